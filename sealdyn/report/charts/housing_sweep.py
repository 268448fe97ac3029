"""Sweeps of the housing beside the time line of a run: which frequency is when."""

import math

import numpy as np

from .palette import GREY
from .record import Run

KINDS = {"axial_sweep": "axial", "angular_sweep": "angular"}
# Frequencies that are named (times a power of ten), the least room between two names, how much more the first one
# needs, and the height of a line with its names, as shares of the panel.
NAMED, ROOM, FIRST, HEIGHT = (1, 2, 5), 0.15, 0.17, 0.11


def sweep_lines(ax, run: Run) -> int:
    """Draws a line for each sweep of a run along the top of a panel over its progress, with frequencies in Hz; how many
    there are."""
    found = [(kind, sweep) for kind in KINDS for sweep in run.housing(kind)]
    if not found:
        return 0
    time, level = run.values("time"), 1.0 - 0.4 * HEIGHT
    low, high = (float(run.progress[k]) for k in (0, -1))
    for kind, sweep in found:
        last = min(sweep["start"] + span(sweep), time[-1])
        shown = (max(sweep["start"], time[0]), last)
        if shown[0] >= shown[1]:
            continue
        places = np.interp(shown, time, run.progress)
        way = ax.get_xaxis_transform()
        ax.plot(places, [level, level], color=GREY, lw=1.0, transform=way, clip_on=False)
        marks = [(f, float(np.interp(at, time, run.progress))) for f, at in _marks(sweep)
                 if shown[0] <= at <= shown[1] * (1 + 1e-12)]  # fmt: skip
        for k, (frequency, place) in enumerate(_named(marks, low, high)):
            words = f"{frequency:.4g} Hz" if k else f"{KINDS[kind]} sweep, {frequency:.4g} Hz"
            ax.plot([place], [level], marker="|", ms=5, color=GREY, transform=way, clip_on=False)
            left = _fits(place, low, high)
            ax.annotate(words, (place, level), xycoords=way, xytext=(2 if left else -2, -3), va="top", fontsize=7,
                        textcoords="offset points", ha="left" if left else "right", color=GREY)  # fmt: skip
        level -= HEIGHT
    return len(found)


def _fits(place: float, low: float, high: float) -> bool:
    """Whether a name has room to the right of its place; else it stands to the left."""
    return place < high - ROOM * (high - low)


def _named(marks, low: float, high: float) -> list[tuple[float, float]]:
    """Those of `marks` (frequency, place) whose names have room between `low` and `high`; one that stands to the left
    of its place, as the last one may, goes before those that are in its way."""
    found = []
    for frequency, place in marks:
        fits = _fits(place, low, high)
        while len(found) > 1 and not fits and place - found[-1][1] < 2.0 * ROOM * (high - low):
            found.pop()
        taken = found[-1][1] + FIRST * (len(found) == 1) * (high - low) if found else -math.inf
        if place - taken >= (1.0 if fits else 2.0) * ROOM * (high - low):
            found.append((frequency, place))
    return found


def span(sweep: dict) -> float:
    """How long (s) a resolved sweep takes."""
    if sweep.get("duration") is not None:
        return sweep["duration"]
    first, last = sweep["frequency"]
    return 60.0 * abs(math.log2(last / first)) / sweep["octaves_per_minute"]


def _marks(sweep: dict) -> list[tuple[float, float]]:
    """Frequencies (Hz) that are named, its first and last among them, and when they are (s), in the order of time."""
    first, last = sweep["frequency"]
    low, high = sorted((first, last))
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    named = [n * 10.0**k for k in decades for n in NAMED if low < n * 10.0**k <= high]

    def when(f):
        linear = sweep["spacing"] == "linear"
        share = (f - first) / (last - first) if linear else math.log(f / first) / math.log(last / first)
        return sweep["start"] + share * span(sweep)

    return sorted(((f, when(f)) for f in {first, last, *named}), key=lambda pair: pair[1])
