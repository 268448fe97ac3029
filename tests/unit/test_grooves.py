"""Scenes with grooves: keys, what is refused, and what studies say of the aligned film and its ring."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from grooved_faces import AREA, R_I, R_O, ROWS, SEAL_TOML

from sealdyn import read_scenario, run_study
from sealdyn.analysis.desk import checked
from sealdyn.dynamics.equilibrium import settle
from sealdyn.dynamics.interface import Interface, opening_law
from sealdyn.films import film_of
from sealdyn.films._grooved.aligned import aligned_film, extrapolated_force
from sealdyn.films._grooved.motion import tilt_law, unstable_roots
from sealdyn.report.text import resolved_lines
from sealdyn.scene.checks import scene_errors, unused
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import GasReynolds
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Grooves
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Closing, Scene, SceneError, counterpart, frozen_at_start
from sealdyn.studies import stribeck
from sealdyn.studies._grooved import flows_over_grooves, tracking
from sealdyn.studies._grooved_roots import RootsOverSpeed, modes, rings_of

SPIRAL = Grooves(12, 6e-6, 0.0555, R_O, 0.5, angle=math.radians(15.0))
SUPPORT = Support(axial_stiffness=1.64e4, axial_damping=1e3, tilt_stiffness=31.0, tilt_damping=1.4)
RING = dict(mass=0.2, transverse_inertia=3.5e-4, support=SUPPORT)
GAS = Film(R_I, R_O, 5e5, 1e5, viscosity=1.8e-5, gas="air", temperature=300.0, clearance=3e-6)
LIQUID = Film(R_I, R_O, 5e5, 1e5, 1e-3, clearance=3e-6)
ROW = {key: value[0] for key, value in ROWS["gas_5bar"]["expected"].items()}


def seal(film=GAS, rotor=(SPIRAL,), stator=(), speed=1000.0, floats="stator", **parts):
    rings = {"rotor": Rotor(grooves=list(rotor)), "stator": Stator(grooves=list(stator))}
    rings |= {name: replace(rings[name], **RING) for name in floats.split()}
    return Scene(shaft=Shaft(speed=speed), film=film, **rings, **parts)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    path = tmp_path_factory.mktemp("grooves") / "dry.toml"
    path.write_text(SEAL_TOML)
    return read_scenario(path)


RUN = type("Run", (), {"duration": 1.0, "start": "steady", "turns": None})()


@pytest.mark.parametrize(
    "key, changes",
    [
        ("inner_radius", {"outer_radius": 0.063}), ("inner_radius", {"inner_radius": 0.050}),
        ("inner_radius", {"inner_radius": R_O}), ("share", {"share": 0.0}), ("share", {"share": 1.0}),
        ("depth", {"depth": -1e-6}), ("count", {"count": 0}), ("angle", {"angle": None}), ("angle", {"angle": 0.0}),
        ("angle", {"angle": math.radians(165.0)}), ("stem_share", {"stem_share": 0.2}),
        ("stem_outer_radius", {"shape": "tee", "angle": None}),
        ("angle", {"shape": "tee", "stem_share": 0.2, "stem_outer_radius": R_O, "outer_radius": 0.0585}),
        ("stem_share", {"shape": "tee", "stem_share": 0.6, "stem_outer_radius": R_O, "outer_radius": 0.0585,
                        "angle": None}),
        ("stem_outer_radius", {"shape": "tee", "stem_share": 0.2, "stem_outer_radius": 0.058, "outer_radius": 0.0585,
                               "angle": None}),
    ],
)  # fmt: skip
def test_grooves_that_cannot_be(key, changes):
    assert not scene_errors(seal(), RUN)
    errors = [error.key for error in scene_errors(seal(rotor=[replace(SPIRAL, **changes)]), RUN)]
    assert f"rotor.grooves.0.{key}" in errors


@pytest.mark.parametrize(
    "key, scene",
    [
        ("rotor.grooves", seal(rotor=[SPIRAL, SPIRAL])), ("rotor.grooves", seal(stator=[SPIRAL])),
        ("film.model", seal(replace(GAS, model="gas_dam"))), ("film.geometry", seal(replace(GAS, geometry="planar"))),
        ("contact", seal(LIQUID, contact=Contact(1e-7, compressive_strength=3e8))),
    ],
)  # fmt: skip
def test_what_no_film_over_grooves_reckons_with(key, scene):
    assert key in [error.key for error in scene_errors(scene, RUN)]


@pytest.mark.core
def test_the_film_of_grooves_stands_for_the_one_that_is_asked_for(scenario):
    (one,) = scenario.scene.rotor.grooves
    read, meant = ([getattr(row, key) for key in ("depth", "inner_radius", "angle", "share")] for row in (one, SPIRAL))
    assert read == pytest.approx(meant, rel=1e-12) and one.count == 12
    assert film_of(seal()).name == "gas_reynolds" and film_of(seal()).frame is not None
    liquid = Film(R_I, R_O, 5e5, 1e5, viscosity=1e-3, clearance=3e-6)
    assert film_of(seal(liquid, rotor=(), stator=[SPIRAL], floats="rotor")).name == "reynolds"
    with pytest.raises(SceneError):
        film_of(seal(replace(GAS, model="gas_dam")))


def test_grooves_go_with_their_ring():
    assert counterpart(seal()).stator.grooves == [SPIRAL] and not counterpart(seal()).rotor.grooves


def test_the_film_of_a_scene_is_that_of_the_row():
    found = aligned_film(seal(), 3e-6)
    force, error = found.better(lambda one: one.force)
    assert force - 1e5 * AREA == pytest.approx(ROW["force"], rel=2e-3) and error < 5e-3 * force
    # The stator's grooves the other way round, under a rotor that turns as fast beyond it.
    other = seal(rotor=(), stator=[replace(SPIRAL, angle=-SPIRAL.angle)], floats="rotor")
    assert aligned_film(other, 3e-6).better(lambda one: one.force)[0] == pytest.approx(force, rel=1e-4)
    turning = seal(speed=400.0)
    turning = replace(turning, stator=replace(turning.stator, speed=-600.0))
    assert aligned_film(turning, 3e-6).better(lambda one: one.force)[0] == pytest.approx(force, rel=1e-9)


def test_a_film_that_is_not_there_is_told():
    thin = replace(GAS, outer_pressure=1e5)
    wrong = replace(SPIRAL, angle=-SPIRAL.angle)
    torn = Film(R_I, R_O, 1.5e5, 1e5, viscosity=1e-3, clearance=3e-6)
    flat = replace(SPIRAL, angle=1e-9)
    for scene, clearance in ((seal(thin, [wrong]), 1e-7), (seal(torn, [wrong]), 3e-6), (seal(rotor=[flat]), 3e-6)):
        with pytest.raises(SceneError):
            aligned_film(scene, clearance)


def test_the_opening_force_between_its_nodes():
    force, scene = extrapolated_force(seal()), seal()
    for clearance in (1.7e-6, 3e-6, 8.2e-6):
        exact = aligned_film(scene, clearance, 8).better(lambda one: one.force)[0]
        assert force(clearance, 1e5, 5e5) == pytest.approx(exact, rel=3e-5)
    assert math.isnan(force(1e-9, 1e5, 5e5))


def test_the_clearance_follows_from_the_closing_force():
    held = seal()
    clearance, law, *_ = settle(held, opening_law(held))
    closing = Closing(balance_ratio=law.balance_ratio, spring_force=law.spring)
    found, _, roots, _ = settle(seal(replace(GAS, clearance=None), closing=closing), opening_law(held))
    assert clearance == 3e-6 and found == pytest.approx(3e-6, rel=1e-6)
    (root,) = [root for root in roots if root.stable]
    assert root.stiffness == pytest.approx(ROW["axial_K_at_0W"], rel=5e-3)


def test_the_studies_of_a_dry_gas_seal(scenario, tmp_path):
    found = run_study("equilibrium", scenario, tmp_path / "e.h5", flags={"points": 11}, workers=1)
    (root,) = found["roots"]
    assert root["film_force"] == pytest.approx(1e5 * AREA + ROW["force"], rel=3e-3)
    assert root["torque"] == pytest.approx(ROW["torque"], rel=2e-3)
    assert root["stiffness"] == pytest.approx(ROW["axial_K_at_0W"], rel=2e-3)
    # From the high to the low pressure, at normal conditions.
    leakage = -ROW["outflow"] * 273.15 / 300.0 / 101325.0
    assert root["leakage"] == pytest.approx(leakage, rel=2e-3)
    flags = {"vary": "rotor.grooves.0.depth=6 um"}
    over = run_study("load-support", scenario, tmp_path / "l.h5", flags=flags, workers=1)
    (row,) = over["rows"]
    assert row["stiffness_over_leakage"] == pytest.approx(root["stiffness"] / leakage, rel=4e-3)
    assert row["stiffness"] == pytest.approx(root["stiffness"], rel=1e-9)
    flags = {"frequency": "10,1000,2000 rad/s"}
    found = run_study("coefficients", scenario, tmp_path / "c.h5", flags=flags, workers=1)
    k, d = (np.array(found["map"][name])[0] for name in ("stiffness", "damping"))
    assert found["map"]["frame"] == "inertial" and k.shape == d.shape == (3, 3, 3)
    assert k[1, 0, 0] == pytest.approx(ROW["axial_K_at_1W"], rel=4e-3)
    assert k[1, 1, 1] == pytest.approx(5.043e5, rel=5e-3) and k[1, 1, 2] == pytest.approx(-1.70e4, abs=5e3)
    assert (found["leakage"], found["torque"]) == pytest.approx((root["leakage"], root["torque"]), rel=1e-9)
    assert complex(*found["modes"]["tilt_forward"]) == pytest.approx(-5035 + 43004j, rel=5e-3)
    assert complex(*found["modes"]["tilt_backward"]) == pytest.approx(-5017 - 43056j, rel=5e-3)
    assert complex(*found["modes"]["axial"]) == pytest.approx(-5356 + 45260j, rel=5e-3)
    assert found["modes"]["stable"] and found["pumping"] == "inwards"


def test_a_ring_on_grooves_the_wrong_way_round_is_unstable():
    """Negative stiffness: one root that grows without turning; of a heavy ring at ambient pressure, whose film damps
    negatively at low frequencies, a pair."""
    wrong = seal(rotor=[replace(SPIRAL, angle=-SPIRAL.angle)])
    found = modes(wrong, aligned_film(wrong, 3e-6, 8))
    assert found["unstable_axial"] == 1 and not found["stable"]
    ambient = seal(replace(GAS, outer_pressure=1e5))
    support = replace(SUPPORT, axial_damping=0.0)
    heavy = replace(ambient, stator=replace(ambient.stator, mass=100.0, support=support))
    found, light = (modes(scene, aligned_film(scene, 3e-6, 8)) for scene in (heavy, ambient))
    assert light["stable"] and found["unstable_axial"] == 2 and found["axial"][0] > 0.0


def test_upstream_pumping():
    """The liquid flows against its pressure; the ring, overdamped, whirls forward only, at the film's ratio."""
    row = ROWS["liquid_upstream_pumping"]
    face = Film(0.026, 0.031, 8e5, 3e5, viscosity=1e-3, clearance=3e-6)
    grooves = Grooves(10, 8e-6, 0.026, 0.0285, 0.5, angle=math.radians(-15.0))
    scene = seal(face, [grooves], speed=300.0)
    found = aligned_film(scene, 3e-6)
    flows = flows_over_grooves(scene, 3e-6, 1000.0)
    assert flows["leakage"] == pytest.approx(-row["expected"]["outflow"][0], rel=5e-3) and flows["mass_flow"] < 0.0
    ring = modes(scene, found)
    assert ring["stable"] and ring["tilt_backward"] is None
    assert ring["tilt_forward"][1] / 300.0 == pytest.approx(0.526, abs=0.01)


