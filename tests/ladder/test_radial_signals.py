"""What is kept and told of radial seals, beside formulas and sums of the tests' own: the shaft under the followers, the
equations of each, series and fields, what is watched, events, and the lines of a summary."""

import math
import re
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from sealdyn.archive import FIELD_TIME, column, field, read_info
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.radial_seals import observers
from sealdyn.radial_seals.equations import Contacts
from sealdyn.radial_seals.followers import (
    closed_form_sentences,
    fastest,
    followers_of,
    hangs_up,
    largest_eccentricity,
    needed_preload,
)
from sealdyn.radial_seals.model import RadialModel, RadialRun, RadialSegment
from sealdyn.radial_seals.observers import _warnings
from sealdyn.report.summary import run_answer
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.radial import Circumferential, Lip, Lobes, RadialScene, RadialShaft
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import Recorder, Transition
from sealdyn.solvers.integrate import solve

R = 0.025
TIMES, SPEEDS = (0.0, 0.02, 0.05), (-200.0, 400.0, 500.0)
# Order, amplitude, phase.
WAVES = ((1, 1e-4, 0.0), (2, 4e-5, 0.4), (3, 3e-5, -1.1))
OFFSET, DIRECTION = 5e-5, 0.7
FREE, HELD, RIDING = 0.0, 1.0, 2.0
FLOW = dict(friction_coefficient=0.3, contact_width=2e-3, viscosity=0.02, pressure_difference=1e4)


def turned(t):
    """Angle (rad) of the shaft at a time (s)."""
    total = 0.0
    for (t0, t1), (w0, w1) in zip(pairwise(TIMES), pairwise(SPEEDS), strict=True):
        dt = min(max(t - t0, 0.0), t1 - t0)
        total += w0 * dt + 0.5 * (w1 - w0) / (t1 - t0) * dt**2
    return total


def shape(theta, t):
    """How far (m) the shaft stands out."""
    out = OFFSET * np.cos(theta - DIRECTION)
    for order, amplitude, phase in WAVES:
        out = out + amplitude * np.cos(order * (theta - turned(t)) - phase)
    return out


def ramped(kind):
    """A lip with everything that damps and couples, or segments with everything that rubs, on a ramped shaft."""
    (_, e, _), *lobes = WAVES
    shaft = RadialShaft(R, PiecewiseLinear(TIMES, SPEEDS), e, OFFSET, DIRECTION, [Lobes(*wave) for wave in lobes])
    if kind == "lip":
        return RadialScene(shaft, lip=Lip(0.03, 12, 9.0, 5e4, garter_tension=3.0, garter_rate=200.0, loss_factor=0.4,
                                          **FLOW))  # fmt: skip
    return RadialScene(shaft, circumferential=Circumferential(0.06, 12, 2.0, 500.0, axial_force=1.2,
                                                              flange_friction=0.25, **FLOW))  # fmt: skip


def constants(kind):
    """Of a follower of `ramped`: mass, stiffness matrix, damping, preload, friction."""
    theta = 2 * np.pi * np.arange(12) / 12
    arc = 2 * math.pi * R / 12
    apart = theta[:, None] - theta
    if kind == "segments":
        share = 2 * math.sin(math.pi / 12)
        return 0.06 / 12, np.full((12, 12), 500.0 * share**2), 0.0, 2.0 * share, 0.25 * 1.2 / 12
    # Sums of waves around the ring, each with its own stiffness.
    waves = np.arange(12)
    orders = np.minimum(waves, 12 - waves)
    stiffness = [5e4 + (3.0 * (n * n - 1) / R**2 if n else 2 * math.pi * 200.0 / R) for n in orders]
    matrix = arc / 12 * sum(k * np.cos(n * apart) for n, k in zip(waves, stiffness, strict=True))
    return 0.03 / 12, matrix, 0.4 * 5e4 / 500.0 * arc, (9.0 + 3.0 / R) * arc, 0.0


