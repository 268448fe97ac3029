"""Asperity contact of the faces: load, moments, friction, wear, and the energy it stores.

**Source** the laws: faces/roughness.py.  Friction as a share of the load or of the touching area and wear by Archard's
law: Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979).
**Valid** rigid faces, coned, wavy, with a profile or grooves, rough at a scale far below their width; dry, and without
memory.

Contact depends on the film thickness alone, so it has a potential: V = int W(h) dA, dW/dh = -p_c, force and moments are
minus its derivatives, and turning costs nothing but friction.  A face with a profile is a sum of annuli between its
radii, which faces/roughness.py integrates.

Of a face with grooves, whose bottoms no asperity reaches, lands carry: int L p_c dA, L = sum_k L_k(r) e^{ikN phi} of 1
and 0.  Of a contact pressure without harmonics from N - 1 on the mean share L_0 of land on each circle gives force and
moments exactly; of any it gives their mean over all angles at which the pattern may stand, and has a potential.  L_0 is
one number from edge to edge of a pattern.  Measured with 12 spiral grooves over half the pitch, c = 3 rms, h_min 0.2 c
and a tilt of 0.6, 1, 2, 10 c at the outer edge: as the pattern turns the force differs by 2e-5, 3e-4, 2e-3, 0.4 (an arc
as narrow as a groove); the gap at which a force is carried by less than 0.08 c, at first touch too.

The kernels take `k` this module's block, `f` a film's block (its
leading slots the faces) and `s` the gap state (slots in faces/geometry.py).
"""

import math
from functools import lru_cache

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ..scene.forces import HALF_HEIGHT as HALF
from ..scene.forces import Contact, contact_thresholds, finish, plateau_height
from ..scene.patterns import land_shares
from .film_thickness import lay_waves, waves
from .geometry import (
    COLLAPSE,
    CONING_CHANGE,
    CONTACT_AREA,
    CONTACT_ENERGY,
    CONTACT_FORCE,
    CONTACT_PRESSURE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FLOOR,
    GX,
    GY,
    HALF_HEIGHT,
    INNER_RADIUS,
    ORDER_LIST,
    ORDERS,
    OUTER_RADIUS,
    PLATEAU,
    PROFILE,
    PROFILE_RADII,
    SPIN_DIFFERENCE,
    TILT_AT_MEAN,
    TOUCH,
    WAVES,
    WEAR,
    edge_gaps,
    node_gap,
    smallest_gap,
)
from .roughness import (
    ANNULI,
    ANNULUS_RADII,
    AREA,
    AROUND,
    ENERGY,
    FACE_AREA,
    LAND_SHARES,
    LOAD,
    NODES,
    RADIAL,
    SHEAR_OF_AREA,
    SHEAR_OF_LOAD,
    SPAN,
    TOP,
    WEAR_PER_LOAD,
    annulus,
    christensen_series,
    gaussian_series,
    plateau_share,
    pressed,
    scaled,
    stored,
    touching_radius,
)

# Gauss points of a panel around the circle: error below 1e-10 of the load (tests/convergence).
ANGLE_POINTS = {"christensen": 12, "greenwood-williamson": 20, "plateaus": 12}
# Even angles to each wave of wavy faces.
ANGLES_PER_WAVE = 128
_gauss = lru_cache(maxsize=16)(np.polynomial.legendre.leggauss)


def lay_asperities(contact: Contact, face: np.ndarray, points: int | None = None, lands=None) -> np.ndarray:
    """The contact's block of the parameter array, float64; the film thicknesses (m) of its floor, touch and collapse go
    into the `face` block, or a film's that begins with it.  `points`: Gauss points of each panel around the circle;
    `lands`: radii (m) of a face with grooves and the share of land between them, as of patterns.land_shares.
    """
    face[FLOOR], face[TOUCH], face[COLLAPSE] = contact_thresholds(contact)
    face[HALF_HEIGHT], face[PLATEAU] = HALF * finish(contact), plateau_height(contact)
    k = _laws(contact, points or ANGLE_POINTS[contact.law], bool(face[PROFILE] > 0)).copy()
    k[FACE_AREA] = math.pi * (face[OUTER_RADIUS] ** 2 - face[INNER_RADIUS] ** 2)
    if lands is not None:
        radii, shares = lands
        k[ANNULI] = len(shares)
        k[ANNULUS_RADII:LAND_SHARES][: len(radii)], k[LAND_SHARES:NODES][: len(shares)] = radii, shares
    return k


