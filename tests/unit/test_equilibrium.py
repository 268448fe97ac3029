"""Clearance, balance ratio and spring force: two give the third; every root is found, against a film solved here."""

import math

import numpy as np
import pytest
from command import SCENARIOS
from oracles import opening_force
from scenes import CLEARANCE, R_I, R_O, SUPPORT, film, fmr, fms, fmsr, run, started

from sealdyn.analysis.film_matrices import State, matrices, opened
from sealdyn.analysis.poincare_map import frozen_at_end
from sealdyn.dynamics.equilibrium import axial_excess, equilibria, settle, support_stiffness
from sealdyn.dynamics.model import Model
from sealdyn.faces.geometry import FLOOR
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import read_scenario
from sealdyn.scene.scene import Closing, SceneError

AREA = math.pi * (R_O**2 - R_I**2)
P_O, P_I = 6e5, 1e5


def opening(clearance, coning=3.125e-3, p_i=P_I, p_o=P_O, geometry="cylindrical"):
    return opening_force(clearance, coning, p_i, p_o, geometry=geometry)


def closing_force(balance, spring, p_i=P_I, p_o=P_O):
    return AREA * (max(p_i, p_o) * balance + min(p_i, p_o) * (1 - balance)) + spring


def scene(closing=None, build=fms, **film_changes):
    """An aligned seal with a flexible ring of 1 kg: its acceleration is the force in newtons."""
    given = dict(outer_pressure=P_O, inner_pressure=P_I) | film_changes
    still = dict(own=0.0, runout=0.0) if build is fms else dict(own=0.0, fixed=0.0)
    return build(film=film(**given), closing=closing or Closing(), **still)


# --- two of three -------------------------------------------------------------------------------------


@pytest.mark.core
@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("balance,spring", [(0.72, 40.0), (0.80, 0.0), (0.65, 120.0)])
def test_balance_ratio_and_spring_give_a_clearance_that_balances(geometry, balance, spring):
    ready = started(scene(Closing(balance, spring), clearance=None, geometry=geometry), 1e-3)
    force = closing_force(balance, spring)
    assert opening(ready.model.clearance, geometry=geometry) == pytest.approx(force, rel=1e-10)
    root = ready.model.interface.equilibria[0]
    assert len(ready.model.interface.equilibria) == 1 and root.stable
    step = 1e-4 * ready.model.clearance
    thinner, thicker = (opening(ready.model.clearance + side * step, geometry=geometry) for side in (-1, 1))
    slope = thinner - thicker
    assert root.stiffness == pytest.approx(slope / (2 * step), rel=1e-6)
    # The aligned scene stands still there.
    y, yp = np.zeros(ready.model.unknowns.size), np.empty(ready.model.unknowns.size)
    ready.segment(0).rhs(0.0, y, yp)
    assert abs(yp[ready.model.unknowns.rate_places[0]]) < 1e-10 * force


def test_two_give_the_third_around_the_circle():
    first = started(scene(Closing(0.72, 40.0), clearance=None), 1e-3)
    spring = started(scene(Closing(balance_ratio=0.72), clearance=first.model.clearance), 1e-3).model.closing.spring
    held = started(scene(Closing(spring_force=40.0), clearance=first.model.clearance), 1e-3)
    balance = held.model.closing.balance_ratio
    assert spring == pytest.approx(40.0, rel=1e-9)
    assert balance == pytest.approx(0.72, rel=1e-12)


def test_clearance_alone_is_held_by_hydraulic_closing():
    ready = started(scene(), 1e-3)
    assert ready.model.clearance == CLEARANCE and ready.model.closing.spring == 0.0
    assert closing_force(ready.model.closing.balance_ratio, 0.0) == pytest.approx(opening(CLEARANCE), rel=1e-12)


def test_equal_pressures_are_held_by_the_spring():
    ready = started(scene(inner_pressure=P_O), 1e-3)
    assert ready.model.closing.at(P_O, P_O, ready.model.closing.spring) == pytest.approx(P_O * AREA, rel=1e-12)
    with pytest.raises(SceneError) as raised:
        started(scene(Closing(spring_force=40.0), inner_pressure=P_O), 1e-3)
    assert raised.value.key.startswith("closing.")


def test_a_pressure_step_moves_the_closing_force():
    """Hydraulic closing follows the sealed pressure, the spring does not."""
    step = PiecewiseLinear((0.0, 0.01, 0.01, 0.02), (P_O, P_O, 4e5, 4e5))
    ready = started(scene(Closing(0.72, 40.0), clearance=None, outer_pressure=step), 0.02)
    late = ready.model.closing.over(ready.intervals[-1], ready.model.scene.film)
    assert late[0] == pytest.approx(closing_force(0.72, 40.0, P_I, 4e5), rel=1e-12)
    assert late[1] == pytest.approx(0.0, abs=1e-9)


