"""Secondary seal (O-ring): Coulomb friction along its circle, as the axial force and moment on the ring.

**Source** Ludwig & Allen, NASA TN D-8102 (1976); the circle integral of -F' sign(v) for a rigid ring, whose sliding
speed is a constant plus a first harmonic, v = z' + R (q_x sin(theta) - q_y cos(theta)):

    u = R |q|,  a = z'/u clipped to [-1, 1]:   force -4 R F' asin(a),   moment -4 R^2 F' sqrt(1 - a^2) q/|q|

Nothing sticks partially: the ring slides everywhere (or along a line), or is stuck with all three speeds zero.
The loads it can hold while stuck fill the limit surface |M| / (4 R^2 F') = cos(pi/2 |F| / (2 pi R F')).
**Valid** uniform line friction, rigid ring, no dependence on speed.
"""

import math
from dataclasses import dataclass
from typing import Literal

from numba import njit

from .units import Force, Length, LineForce, Velocity


@dataclass(frozen=True)
class SecondarySeal:
    """The `[stator.secondary_seal]` or `[rotor.secondary_seal]` table: `radius` of the circle, and `line_friction`
    (F', force per length) or `friction_force` (axial breakaway force, 2 pi R F').  `law = "regularised"` replaces
    the sign of the sliding speed by v/sqrt(v^2 + width^2): smooth, and creeping where a real seal sticks."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    radius: Length
    """Radius of the circle on which the O-ring slides."""
    line_friction: LineForce | None = None
    """Friction per length of that circle; or give `friction_force`."""
    friction_force: Force | None = None
    """Axial breakaway force, in place of `line_friction`."""
    law: Literal["coulomb", "regularised"] = "coulomb"
    """Real sticking, or a smoothed sign that creeps."""
    width: Velocity | None = None
    """Sliding speed over which the sign turns, for "regularised"."""

    def line(self) -> float:
        """Friction per length F' (N/m)."""
        if self.line_friction is not None:
            return self.line_friction
        return self.friction_force / (2 * math.pi * self.radius)

    def breakaway(self) -> tuple[float, float]:
        """Axial force (N) and moment (N m) that make a stuck ring slide, each alone."""
        return 2 * math.pi * self.radius * self.line(), 4 * self.radius**2 * self.line()


def faults(seal) -> list[tuple[str, str, str]]:
    """What is wrong with a table: (key, found, expected)."""
    out = []
    if seal.radius <= 0:
        out.append(("radius", f"{seal.radius:g} m", "a length > 0"))
    given = [x is not None for x in (seal.line_friction, seal.friction_force)]
    if sum(given) != 1:
        found = "both" if all(given) else "neither"
        out.append(("line_friction", found, "exactly one of line_friction and friction_force"))
    elif (seal.line_friction if given[0] else seal.friction_force) < 0:
        out.append(("friction_force", "a negative friction", "a friction >= 0"))
    if seal.law == "regularised" and not (seal.width and seal.width > 0):
        out.append(("width", "nothing", "a sliding speed > 0, over which the regularised law turns"))
    if seal.law == "coulomb" and seal.width is not None:
        out.append(("width", f"{seal.width:g} m/s", 'no width, or law = "regularised"'))
    return out


@njit(cache=True)
def sliding(v, q_x, q_y, line, radius, band, smooth, out):
    """Axial force (N) and moments (N m) on a ring that slides, into out[0:3]; returns its sliding speed (m/s).

    `v` axial speed, `q_x`, `q_y` tilt rates relative to what the ring slides on; `band` sliding speed (m/s) below
    which the friction fades linearly (Coulomb: a ring that slow is captured), or the width of the smooth law.
    """
    q = math.hypot(q_x, q_y)
    u = radius * q
    speed = math.hypot(v, u)
    if speed == 0.0:
        out[0] = out[1] = out[2] = 0.0
        return 0.0
    fade = speed / math.hypot(speed, band) if smooth else min(speed / band, 1.0)
    if u == 0.0:
        out[0], out[1], out[2] = -math.copysign(2.0 * math.pi * radius * line, v) * fade, 0.0, 0.0
        return speed
    a = min(max(v / u, -1.0), 1.0)
    out[0] = -4.0 * radius * line * math.asin(a) * fade
    # Close to |a| = 1 the product form does not cancel.
    moment = -4.0 * radius**2 * line * math.sqrt((1.0 - a) * (1.0 + a)) * fade / q
    out[1], out[2] = moment * q_x, moment * q_y
    return speed


@njit(cache=True)
def excess(force, moment_x, moment_y, line, radius):
    """How far a load lies outside the limit surface of a stuck ring: negative inside, 0 on it, in units of the
    largest moment (or, beyond the largest force, of that force)."""
    held = 2.0 * math.pi * radius * line
    most = 4.0 * radius**2 * line
    if line == 0.0:
        return 1.0
    f, m = abs(force) / held, math.hypot(moment_x, moment_y) / most
    return m - math.cos(0.5 * math.pi * min(f, 1.0)) + max(f - 1.0, 0.0)
