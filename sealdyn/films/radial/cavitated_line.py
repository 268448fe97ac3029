"""One radial line of a film whose pressure is floored: where it is dry, what the wet rest carries.

Along the line `p' = 12 mu Q / (r h^3)`, Q a cubic in d = r - r_i (planar: a quadratic, and no r), which turns once
at most inside the face.  So the pressure turns twice at most and falls into three monotone pieces, each of which is
wet, dry, or crosses the floor once.  With inertia p' gains g r: the pressure turns where the polynomial
F = Q + g r^2 h^3 / (12 mu) is zero (planar: r h^3), and there may be more pieces.
"""

import math

import numpy as np

from ...numerics.kernel import inner_kernel, outer_kernel
from .._radial_quadrature import cubic, line_sums

# A line's state: bits.
INNER_DRY, OUTER_DRY, HAS_DRY, HAS_WET = 1, 2, 4, 8
# A crossing enters force and moment by its square.
CLOSE = 1e-9
# Most places where the pressure may turn.
TURNS = 5


@inner_kernel()
def _zero(q0, q, low, high, rising):
    """The d in [low, high] where the cubic changes sign: Newton held inside the bracket."""
    d = 0.5 * (low + high)
    for _ in range(60):
        value = q0 + d * (q[0] + d * (q[1] + d * q[2]))
        if (value > 0.0) == rising:
            high = d
        else:
            low = d
        slope = q[0] + d * (2.0 * q[1] + d * 3.0 * q[2])
        last, d = d, d - value / slope if slope != 0.0 else low
        if not low < d < high:
            d = 0.5 * (low + high)
        if abs(d - last) <= 1e-15 * high:
            break
    return d


@inner_kernel()
def _bend(d, q0, q, r_i, width, h_i, h_o, planar, push):
    """F at a distance d (m): it has the sign of p'; `push` = g / (12 mu)."""
    value = q0 + d * (q[0] + d * (q[1] + d * q[2]))
    if push != 0.0:
        r, h = r_i + d, h_i + (h_o - h_i) * d / width
        value += push * (r if planar else r * r) * h**3
    return value


@inner_kernel()
def _polynomial(q0, q, r_i, width, h_i, h_o, planar, push):
    """Coefficients (6,) of F in x = d / width, rising powers."""
    found, h = np.zeros(6), np.array([h_i, h_o - h_i])
    found[0] = 1.0
    factors = 4 if planar else 5
    for k in range(factors):
        low, high = (h[0], h[1]) if k < 3 else (r_i, width)
        for j in range(5, 0, -1):
            found[j] = low * found[j] + high * found[j - 1]
        found[0] *= low
    found *= push
    found[0] += q0
    for j in range(3):
        found[j + 1] += q[j] * width ** (j + 1)
    return found


@inner_kernel()
def _value(poly, x):
    value = 0.0
    for j in range(len(poly) - 1, -1, -1):
        value = value * x + poly[j]
    return value


@inner_kernel()
def _sign_changes(poly):
    """Where on [0, 1] a polynomial (rising powers) changes sign, in order: between two places where its derivative
    does it changes sign once at most, so the derivatives are gone through from the last one up."""
    degree = len(poly) - 1
    ends, count = np.empty(degree + 2), 2
    ends[0], ends[1] = 0.0, 1.0
    for order in range(degree - 1, -1, -1):
        part = poly[order:].copy()
        for j in range(len(part)):
            for k in range(order):
                part[j] *= j + order - k
        found, number = np.empty(degree + 2), 1
        found[0] = 0.0
        for n in range(count - 1):
            low, high = ends[n], ends[n + 1]
            begin = _value(part, low)
            if begin * _value(part, high) >= 0.0:
                continue
            for _ in range(60):
                middle = 0.5 * (low + high)
                if middle in (low, high):
                    break
                if _value(part, middle) * begin > 0.0:
                    low = middle
                else:
                    high = middle
            found[number], number = 0.5 * (low + high), number + 1
        found[number] = 1.0
        ends, count = found, number + 1
    return ends[1 : count - 1]


@inner_kernel()
def _places(q0, q, turn, r_i, width, h_i, h_o, planar, push):
    """Where the pressure turns: how many places, and the places d (m), room for TURNS of them."""
    if push == 0.0:
        count, first, second = _turns(q0, q, turn, width)
        return count, (first, second, width, width, width)
    x = _sign_changes(_polynomial(q0, q, r_i, width, h_i, h_o, planar, push))
    at = np.full(TURNS, width)
    at[: len(x)] = width * x
    return len(x), (at[0], at[1], at[2], at[3], at[4])


