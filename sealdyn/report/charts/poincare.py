"""Poincare section: the relative tilt and the gap whenever the shaft passes its zero angle."""

import numpy as np

from .page import ROUNDING, absent, look, run_page, save
from .palette import FILM, THICKNESS, TILT
from .record import Run
from .spectrum import cubic

MOST = 4000  # crossings drawn, the last ones


@look()
def draw(archive_path, out_path):
    """Once-per-turn points in the plane of the relative tilt, and of h_min against turns."""
    run = Run(archive_path)
    figure, ax = run_page(run, 11.5, 6.0, [["tilt", "film"]], space=0.06)
    names = ("relative_tilt_x", "relative_tilt_y", "h_min")
    turns, values = section(run, names) if run.has(*names, "shaft_angle") and run.turning else ((), None)
    for panel, title, draws in (("tilt", "relative tilt", _plane), ("film", "smallest film thickness", _film)):
        if len(turns) < 2:
            absent(ax[panel], f"Once per turn: {title}", "fewer than two passages of shaft angle zero")
        else:
            ax[panel].set_title(f"Once per turn: {title}")
            draws(ax[panel], run, turns, values)
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
    return whole, np.array([cubic(whole, phase, column) for column in columns])


def frame(ax, x, y, least: float = 0.0) -> None:
    """Limits around a section, the same scale in both directions, at `least` so far apart; one point to plotting
    accuracy is shown where it lies."""
    size, reach = max(np.abs(x).max(), np.abs(y).max(), 1e-12), max(np.ptp(x), np.ptp(y), least)
    half = 0.6 * (reach if reach > ROUNDING * size else 0.2 * size)
    (x, y) = (0.5 * (values.min() + values.max()) for values in (x, y))
    ax.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect="equal")


def _plane(ax, run, turns, values):
    unit, per = run.shown("relative_tilt_x")
    x, y = per * values[:2]
    points = ax.scatter(x, y, c=turns, cmap=THICKNESS, s=12, lw=0)
    ax.plot(x[-1], y[-1], "o", mfc="none", mec=TILT, ms=10, label=f"last of {len(turns)} turns")
    frame(ax, x, y)
    ax.set(xlabel=f"tilt about x, {unit}", ylabel=f"tilt about y, {unit}")
    ax.legend(loc="upper right")
    ax.figure.colorbar(points, ax=ax, fraction=0.04, pad=0.02, label="turn")


def _film(ax, run, turns, values):
    unit, per = run.shown("h_min")
    ax.plot(turns, per * values[2], ".", color=FILM, ms=4)
    ax.set(xlabel="turns of the shaft", ylabel=f"h_min, {unit}")
