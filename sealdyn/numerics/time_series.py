"""What a motion looks like once it has settled: its period, its class, its spectrum in orders of a turn or in
frequency, and averages with their uncertainty.

A section holds one point (real or complex) per return of the motion, such as one per period of a forcing.
**Source** Moon, *Chaotic Vibrations* (1987), ch. 2 and 5: sections, spectra and exponents as the tests of chaos.
"""

from dataclasses import dataclass

import numpy as np

# Equivalent noise bandwidth of the Hann window, in bins: what a resolution means.
HANN = 1.5
# Share of the power in the top tenth of the band, of all that moves, above which a spectrum may be folded.  Measured:
# below 3e-7 in well sampled runs; 9e-4 with the housing's 5.4 kHz at order 33.75 of 160 Hz, 64 samples a turn.
FOLDED = 1e-4
CLEAR = 4  # lines
NEAR = 0.1  # lines: an order this near is that of the line
CLEAN = 0.02  # of a peak: by which the lines beside one that is clear of others are off


def at_the_edge(orders, amplitude, near: float, still: float = 0.0) -> float:
    """Share of the power in the top tenth of the sampled band, of all orders farther than 2 `near` from zero: a
    response that has not died out there is folded.  `orders`, `amplitude` (n,); 0 if all that moves stays below `still`
    (unit of the amplitude)."""
    power = np.where(np.abs(orders) > 2 * near, amplitude**2, 0.0)
    total = power.sum()
    edge = power[np.abs(orders) > 0.9 * np.abs(orders).max()].sum()
    return float(edge / total) if total > still**2 else 0.0


def order_spectrum(turns, signal):
    """Amplitude spectrum of `signal` (real or complex) over shaft angle, Hann window.

    `turns` rise; where they do not rise evenly the signal is resampled by cubic interpolation.  Cut to a
    whole number of turns, so that integer orders fall on a line of the spectrum.  Returns orders,
    amplitudes (of a cosine if real, of the rotating vector if complex), resolution (orders), resampled.  Of what a
    standing shaft has at one angle the first counts.
    """
    turning = np.r_[True, np.diff(turns) != 0.0]
    turns, signal = turns[turning], signal[turning]
    step = (turns[-1] - turns[0]) / (len(turns) - 1)
    resampled = bool(np.abs(np.diff(turns) / step - 1).max() > 1e-3)
    if resampled:
        grid = np.linspace(turns[0], turns[-1], len(turns))
        signal = cubic(grid, turns, signal)
    if step < 0.5:
        whole = np.floor((turns[-1] - turns[0]) / 1.0 + 1e-6)
        signal = signal[-max(2, round(whole / step)) :]
    if np.isrealobj(signal):
        signal = signal - signal.mean()
    count = len(signal)
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(count) / count)
    if np.iscomplexobj(signal):
        lines = np.fft.fftshift(np.fft.fft(hann * signal))
        orders = np.fft.fftshift(np.fft.fftfreq(count, step))
        amplitude = np.abs(lines) / hann.sum()
    else:
        orders, amplitude = np.fft.rfftfreq(count, step), 2 * np.abs(np.fft.rfft(hann * signal)) / hann.sum()
    return orders, amplitude, HANN / (count * step), resampled


def cubic(at, x, y):
    """Lagrange interpolation through the four nearest rows; `x` rises, unevenly."""
    k = np.clip(np.searchsorted(x, at) - 2, 0, len(x) - 4)
    total = np.zeros(len(at), y.dtype)
    for i in range(4):
        weight = np.ones(len(at))
        for j in range(4):
            if j != i:
                weight *= (at - x[k + j]) / (x[k + i] - x[k + j])
        total += weight * y[k + i]
    return total


def peaks(orders, amplitude, most: int = 5) -> np.ndarray:
    """Rows of the largest local maxima, above 1 % of the largest and clear of one another."""
    inside = np.r_[False, (amplitude[1:-1] >= amplitude[:-2]) & (amplitude[1:-1] > amplitude[2:]), False]
    # A peak stands at least twice above a valley a few lines to its left, and one to its right.
    around = np.lib.stride_tricks.sliding_window_view(np.pad(amplitude, CLEAR, mode="reflect"), CLEAR)
    inside &= amplitude > 2 * np.maximum(around[: -CLEAR - 1].min(1), around[CLEAR + 1 :].min(1))
    ranked = np.flatnonzero(inside & (amplitude > 0.01 * amplitude.max()))
    kept: list[int] = []
    for at in ranked[np.argsort(-amplitude[ranked])]:
        if all(abs(orders[at] - orders[other]) > 0.3 for other in kept) and len(kept) < most:
            kept.append(int(at))
    return np.array(kept, int)


