"""Faces with a profile: the gap, its smallest value, contact and wear against sums over the whole face."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from test_contact import C0, GAUSSIAN, R_I, R_O, SLOTS, SPEED, C, pressed, sums
from test_contact import CHRISTENSEN as LAW

from sealdyn.faces import contact, geometry
from sealdyn.faces.film_thickness import h_min
from sealdyn.scene.film import Film, Profile

# Thinnest in the middle, at an edge, and with a groove.
BENT = {
    "middle": ((0.032, 0.0335, 0.0371, 0.040), (4e-6, 0.3e-6, 0.0, 6e-6)),
    "inner": ((0.032, 0.033, 0.036, 0.040), (0.0, 0.4e-6, 0.5e-6, 3e-6)),
    "groove": ((0.032, 0.0345, 0.0347, 0.0349, 0.0374, 0.040), (0.5e-6, 0.0, 9e-6, 0.1e-6, 0.2e-6, 2e-6)),
}
bent = pytest.mark.parametrize("shape", BENT.values(), ids=BENT)
mean_or_local = pytest.mark.parametrize("mean", [False, True], ids=["local", "mean"])


def table(shape=None, mean=False, coning=0.0, **changes):
    profile = Profile(*shape) if shape else None
    radius = "mean" if mean else "local"
    given = Film(R_I, R_O, 5e-4, 6e5, 1e5, clearance=C0, coning=coning, tilt_radius=radius, profile=profile)
    return replace(given, **changes)


def face(*args, **more):
    return geometry.face_parameters(table(*args, **more), C0)


def state(dz, g_x, g_y, spin=SPEED):
    s = np.full(geometry.GAP_STATE_SIZE, np.nan)
    s[[geometry.CONING_CHANGE, geometry.CONING_RATE]] = 0.0
    s[: geometry.GY + 1], s[geometry.SPIN_DIFFERENCE] = (dz, g_x, g_y), spin
    return s


def rub(f, at, law=LAW, points=None):
    s = state(*at)
    contact.contact_load_and_friction(contact.lay_asperities(law, f, points), f, s)
    return {name: s[slot] for name, slot in SLOTS.items()}


def wear_integrals(f, at):
    out = np.full(int(f[geometry.PROFILE]), np.nan)
    contact.wear_rates(contact.lay_asperities(LAW, f), f, state(*at), out)
    return out


def depth_at(shape, r):
    return np.interp(r, *shape) if shape else 0.0 * r


def thickness(shape, r, theta, at, mean=False, coning=0.0):
    """The sheet's formula."""
    arm = 0.5 * (R_I + R_O) if mean else r
    slope = arm * (at[1] * np.sin(theta) - at[2] * np.cos(theta))
    return C0 + at[0] + coning * (r - R_I) + depth_at(shape, r) + slope


def grid(shape, angles=1440, per_piece=241):
    """Angles, radii crowded at every corner of the profile, and areas of the points."""
    theta = 2 * np.pi * np.arange(angles)[:, None] / angles
    y = np.linspace(0, 1, per_piece)
    r, dr = [], []
    for a, b in pairwise(shape[0]):
        r.append(a + (b - a) * y**3 * (10 - 15 * y + 6 * y**2))
        dr.append((b - a) * 30 * y**2 * (1 - y) ** 2 / (per_piece - 1))
    r = np.concatenate(r)
    return theta, r, np.concatenate(dr) * r * 2 * np.pi / angles


def summed(shape, at, mean=False, coning=0.0):
    """Every answer of `rub`, and the wear integrals, by sums over the grid."""
    theta, r, da = grid(shape)
    h = thickness(shape, r, theta, at, mean, coning)
    found = sums(pressed, theta, r, da, 0.5 * (R_I + R_O) if mean else r, h, at)
    hats = [np.interp(r, shape[0], row) for row in np.eye(len(shape[0]))]
    return found | {"nodes": np.array([np.sum(pressed(h)[1] * r * hat * da) for hat in hats])}


