"""The figure a seal engineer pins to the wall: question, verdict, orbit, film, tilt, leakage, spectrum, numbers."""

import numpy as np
from matplotlib import rc_context

from ...status import Status
from ..summary import is_radial
from ..text import speed_unit
from . import followers, housing_sweep, orbit, spectrum
from .page import PAPER, absent, free_side, header, level, look, save, sheet, written
from .palette import CONTACT, FILM, GREY, LEAK, PALE, STATUS, THEORY, TILT, YELLOW
from .record import Run, fitting

# Rows of the right-hand side; the first of each pair is of the whole run.
ROWS = {"film": "film, end", "tilt": "tilt, end", "flow": "spectrum"}
# Height of a name beside a line, as a share of the panel.
NAME_HEIGHT = 0.1
# Samples that a panel of the last turns needs.
FEWEST = 16
# Numbers on the x axis of a panel of the last turns: of thousands of turns more would touch each other.
TURNS = 5
# Of the thickest film: a line further off is not drawn.
FAR = 4.0
# How the units of stiffnesses begin, which are told in thousands where they are large.
STIFF = ("N/", "N ")
# A speed, in the unit that the scenario has.
SPEED = "{} speed"
# Name of a row, and what stands in it: key of the summary, factor, words, digits.
NUMBERS = (
    ("smallest film", ("h_min.value", 1e6, "{} µm", 4), ("h_min.of_clearance", 100, "{} % of clearance", 3)),
    ("tilt max / min / mean", *((f"relative_misalignment.{k}", 1e6, "{} µrad", 3) for k in ("max", "min", "mean"))),
    ("steady max / min", *((f"relative_misalignment.steady_{k}", 1e6, "{} µrad", 4) for k in ("max", "min"))),
    ("closed form max / min", *((f"closed_form.relative_{k}", 1e6, "{} µrad", 4) for k in ("max", "min"))),
    ("mean leakage", ("leakage.mean_ml_per_h", 1, "{} ml/h", 4)),
    ("mean friction", ("friction.power", 1, "{} W", 3), ("friction.torque", 1, "{} N m", 3)),
    ("film stiffness", ("film.axial_stiffness", 1e-6, "{} N/µm", 3), ("film.tilt_stiffness", 1, "{} N m/rad", 3)),
    ("closing force", ("closing.force", 1, "{} N", 4), ("closing.balance_ratio", 1, "balance ratio {}", 3)),
    ("critical speed", ("stability.critical_speed", 1, SPEED, 4)),
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
    first, tilts, moves = run.last(turns), _tilts(run), spectrum.has_orders(run)
    figure = sheet(13.5, 9.0 if tilts else 6.6)
    ends = first > 0 and run.rows - first >= FEWEST
    ax = _placed(figure, header(figure, run) - 0.225 / figure.get_figheight(), tilts, ends, moves)
    key_numbers(ax["numbers"], run)
    if tilts:
        ax["orbit"].set_anchor("N")
        orbit.panel(ax["orbit"], run)
    for column, start in (("", 0), (", end", first)):
        if film := ax.get("film" + column):
            film_panel(film, run, start)
        if tilt := ax.get("tilt" + column):
            tilt.sharex(film)
            tilt_panel(tilt, run, start)
    ax["flow"].sharex(ax["film"])
    (contact_panel if run.touches else leakage_panel)(ax["flow"], run)
    # Panels above share their x axis with the lowest of the column.
    for name in ("flow", "tilt, end" if tilts else "film, end"):
        if name in ax:
            ax[name].set_xlabel(run.progress_label)
    if "film, end" in ax:
        ax["film, end"].locator_params(axis="x", nbins=TURNS)
    if moves:
        spectrum.panel(ax["spectrum"], run)
    return save(figure, out_path)


def _tilts(run: Run) -> bool:
    """Whether the faces tilt against each other."""
    return run.has("relative_misalignment") and run.largest("relative_misalignment") > 0


def _placed(figure, top: float, tilts: bool, ends: bool, moves: bool) -> dict:
    """Axes by name, by hand: every run draws this page, and a layout engine would take half of its time.  Aligned faces
    have no panels of tilts, a short run none of its end, one without orders no spectrum: the others take their room."""
    height = figure.get_figheight()
    low, ratios = 0.63 / height, {"height_ratios": (5, 3), "hspace": 0.27} if tilts else {}
    left = figure.add_gridspec(1 + tilts, 1, left=0.056, right=0.326, bottom=low, top=top, **ratios)
    rows = [name for name in ROWS if tilts or name != "tilt"]
    right = figure.add_gridspec(len(rows), 2, left=0.385, right=0.975, bottom=0.74 / height, top=top, wspace=0.26,
                                hspace=0.33)  # fmt: skip
    ax = {name: figure.add_subplot(left[row]) for row, name in enumerate(["orbit"] * tilts + ["numbers"])}
    for row, name in enumerate(rows):
        beside = moves if name == "flow" else ends
        ax[name] = figure.add_subplot(right[row, 0] if beside else right[row, :])
        if beside:
            ax[ROWS[name]] = figure.add_subplot(right[row, 1])
    return ax


def film_panel(ax, run: Run, first: int) -> None:
    """h_min with the design clearance, contact, and where the run ended if it did not end well."""
    title = "Smallest film thickness" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "h_min"):
        return
    per, (x, h, unit) = run.shown("h_min", first)[1], run.drawn("h_min", first)
    ax.plot(x, h, color=FILM)
    ax.set(title=title, ylabel=f"h_min, {unit}")
    _span(ax, run, first)
    low, top = np.nanmin(h), np.nanmax(h)
    clearance, touch = per * (run.clearance or 0.0), per * run.touch_at
    lines = [(clearance, "clearance", {"colour": GREY})] if run.clearance else []
    lines += [(touch, "asperities meet" if touch else "contact", {"colour": CONTACT, "ls": "-", "lw": 1.2})]
    if first:
        margin = max(0.3 * (top - low), 2e-3 * top)
        ax.set_ylim(low - margin, top + margin)
        for at, _, style in lines:
            level(ax, at, "", **style)
    else:
        # Where asperities meet far above all films, that line is left out.
        lines = [line for line in lines if line[0] < FAR * max(top, clearance)]
        top = 1.2 * max(top, *(line[0] for line in lines))
        room = NAME_HEIGHT * top
        # A line for each sweep has its place above the curve.
        swept = housing_sweep.HEIGHT * housing_sweep.sweep_lines(ax, run)
        top *= 1.0 + swept
        ax.set_ylim(min(1.1 * low, -0.03 * top), top)
        levels = [np.full_like(x, at) for at, *_ in lines]
        places = [free_side(x, [h, *levels[:k], *levels[k + 1 :]], line[0], room) for k, line in enumerate(lines)]
        if None in places:
            # A film that swings through a name everywhere: the names stand above it.
            for at, name, style in lines:
                level(ax, at, "", label=name, **style)
            ax.set_ylim(top=(1.15 + 0.5 * swept) * top)
            ax.legend(loc="upper left", ncols=2, borderaxespad=0.0, bbox_to_anchor=(0.0, 1.0 - 1.5 * swept))
        for (at, name, style), found in zip(lines, places if None not in places else (), strict=False):
            level(ax, at, name, **found, **style)
            if found["below"] and at < 1.5 * room:
                ax.set_ylim(bottom=min(ax.get_ylim()[0], at - 1.5 * room))
    if not first and run.touches:
        _mark_touch(ax, run, x, h)
    if run.status in (Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED):
        colour = STATUS[run.status]
        ax.plot(x[-1], h[-1], "X", ms=8, color=colour, clip_on=False, zorder=5)
        ax.annotate(run.status, (x[-1], h[-1]), xytext=(-8, -12 if h[-1] > 0.75 * top else 9), color=colour,
                    textcoords="offset points", ha="right", weight="bold", bbox=PAPER)  # fmt: skip


