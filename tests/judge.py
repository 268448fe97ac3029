"""The truth of a scene by other methods than the program's own choice, and how far a run is from it.

Two references, and the truth as far as they agree.  The first, of smooth scenes: SciPy's Radau or DOP853 on the
scene's right-hand side, started anew at every instant that is compared, so that nothing is interpolated.  The second:
a run of `solve` by the method that the program chooses, far sharper; where the first takes too long, or dry friction
needs the events of `solve`, also one by another method.
"""

import math
import time
from dataclasses import dataclass

import numpy as np
from own_words import OwnSeal, own
from scipy.integrate import DOP853, Radau
from scipy.sparse import csc_matrix

from sealdyn.faces.film_thickness import h_min_of
from sealdyn.faces.geometry import COLLAPSE
from sealdyn.simulation.verification_run import clip_jumps
from sealdyn.solvers.contract import absolute_tolerances
from sealdyn.solvers.integrate import solve


class TooLong(Exception):
    """A reference took longer than it may."""


class Instants:
    """A sink for the columns of ErrorScales at given times (m,) (s, of the run); raises TooLong after `deadline` (s, of
    time.process_time)."""

    def __init__(self, scales, times, deadline=math.inf):
        self.scales, self.times, self.deadline, self.columns = scales, times, deadline, []

    def due(self, segment):
        end = np.inf if segment.last else segment.time + segment.length
        mine = self.times[(self.times >= segment.time) & (self.times < end)]
        return np.minimum(mine - segment.time, segment.length)

    def take(self, segment, taus, q, q_rate, x=None):
        # A run that ends early adds its end.
        kept = np.isin(taus, self.due(segment))
        own = None if x is None else x[kept]
        self.columns.append(self.scales.of(segment, taus[kept], q[kept], q_rate[kept], own))

    def state(self, *anything):
        if time.process_time() > self.deadline:
            raise TooLong

    def event(self, *anything):
        pass

    def all(self):
        return np.concatenate(self.columns) if self.columns else np.empty((0, 0))


