"""The page of a chart: heading, panels in the house's look, what panels have in common, and a file at the end, or lines
that stay sharp as a page in a browser enlarges them, with the scales by which they are read off; and colours that
colour-blind readers tell apart.

**Source** Okabe and Ito (2008), Color Universal Design; the map for film thickness is cividis
(Nunez, Anderton and Renslow, 2018), that for pressure viridis (van der Walt and Smith, 2015).
"""

import io
import json
import os
import re
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib import rc_context
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, LogFormatter, LogLocator, MaxNLocator, NullFormatter
from PIL import Image

from ...answers import CYCLE as CYCLED
from ...quantities import printed
from ...status import Status
from ..text import question_of

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILLION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#8A8A8A"
PALE = "#D9D9D9"

THICKNESS, PRESSURE = "cividis", "viridis"

# One meaning, one colour, in every chart.
FILM, TILT, LEAK, CONTACT, THEORY, MARK = BLUE, GREEN, SKY, VERMILLION, ORANGE, BLACK
RING = {"stator": PURPLE, "rotor": BLUE}
STATUS = {Status.OK: GREEN, Status.INACCURATE: ORANGE, Status.COLLAPSED: VERMILLION, Status.FAILED: VERMILLION,
          Status.INTERRUPTED: ORANGE, Status.RUNNING: BLUE}  # fmt: skip

# Colours of lines that have no meaning of their own, in order.
CYCLE = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)

# Words of a style: colours by their meaning, dashes, marks.
COLOURS = {
    "film": FILM, "tilt": TILT, "leakage": LEAK, "contact": CONTACT, "theory": THEORY, **RING, **STATUS,
    "stable": GREEN, "unstable": VERMILLION, "neutral": ORANGE, "good": GREEN, "bad": VERMILLION, "warn": ORANGE,
    "black": BLACK, "grey": GREY, "pale": PALE, "blue": BLUE, "yellow": YELLOW,
}  # fmt: skip
COLOURS |= dict(zip(CYCLED, CYCLE, strict=True))
DASHES = {"dashed": (0, (5, 2)), "dotted": (0, (1, 1.5)), "dashdot": (0, (5, 2, 1, 2))}
MARKS = {"circle": "o", "square": "s", "diamond": "D", "triangle": "^", "down": "v", "cross": "x", "plus": "+",
         "star": "*", "tick": "_", "point": "."}  # fmt: skip


LOOK = {
    "font.size": 8.5, "text.hinting": "none", "lines.linewidth": 1.0, "legend.frameon": False, "legend.fontsize": 8,
    "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True, "axes.formatter.useoffset": False,
    "axes.grid": True, "grid.color": PALE, "grid.linewidth": 0.5,
    "path.simplify": True, "agg.path.chunksize": 20000,
}  # fmt: skip
DPI = 150
# Files of lines in place of pixels, and what their date is called.
LINES = {".svg": "Date", ".pdf": "CreationDate"}
# Of the value: a panel whose values change by less shows a flat line, not ticks that differ in the sixth digit.
EVEN = 1e-4
# Lines of a heading that a sheet has room for, and the most it has: it grows by what is beyond.
ROOM, MOST_LINES = 3, 14
# Faces narrower than this share of their radius are drawn wider.
NARROW = 0.1
# Of an archive that is being written, or whose run was killed.
NO_END = "the archive has no end yet; a run that was killed goes on with --continue"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
PAPER = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.5}


def look():
    """The house's look, as a context or a decorator: axes must be made inside it."""
    return rc_context(LOOK)


# --- the page --------------------------------------------------------------------------------------------


def run_page(run, width: float, height: float, mosaic, **layout):
    """Figure (inches) and axes by name for a run: `mosaic` and `layout` as of matplotlib's subplot_mosaic."""
    figure = sheet(width, height)
    return figure, panels(figure, header(figure, run), mosaic, **layout)


