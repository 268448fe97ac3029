"""Faces whose centres lie apart: what the film then does, from the surfaces' own places and velocities."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import R_I, R_O, SPEED, fmr, fms
from scipy.integrate import solve_ivp

import sealdyn
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.signals import signals

OFFSET, DIRECTION = 2e-4, 0.4
DISPLACED = np.array([1e-6, 4e-5, -2e-5])
RATES = np.array([2e-4, 1e-2, 2e-2])


def offset(scene, narrow, **changes):
    """The scene with one face off the axis."""
    given = {"offset": OFFSET, "offset_direction": DIRECTION, "narrow_face": narrow} | changes
    return replace(scene, film=replace(scene.film, **given))


def at(scene, q, rates, tau=3e-4):
    """Signals of a scene at one instant."""
    return {name: v[0] for name, v in signals(Model(scene).segment(), [tau], q[None], rates[None]).items()}


class Surfaces:
    """Heights of both faces in the frame of the shaft, the rings turning about its axis, each tilting about its own
    centre: `state(t)` gives (z, tilt_x, tilt_y) of the stator and of the rotor."""

    def __init__(self, scene, state, at):
        self.film, self.state, self.at = scene.film, state, at
        self.coning = scene.film.coning
        self.spin = SPEED if scene.film.narrow_face == "rotor" else 0.0

    def centre(self, t):
        angle = DIRECTION + self.spin * t
        return OFFSET * np.array([math.cos(angle), math.sin(angle)])

    def gap(self, x, t):
        """Film thickness at places `x` (2, ...) from the film's centre."""
        stator, rotor = self.state(t)
        here, c = x, self.centre(t)
        far = x + c.reshape(2, *[1] * (x.ndim - 1))
        s, r = (here, far) if self.spin == 0.0 else (far, here)
        total = self.film.clearance + self.coning * (np.hypot(*here) - R_I)
        total = total + stator[0] + stator[1] * s[1] - stator[2] * s[0]
        return total - (rotor[0] + rotor[1] * r[1] - rotor[2] * r[0])

    def slide(self, x):
        """Mean velocity (2, ...) of both faces at `x`, seen from the film's centre."""
        c = self.centre(self.at).reshape(2, *[1] * (x.ndim - 1))
        own = self.spin * np.stack([-c[1], c[0]])
        rotor = SPEED * np.stack([-(x[1] + c[1]), x[0] + c[0]])
        return 0.5 * rotor - own

    def line(self, theta):
        """Force, r-weighted force and both flows per angle of a radial line: pressure by integrating Reynolds'
        equation from both boundary values."""
        e, film, dt, dx = np.array([math.cos(theta), math.sin(theta)]), self.film, 1e-7, 1e-6

        def h(r, t=self.at):
            return float(self.gap(r * e, t))

        def source(r):
            x, u = r * e, self.slide(r * e)
            rate = (h(r, self.at + dt) - h(r, self.at - dt)) / (2 * dt)
            slope = [(self.gap(x + d, self.at) - self.gap(x - d, self.at)) / (2 * dx) for d in dx * np.eye(2)]
            return rate + float(u @ np.array(slope))

        def rates(r, y):
            # Flow r h^3 p'/(12 mu), pressure, and the same two started by one unit of flow; then the sums of p.
            per = 12.0 * film.viscosity / (r * h(r) ** 3)
            return [r * source(r), per * y[0], per, y[1] * r, y[2] * r, y[1] * r * r, y[2] * r * r]

        start = [0.0, film.inner_pressure, 0.0, 0.0, 0.0, 0.0, 0.0]
        y = solve_ivp(rates, (R_I, R_O), start, rtol=1e-10, atol=1e-14).y[:, -1]
        flow = (film.outer_pressure - y[1]) / y[2]
        carried = [float(self.slide(r * e) @ e) * h(r) * r for r in (R_I, R_O)]
        return y[3] + flow * y[4], y[5] + flow * y[6], carried[0] - flow, carried[1] - (flow + y[0])


def around(surfaces, angles=32):
    """Force, moments and flows out of the faces, summed over the circle: (force, m_x, m_y, inner, outer)."""
    theta = 2 * np.pi * np.arange(angles) / angles
    force, first, inner, outer = np.array([surfaces.line(angle) for angle in theta]).T * 2 * np.pi / angles
    return force.sum(), first @ np.sin(theta), -first @ np.cos(theta), inner.sum(), outer.sum()


