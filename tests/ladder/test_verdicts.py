"""Stability verdicts, growth rates and critical speeds of random seals against eigenvalues in mpmath and a dense scan
over the shaft speed (eigenvalue_scan.py, which shares nothing with the package).  More of them, and what it costs:
tests/benchmark/verdicts.py."""

import sys
from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from eigenvalue_scan import DIGITS, film_numbers, growth, largest, thresholds, tilt_polynomial
from random_seals import drawn_seal, plain, rough_seal
from scenes import NOTHING, SUPPORT, film, fmr, fms, fmsr, ring

from sealdyn.dynamics import modes
from sealdyn.dynamics.exponents import roots
from sealdyn.dynamics.model import Model
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Rotor, Stator
from sealdyn.simulation.stability import stability

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmark"))
import verdicts

# A film whose squeeze dies out at 7.4e6 1/s, 3000 times the whirl's frequency.
THIN = film(clearance=2e-6, coning=6.25e-4, viscosity=5e-3, outer_pressure=5e4)


def answer(scene):
    model = Model(scene)
    return stability(model, None, model.linear_scene(), True)


@pytest.mark.parametrize("seals,points", [(20, 80), pytest.param(25, 400, marks=pytest.mark.slow)])
def test_random_seals(seals, points):
    bad = [words for _, scene, wanted in verdicts.seals(seals, points) for words in verdicts.judged(scene, wanted)[2]]
    assert not bad


@pytest.mark.parametrize("seals,points", [(20, 80), pytest.param(25, 400, marks=pytest.mark.slow)])
def test_random_seals_that_ride_on_asperities(seals, points):
    drawn = verdicts.seals(seals, points, rough_seal)
    bad = [words for _, scene, wanted in drawn for words in verdicts.judged(scene, wanted)[2]]
    assert not bad


def test_growth_rates_of_the_thin_film():
    """At the threshold a ten-millionth of the speed decides: 1e-9 of the squeeze's rate would be 7e-3 1/s."""
    found = answer(fms(film=THIN, speed=5000.0))
    assert found["verdict"] == "unstable" and found["growth_rate"] == pytest.approx(0.449407, rel=1e-5)
    (threshold,) = found["thresholds"]
    assert found["critical_speed"] == threshold == pytest.approx(3840.6108, rel=1e-7)
    for share, verdict in ((1 - 1e-7, "stable"), (1 + 1e-7, "unstable")):
        beside = answer(fms(film=THIN, speed=share * threshold))
        exact = float(growth(plain(fms(film=THIN, speed=share * threshold)))["all"])
        assert beside["verdict"] == verdict and abs(beside["growth_rate"] - exact) <= beside["growth_rate_uncertainty"]
        assert 0.0 < beside["growth_rate_uncertainty"] < 1e-2 * abs(exact)


@pytest.mark.parametrize("rate", [-0.0233, 0.0137, 0.496])
def test_small_growth_of_a_stiff_film_is_no_neutrality(rate):
    """A film of a micrometre and a light ring: squeeze modes beyond 1e8 1/s."""
    soft = replace(SUPPORT, axial_stiffness=2e4)
    light = Stator(**ring(mass=0.02, transverse_inertia=1.6e-5, polar_inertia=3e-5, support=soft))
    scene = fms(film=film(clearance=1e-6, coning=2e-4, viscosity=5e-3, outer_pressure=5e4), stator=light)
    (threshold,) = thresholds(plain(replace(scene, shaft=Shaft(speed=3e4))), 80)
    with mp.workdps(DIGITS):
        numbers, seal = film_numbers(plain(scene)["film"]), plain(scene)
        speed = mp.findroot(
            lambda w: largest(tilt_polynomial(seal, numbers, w)) - rate, (threshold, 1.1 * threshold), tol=1e-20
        )
    found = answer(replace(scene, shaft=Shaft(speed=float(speed))))
    assert max(abs(complex(m["re"], m["im"])) for m in found["modes"]) > 1e8
    assert found["growth_rate"] == pytest.approx(rate, rel=1e-6)
    assert found["verdict"] == ("unstable" if rate > 0 else "stable")
    assert found["critical_speed"] == pytest.approx(threshold, rel=1e-8)


def both(speed=1000.0, stator_speed=0.0, table=THIN):
    """Both rings float on one film, the rotor slender."""
    made = replace(fmsr(speed=speed), film=table, rotor=Rotor(**ring(3.0)))
    return replace(made, stator=replace(made.stator, speed=stator_speed))


@pytest.mark.parametrize("stator_speed", [0.0, -2000.0, 700.0])
def test_both_rings_float(stator_speed):
    for table in (film(), THIN):
        scene = both(5000.0, stator_speed, table)
        expected = thresholds(plain(scene), 120)
        inside = [w for w in answer(scene)["thresholds"] if 5.0 <= w <= 5e4]
        assert inside == pytest.approx(expected, rel=1e-8)


@pytest.mark.core
def test_all_thresholds_not_the_first_alone():
    """Between rings that turn against one another the whirl loses and regains its damping."""
    draw, several = np.random.default_rng(5), 0
    while several < 2:
        scene = drawn_seal(draw)
        found = answer(scene)["thresholds"]
        if len(found) > 1:
            several += 1
            inside = [w for w in found if 1e-3 <= w / scene.shaft.speed <= 10.0]
            assert inside == pytest.approx(thresholds(plain(scene), 200), rel=1e-8)


