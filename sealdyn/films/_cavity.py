"""One radial line of a film whose pressure is floored: where it cavitates, what the rest carries."""

import math

from numba import njit

PANELS = 8


@njit(cache=True)
def _slope(x, line):
    """dp/dx (Pa) at x in [-1, 1], the radius there and dr/dx; `line` holds the line's constants."""
    (r_i, width, t, u_i, u_s, h_g, edge, z_rate, tilt_rate, r_m, mean, planar, mu) = line
    back = 1.0 / (1.0 - t * x)
    u = (1.0 + t * x) * back
    d = 0.5 * (1.0 - t) * u_s * width * (1.0 + x) * back * (u + u_i)
    dr = width * u * (1.0 - t * t) * u_s * back * back
    r = r_i + d
    if planar:
        phi_0, phi_1, per_r = d, d * (r_i + 0.5 * d), 1.0
    else:
        phi_0, phi_1, per_r = d * (r_i + 0.5 * d), d * (r_i * r_i + d * (r_i + d / 3.0)), 1.0 / r
    if mean:
        phi_1 = r_m * phi_0
    h = h_g * u * u
    return 12.0 * mu * (z_rate * phi_0 + tilt_rate * phi_1 + edge) * per_r * dr / h**3, r, dr


@njit(cache=True)
def _rise(a, b, x_k, w_k, line):
    """Integrals of p', r^2 p' and r^3 p' from x = a to b, by the Gauss rule."""
    half, middle = 0.5 * (b - a), 0.5 * (a + b)
    rise = rise_2 = rise_3 = 0.0
    for k in range(len(x_k)):
        slope, r, _ = _slope(middle + half * x_k[k], line)
        rise += w_k[k] * slope
        rise_2 += w_k[k] * slope * r * r
        rise_3 += w_k[k] * slope * r**3
    return half * rise, half * rise_2, half * rise_3


@njit(cache=True)
def _crossing(a, b, p_a, level, x_k, w_k, line):
    """x in [a, b] where the pressure, p_a at a, crosses `level`: Newton held inside the bracket."""
    low, high = a, b
    falling = p_a > level
    x = 0.5 * (a + b)
    for _ in range(60):
        rise, _, _ = _rise(a, x, x_k, w_k, line)
        excess = p_a + rise - level
        if (excess > 0.0) == falling:
            low = x
        else:
            high = x
        slope, _, _ = _slope(x, line)
        step = x - excess / slope if slope != 0.0 else low
        previous = x
        x = step if low < step < high else 0.5 * (low + high)
        if abs(x - previous) < 1e-14:
            break
    return x


@njit(cache=True)
def floored_line(x_k, w_k, r_i, r_o, h_i, h_o, z_rate, tilt_rate, mean, planar, mu, p_i, p_o, p_cav):
    """Load `int max(p, p_cav) r dr` (N/rad), moment `int max(p, p_cav) r^2 dr` (N m/rad) and the share of
    the face width that is full, for one angle.  Thickness linear from h_i to h_o (m), thickening rate
    `z_rate + tilt_rate r` (m/s).  The load is split at the cavity's edges, so no quadrature meets a kink."""
    width, r_m = r_o - r_i, 0.5 * (r_i + r_o)
    h_g = math.sqrt(h_i * h_o)
    q = math.sqrt(h_g / h_i)
    t, u_i, u_s = (q - 1.0) / (q + 1.0), 1.0 / q, 1.0 / (q + 1.0 / q)

    # The two boundary pressures give the edge constant: p' is linear in it.
    bare = (r_i, width, t, u_i, u_s, h_g, 0.0, z_rate, tilt_rate, r_m, mean, planar, mu)
    unit = (r_i, width, t, u_i, u_s, h_g, 1.0, 0.0, 0.0, r_m, mean, planar, mu)
    edge = (p_o - p_i - _rise(-1.0, 1.0, x_k, w_k, bare)[0]) / _rise(-1.0, 1.0, x_k, w_k, unit)[0]
    line = (r_i, width, t, u_i, u_s, h_g, edge, z_rate, tilt_rate, r_m, mean, planar, mu)

    # A pressure that only rises or only falls stays between its boundary values: nothing to floor.
    rising = falling = True
    for k in range(len(x_k) + 2):
        x = x_k[k] if k < len(x_k) else (-1.0 if k == len(x_k) else 1.0)
        slope = _slope(x, line)[0]
        rising, falling = rising and slope >= 0.0, falling and slope <= 0.0
    if rising or falling:
        _, rise_2, rise_3 = _rise(-1.0, 1.0, x_k, w_k, line)
        return 0.5 * (p_o * r_o**2 - p_i * r_i**2 - rise_2), (p_o * r_o**3 - p_i * r_i**3 - rise_3) / 3.0, 1.0

    load = moment = wet = 0.0
    p_a, a = p_i, -1.0
    for panel in range(PANELS):
        b = -1.0 + 2.0 * (panel + 1) / PANELS
        # Halve a panel that dips below and comes back: its edges must be bracketed singly.
        end = b
        slope_a, _, _ = _slope(a, line)
        slope_b, _, _ = _slope(b, line)
        if slope_a < 0.0 < slope_b:
            low, high = a, b
            for _ in range(50):
                end = 0.5 * (low + high)
                if _slope(end, line)[0] < 0.0:
                    low = end
                else:
                    high = end
        while True:
            rise, rise_2, rise_3 = _rise(a, end, x_k, w_k, line)
            p_b = p_a + rise
            start, stop, p_start, p_stop = a, end, p_a, p_b
            full = True
            if p_a <= p_cav and p_b <= p_cav:
                full = False
            elif p_a < p_cav or p_b < p_cav:
                edge_x = _crossing(a, end, p_a, p_cav, x_k, w_k, line)
                if p_a < p_cav:
                    start, p_start = edge_x, p_cav
                else:
                    stop, p_stop = edge_x, p_cav
                rise, rise_2, rise_3 = _rise(start, stop, x_k, w_k, line)
            if full:
                r_a, r_b = _slope(start, line)[1], _slope(stop, line)[1]
                # Measured from the floor, so that the dry part carries exactly p_cav.
                load += 0.5 * ((p_stop - p_cav) * r_b**2 - (p_start - p_cav) * r_a**2 - rise_2)
                moment += ((p_stop - p_cav) * r_b**3 - (p_start - p_cav) * r_a**3 - rise_3) / 3.0
                wet += (r_b - r_a) / width
            a, p_a = end, p_b
            if end == b:
                break
            end = b
    load += 0.5 * p_cav * (r_o * r_o - r_i * r_i)
    moment += p_cav * (r_o**3 - r_i**3) / 3.0
    return load, moment, wet
