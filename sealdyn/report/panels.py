"""The figure of any answer: its panels, drawn from plain data with units from `quantities`."""

import importlib.util
from itertools import groupby, pairwise
from textwrap import fill

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize, SymLogNorm
from matplotlib.ticker import LogLocator, MultipleLocator

from ..answers import Axis, Panel, Series, panels_of, plain
from ..archive import read_study
from ..quantities import printed, quantity, reading_in, shown_in
from .charts.page import (
    COLOURS,
    CYCLE,
    DASHES,
    GREY,
    MARKS,
    PALE,
    PAPER,
    PRESSURE,
    THICKNESS,
    absent,
    annulus,
    heading,
    logarithmic,
    look,
    no_label_cut,
    number,
    power,
    save,
    sheet,
    study_words,
)

# Columns of panels side by side; width (inches) of a figure by their number; height of a panel alone and in a stack.
ACROSS, WIDTHS, ALONE, STACKED = 3, (8.5, 11.5, 13.0, 13.5), 4.6, 3.0
# Height of a panel of several rows, and from how many panels on four stand in a row.
IN_ROWS, MANY = 3.4, 7
# Letters of a legend and of a title that an inch has room for, and points of height that a row of a legend takes.
LETTERS, BOLD, ROW = 11.0, 9.0, 12.0
# Of the largest value of a diverging map: below, its colours are linear.
LINEAR = 1 / 300
# Of the value: the finest scale of colours.
FINEST = 2e-3
# A point of a curve's label away from its mark.
BESIDE = (6, 5)


@look()
def draw(path, out=None):
    """The figure of a study's archive; `out` as in page.save.  A study whose chart has a file of its own draws that."""
    study = read_study(path)
    own = f"{__package__}.charts.study_{study['study']}"
    if not study.get("panels") and importlib.util.find_spec(own):
        return importlib.import_module(own).draw(path, out)
    answer = study["answer"]
    words = "\n".join([answer.get("found") or answer["message"], *answer.get("notes", [])[:2]])
    figure = study_sheet(study, panels_of(study["panels"]), study.get("asks") or "", bold=words)
    return save(figure, out)


def study_sheet(study, panels: list[Panel], title: str = "", below: str = "", bold: str = ""):
    """The figure of a study's panels; words above them as page.study_words has them."""
    with reading_in(study.get("written")):
        return sheet_of(panels, *study_words(study, title, below, bold))


