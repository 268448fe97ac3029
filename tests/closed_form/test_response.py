"""Transmissibilities and contact onset, against the equation of motion solved here in real coordinates."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sealdyn import closed_form
from sealdyn.closed_form import critical_forcing, superposed

# The reference seal, a stiff and heavily damped one, a light one with a softening film.
SEALS = [
    {"speed": 1000.0, "transverse_inertia": 8e-4, "polar_inertia": 16e-4, "support_stiffness": 400.0}
    | {"support_damping": 0.24, "film_stiffness": 5790.6, "film_damping": 4.082},
    {"speed": 2700.0, "transverse_inertia": 8e-4, "polar_inertia": 8e-4 / 3, "support_stiffness": 2500.0}
    | {"support_damping": 1.3, "film_stiffness": 900.0, "film_damping": 2.0},
    {"speed": 350.0, "transverse_inertia": 2e-3, "polar_inertia": 1e-3, "support_stiffness": 700.0}
    | {"support_damping": 0.9, "film_stiffness": -150.0, "film_damping": 0.7},
]
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # turns a tilt vector (x, y) by 90 degrees


def ring(seal, flexible):
    """Real matrices M, G, S of `M q'' + G q' + S q = drive` for the flexible ring's tilt (x, y).

    Written part by part: springs and dampers of the support ride on its carrier, which spins with the rotor's
    shaft; the film's damping acts on what is left after half the shaft's spin.
    """
    spin = seal["speed"] if flexible == "rotor" else 0.0
    one = np.eye(2)
    mass = seal["transverse_inertia"] * one
    gyroscopic = -seal["polar_inertia"] * spin * QUARTER
    support = seal["support_stiffness"] * one - seal["support_damping"] * spin * QUARTER
    film = seal["film_stiffness"] * one - seal["film_damping"] * seal["speed"] / 2 * QUARTER
    damping = (seal["support_damping"] + seal["film_damping"]) * one
    return mass, gyroscopic + damping, support + film, film


def steady_tilt(seal, flexible, drive_cos, drive_sin, frequency):
    """Coefficients a, b of q = a cos(frequency t) + b sin(frequency t)."""
    mass, rate, stiffness, _ = ring(seal, flexible)
    inner = stiffness - frequency**2 * mass
    blocks = np.block([[inner, frequency * rate], [-frequency * rate, inner]])
    both = np.linalg.solve(blocks, np.concatenate([drive_cos, drive_sin]))
    return both[:2], both[2:]


X, Y = np.array([1.0, 0.0]), np.array([0.0, 1.0])


def answers(seal):
    """All four transmissibilities; every partner's tilt is 1 along x at t = 0."""
    w = seal["speed"]
    found = {}
    film = ring(seal, "rotor")[3]
    rotor, _ = steady_tilt(seal, "rotor", film @ X, 0 * X, 0.0)
    found["fmr_static"] = np.linalg.norm(X - rotor)
    own = seal["support_stiffness"]
    found["fmr_dynamic"] = np.linalg.norm(steady_tilt(seal, "rotor", own * X, own * Y, w)[0])
    found["fms_static"] = np.linalg.norm(steady_tilt(seal, "stator", own * X, 0 * X, 0.0)[0])
    # Runout (cos, sin): the film feels its tilt and its rate, w (-sin, cos).
    drive_cos = film @ X + seal["film_damping"] * w * Y
    drive_sin = film @ Y - seal["film_damping"] * w * X
    stator, _ = steady_tilt(seal, "stator", drive_cos, drive_sin, w)
    found["fms_dynamic"] = np.linalg.norm(stator - X)
    return found


@pytest.mark.parametrize("seal", SEALS)
def test_transmissibilities_solve_the_equation_of_motion(seal):
    for name, expected in answers(seal).items():
        assert getattr(closed_form, name)(**seal) == pytest.approx(expected, rel=1e-12), name


@pytest.mark.parametrize("seal", SEALS)
def test_dimensionless_numbers_serve_as_well(seal):
    scale, w = 4.9e5, seal["speed"]
    bars = {"speed": 1.0}
    for name, value in seal.items():
        power = {"inertia": 2, "damping": 1, "stiffness": 0}.get(name.split("_")[-1])
        if power is not None:
            bars[name] = value * w**power / scale
    for name, expected in answers(seal).items():
        assert getattr(closed_form, name)(**bars) == pytest.approx(expected, rel=1e-12), name


@pytest.mark.parametrize("flexible", ["rotor", "stator"])
def test_extremes_of_an_integrated_ring(flexible):
    # Both forcings at once, from rest; the transient has died long before the last turn.
    seal = SEALS[0]
    w, own, other = seal["speed"], 25e-6, 40e-6
    mass, rate, stiffness, film = ring(seal, flexible)

    def turning(t, size):
        return size * np.array([np.cos(w * t), np.sin(w * t)])

    def partner(t):
        if flexible == "rotor":
            return other * X, 0 * X
        return turning(t, other), w * QUARTER @ turning(t, other)

    def motion(t, y):
        tilt, tilt_rate = partner(t)
        mine = turning(t, own) if flexible == "rotor" else own * X
        drive = film @ tilt + seal["film_damping"] * tilt_rate + seal["support_stiffness"] * mine
        return np.concatenate([y[2:], np.linalg.solve(mass, drive - rate @ y[2:] - stiffness @ y[:2])])

    end, turn = 0.1, 2 * np.pi / w
    times = np.linspace(end - turn, end, 4001)
    run = solve_ivp(motion, (0, end), np.zeros(4), "DOP853", times, rtol=1e-10, atol=1e-16, max_step=turn / 20)
    relative = np.linalg.norm(run.y[:2].T - np.array([partner(t)[0] for t in times]), axis=1)
    if flexible == "rotor":
        most, least = superposed(closed_form.fmr_static(**seal) * other, closed_form.fmr_dynamic(**seal) * own)
    else:
        most, least = superposed(closed_form.fms_static(**seal) * own, closed_form.fms_dynamic(**seal) * other)
    assert relative.max() == pytest.approx(most, rel=1e-6)
    assert relative.min() == pytest.approx(least, rel=1e-6)


def test_speed_may_be_an_array():
    speeds = np.linspace(0, 3000, 7)
    for name in answers(SEALS[0]):
        law = getattr(closed_form, name)
        swept = law(**SEALS[0] | {"speed": speeds})
        assert swept == pytest.approx([law(**SEALS[0] | {"speed": w}) for w in speeds])


@pytest.mark.core
def test_critical_forcing_brings_the_response_to_contact():
    assert 2e-6 + 0.07 * critical_forcing(3e-4, 2e-6, 0.07) == pytest.approx(3e-4)
    assert critical_forcing(3e-4, 4e-4, 0.07) < 0
    assert critical_forcing(3e-4, 0.0, 0.0) == np.inf
