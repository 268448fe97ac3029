"""Films solved the long way, importing nothing of the package: for tests to compare with."""

import numpy as np
from scipy.integrate import quad, solve_ivp


def pressure_lines(face, state, angles, push=0.0):
    """Reynolds' equation along the radius at every angle, `(r h^3 (p' - push r))' = 12 mu r (dh/dt + wm dh/dtheta)`,
    by shooting with DOP853: returns theta and the solution's integrals over the radius.  `push` (Pa/m^2) of inertia.

    `face`: r_i, r_o, clearance, coning, planar, mean; `state`: dz, gx, gy, their rates, wm, mu, p_i, p_o.
    Everything in the fixed frame, angle by angle, no symmetry used.  Integrals: of p r, p r^2, and r^3/h, p' s, ...
    """
    r_i, r_o, c, coning, planar, mean = face
    dz, gx, gy, dz_t, gx_t, gy_t, wm, mu, p_i, p_o = state
    theta = 2 * np.pi * np.arange(angles) / angles
    sin, cos = np.sin(theta), np.cos(theta)
    r_m, n = 0.5 * (r_i + r_o), angles

    def film(r):
        arm = r_m if mean else r
        h = c + dz + coning * (r - r_i) + arm * (gx * sin - gy * cos)
        turn = arm * (gx * cos + gy * sin)
        return h, dz_t + arm * (gx_t * sin - gy_t * cos) + wm * turn, turn

    def slopes(r, y):
        phi, p1, p0 = y[:n], y[n : 2 * n], y[2 * n : 3 * n]
        h, f, _ = film(r)
        area = 1.0 if planar else r
        per = 12 * mu / (area * h**3)
        return np.concatenate(
            [area * f, per * phi + push * r, per, p1 * r, p0 * r, p1 * r * r, p0 * r * r, r**3 / h, film(r)[2] * p1 * r,
             film(r)[2] * p0 * r]
        )  # fmt: skip

    h_small = min(np.min(film(r_i)[0]), np.min(film(r_o)[0]))
    width, size = r_o - r_i, 12 * mu / (r_m * h_small**3)
    f_size = max(np.max(np.abs(film(r)[1])) for r in (r_i, r_o)) + 1e-30
    scale = [f_size * r_m * width, size * f_size * r_m * width**2, size * width]
    scale += [scale[1] * r_m * width, scale[2] * r_m * width, scale[1] * r_m**2 * width, scale[2] * r_m**2 * width]
    scale += [r_o**4 / h_small, scale[1] * h_small * width, scale[2] * h_small * width]
    atol = np.repeat(np.array(scale) * 1e-18, n)
    found = solve_ivp(slopes, (r_i, r_o), np.zeros(10 * n), "DOP853", rtol=2.3e-14, atol=atol, max_step=width / 40)
    phi, p1, p0, f1, f0, m1, m0, drag, t1, t0 = found.y[:, -1].reshape(10, n)
    edge = (p_o - p_i - p1) / p0
    strip = r_m if planar else 1.0
    force = f1 + edge * f0 + p_i * (r_o**2 - r_i**2) / 2
    moment = m1 + edge * m0 + p_i * (r_o**3 - r_i**3) / 3
    # int dh/dtheta p r dr, whose constant part p_i integrates to zero around the circle.
    turned = t1 + edge * t0
    return theta, dict(
        force=force, moment=moment, inner=-edge * strip, outer=-(edge + phi) * strip, drag=drag, turned=turned
    )


def radial_wrench(face, state, angles, push=0.0):
    """F (N), M = M_x + i M_y (N m) on the stator, flow in +r at both radii (m^3/s), Couette integral
    int r^3/h (m^2), and int p dh/dtheta dA (N m)."""
    theta, line = pressure_lines(face, state, angles, push)
    d = 2 * np.pi / angles
    moment = np.sum(line["moment"] * (np.sin(theta) - 1j * np.cos(theta))) * d
    return (np.sum(line["force"]) * d, moment, np.sum(line["inner"]) * d, np.sum(line["outer"]) * d,
            np.sum(line["drag"]) * d, np.sum(line["turned"]) * d)  # fmt: skip


