"""A ring that grows lighter tends to the massless ring: an ODE to its first-order limit."""

from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scenes import INERTIA, TILT_SCALE, film, fmr, fms, ring, run
from scipy.integrate import solve_ivp

from sealdyn.closed_form import film_coefficients
from sealdyn.scenario.reader import read_scenario
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.simulation.simulate import prepare_run, simulate
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

TURNS, PER_TURN = 2, 32


def lightened(build, share, model):
    """The ring with `share` of its mass and inertias."""
    light = ring(mass=share, transverse_inertia=share * INERTIA, polar_inertia=2 * share * INERTIA)
    scene = build(model)
    if build is fmr:
        return replace(scene, rotor=replace(scene.rotor, **light))
    return replace(scene, stator=replace(scene.stator, **light))


@pytest.mark.parametrize("model", ["linear", "radial"])
@pytest.mark.parametrize("build", [fmr, fms])
def test_light_ring_tends_to_the_massless_one_linearly(build, model):
    """CVODE's BDF with mass against IDA without: the difference is proportional to the mass."""
    name = "rotor" if build is fmr else "stator"
    limit = run(lightened(build, 0.0, model), turns=TURNS, accuracy=1e-9, method="ida", per_turn=PER_TURN)
    assert limit.outcome.status == "ok" and limit.ready.model.unknowns.massless
    shares, errors = np.array([1e-2, 3e-3, 1e-3, 3e-4]), []
    for share in shares:
        found = run(lightened(build, share, model), turns=TURNS, accuracy=1e-9, method="bdf", per_turn=PER_TURN)
        assert found.outcome.status == "ok"
        errors.append(np.max(np.abs(found.tilt(name) - limit.tilt(name))) / TILT_SCALE)
    slope = np.polyfit(np.log(shares), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.05)
    assert errors[-1] < 1e-4


@pytest.mark.core
def test_massless_ring_obeys_its_first_order_equation():
    """D gamma' + K gamma = ..., complex, from SciPy: FMR ring at rest, then dragged along."""
    c = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
    k_s, d_s, w = 400.0, 0.24, 1000.0

    def slope(t, y):
        g = complex(*y)
        push = (c.tilt_stiffness - 0.5j * w * c.tilt_damping) * (25e-6 - g)
        own = k_s * (g - 25e-6 * np.exp(1j * w * t)) - 1j * w * d_s * g
        rate = (push - own) / (d_s + c.tilt_damping)
        return [rate.real, rate.imag]

    found = run(lightened(fmr, 0.0, "linear"), turns=TURNS, accuracy=1e-9, method="ida", per_turn=PER_TURN)
    exact = solve_ivp(slope, (0, found.times[-1]), [0, 0], "DOP853", t_eval=found.times, rtol=1e-12, atol=1e-18).y
    assert np.max(np.abs(found.tilt("rotor") - exact[0] - 1j * exact[1])) < 1e-9 * TILT_SCALE


@pytest.mark.parametrize("build", [fmr, fms])
def test_massless_ring_without_damping_stands_in_balance_at_once(build):
    """No rate anywhere: K (gamma - own) = film, an algebraic answer at every instant."""
    nothing = dict(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0)
    light = ring(support=Support(axial_stiffness=5e5, radius=0.04), **nothing)
    stiff = film("linear", coefficients=Coefficients(5000.0, 0.0, 6e6, 0.0))
    own, partner, k_s, k_f = 25e-6, 10e-6, 400.0, 5000.0
    if build is fmr:
        scene = build(film=stiff, rotor=Rotor(**light, misalignment=own), stator=Stator(misalignment=partner))
    else:
        scene = build(film=stiff, stator=Stator(**light, misalignment=own), rotor=Rotor(runout=partner))
    found = run(scene, turns=1, accuracy=1e-8, method="ida", per_turn=PER_TURN, start="steady")
    turning = np.exp(1000j * found.times)
    own, partner = (own * turning, partner) if build is fmr else (own, partner * turning)
    expected = (k_s * own + k_f * partner) / (k_s + k_f)
    tilt = found.tilt("rotor" if build is fmr else "stator")
    assert found.ready.model.algebraic == [0, 1]
    assert np.max(np.abs(tilt - expected)) < 1e-8 * TILT_SCALE


class Events(Recorder):
    """What happened: kinds and times (s)."""

    def __init__(self):
        super().__init__()
        self.seen = []

    def event(self, segment, tau, event):
        self.seen.append((event["kind"], segment.time + tau))


def test_stick_slip_across_from_a_massless_ring():
    """A stator that sticks and slips on its O-ring, on a rotor without mass (IDA) and on a light one: the same events
    at the same times, but for a first slip of the rotor's inertia."""

    def events(share):
        size = {"mass": f"{share} kg", "transverse_inertia": f"{share * INERTIA} kg*m^2",
                "polar_inertia": f"{2 * share * INERTIA} kg*m^2"}  # fmt: skip
        stator = {"mass": "1 kg", "transverse_inertia": f"{INERTIA} kg*m^2", "polar_inertia": f"{2 * INERTIA} kg*m^2"}
        support = {"axial_stiffness": "5e5 N/m", "axial_damping": "300 N*s/m", "radius": "40 mm"}
        sets = [*(f"rotor.{key}='{value}'" for key, value in size.items()),
                *(f"stator.{key}='{value}'" for key, value in stator.items()),
                *(f"stator.support.{key}='{value}'" for key, value in support.items()),
                "stator.secondary_seal={radius='45 mm', friction_force='2 N'}", "stator.misalignment='100 urad'",
                "rotor.misalignment='60 urad'", "run.turns=4"]  # fmt: skip
        run, plan = prepare_run(read_scenario(SCENARIOS / "fmr_reference.toml", sets))
        method = plan.method
        sink = Events()
        assert solve(run, method, 1e-6, sink).status == "ok" and run.model.unknowns.massless == (share == 0.0)
        return [seen for seen in sink.seen if seen[1] > 1e-5]

    massless, light = events(0.0), events(1e-3)
    assert len(massless) > 5 and [kind for kind, _ in massless] == [kind for kind, _ in light]
    assert np.array([t for _, t in massless]) == pytest.approx(np.array([t for _, t in light]), rel=1e-3)


def test_forces_that_do_not_tell_a_rate_fail_the_run(tmp_path):
    """At a shaft speed of rounding size the rates by which these are differenced move nothing."""
    scenario = read_scenario(SCENARIOS / "massless_ring.toml", ["shaft.speed=1e-24", "run.turns=0.5"])
    found = simulate(scenario, tmp_path / "x.h5")
    assert found.status == "failed" and "how fast a ring without mass moves" in found.message
