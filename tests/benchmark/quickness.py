"""Quick to begin, quick by the thousand: each figure as a ratio beside its goal.

    python tests/benchmark/quickness.py [--repeats 5] [--cold] [--keep FILE.json] [--parts PART ...]

Processor time (user and system) of whole processes over that of importing numba, scipy.integrate, h5py and pydantic, of
runs in one warm process over each other, and of a whole run over the C program of limit.py: both sides take turns, and
the median of the ratios of the pairs counts, so that other work on the machine weighs on both.  --cold: the first runs,
which compile into an empty folder.  Rows of a kept file that are not measured again stay; `gallery.py` prints it.
"""

import argparse
import datetime
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from limit import SCENARIO, build, in_c
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

import sealdyn
import sealdyn.simulation.simulate
from sealdyn.kernel_cache import solvers_digest
from sealdyn.simulation.certificate import no_certificate
from sealdyn.simulation.selection import prepare_run
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.studies.work_precision import machine

ROOT = Path(__file__).parents[2]
IMPORTS = ("-c", "import numba, scipy.integrate, h5py, pydantic")
ONE_KERNEL = ("-c", IMPORTS[1] + "; import numba as nb; from sealdyn.films.radial.film import wrench; "
                                 "wrench.compile((nb.float64[::1], nb.float64[::1]))")  # fmt: skip
# Runs of many: enough that what is done once does not count.
MANY = 100


def of_children(function) -> float:
    """User and system time (s) of the processes that a call starts and waits for."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    function()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def processor_time(words, folder, **environment) -> float:
    """User and system time (s) of one Python process, its byte code kept below the folder."""
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    kept |= {"PYTHONPYCACHEPREFIX": str(Path(folder) / "byte_code"), **environment}
    call = [sys.executable, *words]
    return of_children(lambda: subprocess.run(call, env=kept, cwd=ROOT, check=True, capture_output=True))


def in_process(function) -> float:
    """Processor time (s) of this process for a call."""
    begun = time.process_time()
    function()
    return time.process_time() - begun


def ratio(one, other, repeats) -> dict:
    """Median of one over the other in alternating pairs after a first, which makes ready; and both medians (s)."""
    pairs = [(one(), other()) for _ in range(repeats + 1)][1:]
    ones, others = zip(*pairs, strict=True)
    return {
        "ratio": statistics.median(a / b for a, b in pairs),
        "seconds": statistics.median(ones),
        "over": statistics.median(others),
    }


def of_processes(folder, repeats, cold):
    """What stands before a run computes: later runs, and with `cold` first ones."""

    def run(name, *words, **environment):
        words = ["-m", "sealdyn.cli", "run", f"scenarios/{name}.toml", "--out", f"{folder}/run.h5", *words]
        return lambda: processor_time(words, folder, **environment)

    imports = lambda: processor_time(IMPORTS, folder)  # noqa: E731
    yield "run, kernels kept, without figure / imports", 1.3, ratio(run("fms_reference", "--no-plot"), imports, repeats)
    loaded = lambda: processor_time(ONE_KERNEL, folder)  # noqa: E731
    found = ratio(run("fms_reference", "--no-plot"), loaded, repeats)
    yield "the same / imports and one kernel that is kept", 1.3, found
    yield "run, kernels kept, with figure / imports", 2.0, ratio(run("fms_reference"), imports, repeats)
    goals = {"fms_reference": 11.0, "gas_dam_reference": 14.0} if cold else {}
    for name, goal in goals.items():
        first = processor_time(IMPORTS, folder)
        spent = run(name, "--no-plot", NUMBA_CACHE_DIR=f"{folder}/{name}")()
        over = statistics.median([first, *(processor_time(IMPORTS, folder) for _ in range(2))])
        yield (
            f"first run, {name}, empty folder / imports",
            goal,
            {"ratio": spent / over, "seconds": spent, "over": over},
        )
    if cold and build(folder):
        # A first run of this film and these rings would be a later one, and this the package's build.
        found = ratio(lambda: of_children(lambda: build(folder)), imports, repeats)
        yield "film, rings and loop of the reference in C, compiled / imports", 11.0, found


def of_many(folder, repeats):
    """The model that is chosen over the radial film, in many runs and asked for numbers: of README's pump, whose motion
    a linear film tells."""
    pump = Path(folder) / "pump.toml"
    pump.write_text((ROOT / "README.md").read_text().split("```toml\n", 1)[1].split("```", 1)[0])
    sets = [{"rotor.runout": 1e-6 * (20 + 0.05 * k)} for k in range(MANY)]

    def ways(model):
        scenario = sealdyn.read_scenario(pump, [f"film.model={model}"])
        many = lambda: in_process(lambda: sealdyn.simulate_many(scenario, sets, ("h_min.value",), workers=1))  # noqa: E731
        one = lambda: in_process(lambda: sealdyn.evaluate(scenario, {}, "h_min.value"))  # noqa: E731
        return many, one

    (many, one), (many_radial, one_radial) = ways("auto"), ways("radial")
    yield f"pump of README, {MANY} runs, film auto / radial", 1.0, ratio(many, many_radial, min(repeats, 3))
    yield "pump of README, evaluate, film auto / radial", 1.0, ratio(one, one_radial, 4 * repeats)


def in_c_alone(program, turns, tolerance) -> float:
    """Processor time (s) of one run in C: of ten more repeats in one process, without what it judges itself by."""

    def spent(count):
        words = [program, str(count), str(turns), f"{tolerance:.3e}"]
        return of_children(lambda: subprocess.run(words, check=True, capture_output=True))

    return (spent(11) - spent(1)) / 10


def of_one(folder, repeats):
    """A whole run with archive, audit and certificate over the C program, and what of it is the certificate's."""
    turns, program = 400, build(folder)
    scenario = sealdyn.read_scenario(SCENARIO, [f"run.turns={turns}"])
    whole = lambda: in_process(lambda: sealdyn.simulate(scenario, Path(folder) / "run.h5"))  # noqa: E731
    if program:
        exact = next(10.0**-k for k in (5, 6, 7, 8) if in_c(program, turns, 10.0**-k)[1] <= 1e-6)
        floor = lambda: in_c_alone(program, turns, exact)  # noqa: E731
        yield "simulate, archive, audit and certificate / C at an error of 1e-6", 4.0, ratio(whole, floor, 2 * repeats)
    simulation = sys.modules["sealdyn.simulation.simulate"]
    kept = {name: getattr(simulation, name) for name in ("first_steps", "certificate", "Comparison")}

    def without():
        """The error is neither followed nor told."""
        simulation.first_steps = lambda run, plan: (kept["first_steps"](run, plan)[0], None)
        simulation.certificate = lambda run, plan, outcome, *_: (no_certificate(run.model.accuracy, "-"), outcome)
        simulation.Comparison = lambda run: None
        try:
            return whole()
        finally:
            for name, function in kept.items():
                setattr(simulation, name, function)

    yield "simulate / the same without the error that it follows", 2.0, ratio(whole, without, 2 * repeats)