@lru_cache(maxsize=16)
def _laws(contact: Contact, points: int, profiled: bool) -> np.ndarray:
    """The block of `lay_asperities` without what is the face's own: it is laid at every step of a search."""
    _, top, bottom = contact_thresholds(contact)
    span = top - bottom
    if contact.law == "christensen":
        load = scaled(christensen_series(), contact.compressive_strength)
        area = christensen_series()
    elif contact.law == "plateaus":
        area, span = scaled(christensen_series(), plateau_share(contact.truncation)), 2.0 * HALF * finish(contact)
        load = scaled(area, contact.compressive_strength)
    else:
        number = contact.asperity_density * contact.asperity_radius * contact.roughness
        stiff = 4.0 / 3.0 * number * contact.modulus * math.sqrt(contact.roughness / contact.asperity_radius)
        load, area = scaled(gaussian_series(1.5), stiff), scaled(gaussian_series(1.0), math.pi * number)
    # Exact for u^4 Q(v) r^2, and for the energy u^5 R(v) r; with a profile also for u^4 Q(v) r^3.
    radial = (4 + int(load[0]) + 2 + int(profiled)) // 2 + 1
    k = np.zeros(NODES + 2 * (radial + points))
    k[TOP], k[SPAN] = top, span
    k[SHEAR_OF_AREA] = contact.shear_strength or 0.0
    if contact.shear_strength is None:
        k[SHEAR_OF_LOAD] = 0.1 if contact.friction_coefficient is None else contact.friction_coefficient
    k[WEAR_PER_LOAD] = contact.stator_wear_coefficient + contact.rotor_wear_coefficient
    k[LOAD:AREA], k[AREA:ENERGY], k[ENERGY:ANNULI] = load, area, stored(load, span)
    k[RADIAL], k[AROUND], first = radial, points, NODES
    for count in (radial, points):
        node, weight = _gauss(count)
        k[first : first + count] = 0.5 * (1.0 + node)
        k[first + count : first + 2 * count] = 0.5 * weight
        first += 2 * count
    return k


@inner_kernel()
def _mean_arm(f):
    """The mean radius where the tilt is taken there, else 0."""
    return 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]) if f[TILT_AT_MEAN] != 0.0 else 0.0


@inner_kernel()
def _face(k, f, s, complete):
    """Write the contact slots.  `complete` asks for friction, area, energy and wear too."""
    if f[WAVES] != 0.0:
        _wavy_face(k, f, s, complete)
        return
    s[CONTACT_FORCE] = s[CONTACT_X] = s[CONTACT_Y] = 0.0
    if complete:
        s[CONTACT_TORQUE] = s[CONTACT_AREA] = s[CONTACT_PRESSURE] = s[CONTACT_ENERGY] = s[WEAR] = 0.0
    tilt = math.hypot(s[GX], s[GY])
    if f[PROFILE] == 0.0:
        low_i, low_o = edge_gaps(f, s[DZ], tilt, s[CONING_CHANGE])
        low = min(low_i, low_o)
        if low >= k[TOP]:
            return
        r_i, r_o = f[INNER_RADIUS], f[OUTER_RADIUS]
        if k[ANNULI] == 0.0:
            load, arm, along, area, area_arm, energy, _ = annulus(
                k, r_i, r_o, _mean_arm(f), tilt, low_i, low_o, complete
            )
        else:
            load, arm, along, area, area_arm, energy = _lands(k, r_i, r_o, tilt, low_i, low_o, complete)
    else:
        low, _ = smallest_gap(f, s[DZ], tilt, s[CONING_CHANGE])
        if low >= k[TOP]:
            return
        load = arm = along = area = area_arm = energy = 0.0
        low_o = node_gap(f, 0, s[DZ], tilt, s[CONING_CHANGE])
        for node in range(int(f[PROFILE]) - 1):
            low_i, low_o = low_o, node_gap(f, node + 1, s[DZ], tilt, s[CONING_CHANGE])
            if min(low_i, low_o) >= k[TOP]:
                continue
            r_i, r_o = f[PROFILE_RADII + node], f[PROFILE_RADII + node + 1]
            a, b, c, d, e, g, _ = annulus(k, r_i, r_o, _mean_arm(f), tilt, low_i, low_o, complete)
            load += a
            arm += b
            along += c
            area += d
            area_arm += e
            energy += g
    s[CONTACT_FORCE] = load
    # The pressure is even about the thinnest place: its moment is along the tilt.
    if tilt > 0.0:
        s[CONTACT_X], s[CONTACT_Y] = along * s[GX] / tilt, along * s[GY] / tilt
    if complete:
        _complete(k, s, arm, area, area_arm, energy, low)


