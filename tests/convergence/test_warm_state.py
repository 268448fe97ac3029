"""Warm states beside an independent computation, a closed form, and runs of the scene with the warm numbers put in."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from warm_seals import (
    COEFFICIENTS,
    COLD,
    FOLDS,
    INSIDE,
    NAMES,
    PUMP,
    ROUGH,
    ROWS,
    TOLERANCE,
    VG32,
    by_hand,
    scene_of,
    warm_seal,
)

import sealdyn
from sealdyn.dynamics.interface import Interface
from sealdyn.dynamics.warm_state import NoWarmState, at_work, warming

# A liquid that never thins, and whose leakage carries no heat.
DEAD = {"density": 1e-3, "specific_heat": 1.0, "viscosity": [["1 degC", 8e-4], ["900 degC", 8e-4]]}
RPM = math.pi / 30.0


@pytest.mark.core
@pytest.mark.parametrize(("changes", "rows"), ROWS.values(), ids=ROWS)
def test_warm_states_are_those_of_an_independent_computation(changes, rows):
    found = warming(scene_of(changes))
    assert len(found.states) == len(rows)
    for state, row in zip(found.states, rows, strict=True):
        viscous = state.power - state.contact_power - state.flow_power
        numbers = {**vars(state), "viscous": viscous}
        for name, value in zip(NAMES, row, strict=True):
            # Loop gains have three digits, or four decimals.
            margin = dict(rel=5e-3, abs=6e-5) if name == "loop_gain" else dict(rel=TOLERANCE)
            assert value is None or numbers[name] == pytest.approx(value, **margin), name
        # Heat balances far better than it is known.
        left = (found.conductance + state.carried) * state.rise
        assert left == pytest.approx(state.power, rel=1e-9)
    # The coolest works; a second one is the thin film from which a seal collapses.
    assert [state.stable for state in found.states] == [True, False][: len(rows)]


@pytest.mark.parametrize("name", COLD)
def test_so_are_the_states_before_anything_is_warm(name):
    cold, (clearance, friction) = warming(scene_of(ROWS[name][0])).cold_state, COLD[name]
    assert (cold.clearance, cold.power - cold.flow_power) == pytest.approx((clearance, friction), rel=TOLERANCE)


def test_film_coefficients_are_those_of_the_warm_film():
    found = warming(scene_of())
    (state,) = found.states
    for rise, clearance, expected in ((0.0, found.cold_state.clearance, 0), (state.rise, state.clearance, 1)):
        k, d = Interface(found.at(rise, clearance), 1e-10).slopes()[:2]
        assert (k[0, 0], k[1, 1], d[1, 1]) == pytest.approx(COEFFICIENTS[expected], rel=TOLERANCE)


@pytest.mark.parametrize(("thins", "fold"), list(enumerate(FOLDS)), ids=["dead", "water"])
def test_the_fold_of_a_seal_pressurised_inside(thins, fold):
    """The speed from which heat has no balance: by counting the states."""
    changes = INSIDE if thins else INSIDE | {"film.liquid": _unthinned()}

    def at(rpm):
        return warming(scene_of(changes, shaft__speed=rpm * RPM))

    low, high = 0.8 * fold, 1.25 * fold
    assert len(at(low).states) == 2 and not at(high).states
    while high - low > 1e-3 * fold:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at(middle).states else (low, middle)
    assert 0.5 * (low + high) == pytest.approx(fold, rel=0.01)
    assert at(high).working() is None


def _unthinned():
    """Water whose viscosity stays that of 30 degC."""
    at = math.exp(-10.57455285 + 552.34120971 / (303.15 - 142.78519617))
    return {"density": 995.6, "specific_heat": 4180.0, "viscosity": [["1 degC", at], ["400 degC", at]]}


@pytest.mark.core
@pytest.mark.parametrize(("s", "ratios"), [(2.7062, [2.2194]), (-0.2, [0.72361, 0.27639])])
def test_a_smooth_film_that_does_not_thin_obeys_the_quadratic(s, ratios):
    """y^2 - y - s = 0 for the coning, and the clearance, over the cold ones; s = (B/G) cold friction / cold coning."""
    changes = {"film.liquid": DEAD, "film.outer_pressure": 1.1e6} if s > 0 else INSIDE | {"film.liquid": DEAD}
    cold = warming(scene_of(changes)).cold_state
    # Friction goes with the square of the speed, which decides s.
    found = warming(scene_of(changes))
    one = found.coning_per_kelvin / found.conductance * (cold.power - cold.flow_power) / cold.coning
    assert one * s > 0.0
    states = warming(scene_of(changes, shaft__speed=math.sqrt(s / one) * found.scene.shaft.speed)).states
    assert [state.coning / cold.coning for state in states] == pytest.approx(ratios, rel=1e-4)
    assert [state.clearance / cold.clearance for state in states] == pytest.approx(ratios, rel=1e-4)


@pytest.mark.parametrize("changes", [{}, INSIDE, ROUGH], ids=["pump", "inside", "rough"])
def test_slow_stiffness_over_fast_is_that_of_the_loops(changes):
    """k_slow/k_fast = (1 - L0)/(1 - L00): L0 with the clearance that follows, L00 with one that is held."""
    found = warming(scene_of(changes))
    state = found.states[0]
    step = 1e-4 * state.clearance

    def force(clearance, rise):
        return found.excess(rise)(clearance)

    def held(clearance):
        """The rise at which heat balances while the clearance is held."""
        near = 0.5 * state.rise, 2.0 * state.rise
        return brentq(lambda rise: found.surplus(found.state(rise, clearance)), *near, xtol=1e-13, rtol=1e-13)

    def slope(value):
        return (value(1) - value(-1)) / 2.0

    slow = slope(lambda n: force(state.clearance + n * step, held(state.clearance + n * step)))
    fast = slope(lambda n: force(state.clearance + n * step, state.rise))
    warmer = 1e-4 * state.rise

    def per_kelvin(quantity, follows):
        """Over the heat that a kelvin takes away, the clearance following or held."""
        rises = [state.rise + n * warmer for n in (1, -1)]
        gaps = [found.clearance(rise, state.clearance) if follows else state.clearance for rise in rises]
        more, less = (getattr(found.state(*at), quantity) for at in zip(rises, gaps, strict=True))
        return (more - less) / (2.0 * warmer) / (found.conductance + state.carried)

    # What the leakage carries away changes with the rise, too.
    left, held_left = (1.0 + state.rise * per_kelvin("carried", follows) for follows in (True, False))
    expected = (left - state.loop_gain) / (held_left - per_kelvin("power", False))
    assert slow / fast == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("changes", "speeds"),
    [({"film.coning": 4e-4}, (308.9, 5e3, 1e4, 1.6e4)), (INSIDE, (300.0, 600.0, 830.0, 838.0))],
    ids=["to the end of the table", "to the fold"],
)
def test_a_state_followed_from_speed_to_speed_is_that_of_a_scan(changes, speeds):
    near = None
    for speed in speeds:
        near = at_work(scene_of(changes), speed, near)[1]
        assert near.rise == pytest.approx(warming(scene_of(changes, shaft__speed=speed)).working().rise, rel=1e-8)
    with pytest.raises(NoWarmState):
        at_work(scene_of(changes), 1.1 * speeds[-1], near)


# --- a run is that of the scene with the warm numbers put in ---------------------------------------------

FILMS = {
    "linear": {"film.model": "linear", "film.coefficients": "radial"},
    "rough": ROUGH,
    "profiled, oil": {
        "film.liquid": VG32, "film.temperature": "60 degC", "film.coning": 2e-4, "film.model": "profiled",
        "film.profile": {"radius": [0.025, 0.0275, 0.03], "depth": [0.0, 5e-8, 0.0]},
    },
}  # fmt: skip


@pytest.mark.parametrize("changes", FILMS.values(), ids=FILMS)
def test_a_run_is_that_with_the_warm_numbers_put_in(changes):
    scenario = warm_seal(changes).with_({"run.turns": 1})
    warm, plain = sealdyn.run(scenario), sealdyn.run(by_hand(scenario))
    assert warm.status == plain.status == "ok"
    one, other = warm.summary, plain.summary
    for part, key in (("film", "clearance"), ("leakage", "mean"), ("friction", "power"), ("h_min", "value")):
        assert one[part][key] == pytest.approx(other[part][key], rel=2e-6), (part, key)
    assert one["stability"]["growth_rate"] == pytest.approx(other["stability"]["growth_rate"], rel=1e-4)
    for name in ("stator_tilt_x", "h_min"):
        found, expected = warm.data[name].values, plain.data[name].values
        assert np.max(np.abs(found - expected)) <= 1e-5 * np.max(np.abs(expected))
    assert one["heat"]["coning"] == pytest.approx(by_hand(scenario).scene.film.coning, rel=1e-12)
    assert "heat" not in other or other["heat"] is None


def test_cells_that_are_looked_for_serve_a_warm_seal_too():
    """Of plain faces they give the radial film; no clearance is given, so that cells are sought where it rides."""
    plain = {
        "film.model": "reynolds",
        "film.reynolds": {"cavitation": "none", "roughness": "none", "grid_accuracy": 1e-3},
        "rotor.runout": 0,
        "stator.misalignment": 0,
    }
    cells, whole = (at_work(sealdyn.example("pump_seal").with_(changes).scene)[1] for changes in (plain, {}))
    for name in ("rise", "clearance", "leakage"):
        assert getattr(cells, name) == pytest.approx(getattr(whole, name), rel=0.01), name


def test_what_is_told_adds_up():
    """Shares are all of the heat; the film's friction, which a run measures, is the heat that the state made."""
    found = sealdyn.run(warm_seal().with_({"run.turns": 1})).summary
    heat = found["heat"]
    assert sum(heat["shares"].values()) == pytest.approx(1.0, rel=1e-9)
    assert heat["power"] == pytest.approx(found["friction"]["power"], rel=5e-3)
    assert heat["face_temperature"] - heat["rise"] == pytest.approx(PUMP["film"]["temperature"])
    assert heat["coning"] - heat["coning_by_heat"] == pytest.approx(PUMP["film"]["coning"])
    assert heat["cold"]["clearance"] == pytest.approx(COLD["pump, 50 urad"][0], rel=TOLERANCE)


