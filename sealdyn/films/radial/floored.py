"""The radial film (film.py) with its pressure floored at the cavitation pressure (cavitated_circle.py)."""

from ...faces.geometry import TORQUE
from ...numerics.kernel import value_kernel
from .. import _radial_quadrature
from .._radial_quadrature import parameters
from .cavitated_circle import cavitated_circle
from .film import FIELDS, RUNG, accepts, fields, grid
from .rough import rough_circle

__all__ = ["FIELDS", "RUNG", "accepts", "fields", "flow", "grid", "opening_law", "parameters", "wrench"]


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned film, as that of film.py."""
    return _radial_quadrature.opening_law(film, parameters, wrench, mean_spin, spin_difference)


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    if not cavitated_circle(f, s)[0]:
        rough_circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m).  The leakage of a
    floored film is that of the film not floored."""
    by_pressure = rough_circle(f, s, True)
    dry, by_floored_pressure = cavitated_circle(f, s)
    if dry:
        s[TORQUE] += by_floored_pressure - by_pressure
