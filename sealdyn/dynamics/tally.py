"""What a run is told by beside its samples: contacts of the faces, located between steps (touch, deepest place,
lift-off, impulse), and means and largest values of its series, integrals over the solver's steps and peaks between
them.

As in dynamics/extrema.py the motion inside a step is a polynomial and the imposed motion exact, so no contact is
missed however long the step; what is closer to touching than the gap's own error is called grazing, since it cannot
be decided.
Whatever is sampled for an archive, means and peaks are of the motion itself.  Lobatto's rule (numerics/hermite.py) on
panels of a few steps, at most so long that an oscillation of TIMES the fastest motion of interest keeps the accuracy; a
peak is sought where a parabola through three points rises above the largest value so far, and looked at there.
"""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..faces.geometry import TOUCH
from ..numerics.hermite import LOBATTO_ERROR, LOBATTO_ORDER, NODES, fit, points, sample
from ..numerics.kernel import inner_kernel, outer_kernel
from ..quantities import in_words
from .extrema import MOST_SCAN, PER_RADIAN, SCAN, crossing_time, locate_minimum, measures_at, scan_step
from .native import thinnest_value
from .signals import TALLIED, signals
from .step_bounds import THICKNESS

# One row per contact (or near miss): 1 a contact, 0 grazing; times of touch, lift-off and deepest place (s); film
# thickness (m), angle (rad) and radius (m) there; impulse (N s).
KIND, TOUCHED, LIFTED, DEEPEST, DEPTH_H, DEPTH_THETA, DEPTH_RADIUS, IMPULSE = range(8)
ROW = 8
# A contact that goes on, carried from block to block: its row so far, whether it is open, and whether the gap was
# sinking at the last step's end.
OPEN, SINKING = ROW, ROW + 1
STATE = ROW + 2


@dataclass
class ContactSummary:
    """Contacts so far: how many, grazing ones, the first touch (s), the thinnest film in any (`lowest`, m), the longest
    (s), and the sum of impulses (N s)."""

    count: int = 0
    grazing: int = 0
    first: float | None = None
    lowest: float | None = None
    longest: float = 0.0
    impulse: float = 0.0

    def add(self, rows):
        """Count the contacts of `rows` (k, ROW), as `locate_contacts` writes them."""
        for row in rows:
            if row[KIND] == 0.0:
                self.grazing += 1
                continue
            self.count += 1
            self.first = float(row[TOUCHED]) if self.first is None else self.first
            self.lowest = float(row[DEPTH_H] if self.lowest is None else min(self.lowest, row[DEPTH_H]))
            self.impulse += float(row[IMPULSE])
            if np.isfinite(row[LIFTED]):
                self.longest = max(self.longest, float(row[LIFTED] - row[TOUCHED]))


def contact_event(row, level: float) -> dict:
    """A row (ROW,) as an event of the archive, `level` the film thickness (m) of touch: kind ("contact" or "grazing"),
    time, lift_off, deepest (s), value (thinnest film, m), theta (rad), radius (m), depth below touch (m), impulse (N
    s), text."""
    kind = "contact" if row[KIND] else "grazing"
    depth = level - row[DEPTH_H]
    text = (
        f"faces touch, {in_words('depth', depth, 3)} deep"
        if row[KIND]
        else f"{in_words('depth', abs(depth), 2)} {'below' if depth > 0 else 'above'} touch: undecided at this accuracy"
    )
    return {"kind": kind, "time": float(row[TOUCHED]), "value": float(row[DEPTH_H]), "text": text,
            "lift_off": float(row[LIFTED]), "deepest": float(row[DEEPEST]), "theta": float(row[DEPTH_THETA]),
            "radius": float(row[DEPTH_RADIUS]), "impulse": float(row[IMPULSE]), "depth": float(depth)}  # fmt: skip


@inner_kernel()
def _begin(state, touched, impulse):
    state[OPEN], state[TOUCHED], state[IMPULSE], state[DEPTH_H] = 1.0, touched, impulse, np.inf


@inner_kernel()
def _deepen(state, at, h, theta, radius):
    if h < state[DEPTH_H]:
        state[DEEPEST], state[DEPTH_H], state[DEPTH_THETA], state[DEPTH_RADIUS] = at, h, theta, radius


@inner_kernel()
def _close(state, lifted, impulse, level, error, rows, count):
    """A contact ends: its row is written; shallower than the error it is grazing."""
    rows[count] = state[:ROW]
    rows[count, LIFTED], rows[count, IMPULSE] = lifted, impulse - state[IMPULSE]
    rows[count, KIND] = 1.0 if level - state[DEPTH_H] > error else 0.0
    state[OPEN] = 0.0
    return count + 1


