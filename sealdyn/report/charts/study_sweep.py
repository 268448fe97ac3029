"""A sweep: lines over one key, maps over two."""

import math

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

from ...archive import read_study
from ...status import Status
from .page import absent, look, number, printed, save, study_page
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, THICKNESS, YELLOW

# SI unit of an output -> what it is shown in, and the factor.
SHOWN = {"m": ("µm", 1e6), "rad": ("µrad", 1e6), "m^3/s": ("ml/h", 3.6e9)}
# Leakage (m^3/s) from which it is shown in l/min, as that of gases; as in the tables of the studies.
MUCH = 1e-5
# Words whose colours mean something, in whatever order they come; the colours of others.
KNOWN = {"stable": GREEN, Status.OK: GREEN, "unstable": CONTACT, Status.COLLAPSED: CONTACT, "neutral": ORANGE}
WORDS = (BLUE, PURPLE, SKY, YELLOW, GREY, BLACK)
MOST = 8
# Letters from which on a title is small.
LONG = 27
# Numbers at the cells of a map.
FEW = 6
# Letters of them that an inch of a panel has room for.
LETTERS = 11


@look()
def draw(path, out):
    """One panel per output, at most eight."""
    study = read_study(path)
    answer = study["answer"]
    outputs = list(dict.fromkeys(answer["outputs"]))[:MOST]
    across = min(len(outputs), 4 if len(outputs) > 4 else 2)
    down = math.ceil(len(outputs) / across)
    mosaic = np.array(outputs + ["."] * (across * down - len(outputs))).reshape(down, across).tolist()
    title = f"{study['name'].replace('_', ' ')} over {' and '.join(answer['keys'])}"
    said = " ".join(answer["verdict"][:2])
    if len(answer["keys"]) == 2 and any(not np.isfinite(column(answer, name)[0]).all() for name in outputs):
        said += "\nHatched: no value."
    figure, panels = study_page(study, max(3.6 * across, 7.2), 1.1 + 2.7 * down, mosaic, title, said)
    for output, ax in panels.items():
        values, unit, words = column(answer, output)
        if len(answer["keys"]) > 2:
            absent(ax, output, "more than two keys: see the table in the archive")
        elif not np.isfinite(values).any():
            absent(ax, output, "no value at any point")
            ax.set_title(output, fontsize=9.5 if len(output) < LONG else 8)
        else:
            ax.set_title(output, fontsize=9.5 if len(output) < LONG else 8)
            (lines if len(answer["keys"]) == 1 else maps)(ax, answer, values, unit, words)
    return save(figure, out)


def axis_label(axis: dict) -> str:
    """The key and the unit of its values: as written, or its own in SI; none of words and of pure numbers."""
    # Archives of earlier versions do not hold the key's own unit.
    unit = axis["unit"] or axis.get("si", "SI")
    return axis["key"] if axis["unit"] is None or unit == "1" else f"{axis['key']}, {printed(unit)}"


def column(answer, output):
    """Values (n,) as shown, their unit, and the words they stand for if they are words."""
    raw = [row.get(output) for row in answer["rows"]]
    if any(isinstance(value, str) for value in raw):
        words = list(dict.fromkeys(value for value in raw if value is not None))
        return np.array([np.nan if value is None else words.index(value) for value in raw]), "", words
    unit = answer["output_units"].get(output, "")
    values = np.array(raw, dtype=float)
    unit, factor = shown(unit, values)
    return factor * values, unit, None


def shown(unit: str, values) -> tuple[str, float]:
    """What `values` in this SI unit are shown in, and how many of it make one."""
    if unit == "m^3/s" and np.nanmax(np.abs(values), initial=0.0) >= MUCH:
        return "l/min", 6e4
    return SHOWN.get(unit, (unit, 1.0))


def positions(axis: dict) -> np.ndarray:
    """Numbers of a key's values; words are counted."""
    return np.arange(len(axis["values"])) if axis["unit"] is None else np.array(axis["values"], dtype=float)


def lines(ax, answer, values, unit, words):
    """One output over one key; crosses at the foot where a run was not possible or gave no value."""
    axis = answer["axes"][0]
    x, good = positions(axis), np.isfinite(values)
    if words:
        for k in range(len(words)):
            ax.plot(x[values == k], values[values == k], "s", ms=5, color=_colour(words, k))
        ax.set_yticks(range(len(words)), words, rotation=90 if len(words) < 4 else 0, va="center")
        ax.set_ylim(-0.7, len(words) - 0.3)
    else:
        # Between words there is nothing.
        ax.plot(x, values, "o" if axis["unit"] is None else "-o", ms=3.5, color=BLUE)
        ax.set_ylabel(unit)
        if not np.nan_to_num(values).any():
            ax.set(ylim=(-1.0, 1.0), yticks=[0.0], yticklabels=["0"])
    if not good.all():
        ax.plot(x[~good], np.full((~good).sum(), 0.03), "x", ms=6, color=CONTACT, transform=ax.get_xaxis_transform(),
                label="no value")  # fmt: skip
        ax.legend(loc="best")
    _ticks(ax.set_xticks, axis, x)
    ax.set_xlabel(axis_label(axis))


def maps(ax, answer, values, unit, words):
    """One output over two keys; hatched where a run was not possible or gave no value."""
    first, second = answer["axes"]
    cells = np.ma.masked_invalid(values.reshape(len(first["values"]), len(second["values"])).T)
    x, y = positions(first), positions(second)
    ax.grid(False)
    ax.set_facecolor(PALE)
    ax.patch.set(hatch="///", edgecolor="white")
    if words:
        colours = ListedColormap([_colour(words, k) for k in range(len(words))])
        norm = BoundaryNorm(np.arange(len(words) + 1) - 0.5, len(words))
        drawn = ax.pcolormesh(edges(x), edges(y), cells, cmap=colours, norm=norm)
        bar = ax.figure.colorbar(drawn, ax=ax, ticks=range(len(words)))
        bar.ax.set_yticklabels(words, rotation=90, va="center")
    else:
        drawn = ax.pcolormesh(edges(x), edges(y), cells, cmap=THICKNESS)
        ax.figure.colorbar(drawn, ax=ax, label=unit)
    _ticks(ax.set_xticks, first, x, few=True)
    _ticks(ax.set_yticks, second, y, few=True)
    ax.set(xlabel=axis_label(first), ylabel=axis_label(second))


def _colour(words, k: int) -> str:
    """The colour of a word among those of its panel."""
    others = [word for word in words if word not in KNOWN]
    return KNOWN.get(words[k]) or WORDS[others.index(words[k]) % len(WORDS)]


def edges(x) -> np.ndarray:
    """Cell edges half-way between points (in any order of the keys' values)."""
    if len(x) == 1:
        return np.array([x[0] - 0.5, x[0] + 0.5])
    middle = 0.5 * (x[1:] + x[:-1])
    return np.concatenate([[2 * x[0] - middle[0]], middle, [2 * x[-1] - middle[-1]]])


def _ticks(put, axis, x, few=False):
    """Words stand at their place; of a map so do a few numbers."""
    if axis["unit"] is None:
        put(x, axis["values"])
    elif few and len(x) <= FEW:
        words = [number(value) for value in axis["values"]]
        # Numbers that would touch: every second, or third.
        room = LETTERS * put.__self__.bbox.width / put.__self__.figure.dpi
        every = math.ceil(sum(len(word) + 1 for word in words) / room) if put.__name__ == "set_xticks" else 1
        put(x[::every], words[::every])
