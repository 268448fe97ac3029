"""Where a run's samples go: into an archive."""

import math
import time as clock
from copy import deepcopy
from fractions import Fraction

import numpy as np

from ..archive import FIELD_TIME, Fields, Series
from ..dynamics.signals import (
    field_grid,
    fields,
    fields_of,
    samples,
    series_of,
    signal_table,
)
from ..quantities import everyday
from ..scene.radial import RadialScene
from ..solvers.run_error import EnergyAudit
from .verification_run import ProgressSink

# Single events kept in an archive; a seal that rubs for hours has more, which are counted.
MOST_EVENTS = 20_000
# Samples of which the film's fields are kept, both ends among them.  Less one this is a prime: they seldom fall on the
# same shaft angle every time.
KEPT = 32
# And where a film that closes ends the run between two samples.
MOST_INSTANTS = KEPT + 1
# Instants at which gap and load around the shaft of a radial seal are kept, at most.
MOST_RADIAL = 600
# Seconds between the starts of the method that are kept to go on from: each is, where so few steps lie between.
EVERY = 0.3


def archived_series(model) -> tuple[dict[str, Series], Fields | None]:
    """Series by name, and the fields if it has any, as an archive of this model keeps them."""
    if isinstance(model.scene, RadialScene):
        from ..radial_seals.observers import archived_series

        return archived_series(model, MOST_RADIAL + 2)
    series = {signal.name: Series(signal.unit, signal.long_name, *signal.display) for signal in signal_table(model)}
    table = fields_of(model)
    if not table:
        return series, None
    r, theta = field_grid(model)
    grid = {
        "r": (Series("m", "radius", *everyday("radius")), r),
        "theta": (Series("rad", "angle, from the x axis", *everyday("angle")), theta),
    }
    return series, Fields({x.name: Series(x.unit, x.long_name, *x.shown) for x in table}, grid, MOST_INSTANTS)