def segment_at(kind, index, modes, signs=None):
    model = RadialModel(ramped(kind), 1e-6)
    intervals = model.intervals(TIMES[-1])
    signs = np.zeros(12) if signs is None else signs
    return RadialSegment(model, intervals[index], index, index + 1 == len(intervals), {"modes": modes, "signs": signs})


@pytest.mark.parametrize("index", [0, 1])
def test_the_shaft_under_the_followers_turns_with_its_table(index):
    """Surface, rate and acceleration, on both ramps, also where the shaft turns back."""
    segment = segment_at("lip", index, np.full(12, RIDING))
    theta, h = 2 * np.pi * np.arange(12) / 12, 1e-5
    for share in (0.0, 0.31, 0.77):
        tau = share * segment.length
        t = segment.time + tau + (h if share == 0.0 else 0.0)
        found = segment.surface(t - segment.time)
        before, here, after = shape(theta, t - h), shape(theta, t), shape(theta, t + h)
        np.testing.assert_allclose(found[:, 0], here, atol=1e-15)
        np.testing.assert_allclose(found[:, 1], (after - before) / (2 * h), atol=2e-5 * np.abs(found[:, 1]).max())
        np.testing.assert_allclose(
            found[:, 2], (after - 2 * here + before) / h**2, atol=3e-4 * np.abs(found[:, 2]).max()
        )


@pytest.mark.parametrize("kind", ["lip", "segments"])
def test_the_equations_of_each_follower(kind):
    """Free, held and riding ones beside each other: rates, works, loads, and energy."""
    rng = np.random.default_rng(7)
    modes = np.array([RIDING, FREE, HELD, RIDING, FREE, HELD] * 2)
    u, v = rng.normal(size=12) * 1e-4, rng.normal(size=12) * 0.03
    v[modes == HELD] = 0.0
    signs = np.where(modes == FREE, np.sign(v), 0.0)
    segment = segment_at(kind, 1, modes, signs)
    tau = 0.4 * segment.length
    s, rate, bend = segment.surface(tau).T
    m, matrix, d, preload, friction = constants(kind)
    np.testing.assert_allclose([segment.model.followers.mass, segment.model.followers.damping,
                                segment.model.followers.preload, segment.model.followers.friction],
                               [m, d, preload, friction], rtol=1e-12)  # fmt: skip
    pressed = matrix @ u + preload
    y, yp = np.concatenate([u, v, np.zeros(4)]), np.empty(28)
    segment.rhs(tau, y, yp)
    rides, free = modes == RIDING, modes == FREE
    w = np.where(rides, rate, np.where(free, v, 0.0))
    slides = np.where(rides, np.sign(rate), signs)
    np.testing.assert_allclose(yp[:12], w, rtol=1e-12)
    fall = -(pressed + d * v + friction * signs) / m
    np.testing.assert_allclose(yp[12:24], np.where(rides, bend, np.where(free, fall, 0.0)), rtol=1e-9)
    load = m * bend + d * rate + pressed + friction * np.sign(rate)
    works = [load[rides] * rate[rides], -d * w**2, -friction * slides * w]
    np.testing.assert_allclose(yp[24:], [*(part.sum() for part in works), sum(np.abs(part).sum() for part in works)],
                               rtol=1e-9)  # fmt: skip
    gaps, gap_rates, loads = (part[0] for part in segment.state(np.array([tau]), u[None], v[None]))
    np.testing.assert_allclose(loads, np.where(rides, load, -pressed), rtol=1e-9)
    np.testing.assert_allclose(gaps, np.where(rides, 0.0, u - s), atol=1e-18)
    np.testing.assert_allclose(gap_rates, np.where(rides, 0.0, v - rate), atol=1e-15)
    energy = 0.5 * m * v @ v + 0.5 * u @ matrix @ u + preload * u.sum()
    assert segment.energies(np.array([tau]), y[None])[0] == pytest.approx(energy, rel=1e-9)
    # A Newton's iteration is led by the derivatives of just these.
    jac, yp2 = np.empty((28, 28)), np.empty(28)
    segment.jacobian(tau, y, yp, jac)
    step = np.concatenate([rng.normal(size=12) * 1e-9, rng.normal(size=12) * 1e-6, np.zeros(4)])
    segment.rhs(tau, y + step, yp2)
    np.testing.assert_allclose(jac[:24] @ step, (yp2 - yp)[:24], atol=1e-4 * np.abs((yp2 - yp)[:24]).max())


