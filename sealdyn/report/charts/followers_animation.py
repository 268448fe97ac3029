"""The motion of a radial seal: the shaft in cross-section, runout enlarged, its followers, gap and load around it, and
where on the time line."""

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba

from ...archive import FIELD_TIME, ArchiveError, field
from .followers import preload_level
from .moving import moments, now, round_times, write
from .orbit import window
from .palette import CONTACT, FILM, GREY, LEAK, MARK, PALE, THEORY
from .record import DEG, MM, Run

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
    return write(run, partial(panels, around), at, out_path, progress)


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


def panels(around: Around, figure, run: Run, at: np.ndarray, top: float) -> list:
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
    return [*movers, _line(ax["line"], run, at, lost)]


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


def _line(ax, run: Run, at, lost: bool):
    """Share of the followers on the shaft, or where nothing leaves it the least load, over the stretch; and now."""
    name, colour, words = ("contact_share", CONTACT, "on the shaft") if lost else ("least_load", LEAK, "least load")
    first = max(0, int(np.searchsorted(run.progress, at[0])) - 1)
    x, values, unit = run.drawn(name, first)
    ax.plot(x, values, color=colour)
    ax.set_ylabel(f"{words}, {unit}")
    ax.set_ylim(*((-3.0, 105.0) if lost else (0.0, 1.2 * max(float(np.nanmax(values)), 0.0) or 1.0)))
    return now(ax, run, at)