def test_two_grooves_have_roots_and_a_tilt_at_twice_the_speed():
    scene = seal(rotor=[replace(SPIRAL, count=2)])
    scene = replace(scene, stator=replace(scene.stator, misalignment=4e-5))
    found = aligned_film(scene, 3e-6, 8)
    ring, follows = modes(scene, found), tracking(scene, found, 3e-6)
    assert ring["stable"] and ring["unstable"] == 0 and ring["tilt_forward"][0] < 0.0
    assert follows["at_twice"] > 0.0 and follows["largest"] > follows["by_runout"] + follows["by_misalignment"]


def test_what_no_run_over_grooves_takes():
    """A liquid that would tear or does, columns without number."""
    tears = seal(Film(R_I, R_O, 5e5, 1e5, 1e-3, clearance=3e-6, cavitation_pressure=0.0))
    torn = seal(Film(R_I, R_O, 1.5e5, 1e5, viscosity=1e-3, clearance=3e-6), [replace(SPIRAL, angle=-SPIRAL.angle)])
    for scene, key in ((torn, "film.clearance"), (tears, "film.cavitation_pressure")):
        with pytest.raises(SceneError) as refused:
            Interface(scene, 1e-8)
        assert refused.value.key == key
    for columns in (1, 1000):
        wrong = seal(replace(GAS, gas_reynolds=GasReynolds(columns=columns)))
        assert [error.key for error in scene_errors(wrong, RUN)] == ["film.gas_reynolds.columns"]


