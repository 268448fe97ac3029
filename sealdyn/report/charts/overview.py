"""The figure a seal engineer pins to the wall: question, verdict, orbit, film, tilt, leakage, spectrum, numbers."""

import math

import numpy as np
from matplotlib import rc_context

from ...answers import Axis, Level, Panel, Series
from ...quantities import in_words, printed, reading_in, shown_in
from ...status import Status
from ..panels import draw_panel
from ..summary import is_below, is_radial, tilt_resolved
from ..text import written_units
from . import followers, orbit, spectrum
from .page import BLACK, GREY, PALE, absent, header, look, number, save, sheet
from .record import Run

# Rows of the right-hand side; the first of each pair is of the whole run.
ROWS = {"film": "film, end", "tilt": "tilt, end", "flow": "spectrum"}
# Samples that a panel of the last turns needs.
FEWEST = 16
# Numbers on the x axis of a panel of the last turns: of thousands of turns more would touch each other.
TURNS = 5
# Of the thickest film: a line further off is not drawn.
FAR = 4.0
# Of the largest contact force: with less on average the faces touch now and then, and the largest one is marked.
BRIEF = 0.1
# Name of a row, and what stands in it: key of the summary, quantity, digits, words after it.
NUMBERS = (
    ("smallest film", ("h_min.value", "h_min", 4, ""), ("h_min.of_clearance", "share", 3, " of clearance")),
    ("tilt max / min / mean", *((f"relative_misalignment.{k}", "misalignment", 3, "") for k in ("max", "min", "mean"))),
    ("steady max / min", *((f"relative_misalignment.steady_{k}", "misalignment", 4, "") for k in ("max", "min"))),
    ("closed form max / min", *((f"closed_form.relative_{k}", "misalignment", 4, "") for k in ("max", "min"))),
    ("mean leakage", ("leakage.mean", "leakage", 4, "")),
    ("mean friction", ("friction.power", "power", 3, ""), ("friction.torque", "torque", 3, "")),
    ("film stiffness", *((f"film.{kind}_stiffness", f"{kind}_stiffness", 4, "") for kind in ("axial", "tilt"))),
    ("closing force", ("closing.force", "force", 4, ""), ("closing.balance_ratio", "1", 3, " balance ratio")),
    ("critical speed", ("stability.critical_speed", "speed", 4, "")),
    ("margin", ("contact_margin", "1", 3, " × this forcing")),
    ("touches", ("contact.touches", "1", 4, ""), ("contact.depth", "depth", 3, " deep")),
    ("wear rate", ("contact.wear_rate", "wear_rate", 3, "")),
    ("energy residual", ("energy_residual", "1", 2, "")),
)
# Where the volume of a gas is counted.
NORMAL = " (0 °C, 1.01325 bar)"


# Titles stay where they are put: nothing is above them that they had to make room for, and looking takes a quarter of
# the drawing.
@rc_context({"axes.titley": 1.0})
@look()
def draw(archive_path, out_path, turns: float = 4.0):
    """Everything on one sheet; the enlarged panels show the last `turns` turns."""
    run = Run(archive_path, over_time=True)
    if is_radial(run.info):
        return followers.draw(archive_path, out_path, turns)
    first, moves = run.last(turns), spectrum.has_orders(run)
    # Whether the faces tilt against each other.
    tilts = run.has("relative_misalignment") and run.largest("relative_misalignment") > 0
    figure = sheet(13.5, 9.4 if tilts else 6.9)
    ends = first > 0 and run.rows - first >= FEWEST
    ax = _placed(figure, header(figure, run) - 0.4 / figure.get_figheight(), tilts, ends, moves)
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


def _placed(figure, top: float, tilts: bool, ends: bool, moves: bool) -> dict:
    """Axes by name, by hand: every run draws this page, and a layout engine would take half of its time.  Aligned faces
    have no panels of tilts, a short run none of its end, one without orders no spectrum: the others take their room."""
    height = figure.get_figheight()
    low, ratios = 0.63 / height, {"height_ratios": (5, 3), "hspace": 0.25} if tilts else {}
    left = figure.add_gridspec(1 + tilts, 1, left=0.056, right=0.326, bottom=low, top=top, **ratios)
    rows = [name for name in ROWS if tilts or name != "tilt"]
    right = figure.add_gridspec(len(rows), 2, left=0.385, right=0.975, bottom=0.74 / height, top=top, wspace=0.26,
                                hspace=0.45)  # fmt: skip
    ax = {name: figure.add_subplot(left[row]) for row, name in enumerate(["orbit"] * tilts + ["numbers"])}
    for row, name in enumerate(rows):
        beside = moves if name == "flow" else ends
        ax[name] = figure.add_subplot(right[row, 0] if beside else right[row, :])
        if beside:
            ax[ROWS[name]] = figure.add_subplot(right[row, 1])
    return ax


