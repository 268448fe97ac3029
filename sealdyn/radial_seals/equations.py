"""Equations of motion of followers on a shaft that runs out, in the solver's inner loop; and when they leave the shaft,
land on it, stop on their flange and slip again, found between the solver's steps.

Follower j moves along its own radius by u_j (outward, zero on the concentric shaft).  It is free, held on its flange
by dry friction, or rides on the shaft: then it moves as the surface under it, and the load on the shaft

    N_j = m s'' + d s' + (K u)_j + P + F sign(s')

must not pull.  Free it moves by  m u'' = -(K u)_j - d u' - P - F sign(u').

Unknowns `y`: n displacements, n rates, the works (of the shaft on those that ride, of damping, of friction), and the
sum of their absolute values.  Parameters `p`: HEAD numbers, the angle and the mode of each follower and the sign of its
sliding, the first row of the stiffness matrix, then the waves of the shaft, WAVE numbers each: `order, amplitude, a0,
a1, a2` with the phase a0 + a1 tau + a2 tau^2.
"""

import math
from typing import Any

import numpy as np
from numba import carray
from scipy.optimize import minimize_scalar

from ..dynamics.native import BLOCK, PARAMETERS, RATES, array
from ..numerics.kernel import c_function, floats, inner_kernel, integers, outer_kernel
from ..solvers.contract import Change, Transition

COUNT, MASS, DAMPING, PRELOAD, FRICTION, OFFSET, OFFSET_DIRECTION, WAVES, HEAD = range(9)
WAVE = 5
FREE, HELD, RIDING = 0.0, 1.0, 2.0
# The works; after them the sum of absolute works.
SHAFT_WORK, DAMPING_WORK, FRICTION_WORK, WORKS = range(4)


def unknowns(count: int) -> int:
    """Number of unknowns of so many followers."""
    return 2 * count + WORKS + 1


@inner_kernel()
def surface(tau, theta, p, out):
    """The shaft's surface at the angle `theta` (rad) of the housing and segment time `tau` (s): how far (m) it stands
    out, its rate (m/s) and acceleration (m/s^2), into `out` (3,)."""
    n = int(p[COUNT])
    out[0], out[1], out[2] = p[OFFSET] * math.cos(theta - p[OFFSET_DIRECTION]), 0.0, 0.0
    for k in range(int(p[WAVES])):
        at = HEAD + 4 * n + WAVE * k
        phase = p[at] * theta - (p[at + 2] + tau * (p[at + 3] + tau * p[at + 4]))
        w = p[at + 3] + 2.0 * tau * p[at + 4]
        cos, sin = p[at + 1] * math.cos(phase), p[at + 1] * math.sin(phase)
        out[0] += cos
        out[1] += sin * w
        out[2] += 2.0 * p[at + 4] * sin - w * w * cos


@inner_kernel()
def spring(y, p, j):
    """Force (N) of the springs on follower j, inward."""
    n = int(p[COUNT])
    force = 0.0
    for k in range(n):
        force += p[HEAD + 3 * n + (j - k) % n] * y[k]
    return force


@outer_kernel()
def rates(tau, y, p, yp):
    """The right-hand side `yp` at segment time `tau` (s) and unknowns `y`."""
    n, here = int(p[COUNT]), np.zeros(3)
    works = 2 * n
    for i in range(WORKS + 1):
        yp[works + i] = 0.0
    for j in range(n):
        mode, sign, v = p[HEAD + n + j], p[HEAD + 2 * n + j], y[n + j]
        if mode == RIDING:
            surface(tau, p[HEAD + j], p, here)
            yp[j], yp[n + j], v = here[1], here[2], here[1]
            slides = np.sign(v)
            load = p[MASS] * here[2] + p[DAMPING] * v + spring(y, p, j) + p[PRELOAD] + p[FRICTION] * slides
            yp[works + SHAFT_WORK] += load * v
            yp[works + WORKS] += abs(load * v)
        elif mode == HELD:
            yp[j], yp[n + j], v, slides = 0.0, 0.0, 0.0, 0.0
        else:
            slides = sign
            force = spring(y, p, j) + p[DAMPING] * v + p[PRELOAD] + p[FRICTION] * slides
            yp[j], yp[n + j] = v, -force / p[MASS]
        damped, rubbed = p[DAMPING] * v * v, p[FRICTION] * slides * v
        yp[works + DAMPING_WORK] -= damped
        yp[works + FRICTION_WORK] -= rubbed
        yp[works + WORKS] += damped + abs(rubbed)


