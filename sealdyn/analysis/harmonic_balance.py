"""Periodic steady state by harmonic balance: a Fourier series whose points obey the equations of motion, of rings alone
and of rings on a film that stores.

The displacements at N points of a period are the unknowns, N odd; rates and accelerations are those of the
trigonometric polynomial through them.  Newton's method makes these the accelerations that the forces give, or the
forces on a ring without mass nothing, and N grows until the last harmonics are nothing.  No time is integrated: neither
a stiff film nor slow decay costs anything.
Points of a film that stores hold its unknowns behind the displacements; each must leave nothing of the residual of its
instant.  Newton's steps are then solved by GMRES, prepared by the mean derivatives along the orbit, for which each
harmonic stands alone: one sparse factorisation a harmonic, and a few products a step.
**Source** Cameron & Griffin (1989), J. Appl. Mech. 56, 149 (forces evaluated in time); Trefethen (2000), Spectral
Methods in MATLAB, ch. 3; Floquet multipliers from the linearisation along the orbit, by collocation at Radau's nodes
(Hairer & Wanner 1996, Solving ODEs II, IV.5), which forgets what decays at once; Saad & Schultz (1986), SIAM J. Sci.
Stat. Comput. 7, 856 (GMRES).
**Valid** forces that hang on the motion of the rings alone, or on unknowns of a film, and are smooth along it, without
fronts of cavities; multipliers of a massless ring that is damped, none on a film that stores.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.optimize import minimize_scalar
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, gmres, splu

from ..dynamics.run_state import RunState
from ..faces.film_thickness import h_min
from ..faces.geometry import COLLAPSE, GX, GY
from ..scene.scene import SceneError
from ..solvers.contract import SolverFailure
from ..solvers.own_methods import RADAU, rule
from .shooting import CLOSED, NoOrbit, Orbit, TooMuchWork, must_be_open, orbit_extremes, periodic

# Harmonics of the fastest forcing to begin with; points of a period at most; share of the last harmonics that must
# fall, each time the points are doubled, for more of them to be worth it.
HARMONICS, MOST, FALLS = 6, 513, 0.3
# The last harmonics, in units of the scales, are nothing at so much of the accuracy, or of this one if they fall that
# far; part of the harmonics that are the last.
SETTLED, SHARP, LAST = 0.1, 1e-9, 0.2
# Newton's steps at most, a step that diverges, and by how much one must be shorter for the slopes to stand; the step of
# differences, in units of the scales.
MOST_STEPS, DIVERGED, CONTRACTS, STEP = 40, 1e3, 0.1, 1e-5
# A guess of thinner films is opened to so much of the clearance; a step leaves at least so much of the film, or is cut
# to this share.
OPEN, KEPT, SHORTEST = 0.05, 0.2, 1e-3
# Looks at an orbit between two points; how well its multipliers are known, and how often the steps are halved for that.
LOOKS, KNOWN, HALVINGS = 8, 1e-9, 6
# A multiplier nearer to one: the orbit is not isolated.
ISOLATED = 1e-10


class NotSmooth(NoOrbit):
    """The orbit is no Fourier series of a few hundred harmonics."""


class HarmonicBalance:
    """Periodic orbits of a scene over `turns` periods of its forcing, from displacements (N, n) at N points of a
    period; `work` right-hand sides so far, at most `most_work`,
    `defects` Newton's steps, in units of the scales.  Other members as of `shooting.Shooter`; its orbits
    have multipliers only `with_multipliers`.  Raises NoOrbit as that, NotSmooth for too many cycles in a period."""

    # Whether the film may store; points of a period and steps of Newton's method at most.
    stores, most, most_steps = False, MOST, MOST_STEPS

    def __init__(self, scene, accuracy: float = 1e-8, turns: int = 1):
        self.model, self.period = periodic(scene, accuracy, turns, self.stores)
        unknowns = self.model.unknowns
        self.segment, self.n = RunState(self.model, self.period).segment(0), unknowns.n
        # Rows of the equations of motion: accelerations, and forces on what has no mass.
        self.places = np.where(unknowns.lacks_inertia, np.arange(self.n), unknowns.rate_places)
        self.heavy = np.flatnonzero(~unknowns.lacks_inertia)
        # A displacement (n,) that opens the gap by one metre, along the axis of the first ring that moves so.
        axial = [name for name in unknowns.names if name.endswith("_z")][:1]
        self.opening = np.array([(1.0 if name == "stator_z" else -1.0) * (name in axial) for name in unknowns.names])
        self.scales, self.pace = self.model.scales[: self.n], self.model.reference_rate
        self.settled, self.sharp = SETTLED * accuracy, SETTLED * min(accuracy, SHARP)
        self.work, self.most_work, self.defects = 0, np.inf, []
        frequencies = [abs(h.frequency) for h in self.segment.harmonics()]
        cycles = max(1, round(max(frequencies, default=0.0) * self.period / (2 * np.pi)))
        self.first = 2 * HARMONICS * cycles + 1
        if self.first > self.most:
            raise NotSmooth("its fastest forcing has too many cycles in a period")

    def times(self, count: int) -> np.ndarray:
        """Points of a period (s)."""
        return self.period * np.arange(count) / count

    def guess(self) -> np.ndarray:
        """The linear steady state at the first points (N, n)."""
        return self._linear()[0]

    def _linear(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and rates (N, n) of the linear steady state at the first points, opened where they would close
        the film."""
        at, places = self.segment.periodic_motion[0], self.model.unknowns.among_three()
        q, rates = (np.array([at(tau)[k][places] for tau in self.times(self.first)]) for k in (0, 1))
        return q + max(OPEN * self.model.clearance - self._film(q), 0.0) * self.opening, rates

    def find(self, guess=None) -> Orbit:
        """The orbit near `guess` (N, n), by default the linear steady state.  Raises NoOrbit; NotSmooth where its
        series does not end; TooMuchWork."""
        points, before = self.guess() if guess is None else guess, np.inf
        while True:
            points, left = self._solved(points)
            tail = self._last_harmonics(points)
            ends = 2 * len(points) > self.most or tail > FALLS * before
            if tail <= (self.settled if ends else self.sharp):
                return must_be_open(self._orbit(points, left))
            if ends:
                raise NotSmooth(f"harmonics of {tail:.1e} of the clearance beyond {len(points) // 2}")
            points, before = self.at(points, self.times(2 * len(points) - 1)), tail

    def _solved(self, points) -> tuple[np.ndarray, float]:
        """Points (N, n) at which nothing is left over, from some nearby, and the last step of Newton's method (units of
        the scales)."""
        kept, before = None, np.inf
        for _ in range(self.most_steps):
            step, kept = self._step(points, kept)
            size = float(np.max(np.abs(step[:, : self.n]) / self.scales))
            self.defects.append(size)
            if not size < DIVERGED:
                break
            share, film = 1.0, max(self._film(points), 0.0)
            while share > SHORTEST and self._film(points - share * step) < KEPT * film:
                share *= 0.5
            points = points - share * step
            if size < 0.1 * self.sharp or (size < self.settled and size > 0.3 * before):
                return points, size
            kept, before = kept if size < CONTRACTS * before and share == 1.0 else None, size
        film = self._film(points) / self.model.clearance
        said = "the forcing is at contact or beyond" if film < CLOSED else "none is near the linear steady state"
        raise NoOrbit(
            f"no periodic orbit is found, the thinnest film of the last trial {film:.1g} of the clearance: {said}"
        )

    def _step(self, points, kept) -> tuple[np.ndarray, Any]:
        """Newton's step (N, n), and its matrix, made ready: `kept` if there is one."""
        left = self._left(points, *self.derivatives(points))
        kept = lu_factor(self._matrix(points)) if kept is None else kept
        if not np.all(np.isfinite(left)):
            return np.full_like(points, np.inf), kept
        return lu_solve(kept, left.ravel()).reshape(points.shape) * self.scales, kept

    def _film(self, points) -> float:
        """Thinnest film (m) at points (N, n)."""
        states = (self.segment.gap_state(tau, self.model.vector(q, 0.0 * q))
                  for tau, q in zip(self.times(len(points)), points[:, : self.n], strict=True))  # fmt: skip
        return min(h_min(self.model.face, s)[0] for s in states)

    def _left(self, points, rates, accelerations) -> np.ndarray:
        """What is left over (N, n) in the equations of motion along displacements, rates and accelerations (N, n)."""
        found, yp, left = np.empty_like(points), np.zeros(self.segment.size), np.empty(self.segment.size)
        film = self.model.interface.unknowns is not None
        for k, tau in enumerate(self.times(len(points))):
            y = self.model.vector(points[k], rates[k])
            if film:
                try:
                    y[self.segment.film] = self.model.interface.steady(self.model.f, self.segment.gap_state(tau, y))
                except SceneError:
                    found[k] = np.nan
                    continue
            if len(self.heavy) == self.n:
                self.segment.ring_rates(tau, y, yp)
                found[k] = accelerations[k] - yp[self.places]
                continue
            yp[: self.n] = rates[k]
            yp[self.places[self.heavy]] = accelerations[k, self.heavy]
            self.segment.residual(tau, y, yp, left)
            found[k] = left[self.places]
        self.work += len(points)
        if self.work > self.most_work:
            raise TooMuchWork("more right-hand sides than this orbit may cost")
        return found

    def slopes(self, points) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (N, n, n) of what is left over by displacements and by rates along points (N, n), in units of the
        scales and the reference rate."""
        rates, accelerations = self.derivatives(points)
        found = []
        for by_rate, size in ((False, self.scales), (True, self.scales * self.pace)):
            columns = []
            for step in np.diag(STEP * size):
                sides = [self._left(points + sign * step * (not by_rate), rates + sign * step * by_rate, accelerations)
                         for sign in (1.0, -1.0)]  # fmt: skip
                columns.append((sides[0] - sides[1]) / (2.0 * STEP))
            found.append(np.stack(columns, axis=-1))
        return found[0], found[1]

    def _matrix(self, points) -> np.ndarray:
        """Newton's matrix (N n, N n), by displacements in units of the scales."""
        count, n = points.shape
        by_place, by_rate = self.slopes(points)
        first, second = self.derivatives(np.eye(count))
        mass = np.zeros((n, n))
        mass[self.heavy, self.heavy] = self.scales[self.heavy]
        matrix = np.einsum("kl,ij->kilj", second, mass) + np.einsum("kl,kij->kilj", first / self.pace, by_rate)
        at = np.arange(count)
        matrix[at, :, at, :] += by_place
        return matrix.reshape(count * n, count * n)

    def derivatives(self, points) -> tuple[np.ndarray, np.ndarray]:
        """First and second derivative in time of points of a period (N, n)."""
        series, turned = (
            np.fft.rfft(points, axis=0),
            2j * np.pi / self.period * np.arange(len(points) // 2 + 1)[:, None],
        )
        return tuple(np.fft.irfft(turned**k * series, len(points), axis=0) for k in (1, 2))

    def at(self, points, times) -> np.ndarray:
        """The trigonometric polynomial through points (N, ...) of a period at times (m,) (s)."""
        series = np.fft.rfft(points, axis=0) / len(points)
        series[1:] *= 2.0
        turned = np.exp(2j * np.pi / self.period * np.outer(times, np.arange(len(series))))
        return np.tensordot(turned, series, axes=1).real

    def _last_harmonics(self, points) -> float:
        """Largest of the last harmonics, in units of the scales."""
        series = np.abs(np.fft.rfft(points / self.model.scales[: points.shape[1]], axis=0)) * 2.0 / len(points)
        return float(np.max(series[-max(2, int(LAST * len(series))) :]))

    # --- what an orbit is like ------------------------------------------------------------------------------

    def _orbit(self, points, left: float) -> Orbit:
        rates, n = self.derivatives(points)[0], self.n
        start = self.model.vector(points[0, :n], rates[0, :n])[: self.model.unknowns.n_mechanical]
        return Orbit(self.period, start, None, None, left, 0, self.extremes(points), points)

    def extremes(self, points, per_period: int | None = None) -> dict:
        """As `Shooter.extremes`, of points (N, n)."""
        points = points[:, : self.n]
        rates = self.derivatives(points)[0]

        def seen(tau):
            q, rate = self.at(points, [tau])[0], self.at(rates, [tau])[0]
            s = self.segment.gap_state(tau, self.model.vector(q, rate))
            return (*h_min(self.model.face, s), float(np.hypot(s[GX], s[GY])))

        times = self.times(LOOKS * len(points))
        looks = np.array([seen(tau) for tau in times])

        def least(column, sign=1.0):
            """Time (s) at which a column is least."""
            about, reach = times[np.argmin(sign * looks[:, column])], times[1]
            found = minimize_scalar(lambda tau: sign * seen(tau)[column], bounds=(about - reach, about + reach),
                                    method="bounded", options={"xatol": 1e-9 * self.period})  # fmt: skip
            return float(found.x if found.fun < sign * seen(about)[column] else about)

        time = least(0)
        *low, _ = seen(time)
        tilts = seen(least(3, -1.0))[3], seen(least(3))[3]
        closed = bool(low[0] <= self.model.face[COLLAPSE])
        found = orbit_extremes(self.model, low, time % self.period, *tilts, closed)
        if per_period:
            found["times"] = self.period * np.arange(per_period + 1) / per_period
            found["displacements"], found["rates"] = self.at(points, found["times"]), self.at(rates, found["times"])
        return found

    def with_multipliers(self, orbit: Orbit) -> Orbit:
        """The orbit with its monodromy matrix and multipliers.  Raises NoOrbit where one of these is one."""
        rates = self._rates(*self.slopes(orbit.points))
        steps, before = len(orbit.points), None
        for _ in range(HALVINGS):
            matrix = self._monodromy(rates, steps)
            values = np.linalg.eigvals(matrix)
            largest = float(np.max(np.abs(values)))
            if before is not None and abs(largest - before) < KNOWN * largest:
                break
            steps, before = 2 * steps, largest
        if np.min(np.abs(1.0 - values)) < ISOLATED:
            raise NoOrbit("a multiplier is one: the orbit is not isolated (no damping, or a bifurcation)")
        return replace(orbit, monodromy=matrix, multipliers=values)

    def _rates(self, by_place, by_rate) -> np.ndarray:
        """Rates (N, m, m) of small disturbances of an orbit, unknowns and all in units of the scales."""
        n, size, heavy = self.n, self.model.unknowns.n_mechanical, self.heavy
        light, found = np.setdiff1d(np.arange(n), heavy), np.zeros((len(by_place), size, size))
        # What is left over, by the unknowns: displacements, and rates of what has mass.
        left = np.zeros((len(by_place), n, size))
        left[:, :, :n] = by_place
        left[:, :, self.places[heavy]] += by_rate[:, :, heavy]
        found[:, heavy, self.places[heavy]] = self.pace
        if len(light):
            held = by_rate[:, light[:, None], light]
            found[:, light] = -self.pace * np.linalg.solve(held, left[:, light])
            left[:, heavy] += by_rate[:, heavy[:, None], light] @ found[:, light] / self.pace
        found[:, self.places[heavy]] = -left[:, heavy] / (self.scales[heavy] * self.pace)[:, None]
        return found

    def _monodromy(self, rates, steps: int) -> np.ndarray:
        """Product over a period of the solutions of x' = A x, `rates` A (N, m, m) along it."""
        c, a, *_ = rule(RADAU, True)
        step, m = self.period / steps, rates.shape[1]
        stages = self.at(rates, step * np.add.outer(np.arange(steps), c).ravel()).reshape(steps, len(c), m, m)
        # Of the stages Z: Z_i = x + step sum_j a_ij A_j Z_j, the last one being the end.
        whole = np.eye(len(c) * m) - step * np.einsum("ij,kjab->kiajb", a, stages).reshape(steps, len(c) * m, -1)
        ends = np.linalg.solve(whole, np.tile(np.eye(m), (len(c), 1)))[:, -m:]
        found = np.eye(m)
        for one in ends:
            found = one @ found
        return found

    def multiplier(self, orbit: Orbit) -> float:
        """Largest modulus of the Floquet multipliers of an orbit."""
        return float(np.max(np.abs(self.with_multipliers(orbit).multipliers)))


# How well a step of Newton's method is solved, and products of a matrix that it may take.
SOLVED, RESTART, MOST_RESTARTS = 1e-4, 60, 3
# Accuracy of an orbit at least, of the film's unknowns too.
NEAR = 1e-3
# Clearances by which a guess is opened until its film has a solution.
WIDER = (0.0, 0.1, 0.3, 1.0, 3.0)


class FilmBalance(HarmonicBalance):
    """As HarmonicBalance; points (N, m) are displacements and all other unknowns of rings and film."""

    stores, most, most_steps = True, 97, 15

    def __init__(self, scene, accuracy: float = NEAR, turns: int = 1):
        super().__init__(scene, min(accuracy, NEAR), turns)
        # Cells are not smooth enough for more than is asked.
        self.sharp = self.settled

    def guess(self) -> np.ndarray:
        """The linear steady state of the rings, opened as far as it takes, and at each point the film that would be
        steady there (N, m)."""
        motion, rates = self._linear()
        for wider in WIDER:
            found = []
            try:
                for tau, q, rate in zip(self.times(self.first), motion, rates, strict=True):
                    y = self.model.vector(q + wider * self.model.clearance * self.opening, rate)
                    self.segment.settle_film(tau, y)
                    found.append(y[: self.segment.film.stop])
                return np.array(found)
            except SceneError as reason:
                why = reason
        raise NoOrbit(f"the film has no solution along the linear steady state: {why}")

    def _step(self, points, kept):
        count, m = points.shape
        try:
            left, parts = self._residuals(points)
        except SolverFailure as reason:
            raise NoOrbit(f"no periodic orbit is found: {reason}") from None
        mean = [sum(pair[k] for pair in parts) / count for k in (0, 1)]
        pace = 2.0 * np.pi / self.period
        try:
            alone = [splu((mean[0] + 1j * pace * k * mean[1]).tocsc()) for k in range(count // 2 + 1)]
        except RuntimeError as reason:
            raise NoOrbit(f"no periodic orbit is found: {reason}") from None

        def product(x):
            held = x.reshape(count, m)
            rates = self.derivatives(held)[0]
            return np.concatenate([a @ one + b @ rate for (a, b), one, rate in zip(parts, held, rates, strict=True)])

        def prepared(x):
            series = np.fft.rfft(x.reshape(count, m), axis=0)
            solved = np.array([one.solve(part) for one, part in zip(alone, series, strict=True)])
            return np.fft.irfft(solved, count, axis=0).ravel()

        whole = LinearOperator((count * m, count * m), matvec=lambda x: product(prepared(x)))
        # A step that is solved less well is a step, too.
        found, _ = gmres(whole, left.ravel(), rtol=SOLVED, restart=RESTART, maxiter=MOST_RESTARTS)
        return prepared(found).reshape(count, m) * self.model.scales[:m], None

    def _residuals(self, points):
        """Residuals (N, m), and of each point their derivatives by unknowns and by rates, in units of the scales."""
        segment, m, scales = self.segment, points.shape[1], self.model.scales
        left, parts, rates = np.empty_like(points), [], self.derivatives(points)[0]
        y, yp, residual, data = (np.zeros(size) for size in (*[segment.size] * 3, segment.pattern.nnz))
        for k, tau in enumerate(self.times(len(points))):
            y[:m], yp[:m] = points[k], rates[k]
            segment.residual(tau, y, yp, residual)
            left[k], pair = residual[:m], []
            for by_rate, by_place in ((0.0, 1.0), (1.0, 0.0)):
                segment.residual_derivatives(tau, y, yp, by_rate, data, by_place)
                whole = csc_array((data, segment.pattern.indices, segment.pattern.indptr), shape=segment.pattern.shape)
                pair.append(csc_array(whole[:m, :m].multiply(scales[:m])).tocsr())
            parts.append(pair)
        self.work += len(points)
        if self.work > self.most_work:
            raise TooMuchWork("more residuals than this orbit may cost")
        return left, parts

    def with_multipliers(self, orbit: Orbit) -> Orbit:
        """The orbit itself: its multipliers are not known."""
        return orbit

    def multiplier(self, orbit: Orbit) -> None:
        """Not known."""
        return None