def test_a_shaft_that_turns_the_other_way_is_the_same_seal():
    """All speeds turned round: the same growth, the same thresholds in the shaft's own direction."""
    one, other = (answer(both(sign * 3000.0, sign * -500.0)) for sign in (1.0, -1.0))
    assert one["growth_rate"] == pytest.approx(other["growth_rate"], rel=1e-12)
    for key in ("thresholds", "resonance_speeds"):
        assert one[key] == pytest.approx(other[key], rel=1e-10) and (key != "thresholds" or one[key])


def test_neutral_only_where_nothing_damps():
    undamped = replace(SUPPORT, axial_damping=0.0)
    free = fmr(film=film("linear", coefficients=NOTHING), rotor=Rotor(**ring(support=undamped)))
    found = answer(free)
    assert found["verdict"] == "neutral" and found["critical_speed"] is None
    assert abs(found["growth_rate"]) <= found["growth_rate_uncertainty"] < 1e-10
    # A damper a hundred-billionth as strong as the reference seal's decides already.
    barely = replace(free, rotor=Rotor(**ring(support=replace(SUPPORT, axial_damping=3e-9))))
    assert answer(barely)["verdict"] == "stable"


@pytest.mark.parametrize("apart", [0.0, 1e-12, 1e-6])
def test_a_double_root_is_as_sure_as_its_square_root(apart):
    """(s + 3) (s + 3 + apart): the error of either is that of the square root of rounding, no infinity."""
    values, errors = roots([(1.0, 6.0 + apart, 9.0 + 3.0 * apart)], (0.0, 0.0))
    exact = np.array([-3.0, -3.0 - apart])
    assert np.all(np.min(np.abs(values[:, None] - exact), axis=1) <= errors + 1e-15) and np.all(errors < 1e-6)


def test_bounds_on_film_coefficients_hold():
    """The doubt that comes with them is more than they err, and no more than 1e-9 of them (unless they are none)."""
    draw = np.random.default_rng(11)
    for _ in range(8):
        scene = drawn_seal(draw)
        linear, exact = Model(scene).linear_scene(), [float(x) for x in film_numbers(plain(scene)["film"])]
        found = linear.film_k[1, 1], linear.film_d[1, 1], linear.film_k[0, 0], linear.film_d[0, 0]
        doubt = (*linear.doubt.tilt, *linear.doubt.axial)
        for value, true, bound in zip(found, exact, doubt, strict=True):
            assert abs(value - true) <= bound
        assert found[0] == 0.0 or doubt[0] <= 1e-9 * abs(found[0])
        assert found[1] == 0.0 or doubt[1] <= 1e-9 * abs(found[1])


def test_bounds_on_coefficients_of_rough_faces_hold():
    """However near a film edge is to where asperities meet or the floor of rough faces begins: differences across would
    be wrong by a thousandth there, and foretell less."""
    for n in range(60):
        scene = rough_seal(np.random.default_rng([77, n]))
        linear, exact = Model(scene).linear_scene(), [float(x) for x in film_numbers(plain(scene)["film"])]
        found = linear.film_k[1, 1], linear.film_d[1, 1], linear.film_k[0, 0], linear.film_d[0, 0]
        # Asperities that all but touch carry less than any rounding; a polynomial fitted twice is the same to 1e-11.
        rough = plain(scene)["film"]
        nothing = 1e-15 * rough["rough"][1] * scene.film.outer_radius**2 / scene.contact.roughness
        fit = 3e-11 * rough["gaussian"]
        for value, true, bound in zip(found, exact, (*linear.doubt.tilt, *linear.doubt.axial), strict=True):
            assert abs(value - true) <= bound + nothing + fit * abs(true), n


def test_a_linear_film_that_borrows_has_the_floor_of_rough_faces_too():
    scene = fms(film=film(clearance=0.3e-6, coning=1e-5), contact=Contact(roughness=0.2e-6, compressive_strength=3e8))
    own = Model(scene).linear_scene()
    lent = Model(replace(scene, film=replace(scene.film, model="linear", coefficients="radial"))).linear_scene()
    assert lent.film_k == pytest.approx(own.film_k, rel=1e-9, abs=1e-9 * own.film_k[1, 1])


@pytest.mark.parametrize("floor", [0.0, -1.0, -1e5])
@pytest.mark.parametrize("lent", [{}, {"model": "linear", "coefficients": "radial"}], ids=["radial", "lent"])
def test_a_floor_that_only_large_motion_meets_is_none_to_small_motion(floor, lent):
    """At the lower of the two pressures, or however little below."""
    table = replace(THIN, **lent)
    plain_film, floored = (answer(fms(film=replace(table, cavitation_pressure=p), speed=5000.0)) for p in (None, floor))
    assert floored == plain_film


def test_verdict_is_neutral_where_the_bound_contains_zero():
    at = [modes.Mode(complex(rate, 100.0), "tilt", "forward", 2.0) for rate in (-3.0, -1.0, 1.0, 3.0)]
    assert [modes.verdict([mode]) for mode in at] == ["stable", "neutral", "neutral", "unstable"]
    assert modes.verdict([at[1], at[3]]) == "unstable" and modes.verdict([at[0], at[1]]) == "neutral"
    # The second may be the one that grows most.
    unsure = [modes.Mode(-1.0, "tilt", "none", 0.1), modes.Mode(-2.0, "tilt", "none", 5.0)]
    assert modes.uncertainty(unsure) == pytest.approx(4.0) and modes.verdict(unsure) == "neutral"
    assert modes.growth([at[2], at[0]]) == 0.0 and modes.growth([at[0]]) == -3.0
