"""The radial film's kernel against a shooting solution of Reynolds' equation, angle by angle (oracles.py)."""

import numpy as np
import pytest
from oracles import floored_wrench, radial_wrench
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fmr

from sealdyn.dynamics.condensation import film_slopes
from sealdyn.dynamics.imposed_motion import rest_state
from sealdyn.faces import geometry
from sealdyn.films._radial_quadrature import HAS_CAVITATION
from sealdyn.films.radial import film as radial
from sealdyn.films.radial import floored

MU, P_I, P_O = 0.5e-3, 1e5, 6e5
AREA = np.pi * (R_O**2 - R_I**2)
CONVERGING, FLAT, DIVERGING, STEEP = 3.125e-3, 0.0, -0.6e-3, 12e-3
FACES = [
    pytest.param(coning, geometry, tilt_radius, id=f"{name}-{geometry}-{tilt_radius}")
    for name, coning in (("converging", CONVERGING), ("flat", FLAT), ("diverging", DIVERGING))
    for geometry in ("cylindrical", "planar")
    for tilt_radius in ("local", "mean")
]


def face_of(coning, geometry="cylindrical", tilt_radius="local"):
    return R_I, R_O, CLEARANCE, coning, geometry == "planar", tilt_radius == "mean"


def block(coning, geometry="cylindrical", tilt_radius="local", error=1e-13, **more):
    module = radial if more.get("cavitation_pressure") is None else floored
    return module.parameters(
        film(coning=coning, geometry=geometry, tilt_radius=tilt_radius, **more), CLEARANCE, error
    )  # fmt: skip


def random_state(face, share, seed, pressures=(P_I, P_O), mean_spin=0.5 * SPEED, squeeze=1.0):
    """A tilt in any direction that leaves `share` of the clearance, and random rates of the same size."""
    r_i, r_o, c, coning, _, mean = face
    draw = np.random.default_rng(seed)
    arms = (0.5 * (r_i + r_o),) * 2 if mean else (r_i, r_o)
    tilt = min((c - share * c) / arms[0], (c + coning * (r_o - r_i) - share * c) / arms[1])
    angle, rates = draw.uniform(0, 2 * np.pi), draw.normal(size=3) * SPEED * c * [0.1 * squeeze, 0.5 / r_o, 0.5 / r_o]
    return [0.0, tilt * np.cos(angle), tilt * np.sin(angle), *rates, mean_spin, MU, *pressures]


def gap_state(state, spin_difference=SPEED):
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[:6], s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE] = state[:6], state[6], spin_difference
    s[geometry.VISCOSITY], s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = state[7:10]
    return s


def kernel(f, state, spin_difference=SPEED):
    """Force, complex moment, flow in +r at both radii, torque."""
    s = gap_state(state, spin_difference)
    (floored if f[HAS_CAVITATION] else radial).flow(f, s)
    moment = complex(s[geometry.MOMENT_X], s[geometry.MOMENT_Y])
    return s[geometry.FORCE], moment, s[geometry.FLOW_INNER], s[geometry.FLOW_OUTER], s[geometry.TORQUE]


def deviation(found, expected):
    """Of force and moment: relative to the force (never below the sealed pressure on the face) and the moment."""
    size = max(abs(expected[0]), (P_O - P_I) * AREA)
    return max(abs(found[0] - expected[0]) / size, abs(found[1] - expected[1]) / abs(expected[1]))


# At 0.3 % shooting takes seconds: there every coning once, geometries and levers in turn.
THINNEST = {(CONVERGING, "cylindrical", "local"), (FLAT, "planar", "mean"), (DIVERGING, "cylindrical", "mean")}
SHOT = [
    pytest.param(*face.values, share, id=f"{face.id}-{share}",
                 marks=pytest.mark.slow if share < 0.05 and face.values not in THINNEST else ())
    for share in (0.7, 0.1, 0.003)
    for face in FACES
]  # fmt: skip


@pytest.mark.parametrize(("coning", "geometry", "tilt_radius", "share"), SHOT)
def test_wrench_leakage_and_torque_at_random_states(coning, geometry, tilt_radius, share):
    face = face_of(coning, geometry, tilt_radius)
    state = random_state(face, share, seed=int(1000 * share))
    force, moment, inner, outer, couette, turned = radial_wrench(face, state, 2048 if share < 0.05 else 384)
    found = kernel(block(coning, geometry, tilt_radius), state)
    assert deviation(found, (force, moment)) < 1e-11
    assert found[2:4] == pytest.approx((inner, outer), rel=1e-11)
    # Friction on the rotor: Couette drag and (h/2) r dp/dtheta, here by parts -p (dh/dtheta)/2.
    assert found[4] == pytest.approx(MU * SPEED * couette - 0.5 * turned, rel=1e-11)


