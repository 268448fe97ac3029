"""A run of a radial seal on one sheet: contact and gap over the turns, gap and load around the shaft, numbers."""

from textwrap import wrap

import numpy as np

from ...archive import FIELD_TIME, field
from ..radial import radial_rows
from .page import absent, header, look, panels, save, sheet
from .palette import CONTACT, FILM, LEAK, PRESSURE, THEORY, THICKNESS
from .record import Run

NUMBERS = ("follower", "load", "largest gap", "leakage", "closed form", "energy audit", "accuracy")


@look()
def draw(archive_path, out_path, turns: float = 4.0):
    """All of it; the maps show the last `turns` turns of the shaft."""
    run = Run(archive_path)
    figure = sheet(13.0, 8.6)
    ax = panels(figure, header(figure, run), [["gap", "share", "load"], ["gaps", "gaps", "numbers"],
                                              ["loads", "loads", "numbers"]])  # fmt: skip
    _line(ax["gap"], run, "largest_gap", "Largest gap", FILM)
    _line(ax["share"], run, "contact_share", "On the shaft", CONTACT)
    _line(ax["load"], run, "least_load", "Least load of a follower that rides", LEAK)
    needed = run.summary.get("follower", {}).get("preload")
    if needed:
        ax["load"].axhline(needed, color=THEORY, ls="--", label="preload")
        ax["load"].legend(loc="lower right")
    _map(ax["gaps"], run, "gap", "Gap around the shaft", THICKNESS, turns)
    _map(ax["loads"], run, "follower_load", "Load around the shaft", PRESSURE, turns)
    _numbers(ax["numbers"], run)
    return save(figure, out_path)


def _line(ax, run, name, title, colour):
    if not run.has(name):
        return absent(ax, title, "no rows yet")
    x, values, unit = run.drawn(name)
    ax.plot(x, values, color=colour)
    top = max(float(np.nanmax(values)), 0.0)
    ax.set(title=title, xlabel=run.progress_label,
           ylabel=unit, ylim=(-0.03 * (top or 1.0), 1.15 * (top or 1.0)))  # fmt: skip
    return None


def _map(ax, run, name, title, colours, turns):
    instants = run.info["grid"].get(FIELD_TIME, 0)
    if instants < 2:
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
    image = ax.pcolormesh(middles, edges, values[1:-1].T, cmap=colours, shading="flat", rasterized=True)
    ax.figure.colorbar(image, ax=ax, fraction=0.03, pad=0.01, label=f"{about.display_unit}")
    ax.grid(False)
    ax.set(title=title, xlabel=run.progress_label, ylabel="angle, deg")
    return None


def _numbers(ax, run):
    ax.axis("off")
    if "follower" not in run.summary:
        return
    lines, on = [], False
    for name, words in radial_rows({**run.summary, "wall_time": 0.0}):
        on = name in NUMBERS if name else on
        if on:
            lines += [(name if k == 0 else "", part) for k, part in enumerate(wrap(words, 44))]
    for k, (name, words) in enumerate(lines):
        y = 1.0 - 0.043 * k
        ax.text(0.0, y, name, transform=ax.transAxes, fontsize=8, weight="bold", va="top")
        ax.text(0.27, y, words, transform=ax.transAxes, fontsize=8, va="top")
