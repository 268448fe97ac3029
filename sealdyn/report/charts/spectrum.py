"""What the tilt and the film are made of, in orders of shaft speed."""

import numpy as np
from matplotlib.ticker import NullLocator

from ...numerics.time_series import FOLDED, at_the_edge, located, order_spectrum, peaks
from ...quantities import in_words
from .page import CONTACT, FILM, LEAK, TILT, absent, decades, look, number, run_page, save, written
from .record import Run

MOST_ROWS = 1 << 14
# Turns that a spectrum needs: the Hann window tells half the shaft speed from it only from four turns on.
LEAST_TURNS = 4
TOO_SHORT = "fewer than four turns: no spectrum"
FLOOR = 1e-5
NOTHING = 1e-13  # m or rad: below what any run resolves
# Tables of the housing whose frequencies are those of a band.
BANDS = ("axial_random", "angular_random", "axial_sweep", "angular_sweep")


@look()
def draw(archive_path, out_path, turns: float | None = None):
    """Spectra of the relative tilt (forward and backward), the axial gap and h_min over the last `turns`
    turns; default the last half of the run."""
    run = Run(archive_path)
    if not has_orders(run):
        figure, ax = run_page(run, 8.5, 3.4, [["tilt"]])
        absent(ax["tilt"], "Orders of shaft speed", "nothing moves" if _long_enough(run) else TOO_SHORT)
        return save(figure, out_path)
    tilts = [name for name in ("relative_tilt_x", "relative_tilt_y") if run.has(name)]
    # Aligned faces have their axial motion in the place of the tilt.
    aligned = not any(run.largest(name) for name in tilts)
    mosaic = [["tilt"], ["film"]] if aligned else [["tilt", "tilt"], ["axial", "film"]]
    figure, ax = run_page(run, 11.5, 7.2, mosaic, height_ratios=(5, 4))
    panel(ax["tilt"], run, turns)
    if not aligned:
        real_panel(ax["axial"], run, "axial_gap_change", "Axial motion", turns, said=False)
    real_panel(ax["film"], run, "h_min", "h_min", turns, said=False)
    return save(figure, out_path)


def has_orders(run: Run) -> bool:
    """Whether there is a spectrum at all: some turns, and something that moves."""
    if not _long_enough(run):
        return False
    first = _window(run, None)
    names = ("relative_tilt_x", "relative_tilt_y", "axial_gap_change")
    return any(np.ptp(run.values(name, first)) > NOTHING for name in names if run.has(name))


def _long_enough(run: Run) -> bool:
    return run.turned and run.turns[-1] >= LEAST_TURNS * (1 - 1e-9) and run.has("shaft_speed")


def _window(run: Run, turns: float | None) -> int:
    """First row of the last `turns`, by default of the last half."""
    return run.last(turns or max(run.turns[-1] / 2, LEAST_TURNS), MOST_ROWS)


def panel(ax, run: Run, turns: float | None = None) -> None:
    """Relative tilt, two-sided: positive orders whirl with the shaft, negative ones against it.  An
    aligned scene shows its axial motion instead."""
    first = run.last(turns or np.inf, MOST_ROWS)
    x, y = "relative_tilt_x", "relative_tilt_y"
    if not run.has(x, y) or not any(run.values(tilt, first).any() for tilt in (x, y)):
        return real_panel(ax, run, "axial_gap_change", "Axial motion in orders of shaft speed", turns)
    title = "Relative tilt in orders of shaft speed"
    show(ax, run, lambda first: run.values(x, first) + 1j * run.values(y, first), title, x, TILT, turns)


def real_panel(ax, run: Run, name: str, title: str, turns: float | None = None, said=True) -> None:
    """A real series about its mean, one-sided; `said`: state window and resolution below."""
    if not run.has(name):
        return absent(ax, title)
    colour = FILM if name == "h_min" else LEAK
    show(ax, run, lambda first: run.values(name, first), title, name, colour, turns, said)


