"""The gas dam's kernel against the marched differential equation (marched_dam.py), its limits and its statuses."""

import numpy as np
import pytest
from marched_dam import Dam, flow
from oracles import viscous_dam_load
from scipy.integrate import quad

from sealdyn.closed_form import zuk_1972 as zuk
from sealdyn.films import _gas_dam as gas

SEAL = zuk.CRUISE
R_I, R_O, P_0, P_3 = SEAL.inner_radius, SEAL.outer_radius, SEAL.high_pressure, SEAL.low_pressure
WIDTH = R_O - R_I
MIL = zuk.MIL
FRICTION = {"laminar": lambda re: 24 / re, "turbulent": lambda re: 0.079 / re**0.25}
FRICTION["blend"] = lambda re: (FRICTION["laminar"](re) ** 8 + FRICTION["turbulent"](re) ** 8) ** 0.125
WIDTHS = "constant", "zuk", "radial"


def sutherland(temperature):
    return SEAL.sutherland[0] * temperature**1.5 / (temperature + SEAL.sutherland[1])


def block(friction="laminar", width="constant", radii=(R_I, R_O), **more):
    more = {"sutherland": SEAL.sutherland} | more
    gases = {"gas_constant": SEAL.gas_constant, "heat_ratio": SEAL.heat_ratio}
    return gas.parameters(*radii, SEAL.temperature, **gases, friction=friction, width=width, **more)


def solved(f, films, pressures=(P_0, P_3)):
    """Code, and the solution with the force's arm about the mean radius (m) instead of its moment."""
    out = np.zeros(gas.DAM_SIZE)
    code = gas.dam(f, *films, *pressures, out)
    found = out[: gas.LENGTH].copy()
    if found[gas.FORCE]:
        found[gas.MOMENT] /= found[gas.FORCE]
    return code, found


def ends(mean, ratio):
    """Films at both radii for a mean film (mil) and (h2 - h1)/(2 h_mean)."""
    return mean * MIL * (1 - ratio), mean * MIL * (1 + ratio)


def against_march(films, pressures, friction="laminar", width="constant", radii=(R_I, R_O), loss=1.0, **more):
    """Largest relative difference of mass flow, force, centre and Mach numbers to the march; None where neither has
    a flow.  Radii, films and pressures from the side with the high pressure."""
    inwards = radii[0] > radii[1]
    order = slice(None, None, -1 if inwards else 1)
    f = block(friction, width, radii[order], entrance_loss=loss, **more)
    code, found = solved(f, films[order], pressures[order])
    if inwards:
        found[[gas.MOMENT, gas.MASS_FLOW]] *= -1.0
    laws = sutherland, FRICTION[friction], width != "constant", width == "radial", loss
    dam = Dam(radii, films, pressures, SEAL.temperature, SEAL.gas_constant, SEAL.heat_ratio, *laws)
    truth = flow(dam)
    assert (code == gas.SOLVED) == (truth is not None), (code, truth, films, pressures)
    if truth is None:
        return None
    centre = 0.5 + found[gas.MOMENT] / abs(radii[1] - radii[0])
    ours = found[gas.MASS_FLOW], found[gas.FORCE], centre, found[gas.ENTRANCE_MACH], found[gas.EXIT_MACH]
    return np.max(np.abs(np.array(ours) / truth - 1))


@pytest.mark.core
@pytest.mark.parametrize("row", zuk.ZUK_1972, ids=lambda row: f"{row.tilt:g}-{row.mean_film / MIL:.1f}mil")
def test_table_against_the_march(row):
    films = row.mean_film - row.tilt * WIDTH / 2, row.mean_film + row.tilt * WIDTH / 2
    assert against_march(films, (P_0, P_3)) < 1e-9
    # Pieces, 2e-6 measured.
    for width in WIDTHS[1:]:
        assert against_march(films, (P_0, P_3), width=width) < 1e-5
        assert against_march(films, (P_0, P_3), width=width, pieces=16) < 1e-6


def random_dam(rng):
    """Films, pressures, law, entrance loss."""
    films = ends(np.exp(rng.uniform(np.log(0.05), 0)), rng.uniform(-0.9, 0.9))
    pressures = P_3 * np.exp(rng.uniform(np.log(1.05), np.log(20))), P_3
    return films, pressures, rng.choice(list(FRICTION)), rng.choice([1.0, 0.7])


