"""Equations of motion against their complex form (Green 1989), written out here, at random states of all scenes."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import SPEED, SUPPORT, film, ring, started

from sealdyn.dynamics.equations import PLAIN, WORKS
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing, Shaft, Whirl
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import AxialRunout, Rotor, Stator
from sealdyn.scene.scene import Scene

K_F, D_F, K_FZ, D_FZ = 5300.0, 3.7, 6.1e6, 5200.0
FILM = film("linear", coefficients=Coefficients(K_F, D_F, K_FZ, D_FZ))
SHAKING = Housing(
    axial=[AxialVibration(frequency=130.0, displacement=2e-6, phase=0.4)],
    angular=[AngularVibration(frequency=210.0, acceleration=60.0, direction=0.8, phase=-0.3)],
)
SHAFT = Shaft(speed=SPEED, whirl=[Whirl(ratio=0.42, angle=30e-6, phase=0.5), Whirl(ratio=-1.3, angle=10e-6)])
RUNOUT = [AxialRunout(order=2, amplitude=1e-6, phase=0.7)]
OWN_S, OWN_R = dict(misalignment=25e-6, misalignment_direction=0.3), dict(misalignment=20e-6, misalignment_phase=1.1)
FLEXIBLE_S = Stator(**ring(mass=0.8, transverse_inertia=7e-4, polar_inertia=1.1e-3), **OWN_S)
FLEXIBLE_R = Rotor(**ring(), **OWN_R, axial_runout=RUNOUT)
RIGID_R = Rotor(runout=15e-6, runout_phase=-0.6, axial_runout=RUNOUT)
SCENES = {
    "FMS": dict(stator=FLEXIBLE_S, rotor=RIGID_R),
    "FMR": dict(stator=Stator(**OWN_S), rotor=FLEXIBLE_R),
    "FMSR": dict(stator=FLEXIBLE_S, rotor=FLEXIBLE_R),
    "counter-rotating FMSR": dict(stator=replace(FLEXIBLE_S, speed=-400.0), rotor=FLEXIBLE_R),
    "counter-rotating FMS": dict(stator=replace(FLEXIBLE_S, speed=-400.0), rotor=RIGID_R),
    "counter-rotating rigid stator": dict(stator=Stator(**OWN_S, speed=-400.0), rotor=FLEXIBLE_R),
    "run-up FMSR": dict(
        stator=FLEXIBLE_S, rotor=FLEXIBLE_R,
        shaft=replace(SHAFT, speed=PiecewiseLinear((0.0, 0.1), (500.0, 1500.0))),
    ),
}  # fmt: skip
TAU = 0.0371
# Of the support, along the axis and about a diameter.
K_Z, D_Z = SUPPORT.axial_stiffness, SUPPORT.axial_damping
K_S, D_S = K_Z * 0.04**2 / 2, D_Z * 0.04**2 / 2


def segment_of(name, film_table=FILM):
    return started(Scene(**(dict(shaft=SHAFT, film=film_table, housing=SHAKING) | SCENES[name])), 0.1).segment(0)


def random_state(segment, seed):
    """Displacements and rates of the size of their scales; works are numbers of no matter."""
    return np.random.default_rng(seed).normal(size=segment.size) * segment.scales * 0.3


class Oracle:
    """Green's (1989) equation in complex tilt: carriers, film wrench and accelerations at one instant."""

    def __init__(self, scene, t, states):
        self.scene, self.t, self.states = scene, t, states
        speed = scene.shaft.speed
        if isinstance(speed, PiecewiseLinear):
            self.w_r, self.turned = 500.0 + 1e4 * t, 500.0 * t + 5e3 * t**2
        else:
            self.w_r, self.turned = speed, speed * t
        self.w_s = scene.stator.speed
        self.spin, self.angle = (self.w_s, self.w_r), (self.w_s * t, self.turned)
        self.carriers = self.stator_carrier(), self.rotor_carrier()
        self.own = self.turning(0, 25e-6, 0.3), self.turning(1, 20e-6, 1.1)

    def turning(self, k, amplitude, phase, order=1.0):
        """A vector that turns with carrier k, and its rate."""
        vector = amplitude * np.exp(1j * (order * self.angle[k] + phase))
        return vector, 1j * order * self.spin[k] * vector

    def stator_carrier(self):
        w_z, w_a = 2 * np.pi * 130.0, 2 * np.pi * 210.0
        z, z_rate = 2e-6 * np.cos(w_z * self.t + 0.4), -2e-6 * w_z * np.sin(w_z * self.t + 0.4)
        # Acceleration 60 cos(...): displacement -60/w^2 cos(...).
        tilt = -60.0 / w_a**2 * np.cos(w_a * self.t - 0.3) * np.exp(0.8j)
        rate = 60.0 / w_a * np.sin(w_a * self.t - 0.3) * np.exp(0.8j)
        if self.scene.stator.support is None:
            fixed = self.turning(0, 25e-6, 0.3)
            tilt, rate = tilt + fixed[0], rate + fixed[1]
        return z, z_rate, tilt, rate

    def rotor_carrier(self):
        z = 1e-6 * np.cos(2 * self.turned + 0.7)
        z_rate = -2e-6 * self.w_r * np.sin(2 * self.turned + 0.7)
        parts = [self.turning(1, 30e-6, 0.5, 0.42), self.turning(1, 10e-6, 0.0, -1.3)]
        if self.scene.rotor.support is None:
            parts.append(self.turning(1, 15e-6, -0.6))
        return z, z_rate, sum(p[0] for p in parts), sum(p[1] for p in parts)

    def state(self, k):
        """z, z', gamma, gamma' of ring k: its own if it floats, its carrier's if rigid."""
        return self.states.get(k, self.carriers[k])

    def film(self):
        """F - F_0 and M on the stator."""
        s, r = self.state(0), self.state(1)
        dz, dz_rate, g, g_rate = (s[i] - r[i] for i in range(4))
        wedge = 0.5j * (self.w_s + self.w_r) * g
        return -K_FZ * dz - D_FZ * dz_rate, -(K_F * g + D_F * (g_rate - wedge))

    def accelerations(self, k):
        body = (self.scene.stator, self.scene.rotor)[k]
        sign, w = (1, -1)[k], self.spin[k]
        z, v, g, g_rate = self.state(k)
        z_c, v_c, g_c, g_c_rate = self.carriers[k]
        force, moment = self.film()
        axial = sign * force - D_Z * (v - v_c) - K_Z * (z - z_c)
        angular = sign * moment + 1j * body.polar_inertia * w * g_rate
        angular -= D_S * (g_rate - g_c_rate - 1j * w * (g - g_c)) + K_S * (g - g_c - self.own[k][0])
        return axial / body.mass, angular / body.transverse_inertia