@pytest.mark.filterwarnings("error")
def test_faces_too_far_apart_to_squeeze_have_no_slow_eigenvalue():
    assert at_work(sealdyn.example("pump_seal").with_(film__coning=9e12).scene)[1].slow is None


def test_a_slow_eigenvalue_needs_every_time_constant():
    table = warm_seal().to_dict()["film"]["heat"]
    without = {**table, "rotor": {k: v for k, v in table["rotor"].items() if k != "time_constant"}}
    (state,) = warming(scene_of({"film.heat": without})).states
    assert state.slow is None and state.stable
    (whole,) = warming(scene_of()).states
    assert replace(state, slow=whole.slow, stable=whole.stable) == whole


def test_a_run_that_rubs_more_than_the_aligned_film_is_done_again_with_its_friction(tmp_path):
    """A stator too heavy to follow; a run broken off while it is done again goes on to the same end."""
    heavy = {"stator.transverse_inertia": 2e-2, "film.coning": 3e-3, "run.turns": 9, "run.start": "steady"}
    seal, times = warm_seal(heavy), [0.0]
    whole = sealdyn.simulate(seal, tmp_path / "whole.h5")
    counted, run = (whole.summary["heat"]["friction"][key] for key in ("counted", "run"))
    assert counted == pytest.approx(run, rel=2e-3)
    factor = sealdyn.read_scenario(tmp_path / "whole.h5").scene.film.heat.friction
    assert 1.05 < factor < 1.06

    def stop():
        again = any(then < before for before, then in pairwise(times))
        return again and times[-1] < max(times)

    broken = sealdyn.simulate(seal, tmp_path / "broken.h5", progress=lambda t, end: times.append(t), stop=stop)
    assert broken.status == "interrupted"
    assert sealdyn.read_scenario(broken.archive).scene.film.heat.friction == factor
    done = sealdyn.simulate(seal, tmp_path / "broken.h5", resume=True)
    assert done.status == whole.status
    assert done.summary["heat"]["friction"] == whole.summary["heat"]["friction"]
    assert done.summary["h_min"] == whole.summary["h_min"]
    # So is one of many, whose friction nobody asks for.
    many = sealdyn.simulate_many(seal, [{}], ["h_min.value"], workers=1)
    assert many["h_min.value"].item() == pytest.approx(whole.summary["h_min"]["value"], rel=1e-5)