def test_the_ring_settles_at_the_new_clearance_after_a_pressure_step():
    """In time, from the old equilibrium to the new one, the support's spring having moved its end with the ring."""
    step = PiecewiseLinear((0.0, 0.001, 0.001, 0.02), (P_O, P_O, 5.5e5, 5.5e5))
    stepped = scene(Closing(0.72, 40.0), clearance=None, outer_pressure=step)
    found = run(stepped, duration=0.02)
    z, clearance = found.q[-1, 0], found.ready.model.clearance
    left = opening(clearance + z, p_o=5.5e5) - closing_force(0.72, 40.0, P_I, 5.5e5) - SUPPORT.axial_stiffness * z
    assert found.ready.model.unknowns.names == ["stator_z"] and abs(z) > 1e-8
    assert abs(left) < 1e-5 * SUPPORT.axial_stiffness * CLEARANCE


# --- mirrored -----------------------------------------------------------------------------------------


def test_inside_pressurised_seal_is_the_outside_pressurised_one_mirrored():
    """Narrow film: a face converging inwards under inner pressure.  The inner film of one is the outer of the other."""
    coning, width = 3.125e-3, R_O - R_I
    outside = started(scene(Closing(0.72, 40.0), model="linear", clearance=None, coning=coning), 1e-3)
    inside = started(
        scene(
            Closing(0.72, 40.0), model="linear", clearance=None, coning=-coning,
            outer_pressure=P_I, inner_pressure=P_O,
        ), 1e-3,
    )  # fmt: skip
    assert not inside.model.closing.outer_is_high and outside.model.closing.outer_is_high
    assert inside.model.clearance == pytest.approx(outside.model.clearance + coning * width, rel=1e-9)
    stiffness = [ready.model.interface.equilibria[0].stiffness for ready in (inside, outside)]
    assert stiffness[0] == pytest.approx(stiffness[1], rel=1e-7)


def test_inside_pressurised_cylindrical_film_balances():
    turned = dict(clearance=None, coning=-3.125e-3, outer_pressure=P_I, inner_pressure=P_O)
    ready = started(scene(Closing(0.72, 40.0), **turned), 1e-3)
    force = closing_force(0.72, 40.0, P_O, P_I)
    assert opening(ready.model.clearance, -3.125e-3, P_O, P_I) == pytest.approx(force, rel=1e-10)
    assert ready.model.interface.equilibria[-1].stable


# --- several roots, or none ---------------------------------------------------------------------------


def bumpy(clearance, inner, outer):
    """A film with three equilibria at 1000 N: 5, 12 and 40 um."""
    x = clearance * 1e6
    return 1000.0 - 0.5 * (x - 5) * (x - 12) * (x - 40) / (1 + (x / 30) ** 3)


def test_all_roots_are_found_and_the_widest_stable_one_is_taken():
    roots = equilibria(film(), bumpy, 1000.0, P_I, P_O)
    assert [root.clearance for root in roots] == pytest.approx([5e-6, 12e-6, 40e-6], rel=1e-9)
    assert [root.stable for root in roots] == [True, False, True]
    slope = -(bumpy(12.001e-6, 0, 0) - bumpy(11.999e-6, 0, 0)) / 2e-9
    assert roots[1].stiffness == pytest.approx(slope, rel=1e-5)
    spring = 1000.0 - closing_force(0.5, 0.0)
    clearance, _, every, _ = settle(scene(Closing(0.5, spring), clearance=None), bumpy)
    assert clearance == pytest.approx(40e-6, rel=1e-9) and len(every) == 3


@pytest.mark.parametrize("balance", [1.2, 0.3])
def test_too_much_or_too_little_closing_has_no_equilibrium(balance):
    with pytest.raises(SceneError) as raised:
        started(scene(Closing(balance, 0.0), clearance=None), 1e-3)
    assert raised.value.key == "closing.balance_ratio"
    # What is expected brackets what a converging film can carry.
    least, most = (float(word) for word in raised.value.expected.split() if word.replace(".", "").isdigit())
    assert least == pytest.approx(min(opening(25e-6 / 100), opening(25e-6 * 100)), rel=1e-3)
    assert most == pytest.approx(max(opening(25e-6 / 100), opening(25e-6 * 100)), rel=1e-3)
    # What the film cannot carry, asperities do.
    assert ("[contact]" in raised.value.expected) == (balance > 1.0)


def test_a_diverging_film_has_only_an_unstable_one():
    force = opening(20e-6, coning=-1e-3)
    spring = force - closing_force(0.3, 0.0)
    with pytest.raises(SceneError) as raised:
        started(scene(Closing(0.3, spring), clearance=None, coning=-1e-3), 1e-3)
    assert "20 um" in raised.value.found
    side = "above" if P_O >= P_I else "below"
    assert f"film.coning {side} 0" in raised.value.expected and "this one widens" in raised.value.expected


def test_flat_faces_have_none():
    """The same force at every clearance: whatever the closing force, nothing decides the clearance."""
    for spring in (0.0, opening(1e-5, 0.0) - closing_force(0.5, 0.0)):
        with pytest.raises(SceneError, match="same at every clearance"):
            started(scene(Closing(0.5, spring), clearance=None, coning=0.0), 1e-3)


