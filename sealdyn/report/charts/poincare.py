"""Poincare section: the relative tilt and the gap whenever the shaft passes its zero angle."""

import numpy as np

from .page import absent, header, look, save, sheet
from .palette import FILM, TILT
from .record import Run

MOST = 4000  # crossings drawn, the last ones


def draw(archive_path, out_path):
    """Once-per-turn points in the plane of the relative tilt, and of h_min against turns."""
    run = Run(archive_path)
    with look():
        figure = sheet(11.5, 6.0)
        header(figure, run)
        left, right = figure.add_axes((0.07, 0.10, 0.38, 0.68)), figure.add_axes((0.55, 0.10, 0.40, 0.68))
        if run.has("relative_tilt_x", "relative_tilt_y", "h_min", "shaft_angle") and run.turning:
            turns, values = section(run, ("relative_tilt_x", "relative_tilt_y", "h_min"))
        else:
            turns, values = np.empty(0), np.empty((3, 0))
        if len(turns) < 2:
            absent(left, "Once per turn: relative tilt", "fewer than two passages of shaft angle zero")
            absent(right, "Once per turn: smallest film thickness", "fewer than two passages of shaft angle zero")
        else:
            unit, per = run.shown("relative_tilt_x")
            _plane(left, turns, per * values[0], per * values[1], unit)
            unit, per = run.shown("h_min")
            _film(right, turns, per * values[2], unit)
        return save(figure, out_path)


def section(run: Run, names):
    """Turn numbers (m,) at which the shaft passes angle zero, and the named series there (SI), by cubic
    interpolation between the four nearest samples."""
    phase = run.turns + run.values("shaft_angle", 0, 1)[0] / (2 * np.pi)
    # The last instant of a run that ended early may stand twice.
    kept = np.concatenate([[True], np.diff(phase) > 1e-9])
    phase, columns = phase[kept], [run.values(name)[kept] for name in names]
    if len(phase) < 4:
        return np.empty(0), np.empty((len(names), 0))
    whole = np.arange(np.ceil(phase[0] - 1e-9), np.floor(phase[-1] + 1e-9) + 1)[-MOST:]
    at = np.clip(np.searchsorted(phase, whole), 2, len(phase) - 2)
    found = np.zeros((len(names), len(whole)))
    for i in range(-2, 2):
        weight = np.ones(len(whole))
        for j in range(-2, 2):
            if j != i:
                weight *= (whole - phase[at + j]) / (phase[at + i] - phase[at + j])
        found += weight * np.array([column[at + i] for column in columns])
    return whole, found


def _plane(ax, turns, x, y, unit):
    points = ax.scatter(x, y, c=turns, cmap="cividis", s=12, lw=0)
    ax.plot(x[-1], y[-1], "o", mfc="none", mec=TILT, ms=10, label="last turn")
    reach = max(np.ptp(x), np.ptp(y), 1e-9 * max(np.abs(x).max(), np.abs(y).max(), 1e-12))
    if reach < 1e-6 * max(np.abs(x).max(), np.abs(y).max()):
        # One point to plotting accuracy: a period of one turn; show it where it lies.
        reach = 0.2 * max(np.abs(x).max(), np.abs(y).max())
    for centre, setter in ((0.5 * (x.min() + x.max()), ax.set_xlim), (0.5 * (y.min() + y.max()), ax.set_ylim)):
        setter(centre - 0.6 * reach, centre + 0.6 * reach)
    ax.set_aspect("equal")
    ax.set_title(f"Once per turn: relative tilt, {len(turns)} turns")
    ax.set_xlabel(f"tilt about x, {unit}")
    ax.set_ylabel(f"tilt about y, {unit}")
    ax.legend(loc="upper right")
    bar = ax.figure.colorbar(points, ax=ax, fraction=0.04, pad=0.02)
    bar.set_label("turn")


def _film(ax, turns, h_min, unit):
    ax.plot(turns, h_min, ".", color=FILM, ms=4)
    ax.set_title("Once per turn: smallest film thickness")
    ax.set_xlabel("turns of the shaft")
    ax.set_ylabel(f"h_min, {unit}")
