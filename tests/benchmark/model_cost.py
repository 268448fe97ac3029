"""What a model costs: the least time (ms) to build `Model(scene)` of some shipped scenarios.

    python tests/benchmark/model_cost.py

Processor time of this process, the best of many: what other processes do counts little.
"""

import time
from pathlib import Path

from sealdyn.dynamics.model import Model
from sealdyn.scenario.reader import read_scenario

SCENARIOS = Path(__file__).parents[2] / "scenarios"
NAMES = ("fmr_reference", "fms_reference", "run_in", "rub", "ludwig_allen")
TRIALS, EACH = 30, 3


def milliseconds(scene) -> float:
    """Processor time (ms) to build the model of a scene, compiled kernels loaded."""
    Model(scene)
    found = []
    for _ in range(TRIALS):
        begun = time.process_time()
        for _ in range(EACH):
            Model(scene)
        found.append((time.process_time() - begun) / EACH)
    return 1e3 * min(found)


if __name__ == "__main__":
    print("scenario          model, ms")
    for name in NAMES:
        print(f"{name:16s} {milliseconds(read_scenario(SCENARIOS / f'{name}.toml').scene):10.3f}", flush=True)
