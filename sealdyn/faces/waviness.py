"""Waves around the faces: what they add to the film thickness, each turning with its ring.

    stator  + a cos(n (theta - stator angle) + phase)
    rotor   - a cos(n (theta - rotor angle) + phase)

since the gap is the stator's surface less the rotor's and both heights are counted along the shaft.  A wave is the same
at every radius.  Its row in the face block `f`: sign, order, amplitude (m), phase (rad), and which of the list of
different orders it has.  `s` is a gap state (faces/geometry.py).
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979): waviness h_n cos(n theta) of one face.
**Valid** waves far lower than they are long.
"""

import math

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel
from .geometry import (
    FACE_SIZE,
    MEAN_SPIN,
    ORDER_LIST,
    ORDERS,
    ROTOR_ANGLE,
    SPIN_DIFFERENCE,
    STATOR_ANGLE,
    WAVE_ROW,
    WAVE_ROWS,
    WAVES,
)

SIGN, ORDER, AMPLITUDE, PHASE, PLACE = range(WAVE_ROW)


def lay_waves(f, stator, rotor) -> None:
    """Write the waves of both rings' faces (lists of Waviness) into a face block; flat ones are left out."""
    waves = [(sign, w) for sign, face in ((1.0, stator), (-1.0, rotor)) for w in face if w.amplitude != 0.0]
    orders = sorted({wave.order for _, wave in waves})
    f[WAVES], f[ORDERS] = len(waves), len(orders)
    f[ORDER_LIST:WAVE_ROWS][: len(orders)] = orders
    rows = [(sign, wave.order, wave.amplitude, wave.phase, orders.index(wave.order)) for sign, wave in waves]
    f[WAVE_ROWS:FACE_SIZE][: WAVE_ROW * len(rows)] = np.array(rows).ravel()


def wave_rows(f) -> np.ndarray:
    """Rows (waves, WAVE_ROW) of a face block."""
    return f[WAVE_ROWS : WAVE_ROWS + WAVE_ROW * int(f[WAVES])].reshape(-1, WAVE_ROW)


def highest_orders(f) -> tuple[int, int]:
    """Highest order (waves to the circle) on the stator's and on the rotor's face of a block, 0 without waves."""
    rows = wave_rows(f)
    return tuple(int(max(rows[rows[:, SIGN] == sign, ORDER], default=0)) for sign in (1.0, -1.0))


@inner_kernel()
def waves(f, s, theta):
    """What the waves add to the film thickness (m) at an angle (rad, from the x axis)."""
    total = 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned = s[STATOR_ANGLE] if f[row + SIGN] > 0.0 else s[ROTOR_ANGLE]
        total += f[row + SIGN] * f[row + AMPLITUDE] * math.cos(f[row + ORDER] * (theta - turned) + f[row + PHASE])
    return total


@inner_kernel()
def waves_rate(f, s, theta):
    """Rate (m/s) of `waves` at a fixed angle (rad): each wave passes with its ring's spin."""
    total = 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned, spin = s[STATOR_ANGLE], s[MEAN_SPIN] - 0.5 * s[SPIN_DIFFERENCE]
        if f[row + SIGN] < 0.0:
            turned, spin = s[ROTOR_ANGLE], s[MEAN_SPIN] + 0.5 * s[SPIN_DIFFERENCE]
        slope = f[row + ORDER] * math.sin(f[row + ORDER] * (theta - turned) + f[row + PHASE])
        total += f[row + SIGN] * f[row + AMPLITUDE] * spin * slope
    return total


@inner_kernel()
def waves_turn(f, s):
    """Whether the ring of a wave turns."""
    for k in range(int(f[WAVES])):
        half = 0.5 * s[SPIN_DIFFERENCE]
        if s[MEAN_SPIN] + (half if f[WAVE_ROWS + WAVE_ROW * k + SIGN] < 0.0 else -half) != 0.0:
            return True
    return False


@inner_kernel()
def wave_parts(f, s, cosines, sines):
    """Waves of both faces together, sum of `cosines[j] cos(n theta) + sines[j] sin(n theta)` (m) over the different
    orders n of the face block, both (orders,)."""
    cosines[:], sines[:] = 0.0, 0.0
    for k in range(int(f[WAVES])):
        row = WAVE_ROWS + WAVE_ROW * k
        turned = s[STATOR_ANGLE] if f[row + SIGN] > 0.0 else s[ROTOR_ANGLE]
        at, angle = int(f[row + PLACE]), f[row + PHASE] - f[row + ORDER] * turned
        cosines[at] += f[row + SIGN] * f[row + AMPLITUDE] * math.cos(angle)
        sines[at] -= f[row + SIGN] * f[row + AMPLITUDE] * math.sin(angle)


@outer_kernel()
def wave_parts_along(f, gaps):
    """`wave_parts` at gap states `gaps` (m, GAP_STATE_SIZE): cosine and sine parts (m), shape (m, orders, 2)."""
    parts = np.empty((len(gaps), int(f[ORDERS]), 2))
    for k in range(len(gaps)):
        wave_parts(f, gaps[k], parts[k, :, 0], parts[k, :, 1])
    return parts
