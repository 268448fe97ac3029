"""Rings and a film with unknowns of its own over a stretch of time: residual, its derivatives, consistent starts."""

from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from ..faces import contact
from ..faces.film_thickness import h_min
from ..solvers.contract import SolverFailure
from . import coupled_native, equations
from .condensation import factored
from .segments import Segment

# Newton's steps to a consistent start, and the change relative to the scales at which it has arrived.
MOST_STEPS, ARRIVED = 12, 1e-12
# Share of the errors of rates that counts in a step of an implicit method.
RATES = 0.3


class CoupledSegment(Segment):
    """A Segment whose film has unknowns: it has a residual and its derivatives, and no right-hand side (SolverFailure);
    `ring_rates` are those of the rings at given unknowns of the film."""

    def _bind(self):
        """The equations are functions of this segment's own (coupled_native.py)."""
        # How often the film was settled.
        self.settled = 0

    @cached_property
    def native(self):
        """These equations for C (coupled_native.py), which work on this segment's arrays and those of its copies."""
        return coupled_native.native(self)

    def rhs(self, tau, y, yp):
        """There is none: raises SolverFailure."""
        raise SolverFailure("a film with unknowns of its own has no rates: only the residual form (IDA)")

    def ring_rates(self, tau, y, yp):
        """Rates of rings and works at given unknowns of the film, into `yp` (size,)."""
        coupled_native.ring_rates(tau, np.array(y), yp, self.native.block)

    def residual(self, tau, y, yp, res):
        """The residual into `res` (size,).  Raises SolverFailure where the film has no solution."""
        # A solver's arrays may be for reading only, which no kernel takes.
        self._check(coupled_native.residual(tau, np.array(y), np.array(yp), res, self.native.block))

    def _check(self, code):
        if code:
            raise SolverFailure(self.failure())

    def failure(self) -> str:
        """What the film says if it has failed since it was asked last, else ""."""
        numbers = self.native.arrays[coupled_native.NUMBERS]
        code, tau = int(numbers[coupled_native.CODE]), numbers[coupled_native.WHEN]
        numbers[coupled_native.CODE] = 0.0
        if not code:
            return ""
        numberless = "a residual, or a derivative of it, is not a number"
        sentence = numberless if code == coupled_native.NO_NUMBER else self.model.interface.film.status[code]
        return f"{sentence} (at {tau:.6g} s into this segment)"

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

    def residual_derivatives(self, tau, y, yp, alpha, data, by_y=1.0):
        """`by_y` d res / d y + `alpha` d res / d y' at segment time `tau` (s), `by_y` 0 or 1, into the values `data`
        (nnz,) of the pattern.  Raises SolverFailure where the film has no solution."""
        block = self.native.block
        self._check(coupled_native.derivatives(tau, alpha, by_y, np.array(y), np.array(yp), data, block))

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
            change = factored(csc_array(mixed.tocsc()[np.ix_(free, free)])).solve(-res[free])
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

    # --- stages of an implicit method -------------------------------------------------------------

    @property
    def settles(self) -> bool:
        """Whether its film settles by itself at a stage."""
        return self.model.interface.film.settle is not None

    @cached_property
    def _stores(self):
        return np.array(self.model.unknowns.film_unknowns.differential, dtype=bool)

    @cached_property
    def _newton(self):
        rings = self.film.start
        return np.zeros((rings, rings)), np.zeros(1)

    def stage(self, tau, alpha, base, guess, near, small):
        """Unknowns and rates, each (size,), with the residual zero at segment time `tau` (s) where the rates are
        `alpha` (1/s) times (unknowns - `base`); the rings start from `guess`, the film from `near`, all (size,).
        `small`: change relative to the scales after which the rings have arrived.  None where there are none."""
        from .coupled_stage import stage

        y, yp = guess.copy(), np.zeros(self.size)
        y[self.film] = near[self.film]
        matrix, kept = self._newton
        try:
            found = stage(tau, alpha, base, y, yp, matrix, kept, self.n, self._stores, small, self.native.block)
        except np.linalg.LinAlgError:
            # So short a step that what moves a ring is lost in rounding.
            kept[0] = 0.0
            return None
        if found < 0:
            return None
        self.settled += found
        return y, yp

    def stage_error(self, error, alpha) -> float:
        """Size of a step's `error` (size,) relative to the scales: of the displacements, a share of that of the rates,
        and on average of what the film stores; the step had stages of `alpha` (1/s).

        Where a cell of a cavity fills, its pressure jumps, and the rate of a ring that its film holds soon after: what
        decays faster than a step sees does not count."""
        rings, stores, (matrix, _) = self.film.start, self._stores, self._newton
        own, fast = error[:rings], [rate for rate in self.rate_places if rate >= 0]
        if fast:
            held = own if np.any(self.lacks_inertia) else self._filtered(own, alpha, matrix)
            rates = RATES * float(np.max(np.abs(held[fast]) / self.scales[fast]))
        else:
            rates = 0.0
        kept = np.abs(error[self.film][stores] / self.scales[self.film][stores])
        return max(rates, float(np.max(np.abs(own[: self.n]) / self.scales[: self.n])), float(np.mean(kept)))

    @staticmethod
    def _filtered(own, alpha, matrix):
        """An error without what decays fast; twice, since what a stage errs in a held ring's rate goes with its step
        once."""
        return alpha**2 * np.linalg.solve(matrix, np.linalg.solve(matrix, own))

    def film_between(self, taus, q, q_rate, x):
        """The film's unknowns (m, n) at times (m,) (s) between steps, from displacements and rates and from `x`, where
        they are interpolated: those of a film that settles follow from what it stores."""
        film, model = self.model.interface.film, self.model
        if self.settles:
            rates = np.zeros(self.size)
            for tau, at, rate, own in zip(taus, q, q_rate, x, strict=True):
                # Of a ring without mass the rate is no unknown.
                rates[: self.n] = rate
                equations.kinematics(tau, model.vector(at, rate), rates, self.p, self.w, self.s)
                film.between(model.f, self.s, own)
        return x

    # --- stored steps -------------------------------------------------------------------------------

    def derivatives(self, taus, ys):
        """Derivatives (m, size) at times and unknowns `ys` (m, size), zero for the film's; every ring has mass."""
        out = np.zeros((len(taus), self.size))
        coupled_native.ring_rates_along(taus, ys, out, self.native.block)
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
