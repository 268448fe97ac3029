"""The path of the relative tilt, and of each flexible ring's own tilt, as seen along the shaft."""

import numpy as np

from .page import CONTACT, GREY, MARK, RING, TILT, absent, look, once, run_page, save, written
from .record import BLOCK, Run

DIRECTIONS = 72
# Of the reach: a ring that moves by less is marked, for its path is no line.
STILL = 5e-3


@look()
def draw(archive_path, out_path, turns: float = 8.0):
    """The orbit of the last `turns` turns of the shaft, inside the reach of the whole run."""
    run = Run(archive_path)
    if not any(run.largest(f"{prefix}_tilt_x") for prefix in ("relative", *RING) if run.has(f"{prefix}_tilt_x")):
        figure, ax = run_page(run, 8.5, 3.4, [["relative"]])
        absent(ax["relative"], "Orbit of the relative tilt", "faces aligned throughout")
        return save(figure, out_path)
    figure, ax = run_page(run, 11.5, 6.4, [["relative", "rings"]])
    panel(ax["relative"], run, turns=turns)
    rings = [(f"{ring}_tilt", colour, ring) for ring, colour in RING.items()]
    panel(ax["rings"], run, rings, "Tilt of each ring", turns, contact=False)
    return save(figure, out_path)


def panel(ax, run: Run, tilts=None, title: str = "Orbit of the relative tilt", turns=8.0, contact=True):
    """Draws orbits of the complex tilts `(series prefix, colour, label)`; default the relative one."""
    tilts = [tilt for tilt in tilts or [("relative_tilt", TILT, None)] if run.has(f"{tilt[0]}_x", f"{tilt[0]}_y")]
    if not tilts:
        return absent(ax, title)
    first = run.last(turns)
    # The coarsest unit of what is drawn.
    per, unit = min((run.shown(f"{prefix}_x", first)[::-1] for prefix, _, _ in tilts), key=lambda found: found[0])
    hulls = [hull(run, prefix, per) for prefix, _, _ in tilts]
    whole = max(np.hypot(*outer).max() for outer in hulls)
    if not whole > 0:
        return absent(ax, title, "faces aligned throughout")
    drawn = 0.0
    for (prefix, colour, label), outer in zip(tilts, hulls, strict=True):
        x, y = (per * run.values(f"{prefix}_{axis}", first) for axis in "xy")
        still = max(np.ptp(x), np.ptp(y)) < STILL * whole
        if first > 0 and not (still and max(np.ptp(outer[0]), np.ptp(outer[1])) < STILL * whole):
            ax.fill(*outer, color=colour, alpha=0.12, lw=0, label=once(ax, f"whole run: to {written(whole, 3)} {unit}"))
        # A ring that follows the other closely lies upon it, one that stands still is a point; dots of turns upon both.
        under = len(tilts) > 1 and prefix == tilts[0][0]
        width, mark = (4.0, 10) if under else (1.0, 6.5)
        ax.plot(x, y, color=colour, lw=width, label=label or window(run, first))
        if still:
            ax.plot(x[-1], y[-1], "s", ms=mark, color=colour)
        mark_turns(ax, run, first, x, y)
        drawn = max(drawn, np.hypot(x, y).max())
    # A start-up transient much larger than what is left of it would hide the orbit: look closer.
    reach = drawn if 0 < 3 * drawn < whole else whole
    circle = contact_circle(ax, per * (run.contact_tilt or 0.0), reach) if contact else 0.0
    limit = 1.12 * max(reach, circle)
    ax.axhline(0, color=GREY, lw=0.5, zorder=0.8)
    ax.axvline(0, color=GREY, lw=0.5, zorder=0.8)
    ax.set(xlim=(-limit, limit), ylim=(-limit, limit * 1.3), aspect="equal", title=title)
    ax.set(xlabel=f"tilt about x, {unit}", ylabel=f"tilt about y, {unit}")
    ax.locator_params(nbins=7)
    ax.legend(loc="upper left", ncols=2, borderaxespad=0.1, handlelength=1.4, columnspacing=1.0)


def window(run: Run, first: int) -> str:
    """The drawn stretch in words."""
    along, unit = (run.turns, "turns") if run.turned else (run.progress, run.progress_unit)
    amount = along[-1] - along[first]
    digits = 2 if amount < 10 else 3
    return f"last {amount:.{digits}g} {unit}" if first else "whole run"


def hull(run: Run, prefix: str, per: float | None = None) -> np.ndarray:
    """How far the tilt went towards each direction in the whole run: a convex polygon, (2, n), in a unit of which
    `per` make a radian; without it in the series' unit for people."""
    angles = np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS
    towards = np.stack([np.cos(angles), np.sin(angles)], 1)
    furthest, corners = np.full(DIRECTIONS, -np.inf), np.zeros((2, DIRECTIONS))
    for start in range(0, run.rows, BLOCK):
        tilt = np.stack([run.values(f"{prefix}_{axis}", start, start + BLOCK) for axis in "xy"])
        reached = towards @ tilt
        at = reached.argmax(1)
        reached = reached[np.arange(DIRECTIONS), at]
        corners = np.where(reached > furthest, tilt[:, at], corners)
        furthest = np.maximum(reached, furthest)
    return (per or run.shown(f"{prefix}_x")[1]) * corners


def mark_turns(ax, run: Run, first: int, x, y) -> None:
    """A dot wherever the shaft passes its zero angle."""
    if not run.has("shaft_angle") or not run.turned:
        return
    phase = run.turns[first:] + run.values("shaft_angle", 0, 1)[0] / (2 * np.pi)
    whole = np.arange(np.ceil(phase[0]), np.floor(phase[-1]) + 1)[-200:]
    x, y = np.interp(whole, phase, x), np.interp(whole, phase, y)
    ax.plot(x, y, "o", ms=3.2, color=MARK, label=once(ax, "once per turn"))


def contact_circle(ax, radius: float, reach: float) -> float:
    """Draws where the faces touch, if the orbit's reach comes within a factor three; returns the radius, else zero."""
    if not 0 < radius < 3 * reach:
        return 0.0
    angles = np.linspace(0, 2 * np.pi, 361)
    ax.plot(radius * np.cos(angles), radius * np.sin(angles), "--", color=CONTACT, lw=1.0, label="touch at clearance C")
    return radius