@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING])
@pytest.mark.parametrize("tilt_radius", ["local", "mean"])
def test_aligned_film(coning, tilt_radius):
    """No tilt at all: the film ratio is one number, for flat faces exactly 1."""
    face = face_of(coning, tilt_radius=tilt_radius)
    state = [0.1e-5, 0.0, 0.0, 1e-3, 0.02, -0.01, 0.5 * SPEED, MU, P_I, P_O]
    force, moment, inner, outer, *_ = radial_wrench(face, state, 16)
    found = kernel(block(coning, tilt_radius=tilt_radius), state)
    assert deviation(found, (force, moment)) < 1e-11
    assert found[2:4] == pytest.approx((inner, outer), rel=1e-11)


@pytest.mark.parametrize("error", [1e-4, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING, STEEP])
def test_quadrature_follows_the_asked_error(coning, error):
    """Points and angles chosen from the gap keep the asked error from wide open to 0.2 % of the clearance; the
    finest rule, itself checked above against the shooting solution, is the measure."""
    for shape_name in ("cylindrical", "planar"):
        face = face_of(coning, shape_name)
        fine, asked = block(coning, shape_name, error=1e-14), block(coning, shape_name, error=error)
        for share in (0.9, 0.5, 0.31, 0.1, 0.03, 0.01, 0.004, 0.002):
            for seed in range(12):
                state = random_state(face, share, seed)
                assert deviation(kernel(asked, state), kernel(fine, state)) < error, (shape_name, share, seed)


@pytest.mark.parametrize("tilt_radius", ["local", "mean"])
@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING])
def test_default_error_is_1e_8_above_a_third_of_the_clearance(coning, tilt_radius):
    face = face_of(coning, tilt_radius=tilt_radius)
    asked = radial.parameters(film(coning=coning, tilt_radius=tilt_radius), CLEARANCE)
    for seed, share in enumerate((0.95, 0.6, 0.31)):
        state = random_state(face, share, seed)
        assert deviation(kernel(asked, state), radial_wrench(face, state, 512)[:2]) < 1e-8


@pytest.mark.parametrize("cavitation", [None, 0.0])
def test_turning_the_tilt_turns_the_moment(cavitation):
    f = block(CONVERGING, error=1e-8, cavitation_pressure=cavitation)
    state = np.array(random_state(face_of(CONVERGING), 0.05, 3, pressures=(0.0, 5e5)))
    force, moment, *flows, torque = kernel(f, state)
    for angle in (0.3, 1.0, np.pi / 2, 2.0, np.pi, 5.0):
        turned, turn = state.copy(), np.exp(1j * angle)
        for x, y in ((1, 2), (4, 5)):
            value = complex(state[x], state[y]) * turn
            turned[x], turned[y] = value.real, value.imag
        found = kernel(f, turned)
        assert found[0] == pytest.approx(force, rel=1e-10)
        assert abs(found[1] - moment * turn) < 1e-10 * abs(moment)
        assert found[2:] == pytest.approx((*flows, torque), rel=1e-10)


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING])
def test_cross_stiffness_is_mean_spin_times_damping(coning, geometry):
    """M = -[K g + D (g' - i wm g)]: linearised, K_xy = -K_yx = wm D and no other coupling."""
    scene = fmr(film=film(coning=coning, geometry=geometry, inner_pressure=P_I, outer_pressure=P_O))
    k, d = film_slopes(radial.wrench, block(coning, geometry, error=1e-13), *rest_state(scene, CLEARANCE))[:2]
    wedge = 0.5 * SPEED * d[1, 1]
    assert (k[1, 2], -k[2, 1]) == pytest.approx((wedge, wedge), rel=1e-9)
    assert k[1, 1] == pytest.approx(k[2, 2], rel=1e-9)
    assert d[1, 1] == pytest.approx(d[2, 2], rel=1e-9)
    assert np.max(np.abs(d[[1, 2], [2, 1]])) < 1e-9 * d[1, 1]
    assert np.max(np.abs([k[0, 1:], k[1:, 0]])) * 0.04 < 1e-8 * wedge


