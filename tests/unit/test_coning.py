"""Coning that changes: in the gap, in the films' forces, in the squeeze of a cone that opens."""

from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gas_film
from scenes import CLEARANCE, R_I, R_O, SPEED, film, fmr, fms

from sealdyn.dynamics.equilibrium import axial_shift
from sealdyn.dynamics.intervals import split_at_breaks
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.step_bounds import LEAST_CONING
from sealdyn.faces import geometry
from sealdyn.faces.film_thickness import film_thickness, h_min
from sealdyn.films.gas_dam import film as gas_dam
from sealdyn.films.gas_reynolds import film as gas_reynolds
from sealdyn.films.gas_reynolds.cells import thickness_rates, thicknesses
from sealdyn.films.profiled import film as profiled
from sealdyn.films.radial import film as radial
from sealdyn.films.radial import floored
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.checks import check_scene
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Profile, coned, coning_change
from sealdyn.scene.scene import SceneError

MU, P_I, P_O = 0.5e-3, 1e5, 6e5
CHANGE, RATE = 1.7e-4, 0.9
PARTS = [geometry.FORCE, geometry.MOMENT_X, geometry.MOMENT_Y, geometry.FLOW_INNER, geometry.FLOW_OUTER,
         geometry.TORQUE]  # fmt: skip
SHAPE = Profile(radius=(R_I, 0.036, R_O), depth=(0.0, 2e-7, 0.0))
LIQUIDS = {
    "radial": (radial, film(outer_pressure=P_O, inner_pressure=P_I)),
    "planar": (radial, film(outer_pressure=P_O, inner_pressure=P_I, geometry="planar")),
    "floored": (floored, film(outer_pressure=P_O, inner_pressure=P_I, cavitation_pressure=0.0)),
    "profiled": (profiled, film("profiled", outer_pressure=P_O, inner_pressure=P_I, profile=SHAPE)),
    "gas_dam": (gas_dam, replace(gas_film(), model="gas_dam", coning=1e-4)),
}


def state(**slots):
    """A tilted gap that moves, between two turning faces."""
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[geometry.DZ], s[geometry.GX], s[geometry.GY] = 4e-7, 3e-5, -5e-5
    s[geometry.DZ_RATE], s[geometry.GX_RATE], s[geometry.GY_RATE] = 1e-3, 0.02, -0.01
    s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE] = 0.5 * SPEED, SPEED
    s[geometry.VISCOSITY], s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = MU, P_I, P_O
    s[geometry.TEMPERATURE] = 300.0
    for name, value in slots.items():
        s[getattr(geometry, name.upper())] = value
    return s


@pytest.mark.parametrize(("module", "table"), LIQUIDS.values(), ids=LIQUIDS)
def test_a_change_does_what_the_other_coning_does(module, table):
    changed, other = state(coning_change=CHANGE), state()
    module.flow(module.parameters(table, 5e-6, 1e-12), changed)
    module.flow(module.parameters(replace(table, coning=table.coning + CHANGE), 5e-6, 1e-12), other)
    assert changed[PARTS] == pytest.approx(other[PARTS], rel=1e-11)
    plain = state()
    module.flow(module.parameters(table, 5e-6, 1e-12), plain)
    assert changed[geometry.FORCE] != pytest.approx(plain[geometry.FORCE], rel=1e-3)


def test_a_change_does_what_the_other_coning_does_to_stored_gas():
    rates = []
    for coning, change in ((1e-4, CHANGE), (1e-4 + CHANGE, 0.0)):
        f = gas_reynolds.parameters(gas_film(coning=coning), 5e-6)
        s = state(coning_change=change, outer_pressure=1e5, inner_pressure=6e5, viscosity=1.8e-5)
        x = np.full(int(f[gas_reynolds.CELLS] * f[gas_reynolds.ANGLES]), 3e5 * 5e-6)
        rates.append(np.empty(len(x)))
        gas_reynolds.residual(f, s, x, np.zeros(len(x)), rates[-1])
        gas_reynolds.wrench(f, s, x)
        rates.append(s[PARTS[:3]].copy())
    assert rates[0] == pytest.approx(rates[2], rel=1e-10)
    assert rates[1] == pytest.approx(rates[3], rel=1e-10)


def aligned_force(planar, rate, h_rate=0.0, points=4001):
    """Opening force (N) of an aligned cone that opens at a rate (rad/s): r h^3 p' = 12 mu (int h' r dr + c), by the
    trapezoidal rule, in words of its own."""
    r = np.linspace(R_I, R_O, points)
    h = CLEARANCE + (3.125e-3 + CHANGE) * (r - R_I)
    around = np.ones_like(r) if planar else r
    sums = lambda y: np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(r))])  # noqa: E731
    driven = sums((h_rate + rate * (r - R_I)) * around)
    through = 12.0 * MU / (around * h**3)
    c = (P_O - P_I - sums(through * driven)[-1]) / sums(through)[-1]
    p = P_I + sums(through * (driven + c))
    return 2.0 * np.pi * sums(p * r)[-1]


