"""Lands of grooved faces on their asperities: load, moment and friction against a fine quadrature over the pattern."""

import math
from dataclasses import replace

import numpy as np
import pytest
from grooved_faces import FACES_TOML, R_I, R_O, RINGS_TOML
from grooved_faces import SPIRAL as SPIRAL_PATTERN
from scenes import run
from scipy.optimize import brentq

from sealdyn import read_scenario, run_study
from sealdyn.dynamics.imposed_motion import rest_state
from sealdyn.dynamics.interface import Interface, flow_at_rest, opening_parts
from sealdyn.faces import contact
from sealdyn.faces.geometry import (
    CONTACT_AREA,
    CONTACT_ENERGY,
    CONTACT_FORCE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    SPIN_DIFFERENCE,
    face_parameters,
)
from sealdyn.faces.roughness import contact_fraction
from sealdyn.films import film_of
from sealdyn.films._grooved.aligned import axial_stiffness, pattern_of
from sealdyn.films._grooved.balance import Conditions, steady
from sealdyn.films._grooved.mesh import mesh_of
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import GasReynolds
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Grooves, grooves_errors
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Closing, Scene, SceneError, frozen_at_start
from sealdyn.studies._grooved_roots import RootsOverSpeed

START = f"""
[shaft]
speed = "1 rad/s"
[film]
{FACES_TOML}
outer_pressure = "1 bar"
gas_reynolds = {{ slip = true, columns = 4 }}
[contact]
roughness = "0.1 um"
compressive_strength = "300 MPa"
friction_coefficient = 0.15
[closing]
balance_ratio = 0.8
spring_force = "100 N"
{RINGS_TOML}
[run]
turns = 1
"""
ROUGH, STRENGTH = 1e-7, 3e8
C = 3.0 * ROUGH
FACES = Contact(ROUGH, compressive_strength=STRENGTH, friction_coefficient=0.15)
GAS = Film(R_I, R_O, 1e5, 1e5, viscosity=1.8e-5, gas="air", temperature=300.0)
SPIRAL = Grooves(12, 6e-6, 0.0555, R_O, 0.5, angle=math.radians(15.0))
TEE = Grooves(12, 6e-6, 0.053, 0.055, 0.7, "tee", stem_outer_radius=0.0616, stem_share=0.25)
BOTH_SIDES = Grooves(12, 6e-6, R_I, 0.0555, 0.3, angle=math.radians(-40.0))


def seal(grooves=SPIRAL, table=GAS, faces=FACES, face="rotor"):
    parts = {
        "rotor": Rotor(),
        "stator": Stator(mass=0.2, transverse_inertia=3.5e-4, support=Support(axial_stiffness=1.64e4)),
    }
    parts[face] = type(parts[face])(**{**vars(parts[face]), "grooves": [grooves]})
    return Scene(shaft=Shaft(speed=100.0), film=table, contact=faces, **parts)


def touching(scene, clearance, tilt=0.0, dz=0.0, law=None):
    """The gap state with the contact of a scene at a tilt (complex, rad)."""
    f, s = face_parameters(scene.film, clearance), np.zeros(GAP_STATE_SIZE)
    s[DZ], s[GX], s[GY], s[SPIN_DIFFERENCE] = dz, complex(tilt).real, complex(tilt).imag, 100.0
    contact.contact_load_and_friction(contact.lay_surfaces(f, scene), f, s)
    return s


def over_the_pattern(grooves, clearance, tilt, turned, coning=0.0, radii=300, angles=2880):
    """Load (N), moment (complex, N m) and its integral with the radius (N m) by midpoints over the lands of a pattern
    that has turned by an angle (rad)."""
    pattern = pattern_of(grooves)
    r = R_I + (R_O - R_I) * (np.arange(radii)[:, None] + 0.5) / radii
    theta = 2.0 * math.pi * (np.arange(angles) + 0.5) / angles
    h = clearance + coning * (r - R_I) + r * (tilt.real * np.sin(theta) - tilt.imag * np.cos(theta))
    land = pattern.depth_at(r, theta - turned) == 0.0
    part = STRENGTH * contact_fraction(h / C) * land * r * (R_O - R_I) / radii * 2.0 * math.pi / angles
    return part.sum(), (-1j * part * r * np.exp(1j * theta)).sum(), (part * r).sum()


