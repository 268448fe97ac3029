"""Names of the design rules that a scenario may acknowledge (analysis/design_rules.py, radial_rules.py)."""

from .errors import nearest_of

FACE = (
    "axial_travel", "balance", "coking", "face_pressure", "face_width", "film_thickness", "finish", "flatness",
    "gear_resonance", "hang_up", "heat", "leakage", "life", "lubricant_side", "misalignment", "pressure_velocity",
    "runout", "seal_temperature", "shaft_resonance", "sliding_speed",
)  # fmt: skip
LIP = ("lip_eccentricity", "lip_load", "lip_pressure", "lip_speed")
CIRCUMFERENTIAL = ("axial_load", "garter_load", "hang_up", "segment_pressure", "segment_runout", "segment_speed")


def unknown_rules(acknowledged, known: tuple[str, ...] = FACE) -> list[tuple[str, str, str]]:
    """What is wrong with the names of rules that are acknowledged, of the `known` ones: (key, found, expected)."""
    return [
        (f"acknowledge.{name}", "an unknown design rule",
         f"one of {', '.join(known)}{nearest_of(name, known, 0.0)}")
        for name in acknowledged
        if name not in known
    ]  # fmt: skip
