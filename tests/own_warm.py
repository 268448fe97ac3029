"""A warm seal whole: both rings by finite elements, tied over the band, and a film by radius between them; nothing of
the package is used.

The film is aligned, Reynolds' over the radius, with the liquid of the local temperature, which is that of both faces;
friction, asperities and the pressure's flow heat it where they work, and the leakage carries heat along.  The gap is
the cold cone and the displacement of both faces.  `warm` is for seals with the pressure outside.
"""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from own_ring import Ring
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq, root

POINTS = 1201


@dataclass(frozen=True)
class Seal:
    """`rings` as own_ring.py takes them, with one band; SI units, temperatures in K.

    `pressure` outside above inside (Pa), `viscosity(T)` and `heat(T)`, the heat of a volume (J/(m^3 K)); asperities by
    their half height `touch` (m), `strength` (Pa) and `friction`.
    """

    rings: tuple[Any, Any]
    coning: float
    pressure: float
    speed: float
    balance_ratio: float
    spring_force: float
    temperature: float
    viscosity: Any
    heat: Any
    touch: float = 0.0
    strength: float = 0.0
    friction: float = 0.0


def asperity_share(x):
    """Of the area in contact at mean film x half heights, Christensen's heights."""
    x = np.clip(x, -1.0, 1.0)
    return 0.5 - 35 / 32 * (x - x**3 + 3 * x**5 / 5 - x**7 / 7)


def film(seal, r, gap, rise):
    """Force above the outside of the low pressure (N), its part of asperities, leakage (m^3/s), and heat (W/m^2) by
    friction, asperities and pressure, along the radii r (m) with film `gap` (m) and `rise` (K)."""
    viscosity = seal.viscosity(seal.temperature + rise)
    resist = cumulative_trapezoid(viscosity / (r * gap**3), r, initial=0.0)
    leakage, share = np.pi / 6 * abs(seal.pressure) / resist[-1], resist / resist[-1]
    share = share if seal.pressure > 0 else 1 - share
    touching = asperity_share(gap / seal.touch) * seal.strength if seal.touch else 0 * r
    force = np.trapezoid((abs(seal.pressure) * share + touching) * 2 * np.pi * r, r)
    viscous, rubbed = viscosity * (seal.speed * r) ** 2 / gap, seal.friction * touching * seal.speed * r
    pressed = 12 * viscosity / gap**3 * (leakage / (2 * np.pi * r)) ** 2
    return force, np.trapezoid(touching * 2 * np.pi * r, r), leakage, (viscous, rubbed, pressed)


def closing_force(seal):
    """Above the outside of the low pressure, N."""
    inner, outer = seal.rings[0].face_inner_radius, seal.rings[0].face_outer_radius
    return seal.balance_ratio * abs(seal.pressure) * np.pi * (outer**2 - inner**2) + seal.spring_force


def clearance_of(seal, r, shape, rise):
    """Film (m) at the inner radius that carries the closing force, beside the `shape` (m) of the gap."""
    force = closing_force(seal)
    least = max(0.0, -np.min(shape)) + 1e-9
    return brentq(lambda c: film(seal, r, c + shape, rise)[0] - force, least, 1e-4, xtol=1e-16)


