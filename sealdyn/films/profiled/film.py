"""Radial film between faces of any profile: Reynolds' equation solved exactly over the radius at every angle.

**Source** the moment integrals of the radial film (films/radial/film.py),

    r h^3 p' = 12 mu (Phi + c),   Phi = integral of f r dr,   f = dh/dt + wm dh/dtheta

(planar: no r).  Phi does not ask for the shape of the faces; only 1/h^3 does, and its integrals are sums over the
pieces of the radius between which h is linear.
**Valid** narrow and moderately wide faces, incompressible, laminar; no pressure flow around the circle; faces whose
shape is the same all around; no cavitation.
"""

import math

import numpy as np

from ...faces.geometry import (
    CAVITATED,
    CONING_RATE,
    DZ_RATE,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    PROFILE,
    PROFILE_RADII,
    SPIN_DIFFERENCE,
    TILT_AT_MEAN,
    TORQUE,
    VISCOSITY,
)
from ...numerics.kernel import inner_kernel, value_kernel
from .. import _radial_pressure, _radial_quadrature
from .._radial_quadrature import COSINES, ERROR, MOST_ANGLES, SINES, centrifugal
from .quadrature import BLOCK_SIZE, PLAIN, TABLE, at_angle, drag, lay_in_r, nodes_of, phi, pieces_of, plain_ratios, sums

RUNG = 2
GENERALISES = "radial"
FIELDS, grid, fields = _radial_pressure.FIELDS, _radial_pressure.grid, _radial_pressure.fields


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    return "faces that are the same all around" if waves else ""


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,).

    `film` a Film table, `clearance` design clearance at the inner radius where the profile is 0 (m), `error` relative
    error allowed to the quadrature of force and moments; points and angles follow it and the gap.
    """
    f = np.zeros(BLOCK_SIZE)
    f[:PLAIN] = _radial_quadrature.parameters(film, clearance, error)
    if f[PROFILE] == 0.0:
        f[PROFILE], f[PROFILE_RADII], f[PROFILE_RADII + 1] = 2, film.inner_radius, film.outer_radius
    r = f[PROFILE_RADII : PROFILE_RADII + int(f[PROFILE])]
    f[PLAIN:] = plain_ratios(float(np.min(r[:-1] / r[1:])), float(f[ERROR]))
    return f


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned film between still or turning faces (rad/s),
    `force(clearance, inner_pressure, outer_pressure, floor)`: pressures absolute (Pa), clearance and floor of the film
    thickness (without it the film's own) in m."""
    return _radial_quadrature.opening_law(film, parameters, wrench, mean_spin, spin_difference)


@inner_kernel()
def _circle(f, s, complete):
    """Integrate over the face.  `complete` asks for leakage and friction torque too."""
    r_i, r_o, mean, planar = f[INNER_RADIUS], f[OUTER_RADIUS], f[TILT_AT_MEAN] != 0.0, f[PLANAR] != 0.0
    mu, p_i, p_o, r_m = s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE], 0.5 * (r_i + r_o)
    # A cone that grows is a tilting of every radius alike.
    cone_rate = s[CONING_RATE]
    z_rate = s[DZ_RATE] - cone_rate * r_i
    # In p - g r^2/2 the film is one without inertia.
    g = centrifugal(f, s)
    p_i, p_o = p_i - 0.5 * g * r_i * r_i, p_o - 0.5 * g * r_o * r_o

    # The frame of the tilt: beta = 0 at the thinnest place, f even part + odd part.
    tilt = math.hypot(s[GX], s[GY])
    c_a, s_a = (s[GX] / tilt, s[GY] / tilt) if tilt > 0.0 else (1.0, 0.0)
    along = c_a * s[GX_RATE] + s_a * s[GY_RATE]
    across = c_a * s[GY_RATE] - s_a * s[GX_RATE] - s[MEAN_SPIN] * tilt

    nodes = nodes_of(f, s)
    pieces, points, angles, low = pieces_of(f, nodes, tilt)
    table = np.empty((TABLE, points))
    lay_in_r(f, nodes, pieces, table)
    whole_0, whole_1 = phi(r_o - r_i, r_i, r_m, mean, planar)
    stride, drive = MOST_ANGLES // angles, (p_o - p_i) / (12.0 * mu)

    force = moment_even = moment_odd = flow_i = flow_o = couette = twist = 0.0
    for j in range(angles // 2 + 1):
        cos_b, sin_b = f[COSINES + j * stride], f[SINES + j * stride]
        at_angle(f, nodes, pieces, table, tilt * cos_b, low)
        even = along * cos_b - cone_rate
        a0, ae, a1, b0, be, b1, c0, ce, c1 = sums(table, z_rate, even)
        edge, edge_odd = (drive - ae) / a0, -a1 / a0
        twice = 1.0 if j == 0 or 2 * j == angles else 2.0
        force += twice * (be + edge * b0)
        moment_even += twice * cos_b * (ce + edge * c0)
        moment_odd += twice * sin_b * sin_b * (c1 + edge_odd * c0)
        if complete:
            flow_i -= twice * edge
            flow_o -= twice * (edge + z_rate * whole_0 - even * whole_1)
            couette += twice * drag(table, planar)
            twist += twice * sin_b * sin_b * (b1 + edge_odd * b0)

    d_beta = 2.0 * math.pi / angles
    m_along, m_across = 4.0 * mu * d_beta * moment_even, -4.0 * mu * across * d_beta * moment_odd
    s[FORCE] = math.pi * (p_o * r_o * r_o - p_i * r_i * r_i) - 6.0 * mu * d_beta * force
    s[FORCE] += 0.25 * math.pi * g * (r_o**4 - r_i**4)
    s[MOMENT_X], s[MOMENT_Y] = c_a * m_along - s_a * m_across, s_a * m_along + c_a * m_across
    s[CAVITATED] = 0.0
    if complete:
        # The planar face is a strip of the mean circumference: what flows in flows out.
        s[FLOW_INNER] = flow_i * d_beta * (r_m if planar else 1.0)
        s[FLOW_OUTER] = flow_o * d_beta * (r_m if planar else 1.0)
        # Couette drag, and the pressure pushing on the slope of the film (by parts: no dp/dtheta needed).
        pressure_part = -3.0 * mu * across * d_beta * twist * r_m if mean else 0.5 * m_across
        s[TORQUE] = mu * s[SPIN_DIFFERENCE] * d_beta * couette + tilt * pressure_part


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    _circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m):
    `int [mu (W_r - W_s) r^3/h + (h/2) r dp/dtheta] dr dtheta`, what the shaft supplies."""
    _circle(f, s, True)
