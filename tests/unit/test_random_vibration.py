"""Random vibration of the housing: the density that was asked for comes out of the compiled imposed motion."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from command import SCENARIOS
from scenes import fmr
from scipy.integrate import quad
from scipy.signal import welch

from sealdyn.dynamics.equations import LEG_AT
from sealdyn.dynamics.imposed_motion import PER_RING, TILT_Y_ACCELERATION, Z_ACCELERATION, imposed_state
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import Concern
from sealdyn.scenario.reader import ScenarioError, parse_scenario
from sealdyn.scene.excitation import AngularRandom, AxialRandom, Housing, mean_square, tones_of
from sealdyn.simulation.simulate import prepare_run

FMR = (SCENARIOS / "fmr_reference.toml").read_text()
# As test standards draw it: up, flat, down, and a piece that falls as 1/f.
CORNERS, DENSITY = (20.0, 80.0, 350.0, 700.0, 2000.0), (0.1, 0.4, 0.4, 0.2, 0.01)
STANDARD = AxialRandom(CORNERS, DENSITY)


def density_at(f):
    """Straight between the corners in a double logarithmic diagram."""
    return np.exp(np.interp(np.log(f), np.log(CORNERS), np.log(DENSITY)))


def imposed(housing, times, slot):
    """One slot of the stator's imposed state at times (s)."""
    segment = Model(fmr(housing=housing)).segment()
    c, found = np.zeros(2 * PER_RING), np.empty(len(times))
    for n, t in enumerate(times):
        imposed_state(t, segment.p[LEG_AT:], c)
        found[n] = c[slot]
    return found


@pytest.mark.core
def test_mean_square_is_the_integral_of_the_density():
    for low, high in ((20.0, 2000.0), (50.0, 90.0), (400.0, 600.0), (1.0, 30.0)):
        inside = [max(low, 20.0), *(f for f in CORNERS if low < f < high), min(high, 2000.0)]
        area = sum(quad(density_at, a, b)[0] for a, b in pairwise(sorted(set(inside))))
        assert mean_square(STANDARD, low, high) == pytest.approx(area, rel=1e-10)
    assert mean_square(AxialRandom((20.0, 2000.0), 0.5)) == pytest.approx(0.5 * 1980.0, rel=1e-14)


def test_power_of_the_tones_is_the_mean_square_bin_by_bin():
    tones = tones_of(STANDARD, "axial 0")
    assert sum(a * a / 2 for _, a, _ in tones) == pytest.approx(mean_square(STANDARD), rel=1e-12)
    width = 1980.0 / 200
    for n, (frequency, amplitude, _) in enumerate(tones):
        begin = 20.0 + n * width
        assert begin <= frequency <= begin + width
        assert amplitude**2 / 2 == pytest.approx(mean_square(STANDARD, begin, begin + width), rel=1e-9)


def test_spectrum_of_the_imposed_acceleration_is_the_density():
    rate, long = 5120.0, 8.0
    times = np.arange(int(rate * long)) / rate
    acceleration = imposed(Housing(axial_random=[STANDARD]), times, Z_ACCELERATION)
    rms = math.sqrt(mean_square(STANDARD))
    assert np.sqrt(np.mean(acceleration**2)) == pytest.approx(rms, rel=0.02)
    f, found = welch(acceleration, rate, nperseg=int(rate / 4))
    for low, high in ((100.0, 300.0), (350.0, 650.0), (800.0, 1200.0), (1300.0, 1900.0)):
        inside = (f >= low) & (f < high)
        assert np.mean(found[inside]) == pytest.approx(np.mean(density_at(f[inside])), rel=0.1)
    assert np.max(found[f > 2040.0]) < 1e-6 * max(DENSITY)


def test_angular_vibration_about_its_axis():
    shaken = AngularRandom((50.0, 500.0), 100.0, direction=math.pi / 2)
    times = np.arange(0.0, 8.0, 1 / 2048)
    acceleration = imposed(Housing(angular_random=[shaken]), times, TILT_Y_ACCELERATION)
    assert np.sqrt(np.mean(acceleration**2)) == pytest.approx(math.sqrt(100.0 * 450.0), rel=0.03)
    assert Model(fmr(own=0.0, fixed=0.0, housing=Housing(angular_random=[shaken]))).unknowns.with_tilt
    assert not Model(fmr(own=0.0, fixed=0.0, housing=Housing(axial_random=[STANDARD]))).unknowns.with_tilt


