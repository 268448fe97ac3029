"""Asperity contact against Christensen's law, written out here and summed over a dense grid of the face."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import christensen
from scipy.integrate import quad
from scipy.special import pbdv

from sealdyn.faces import contact, geometry, roughness
from sealdyn.scene.film import Film
from sealdyn.scene.forces import Contact, contact_errors, contact_thresholds, finish

R_I, R_O, C0, CONING, ROUGHNESS, STRENGTH, SPEED = 0.032, 0.040, 10e-6, 3.125e-3, 0.1e-6, 300e6, 1000.0
C = 3 * ROUGHNESS
WEARS = {"stator_wear_coefficient": 2e-16, "rotor_wear_coefficient": 3e-16}
CHRISTENSEN = Contact(ROUGHNESS, compressive_strength=STRENGTH, **WEARS)
NUMBER, TIP, MODULUS = 1e11, 5e-6, 30e9
GAUSSIAN = Contact(ROUGHNESS, law="greenwood-williamson", asperity_density=NUMBER, asperity_radius=TIP, modulus=MODULUS)
WORN, PEAK = 1.5, 2e-8
PLATEAUS = Contact(
    ROUGHNESS, law="plateaus", truncation=WORN, plateau_roughness=PEAK, compressive_strength=STRENGTH, **WEARS
)  # fmt: skip
LAWS = pytest.mark.parametrize("law", [CHRISTENSEN, GAUSSIAN, PLATEAUS], ids=["christensen", "gaussian", "plateaus"])
NAMES = "force", "x", "y", "torque", "area", "pressure", "energy"
SLOTS = {name: getattr(geometry, f"CONTACT_{name.upper()}") for name in NAMES}
SLOTS["wear"] = geometry.WEAR


def face(coning=CONING, tilt_radius="local", shape="cylindrical", r_i=R_I):
    film = Film(r_i, R_O, 5e-4, 6e5, 1e5, clearance=C0, coning=coning, tilt_radius=tilt_radius, geometry=shape)
    return geometry.face_parameters(film, C0)


def rub(law, f, dz, g_x, g_y, spin=SPEED):
    s = np.full(geometry.GAP_STATE_SIZE, np.nan)
    s[[geometry.CONING_CHANGE, geometry.CONING_RATE]] = 0.0
    s[: geometry.GY + 1], s[geometry.SPIN_DIFFERENCE] = (dz, g_x, g_y), spin
    contact.contact_load_and_friction(contact.lay_asperities(law, f), f, s)
    return {name: s[slot] for name, slot in SLOTS.items()}


def pressed(h):
    """Contact fraction, pressure (Pa) and energy per area (J/m^2)."""
    share, energy = christensen(h, C, STRENGTH)
    return share, STRENGTH * share, energy


def overlap(n, d):
    """F_n(d) by parabolic cylinder functions."""
    return np.exp(-(d**2) / 4) / np.sqrt(2 * np.pi) * float(mpmath.gamma(n + 1)) * pbdv(-n - 1, d)[0]


def gaussian(h):
    d = h / ROUGHNESS
    stiff = 4 / 3 * NUMBER * MODULUS * np.sqrt(TIP) * ROUGHNESS**1.5
    area = np.pi * NUMBER * TIP * ROUGHNESS * overlap(1.0, d)
    return area, stiff * overlap(1.5, d), stiff * ROUGHNESS * overlap(2.5, d) / 2.5


def summed(pointwise, coning, dz, g_x, g_y, mean=False, angles=2048, radii=241):
    """Every answer of `rub` by the trapezoid around the circle and along a radius crowded at both edges."""
    theta, y = 2 * np.pi * np.arange(angles)[:, None] / angles, np.linspace(0, 1, radii)
    r = R_I + (R_O - R_I) * y**3 * (10 - 15 * y + 6 * y**2)
    da = (R_O - R_I) * 30 * y**2 * (1 - y) ** 2 / (radii - 1) * 2 * np.pi / angles * r
    arm = 0.5 * (R_I + R_O) if mean else r
    h = C0 + dz + coning * (r - R_I) + arm * (g_x * np.sin(theta) - g_y * np.cos(theta))
    return sums(pointwise, theta, r, da, arm, h, (dz, g_x, g_y))


def sums(pointwise, theta, r, da, arm, h, state):
    """Every answer of `rub` of points of a face, of area `da` (m^2) each, with the film `h` (m)."""
    slope = arm * (state[1] * np.cos(theta) + state[2] * np.sin(theta))
    area, p, energy = pointwise(h)
    return {
        "force": np.sum(p * da),
        "x": np.sum(p * arm * np.sin(theta) * da),
        "y": -np.sum(p * arm * np.cos(theta) * da),
        "torque": 0.1 * np.sum(p * r * da) - 0.5 * np.sum(p * slope * da),
        "area": np.sum(area * da) / np.sum(da * np.ones_like(theta)),
        "pressure": p.max(),
        "energy": np.sum(energy * da),
        "wear": 5e-16 * SPEED * np.sum(p * r * da) / np.sum(da * np.ones_like(theta)),
    }


def random_states(seed, number, coning, deepest=-2.0):
    """Tilts from tiny to large in any direction, thinnest film from `deepest` c to c."""
    draw = np.random.default_rng(seed)
    for _ in range(number):
        tilt, angle = 10 ** draw.uniform(-6.5, -3.3), draw.uniform(0, 2 * np.pi)
        low = min(C0 - R_I * tilt, C0 + coning * (R_O - R_I) - R_O * tilt)
        yield C * draw.uniform(deepest, 0.9) - low, tilt * np.cos(angle), tilt * np.sin(angle)


@pytest.mark.parametrize("coning", [CONING, 0.0, -0.5e-3, 2e-5])
def test_christensen_is_the_sum_over_the_face(coning):
    for mean in (False, True):
        f = face(coning, "mean" if mean else "local")
        for state in random_states(7, 6, coning):
            found, exact = rub(CHRISTENSEN, f, *state), summed(pressed, coning, *state, mean=mean)
            for name, value in exact.items():
                size = R_O * exact["force"] if name in "xy" else value
                # The grid's own error; its points miss the most pressed one by half a step.
                allowed = 1e-4 if name == "pressure" else 2e-5
                assert abs(found[name] - value) <= allowed * size, (name, state)


def worn(h):
    """Share, pressure and energy of faces worn to plateaus: both Gaussian heights of rms 1/sqrt(2) are beyond the cut
    at once, and there Christensen's heights of the plateaus meet."""
    flat = quad(lambda z: np.exp(-z * z / 2) / np.sqrt(2 * np.pi), WORN, 12)[0] ** 2
    share, energy = christensen(h - 2 * WORN * ROUGHNESS / np.sqrt(2), 3 * PEAK, STRENGTH)
    return flat * share, flat * STRENGTH * share, flat * energy


