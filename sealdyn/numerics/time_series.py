"""What a motion looks like once it has settled: its period, its class, its spectrum, and averages with their
uncertainty.

A section holds one point (real or complex) per return of the motion, such as one per period of a forcing.
**Source** Moon, *Chaotic Vibrations* (1987), ch. 2 and 5: sections, spectra and exponents as the tests of chaos.
"""

import numpy as np
from scipy.stats import t as student

# Returns closer than this (in units of the scale) are the same point; longest period looked for.
SAME, LONGEST = 2e-3, 16
# Repeated this much better still, points may lie close together.
EXACT = 0.05
# An exponent this well known to be zero is a motion on a torus.
TORUS = 0.05
BLOCKS = (8, 16)


def period_of(section, scale: float, same: float = SAME) -> int | None:
    """Smallest number of returns after which all later points of a section (m,) repeat within `same` x scale, and
    between which as many points are seen; None if there is none up to LONGEST."""
    section = np.asarray(section)
    for k in range(1, min(LONGEST, len(section) // 3) + 1):
        mismatch = np.max(np.abs(section[k:] - section[:-k])) / scale
        if mismatch <= same:
            # A slow spiral also comes near where it was, but is seen at too few or too many places.
            apart = same if mismatch <= EXACT * same else 3 * same
            return k if distinct_points(section, scale, apart) == k else None
    return None


def shrinking(section) -> bool:
    """Whether the section (m,) still draws together: its last third is spread less than seven tenths of its first."""
    third = len(section) // 3
    return bool(np.std(section[-third:]) < 0.7 * np.std(section[:third]))


def distinct_points(section, scale: float, same: float = SAME) -> int:
    """How many points of a section (m,) differ by more than `same` x scale."""
    kept: list[complex] = []
    for point in section:
        if all(abs(point - other) > same * scale for other in kept):
            kept.append(point)
    return len(kept)


def spread(section) -> float:
    """Size of an attractor, in units of its section (m,): standard deviation of the section, of one band if it visits
    several in turn; 0 for fewer than eight points."""
    section = np.asarray(section)
    bands = [[np.var(section[j::k]) for j in range(k)] for k in (1, 2, 3, 4, 6, 8) if len(section) >= 8 * k]
    return float(np.sqrt(min(np.mean(variances) for variances in bands))) if bands else 0.0


# Growth a return below which nothing is called chaotic.
SLIGHT = 0.02


def classify(period: int | None, exponent: float, uncertainty: float, still: bool = False, points: int = 1000) -> str:
    """The class of a motion: "period k", "chaotic", "quasi-periodic", "settling" or "undecided".

    `period` (returns, or None), largest `exponent` per return and its `uncertainty`, `still` whether the section draws
    together, `points` its distinct points.  Period: the section repeats, and nothing grows (else settling).  Chaotic:
    it does not repeat, and the exponent is above zero by more than its uncertainty and above SLIGHT (else undecided).
    Settling: the exponent is below zero by as much, or the section draws together or has few points.  Quasi-periodic:
    none of these, and the exponent is known to be zero within TORUS (else undecided).
    """
    if period is not None:
        # On an orbit that repels, or still coming nearer to another one: the motion is not yet what it will be.
        moving = exponent > uncertainty or (period > 1 and still)
        return "settling" if moving else f"period {period}"
    if exponent > uncertainty:
        # So slow a growth is that of a motion about to bifurcate, or of too short a look.
        return "chaotic" if exponent > SLIGHT else "undecided"
    if exponent < -uncertainty or still or points <= LONGEST:
        return "settling"
    return "quasi-periodic" if uncertainty <= TORUS else "undecided"


def spectrum(series, per_return: int) -> tuple[np.ndarray, np.ndarray]:
    """Orders (cycles per return) and amplitudes, both (m // 2 + 1,), of a series (m,) with `per_return` even samples a
    return, mean taken off, Hann window: exact for a line on a bin."""
    series = np.asarray(series, dtype=float)
    window = 1.0 - np.cos(2 * np.pi * np.arange(len(series)) / len(series))
    amplitude = 2.0 / len(series) * np.abs(np.fft.rfft((series - series.mean()) * window))
    return np.fft.rfftfreq(len(series), 1.0 / per_return), amplitude


def lines(orders, amplitude, wanted=(0.5, 1.0, 1.5, 2.0, 3.0, 4.0)) -> dict[str, float]:
    """Amplitudes {"0.5": a, "1": a, ...} at the `wanted` orders (the largest within 1.6 bins) of a spectrum (`orders`,
    `amplitude`, (m,)), and `between`: share of the power more than two bins off every integer order, of all above a
    quarter order."""
    width = orders[1] - orders[0]
    found = {f"{w:g}": float(amplitude[np.abs(orders - w) < 1.6 * width].max()) for w in wanted}
    seen, off = orders > 0.25, np.abs(orders - np.round(orders)) > 2.1 * width
    power = amplitude**2
    return found | {"between": float(power[seen & off].sum() / max(power[seen].sum(), 1e-300))}


def average(series, statistic=np.mean) -> dict:
    """{"value", "uncertainty"} of a statistic of a stationary series (m,), in the unit of the statistic: the
    uncertainty (95 % of cases) is the spread of the same over blocks, and 0 for fewer than 32 samples, which have none.
    """
    series = np.asarray(series, dtype=float)
    errors = [0.0]
    for count in BLOCKS:
        length = len(series) // count
        if length < 4:
            continue
        values = [float(statistic(part)) for part in series[: count * length].reshape(count, length)]
        errors.append(float(np.std(values, ddof=1) / np.sqrt(count) * student.ppf(0.975, count - 1)))
    return {"value": float(statistic(series)), "uncertainty": max(errors)}


def statistics(series, name: str) -> dict:
    """{NAME_mean, NAME_std, NAME_median, NAME_q05, NAME_q95} of a series (m,), each as `average`."""
    return {
        f"{name}_mean": average(series),
        f"{name}_std": average(series, np.std),
        f"{name}_median": average(series, np.median),
        f"{name}_q05": average(series, lambda part: np.quantile(part, 0.05)),
        f"{name}_q95": average(series, lambda part: np.quantile(part, 0.95)),
    }


def compared(one: dict, other: dict, floors: dict) -> dict:
    """Two sets of averages {name: `average`} side by side: {name: {"values" [2], "uncertainties" [2], "allowed",
    "agree"}}; they agree where they differ by no more than both uncertainties and the floor of that name in `floors`.
    """
    rows = {}
    for name, a in one.items():
        b = other[name]
        apart, allowed = abs(a["value"] - b["value"]), a["uncertainty"] + b["uncertainty"] + floors.get(name, 0.0)
        rows[name] = {
            "values": [a["value"], b["value"]],
            "uncertainties": [a["uncertainty"], b["uncertainty"]],
            "allowed": allowed,
            "agree": bool(apart <= allowed),
        }
    return rows