def test_seed_decides_all():
    again, other = AxialRandom(CORNERS, DENSITY, seed=0), AxialRandom(CORNERS, DENSITY, seed=1)
    assert tones_of(again, "axial 0") == tones_of(STANDARD, "axial 0")
    assert tones_of(other, "axial 0") != tones_of(STANDARD, "axial 0")
    # As drawn on any machine.
    assert tones_of(STANDARD, "axial 0")[0][0] == pytest.approx(20.0 + 9.9 * 0.7273151403132914, rel=1e-14)
    # Two vibrations with the same numbers and seed are independent.
    first, second = np.array([t.phase for t in Housing(axial_random=[STANDARD, STANDARD]).tones]).reshape(2, 200)
    assert abs(np.mean(np.exp(1j * (first - second)))) < 0.25


def scenario(table, *overrides):
    return parse_scenario(f"{FMR}\n[[housing.axial_random]]\n{table}\n", "seal.toml", overrides)


def test_scenario_with_units_and_what_check_says():
    held = scenario('frequency = ["20 Hz", "2 kHz"]\ndensity = "0.001 g^2/Hz"', "run.turns=2")
    (random,) = held.scene.housing.axial_random
    assert random == AxialRandom((20.0, 2000.0), 0.0961703842225)
    words = '["0.0961703842225 (m/s^2)^2/Hz", "0.0961703842225 m^2/s^4/Hz"]'
    assert scenario(f"frequency = [20, 2000]\ndensity = {words}").scene != held.scene
    gentle = scenario('frequency = ["500 Hz", "2 kHz"]\ndensity = "1e-6 g^2/Hz"', "run.turns=2")
    rms = 9.80665 * math.sqrt(1e-6 * 1500.0)
    assert any(f"{rms:.4g} m/s^2 rms" in reason for reason in prepare_run(gentle)[0].reasons)


def test_samples_too_few_for_the_highest_frequency():
    table = 'frequency = ["500 Hz", "8 kHz"]\ndensity = "1e-6 g^2/Hz"'
    for per_turn, warned in ((64, True), (128, False)):
        ready, *_ = prepare_run(scenario(table, "run.turns=2", f"run.samples_per_turn={per_turn}"))
        assert any(caution.concern is Concern.ALIASING for caution in ready.cautions) == warned


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ('frequency = ["20 Hz"]\ndensity = 1.0', "housing.axial_random.0.frequency"),
        ("frequency = [20, 10]\ndensity = 1.0", "housing.axial_random.0.frequency"),
        ("frequency = 20\ndensity = 1.0", "housing.axial_random.0.frequency"),
        ("frequency = [20, 100]\ndensity = [1, 2, 3]", "housing.axial_random.0.density"),
        ("frequency = [20, 100]\ndensity = 0.0", "housing.axial_random.0.density"),
        ('frequency = [20, 100]\ndensity = "1 g"', "housing.axial_random.0.density"),
        ("frequency = [20, 100]\ndensity = 1\ntones = 0", "housing.axial_random.0.tones"),
        ("frequency = [20, 100]\ndensity = 1\ntones = 1000000", "housing.axial_random.0.tones"),
        ("frequency = [20, 100]\ndensity = 1\nseed = -1", "housing.axial_random.0.seed"),
    ],
)
def test_what_cannot_be(table, key):
    with pytest.raises(ScenarioError) as error:
        scenario(table)
    assert error.value.key == key


def test_values_at_keys_and_back_to_a_file():
    held = scenario("frequency = [20, 100]\ndensity = 1e-3")
    changed = held.with_({"housing.axial_random.0.density": [1e-3, 2e-3], "housing.axial_random.0.seed": 5})
    expected = replace(held.scene.housing.axial_random[0], density=(1e-3, 2e-3), seed=5)
    assert changed.scene.housing.axial_random == [expected]
    assert parse_scenario(changed.to_toml(), "seal.toml").scene == changed.scene
