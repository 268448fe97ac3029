"""The equations of one scene: constant once made, whatever is run with them."""

import copy
import math
from fractions import Fraction

import numpy as np

from ..faces.geometry import FACE_SIZE
from ..numerics.piecewise_linear import PiecewiseLinear, initially
from ..scene.film import aligned_gaps, coning_change
from ..scene.forces import load_of
from ..scene.rings import RING_NAMES
from ..scene.scene import Scene, SceneError
from . import equations, linearisation, modes
from .equilibrium import axial_shift
from .imposed_motion import fluid_conditions
from .interface import FAST, Interface
from .intervals import Instant, Interval, Intervals, constant_and_slope, first_interval, split_at_breaks, time_of_angle
from .segments import Segment
from .stick_slip import CAPTURE, FADE, ONSET_SPEED
from .swept_motion import check_begins, check_covers, sweep_breaks
from .unknowns import Unknowns


class Model:
    """Equations, unknowns and scales of a scene at one accuracy; nothing of it changes, and nothing of it knows how
    long a run is.

    `interface` film, faces and aligned equilibrium (interface.py), of which `f` is the film's block (n,), `face` its
    leading slots, `contact` the block of the asperities or None, `clearance` (m) and `closing` the closing force;
    `observed` film and block from which leakage and friction are reported; `unknowns` (unknowns.py); `scales` (size,)
    of the unknowns, `reference_rate` (rad/s) between displacements and rates, `shortest_period` (s) of interest;
    `capture_speed` (m/s) below which a ring on its secondary seal is captured; `algebraic` places of unknowns without
    mass and damping, or of the film's without a rate; `start` the first interval.  The scene names its film, unless a
    `film` is given (Film, films/_contract.py).  `film_error`: relative, of the film's
    integrals (default a hundredth of the accuracy).  `given` the scene as it was, `heat` its WarmState at the start
    (None without `[film.heat]`): `scene` is as warm, throughout or, where loads change for long, along its `course`.
    """

    def __init__(self, scene: Scene, accuracy: float = 1e-6, observed=None, film=None, film_error=None):
        self.given, made = scene, None
        self.heat = None
        if scene.film.liquid is not None:
            # Loaded only where temperature counts.
            from .warm_state import at_work

            scene, self.heat = at_work(scene)
        self.course = None
        if self.heat is not None:
            from .warm_course import followed, with_course

            self.course = followed(self.given)
            if self.course is not None:
                scene = with_course(scene, self.given, self.course)
        self._warm = {} if self.heat is None else {float(initially(scene.shaft.speed)): self}
        if scene.stator.elastic is not None:
            from .elastic_ring import at_rest, unloaded

            # Its waves are those at rest, throughout.
            made, scene = unloaded(scene), at_rest(scene)
        self.scene, self.accuracy, self.film = scene, accuracy, film
        self.film_error = accuracy / 100 if film_error is None else film_error
        self.interface = Interface(scene, max(self.film_error, 1e-13), film)
        self.f, self.contact = self.interface.f, self.interface.contact
        self.face = self.f[:FACE_SIZE].copy()
        self.clearance, self.closing = self.interface.clearance, self.interface.closing
        self.observed = observed or self.interface.observed
        self.start = first_interval(self._imposed(), sweep_breaks(scene))
        self.unknowns = Unknowns(scene, self.closing, self.interface.film.constant, self.interface.unknowns)
        if made is not None:
            was, left = 1e6 * made, 1e6 * scene.stator.waviness[0].amplitude
            self.unknowns.reasons.append(f"elastic ring: {left:.4g} um of its {was:.4g} um of waves are left at rest")
        sticking = [*self.unknowns.coulomb_rings, *self.unknowns.elastic_rings]
        if self.unknowns.film_unknowns and sticking:
            # What a stuck ring holds is looked for between steps, from the motion of the rings alone; and each place
            # of a seal that gives would start the film anew.
            key = f"{RING_NAMES[sticking[0]]}.secondary_seal.law"
            raise SceneError(key, "sticking beside a film with unknowns of its own", '"regularised"')
        self._shifts, self._linear_scenes, self._still_films = {}, {}, {}
        self.loads = None
        self.algebraic = self.unknowns.algebraic(self.film_matrices()[1]) if self.unknowns.has_residual_form else []
        self.scales, self.reference_rate, self.shortest_period = self.unknowns.scales(self)
        self.capture_speed = CAPTURE * accuracy * self.clearance * self.reference_rate
        self._set_bands()

    def with_sharper_film(self, share: float) -> "Model":
        """The same with a film whose integrals err by this share of what they do.  **Valid** where the film is the one
        that is observed; one of cells has no integrals to sharpen, and is the same."""
        if self.unknowns.film_unknowns:
            return self
        return Model(self.given, self.accuracy, None, self.film, share * self.film_error)

    def under(self, scene: Scene, loads) -> "Model":
        """The same equations under other conditions: the `scene` with what may be a table changed, and `loads` on its
        rings, harmonics (n, ROW) (imposed_motion.py).  **Valid** for the segments of a run; numbers at rest are those
        of the scene."""
        other = copy.copy(self)
        other.scene, other.loads = scene, loads
        other._shifts, other._linear_scenes, other._still_films = {}, {}, {}
        return other

    def _imposed(self) -> list:
        """Everything that may be a table."""
        scene, film = self.scene, self.scene.film
        return [
            scene.shaft.speed, scene.stator.speed, *fluid_conditions(film).values(), film.coning, film.temperature,
            self.closing.spring, scene.rotor.runout, scene.rotor.misalignment, scene.stator.misalignment,
            *(q for ring in (scene.stator, scene.rotor) if (load := load_of(ring)) for q in load.varying()),
        ]  # fmt: skip

    def _set_bands(self):
        """Sliding speeds (m/s) below which friction fades: the user's, or a part of the onset's (stick_slip.py)."""
        for k in (k for k in self.unknowns.seals if k not in self.unknowns.elastic_rings):
            coulomb = k in self.unknowns.coulomb_rings
            band = FADE * ONSET_SPEED * self.capture_speed if coulomb else self.unknowns.seal(k).width
            self.unknowns.ring_block[equations.RING * k + equations.SEAL_BAND] = band

    # --- time ---------------------------------------------------------------------------------------

    def intervals(self, duration: float) -> Intervals:
        """The intervals of a run of `duration` (s), on each of which everything imposed is linear.  Raises SceneError
        for one beyond the samples of a motion, or before a sweep begins."""
        check_covers(self.scene, duration)
        check_begins(self.scene, duration)
        speeds, times = (self.scene.shaft.speed, self.scene.stator.speed), sweep_breaks(self.scene)
        return split_at_breaks(duration, *speeds, self._imposed(), times)

    def next_break(self, time: Fraction) -> float:
        """The first time (s) after another at which something imposed has a kink or a step; infinite if none comes."""
        tables = [quantity for quantity in self._imposed() if isinstance(quantity, PiecewiseLinear)]
        times = [*sweep_breaks(self.scene), *(t for table in tables for t in table.time)]
        return min((t for t in times if t > time), default=math.inf)

    def instant(self, interval: Interval, tau: float) -> Interval:
        """What stands for the conditions `tau` (s) after an interval's start: itself where nothing changes in it."""
        moves = any(constant_and_slope(quantity, interval)[1] for quantity in self._imposed() if quantity is not None)
        return Instant.of(interval, tau) if moves else interval

    def time_of(self, turns: float) -> float:
        """Time (s) in which the shaft turns so often.  Raises SceneError if it never does."""
        try:
            return time_of_angle(self.scene.shaft.speed, 2 * math.pi * turns)
        except ValueError as error:
            raise SceneError("run.turns", str(error), "run.duration instead") from None

    def segment(self, interval: Interval | None = None, index: int = 0, last: bool = True, stuck=None) -> Segment:
        """The equations over an interval (the first one if none is given); `stuck` as Segment's."""
        if self.unknowns.film_unknowns is None:
            kind = Segment
        else:
            # Sparse matrices are loaded for a film with unknowns only.
            from .coupled_segment import CoupledSegment as kind
        return kind(self, interval or self.start, index, last, stuck)

    # --- numbers at rest ----------------------------------------------------------------------------

    def closing_force(self) -> float:
        """Closing force (N) at the start."""
        return self.closing.over(self.start, self.scene.film)[0]

    def gap_error(self) -> float:
        """How exactly (m) the gap is known: the accuracy on the axial gap and on the tilt at the outer radius."""
        return 2.0 * self.accuracy * self.clearance

    # --- the linear side ----------------------------------------------------------------------------

    def film_matrices(self, interval: Interval | None = None):
        """Stiffness and damping (3, 3) of the film about the aligned equilibrium, speed of an interval's start; of a
        film that stores those of slow motion."""
        linear = self.linear_scene(interval)
        return linear.film_k, linear.film_d

    def axial_shift(self, interval: Interval | None = None) -> float:
        """How far (m) the loads at an interval's start move the aligned gap from its design clearance."""
        return self._axial_shift(interval or self.start)[0]

    def loads_are_balanced(self, interval: Interval) -> bool:
        """Whether there is a gap at which the film holds the loads of an interval's start."""
        return self._axial_shift(interval)[1]

    def no_steady_response(self) -> str:
        """Why no run can start on a linear steady response of the scene; else empty."""
        if self.scene.initial.given:
            return "[initial] gives the rest"
        if not self.loads_are_balanced(self.start):
            return "no gap at which the film holds the loads"
        verdict = modes.verdict(self.linear_scene().modes())
        return "" if verdict == "stable" else f"the linear steady response is {verdict}"

    def _axial_shift(self, interval: Interval) -> tuple[float, bool]:
        if interval.key not in self._shifts:
            self._shifts[interval.key] = axial_shift(self, interval)
        return self._shifts[interval.key]

    def linear_scene(self, interval: Interval | None = None, speed: float | None = None, shift: float | None = None):
        """The linearised scene at an interval's start, or at another shaft speed (rad/s), or with aligned faces at
        another `shift` (m) of the gap (linearisation.py)."""
        interval = interval or self.start
        if speed is not None and self.heat is not None:
            return self.at_speed(float(speed)).linear_scene(shift=shift)
        if speed is not None:
            return linearisation.linear_scene(self, interval, speed, shift)
        key = interval.key, None if shift == self.axial_shift(interval) else shift
        if key not in self._linear_scenes:
            self._linear_scenes[key] = linearisation.linear_scene(self, interval, shift=key[1])
        return self._linear_scenes[key]

    def at_speed(self, speed: float) -> "Model":
        """The same with the warm state of another shaft speed (rad/s); itself where nothing is warm.  Raises
        NoWarmState."""
        if self.heat is None:
            return self
        from .warm_state import at_work

        if speed not in self._warm:
            beside = self._warm[min(self._warm, key=lambda w: abs(w - speed))].heat
            scene, heat = at_work(self.given, speed, beside)
            self._warm[speed] = Model(scene, self.accuracy, None, self.film, self.film_error)
            self._warm[speed].heat = heat
        return self._warm[speed]

    def still_film(self, interval: Interval, shift: float):
        """Slopes (condensation.py) of a film that is linear in the rates, at an interval's start without mean spin, the
        gap `shift` (m) wider; not to be changed."""
        key = interval.key, shift
        if key not in self._still_films:
            found = self.interface.slopes(interval, mean_spin=0.0, shift=shift, pace=FAST)
            self._still_films[key] = found
        return self._still_films[key]

    def coning_change(self, interval: Interval | None = None, speed: float | None = None) -> float:
        """By how much (rad) the coning differs from the face block's, at an interval's start and a shaft speed
        (rad/s), or the scene's own."""
        return coning_change(self.scene, lambda q: constant_and_slope(q, interval or self.start)[0], speed)

    def aligned_gaps(self, interval: Interval | None = None) -> list[tuple[float, float]]:
        """(radius, film thickness) in m of the aligned faces at the clearance, at an interval's start."""
        return aligned_gaps(self.scene.film, self.clearance, self.coning_change(interval))

    def speed_at(self, interval: Interval) -> float:
        """Shaft speed (rad/s) at an interval's start."""
        return constant_and_slope(self.scene.shaft.speed, interval)[0]

    # --- vectors ------------------------------------------------------------------------------------

    def vector(self, q, q_rate) -> np.ndarray:
        """Unknowns `y` (size,), works and film zero, from displacements (m, rad) and rates (n,)."""
        unknowns, y = self.unknowns, np.zeros(self.unknowns.size)
        y[: unknowns.n] = q
        for i, place in enumerate(unknowns.rate_places):
            if place >= 0:
                y[place] = q_rate[i]
        return y
