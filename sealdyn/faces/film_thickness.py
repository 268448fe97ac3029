"""Film thickness h(r, theta, t) between the faces, the waves in it, and its smallest value with where it is.

Axes and signs: faces/geometry.py.  `f` is a face block (the leading slots of any film's), `s` a gap state.
Waves turn with their ring and are the same at every radius; heights of both faces are counted along the shaft:

    stator  + a cos(n (theta - stator angle) + phase)
    rotor   - a cos(n (theta - rotor angle) + phase)

The row of a wave in `f`: sign, order, amplitude (m), phase (rad), and which of the list of different orders it has.
**Source** of waves: Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), waviness h_n cos(n theta) of one face.
**Valid** rigid faces: cones, a profile over the radius, waves far lower than they are long, tilt.

The smallest film of wavy faces is the global minimum of a trigonometric polynomial, certified by its bend.
At one radius h = base + arm (g_x sin - g_y cos) + waves is a trigonometric polynomial of theta; over the radius it is
linear between the edges (or the radii of a profile), and so smallest at one of them.  Between two points a function
sinks by no more than its largest second derivative times width^2/8 below the lower end: of the cells of a scan those
that could hold the minimum are kept and halved, until the second derivative keeps its sign over a cell, where Newton's
steps are safe.
**Source** branch and bound with second-order bounds: Hansen & Walster (2004), Global Optimization Using Interval
Analysis, 12.
**Valid** any orders and phases; the value is exact to 1e-13 of the clearance.
"""

import math

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel, value_kernel
from .geometry import (
    CLEARANCE,
    CONING,
    CONING_CHANGE,
    DZ,
    FACE_SIZE,
    GX,
    GY,
    INNER_RADIUS,
    MEAN_SPIN,
    ORDER_LIST,
    ORDERS,
    OUTER_RADIUS,
    PROFILE,
    PROFILE_DEPTHS,
    PROFILE_RADII,
    ROTOR_ANGLE,
    SPIN_DIFFERENCE,
    STATOR_ANGLE,
    TILT_AT_MEAN,
    WAVE_ROW,
    WAVE_ROWS,
    WAVES,
    edge_gaps,
    node_gap,
    smallest_gap,
)

SIGN, ORDER, AMPLITUDE, PHASE, PLACE = range(WAVE_ROW)


def lay_waves(f, stator, rotor) -> None:
    """Write the waves of both rings' faces (lists of Waviness) into a face block; flat ones are left out."""
    waves = [(sign, w) for sign, face in ((1.0, stator), (-1.0, rotor)) for w in face if w.amplitude != 0.0]
    orders = sorted({wave.order for _, wave in waves})
    f[WAVES], f[ORDERS] = len(waves), len(orders)
    f[ORDER_LIST:WAVE_ROWS][: len(orders)] = orders
    rows = [(sign, wave.order, wave.amplitude, wave.phase, orders.index(wave.order)) for sign, wave in waves]
    f[WAVE_ROWS:FACE_SIZE][: WAVE_ROW * len(rows)] = np.array(rows).ravel()


def wave_rows(f) -> np.ndarray:
    """Rows (waves, WAVE_ROW) of a face block."""
    return f[WAVE_ROWS : WAVE_ROWS + WAVE_ROW * int(f[WAVES])].reshape(-1, WAVE_ROW)


def highest_orders(f) -> tuple[int, int]:
    """Highest order (waves to the circle) on the stator's and on the rotor's face of a block, 0 without waves."""
    rows = wave_rows(f)
    stator, rotor = (int(max(rows[rows[:, SIGN] == sign, ORDER], default=0)) for sign in (1.0, -1.0))
    return stator, rotor


@inner_kernel()
def waves(f, s, theta):
    """What the waves add to the film thickness (m) at an angle (rad, from the x axis)."""
    total = 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned = s[STATOR_ANGLE] if f[row + SIGN] > 0.0 else s[ROTOR_ANGLE]
        total += f[row + SIGN] * f[row + AMPLITUDE] * math.cos(f[row + ORDER] * (theta - turned) + f[row + PHASE])
    return total


@inner_kernel()
def waves_rate(f, s, theta):
    """Rate (m/s) of `waves` at a fixed angle (rad): each wave passes with its ring's spin."""
    total = 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned, spin = s[STATOR_ANGLE], s[MEAN_SPIN] - 0.5 * s[SPIN_DIFFERENCE]
        if f[row + SIGN] < 0.0:
            turned, spin = s[ROTOR_ANGLE], s[MEAN_SPIN] + 0.5 * s[SPIN_DIFFERENCE]
        slope = f[row + ORDER] * math.sin(f[row + ORDER] * (theta - turned) + f[row + PHASE])
        total += f[row + SIGN] * f[row + AMPLITUDE] * spin * slope
    return total


