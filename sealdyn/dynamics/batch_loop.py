"""Many runs in one compiled loop: each integrated by CVODE, its extremes and contacts followed, its samples
interpolated, and nothing of Python between them.

The same kernels look at the same steps as in a run of its own (solvers/integrate.py), so that numbers are the same to
the bit at the same tolerance.  A run that does not end well is left for that other way, which can say why.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import carray

from ..numerics.hermite import sample, sample_doubtful
from ..numerics.kernel import call_rates, inner_kernel, integers, outer_kernel
from ..solvers.contract import OVERLAP
from ..solvers.sundials_direct import add_refused, restart_cvode, step_cvode
from ..solvers.sundials_libraries import BLOCK, CALLS, DATA, FUNCTION, JACOBIANS, SCALES
from ..solvers.sundials_python import longest_step
from .contact_events import locate_contacts
from .extrema import track_extremes
from .native import BLOCK as WORDS
from .native import FILM, GAP, PARAMETERS, SCRATCH, array

# How a run ended: well, as one to be looked at alone, or not at all because the loop was told to stop.
DONE, ALONE, STOPPED = range(3)
# Of a stretch: address of its equations' block, its index in the run, its first output and the one after its last;
# length (s), longest step (s, 0: any), start (s), pace of the scan and fastest motion of interest (rad/s).
EQUATIONS, INDEX, FIRST_DUE, END_DUE = range(4)
LENGTH, LONGEST, START, PACE, FASTEST = range(5)


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
    5) of each, see above, and `swing` (l, SWING) of dynamics/step_bounds.py; `tolerance` (m,); whether extremes are
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
    """Segment times `due` (k,) (s) of all stretches, one after the other, and displacements and rates (k, n) there;
    `stiff` as of a Block."""

    due: np.ndarray
    q: np.ndarray
    q_rate: np.ndarray
    stiff: bool


def numbers(segment) -> list[float]:
    """What a stretch has in `real`."""
    fastest = 2 * math.pi / segment.shortest_period
    return [segment.length, longest_step(segment), segment.time, segment.pace, fastest]


@outer_kernel(nogil=True)
def integrate_many(cvode, runs, thinnest, touching, output, told):
    """Integrate the runs one after the other; `thinnest` a function value, `touching` and `output` None where there is
    no contact or nothing is due.  `told` (2,): the loop stops at once where the first is not zero; the second counts
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
    most = BLOCK + OVERLAP + 1
    t, ys, reached = np.empty(most), np.empty((most, size)), np.zeros(1)
    q, q_rate, reach = np.empty((most, n)), np.empty((most, n)), np.empty(most)
    scratch, rates = np.zeros(size), np.zeros(size)
    t[0], ys[0] = 0.0, cvode.y
    count, watched, done = 1, 0, whole[FIRST_DUE]
    while reached[0] < length:
        taken, flag = step_cvode(
            cvode.memory, cvode.vector, cvode.y, reached, length, runs.orders[i], t[count:], ys[count:]
        )
        if flag < 0:
            return ALONE
        runs.counts[i, 0] += taken
        count += taken
        # The last intervals wait for their right-hand neighbours.
        upto = count - 1 if reached[0] >= length else count - 1 - OVERLAP
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
                done = _hand_over(cvode, runs, whole, t, ys, q, q_rate, count, watched, upto, done, output)
            # Neighbours to the left of what comes next.
            keep = max(0, upto - OVERLAP)
            for k in range(keep, count):
                t[k - keep], ys[k - keep] = t[k], ys[k]
            count, watched = count - keep, upto - keep
        if told[0] != 0:
            return STOPPED
    return DONE


@inner_kernel()
def _hand_over(cvode, runs, whole, t, ys, q, q_rate, count, begin, end, done, output):
    """Output due in the steps [begin, end], as Block.at (solvers/contract.py); returns how many are done."""
    last = done
    while last < whole[END_DUE] and output.due[last] <= t[end]:
        last += 1
    if last == done:
        return done
    n, slopes = q.shape[1], np.empty(ys.shape[1])
    accelerations, unused = np.empty_like(q), np.empty((last - done, n))
    for k in range(max(0, begin - OVERLAP), min(count, end + OVERLAP + 1)):
        call_rates(cvode.words[FUNCTION], t[k], ys[k].ctypes.data, slopes.ctypes.data, cvode.words[DATA])
        for j in range(n):
            accelerations[k, j] = slopes[runs.rate_places[j]]
    times = output.due[done:last]
    sample(t, q, q_rate, count, begin, end, times, output.q[done:last], unused)
    if output.stiff:
        sample_doubtful(t, q_rate, accelerations, count, begin, end, times, output.q_rate[done:last])
    else:
        sample(t, q_rate, accelerations, count, begin, end, times, output.q_rate[done:last], unused)
    return last