@c_function(RATES)
def rates_at(tau, y_at, yp_at, data):
    """The right-hand side for C (dynamics/native.py)."""
    block = carray(integers(data), BLOCK)
    size = block[0]
    rates(tau, carray(floats(y_at), size), array(block, PARAMETERS), carray(floats(yp_at), size))
    return 0


@outer_kernel()
def rates_along(taus, ys, p, out):
    """Derivatives `out` (m, size) at times `taus` (m,) (s) and unknowns `ys` (m, size)."""
    for i in range(len(taus)):
        rates(taus[i], ys[i], p, out[i])


@outer_kernel()
def energies_along(ys, p, out):
    """Energy (J) `out` (m,) of motion, springs and preload at unknowns `ys` (m, size)."""
    n = int(p[COUNT])
    for i in range(len(ys)):
        y, found = ys[i], 0.0
        for j in range(n):
            found += 0.5 * p[MASS] * y[n + j] ** 2 + y[j] * (0.5 * spring(y, p, j) + p[PRELOAD])
        out[i] = found


@outer_kernel()
def state_along(taus, us, vs, p, gaps, gap_rates, loads):
    """At times `taus` (m,) (s), displacements `us` and rates `vs` (m, n): the gaps to the shaft (m), their rates (m/s),
    and the loads (N): of those that ride on the shaft, of the others what the flange must hold (signed, outward where
    the springs pull outward), all (m, n)."""
    n, here = int(p[COUNT]), np.zeros(3)
    for i in range(len(taus)):
        for j in range(n):
            surface(taus[i], p[HEAD + j], p, here)
            pressed = spring(us[i], p, j) + p[PRELOAD]
            gaps[i, j], gap_rates[i, j] = us[i, j] - here[0], vs[i, j] - here[1]
            if p[HEAD + n + j] == RIDING:
                gaps[i, j], gap_rates[i, j] = 0.0, 0.0
                slides = np.sign(here[1])
                loads[i, j] = p[MASS] * here[2] + p[DAMPING] * here[1] + pressed + p[FRICTION] * slides
            else:
                loads[i, j] = -pressed


@outer_kernel()
def surface_at(tau, p, out):
    """The shaft's surface under every follower at segment time `tau` (s), into `out` (n, 3) as `surface`."""
    for j in range(int(p[COUNT])):
        surface(tau, p[HEAD + j], p, out[j])


# Places within each step at which is looked.
LOOKS = 8
# What counts as nothing: of distances and speeds a share of their error, of loads of their size.
OF_ERROR, OF_LOAD = 0.01, 1e-11
# From a place to the next to rounding.
HALVINGS = 48
# Share of a step by which a contact is moved to where it is.
NEWTON = 0.01
# Share of a segment's length in which nothing is integrated.
CRUMB = 1e-12
EVENTS = {"lift": "leaves the shaft", "land": "lands on the shaft", "stick": "is held by its flange",
          "slip": "slips on its flange", "turn": "turns on its flange"}  # fmt: skip


