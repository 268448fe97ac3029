"""Runs and the onset of contact of drawn scenes (own_scenes.py) against equations in the tests' own words: errors by
name, what was promised, whether the program warned that this is more than was asked, and a number or a word more.

What a run promises: its accuracy, or what its certificate says where that is more and it therefore warns, and beside it
the error of its film's cells, where these stand beside.  Loads of films that tear count at 99 % of the instants.
"""

import tempfile
import time
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from unittest import mock

import numpy as np
import own_films
import own_march
import own_onset
import own_scenes as draw
import own_torn
from own_words import OwnSeal
from patterned_faces import scenario

from sealdyn.simulation import summary
from sealdyn.simulation.simulate import simulate
from sealdyn.studies import contact_onset

# Processor time (s) of one run by own words.
LONGEST = 90.0

BLOCK = 12
BLOCKS = (
    "sealdyn.solvers.sundials_direct.BLOCK", "sealdyn.solvers.own_methods.BLOCK_OF_STEPS",
    "sealdyn.solvers.integrate.MANY",
)  # fmt: skip


def program(scene, turns, accuracy, folder, interrupted=0):
    """A run; `interrupted`: so many times on the way."""
    given = scenario(scene, turns=turns, samples_per_turn=64, accuracy=accuracy, start="rest", duration=None)
    out = Path(folder) / f"{interrupted}.h5"
    # Critical and resonance speeds, which cost more than the run, are not judged.
    parts = partial(summary.parts, speeds=False)
    with mock.patch("sealdyn.simulation.simulate.parts", parts):
        if not interrupted:
            return simulate(given, out)
        # Short runs are one block of steps, and end where one ends.
        with ExitStack() as stack:
            for name in BLOCKS:
                stack.enter_context(mock.patch(name, BLOCK))
            for time_out in range(interrupted):
                stopped = simulate(given, out, stop=lambda: True, resume=time_out > 0)
                assert (
                    stopped.status == "interrupted" and stopped.summary["end"]["time"] < stopped.summary["end"]["asked"]
                )
            return simulate(given, out, resume=True)


def promise(result, cells=False):
    """What a run promises, and whether it warns that this is not what was asked; `cells`: on the same cells."""
    found, grid = result.summary["certificate"], 0.0
    if found.get("grid_asked"):
        grid = max(found["cells"], found["grid_asked"])
    if cells:
        return max(found["asked"], found["solver"] or 0.0), found["solver"] > found["asked"]
    said = found["met"] is not True or result.status != "ok"
    return max(found["asked"], found["estimated"] or 0.0) + grid, said


def series(result, seal):
    """Columns of a run's archive as own_march.columns has them."""
    data = result.data
    motion = [data[name].values / length for name, length in zip(seal.names, seal.lengths, strict=True)]
    motion += [
        data[name + "_rate"].values / (length * seal.rate)
        for name, length in zip(seal.names, seal.lengths, strict=True)
    ]
    outwards = -1.0 if seal.outside else 1.0
    loads = [
        data.film_force,
        data.film_moment_x,
        data.film_moment_y,
        outwards * data.leakage_inner,
        data.friction_torque,
    ]
    return np.column_stack([*motion, *(load.values for load in loads)])


def apart(seal, ours, theirs, torn=False):
    """Largest errors by name of displacements, rates, force, moment, leakage and torque (own_march.columns)."""
    n, gap, force = seal.n, np.abs(ours - theirs), load_of(seal)
    fast = np.maximum(np.abs(ours[:, n : 2 * n]).max(axis=1), 1.0)
    moment = np.hypot(gap[:, 2 * n + 1], gap[:, 2 * n + 2]) / (force * seal.scene.film.outer_radius)
    leakage, torque = (gap[:, k] / (np.abs(ours[:, k]).max() or 1.0) for k in (-2, -1))
    found = {"displacement": gap[:, :n].max(axis=1), "rate": gap[:, n : 2 * n].max(axis=1) / fast,
             "force": gap[:, 2 * n] / force, "moment": moment, "leakage": leakage, "torque": torque}  # fmt: skip
    if torn or (seal.scene.contact and seal.scene.film.model == "reynolds"):
        # Shear in cavities and between asperities is a definition of the program.
        del found["torque"]
    if torn:
        # What jumps counts at 99 %.
        return {k: np.quantile(e, 1.0 if k in ("displacement", "rate") else 0.99) for k, e in found.items()}
    return {k: e.max() for k, e in found.items()}


