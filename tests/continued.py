"""Runs that are stopped and go on, and all that their archives hold."""

import json
import math
from pathlib import Path

import h5py

from sealdyn.simulation import sinks
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers import integrate, sundials_direct

SCENARIOS = Path(__file__).parents[1] / "scenarios"
# What may differ: where and when it was written, and for how long.
OWN = ("created", "title", "seal", "summary")
OWN_NUMBERS = ("wall_time", "archive", "figure")


def often(put=setattr) -> None:
    """Let methods start anew often, hand over few steps at once, and keep every start to go on from."""
    for name, steps in (("RENEWED", 1500), ("RENEWED_PYTHON", 400), ("RENEWED_FILM", 300), ("RENEWED_CELLS", 30)):
        put(integrate, name, steps)
    put(sundials_direct, "BLOCK", 200)
    put(sinks, "EVERY", 0.0)


def content(path) -> dict:
    """All that an archive holds: bytes of its numbers, words, the numbers of its summary."""
    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item[()].tobytes() if item.dtype.kind == "f" else item[()].tolist()

    with h5py.File(path) as file:
        file.visititems(keep)
        found |= {f"@{name}": value for name, value in file.attrs.items() if name not in OWN}
        summary = json.loads(file.attrs["summary"])
    return found | {f"summary {name}": repr(value) for name, value in summary.items() if name not in OWN_NUMBERS}


def differences(one, other) -> list[str]:
    """What two archives do not have alike."""
    held = content(one), content(other)
    return sorted(name for name in held[0].keys() | held[1].keys() if held[0].get(name) != held[1].get(name))


def stopped(scenario, out, after: list[int]):
    """A run that was stopped after so many blocks of steps, each time it went on; how often it was, and its end."""
    count = 0
    for k, many in enumerate([*after, math.inf]):
        left = [many]

        def stop(left=left):
            left[0] -= 1
            return left[0] < 0

        result = simulate(scenario, out, stop=stop, resume=k > 0 and count == k)
        count += result.status == "interrupted"
        if result.status != "interrupted":
            break
    return count, result