def of_films(repeats):
    """A run over cells beside what it cannot do without: one factorisation and solution of its own matrix a step."""
    for name, turns in (("gas_reynolds_reference", 10), ("lebeck_n3", 2)):
        scenario = sealdyn.read_scenario(ROOT / "scenarios" / f"{name}.toml", [f"run.turns={turns}"])
        run = prepare_run(scenario)[0]
        done = []

        def whole(run=run, done=done):
            def integrated():
                done[:] = [solve(run.anew(), "ida", run.model.accuracy, Recorder())]

            return in_process(integrated)

        whole()
        segment, outcome = run.segment(), done[0]
        data, rates = np.empty(segment.pattern.nnz), np.zeros(segment.size)
        segment.residual_derivatives(outcome.tau, outcome.y, rates, outcome.counts.steps / run.duration, data)
        kept = csc_array((data, segment.pattern.indices, segment.pattern.indptr), segment.pattern.shape)
        # Works are sums, which no solver need ask for.
        size = segment.film.stop
        matrix, right = kept[:size, :size].tocsc(), np.ones(size)

        def solutions(matrix=matrix, right=right, steps=outcome.counts.steps):
            return in_process(lambda: [splu(matrix).solve(right) for _ in range(steps)])

        found = f"{name}, {turns} turns, {size} unknowns / a sparse solution a step"
        yield found, 3.0, ratio(whole, solutions, min(repeats, 3))


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--repeats", type=int, default=5)
    words.add_argument("--cold", action="store_true", help="the first runs too, which compile")
    words.add_argument("--keep", type=Path, help="JSON file of the table in the gallery")
    words.add_argument("--parts", nargs="+", choices=("begin", "many", "whole", "films"), help="(default all)")
    asked = words.parse_args()
    rows = json.loads(asked.keep.read_text())["rows"] if asked.keep and asked.keep.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        parts = {
            "begin": of_processes(folder, asked.repeats, asked.cold),
            "many": of_many(folder, asked.repeats),
            "whole": of_one(folder, asked.repeats),
            "films": of_films(asked.repeats),
        }
        for part in asked.parts or parts:
            for name, goal, found in parts[part]:
                rows[name] = {"goal": goal, **found}
                seconds = f"{found['seconds']:.4g} s, {found['over']:.4g} s"
                print(f"{name:72s}{found['ratio']:7.2f}  goal {goal:g}   ({seconds})", flush=True)
    if asked.keep:
        on = {"date": f"{datetime.datetime.now():%Y-%m-%d}", **machine(), "load": os.getloadavg()[1],
              "solvers": solvers_digest()}  # fmt: skip
        asked.keep.write_text(json.dumps({"machine": on, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