def test_which_cells_are_used():
    given = {"film.gas_reynolds.cells", "film.gas_reynolds.columns"}
    assert unused(seal(), given) == ["film.gas_reynolds.cells"]
    assert unused(seal(rotor=()), given) == ["film.gas_reynolds.columns"]


def test_a_study_that_does_not_reckon_with_grooves_says_so(scenario, tmp_path):
    with pytest.raises(SceneError) as refused:
        run_study("contact-onset", scenario, tmp_path / "c.h5")
    assert refused.value.key == "rotor.grooves"


HEAVY = {"stator.transverse_inertia": 5e-2, "rotor.grooves.0.count": 5, "film.clearance": 4e-6}


def test_campbell_over_grooves_finds_where_a_whirl_loses_its_damping(tmp_path):
    """Where the count of growing roots changes; there K - I w^2 and the damping of film and support are zero."""
    heavy = read_scenario(SCENARIOS / "upstream_pumping.toml").with_(HEAVY)
    flags = {"points": 4, "speed_from": 700.0, "speed_to": 1300.0}
    found = run_study("campbell", heavy, tmp_path / "c.h5", flags=flags, workers=1)
    (point,) = [point for point in found["thresholds"] if point["what"] == "damping"]
    # The count is of the finer mesh, the roots extrapolated.
    far = [(w, n) for w, n in zip(found["speed"], found["growing"], strict=True) if abs(w / point["speed"] - 1) > 3e-2]
    assert len(far) > 4 and all(growing == int(speed > point["speed"]) for speed, growing in far)
    roots = RootsOverSpeed(frozen_at_start(heavy.scene))
    assert roots(point["speed"])["tilt_forward"][0] == pytest.approx(0.0, abs=0.1)
    # The closing force is kept, not the clearance.
    assert np.all(np.diff(found["clearance"]) > 0.0)
    whirl = 1j * point["whirl_ratio"] * point["speed"]
    turned = frozen_at_start(roots.film.free, speed=point["speed"])
    clearance = settle(turned, opening_law(turned))[0]
    law = tilt_law(aligned_film(turned, clearance, 8).motions[1], *rings_of(turned))
    assert abs(law(whirl)) < 2e-2 * abs(law(0.0))


