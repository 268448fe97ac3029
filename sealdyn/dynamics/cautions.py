"""What a person should know of a run before trusting it: code tests the concern, a person reads the sentence."""

from enum import StrEnum
from typing import NamedTuple


class Concern(StrEnum):
    """What a caution is about."""

    ACCURACY = "accuracy"
    ALIASING = "aliasing"
    NO_EQUILIBRIUM = "no equilibrium gap"
    CHOKING = "choking"
    BLOWN_OPEN = "blown open"
    CONTACT_ARM = "arm of the contact force"
    ENERGY = "energy"
    FLOOR = "pressure floor"
    FLASHING = "flashing"
    HEATING = "heating"
    INERTIA = "inertia of the film"
    ROUGH_FILM = "rough film"
    THIN_FILM = "thin film"
    TURBULENCE = "turbulence"
    WIDE_DAM = "wide dam"
    UNITS = "units"
    WEAR = "wear"


class Caution(NamedTuple):
    """A warning: what it is about, and a sentence for a person."""

    concern: Concern
    sentence: str
