"""Bounds of the gap within a step: below all that happens there, and extremes to the bit those of a full scan."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, NOTHING, R_I, R_O, SPEED, TILT_SCALE, film, fms, prepared, ring, run
from scipy.interpolate import CubicHermiteSpline

from sealdyn.dynamics import segments, step_bounds
from sealdyn.dynamics.extrema import LEAST, MOST, H, empty_records, slack, track_extremes, watched_level
from sealdyn.dynamics.imposed_motion import PER_RING
from sealdyn.dynamics.native import thinnest_value
from sealdyn.faces.film_thickness import h_min
from sealdyn.faces.geometry import GX, GY
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing, Shaft, Whirl
from sealdyn.scene.film import Profile
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import AxialRunout, Rotor, Stator
from sealdyn.scene.scene import Initial, RingStart
from sealdyn.solvers.contract import Counts
from sealdyn.solvers.methods import METHODS

TURN = 2 * math.pi / SPEED
EMPTY = film("linear", coefficients=NOTHING)
NO_BOUND = np.full(step_bounds.SWING, np.inf)
SEEDS = range(24)


def table(draw, least, most, end=3 * TURN):
    return PiecewiseLinear((0.0, end), tuple(draw.uniform(least, most, 2)))


def drawn(seed):
    """A scene whose rings move in every way there is, on faces that are flat, coned, worn or wavy; the cone of some
    follows the speed, of some time too."""
    draw = np.random.default_rng(seed)
    tilt = lambda most=4.0: draw.uniform(0, most) * TILT_SCALE / 10  # noqa: E731
    runout = [AxialRunout(draw.uniform(0.5, 5), draw.uniform(0, 0.15) * CLEARANCE, draw.uniform(0, 7))]
    whirl = [Whirl(draw.uniform(-2, 2), tilt(), draw.uniform(0, 7))]
    shaking = Housing(
        axial=[AxialVibration(frequency=draw.uniform(50, 400), displacement=draw.uniform(0, 0.1) * CLEARANCE)],
        angular=[AngularVibration(frequency=draw.uniform(50, 400), displacement=tilt(), direction=draw.uniform(0, 7))],
    )
    base, waves = film(), [[], []]
    if seed % 4 == 1:
        worn = Profile((R_I, draw.uniform(R_I + 1e-3, R_O - 1e-3), R_O), tuple(draw.uniform(0, 5e-6, 3)))
        base = film("profiled", profile=worn)
    if seed % 4 == 2:
        base = EMPTY
        waves = [
            [Waviness(int(draw.integers(2, 7)), draw.uniform(0, 0.1) * CLEARANCE, draw.uniform(0, 7))] for _ in range(2)
        ]
    speed = table(draw, 0.5 * SPEED, 1.5 * SPEED) if seed % 5 == 3 else SPEED
    if seed % 4 != 2 and seed % 5 in (0, 3):
        base = replace(base, coning=draw.uniform(-8e-4, 2e-4), coning_per_speed_squared=draw.uniform(-4e-10, 4e-10))
        base = replace(base, coning=table(draw, -8e-4, 2e-4)) if seed % 2 else base
    angle = table(draw, 0, 4e-5) if seed % 3 == 1 else tilt()
    if seed % 2:
        rotor, stator = Rotor(runout=angle, axial_runout=runout), Stator(**ring(misalignment=tilt()))
    elif seed % 3:
        rotor, stator = Rotor(**ring(misalignment=tilt())), Stator(misalignment=angle)
    else:
        rotor, stator = Rotor(**ring(misalignment=tilt())), Stator(**ring(misalignment=tilt()))
    return fms(
        film=base, housing=shaking, shaft=Shaft(speed=speed, whirl=whirl),
        stator=replace(stator, waviness=waves[0]), rotor=replace(rotor, waviness=waves[1]),
    )  # fmt: skip


def steps_of(scene, turns=3, accuracy=1e-6):
    """A run made ready, its first segment, and times, displacements and rates of the steps of CVODE over it."""
    ready = prepared(scene, turns * TURN, accuracy)
    segment, blocks = ready.segment(0), [(np.zeros(1), ready.y0[None])]
    blocks += [(t, ys) for t, ys, _ in METHODS["adams"](segment, 0.0, ready.y0, "adams", accuracy, Counts())]
    t, ys = (np.concatenate([block[i] for block in blocks]) for i in range(2))
    return ready, segment, t, *segment.motion(ys, ys)


def track(ready, segment, t, q, q_rate, swing=None, asked=True, known=None):
    """Time of collapse or -1, records, and reach (m, m), as the compiled loop has them; `known` records so far."""
    model, reach = ready.model, np.full((len(t), 2), np.nan)
    records = empty_records() if known is None else known
    windows = np.array([[0.0, t[-1]], [t[-1] - TURN, t[-1]], [t[-1] - 2 * TURN, t[-1] - TURN]])
    fallen = track_extremes(
        t, q, q_rate, len(t), 0, len(t) - 1, segment.p, thinnest_value(model.face), model.f, np.zeros(segment.size),
        np.zeros(segment.size), segment.w, segment.s, segment.swing if swing is None else swing, windows, 0, records,
        asked, watched_level(model), slack(model), segment.pace, 2 * math.pi / segment.shortest_period, reach,
    )  # fmt: skip
    return fallen, records, reach


def bounds(segment, face, t, q, q_rate, k):
    """Bounds (3,) of the measures over step k, and the lowest film possible."""
    motion, imposed, lower = np.empty((4, 3)), np.empty((2, 6)), np.empty(3)
    step_bounds.floating_motion(t, q, q_rate, k, segment.p, motion)
    lowest = step_bounds.lowest_possible(face, segment.swing, motion)
    films = [h_min(face, segment.gap_state(t[k + at], unknowns(segment, q[k + at])))[0] for at in range(2)]
    for at in range(2):
        step_bounds.imposed_gap(t[k + at], segment.p, segment.w[: 2 * PER_RING], imposed[at])
    step_bounds.add_imposed(motion, imposed, t[k + 1] - t[k])
    length, angle = t[k + 1] - t[k], segment.pace * t[k + 1]
    step_bounds.bound_measures(face, segment.swing, length, angle, motion, np.array(films), lower)
    return lower, lowest


def unknowns(segment, q):
    return np.concatenate([q, np.zeros(segment.size - len(q))])


def bent_steps(segment, seed):
    """Twenty steps (times, displacements, rates at both ends), cubics far more bent than those of a solver."""
    draw, n = np.random.default_rng(seed), segment.n
    for _ in range(20):
        t = draw.uniform(0, 1e-3) + np.array([0.0, 10.0 ** draw.uniform(-6, -3.5)])
        size = segment.scales[:n] * 10.0 ** draw.uniform(-3, -0.3)
        yield t, draw.normal(0, size, (2, n)), draw.normal(0, size, (2, n)) * draw.uniform(0, 2) / (t[1] - t[0])


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_in_a_step_is_beyond_its_bounds(seed):
    ready = prepared(drawn(seed), 3 * TURN, 1e-6)
    segment, face, close = ready.segment(0), ready.model.face, []
    for t, q, q_rate in bent_steps(segment, 100 + seed):
        lower, lowest = bounds(segment, face, t, q, q_rate, 0)
        curve, seen = CubicHermiteSpline(t, q, q_rate), []
        for at in np.linspace(t[0], t[1], 60):
            s = segment.gap_state(at, unknowns(segment, curve(at)))
            tilt = s[GX] ** 2 + s[GY] ** 2
            seen.append([h_min(face, s)[0], -tilt, tilt])
        least = np.min(seen, axis=0)
        assert np.all(lower <= least) and lowest <= least[step_bounds.THICKNESS]
        close.append((least - lower) / np.ptp(seen, axis=0))
    # They are worth having: of the same size as what they bound.
    assert np.median(close) < 3.0


@pytest.mark.parametrize("seed", SEEDS)
def test_the_thinnest_film_stays_within_its_reach(seed):
    ready = prepared(drawn(seed), 3 * TURN, 1e-6)
    segment, face, seen = ready.segment(0), ready.model.face, 0
    for t, q, q_rate in bent_steps(segment, 200 + seed):
        fallen, _, reach = track(ready, segment, t, q, q_rate)
        if fallen >= 0:
            continue
        curve = CubicHermiteSpline(t, q, q_rate)
        films = [h_min(face, segment.gap_state(at, unknowns(segment, curve(at))))[0] for at in np.linspace(*t, 60)]
        assert reach[0, 0] <= min(films) and max(films) <= reach[0, 1]
        seen += 1
    assert seen > 3


NODS = {
    # Farthest at one end or at both, where it has no rate: a cubic shows nothing of the nod.
    "half a turn": (0.5, Rotor(axial_runout=[AxialRunout(1, 2e-6, math.pi)], runout=TILT_SCALE / 10), []),
    "a turn": (1.0, Rotor(axial_runout=[AxialRunout(1, 2e-6, math.pi)]), []),
    # Crest in trough at both ends, crest on crest between.
    "a wave": (1 / 3, Rotor(waviness=[Waviness(3, 1e-6)]), [Waviness(3, 1e-6)]),
}


@pytest.mark.parametrize("name", NODS)
def test_a_step_past_a_whole_nod(name):
    turns, rotor, waves = NODS[name]
    ready = prepared(fms(film=EMPTY, stator=Stator(**ring(), waviness=waves), rotor=rotor), 3 * TURN, 1e-6)
    segment, face, t = ready.segment(0), ready.model.face, np.array([0.0, turns * TURN])
    rest = np.zeros((2, segment.n))
    lower, lowest = bounds(segment, face, t, rest, rest, 0)
    films = [h_min(face, segment.gap_state(at, np.zeros(segment.size)))[0] for at in np.linspace(*t, 400)]
    assert max(lower[step_bounds.THICKNESS], lowest) <= min(films) < films[0] + 1e-15


@pytest.mark.parametrize("seed", SEEDS)
def test_imposed_motion_as_the_equations_have_it(seed):
    """The gap of rings that rest in their scene, and its rates by differences."""
    ready = prepared(drawn(seed), 3 * TURN, 1e-6)
    segment, step, at = ready.segment(0), 1e-8, np.empty(6)
    rest = np.zeros(segment.size)
    for tau in np.linspace(1e-4, segment.length - 1e-4, 7):
        step_bounds.imposed_gap(tau, segment.p, segment.w[: 2 * PER_RING], at)
        before, here, after = (segment.gap_state(tau + move, rest)[:3].copy() for move in (-step, 0.0, step))
        scales = np.array([CLEARANCE, TILT_SCALE, TILT_SCALE])
        assert np.all(np.abs(at[:3] - here) <= 1e-13 * scales)
        assert np.all(np.abs(at[3:] - (after - before) / (2 * step)) <= 1e-5 * SPEED * scales)
        most = segment.swing[:2] * (1 + 1e-12)
        assert abs(here[0]) <= most[0] and np.hypot(*here[1:]) <= most[1]


def compared(given):
    """Time of collapse or -1, the same with bounds and without them, and the share of steps that need no scan."""
    fallen, records, reach = track(*given)
    everywhere, full, whole = track(*given, swing=NO_BOUND)
    assert fallen == everywhere and np.array_equal(records, full)
    # Collapse alone, by the bounds alone.
    alone, nothing, _ = track(*given, asked=False)
    assert alone == fallen and (alone >= 0 or np.array_equal(nothing, empty_records()))
    return fallen, np.mean(reach[:-1, 0] != whole[:-1, 0])


@pytest.mark.parametrize("seed", SEEDS)
def test_extremes_are_those_of_a_full_scan(seed):
    compared(steps_of(drawn(seed)))


@pytest.mark.parametrize("measure", [H, MOST, LEAST])
@pytest.mark.parametrize("span", [0.3, 1.5])
def test_an_extreme_is_found_wherever_in_a_step_it_lies(span, measure):
    """A parabola in three equal steps of so many radians of the fastest motion, its end in the second of them, a little
    beyond what is known."""
    moving = Initial(stator=RingStart(z=0.1 * CLEARANCE, tilt_x=0.1 * TILT_SCALE))
    ready = prepared(fms(film=EMPTY, own=0.0, runout=0.0, initial=moving), 3 * TURN, 1e-6)
    segment, unknown, bend = ready.segment(0), int(measure != H), -1.0 if measure == MOST else 1.0
    step, size = span * segment.shortest_period / (2 * math.pi), 0.02 * (CLEARANCE if measure == H else TILT_SCALE)
    t, q, q_rate = step * np.arange(4.0), np.zeros((4, segment.n)), np.zeros((4, segment.n))
    for place in np.linspace(1.0, 2.0, 121):
        off = t / step - place
        q[:, unknown] = size * (10.0 + bend * off**2)
        q_rate[:, unknown] = size * bend * 2.0 * off / step
        exact, known = 10.0 * size + (CLEARANCE if measure == H else 0.0), empty_records()
        known[:, measure] = exact + bend * 0.002 * size
        found = track(ready, segment, t, q, q_rate, known=known)[1][0, measure]
        assert found == pytest.approx(exact, abs=2.0 * slack(ready.model)[unknown])


@pytest.mark.core
def test_few_steps_are_scanned():
    fallen, share = compared(steps_of(fms(), turns=20))
    assert fallen < 0 and share > 0.7


@pytest.mark.parametrize("deep", [0.9, 1.0, 1.02, 1.3])
def test_no_collapse_is_missed(deep):
    """Gaps that nod to the floor between steps, as deep as it or not quite."""
    collapsed = 0
    for seed in range(12):
        draw = np.random.default_rng(seed)
        ratio, share = 1 + 1 / draw.integers(5, 12), draw.uniform(0.3, 0.7)
        depth = deep * (1 - 1e-3) * CLEARANCE
        runout = [AxialRunout(1, share * depth), AxialRunout(ratio, (1 - share) * depth, draw.uniform(0, 7))]
        waves = [Waviness(3, 0.02 * CLEARANCE)] if seed % 2 else []
        rotor = Rotor(axial_runout=runout, waviness=waves)
        scene = fms(film=EMPTY, stator=Stator(**ring(misalignment=1e-7)), rotor=rotor)
        collapsed += compared(steps_of(scene, turns=12, accuracy=1e-3))[0] >= 0
    assert collapsed >= {0.9: 0, 1.0: 6, 1.02: 6, 1.3: 12}[deep]


@pytest.mark.parametrize("seed", [0, 3, 5, 9, 12, 15])
def test_contacts_are_those_of_a_full_scan(seed, monkeypatch):
    """Faces so soft that touching changes nothing."""
    scene = replace(drawn(seed), contact=Contact(roughness=6e-7, compressive_strength=1e-6))
    found = []
    for swing in (None, NO_BOUND):
        if swing is not None:
            monkeypatch.setattr(segments, "largest_swing", lambda *given: NO_BOUND)
        ended, events = run(scene, turns=3, per_turn=1), []
        ended.ready.contacts.tell(events.extend, end=(ended.outcome.tau, ended.outcome.y))
        found.append((ended.outcome.tau, str(events), ended.ready.extrema.records.tolist()))
    assert found[0] == found[1]
