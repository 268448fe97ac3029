"""A run of the compiled loop: made ready for it, and what is left of it afterwards."""

from threading import Event, Thread

import numpy as np

from ..dynamics.contact_events import ROW
from ..dynamics.extrema import slack, watched_level
from ..dynamics.function_values import thinnest_value
from ..solvers.contract import MOST_ORDERS, Cause, Counts, Status, tolerance_for
from ..solvers.integrate import STIFF, Outcome
from ..solvers.sundials import looped
from .outputs import with_speeds
from .simulate import prepare_run
from .sinks import TallySink
from .summary import parts

# Contacts of one run at most, numbers that a run may hand over, and seconds between two looks at the keyboard.
MOST_CONTACTS, MOST_OUTPUT, PATIENCE = 256, 4_000_000, 0.1
# Parts of the summary that are made of samples, and what only a run of its own has.
SAMPLED = (
    "leakage", "friction", "relative_misalignment.mean", "contact.force", "contact.share_of_closing",
    "contact.share_of_load", "contact.torque", "contact.max_area_fraction", "contact.max_pressure", "contact.wear_rate",
    "film.max_cavitated_fraction", "warnings",
)  # fmt: skip
# Those that are extremes between steps.
EXTREMES = ("h_min", "relative_misalignment")
OWN = ("energy_residual", "counts.back_end")


class LoopedRun:
    """A scenario made ready: `run`, `method`, `segments`; `structure` is equal for runs that can share a loop, and None
    for one that can be in none.  `outcome` (solvers/integrate.py) is None until it has ended well."""

    def __init__(self, scenario, outputs):
        self.scenario, self.outputs, self.outcome = scenario, outputs, None
        self.run, self.method, self.why, interval, count, _ = prepare_run(scenario)
        run, unknowns = self.run, self.run.model.unknowns
        self.tolerance = tolerance_for(self.method, run.model.accuracy, run.memory)
        self.structure = None
        self.sampled, self.watched = (any(key.startswith(asked) for key in outputs) for asked in (SAMPLED, EXTREMES))
        self.segments = [run.segment(index) for index in range(len(run.intervals))]
        alone = run.stick_slip or any(key.startswith(OWN) for key in outputs) or not looped(self.segments[0])
        heavy = self.sampled and count * unknowns.n > MOST_OUTPUT
        if alone or heavy or self.method not in ("adams", "bdf"):
            return
        self.sink = TallySink(run, interval, count)
        thinnest, touching = thinnest_value(run.model.face), run.model.contact is not None
        places = tuple(unknowns.rate_places)
        kernels = thinnest, touching, unknowns.impulse
        self.structure = self.method, unknowns.size, places, *kernels, self.sampled, self.watched

    def parts(self) -> dict:
        """The `parts` of its summary (summary.py), once it has ended."""
        tally = self.sink.tally if self.sampled else Unsampled()
        why = f"{self.why}; one loop for many runs, cautious tolerance"
        return parts(self.scenario, self.run, self.outcome, tally, self.method, why, with_speeds(self.outputs))

    def ends(self, runs, i, touching, output):
        """Take what the loop has left in row `i`."""
        run, last = self.run, self.segments[-1]
        run.extrema.records = runs.records[i] if self.watched else Unsampled()
        if touching:
            run.contacts.open[:] = touching.open[i]
            run.contacts.waiting = list(touching.rows[i, : touching.found[i]])
        steps, rhs, jacobians, rejected, unsolved = map(int, runs.counts[i])
        counts = Counts(rhs, steps, jacobians, len(self.segments), rejected, unsolved, runs.orders[i].tolist())
        y, said = runs.y[i].copy(), str(Cause.DONE)
        run.last = last.index, last.length, y
        self.outcome = Outcome(
            Status.OK, Cause.DONE, said, counts, 0.0, last.index, last.length, y, self.tolerance, np.nan
        )
        run.contacts.tell(self.sink.log, end=(run.end_time(last.index, last.length), y))
        if self.sampled:
            for k, segment in enumerate(self.segments):
                at = slice(*runs.whole[runs.stretches[i] + k, 2:4])
                if at.stop > at.start:
                    self.sink.take(segment, output.due[at], output.q[at], output.q_rate[at])


