"""A seal ring on its support: what a scenario says of it, and the numbers its equation of motion needs."""

from dataclasses import dataclass, field

from ..units import Angle, Damping, Inertia, Length, Mass, Speed, Stiffness, TiltDamping, TiltStiffness, Varying
from .secondary_seal import SecondarySeal
from .waviness import Waviness

STATOR, ROTOR = 0, 1
RING_NAMES = ("stator", "rotor")

FORBID_UNKNOWN = {"extra": "forbid"}


@dataclass(frozen=True)
class Support:
    """Springs and dampers between a ring and its carrier (housing or shaft).

    A ring of springs at `radius` r_s gives `tilt_stiffness = axial_stiffness r_s**2 / 2`, and the
    same for damping; or give the two tilt coefficients themselves.
    **Source** Green (1989), eq. 1-2 (sum over the circle of spring elements).
    """

    __pydantic_config__ = FORBID_UNKNOWN

    axial_stiffness: Stiffness
    axial_damping: Damping = 0.0
    radius: Length | None = None
    tilt_stiffness: TiltStiffness | None = None
    tilt_damping: TiltDamping | None = None

    def tilt(self) -> tuple[float, float]:
        """Tilt stiffness (N m/rad) and tilt damping (N m s/rad)."""
        if self.radius is not None:
            half = self.radius**2 / 2
            return self.axial_stiffness * half, self.axial_damping * half
        return self.tilt_stiffness or 0.0, self.tilt_damping or 0.0


@dataclass(frozen=True)
class AxialRunout:
    """One harmonic of the rotor's axial runout, `amplitude cos(order * shaft angle + phase)`."""

    __pydantic_config__ = FORBID_UNKNOWN

    order: float
    amplitude: Length
    phase: Angle = 0.0


@dataclass(frozen=True)
class Stator:
    """The ring that does not turn (unless `speed` says so).  With a support it floats."""

    __pydantic_config__ = FORBID_UNKNOWN

    mass: Mass = 0.0
    transverse_inertia: Inertia = 0.0
    polar_inertia: Inertia = 0.0
    unphysical_inertia: bool = False
    misalignment: Varying[Angle] = 0.0
    misalignment_direction: Angle = 0.0
    speed: Varying[Speed] = 0.0
    waviness: list[Waviness] = field(default_factory=list)
    support: Support | None = None
    secondary_seal: SecondarySeal | None = None


@dataclass(frozen=True)
class Rotor:
    """The ring that turns with the shaft.  With a support it floats and has its own `misalignment`;
    rigid it has a `runout`.  Both turn with the shaft."""

    __pydantic_config__ = FORBID_UNKNOWN

    mass: Mass = 0.0
    transverse_inertia: Inertia = 0.0
    polar_inertia: Inertia = 0.0
    unphysical_inertia: bool = False
    misalignment: Varying[Angle] = 0.0
    misalignment_phase: Angle = 0.0
    runout: Varying[Angle] = 0.0
    runout_phase: Angle = 0.0
    axial_runout: list[AxialRunout] = field(default_factory=list)
    waviness: list[Waviness] = field(default_factory=list)
    support: Support | None = None
    secondary_seal: SecondarySeal | None = None
