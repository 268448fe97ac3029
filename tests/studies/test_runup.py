"""Study runup: growth, touch and lag as linear theory has them; every run once; errors in one line."""

import json
import math

import numpy as np
import pytest
from command import read
from drawn import curve, drawn, has_points, panel, text_trouble

from sealdyn.archive import read_study
from sealdyn.dynamics.model import Model
from sealdyn.faces.geometry import COLLAPSE
from sealdyn.report.charts import study_runup
from sealdyn.scenario.errors import ScenarioError
from sealdyn.studies import runup
from sealdyn.studies._runner import run_study
from sealdyn.studies.runup.speed_ramp import touch_tilt

GREEN = 5890.6
NARROW = {"begin": 5600, "end": 6185, "rates": "8000, 20000, 60000"}


def study(folder, scenario, **flags):
    return run_study("runup", scenario, folder / "r.h5", flags=flags, workers=1)


@pytest.fixture(scope="module")
def linear(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runup")
    return folder, study(folder, read("runup_past_threshold", "film.model=linear"), touch=False, **NARROW)


def test_growth_past_the_threshold_at_three_rates(linear):
    """The issue: within 5 % of the integral of the linear growth rate while small; as it is, within 1 %."""
    _, answer = linear
    assert answer["threshold"] == pytest.approx(GREEN, abs=0.1)
    assert [row["rate"] for row in answer["rows"]] == [8000.0, 20000.0, 60000.0]
    for row in answer["rows"]:
        assert row["status"] == "ok"
        assert abs(row["growth"]["error"]) < 0.05
        assert abs(row["growth"]["error_with_factor"]) < 0.01
        # Up to 1.05 of the threshold and back at constant rate.
        assert row["time_above"] == pytest.approx(2 * (6185 - answer["threshold"]) / row["rate"], rel=1e-9)
    grown = [row["growth"]["whole"] * row["rate"] for row in answer["rows"]]
    assert grown == pytest.approx([grown[0]] * 3, rel=1e-12)


def test_resolution_is_stated_and_right(linear):
    _, answer = linear
    for row in answer["rows"]:
        assert row["resolution"] == pytest.approx(1.5 / row["window"])
        turns = (6185**2 - 5600**2) / (2 * row["rate"]) / (2 * math.pi)
        assert row["turns"] == pytest.approx(turns, abs=0.2)
        assert row["folding"] < 1e-6
    # The whirl is on its line: the half order, where it grows.
    fall = answer["waterfall"]["down"]
    first = dict(zip(fall["orders"], fall["amplitude"][0], strict=True))
    slow = max((v, k) for k, v in first.items() if k < 0.8 and k > 0.2)
    assert slow[1] == pytest.approx(answer["whirl"]["frequency"][-1] / 6185, abs=1 / answer["waterfall"]["window"])


def test_answer_is_plain_and_drawn_from_the_archive_alone(linear):
    folder, answer = linear
    assert len(json.dumps(answer, allow_nan=False)) < 400_000
    assert read_study(folder / "r.h5")["answer"]["rows"] == json.loads(json.dumps(answer["rows"]))
    figure = drawn(study_runup, folder / "r.h5", folder / "r.png")
    order, growth = panel(figure, "Relative tilt"), panel(figure, "Free whirl")
    for row in answer["rows"]:
        name = f"{row['rate']:g} rad/s²"
        assert curve(order, name)[1] == pytest.approx(1e6 * np.array(row["up"]["amplitude"]), rel=1e-12)
        measured = row["growth"]["curve"]
        expected = np.array(measured["time"]) * row["rate"], np.array(measured["measured"])
        assert curve(growth, name) == pytest.approx(np.array(expected), rel=1e-12)
    tilts = np.array([row["relative_misalignment"] for row in answer["rows"]])
    assert has_points(panel(figure, "How fast"), [row["rate"] for row in answer["rows"]], 1e6 * tilts)
    assert "µrad" in order.get_ylabel() and "rad/s" in growth.get_xlabel() and text_trouble(figure)[1] == []


@pytest.mark.slow
def test_touching_rate_of_a_linear_film(tmp_path):
    """exp(2/rate int Re(lambda) dw) times the whirl met, and the forced tilt on top, closes the gap: a formula."""
    answer = study(tmp_path, read("runup_past_threshold", "film.model=linear"), begin=5300, end=6185, rates="8000")
    speed, growth = np.array(answer["whirl"]["speed"]), np.array(answer["whirl"]["growth_rate"])
    above = speed >= answer["threshold"]
    whole = 2 * np.trapezoid(np.r_[0.0, growth[above]], np.r_[answer["threshold"], speed[above]])
    gap = 1e-5 / 0.032 - answer["forced_tilt"]
    expected = whole / math.log(gap / answer["disturbance"])
    assert answer["rate_foretold"] == pytest.approx(expected, rel=0.01)
    assert answer["touch_rate"]["value"] == pytest.approx(expected, rel=0.02)
    low, high = answer["touch_rate"]["bracket"]
    assert high < 1.011 * low
    # The curve: what touches is slower than what does not, and faster is smaller.
    curve = answer["curve"]
    touched = np.array(curve["touched"])
    assert np.all(np.diff(touched.astype(int)) <= 0)
    free = np.array(curve["relative_misalignment"])[~touched]
    assert np.all(np.diff(free) < 0)


@pytest.mark.slow
def test_a_nonlinear_film_touches_at_other_rates_and_says_so(tmp_path):
    answer = study(tmp_path, read("runup_past_threshold"), begin=5000, end=5868, rates="1500, 10000")
    slow, fast = answer["rows"]
    assert slow["status"] == "collapsed" and fast["status"] == "ok"
    assert slow["h_min_way"] == "down"
    assert 1.03 < answer["touch_rate"]["value"] / answer["rate_foretold"] < 1.3
    assert abs(fast["growth"]["error"]) < 0.05


@pytest.mark.slow
def test_with_contact_the_run_goes_on(tmp_path):
    """Asperities that carry the whirl: the slow passing touches, and comes back down."""
    hard = 'contact={roughness="1 um", compressive_strength="5 GPa"}'
    answer = study(tmp_path, read("runup_past_threshold", hard), begin=5300, end=5700, rates="400", touch=False)
    (row,) = answer["rows"]
    assert row["status"] == "ok" and row["touched"]
    assert 0 < row["h_min"] < 3e-6


def test_without_threshold_the_order_lags(tmp_path):
    """FMR at c = 1/2 is stable at any speed: nothing grows, and the lag goes with the rate."""
    answer = study(tmp_path, read("fmr_reference"), begin=500, end=1500, rates="1000, 4000, 16000")
    assert answer["threshold"] is None and answer["crossing"] is None
    assert answer["rows"][0]["growth"] is None and answer["touch_rate"] is None
    far = [max(row["up"]["departure"], row["down"]["departure"]) for row in answer["rows"]]
    assert far[1] / far[0] == pytest.approx(4.0, rel=0.4)
    assert far[2] / far[1] == pytest.approx(4.0, rel=0.4)
    figure = drawn(study_runup, tmp_path / "r.h5", tmp_path / "r.png")
    assert not any("Free whirl" in ax.get_title("left") for ax in figure.axes) and text_trouble(figure)[1] == []


def test_without_threshold_an_unstable_seal_is_not_called_stable(tmp_path):
    """A diverging film pushes the ring over at every speed; undriven, stable rings have nothing that whirls."""
    diverging = read("fms_reference", "film.coning=-1e-4")
    answer = study(tmp_path, diverging, begin=500, end=1000, rates="20000", touch=False)
    assert answer["threshold"] is None and answer["linear_verdict"] == "unstable" and answer["tilting"]
    undriven = read("fms_reference", "rotor.runout=0", "stator.misalignment=0")
    answer = study(tmp_path, undriven, begin=500, end=1000, rates="20000", touch=False)
    assert answer["threshold"] is None and answer["linear_verdict"] == "stable" and not answer["tilting"]


def test_a_touching_rate_that_cannot_be_found_is_undecided(tmp_path, monkeypatch):
    def failed(scenario, point):
        raise ValueError("no film")

    def found(scenario, point):
        touched = point["rate"] < 30000
        return {"rate": point["rate"], "status": "ok", "touched": touched, "relative_misalignment": 1e-4, "h_min": 1e-6}

    calls = []
    passes = lambda scenario, point: (failed if len(calls) > 4 else found)(scenario, calls.append(0) or point)  # noqa: E731
    monkeypatch.setattr(runup, "short_pass", passes)
    answer = study(tmp_path, read("runup_past_threshold", "film.model=linear"), **{**NARROW, "rates": "20000"})
    assert answer["touch_rate"]["value"] is None and answer["status"] == "failed"


def test_no_finished_run_is_repeated(tmp_path, monkeypatch):
    """Stopped at its second run, then started again: the first one is not run anew, and the answer is the same."""
    flags = {**NARROW, "rates": "20000, 60000", "touch": False}
    scenario = read("runup_past_threshold", "film.model=linear")
    ran, whole = [], runup.passage

    def counted(scenario, point):
        ran.append(point["rate"])
        if len(ran) == 2:
            raise KeyboardInterrupt
        return whole(scenario, point)

    monkeypatch.setattr(runup, "passage", counted)
    with pytest.raises(KeyboardInterrupt):
        study(tmp_path, scenario, **flags)
    answer = study(tmp_path, scenario, **flags)
    assert ran == [20000.0, 60000.0, 60000.0]
    assert [row["status"] for row in answer["rows"]] == ["ok", "ok"]
    assert not list(tmp_path.glob("*.partial.jsonl"))


def test_aliasing_is_warned_of(tmp_path):
    """A housing tone beyond what the samples can show, asked for; by itself the study samples often enough."""
    scenario = read("housing_vibration")
    flags = {"begin": 900, "end": 1200, "rates": "20000"}
    few = study(tmp_path, scenario, samples_per_turn=8, **flags)
    enough = study(tmp_path, scenario, **flags)
    assert len(few["warnings"]) == 1 and set(few["warnings"]) <= set(few["verdict"])
    assert not enough["warnings"] and enough["samples_per_turn"] > 8


# --- anything else ----------------------------------------------------------------------------------------


def test_pressure_ramps_and_a_step(tmp_path):
    """The seal of pressure_step: at 1.3 bar film, spring and support balance at 0.87 um (coned film, closed form)."""
    answer = study(tmp_path, read("pressure_step"), key="film.outer_pressure")
    slow = answer["quasi_static"]
    assert (answer["begin"], answer["end"], answer["unit"]) == (5e5, 1.3e5, "Pa")
    assert slow["h_min"][0] == pytest.approx(10e-6, rel=1e-6)
    assert slow["h_min"][-1] == pytest.approx(0.87e-6, abs=0.005e-6)
    assert [row["rate"] is None for row in answer["rows"]] == [False, False, False, True]
    for row in answer["rows"]:
        # A squeezed film comes down from above: no overshoot.
        assert row["status"] == "ok"
        assert row["overshoot"]["h_min"] < 1e-3
        assert row["settled"]["end"]["leakage"] == pytest.approx(slow["leakage"][-1], rel=0.05)
        assert row["settled"]["begin"]["leakage"] == pytest.approx(slow["leakage"][0], rel=0.01)
    json.dumps(answer, allow_nan=False)
    figure = drawn(study_runup, tmp_path / "r.h5", tmp_path / "r.png")
    ramps = [row for row in answer["rows"] if row["rate"]]
    films = [1e6 * row["h_min"] for row in ramps]
    assert has_points(panel(figure, "Thinnest film:"), [1e-5 * row["rate"] for row in ramps], films)
    assert text_trouble(figure)[1] == []


def test_a_light_support_overshoots_as_an_oscillator(tmp_path):
    """Two linear films of Green's stiffness but hardly any damping: a step of pressure passes the new balance by
    exp(-pi zeta / sqrt(1 - zeta**2)), a ramp of one natural period by almost nothing."""
    k, d, mass = 4e6, 400.0, 1.0
    film = f"film.coefficients={{tilt_stiffness=5000, tilt_damping=1, axial_stiffness={k}, axial_damping={d}}}"
    given = [film, "film.model=linear", "closing.spring_force=20 N", "rotor.runout=0 rad", "stator.misalignment=0 rad"]
    scenario = read("fms_reference", *given)
    total = k + 5e5
    period = 2 * math.pi / math.sqrt(total / mass)
    answer = study(tmp_path, scenario, key="closing.spring_force", end="40 N", rates=f"{20 / period}, step")
    zeta = (d + 300.0) / (2 * math.sqrt(total * mass))
    expected = math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    ramp, step = answer["rows"]
    assert answer["quasi_static"]["h_min"][-1] == pytest.approx(10e-6 - 20 / total, rel=1e-6)
    assert step["overshoot"]["h_min"] == pytest.approx(expected, rel=0.01)
    assert ramp["overshoot"]["h_min"] < 0.3 * expected


def test_the_scenes_own_tables_have_their_say(tmp_path):
    """pressure_step again, its step to 1.3 bar behind it: the closing force is still what its start decided."""
    flags = {"key": "film.inner_pressure", "rates": "20 bar/s"}
    answer = study(tmp_path, read("pressure_step"), end="0.02 bar", **flags)
    slow, (row,) = answer["quasi_static"], answer["rows"]
    assert slow["h_min"][0] == pytest.approx(0.87e-6, abs=0.005e-6)
    for name, k in (("begin", 0), ("end", -1)):
        assert row["settled"][name]["leakage"] == pytest.approx(slow["leakage"][k], rel=0.02)
    # It was settled before it began: at most what was left of that is beyond the slow answer.
    assert row["overshoot"]["leakage"] < 0.05
    # Its spring alone is more than 0.3 bar can carry.
    answer = study(tmp_path, read("pressure_step"), end="1 bar", **flags)
    assert answer["quasi_static"]["h_min"][-1] is None and answer["quasi_static"]["leakage"][0] > 0
    assert set(answer["rows"][0]["overshoot"].values()) == {None}
    assert text_trouble(drawn(study_runup, tmp_path / "r.h5", tmp_path / "r.png"))[1] == []


def test_an_own_ramp_of_the_speed_is_waited_for(tmp_path):
    """The shaft of the scenario has done its run-up before the pressure changes."""
    speed = "shaft.speed={ time = ['0 s', '0.3 s'], value = ['500 rad/s', '1000 rad/s'] }"
    answer = study(tmp_path, read("fms_reference", speed), key="film.outer_pressure", end="4.5 bar", rates="step")
    assert answer["rows"][0]["stages"][0] > 0.3


def test_no_hold_is_none(tmp_path):
    flags = {"key": "film.outer_pressure", "end": "4.9 bar", "rates": "10 bar/s", "hold": 0}
    (row,) = study(tmp_path, read("fms_reference"), **flags)["rows"]
    assert row["stages"][1] == row["stages"][2] and row["settled"]["end"] is None
    assert text_trouble(drawn(study_runup, tmp_path / "r.h5", tmp_path / "r.png"))[1] == []


def test_an_unstable_seal_does_not_calm_down(tmp_path):
    answer = study(tmp_path, read("fms_reference", "shaft.speed=6500 rad/s"), key="film.outer_pressure",
                   end="5.1 bar", rates="step", hold="1 ms")  # fmt: skip
    assert answer["slowest"] > 0


@pytest.mark.core
def test_the_tilt_that_touches_whatever_the_profile():
    """Faces 30 um apart everywhere, by a profile of 25 um on a clearance of 5: h = floor at the outer radius."""
    film = "film.profile={ radius = ['32 mm', '40 mm'], depth = ['25 um', '25 um'] }"
    scene = read("fms_reference", film, "film.clearance=5 um", "film.coning=0 rad", "film.model=auto").scene
    ready = Model(scene)
    assert touch_tilt(ready) == pytest.approx((30e-6 - ready.face[COLLAPSE]) / 40e-3, rel=1e-9)


# --- errors -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "flags, told",
    [
        ({"begin": 6000, "end": 5000}, ["begin", "6000 rad/s, not below end 5000", "lower speed"]),
        ({"begin": -1}, ["begin", "-1 rad/s", "not below zero"]),
        ({"begin": "3 bar"}, ["begin", "3 bar", "rad/s"]),
        ({"rates": "1000, -5"}, ["rates", "above zero"]),
        ({"rates": "0"}, ["rates", "above zero"]),
        ({"rates": "fast"}, ["rates", "fast"]),
        ({"rates": "step"}, ["rates", '"step" of the shaft speed']),
        ({"rates": "0.01"}, ["rates", "turns each way", "a rate above"]),
        ({"key": "film.outer_presure"}, ["key", "film.outer_presure"]),
        ({"key": "film.inner_radius"}, ["key", "film.inner_radius", "change in time"]),
        ({"key": "film.outer_pressure", "end": "5 bar"}, ["end", "as begin"]),
        ({"key": "film.outer_pressure"}, ["end", "nothing"]),
        ({"key": "rotor.runout", "end": "50 urad", "rates": "step"}, ["rates", "a rigid ring cannot jump"]),
        ({"key": "closing.spring_force", "end": "5 N"}, ["key", "does not give"]),
        ({"window": 1}, ["window", "equal to 2"]),
        ({"hold": -1}, ["hold", "-1", "equal to 0"]),
        ({"rate": 1000}, ["unknown key", "nearest 'rates'"]),
        ({"rates": "5 m"}, ["rates", "5 m", "rad/s^2"]),
        ({"rates": "1 foo:2 foo:3"}, ["rates", "1 foo"]),
        ({"rates": "10 foo:20 rpm/s:3"}, ["rates", "units of one kind"]),
        ({"key": "film.outer_pressure", "end": "4 bar", "rates": "5 rpm"}, ["rates", "5 rpm", "Pa/s"]),
        ({"key": "film.outer_pressure", "end": "4 bar", "rates": "3 m, 1 bar/s"}, ["rates", "3 m"]),
        ({"key": "film.outer_pressure", "end": "4 bar", "rates": "step", "hold": 0}, ["hold", "a step"]),
        ({"end": "{ time = [0, 1], value = [800, 900] }"}, ["end", "a table", "one value"]),
    ],
)
def test_errors_in_one_line(tmp_path, flags, told):
    with pytest.raises(ScenarioError) as refused:
        study(tmp_path, read("fms_reference"), **flags)
    words = str(refused.value)
    assert "\n" not in words and "study.runup" in words
    assert all(part in words for part in told), words