class Contacts:
    """Modes and signs of sliding of all followers (`modes`, `signs` (n,)); finds and makes their changes.  `counts` of
    each kind of EVENTS, `dropped` the kinetic energy (J) lost at landings, `first_lift` (s) or None."""

    def __init__(self, model):
        n = model.followers.count
        self.model = model
        self.segment: Any = None
        self.modes, self.signs = np.full(n, RIDING), np.zeros(n)
        self.counts, self.dropped, self.first_lift = dict.fromkeys(EVENTS, 0), 0.0, None
        followers = model.followers
        self.near = OF_ERROR * model.accuracy * model.length
        self.slow = self.near * model.reference_rate
        self.weak = OF_LOAD * (followers.preload + followers.friction + followers.row[0] * model.length)

    # --- what solve asks ----------------------------------------------------------------------------

    def start(self, segment, tau: float, y) -> dict:
        """Modes at the very start: who rides pulls nowhere."""
        self.begin(segment, tau, y)
        here = segment.surface(tau)
        _, _, loads = self._state(np.array([tau]), y)
        for j in range(len(self.modes)):
            if self.modes[j] == RIDING and loads[0, j] < -self.weak:
                self._let_go(j, y, here[j])
                self.counts["lift"], self.first_lift = self.counts["lift"] + 1, segment.time + tau
        return self.held()

    def begin(self, segment, tau, y):
        """A segment begins."""
        self.segment = segment

    def held(self) -> dict:
        """The modes, as a segment takes them."""
        return {"modes": self.modes.copy(), "signs": self.signs.copy()}

    def state(self) -> dict:
        """What a continued run needs."""
        return {"modes": self.modes.tolist(), "signs": self.signs.tolist(), "counts": self.counts,
                "dropped": self.dropped, "first_lift": self.first_lift}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.modes, self.signs = np.array(state["modes"]), np.array(state["signs"])
        self.counts, self.dropped, self.first_lift = dict(state["counts"]), state["dropped"], state["first_lift"]

    def accept(self, block, advance) -> Transition | None:
        """The first change in a block of steps.  `advance(tau, y, until)`: unknowns at `until` (s)."""
        # Worked out once for all steps.
        _ = block.accelerations
        for step in range(block.begin, block.end):
            found = self._in_step(block, step)
            # What happens at the end belongs to what comes next.
            if found and self.segment.length - found[0] > CRUMB * self.segment.length:
                time, j, touches = found
                y = advance(block.t[step], block.ys[step], time)
                if touches:
                    time, y = self._at_contact(block, step, time, y, j, advance)
                return Transition(step, float(time), y, (j, touches))
        return None

    def _at_contact(self, block, step, time, y, j, advance):
        """Time and unknowns where follower j meets the shaft, which between the steps was found at `time` (s), with the
        unknowns `y` there: a step of Newton's.  Where one grazes the other the time hangs on the last digits."""
        here, low = self.segment.surface(time)[j], block.t[step]
        gap, closing = y[j] - here[0], here[1] - y[self.segment.n + j]
        if closing <= 0.0 or abs(gap) > NEWTON * (block.t[step + 1] - low) * closing or time + gap / closing <= low:
            return time, y
        time += gap / closing
        return time, advance(low, block.ys[step], time)

    def make(self, transition: Transition) -> Change:
        """Let the follower of `transition.what` (which, whether at the shaft) do what its guards ask."""
        what: Any = transition.what
        (j, touches), tau, y = what, transition.time, transition.y.copy()
        here, n = self.segment.surface(tau)[j], len(self.modes)
        mode, v = self.modes[j], y[n + j]
        lost = 0.0
        if mode == RIDING:
            kind = self._let_go(j, y, here)
        elif touches:
            kind, lost = "land", 0.5 * self.model.followers.mass * (v - here[1]) ** 2
            y[j], y[n + j] = here[0], here[1]
            self.modes[j], self.signs[j] = RIDING, 0.0
        elif mode == HELD:
            kind = "slip"
            self.modes[j], self.signs[j] = FREE, np.sign(-self._pull(j, y))
        else:
            kind = self._stop(j, y)
        self.counts[kind] += 1
        self.dropped += lost
        if kind == "lift" and self.first_lift is None:
            self.first_lift = self.segment.time + tau
        text = f"follower {j + 1} {EVENTS[kind]}"
        return Change(y, self.held(), {"kind": kind, "value": float(lost if kind == "land" else v), "text": text})

    # --- what a follower does -----------------------------------------------------------------------

    def _let_go(self, j, y, here) -> str:
        """Follower j leaves the shaft with the shaft's own motion; where that stands, friction may hold it."""
        y[j], y[len(self.modes) + j] = here[0], here[1]
        if abs(here[1]) > self.slow:
            self.modes[j], self.signs[j] = FREE, np.sign(here[1])
        else:
            self._stop(j, y)
        return "lift"

    def _stop(self, j, y) -> str:
        """Follower j, at rest: held, or turned to where it is pulled."""
        pull, n = self._pull(j, y), len(self.modes)
        y[n + j] = 0.0
        if abs(pull) <= self.model.followers.friction:
            self.modes[j], self.signs[j] = HELD, 0.0
            return "stick"
        self.modes[j], self.signs[j] = FREE, -np.sign(pull)
        return "turn"

    def _pull(self, j, y) -> float:
        """Inward force (N) of springs and preload on follower j."""
        found = self.model.followers
        n = found.count
        return float(found.row[(j - np.arange(n)) % n] @ y[:n] + found.preload)

    # --- where it happens ---------------------------------------------------------------------------

    def _state(self, taus, y):
        n = self.segment.n
        us, vs = (np.repeat(part[None, :], len(taus), axis=0) for part in (y[:n], y[n : 2 * n]))
        return self.segment.state(taus, us, vs)

    def guards(self, block, taus):
        """What must not fall below zero at `taus` (m,) (s) inside a block's new steps, two each (m, n): the distance
        from the shaft of those that are not on it (m); the load of those that ride, what friction has left of those
        that are held (N), and the speed of the free ones in the direction of their sliding where there is friction
        (m/s)."""
        us, vs = block.at(taus)
        gaps, _, loads = self.segment.state(taus, us, vs)
        friction, modes = self.model.followers.friction, self.modes
        sliding = vs * self.signs if friction else np.full_like(vs, np.inf)
        second = np.where(modes == RIDING, loads, np.where(modes == HELD, friction - np.abs(loads), sliding))
        return np.where(modes == RIDING, np.inf, gaps), second

    def _in_step(self, block, step):
        """Time and follower of the first change within a step, and whether it meets the shaft; or None."""
        taus = np.linspace(block.t[step], block.t[step + 1], LOOKS + 1)
        block = block.only(step)
        allowed = np.full(len(self.modes), self.near), np.where(self.modes == FREE, self.slow, self.weak)
        first = None
        for which, values in enumerate(self.guards(block, taus)):
            least = -allowed[which]
            dips = _dips(values)
            for j in np.flatnonzero((values[1:] < least).any(axis=0) | dips.any(axis=0)):

                def guard(tau, which=which, j=j):
                    return self.guards(block, np.array([tau]))[which][0, j]

                found = _first_below(guard, taus, values[:, j], dips[:, j], least[j])
                if found is not None:
                    # No interval without a length.
                    found = max(found, taus[0] + CRUMB * self.segment.length)
                if found is not None and (first is None or found < first[0]):
                    first = (found, int(j), which == 0)
        return first


