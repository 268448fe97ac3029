"""Tolerance: how the outputs scatter, which keys make them, and how sure the numbers are."""

import numpy as np

from ...answers import CYCLE, Axis, Level, Panel, Series
from ...archive import read_study
from ...quantities import printed, shown_in
from ..panels import study_sheet
from .page import EVEN, number, power, save

# Outputs that have a histogram, and keys that have a row.
MOST, MOST_KEYS = 4, 10
# From which on numbers are read in thousands, millions, ...
LARGE = 1e5
BAND, LINES = (("5", "95", "faint"), ("25", "75", "")), {"1": "1, 99 %", "50": "50 %", "99": ""}


def draw(path, out):
    """Histograms of at most four outputs; shares of the keys; the first output over its foremost key; convergence."""
    study = read_study(path)
    answer = study["answer"]
    outputs = answer["outputs"][:MOST]
    panels = [_histogram(answer, name) for name in outputs]
    panels += [_shares(answer), _matrix(answer, outputs), _cloud(answer)]
    # How the numbers settle is seen from two counts of runs on.
    if len(answer["convergence"]["runs"]) > 1:
        panels += [_quantiles(answer), _risk(answer), *([_totals(answer)] if _has_indices(answer) else [])]
    below = f"{study['name']}: {' '.join(answer['verdict'][:2])}"
    return save(study_sheet(study, panels, below=below), out)


def _has_indices(answer) -> bool:
    """Whether there are indices for any number of samples."""
    totals = answer["convergence"]["total"].values()
    return any(np.isfinite(np.array(values, dtype=float)).any() for values in totals)


def _shown(unit: str, size: float) -> tuple[str, float]:
    """What a quantity of this SI unit and size is shown in, and the factor."""
    unit, factor = shown_in(unit, [size])
    if size * factor >= LARGE:
        thousands = int(np.log10(size * factor) / 3)
        return f"{power(3 * thousands)} {printed(unit)}".strip(), factor / 1e3**thousands
    return printed(unit), factor


def _values(answer, name) -> tuple[np.ndarray, str, float]:
    """Values (n,) of an output as shown, their unit and the factor."""
    values = np.array(answer["samples"]["outputs"][name], dtype=float)
    size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    unit, factor = _shown(answer["output_units"][name], size)
    return factor * values, unit, factor


def _touched(answer) -> np.ndarray:
    return np.array(answer["samples"]["contact"], dtype=float) == 1


def _histogram(answer, name) -> Panel:
    """How an output scatters: runs in which the faces touched in the colour of contact, the value as drawn, and the
    range of nine runs in ten."""
    values, unit, factor = _values(answer, name)
    known, first = np.isfinite(values), name == answer["outputs"][0]
    if not known.any():
        return Panel(name, note="no value in any run", first=first)
    low, high = values[known].min(), values[known].max()
    if high - low <= EVEN * max(abs(low), abs(high)):
        same = f"{number(high, '.4g')} {unit}".strip()
        return Panel(name, note=f"{same} in every run that has a value", first=first)
    edges = np.histogram_bin_edges(values[known], bins=min(40, max(8, int(np.sqrt(known.sum())))))
    touched, apart = (np.histogram(values[known & kept], edges)[0] for kept in (_touched(answer), ~_touched(answer)))
    middles = 0.5 * (edges[1:] + edges[:-1])
    series = [Series("bars", middles, touched, label="touched", style="contact wide")] if touched.any() else []
    series.append(Series("bars", middles, apart, touched, style="sixth wide"))
    quantiles, nominal = answer["quantiles"][name], answer["nominal"][name]
    levels = [Level(factor * quantiles["5"], "5 to 95 %", upright=True, to=factor * quantiles["95"], legend=True)]
    if nominal is not None:
        levels.append(Level(factor * nominal, "as drawn", upright=True, style="black dashed", legend=True))
    return Panel(name, Axis(unit or "1", name), Axis("count"), series, levels, first=first)


def _shares(answer) -> Panel:
    """First and total index of every key for the first output with the total's interval; or rank correlations."""
    name = answer["outputs"][0]
    rows, title = answer["tighten"][name][:MOST_KEYS], f"What makes {name} scatter"
    at, keys = list(range(len(rows))), Axis("1", " ", words=[row["key"] for row in rows])
    if any(row["total"] is not None for row in rows):
        total, low, high, alone = (_column(rows, key) for key in ("total", "total_low", "total_high", "first"))
        ends = np.maximum([total - low, high - total], 0).max(axis=0)
        bars = Series("bars", total, at, label="total", style="first", error=ends)
        marks = Series("marks", alone, at, label="alone", style="sixth diamond front")
        return Panel(title, Axis("1", "share of the variance (Sobol)"), keys, [bars, marks], first=True, wide=1.2)
    if any(row["rank_correlation"] is not None for row in rows):
        bars = Series("bars", _column(rows, "rank_correlation"), at, style="first")
        return Panel(f"What {name} follows", Axis("1", "rank correlation", low=-1, high=1), keys, [bars], first=True)
    return Panel(title, note="it does not vary", first=True)


