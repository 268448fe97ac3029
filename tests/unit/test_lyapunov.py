"""Lyapunov exponents against maps and flows whose exponents are known, both roads."""

import numpy as np
import pytest
from scipy.linalg import expm

from sealdyn.numerics.time_series import horizon, tangent_product, two_trajectories, uncertainty


def logistic(x):
    return 4.0 * x * (1.0 - x)


def logistic_tangent(x, q):
    return logistic(x), (4.0 - 8.0 * x)[:, None] * q


def henon(x):
    return np.array([1.0 - 1.4 * x[0] ** 2 + x[1], 0.3 * x[0]])


def henon_tangent(x, q):
    return henon(x), np.array([[-2.8 * x[0], 1.0], [0.3, 0.0]]) @ q


@pytest.mark.core
def test_logistic_map_has_ln_2():
    found = [
        two_trajectories(logistic, [0.3], [1.0], 20_000, distance=1e-8),
        tangent_product(logistic_tangent, [0.3], 20_000),
    ]
    for exponent in found:
        assert exponent.value == pytest.approx(np.log(2.0), abs=exponent.uncertainty + 1e-6)
        assert 0.0 < exponent.uncertainty < 0.02


def test_henon_map_and_its_area():
    found = two_trajectories(henon, [0.1, 0.1], [1.0, 1.0], 8000, distance=1e-7)
    product = tangent_product(henon_tangent, [0.1, 0.1], 8000, directions=2)
    for exponent in (found, product):
        assert exponent.value == pytest.approx(0.4192, abs=exponent.uncertainty)
        assert exponent.uncertainty < 0.03
    # The determinant of the map is -0.3 everywhere.
    assert product.spectrum.sum() == pytest.approx(np.log(0.3), abs=1e-10)


def test_damped_ring_has_its_least_damped_eigenvalue():
    """Gyroscopic ring, linear: gamma'' + (d - i J W) gamma' + k gamma = 0."""
    k, d, gyro, time = 4.0, 0.1, 0.6, 1.7
    a = np.array([[0, 0, 1, 0], [0, 0, 0, 1], [-k, 0, -d, -gyro], [0, -k, gyro, -d]], dtype=float)
    over = expm(a * time)
    expected = np.linalg.eigvals(a).real.max() * time
    one = two_trajectories(lambda x: over @ x, [1.0, 0, 0, 0], np.ones(4), 2000, settle=200)
    two = tangent_product(lambda x, q: (over @ x, over @ q), [1.0, 0, 0, 0], 2000, directions=4, settle=200)
    assert one.value == pytest.approx(expected, rel=2e-3)
    assert two.value == pytest.approx(expected, rel=2e-3)
    assert two.spectrum.sum() == pytest.approx(np.trace(a) * time, rel=1e-10)


@pytest.mark.parametrize("correlation", [0.0, 0.9])
def test_uncertainty_covers_what_it_says(correlation):
    """Means of a series that remembers: within the uncertainty in some 95 of 100 cases; the plain standard error would
    cover about a third of them at a correlation of 0.9."""
    rng, inside, plain = np.random.default_rng(5), 0, 0
    for _ in range(400):
        noise, series = rng.standard_normal(1200), np.zeros(1200)
        for k in range(1, 1200):
            series[k] = correlation * series[k - 1] + noise[k]
        inside += abs(series.mean()) < uncertainty(series)
        plain += abs(series.mean()) < 1.96 * series.std() / np.sqrt(len(series))
    assert inside > 360
    assert correlation == 0.0 or plain < 200


def test_horizon():
    assert horizon(np.log(2.0), 2.0**-20) == pytest.approx(20.0)
    assert horizon(-0.1, 1e-6) == np.inf
    assert uncertainty([1.0, 2.0, 3.0]) == np.inf