@pytest.mark.core
@pytest.mark.parametrize("grooves", [SPIRAL, TEE, BOTH_SIDES])
@pytest.mark.parametrize("coning", [0.0, 4e-5])
def test_lands_carry_what_a_fine_quadrature_of_the_pattern_does(grooves, coning):
    """At tilts whose contact pressure has no harmonic as short as a pitch, wherever the pattern stands."""
    table = Film(**{**vars(GAS), "coning": coning})
    for tilt in (0.0j, -2e-6 + 5e-7j):
        s = touching(seal(grooves, table), 0.45 * C, tilt)
        for turned in (0.0, 0.11):
            load, moment, arm = over_the_pattern(grooves, 0.45 * C, tilt, turned, coning)
            assert s[CONTACT_FORCE] == pytest.approx(load, rel=2e-3)
            assert complex(s[CONTACT_X], s[CONTACT_Y]) == pytest.approx(
                moment, abs=2e-3 * abs(moment) + 1e-5 * load * R_O
            )
            assert s[CONTACT_TORQUE] == pytest.approx(0.15 * arm, rel=2e-3)


def test_a_narrow_arc_is_the_mean_over_all_places_of_the_pattern():
    tilt, low = 5e-5j, 0.2 * C
    s = touching(seal(), low + R_O * abs(tilt), tilt)
    at = [over_the_pattern(SPIRAL, low + R_O * abs(tilt), tilt, k * math.pi / 6.0 / 16) for k in range(16)]
    loads, moments = (np.array([one[n] for one in at]) for n in (0, 1))
    assert s[CONTACT_FORCE] == pytest.approx(loads.mean(), rel=5e-3)
    assert complex(s[CONTACT_X], s[CONTACT_Y]) == pytest.approx(moments.mean(), abs=5e-3 * abs(moments.mean()))
    # What is lost of it, as the module says.
    assert 0.1 < np.abs(loads / loads.mean() - 1.0).max() < 0.6


@pytest.mark.parametrize("law", [FACES, Contact(ROUGH, law="greenwood-williamson", asperity_density=1e11,
                                               asperity_radius=5e-6, modulus=3e10)])  # fmt: skip
def test_force_and_moment_are_derivatives_of_the_stored_energy(law):
    scene, tilt, step = seal(faces=law), 4e-6 - 3e-6j, 1e-12

    def energy(dz, g):
        return touching(scene, 0.6 * C, g, dz)[CONTACT_ENERGY]

    s = touching(scene, 0.6 * C, tilt)
    assert s[CONTACT_FORCE] == pytest.approx((energy(-step, tilt) - energy(step, tilt)) / (2.0 * step), rel=1e-4)
    turn = step / R_O
    for slot, way in ((CONTACT_X, 1.0), (CONTACT_Y, 1j)):
        slope = (energy(0.0, tilt - turn * way) - energy(0.0, tilt + turn * way)) / (2.0 * turn)
        assert s[slot] == pytest.approx(slope, rel=1e-4, abs=1e-4 * s[CONTACT_FORCE] * R_O)


def test_pressed_flat_the_lands_share_of_the_face_touches():
    """Half of the pitch over the grooves, all of it on the dam."""
    s, outer = touching(seal(), -C), R_O**2 - 0.0555**2
    share = 1.0 - 0.5 * outer / (R_O**2 - R_I**2)
    assert s[CONTACT_AREA] == pytest.approx(share, rel=1e-9)
    assert s[CONTACT_FORCE] == pytest.approx(STRENGTH * math.pi * (R_O**2 - R_I**2) * share, rel=1e-9)