def states(shape, seed, number, mean=False, coning=0.0, deepest=-1.5):
    """Tilts from tiny to large in any direction, the thinnest film from `deepest` c to c."""
    draw = np.random.default_rng(seed)
    r = np.asarray(shape[0])
    for _ in range(number):
        tilt, angle = 10 ** draw.uniform(-6.5, -3.3), draw.uniform(0, 2 * np.pi)
        arm = 0.5 * (R_I + R_O) if mean else r
        low = np.min(C0 + coning * (r - R_I) + np.asarray(shape[1]) - arm * tilt)
        yield C * draw.uniform(deepest, 0.9) - low, tilt * np.cos(angle), tilt * np.sin(angle)


@bent
@mean_or_local
@pytest.mark.parametrize("coning", [0.0, 3e-4, -2e-4])
def test_smallest_film_is_the_least_of_a_fine_scan(shape, mean, coning):
    f, seen = face(shape, mean, coning), set()
    theta, r = np.linspace(-np.pi, np.pi, 3601)[:, None], np.unique(np.r_[np.linspace(R_I, R_O, 400), shape[0]])
    for at in states(shape, 1, 25, mean, coning, -20.0):
        low, angle, radius = h_min(f, state(*at))
        scanned = thickness(shape, r, theta, at, mean, coning).min()
        slack = R_O * np.hypot(*at[1:]) * (np.pi / 3600) ** 2 / 2
        assert low - 1e-18 <= scanned <= low + slack + 1e-18
        assert thickness(shape, radius, angle, at, mean, coning) == pytest.approx(low, abs=1e-17)
        edges = [thickness(shape, e, angle, at, mean, coning) for e in (R_I, R_O)]
        assert geometry.edge_gaps(f, at[0], np.hypot(*at[1:]), 0.0) == pytest.approx(edges, abs=1e-17)
        seen.add(radius)
    assert seen <= set(shape[0])


@pytest.mark.parametrize("coning", [3.125e-3, 0.0, -0.5e-3])
@mean_or_local
def test_a_linear_profile_is_coning_and_zeros_are_nothing(coning, mean):
    plain = face(coning=coning, mean=mean)
    for n in (2, 7, 65):
        r = np.linspace(R_I, R_O, n)
        straight = r, coning * (r - R_I)
        for f in (face((r, np.zeros(n)), mean, coning), face(straight, mean)):
            for at in states(straight, 2, 20, mean):
                assert h_min(f, state(*at))[:2] == pytest.approx(h_min(plain, state(*at))[:2], abs=1e-20, rel=1e-13)
                # The law's own points around the circle leave 1e-9 of a shallow load; with twice as many, rounding.
                for law, points, allowed in ((LAW, None, 1e-9), (LAW, 30, 1e-12), (GAUSSIAN, 40, 1e-12)):
                    expected = rub(plain, at, law, points)
                    for name, value in rub(f, at, law, points).items():
                        size = expected["force"] * R_O if name in "xy" else expected[name]
                        assert abs(value - expected[name]) <= allowed * size, (name, n, at)


@bent
@mean_or_local
def test_contact_is_the_sum_over_the_face(shape, mean):
    for coning in (0.0, 1e-4):
        f = face(shape, mean, coning)
        for at in states(shape, 3, 5, mean, coning):
            found, exact = rub(f, at), summed(shape, at, mean, coning)
            for name, slot in found.items():
                size = R_O * exact["force"] if name in "xy" else exact[name]
                # The grid's own error; its points miss the most pressed one by half a step.
                assert abs(slot - exact[name]) <= (1e-3 if name == "pressure" else 5e-5) * size, (name, at)
            nodes = wear_integrals(f, at)
            assert np.max(np.abs(nodes - exact["nodes"])) < 5e-5 * np.sum(exact["nodes"]), at
            # And to rounding it is what the mean wear rate has.
            mean_depth = 5e-16 * SPEED * np.sum(nodes) / (np.pi * (R_O**2 - R_I**2))
            assert mean_depth == pytest.approx(found["wear"], rel=1e-13)


