"""Tolerance: what the scatter of manufacture and operation does to the seal, and which tolerance to tighten first."""

from collections import Counter
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...answers import Answer, Table, table_of
from ...dynamics.run_state import FilmClosed
from ...numerics.parallel import Together
from ...quantities import in_words
from ...scenario.errors import ScenarioError
from ...scenario.reader import with_values
from ...simulation.batch import rows_alike, run_many
from ...simulation.result import START, unit_of
from ...status import Status
from .. import Info
from ..sweep import quantity_of
from .scatter import (
    SCRAMBLES,
    Sample,
    convergence,
    indices,
    moments,
    number,
    points,
    probability,
    quantiles,
    read_correlations,
    read_scatter,
    tightened,
)

INFO = Info(
    timed=("tolerance", 48),
    wavy=True,
    # Of keys and outputs the answer knows the units; what is left are indices, shares and counts.
    units={"*": "1"},
    along={
        **dict.fromkeys(("samples", "samples/keys", "samples/outputs"), ("samples/run",)),
        **dict.fromkeys(("convergence", "convergence/quantiles", "convergence/total"), ("convergence/runs",)),
    },
)
OUTPUTS = ("h_min.value", "leakage.mean", "relative_misalignment.max", "contact_margin")
# What every run is asked besides, to know whether the faces touched and whether the seal is stable.
FILM, THINNEST, TOUCHES, VERDICT = "h_min.value", "h_min.of_clearance", "contact.touches", "stability.verdict"

# By how much an estimated first index may be above the total, before neither is settled.
ROUGHLY = 0.05


@dataclass(frozen=True)
class Settings:
    """What scatters, how many seals, and what is asked of them."""

    scatter: list[str] | str = ()
    """One entry a key: "KEY = normal(MEAN, SIGMA)", "uniform(LOW, HIGH)", "truncated(MEAN, SIGMA, LOW, HIGH)";
    without MEAN the scenario's own value; "normal(MEAN +- W)" or "normal(+- W)" with a tolerance W of 3 SIGMA
    ("truncated" also cuts there, of "uniform" it is half the width), W in % of the mean too."""
    correlations: list[str] | str = ()
    """"KEY, KEY = NUMBER", of a Gaussian copula."""
    samples: int = 256
    """A power of two: the study takes so many x (keys + 2) runs, or so many without indices."""
    seed: int = 1
    """Equal seed, equal numbers."""
    outputs: list[str] | str = OUTPUTS
    """As of a sweep; which tolerance to tighten is asked of the first."""
    indices: bool = True
    """Sobol indices; with correlations they are not defined."""
    margin: float = 1e-3
    """Contact is a film that gets down to so much of the clearance, collapses or is closed at the start, or asperities
    that touch."""


def run(scenario, settings, tools) -> Answer:
    """Runs at scrambled Sobol points of the keys: distributions, probability of contact, indices, what to tighten."""
    scatters = read_scatter(scenario, listed(settings.scatter))
    keys = [s.key for s in scatters]
    factor = read_correlations(scenario, listed(settings.correlations), keys)
    check(scenario, settings)
    outputs = list(dict.fromkeys(name.strip() for entry in listed(settings.outputs) for name in entry.split(",")))
    a, b = points(scatters, settings.samples, settings.seed, factor)
    check_used(scenario, keys, a[0])
    asked = [*outputs, THINNEST, VERDICT, *([TOUCHES] if scenario.scene.contact else []), START]
    nominal = nominal_run(scenario, asked, outputs)
    with_indices = settings.indices and factor is None
    designs = [a, b, *mixed(a, b)] if with_indices else [a]
    tools.tell(f"tolerance: {runs_of(settings.samples, len(keys), with_indices)}")
    sets = [dict(zip(keys, map(float, row), strict=True)) for design in designs for row in design]
    todo = [{"outputs": asked, "set": values} for values in sets]
    rows = rows_alike(scenario, Together(partial(seals, scenario)), todo, partial(tools.map, what="runs"))
    starts = {row[START] for row in rows if row.get(START)}
    if len(starts) == 1 and nominal[START] not in starts:
        # The nominal seal begins as those that scatter about it.
        nominal = nominal_run(with_values(scenario, {"run.start": starts.pop()}), asked, outputs)

    found = {name: column(rows, name).reshape(len(designs), -1) for name in outputs}
    contact = touched(rows, settings.margin).reshape(len(designs), -1)
    # The distribution is that of A and B: the mixed points repeat their values.
    whole = Sample(scatters, np.vstack(designs[:2]), settings.samples, len(designs[:2]))
    numbers = {
        "keys": keys,
        "scatter": {s.key: {"words": s.words, "mean": float(s.law.mean()), "sigma": float(s.law.std()), "unit": s.unit}
                    for s in scatters},
        "outputs": outputs,
        "output_units": {name: unit_of(name) for name in outputs},
        "units": {f"samples/keys/{s.key}": s.unit or "1" for s in scatters}
        | {f"samples/outputs/{name}": unit_of(name) or "1" for name in outputs},
        "nominal": {name: nominal[name] for name in outputs},
        "runs": {"asked": len(rows), "scrambles": SCRAMBLES, "ends": ends(rows), **counts(rows[: len(whole.values)])},
        "sobol": indices(found, keys, settings.seed) if with_indices else
                 {"first": None, "total": None, "reason": "correlated keys" if settings.indices else "not asked for"},
    }  # fmt: skip
    numbers |= distribution(whole, found, contact, numbers["sobol"], factor is None)
    numbers["convergence"] = convergence(found, contact, settings.samples, outputs[0], keys)
    of_first = ("standard_deviation", *(f"quantiles/{level}" for level in numbers["quantiles"][outputs[0]]))
    numbers["units"] |= {f"convergence/{name}": unit_of(outputs[0]) or "1" for name in of_first}
    if not any(moment["count"] for moment in numbers["moments"].values()):
        numbers["status"] = Status.FAILED
    return Answer(numbers, _found(numbers), _tables(numbers), notes=_notes(numbers, rows))


