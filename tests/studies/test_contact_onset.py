"""Contact onset of the reference seals: formula, continuation, and plain runs that touch just above, not just below."""

from pathlib import Path

import numpy as np
import pytest

import sealdyn
from sealdyn import closed_form as cf
from sealdyn.films import radial
from sealdyn.orbit import Shooter
from sealdyn.problem import Problem
from sealdyn.recorder import Recorder
from sealdyn.scenario_study import varied
from sealdyn.solve import solve
from sealdyn.studies.contact_onset import onset

SCENARIOS = Path(__file__).parents[2] / "scenarios"
CASES = {
    "fms": ("fms_reference", "rotor.runout", ["stator.misalignment=0"]),
    "fmr": ("fmr_reference", "stator.misalignment", []),
}


@pytest.fixture(scope="module", params=sorted(CASES))
def found(request):
    name, key, overrides = CASES[request.param]
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml", overrides)
    point = {"text": scenario.text, "name": name, "overrides": overrides, "key": key, "margin": 1e-3,
             "tolerance": 1e-6, "set": {}, "floor": False}  # fmt: skip
    return request.param, scenario, key, onset(point)


def test_linear_onset_is_the_formula(found):
    arrangement, scenario, _, answer = found
    film, ring = scenario.scene.film, scenario.scene.stator if arrangement == "fms" else scenario.scene.rotor
    faces = dict(
        inner_radius=film.inner_radius, outer_radius=film.outer_radius, clearance=film.clearance, coning=film.coning
    )
    c = cf.radial_film_coefficients(**faces, viscosity=film.viscosity, pressure_drop=5e5, geometry="cylindrical")
    stiffness, damping = ring.support.tilt()
    numbers = dict(speed=1000.0, transverse_inertia=ring.transverse_inertia, polar_inertia=ring.polar_inertia,
                   support_stiffness=stiffness, support_damping=damping, film_stiffness=c.tilt_stiffness,
                   film_damping=c.tilt_damping)  # fmt: skip
    tilt = cf.contact_tilt(**faces)
    if arrangement == "fms":
        expected = cf.critical_forcing(tilt, 0.0, cf.fms_dynamic(**numbers))
    else:
        expected = cf.critical_forcing(tilt, cf.fmr_dynamic(**numbers) * 25e-6, cf.fmr_static(**numbers))
    assert answer["formula"] == pytest.approx(expected, rel=1e-8)
    assert radial.RUNG == 2


def test_the_film_postpones_contact_by_forty_per_cent(found):
    arrangement, _, _, answer = found
    # Measured 1.4244 (FMS, runout alone) and 1.4082 (FMR).
    assert answer["ratio"] == pytest.approx({"fms": 1.4244, "fmr": 1.4082}[arrangement], abs=1e-3)
    assert answer["radius"] == 0.032
    assert answer["axial_opening"] > 0.3


def test_plain_runs_touch_just_above_and_not_just_below(found):
    """From the touching orbit itself, so that no start-up transient decides."""
    _, scenario, key, answer = found
    for part, status in ((0.995, "ok"), (1.005, "collapsed")):
        scene = varied(scenario, {key: part * answer["nonlinear"], "run.start": '"steady"'}).scene
        shooter = Shooter(scene, 1e-7, tight=1e-10)
        problem = Problem(scene, 40 * shooter.period, 1e-6)
        start = np.array(answer["start"])
        # Below, the orbit lies within a trial of Newton; above, the film must be reached from the touching one.
        problem.y0[: len(start)] = shooter.find(start).start if status == "ok" else start
        outcome = solve(problem, "adams", 1e-6, Recorder(problem))
        assert outcome.status == status, (part, problem.records[0, 0])