def instants(random, run, count=240):
    """Times (s) at which runs are compared: anywhere, and closer to the starts and breaks, where fast parts decay, and
    before the end, where the last step is cut short."""
    anywhere = random.uniform(0.0, run.duration, count)
    starts = np.array([interval.time for interval in run.intervals][:6])
    after = starts[:, None] + run.duration * 10.0 ** random.uniform(-6.0, -1.0, (len(starts), count // 8))
    before = run.duration * (1.0 - 10.0 ** random.uniform(-6.0, -1.0, count // 8))
    return np.unique(np.clip(np.concatenate([anywhere, after.ravel(), before]), 0.0, run.duration * (1 - 1e-9)))


def landed(run, scales, times, kind, tolerance, deadline=math.inf):
    """Columns at the times by a solver class of SciPy, from instant to instant; fewer rows where the film closes or the
    solver gives up.  Raises TooLong."""
    y, columns, step = run.y0.copy(), [], None
    run.segment(0).settle_film(0.0, y)
    for k in range(len(run.intervals)):
        segment, last = run.segment(k), k + 1 == len(run.intervals)
        absolute, tau = absolute_tolerances(segment, tolerance), 0.0
        end = np.inf if last else segment.time + segment.length
        stops = [float(t) - segment.time for t in times if segment.time <= t < end]
        for stop in [*stops, *([] if last else [segment.length])]:
            stop = min(max(stop, 0.0), segment.length)
            if stop > tau:
                y, step = _carried(segment, kind, tau, y, stop, tolerance, absolute, step, deadline)
                if y is None:
                    return np.concatenate(columns) if columns else np.empty((0, 0))
                tau = stop
            if stop in stops:
                q, rate = segment.motion(y[None, :], np.zeros((1, len(y))))
                x = None if segment.model.unknowns.film_unknowns is None else y[None, segment.film]
                columns.append(scales.of(segment, np.array([tau]), q, rate, x))
    return np.concatenate(columns)


def _rates_and_jacobian(segment):
    """Functions of time and unknowns; of a film with unknowns their rates stand alone in its balances, and the matrix
    is sparse."""
    coupled = segment.model.unknowns.film_unknowns is not None

    def rates(t, y):
        yp = np.zeros_like(y)
        if not coupled:
            segment.rhs(t, y, yp)
            return yp
        segment.ring_rates(t, y, yp)
        left = np.empty_like(y)
        segment.residual(t, y, np.zeros_like(y), left)
        yp[segment.film] = -left[segment.film]
        return yp

    def jacobian(t, y):
        if coupled:
            pattern = segment.pattern
            data = np.empty(pattern.nnz)
            segment.residual_derivatives(t, y, np.zeros_like(y), 0.0, data)
            return csc_matrix((-data, pattern.indices, pattern.indptr), shape=pattern.shape)
        matrix = np.empty((segment.size, segment.size))
        segment.jacobian(t, np.array(y), None, matrix)
        return matrix

    return rates, jacobian


def _carried(segment, kind, tau, y, stop, tolerance, absolute, step, deadline):
    rates, jacobian = _rates_and_jacobian(segment)
    face = segment.model.face
    thinnest = h_min_of(face)
    options = {"jac": jacobian} if kind is Radau else {}
    first = min(step, stop - tau) if step else None
    solver = kind(rates, tau, y, stop, rtol=max(tolerance, 1e-13), atol=absolute, first_step=first, **options)
    while solver.status == "running":
        with np.errstate(all="ignore"):
            solver.step()
        if time.process_time() > deadline:
            raise TooLong
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            return None, None
        if thinnest(face, segment.gap_state(solver.t, solver.y))[0] < face[COLLAPSE]:
            return None, None
        # The last step before a stop is cut short: no measure of the next.
        step = solver.h_abs if solver.status == "running" else max(solver.h_abs, step or 0.0)
    return solver.y, step


def by_steps(run, scales, times, method, tolerance, deadline=math.inf):
    """Columns at the times by `solve`, and its contacts (events as in an archive).  Raises TooLong."""
    sink = Instants(scales, times, deadline)
    outcome = solve(run, method, run.model.accuracy, sink, tolerance=tolerance)
    found = sink.all() if outcome.status in ("ok", "collapsed") and sink.columns else np.empty((0, 0))
    return found, all_contacts(run, outcome)


def all_contacts(run, outcome) -> list[dict]:
    """Contacts and grazes of a run that has been solved, as events of an archive."""
    events = []
    run.contacts.tell(events.extend, end=(run.end_time(outcome.segment, outcome.tau), outcome.y))
    return events


def contact_errors(found, true, until, run, rate):
    """Contacts of a run against the true ones up to the time `until` (s): how many are missed or too many, and the
    largest error of their depth over the clearance and of touch and lift-off times the reference `rate` (rad/s).  Those
    shallower than the accuracy do not count, and times only of contacts that are one in both."""
    least, clearance = 2 * max(run.model.accuracy * run.model.clearance, run.model.gap_error()), run.model.clearance

    def meet(one, other):
        ends = [event["lift_off"] if np.isfinite(event["lift_off"]) else math.inf for event in (one, other)]
        return one["time"] <= ends[1] + slack and other["time"] <= ends[0] + slack

    slack, wrong, depth, time_error = 1e-3 / rate, 0, 0.0, 0.0
    for ours, theirs in ((found, true), (true, found)):
        for event in ours:
            if event["depth"] <= least or event["deepest"] >= until:
                continue
            met = [other for other in theirs if meet(event, other)]
            wrong += not met
            if met:
                depth = max(depth, min(abs(event["depth"] - other["depth"]) for other in met) / clearance)
            if len(met) == 1 and sum(meet(met[0], other) for other in ours) == 1:
                time_error = max(time_error, abs(event["time"] - met[0]["time"]) * rate)
                if max(event["lift_off"], met[0]["lift_off"]) < until:
                    time_error = max(time_error, abs(event["lift_off"] - met[0]["lift_off"]) * rate)
    return wrong, depth, time_error


@dataclass
class Truth:
    """Columns (m, ...) at the instants, of which the first `rows` are known to accuracy/100; contacts (events); and how
    it was found."""

    columns: np.ndarray
    rows: int
    contacts: list[dict]
    found_by: str


def truth(make, scales, times, accuracy, chosen, budget=30.0) -> Truth | None:
    """The truth of a run that `make()` gives, with its start; `chosen` the method that the program takes, `budget` (s)
    of processor time of each reference.  None if fewer than two references are found."""
    tolerance = max(accuracy * 1e-4, 1e-12)
    kind = DOP853 if chosen in ("adams", "dop853", "expm") else Radau
    methods = (
        (f"{chosen}, sharper", chosen, tolerance / 10),
        ("dop853", "dop853", tolerance),
        ("radau", "radau", tolerance),
    )
    plans = [
        (name, lambda until, method=method, sharp=sharp: by_steps(make(), scales, times, method, sharp, until))
        for name, method, sharp in methods
    ]
    if not make().stick_slip:
        plans.insert(
            0, (kind.__name__, lambda until: (landed(make(), scales, times, kind, tolerance / 10, until), None))
        )
    found = []
    for name, plan in plans:
        try:
            columns, contacts = plan(time.process_time() + budget)
        except TooLong:
            continue
        if len(columns):
            found.append((name, columns, contacts))
        if len(found) == 2:
            break
    if len(found) < 2:
        return None
    (one, columns, _), (two, others, contacts) = found
    return Truth(columns, _agreed(scales, columns, others, accuracy), contacts, f"{one} and {two}")


def truth_by_steps(make, scales, times, accuracy, method, budget=60.0) -> Truth | None:
    """As `truth`, of a film that one method alone passes: by that method twice, far sharper than a run would be, as far
    as they agree within a tenth of the accuracy."""
    found = []
    for sharp in (accuracy / 2e3, accuracy / 6e3):
        try:
            columns, contacts = by_steps(make(), scales, times, method, sharp, time.process_time() + budget)
        except TooLong:
            return None
        found.append((columns, contacts))
    (others, _), (columns, contacts) = found
    if not len(columns) or not len(others):
        return None
    known = _agreed(scales, columns, others, accuracy, 0.1, clip_jumps)
    return Truth(columns, known, contacts, f"{method} twice, sharper")


def truth_in_own_words(make, scales, times, accuracy, chosen, budget=60.0) -> Truth | None:
    """As `truth`, by equations that share nothing with the program (tests/own_words.py), solved twice; contacts are a
    sharper run's.  None for a scene which they do not know, or that takes too long."""
    run = make()
    # Radau's method errs by less than its tolerance, and gas that stores makes it dear.
    tolerance = max(accuracy * (1e-4 if run.model.scene.film.gas is None else 1e-3), 1e-12)
    scene, kind = run.model.scene, Radau if chosen in ("bdf", "ida") else DOP853
    try:
        names = OwnSeal(scene, run.duration).names
        columns, others = (
            own(scene, run.duration, run.y0[: 2 * len(names)], times, sharp, kind, time.process_time() + budget)
            for sharp in (tolerance / 10, tolerance)
        )
        _, contacts = by_steps(run, scales, times, chosen, tolerance / 10, time.process_time() + budget)
    except (NotImplementedError, TimeoutError, TooLong):
        return None
    assert names == run.model.unknowns.names
    if not len(columns) or not len(others):
        return None
    return Truth(columns, _agreed(scales, columns, others, accuracy), contacts, f"own words, {kind.__name__} twice")


def _agreed(scales, columns, others, accuracy, share=0.01, counted=np.asarray):
    """Rows up to which two references are one to a share of the accuracy, in errors that are `counted`."""
    rows = min(len(columns), len(others))
    apart = counted(scales.errors(columns[:rows], others[:rows])).max(axis=1)
    bad = np.flatnonzero(apart > accuracy * share)
    return int(bad[0]) if len(bad) else rows
