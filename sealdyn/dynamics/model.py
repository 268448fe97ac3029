"""A scene made ready for a solver: unknowns, scales, right-hand side, residual, signals, linear form."""

import math

import numpy as np

from ..faces import contact
from ..faces.film_thickness import h_min
from ..faces.geometry import COLLAPSE, DZ, FACE_SIZE, FLOOR, GAP_STATE_SIZE, TOUCH, WAVES
from ..faces.waviness import highest_orders
from ..scene.scene import Scene, SceneError
from . import equations, extrema, linearisation
from .contact_events import (
    IMPULSE,
    KIND,
    LIFTED,
    OPEN,
    TOUCHED,
    ContactSummary,
    contact_event,
    locate_contacts,
    no_contact,
)
from .contact_events import ROW as TOUCH_ROW
from .imposed_motion import harmonics_of_segment
from .interface import Interface
from .modes import common_period
from .segments import Segment, constant_and_slope, modulo_turn, split_at_breaks
from .stick_slip import FADES, StickSlip
from .unknowns import Unknowns

# Above this ratio of the fastest decay to the fastest motion of interest, an explicit-like method crawls.
STIFF = 60.0
# Steps per fastest period while a ring sticks: its load is looked at twice in each.
PER_PERIOD = 32


class Model:
    """Equations, scales and signals of one scene over a duration.

    `n` displacements come first in the unknowns `y`, then the rates of those with mass (n_mechanical in all),
    then five works and the sum of absolute works.  Times handed in are leg times tau; call `begin(k)` first.
    """

    def __init__(self, scene: Scene, duration: float, accuracy: float = 1e-6):
        self.scene, self.duration, self.accuracy = scene, duration, accuracy
        self.faces = faces = Interface(scene, max(accuracy / 100, 1e-13))
        self.film, self.film_name, self.f, self.contact = faces.film, faces.name, faces.f, faces.contact
        self.clearance, self.closing, self.equilibria, self.closing_said = (
            faces.clearance, faces.closing, faces.equilibria, faces.said
        )  # fmt: skip
        self.observed = faces.observed
        self.face = self.f[:FACE_SIZE].copy()
        self.legs = self._legs()
        self.w, self.s = np.zeros(equations.SCRATCH), np.zeros(GAP_STATE_SIZE)
        self._shifts, self._linear_scenes, self.warnings = {}, {}, []
        self.layout = layout = Unknowns(scene, self.legs, self.closing, self.film_name == "linear")
        self.names, self.n, self.rate_places = layout.names, layout.n, layout.rate_places
        self.n_mechanical, self.size, self.reasons = layout.n_mechanical, layout.size, layout.reasons
        if self.face[WAVES]:
            self.reasons.append("wavy faces: the gap and leakage have the waves, the film's forces are as given")
        self.floats, self.massless, self.linear, self.constant = (
            layout.floats, layout.massless, layout.linear, layout.constant
        )  # fmt: skip
        self.algebraic = layout.algebraic(self.film_matrices()[1]) if layout.massless else []
        self.scales, self.pace, self.fast_time = layout.scales(self)
        self.memory = layout.memory(self, self.fast_time)
        self.works, self.touching, self.contacts = layout.works, no_contact(), []
        self.contact_tally = ContactSummary()
        self._set_bands()
        self.begin(0)
        self.sticking = StickSlip(self) if any(self._coulomb(k) for k in layout.seals) else None
        self.y0 = np.zeros(self.size)
        self.records = extrema.empty_records()
        self.last = (0.0, self.y0)
        self.windows = [[0.0, duration], [duration, duration], [duration, duration]]

    # --- making ready -------------------------------------------------------------------------------

    def seal(self, k: int):
        """Secondary seal of ring k (0 stator, 1 rotor), or None."""
        return (self.scene.stator, self.scene.rotor)[k].secondary_seal

    def _coulomb(self, k) -> bool:
        return self.seal(k).law == "coulomb"

    def _set_bands(self):
        """Sliding speeds (m/s) below which friction fades: the user's width, or the accuracy times the scale of rates;
        `band`, a little above, below which a ring is captured."""
        self.band = self.accuracy * self.clearance * self.pace / FADES
        for k in self.layout.seals:
            band = FADES * self.band if self._coulomb(k) else self.seal(k).width
            self.layout.ring_block[equations.RING * k + equations.SEAL_BAND] = band

    def closing_force(self) -> float:
        """Closing force (N) at the start."""
        return self.closing.over(self.legs[0], self.scene.film)[0]

    def _legs(self) -> list[Segment]:
        scene = self.scene
        quantities = [
            scene.shaft.speed,
            scene.stator.speed,
            scene.film.viscosity,
            scene.film.inner_pressure,
            scene.film.outer_pressure,
            self.closing.spring,
            scene.rotor.runout,
            scene.rotor.misalignment,
            scene.stator.misalignment,
        ]
        return split_at_breaks(self.duration, scene.shaft.speed, scene.stator.speed, quantities)

    # --- the pass -----------------------------------------------------------------------------------

    def begin(self, index: int) -> Segment:
        """Load a leg: tables as value and slope, phases reduced modulo one turn."""
        leg, scene = self.legs[index], self.scene
        closing = self.closing.over(leg, scene.film)
        varying = [
            constant_and_slope(q, leg)
            for q in (
                scene.shaft.speed,
                scene.stator.speed,
                scene.film.viscosity,
                scene.film.inner_pressure,
                scene.film.outer_pressure,
            )
        ]
        rows = harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, leg)
        head = np.array([x for pair in [*varying, closing] for x in pair]
                        + [modulo_turn(leg.rotor_angle), modulo_turn(leg.stator_angle), len(rows)])  # fmt: skip
        self.p = np.concatenate([self.layout.ring_block, head, rows.ravel()])
        self.leg, self.leg_index, self.rows = leg, index, rows
        self.leg_pace = max((max(abs(r[7]), abs(r[7] + 2 * r[8] * leg.length)) for r in rows), default=0.0)
        if self.face[WAVES]:
            spins = [[w, w + slope * leg.length] for w, slope in (varying[1], varying[0])]
            self.leg_pace = extrema.scan_pace(self.face, self.leg_pace, 2 * math.pi / self.fast_time, spins)
        self._bind()
        return leg

    def _bind(self):
        """Right-hand side and residual as plain functions over this leg's arrays."""
        p, w, s, f = self.p, self.w, self.s, self.f
        kinematics, rates, balance, wrench = (
            equations.kinematics,
            equations.rates,
            equations.residual,
            self.film.wrench,
        )
        work, block = np.zeros(self.size), self.contact
        press, both = contact.contact_load, equations.touching_rates

        def rhs(tau, y, yp):
            kinematics(tau, y, yp, p, w, s)
            wrench(f, s)
            rates(tau, y, p, w, s, yp)

        def residual(tau, y, yp, res):
            kinematics(tau, y, yp, p, w, s)
            wrench(f, s)
            balance(tau, y, yp, p, w, s, work, res)

        def touching_rhs(tau, y, yp):
            kinematics(tau, y, yp, p, w, s)
            wrench(f, s)
            both(tau, y, p, w, s, yp, block, f)

        def touching_residual(tau, y, yp, res):
            kinematics(tau, y, yp, p, w, s)
            wrench(f, s)
            press(block, f, s)
            balance(tau, y, yp, p, w, s, work, res)

        # A scene without contact does not even ask.
        pair = (rhs, residual) if block is None else (touching_rhs, touching_residual)
        self.rhs, self.residual = pair

    def jacobian(self, tau, y, yp, jac):
        """d y'/d y (size, size) by forward differences over the mechanical unknowns; works feed nothing back."""
        base, moved = np.empty(self.size), y.copy()
        self.rhs(tau, y, base)
        jac[:, :] = 0.0
        column = np.empty(self.size)
        for j in range(self.n_mechanical):
            step = 1e-7 * max(abs(y[j]), self.scales[j])
            moved[j] = y[j] + step
            self.rhs(tau, moved, column)
            jac[:, j] = (column - base) / step
            moved[j] = y[j]

    def start_rates(self, tau, y) -> np.ndarray:
        """Consistent derivatives at y: Newton on the residual, whose rows are linear in them but for a floor."""
        yp, res = np.zeros(self.size), np.empty(self.size)
        if not self.massless:
            self.rhs(tau, y, yp)
            return yp
        light = [i for i in range(self.n) if self.rate_places[i] < 0 and i not in self.algebraic]
        scale = self.scales[: self.n] * self.pace
        for _ in range(4):
            self.residual(tau, y, yp, res)
            jac = np.zeros((len(light), len(light)))
            for b, j in enumerate(light):
                moved, shifted = yp.copy(), np.empty(self.size)
                moved[j] += scale[j]
                self.residual(tau, y, moved, shifted)
                jac[:, b] = (shifted[light] - res[light]) / scale[j]
            yp[light] -= np.linalg.solve(jac, res[light])
        self.residual(tau, y, yp, res)
        others = [i for i in range(self.size) if i not in light and i not in self.algebraic]
        yp[others] -= res[others]
        return yp

    def motion(self, ys, yps):
        """Displacements (m, n) and their rates (m, n) of stored steps."""
        rate = np.empty((len(ys), self.n))
        for i, place in enumerate(self.rate_places):
            rate[:, i] = ys[:, place] if place >= 0 else yps[:, i]
        return np.ascontiguousarray(ys[:, : self.n]), rate

    def derivatives(self, taus, ys) -> np.ndarray:
        """The right-hand side (m, size) at leg times and unknowns `ys` (m, size); every ring has mass."""
        # A kernel of fixed signature is made ready by its import.
        from .kernels import Value, rates_along

        out, block = np.zeros((len(taus), self.size)), np.empty(0) if self.contact is None else self.contact
        rates_along(Value(self.film.wrench), self.f, block, self.p, self.w, self.s, taus, ys, out)
        return out

    def impulses(self, ys) -> np.ndarray:
        """Impulse of contact (N s) so far at stored steps."""
        return np.ascontiguousarray(ys[:, self.layout.impulse]) if self.layout.extended else np.zeros(len(ys))

    def longest_step(self) -> float:
        """Longest step (s) a solver may take: short where a stuck ring gives it nothing to do; no longer than its scan
        can see waves pass; else any."""
        held = self.sticking is not None and any(self.sticking.stuck.values())
        longest = self.fast_time / PER_PERIOD if held else math.inf
        return min(longest, extrema.longest_scan(self.leg_pace)) if self.face[WAVES] else longest

    def energies(self, taus, ys) -> np.ndarray:
        """Kinetic and spring energy (J) at stored steps."""
        out = np.empty(len(taus))
        equations.energies(taus, ys, np.zeros(self.size), self.p, self.w, self.s, out)
        return out

    def unknowns(self, q, q_rate) -> np.ndarray:
        """A vector `y` (works zero) from displacements and rates."""
        y = np.zeros(self.size)
        y[: self.n] = q
        for i, place in enumerate(self.rate_places):
            if place >= 0:
                y[place] = q_rate[i]
        return y

    def watch(self, index, t, q, q_rate, impulse, count, begin, end) -> float:
        """Update the records of extremes, and of contacts, over some steps; leg time of collapse or -1."""
        windows = np.array(self.windows) - self.legs[index].time
        tolerance = 0.02 * self.accuracy * np.array([self.clearance, self.clearance / self.face[1]])
        scratch = (self.p, self.f, np.zeros(self.size), np.zeros(self.size), self.w, self.s)
        reach = np.empty(count)
        fallen = extrema.track_extrema(
            t, q, q_rate, count, begin, end, *scratch, windows, index, self.records, tolerance, self.leg_pace, reach
        )
        if self.contact is not None:
            rows = np.empty((64 * (end - begin) + 64, TOUCH_ROW))
            upto = end if fallen < 0 else int(np.searchsorted(t, fallen))
            found = locate_contacts(
                t, q, q_rate, impulse, count, begin, upto, reach, *scratch, self.legs[index].time, self.leg_pace,
                self.gap_error(), self.touching, rows,
            )  # fmt: skip
            self.contacts.extend(rows[:found])
        return fallen

    def tell_contacts(self, log, end: tuple | None = None):
        """Hand the contacts that have ended to `log` as events, and add them to the tally of contacts; at the `end`
        (time, unknowns) of a run also one that goes on, without a lift-off."""
        rows, self.contacts = self.contacts, []
        if end and self.touching[OPEN]:
            row = self.touching[:TOUCH_ROW].copy()
            row[KIND], row[LIFTED] = 1.0, np.nan
            row[IMPULSE] = end[1][self.layout.impulse] - row[IMPULSE]
            self.contact_tally.longest = max(self.contact_tally.longest, float(end[0] - row[TOUCHED]))
            rows.append(row)
        if rows:
            self.contact_tally.add(rows)
            log([contact_event(row, self.face[TOUCH]) for row in rows])

    def kept_modes(self) -> dict:
        """What a continued run needs beside the unknowns: contacts so far, and which rings stick."""
        return {
            "touching": self.touching,
            "contacts": vars(self.contact_tally),
            "sticking": self.sticking.kept() if self.sticking else None,
        }

    def restore_modes(self, kept: dict):
        """Go on from `kept`."""
        self.touching[:] = kept["touching"]
        self.contact_tally = ContactSummary(**kept["contacts"])
        if self.sticking:
            self.sticking.restore(kept["sticking"])

    def gap_error(self) -> float:
        """How exactly (m) the gap is known: the accuracy on the axial gap and on the tilt at the outer radius."""
        return 2.0 * self.accuracy * self.clearance

    def collapse_sentence(self, index: int, tau: float) -> str:
        """When, where, and what to try."""
        record = self.records[0]
        what, limit = (
            ("film collapsed", "floor") if self.contact is None else ("asperities crushed flat", "all flat at")
        )
        at = "at the {} radius".format("inner" if record[extrema.H_RADIUS] == self.face[0] else "outer")
        if record[extrema.H_RADIUS] not in self.face[:2]:
            at = "at the radius"
        return (
            f"{what} at t = {self.legs[index].time + tau:.6g} s: thickness {record[extrema.H] * 1e6:.3g} um "
            f"({limit} {self.face[COLLAPSE] * 1e6:.3g} um) {at} {record[extrema.H_RADIUS] * 1e3:.4g} mm, "
            f"theta = {math.degrees(record[extrema.H_THETA]):.1f} deg.  Try less misalignment or runout, "
            'more coning or clearance, a stiffer or more damped support, run.start = "steady".'
        )

    def solver(self) -> tuple[str, str]:
        """The method this scene wants, and why."""
        if self.massless:
            return "ida", "a massless ring has no rates: IDA, on the residual form"
        if self.linear and self.constant:
            return "expm", "linear film, constant conditions: the exact motion, by matrix exponential"
        ratio = self._fastest_decay() * self.fast_time / (2 * math.pi)
        if ratio > STIFF:
            return "bdf", f"fastest decay {ratio:.0f} times the fastest forcing: stiff, CVODE BDF"
        return "adams", f"fastest decay {max(ratio, 0):.2g} times the fastest motion: not stiff, CVODE Adams"

    def _fastest_decay(self) -> float:
        """Fastest decay (1/s) of the scene linearised where the run starts (a squeezed film is stiffer by the cube)
        and at the equilibrium of each leg's loads."""
        self.begin(0)
        equations.kinematics(0.0, self.y0, np.zeros(self.size), self.p, self.w, self.s)
        shifts = {(max(self.s[DZ], self.f[FLOOR] - self.clearance),): 0}
        for k, leg in enumerate(self.legs):
            varying = (self.scene.shaft.speed, self.scene.film.viscosity)
            shifts[self.axial_shift(k), *(constant_and_slope(q, leg)[0] for q in varying)] = k
        return max(float(np.max(-self.linear_scene(k, shift=at[0]).eigen()[0].real)) for at, k in shifts.items())

    def start_film(self) -> float:
        """Thinnest film (m) at the start."""
        if self.leg_index:
            self.begin(0)
        equations.kinematics(0.0, self.y0, np.zeros(self.size), self.p, self.w, self.s)
        return float(h_min(self.face, self.s)[0])

    def check_start(self):
        """Raises ImpossibleScene if the film is closed at the start."""
        low = self.start_film()
        if low <= self.face[COLLAPSE]:
            raise SceneError(
                "film.clearance",
                f"a film closed at the start (thinnest {low * 1e6:.4g} um)",
                f"more than the floor, {self.face[COLLAPSE] * 1e6:.3g} um: less tilt or waviness, more clearance, "
                'or run.start = "steady"',
            )

    def period(self) -> float | None:
        """Common period (s) of the forcing in the present leg; one shaft turn if nothing moves; None if the
        frequencies are incommensurate or change."""
        if np.any(self.rows[:, 3]) or np.any(self.rows[:, 8]):
            return None
        speed, slope = constant_and_slope(self.scene.shaft.speed, self.leg)
        if slope:
            return None
        moving = [w for w in self.rows[:, 7] if w != 0.0]
        if highest_orders(self.face)[0] and self.scene.stator.speed:
            # A wave of the stator's face comes round with its ring.
            moving.append(constant_and_slope(self.scene.stator.speed, self.leg)[0])
        if not moving and not speed:
            # Nothing moves: any stretch of time is a period.
            return self.duration / 4
        return common_period([*moving, speed] if speed else moving)

    def fastest_forcing(self) -> float:
        """Highest angular frequency (rad/s) imposed at any leg's start or end; the shaft speed counts."""
        scene, fastest = self.scene, 0.0
        for leg in self.legs:
            for row in harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, leg):
                fastest = max(fastest, abs(row[7]), abs(row[7] + 2 * row[8] * leg.length))
            speed, slope = constant_and_slope(scene.shaft.speed, leg)
            fastest = max(fastest, abs(speed), abs(speed + slope * leg.length))
        return fastest

    # --- the linear side ----------------------------------------------------------------------------

    def film_matrices(self, leg_index: int = 0):
        """Stiffness and damping (3, 3) of the film about the aligned equilibrium, speed of that leg's start."""
        linear = self.linear_scene(leg_index)
        return linear.film_k, linear.film_d

    def axial_shift(self, leg_index: int) -> float:
        """How far (m) the loads at a leg's start move the aligned gap from its design clearance."""
        if leg_index not in self._shifts:
            self._shifts[leg_index] = linearisation.axial_shift(self, leg_index)
        return self._shifts[leg_index]

    def linear_scene(self, leg_index: int = 0, speed: float | None = None, shift: float | None = None):
        """The linearised scene at a leg's start, or at another shaft speed (rad/s) or `shift` (m) of the gap."""
        if speed is not None:
            return linearisation.linear_scene(self, leg_index, speed, shift)
        key = leg_index, self.axial_shift(leg_index) if shift is None else shift
        if key not in self._linear_scenes:
            self._linear_scenes[key] = linearisation.linear_scene(self, leg_index, shift=key[1])
        return self._linear_scenes[key]

    def harmonics(self) -> list:
        """The imposed oscillators of the present leg as harmonics in leg time."""
        return linearisation.harmonics(self)

    def steady_motion(self):
        """Linear steady state (dynamics/linearisation.py)."""
        return linearisation.steady_motion(self)

    def exact_motion(self):
        """Exact solution of a linear scene (dynamics/linearisation.py)."""
        return linearisation.ExactMotion(self)

    def kept(self) -> list[int]:
        """Places of this problem's displacements among three per floating ring."""
        parts = [i for i in range(3) if (i == 0 and self.layout.with_axial) or (i > 0 and self.layout.with_tilt)]
        count = sum(self.floats.values())
        return [3 * a + i for a in range(count) for i in parts]

    def steady_start(self) -> np.ndarray:
        """Unknowns on the linear steady state at time zero."""
        at, _, _ = self.steady_motion()
        q, rate = at(0.0)
        kept = self.kept()
        return self.unknowns(q[kept], rate[kept])