def _mark_touch(ax, run: Run, x, h) -> None:
    """Where the faces touch now and then, when they press hardest: what lasts a moment is not seen in a long run."""
    when, force, _ = run.drawn("contact_force")
    most = int(np.nanargmax(force))
    if not np.nanmean(force) < BRIEF * force[most]:
        return
    at = int(np.argmin(np.abs(x - when[most])))
    ax.plot(x[at], h[at], "o", ms=3.5, color=CONTACT, clip_on=False, zorder=5)
    unit = run.progress_label.partition(", ")[2] or "turns"
    # Towards the middle of the panel.
    side, away = ("right", -6) if x[at] > 0.5 * (x[0] + x[-1]) else ("left", 6)
    ax.annotate(f"touches at {written(x[at], 3)} {unit}", (x[at], h[at]), xytext=(away, 0), color=CONTACT,
                textcoords="offset points", ha=side, va="center", fontsize=8, bbox=PAPER)  # fmt: skip


def tilt_panel(ax, run: Run, first: int) -> None:
    """Relative misalignment between the closed form's extremes."""
    title = "Relative misalignment" + (f", {orbit.window(run, first)}" if first else "")
    if _lacking(ax, run, title, "relative_misalignment"):
        return
    per, (x, tilt, unit) = run.shown("relative_misalignment", first)[1], run.drawn("relative_misalignment", first)
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