@inner_kernel()
def _turns(q0, q, turn, width):
    """The places where a fluid without inertia has its pressure turn."""
    q_o = q0 + width * (q[0] + width * (q[1] + width * q[2]))
    if not 0.0 < turn < width:
        if q0 * q_o < 0.0:
            return 1, _zero(q0, q, 0.0, width, q_o > 0.0), width
        return 0, width, width
    q_t = q0 + turn * (q[0] + turn * (q[1] + turn * q[2]))
    first = _zero(q0, q, 0.0, turn, q_t > 0.0) if q0 * q_t < 0.0 else -1.0
    second = _zero(q0, q, turn, width, q_o > 0.0) if q_t * q_o < 0.0 else -1.0
    if first >= 0.0 and second >= 0.0:
        return 2, first, second
    if first >= 0.0 or second >= 0.0:
        return 1, max(first, second), width
    return 0, width, width


@inner_kernel()
def line_state(x_k, w_k, r_i, r_o, h_i, h_o, z_rate, tilt_rate, mean, planar, mu, p_i, p_o, p_cav, g):
    """What of a line is dry (bits), and three numbers that change sign where that changes: at the inner edge, at the
    outer, and the least pressure above the floor (Pa).  Arguments as `cavitated_line`."""
    width, per = r_o - r_i, 12.0 * mu
    q, turn = cubic(z_rate, tilt_rate, r_i, r_o, mean, planar)
    p_0, _, _, e_0, _, _ = line_sums(0.0, q, r_i, planar, 0.0, width, h_i, h_o, x_k, w_k)
    q0 = ((p_o - p_i - 0.5 * g * (r_o * r_o - r_i * r_i)) / per - p_0) / e_0
    f_i = _bend(0.0, q0, q, r_i, width, h_i, h_o, planar, g / per)
    f_o = _bend(width, q0, q, r_i, width, h_i, h_o, planar, g / per)
    count, places = _places(q0, q, turn, r_i, width, h_i, h_o, planar, g / per)
    # An edge at the floor itself is dry if the pressure falls away from it.
    at_inner = f_i if p_i == p_cav else p_i - p_cav
    at_outer = -f_o if p_o == p_cav else p_o - p_cav
    low, high = min(p_i, p_o) - p_cav, max(p_i, p_o) - p_cav
    least = max(low, high * 1e-3)
    for k in range(count):
        end = places[k]
        falls_before = (f_i < 0.0) == (k % 2 == 0)
        if not falls_before and high > 0.0:
            continue
        h = h_i + (h_o - h_i) * end / width
        rise = line_sums(q0, q, r_i, planar, 0.0, end, h_i, h, x_k, w_k)[0]
        p = p_i + per * rise + 0.5 * g * end * (2.0 * r_i + end) - p_cav
        low, high = min(low, p), max(high, p)
        if falls_before:
            least = p if k < 2 else min(least, p)
    state = 0
    if at_inner < 0.0:
        state |= INNER_DRY
    if at_outer < 0.0:
        state |= OUTER_DRY
    if low < 0.0:
        state |= HAS_DRY
    if high > 0.0 or (low == 0.0 and state == 0):
        state |= HAS_WET
    return state, at_inner if p_i == p_cav else 1.0, at_outer if p_o == p_cav else 1.0, least


@inner_kernel()
def _own(g, r_a, r_b):
    """Integrals of p', r^2 p', r^3 p' of what inertia adds to p', from r_a to r_b (m)."""
    return 0.5 * g * (r_b**2 - r_a**2), 0.25 * g * (r_b**4 - r_a**4), 0.2 * g * (r_b**5 - r_a**5)


@inner_kernel()
def _crossing(q0, q, line, a, b, p_a, p_b, wet_from, x_k, w_k):
    """The d in [a, b] where the pressure (above the floor: p_a at a, p_b at b, of different sign) is zero, and
    the integrals of p', r^2 p', r^3 p' over the wet side of it, which begins at `wet_from` = a or b."""
    r_i, width, h_i, h_o, planar, per, g = line
    wet_is_a = wet_from == a
    dry, p_dry, p_wet = (b, p_b, p_a) if wet_is_a else (a, p_a, p_b)
    slope_h = (h_o - h_i) / width
    h_dry, r_dry = h_i + slope_h * dry, 1.0 if planar else r_i + dry
    # At the dry end the pressure turns: a parabola from there is a good first guess, if it stays inside.
    bend = per * (q[0] + dry * (2.0 * q[1] + dry * 3.0 * q[2])) / (r_dry * h_dry**3)
    bend += g * ((1.0 if planar else 2.0) + 3.0 * (r_i + dry) * slope_h / h_dry)
    step = math.sqrt(-2.0 * p_dry / bend) if bend > 0.0 else 2.0 * width
    if step >= b - a:
        step = (b - a) * p_dry / (p_dry - p_wet)
    d = dry - step if wet_is_a else dry + step
    low, high, h_wet = a, b, h_i + slope_h * wet_from
    s_0 = s_2 = s_3 = 0.0
    for _ in range(60):
        h = h_i + slope_h * d
        if wet_is_a:
            s_0, s_2, s_3, _, _, _ = line_sums(q0, q, r_i, planar, a, d, h_wet, h, x_k, w_k)
            p = p_a + per * s_0 + 0.5 * g * (d - a) * (2.0 * r_i + a + d)
        else:
            s_0, s_2, s_3, _, _, _ = line_sums(q0, q, r_i, planar, d, b, h, h_wet, x_k, w_k)
            p = p_b - per * s_0 - 0.5 * g * (b - d) * (2.0 * r_i + b + d)
        if (p > 0.0) == wet_is_a:
            low = d
        else:
            high = d
        slope = per * (q0 + d * (q[0] + d * (q[1] + d * q[2]))) / ((1.0 if planar else r_i + d) * h**3) + g * (r_i + d)
        if slope == 0.0:
            slope = 1e-300
        move = -p / slope
        if abs(move) < CLOSE * width or high - low < CLOSE * width:
            break
        d = d + move if low < d + move < high else 0.5 * (low + high)
    low, high = (a, d) if wet_is_a else (d, b)
    own_0, own_2, own_3 = _own(g, r_i + low, r_i + high)
    return d, per * s_0 + own_0, per * s_2 + own_2, per * s_3 + own_3


