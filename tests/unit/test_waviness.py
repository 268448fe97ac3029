"""Wavy faces: film thickness, its rate and its smallest value in angle and time, against sums and roots of its own."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scenes import CLEARANCE, NOTHING, R_I, R_O, SPEED, film, fmr, fms, prepared, ring, run, started

import sealdyn
from sealdyn.dynamics.extrema import H_TAU, H_THETA, MOST_SCAN, PER_RADIAN, H
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.native import thinnest_value
from sealdyn.dynamics.tally import DEEPEST, DEPTH_H, DEPTH_THETA, LIFTED, ROW, STATE, TOUCHED, locate_contacts
from sealdyn.faces import geometry as G
from sealdyn.faces.film_thickness import film_thickness, h_min, lay_waves, wave_parts_along, waves_rate
from sealdyn.films import all_film_names, film_named, linear
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.report.charts import film as film_chart
from sealdyn.report.charts.record import Run
from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.scene.film import Profile
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor, Stator
from sealdyn.scene.scene import SceneError
from sealdyn.scene.tabulated import Tabulated
from sealdyn.solvers.contract import Block, Counts
from sealdyn.solvers.methods import METHODS
from sealdyn.studies._declared import json_schema
from sealdyn.studies._runner import run_study

UM = 1e-6
SHAPE = (0.032, 0.034, 0.037, 0.040), (0.0, 3e-6, -2e-6, 1e-6)
EMPTY_FILM = film("linear", coefficients=NOTHING)
TURN = 2 * math.pi / SPEED


def height(waves, theta, angle):
    """A face along the shaft (m), its ring turned through `angle`."""
    return sum(w.amplitude * np.cos(w.order * (theta - angle) + w.phase) for w in waves) + 0.0 * theta


def thickness(r, theta, stator, rotor, at, coning=3.125e-3, shape=None, mean=False):
    """Stator's surface less the rotor's; `at` = (dz, g_x, g_y, stator angle, rotor angle)."""
    dz, g_x, g_y, angle_s, angle_r = at
    arm = 0.5 * (R_I + R_O) if mean else r
    depth = np.interp(r, *shape) if shape else 0.0
    aligned = CLEARANCE + dz + coning * (r - R_I) + depth + arm * (g_x * np.sin(theta) - g_y * np.cos(theta))
    return aligned + height(stator, theta, angle_s) - height(rotor, theta, angle_r)


def least_around(r, stator, rotor, at, **faces):
    """Smallest thickness at a radius: at one of the roots of dh/dtheta, a polynomial in exp(i theta)."""
    order = max([1, *(w.order for w in [*stator, *rotor])])
    count = 4 * order + 4
    series = np.fft.fft(thickness(r, 2 * np.pi * np.arange(count) / count, stator, rotor, at, **faces)) / count
    n = np.arange(-order, order + 1)
    theta = np.angle(np.roots((1j * n * series[n])[::-1]))
    for _ in range(3):
        turned = series[n] * np.exp(1j * n * theta[:, None])
        slope, bend = (turned @ (1j * n)).real, (turned @ (-(n**2) + 0j)).real
        theta = theta - np.where(np.abs(bend) > 0, np.clip(slope / bend, -1e-3, 1e-3), 0.0)
    return thickness(r, theta, stator, rotor, at, **faces).min()


def block(stator, rotor, shape=None, **changes):
    profile = Profile(*shape) if shape else None
    f = G.face_parameters(film("profiled" if shape else "radial", profile=profile, **changes), CLEARANCE)
    lay_waves(f, stator, rotor)
    return f


def gap(dz=0.0, g_x=0.0, g_y=0.0, angle_s=0.0, angle_r=0.0):
    s = np.zeros(G.GAP_STATE_SIZE)
    s[: G.GY + 1], s[G.STATOR_ANGLE], s[G.ROTOR_ANGLE] = (dz, g_x, g_y), angle_s, angle_r
    return s


def drawn(seed, count, highest=12):
    """(stator, rotor, state): random waves of both faces, tilts up to touch and beyond, none every fourth time."""
    draw = np.random.default_rng(seed)

    def some(n):
        return [
            Waviness(int(draw.integers(2, highest + 1)), draw.uniform(0, 0.3) * CLEARANCE, draw.uniform(-7, 7))
            for _ in range(n)
        ]

    for k in range(count):
        tilt = draw.uniform(0, 1.2) * CLEARANCE / R_O * (k % 4 > 0) * np.exp(1j * draw.uniform(-np.pi, np.pi))
        at = draw.normal() * 0.2 * CLEARANCE, tilt.real, tilt.imag, *draw.uniform(-40, 1e4, 2)
        yield some(draw.integers(0, 3)), some(draw.integers(1, 4)), at


# --- at one instant -------------------------------------------------------------------------------------


@pytest.mark.core
@pytest.mark.parametrize("shape", [None, SHAPE], ids=["cone", "profile"])
@pytest.mark.parametrize("mean", [False, True], ids=["local", "mean"])
def test_thickness_is_stator_surface_less_rotor_surface(shape, mean):
    for stator, rotor, at in drawn(1, 20):
        f = block(stator, rotor, shape, tilt_radius="mean" if mean else "local")
        for r, theta in ((R_I, 0.3), (0.0345, -2.0), (R_O, 5.0)):
            expected = thickness(r, theta, stator, rotor, at, shape=shape, mean=mean)
            # An angle of 1e4 rad is known to 1e-12, and twelve times as badly for the twelfth order.
            assert film_thickness(f, gap(*at), r, theta) == pytest.approx(expected, abs=1e-10 * CLEARANCE)


@pytest.mark.parametrize("shape", [None, SHAPE], ids=["cone", "profile"])
@pytest.mark.parametrize("mean", [False, True], ids=["local", "mean"])
@pytest.mark.parametrize("coning", [3.125e-3, 0.0, -2e-4])
def test_smallest_thickness_is_at_a_root_of_its_slope(shape, mean, coning):
    for stator, rotor, at in drawn(2, 60):
        at = (*at[:3], *np.mod(at[3:], 2 * np.pi))
        f = block(stator, rotor, shape, tilt_radius="mean" if mean else "local", coning=coning)
        low, theta, radius = h_min(f, gap(*at))
        faces = dict(coning=coning, shape=shape, mean=mean)
        expected = min(least_around(r, stator, rotor, at, **faces) for r in (shape[0] if shape else (R_I, R_O)))
        assert low == pytest.approx(expected, abs=1e-12 * CLEARANCE)
        assert thickness(radius, theta, stator, rotor, at, **faces) == pytest.approx(low, abs=1e-12 * CLEARANCE)
        assert -np.pi <= theta <= np.pi


def test_the_highest_wave_has_its_crests_where_its_phase_says():
    wave, turned = Waviness(100, 2 * UM, 0.7), 1.9
    for stator, rotor, angles, extreme in (([wave], [], (turned, 0.0), np.pi), ([], [wave], (0.0, turned), 0.0)):
        f = block(stator, rotor)
        low, theta, radius = h_min(f, gap(0.0, 0.0, 0.0, *angles))
        assert low == pytest.approx(CLEARANCE - 2 * UM, rel=1e-13) and radius == R_I
        # The stator's troughs, the rotor's crests: order (theta - angle) + phase = pi, 0.
        off = np.exp(1j * (100 * (theta - turned) + 0.7 - extreme))
        assert abs(off - 1.0) < 1e-6


def test_flat_waves_are_no_waves():
    f = block([Waviness(3, 0.0)], [Waviness(2, 0.0)])
    assert np.array_equal(f, block([], []))


def test_nothing_to_find_is_said_at_once():
    assert math.isnan(h_min(block([Waviness(2, UM)], []), gap(np.nan))[0])
    assert math.isnan(h_min(block([Waviness(2, UM)], []), gap(0.0, np.inf))[0])


def test_rate_against_differences():
    draw = np.random.default_rng(4)
    for stator, rotor, at in drawn(3, 20):
        f, rates, spins = block(stator, rotor), draw.normal(size=3) * (1e-3, 1e-2, 1e-2), draw.normal(size=2) * 1e3
        at, rates = np.array([*at[:3], *np.mod(at[3:], 7.0)]), np.array([*rates, *spins])
        s = gap(*at)
        s[G.MEAN_SPIN], s[G.SPIN_DIFFERENCE] = 0.5 * (spins[0] + spins[1]), spins[1] - spins[0]
        step = 1e-8
        for r, theta in ((R_I, 0.4), (R_O, 4.0)):
            ahead, behind = (film_thickness(f, gap(*(at + side * step * rates)), r, theta) for side in (1, -1))
            scale = 12 * CLEARANCE * 3e3
            rate = (ahead - behind) / (2 * step)
            tilting = rates[1] * math.sin(theta) - rates[2] * math.cos(theta)
            assert rates[0] + r * tilting + waves_rate(f, s, theta) == pytest.approx(rate, abs=1e-7 * scale)


def test_parts_of_the_waves_add_up_to_them():
    for stator, rotor, at in drawn(5, 10):
        f, s = block(stator, rotor), gap(*at)
        parts, theta = wave_parts_along(f, s[None])[0], 0.8
        orders = sorted({w.order for w in [*stator, *rotor]})
        total = sum(c * np.cos(n * theta) + d * np.sin(n * theta) for n, (c, d) in zip(orders, parts, strict=True))
        expected = height(stator, theta, at[3]) - height(rotor, theta, at[4])
        assert total == pytest.approx(expected, abs=1e-10 * CLEARANCE)


@pytest.mark.parametrize("waves", [([Waviness(5, 2 * UM)], [Waviness(3, 1 * UM, 0.4)]), ([], [])])
@pytest.mark.parametrize("coning", [3.125e-3, -5e-4])
def test_leakage_and_friction_of_a_narrow_film(waves, coning):
    (stator, rotor), at = waves, (0.0, 3e-5, 1e-5, 0.2, 1.0)
    f = linear.parameters(replace(EMPTY_FILM, coning=coning), CLEARANCE)
    lay_waves(f, stator, rotor)
    s = gap(*at)
    s[G.VISCOSITY], s[G.OUTER_PRESSURE], s[G.SPIN_DIFFERENCE] = 5e-4, 5e5, SPEED
    linear.flow(f, s)
    theta, w, r_m = 2 * np.pi * np.arange(4096) / 4096, R_O - R_I, 0.5 * (R_I + R_O)
    h_i, h_o = (thickness(r, theta, stator, rotor, at, coning) for r in (R_I, R_O))
    flow = -2 * np.pi * r_m * 5e5 / (12 * 5e-4) * np.mean(2 * (h_i * h_o) ** 2 / (w * (h_i + h_o)))
    drag = 5e-4 * SPEED * r_m**3 * 2 * np.pi * np.mean(w * np.log(h_o / h_i) / (h_o - h_i))
    assert s[G.FLOW_INNER] == pytest.approx(flow, rel=1e-12) and s[G.TORQUE] == pytest.approx(drag, rel=1e-12)


# --- in time --------------------------------------------------------------------------------------------

RUNOUT, WHIRL, RATIO = 60e-6, 25e-6, 0.42
RAMPS = PiecewiseLinear((0.0, 5.0, 30.0), (1000.0, 400.0, 1200.0))
PASSING = {
    "rotor past a tilt": ([], [Waviness(3, 2 * UM, 0.3)]),
    "stator under a turning tilt": ([Waviness(4, 2 * UM, 1.0)], []),
    "5 past 7": ([Waviness(5, 2 * UM)], [Waviness(7, 1.5 * UM, 0.4)]),
    "12 and 3 past 2": ([Waviness(2, 1 * UM, 0.5)], [Waviness(12, 1.5 * UM), Waviness(3, 1 * UM, 2.0)]),
}


def passing(stator, rotor, speed=0.0):
    """A resting stator that nothing pushes, over a rigid rotor that runs out and whirls: the gap is known in closed
    form, and of its dips one is the deepest."""
    return fms(
        film=EMPTY_FILM,
        shaft=Shaft(speed=SPEED, whirl=[Whirl(ratio=RATIO, angle=WHIRL, phase=1.0)]),
        stator=Stator(**ring(), waviness=stator, speed=speed),
        rotor=Rotor(runout=RUNOUT, waviness=rotor),
    )


def passing_gap(t, speed=0.0):
    """State of that gap at times t."""
    tilt = RUNOUT * np.exp(1j * SPEED * t) + WHIRL * np.exp(1j * (RATIO * SPEED * t + 1.0))
    return 0.0, -tilt.real, -tilt.imag, speed * t, SPEED * t


def lowest_at(stator, rotor, times, speed=0.0):
    """Smallest thickness (m) at each time, and its angle."""
    theta = np.linspace(0, 2 * np.pi, 2881)
    found = []
    for t in times:
        h = thickness(R_I, theta, stator, rotor, passing_gap(t, speed))
        found.append((h.min(), theta[h.argmin()]))
    return np.array(found).T


def zoomed(stator, rotor, begin, end, speed=0.0):
    """Smallest thickness over angle and time, its time and angle: a grid, refined around its lowest point."""
    t, theta = np.linspace(begin, end, 3001), np.linspace(0, 2 * np.pi, 721)
    for _ in range(6):
        at = passing_gap(t[:, None], speed)
        h = thickness(R_I, theta[None], stator, rotor, at)
        i, j = np.unravel_index(h.argmin(), h.shape)
        lowest, when, where = h[i, j], t[i], theta[j]
        reach_t, reach = 2 * (t[1] - t[0]), 2 * (theta[1] - theta[0])
        t = np.linspace(max(when - reach_t, begin), min(when + reach_t, end), 161)
        theta = np.linspace(where - reach, where + reach, 161)
    return lowest, when, where


@pytest.mark.parametrize("method", ["adams", "dop853", "expm"])
@pytest.mark.parametrize("waves", PASSING.values(), ids=PASSING)
def test_waves_that_pass_between_steps(waves, method):
    """The stator rests, so a step may be as long as it likes: the dips are those of the waves alone."""
    speed = -0.37 * SPEED if waves[0] else 0.0
    found = run(passing(*waves, speed), duration=1.3 * TURN, accuracy=1e-8, method=method, per_turn=1)
    lowest, when, where = zoomed(*waves, 0.0, 1.3 * TURN, speed)
    record = found.record(0)
    assert record[H] == pytest.approx(lowest, abs=1e-7 * CLEARANCE)
    here = thickness(R_I, record[H_THETA], *waves, passing_gap(record[H_TAU], speed))
    assert here == pytest.approx(record[H], abs=1e-7 * CLEARANCE)
    assert abs(record[H_TAU] - when) < 1e-3 * TURN and abs(np.exp(1j * (record[H_THETA] - where)) - 1) < 1e-2


@pytest.mark.parametrize("phase", [0.4, 3.0, 5.0])
def test_waves_that_pass_within_a_step(phase):
    """Two steps over one and a third turns: nothing but the scan shows the dips.  At the pace of the tilt alone it
    misses the deepest by 0.7 % of the clearance at two of these phases."""
    waves, speed = ([Waviness(5, 2 * UM)], [Waviness(7, 1.5 * UM, phase)]), -0.37 * SPEED
    ready = prepared(passing(*waves, speed), 1.3 * TURN, 1e-8)
    t, segment = np.linspace(0.0, 1.3 * TURN, 3), ready.segment(0)
    rest = np.zeros((3, segment.size))
    ready.extrema.begin(segment, 0.0, rest[0])
    assert ready.extrema.accept(Block(segment, t, rest, rest, 0, 2)) is None
    above = ready.extrema.records[0, H] - zoomed(*waves, 0.0, 1.3 * TURN, speed)[0]
    # The grid of the other may not have its very bottom.
    assert -1e-8 * CLEARANCE < above < 1e-11 * CLEARANCE


def test_no_step_is_longer_than_its_scan_can_see():
    ready = prepared(passing([], [Waviness(100, UM)]), 60 * TURN, 1e-6)
    fine = ready.segment(0)
    longest = fine.longest_step()
    assert int(PER_RADIAN * fine.pace * longest) <= MOST_SCAN and longest < 3 * TURN
    steps = METHODS["expm"](fine, 0.0, ready.y0, "expm", 1e-6, Counts())
    times = np.concatenate([[0.0], *(times for times, _, _ in steps)])
    assert times[-1] == pytest.approx(60 * TURN) and np.max(np.diff(times)) <= longest * (1 + 1e-9)
    # Without waves a third of a turn: what is imposed turns with the shaft.
    assert prepared(passing([], []), 60 * TURN, 1e-6).segment(0).longest_step() == pytest.approx(2.0 / SPEED)


@pytest.mark.parametrize("speed", [SPEED, RAMPS], ids=["even", "ramps"])
def test_rings_have_turned_by_the_integral_of_their_speed(speed):
    """After thousands of turns, and two stretches of time or more, to the rounding of one stretch."""
    scene = replace(passing(*PASSING["5 past 7"], -123.4), shaft=Shaft(speed=speed))
    ready = prepared(scene, 25.0, 1e-6)
    assert len(ready.intervals) > 1
    for k, leg in enumerate(ready.intervals):
        s = ready.segment(k).gap_state(0.6 * leg.length, ready.y0)
        t = leg.time + 0.6 * leg.length
        turned = SPEED * t
        if speed is not SPEED:
            turned = 1000.0 * t - 60.0 * t * t if t < 5.0 else 3500.0 + 400.0 * (t - 5.0) + 16.0 * (t - 5.0) ** 2
        for slot, angle in ((G.ROTOR_ANGLE, turned), (G.STATOR_ANGLE, -123.4 * t)):
            assert abs(np.exp(1j * (s[slot] - angle)) - 1.0) < 1e-10


def test_signals_show_the_waves():
    stator, rotor = PASSING["5 past 7"]
    found = run(passing(stator, rotor, 200.0), duration=TURN, accuracy=1e-6, per_turn=50)
    lowest, _ = lowest_at(stator, rotor, found.times, 200.0)
    # Half a step of the grid from the minimum.
    assert np.max(np.abs(found["h_min"] - lowest)) < 150 * UM * (np.pi / 2880) ** 2
    assert np.all(found["h_min"] <= lowest + 1e-18)


def test_ends_where_crests_meet():
    """Crests of 4.5 and 4 um and a tilt in a gap of 10 um: the run ends at the first time that the floor is reached."""
    waves = [Waviness(5, 4.5 * UM)], [Waviness(7, 4 * UM, 4.0)]
    found = run(passing(*waves), duration=TURN, accuracy=1e-6, per_turn=1)
    times = np.linspace(0, TURN, 40_001)
    low, _ = lowest_at(*waves, times[: 2 * np.searchsorted(times, found.outcome.tau) + 2])
    first = np.argmax(low < EMPTY_FILM.floor * CLEARANCE)
    assert found.outcome.status == "collapsed" and low.min() < EMPTY_FILM.floor * CLEARANCE
    assert abs(found.outcome.tau - times[first]) < 2 * times[1]
    assert found.record(0)[H] == pytest.approx(EMPTY_FILM.floor * CLEARANCE, abs=1e-9 * CLEARANCE)


def test_touches_of_waves_between_steps():
    """Every time the smallest gap passes a level, over steps of a third of a turn."""
    waves, level = PASSING["5 past 7"], 4.8 * UM
    segment = prepared(passing(*waves), TURN, 1e-8).segment(0)
    t, count = np.linspace(0, TURN, 4), 4
    q, f = np.zeros((count, segment.n)), segment.model.f.copy()
    f[G.TOUCH] = level
    scratch = np.zeros(segment.size), np.zeros(segment.size), segment.w, segment.s
    scratch = segment.p, thinnest_value(f), f, *scratch
    rows, state = np.zeros((500, ROW)), np.zeros(STATE)
    steps = t, q, q, np.zeros(count), count, 0, count - 1, np.tile([-np.inf, np.inf], (count, 1))
    found = locate_contacts(*steps, *scratch, 0.0, segment.pace, 1e-8 * CLEARANCE, state, rows)
    rows, times = rows[:found], np.linspace(0, TURN, 8001)
    low, _ = lowest_at(*waves, times)
    below = low < level
    down, up = np.flatnonzero(~below[:-1] & below[1:]), np.flatnonzero(below[:-1] & ~below[1:])
    # The first may have begun before the start, the last may go on.
    touched = np.concatenate([[0.0] * int(below[0]), times[down]])[: len(up)]
    assert len(up) > 5 and len(rows) == len(up)
    assert np.max(np.abs(rows[:, LIFTED] - times[up])) < 2 * times[1]
    assert np.max(np.abs(rows[:, TOUCHED] - touched)) < 2 * times[1]
    for row in rows:
        here = thickness(R_I, row[DEPTH_THETA], *waves, passing_gap(row[DEEPEST]))
        assert here == pytest.approx(row[DEPTH_H], abs=1e-9 * CLEARANCE)
        during = (times >= row[TOUCHED]) & (times <= row[LIFTED])
        assert row[DEPTH_H] <= low[during].min() + 1e-7 * CLEARANCE


# --- what a scenario may say ----------------------------------------------------------------------------

TEXT = (SCENARIOS / "fmr_reference.toml").read_text()
OWN = "film.coefficients={tilt_stiffness=1e3, tilt_damping=0.5, axial_stiffness=2e6, axial_damping=800.0}"
WAVE = "\n[[rotor.waviness]]\norder = 3\namplitude = '2 um'\n[[stator.waviness]]\norder = 2\namplitude = '1 um'\n"


def scenario(*overrides, waves=WAVE):
    return parse_scenario(TEXT + waves, "wavy.toml", ["film.model=linear", OWN, "run.turns=3", *overrides])


def test_a_scenario_reads_its_waves():
    read = scenario("rotor.waviness.0.phase='30 deg'").scene
    assert read.rotor.waviness == [Waviness(3, pytest.approx(2e-6), pytest.approx(math.pi / 6))]
    assert read.stator.waviness == [Waviness(2, pytest.approx(1e-6), 0.0)] and type(read.rotor.waviness[0].order) is int
    properties = json_schema()["$defs"]["Waviness"]["properties"]
    assert set(properties) == {"order", "amplitude", "phase"}


@pytest.mark.parametrize(
    ("overrides", "key"),
    [
        (["rotor.waviness.0.order=1"], "rotor.waviness.0.order"),
        (["rotor.waviness.0.order=0"], "rotor.waviness.0.order"),
        (["rotor.waviness.0.order=-3"], "rotor.waviness.0.order"),
        (["rotor.waviness.0.order=2.5"], "rotor.waviness.0.order"),
        (["rotor.waviness.0.order=101"], "rotor.waviness.0.order"),
        (["stator.waviness.0.amplitude='-1 um'"], "stator.waviness.0.amplitude"),
        (["stator.waviness.0.amplitude='1 deg'"], "stator.waviness.0.amplitude"),
        (["stator.waviness.0.phase='1 um'"], "stator.waviness.0.phase"),
        (["film.model=radial"], "film.model"),
        (["film.model=profiled"], "film.model"),
        (["film.model=auto"], "film.model"),
        (["film.coefficients=green"], "film.model"),
        (["film.coefficients=radial"], "film.model"),
        # More than there is room for.
        (["rotor.waviness=[" + 17 * "{order = 3, amplitude = 1e-8}, " + "]"], "rotor.waviness"),
        (["contact={roughness='0.1 um', compressive_strength='300 MPa'}"], "contact"),
    ],
)
def test_what_cannot_be_wavy(overrides, key):
    with pytest.raises(ScenarioError) as error:
        scenario(*overrides)
    assert error.value.key == key and "\n" not in str(error.value)


def test_a_model_refuses_what_the_reader_refuses():
    wavy = passing(*PASSING["5 past 7"])
    rough = replace(wavy, contact=Contact(roughness=1e-7, compressive_strength=3e8))
    for scene, key in (
        (rough, "contact"),
        (replace(wavy, film=film("radial")), "film.model"),
        (replace(wavy, stator=replace(wavy.stator, waviness=[Waviness(1, UM)])), "stator.waviness.0.order"),
        (replace(wavy, stator=replace(wavy.stator, waviness=[Waviness(2, math.nan)])), "stator.waviness.0.amplitude"),
    ):
        with pytest.raises(SceneError) as error:
            Model(scene)
        assert error.value.key == key


def test_waves_that_close_the_film_at_the_start():
    deep = [Waviness(2, 0.6 * CLEARANCE), Waviness(4, 0.6 * CLEARANCE)]
    with pytest.raises(SceneError) as error:
        started(fmr(film=EMPTY_FILM, rotor=Rotor(**ring(), waviness=deep)), 0.01).check_start()
    assert error.value.key == "film.clearance"


def test_films_say_what_faces_they_take():
    # A film of numbers wants them.
    numbers = Tabulated()
    cone, worn = film(tabulated=numbers), film(tabulated=numbers, profile=Profile(*SHAPE))
    waves = [Waviness(2, UM)]
    for name in all_film_names():
        accepts = film_named(name).accepts
        # Of a face that stands still.
        assert accepts(cone) == "" and bool(accepts(cone, waves)) == (name not in ("gas_reynolds", "reynolds"))
        assert bool(accepts(worn)) == (name not in ("profiled", "gas_reynolds", "reynolds"))
    assert linear.accepts(EMPTY_FILM, waves) == ""


def test_a_study_of_round_faces_refuses_waves(tmp_path):
    with pytest.raises(SceneError) as error:
        run_study("contact-onset", scenario(), tmp_path / "onset.h5")
    assert error.value.key == "rotor.waviness"


# --- what is kept and drawn -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    turning = scenario("stator.speed='-300 rad/s'", "run.samples_per_turn=40")
    result = sealdyn.simulate(turning, tmp_path_factory.mktemp("wavy") / "wavy.h5")
    assert result.status == "ok" and result.summary["contact_margin"] is None
    return result.archive


def test_chart_draws_the_waves(archive, tmp_path):
    seen = Run(archive)
    stator, rotor = ([Waviness(n, a)] for n, a in ((2, 1 * UM), (3, 2 * UM)))
    theta, time = film_chart.around(seen), seen.values("time")
    drawn = film_chart.thickness(seen, R_I, theta, 0, seen.rows)
    names = "axial_gap_change", "relative_tilt_x", "relative_tilt_y", "shaft_angle"
    columns = [seen.values(name)[:, None] for name in names]
    at = (*columns[:3], -300.0 * time[:, None], columns[3])
    clearance, coning = seen.clearance, seen.film("coning")
    expected = thickness(R_I, theta, stator, rotor, at, coning=coning) + clearance - CLEARANCE
    assert np.max(np.abs(drawn - expected)) < 1e-12 * CLEARANCE
    lowest = seen.values("h_min")
    assert np.all(lowest <= drawn.min(1) + 1e-17) and np.max(drawn.min(1) - lowest) < 1e-2 * UM
    assert seen.wave_orders == [2, 3] and seen.contact_tilt is None
    film_chart.draw(archive, tmp_path / "film.png")
    assert (tmp_path / "film.png").stat().st_size > 10_000


def test_clearance_is_found_among_waves(archive):
    given, found = Run(archive), Run(archive)
    found.resolved["film"]["clearance"] = None
    assert found.clearance == pytest.approx(given.resolved["film"].get("clearance") or CLEARANCE, rel=1e-9)