def warm(seal, damping=0.3, finest=40):
    """The warm state: `rise` (K, mean over the band), `hottest` (K), `coning` (rad), `clearance` (m, at the inner
    radius), `power` (W), `leakage` (m^3/s), `contact` (N), and `carried` by the leakage (W) and `taken` by each ring
    (W).  The smallest element is a `finest` part of a ring's width."""
    first = min(ring.outer_radius - ring.inner_radius for ring in seal.rings) / finest
    answers = [Ring(ring, first).answers() for ring in seal.rings]
    nodes = answers[0][2]
    assert np.allclose(answers[1][2], nodes, rtol=1e-9, atol=0.0)
    r = np.linspace(nodes[0], nodes[-1], POINTS)
    at = shapes(nodes, r)
    along = np.full(POINTS, r[1] - r[0])
    along[[0, -1]] /= 2
    weights = 2 * np.pi * r * along
    conducted = [np.linalg.inv(rises) for rises, _, _ in answers]
    tied = np.linalg.inv(sum(conducted))
    opens = sum(moved @ inverse for (_, moved, _), inverse in zip(answers, conducted, strict=True))

    def gap_less_clearance(rise):
        height = at @ (opens @ rise)
        return seal.coning * (r - r[0]) + height - height[0]

    rise = np.zeros(len(nodes))
    for _ in range(400):
        shape, warmed = gap_less_clearance(rise), at @ rise
        clearance = clearance_of(seal, r, shape, warmed)
        _, contact, leakage, heats = film(seal, r, clearance + shape, warmed)
        # The leakage enters cold at the outer edge and takes up heat on its way.
        carried = seal.heat(seal.temperature + np.mean(warmed)) * leakage
        load = at.T @ (weights * sum(heats) + carried * np.gradient(warmed, r) * along)
        load[-1] -= carried * rise[-1]
        change = tied @ load - rise
        rise = rise + damping * change
        if np.max(np.abs(change)) < 1e-9 * max(np.max(np.abs(rise)), 1e-3):
            break
    else:
        raise ArithmeticError("the warm state was not found")
    gap, even = clearance + shape, np.polyfit(r, clearance + shape, 1)
    return SimpleNamespace(
        rise=np.sum(weights * warmed) / np.sum(weights), hottest=np.max(rise), coning=even[0], clearance=gap[0],
        power=sum(np.sum(weights * heat) for heat in heats), leakage=leakage, contact=contact,
        carried=carried * rise[0], taken=[np.sum(inverse @ rise) for inverse in conducted],
    )  # fmt: skip


def one_temperature(seal, resistances, conings):
    """The same seal by two numbers a ring, K/W and rad/W: film and faces of one temperature, the smallest rise (K) at
    which heat and cooling are in balance; None without one."""
    conduct, turn = sum(1 / x for x in resistances), sum(x / y for x, y in zip(conings, resistances, strict=True))

    def state(rise):
        found = at_coning(seal, rise, seal.coning + turn * rise)
        found.over = found.power - (conduct + seal.heat(seal.temperature + rise) * found.leakage) * rise
        return found

    below = 1e-3
    for rise in np.linspace(0.5, 80.0, 60):
        # The film closes: no more of it.
        if seal.pressure * (seal.coning + turn * rise) <= 0.0:
            return None
        if state(rise).over < 0.0:
            return state(brentq(lambda rise: state(rise).over, below, rise, xtol=1e-9))
        below = rise
    return None


def at_coning(seal, rise, coning):
    """The film at one temperature and a plain cone: `power` (W), `leakage`, `clearance`, `contact`."""
    r = np.linspace(seal.rings[0].face_inner_radius, seal.rings[0].face_outer_radius, POINTS)
    shape, warmed = coning * (r - r[0]), np.full(POINTS, rise)
    clearance = clearance_of(seal, r, shape, warmed)
    _, contact, leakage, heats = film(seal, r, clearance + shape, warmed)
    power = sum(np.trapezoid(heat * 2 * np.pi * r, r) for heat in heats)
    return SimpleNamespace(
        rise=rise, coning=coning, clearance=clearance, power=power, leakage=leakage, contact=contact
    )  # fmt: skip


def squeezed(seal, r, gap, rise):
    """Damping of the film along the radii r (m) with film `gap` (m), at one `rise` (K): of a rate of all of the gap
    (N s/m), and of its cone (N s/rad)."""
    resist, found = 12 * seal.viscosity(seal.temperature + rise) / (r * gap**3), []
    for displaced in (r**2 / 2, r**3 / 3 - r[0] * r**2 / 2):
        beside = np.trapezoid(resist * displaced, r) / np.trapezoid(resist, r)
        found.append(np.pi * np.trapezoid(r**2 * resist * (displaced - beside), r))
    return found


