"""Leakage and friction of the narrow seal at any gap, for films that know their forces alone.

**Source** conductance `h^3/(12 mu)` and drag `mu r w/h` of parallel faces, integrated over the width of a cone in
closed form, angle by angle around the circle.
**Valid** laminar flow, without squeeze and without what the pressure does on the slope of a wave; of a gas isothermal
and viscous.
"""

import math

from ..faces.film_thickness import film_thickness
from ..faces.geometry import (
    CLEARANCE,
    CONING,
    DZ,
    FLOOR,
    GX,
    GY,
    INNER_PRESSURE,
    INNER_RADIUS,
    MOMENT_X,
    MOMENT_Y,
    ORDER_LIST,
    ORDERS,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    SPIN_DIFFERENCE,
    TEMPERATURE,
    TILT_AT_MEAN,
    VISCOSITY,
    WAVES,
    regularised_thickness,
)
from ..numerics.kernel import inner_kernel
from ..scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE

FLOW_ANGLES = 64


def normal_conditions(film) -> float:
    """Normal temperature over normal pressure (K/Pa) of a `Film` table with a gas; 0 with a liquid."""
    return 0.0 if film.gas is None else NORMAL_TEMPERATURE / NORMAL_PRESSURE


@inner_kernel()
def narrow_seal(f, s, normal):
    """Flow in +r (m^3/s; of a gas at normal conditions, `normal` not 0) and friction torque on the rotor (N m), whose
    forces stand in the gap state `s`; `f` a face block."""
    r_i, r_o, floor = f[INNER_RADIUS], f[OUTER_RADIUS], f[FLOOR]
    width, r_m = r_o - r_i, 0.5 * (r_i + r_o)
    tilt = math.hypot(s[GX], s[GY])
    swing_i, swing_o = r_i * tilt, r_o * tilt
    if f[TILT_AT_MEAN] != 0.0:
        swing_i = swing_o = r_m * tilt
    conductance = drag = 0.0
    angles = FLOW_ANGLES
    if f[WAVES] != 0.0:
        angles *= int(f[ORDER_LIST + int(f[ORDERS]) - 1])
    for j in range(angles):
        angle = 2.0 * math.pi * j / angles
        if f[WAVES] == 0.0:
            # Counted from the thinnest place.
            cos_b = math.cos(angle)
            h_i = regularised_thickness(f[CLEARANCE] + s[DZ] - swing_i * cos_b, floor)
            h_o = regularised_thickness(f[CLEARANCE] + s[DZ] + f[CONING] * width - swing_o * cos_b, floor)
        else:
            h_i = regularised_thickness(film_thickness(f, s, r_i, angle), floor)
            h_o = regularised_thickness(film_thickness(f, s, r_o, angle), floor)
        conductance += 2.0 * (h_i * h_o) ** 2 / (width * (h_i + h_o))
        change = (h_o - h_i) / h_i
        drag += width / h_i * (math.log1p(change) / change if abs(change) > 1e-9 else 1.0)
    d_theta = 2.0 * math.pi / angles
    drop = s[OUTER_PRESSURE] - s[INNER_PRESSURE]
    volume = -r_m * drop * d_theta * conductance / (12.0 * s[VISCOSITY])
    if normal != 0.0:
        # Isothermal, at the mean pressure: p^2 falls as the pressure of a liquid.
        volume *= 0.5 * (s[INNER_PRESSURE] + s[OUTER_PRESSURE]) * normal / s[TEMPERATURE]
    twist = 0.5 * (s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X])
    return volume, s[VISCOSITY] * s[SPIN_DIFFERENCE] * r_m**3 * d_theta * drag + twist
