"""Natural frequencies of the primary ring against gears and the housing's tones."""

from ._finding import missing
from ._ring_on_springs import resonances

SOURCE = "gear mesh up to 5400 Hz, 45 g"
COMMAND = "sealdyn study vibration FILE"


def finding(seal):
    """Fail if a ring on its springs has a resonance at a gear mesh frequency, at a tone of the housing or in a band of
    its random vibration or of a sweep."""
    housing = seal.scene.housing
    tones = [tone.frequency for tone in (*housing.axial, *housing.angular)]
    tones += seal.application.gear_mesh_frequency or ()
    bands = [(tone, tone) for tone in tones]
    bands += [(r.frequency[0], r.frequency[-1]) for r in (*housing.axial_random, *housing.angular_random)]
    bands += [(min(sweep.frequency), max(sweep.frequency)) for sweep in housing.sweeps]
    if not bands:
        return missing("application.gear_mesh_frequency", "housing.axial")
    return resonances(seal.scene, bands, "what surrounds it")
