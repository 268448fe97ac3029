"""Periodic steady state by shooting, or as a point where it only turns, and its Floquet multipliers.

**Source** Newton's method on the period map P(x) = x (Nayfeh & Balachandran, Applied Nonlinear Dynamics, 1995,
sec. 5.2); the multipliers are the eigenvalues of dP/dx at the orbit, and the orbit is stable when all lie inside
the unit circle.  The derivative comes from fourth-order central differences of the flow.
**Valid** constant conditions and commensurate forcing; a scene without forcing has its rest state as orbit.
What is forced at one speed alone, faces alike all around, turns as a whole: in the frame of the forcing its steady
state is a point (`ForcedWave`; Golubitsky, Stewart & Schaeffer 1988, ch. XVI), also of a film that stores.
"""

from dataclasses import dataclass

import numpy as np

from ..dynamics.extrema import H_RADIUS, H_TAU, H_THETA, LEAST, MOST, H
from ..dynamics.imposed_motion import OWN, TURNING
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..faces.film_thickness import h_min
from ..faces.geometry import COLLAPSE, DZ_RATE, GX, GX_RATE, GY, GY_RATE, MEAN_SPIN
from ..scene.patterns import face_orders
from ..scene.scene import SceneError, uneven_supports
from ..simulation.selection import choose_method
from ..solvers.contract import Counts, Recorder, SolverFailure, Status
from ..solvers.integrate import solve
from ..solvers.methods import METHODS
from .rotating_wave import SPEED_AT, STEP, RotatingWave

TIGHT = 1e-13
# Differences of the flow: steps in units of the scales.  The error is the fourth power of the step plus the
# integrator's tolerance over the step.
DIFFERENCE = 3e-3
# Right-hand sides that each of its fastest forcing periods may cost; a healthy one takes some hundreds.
CRAWLING = 10_000
# Share of the clearance below which a film has closed.
CLOSED = 0.01
# Tolerances, by method: BDF errs more than its tolerance; and the finest that rounding leaves to each.
SHARPER, FINEST = {"bdf": 1e-2}, {"ida": 1e-11, "bdf": 1e-12}
# Newton's steps to the point of a forcing's frame, and the last of them, in units of the scales.
MOST_POINTS, POINT = 25, 1e-12
# Scale of an unknown whose error is free.
FREE = 1e30
WEIGHTS = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))


class NoOrbit(ValueError):
    """There is no isolated periodic orbit, or Newton did not find it: the sentence says which."""


class NotOneSpeed(NoOrbit):
    """The forcing does not turn at one speed alone."""


class TooMuchWork(NoOrbit):
    """An orbit costs more than it may."""


class _Crawls(NoOrbit):
    """A period takes too many steps: given up after a `share` of it, the film then `film` of the clearance."""

    def __init__(self, share: float, film: float):
        self.film = film
        if film < CLOSED:
            said = f"a trial motion closes the film ({film:.1g} of the clearance): the forcing is at contact or beyond"
        else:
            said = (f"a trial motion takes too many steps, {share:.2g} of a period done, its film {film:.2g} of the "
                    "clearance: too stiff or too fast to follow")  # fmt: skip
        super().__init__(f"{said}; a run in time shows whether it settles")


@dataclass(frozen=True)
class Orbit:
    """A periodic steady state: period (s), mechanical unknowns (n,) at its start, monodromy matrix (n, n) in units of
    the scales and its eigenvalues (n,), None where they were not asked for, what Newton left (in units of the scales),
    periods integrated on the way, the extremes over the orbit (`Shooter.extremes`), and of harmonic balance its
    `points`, displacements (N, n) over the period."""

    period: float
    start: np.ndarray
    monodromy: np.ndarray | None
    multipliers: np.ndarray | None
    residual: float
    periods_used: int
    extremes: dict
    points: np.ndarray | None = None

    @property
    def stable(self) -> bool:
        """All multipliers inside the unit circle."""
        return bool(np.max(np.abs(self.multipliers)) < 1.0)


def orbit_extremes(model: Model, low: tuple, time: float, most: float, least: float, collapsed: bool) -> dict:
    """As `Shooter.extremes`, of the thinnest film `low` (m, with its theta (rad) and radius (m)) at a `time` (s), and
    the most and least relative misalignment (rad)."""
    value, theta, radius = low
    place = {"value": value, "time": time, "theta": theta, "radius": radius, "of_clearance": value / model.clearance}
    return {"h_min": place, "relative_misalignment": {"max": most, "min": least}, "collapsed": collapsed}


