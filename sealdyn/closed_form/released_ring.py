"""Ludwig & Allen's ring let go: friction and its support's tilt spring are all that hold the moment of its film.

The ring turns and follows a seat that is tilted in space: seen from the shaft its tilt turns backwards, so its
secondary seal slides all around, with the moment 4 R F_d / pi a quarter turn ahead of the tilt.  The support pulls
along the tilt.  Both components of a steady film's moment are to be balanced, and the ring turns to where they are:

    |M_film|^2 = (4 R F_d / pi)^2 + (K_s gamma)^2,      F_film = F_s

With e = h1/h0, m = |M_film| / (R F_s), and the force and moments of ludwig_allen.py:

    m^2 = (pi/4)^2 (1 - e^2) + e^2,      h0^2 F_s / (mu U dR^3) = e / (1 - e^2)^2

so there is a film for pi/4 < m < 1 only: below, the ring straightens and is squeezed onto its seat; above, no pressure
between the faces has arm enough (R) and the ring hangs open.  Ludwig & Allen's film is the one whose support carries
the moment about the tilt axis: K_s gamma = e R F_s.

**Source** derived here from Ludwig & Allen, NASA TN D-8102 (1976); confirmed in time by
studies/sealing_number/released.py.
**Valid** their assumptions (ludwig_allen.py); ring that slides on its secondary seal all around, no support damping,
seat tilted by more than h1/R.  `guide` is K_s gamma / (R F_s), `group` mu U dR^3 / F_s in m^2.
"""

import math

import numpy as np

from . import ludwig_allen as closed

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
    least = math.inf if guide >= MOST_MOMENT else 4 / math.pi / math.sqrt(1 - guide**2)
    most = math.inf if guide >= LEAST_MOMENT else closed.LEAST_FORCE_RATIO / math.sqrt(1 - (guide / LEAST_MOMENT) ** 2)
    return least, most


def closed_form_guide(force_ratio: float) -> float:
    """K_s gamma / (R F_s), dimensionless, with which the released ring keeps Ludwig & Allen's film at `force_ratio` q:
    h1/h0 of it.

    **Source** derived here.  **Valid** q >= LEAST_FORCE_RATIO.  **Raises** ValueError below it: hang-up.
    """
    return float(closed.amplitude_ratio(force_ratio))
