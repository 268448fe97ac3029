"""Sine sweeps of the housing: the compiled motion against mpmath, its bounds, where it meets a run, what is refused."""

import math
import re
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr, run, started

from sealdyn.dynamics import imposed_motion as M
from sealdyn.dynamics.equations import LEG_AT
from sealdyn.dynamics.intervals import Interval
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import Concern
from sealdyn.dynamics.step_bounds import imposed_gap
from sealdyn.dynamics.swept_motion import largest_sweep
from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scene import sweep as sweeps
from sealdyn.scene.excitation import Housing
from sealdyn.scene.scene import SceneError
from sealdyn.scene.sweep import AngularSweep, AxialSweep, end, frequency_at, ramps, span
from sealdyn.simulation.batch import run_many
from sealdyn.simulation.film_error import steady_tilt
from sealdyn.simulation.run import evaluate
from sealdyn.simulation.simulate import prepare_run

FMR = (SCENARIOS / "fmr_reference.toml").read_text()
UP = AxialSweep((20.0, 400.0), displacement=3e-7, start=0.01, duration=0.4)
SWEEPS = {
    "displacement kept": UP,
    "acceleration kept": AxialSweep((20.0, 400.0), acceleration=3.0, start=0.01, duration=0.4),
    "crossover": AxialSweep((20.0, 400.0), displacement=3e-7, crossover=90.0, start=0.01, duration=0.4),
    "crossover of an acceleration": AxialSweep((20.0, 400.0), acceleration=3.0, crossover=90.0, duration=0.4),
    "downwards": AxialSweep((400.0, 20.0), acceleration=3.0, crossover=90.0, start=0.01, duration=0.4),
    "linear": AxialSweep((20.0, 400.0), displacement=3e-7, crossover=90.0, duration=0.4, spacing="linear"),
    "linear downwards": AxialSweep((400.0, 20.0), acceleration=2.0, duration=0.4, spacing="linear", ramp=0.2),
    "octaves a minute": AxialSweep((30.0, 240.0), displacement=3e-7, octaves_per_minute=450.0, start=0.01),
}


def exact_motion(sweep):
    """The displacement (m) over time (s) in mpmath, from its definition alone."""
    first, last = map(mpmath.mpf, sweep.frequency)
    octaves = mpmath.log(last / first, 2)
    length = mpmath.mpf(sweep.duration) if sweep.duration else 60 * octaves / sweep.octaves_per_minute
    ramp_up, ramp_down = ramps(sweep)

    def step(x):
        """Integral of (x (1 - x))^4 from 0, over its whole."""
        x = min(max(x, mpmath.mpf(0)), mpmath.mpf(1))
        return 630 * sum(math.comb(4, k) * (-1) ** k * x ** (5 + k) / (5 + k) for k in range(5))

    def at(t):
        s = t - mpmath.mpf(sweep.start)
        if s <= 0 or s >= length:
            return mpmath.mpf(0)
        if sweep.spacing == "linear":
            f, cycles = first + (last - first) * s / length, first * s + (last - first) * s**2 / length / 2
        else:
            k = mpmath.log(last / first) / length
            f = first * mpmath.exp(k * s)
            cycles = (f - first) / k
        w, corner = 2 * mpmath.pi * f, sweep.crossover and 2 * mpmath.pi * mpmath.mpf(sweep.crossover)
        if corner is None:
            size = sweep.displacement if sweep.acceleration is None else sweep.acceleration / w**2
        else:
            size = (sweep.displacement or sweep.acceleration / corner**2) / mpmath.root(1 + (w / corner) ** 32, 16)
        return size * step(s / ramp_up) * step((length - s) / ramp_down) * mpmath.sin(2 * mpmath.pi * cycles)

    return at


def shaken(*sweeps, **housing):
    axial = [sweep for sweep in sweeps if isinstance(sweep, AxialSweep)]
    angular = [sweep for sweep in sweeps if isinstance(sweep, AngularSweep)]
    return fmr(fixed=0.0, housing=Housing(axial_sweep=axial, angular_sweep=angular, **housing))


def segment_over(scene, begin, length):
    return Model(scene).segment(Interval(Fraction(begin), Fraction(length), Fraction(0), Fraction(0)))