def test_random_dams_against_the_march():
    rng, count = np.random.default_rng(60), 60
    worst, without = 0.0, 0
    for _ in range(count):
        films, pressures, friction, loss = random_dam(rng)
        error = against_march(films, pressures, friction, loss=loss)
        without += error is None
        worst = max(worst, error or 0.0)
    # Measured 2e-9; the march itself is as good as 1e-10 to 1e-9.
    assert worst < 1e-6
    assert without < 0.1 * count


def test_diffusers_against_the_march():
    """Divergent films that the gas leaves slower than it came, up to the entrance's Mach number 1; none beyond."""
    rng, shapes, machs = np.random.default_rng(3), [], []
    f, out = block("blend"), np.zeros(gas.DAM_SIZE)
    for _ in range(40):
        films, pressures = ends(rng.uniform(1.5, 5), rng.uniform(0.2, 0.6)), (P_3 * rng.uniform(1.1, 1.6), P_3)
        error = against_march(films, pressures, "blend")
        assert error is None or error < 1e-6
        if gas.dam(f, *films, *pressures, out) == gas.SOLVED and out[gas.EXIT_MACH] < out[gas.ENTRANCE_MACH]:
            friction = FRICTION["blend"](out[gas.REYNOLDS])
            shapes.append((films[1] - films[0]) / (WIDTH * SEAL.heat_ratio * friction))
            machs.append(out[gas.ENTRANCE_MACH])
    # On both sides of A'/A = g f/h.
    assert len(machs) > 10 and max(machs) > 0.8 and min(shapes) < 1 < max(shapes)


def test_wide_dam_against_the_march():
    """A dam of 40 % of its radius: four pieces, and the slope of their error."""
    radii = (0.06, 0.09)
    for films in ((8e-6, 8e-6), (4e-6, 12e-6), (12e-6, 4e-6)):
        errors = [against_march(films, (P_0, P_3), "blend", "radial", radii, pieces=n, points=16) for n in (2, 4, 8)]
        assert errors[1] < 1e-3
        assert errors[2] < 0.4 * errors[1] < 0.16 * errors[0]


@pytest.mark.parametrize("friction", ["laminar", "turbulent"])
@pytest.mark.parametrize("coning", [-1e-3, -2e-4, 0.0, 5e-4, 2e-3])
def test_friction_and_areas_follow_the_radius(friction, coning):
    """A dam of 15 % of its radius, high pressure inside and outside, slow and choked."""
    machs = []
    for radii in ((0.030, 0.035), (0.035, 0.030)):
        # 4 um at the inner radius, or at the outer one if that is the narrow edge.
        films = [max(4e-6, 4e-6 - coning * 0.005) + coning * (r - 0.030) for r in radii]
        for pressures in ((2e5, 1e5), (3e6, 1e5)):
            assert against_march(tuple(films), pressures, friction, "radial", radii) < 3e-4
            order = slice(None, None, -1 if radii[0] > radii[1] else 1)
            f = block(friction, "radial", radii[order])
            machs.append(solved(f, films[order], pressures[order])[1][gas.EXIT_MACH])
    assert min(machs) < 0.5 < max(machs), machs


@pytest.mark.parametrize("ratio", [0.0, 0.4, -0.4])
def test_the_other_direction_mirrors(ratio):
    films, signs = ends(0.3, ratio), np.ones(gas.LENGTH)
    signs[[gas.MOMENT, gas.MASS_FLOW]] = -1.0
    out, back = solved(block(), films)[1], solved(block(), films[::-1], (P_3, P_0))[1]
    assert back * signs == pytest.approx(out, rel=1e-13)
    # Radial width narrows that way: no mirror, but the march knows it.
    for width in WIDTHS[1:]:
        assert against_march(films, (P_0, P_3), width=width, radii=(R_O, R_I)) < 1e-5


