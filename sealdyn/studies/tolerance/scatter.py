"""How scenario keys scatter (distributions as a user writes them, correlations, scrambled Sobol points), and what
scattered runs say: distribution of an output, probability of an event, Sobol indices, each with its doubt."""

import re
import typing
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import binomtest, norm, qmc, spearmanr, truncnorm, uniform

from ...quantities import everyday
from ...scenario.errors import ScenarioError, nearest, nearest_of
from ...scenario.keys import diameters, radius_key, tables, without_indices
from ...scenario.own_options import with_options
from ...scenario.tables import outside_of
from ...scene import scene as scenes
from ...scene.scene import Scene
from ...units import Length, Quantity, QuantityError, quantity_of, quoted

SCATTER, CORRELATIONS = "study.tolerance.scatter", "study.tolerance.correlations"
# What a distribution takes, beside "MEAN +- WIDTH" and "+- WIDTH": counts of numbers, the last without the mean.
TAKES = {"normal": (2, 1), "uniform": (2,), "truncated": (4, 3)}
FORMS = {
    "normal": "normal(MEAN, SIGMA), normal(SIGMA) or normal(MEAN +- 3 SIGMA)",
    "uniform": "uniform(LOW, HIGH) or uniform(MEAN +- HALF WIDTH)",
    "truncated": "truncated(MEAN, SIGMA, LOW, HIGH) or truncated(MEAN +- 3 SIGMA)",
}
ENTRY = re.compile(r"\s*([\w.]+)\s*=\s*(\w+)\s*\((.*)\)\s*")
NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
PAIR = re.compile(r"\s*([\w.]+)\s*,\s*([\w.]+)\s*=\s*(\S+)\s*")
# A tolerance +-W of a normal distribution is so many standard deviations.
SIGMAS = 3.0
# Independent scrambles of the points: of 256 samples four lose nothing against one (eight do), and tell the error.
SCRAMBLES = 4
LENGTH = Length.__metadata__[0]


@dataclass(frozen=True)
class Scatter:
    """How one key scatters: `law` (a frozen distribution of scipy.stats, SI) about its `centre`; `unit` SI; `words` as
    the user wrote them."""

    key: str
    law: typing.Any
    centre: float
    unit: str
    words: str

    def halved(self, values) -> np.ndarray:
        """Weights (n,) that turn values (n,) of this scatter into values of half of it about the centre: the ratio of
        the densities, 2 f(c + 2 (x - c)) / f(x), at most 2 since no density here rises away from the centre."""
        return 2 * self.law.pdf(self.centre + 2 * (values - self.centre)) / self.law.pdf(values)


def read_scatter(scenario, entries) -> list[Scatter]:
    """Scatters of the entries "KEY = KIND(NUMBERS)", each key once.  Raises ScenarioError."""
    if not entries:
        raise ScenarioError(scenario.name, SCATTER, "nothing that scatters", '--scatter "rotor.runout=normal(+- 10 %)"')
    found = [_Entry(scenario, words).scatter() for words in entries]
    keys = [scatter.key for scatter in found]
    for key in keys:
        if keys.count(key) > 1:
            raise ScenarioError(scenario.name, SCATTER, f"{key} {keys.count(key)} times", "each key once")
    return found


