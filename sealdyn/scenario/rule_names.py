"""Names of the design rules that a scenario may acknowledge: those of the files in analysis/rules, none of which is
read for that."""

import pkgutil
from pathlib import Path

from .errors import nearest_of

FOLDER = Path(__file__).parents[1] / "analysis" / "rules"


# Those of radial seals (analysis/radial_rules.py).
RADIAL = {
    "lip": ("lip_eccentricity", "lip_load", "lip_pressure", "lip_speed"),
    "circumferential": (
        "axial_load",
        "garter_load",
        "hang_up",
        "segment_pressure",
        "segment_runout",
        "segment_speed",
    ),
}


def rule_names() -> list[str]:
    """Names of the rules there are."""
    return sorted(m.name for m in pkgutil.iter_modules([str(FOLDER)]) if m.name[0] != "_")


def unknown_rules(acknowledged, known=None) -> list[tuple[str, str, str]]:
    """What is wrong with the names of rules that are acknowledged, of the `known` ones (None: those of face seals):
    (key, found, expected)."""
    known = (known or rule_names()) if acknowledged else []
    return [
        (f"acknowledge.{name}", "an unknown design rule",
         f"one of {', '.join(known)}{nearest_of(name, known, 0.0)}")
        for name in acknowledged
        if name not in known
    ]  # fmt: skip