@pytest.mark.parametrize("depth", [0.0, 5e-7, 5.9e-7])
def test_grooves_into_which_asperities_reach_are_refused(depth):
    grooves = Grooves(**{**vars(SPIRAL), "depth": depth})
    assert [error[0] for error in grooves_errors(seal(grooves))] == ["rotor.grooves.0.depth"]
    assert not grooves_errors(seal())


# --- at rest, held at a speed, and in time ----------------------------------------------------------------

SLIPS = GasReynolds(slip=True, columns=4)
PRESSED = Closing(balance_ratio=0.8, spring_force=100.0)


def pressed(speed=0.0, tilt=0.0, mass=0.0, columns=4):
    """A stator that a spring presses at ambient pressure on the grooves of the rotor, both tilted alike."""
    table = replace(GAS, gas_reynolds=replace(SLIPS, columns=columns))
    support = Support(axial_stiffness=1.64e4, axial_damping=1e3, tilt_stiffness=31.0, tilt_damping=1.4)
    ring = Stator(mass=mass, transverse_inertia=3.5e-4 * (mass > 0.0), support=support)
    return replace(
        seal(table=table), shaft=Shaft(speed=speed), closing=PRESSED, stator=replace(ring, misalignment=tilt)
    )


def lifts_at(scene) -> float:
    """Speed (rad/s) at which the film alone carries the closing force where the lands just part, on a run's mesh."""
    closing = 100.0 + 1e5 * math.pi * (R_O**2 - R_I**2)

    def excess(speed):
        one = replace(scene, shaft=Shaft(speed=speed))
        film, rough = opening_parts(one, film_of(one))(C, 1e5, 1e5)
        assert rough == 0.0
        return film - closing

    return brentq(excess, 15.0, 40.0, xtol=1e-4)


@pytest.mark.core
def test_a_seal_at_rest_stands_on_its_lands():
    interface = Interface(pressed(), 1e-8)
    s, _ = rest_state(interface.scene, interface.clearance)
    flow_at_rest(interface, s)
    # Gas at rest carries the ambient pressure alone.
    assert s[FORCE] == pytest.approx(1e5 * math.pi * (R_O**2 - R_I**2), rel=1e-7)
    assert s[CONTACT_FORCE] == pytest.approx(100.0, rel=1e-6) and 0.8 * C < interface.clearance < C
    (rest,) = interface.equilibria
    around = [touching(interface.scene, interface.clearance + z)[CONTACT_FORCE] for z in (-1e-11, 1e-11)]
    assert rest.stable and rest.stiffness == pytest.approx((around[0] - around[1]) / 2e-11, rel=1e-3)


def test_the_film_of_both_meshes_keeps_the_floor_of_rough_faces():
    """That of a run, and that of the studies, where the lands touch and the gap is conical."""
    scene = replace(pressed(20.0), film=replace(pressed().film, coning=2e-5, gas_reynolds=replace(SLIPS, columns=8)))
    for clearance in (2e-8, 1.2e-7, 2.5e-7):
        coarse = opening_parts(scene, film_of(scene))(clearance, 1e5, 1e5)
        finer = opening_parts(scene)(clearance, 1e5, 1e5)
        assert coarse[1] == pytest.approx(finer[1], rel=1e-12) and coarse[1] > 0.0
        ambient = 1e5 * math.pi * (R_O**2 - R_I**2)
        assert coarse[0] - ambient == pytest.approx(finer[0] - ambient, rel=0.05)


def test_small_motion_between_rough_faces_is_the_slope_of_the_force():
    """Below the floor the film follows the gap less, and its stiffness with it."""
    mesh = mesh_of(SPIRAL_PATTERN, R_I, R_O, 4)
    film = Conditions(1.2e-7, 1.8e-5, 1e5, 1e5, 20.0, slip=300.0, floor=0.6 * C, coning=1e-5)
    either = [steady(mesh, replace(film, clearance=film.clearance + z)).force for z in (-1e-11, 1e-11)]
    assert axial_stiffness(steady(mesh, film)) == pytest.approx((either[0] - either[1]) / 2e-11, rel=1e-5)


