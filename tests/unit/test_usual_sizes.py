"""One rule for every key with a unit: a bare number that no seal has is told in one line, others are not."""

import math
import random
from types import SimpleNamespace
from typing import get_type_hints

import pytest
from command import SCENARIOS

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.keys import is_list, tables
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scenario.tables import RadialFile, ScenarioFile
from sealdyn.scene.radial import RadialScene
from sealdyn.simulation.plausibility import unit_warnings
from sealdyn.studies import study_names
from sealdyn.studies._runner import setting_warnings, study_module
from sealdyn.units import ListedQuantity, SampleTime, VaryingQuantity, quantity_of

SEAL = (SCENARIOS / "fms_reference.toml").read_text()
KEYS = [
    (kind, f"{table}.{key}", holds)
    for kind in (ScenarioFile, RadialFile)
    for table, keys in tables(kind).items()
    for key, holds in keys.items()
    if table and (found := quantity_of(holds)) and found.unit != "words"
]


class Radial(RadialScene):
    """One with any tables."""

    def __init__(self, **tables):
        vars(self).update(tables)


def scenario_with(kind, key, value):
    """What has a bare value at a key of the schema, of a list in its first entry, and nothing else."""
    steps, path, held, written = key.split("."), "", value, []
    for step in steps:
        path = f"{path}.{step}".strip(".")
        written.append(step)
        table, _, last = path.rpartition(".")
        if is_list(tables(kind)[table].get(last)):
            written.append("0")
    for step in reversed(written):
        held = [held] if step == "0" else SimpleNamespace(**{step: held})
    scene = Radial(**vars(held)) if kind is RadialFile else held
    return SimpleNamespace(scene=scene, bare={".".join(written)}, **vars(held))


def as_held(holds, quantity, size):
    """A value of a size as a scene has it at a key: alone, as a tuple, over time."""
    kinds = [part for kind in (holds, *getattr(holds, "__args__", ())) for part in getattr(kind, "__metadata__", ())]
    if isinstance(quantity, SampleTime):
        return (0.0, size, 2.0 * size)
    if any(isinstance(part, ListedQuantity) for part in kinds):
        return (0.0, size)
    return PiecewiseLinear((0.0, 1.0), (0.0, size)) if any(isinstance(p, VaryingQuantity) for p in kinds) else size


@pytest.mark.core
def test_every_key_of_the_schema_tells_what_no_seal_has():
    drawn = random.Random(7)
    for kind, key, holds in KEYS:
        quantity = quantity_of(holds)
        low, high, meant = quantity.usual
        beyond = high if math.isfinite(high) else 1.0
        sizes = [(beyond * 10 ** drawn.uniform(0.1, 6), True)]
        if 0.0 < low < math.inf:
            sizes.append((low / 10 ** drawn.uniform(0.1, 6), True))
        if math.isfinite(high):
            sizes += [(math.exp(drawn.uniform(math.log(low or high / 1e6), math.log(high))), False), (0.0, False)]
        for size, told in sizes:
            scenario = scenario_with(kind, key, as_held(holds, quantity, size))
            (name,) = scenario.bare
            said = unit_warnings(scenario)
            assert len(said) == told and all(s.startswith(name) and meant in s for s in said), (key, size, said)


def test_a_unit_that_may_be_meant_is_one():
    for _, key, holds in KEYS:
        quantity = quantity_of(holds)
        if quantity.usual.meant != "%":
            assert float(quantity.as_meant(1.0).split()[0]) != 1.0, key


def told(text):
    return {sentence.split()[0]: sentence for sentence in unit_warnings(parse_scenario(text, "seal.toml"))}


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ("[[housing.axial]]\nfrequency = 60\ndisplacement = 5", "housing.axial.0.displacement"),
        ('[[housing.axial]]\nfrequency = "60 Hz"\nacceleration = 2e4', "housing.axial.0.acceleration"),
        ("[stator.secondary_seal]\nradius = 27\nfriction_force = 5", "stator.secondary_seal.radius"),
        ("[stator.secondary_seal]\ndiameter = 54\nfriction_force = 5", "stator.secondary_seal.diameter"),
        ("[[rotor.axial_runout]]\norder = 2\namplitude = '1 um'\nphase = 90", "rotor.axial_runout.0.phase"),
        ("[application]\nlife = 1500", "application.life"),
        ("[application]\nlowest_speed = 100\nhighest_speed = '9550 rpm'", "application.lowest_speed"),
        ('[housing.motion]\ntime = [0, 1, 2, 3, 4, 500]\naxial = ["0 m", 0, 0, 0, 0, "1 um"]', "housing.motion.time"),
        ('[closing]\nspring_force = { time = [0, 50000], value = ["5 N", "9 N"] }', "closing.spring_force.time"),
        ('[closing]\nspring_force = { time = [0, 5], value = [0, 9e7] }', "closing.spring_force"),
    ],
)  # fmt: skip
def test_bare_numbers_of_a_file(table, key):
    text = SEAL.replace("[closing]", "[closing]\n" + table.removeprefix("[closing]")) if "closing" in table else SEAL
    if text == SEAL:
        text = f"{SEAL}\n{table}\n"
    assert key in told(text) and key not in told(SEAL)


