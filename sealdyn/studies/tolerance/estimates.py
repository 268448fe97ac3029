"""What scattered runs say: distribution of an output, probability of an event, Sobol indices, each with its doubt."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest, spearmanr

from ...quantities import everyday
from .scatter import SCRAMBLES

LEVELS = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
CONFIDENCE = 0.95
RESAMPLES = 1000
PERCENT = everyday("share")[1]


def quantiles(values) -> dict[str, float | None]:
    """{percent: value} of the numbers among the values (n,)."""
    known = values[np.isfinite(values)]
    found = np.quantile(known, LEVELS) if len(known) else [np.nan] * len(LEVELS)
    return {f"{PERCENT * level:g}": number(value) for level, value in zip(LEVELS, found, strict=True)}


def moments(values, scrambles) -> dict:
    """`count` of numbers among the values (n,), `mean`, its standard error from the differences of the `scrambles`
    (n,), and `standard_deviation`."""
    known = np.isfinite(values)
    x = values[known]
    if len(x) < 2:
        return {"count": len(x), "mean": number(np.mean(x)) if len(x) else None, "mean_error": None,
                "standard_deviation": None}  # fmt: skip
    return {"count": len(x), "mean": number(np.mean(x)), "mean_error": error_of_mean(x, scrambles[known]),
            "standard_deviation": number(np.std(x, ddof=1))}  # fmt: skip


def error_of_mean(values, scrambles) -> float | None:
    """Standard error of the mean of the values (n,) of independent `scrambles` (n,): each scramble's mean is unbiased
    and they are independent, so the variance of R of them over R is that of their mean, whatever the function.
    None if a scramble has no value."""
    means = [np.mean(values[scrambles == k]) for k in range(SCRAMBLES) if np.any(scrambles == k)]
    return number(np.std(means, ddof=1) / np.sqrt(SCRAMBLES)) if len(means) == SCRAMBLES else None


def probability(happened, scrambles) -> dict:
    """Probability of an event, from runs (n,) in which it happened (1), did not (0), or may have (not a number).

    `value` over the runs that are known; `low`, `high` the 95 % interval of Clopper and Pearson (1934), which is exact
    for independent runs: it covers at least that often; a run that is not known counts as either.  Scrambled points
    are more even than independent ones, so it is wider than it need be.  No theorem says so of every event (Owen 1998
    bounds their variance by a multiple of p (1 - p) / n only): `standard_error`, from the scrambles, is what holds.
    Where nothing happened the interval alone speaks.
    """
    known = np.isfinite(happened)
    count, runs, unknown = int(np.nansum(happened)), int(known.sum()), int((~known).sum())
    if not runs:
        return {"value": None, "low": 0.0, "high": 1.0, "count": 0, "runs": 0, "unknown": unknown,
                "standard_error": None}  # fmt: skip
    low = binomtest(count, runs + unknown).proportion_ci(CONFIDENCE, "exact").low
    high = binomtest(count + unknown, runs + unknown).proportion_ci(CONFIDENCE, "exact").high
    error = error_of_mean(happened[known], scrambles[known])
    return {"value": count / runs, "low": float(low), "high": float(high), "count": count, "runs": runs,
            "unknown": unknown, "standard_error": error}  # fmt: skip


def sobol(a, b, ab, weights=None) -> tuple[np.ndarray, np.ndarray]:
    """First and total Sobol indices (..., d) of an output at the points A and B (n,), and at A with one key of B
    (d, n): the share of the variance that a key makes by itself, and with all it interacts with; `weights` (..., n) of
    the points, with the sum 1.  Not a number for an output that does not vary.

    **Source** Saltelli et al. (2010), Computer Physics Communications 181, table 2 (b) and (f), as
    scipy.stats.sobol_indices has it, which takes no n but a power of two: base points with a failed run are left out.
    **Valid** independent keys.
    """
    weights = np.full(len(a), 1 / len(a)) if weights is None else weights
    centre, change = 0.5 * (np.mean(a) + np.mean(b)), ab - a
    a, b = a - centre, b - centre
    mean, square = 0.5 * weights @ (a + b), 0.5 * weights @ (a**2 + b**2)
    # What differs by rounding only does not vary.
    scale = np.where(square > (1e-12 * centre) ** 2, square - mean**2, np.nan)[..., None]
    first = weights @ (b * change).T - mean[..., None] * (weights @ change.T)
    return first / scale, 0.5 * weights @ (change**2).T / scale


def sobol_intervals(a, b, ab, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """95 % intervals (2, d) of the first and total indices, by a bootstrap over the base points as if they were
    independent; a resample that does not vary tells nothing."""
    draws = np.random.default_rng([seed, SCRAMBLES]).multinomial(len(a), np.full(len(a), 1 / len(a)), RESAMPLES)
    tail = 0.5 * (1 - CONFIDENCE)
    return tuple(np.nanquantile(found, [tail, 1 - tail], axis=0) for found in sobol(a, b, ab, draws / len(a)))


def rank_correlation(x, y) -> float | None:
    """Spearman's rank correlation of two series (n,), over the numbers of the second; None if either is constant."""
    known = np.isfinite(y)
    x, y = x[known], y[known]
    if len(y) < 3 or np.ptp(x) == 0 or np.ptp(y) == 0:
        return None
    return number(spearmanr(x, y).statistic)


