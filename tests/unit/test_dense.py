"""Interpolation between accepted steps: its order, what it reproduces exactly, and uneven steps."""

import numpy as np
import pytest
from scipy.interpolate import KroghInterpolator
from sksundae.cvode import CVODE

from sealdyn.numerics.hermite import LONGEST, NODES, fit, sample, sample_doubtful, window


def sampled(t, motion, times, begin=0, end=None):
    """Displacements and rates (m, n) at `times` from the steps `t` of `motion(t) -> (q, q_rate)`."""
    q, rate = (np.ascontiguousarray(np.stack(part, axis=1)) for part in motion(t))
    out, out_rate = np.empty((len(times), q.shape[1])), np.empty((len(times), q.shape[1]))
    sample(t, q, rate, len(t), begin, len(t) - 1 if end is None else end, np.asarray(times), out, out_rate)
    return out, out_rate


def sines(t):
    """Two unknowns, so that one's table may not spoil the other's."""
    return (np.sin(t), 3 * np.cos(0.8 * t + 1)), (np.cos(t), -2.4 * np.sin(0.8 * t + 1))


def error(t, motion, times, **window):
    found = sampled(t, motion, times, **window)
    exact = [np.stack(part, axis=1) for part in motion(times)]
    return [np.max(np.abs(a - b)) for a, b in zip(found, exact, strict=True)]


def test_order_on_sines():
    """Six steps carry twelve conditions: displacement of order 12, rate of order 11, by regression."""
    steps, errors = np.array([0.6, 0.75, 0.9, 1.1, 1.35, 1.6]), []
    for step in steps:
        t = step * np.arange(40)
        errors.append(error(t, sines, np.linspace(t[8], t[-9], 3001)))
    for part, order in enumerate((12, 11)):
        slope = np.polyfit(np.log(steps), np.log(np.array(errors)[:, part]), 1)[0]
        assert slope == pytest.approx(order, abs=0.3)
    # At a sixth of a radian, a usual step, rounding is all that is left.
    t = np.arange(40) / 6
    assert max(error(t, sines, np.linspace(t[0], t[-1], 3001))) < 2e-13


@pytest.mark.core
@pytest.mark.parametrize("degree", range(12))
def test_polynomials_up_to_degree_eleven_are_exact(degree):
    draw = np.random.default_rng(degree)
    t = np.cumsum(draw.uniform(0.6, 1.5, 14))
    t = (t - t[0]) / (t[-1] - t[0]) * 2 - 1
    # A motion that the steps resolve: its terms shrink.
    poly = np.polynomial.Chebyshev(draw.normal(size=degree + 1) * 0.6 ** np.arange(degree + 1))
    times = np.linspace(t[0], t[-1], 501)
    # All intervals, those at the ends with all their neighbours on one side too.
    assert max(error(t, lambda x: ((poly(x),), (poly.deriv()(x),)), times)) < 2e-10


def test_steps_are_met_exactly_and_the_rate_is_the_slope():
    t = np.cumsum(np.random.default_rng(3).uniform(0.1, 0.3, 30))
    found, rate = sampled(t, sines, t)
    (q, p), (q_rate, p_rate) = sines(t)
    assert np.allclose(found, np.stack([q, p], axis=1), atol=1e-15)
    assert np.allclose(rate, np.stack([q_rate, p_rate], axis=1), atol=1e-13)
    step, times = 1e-5, np.linspace(t[3], t[-3], 200)
    late, early = sampled(t, sines, times + step)[0], sampled(t, sines, times - step)[0]
    assert np.allclose(sampled(t, sines, times)[1], (late - early) / (2 * step), atol=1e-9)


def test_much_shorter_or_longer_neighbours_are_left_out():
    t = np.array([0.0, 1.0, 2.0, 2.1, 2.2, 2.3, 3.3, 4.3])
    # The long interval before the short ones keeps to the left, the short ones to themselves.
    assert window(t, 1, len(t), LONGEST) == (0, 3)
    assert window(t, 4, len(t), LONGEST) == (2, 6)
    table, nodes = np.zeros((2 * NODES, 1)), np.zeros(2 * NODES)
    q = np.zeros((len(t), 1))
    assert fit(t, q, q, 4, len(t), table, nodes) == 8


def test_a_short_last_step_does_not_take_doubtful_rates():
    """Values good to 1e-12, rates to 1e-2 as a stiff scene's: a step cut to a fifth has no neighbour of its own size,
    and is told by the values all the same (by its own two alone the rates would seem as good: error 2e-4)."""
    t = np.append(np.arange(20.0), 19.2)
    q, wrong = np.sin(0.1 * t)[:, None], 0.1 * np.cos(0.1 * t)[:, None] + 1e-2 * (-1.0) ** np.arange(21)[:, None]
    times = np.linspace(19.0, 19.2, 41)
    out = np.empty((41, 1))
    sample_doubtful(t, q, wrong, len(t), 0, len(t) - 1, times, out)
    assert np.max(np.abs(out[:, 0] - np.sin(0.1 * times))) < 1e-6