@pytest.mark.parametrize("name", SWEEPS)
@pytest.mark.parametrize("begin", [0.0, 0.15], ids=["whole", "from within"])
def test_motion_is_the_defined_one_and_its_derivatives(name, begin):
    sweep = SWEEPS[name]
    segment, exact = segment_over(shaken(sweep), begin, 0.5), exact_motion(sweep)
    c, gap = np.zeros(2 * M.PER_RING), np.zeros(6)
    with mpmath.workdps(40):
        places = np.linspace(max(sweep.start, begin) + 1e-4, end(sweep) - 1e-4, 23)
        for t in (*places, sweep.start + ramps(sweep)[0] / 2, end(sweep) - ramps(sweep)[1] / 3):
            if t < begin:
                continue
            w = 2 * math.pi * frequency_at(sweep, t)
            size = abs(sweep.displacement or sweep.acceleration / w**2)
            M.imposed_state(t - begin, segment.p[LEG_AT:], c)
            imposed_gap(t - begin, segment.p, segment.w[: 2 * M.PER_RING], gap)
            for slot, order in ((M.Z, 0), (M.Z_RATE, 1), (M.Z_ACCELERATION, 2)):
                expected = float(mpmath.diff(exact, mpmath.mpf(t), order, h=mpmath.mpf(10) ** -12))
                # A time of 1 s is a float within 1e-16, which a phase of 1e3 rad feels.
                assert c[slot] == pytest.approx(expected, rel=1e-10, abs=3e-12 * size * w**order)
            assert (gap[0], gap[3]) == pytest.approx((c[M.Z], c[M.Z_RATE]), rel=1e-14)
    for t in (sweep.start - 1e-9, end(sweep) + 1e-9):
        M.imposed_state(t - begin, segment.p[LEG_AT:], c)
        assert not np.any(c[: M.PER_RING])


def test_tilt_is_about_its_direction_and_sweeps_add_up():
    tilted = AngularSweep((20.0, 400.0), displacement=1e-5, direction=0.7, duration=0.4)
    segment, c, alone = segment_over(shaken(UP, tilted, tilted), 0.0, 0.5), *np.zeros((2, 2 * M.PER_RING))
    gap, one = np.zeros(6), segment_over(shaken(replace(UP, start=0.0, displacement=1e-5)), 0.0, 0.5)
    for t in (0.05, 0.2, 0.39):
        M.imposed_state(t, segment.p[LEG_AT:], c)
        M.imposed_state(t, one.p[LEG_AT:], alone)
        imposed_gap(t, segment.p, segment.w[: 2 * M.PER_RING], gap)
        for slot, other in ((M.TILT_X, M.Z), (M.TILT_X_RATE, M.Z_RATE), (M.TILT_X_ACCELERATION, M.Z_ACCELERATION)):
            expected = 2 * alone[other] * np.array([math.cos(0.7), math.sin(0.7)])
            assert c[slot : slot + 2] == pytest.approx(expected, rel=1e-12)
        slots = M.Z, M.TILT_X, M.TILT_X + 1, M.Z_RATE, M.TILT_X_RATE, M.TILT_X_RATE + 1
        assert gap == pytest.approx(c[[*slots]])


@pytest.mark.parametrize("name", SWEEPS)
def test_bounds_hold_the_motion(name):
    sweep = SWEEPS[name]
    segment, exact = segment_over(shaken(sweep), 0.0, 0.5), exact_motion(sweep)
    reach, fourth = largest_sweep(segment.sweeps, segment.length)
    with mpmath.workdps(40):
        times = [mpmath.mpf(t) for t in np.linspace(sweep.start, end(sweep), 601)[1:-1]]
        found = max(abs(exact(t)) for t in times)
        bent = max(abs(mpmath.diff(exact, t, 4, h=mpmath.mpf(10) ** -8)) for t in times[::4])
    assert float(found) <= reach[0] == pytest.approx(sweeps.largest_amplitude(sweep)) and reach[1] == fourth[1] == 0.0
    # Of the fastest cycles nearly every phase is met.
    assert float(bent) <= fourth[0] < 6.0 * float(bent)
    swing = segment.swing
    assert swing[0] >= reach[0] and swing[3] >= fourth[0]
    assert segment.imposed_pace >= 2 * math.pi * max(sweep.frequency) * (1 - 1e-12)


def test_no_part_of_a_long_sweep_loses_its_phase():
    # A million cycles, met in the middle.
    sweep = AxialSweep((3.0, 5400.0), acceleration=10.0, duration=1400.0)
    c = np.zeros(2 * M.PER_RING)
    with mpmath.workdps(40):
        exact = exact_motion(sweep)
        for begin in (200.0, 1300.0):
            segment = segment_over(shaken(sweep), begin, 1.0)
            for tau in (0.0, 0.3, 0.999):
                M.imposed_state(tau, segment.p[LEG_AT:], c)
                expected = float(exact(mpmath.mpf(begin) + mpmath.mpf(tau)))
                w = 2 * math.pi * frequency_at(sweep, begin + tau)
                assert c[M.Z] == pytest.approx(expected, abs=1e-11 * 10.0 / w**2)


