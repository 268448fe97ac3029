"""What a run changes: where it starts, its segments, and what is observed on the way."""

from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..faces.film_thickness import h_min, highest_orders
from ..faces.geometry import COLLAPSE
from ..scene.forces import film_in_words, limit_in_words
from ..scene.scene import SceneError
from ..scene.sweep import end
from .equilibrium import pulled_apart
from .extrema import ExtremaTracker
from .imposed_motion import harmonics_of_segment
from .intervals import constant_and_slope
from .model import Model
from .segments import Segment
from .stick_slip import StickSlip
from .swept_motion import fastest_sweep, splines, sweeps_of, sweeps_of_segment
from .tally import ContactEvents


class Concern(StrEnum):
    """What a caution is about."""

    ACCURACY = "accuracy"
    ALIASING = "aliasing"
    ALIGNED = "aligned faces"
    NO_EQUILIBRIUM = "no equilibrium gap"
    CHOKING = "choking"
    BLOWN_OPEN = "blown open"
    CONTACT_ARM = "arm of the contact force"
    ENERGY = "energy"
    FLOOR = "pressure floor"
    FLASHING = "flashing"
    HEATING = "heating"
    INERTIA = "inertia of the film"
    ROUGH_FILM = "rough film"
    THIN_FILM = "thin film"
    TURBULENCE = "turbulence"
    WIDE_DAM = "wide dam"
    UNITS = "units"
    WEAR = "wear"


class Caution(NamedTuple):
    """What a person should know of a run before trusting it: code tests the concern, a person reads the sentence."""

    concern: Concern
    sentence: str


class FilmClosed(SceneError):
    """A film that is closed before its run begins: the faces touch there."""