def test_uneven_steps_do_not_blow_up_noise():
    """Step lengths over two decades at random, displacements that are noise alone: they come out up to 3.6 times as
    large; six steps without leaving any out (SciPy's Krogh form) blow them up 2e6 times."""
    worst = every = 0.0
    for seed in range(60):
        draw = np.random.default_rng(seed)
        t = np.concatenate([[0.0], np.cumsum(0.02 * 10 ** draw.uniform(-1, 1, 400))])
        noise = draw.uniform(-1, 1, (len(t), 1))
        times = np.sort(draw.uniform(t[0], t[-1], 8000))
        out, out_rate = np.empty((8000, 1)), np.empty((8000, 1))
        sample(t, noise, np.zeros_like(noise), len(t), 0, len(t) - 1, times, out, out_rate)
        worst = max(worst, np.max(np.abs(out)))
        for k in range(2, 12):
            six, start, span = slice(k - 2, k + 4), t[k], t[k + 1] - t[k]
            conditions = np.zeros(2 * NODES)
            conditions[::2] = noise[six, 0]
            through = KroghInterpolator(np.repeat((t[six] - start) / span, 2), conditions)
            every = max(every, np.max(np.abs(through(np.linspace(0.1, 0.9, 5)))))
    assert worst < 5.0 < 1e6 < every


def restarted(seed):
    """CVODE's Adams on two oscillators, started again every few periods: steps, and the exact motion."""
    draw = np.random.default_rng(seed)
    faster, tolerance = draw.uniform(1.5, 4.0), 10 ** draw.uniform(-9, -3)

    def rhs(t, y, yp):
        yp[:] = y[2], y[3], -y[0], -(faster**2) * y[1]

    def motion(t):
        return (np.cos(t), np.cos(faster * t)), (-np.sin(t), -faster * np.sin(faster * t))

    t, y = np.zeros(1), np.array([[1.0, 1.0, 0.0, 0.0]])
    while t[-1] < 60:
        stretch = np.array([t[-1], t[-1] + draw.uniform(10, 20)])
        found = CVODE(rhs, method="Adams", rtol=tolerance, atol=tolerance).solve(stretch, y[-1].copy())
        t, y = np.concatenate([t, found.t[1:]]), np.vstack([y, found.y[1:]])
    return t, y, motion


def test_errors_of_the_steps_after_a_start_are_not_magnified():
    """A solver starts with short steps, and the errors of its long ones beside them must not be magnified: whatever
    lies between steps errs hardly more than the steps around do (without the last rule of numerics/hermite.py up to
    16 times)."""
    worst = []
    for seed in range(40):
        t, y, motion = restarted(seed)
        at = np.sort(np.concatenate([t[:-1] + part * np.diff(t) for part in (0.2, 0.5, 0.8)]))
        out, rate = np.empty((len(at), 2)), np.empty((len(at), 2))
        sample(t, np.ascontiguousarray(y[:, :2]), np.ascontiguousarray(y[:, 2:]), len(t), 0, len(t) - 1, at, out, rate)
        steps = np.max(np.abs(y[:, :2] - np.stack(motion(t)[0], axis=1)), axis=1)
        around = np.array([steps[max(0, k - 4) : k + 4].max() for k in np.searchsorted(t, at)])
        worst.append(np.max(np.max(np.abs(out - np.stack(motion(at)[0], axis=1)), axis=1) / around))
    assert max(worst) < 1.5


def test_terms_that_vanish_by_chance_end_nothing():
    """A fast tone on a slow one: where the second and third differences of both cancel, the next ones are larger and
    still belong to the motion.  An interpolant that stopped there would err 800 000 times as much."""

    def motion(t):
        return (np.sin(0.003 * t) + 5e-6 * np.sin(t),), (0.003 * np.cos(0.003 * t) + 5e-6 * np.cos(t),)

    t = 0.7 * np.arange(8000)
    assert error(t, motion, np.linspace(t[9], t[-9], 60_000))[0] < 1e-13


def test_only_the_asked_steps_are_walked():
    """Sampling in the middle of a record gives what sampling the whole record gives."""
    t = np.cumsum(np.random.default_rng(1).uniform(0.1, 0.4, 40))
    times = np.linspace(t[10], t[20], 77)
    part, whole = sampled(t, sines, times, begin=10, end=20), sampled(t, sines, times)
    assert np.array_equal(part[0], whole[0]) and np.array_equal(part[1], whole[1])