def test_a_start_and_a_stop_in_time():
    """From one held speed to another and back, the lands lift and come down; a ramp so slow passes through states that
    are nearly held, the lift a little late."""
    lift = lifts_at(pressed())
    ramp = PiecewiseLinear((0.0, 0.35, 0.4, 0.75), (0.9 * lift, 1.2 * lift, 1.2 * lift, 0.9 * lift))
    done = run(pressed(ramp), duration=0.75, accuracy=1e-3, method="ida", per_turn=128)
    assert done.outcome.status == "ok" and done.outcome.energy_residual < 1e-6
    gap = done.model.clearance + done.q[:, 0]
    speed = np.interp(done.times, ramp.time, ramp.value)
    off = np.flatnonzero(gap > C)
    assert 0.0 < speed[off[0]] / lift - 1.0 < 0.06
    assert -0.08 < speed[off[-1]] / lift - 1.0 < 0.01
    assert gap.max() > 1.2 * C and gap[0] == pytest.approx(gap[-1], rel=0.02)


def test_the_impulse_of_contact_is_that_of_its_force():
    """Audited as another integral: of the samples of a start from rest with a ring that has mass."""
    speed = PiecewiseLinear((0.0, 0.002, 0.012), (0.0, 0.0, 400.0))
    done = run(pressed(speed, mass=0.2), duration=0.012, accuracy=1e-4, method="ida", per_turn=4000)
    assert done.outcome.status == "ok" and done.outcome.energy_residual < 1e-6
    found = [touching(done.model.scene, done.model.clearance, dz=z)[CONTACT_FORCE] for z in done.q[:, 0]]
    impulse = np.trapezoid(found, done.times)
    kept = done.ready.contacts.so_far((0.012, done.outcome.y)).impulse
    assert found[0] == pytest.approx(100.0, rel=1e-6) and min(found) < 90.0
    assert kept == pytest.approx(impulse, rel=1e-4)


def test_one_pitch_stands_for_all_where_nothing_tilts():
    """The same start with a tilt of nothing, for which the whole circle is computed."""
    speed, ends = PiecewiseLinear((0.0, 0.01), (20.0, 120.0)), []
    for tilt in (0.0, 1e-12):
        done = run(pressed(speed, tilt), duration=0.01, accuracy=1e-4, method="ida", per_turn=64)
        ends.append((len(done.model.unknowns.film_unknowns.names), done.q[-1, 0]))
    assert 12 * ends[0][0] == ends[1][0]
    assert ends[0][1] == pytest.approx(ends[1][1], rel=1e-4) and ends[0][1] > 1e-8


def test_held_speeds_show_where_it_lifts(tmp_path):
    """The Stribeck curve: by asperities nearly alone, mixed, by the film alone."""
    path = tmp_path / "start.toml"
    path.write_text(START)
    scenario = read_scenario(path)
    flags = {"speed_from": "1 rad/s", "speed_to": "60 rad/s", "points": 3}
    answer = run_study("stribeck", scenario, tmp_path / "answer.h5", flags=flags)
    share, torque = answer["load_share"], answer["torque"]
    assert share[0] < 0.1 < share[1] < 0.9 and share[2] == 1.0
    assert 0.1 * torque[0] > torque[2] > 0.0
    assert torque[0] == pytest.approx(0.15 * 100.0 * 0.057, rel=0.06)


def test_small_motion_of_lands_that_touch_is_refused(tmp_path):
    path = tmp_path / "start.toml"
    path.write_text(START)
    with pytest.raises(SceneError) as refused:
        run_study("coefficients", read_scenario(path), tmp_path / "answer.h5")
    assert refused.value.key == "contact"
    # Nor are the roots of the ring those of the film alone, at the speeds at which it touches.
    roots = RootsOverSpeed(frozen_at_start(read_scenario(path).scene))
    with pytest.raises(SceneError) as refused:
        roots(1.0)
    assert refused.value.key == "contact"
