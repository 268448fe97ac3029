"""A run of a radial seal on one sheet: contact and gap over the turns, gap and load around the shaft, numbers."""

from textwrap import wrap

import numpy as np

from ...answers import Axis, Level, Panel, Series
from ...archive import FIELD_TIME, field
from ...quantities import printed
from ..panels import draw_panel
from ..summary import run_answer
from ..text import line_words
from .page import absent, header, look, panels, save, sheet
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
    # The least load beside the preload, from which it falls by what a follower's motion takes.
    preload = preload_level(run)
    most = max((one.value for one in preload), default=0.0)
    _line(ax["load"], run, "least_load", "Least load of those that ride", "leakage", preload, 1.05 * most)
    if lost:
        _line(ax["gap"], run, "largest_gap", "Largest gap", "film")
        _line(ax["share"], run, "contact_share", "Share of followers on the shaft", "contact", most=100.0)
        _map(ax["gaps"], run, "gap", "Gap around the shaft", turns)
    _map(ax["loads"], run, "follower_load", "Load around the shaft", turns)
    _numbers(ax["numbers"], run)
    return save(figure, out_path)


def _line(ax, run, name, title, style, levels=(), most: float = 0.0) -> None:
    """One series over the whole run, from zero to at least `most`, in the unit in which it is read."""
    if not run.has(name):
        return absent(ax, title, "no rows yet")
    x, values, unit = run.drawn(name)
    top = max(float(np.nanmax(values)), most) or 1.0
    along = Axis("1", run.progress_label, low=run.progress[0], high=run.progress[-1])
    y = Axis(unit, " ", low=-0.03 * top, high=1.05 * top)
    draw_panel(ax, Panel(title, along, y, [Series("line", x, values, style=f"{style} thin")], levels))


def preload_level(run) -> list[Level]:
    """A follower's preload (N), where the archive tells it."""
    preload = run.summary.get("follower", {}).get("preload")
    return [Level(preload, "preload", style="theory dashed", number=True)] if preload else []


def _map(ax, run, name, title, turns):
    if run.info["grid"].get(FIELD_TIME, 0) < 3:
        return absent(ax, title, "no instants kept")
    times, values = field(run.path, FIELD_TIME), field(run.path, name)
    x = np.interp(times, run.values("time"), run.progress)
    shown = x >= x[-1] - turns
    unit, per = run.field_shown(name, float(np.abs(values[shown]).max()))
    series = [Series("map", x[shown], field(run.path, "theta"), per * values[shown].T)]
    draw_panel(ax, Panel(title, Axis("1", run.progress_label), Axis("angle"), series, colour=Axis(unit, " ")))


def _numbers(ax, run):
    ax.axis("off")
    if "follower" not in run.summary:
        return
    lines, on = [], False
    for name, words in ((line.label, line_words(line)) for line in run_answer(run.summary).lines):
        on = name in NUMBERS if name else on
        if on:
            lines += [(name if k == 0 else "", part) for k, part in enumerate(wrap(printed(words), LETTERS))]
    ax.figure.draw_without_rendering()
    height = ax.get_position().height * ax.figure.get_figheight()
    for k, (name, words) in enumerate(lines):
        y = 1.0 - k * min(LINE, height / len(lines)) / height
        ax.text(0.0, y, name, transform=ax.transAxes, fontsize=8, weight="bold", va="top")
        ax.text(0.29, y, words, transform=ax.transAxes, fontsize=8, va="top")
