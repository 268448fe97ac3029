"""Forces and moments from outside on a floating ring: constant or over time, as tones, and by samples of a record.

They act on the ring beside film, support and closing force and do work on it.  The axial force points along z, from the
rotor to the stator: positive it opens the gap of a floating stator and closes that of a floating rotor.
"""

from dataclasses import dataclass, field

from ..numerics.piecewise_linear import points
from ..units import Angle, Force, Frequency, Listed, Moment, Sample, Varying
from . import Strict

LOAD_COLUMNS = ("force", "moment_x", "moment_y")


@dataclass(frozen=True)
class LoadTone(Strict):
    """A force along the shaft axis and a moment about a fixed axis, cos(2 pi frequency t + phase)."""

    frequency: Frequency
    """Of both."""
    force: Force = 0.0
    """Amplitude along the shaft axis."""
    moment: Moment = 0.0
    """Amplitude about the axis at `direction`."""
    direction: Angle = 0.0
    """Of the axis of the moment, from the x axis."""
    phase: Angle = 0.0
    """Of the cosine, at the start."""


@dataclass(frozen=True)
class LoadSamples(Strict):
    """Force and moments of a record, along the spline of fifth degree through its samples."""

    file: str | None = field(default=None, compare=False)
    """CSV or HDF5 with these columns, beside the scenario; columns that are given here are not read from it."""
    titles: list[str] | None = field(default=None, compare=False)
    """Names of the columns of a CSV file that has no line of them, "time (ms)" and the like, "" for one not read."""
    time: Listed[Sample] = ()
    """Of the samples, increasing, from 0 or before to the end of the run or beyond."""
    force: Listed[Force] | None = None
    """Along the shaft axis; none without it."""
    moment_x: Listed[Moment] | None = None
    """About the x axis; none without it."""
    moment_y: Listed[Moment] | None = None
    """About the y axis; none without it."""

    def columns(self) -> list[tuple[float, ...]]:
        """Force (N) and moments (N m) at the times, zeros where none are given."""
        return [getattr(self, name) or (0.0,) * len(self.time) for name in LOAD_COLUMNS]


@dataclass(frozen=True)
class Load(Strict):
    """The `[stator.load]` or `[rotor.load]` table: what pulls at a floating ring from outside, in the axes of the
    housing."""

    force: Varying[Force] = 0.0
    """Along the shaft axis, from rotor to stator where positive."""
    moment_x: Varying[Moment] = 0.0
    """About the x axis."""
    moment_y: Varying[Moment] = 0.0
    """About the y axis."""
    turns: bool = False
    """Whether the axes of `moment_x` and `moment_y` turn with the ring's carrier."""
    tone: list[LoadTone] = field(default_factory=list)
    """Tones of force and moment, in the axes of the housing."""
    samples: LoadSamples | None = None
    """Force and moments of a record, in the axes of the housing."""
    model: str | None = None
    """A load from outside by its name, smooth functions of time, which become `samples`; its options in a table of that
    name."""

    def varying(self) -> tuple:
        """What may be a function of time."""
        return self.force, self.moment_x, self.moment_y


def load_of(ring) -> Load | None:
    """The load on a Stator or Rotor that floats; None without."""
    return ring.load if ring.support else None


def standing(load: Load | None) -> Load | None:
    """What is left of a load of constant numbers where nothing is imposed: the force that moves the aligned rest."""
    return Load(force=load.force) if load is not None and load.force else None


def samples_of_loads(scene) -> dict[int, LoadSamples]:
    """Records of force by the ring that they pull at, 0 stator, 1 rotor."""
    loads = {0: load_of(scene.stator), 1: load_of(scene.rotor)}
    return {ring: load.samples for ring, load in loads.items() if load is not None and load.samples is not None}


def pulls(load: Load | None) -> bool:
    """Whether it has an axial force at any time."""
    if load is None:
        return False
    sampled = load.samples is not None and any(load.samples.force or ())
    return sampled or any(points(load.force)) or any(tone.force for tone in load.tone)


def turns_over(load: Load | None) -> bool:
    """Whether it has a moment at any time."""
    if load is None:
        return False
    moments = () if load.samples is None else (*(load.samples.moment_x or ()), *(load.samples.moment_y or ()))
    steady = any(points(load.moment_x)) or any(points(load.moment_y))
    return steady or any(moments) or any(tone.moment for tone in load.tone)