@outer_kernel()
def locate_contacts(t, q_all, q_rate_all, impulse, count, begin, end, reach, p, thinnest, f, y, yp, w, s, start, pace,
                    error, state, rows):  # fmt: skip
    """Contacts in steps [begin, end] of a segment that starts at `start` (s), into `rows` (k, ROW); returns how many
    ended.

    `t` (count,), `q_all`, `q_rate_all` (count, n) the accepted steps, `impulse` (count,) the impulse so far (N s),
    `reach` (count, 2) bounds of the thinnest film (m) of a step; `p`, `w`, `s` as in dynamics/equations.py, `thinnest`
    as in extrema.py, `f` the film's block, `y`, `yp` (size,) scratch; `error` of the gap (m); `pace` the fastest
    imposed motion (rad/s); `state` (STATE,) is carried from call to call.
    """
    n, level = q_all.shape[1], f[TOUCH]
    table, nodes = np.zeros((2 * NODES, n)), np.zeros(2 * NODES)
    q, q_rate, out, seen = np.zeros(n), np.zeros(n), np.zeros(3), np.zeros((MOST_SCAN + 1, 3))
    # Times looked at in a step: the scan, and the located dips between its points.
    at, height = np.zeros(2 * MOST_SCAN + 2), np.zeros(2 * MOST_SCAN + 2)
    found = 0
    for k in range(begin, end):
        low, high = t[k], t[k + 1]
        scan = min(max(SCAN, int(PER_RADIAN * pace * (high - low))), MOST_SCAN)
        if high <= low:
            continue
        # No touch; or no lift-off, and nowhere deeper than before.
        apart = state[OPEN] == 0.0 and reach[k, 0] > level + error
        if apart or (state[OPEN] != 0.0 and reach[k, 1] < level and reach[k, 0] >= state[DEPTH_H]):
            state[SINKING] = 0.0
            continue
        scan_step(t, q_all, q_rate_all, k, low, high, y, yp, p, thinnest, f, w, s, q, out, seen, scan, 0, scan)
        size = fit(t, q_all, q_rate_all, k, count, table, nodes)
        step = (high - low) / scan
        points = 0
        for i in range(scan + 1):
            here, left, right = low + i * step, max(i - 1, 0), min(i + 1, scan)
            measures_at(here, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
            at[points], height[points] = here, out[THICKNESS]
            dip = seen[i, THICKNESS] <= seen[left, THICKNESS] and seen[i, THICKNESS] <= seen[right, THICKNESS]
            if dip:
                best = locate_minimum(
                    THICKNESS, low + left * step, low + right * step,
                    table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out,
                )  # fmt: skip
                measures_at(best, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
                if out[THICKNESS] < height[points] and best != here:
                    # Between this point of the scan and the one before it, or the one after.
                    place = points if best < here else points + 1
                    points += 1
                    at[points], height[points] = here, height[points - 1]
                    at[place], height[place] = best, out[THICKNESS]
            points += 1
        for i in range(points):
            if i > 0 and height[i - 1] >= level > height[i] and state[OPEN] == 0.0:
                touched = crossing_time(
                    at[i - 1], at[i], level, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out
                )  # fmt: skip
                _begin(state, start + touched, impulse[k])
            elif state[OPEN] == 0.0 and height[i] < level:
                _begin(state, start + at[i], impulse[k])
            if height[i] < level:
                theta, radius = measures_at(at[i], table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
                _deepen(state, start + at[i], height[i], theta, radius)
            elif state[OPEN] != 0.0:
                lifted = at[i]
                if i > 0:
                    lifted = crossing_time(
                        at[i], at[i - 1], level, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out
                    )
                if found < len(rows):
                    found = _close(state, start + lifted, impulse[k + 1], level, error, rows, found)
            elif i < points - 1 and height[i] <= level + error:
                sinking = height[i] <= height[i - 1] if i > 0 else state[SINKING] != 0.0
                if sinking and height[i] < height[i + 1] and found < len(rows):
                    theta, radius = measures_at(at[i], table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
                    _begin(state, start + at[i], impulse[k])
                    _deepen(state, start + at[i], height[i], theta, radius)
                    found = _close(state, start + at[i], impulse[k + 1], level, error, rows, found)
        state[SINKING] = height[points - 1] <= height[points - 2]
    return found


class ContactEvents:
    """An observer of contacts: `summary` of those so far (ContactSummary), those that have ended but are not yet events
    (`waiting`), and one that goes on (`open`).  It follows the ExtremaTracker, whose bound on each step's film tells
    where nothing can touch."""

    def __init__(self, model, extrema):
        self.model, self.extrema, self.summary = model, extrema, ContactSummary()
        self.open, self.waiting, self.segment = np.zeros(STATE), [], None

    def begin(self, segment, tau, y):
        """A segment begins: a contact that goes on stays open."""
        self.segment = segment

    def accept(self, block):
        """Locate the contacts in a block of steps."""
        if self.model.contact is None:
            return
        segment, (q, q_rate) = self.segment, block.motion
        impulse = np.ascontiguousarray(block.ys[:, self.model.unknowns.impulse])
        # Each dip lies between points of the scan.
        looked = PER_RADIAN * segment.pace * np.diff(block.t[block.begin : block.end + 1])
        rows = np.empty((64 + int(np.sum(np.clip(looked, SCAN, MOST_SCAN) + 1)), ROW))
        found = locate_contacts(
            block.t, q, q_rate, impulse, len(block.t), block.begin, block.end, self.extrema.reach,
            segment.p, thinnest_value(self.model.face), self.model.f, np.zeros(segment.size), np.zeros(segment.size),
            segment.w, segment.s, segment.time, segment.pace, self.model.gap_error(), self.open, rows,
        )  # fmt: skip
        self.waiting.extend(rows[:found])

    def tell(self, log, end: tuple | None = None):
        """Hand the contacts that have ended to `log` as events, and add them to the summary; at the `end` (time (s),
        unknowns (size,)) of a run also one that goes on, without a lift-off."""
        rows = self._rows(end)
        self.summary, self.waiting = self._with(rows, end), []
        if end:
            self.open[OPEN] = 0.0
        if rows:
            log([contact_event(row, self.model.face[TOUCH]) for row in rows])

    def so_far(self, end: tuple) -> ContactSummary:
        """The summary with all contacts up to the `end` (as of `tell`) of a run, of which one may go on."""
        return self._with(self._rows(end), end)

    def _rows(self, end) -> list:
        """Contacts that have ended and have not been told, and at the `end` of a run the one that goes on."""
        if not (end and self.open[OPEN]):
            return self.waiting
        row = self.open[:ROW].copy()
        row[KIND], row[LIFTED] = 1.0, np.nan
        row[IMPULSE] = end[1][self.model.unknowns.impulse] - row[IMPULSE]
        return [*self.waiting, row]

    def _with(self, rows, end) -> ContactSummary:
        """The summary with these contacts."""
        found = replace(self.summary)
        found.add(rows)
        if end and self.open[OPEN]:
            found.longest = max(found.longest, float(end[0] - self.open[TOUCHED]))
        return found

    def state(self) -> dict:
        """What a continued run needs: {"touching": (STATE,), "contacts": counts, "untold": (k, ROW)}."""
        return {"touching": self.open, "contacts": vars(self.summary), "untold": np.reshape(self.waiting, (-1, ROW))}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.open[:] = state["touching"]
        self.summary = ContactSummary(**state["contacts"])
        self.waiting = list(np.reshape(state["untold"], (-1, ROW)))


# Harmonics of the fastest motion that are resolved, and the longest panel (rad of it).
TIMES, LONGEST = 2.0, 1.0
# Series whose peaks are looked for.
PEAKED = ("leakage_inner", "leakage_outer", "friction_power", "contact_force", "contact_area_fraction",
          "contact_pressure", "cavitated_fraction")  # fmt: skip
# Looks at peaks, each nearer; and an improvement not worth one, over the accuracy.
LOOKS, SLACK = 3, 0.02
# Points looked at in one call: bounds the memory that a film with unknowns of its own takes.
AT_ONCE = 512


def longest_panel(segment) -> float:
    """Longest panel (s) of the quadrature in a segment."""
    asked = (segment.model.accuracy / LOBATTO_ERROR) ** (1 / LOBATTO_ORDER) / TIMES
    return min(asked, LONGEST) / max(2 * math.pi / segment.shortest_period, segment.pace)


class Tally:
    """An observer: integrals `sums` {series: SI s} and `largest` values {series: SI} of the series that are tallied,
    over `time` (s).

    Of a film whose unknowns settle at each step, which is where it is known best, the points are the steps: the
    trapezoidal rule, of the second order that its method has."""

    def __init__(self, model):
        self.time, self.sums, self.largest = 0.0, {}, {}
        self.slack = SLACK * model.accuracy
        self.at_steps = model.interface.film.settle is not None

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in a block's new steps."""
        begin, end, t = block.begin, block.end, block.t
        until = t[end] if block.until is None else block.until
        if self.at_steps:
            times = np.append(t[begin:end], until)
            halves = 0.5 * np.diff(times)
            weights = np.append(halves, 0.0) + np.append(0.0, halves)
        else:
            times, weights = points(t, begin, end, until, longest_panel(block.segment))
        if block.segment.film.start == block.segment.film.stop:
            self.take_motion(block.segment, times, weights, *block.at(times))
        else:
            whole = partial(_columns, block.segment, lambda some: (*block.at(some), *block.film_at(some)))
            self._take(times, weights, whole(times), whole)

    def take_motion(self, segment, times, weights, q, q_rate):
        """Take in points of a segment without unknowns of the film: increasing `times` (m,) (s, of the segment),
        `weights` (m,) (s), and the motion there, displacements and rates (m, n)."""

        def between(wanted):
            out, slope = np.empty((2, len(wanted), q.shape[1]))
            sample(times, q, q_rate, len(times), 0, len(times) - 1, wanted, out, slope)
            return out, slope

        columns = _columns(segment, lambda some: (q, q_rate), times, len(times))
        self._take(times, weights, columns, partial(_columns, segment, between))

    def _take(self, times, weights, columns, between):
        """Take in `columns` {series: (m,)} at points, and what is `between` them."""
        self.time += float(weights.sum())
        for name, values in columns.items():
            self.sums[name] = self.sums.get(name, 0.0) + float(weights @ values)
            self.largest[name] = max(self.largest.get(name, -math.inf), float(values.max()))
        if not self.at_steps:
            self._locate(times, {name: columns[name] for name in PEAKED if name in columns}, between)

    def _locate(self, times, columns, between):
        """Look at the peaks between the points."""
        for _ in range(LOOKS):
            peaks = [_peaks(times, values, self.largest[name], self.slack) for name, values in columns.items()]
            wanted = np.setdiff1d(np.concatenate(peaks), times)
            if not len(wanted):
                return
            found = between(wanted)
            at = np.searchsorted(times, wanted)
            times = np.insert(times, at, wanted)
            for name, values in columns.items():
                self.largest[name] = max(self.largest[name], float(found[name].max()))
                columns[name] = np.insert(values, at, found[name])

    def mean(self, name: str) -> float:
        """Mean (SI) of a series so far; NaN without one."""
        return self.sums[name] / self.time if self.time and name in self.sums else math.nan

    def most(self, name: str) -> float:
        """Largest value (SI) of a series so far; NaN without one."""
        return self.largest.get(name, math.nan)

    def state(self) -> dict:
        """What a continued run needs."""
        return {"time": self.time, "sums": self.sums, "largest": self.largest}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.time, self.sums, self.largest = float(state["time"]), dict(state["sums"]), dict(state["largest"])


def _columns(segment, motion, times, at_once=AT_ONCE) -> dict[str, np.ndarray]:
    """Series (m,) that are tallied, at segment times (m,) (s), of displacements, rates and the film's unknowns that
    `motion` has there."""
    pieces = [times[first : first + at_once] for first in range(0, len(times), at_once)]
    parts = [signals(segment, some, *motion(some), tallied=True) for some in pieces]
    return {name: np.concatenate([part[name] for part in parts]) for name in TALLIED if name in parts[0]}


def _peaks(t, values, record: float, slack: float) -> np.ndarray:
    """Times (s) at which `values` (m,) at `t` (m,) may be larger than the `record`, by the parabolas through three
    neighbours, each over the middle half of them, the outermost to the ends.  `slack`: an improvement not worth a look,
    over the record."""
    if len(t) < 3:
        return np.empty(0)
    slopes = np.diff(values) / np.diff(t)
    bend = np.diff(slopes) / (t[2:] - t[:-2])
    bent = np.flatnonzero(bend < 0.0)
    here, left = t[bent + 1], t[bent]
    slope = slopes[bent] + bend[bent] * (here - left)
    at = here - 0.5 * slope / bend[bent]
    low, high = 0.5 * (left + here), 0.5 * (here + t[bent + 2])
    low, high = np.where(bent == 0, left, low), np.where(bent == len(t) - 3, t[bent + 2], high)
    known = np.maximum(np.maximum(values[bent], values[bent + 1]), values[bent + 2])
    gain = values[bent + 1] - 0.25 * slope**2 / bend[bent] - known
    margin = slack * abs(record)
    return at[(low < at) & (at < high) & (gain > margin) & (known + 1.5 * gain > record + margin)]
