"""Work and precision: error against wall time and right-hand sides by method, and by model rung on the same axes."""

import math
from textwrap import wrap

import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, NullFormatter

from ...archive import read_study
from ...status import Status
from ..text import question_of, solvers_words
from .page import (
    BLUE,
    CONTACT,
    GREEN,
    GREY,
    LOOKS,
    ORANGE,
    PALE,
    PURPLE,
    SHORT,
    SKY,
    VERMILLION,
    absent,
    look,
    save,
    shortened,
    study_page,
)
from .record import MILLISECONDS

# Of a cost: how many of its unit make one.
UNITS = {"wall": MILLISECONDS, "rhs": 1.0}
# Errors beyond so many clearances are all as bad.
MOST = 1e3
TITLES = {"end": "error at the end", "over_time": "largest error over time", "steady": "error of the steady state"}
# Marks and colours of the rungs.
MODELS = ("o", "s", "^", "v", "D", "P", "X")
RUNGS = (ORANGE, VERMILLION, SKY, BLUE, GREEN, PURPLE)


@look()
def draw(path, out):
    """Three panels of error against time, one against right-hand sides, models beside solvers, and what is said."""
    study = read_study(path)
    answer, title = study["answer"], f"How much solver, how much model: {study['name'].replace('_', ' ')}"
    mosaic = [list(TITLES), ["rhs", "models", "said"]]
    figure, ax = study_page(study, 15.5, 9.6, mosaic, title, question_of(study["question"]))
    figure.supxlabel(caption(study), x=0.03, ha="left", fontsize=7.5, linespacing=1.35)
    costs = {**{where: (where, "wall") for where in TITLES}, "rhs": (answer["where"], "rhs")}
    ends = {name: precision(ax[name], answer, *cost) for name, cost in costs.items()}
    models(ax["models"], answer)
    said(ax["said"], answer)
    # Names find their places in panels that have theirs.
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for name, lines in ends.items():
        label_ends(ax[name], lines)
    return save(figure, out)


def precision(ax, answer, where: str, cost: str, labels: bool = True, title: str | None = None):
    """Error to the right, cost upwards; crosses are runs that did not end well.  Returns (x, y, words, colour) of the
    end of every line; without `labels` the panel is one of many."""
    band = (answer["judge_error"] or {}).get(where)
    ends, drawn = [], False
    for name, row in answer["methods"].items():
        colour, line, marker = LOOKS.get(name, (GREY, "-", "o"))
        error = _errors(row, where)
        spent = np.array(row[cost], dtype=float) * UNITS[cost]
        good = np.array([s in (Status.OK, "slow") for s in row["status"]]) & np.isfinite(error)
        slow = np.array([s == "slow" for s in row["status"]])
        if good.any():
            drawn = True
            ax.plot(error[good], spent[good], line, color=colour, marker=marker, ms=4.2, lw=1.2)
            ax.plot(error[good & slow], spent[good & slow], "x", color=colour, ms=9, mew=1.8)
            last = np.nonzero(good)[0][-1]
            ends.append((error[last], spent[last], SHORT[name], colour))
    crossed = any(status != Status.OK for row in answer["methods"].values() for status in row["status"])
    if not drawn and (where == "steady" or not crossed):
        absent(ax, title or TITLES[where], "no steady state here" if where == "steady" else "nothing to compare")
        return []
    ax.set(xscale="log", yscale="log")
    limits(ax, answer, where, cost)
    _crosses(ax, answer, where, cost)
    if band and band > ax.get_xlim()[1]:
        ax.axvspan(ax.get_xlim()[1], band, color=PALE, lw=0, zorder=0)
    ax.set(title=title or f"{TITLES[where]}, against {'wall time' if cost == 'wall' else 'right-hand sides'}",
           xlabel="error, of the clearance (leakage, impulse: relative)" if labels else "error",
           ylabel="wall time, ms" if cost == "wall" else "right-hand sides")  # fmt: skip
    if band:
        note = f"judge's own error {band:.0e}"
        ax.text(0.985, 0.012, note, transform=ax.transAxes, fontsize=7, color=GREY, ha="right", va="bottom")
    if not (labels or drawn):
        ax.text(0.5, 0.5, "no method ended", transform=ax.transAxes, ha="center", color=GREY, style="italic")
    return ends


