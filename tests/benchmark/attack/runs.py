"""Mutated scenarios that are valid, run for a moment: what is stored is finite, and the motion advances."""

import json
import mmap
import os
import random
import struct
import time
import warnings
from pathlib import Path

import numpy as np

from sealdyn.archive import ArchiveError, column, read_info
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.plausibility import size_of
from sealdyn.simulation.simulate import simulate

from .outcome import PATIENCE, one_line, place
from .scenarios import SCENARIOS, healthy, mutated

# Longest making ready without a word (s): films of many cells, kernels; a run that advances is broken off after LONG.
READY, LONG = 120, 5
TURNS, SAMPLES = 0.5, 24
# Share of the scenes of very many cells that are run with fewer.
FEWER = 0.8
WARM, SHORT = ("fms_reference", "rub", "lebeck_elastic", "rayleigh_pads"), ("run.turns=1e-3",)


def runs(ledger, seed, numbers, folder: Path) -> None:
    """One run for each number."""
    texts = healthy()
    for name in WARM:
        # Kernels that are in this process need not be read by its forks.
        simulate(read_scenario(SCENARIOS / f"{name}.toml", SHORT), folder / "run-0.h5")
    for number in numbers:
        chance = random.Random(f"run {seed} {number}")
        text, scenario = _valid(chance, texts)
        out = folder / f"run-{number}.h5"
        outcome, how = _watched(scenario, out)
        if not how and outcome.startswith("done"):
            how = unsound(out)
        ledger.note("short run", "escaped" if how else outcome, how, text)
        for left in folder.glob(f"run-{number}*"):
            left.unlink()


def _valid(chance, texts):
    """A mutated scenario that is read, and cut short."""
    while True:
        text = mutated(chance, chance.choice(texts))
        try:
            whole = parse_scenario(text, "attack")
            turns, end = size_of(whole).turns, whole.run.duration
            short = [] if turns <= TURNS and whole.run.turns else [f"run.turns={TURNS}"]
            if end is not None:
                share = TURNS / turns if turns > TURNS else 1.0
                short = [f"run.duration='{end * min(share, 1.0)!r} s'"]
            if _many_cells(whole) and chance.random() < FEWER:
                short += ["film.reynolds.cells_r=8", "film.reynolds.cells_theta=72"]
            samples = "run.samples=40" if whole.run.samples is not None else f"run.samples_per_turn={SAMPLES}"
            return text, parse_scenario(text, "attack", [*short, samples])
        except (ScenarioError, SceneError):
            continue


def _many_cells(scenario) -> bool:
    cells = scenario.scene.film.reynolds and scenario.scene.film.reynolds.cells_theta
    return bool(cells) and cells > 72


def _watched(scenario, out) -> tuple[str, str]:
    """How a run in a fork of this process went, which is ended when it says nothing for too long."""
    told, (at, answer) = mmap.mmap(-1, 8), os.pipe()
    child = os.fork()
    if child == 0:
        os.close(at)
        _be_the_run(scenario, out, told, answer)
    os.close(answer)
    since, begun, last, patience = time.monotonic(), None, bytes(8), READY
    while not (done := os.waitpid(child, os.WNOHANG))[0]:
        now = time.monotonic()
        if told[:8] != last:
            last, since, begun, patience = told[:8], now, begun or now, PATIENCE
        if now - since > patience or (begun and now - begun > LONG):
            os.kill(child, 9)
            os.waitpid(child, 0)
            return ("done: still under way", "") if now - since <= patience else ("escaped", "no advance")
        time.sleep(0.005)
    with os.fdopen(at) as answers:
        found = answers.read()
    code = os.waitstatus_to_exitcode(done[1])
    return tuple(json.loads(found)) if found else ("escaped", f"ended by {code}")


def _be_the_run(scenario, out, told, answer):
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        found = _ran(scenario, out, told)
        os.write(answer, json.dumps(found).encode())
    finally:
        os._exit(0)


def _ran(scenario, out, told):
    def progress(done, end):
        told[:8] = struct.pack("d", done)

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return f"done: {simulate(scenario, out, progress=progress).status}", ""
    except (ScenarioError, SceneError, ArchiveError) as error:
        return "refused", one_line(error)
    except Exception as error:
        return "escaped", place(error)


def unsound(path) -> str:
    """What an archive holds that it must not; "" if nothing."""
    if not path.exists():
        return ""
    info = read_info(path)
    for name in info["series"]:
        if not np.isfinite(column(path, name)).all():
            return f"{name} is not finite, status {info['status']}"
    wrong = [name for name, value in _leaves(info["summary"]) if isinstance(value, float) and not np.isfinite(value)]
    return f"in the summary {wrong[0]} is not finite" if wrong else ""


def _leaves(tree, name=""):
    if isinstance(tree, dict | list):
        for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from _leaves(value, f"{name}.{key}")
    else:
        yield name, tree