class _Entry:
    """One entry being read; whatever is wrong with it is one line that quotes it."""

    def __init__(self, scenario, words: str):
        self.scenario, self.words = scenario, words
        match = ENTRY.fullmatch(words) if isinstance(words, str) else None
        if not match:
            raise self.wrong("no KEY = KIND(...)", f'"KEY = KIND(...)", e.g. {FORMS["normal"]}')
        self.key, self.kind, self.inside = match.groups()

    def wrong(self, found: str, expected: str) -> ScenarioError:
        return ScenarioError(self.scenario.name, SCATTER, f"{found} in {quoted(self.words, 90)}", expected)

    def scatter(self) -> Scatter:
        if self.kind not in FORMS:
            hint = nearest_of(self.kind, FORMS)
            raise self.wrong(f"the distribution {quoted(self.kind)}", f"one of {', '.join(FORMS)}{hint}")
        self.quantity = self._quantity()
        low, high, centre, sigma = self._numbers()
        if self.kind == "uniform":
            law = uniform(low, high - low)
        elif self.kind == "normal":
            law = norm(centre, sigma)
        else:
            law = truncnorm((low - centre) / sigma, (high - centre) / sigma, centre, sigma)
        return Scatter(self.key, law, centre, self.quantity.unit if self.quantity else "", self.words)

    def _kind(self) -> type:
        """The dataclass of the scene, with options from outside."""
        return with_options(Scene, outside_of(self.scenario.scene))

    def _quantity(self) -> Quantity | None:
        """What the key holds; None for a plain number.  Raises ScenarioError if it is no key, or no number."""
        table, _, last = self.key.rpartition(".")
        kind = self._kind()
        known = {table: keys | diameters(keys) for table, keys in tables(kind).items()}
        if last not in known.get(without_indices(table), {}):
            # Of a table that there is not, and a key that none has: which tables there are.
            strange = without_indices(table) not in known and not any(last in keys for keys in known.values())
            hint = f"the tables are {', '.join(known[''])}" if strange else nearest(kind, table, last)
            raise self.wrong(f"an unknown key {self.key}", f"a key of the scene; {hint}")
        last = radius_key(kind, self.key).rpartition(".")[2]
        try:
            owner = scenes.part(self.scenario.scene, table) if table else self.scenario.scene
            kind, plain = (typing.get_type_hints(type(owner), include_extras=extras)[last] for extras in (True, False))
        except (AttributeError, IndexError, KeyError, ValueError):
            raise self.wrong(f"{self.key}", f"a key of a table that the scenario has: no {table}") from None
        quantity = quantity_of(kind)
        if quantity and quantity.example:
            return quantity
        # A number with or without what is usual of it.
        if quantity or float in (plain, *typing.get_args(plain)):
            return None
        raise self.wrong(f"{self.key}, which holds no number", "a key that holds a number, with or without unit")

    def _numbers(self) -> tuple[float, float, float, float]:
        """Low, high, centre and standard deviation (SI; not a number where the kind has none)."""
        before, plus_minus, after = self.inside.replace("±", "+-").partition("+-")
        if plus_minus:
            return self._tolerance(before, after)
        parts = before.split(",")
        if len(parts) not in TAKES[self.kind]:
            raise self.wrong(f"{len(parts)} numbers", FORMS[self.kind])
        unit = self._unit(parts)
        if self.kind == "uniform":
            low, high = (self._value(part, unit) for part in parts)
            if not low < high:
                raise self.wrong(f"{high:g} after {low:g}", "a high value above the low one")
            return low, high, (low + high) / 2, np.nan
        own = len(parts) == TAKES[self.kind][1]
        centre = self._own() if own else self._value(parts.pop(0), unit)
        sigma = self._width(parts[0], unit, centre)
        if self.kind == "normal":
            return np.nan, np.nan, centre, sigma
        low, high = (self._value(part, unit) for part in parts[1:])
        if not low < centre < high:
            raise self.wrong(f"bounds {low:g} and {high:g} of the mean {centre:g}", "a mean between its bounds")
        return low, high, centre, sigma

    def _tolerance(self, before: str, after: str) -> tuple[float, float, float, float]:
        """What "MEAN +- WIDTH" says, or "+- WIDTH" of the scenario's own value."""
        unit = self._unit((before, after))
        centre = self._value(before, unit) if before.strip() else self._own()
        width = self._width(after, unit, centre)
        return centre - width, centre + width, centre, width / SIGMAS

    def _own(self) -> float:
        radius = radius_key(self._kind(), self.key)
        value = scenes.part(self.scenario.scene, radius)
        if not isinstance(value, int | float):
            found = "no value" if value is None else "a function of time"
            raise self.wrong(f"{found} of {self.key} in the scenario", FORMS[self.kind])
        return float(value) if radius == self.key else 2 * float(value)

    def _unit(self, parts) -> str:
        """The last unit written: a number without a unit is in that of its neighbours."""
        matches = [NUMBER.fullmatch(part) for part in parts]
        return next((m[2] for m in reversed(matches) if m and m[2] not in ("", "%")), "")

    def _width(self, words: str, unit: str, centre: float) -> float:
        """A standard deviation or a tolerance, SI, positive; "%" is of the mean."""
        match = NUMBER.fullmatch(words)
        if match and match[2] == "%":
            width = abs(centre) * float(match[1]) / 100
            if not float(match[1]) > 0 or not width > 0:
                raise self.wrong(f"{words.strip()} of {centre:g}", "more than nothing")
            return width
        return self._value(words, unit, positive=True)

    def _value(self, words: str, unit: str, positive: bool = False) -> float:
        """The number in SI; without a unit in `unit`, or SI if that is "".  A runout may be "20 um TIR"."""
        match, quantity = NUMBER.fullmatch(words), self.quantity or Quantity("number", "", "0.75")
        if not match:
            raise self.wrong(f"{quoted(words.strip())}", quantity.expected() if self.quantity else "a number")
        number, written = match[1], match[2] or unit
        if positive:
            # A width counts from no zero but its own: of degrees, kelvins, and never gauge.
            quantity = Quantity(quantity.name, quantity.unit, quantity.example, quantity.also, 0, True)
        if self.quantity is None and written:
            raise self.wrong(f"{quoted(words.strip())}", "a number without a unit")
        try:
            if self.key == "rotor.runout" and written.endswith("TIR"):
                reading = LENGTH.read(f"{number} {written.removesuffix('TIR').strip()}")
                return quantity.read(reading / (2 * self.scenario.scene.film.outer_radius))
            return quantity.read(f"{number} {written}" if written else float(number))
        except QuantityError as error:
            raise self.wrong(error.found, error.expected) from None


