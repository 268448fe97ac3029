"""Pressures of the radial and the profiled film over the face, against Reynolds' equation integrated along each line by
the trapezoid on a fine grid."""

from itertools import pairwise

import numpy as np
import pytest
from scenes import CLEARANCE, R_I, R_O, SPEED, film
from scipy.integrate import cumulative_trapezoid, simpson

from sealdyn.faces import geometry
from sealdyn.films import film_named
from sealdyn.scene.film import Profile

MU, P_I, P_O = 3e-3, 1e5, 6e5
RADII, DEPTHS = (R_I, 0.0335, 0.036, R_O), (0.5e-6, 0.0, 8e-6, 22e-6)
# Points of the trapezoid between two radii of the grid.
FINE = 2000
FACES = {
    "cone": {}, "planar": {"geometry": "planar"}, "tilted at the mean radius": {"tilt_radius": "mean"},
    "planar, mean": {"geometry": "planar", "tilt_radius": "mean"}, "diverging": {"coning": -0.1e-3},
    "floor": {"cavitation_pressure": 1e5}, "inertia": {"inertia": True, "density": 8000.0},
    "profile": {"model": "profiled", "coning": 0.0, "profile": Profile(RADII, DEPTHS)},
    "planar profile": {"model": "profiled", "geometry": "planar", "profile": Profile(RADII, DEPTHS)},
}  # fmt: skip


def gap_state(share=0.2):
    """A tilt that leaves `share` of the clearance, and rates of the size of the motion."""
    s, tilt = np.zeros(geometry.GAP_STATE_SIZE), (1 - share) * CLEARANCE / R_O
    s[:6] = (0.05 * CLEARANCE, 0.8 * tilt, -0.6 * tilt, 0.03 * CLEARANCE * SPEED, 0.2 * tilt * SPEED, -tilt * SPEED)
    s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE], s[geometry.VISCOSITY] = 0.5 * SPEED, SPEED, MU
    s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = P_I, P_O
    return s


def pressures(table, s, radii, angles):
    """(radii, angles), from formulas of the gap alone."""
    dz, gx, gy, dz_rate, gx_rate, gy_rate, spin = s[:7]
    fine = [np.linspace(a, b, FINE, endpoint=False) for a, b in pairwise(radii)]
    r = np.append(np.concatenate(fine), radii[-1])[:, None]
    sin, cos = np.sin(angles), np.cos(angles)
    arm = 0.5 * (R_I + R_O) + 0 * r if table.tilt_radius == "mean" else r
    weight = 1.0 + 0 * r if table.geometry == "planar" else r
    h = CLEARANCE + dz + table.coning * (r - R_I) + arm * (gx * sin - gy * cos)
    if table.profile:
        h = h + np.interp(r, RADII, DEPTHS)
    rate = dz_rate + arm * (gx_rate * sin - gy_rate * cos + spin * (gx * cos + gy * sin))

    def summed(slope):
        return cumulative_trapezoid(slope, r, axis=0, initial=0.0)

    driven, through = summed(summed(rate * weight) / (weight * h**3)), summed(1 / (weight * h**3))
    # One face turns, the other does not: p' gains 3/10 rho r w^2.
    driven += summed(0.3 * table.density * r * SPEED**2 / (12 * MU) + 0 * driven) if table.inertia else 0.0
    c = ((P_O - P_I) / (12 * MU) - driven[-1]) / through[-1]
    p = (P_I + 12 * MU * (driven + c * through))[::FINE]
    return p if table.cavitation_pressure is None else np.maximum(p, table.cavitation_pressure)


@pytest.mark.core
@pytest.mark.parametrize("faces", FACES)
def test_pressures_are_those_of_reynolds_equation(faces):
    table, s = film(**FACES[faces]), gap_state()
    module = film_named(table.model, table)
    f = module.parameters(table, CLEARANCE)
    radii, angles = module.grid(f)
    found = np.full((1, len(radii), len(angles)), np.nan)
    module.fields(f, s, found)
    expected = pressures(table, s, radii, angles)
    assert np.max(np.abs(found[0] - expected)) < 1e-6 * np.max(expected)
    assert np.ptp(expected) > P_O, "this state must drive the film"
    if table.cavitation_pressure is not None:
        assert np.mean(found == table.cavitation_pressure) > 0.05


def test_the_grid_holds_the_edges_and_the_nodes_of_a_profile():
    for faces, nodes in (("cone", (R_I, R_O)), ("profile", RADII)):
        table = film(**FACES[faces])
        module = film_named(table.model, table)
        radii, angles = module.grid(module.parameters(table, CLEARANCE))
        assert np.all(np.diff(radii) > 1e-6) and 17 <= len(radii) <= 17 + len(nodes) - 2
        assert radii[0] == R_I and radii[-1] == R_O and np.all(np.isin(nodes, radii))
        assert np.diff(angles) == pytest.approx(2 * np.pi / len(angles)) and angles[0] == 0.0


def test_below_the_floor_the_film_is_as_its_force_sees_it():
    """Faces that overlap: the pressures sum up to the film's force."""
    for faces in ("cone", "profile"):
        table, s = film(floor=0.2, **FACES[faces]), gap_state(share=-0.3)
        module = film_named(table.model, table)
        f = module.parameters(table, CLEARANCE)
        radii, angles = module.grid(f)
        found = np.empty((1, len(radii), len(angles)))
        module.fields(f, s, found)
        module.wrench(f, s)
        force = simpson(found[0] * radii[:, None], x=radii, axis=0).mean() * 2 * np.pi
        assert force == pytest.approx(s[geometry.FORCE], rel=0.03)