def pressure_field(face, state, angles, points, push=0.0):
    """Pressure (angles, points) on a dense grid by cumulative Simpson rule, with theta, r and film (same shapes);
    `push` as in `pressure_lines`."""
    r_i, r_o, c, coning, planar, mean = face
    dz, gx, gy, dz_t, gx_t, gy_t, wm, mu, p_i, p_o = state
    theta = 2 * np.pi * np.arange(angles) / angles
    sin, cos = np.sin(theta)[:, None], np.cos(theta)[:, None]
    r = np.linspace(r_i, r_o, 2 * points - 1)
    arm = np.full_like(r, 0.5 * (r_i + r_o)) if mean else r
    h = c + dz + coning * (r - r_i) + arm * (gx * sin - gy * cos)
    f = dz_t + arm * (gx_t * sin - gy_t * cos) + wm * arm * (gx * cos + gy * sin)
    area = np.ones_like(r) if planar else r
    # area * f is a quadratic at most (planar: linear) in r: its integral by Simpson's rule on the halves is exact
    # at even points; the integrand at odd points by the matching three-point formula.
    step = r[1] - r[0]
    phi = _cumulative(area * f, step)
    per = 12 * mu / (area * h**3)
    p1, p0 = _cumulative(per * phi + push * r, step), _cumulative(per, step)
    p = p_i + p1 + (p_o - p_i - p1[:, -1:]) / p0[:, -1:] * p0
    return theta, r, h, p


def _cumulative(values, step):
    """Cumulative integral along the last axis, third order at odd points, fourth at even (Simpson)."""
    out = np.zeros(np.broadcast_shapes(values.shape))
    a, b, c = values[..., 0:-2:2], values[..., 1:-1:2], values[..., 2::2]
    first = step / 12 * (5 * a + 8 * b - c)
    whole = step / 3 * (a + 4 * b + c)
    ends = np.cumsum(whole, axis=-1)
    out[..., 2::2] = ends
    out[..., 1::2] = first
    out[..., 3::2] += ends[..., :-1]
    return out


def floored_wrench(face, state, floor, angles, points, push=0.0):
    """F and M with max(p, floor) on the dense grid."""
    theta, r, _, p = pressure_field(face, state, angles, points, push)
    p = np.maximum(p, floor)
    d = 2 * np.pi / angles
    line, line_2 = np.trapezoid(p * r, r, axis=1), np.trapezoid(p * r * r, r, axis=1)
    return np.sum(line) * d, np.sum(line_2 * (np.sin(theta) - 1j * np.cos(theta))) * d


def green_film():
    """Tilt stiffness (N m/rad) and damping (N m s/rad) of the film of the reference seal, Green (1989), appendix, made
    dimensional: inner over outer radius 0.8, coning 12.5 clearances over the outer radius."""
    ratio, b, r_o, c, mu = 0.8, 12.5, 0.04, 1e-5, 0.5e-3
    stiffness = np.pi * 5e5 * (b * ratio - 1) * ((1 - ratio**2) / (4 + 2 * b * (1 - ratio))) ** 2 * r_o**4 / c
    x = b * (1 - ratio)
    g = (np.log(1 + x) - 2 * x / (2 + x)) / (b**3 * (1 - ratio) ** 2)
    scale = 6 * mu * (r_o / c) ** 2 * (1 - ratio) ** 2 * r_o**4 / c
    return stiffness, 2 * np.pi * ((1 + ratio) / 2) ** 3 * g * scale


def christensen(h, c, strength):
    """Share in contact (pressure over the strength) and energy per area (J/m^2) of asperities of half height c (m)."""
    x = np.clip(h / c, -1, 1)
    share = 0.5 - 35 / 32 * (x - x**3 + 3 * x**5 / 5 - x**7 / 7)
    left = 0.5 * x - 35 / 32 * (x**2 / 2 - x**4 / 4 + x**6 / 10 - x**8 / 56)
    whole = 0.5 - 35 / 32 * (1 / 2 - 1 / 4 + 1 / 10 - 1 / 56)
    return share, strength * c * (whole - left + np.maximum(-1 - h / c, 0))


def tilt_roots(speed, flexible, *, inertia, polar, k_s, d_s, k, d):
    """Roots s (1/s) of the tilt equation of `gamma exp(s t)`, gamma = tilt_x + i tilt_y, in the fixed frame, of a
    flexible "rotor" (turns, and its dampers with it) or "stator" on a support k_s, d_s and a film k, d."""
    spin = speed if flexible == "rotor" else 0.0
    return np.roots([inertia, d_s + d - 1j * polar * spin, k_s + k - 1j * (d_s * spin + d * speed / 2)])


