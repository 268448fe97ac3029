"""Warm states: the temperature at which the heat that film and asperities make leaves through rings and leakage.

Film and both faces have one temperature T = T_sealed + rise.  Each ring is a linear body: R (K/W), rise of its face
over the heat that enters it, X (rad/W), its coning over that heat.  With G = sum 1/R, B = sum X/R and the leakage Q

    H = torque x relative speed + Q |p_o - p_i| = (G + density specific_heat Q) rise
    coning = cold coning + B rise,   viscosity at T,   clearance: film + asperities = closing force

and in time, the film squeezed with the dampings D, D_c of clearance and coning,

    C rise' = H - (G + density specific_heat Q) rise,  C = sum time_constant/R
    D clearance' + D_c coning' = opening - closing force

or, of rings from their drawings, with the states of heated_rings.py: quick and late coning may oppose each other, and a
seal that is pressurised inside then hunts before heat loses its balance.

**Source** derived; the field is Lebeck, *Principles and Design of Mechanical Face Seals* (1991), and Brunetiere,
Tournerie & Frene (2003).
**Valid** liquids; walls and film of one temperature, as a film of a micrometre has it (b mu U^2/k below 1), and where
the leakage carries less than a third of the heat.
"""

import math
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from ..faces.geometry import (
    CONING_RATE,
    CONTACT_FORCE,
    CONTACT_TORQUE,
    DZ_RATE,
    FLOW_INNER,
    FORCE,
    SPIN_DIFFERENCE,
    TORQUE,
)
from ..films import film_of
from ..numerics.piecewise_linear import initially, shifted
from ..scene.film import coned
from ..scene.fluid import in_numbers, liquid_of
from ..scene.patterns import grooves_of, waves_of
from ..scene.scene import Closing, SceneError
from ..status import Status
from .equilibrium import closing_law, crossing, equilibria, must_be_held
from .heated_rings import ThermalStates, heated_body
from .imposed_motion import rest_state
from .interface import Asked, Interface, lender, loads_at_rest, opening_law, prepared

# Rises that are looked at between the first, as a share of the last, and the end of the liquid's table.
SCANNED, FIRST = 60, 1e-4
# Relative step of differences; relative error of the film's integrals.
STEP, FINE = 1e-4, 1e-10
# Rise, as a share of the last, below which there is none.
TINY = 1e-9
# Halvings towards the rise at which a film holds no more.
HALVINGS = 30
# From rise to rise in looking for the balance of a speed nearby: first, and at most: near a fold two states are close.
WIDER, WIDEST = 1.05, 1.2
# Secants at most, how far one goes as a share, the last of them, and the least slope of the surplus, none at a fold.
SECANTS, NEARBY, SETTLED, DOUBTFUL = 8, 0.5, 1e-7, 0.05
# From clearance to clearance in following one, and how far it is followed from rise to rise.
STRIDE, REACH = 1.03, 60


@dataclass(frozen=True)
class WarmState:
    """A state in which heat balances: `rise` (K) of the faces over the sealed liquid, `clearance` (m) and `coning`
    (rad) then, `viscosity` (Pa s), heat made `power` (W), of it the asperities' `contact_power` and what the leakage
    spends `flow_power`, `carried` (W/K) by the leakage, `loop_gain` dH/d(rise) over (G + carried), `slow` the least
    damped eigenvalue of film and rings (1/s, complex; None without time constants), and whether it is `stable`;
    `torque` (N m) of film and asperities, `excess` (N) of the opening force over the closing force, which is 0 at its
    clearance; `coned_by`: coning by heat (rad)."""

    rise: float
    clearance: float
    coning: float
    viscosity: float
    power: float
    contact_power: float
    flow_power: float
    leakage: float
    carried: float
    torque: float
    excess: float
    coned_by: float
    loop_gain: float = math.nan
    slow: complex | None = None
    stable: bool = True

    @property
    def period(self) -> float | None:
        """Of the oscillation (s) that grows from the state: it hunts; None if it is stable or leaves it otherwise."""
        hunts = self.slow is not None and not self.stable and self.slow.imag
        return 2.0 * math.pi / self.slow.imag if hunts else None


