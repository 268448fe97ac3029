"""Response to a sine sweep of the housing (quasi-steady with its known lag, and beside an independent integration), and
to a gear mesh: displacement of the housing and motion of the film."""

import math

import numpy as np
import pytest
from command import SCENARIOS
from scenes import CLEARANCE, R_I, R_O, SUPPORT, film, fmr, ring, run
from scipy.integrate import solve_ivp

from sealdyn import read_scenario
from sealdyn.scene.excitation import Housing
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import Rotor, Stator
from sealdyn.scene.sweep import AxialSweep, ramps

# Of the support and, of a linear film, axially (N/m, N s/m).
K, D, K_F, D_F, MASS = SUPPORT.axial_stiffness, SUPPORT.axial_damping, 5e6, 200.0, 1.0
LINEAR = film("linear", coefficients=Coefficients(400.0, 1.0, K_F, D_F))
VISCOSITY, CONING, OUTER = 0.5e-3, 3.125e-3, 5e5


def aligned(film_table, sweep):
    """The rotor floats, square with the shaft, the stator moves with the housing."""
    housing = Housing(axial_sweep=[sweep])
    return fmr(film=film_table, rotor=Rotor(**ring()), stator=Stator(), housing=housing)


def displacement(sweep, t):
    """Of the housing (m) at a real or complex time (s), from its definition."""
    (first, last), length, (rise, fall) = sweep.frequency, sweep.duration, ramps(sweep)
    if not 0.0 < t.real - sweep.start < length:
        return 0.0 * t
    s = t - sweep.start
    k = math.log(last / first) / length
    f = first * np.exp(k * s) if sweep.spacing == "logarithmic" else first + (last - first) * s / length
    cycles = (f - first) / k if sweep.spacing == "logarithmic" else 0.5 * (first + f) * s
    size = (
        sweep.displacement * (1 + (f / sweep.crossover) ** 32) ** (-1 / 16) if sweep.crossover else sweep.displacement
    )
    for share in (s / rise, (length - s) / fall):
        if share.real < 1.0:
            size = size * share**5 * (126 - 420 * share + 540 * share**2 - 315 * share**3 + 70 * share**4)
    return size * np.sin(2 * np.pi * cycles)


def moved(sweep, t):
    """Displacement and velocity (m/s), this one by a complex step."""
    return displacement(sweep, complex(t)).real, displacement(sweep, complex(t, 1e-30)).imag / 1e-30


def linear_force(gap, rate):
    return K_F * gap + D_F * rate


NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
RADII, WEIGHTS = 0.5 * (R_O + R_I) + 0.5 * (R_O - R_I) * NODES, 0.5 * (R_O - R_I) * WEIGHTS


def radial_force(gap, rate):
    """That at rest less that of the coned film (N), `(r h^3 p')' = 12 mu r h'` integrated once in closed form."""

    def force(gap, rate):
        h = CLEARANCE + gap + CONING * (RADII - R_I)
        per, squeeze = 1 / (RADII * h**3), 6 * VISCOSITY * rate * RADII / h**3
        slope = squeeze + (OUTER - WEIGHTS @ squeeze) / (WEIGHTS @ per) * per
        return np.pi * (OUTER * R_O**2 - WEIGHTS @ (slope * RADII**2))

    return force(0.0, 0.0) - force(gap, rate)


@pytest.mark.parametrize(
    ("table", "force"), [(LINEAR, linear_force), (film(), radial_force)], ids=["linear film", "radial film"]
)
@pytest.mark.parametrize(
    "sweep",
    [
        AxialSweep((100.0, 900.0), displacement=1.5e-6, crossover=400.0, start=0.005, duration=0.06),
        AxialSweep((900.0, 100.0), displacement=1.5e-6, duration=0.06, spacing="linear", ramp=0.02),
    ],
    ids=["up", "down"],
)
def test_ring_moves_as_an_independent_integration_has_it(table, force, sweep):
    def slopes(t, y):
        u, u_rate = moved(sweep, t)
        return [y[1], (-K * y[0] - D * y[1] + force(u - y[0], u_rate - y[1])) / MASS]

    found = run(aligned(table, sweep), duration=0.07, accuracy=1e-9)
    assert found.outcome.status == "ok" and found.outcome.energy_residual < 1e-7
    own = solve_ivp(
        slopes, (0.0, 0.07), [0.0, 0.0], "DOP853", t_eval=found.times, rtol=1e-10, atol=1e-17, max_step=2e-4
    )
    assert np.abs(found.q[:, 0] - own.y[0]).max() < 1e-7 * np.abs(own.y[0]).max()
    assert np.abs(own.y[0]).max() > 1e-6
    # The thinnest film of the run, met between the samples.
    gap = [moved(sweep, t)[0] for t in own.t] - own.y[0]
    assert found.record(0)[0] <= CLEARANCE + gap.min() + 1e-15


@pytest.mark.core
def test_lag_of_a_slow_sweep_is_that_of_its_rate():
    """Of a tone whose frequency changes at the rate a (rad/s^2) the answer is `(H - i a/2 H'') exp(i phase)`, to second
    order in a; without the second part the amplitude at resonance is late by the first order."""

    def answer(w):
        return (K_F + 1j * w * D_F) / (K + K_F - MASS * w**2 + 1j * w * (D + D_F))

    late, off = [], []
    for length in (0.4, 0.8, 1.6):
        sweep = AxialSweep((150.0, 650.0), displacement=1e-6, duration=length, spacing="linear", ramp=0.05 * length)
        found = run(aligned(LINEAR, sweep), duration=length, accuracy=1e-9, per_turn=40)
        inside = (found.times > 0.2 * length) & (found.times < 0.9 * length)
        t, z = found.times[inside], found.q[inside, 0]
        rate = 2 * np.pi * 500.0 / length
        w, phase = 2 * np.pi * 150.0 + rate * t, 2 * np.pi * 150.0 * t + 0.5 * rate * t**2
        step = 2.0
        second = (answer(w + step) - 2 * answer(w) + answer(w - step)) / step**2
        slow, lagging = (1e-6 * (h * np.exp(1j * phase)).imag for h in (answer(w), answer(w) - 0.5j * rate * second))
        late.append(np.abs(z - slow).max() / np.abs(z).max())
        off.append(np.abs(z - lagging).max() / np.abs(z).max())
    assert np.abs(np.log2(np.array(late[:-1]) / late[1:]) - 1.0).max() < 0.15, late
    assert np.abs(np.log2(np.array(off[:-1]) / off[1:]) - 2.0).max() < 0.4, off
    assert late[-1] > 5 * off[-1]


SCENARIO = SCENARIOS / "gear_mesh.toml"


@pytest.mark.core
def test_film_takes_what_the_mass_does_not_follow():
    w = 2 * math.pi * 5400.0
    displacement = 45 * 9.80665 / w**2
    assert displacement == pytest.approx(0.3833e-6, rel=2e-4)
    found = run(read_scenario(SCENARIO).scene, turns=8, accuracy=1e-7, per_turn=512, start="steady")
    stiffness, damping = (matrix[0, 0] for matrix in found.model.film_matrices())
    ring = 5e5 - w**2 * 1.0 + 300j * w
    # Rotor and film in series with the housing.
    expected = displacement * abs(ring / (ring + stiffness + 1j * w * damping))
    gap = found["axial_gap_change"][-4 * 512 :]
    # The film is stiffer as it closes: second order in the motion, 4 % of the clearance.
    assert 0.5 * np.ptp(gap) == pytest.approx(expected, rel=2e-3)
