"""Methods for comparison, which no run chooses: what rotordynamics codes and scientific libraries integrate with.

Generators with the contract of solvers/contract.py.  The fixed-step ones take the tolerance as the square of a step
over the fastest period of interest: 1e-4 is a hundred steps a period, and their second-order error follows the
tolerance.
"""

import math
import warnings
from functools import partial

import numpy as np

from .contract import FEW, SolverFailure, failure_message
from .methods import METHODS, cvode, ida, scipy_steps

# Spectral radius of generalised-alpha at infinite frequency: how much it damps what the step does not resolve.
RHO = 0.8
# Steps handed over at once; Newton iterations with one matrix, and matrices tried for one step.
BLOCK, ITERATIONS, MATRICES = 64, 12, 6
# A contraction slower than this asks for a fresh matrix.
SLOW = 0.3
# Of its scale, how far from where the film saw it a displacement may end a step of film and rings in turn.
APART = 0.1
TOO_LONG = "the step may be too long for this film."


def _silent(*given):
    """Steps of SciPy's solvers without their warnings, with which LSODA gives up."""
    steps = scipy_steps(*given)
    while True:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            block = next(steps, None)
        if block is None:
            return
        yield block


# --- fixed steps ------------------------------------------------------------------------------------


def _newmark(segment, tau, y, method, tolerance, counts):
    """Constant average acceleration.

    **Source** Newmark (1959), J. Eng. Mech. 85, beta = 1/4, gamma = 1/2: the trapezoidal rule on displacements and
    rates.  The works are integrated by the same rule.
    """
    system = _System(segment, method, tolerance, counts)
    rate, n = system.rates(tau, y), segment.n_mechanical
    before = rate

    def advance(t, h, y):
        nonlocal rate, before
        base, half = y[:n] + 0.5 * h * rate[:n], 0.5 * h
        guess = y[:n] + h * (1.5 * rate[:n] - 0.5 * before[:n])
        state, last = system.solve(t + h, guess, lambda x, f: x - base - half * f, half)
        y = np.concatenate([state, y[n:] + half * (rate[n:] + last[n:])])
        before, rate = rate, last
        return y

    yield from system.march(tau, y, advance)


def _midpoint(segment, tau, y, method, tolerance, counts):
    """Implicit midpoint rule: symplectic, keeps quadratic invariants (Hairer, Lubich & Wanner, 2006, sec. II.1.1)."""
    system = _System(segment, method, tolerance, counts)
    rate, n = system.rates(tau, y), segment.n_mechanical
    before = rate

    def advance(t, h, y):
        nonlocal rate, before
        here, half = y[:n], 0.5 * h
        guess = here + half * (2.0 * rate[:n] - before[:n])
        middle, last = system.solve(t + half, guess, lambda x, f: x - here - half * f, half)
        y = np.concatenate([2.0 * middle - here, y[n:] + h * last[n:]])
        before, rate = rate, last
        return y

    yield from system.march(tau, y, advance)


def _generalised_alpha(segment, tau, y, method, tolerance, counts):
    """Generalised-alpha with spectral radius RHO.

    **Source** Chung & Hulbert (1993), J. Appl. Mech. 60, 371; forces at the generalised mid-step.  The works by the
    trapezoidal rule, which takes one evaluation more per step.
    """
    system = _System(segment, method, tolerance, counts)
    alpha_m, alpha_f = (2 * RHO - 1) / (RHO + 1), RHO / (RHO + 1)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (0.5 + gamma) ** 2
    n, m, at = segment.n, segment.n_mechanical, segment.rate_places
    rate = system.rates(tau, y)
    a = before = rate[at].copy()
    state = np.empty(m)

    def advance(t, h, y):
        nonlocal rate, a, before
        q, v, present = y[:n], y[at], a
        tied = (1 - alpha_m) * 2.0 * h / (1 - alpha_f)

        def between(acceleration):
            q_next = q + h * v + h * h * ((0.5 - beta) * present + beta * acceleration)
            v_next = v + h * ((1 - gamma) * present + gamma * acceleration)
            return q_next, v_next

        def defect(acceleration, f):
            return (1 - alpha_m) * acceleration + alpha_m * present - f[at]

        def place(acceleration):
            q_next, v_next = between(acceleration)
            state[:n], state[at] = (1 - alpha_f) * q_next + alpha_f * q, (1 - alpha_f) * v_next + alpha_f * v
            return state

        def matrix(full):
            on_q, on_v = full[np.ix_(at, range(n))], full[np.ix_(at, at)]
            return (1 - alpha_m) * np.eye(n) - (1 - alpha_f) * (h * h * beta * on_q + h * gamma * on_v)

        found, _ = system.solve(t + (1 - alpha_f) * h, 2.0 * present - before, defect, tied, place, matrix)
        q_next, v_next = between(found)
        y_next = y.copy()
        y_next[:n], y_next[at] = q_next, v_next
        rate_next = system.rates(t + h, y_next)
        y_next[m:] += 0.5 * h * (rate[m:] + rate_next[m:])
        before, a, rate = a, found, rate_next
        return y_next

    yield from system.march(tau, y, advance)


