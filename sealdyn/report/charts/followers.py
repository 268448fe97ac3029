"""A run of a radial seal on one sheet (contact and gap over the turns, gap and load around the shaft, numbers), and its
motion: the shaft in cross-section, runout enlarged, its followers, gap and load around it, now on the time line."""

from functools import partial
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba

from ...answers import Axis, Level, Panel, Series
from ...archive import FIELD_TIME, ArchiveError, field
from ...quantities import printed
from ..panels import draw_panel
from ..summary import run_answer
from ..text import line_words
from .moving import moments, now, round_times, write
from .orbit import window
from .page import CONTACT, FILM, GREY, LEAK, MARK, PALE, THEORY, absent, header, look, panels, save, sheet
from .record import DEG, MM, Run

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


# Of the radius: how far what moves may reach, height of a foot and of the body on it, and room around all.
REACH, FOOT, BODY, ROOM = 0.2, 0.24, 0.16, 0.03
# Of a follower's share of the circumference: its body and its foot; the widest foot and a corner of arcs, rad.
WIDE, NARROW, WIDEST, FINE = 0.78, 0.3, 0.14, 0.02
POINTS = 361


def animate(run: Run, out_path: Path, turns: float, per_turn: int, progress=None) -> Path:
    """As animation.animate, of an opened archive of a radial seal."""
    if not run.has("least_load", "shaft_angle") or not run.info["grid"].get(FIELD_TIME, 0):
        raise ArchiveError(f"{run.path}: holds no gap around the shaft over time")
    around = Around(run)
    at = around.nearest(moments(run, turns, per_turn, out_path))
    return write(run, partial(moving_panels, around), at, out_path, progress)


class Around:
    """What an archive keeps around the shaft: `theta` (n,) (rad) of the followers, `at` (m,) the progress of the kept
    instants; gaps (m), loads (N), and the shaft's surface as its scene says."""

    def __init__(self, run: Run):
        times, time = field(run.path, FIELD_TIME), run.values("time")
        self.theta, self.shaft = field(run.path, "theta"), run.resolved["shaft"]
        row = np.clip(np.searchsorted(time, times - 1e-9 * time[-1]), 0, run.rows - 1)
        self.at, self.angle = run.progress[row], run.values("shaft_angle")[row]
        self.kept = {name: field(run.path, name) for name in ("gap", "follower_load")}

    def nearest(self, asked) -> np.ndarray:
        """The kept instants nearest to those asked for, each once: between them nothing is made up."""
        middles = 0.5 * (self.at[1:] + self.at[:-1])
        return self.at[np.unique(np.searchsorted(middles, asked))]

    def values(self, name: str, at) -> np.ndarray:
        """Values of a field, (n,) at a kept instant, (m, n) at several."""
        return self.kept[name][np.searchsorted(self.at, at)]

    def surface(self, theta, moment: float) -> np.ndarray:
        """How far (m) the shaft stands out at angles of the housing."""
        shaft, angle = self.shaft, self.angle[np.searchsorted(self.at, moment)]
        out = shaft["offset"] * np.cos(theta - shaft["offset_direction"])
        out = out + shaft["eccentricity"] * np.cos(theta - angle)
        for lobe in shaft["lobes"]:
            out = out + lobe["amplitude"] * np.cos(lobe["order"] * (theta - angle) - lobe["phase"])
        return out

    def displacement(self, moment: float) -> np.ndarray:
        """How far (m) outward the followers are of where they ride on a concentric shaft."""
        return self.surface(self.theta, moment) + self.values("gap", moment)

    def reach(self, at) -> float:
        """The farthest (m) that shaft or followers go from a concentric shaft at the instants `at`."""
        theta = np.linspace(0.0, 2.0 * np.pi, POINTS)
        shaft = max(np.abs(self.surface(theta, moment)).max() for moment in at)
        return float(max(shaft, *(np.abs(self.displacement(moment)).max() for moment in at)))


def moving_panels(around: Around, figure, run: Run, at: np.ndarray, top: float) -> list:
    """Axes and what stands still in them; returns functions of the progress that move the rest."""
    section = figure.add_axes((0.036, 0.075, 0.46, top - 0.15))
    ax = {"line": figure.add_axes((0.565, 0.095, 0.41, 0.15))}
    lost = bool(around.values("gap", at).max() > 0.0)
    names = ("load", "gap") if lost else ("load",)
    each = (top - 0.39) / len(names)
    for k, name in enumerate(names):
        ax[name] = figure.add_axes((0.565, 0.35 + k * (each + 0.01), 0.41, each - 0.05))
    if lost:
        ax["gap"].sharex(ax["load"])
        ax["gap"].tick_params(labelbottom=False)
    movers = [_section(section, run, around, at)]
    movers.append(_bars(ax["load"], run, around, at, "follower_load", "Load around the shaft", LEAK))
    for preload in preload_level(run):
        ax["load"].axhline(preload.value, color=THEORY, ls="--", label=preload.meaning, zorder=1.5)
        ax["load"].set_ylim(0.0, max(ax["load"].get_ylim()[1], 1.1 * preload.value))
        ax["load"].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.1)
    if lost:
        movers.append(_bars(ax["gap"], run, around, at, "gap", "Gap around the shaft", FILM))
    ax["load"].set_xlabel("angle, degrees")
    return [*movers, _time_line(ax["line"], run, at, lost)]