def test_the_ring_that_floats_spins_with_its_own_speed():
    """What gyroscopic moments and the dampers of a ring that turns add to its law, by hand."""
    rotor = seal(floats="rotor")
    rotor = replace(rotor, rotor=replace(rotor.rotor, polar_inertia=6e-4))
    (ring,), (still,) = rings_of(rotor), rings_of(seal())
    assert (ring.spin, ring.polar_inertia, still.spin) == (1000.0, 6e-4, 0.0)
    motion, s = aligned_film(rotor, 3e-6, 8).motions[0], -200.0 + 3e4j
    more = tilt_law(motion, ring)(s) - tilt_law(motion, still)(s)
    assert more == pytest.approx(-1j * 6e-4 * 1000.0 * s - 1j * 1000.0 * 1.4, rel=1e-6)


@pytest.mark.parametrize(
    "roots, count",
    [((-1.0, -3.0), 0), ((2.0, -3.0), 1), ((5.0 + 80.0j, 5.0 - 80.0j), 2), ((0.01 + 80.0j, -40.0 - 3.0j), 1)],
)
def test_roots_on_the_right_are_counted(roots, count):
    """Of a law with a film that stores, whose pole lies on the left."""

    def law(s):
        return 0.3 * (s - roots[0]) * (s - roots[1]) * (s + 400.0) / (s + 300.0)

    assert unstable_roots(law, 0.3) == count
    assert cmath.isclose(law(roots[0]), 0.0)


