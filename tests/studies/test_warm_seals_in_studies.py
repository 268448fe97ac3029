"""Studies of a warm seal: at one speed they say what they say of the seal with the warm numbers put in; over the speed
they take the warm film of each."""

import math

import pytest
from warm_seals import ROUGH, by_hand, warm_seal

import sealdyn
from sealdyn import Scenario
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.warm_state import warming
from sealdyn.scene.fluid import in_numbers
from sealdyn.studies.contact_onset import SETTLED

SPEED = 308.923278
SMOOTH = {"film.coning": 4e-4, "run.turns": 2}
SHAKEN = SMOOTH | {"housing": {"axial": [{"frequency": "100 Hz", "acceleration": "5 m/s^2"}]}}
WORN = ROUGH | {"contact": ROUGH["contact"] | {"stator_wear_coefficient": 1e-15}}
# What is not of the seal itself: instants and places of equal extremes, times of computing, words that count roots, and
# thresholds that need other speeds.
ELSEWHERE = {
    "time", "theta", "residual", "seconds", "multipliers", "moment", "critical_speed", "speed_margin", "speeds_held",
    "closing_said", "message", "verdict", "notes", "heat", "balance", "why_none", "tables", "cold_coning",
    "periods_used",
}  # fmt: skip
# Study, seal, settings.
AT_ONE_SPEED = {
    "pressure": (SMOOTH, {"at": "tilt=0.01mrad"}),
    "pressure at a clearance": (SMOOTH, {"at": "clearance=1um", "beside": "2 um"}),
    "steady-state": (SMOOTH, {"approach": []}),
    "contact-onset": (SMOOTH, {"margin": 0.6, "over": "film.outer_pressure", "values": "11 bar"}),
    "contact-onset of rough faces": (ROUGH, {"margin": 0.6, "tolerance": 1e-4}),
    "vibration": (SHAKEN, {"points": 7, "runs": 0}),
    "equilibrium": (SMOOTH, {"points": 11}),
    "equilibrium of rough faces": (WORN, {"points": 11}),
    "load-support": (WORN, {"vary": "contact.roughness=0.1 um"}),
    "wear": (WORN | {"rotor.runout": 0.0}, {"duration": "10 s"}),
    "coefficients": (SMOOTH, {"points": 2, "speed": "308.923278 rad/s"}),
    "sweep": (SMOOTH, {"vary": "rotor.runout=10,20 urad"}),
}


def study(name, scenario, **settings):
    return sealdyn.study(name, scenario, workers=1, **settings).answer


def numbers(found, name=""):
    """{dotted name: number} of an answer, but what is ELSEWHERE."""
    if isinstance(found, dict):
        return {k: v for key, value in found.items() if key not in ELSEWHERE
                for k, v in numbers(value, f"{name}.{key}").items()}  # fmt: skip
    if isinstance(found, list | tuple):
        return {k: v for n, value in enumerate(found) for k, v in numbers(value, f"{name}.{n}").items()}
    return {name: float(found)} if isinstance(found, int | float) and not isinstance(found, bool) else {}


def within(key, largest):
    """How far apart a number may be: a rise is a small difference of means, which settle so well only."""
    return SETTLED if ".rise." in key else 1e-4 * largest[key.rstrip("0123456789.")] + 1e-20


@pytest.mark.parametrize(("changes", "settings"), AT_ONE_SPEED.values(), ids=AT_ONE_SPEED)
def test_at_one_speed_it_is_the_seal_with_the_warm_numbers(changes, settings, request):
    name, scenario = request.node.callspec.id.split(" ")[0], warm_seal(changes)
    found, expected = (numbers(study(name, one, **settings)) for one in (scenario, by_hand(scenario)))
    assert found.keys() == expected.keys() and len(found) > 3
    largest = {}
    for key, value in expected.items():
        column = key.rstrip("0123456789.")
        largest[column] = max(largest.get(column, 0.0), abs(value) if math.isfinite(value) else 0.0)
    apart = {
        key: (found[key], value)
        for key, value in expected.items()
        if not (abs(found[key] - value) <= within(key, largest) or math.isnan(value))
    }
    assert not apart


FASTER = 2.0 * SPEED


def test_coefficients_are_those_of_each_speeds_warm_film():
    scenario = warm_seal(SMOOTH)
    found = study("coefficients", scenario, speed=f"{SPEED},{FASTER} rad/s", points=2)["map"]
    for n, speed in enumerate((SPEED, FASTER)):
        plain = study("coefficients", by_hand(scenario, speed), speed=f"{speed} rad/s", points=2)["map"]
        assert numbers(found["stiffness"][n]) == pytest.approx(numbers(plain["stiffness"][0]), rel=1e-4, abs=1.0)
        assert numbers(found["clearance"][n]) == pytest.approx(numbers(plain["clearance"][0]), rel=1e-6)
    assert found["clearance"][1][0] > 1.02 * found["clearance"][0][0]


