"""The scene chooses its unknowns: which, why, and where they stand."""

import math

import numpy as np
import pytest
from scenes import CLEARANCE, NOTHING, R_O, SPEED, SUPPORT, film, fmr, fms, fmsr, free_ring, ring, started

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing, Shaft, Whirl
from sealdyn.scene.rings import AxialRunout, Rotor, Support
from sealdyn.scene.scene import Closing, Initial, RingStart
from sealdyn.simulation.selection import choose_method

TURN = 2 * math.pi / SPEED
ALIGNED = dict(own=0.0, fixed=0.0)
TILTS = ["rotor_tilt_x", "rotor_tilt_y"]
MASSLESS = dict(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0)


def layout(scene):
    return started(scene, TURN)


# --- which ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["radial", "linear"])
def test_aligned_scene_has_axial_unknowns_only(model):
    """Nothing tilts: axial runout, axial vibration and axial starts keep it so."""
    runout = Rotor(**ring(), axial_runout=[AxialRunout(order=2, amplitude=1e-6)])
    shaking = Housing(axial=[AxialVibration(frequency=100.0, displacement=1e-6)])
    start = Initial(rotor=RingStart(z=1e-6))
    for more in ({}, dict(rotor=runout), dict(housing=shaking), dict(initial=start)):
        ready = layout(fmr(model, **(ALIGNED | more)))
        assert ready.model.unknowns.names == ["rotor_z"]
        assert ready.reasons


def test_both_rings_of_an_aligned_scene():
    assert layout(fmsr(own=0.0, fixed=0.0)).model.unknowns.names == ["stator_z", "rotor_z"]


def driven():
    angular = Housing(angular=[AngularVibration(frequency=75.0, displacement=1e-6)])
    return {
        "own misalignment": fmr("linear", fixed=0.0),
        "stator misalignment": fmr("linear", own=0.0),
        "growing misalignment": fmr("linear", own=0.0, fixed=PiecewiseLinear((0.0, 1.0), (0.0, 1e-6))),
        "whirl": fmr("linear", **ALIGNED, shaft=Shaft(speed=SPEED, whirl=[Whirl(ratio=0.4, angle=1e-6)])),
        "angular vibration": fmr("linear", **ALIGNED, housing=angular),
        "start": fmr("linear", **ALIGNED, initial=Initial(rotor=RingStart(tilt_x=1e-6))),
        "start rate": fmr("linear", **ALIGNED, initial=Initial(rotor=RingStart(tilt_y_rate=1e-3))),
    }


@pytest.mark.parametrize("name", driven())
def test_linear_film_without_axial_forcing_has_tilts_only(name):
    ready = layout(driven()[name])
    assert ready.model.unknowns.names == TILTS and ready.model.unknowns.size == 4 + 6


def test_linear_film_with_both_drives_keeps_both():
    drives = [
        dict(housing=Housing(axial=[AxialVibration(frequency=100.0, displacement=1e-6)])),
        dict(initial=Initial(rotor=RingStart(z=1e-6))),
        dict(film=film("linear", outer_pressure=PiecewiseLinear((0.0, 1.0), (5e5, 6e5)))),
        dict(film=film("linear", clearance=None), closing=Closing(0.75, PiecewiseLinear((0.0, 1.0), (0.0, 1.0)))),
    ]
    for more in drives:
        ready = layout(fmr("linear", **more))
        assert ready.model.unknowns.names == ["rotor_z", *TILTS]


def test_nonlinear_film_with_tilt_keeps_all():
    ready = layout(fmsr())
    assert ready.model.unknowns.names == [f"{r}_{p}" for r in ("stator", "rotor") for p in ("z", "tilt_x", "tilt_y")]


def test_a_start_of_a_rigid_ring_tilts_nothing():
    """Only a ring that floats can start anywhere."""
    assert layout(fmr(**ALIGNED, initial=Initial(stator=RingStart(tilt_x=1e-6)))).model.unknowns.names == ["rotor_z"]


@pytest.mark.core
@pytest.mark.parametrize(
    "build, arrangement, floats",
    [(fmr, "FMR:", [False, True]), (fms, "FMS:", [True, False]), (fmsr, "FMSR:", [True] * 2)],
)
def test_arrangement_follows_from_the_supports(build, arrangement, floats):
    ready = layout(build())
    assert [bool(ready.model.unknowns.floats[k]) for k in (0, 1)] == floats
    assert any(reason.startswith(arrangement) for reason in ready.reasons)


