"""The figure a seal engineer pins to the wall: question, verdict, orbit, film, tilt, leakage, spectrum, numbers."""

import numpy as np
from matplotlib import rc_context

from ...status import Status
from ..radial import is_radial
from . import followers, orbit, spectrum
from .page import PAPER, absent, header, level, look, save, sheet
from .palette import CONTACT, FILM, GREY, LEAK, PALE, STATUS, THEORY, TILT, YELLOW
from .record import Run

LEFT, RIGHT = (("orbit",), ("numbers",)), (("film", "film, end"), ("tilt", "tilt, end"), ("flow", "spectrum"))
# Height of a name beside a line, as a share of the panel.
NAME_HEIGHT = 0.08
# Name of a row, and what stands in it: key of the summary, factor, words, digits.
NUMBERS = (
    ("smallest film", ("h_min.value", 1e6, "{} µm", 4), ("h_min.of_clearance", 100, "{} % of clearance", 3)),
    ("tilt max / min / mean", *((f"relative_misalignment.{k}", 1e6, "{}", 3) for k in ("max", "min", "mean"))),
    ("steady max / min", *((f"relative_misalignment.steady_{k}", 1e6, "{}", 4) for k in ("max", "min"))),
    ("closed form max / min", *((f"closed_form.relative_{k}", 1e6, "{}", 4) for k in ("max", "min"))),
    ("mean leakage", ("leakage.mean_ml_per_h", 1, "{} ml/h", 4)),
    ("mean friction", ("friction.power", 1, "{} W", 3), ("friction.torque", 1, "{} N m", 3)),
    ("film stiffness", ("film.axial_stiffness", 1e-6, "{} N/µm", 3), ("film.tilt_stiffness", 1, "{} N m/rad", 3)),
    ("closing force", ("closing.force", 1, "{} N", 4), ("closing.balance_ratio", 1, "balance ratio {}", 3)),
    ("critical speed", ("stability.critical_speed", 1, "{} rad/s", 4)),
    ("margin to contact", ("contact_margin", 1, "{} × this forcing", 3)),
    ("touches", ("contact.touches", 1, "{}", 4), ("contact.depth", 1e6, "{} µm deep", 3)),
    ("wear rate", ("contact.wear_rate", 3.6e9, "{} µm/h", 3)),
    ("energy residual", ("energy_residual", 1, "{}", 2)),
)  # fmt: skip


# Titles stay where they are put: nothing is above them that they had to make room for, and looking takes a quarter of
# the drawing.
@rc_context({"axes.titley": 1.0})
@look()
def draw(archive_path, out_path, turns: float = 4.0):
    """Everything on one sheet; the enlarged panels show the last `turns` turns."""
    run = Run(archive_path)
    if is_radial(run.info):
        return followers.draw(archive_path, out_path, turns)
    figure = sheet(13.5, 9.0)
    ax = _placed(figure, header(figure, run) - 0.025)
    ax["orbit"].set_anchor("N")
    orbit.panel(ax["orbit"], run)
    key_numbers(ax["numbers"], run)
    for column, first in (("", 0), (", end", run.last(turns))):
        film, tilt = ax["film" + column], ax["tilt" + column]
        tilt.sharex(film)
        film_panel(film, run, first)
        tilt_panel(tilt, run, first)
    ax["flow"].sharex(ax["film"])
    (contact_panel if run.touches else leakage_panel)(ax["flow"], run)
    # Panels above share their x axis with the lowest of the column.
    for name in ("flow", "tilt, end"):
        ax[name].set_xlabel(run.progress_label)
    spectrum.panel(ax["spectrum"], run)
    return save(figure, out_path)


def _placed(figure, top: float) -> dict:
    """Axes by name, by hand: every run draws this page, and a layout engine would take half of its time."""
    left = figure.add_gridspec(2, 1, left=0.056, right=0.326, bottom=0.07, top=top, height_ratios=(5, 3), hspace=0.17)
    right = figure.add_gridspec(3, 2, left=0.385, right=0.975, bottom=0.082, top=top, wspace=0.26, hspace=0.33)
    return {
        name: figure.add_subplot(grid[row, column])
        for grid, names in ((left, LEFT), (right, RIGHT))
        for row, across in enumerate(names)
        for column, name in enumerate(across)
    }


def film_panel(ax, run: Run, first: int) -> None:
    """h_min with the design clearance, contact, and where the run ended if it did not end well."""
    title = "Smallest film thickness" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "h_min"):
        return
    per, (x, h, unit) = run.shown("h_min")[1], run.drawn("h_min", first)
    ax.plot(x, h, color=FILM)
    ax.set(title=title, ylabel=f"h_min, {unit}")
    _span(ax, run, first)
    low, top = np.nanmin(h), np.nanmax(h)
    if first:
        margin = max(0.3 * (top - low), 2e-3 * top)
        ax.set_ylim(low - margin, top + margin)
    else:
        top = 1.15 * max(top, per * (run.clearance or 0))
        ax.set_ylim(min(1.1 * low, -0.03 * top), top)
        # Two lines close together: the lower one's name goes below it.
        apart = per * ((run.clearance or np.inf) - run.touch_at)
        close = abs(apart) < NAME_HEIGHT * top
    if run.clearance:
        level(ax, per * run.clearance, "" if first else "clearance", below=not first and close and apart <= 0)
    words = "" if first else "asperities meet" if run.touch_at else "contact"
    level(ax, per * run.touch_at, words, CONTACT, below=not first and close and apart > 0, ls="-", lw=1.2)
    if run.status in (Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED):
        colour = STATUS[run.status]
        ax.plot(x[-1], h[-1], "X", ms=8, color=colour, clip_on=False, zorder=5)
        ax.annotate(run.status, (x[-1], h[-1]), xytext=(-8, -12 if h[-1] > 0.75 * top else 9), color=colour,
                    textcoords="offset points", ha="right", weight="bold", bbox=PAPER)  # fmt: skip


