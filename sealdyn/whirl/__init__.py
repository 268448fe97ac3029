"""Whirl of the aligned seal free of forcing: as a relative equilibrium (turning), and in the time domain (in_time)."""

from .in_time import bounded_or_not, followed, growth_rate, tipping_disturbance
from .turning import Whirl, Whirling, branch, contact_tilt_aligned, free_problem, least_damped, undisturbed

__all__ = [
    "Whirl",
    "Whirling",
    "bounded_or_not",
    "branch",
    "contact_tilt_aligned",
    "followed",
    "free_problem",
    "growth_rate",
    "least_damped",
    "tipping_disturbance",
    "undisturbed",
]