@pytest.mark.parametrize("name", ["radial", "planar", "floored", "profiled"])
def test_a_cone_that_opens_draws_fluid_in(name):
    module, table = LIQUIDS[name]
    table = replace(table, profile=Profile((R_I, 0.036, R_O), (0.0, 0.0, 0.0))) if name == "profiled" else table
    f = module.parameters(table, CLEARANCE, 1e-12)
    still = dict(dz=0.0, gx=0.0, gy=0.0, dz_rate=0.0, gx_rate=0.0, gy_rate=0.0, coning_change=CHANGE)
    forces = []
    for rate in (0.0, RATE):
        s = state(**still, coning_rate=rate)
        module.wrench(f, s)
        forces.append(s[geometry.FORCE])
    expected = [aligned_force(name == "planar", rate) for rate in (0.0, RATE)]
    assert forces == pytest.approx(expected, rel=2e-7)
    # It sucks the faces together, by far more than the oracle's error.
    assert forces[1] < forces[0] - 1e-3 * forces[0]


@pytest.mark.parametrize("name", ["radial", "profiled", "floored"])
def test_what_a_cone_opens_flows_in(name):
    """Volume is conserved: flows at the edges differ by what the film gains."""
    module, table = LIQUIDS[name]
    s = state(coning_change=CHANGE, coning_rate=RATE)
    module.flow(module.parameters(table, CLEARANCE, 1e-12), s)
    r = np.linspace(R_I, R_O, 2001)
    gained = np.trapezoid((1e-3 + RATE * (r - R_I)) * r, r) * 2.0 * np.pi
    assert s[geometry.FLOW_INNER] - s[geometry.FLOW_OUTER] == pytest.approx(gained, rel=1e-6)


def test_the_pressure_over_the_face_integrates_to_the_force():
    module, table = LIQUIDS["radial"]
    f, s = module.parameters(table, CLEARANCE, 1e-12), state(coning_change=CHANGE, coning_rate=20.0)
    module.wrench(f, s)
    r, theta = module.grid(f)
    out = np.empty((1, len(r), len(theta)))
    module.fields(f, s, out)
    force = np.trapezoid(out[0].mean(axis=1) * r, r) * 2.0 * np.pi
    assert force == pytest.approx(s[geometry.FORCE], rel=2e-3)
    still = state(coning_change=CHANGE)
    module.wrench(f, still)
    assert abs(still[geometry.FORCE] - s[geometry.FORCE]) > 0.05 * abs(s[geometry.FORCE])


def test_steady_gas_flows_into_the_cone_that_opens():
    """What pressed gas a film gains at a steady pressure: its rates, beside those of a film that stands still."""
    f = gas_reynolds.parameters(gas_film(coning=1e-4), 5e-6)
    h, rates = np.empty((2, int(f[gas_reynolds.ANGLES]), int(f[gas_reynolds.CELLS]) + 2))
    rates = np.empty((len(h), h.shape[1] - 2))
    thicknesses(f, state(), h, np.empty(len(h)))
    thickness_rates(f, state(coning_rate=RATE), h, rates)
    still = np.empty_like(rates)
    thickness_rates(f, state(), h, still)
    r = gas_reynolds.grid(f)[0][1:-1]
    assert rates - still == pytest.approx(np.broadcast_to(RATE * (r - 0.032), rates.shape), rel=1e-11)


@pytest.mark.core
def test_thickness_and_its_rate_follow_the_cone():
    f = geometry.face_parameters(film(), CLEARANCE)
    at = [state(coning_change=CHANGE + k * 1e-6 * RATE, coning_rate=RATE) for k in (-1, 0, 1)]
    for s, k in zip(at, (-1, 0, 1), strict=True):
        for slot, rate in ((geometry.DZ, geometry.DZ_RATE), (geometry.GX, geometry.GX_RATE),
                           (geometry.GY, geometry.GY_RATE)):  # fmt: skip
            s[slot] += k * 1e-6 * s[rate]
    for r, theta in ((R_I, 0.3), (0.0355, 2.0), (R_O, 4.0)):
        h = [film_thickness(f, s, r, theta) for s in at]
        rate = 1e-3 + r * (0.02 * np.sin(theta) + 0.01 * np.cos(theta)) + RATE * (r - R_I)
        assert (h[2] - h[0]) / 2e-6 == pytest.approx(rate, rel=1e-8)
    # A cone that closes outwards is thinnest there.
    closing = state(coning_change=-3.125e-3 - 4e-4, gx=0.0, gy=0.0)
    assert h_min(f, closing)[0] == pytest.approx(CLEARANCE + 4e-7 - 4e-4 * (R_O - R_I), rel=1e-12)
    assert h_min(f, closing)[2] == R_O


