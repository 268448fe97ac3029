"""Random scenes that are hard on a run: speeds through zero and back, faces that rub all the way, waves and pads under
tilted rings; and keys of which each makes a scene of theirs impossible."""

import math
from dataclasses import replace

import families
import numpy as np
from families import PADS, WAVES, Drawn, gas, gas_reynolds, logarithmic, reynolds, wide

from sealdyn.numerics.piecewise_linear import PiecewiseLinear, points
from sealdyn.scene.film import Pads
from sealdyn.scene.forces import HALF_HEIGHT, Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.scene import Initial

# Names of all families, those of families.py too; seals of one kind of film as often as those of several.
FAMILIES = ("wide", "wide", "gas", "reynolds", "gas_reynolds", "patterned", "runup", "rubbing", "tilted_faces")


def one_of(name: str, random) -> Drawn:
    """A scene of a family."""
    return globals().get(name, getattr(families, name, None))(random)


def first(quantity) -> float:
    """A number, or what a table begins with."""
    return quantity.value[0] if isinstance(quantity, PiecewiseLinear) else quantity


def runup(random) -> Drawn:
    """A scene of the other families whose shaft passes through zero and comes back, or stops, stands and starts again
    either way, from rest or from its speed; liquids, gas dams, cavities and gas that stores."""
    made = (wide, wide, gas, reynolds, gas_reynolds)[random.integers(5)]
    drawn = made(random, 8) if made is wide else made(random)
    speed = first(drawn.scene.shaft.speed)
    begun, back = float(random.choice([0.0, 1.0])), float(random.uniform(0.2, 1.0))
    a, b, c, d = (float(t) for t in np.sort(random.uniform(0.05, 0.95, 4)) * drawn.duration)
    if random.random() < 0.5:
        # Still between b and c.
        times, shares = (0.0, a, b, c, d), (begun, 1.0, 0.0, 0.0, float(random.choice([-1.0, 1.0])) * back)
        word = "stop and start"
    else:
        times, shares, word = (0.0, a, b, c), (begun, 1.0, -back, 1.0), "through zero"
    table = PiecewiseLinear(times, tuple(speed * share for share in shares))
    scene = replace(drawn.scene, shaft=replace(drawn.scene.shaft, speed=table))
    words = tuple(w for w in drawn.words if w != "speed table")
    return replace(drawn, scene=scene, words=(*words, word))


def meeting(depth: float) -> float:
    """Share of the face where Christensen's asperities meet: those beyond `depth` half heights, in (-1, 1)."""
    density = np.poly1d([-1.0, 0.0, 1.0]) ** 3 * (35.0 / 32.0)
    whole = density.integ()
    return float(whole(1.0) - whole(depth))


def rubbing(random) -> Drawn:
    """A scene of `wide`, `gas` or `reynolds` whose aligned faces ride on their asperities, which carry a tenth to nine
    tenths of what presses on the face."""
    made = (wide, wide, gas, reynolds)[random.integers(4)]
    drawn = made(random, 10) if made is wide else made(random)
    film = drawn.scene.film
    depth, share = float(random.uniform(0.15, 0.75)), float(random.uniform(0.1, 0.9))
    # The faces are at most as conical as their asperities are high, so that these meet somewhere and rub.
    width, half = film.outer_radius - film.inner_radius, film.clearance / depth
    slope = float(np.clip(first(film.coning), -0.3 * film.clearance / width, 0.5 * (half - film.clearance) / width))
    pressed = 0.5 * (first(film.inner_pressure) + first(film.outer_pressure)) + 1e5
    strength = share / (1.0 - share) * pressed / meeting(depth)
    rough = Contact(roughness=half / HALF_HEIGHT, compressive_strength=strength,
                    friction_coefficient=float(random.uniform(0.02, 0.3)))  # fmt: skip
    scene = replace(drawn.scene, film=replace(film, coning=slope), contact=rough, initial=Initial())
    if film.model == "reynolds" and random.random() < 0.5:
        wave = Waviness(int(random.integers(2, 6)), film.clearance * logarithmic(random, 0.05, 0.5))
        scene = replace(scene, stator=replace(scene.stator, waviness=[wave] if scene.stator.speed == 0.0 else []))
    words = {
        "contact": None,
        **dict.fromkeys(w for w in drawn.words if w not in ("rub", "throw", "rest", "steady")),
        "riding": None,
        "rest": None,
    }
    return replace(drawn, scene=scene, start="rest", words=tuple(words))


