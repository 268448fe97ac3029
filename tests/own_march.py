"""A run of equations in the tests' own words from its start to its end, with what a run's summary tells of it: means
and largest values over time, the thinnest film.  Nothing of the program."""

import math
import time
from dataclasses import dataclass

import numpy as np
from own_face import DRAG, FLOW, FORCE, MOMENT_X, MOMENT_Y, PRESS, RUB
from scipy.integrate import DOP853, Radau
from scipy.optimize import minimize_scalar

# Points of a step at which loads are looked at, and their weights.
NODES, WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(3))


@dataclass
class Seen:
    """Times (m,) (s), displacements and rates (m, 2 n) (SI), loads (m, 9) in the order of own_face.py; and over the
    run: `sums`, integrals over time of contact force (N s), friction power (J) and its part by contact (J), flow
    outwards (m^3); `most`, the largest contact force (N), friction power (W) and flow (m^3/s); the thinnest film
    `h_min` (m).  Of a run that ended early up to there."""

    times: np.ndarray
    states: np.ndarray
    loads: np.ndarray
    sums: np.ndarray
    most: np.ndarray
    h_min: float


def thinnest(seal, t, y):
    """Thinnest film (m)."""
    return seal.h_min(t, y) if hasattr(seal, "h_min") else seal.thinnest(t, y)


def told(seal, t, y, piece):
    """Loads at a time, and what is summed of them."""
    now = seal._at(t, piece)
    loads = seal._loads(now, seal._gap(seal._motion(t, y, now)[1]), y[2 * seal.n :])
    spin = now["spin_r"] - now["spin_s"]
    return loads, np.array([loads[PRESS], (loads[DRAG] + loads[RUB]) * spin, loads[RUB] * spin, loads[FLOW]])


def march(seal, y0, times, tolerance, kind=Radau, deadline=math.inf, whole=True):
    """`Seen` at increasing `times` (s) by a solver class of SciPy from displacements and rates y0 (2 n,); `whole`: with
    the sums over the run.  Raises TimeoutError after `deadline` (s, of time.process_time)."""
    scale, n = seal.scale(), seal.n
    u, sums, best = seal.begun(np.array(y0)) / scale, np.zeros(4), np.full(4, -math.inf)
    states, loads, wanted = [], [], np.asarray(times, dtype=float)
    for piece, (begin, end) in enumerate(zip(seal.edges, seal.edges[1:], strict=False)):

        def rates(t, u, piece=piece):
            return seal.rates(t, u * scale, piece) / scale

        def jacobian(t, u, piece=piece):
            return seal.jacobian(t, u * scale, piece) * scale / scale[:, None]

        options = {"jac": jacobian} if kind is Radau and seal.gas else {}
        solver = kind(rates, begin, u, end, rtol=max(tolerance, 1e-13), atol=0.01 * tolerance, **options)
        at = begin
        while solver.status == "running":
            solver.step()
            if time.process_time() > deadline:
                raise TimeoutError
            if solver.status == "failed":
                return Seen(wanted[: len(states)], np.array(states), np.array(loads), sums, best[:3], -best[3])
            between, width = solver.dense_output(), solver.t - at
            if whole:
                for node, weight in zip(NODES, WEIGHTS, strict=True):
                    t = at + width * (0.5 + node)
                    y = between(t) * scale
                    found = told(seal, t, y, piece)[1]
                    sums += width * weight * found
                    seen = np.array([found[0], found[1], abs(found[3]), -thinnest(seal, t, y)])
                    best = best_of(seal, between, piece, at, solver.t, scale, best, seen)
            last = piece + 2 == len(seal.edges) and solver.status == "finished"
            for t in wanted[(wanted >= at) & ((wanted < solver.t) | (last and wanted <= solver.t * (1 + 1e-12)))]:
                y = between(t) * scale if width else solver.y * scale
                states.append(y[: 2 * n])
                loads.append(told(seal, t, y, piece)[0])
            at = solver.t
        u = solver.y
    return Seen(wanted[: len(states)], np.array(states), np.array(loads), sums, best[:3], -best[3])


def best_of(seal, between, piece, begin, end, scale, best, seen):
    """Largest contact force, friction power, flow and least film (negative) so far, (4,), after a step in which this is
    `seen` of them: a new one is sought within the step."""
    best = best.copy()
    for k in np.flatnonzero(seen > best):

        def value(t, k=k):
            y = between(t) * scale
            if k == 3:
                return thinnest(seal, t, y)
            return -abs(told(seal, t, y, piece)[1][(0, 1, 3)[k]])

        found = minimize_scalar(value, bounds=(begin, end), method="bounded", options={"xatol": 1e-3 * (end - begin)})
        best[k] = max(seen[k], -found.fun)
    return best


def columns(seal, seen):
    """Displacements over their lengths, rates over these times the reference rate, film force (N), moments (N m),
    flow outwards (m^3/s), torque (N m): (m, 2 n + 5), as the certificate has them."""
    states, loads = seen.states, seen.loads
    return np.column_stack(
        [states[:, : seal.n] / seal.lengths, states[:, seal.n :] / (seal.lengths * seal.rate),
         loads[:, [FORCE, MOMENT_X, MOMENT_Y, FLOW]], loads[:, DRAG] + loads[:, RUB]]
    )  # fmt: skip


__all__ = ["DOP853", "Radau", "Seen", "columns", "march", "thinnest", "told"]
