"""What is imposed on a scene: shaft speed and angle, misalignments, runout, whirl, vibration, tables."""

from dataclasses import dataclass, field

from ..units import Acceleration, Angle, AngularAcceleration, Frequency, Length, Speed, Varying


@dataclass(frozen=True)
class Whirl:
    """Non-synchronous angular whirl of the shaft, `angle exp(i (ratio * shaft angle + phase))`, in rad."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    ratio: float
    """Whirl speed over shaft speed; negative against the shaft."""
    angle: Angle
    """Tilt of the shaft."""
    phase: Angle = 0.0
    """Of the tilt, at the start."""


@dataclass(frozen=True)
class Shaft:
    """The `[shaft]` table: speed (rad/s) and whirls."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    speed: Varying[Speed]
    """Shaft speed; negative turns the other way."""
    whirl: list[Whirl] = field(default_factory=list)
    """Whirling motions of the shaft."""


@dataclass(frozen=True)
class AxialVibration:
    """Axial vibration of the housing, cos(2 pi frequency t + phase), frequency in Hz, as displacement (m) or
    acceleration (m/s^2)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Frequency
    """Of this tone."""
    displacement: Length | None = None
    """Amplitude; or give `acceleration`."""
    acceleration: Acceleration | None = None
    """Amplitude, in place of `displacement`."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class AngularVibration:
    """Angular vibration of the housing about a fixed axis at `direction` (rad) from the x axis, cos(2 pi frequency t +
    phase)."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    frequency: Frequency
    """Of this tone."""
    displacement: Angle | None = None
    """Amplitude; or give `acceleration`."""
    acceleration: AngularAcceleration | None = None
    """Amplitude, in place of `displacement`."""
    direction: Angle = 0.0
    """Of the axis about which the housing rocks, from the x axis."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class Housing:
    """The `[[housing.axial]]` and `[[housing.angular]]` tables."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    axial: list[AxialVibration] = field(default_factory=list)
    """Tones along the shaft axis."""
    angular: list[AngularVibration] = field(default_factory=list)
    """Tones of tilt."""