def table_of(times, values):
    return PiecewiseLinear(tuple(times), tuple(values))


def changing(**more):
    """A seal whose speed, temperature and coning are tables over time."""
    given = dict(
        outer_pressure=P_O, inner_pressure=P_I, coning=table_of([0.0, 0.01, 0.03], [3e-3, 2.5e-3, 2.9e-3]),
        coning_per_speed_squared=-4e-10, temperature=table_of([0.0, 0.02], [300.0, 340.0]), coning_per_kelvin=6e-6,
        coning_reference_temperature=290.0,
    )  # fmt: skip
    scene = fms(film=film(**(given | more)))
    return replace(scene, shaft=Shaft(speed=table_of([0.0, 0.025], [100.0, 1500.0])))


def test_segments_follow_the_law():
    scene = changing()
    model, law = Model(scene), scene.film
    legs = split_at_breaks(0.035, scene.shaft.speed, 0.0, [scene.shaft.speed, law.coning, law.temperature])
    for interval in legs:
        segment = model.segment(interval)
        least = np.inf
        for tau in np.linspace(0.0, interval.length, 7):
            t = interval.time + tau
            coning = law.coning.at(t) - 4e-10 * scene.shaft.speed.at(t) ** 2 + 6e-6 * (law.temperature.at(t) - 290.0)
            s = segment.gap_state(tau, np.zeros(segment.size))
            found, rate = s[geometry.CONING_CHANGE], s[geometry.CONING_RATE]
            assert 3e-3 + found == pytest.approx(coning, rel=1e-12)
            least = min(least, found)
            rest = np.zeros(segment.size)
            near = [segment.gap_state(tau + step, rest)[geometry.CONING_CHANGE] for step in (-1e-6, 1e-6)]
            assert np.diff(near)[0] / 2e-6 == pytest.approx(rate, rel=1e-6)
        # The watch between steps counts on the least of it.
        assert segment.swing[LEAST_CONING] <= least + 1e-15
        assert segment.swing[LEAST_CONING] >= least - 2e-5
    assert coned(scene).coning == pytest.approx(3e-3 - 4e-10 * 1e4 + 6e-6 * 10.0)
    assert coning_change(scene, speed=1000.0) == pytest.approx(-4e-4 + 6e-5)


def test_what_cannot_be():
    class Run:
        start, duration, turns = "rest", 0.01, None

    step = table_of([0.0, 0.01, 0.01, 0.02], [3e-3, 3e-3, 2e-3, 2e-3])
    for key, scene in {
        "film.coning": changing(coning=step),
        "film.temperature": changing(temperature=None),
        "film.coning_reference_temperature": changing(coning_reference_temperature=None),
        "shaft.speed": replace(changing(), shaft=Shaft(speed=table_of([0.0, 0.01, 0.01], [100.0, 100.0, 900.0]))),
    }.items():
        with pytest.raises(SceneError) as caught:
            check_scene(scene, Run)
        assert caught.value.key == key
    with pytest.raises(SceneError, match="both of them"):
        check_scene(changing(coning_per_kelvin=0.0, temperature=None), Run)
    with pytest.raises(SceneError, match="open film"):
        check_scene(changing(coning=-2e-3), Run)
    with pytest.raises(SceneError, match="linear"):
        Model(fmr(film=film("linear", coning_per_speed_squared=1e-10)))


def test_linear_theory_at_another_speed_has_the_coning_of_that_speed():
    """The scene at one speed, linearised at another, against the scene at the other, its closing force the same."""
    law = dict(outer_pressure=P_O, inner_pressure=P_I, coning_per_speed_squared=1.2e-9)
    slow = Model(fms(film=film(**law), speed=600.0))
    found = slow.linear_scene(speed=1400.0)
    given = film(**law | {"coning": 3.125e-3 + 1.2e-9 * 1400.0**2, "coning_per_speed_squared": 0.0})
    fast = Model(fms(film=replace(given, clearance=slow.clearance), speed=1400.0))
    shift = axial_shift(slow, slow.start, 1400.0)[0]
    expected = fast.linear_scene(shift=shift)
    assert found.film_k == pytest.approx(expected.film_k, rel=1e-7, abs=1e-6 * np.max(np.abs(expected.film_k)))
    assert found.film_d == pytest.approx(expected.film_d, rel=1e-7, abs=1e-9 * np.max(np.abs(expected.film_d)))
    # The wider cone lifts off, and at the other speed's own balance.
    assert shift > 0.05 * slow.clearance
    excess = fast.interface.opening_force(slow.clearance + shift, P_I, P_O) - slow.closing_force()
    assert excess == pytest.approx(5e5 * shift, rel=1e-6)