@inner_kernel()
def waves_turn(f, s):
    """Whether the ring of a wave turns."""
    for k in range(int(f[WAVES])):
        half = 0.5 * s[SPIN_DIFFERENCE]
        if s[MEAN_SPIN] + (half if f[WAVE_ROWS + WAVE_ROW * k + SIGN] < 0.0 else -half) != 0.0:
            return True
    return False


@inner_kernel()
def wave_parts(f, s, cosines, sines):
    """Waves of both faces together, sum of `cosines[j] cos(n theta) + sines[j] sin(n theta)` (m) over the different
    orders n of the face block, both (orders,)."""
    cosines[:], sines[:] = 0.0, 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned = s[STATOR_ANGLE] if f[row + SIGN] > 0.0 else s[ROTOR_ANGLE]
        at, angle = int(f[row + PLACE]), f[row + PHASE] - f[row + ORDER] * turned
        cosines[at] += f[row + SIGN] * f[row + AMPLITUDE] * math.cos(angle)
        sines[at] -= f[row + SIGN] * f[row + AMPLITUDE] * math.sin(angle)


@outer_kernel()
def wave_parts_along(f, gaps):
    """`wave_parts` at gap states `gaps` (m, GAP_STATE_SIZE): cosine and sine parts (m), shape (m, orders, 2)."""
    parts = np.empty((len(gaps), int(f[ORDERS]), 2))
    for k in range(len(gaps)):
        wave_parts(f, gaps[k], parts[k, :, 0], parts[k, :, 1])
    return parts


# Points of the scan per wave of the highest order; difference of two films that are one, of the clearance.
POINTS, EQUAL = 12, 1e-13
NEWTON = 40


@inner_kernel()
def _at(theta, orders, a, b, arm):
    """Value and two derivatives of the sum of a cos(n theta) + b sin(n theta), the first (the tilt) times `arm`."""
    value = first = second = 0.0
    for j in range(len(orders)):
        n, share = orders[j], arm if j == 0 else 1.0
        cos, sin = math.cos(n * theta), math.sin(n * theta)
        even, odd = share * (a[j] * cos + b[j] * sin), share * (b[j] * cos - a[j] * sin)
        value += even
        first += n * odd
        second -= n * n * even
    return value, first, second


@inner_kernel()
def _newton(low, high, start, orders, a, b, arm):
    """Place of the minimum in a cell over which the second derivative is positive, from `start`, and its value."""
    x, near = start, 1e-8 * (high - low)
    value, slope, bend = _at(x, orders, a, b, arm)
    for _ in range(NEWTON):
        if slope > 0.0:
            high = x
        else:
            low = x
        to = min(max(x - slope / bend, low), high)
        moved, x = abs(to - x), to
        value, slope, bend = _at(x, orders, a, b, arm)
        if moved <= near:
            break
    return x, value


@inner_kernel()
def _lowest_in(low, high, orders, a, b, arm, third, best, at, slack, stack):
    """The lower of `best` (at `at`) and the minimum over a cell; `third` bounds the third derivative."""
    stack[0, 0], stack[0, 1], size = low, high, 1
    while size:
        size -= 1
        low, high = stack[size, 0], stack[size, 1]
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        value, _, bend = _at(middle, orders, a, b, arm)
        if bend > third * half:
            x, value = _newton(low, high, middle, orders, a, b, arm)
            if value < best:
                best, at = value, x
            continue
        if value < best:
            best, at = value, middle
        left, right = _at(low, orders, a, b, arm)[0], _at(high, orders, a, b, arm)[0]
        if left < best:
            best, at = left, low
        if right < best:
            best, at = right, high
        # Concave, or it cannot sink far enough.
        deepest = 0.5 * half * half * (bend + third * half)
        if deepest <= 0.0 or min(left, right) - deepest >= best - slack:
            continue
        stack[size, 0], stack[size, 1] = middle, high
        stack[size + 1, 0], stack[size + 1, 1] = low, middle
        size += 2
    return best, at


@inner_kernel()
def _radii_of(f, s, radii, bases, arms):
    """Radii (m) at one of which h is smallest, the film there without tilt and waves (m), the arm of the tilt (m)."""
    if f[PROFILE] == 0.0:
        radii[0], radii[1] = f[INNER_RADIUS], f[OUTER_RADIUS]
        bases[0], bases[1] = edge_gaps(f, s[DZ], 0.0, s[CONING_CHANGE])
    else:
        for k in range(len(radii)):
            radii[k], bases[k] = f[PROFILE_RADII + k], node_gap(f, k, s[DZ], 0.0, s[CONING_CHANGE])
    arms[:] = radii
    if f[TILT_AT_MEAN] != 0.0:
        arms[:] = 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS])


@inner_kernel()
def _scan(step, orders, a, b, tilts, others):
    """Tilt (per arm) and waves (m) at equally spaced angles, by turning each order on from point to point."""
    tilts[:], others[:] = 0.0, 0.0
    for j in range(len(orders)):
        cos, sin = math.cos(orders[j] * step), math.sin(orders[j] * step)
        x, y, out = a[j], b[j], tilts if j == 0 else others
        for i in range(len(tilts)):
            out[i] += x
            x, y = x * cos + y * sin, y * cos - x * sin