def _errors(row, where):
    """Errors, above what a float can show, and no more than `MOST`."""
    values = np.array(row["error"][where], dtype=float)
    return np.where(np.isfinite(values), np.clip(values, 1e-16, MOST), values)


def limits(ax, answer, where, cost):
    """Errors decrease to the right: precision and work both grow outwards."""
    found = np.concatenate([_errors(row, where) for row in answer["methods"].values()] or [np.empty(0)])
    found = found[np.isfinite(found)]
    low, high = (found.min(), found.max()) if len(found) else (1e-12, 1.0)
    band = (answer["judge_error"] or {}).get(where) or 1e-15
    low = max(min(low, 1e-9), 0.3 * min(band, low) if band < 1e-8 else low, 1e-16)
    _error_axis(ax, high, low / 40)
    spent = [c for row in answer["methods"].values() for c in row[cost] if c > 0]
    factor = UNITS[cost]
    ax.set_ylim(factor * min(spent, default=1e-3) * 0.5, factor * max(spent, default=1.0) * 2.5)
    ax.yaxis.set_minor_formatter(NullFormatter())


def _error_axis(ax, high, least):
    """Errors from above the largest one, or 1e-3, down to the `least`, to the right."""
    ax.set_xlim(10 ** math.ceil(math.log10(max(high, 1e-3)) + 0.15), least)
    ax.xaxis.set_major_locator(LogLocator(base=10, numticks=9))
    ax.xaxis.set_minor_formatter(NullFormatter())


def _crosses(ax, answer, where, cost):
    """Runs without an error stand at the left edge, or where the error was to be expected."""
    factor, left = UNITS[cost], ax.get_xlim()[0]
    for name, row in answer["methods"].items():
        colour = LOOKS.get(name, (GREY,))[0]
        for k, status in enumerate(row["status"]):
            if status in (Status.OK, "slow"):
                continue
            # Errors fall to the right: the right end is the smaller number.
            at = left
            if status == "stopped" and row["expected"][k]:
                at = min(max(row["expected"][k], ax.get_xlim()[1]), left)
            spent = max(factor * row[cost][k], ax.get_ylim()[0])
            ax.plot(at, spent, "x", color=colour, ms=7, mew=1.6, clip_on=False, zorder=5)


def label_ends(ax, ends):
    """Names at the right ends of the lines, pushed apart so that none covers another."""
    to_pixels, back = ax.transData.transform, ax.transData.inverted().transform
    height, bottom, top = 17.0, *ax.get_window_extent().intervaly
    placed = sorted(((*to_pixels((x, y)), words, colour) for x, y, words, colour in ends), key=lambda e: e[1])
    levels = [min(max(e[1], bottom + 14), top) for e in placed]
    for k in range(1, len(levels)):
        levels[k] = max(levels[k], levels[k - 1] + height)
    for k in reversed(range(len(levels))):
        levels[k] = min(levels[k], levels[k + 1] - height if k + 1 < len(levels) else top - 4)
    right = ax.get_window_extent().x1
    for (x, y, words, colour), level in zip(placed, levels, strict=True):
        here = min(x + 7, right - 48)
        at = back((here, level))
        if abs(level - y) > 3 or here < x:
            ax.plot(*zip(back((x, y)), back((here - 1, level)), strict=True), color=colour, lw=0.5)
        name = ax.text(*at, words, fontsize=7.5, color=colour, va="center", ha="left", weight="bold", zorder=6)
        name.set_path_effects([withStroke(linewidth=2.5, foreground="white")])


