"""Closing force, and where it balances the opening force: clearance of the aligned seal, and how loads change it."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..faces.geometry import (
    DZ,
    FORCE,
    GAP_STATE_SIZE,
    MEAN_SPIN,
    SPIN_DIFFERENCE,
)
from ..numerics.piecewise_linear import PiecewiseLinear, initially
from ..quantities import in_words, resolved
from ..scene.film import aligned_gaps, coned
from ..scene.forces import contact_thresholds, load_of
from ..scene.patterns import grooves_of, waves_of
from ..scene.scene import Scene, SceneError
from .imposed_motion import set_conditions
from .intervals import Interval, constant_and_slope, spins

POINTS = 600
STEP = 1e-3  # of a difference, in clearances
ROUNDING = 64 * np.finfo(float).eps  # of forces, of which many terms are the sum
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
    """`F = [p_hi B + p_lo (1 - B)] area + spring` (N); `area` of the face (m^2), `balance_ratio` B, `spring` (N).
    `outer_is_high` says which side is sealed."""

    area: float
    balance_ratio: float
    spring: float | PiecewiseLinear
    outer_is_high: bool

    def at(self, inner: float, outer: float, spring: float) -> float:
        """Closing force (N) at these pressures (Pa) and spring force (N)."""
        high, low = (outer, inner) if self.outer_is_high else (inner, outer)
        return self.area * (self.balance_ratio * high + (1 - self.balance_ratio) * low) + spring

    def over(self, interval: Interval, film) -> tuple[float, float]:
        """Closing force (N) and its slope (N/s) over a segment."""
        quantities = film.inner_pressure, film.outer_pressure, self.spring
        return tuple(map(self.at, *(constant_and_slope(quantity, interval) for quantity in quantities)))


def settle(scene: Scene, opening_force) -> tuple[float, ClosingForce, list[Equilibrium], str]:
    """Design clearance, `closing_law`, all equilibria found and a sentence, from what the scene gives.

    `opening_force(clearance, p_i, p_o)` is that of film and faces.  Raises SceneError if there is no stable
    equilibrium.
    """
    film, (law, said) = coned(scene), closing_law(scene, opening_force)
    inner, outer = initially(film.inner_pressure), initially(film.outer_pressure)
    if film.clearance is not None:
        stiffness = film_stiffness(opening_force, film.clearance, inner, outer, STEP * film.clearance)
        return film.clearance, law, [Equilibrium(film.clearance, stiffness, stiffness > 0)], said

    surfaces = waves_of(scene), scene.contact
    roots = equilibria(film, opening_force, law.at(inner, outer, initially(law.spring)), inner, outer, *surfaces)
    stable = [root for root in roots if root.stable]
    if not stable:
        raise SceneError(*_no_equilibrium(scene, opening_force, law, inner, outer, roots))
    said = f"{len(roots)} equilibrium clearance(s) found, {len(stable)} stable"
    if len(stable) > 1:
        said += "; the run starts at the widest stable one"
    return stable[-1].clearance, law, roots, said


def closing_law(scene: Scene, opening_force) -> tuple[ClosingForce, str]:
    """The closing force of a scene, as given or what holds its clearance, and a sentence; also of one without a stable
    equilibrium.

    Two of clearance, balance ratio and spring force decide the third; the clearance alone means: whatever holds it,
    counted as hydraulic closing; all three (no scenario has them): the closing force is as given, whether or not it
    balances at the clearance.
    """
    film, closing = coned(scene), scene.closing
    inner, outer = initially(film.inner_pressure), initially(film.outer_pressure)
    area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
    high, low = max(inner, outer), min(inner, outer)
    balance, spring = closing.balance_ratio, closing.spring_force

    if film.clearance is None:
        if balance is None or spring is None:
            raise SceneError("film.clearance", "nothing", "a length, or both balance_ratio and spring_force")
        return ClosingForce(area, balance, spring, outer >= inner), "closing force from balance ratio and spring"
    force = must_be_held(opening_force(film.clearance, inner, outer), film.clearance)
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
        spring = force - ClosingForce(area, balance, 0.0, outer >= inner).at(inner, outer, 0.0)
        said = "spring force follows from clearance and balance ratio"
    return ClosingForce(area, balance, spring, outer >= inner), said


def must_be_held(force: float, clearance: float) -> float:
    """The opening force (N) at a clearance (m).  Raises SceneError where the film has no solution."""
    if math.isnan(force):
        found = f"{clearance:.4g} m, at which the film has no solution"
        raise SceneError("film.clearance", found, "a clearance of the size of a film's, and a flow through it")
    return force


def extent(film, waves=(), contact=None) -> tuple[float, float]:
    """Difference (m) between the thickest and the thinnest place of the aligned film, and the clearance (m) below which
    it is closed somewhere, as a diverging one is at its outer edge; waves (Waviness) at their highest at one place,
    where the asperities of a Contact may be pressed flat."""
    gaps, bumps = [h for _, h in aligned_gaps(film, 0.0)], sum(wave.amplitude for wave in waves)
    flat = contact_thresholds(contact)[2] if contact and bumps else 0.0
    return max(gaps) - min(gaps) + 2.0 * bumps, max(0.0, bumps - min(gaps) + flat)


def equilibria(film, opening_force, closing: float, inner: float, outer: float, waves=(), contact=None):
    """Every clearance (Equilibrium) where the aligned film's `opening_force(clearance, inner, outer)` (N) equals
    `closing` (N), increasing; pressures `inner`, `outer` (Pa); `waves` (Waviness) and Contact of the faces that the
    force knows."""
    rise, closed_below = extent(film, waves, contact)
    reference, least = max(rise, 1e-6), closed_below * (1 + 1e-9)
    grid = least + np.geomspace(reference / WIDEST, reference * WIDEST, POINTS)
    excess = np.array([opening_force(c, inner, outer) - closing for c in grid])
    # An excess that never leaves rounding is no root: flat faces carry the same load at any clearance.
    carried = np.abs(excess + closing)
    noise = 1e-11 * float(np.max(carried, initial=abs(closing), where=np.isfinite(carried)))
    roots = []
    for k in range(POINTS - 1):
        if excess[k] * excess[k + 1] < 0 and max(abs(excess[k]), abs(excess[k + 1])) > noise:
            try:
                root = crossing(lambda c: opening_force(c, inner, outer) - closing, grid[k], grid[k + 1])
            except ValueError:
                found = f"one without a solution between clearances of {grid[k]:.3g} and {grid[k + 1]:.3g} m"
                raise SceneError("film", found, "a film that has one at every clearance") from None
            stiffness = film_stiffness(opening_force, root, inner, outer, STEP * root)
            roots.append(Equilibrium(root, stiffness, stiffness > 0))
    return roots


def film_stiffness(opening_force, clearance, inner, outer, step) -> float:
    """Axial film stiffness -dF/dC (N/m) at a `clearance` (m), pressures (Pa): fourth-order central difference of this
    step (m)."""
    f = [opening_force(clearance + k * step, inner, outer) for k in (-2, -1, 1, 2)]
    found = float(-(f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * step))
    return resolved(found, ROUNDING * max(map(abs, f)) / step)


def resolved_matrices(stiffness, damping, force: float, clearance: float, radius: float):
    """Stiffness and damping matrices (3, 3) of a film on (dz, g_x, g_y) without what is left of rounding: of its
    `force` (N) and of moments with an arm `radius` (m), differences in a `clearance` (m); of damping beside its
    diagonal."""
    arms, own = np.array([1.0, radius, radius]), np.sqrt(np.abs(np.diagonal(damping)))
    bounds = ROUNDING * abs(force) / (STEP * clearance) * np.outer(arms, arms), ROUNDING / STEP * np.outer(own, own)
    return tuple(np.where(np.abs(m) <= least, 0.0, m) for m, least in zip((stiffness, damping), bounds, strict=True))


def crossing(excess, low: float, high: float) -> float:
    """The clearance, or its change (m), between `low` and `high` at which an `excess` of opening force (N) is zero.
    Raises ValueError if it has one sign."""
    # Loaded only where there is something to search: a given clearance needs none of it.
    from scipy.optimize import brentq

    return float(brentq(excess, low, high, xtol=1e-18, rtol=1e-14))


def support_stiffness(scene: Scene) -> float:
    """Axial stiffness (N/m) of the supports against a change of the gap: both carry the same force, so in series."""
    stiffness = [ring.support.axial_stiffness for ring in (scene.stator, scene.rotor) if ring.support]
    return 1 / sum(1 / k for k in stiffness) if all(stiffness) else 0.0


def outside_force(model, interval: Interval) -> float:
    """Force (N) by which what pulls at floating rings from outside at an interval's start opens the gap, on the springs
    of their supports in series: `sum of +-F K/K_ring`, K that of both; 0 on a film of constant coefficients, about
    which the pull is one of the harmonics."""
    if model.interface.film.constant:
        return 0.0
    rings = {1.0: model.scene.stator, -1.0: model.scene.rotor}
    forces = {sign: constant_and_slope(load.force, interval)[0] for sign, r in rings.items() if (load := load_of(r))}
    soft = [1.0 / max(r.support.axial_stiffness, 1e-12) for r in rings.values() if r.support]
    return sum(sign * f / max(rings[sign].support.axial_stiffness, 1e-12) for sign, f in forces.items()) / sum(soft)


def pulled_apart(model, interval: Interval) -> np.ndarray:
    """Axial displacement (m) of each floating ring where `outside_force` at an interval's start lets them rest; zeros
    without one."""
    pull, scene = outside_force(model, interval), model.scene
    signs = [sign for sign, ring in ((1.0, scene.stator), (-1.0, scene.rotor)) if ring.support]
    if not pull:
        return np.zeros(len(signs))
    shift = model.axial_shift(interval)
    if len(signs) == 1:
        return np.array([signs[0] * shift])
    stiffness = scene.rotor.support.axial_stiffness
    excess = support_stiffness(scene) * shift - pull
    force = constant_and_slope(scene.rotor.load.force, interval)[0] if scene.rotor.load else 0.0
    rotor = (force - excess) / stiffness if stiffness else 0.0
    return np.array([rotor + shift, rotor])


def axial_excess(model, s, closing: float):
    """Opening force (N) of film and asperities in excess of a closing force (N) and of the supports, as a function of
    the change (m) of the axial gap; tilts, rates and pressures are those of the gap state `s`, which it fills."""
    support = support_stiffness(model.scene)

    def excess(shift):
        s[DZ] = shift
        model.interface.wrench(model.f, s)
        return s[FORCE] - closing - support * shift

    return excess


def axial_shift(model, interval: Interval, speed: float | None = None) -> tuple[float, bool]:
    """How far (m) the loads at an interval's start, or at another shaft speed (rad/s), move the aligned gap from its
    design clearance: opening force = closing force + support springs.  (0, False) if none is found from 0.1 % to 50
    times the clearance."""
    film, s = model.scene.film, np.zeros(GAP_STATE_SIZE)
    set_conditions(s, model.scene, lambda quantity: constant_and_slope(quantity, interval)[0], speed)
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = spins(model.scene, interval)
    if speed is not None:
        w_s = s[MEAN_SPIN] - 0.5 * s[SPIN_DIFFERENCE]
        s[MEAN_SPIN], s[SPIN_DIFFERENCE] = 0.5 * (speed + w_s), speed - w_s
    closing = model.closing.over(interval, film)[0] - outside_force(model, interval)
    excess = axial_excess(model, s, closing)

    @cache
    def value(shift):
        try:
            return excess(shift)
        except SceneError:
            # No film there: wavy faces that meet, say, or grooves too fast for so thin a film.
            return math.nan

    if abs(value(0.0)) < 1e-9 * max(abs(closing), 1e-30):
        return 0.0, True
    grid = model.clearance * np.concatenate([np.geomspace(1e-3, 1.0, 60) - 1.0, np.geomspace(1e-3, 50, 80)])

    # The stable root nearest to the design clearance: the excess falls through zero.
    for k in sorted(range(len(grid) - 1), key=lambda k: abs(grid[k])):
        if value(grid[k]) > 0 >= value(grid[k + 1]):
            return crossing(excess, grid[k], grid[k + 1]), True
    return 0.0, False


def _no_equilibrium(scene, opening_force, law, inner, outer, roots):
    film, asperities, grooves = coned(scene), scene.contact is not None, grooves_of(scene)[1]
    closing = law.at(inner, outer, initially(law.spring))
    reference = max(extent(film)[0], 1e-6)
    closed, wide = (opening_force(c, inner, outer) for c in (reference / 100, reference * 100))
    # Over grooves no film is found that is too thin.
    thinner = (opening_force(reference * 2.0**k, inner, outer) for k in range(-6, 7))
    tight = closed if math.isfinite(closed) else next(filter(math.isfinite, thinner), math.nan)
    rounding = 1e-9 * abs(wide)
    if tight - wide > rounding:
        expected = f"between {wide:.4g} N, which this film carries wide open, and {tight:.4g} N, nearly closed"
        if closing > tight and not asperities and not grooves:
            expected += "; beyond that a seal rides on its asperities, which a table [contact] counts"
    elif grooves and math.isnan(tight):
        expected = "a film over the grooves at some clearance: none is found, or a liquid would tear at all of them"
    elif grooves:
        expected = "a film that carries more as it thins: grooves pump the other way with the other sign of their angle"
    elif inner == outer:
        expected = "a difference of the pressures, of which this film would carry more as it closes"
    else:
        side, narrows = ("outer", "above") if outer >= inner else ("inner", "below")
        this = "this one widens" if wide - tight > rounding else "this one carries the same at every clearance"
        where = f"the pressure is higher at the {side} radius"
        expected = f"a film that narrows along its flow, as film.coning {narrows} 0 makes it ({where}); {this}"
    found = f"no equilibrium clearance (closing force {closing:.6g} N)"
    if roots:
        found = f"only unstable equilibria (at {', '.join(in_words('h_min', r.clearance, 3) for r in roots)})"
    return "closing.balance_ratio", found, expected
