"""Rub: the diagram of a seal that stays periodic and of one that does not; two methods on the same attractor."""

import json
import math

import numpy as np
import pytest
from command import read
from drawn import drawn, has_points, panel, text_trouble

from sealdyn.analysis import poincare_map
from sealdyn.analysis.poincare_map import SAMPLES, PeriodMap, share_below
from sealdyn.analysis.rotating_wave import RotatingWave, free_model, least_damped
from sealdyn.analysis.shooting import Shooter
from sealdyn.analysis.whirl_in_time import whirl_fate
from sealdyn.numerics import time_series
from sealdyn.report import panels
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.scene import with_values
from sealdyn.studies._runner import run_study

QUICK = {"ramp": 10, "drop": 6, "keep": 16, "exponent_turns": 16, "judge_turns": 0}


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    out = tmp_path_factory.mktemp("rub") / "reference.h5"
    flags = QUICK | {"values": "3.6:4.8 mrad:2", "down": True}
    return run_study("rub", read("rub"), out, flags=flags, workers=1), out


def test_reference_seal_rubs_with_period_one(reference):
    """Contact begins between 3.6 and 4.8 mrad; the motion repeats every turn, and going back it is the same."""
    answer, _ = reference
    up, down = ([row for row in answer["rows"] if row["direction"] == d] for d in ("up", "down"))
    assert [row["class"] for row in up] == ["no contact", "period 1"]
    for row, back in zip(up, down[::-1], strict=True):
        assert row["status"] == "ok"
        assert row["exponent"] < -4.0
        assert row["section"][-1] == pytest.approx(back["section"][-1], abs=1e-8)
        assert np.ptp(row["h_min"]) < 1e-9
    last = up[-1]
    assert 0.02 < last["contact_share"] <= 1.0
    assert last["lines"]["between"] < 1e-6
    assert last["lines"]["1"] > last["lines"]["2"] > last["lines"]["3"] > 100 * last["lines"]["0.5"]
    json.dumps(answer, allow_nan=False)
    assert not [row for row in answer["rows"] if row["class"] == "chaotic"] and answer["judge"] is None


def test_exponent_of_a_periodic_rub_is_its_floquet_multiplier(reference):
    """The orbit by Newton on the period map (DOP853, differences of the flow) has the multiplier whose logarithm the
    two trajectories (Adams) grow by."""
    answer, _ = reference
    row = [row for row in answer["rows"] if row["direction"] == "up"][-1]
    scene = with_values(poincare_map.frozen_at_end(read("rub").scene), {"rotor.runout": row["value"]})
    orbit = Shooter(scene, 1e-6, tight=1e-9).find(np.array(row["end"]), target=1e-6)
    assert row["exponent"] == pytest.approx(math.log(np.abs(orbit.multipliers).max()), abs=row["uncertainty"] + 0.1)
    assert orbit.extremes["h_min"]["value"] == pytest.approx(min(row["h_min"]), abs=2e-9)


def test_chart_holds_every_turn_every_exponent_and_a_section(reference, tmp_path):
    answer, out = reference
    figure = drawn(panels, out, tmp_path / "rub.png")
    diagram, exponents = panel(figure, "Smallest film"), panel(figure, "Largest Lyapunov")
    words = ("growing", "falling")
    films = np.concatenate([line.get_ydata() for line in diagram.lines if str(line.get_label()).startswith(words)])
    assert sorted(films) == pytest.approx(sorted(1e6 * h for row in answer["rows"] for h in row["h_min"]), rel=1e-12)
    marks = [line for line in exponents.lines if len(line.get_xdata()) == 1]
    drawn_there = sorted({round(float(line.get_ydata()[0]), 9) for line in marks})
    assert set(drawn_there) >= {round(row["exponent"], 9) for row in answer["rows"]}
    last = [row for row in answer["rows"] if row["direction"] == "up"][-1]
    (section,) = [ax for ax in figure.axes if ax.get_title(loc="left").endswith(last["class"])]
    assert has_points(section, *(1e6 * np.array(last["section"]).T))
    assert "µm" in diagram.get_ylabel() and "mrad" in exponents.get_xlabel() and "µrad" in section.get_ylabel()
    assert text_trouble(figure)[1] == []


def test_a_seal_without_contact_table_is_refused(tmp_path):
    with pytest.raises(ScenarioError) as refused:
        run_study("rub", read("fms_reference"), tmp_path / "x.h5", workers=1)
    assert refused.value.key == "contact"


