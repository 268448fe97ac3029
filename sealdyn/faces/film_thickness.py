"""Film thickness h(r, theta, t) between the faces, its rate, and its smallest value with where it is.

Axes and signs: faces/geometry.py.  `f` is a face block (the leading slots of any film's), `s` a gap state.
**Valid** rigid faces: cones, a profile over the radius, waves around the circle, tilt.
"""

import math

from ..numerics.kernel import inner_kernel, value_kernel
from .geometry import (
    CLEARANCE,
    CONING,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_RADIUS,
    OUTER_RADIUS,
    PROFILE,
    PROFILE_DEPTHS,
    PROFILE_RADII,
    TILT_AT_MEAN,
    WAVES,
    smallest_gap,
)
from .thinnest import thinnest_of_waves
from .waviness import waves, waves_rate


@inner_kernel()
def _arm(f, r):
    """Arm (m) of the tilt at radius r."""
    return 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]) if f[TILT_AT_MEAN] != 0.0 else r


@inner_kernel()
def _depth(f, r):
    """Depth (m) of the profile at radius r, 0 without one; beyond its ends as there."""
    count = int(f[PROFILE])
    if count == 0 or r <= f[PROFILE_RADII]:
        return f[PROFILE_DEPTHS] if count else 0.0
    for k in range(1, count):
        before, here = f[PROFILE_RADII + k - 1], f[PROFILE_RADII + k]
        if r <= here:
            share = (r - before) / (here - before)
            return f[PROFILE_DEPTHS + k - 1] + share * (f[PROFILE_DEPTHS + k] - f[PROFILE_DEPTHS + k - 1])
    return f[PROFILE_DEPTHS + count - 1]


@inner_kernel()
def film_thickness(f, s, r, theta):
    """Film thickness (m) at radius r (m) and angle theta (rad, from the x axis)."""
    aligned = f[CLEARANCE] + s[DZ] + (f[CONING] + s[CONING_CHANGE]) * (r - f[INNER_RADIUS]) + _depth(f, r)
    return aligned + _arm(f, r) * (s[GX] * math.sin(theta) - s[GY] * math.cos(theta)) + waves(f, s, theta)


@inner_kernel()
def film_thickness_rate(f, s, r, theta):
    """Rate of the film thickness (m/s) at a fixed radius r (m) and angle theta (rad): the rings' own rates, the
    coning's, and the waves that pass with them."""
    tilting = s[GX_RATE] * math.sin(theta) - s[GY_RATE] * math.cos(theta)
    coned = s[CONING_RATE] * (r - f[INNER_RADIUS])
    return s[DZ_RATE] + coned + _arm(f, r) * tilting + waves_rate(f, s, theta)


def h_min(f, s) -> tuple[float, float, float]:
    """Smallest film thickness (m) over the face, its angle (rad, from the x axis, up to half a turn) and radius (m)."""
    return h_min_of(f)(f, s)


def h_min_of(f):
    """The compiled kernel that finds `h_min` of a face block; that of waves is compiled for wavy faces only."""
    return thinnest_of_waves if f[WAVES] != 0.0 else thinnest_of_cones


@value_kernel()
def thinnest_of_cones(f, s):
    """As `h_min`, of faces without waves."""
    # h = C + dz + ... - r G cos(beta): beta counts from the thinnest place (faces/geometry.py).
    least, radius = smallest_gap(f, s[DZ], math.hypot(s[GX], s[GY]), s[CONING_CHANGE])
    theta = math.atan2(s[GY], s[GX]) - 0.5 * math.pi
    if theta < -math.pi:
        theta += 2.0 * math.pi
    return least, theta, radius