def must_be_open(orbit: Orbit) -> Orbit:
    """The orbit itself.  Raises NoOrbit for one of a film that is closed, which is no motion of the seal."""
    if orbit.extremes["collapsed"]:
        share = orbit.extremes["h_min"]["of_clearance"]
        raise NoOrbit(f"the orbit closes the film ({share:.1g} of the clearance): the forcing is at contact or beyond")
    return orbit


def periodic(scene, accuracy: float, turns: int = 1, stores: bool = False) -> tuple[Model, float]:
    """Model of a scene, and its period (s): `turns` times that of the forcing.  Raises NoOrbit if there is none, a ring
    sticks, or the film `stores` more than was asked for."""
    probe = RunState(Model(scene, accuracy), 1.0)
    period = probe.period()
    if period is None or not probe.model.unknowns.constant:
        raise NoOrbit("no common period: forcing frequencies are incommensurate, or conditions change with time")
    if probe.stick_slip:
        raise NoOrbit("a secondary seal that sticks and slips has no smooth period map: run it in time")
    if probe.model.interface.stores and not stores:
        raise NoOrbit("a film that stores has more to its period map than the motion of the rings: run it in time")
    return probe.model, float(turns * period)


class Shooter:
    """The period map of a scene, over `turns` periods of its forcing, integrated at the tolerance `tight`; `size` n of
    its points: the mechanical unknowns, of a massless ring the displacements, and their `scales` (n,); `flows`, `work`:
    periods and right-hand sides so far, the latter at most `most_work`; `defects` what each step of Newton's method
    found, in units of the scales.
    Raises NoOrbit if the forcing has no common period, a ring sticks or the film stores."""

    def __init__(self, scene, accuracy: float = 1e-8, turns: int = 1, tight: float = TIGHT):
        self.scene, self.accuracy, self.tight = scene, accuracy, tight
        self.model, self.period = periodic(scene, accuracy, turns)
        # Nobody asks for the works here, and where next to nothing moves their tolerance is below all rounding.
        self.model.scales[self.model.unknowns.works] = FREE
        # SciPy's Runge-Kutta keeps 1e-13 over a period; a massless or stiff ring needs an implicit method.
        method, _ = choose_method(RunState(self.model, self.period))
        self.method = {"adams": "dop853"}.get(method, method)
        unknowns = self.model.unknowns
        n = unknowns.n if unknowns.massless else unknowns.n_mechanical
        self.size, self.scales = n, self.model.scales[:n]
        self.flows, self.work, self.most_work, self.defects = 0, 0, np.inf, []

    def flow(self, start: np.ndarray) -> np.ndarray:
        """The unknowns (n,) one period later.  Raises NoOrbit where the map crawls, SolverFailure."""
        try:
            return self._flow(start)
        except _Crawls as crawl:
            # Explicit steps on an open film that is stiff after all.
            if self.method != "dop853" or crawl.film < CLOSED:
                raise
        self.method = "bdf"
        return self._flow(start)

    def _flow(self, start):
        segment = RunState(self.model, self.period).segment(0).until(self.period)
        y = np.zeros(segment.size)
        y[: self.size] = start
        self.flows += 1
        tolerance = max(self.tight * SHARPER.get(self.method, 1.0), FINEST.get(self.method, 0.0))
        counts = Counts()
        try:
            for tau, block, _ in METHODS[self.method](segment, 0.0, y, self.method, tolerance, counts):
                last = block[-1]
                if counts.rhs > CRAWLING * max(1.0, self.period / segment.shortest_period):
                    film = h_min(self.model.face, segment.gap_state(tau[-1], last))[0] / self.model.clearance
                    raise _Crawls(tau[-1] / self.period, film)
                if self.work + counts.rhs > self.most_work:
                    raise TooMuchWork("more right-hand sides than this orbit may cost")
        finally:
            self.work += counts.rhs
        return last[: self.size].copy()

    def monodromy(self, start: np.ndarray) -> np.ndarray:
        """Derivative of the period map at `start` (n,), (n, n), in units of the scales."""
        matrix = np.empty((self.size, self.size))
        for j in range(self.size):
            column = np.zeros(self.size)
            for steps, weight in WEIGHTS:
                moved = start.copy()
                moved[j] += steps * DIFFERENCE * self.scales[j]
                column += weight * self.flow(moved)
            matrix[:, j] = column / DIFFERENCE / self.scales
        return matrix

    def guess(self) -> np.ndarray:
        """The linear steady state (n,) at the start of the period."""
        return RunState(self.model, self.period).steady_start()[: self.size]

    def find(self, guess=None, monodromy=None, target: float = 1e-11, most: int = 12) -> Orbit:
        """Newton from `guess` (n,) (default: the linear steady state) until the defect is below `target` (in units of
        the scales), in `most` steps.  A `monodromy` (n, n) handed in is used unchanged as long as it contracts (chord
        method) and is then the orbit's; its multipliers are those of that matrix.  Raises NoOrbit."""
        x = self.guess() if guess is None else np.array(guess, dtype=float)
        frozen = monodromy is not None
        before = np.inf
        begun = self.flows
        for _ in range(most):
            try:
                defect = (self.flow(x) - x) / self.scales
            except SolverFailure as failure:
                raise NoOrbit(f"the period map failed: {failure}") from None
            size = float(np.max(np.abs(defect)))
            self.defects.append(size)
            if not np.isfinite(size) or size > 1e3:
                raise NoOrbit("Newton diverged: no periodic orbit near the linear steady state")
            # Below the target, or at the integrator's own noise.
            if size < target or (size < 1e3 * target and size > 0.3 * before):
                break
            if monodromy is None or (frozen and size > 0.2 * before):
                monodromy, frozen = self.monodromy(x), False
            elif not frozen:
                monodromy = self.monodromy(x)
            x = x + self._correction(monodromy, defect) * self.scales
            before = size
        else:
            raise NoOrbit(f"Newton did not converge in {most} steps (defect {size:.1e} of the scales)")
        if monodromy is None:
            monodromy = self.monodromy(x)
        values = np.linalg.eigvals(monodromy)
        return Orbit(self.period, x, monodromy, values, size, self.flows - begun, self.extremes(x))

    def multiplier(self, orbit: Orbit) -> float:
        """Largest modulus of the Floquet multipliers of an orbit, by a monodromy of its own."""
        return float(np.max(np.abs(np.linalg.eigvals(self.monodromy(orbit.start)))))

    def _correction(self, monodromy, defect):
        matrix = np.eye(self.size) - monodromy
        if np.min(np.abs(np.linalg.eigvals(matrix))) < 1e-10:
            raise NoOrbit("a multiplier is one: the orbit is not isolated (no damping, or a bifurcation)")
        return np.linalg.solve(matrix, defect)

    def extremes(self, start: np.ndarray, per_period: int | None = None, accuracy: float | None = None) -> dict:
        """Located extremes over one period from `start` (n,): `h_min` {value (m), time (s), theta (rad), radius (m),
        of_clearance}, `relative_misalignment` {max, min} (rad), `collapsed`; with `per_period` also that many samples:
        `times` (m,) (s), `displacements` and `rates` (m, n).  `accuracy` of this period is by default the
        shooter's."""
        run = RunState(self.model, self.period)
        run.y0[: self.size] = start
        recorder = Recorder(self.period / per_period if per_period else None)
        method = "ida" if run.model.unknowns.has_residual_form else choose_method(run)[0]
        outcome = solve(run, method, self.accuracy if accuracy is None else accuracy, recorder)
        low, theta, radius, time, most, least = map(
            float, run.extrema.records[0, [H, H_THETA, H_RADIUS, H_TAU, MOST, LEAST]]
        )
        closed = outcome.status == Status.COLLAPSED
        found = orbit_extremes(run.model, (low, theta, radius), time, most, least, closed)
        if per_period:
            found["times"], found["displacements"], found["rates"] = recorder.arrays()
        return found


