"""Contact of a tilted seal: the error of the load against the points around the circle.

The reference seal touching at its inner edge: the patch is 4 to 14 degrees wide, and any fixed division of the circle
either misses it or pays for thousands of angles (256 equal ones err by 9e-7 to 9e-5, a panel of 12 points by 1e-13).
"""

import numpy as np
import pytest

from sealdyn.faces import contact, geometry
from sealdyn.scene.film import Film
from sealdyn.scene.forces import Contact

R_I, R_O, C0, CONING, ROUGHNESS = 0.032, 0.040, 10e-6, 3.125e-3, 0.1e-6
C = 3 * ROUGHNESS
LAW = Contact(ROUGHNESS, compressive_strength=300e6)
GAUSSIAN = Contact(ROUGHNESS, law="greenwood-williamson", asperity_density=1e11, asperity_radius=5e-6, modulus=30e9)


def answers(law, points, coning, dz, tilt, r_i=R_I):
    """Force, moment times 1/r_o, and energy per half height."""
    f = geometry.face_parameters(Film(r_i, R_O, 5e-4, 6e5, 1e5, clearance=C0, coning=coning), C0)
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[geometry.DZ], s[geometry.GX] = dz, tilt
    contact.contact_load_and_friction(contact.lay_asperities(law, f, points), f, s)
    return np.array([s[geometry.CONTACT_FORCE], s[geometry.CONTACT_X] / R_O, s[geometry.CONTACT_ENERGY] / C])


STATES = {
    # name: coning, thinnest film / c, tilt, inner radius
    "patch of the reference seal": (CONING, 0.0, C0 / R_I, R_I),
    "grazing": (CONING, 0.98, C0 / R_I, R_I),
    "flattened in the middle": (CONING, -1.8, C0 / R_I, R_I),
    "flat face, half the circle": (0.0, -0.5, C / R_O, R_I),
    "flat face, all of it": (0.0, -0.9, 0.4 * C / R_O, R_I),
    "touching at the outer edge": (-0.5e-3, 0.0, C0 / R_O, R_I),
    "both edges at once": (CONING / 1000, 0.2, 1.01 * CONING / 1000, R_I),
    "a wide face": (0.0, -0.3, 2 * C / R_O, 0.1 * R_O),
}


def state(name):
    coning, thinnest, tilt, r_i = STATES[name]
    low = min(C0 - r_i * tilt, C0 + coning * (R_O - r_i) - R_O * tilt)
    return coning, thinnest * C - low, tilt, r_i


def errors(law, name, counts):
    exact = answers(law, 80, *state(name))
    return np.array([np.max(np.abs(answers(law, n, *state(name)) - exact)) for n in counts]) / exact[0]


@pytest.mark.parametrize("name", STATES)
@pytest.mark.parametrize("law", [LAW, GAUSSIAN], ids=["christensen", "gaussian"])
def test_panels_converge_exponentially(law, name):
    """Each four points more gain two digits at least (Christensen; three are usual), until rounding is reached.

    Measured, worst state: Christensen 2e-3, 3e-7, 5e-11, 1e-14 with 4, 8, 12, 16 points of a panel;
    Gaussian heights 3e-2, 9e-5, 8e-7, 2e-9, 6e-12 with 4, 8, 12, 16, 20.
    """
    found = errors(law, name, np.array([4, 8, 12, 16, 20]))
    gain = 100 if law is LAW else 20
    assert found[0] < 0.1
    assert np.all(found[1:] < np.maximum(found[:-1] / gain, 1e-11)), found
    assert found[-1] < 1e-11


@pytest.mark.core
@pytest.mark.parametrize("law", [LAW, GAUSSIAN], ids=["christensen", "gaussian"])
def test_the_points_given_are_enough(law):
    draw = np.random.default_rng(3)
    for _ in range(150):
        coning = draw.choice([CONING, 0.0, -0.5e-3, 1e-5])
        tilt = 10 ** draw.uniform(-7, -2)
        low = min(C0 - R_I * tilt, C0 + coning * (R_O - R_I) - R_O * tilt)
        at = coning, draw.uniform(-3, 0.99) * C - low, tilt
        exact, found = answers(law, 80, *at), answers(law, None, *at)
        assert np.max(np.abs(found - exact)) < 1e-9 * exact[0], at
