"""What is imposed on a scene: shaft speed and angle, misalignments, runout, whirl, vibration, tables."""

from dataclasses import dataclass, field

from ..units import Acceleration, Angle, AngularAcceleration, Frequency, Length, Speed, Varying


@dataclass(frozen=True)
class Whirl:
    """Non-synchronous angular whirl of the shaft, `angle exp(i (ratio * shaft angle + phase))`."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    ratio: float
    angle: Angle
    phase: Angle = 0.0


@dataclass(frozen=True)
class Shaft:
    """The `[shaft]` table."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    speed: Varying[Speed]
    whirl: list[Whirl] = field(default_factory=list)


@dataclass(frozen=True)
class AxialVibration:
    """Axial vibration of the housing, cos(2 pi frequency t + phase), as displacement or acceleration."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Frequency
    displacement: Length | None = None
    acceleration: Acceleration | None = None
    phase: Angle = 0.0


@dataclass(frozen=True)
class AngularVibration:
    """Angular vibration of the housing about a fixed axis at `direction` from the x axis."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Frequency
    displacement: Angle | None = None
    acceleration: AngularAcceleration | None = None
    direction: Angle = 0.0
    phase: Angle = 0.0


@dataclass(frozen=True)
class Housing:
    """The `[[housing.axial]]` and `[[housing.angular]]` tables."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    axial: list[AxialVibration] = field(default_factory=list)
    angular: list[AngularVibration] = field(default_factory=list)