def located(orders, amplitude, at: int) -> tuple[float, float]:
    """Order and amplitude of a peak between the lines of a spectrum with a Hann window, from its line and the larger
    one beside it: with the ratio r of these it lies d = (2 r - 1)/(r + 1) of a line towards that one.  The line on the
    other side, (1 - d)/(2 + d) of its own, tells whether it is clear of others; else it is taken as it stands.

    **Source** Grandke (1983), IEEE Trans. Instrum. Meas. 32, 350.  **Valid** of one order, clear of others."""
    towards = 1 if amplitude[at + 1] > amplitude[at - 1] else -1
    near, far = (amplitude[at + side] / amplitude[at] for side in (towards, -towards))
    off = (2 * near - 1) / (near + 1)
    if not NEAR <= off <= 0.5 or abs(far - (1 - off) / (2 + off)) > CLEAN:
        return float(orders[at]), float(amplitude[at])
    order = orders[at] + towards * off * (orders[1] - orders[0])
    return float(order), float(amplitude[at] * (1 - off**2) / np.sinc(off))


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
        errors.append(float(np.std(values, ddof=1) / np.sqrt(count) * _student(count)))
    return {"value": float(statistic(series)), "uncertainty": max(errors)}


def _student(count: int) -> float:
    """Student's t of 95 %; SciPy's functions are loaded where they are used, as spectra need none."""
    from scipy.special import stdtrit

    return stdtrit(count - 1, 0.975)


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


# --- Lyapunov exponents ----------------------------------------------------------------------------

# Lyapunov exponents of a map, by two methods that share nothing, with their uncertainty; and how far one can see.
#
# A map is a function of a point; a flow becomes one by integrating it over a fixed time. Exponents are per iteration.
# **Source** Benettin, Galgani, Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9 and 21: two neighbours pulled back
# together, and products of tangent maps made orthonormal; block averages: Flyvbjerg & Petersen, *J. Chem. Phys.* 91
# (1989) 461. **Valid** maps with a continuous derivative; the trajectory must be on its attractor when counting
# begins.

# Blocks an uncertainty is drawn from: fewer say too little, more are too short to be independent.
EXPONENT_BLOCKS = (8, 12, 16, 24, 32)


@dataclass(frozen=True)
class Exponent:
    """Largest exponent per iteration (`value`), its uncertainty (95 % of cases, by blocks), and the spectrum (k,): as
    many exponents as directions were followed, largest first."""

    value: float
    uncertainty: float
    spectrum: np.ndarray


def two_trajectories(step, start, scales, iterations: int, settle: int = 20, distance: float = 1e-5) -> Exponent:
    """Growth of the distance of two neighbours, pulled back to `distance` (in units of `scales`) at each iteration.

    `step(x) -> x` the map on points (n,), from `start`; `scales` (n,) of its unknowns; the first `settle` iterations
    only turn the distance into the direction that grows, `iterations` more are counted.
    **Valid** `distance` far above the map's own error, and far below the size of the attractor.
    """
    x, scales = np.array(start, dtype=float), np.asarray(scales, dtype=float)
    apart = _direction(len(x)) * distance
    growths = np.empty(settle + iterations)
    for k in range(settle + iterations):
        other = step(x + apart * scales)
        x = step(x)
        apart = (other - x) / scales
        size = np.linalg.norm(apart)
        growths[k] = np.log(size / distance)
        apart *= distance / size
    growths = growths[settle:]
    return Exponent(float(growths.mean()), uncertainty(growths), growths.mean(keepdims=True))


def tangent_product(step, start, iterations: int, directions: int = 1, settle: int = 20) -> Exponent:
    """Growth of tangent vectors under the products of the map's derivative, made orthonormal at each iteration (QR).

    `step(x, q) -> (x, dq)`: the map on points (n,), from `start`, and its derivative applied to the columns of q (n,
    directions); `q` and `dq` in units in which lengths are compared.  `settle` iterations are not counted.
    """
    x = np.array(start, dtype=float)
    q = np.linalg.qr(np.column_stack([np.roll(_direction(len(x)), k) for k in range(directions)]))[0]
    growths = np.empty((settle + iterations, directions))
    for k in range(settle + iterations):
        x, moved = step(x, q)
        q, r = np.linalg.qr(moved)
        growths[k] = np.log(np.abs(np.diag(r)))
    growths = growths[settle:]
    spectrum = growths.mean(axis=0)
    return Exponent(float(spectrum[0]), uncertainty(growths[:, 0]), spectrum)


def _direction(n: int) -> np.ndarray:
    """A unit vector that no symmetry of a scene singles out."""
    v = np.cos(1.0 + 2.3 * np.arange(n))
    return v / np.linalg.norm(v)


def uncertainty(series) -> float:
    """Half-width (95 % of cases) of the mean of a correlated series (m,): spread of the means of blocks, the largest
    over several lengths of blocks, in units of the series.  Infinite for fewer than two values a block (m < 16)."""
    series = np.asarray(series, dtype=float)
    found = [0.0]
    for count in EXPONENT_BLOCKS:
        length = len(series) // count
        if length < 2:
            break
        means = series[: count * length].reshape(count, length).mean(axis=1)
        found.append(float(means.std(ddof=1) / np.sqrt(count) * _student(count)))
    return max(found) if len(found) > 1 else float("inf")


def horizon(exponent: float, error: float, scale: float = 1.0) -> float:
    """Iterations after which an error has grown to `scale` (same unit): ln(scale/error)/exponent; infinite if nothing
    grows."""
    return float(np.log(scale / error) / exponent) if exponent > 0 else float("inf")


