"""Modes of rings on a film that stores: its unknowns in the few combinations that rings can move, and one eigenproblem
of rings and combinations together (a reduced basis of the film's own answers).

The eigenvalues are those of det(M p^2 + C p + K + H(p)) = 0 with the film's dynamic stiffness H (condensation.py), the
film's own modes among them.  Newton's method on that equation finds what it starts near; this finds all (measured on
one core: 16 ms with 400 unknowns, 43 ms with 1920, of which rings move some twenty combinations).
"""

import numpy as np
from scipy.linalg import block_diag, eig

from ..scene.scene import SceneError
from .condensation import factored

# How far modes are looked for, in the fastest eigenvalue of the rings on the film's stiffness and damping at that very
# frequency: right of the imaginary axis a film that delays its forces is no stiffer, so nothing faster than this grows.
REACH, SHRINKINGS = 3.0, 6
# Largest residual, as a share of the answer, and of what is worth a closer look; what a basis vector adds at least,
# above the rounding of derivatives; least motion of the rings in a mode, as a share of what it does to the film;
# answers and rounds at most.
SOLVED, LIKELY, NEW, STILL, MOST_ANSWERS, MOST_ROUNDS = 1e-8, 1e-3, 1e-10, 1e-9, 40, 12
# Modes that are made exact: so many of those next to growing; iterations,
# how exact (relative), and how near they were.
EXACT, ITERATIONS, CONVERGED, NEAR = 8, 8, 1e-10, 0.05
# Beyond so many vectors of the basis only those modes are taken up: fine cells have hundreds that die within a fraction
# of their period, a crowd that rounding stirs.
CROWD = 100
# Error of an eigenvalue, as a share; what is a rounding of the largest.
STORED, ROUNDING = 1e-8, 1e-15
# Frequencies of the forced motion at which the residual is watched, over the reach.
WATCHED = np.geomspace(1e-10, 1.0, 41)