def _segregated(segment, tau, y, method, tolerance, counts):
    """Conventional serial staggered procedure: film and rings in turn.

    The displacements are predicted with the rates at the step's start, which are held; the film goes on by implicit
    Euler in the gap of these; the rings by the implicit midpoint rule under its force and moments at the step's end.
    **Source** Piperno, Farhat & Larrouturou (1995), Comput. Methods Appl. Mech. Engrg 124, 79, with their predictor's
    alpha_0 = 1, alpha_1 = 0; Felippa, Park & Farhat (2001), ibid. 190, 3247.
    **Valid** first order, so errors follow the root of the tolerance; stiffness and damping of the film are explicit,
    which limits the step: at light rings, and under liquids far below what pays.
    The segment has a `film_step` and `rates_under` a load (dynamics/coupled_segment.py).
    """
    load = np.zeros(3)
    system = _System(segment, method, tolerance, counts, lambda *at: segment.rates_under(load, *at))
    # A hundredth of the local error of a first-order method.
    system.small = 1e-2 * tolerance
    d, m, film = segment.n, segment.n_mechanical, segment.film

    def advance(t, h, y):
        here, ahead, half, before = y[:m], y.copy(), 0.5 * h, segment.settled
        ahead[:d] += h * y[segment.rate_places]
        try:
            load[:] = segment.film_step(t + h, 1.0 / h, ahead, system.small)
        except SolverFailure as failure:
            raise SolverFailure(failure_message(method, f"{failure}; {TOO_LONG}", t)) from None
        counts.rhs += segment.settled - before
        middle, last = system.solve(t + half, 0.5 * (here + ahead[:m]), lambda x, f: x - here - half * f, half)
        end = y + h * last
        end[:m], end[film] = 2.0 * middle - here, ahead[film]
        apart = float(np.max(np.abs(end[:d] - ahead[:d]) / segment.scales[:d]))
        if not apart <= APART:
            words = f"a ring ends a step {apart:.2g} of a clearance from where the film saw it; {TOO_LONG}"
            raise SolverFailure(failure_message(method, words, t))
        # Between steps the film is interpolated.
        system.slope = (end - y) / h
        return end

    yield from system.march(tau, y, advance)


class _QuasiStatic:
    """A segment's rings and works under the quasi-static film: the steady one at any place and speed of the rings,
    squeeze included, which leaves it no unknowns.

    **Valid** where a gas film fills far faster than the rings move (low squeeze number), or a film stores nothing:
    elsewhere its errors end at what storage is worth, however small the tolerance.
    """

    film = slice(0, 0)

    def __init__(self, segment, y):
        self.segment, self.y = segment, y.copy()
        self.own = np.delete(np.arange(segment.size), segment.film)
        self.size, self.n_mechanical = len(self.own), segment.n_mechanical
        self.length, self.longest_step, self.scales = segment.length, segment.longest_step, segment.scales[self.own]

    def whole(self, tau, own):
        """Rates and unknowns (size,) of the segment, those of the film the steady ones; its rates are left 0."""
        y, yp = self.y, np.zeros(self.segment.size)
        y[self.own] = own
        self.segment.quasi_static_rates(tau, y, yp)
        return yp, y.copy()

    def rhs(self, tau, own, own_rates):
        own_rates[:] = self.whole(tau, own)[0][self.own]

    def jacobian(self, tau, own, _, matrix):
        full, y = np.empty((self.segment.size,) * 2), self.y
        y[self.own] = own
        self.segment.jacobian(tau, y, None, full, rhs=self.segment.quasi_static_rates)
        matrix[:] = full[np.ix_(self.own, self.own)]


def _quasi_static(segment, tau, y, method, tolerance, counts):
    """Rings on a quasi-static film, by SciPy's BDF."""
    rings, film = _QuasiStatic(segment, y), segment.film
    for ts, owns, _ in scipy_steps(rings, tau, y[rings.own], method, tolerance, counts):
        rates, end = rings.whole(ts[-1], owns[-1])
        # Between steps the film is interpolated.
        rates[film] = (end[film] - y[film]) / (ts[-1] - tau)
        tau, y = ts[-1], end
        yield ts, end[None, :], rates[None, :]


