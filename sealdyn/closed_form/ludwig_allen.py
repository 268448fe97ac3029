"""A ring kept from following its misaligned seat by secondary-seal friction, carried by the wedge of its own tilt.

**Source** Ludwig, L. P. & Allen, G. P., "Face-seal lubrication. II - Theory of response to angular misalignment", NASA
TN D-8102 (1976); eigenvalues and the moment about the tilt axis derived here from their film.
**Valid** zero sealed pressure, film `h = h0 + h1 cos(theta)` constant over a narrow face (short bearing), pressure
ambient in the diverging half, no inertia.  U is the sliding speed at the mean radius R, dR the face width, F_s the
spring force, F_d the friction force on one half of the secondary seal, q = F_s / F_d.  Over the width the wedge has
the mean p = -(mu U dR^2 / 2R) h^-3 dh/dtheta where that is positive: over mu U dR^3 and of moments over R, a force, a
moment about the diameter through thickest and thinnest film, and one about the tilt axis, which straightens the ring
and which they leave unbalanced,

    h0 h1 / (h0^2 - h1^2)^2,     (pi/4) h1 / (h0^2 - h1^2)^(3/2),     -h1^2 / (h0^2 - h1^2)^2

With sealed pressures (`edges`, sealed_wedge.py) F_s is the closing load that their line over the width leaves; without
them all is theirs.
Arguments: `force_ratio` q, `group` mu U dR^3 / F_s (m^2); scalars or arrays that broadcast.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from . import sealed_wedge as sealed

Real = float | np.ndarray

# Below this ratio of spring to friction force no film balances both: 16 / pi^2 = 1.6211.
LEAST_FORCE_RATIO = 16 / math.pi**2
# Below this one the balance exists but repels: where the real part of `eigenvalues` changes sign (h1/h0 = 0.3235).
LEAST_ATTRACTING_FORCE_RATIO = 1.7132380648575958
NO_PRESSURE = sealed.Edges()


class Published(NamedTuple):
    """One printed row: force ratio q, mean film h0 and least film h0 - h1 (m; None: not printed)."""

    force_ratio: float
    mean_film: float
    least_film: float | None


# The example's inputs are lost but for the face width; all printed h0 give this mu U dR^3 / F_s (m^2).
LUDWIG_ALLEN = (Published(2.0, 0.71e-6, 0.30e-6), Published(5.0, 5.69e-6, None))
LUDWIG_ALLEN_GROUP = 3.79e-13
LUDWIG_ALLEN_FACE_WIDTH = 1.02e-3


def friction_moment(friction_force: Real, mean_radius: Real) -> Real:
    """Moment (N m) `4 R F_d / pi` of the friction on both halves of the secondary seal.  **Source**, arguments as the
    module: F_d in N, R in m."""
    return 4 * mean_radius * friction_force / math.pi


def least_force_ratio(edges: sealed.Edges = NO_PRESSURE) -> float:
    """q below which no film balances friction and load: LEAST_FORCE_RATIO, and less under pressure, as the film's
    moment falls with its tilt from that of nearly parallel faces.  **Source**, **Valid** as the module."""
    return 4 / (math.pi * sealed.moment_limits(edges)[0])


@lru_cache(maxsize=64)
def least_attracting_force_ratio(edges: sealed.Edges = NO_PRESSURE) -> float:
    """q below which the balance repels: where the real part of `eigenvalues` changes sign.  **Source**, **Valid** as
    the module."""
    if not edges.sealed:
        return LEAST_ATTRACTING_FORCE_RATIO

    def growth(e):
        squeeze, film = sealed.slopes(e, edges)[::-1]
        return max(np.linalg.eigvals(np.linalg.solve(squeeze, -film)).real)

    # The thin side of a strong wedge attracts; from there to where it first does not.
    last = 1 - 1e-4
    for e in 1 - np.geomspace(1e-3, 0.99, 30):
        if growth(e) > 0.0:
            return 4 / (math.pi * sealed.balance(brentq(growth, e, last), edges)[1])
        last = e
    return least_force_ratio(edges)


@lru_cache(maxsize=4096)
def _film_at(force_ratio: float, edges: sealed.Edges) -> tuple[float, float, float]:
    """h1/h0, sealing number and cosine moment over R F_s of the balance; scalar arguments."""
    friction = 4 / (math.pi * force_ratio)
    e = brentq(lambda e: sealed.balance(e, edges)[1] - friction, sealed.FLAT, 1 - 1e-9, xtol=1e-14)
    number, _, cosine = sealed.balance(e, edges)
    return e, number, cosine


def _films_at(force_ratio: Real, edges: sealed.Edges) -> list[Real]:
    return [found[()] for found in np.vectorize(lambda q: _film_at(float(q), edges), otypes="ddd")(force_ratio)]


def amplitude_ratio(force_ratio: Real, edges: sealed.Edges = NO_PRESSURE) -> Real:
    """h1 / h0 `= sqrt(1 - (256 / pi^4) / q^2)`, dimensionless; under pressure the root of the balance.

    **Source** as the module.  **Valid** q >= `least_force_ratio`.  **Raises** ValueError below it: hang-up.
    """
    least = least_force_ratio(edges)
    if not np.all(np.greater_equal(force_ratio, least)):
        known = "" if edges.sealed else " = 16/pi^2"
        raise ValueError(f"hang-up: no film balances friction and spring below F_s/F_d{known} = {least:.4f}")
    if edges.sealed:
        return _films_at(force_ratio, edges)[0]
    ratio = np.divide(LEAST_FORCE_RATIO, force_ratio)
    return np.sqrt((1 - ratio) * (1 + ratio))[()]


def sealing_number(force_ratio: Real, edges: sealed.Edges = NO_PRESSURE) -> Real:
    """`h0^2 F_s / (mu U dR^3) = (pi^4/256)^2 q^4 h1/h0`, dimensionless, a function of q (and the pressures) alone.

    **Source** as the module.  **Valid** q >= `least_force_ratio`.  **Raises** ValueError below it: hang-up.
    """
    share = amplitude_ratio(force_ratio, edges)
    if edges.sealed:
        return _films_at(force_ratio, edges)[1]
    return (np.divide(force_ratio, LEAST_FORCE_RATIO) ** 4 * share)[()]


def equilibrium(force_ratio: Real, group: Real, edges: sealed.Edges = NO_PRESSURE) -> tuple[Real, Real]:
    """Mean film h0 and amplitude h1 (m) for q and `group` = mu U dR^3 / F_s (m^2).

    **Source** as the module.  **Valid** q >= `least_force_ratio`.  **Raises** ValueError below it: hang-up.
    """
    mean_film = np.sqrt(sealing_number(force_ratio, edges) * group)
    return mean_film, mean_film * amplitude_ratio(force_ratio, edges)


def eigenvalues(force_ratio: float, mean_spin: float, edges: sealed.Edges = NO_PRESSURE) -> np.ndarray:
    """The two eigenvalues (2,) (1/s, complex) of h0, h1 under force and sine moment, squeeze included; scalar
    arguments.

    `A h' + B h = 0` with A, B the derivatives of the half film's force and sine moment, all elementary integrals over
    the half circle (under pressure by `sealed_wedge.slopes`); proportional to `mean_spin` (rad/s, half the shaft's
    speed over a still seat).
    **Source** derived here.  **Valid** as the module, q > `least_force_ratio`; small motion about the equilibrium.
    **Raises** ValueError below it: hang-up.
    """
    e = float(amplitude_ratio(force_ratio, edges))
    if edges.sealed:
        film, squeeze = sealed.slopes(e, edges)
        return np.sort_complex(np.linalg.eigvals(np.linalg.solve(squeeze, -mean_spin * film)))
    s, w = (1 - e) * (1 + e), mean_spin
    squeeze = np.array([[-math.pi * (2 + e * e) / 2, 3 * math.pi * e / 2], [-2 * s**0.5, 2 * e * s**0.5]]) / s**2.5
    film = w * np.array(
        [
            [2 * e * (s - 4) / s**3, 2 * (s + 4 * e * e) / s**3],
            [-1.5 * math.pi * e / s**2.5, 0.5 * math.pi * (s + 3 * e * e) / s**2.5],
        ]
    )
    return np.sort_complex(np.linalg.eigvals(np.linalg.solve(squeeze, -film)))


# --- The ring let go ----------------------------------------------------------------------------------

# Ludwig & Allen's ring let go: friction and its support's tilt spring are all that hold the moment of its film.
#
# The ring turns and follows a seat that is tilted in space: seen from the shaft its tilt turns backwards, so its
# secondary seal slides all around, with the moment 4 R F_d / pi a quarter turn ahead of the tilt.  The support pulls
# along the tilt.  Both components of a steady film's moment are to be balanced, and the ring turns to where they are:
#
#     |M_film|^2 = (4 R F_d / pi)^2 + (K_s gamma)^2,      F_film = F_s
#
# With e = h1/h0, m = |M_film| / (R F_s), and the force and moments above:
#
#     m^2 = (pi/4)^2 (1 - e^2) + e^2,      h0^2 F_s / (mu U dR^3) = e / (1 - e^2)^2
#
# so there is a film for pi/4 < m < 1 only: below, the ring straightens and is squeezed onto its seat; above, no
# pressure between the faces has arm enough (R) and the ring hangs open.  Ludwig & Allen's film is the one whose support
# carries the moment about the tilt axis: K_s gamma = e R F_s.
#
# Under pressure (`edges`) both moments are those of `sealed_wedge.balance`, and pi/4 and 1 become `moment_limits`.  The
# load is small beside the pressures of the wedge, so m at e = 0 is larger, and from p R dR / F_s = 0.2 on it falls
# with e all the way to 1: a film that tilts more is held with less moment, and no released ring keeps one.
#
# **Source** derived here from Ludwig & Allen, NASA TN D-8102 (1976); confirmed in time by
# studies/sealing_number/released.py.
# **Valid** their assumptions; ring that slides on its secondary seal all around, no support damping,
# seat tilted by more than h1/R.  `guide` is K_s gamma / (R F_s), `group` mu U dR^3 / F_s in m^2.
#
# Where the seat turns and the ring stands (FMS) the ring nods at the shaft's speed w, and its inertia acts at right
# angles to the friction: guide = (I w^2 - K_s) gamma / (R F_s), of either sign, and
#
#     m^2 = (4 / (pi q))^2 + guide^2
#
# so that inertia carries a film as friction does, from no speed (m = 4 / (pi q)) to no friction (m = guide).

# Moment over R F_s that a film without pressure carries between parallel faces, its least.
LEAST_MOMENT = math.pi / 4


def moment_ratio(force_ratio, guide=0.0):
    """|M_film| / (R F_s), dimensionless, that friction (`force_ratio` q = F_s / F_d) and support (`guide`) ask for;
    scalars or arrays.  **Source**, **Valid** as the module."""
    return np.hypot(4 / (math.pi * np.asarray(force_ratio, dtype=float)), guide)[()]


def film(force_ratio: float, guide: float, group: float, edges: sealed.Edges = NO_PRESSURE) -> tuple[float, float]:
    """Mean film h0 and amplitude h1 (m) of the released ring; scalar arguments: `force_ratio` q = F_s / F_d, `guide`,
    `group` (m^2).  **Source**, **Valid** as the module.

    **Raises** ValueError that says whether the ring straightens or hangs up.
    """
    m = float(moment_ratio(force_ratio, guide))
    least, most, widest = sealed.moment_limits(edges)
    if not m < most:
        known = f"{most:.4g} " if edges.sealed else ""
        raise ValueError(f"hang-up: friction and support ask for {m:.4g} R F_s, a film carries at most {known}R F_s")
    if not m > least:
        known = f"{least:.4g}" if edges.sealed else "pi/4"
        raise ValueError(
            f"straightens: a film's moment is at least {known} R F_s, friction and support hold {m:.4g} R F_s"
        )
    if edges.sealed:
        e = brentq(lambda e: math.hypot(*sealed.balance(e, edges)[1:]) - m, sealed.FLAT, widest, xtol=1e-14)
    else:
        e = math.sqrt((m**2 - LEAST_MOMENT**2) / (1 - LEAST_MOMENT**2))
    mean = math.sqrt(group * sealed.balance(e, edges)[0])
    return mean, e * mean


def film_range(guide: float = 0.0, edges: sealed.Edges = NO_PRESSURE) -> tuple[float, float]:
    """Force ratios F_s / F_d between which the released ring has a film: it hangs up below and straightens above (inf:
    never); scalar `guide`.  **Source**, **Valid** as the module."""
    least, most, _ = sealed.moment_limits(edges)

    def beyond(moment):
        return math.inf if abs(guide) >= moment else 4 / math.pi / math.sqrt(moment**2 - guide**2)

    return beyond(most), beyond(least)


def closed_form_guide(force_ratio: Real, edges: sealed.Edges = NO_PRESSURE) -> Real:
    """K_s gamma / (R F_s), dimensionless, with which the released ring keeps Ludwig & Allen's film at `force_ratio` q:
    h1/h0 of it; under pressure its moment about the tilt axis.

    **Source** derived here.  **Valid** q >= `least_force_ratio`.  **Raises** ValueError below it: hang-up.
    """
    share = amplitude_ratio(force_ratio, edges)
    return -_films_at(force_ratio, edges)[2] if edges.sealed else share
