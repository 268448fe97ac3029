"""Ludwig & Allen's film, closed form against the radial film at rest and in time.

Face width over mean radius is 0.017: the arm of the sine moment, dR^2/(20 R^2) longer, moves h0, h1 by 3e-5 to 7e-5.
"""

import numpy as np
import pytest

from sealdyn.analysis import quasi_static
from sealdyn.closed_form import ludwig_allen as la

RING = quasi_static.Ring()
RATIOS = [2.0, 3.0, 5.0, 20.0]


def closed(q):
    return np.array(la.equilibrium(q, RING.group))


def linearised(films, ring):
    """Eigenvalues (1/s) of the two unknowns about (h0, h1), from central differences of the radial film."""
    wedge = quasi_static.Wedge(ring)
    step, pace = 1e-4 * (films[0] - films[1]), 0.5 * ring.shaft_speed
    columns = []
    for k in range(4):
        size = step if k < 2 else step * pace
        move = np.eye(4)[k] * size
        up, down = (np.array(wedge(films + m[:2], m[2:])[:2]) for m in (move, -move))
        columns.append((up - down) / (2 * size))
    stiffness, damping = np.array(columns[:2]).T, np.array(columns[2:]).T
    return np.sort_complex(np.linalg.eigvals(np.linalg.solve(damping, -stiffness)))


@pytest.mark.parametrize("q", RATIOS)
def test_static_residuals_vanish_at_the_closed_form_and_a_root_finder_returns_to_it(q):
    films = closed(q)
    force, moment = quasi_static.residuals(q, quasi_static.Wedge(RING), films)
    assert abs(force) < 1e-9
    assert moment == pytest.approx((RING.face_width / RING.mean_radius) ** 2 / 20, rel=1e-3)
    for start in ((1.3, 1.04), (0.5, 0.3), (3.0, 2.0)):
        found = quasi_static.static_root(q, (start[0] * films[0], start[1] * films[0]), RING)
        assert found == pytest.approx(films, rel=1e-4)


@pytest.mark.core
def test_no_static_film_below_the_least_ratio():
    with pytest.raises(ValueError, match="hang-up"):
        quasi_static.static_root(1.6, (5e-7, 1e-7), RING)


@pytest.mark.parametrize("q", RATIOS)
def test_quasi_static_run_settles_on_the_closed_form_from_above(q):
    films = closed(q)
    for above in (1.02, 1.1) if q < 3 else (1.02, 1.2):
        run = quasi_static.quasi_static(q, above * films, RING)
        assert run.status == "settled", run.message
        assert np.array(run.films) == pytest.approx(films, rel=1e-4)
        cosine = -RING.spring_force * RING.mean_radius * films[1] / films[0]
        # Nobody balances it: the ring's guide carries it.
        assert quasi_static.Wedge(RING)(run.films)[2] == pytest.approx(cosine, rel=2e-3)


@pytest.mark.parametrize("q", RATIOS)
def test_eigenvalues_of_the_radial_film_are_the_closed_form(q):
    expected = la.eigenvalues(q, 0.5 * RING.shaft_speed)
    assert linearised(closed(q), RING) == pytest.approx(expected, rel=1e-5)


def test_the_run_turns_and_decays_with_them():
    """Two windows of the free motion: decay and frequency of what is left of a 0.1 % start, at q = 2."""
    films = closed(2.0)
    run = quasi_static.quasi_static(2.0, 1.001 * films, RING, duration=0.02, accuracy=1e-7)
    value = la.eigenvalues(2.0, 500.0)[1]
    rest = np.array(quasi_static.static_root(2.0, films, RING))
    left = run.mean_film - rest[0]
    inside = (run.time > 0) & (run.time < 0.01)
    t = run.time[inside]
    # h0 - rest = e^(re t) (a cos + b sin): linear least squares with the closed form's value leaves next to nothing.
    wave = np.exp(value.real * t)[:, None] * np.column_stack([np.cos(value.imag * t), np.sin(value.imag * t)])
    fit = wave @ np.linalg.lstsq(wave, left[inside], rcond=None)[0]
    assert np.max(np.abs(fit - left[inside])) < 0.01 * np.max(np.abs(left))


@pytest.mark.parametrize("q, start", [(1.65, (3e-7, 1.5e-7)), (1.65, (5e-7, 2e-7)), (1.62, (5e-7, 2e-7))])
def test_hang_up_is_named(q, start):
    run = quasi_static.quasi_static(q, start, RING, duration=0.02)
    assert run.status == "hang-up"


def test_a_start_too_thick_hangs_too():
    run = quasi_static.quasi_static(3.0, 1.5 * closed(3.0), RING)
    assert run.status == "hang-up"