class NotSampled(Exception):
    """A number made of samples, or an extreme between steps, was asked for, and there are none."""


class Unsampled:
    """In place of a tally where nothing was sampled, or of records where none were kept: all it has to say is
    NotSampled."""

    def __getattr__(self, name):
        raise NotSampled

    def __getitem__(self, key):
        raise NotSampled


def integrate(alike: list[LoopedRun]):
    """Integrate runs of one structure; those that end well get their outcome.  Raises KeyboardInterrupt within
    PATIENCE."""
    # Compiled and linked with the libraries as it is imported.
    from ..dynamics import batch_loop as loop
    from ..solvers.sundials_direct import cvode_for
    from ..solvers.sundials_objects import words_for

    first = alike[0]
    runs, touching, output = _stacked(alike, loop)
    told, y, absolute = np.zeros(2, dtype=np.int64), np.empty(runs.y.shape[1]), np.ones(runs.y.shape[1])
    words = words_for(first.segments[0], first.segments[0].native.rates)
    with cvode_for(y, absolute, words, first.method) as (memory, vector, tolerances):
        cvode = loop.Integrator(memory.value, vector.value, tolerances.value, y, absolute, words)
        given = cvode, runs, thinnest_value(first.run.model.face), touching, output, told
        _in_a_thread(loop.integrate_many, given, told)
    for i, one in enumerate(alike):
        if runs.status[i] == loop.DONE:
            one.ends(runs, i, touching, output)


def _in_a_thread(loop, given, told):
    """Call the loop where it does not keep Python from seeing a KeyboardInterrupt; told of one it stops, and only then
    is this left, since others own what it works on."""
    failures, ended = [], Event()

    def call():
        try:
            loop(*given)
        except Exception as error:
            failures.append(error)
        finally:
            ended.set()

    Thread(target=call).start()
    interrupted = False
    while not ended.is_set():
        try:
            ended.wait(PATIENCE)
        except KeyboardInterrupt:
            interrupted, told[0] = True, 1
    if interrupted:
        raise KeyboardInterrupt
    if failures:
        raise failures[0]


def _stacked(alike, loop):
    """The runs as the loop takes them."""
    models, count = [one.run.model for one in alike], len(alike)
    stretches = np.cumsum([0, *(len(one.segments) for one in alike)])
    segments = [segment for one in alike for segment in one.segments]
    due = [one.sink.due(segment) if one.sampled else np.empty(0) for one in alike for segment in one.segments]
    ends = np.cumsum([0, *map(len, due)])
    runs = loop.Runs(
        stretches,
        np.array([[s.native.block.ctypes.data, s.index, ends[k], ends[k + 1]] for k, s in enumerate(segments)]),
        np.array([loop.numbers(segment) for segment in segments]),
        np.array([segment.swing for segment in segments]),
        np.array([one.tolerance for one in alike]),
        alike[0].watched,
        np.array([slack(model) for model in models]),
        np.array([watched_level(model) for model in models]),
        np.array([one.run.extrema.windows for one in alike], dtype=float),
        np.array([one.run.extrema.records for one in alike]),
        np.array([model.scales for model in models]),
        np.array([one.run.y0 for one in alike]),
        alike[0].segments[0].rate_places,
        np.full(count, loop.STOPPED),
        np.zeros((count, 5), dtype=np.int64),
        np.zeros((count, MOST_ORDERS), dtype=np.int64),
    )
    touching = output = None
    if models[0].contact is not None:
        touching = loop.Touching(
            models[0].unknowns.impulse,
            np.array([model.gap_error() for model in models]),
            np.array([one.run.contacts.open for one in alike]),
            np.empty((count, MOST_CONTACTS, ROW)),
            np.zeros(count, dtype=np.int64),
        )
    if alike[0].sampled:
        q, q_rate = np.empty((2, ends[-1], models[0].unknowns.n))
        output = loop.Output(np.concatenate(due), q, q_rate, alike[0].method in STIFF)
    return runs, touching, output
