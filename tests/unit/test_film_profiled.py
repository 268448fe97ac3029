"""The film between faces with a profile, against a shooting solution of Reynolds' equation, corner by corner, and
against the radial film where the profile is a cone."""

from itertools import pairwise

import numpy as np
import pytest
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fms
from scipy.integrate import solve_ivp

from sealdyn.faces import geometry
from sealdyn.films import film_names, film_of
from sealdyn.films.profiled import film as profiled
from sealdyn.films.radial import film as radial
from sealdyn.scene.film import Profile

MU, P_I, P_O = 0.5e-3, 1e5, 6e5
AREA = np.pi * (R_O**2 - R_I**2)
BENT = {
    "middle": ((R_I, 0.0335, 0.0371, R_O), (8e-6, 0.3e-6, 0.0, 12e-6)),
    "groove": ((R_I, 0.0345, 0.0347, 0.0349, R_O), (0.5e-6, 0.0, 20e-6, 0.1e-6, 4e-6)),
    "smooth": (tuple(np.linspace(R_I, R_O, 33)), tuple(5e-6 * np.cos(np.linspace(0.3, 4.0, 33)) ** 2)),
}
KINDS = [
    pytest.param(shape, geometry, tilt_radius, id=f"{name}-{geometry}-{tilt_radius}")
    for name, shape in BENT.items()
    for geometry in ("cylindrical", "planar")
    for tilt_radius in ("local", "mean")
]


def block(shape=None, error=1e-13, coning=0.0, module=profiled, **more):
    return module.parameters(film(coning=coning, profile=Profile(*shape) if shape else None, **more), CLEARANCE, error)


def thinnest(shape, coning, mean):
    """(arm, aligned film) at the corners."""
    r = np.asarray(shape[0])
    return (np.full_like(r, 0.5 * (R_I + R_O)) if mean else r), CLEARANCE + coning * (r - R_I) + np.asarray(shape[1])


def random_state(shape, share, seed, coning=0.0, tilt_radius="local"):
    """dz, tilt, rates, mean spin: a tilt in any direction that leaves `share` of the clearance, rates to match."""
    draw = np.random.default_rng(seed)
    arm, h = thinnest(shape, coning, tilt_radius == "mean")
    tilt, angle = np.min((h - share * CLEARANCE) / arm), draw.uniform(0, 2 * np.pi)
    rates = draw.normal(size=3) * SPEED * CLEARANCE * [0.1, 0.5 / R_O, 0.5 / R_O]
    return np.array([0.0, tilt * np.cos(angle), tilt * np.sin(angle), *rates, 0.5 * SPEED])


def kernel(f, state, module=profiled):
    """Force, complex moment, flow in +r at both radii, torque."""
    s = np.full(geometry.GAP_STATE_SIZE, np.nan)
    s[[geometry.CONING_CHANGE, geometry.CONING_RATE]] = 0.0
    s[:6], s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE] = state[:6], state[6], SPEED
    s[geometry.VISCOSITY], s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = MU, P_I, P_O
    module.flow(f, s)
    only = s.copy()
    module.wrench(f, only)
    here = slice(geometry.FORCE, geometry.MOMENT_Y + 1)
    assert np.max(np.abs(only[here] - s[here])) < 1e-12 * abs(s[geometry.FORCE])
    flows = s[[geometry.FLOW_INNER, geometry.FLOW_OUTER]]
    return s[geometry.FORCE], complex(s[geometry.MOMENT_X], s[geometry.MOMENT_Y]), *flows, s[geometry.TORQUE]


def shot(shape, state, geometry, tilt_radius, angles):
    """The same five by shooting from corner to corner, with the pressure itself as an unknown, at every angle."""
    dz, gx, gy, dz_t, gx_t, gy_t, wm = state
    theta = 2 * np.pi * np.arange(angles) / angles
    sin, cos, n, planar = np.sin(theta), np.cos(theta), angles, geometry == "planar"
    r_m, radii = 0.5 * (R_I + R_O), np.asarray(shape[0])

    def parts(r, depth):
        arm = r_m if tilt_radius == "mean" else r
        turn = arm * (gx * cos + gy * sin)
        return (CLEARANCE + dz + depth + arm * (gx * sin - gy * cos),
                dz_t + arm * (gx_t * sin - gy_t * cos) + wm * turn, turn)  # fmt: skip

    def slopes(r, y, piece):
        q, p, p0 = y[:n], y[n : 2 * n], y[2 * n : 3 * n]
        h, f, turn = parts(r, np.interp(r, radii[piece : piece + 2], shape[1][piece : piece + 2]))
        width = 1.0 if planar else r
        per = 12 * MU / (width * h**3)
        return np.concatenate([width * f, per * q, per, p * r, p0 * r, p * r * r, p0 * r * r, r**3 / h,
                               turn * p * r, turn * p0 * r])  # fmt: skip

    y = np.concatenate([np.zeros(n), np.full(n, P_I), np.zeros(8 * n)])
    least = np.min(CLEARANCE + np.asarray(shape[1])) * 1e-3
    sizes = [1e-6, P_O, 12 * MU / least**3 * 1e-3, 1, 1, 1e-2, 1e-2, 1e-2, 1e-6, 1e-6]
    for piece, (a, b) in enumerate(pairwise(radii)):
        found = solve_ivp(slopes, (a, b), y, "DOP853", rtol=2.3e-14, atol=np.repeat(sizes, n) * 1e-20,
                          args=(piece,), max_step=(R_O - R_I) / 60)  # fmt: skip
        y = found.y[:, -1]
    q, p, p0, f1, f0, m1, m0, drag, t1, t0 = y.reshape(10, n)
    edge, d, strip = (P_O - p) / p0, 2 * np.pi / n, r_m if planar else 1.0
    moment = np.sum((m1 + edge * m0) * (sin - 1j * cos)) * d
    torque = MU * SPEED * np.sum(drag) * d - 0.5 * np.sum(t1 + edge * t0) * d
    flows = [-np.sum(edge) * strip * d, -np.sum(edge + q) * strip * d]
    return np.sum(f1 + edge * f0) * d, moment, *flows, torque


