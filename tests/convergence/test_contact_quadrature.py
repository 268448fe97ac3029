"""Contact of a tilted seal: the error of the load against the points around the circle.

The reference seal touching at its inner edge: the patch is a few degrees wide (table below), and any fixed
division of the circle either misses it or pays for thousands of angles.
"""

import math

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


def line(h_i, slope):
    """int p r dr over one radius by a Gauss rule on the touching part; the circle's rule is what is compared."""
    end = np.clip((C - h_i) / slope, 0.0, R_O - R_I)
    node, weight = np.polynomial.legendre.leggauss(24)
    r = 0.5 * end[:, None] * (1 + node)
    x = (h_i[:, None] + slope[:, None] * r) / C
    p = 300e6 * (0.5 - 35 / 32 * (x - x**3 + 3 * x**5 / 5 - x**7 / 7))
    return np.sum(0.5 * end[:, None] * weight * p * (R_I + r), axis=1)


def trapezoid(angles, offset, thinnest, tilt):
    """Load of the reference seal by `angles` equal steps, the first `offset` of a step from the thinnest place."""
    beta = 2 * np.pi * (np.arange(angles) + offset) / angles
    h_i = thinnest + R_I * tilt * (1 - np.cos(beta))
    touching = h_i < C
    if not touching.any():
        return 0.0
    return 2 * np.pi / angles * np.sum(line(h_i[touching], CONING - tilt * np.cos(beta[touching])))


# Half width of the patch and worst relative error of the load over the angle of the grid, as measured:
#   h_min / c   half width   panel of 12    64 angles   256      1024     4096
#   0.0         14.1 deg     3e-15          4e-4        9e-7     2e-10    5e-14
#   0.5          9.9 deg     2e-15          1e-2        3e-6     2e-10    3e-13
#   0.9          4.4 deg     1e-13          0.73        9e-5     5e-8     2e-11
@pytest.mark.parametrize("thinnest, least", [(0.0, (1e-4, 3e-7, 1e-10)), (0.9, (0.3, 3e-5, 1e-8))])
def test_a_fixed_division_of_the_circle_is_worse(thinnest, least):
    """The panel against the trapezoid, which has to be thousands of angles for the same digits, and moves with the
    patch: with 64 angles a grazing patch is missed or trebled as the tilt turns."""
    tilt = C0 / R_I
    half_width = math.degrees(math.acos(1 - C * (1 - thinnest) / (R_I * tilt)))
    assert 4 < half_width < 15
    exact = answers(LAW, 80, CONING, thinnest * C, tilt)[0]
    panel = abs(answers(LAW, None, CONING, thinnest * C, tilt)[0] / exact - 1)
    assert panel < 1e-11
    offsets = np.linspace(0, 0.5, 9)
    for angles, error in zip((64, 256, 1024), least, strict=True):
        worst = max(abs(trapezoid(angles, o, thinnest * C, tilt) / exact - 1) for o in offsets)
        assert worst > error > 100 * panel, (angles, worst, panel)
    # The same integral after all.
    assert trapezoid(2**15, 0.3, thinnest * C, tilt) == pytest.approx(exact, rel=1e-11)
