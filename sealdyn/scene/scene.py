"""A scene: rings, film, shaft and what drives them, as plain data.  It decides its own model."""

from dataclasses import dataclass, field

from ..status import Status
from ..units import Force, Height, Share, Tilt, TiltRate, Varying, Velocity, cut
from . import Strict
from .contact import Contact
from .excitation import Housing, Shaft
from .film import Film
from .rings import Rotor, Stator


@dataclass(frozen=True)
class Closing(Strict):
    """The `[closing]` table: hydraulic balance and spring force (N).  Give two of balance ratio, spring force and film
    clearance and the third follows; give the clearance alone and the closing force is what holds it."""

    balance_ratio: Share | None = None
    """Closing area over face area, of the high-pressure side."""
    spring_force: Varying[Force] | None = None
    """Closing force of the springs at the operating length."""


@dataclass(frozen=True)
class RingStart(Strict):
    """Where a floating ring starts, in place of what `run.start` gives: displacement, tilt, and their rates (m, rad,
    m/s, rad/s)."""

    z: Height | None = None
    """Displacement along the shaft axis from equilibrium; positive closes a rotor's gap and opens a stator's."""
    tilt_x: Tilt | None = None
    """Tilt about the x axis."""
    tilt_y: Tilt | None = None
    """Tilt about the y axis."""
    z_rate: Velocity | None = None
    """Rate of `z`."""
    tilt_x_rate: TiltRate | None = None
    """Rate of `tilt_x`."""
    tilt_y_rate: TiltRate | None = None
    """Rate of `tilt_y`."""


@dataclass(frozen=True)
class Initial(Strict):
    """The `[initial]` table; what it gives overrides `run.start`."""

    rotor: RingStart = field(default_factory=RingStart)
    """Start of a floating rotor."""
    stator: RingStart = field(default_factory=RingStart)
    """Start of a floating stator."""

    @property
    def given(self) -> bool:
        """Whether it gives anything."""
        return any(value is not None for ring in (self.rotor, self.stator) for value in vars(ring).values())


@dataclass(frozen=True)
class Scene(Strict):
    """Everything physical a scenario describes, SI."""

    shaft: Shaft
    """Speed and whirl."""
    film: Film
    """Faces, fluid, pressures, film model."""
    rotor: Rotor = field(default_factory=Rotor)
    """The ring that turns with the shaft."""
    stator: Stator = field(default_factory=Stator)
    """The ring that stands in the housing."""
    housing: Housing = field(default_factory=Housing)
    """Vibration of the housing."""
    closing: Closing = field(default_factory=Closing)
    """Hydraulic balance and spring."""
    initial: Initial = field(default_factory=Initial)
    """Start of the floating rings."""
    contact: Contact | None = None
    """Asperities; without this table a film that closes ends the run."""


class SceneError(ValueError):
    """A scene that cannot exist: the key to blame, what was found, what is expected, and the `status` of its run;
    `others`: what else is wrong with the same tables."""

    status = Status.INVALID
    others: "tuple[SceneError, ...]" = ()

    def __init__(self, key: str, found: str, expected: str):
        super().__init__(key, found, expected)
        self.key, self.found, self.expected = key, found, expected

    def __str__(self):
        return f"{cut(self.key)}: found {cut(self.found)}; expected {cut(self.expected, 600)}"