@pytest.mark.core
def test_worn_faces_touch_as_their_heights_say():
    """Share, pressure and energy by quadrature of both distributions, from first touch to far below the plateaus."""
    flat = quad(lambda z: np.exp(-z * z / 2) / np.sqrt(2 * np.pi), WORN, 12)[0] ** 2

    def share(h):
        low = (h - 2 * WORN * ROUGHNESS / np.sqrt(2)) / (3 * PEAK)
        low = min(max(low, -1), 1)
        return flat * quad(lambda d: 35 / 32 * (1 - d * d) ** 3, low, 1)[0]

    top = contact_thresholds(PLATEAUS)[1]
    area = np.pi * (R_O**2 - R_I**2)
    for h in (0.27e-6, 0.24e-6, 0.22e-6, 0.19e-6, 0.16e-6, 0.15e-6, 0.05e-6):
        found = rub(PLATEAUS, face(0.0), h - C0, 0.0, 0.0)
        edges = [e for e in (2 * WORN * ROUGHNESS / np.sqrt(2) - 3 * PEAK,) if h < e]
        energy = STRENGTH * quad(share, h, top, points=edges, epsabs=0)[0]
        assert found["area"] == pytest.approx(share(h), rel=1e-9, abs=1e-15)
        assert found["pressure"] == pytest.approx(STRENGTH * share(h), rel=1e-9, abs=1e-6)
        assert found["force"] == pytest.approx(STRENGTH * share(h) * area, rel=1e-9, abs=1e-9)
        assert found["energy"] == pytest.approx(energy * area, rel=1e-7, abs=1e-16)


