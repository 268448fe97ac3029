"""The gap between the faces: axes, signs, gap-state array, face block, closed forms of faces the same all around.

Axes (see README): z runs along the shaft from the rotor to the stator, theta is measured from the x axis.  The gap is
the stator's surface less the rotor's; the tilt of a ring is a small rotation vector, and `g = tilt of stator - tilt of
rotor`.  Film thickness of two rigid coned faces:

    h(r, theta, t) = C + dz + coning (r - r_i) + depth(r) + r (g_x sin(theta) - g_y cos(theta)) + waves(theta, t)

where coning is the block's and its change, `depth` is what faces that are not plain cones (worn ones) are wider apart,
linear between the radii of a profile, 0 without one, and `waves` what turns with either ring (faces/film_thickness.py).
Without waves and with `g = G exp(i alpha)` the thinnest place lies at theta = alpha - pi/2, and beta is counted from
there: h = C + dz + coning (r - r_i) + depth(r) - r G cos(beta).  Here are the slots and the closed forms of such
faces and faces that lie apart; h itself, its rate and its smallest value are in faces/film_thickness.py.
"""

import math

import numpy as np

from ..numerics.kernel import inner_kernel
from ..numerics.piecewise_linear import initially
from ..scene.film import MOST_NODES
from ..scene.patterns import MOST_WAVES

# Slots of the gap-state array `s`, which the scene fills and the film kernels read and complete.
DZ, GX, GY, DZ_RATE, GX_RATE, GY_RATE = range(6)
MEAN_SPIN, SPIN_DIFFERENCE, VISCOSITY, INNER_PRESSURE, OUTER_PRESSURE = range(6, 11)
FORCE, MOMENT_X, MOMENT_Y = range(11, 14)
FLOW_INNER, FLOW_OUTER, TORQUE, CAVITATED = range(14, 18)
CONTACT_FORCE, CONTACT_X, CONTACT_Y = range(18, 21)
CONTACT_TORQUE, CONTACT_AREA, CONTACT_PRESSURE, CONTACT_ENERGY, WEAR = range(21, 26)
# Angle (rad) each ring has turned, less whole turns before the present stretch of time.
STATOR_ANGLE, ROTOR_ANGLE = 26, 27
# Of a gas the temperature (K) of its reservoir; a code of the film's STATUS once it had no solution, 0 before.
TEMPERATURE, REFUSED = 28, 29
# By how much the coning differs from the block's (rad), and its rate (rad/s).
CONING_CHANGE, CONING_RATE = 30, 31
GAP_STATE_SIZE = 32

# Leading slots of every film's block `f`: the faces.  A film's own numbers follow.
INNER_RADIUS, OUTER_RADIUS, CLEARANCE, CONING, FLOOR, TILT_AT_MEAN, PLANAR, TOUCH, COLLAPSE, HALF_HEIGHT, PLATEAU = (
    range(11)
)
# The profile: how many radii (0: none), and room for the radii and the depths.
PROFILE, PROFILE_RADII = 11, 12
PROFILE_DEPTHS = PROFILE_RADII + MOST_NODES
# The waves (faces/film_thickness.py): how many (0: none), how many different orders, room for these, a row per wave.
WAVES = PROFILE_DEPTHS + MOST_NODES
ORDERS, ORDER_LIST = WAVES + 1, WAVES + 2
WAVE_ROWS, WAVE_ROW = ORDER_LIST + MOST_WAVES, 5
FACE_SIZE = WAVE_ROWS + WAVE_ROW * MOST_WAVES


def face_parameters(film, clearance: float) -> np.ndarray:
    """The face part of a film's parameter block, shape (FACE_SIZE,), of a `Film` table and a `clearance` (m): radii and
    clearance in m, coning in rad, the floor of the film thickness in m, two flags, the thickness at which the faces
    touch and the one at which the run ends (m), half the height of the asperities (m, 0: smooth) and where they stand
    on plateaus the film between these (m), the profile (m); with
    contact these are laid by faces/contact.py, and faces/film_thickness.py lays the waves."""
    f = np.zeros(FACE_SIZE)
    f[:PROFILE] = (
        film.inner_radius,
        film.outer_radius,
        clearance,
        initially(film.coning),
        film.floor * clearance,
        film.tilt_radius == "mean",
        film.geometry == "planar",
        -np.inf,
        film.floor * clearance,
        0.0,
        0.0,
    )
    if film.profile is not None:
        count = len(film.profile.radius)
        f[PROFILE] = count
        f[PROFILE_RADII:PROFILE_DEPTHS][:count] = film.profile.radius
        f[PROFILE_DEPTHS:WAVES][:count] = film.profile.depth
    return f


