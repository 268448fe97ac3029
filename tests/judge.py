"""The truth of a scene by other methods than the program's own, and how far a run is from it.

Smooth scenes: SciPy's Radau or DOP853 on the scene's right-hand side, started anew at every instant that is compared,
so that nothing is interpolated.  Dry friction needs the events of `solve`: there the references are its runs by DOP853
and Radau.
"""

import numpy as np
from scipy.integrate import DOP853, Radau

from sealdyn.solvers.contract import absolute_tolerances
from sealdyn.solvers.integrate import solve


class Instants:
    """A sink for the columns of LookedAt at given times (m,) (s, of the run)."""

    def __init__(self, scales, times):
        self.scales, self.times, self.columns, self.reached = scales, times, [], 0

    def due(self, segment):
        end = np.inf if segment.last else segment.time + segment.length
        mine = self.times[(self.times >= segment.time) & (self.times < end)]
        return np.minimum(mine - segment.time, segment.length)

    def take(self, segment, taus, q, q_rate, x=None):
        # A run that ends early adds its end.
        kept = np.isin(taus, self.due(segment))
        self.columns.append(self.scales.of(segment, taus[kept], q[kept], q_rate[kept]))

    def state(self, *anything):
        pass

    event = state

    def all(self):
        return np.concatenate(self.columns)


def instants(random, run, count=240):
    """Times (s) at which runs are compared: anywhere, and closer to the starts and breaks, where fast parts decay."""
    anywhere = random.uniform(0.0, run.duration, count)
    starts = np.array([interval.time for interval in run.intervals][:6])
    after = starts[:, None] + run.duration * 10.0 ** random.uniform(-6.0, -1.0, (len(starts), count // 8))
    return np.unique(np.clip(np.concatenate([anywhere, after.ravel()]), 0.0, run.duration * (1 - 1e-9)))


def landed(run, scales, times, kind, tolerance):
    """Columns at the times by a solver class of SciPy, from instant to instant; fewer rows where the film closes or the
    solver gives up."""
    y, columns, step = run.y0.copy(), [], None
    for k in range(len(run.intervals)):
        segment, last = run.segment(k), k + 1 == len(run.intervals)
        absolute, tau = absolute_tolerances(segment, tolerance), 0.0
        end = np.inf if last else segment.time + segment.length
        stops = [float(t) - segment.time for t in times if segment.time <= t < end]
        for stop in [*stops, *([] if last else [segment.length])]:
            stop = min(max(stop, 0.0), segment.length)
            if stop > tau:
                y, step = _carried(segment, kind, tau, y, stop, tolerance, absolute, step)
                if y is None:
                    return np.concatenate(columns) if columns else np.empty((0, 0))
                tau = stop
            if stop in stops:
                q, rate = segment.motion(y[None, :], np.zeros((1, len(y))))
                columns.append(scales.of(segment, np.array([tau]), q, rate))
    return np.concatenate(columns)


def _carried(segment, kind, tau, y, stop, tolerance, absolute, step):
    def rates(t, y):
        yp = np.empty_like(y)
        segment.rhs(t, y, yp)
        return yp

    def jacobian(t, y):
        matrix = np.empty((segment.size, segment.size))
        segment.jacobian(t, np.array(y), None, matrix)
        return matrix

    options = {"jac": jacobian} if kind is Radau else {}
    first = min(step, stop - tau) if step else None
    solver = kind(rates, tau, y, stop, rtol=max(tolerance, 1e-13), atol=absolute, first_step=first, **options)
    while solver.status == "running":
        with np.errstate(all="ignore"):
            solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            return None, None
        # The last step before a stop is cut short: no measure of the next.
        step = solver.h_abs if solver.status == "running" else max(solver.h_abs, step or 0.0)
    return solver.y, step


def by_events(run, scales, times, method, tolerance):
    """Columns at the times by `solve`, with its events."""
    sink = Instants(scales, times)
    outcome = solve(run, method, run.model.accuracy, sink, tolerance=tolerance)
    return sink.all() if outcome.status in ("ok", "collapsed") else np.empty((0, 0))


def truth(make, scales, times, accuracy, stiff):
    """Columns at the times, and how far (rows) two references agree within accuracy/100: the horizon.  `make()` a run
    with its start."""
    run, tolerance = make(), max(accuracy * 1e-4, 1e-12)
    if run.stick_slip:
        found = [
            by_events(make(), scales, times, method, tol)
            for method, tol in (("radau", tolerance / 10), ("dop853" if not stiff else "bdf", tolerance))
        ]
    else:
        kinds = (Radau, Radau) if stiff else (DOP853, DOP853)
        found = [
            landed(make(), scales, times, kind, tol)
            for kind, tol in zip(kinds, (tolerance / 10, tolerance), strict=True)
        ]
    rows = min(map(len, found))
    if rows == 0:
        return found[0], 0
    apart = scales.errors(found[0][:rows], found[1][:rows]).max(axis=1)
    bad = np.flatnonzero(apart > accuracy / 100)
    return found[0], int(bad[0]) if len(bad) else rows
