"""What a shaft feels: against all rings written down at once, and limits by hand."""

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn import read_scenario, run_study
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.modes import at_shaft
from sealdyn.scene.scene import frozen_at_start, with_both_flexible_rings, with_single_flexible_ring

W = 700.0


def scene_of(kind):
    scene = frozen_at_start(read_scenario(SCENARIOS / "fmr_reference.toml").scene)
    return with_both_flexible_rings(scene) if kind == "FMSR" else with_single_flexible_ring(scene, kind)


def complex_tilt(ring, spin, w, base):
    """(ring alone, support) of a tilt g = g_x + i g_y that goes with e^{iwt}; or of axial motion."""
    k, d = ring.support.tilt() if base == "tilt" else (ring.support.axial_stiffness, ring.support.axial_damping)
    if base == "axial":
        return -ring.mass * w**2 + k + 1j * w * d, k + 1j * w * d
    support = k + 1j * d * (w - spin)
    return -ring.transverse_inertia * w**2 + ring.polar_inertia * spin * w + support, support


@pytest.mark.core
@pytest.mark.parametrize("kind", ["FMS", "FMR", "FMSR"])
@pytest.mark.parametrize("base", ["axial", "tilt"])
def test_all_rings_at_once_give_the_same(kind, base):
    """Unknowns stator, rotor and a shaft of unit motion, as complex numbers: the force that holds the shaft there."""
    scene = scene_of(kind)
    linear = Model(scene).linear_scene()
    k, d = linear.film_k, linear.film_d
    film = k[0, 0] + 1j * W * d[0, 0]
    if base == "tilt":
        # Of isotropic matrices: direct less i times the xy element.
        film = k[1, 1] - 1j * k[1, 2] + 1j * W * (d[1, 1] - 1j * d[1, 2])
    rows, right = np.eye(2, dtype=complex), np.zeros(2, dtype=complex)
    if scene.stator.support:
        rows[0] = [complex_tilt(scene.stator, 0.0, W, base)[0] + film, -film]
    if scene.rotor.support:
        alone, support = complex_tilt(scene.rotor, scene.shaft.speed, W, base)
        rows[1], right[1] = [-film, alone + film], support
    else:
        right[1] = 1.0
    if not scene.stator.support:
        rows[0] = [1.0, 0.0]
    stator, rotor = np.linalg.solve(rows, right)
    expected = support * (1.0 - rotor) if scene.rotor.support else film * (rotor - stator)
    z = at_shaft(linear, W)
    found = z[0, 0] if base == "axial" else z[1, 1] - 1j * z[1, 2]
    assert found == pytest.approx(expected, rel=1e-9)


def test_limits():
    """Slow motion meets film and support in series; a shaft that moves fast a film before a ring at rest."""
    scene = scene_of("FMS")
    linear = Model(scene).linear_scene()
    film, support = linear.film_k[0, 0], scene.stator.support.axial_stiffness
    assert at_shaft(linear, 1e-3)[0, 0].real == pytest.approx(film * support / (film + support), rel=1e-6)
    fast = 1e7
    assert at_shaft(linear, fast)[0, 0] == pytest.approx(film + 1j * fast * linear.film_d[0, 0], rel=1e-2)


def test_the_study(tmp_path):
    scenario = read_scenario(SCENARIOS / "fms_reference.toml")
    flags = {"frequency": "10, 50, 100 Hz"}
    found = run_study("shaft-impedance", scenario, tmp_path / "s.h5", flags=flags, workers=1)
    linear = Model(frozen_at_start(scenario.scene)).linear_scene()
    z = at_shaft(linear, 2.0 * np.pi * 50.0)
    assert found["stiffness"][1] == pytest.approx(z.real, rel=1e-9)
    assert np.array(found["damping"][1]) * 2.0 * np.pi * 50.0 == pytest.approx(z.imag, rel=1e-9)
