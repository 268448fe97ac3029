"""A run of a radial seal on one sheet: contact and gap over the turns, gap and load around the shaft, numbers."""

from textwrap import wrap

import numpy as np

from ...archive import FIELD_TIME, field
from ..summary import run_answer
from ..text import line_words
from .film import scale
from .page import EVEN, absent, header, look, panels, printed, save, sheet
from .palette import CONTACT, FILM, LEAK, PRESSURE, THEORY, THICKNESS
from .record import Run

NUMBERS = ("follower", "contact", "largest gap", "load", "leakage", "closed form", "energy audit", "accuracy")
# Letters of a line of numbers, and inches from one to the next.
LETTERS, LINE = 44, 0.175
LOW, HIGH = 6.2, 9.0
# Panels of a run in which nothing leaves the shaft, and of another.
RIDES = [["load", "load", "numbers"], ["loads", "loads", "numbers"]]
LOST = [[[["gap", "share", "load"]]], [[["gaps", "gaps", "numbers"], ["loads", "loads", "numbers"]]]]


@look()
def draw(archive_path, out_path, turns: float = 4.0):
    """All of it; the maps show the last `turns` turns of the shaft.  Where nothing leaves the shaft there is no gap to
    be shown."""
    run = Run(archive_path)
    lost = run.has("largest_gap") and run.largest("largest_gap") > 0
    figure = sheet(13.0, HIGH if lost else LOW)
    layout = {"height_ratios": (1, 3)} if lost else {}
    ax = panels(figure, header(figure, run), LOST if lost else RIDES, **layout)
    _load(ax["load"], run)
    if lost:
        _line(ax["gap"], run, "largest_gap", "Largest gap", FILM)
        _line(ax["share"], run, "contact_share", "Share of followers on the shaft", CONTACT)
        ax["share"].set_ylim(-3, 105)
        _map(ax["gaps"], run, "gap", "Gap around the shaft", THICKNESS, turns)
    _map(ax["loads"], run, "follower_load", "Load around the shaft", PRESSURE, turns)
    _numbers(ax["numbers"], run)
    return save(figure, out_path)


def _line(ax, run, name, title, colour) -> float:
    """One series over the whole run, from zero; returns its largest value."""
    if not run.has(name):
        absent(ax, title, "no rows yet")
        return 0.0
    x, values, unit = run.drawn(name)
    ax.plot(x, values, color=colour)
    top = max(float(np.nanmax(values)), 0.0)
    ax.set(title=title, xlabel=run.progress_label, ylabel=unit, xlim=(run.progress[0], run.progress[-1]))
    ax.set_ylim(-0.03 * (top or 1.0), 1.2 * (top or 1.0))
    return top


def _load(ax, run) -> None:
    """The least load beside the preload, from which it falls by what a follower's motion takes."""
    top = _line(ax, run, "least_load", "Least load of those that ride", LEAK)
    if preload := preload_level(ax, run):
        top = max(top, preload)
        ax.set_ylim(-0.03 * top, 1.25 * top)
        ax.legend(loc="upper right", borderaxespad=0.0)


def preload_level(ax, run) -> float | None:
    """Draws and returns a follower's preload (N), where the archive tells it."""
    if preload := run.summary.get("follower", {}).get("preload"):
        ax.axhline(preload, color=THEORY, ls="--", label="preload", zorder=1.5)
    return preload


def _map(ax, run, name, title, colours, turns):
    instants = run.info["grid"].get(FIELD_TIME, 0)
    if instants < 3:
        return absent(ax, title, "no instants kept")
    times, values = field(run.path, FIELD_TIME), field(run.path, name)
    theta = np.degrees(field(run.path, "theta"))
    about = run.info["fields"][name]
    x = np.interp(times, run.values("time"), run.progress)
    shown = x >= x[-1] - turns
    step = theta[1] - theta[0] if len(theta) > 1 else 360.0
    edges = np.append(theta - 0.5 * step, theta[-1] + 0.5 * step)
    x, values = x[shown], about.display_factor * values[shown]
    middles = 0.5 * (x[1:] + x[:-1])
    image = ax.pcolormesh(middles, edges, values[1:-1].T, cmap=colours, shading="flat", rasterized=True,
                          norm=scale(values))  # fmt: skip
    even = np.ptp(values) <= EVEN * np.abs(values).max()
    ax.figure.colorbar(image, ax=ax, fraction=0.03, pad=0.01, label=about.display_unit,
                       ticks=[values.min()] if even else None, format="{x:.4g}")  # fmt: skip
    ax.grid(False)
    ax.set(title=title, xlabel=run.progress_label, ylabel="angle, degrees", yticks=range(0, 360, 60))
    return None


def _numbers(ax, run):
    ax.axis("off")
    if "follower" not in run.summary:
        return
    lines, on = [], False
    answer = run_answer(run.summary, {})
    for name, words in ((line.label, line_words(line, {})) for line in answer.lines):
        on = name in NUMBERS if name else on
        if on:
            lines += [(name if k == 0 else "", part) for k, part in enumerate(wrap(printed(words), LETTERS))]
    ax.figure.draw_without_rendering()
    height = ax.get_position().height * ax.figure.get_figheight()
    for k, (name, words) in enumerate(lines):
        y = 1.0 - k * min(LINE, height / len(lines)) / height
        ax.text(0.0, y, name, transform=ax.transAxes, fontsize=8, weight="bold", va="top")
        ax.text(0.29, y, words, transform=ax.transAxes, fontsize=8, va="top")
