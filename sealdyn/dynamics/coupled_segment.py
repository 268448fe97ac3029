"""Rings and a film with unknowns of its own over a stretch of time: residual, its derivatives, consistent starts."""

from functools import cached_property

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from ..faces import contact
from ..faces.film_thickness import h_min
from ..faces.geometry import FORCE, MOMENT_X, MOMENT_Y, OUTER_RADIUS
from ..films._unknowns import FilmDerivatives
from ..solvers.contract import SolverFailure
from . import equations
from .segments import Segment

# Newton's steps to a consistent start, and the change relative to the scales at which it has arrived.
MOST_STEPS, ARRIVED = 12, 1e-12


class CoupledSegment(Segment):
    """A Segment whose film has unknowns: it has a residual and its derivatives, and no right-hand side (SolverFailure);
    `ring_rates` are those of the rings at given unknowns of the film.  The residual raises SolverFailure with the
    film's sentence where the film has no solution."""

    def _bind(self):
        model, at, p, w, s = self.model, self.film, self.p, self.w, self.s
        film, f, block = model.interface.film, model.f, model.contact
        self._of_film = FilmDerivatives(film, model.unknowns.film_unknowns, f)
        count = at.stop - at.start
        x, x_rate, rest, work = np.empty(count), np.empty(count), np.empty(count), np.zeros(self.size)

        def loads(tau, y, yp):
            equations.kinematics(tau, y, yp, p, w, s)
            x[:] = y[at]
            film.wrench(f, s, x)
            if block is not None:
                contact.contact_load(block, f, s)

        def residual(tau, y, yp, res):
            loads(tau, y, yp)
            equations.residual(tau, y, yp, p, w, s, work, res)
            x_rate[:] = yp[at]
            code = film.residual(f, s, x, x_rate, rest)
            if code:
                raise SolverFailure(f"{film.STATUS[code]} (at {tau:.6g} s into this segment)")
            res[at] = rest

        def rhs(tau, y, yp):
            raise SolverFailure("a film with unknowns of its own has no rates: only the residual form (IDA)")

        def ring_rates(tau, y, yp):
            loads(tau, y, yp)
            equations.rates(tau, y, p, w, s, yp)

        self.rhs, self.ring_rates, self._loads, self.residual = rhs, ring_rates, loads, residual

    # A film with unknowns is evaluated by Python.
    native = None

    # --- derivatives --------------------------------------------------------------------------------

    @cached_property
    def pattern(self) -> csc_array:
        """Where the residual's derivative may differ from zero, (size, size): the columns of the rings whole, of the
        film's unknowns its own block, the rings' rows and the works', of the works the diagonal."""
        m, n, size = self.n_mechanical, self.film.stop - self.film.start, self.size
        own, measures = self.model.unknowns.film_unknowns.pattern, np.arange(self.film.stop, size)
        columns = [np.arange(size)] * m
        for j in range(n):
            rows = m + own.indices[own.indptr[j] : own.indptr[j + 1]]
            columns.append(np.concatenate([np.arange(m), rows, measures]))
        columns += [np.array([i]) for i in measures]
        # SuperLU_MT counts in 32 bits.
        indptr = np.concatenate([[0], np.cumsum([len(rows) for rows in columns])]).astype(np.int32)
        indices = np.concatenate(columns).astype(np.int32)
        return csc_array((np.ones(len(indices)), indices, indptr), shape=(size, size))

    @cached_property
    def _places(self):
        """Places among the pattern's values: of the film's block, and of the rows of rings and works (n, rows)."""
        m, n = self.n_mechanical, self.film.stop - self.film.start
        own, starts = self.model.unknowns.film_unknowns.pattern, self.pattern.indptr[m : m + n]
        counts, measures = np.diff(own.indptr), self.size - self.film.stop
        block = np.concatenate([np.arange(c) + a + m for a, c in zip(starts, counts, strict=True)])
        above = starts[:, None] + np.arange(m)
        below = (starts + m + counts)[:, None] + np.arange(measures)
        return block, np.hstack([above, below])

    def residual_derivatives(self, tau, y, yp, alpha, data, by_y=1.0):
        """`by_y` d res / d y + `alpha` d res / d y' at segment time `tau` (s), the values `data` (nnz,) of the pattern.
        The rings' columns are differences of the whole residual; the film's are its own, and its force's into the
        rings' rows."""
        m, size, at = self.n_mechanical, self.size, self.film
        base, moved = np.empty(size), np.empty(size)
        y, yp, data[:] = y.copy(), yp.copy(), 0.0
        self.residual(tau, y, yp, base)
        s, force = self.s.copy(), self.s[[FORCE, MOMENT_X, MOMENT_Y]]
        for j in range(m):
            step = 1e-7 * max(abs(y[j]), self.scales[j]) / max(by_y, alpha / self.reference_rate)
            before = y[j], yp[j]
            y[j], yp[j] = y[j] + by_y * step, yp[j] + alpha * step
            self.residual(tau, y, yp, moved)
            data[size * j : size * (j + 1)] = (moved - base) / step
            y[j], yp[j] = before
        block, rows = self._places
        # From here `s` is that of the base again.
        self._loads(tau, y, yp)
        x, x_rate = y[at].copy(), yp[at].copy()
        if not by_y:
            data[block] = self._of_film.residual(s, x, x_rate, 1.0)
            data[block] -= self._of_film.residual(s, x, x_rate, 0.0)
            data[block] *= alpha
        else:
            data[block] = self._of_film.residual(s, x, x_rate, alpha)
            others = np.concatenate([np.arange(m), np.arange(at.stop, size)])
            data[rows] = (self._by_force(tau, y, yp, force)[others] @ self._of_film.wrench(s, x)).T
        data[self.pattern.indptr[at.stop] :] = alpha

    def _by_force(self, tau, y, yp, force):
        """Derivatives (size, 3) of the rings' and works' rows by the film's force and moments."""
        s, work, columns = self.s, np.zeros(self.size), np.zeros((self.size, 3))
        base, moved = np.zeros(self.size), np.zeros(self.size)
        equations.residual(tau, y, yp, self.p, self.w, s, work, base)
        # Short: the sum of absolute works has kinks.
        step = 1e-6 * max(abs(force[0]), 1.0) * np.array([1.0, self.model.f[OUTER_RADIUS], self.model.f[OUTER_RADIUS]])
        for k, slot in enumerate((FORCE, MOMENT_X, MOMENT_Y)):
            s[slot] = force[k] + step[k]
            equations.residual(tau, y, yp, self.p, self.w, s, work, moved)
            columns[:, k] = (moved - base) / step[k]
            s[slot] = force[k]
        return columns

    # --- starts -------------------------------------------------------------------------------------

    def settle_film(self, tau, y):
        """Film unknowns of `y` as those of the steady film at the gap state there."""
        y[self.film] = self.model.interface.steady(self.model.f, self.gap_state(tau, y))

    def start(self, tau, y):
        """Consistent unknowns and derivatives, each (size,), from `y` at segment time `tau` (s): Newton on the residual
        for the algebraic unknowns of the film and the derivatives of all others.  Displacements without mass and
        damping stay as they are."""
        y, yp, res = y.copy(), np.zeros(self.size), np.empty(self.size)
        held = [i for i in self.algebraic if i < self.n]
        free = np.setdiff1d(np.arange(self.size), held)
        algebraic = np.array([i for i in self.algebraic if i >= self.film.start], dtype=int)
        scale = self.scales * self.reference_rate
        scale[algebraic] = self.scales[algebraic]
        kept = np.isin(np.arange(self.size), algebraic).astype(float)
        for _ in range(MOST_STEPS):
            by_y, by_rate = (self._matrix(tau, y, yp, *weights) for weights in ((0.0, 1.0), (self.reference_rate, 0.0)))
            mixed = by_y.multiply(scale * kept) + by_rate.multiply(scale / self.reference_rate * (1.0 - kept))
            self.residual(tau, y, yp, res)
            change = splu(csc_array(mixed.tocsc()[np.ix_(free, free)])).solve(-res[free])
            step = np.zeros(self.size)
            step[free] = change * scale[free]
            y += step * kept
            yp += step * (1.0 - kept)
            if np.max(np.abs(change)) < ARRIVED:
                break
        return y, yp

    def _matrix(self, tau, y, yp, alpha, by_y):
        data = np.empty(self.pattern.nnz)
        self.residual_derivatives(tau, y, yp, alpha, data, by_y)
        return csc_array((data, self.pattern.indices, self.pattern.indptr), shape=self.pattern.shape)

    # --- stored steps -------------------------------------------------------------------------------

    def derivatives(self, taus, ys):
        """Derivatives (m, size) at times and unknowns `ys` (m, size), zero for the film's; every ring has mass."""
        out = np.zeros((len(taus), self.size))
        for tau, y, yp in zip(taus, ys, out, strict=True):
            self.ring_rates(tau, y, yp)
        return out

    def states(self, taus, ys, yps, gaps, scratch, low):
        """As kernels.states_along, into `gaps`, `scratch` and `low`, with the film's unknowns among `ys` (m, size)."""
        model, s, rates = self.model, self.s, np.zeros(self.size)
        for i, tau in enumerate(taus):
            equations.kinematics(tau, ys[i], yps[i], self.p, self.w, s)
            model.interface.film.flow(model.f, s, ys[i, self.film])
            if model.contact is not None:
                contact.contact_load_and_friction(model.contact, model.f, s)
            equations.rates(tau, ys[i], self.p, self.w, s, rates)
            gaps[i], scratch[i], low[i] = s, self.w, h_min(model.face, s)
