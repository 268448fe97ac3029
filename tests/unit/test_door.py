"""What comes in is bounded before it is read: each kind in two forms, as text and as tables, is one line of ours."""

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import Scenario, parse_scenario, scenario_of
from sealdyn.scenario.settings import study_settings
from sealdyn.studies.sweep import Settings
from sealdyn.unit_names import spelled_like

SEAL = (SCENARIOS / "fms_reference.toml").read_text()


def nested(depth, table):
    held = 1
    for _ in range(depth):
        held = {"a": held} if table else [held]
    return held


def in_itself():
    held = []
    held.append(held)
    return held


def doubling():
    """Few objects, and more entries than there is time to go through."""
    held = [1]
    for _ in range(18):
        held = [held] * 8
    return held


def with_line(line):
    return lambda: parse_scenario(f"{SEAL}\n{line}\n", "seal.toml")


def with_value(key, value):
    return lambda: parse_scenario(SEAL, "seal.toml").with_({key: value})


def with_set(*overrides):
    return lambda: parse_scenario(SEAL, "seal.toml", overrides)


def with_flags(**flags):
    return lambda: study_settings(parse_scenario(SEAL, "seal.toml"), "sweep", Settings, flags)


@pytest.mark.parametrize(
    "reads",
    [
        # Integers that Python does not print, and digits that no number has.
        with_line("study.sweep.key = 0x" + 5000 * "f"), with_line("run.x = " + 30_000 * "1" + " mm"),
        with_value("run.turns", 10**5000), with_set("run.turns=0b" + 9000 * "1"), with_flags(vary=[10**5000]),
        # Depth.
        with_line(".".join(["a"] * 3000) + " = 1"), with_line("'b c'." * 30_000 + "a = 1"),
        with_line("x = " + 100_000 * "["), with_set("film." + ".".join(["a"] * 3000) + "=1"),
        with_set("film.x=" + 400 * "[" + 400 * "]"), with_value("film.x", nested(3000, True)),
        with_value("film.x", nested(3000, False)), with_value("film.x", in_itself()),
        lambda: Scenario.from_dict({"film": nested(3000, True)}), with_flags(vary=nested(3000, False)),
        # Number.
        with_value("film.x", doubling()), lambda: Scenario.from_dict({"film": {"x": doubling()}}),
        # Length.
        with_line("a" * 10**6 + " = 1"), with_line("x = '" + 10**6 * "1 '"), with_value("film.model", 10**5 * "x"),
        # Keys that are no strings; halves of characters.
        with_value("shaft.speed", {None: 1, "time": [0, 1]}), with_value("film", {3: 1}), with_value(None, 1),
        with_value("film.\ud800", 1), with_value("film.model", "\udfff"), with_set("film.\udcff=1"),
        with_set("film.model=\udcff"), with_line("x = '\ud800'"), with_value("film.x", np.array([None, "\ud800"])),
        with_set(1), lambda: scenario_of(__file__, {"film": nested(3000, True)}),
    ],
)  # fmt: skip
def test_what_has_no_bounds_is_refused(reads):
    with pytest.raises(ScenarioError) as error:
        reads()
    line = str(error.value)
    assert "\n" not in line and len(line) < 1000 and line.encode()


def test_a_spelling_is_looked_for_of_anything():
    assert spelled_like("clearence", ["clearance"]) == ["clearance"]
    for word in (None, 3, [], "x" * 10**6, ("a",), b"clearance"):
        assert spelled_like(word, ["clearance"]) == []


def test_what_scenarios_have_goes_through():
    # Written and read again in the time of their count, not of its square.
    samples = {"time": list(np.arange(500) * 1e-5), "axial": list(np.sin(np.arange(500.0)) * 1e-6)}
    scenario = parse_scenario(SEAL, "seal.toml", ["run.duration=0.004"]).with_({"housing.motion": samples})
    assert Scenario.from_dict(scenario.to_dict()).scene == scenario.scene
