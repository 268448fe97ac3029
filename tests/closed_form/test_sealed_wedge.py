"""The wedge under a sealed pressure against the cut parabola summed over the face; its limits."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from sealdyn.closed_form import ludwig_allen as la
from sealdyn.closed_form import sealed_wedge as sealed
from sealdyn.closed_form.sealed_wedge import Edges

# Outside, inside, both over the cavity's, cavity far below; the last two with the face's width.
CASES = {
    "outside": Edges(0.0, 0.3),
    "inside": Edges(2.0, 0.0),
    "both": Edges(0.1, 0.6),
    "equal": Edges(0.5, 0.5),
    "wide": Edges(0.05, 0.4, 0.05),
    "wide, inside": Edges(0.9, 0.0, 0.05),
}
# Middles of cells over the width, and around the circle.
X = (np.arange(1500) + 0.5) / 1500
THETA = (np.arange(1500) + 0.5) / 1500 * 2 * math.pi


def summed(e, number, edges):
    """Force, sine and cosine moment over L and R L of the cut profile on a film, cell by cell."""
    wedge = e * np.sin(THETA) / (1 + e * np.cos(THETA)) ** 3
    line = 2 * number * (edges.inner + (edges.outer - edges.inner) * X)
    excess = np.maximum(line + 6 * wedge[:, None] * X * (1 - X), 0.0) - line
    radius = 1 + edges.width * (X - 0.5)
    force, moment = excess @ radius, excess @ radius**2
    each = 2 * math.pi / len(THETA) / len(X) / 2 / number
    return each * np.array([force.sum(), moment @ np.sin(THETA), moment @ np.cos(THETA)])


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("e", [0.05, 0.5, 0.9])
def test_balance_is_that_of_the_cut_profile(name, e):
    """Cells err by 1e-6; the second order of the width, left out of the moments, by width^2/20 = 1e-4."""
    edges = CASES[name]
    number, sine, cosine = sealed.balance(e, edges)
    expected = summed(e, number, edges)
    assert expected[0] == pytest.approx(1.0, rel=2e-5)
    assert (sine, cosine) == pytest.approx(expected[1:], rel=4e-4 if edges.width else 3e-5)


@pytest.mark.core
@pytest.mark.parametrize("q", [2.0, 6.0])
def test_without_pressure_it_is_ludwig_and_allens(q):
    faint = Edges(0.0, 1e-7)
    for function in (la.amplitude_ratio, la.sealing_number, la.closed_form_guide):
        assert function(q, faint) == pytest.approx(function(q), rel=1e-5), function
    assert la.eigenvalues(q, 500.0, faint) == pytest.approx(la.eigenvalues(q, 500.0), rel=1e-4)
    assert la.least_force_ratio(faint) == pytest.approx(la.LEAST_FORCE_RATIO, rel=1e-5)
    assert la.least_attracting_force_ratio(faint) == pytest.approx(la.LEAST_ATTRACTING_FORCE_RATIO, rel=1e-4)
    assert la.film(1.4, 0.1, 1e-13, faint) == pytest.approx(la.film(1.4, 0.1, 1e-13), rel=1e-5)
    assert la.film_range(0.3, faint) == pytest.approx(la.film_range(0.3), rel=1e-5)


def test_a_film_that_does_not_cavitate_carries_nothing():
    """Full Sommerfeld: no force, no cosine moment, the sine moment of both halves.  Under strong pressure the film is
    the one where the cavity just begins, 6 |P| = p: N p R dR / L = 3 max e sin / (1 + e cos)^3."""
    e = 0.6
    summit = max(e * np.sin(THETA) / (1 + e * np.cos(THETA)) ** 3)
    onset = 3 * summit
    thick = sealed.carried(e, 1.01 * onset, Edges(0.0, 1.0))
    assert thick * 1.01 * onset == pytest.approx([0.0, 0.5 * math.pi * e / (1 - e * e) ** 1.5, 0.0], abs=1e-12)
    numbers = [sealed.balance(e, Edges(0.0, pressure))[0] * pressure / onset for pressure in (1e1, 1e3, 1e5, 1e7)]
    assert np.all(np.diff(numbers) > 0) and 0.95 < numbers[-1] < 1.0
    # A cavity of depth eps spans eps^(1/2) of the circle, and keeps eps^3 of the pressure: load eps^(7/2).
    slope = np.diff(np.log(1 - np.array(numbers)))[-1] / math.log(1e2)
    assert slope == pytest.approx(-2 / 7, abs=0.02)


def test_orientation():
    """The side of the pressure does not matter on a face of no width; on another it shifts the film up or down."""
    plain = sealed.balance(0.7, Edges(0.0, 0.5))
    assert sealed.balance(0.7, Edges(0.5, 0.0)) == pytest.approx(plain, rel=1e-12)
    out, inside = (sealed.balance(0.7, edges)[0] - plain[0] for edges in (Edges(0, 0.5, 1e-3), Edges(0.5, 0, 1e-3)))
    assert out == pytest.approx(-inside, rel=1e-2) and abs(out) > 1e-5 * plain[0]


def test_moments_of_a_released_ring():
    """Its film's moment rises with the tilt under weak pressure, and falls under strong: then there is no range."""
    for pressure, rises in ((0.1, True), (0.3, False)):
        edges = Edges(0.0, pressure)
        moments = [math.hypot(*sealed.balance(e, edges)[1:]) for e in np.linspace(1e-5, 0.999, 300)]
        least, most, _ = sealed.moment_limits(edges)
        assert (least, most) == pytest.approx((moments[0], max(moments)), rel=1e-4)
        assert (most > 1.01 * least) == rises
    q = 4 / math.pi / 1.02
    mean, amplitude = la.film(q, 0.0, 1.0, Edges(0.0, 0.1))
    e = brentq(
        lambda e: math.hypot(*summed(e, sealed.balance(e, Edges(0.0, 0.1))[0], Edges(0.0, 0.1))[1:]) - 1.02, 0.1, 0.6
    )
    assert amplitude / mean == pytest.approx(e, rel=1e-3)
    with pytest.raises(ValueError, match="straightens"):
        la.film(1.0, 0.0, 1.0, Edges(0.0, 0.3))
    with pytest.raises(ValueError, match="hang-up"):
        la.film(0.9, 0.0, 1.0, Edges(0.0, 0.3))
