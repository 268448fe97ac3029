"""The figure a seal engineer pins to the wall: question, verdict, orbit, film, tilt, leakage, spectrum, numbers."""

import numpy as np

from ...status import Status
from . import orbit, spectrum
from .page import absent, header, look, save, sheet
from .palette import CONTACT, FILM, GREY, LEAK, PALE, STATUS, THEORY, TILT, YELLOW
from .record import Run

PAPER = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.5}
LEFT, MIDDLE, RIGHT = (0.055, 0.25), (0.375, 0.265), (0.715, 0.265)
ROWS = ((0.64, 0.235), (0.37, 0.205), (0.085, 0.19))
# Height of a name beside a line, as a share of the panel.
NAME_HEIGHT = 0.08


def draw(archive_path, out_path, turns: float = 4.0):
    """Everything on one sheet; the enlarged panels show the last `turns` turns."""
    run = Run(archive_path)
    with look():
        figure = sheet(13.5, 9.0)
        header(figure, run)

        def axes(column, row, share=None):
            return figure.add_axes((column[0], ROWS[row][0], column[1], ROWS[row][1]), sharex=share)

        orbit.panel(figure.add_axes((LEFT[0], 0.444, LEFT[1], 0.431)), run)
        key_numbers(figure.add_axes((LEFT[0] - 0.02, 0.03, LEFT[1] + 0.015, 0.32)), run)
        whole, last = axes(MIDDLE, 0), axes(RIGHT, 0)
        for ax, first in ((whole, 0), (last, run.last(turns))):
            film_panel(ax, run, first)
        for ax, first in ((axes(MIDDLE, 1, whole), 0), (axes(RIGHT, 1, last), run.last(turns))):
            tilt_panel(ax, run, first)
        low = axes(MIDDLE, 2, whole)
        if run.touches:
            contact_panel(low, run)
        else:
            leakage_panel(low, run)
        for ax in figure.axes[-2:]:
            # Panels above share their x axis with the lowest of the column.
            ax.set_xlabel(run.progress_label)
        spectrum.panel(axes(RIGHT, 2), run)
        return save(figure, out_path)


def film_panel(ax, run: Run, first: int) -> None:
    """h_min with the design clearance, contact, and where the run ended if it did not end well."""
    title = "Smallest film thickness" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "h_min"):
        return
    unit, per = run.shown("h_min")
    x, h = run.envelope("h_min", first)
    ax.plot(x, per * h, color=FILM)
    ax.set(title=title, ylabel=f"h_min, {unit}")
    _span(ax, run, first)
    low, top = per * np.nanmin(h), per * np.nanmax(h)
    if first:
        margin = max(0.3 * (top - low), 2e-3 * top)
        ax.set_ylim(low - margin, top + margin)
    else:
        top = 1.15 * max(top, per * (run.clearance or 0))
        ax.set_ylim(min(1.1 * low, -0.03 * top), top)
        # Two lines close together: the lower one's name goes below it.
        apart = per * ((run.clearance or np.inf) - run.touch_at)
        close = abs(apart) < NAME_HEIGHT * top
        words = "asperities meet" if run.touch_at else "contact"
        _name(ax, per * run.touch_at, words, CONTACT, below=close and apart > 0)
    if run.clearance:
        ax.axhline(per * run.clearance, color=GREY, ls="--", lw=0.9)
        if not first:
            _name(ax, per * run.clearance, "clearance", GREY, below=close and apart <= 0)
    ax.axhline(per * run.touch_at, color=CONTACT, lw=1.2)
    if run.status in (Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED):
        colour = STATUS[run.status]
        ax.plot(x[-1], per * h[-1], "X", ms=8, color=colour, clip_on=False, zorder=5)
        near_top = per * h[-1] > 0.75 * top
        ax.annotate(run.status, (x[-1], per * h[-1]), xytext=(-8, -12 if near_top else 9), color=colour,
                    textcoords="offset points", ha="right", weight="bold", bbox=PAPER)  # fmt: skip


def tilt_panel(ax, run: Run, first: int) -> None:
    """Relative misalignment between the closed form's extremes."""
    title = "Relative misalignment" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "relative_misalignment"):
        return
    unit, per = run.shown("relative_misalignment")
    x, tilt = run.envelope("relative_misalignment", first)
    top = per * np.nanmax(tilt)
    if not top > 0:
        absent(ax, title, "faces aligned")
        return
    ax.plot(x, per * tilt, color=TILT)
    theory = run.summary.get("closed_form") or {}
    lines = [per * theory[k] for k in ("relative_max", "relative_min") if isinstance(theory.get(k), int | float)]
    if lines and 0 < max(lines) < 3 * top:
        for line in lines:
            ax.axhline(line, color=THEORY, ls="--", lw=1.1, zorder=3)
        ax.plot([], [], color=THEORY, ls="--", lw=1.1, label="closed form, max and min")
        ax.legend(loc="upper right", borderaxespad=0.0)
        top = max(top, *lines)
    ax.set(title=title, ylabel=f"tilt, {unit}", ylim=(0, 1.3 * top))
    _span(ax, run, first)