@inner_kernel()
def edge_gaps(f, dz, tilt, change):
    """Smallest film thickness (m) over the circle at the inner and at the outer edge.

    `f` a face block, `dz` change of the axial gap (m), `tilt` relative misalignment |g| (rad), `change` of the coning
    (rad).
    **Valid** rigid faces without waves; without a profile the minimum over the face is the smaller of the two.
    """
    r_i, r_o = f[INNER_RADIUS], f[OUTER_RADIUS]
    a_i, a_o = r_i, r_o
    if f[TILT_AT_MEAN] != 0.0:
        a_i = a_o = 0.5 * (r_i + r_o)
    inner = f[CLEARANCE] + dz - a_i * tilt
    outer = f[CLEARANCE] + dz + (f[CONING] + change) * (r_o - r_i) - a_o * tilt
    if f[PROFILE] != 0.0:
        inner += f[PROFILE_DEPTHS]
        outer += f[PROFILE_DEPTHS + int(f[PROFILE]) - 1]
    return inner, outer


@inner_kernel()
def node_gap(f, node, dz, tilt, change):
    """As `edge_gaps`, one film thickness (m), at the radius `node` of the profile (counted from 0); between them it is
    linear in r."""
    r_i, r = f[INNER_RADIUS], f[PROFILE_RADII + node]
    arm = 0.5 * (r_i + f[OUTER_RADIUS]) if f[TILT_AT_MEAN] != 0.0 else r
    return f[CLEARANCE] + dz + (f[CONING] + change) * (r - r_i) - arm * tilt + f[PROFILE_DEPTHS + node]


@inner_kernel()
def smallest_gap(f, dz, tilt, change):
    """Smallest film thickness over a face without waves (m), and its radius (m); arguments as `edge_gaps`."""
    if f[PROFILE] == 0.0:
        inner, outer = edge_gaps(f, dz, tilt, change)
        if inner <= outer:
            return inner, f[INNER_RADIUS]
        return outer, f[OUTER_RADIUS]
    # Linear between the radii of the profile, it is smallest at one of them.
    least, at = node_gap(f, 0, dz, tilt, change), 0
    for node in range(1, int(f[PROFILE])):
        gap = node_gap(f, node, dz, tilt, change)
        if gap < least:
            least, at = gap, node
    return least, f[PROFILE_RADII + at]


@inner_kernel()
def edges_of(f, s):
    """Mean films (m) at the inner and the outer edge, and their swings around the circle (m), of a gap state between
    faces without waves and profile."""
    tilt, mean = math.hypot(s[GX], s[GY]), 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS])
    inner, outer = (mean, mean) if f[TILT_AT_MEAN] != 0.0 else (f[INNER_RADIUS], f[OUTER_RADIUS])
    h_i = f[CLEARANCE] + s[DZ]
    coning = f[CONING] + s[CONING_CHANGE]
    return h_i, h_i + coning * (f[OUTER_RADIUS] - f[INNER_RADIUS]), inner * tilt, outer * tilt


@inner_kernel()
def tilt_frame(s):
    """The frame in which beta counts from the thinnest place: tilt (rad), cosine and sine of the angle alpha of its
    vector, and the tilt's rates (rad/s) along that and across it, less the wedge of the mean spin."""
    tilt = math.hypot(s[GX], s[GY])
    c_a, s_a = (s[GX] / tilt, s[GY] / tilt) if tilt > 0.0 else (1.0, 0.0)
    along = c_a * s[GX_RATE] + s_a * s[GY_RATE]
    return tilt, c_a, s_a, along, c_a * s[GY_RATE] - s_a * s[GX_RATE] - s[MEAN_SPIN] * tilt


@inner_kernel()
def regularised_thickness(h, floor):
    """Film thickness (m) as the film laws see it: h (m) itself above the `floor` (m), below it a positive continuation
    with the same slope, so that a solver's trial state never meets 1/h**3 of h <= 0."""
    if h >= floor:
        return h
    return floor * floor / (2.0 * floor - h)