@inner_kernel()
def _lands(k, r_i, r_o, tilt, low_i, low_o, complete):
    """As roughness.annulus but its last, of the lands of a face between r_i and r_o."""
    load = arm = along = area = area_arm = energy = 0.0
    per_width, high = 1.0 / (r_o - r_i), low_i
    for n in range(int(k[ANNULI])):
        inner, outer, share = k[ANNULUS_RADII + n], k[ANNULUS_RADII + n + 1], k[LAND_SHARES + n]
        low, high = high, low_i + (low_o - low_i) * (outer - r_i) * per_width
        if min(low, high) >= k[TOP]:
            continue
        a, b, c, d, e, g, _ = annulus(k, inner, outer, 0.0, tilt, low, high, complete)
        load, arm, along = load + share * a, arm + share * b, along + share * c
        area, area_arm, energy = area + share * d, area_arm + share * e, energy + share * g
    return load, arm, along, area, area_arm, energy


@inner_kernel()
def _complete(k, s, arm, area, area_arm, energy, low):
    """Write what follows from the load's and the touching area's integrals with the radius (N m, m^3), that area (m^2),
    the stored energy (J) and the thinnest film (m)."""
    shear, spin = k[SHEAR_OF_LOAD] * arm + k[SHEAR_OF_AREA] * area_arm, s[SPIN_DIFFERENCE]
    s[CONTACT_TORQUE] = math.copysign(shear, spin) if spin != 0.0 else 0.0
    u = (k[TOP] - low) / k[SPAN]
    s[CONTACT_PRESSURE] = pressed(k, LOAD, u, u**4)
    s[CONTACT_AREA], s[CONTACT_ENERGY] = area / k[FACE_AREA], energy
    s[WEAR] = k[WEAR_PER_LOAD] * abs(spin) * arm / k[FACE_AREA]


