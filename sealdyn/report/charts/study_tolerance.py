"""Tolerance: how the outputs scatter, which keys make them, and how sure the numbers are."""

from textwrap import fill

import numpy as np
from matplotlib.ticker import MaxNLocator

from ...archive import read_study
from ...quantities import shown_in
from ..text import speed_unit
from .page import EVEN, PAPER, absent, legend, look, number, power, printed, save, study_page, upright
from .palette import BLACK, BLUE, CONTACT, CYCLE, GREY, ORANGE, PALE, SKY

# Outputs that have a histogram, and keys that have a row.
MOST, MOST_KEYS = 4, 10
# Keys that fill the panels of keys.
FEW = 3
# Letters of a title that a third of the page has room for, and beside the names of keys.
LETTERS, FEWER_LETTERS = 44, 38
# Steps of ticks.
STEPS = (1, 2, 2.5, 5, 10)
# From which on numbers are read in thousands, millions, ...
LARGE = 1e5
BAND = (("5", "95", 0.5), ("25", "75", 1.0))
LINES = {"1": "1, 99 %", "50": "_", "99": "_"}


@look()
def draw(path, out):
    """Histograms of at most four outputs; shares of the keys; the first output over its foremost key; convergence."""
    study = read_study(path)
    answer = {**study["answer"], "speeds": speed_unit(study)}
    outputs = answer["outputs"][:MOST]
    top = [name for name in outputs for _ in range(12 // len(outputs))]
    top += [outputs[-1]] * (12 - len(top))
    mosaic, heights = [top, 4 * ["shares"] + 4 * ["matrix"] + 4 * ["cloud"]], (4, 5)
    # How the numbers settle is seen from two counts of runs on.
    settles = len(answer["convergence"]["runs"]) > 1
    if settles:
        lower = ["quantiles", "risk", "totals"] if _has_indices(answer) else ["quantiles", "risk"]
        mosaic, heights = [*mosaic, [name for name in lower for _ in range(12 // len(lower))]], (4, 5, 4)
    said, height = " ".join(answer["verdict"][:2]), 1.5 + 0.65 * sum(heights)
    figure, ax = study_page(study, 14, height, mosaic, below=f"{study['name']}: {said}", height_ratios=heights)
    for name in outputs:
        _histogram(ax[name], answer, name)
    _shares(ax["shares"], answer)
    _matrix(ax["matrix"], answer, outputs)
    _cloud(ax["cloud"], answer)
    if settles:
        _quantiles(ax["quantiles"], answer)
        _risk(ax["risk"], answer)
        if "totals" in ax:
            _totals(ax["totals"], answer)
    return save(figure, out)


def _has_indices(answer) -> bool:
    """Whether there are indices for any number of samples."""
    totals = answer["convergence"]["total"].values()
    return any(np.isfinite(np.array(values, dtype=float)).any() for values in totals)


def _shown(unit: str, size: float, speeds) -> tuple[str, float]:
    """What a quantity of this SI unit and size is shown in, speeds as in `speeds`, and the factor."""
    unit, factor = shown_in(unit, [size], {"rad/s": speeds[0]})
    if size * factor >= LARGE:
        thousands = int(np.log10(size * factor) / 3)
        return f"{power(3 * thousands)} {printed(unit)}".strip(), factor / 1e3**thousands
    return printed(unit), factor


def _values(answer, name) -> tuple[np.ndarray, str, float]:
    """Values (n,) of an output as shown, the axis label and the factor."""
    values = np.array(answer["samples"]["outputs"][name], dtype=float)
    size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    unit, factor = _shown(answer["output_units"][name], size, answer["speeds"])
    return factor * values, f"{name}, {unit}" if unit else name, factor


def _histogram(ax, answer, name):
    """How an output scatters: runs in which the faces touched in the colour of contact, the value as drawn, and the
    range of nine runs in ten."""
    values, label, factor = _values(answer, name)
    known = np.isfinite(values)
    if not known.any():
        return absent(ax, name, "no value in any run")
    low, high = values[known].min(), values[known].max()
    if high - low <= EVEN * max(abs(low), abs(high)):
        quantity = label.removeprefix(name).removeprefix(", ")
        return absent(ax, name, f"{number(high, '.4g')} {quantity}".strip() + " in every run that has a value")
    touched = np.array(answer["samples"]["contact"], dtype=float) == 1
    edges = np.histogram_bin_edges(values[known], bins=min(40, max(8, int(np.sqrt(known.sum())))))
    ax.hist([values[known & touched], values[known & ~touched]], edges, stacked=True, color=[CONTACT, SKY],
            label=["touched" if touched.any() else "_", "_"])  # fmt: skip
    quantiles = answer["quantiles"][name]
    ax.axvspan(factor * quantiles["5"], factor * quantiles["95"], fc=(PALE, 0.5), ec=GREY, lw=0.6, zorder=0,
               label="5 to 95 %")  # fmt: skip
    if answer["nominal"][name] is not None:
        nominal = factor * answer["nominal"][name]
        side = "right" if nominal > 0.5 * (edges[0] + edges[-1]) else "left"
        upright(ax, nominal, "as drawn", BLACK, height=0.93, ha=side, ls="--", bbox=PAPER)
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=STEPS, min_n_ticks=3))
    ax.yaxis.set_major_locator(MaxNLocator(6, steps=STEPS, integer=True))
    ax.set(title=name, xlabel=label, ylabel="runs")
    if name == answer["outputs"][-1]:
        # Its grey patch is on paper, not on the band.
        legend(ax, "best", frameon=True, facecolor="white", edgecolor="none", framealpha=0.9)


def _shares(ax, answer):
    """First and total index of every key for the first output with the total's interval; or rank correlations."""
    rows, name = answer["tighten"][answer["outputs"][0]][:MOST_KEYS][::-1], answer["outputs"][0]
    at = np.arange(len(rows))
    ax.grid(False, axis="y")
    if any(row["total"] is not None for row in rows):
        total, low, high = (_column(rows, key) for key in ("total", "total_low", "total_high"))
        ax.barh(at + 0.18, total, 0.36, color=BLUE, label="total")
        ax.errorbar(total, at + 0.18, xerr=np.maximum([total - low, high - total], 0), fmt="none", ecolor="black",
                    elinewidth=0.9, capsize=2)  # fmt: skip
        ax.barh(at - 0.18, _column(rows, "first"), 0.36, color=SKY, label="alone")
        ax.set(title=_title(f"What makes {name} scatter", FEWER_LETTERS), xlabel="Sobol index: share of the variance")
        legend(ax, "lower right")
    elif any(row["rank_correlation"] is not None for row in rows):
        ax.barh(at, _column(rows, "rank_correlation"), 0.5, color=BLUE)
        ax.set(title=_title(f"What {name} follows", FEWER_LETTERS), xlabel="rank correlation", xlim=(-1, 1))
        ax.set_xticks((-1.0, -0.5, 0.0, 0.5, 1.0))
    else:
        return absent(ax, _title(f"What makes {name} scatter", FEWER_LETTERS), "it does not vary")
    ax.set_yticks(at, [row["key"] for row in rows])
    ax.set_ylim(-0.5 - _room(rows), len(rows) - 0.5 + _room(rows))


def _title(words: str, letters: int = LETTERS) -> str:
    """A title in the lines that its panel has room for."""
    return fill(words, letters, break_long_words=False)


def _column(rows, key) -> np.ndarray:
    return np.array([row[key] for row in rows], dtype=float)


def _matrix(ax, answer, outputs):
    """Total index (else rank correlation) of every key for every output; the keys in the order of the shares."""
    keys = [row["key"] for row in answer["tighten"][outputs[0]]][:MOST_KEYS]
    what = "total" if answer["sobol"]["total"] else "rank_correlation"
    title = "Total index of every output" if what == "total" else "Rank correlation of every output"
    rows = [{row["key"]: row[what] for row in answer["tighten"][name]} for name in outputs]
    cells = np.array([[row[key] for row in rows] for key in keys], dtype=float)
    if not np.isfinite(cells).any():
        return absent(ax, title, "no output varies")
    ax.imshow(np.abs(cells), cmap="Blues", vmin=0, vmax=1.2, aspect="auto")
    for (i, j), value in np.ndenumerate(cells):
        words = number(value, ".2f") if np.isfinite(value) else "–"
        ax.text(j, i, words, ha="center", va="center", color="white" if abs(value) > 0.7 else "black")
    ax.grid(False)
    ax.set_xticks(range(len(outputs)), [_folded(name) for name in outputs])
    ax.set_yticks(range(len(keys)), len(keys) * [""])
    ax.set_ylim(len(keys) - 0.5 + _room(keys), -0.5 - _room(keys))
    ax.set_title(title)


def _room(keys) -> float:
    """Rows left free on both sides of few keys, whose bars would else fill the panel."""
    return max(0.0, 0.5 * (FEW - len(keys)))


def _folded(name: str) -> str:
    """The name of an output on lines of their own, so that neighbours have room."""
    return "\n".join(part.replace("_", "\n") if len(part) > 8 else part for part in name.split("."))


def _cloud(ax, answer):
    """The first output over the key to tighten first."""
    name = answer["outputs"][0]
    values, label, _ = _values(answer, name)
    key = answer["tighten"][name][0]["key"]
    if not np.isfinite(values).any():
        return absent(ax, _title(f"{name} over {key}"), "no value in any run")
    x = np.array(answer["samples"]["keys"][key])
    unit, factor = _shown(answer["scatter"][key]["unit"], np.abs(x).max(), answer["speeds"])
    x = factor * x
    touched = np.array(answer["samples"]["contact"], dtype=float) == 1
    if not touched.all():
        ax.plot(x[~touched], values[~touched], ".", ms=3.5, color=BLUE, label="apart")
    if touched.any():
        ax.plot(x[touched], values[touched], ".", ms=4.5, color=CONTACT, label="touched")
    missing = ~np.isfinite(values)
    if missing.any():
        ax.plot(x[missing], np.full(missing.sum(), 0.02), "x", ms=5, color=ORANGE, label="no value",
                transform=ax.get_xaxis_transform())  # fmt: skip
    ax.set(title=_title(f"{name} over {key}"), xlabel=f"{key}, {unit}" if unit else key, ylabel=label)
    if touched.any() or missing.any():
        legend(ax, "best")


def _quantiles(ax, answer):
    """Quantiles of the first output over the number of runs they are taken from."""
    found = answer["convergence"]
    _, label, factor = _values(answer, found["output"])
    columns = {level: factor * np.array(found["quantiles"].get(level, []), dtype=float) for level in ("1", "50", "99")}
    if not np.isfinite(columns["50"]).any():
        return absent(ax, "Quantiles", "no value in any run")
    runs = np.array(found["runs"])
    for low, high, strength in BAND:
        ends = [factor * np.array(found["quantiles"][level], dtype=float) for level in (low, high)]
        ax.fill_between(runs, *ends, color=SKY, alpha=0.5 * strength, lw=0, label=f"{low} to {high} %")
    for level, values in columns.items():
        ax.plot(runs, values, "-" if level == "50" else ":", color=BLUE, label=LINES[level])
    _over_runs(ax, runs)
    ax.set(title="Quantiles", ylabel=label, xlabel="runs")
    legend(ax, "above", ncols=3, handlelength=1.2, columnspacing=0.8, handletextpad=0.4)


def _risk(ax, answer):
    """Probability of contact with its interval over the number of runs."""
    found = answer["convergence"]
    value, low, high = 100 * np.array(found["probability_of_contact"], dtype=float).T
    runs = np.array(found["runs"])
    ax.fill_between(runs, low, high, color=CONTACT, alpha=0.2, lw=0, label="95 % interval")
    ax.plot(runs, value, "o-", ms=3.5, color=CONTACT, label="share of the runs", clip_on=False)
    _over_runs(ax, runs)
    ax.set(title="Probability of contact", xlabel="runs", ylabel="%")
    ax.set_ylim(bottom=0)
    legend(ax, "best")


def _totals(ax, answer):
    """Total indices of the first output over the number of samples."""
    found = answer["convergence"]
    columns = {key: np.array(values, dtype=float) for key, values in found["total"].items()}
    keys = [row["key"] for row in answer["tighten"][found["output"]]]
    for n, key in enumerate(keys):
        colour = CYCLE[n] if n < len(CYCLE) else GREY
        ax.plot(found["samples"], columns[key], "o-", ms=3, color=colour, label=key if n < 5 else "_")
    _over_runs(ax, np.array(found["samples"]))
    ax.set(title="Do the indices settle?", xlabel="samples", ylabel=f"total index of {found['output']}")
    ax.set_ylim(bottom=0)
    legend(ax, "best")


def _over_runs(ax, runs):
    """A logarithmic axis of powers of two."""
    ax.set_xscale("log", base=2)
    ax.set_xticks(runs, [f"{n}" for n in runs])
    ax.minorticks_off()
    ax.set_xlim(runs[0], runs[-1] * (1.25 if len(runs) > 1 else 2))
