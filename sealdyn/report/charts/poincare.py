"""Poincare section: the relative tilt and the gap whenever the shaft passes its zero angle."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from ...numerics.time_series import cubic
from .page import EVEN, FILM, THICKNESS, TILT, absent, look, run_page, save
from .record import Run

MOST = 4000  # crossings drawn, the last ones
# Samples of a turn between which a passage can be interpolated.
PER_TURN = 8
# Of the reach of all passages: a last half that is smaller is what the panel shows.
SETTLED = 0.1
NOTHING = 1e-18  # below any tilt in any unit


@look()
def draw(archive_path, out_path):
    """Once-per-turn points in the plane of the relative tilt, and of h_min against turns."""
    run = Run(archive_path)
    names = ("relative_tilt_x", "relative_tilt_y", "h_min")
    drawable = run.has(*names, "shaft_angle") and run.turning
    turns, values = section(run, names) if drawable else ((), None)
    why = "fewer than two passages of shaft angle zero" if len(turns) < 2 else ""
    if drawable and run.turns[-1] * PER_TURN > run.rows:
        why = f"fewer than {PER_TURN} samples per turn: what happens between them is not known"
    if why:
        figure, ax = run_page(run, 8.5, 3.4, [["tilt"]])
        absent(ax["tilt"], "Once per turn", why)
        return save(figure, out_path)
    # Aligned faces are one point in the plane of the tilt.
    tilts = run.largest("relative_tilt_x") > 0
    figure, ax = run_page(run, *((11.5, 6.0) if tilts else (8.5, 4.5)), [["tilt", "film"][not tilts :]], space=0.06)
    for panel, title, draws in (("tilt", "relative tilt", _plane), ("film", "smallest film thickness", _film)):
        if panel in ax:
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


def around(x, y, whole: float = 0.0) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits around a section in x and in y, equally far apart; what is one point beside its own size or that of
    the `whole` motion, to plotting accuracy, is shown where it lies."""
    size, reach = max(np.abs(x).max(), np.abs(y).max(), whole, NOTHING), max(np.ptp(x), np.ptp(y))
    half = 0.6 * (reach if reach > EVEN * size else 0.2 * size)
    (x, y) = (0.5 * (values.min() + values.max()) for values in (x, y))
    return (x - half, x + half), (y - half, y + half)


def _plane(ax, run, turns, values):
    unit, per = run.shown("relative_tilt_x")
    x, y = per * values[:2]
    points = ax.scatter(x, y, c=turns, cmap=THICKNESS, s=12, lw=0)
    ax.plot(x[-1], y[-1], "o", mfc="none", mec=TILT, ms=10, label=f"last of {len(turns)} passages")
    late = run.last(run.turns[-1] / 2, run.rows)
    settled = slice(_settled(x, y, per * run.largest("relative_tilt_x", late)), None)
    xlim, ylim = around(x[settled], y[settled], whole=per * run.largest("relative_tilt_x", late))
    ax.set(xlim=xlim, ylim=ylim, aspect="equal")
    if settled.start:
        ax.set_title(f"Once per turn: relative tilt, last {len(x) - settled.start} passages")
    ax.set(xlabel=f"tilt about x, {unit}", ylabel=f"tilt about y, {unit}")
    ax.locator_params(nbins=7)
    ax.legend(loc="upper right")
    ax.figure.colorbar(points, ax=ax, fraction=0.04, pad=0.02, label="turn", ticks=MaxNLocator(6, integer=True))


def _settled(x, y, size: float) -> int:
    """First of the last half of the passages where they are a small part of all and yet no point, else zero."""
    half = len(x) // 2
    late, whole = (max(np.ptp(x[first:]), np.ptp(y[first:])) for first in (half, 0))
    return half if EVEN * size < late < SETTLED * whole else 0


def _film(ax, run, turns, values):
    unit, per = run.shown("h_min")
    ax.plot(turns, per * values[2], ".", color=FILM, ms=4)
    ax.set(xlabel="turns of the shaft", ylabel=f"h_min, {unit}")
    ax.xaxis.set_major_locator(MaxNLocator(8, integer=True))