def test_columns_without_a_unit_are_bare_and_others_are_not(tmp_path):
    rows = "\n".join(f"{n},{n % 3}" for n in range(80))
    text = f'{SEAL}\n[housing.motion]\nfile = "m.csv"\n'
    found = []
    for titles in ("time,axial", "time (ms),axial (um)"):
        (tmp_path / "m.csv").write_text(f"{titles}\n{rows}\n")
        found.append(set(unit_warnings_of(text, tmp_path)))
    assert {"housing.motion.time", "housing.motion.axial"} <= found[0] and not found[1]


def unit_warnings_of(text, folder):
    scenario = parse_scenario(text, "seal.toml", path=folder / "seal.toml")
    return [sentence.split()[0] for sentence in unit_warnings(scenario)]


def test_a_unit_that_is_written_later_is_one():
    scenario = parse_scenario(SEAL, "seal.toml", ["film.viscosity=0.8"])
    assert unit_warnings(scenario) and not unit_warnings(scenario.with_({"film.viscosity": "0.8 Pa*s"}))
    assert unit_warnings(scenario.with_({"film.viscosity": 0.9}))
    # Words without a unit are a bare number, whoever gives them.
    fine = parse_scenario(SEAL, "seal.toml")
    assert not unit_warnings(fine) and unit_warnings(fine.with_({"film.viscosity": "0.8"}))


@pytest.mark.core
def test_every_setting_of_a_study_is_under_the_rule():
    """Those with a quantity of their own, alone and in lists."""
    scenario, count = parse_scenario(SEAL, "seal.toml"), 0
    for name in study_names():
        name = name.replace("-", "_")
        kind = study_module(name).Settings
        for setting, holds in get_type_hints(kind, include_extras=True).items():
            if not (quantity := quantity_of(holds)):
                continue
            high = quantity.usual.most if math.isfinite(quantity.usual.most) else 1.0
            for value in (20 * high, [0.0, 20 * high], f"0, {20 * high}", f"0:{20 * high}:3"):
                (said,) = setting_warnings(scenario, name, {setting: value})
                assert said.startswith(f"study.{name}.{setting} ") and quantity.usual.meant in said
            for value in (f"{20 * high} {quantity.unit}", f"0:{20 * high} {quantity.unit}:3", 0.0):
                assert setting_warnings(scenario, name, {setting: value}) == []
            count += 1
    assert count >= 20


@pytest.mark.parametrize(
    ("name", "settings", "count"),
    [
        ("sweep", {"vary": ["film.clearance=5:10:6", "stator.mass=1,2"]}, 1),
        ("sweep", {"vary": ["film.clearance=5:10 um:6", "film.reynolds.cells_r=8,16"]}, 0),
        ("tolerance", {"scatter": "film.coning = normal(5, 0.1)"}, 1),
        ("tolerance", {"scatter": "film.coning = normal(5 mrad, 0.1)"}, 0),
        ("rub", {"key": "film.viscosity", "values": "1:2:5"}, 1),
        ("rub", {"key": "film.viscosity", "values": "1:2 mPa*s:5", "judge": 1}, 1),
        ("runup", {"key": "shaft.speed", "begin": 10, "end": "20 rad/s"}, 1),
        ("contact_onset", {"key": "rotor.runout", "over": "film.clearance", "values": [5, 6]}, 1),
    ],
)
def test_numbers_in_words_of_a_study(name, settings, count):
    said = setting_warnings(parse_scenario(SEAL, "seal.toml"), name, settings)
    assert len(said) == count