@pytest.mark.parametrize("kind", ["lip", "segments"])
def test_series_are_sums_over_the_followers(kind):
    rng = np.random.default_rng(3)
    modes = np.array([RIDING, FREE, RIDING, RIDING, FREE, HELD] * 2)
    segment = segment_at(kind, 1, modes, np.where(modes == FREE, 1.0, 0.0))
    taus = np.array([0.2, 0.6]) * segment.length
    surfaces = np.array([segment.surface(tau) for tau in taus])
    us = surfaces[:, :, 0] + np.where(modes == RIDING, 0.0, rng.uniform(-2e-6, 9e-6, (2, 12)))
    # One so far inside that its springs pull it out: nothing presses on the shaft all the same.
    us[:, 1] = -5e-3
    vs = np.where(modes == RIDING, surfaces[:, :, 1], rng.normal(size=(2, 12)) * 0.01)
    found, around = observers.columns(segment, taus, us, vs)
    m, matrix, d, preload, friction = constants(kind)
    loads = (
        m * surfaces[:, :, 2] + d * surfaces[:, :, 1] + us @ matrix + preload + friction * np.sign(surfaces[:, :, 1])
    )
    loads = np.where(modes == RIDING, np.maximum(loads, 0.0), 0.0)
    gaps = np.where(modes == RIDING, 0.0, np.maximum(us - surfaces[:, :, 0], 0.0))
    np.testing.assert_allclose(around["follower_load"], loads, rtol=1e-9)
    np.testing.assert_allclose(around["gap"], gaps, atol=1e-18)
    arc = 2 * math.pi * R / 12
    expected = {
        "time": TIMES[1] + taus,
        "shaft_angle": [turned(TIMES[1] + tau) % (2 * math.pi) for tau in taus],
        "shaft_speed": SPEEDS[1] + (SPEEDS[2] - SPEEDS[1]) * taus / segment.length,
        "largest_gap": gaps.max(axis=1),
        "contact_share": [0.5, 0.5],
        "least_load": [min(row[modes == RIDING]) for row in loads],
        "load": loads.sum(axis=1),
        "friction_torque": 0.3 * R * loads.sum(axis=1),
        # A slot between two plates.
        "leakage_estimate": [sum(arc * gap**3 * 1e4 / (12 * 0.02 * 2e-3) for gap in row) for row in gaps],
    }
    assert set(found) == set(expected)
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-9, err_msg=name)


def test_a_run_begins_on_the_shaft():
    run = RadialRun(RadialModel(ramped("lip"), 1e-6), TIMES[-1])
    theta, h = 2 * np.pi * np.arange(12) / 12, 1e-6
    np.testing.assert_allclose(run.y0[:12], shape(theta, 0.0), atol=1e-18)
    np.testing.assert_allclose(run.y0[12:24], -SPEEDS[0] * (shape(theta + h, 0) - shape(theta - h, 0)
                               + OFFSET * 2 * h * np.sin(theta - DIRECTION)) / (2 * h), atol=1e-9)  # fmt: skip
    assert run.end_time(1, 0.003) == pytest.approx(TIMES[1] + 0.003)


def test_what_a_solver_is_told_of_its_pace():
    """Steps resolve waves of the shaft and vibrations of the sectors, whichever is faster; errors last while a free
    sector swings."""
    scene = ramped("lip")
    scene = replace(scene, lip=replace(scene.lip, mass=0.003))
    _, matrix, d, _, _ = constants("lip")
    m = 0.003 / 12
    natural = math.sqrt(np.linalg.eigvalsh(matrix)[-1] / m)
    model = RadialModel(scene, 1e-6)
    assert natural > 3 * 500.0 and model.reference_rate == pytest.approx(natural)
    slow = RadialModel(replace(scene, lip=replace(scene.lip, mass=30.0)), 1e-6)
    assert slow.reference_rate == pytest.approx(3 * 500.0)
    run = RadialRun(model, 1.0)
    assert 2 * m / d < 1.0
    assert run.memory == pytest.approx(2 * m / d / model.shortest_period)
    undamped = RadialRun(RadialModel(replace(scene, lip=replace(scene.lip, loss_factor=0.0)), 1e-6), 1.0)
    assert undamped.memory == pytest.approx(1.0 / model.shortest_period)


