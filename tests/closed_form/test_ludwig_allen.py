"""Ludwig & Allen's closed forms against their print and against direct integration over the half circle."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from sealdyn.closed_form import ludwig_allen as la


@pytest.mark.core
@pytest.mark.parametrize("row", la.LUDWIG_ALLEN, ids=lambda row: f"q={row.force_ratio:g}")
def test_published_films(row):
    """The group was recovered from the rounded print: 2 % for q = 2, 0.2 % for the other."""
    mean, amplitude = la.equilibrium(row.force_ratio, la.LUDWIG_ALLEN_GROUP)
    assert mean == pytest.approx(row.mean_film, rel=0.02 if row.force_ratio == 2 else 2e-3)
    if row.least_film is not None:
        assert mean - amplitude == pytest.approx(row.least_film, rel=0.02)


def half_circle(mean, amplitude, arm):
    """Force (arm 1) or moment over R (arm sin or cos of theta) of the wedge over its half, both over mu U dR^3."""

    def part(theta):
        return 0.5 * amplitude * math.sin(theta) / (mean + amplitude * math.cos(theta)) ** 3 * arm(theta)

    return quad(part, 0, math.pi, epsrel=1e-12)[0]


@pytest.mark.parametrize("q", [1.63, 2.0, 3.0, 5.0, 20.0])
def test_equilibrium_balances_spring_and_friction(q):
    group = la.LUDWIG_ALLEN_GROUP
    films = la.equilibrium(q, group)
    assert group * half_circle(*films, lambda t: 1.0) == pytest.approx(1.0, rel=1e-10)
    assert group * half_circle(*films, math.sin) == pytest.approx(la.friction_moment(1.0 / q, 1.0), rel=1e-10)
    assert la.sealing_number(q) == pytest.approx(films[0] ** 2 / group, rel=1e-12)


def test_the_moment_left_unbalanced():
    """The thinnest place is at theta = pi: pressure nearer to it straightens the ring."""
    films = la.equilibrium(2.0, la.LUDWIG_ALLEN_GROUP)
    assert half_circle(*films, math.cos) / half_circle(*films, math.sin) == pytest.approx(-0.92, abs=0.005)


def test_below_the_least_ratio_is_hang_up():
    assert abs(la.LEAST_FORCE_RATIO - 1.6211) < 5e-5
    assert la.amplitude_ratio(la.LEAST_FORCE_RATIO) == 0.0
    for function in (la.amplitude_ratio, la.sealing_number, lambda q: la.equilibrium(q, 1e-13)):
        with pytest.raises(ValueError, match="hang-up"):
            function(1.62)
    assert np.all(np.diff(la.sealing_number(np.linspace(1.7, 20, 30))) > 0)


def test_the_balance_repels_below_a_ratio_of_its_own():
    """It exists from 1.6211, but attracts from 1.7132 only: nobody seems to have said so."""
    assert abs(la.eigenvalues(la.LEAST_ATTRACTING_FORCE_RATIO, 500.0)[1].real) < 1e-9
    assert np.all(la.eigenvalues(1.70, 500.0).real > 0) and np.all(la.eigenvalues(1.73, 500.0).real < 0)
    assert la.eigenvalues(3.0, 1000.0) == pytest.approx(2 * la.eigenvalues(3.0, 500.0))