@pytest.mark.parametrize("coning", [CONING, -0.5e-3])
def test_worn_faces_are_the_sum_over_the_face(coning):
    for state in random_states(7, 6, coning, deepest=0.2):
        found, exact = rub(PLATEAUS, face(coning), *state), summed(worn, coning, *state, angles=4096, radii=961)
        for name, value in exact.items():
            size = R_O * exact["force"] if name in "xy" else value
            assert abs(found[name] - value) <= 1e-4 * size, (name, state)


@pytest.mark.parametrize("coning", [CONING, 0.0, -0.5e-3])
def test_gaussian_is_the_sum_over_the_face(coning):
    """Within the fit: 1e-3 of Greenwood & Williamson's integrals, as long as h > -3 rms; wear was not asked for."""
    for state in random_states(8, 6, coning, -1.0):
        found, exact = rub(GAUSSIAN, face(coning), *state), summed(gaussian, coning, *state, angles=360, radii=101)
        assert found["wear"] == 0.0
        for name in ("force", "x", "y", "torque", "area", "energy"):
            size = R_O * exact["force"] if name in "xy" else exact[name]
            assert abs(found[name] - exact[name]) < 1e-3 * size, (name, state)


@LAWS
def test_forces_are_minus_the_derivatives_of_the_energy(law):
    for tilt_radius in ("local", "mean"):
        f = face(tilt_radius=tilt_radius)
        for state in random_states(9, 15, CONING):
            found = rub(law, f, *state)
            length = 3e-3 * finish(law)
            for n, (name, step) in enumerate((("force", length), ("x", length / R_O), ("y", length / R_O))):
                at = [rub(law, f, *(np.array(state) + m * step * np.eye(3)[n]))["energy"] for m in (-2, -1, 1, 2)]
                slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * step)
                size = found["force"] * (1 if n == 0 else R_O)
                # The difference formula's own error is 1e-8 in shallow patches.
                assert abs(found[name] + slope) < 1e-7 * size, (tilt_radius, name, state)


@LAWS
def test_a_closed_loop_does_no_work(law):
    """Round a loop in (dz, g_x, g_y) that touches and lifts off, passing flattened asperities."""
    f, n = face(), 2048
    t = 2 * np.pi * np.arange(n) / n
    tilt = C0 / R_I
    path = np.stack([-C * np.sin(t), tilt * (1 + 0.1 * np.cos(t)), 0.4 * tilt * np.sin(t + 1)])
    rate = np.stack([-C * np.cos(t), -0.1 * tilt * np.sin(t), 0.4 * tilt * np.cos(t + 1)])
    power = []
    for at, speed in zip(path.T, rate.T, strict=True):
        found = rub(law, f, *at)
        power.append(found["force"] * speed[0] + found["x"] * speed[1] + found["y"] * speed[2])
    # Measured 3e-12.
    assert np.abs(power).max() > 0 and min(power) < 0 < max(power)
    assert abs(np.sum(power)) < 1e-9 * np.sum(np.abs(power))


@LAWS
@given(st.floats(0, 6.3), st.floats(-2, 0.9), st.floats(-7, -3))
@settings(max_examples=60, deadline=None)
def test_turning_the_tilt_turns_the_moment(law, angle, depth, log_tilt):
    f, tilt = face(), 10**log_tilt
    dz = depth * C - min(C0 - R_I * tilt, C0 + CONING * (R_O - R_I) - R_O * tilt)
    one, other = rub(law, f, dz, tilt, 0.0), rub(law, f, dz, tilt * np.cos(angle), tilt * np.sin(angle))
    size = one["force"] * R_O + 1e-30
    assert abs(complex(other["x"], other["y"]) - complex(one["x"], one["y"]) * np.exp(1j * angle)) < 1e-12 * size
    assert other["force"] == pytest.approx(one["force"], rel=1e-11, abs=1e-30)


