"""Smallest film thickness against a search over the face, and the continuation of a film below its floor."""

import numpy as np
import pytest
from scenes import CLEARANCE, R_I, R_O, film

from sealdyn.faces import geometry as G
from sealdyn.faces.film_thickness import h_min

CONINGS = {"converging": 3.125e-3, "flat": 0.0, "diverging": -1.1e-3}


def gap(dz=0.0, g_x=0.0, g_y=0.0):
    """A gap state; of faces without waves nothing else is asked."""
    s = np.full(G.GAP_STATE_SIZE, np.nan)
    s[:3] = dz, g_x, g_y
    s[G.CONING_CHANGE] = 0.0
    return s


def thickness(r, theta, coning, dz, g_x, g_y, mean=False):
    """Film between two rigid cones, from the formula of faces/geometry.py."""
    arm = 0.5 * (R_I + R_O) if mean else r
    return CLEARANCE + dz + coning * (r - R_I) + arm * (g_x * np.sin(theta) - g_y * np.cos(theta))


def states(count=40):
    """Axial shifts and tilts of any direction, some beyond touch."""
    draw = np.random.default_rng(7)
    angles = np.concatenate([[0.0, np.pi / 2, np.pi, -np.pi / 2], draw.uniform(-np.pi, np.pi, count - 4)])
    tilts = draw.uniform(0.0, 1.5, count) * CLEARANCE / R_O
    return zip(draw.normal(size=count) * 0.3 * CLEARANCE, tilts * np.cos(angles), tilts * np.sin(angles), strict=True)


@pytest.mark.core
@pytest.mark.parametrize("mean", [False, True], ids=["local", "mean"])
@pytest.mark.parametrize("coning", CONINGS.values(), ids=CONINGS)
def test_smallest_thickness_against_a_search(coning, mean):
    f = G.face_parameters(film(coning=coning, tilt_radius="mean" if mean else "local"), CLEARANCE)
    count = 3600
    theta, r = np.meshgrid(2 * np.pi * np.arange(count) / count, np.linspace(R_I, R_O, 9))
    sides = set()
    for dz, g_x, g_y in states():
        low, at, radius = h_min(f, gap(dz, g_x, g_y))
        searched = thickness(r, theta, coning, dz, g_x, g_y, mean).min()
        # Half a grid step from the minimum the cosine has risen by (pi/count)^2 / 2.
        slack = R_O * np.hypot(g_x, g_y) * (np.pi / count) ** 2 / 2
        assert low - 1e-18 <= searched <= low + slack + 1e-18
        assert thickness(radius, at, coning, dz, g_x, g_y, mean) == pytest.approx(low, abs=1e-17)
        assert -np.pi <= at <= np.pi
        assert low == min(G.edge_gaps(f, dz, np.hypot(g_x, g_y), 0.0))
        sides.add(radius)
    # With the tilt taken at one radius the coning alone says which edge is thinner.
    assert sides == ({R_I} if coning >= 0.0 and mean else {R_O} if mean or coning <= 0.0 else sides)


def test_untilted_faces_have_a_finite_place():
    low, at, radius = h_min(G.face_parameters(film(), CLEARANCE), gap(1e-6))
    assert low == pytest.approx(CLEARANCE + 1e-6, rel=1e-15) and np.isfinite(at) and radius == R_I


def test_thickness_below_the_floor_stays_positive_and_smooth():
    floor = G.face_parameters(film(floor=1e-3), CLEARANCE)[G.FLOOR]
    assert floor == pytest.approx(1e-3 * CLEARANCE, rel=1e-15)
    h = np.concatenate([-np.geomspace(1e3, 1e-3, 200) * floor, np.linspace(0.0, 3.0, 301) * floor])
    seen = np.array([G.regularised_thickness(value, floor) for value in h])
    assert np.all(seen > 0.0) and np.all(np.diff(seen) > 0.0)
    assert np.all(seen[h >= floor] == h[h >= floor])
    # Value and slope are continuous: one-sided differences on both sides agree as the step shrinks.
    assert G.regularised_thickness(floor * (1 - 1e-15), floor) == pytest.approx(floor, rel=1e-14)
    for step in (1e-3, 1e-5):
        below = (floor - G.regularised_thickness(floor * (1 - step), floor)) / (step * floor)
        above = (G.regularised_thickness(floor * (1 + step), floor) - floor) / (step * floor)
        assert abs(below - above) < 1.5 * step