@inner_kernel()
def _wavy_face(k, f, s, complete):
    """As `_face`, of faces with waves: even angles, at each of which the gap is linear in r.

    The laws are smooth three times where they begin: the error falls as the fifth power of the angles.
    """
    s[CONTACT_FORCE] = s[CONTACT_X] = s[CONTACT_Y] = 0.0
    if complete:
        s[CONTACT_TORQUE] = s[CONTACT_AREA] = s[CONTACT_PRESSURE] = s[CONTACT_ENERGY] = s[WEAR] = 0.0
    pieces, per_span = max(int(f[PROFILE]) - 1, 1), 1.0 / k[SPAN]
    radii, gaps = np.empty(pieces + 1), np.empty(pieces + 1)
    for node in range(pieces + 1):
        # A tilt of zero: the film of the aligned faces.
        if f[PROFILE] == 0.0:
            radii[node] = f[INNER_RADIUS] if node == 0 else f[OUTER_RADIUS]
            gaps[node] = edge_gaps(f, s[DZ], 0.0, s[CONING_CHANGE])[node]
        else:
            radii[node], gaps[node] = f[PROFILE_RADII + node], node_gap(f, node, s[DZ], 0.0, s[CONING_CHANGE])
    mean, highest = _mean_arm(f), 1
    for n in range(int(f[ORDERS])):
        highest = max(highest, int(f[ORDER_LIST + n]))
    angles, low = ANGLES_PER_WAVE * highest, math.inf
    load = arm = moment_x = moment_y = area = area_arm = energy = 0.0
    for n in range(angles):
        theta = 2.0 * math.pi * n / angles
        sin, cos = math.sin(theta), math.cos(theta)
        bump, tilt = waves(f, s, theta), s[GX] * sin - s[GY] * cos
        for node in range(pieces):
            r_i, r_o = radii[node], radii[node + 1]
            h_i = gaps[node] + bump + (mean if mean > 0.0 else r_i) * tilt
            h_o = gaps[node + 1] + bump + (mean if mean > 0.0 else r_o) * tilt
            low = min(low, h_i, h_o)
            if min(h_i, h_o) >= k[TOP]:
                continue
            a, b, c, d, e, _ = touching_radius(
                k, r_i, r_o, (k[TOP] - h_i) * per_span, (k[TOP] - h_o) * per_span, complete
            )
            turned = mean * a if mean > 0.0 else b
            load, arm, area, area_arm, energy = load + a, arm + b, area + c, area_arm + d, energy + e
            moment_x, moment_y = moment_x + sin * turned, moment_y - cos * turned
    if low >= k[TOP]:
        return
    step = 2.0 * math.pi / angles
    s[CONTACT_FORCE], s[CONTACT_X], s[CONTACT_Y] = step * load, step * moment_x, step * moment_y
    if complete:
        _complete(k, s, step * arm, step * area, step * area_arm, step * energy, low)


@value_kernel()
def no_load(k, f, s):
    """In place of `contact_load` where there is no contact: leaves the gap state as it is."""


@value_kernel()
def contact_load(k, f, s):
    """Contact force (N, opening) and moments (N m) on the stator, into the gap state: minus the derivatives of
    CONTACT_ENERGY by gap and tilt."""
    _face(k, f, s, False)


@value_kernel()
def contact_load_and_friction(k, f, s):
    """As `contact_load`; also the friction torque the shaft supplies (N m, sign of SPIN_DIFFERENCE), share of the face
    in contact, largest contact pressure (Pa), stored energy (J), and mean depth rate of wear of both faces (m/s), into
    the gap state.

    The normal pressure needs no torque on the slope of the faces: p_c is a function of h, so around any circle
    `int p_c dh/dtheta dtheta = -[W] = 0`.
    """
    _face(k, f, s, True)


@outer_kernel()
def wear_rates(k, f, s, out):
    """Where the load of faces with a profile rubs: `out[j] = int p_c r phi_j dA` (N m) for each of its radii, phi_j the
    hat function of radius j (1 there, 0 at the others, linear between), shape (radii,).

    The depth of a face grows at radius j by its wear coefficient times |SPIN_DIFFERENCE| times out[j] over the area
    int phi_j dA; the sum of `out` is the integral that WEAR has.
    **Source** Archard's law, as the module.
    """
    out[:] = 0.0
    tilt = math.hypot(s[GX], s[GY])
    for node in range(int(f[PROFILE]) - 1):
        low_i = node_gap(f, node, s[DZ], tilt, s[CONING_CHANGE])
        low_o = node_gap(f, node + 1, s[DZ], tilt, s[CONING_CHANGE])
        if min(low_i, low_o) >= k[TOP]:
            continue
        r_i, r_o = f[PROFILE_RADII + node], f[PROFILE_RADII + node + 1]
        _, arm, _, _, _, _, outwards = annulus(k, r_i, r_o, _mean_arm(f), tilt, low_i, low_o, True)
        share = outwards / (r_o - r_i)
        out[node] += arm - share
        out[node + 1] += share


def lay_surfaces(f, scene) -> np.ndarray | None:
    """Write the waves and the roughness of a scene's faces into a face block; returns the block of the asperities
    (contact.py), None for faces without `[contact]`."""
    lay_waves(f, scene.stator.waviness, scene.rotor.waviness)
    return lay_asperities(scene.contact, f, lands=land_shares(scene)) if scene.contact else None
