"""Temperature and coning over time, while speed, pressures or the sealed liquid's temperature change: aligned faces,
the film squeezed, the rings with one state of heat in all or, from their drawings, with six each.

    D clearance' + D_c coning' = opening - closing force,  heat that enters the rings = H - density specific_heat Q rise

with the rings' states of heated_rings.py: their faces have one rise.
**Source** derived; the states of a ring are faces/ring_heat.py's.
**Valid** rings without inertia: changes slower than they move.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..answers import columns
from ..numerics.piecewise_linear import PiecewiseLinear, initially
from ..scene.film import coned
from ..scene.scene import frozen_at
from .heated_rings import ThermalStates
from .interface import Asked
from .warm_state import Warming, WarmState, unheated, warming

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
# Over so many time constants of the slower ring loads must change for a run to follow its temperature, and so many of
# the slowest state later it stays.
LASTS, SETTLED = 0.05, 8.0
# What a run's tables of coning and viscosity miss of the course at most, as a share of its range; moments of it that
# are looked at in a step.
STRAIGHT, LOOKED_AT = 2e-3, 4


@dataclass(frozen=True)
class Course:
    """The `time` (s) of steps and the WarmState of each, the `heat` made in all (J), the share of it by which, at most
    of any step, what left with liquid and leakage and what the rings hold more is not the heat made by then
    (`residual`), and when the film closed (s), None if it did not."""

    time: list[float]
    states: list[WarmState]
    heat: float
    residual: float
    collapsed: float | None

    def at(self, t: float) -> dict:
        """Rise (K), coning by heat (rad), viscosity (Pa s) and the residual of the whole, at a time (s)."""
        found = columns(self.states, ("rise", "coned_by", "viscosity"))
        rise, coning, viscosity = (float(np.interp(t, self.time, values)) for values in found.values())
        return {"rise": rise, "coning_by_heat": coning, "viscosity": viscosity, "energy_residual": self.residual}


def film_between(
    rings: ThermalStates, found: Warming, theta: np.ndarray, thickness: float, arm: float, least: float
) -> WarmState:
    """The state of the film between rings in states theta (K): `thickness` (m) at an `arm` (m) from the inner radius,
    its cold coning aside, and at least `least` (m) at that radius.  What follows the heat at once may balance at two
    rises: the lower one goes on from before, and secants from below, of heat that grows ever faster, end in it."""
    if not rings.several:
        coned_by = float(rings.coning @ theta)
        return found.state(float(theta[0]), max(thickness - arm * coned_by, least), coned_by)
    beneath, before = rings.beneath(theta), None
    coned, held = float(rings.coning @ theta), rings.immediate @ beneath
    # Where no heat enters.
    rise = float(held / np.sum(rings.immediate))
    for _ in range(CORRECTIONS):
        coned_by = coned + float(rings.immediate_coning @ (rise - beneath))
        now = found.state(rise, max(thickness - arm * coned_by, least), coned_by)
        balanced = (now.power + held) / (np.sum(rings.immediate) + now.carried)
        tried = rise, float(balanced - rise)
        if abs(tried[1]) < SAME:
            break
        # By secants, once there are two.
        rise = float(balanced) if before is None else _secant(before, tried)
        before = tried
    return now


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


def followed(scene) -> Course | None:
    """The course of a scene with `[film.heat]` from its warm start until it is settled, remembered; None where its
    loads do not change for long enough, or where the rings have no time constants."""
    found, times = warming(scene), breaks(scene)
    if found.capacity is None or times[-1] <= LASTS * max(ring.time_constant for ring in found.rings.values()):
        return None
    slowest = float(np.max(ThermalStates(found.rings).time))
    return _followed(Asked(scene), (*times, times[-1] + SETTLED * slowest))


@lru_cache(maxsize=16)
def _followed(asked, times):
    return course(asked.scene, times, warming(asked.scene).working(), each=LOOKED_AT)


def with_course(scene, given, found: Course):
    """A scene as it works at its start (`at_work` of the scene `given`) with coning and viscosity over time."""
    cold = given.film.coning
    cold = [cold.at(t) if isinstance(cold, PiecewiseLinear) else cold for t in found.time]
    rows = np.array([[c + now.coned_by, now.viscosity] for c, now in zip(cold, found.states, strict=True)])
    kept = _corners(np.array(found.time), rows / np.maximum(np.ptp(rows, axis=0), 1e-300))
    coning, viscosity = (
        PiecewiseLinear(tuple(found.time[k] for k in kept), tuple(map(float, values[kept]))) for values in rows.T
    )
    return replace(scene, film=replace(scene.film, coning=coning, viscosity=viscosity))


def _corners(time, rows) -> list[int]:
    """Places of so few points that straight lines between them miss no row (m, n) by more than STRAIGHT."""
    kept, end = [0], len(time) - 1
    while kept[-1] < end:
        first = last = kept[-1]
        while last < end:
            share = ((time[first : last + 2] - time[first]) / (time[last + 1] - time[first]))[:, None]
            line = rows[first] + share * (rows[last + 1] - rows[first])
            if last > first and np.abs(line - rows[first : last + 2]).max() > STRAIGHT:
                break
            last += 1
        kept.append(last)
    return kept


def course(scene, times, start: WarmState, say: Callable[[float], None] = lambda share: None, each: int = 1) -> Course:
    """The course from one of the `times` (s, increasing) to the last, between which everything is linear, from a
    `start` in which the rings are settled; `say` is told how much is done.  Kept are `each` moments of a step.
    Method: Radau IIA of SciPy, fifth order."""
    from scipy.integrate import solve_ivp

    whole, cold = warming(scene), unheated(scene)
    rings, unit = ThermalStates(whole.rings), start.clearance
    first = whole.under(frozen_at(scene, times[0]))
    (damped, turned), kept, collapsed, lacking = first.damping(start.rise, unit), [], None, [0.0]
    # Coning that follows the heat at once turns the faces about where it squeezes nothing: the thickness there is the
    # unknown beside the states of the rings, the heat made and the heat that left (J).
    arm = turned / damped
    y = np.array([1.0 + arm * start.coned_by / unit, *np.full(len(rings.content), start.rise), 0.0, 0.0])

    def here(t):
        return whole.under(frozen_at(scene, float(t)))

    def rates(t, y):
        found, theta = here(min(max(t, inside[0]), inside[1])), y[1:-2]
        now = film_between(rings, found, theta, float(y[0]) * unit, arm, CLOSED * unit)
        carried = now.carried * now.rise
        warming_up = rings.rates(theta, now.rise) if rings.several else [found.surplus(now) / rings.content[0]]
        axial, turning = found.damping(now.rise, now.clearance, now.coned_by)
        by_heat = (turning - arm * axial) * (np.asarray(warming_up) @ rings.coning)
        squeezed = (now.excess - turning * cold_rate - by_heat) / (max(axial, LEAST * damped) * unit)
        return np.array([squeezed, *warming_up, now.power, float(rings.leaving @ theta) + carried])

    def jacobian(t, y):
        # SciPy's own widens its steps without end for the two heats, on which nothing hangs.
        found, before = np.zeros((len(y), len(y))), rates(t, y)
        for k in range(len(y) - 2):
            moved = y.copy()
            moved[k] += STEP * max(abs(y[k]), SMALLEST)
            found[:, k] = (rates(t, moved) - before) / (moved[k] - y[k])
        return found

    def closed(t, y):
        return y[0] - arm * float(rings.coning @ y[1:-2]) / unit - CLOSED

    closed.terminal = True
    scale = np.full(len(y), RESOLVED)
    scale[0] = ACCURACY
    for begin, end in pairwise(times):
        # At a step of a table the value is that of the piece.
        inside = np.nextafter(begin, end), np.nextafter(end, begin)
        # Coning that is not by heat turns at one rate: by a table, by pressures or the sealed temperature.
        at_first, at_last = (initially(coned(frozen_at(cold, t)).coning) for t in inside)
        cold_rate = (at_last - at_first) / (end - begin)
        part = solve_ivp(
            rates, (begin, end), y, "Radau", rtol=ACCURACY, atol=scale, events=closed, jac=jacobian,
            dense_output=each > 1,
        )  # fmt: skip
        moments, columns = part.t, part.y
        if each > 1:
            moments = np.interp(np.arange(each * (len(part.t) - 1) + 1) / each, np.arange(len(part.t)), part.t)
            columns = part.sol(moments)
        for t, column in list(zip(moments, columns.T, strict=True))[1 if kept else 0 :]:
            found, theta = here(min(max(t, inside[0]), inside[1])), column[1:-2]
            lacking.append(abs(column[-2] - column[-1] - float(rings.content @ (theta - start.rise))))
            thickness = float(column[0]) * unit
            kept.append((float(t), film_between(rings, found, theta, thickness, arm, CLOSED * unit)))
        y = part.y[:, -1]
        say(end / times[-1])
        if part.status != 0:
            collapsed = float(part.t[-1])
            break
    made = float(y[-2])
    return Course([t for t, _ in kept], [now for _, now in kept], made, max(lacking) / max(made, RESOLVED), collapsed)
