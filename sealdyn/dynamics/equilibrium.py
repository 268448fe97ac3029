"""Closing force and equilibrium clearance of the aligned seal."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.film import aligned_gaps
from ..scene.scene import Scene, SceneError
from .intervals import Interval, constant_and_slope

POINTS = 600
WIDEST = 1e3  # the search runs from the reference clearance over and under this factor


@dataclass(frozen=True)
class Equilibrium:
    """A clearance (m) where opening and closing force balance, the axial film stiffness there (N/m,
    positive: restoring) and whether the film alone holds it."""

    clearance: float
    stiffness: float
    stable: bool


@dataclass(frozen=True)
class ClosingForce:
    """`F = [p_hi B + p_lo (1 - B)] area + spring`.  `outer_is_high` says which side is sealed."""

    area: float
    balance_ratio: float
    spring: float | PiecewiseLinear
    outer_is_high: bool

    def at(self, inner: float, outer: float, spring: float) -> float:
        """Closing force (N) at these pressures (Pa) and spring force (N)."""
        high, low = (outer, inner) if self.outer_is_high else (inner, outer)
        return self.area * (self.balance_ratio * high + (1 - self.balance_ratio) * low) + spring

    def over(self, leg: Interval, film) -> tuple[float, float]:
        """Closing force (N) and its slope (N/s) over a segment."""
        inner, outer = (
            constant_and_slope(film.inner_pressure, leg),
            constant_and_slope(film.outer_pressure, leg),
        )
        spring = constant_and_slope(self.spring, leg)
        return tuple(self.at(inner[k], outer[k], spring[k]) for k in range(2))


def initially(quantity) -> float:
    """Value of a number or table at time zero."""
    return quantity.at(0.0) if isinstance(quantity, PiecewiseLinear) else float(quantity)


def settle(scene: Scene, opening_force) -> tuple[float, ClosingForce, list[Equilibrium], str]:
    """Design clearance, closing force, all equilibria found and a sentence, from what the scene gives.

    `opening_force(clearance, p_i, p_o)` is that of film and faces.  Two of clearance, balance ratio and spring
    force decide the third; the clearance alone means: whatever holds it, counted as hydraulic closing; all three
    (no scenario has them): the closing force is as given, whether or not it balances at the clearance.
    Raises SceneError if there is no stable equilibrium.
    """
    film, closing = scene.film, scene.closing
    inner, outer = initially(film.inner_pressure), initially(film.outer_pressure)
    area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
    outer_is_high = outer >= inner
    high, low = max(inner, outer), min(inner, outer)
    balance, spring = closing.balance_ratio, closing.spring_force

    if film.clearance is not None:
        force = opening_force(film.clearance, inner, outer)
        if balance is None and spring is None:
            balance = (force / area - low) / (high - low) if high > low else 1.0
            spring = 0.0 if high > low else force - area * low
            said = "closing force is what holds the given clearance"
        elif balance is None:
            if high == low:
                raise SceneError("closing.spring_force", "equal pressures", "balance_ratio, or a pressure difference")
            balance = ((force - initially(spring)) / area - low) / (high - low)
            said = "balance ratio follows from clearance and spring force"
        elif spring is not None:
            said = "closing force as given: the clearance is where displacements are counted from"
        else:
            spring = force - ClosingForce(area, balance, 0.0, outer_is_high).at(inner, outer, 0.0)
            said = "spring force follows from clearance and balance ratio"
        law = ClosingForce(area, balance, spring, outer_is_high)
        stiffness = _stiffness(opening_force, film.clearance, inner, outer)
        here = Equilibrium(film.clearance, stiffness, stiffness > 0)
        return film.clearance, law, [here], said

    law = ClosingForce(area, balance, spring, outer_is_high)
    roots = equilibria(film, opening_force, law.at(inner, outer, initially(spring)), inner, outer)
    stable = [root for root in roots if root.stable]
    if not stable:
        raise SceneError(*_no_equilibrium(film, opening_force, law, inner, outer, roots))
    said = f"{len(roots)} equilibrium clearance(s) found, {len(stable)} stable"
    if len(stable) > 1:
        said += "; the run starts at the widest stable one"
    return stable[-1].clearance, law, roots, said


def rise(film) -> float:
    """Difference (m) between the thickest and the thinnest place of the aligned film."""
    gaps = [h for _, h in aligned_gaps(film, 0.0)]
    return max(gaps) - min(gaps)


def closed_below(film) -> float:
    """Clearance (m) below which the aligned film is closed somewhere, as a diverging one is at its outer edge."""
    return max(0.0, -min(h for _, h in aligned_gaps(film, 0.0)))


def equilibria(film, opening_force, closing: float, inner: float, outer: float) -> list[Equilibrium]:
    """Every clearance where the aligned film's opening force equals `closing` (N), increasing."""
    reference, least = max(rise(film), 1e-6), closed_below(film) * (1 + 1e-9)
    grid = least + np.geomspace(reference / WIDEST, reference * WIDEST, POINTS)
    excess = np.array([opening_force(c, inner, outer) - closing for c in grid])
    # An excess that never leaves rounding is no root: flat faces carry the same load at any clearance.
    noise = 1e-11 * max(abs(closing), float(np.max(np.abs(excess + closing))))
    roots = []
    for k in range(POINTS - 1):
        if excess[k] * excess[k + 1] < 0 and max(abs(excess[k]), abs(excess[k + 1])) > noise:
            root = brentq(
                lambda c: opening_force(c, inner, outer) - closing,
                grid[k],
                grid[k + 1],
                xtol=1e-18,
                rtol=1e-14,
            )
            stiffness = _stiffness(opening_force, root, inner, outer)
            roots.append(Equilibrium(float(root), stiffness, stiffness > 0))
    return roots


def _stiffness(opening_force, clearance, inner, outer) -> float:
    """Axial film stiffness -dF/dC (N/m), fourth-order central difference."""
    step = 1e-3 * clearance
    f = [opening_force(clearance + k * step, inner, outer) for k in (-2, -1, 1, 2)]
    return float(-(f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * step))


def _no_equilibrium(film, opening_force, law, inner, outer, roots):
    closing = law.at(inner, outer, initially(law.spring))
    reference = max(rise(film), 1e-6)
    tight, wide = (opening_force(c, inner, outer) for c in (reference / 100, reference * 100))
    expected = f"a closing force between {min(tight, wide):.4g} and {max(tight, wide):.4g} N on a converging film"
    found = f"no equilibrium clearance (closing force {closing:.6g} N)"
    if roots:
        found = f"only unstable equilibria (at {', '.join(f'{r.clearance * 1e6:.3g} um' for r in roots)})"
    return "closing.balance_ratio", found, expected
