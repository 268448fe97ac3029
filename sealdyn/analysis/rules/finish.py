"""Finish of the faces."""

import math

from ._finding import missing, within

SOURCE = "finish of the faces about 0.1 um"
COMMAND = "sealdyn study load-support FILE"

EACH = 0.1e-6


def finding(seal):
    """Pass up to 0.14 um: two faces of 0.1 um have sqrt(2) times as much together.  The scene's roughness is an rms
    one; a guide that averages reads some tenths less."""
    if seal.scene.contact is None:
        return missing("contact.roughness")
    roughness, most = seal.scene.contact.roughness, math.sqrt(2) * EACH
    said = f"both faces are rough by {1e6 * roughness:.4g} um together; two of 0.1 um have {1e6 * most:.2g} um"
    return within(said, roughness, "m", most=most)