@look()
def sheet_of(panels: list[Panel], title: str, below: str, bold: str, colour: str = "black"):
    """A figure: heading, then the panels."""
    stacks = _stacks(panels_of(plain(panels)))
    most = ACROSS + (len(stacks) >= MANY)
    # Rows that nobody began are of one length.
    across = most if any(stack[0].first for stack in stacks) else -(-len(stacks) // -(-len(stacks) // most))
    rows: list[list] = []
    for stack in stacks:
        if not rows or len(rows[-1]) == across or stack[0].first:
            rows.append([])
        rows[-1].append(stack)
    alone = ALONE if len(rows) == 1 else IN_ROWS
    heights = [max(alone * stack[0].tall if len(stack) == 1 else STACKED * sum(panel.tall for panel in stack)
                   for stack in row) for row in rows]  # fmt: skip
    figure = sheet(WIDTHS[max(map(len, rows)) - 1], 1.1 + sum(heights))
    top = heading(figure, title, below, bold, colour)
    width = figure.get_figwidth()
    no_label_cut(figure, top)
    grid = figure.add_gridspec(len(rows), 1, height_ratios=heights)
    for k, row in enumerate(rows):
        columns = grid[k].subgridspec(1, len(row), width_ratios=[stack[0].wide for stack in row])
        for j, stack in enumerate(row):
            share = width * stack[0].wide / sum(other[0].wide for other in row)
            _draw_stack(figure, columns[j], stack, share)
    return figure


def _stacks(panels) -> list[list[Panel]]:
    first = [k for k, panel in enumerate(panels) if k == 0 or not panel.below]
    return [panels[a:b] for a, b in pairwise([*first, len(panels)])]


def _draw_stack(figure, place, stack, width: float) -> None:
    """Panels above one another; neighbours of one quantity along x share that axis."""
    cells = place.subgridspec(len(stack), 1, height_ratios=[panel.tall for panel in stack])

    def along(held):
        x, panel = held[1].x, held[1]
        return x.quantity, x.label, x.scale, tuple(x.words), panel.polar, bool(panel.series)

    alike = [list(group) for _, group in groupby(enumerate(stack), key=along)]
    for group in alike:
        shared = None
        for k, panel in group:
            kind = {"projection": "polar"} if panel.polar else {"sharex": shared}
            ax = figure.add_subplot(cells[k], **kind)
            shared = shared or ax
            draw_panel(ax, panel, width)
            if k != group[-1][0]:
                ax.set_xlabel("")
                ax.tick_params(labelbottom=False, which="both")


# --- one panel -------------------------------------------------------------------------------------------


def draw_panel(ax, panel: Panel, width: float = 8.0) -> None:
    """Series, levels, axes and legend of a panel on axes `ax` that are `width` inches wide or so."""
    if not panel.series:
        absent(ax, panel.title, panel.note or "nothing to draw")
        return
    # Axes in one scale have one unit, that of the larger.
    ends = {which: _values(panel, "xy" if panel.equal else which) for which in "xy"}
    x, y = (_Scaled(axis, ends[which]) for which, axis in (("x", panel.x), ("y", panel.y)))
    # matplotlib's own angles.
    x.factor = 1.0 if panel.polar else x.factor
    other = beside = None
    if panel.right:
        other = _Scaled(panel.right, _values(panel, "right"))
        beside = ax.twinx()
        beside.grid(False)
        beside.spines["right"].set_visible(True)
    # Scales first: some artists ask for them.
    if not panel.polar:
        x.scale(ax, "x")
        y.scale(ax, "y")
        if beside is not None:
            other.scale(beside, "y")
    for k, one in enumerate(panel.series):
        target, across = (beside, other) if one.right else (ax, y)
        DRAWN[one.kind](target, panel, one, x, across, _style(one.style, k))
    for one in panel.levels:
        _level(ax, one, x if one.upright else y)
    if panel.polar:
        ax.set_xticks([])
        ends = y.of([end for one in panel.series if one.kind == "map" for end in (one.y[0], one.y[-1])])
        annulus(ax, ends.min(), ends.max(), printed(panel.title))
    else:
        x.finish(ax, "x")
        y.finish(ax, "y")
        if beside is not None:
            other.finish(beside, "y")
    if panel.down:
        ax.invert_yaxis()
    if panel.equal:
        ax.set_aspect("equal", "datalim" if panel.y.low is None else "box")
    if panel.note:
        ax.text(0.985, 0.03, printed(panel.note), transform=ax.transAxes, ha="right", va="bottom", fontsize=8,
                color=GREY, bbox=PAPER, zorder=6)  # fmt: skip
    # Words along the y axis take of the width.
    _title_and_legend(ax, beside, panel, width - max(map(len, panel.y.words), default=0) / LETTERS)


class _Scaled:
    """An axis in the unit of a person: name, factor, numbers."""

    def __init__(self, axis: Axis, values):
        self.axis = axis
        self.unit, self.factor = ("", 1.0) if axis.words else shown_in(axis.quantity, values)

    def of(self, values) -> np.ndarray:
        """Numbers as drawn (NaN for None)."""
        return self.factor * np.array(values, float)

    @property
    def label(self) -> str:
        name = self.axis.label or quantity(self.axis.quantity).name
        return printed(", ".join(filter(None, (name.strip(), "degrees" if self.unit == "deg" else self.unit))))

    def scale(self, ax, which: str) -> None:
        if self.axis.scale == "log":
            logarithmic(ax, which)
        elif self.axis.scale == "asinh":
            getattr(ax, f"set_{which}scale")("asinh", linear_width=self.factor * (self.axis.width or 1.0))

    def finish(self, ax, which: str) -> None:
        """Name, ends, and ticks."""
        axis, put = getattr(ax, f"{which}axis"), getattr(ax, f"set_{which}ticks")
        getattr(ax, f"set_{which}label")(self.label)
        low, high = (None if end is None else end * self.factor for end in (self.axis.low, self.axis.high))
        if low is not None or high is not None:
            getattr(ax, f"set_{which}lim")(low, high)
        if self.axis.words:
            put(range(len(self.axis.words)), [printed(word) for word in self.axis.words])
            if which == "x" and sum(max(map(len, word.split("\n"))) for word in self.axis.words) > 60:
                ax.tick_params(axis="x", labelrotation=30)
        elif self.axis.scale == "asinh":
            ends, least = axis.get_view_interval(), self.factor * (self.axis.width or 1.0)
            most = max(abs(end) for end in ends)
            first, last = int(np.ceil(np.log10(least))), int(np.floor(np.log10(max(most, least))))
            step = max(1, (last - first + 1) // 4)
            powers = [10.0**k for k in range(last, first - 1, -step)][::-1]
            put([at for at in (*(-p for p in powers[::-1]), 0.0, *powers) if ends[0] <= at <= ends[1]])
            axis.set_major_formatter(lambda at, _: number(at) if 1e-3 <= abs(at) < 1e5 or at == 0 else _signed(at))
        elif self.unit == "deg" and np.ptp(axis.get_view_interval()) > 180.0:
            axis.set_major_locator(MultipleLocator(60.0 if which == "x" else 90.0))
        elif self.axis.quantity == "count" and self.axis.scale == "linear":
            axis.get_major_locator().set_params(integer=True)
        elif self.axis.scale == "log":
            low, high = sorted(axis.get_view_interval())
            if low > 0 and high / low > 300:
                axis.set_major_locator(LogLocator(numticks=8))
                axis.set_major_formatter(lambda at, _: number(at) if 1e-2 <= at < 1e4 else power(round(np.log10(at))))


def _signed(value: float) -> str:
    return ("−" if value < 0 else "") + power(round(np.log10(abs(value))))


def _values(panel: Panel, which: str) -> list[float]:
    """Ends (SI) of what is drawn along an axis, or along "xy": what decides its unit."""
    if which == "xy":
        return _values(panel, "x") + _values(panel, "y")
    found = [[panel.x.low, panel.x.high] if which == "x" else []]
    for one in panel.series:
        if which == "x":
            found.append(one.x)
        elif one.right == (which == "right"):
            found += [one.y, one.z if one.kind == "shade" and one.z is not None else []]
    if which != "right":
        found.append([one.value for one in panel.levels if one.upright == (which == "x")])
    known = [held[np.isfinite(held)] for held in (np.array(values, float) for values in found)]
    return [end for values in known if len(values) for end in (float(values.min()), float(values.max()))]


def _style(words: str, k: int) -> dict:
    """Colour, dashes, mark and the rest of a series, from the words of its style."""
    given = words.split()
    look = {
        "color": CYCLE[k % len(CYCLE)], "ls": "-", "marker": "", "mfc": "white" if "open" in given else None,
        "lw": 0.9 if "thin" in given else 2.4 if "thick" in given else 1.5,
        "markersize": 3.5 if "small" in given else 9.0 if "large" in given else 5.0,
        "alpha": 0.45 if "faint" in given else 1.0, "zorder": 5.0 if "front" in given else 2.0,
    }  # fmt: skip
    for word in given:
        if word in COLOURS:
            look["color"] = COLOURS[word]
        elif word in DASHES:
            look["ls"] = DASHES[word]
        elif word in MARKS:
            look["marker"] = MARKS[word]
        elif word[0].isdigit():
            look["color"] = colormaps[THICKNESS].reversed()(float(word))
        elif word not in ("open", "thin", "thick", "faint", "front", "small", "large", "wide"):
            raise ValueError(f"style: found {word!r}")
    return look


def _line(ax, panel, one: Series, x, y, style) -> None:
    at, value = x.of(one.x), y.of(one.y)
    mfc = style.pop("mfc") or style["color"]
    if one.error is not None:
        bars = y.of(one.error)
        ax.errorbar(at, value, bars, mfc=mfc, label=printed(one.label), capsize=3, elinewidth=1.0, **style)
    else:
        ax.plot(at, value, mfc=mfc, label=printed(one.label), **style)
    for px, py, word in zip(at, value, one.names, strict=False):
        ax.annotate(printed(word), (px, py), xytext=BESIDE, textcoords="offset points", fontsize=8.5,
                    color=style["color"], bbox=PAPER, zorder=6)  # fmt: skip


def _marks(ax, panel, one, x, y, style) -> None:
    # One on the edge of a map is whole.
    style |= {"ls": "none", "marker": style["marker"] or "o", "clip_on": panel.colour is None}
    if style["marker"] in "x+_":
        style["mew"] = 1.8
    _line(ax, panel, one, x, y, style)


def _shade(ax, panel, one, x, y, style) -> None:
    alpha = 0.18 if style["alpha"] == 1.0 else 0.08
    base = np.zeros(len(one.y)) if one.z is None else one.z
    ax.fill_between(x.of(one.x), y.of(one.y), y.of(base), color=style["color"], alpha=alpha, lw=0,
                    label=printed(one.label))  # fmt: skip


def _bars(ax, panel, one, x, y, style) -> None:
    """Bars standing on zero, or lying where the y axis has words."""
    lying = bool(panel.y.words)
    at, length = (y.of(one.y), x.of(one.x)) if lying else (x.of(one.x), y.of(one.y))
    put, error = (ax.barh, "xerr") if lying else (ax.bar, "yerr")
    size = (1.0 if "wide" in one.style else 0.6) * (
        np.min(np.diff(np.sort(at))) if len(at) > 1 and len(set(at)) == len(at) else 1.0
    )
    bars = {} if one.error is None else {error: (x if lying else y).of(one.error), "capsize": 3}
    bars |= {} if one.z is None else {"left" if lying else "bottom": (x if lying else y).of(one.z)}
    put(at, length, size, color=style["color"], alpha=style["alpha"], label=printed(one.label), **bars)
    for px, py, word in zip(at, length, one.names, strict=False):
        ax.annotate(f" {printed(word)}", (py, px) if lying else (px, py), ha="left" if lying else "center",
                    va="center" if lying else "bottom", fontsize=8.5, color=style["color"])  # fmt: skip
    if lying:
        ax.invert_yaxis()
        ax.grid(False, axis="y")


def _map(ax, panel, one, x, y, style) -> None:
    """Colours over x and y: of words, on both sides of zero, or from low to high; hatched where there is no value."""
    colour = panel.colour or Axis()
    cells = np.array(one.z, float)
    # Ends of the colours, where they are not to fit what is drawn.
    finite = np.append(cells[np.isfinite(cells)], [end for end in (colour.low, colour.high) if end is not None])
    scaled = _Scaled(colour, finite.tolist())
    shown = np.ma.masked_invalid(scaled.factor * cells)
    ax.grid(False)
    if not panel.polar:
        ax.set_facecolor(PALE)
        ax.patch.set(hatch="///", edgecolor="white")
    norm, colours, ticks = _colours_of(colour, scaled.factor * finite)
    at = (x.of(one.x), y.of(one.y))
    ends, shading = (at, "gouraud") if panel.polar else (map(_edges, at), "flat")
    drawn = ax.pcolormesh(*ends, shown, norm=norm, cmap=colours, shading=shading, rasterized=True)
    below = {"location": "bottom", "shrink": 0.8} if panel.polar else {"fraction": 0.05}
    bar = ax.figure.colorbar(drawn, ax=ax, pad=0.03, ticks=ticks, label=scaled.label, **below)
    bar.ax.minorticks_off()
    if colour.words:
        bar.ax.set_yticklabels(list(colour.words), rotation=90, va="center")
    else:
        bar.ax.yaxis.set_major_formatter(lambda value, _: number(value, ".4g"))
    # A few values stand at their cells.
    for axis, values, scale in (("x", at[0], panel.x), ("y", at[1], panel.y)):
        if len(values) <= 6 and not scale.words and not panel.polar:
            getattr(ax, f"set_{axis}ticks")(values, [number(value, ".4g") for value in values])


def _edges(at) -> np.ndarray:
    """Ends of the cells around values of an axis; a single one has a cell of one."""
    half = 0.5 * np.diff(at) if len(at) > 1 else np.array([0.5])
    return np.concatenate([at[:1] - half[:1], at[:-1] + half[: len(at) - 1], at[-1:] + half[-1:]])


def _colours_of(colour: Axis, values):
    """Scale, colours and ticks of a map."""
    if colour.words:
        count = len(colour.words)
        return (BoundaryNorm(np.arange(count + 1) - 0.5, count), ListedColormap([COLOURS.get(w, CYCLE[k % len(CYCLE)])
                for k, w in enumerate(colour.words)]), range(count))  # fmt: skip
    low, high = (float(np.min(values)), float(np.max(values))) if len(values) else (0.0, 1.0)
    if colour.scale == "asinh":
        most = max(abs(low), abs(high)) or 1.0
        if low < 0 < high:
            top = int(np.floor(np.log10(most)))
            powers = [10.0 ** (top - 1), 10.0**top]
            norm = SymLogNorm(linthresh=max(LINEAR * most, 1e-300), vmin=-most, vmax=most)
            return norm, "PuOr_r", [*(-p for p in powers[::-1]), 0.0, *powers]
        half = np.linspace(0.08, 0.5, 256) if high <= 0 else np.linspace(0.5, 0.92, 256)
        room = 1e-3 * most if high - low < 1e-3 * most else 0.0
        return Normalize(low - room, high + room), ListedColormap(colormaps["PuOr_r"](half)), None
    if colour.scale == "log" and low > 0:
        return LogNorm(low, max(high, low * 1.001)), THICKNESS, None
    colours = PRESSURE if quantity(colour.quantity).unit == "Pa" else THICKNESS
    # Never a scale so fine that nothing happens all over it.
    return Normalize(low, max(high, low + FINEST * max(abs(high), abs(low), 1e-300))), colours, None


def _contour(ax, panel, one, x, y, style) -> None:
    cells = np.ma.masked_invalid(np.array(one.z, float))
    if cells.count() and cells.min() < 0 < cells.max():
        ax.contour(x.of(one.x), y.of(one.y), cells, [0.0], colors=style["color"], linewidths=style["lw"])
        ax.plot([], [], color=style["color"], lw=style["lw"], label=printed(one.label))


def _words(ax, panel, one, x, y, style) -> None:
    for at, value, word in zip(x.of(one.x), y.of(one.y), one.names, strict=True):
        ax.text(at, value, printed(word), color=style["color"], ha="center", va="center", weight="bold", fontsize=9,
                bbox=PAPER, clip_on=True, zorder=5)  # fmt: skip


DRAWN = {"line": _line, "marks": _marks, "shade": _shade, "bars": _bars, "map": _map, "contour": _contour,
         "words": _words}  # fmt: skip


def _level(ax, one, scaled: _Scaled) -> None:
    """A line across the panel, or a band, with its meaning and number."""
    at, style = one.value * scaled.factor, _style(one.style, 0)
    words = printed(f"{one.meaning} {number(at, '.5g')} {scaled.unit}".strip() if one.number else one.meaning)
    span, line = (ax.axvspan, ax.axvline) if one.upright else (ax.axhspan, ax.axhline)
    named = {"label": words} if one.legend and words else {}
    if one.to is not None:
        span(at, one.to * scaled.factor, color=style["color"], alpha=0.15, lw=0, zorder=0.5, **named)
    else:
        line(at, color=style["color"], ls=style["ls"], lw=style["lw"] if "thick" in one.style else 1.0, **named)
    if one.legend or not words:
        return
    ends = getattr(ax, f"get_{'x' if one.upright else 'y'}lim")()
    if one.upright:
        late = at > 0.6 * ends[1] + 0.4 * ends[0]
        ax.annotate(words, (at, 0.98), xycoords=("data", "axes fraction"), xytext=(-3 if late else 3, 0), rotation=90,
                    textcoords="offset points", ha="right" if late else "left", va="top", fontsize=8,
                    color=style["color"], bbox=PAPER, zorder=5, annotation_clip=True)  # fmt: skip
    else:
        ax.annotate(words, (1.0, at), xycoords=("axes fraction", "data"), xytext=(-3, 3), textcoords="offset points",
                    ha="right", va="bottom", fontsize=8, color=style["color"], bbox=PAPER, zorder=5,
                    annotation_clip=True)  # fmt: skip


def _title_and_legend(ax, beside, panel: Panel, width: float) -> None:
    """The title, and between it and the panel the legend: off the curves whatever they do."""
    handles, labels = ax.get_legend_handles_labels()
    if beside is not None:
        more = beside.get_legend_handles_labels()
        handles, labels = handles + more[0], labels + more[1]
    title = fill(printed(panel.title), max(24, int(BOLD * width)), break_long_words=False)
    named = {label: handle for handle, label in zip(handles, labels, strict=True) if label}
    if panel.polar:
        # The title stands in the middle; one above would lie on the heading.
        if named:
            ax.legend(named.values(), named.keys(), loc="upper center", bbox_to_anchor=(0.5, 0.44), fontsize=8)
        return
    if not named:
        ax.set_title(title)
        return
    longest = max(map(len, named)) + 5
    columns = max(1, min(len(named), int(LETTERS * (width - 0.8) / longest)))
    rows = -(-len(named) // columns)
    ax.legend(named.values(), named.keys(), loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, fontsize=8,
              borderaxespad=0.2, handlelength=2.2, columnspacing=1.2, labelspacing=0.25, borderpad=0.1)  # fmt: skip
    ax.set_title(title, pad=6.0 + ROW * rows)
