"""Contact onset of the reference seals: formula, continuation, and plain runs that touch just above, not just below."""

import numpy as np
import pytest
from command import SCENARIOS
from oracles import contact_tilt
from scenes import started

import sealdyn
from sealdyn import closed_form as cf
from sealdyn.analysis import orbit_path
from sealdyn.analysis.orbit_path import Follower
from sealdyn.analysis.shooting import Shooter, TooMuchWork
from sealdyn.archive import read_study
from sealdyn.dynamics.model import Model
from sealdyn.report.panels import sheet_of
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario, with_values
from sealdyn.scene import scene as scenes
from sealdyn.simulation.margin import aligned_flow, limit_of_forcing, linear_films, linear_onset
from sealdyn.simulation.plausibility import FAST, leakage_numbers
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.studies import contact_onset
from sealdyn.studies._runner import run_study
from sealdyn.studies.contact_onset import Settings, onset

POINT = {"margin": 1e-3, "tolerance": 1e-5, "most": 1e3, "set": {}, "floor": False}
CASES = {
    "fms": ("fms_reference", "rotor.runout", ["stator.misalignment=0"]),
    "fmr": ("fmr_reference", "stator.misalignment", []),
}


@pytest.fixture(scope="module", params=["fmr", pytest.param("fms", marks=pytest.mark.slow)])
def found(request):
    name, key, overrides = CASES[request.param]
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml", overrides)
    return request.param, scenario, key, onset(scenario, {"key": key, **POINT})


@pytest.mark.core
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
    tilt = contact_tilt(**faces)
    if arrangement == "fms":
        expected = cf.critical_forcing(tilt, 0.0, cf.fms_dynamic(**numbers))
    else:
        expected = cf.critical_forcing(tilt, cf.fmr_dynamic(**numbers) * 25e-6, cf.fmr_static(**numbers))
    assert answer["formula"] == pytest.approx(expected, rel=1e-8)


def test_the_film_postpones_contact_by_forty_per_cent(found):
    arrangement, _, _, answer = found
    # Measured 1.4244 (FMS, runout alone) and 1.4082 (FMR).
    assert answer["ratio"] == pytest.approx({"fms": 1.4244, "fmr": 1.4082}[arrangement], abs=1e-3)
    assert answer["radius"] == 0.032
    assert answer["axial_opening"] > 0.3


@pytest.mark.parametrize("found", ["fmr"], indirect=True)
def test_plain_runs_touch_just_above_and_not_just_below(found):
    """From the touching orbit itself, so that no start-up transient decides; a stator is followed by the same code."""
    _, scenario, key, answer = found
    for part, status in ((0.995, "ok"), (1.005, "collapsed")):
        scene = with_values(scenario, {key: part * answer["nonlinear"], "run.start": "steady"}).scene
        shooter = Shooter(scene, 1e-6, tight=1e-9)
        ready = started(scene, 40 * shooter.period, 1e-6)
        start = np.array(answer["start"])
        # Below, the orbit lies within a trial of Newton; above, the film must be reached from the touching one.
        if status == "ok":
            below = shooter.find(start)
            start = below.start
            # The touching orbit itself attracts, about as its neighbour does.
            assert answer["multiplier"] < 1
            assert answer["multiplier"] == pytest.approx(np.max(np.abs(below.multipliers)), rel=0.2)
        ready.y0[: len(start)] = start
        outcome = solve(ready, "adams", 1e-6, Recorder())
        assert outcome.status == status, (part, ready.extrema.records[0, 0])


@pytest.mark.parametrize("found", ["fmr"], indirect=True)
def test_rough_faces_touch_where_their_asperities_meet(found):
    """The steady orbit of a run at the onset comes down to three rms roughnesses, and no asperity carries yet."""
    contact = 'contact={roughness="0.3 um", compressive_strength="300 MPa"}'
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml", [contact])
    answer = onset(scenario, {"key": "stator.misalignment", **POINT})
    scene = with_values(scenario, {"stator.misalignment": answer["nonlinear"], "run.start": "steady"}).scene
    orbit = Shooter(scene, 1e-8, tight=1e-10).find(np.array(answer["start"]))
    assert orbit.extremes["h_min"]["value"] == pytest.approx(0.9e-6, abs=1e-5 * 1e-5)
    *_, alone = found
    assert answer["nonlinear"] < 0.9 * alone["nonlinear"] and answer["formula"] < 0.95 * alone["formula"]


