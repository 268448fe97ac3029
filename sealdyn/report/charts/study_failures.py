"""The failure gallery on one page: each failing method's error beside the survivor's, on its own decades."""

import math
from textwrap import wrap

from ...archive import read_study
from ..text import question_of
from .page import heading, look, power, printed, save, sheet, shortened
from .palette import BLACK, BLUE, GREY, PALE, VERMILLION

# Decades drawn; what is smaller, or nothing at all, ends at the left edge.
LEAST, MOST = -17, 11
NAMES, NUMBERS = 0.235, 0.715


@look()
def draw(path, out):
    """One line of bars per exhibit, its name and unit to the left, in colour where the seal comes to its place,
    what the program does by default to the right."""
    study = read_study(path)
    rows, verdict = study["answer"]["rows"], study["answer"]["verdict"]
    figure = sheet(14.5, 2.0 + 0.42 * len(rows))
    met = any(row.get("met") for row in rows)
    words = [": ".join(filter(None, (study["name"], question_of(study["question"])))), *verdict[1:]]
    words += ["names in colour: where this seal comes to"] * met
    top = heading(figure, "Where methods fail, by how much, and what survives", "\n".join(words))
    # The heading makes the page grow.
    height = figure.get_figheight()
    bottom, top = 0.6 / height, top - 0.14 / height
    ax = figure.add_axes((NAMES, bottom, NUMBERS - NAMES, top - 0.16 / height - bottom))
    _frame(figure, ax, len(rows), top)
    for at, row in enumerate(rows):
        _line(ax, row, -at)
    return save(figure, out)


def _frame(figure, ax, count, top):
    """The axis of errors, and at the height `top` (share of the page) what the columns are."""
    ticks = range(-16, 11, 4)
    ax.set(xlim=(LEAST, MOST), ylim=(-count + 0.4, 0.6), yticks=[], xlabel="error or cost, in the unit named")
    ax.set_xticks(ticks, [power(t) if t else "1" for t in ticks])
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)
    for at, words, colour in (
        (NAMES + 0.003, "the method that fails", VERMILLION),
        (NAMES + 0.133, "the survivor", BLUE),
        (NAMES + 0.213, "(a cross: no answer at all)", GREY),
        (NUMBERS + 0.012, "by default the program …", BLACK),
    ):
        weight = "normal" if colour == GREY else "bold"
        figure.text(at, top, words, color=colour, fontsize=9, weight=weight)


def _line(ax, row, y):
    ax.axhline(y - 0.5, color=PALE, lw=0.5)
    beside = {"transform": ax.get_yaxis_transform(), "va": "center"}
    place = {"ha": "right", "fontsize": 9, "weight": "bold", "color": VERMILLION if row.get("met") else BLACK}
    ax.text(-0.012, y + 0.14, f"{row['item']}  {row['title']}", **place, **beside)
    ax.text(
        -0.012, y - 0.2, shortened(printed(row.get("unit", "")), 62), ha="right", fontsize=7.5, color=GREY, **beside
    )
    if "failed" in row:
        ax.text(LEAST, y, f" the exhibit failed: {row['failed']}", color=VERMILLION, va="center")
        return
    _bar(ax, y + 0.2, row["failing_error"], row["failing"], VERMILLION)
    _bar(ax, y - 0.2, row["survivor_error"], row["survivor"], BLUE)
    ax.text(1.023, y, "\n".join(wrap(printed(row["default"]), 62)[:2]), fontsize=7.5, linespacing=1.4, **beside)


def _bar(ax, y, error, words, colour):
    """A bar to the error with its name and number; a cross where there is no answer."""
    words = printed(words)
    if error is None:
        ax.barh(y, MOST - LEAST - 0.4, left=LEAST, height=0.34, color=colour, alpha=0.18)
        ax.plot(MOST - 0.4, y, "x", color=colour, ms=6, mew=2, clip_on=False)
        ax.text(LEAST + 0.2, y, words, fontsize=7.5, va="center", color=BLACK)
        return
    end = max(math.log10(error), LEAST + 0.25) if error > 0 else LEAST + 0.25
    ax.barh(y, end - LEAST, left=LEAST, height=0.34, color=colour, alpha=0.4)
    ax.plot([end, end], [y - 0.17, y + 0.17], color=colour, lw=2)
    words = f"{error:.2g}  {words}" if error > 0 else f"none  {words}"
    # Inside a bar that is long enough, else beside it.
    told = ax.text(LEAST + 0.2, y, words, fontsize=7.5, va="center", color=BLACK)
    if ax.transData.inverted().transform(told.get_window_extent())[1, 0] > end - 0.1:
        told.set_x(end + 0.25)
