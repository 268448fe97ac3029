"""A ring kept from following its misaligned seat by secondary-seal friction, carried by the wedge of its own tilt.

**Source** Ludwig, L. P. & Allen, G. P., "Face-seal lubrication. II - Theory of response to angular misalignment", NASA
TN D-8102 (1976); eigenvalues and the moment about the tilt axis derived here from their film.
**Valid** zero sealed pressure, film `h = h0 + h1 cos(theta)` constant over a narrow face (short bearing), pressure
ambient in the diverging half, no inertia.  U is the sliding speed at the mean radius R, dR the face width, F_s the
spring force, F_d the friction force on one half of the secondary seal, q = F_s / F_d.
Arguments: `viscosity` mu (Pa s), `sliding_speed` U (m/s), `face_width` dR, `mean_radius` R, `mean_film` h0 and
`amplitude` h1 (m), forces (N), `force_ratio` q; scalars or arrays that broadcast.
"""

import math
from typing import NamedTuple

import numpy as np

from . import ludwig_allen as closed

Real = float | np.ndarray

# Below this ratio of spring to friction force no film balances both: 16 / pi^2 = 1.6211.
LEAST_FORCE_RATIO = 16 / math.pi**2
# Below this one the balance exists but repels: where the real part of `eigenvalues` changes sign (h1/h0 = 0.3235).
LEAST_ATTRACTING_FORCE_RATIO = 1.7132380648575958


class Published(NamedTuple):
    """One printed row: force ratio q, mean film h0 and least film h0 - h1 (m; None: not printed)."""

    force_ratio: float
    mean_film: float
    least_film: float | None


# The example's inputs are lost but for the face width; all printed h0 give this mu U dR^3 / F_s (m^2).
LUDWIG_ALLEN = (Published(2.0, 0.71e-6, 0.30e-6), Published(5.0, 5.69e-6, None))
LUDWIG_ALLEN_GROUP = 3.79e-13
LUDWIG_ALLEN_FACE_WIDTH = 1.02e-3


def _open(mean_film: Real, amplitude: Real) -> Real:
    """h0^2 - h1^2 (m^2); ValueError if the faces touch."""
    if not np.all(np.abs(amplitude) < mean_film):
        raise ValueError("film: the amplitude h1 must be smaller than the mean film h0")
    return np.subtract(mean_film, amplitude) * np.add(mean_film, amplitude)


def wedge_pressure(viscosity: Real, sliding_speed: Real, face_width: Real, mean_radius: Real,
                   film: Real, film_slope: Real) -> Real:  # fmt: skip
    """Pressure (Pa) averaged over the face width, `-(mu U dR^2 / 2R) h^-3 dh/dtheta`, ambient where that is negative.

    `film` in m, `film_slope` dh/dtheta in m/rad.  **Source**, **Valid**, other arguments as the module.
    """
    return np.maximum(-viscosity * sliding_speed * face_width**2 / (2 * mean_radius) * film_slope / film**3, 0.0)


def wedge_force(viscosity: Real, sliding_speed: Real, face_width: Real, mean_film: Real, amplitude: Real) -> Real:
    """Force (N) of the wedge, `mu U dR^3 h0 h1 / (h0^2 - h1^2)^2`.

    **Source**, **Valid**, arguments as the module.  **Raises** ValueError when the faces touch.
    """
    return viscosity * sliding_speed * face_width**3 * mean_film * amplitude / _open(mean_film, amplitude) ** 2


def sine_moment(viscosity: Real, sliding_speed: Real, face_width: Real, mean_radius: Real,
                mean_film: Real, amplitude: Real) -> Real:  # fmt: skip
    """Moment (N m) about the diameter through thickest and thinnest film, perpendicular to the tilt axis:
    `(pi/4) mu U R dR^3 h1 / (h0^2 - h1^2)^(3/2)`.

    **Source** as the module, with R_o^2 - R_i^2 = 2 R dR.  **Valid**, arguments as the module; over a face of finite
    width the arm is longer by dR^2 / (20 R^2).  **Raises** ValueError when the faces touch.
    """
    strength = math.pi / 4 * viscosity * sliding_speed * mean_radius * face_width**3
    return strength * amplitude / _open(mean_film, amplitude) ** 1.5


def cosine_moment(viscosity: Real, sliding_speed: Real, face_width: Real, mean_radius: Real,
                  mean_film: Real, amplitude: Real) -> Real:  # fmt: skip
    """Moment (N m) about the tilt axis, negative: it straightens the ring; `-mu U R dR^3 h1^2 / (h0^2 - h1^2)^2`.

    **Source** derived here; Ludwig & Allen leave it unbalanced.  **Valid**, arguments as the module.
    **Raises** ValueError when the faces touch.
    """
    strength = viscosity * sliding_speed * mean_radius * face_width**3
    return -strength * amplitude**2 / _open(mean_film, amplitude) ** 2


