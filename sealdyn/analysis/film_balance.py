"""Periodic steady state of rings on a film that stores, by harmonic balance of both together.

Points of a period hold the film's unknowns behind the displacements; each must leave nothing of the residual of its
instant.  Newton's steps are solved by GMRES, prepared by the mean derivatives along the orbit, for which each harmonic
stands alone: one sparse factorisation a harmonic, and a few products a step.
**Source** Saad & Schultz (1986), SIAM J. Sci. Stat. Comput. 7, 856 (GMRES); the rest as in harmonic_balance.py.
**Valid** films whose residual is smooth along the orbit: without fronts of cavities.  Nothing is told of multipliers.
"""

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, gmres, splu

from ..scene.scene import SceneError
from ..solvers.contract import SolverFailure
from .harmonic_balance import HarmonicBalance
from .shooting import NoOrbit, Orbit, TooMuchWork

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