def states_of(segment, y):
    states = {}
    for k, name in enumerate(("stator", "rotor")):
        if segment.model.unknowns.floats[k]:
            z, x = segment.model.unknowns.names.index(f"{name}_z"), segment.model.unknowns.names.index(f"{name}_tilt_x")
            z_rate, x_rate = segment.model.unknowns.rate_places[[z, x]]
            states[k] = y[z], y[z_rate], complex(*y[x : x + 2]), complex(*y[x_rate : x_rate + 2])
    return states


@pytest.mark.core
@pytest.mark.parametrize("name", SCENES)
def test_right_hand_side_against_the_complex_form(name):
    segment = segment_of(name)
    for seed in range(10):
        y, yp = random_state(segment, seed), np.empty(segment.size)
        segment.rhs(TAU, y, yp)
        states = states_of(segment, y)
        found = states_of(segment, yp)
        oracle = Oracle(segment.model.scene, TAU, states)
        for k, (_, v, _, g_rate) in states.items():
            acceleration, angular = oracle.accelerations(k)
            assert found[k][0] == v and found[k][2] == g_rate
            # F - F_0 is a difference of two forces of 1000 N: 1e-12 of the acceleration's scale.
            assert abs(found[k][1] - acceleration) < 1e-12 * 1e3
            assert found[k][3] == pytest.approx(angular, rel=1e-12, abs=1e-10)


@pytest.mark.parametrize("model", ["linear", "radial"])
@pytest.mark.parametrize("name", SCENES)
def test_residual_is_the_same_equation(name, model):
    segment = segment_of(name, FILM if model == "linear" else film())
    y, yp, res = random_state(segment, 1) * 0.3, np.empty(segment.size), np.empty(segment.size)
    segment.rhs(TAU, y, yp)
    segment.residual(TAU, y, yp, res)
    assert np.max(np.abs(res) / (1e-300 + np.abs(yp))) < 1e-13
    # And it is one: a wrong derivative is left over as it is.
    wrong = yp + segment.scales * np.arange(1, segment.size + 1)
    segment.residual(TAU, y, wrong, res)
    assert np.allclose(res, wrong - yp, rtol=1e-9, atol=1e-12)