def _column(rows, key) -> np.ndarray:
    return np.array([row[key] for row in rows], dtype=float)


def _matrix(answer, outputs) -> Panel:
    """Total index (else rank correlation) of every key for every output; the keys in the order of the shares."""
    keys = [row["key"] for row in answer["tighten"][outputs[0]]][:MOST_KEYS]
    what = "total" if answer["sobol"]["total"] else "rank_correlation"
    title = "Total index of every output" if what == "total" else "Rank correlation of every output"
    rows = [{row["key"]: row[what] for row in answer["tighten"][name]} for name in outputs]
    cells = np.array([[row[key] for row in rows] for key in keys], dtype=float)
    if not np.isfinite(cells).any():
        return Panel(title, note="no output varies")
    across, down = np.meshgrid(range(len(outputs)), range(len(keys)))
    told = [number(value, ".2f") if np.isfinite(value) else "–" for value in cells.ravel()]
    series = [Series("map", range(len(outputs)), range(len(keys)), np.abs(cells)),
              Series("words", across.ravel(), down.ravel(), names=told, style="black")]  # fmt: skip
    names = [name.replace(".", "\n").replace("_", "\n") for name in outputs]
    colour = Axis("1", " ", low=0.0, high=1.0)
    # The keys stand beside the bars on the left.
    rows = Axis("1", " ", words=[" "] * len(keys))
    return Panel(title, Axis("1", " ", words=names), rows, series, colour=colour, down=True, wide=0.8)


def _cloud(answer) -> Panel:
    """The first output over the key to tighten first."""
    name = answer["outputs"][0]
    values, unit, _ = _values(answer, name)
    key = answer["tighten"][name][0]["key"]
    title, known = f"{name} over {key}", np.isfinite(values)
    if not known.any():
        return Panel(title, note="no value in any run")
    x, series = np.array(answer["samples"]["keys"][key]), []
    across, factor = _shown(answer["scatter"][key]["unit"], np.abs(x).max())
    for kept, label, style in ((~_touched(answer), "apart", "first"), (_touched(answer), "touched", "contact")):
        if (kept & known).any():
            series.append(Series("marks", factor * x[kept], values[kept], label=label, style=f"{style} point"))
    if not known.all():
        low = np.full((~known).sum(), values[known].min())
        series.append(Series("marks", factor * x[~known], low, label="no value", style="warn cross small"))
    return Panel(title, Axis(across or "1", key), Axis(unit or "1", name), series)


def _quantiles(answer) -> Panel:
    """Quantiles of the first output over the number of runs they are taken from."""
    found = answer["convergence"]
    _, unit, factor = _values(answer, found["output"])
    columns = {q: factor * np.array(values, dtype=float) for q, values in found["quantiles"].items()}
    if not np.isfinite(columns["50"]).any():
        return Panel("Quantiles", note="no value in any run", first=True)
    runs = found["runs"]
    series = [Series("shade", runs, columns[low], columns[high], label=f"{low} to {high} %", style=f"first {strength}")
              for low, high, strength in BAND]  # fmt: skip
    series += [Series("line", runs, columns[q], label=label, style=f"first thin{'' if q == '50' else ' dotted'}")
               for q, label in LINES.items()]  # fmt: skip
    return Panel("Quantiles", Axis("1", "runs", scale="log"), Axis(unit or "1", found["output"]), series, first=True)


def _risk(answer) -> Panel:
    """Probability of contact with its interval over the number of runs."""
    found = answer["convergence"]
    value, low, high = np.array(found["probability_of_contact"], dtype=float).T
    runs, style = found["runs"], "contact circle small"
    series = [Series("shade", runs, low, high, label="95 % interval", style="contact")]
    series.append(Series("line", runs, value, label="share of the runs", style=style))
    return Panel("Probability of contact", Axis("1", "runs", scale="log"), Axis("share", " ", low=0.0), series)


def _totals(answer) -> Panel:
    """Total indices of the first output over the number of samples."""
    found, series = answer["convergence"], []
    for n, row in enumerate(answer["tighten"][found["output"]]):
        style, label = (CYCLE[n], row["key"]) if n < 5 else ("grey", "")
        total = np.array(found["total"][row["key"]], dtype=float)
        series.append(Series("line", found["samples"], total, label=label, style=f"{style} thin circle small"))
    axis = Axis("1", f"total index of {found['output']}", low=0.0)
    return Panel("Do the indices settle?", Axis("1", "samples", scale="log"), axis, series)
