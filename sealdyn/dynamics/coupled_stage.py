"""Rings and a film that settles by itself at one stage of an implicit method: Newton on the rings' unknowns, with the
film's solved inside (a Schur complement on the few unknowns of the rings)."""

import math

import numpy as np

from ..numerics.addresses import call_load, call_settle
from ..numerics.kernel import inner_kernel, outer_kernel
from . import equations
from .coupled_native import CODE, FIRST, KERNELS, NUMBERS, PACE, SCALES, WHEN, integer_array, of_film, rows_of_rings
from .film_derivatives import SETTLE
from .native import CONTACT, FILM, GAP, KERNEL, LOAD, PARAMETERS, SCRATCH, SIZE, array

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
