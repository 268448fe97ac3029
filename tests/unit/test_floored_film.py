"""The floored film against oracles that share nothing with it: exact lines of a planar flat face, mpmath around the
circle; and what a solver needs of it: smoothness across the places where lines begin to be dry."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from sealdyn.faces import geometry
from sealdyn.films.radial import floored as radial
from sealdyn.scene.film import Film

R_I, R_O, C, MU = 0.0495, 0.0505, 2e-6, 5e-3
R_M, WIDTH = 0.5 * (R_I + R_O), R_O - R_I


def block(error, mean=True, coning=0.0, geometry="planar", cavitation=0.0, radii=(R_I, R_O)):
    film = Film(
        inner_radius=radii[0], outer_radius=radii[1], viscosity=MU, outer_pressure=0.0, inner_pressure=0.0,
        geometry=geometry, tilt_radius="mean" if mean else "local", coning=coning, cavitation_pressure=cavitation,
    )  # fmt: skip
    return radial.parameters(film, C, error)


def gap_state(motion, mean_spin, p_i, p_o, spin_difference=0.0):
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[:6], s[geometry.MEAN_SPIN], s[geometry.VISCOSITY] = motion, mean_spin, MU
    s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE], s[geometry.SPIN_DIFFERENCE] = p_i, p_o, spin_difference
    return s


def exact_line(h, rate, p_i, p_o, floor):
    """max(p - floor, 0) on a film of one thickness: p is a parabola in r, its roots and its integrals are exact."""
    bend = 6 * MU * rate / h**3
    # p - floor = bend (d^2 - d L) + p_i - floor + (p_o - p_i) d / L
    p = np.array([p_i - floor, (p_o - p_i) / WIDTH - bend * WIDTH, bend])
    roots = np.roots(p[::-1]) if bend else np.array([-p[0] / p[1]]) if p[1] else np.array([])
    inside = sorted(x.real for x in roots if abs(x.imag) < 1e-300 and 0 < x.real < WIDTH)
    ends = [0.0, *inside, WIDTH]
    load = moment = wet = 0.0
    for a, b in pairwise(ends):
        if np.polyval(p[::-1], 0.5 * (a + b)) > 0:
            line, line_2 = np.polymul(p[::-1], [1, R_I]), np.polymul(p[::-1], [1, 2 * R_I, R_I**2])
            load += np.diff(np.polyval(np.polyint(line), [a, b]))[0]
            moment += np.diff(np.polyval(np.polyint(line_2), [a, b]))[0]
            wet += (b - a) / WIDTH
    return load, moment, wet


def composite(panels, points):
    """Nodes and weights on [-1, 1] of Gauss rules side by side."""
    x, w = np.polynomial.legendre.leggauss(points)
    middles = (2 * np.arange(panels) + 1) / panels - 1
    return np.ravel(middles[:, None] + x / panels), np.tile(w / panels, panels)


# A face almost closed has its peak within 1e-3 of the circle.
AROUND = composite(48, 24)


def exact_circle(motion, mean_spin, p_i, p_o, floor):
    """Force, moment, cavitated share and torque of the pressure of a planar flat face tilted at its mean radius."""
    z, gx, gy, zt, gxt, gyt = motion

    def at(theta):
        s, c = math.sin(theta), math.cos(theta)
        turn = R_M * (gx * c + gy * s)
        return C + z + R_M * (gx * s - gy * c), zt + R_M * (gxt * s - gyt * c) + mean_spin * turn, turn

    def parts(theta):
        h, rate, turn = at(theta)
        load, moment, wet = exact_line(h, rate, p_i, p_o, floor)
        return load, moment * math.sin(theta), -moment * math.cos(theta), wet, -0.5 * turn * load

    def depth(theta):
        """What changes sign where a line begins to be dry: the rate, or the parabola's least pressure."""
        h, rate, _ = at(theta)
        if p_i == p_o == floor:
            return rate
        bend = 6 * MU * rate / h**3
        slope = (p_o - p_i) / WIDTH - bend * WIDTH
        lowest = -slope / (2 * bend) if bend > 0 else -1.0
        return p_i - floor - slope**2 / (4 * bend) if 0 < lowest < WIDTH else 1e30

    grid = np.linspace(0, 2 * np.pi, 2001)
    marks = [depth(t) for t in grid]
    ends = [brentq(depth, a, b, xtol=1e-15) for a, b, p, q in zip(grid, grid[1:], marks, marks[1:], strict=False)
            if p * q < 0]  # fmt: skip
    ends = [*ends, ends[0] + 2 * np.pi] if ends else [0.0, 2 * np.pi]
    total = np.zeros(5)
    for a, b in pairwise(ends):
        for x, weight in zip(*AROUND, strict=True):
            # Clusters at both ends, so that no power of the kink is left.
            theta = 0.5 * (a + b) + 0.25 * (b - a) * x * (3 - x * x)
            total += np.multiply(parts(theta), weight * 0.75 * (b - a) * (1 - x * x))
    force = total[0] + math.pi * floor * (R_O**2 - R_I**2)
    return force, complex(total[1], total[2]), 1 - total[3] / (2 * np.pi), total[4]


