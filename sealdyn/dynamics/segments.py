"""The equations over one stretch of time on which everything imposed is linear."""

import copy
import math
from functools import cached_property

import numpy as np

from ..faces.film_thickness import highest_orders
from ..faces.geometry import GAP_STATE_SIZE, REFUSED, WAVES
from ..scene.rings import STATOR
from ..solvers.contract import SolverFailure
from . import equations, linearisation
from .extrema import longest_scan, scan_pace
from .imposed_motion import (
    CONING_PER_SPEED_SQUARED,
    ROTOR_SPEED,
    coning_at,
    fluid_conditions,
    harmonics_of_segment,
    imposed_block,
    thermal_coning,
)
from .intervals import Interval, common_period, constant_and_slope, modulo_turn
from .native import native, rates_along, rates_of, residual_of
from .step_bounds import BEND, REACH, largest_swing
from .swept_motion import fastest_sweep, largest_sweep, motions, splines, sweeps_of, sweeps_of_segment

# Steps per shortest period while a ring sticks: its load is looked at twice in each.
PER_PERIOD = 32
# By how much of the speed below which friction fades a rate is moved to difference it.
TURNING = 0.2
# A ring without mass moves as its damping lets it.
UNDAMPED = (
    "no force tells how fast a ring without mass moves: give it a mass, or damping; look at the units of speed, "
    "viscosity and damping"
)
# Longest step in radians of the fastest imposed motion: a third of its period.
LONGEST = 2.0


