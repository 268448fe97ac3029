"""The equations of rings and a film with unknowns of its own as functions for C: the residual and its derivatives, as
native.py has the equations of rings alone."""

import math

import numpy as np
from numba import carray, float64, int32

from ..faces.geometry import FORCE, MOMENT_X, MOMENT_Y, OUTER_RADIUS
from ..numerics.kernel import (
    ADDRESS,
    c_function,
    call_film_residual,
    call_load,
    floats,
    inner_kernel,
    integers,
    outer_kernel,
)
from . import equations
from .condensation import RESIDUAL, WRENCH, FilmDerivatives, residual_by_unknowns, wrench_by_unknowns
from .native import ARRAYS, CONTACT, FILM, GAP, KERNEL, LOAD, PARAMETERS, SCRATCH, SIZE, WORK, Native, array, load_value
from .native import RATES as OF_RATES
from .native import RESIDUAL as OF_RESIDUAL

# The block goes on after that of native.py: two arrays of float64, four of int64; where the film's unknowns begin, and
# how many values the segment's pattern has.
SCALES, NUMBERS, KERNELS, STARTS, ROWS, COLOURS = range(6, 12)
FIRST, VALUES = ARRAYS + 2 * 12, ARRAYS + 2 * 12 + 1
BLOCK = VALUES + 1
# The numbers: rate (rad/s) between displacements and rates; the code of a film that has failed, and when (s).
PACE, CODE, WHEN = range(3)
# C: int(double tau, double alpha, double *y, double *yp, double *values, int64 *block).
OF_DERIVATIVES = int32(float64, float64, ADDRESS, ADDRESS, ADDRESS, ADDRESS)
# What these functions tell C of a film that has no solution: nothing helps.
FAILED = -1
# Beside the film's own codes: IDA would go on for ever with what is not a number.
NO_NUMBER = -1


def native(segment) -> Native:
    """The equations of a segment whose film has unknowns of its own; they work on the segment's own arrays."""
    model, work = segment.model, np.zeros(segment.size)
    film = FilmDerivatives(model.interface.film, model.unknowns.film_unknowns, model.f)
    load, contact = load_value(model.contact)
    scales, numbers = np.ascontiguousarray(segment.scales), np.array([segment.reference_rate, 0.0, 0.0])
    arrays = (segment.p, segment.w, segment.s, model.f, contact, work, scales, numbers, film.kernels, *film.pattern)
    block = [segment.size, film.kernels[WRENCH], load.address]
    for part in arrays:
        block += [part.ctypes.data, len(part)]
    block = np.array([*block, segment.film.start, segment.pattern.nnz], dtype=np.int64)
    return Native(0, block, arrays, residual_at.address, derivatives_at.address, ring_rates_at.address)


@inner_kernel()
def integer_array(block, which):
    """One of the block's int64 arrays."""
    at = ARRAYS + 2 * which
    return carray(integers(block[at]), block[at + 1])


@inner_kernel()
def of_film(y, block):
    """The film's part of `y` (size,)."""
    return y[block[FIRST] : block[FIRST] + len(integer_array(block, COLOURS))]


@inner_kernel()
def loads(tau, y, yp, block):
    """Kinematics, film and contact at segment time tau (s) and unknowns `y` (size,), in the block's gap state."""
    f, s = array(block, FILM), array(block, GAP)
    equations.kinematics(tau, y, yp, array(block, PARAMETERS), array(block, SCRATCH), s)
    # A kernel that raises an error leaves what it should have written: here, and below.
    s[FORCE] = s[MOMENT_X] = s[MOMENT_Y] = math.nan
    call_load(block[KERNEL], f, s, of_film(y, block))
    call_load(block[LOAD], array(block, CONTACT), f, s)


@inner_kernel()
def rows_of_rings(tau, y, yp, res, block):
    """The residual's rows of rings and works, at the loads of the block's gap state."""
    p, w, s = array(block, PARAMETERS), array(block, SCRATCH), array(block, GAP)
    equations.residual(tau, y, yp, p, w, s, array(block, WORK), res)


@outer_kernel()
def residual(tau, y, yp, res, block):
    """The residual `res` (size,); returns the film's code, which the block keeps with the time."""
    loads(tau, y, yp, block)
    rows_of_rings(tau, y, yp, res, block)
    kernel, rest = integer_array(block, KERNELS)[RESIDUAL], of_film(res, block)
    rest[:] = math.nan
    code = call_film_residual(
        kernel, array(block, FILM), array(block, GAP), of_film(y, block), of_film(yp, block), rest
    )
    return _verdict(code, res, tau, block)


@inner_kernel()
def _verdict(code, values, tau, block):
    """The film's code, or NO_NUMBER if one of the values is none; kept with the time if it is one of failure."""
    wrong = False
    for value in values:
        wrong |= math.isnan(value)
    if code == 0 and wrong:
        code = NO_NUMBER
    if code != 0:
        numbers = array(block, NUMBERS)
        numbers[CODE], numbers[WHEN] = code, tau
    return code


