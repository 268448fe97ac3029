"""What is imposed on a scene: shaft speed and angle, misalignments, runout, whirl, vibration, tables."""

from dataclasses import dataclass, field

from ..units import Acceleration, Angle, AngularAcceleration, Frequency, Length, Speed, Varying
from .motion import Motion
from .random_vibration import AngularRandom, AxialRandom, mean_square, tones_of
from .sweep import AngularSweep, AxialSweep, Sweep, remark


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
    motion: Motion | None = None
    """Motion of the shaft under the rotor by samples."""


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
    """The `[[housing.axial]]` and `[[housing.angular]]` tables, those of random vibration and of sweeps, and
    `[housing.motion]`."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    axial: list[AxialVibration] = field(default_factory=list)
    """Tones along the shaft axis."""
    angular: list[AngularVibration] = field(default_factory=list)
    """Tones of tilt."""
    axial_random: list[AxialRandom] = field(default_factory=list)
    """Random vibrations along the shaft axis."""
    angular_random: list[AngularRandom] = field(default_factory=list)
    """Random vibrations of tilt."""
    axial_sweep: list[AxialSweep] = field(default_factory=list)
    """Sine sweeps along the shaft axis."""
    angular_sweep: list[AngularSweep] = field(default_factory=list)
    """Sine sweeps of tilt."""
    motion: Motion | None = None
    """Motion of the housing by samples."""

    @property
    def axial_tones(self) -> list[AxialVibration]:
        """All tones along the shaft axis, those of random vibration among them."""
        drawn = [tones_of(random, f"axial {n}") for n, random in enumerate(self.axial_random)]
        return [*self.axial, *(AxialVibration(f, acceleration=a, phase=p) for tones in drawn for f, a, p in tones)]

    @property
    def angular_tones(self) -> list[AngularVibration]:
        """All tones of tilt, those of random vibration among them."""
        found = list(self.angular)
        for n, random in enumerate(self.angular_random):
            found += [
                AngularVibration(f, acceleration=a, direction=random.direction, phase=p)
                for f, a, p in tones_of(random, f"angular {n}")
            ]
        return found

    @property
    def tones(self) -> list[AxialVibration | AngularVibration]:
        """All tones."""
        return [*self.axial_tones, *self.angular_tones]

    @property
    def sweeps(self) -> list[Sweep]:
        """All sweeps."""
        return [*self.axial_sweep, *self.angular_sweep]

    def remarks(self, duration: float) -> list[str]:
        """A sentence for each random vibration: how strong it is, over which band, of how many tones; and for each
        sweep, of which a run of `duration` (s) may have a part."""
        kinds = [("axially", "m/s^2", random) for random in self.axial_random]
        kinds += [("angularly", "rad/s^2", random) for random in self.angular_random]
        shaken = [
            f"housing shaken {how} at random: {mean_square(random) ** 0.5:.4g} {unit} rms from {random.frequency[0]:g} "
            f"to {random.frequency[-1]:g} Hz, {random.tones} tones, seed {random.seed}"
            for how, unit, random in kinds
        ]
        return shaken + [remark(sweep, duration) for sweep in self.sweeps]