@bent
def test_aligned_faces_against_quadrature(shape):
    """No tilt: single integrals over the radius, split where the film meets the first asperities."""
    f = face(shape)
    r = np.asarray(shape[0])
    for depth in (-0.5, 0.0, 0.5, 0.9):
        at = (C * depth - C0 - min(shape[1]), 0.0, 0.0)
        corners = list(r[1:-1])
        for a, b in pairwise(r):
            for level in (C, -C):

                def above(x, level=level, at=at):
                    return thickness(shape, x, 0.0, at) - level

                if above(a) * above(b) < 0:
                    corners.append(brentq(above, a, b, xtol=1e-17))

        def around(x, weight, at=at):
            return pressed(thickness(shape, x, 0.0, at))[1] * weight(x) * 2 * np.pi * x

        ends = [R_I, *sorted(corners), R_O]

        def integral(weight, ends=ends, around=around):
            return sum(quad(around, a, b, (weight,), epsabs=0, epsrel=1e-13)[0] for a, b in pairwise(ends))

        assert rub(f, at)["force"] == pytest.approx(integral(lambda x: 1.0), rel=1e-11)
        for found, row in zip(wear_integrals(f, at), np.eye(len(r)), strict=True):
            exact = integral(lambda x, row=row: x * np.interp(x, r, row))
            assert found == pytest.approx(exact, rel=1e-10, abs=1e-12 * integral(lambda x: x))


@bent
@mean_or_local
@pytest.mark.parametrize("law", [LAW, GAUSSIAN], ids=["christensen", "gaussian"])
def test_forces_are_minus_the_derivatives_of_the_energy(shape, mean, law):
    f = face(shape, mean)
    for at in states(shape, 4, 8, mean):
        found = rub(f, at, law)
        for n, (name, step) in enumerate((("force", 1e-3 * C), ("x", 1e-3 * C / R_O), ("y", 1e-3 * C / R_O))):
            near = [rub(f, np.array(at) + m * step * np.eye(3)[n], law)["energy"] for m in (-2, -1, 1, 2)]
            slope = (near[0] - 8 * near[1] + 8 * near[2] - near[3]) / (12 * step)
            assert abs(found[name] + slope) < 2e-7 * found["force"] * (1 if n == 0 else R_O), (name, at)


@bent
def test_turning_the_tilt_turns_the_moment(shape):
    f = face(shape)
    for at in states(shape, 5, 5):
        found, worn = rub(f, at), wear_integrals(f, at)
        for angle in (0.3, np.pi / 2, 2.5, 5.0):
            tilt = complex(*at[1:]) * np.exp(1j * angle)
            turned = rub(f, (at[0], tilt.real, tilt.imag))
            moment = complex(found["x"], found["y"]) * np.exp(1j * angle)
            assert abs(complex(turned["x"], turned["y"]) - moment) < 1e-11 * found["force"] * R_O
            assert turned["force"] == pytest.approx(found["force"], rel=1e-11)
            assert wear_integrals(f, (at[0], tilt.real, tilt.imag)) == pytest.approx(worn, rel=1e-10, abs=1e-300)


def test_above_touch_nothing_wears():
    f = face(BENT["middle"])
    at = (C * 1.0001 - C0, 0.0, 0.0)
    assert not any(rub(f, at).values()) and not np.any(wear_integrals(f, at))


def test_65_radii_fit():
    r = np.linspace(R_I, R_O, 65)
    f = face((r, 1e-6 * np.sin(400 * r)))
    assert f[geometry.PROFILE] == 65 and f[geometry.PROFILE_RADII + 64] == R_O
    with pytest.raises(ValueError):
        r = np.linspace(R_I, R_O, 66)
        face((r, 0 * r))