@outer_kernel()
def derivatives(tau, alpha, by_y, y, yp, data, block):
    """`by_y` d res / d y + `alpha` d res / d y', `by_y` 0 or 1, into the values `data` (nnz,) of the segment's pattern;
    returns the film's code.  The rings' columns are differences of the whole residual; the film's are its own, and its
    force's into the rings' rows."""
    size, rings, scales, pace = block[SIZE], block[FIRST], array(block, SCALES), array(block, NUMBERS)[PACE]
    base, moved, near, near_rate = np.empty(size), np.empty(size), y.copy(), yp.copy()
    code = residual(tau, y, yp, base, block)
    for j in range(rings):
        step = 1e-7 * max(abs(y[j]), scales[j]) / max(by_y, alpha / pace)
        near[j], near_rate[j] = y[j] + by_y * step, yp[j] + alpha * step
        code = residual(tau, near, near_rate, moved, block) if code == 0 else code
        for i in range(size):
            data[size * j + i] = (moved[i] - base[i]) / step
        near[j], near_rate[j] = y[j], yp[j]
    if code == 0:
        # From here the gap state is that of the base again.
        loads(tau, y, yp, block)
        code = _columns_of_film(tau, alpha, by_y, y, yp, data[size * rings :], block)
    return _verdict(code, data, tau, block)


@inner_kernel()
def _columns_of_film(tau, alpha, by_y, y, yp, data, block):
    """The values of `derivatives` after the rings' columns, into `data`; returns the film's code."""
    size, rings, starts = block[SIZE], block[FIRST], integer_array(block, STARTS)
    n = len(starts) - 1
    own, by_force, force_by_film = np.full(starts[n], math.nan), np.zeros((3, size)), np.zeros((3, n))
    code = _block_of_film(alpha, y, yp, own, block)
    if by_y == 0.0 and code == 0:
        still = np.full(starts[n], math.nan)
        code = _block_of_film(0.0, y, yp, still, block)
        own -= still
    else:
        force_by_film[:] = math.nan
        f, s, scales = array(block, FILM), array(block, GAP), of_film(array(block, SCALES), block)
        wrench_by_unknowns(integer_array(block, KERNELS), f, s, of_film(y, block), scales, force_by_film)
        _rows_by_force(tau, y, yp, by_force, block)
    at = 0
    for j in range(n):
        at = _by_force(by_force, force_by_film, j, 0, rings, data, at)
        for place in range(starts[j], starts[j + 1]):
            data[at], at = own[place], at + 1
        at = _by_force(by_force, force_by_film, j, rings + n, size, data, at)
    # What only measures.
    data[at:] = alpha
    return code


@inner_kernel()
def _by_force(by_force, force_by_film, j, first, last, data, at):
    """Rows from `first` to `last` of the film's column j into `data` from place `at` on; returns the place after."""
    for i in range(first, last):
        data[at] = 0.0
        for k in range(3):
            data[at] += by_force[k, i] * force_by_film[k, j]
        at += 1
    return at


@inner_kernel()
def _block_of_film(alpha, y, yp, own, block):
    """The film's own derivatives into the values `own` of its pattern; returns its code."""
    return residual_by_unknowns(
        integer_array(block, KERNELS), array(block, FILM), array(block, GAP), of_film(y, block), of_film(yp, block),
        alpha, of_film(array(block, SCALES), block), integer_array(block, STARTS), integer_array(block, ROWS),
        integer_array(block, COLOURS), own,
    )  # fmt: skip


@inner_kernel()
def _rows_by_force(tau, y, yp, columns, block):
    """Derivatives `columns` (3, size) of the rings' and works' rows by the film's force and moments."""
    s, size = array(block, GAP), block[SIZE]
    base, moved = np.zeros(size), np.zeros(size)
    rows_of_rings(tau, y, yp, base, block)
    # Short: the sum of absolute works has kinks.
    step = 1e-6 * max(abs(s[FORCE]), 1.0)
    for k in range(3):
        held, arm = s[FORCE + k], array(block, FILM)[OUTER_RADIUS] if k else 1.0
        s[FORCE + k] = held + step * arm
        rows_of_rings(tau, y, yp, moved, block)
        columns[k] = (moved - base) / (step * arm)
        s[FORCE + k] = held


@c_function(OF_RATES)
def ring_rates_at(tau, y_at, yp_at, data):
    """Rates of the rings and works at given unknowns of the film, whose own stay as they are."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    loads(tau, y, yp, block)
    equations.rates(tau, y, array(block, PARAMETERS), array(block, SCRATCH), array(block, GAP), yp)
    return 0


@c_function(OF_RESIDUAL)
def residual_at(tau, y_at, yp_at, res_at, data):
    """The residual; FAILED where the film has no solution."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    return FAILED if residual(tau, y, yp, carray(floats(res_at), block[SIZE]), block) != 0 else 0


@c_function(OF_DERIVATIVES)
def derivatives_at(tau, alpha, y_at, yp_at, values_at, data):
    """d res / d y + alpha d res / d y', the values of the segment's pattern; FAILED where the film has no solution."""
    block = carray(integers(data), BLOCK)
    y, yp = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE])
    values = carray(floats(values_at), block[VALUES])
    return FAILED if derivatives(tau, alpha, 1.0, y, yp, values, block) != 0 else 0