class ReducedFilm:
    """A LinearFilm in the span of its answers at some complex frequencies.

    With the operator A = (R_x + c R_x')^-1 R_x', which neither rows nor scales of the residual touch, the film obeys
    x + (p - c) A x = -(b + p b') g; its Galerkin projection on the `basis` (n, r) of scaled unknowns is exact at every
    frequency whose answer the basis holds.  `pace` c (1/s), where the film alone has no mode.
    **Source** Antoulas (2005), Approximation of Large-Scale Dynamical Systems, sec. 11.3 (rational Krylov projection).
    """

    def __init__(self, film, pace: float):
        self.film, self.pace = film, pace
        self.solver = factored(film.by_x + pace * film.by_rate)
        self.by_gap, self.by_gap_rate = self._scaled(film.by_gap), self._scaled(film.by_gap_rate)
        self.basis = self.stored = self._span = np.empty((len(film.scales), 0))
        self._triangle, self._turns = np.empty((0, 0)), []
        self._watch(self.by_gap, self.by_gap_rate)

    def _scaled(self, right):
        return self.solver.solve(right) / self.film.scales[:, None]

    def add(self, p: complex):
        """Take up the film's answer at a complex frequency (1/s)."""
        answer, basis = self.film.unknowns(p) / self.film.scales[:, None], self.basis
        new = np.hstack([answer.real, np.imag(answer)])
        sizes = np.linalg.norm(new, axis=0)
        new = new[:, sizes > 0] / sizes[sizes > 0]
        # Twice: once leaves what rounding leaves.
        for _ in range(2):
            new = new - basis @ (basis.T @ new)
        new, weights, _ = np.linalg.svd(new, full_matrices=False)
        new = new[:, weights > NEW]
        new = np.linalg.qr(new - basis @ (basis.T @ new))[0]
        self.basis = np.hstack([basis, new])
        stored = self._scaled(self.film.by_rate @ (self.film.scales[:, None] * new))
        self.stored = np.hstack([self.stored, stored])
        self._watch(new, stored)

    def _watch(self, one, other):
        """Every residual is in the span of the columns of `one` and `other` (n, m) of all calls: its norm needs their
        triangle only, which grows by columns."""
        new, span = np.hstack([one, other]), self._span
        self._turns.append(one.shape[1])
        if span is not None and span.shape[1] + new.shape[1] > len(new):
            # More columns than there are directions: as they are.
            self._triangle, self._span = span @ self._triangle, None
        if self._span is None:
            self._triangle = np.hstack([self._triangle, new])
            return
        first = span.T @ new
        own, left = np.linalg.qr(new - span @ first)
        # Twice: of a column that lies in the span the first time leaves a rounding, which points anywhere.
        again = span.T @ own
        own, corner = np.linalg.qr(own - span @ again)
        self._span = np.hstack([span, own])
        below = np.zeros((len(corner), self._triangle.shape[1]))
        self._triangle = np.block([[self._triangle, first + again @ left], [below, corner @ left]])

    def residual(self, p, parts, gap) -> np.ndarray:
        """Norms (..., m) of what `parts` (..., r, m) of the basis leave of the film's equations, for gaps (..., 3, m)
        moving as exp(p t), p (..., 1, m)."""
        each = np.split(parts, np.cumsum(self._turns[1:-1]), axis=-2)
        own = [part for turn in each for part in (turn, (p - self.pace) * turn)]
        return np.linalg.norm(self._triangle @ np.concatenate([gap, p * gap, *own], axis=-2), axis=-2)

    def forced_residuals(self, p) -> np.ndarray:
        """The largest residual (m,) of the projected answers to the three unit motions of the gap, moving as exp(p t),
        p (m,), as a share of the answer."""
        stored, at = self.basis.T @ self.stored, p[:, None, None]
        pushed = self.basis.T @ self.by_gap + at * (self.basis.T @ self.by_gap_rate)
        parts = -np.linalg.solve(np.eye(len(stored)) + (at - self.pace) * stored, pushed)
        left = self.residual(at, parts, np.broadcast_to(np.eye(3), (len(p), 3, 3)))
        return np.max(left / np.linalg.norm(parts, axis=1), axis=1)

    def pushed(self, p, gap) -> np.ndarray:
        """What motions `gap` (3, m) do to the film at the sizes of their frequencies p (m,), (m,)."""
        still, moving = (np.linalg.norm(by, axis=0) @ np.abs(gap) for by in (self.by_gap, self.by_gap_rate))
        return still + np.abs(p) * moving

    def pencil(self, linear) -> tuple[np.ndarray, ...]:
        """Matrices (N, N) of `left y = p right y` on y = (displacements, rates, parts of the basis), and factors (N,)
        of their rows and columns that make their elements alike."""
        film, gap, n = self.film, linear.gap, len(linear.mass)
        stiffness, damping = beside_unknowns(linear)
        stored = self.basis.T @ self.stored
        r = len(stored)
        force = gap.T @ (film.force_by_x * film.scales) @ self.basis
        left = np.block([
            [np.zeros((n, n)), np.eye(n), np.zeros((n, r))],
            [-stiffness, -damping, force],
            [-self.basis.T @ self.by_gap @ gap, -self.basis.T @ self.by_gap_rate @ gap, self.pace * stored - np.eye(r)],
        ])  # fmt: skip
        right = block_diag(np.eye(n), linear.mass, stored)
        return left, right, *even(np.abs(left) + self.pace * np.abs(right))

    def stored_by_unknowns(self) -> np.ndarray:
        """The basis times A (r, n), on the scaled unknowns themselves."""
        turned = self.solver.solve(self.basis / self.film.scales[:, None], trans="T")
        return (self.film.by_rate.T @ turned).T * self.film.scales


def even(sizes) -> tuple[np.ndarray, np.ndarray]:
    """Factors (N,) of rows and columns that bring the largest element of each near one.
    **Source** Ruiz (2001), RAL-TR-2001-034."""
    rows, columns = np.ones(len(sizes)), np.ones(len(sizes))
    for _ in range(6):
        now = sizes * rows[:, None] * columns
        rows, columns = rows / np.sqrt(now.max(axis=1)), columns / np.sqrt(now.max(axis=0))
    return rows, columns


