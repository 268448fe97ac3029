"""How honest are runs and their certificates over grooves?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/grooved_honesty.py [scenes] [seed] [processes]

Random seals with spiral grooves, T-grooves or pads in either face, of gases and liquids, FMS and FMR, forced by runout
and misalignment, flat and coned, from rest and from the steady state.  A run is done as `sealdyn run` does it; the
truth is a sharper run on three times as many columns; the order of the grooves' tips says how much of the difference is
left.  Honest: every quantity of the certificate is right within the asked accuracy, or the run says that it is not.
"""

import math
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from families import Drawn, logarithmic
from honesty import automatic, in_order
from judge import TooLong, by_steps, instants
from scenes import prepared

from sealdyn.scene.checks import scene_errors
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film, Reynolds
from sealdyn.scene.fluid import GasReynolds
from sealdyn.scene.patterns import Grooves
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene, SceneError
from sealdyn.simulation.verification_run import QUANTITIES, ErrorScales

SEED, SCENES, FINER, LONGEST = 2035, 30, 3, 240.0
# How much sharper the truth is: of many columns the rates of rings are a small part of what steps are chosen by.
SHARPER = 300.0
# Least order of the meshes in all cases of use.
TIPS = 1.2
RUN = type("Run", (), {"duration": 1.0, "start": "rest", "turns": None})()


def grooved(random) -> Drawn:
    """A seal with one row of grooves, over few turns."""
    log, uniform = partial(logarithmic, random), lambda *ends: float(random.uniform(*ends))
    r_o, clearance, speed = uniform(0.03, 0.08), log(2e-6, 8e-6), log(100.0, 1500.0)
    r_i, gas, columns = r_o * uniform(0.78, 0.9), random.random() < 0.6, int(random.integers(4, 8))
    shape, face = str(random.choice(["spiral", "spiral", "tee", "pad"])), str(random.choice(["rotor", "stator"]))
    inside = random.random() < 0.3
    low, high = (r_i, r_i + uniform(0.4, 0.7) * (r_o - r_i)) if inside else (r_o - uniform(0.4, 0.7) * (r_o - r_i), r_o)
    given = {"share": uniform(0.3, 0.6), "shape": shape}
    if shape == "spiral":
        given["angle"] = math.radians(float(random.choice([-1, 1])) * uniform(10.0, 40.0))
    if shape == "tee":
        high = r_o - 0.3 * (r_o - low)
        given |= {"stem_outer_radius": r_o, "stem_share": 0.5 * given["share"]}
    row = Grooves(int(random.integers(3, 8)), clearance * log(0.3, 3.0), low, high, **given)
    ends = [1e5, 1e5 + log(1e4, 2e6)][:: 1 if random.random() < 0.7 else -1]
    fluid = {"gas": "air", "temperature": uniform(280.0, 400.0), "gas_reynolds": GasReynolds(columns=columns)}
    liquid = {"viscosity": log(2e-4, 3e-3), "reynolds": Reynolds(columns=columns, cavitation="none")}
    film = Film(r_i, r_o, ends[1], ends[0], clearance=clearance, coning=float(random.choice([0.0, 1.0]))
                * uniform(-0.3, 1.0) * clearance / (r_o - r_i), **(fluid if gas else liquid))  # fmt: skip
    mass, tilt = log(0.03, 0.5), clearance / r_o
    support = Support(axial_stiffness=log(1e4, 2e5), axial_damping=log(30.0, 1000.0), radius=0.5 * (r_i + r_o))
    inertia = 0.5 * mass * r_o**2
    ring = {"mass": mass, "transverse_inertia": inertia, "polar_inertia": 2.0 * inertia, "support": support}
    floats = str(random.choice(["stator", "stator", "rotor"]))
    own = {"rotor": {"runout": tilt * log(0.01, 0.4)}, "stator": {"misalignment": tilt * log(0.01, 0.4)}}
    if floats == "rotor":
        own = {"rotor": {"misalignment": tilt * log(0.01, 0.4)}, "stator": {"misalignment": tilt * log(0.01, 0.4)}}
    own[floats] |= ring
    own[face]["grooves"] = [row]
    scene = Scene(shaft=Shaft(speed=speed), film=film, rotor=Rotor(**own["rotor"]), stator=Stator(**own["stator"]))
    words = ("gas" if gas else "liquid", shape, face, floats, f"{row.count} x {columns}")
    turns = uniform(1.0, 4.0)
    return Drawn(scene, turns * 2.0 * math.pi / speed, log(1e-2, 1e-1), str(random.choice(["rest", "steady"])), words)


def judge(number, seed=SEED) -> dict:
    """What one scene shows."""
    random = np.random.default_rng([seed, number])
    drawn = grooved(random)
    row = {"number": number, "words": drawn.words, "accuracy": drawn.accuracy}
    if errors := scene_errors(drawn.scene, RUN):
        return {**row, "why": f"no scene: {errors[0]}"}
    film = drawn.scene.film
    name = "reynolds" if film.gas is None else "gas_reynolds"
    options = getattr(film, name)
    fine = replace(options, columns=FINER * options.columns)
    try:
        scene, sharper = replace(drawn.scene, film=replace(film, **{name: fine})), drawn.accuracy / SHARPER
        reference = prepared(scene, drawn.duration, sharper, drawn.start)
        reference.check_start()
        times = instants(random, reference, 120)
        run, _, found, outcome, columns, *_ = automatic(drawn, times)
    except (SceneError, ValueError, ArithmeticError) as error:
        return {**row, "why": f"no run: {error}"}
    row |= {"status": str(outcome.status), "met": found["met"], "estimated": found["estimated"]}
    try:
        until = time.process_time() + LONGEST
        known, _ = by_steps(reference, ErrorScales(reference), times, "ida", sharper, until)
    except TooLong:
        return {**row, "why": "the truth takes too long"}
    rows = min(len(known), len(columns))
    if not rows:
        return {**row, "why": "nothing to compare"}
    if found["horizon"]:
        rows = min(rows, int(np.searchsorted(times, found["horizon"])))
    known = in_order(run.model, reference.model, known)
    errors = ErrorScales(run).errors(columns[:rows], known[:rows]).max(axis=0, initial=0.0)
    return {**row, "errors": errors / (1.0 - FINER**-TIPS), "compared": rows / len(times)}


def said(row) -> str:
    """One line about a scene."""
    start = f"{row['number']} {','.join(row['words'])} asked {row['accuracy']:.1e}"
    if "errors" not in row:
        return f"{start} not judged: {row['why']}"
    worst = int(np.argmax(row["errors"]))
    most, spoken = row["errors"][worst] / row["accuracy"], row["status"] != "ok" or row["met"] is not True
    verdict = "right" if most <= 1.0 else "SAID" if spoken else "WRONG"
    estimated = (row["estimated"] or math.nan) / row["accuracy"]
    return (f"{start} {verdict}: {most:.2g} of it ({QUANTITIES[worst]}), estimated {estimated:.2g}, {row['status']}, "
            f"{100 * row['compared']:.0f} % of the instants")  # fmt: skip


if __name__ == "__main__":
    scenes, seed, processes = (*map(int, sys.argv[1:]), *(SCENES, SEED, 2)[len(sys.argv) - 1 :])
    with ProcessPoolExecutor(processes) as pool:
        lines = []
        for line in map(said, pool.map(partial(judge, seed=seed), range(scenes))):
            lines.append(line)
            print(line, flush=True)
    print({word: sum(word in line for line in lines) for word in ("right", "SAID", "WRONG", "not judged")})