def _panel(ax, run: Run, title: str, axis: Axis, series, levels=(), first: int = 0) -> None:
    """Draws curves over the progress from row `first` on."""
    start, end = run.progress[first], run.progress[-1]
    # A tick at an end is not to be lost to rounding.
    more = 1e-6 * (end - start) if end > start else 1.0
    title += f", {orbit.window(run, first)}" if first else ""
    draw_panel(ax, Panel(title, Axis(low=start - more, high=end + more), axis, series, levels),
               width=1.9 * ax.get_position().width * ax.figure.get_figwidth())  # fmt: skip
    # A mark on the edge is whole.
    for line in ax.lines:
        line.set_clip_on(line.get_marker() in ("None", ""))


def film_panel(ax, run: Run, first: int) -> None:
    """h_min with the design clearance, contact, where the run ended if it did not end well, and a speed that varies."""
    if _lacking(ax, run, title := "Smallest film thickness", "h_min"):
        return
    per, (x, h, unit) = run.shown("h_min", first)[1], run.drawn("h_min", first)
    low, top, touch = np.nanmin(h), np.nanmax(h), per * run.touch_at
    levels = [Level(per * run.clearance, "clearance", legend=True, number=True)] if run.clearance else []
    levels += [Level(touch, "asperities meet" if touch else "contact", style="contact", legend=True, number=touch > 0)]
    if first:
        margin = max(0.3 * (top - low), 2e-3 * top)
        ends = low - margin, top + margin
        levels = [one for one in levels if ends[0] <= one.value <= ends[1]]
    else:
        # Where asperities meet far above all films, that line is left out.
        levels = [one for one in levels if one.value < FAR * max(top, per * (run.clearance or 0.0))]
        top = 1.1 * max(top, *(one.value for one in levels))
        # A line for each sweep has its place above the curve.
        top *= 1.0 + HEIGHT * sweep_lines(ax, run)
        ends = min(1.1 * low, -0.03 * top), top
    series = [Series("line", x, h, style="film thin")]
    if not first and run.touches:
        series += _touch(run, x, h)
    if run.status in (Status.COLLAPSED, Status.FAILED, Status.INTERRUPTED):
        series.append(Series("marks", x[-1:], h[-1:], label=run.status, style=f"{run.status} cross large front"))
    series += [] if first else _speed(run, 0.97 * ends[1])
    _panel(ax, run, title, Axis(unit, "h_min", low=ends[0], high=ends[1]), series, levels, first)


def _speed(run: Run, top: float) -> list[Series]:
    """A shaft speed that varies, from 0 to the `top`: its ends are in its name, an axis has no room here."""
    if not run.varies:
        return []
    x, speed = run.envelope("shaft_speed")
    low, high = speed.min(), speed.max()
    with reading_in(written_units(run.info)):
        words = f"shaft speed, {in_words('speed', low)} to {in_words('speed', high)}"
    low, high = min(low, 0.0), max(high, 0.0)
    return [Series("line", x, top * (speed - low) / (high - low), label=words, style="grey dotted")]


def _touch(run: Run, x, h) -> list[Series]:
    """Where the faces touch now and then, when they press hardest: what lasts a moment is not seen in a long run."""
    when, force, _ = run.drawn("contact_force")
    most = int(np.nanargmax(force))
    if not np.nanmean(force) < BRIEF * force[most]:
        return []
    at = [int(np.argmin(np.abs(x - when[most])))]
    words = f"touches at {number(x[at[0]], '.3g')} {run.progress_unit}"
    return [Series("marks", x[at], h[at], label=words, style="contact circle small front")]


