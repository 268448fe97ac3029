"""Natural frequencies of the primary ring against the rotation of the shaft."""

import math

from ._finding import missing
from ._ring_on_springs import resonances

SOURCE = "rotation 3 to 350 Hz"
COMMAND = "sealdyn study campbell FILE"


def finding(seal):
    """Fail if a ring on its springs has a resonance at a speed of the scene or in service."""
    low, high = (speed / (2 * math.pi) for speed in seal.shaft_speeds)
    if high == 0.0:
        return missing("shaft.speed", "application.highest_speed")
    return resonances(seal.scene, [(low, high)], "the shaft")