# Mean leakage (ml/h), and a tenth of the largest, from which it is told in l/min, as that of gases.
MUCH = 1e5
# Of the largest contact force: with less on average the faces touch now and then, and the largest one is marked.
BRIEF = 0.1
LITRES, NORMAL = "l/min", "l/min (0 °C, 1.01325 bar)"


def leakage_panel(ax, run: Run) -> None:
    """Leakage at both radii; they differ while the film swells and shrinks."""
    sides = [side for side in ("inner", "outer") if run.has(f"leakage_{side}")]
    title = "Leakage, high to low pressure"
    if not sides and _lacking(ax, run, title, "leakage_inner"):
        return
    # The outer one wide and pale beneath, so that both are seen where they agree.
    flows = {side: run.drawn(f"leakage_{side}") for side in reversed(sides)}
    coarser = _litres(run)
    for side, (x, flow, unit) in flows.items():
        if coarser:
            flow, unit = flow / 6e4, coarser
        colour, width = (LEAK, 0.8) if side == "inner" else (YELLOW, 2.0)
        ax.plot(x, flow, label=f"at the {side} radius", color=colour, lw=width)
    ax.set(title=title, ylabel=unit)
    ax.margins(y=0.25)
    ax.legend(loc="upper right", ncols=2, borderaxespad=0.0)
    _span(ax, run, 0)


def _litres(run: Run) -> str:
    """The unit of a leakage that is told in litres, a gas's always; empty of one told in millilitres."""
    if _of_gas(run.summary) or (run.resolved.get("film") or {}).get("gas"):
        return NORMAL
    mean = _value(run.summary, "leakage.mean_ml_per_h")
    sides = [f"leakage_{side}" for side in ("inner", "outer") if run.has(f"leakage_{side}")]
    most = max((run.shown(side)[1] * run.largest(side) for side in sides), default=0.0)
    return LITRES if max(most if mean is None else abs(mean), 0.1 * most) > MUCH else ""


def _of_gas(summary: dict) -> bool:
    return bool((summary.get("leakage") or {}).get("conditions"))


