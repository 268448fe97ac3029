"""The path of the relative tilt, and of each flexible ring's own tilt, as seen along the shaft."""

import numpy as np

from .page import absent, header, look, save, sheet
from .palette import CONTACT, GREY, MARK, PALE, RING, TILT
from .record import BLOCK, Run

DIRECTIONS = 360


def draw(archive_path, out_path, turns: float = 8.0):
    """The orbit of the last `turns` turns of the shaft, inside the reach of the whole run."""
    run = Run(archive_path)
    rings = [ring for ring in ("stator", "rotor") if run.has(f"{ring}_tilt_x", f"{ring}_tilt_y")]
    with look():
        figure = sheet(11.5, 6.4)
        header(figure, run)
        left, right = figure.add_axes((0.07, 0.09, 0.4, 0.70)), figure.add_axes((0.57, 0.09, 0.4, 0.70))
        panel(left, run, turns=turns)
        tilts = [(f"{ring}_tilt", RING[ring], ring) for ring in rings]
        panel(right, run, tilts, "Tilt of each ring", turns, contact=False)
        return save(figure, out_path)


def panel(ax, run: Run, tilts=None, title: str = "Orbit of the relative tilt", turns=8.0, contact=True):
    """Draws orbits of the complex tilts `(series prefix, colour, label)`; default the relative one."""
    tilts = [("relative_tilt", TILT, None)] if tilts is None else tilts
    tilts = [tilt for tilt in tilts if run.has(f"{tilt[0]}_x", f"{tilt[0]}_y")]
    if not tilts:
        absent(ax, title)
        return
    hulls = [hull(run, prefix) for prefix, _, _ in tilts]
    reach = max(np.abs(outer).max(initial=0.0) for outer in hulls)
    if not reach > 0:
        absent(ax, title, "faces aligned throughout")
        return
    first = run.last(turns if run.turning else np.inf)
    for (prefix, colour, label), outer in zip(tilts, hulls, strict=True):
        if first > 0:
            ax.fill(*outer, color=PALE, alpha=0.6, lw=0, label="reach of the whole run" if label is None else None)
        x, y = (1e6 * run.values(f"{prefix}_{axis}", first) for axis in "xy")
        ax.plot(x, y, color=colour, lw=0.9, label=label or window(run, first))
        mark_turns(ax, run, first, x, y)
    circle = contact_circle(ax, run, reach) if contact else 0.0
    limit = 1.12 * max(reach, circle)
    ax.axhline(0, color=GREY, lw=0.5)
    ax.axvline(0, color=GREY, lw=0.5)
    ax.set(xlim=(-limit, limit), ylim=(-limit, limit * 1.3), aspect="equal", title=title)
    ax.set(xlabel="tilt about x, µrad", ylabel="tilt about y, µrad")
    ax.legend(loc="upper left", ncols=2, borderaxespad=0.1, handlelength=1.4, columnspacing=1.0)


def window(run: Run, first: int) -> str:
    """The drawn stretch in words."""
    amount = run.progress[-1] - run.progress[first]
    return f"last {amount:.3g} {'turns' if run.turning else 'ms'}" if first else "whole run"


def hull(run: Run, prefix: str) -> np.ndarray:
    """The furthest the tilt went in each direction, over the whole run: a closed polygon, 2 x n, urad."""
    furthest = np.zeros(DIRECTIONS)
    for start in range(0, run.rows, BLOCK):
        tilt = sum(f * run.values(f"{prefix}_{a}", start, start + BLOCK) for f, a in ((1, "x"), (1j, "y")))
        sector = (np.angle(tilt) / (2 * np.pi) * DIRECTIONS).astype(int) % DIRECTIONS
        np.maximum.at(furthest, sector, np.abs(tilt))
    angles = (np.arange(DIRECTIONS) + 0.5) * 2 * np.pi / DIRECTIONS
    seen = furthest > 0
    return 1e6 * furthest[seen] * np.array([np.cos(angles[seen]), np.sin(angles[seen])])


def mark_turns(ax, run: Run, first: int, x, y) -> None:
    """A dot wherever the shaft passes its zero angle."""
    if not run.has("shaft_angle") or not run.turning:
        return
    phase = run.turns[first:] + run.values("shaft_angle", 0, 1)[0] / (2 * np.pi)
    whole = np.arange(np.ceil(phase[0]), np.floor(phase[-1]) + 1)[-200:]
    ax.plot(np.interp(whole, phase, x), np.interp(whole, phase, y), "o", ms=3.2, color=MARK, label="once per turn")


def contact_circle(ax, run: Run, reach: float) -> float:
    """Draws where the faces touch, if the orbit comes within a factor three; returns its radius, urad."""
    radius = 1e6 * (run.contact_tilt or 0.0)
    if not 0 < radius < 3 * reach:
        return 0.0
    angles = np.linspace(0, 2 * np.pi, 361)
    ax.plot(radius * np.cos(angles), radius * np.sin(angles), "--", color=CONTACT, lw=1.0, label="contact")
    return radius
