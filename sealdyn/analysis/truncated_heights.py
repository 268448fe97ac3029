"""Faces whose highest asperities are worn flat: Gaussian heights that end at a plateau, and the film between them.

Two faces with rms roughness s each, cut off at t above their mean planes, touch on their plateaus alone, where the
mean film h is below 2 t: on the share Phi(-t/s)^2 of the area, however much below.  The film flows as between smooth
faces there and never thinner than 2 t.  The load of a contact that begins all at once jumps: a law to reproduce a
table with, not one to run.
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 2; that the film is a smooth one, not thinner than
the plateaus, is concluded from Table 2-7.
**Valid** aligned plane faces with waves of one order, standing.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from ..faces.geometry import (
    FORCE,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    VISCOSITY,
)
from ..faces.waviness import lay_waves
from ..films.reynolds.cavitation import balance, unknowns
from ..films.reynolds.mesh import (
    ANGLE_STEP,
    ANGLES,
    CAVITATION,
    CELLS,
    DRAG,
    RADIAL_STEP,
    SCALE,
    SECTORS,
    heights,
    parameters,
    table,
)
from ..films.reynolds.pressure import sum_up
from ..numerics.kernel import outer_kernel


@dataclass(frozen=True)
class Plateaus:
    """Faces cut off at `height` (m) each, that touch on `share` of the area; `strength` and `shear` of it (Pa)."""

    height: float
    share: float
    strength: float
    shear: float


def plateaus(roughness, truncation, strength, shear) -> Plateaus:
    """Both faces with the same rms heights, `roughness` (m) that of their sum, each cut off `truncation` of its own rms
    heights above its mean plane."""
    own = roughness / math.sqrt(2.0)
    return Plateaus(truncation * own, float(ndtr(-truncation)) ** 2, strength, shear)


def load_shares(film, waves, speed, faces: Plateaus, clearance) -> dict[str, float]:
    """Forces `film_force` and `contact_force` (N), `torque` (N m) and `leakage` (m^3/s, outer to inner radius) of a
    `Film` table between these faces at a clearance (m), the rotor turning at `speed` (rad/s) below a `waves`
    (Waviness) of the stator.  Raises ValueError where no cavities are found."""
    f, s = parameters(film, clearance), np.zeros(GAP_STATE_SIZE)
    lay_waves(f, [waves], [])
    s[MEAN_SPIN], s[SPIN_DIFFERENCE], s[VISCOSITY] = 0.5 * speed, speed, film.viscosity
    s[INNER_PRESSURE], s[OUTER_PRESSURE] = film.inner_pressure, film.outer_pressure
    leakage, sheared = _film(f, s, 2.0 * faces.height, unknowns(f))
    if not leakage < math.inf:
        raise ValueError("no pressures of the cavitating film are found")
    # Of one wave: where h is below the plateaus.
    low = (2.0 * faces.height - clearance) / waves.amplitude if waves.amplitude else math.inf
    touching = faces.share * math.acos(-min(max(low, -1.0), 1.0)) / math.pi
    inner, outer = film.inner_radius, film.outer_radius
    rubbed = 2.0 * math.pi / 3.0 * (outer**3 - inner**3) * touching * faces.shear
    return {"film_force": float(s[FORCE]), "contact_force": touching * faces.strength * math.pi * (outer**2 - inner**2),
            "torque": film.viscosity * speed * sheared + rubbed, "leakage": leakage}  # fmt: skip


@outer_kernel()
def _film(f, s, least, u):
    """Force of the film between smooth faces not nearer than `least` (m), into the gap state; returns the flow from the
    outer to the inner radius (m^3/s), infinite where none is found, and int r^3/h dr dtheta (m^3)."""
    angles, cells = int(f[ANGLES]), int(f[CELLS])
    nodes, middle, nothing = np.empty((angles, cells)), np.empty((angles, cells)), np.zeros((angles, cells))
    around, ways = np.empty((angles, cells)), np.empty((angles, cells + 1))
    heights(f, s, nodes, middle, ways)
    per, drag, sheared = 1.0 / (12.0 * s[VISCOSITY]), table(f, DRAG), 0.0
    over, along = per * f[ANGLE_STEP] / f[RADIAL_STEP], per * f[RADIAL_STEP] / f[ANGLE_STEP]
    for k in range(angles):
        for j in range(cells):
            middle[k, j] = max(middle[k, j], least)
            around[k, j] = along * middle[k, j] ** 3
            sheared += drag[j] / max(nodes[k, j], least)
        for j in range(cells + 1):
            ways[k, j] = (2.0 if j == 0 or j == cells else 1.0) * over * max(ways[k, j], least) ** 3
    if balance(f, s, middle, ways, around, nothing, nothing, u) == 0:
        return np.inf, np.inf
    sum_up(f, s, u)
    leakage = 0.0
    for k in range(angles):
        leakage += ways[k, cells] * (s[OUTER_PRESSURE] - f[CAVITATION] - f[SCALE] * max(u[k, cells - 1], 0.0))
    return f[SECTORS] * leakage, f[SECTORS] * f[ANGLE_STEP] * sheared
