"""A seal ring on its support: what a scenario says of it, and the numbers its equation of motion needs."""

from dataclasses import dataclass, field

from ..units import Angle, Damping, Inertia, Length, Mass, Radius, Speed, Stiffness, TiltDamping, TiltStiffness, Varying
from .body import Body
from .elastic_ring import ElasticRing
from .secondary_seal import SecondarySeal
from .waviness import Waviness

STATOR, ROTOR = 0, 1
RING_NAMES = ("stator", "rotor")

FORBID_UNKNOWN = {"extra": "forbid"}


@dataclass(frozen=True)
class Support:
    """Springs and dampers between a ring and its carrier (housing or shaft), SI.

    A ring of springs at `radius` r_s gives `tilt_stiffness = axial_stiffness r_s**2 / 2`, and the same for damping; or
    give the two tilt coefficients themselves.
    **Source** Green (1989), eq. 1-2 (sum over the circle of spring elements).
    """

    __pydantic_config__ = FORBID_UNKNOWN

    axial_stiffness: Stiffness
    """All springs together, along the shaft axis."""
    axial_damping: Damping = 0.0
    """All dampers together, along the shaft axis."""
    radius: Radius | None = None
    """Radius of the circle of springs: tilt coefficient = axial coefficient * radius^2 / 2."""
    tilt_stiffness: TiltStiffness | None = None
    """About a diameter, in place of `radius`."""
    tilt_damping: TiltDamping | None = None
    """About a diameter, beside `tilt_stiffness`; none without it."""

    def tilt(self) -> tuple[float, float]:
        """Tilt stiffness (N m/rad) and tilt damping (N m s/rad)."""
        if self.radius is not None:
            half = self.radius**2 / 2
            return self.axial_stiffness * half, self.axial_damping * half
        return self.tilt_stiffness or 0.0, self.tilt_damping or 0.0


@dataclass(frozen=True)
class AxialRunout:
    """One harmonic of the rotor's axial runout (m), `amplitude cos(order * shaft angle + phase)`."""

    __pydantic_config__ = FORBID_UNKNOWN

    order: float
    """Waves per turn of the shaft."""
    amplitude: Length
    """Half of the peak-to-peak axial motion of the whole face."""
    phase: Angle = 0.0
    """Of the wave, at the start."""


@dataclass(frozen=True)
class Stator:
    """The ring that does not turn (unless `speed` says so).  With a support it floats."""

    __pydantic_config__ = FORBID_UNKNOWN

    mass: Mass = 0.0
    """Mass of the ring, if it floats; or a table `body`."""
    transverse_inertia: Inertia = 0.0
    """Moment of inertia about a diameter; with mass 0 and inertias 0 the ring has no inertia."""
    polar_inertia: Inertia = 0.0
    """Moment of inertia about the shaft axis, at most twice the transverse one."""
    body: Body | None = None
    """The ring from its drawing, in place of mass and inertias."""
    unphysical_inertia: bool = False
    """Allow a polar inertia beyond twice the transverse one, for comparison with published numbers."""
    misalignment: Varying[Angle] = 0.0
    """Tilt of the seat of a rigid stator, or of the unloaded face in its springs if it floats."""
    misalignment_direction: Angle = 0.0
    """Of the axis of that tilt, from the x axis; fixed in space, or in the carrier of a stator with a `speed`."""
    speed: Varying[Speed] = 0.0
    """Of a stator that turns with a carrier of its own (counter-rotation: negative)."""
    waviness: list[Waviness] = field(default_factory=list)
    """Waves around its face, which turn with it."""
    elastic: ElasticRing | None = None
    """A ring that bends: its waviness is what it was made with, and less is left under load."""
    support: Support | None = None
    """Springs and dampers to the housing: the stator floats."""
    secondary_seal: SecondarySeal | None = None
    """Friction of the O-ring under a floating stator."""


@dataclass(frozen=True)
class Rotor:
    """The ring that turns with the shaft.  With a support it floats and has its own `misalignment`;
    rigid it has a `runout`.  Both turn with the shaft."""

    __pydantic_config__ = FORBID_UNKNOWN

    mass: Mass = 0.0
    """Mass of the ring, if it floats; or a table `body`."""
    transverse_inertia: Inertia = 0.0
    """Moment of inertia about a diameter; with mass 0 and inertias 0 the ring has no inertia."""
    polar_inertia: Inertia = 0.0
    """Moment of inertia about the shaft axis, at most twice the transverse one."""
    body: Body | None = None
    """The ring from its drawing, in place of mass and inertias."""
    unphysical_inertia: bool = False
    """Allow a polar inertia beyond twice the transverse one, for comparison with published numbers."""
    misalignment: Varying[Angle] = 0.0
    """Tilt of the unloaded face of a floating rotor in its springs; turns with the shaft."""
    misalignment_phase: Angle = 0.0
    """Of the axis of that tilt, at the start, from the x axis."""
    runout: Varying[Angle] = 0.0
    """Tilt of the face of a rigid rotor, turning with the shaft; also "20 um TIR", read at the outer radius."""
    runout_phase: Angle = 0.0
    """Of the axis of that tilt, at the start, from the x axis."""
    axial_runout: list[AxialRunout] = field(default_factory=list)
    """Harmonics of the axial motion of the rotor's carrier."""
    waviness: list[Waviness] = field(default_factory=list)
    """Waves around its face, which turn with it."""
    support: Support | None = None
    """Springs and dampers to the shaft: the rotor floats."""
    secondary_seal: SecondarySeal | None = None
    """Friction of the O-ring under a floating rotor."""