def friction_moment(friction_force: Real, mean_radius: Real) -> Real:
    """Moment (N m) `4 R F_d / pi` of the friction on both halves of the secondary seal.  **Source**, arguments as the
    module: F_d in N, R in m."""
    return 4 * mean_radius * friction_force / math.pi


def amplitude_ratio(force_ratio: Real) -> Real:
    """h1 / h0 `= sqrt(1 - (256 / pi^4) / q^2)`, dimensionless.

    **Source** as the module.  **Valid** q >= LEAST_FORCE_RATIO.  **Raises** ValueError below it: hang-up.
    """
    if not np.all(np.greater_equal(force_ratio, LEAST_FORCE_RATIO)):
        raise ValueError(
            f"hang-up: no film balances friction and spring below F_s/F_d = 16/pi^2 = {LEAST_FORCE_RATIO:.4f}"
        )
    ratio = np.divide(LEAST_FORCE_RATIO, force_ratio)
    return np.sqrt((1 - ratio) * (1 + ratio))[()]


def sealing_number(force_ratio: Real) -> Real:
    """`h0^2 F_s / (mu U dR^3) = (pi^4/256)^2 q^4 h1/h0`, dimensionless, a function of q alone.

    **Source** as the module.  **Valid** q >= LEAST_FORCE_RATIO.  **Raises** ValueError below it: hang-up.
    """
    return (np.divide(force_ratio, LEAST_FORCE_RATIO) ** 4 * amplitude_ratio(force_ratio))[()]


def equilibrium(force_ratio: Real, group: Real) -> tuple[Real, Real]:
    """Mean film h0 and amplitude h1 (m) for q and `group` = mu U dR^3 / F_s (m^2).

    **Source** as the module.  **Valid** q >= LEAST_FORCE_RATIO.  **Raises** ValueError below it: hang-up.
    """
    mean_film = np.sqrt(sealing_number(force_ratio) * group)
    return mean_film, mean_film * amplitude_ratio(force_ratio)


def eigenvalues(force_ratio: float, mean_spin: float) -> np.ndarray:
    """The two eigenvalues (2,) (1/s, complex) of h0, h1 under force and sine moment, squeeze included; scalar
    arguments.

    `A h' + B h = 0` with A, B the derivatives of the half film's force and sine moment, all elementary integrals over
    the half circle; proportional to `mean_spin` (rad/s, half the shaft's speed over a still seat).
    **Source** derived here.  **Valid** as the module, q > LEAST_FORCE_RATIO; small motion about the equilibrium.
    **Raises** ValueError below LEAST_FORCE_RATIO: hang-up.
    """
    e = float(amplitude_ratio(force_ratio))
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

# Moment over R F_s that a film carries: least (parallel faces), most (the whole load at the arm R).
LEAST_MOMENT, MOST_MOMENT = math.pi / 4, 1.0


def moment_ratio(force_ratio, guide=0.0):
    """|M_film| / (R F_s), dimensionless, that friction (`force_ratio` q = F_s / F_d) and support (`guide`) ask for;
    scalars or arrays.  **Source**, **Valid** as the module."""
    return np.hypot(4 / (math.pi * np.asarray(force_ratio, dtype=float)), guide)[()]


def film(force_ratio: float, guide: float, group: float) -> tuple[float, float]:
    """Mean film h0 and amplitude h1 (m) of the released ring; scalar arguments: `force_ratio` q = F_s / F_d, `guide`,
    `group` (m^2).  **Source**, **Valid** as the module.

    **Raises** ValueError that says whether the ring straightens or hangs up.
    """
    m = float(moment_ratio(force_ratio, guide))
    if not m < MOST_MOMENT:
        raise ValueError(f"hang-up: friction and support ask for {m:.4g} R F_s, a film carries at most R F_s")
    if not m > LEAST_MOMENT:
        raise ValueError(
            f"straightens: a film's moment is at least pi/4 R F_s, friction and support hold {m:.4g} R F_s"
        )
    e = math.sqrt((m**2 - LEAST_MOMENT**2) / (1 - LEAST_MOMENT**2))
    mean = math.sqrt(group * e) / (1 - e * e)
    return mean, e * mean


def film_range(guide: float = 0.0) -> tuple[float, float]:
    """Force ratios F_s / F_d between which the released ring has a film: it hangs up below and straightens above (inf:
    never); scalar `guide`.  **Source**, **Valid** as the module."""
    guide = abs(guide)
    least = math.inf if guide >= MOST_MOMENT else 4 / math.pi / math.sqrt(1 - guide**2)
    most = math.inf if guide >= LEAST_MOMENT else closed.LEAST_FORCE_RATIO / math.sqrt(1 - (guide / LEAST_MOMENT) ** 2)
    return least, most


def closed_form_guide(force_ratio: float) -> float:
    """K_s gamma / (R F_s), dimensionless, with which the released ring keeps Ludwig & Allen's film at `force_ratio` q:
    h1/h0 of it.

    **Source** derived here.  **Valid** q >= LEAST_FORCE_RATIO.  **Raises** ValueError below it: hang-up.
    """
    return float(closed.amplitude_ratio(force_ratio))