@pytest.mark.core
@pytest.mark.parametrize("floating, narrow", [("rotor", "stator"), ("rotor", "rotor"), ("stator", "rotor")])
def test_film_and_flows_are_those_of_the_surfaces(floating, narrow):
    base = fmr(fixed=0.0) if floating == "rotor" else fms()
    scene, tau = offset(base, narrow, coning=0.0), 3e-4
    found, plain = at(scene, DISPLACED, RATES), at(offset(base, narrow, coning=0.0, offset=0.0), DISPLACED, RATES)
    out = np.array([found["rotor_tilt_x"], found["rotor_tilt_y"]])

    def state(t):
        moved, turned = DISPLACED + RATES * (t - tau), SPEED * (t - tau)
        if floating == "rotor":
            return np.zeros(3), moved
        turn = np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]])
        return moved, np.array([0.0, *turn @ out])

    force, m_x, m_y, inner, outer = around(Surfaces(scene, state, tau))
    assert found["film_force"] == pytest.approx(force, rel=1e-6)
    for name, moment in (("film_moment_x", m_x), ("film_moment_y", m_y)):
        assert found[name] == pytest.approx(moment, abs=1e-5 * math.hypot(m_x, m_y))
    # Leakage counts inwards here.
    assert found["leakage_inner"] == pytest.approx(-inner, rel=1e-6)
    assert found["leakage_outer"] == pytest.approx(-outer, rel=1e-6)
    assert abs(found["leakage_inner"] / plain["leakage_inner"] - 1.0) > 1e-4
    if floating == "rotor" and narrow == "rotor":
        # The rigid stator is the wide ring: the film's force has an arm there.
        x, y = Surfaces(scene, state, tau).centre(tau)
        assert found["housing_moment_x"] == pytest.approx(m_x + y * force, rel=1e-6)
        assert found["housing_moment_y"] == pytest.approx(m_y - x * force, rel=1e-6)


def test_a_coned_film_feels_the_sliding():
    """Aligned and at rest: what the sliding does to a cone is all the moment there is."""
    scene, none = offset(fmr(fixed=0.0, own=0.0), "stator"), np.zeros(3)
    found = at(scene, none, none)
    force, m_x, m_y, _, _ = around(Surfaces(scene, lambda t: np.zeros((2, 3)), 3e-4))
    # The mean radius stands for all of the face, which is a fifth as wide.
    for name, moment in (("film_moment_x", m_x), ("film_moment_y", m_y)):
        assert found[name] == pytest.approx(moment, abs=0.05 * math.hypot(m_x, m_y))
    assert found["film_force"] == pytest.approx(force, rel=1e-5)


@pytest.mark.parametrize("narrow", ["stator", "rotor"])
def test_a_wide_ring_tilts_by_the_force_on_its_arm(narrow):
    """In time as its linear steady response says, and with the energy in balance."""
    name = {"stator": "fmr_reference", "rotor": "fms_reference"}[narrow]
    keys = {"film.offset": "0.1 mm", "film.narrow_face": narrow, "film.offset_direction": "30 deg"}
    scenario = sealdyn.example(name).with_(keys | {"run.turns": 30, "run.samples_per_turn": 64})
    result = sealdyn.run(scenario)
    model = Model(scenario.scene)
    steady, _, _ = model.segment().steady_motion()
    data = result.data.isel(time=slice(-64, None))
    ring = {"stator": "rotor", "rotor": "stator"}[narrow]
    expected = np.array([steady(t)[0][1:] for t in data.time.values])
    found = np.stack([data[f"{ring}_tilt_x"], data[f"{ring}_tilt_y"]], axis=1)
    assert np.abs(expected).max() > 1e-5
    np.testing.assert_allclose(found, expected, atol=0.03 * np.abs(expected).max())
    assert result.summary["energy_residual"] < 1e-6


@pytest.mark.parametrize(
    "name, keys",
    [
        ("gas_dam_reference", {}),
        ("upstream_pumping", {}),
        ("fmr_reference", {"film.model": "reynolds", "film.cavitation_pressure": 0}),
        ("fmr_reference", {"film.offset": "9 mm"}),
    ],
)
def test_other_films_and_widths_are_refused(name, keys):
    with pytest.raises(sealdyn.ScenarioError) as error:
        sealdyn.run(sealdyn.example(name).with_({"film.offset": "0.1 mm"} | keys))
    assert error.value.key == "film.offset"
