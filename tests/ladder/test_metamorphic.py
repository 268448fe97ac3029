"""What a seal's motion does not depend on: where angles are counted from, which way the shaft turns, units of length,
time and mass, which ring is called rotor, how often a run is sampled, the order of keys.

Random scenes of all families (tests/families.py), and some with waves, pads and contact; each is run twice, as it is
and changed, and whatever the run amounts to must come out alike within its accuracy.
"""

import math
import tomllib
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import get_type_hints

import numpy as np
import pytest
import tomlkit
from families import gas, gas_reynolds, reynolds, wide
from scenes import fmsr

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import Scenario, parse_scenario
from sealdyn.scenario.tables import Run
from sealdyn.scenario.templates import shipped_paths
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Pads, Reynolds
from sealdyn.scene.fluid import gas_of
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor
from sealdyn.scene.scene import Initial, RingStart, Scene
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.unit_names import dimension_and_factor
from sealdyn.units import quantity_of

ACCURACY = 1e-5
FAMILIES = {"liquid": wide, "gas dam": gas, "gas film": gas_reynolds, "cavities": reynolds}
# An angle (rad) that no symmetry knows; with cells the nearest that carries cells onto cells.
ANGLE = 0.7
# New unit of length, time and mass in metres, seconds and kilograms.
UNITS = {"[length]": 2.5, "[time]": 0.4, "[mass]": 1.7}


def drawn(family, seed):
    """A scene without dry friction, its duration (s), half a turn at most."""
    random = np.random.default_rng(seed)
    while not (made := FAMILIES[family](random)).smooth:
        pass
    return made.scene, shortened(made)


def shortened(made):
    """Duration (s) of a drawn scene, half a turn at most."""
    speed = made.scene.shaft.speed
    speed = speed.value[0] if isinstance(speed, PiecewiseLinear) else speed
    return min(made.duration, math.pi / abs(speed))


def floating_stator(family):
    """A scene of a family in which only the stator floats, and its duration (s), half a turn at most."""
    random = np.random.default_rng(3)
    while "fms" not in (made := FAMILIES[family](random)).words:
        pass
    return made.scene, shortened(made)


def wavy():
    """A floating stator with waves of two orders, in oil with cavities."""
    scene, duration = floating_stator("cavities")
    low = scene.film.clearance
    waves = [Waviness(2, 0.2 * low, 0.4), Waviness(3, 0.1 * low, -0.8)]
    film = replace(scene.film, reynolds=Reynolds(cells_r=5, cells_theta=36, grid_accuracy=1.0))
    return replace(scene, film=film, stator=replace(scene.stator, waviness=waves)), duration


def padded():
    """A floating stator with three pads, in gas."""
    scene, duration = floating_stator("gas film")
    film = scene.film
    middle, half = 0.5 * (film.inner_radius + film.outer_radius), 0.3 * (film.outer_radius - film.inner_radius)
    pads = Pads(3, 0.5 * film.clearance, 1.0, middle - half, middle + half, half, 0.3)
    film = replace(film, pads=[pads], gas_reynolds=replace(film.gas_reynolds, cells=(10, 36)))
    return replace(scene, film=film, stator=replace(scene.stator, waviness=[])), duration


def touching():
    """A ring thrown at its mate: contact, from a start of its own."""
    initial = Initial(stator=RingStart(z_rate=-0.02, tilt_x_rate=3.0, tilt_y_rate=-2.0))
    rough = Contact(roughness=0.5e-6, compressive_strength=1e9, friction_coefficient=0.1)
    return replace(fmsr(own=4e-5), initial=initial, contact=rough), 2 * 2 * math.pi / 1000.0


SCENES = {
    **{f"{family} {seed}": (drawn, family, seed) for family in FAMILIES for seed in (1, 3)},
    "waves": (wavy,),
    "pads": (padded,),
    "contact": (touching,),
}


def run(scene, duration, samples=40, accuracy=ACCURACY):
    return simulate_in_memory(Scenario(scene, Run(duration=duration, samples=samples, accuracy=accuracy)))


@cache
def as_it_is(name):
    """A scene, its duration (s), and its run, to which the three changed ones are held."""
    scene, duration = SCENES[name][0](*SCENES[name][1:])
    if scene.film.gas is not None:
        # By its numbers, which have units; by its name the gas would stay what it is in a similar scene.
        scene = replace(scene, film=replace(scene.film, gas=gas_of(scene.film)))
    return scene, duration, run(scene, duration)


