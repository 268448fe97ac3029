"""Many runs in one compiled loop: each integrated by CVODE, its extremes and contacts followed, its motion at the
points of the tally (dynamics/tally.py) interpolated, and nothing of Python between them.

The same kernels look at the same steps as in a run of its own (solvers/integrate.py), so that numbers are the same to
the bit at the same tolerance.  A run that does not end well is left for that other way, which can say why.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import carray

from ..numerics.hermite import lobatto, sample, sample_doubtful
from ..numerics.kernel import call_rates, inner_kernel, integers, outer_kernel
from ..solvers.contract import OVERLAP, longest_step
from ..solvers.integrate import RENEWED
from ..solvers.sundials_direct import add_refused, restart_cvode, step_cvode
from ..solvers.sundials_libraries import BLOCK, CALLS, DATA, FUNCTION, JACOBIANS, SCALES
from .extrema import track_extremes
from .native import BLOCK as WORDS
from .native import FILM, GAP, PARAMETERS, SCRATCH, array
from .tally import locate_contacts, longest_panel

# How a run ended: well, as one to be looked at alone, or not at all because the loop was told to stop.
DONE, ALONE, STOPPED = range(3)
# Of a stretch: address of its equations' block, its index in the run, its first point of output and the one after its
# last, which the loop writes; length (s), longest step (s, 0: any), start (s), pace of the scan and fastest motion of
# interest (rad/s), longest panel of the tally (s).
EQUATIONS, INDEX, FIRST, END = range(4)
LENGTH, LONGEST, START, PACE, FASTEST, PANEL = range(6)


class Integrator(NamedTuple):
    """CVODE of `cvode_for` (solvers/sundials_direct.py): addresses of its memory and its N_Vectors, the arrays behind
    them (size,), and the words it carries."""

    memory: int
    vector: int
    tolerances: int
    y: np.ndarray
    absolute: np.ndarray
    words: np.ndarray


class Runs(NamedTuple):
    """Many runs of one structure: m of them, over l stretches of time, with `size` unknowns of which `n` are
    displacements.

    `stretches` (m + 1,): run i has the stretches from stretches[i] to stretches[i + 1]; `whole` (l, 4) and `real` (l,
    6) of each, see above, and `swing` (l, SWING) of dynamics/step_bounds.py; `tolerance` (m,); whether extremes are
    `asked` for, their `slack` (m, 2) (m, rad), `level` (m,) (m), `windows` (m, WINDOWS, 2) (s) and `records` (m,
    WINDOWS, RECORD) of dynamics/extrema.py; `scales` (m, size); `y` (m, size) the start, then the end; `rate_places`
    (n,); `status` (m,); `counts` (m, 5): steps, evaluations, Jacobians, steps refused by error test and nonlinear
    solver; `orders` (m, MOST_ORDERS).
    """

    stretches: np.ndarray
    whole: np.ndarray
    real: np.ndarray
    swing: np.ndarray
    tolerance: np.ndarray
    asked: bool
    slack: np.ndarray
    level: np.ndarray
    windows: np.ndarray
    records: np.ndarray
    scales: np.ndarray
    y: np.ndarray
    rate_places: np.ndarray
    status: np.ndarray
    counts: np.ndarray
    orders: np.ndarray


class Touching(NamedTuple):
    """What is kept of contacts: place of the `impulse` in the unknowns, `error` (m,) of the gap (m), `open` (m, STATE),
    `rows` (m, most, ROW) and how many of them are `found` (m,)."""

    impulse: int
    error: np.ndarray
    open: np.ndarray
    rows: np.ndarray
    found: np.ndarray


class Output(NamedTuple):
    """Points of the tally: segment `times` (k,) (s) and `weights` (k,) (s), 0 before the loop, and displacements and
    rates (k, n) there; `room` (m + 1,): run i has the places from room[i] to room[i + 1]; `stiff` as of a Block."""

    room: np.ndarray
    times: np.ndarray
    weights: np.ndarray
    q: np.ndarray
    q_rate: np.ndarray
    stiff: bool


def numbers(segment) -> list[float]:
    """What a stretch has in `real`."""
    fastest = 2 * math.pi / segment.shortest_period
    return [segment.length, longest_step(segment), segment.time, segment.pace, fastest, longest_panel(segment)]


@outer_kernel(nogil=True)
def integrate_many(cvode, runs, thinnest, touching, output, told):
    """Integrate the runs one after the other; `thinnest` a function value, `touching` and `output` None where there is
    no contact or no tally.  `told` (2,): the loop stops at once where the first is not zero; the second counts
    the runs that are done."""
    for i in range(len(runs.status)):
        runs.status[i] = _one(cvode, runs, i, thinnest, touching, output, told)
        if runs.status[i] == STOPPED:
            return
        told[1] += 1


@inner_kernel()
def _one(cvode, runs, i, thinnest, touching, output, told):
    """The run `i`; returns how it ended."""
    cvode.y[:] = runs.y[i]
    cvode.words[SCALES] = runs.scales[i].ctypes.data
    cvode.words[CALLS] = cvode.words[JACOBIANS] = 0
    status = DONE
    for stretch in range(runs.stretches[i], runs.stretches[i + 1]):
        status = _stretch(cvode, runs, i, stretch, thinnest, touching, output, told)
        add_refused(cvode.memory, runs.counts[i, 3:])
        if status != DONE:
            break
    runs.counts[i, 1], runs.counts[i, 2] = cvode.words[CALLS], cvode.words[JACOBIANS]
    runs.y[i] = cvode.y
    return status


@inner_kernel()
def _stretch(cvode, runs, i, stretch, thinnest, touching, output, told):
    """One stretch of the run `i` from the unknowns in `cvode.y` on; returns how it ended."""
    size, n, real, whole = len(cvode.y), len(runs.rate_places), runs.real[stretch], runs.whole[stretch]
    tolerance, length = runs.tolerance[i], real[LENGTH]
    for j in range(size):
        cvode.absolute[j] = tolerance * runs.scales[i, j]
    # As absolute_tolerances (solvers/contract.py).
    cvode.absolute[size - 1] = 1e30
    cvode.words[DATA] = whole[EQUATIONS]
    settings = restart_cvode(cvode.memory, cvode.vector, cvode.tolerances, 0.0, tolerance, length, real[LONGEST])
    if settings < 0:
        return ALONE
    block = carray(integers(whole[EQUATIONS]), WORDS)
    p, w, s, f = array(block, PARAMETERS), array(block, SCRATCH), array(block, GAP), array(block, FILM)
    windows = runs.windows[i] - real[START]
    most = BLOCK + 2 * OVERLAP + 1
    t, ys, reached = np.empty(most), np.empty((most, size)), np.zeros(1)
    q, q_rate, reach = np.empty((most, n)), np.empty((most, n)), np.empty((most, 2))
    scratch, rates = np.zeros(size), np.zeros(size)
    t[0], ys[0] = 0.0, cvode.y
    count, watched, begun = 1, 0, runs.counts[i, 0]
    if output is not None:
        whole[FIRST] = whole[END] = output.room[i] if stretch == runs.stretches[i] else runs.whole[stretch - 1, END]
    while reached[0] < length:
        taken, flag = step_cvode(
            cvode.memory, cvode.vector, cvode.y, reached, length, runs.orders[i],
            t[count : count + BLOCK], ys[count : count + BLOCK],
        )  # fmt: skip
        if flag < 0:
            return ALONE
        runs.counts[i, 0] += taken
        count += taken
        # The last intervals wait for their right-hand neighbours.
        renewed = reached[0] < length and runs.counts[i, 0] - begun >= RENEWED
        upto = count - 1 if renewed or reached[0] >= length else count - 1 - OVERLAP
        if upto > watched:
            for k in range(count):
                for j in range(n):
                    q[k, j], q_rate[k, j] = ys[k, j], ys[k, runs.rate_places[j]]
            fallen = track_extremes(
                t, q, q_rate, count, watched, upto, p, thinnest, f, scratch, rates, w, s, runs.swing[stretch], windows,
                whole[INDEX], runs.records[i], runs.asked, runs.level[i], runs.slack[i], real[PACE], real[FASTEST],
                reach,
            )  # fmt: skip
            if fallen >= 0.0:
                return ALONE
            if touching is not None:
                place = touching.found[i]
                free = touching.rows[i, place:]
                touching.found[i] += locate_contacts(
                    t, q, q_rate, np.ascontiguousarray(ys[:, touching.impulse]), count, watched, upto, reach, p,
                    thinnest, f, scratch, rates, w, s, real[START], real[PACE], touching.error[i], touching.open[i],
                    free,
                )  # fmt: skip
                if touching.found[i] == touching.rows.shape[1]:
                    return ALONE
            if output is not None:
                room = output.room[i + 1]
                if not _hand_over(cvode, runs, stretch, t, ys, q, q_rate, count, watched, upto, room, output):
                    return ALONE
            # Neighbours to the left of what comes next.
            keep = upto if renewed else max(0, upto - OVERLAP)
            for k in range(keep, count):
                t[k - keep], ys[k - keep] = t[k], ys[k]
            count, watched = count - keep, upto - keep
        if renewed:
            add_refused(cvode.memory, runs.counts[i, 3:])
            begun = runs.counts[i, 0]
            if restart_cvode(cvode.memory, cvode.vector, cvode.tolerances, t[0], tolerance, length, real[LONGEST]) < 0:
                return ALONE
        if told[0] != 0:
            return STOPPED
    return DONE


@inner_kernel()
def _hand_over(cvode, runs, stretch, t, ys, q, q_rate, count, begin, end, room, output):
    """Points of the tally in the steps [begin, end], the motion there as Block.at (solvers/contract.py); whether there
    was room for them."""
    whole, n, slopes = runs.whole[stretch], q.shape[1], np.empty(ys.shape[1])
    first = whole[END]
    free = slice(first, room)
    found = lobatto(t, begin, end, t[end], runs.real[stretch, PANEL], output.times[free], output.weights[free])
    if found < 0:
        return False
    whole[END] += found
    accelerations, unused = np.empty_like(q), np.empty((found, n))
    for k in range(count):
        call_rates(cvode.words[FUNCTION], t[k], ys[k].ctypes.data, slopes.ctypes.data, cvode.words[DATA])
        for j in range(n):
            accelerations[k, j] = slopes[runs.rate_places[j]]
    here = slice(first, first + found)
    times = output.times[here]
    sample(t, q, q_rate, count, begin, end, times, output.q[here], unused)
    if output.stiff:
        sample_doubtful(t, q_rate, accelerations, count, begin, end, times, output.q_rate[here])
    else:
        sample(t, q_rate, accelerations, count, begin, end, times, output.q_rate[here], unused)
    return True