class _System:
    """One segment for a fixed-step implicit method: steps, evaluations, modified Newton."""

    def __init__(self, segment, method, tolerance, counts, rhs=None):
        self.segment, self.method, self.counts, self.rhs = segment, method, counts, rhs or segment.rhs
        self.jacobian = partial(segment.jacobian, rhs=rhs) if rhs else segment.jacobian
        # The unknowns' rates at the last step, of a method that has those of a film.
        self.slope = None
        self.step = min(segment.shortest_period * math.sqrt(tolerance), segment.longest_step())
        # A hundredth of the local error of a second-order method, above rounding.
        self.small = max(1e-2 * tolerance**1.5, 1e-14)
        self.inverse, self.tied, self.whole = None, None, None

    def rates(self, t, y):
        """The whole right-hand side at unknowns `y`."""
        yp = np.empty(self.segment.size)
        self.rhs(t, y, yp)
        self.counts.rhs += 1
        return yp

    def march(self, start, y, advance):
        """Blocks of equal steps to the segment's end."""
        end = self.segment.length
        count = max(1, math.ceil((end - start) / self.step * (1 - 1e-12)))
        h = (end - start) / count
        block = FEW if self.segment.may_change else BLOCK
        ts, ys, slopes = [], [], []
        for k in range(count):
            y = advance(start + k * h, h, y)
            ts.append(end if k + 1 == count else start + (k + 1) * h)
            ys.append(y)
            slopes.append(self.slope)
            if len(ts) == block or k + 1 == count:
                yield np.array(ts), np.array(ys), None if self.slope is None else np.array(slopes)
                ts, ys, slopes = [], [], []

    def solve(self, t, guess, defect, tied, place=None, matrix=None):
        """Unknowns x with defect(x, f) = 0, where f is the right-hand side at place(x), and that f.

        `tied` is what the matrix I - tied J depends on; the matrix is kept over steps until convergence is slow.
        """
        m, scales = self.segment.n_mechanical, self.segment.scales
        scale = scales[:m] if place is None else scales[self.segment.rate_places] * self.segment.reference_rate
        whole = self.whole = np.zeros(self.segment.size) if self.whole is None else self.whole
        stale = self.inverse is None or self.tied != tied
        for trial in range(MATRICES):
            # Back to the guess once; then Newton goes on with fresh matrices.
            if trial < 2:
                x = guess
            whole[:m] = x if place is None else place(x)
            if stale:
                self._refresh(t, whole, tied, matrix)
            before = math.inf
            for _ in range(ITERATIONS):
                f = self.rates(t, whole)
                change = self.inverse @ defect(x, f[:m] if place is None else f)
                x = x - change
                whole[:m] = x if place is None else place(x)
                size = float(np.max(np.abs(change) / scale))
                if size <= self.small:
                    return x, f
                if not size < before or (size > SLOW * before and size > 1e3 * self.small):
                    break
                if before < math.inf and size * size <= self.small * (before - size):
                    # What the next iterations would still change.
                    return x, f
                before = size
            stale = True
            if not np.all(np.isfinite(x)):
                break
        raise SolverFailure(
            failure_message(self.method, "Newton does not converge at this step: too long for this film.", t)
        )

    def _refresh(self, t, whole, tied, matrix):
        segment, m = self.segment, self.segment.n_mechanical
        full = np.zeros((segment.size, segment.size))
        self.jacobian(t, whole.copy(), None, full)
        self.counts.jacobians += 1
        self.counts.rhs += m + 1
        built = matrix(full) if matrix else np.eye(m) - tied * full[:m, :m]
        self.inverse, self.tied = np.linalg.inv(built), tied


def _without_rates(segment) -> str:
    """Why a segment has no rates, "" where it has them."""
    if not segment.has_residual_form or (np.all(segment.rate_places >= 0) and segment.has_rates):
        return ""
    what = "a massless ring has none" if np.any(segment.lacks_inertia) else "this film's unknowns have none"
    return f"{what}: only the residual form (IDA)"


def _without_mass(segment) -> str:
    """Why a segment's rings have no rates, "" where they have them."""
    return "a massless ring has none" if np.any(segment.lacks_inertia) else ""


def _refusing(lack, steps):
    """A method that says so where a segment has a `lack` of the rates that it needs."""

    def guarded(segment, tau, y, method, tolerance, counts):
        if why := lack(segment):
            raise SolverFailure(f"{method} needs rates, and {why}")
        yield from steps(segment, tau, y, method, tolerance, counts)

    return guarded


# BDF of CVODE held at order two is what an order-limited stiff solver costs; IDA held at order one is the implicit
# Euler rule with an error estimate.
OF_RATES = {
    "bdf2": partial(cvode, max_order=2), "rk45": _silent, "lsoda": _silent, "scipy_bdf": _silent, "newmark": _newmark,
    "generalised_alpha": _generalised_alpha, "midpoint": _midpoint,
}  # fmt: skip
OF_RINGS = {"segregated": _segregated, "quasi_static": _quasi_static}
REFERENCE_METHODS = {
    **METHODS,
    **{name: _refusing(_without_rates, steps) for name, steps in {**METHODS, **OF_RATES}.items()
       if name not in ("ida", "trbdf2")},
    "ida1": partial(ida, max_order=1), "ida2": partial(ida, max_order=2),
    **{name: _refusing(_without_mass, steps) for name, steps in OF_RINGS.items()},
}  # fmt: skip