def alike(scene, one, other, times=None):
    """Whether two runs amount to the same: lengths to the clearance, tilts to clearance over radius, flow to its most,
    power to itself; those of the second are `times` (name -> factor) as large."""
    times, low = times or {}, one["film"]["clearance"]
    scales = {("h_min", "value"): low, ("relative_misalignment", "max"): low / scene.film.outer_radius,
              ("relative_misalignment", "mean"): low / scene.film.outer_radius,
              ("leakage", "mean_kg_per_h"): _largest_flow(one), ("friction", "power"): None}  # fmt: skip
    assert one["status"] == other["status"]
    for path, scale in scales.items():
        a, b = (found[path[0]][path[1]] for found in (one, other))
        if a is None or b is None:
            assert a == b, path
            continue
        assert b / times.get(path, 1.0) == pytest.approx(a, abs=30 * ACCURACY * (scale or abs(a))), path


def _largest_flow(found) -> float:
    """Of a run (kg/h)."""
    flow = found["leakage"]
    return abs(flow["mean_kg_per_h"]) * max(abs(flow["max"] / flow["mean"]), 1.0)


def turned(scene, by):
    """All of a scene turned by an angle (rad) about the shaft."""
    film, stator, rotor, housing, initial = scene.film, scene.stator, scene.rotor, scene.housing, scene.initial

    def waves(ring):
        return [replace(wave, phase=wave.phase - wave.order * by) for wave in ring.waviness]

    def start(ring):
        (x, y), (vx, vy) = (ring.tilt_x, ring.tilt_y), (ring.tilt_x_rate, ring.tilt_y_rate)
        tilt, rate = (complex(a or 0, b or 0) * np.exp(1j * by) for a, b in ((x, y), (vx, vy)))
        given = dict(tilt_x=tilt.real, tilt_y=tilt.imag) if (x, y) != (None, None) else {}
        return replace(ring, **given, tilt_x_rate=rate.real, tilt_y_rate=rate.imag)

    if initial.given:
        initial = replace(initial, **{k: start(getattr(initial, k)) for k in ("rotor", "stator")})
    return replace(
        scene,
        film=replace(film, pads=[replace(row, phase=row.phase + by) for row in film.pads]),
        stator=replace(stator, misalignment_direction=stator.misalignment_direction + by, waviness=waves(stator)),
        rotor=replace(rotor, misalignment_phase=rotor.misalignment_phase + by, runout_phase=rotor.runout_phase + by,
                      waviness=waves(rotor)),
        shaft=replace(scene.shaft, whirl=[replace(w, phase=w.phase + by) for w in scene.shaft.whirl]),
        housing=replace(housing, angular=[replace(t, direction=t.direction + by) for t in housing.angular]),
        initial=initial,
    )  # fmt: skip


def negative(value):
    """Of a number, or of one that follows time."""
    return replace(value, value=tuple(-v for v in value.value)) if isinstance(value, PiecewiseLinear) else -value


def mirrored(scene):
    """A scene seen in a mirror that holds the x axis: angles and speeds of rotation change their sign, and a tilt
    about x, which is an axial vector, too."""
    film, stator, rotor, housing, initial = scene.film, scene.stator, scene.rotor, scene.housing, scene.initial

    def angles(part, *names):
        return replace(part, **{name: negative(getattr(part, name)) for name in names})

    def waves(ring):
        return [angles(wave, "phase") for wave in ring.waviness]

    def start(ring):
        given = {k: negative(getattr(ring, k)) for k in ("tilt_x", "tilt_x_rate") if getattr(ring, k) is not None}
        return replace(ring, **given)

    # The mirror turns a tilt at an angle into one at pi less it.
    tilts = {"misalignment_direction", "misalignment_phase", "runout_phase", "direction", "phase"}

    def tilt(part, *names):
        assert set(names) <= tilts
        return replace(part, **{name: math.pi - getattr(part, name) for name in names})

    if initial.given:
        initial = replace(initial, **{k: start(getattr(initial, k)) for k in ("rotor", "stator")})
    return replace(
        scene,
        film=replace(film, pads=[angles(row, "phase") for row in film.pads]),
        stator=replace(tilt(stator, "misalignment_direction"), waviness=waves(stator), speed=negative(stator.speed)),
        rotor=replace(tilt(rotor, "misalignment_phase", "runout_phase"), waviness=waves(rotor)),
        # Whirl is counted with the shaft's angle: the same ratio.
        shaft=replace(scene.shaft, speed=negative(scene.shaft.speed),
                      whirl=[tilt(w, "phase") for w in scene.shaft.whirl]),
        housing=replace(housing, angular=[tilt(t, "direction") for t in housing.angular]),
        initial=initial,
    )  # fmt: skip