def models(ax, answer):
    """One point per rung: the model's error against what a run with it costs, over the edge of all solvers."""
    where = "steady" if any(row["error"]["steady"] is not None for row in answer["models"]) else answer["where"]
    rows = [row for row in answer["models"] if row["error"][where] is not None]
    title = f"models: {TITLES[where]}, against wall time"
    if not rows:
        return absent(ax, title, "no rung to compare")
    edge = sorted(
        (e, MILLISECONDS * w)
        for row in answer["methods"].values()
        for e, w, s in zip(_errors(row, where), row["wall"], row["status"], strict=True)
        if s == Status.OK and np.isfinite(e)
    )
    best = np.minimum.accumulate([w for _, w in edge]) if edge else []
    ax.set(xscale="log", yscale="log")
    if edge:
        ax.plot([e for e, _ in edge], best, "-", color=GREY, lw=1.2, drawstyle="steps-post",
                label="fastest solver of this scene")  # fmt: skip
    walls = [MILLISECONDS * row["wall"] for row in rows] + list(best)
    errors = [max(row["error"][where], 1e-12) for row in rows] + [e for e, _ in edge]
    _error_axis(ax, max(errors), max(min(errors), 1e-13) / 5)
    ax.set_ylim(min(walls) * 0.25, max(walls) * 200)
    for k, row in enumerate(rows):
        words = f"{row['label']}: {row['error'][where]:.1e}, {MILLISECONDS * row['wall']:.2g} ms"
        mark, colour = MODELS[k % len(MODELS)], RUNGS[k % len(RUNGS)]
        at = max(row["error"][where], 1e-12), MILLISECONDS * row["wall"]
        ax.plot(*at, mark, ms=9, color=colour, mec="white", zorder=4, label=words)
    for row in (row for row in answer["models"] if row["failed"]):
        ax.plot([], [], "x", color=CONTACT, label=shortened(f"{row['label']}: {row['failed']}", 76))
    ax.legend(loc="upper left", fontsize=7.5, markerscale=0.8, borderaxespad=0.2, handlelength=1.0)
    ax.set(title=title, xlabel="error of the motion against the highest rung, of the clearance",
           ylabel="wall time, ms")  # fmt: skip


def said(ax, answer):
    """The verdict in words, and what the crosses are."""
    ax.axis("off")
    ax.set_title("what it amounts to")
    lines = []
    for sentence in answer["verdict"]:
        lines += wrap(sentence, 74, initial_indent="• ", subsequent_indent="   ")
    reasons = {}
    for name, row in answer["methods"].items():
        for status, reason in zip(row["status"], row["reason"], strict=True):
            if status not in (Status.OK, "slow"):
                # One of each kind; "NAME gave up ... into this segment:" is said by the cross.
                words = reason.partition("this segment: ")[2] or reason
                reasons.setdefault((name, status), shortened(f"✕ {SHORT[name]}: {words}", 72))
    lines += ["", *list(reasons.values())[: max(0, 27 - len(lines))]]
    ax.text(0.0, 0.98, "\n".join(lines), transform=ax.transAxes, fontsize=8, va="top", linespacing=1.3)


def caption(info) -> str:
    """Machine, versions, scenario, and how it was measured."""
    answer, settings = info["answer"], info["settings"]
    m = answer["machine"]
    libraries = ", ".join(f"{k} {m[k]}" for k in ("python", "numpy", "scipy", "scikit-sundae", "numba"))
    if "back_end" in m:
        libraries += f"; CVODE and IDA: {m['back_end']}"
    overrides = f" with {', '.join(info['overrides'])}" if info["overrides"] else ""
    words = (
        f"Scenario {info['name']}{overrides}, {answer['scene']['turns']:.3g} turns; sealdyn {info['version']}, "
        f"solvers {solvers_words(info)}. "
        f"{m['processor']}, {m['cores']} cores (wall time {m.get('busy', 1.0):.2f} of the "
        f"processor's); {libraries}.\n"
        f"Wall time: fastest of {settings['repeats']} runs after warm-up, inside the method only.  Error: largest of "
        "h_min, relative misalignment, leakage, contact impulse, between steps by the program's own interpolation.\n"
        f"{settings['tolerances']} tolerances, {settings['loosest']:.0e} to {settings['tightest']:.0e}; of fixed steps "
        "(step / fastest period)².  ✕: did not end well, or too slow; at the left edge when its error is unknown."
    )
    return "\n".join(line for part in words.split("\n") for line in wrap(part, 250))
