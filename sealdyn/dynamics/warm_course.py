"""Temperature and coning over time, while speed, pressures or the sealed liquid's temperature change: aligned faces,
the film squeezed, the rings with one state of heat in all or, from their drawings, with six each.

    one state:  C rise' = H - (G + density specific_heat Q) rise,  coning by heat = B rise
    six a ring: tau_k theta_k' = R_k q - theta_k,  rise = sum theta_k + R_0 q,  coning = sum X_k/R_k theta_k + X_0 q
    film:       D clearance' = opening force - closing force

q is what enters a ring, the sum of them and what the leakage carries is the heat H; R_0, X_0 follow the heat at once.
**Source** derived; the states of a ring are faces/ring_heat.py's.
**Valid** rings without inertia: changes slower than they move.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.variants import frozen_at
from .warm_state import Warming, WarmState, warming

# Relative accuracy of the integration, and absolute of the rise (K).
ACCURACY, RESOLVED = 1e-6, 1e-5
# Share of the clearance at the start at which the film counts as closed.
CLOSED = 1e-4
# Damping at least, as a share of that at the start: faces pressed flat squeeze nothing out.
LEAST = 1e-6
# Step of the Jacobian's differences, as a share of a state, and the least state (of the clearance at the start, or K).
STEP, SMALLEST = 1e-6, 1e-2
# Corrections of the common temperature at most, and the change (K) that is none.
CORRECTIONS, SAME = 40, 1e-11


@dataclass(frozen=True)
class Course:
    """The `time` (s) of steps and the WarmState of each, the `heat` made in all (J), the share of it by which rings of
    one state store and lose another heat (`residual`, None of six), and when the film closed (s), None if it did
    not."""

    time: list[float]
    states: list[WarmState]
    heat: float
    residual: float | None
    collapsed: float | None


class ThermalStates:
    """The rings' states theta (K): six of each from its drawing where all are, else one, the rise."""

    def __init__(self, found: Warming):
        wholes = [ring.whole for ring in found.rings.values()]
        self.several = all(whole is not None for whole in wholes)
        if not self.several:
            self.storing = np.array([found.capacity])
            return
        self.ring = np.concatenate([np.full(len(whole.resistances), k) for k, whole in enumerate(wholes)])
        self.time = np.concatenate([whole.time_constants for whole in wholes])
        self.resistance = np.concatenate([whole.resistances for whole in wholes])
        self.coning = np.concatenate([whole.conings for whole in wholes]) / self.resistance
        self.immediate = np.array([whole.immediate_resistance for whole in wholes])
        self.immediate_coning = np.array([whole.immediate_coning for whole in wholes])

    def steady(self, found: Warming, rise: float) -> np.ndarray:
        """The states at a rise (K) that stays."""
        if not self.several:
            return np.array([rise])
        through = np.array([rise / ring.resistance for ring in found.rings.values()])
        return self.resistance * through[self.ring]

    def now(self, found: Warming, theta: np.ndarray, clearance: float, rise: float) -> tuple[WarmState, np.ndarray]:
        """The state of the film and the rates of theta (K/s) at a clearance (m), the common temperature looked for from
        a `rise` (K) on."""
        if not self.several:
            now = found.state(float(theta[0]), clearance)
            return now, np.array([found.surplus(now)]) / self.storing
        within = np.bincount(self.ring, theta, len(self.immediate))
        coned, held = float(self.coning @ theta), np.sum(within / self.immediate)
        before = None
        for _ in range(CORRECTIONS):
            coned_by = coned + float(self.immediate_coning @ ((rise - within) / self.immediate))
            now = found.state(rise, clearance, coned_by)
            balanced = (now.power + held) / (np.sum(1.0 / self.immediate) + now.carried)
            tried = rise, float(balanced - rise)
            if abs(tried[1]) < SAME:
                break
            # By secants, once there are two.
            rise = float(balanced) if before is None else _secant(before, tried)
            before = tried
        entering = (rise - within) / self.immediate
        return now, (self.resistance * entering[self.ring] - theta) / self.time


def _secant(before, here) -> float:
    """Where the line through two points (x, f) is zero."""
    (a, f), (b, g) = here, before
    return a - f * (a - b) / (f - g) if f != g else a


def breaks(scene) -> list[float]:
    """Times (s), from 0 on, between which everything that the film's heat and load hang on is linear."""
    film = scene.film
    tables = (scene.shaft.speed, scene.stator.speed, film.outer_pressure, film.inner_pressure, film.temperature,
              film.coning, scene.closing.spring_force)  # fmt: skip
    return sorted({0.0} | {t for table in tables if isinstance(table, PiecewiseLinear) for t in table.time if t > 0.0})


def course(scene, times, start: WarmState, say: Callable[[float], None] = lambda share: None) -> Course:
    """The course from one of the `times` (s, increasing) to the last, between which everything is linear, from a
    `start` in which the rings are settled; `say` is told how much is done.  Method: Radau IIA of SciPy, fifth order."""
    from scipy.integrate import solve_ivp

    whole = warming(scene)
    rings, unit = ThermalStates(whole), start.clearance
    first = whole.under(frozen_at(scene, times[0]))
    # Clearance, states of the rings, heat made and heat that left (J).
    y, kept, collapsed, near = np.array([1.0, *rings.steady(first, start.rise), 0.0, 0.0]), [], None, [start.rise]
    begun, damped = y[1], first.damping(start.rise, unit)

    def here(t):
        return whole.under(frozen_at(scene, float(t)))

    def rates(t, y):
        found, clearance = here(min(max(t, inside[0]), inside[1])), max(float(y[0]), CLOSED) * unit
        now, warming_up = rings.now(found, y[1:-2], clearance, near[0])
        near[0] = now.rise
        damping = max(found.damping(now.rise, clearance, now.coned_by), LEAST * damped)
        squeezed = now.excess / (damping * unit)
        return np.array([squeezed, *warming_up, now.power, (found.conductance + now.carried) * now.rise])

    def jacobian(t, y):
        # SciPy's own widens its steps without end for the two heats, on which nothing hangs.
        found, before = np.zeros((len(y), len(y))), rates(t, y)
        for k in range(len(y) - 2):
            moved = y.copy()
            moved[k] += STEP * max(abs(y[k]), SMALLEST)
            found[:, k] = (rates(t, moved) - before) / (moved[k] - y[k])
        return found

    def closed(t, y):
        return y[0] - CLOSED

    closed.terminal = True
    scale = np.full(len(y), RESOLVED)
    scale[0] = ACCURACY
    for begin, end in pairwise(times):
        # At a step of a table the value is that of the piece.
        inside = np.nextafter(begin, end), np.nextafter(end, begin)
        part = solve_ivp(rates, (begin, end), y, "Radau", rtol=ACCURACY, atol=scale, events=closed, jac=jacobian)
        for t, column in list(zip(part.t, part.y.T, strict=True))[1 if kept else 0 :]:
            clearance = max(float(column[0]), CLOSED) * unit
            found = here(min(max(t, inside[0]), inside[1]))
            kept.append((float(t), rings.now(found, column[1:-2], clearance, start.rise)[0]))
        y = part.y[:, -1]
        say(end / times[-1])
        if part.status != 0:
            collapsed = float(part.t[-1])
            break
    made, left = float(y[-2]), float(y[-1])
    residual = None if rings.several else abs(made - left - whole.capacity * (y[1] - begun)) / max(made, RESOLVED)
    return Course([t for t, _ in kept], [now for _, now in kept], made, residual, collapsed)