# --- Order tracking ---------------------------------------------------------------------------------

# One order of a signal followed over a ramp, and spectra in orders against speed: all over the shaft's angle.
#
# A signal sampled evenly in shaft angle has its orders standing still however the speed changes; windows of whole
# turns put every whole order on a line. A Hann window over `turns` turns lets orders nearer than 2/turns into each
# other, and sees everything that happens while the shaft turns through it as one: the speed then changes by rate
# times its duration. **Source** Fyfe and Munck (1997), Mech. Systems and Signal Processing 11(2), order tracking;
# Harris (1978), windows.


def hann(count: int) -> np.ndarray:
    """Hann window (count,) at the middles of its samples, symmetric, its sum one."""
    window = 0.5 - 0.5 * np.cos(2 * np.pi * (np.arange(count) + 0.5) / count)
    return window / window.sum()


def resolution(turns: int) -> float:
    """Resolution (orders) of a window of whole turns."""
    return HANN / turns


def centres(begin: int, end: int, length: int, speed, most: int) -> np.ndarray:
    """First samples (ints) of at most `most` windows of `length` samples inside [begin, end), even in `speed` (m,)
    (rad/s), which is monotonic there; empty if no window fits."""
    firsts = np.arange(begin, end - length + 1)
    if not len(firsts):
        return firsts
    middle = speed[firsts + length // 2]
    if most >= len(firsts) or np.ptp(middle) == 0.0:
        return firsts[np.unique(np.linspace(0, len(firsts) - 1, min(most, len(firsts))).astype(int))]
    rising = 1.0 if middle[-1] > middle[0] else -1.0
    wanted = np.linspace(middle[0], middle[-1], most)
    return firsts[np.unique(np.clip(np.searchsorted(rising * middle, rising * wanted), 0, len(firsts) - 1))]


def tracked(signal, phase_index, per_turn: int, turns: int, order: float, firsts) -> np.ndarray:
    """Complex amplitudes (windows,) of `exp(i order angle)` in windows of whole turns beginning at samples `firsts`.

    `signal` (m,), `per_turn` samples a turn; sample k stands at the angle `2 pi phase_index[k] / per_turn`.
    Of a real signal: amplitude and phase of the cosine, in its unit.
    """
    length = turns * per_turn
    window, twice = hann(length), 2.0 if np.isrealobj(signal) and order != 0.0 else 1.0
    out = np.empty(len(firsts), dtype=complex)
    for n, first in enumerate(firsts):
        part = slice(first, first + length)
        # Whole turns are taken off the angle before it is multiplied: a phase as exact after a thousand turns.
        angle = 2 * np.pi * order * (phase_index[part] - phase_index[first]) / per_turn
        begun = 2 * np.pi * np.mod(order * phase_index[first] / per_turn, 1.0)
        out[n] = twice * np.sum(window * signal[part] * np.exp(-1j * (angle + begun)))
    return out


def waterfall(signal, per_turn: int, turns: int, firsts, low: float, high: float, still: float = 0.0):
    """Amplitudes (windows, orders) of `signal` (m,), real or complex, in windows of whole turns beginning at samples
    `firsts`, two-sided; the orders (n,) within [low, high]; the largest share of power in the top tenth of the band
    (`at_the_edge`)."""
    length = turns * per_turn
    window = hann(length)
    orders = np.fft.fftshift(np.fft.fftfreq(length, 1.0 / per_turn))
    kept, rows, share = (orders >= low) & (orders <= high), [], 0.0
    for first in firsts:
        part = signal[first : first + length]
        lines = np.abs(np.fft.fftshift(np.fft.fft(window * part)))
        share = max(share, at_the_edge(orders, lines, resolution(turns), still))
        rows.append(lines[kept])
    return np.array(rows).reshape(len(firsts), int(kept.sum())), orders[kept], share


# A peak is read from a parabola through what stands above this share of its height.
TOP = 0.98


def peak(speed, amplitude) -> tuple[float, float] | None:
    """Speed and height of the largest of `amplitude` (n,) over `speed` (n,), by the parabola fitted to the top two per
    cent around it (three points at least; from nine points on a fourth-order fit's parabola); None where the largest is
    at an end."""
    speed, amplitude = np.asarray(speed), np.asarray(amplitude)
    k = int(np.argmax(amplitude)) if len(speed) > 2 else 0
    if k in (0, len(speed) - 1):
        return None
    first, last = k - 1, k + 1
    while first > 0 and amplitude[first - 1] > TOP * amplitude[k]:
        first -= 1
    while last < len(speed) - 1 and amplitude[last + 1] > TOP * amplitude[k]:
        last += 1
    # As far to one side as to the other, so that a lopsided top does not pull it.
    reach = max(1, min(k - first, last - k))
    x, y = speed[k - reach : k + reach + 1] - speed[k], amplitude[k - reach : k + reach + 1]
    a, b, c = np.polyfit(x, y, min(4, len(x) - 1) if reach > 3 else 2)[-3:]
    at = -b / (2 * a) if a < 0 else 0.0
    return float(speed[k] + at), float(c + b * at + a * at * at)
