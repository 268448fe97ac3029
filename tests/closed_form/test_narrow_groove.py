"""Narrow-groove theory: Muijderman's number, the plain film as its limit, and its own differential equation."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import minimize

from sealdyn.closed_form.film import GroovedFace, groove_coefficients, narrow_groove_gas, narrow_groove_liquid

FACE = GroovedFace(0.0516, 0.0616, 0.0555, 0.0616, math.radians(15.0), 0.5, 6e-6, 3e-6)
AREA = math.pi * (FACE.outer_radius**2 - FACE.inner_radius**2)


def muijderman_number(face):
    """g1 of |p_2 - p_1| = 3 mu W (r_2^2 - r_1^2) g1/h_l^2 without flow, W the relative speed."""
    films, lands, slope = face.clearance / (face.clearance + face.depth), 1 / face.share - 1, 1 / math.tan(face.angle)
    cube = films**3
    below = (1 + lands * cube) * (lands + cube) + cube * slope**2 * (1 + lands) ** 2
    return films**2 * slope * lands * (1 - films) * (1 - cube) / below


@pytest.mark.core
def test_the_largest_pumping_is_muijdermans():
    def pumping(x):
        face = FACE._replace(angle=math.radians(10.0 * x[0]), share=1 / (1 + x[2]), depth=3e-6 * (1 / x[1] - 1))
        k1, k2 = groove_coefficients(face)
        return -k2 / k1 * face.clearance**2

    found = minimize(pumping, [1.5, 0.3, 1.1], method="Nelder-Mead", options=dict(xatol=1e-8, fatol=1e-14))
    assert -found.fun == pytest.approx(0.091176, abs=5e-7)
    assert found.x == pytest.approx([1.5678, 0.2737, 1.0], abs=3e-4)


@pytest.mark.parametrize("angle, share, depth", [(15.0, 0.5, 6e-6), (-25.0, 0.35, 4e-6), (60.0, 0.7, 9e-6)])
def test_pumping_is_that_of_muijdermans_form(angle, share, depth):
    face = FACE._replace(angle=math.radians(angle), share=share, depth=depth)
    k1, k2 = groove_coefficients(face)
    assert k2 / k1 * face.clearance**2 == pytest.approx(muijderman_number(face), rel=1e-12)


def test_a_row_of_an_independent_computation():
    assert groove_coefficients(FACE) == pytest.approx((7.39045e-17, 6.964286e-07), rel=1e-6)
    found = narrow_groove_liquid(FACE, 1e-3, -150.0, 0.0, 0.0)
    assert found == pytest.approx((7218.00846, -7.71858871e-07), rel=1e-8)


def test_without_depth_it_is_the_plain_film():
    plain = FACE._replace(depth=0.0)
    found = narrow_groove_liquid(plain, 1e-3, 150.0, 1e5, 5e5)
    # int p 2 pi r dr of p linear in ln r.
    log, at_edges = math.log(0.0616 / 0.0516), 5e5 * 0.0616**2 - 1e5 * 0.0516**2
    assert found.force == pytest.approx(math.pi * at_edges - 4e5 * AREA / (2 * log), rel=1e-12)
    assert found.flow == pytest.approx(-math.pi * 3e-6**3 * 4e5 / (6e-3 * log), rel=1e-12)
    gas = narrow_groove_gas(plain, 1.8e-5, -500.0, 1e5, 5e5)
    flow = math.pi * 3e-6**3 * (1e5**2 - 5e5**2) / (12.0 * 1.8e-5) / math.log(0.0616 / 0.0516)
    assert gas.flow == pytest.approx(flow, rel=1e-9)
    assert gas.force - 1e5 * AREA == pytest.approx(907.2336887, rel=1e-8)


@pytest.mark.parametrize("angle, outer", [(15.0, 5e5), (-15.0, 5e5), (15.0, 1e5)])
def test_gas_by_another_road(angle, outer):
    """Collocation of p^2/2 with the flow as its parameter."""
    face = FACE._replace(angle=math.radians(angle))
    k1, k2 = groove_coefficients(face)

    def slope(x, y, q):
        # Both annuli at once, each over x from 0 to 1.
        found = []
        for n, (a, b, one, two) in enumerate([(0.0516, 0.0555, 3e-6**3, 0.0), (0.0555, 0.0616, k1, k2)]):
            r, p = a + (b - a) * x, np.sqrt(np.maximum(2e10 * y[n], 1.0))
            found.append((b - a) * 12.0 * 1.8e-5 / one * (-500.0 * r * two * p - q[0] / (2.0 * math.pi * r)) / 1e10)
        return np.array(found)

    def ends(left, right, q):
        return np.array([left[0] - 0.5, right[0] - left[1], right[1] - 0.5 * outer**2 / 1e10])

    x = np.linspace(0.0, 1.0, 80)
    start = 0.5 + (0.5 * outer**2 / 1e10 - 0.5) * np.array([0.5 * x, 0.5 + 0.5 * x])
    solved = solve_bvp(slope, ends, x, start, [-1.0], tol=1e-9, max_nodes=20000)
    assert solved.success
    assert narrow_groove_gas(face, 1.8e-5, -500.0, 1e5, outer).flow == pytest.approx(solved.p[0], rel=1e-6)
