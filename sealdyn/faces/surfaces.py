"""What the faces of a scene have besides their geometry: waves and roughness."""

import numpy as np

from .contact import lay_asperities
from .waviness import lay_waves


def lay_surfaces(f, scene) -> np.ndarray | None:
    """Write the waves and the roughness of a scene's faces into a face block; returns the block of the asperities
    (contact.py), None for faces without `[contact]`."""
    lay_waves(f, scene.stator.waviness, scene.rotor.waviness)
    return lay_asperities(scene.contact, f) if scene.contact else None