def tilt_panel(ax, run: Run, first: int) -> None:
    """Relative misalignment between the closed form's extremes."""
    if _lacking(ax, run, title := "Relative misalignment", "relative_misalignment"):
        return
    per, (x, tilt, unit) = run.shown("relative_misalignment", first)[1], run.drawn("relative_misalignment", first)
    top = np.nanmax(tilt)
    theory = run.summary.get("closed_form") or {}
    found = [per * theory[k] for k in ("relative_max", "relative_min") if isinstance(theory.get(k), int | float)]
    found = found if found and 0 < max(found) < 3 * top else []
    named = ("closed form, max and min", "")
    levels = [Level(at, words, style="theory dashed", legend=True) for at, words in zip(found, named, strict=False)]
    axis = Axis(unit, "tilt", low=0.0, high=1.1 * max(top, *found, 0.0))
    _panel(ax, run, title, axis, [Series("line", x, tilt, style="tilt thin")], levels, first)


def leakage_panel(ax, run: Run) -> None:
    """Leakage at both radii; they differ while the film swells and shrinks."""
    sides = [side for side in ("outer", "inner") if run.has(f"leakage_{side}")]
    title = "Leakage, high to low pressure"
    if not sides and _lacking(ax, run, title, "leakage_inner"):
        return
    # The outer one wide beneath, so that both are seen where they agree; one unit, that of the larger.
    per, unit = min(run.shown(f"leakage_{side}")[::-1] for side in sides)
    series, styles = [], {"outer": "yellow thick", "inner": "leakage thin"}
    for side in sides:
        x, flow = run.envelope(f"leakage_{side}")
        series.append(Series("line", x, per * flow, label=f"{side} radius", style=styles[side]))
    gas = _of_gas(run.summary) or (run.resolved.get("film") or {}).get("gas")
    ax.margins(y=0.25)
    _panel(ax, run, title, Axis(f"{unit}{NORMAL if gas else ''}", " "), series)


def _of_gas(summary: dict) -> bool:
    return bool((summary.get("leakage") or {}).get("conditions"))


def contact_panel(ax, run: Run) -> None:
    """Load that the touching asperities carry, how much at most, and which share of the closing force."""
    x, force, unit = run.drawn("contact_force")
    most = int(np.nanargmax(force))
    words = f"at most {number(force[most], '.3g')} {unit}"
    share = (run.summary.get("contact") or {}).get("share_of_closing")
    if isinstance(share, float):
        words += f", on average {in_words('share', share, digits=3)} of the absolute closing force"
    series = [Series("shade", x, force, style="contact"), Series("line", x, force, label=words, style="contact thin")]
    if np.nanmean(force) < BRIEF * force[most]:
        # A touch at the edge of the panel would lie on its frame.
        series.append(Series("marks", x[[most]], force[[most]], style="contact circle small front"))
    _panel(ax, run, "Contact force", Axis(unit, " ", low=0.0, high=1.1 * force[most]), series)


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
    with reading_in(written_units(run.info)):
        rows = list(_numbers(run.summary)) or [("no summary", run.status)]
    step = min(0.082, 0.97 / len(rows))
    for line, (name, value) in enumerate(rows):
        for x, words, colour in ((0.0, name, GREY), (0.44, value, BLACK)):
            ax.text(x, 0.95 - step * line, words, va="center", transform=ax.transAxes, fontsize=8, color=colour)
    below = 0.95 - step * (np.arange(len(rows)) + 0.5)
    ax.hlines(below, 0, 1, color=PALE, lw=0.5, capstyle="projecting", transform=ax.transAxes)


def _numbers(summary: dict):
    """(name, value in words) of what the summary holds; with strokes in the name, values of one unit in its order."""
    for name, *parts in NUMBERS:
        values = [_value(summary, key) for key, *_ in parts]
        known = [value for value in values if value is not None]
        # Of no seal; faces of no wear coefficient say nothing of wear.
        beyond = name == "critical speed" and known and known[0] > (_value(summary, "stability.fastest") or np.inf)
        if beyond or (not any(known) and (not known or "/" in name or name == "wear rate")):
            continue
        if name == "film stiffness" and summary.get("contact"):
            name = "film and asperities"
        if "/" in name:
            unit, factor = shown_in(parts[0][1], known)
            near = tilt_resolved(summary) if parts[0][0].startswith("relative_misalignment") else 0.0
            told = " / ".join(_one_of(v, near, factor, parts[0][2]) for v in values) + f" {unit}"
        else:
            told = ", ".join(
                in_words(held, v, digits) + words
                for v, (_, held, digits, words) in zip(values, parts, strict=True)
                if v is not None
            )
        yield name, printed(told).replace("-", "−") + (NORMAL if name == "mean leakage" and _of_gas(summary) else "")