def contact_panel(ax, run: Run) -> None:
    """Load that the touching asperities carry, how much at most, and which share of the closing force."""
    x, force, unit = run.drawn("contact_force")
    ax.fill_between(x, force, color=CONTACT, alpha=0.25, lw=0)
    ax.plot(x, force, color=CONTACT, lw=0.9)
    most = int(np.nanargmax(force))
    if np.nanmean(force) < BRIEF * force[most]:
        # A touch at the edge of the panel would lie on its frame.
        ax.plot(x[most], force[most], "o", ms=3.5, color=CONTACT, clip_on=False)
    words = f"at most {written(force[most], 3)} {unit}"
    share = (run.summary.get("contact") or {}).get("share_of_closing")
    if isinstance(share, float):
        words += f"\non average {written(100 * share, 3)} % of the absolute closing force"
    ax.text(0.99, 0.97, words, transform=ax.transAxes, ha="right", va="top", fontsize=8, color=CONTACT)
    ax.set(title="Contact force", ylabel=unit, ylim=(0, 1.35 * np.nanmax(force)))
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
    rows = list(_numbers(run.summary, speed_unit(run.info), _litres(run))) or [("no summary", run.status)]
    step = min(0.082, 0.97 / len(rows))
    for line, (name, value) in enumerate(rows):
        y = 0.95 - step * line
        ax.text(0.0, y, name, va="center", transform=ax.transAxes, color=GREY, fontsize=8)
        ax.text(0.44, y, value, va="center", transform=ax.transAxes, fontsize=8)
    below = 0.95 - step * (np.arange(len(rows)) + 0.5)
    ax.hlines(below, 0, 1, color=PALE, lw=0.5, capstyle="projecting", transform=ax.transAxes)


def _numbers(summary: dict, speed: tuple[str, float], litres: str = ""):
    """(name, value in words) of what the summary holds; with strokes in the name, tilts in the order of the name.
    `speed`: unit of speeds, and how many of it make one rad/s; `litres`: unit of the leakage if not ml/h."""
    litres = NORMAL if _of_gas(summary) else litres
    for name, *parts in NUMBERS:
        if name == "mean leakage" and litres:
            parts = ((parts[0][0], 1 / 6e4, f"{{}} {litres}", 4),)
        if name == "film stiffness" and summary.get("contact"):
            name = "film and asperities"
        values = [_value(summary, key) for key, *_ in parts]
        if name == "critical speed" and (values[0] or 0.0) > (_value(summary, "stability.fastest") or np.inf):
            # Of no seal.
            continue
        # Faces of no wear coefficient say nothing of wear.
        if all(value is None for value in values) or (name == "wear rate" and values == [0.0]):
            continue
        if "/" not in name:
            yield (
                name,
                ", ".join(_said(v, *part[1:], speed) for v, part in zip(values, parts, strict=True) if v is not None),
            )
            continue
        # One unit for all of them.
        largest = max(abs(value) for value in values if value is not None)
        if not largest:
            continue
        unit, finer = fitting("µrad", 1e6 * largest)
        told = ["–" if v is None else written(1e6 * finer * v, part[-1]) for v, part in zip(values, parts, strict=True)]
        yield name, f"{' / '.join(told)} {unit}"


def _value(summary: dict, key: str) -> float | None:
    """A number of the summary; None if it is not there, or no number."""
    value = summary
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value if isinstance(value, int | float) and np.isfinite(value) else None


def _said(value: float, factor: float, words: str, digits: int, speed: tuple[str, float]) -> str:
    """A number in words, in a finer unit or in that of speeds where its own does not fit."""
    if words == SPEED:
        words, factor = f"{{}} {speed[0]}", speed[1]
    number, _, unit = words.partition(" ")
    size = abs(factor * value)
    other, more = (f"k{unit}", 1e-3) if unit[:2] in STIFF and size >= 1e5 else fitting(unit, size)
    return f"{number} {other}".format(written(more * factor * value, digits)).rstrip()


def _span(ax, run: Run, first: int) -> None:
    start, end = run.progress[first], run.progress[-1]
    # A tick at an end is not to be lost to rounding.
    more = 1e-6 * (end - start)
    ax.set_xlim(start - more, end + more if end > start else start + 1)
