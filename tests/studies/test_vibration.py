"""Vibration study: against formulas of one ring and matrices of two written here, a nonlinear balance; its chart."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from drawn import text_trouble
from in_process import InProcess
from oracles import opening_force

import sealdyn
from sealdyn import read_scenario, run_study
from sealdyn.analysis.film_matrices import State, matrices
from sealdyn.dynamics.model import Model
from sealdyn.report.panels import draw
from sealdyn.scene.scene import SceneError
from sealdyn.solvers.integrate import solve
from sealdyn.studies import vibration as study
from sealdyn.studies.vibration import Settings, shaken_seal
from sealdyn.studies.vibration.shaken_seal import ShakenSeal

G = 9.80665
# Green's ring and support; stiffness and damping of the springs against tilt.
MASS, INERTIA, POLAR, K_Z, D_Z, K_S, D_S, SPEED = 1.0, 8e-4, 16e-4, 5e5, 300.0, 400.0, 0.24, 1000.0
INNER, OUTER, CLEARANCE, CONING = 0.032, 0.040, 1e-5, 3.125e-3
TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def scenario(arrangement, *overrides):
    file = {"fmr": "fmr_reference", "fms": "fms_reference", "fmsr": "fmsr_both_flexible"}[arrangement]
    return read_scenario(SCENARIOS / f"{file}.toml", ["film.model=radial", *overrides])


def ask(seal, **settings):
    return study.run(seal, Settings(**{"points": 7, "runs": 0} | settings), InProcess())


def answer(arrangement, *overrides, **settings):
    return ask(scenario(arrangement, *overrides), **settings).numbers


def film(arrangement):
    """The film's own tilt and axial stiffness and damping."""
    k, d = Model(scenario(arrangement).scene).film_matrices()
    return k[1, 1], d[1, 1], k[0, 0], d[0, 0]


def axial_transmissibility(arrangement, w):
    """Gap per housing displacement, one ring or two, from Newton's law of each."""
    _, _, k, d = film(arrangement)
    support, between, inertia = K_Z + 1j * w * D_Z, k + 1j * w * d, MASS * w * w
    if arrangement == "fms":
        return support / (support + between - inertia)
    if arrangement == "fmr":
        return (support - inertia) / (support + between - inertia)
    # Both: support (z_s - 1) + between (z_s - z_r) = m w^2 z_s, support z_r + between (z_r - z_s) = m w^2 z_r.
    matrix = np.array([[support + between - inertia, -between], [-between, support + between - inertia]])
    stator, rotor = np.linalg.solve(matrix, [support, 0.0])
    return stator - rotor


def tilt_transmissibility(arrangement, w):
    """Largest relative tilt over a period per rocking of the housing about x, from the rings' real equations."""
    k, d, *_ = film(arrangement)
    one = np.eye(2)
    between = (k + 1j * w * d) * one - 0.5 * SPEED * d * TURN
    standing = (K_S + 1j * w * D_S - INERTIA * w * w) * one
    turns = standing - 1j * w * POLAR * SPEED * TURN - SPEED * D_S * TURN
    rocked = np.array([1.0, 0.0])
    carried = (K_S + 1j * w * D_S) * rocked
    if arrangement == "fms":
        found = np.linalg.solve(standing + between, carried)
    elif arrangement == "fmr":
        found = rocked - np.linalg.solve(turns + between, between @ rocked)
    else:
        matrix = np.block([[standing + between, -between], [-between, turns + between]])
        both = np.linalg.solve(matrix, np.concatenate([carried, np.zeros(2)]))
        found = both[:2] - both[2:]
    times = np.exp(1j * np.linspace(0.0, 2 * math.pi, 40001))
    return np.max(np.linalg.norm(np.real(times[:, None] * found), axis=1))


@pytest.mark.parametrize("arrangement", ["fms", "fmr", "fmsr"])
def test_gap_over_frequency_is_that_of_newtons_law(arrangement):
    overrides = []
    if arrangement == "fmsr":
        overrides = [f"{ring}.{key}" for ring in ("stator", "rotor") for key in (
            f"mass={MASS}", f"transverse_inertia={INERTIA}", f"support.axial_stiffness={K_Z}",
            f"support.axial_damping={D_Z}", "support.radius=0.04")] + [f"rotor.polar_inertia={POLAR}"]  # fmt: skip
    found = answer(arrangement, *overrides)["table"]
    for n, frequency in enumerate(found["frequency"]):
        w = 2 * math.pi * frequency
        gain, tilt = abs(axial_transmissibility(arrangement, w)), tilt_transmissibility(arrangement, w)
        assert found["axial_gain"][n] == pytest.approx(gain, rel=1e-7)
        assert found["angular_gain"][n] == pytest.approx(tilt, rel=1e-7)
        assert found["axial_per_acceleration"][n] == pytest.approx(gain / w**2, rel=1e-7)
        # Aligned faces touch at the inner edge, which the clearance is at.
        assert found["axial_touch_aligned"][n] == pytest.approx(CLEARANCE * w**2 / gain, rel=1e-7)
        edge = min(CLEARANCE / INNER, (CLEARANCE + CONING * 0.008) / OUTER)
        assert found["angular_touch_aligned"][n] == pytest.approx(edge * w**2 / tilt, rel=1e-7)


