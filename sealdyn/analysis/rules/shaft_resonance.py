"""Natural frequencies of the primary ring against the rotation of the shaft."""

import math

from ...numerics.piecewise_linear import points
from ._finding import missing
from ._ring_on_springs import resonances

SOURCE = "rotation 3 to 350 Hz"
COMMAND = "sealdyn study campbell FILE"


def finding(seal):
    """Fail if a ring on its springs has a resonance at a speed of the shaft, of the scene or in service, or at one of
    the stator's carrier, where that turns."""
    bands = [tuple(speed / (2 * math.pi) for speed in seal.shaft_speeds)]
    if bands[0][1] == 0.0:
        return missing("shaft.speed", "application.highest_speed")
    turning = [abs(speed) / (2 * math.pi) for speed in points(seal.scene.stator.speed)]
    if any(turning):
        bands.append((min(turning), max(turning)))
        return resonances(seal.scene, bands, "rotation of the shaft or of the stator's carrier")
    return resonances(seal.scene, bands, "the shaft")
