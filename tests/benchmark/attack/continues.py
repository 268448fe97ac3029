"""Runs over scenes and methods, killed at any moment and gone on with: to the bit the run that nobody killed."""

import os
import random
import signal
import time
from itertools import product
from pathlib import Path

from continued import SCENARIOS, differences, often

from sealdyn.archive import partial_path
from sealdyn.scenario.reader import ScenarioError, read_scenario
from sealdyn.simulation.simulate import simulate

METHODS = ("adams", "bdf", "ida", "dop853", "radau", "auto")
# Scenes, and how they are cut short.
SCENES = {
    "fms_reference": ("run.turns=40",),
    "fmr_reference": ("run.turns=40",),
    "fmsr_both_flexible": ("run.turns=20",),
    "massless_ring": ("run.turns=40",),
    "gear_mesh": ("run.turns=4",),
    "gas_dam_reference": ("run.turns=5",),
    "impact": (),
    "rub_chaotic": ("run.turns=6",),
    "runup_through_critical": ("run.accuracy=1e-5",),
    "rayleigh_pads": (),
}
CASES = list(product(SCENES, METHODS))
# Longest run (s); its kills at most; the time (s) after which the first may come.
LONG, MOST, READY = 60.0, 3, 0.02


def continues(ledger, seed, numbers, folder: Path) -> None:
    """Each case once whole, then killed up to three times, after any share of the time that the whole one took."""
    often()
    for number in numbers:
        scene, method = CASES[number % len(CASES)]
        name, chance = f"{scene} {method}", random.Random(f"continue {seed} {number}")
        whole, part = folder / f"whole-{number}.h5", folder / f"part-{number}.h5"
        scenario = read_scenario(SCENARIOS / f"{scene}.toml", (*SCENES[scene], f"run.solver={method}"))
        try:
            simulate(scenario, whole)
            begun = time.monotonic()
            simulate(scenario, whole)
            spent = time.monotonic() - begun
        except Exception as error:
            refused = isinstance(error, ScenarioError) or type(error).__name__ == "SceneError"
            ledger.note("run continued", "refused" if refused else "escaped", "" if refused else name, repr(error))
            continue
        kills = sum(_killed(scenario, part, chance.uniform(READY, spent)) for _ in range(chance.randint(1, MOST)))
        simulate(scenario, part, resume=True)
        unlike = differences(whole, part)
        ledger.note("run continued", "escaped" if unlike else "to the bit", unlike and f"{name} {unlike[:4]}", name)
        ledger.counts["kills of continued runs"] += kills
        for path in (whole, part, partial_path(part)):
            path.unlink(missing_ok=True)


def _killed(scenario, out, after: float) -> bool:
    """Whether a run in a fork of this process was killed, after so many seconds."""
    child = os.fork()
    if child == 0:
        try:
            simulate(scenario, out, resume=True)
        finally:
            os._exit(0)
    end = time.monotonic() + min(after, LONG)
    while time.monotonic() < end:
        if os.waitpid(child, os.WNOHANG)[0]:
            return False
        time.sleep(0.002)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return True