class ForcedWave:
    """Steady states of a scene whose forcing turns at one `speed` (rad/s, 0 if it stands), as points of the frame that
    turns with it, where nothing moves: no time is integrated.  Members as of `Shooter`; its orbits have neither
    monodromy nor multipliers, of which `multiplier` tells the largest.  **Valid** films that entrain what they store.
    Raises NotOneSpeed where the forcing needs more than one frame, a ring has no mass or sticks."""

    def __init__(self, scene, accuracy: float = 1e-8):
        self.model, self.work = Model(scene, accuracy), 0
        self.segment, unknowns = self.model.segment(), self.model.unknowns
        kinds, speeds = self.segment.rows[:, 1], set(self.segment.rows[:, 7])
        one = self.segment.harmonic and unknowns.constant and np.all(np.isin(kinds, (OWN, TURNING)))
        self.turning = self.model.interface.film.frame
        if self.turning is not None:
            # A pattern has to turn with the forcing.
            speeds.add(self.turning(self.model.f, self.segment.gap_state(0.0, np.zeros(self.segment.size))))
        elif face_orders(scene) or uneven_supports(scene):
            one = False
        if not one or len(speeds) > 1 or unknowns.massless or unknowns.coulomb_rings or unknowns.elastic_rings:
            raise NotOneSpeed("the forcing does not turn at one speed alone")
        self.speed = speeds.pop() if speeds else 0.0
        self.wave = RotatingWave(self.model)
        self.scales = self.wave.scales

    def state(self, q: np.ndarray) -> np.ndarray:
        """Unknowns (size,) of displacements `q` (n,) that turn with the forcing, a film of its own steady there."""
        y = self.wave.state(q, self.speed)
        if self.model.interface.unknowns is not None:
            s = self.segment.gap_state(0.0, y).copy()
            if self.turning is None:
                # In this frame no gap moves, and the faces drag the fluid by so much less.
                s[[DZ_RATE, GX_RATE, GY_RATE]] = 0.0
                s[MEAN_SPIN] -= self.speed
            y[self.segment.film] = self.model.interface.steady(self.model.f, s)
        return y

    def _unbalance(self, x):
        """Accelerations left over (n,), scaled; not numbers where the film has no solution."""
        q, yp = x * self.scales, np.empty(self.segment.size)
        try:
            self.segment.ring_rates(0.0, self.state(q), yp)
        except SceneError:
            return np.full(len(x), np.nan)
        self.work += 1
        turning = self.speed**2 * self.wave.turned(self.wave.turned(q))
        return (yp[self.wave.places] - turning) / (self.scales * self.wave.pace**2)

    def guess(self) -> np.ndarray:
        """The linear steady state (n,) at the start."""
        return RunState(self.model, 1.0).steady_start()[: self.model.unknowns.n_mechanical]

    def find(self, guess=None) -> Orbit:
        """The point near `guess` (n,) (default: the linear steady state), by Newton's method until its steps are below
        POINT, in units of the scales.  Raises NoOrbit."""
        x, last = (self.guess() if guess is None else guess)[: self.wave.n] / self.scales, np.inf
        for _ in range(MOST_POINTS):
            left, matrix = self._unbalance(x), np.empty((len(x), len(x)))
            for j in range(len(x)):
                moved = np.zeros(len(x))
                moved[j] = STEP
                matrix[:, j] = (self._unbalance(x + moved) - self._unbalance(x - moved)) / (2 * STEP)
            if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(left))):
                break
            try:
                step = np.linalg.solve(matrix, left)
            except np.linalg.LinAlgError:
                break
            x, before, last = x - step, last, float(np.max(np.abs(step)))
            # To rounding, of which a stiff film leaves more.
            if last < POINT or (last < 1e3 * POINT and last > 0.3 * before):
                return must_be_open(self._orbit(x * self.scales, last))
        raise NoOrbit("no point of the forcing's frame is found where the rings are in balance")

    def _orbit(self, q, residual) -> Orbit:
        y = self.state(q)
        s = self.segment.gap_state(0.0, y)
        low, tilt = h_min(self.model.face, s), float(np.hypot(s[GX], s[GY]))
        extremes = orbit_extremes(self.model, low, 0.0, tilt, tilt, bool(low[0] <= self.model.face[COLLAPSE]))
        start, period = y[: self.model.unknowns.n_mechanical], RunState(self.model, 1.0).period()
        return Orbit(period, start, None, None, residual, 0, extremes)

    def relative(self, orbit) -> complex:
        """Relative tilt g_x + i g_y (rad) of an orbit at the forcing's start."""
        s = self.segment.gap_state(0.0, self.state(orbit.start[: self.wave.n]))
        return complex(s[GX], s[GY])

    def multiplier(self, orbit) -> float | None:
        """Largest modulus of the Floquet multipliers of an orbit; None of a film that stores."""
        if self.model.interface.stores:
            return None
        values = self.wave.disturbances(self.state(orbit.start[: self.wave.n]), self.speed, self.segment.p[SPEED_AT])
        return float(np.exp(np.max(values.real) * orbit.period))
