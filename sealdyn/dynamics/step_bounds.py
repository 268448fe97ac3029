"""Bounds of the gap within a step, from its two ends: where nothing asked can happen between them, nothing is scanned.

At a fixed place of the faces the film over a step departs from its chord by no more than what moves it does: the motion
of ring against ring, displacements and imposed motion together, is near its Hermite cubic, and that departs from its
chord by 3/4 of the larger of its inner Bernstein coefficients; a wave that passes by an eighth of its largest second
derivative times the square of the step.  The thinnest film of chords is concave in time, so lowest at one of the ends;
the tilt of chords is convex, so largest there.
**Source** Farouki (2012), Computer Aided Geometric Design 29(6), 379-419: a polynomial in Bernstein form lies in the
hull of its coefficients.  Hermite's cubic misses a motion by its fourth derivative over 384 times the step's fourth
power.
**Valid** rigid faces: cones, profiles, waves; any imposed motion of a stretch of time.
"""

import math

import numpy as np

from ..faces.film_thickness import wave_rows
from ..faces.geometry import CLEARANCE, INNER_RADIUS, OUTER_RADIUS, smallest_gap
from ..numerics.kernel import inner_kernel
from .equations import AT_TILT, AT_Z, FLOATS, LEG_AT, RING
from .imposed_motion import AXIAL, OWN, PER_RING, imposed_state

# The three measures that are made small: the film thickness, minus the squared tilt, the squared tilt (smooth through
# zero).
THICKNESS, MINUS_TILT, TILT = range(3)
# The motion of stator against rotor over a step, a row each: at both ends, and their rates times the step; axial (m)
# and tilt (rad, rad).
FROM, TO, RATE_FROM, RATE_TO = range(4)
# Of a stretch of time: largest imposed axial motion (m), tilt (rad) and sum of waves (m); largest fourth derivatives of
# the first two (per s^4), second of the waves and of what the cone opens (per s^2); least change of the coning (rad).
REACH, BEND, LEAST_CONING, SWING = 0, 3, 6, 7
# What kernels round: of all that moves the gap, per radian of the imposed motion so far; and of the thinnest film of
# waves, of the clearance.
ROUNDING, FOUND = 1e-15, 1e-12


def largest_swing(face, rows, floats, spins, coning, length: float) -> np.ndarray:
    """How far and how sharply what is imposed can move the gap, (SWING,): `face` block, harmonics `rows`
    (imposed_motion.py), which of stator and rotor `floats`, `spins` of both (speed, slope; rad/s, rad/s^2), the
    `coning` (change, rate, half its second derivative; rad, rad/s, rad/s^2), over `length` (s).  A ring that floats
    does not move with its carrier."""
    out = np.zeros(SWING)
    for ring, kind, a, a_slope, _, _, _, w, half_slope in rows.tolist():
        if kind == OWN or floats[int(ring)]:
            continue
        part, bend = 0 if kind == AXIAL else 1, 2.0 * abs(half_slope)
        size, w = max(abs(a), abs(a + a_slope * length)), _fastest(w, 2.0 * half_slope, length)
        out[REACH + part] += size
        # Of a exp(i phase), with a linear and the phase quadratic in time.
        out[BEND + part] += size * (w**4 + 6.0 * w**2 * bend + 3.0 * bend**2)
        out[BEND + part] += 4.0 * abs(a_slope) * (w**3 + 3.0 * w * bend)
    for sign, order, amplitude, *_ in wave_rows(face).tolist():
        speed, slope = spins[0 if sign > 0.0 else 1]
        out[REACH + 2] += abs(amplitude)
        out[BEND + 2] += abs(amplitude) * ((order * _fastest(speed, slope, length)) ** 2 + order * abs(slope))
    change, rate, bend = coning
    vertex = min(max(-0.5 * rate / bend if bend > 0.0 else 0.0, 0.0), length)
    out[LEAST_CONING] = min(change + tau * (rate + bend * tau) for tau in (0.0, vertex, length))
    out[BEND + 2] += 2.0 * abs(bend) * (face[OUTER_RADIUS] - face[INNER_RADIUS])
    return out


def _fastest(w, slope, length):
    return max(abs(w), abs(w + slope * length))


@inner_kernel()
def floating_motion(t, q_all, q_rate_all, k, p, motion):
    """The `motion` (4, 3) over step k of the rings that float alone; arguments as of `track_extremes` (extrema.py)."""
    span = t[k + 1] - t[k]
    for i in range(4):
        for j in range(3):
            motion[i, j] = 0.0
    for ring in range(2):
        sign, block = 1.0 - 2.0 * ring, RING * ring
        if p[block + FLOATS] == 0.0:
            continue
        for part in range(3):
            first = int(p[block + AT_Z]) if part == 0 else int(p[block + AT_TILT])
            if first < 0:
                continue
            j = first if part == 0 else first + part - 1
            motion[FROM, part] += sign * q_all[k, j]
            motion[TO, part] += sign * q_all[k + 1, j]
            motion[RATE_FROM, part] += sign * span * q_rate_all[k, j]
            motion[RATE_TO, part] += sign * span * q_rate_all[k + 1, j]