def test_no_taper_is_a_limit():
    for width in WIDTHS:
        f = block("blend", width)
        flat = solved(f, ends(0.3, 0.0))[1]
        for ratio in (1e-6, 1e-9, 1e-12, 1e-15, -1e-15, -1e-9):
            # The force hangs on the film: to first order, with a factor near 1.
            assert solved(f, ends(0.3, ratio))[1] == pytest.approx(flat, rel=10 * abs(ratio) + 1e-11)


@pytest.mark.parametrize("friction", ["laminar", "turbulent"])
@pytest.mark.parametrize("ratio", [0.0, 0.3, -0.3, 0.8, -0.8])
def test_viscous_limit(friction, ratio):
    """A wide dam with a small drop: the p^2 profile, to the square of the exit Mach number."""
    width, pressures, h = 1.0, (1.2 * P_3, P_3), 5e-6
    films = h * (1 - ratio), h * (1 + ratio)
    viscosity = 3.4e-5
    f = block(friction, "constant", (100.0, 100.0 + width), viscosity=viscosity, sutherland=(0.0, 0.0))
    code, found = solved(f, films, pressures)
    assert code == gas.SOLVED and found[gas.EXIT_MACH] < 5e-3
    # 2 f R T G^2 int dx/h^3 is the drop of p^2.
    passing = found[gas.MASS_FLOW]
    resistance = width * quad(lambda x: (films[0] + (films[1] - films[0]) * x) ** -3, 0, 1)[0]
    loss = 2 * FRICTION[friction](2 * passing / viscosity) * passing**2 * resistance
    drop = loss * SEAL.gas_constant * SEAL.temperature
    assert drop == pytest.approx(pressures[0] ** 2 - pressures[1] ** 2, rel=1e-4)
    load = viscous_dam_load(films, width, pressures)
    assert found[gas.FORCE] == pytest.approx(load[0], rel=1e-4)
    assert 0.5 + found[gas.MOMENT] / width == pytest.approx(load[1], rel=1e-4)


@pytest.mark.parametrize("ratio", [-0.5, 0.0, 0.3])
def test_choking_is_smooth_once(ratio):
    """Force and mass flow are C1 in film and pressure where the exit becomes sonic; the second derivative jumps."""
    f = block()

    def choked(h):
        return solved(f, ends(h, ratio))[1][gas.EXIT_MACH] == 1.0

    low, high = 0.05, 0.6
    while high - low > 1e-13:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if choked(middle) else (middle, high)
    at = solved(f, ends(low, ratio))[1]
    for slot in (gas.FORCE, gas.MASS_FLOW, gas.MOMENT):

        def value(h, slot=slot):
            found = solved(f, ends(h, ratio))[1]
            return found[slot] * (found[gas.FORCE] if slot == gas.MOMENT else 1.0)

        size = abs(value(low))
        slopes = []
        for step in (4e-4, 2e-4):
            left = (3 * value(low) - 4 * value(low - step) + value(low - 2 * step)) / (2 * step)
            right = (-3 * value(high) + 4 * value(high + step) - value(high + 2 * step)) / (2 * step)
            slopes.append((left, right))
        scale = size / low
        assert abs(value(high) - value(low)) < 1e-10 * size
        for left, right in slopes:
            assert abs(left - right) < 1e-4 * scale
    assert at[gas.EXIT_MACH] > 1 - 1e-5


def test_mass_flow_of_choked_exit_does_not_know_the_low_pressure():
    f = block("blend")
    f[gas.HEAT_RATIO] = 5 / 3
    a, b = (solved(f, ends(0.8, -0.3), (P_0, p))[1] for p in (P_3, P_3 / 3))
    assert a[gas.EXIT_MACH] == b[gas.EXIT_MACH] == 1.0
    assert a[gas.MASS_FLOW] == pytest.approx(b[gas.MASS_FLOW], rel=1e-12)
    assert b[gas.FORCE] - a[gas.FORCE] == pytest.approx(2 / 3 * P_3 * WIDTH, rel=1e-6)