@pytest.mark.parametrize("flags, key", [({"key": "rotor.runuot"}, "key"), ({"values": "1 um:2 um:3"}, "values")])
def test_a_key_or_a_unit_that_cannot_be_is_refused(flags, key, tmp_path):
    with pytest.raises(ScenarioError) as refused:
        run_study("rub", read("rub"), tmp_path / "x.h5", flags=flags, workers=1)
    assert refused.value.key == f"study.rub.{key}" and "\n" not in str(refused.value)


def test_impulse_share_and_film_do_not_depend_on_sampling():
    """Impulse integrated with the motion against samples of the force; located contacts against the sampled film."""
    scene = poincare_map.frozen_at_end(read("rub_chaotic").scene)
    scene = with_values(scene, {"rotor.runout": 0.33e-3})
    stroboscope = PeriodMap(scene, 1e-7)
    x = poincare_map.ramp_to(scene, "rotor.runout", None, None, {"ramp": 15, "accuracy": 1e-6})
    turns = stroboscope.run(x, 24)
    assert turns.impulse == pytest.approx(turns.contact_force.mean() * stroboscope.period, rel=2e-3)
    share = share_below(turns.h_min, 3e-6)
    assert share.mean() == pytest.approx(turns.touching.mean(), abs=3e-3)
    assert np.all(turns.lowest <= turns.h_min.min(axis=1))
    # The period map is the run, seen once a turn.
    x1 = stroboscope.step(x)
    assert (stroboscope.run(x, 1).last - x1) / stroboscope.scales == pytest.approx(np.zeros(6), abs=1e-5)


def test_tangents_are_differences_of_the_map():
    scene = with_values(poincare_map.frozen_at_end(read("rub_chaotic").scene), {"rotor.runout": 0.33e-3})
    x = poincare_map.ramp_to(scene, "rotor.runout", None, None, {"ramp": 15, "accuracy": 1e-6})
    stroboscope, q = PeriodMap(scene, 1e-8, "dop853"), np.eye(6)[:, [1, 5]]
    samples = []
    x1, moved = stroboscope.tangents(x, q, samples)
    step = 1e-4
    for j in range(2):
        ahead, behind = (stroboscope.step(x + s * step * stroboscope.scales * q[:, j]) for s in (1, -1))
        assert (ahead - behind) / (2 * step * stroboscope.scales) == pytest.approx(moved[:, j], abs=1e-3)
    assert x1 == pytest.approx(stroboscope.step(x), rel=1e-5)
    assert sum(len(part[0]) for part in samples) == SAMPLES


def test_whirl_beyond_the_critical_speed_ends_in_contact():
    """Below 5588.7 rad/s it dies; above it grows into the faces, and the reference seal's asperities give way."""
    scene = poincare_map.frozen_at_end(read("rub").scene)
    below, above = whirl_fate(scene, 5400.0), whirl_fate(scene, 6200.0)
    assert below["fate"] == "decays"
    assert below["first_contact"] is None
    assert above["fate"] == "collapse"
    assert above["first_contact"] < above["turns"]


@pytest.mark.slow
def test_whirl_that_settles_in_a_rub_is_a_relative_equilibrium():
    """Harder asperities carry it: the ring rolls on a patch that turns with it.  The same motion without integration,
    as a point at rest in the frame that turns with the whirl, has this shaft speed and is stable."""
    hard = 'contact={roughness="1 um", compressive_strength="5 GPa"}'
    scene, speed = read("fms_reference", hard).scene, 5700.0
    found = whirl_fate(scene, speed)
    assert found["fate"] == "rub"
    assert found["contact_share"] == 1.0
    low, high = found["amplitude"]
    assert high - low < 1e-5 * high
    ready = free_model(scene, speed)
    whirling, shape = RotatingWave(ready), least_damped(ready, speed)[1]
    q = high * shape
    q[ready.unknowns.names.index("stator_z")] = 0.5 * high * ready.face[0]
    whirl = whirling.solve(high, (q, found["whirl_ratio"] * speed, speed))
    assert whirl.speed == pytest.approx(speed, rel=1e-3)
    assert whirl.frequency / speed == pytest.approx(found["whirl_ratio"], rel=1e-3)
    assert whirl.h_min == pytest.approx(found["h_min"], rel=1e-3)
    assert whirl.growth < 0