def test_an_onset_far_away_is_not_followed():
    """A forcing of a nanoradian: linear theory says by how much it may grow, and nothing else is done."""
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml", ["stator.misalignment=1e-9"])
    row = onset(scenario, {"key": "stator.misalignment", **POINT})
    assert "failed" in row and "path" not in row
    assert row["times_own"] == pytest.approx(row["formula"] / 1e-9) and row["times_own"] > 1e6


def test_a_seal_that_never_touches_has_the_films_of_linear_theory():
    """h_min falls by the same for each step of the runout: the response is linear in it."""
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml", ["stator.misalignment=0", "rotor.runout=1e-6"])

    def scene(value):
        return with_values(scenario, {"rotor.runout": value, "run.start": "steady"}).scene

    answer = linear_films(scene, "rotor.runout", 0.0, scenario.scene)
    forcing, h_min = np.array(answer["linear"]["forcing"]), np.array(answer["linear"]["h_min"])
    assert answer["linear"]["own"] == 1e-6 and forcing[0] == 0.0 and forcing[-1] == pytest.approx(1e-5)
    assert h_min[0] == pytest.approx(answer["clearance"], rel=1e-12) and np.all(np.diff(h_min) < 0)
    np.testing.assert_allclose(np.diff(h_min), h_min[1] - h_min[0], rtol=1e-3)


PUMP = """
shaft.speed = "2950 rpm"
rotor.runout = "20 um TIR"
closing = { balance_ratio = 0.75, spring_force = "40 N" }
film = { inner_radius = "25 mm", outer_radius = "30 mm", coning = "0.4 mrad", viscosity = "0.8 mPa*s", \
outer_pressure = "11 bar", inner_pressure = "1 bar" }
[stator]
mass = "120 g"
transverse_inertia = "5e-5 kg*m^2"
support = { axial_stiffness = "30 N/mm", axial_damping = "50 N*s/m", radius = "27 mm" }
"""


def test_an_onset_beyond_any_small_tilt_is_an_answer(tmp_path):
    """A stiff film follows its rotor: the onset of linear theory by the closed form, no orbit, and nothing failed."""
    scenario = parse_scenario(PUMP, "pump")
    answer = run_study("contact-onset", scenario, tmp_path / "c.h5", workers=1)
    faces = dict(inner_radius=0.025, outer_radius=0.030, clearance=answer["clearance"], coning=4e-4)
    c = cf.radial_film_coefficients(**faces, viscosity=8e-4, pressure_drop=1e6, geometry="cylindrical")
    numbers = dict(speed=2950 * np.pi / 30, transverse_inertia=5e-5, polar_inertia=0.0,
                   support_stiffness=3e4 * 0.027**2 / 2, support_damping=50 * 0.027**2 / 2,
                   film_stiffness=c.tilt_stiffness, film_damping=c.tilt_damping)  # fmt: skip
    expected = contact_tilt(**faces) / cf.fms_dynamic(**numbers)
    assert answer["formula"] == pytest.approx(expected, rel=1e-5) and expected > 0.5
    assert answer["status"] == "ok" and answer["nonlinear"] is None and answer["beyond_tilt"] < answer["formula"]
    assert "path" not in answer and answer["times_own"] == pytest.approx(answer["formula"] * 0.060 / 20e-6)
    # Its own tilt ends it: that of the ring, which is what the film makes of the rotor's less what it does not.
    w, k, d = numbers["speed"], numbers["film_stiffness"], numbers["film_damping"]
    film = k + 0.5j * w * d
    ring = numbers["support_stiffness"] - 5e-5 * w**2 + 1j * w * numbers["support_damping"]
    assert answer["linear_limit"]["by"] == "small tilts"
    assert answer["linear_limit"]["value"] == pytest.approx(0.02 / max(1.0, abs(film / (ring + film))), rel=1e-4)


