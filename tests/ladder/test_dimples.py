"""Dimples: triangles on their edges, a film beside one of plain cells, land between them, and a run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from grooved_faces import GAS, LIQUID, R_I, R_O
from scenes import run
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from sealdyn.faces.pattern import Dimples
from sealdyn.films._grooved.aligned import aligned_film, pattern_of
from sealdyn.films._grooved.balance import extrapolated, steady, steady_pair
from sealdyn.films._grooved.mesh import dimpled_mesh
from sealdyn.scene.checks import scene_errors
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.patterns import Grooves, land_shares
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene

DIMPLES = Dimples(20, 0.0566, 6e-3, 3e-3, math.radians(40.0), 5e-6)
CLOSE = Dimples(60, 0.0566, 7e-3, 3e-3, math.radians(25.0), 5e-6, 0.02)
ROW = Grooves(20, 5e-6, shape="dimples", radius=0.0566, length=6e-3, width=3e-3, angle=math.radians(40.0))
ELLIPSE = math.pi * 6e-3 * 3e-3 / 4.0
RUN = type("Run", (), {"duration": 1.0, "start": "rest", "turns": None})()


@pytest.mark.core
@pytest.mark.parametrize("pattern", [DIMPLES, CLOSE, replace(DIMPLES, angle=0.0), replace(DIMPLES, width=6e-3)])
def test_no_triangle_lies_on_both_sides_of_an_edge(pattern):
    mesh = dimpled_mesh(pattern, R_I, R_O, 12, 1)
    level = pattern.level(np.exp(mesh.corner_u), mesh.corner_phi)
    deep, on = mesh.depth > 0.0, np.abs(level) < 1e-9
    assert mesh.area.min() > 0.0 and (level[deep] < 1e-9).all()
    assert mesh.area.sum() == pytest.approx(mesh.pitch * math.log(R_O / R_I), rel=1e-12)
    # On the lands chords bulge by their sagitta only.
    assert (level[~deep] > -1e-9).all() and on.any()


def test_polygons_become_the_ellipse():
    areas = [mesh.area[mesh.depth > 0.0].sum() * DIMPLES.radius**2
             for mesh in (dimpled_mesh(DIMPLES, R_I, R_O, 16, times) for times in (1, 2, 4))]  # fmt: skip
    left = 1.0 - np.array(areas) / ELLIPSE
    assert left[2] < 1e-3 and (left[:-1] / left[1:] > 3.0).all()


def plain_cells(pattern, conditions, n):
    """Force (N) and flow at the inner edge (m^3/s) of a full film of liquid on n x n cells of
    (ln r, phi) that have the depth of their middles, between two of which harmonic means pass."""
    pitch, low, high = 2.0 * math.pi / pattern.count, math.log(R_I), math.log(R_O)
    du, dphi = (high - low) / n, pitch / n
    u, phi = low + du * (np.arange(n) + 0.5), dphi * (np.arange(n) + 0.5)
    r = np.exp(u)[:, None]
    h = conditions.clearance + pattern.depth_at(r, phi)
    k = h**3 / (12.0 * conditions.viscosity)
    at, rows, columns, values, right = np.arange(n * n).reshape(n, n), [], [], [], np.zeros((n, n))

    def link(here, there, way):
        for a, b in ((here, there), (there, here)):
            rows.extend([a.ravel(), a.ravel()])
            columns.extend([a.ravel(), b.ravel()])
            values.extend([way.ravel(), -way.ravel()])

    link(at[:-1], at[1:], 2.0 * k[:-1] * k[1:] / (k[:-1] + k[1:]) * dphi / du)
    after = np.roll(k, -1, axis=1)
    link(at, np.roll(at, -1, axis=1), 2.0 * k * after / (k + after) * du / dphi)
    # What a face drags along, from the film that it leaves: r^2 w h.
    dragged = conditions.entrainment * r**2 * 0.5 * (h + np.roll(h, -1, axis=1)) * du
    right += np.roll(dragged, 1, axis=1) - dragged
    for row, pressure in ((0, conditions.inner_pressure), (-1, conditions.outer_pressure)):
        way = 2.0 * k[row] * dphi / du
        rows.append(at[row])
        columns.append(at[row])
        values.append(way)
        right[row] += way * pressure
    matrix = coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n * n, n * n))
    p = spsolve(matrix.tocsc(), right.ravel()).reshape(n, n)
    force = pattern.count * float((p * r**2).sum() * du * dphi)
    flow = pattern.count * float((2.0 * k[0] * (conditions.inner_pressure - p[0])).sum() * dphi / du)
    return np.array([force, flow])


@pytest.mark.core
def test_the_film_is_that_of_plain_cells():
    """Which see the edge as steps, and err by some of their width."""
    coarse, fine, power = steady_pair(DIMPLES, R_I, R_O, LIQUID, 16)
    found = [extrapolated(number(coarse), number(fine), power)[0]
             for number in (lambda one: one.force, lambda one: one.flows[0])]  # fmt: skip
    rough, cells = (plain_cells(DIMPLES, LIQUID, n) for n in (120, 240))
    assert power == 2.0
    assert found == pytest.approx((2.0 * cells - rough).tolist(), rel=1e-2)
    assert found[0] == pytest.approx(cells[0], rel=1e-3)


@pytest.mark.parametrize("conditions", [GAS, LIQUID])
def test_what_enters_leaves_over_dimples(conditions):
    found = steady(dimpled_mesh(DIMPLES, R_I, R_O, 12, 1), conditions)
    assert found.flows[0] == pytest.approx(found.flows[1], rel=1e-9)


def seal(row=ROW, **stator):
    film = Film(R_I, R_O, 5e5, 1e5, viscosity=1.8e-5, gas="air", temperature=300.0, clearance=3e-6)
    support = Support(axial_stiffness=1.64e4, axial_damping=1e3, tilt_stiffness=3e5, tilt_damping=500.0)
    ring = Stator(mass=0.2, transverse_inertia=3.5e-4, support=support, **stator)
    return Scene(shaft=Shaft(speed=1000.0), film=film, rotor=Rotor(grooves=[row]), stator=ring)


def test_dimples_leave_land():
    """As much as their ellipses do, and between the radii that the mesh has."""
    radii, shares = land_shares(seal())
    assert (radii[1], radii[-2]) == pytest.approx(DIMPLES.reach, rel=1e-12)
    radii, shares = np.array(radii), np.array(shares)
    areas = math.pi * np.diff(radii**2)
    assert ((1.0 - shares) * areas).sum() == pytest.approx(20 * ELLIPSE, rel=1e-2)


@pytest.mark.parametrize(
    "key, changes",
    [("radius", {"radius": R_O}), ("width", {"width": None}), ("width", {"width": 0.0}), ("share", {"share": 0.5}),
     ("stem_share", {"stem_share": 0.2}), ("length", {"shape": "pad"})],
)  # fmt: skip
def test_dimples_that_cannot_be(key, changes):
    assert not scene_errors(seal(), RUN)
    assert f"rotor.grooves.0.{key}" in [error.key for error in scene_errors(seal(replace(ROW, **changes)), RUN)]


def test_a_run_begins_where_the_aligned_film_is():
    """Aligned, one dimple for all of them; what is steady stays."""
    scene = seal()
    done = run(scene, 0.01, accuracy=1e-6, method="ida")
    assert pattern_of(ROW) == DIMPLES
    found = aligned_film(scene, 3e-6, 4).fine
    assert done["film_force"][0] == pytest.approx(found.force, rel=2e-3)
    assert np.abs(done.q[:, 0]).max() < 3e-10