@LAWS
@pytest.mark.parametrize(
    "coning, tilt, order", [(CONING, C0 / R_I, 5.5), (0.0, 0.0, 4.0), (-0.2e-3, C0 / R_O / 2, 5.5)]
)
def test_first_touch_is_smooth(law, coning, tilt, order):
    """Zero above touch, then depth to the 4th power (flat) or 5.5th (a corner): three derivatives vanish."""
    touch = contact_thresholds(law)[1]
    f = face(coning)
    low = min(C0 - R_I * tilt, C0 + coning * (R_O - R_I) - R_O * tilt)
    above = rub(law, f, touch - low + 1e-18, tilt, 0.0)
    assert all(value == 0.0 for value in above.values())
    depths = np.array([2.5e-4, 5e-4, 1e-3]) * C
    forces = np.array([rub(law, f, touch - low - depth, tilt, 0.0)["force"] for depth in depths])
    assert np.all(forces > 0)
    assert np.diff(np.log(forces)) / np.log(2) == pytest.approx([order, order], abs=0.05)


@LAWS
def test_never_negative_and_finite_everywhere(law):
    """Closing monotonically, also for trial states far through the other face and with absurd tilts."""
    last = 0.0
    for dz in np.concatenate([np.linspace(0, -C0 - 1.2 * C, 400), [-1e-3, -1.0]]):
        found = rub(law, face(0.0), dz, 0.0, 0.0)
        assert all(np.isfinite(v) and v >= 0 for v in found.values())
        assert found["force"] >= last
        last = found["force"]
    for state in ((-1.0, 10.0, -3.0), (0.0, 1.0, 0.0), (-1e-5, 1e-300, 0.0), (5.0, 100.0, 100.0)):
        found = rub(law, face(), *state)
        assert all(np.isfinite(v) for v in found.values()) and found["force"] > 0


def test_flattened_face_carries_its_strength():
    area = np.pi * (R_O**2 - R_I**2)
    found = rub(CHRISTENSEN, face(0.0), -C0 - 2 * C, 0.0, 0.0)
    assert found["force"] == pytest.approx(STRENGTH * area, rel=1e-13) and found["area"] == pytest.approx(1, rel=1e-13)
    assert found["energy"] == pytest.approx(STRENGTH * 2 * C * area, rel=1e-13)
    assert found["pressure"] == STRENGTH and found["x"] == found["y"] == 0.0


def test_friction_takes_the_sign_of_the_spin_and_either_law():
    state = (0.0, C0 / R_I, 0.0)
    forth, back, still = (rub(CHRISTENSEN, face(), *state, spin=w) for w in (SPEED, -SPEED, 0.0))
    assert forth["torque"] == -back["torque"] > 0 and still["torque"] == still["wear"] == 0
    assert forth["wear"] == back["wear"] > 0
    sheared = Contact(ROUGHNESS, compressive_strength=STRENGTH, shear_strength=0.3 * STRENGTH)
    assert rub(sheared, face(), *state)["torque"] == pytest.approx(3 * forth["torque"], rel=1e-13)


def test_planar_film_has_the_same_contact():
    state = (0.0, C0 / R_I, 1e-5)
    assert rub(CHRISTENSEN, face(), *state) == rub(CHRISTENSEN, face(shape="planar"), *state)


@pytest.mark.core
def test_closed_forms_against_the_density():
    """Share in contact and E(H^3) by quadrature of Christensen's density."""
    for x in (-1.3, -1.0, -0.99, -0.5, 0.0, 0.3, 0.81, 0.999, 1.0, 1.7):
        low, high = min(max(-x, -1), 1), 1

        def mean(power, low=low, high=high, x=x):
            density = lambda d: 35 / mpmath.mpf(32) * (1 - d * d) ** 3  # noqa: E731
            return float(mpmath.quad(lambda d: max(x + d, 0) ** power * density(d), [low, high]))

        assert roughness.contact_fraction(x) == pytest.approx(1 - mean(0), abs=1e-14)
        assert roughness.mean_film_cubed(x) == pytest.approx(mean(3), abs=1e-13)


