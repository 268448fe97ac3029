"""The steady-state study through its front door."""

from pathlib import Path

import numpy as np

import sealdyn
from sealdyn.archive import read_study
from sealdyn.investigate import investigate

SCENARIOS = Path(__file__).parents[2] / "scenarios"


def test_answer_archive_and_figure(tmp_path):
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml")
    flags = {"approach": [0.9, 0.98]}
    answer = investigate("steady-state", scenario, tmp_path / "s.h5", flags=flags, workers=1)
    assert answer["stable"] and len(answer["multipliers"]) == 6
    low, high = answer["near_threshold"]
    # Waiting takes ever longer, shooting does not.
    assert high["transient"] > 3 * low["transient"] and high["shooting"] <= 60
    kept = read_study(tmp_path / "s.h5")
    assert kept["answer"]["h_min"] == answer["h_min"] and kept["scenario"] == scenario.text
    from sealdyn.charts import study_steady_state

    assert study_steady_state.draw(tmp_path / "s.h5", tmp_path / "s.png").stat().st_size < 300_000
    assert not list(tmp_path.glob("*.jsonl"))


def test_incommensurate_forcing_falls_back_and_says_so(tmp_path):
    text = (SCENARIOS / "fmr_reference.toml").read_text() + "[[shaft.whirl]]\nratio = 0.41421356\nangle = 2e-6\n"
    from sealdyn.scenario import parse_scenario

    answer = investigate("steady-state", parse_scenario(text, "x.toml"), tmp_path / "s.h5", workers=1)
    assert answer["period"] is None and "time domain" in answer["verdict"][0]
    assert np.isfinite(answer["relative_misalignment"]["max"])
