"""Triangles over one pitch of a pattern: closed, on the edges, fine at the tips, and how p^2 goes there."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from grooved_faces import R_I, R_O, SPIRAL, TEE

from sealdyn.faces.pattern import Box, Boxes
from sealdyn.films._grooved.mesh import Tip, mesh_of, tips_of, whole_circle

PADS = Boxes(3, 4e-6, (Box(0.0545, 0.058, 0.6),), phase=0.4)
PATTERNS = [SPIRAL, replace(SPIRAL, angle=-0.6, share=0.3, inner_radius=0.053, outer_radius=0.058), TEE, PADS]


def edges(mesh):
    """How many triangles have each edge: its nodes, and how many sectors the second lies ahead."""
    found = Counter()
    for nodes, ahead in zip(mesh.corners.tolist(), mesh.shifts.tolist(), strict=True):
        for k in range(3):
            (a, first), (b, second) = sorted([(nodes[k], ahead[k]), (nodes[k - 1], ahead[k - 1])])
            found[a, b, second - first] += 1
    return found


@pytest.mark.core
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("bisections", [0, 8])
def test_triangles_fill_the_pitch_once(pattern, bisections):
    mesh = mesh_of(pattern, R_I, R_O, 8, bisections=bisections)
    for one in (mesh, whole_circle(mesh)):
        assert one.area.min() > 0.0
        assert one.count * one.area.sum() == pytest.approx(2.0 * math.pi * math.log(R_O / R_I), rel=1e-12)
        both = one.inner | one.outer
        for (a, b, _), times in edges(one).items():
            assert times == (1 if (one.inner[a] and one.inner[b]) or (one.outer[a] and one.outer[b]) else 2)
        assert np.allclose(np.exp(one.u[one.inner]), R_I) and np.allclose(np.exp(one.u[one.outer]), R_O)
        assert len(one.free) + both.sum() == len(one.u)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_no_triangle_lies_across_an_edge_of_the_pattern(pattern):
    mesh = mesh_of(pattern, R_I, R_O, 10)
    for near in np.eye(3) * 0.98 + 0.02 / 3.0:
        # Near each corner as at the middle.
        depth = pattern.depth_at(np.exp(mesh.corner_u @ near), mesh.corner_phi @ near)
        assert np.array_equal(depth, mesh.depth)
    assert set(mesh.depth) == {0.0, pattern.depth}


def test_twice_the_columns_halve_every_edge():
    coarse, fine = (mesh_of(SPIRAL, R_I, R_O, 8, times, bisections=0) for times in (1, 2))
    assert len(fine.corners) == 4 * len(coarse.corners)
    old = {(round(u, 9), round(phi, 9)) for u, phi in zip(coarse.u, coarse.phi, strict=True)}
    assert old <= {(round(u, 9), round(phi, 9)) for u, phi in zip(fine.u, fine.phi, strict=True)}


def test_tips_are_found_and_refined():
    for pattern, count, opened in ((SPIRAL, 4, 2), (TEE, 6, 0), (PADS, 4, 0)):
        plain, fine = (mesh_of(pattern, R_I, R_O, 8, bisections=times) for times in (0, 8))
        tips = tips_of(plain)
        assert len(tips) == count and sum(tip.open for tip in tips) == opened
        for tip in tips:
            sizes = [mesh.area[(mesh.corners == tip.node).any(axis=1)].max() for mesh in (plain, fine)]
            assert sizes[1] < sizes[0] / 100.0
        assert len(fine.u) < len(plain.u) + 80 * count


@pytest.mark.parametrize(
    "degrees, opened, kappa, power",
    [(15.0, False, 27.0, 0.657), (165.0, True, 27.0, 0.622), (165.0, True, 8.0, 0.742), (90.0, False, 27.0, 0.693)],
)
def test_power_of_the_pressure_at_a_tip(degrees, opened, kappa, power):
    assert Tip(0, math.radians(degrees), opened).exponent(kappa) == pytest.approx(power, abs=5e-4)


@pytest.mark.parametrize("opened", [False, True])
def test_the_power_at_a_tip_by_finite_differences_around_it(opened):
    """u'' = -lambda^2 u on the circle (or half of it) about the tip, with kappa u' the same on both sides."""
    kappa, filled, n = 12.0, 1.1, 4000
    around = math.pi if opened else 2.0 * math.pi
    edges = np.linspace(0.0, around, n + 1)
    middle, step = 0.5 * (edges[1:] + edges[:-1]), around / n
    conductivity = np.where(middle < filled, kappa, 1.0)
    from scipy.sparse import diags
    from scipy.sparse.linalg import eigsh

    # Nodes at the edges, the first and the last given or the same.
    own = (np.roll(conductivity, 1) + conductivity) / step
    held = 0.5 * step * (np.roll(conductivity, 1) + conductivity)
    first = 1 if opened else 0
    stiff = diags([own[first:], -conductivity[first:-1] / step, -conductivity[first:-1] / step], [0, 1, -1]).tolil()
    if not opened:
        stiff[0, n - 1] = stiff[n - 1, 0] = -conductivity[-1] / step
    values = eigsh(stiff.tocsc(), 3, diags(held[first:]).tocsc(), sigma=0.05, return_eigenvectors=False)
    least = min(value for value in np.sqrt(np.abs(values)) if value > 1e-3)
    assert Tip(0, filled, opened).exponent(kappa) == pytest.approx(min(least, 1.0), rel=2e-3)