def test_check_says_how_deep_the_grooves_are_and_which_way_they_pump(scenario):
    found = checked(scenario)
    density = 5e5 / (287.05 * 300.0)
    assert found["grooves"]["reynolds_number"] == pytest.approx(density * 1000.0 * R_O * 9e-6 / 1.8e-5, rel=1e-3)
    assert (found["grooves"]["pumping"], found["grooves"]["depth_over_film"]) == ("inwards", 2.0)
    assert not found["warnings"] and "inwards" in " ".join(resolved_lines(found))
    assert checked(scenario.with_(shaft__speed=-1000.0))["grooves"]["pumping"] == "outwards"
    assert len(checked(scenario.with_(shaft__speed=20000.0, film__clearance="8 um"))["warnings"]) == 1


def test_a_stator_follows_its_grooved_rotor_as_the_row_has_it(scenario, tmp_path):
    """Linear part of the row fms_gas_5bar: 2.245e-5 and 7.577e-6 rad are sum and difference of the two."""
    tilts = {"rotor.runout": 2e-5, "stator.misalignment": 4e-5}
    stiff = {"stator.support.tilt_stiffness": 3e5, "stator.support.tilt_damping": 50.0}
    found = run_study("coefficients", scenario.with_({**tilts, **stiff}), tmp_path / "found.h5")["tracking"]
    turning, standing = found["by_runout"], found["by_misalignment"]
    assert [turning + standing, abs(turning - standing)] == pytest.approx([2.245e-5, 7.5773e-6], rel=4e-3)
    assert found["h_min"] == pytest.approx(3e-6 - R_O * found["largest"], rel=1e-9)


@pytest.mark.parametrize("closing", [None, Closing(0.83, 60.0)])
def test_grooves_without_a_mesh_are_refused_as_such(closing):
    """Whether or not a clearance is looked for."""
    flat = seal(rotor=[replace(SPIRAL, count=100_000)])
    scene = flat if closing is None else replace(flat, closing=closing, film=replace(GAS, clearance=None))
    with pytest.raises(SceneError) as error:
        aligned_film(scene, settle(scene, opening_law(scene))[0])
    assert error.value.key == "rotor.grooves"


def test_a_speed_at_which_nothing_holds_the_closing_force_has_no_state():
    """Grooves that pump hardly: not the film of the clearance that another speed has."""
    scene = frozen_at_start(read_scenario(SCENARIOS / "upstream_pumping.toml").scene)
    assert stribeck._point(scene, 3.0).keys() == {"failed"}
    found = stribeck._point(scene, 200.0)["unheated"]
    assert 1e-6 < found["clearance"] < 3e-6 and found["load_share"] == pytest.approx(1.0)