@inner_kernel()
def imposed_gap(tau, p, c, at):
    """What the rings that do not float add to the gap at segment time tau (s): axial (m) and tilt (rad, rad), then
    their rates, into `at` (6,); `c` (2 x PER_RING) is scratch for the imposed state."""
    imposed_state(tau, p[LEG_AT:], c)
    for part in range(6):
        at[part] = 0.0
        for ring in range(2):
            if p[RING * ring + FLOATS] == 0.0:
                at[part] += (1.0 - 2.0 * ring) * c[PER_RING * ring + part]


@inner_kernel()
def add_imposed(motion, imposed, span):
    """Add what `imposed_gap` gives at both ends (2, 6) to the `motion` over a step of `span` (s)."""
    for end in range(2):
        for part in range(3):
            motion[FROM + end, part] += imposed[end, part]
            motion[RATE_FROM + end, part] += span * imposed[end, 3 + part]


@inner_kernel()
def departures(motion):
    """How far the interpolant of a `motion` (4, 3) may depart from its chord: axial (m), tilt (rad)."""
    axial = tilt = 0.0
    for end in range(2):
        rate = RATE_FROM + end
        z = motion[rate, 0] - motion[TO, 0] + motion[FROM, 0]
        x = motion[rate, 1] - motion[TO, 1] + motion[FROM, 1]
        y = motion[rate, 2] - motion[TO, 2] + motion[FROM, 2]
        axial, tilt = max(axial, abs(z)), max(tilt, x * x + y * y)
    # A quarter is the cubic's; one through more steps departs from it by far less than it from its chord.
    return 0.5 * axial, 0.5 * math.sqrt(tilt)


@inner_kernel()
def tilt_at(motion, end):
    """Tilt (rad) at one end.  Without the care of math.hypot for overflow, which costs as much as all else."""
    return math.sqrt(motion[end, 1] * motion[end, 1] + motion[end, 2] * motion[end, 2])


@inner_kernel()
def chord_length(f, motion, cones):
    """How far (m) a place of the faces may move along the chord of a `motion` and of the coning changes `cones` (2,)
    (rad) at the step's ends."""
    x, y = motion[TO, 1] - motion[FROM, 1], motion[TO, 2] - motion[FROM, 2]
    turned = f[OUTER_RADIUS] * math.sqrt(x * x + y * y) + (f[OUTER_RADIUS] - f[INNER_RADIUS]) * abs(cones[1] - cones[0])
    return abs(motion[TO, 0] - motion[FROM, 0]) + turned


@inner_kernel()
def lowest_possible(f, swing, motion):
    """What no film of a step is thinner than (m), wherever the imposed motion may stand; `motion` of the rings that
    float alone."""
    axial, tilt = departures(motion)
    dz = min(motion[FROM, 0], motion[TO, 0]) - axial - swing[REACH]
    tilt += max(tilt_at(motion, FROM), tilt_at(motion, TO)) + swing[REACH + 1]
    least, _ = smallest_gap(f, dz, tilt, swing[LEAST_CONING])
    return least - swing[REACH + 2]


@inner_kernel()
def bound_measures(f, swing, span, turned, motion, films, lower):
    """What the measures are not less than over a step of `span` (s), into `lower` (3,): of its `motion` and the `films`
    (2,) at its ends (m); `turned` (rad) how far the imposed motion has come."""
    axial, tilt = departures(motion)
    moved = f[CLEARANCE] + swing[REACH] + swing[REACH + 2] + f[OUTER_RADIUS] * swing[REACH + 1]
    rounding = ROUNDING * (1.0 + turned) * moved + FOUND * f[CLEARANCE]
    square = span * span
    axial += square * square * swing[BEND] / 384.0 + rounding
    tilt += square * square * swing[BEND + 1] / 384.0 + rounding / f[OUTER_RADIUS]
    waves = 0.125 * square * swing[BEND + 2]
    lower[THICKNESS] = min(films[0], films[1]) - axial - f[OUTER_RADIUS] * tilt - waves
    farthest = max(tilt_at(motion, FROM), tilt_at(motion, TO)) + tilt
    lower[MINUS_TILT] = -farthest * farthest
    # From the origin to the chord of the tilt.
    x, y = motion[FROM, 1], motion[FROM, 2]
    d_x, d_y = motion[TO, 1] - x, motion[TO, 2] - y
    along, length = -(x * d_x + y * d_y), d_x * d_x + d_y * d_y
    share = min(along / length, 1.0) if along > 0.0 else 0.0
    x, y = x + share * d_x, y + share * d_y
    nearest = max(0.0, math.sqrt(x * x + y * y) - tilt)
    lower[TILT] = nearest * nearest
