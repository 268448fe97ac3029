"""Flatness of the faces, from trough to crest of their waves."""

import numpy as np

from ...scene.waviness import HIGHEST_ORDER
from ._finding import missing, within

SOURCE = "three helium light bands"
COMMAND = "sealdyn study load-support FILE"

MOST = 0.88e-6
# Angles around the face: forty to a wave.
ANGLES = np.linspace(0.0, 2 * np.pi, 40 * HIGHEST_ORDER + 1)


def finding(seal):
    """Pass up to 0.88 um on either face, as it was made."""
    heights = {"stator": _height(seal.scene.stator), "rotor": _height(seal.scene.rotor)}
    worst = max(heights, key=heights.get)
    if heights[worst] == 0.0:
        return missing("stator.waviness", "rotor.waviness")
    said = f"the {worst}'s face is wavy by {1e6 * heights[worst]:.4g} um, faces are flat within {1e6 * MOST:g} um"
    return within(said, heights[worst], "m", most=MOST)


def _height(ring) -> float:
    """From trough to crest (m)."""
    waves = (wave.amplitude * np.cos(wave.order * ANGLES + wave.phase) for wave in ring.waviness)
    return float(np.ptp(sum(waves, np.zeros_like(ANGLES))))
