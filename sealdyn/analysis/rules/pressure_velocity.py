"""Face pressure times sliding speed (PV)."""

from ._finding import noted

SOURCE = "no limit of materials is taken from the guide"
COMMAND = "sealdyn study wear FILE"


def finding(seal):
    """A note: closing force above the lower pressure, over the face, times the highest sliding speed."""
    pv = seal.face_load / seal.face_area * seal.sliding_speed
    said = (
        f"PV {pv / 1e6:.4g} MPa m/s, if the faces carried all of the closing force: to be held against the limit of "
        "their materials"
    )
    return noted(said, pv, "Pa m/s")
