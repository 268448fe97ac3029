"""Ludwig & Allen's balance where the seat turns and the ring stands (FMS): inertia beside friction, in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scipy.optimize import brentq
from test_ludwig_released import integrals, ready_scene

from sealdyn.analysis import quasi_static
from sealdyn.closed_form import ludwig_allen as la
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.forces import SecondarySeal
from sealdyn.scene.rings import AxialRunout
from sealdyn.scene.scene import SceneError, counterpart
from sealdyn.studies._runner import run_study
from sealdyn.studies.sealing_number import released as free

# So narrow (dR/R = 0.008) that its film errs by 1e-5 from that of no width.
RING = quasi_static.Ring(viscosity=2e-3, shaft_speed=1500.0, face_width=0.5e-3)
TILT = 2.5e-3
ARM = RING.mean_radius * RING.spring_force
SCENARIO = SCENARIOS / "ludwig_allen.toml"


def nodding(force_ratio, share):
    """A stator over a rotor that runs out; the inertia of its nodding takes this share of R F_s, friction q."""
    scene = counterpart(ready_scene(RING, misalignment=TILT))
    inertia = share * ARM / (RING.shaft_speed**2 * TILT)
    stator = replace(scene.stator, transverse_inertia=inertia, polar_inertia=2 * inertia)
    return free.with_force_ratio(replace(scene, stator=stator), force_ratio)


def balanced(moment):
    """h0, h1 (m) of a film whose moment is `moment` times R F_s, by integrals over its half circle."""

    def over(e):
        load, sine, cosine = integrals(e)
        return math.hypot(sine, cosine) / load - moment

    e = brentq(over, 1e-6, 1 - 1e-6, xtol=1e-14)
    mean = math.sqrt(integrals(e)[0] * RING.group)
    return mean, e * mean


# Friction alone (inertia a thousandth), inertia alone (friction a millionth), and both.
CASES = {"no inertia": (1.45, 1e-3), "no friction": (1e6, 0.83), "both": (2.5, 0.75)}


@pytest.mark.core
@pytest.mark.parametrize("name", CASES)
def test_film_to_be_expected(name):
    """Friction and inertia at right angles: m^2 = (4/(pi q))^2 + (I w^2 gamma/(R F_s))^2, where the ring nods by the
    seat's tilt but for h1/R = 1e-5."""
    q, share = CASES[name]
    mean, amplitude, tilt = free.film_on(nodding(q, share))
    moment = math.hypot(4 / (math.pi * q), share * abs(tilt) / TILT)
    assert (mean, amplitude) == pytest.approx(balanced(moment), rel=1e-7)
    assert abs(abs(tilt) - TILT) <= amplitude / RING.mean_radius * (1 + 1e-9)
    # In the limits, closed: e^2 = (m^2 - pi^2/16)/(1 - pi^2/16), h0^2 F_s/(mu U dR^3) = e/(1 - e^2)^2.
    if name != "both":
        alone = 4 / (math.pi * q) if name == "no inertia" else share
        e = math.sqrt((alone**2 - math.pi**2 / 16) / (1 - math.pi**2 / 16))
        assert mean**2 / RING.group == pytest.approx(e / (1 - e * e) ** 2, rel=2e-2)
        guide = 0.0 if name == "no inertia" else -share
        assert la.film(q, guide, RING.group)[0] ** 2 / RING.group == pytest.approx(e / (1 - e * e) ** 2, rel=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_in_time_the_ring_keeps_that_film(name):
    """Three degrees of freedom, inertia, dry friction and both film moments, from 0.1 % beside it.  Measured: mean film
    3e-5 without inertia, 8e-6 without friction, 7e-5 with both."""
    scene = nodding(*CASES[name])
    mean, amplitude, _ = free.film_on(scene)
    start = (1.001 * mean, 1.001 * amplitude)
    told = free.released(free.started(scene, start), 16, last=1, accuracy=1e-5)
    assert told.status == "film", told.message
    assert told.mean_film[0] == pytest.approx(mean, rel=1e-4)
    assert told.amplitude[0] == pytest.approx(amplitude, rel=2.5e-4)
    assert abs(told.whirl) < 1e-4 and told.energy_residual < 5e-3


def test_a_mirror_of_the_ring_that_turns():
    """Without inertia the film is that of the seat that stands, its thinnest place as far on the other side."""
    stands = free.with_force_ratio(ready_scene(RING, misalignment=TILT), 1.45)
    one, other = free.film_on(stands), free.film_on(nodding(1.45, 1e-12))
    assert other[:2] == pytest.approx(one[:2], rel=1e-9)
    assert other[2] == pytest.approx(one[2].conjugate(), rel=1e-9)
    assert free.force_ratio_of(nodding(1.45, 0.5)) == pytest.approx(1.45, rel=1e-12)


def test_the_study_foresees_films_over_the_speed(tmp_path):
    """Over the speed friction's share stays and inertia's grows with its square; from m = pi/4 to 1 there is a film."""
    # The shipped ring as its counterpart: rotor and stator change places.
    text = SCENARIO.read_text().replace("[stator]\nmisalignment", "[ROTOR]\nrunout").replace("[rotor", "[stator")
    text = text.replace("[ROTOR]", "[rotor]").replace("rotor.z", "stator.z").replace("rotor.tilt", "stator.tilt")
    scenario = parse_scenario(text.replace("-0.59 um", "0.59 um"), "nodding", [])
    flags = {"force_ratios": 1.45, "starts": "closed form", "turns": 10}
    answer = run_study("sealing-number", scenario, tmp_path / "n.h5", flags=flags, workers=1)
    over = {name: np.array(values, dtype=float) for name, values in answer["over_speed"].items()}
    scene, q = scenario.scene, 4 / math.pi / (2 / math.pi)
    inertia, stiffness = scene.stator.transverse_inertia, scene.stator.support.tilt()[0]
    guide = (inertia * over["speed"] ** 2 - stiffness) * scene.rotor.runout / (0.06 * 100.8)
    assert over["moment_ratio"] == pytest.approx(np.hypot(4 / math.pi / q, guide), rel=1e-9)
    there = (over["moment_ratio"] > math.pi / 4) & (over["moment_ratio"] < 1)
    assert there.any() and (np.isfinite(over["mean_film"]) == there).all()
    row = answer["released"][0]
    assert row["status"] == "film" and row["foreseen"]["mean_film"] == pytest.approx(row["mean_film"][0], rel=5e-3)


GIVES = SecondarySeal(radius=0.06, friction_force=10.0, stiffness=1e6)


@pytest.mark.parametrize(
    "changes,key",
    [
        ({"speed": 10.0}, "speed"),
        ({"secondary_seal": GIVES}, "secondary_seal.stiffness"),
        ({"secondary_seal": None}, "secondary_seal"),
        ({"misalignment": 1e-5}, "misalignment"),
    ],
)
def test_other_rings_are_refused(changes, key):
    scene = nodding(2.0, 0.5)
    with pytest.raises(SceneError) as refused:
        free.ring_of(replace(scene, stator=replace(scene.stator, **changes)))
    assert refused.value.key == f"stator.{key}"
    with pytest.raises(SceneError) as refused:
        free.ring_of(replace(scene, rotor=replace(scene.rotor, axial_runout=[AxialRunout(order=1, amplitude=1e-6)])))
    assert refused.value.key == "rotor.axial_runout"