def beside_unknowns(linear) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping (n, n) of a `LinearScene` without what its film's unknowns do: the rings' matrices have the
    film of slow motion, and here its unknowns are their own."""
    film, gap, (stiffness, damping) = linear.film, linear.gap, linear.film.slow
    return (
        linear.stiffness - gap.T @ (stiffness + film.force_by_gap) @ gap,
        linear.damping - gap.T @ (damping + film.force_by_gap_rate) @ gap,
    )


def reach_of(linear) -> float:
    """Largest size (1/s) of an eigenvalue that is looked for."""
    reach = np.inf
    for _ in range(SHRINKINGS):
        values, _ = linear.at_frequency(0.0 if np.isinf(reach) else reach).eigen()
        found = REACH * float(np.max(np.abs(values), initial=0.0))
        if not 0.0 < found < 0.9 * reach:
            break
        reach = found
    return reach if np.isfinite(reach) else 1.0


def coupled_modes(linear, reach: float) -> tuple[np.ndarray, np.ndarray, ReducedFilm]:
    """Eigenvalues (m,) of size up to the reach (1/s) in which rings move, displacement shapes (n, m), and the reduced
    film they rest on.

    `linear` LinearScene with a `film`.  The basis takes up answers along the imaginary axis until none is missed: H is
    analytic to the right of it, so its error there is no larger and no growing mode is missed.  Then it takes up those
    at the eigenvalues until each has its residual solved (in a crowd: each of those next to growing, and of the others
    those that are solved are found).  Of modes far slower than the fastest that says little: those
    next to growing are made exact.
    **Valid** a film that is stable between rings at rest.  Raises SceneError for eigenvalues that do not settle.
    """
    reduced, n, watched = ReducedFilm(linear.film.few, reach / REACH), len(linear.mass), 1j * reach * WATCHED
    reduced.add(0.0)
    reduced.add(watched[-1])
    # Where the answer is in the basis already, what is left is rounding.
    unknown = np.ones(len(watched), bool)
    for _ in range(MOST_ANSWERS + len(watched)):
        left = np.where(unknown, reduced.forced_residuals(watched), 0.0)
        if left.max() < SOLVED:
            break
        worst, size = int(np.argmax(left)), reduced.basis.shape[1]
        reduced.add(watched[worst])
        unknown[worst] = reduced.basis.shape[1] > size
    else:
        raise _unsettled(watched, left)
    for _ in range(MOST_ROUNDS):
        one, other, rows, columns = reduced.pencil(linear)
        values, vectors = eig(rows[:, None] * one * columns, rows[:, None] * other * columns)
        vectors = columns[:, None] * vectors
        q, parts = vectors[:n], vectors[2 * n :]
        # Rings that go together move no film, but would if they did not.
        finite = np.where(np.isfinite(values), values, 0.0)
        moved = reduced.pushed(finite, np.abs(linear.gap) @ np.abs(q))
        answer = np.linalg.norm(parts, axis=0) + moved
        near = np.isfinite(values) & (np.abs(values) < reach) & (moved > STILL * answer)
        values, q, parts, answer = values[near], q[:, near], parts[:, near], answer[near]
        left = reduced.residual(values, parts, linear.gap @ q) / answer
        solved, size = left < SOLVED, reduced.basis.shape[1]
        wanted = ~solved & (values.imag >= 0)
        if size > CROWD:
            wanted[np.argsort(-values.real, kind="stable")[EXACT:]] = False
        for value in values[wanted]:
            reduced.add(complex(value))
        # With the answer there in the basis already, it is the basis that has a mode there, not rings and film.
        if reduced.basis.shape[1] == size:
            # Eigenvectors that are nearly one another's leave a residual of modes that are known well.
            first = np.isin(np.arange(len(values)), np.argsort(-values.real, kind="stable")[: 2 * EXACT])
            known = solved | (first & (left < LIKELY))
            return *_exact(linear, values[known], q[:, known], solved[known]), reduced
    raise _unsettled(values, left)


def _exact(linear, values, shapes, solved) -> tuple[np.ndarray, np.ndarray]:
    """The eigenvalues and shapes, those EXACT with the largest real parts by inverse iteration on rings and film
    themselves; without those that are neither `solved` (m,) nor found so.

    **Source** Ruhe (1973), SIAM J. Numer. Anal. 10, 674: inverse iteration for nonlinear eigenproblems."""
    film, gap = linear.film, linear.gap
    stiffness, damping = film.slow
    stiffness, damping = linear.stiffness - gap.T @ stiffness @ gap, linear.damping - gap.T @ damping @ gap

    def dynamic(p):
        return linear.mass * p * p + damping * p + stiffness + gap.T @ film.stiffness(p) @ gap

    values, shapes, sure = values.astype(complex), shapes.astype(complex), solved.copy()
    upper = [k for k in np.argsort(-values.real) if values[k].imag >= 0.0][:EXACT]
    for k in upper:
        partner = int(np.argmin(np.abs(values - values[k].conj())))
        p, q = complex(values[k]), shapes[:, k] / np.linalg.norm(shapes[:, k])
        for _ in range(ITERATIONS):
            step = 1e-5 * abs(p)
            if not step > 0.0:
                break
            slope = (dynamic(p + step) - dynamic(p - step)) / (2.0 * step)
            try:
                answer = np.linalg.solve(dynamic(p), slope @ q)
            except np.linalg.LinAlgError:
                # Exact already.
                break
            change = 1.0 / (q.conj() @ answer)
            p, q = p - change, answer / np.linalg.norm(answer)
            if abs(change) < CONVERGED * abs(p):
                sure[[k, partner]] |= abs(p - values[k]) < NEAR * abs(p)
                break
        # One that leads elsewhere was well known, or is none of its own.
        if abs(p - values[k]) < NEAR * abs(p):
            if values[k].imag == 0.0:
                p, q = complex(p.real), q * np.exp(-1j * np.angle(q[np.argmax(np.abs(q))]))
            values[partner], shapes[:, partner] = np.conj(p), q.conj()
            values[k], shapes[:, k] = p, q
    return values[sure], shapes[:, sure]


# --- Tilts of a film that is alike all round, over the shaft speed -------------------------------------

# What matrices may differ by from what is linear in the speed, or alike in all directions, as a share; between which
# speeds they are looked at, in the reference speed.
LINEAR, SPEEDS = 1e-9, (0.0, 100.0, 1.0)


def tilt_pencil(linear) -> tuple[np.ndarray, np.ndarray] | None:
    """Complex matrices (N, N) of `left y = p right y` on y = (tilt_x + i tilt_y of each floating ring, its rates,
    cosine + i sine of the film's unknowns); None of a `LinearScene` that is not alike in all directions.

    **Source** what commutes with a turn by a sector is [[a, -b], [b, a]] on each such pair, and so is a + i b."""
    film, gap, n = linear.film, linear.gap, len(linear.mass)
    if film.combinations is None or linear.rest is not None:
        return None
    few, (angles, cells), (stiffness, damping) = film.few, film.around, beside_unknowns(linear)
    kinds = len(film.scales) // (angles * cells)
    each = len(few.scales) // (3 * kinds)
    cosines = (each * (3 * np.arange(kinds)[:, None] + 1) + np.arange(each)).ravel()
    tilts, waves = (np.arange(1, n, 3), np.arange(2, n, 3)), (cosines, cosines + each)
    alike = []

    def turning(matrix, rows, columns):
        parts = [[matrix[np.ix_(row, column)] for column in columns] for row in rows]
        apart = np.abs(parts[0][0] - parts[1][1]).max() + np.abs(parts[1][0] + parts[0][1]).max()
        alike.append(apart <= LINEAR * np.abs(matrix).max())
        return parts[0][0] + 1j * parts[1][0]

    one, none = np.eye(n // 3), np.zeros((n // 3, n // 3))
    pushed = [turning(by @ gap, waves, tilts) for by in (few.by_gap, few.by_gap_rate)]
    pushes = turning(gap.T @ few.force_by_x, tilts, waves)
    left = np.block([
        [none, one, np.zeros_like(pushes)],
        [-turning(stiffness, tilts, tilts), -turning(damping, tilts, tilts), pushes],
        [-pushed[0], -pushed[1], -turning(few.by_x.toarray(), waves, waves)],
    ])  # fmt: skip
    right = block_diag(one, linear.mass[np.ix_(tilts[0], tilts[0])], turning(few.by_rate.toarray(), waves, waves))
    return (left, right) if all(alike) else None


def tilts_over_speed(at_speed, reference: float, direction: float = 1.0):
    """The function `values` of stability_thresholds.py of a film that stores, where the matrices of the tilts are
    linear in the speed: `at_speed(w)` gives the LinearScene, `reference` a speed (rad/s, without sign), `direction` as
    of `one_by_one`.  None where they are not, or at such a speed there is no film.  Modes in which rings hardly move,
    or which die at once, are among them."""
    try:
        found = [tilt_pencil(at_speed(direction * share * reference)) for share in SPEEDS]
    except SceneError:
        return None
    if any(pencil is None for pencil in found):
        return None
    ends = []
    for first, last, between in zip(*found, strict=True):
        slope = (last - first) / SPEEDS[1]
        if not np.all(np.abs(first + slope - between).max(axis=1) <= LINEAR * np.abs(between).max(axis=1)):
            return None
        ends.append((first, slope / reference))

    def values(speeds):
        left, right = (still + np.asarray(speeds)[:, None, None] * by_speed for still, by_speed in ends)
        # 1/(p - c) of an eigenvalue p: of those without end zero.
        inverse = np.linalg.eigvals(np.linalg.solve(left - reference * right, right))
        with np.errstate(all="ignore"):
            p = reference + 1.0 / np.where(np.abs(inverse) > ROUNDING * np.abs(inverse).max(), inverse, np.nan)
        p = p if direction > 0.0 else p.conj()
        return p, errors_of(p)

    return values


def errors_of(values) -> np.ndarray:
    """Bounds on the errors of eigenvalues (..., m) (1/s) of rings and a film that stores."""
    return STORED * np.abs(values) + ROUNDING * np.nanmax(np.abs(values), axis=-1, initial=0.0, keepdims=True)


def _unsettled(p, left) -> SceneError:
    worst = int(np.argmax(left))
    found = f"one whose answer near {p[worst]:.4g} 1/s does not settle (residual {left[worst]:.1g})"
    return SceneError("film", found, "a film that few combinations of its unknowns describe")
