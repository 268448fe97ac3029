"""A secondary seal that gives before it slides: energy of its loops, place by place, a stiff one, small motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from continued import differences, often, stopped
from scenes import SPEED, SUPPORT, fmr, fms, ring, run

from sealdyn.dynamics.linearisation import linear_scene
from sealdyn.dynamics.model import Model
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scenario.tables import Run
from sealdyn.scene.checks import check_scene
from sealdyn.scene.forces import FrictionElement, SecondarySeal, secondary_seal_errors
from sealdyn.scene.rings import AxialRunout, Rotor, Stator, stuck_support
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.simulate import simulate
from sealdyn.studies._runner import run_study

SCENARIO = SCENARIOS / "fms_reference.toml"
TURN = 2 * math.pi / SPEED
ONE = SecondarySeal(radius=0.04, friction_force=4.0, stiffness=1e6)
# Two more in parallel, one of them pins at a radius of their own.
MORE = [FrictionElement(stiffness=1e6, friction_force=3.0),
        FrictionElement(stiffness=5e5, friction_force=1.5, radius=0.05)]  # fmt: skip
SEALS = {"one": ONE, "three": replace(ONE, elements=MORE)}


def numbers(seal):
    """Radius, friction and stiffness of each element, as given."""
    own = [(seal.radius, seal.friction_force, seal.stiffness)]
    return own + [(one.radius or seal.radius, one.friction_force, one.stiffness) for one in seal.elements]


def on_stator(seal, **parts):
    return fms(stator=Stator(**ring(misalignment=0.0, **parts), secondary_seal=seal), own=0.0, runout=0.0)


def work_of_a_turn(scene, settled=5, accuracy=1e-5):
    """What the seal takes (J) in a turn of a settled run, and that run."""
    before, after = (run(scene, turns, accuracy) for turns in (settled, settled + 1))
    works = [one.outcome.y[one.model.unknowns.works][-1] for one in (before, after)]
    return works[0] - works[1], after


# --- energy of a cycle, in closed form ----------------------------------------------------------------------


@pytest.mark.core
@pytest.mark.parametrize("name", SEALS)
def test_a_cycle_of_axial_motion_takes_four_f_times_what_slides(name):
    """Iwan: sum of 4 F (X - F/k) over the elements with F/k < X, whatever goes on between the turning points.  Measured
    3e-6, what is left of the transient."""
    scene = replace(on_stator(SEALS[name]), rotor=Rotor(axial_runout=[AxialRunout(order=1, amplitude=8e-6)]))
    work, found = work_of_a_turn(scene)
    last, pressed = found.times > 4.99 * TURN, found["stator_seal_friction"]
    # Turning points from the parabola through the three samples next to each.
    z, ends = found.q[last, 0], []
    for sign in (1, -1):
        k = int(np.argmax(sign * z[1:-1])) + 1
        rise, bend = 0.5 * (z[k + 1] - z[k - 1]), z[k + 1] - 2 * z[k] + z[k - 1]
        ends.append(z[k] - 0.5 * rise**2 / bend)
    reach = 0.5 * (ends[0] - ends[1])
    expected = sum(4 * friction * max(reach - friction / k, 0.0) for _, friction, k in numbers(SEALS[name]))
    assert work == pytest.approx(expected, rel=3e-5)
    assert np.max(np.abs(pressed)) <= sum(f for _, f, _ in numbers(SEALS[name])) * (1 + 1e-12)
    assert found.outcome.energy_residual < 1e-6 and not found.events


@pytest.mark.parametrize("name", SEALS)
def test_a_turn_of_a_turning_tilt_takes_as_much_at_every_place(name):
    """A tilt A that turns moves each place by R A there and back: sum of 4 F (R A - F/k) a turn.  Measured: 3e-6."""
    scene = replace(on_stator(SEALS[name]), rotor=Rotor(runout=2e-4))
    work, found = work_of_a_turn(scene)
    tilt = np.abs(found.tilt("stator"))[found.times > 5 * TURN]
    assert np.ptp(tilt) < 2e-4 * tilt[0]
    expected = sum(4 * f * max(radius * tilt.mean() - f / k, 0.0) for radius, f, k in numbers(SEALS[name]))
    assert work == pytest.approx(expected, rel=1e-4)
    assert found.outcome.energy_residual < 1e-5


# --- force and moments of any motion ------------------------------------------------------------------------


def replayed(found, name, seal, spin, carried, own, count=720):
    """Force and moment (complex) of the seal along a run, by the play operator at `count` places of its circles."""
    z, g = found.q[:, found.model.unknowns.names.index(f"{name}_z")] - carried, found.tilt(name)
    turned = np.exp(1j * spin * found.times)
    e, theta = g / turned - own, 2 * np.pi * (np.arange(count) + 0.5) / count
    force, moment = np.zeros(len(z)), np.zeros(len(z), dtype=complex)
    for radius, friction, k in numbers(seal):
        s, slid = z[:, None] + radius * (np.outer(e.real, np.sin(theta)) - np.outer(e.imag, np.cos(theta))), 0.0
        for i in range(len(z)):
            slid = np.clip(slid, s[i] - friction / k, s[i] + friction / k)
            t = -k / count * (s[i] - slid)
            force[i] += t.sum()
            moment[i] += radius * (t @ np.sin(theta) - 1j * (t @ np.cos(theta)))
    return force, moment * turned


@pytest.mark.parametrize("name", ["rotor", "stator"])
def test_force_and_moments_are_those_of_the_places_one_by_one(name):
    """Axial motion and tilt at once, own misalignment, in a carrier that turns and in one that stands.  Measured: 0.6 %
    of the friction, what 24 places lack of a circle; against 24 of the same 2e-5."""
    seal, runout = SEALS["three"], [AxialRunout(order=2, amplitude=4e-6)]
    part = dict(**ring(misalignment=3e-5), secondary_seal=seal)
    if name == "rotor":
        scene, spin = fmr(fixed=1.5e-4, rotor=Rotor(**part, axial_runout=runout)), SPEED
    else:
        scene, spin = fms(stator=Stator(**part), rotor=Rotor(runout=1.5e-4, axial_runout=runout)), 0.0
    found = run(scene, 2, 1e-5, per_turn=600)
    carried = 4e-6 * np.cos(2 * SPEED * found.times) if name == "rotor" else 0.0
    force, moment = replayed(found, name, seal, spin, carried, 3e-5)
    most = sum(friction for _, friction, _ in numbers(seal))
    assert found[f"{name}_seal_friction"] == pytest.approx(force, abs=0.012 * most)
    found_moment = found[f"{name}_seal_moment_x"] + 1j * found[f"{name}_seal_moment_y"]
    assert np.max(np.abs(found_moment - moment)) < 0.012 * seal.breakaway()[1]
    # Some slides, some does not.
    stuck = found[f"{name}_seal_stuck"]
    assert stuck.min() < 0.5 and stuck.max() == 1.0 and found.outcome.energy_residual < 1e-5


def test_a_stiff_one_slides_as_one_that_sticks_rigidly():
    """With a stiffness that gives by 5e-5 of the motion.  Measured: 8e-4 of the tilt, what 24 places lack of a circle,
    where the friction moves it by 0.25."""
    rigid = SecondarySeal(radius=0.04, friction_force=10.0)
    scene, last = replace(on_stator(rigid), rotor=Rotor(runout=2e-4)), []
    for seal in (rigid, replace(rigid, stiffness=2e10), None):
        last.append(run(replace(scene, stator=replace(scene.stator, secondary_seal=seal)), 3, 1e-4).tilt("stator")[-1])
    assert abs(last[1] - last[0]) < 2.4e-3 * abs(last[0])
    assert abs(last[2] - last[0]) > 0.1 * abs(last[0])


# --- small motion -------------------------------------------------------------------------------------------


@pytest.mark.core
def test_a_small_motion_sees_springs():
    """While nothing slides, a run is that of stiffer supports, k and k R^2 / 2 of each element: to the accuracy."""
    seal, accuracy = SEALS["three"], 1e-6
    scene = replace(on_stator(seal), rotor=Rotor(runout=2e-5, axial_runout=[AxialRunout(order=2, amplitude=2e-7)]))
    axial = sum(k for _, _, k in numbers(seal))
    tilt = sum(0.5 * k * radius**2 for radius, _, k in numbers(seal))
    stiffer = replace(SUPPORT, axial_stiffness=SUPPORT.axial_stiffness + axial, radius=None,
                      tilt_stiffness=SUPPORT.tilt()[0] + tilt, tilt_damping=SUPPORT.tilt()[1])  # fmt: skip
    plain = replace(scene, stator=replace(scene.stator, secondary_seal=None, support=stiffer))
    assert vars(stuck_support(scene.stator)) == pytest.approx(vars(stiffer))
    one, other = (run(part, 2, accuracy) for part in (scene, plain))
    assert np.max(np.abs(one.scaled() - other.scaled())) < 2 * accuracy
    assert (one["stator_seal_stuck"] == 1.0).all() and not one["stator_seal_sliding_speed"].any()
    models = [Model(part, accuracy) for part in (scene, plain)]
    found, expected = (np.sort_complex(linear_scene(model, model.start).eigen()[0]) for model in models)
    assert found == pytest.approx(expected, rel=1e-12)


def test_studies_of_small_motion_take_it_for_springs(tmp_path):
    """Not left out, and the modes of a support stiffened by hand; a rigid one they refuse."""
    seal = ["stator.secondary_seal.radius=40 mm", "stator.secondary_seal.friction_force=4 N"]
    ways = {
        "given": [*seal, "stator.secondary_seal.stiffness=1 N/um"],
        "stiff": ["stator.support.axial_stiffness=1.5 N/um", "stator.support.radius=40 mm",
                  "stator.support.axial_damping=300 N*s/m"],
        "rigid": seal,
    }  # fmt: skip

    def modes_of(way):
        scenario = parse_scenario(SCENARIO.read_text(), way, ways[way])
        return run_study("campbell", scenario, tmp_path / f"{way}.h5", flags={"points": 5}, workers=1)

    found, expected = modes_of("given"), modes_of("stiff")
    assert found["left_out"] == [] and len(found["notes"]) == len(expected["notes"]) + 1
    assert len(found["modes"]) == len(expected["modes"]) > 1
    for one, other in zip(found["modes"], expected["modes"], strict=True):
        assert one["frequency"] == pytest.approx(other["frequency"], rel=1e-9)
    with pytest.raises(SceneError) as refused:
        modes_of("rigid")
    assert refused.value.key == "stator.secondary_seal"


def test_a_run_goes_on_to_the_bit(tmp_path, monkeypatch):
    often(monkeypatch.setattr)
    how = [
        "stator.secondary_seal.radius=40 mm",
        "stator.secondary_seal.friction_force=0.2 N",
        "stator.secondary_seal.stiffness=1 N/um",
        "rotor.runout=0.1 mrad",
        "run.turns=1",
        "run.accuracy=1e-4",
    ]
    scenario, out = parse_scenario(SCENARIO.read_text(), "fms", how), [tmp_path / name for name in ("a.h5", "b.h5")]
    simulate(scenario, out[0])
    count, _ = stopped(scenario, out[1], [3, 9])
    assert count and differences(*out) == []


# --- what it is ---------------------------------------------------------------------------------------------


def test_pins_break_away_at_their_own_radius():
    force, moment = SEALS["three"].breakaway()
    assert force == pytest.approx(8.5) and moment == pytest.approx(2 / math.pi * (7.0 * 0.04 + 1.5 * 0.05))
    assert SEALS["three"].reach() == pytest.approx(3e-6)


@pytest.mark.parametrize(
    "changes,keys",
    [
        (dict(stiffness=None, elements=MORE), ["stiffness"]),
        (dict(law="regularised", width=1e-3), ["stiffness"]),
        (dict(stiffness=0.0), ["stiffness"]),
        (dict(friction_force=0.0), ["friction_force"]),
        (dict(elements=[replace(MORE[0], radius=0.0, stiffness=-1.0)]), ["elements.0.radius", "elements.0.stiffness"]),
    ],
)
def test_faults_name_the_key(changes, keys):
    assert [fault[0] for fault in secondary_seal_errors(replace(ONE, **changes))] == keys
    assert not secondary_seal_errors(SEALS["three"])


def test_one_ring_that_sticks_rigidly_beside_one_that_gives_is_refused():
    both = replace(on_stator(ONE), rotor=Rotor(**ring(), secondary_seal=replace(ONE, stiffness=None)))
    with pytest.raises(SceneError) as refused:
        check_scene(both, Run(turns=1))
    assert refused.value.key == "rotor.secondary_seal.stiffness"
    check_scene(replace(both, rotor=replace(both.rotor, secondary_seal=ONE)), Run(turns=1))
