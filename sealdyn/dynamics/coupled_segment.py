"""Rings and a film with unknowns of its own over a stretch of time: residual, its derivatives, consistent starts."""

import math
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from ..faces import contact
from ..faces.film_thickness import h_min
from ..faces.geometry import FORCE
from ..numerics.kernel import call_load, call_settle, inner_kernel, outer_kernel
from ..scene.scene import SceneError
from ..solvers.contract import SolverFailure
from . import coupled_native, equations
from .condensation import SETTLE, factored
from .coupled_native import CODE, FIRST, KERNELS, NUMBERS, PACE, SCALES, WHEN, integer_array, of_film, rows_of_rings
from .native import CONTACT, FILM, GAP, KERNEL, LOAD, PARAMETERS, SCRATCH, SIZE, array
from .segments import Segment

# --- One stage of an implicit method -------------------------------------------------------------------

# Newton on the rings' unknowns, with those of a film that settles by itself solved inside: a Schur complement on the
# few unknowns of the rings.
# Newton's steps in all; a contraction slower than this asks for a fresh matrix; the least share of a step.
MOST, SLOW, LEAST = 32, 0.3, 1.0 / 64.0
# Steps of differences, as a share of the scales; and of the rate between them that such a step would be.
STEP, RATE = 1e-6, 1e-2
# What a stage returns instead of the number of its steps.
NO_FILM, NOT_CONVERGED = -1, -2


@inner_kernel()
def _rows(tau, alpha, base, y, yp, res, settles, block):
    """Rows of rings and works at a stage, `res` (size,), with the film settled if asked to; its code."""
    rings, code = block[FIRST], 0
    for i in range(rings):
        yp[i] = alpha * (y[i] - base[i])
    f, s = array(block, FILM), array(block, GAP)
    equations.kinematics(tau, y, yp, array(block, PARAMETERS), array(block, SCRATCH), s)
    if settles:
        kernel = integer_array(block, KERNELS)[SETTLE]
        code = call_settle(kernel, f, s, alpha, of_film(base, block), of_film(y, block))
        call_load(block[KERNEL], f, s, of_film(y, block))
    call_load(block[LOAD], array(block, CONTACT), f, s)
    rows_of_rings(tau, y, yp, res, block)
    return code


@inner_kernel()
def _matrix(tau, alpha, base, y, yp, matrix, places, block):
    """Derivatives (rings, rings) of the rings' rows by their unknowns at a stage, the film settled for each that moves
    the gap, one of the first `places`; its code."""
    rings, scales, size = block[FIRST], array(block, SCALES), block[SIZE]
    share = min(STEP, RATE * array(block, NUMBERS)[PACE] / alpha)
    held, near, moved, lower = y.copy(), y.copy(), np.empty(size), np.empty(size)
    code = _rows(tau, alpha, base, near, yp, lower, True, block)
    settled = near.copy()
    for j in range(rings):
        step = share * scales[j]
        near[:] = settled
        near[j] = held[j] + step
        # Forces of another place stay in the gap state: the film of the place itself again.
        found = _rows(tau, alpha, base, near, yp, moved, j < places, block)
        code = found if code == 0 else code
        for i in range(rings):
            matrix[i, j] = (moved[i] - lower[i]) / step
        if j == places - 1:
            near[:] = settled
            found = _rows(tau, alpha, base, near, yp, lower, True, block)
    return code