def tilts_in_turning_axes(frame, w, k, d, rotor, stator, own_rotor=0.0, own_stator=0.0):
    """Relative tilt (2,), stator less rotor, that stands still in axes turning at `frame` (rad/s), of a film of tilt
    stiffness k and damping d between two rings (transverse inertia, polar inertia, support stiffness, damping), a rigid
    one None, tilted by `own_rotor`, `own_stator` about the first axis in their springs or, rigid, in space.

    Moments of every part on pairs of real numbers; seen from the axes a rate is the turn of what stands still.
    """
    turn, one = np.array([[0.0, -1.0], [1.0, 0.0]]), np.eye(2)
    film = k * one + d * (frame - w / 2) * turn
    matrix, push = np.zeros((4, 4)), np.zeros(4)
    for at, other, ring, spin, own in ((0, 2, rotor, w, own_rotor), (2, 0, stator, 0.0, own_stator)):
        mine, partner = slice(at, at + 2), slice(other, other + 2)
        if ring is None:
            matrix[mine, mine], push[at] = one, own
            continue
        inertia, polar, k_s, d_s = ring
        # Angular momentum: that of the tilt's rate, and of the spin about the tilted axis.
        matrix[mine, mine] = inertia * frame**2 * (turn @ turn) - polar * spin * frame * (turn @ turn)
        matrix[mine, mine] += k_s * one + d_s * (frame - spin) * turn + film
        matrix[mine, partner] = -film
        push[at] = k_s * own
    tilts = np.linalg.solve(matrix, push)
    return tilts[2:] - tilts[:2]


def opening_force(clearance, coning, p_i, p_o, r_i=0.032, r_o=0.040, geometry="cylindrical"):
    """Opening force (N) from the pressure line itself: r h^3 p' = const, then int p 2 pi r dr, by quadrature."""

    def per(r):
        return 1 / (clearance + coning * (r - r_i)) ** 3 / (r if geometry == "cylindrical" else 1.0)

    options = dict(epsabs=0.0, epsrel=1e-13, limit=400)
    whole = quad(per, r_i, r_o, **options)[0]
    # int p 2 pi r dr by parts: pi [p r^2] - pi int p' r^2 dr.
    bent = quad(lambda r: per(r) * r * r, r_i, r_o, **options)[0] / whole
    return np.pi * (p_o * r_o**2 - p_i * r_i**2 - (p_o - p_i) * bent)


def viscous_dam_pressure(x, films, length, pressures):
    """Pressure (Pa) at `x` (m) from the entrance of a gas dam without inertia, laminar or turbulent: P^2 falls as
    int dx/h^3 between `films` (m) and `pressures` (Pa) at entrance and exit.  Zuk, NASA TM X-68022 (1972)."""
    (h_1, h_2), (p_1, p_2) = films, pressures
    h = h_1 + (h_2 - h_1) * x / length
    part = x / length * h_2**2 * (h_1 + h) / ((h_1 + h_2) * h**2)
    return np.sqrt(p_1**2 + (p_2**2 - p_1**2) * part)


def viscous_dam_load(films, length, pressures):
    """Its gauge force per width (N/m), and the centre of that (share of the length from the entrance)."""

    def gauge(x):
        return viscous_dam_pressure(x, films, length, pressures) - pressures[1]

    force = quad(gauge, 0, length, epsrel=1e-11, limit=200)[0]
    return force, quad(lambda x: gauge(x) * x, 0, length, epsrel=1e-11, limit=200)[0] / (force * length)


def ring_fin(a, b, length, *, conductivity, expansion, poisson, density, specific_heat, convection, wet_bore=False):
    """Resistance (K/W), coning (rad/W) and time constant (s) of a ring a <= r <= b heated through its whole face, as a
    fin with the resistance inside its section: a moment of the hot face, and a ring that is longer where it is hotter.
    Derived here, of rigid sections up to 1.1 sqrt(r_m w) long."""
    wet, dry, side = (a, b, -1.0) if wet_bore else (b, a, 1.0)
    both, area = wet**2 - dry**2, np.pi * (b**2 - a**2)
    log, scale = np.log(wet / dry), 2 * wet / abs(both)
    inside = scale / conductivity * abs(both / 8 - dry**2 / 4 + dry**4 / (2 * both) * log)
    effective = 1 / (1 / convection + inside)
    m = np.sqrt(effective * 2 * np.pi * wet / (conductivity * area))
    z = m * length
    resistance = 1 / (conductivity * area * m * np.tanh(z))
    moment = 12 * (np.tanh(z) / (2 * z) - (1 - 1 / np.cosh(z)) / z**2)
    bow = (1 + poisson) * effective * scale * abs(both / 4 - dry**2 / 2 * log) / (conductivity * (b - a))
    axial = side * bow * length * (np.tanh(z) / z - moment / z**2)
    coning = expansion * resistance * ((a + b) / 2 / length * moment + axial)
    spread = 1 + 2 * z / np.sinh(2 * z)
    return resistance, coning, spread * density * specific_heat / (2 * conductivity * m**2)


def contact_tilt(inner_radius, outer_radius, clearance, coning):
    """Tilt (rad) at which cones at the aligned clearance touch, at whichever edge."""
    return min(clearance / inner_radius, (clearance + coning * (outer_radius - inner_radius)) / outer_radius)