STATES = {
    "wedge": (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    "wedge and squeeze": (0.3e-6, 0.0, 0.0, -2e-5, 1e-3, -2e-3),
    "drawn apart": (-0.2e-6, 0.0, 0.0, 3e-4, 5e-3, 1e-3),
}
PRESSURES = {"all at the floor": (0.0, 0.0), "inside above it": (2e5, 0.0), "both above it": (4e5, 1e5)}


def motion_of(name, share):
    dz, _, _, *rates = STATES[name]
    tilt = (1 - share) * (C + dz) / R_M
    return (dz, tilt * math.cos(2.1), tilt * math.sin(2.1), *rates)


@pytest.mark.parametrize("pressures", PRESSURES)
@pytest.mark.parametrize("name", STATES)
@pytest.mark.parametrize("share", [0.8, 0.05])
def test_planar_flat_face_against_exact_lines(name, pressures, share):
    p_i, p_o = PRESSURES[pressures]
    motion = motion_of(name, share)
    force, moment, dry, torque = exact_circle(motion, 300.0, p_i, p_o, 0.0)
    for error in (1e-5, 1e-7, 1e-9):
        s = gap_state(motion, 300.0, p_i, p_o)
        radial.flow(block(error), s)
        found = complex(s[geometry.MOMENT_X], s[geometry.MOMENT_Y])
        assert s[geometry.FORCE] == pytest.approx(force, rel=error)
        assert abs(found - moment) < error * abs(moment)
        assert s[geometry.CAVITATED] == pytest.approx(dry, abs=3e-5 if error > 1e-6 else 1e-6)
        assert s[geometry.TORQUE] == pytest.approx(torque, rel=10 * error, abs=1e-12 * abs(moment))


@pytest.mark.parametrize("mean", [True, False])
@pytest.mark.parametrize("pressures", PRESSURES)
def test_smooth_in_the_state(pressures, mean):
    """What Newton's method meets: the squeeze goes from filling the film to emptying it, past every kind of kink;
    polynomials through neighbouring states leave 1e-7 of force and moment only (a trapezoid's noise: 1e-4)."""
    f, (p_i, p_o) = block(1e-7, mean), PRESSURES[pressures]
    motion = np.array(motion_of("wedge and squeeze", 0.3))
    for centre in np.linspace(-2e-4, 4e-4, 25):
        steps, values = np.linspace(-1.0, 1.0, 9), []
        for step in steps:
            motion[3] = centre + 1e-8 * step
            s = gap_state(motion, 300.0, p_i, p_o)
            radial.wrench(f, s)
            values.append([s[geometry.FORCE], s[geometry.MOMENT_X] / R_M, s[geometry.MOMENT_Y] / R_M])
        values = np.array(values)
        smooth = np.array([np.polyval(np.polyfit(steps, v, 2), steps) for v in values.T]).T
        assert np.max(np.abs(values - smooth)) < 1e-9 * np.max(values)


@pytest.mark.core
def test_the_tables_are_a_gauss_kronrod_pair():
    """Exact for polynomials up to degree 31 and 19, and not beyond."""
    x = np.concatenate([radial.NODES, -radial.NODES[-2::-1]])
    fine = np.concatenate([radial.KRONROD, radial.KRONROD[-2::-1]])
    coarse = np.concatenate([radial.GAUSS, radial.GAUSS[::-1]])
    for weights, nodes, degree in ((fine, x, 31), (coarse, x[1::2], 19)):
        for power in range(0, degree + 1, 2):
            assert weights @ nodes**power == pytest.approx(2 / (power + 1), abs=2e-15)
        assert abs(weights @ nodes ** (degree + 3) - 2 / (degree + 4)) > 1e-15


# Rates (m/s, rad/s) of faces that meet almost: most of the circle is then thick and lies between two angles of an even
# scan; the share left and the mean spin (rad/s).
ALMOST_CLOSED = {
    "rocking in, dry where it is thick": (1.8e-3, 0.0, (0.0, 2e-4, 8e-5), (0.0, 0.0)),
    "rocking out, wet where it is thick": (1.6e-3, 0.0, (0.0, -1.2e-4, 3.6e-5), (0.0, 0.0)),
    "rocking and squeezed": (1.9e-3, 0.0, (-4.3e-5, 9e-4, 2.5e-5), (0.0, 0.0)),
    "above the floor at both edges": (1.9e-3, 300.0, (0.0, -3.2e-2, -5.5e-2), (4e5, 1e5)),
}


@pytest.mark.parametrize("name", ALMOST_CLOSED)
def test_almost_closed_face_against_exact_lines(name):
    share, mean_spin, rates, (p_i, p_o) = ALMOST_CLOSED[name]
    tilt = (1 - share) * C / R_M
    for angle in (0.0, 0.4, 2.1, 5.0):
        turn = complex(*rates[1:]) * complex(math.cos(angle), math.sin(angle))
        motion = (0.0, tilt * math.cos(angle), tilt * math.sin(angle), rates[0], turn.real, turn.imag)
        force, _, dry, _ = exact_circle(motion, mean_spin, p_i, p_o, 0.0)
        s = gap_state(motion, mean_spin, p_i, p_o)
        radial.flow(block(1e-7), s)
        assert 0.05 < dry < 0.95
        assert s[geometry.CAVITATED] == pytest.approx(dry, abs=3e-5)
        assert s[geometry.FORCE] == pytest.approx(force, rel=1e-7)