def weighted_mean(values, weights) -> float | None:
    """Mean of the numbers among the values (n,) with weights (n,)."""
    known = np.isfinite(values)
    return float(np.average(values[known], weights=weights[known])) if weights[known].sum() > 0 else None


def number(value) -> float | None:
    """A float that JSON takes."""
    return float(value) if np.isfinite(value) else None


# Contacts below which nothing is said about what decides them.
FEW = 10


@dataclass(frozen=True)
class Sample:
    """The points whose runs make the distribution: `values` (n, d) of the keys, A above B."""

    scatters: list
    values: np.ndarray
    samples: int
    sets: int

    @property
    def scrambles(self) -> np.ndarray:
        """Which scramble each point is of, (n,)."""
        return np.tile(np.arange(self.samples) % SCRAMBLES, self.sets)


def indices(found, keys, seed) -> dict:
    """Sobol indices {output: {key: value}}, `first` and `total`, their 95 % intervals, and the `base_points` of each
    output all of whose runs have a value; None of an output that does not vary."""
    kinds = ("first", "total", "first_interval", "total_interval")
    answer = {**{kind: {} for kind in kinds}, "base_points": {}, "reason": None}
    for name, values in found.items():
        a, b, *ab = values[:, np.isfinite(values).all(axis=0)]
        answer["base_points"][name] = len(a)
        columns = 4 * [None]
        if len(a) > 2 * SCRAMBLES and np.isfinite(sobol(a, b, np.array(ab))).all():
            columns = [*sobol(a, b, np.array(ab)), *(c.T for c in sobol_intervals(a, b, np.array(ab), seed))]
        for kind, column in zip(kinds, columns, strict=True):
            answer[kind][name] = None if column is None else dict(zip(keys, column.tolist(), strict=True))
    return answer


def tightened(whole, values, contact, found, name, independent) -> list[dict]:
    """What each key makes of an output's spread, the one to tighten first on top: rows of `key`, `scatter`,

    `first`, `total` indices, the total's interval `total_low`, `total_high`, and `rank_correlation`;
    `halved`, `removed`: standard deviation over the present one if the key scattered half as much about its centre, or
    not at all: sqrt(1 - 3/4 total) and sqrt(1 - total).  **Valid** for an output a(others) + b(others) (x - centre):
    its variance is Var(a) + E(b^2) sigma^2, the second part the total index of it; about right where it bends little.
    `contact_halved`: probability of contact with half the scatter, the same runs weighted, whatever decides contact;
    None if only a FEW touched.
    """
    rows = []
    for i, scatter in enumerate(whole.scatters):
        x = whole.values[:, i]
        row = dict.fromkeys(("first", "total", "total_low", "total_high", "halved", "removed", "contact_halved"))
        row |= {"key": scatter.key, "scatter": scatter.words.partition("=")[2].strip(),
                "rank_correlation": rank_correlation(x, values)}  # fmt: skip
        if found["total"] and found["total"][name]:
            row["first"], row["total"] = (found[kind][name][scatter.key] for kind in ("first", "total"))
            row["total_low"], row["total_high"] = found["total_interval"][name][scatter.key]
            # An index is estimated: it may come out a little above one.
            share = min(row["total"], 1.0)
            row["halved"], row["removed"] = (float(np.sqrt(1 - part * share)) for part in (0.75, 1))
        if independent and np.nansum(contact) >= FEW:
            row["contact_halved"] = weighted_mean(contact, scatter.halved(x))
        rows.append(row)
    rank = "total" if any(row["total"] is not None for row in rows) else "rank_correlation"
    return sorted(rows, key=lambda row: -abs(row[rank] or 0.0))


def convergence(found, contact, samples, output, keys) -> dict:
    """The estimates from the first 2^k points of all scrambles, up to all: number of `runs`, `probability_of_contact`
    [value, low, high], `quantiles` of the first output, its `standard_deviation`, and `total` indices {key: [...]}."""
    counts = [SCRAMBLES << k for k in range(2, samples.bit_length()) if SCRAMBLES << k <= samples]
    values, sets = found[output], min(len(found[output]), 2)
    answer = {"samples": counts, "runs": [sets * n for n in counts], "output": output, "probability_of_contact": [],
              "quantiles": {}, "standard_deviation": [], "total": {key: [] for key in keys}}  # fmt: skip
    for n in counts:
        part, scrambles = values[:2, :n].ravel(), np.tile(np.arange(n) % SCRAMBLES, sets)
        risk = probability(contact[:2, :n].ravel(), scrambles)
        answer["probability_of_contact"].append([risk["value"], risk["low"], risk["high"]])
        answer["standard_deviation"].append(moments(part, scrambles)["standard_deviation"])
        for level, value in quantiles(part).items():
            answer["quantiles"].setdefault(level, []).append(value)
        a, b, *ab = values[:, :n][:, np.isfinite(values[:, :n]).all(axis=0)] if sets > 1 else ([], [])
        total = sobol(a, b, np.array(ab))[1] if len(a) else [np.nan] * len(keys)
        for key, value in zip(keys, total, strict=True):
            answer["total"][key].append(number(value))
    return answer