def test_massless_ring_has_no_rates():
    ready = layout(fmr(rotor=Rotor(**ring(**MASSLESS), misalignment=1e-6)))
    assert ready.model.unknowns.massless and list(ready.model.unknowns.rate_places) == [-1] * 3
    assert ready.model.unknowns.n_mechanical == 3 and ready.model.unknowns.size == 9 and ready.model.algebraic == []
    assert choose_method(ready)[0] == "ida"


def test_a_ring_may_lack_one_inertia_only():
    """Mass without transverse inertia: the axial motion keeps its rate."""
    ready = layout(fmr(rotor=Rotor(**ring(transverse_inertia=0.0, polar_inertia=0.0), misalignment=1e-6)))
    unknowns = ready.model.unknowns
    assert unknowns.massless and list(unknowns.rate_places) == [3, -1, -1] and unknowns.n_mechanical == 4


def test_mass_of_a_motion_that_is_not_integrated_does_not_matter():
    """Linear film, tilt only: a ring without mass but with inertia is an ordinary ring."""
    ready = layout(fmr("linear", rotor=Rotor(**ring(mass=0.0), misalignment=1e-6)))
    unknowns = ready.model.unknowns
    assert unknowns.names == TILTS and not unknowns.massless and choose_method(ready)[0] != "ida"


def test_massless_and_undamped_is_algebraic():
    spring = Support(axial_stiffness=5e5, radius=0.04)
    rotor = Rotor(**ring(**MASSLESS, support=spring), misalignment=1e-6)
    assert layout(fmr("linear", film=film("linear", coefficients=NOTHING), rotor=rotor)).model.algebraic == [0, 1]
    # The film's damping makes it first order again.
    assert layout(fmr("linear", rotor=rotor)).model.algebraic == []


# --- places and scales ---------------------------------------------------------------------------------


@pytest.mark.parametrize("build", [fmr, fms, fmsr])
def test_every_unknown_has_its_own_place(build):
    ready = layout(build())
    unknowns = ready.model.unknowns
    assert sorted([*range(unknowns.n), *unknowns.rate_places]) == list(range(unknowns.n_mechanical))
    q, rate = np.arange(1.0, ready.model.unknowns.n + 1), -np.arange(1.0, ready.model.unknowns.n + 1)
    y = ready.model.vector(q, rate)
    found = ready.segment(0).motion(y[None, :], np.zeros((1, ready.model.unknowns.size)))
    assert np.array_equal(found[0][0], q) and np.array_equal(found[1][0], rate)


def test_scales_are_the_clearance_and_its_tilt_and_the_shaft_speed():
    ready = layout(fmr())
    expected = [CLEARANCE, CLEARANCE / R_O, CLEARANCE / R_O]
    assert np.allclose(ready.model.scales[:3], expected, rtol=1e-15)
    assert np.allclose(ready.model.scales[ready.model.unknowns.rate_places], np.array(expected) * SPEED, rtol=1e-15)
    assert ready.model.reference_rate == SPEED and np.all(ready.model.scales > 0)


def test_a_shaft_at_rest_takes_its_pace_from_what_shakes_it():
    shaking = Housing(axial=[AxialVibration(frequency=400.0, acceleration=20.0)])
    ready = started(fms(**dict(own=0.0, runout=0.0), speed=0.0, housing=shaking), 0.01)
    assert ready.model.reference_rate == pytest.approx(2 * math.pi * 400.0, rel=1e-15)


def test_memory_is_the_run_for_an_undamped_ring_and_short_for_a_damped_one():
    free, damped = (started(scene, 1000 * TURN) for scene in (free_ring(), fmr("linear")))
    # Fastest period of the free ring: the forward root of -I w^2 + J W w + K_s = 0.
    fastest = SPEED + math.sqrt(SPEED**2 + SUPPORT.tilt()[0] / 8e-4)
    assert free.memory == pytest.approx(1000 * TURN * fastest / (2 * math.pi), rel=1e-9)
    assert damped.memory < 10
