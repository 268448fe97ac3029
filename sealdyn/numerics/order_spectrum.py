"""Spectra in orders of a turn: amplitudes over a turn's multiples, their peaks, and what lies between the lines."""

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