def test_runout_takes_its_part_of_the_film():
    """FMS: relative tilt of the runout by Green's formula; at the inner edge it takes r_i times that."""
    k, d, *_ = film("fms")
    ring = K_S - INERTIA * SPEED**2 + 1j * SPEED * D_S
    tilt = 2e-4 * abs(ring / (ring + k + 0.5j * SPEED * d))
    found = answer("fms", "stator.misalignment=0", "rotor.runout=0.2 mrad")
    assert found["own"]["tilt"] == pytest.approx(tilt, rel=1e-6) and found["own"]["closing"] < 1e-15
    for direction in ("axial", "angular"):
        touch, aligned = (np.array(found["table"][f"{direction}_touch{part}"]) for part in ("", "_aligned"))
        assert touch == pytest.approx(aligned * (1.0 - INNER * tilt / CLEARANCE), rel=1e-6)


def test_a_runout_that_touches_alone_leaves_nothing_to_vibration():
    seal = scenario("fms")
    # No scenario's start, which would have the film closed.
    seal = replace(seal, scene=replace(seal.scene, rotor=replace(seal.scene.rotor, runout=8e-3)), read=None)
    found = ask(seal)
    assert set(found.numbers["table"]["axial_touch"]) == {0.0} and "without any vibration" in found.found


@pytest.mark.core
def test_peaks_bands_and_gear_mesh():
    found = answer("fms", highest=20e3, points=31, accelerations=(50.0, 500.0))
    for peak in found["peaks"]:
        function = axial_transmissibility if peak["direction"] == "axial" else tilt_transmissibility
        gains = [abs(function("fms", 2 * math.pi * f)) for f in np.array([0.99, 1.0, 1.01]) * peak["frequency"]]
        assert peak["inside"] and gains[1] > max(gains[0], gains[2])
    assert [(b["direction"], b["acceleration"]) for b in found["bands"]] == [
        ("axial", 50.0), ("axial", 500.0), ("angular", 50.0), ("angular", 500.0)]  # fmt: skip
    axial = found["bands"][0]
    w, own = 2 * math.pi * axial["highest"], INNER * found["own"]["tilt"] / CLEARANCE
    assert (1 - own) * CLEARANCE * w**2 / abs(axial_transmissibility("fms", w)) == pytest.approx(50.0, rel=1e-6)
    assert axial["lowest"] == 3.0
    mesh = found["gear_mesh"][0]
    assert (mesh["direction"], mesh["frequency"], mesh["acceleration"]) == ("axial", 5400.0, 45 * G)
    gain = abs(axial_transmissibility("fms", 2 * math.pi * 5400.0))
    left = CLEARANCE - gain * 45 * G / (2 * math.pi * 5400.0) ** 2
    assert mesh["film_left"] == pytest.approx(left, rel=1e-9)
    angular, k = found["gear_mesh"][1], 2 * math.pi * 5400.0
    edge = OUTER * (1 - own) * CLEARANCE / INNER * k**2 / tilt_transmissibility("fms", k)
    assert angular["touch"] == pytest.approx(edge, rel=1e-7)
    assert angular["margin"] == pytest.approx(edge / (45 * G), rel=1e-7)
    given = answer("fms", "application.gear_mesh_frequency=[2100, 3000]", direction="axial")["gear_mesh"]
    assert [row["frequency"] for row in given] == [2100.0, 3000.0]


def test_modes_have_the_roots_of_their_equations():
    _, _, k, d = film("fmr")
    root = np.roots([MASS, D_Z + d, K_Z + k])[0]
    (axial,) = [mode for mode in answer("fmr")["modes"] if mode["kind"] == "axial"]
    assert axial["frequency"] == pytest.approx(abs(root) / (2 * math.pi), rel=1e-9)
    assert axial["damping_ratio"] == pytest.approx(-root.real / abs(root), rel=1e-9)