class Warming:
    """A scene with `[film.heat]` at the conditions of its start: `rings` (HeatedBody by name), what it is at any rise,
    and its warm states.  Raises SceneError where no closing force is known."""

    def __init__(self, scene, cooling: float = 1.0):
        cold, self.cooling = unheated(scene), cooling
        self.film = film_of(cold)
        self.law, self.said = closing_law(cold, self._opening_law(cold))
        # Cells that are looked for are those of the unheated seal.
        self.cells = prepared(cold, self.film).reynolds
        self._cool(scene)
        self._begin(scene)

    def _cool(self, scene):
        self.rings = {name: heated_body(scene, name, self.cooling) for name in scene.film.heat.rings}
        self.conductance = sum(1.0 / ring.resistance for ring in self.rings.values())
        self.coning_per_kelvin = sum(ring.coning_per_watt / ring.resistance for ring in self.rings.values())
        known = all(ring.time_constant is not None for ring in self.rings.values())
        stored = sum((ring.time_constant or 0.0) / ring.resistance for ring in self.rings.values())
        self.capacity = stored if known and stored > 0.0 else None

    def at_speed(self, speed: float) -> "Warming":
        """The same closing force law at a shaft speed (rad/s) that stays: rings are cooled as it moves the liquid."""
        scene = replace(self.scene, shaft=replace(self.scene.shaft, speed=speed))
        other = self.under(scene)
        other._cool(scene)
        return other

    def under(self, scene) -> "Warming":
        """The same rings and closing force law at the conditions of another scene: speed, pressures, temperature."""
        other = copy(self)
        for found in ("cold_state", "scanned", "states", "_coolest"):
            vars(other).pop(found, None)
        other._begin(scene)
        return other

    def _begin(self, scene):
        self.scene = scene
        film, liquid = scene.film, liquid_of(scene.film)
        self.plain = replace(film, heat=None, reynolds=self.cells)
        self.pressures = initially(film.inner_pressure), initially(film.outer_pressure)
        given = scene.closing.spring_force
        self.spring = self.law.spring if given is None else given
        self.closing = self.law.at(*self.pressures, initially(self.spring))
        self.sealed = initially(film.temperature)
        self.highest = liquid.highest - self.sealed

    def at(self, rise: float, clearance: float | None = None, coned_by: float | None = None):
        """The scene, without heat, with faces and liquid `rise` (K) above the sealed one, and a clearance (m) if given;
        its closing force is the same.  `coned_by`: coning by heat (rad), where it is not that of the steady rings."""
        change = self.coning_per_kelvin * rise if coned_by is None else coned_by
        film = in_numbers(self.plain, rise, coning=shifted(self.plain.coning, change), clearance=clearance)
        closing = Closing(self.law.balance_ratio, self.spring) if clearance is not None else Closing()
        return replace(self.scene, film=film, closing=closing)

    def _opening_law(self, scene):
        # Over grooves it is nearer than the film of a run.
        return opening_law(scene, None if grooves_of(scene)[1] else self.film)

    def excess(self, rise: float):
        """Function of the clearance (m): opening force in excess of the closing force (N) at a rise (K)."""
        force = self._opening_law(self.at(rise))
        return lambda clearance: force(clearance, *self.pressures) - self.closing

    def clearance(self, rise: float, near: float | None = None) -> float | None:
        """The clearance (m) that the film holds at a rise (K): that which continues a clearance `near`, or the widest
        stable one; None if it holds none."""
        excess = self.excess(rise)
        if near is not None:
            below = above = near
            for _ in range(REACH):
                if (e := excess(below)) > 0.0 >= excess(above):
                    return crossing(excess, below, above)
                below, above = (below, above * STRIDE) if e > 0.0 else (below / STRIDE, above)
        scene = self.at(rise)
        try:
            roots = equilibria(
                coned(scene), self._opening_law(scene), self.closing, *self.pressures, waves_of(scene), scene.contact
            )
        except SceneError:
            return None
        return next((root.clearance for root in reversed(roots) if root.stable), None)

    def state(self, rise: float, clearance: float, coned_by: float | None = None) -> WarmState:
        """Heat made and carried at a rise (K) and a clearance (m), whether or not they balance; `coned_by` as in
        `at`."""
        scene = self.at(rise, clearance, coned_by)
        film, s = scene.film, loads_at_rest(scene, lender(scene, self.film), clearance, FINE)
        opening = must_be_held(float(s[FORCE] + s[CONTACT_FORCE]), clearance)
        leakage = s[FLOW_INNER] * math.copysign(1.0, self.pressures[0] - self.pressures[1])
        speed = self.scene.film.heat.friction * s[SPIN_DIFFERENCE]
        rubbed, sheared = (float(abs(s[k] * speed)) for k in (CONTACT_TORQUE, TORQUE))
        spent = float(abs(leakage * (self.pressures[1] - self.pressures[0])))
        return WarmState(
            rise, clearance, initially(coned(scene).coning), initially(film.viscosity), sheared + rubbed + spent,
            rubbed, spent, float(leakage), film.density * film.specific_heat * abs(float(leakage)),
            float(abs(s[TORQUE] + s[CONTACT_TORQUE])), opening - self.closing,
            self.coning_per_kelvin * rise if coned_by is None else coned_by,
        )  # fmt: skip

    def damping(self, rise: float, clearance: float, coned_by: float | None = None) -> np.ndarray:
        """Damping of the film, of rates of the clearance (N s/m) and of the coning (N s/rad), at a rise (K) and a
        clearance (m); `coned_by` as in `at`."""
        scene = self.at(rise, clearance, coned_by)
        interface, wide = Interface(scene, FINE, self.film), scene.film.outer_radius - scene.film.inner_radius

        def force(place, rate):
            s, _ = rest_state(scene, clearance)
            s[place] = rate
            interface.film_wrench(interface.f, s)
            return s[FORCE]

        rates = (DZ_RATE, clearance), (CONING_RATE, clearance / wide)
        return np.array([(force(place, -rate) - force(place, rate)) / (2.0 * rate) for place, rate in rates])

    def surplus(self, state: WarmState) -> float:
        """Heat (W) that is made and not carried away in a state."""
        return state.power - (self.conductance + state.carried) * state.rise

    @cached_property
    def cold_state(self) -> WarmState | None:
        """The state of unheated faces, None if they hold no film."""
        return self._following(0.0)

    @cached_property
    def scanned(self) -> list[WarmState]:
        """States along the rise, each at the clearance that its film holds, up to where it holds none."""
        found, rises = [], self.highest * np.concatenate([[0.0], np.geomspace(FIRST, 1.0, SCANNED)])
        for rise in map(float, rises):
            state = self._following(rise, found[-1].clearance if found else None)
            if state is not None:
                found.append(state)
            elif found:
                return found + self._closing_film(found[-1], rise)
        return found

    def _closing_film(self, last: WarmState, beyond: float) -> list[WarmState]:
        """States ever nearer to the rise (K) at which the film holds no more, between the `last` of those that are and
        one `beyond`: heat grows without bound there."""
        found = [last]
        for _ in range(HALVINGS):
            middle = 0.5 * (found[-1].rise + beyond)
            state = self._following(middle, found[-1].clearance)
            if state is None:
                beyond = middle
            else:
                found.append(state)
        return found[1:]

    @cached_property
    def states(self) -> list[WarmState]:
        """Every warm state, the coolest first."""
        scanned, found = self.scanned, []
        surplus = [self.surplus(state) for state in scanned]
        sizes = np.abs(surplus)
        for k in range(len(scanned) - 1):
            low, high = scanned[k], scanned[k + 1]
            if surplus[k] * surplus[k + 1] <= 0.0 and surplus[k] != surplus[k + 1]:
                found.append(self._balanced(low, high))
            elif k > 0 and sizes[k - 1] > sizes[k] < sizes[k + 1] and surplus[k - 1] * surplus[k] > 0.0:
                # Of one sign and least here: nearby it may have the other.
                found += self._dip(scanned[k - 1], low, high)
        return [self._judged(state) for state in found]

    def _dip(self, before, here, after) -> list[WarmState]:
        """The two states between which the surplus has the other sign, if it has it anywhere near its least size."""
        from scipy.optimize import minimize_scalar

        sign = math.copysign(1.0, self.surplus(here))
        least = minimize_scalar(
            lambda rise: sign * self._surplus_at(rise, here.clearance), bounds=(before.rise, after.rise),
            method="bounded", options={"xatol": 1e-6 * after.rise},
        )  # fmt: skip
        if not least.fun < 0.0:
            return []
        middle = self._following(float(least.x), here.clearance)
        return [self._balanced(before, middle), self._balanced(middle, after)]

    def _following(self, rise, near=None):
        """The state at a rise (K) and the clearance that continues one `near` (m); None where no film holds."""
        clearance = self.clearance(rise, near)
        return None if clearance is None else self.state(rise, clearance)

    def _surplus_at(self, rise, near) -> float:
        state = self._following(rise, near)
        return math.nan if state is None else self.surplus(state)

    def _balanced(self, low, high) -> WarmState:
        """The state between two of opposite surplus."""
        rise = crossing(lambda rise: self._surplus_at(rise, low.clearance), low.rise, high.rise)
        return self._following(rise, low.clearance)

    def _judged(self, state: WarmState) -> WarmState:
        """A state of balance with its loop gain, slow eigenvalue and stability."""
        steps = STEP * max(state.rise, 1e-3) * np.array([-2.0, -1.0, 1.0, 2.0])
        along = [self._following(state.rise + d, state.clearance) for d in steps]
        made, left = (_slope([take(one) for one in along], steps) for take in (lambda one: one.power, self.surplus))
        slow = self._slow(state)
        stable = left < 0.0 if slow is None else slow.real < 0.0
        return replace(state, loop_gain=made / (self.conductance + state.carried), slow=slow, stable=bool(stable))

    def _slow(self, state: WarmState) -> complex | None:
        """Least damped eigenvalue (1/s) of the clearance and the rings' heat about a state; None without time
        constants, or between faces so far apart that their squeeze is rounding."""
        if self.capacity is None:
            return None
        film = self.scene.film
        # Of the coning by heat such a step as changes the film's outer edge like that of the clearance.
        at, wide = np.array([state.clearance, state.rise, state.coned_by]), film.outer_radius - film.inner_radius
        steps = STEP * np.array([state.clearance, max(state.rise, 1e-3), state.clearance / wide])

        def film_at(clearance, rise, coned_by):
            there = self.state(rise, clearance, coned_by)
            return np.array([there.excess, there.power - there.carried * rise])

        slopes = [(film_at(*(at + d)) - film_at(*(at - d))) / (2.0 * d.sum()) for d in np.diag(steps)]
        squeezed, heated = np.transpose(slopes)
        axial, turning = self.damping(state.rise, state.clearance)
        if not axial > 0.0:
            return None
        matrix = ThermalStates(self.rings).matrix(squeezed / axial, heated, turning / axial)
        values = np.linalg.eigvals(matrix)
        slowest = values[np.argmax(values.real)]
        return complex(slowest.real, abs(slowest.imag))

    def working(self, near: WarmState | None = None) -> WarmState | None:
        """The state that the seal works in, the coolest stable one; looked for beside one `near` first, that of a speed
        nearby, whose stability is then that of the balance alone.  None if there is none."""
        # A shaft that stands makes no heat to begin from.
        return self._beside(near) if near is not None and near.rise > 0.0 else self._coolest

    @cached_property
    def _coolest(self) -> WarmState | None:
        found = self.continued(self.cold_state)
        return found if found and found.stable else next((state for state in self.states if state.stable), None)

    def continued(self, near: WarmState | None) -> WarmState | None:
        """The balance that continues one `near`, stable or not; None without it."""
        found = self._beside(near) if near is not None else None
        return None if found is None else self._judged(found)

    def _beside(self, near: WarmState) -> WarmState | None:
        """The balance that continues one `near`, where the surplus falls; None if there is none."""
        if (found := self._by_secants(near)) is not None:
            return found
        low = high = self._held(near.rise, near.clearance)
        if low is None:
            # No film so warm: from the cold on.
            low = high = self.cold_state
        wider, ended = WIDER, math.inf
        while low is not None and high is not None:
            if self.surplus(low) >= 0.0 > self.surplus(high):
                return self._balanced(low, high)
            if self.surplus(low) < 0.0:
                low, high = self._held(low.rise / wider, low.clearance), low
            else:
                rise = max(high.rise * wider, high.rise + FIRST * self.highest)
                low, (high, ended) = high, self._warmer(high, min(rise, self.highest), ended)
            wider = min(wider**2, WIDEST)
        return None

    def _by_secants(self, near: WarmState) -> WarmState | None:
        """The same, where a few secants end in it; None in any doubt."""
        before = None if near.rise else (0.0, near.power)
        rise, clearance = near.rise or near.power / (self.conductance + near.carried), near.clearance
        for _ in range(SECANTS):
            if (state := self._held(rise, clearance)) is None:
                return None
            left, surplus = self.conductance + state.carried, self.surplus(state)
            slope = -left if before is None else (surplus - before[1]) / (rise - before[0])
            step = -surplus / slope if slope < -DOUBTFUL * left else math.inf
            if abs(step) > NEARBY * rise:
                return None
            if abs(step) <= SETTLED * rise:
                return self._held(rise + step, state.clearance)
            before, clearance, rise = (rise, surplus), state.clearance, rise + step
        return None

    def _warmer(self, state: WarmState, rise: float, ended: float) -> tuple[WarmState | None, float]:
        """A state warmer than one, at a rise (K) or as near to it as there is a film, None where that ends with the
        state; and the least rise at which there is known to be none, `ended` before."""
        # Whatever was asked for is tried, and halves of it.
        rise = rise if rise < ended else 0.5 * (state.rise + ended)
        while rise - state.rise > 0.1 * FIRST * self.highest:
            if (found := self._held(rise, state.clearance)) is not None:
                return found, ended
            ended, rise = rise, 0.5 * (state.rise + rise)
        return None, ended

    def _held(self, rise: float, near: float) -> WarmState | None:
        """The same within the liquid's table; None beyond it, and of a rise that is none."""
        return self._following(rise, near) if TINY * self.highest < rise <= self.highest else None

    def why_none(self) -> str:
        """Why there is no warm state, in words."""
        if self.states:
            period = self.states[0].period
            hunts = f": the coolest hunts with a period of {period:.3g} s" if period else ""
            return f"every balance of heat is unstable{hunts}"
        if not self.scanned:
            return "no film holds the closing force at any temperature of the liquid's table"
        last = self.scanned[-1]
        if last.rise < self.highest * (1.0 - 1e-9):
            return f"the film collapses by heat: none holds the closing force {last.rise:.4g} K above the sealed liquid"
        end, times = self.sealed + last.rise - 273.15, last.power / ((self.conductance + last.carried) * last.rise)
        return f"at {end:.4g} degC, where the liquid's table ends, the film makes {times:.3g} times the heat it loses"


