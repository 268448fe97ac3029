"""Reference solution: implicit collocation of high order with its own step control; no run integrates with it.

**Source** Hairer & Wanner (1996), Solving ODEs II, IV.5 and IV.8: collocation at Gauss nodes has order 2 s, at the
right-hand Radau nodes 2 s - 1 and damps what is infinitely stiff.
**Valid** smooth scenes reach rounding; kinks of the right-hand side cost short steps, not accuracy.
"""

import math
from functools import lru_cache

import numpy as np

from .contract import SolverFailure

# Stages; the error estimate is filtered with this multiple of the step, so that what is stiff does not count.
GAUSS, RADAU, FILTER = 6, 5, 0.2
# Steps per fastest period at least: the motion between them is interpolated.
PER_PERIOD, MOST = 48, 4000
ITERATIONS, SLOW, ROUNDING = 14, 0.3, 2e-16
SHORTEST = 1e-12


@lru_cache
def rule(stages: int, radau: bool):
    """Nodes (s,), matrix (s, s) and weights (s,) of the collocation on [0, 1], the error weights (s + 1,) of the
    quadrature through the start and all nodes but the first, the weights (2, s) that carry the nodes on to 0 and 1."""
    if radau:
        # (P_s - P_{s-1}) on [-1, 1]: its roots include the right end.
        shifted = np.polynomial.legendre.Legendre([0.0] * (stages - 1) + [-1.0, 1.0])
        nodes = np.sort(shifted.roots().real)
        nodes[-1] = 1.0
    else:
        nodes = np.polynomial.legendre.leggauss(stages)[0]
    points, weights = np.polynomial.legendre.leggauss(stages)
    c = 0.5 * (1.0 + nodes)

    def integrals(knots, upto):
        """Integrals of the Lagrange polynomials on `knots` from 0 to `upto`."""
        at = 0.5 * upto * (1.0 + points)
        values = [math.prod((at - b) / (a - b) for b in knots if b != a) for a in knots]
        return np.array([0.5 * upto * float(weights @ v) for v in values])

    matrix = np.array([integrals(c, x) for x in c])
    b = integrals(c, 1.0)
    other = integrals(np.concatenate([[0.0], c[1:]]), 1.0)
    error = np.concatenate([[other[0], 0.0], other[1:]]) - np.concatenate([[0.0], b])
    return c, matrix, b, error, _carried(c, np.array([0.0, 1.0]))


