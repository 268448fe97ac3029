"""Modes of rings on a linear film of a hundred unknowns made up here, against the eigenvalues of the whole system."""

from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gap_state, gas_film, linear_film, steady
from scipy.linalg import block_diag, eig
from scipy.sparse import csc_array

from sealdyn.dynamics.condensation import FilmDerivatives, LinearFilm
from sealdyn.dynamics.film_modes import ReducedFilm
from sealdyn.dynamics.modes import LinearScene, RingNumbers
from sealdyn.faces.film_thickness import lay_waves
from sealdyn.films.gas_reynolds import film as gas
from sealdyn.scene.patterns import Waviness

N = 40
STATOR = RingNumbers(1.0, True, 1.0, 8e-4, 0.0, 5e5, 300.0, 400.0, 0.24, 0.0)
ROTOR = RingNumbers(-1.0, True, 1.0, 8e-4, 16e-4, 5e5, 300.0, 400.0, 0.24, 5000.0)
RIGID = RingNumbers(-1.0, False, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5000.0)


def line_of_pressures(storage, carried, direct):
    """A film of three lines of N pressures, one for each motion of the gap: p'' = storage (p' + carried beside) + gap's
    rate and slope; the tilts' two lines carried around by the shaft, and a force of the gap itself, `direct`."""
    along = np.linspace(0.0, 1.0, N)
    diffusion = N**2 * (np.diag(-2 * np.ones(N)) + np.diag(np.ones(N - 1), 1) + np.diag(np.ones(N - 1), -1))
    turn = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    by_gap_rate, weights = -np.kron(np.eye(3), np.ones((N, 1))), 5e4 / N * (1 + 0.3 * along)
    return LinearFilm(
        by_rate=csc_array(-storage * np.eye(3 * N)),
        by_x=csc_array(np.kron(np.eye(3), diffusion) - storage * carried * np.kron(turn, np.eye(N))),
        by_gap_rate=by_gap_rate,
        by_gap=-3e3 * np.kron(np.eye(3), (1 - 2 * along)[:, None]) + 2500.0 * by_gap_rate @ turn,
        force_by_x=np.kron(np.diag([1.0, 1e-3, 1e-3]), weights[None, :]),
        force_by_gap=-direct * np.diag([1e6, 1e3, 1e3]),
        force_by_gap_rate=-direct * np.diag([200.0, 0.5, 0.5]),
        scales=np.full(3 * N, 1e-2),
    )


def whole_system(rings, film):
    """Eigenvalues of rings and pressures together, nothing reduced."""
    bare = LinearScene(rings, -film.force_by_gap, -film.force_by_gap_rate)
    n, gap = len(bare.mass), bare.gap
    left = np.block([
        [np.zeros((n, n)), np.eye(n), np.zeros((n, 3 * N))],
        [-bare.stiffness, -bare.damping, gap.T @ film.force_by_x],
        [film.by_gap @ gap, film.by_gap_rate @ gap, film.by_x.toarray()],
    ])  # fmt: skip
    return eig(left, block_diag(np.eye(n), bare.mass, -film.by_rate.toarray()))[0]


@pytest.mark.parametrize("rings", [[STATOR, RIGID], [STATOR, ROTOR]], ids=["one ring", "two rings"])
@pytest.mark.parametrize("storage", [1e-5, 1e-3, 1e-2, 1e-1])
@pytest.mark.parametrize("carried, direct", [(0.0, 0.0), (2500.0, 1.0)])
def test_no_mode_within_the_reach_is_missed_or_made_up(rings, storage, carried, direct):
    film = line_of_pressures(storage, carried, direct)
    linear = LinearScene(rings, *film.slow, film)
    found, expected = linear.eigen()[0], whole_system(rings, film)
    for value in found:
        assert np.min(np.abs(expected - value)) < 1e-8 * abs(value)
    for value in expected[np.abs(expected) < 0.999 * linear.reach]:
        assert np.min(np.abs(found - value)) < 1e-8 * abs(value)
    # Nothing faster grows.
    assert np.all(np.abs(expected[expected.real > 0]) < linear.reach)
    # The reduced film answers as the film along the imaginary axis, between the frequencies that were watched.
    reduced = linear._coupled[2]
    assert np.max(reduced.forced_residuals(1j * linear.reach * np.geomspace(1.1e-4, 1.0, 50))) < 1e-7
    assert reduced.basis.shape[1] < 3 * N


def test_state_matrix_of_a_film_that_stores_is_refused():
    film = line_of_pressures(1e-3, 0.0, 0.0)
    with pytest.raises(ValueError):
        LinearScene([STATOR, RIGID], *film.slow, film).state_matrix()


@pytest.mark.core
def test_answers_that_leave_rounding_and_no_more_are_no_reason_to_give_up(monkeypatch):
    film = line_of_pressures(1e-3, 2500.0, 1.0)
    expected = LinearScene([STATOR, RIGID], *film.slow, film).eigen()[0]
    sharp = ReducedFilm.forced_residuals
    monkeypatch.setattr(ReducedFilm, "forced_residuals", lambda self, p: np.maximum(sharp(self, p), 2e-8))
    found = LinearScene([STATOR, RIGID], *film.slow, film).eigen()[0]
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(expected), rel=1e-7)


def test_a_film_alike_all_around_answers_as_its_few_combinations_do():
    film = gas_film((6, 16), coning=3e-4)
    whole = linear_film(film, gap_state(film, 1000.0))
    alone = replace(whole, around=None)
    assert len(whole.few.scales) == 3 * 6 and alone.few is alone
    for p in (0.0, 3e3j, -2e3 + 5e4j):
        assert whole.stiffness(p) == pytest.approx(alone.stiffness(p), rel=1e-10, abs=1e-3)
        assert whole.unknowns(p) == pytest.approx(alone.unknowns(p), rel=1e-9, abs=1e-4)
    for one, other in zip(whole.slow, alone.slow, strict=True):
        assert one == pytest.approx(other, rel=1e-10, abs=1e-3)
    rings = [STATOR, RIGID]
    found, expected = (LinearScene(rings, *film.slow, film).eigen()[0] for film in (whole, alone))
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(expected), rel=1e-8)


@pytest.mark.parametrize("order, few", [(3, None), (4, 3 * 6 * 4), (5, None), (8, 3 * 6 * 2)])
def test_waves_leave_the_sectors_that_they_leave_alike(order, few):
    film = gas_film((6, 16), coning=3e-4)
    s, f = gap_state(film, 1000.0), gas.parameters(film, film.clearance)
    lay_waves(f, [Waviness(order=order, amplitude=1e-6)], [])
    x, steps = steady(f, s), (5e-8, 1e-6, 5e-5, 1e-3)
    found = LinearFilm.about(FilmDerivatives(gas.FILM, gas.unknowns(f), f), s, x, steps)
    assert (None if found.few is found else len(found.few.scales)) == few
    alone = replace(found, around=None)
    assert found.stiffness(2e3j) == pytest.approx(alone.stiffness(2e3j), rel=1e-9, abs=1e-3)