def distribution(whole, found, contact, sobol, independent) -> dict:
    """What the runs at A and B say of every output and of contact, and these runs themselves."""
    values, touching = {name: runs[:2].ravel() for name, runs in found.items()}, contact[:2].ravel()
    return {
        "quantiles": {name: quantiles(x) for name, x in values.items()},
        "moments": {name: moments(x, whole.scrambles) for name, x in values.items()},
        "probability_of_contact": probability(touching, whole.scrambles),
        "tighten": {name: tightened(whole, x, touching, sobol, name, independent) for name, x in values.items()},
        "samples": {
            "keys": {s.key: whole.values[:, i].tolist() for i, s in enumerate(whole.scatters)},
            "outputs": {name: [number(v) for v in x] for name, x in values.items()},
            "contact": [number(v) for v in touching],
        },
    }


def counts(rows) -> dict:
    """Of the runs that make the distribution: how many, unstable ones, and films closed at the start."""
    return {"distribution": len(rows), "unstable": sum(row.get(VERDICT) == "unstable" for row in rows),
            "closed_at_start": sum("closed_at_start" in row for row in rows)}  # fmt: skip


def listed(entries) -> list[str]:
    return [entries] if isinstance(entries, str) else list(entries)


def check(scenario, settings):
    """Raises ScenarioError if the number of samples or the margin cannot be."""
    n, least = settings.samples, 4 * SCRAMBLES
    if n < least or n & (n - 1):
        below = max(least, 1 << max(n, 1).bit_length() - 1)
        expected = f"a power of two, without which Sobol points are not balanced: {below} or {2 * below}"
        raise ScenarioError(scenario.name, "study.tolerance.samples", f"{n}", expected)
    if not 0 <= settings.margin < 1:
        raise ScenarioError(scenario.name, "study.tolerance.margin", f"{settings.margin:g}", "a share of the clearance")
    if not listed(settings.outputs):
        raise ScenarioError(scenario.name, "study.tolerance.outputs", "none", "keys of the run's summary")
    if settings.seed < 0:
        raise ScenarioError(scenario.name, "study.tolerance.seed", f"{settings.seed}", "a whole number >= 0")


def check_used(scenario, keys, values):
    """Raises ScenarioError for a key that this seal does not use: its runs would be in vain."""
    for key, value in zip(keys, values, strict=True):
        try:
            unused = with_values(scenario, {key: float(value)}).unused()
        except ScenarioError:
            # A value that cannot be is a row that failed.
            continue
        if key in unused:
            expected = "a key that this seal uses"
            raise ScenarioError(scenario.name, "study.tolerance.scatter", f"{key}, which it does not", expected)


def nominal_run(scenario, asked, outputs) -> dict:
    """The run of the scenario as it stands, before the many.  Raises ScenarioError for outputs that are no numbers, or
    are not there."""
    where = "study.tolerance.outputs"
    try:
        row = Together(partial(seals, scenario))({"outputs": asked, "set": {}})
    except ValueError as error:
        if type(error) is ValueError:
            raise ScenarioError(scenario.name, where, str(error), "keys of the run's summary") from None
        raise
    for name in outputs:
        if isinstance(row[name], str | list | dict | bool):
            raise ScenarioError(scenario.name, where, f"{name}, which is no number", "numbers of the run's summary")
    return row


def runs_of(samples: int, keys: int, with_indices: bool) -> str:
    """What the study is about to run, in words."""
    if not with_indices:
        return f"{samples} runs"
    return f"{samples * (keys + 2)} runs ({samples} samples x ({keys} keys + 2)); {samples} with indices = false"


def seals(scenario, points: list[dict]) -> list:
    """Rows as a sweep's; a film that is closed before it starts has collapsed, with no thickness and no other
    numbers."""
    rows = run_many(scenario, points)
    return [closed(row, point) if isinstance(row, FilmClosed) else row for row, point in zip(rows, points, strict=True)]


def closed(error, point: dict) -> dict:
    """The row of a film that is closed at the start."""
    row = {name: 0.0 if name in (FILM, THINNEST) else None for name in point["outputs"]}
    return {"status": Status.COLLAPSED, "closed_at_start": True, **row, "message": str(error)}