def test_segments_end_where_sweeps_do_and_nowhere_between():
    scene = shaken(UP, replace(UP, start=0.2))
    state = started(scene, 0.7)
    ends = [interval.time for interval in state.intervals]
    assert ends == pytest.approx([0.0, 0.01, 0.2, 0.41, 0.6])
    assert [len(state.segment(n).sweeps) for n in range(5)] == [0, 1, 2, 1, 0]
    assert [state.segment(n).harmonic for n in range(5)] == [True, False, False, False, True]
    assert state.segment(2).period() is None and state.segment(4).period() is not None
    assert state.fastest_forcing() >= 2 * math.pi * 400.0 * (1 - 1e-12)
    # A run that ends before the sweep does is not told of frequencies it does not get to.
    assert started(shaken(UP), 0.21).fastest_forcing() == pytest.approx(1000.0)
    fast = started(shaken(replace(UP, frequency=(200.0, 4000.0))), 0.21)
    assert fast.fastest_forcing() == pytest.approx(2 * math.pi * 200.0 * math.sqrt(20.0))


@pytest.mark.core
def test_rates_are_octaves_a_minute():
    sweep = SWEEPS["octaves a minute"]
    assert span(sweep) == pytest.approx(0.4) and frequency_at(sweep, 0.01 + 0.4 / 3) == pytest.approx(60.0)
    down = replace(sweep, frequency=(240.0, 30.0))
    assert span(down) == pytest.approx(0.4) and frequency_at(down, 0.41) == pytest.approx(30.0)


def test_cycles_of_the_slowest_octave():
    for name in ("displacement kept", "downwards", "linear", "linear downwards"):
        sweep = SWEEPS[name]
        times = np.linspace(sweep.start, end(sweep), 200_001)
        frequencies = np.array([frequency_at(sweep, t) for t in times])
        cycles = np.sum(frequencies[frequencies <= 40.0]) * (times[1] - times[0])
        assert sweeps.cycles_an_octave(sweep) == pytest.approx(cycles, rel=1e-3)
    fast = Housing(axial_sweep=[replace(UP, octaves_per_minute=3000.0, duration=None)])
    assert len(fast.remarks(1.0)[0]) > len(Housing(axial_sweep=[UP]).remarks(1.0)[0])


# --- runs ---------------------------------------------------------------------------------------------


def scenario_of(text, **values):
    return parse_scenario(f"{FMR}\n{text}\n", "seal.toml").with_({"run.duration": 0.1, "run.samples": 800, **values})


SHORT = '[[housing.axial_sweep]]\nfrequency = ["200 Hz", "2 kHz"]\nacceleration = "2 g"\nduration = "60 ms"'
LATE = SHORT + '\nstart = "20 ms"'


def test_energy_of_a_run_is_accounted_for():
    tilted = AngularSweep((200.0, 2000.0), displacement=4e-6, crossover=500.0, direction=0.3, duration=0.06)
    found = run(shaken(replace(UP, duration=0.06), tilted), duration=0.08, accuracy=1e-8)
    assert found.outcome.status == "ok" and found.model.unknowns.with_tilt
    assert found.outcome.energy_residual < 1e-7


def test_neighbouring_methods_agree():
    scene = shaken(replace(UP, frequency=(100.0, 1000.0), duration=0.06, displacement=1e-6))
    one, other = (run(scene, duration=0.08, accuracy=1e-8, method=name) for name in ("adams", "dop853"))
    assert np.abs(one.scaled() - other.scaled()).max() < 1e-6


def test_steady_starts_and_ends_are_beside_a_sweep():
    ready, plan = prepare_run(scenario_of(LATE, **{"run.start": "steady"}))
    method = plan.method
    assert ready.start.taken == "steady" and method != "expm" and ready.period(-1) is not None
    assert prepare_run(scenario_of(LATE, **{"run.start": "auto"}))[0].start.taken == "rest"


MEASURED = "[housing.motion]\ntime = [0, 0.02, 0.04, 0.06, 0.08, 0.1]\naxial = [0, 1e-7, 0, -1e-7, 0, 0]"
PUMP = re.search(r"```toml\n(.*?)```", (SCENARIOS.parent / "README.md").read_text(), re.DOTALL)[1]


@pytest.mark.parametrize("moved", [SHORT, MEASURED], ids=["sweep", "samples"])
def test_a_seal_that_overlaps_at_rest_begins_on_the_response_of_what_turns(moved):
    texts = (PUMP, f"{PUMP}\n{moved}\n")
    still, moving = (prepare_run(parse_scenario(text, "pump", ["run.turns=1"]))[0] for text in texts)
    assert moving.start.taken == "steady"
    names = [run.model.unknowns.names for run in (still, moving)]
    alike = [moving.y0[names[1].index(name)] for name in names[0]]
    assert np.any(alike) and alike == pytest.approx(still.y0[: len(alike)], rel=1e-9)