@pytest.mark.core
def test_a_gas_is_slow_no_more_before_its_faces_touch():
    """Edges open as much as they close; the Mach number of the mean flow grows with the square of the gap, up to where
    the program takes a gas for slow."""
    read = sealdyn.read_scenario(SCENARIOS / "gas_reynolds_reference.toml", ["stator.misalignment=0"])

    def scene(value):
        return scenes.with_values(read.scene, {"rotor.runout": value})

    formula, touching = linear_onset(scene, "rotor.runout")
    model = Model(scene(0.0), 1e-6)
    (r_i, h_i), (r_o, h_o) = sorted(model.aligned_gaps())
    per = (h_i if touching == r_i else h_o) / (formula * touching)
    mach = leakage_numbers(model, aligned_flow(model, model.start)[0])[1]
    room = (FAST / mach) ** 0.5 - 1.0
    found = limit_of_forcing(lambda value: Model(scene(value), 1e-6), formula)
    assert found["by"] == "slow gas" and found["value"] < 0.1 * formula
    assert found["value"] == pytest.approx(min(h_i * room / (r_i * per), h_o * room / (r_o * per)), rel=1e-6)
    assert limit_of_forcing(lambda value: Model(scene(value), 1e-6), 0.5 * found["value"]) is None


def test_orbits_are_not_followed_beyond_any_small_tilt(tmp_path):
    """Linear theory touches within small tilts, the orbits, which open the gap, at none of them: 23 mrad were said."""
    changes = ["rotor.support.axial_stiffness=3e4", "rotor.support.axial_damping=130", "rotor.misalignment=0"]
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml", changes)
    answer = run_study("contact-onset", scenario, tmp_path / "c.h5", workers=1)
    assert answer["status"] == "ok" and answer["nonlinear"] is None
    assert answer["formula"] < answer["beyond_tilt"] == max(answer["path"]["forcing"])


@pytest.mark.parametrize(
    "name, overrides, keys",
    [
        ("fms_reference", ["stator.misalignment=1e-5"], ["rotor.runout", "stator.misalignment"]),
        ("fms_reference", ["rotor.runout=0", "stator.misalignment=1e-5"], ["stator.misalignment", "rotor.runout"]),
        ("fmr_reference", [], ["stator.misalignment", "rotor.misalignment"]),
        ("fmr_reference", ["stator.misalignment=0"], ["rotor.misalignment", "stator.misalignment"]),
        ("fmsr_both_flexible", ["stator.misalignment=0", "rotor.misalignment=1e-5"],
         ["rotor.misalignment", "stator.misalignment"]),
        ("fmsr_both_flexible", ["stator.misalignment=1e-5", "rotor.misalignment=0"],
         ["stator.misalignment", "rotor.misalignment"]),
    ],
)  # fmt: skip
def test_the_key_that_grows_is_a_tilt_that_the_seal_has(name, overrides, keys):
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml", overrides)
    assert contact_onset.acting(scenario.scene) == keys


@pytest.mark.parametrize("name, key", [("fmr_reference", "rotor.runout"), ("fms_reference", "rotor.misalignment"),
                                       ("fmsr_both_flexible", "rotor.runout")])  # fmt: skip
def test_a_key_that_the_seal_does_not_use_is_refused(name, key, tmp_path):
    scenario = sealdyn.read_scenario(SCENARIOS / f"{name}.toml")
    with pytest.raises(ScenarioError) as refused:
        run_study("contact-onset", scenario, tmp_path / "c.h5", flags={"key": key}, workers=1)
    assert refused.value.key == "study.contact_onset.key" and key in refused.value.found
    assert contact_onset.acting(scenario.scene)[0] in refused.value.expected


