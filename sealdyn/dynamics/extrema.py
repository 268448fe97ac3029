"""The gap watched between steps: where it is smallest, where the tilt is largest, and whether it closes.

Every step's two ends carry positions and rates, so the motion inside is a polynomial (numerics/hermite.py) and the
imposed motion is exact.  An interval whose bounds (step_bounds.py) do not settle the question is scanned on a cubic; a
candidate that could beat the record is then located on the full interpolant.  No event function, no sample: the step
size does not matter.
"""

import math

import numpy as np

from ..faces.film_thickness import highest_orders
from ..faces.geometry import COLLAPSE, GX, GY, INNER_RADIUS, OUTER_RADIUS, TOUCH, WAVES, smallest_gap
from ..numerics.hermite import NODES, fit, value
from ..numerics.kernel import inner_kernel, outer_kernel
from ..quantities import in_words
from ..scene.forces import film_in_words, limit_in_words
from ..solvers.contract import Cause, Stop
from .equations import LEG_AT, kinematics
from .imposed_motion import PER_RING, coning_at
from .native import thinnest_value
from .step_bounds import (
    FROM,
    MINUS_TILT,
    THICKNESS,
    TILT,
    add_imposed,
    bound_measures,
    chord_length,
    floating_motion,
    imposed_gap,
    lowest_possible,
    tilt_at,
)

# One record per window: value, segment time, angle, radius of h_min; value and time of the largest and of the
# smallest relative misalignment.  Windows: the whole run, the last forcing period, the one before.
H, H_TAU, H_THETA, H_RADIUS, MOST, MOST_TAU, LEAST, LEAST_TAU, H_LEG, MOST_LEG, LEAST_LEG = range(11)
RECORD = 11
WINDOWS = 3
# Points looked at in a step: at least these, and at least so many per radian of the fastest imposed motion.
SCAN, PER_RADIAN, MOST_SCAN = 6, 3.0, 4096
# In a step of less than this (rad) of the fastest motion of interest, on which all that moves is nearly a parabola.
SHORT, SHORT_SCAN = 0.5, 3


def empty_records() -> np.ndarray:
    """Records of no motion yet, shape (WINDOWS, RECORD), in m, s, rad."""
    records = np.zeros((WINDOWS, RECORD))
    records[:, H], records[:, MOST], records[:, LEAST] = np.inf, -np.inf, np.inf
    return records


def merged(one, other) -> np.ndarray:
    """Records (..., RECORD) of two looks at the same windows: of each measure what is further out, its time and
    place."""
    further = {
        (H, H_TAU, H_THETA, H_RADIUS, H_LEG): other[..., H] < one[..., H],
        (MOST, MOST_TAU, MOST_LEG): other[..., MOST] > one[..., MOST],
        (LEAST, LEAST_TAU, LEAST_LEG): other[..., LEAST] < one[..., LEAST],
    }
    found = one.copy()
    for slots, better in further.items():
        for slot in slots:
            found[..., slot] = np.where(better, other[..., slot], one[..., slot])
    return found


def scan_pace(face, imposed: float, fastest: float, spins) -> float:
    """Pace (rad/s) of the scan: of the `imposed` motion (rad/s), or of waves that pass each other or the tilt, if
    faster.

    `face` block, `fastest` motion of the rings (rad/s), `spins` of stator and rotor (rad/s), each at the ends of a
    stretch of time.  Waves of m and n to the circle are crest to trough at up to m n places a turn; a tilt is one wave.
    """
    orders, turning = highest_orders(face), max(imposed, fastest)
    past_tilt = max(n * (np.max(np.abs(w)) + turning) if n else 0.0 for n, w in zip(orders, spins, strict=True))
    past_waves = orders[0] * orders[1] * np.max(np.abs(np.subtract(*spins)))
    return float(max(imposed, past_tilt, past_waves))


def longest_scan(pace: float) -> float:
    """Longest step (s) that can be scanned at a pace (rad/s); infinite at none."""
    return MOST_SCAN / (PER_RADIAN * pace) if pace else math.inf


