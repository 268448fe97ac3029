"""Studies of whirls over grooves: thresholds of plain ones by the closed form, two rings, maps, transmissibility beside
harmonic balance of the run's own film."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from grooved_faces import R_I, R_O, SEAL_TOML

from sealdyn import read_scenario, run_study
from sealdyn.closed_form import fmr_critical_speed
from sealdyn.films._grooved.aligned import aligned_film
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.patterns import Grooves
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene, frozen_at_start
from sealdyn.studies import _grooved_roots
from sealdyn.studies._grooved_roots import RootsOverSpeed, modes
from sealdyn.studies.transmissibility.arrangements import SEALS, Arrangement, seals_over_grooves

SUPPORT = Support(axial_stiffness=1.64e4, axial_damping=1e3, tilt_stiffness=31.0, tilt_damping=1.4)
RING = dict(mass=0.2, transverse_inertia=2e-3, polar_inertia=5e-4, support=SUPPORT)


@pytest.mark.core
def test_the_threshold_over_plain_grooves_is_the_closed_form():
    """A slender rotor on a liquid film."""
    film = Film(R_I, R_O, 5e5, 1e5, 1e-4, clearance=6e-6, coning=5e-4)
    plain = Grooves(12, 0.0, 0.0555, R_O, 0.5, angle=math.radians(15.0))
    scene = Scene(shaft=Shaft(speed=9e3), film=film, rotor=Rotor(grooves=[plain], **RING), stator=Stator())
    found = RootsOverSpeed(scene).threshold(9e3, 1.1e4)
    k, d = aligned_film(scene, 6e-6, 8).of_motion(lambda motion: np.array(motion.matrices(1.0)))[0]
    expected = fmr_critical_speed(
        transverse_inertia=2e-3, polar_inertia=5e-4, support_stiffness=31.0, support_damping=1.4,
        film_stiffness=k[1, 1], film_damping=d[1, 1],
    )  # fmt: skip
    assert found == pytest.approx(expected, rel=2e-3)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    """The seal of row gas_5bar on six grooves and coarse cells, with a closing force of its own."""
    text = SEAL_TOML.replace("count = 12", "count = 6").replace("[film]", "[film]\ngas_reynolds.columns = 6")
    path = tmp_path_factory.mktemp("grooves") / "six.toml"
    path.write_text(text, encoding="utf-8")
    return read_scenario(path)


def test_arrangements_over_grooves_are_those_of_harmonic_balance(scenario):
    """Of the run's whole circle, at the scenario's own speed; two rings, between which dampers that turn whirl beyond
    twice their natural frequency."""
    seals = seals_over_grooves(scenario.scene)
    for name in SEALS:
        found, expected = seals[name].relative_tilts(1000.0), Arrangement.relative_tilts(seals[name], 1000.0)
        assert np.abs(found) == pytest.approx(np.abs(expected), rel=6e-2)
        assert np.angle(found) == pytest.approx(np.angle(expected), abs=6e-2)
    natural = math.sqrt(31.0 / 3.5e-4)
    below, above = (seals["fmsr"].growth(w * natural) for w in (1.9, 2.1))
    assert below < 0.0 < above
    assert seals["fmsr"].critical_speed() == pytest.approx(2.0 * natural, rel=5e-3)
    assert seals["fms"].critical_speed() is None


def test_the_studies_of_whirls(scenario, tmp_path, monkeypatch):
    """Each with few speeds: one number by three ways."""
    monkeypatch.setattr(_grooved_roots, "SPEEDS", (0.9, 1.2, 3))
    critical = run_study("critical-speed", scenario, tmp_path / "s.h5", workers=1)
    assert critical["eigenvalue"] is None and len(critical["growth"]["speed"]) == 3
    flags = {"x": "shaft.speed=900,1000", "y": "stator.support.tilt_damping=0,1.4,20"}
    found = run_study("stability", scenario, tmp_path / "m.h5", flags=flags, workers=1)
    scene = frozen_at_start(scenario.scene)
    roots = modes(scene, aligned_film(scene, 3e-6, 8))
    tilt = max(root[0] for name, root in roots.items() if name.startswith("tilt_"))
    assert found["tilt_growth_rate"][1][1] == pytest.approx(tilt, rel=1e-9)
    assert np.all(np.diff([row[1] for row in found["tilt_growth_rate"]]) < 0.0)
    assert found["margins"]["verdict"] == "stable" and found["margins"]["critical_speed"] is None
    assert found["margins"]["growth_rate"] == pytest.approx(max(tilt, roots["axial"][0]), rel=1e-4)


def test_the_critical_speed_of_a_heavy_ring(monkeypatch, tmp_path):
    """Where the tilt's growth is zero."""
    monkeypatch.setattr(_grooved_roots, "SPEEDS", (2.5, 3.5, 2))
    heavy = {"stator.transverse_inertia": 5e-2, "rotor.grooves.0.count": 5, "film.clearance": 4e-6}
    scenario = read_scenario(SCENARIOS / "upstream_pumping.toml").with_(heavy)
    found = run_study("critical-speed", scenario, tmp_path / "s.h5", workers=1)
    (speed,) = found["thresholds"]
    roots = RootsOverSpeed(frozen_at_start(scenario.scene))
    assert found["eigenvalue"] == speed and roots.growth(0.97 * speed) < 0.0 < roots.growth(1.03 * speed)


def test_two_rings_have_twice_the_roots(scenario):
    """Between them, and together, where the film is not strained: the supports' own."""
    scene = seals_over_grooves(scenario.scene)["fmsr"].scene
    found = modes(scene, aligned_film(scene, 3e-6, 8))
    assert len([name for name in found if name.startswith(("axial", "tilt"))]) == 6
    assert abs(found["axial_together"][1]) < 1e-3 * abs(found["axial"][1])
    still = replace(scene, shaft=Shaft(speed=100.0))
    together = modes(still, aligned_film(still, 3e-6, 8))["tilt_forward_together"]
    # (I s^2 + D s + K) of both, the rotor's damper turning: 2 I s^2 + D (2 s - i W) + 2 K.
    expected = max(np.roots([2 * 3.5e-4, 2.8, 62.0 - 140j]), key=np.imag)
    assert complex(*together) == pytest.approx(expected, rel=2e-2)