def study_words(study, title: str = "", below: str = "", bold: str = "") -> tuple[str, str, str, str]:
    """Title, lines below, bold ones and their colour, the title by default the scenario's question, the lines
    below by default name and question."""
    asked, status = question_of(study["question"]), study["answer"].get("status", Status.OK)
    title = title or asked or study["name"]
    below = below or (f"{study['name']}: {asked}" if asked and asked != title else study["name"])
    return title, below, bold, BLACK if status == Status.OK else STATUS.get(status, BLACK)


def sheet(width: float, height: float):
    """A figure of `width` x `height` inches."""
    figure = Figure(figsize=(width, height), dpi=DPI)
    FigureCanvasAgg(figure)
    return figure


def panels(figure, top: float, mosaic, space: float = 0.04, **layout) -> dict:
    """Axes by name below `top` (share of the height), as `no_label_cut` places them."""
    no_label_cut(figure, top, space)
    return figure.subplot_mosaic(mosaic, **layout)


def no_label_cut(figure, top: float, space: float = 0.04) -> None:
    """Has axes placed below `top` (share of the height) so that no label is cut; `space` between them, as a share of
    their size."""
    width, height = figure.get_size_inches()
    rect = (0.25 / width, 0.1 / height, 1 - 0.45 / width, top - 0.1 / height)
    figure.set_layout_engine("constrained", rect=rect, wspace=space, hspace=space, w_pad=0.06, h_pad=0.06)


def header(figure, run) -> float:
    """The scene's question, then name, model and verdict, warnings, then what happened; returns where they end, as
    `heading`."""
    message = run.message or (NO_END if run.status == Status.RUNNING else "")
    ended = f"{run.status}: {message}" if message else run.status
    warnings = dict.fromkeys(_headline(str(words)) for words in run.summary.get("warnings") or [])
    below = run.description + (f"\nwarning: {'; '.join(warnings)}" if warnings else "")
    return heading(figure, run.question, below, ended, STATUS.get(run.status, BLACK))


def _headline(warning: str) -> str:
    """Of a warning what stands before its reason; a single word says too little."""
    head, _, reason = warning.partition(":")
    return head if " " in head or not reason else f"{head}:{reason.split(';')[0]}"


def heading(figure, title: str, below: str, bold: str = "", colour: str = BLACK) -> float:
    """The title of a page, the lines below it and the bold ones in `colour`, wrapped to its width.  The page grows
    where there are many.  Returns where they end, as a share of the height."""
    width, height = figure.get_size_inches()
    titles = _lines(title, int(9.5 * width)) or [""]
    lines = [(words, {}) for words in _lines(printed(below), int(14 * width))]
    lines += [(words, {"color": colour, "weight": "bold"}) for words in _lines(printed(bold), int(12 * width))]
    # A second line of the title is higher than those below.
    more = 0.24 * (len(titles) - 1)
    height += max(0.0, 0.2 * (len(lines) - ROOM) + more)
    figure.set_size_inches(width, height)
    for k, words in enumerate(titles):
        figure.text(0.4 / width, 1 - (0.26 + 0.24 * k) / height, words, fontsize=13, weight="bold", va="center")
    for k, (words, style) in enumerate(lines):
        figure.text(0.4 / width, 1 - (0.52 + more + 0.2 * k) / height, words, fontsize=9, va="center", **style)
    return 1 - (0.48 + more + 0.2 * len(lines)) / height


def _lines(words: str, length: int) -> list[str]:
    """Lines of at most `length` characters; a text without end is cut."""
    return [line for part in words.split("\n") for line in wrap(part, length, max_lines=MOST_LINES, placeholder=" …")]


def save(figure, path) -> Path | Figure:
    """Writes the figure (png, svg or pdf, by the name) beside `path` first, so that none is ever seen half drawn, and
    returns its path; without a path nothing is written, and the figure itself is returned."""
    for ax in figure.axes:
        flatten(ax)
        for axis in (ax.xaxis, ax.yaxis):
            numbered(axis)
    if path is None:
        return figure
    path = Path(path)
    with replacing(path) as fresh:
        (_write_lines if path.suffix in LINES else _write_pixels)(figure, fresh)
    return path


