"""Wave design: fold, drive and stiffest ring of a load in closed form, and of Lebeck's seal against its balances."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scipy.optimize import minimize_scalar

from sealdyn import read_scenario, run_study
from sealdyn.dynamics.elastic_ring import at_rest, design, joined, operating_point, stiffest, with_cells_of
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scene.rings import ElasticRing
from sealdyn.scene.scene import SceneError
from sealdyn.studies.wave_design import of_order

FILE = SCENARIOS / "lebeck_driven.toml"
COARSE = ["film.reynolds.cells_r=6", "film.reynolds.cells_theta=324"]
RING = ElasticRing(bending_stiffness=50.0, radius=0.05, torsion_ratio=2.0, drive_pressure=5e6, drive_length=0.02)
ORDER, WIDTH = 4, 0.7e-6


@pytest.fixture(scope="module")
def curve():
    """A load -P net/(net^2 + b^2), which turns as well: all in closed form; leakage and load support rise."""
    compliance, rows = RING.compliance(ORDER), []
    for net in np.geomspace(0.05e-6, 20e-6, 60):
        initial = net - compliance * load(net)
        rows.append({"net": net, "initial": abs(initial), "turned": -np.angle(initial), "load_support": net,
                     "friction_coefficient": 1.0, "leakage": net**3, "clearance": 1e-6})  # fmt: skip
    return joined(compliance, rows)


def load(net):
    return -3e-12 / RING.compliance(ORDER) * net / (net**2 + WIDTH**2) * (1.0 + 0j)


def test_the_fold_is_where_the_slope_ends(curve):
    soft = replace(RING, drive_pressure=None, drive_length=None, bending_stiffness=25.0)
    # 1 + g (b^2 - x^2)/(x^2 + b^2)^2 = 0, g over the stiffness.
    g = 3e-12 * RING.bending_stiffness / soft.bending_stiffness
    ends = np.sqrt(np.roots([1.0, 2.0 * WIDTH**2 - g, WIDTH**4 + g * WIDTH**2]).real)
    found = design(soft, ORDER, curve)
    assert [found["fold"], found["holds_again"]] == pytest.approx(sorted(ends), rel=2e-3)
    assert found["drivable"] is None and found["limited_by"] == "range"
    limited = design(soft, ORDER, curve, 0.5 * (min(ends) ** 3 + max(ends) ** 3))
    assert limited["limited_by"] == "fold" and limited["net"] == pytest.approx(min(ends), rel=2e-3)
    assert design(soft, ORDER, curve, (0.9 * min(ends)) ** 3)["limited_by"] == "leakage"


def test_the_stiffest_ring_is_where_drive_and_leakage_meet(curve):
    limit = (2e-6) ** 3
    own = stiffest(RING, ORDER, curve, limit)
    assert own["net"] == pytest.approx(2e-6, rel=1e-3)
    softer, stiffer = (design(replace(RING, bending_stiffness=share * own["stiffest"]), ORDER, curve, limit)
                       for share in (0.99, 1.01))  # fmt: skip
    assert (softer["limited_by"], stiffer["limited_by"]) == ("leakage", "drive")
    assert stiffer["initial"] == pytest.approx(stiffer["drivable"], rel=1e-3)
    assert stiffer["net"] == stiffer["largest_stable"] < own["net"]
    assert stiffest(replace(RING, drive_pressure=None), ORDER, curve, limit)["stiffest"] is None
    weak = design(replace(RING, drive_pressure=1.0), ORDER, curve, limit)
    assert weak["net"] is None and weak["limited_by"] == "drive"
    assert design(RING, ORDER, curve, 1e-30)["limited_by"] == "leakage"


def test_a_couple_that_follows_the_waves_makes_work_and_strain_energy_least():
    """Deflection w and twist t of a ring under a couple p l^2/8 per length that is a cosine: energies as in
    tests/ladder/test_elastic_ring.py, here by hand."""
    r, stiff, n, couple = RING.radius, RING.bending_stiffness, ORDER, 5e6 * 0.02**2 / 8.0
    twisting = stiff / RING.torsion_ratio
    bend, turn = np.array([n**2 / r**2, 1.0 / r]), n * np.array([1.0 / r**2, 1.0 / r])
    matrix = math.pi * r * (stiff * np.outer(bend, bend) + twisting * np.outer(turn, turn))
    w, _ = np.linalg.solve(matrix, [0.0, math.pi * r * couple])
    assert RING.driven(n) == pytest.approx(abs(w), rel=1e-10)


def test_what_a_drive_gives_is_as_if_it_was_lapped():
    scene = read_scenario(FILE, COARSE).scene
    ring = scene.stator.elastic
    lapped = replace(scene.stator.waviness[0], amplitude=ring.driven(9))
    plain = replace(ring, drive_pressure=None, drive_length=None)
    same = replace(scene, stator=replace(scene.stator, waviness=[lapped], elastic=plain))
    left, other = (at_rest(one).stator.waviness[0].amplitude for one in (scene, same))
    assert left == pytest.approx(other, rel=1e-9) and 0.2e-6 < left < ring.driven(9)


def test_designs_are_balances_of_the_seal(tmp_path):
    """Orders 3 and 9: what is said of a best waviness, and of a fold, its own balances say."""
    scenario = read_scenario(FILE, COARSE)
    flags = {"orders": (3, 9), "rings": 5, "points": 13}
    answer = run_study("wave-design", scenario, tmp_path / "s.h5", flags=flags, workers=1)
    assert answer["best"]["order"] == 9
    by = {(one["order"], one["limited_by"]): one for one in answer["designs"][::-1] if one["net"]}
    assert by[9, "drive"]["net"] < by[9, "leakage"]["net"]
    for order, limited_by in ((9, "drive"), (3, "leakage")):
        one, scene = by[order, limited_by], of_order(scenario.scene, order)
        ring = replace(scene.stator.elastic, bending_stiffness=one["stiffness"])
        scene = with_cells_of(replace(scene, stator=replace(scene.stator, elastic=ring)), one["net"])
        point = operating_point(scene, one["net"])
        assert point.load_support == pytest.approx(one["load_support"], rel=2e-3)
        assert point.initial == pytest.approx(one["initial"], rel=5e-3)
        reached = point.initial / one["drivable"] if limited_by == "drive" else point.leakage / 2.06e-8
        assert reached == pytest.approx(1.0, rel=1e-2)
    # `scene` has three waves still.
    most = minimize_scalar(lambda net: -operating_point(scene, net).initial, (0.2e-6, 0.33e-6, 0.6e-6), tol=1e-3)
    assert most.x == pytest.approx(by[3, "leakage"]["fold"], rel=0.03)


@pytest.mark.core
@pytest.mark.parametrize(
    ("override", "key"),
    [
        ("stator.elastic.drive_length=0", "stator.elastic.drive_length"),
        ("stator.elastic={bending_stiffness=77, radius=0.05, drive_pressure=1e6}", "stator.elastic.drive_length"),
        ("stator.elastic={bending_stiffness=77, radius=0.05, drive_length=0.02}", "stator.elastic.drive_pressure"),
    ],
)
def test_half_a_drive_is_none(override, key):
    with pytest.raises(ScenarioError) as error:
        read_scenario(FILE, [override])
    assert error.value.key == key


@pytest.mark.parametrize(
    ("file", "flags", "key"),
    [
        ("lebeck_n3", {}, r"stator\.elastic"),
        ("lebeck_driven", {"net_from": 2e-6, "net_to": 1e-6}, "net_to"),
        ("lebeck_driven", {"stiffness_from": 5.0, "stiffness_to": 1.0}, "stiffness_to"),
    ],
)
def test_what_cannot_be_asked(file, flags, key, tmp_path):
    with pytest.raises(SceneError, match=key):
        run_study("wave-design", read_scenario(FILE.with_name(f"{file}.toml")), tmp_path / "s.h5", flags=flags)
