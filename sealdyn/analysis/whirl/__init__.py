"""Whirl of the aligned seal free of forcing: as a relative equilibrium (rotating_wave.py), and in the time domain
(time_domain.py)."""

from .rotating_wave import (
    RotatingWave,
    Whirl,
    branch,
    compared,
    contact_tilt_aligned,
    family_columns,
    free_model,
    kind_of,
    least_damped,
)
from .time_domain import TOO_SLOW, bounded_or_not, growth_rate, linear_growth, tilt_in_time, tipping_disturbance

__all__ = [
    "TOO_SLOW",
    "RotatingWave",
    "Whirl",
    "bounded_or_not",
    "branch",
    "compared",
    "contact_tilt_aligned",
    "family_columns",
    "free_model",
    "growth_rate",
    "kind_of",
    "least_damped",
    "linear_growth",
    "tilt_in_time",
    "tipping_disturbance",
]
