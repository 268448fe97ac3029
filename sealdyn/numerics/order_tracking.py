"""One order of a signal followed over a ramp, and spectra in orders against speed: all over the shaft's angle.

A signal sampled evenly in shaft angle has its orders standing still however the speed changes; windows of whole turns
put every whole order on a line.  A Hann window over `turns` turns lets orders nearer than 2/turns into each other, and
sees everything that happens while the shaft turns through it as one: the speed then changes by rate times its duration.
**Source** Fyfe and Munck (1997), Mech. Systems and Signal Processing 11(2), order tracking; Harris (1978), windows.
"""

import numpy as np

# Equivalent noise bandwidth of the Hann window, in bins: what `resolution` means.
HANN = 1.5
# Share of the power in the top tenth of the band above which a spectrum may be folded.
FOLDED = 1e-4


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


def at_the_edge(orders, amplitude, near: float, still: float = 0.0) -> float:
    """Share of the power in the top tenth of the sampled band, of all orders farther than 2 `near` from zero: a
    response that has not died out there is folded.  `orders`, `amplitude` (n,); 0 if all that moves stays below `still`
    (unit of the amplitude)."""
    power = np.where(np.abs(orders) > 2 * near, amplitude**2, 0.0)
    total = power.sum()
    edge = power[np.abs(orders) > 0.9 * np.abs(orders).max()].sum()
    return float(edge / total) if total > still**2 else 0.0


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
