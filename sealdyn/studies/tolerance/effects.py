"""What each key makes of the scatter: Sobol indices, what tightening it would leave, and how sure the numbers are."""

from dataclasses import dataclass

import numpy as np

from .estimates import moments, number, probability, quantiles, rank_correlation, sobol, sobol_intervals, weighted_mean
from .scatter import SCRAMBLES

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