def _slope(values, steps) -> float:
    """Derivative by a fourth-order central difference of values at -2, -1, 1 and 2 steps."""
    return float((values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (6.0 * (steps[3] - steps[2]) * 2.0))


def unheated(scene):
    """The scene with faces that take no heat and the numbers of its liquid."""
    return replace(scene, film=in_numbers(replace(scene.film, heat=None)))


@lru_cache(maxsize=64)
def _warming(asked, cooling) -> Warming:
    return Warming(asked.scene, cooling)


def warming(scene, cooling: float = 1.0) -> Warming:
    """The `Warming` of a scene with `[film.heat]`, remembered; convection that is reckoned or given times `cooling`."""
    return _warming(Asked(scene), cooling)


class NoWarmState(SceneError):
    """Heat that nothing balances: a film that collapses by it, or beyond the table of its liquid."""

    status = Status.COLLAPSED


def at_work(scene, speed: float | None = None, near: WarmState | None = None):
    """The scene as it works: the numbers of its liquid in place of the liquid, faces coned by the heat that is made at
    a shaft speed (rad/s; its own), clearance and closing force of that; and its WarmState, None without `[film.heat]`,
    looked for beside one `near` first.  Raises NoWarmState."""
    if scene.film.heat is None:
        return (scene if scene.film.liquid is None else unheated(scene)), None
    found = warming(scene)
    if speed is not None:
        found = found.at_speed(speed)
    state = found.working(near)
    if state is None and near is not None:
        raise NoWarmState("shaft.speed", f"no warm state at {speed:.6g} rad/s", "a speed whose heat is carried away")
    if state is None:
        expected = "rings and leakage that carry the heat away, or a liquid known to a higher temperature"
        raise NoWarmState("film.heat", f"no warm state: {found.why_none()}", expected)
    return found.at(state.rise, state.clearance), state