@pytest.mark.parametrize("arrangement", ["fms", "fmr", "fmsr"])
@pytest.mark.parametrize("direction", ["axial", "angular"])
def test_small_motion_in_time_is_that_of_linear_theory(arrangement, direction, monkeypatch):
    monkeypatch.setattr(shaken_seal, "BEYOND", 0.0)
    for frequency in (20.0, 700.0):
        row = shaken_seal.measured(scenario(arrangement).scene, {"direction": direction, "frequency": frequency})
        assert row["deviation"] < 1e-5 and row["touch"] is None and "not looked for" in row["said"]


@pytest.mark.parametrize("arrangement", ["fms", "fmr"])
def test_slow_vibration_touches_where_springs_overcome_the_film(arrangement):
    """So slowly that forces balance: K_z (amplitude - closing) = film force nearly closed less that at rest, by
    quadrature of the pressure; linear theory has half of it."""
    closing = CLEARANCE * (1 - 1e-3)
    more = opening_force(CLEARANCE - closing, CONING, 0.0, 5e5) - opening_force(CLEARANCE, CONING, 0.0, 5e5)
    amplitude = closing + more / K_Z
    row = shaken_seal.measured(scenario(arrangement).scene, {"direction": "axial", "frequency": 1.0})
    assert row["touch"] == pytest.approx(amplitude * (2 * math.pi) ** 2, rel=0.03)
    assert 1.5 < row["ratio"] < 2.0


def test_rough_faces_touch_where_their_asperities_meet():
    """At 3 rms, by linear theory and, slowly, by the balance of forces."""
    rough = ["contact.roughness=0.5 um", "contact.compressive_strength=100 MPa"]
    left = CLEARANCE - 1.5e-6
    found = answer("fms", *rough, direction="axial")["table"]
    w = 2 * math.pi * np.array(found["frequency"])
    assert found["axial_touch_aligned"] == pytest.approx(left * w**2 / np.array(found["axial_gain"]), rel=1e-7)
    more = opening_force(1.5e-6, CONING, 0.0, 5e5) - opening_force(CLEARANCE, CONING, 0.0, 5e5)
    row = shaken_seal.measured(scenario("fms", *rough).scene, {"direction": "axial", "frequency": 1.0})
    assert row["touch"] == pytest.approx((left + more / K_Z) * (2 * math.pi) ** 2, rel=0.03)


def test_a_linear_film_touches_in_time_where_linear_theory_says():
    row = shaken_seal.measured(scenario("fms", "film.model=linear").scene, {"direction": "axial", "frequency": 150.0})
    assert row["ratio"] == pytest.approx(1.0, rel=0.02)


def test_a_film_that_stores_answers_at_the_frequency_of_the_motion():
    seal = read_scenario(SCENARIOS / "gas_reynolds_reference.toml", ["film.gas_reynolds.cells=[6, 8]"])
    found = ask(seal, points=3, direction="axial").numbers
    shaken = ShakenSeal(seal.scene)
    ring = seal.scene.stator if seal.scene.stator.support else seal.scene.rotor
    for frequency, gain in zip(found["table"]["frequency"], found["table"]["axial_gain"], strict=True):
        w = 2 * math.pi * frequency
        k, d = (part[0, 0] for part in matrices(shaken.model, State(), omega=w))
        support = ring.support.axial_stiffness + 1j * w * ring.support.axial_damping
        inertia = ring.mass * w * w
        drive = support if seal.scene.stator.support else support - inertia
        assert gain == pytest.approx(abs(drive / (support + k + 1j * w * d - inertia)), rel=1e-6)


STIFF = ("shaft.speed=12000 rpm", "film.clearance=1.5 um", "film.coning=1 mrad", "film.viscosity=20 mPa*s",
         "rotor.support.axial_stiffness=5e4", "rotor.support.axial_damping=100")  # fmt: skip


def test_a_run_is_not_more_accurate_than_rounding_knows_the_housing():
    """Such a film moves by 1e-5 of the housing; asked for 1e-8 of the clearance for 300 periods, a stiff solver
    followed the rounding of the phase for six minutes."""
    seal = ShakenSeal(scenario("fmr", *STIFF).scene)
    period = 2 * math.pi * 36.0
    rounding = 2.0**-52 * 2 * math.pi * 300 * 10.0 / period**2 / seal.model.clearance
    assert shaken_seal._accuracy(seal, "axial", 36.0, 10.0, 300) == pytest.approx(shaken_seal.ABOVE_ROUNDING * rounding)
    assert shaken_seal._accuracy(seal, "axial", 3600.0, 10.0, 3) == shaken_seal.ACCURACY
    arm = seal.model.scene.film.outer_radius
    assert shaken_seal._accuracy(seal, "angular", 36.0, 10.0 / arm, 300) == pytest.approx(
        shaken_seal.ABOVE_ROUNDING * rounding
    )