@pytest.mark.core
@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING])
def test_power_put_in_is_the_heat_of_the_film(coning):
    """Torques times spins + pressures times flows - film wrench times relative rates = viscous dissipation,
    `mu (dW)^2 r^2/h + h^3 p_r^2/(12 mu)`, integrated on its own over the face.  (The planar film and the film
    tilted at the mean radius carry their pressure on other arms than they squeeze it with: no such balance.)"""
    w_r, w_s = SPEED, -0.3 * SPEED
    state = random_state(face_of(coning), 0.2, 7, mean_spin=0.5 * (w_r + w_s))
    force, moment, inner, outer, torque = kernel(block(coning), state, w_r - w_s)
    x, weight = np.polynomial.legendre.leggauss(40)
    theta = 2 * np.pi * np.arange(384)[:, None] / 384
    r, w = R_I + 0.5 * (R_O - R_I) * (1 + x), 0.5 * (R_O - R_I) * weight
    g, rate = complex(*state[1:3]), complex(*state[4:6])

    def swing(radius, tilt):
        """r (t_x sin - t_y cos) and its slope around the circle."""
        turned = np.exp(1j * theta) * np.conj(tilt)
        return radius * turned.imag, radius * turned.real

    def volume(radius):
        """r (dh/dt + wm dh/dtheta)"""
        return radius * (state[3] + swing(radius, rate)[0] + state[6] * swing(radius, g)[1])

    h = CLEARANCE + coning * (r - R_I) + swing(r, g)[0]
    phi = np.empty_like(h)
    for k, end in enumerate(r):
        half = 0.5 * (end - R_I)
        phi[:, k] = np.sum(half * weight * volume(R_I + half * (1 + x)), axis=1)
    per = 12 * MU / (r * h**3)
    edge = (P_O - P_I - np.sum(w * per * phi, axis=1)) / np.sum(w * per, axis=1)
    slope, d = per * (phi + edge[:, None]), 2 * np.pi / 384
    couette = MU * (w_r - w_s) * np.sum(w * r**3 / h) * d
    heat = (w_r - w_s) * couette + np.sum(w * h**3 / (12 * MU) * slope**2 * r) * d
    # What the shaft supplies is the rotor's torque; the stator's has the opposite drag and the same pressure part.
    put_in = w_r * torque + w_s * (torque - 2 * couette)
    put_in += P_I * inner - P_O * outer - force * state[3] - (moment * np.conj(rate)).real
    assert put_in == pytest.approx(heat, rel=1e-10)


@pytest.mark.parametrize(("coning", "geometry", "tilt_radius"), FACES)
@pytest.mark.parametrize("share", [0.5, 0.1])
def test_cavitation_floor_against_a_dense_grid(coning, geometry, tilt_radius, share):
    """max(p, p_cav) by brute force on 4000 x 501 points (itself good to some 1e-6)."""
    face = face_of(coning, geometry, tilt_radius)
    state = random_state(face, share, 11, pressures=(0.0, 5e5), mean_spin=2 * SPEED, squeeze=3.0)
    expected = floored_wrench(face, state, 0.0, 4000, 501)
    full = kernel(block(coning, geometry, tilt_radius), state)
    found = kernel(block(coning, geometry, tilt_radius, error=1e-9, cavitation_pressure=0.0), state)
    assert deviation(found, expected) < 1e-5
    if coning <= 0 or share < 0.5:
        assert deviation(full, expected) > 1e-4


def test_a_floor_below_every_pressure_changes_nothing():
    state = random_state(face_of(CONVERGING), 0.4, 2)
    floored = kernel(block(CONVERGING, cavitation_pressure=-1e9), state)
    assert floored == pytest.approx(kernel(block(CONVERGING), state), rel=1e-11)


@pytest.mark.parametrize("error", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("coning", [CONVERGING, FLAT, DIVERGING])
def test_floored_quadrature_follows_the_asked_error(coning, error):
    face = face_of(coning)
    fine = block(coning, error=1e-11, cavitation_pressure=0.0)
    asked = block(coning, error=error, cavitation_pressure=0.0)
    worst = 0.0
    for share in (0.5, 0.1, 0.02):
        for seed in range(6):
            state = random_state(face, share, seed, pressures=(0.0, 5e5), mean_spin=2 * SPEED, squeeze=3.0)
            worst = max(worst, deviation(kernel(asked, state), kernel(fine, state)))
    assert worst < error


def test_finite_below_the_floor():
    """A solver's trial state may put the faces through each other: the film stays finite and pushes back."""
    f, s = block(CONVERGING), gap_state([-2 * CLEARANCE, 3e-4, 1e-4, 0, 0, 0, 500.0, MU, P_I, P_O])
    radial.wrench(f, s)
    assert np.all(np.isfinite(s))


def test_rough_faces_take_any_trial_state():
    """Tilts of any size, through each other or far apart: an answer, and soon."""
    f, draw = block(CONVERGING), np.random.default_rng(4)
    for _ in range(2000):
        s = gap_state([*draw.normal(size=6) * 10 ** draw.uniform(-9, 60), 500.0, MU, P_I, P_O])
        s[:3] *= draw.integers(0, 2, 3)
        radial.rough_wrench(f, s)
    s[:6] = np.nan
    radial.rough_wrench(f, s)
    f, s = block(CONVERGING), gap_state([-2 * CLEARANCE, 3e-4, 1e-4, 0, 0, 0, 500.0, MU, P_I, P_O])
    radial.rough_wrench(f, s)
    assert np.all(np.isfinite(s))