def collocation(segment, tau, y, method, tolerance, counts):
    """Steps of a segment from `tau` (s) and the unknowns `y` (size,), with the contract of contract.py; `method`
    "gauss" or "radau_nodes".

    `tolerance` bounds the embedded error estimate, which is of far lower order than the method: the error itself is
    orders smaller.  A massless ring is integrated through its consistent derivatives.
    **Raises** SolverFailure where the step vanishes, and for an undamped massless ring.
    """
    radau = method != "gauss"
    c, a, b, error, ends = rule(RADAU if radau else GAUSS, radau)
    rhs, n = _rates(segment, counts), segment.n_mechanical
    scale, largest = segment.scales[:n], min(segment.shortest_period / PER_PERIOD, segment.longest_step())
    if not segment.imposed_pace and not len(segment.rows):
        # Nothing is imposed: what creeps for many periods need not be followed by each of them.
        largest = max(largest, segment.length / MOST)
    order = len(c) + 1
    h = min(1e-3 * segment.shortest_period / PER_PERIOD, segment.length - tau)
    f, stages, inverse, jac, built = rhs(tau, y), None, None, None, None
    while tau < segment.length:
        h = segment.length - tau if tau + 1.0001 * h >= segment.length else h
        if h < SHORTEST * max(segment.length, 1e-300) and tau + h < segment.length:
            raise SolverFailure(f"collocation gave up {tau:.6g} s into this segment: its step vanished")
        if jac is None:
            jac = _jacobian(rhs, tau, y, f, segment)
            built = None
        if built != h:
            inverse, built = np.linalg.inv(np.eye(n * len(c)) - h * np.kron(a, jac)), h
        guess = np.tile(f, (len(c), 1)) if stages is None else stages
        k = _stages(rhs, tau, h, y, guess, c, a, inverse, n, scale)
        if k is None:
            # A fresh matrix first, then shorter steps.
            h, jac, stages = (h, None, None) if stages is not None else (0.3 * h, None, None)
            continue
        there = y + h * (b @ k)
        f_there = rhs(tau + h, there)
        # Between the ends and their nodes nobody has looked: a kink there shows in the derivatives at the ends.
        before, after = np.stack([f, f_there]) - ends @ k
        embedded = error[0] * f + error[1:] @ k
        estimates = h * np.stack([embedded, 0.5 * c[0] * before, 0.5 * (1.0 - c[-1]) * after])[:, :n].T
        estimates = np.linalg.solve(np.eye(n) - FILTER * h * jac, estimates)
        size = float(np.max(np.abs(estimates) / scale[:, None])) / tolerance
        factor = min(max(0.8 * max(size, 1e-12) ** (-1.0 / order), 0.2), 3.0)
        if size > 1.0:
            h, stages = factor * h, None
            continue
        tau = segment.length if h == segment.length - tau else tau + h
        y, f = there, f_there
        yield np.array([tau]), y[None, :].copy(), f[None, :].copy()
        following = min(largest, factor * h)
        # The same step again keeps the matrix.
        following = h if h <= following < 1.3 * h else following
        stages = _extrapolated(c, k, following / h)
        if counts.steps % 8 == 0 or following != h:
            jac = None
        h = following
        counts.jacobians += jac is None


def _rates(segment, counts):
    """The right-hand side; a massless ring's from its consistent derivatives."""
    if segment.has_residual_form:
        if len(segment.algebraic):
            raise SolverFailure("collocation needs derivatives, and an undamped massless ring has none")

        def consistent(t, y):
            counts.rhs += 1
            return segment.start(t, y)[1]

        return consistent

    def plain(t, y):
        counts.rhs += 1
        yp = np.empty(segment.size)
        segment.rhs(t, y, yp)
        return yp

    return plain


def _jacobian(rhs, t, y, f, segment):
    n = segment.n_mechanical
    jac, moved = np.empty((n, n)), y.copy()
    for j in range(n):
        step = 1e-7 * max(abs(y[j]), segment.scales[j])
        moved[j] = y[j] + step
        jac[:, j] = (rhs(t, moved)[:n] - f[:n]) / step
        moved[j] = y[j]
    return jac


def _stages(rhs, tau, h, y, k, c, a, inverse, n, scale):
    """Derivatives at the nodes (s, size) by simplified Newton; None if it does not converge."""
    k, before = k.copy(), math.inf
    for _ in range(ITERATIONS):
        places = y + h * (a @ k)
        fresh = np.array([rhs(tau + x * h, place) for x, place in zip(c, places, strict=True)])
        if not np.all(np.isfinite(fresh)):
            return None
        # The works feed nothing back: they take the fresh values.
        change = (inverse @ (fresh - k)[:, :n].ravel()).reshape(len(c), n)
        fresh[:, :n] = k[:, :n] + change
        k = fresh
        size = float(np.max(np.abs(h * change) / scale))
        if size < 50 * ROUNDING:
            return k
        if size > SLOW * before:
            # Rounding, or no contraction.
            return k if size < 1e-11 else None
        before = size
    return None


def _extrapolated(c, k, ratio):
    """The last step's derivatives carried on to the nodes of the next, `ratio` times as long."""
    return _carried(c, 1.0 + ratio * c) @ k


def _carried(c, at):
    """Weights (m, s) of values at the nodes for their polynomial at other places."""
    return np.array([[math.prod((x - e) / (d - e) for e in c if e != d) for d in c] for x in at])
