"""Runs of seals whose faces have a profile: through the program, against cones, and the energy they exchange."""

import math

import numpy as np
import pytest
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fmr, fms, run

from sealdyn import open_archive, read_scenario, simulate
from sealdyn.faces import contact, geometry
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.film import Profile
from sealdyn.scene.forces import Contact
from sealdyn.studies.wear.rosenbrock import HatBasis

SCENARIO = """
[shaft]
speed = "1000 rad/s"
[film]
inner_radius = "32 mm"
outer_radius = "40 mm"
clearance = "10 um"
viscosity = "0.5 mPa*s"
outer_pressure = "5 bar"
inner_pressure = 0
[film.profile]
radius = ["32 mm", "33.5 mm", "36 mm", "40 mm"]
depth = ["0.5 um", "0 um", "8 um", "22 um"]
[contact]
roughness = "0.1 um"
compressive_strength = "300 MPa"
stator_wear_coefficient = "1e-16 1/Pa"
[rotor]
runout = { time = ["0 s", "0.0125 s"], value = ["25 urad", "8 mrad"] }
[stator]
mass = "1 kg"
transverse_inertia = "8e-4 kg*m^2"
polar_inertia = "16e-4 kg*m^2"
misalignment = "0.4 mrad"
[stator.support]
axial_stiffness = "5e5 N/m"
axial_damping = "300 N*s/m"
radius = "40 mm"
[run]
turns = 2.1
accuracy = 1e-5
start = "steady"
"""
RADIUS, DEPTH = (0.032, 0.0335, 0.036, 0.040), (0.5e-6, 0.0, 8e-6, 22e-6)
ROUGH = Contact(roughness=0.1e-6, compressive_strength=300e6, stator_wear_coefficient=1e-16)


def test_a_rubbing_run_of_the_program(tmp_path):
    """The energy balances, h_min is the formula of a profiled face, and faces touch at a radius of the profile."""
    (tmp_path / "worn.toml").write_text(SCENARIO)
    result = simulate(read_scenario(tmp_path / "worn.toml"), tmp_path / "worn.h5")
    assert result.status == "ok" and result.summary["model"]["film"] == "profiled"
    assert result.summary["energy_residual"] < 1e-4
    data = open_archive(result.archive)
    g = np.hypot(data["relative_tilt_x"].values, data["relative_tilt_y"].values)[:, None]
    low = CLEARANCE + data["axial_gap_change"].values[:, None] + np.array(DEPTH) - np.array(RADIUS) * g
    assert data["h_min"].values == pytest.approx(low.min(axis=1), rel=1e-9, abs=1e-15)
    assert data["h_min_radius"].values == pytest.approx(np.array(RADIUS)[low.argmin(axis=1)])
    assert data["contact_force"].values.max() > 1.0 and data["h_min_radius"].values[-1] == 0.0335


@pytest.mark.parametrize("n", [2, 9])
def test_a_linear_profile_runs_as_its_coning(n):
    """The same motion to the accuracy of the run, with large tilt."""
    r = np.linspace(R_I, R_O, n)
    cone = run(fmr(fixed=2.6e-3), turns=4, accuracy=1e-9, start="steady")
    worn = film("profiled", coning=0.0, profile=Profile(tuple(r), tuple(3.125e-3 * (r - R_I))))
    found = run(fmr(film=worn, fixed=2.6e-3), turns=4, accuracy=1e-9, start="steady")
    assert np.max(np.abs(found.scaled() - cone.scaled())) < 1e-6
    for name in ("h_min", "leakage_inner", "friction_torque"):
        assert found[name] == pytest.approx(cone[name], rel=1e-6)


def rubbing(accuracy):
    worn = film("auto", coning=0.0, profile=Profile(RADIUS, DEPTH))
    ramp = PiecewiseLinear((0.0, 2 * 2 * math.pi / SPEED), (25e-6, 8e-3))
    return run(fms(film=worn, contact=ROUGH, own=4e-4, runout=ramp), turns=3, accuracy=accuracy, start="steady")


@pytest.mark.slow
def test_rubbing_converges_and_its_energy_balances():
    rough, fine, finest = (rubbing(accuracy) for accuracy in (1e-5, 1e-7, 1e-8))
    assert fine["contact_force"].max() > 1.0
    errors = [np.max(np.abs(found.scaled() - finest.scaled())) for found in (rough, fine)]
    assert errors[0] < 1e-3 and errors[1] < 1e-5
    for found, accuracy in ((rough, 1e-5), (fine, 1e-7)):
        assert found.outcome.energy_residual < 10 * accuracy


@pytest.mark.core
def test_wear_at_the_radii_is_the_wear_rate_of_the_run():
    """Sum of depth rate times hat area over the face: the mean wear rate, at every sample."""
    found = rubbing(1e-6)
    ready, out = found.ready, np.zeros(len(RADIUS))
    areas, rates = HatBasis(RADIUS).areas, []
    for dz, x, y in zip(*(found[n] for n in ("axial_gap_change", "relative_tilt_x", "relative_tilt_y")), strict=True):
        s = np.zeros(geometry.GAP_STATE_SIZE)
        s[geometry.DZ], s[geometry.GX], s[geometry.GY] = dz, x, y
        contact.wear_rates(ready.model.contact, ready.model.f, s, out)
        depth_rates = 1e-16 * SPEED * out / areas
        rates.append(np.sum(depth_rates * areas) / np.sum(areas))
    assert max(rates) > 0 and np.array(rates) == pytest.approx(found["wear_rate"], rel=1e-12, abs=1e-30)
