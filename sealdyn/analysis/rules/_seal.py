"""What design rules ask of a seal: figures of its scene and application, SI."""

import math
from dataclasses import dataclass

import numpy as np

from ...dynamics.interface import rest_state
from ...dynamics.intervals import largest_value
from ...faces.contact import contact_load_and_friction
from ...faces.geometry import CONTACT_TORQUE, FLOW_INNER, FLOW_OUTER, SPIN_DIFFERENCE
from ...numerics.piecewise_linear import PiecewiseLinear, initially, points
from ...scene.application import Application
from ...scene.scene import Scene


@dataclass(frozen=True)
class Seal:
    """A scene as it was made, what it is for (an empty `Application` if nothing says so), and its model."""

    scene: Scene
    application: Application
    model: object

    @property
    def outer_diameter(self) -> float:
        """Outer diameter (m) of the face."""
        return 2 * self.scene.film.outer_radius

    @property
    def mean_diameter(self) -> float:
        """Mean diameter (m) of the face."""
        return self.scene.film.outer_radius + self.scene.film.inner_radius

    @property
    def face_width(self) -> float:
        """Radial width (m) of the face."""
        return self.scene.film.outer_radius - self.scene.film.inner_radius

    @property
    def face_area(self) -> float:
        """Area (m^2) of the face."""
        return math.pi * self.mean_diameter * self.face_width

    @property
    def sliding_speed(self) -> float:
        """Highest sliding speed pi D N (m/s) at the mean diameter, of the scene or in service."""
        spin = _apart(self.scene.shaft.speed, self.scene.stator.speed)
        return 0.5 * self.mean_diameter * max(spin, self.application.highest_speed or 0.0)

    @property
    def shaft_speeds(self) -> tuple[float, float]:
        """Lowest and highest shaft speed (rad/s, either way) of the scene and in service."""
        signed = points(self.scene.shaft.speed)
        low = 0.0 if min(signed) < 0.0 < max(signed) else min(map(abs, signed))
        lowest, highest = self.application.lowest_speed, self.application.highest_speed
        return min(low, low if lowest is None else lowest), max(largest_value(self.scene.shaft.speed), highest or 0.0)

    @property
    def sealed_pressure(self) -> float:
        """Largest pressure difference (Pa) across the face, of the scene or in service."""
        film = self.scene.film
        low = min(*points(film.inner_pressure), *points(film.outer_pressure))
        return max(_apart(film.outer_pressure, film.inner_pressure), (self.application.highest_pressure or 0.0) - low)

    @property
    def spring_force(self) -> float | None:
        """Spring force (N) at the start, given or following from balance ratio and clearance; None where the scene
        only says that something holds its clearance."""
        closing = self.scene.closing
        if closing.spring_force is None and closing.balance_ratio is None:
            return None
        return initially(self.model.closing.spring)

    @property
    def face_load(self) -> float:
        """Closing force (N) at the start above the lower of the two pressures."""
        film = self.scene.film
        low = min(initially(film.inner_pressure), initially(film.outer_pressure))
        return self.model.closing_force() - low * self.face_area

    @property
    def film_thickness(self) -> float:
        """Film thickness (m) of the aligned faces at the mean radius, at the start."""
        radii, gaps = zip(*self.model.aligned_gaps(), strict=True)
        return float(np.interp(0.5 * self.mean_diameter, radii, gaps))

    @property
    def asperity_heat(self) -> float:
        """Friction (W) of the asperities at the highest sliding speed, of what they carry at the start."""
        interface = self.model.interface
        if interface.contact is None:
            return 0.0
        s = rest_state(self.model.scene, self.model.clearance, self.model.start)[0]
        s[SPIN_DIFFERENCE] = 2 * self.sliding_speed / self.mean_diameter
        contact_load_and_friction(interface.contact, self.model.observed[1], s)
        return float(s[CONTACT_TORQUE] * s[SPIN_DIFFERENCE])

    @property
    def leakage(self) -> float:
        """Leakage (m^3/s) of the aligned faces, at the start.  Raises SceneError where the film has no solution."""
        film, f = self.model.observed
        s = rest_state(self.model.scene, self.model.clearance, self.model.start)[0]
        own = [self.model.interface.steady(f, s)] if self.model.interface.unknowns is not None else []
        film.flow(f, s, *own)
        return abs(float(s[FLOW_INNER if self.model.closing.outer_is_high else FLOW_OUTER]))

    @property
    def highest_temperature(self) -> float | None:
        """Highest temperature (K) of the fluid, of the scene or in service; None where neither says."""
        told = self.application.highest_temperature, *points(self.scene.film.temperature)
        return max((t for t in told if t is not None), default=None)


def _apart(one, other) -> float:
    """Largest difference of two numbers or functions of time, in their unit."""
    times = {t for q in (one, other) if isinstance(q, PiecewiseLinear) for t in q.time} | {0.0}
    # Of a step also what was before it.
    times |= {math.nextafter(t, -math.inf) for t in times}
    return max(abs(_at(one, t) - _at(other, t)) for t in times)


def _at(quantity, t: float) -> float:
    return quantity.at(t) if isinstance(quantity, PiecewiseLinear) else float(quantity)
