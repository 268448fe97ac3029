"""Scenarios to begin with: each is read, runs, and says what its keys are."""

import tomllib

import pytest
from command import sealdyn

from sealdyn.scenario.templates import kinds, template


@pytest.mark.parametrize("kind", kinds())
def test_it_runs(kind, tmp_path):
    answer = sealdyn("new", kind, cwd=tmp_path)
    assert answer.code == 0 and f"{kind}.toml" in answer.out
    short = ["--set", f"run.turns={0.05 if kind == 'wavy' else 1}", "--no-plot", "--json"]
    answer = sealdyn("run", f"{kind}.toml", *short, "--out", "a.h5", cwd=tmp_path)
    assert answer.code == 0, answer.err
    found = answer.found
    assert found["stability"]["verdict"] == "stable"
    floats = found["model"]["reasons"][0]
    assert kind.upper() in floats or kind in ("gas", "pump", "wavy")


@pytest.mark.parametrize("kind", kinds())
def test_it_explains_itself(kind):
    text = template(kind)
    assert "?" in text.splitlines()[0] and tomllib.loads(text)
    keys = [line for line in text.splitlines() if " = " in line and line[0] != "#"]
    assert sum("  # " in line for line in keys) > 0.5 * len(keys)


@pytest.mark.core
def test_nothing_is_overwritten(tmp_path):
    (tmp_path / "fms.toml").write_text("mine")
    answer = sealdyn("new", "fms", cwd=tmp_path)
    assert answer.code == 2 and "already" in answer.err and (tmp_path / "fms.toml").read_text() == "mine"
    answer = sealdyn("new", "fsm", cwd=tmp_path)
    assert answer.code == 2 and "nearest 'fms'" in answer.err
    assert sealdyn("new", "gas", "--out", "nowhere/a.toml", cwd=tmp_path).code == 2