@outer_kernel()
def stage(tau, alpha, base, y, yp, matrix, kept, places, stores, small, block):
    """Unknowns `y` (size,) with the residual zero where the rates are `yp` = alpha (y - base); at entry those near by.

    `matrix` (rings, rings) is the Newton matrix, `kept[0]` the alpha that it was made with (0: none yet); `places` how
    many displacements there are, the first of the unknowns; `stores` (film's,) which of its unknowns have rates (those
    of the others are left 0); `small` the change of the rings' unknowns, relative to the
    scales, after which they have arrived.  Returns how many times the film was settled, or NO_FILM, NOT_CONVERGED.
    """
    rings, size, scales = block[FIRST], block[SIZE], array(block, SCALES)
    res, before, settled, with_one = np.zeros(size), math.inf, 0, 0
    last, step, share, fresh, made_there = y[:rings].copy(), np.zeros(rings), 1.0, False, False
    if abs(kept[0] - alpha) > SLOW * alpha:
        kept[0] = 0.0
    for _ in range(MOST):
        if kept[0] == 0.0:
            code = _matrix(tau, alpha, base, y, yp, matrix, places, block)
            if code != 0:
                return _failed(code, tau, block)
            settled, kept[0], with_one, before, fresh = settled + places + 2, alpha, 0, math.inf, True
        code = _rows(tau, alpha, base, y, yp, res, True, block)
        settled += 1
        if code != 0:
            kept[0] = 0.0
            return _failed(code, tau, block)
        change, size_of = np.linalg.solve(matrix, res[:rings]), 0.0
        for i in range(rings):
            size_of = max(size_of, abs(change[i]) / scales[i])
        if before < math.inf and not size_of < (1.0 - 0.25 * share) * before:
            # A kink was passed, behind which the way leads back: a part of the step, by the matrix of its start.
            share = 0.5 * share if made_there else 1.0
            kept[0] = kept[0] if made_there else 0.0
            if share < LEAST:
                break
            for i in range(rings):
                y[i] = last[i] - share * step[i] if made_there else last[i]
            continue
        if not size_of < math.inf:
            break
        if share < 1.0:
            share, kept[0] = 1.0, 0.0
            continue
        made_there = fresh and with_one == 0
        for i in range(rings):
            last[i], step[i] = y[i], change[i]
            y[i] -= change[i]
        with_one += 1
        # What the next change would be, by how these shrink.
        if size_of <= small or (before < math.inf and size_of < before and size_of * size_of <= small * before):
            code = _rows(tau, alpha, base, y, yp, res, True, block)
            if code != 0:
                kept[0] = 0.0
                return _failed(code, tau, block)
            for i in range(rings + len(of_film(y, block)), size):
                yp[i] = -(res[i] - yp[i])
                y[i] = base[i] + yp[i] / alpha
            film, at, to = of_film(y, block), of_film(base, block), of_film(yp, block)
            for i in range(len(film)):
                to[i] = alpha * (film[i] - at[i]) if stores[i] else 0.0
            return settled + 1
        if size_of > SLOW * before and not (fresh and with_one < 3):
            kept[0], fresh = 0.0, False
        before = size_of
    kept[0] = 0.0
    return NOT_CONVERGED


@inner_kernel()
def _failed(code, tau, block):
    """Keep the film's code and the time; NO_FILM."""
    numbers = array(block, NUMBERS)
    numbers[CODE], numbers[WHEN] = code, tau
    return NO_FILM


# Newton's steps to a consistent start, and the change relative to the scales at which it has arrived.
MOST_STEPS, ARRIVED = 12, 1e-12
# Share of the errors of rates that counts in a step of an implicit method.
RATES = 0.3