def test_a_map_of_stability_has_the_warm_film_of_each_speed():
    scenario = warm_seal(SMOOTH)
    grid = {"x": f"shaft.speed={SPEED}:{FASTER} rad/s:2", "y": "inertia_ratio=0.5:4:2", "confirm": 1}
    found = study("stability", scenario, **grid)
    for n, speed in enumerate((SPEED, FASTER)):
        plain = study("stability", by_hand(scenario, speed), **grid | {"confirm": 0})
        for row, expected in zip(found["growth_rate"], plain["growth_rate"], strict=True):
            assert row[n] == pytest.approx(expected[n], rel=1e-5)
    assert all(point["agrees"] for point in found["confirmed"])


def test_transmissibility_and_whirls_have_the_warm_film_of_each_speed():
    scenario, points = warm_seal(SMOOTH), dict(speed_from=SPEED, speed_to=FASTER)
    found = study("transmissibility", scenario, **points, points=2, time_points=0)
    whirls = study("campbell", scenario, **points, points=2)
    for n, speed in enumerate((SPEED, FASTER)):
        plain = by_hand(scenario, speed)
        expected = study("transmissibility", plain, **points, points=2, time_points=0)
        for seal in ("fmr", "fms", "fmsr"):
            assert found[seal]["total"][n] == pytest.approx(expected[seal]["total"][n], rel=1e-5), (seal, speed)
        if n == 0:
            assert numbers(found["groups"]) == pytest.approx(numbers(expected["groups"]), rel=1e-5)
        # Three speeds at least: the ends.
        slow = max(mode["growth_rate"][-n] for mode in study("campbell", plain, **points, points=2)["modes"])
        assert max(mode["growth_rate"][-n] for mode in whirls["modes"]) == pytest.approx(slow, rel=1e-4)


def test_a_threshold_that_no_film_reaches_is_none():
    """From some speed on there is no warm state: the search ends there, and says so."""
    found = study("critical-speed", warm_seal(SMOOTH), turns=5, speeds=1)
    assert found["eigenvalue"] is None and found["formula"] is None
    last = found["speeds_held"][1]
    assert warming(warm_seal(SMOOTH, shaft__speed=0.99 * last).scene).states
    assert not warming(warm_seal(SMOOTH, shaft__speed=1.01 * last).scene).states


# Studies that compute with the film's own numbers, and a seal of each whose liquid may be given by name.
BY_NAME = (
    ("stability", "fmr_reference", {"confirm": 0}),
    ("equilibrium", "lebeck_elastic", {"points": 5}),
    ("load-support", "run_in", {"vary": "contact.roughness=0.1:0.4um:2"}),
    ("campbell", "fms_reference", {"points": 9}),
)


def _flat(value) -> list[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return [number for one in value for number in _flat(one)]
    return [float(value)] if isinstance(value, int | float) else []


@pytest.mark.parametrize("name, seal, settings", BY_NAME, ids=[row[0] for row in BY_NAME])
def test_a_liquid_by_name_is_its_numbers(name, seal, settings):
    tables = sealdyn.example(seal).to_dict()
    own = {k: v for k, v in tables["film"].items() if k not in ("viscosity", "density", "specific_heat")}
    named = Scenario.from_dict(tables | {"film": own | {"liquid": "water", "temperature": "40 degC"}}, seal)
    film = in_numbers(named.scene.film)
    numbers = {key: getattr(film, key) for key in ("viscosity", "density", "specific_heat", "vapour_pressure")}
    plain = Scenario.from_dict(tables | {"film": own | numbers}, seal)
    by_name, by_numbers = (sealdyn.study(name, scenario, **settings).answer for scenario in (named, plain))
    for key, value in by_numbers.items():
        if isinstance(value, list) and value and key not in ("verdict", "notes", "tables", "panels"):
            # By a formula, or by the film that it is of.
            assert _flat(by_name[key]) == pytest.approx(_flat(value), rel=1e-8, nan_ok=True), key


def test_a_seal_that_starts_from_rest_has_the_warm_states_of_its_speeds():
    """The state of a shaft that stands, without heat, is none to look from."""
    scenario = sealdyn.example("pump_seal")
    ramp = {"time": [0.0, 1.0], "value": [0.0, 300.0]}
    rising = scenario.with_({"shaft.speed": ramp, "run.turns": 1})
    found = Model(rising.scene).at_speed(300.0).heat
    assert found.rise == pytest.approx(Model(scenario.with_({"shaft.speed": 300.0}).scene).heat.rise, rel=1e-6)
