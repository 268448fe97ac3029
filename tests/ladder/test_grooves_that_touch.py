"""Lands of grooved faces on their asperities: load, moment and friction against a fine quadrature over the pattern."""

import math

import numpy as np
import pytest
from grooved_faces import R_I, R_O

from sealdyn.faces import contact
from sealdyn.faces.geometry import (
    CONTACT_AREA,
    CONTACT_ENERGY,
    CONTACT_FORCE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    GAP_STATE_SIZE,
    GX,
    GY,
    SPIN_DIFFERENCE,
    face_parameters,
)
from sealdyn.faces.roughness import contact_fraction
from sealdyn.films._grooved.aligned import pattern_of
from sealdyn.scene.contact import Contact
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.patterns import Grooves, grooves_errors
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene

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


def over_the_pattern(grooves, clearance, tilt, turned, coning=0.0, radii=600, angles=7200):
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
    for tilt in (0.0j, 1e-6 + 5e-7j, -2e-6j):
        s = touching(seal(grooves, table), 0.45 * C, tilt)
        for turned in (0.0, 0.11, 0.3):
            load, moment, arm = over_the_pattern(grooves, 0.45 * C, tilt, turned, coning)
            assert s[CONTACT_FORCE] == pytest.approx(load, rel=2e-3)
            assert complex(s[CONTACT_X], s[CONTACT_Y]) == pytest.approx(
                moment, abs=2e-3 * abs(moment) + 1e-5 * load * R_O
            )
            assert s[CONTACT_TORQUE] == pytest.approx(0.15 * arm, rel=2e-3)


def test_a_narrow_arc_is_the_mean_over_all_places_of_the_pattern():
    tilt, low = 5e-5j, 0.2 * C
    s = touching(seal(), low + R_O * abs(tilt), tilt)
    at = [over_the_pattern(SPIRAL, low + R_O * abs(tilt), tilt, k * math.pi / 6.0 / 16, angles=3600) for k in range(16)]
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