@pytest.mark.parametrize("friction", FRICTION)
def test_many_dams_at_cruise(friction):
    """Whatever the film, there is a flow, or the gas chokes at the entrance of a divergent dam."""
    rng = np.random.default_rng(7)
    f, out = block(friction), np.zeros(gas.DAM_SIZE)
    count = 20_000
    means, ratios = np.exp(rng.uniform(np.log(0.06), 0, count)), rng.uniform(-0.9, 0.9, count)
    choked = 0
    for mean, ratio in zip(means, ratios, strict=True):
        films = ends(mean, ratio)
        code = gas.dam(f, *films, P_0, P_3, out)
        if code == gas.ENTRANCE_CHOKED:
            choked += 1
            assert ratio > 0.3 and mean > 0.5
            assert not np.any(out[: gas.LENGTH])
            continue
        assert code == gas.SOLVED
        assert 0 < out[gas.FORCE] < (P_0 - P_3) * WIDTH
        assert abs(out[gas.MOMENT]) < 0.5 * WIDTH * out[gas.FORCE]
        assert 0 < out[gas.ENTRANCE_MACH] < 1
        assert out[gas.EXIT_MACH] <= 1
    assert 0 < choked < 0.05 * count


def test_flows_end_where_friction_no_longer_holds_the_opening():
    """The exit is sonic as long as A'/A < g f/h with a sonic entrance; on the way there M1^2 goes with that ratio."""
    f, out = block(), np.zeros(gas.DAM_SIZE)

    def shape(mean):
        films = ends(mean, 0.5)
        code = gas.dam(f, *films, P_0, P_3, out)
        taper = (films[1] - films[0]) / WIDTH
        return code, taper * out[gas.REYNOLDS] / (24 * SEAL.heat_ratio)

    low, high = 0.5, 1.2
    assert shape(high)[0] == gas.ENTRANCE_CHOKED
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        code, ratio = shape(middle)
        low, high = (middle, high) if code == gas.SOLVED else (low, middle)
    code, ratio = shape(low)
    assert code == gas.SOLVED
    assert ratio == pytest.approx(1, abs=1e-3)
    assert out[gas.ENTRANCE_MACH] == pytest.approx(1, abs=1e-3)


def test_entrance_with_loss_lets_less_through():
    short = (R_I, R_I + 0.02 * WIDTH)
    films = ends(1.0, 0.0)
    assert solved(block("blend", radii=short), films)[0] == gas.SOLVED
    assert solved(block("blend", radii=short, entrance_loss=0.5), films)[0] == gas.ENTRANCE_CHOKED
    a, b = (solved(block("blend", entrance_loss=loss), ends(0.8, 0.0))[1] for loss in (1.0, 0.6))
    assert b[gas.MASS_FLOW] < 0.99 * a[gas.MASS_FLOW]


def test_bad_films_and_pressures():
    f, out = block(), np.zeros(gas.DAM_SIZE)
    nan = float("nan")
    for films, pressures in (
        ((0.0, 1e-6), (P_0, P_3)),
        ((1e-6, -1e-6), (P_0, P_3)),
        ((1e-6, nan), (P_0, P_3)),
        ((1e-6, 1e-6), (P_0, 0.0)),
        ((1e-6, 1e-6), (nan, P_3)),
    ):
        out[:] = 1.0
        assert gas.dam(f, *films, *pressures, out) == gas.NO_FILM
        assert not np.any(out[: gas.LENGTH])
    assert set(gas.STATUS) == {gas.ENTRANCE_CHOKED, gas.NOT_FOUND, gas.NO_FILM}


def test_equal_pressures_are_no_flow():
    code, found = solved(block(), ends(0.3, 0.2), (P_3, P_3))
    assert code == gas.SOLVED and not np.any(found)
    # A small drop: half of it.
    code, found = solved(block(), ends(0.3, 0.0), (P_3 * (1 + 1e-7), P_3))
    assert found[gas.FORCE] == pytest.approx(0.5e-7 * P_3 * WIDTH, rel=1e-5)


def test_blend_is_the_larger_law_far_from_where_they_cross():
    for re in (1.0, 200.0, 2045.0, 2e4, 1e8):
        blended = gas.blended_friction(24.0, 0.079, re)
        assert blended == pytest.approx(FRICTION["blend"](re), rel=1e-13)
        assert gas.blended_friction(24.0, 0.0, re) == pytest.approx(24 / re, rel=1e-15)
        assert gas.blended_friction(0.0, 0.079, re) == pytest.approx(0.079 / re**0.25, rel=1e-14)