class RunState:
    """A model over `duration` (s): its `intervals`, start `y0` (size,), observers (`extrema`, `contacts`, `stick_slip`
    or None), `reasons` (sentences) and `cautions`, and `last`: the segment's index, time in it (s) and unknowns (size,)
    reached so far; `start` where it starts and why (simulation/selection.py), None if nobody chose."""

    def __init__(self, model: Model, duration: float):
        self.model, self.duration = model, duration
        self.intervals = model.intervals(duration)
        self.y0 = np.zeros(model.unknowns.size)
        self.extrema = ExtremaTracker(model, duration)
        self.contacts = ContactEvents(model, self.extrema)
        self.stick_slip = StickSlip(model) if model.unknowns.coulomb_rings else None
        if model.unknowns.elastic_rings:
            # Loaded only where a seal gives.
            from .secondary_seal import Reversals

            self.stick_slip = Reversals(model)
        remark = model.interface.film.remark
        self.reasons = [*model.unknowns.reasons, *([remark] if remark else []), *model.scene.housing.remarks(duration)]
        for key, motion in (("housing.motion", model.scene.housing.motion), ("shaft.motion", model.scene.shaft.motion)):
            self.reasons += motion.remarks(key) if motion else []
        self.cautions = []
        self.last, self.start = (0, 0.0, self.y0), None
        self._segment = None

    def segment(self, index: int = 0, stuck=None) -> Segment:
        """The equations over the interval `index` (negative: from the end); `stuck` as Segment's in place of how the
        rings are held now.  Where none can stick, the last one is not made twice."""
        index %= len(self.intervals)
        if stuck is None and self.stick_slip:
            stuck = self.stick_slip.held()
        if self.stick_slip or self._segment is None or self._segment.index != index:
            self._segment = self.model.segment(self.intervals[index], index, index + 1 == len(self.intervals), stuck)
        return self._segment

    def anew(self, model: Model | None = None) -> "RunState":
        """The same run before its start, with observers of its own; `model`: in place of its own."""
        other = RunState(model or self.model, self.duration)
        other.y0, other.reasons, other.cautions = self.y0.copy(), list(self.reasons), list(self.cautions)
        other.extrema.windows[1:], other.start = self.extrema.windows[1:], self.start
        other.extrema.steady = self.extrema.steady
        return other

    @cached_property
    def memory(self) -> float:
        """Number of shortest periods for which the linearised scene remembers an error, at most those of the run."""
        speeds = {self.model.speed_at(interval): interval for interval in self.intervals.few}
        rates = [self.model.linear_scene(interval).eigen()[0].real for interval in speeds.values()]
        # A massless undamped ring has no free motion: it forgets at once.
        slowest = max(float(np.max(rate, initial=-np.inf)) for rate in rates)
        longest = self.duration if slowest * self.duration > -1.0 else -1.0 / slowest
        return longest / self.model.shortest_period

    def period(self, index: int = 0) -> float | None:
        """Common period (s) of the forcing from a segment on (Segment.period), None if a sweep is still to come; where
        nothing moves a quarter of the run."""
        begin = self.intervals[index].time
        if any(end(sweep) > begin for _, sweep in sweeps_of(self.model.scene)):
            return None
        period = self.segment(index).period()
        return self.duration / 4 if period == 0.0 else period

    def watch_last_periods(self):
        """Look for extremes in the last two forcing periods apart, for the steady state."""
        period, end, last = self.period(-1), self.duration, self.intervals[-1]
        constant_from = last.time if len(self.intervals) > 1 and not self.model.unknowns.constant else 0.0
        if period and end - 2 * period >= constant_from - 1e-9 * end:
            self.extrema.windows[1:] = [[end - period, end], [end - 2 * period, end - period]]

    def fastest_forcing(self) -> float:
        """Highest angular frequency (rad/s) imposed at any interval's start or end, waves as they pass the other face
        among it; where anything is imposed the shaft speed counts, where nothing is it is 0."""
        scene, fastest, waves = self.model.scene, 0.0, max(highest_orders(self.model.face))
        for interval in self.intervals.few:
            rows = harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, interval)
            for row in rows:
                fastest = max(fastest, abs(row[7]), abs(row[7] + 2 * row[8] * interval.length))
            spins = (constant_and_slope(ring.speed, interval) for ring in (scene.shaft, scene.stator))
            shaft, stator = (np.array([spin, spin + slope * interval.length]) for spin, slope in spins)
            passing = [waves * abs(shaft - stator), abs(shaft) * bool(len(rows))]
            fastest = max(fastest, float(np.max(passing)))
            fastest = max(fastest, fastest_sweep(sweeps_of_segment(scene, interval), interval.length))
        return max([fastest, *(sampled.rate for sampled in splines(scene).values())])

    # --- the start ----------------------------------------------------------------------------------

    def steady_start(self) -> np.ndarray:
        """Unknowns (size,) on the linear steady state at time zero: of what turns and of tones; what samples and sweeps
        impose begins with the run."""
        at, _, _ = self.segment(0).periodic_motion
        q, rate = at(0.0)
        places = self.model.unknowns.among_three()
        q[::3] += pulled_apart(self.model, self.model.start)
        return self.model.vector(q[places], rate[places])

    def start_film(self, y=None) -> float:
        """Thinnest film (m) at the start, or if it were with unknowns `y` (size,)."""
        s = self.segment(0).gap_state(0.0, self.y0 if y is None else y)
        return float(h_min(self.model.face, s)[0])

    def check_start(self):
        """Raises SceneError if the film is closed at the start."""
        low, floor = self.start_film(), self.model.face[COLLAPSE]
        if low <= floor:
            begun = self.start and self.start.taken == "steady"
            none = begun or self.model.no_steady_response() or self.start_film(self.steady_start()) <= floor
            other = "" if none else ', or run.start = "steady"'
            raise FilmClosed(
                "film.clearance",
                f"a film closed at the start ({film_in_words(low)})",
                f"a film above {limit_in_words(floor)}: less tilt or waviness, more clearance{other}",
            )

    def check_loads(self):
        """Warn of loads for which no equilibrium gap is found."""
        for interval in self.intervals.few:
            if not self.model.loads_are_balanced(interval):
                sentence = (
                    f"no equilibrium gap found for the loads from t = {interval.time:.4g} s: linear numbers are at the "
                    "clearance"
                )
                self.cautions.append(Caution(Concern.NO_EQUILIBRIUM, sentence))
                return

    # --- going on -----------------------------------------------------------------------------------

    def modes(self) -> dict:
        """What a continued run needs beside the unknowns: contacts so far ("touching", "contacts"), and which rings
        stick ("sticking")."""
        return {**self.contacts.state(), "sticking": self.stick_slip.state() if self.stick_slip else None}

    def restore_modes(self, modes: dict):
        """Go on from `modes`."""
        self.contacts.restore(modes)
        if self.stick_slip:
            self.stick_slip.restore(modes["sticking"])

    def end_time(self, index: int, tau: float) -> float:
        """Time (s) since the start of the run at time tau of a segment."""
        return self.intervals[index].time + tau