def mixed(a, b):
    """The points A with one key each of B, (n, d) d times."""
    for i in range(a.shape[1]):
        point = a.copy()
        point[:, i] = b[:, i]
        yield point


def column(rows, name) -> np.ndarray:
    """An output of the rows, not a number where a run was not possible, its solver failed or it has none.  A run that
    collapsed counts with what it had until then."""
    values = [None if row.get("status", Status.FAILED) == Status.FAILED else row.get(name) for row in rows]
    return np.array(values, dtype=float)


def touched(rows, margin: float) -> np.ndarray:
    """1 for runs in which the faces touched, 0 for others, not a number where that is not known."""
    return np.array([contact_of(row, margin) for row in rows], dtype=float)


def contact_of(row: dict, margin: float) -> float:
    thinnest = row.get(THINNEST)
    if row.get("status") == Status.COLLAPSED or row.get(TOUCHES) or (thinnest is not None and thinnest <= margin):
        return 1.0
    return 0.0 if row.get("status") == Status.OK else np.nan


def ends(rows) -> dict[str, int]:
    """How many runs ended how."""
    return dict(sorted(Counter(str(row.get("status", "not possible")) for row in rows).items()))


# --- what is shown -----------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """How many touch, and which tolerance to tighten first."""
    risk, name = numbers["probability_of_contact"], numbers["outputs"][0]
    if risk["value"] is None:
        return "No run ended, so whether the faces touch is not known."
    low, high = (in_words("share", risk[end], digits=3) for end in ("low", "high"))
    touch = f"{in_words('share', risk['value'], digits=3)} of the seals touch (95 % interval {low} to {high})"
    first = numbers["tighten"][name][0]
    if first["total"] is None and first["rank_correlation"] is None:
        return f"{touch}; nothing that scatters changes {name}."
    if first["total"] is None:
        return f"{touch}; {name} follows {first['key']} most closely."
    return f"{touch}; for {name} tighten {first['key']} first."


def _notes(numbers, rows) -> list[str]:
    """What the tables do not say of how far the numbers can be trusted."""
    runs, name, notes = numbers["runs"], numbers["outputs"][0], []
    if runs["closed_at_start"]:
        notes.append(f"{runs['closed_at_start']} touch before anything moves (contact-onset follows the film further).")
    if runs["unstable"]:
        notes.append(f"{runs['unstable']} are unstable and may touch later.")
    first, *others = numbers["tighten"][name]
    if first["total"] is not None:
        rivals = [row["key"] for row in others if row["total_high"] > first["total_low"]]
        notes += [f"May matter as much: {', '.join(rivals)}; more samples tell."] if rivals else []
        rough = [row["key"] for row in (first, *others) if row["first"] - row["total"] > ROUGHLY]
        if rough:
            notes.append(f"First index above the total of {', '.join(rough)}: so few samples give tenths only.")
    elif numbers["sobol"]["total"] is None or not numbers["sobol"]["total"][name]:
        why = numbers["sobol"]["reason"] or f"only {numbers['sobol']['base_points'][name]} samples have all their runs"
        notes.append(f"No indices: {why}.")
    bad = [row for row in rows if row.get("status", Status.FAILED) == Status.FAILED]
    if bad:
        why = bad[0].get("failed") or bad[0].get("message")
        notes.append(f"{len(bad)} of {len(rows)} runs gave no numbers and widen the interval; the first: {why}")
    return notes


def _tables(numbers) -> list[Table]:
    """The distribution of every output; the keys, as the first output has them; total indices of all outputs."""
    outputs, first = numbers["outputs"], numbers["outputs"][0]
    levels = list(numbers["quantiles"][first])
    columns = [("1", "output"), *(("row", name) for name in ("nominal", "mean", "st. dev.")),
               *(("row", f"{level} %") for level in levels), ("1", "values")]  # fmt: skip
    rows = []
    for name in outputs:
        moments, spread = numbers["moments"][name], numbers["quantiles"][name]
        rows.append([name, numbers["nominal"][name], moments["mean"], moments["standard_deviation"],
                     *(spread[level] for level in levels), moments["count"]])  # fmt: skip
    shown = (("1", "key", "key"), ("1", "scatter", "scatter"), ("1", "first", "first"), ("1", "total", "total"),
             ("1", "from", "total_low"), ("1", "to", "total_high"), ("1", "rank corr.", "rank_correlation"),
             ("share", "sd if halved", "halved"), ("share", "if none", "removed"),
             ("share", "contact if halved", "contact_halved"))  # fmt: skip
    tables = [Table("distribution", columns, rows, of_rows=[quantity_of(name) for name in outputs]),
              table_of(f"keys for {first}", shown, numbers["tighten"][first])]  # fmt: skip
    total = numbers["sobol"]["total"]
    if total and len(outputs) > 1 and any(total.values()):
        rows = [[row["key"], *(total[name] and total[name][row["key"]] for name in outputs)]
                for row in numbers["tighten"][first]]  # fmt: skip
        tables.append(Table("total indices", [("1", "total index"), *(("1", name) for name in outputs)], rows))
    return tables