# --- what a run amounts to ----------------------------------------------------------------------------

WATCHED = """
# Six segments, held by their flange now and then.
[shaft]
radius = 0.025
speed = {speed}
eccentricity = 2e-4
[circumferential]
mass = 0.06
segments = 6
garter_tension = {tension}
axial_force = 0.6
flange_friction = 1.0
friction_coefficient = 0.2
contact_width = 0.003
viscosity = 0.02
pressure_difference = 5000.0
[run]
turns = 3
samples_per_turn = {samples}
"""


TURNING = "'300 rad/s'"
SPEEDING = "{time = [0.0, 0.03, 0.08], value = ['60 rad/s', '60 rad/s', '300 rad/s']}"


@pytest.fixture(scope="module", params=[(0.12, TURNING), (0.101, TURNING), (0.06, TURNING), (0.12, SPEEDING)],
                ids=["flies", "turns", "hangs up", "speeds up"])  # fmt: skip
def watched(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("radial") / "x.h5"
    tension, speed = request.param
    # As many as the archive keeps of what is around the shaft.
    samples = 110 if speed == SPEEDING else 190
    found = simulate(parse_scenario(WATCHED.format(tension=tension, speed=speed, samples=samples), "x"), path)
    assert found.status == "ok"
    return path, found.summary


def kept(path):
    """Times (s), gaps, loads, displacements (m, n), and who rides, is held."""
    times, gaps, loads = (field(path, name) for name in (FIELD_TIME, "gap", "follower_load"))
    theta = np.pi / 3 * np.arange(6)
    us = gaps + 2e-4 * np.cos(theta - column(path, "shaft_angle")[:, None])
    rides = loads > 0
    still = np.zeros_like(rides)
    still[1:] = np.abs(np.diff(us, axis=0)) < 1e-12
    still[:-1] |= still[1:]
    return times, gaps, loads, us, rides, still & ~rides


@pytest.mark.parametrize("part", ["whole", "settled"])
def test_what_is_watched_is_what_the_archive_adds_up_to(watched, part):
    path, summary = watched
    told = summary[part]
    times, gaps, loads, _, rides, held = kept(path)
    assert len(times) == len(column(path, "time"))
    late = times >= (0.0 if part == "whole" else 0.5 * times[-1])
    shares = rides[late].mean(axis=0)
    assert told["contact_share"] == pytest.approx(shares.mean(), abs=4e-3)
    assert told["least_contact_share"] == pytest.approx(shares.min(), abs=8e-3)
    assert told["held_share"] == pytest.approx(held[late].mean(), abs=4e-3)
    load = loads[late].sum(axis=1).mean()
    assert told["load"] == pytest.approx(load, rel=0.02)
    assert told["friction_torque"] == pytest.approx(0.2 * R * load, rel=0.02)
    assert told["leakage_estimate"] == pytest.approx(column(path, "leakage_estimate")[late].mean(), rel=0.02)
    at, j = np.unravel_index(np.where(late[:, None], gaps, 0.0).argmax(), gaps.shape)
    assert gaps[at, j] <= told["largest_gap"] <= 1.001 * gaps[at, j]
    first = told["largest_gap_time"]
    row = int(np.argmin(np.abs(times - first)))
    which = round(told["largest_gap_angle"] / (math.pi / 3))
    assert told["largest_gap_angle"] == pytest.approx(which * math.pi / 3, abs=1e-9)
    assert late[max(row, 1)] and gaps[row, which] == pytest.approx(told["largest_gap"], rel=2e-3)
    riding = loads[late][rides[late]]
    if not len(riding):
        assert told["least_load"] is told["largest_load"] is None
        return
    most = riding.max()
    assert most * 0.999 <= told["largest_load"] <= 1.02 * most
    assert 0.0 <= told["least_load"] <= riding.min() + 1e-3 * most
    row = int(np.argmin(np.abs(times - told["least_load_time"])))
    near = loads[max(row - 1, 0) : row + 2]
    assert near[near > 0].min() <= told["least_load"] + 0.02 * most


def test_events_are_those_of_the_motion(watched):
    """Their number, their energy, and which follower it is: it presses after a landing, and comes with the speed that
    the landing takes."""
    path, summary = watched
    events, contact = read_info(path)["events"], summary["contact"]
    times, gaps, loads, _, rides, held = kept(path)
    at_once = int((~rides[1] & (loads[0] == 0)).sum())
    for kind in ("land", "stick", "slip", "turn"):
        assert sum(event["kind"] == kind for event in events) == contact[kind]
    assert contact["lift"] - sum(event["kind"] == "lift" for event in events) in (0, at_once)
    lands = [event for event in events if event["kind"] == "land"]
    assert lands and contact["energy_lost"] == pytest.approx(sum(event["value"] for event in lands))
    lifts = [event["time"] for event in events if event["kind"] == "lift"]
    assert contact["first_lift"] == pytest.approx(0.0 if at_once else lifts[0], abs=1e-12)
    sizes = []
    for event in lands:
        j, row = int(re.findall(r"\d+", event["text"])[0]) - 1, int(np.searchsorted(times, event["time"]))
        if 3 < row < len(times):
            assert gaps[row, j] == 0.0 and gaps[row - 1, j] > 0.0
            closing = np.diff(gaps[row - 3 : row, j])[-1] / (times[1] - times[0])
            bend = np.diff(gaps[row - 3 : row, j], 2)[0] / (times[1] - times[0]) ** 2
            closing += bend * (event["time"] - 0.5 * (times[row - 1] + times[row - 2]))
            sizes.append((event["value"], 0.5 * 0.01 * closing**2))
    values, expected = np.array(sizes).T
    np.testing.assert_allclose(values, expected, atol=0.06 * values.max())
    assert contact["followers_riding_at_end"] == rides[-1].sum()
    assert contact["followers_held_at_end"] == held[-1].sum()
    (series,) = [column(path, "contact_share")]
    assert series[-1] == pytest.approx(rides[-1].mean())


def test_lines_of_a_summary_have_its_numbers(watched):
    """In the units that people read them in."""
    _, summary = watched

    def numbers(found):
        rows = run_answer({**found, "wall_time": 1.0, "archive": "x.h5"}).lines
        return [value for line in rows for _, value, *_ in line.parts if isinstance(value, float | int)]

    arc, settled, whole = 2 * math.pi * R / 6, summary["settled"], summary["whole"]
    told, preload = numbers(summary), summary["follower"]["preload"]
    needed = 0.01 * 2e-4 * 300.0**2 + 0.1
    largest = max(preload - 0.1, 0.0) / (0.01 * 300.0**2)
    wanted = [preload / arc, 0.0, 0.01 / arc, 0.1, needed / arc, 300.0, preload / needed, largest]
    wanted += [settled[name] for name in ("contact_share", "least_contact_share", "held_share", "leakage_estimate")]
    wanted += [whole["largest_gap"], whole["largest_gap_angle"]]
    assert all(any(value == pytest.approx(number, rel=1e-9) for number in told) for value in wanted)
    assert 7.5 / arc in numbers(summary | {"follower": summary["follower"] | {"stiffness": 7.5}})
    form = summary["closed_form"] | {"hangs_up": True, "margin": None, "largest_eccentricity": None}
    assert len(numbers(summary | {"closed_form": form})) < len(told)
    (warning, *_) = summary["warnings"]
    assert f"off the shaft {100 * (1 - settled['contact_share']):.3g} % of the time" in warning


def test_what_leaves_and_does_not_come_back_is_a_loss_too(tmp_path):
    """Warned of by what has left, not by what has landed; and of a shaft that is far off its place."""
    text = (
        WATCHED.format(tension=0.02, speed=TURNING, samples=72)
        .replace("axial_force = 0.6", "axial_force = 60.0")
        .replace("2e-4", "2.6e-3")
    )
    found = simulate(parse_scenario(text.replace("turns = 3", "turns = 2"), "x"), tmp_path / "x.h5").summary
    none = found | {"contact": found["contact"] | {"land": 0}}
    assert found["contact"]["lift"] and _warnings(none, parse_scenario(text, "x").scene)[0] == found["warnings"][0]
    assert found["contact"]["followers_held_at_end"] == 6 and found["contact"]["followers_riding_at_end"] == 0
    assert [words.split(":")[0][:18] for words in found["warnings"][:3]] == [
        "contact is lost", "the flange's frict", "the shaft is off b"]  # fmt: skip
    assert found["closed_form"]["hangs_up"] and found["closed_form"]["largest_eccentricity"] == 0.0


@pytest.mark.parametrize("when", [0.1, 0.25, 0.7])
def test_a_run_that_goes_on_amounts_to_the_same(when, tmp_path):
    """Broken off in its first half, in its second, and while it is done once more: all that is added up."""
    scenario, looks = parse_scenario(WATCHED.format(tension=0.12, speed=SPEEDING, samples=72), "x"), []
    whole = simulate(scenario, tmp_path / "whole.h5", stop=lambda: looks.append(0) is not None)
    # The later looks are those of the sharper run.
    left = iter(range(int(when * len(looks)), -1, -1))
    part = simulate(scenario, tmp_path / "part.h5", stop=lambda: next(left, 0) == 0)
    assert part.status == "interrupted" and (part.summary["settled"]["load"] is None) == (when == 0.1)
    assert (part.summary["end"]["time"] == part.summary["end"]["asked"]) == (when == 0.7)
    rest = simulate(scenario, tmp_path / "part.h5", resume=True)
    for part in ("whole", "settled", "contact"):
        # Each turn is as the other: which of them has the largest by a hair says nothing.
        same = {name: value for name, value in whole.summary[part].items() if not name.endswith(("_time", "_angle"))}
        for name, value in same.items():
            # The least load is one of places within the steps, which are others.
            near = 1e-3 * whole.summary["whole"]["largest_load"] if name == "least_load" else 1e-12
            assert rest.summary[part][name] == pytest.approx(value, rel=1e-4, abs=near), (part, name)


@pytest.mark.core
def test_the_impulse_is_the_integral_of_the_load():
    """Of a lip that rides for a third of a turn, to what the equations are exact to."""
    shaft = RadialShaft(R, 300.0, eccentricity=1e-4)
    run = RadialRun(RadialModel(RadialScene(shaft, lip=Lip(0.03, 4, 20.0, 5e4)), 1e-5), 0.007)
    assert solve(run, "dop853", 1e-5, Recorder()).status == "ok"
    arc, theta = 2 * math.pi * R / 4, np.pi / 2 * np.arange(4)
    swing = 1e-4 * (5e4 * arc - 0.0075 * 300.0**2)
    load = 20.0 * arc * 0.007 + swing * (np.sin(theta) - np.sin(theta - 300.0 * 0.007)) / 300.0
    assert run.extrema.time == pytest.approx(0.007)
    np.testing.assert_allclose(run.extrema.impulse, load, rtol=1e-8)


# --- what a follower does at rest ---------------------------------------------------------------------


@pytest.mark.parametrize("pull, mode, sign", [(0.024, HELD, 0.0), (-0.024, HELD, 0.0), (0.026, FREE, -1.0),
                                              (-0.026, FREE, 1.0)])  # fmt: skip
def test_a_follower_at_rest_is_held_or_goes_where_it_is_pulled(pull, mode, sign):
    """Flange friction of 0.025 N holds both ways; the springs of all others pull with it."""
    contacts = Contacts(RadialModel(ramped("segments"), 1e-6))
    _, matrix, _, preload, _ = constants("segments")
    # The follower itself stands where it should: the others pull.
    u = np.zeros(12)
    u[[0, 7]] = 0.5 * (pull - preload) / matrix[3, 0]
    y = np.concatenate([u, np.full(12, 1e-9), np.zeros(4)])
    contacts.modes[:] = FREE
    kind = contacts._stop(3, y)
    assert (contacts.modes[3], contacts.signs[3]) == (mode, sign) and kind == ("stick" if mode == HELD else "turn")
    assert y[12 + 3] == 0.0 and contacts.modes[2] == FREE
    # One that is held slips the same way.
    if mode == FREE:
        contacts.modes[:], contacts.signs[:] = HELD, 0.0
        contacts.begin(segment_at("segments", 0, contacts.modes), 0.0, y)
        _, second = contacts.guards(SimpleNamespace(at=lambda taus: (u[None], np.zeros((1, 12)))), np.array([0.0]))
        assert second[0, 3] == pytest.approx(0.025 - abs(pull))
        made = contacts.make(Transition(0, 0.0, y, (3, False)))
        assert made.event["kind"] == "slip" and (contacts.modes[3], contacts.signs[3]) == (FREE, sign)


def test_of_several_changes_within_a_step_the_first_is_made(monkeypatch):
    """Whichever follower it is of, and whether it meets the shaft."""
    contacts, block = Contacts(RadialModel(ramped("lip"), 1e-6)), SimpleNamespace(t=np.array([0.0, 1.0]))
    block.only = lambda step: block
    contacts.begin(SimpleNamespace(length=1.0), 0.0, None)
    for meets, leaves in ((0.3, 0.62), (0.62, 0.3)):
        at = np.full((2, 12), np.inf)
        at[0, 9], at[1, 2], at[1, 5] = meets, leaves, 0.9
        monkeypatch.setattr(contacts, "guards", lambda block, taus, at=at: (at - taus[:, None, None]).swapaxes(0, 1))
        time, j, touches = contacts._in_step(block, 0)
        assert time == pytest.approx(0.3, abs=1e-6) and (j, touches) == ((9, True) if meets == 0.3 else (2, False))


def test_closed_forms_in_words_and_at_their_edges():
    scene = ramped("segments")
    followers, shaft = followers_of(scene), scene.shaft
    preload, needed, largest = (
        words for words in re.findall(r"[\d.e+-]+(?= N/m| um)", " ".join(closed_form_sentences(followers, shaft)))
    )
    arc = 2 * math.pi * R / 12
    assert float(preload) == pytest.approx(4 * math.sin(math.pi / 12) / arc, rel=1e-3)
    # On a grid of the turn: where the three waves, seen by their inertia, push most.
    angles = np.linspace(0, 2 * np.pi, 100_001)
    inertia = sum(0.005 * (n * 500.0) ** 2 * a * np.cos(n * angles - phase) for n, a, phase in WAVES)
    assert float(needed) == pytest.approx((inertia.max() + 0.025) / arc, rel=1e-3)
    assert float(largest) == pytest.approx(1e6 * (4 * math.sin(math.pi / 12) - 0.025) / (0.005 * 500.0**2), rel=1e-3)
    assert needed_preload(followers, shaft, 500.0) == pytest.approx(float(needed) * arc, rel=1e-3)
    soft = followers_of(RadialScene(shaft, circumferential=Circumferential(0.06, 12, 0.01, axial_force=1.2,
                                                                           flange_friction=0.25)))  # fmt: skip
    assert largest_eccentricity(soft, shaft, 500.0) == 0.0
    # A lip whose offset alone takes all of its preload.
    slack = followers_of(RadialScene(shaft, lip=Lip(0.03, 12, 1.0, 5e4)))
    assert largest_eccentricity(slack, shaft, 500.0) == 0.0
    held = replace(followers, preload=0.025, friction=0.025)
    assert hangs_up(held) and not hangs_up(replace(held, preload=0.0250001))
    # The fastest may be the other way round.
    assert fastest(replace(shaft, speed=PiecewiseLinear((0.0, 1.0), (-600.0, 400.0)))) == -600.0