class ArchiveSink(ProgressSink):
    """Takes what the solver has integrated: signals into the archive (`writer`), restart data beside them.  Samples
    every `dt` (s), `count` intervals in all; `tally` (dynamics/tally.py) of the same run, or None; `progress(t, end)`
    (s) and `stop() -> bool` as in `simulate`, or None."""

    def __init__(self, run, writer, dt, count, tally, progress, stop):
        super().__init__(run, progress, stop)
        self.writer, self.dt, self.count, self.tally = writer, dt, count, tally
        self.audit, self.errors, self.seen = EnergyAudit(), None, None
        self.waiting = self.waiting_fields = None
        self.kept = np.rint(np.linspace(0, count, KEPT))
        self.logged, self.pending = 0, []
        # What is known of the run as a whole, and the last start of its method.
        self.begun, self.start, self.since = {}, None, -math.inf

    def due(self, segment) -> np.ndarray:
        """Segment times (m,) (s) of the samples in a segment, counted from the nearest sample so that they
        stay exact."""
        first = max(0, math.ceil(segment.time / self.dt - 1e-9))
        # The offset of the first sample is taken in exact arithmetic.
        offset = float(Fraction(self.dt) * first - segment.interval.start)
        end, last = segment.length, segment.last
        number = math.floor((end - offset) / self.dt + 1e-9) + 1
        taus = offset + self.dt * np.arange(max(number, 0))
        # A sample at a segment's end belongs to the next one, whose parameters it shows; the run's last stays.
        keep = (taus >= -1e-12 * end) & ((taus < end * (1 - 1e-12)) | last)
        return np.clip(taus[keep & (first + np.arange(len(taus)) <= self.count)], 0.0, end)

    def take(self, segment, taus, q, q_rate, x=None):
        """Signals at segment times (m,) (s) from displacements and rates (m, n) and the film's unknowns, kept until the
        next flush."""
        at = samples(segment, taus, q, q_rate, x)
        self.run.extrema.see(at)
        columns = series_of(at)
        if fields_of(segment.model):
            self.keep_fields(at, columns["time"], x)
        self.waiting = _joined(self.waiting, columns)

    def keep_fields(self, at, times, x):
        """Fields at those of the samples `at` that keep them, at `times` (m,) (s) of the run: those that are due, and
        one that is no sample, the end of a run."""
        steps = times / self.dt
        number = np.rint(steps)
        next_kept = self.kept[np.minimum(np.searchsorted(self.kept, number), KEPT - 1)]
        places = np.flatnonzero((next_kept == number) | (np.abs(steps - number) > 1e-6))
        if len(places):
            found = {FIELD_TIME: times[places], **fields(at, places, x)}
            self.waiting_fields = _joined(self.waiting_fields, found)

    def event(self, segment, tau, event):
        """Keep a change of the equations (an archive's event without its time) at segment time `tau` (s)."""
        self.log([{**event, "time": segment.time + tau}])

    def log(self, events):
        """Keep events until the next flush; beyond the most that an archive keeps they are dropped (ContactSummary
        counts them)."""
        kept = events[: max(MOST_EVENTS - self.logged, 0)]
        self.logged += len(kept)
        self.pending += kept

    def state(self, segment, tau, y):
        """Flush what has been taken, with the state at segment time `tau` (s), `y` (size,); raises Enough when `stop`
        asks for it."""
        self.flush(segment.index, tau, y)
        super().state(segment, tau, y)

    def flush(self, index, tau, y):
        """Write rows, what happened, and the state to go on from (segment index, `tau` (s), `y` (size,)): all three
        belong together."""
        if self.waiting is None:
            return
        self.run.contacts.tell(self.log)
        self.write_events()
        here = {"leg": index, "tau": tau, "y": np.asarray(y), "names": self.run.model.unknowns.names}
        self.writer.append(self.waiting, {**self.begun, **here, "point": self.start}, self.waiting_fields)
        self.waiting = self.waiting_fields = None

    def point(self, segment, tau, y, account):
        """Keep a start of the method at segment time `tau` (s), unknowns `y` (size,), to go on from: all that has been
        observed, what has been written by then, and the `account` of solvers/integrate.py."""
        now = clock.monotonic()
        if self.waiting is not None or now - self.since < EVERY:
            return
        run, self.since = self.run, now
        self.start = deepcopy(
            {
                "leg": segment.index,
                "tau": tau,
                "y": y,
                "account": account,
                "records": run.extrema.state(),
                "tally": self.tally and self.tally.state(),
                "audit": self.audit.state(),
                "errors": self.errors and self.errors.state(),
                "seen": self.seen and self.seen.state(),
                "modes": run.modes(),
                "logged": self.logged,
                "pending": self.pending,
                "written": self.writer.counts(),
            }
        )

    def restore(self, point: dict):
        """Go on from a `point` that was kept; it stays what it is, as it may be gone on from again."""
        run, self.start, point = self.run, point, deepcopy(point)
        run.extrema.restore(point["records"])
        run.restore_modes(point["modes"])
        self.audit.restore(point["audit"])
        for observer, name in ((self.tally, "tally"), (self.errors, "errors"), (self.seen, "seen")):
            if observer:
                observer.restore(point[name])
        self.logged, self.pending = int(point["logged"]), list(point["pending"])
        self.since = clock.monotonic()

    def write_events(self):
        """Hand the events kept so far to the archive."""
        if self.pending:
            self.writer.events(self.pending)
        self.pending = []


def _joined(waiting: dict | None, columns: dict) -> dict:
    return columns if waiting is None else {k: np.concatenate([waiting[k], columns[k]]) for k in columns}


class RadialSink(ArchiveSink):
    """Takes the series of a radial seal, and at a few instants what is around the shaft."""

    def __init__(self, run, writer, dt, count, tally, progress, stop):
        super().__init__(run, writer, dt, count, tally, progress, stop)
        self.kept = np.rint(np.linspace(0, count, min(count + 1, MOST_RADIAL)))

    def take(self, segment, taus, q, q_rate, x=None):
        """Series and fields at segment times (m,) (s) of displacements and rates (m, n)."""
        from ..radial_seals.observers import columns

        found, around = columns(segment, taus, q, q_rate)
        number = found["time"] / self.dt
        at = np.flatnonzero(np.isin(np.rint(number), self.kept) & (np.abs(number - np.rint(number)) < 1e-6))
        if len(at):
            fields = {FIELD_TIME: found["time"][at], **{name: values[at] for name, values in around.items()}}
            self.waiting_fields = _joined(self.waiting_fields, fields)
        self.waiting = _joined(self.waiting, found)