# --- correlations and points --------------------------------------------------------------------------


def read_correlations(scenario, entries, keys: list[str]) -> np.ndarray | None:
    """Cholesky factor (d, d) of the correlations "KEY, KEY = NUMBER" of the standard normals behind the keys; None
    without any.  Raises ScenarioError."""
    if not entries:
        return None

    def wrong(found, expected):
        return ScenarioError(scenario.name, CORRELATIONS, found, expected)

    matrix, seen = np.eye(len(keys)), set()
    for words in entries:
        match = PAIR.fullmatch(words) if isinstance(words, str) else None
        if not match:
            raise wrong(quoted(words, 90), '"KEY, KEY = NUMBER", e.g. "rotor.runout, stator.misalignment = 0.6"')
        for key in match[1], match[2]:
            if key not in keys:
                hint = nearest_of(key, keys)
                raise wrong(f"{key} in {quoted(words, 90)}", f"a key that scatters: {', '.join(keys)}{hint}")
        number = NUMBER.fullmatch(match[3])
        value = float(number[1]) if number and not number[2] else np.nan
        pair = frozenset((match[1], match[2]))
        if not -1 < value < 1 or len(pair) < 2 or pair in seen:
            raise wrong(quoted(words, 90), "two different keys once, and a number between -1 and 1")
        seen.add(pair)
        i, j = (keys.index(key) for key in pair)
        matrix[i, j] = matrix[j, i] = value
    least = np.linalg.eigvalsh(matrix)[0]
    if least < 1e-10:
        found = f"correlations that contradict one another (least eigenvalue {least:.3g})"
        raise wrong(found, "a positive definite matrix: smaller correlations, or more of them")
    return np.linalg.cholesky(matrix)


def points(scatters: list[Scatter], samples: int, seed: int, factor=None) -> tuple[np.ndarray, np.ndarray]:
    """Two sets of values (n, d), SI, independent of each other: SCRAMBLES independent scramblings of the Sobol sequence
    in 2 d dimensions, `samples` / SCRAMBLES points each, row j of scramble j % SCRAMBLES, so that the first
    SCRAMBLES 2^k rows are the first 2^k points of all.  `factor`: Cholesky factor of a Gaussian copula.

    **Source** Owen (1995): every scrambled point is uniform on the cube, so each scramble is unbiased and their
    differences tell the error; Saltelli et al. (2010), section 5, for the 2 d columns.
    """
    d, each = len(scatters), samples // SCRAMBLES
    blocks = [qmc.Sobol(2 * d, seed=np.random.default_rng([seed, k])).random(each) for k in range(SCRAMBLES)]
    # Half a bit up: a share of exactly zero has no finite normal value.
    shares = np.stack(blocks, axis=1).reshape(samples, 2, d) + 2.0**-31
    if factor is not None:
        shares = ndtr(ndtri(shares) @ factor.T)
    values = np.stack([s.law.ppf(shares[:, :, i]) for i, s in enumerate(scatters)], axis=-1)
    return values[:, 0], values[:, 1]


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
    scattered = len(x) > 1
    return {"count": len(x), "mean": number(np.mean(x)) if len(x) else None,
            "mean_error": error_of_mean(x, scrambles[known]) if scattered else None,
            "standard_deviation": number(np.std(x, ddof=1)) if scattered else None}  # fmt: skip


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