def tilt_panel(ax, run: Run, first: int) -> None:
    """Relative misalignment between the closed form's extremes."""
    title = "Relative misalignment" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "relative_misalignment"):
        return
    per, (x, tilt, unit) = run.shown("relative_misalignment")[1], run.drawn("relative_misalignment", first)
    top = np.nanmax(tilt)
    if not top > 0:
        return absent(ax, title, "faces aligned")
    ax.plot(x, tilt, color=TILT)
    theory = run.summary.get("closed_form") or {}
    lines = [per * theory[k] for k in ("relative_max", "relative_min") if isinstance(theory.get(k), int | float)]
    if lines and 0 < max(lines) < 3 * top:
        for line, label in zip(lines, ("closed form, max and min", "_"), strict=False):
            ax.axhline(line, color=THEORY, ls="--", lw=1.1, zorder=3, label=label)
        ax.legend(loc="upper right", borderaxespad=0.0)
        top = max(top, *lines)
    ax.set(title=title, ylabel=f"tilt, {unit}", ylim=(0, 1.3 * top))
    _span(ax, run, first)


# Leakage (ml/h) from which it is drawn in l/min, as that of gases.
MUCH = 1e5


def leakage_panel(ax, run: Run) -> None:
    """Leakage at both radii; they differ while the film swells and shrinks."""
    sides = [side for side in ("inner", "outer") if run.has(f"leakage_{side}")]
    title = "Leakage, high to low pressure"
    if not sides and _lacking(ax, run, title, "leakage_inner"):
        return
    # The outer one wide and pale beneath, so that both are seen where they agree.
    flows = {side: run.drawn(f"leakage_{side}") for side in reversed(sides)}
    large = max(np.nanmax(np.abs(flow)) for _, flow, _ in flows.values()) > MUCH
    for side, (x, flow, unit) in flows.items():
        if large:
            flow, unit = flow / 6e4, "l/min"
        colour, width = (LEAK, 0.8) if side == "inner" else (YELLOW, 2.0)
        ax.plot(x, flow, label=f"at the {side} radius", color=colour, lw=width)
    ax.set(title=title, ylabel=unit)
    ax.margins(y=0.25)
    ax.legend(loc="upper right", ncols=2, borderaxespad=0.0)
    _span(ax, run, 0)


def contact_panel(ax, run: Run) -> None:
    """Load that the touching asperities carry, beside the closing force it is a share of."""
    x, force, unit = run.drawn("contact_force")
    ax.fill_between(x, force, color=CONTACT, alpha=0.25, lw=0)
    ax.plot(x, force, color=CONTACT, lw=0.9)
    share = (run.summary.get("contact") or {}).get("share_of_closing")
    words = f", {100 * share:.3g} % of the closing force on average" if isinstance(share, float) else ""
    ax.set(title=f"Contact force{words}", ylabel=unit, ylim=(0, 1.15 * np.nanmax(force)))
    _span(ax, run, 0)


def _lacking(ax, run: Run, title: str, name: str) -> bool:
    """Whether a series has nothing to draw; the panel then says so."""
    if run.has(name):
        return False
    absent(ax, title, "no samples" if run.rows < 2 else "not in this scene")
    return True


def key_numbers(ax, run: Run) -> None:
    """A short table from the summary; rows the run does not have are left out."""
    ax.set_axis_off()
    ax.set_title("Key numbers")
    rows = list(_numbers(run.summary)) or [("no summary", run.status)]
    step = min(0.082, 0.97 / len(rows))
    for line, (name, value) in enumerate(rows):
        y = 0.95 - step * line
        ax.text(0.0, y, name, va="center", transform=ax.transAxes, color=GREY, fontsize=8)
        ax.text(0.44, y, value, va="center", transform=ax.transAxes, fontsize=8)
    below = 0.95 - step * (np.arange(len(rows)) + 0.5)
    ax.hlines(below, 0, 1, color=PALE, lw=0.5, capstyle="projecting", transform=ax.transAxes)


def _numbers(summary: dict):
    """(name, value in words) of what the summary holds; with strokes in the name, tilts in the order of the name."""
    for name, *parts in NUMBERS:
        words = [_said(summary, *part) for part in parts]
        # Faces of no wear coefficient say nothing of wear.
        if any(words) and words != ["0 µm/h"]:
            yield name, " / ".join(w or "–" for w in words) + " µrad" if "/" in name else ", ".join(filter(None, words))


def _said(summary: dict, key: str, factor: float, words: str, digits: int) -> str | None:
    """A number of the summary in words; None if it is not there, or no number."""
    value = summary
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    known = isinstance(value, int | float) and np.isfinite(value)
    return words.format(written(factor * value, digits)) if known else None


def written(value: float, digits: int) -> str:
    """`digits` significant figures; large numbers in full, with thousands marked."""
    if 1e4 <= abs(value) < 1e7:
        return f"{float(f'{value:.{digits}g}'):,.0f}".replace(",", " ")
    return f"{value:.{digits}g}"


def _span(ax, run: Run, first: int) -> None:
    start, end = run.progress[first], run.progress[-1]
    ax.set_xlim(start, end if end > start else start + 1)
