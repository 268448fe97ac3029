"""Broken scenarios of every sort: always one line, or a valid scenario; never anything else."""

import json
import tomllib
from copy import deepcopy

import pytest
from command import SCENARIOS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sealdyn.scenario.reader import Scenario, ScenarioError, parse_scenario

SHIPPED = [p.read_text() for p in sorted(SCENARIOS.glob("*.toml"))]
TREES = [tomllib.loads(text) for text in SHIPPED]
WORDS = sorted({w for text in SHIPPED for w in text.replace("=", " ").replace(".", " ").split()})
ODD_NUMBERS = [0, -1, 1, 1e308, -1e308, 5e-324, 10**400, float("nan"), float("inf"), True, False]
UNITS = ["um", "rpm", "bar", "kg", "N*m", "Hz", "g", "um TIR", "bar gauge", "", "m**9**9", "((", "1/", "°", "\n"]

numbers = st.one_of(st.sampled_from(ODD_NUMBERS), st.floats(), st.integers())
strings = st.one_of(
    st.text(max_size=12),
    st.sampled_from(WORDS),
    st.builds("{} {}".format, st.floats(), st.sampled_from(UNITS)),
    st.builds("{} {}".format, st.integers(), st.sampled_from(UNITS)),
)
scalars = st.one_of(numbers, strings)
tables = st.fixed_dictionaries({"time": st.lists(scalars, max_size=4), "value": st.lists(scalars, max_size=4)})
values = st.recursive(
    st.one_of(scalars, tables),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(strings, inner, max_size=3)),
    max_leaves=6,
)


def check(text, *overrides):
    try:
        scenario = parse_scenario(text, "broken.toml", overrides)
    except ScenarioError as error:
        assert str(error).startswith("broken.toml") and str(error).isprintable()
        assert "found" in str(error) and "expected" in str(error) and len(str(error)) < 1000
    else:
        assert isinstance(scenario, Scenario)
        json.dumps(scenario.resolved())
        scenario.unused()


def places(tree, path=()):
    """Paths of all tables, entries and leaves."""
    below = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [path] + [p for step, value in below for p in places(value, (*path, step))]


@st.composite
def mutated(draw):
    """A shipped scenario with one to three keys dropped, renamed, replaced, moved or added."""
    tree = deepcopy(draw(st.sampled_from(TREES)))
    for _ in range(draw(st.integers(1, 3))):
        paths = [p for p in places(tree) if p]
        if not paths:
            break
        *above, last = draw(st.sampled_from(paths))
        parent = tree
        for step in above:
            parent = parent[step]
        deed = draw(st.sampled_from(["drop", "rename", "replace", "add", "wrap"]))
        if deed == "drop":
            del parent[last]
        elif deed == "rename" and isinstance(parent, dict):
            parent[draw(strings)] = parent.pop(last)
        elif deed == "add" and isinstance(parent, dict):
            parent[draw(strings)] = draw(values)
        elif deed == "wrap":
            parent[last] = [parent[last]]
        else:
            parent[last] = draw(values)
    return tree


def as_toml(value) -> str:
    """Inline TOML of a tree."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{quoted(k)} = {as_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(as_toml(v) for v in value) + "]"
    if isinstance(value, str):
        return quoted(value)
    return str(value).lower() if isinstance(value, (bool, float)) else str(value)


def quoted(text: str) -> str:
    plain = "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{plain}"'


quick = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))


@quick
@given(mutated())
def test_mutated_scenarios(tree):
    check("\n".join(f"{quoted(k)} = {as_toml(v)}" for k, v in tree.items()))


@quick
@given(st.sampled_from(SHIPPED), st.integers(0, 2000), st.integers(0, 40), st.text(max_size=8))
def test_damaged_text(text, at, length, inserted):
    check(text[:at] + inserted + text[at + length :])


@quick
@given(st.text())
def test_any_text(text):
    check(text)


@quick
@given(st.sampled_from(SHIPPED), st.one_of(st.text(), st.builds("{}={}".format, st.sampled_from(WORDS), st.text())))
def test_any_override(text, override):
    check(text, override)


@quick
@given(st.sampled_from(["rotor", "run", "film.coefficients", "housing.axial", "study.a", "x"]), st.integers(1, 3000))
def test_deep_nesting(key, depth):
    check(SHIPPED[0], f"{key}=" + "[" * depth + "]" * depth)
    check(SHIPPED[0], f"{key}=" + "{a=" * depth + "1" + "}" * depth)


@pytest.mark.core
def test_the_unbroken_ones_pass(monkeypatch):
    # Files are named as beside a scenario.
    monkeypatch.chdir(SCENARIOS)
    for tree in TREES:
        text = "\n".join(f"{quoted(k)} = {as_toml(v)}" for k, v in tree.items())
        assert isinstance(parse_scenario(text, "whole.toml"), Scenario)
