"""Ten thousand short runs: python tests/benchmark/many_runs.py [--runs 10000] [--turns 40] [--repeats 2]

The reference FMS seal with as many values of runout and misalignment, on one process and on all cores in turns: wall
time with end states only, with located extremes, and with samples too; beside them the C program of limit.py at equal
error, run after run on one core, in turns with them; and the memory of a worker.  On a busy machine the processor time
of one process tells more.
"""

import argparse
import os
import resource
import tempfile
import time

import numpy as np
from limit import SCENARIO, build, in_c

import sealdyn

WAYS = {"end state": (),
        "end state, thinnest film, largest tilt": ("h_min.value", "relative_misalignment.max"),
        "leakage too, from samples": ("h_min.value", "leakage.mean")}  # fmt: skip


def sets(count):
    draw = np.random.default_rng(1)
    runout, own = draw.uniform(5e-6, 5e-5, (2, count))
    return [{"rotor.runout": float(a), "stator.misalignment": float(b)} for a, b in zip(runout, own, strict=True)]


def wall(scenario, many, outputs, workers):
    """Wall time and, of one process alone, processor time (s)."""
    begun = time.perf_counter(), time.process_time()
    data = sealdyn.simulate_many(scenario, many, outputs, workers=workers)
    assert (data["status"] == "ok").all()
    return np.array([time.perf_counter() - begun[0], time.process_time() - begun[1]])


def in_turns(program, turns):
    """Least wall time (s) of a run in C at an error of 1e-6, of a few tries; infinite without the program."""
    tried = [in_c(program, turns, 10.0**-k) for _ in range(5) for k in (5, 6, 7, 8)] if program else []
    return min((wall for wall, error in tried if error <= 1e-6), default=np.inf)


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--runs", type=int, default=10_000)
    words.add_argument("--turns", type=int, default=40)
    words.add_argument("--repeats", type=int, default=2)
    asked = words.parse_args()
    scenario = sealdyn.read_scenario(SCENARIO, [f"run.turns={asked.turns}"])
    many, cores = sets(asked.runs), os.cpu_count()
    with tempfile.TemporaryDirectory() as folder:
        program, floor = build(folder), np.inf
        walls = {name: {1: np.full(2, np.inf), cores: np.full(2, np.inf)} for name in WAYS}
        for outputs in WAYS.values():
            wall(scenario, many[:64], outputs, cores)
        for _ in range(asked.repeats):
            for name, outputs in WAYS.items():
                # The machine may be slower at one time than at another: C and all ways take turns.
                floor = min(floor, in_turns(program, asked.turns))
                for workers in walls[name]:
                    found = wall(scenario, many, outputs, workers)
                    walls[name][workers] = np.minimum(walls[name][workers], found)
    if program:
        print(f"C, one run of {asked.turns} turns at error 1e-6: {floor * 1e3:.2f} ms; {asked.runs} of them on {cores} "
              f"cores {floor * asked.runs / cores:.1f} s")  # fmt: skip
    for name, found in walls.items():
        (one, alone), (many_wall, _) = found[1], found[cores]
        told = f"{name}: {one:.1f} s on one process, {many_wall:.1f} s on {cores}, {one / many_wall:.2f} times faster"
        if program:
            c = floor * asked.runs
            told += f"; times C: {many_wall * cores / c:.2f} on {cores}, {alone / c:.2f} in processor time on one"
        print(told)
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"largest process: {most:.0f} MB")


if __name__ == "__main__":
    main()