def test_a_figure_shows_why_an_onset_is_not_followed(tmp_path):
    """Linear theory's line from the clearance to touch, and where the scenario is on it."""
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml", ["stator.misalignment=1e-7"])
    answer = run_study("contact-onset", scenario, tmp_path / "c.h5", workers=1)
    assert answer["status"] == "failed" and answer["nonlinear"] is None
    (panel,) = read_study(tmp_path / "c.h5")["panels"]
    (line,) = panel["series"]
    ends = [(line["x"][k], line["y"][k]) for k in (0, -1)]
    assert ends[0] == pytest.approx((0.0, 1e-5), rel=1e-3, abs=1e-4) and ends[1] == pytest.approx(
        (answer["formula"], 0.0)
    )


def test_a_path_that_costs_too_much_is_given_up(monkeypatch):
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml")
    monkeypatch.setattr(orbit_path, "MOST_WORK", 1000)
    row = onset(scenario, {"key": "stator.misalignment", **POINT})
    assert "right-hand sides" in row["failed"] and 1 <= len(row["path"]["forcing"]) < 5 and row["formula"] > 0


def test_a_single_orbit_that_costs_too_much_is_given_up(monkeypatch):
    """Not only between orbits: one of them may cost more than all others."""
    scenario = sealdyn.read_scenario(SCENARIOS / "fmr_reference.toml")
    monkeypatch.setattr(orbit_path, "MOST_WORK", 100)
    follower = Follower(lambda value: with_values(scenario, {"stator.misalignment": value}).scene, 1e-3, 1e-7)
    with pytest.raises(TooMuchWork):
        follower.excess(1e-4)
    assert 100 <= follower.work < 120 and not follower.path


class Tools:
    """Answers made up from what is asked, so that what belongs to which point shows; two of them fail."""

    def map(self, function, points, what="points"):
        assert function.func is onset
        return [self.row(p["set"].get("film.coning", 1.0), p["floor"]) for p in points]

    @staticmethod
    def row(coning, floor):
        if (coning, floor) in ((3.0, True), (4.0, False)):
            return {"failed": f"no orbit at {coning}, {floor}"}
        kept = {"formula": coning, "nonlinear": (2.5 if floor else 2.0) * coning, "ratio": 2.0, "radius": 0.032,
                "axial_opening": 0.3, "multiplier": 0.5, "clearance": 1e-5,
                "path": {n: [0.5, 1.0] for n in ("forcing", "h_min", "tilt", "axial")}}  # fmt: skip
        return {**kept, "cavitation_pressure": 0.0} if floor else kept


@pytest.mark.parametrize("floor", [False, True])
def test_curve_carries_the_floored_onset_beside_the_plain_one(floor):
    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml")
    settings = Settings(over="film.coning", values=(2.0, 3.0, 4.0), floor=floor)
    answer = contact_onset.run(scenario, settings, Tools())
    assert answer["nonlinear"] == 2.0 and (answer["floored"] or {}).get("nonlinear") == (2.5 if floor else None)
    assert [row["value"] for row in answer["curve"]] == [2.0, 3.0, 4.0]
    assert [row.get("nonlinear") for row in answer["curve"]] == [4.0, 6.0, None]
    assert "no orbit at 4.0, False" in answer["curve"][2]["failed"]
    if floor:
        below = [row["floored"] for row in answer["curve"]]
        assert [row.get("nonlinear") for row in below] == [5.0, None, 10.0]
        assert below[1] == {"failed": "no orbit at 3.0, True"}
    else:
        assert not any("floored" in row for row in answer["curve"])
    curve = answer.panels[-1]
    assert any(one.label == "pressure floored" for one in curve.series) == floor
    assert sheet_of(answer.panels, "x", "", answer.found).axes


def test_a_failed_onset_leaves_its_curve():
    class Broken(Tools):
        def map(self, function, points, what="points"):
            return [{"failed": "no orbit"} if not p["set"] else self.row(2.0, False) for p in points]

    scenario = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml")
    answer = contact_onset.run(scenario, Settings(over="film.coning", values=(2.0,)), Broken())
    assert answer["status"] == "failed" and answer["nonlinear"] is None and answer.found == "no orbit"
    assert answer["curve"][0]["nonlinear"] == 4.0
    assert sheet_of(answer.panels, "x", "", answer.found).axes