def test_film_floor_is_the_mean_flow_of_touching_faces():
    """E(H^3)^(1/3) at h = 0: 0.30 c, 0.31 c for Gaussian heights; the film law's own at h = 0 is floor/2."""
    gauss = float(mpmath.quad(lambda s: s**3 * mpmath.npdf(s), [0, 20])) ** (1 / 3) / 3
    for law, mean in ((CHRISTENSEN, float(roughness.mean_film_cubed(0.0)) ** (1 / 3)), (GAUSSIAN, gauss)):
        floor, touch, collapse = contact_thresholds(law)
        assert geometry.regularised_thickness(0.0, floor) == pytest.approx(mean * C, rel=0.04)
        assert collapse == -C < 0 < floor < touch


@pytest.mark.parametrize("n", [1.0, 1.5])
def test_gaussian_overlap(n):
    for d in (-3.0, -1.0, 0.0, 1.0, 3.0, 5.0):
        exact = float(mpmath.quad(lambda s, d=d: (s - d) ** n * mpmath.npdf(s), [d, d + 1, d + 4, d + 20]))
        assert roughness.gaussian_overlap(n, d) == pytest.approx(exact, rel=1e-11)


def test_gaussian_law_is_the_paper_s():
    """Pressure and area of a flat face: 1e-3 where there is load, dying off smoothly above 3.5 rms."""
    for d in np.linspace(-3, 4.9, 80):
        found = rub(GAUSSIAN, face(0.0), d * ROUGHNESS - C0, 0.0, 0.0)
        area, p, _ = gaussian(d * ROUGHNESS)
        loose = 2e-5 if d > 3.5 else 0.0
        assert abs(found["pressure"] - p) < 1e-3 * p + loose * gaussian(0.0)[1], d
        assert abs(found["area"] - area) < 1e-3 * area + loose * gaussian(0.0)[0], d


FAULTS = {
    "missing strength": (dict(), "compressive_strength"),
    "negative strength": (dict(compressive_strength=-1.0), "compressive_strength"),
    "no roughness": (dict(compressive_strength=1e8, roughness=0.0), "roughness"),
    "infinite roughness": (dict(compressive_strength=1e8, roughness=np.inf), "roughness"),
    "two frictions": (dict(compressive_strength=1e8, shear_strength=1e7, friction_coefficient=0.1), "shear_strength"),
    "friction that drives": (dict(compressive_strength=1e8, friction_coefficient=-0.1), "friction_coefficient"),
    "growing face": (dict(compressive_strength=1e8, rotor_wear_coefficient=-1e-16), "rotor_wear_coefficient"),
    "asperities of the other law": (dict(compressive_strength=1e8, modulus=1e9), "modulus"),
    "plateaus higher than any height": (
        dict(law="plateaus", compressive_strength=1e8, truncation=6.0, plateau_roughness=1e-9), "truncation"),
    "plateaus rougher than high": (
        dict(law="plateaus", compressive_strength=1e8, truncation=1.0, plateau_roughness=1e-7), "plateau_roughness"),
    "plateaus of another law": (dict(compressive_strength=1e8, truncation=1.5), "truncation"),
    "gaussian without tips": (
        dict(law="greenwood-williamson", asperity_density=1e11, modulus=1e9),
        "asperity_radius",
    ),
    "gaussian with strength": (
        dict(law="greenwood-williamson", asperity_density=1e11, asperity_radius=1e-6, modulus=1e9,
             compressive_strength=1e8),
        "compressive_strength",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", FAULTS)
def test_faults_name_the_key(case):
    given, key = FAULTS[case]
    found = contact_errors(Contact(**{"roughness": ROUGHNESS, **given}))
    assert [fault[0] for fault in found] == [key]
    assert all(isinstance(part, str) and part for part in found[0])


@LAWS
def test_nothing_wrong_with_a_whole_table(law):
    assert contact_errors(law) == []