def leakage_panel(ax, run: Run) -> None:
    """Leakage at both radii; they differ while the film swells and shrinks."""
    sides = [side for side in ("inner", "outer") if run.has(f"leakage_{side}")]
    title = "Leakage, high to low pressure"
    if not sides and _lacking(ax, run, title, "leakage_inner"):
        return
    # The outer one wide and pale beneath, so that both are seen where they agree.
    for side in reversed(sides):
        (unit, per), (x, flow) = run.shown(f"leakage_{side}"), run.envelope(f"leakage_{side}")
        colour, width = (LEAK, 0.8) if side == "inner" else (YELLOW, 2.0)
        ax.plot(x, per * flow, label=f"at the {side} radius", color=colour, lw=width)
    ax.set(title=title, ylabel=unit)
    ax.margins(y=0.25)
    ax.legend(loc="upper right", ncols=2, borderaxespad=0.0)
    _span(ax, run, 0)


def contact_panel(ax, run: Run) -> None:
    """Load that the touching asperities carry, beside the closing force it is a share of."""
    (unit, per), (x, force) = run.shown("contact_force"), run.envelope("contact_force")
    ax.fill_between(x, per * force, color=CONTACT, alpha=0.25, lw=0)
    ax.plot(x, per * force, color=CONTACT, lw=0.9)
    share = (run.summary.get("contact") or {}).get("share_of_closing")
    words = f", {100 * share:.3g} % of the closing force on average" if isinstance(share, float) else ""
    ax.set(title=f"Contact force{words}", ylabel=unit, ylim=(0, 1.15 * per * np.nanmax(force)))
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
        ax.text(0.42, y, value, va="center", transform=ax.transAxes, fontsize=8)
        ax.plot((0, 1), (y - step / 2, y - step / 2), color=PALE, lw=0.5, transform=ax.transAxes)


def _numbers(summary: dict):
    """(name, value in words) of what the summary holds."""

    def get(path):
        value = summary
        for key in path.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        return value if isinstance(value, int | float) and np.isfinite(value) else None

    def said(path, factor, unit, digits=4):
        value = get(path)
        return None if value is None else f"{written(factor * value, digits)} {unit}".strip()

    def joined(*parts):
        return ", ".join(part for part in parts if part)

    share = said("h_min.of_clearance", 100, "% of clearance", 3)
    yield from _kept("smallest film", joined(said("h_min.value", 1e6, "µm"), share))
    tilt = [said(f"relative_misalignment.{k}", 1e6, "", 3) for k in ("max", "min", "mean")]
    if any(tilt):
        yield "tilt max / min / mean", " / ".join(part or "–" for part in tilt) + " µrad"
    steady = [said(f"relative_misalignment.steady_{k}", 1e6, "", 4) for k in ("max", "min")]
    if any(steady):
        yield "steady max / min", " / ".join(part or "–" for part in steady) + " µrad"
    theory = [said(f"closed_form.relative_{k}", 1e6, "", 4) for k in ("max", "min")]
    if any(theory):
        yield "closed form max / min", " / ".join(part or "–" for part in theory) + " µrad"
    yield from _kept("mean leakage", said("leakage.mean_ml_per_h", 1, "ml/h"))
    yield from _kept("mean friction", joined(said("friction.power", 1, "W", 3), said("friction.torque", 1, "N m", 3)))
    stiff = joined(said("film.axial_stiffness", 1e-6, "N/µm", 3), said("film.tilt_stiffness", 1, "N m/rad", 3))
    yield from _kept("film stiffness", stiff)
    balance = get("closing.balance_ratio")
    ratio = None if balance is None else f"balance ratio {balance:.3g}"
    yield from _kept("closing force", joined(said("closing.force", 1, "N"), ratio))
    yield from _kept("critical speed", said("stability.critical_speed", 1, "rad/s"))
    yield from _kept("margin to contact", said("contact_margin", 1, "× this forcing", 3))
    yield from _kept("touches", joined(said("contact.touches", 1, ""), said("contact.depth", 1e6, "µm deep", 3)))
    yield from _kept("wear rate", said("contact.wear_rate", 3.6e9, "µm/h", 3) if get("contact.wear_rate") else None)
    yield from _kept("energy residual", said("energy_residual", 1, "", 2))


def written(value: float, digits: int) -> str:
    """`digits` significant figures; large numbers in full, with thousands marked."""
    if 1e4 <= abs(value) < 1e7:
        return f"{float(f'{value:.{digits}g}'):,.0f}".replace(",", " ")
    return f"{value:.{digits}g}"


def _kept(name: str, value):
    return [(name, value)] if value else []


def _name(ax, y: float, words: str, colour: str, below: bool = False) -> None:
    """Names a horizontal line above its right end, or below it."""
    where = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points", "ha": "right"}
    where |= {"va": "top", "xytext": (-2, -2)} if below else {"va": "bottom", "xytext": (-2, 2)}
    ax.annotate(words, (1, y), color=colour, fontsize=8, bbox=PAPER, **where)


def _span(ax, run: Run, first: int) -> None:
    start, end = run.progress[first], run.progress[-1]
    ax.set_xlim(start, end if end > start else start + 1)