def load_of(seal):
    """Closing force less the lower pressure (N)."""
    film = seal.scene.film
    return seal.area * seal.balance * abs(film.outer_pressure - film.inner_pressure)


def totals(seal, seen, result):
    """Errors by name of what the summary tells of the whole run."""
    summary, length, load = result.summary, seal.duration, load_of(seal)
    means, found = (
        seen.sums / length,
        {"h_min": abs(summary["h_min"]["value"] - seen.h_min) / seal.scene.film.clearance},
    )
    found["leakage mean"] = abs(abs(means[3]) - summary["leakage"]["mean"]) / abs(means[3])
    rough = seal.scene.contact and seal.scene.film.model == "reynolds"
    if not rough:
        found["friction power"] = abs(summary["friction"]["power"] / means[1] - 1.0)
        found["most power"] = abs(summary["friction"]["max_power"] / seen.most[1] - 1.0)
    if seal.scene.contact:
        contact = summary["contact"]
        found["contact mean"] = abs(contact["force"]["mean"] - means[0]) / load
        found["contact peak"] = abs(contact["force"]["max"] - seen.most[0]) / max(load, seen.most[0])
        spin = seal.scene.shaft.speed - seal.scene.stator.speed
        found["contact energy"] = abs(contact["torque"] * spin - means[2]) / (means[2] if rough else means[1])
    return found


def in_time(scene, turns, accuracy, make, sharp=1e-2, steps=0, interrupted=0, cells=False):
    """Errors by name of a run against `make(scene, duration)` (by BDF in `steps`, or Radau), what was promised, whether
    it was said, and the mean share of the load that asperities carried, or the largest of the face that was torn."""
    with tempfile.TemporaryDirectory() as folder:
        result = program(scene, turns, accuracy, folder)
        carried = result.summary["contact"]["force"]["mean"] if scene.contact else 0.0
        # No rub, or no run.
        if result.status in ("collapsed", "failed") or (
            scene.contact and carried < 0.02 * result.summary["closing"]["force"]
        ):
            return None
        times = result.data.time.values
        seal = make(scene, times[-1])
        start = [result.data[name + rate].values[0] for rate in ("", "_rate") for name in seal.names]
        if steps:
            seen = own_torn.march(seal, start, times, int(steps * turns))
        else:
            kind = own_march.DOP853 if result.summary["model"]["solver"] in ("adams", "dop853") else own_march.Radau
            seen = own_march.march(seal, start, times, sharp * accuracy, kind, time.process_time() + LONGEST)
        ours, theirs = own_march.columns(seal, seen), series(result, seal)
        # What dies away at once is no step of BDF's.
        late = slice(2 if steps else 0, None)
        found = apart(seal, ours[late], theirs[late], bool(steps))
        if not steps:
            found |= totals(seal, seen, result)
        if interrupted:
            going = program(scene, turns, accuracy, folder, interrupted)
            both = apart(seal, theirs[late], series(going, seal)[late], bool(steps))
            found |= {f"continued {k}": e for k, e in both.items()}
            one, other = result.summary, going.summary
            found["continued means"] = max(
                abs(one[a][b] / other[a][b] - 1.0)
                for a, b in (("leakage", "mean"), ("friction", "power"), ("h_min", "value"))
            )
        share = result.data.cavitated_fraction.values.max() if steps else seen.sums[0] / seal.duration / load_of(seal)
        return found, *promise(result, cells), float(share)


def rub(random):
    """A liquid between rough faces that carry a good share of the load."""
    turns = int(random.integers(1, 3))
    scene, turn = draw.seal(
        random, arrangement=str(random.choice(["fmr", "fmsr", "fms"], p=[0.6, 0.3, 0.1])), stiff=(3e5, 4e6)
    )
    scene = draw.rubbing(random, scene, turns * turn)
    # One that sticks is judged by one that creeps.
    sticks = random.random() < 0.3
    scene = draw.with_seal(random, scene, True) if sticks else scene
    found = in_time(scene, turns, draw.logarithmic(random, 3e-4 if sticks else 1e-5, 1e-3), creeping)
    return found if found and found[-1] > 0.02 else None


