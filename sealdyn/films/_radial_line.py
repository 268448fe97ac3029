"""A radial line of Reynolds' equation: `p' = 12 mu Q / (r h^3)` (planar: no r), h linear, Q a cubic in d = r - r_i."""

import math

from ..numerics.kernel import inner_kernel


@inner_kernel()
def line_sums(q0, q, r_i, planar, a, b, h_a, h_b, x_k, w_k):
    """Integrals of Q/h^3, r^2 Q/h^3, r^3 Q/h^3 (over r unless planar) from d = a to b, films h_a to h_b; then
    the same three of 1/h^3."""
    h_g = math.sqrt(h_a * h_b)
    root = math.sqrt(h_g / h_a)
    t, u_a, u_s = (root - 1.0) / (root + 1.0), 1.0 / root, 1.0 / (root + 1.0 / root)
    per_h, span = 1.0 / h_g, b - a
    scale = span * (1.0 - t * t) * u_s * per_h**3
    reach = 0.5 * (1.0 - t) * u_s * span
    p_0 = p_2 = p_3 = e_0 = e_2 = e_3 = 0.0
    for k in range(len(x_k)):
        tx = t * x_k[k]
        both = 1.0 / ((1.0 - tx) * (1.0 + tx))
        back = (1.0 + tx) * both
        u, v = (1.0 + tx) * back, (1.0 - tx) * (1.0 - tx) * both
        d = a + reach * (1.0 + x_k[k]) * back * (u + u_a)
        r = r_i + d
        weight = w_k[k] * scale * back * back * v**5
        unit = weight if planar else weight / r
        slope = unit * (q0 + d * (q[0] + d * (q[1] + d * q[2])))
        p_0 += slope
        p_2 += slope * r * r
        p_3 += slope * r**3
        e_0 += unit
        e_2 += unit * r * r
        e_3 += unit * r**3
    return p_0, p_2, p_3, e_0, e_2, e_3


@inner_kernel()
def cubic(z_rate, tilt_rate, r_i, r_o, mean, planar):
    """Coefficients of d, d^2, d^3 in `Phi = int f r dr` (planar: `int f dr`), and the d where f changes sign
    (-1: nowhere)."""
    if mean:
        rate = z_rate + tilt_rate * 0.5 * (r_i + r_o)
        return ((rate, 0.0, 0.0) if planar else (rate * r_i, 0.5 * rate, 0.0)), -1.0
    rate = z_rate + tilt_rate * r_i
    turn = -rate / tilt_rate if tilt_rate != 0.0 else -1.0
    if planar:
        return (rate, 0.5 * tilt_rate, 0.0), turn
    return (rate * r_i, 0.5 * (rate + tilt_rate * r_i), tilt_rate / 3.0), turn