class Segment:
    """What a solver integrates: right-hand side and residual over constant parameters, in the segment's own clock tau.

    `n` displacements come first in the unknowns `y` (size,), then the rates of those with mass (`n_mechanical` in
    all), then the film's (slice `film`), then the works.  `p` parameters, `rows` (m, ROW) imposed harmonics, `sweeps`
    (k, SWEEP_ROW) of the housing, `sampled` {ring: what moves its carrier by samples}, `records`
    {key: all by samples, forces among them}, `imposed_pace` (rad/s) the fastest of them, `pace` that of the scan;
    `index` among the segments of a run, `last` of them; `stuck` {ring: True, False, or the velocity of its onset (3,)
    in m/s and rad/s}, of a ring whose seal gives where its elements rest.
    """

    def __init__(self, model, interval: Interval, index: int = 0, last: bool = True, stuck=None):
        unknowns = model.unknowns
        self.model, self.interval, self.index, self.last = model, interval, index, last
        self.time, self.length, self.stuck = interval.time, interval.length, dict(stuck or {})
        self.n, self.n_mechanical, self.size = unknowns.n, unknowns.n_mechanical, unknowns.size
        self.rate_places, self.works, self.scales = unknowns.rate_places, unknowns.works, model.scales
        self.has_residual_form, self.lacks_inertia = unknowns.has_residual_form, unknowns.lacks_inertia
        self.algebraic, self.film = model.algebraic, unknowns.film
        self.reference_rate, self.shortest_period = model.reference_rate, model.shortest_period
        self.may_change = bool(unknowns.coulomb_rings or unknowns.elastic_rings)
        self.sweeps = sweeps_of_segment(model.scene, interval)
        self.p, self.rows = self._parameters()
        self.sampled, self.records = motions(model.scene), splines(model.scene)
        paces = [max(abs(r[7]), abs(r[7] + 2 * r[8] * self.length)) for r in self.rows]
        paces.append(fastest_sweep(self.sweeps, self.length))
        self.imposed_pace = max([*paces, *(motion.pace for motion in self.records.values())], default=0.0)
        self.pace = self._pace()
        self.w, self.s = np.zeros(equations.SCRATCH), np.zeros(GAP_STATE_SIZE)

    def _parameters(self):
        """Parameters: tables as value and slope, phases reduced modulo one turn; and the imposed harmonics."""
        scene, interval = self.model.scene, self.interval
        film = scene.film
        varying = (scene.shaft.speed, scene.stator.speed, *fluid_conditions(film).values())
        pairs = [*(constant_and_slope(q, interval) for q in varying), self.model.closing.over(interval, film)]
        pairs.append(thermal_coning(scene, interval))
        rows = harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, interval)
        if self.model.loads is not None:
            rows = np.vstack([rows, self.model.loads])
        head = [x for pair in pairs for x in pair]
        head += [film.coning_per_speed_squared, *map(modulo_turn, interval.angles), len(rows)]
        p = np.concatenate([self.model.unknowns.ring_block, imposed_block(head, rows, self.sweeps, scene, interval)])
        for k in self.model.unknowns.elastic_rings:
            from .secondary_seal import elements_block

            block = elements_block(self.model.unknowns.seal(k), self.model.unknowns.with_tilt, self.stuck.get(k))
            p[equations.RING * k + equations.SEAL_AT] = len(p)
            p = np.concatenate([p, block])
        for k in (k for k in self.stuck if k in self.model.unknowns.coulomb_rings):
            at, held = equations.RING * k, self.stuck[k]
            p[at + equations.STUCK] = held is True
            p[at + equations.ONSET : at + equations.ONSET + 3] = 0.0 if isinstance(held, bool) else held
        return p, rows

    def _pace(self) -> float:
        """Fastest imposed motion (rad/s); of wavy faces also their waves as they pass."""
        if not self.model.face[WAVES]:
            return self.imposed_pace
        speeds = (constant_and_slope(ring, self.interval) for ring in self._speeds())
        spins = [[w, w + slope * self.length] for w, slope in speeds]
        return scan_pace(self.model.face, self.imposed_pace, 2 * math.pi / self.shortest_period, spins)

    @cached_property
    def swing(self) -> np.ndarray:
        """How far and how sharply the imposed motion can move the gap (step_bounds.py)."""
        spins = [constant_and_slope(ring, self.interval) for ring in self._speeds()]
        floats, leg = self.model.unknowns.floats, self.p[equations.LEG_AT :]
        # Change of the coning as a parabola in time.
        bend = leg[CONING_PER_SPEED_SQUARED] * leg[ROTOR_SPEED + 1] ** 2
        swing = largest_swing(self.model.face, self.rows, floats, spins, (*coning_at(0.0, leg), bend), self.length)
        for ring in (ring for ring in self.sampled if not floats[ring]):
            reach, fourth = self.sampled[ring].reach(self.time, self.length)
            swing[REACH : REACH + 2] += reach
            swing[BEND : BEND + 2] += fourth
        if len(self.sweeps) and not floats[STATOR]:
            reach, fourth = largest_sweep(self.sweeps, self.length)
            swing[REACH : REACH + 2] += reach
            swing[BEND : BEND + 2] += fourth
        return swing

    def _speeds(self):
        """Speeds (rad/s) of stator and rotor."""
        return self.model.scene.stator.speed, self.model.scene.shaft.speed

    @cached_property
    def native(self):
        """These equations for C (native.py), which work on this segment's arrays and those of its copies."""
        return native(self)

    def rhs(self, tau, y, yp):
        """Right-hand side into `yp` (size,) at segment time `tau` (s) and unknowns `y` (size,)."""
        self.ring_rates(tau, y, yp)

    def ring_rates(self, tau, y, yp):
        """Rates of rings and works at given unknowns of the film, if it has any, into `yp` (size,)."""
        # A solver's arrays may be for reading only, which no kernel takes: here, and below.
        rates_of(self.native.ring_rates, self.native.data, tau, np.array(y), yp)

    def residual(self, tau, y, yp, res):
        """Residual into `res` (size,) at unknowns `y` and their derivatives `yp` (size,)."""
        residual_of(self.native.residual, self.native.data, tau, np.array(y), np.array(yp), res)

    def failure(self) -> str:
        """What the film says if it had no solution since it was asked last, else ""."""
        code, self.s[REFUSED] = int(self.s[REFUSED]), 0.0
        return self.model.interface.film.status[code] if code else ""

    def until(self, tau: float) -> "Segment":
        """The same segment, ending at tau (s)."""
        short = copy.copy(self)
        short.length = float(tau)
        return short

    # --- what solvers ask ---------------------------------------------------------------------------

    def jacobian(self, tau, y, yp, jac, rhs=None):
        """d y'/d y (size, size) by forward differences over the mechanical unknowns; works feed nothing back.  `rhs`:
        another right-hand side than the segment's own."""
        rhs, base, moved = rhs or self.rhs, np.empty(self.size), y.copy()
        rhs(tau, y, base)
        jac[:, :] = 0.0
        column = np.empty(self.size)
        for j in range(self.n_mechanical):
            scale = self.differences[j]
            step = -scale if scale < 0.0 else 1e-7 * max(abs(y[j]), scale)
            moved[j] = y[j] + step
            rhs(tau, moved, column)
            jac[:, j] = (column - base) / step
            moved[j] = y[j]

    @cached_property
    def differences(self) -> np.ndarray:
        """Scales (size,) of the steps by which a Jacobian is differenced; negative the step itself, of the rates of a
        ring whose dry friction turns within less than the usual step (stick_slip.py)."""
        scales, unknowns = self.scales.copy(), self.model.unknowns
        for k in unknowns.coulomb_rings:
            ring = self.p[equations.RING * k : equations.RING * (k + 1)]
            band, radius = ring[equations.SEAL_BAND], ring[equations.SEAL_RADIUS]
            z, tilt = int(ring[equations.AT_Z_RATE]), int(ring[equations.AT_TILT_RATE])
            if z >= 0:
                scales[z] = -TURNING * band
            if tilt >= 0:
                scales[tilt : tilt + 2] = -TURNING * band / radius
        return scales

    def settle_film(self, tau, y):
        """Film unknowns of `y` as those of the steady film: an algebraic film has none."""

    def start(self, tau, y) -> tuple[np.ndarray, np.ndarray]:
        """Consistent unknowns and derivatives to go on from `y` with; here `y` itself, and Newton on the residual,
        whose rows are linear in the derivatives but for a floor."""
        yp, res = np.zeros(self.size), np.empty(self.size)
        if not self.has_residual_form:
            self.rhs(tau, y, yp)
            return y, yp
        light = [i for i in range(self.n) if self.rate_places[i] < 0 and i not in self.algebraic]
        scale = self.scales[: self.n] * self.reference_rate
        for _ in range(4):
            self.residual(tau, y, yp, res)
            jac = np.zeros((len(light), len(light)))
            for b, j in enumerate(light):
                moved, shifted = yp.copy(), np.empty(self.size)
                moved[j] += scale[j]
                self.residual(tau, y, moved, shifted)
                jac[:, b] = (shifted[light] - res[light]) / scale[j]
            try:
                yp[light] -= np.linalg.solve(jac, res[light])
            except np.linalg.LinAlgError:
                raise SolverFailure(UNDAMPED) from None
        self.residual(tau, y, yp, res)
        others = [i for i in range(self.size) if i not in light and i not in self.algebraic]
        yp[others] -= res[others]
        if len(self.algebraic):
            self._carry_algebraic(tau, y, yp)
        return y, yp

    def _carry_algebraic(self, tau, y, yp):
        """Derivatives in `yp` of the algebraic unknowns: those with which their rows stay zero.  Without them the first
        steps of a solver miss by all that these unknowns move."""
        at, base, moved = list(self.algebraic), np.empty(self.size), np.empty(self.size)
        self.residual(tau, y, yp, base)
        jac = np.empty((len(at), len(at)))
        for column, j in enumerate(at):
            near = y.copy()
            near[j] += 1e-6 * self.scales[j]
            self.residual(tau, near, yp, moved)
            jac[:, column] = (moved[at] - base[at]) / (1e-6 * self.scales[j])
        ahead = 1e-6 / self.reference_rate
        self.residual(tau + ahead, y + ahead * yp, yp, moved)
        yp[at] = np.linalg.lstsq(jac, -(moved[at] - base[at]) / ahead, rcond=None)[0]

    def longest_step(self) -> float:
        """Longest step (s) a solver may take: short where a stuck ring gives it nothing to do; not past an imposed
        motion unseen, however faint; no longer than its scan can see waves pass; else any."""
        longest = math.inf
        if any(held is True for held in self.stuck.values()):
            # Where nothing turns or shakes, what a stuck ring holds changes as evenly as time goes.
            still = not self.imposed_pace and not any(any(constant_and_slope(w, self.interval)) for w in self._speeds())
            longest = max(self.shortest_period, self.length if still else 0.0) / PER_PERIOD
        if self.imposed_pace:
            longest = min(longest, LONGEST / self.imposed_pace)
        return min(longest, longest_scan(self.pace)) if self.model.face[WAVES] else longest

    def exact_motion(self):
        """Exact solution of a linear scene (linearisation.py)."""
        return linearisation.ExactMotion(self)

    # --- stored steps -------------------------------------------------------------------------------

    def motion(self, ys, yps):
        """Displacements (m, n) and their rates (m, n) of stored steps."""
        rate = np.empty((len(ys), self.n))
        for i, place in enumerate(self.rate_places):
            rate[:, i] = ys[:, place] if place >= 0 else yps[:, i]
        return np.ascontiguousarray(ys[:, : self.n]), rate

    def derivatives(self, taus, ys) -> np.ndarray:
        """The right-hand side (m, size) at times and unknowns `ys` (m, size), zero for the film's; every ring has
        mass."""
        out = np.zeros((len(taus), self.size))
        rates_along(self.native.ring_rates, self.native.data, taus, ys, out)
        return out

    def energies(self, taus, ys) -> np.ndarray:
        """Kinetic and spring energy (J) at stored steps."""
        out = np.empty(len(taus))
        equations.energies(taus, ys, np.zeros(self.size), self.p, self.w, self.s, out)
        return out

    def gap_state(self, tau, y) -> np.ndarray:
        """Gap state `s` (faces/geometry.py) at one time (s) and unknowns (size,), kinematics only; the segment's own
        array, which the next call changes."""
        equations.kinematics(tau, y, np.zeros(self.size), self.p, self.w, self.s)
        return self.s

    # --- forcing ------------------------------------------------------------------------------------

    @property
    def harmonic(self) -> bool:
        """Whether what is imposed is harmonics alone, so that it may have a period and a steady response; in the
        segment that stands for the scene at any time, none of its sweeps may come later."""
        later = self.interval is self.model.start and sweeps_of(self.model.scene)
        return not (self.records or len(self.sweeps) or later)

    def period(self) -> float | None:
        """Common period (s) of the forcing; one shaft turn if nothing moves but the shaft, 0.0 if nothing moves at all
        (any time is a period); None if the frequencies are incommensurate or change."""
        if not self.harmonic or np.any(self.rows[:, 3]) or np.any(self.rows[:, 8]):
            return None
        speed, slope = constant_and_slope(self.model.scene.shaft.speed, self.interval)
        if slope:
            return None
        moving = [w for w in self.rows[:, 7] if w != 0.0]
        if highest_orders(self.model.face)[0] and self.model.scene.stator.speed:
            # A wave of the stator's face comes round with its ring.
            moving.append(constant_and_slope(self.model.scene.stator.speed, self.interval)[0])
        if not moving and not speed:
            return 0.0
        return common_period([*moving, speed] if speed else moving)

    def harmonics(self) -> list:
        """The imposed oscillators as harmonics in segment time.  Raises SceneError where there are others."""
        linearisation.check_harmonic(self)
        return linearisation.harmonics(self)

    def steady_motion(self):
        """Linear steady state (linearisation.py).  Raises as `harmonics`."""
        linearisation.check_harmonic(self)
        return self.periodic_motion

    @cached_property
    def periodic_motion(self):
        """The same of what is periodic alone, without samples and sweeps, worked out once."""
        return linearisation.steady_motion(self)
