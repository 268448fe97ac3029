"""The motion as a film: both rings, tilts enlarged, the gap over the face, the orbit, and where on the time line."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib import colormaps

from ...answers import Axis, Level, Panel, Series
from ...archive import ArchiveError
from ..panels import draw_panel
from ..summary import is_radial
from . import followers
from .film import around, thickness
from .moving import PER_TURN, check_name, moments, now, round_times, write
from .orbit import contact_circle
from .page import CONTACT, GREY, MARK, RING, THICKNESS, TILT, absent, annulus, flatten
from .record import DEG, MM, UM, Run

# Radii of the face in the map, and its colours.
RADII, STEPS = 5, 24
# Height of a ring in the section, as a share of what is drawn.
THICK = 0.22
# Share of the gap that enlarged tilts leave open, and what they may lift a ring's edge by, in the thickest film.
OPEN, LEANING = 0.15, 0.5
RINGS, TILTED = ("stator", "rotor"), ("relative", "rotor", "stator")
# Planes among which the section is chosen.
PLANES = 36


def animate(
    archive_path: str | os.PathLike,
    out_path: str | os.PathLike,
    turns: float = 4.0,
    per_turn: int = PER_TURN,
    progress: Callable[[float, float, str], None] | None = None,
) -> Path:
    """Write the last `turns` turns of a run (of a shaft at rest, milliseconds) as a GIF or an MP4 (which needs the
    package imageio-ffmpeg), or the last picture as a PNG.

    `per_turn` pictures of a turn, of a face seal between samples by straight lines, of a radial seal at the nearest
    instants that are kept; `progress(done, end, words)`.  Returns the path.
    **Raises** ArchiveError for a run without a film thickness or gap, ValueError for more than moving.MOST pictures or
    another kind of file, ImportError where MP4 cannot be made.

    >>> kept = sealdyn.run("fms.toml", out="kept.h5").archive
    >>> sealdyn.animate(kept, "moved.png").name
    'moved.png'
    """
    out_path = Path(out_path)
    check_name(out_path)
    run = Run(archive_path)
    if is_radial(run.info):
        return followers.animate(run, out_path, turns, per_turn, progress)
    if run.clearance is None or not run.has("h_min", "axial_gap_change"):
        raise ArchiveError(f"{archive_path}: holds no film thickness over time")
    return write(run, _panels, moments(run, turns, per_turn, out_path), out_path, progress)


def _panels(figure, run: Run, at: np.ndarray, top: float) -> list:
    """Axes and what stands still in them; returns functions of the progress that move the rest."""
    first = max(0, int(np.searchsorted(run.progress, at[0])) - 1)
    section = figure.add_axes((0.06, 0.32, 0.31, top - 0.39))
    face = figure.add_axes((0.41, 0.31, 0.24, top - 0.41), projection="polar")
    orbit = figure.add_axes((0.78, 0.32, 0.2, top - 0.39))
    line = figure.add_axes((0.06, 0.09, 0.915, 0.13))
    rows = _Rows(run, first)
    return [_section(section, run, rows), _face(face, run, rows), _orbit(orbit, run, rows), _line(line, run, rows)]


class _Rows:
    """The drawn stretch of a run, held in memory, between its samples by straight lines; for `thickness` a run."""

    def __init__(self, run: Run, first: int):
        self.at, self.rows, self.clearance = run.progress[first:], run.rows - first, run.clearance
        self.shape, self.wave_orders, self.has = run.shape, run.wave_orders, run.has
        self.held = {name: run.values(name, first) for name in run.info["series"] if run.has(name)}

    def values(self, name: str, first: int = 0, stop: int | None = None) -> np.ndarray:
        """Rows of a series; zeros of one that is not there: nothing of that kind moves."""
        return self.held[name][first:stop] if name in self.held else np.zeros(self.rows)[first:stop]

    def when(self, name: str, moment: float) -> float:
        """A series at a progress."""
        return float(np.interp(moment, self.at, self.values(name)))

    def lean(self, name: str, angle: float) -> np.ndarray:
        """Rise over radius (m,) of the tilt `name` at an angle."""
        return self.values(f"{name}_tilt_x") * np.sin(angle) - self.values(f"{name}_tilt_y") * np.cos(angle)

    def thickness(self, radius, angle, moment: float) -> np.ndarray:
        """Film thickness (m) over the face at a progress."""
        k = int(np.clip(np.searchsorted(self.at, moment) - 1, 0, self.rows - 2))
        one, other = thickness(self, radius, angle, k, k + 2)
        share = np.clip((moment - self.at[k]) / (self.at[k + 1] - self.at[k]), 0.0, 1.0)
        return one + share * (other - one)


def _radii(run: Run) -> tuple[float, float]:
    return run.film("inner_radius"), run.film("outer_radius")


def _section(ax, run: Run, rows: _Rows):
    """Both rings cut by the plane through the shaft in which they tilt most: heights in micrometres beside millimetres,
    tilts enlarged as far as the gap stays open."""
    radii, planes = np.linspace(*_radii(run), RADII), np.linspace(0, np.pi, PLANES, endpoint=False)
    looked = rows.at[:: max(1, len(rows.at) // 200)]
    leans = [max(np.abs(rows.lean(name, plane)).max() for name in TILTED) for plane in planes]
    plane = planes[np.argmax(leans)]
    sides = (plane, plane + np.pi)
    over = np.array([[rows.thickness(radii, angle, moment) for angle in sides] for moment in looked])
    lean = np.interp(looked, rows.at, rows.lean("relative", plane))
    wedge = lean[:, None, None] * np.array([1.0, -1.0])[:, None] * radii
    times = _enlarged(over - wedge, wedge, max(leans) * radii[-1])
    rotor_lean, relative_lean = rows.lean("rotor", plane), rows.lean("relative", plane)

    def heights(moment, side):
        way = radii if side == plane else -radii
        rotor = rows.when("rotor_z", moment) + times * way * np.interp(moment, rows.at, rotor_lean)
        more = (times - 1) * way * np.interp(moment, rows.at, relative_lean)
        return UM * rotor, UM * (rotor + rows.thickness(radii, side, moment) + more)

    ends = np.array([heights(moment, angle) for moment in looked for angle in sides])
    low, high = ends.min(), ends.max()
    thick = THICK * max(high - low, 1e-3)
    bodies = []
    for k, angle in enumerate(sides):
        two = [ax.fill([0], [0], color=RING[ring], alpha=0.75, lw=0, label="_" * k + ring)[0] for ring in RINGS]
        bodies.append((angle, two))
    width = MM * radii[-1]
    ax.set(xlim=(-1.08 * width, 1.08 * width), ylim=(low - thick, high + thick))
    ax.set_title("Section" if times == 1 else f"Section, tilts {times:g} times enlarged")
    ax.set(xlabel=f"at {DEG * plane:.0f}° (right) and opposite, mm", ylabel="along the shaft, µm")
    ax.axvline(0, color=GREY, lw=0.8, ls="-.")
    ax.legend(loc="center")

    def move(moment):
        for angle, (stator, rotor) in bodies:
            below, above = heights(moment, angle)
            across = MM * (radii if angle == plane else -radii)
            stator.set_xy(_closed(across, above, high + 2 * thick))
            rotor.set_xy(_closed(across, below, low - 2 * thick))

    return move


def _enlarged(level, wedge, lean: float) -> float:
    """How many times tilts are enlarged: to a share of the gap, which must stay open; a 1, 2 or 5 of a decade."""
    if not lean > 0:
        return 1.0
    with np.errstate(divide="ignore"):
        room = np.where(wedge < 0, (1.0 - OPEN) * level / -wedge, np.inf).min()
    most = min(room, LEANING * level.max() / lean)
    return round_times(most)


def _closed(across, face, back: float) -> np.ndarray:
    return np.column_stack([[*across, across[-1], across[0]], [*face, back, back]])


def _face(ax, run: Run, rows: _Rows):
    """Film thickness over the face, where it is thinnest, and a mark on the rotor."""
    inner, outer = _radii(run)
    radius, angle = np.linspace(inner, outer, RADII)[:, None], around(run)[None, :]
    shown = run.shown("h_min")
    every = np.array([rows.thickness(radius, angle, moment) for moment in rows.at[:: max(1, len(rows.at) // 60)]])
    low, high = shown[1] * every.min(), shown[1] * max(every.max(), every.min() * (1 + 2e-3))
    image = ax.pcolormesh(
        angle[0], MM * radius[:, 0], shown[1] * every[0], shading="nearest", vmin=low, vmax=high,
        cmap=colormaps[THICKNESS].resampled(STEPS),
    )  # fmt: skip
    annulus(ax, MM * inner, MM * outer)
    ax.set_title("Film thickness over the face", pad=16, loc="center")
    # Room for the mark on the rotor.
    ax.tick_params(axis="x", pad=7)
    figure, box = ax.figure, ax.get_position()
    place = figure.add_axes((box.x1 + 0.032, box.y0, 0.009, box.height))
    figure.colorbar(image, cax=place).ax.set_title(shown[0], fontsize=8, weight="normal", loc="center")
    (thinnest,) = ax.plot([], [], "o", ms=7, mfc="none", mec=CONTACT, mew=1.8, clip_on=False)
    (mark,) = ax.plot([], [], "v", ms=7, color=MARK, clip_on=False)

    # The angle of the shaft, wrapped at 2 pi, is not interpolated: its turns are, in the direction of its speed.
    start = rows.values("shaft_angle")[0]
    ways = np.sign(rows.values("shaft_speed"))
    turned = start + 2 * np.pi * np.concatenate([[0.0], np.cumsum(ways[1:] * np.diff(rows.at))])

    def move(moment):
        over = rows.thickness(radius, angle, moment)
        image.set_array((shown[1] * over).ravel())
        at = np.unravel_index(np.argmin(over), over.shape)
        thinnest.set_data([angle[0][at[1]]], [MM * radius[at[0]][0]])
        mark.set_data([np.interp(moment, rows.at, turned)], [MM * (outer + 0.06 * (outer - inner))])

    return move


def _orbit(ax, run: Run, rows: _Rows):
    """The relative tilt, and what lies behind it."""
    title = "Orbit of the relative tilt"
    if not np.hypot(rows.values("relative_tilt_x"), rows.values("relative_tilt_y")).any():
        absent(ax, title, "faces aligned throughout")
        return lambda moment: None
    unit, per = run.shown("relative_tilt_x")
    x, y = (per * rows.values(f"relative_tilt_{axis}") for axis in "xy")
    reach = np.hypot(x, y).max()
    circle = contact_circle(ax, per * (run.contact_tilt or 0.0), reach)
    limit = 1.15 * max(reach, circle)
    ax.plot(x, y, color=TILT, lw=0.6, alpha=0.35)
    (tail,) = ax.plot([], [], color=TILT, lw=1.4)
    (dot,) = ax.plot([], [], "o", color=TILT, ms=6)
    ax.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal", title=title)
    dashed = "\ndashed: touch at clearance C" if circle else ""
    ax.set(xlabel=f"about x, {unit}{dashed}", ylabel=f"about y, {unit}")
    length = 1.0 if run.turning else 0.1 * (rows.at[-1] - rows.at[0])

    def move(moment):
        behind = np.linspace(max(rows.at[0], moment - length), moment, 120)
        trail = [np.interp(behind, rows.at, part) for part in (x, y)]
        tail.set_data(*trail)
        dot.set_data([trail[0][-1]], [trail[1][-1]])

    return move


def _line(ax, run: Run, rows: _Rows):
    """Thinnest film over all of the stretch, and now."""
    unit, per = run.shown("h_min")
    touch = [Level(per * run.touch_at, "asperities meet", style="contact dashed", legend=True)]
    film = [Series("line", rows.at, per * rows.values("h_min"), label=f"h_min, {unit}", style="film thin")]
    # Its name above it: beside it long numbers would push the name off the page.
    draw_panel(ax, Panel("", y=Axis("1", " "), series=film, levels=touch if run.touch_at or run.touches else []))
    moves = now(ax, run, rows.at)
    flatten(ax)
    return moves