def test_a_long_wait_is_told_and_how_to_leave_it_out(monkeypatch):
    monkeypatch.setattr(study, "measured", lambda scene, point: {"deviation": 0.0, "ratio": None, "said": ""})
    tools = InProcess()
    found = study.run(scenario("fms"), Settings(points=7, runs=2, direction="axial"), tools).numbers
    assert tools.told.startswith(f"vibration: {len(found['time_domain'])} tones") and "--runs 0" in tools.told


def test_what_takes_too_long_in_time_is_given_up(monkeypatch):
    point, scene = {"direction": "axial", "frequency": 30.0}, scenario("fms").scene
    taken = []

    def counted(*given, **how):
        taken.append(solve(*given, **how))
        return taken[-1]

    monkeypatch.setattr(shaken_seal, "solve", counted)
    whole = shaken_seal.measured(scene, point)
    assert whole["touch"] and not whole["said"]
    small, budget = taken[0].counts.rhs, taken[0].counts.rhs + taken[1].counts.rhs + 1000
    monkeypatch.setattr(shaken_seal, "MOST_WORK", budget)
    taken.clear()
    row = shaken_seal.measured(scene, point)
    # Small motion and the way to touch share what a tone may cost.
    assert row["touch"] is None and row["gain"] == whole["gain"] and str(budget) in row["said"]
    assert sum(outcome.counts.rhs for outcome in taken) < 2 * budget
    monkeypatch.setattr(shaken_seal, "MOST_WORK", small // 2)
    with pytest.raises(ValueError, match=f"more than {small // 2} evaluations"):
        shaken_seal.measured(scene, point)


def test_a_housing_that_tilts_far_is_not_followed(monkeypatch):
    monkeypatch.setattr(shaken_seal, "TILTED", 1e-9)
    row = shaken_seal.measured(scenario("fms").scene, {"direction": "angular", "frequency": 30.0})
    assert row["touch"] is None and "tilts by more than" in row["said"] and row["deviation"] < 1e-4


def test_what_cannot_be_asked_is_refused():
    with pytest.raises(SceneError, match=r"85940 rpm, at which small motion does not die out"):
        answer("fms", "shaft.speed=9000")
    with pytest.raises(sealdyn.ScenarioError, match="range of frequencies"):
        answer("fms", lowest=100.0, highest=50.0)
    with pytest.raises(SceneError, match="does not die out"):
        ask(read_scenario(SCENARIOS / "free_precession.toml"))
    dry = scenario("fms", "stator.support.axial_damping=1e-3", "film.viscosity=1e-15")
    with pytest.raises(ValueError, match="transient"):
        shaken_seal.measured(dry.scene, {"direction": "axial", "frequency": 5400.0})


def test_faces_that_ride_on_asperities_say_so():
    found = ask(read_scenario(SCENARIOS / "pump_seal.toml"), points=3)
    assert found.numbers["riding"] and found.numbers["touch_height"] == 0.0
    assert "asperities touch at rest" in found.notes[0]


@pytest.mark.parametrize("arrangement, direction", [("fmr", "both"), ("fmsr", "axial")])
def test_its_data_and_its_page(arrangement, direction, tmp_path):
    flags = {"points": 21, "runs": 1, "lowest": 200.0, "direction": direction, "accelerations": "1 g, 45 g"}
    found = run_study("vibration", scenario(arrangement), tmp_path / "v.h5", flags=flags, workers=1)
    assert found["accelerations"] == pytest.approx([G, 45 * G])
    assert found["deviation"] < 1e-5 and all(row["ratio"] > 1.0 for row in found["time_domain"] if row["ratio"])
    assert text_trouble(draw(found["archive"])) == ([], [])
    data = sealdyn.study("vibration", scenario(arrangement), points=5, runs=0, workers=1).data
    assert data["table.axial_touch"].dims == ("table.frequency",)
    assert data["table.axial_touch"].attrs["units"] == "m/s^2"


@pytest.mark.parametrize(
    "direction, units",
    [("both", "m/s^2 axial, rad/s^2 angular"), ("axial", "m/s^2"), ("angular", "rad/s^2")],
)
def test_accelerations_have_the_unit_of_their_direction(direction, units, tmp_path):
    out = tmp_path / "v.h5"
    scenario = sealdyn.example("housing_vibration")
    sealdyn.study("vibration", scenario, direction=direction, points=5, runs=1, out=out, workers=1)
    with sealdyn.open_archive(out) as data:
        assert {data[f"time_domain.{name}"].attrs["units"] for name in ("touch", "linear_touch")} == {units}
        assert data["weakest.touch"].attrs["units"] == units and data["gear_mesh.touch"].attrs["units"] == "m/s^2"
        assert not any(column.attrs.get("units") == "SI" for column in data.variables.values())