def _dips(values):
    """Where three places (m - 2, n) of the columns (m, n) have a least value between them that may lie below zero:
    twice as deep as the parabola through them says.  Between the outer two of a step's places it counts too."""
    with np.errstate(invalid="ignore", divide="ignore"):
        slope, bend = 0.5 * (values[2:] - values[:-2]), values[:-2] - 2.0 * values[1:-1] + values[2:]
        return (np.abs(slope) <= 1.1 * bend) & (values[1:-1] < slope**2 / bend)


def _first_below(guard, taus, values, dips, least) -> float | None:
    """When `guard(tau)`, of which `values` (m,) at `taus` (m,) and the `dips` (m - 2,) are known, first falls below
    `least`; None if never."""
    for k in range(1, len(taus)):
        if values[k] < least:
            return _bisected(guard, taus[k - 1], taus[k], least)
        if k + 1 < len(taus) and dips[k - 1]:
            deepest = minimize_scalar(guard, bounds=(taus[k - 1], taus[k + 1]), method="bounded",
                                      options={"xatol": 1e-9 * (taus[-1] - taus[0])})  # fmt: skip
            if deepest.fun < least:
                return _bisected(guard, taus[k - 1], deepest.x, least)
    return None


def _bisected(guard, low, high, least) -> float:
    """The first instant at which the guard is below `least`, between `low` where it is not and `high` where it is."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if guard(middle) < least else (middle, high)
    return high
