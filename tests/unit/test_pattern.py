"""Patterns of faces: where they are deep, their share, edges and mirror images."""

import math

import numpy as np
import pytest

from sealdyn.faces.pattern import Box, Boxes, Dimples, Spiral, pumps

SPIRAL = Spiral(12, 0.0555, 0.0616, math.radians(15.0), 0.4, 6e-6, phase=0.2)
TEE = Boxes(12, 6e-6, (Box(0.0555, 0.0585, 0.7), Box(0.0585, 0.0616, 0.2)), phase=0.1)
DIMPLES = Dimples(20, 0.056, 3e-3, 1e-3, math.radians(30.0), 5e-6)
RADII, ROUND = np.linspace(0.0516, 0.0616, 301)[:, None], np.linspace(0.0, 2.0 * math.pi, 24001)[:-1]


@pytest.mark.core
def test_grooves_fill_their_share_of_every_circle_between_their_radii():
    found = SPIRAL.depth_at(RADII, ROUND)
    share = (found > 0.0).mean(axis=1)
    grooved = (RADII[:, 0] >= 0.0555) & (RADII[:, 0] <= 0.0616)
    assert share[grooved] == pytest.approx(np.full(grooved.sum(), 0.4), abs=2e-3) and not share[~grooved].any()
    assert set(np.unique(found)) == {0.0, 6e-6}


def test_the_edges_of_a_spiral_are_where_its_depth_jumps():
    edges, near = SPIRAL.edges, 1e-9
    r = np.linspace(0.0556, 0.0615, 7)
    for xi, side in zip(edges.angles, (1.0, -1.0), strict=True):
        phi = xi + edges.slope * np.log(r / edges.reference)
        assert (SPIRAL.depth_at(r, phi + side * near) > 0.0).all() and not SPIRAL.depth_at(r, phi - side * near).any()
    # r = r_g e^{phi tan a}
    assert edges.slope == pytest.approx(1.0 / math.tan(math.radians(15.0)))
    assert SPIRAL.depth_at(0.0555, SPIRAL.phase) > 0.0


def test_a_tee_is_arms_and_stem_not_deeper_where_they_overlap():
    overlapping = Boxes(12, 6e-6, (*TEE.boxes[:1], Box(0.057, 0.0616, 0.2)), phase=0.1)
    assert np.array_equal(overlapping.depth_at(RADII, ROUND), TEE.depth_at(RADII, ROUND))
    share = (TEE.depth_at(RADII, ROUND) > 0.0).mean(axis=1)
    assert share[RADII[:, 0] > 0.0586] == pytest.approx(0.2, abs=1e-3)
    assert share[(RADII[:, 0] > 0.0556) & (RADII[:, 0] < 0.0584)] == pytest.approx(0.7, abs=1e-3)
    assert len(TEE.edges.angles) == 4 and TEE.edges.slope == 0.0


def test_a_dimple_has_the_area_of_its_ellipse():
    # In (ln r, phi) it is an ellipse; there r^2 is that of its centre but for a share of the second order.
    r = np.linspace(0.054, 0.058, 801)
    phi = np.linspace(0.0, 2.0 * math.pi / 20, 2001)[:-1]
    u = np.log(r)
    deep = (DIMPLES.depth_at(r[:, None], phi) > 0.0).mean(axis=1) * 2.0 * math.pi / 20
    area = np.sum(0.5 * (deep[1:] + deep[:-1]) * np.diff(u)) * 0.056**2
    assert area == pytest.approx(math.pi * 3e-3 * 1e-3 / 4.0, rel=5e-3)
    # Its far end along the positive axis lies farther out.
    along = 0.49 * 3e-3 / 0.056
    cos, sin = math.cos(DIMPLES.angle), math.sin(DIMPLES.angle)
    assert DIMPLES.depth_at(0.056 * math.exp(along * sin), along * cos) > 0.0
    assert not DIMPLES.depth_at(0.056 * math.exp(along * sin), -along * cos)


def test_which_way_spirals_pump():
    """It turns with the face and with the angle."""
    assert pumps(SPIRAL.angle, -500.0) == "inwards" == pumps(-SPIRAL.angle, 500.0)
    assert pumps(SPIRAL.angle, 500.0) == "outwards" and pumps(SPIRAL.angle, 0.0) == "nowhere"
