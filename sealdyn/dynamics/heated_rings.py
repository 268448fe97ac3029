"""What a ring of a scene takes of the film's heat, and stores: numbers of its maker, or its drawing, material and
cooling.

**Source** faces/ring_heat.py for a ring from its drawing, and for its convection by speed.
**Valid** convection at the largest speed of the scene, which stays while that changes, and at the temperature of the
sealed liquid.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..answers import columns
from ..numerics.piecewise_linear import initially
from ..scene.fluid import liquid_of
from .intervals import largest_value

if TYPE_CHECKING:
    from ..faces.ring_heat import RingBody

# Speed (rad/s) at least.
STANDING = 1.0


@dataclass(frozen=True)
class HeatedBody:
    """A ring's `resistance` (K/W), `coning_per_watt` (rad/W) and `time_constant` (s, None where it is not known); of
    one from its drawing also its `convection` (W/(m^2 K)), the Reynolds number of that by its speed and whether it is
    `extrapolated`, its hottest place and the O-ring's over the face's mean rise, h w/k, whether its band is `narrow` or
    the ring `long`, and what it was `drawn` as."""

    resistance: float
    coning_per_watt: float
    time_constant: float | None
    convection: float | None = None
    reynolds: float | None = None
    extrapolated: bool = False
    hottest: float | None = None
    at_o_ring: float | None = None
    biot: float | None = None
    narrow: bool = False
    long: bool = False
    drawn: "RingBody | None" = None


def heated_body(scene, name: str, cooling: float = 1.0) -> HeatedBody:
    """What the ring called `name` takes of the heat, as given or from its body; its convection times `cooling`."""
    ring = scene.film.heat.rings[name]
    if ring.convection is None:
        return HeatedBody(ring.resistance, ring.coning_per_watt, ring.time_constant)
    from ..faces.ring_heat import RingBody, ring_cooling, ring_heat

    film, body, liquid, cooled = scene.film, scene.rings[name].body, liquid_of(scene.film), None
    sealed, convection = initially(film.temperature), ring.convection
    outer_is_high = initially(film.outer_pressure) >= initially(film.inner_pressure)
    wet = ring.wet or ("outer" if outer_is_high else "bore")
    if convection == "becker":
        speeds = {"rotor": largest_value(scene.shaft.speed), "stator": largest_value(scene.stator.speed)}
        turns = speeds[name] != 0.0
        fluid = [float(of(sealed)) for of in (liquid.density_at, liquid.viscosity_at, liquid.specific_heat_at,
                                              liquid.conductivity_at)]  # fmt: skip
        diameter = 2.0 * (body.inner_radius if wet == "bore" else body.outer_radius)
        # Faces that stand rub nothing: any convection will do.
        passing = max(speeds[name] if turns else max(speeds.values()), STANDING)
        cooled = ring_cooling(passing, diameter, fluid, turns)
        convection = cooled.value
    convection *= cooling
    length = ring.wetted_length or body.length
    drawn = RingBody(body.inner_radius, body.outer_radius, body.length, film.inner_radius, film.outer_radius,
                     **body.solid(), convection=convection, wetted_length=length, wet=wet)  # fmt: skip
    found = ring_heat(drawn)
    return HeatedBody(
        found.resistance, found.coning_per_watt, found.time_constant, convection,
        cooled and cooled.reynolds, bool(cooled and cooled.extrapolated), found.hottest, found.at_o_ring, found.biot,
        film.outer_radius - film.inner_radius < drawn.width / 3.0, body.length > 4.0 * drawn.width, drawn,
    )  # fmt: skip


class ThermalStates:
    """What rings store: states theta (K), six of each from its drawing where all are, else one, the rise.

        one state:  C rise' = heat that enters - G rise,  coning by heat = B rise
        six a ring: tau_k theta_k' = R q - theta_k,  rise = sum R_k/R theta_k + R_0 q,
                    coning = sum X_k/R theta_k + X_0 q

    q is what enters a ring, R_0 and X_0 follow it at once; where it stays all states of the rings are the rise.
    `content` (J/K) and `leaving` (W/K) of each state are the heat that it holds and that it gives to the liquid.
    """

    def __init__(self, rings: dict[str, HeatedBody]):
        bodies = list(rings.values())
        self.several = all(body.drawn is not None for body in bodies)
        if not self.several:
            self.content = np.array([sum((body.time_constant or 0.0) / body.resistance for body in bodies)])
            self.leaving = np.array([sum(1.0 / body.resistance for body in bodies)])
            self.time = self.content / self.leaving
            self.coning = np.array([sum(body.coning_per_watt / body.resistance for body in bodies)])
            return
        from ..faces.ring_heat import ring_states

        wholes = [ring_states(body.drawn) for body in bodies]
        self.ring = np.concatenate([np.full(len(whole.resistances), k) for k, whole in enumerate(wholes)])
        self.time = np.concatenate([whole.time_constants for whole in wholes])
        self.resistance = np.array([body.resistance for body in bodies])[self.ring]
        self.share, self.coning, self.content, self.leaving = (
            np.concatenate(values) / self.resistance
            for values in columns(wholes, ("resistances", "conings", "contents", "leaving")).values()
        )
        # Of each ring: (W/K) and (rad/K) over the rise of the face beyond that of its states.
        self.immediate = np.array([1.0 / whole.immediate_resistance for whole in wholes])
        self.immediate_coning = np.array([whole.immediate_coning for whole in wholes]) * self.immediate

    def beneath(self, theta: np.ndarray) -> np.ndarray:
        """The rise (K) of each ring's face less what follows its heat at once."""
        return np.bincount(self.ring, self.share * theta, len(self.immediate))

    def rates(self, theta: np.ndarray, rise: float) -> np.ndarray:
        """Of theta (K/s), the faces at a rise (K)."""
        entering = self.immediate * (rise - self.beneath(theta))
        return (self.resistance * entering[self.ring] - theta) / self.time

    def matrix(self, squeezed: np.ndarray, heated: np.ndarray, arm: float) -> np.ndarray:
        """Rates (1/s) of a thickness and theta about a warm state over small changes of these, (1 + states, the same).

        `squeezed`, `heated`: slopes of the clearance's rate (m/s) and of the heat that enters the rings (W), over
        clearance (m), rise (K) and coning by heat (rad); `arm` (m/rad) of the coning's rate beside the clearance's:
        the thickness, at that arm, is what the film's force moves, whatever follows the heat at once.
        """
        states = len(self.content)
        squeezed, heated = (by - arm * by[0] * np.array([0.0, 0.0, 1.0]) for by in (squeezed, heated))
        if not self.several:
            # One state is the rise itself, and coning goes with it.
            squeezed, heated = (np.array([by[0], by[1] + self.coning[0] * by[2]]) for by in (squeezed, heated))
            warmed = np.array([heated[0], heated[1] - self.leaving[0]]) / self.content
            return np.array([squeezed, warmed])
        beneath = np.zeros((len(self.immediate), 1 + states))
        beneath[self.ring, 1 + np.arange(states)] = self.share
        coning = np.concatenate([[0.0], self.coning]) - self.immediate_coning @ beneath
        # The heat that enters changes as much as all rings take.
        rise = self.immediate @ beneath + heated[2] * coning
        rise[0] += heated[0]
        turned = float(np.sum(self.immediate_coning))
        rise /= float(np.sum(self.immediate)) - heated[1] - heated[2] * turned
        coning += turned * rise
        found = np.empty((1 + states, 1 + states))
        found[0] = squeezed[1] * rise + squeezed[2] * coning
        found[0, 0] += squeezed[0]
        entering = self.immediate[:, None] * (rise - beneath)
        found[1:] = self.resistance[:, None] * entering[self.ring]
        found[1:, 1:] -= np.eye(states)
        found[1:] /= self.time[:, None]
        return found