@value_kernel()
def thinnest_of_waves(f, s):
    """Smallest film thickness over wavy faces (m), its angle (rad, from the x axis, within half a turn) and radius (m);
    NaN at a gap state that is not finite.  `f` a face block, `s` a gap state."""
    count = int(f[ORDERS]) + 1
    orders, a, b = np.empty(count), np.empty(count), np.empty(count)
    orders[0], a[0], b[0] = 1.0, -s[GY], s[GX]
    orders[1:] = f[ORDER_LIST : ORDER_LIST + count - 1]
    wave_parts(f, s, a[1:], b[1:])
    nodes = 2 if f[PROFILE] == 0.0 else int(f[PROFILE])
    radii, bases, arms = np.empty(nodes), np.empty(nodes), np.empty(nodes)
    _radii_of(f, s, radii, bases, arms)

    second = third = math.hypot(s[GX], s[GY]) * np.max(arms)
    for j in range(1, count):
        height = math.hypot(a[j], b[j])
        second += orders[j] ** 2 * height
        third += orders[j] ** 3 * height
    points = POINTS * int(orders[-1])
    step = 2.0 * math.pi / points
    if not math.isfinite(second + s[DZ]):
        return np.nan, 0.0, radii[0]
    # The last point is the first once more.
    tilts, others = np.empty(points + 1), np.empty(points + 1)
    _scan(step, orders, a, b, tilts, others)

    best, at, node = np.inf, 0, 0
    for i in range(points):
        for k in range(nodes):
            h = bases[k] + arms[k] * tilts[i] + others[i]
            if h < best:
                best, at, node = h, i, k
    theta = step * at
    best = bases[node] + _at(theta, orders, a, b, arms[node])[0]
    sinks, slack, stack = second * step * step / 8.0, EQUAL * f[CLEARANCE], np.empty((128, 2))
    # The cells beside the lowest point come first: what they hold rules most others out.
    for turn in range(points):
        i = (at - 1 + turn) % points
        for k in range(nodes):
            left = bases[k] + arms[k] * tilts[i] + others[i]
            right = bases[k] + arms[k] * tilts[i + 1] + others[i + 1]
            if min(left, right) - sinks >= best - slack:
                continue
            held = best - bases[k]
            over, place = _lowest_in(step * i, step * (i + 1), orders, a, b, arms[k], third, held, theta, slack, stack)
            if over < held:
                best, theta, node = bases[k] + over, place, k
    if theta > math.pi:
        theta -= 2.0 * math.pi
    return best, theta, radii[node]


@inner_kernel()
def _arm(f, r):
    """Arm (m) of the tilt at radius r."""
    return 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]) if f[TILT_AT_MEAN] != 0.0 else r


@inner_kernel()
def _depth(f, r):
    """Depth (m) of the profile at radius r, 0 without one; beyond its ends as there."""
    count = int(f[PROFILE])
    if count == 0 or r <= f[PROFILE_RADII]:
        return f[PROFILE_DEPTHS] if count else 0.0
    for k in range(1, count):
        before, here = f[PROFILE_RADII + k - 1], f[PROFILE_RADII + k]
        if r <= here:
            share = (r - before) / (here - before)
            return f[PROFILE_DEPTHS + k - 1] + share * (f[PROFILE_DEPTHS + k] - f[PROFILE_DEPTHS + k - 1])
    return f[PROFILE_DEPTHS + count - 1]


@inner_kernel()
def film_thickness(f, s, r, theta):
    """Film thickness (m) at radius r (m) and angle theta (rad, from the x axis)."""
    aligned = f[CLEARANCE] + s[DZ] + (f[CONING] + s[CONING_CHANGE]) * (r - f[INNER_RADIUS]) + _depth(f, r)
    return aligned + _arm(f, r) * (s[GX] * math.sin(theta) - s[GY] * math.cos(theta)) + waves(f, s, theta)


def h_min(f, s) -> tuple[float, float, float]:
    """Smallest film thickness (m) over the face, its angle (rad, from the x axis, up to half a turn) and radius (m)."""
    return h_min_of(f)(f, s)


def h_min_of(f):
    """The compiled kernel that finds `h_min` of a face block; that of waves is compiled for wavy faces only."""
    return thinnest_of_waves if f[WAVES] != 0.0 else thinnest_of_cones


@value_kernel()
def thinnest_of_cones(f, s):
    """As `h_min`, of faces without waves."""
    # h = C + dz + ... - r G cos(beta): beta counts from the thinnest place (faces/geometry.py).
    least, radius = smallest_gap(f, s[DZ], math.hypot(s[GX], s[GY]), s[CONING_CHANGE])
    theta = math.atan2(s[GY], s[GX]) - 0.5 * math.pi
    if theta < -math.pi:
        theta += 2.0 * math.pi
    return least, theta, radius