# --- Offset faces --------------------------------------------------------------------------------------

# Faces whose centres lie apart: the narrower face, and with it the film, off the shaft's axis by a small c.
#
# About the film's centre both faces turn at the mean spin wm and slide together at (wm - w) z x c, w the speed of the
# ring with the narrower face:
#
#     div(h^3/(12 mu) grad p) = dh/dt + wm dh/dtheta + (wm - w) (z x c) . grad h
#
# On a tilted film the last term is the same everywhere, (wm - w) c . g: a squeeze of the whole film; on a coned one it
# goes once around like a rate of the tilt.  The sliding itself carries liquid across the face, net
#
#     Q(r) = pi (wm - w) r^2 c . g     outwards,
#
# the pumping of an eccentric face that stands tilted.  The wider ring has its surface, and the film's force, at c.
# **Source** derived here from Reynolds' equation between moving surfaces; Findlay (1969), J. Lubr. Tech. 91, as inward
# pumping.
# **Valid** |c| far below the width of the face, between plain cones; a liquid without cavities of its own unknowns;
# linearised numbers (modes, steady response, margins) have its moments, and err by the offset over the radius.

# Slots in the parameter block: offset (m; 0: none), its direction (rad), whether it is the rotor's, coning at the start
# (rad), mean radius (m).
OFFSET, DIRECTION, OF_ROTOR, CONED, MEAN_RADIUS = range(5)
OFFSET_SIZE = 5


def offset_block(film) -> np.ndarray:
    """The slots (OFFSET_SIZE,) of a `Film` table."""
    mean = 0.5 * (film.inner_radius + film.outer_radius)
    turns = float(film.narrow_face == "rotor")
    return np.array([film.offset, film.offset_direction, turns, initially(film.coning), mean])


@inner_kernel()
def wide_ring(block):
    """The ring with the wider face (0 stator, 1 rotor)."""
    return 0 if block[OF_ROTOR] != 0.0 else 1


@inner_kernel()
def slip(block, s):
    """How much faster (rad/s) the faces turn, on average, than the narrower one."""
    return 0.5 * s[SPIN_DIFFERENCE] if block[OF_ROTOR] == 0.0 else -0.5 * s[SPIN_DIFFERENCE]


@inner_kernel()
def shift(block, wide, centre, s):
    """The narrower face's `centre` (2,) (m), and the gap state `s` there, from displacements and rates `wide` (6,) of
    the wider ring, (z, tilts, rates)."""
    turned = block[DIRECTION] + (s[STATOR_ANGLE] if block[OF_ROTOR] == 0.0 else s[ROTOR_ANGLE])
    x, y = block[OFFSET] * math.cos(turned), block[OFFSET] * math.sin(turned)
    centre[0], centre[1] = x, y
    # The stator's height less the rotor's.
    sign = 1.0 if block[OF_ROTOR] != 0.0 else -1.0
    s[DZ] += sign * (wide[1] * y - wide[2] * x)
    s[DZ_RATE] += sign * (wide[4] * y - wide[5] * x)
    pace = slip(block, s)
    # The centre turns with the narrower ring.
    s[DZ_RATE] += sign * (s[MEAN_SPIN] - pace) * (wide[1] * x + wide[2] * y)
    s[DZ_RATE] += pace * (x * s[GX] + y * s[GY])
    coned = pace * (block[CONED] + s[CONING_CHANGE]) / block[MEAN_RADIUS]
    s[GX_RATE] += coned * x
    s[GY_RATE] += coned * y


@inner_kernel()
def pumped(block, centre, f, s):
    """Adds to the flows (m^3/s) of a gap state what the sliding carries across the face block `f`."""
    across = math.pi * slip(block, s) * (centre[0] * s[GX] + centre[1] * s[GY])
    r_i, r_o = f[INNER_RADIUS], f[OUTER_RADIUS]
    mean = f[TILT_AT_MEAN] != 0.0
    s[FLOW_INNER] += across * r_i * (block[MEAN_RADIUS] if mean else r_i)
    s[FLOW_OUTER] += across * r_o * (block[MEAN_RADIUS] if mean else r_o)
