"""Runout and misalignment of the faces."""

from ...dynamics.intervals import largest_value
from ._finding import missing, within

SOURCE = '0.0005 in/in of diameter; the metric twin ".0127 m/mm" is a misprint'
COMMAND = "sealdyn study contact-onset FILE"

MOST = 0.0005


def finding(seal):
    """Pass up to 0.0005 rad, the largest of both rings' tilts and of the runout of the data sheet."""
    rotor, stator = seal.scene.rotor, seal.scene.stator
    key = "misalignment" if rotor.support else "runout"
    tilts = {
        f"rotor.{key}": largest_value(getattr(rotor, key)),
        "stator.misalignment": largest_value(stator.misalignment),
    }
    tilts["application.face_runout"] = (seal.application.face_runout or 0.0) / seal.outer_diameter
    worst = max(tilts, key=tilts.get)
    if tilts[worst] == 0.0:
        return missing(*tilts)
    said = f"{worst} tilts a face by {1e6 * tilts[worst]:.4g} urad, up to {1e6 * MOST:.0f} urad are usual"
    return within(said, tilts[worst], "rad", most=MOST)