def show(ax, run: Run, read, title: str, name: str, colour: str, turns: float | None, said=True):
    """Draws one spectrum and names its peaks; `read(first_row)` gives the signal (SI), read in the unit of the series
    `name` for its size."""
    if not _long_enough(run):
        return absent(ax, title, TOO_SHORT)
    first = _window(run, turns)
    if run.rows - first < 16:
        first = 0
    orders, amplitude, resolution, resampled = order_spectrum(run.turns[first:], read(first))
    if not amplitude.max() > NOTHING:
        return absent(ax, title, "does not move")
    unit, per = run.shown(name, size=amplitude.max())
    amplitude *= per
    largest = amplitude.max()
    named = peaks(orders, amplitude)
    if orders[0] == 0:
        # One cycle in the window is no order but a drift.
        named = named[orders[named] > resolution]
    reach = min(max(3.0, 1.15 * np.abs(orders[named]).max() if len(named) else 0), np.abs(orders).max())
    two_sided = orders[0] < 0
    # Names that would lie upon one another: the larger peak keeps its own.
    room = 0.5 / (ax.get_position().width * ax.figure.get_figwidth()) * reach * (1 + two_sided)
    told: list[int] = []
    for at in named:
        if all(abs(orders[other] - orders[at]) > room for other in told):
            told.append(at)
    seen = np.maximum(amplitude, largest * FLOOR / 2)
    ax.fill_between(orders, largest * FLOOR / 2, seen, color=colour, alpha=0.25, lw=0)
    ax.semilogy(orders, seen, color=colour, lw=0.9)
    share = at_the_edge(orders, amplitude, 0.5 * resolution)
    # Room for the names of peaks, and above them for a warning.
    top = 2000 if share > FOLDED else 20
    ax.set(xlim=(-reach if two_sided else 0, reach), ylim=(largest * FLOOR, largest * top))
    decades(ax.yaxis)
    # Ticks between five decades or more say little, and are a tenth of the drawing of a page.
    ax.yaxis.set_minor_locator(NullLocator())
    decimals = max(0, int(np.ceil(-np.log10(resolution / 5))))
    for at in told:
        order, size = located(orders, amplitude, at)
        words = f"{number(round(order, decimals) + 0.0)}×\n{written(size, 3)}"
        # A name at the left edge of the panel would lie on its ticks.
        edge = not two_sided and orders[at] < 0.08 * reach
        ax.annotate(words, (orders[at], amplitude[at]), xytext=(2 * edge, 3), textcoords="offset points",
                    ha="left" if edge else "center", fontsize=7.5)  # fmt: skip
    if share > FOLDED:
        words = f"{in_words('share', share, digits=2)} of the power in the top tenth of the band:\n"
        words += "may be folded, raise samples_per_turn"
        ax.text(0.99, 0.97, words, transform=ax.transAxes, ha="right", va="top", fontsize=7.5, color=CONTACT)
    sides = "against the shaft  ←   order   →  with the shaft" if two_sided else "order of shaft speed"
    ax.set(title=title, ylabel=f"amplitude, {unit}")
    span = run.turns[-1] - run.turns[first]
    how = f"\nlast {span:.3g} turns, Hann window, resolution {resolution:.2g} orders"
    how += "\nspeed varies: resampled over shaft angle" if resampled else ""
    how += folded(run, first, np.abs(orders).max())
    ax.set_xlabel(sides + how if said else sides)


def folded(run: Run, first: int, highest: float) -> str:
    """A warning when the housing shakes faster than the samples can follow: such tones show at wrong orders."""
    slowest = np.abs(run.values("shaft_speed", first)).min()
    tones = [tone.get("frequency") for kind in ("axial", "angular") for tone in run.housing(kind)]
    bands = [band for kind in BANDS for band in run.housing(kind)]
    tones += [max(band["frequency"]) for band in bands]
    fast = [f for f in tones if isinstance(f, int | float) and 2 * np.pi * f > highest * slowest]
    return f"\n{max(fast):.4g} Hz, above order {highest:.3g}, folds back: raise samples_per_turn" if fast else ""
