"""The sheet a chart is drawn on: figure, axes in the house's look, and a PNG at the end."""

import os
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from .palette import BLACK, GREY, PALE, STATUS

LOOK = {
    "font.size": 8.5,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": PALE,
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.0,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "path.simplify": True,
    "agg.path.chunksize": 20000,
}
DPI = 150


def sheet(width: float, height: float):
    """A figure of `width` x `height` inches."""
    figure = Figure(figsize=(width, height), dpi=DPI)
    FigureCanvasAgg(figure)
    return figure


def look():
    """The house's look, as a context: axes must be made inside it."""
    return rc_context(LOOK)


def absent(ax, title: str, why: str = "not in this scene") -> None:
    """An empty panel that says so."""
    ax.set_title(title)
    ax.grid(False)
    # Not `set(xticks=[])`: that would empty every panel sharing the axis.
    ax.xaxis.set_visible(False)
    ax.yaxis.set_visible(False)
    for spine in ax.spines.values():
        spine.set_color(PALE)
    ax.text(0.5, 0.5, why, transform=ax.transAxes, ha="center", va="center", color=GREY, style="italic")


def header(figure, run) -> None:
    """The scene's question, then name, model and verdict, then what happened."""
    ended = f"{run.status}: {run.message}" if run.message else run.status
    heading(figure, run.question, run.description, ended, STATUS.get(run.status, BLACK))


def heading(figure, title: str, below: str, bold: str = "", colour: str = BLACK) -> None:
    """The title of a sheet, a line below it, and a bold one in `colour`; each cut to the width of the sheet."""
    left, top, step = 0.035, 1 - 0.26 / figure.get_figheight(), 0.2 / figure.get_figheight()
    width = figure.get_figwidth()
    figure.text(left, top, shortened(title, int(9.5 * width)), fontsize=13, weight="bold", va="center")
    below, bold = shortened(below, int(13 * width)), shortened(bold, int(12.5 * width))
    figure.text(left, top - 1.3 * step, below, fontsize=9, va="center")
    if bold:
        figure.text(left, top - 2.4 * step, bold, fontsize=9, va="center", color=colour, weight="bold")


def shortened(words: str, length: int) -> str:
    """`words` in one line of at most `length` characters."""
    words = " ".join(words.split())
    return words if len(words) <= length else words[: length - 1].rsplit(" ", 1)[0] + " …"


def save(figure, path) -> Path:
    """Writes the PNG beside `path` first, so that a figure is never seen half drawn."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    figure.canvas.draw()
    # 256 colours are enough for lines and a stepped colour map, and a third of the bytes.
    pixels = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    few = pixels.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(fresh, format="PNG", dpi=(DPI, DPI))
    os.replace(fresh, path)
    return path
