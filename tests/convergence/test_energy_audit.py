"""The energy audit sees what it must: an equation that does not do what its works say."""

import numpy as np
import pytest
from command import SCENARIOS
from scenes import INERTIA, SPEED, SUPPORT, fmr, fms, fmsr, prepared, run

from sealdyn.archive import read_info
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.segments import Segment
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation import selection
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.run_error import EnergyAudit

K_S, D_S = SUPPORT.tilt()


def wrong(change):
    """A Model whose equation of motion is off by `change(y, rates' part)` while its works are as before."""

    class WrongSegment(Segment):
        native = None

        def __init__(self, *given):
            super().__init__(*given)
            self.right = Segment(*given)

        def rhs(self, tau, y, yp):
            self.right.rhs(tau, y, yp)
            tilt, rate = self.n - 2, self.n_mechanical - 2
            push = change(complex(*y[tilt : tilt + 2]), complex(*y[rate : rate + 2])) / INERTIA
            yp[rate] += push.real
            yp[rate + 1] += push.imag

        def derivatives(self, taus, ys):
            out = np.zeros((len(taus), self.size))
            for tau, y, yp in zip(taus, ys, out, strict=True):
                self.rhs(tau, y, yp)
            return out

    class Wrong(Model):
        def segment(self, interval=None, index=0, last=True, stuck=None):
            return WrongSegment(self, interval or self.start, index, last, stuck)

    return Wrong


MISTAKES = {
    "damper pushes": lambda g, v: 2 * D_S * v,
    "spring pushes": lambda g, v: 2 * K_S * g,
    "spring 1 % stiff": lambda g, v: -0.01 * K_S * g,
    "gyroscopic moment along the rate": lambda g, v: 0.01 * INERTIA * SPEED * v,
    "rotating damper forgotten": lambda g, v: -1j * SPEED * D_S * g,
}


@pytest.mark.core
@pytest.mark.parametrize("mistake", MISTAKES)
@pytest.mark.parametrize("scene", [fmr(), fms("linear")], ids=["fmr", "fms-linear"])
def test_a_wrong_force_is_exposed(scene, mistake):
    right = run(scene, turns=5, accuracy=1e-6, method="adams")
    found = run(scene, turns=5, accuracy=1e-6, method="adams", model_class=wrong(MISTAKES[mistake]))
    assert right.outcome.energy_residual < 2e-6
    # Ten times the accuracy is the line a sound run stays below.
    assert found.outcome.energy_residual > 10e-6


@pytest.mark.parametrize("mistake", MISTAKES)
def test_works_summed_over_the_steps_expose_it_too(mistake):
    """A tolerance at which the works among the unknowns hide the smallest mistake (2e-6 to 2e-5 of a right scene,
    1.4e-5 of a spring 1 % stiff): Adams takes 690 to 830 steps, as rounding decides, and the residual jumps with
    them."""

    def audited(model_class, tolerance=1.4e-6):
        ready, audit = prepared(fmr(), 30 * 2 * np.pi / SPEED, 1e-4, model_class=model_class), EnergyAudit()
        found = solve(ready, "adams", 1e-4, Recorder(), tolerance=tolerance, audit=audit).energy_residual
        return found, audit.worst[0] / audit.exchanged

    # The damped rotor forgets its errors, its works do not: the middle one of five neighbours is compared.
    right, by_unknowns = zip(
        *(audited(Model, tolerance) for tolerance in np.linspace(1.33e-6, 1.47e-6, 5)), strict=True
    )
    assert 3 * np.median(right) < np.median(by_unknowns)
    assert max(right) < 4e-6 < audited(wrong(MISTAKES[mistake]))[0]


def test_long_steps_are_audited_by_what_the_solver_worked_out():
    """Radau steps over large parts of a turn: its works are more exact than what the powers at its steps tell."""
    ready, audit = prepared(fmr(), 30 * 2 * np.pi / SPEED, 1e-4), EnergyAudit()
    found = solve(ready, "radau", 1e-4, Recorder(), audit=audit)
    assert 3 * audit.worst[0] < audit.worst[1] and found.energy_residual == audit.worst[0] / audit.exchanged


def test_a_run_that_loses_energy_is_inaccurate(tmp_path, monkeypatch):
    """Status, warning and archive say so, though the run is the exact one of its wrong equations."""
    monkeypatch.setattr(selection, "Model", wrong(MISTAKES["spring 1 % stiff"]))
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=5"])
    found = simulate(scenario, tmp_path / "a.h5")
    assert found.status == "inaccurate" == read_info(found.archive)["status"]
    assert "energy audit" in found.message and found.message in found.summary["warnings"]


@pytest.mark.parametrize("speed, turns", [("100 rpm", 3), ("9550 rpm", 20), ("50000 rpm", 20)])
def test_a_ring_that_stays_stuck_exchanges_nothing(tmp_path, speed, turns):
    """It turns with its shaft, its springs wound up: a rounding of their work is not measured by another."""
    sets = [
        "rotor.secondary_seal={radius='45 mm', friction_force='50 N'}",
        f"shaft.speed='{speed}'",
        f"run.turns={turns}",
    ]
    found = simulate(read_scenario(SCENARIOS / "fmr_reference.toml", sets), tmp_path / "a.h5")
    assert found.summary["secondary_seal"]["slips"] == 0
    assert found.status == "ok" and found.summary["energy_residual"] < 1e-9


@pytest.mark.core
def test_gyroscopic_moment_does_no_work():
    """Turning it the other way round is another seal, but no energy is missing: the audit is right to be silent."""
    turned = wrong(lambda g, v: -2j * INERTIA * 2 * SPEED * v)
    assert run(fmr(), turns=5, accuracy=1e-6, model_class=turned).outcome.energy_residual < 1e-5


def test_works_against_an_integral_of_the_trajectory():
    """Each work once more, by Simpson's rule over sampled states, from its formula written out here."""
    found = run(fmsr("linear"), turns=2, accuracy=1e-9, per_turn=4096)
    y = found.outcome.y
    damper = 0.0
    for name, spin in (("stator", 0.0), ("rotor", SPEED)):
        at = found.ready.model.unknowns.names.index(f"{name}_tilt_x")
        g, v = found.tilt(name), found.rates[:, at] + 1j * found.rates[:, at + 1]
        power = -D_S * ((v - 1j * spin * g) * np.conj(v)).real
        step = found.times[1] - found.times[0]
        damper += step / 3 * (power[0] + power[-1] + 4 * power[1:-1:2].sum() + 2 * power[2:-1:2].sum())
    assert y[found.ready.model.unknowns.n_mechanical] == pytest.approx(damper, rel=1e-7)