@contextmanager
def replacing(path: Path):
    """Where a file is written that takes the place of `path` at once when the block ends."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(f"{path.stem}.new{path.suffix}")
    try:
        yield fresh
        os.replace(fresh, path)
    except BaseException:
        fresh.unlink(missing_ok=True)
        raise


def _write_lines(figure, path: Path) -> None:
    """A file that is drawn at any size; without a date, so that equal figures are equal files."""
    with rc_context({"svg.hashsalt": "sealdyn"}):
        figure.savefig(path, metadata={LINES[path.suffix]: None})


def _write_pixels(figure, path: Path) -> None:
    figure.canvas.draw()
    # 256 colours are enough for lines and a stepped colour map, and a third of the bytes.
    pixels = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    few = pixels.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(path, format="PNG", dpi=(DPI, DPI))


# --- what panels have in common --------------------------------------------------------------------------


def absent(ax, title: str, why: str = "not in this scene") -> None:
    """An empty panel that says so."""
    ax.set_title(title)
    ax.grid(False)
    # Not `set(xticks=[])`: that would empty every panel sharing the axis.
    ax.xaxis.set_visible(False)
    ax.yaxis.set_visible(False)
    ax.spines[:].set_color(PALE)
    ax.text(0.5, 0.5, "\n".join(wrap(why, 62)), transform=ax.transAxes, ha="center", va="center", color=GREY,
            style="italic")  # fmt: skip


def flatten(ax) -> None:
    """Values that hardly differ are a flat line beside a plain number: the y axis does not enlarge them."""
    low, high = ax.dataLim.intervaly
    size = max(abs(low), abs(high))
    if ax.get_autoscaley_on() and ax.get_yscale() == "linear" and 0 <= high - low <= EVEN * size and size > 0:
        middle = 0.5 * (low + high)
        ax.set_ylim(middle - 0.1 * abs(middle), middle + 0.1 * abs(middle))


def once(ax, label: str) -> str:
    """`label` the first time, then nothing, so that a legend names it once."""
    return "_" if label in ax.get_legend_handles_labels()[1] else label


def logarithmic(ax, axis: str) -> None:
    """A logarithmic "x" or "y" axis with plain numbers at 1, 2 and 5 of every decade."""
    ax.set(**{f"{axis}scale": "log"})
    axis = getattr(ax, f"{axis}axis")
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(lambda value, _: number(value))
    axis.set_minor_formatter(NullFormatter())


def decades(axis) -> None:
    """Powers of ten at the decades of a logarithmic axis, in plain letters: mathematical ones take as long to load as
    to draw the rest of the panel."""
    axis.set_major_formatter(lambda value, _: power(round(np.log10(value))))
    axis.set_minor_formatter(NullFormatter())


def power(exponent: int) -> str:
    """A power of ten in plain letters."""
    return "10" + str(exponent).translate(RAISED)


def numbered(axis) -> None:
    """A logarithmic axis on which fewer than three numbers would be seen gets plain ones closer together; powers of
    ten are in plain letters."""
    low, high = sorted(axis.get_view_interval())
    if axis.get_scale() != "log" or isinstance(axis.get_major_locator(), FixedLocator) or not 0 < low < high:
        return
    # A factor of two and less has no room for a logarithmic choice.
    closer = [LogLocator(subs=(1, 2, 5)), LogLocator(subs=(1, 1.5, 2, 3, 5, 7)), MaxNLocator(5, steps=(1, 2, 5, 10))]
    for locator in (None, *closer):
        if locator is not None:
            axis.set_major_locator(locator)
            axis.set_major_formatter(lambda value, _: number(value))
            axis.set_minor_formatter(NullFormatter())
        if sum(low <= at <= high for at in axis.get_majorticklocs()) >= 3:
            break
    if isinstance(axis.get_major_formatter(), LogFormatter):
        decades(axis)


def number(value: float, form: str = "g") -> str:
    """A number with the minus of print."""
    return f"{value:{form}}".replace("-", "−")


def written(value: float, digits: int) -> str:
    """`digits` significant figures; large numbers in full, with thousands marked from 10 000 on."""
    if not 1e2 <= abs(value) < 1e9:
        return number(value, f".{digits}g")
    rounded = float(f"{value:.{digits}g}")
    whole = f"{rounded:,.0f}".replace(",", " ") if abs(rounded) >= 1e4 else f"{rounded:.{max(digits, 4)}g}"
    return whole.replace("-", "−")


# --- the face of a seal on polar axes ---------------------------------------------------------------------


def annulus(ax, inner: float, outer: float, title: str = "") -> None:
    """Limits of polar axes for a face between two radii (mm), which stands to scale unless it would be a line, and in
    the middle the `title` and the radii."""
    words, width = f"{inner:.4g}–{outer:.4g} mm", outer - inner
    if width < NARROW * outer:
        ax.set(ylim=(inner, outer), rorigin=inner - 2.0 * width, yticks=[])
        words += "\nwidth stretched"
    else:
        ax.set(ylim=(0, outer), yticks=[])
    ax.grid(False)
    words = f"{title}\n{words}" if title else words
    ax.text(0.5, 0.5, words, ha="center", va="center", linespacing=1.6, transform=ax.transAxes)


# What has no place in a page, and what says nothing there.
ASIDE = re.compile(r"^.*?(?=<svg)|<!--.*?-->|<metadata>.*?</metadata>", re.DOTALL)
# Share of a pixel by which a curve of many points is simplified: enlarged twenty times nothing is to be seen of it.
SIMPLER = 0.02


def svg_of(figure: Figure) -> tuple[str, str]:
    """The <svg> of a figure, and JSON of its axes: `id` of their group, `box` (left, top, right, bottom) as drawn, and
    of x and y the `name`, the `kind` of scale ("linear", "log", "asinh"), its `width`, and the ends on that scale."""
    held = io.StringIO()
    with rc_context({"svg.hashsalt": "sealdyn", "path.simplify_threshold": SIMPLER}):
        figure.savefig(held, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    # Known only once it is laid out; a point is 1/72 inch.
    height, points = 72.0 * figure.get_figheight(), 72.0 / figure.dpi
    axes = []
    for number, ax in enumerate(figure.axes, 1):
        if not ax.axison or ax.name != "rectilinear":
            continue
        x, y = _scale(ax, ax.xaxis), _scale(ax, ax.yaxis)
        if x and y:
            extent = ax.get_window_extent()
            box = [extent.x0 * points, height - extent.y1 * points, extent.x1 * points, height - extent.y0 * points]
            axes.append({"id": f"axes_{number}", "box": [round(end, 2) for end in box], "x": x, "y": y})
    return ASIDE.sub("", held.getvalue()), json.dumps(axes)


def _scale(ax, axis: Axis) -> dict | None:
    """Of an axis of numbers; None of one of words, of another scale, and without a name."""
    which, kind = axis.axis_name, axis.get_scale()
    alike = getattr(ax, f"get_shared_{which}_axes")().get_siblings(ax)
    names = [getattr(one, f"get_{which}label")() for one in chain([ax], alike)]
    words = [label.get_text() for label in axis.get_ticklabels()]
    name = next(filter(None, names), "")
    if kind not in ("linear", "log", "asinh") or not name or any(word[:1].isalpha() for word in words):
        return None
    width = float(axis.get_transform().linear_width) if kind == "asinh" else 1.0
    ends = np.array(axis.get_view_interval(), float)
    ends = np.log10(ends) if kind == "log" else np.arcsinh(ends / width) if kind == "asinh" else ends
    return {"name": name, "kind": kind, "width": width, "ends": ends.tolist()}