@outer_kernel()
def cavitated_line(x_k, w_k, r_i, r_o, h_i, h_o, z_rate, tilt_rate, mean, planar, mu, p_i, p_o, p_cav, g):
    """Load `int max(p - p_cav, 0) r dr` (N/rad), moment `int max(p - p_cav, 0) r^2 dr` (N m/rad) and the share of the
    face width that is wet, for one angle.  Thickness linear from h_i to h_o (m), thickening rate `z_rate + tilt_rate r`
    (m/s; `mean`: at the mean radius); `x_k`, `w_k` (points,) a Gauss rule on [-1, 1]; `mu` (Pa s), pressures in Pa; `g`
    (Pa/m^2) of inertia.
    The load is split at the cavity's edges, so no quadrature meets a kink."""
    width, per = r_o - r_i, 12.0 * mu
    q, turn = cubic(z_rate, tilt_rate, r_i, r_o, mean, planar)
    p_0, p_2, p_3, e_0, e_2, e_3 = line_sums(0.0, q, r_i, planar, 0.0, width, h_i, h_o, x_k, w_k)
    own_0, own_2, own_3 = _own(g, r_i, r_o)
    q0 = ((p_o - p_i - own_0) / per - p_0) / e_0
    count, places = _places(q0, q, turn, r_i, width, h_i, h_o, planar, g / per)
    p_i, p_o = p_i - p_cav, p_o - p_cav
    # Nothing can be below the floor between edges that are not, unless the pressure falls and then rises.
    rises = _bend(0.0, q0, q, r_i, width, h_i, h_o, planar, g / per) > 0.0
    if p_i >= 0.0 and p_o >= 0.0 and (count == 0 or (count == 1 and rises)):
        load = 0.5 * (p_o * r_o**2 - p_i * r_i**2 - (per * (p_2 + q0 * e_2) + own_2))
        return load, (p_o * r_o**3 - p_i * r_i**3 - (per * (p_3 + q0 * e_3) + own_3)) / 3.0, 1.0

    line = (r_i, width, h_i, h_o, planar, per, g)
    load = moment = wet = 0.0
    a, p_a, h_a = 0.0, p_i, h_i
    for piece in range(count + 1):
        b = width if piece == count else places[piece]
        h_b = h_i + (h_o - h_i) * b / width
        s_0, s_2, s_3, _, _, _ = line_sums(q0, q, r_i, planar, a, b, h_a, h_b, x_k, w_k)
        own_0, own_2, own_3 = _own(g, r_i + a, r_i + b)
        p_b = p_o if piece == count else p_a + (per * s_0 + own_0)
        s_2, s_3, start, stop, p_start, p_stop = per * s_2 + own_2, per * s_3 + own_3, a, b, p_a, p_b
        if p_a <= 0.0 and p_b <= 0.0:
            stop = start
        elif p_a < 0.0:
            start, s_0, s_2, s_3 = _crossing(q0, q, line, a, b, p_a, p_b, b, x_k, w_k)
            p_start = p_b - s_0
        elif p_b < 0.0:
            stop, s_0, s_2, s_3 = _crossing(q0, q, line, a, b, p_a, p_b, a, x_k, w_k)
            p_stop = p_a + s_0
        if stop > start:
            r_a, r_b = r_i + start, r_i + stop
            load += 0.5 * (p_stop * r_b**2 - p_start * r_a**2 - s_2)
            moment += (p_stop * r_b**3 - p_start * r_a**3 - s_3) / 3.0
            wet += (stop - start) / width
        a, p_a, h_a = b, p_b, h_b
    return load, moment, wet
