"""Natural frequencies of the primary ring against gears and the housing's tones."""

from ._finding import missing
from ._ring_on_springs import resonances

SOURCE = "gear mesh up to 5400 Hz, 45 g"
COMMAND = "sealdyn study vibration FILE"


def finding(seal):
    """Fail if a ring on its springs has a resonance at a gear mesh frequency or at a tone of the housing."""
    housing = seal.scene.housing
    tones = [tone.frequency for tone in (*housing.axial, *housing.angular)]
    tones += seal.application.gear_mesh_frequency or ()
    if not tones:
        return missing("application.gear_mesh_frequency", "housing.axial")
    return resonances(seal.scene, [(tone, tone) for tone in tones], "what surrounds it")
