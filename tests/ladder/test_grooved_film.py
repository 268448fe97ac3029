"""Steady film over a patterned face: rows computed elsewhere, plain faces, today's gas film, and itself turned."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gap_state, gas_film
from gas_faces import steady as of_cells
from grooved_faces import AREA, GAS, LIQUID, R_I, R_O, ROWS, SPIRAL, TEE, film, films_of, pattern_of

from sealdyn.analysis.sources.grooved_faces import many_over_narrow
from sealdyn.closed_form.film import GroovedFace, narrow_groove_gas, narrow_groove_liquid
from sealdyn.faces.geometry import FLOW_INNER, FORCE, TORQUE
from sealdyn.faces.pattern import Spiral
from sealdyn.films import film_named
from sealdyn.films._grooved.aligned import axial_stiffness
from sealdyn.films._grooved.aligned import pattern_of as pattern_of_scene
from sealdyn.films._grooved.balance import Conditions, NoSteadyFilm, extrapolated, steady, steady_pair
from sealdyn.films._grooved.mesh import mesh_of
from sealdyn.films._grooved.motion import Motion, circle_impedance
from sealdyn.scene.film import Film, Pads
from sealdyn.scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, GasReynolds
from sealdyn.scene.patterns import Grooves

PLAIN = replace(SPIRAL, depth=0.0)
FACES = "inner_radius", "outer_radius"


def statics(row, found):
    lower = min(row["inner_pressure"], row["outer_pressure"])
    area = math.pi * (row["outer_radius"] ** 2 - row["inner_radius"] ** 2)
    return {"force": found.force - lower * area, "outflow": found.flows[0], "torque": found.torque}


@pytest.mark.core
@pytest.mark.parametrize("name", ROWS)
def test_force_flow_and_torque_of_the_rows(name):
    row, (coarse, fine, order) = ROWS[name], films_of(name)
    # Of a liquid's flow two discretisations of the source differ by 0.5 %.
    least = {"outflow": 0.0 if row["gas"] else 5e-3}
    for key, value in statics(row, fine).items():
        if key not in row["expected"]:
            continue
        expected, tolerance = row["expected"][key]
        better, error = extrapolated(statics(row, coarse)[key], value, order)
        assert better == pytest.approx(expected, rel=max(tolerance, least.get(key, 0.0))), key
        # And the fine mesh errs by about what it says.
        assert abs(value - expected) < 3.0 * error + tolerance * abs(expected), key


@pytest.mark.parametrize("pattern", [SPIRAL, TEE, replace(SPIRAL, angle=math.radians(-40.0), share=0.35)])
@pytest.mark.parametrize("conditions", [GAS, LIQUID, replace(GAS, slip=300.0, coning=1e-4)])
def test_what_enters_leaves(pattern, conditions):
    found = film(pattern, conditions)
    inner, outer = found.flows
    assert inner == pytest.approx(outer, rel=1e-9)
    # Every triangle hands on what it takes, whatever the pressures.
    p = found.p * (1.0 + 0.3 * np.sin(17.0 * np.arange(len(found.p))))
    leaving = found.film.leaving(p)
    assert abs(leaving.sum()) < 1e-12 * np.abs(leaving).sum()


def test_plain_faces_to_rounding():
    found = film(PLAIN, columns=16)
    inner, outer = found.flows
    flow = math.pi * 3e-6**3 * (1e5**2 - 5e5**2) / (12.0 * 1.8e-5) / math.log(R_O / R_I)
    assert (inner, outer) == pytest.approx((flow, flow), rel=1e-11)
    assert found.torque == pytest.approx(math.pi / 2 * 1.8e-5 * 1000.0 * (R_O**4 - R_I**4) / 3e-6, rel=1e-8)
    errors = [film(PLAIN, columns=8, times=times).force - 1e5 * AREA - 907.2336887 for times in (1, 2, 4)]
    assert abs(errors[1]) < 1e-3 * 907.0
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx([2.0, 2.0], abs=0.1)
    slipping = film(PLAIN, replace(GAS, slip=300.0)).flows[0]
    more = math.pi * 300.0 * 3e-6**2 * (1e5 - 5e5) / math.log(R_O / R_I)
    assert slipping == pytest.approx(flow + more, rel=1e-11)
    liquid = film(PLAIN, LIQUID)
    flow = math.pi * 3e-6**3 * (1e5 - 5e5) / (6.0 * 1e-3) / math.log(R_O / R_I)
    assert liquid.flows == pytest.approx((flow, flow), rel=1e-11)


def test_a_pattern_without_depth_is_the_gas_film_of_plain_faces():
    """With slip and coning, force, flow and friction of the cells over radius and angle."""
    table = Film(R_I, R_O, 5e5, 1e5, clearance=3e-6, coning=2e-4, gas="air", temperature=300.0, model="gas_reynolds",
                 viscosity=1.8e-5, gas_reynolds=GasReynolds(cells=(24, 3), slip=True))  # fmt: skip
    old, s = film_named("gas_reynolds"), gap_state(table, 1000.0)
    f = old.parameters(table, 3e-6)
    x = np.empty(len(old.unknowns(f).names))
    assert old.start(f, s, x) == 0
    old.flow(f, s, x)
    conditions = replace(GAS, coning=2e-4, viscosity=1.8e-5, slip=math.sqrt(0.5 * math.pi * 287.053 * 300.0))
    found = film(PLAIN, conditions, columns=16, times=2)
    normal = NORMAL_TEMPERATURE / (300.0 * NORMAL_PRESSURE)
    assert found.force == pytest.approx(s[FORCE], rel=3e-4)
    assert normal * found.flows[0] == pytest.approx(s[FLOW_INNER], rel=3e-3)
    assert found.torque == pytest.approx(s[TORQUE], rel=1e-3)


@pytest.mark.slow
def test_pads_with_sharp_edges_are_those_with_narrow_flanks():
    """The cells over radius and angle see the flanks, which end at 222.6 N as they get narrower, in either face."""
    share = 0.5 * 6 / (2.0 * math.pi)
    pads = pattern_of_scene(Grooves(6, 8e-6, 0.034, 0.038, share, "pad"))
    smooth = Pads(6, 8e-6, 0.5, 0.034, 0.038, 5e-5)
    table = gas_film((48, 384), inner_pressure=1.5e5, outer_pressure=1e5, clearance=5e-6, pads=[smooth])
    s = gap_state(table, 2000.0)
    of_cells(film_named("gas_reynolds").parameters(table, 5e-6), s)
    found = []
    for face in ("stator", "rotor"):
        conditions = Conditions(5e-6, 1.8e-5, 1.5e5, 1e5, 2000.0, face)
        coarse, fine, power = steady_pair(pads, 0.032, 0.040, conditions)
        numbers = (lambda one: one.force, lambda one: one.torque, lambda one: one.flows[0])
        found.append([extrapolated(number(coarse), number(fine), power)[0] for number in numbers])
    assert found[0] == pytest.approx(found[1], rel=1e-4)
    assert found[0][0] == pytest.approx(s[FORCE], rel=4e-3)
    assert found[0][1] == pytest.approx(s[TORQUE], rel=2e-2)
    normal = NORMAL_TEMPERATURE / (300.0 * NORMAL_PRESSURE)
    assert normal * found[0][2] == pytest.approx(s[FLOW_INNER], rel=6e-2)


@pytest.mark.parametrize("conditions", [GAS, LIQUID])
def test_turned_round_and_in_the_other_face(conditions):
    reversed_angle, mirror = replace(SPIRAL, angle=-SPIRAL.angle), {"bisections": 0}
    found = film(SPIRAL, conditions, **mirror)
    back = film(reversed_angle, replace(conditions, relative_speed=-conditions.relative_speed), **mirror)
    other = film(reversed_angle, replace(conditions, face="stator"), **mirror)
    same = found.force, found.flows[0], found.torque
    assert (back.force, back.flows[0], -back.torque) == pytest.approx(same, rel=1e-9)
    assert (other.force, other.flows[0], other.torque) == pytest.approx(same, rel=1e-9)
    # The wrong way round it lifts less, and lets less through inwards.
    wrong = film(reversed_angle, conditions, **mirror)
    assert wrong.force < found.force and found.flows[0] < wrong.flows[0]


def test_the_power_of_the_shaft_is_dissipated_or_pumps():
    found = film(SPIRAL, LIQUID)
    mesh, part = found.film.mesh, found.film
    slopes = [np.sum(gradient * found.p[mesh.corners], axis=1) for gradient in mesh.gradients]
    pressed = 12.0 * np.sum(mesh.area * part.viscous * (slopes[0] ** 2 + slopes[1] ** 2))
    plain, grooved = 0.0555**4 - R_I**4, R_O**4 - 0.0555**4
    sheared = 0.5 * math.pi * 1e-3 * 300.0**2 * (plain / 3e-6 + 0.5 * grooved / 3e-6 + 0.5 * grooved / 9e-6)
    pumped = found.flows[0] * (5e5 - 1e5)
    assert found.torque * 300.0 - sheared == pytest.approx(pressed + pumped, rel=1e-7)
    assert abs(pumped) > 1e-3 * pressed


def observed(values):
    return math.log2(abs(values[1] - values[0]) / abs(values[2] - values[1]))


@pytest.mark.parametrize("name, low, high", [("gas_5bar", 1.0, 1.6), ("liquid_upstream_pumping", 1.0, 1.6)])
def test_order_of_convergence_of_spirals(name, low, high):
    """Twice the exponent of the tips, not 2."""
    coarse, fine, order = films_of(name)
    faces = [ROWS[name][key] for key in FACES]
    finer = steady(mesh_of(pattern_of(ROWS[name]), *faces, 16, 4), fine.film.conditions)
    assert low < observed([found.force for found in (coarse, fine, finer)]) < high
    assert low < order < high


PUMPING = Spiral(10, 0.026, 0.0285, math.radians(-15.0), 0.5, 8e-6)


def with_cavities(columns=8, times=1, **changes):
    """The liquid of row liquid_with_cavities, which grooves pump outwards; a film on a coarse mesh."""
    conditions = replace(Conditions(3e-6, 1e-3, 1e5, 1.5e5, 600.0, gas=False, cavity=0.0), **changes)
    return steady(mesh_of(PUMPING, 0.026, 0.031, columns, times), conditions)


def test_cavities_of_the_row_take_their_share_of_the_face():
    assert with_cavities(16, 4).cavitated == pytest.approx(0.0137, rel=0.15)


@pytest.mark.parametrize("cavity", [0.0, -5e4])
@pytest.mark.parametrize("changes", [{}, {"relative_speed": -1500.0}, {"face": "stator", "coning": 1e-4}])
def test_cavities_keep_their_liquid(cavity, changes):
    found = with_cavities(cavity=cavity, **changes)
    inner, outer = found.flows
    assert inner == pytest.approx(outer, rel=1e-9)
    assert found.p.min() >= cavity and found.void.min() == 0.0 and np.all(found.p[found.torn] == cavity)
    step = 1e-5 * 3e-6
    sides = [with_cavities(cavity=cavity, clearance=3e-6 + d, **changes).force for d in (step, -step)]
    assert axial_stiffness(found) == pytest.approx((sides[1] - sides[0]) / (2.0 * step), rel=1e-5)
    # Over one pitch as over the circle, at any frequency.
    answers = circle_impedance(found)(700j)
    motion = Motion(found, changes.get("relative_speed", 600.0))
    assert answers[0, 0] == pytest.approx(motion.axial_impedance(700j), rel=1e-9)
    assert answers[1, 1] - 1j * answers[1, 2] == pytest.approx(motion.frame_impedance(700j), rel=1e-9)


def test_without_cavities_there_is_no_void():
    full, kept = with_cavities(cavity=None), with_cavities(cavity=-1e9)
    assert (kept.force, kept.cavitated) == (pytest.approx(full.force, rel=1e-12), 0.0)
    assert full.force > with_cavities().force


def test_no_steady_film_is_told():
    """Not one whose pressures only the bound of a step keeps above zero."""
    with pytest.raises(NoSteadyFilm):
        film(SPIRAL, replace(GAS, clearance=1e-7))
    with pytest.raises(ValueError):
        film(SPIRAL, replace(GAS, coning=-1e-3))


@pytest.mark.slow
def test_many_grooves_are_narrow_ones():
    """In 1/count the film goes to narrow-groove theory."""
    face = GroovedFace(R_I, R_O, 0.0555, R_O, SPIRAL.angle, 0.5, 6e-6, 3e-6)
    for conditions, law in ((LIQUID, narrow_groove_liquid), (GAS, narrow_groove_gas)):
        conditions = replace(conditions, inner_pressure=1e5, outer_pressure=1e5)
        limit = law(face, conditions.viscosity, conditions.entrainment, 1e5, 1e5)
        found = many_over_narrow(face, conditions, limit, (48, 96, 192, 384))
        assert found == pytest.approx([1.0, 1.0], abs=1e-3)