def gas_rub(random):
    """The same of a gas that stores, and an O-ring."""
    scene, turn = draw.seal(random, draw.gas(random, (6, 24)), str(random.choice(["fmr", "fmsr"])), stiff=(3e5, 4e6))
    scene = draw.with_seal(random, draw.rubbing(random, scene, turn), False)
    # On the program's cells: of so few, and thin films, these would be all that is seen.
    found = in_time(scene, 1.0, draw.logarithmic(random, 1e-3, 1e-2), creeping, cells=True)
    return found if found and found[-1] > 0.01 else None


def creeping(scene, duration):
    """Equations of a scene whose O-ring, if it sticks, creeps instead, a hundred-thousandth as fast as faces move."""
    rings = {}
    for name in ("stator", "rotor"):
        ring = getattr(scene, name)
        if ring.secondary_seal and ring.secondary_seal.law == "coulomb":
            width = 1e-5 * scene.film.clearance * scene.shaft.speed
            rings[name] = replace(ring, secondary_seal=replace(ring.secondary_seal, law="regularised", width=width))
    return OwnSeal(replace(scene, **rings), duration)


def wavy_rub(random):
    """Wavy and rough faces over a liquid between the asperities."""
    scene, turn = draw.seal(random, draw.liquid(random), "fmr", stiff=(3e5, 4e6))
    scene = draw.rubbing(random, draw.waves(random, scene), 0.8 * turn, gaussian=False)
    found = in_time(scene, 0.8, draw.logarithmic(random, 1e-3, 1e-2), lambda *a: own_films.OwnPatterned(*a, (7, 32)))
    return found if found and found[-1] > 0.01 else None


def gas_pads(random):
    """Pads in one face over a gas that stores."""
    scene, _ = draw.seal(random, draw.gas(random, (8, 96)), wide=(0.68, 0.8))
    scene = draw.padded(random, scene)
    return in_time(scene, 0.6, draw.logarithmic(random, 3e-3, 2e-2), lambda *a: own_films.OwnPatterned(*a, (7, 96)))


def gas_waves(random, interrupted=0):
    """Standing waves on a face over a gas that stores."""
    scene, _ = draw.seal(random, draw.gas(random))
    scene = draw.waves(random, scene)
    return in_time(scene, 1.0, draw.logarithmic(random, 3e-3, 2e-2), lambda *a: own_films.OwnPatterned(*a, (8, 32)),
                   interrupted=interrupted)  # fmt: skip


def liquid_waves(random):
    """Standing waves on a face over a liquid that does not tear."""
    scene, _ = draw.seal(random, draw.liquid(random))
    scene = draw.waves(random, scene)
    return in_time(scene, 0.7, draw.logarithmic(random, 1e-3, 1e-2), lambda *a: own_films.OwnPatterned(*a, (8, 40)))


def cavities(random, interrupted=0):
    """A liquid that tears, half of them between wavy faces."""
    scene, _ = draw.seal(random, draw.liquid(random, cavities=True))
    scene = draw.waves(random, scene) if random.random() < 0.5 else scene
    make = partial(own_torn.OwnTorn, cells=(12, 128))
    found = in_time(scene, 0.7, draw.logarithmic(random, 3e-3, 2e-2), make, steps=400, interrupted=interrupted)
    return found if found and found[-1] > 0.005 else None


def onset(random):
    """The onset of contact of a liquid or a gas dam."""
    film = draw.dam(random) if random.random() < 0.6 else None
    scene, _ = draw.seal(random, film, str(random.choice(["fms", "fmr"], p=[0.2, 0.8])))
    key, other = ("rotor.runout", "stator") if scene.stator.support else ("stator.misalignment", "rotor")
    scene = replace(scene, **{other: replace(getattr(scene, other), misalignment=0.0)})
    margin, asked = float(random.uniform(0.02, 0.2)), 1e-5
    point = {"key": key, "margin": margin, "tolerance": asked, "most": 1e6, "set": {}, "floor": False}
    found = contact_onset.onset(scenario(scene, accuracy=1e-6), point)
    if "failed" in found:
        return None
    return {"onset": abs(found["nonlinear"] / own_onset.onset(scene, key, margin) - 1.0)}, 10.0 * asked, False, ""


def gas_continued(random):
    """A gas under waves, interrupted and continued."""
    return gas_waves(random, 2)


def torn_continued(random):
    """A liquid with cavities, interrupted and continued."""
    return cavities(random, 2)


KINDS = (rub, gas_rub, wavy_rub, gas_pads, gas_waves, liquid_waves, cavities, gas_continued, torn_continued, onset)