def tilted_faces(random) -> Drawn:
    """A scene of `reynolds` or `gas_reynolds` with waves of several orders or sets of pads, under rings that tilt."""
    liquid = bool(random.random() < 0.5)
    while (drawn := reynolds(random) if liquid else gas_reynolds(random)).scene.stator.speed != 0.0:
        pass
    scene, film, words = drawn.scene, drawn.scene.film, [word for word in drawn.words if word != "waves"]
    if liquid or random.random() < 0.5:
        orders, height = WAVES[random.integers(len(WAVES))], film.clearance * logarithmic(random, 0.05, 0.3)
        waves = [Waviness(order, height, float(random.uniform(0, 6))) for order in orders]
        scene, words = replace(scene, stator=replace(scene.stator, waviness=waves)), [*words, f"waves {orders}"]
    else:
        counts, width = PADS[random.integers(len(PADS))], film.outer_radius - film.inner_radius
        size = dict(inner_radius=film.inner_radius, outer_radius=film.outer_radius, edge=0.24 * width)
        pads = [Pads(count, film.clearance * logarithmic(random, 0.1, 1.0), float(random.uniform(1.5, 3.0)) / count,
                     phase=float(random.uniform(0, 6)), **size) for count in counts]  # fmt: skip
        cells = replace(film.gas_reynolds, cells=(6, 60))
        stator = replace(scene.stator, waviness=[])
        scene = replace(scene, film=replace(film, pads=pads, gas_reynolds=cells), stator=stator)
        words = [*words, f"pads {counts}"]
    return replace(drawn, scene=scene, words=tuple(words))


def impossible(random, drawn) -> dict:
    """Keys and values, by what is wrong with them, of which each makes a drawn scene one that cannot be."""
    scene, film = drawn.scene, drawn.scene.film
    width, floating = film.outer_radius - film.inner_radius, "stator" if scene.stator.support else "rotor"
    ring, other = getattr(scene, floating), "misalignment" if floating == "rotor" else "runout"
    fixed = {"rotor": "stator", "stator": "rotor"}[floating]
    lowest = min(min(points(p)) for p in (film.inner_pressure, film.outer_pressure))
    half, steep = 0.5 * drawn.duration, film.clearance / film.inner_radius
    return {
        "radii crossed": {"film.inner_radius": film.outer_radius * (1.0 + random.uniform(0.0, 0.2))},
        "no clearance": {"film.clearance": -film.clearance * random.choice([0.0, 1.0])},
        "coned shut": {"film.coning": -film.clearance / width * random.uniform(1.01, 3.0)},
        "tilted shut": {f"{fixed}.{other}": steep * random.uniform(20.0, 30.0)} if not getattr(scene, fixed).support
        else {"initial.stator.tilt_x": steep * random.uniform(20.0, 30.0)},
        "exact motion": {"run.solver": "expm", "film.model": film.model.replace("auto", "radial")},
        "no such cells": {"run.solver": "trbdf2"} if film.model != "reynolds" else {"run.solver": "adams"},
        "thin disk": {f"{floating}.polar_inertia": 2.1 * ring.transverse_inertia},
        "torn from the start": {"film.cavitation_pressure": lowest + 1e3},
        "three of three": {"closing.balance_ratio": 0.8, "closing.spring_force": 50.0},
        "no accuracy": {"run.accuracy": random.choice([0.0, -1e-6, 2.0, math.nan])},
        "no number": {"shaft.speed": random.choice([math.nan, math.inf])},
        "still for a turn": {"shaft.speed": 0.0, "run.turns": 2.0},
        "a step of a face": {f"{floating}.misalignment": PiecewiseLinear((0.0, half, half), (0.0, 0.0, steep))},
        "no mass beside inertia": {f"{floating}.transverse_inertia": 0.0, f"{floating}.polar_inertia": 1e-5},
        "no time": {"run.duration": -half},
        "crests that cross": {"film.clearance": film.clearance, "stator.waviness": [
            {"order": 3, "amplitude": 30.0 * film.clearance}]},
    }  # fmt: skip