def _one_of(value: float | None, near: float, factor: float, digits: int) -> str:
    """A number; one below what the accuracy resolves, `near`, as that."""
    below = is_below(value, near)
    return "–" if value is None else "<" * below + number(factor * (near if below else value), f".{digits}g")


def _value(summary: dict, key: str) -> float | None:
    """A number of the summary; None if it is not there, or no number."""
    value = summary
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value if isinstance(value, int | float) and np.isfinite(value) else None


KINDS = {"axial_sweep": "axial", "angular_sweep": "angular"}
# Frequencies that are named (times a power of ten), the least room between two names, how much more the first one
# needs, and the height of a line with its names, as shares of the panel.
NAMED, ROOM, FIRST, HEIGHT = (1, 2, 5), 0.15, 0.17, 0.11


def sweep_lines(ax, run: Run) -> int:
    """Draws a line for each sweep of a run along the top of a panel over its progress, with frequencies in Hz; how many
    there are."""
    found = [(kind, sweep) for kind in KINDS for sweep in run.housing(kind)]
    if not found:
        return 0
    time, level = run.values("time"), 1.0 - 0.4 * HEIGHT
    low, high = (float(run.progress[k]) for k in (0, -1))
    for kind, sweep in found:
        last = min(sweep["start"] + span(sweep), time[-1])
        shown = (max(sweep["start"], time[0]), last)
        if shown[0] >= shown[1]:
            continue
        places = np.interp(shown, time, run.progress)
        way = ax.get_xaxis_transform()
        ax.plot(places, [level, level], color=GREY, lw=1.0, transform=way, clip_on=False)
        marks = [(f, float(np.interp(at, time, run.progress))) for f, at in _marks(sweep)
                 if shown[0] <= at <= shown[1] * (1 + 1e-12)]  # fmt: skip
        for k, (frequency, place) in enumerate(_named(marks, low, high)):
            words = f"{frequency:.4g} Hz" if k else f"{KINDS[kind]} sweep, {frequency:.4g} Hz"
            ax.plot([place], [level], marker="|", ms=5, color=GREY, transform=way, clip_on=False)
            left = _fits(place, low, high)
            ax.annotate(words, (place, level), xycoords=way, xytext=(2 if left else -2, -3), va="top", fontsize=7,
                        textcoords="offset points", ha="left" if left else "right", color=GREY)  # fmt: skip
        level -= HEIGHT
    return len(found)


def _fits(place: float, low: float, high: float) -> bool:
    """Whether a name has room to the right of its place; else it stands to the left."""
    return place < high - ROOM * (high - low)


def _named(marks, low: float, high: float) -> list[tuple[float, float]]:
    """Those of `marks` (frequency, place) whose names have room between `low` and `high`; one that stands to the left
    of its place, as the last one may, goes before those that are in its way."""
    found = []
    for frequency, place in marks:
        fits = _fits(place, low, high)
        while len(found) > 1 and not fits and place - found[-1][1] < 2.0 * ROOM * (high - low):
            found.pop()
        taken = found[-1][1] + FIRST * (len(found) == 1) * (high - low) if found else -math.inf
        if place - taken >= (1.0 if fits else 2.0) * ROOM * (high - low):
            found.append((frequency, place))
    return found


def span(sweep: dict) -> float:
    """How long (s) a resolved sweep takes."""
    if sweep.get("duration") is not None:
        return sweep["duration"]
    first, last = sweep["frequency"]
    return 60.0 * abs(math.log2(last / first)) / sweep["octaves_per_minute"]


def _marks(sweep: dict) -> list[tuple[float, float]]:
    """Frequencies (Hz) that are named, its first and last among them, and when they are (s), in the order of time."""
    first, last = sweep["frequency"]
    low, high = sorted((first, last))
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    named = [n * 10.0**k for k in decades for n in NAMED if low < n * 10.0**k <= high]

    def when(f):
        linear = sweep["spacing"] == "linear"
        share = (f - first) / (last - first) if linear else math.log(f / first) / math.log(last / first)
        return sweep["start"] + share * span(sweep)

    return sorted(((f, when(f)) for f in {first, last, *named}), key=lambda pair: pair[1])