def test_residual_of_a_massless_ring_is_its_force_balance():
    """Mass times acceleration plus the massless residual is zero for the acceleration of the ring with mass."""
    massive = segment_of("FMR")
    weightless = replace(FLEXIBLE_R, mass=0.0, transverse_inertia=0.0, polar_inertia=0.0)
    light = started(replace(massive.model.scene, rotor=weightless), 0.1)
    y, yp, res = random_state(massive, 2), np.empty(massive.size), np.empty(light.model.unknowns.size)
    massive.rhs(TAU, y, yp)
    q_rate = y[massive.rate_places]
    light.segment(0).residual(TAU, light.model.vector(y[:3], []), np.concatenate([q_rate, np.zeros(6)]), res)
    # The gyroscopic moment goes with the polar inertia.
    body, i = massive.model.scene.rotor, massive.rate_places
    gyroscopic = 1j * body.polar_inertia * SPEED * complex(*q_rate[1:])
    assert res[0] == pytest.approx(body.mass * yp[i[0]], rel=1e-9)
    assert complex(*res[1:3]) == pytest.approx(body.transverse_inertia * complex(*yp[i[1:]]) - gyroscopic, rel=1e-10)


@pytest.mark.parametrize("name", SCENES)
def test_energy_and_works_against_the_complex_form(name):
    """Energy, the power of each element, and their balance dE/dt = sum of powers."""
    segment = segment_of(name)
    for seed in range(5):
        y, yp = random_state(segment, seed), np.empty(segment.size)
        segment.rhs(TAU, y, yp)
        states, energy, change = states_of(segment, y), 0.0, 0.0
        powers = dict.fromkeys(WORKS[:PLAIN], 0.0)
        oracle = Oracle(segment.model.scene, TAU, states)
        force, moment = oracle.film()
        opening = segment.model.closing.over(segment.interval, segment.model.scene.film)[0]
        for k, (z, v, g, g_rate) in states.items():
            body, sign, w = (segment.model.scene.stator, segment.model.scene.rotor)[k], (1, -1)[k], oracle.spin[k]
            z_c, v_c, g_c, g_c_rate = oracle.carriers[k]
            own, own_rate = oracle.own[k]
            stretch, bend = z - z_c, g - g_c - own
            energy += 0.5 * (body.mass * v**2 + K_Z * stretch**2)
            energy += 0.5 * (body.transverse_inertia * abs(g_rate) ** 2 + K_S * abs(bend) ** 2)
            a, angular = oracle.accelerations(k)
            change += body.mass * v * a + K_Z * stretch * (v - v_c)
            change += (body.transverse_inertia * np.conj(g_rate) * angular).real
            change += (K_S * np.conj(bend) * (g_rate - g_c_rate - own_rate)).real
            slip = g_rate - g_c_rate - 1j * w * (g - g_c)
            powers["support_damper"] -= D_Z * (v - v_c) * v + D_S * (np.conj(slip) * g_rate).real
            powers["film"] += sign * ((opening + force) * v + (np.conj(moment) * g_rate).real)
            powers["closing"] -= sign * opening * v
            powers["carrier"] -= K_Z * stretch * v_c + K_S * (np.conj(bend) * (g_c_rate + own_rate)).real
        found = yp[segment.n_mechanical :]
        size = found[5]
        assert segment.energies(np.array([TAU]), y[None, :])[0] == pytest.approx(energy, rel=1e-12)
        assert np.allclose(found[:5], list(powers.values()), rtol=0, atol=1e-12 * size)
        assert found[:5].sum() == pytest.approx(change, abs=1e-12 * size)
        assert size >= np.abs(found[:5]).sum()


def test_jacobian_is_the_slope_of_the_right_hand_side():
    """Linear scene: the Jacobian from steps is the exact matrix, here from differences of whole states."""
    segment = segment_of("FMSR")
    jac, y = np.empty((segment.size, segment.size)), random_state(segment, 3)
    segment.jacobian(TAU, y, np.empty(segment.size), jac)
    base, moved = np.empty(segment.size), np.empty(segment.size)
    segment.rhs(TAU, y, base)
    step = np.zeros(segment.size)
    step[: segment.n_mechanical] = random_state(segment, 4)[: segment.n_mechanical]
    segment.rhs(TAU, y + step, moved)
    n = segment.n_mechanical
    assert np.allclose((jac @ step)[:n], (moved - base)[:n], rtol=1e-5, atol=1e-5 * np.max(np.abs(base)))