def off(found, expected):
    """Largest relative deviation: force against the sealed pressure on the face at least."""
    size = max(abs(expected[0]), (P_O - P_I) * AREA)
    rest = [abs(a - b) / abs(b) for a, b in zip(found[1:], expected[1:], strict=True)]
    return max(abs(found[0] - expected[0]) / size, *rest)


# At one hundredth shooting takes seconds: there every shape once, geometries and levers in turn.
THINNEST = {"smooth-cylindrical-local", "groove-planar-mean", "middle-cylindrical-mean"}
SHOT = [
    pytest.param(*kind.values, share, id=f"{kind.id}-{share}",
                 marks=pytest.mark.slow if share < 0.05 and kind.id not in THINNEST else ())
    for share in (0.6, 0.1, 0.01)
    for kind in KINDS
]  # fmt: skip


@pytest.mark.parametrize(("shape", "geometry", "tilt_radius", "share"), SHOT)
def test_everything_against_shooting(shape, geometry, tilt_radius, share):
    state = random_state(shape, share, int(1000 * share), tilt_radius=tilt_radius)
    found = kernel(block(shape, geometry=geometry, tilt_radius=tilt_radius), state)
    # Measured 2e-12.
    assert off(found, shot(shape, state, geometry, tilt_radius, 1024 if share < 0.05 else 256)) < 1e-10


@pytest.mark.parametrize("tilt_radius", ["local", "mean"])
@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("coning", [3.125e-3, 0.0, -0.6e-3, 12e-3])
def test_a_cone_is_the_radial_film(coning, geometry, tilt_radius):
    """By coning with a profile of zeros, by a linear profile, and with none at all; for 2 radii to 65."""
    more = {"geometry": geometry, "tilt_radius": tilt_radius}
    fine = block(module=radial, coning=coning, **more)
    for n in (2, 3, 16, 65):
        r = np.linspace(R_I, R_O, n) if n != 3 else np.array([R_I, 0.0331, R_O])
        straight, zeros = (r, coning * (r - R_I)), (r, np.zeros(n))
        for share in (0.9, 0.3, 0.03, 0.004):
            state = random_state(straight, share, n, tilt_radius=tilt_radius)
            exact = kernel(fine, state, radial)
            for shape, cone in ((zeros, coning), (straight, 0.0), (None, coning)):
                assert off(kernel(block(shape, coning=cone, **more), state), exact) < 5e-12, (n, share)
                assert off(kernel(block(shape, 1e-8, cone, **more), state), exact) < 1e-9, (n, share)


@pytest.mark.parametrize("error", [1e-4, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("shape", BENT.values(), ids=BENT)
def test_quadrature_follows_the_asked_error(shape, error):
    for shape_name in ("cylindrical", "planar"):
        fine, asked = block(shape, 1e-14, geometry=shape_name), block(shape, error, geometry=shape_name)
        for share in (0.9, 0.5, 0.1, 0.03, 0.01, 0.004, 0.002):
            for seed in range(6):
                state = random_state(shape, share, seed)
                assert off(kernel(asked, state)[:2], kernel(fine, state)[:2]) < error, (shape_name, share, seed)


@pytest.mark.core
@pytest.mark.parametrize("shape", BENT.values(), ids=BENT)
def test_opening_force_is_the_aligned_film_s(shape):
    table = film(coning=0.0, profile=Profile(*shape))
    state = np.array([0.0] * 6 + [500.0])
    # At rest and aligned neither viscosity nor spin matter.
    force = kernel(block(shape), state)[0]
    assert profiled.FILM.opening_law(table)(CLEARANCE, P_I, P_O) == pytest.approx(force, rel=1e-13)


@pytest.mark.parametrize("shape", BENT.values(), ids=BENT)
def test_finite_and_smooth_below_the_floor(shape):
    """A solver's trial state may put the faces through each other: the film stays finite, and meets its other side."""
    f = block(shape, 1e-10)
    _, h = thinnest(shape, 0.0, False)
    for depth in (0.5, 2.0, 10.0):
        state = random_state(shape, -depth, 4)
        force, moment, *_ = kernel(f, state)
        assert np.isfinite(force) and np.isfinite(moment)
    touch = -np.min(h) + f[geometry.FLOOR]
    sides = [kernel(f, np.array([touch + e, *[0.0] * 5, 0.0]))[0] for e in (1e-16, -1e-16)]
    assert sides[0] == pytest.approx(sides[1], rel=1e-6)


def test_films_for_faces():
    """Of faces with a profile one film is left; "auto" takes it."""
    worn = film("auto", profile=Profile(*BENT["middle"]))
    assert film_names(worn) == ["profiled"] and film_of(fms(film=worn)) is profiled.FILM
    assert "profiled" not in film_names(film()) and film_of(fms("auto")) is radial.FILM