@pytest.mark.slow
def test_chaotic_rub_two_methods_agree(tmp_path):
    """Period 6 at 0.4 mrad, chaos at 0.55: exponent positive by both methods, averages the same, trajectories not."""
    flags = {"values": "0.4:0.55 mrad:2", "drop": 40, "keep": 48, "exponent_turns": 40, "judge_turns": 60}
    answer = run_study("rub", read("rub_chaotic"), tmp_path / "c.h5", flags=flags)
    assert answer["rows"][0]["class"] == "period 6"
    assert answer["rows"][-1]["class"] == "chaotic"
    entries = answer["methods"]["invariants"]
    assert all(entry["agree"] for entry in entries.values()), entries
    for value, error in zip(entries["exponent"]["values"], entries["exponent"]["uncertainties"], strict=True):
        assert 0.2 < value < 1.0
        # Measured 0.1 to 0.55 of it: rounding chooses the turns of chaos that are seen.
        assert error < value
    assert entries["h_min_mean"]["uncertainties"][0] < 2e-7
    assert 10 < answer["separation"]["lost"] < 120
    assert answer["separation"]["apart"][0] == 0.0


# --- what needs no seal -----------------------------------------------------------------------------------


def orbit_of(function, x, count):
    out = []
    for _ in range(count):
        x = function(x)
        out.append(x)
    return np.array(out)


@pytest.mark.core
def test_classes_of_the_logistic_map():
    """Periods 1, 2, 4 and chaos, as everyone knows them."""
    for r, expected in ((2.8, 1), (3.2, 2), (3.5, 4), (3.83, 3), (3.9, None)):
        section = orbit_of(lambda x, r=r: r * x * (1 - x), 0.3, 600)[500:]
        assert time_series.period_of(section, 1.0) == expected
        assert expected is None or time_series.distinct_points(section, 1.0) == expected
    # A slow spiral towards a fixed point is no period 16.
    spiral = 0.2 * 0.99 ** np.arange(96) * np.exp(2j * np.pi * np.arange(96) / 16.0)
    assert time_series.period_of(spiral, 1.0) is None
    assert time_series.shrinking(spiral)
    slow = 0.006 * np.exp(2j * np.pi * np.arange(96) / 15.9)
    assert time_series.period_of(slow, 1.0) is None
    assert time_series.classify(None, -0.01, 0.02, still=True) == "settling"
    assert time_series.classify(None, 0.4, 0.1) == "chaotic"
    assert time_series.classify(None, 0.01, 0.005) == "undecided"
    assert time_series.classify(None, 0.0, 0.01) == "quasi-periodic"
    assert time_series.classify(2, -0.1, 0.01) == "period 2"
    assert time_series.classify(2, 0.3, 0.1) == "settling"
    assert time_series.classify(2, -0.3, 0.1, still=True) == "settling"
    assert time_series.classify(None, 0.0, 0.2) == "undecided"


def test_spectrum_in_orders():
    t = np.arange(64 * 40) / 64
    orders, size = time_series.spectrum(3.0 + 2.0 * np.cos(2 * np.pi * t) + 0.1 * np.sin(4 * np.pi * t), 64)
    found = time_series.lines(orders, size)
    assert (found["1"], found["2"], found["between"]) == pytest.approx((2.0, 0.1, 0.0), abs=1e-9)
    # Half a bin off, a line stays within its neighbourhood.
    orders, size = time_series.spectrum(np.cos(2 * np.pi * t * (1 + 0.5 / 40)), 64)
    assert size[np.abs(orders - 1) > 0.5].max() < 1e-3
    half = time_series.lines(*time_series.spectrum(np.cos(np.pi * t), 64))
    assert half["0.5"] == pytest.approx(1.0, abs=1e-9)
    assert half["between"] == pytest.approx(1.0, abs=1e-9)


def test_share_below_a_level():
    for phase in (0.0, 0.013, 0.04):
        h = np.cos(2 * np.pi * (np.arange(64 * 3) / 64 + phase)).reshape(3, 64)
        assert share_below(h, 0.4)[:2] == pytest.approx(1 - np.arccos(0.4) / np.pi, abs=1e-3)


def test_averages_and_their_comparison():
    rng = np.random.default_rng(1)
    one, other, third = (time_series.statistics(rng.normal(size=800) + shift, "h") for shift in (0.0, 0.0, 0.5))
    assert all(entry["agree"] for entry in time_series.compared(one, other, {}).values())
    assert not time_series.compared(one, third, {})["h_mean"]["agree"]
    assert time_series.spread(np.tile([0.0, 5.0], 40)) == 0.0