def test_a_root_far_from_the_coning_is_found():
    """Coning of 25 um, clearances from 0.1 um to 1 mm."""
    for clearance in (0.1e-6, 1e-6, 1e-4, 1e-3):
        force = opening(clearance)
        ready = started(scene(Closing(0.5, force - closing_force(0.5, 0.0)), clearance=None), 1e-3)
        # The force hardly knows a clearance far from the coning: rounding over its slope.
        assert ready.model.clearance == pytest.approx(clearance, rel=1e-8)


def test_a_flexible_rotor_finds_the_same_clearance():
    one, other = (started(scene(Closing(0.72, 40.0), build, clearance=None), 1e-3) for build in (fms, fmr))
    assert one.model.clearance == other.model.clearance
    y, yp = np.zeros(other.model.unknowns.size), np.empty(other.model.unknowns.size)
    other.segment(0).rhs(0.0, y, yp)
    place = other.model.unknowns.rate_places[other.model.unknowns.names.index("rotor_z")]
    assert abs(yp[place]) < 1e-9 * closing_force(0.72, 40.0)


@pytest.mark.parametrize("spring", ["60 N", "400 N", "4000 N"])
def test_rough_faces_pressed_into_each_other_balance_where_the_run_starts(spring):
    """Also where the film is thinner than 0.6 c and its law is continued: the run's own forces agree."""
    path = SCENARIOS / "run_in.toml"
    ready = started(read_scenario(path, [f'closing.spring_force="{spring}"']).scene, 1e-3)
    if spring == "4000 N":
        assert ready.model.clearance < 0.5 * ready.model.face[FLOOR]
    y, yp = np.zeros(ready.model.unknowns.size), np.empty(ready.model.unknowns.size)
    ready.segment(0).rhs(0.0, y, yp)
    force = 0.1 * yp[ready.model.unknowns.rate_places[ready.model.unknowns.names.index("stator_z")]]
    assert abs(force) < 1e-9 * ready.model.closing_force()


def test_what_a_scene_drives_to_is_closed_as_its_run_is():
    """A pressure that falls takes its share of the closing force with it; it does not decide the balance anew."""
    falls = PiecewiseLinear((0.0, 1.0), (P_O, P_O / 3))
    falling = scene(Closing(None, 40.0), clearance=CLEARANCE, outer_pressure=falls)
    whole, end = started(falling, 2.0), started(frozen_at_end(falling), 2.0)
    last = whole.model.closing.over(whole.intervals[-1], falling.film)[0]
    assert end.model.closing_force() == pytest.approx(last, rel=1e-12)
    assert end.model.axial_shift() == pytest.approx(whole.model.axial_shift(whole.intervals[-1]), rel=1e-9)
    assert abs(end.model.axial_shift()) > 1e-9


@pytest.mark.parametrize("rotor, stator, series", [(3.0, 1.5, 5e5), (0.0, 1.0, 0.0), (1.0, 1.0, 2.5e5)])
def test_supports_hold_the_gap_in_series(rotor, stator, series):
    """Both carry the same force; a ring without axial stiffness carries none."""
    assert support_stiffness(fmsr(rotor_stiffer=rotor, stator_stiffer=stator)) == pytest.approx(series, rel=1e-14)
    assert support_stiffness(fms()) == SUPPORT.axial_stiffness


def test_the_excess_of_opening_force_is_zero_where_the_loads_move_the_gap():
    model = started(scene(Closing(None, 40.0), clearance=CLEARANCE), 1.0).model
    s = model.segment().gap_state(0.0, np.zeros(model.unknowns.size)).copy()
    assert abs(axial_excess(model, s, model.closing_force())(0.0)) < 1e-9 * model.closing_force()
    heavier = axial_excess(model, s, 1.02 * model.closing_force())
    assert heavier(0.0) < 0 < heavier(-0.5 * CLEARANCE)


@pytest.mark.parametrize("name", ["radial", "profiled"])
def test_what_is_left_of_rounding_is_no_stiffness(name):
    """Parallel faces carry the same at every clearance; a coning of a thousandth of it is not rounding."""
    for coning, stiff in ((0.0, False), (1e-6 * CLEARANCE / (R_O - R_I), True)):
        model = Model(scene(coning=coning, model=name, clearance=CLEARANCE))
        found = [model.interface.equilibria[0].stiffness, matrices(model, State())[0][0, 0]]
        assert [value != 0.0 for value in found] == [stiff] * 2
    assert opened(model, 0.0, 0.0) == 0.0


def test_a_force_that_is_no_number_balances_nothing():
    """Of a face a million kilometres wide, say: a warning of Python came before the line that refuses it."""
    found = equilibria(film(), lambda *where: math.nan, 100.0, P_I, P_O)
    assert list(found) == []


def test_equal_pressures_are_told_as_such():
    with pytest.raises(SceneError, match="a difference of the pressures"):
        started(scene(Closing(0.75, 60.0), clearance=None, inner_pressure=P_O), 1e-3)
