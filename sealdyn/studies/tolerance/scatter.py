"""How scenario keys scatter: distributions as a user writes them, correlations, and scrambled Sobol points of both."""

import re
import typing
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import norm, qmc, truncnorm, uniform

from ...scenario.errors import ScenarioError, diameters, nearest, nearest_of, tables, without_indices
from ...scenario.overrides import radius_key
from ...scene import variants
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

    def _quantity(self) -> Quantity | None:
        """What the key holds; None for a plain number.  Raises ScenarioError if it is no key, or no number."""
        table, _, last = self.key.rpartition(".")
        known = {table: keys | diameters(keys) for table, keys in tables(Scene).items()}
        if last not in known.get(without_indices(table), {}):
            # Of a table that there is not, and a key that none has: which tables there are.
            strange = without_indices(table) not in known and not any(last in keys for keys in known.values())
            hint = f"the tables are {', '.join(known[''])}" if strange else nearest(Scene, table, last)
            raise self.wrong(f"an unknown key {self.key}", f"a key of the scene; {hint}")
        last = radius_key(Scene, self.key).rpartition(".")[2]
        try:
            owner = variants.part(self.scenario.scene, table) if table else self.scenario.scene
            kind = typing.get_type_hints(type(owner), include_extras=True)[last]
        except (AttributeError, IndexError, KeyError, ValueError):
            raise self.wrong(f"{self.key}", f"a key of a table that the scenario has: no {table}") from None
        quantity = quantity_of(kind)
        if quantity and quantity.example:
            return quantity
        # A number with or without what is usual of it.
        if quantity or any(float in (k, getattr(k, "__origin__", None)) for k in (kind, *typing.get_args(kind))):
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
        radius = radius_key(Scene, self.key)
        value = variants.part(self.scenario.scene, radius)
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