def factor(unit):
    """How a number of an SI unit changes with the units of UNITS."""
    dimension, _ = dimension_and_factor(unit)
    return math.prod(UNITS.get(name, 1.0) ** float(power) for name, power in dimension)


def scaled(part, time=UNITS["[time]"]):
    """A scene in which every number with a unit is that of a seal of another size: similar in length, time, mass."""
    changes = {}
    for name, holds in get_type_hints(type(part), include_extras=True).items():
        if name == "__pydantic_config__":
            continue
        value, quantity = getattr(part, name), quantity_of(holds)
        times = factor(quantity.unit) if quantity else 1.0
        if isinstance(value, PiecewiseLinear):
            changes[name] = PiecewiseLinear(tuple(time * t for t in value.time), tuple(times * v for v in value.value))
        elif is_dataclass(value):
            changes[name] = scaled(value)
        elif isinstance(value, list):
            changes[name] = [scaled(entry) for entry in value]
        elif isinstance(value, float | int) and quantity:
            changes[name] = times * value
    return replace(part, **changes)


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_turned_about_the_shaft(name):
    scene, duration, found = as_it_is(name)
    cells = scene.film.gas_reynolds.cells[1] if scene.film.gas_reynolds else None
    cells = scene.film.reynolds.cells_theta if scene.film.reynolds else cells
    step = 2 * math.pi / cells if cells else ANGLE
    alike(scene, found, run(turned(scene, step * max(round(ANGLE / step), 1)), duration))


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_in_a_mirror(name):
    scene, duration, found = as_it_is(name)
    alike(scene, found, run(mirrored(scene), duration))


@pytest.mark.parametrize("name", SCENES)
def test_a_similar_scene(name):
    scene, duration, found = as_it_is(name)
    times = {("h_min", "value"): factor("m"), ("leakage", "mean_kg_per_h"): factor("kg/s"),
             ("friction", "power"): factor("W")}  # fmt: skip
    alike(scene, found, run(scaled(scene), factor("s") * duration), times)


def test_every_number_with_a_unit_is_scaled():
    """A field that `scaled` passed over would make its scenes unlike."""
    assert {field.name for field in fields(Scene)} == {
        "shaft", "film", "rotor", "stator", "housing", "closing", "initial", "contact"
    }  # fmt: skip
    assert factor("N*m*s/rad") == pytest.approx(UNITS["[mass]"] * UNITS["[length]"] ** 2 / UNITS["[time]"])


@pytest.mark.core
def test_rings_that_change_their_names():
    """Two floating rings that turn, seen from the other end of the shaft: each is the other."""
    scene = fmsr(rotor_stiffer=2.0, own=3e-5, fixed=5e-5)
    scene = replace(scene, stator=replace(scene.stator, speed=-400.0, misalignment_direction=0.4))
    rotor, stator, shaft = scene.rotor, scene.stator, scene.shaft
    common = ("mass", "transverse_inertia", "polar_inertia", "misalignment", "support")
    other = replace(
        scene,
        shaft=Shaft(speed=-stator.speed),
        rotor=Rotor(**{k: getattr(stator, k) for k in common}, misalignment_phase=-stator.misalignment_direction),
        stator=replace(stator, **{k: getattr(rotor, k) for k in common}, speed=-shaft.speed,
                       misalignment_direction=-rotor.misalignment_phase),
    )  # fmt: skip
    duration = 3 * 2 * math.pi / 1000.0
    alike(scene, run(scene, duration), run(other, duration))


def backwards(value):
    """A table with its keys in the other order, and so those within it; lists stay."""
    if isinstance(value, dict):
        return {key: backwards(held) for key, held in reversed(value.items())}
    return [backwards(entry) for entry in value] if isinstance(value, list) else value


def test_the_order_of_keys_says_nothing():
    for path in shipped_paths().values():
        text = path.read_text()
        turned = tomlkit.dumps(backwards(tomllib.loads(text)))
        assert turned != text
        one, other = (parse_scenario(words, path.name, path=path) for words in (text, turned))
        assert other.scene == one.scene and other.run == one.run