class CoupledSegment(Segment):
    """A Segment whose film has unknowns: it has a residual and its derivatives; a right-hand side only where all of the
    unknowns have rates (`has_rates`), which no run takes and comparisons do; `ring_rates` are those of the rings at
    given unknowns of the film."""

    # How often the film was settled, or its residual evaluated on the way there.
    settled = 0
    # Factors of the film's own rows, after the alpha that they hold for.
    _film_factors: tuple = (0.0, None)

    @cached_property
    def native(self):
        """These equations for C (coupled_native.py), which work on this segment's arrays and those of its copies."""
        return coupled_native.native(self)

    @cached_property
    def has_rates(self) -> bool:
        """Whether every unknown has a rate: the residual is then the rates less the right-hand side."""
        return bool(np.all(self._stores)) and not np.any(self.lacks_inertia)

    def rhs(self, tau, y, yp):
        """Rates at unknowns `y`.  Raises SolverFailure where some unknown has none."""
        if not self.has_rates:
            raise SolverFailure("a film with unknowns of its own has no rates: only the residual form (IDA)")
        self.residual(tau, y, np.zeros(self.size), yp)
        np.negative(yp, out=yp)

    def rates_matrix(self, tau, y) -> csc_array:
        """d y'/d y (size, size)."""
        return -self._matrix(tau, y, np.zeros(self.size), 0.0, 1.0)

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
        rates, held = 0.0, own
        if not np.any(self.lacks_inertia):
            # Twice, since what a stage errs in a held ring's rate goes with its step once.
            held = alpha**2 * np.linalg.solve(matrix, np.linalg.solve(matrix, own))
        if fast:
            rates = RATES * float(np.max(np.abs(held[fast]) / self.scales[fast]))
        kept = np.abs(error[self.film][stores] / self.scales[self.film][stores])
        return max(rates, float(np.max(np.abs(own[: self.n]) / self.scales[: self.n])), float(np.mean(kept)))

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

    # --- film and rings in turn ---------------------------------------------------------------------

    def film_step(self, tau, alpha, y, small) -> np.ndarray:
        """Force (N) and moments (N m) of the film (3,) after a step of implicit Euler to segment time `tau` (s) with
        the rings given: its unknowns in `y` (size,) become those whose rates are `alpha` (1/s) times their change, to
        `small` of their scales.  Raises SolverFailure where there are none."""
        film, f, x = self.model.interface.film, self.model.f, y[self.film]
        equations.kinematics(tau, y, np.zeros(self.size), self.p, self.w, self.s)
        if film.settle is None:
            self._solve_film(tau, alpha, y, small)
        else:
            self.settled += 1
            if code := film.settle(f, self.s, alpha, x.copy(), x):
                raise SolverFailure(film.status[code])
        film.wrench(f, self.s, x)
        return self.s[FORCE : FORCE + 3].copy()

    def _solve_film(self, tau, alpha, y, small):
        """Newton on the film's rows, with factors that are kept over steps until convergence is slow."""
        x, yp, res, before = y[self.film], np.zeros(self.size), np.empty(self.size), math.inf
        base = x.copy()
        for _ in range(MOST):
            yp[self.film] = alpha * (x - base) * self._stores
            self.residual(tau, y, yp, res)
            self.settled += 1
            if self._film_factors[0] != alpha:
                own = self._matrix(tau, y, yp, alpha, 1.0)[self.film, self.film]
                self._film_factors, before = (alpha, factored(own)), math.inf
            change = self._film_factors[1].solve(res[self.film])
            x -= change
            size = float(np.max(np.abs(change) / self.scales[self.film]))
            if size <= small or (size < before < math.inf and size * size <= small * (before - size)):
                return
            if not size <= SLOW * before:
                self._film_factors = 0.0, None
            before = size
        raise SolverFailure("the film's pressures do not converge in the gap that it is given")

    def rates_under(self, load, tau, y, yp):
        """Rates of rings and works into `yp` (size,) where the film presses with the `load` (3,) of `film_step`."""
        equations.kinematics(tau, y, yp, self.p, self.w, self.s)
        self.s[FORCE : FORCE + 3] = load
        if self.model.contact is not None:
            contact.contact_load_and_friction(self.model.contact, self.model.f, self.s)
        equations.rates(tau, y, self.p, self.w, self.s, yp)

    def quasi_static_rates(self, tau, y, yp):
        """Rates of rings and works into `yp` (size,), of the film 0, with the steady film of the gap state there, which
        goes into `y` (size,).  Raises SolverFailure where there is none."""
        try:
            self.settle_film(tau, y)
        except SceneError as error:
            raise SolverFailure(error.found) from None
        yp[self.film] = 0.0
        self.ring_rates(tau, y, yp)

    # --- stored steps -------------------------------------------------------------------------------

    def states(self, taus, ys, yps, gaps, scratch, low):
        """As native.states_along, into `gaps`, `scratch` and `low`, with the film's unknowns among `ys` (m, size)."""
        model, s, rates = self.model, self.s, np.zeros(self.size)
        for i, tau in enumerate(taus):
            equations.kinematics(tau, ys[i], yps[i], self.p, self.w, s)
            model.interface.film.flow(model.f, s, ys[i, self.film])
            if model.contact is not None:
                contact.contact_load_and_friction(model.contact, model.f, s)
            equations.rates(tau, ys[i], self.p, self.w, s, rates)
            gaps[i], scratch[i], low[i] = s, self.w, h_min(model.face, s)
