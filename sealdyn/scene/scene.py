"""A scene: rings, film, shaft and what drives them, as plain data.  It decides its own model."""

from dataclasses import dataclass, field

from ..units import Angle, Force, Length, Speed, Varying, Velocity
from .contact import Contact
from .excitation import Housing, Shaft
from .film import Film
from .rings import Rotor, Stator


@dataclass(frozen=True)
class Closing:
    """The `[closing]` table: hydraulic balance and spring.  Give two of balance ratio, spring force and
    film clearance and the third follows; give the clearance alone and the closing force is what holds it."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    balance_ratio: float | None = None
    spring_force: Varying[Force] | None = None


@dataclass(frozen=True)
class RingStart:
    """Where a flexible ring starts: displacement from equilibrium, tilt, and their rates (SI)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    z: Length | None = None
    tilt_x: Angle | None = None
    tilt_y: Angle | None = None
    z_rate: Velocity | None = None
    tilt_x_rate: Speed | None = None
    tilt_y_rate: Speed | None = None


@dataclass(frozen=True)
class Initial:
    """The `[initial]` table; what it gives overrides `run.start`."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    rotor: RingStart = field(default_factory=RingStart)
    stator: RingStart = field(default_factory=RingStart)


@dataclass(frozen=True)
class Scene:
    """Everything physical a scenario says."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    shaft: Shaft
    film: Film
    rotor: Rotor = field(default_factory=Rotor)
    stator: Stator = field(default_factory=Stator)
    housing: Housing = field(default_factory=Housing)
    closing: Closing = field(default_factory=Closing)
    initial: Initial = field(default_factory=Initial)
    contact: Contact | None = None


class SceneError(ValueError):
    """A scene that cannot exist: the key to blame, what was found, what is expected."""

    def __init__(self, key: str, found: str, expected: str):
        super().__init__(f"{key}: found {found}; expected {expected}")
        self.key, self.found, self.expected = key, found, expected