def slow_course(seal, state, grids, along, step, moved):
    """Rise (K) beside that of a warm `state` over time steps (s) `along`, from a clearance that is `moved`-fold: both
    rings by all cells of their `grids` (faces/ring_heat.py's conduction), the film squeezed; by the midpoint rule."""
    r = np.linspace(seal.rings[0].face_inner_radius, seal.rings[0].face_outer_radius, POINTS)
    force, per_step, r_in = closing_force(seal), 2 / step, r - r[0]
    enter = [grid.answer(grid.flux, per_step) for grid in grids]
    settled = [grid.answer(grid.flux) for grid in grids]
    through = [state.rise / (grid.flux @ T + grid.immediate_resistance) for grid, T in zip(grids, settled, strict=True)]
    cells = [q * T for q, T in zip(through, settled, strict=True)]
    damping, by_cone = squeezed(seal, r, state.clearance + state.coning * r_in, state.rise)
    gap, cone, guess, found = state.clearance * moved, state.coning, np.ones(2), []
    for _ in range(along):
        own = [grid.answer(per_step * grid.capacity * T, per_step) for grid, T in zip(grids, cells, strict=True)]
        taken = []
        for grid, T, t in zip(grids, own, enter, strict=True):
            taken.append((grid.flux @ T, grid.flux @ t + grid.immediate_resistance,
                          grid.coning @ T, grid.coning @ t + grid.immediate_coning))  # fmt: skip

        def coned(rise, taken=taken):
            heats = [(rise - a) / b for a, b, _, _ in taken]
            return heats, seal.coning + sum(c + d * q for (_, _, c, d), q in zip(taken, heats, strict=True))

        def lacking(at, coned=coned, gap=gap, cone=cone):
            clearance, rise = at[0] * state.clearance, at[1] * state.rise
            heats, coning = coned(rise)
            opening, _, leakage, made = film(seal, r, clearance + coning * r_in, np.full(POINTS, rise))
            power = sum(np.trapezoid(heat * 2 * np.pi * r, r) for heat in made)
            power -= seal.heat(seal.temperature + rise) * leakage * rise
            moved = clearance - gap - ((opening - force) / per_step - by_cone * (coning - cone)) / damping
            return moved / state.clearance, (power - sum(heats)) / state.power

        guess = root(lacking, guess, tol=1e-12).x
        heats, coning = coned(guess[1] * state.rise)
        cells = [2 * (T + q * t) - before for T, q, t, before in zip(own, heats, enter, cells, strict=True)]
        gap, cone = 2 * guess[0] * state.clearance - gap, 2 * coning - cone
        found.append((guess[1] - 1) * state.rise)
    return np.array(found)


def of_oscillation(values, step):
    """Exponent (1/s, complex) of an oscillation by its values (n,) every `step` (s)."""
    (a, b), *_ = np.linalg.lstsq(np.stack([values[1:-1], values[:-2]], axis=1), values[2:], rcond=None)
    return np.log(np.roots([1, -a, -b]).astype(complex))[0] / step


def slow_root(seal, state, rings, guess):
    """The root s (1/s, complex) of 1 = H_coning X(s) + H_T Z(s) beside a warm `state`: how a small change of it grows.

    Each of the `rings` answers heat by states: time_constants (s), resistances (K/W), conings (rad/W) and what follows
    at once, immediate_resistance and immediate_coning; their faces have one temperature.
    """
    more = [at_coning(seal, state.rise, state.coning * x).power for x in (1 - 1e-4, 1 + 1e-4)]
    warmer = [at_coning(seal, state.rise + x, state.coning).power for x in (-0.01, 0.01)]
    by_coning, by_rise = np.diff(more)[0] / (2e-4 * state.coning), np.diff(warmer)[0] / 0.02
    by_rise -= seal.heat(seal.temperature + state.rise) * state.leakage

    def lacking(at):
        s = complex(*at)
        rises = [x.immediate_resistance + np.sum(x.resistances / (1 + s * x.time_constants)) for x in rings]
        turns = [x.immediate_coning + np.sum(x.conings / (1 + s * x.time_constants)) for x in rings]
        tied = 1 / sum(1 / x for x in rises)
        left = 1 - tied * (by_coning * sum(x / y for x, y in zip(turns, rises, strict=True)) + by_rise)
        return left.real, left.imag

    found = root(lacking, (guess.real, guess.imag), tol=1e-10)
    assert found.success
    return complex(*found.x)


def shapes(nodes, r):
    """Quadratic interpolation (radii, nodes) from nodes (ends and middles of elements) to radii."""
    found, ends = np.zeros((len(r), len(nodes))), nodes[::2]
    piece = np.clip(np.searchsorted(ends, r, side="right") - 1, 0, len(ends) - 2)
    s = (r - ends[piece]) / (ends[piece + 1] - ends[piece])
    rows = np.arange(len(r))
    for k, value in enumerate([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)]):
        found[rows, 2 * piece + k] += value
    return found