@inner_kernel()
def gap_and_tilt(tau, q, y, yp, p, thinnest, f, w, s, out):
    """The three measures (m, rad^2) at displacements q (n,) and segment time tau (s), into `out` (3,); returns angle
    (rad) and radius (m) of h_min, which the function value `thinnest` finds.  Other arguments as `track_extremes`."""
    # One by one, here and below: assigning whole arrays would take seconds to compile.
    for j in range(len(q)):
        y[j] = q[j]
    kinematics(tau, y, yp, p, w, s)
    out[THICKNESS], theta, radius = thinnest(f, s)
    out[TILT] = s[GX] ** 2 + s[GY] ** 2
    out[MINUS_TILT] = -out[TILT]
    return theta, radius


@inner_kernel()
def measures_at(tau, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out):
    """As `gap_and_tilt`, on the full interpolant (`table`, `nodes`, `size` of numerics/hermite.py)."""
    value(table, nodes, size, tau, q, q_rate)
    return gap_and_tilt(tau, q, y, yp, p, thinnest, f, w, s, out)


@inner_kernel()
def locate_minimum(kind, low, high, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out):
    """Time (s) in [low, high] where one measure (`kind`) is smallest on the full interpolant (`table`, `nodes`, `size`
    of numerics/hermite.py): three rounds of five points, then the vertex of a parabola."""
    best, best_at = np.inf, low
    for _ in range(3):
        width = 0.25 * (high - low)
        for i in range(5):
            tau = low + i * width
            measures_at(tau, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
            if out[kind] < best:
                best, best_at = out[kind], tau
        low, high = max(low, best_at - width), min(high, best_at + width)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    points = np.zeros(3)
    for i in range(3):
        measures_at(middle + (i - 1) * half, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
        points[i] = out[kind]
    bend = points[0] - 2.0 * points[1] + points[2]
    if bend > 0.0:
        vertex = middle + 0.5 * half * (points[0] - points[2]) / bend
        vertex = min(max(vertex, low), high)
        measures_at(vertex, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
        if out[kind] <= best:
            return vertex
    return best_at


@inner_kernel()
def crossing_time(above, below, level, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out):
    """Time (s) at which the film crosses a `level` (m), by bisection between a time `above` (s) when it is above and
    one `below` when it is below, whichever is earlier; the film is below there."""
    for _ in range(60):
        middle = 0.5 * (above + below)
        measures_at(middle, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
        if out[THICKNESS] < level:
            below = middle
        else:
            above = middle
    return below


@inner_kernel()
def scan_step(t, q_all, q_rate_all, k, low, high, y, yp, p, thinnest, f, w, s, q, out, seen, scan, first, last):
    """The measures `seen` (scan + 1, 3) at scan + 1 times in [low, high] (s) of step k, from the `first` of them to the
    `last`, on the cubic between its two ends."""
    a, b = t[k], t[k + 1]
    span = b - a
    for i in range(first, last + 1):
        x = (low + (high - low) * i / scan - a) / span
        # The end of a step is the start of the next, to the bit.
        ended = i == scan and high == b
        for j in range(len(q)):
            q0, q1 = q_all[k, j], q_all[k + 1, j]
            v0, v1 = span * q_rate_all[k, j], span * q_rate_all[k + 1, j]
            inside = q0 + x * (v0 + x * (3.0 * (q1 - q0) - 2.0 * v0 - v1 + x * (2.0 * (q0 - q1) + v0 + v1)))
            q[j] = q1 if ended else inside
        gap_and_tilt(b if ended else a + x * span, q, y, yp, p, thinnest, f, w, s, out)
        for j in range(3):
            seen[i, j] = out[j]


@inner_kernel()
def falls_outwards(seen, kind, best, scan):
    """Whether a measure of the scan `seen` (scan + 1, 3), lowest at its first or last point, still falls there: then
    the end is its least, with no dip inside.  By the cubic through the four points there, and that it differs from the
    parabola through three by less than its slope."""
    if best != 0 and best != scan:
        return False
    inwards = 1 if best == 0 else -1
    first = seen[best + inwards, kind] - seen[best, kind]
    second = seen[best + 2 * inwards, kind] - seen[best + inwards, kind] - first
    third = seen[best + 3 * inwards, kind] - seen[best + 2 * inwards, kind] - first - 2.0 * second
    # Newton's forward differences: slope at the end, per interval of the scan.
    return first - 0.5 * second + third / 3.0 > abs(third) / 3.0


@inner_kernel()
def current_record(record, kind, tolerance):
    """The record so far in the measure of this kind (m, rad^2), and the improvement not worth locating."""
    if kind == THICKNESS:
        return record[H], tolerance[0]
    known = record[MOST] if kind == MINUS_TILT else record[LEAST]
    if not abs(known) < np.inf:
        return np.inf, 0.0
    sign = -1.0 if kind == MINUS_TILT else 1.0
    return sign * known * known, tolerance[1] * (2.0 * known + tolerance[1])


@inner_kernel()
def store(record, kind, out, at, theta, radius, index):
    """A new record in the measure of this kind: its value `out`, segment time `at` (s), angle (rad), radius (m) and
    segment index."""
    if kind == THICKNESS:
        record[H], record[H_TAU], record[H_LEG] = out[kind], at, index
        record[H_THETA], record[H_RADIUS] = theta, radius
    elif kind == MINUS_TILT:
        record[MOST], record[MOST_TAU], record[MOST_LEG] = math.sqrt(out[TILT]), at, index
    else:
        record[LEAST], record[LEAST_TAU], record[LEAST_LEG] = math.sqrt(out[TILT]), at, index


@inner_kernel()
def nothing_to_find(record, lower, tolerance):
    """Whether no measure that is nowhere less than `lower` (3,) improves the record."""
    found = False
    for kind in range(3):
        # Nothing is known where a bound is not a number.
        found = found or not lower[kind] >= current_record(record, kind, tolerance)[0]
    return not found


@outer_kernel()
def track_extremes(
    t, q_all, q_rate_all, count, begin, end, p, thinnest, f, y, yp, w, s, swing, windows, index, records, asked, level,
    tolerance, pace, fastest, reach,
):  # fmt: skip
    """Update the records over steps [begin, end]; returns the segment time of collapse (film at the floor), or -1.

    `t` (count,), `q_all`, `q_rate_all` (count, n) the accepted steps; `swing` (SWING,) of step_bounds.py; `windows`
    (WINDOWS, 2) in segment time; unless extremes are `asked` for, only collapse is looked for; `level` (m) above which
    a film tells nothing but extremes; `tolerance` (2,) improvements of film thickness (m) and tilt (rad) that are not
    worth locating; `pace` the fastest imposed motion (rad/s), `fastest` of any motion of interest.  `reach` (count, 2)
    is filled: no film in the step is thinner than the first (m), its thinnest film nowhere thicker than the second.
    """
    n = q_all.shape[1]
    table, nodes = np.zeros((2 * NODES, n)), np.zeros(2 * NODES)
    q, q_rate, out, seen = np.zeros(n), np.zeros(n), np.zeros(3), np.zeros((MOST_SCAN + 1, 3))
    motion, imposed, ends = np.zeros((4, 3)), np.zeros((2, 6)), np.zeros((2, 3))
    films, cones, lower, wavy = np.zeros(2), np.zeros(2), np.zeros(3), f[WAVES] != 0.0
    # A step begins where the one before ended: of which steps the imposed motion and the measures are known there.
    placed = seen_end = -1
    for k in range(begin, end):
        floating_motion(t, q_all, q_rate_all, k, p, motion)
        if not asked:
            reach[k, 0], reach[k, 1] = lowest_possible(f, swing, motion), np.inf
            if reach[k, 0] > level:
                continue
        size, span = 0, t[k + 1] - t[k]
        for j in range(3):
            imposed[0, j], imposed[0, 3 + j], ends[0, j] = imposed[1, j], imposed[1, 3 + j], ends[1, j]
        if placed != k:
            imposed_gap(t[k], p, w[: 2 * PER_RING], imposed[0])
        imposed_gap(t[k + 1], p, w[: 2 * PER_RING], imposed[1])
        add_imposed(motion, imposed, span)
        begins, ended, placed = seen_end == k, False, k + 1
        if wavy:
            for at in range(1 if begins else 0, 2):
                gap_and_tilt(t[k + at], q_all[k + at], y, yp, p, thinnest, f, w, s, ends[at])
            films[0], films[1] = ends[0, THICKNESS], ends[1, THICKNESS]
            begins, ended, seen_end = True, True, k + 1
            farther = np.inf
        else:
            for at in range(2):
                cones[at], _ = coning_at(t[k + at], p[LEG_AT:])
                films[at], _ = smallest_gap(f, motion[FROM + at, 0], tilt_at(motion, FROM + at), cones[at])
            farther = chord_length(f, motion, cones)
        bound_measures(f, swing, span, pace * t[k + 1], motion, films, lower)
        reach[k, 0] = lower[THICKNESS]
        # From either end the thinnest film grows no faster than its place moves along the chord.
        reach[k, 1] = 0.5 * (films[0] + films[1] + farther) + min(films[0], films[1]) - lower[THICKNESS]
        for window in range(WINDOWS if asked else 1):
            low, high = max(t[k], windows[window, 0]), min(t[k + 1], windows[window, 1])
            if high <= low:
                continue
            if lower[THICKNESS] > level and (not asked or nothing_to_find(records[window], lower, tolerance)):
                continue
            short = span * fastest < SHORT
            scan = min(max(SHORT_SCAN if short else SCAN, int(PER_RADIAN * pace * (high - low))), MOST_SCAN)
            first, last = 0, scan
            if begins and low == t[k]:
                first = 1
                for j in range(3):
                    seen[0, j] = ends[0, j]
            if ended and high == t[k + 1]:
                last = scan - 1
                for j in range(3):
                    seen[scan, j] = ends[1, j]
            scan_step(t, q_all, q_rate_all, k, low, high, y, yp, p, thinnest, f, w, s, q, out, seen, scan, first, last)
            if high == t[k + 1]:
                seen_end, ended = k + 1, True
                for j in range(3):
                    ends[1, j] = seen[scan, j]
            if window == 0:
                least, most = np.inf, -np.inf
                for i in range(scan + 1):
                    least, most = min(least, seen[i, THICKNESS]), max(most, seen[i, THICKNESS])
                reach[k, 0] = least - (most - least)
            for kind in range(3 if asked else 1):
                for best in range(scan + 1):
                    # Every dip of the scan, however many a long step holds.
                    left, right = max(best - 1, 0), min(best + 1, scan)
                    if seen[best, kind] > seen[left, kind] or seen[best, kind] > seen[right, kind]:
                        continue
                    # How far it may sink between the points: at most the rise to the farther neighbour.
                    far_left, far_right = min(left, scan - 2), max(right, 2)
                    dip = max(seen[far_left, kind], seen[far_right, kind]) - seen[best, kind]
                    held, slack = current_record(records[window], kind, tolerance) if asked else (-np.inf, 0.0)
                    sinks = kind == THICKNESS and seen[best, kind] - dip < f[COLLAPSE]
                    # Of a parabola at most an eighth of that rise.
                    likely = 0.5 * dip if short else dip
                    if not sinks and seen[best, kind] - likely >= held - slack:
                        continue
                    if size == 0:
                        size = fit(t, q_all, q_rate_all, k, count, table, nodes)
                    step = (high - low) / scan
                    if not sinks and falls_outwards(seen, kind, best, scan):
                        # The next step tells where it ends.
                        at = low if best == 0 else high
                    else:
                        at = locate_minimum(
                            kind, low + left * step, low + right * step,
                            table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out,
                        )  # fmt: skip
                    theta, radius = measures_at(at, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out)
                    if kind == THICKNESS and window == 0 and out[kind] < f[COLLAPSE]:
                        fallen = crossing_time(
                            t[k], at, f[COLLAPSE], table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out
                        )
                        theta, radius = measures_at(
                            fallen, table, nodes, size, q, q_rate, y, yp, p, thinnest, f, w, s, out
                        )
                        for other in range(3):
                            # The tilt's extremes up to the last instant, which belongs to the run.
                            if other == THICKNESS or out[other] < current_record(records[window], other, tolerance)[0]:
                                store(records[window], other, out, fallen, theta, radius, index)
                        return fallen
                    if out[kind] < held:
                        store(records[window], kind, out, at, theta, radius, index)
    return -1.0


def slack(model) -> np.ndarray:
    """Improvements (2,) of film thickness (m) and tilt (rad) that are not worth locating."""
    return 0.02 * model.accuracy * np.array([model.clearance, model.clearance / model.face[OUTER_RADIUS]])


def watched_level(model) -> float:
    """Film thickness (m) above which nothing ends a run and no faces come near each other."""
    face = model.face
    return float(face[COLLAPSE] if model.contact is None else max(face[COLLAPSE], face[TOUCH] + model.gap_error()))


class ExtremaTracker:
    """An observer of the gap: `records` (WINDOWS, RECORD) of extremes in the `windows` [[from, to], ...] (s): the whole
    run of `duration` (s), its last forcing period and the one before; `seen`, those of the samples that are kept.
    `reach` (m, 2) bounds the thinnest film of each step last seen from below and above (m).

    A film that reaches its floor ends the run, with a sentence that knows whether it began on the steady response
    (`steady`).
    """

    def __init__(self, model, duration: float):
        self.model, self.steady = model, False
        self.records, self.seen = empty_records(), empty_records()
        self.windows = [[0.0, duration], [duration, duration], [duration, duration]]
        self.segment = self.reach = None

    def begin(self, segment, tau, y):
        """A segment begins: the records go on."""
        self.segment = segment

    def accept(self, block):
        """Update the records over a block of steps; a Stop where the film collapses."""
        segment, model = self.segment, self.model
        thinnest = thinnest_value(model.face)
        windows = np.array(self.windows) - segment.time
        q, q_rate = block.motion
        self.reach = np.empty((len(block.t), 2))
        fallen = track_extremes(
            block.t, q, q_rate, len(block.t), block.begin, block.end, segment.p, thinnest, model.f,
            np.zeros(segment.size), np.zeros(segment.size), segment.w, segment.s, segment.swing, windows,
            segment.index, self.records, True, watched_level(model), slack(model), segment.pace,
            2 * math.pi / segment.shortest_period, self.reach,
        )  # fmt: skip
        return Stop(fallen, self._cause(), self._collapse_message(fallen)) if fallen >= 0 else None

    def see(self, at):
        """Take in samples that are kept, `Samples` of dynamics/signals.py: beside an improvement that is not worth
        locating they may lie beyond the records."""
        index, times, low, tilt = at.segment.index, at.segment.time + at.taus, at.low, np.abs(at.tilt)
        for window, (begin, end) in enumerate(self.windows):
            inside = np.flatnonzero((begin <= times) & (times <= end))
            if begin == end or not len(inside):
                continue
            h = inside[low[inside, 0].argmin()]
            most, least = inside[tilt[inside].argmax()], inside[tilt[inside].argmin()]
            one = empty_records()[0]
            one[[H, H_TAU, H_LEG]] = low[h, 0], at.taus[h], index
            one[[H_THETA, H_RADIUS]] = low[h, 1:]
            one[[MOST, MOST_TAU, MOST_LEG]] = tilt[most], at.taus[most], index
            one[[LEAST, LEAST_TAU, LEAST_LEG]] = tilt[least], at.taus[least], index
            self.seen[window] = merged(self.seen[window], one)

    def extremes(self) -> np.ndarray:
        """The records (WINDOWS, RECORD), such that each window encloses the samples that are kept of it, and the whole
        run its last periods."""
        found = merged(self.records[:], self.seen)
        for part in found[1:]:
            found[0] = merged(found[0], part)
        return found

    def state(self) -> np.ndarray:
        """What a continued run needs: the records and those of the samples, flat (2 WINDOWS RECORD,)."""
        return np.concatenate([self.records.ravel(), self.seen.ravel()])

    def restore(self, state):
        """Go on from `state`."""
        self.records[:], self.seen[:] = np.reshape(state, (2, WINDOWS, RECORD))

    def _cause(self) -> Cause:
        return Cause.FILM_COLLAPSED if self.model.contact is None else Cause.ASPERITIES_CRUSHED

    def _collapse_message(self, tau: float) -> str:
        """When, where, and what to try."""
        record, face = self.records[0], self.model.face
        other = "" if self.steady or self.model.no_steady_response() else ', run.start = "steady"'
        at = "at the {} radius".format("inner" if record[H_RADIUS] == face[INNER_RADIUS] else "outer")
        if record[H_RADIUS] not in face[[INNER_RADIUS, OUTER_RADIUS]]:
            at = "at the radius"
        return (
            f"{self._cause()} at t = {self.segment.time + tau:.6g} s: {film_in_words(record[H])} "
            f"({limit_in_words(face[COLLAPSE])}) {at} {in_words('radius', record[H_RADIUS])}, "
            f"theta = {math.degrees(record[H_THETA]):.1f} deg.  Try less misalignment or runout, more coning or "
            f"clearance, a stiffer or more damped support{other}."
        )
