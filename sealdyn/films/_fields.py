"""Fields: what a film shows over its faces, beside the forces it sums up to."""

from typing import NamedTuple


class Field(NamedTuple):
    """A quantity over the face: name, SI unit, what it is, and (unit, factor) that people read it in."""

    name: str
    unit: str
    long_name: str
    shown: tuple[str, float]


PRESSURE = Field("pressure", "Pa", "film pressure, absolute", ("MPa", 1e-6))
FILL = Field("fill", "1", "share of the film that is liquid", ("%", 100.0))