def body(share: float) -> np.ndarray:
    """Outline (m, 2) of a follower at the angle 0 of a shaft of radius 1 whose share of the circumference is `share`
    (rad): it touches the shaft with a foot in its middle."""
    wide, foot = 0.5 * WIDE * share, 0.5 * min(NARROW * share, WIDEST)
    corners = []
    for radius, start, end in ((1.0, -foot, foot), (1.0 + FOOT, foot, wide), (1.0 + FOOT + BODY, wide, -wide),
                               (1.0 + FOOT, -wide, -foot)):  # fmt: skip
        angles = np.linspace(start, end, 2 + int(abs(end - start) / FINE))
        corners.append(radius * np.column_stack([np.cos(angles), np.sin(angles)]))
    return np.vstack(corners)


def _section(ax, run: Run, around: Around, at):
    """The shaft, and the followers around it: radii to scale, what moves enlarged."""
    radius, n = MM * around.shaft["radius"], len(around.theta)
    theta = np.linspace(0.0, 2.0 * np.pi, POINTS)
    reach = MM * around.reach(at)
    times = round_times(REACH * radius / reach) if reach else 1.0
    circle, towards = (np.column_stack([np.cos(angles), np.sin(angles)]) for angles in (theta, around.theta))
    outline = radius * body(2.0 * np.pi / n)
    x, y = outline[:, 0], outline[:, 1]
    turned = np.array([np.column_stack([x * c - y * s, x * s + y * c]) for c, s in towards])
    feet = ax.add_collection(PolyCollection(turned, lw=0.0 if n > 100 else 0.5, ec=MARK))
    (shaft,) = ax.fill([0], [0], fc=PALE, ec=MARK, lw=0.8)
    ax.plot(*(radius * circle).T, color=GREY, lw=0.7, ls=":")
    (spoke,) = ax.plot([], [], color=MARK, lw=1.2)
    (centre,) = ax.plot([], [], "+", color=MARK, ms=7)
    for colour, label in ((CONTACT, "on the shaft"), (FILM, "off the shaft")):
        ax.fill([], [], color=colour, label=label)
    limit = radius * (1.0 + FOOT + BODY + ROOM) + times * reach
    ax.set(ylim=(-limit, limit), xticks=[], yticks=[])
    ax.set_aspect("equal", adjustable="datalim")
    ax.spines[:].set_visible(False)
    ax.set_title("Cross-section" if times == 1 else f"Cross-section, runout {times:g} times enlarged")
    stretch = window(run, int(np.searchsorted(run.progress, at[0])))
    ax.set_xlabel(f"shaft of {2 * radius:.4g} mm; dotted: concentric; {len(at)} kept instants, {stretch}")
    ax.legend(loc="upper right", borderaxespad=0.0)
    offset, direction = MM * times * around.shaft["offset"], around.shaft["offset_direction"]
    middle = offset * np.array([np.cos(direction), np.sin(direction)])
    centre.set_data([middle[0]], [middle[1]])
    colours = np.array([to_rgba(CONTACT), to_rgba(FILM)])

    def move(moment):
        shaft.set_xy((radius + MM * times * around.surface(theta, moment))[:, None] * circle)
        away = MM * times * around.displacement(moment)
        feet.set_verts(turned + (away[:, None] * towards)[:, None, :])
        feet.set_facecolor(colours[(around.values("follower_load", moment) <= 0.0).astype(int)])
        angle = around.angle[np.searchsorted(around.at, moment)]
        end = radius + MM * times * around.surface(angle, moment)
        spoke.set_data([middle[0], end * np.cos(angle)], [middle[1], end * np.sin(angle)])

    return move


def _bars(ax, run: Run, around: Around, at, name: str, title: str, colour: str):
    """A field around the shaft, a step for each follower."""
    every = around.values(name, at)
    unit, per = run.field_shown(name, float(every.max()))
    theta, n = DEG * around.theta, len(around.theta)
    steps = ax.stairs(np.zeros(n), np.append(theta, 360.0) - 180.0 / n, fill=True, color=colour, baseline=0.0)
    top = per * float(every.max()) or 1.0
    ax.set(title=title, ylabel=unit, ylim=(0.0, 1.1 * top), xlim=(-180.0 / n, 360.0 - 180.0 / n))
    ax.set(xticks=range(-60 * (3 // n), 360, 60))
    return lambda moment: steps.set_data(per * around.values(name, moment))


def _time_line(ax, run: Run, at, lost: bool):
    """Share of the followers on the shaft, or where nothing leaves it the least load, over the stretch; and now."""
    name, colour, words = ("contact_share", CONTACT, "on the shaft") if lost else ("least_load", LEAK, "least load")
    first = max(0, int(np.searchsorted(run.progress, at[0])) - 1)
    x, values, unit = run.drawn(name, first)
    ax.plot(x, values, color=colour)
    ax.set_ylabel(f"{words}, {unit}")
    ax.set_ylim(*((-3.0, 105.0) if lost else (0.0, 1.2 * max(float(np.nanmax(values)), 0.0) or 1.0)))
    return now(ax, run, at)