def test_no_scene_takes_a_sweep_that_comes_later_for_none():
    """What studies ask of a scene, whatever the time."""
    scene = shaken(replace(UP, start=0.2))
    with pytest.raises(SceneError) as error:
        Model(scene).segment().harmonics()
    assert error.value.key == "housing.axial_sweep.0"
    assert started(scene, 1.0).period() is None and started(scene, 1.0).period(-1) is not None
    assert steady_tilt(Model(scene))[0] == 0.0 != steady_tilt(Model(fmr()))[0]


def test_coarse_samples_are_told():
    for samples, warned in ((800, False), (300, True)):
        ready, *_ = prepare_run(scenario_of(SHORT, **{"run.samples": samples}))
        assert any(caution.concern is Concern.ALIASING for caution in ready.cautions) == warned


@pytest.mark.parametrize(
    "moved, frequency",
    [
        ('[[housing.axial]]\nfrequency = "5.4 kHz"\ndisplacement = "0.1 um"', 5400.0),
        (SHORT, 2000.0),
        # Passing at the shaft's speed.
        ('[[rotor.waviness]]\norder = 20\namplitude = "0.1 um"', 20 * 1000.0 / (2 * math.pi)),
        ("", None),
    ],
)
def test_samples_follow_what_is_known_to_be_fastest(moved, frequency):
    text = re.sub("samples_per_turn.*", "", f"{FMR}\n{moved}\n")
    film = "film.coefficients={axial_stiffness=1e7, tilt_stiffness=1e4, axial_damping=300, tilt_damping=0.2}"
    ready, plan = prepare_run(parse_scenario(text, "seal", ["run.turns=12", "film.model=linear", film]))
    assert not any(caution.concern is Concern.ALIASING for caution in ready.cautions)
    # As long as there is nothing, those of a turn.
    assert plan.count >= 8 * frequency * ready.duration * (1 - 1e-9) if frequency else plan.count == 12 * 64


def test_runs_together_are_those_by_themselves():
    scenario = scenario_of(SHORT)
    points = [{"set": {"housing.axial_sweep.0.acceleration": a}, "outputs": ["h_min.value"]} for a in (5.0, 20.0)]
    together = [row["h_min.value"] for row in run_many(scenario, points)]
    alone = [evaluate(scenario, p["set"], p["outputs"])["h_min.value"] for p in points]
    assert together == pytest.approx(alone, abs=1e-6 * 1e-5) and alone[1] < alone[0] - 1e-7
    fast = {"housing.axial_sweep.0.octaves_per_minute": 6000.0}
    assert evaluate(scenario, fast, ["h_min.value"])["h_min.value"] != alone[1]


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ('frequency = ["3 Hz"]\ndisplacement = 1e-6\nduration = 1', "frequency"),
        ('frequency = ["3 Hz", "9 Hz", "27 Hz"]\ndisplacement = 1e-6\nduration = 1', "frequency"),
        ("frequency = [3, 3]\ndisplacement = 1e-6\nduration = 1", "frequency"),
        ("frequency = [0, 3]\ndisplacement = 1e-6\nduration = 1", "frequency"),
        ("frequency = [3, -5]\ndisplacement = 1e-6\nduration = 1", "frequency"),
        ("frequency = [3, 5]\nduration = 1", "displacement"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nacceleration = 3\nduration = 1", "displacement"),
        ("frequency = [3, 5]\ndisplacement = -1e-6\nduration = 1", "displacement"),
        ("frequency = [3, 5]\ndisplacement = 1e-6", "duration"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nduration = 1\noctaves_per_minute = 1", "duration"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nduration = 0", "duration"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\noctaves_per_minute = -1", "octaves_per_minute"),
        ('frequency = [3, 5]\ndisplacement = 1e-6\noctaves_per_minute = 1\nspacing = "linear"', "octaves_per_minute"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nduration = 1\nstart = -1", "start"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nduration = 1\nramp = 0.6", "ramp"),
        ("frequency = [3, 5]\ndisplacement = 1e-6\nduration = 1\ncrossover = 0", "crossover"),
    ],
)
def test_what_a_sweep_cannot_be(table, key):
    with pytest.raises(ScenarioError) as error:
        parse_scenario(f"{FMR}\n[[housing.axial_sweep]]\n{table}\n", "seal.toml")
    assert error.value.key == f"housing.axial_sweep.0.{key}"


def test_a_sweep_after_the_end_of_the_run_is_refused():
    with pytest.raises(SceneError) as error:
        prepare_run(scenario_of(LATE, **{"run.duration": 0.02}))
    assert error.value.key == "housing.axial_sweep.0.start"
