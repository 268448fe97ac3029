"""Secondary seal (O-ring): Coulomb friction along its circle, as the axial force and moment on the ring.

**Source** Ludwig & Allen, NASA TN D-8102 (1976); the circle integral of -F' sign(v) for a rigid ring, whose sliding
speed is a constant plus a first harmonic, v = z' + R (q_x sin(theta) - q_y cos(theta)):

    u = R |q|,  a = z'/u clipped to [-1, 1]:   force -4 R F' asin(a),   moment -4 R^2 F' sqrt(1 - a^2) q/|q|

Nothing sticks partially: the ring slides everywhere (or along a line), or is stuck with all three speeds zero.
The loads it can hold while stuck fill the limit surface |M| / (4 R^2 F') = cos(pi/2 |F| / (2 pi R F')).
**Valid** uniform line friction, rigid ring, no dependence on speed.
"""

import math

from ..numerics.kernel import inner_kernel, value_kernel
from .equations import (
    AT_TILT,
    AT_Z,
    FOLLOWING,
    INERTIA,
    MASS,
    NET,
    ONSET,
    OWN_STATE,
    PER_SEAL,
    RING,
    SEAL_BAND,
    SEAL_EXCESS,
    SEAL_LINE,
    SEAL_RADIUS,
    SEAL_SMOOTH,
    SEAL_SPEED,
    SEALS,
    STUCK,
)
from .imposed_motion import (
    PER_RING,
    TILT_X,
    TILT_X_ACCELERATION,
    TILT_X_RATE,
    TILT_Y,
    TILT_Y_ACCELERATION,
    TILT_Y_RATE,
    Z_ACCELERATION,
    Z_RATE,
)


@inner_kernel()
def sliding(v, q_x, q_y, line, radius, band, smooth, out):
    """Axial force (N) and moments (N m) on a ring that slides, into out[0:3]; returns its sliding speed (m/s).

    `v` axial speed (m/s), `q_x`, `q_y` tilt rates (rad/s) relative to what the ring slides on; `line` friction (N/m),
    `radius` (m); `band` sliding speed (m/s) below which the friction fades linearly (Coulomb: no ring comes to be that
    slow), or the width of the `smooth` law.
    **Source**, **Valid** as the module.
    """
    q = math.hypot(q_x, q_y)
    u = radius * q
    speed = math.hypot(v, u)
    if speed == 0.0:
        out[0] = out[1] = out[2] = 0.0
        return 0.0
    fade = speed / math.hypot(speed, band) if smooth else min(speed / band, 1.0)
    if u == 0.0:
        out[0], out[1], out[2] = -math.copysign(2.0 * math.pi * radius * line, v) * fade, 0.0, 0.0
        return speed
    a = min(max(v / u, -1.0), 1.0)
    out[0] = -4.0 * radius * line * math.asin(a) * fade
    # Close to |a| = 1 the product form does not cancel.
    moment = -4.0 * radius**2 * line * math.sqrt((1.0 - a) * (1.0 + a)) * fade / q
    out[1], out[2] = moment * q_x, moment * q_y
    return speed


@inner_kernel()
def excess(force, moment_x, moment_y, line, radius):
    """How far a load (N, N m) lies outside the limit surface of a stuck ring: negative inside, 0 on it, in units of the
    largest moment (or, beyond the largest force, of that force); `line` friction (N/m), `radius` (m).
    **Source**, **Valid** as the module."""
    held = 2.0 * math.pi * radius * line
    most = 4.0 * radius**2 * line
    if line == 0.0:
        return 1.0
    f, m = abs(force) / held, math.hypot(moment_x, moment_y) / most
    return m - math.cos(0.5 * math.pi * min(f, 1.0)) + max(f - 1.0, 0.0)


@value_kernel()
def friction_on_ring(k, spin, spin_rate, p, w):
    """Friction of ring k's secondary seal onto its net load; returns the power of that friction."""
    ring, c, x, net, seal = k * RING, k * PER_RING, OWN_STATE + 6 * k, NET + 3 * k, SEALS + PER_SEAL * k
    line, radius = p[ring + SEAL_LINE], p[ring + SEAL_RADIUS]
    v, v_x, v_y = w[x + Z_RATE], w[x + TILT_X_RATE], w[x + TILT_Y_RATE]
    d_x, d_y = w[x + TILT_X] - w[c + TILT_X], w[x + TILT_Y] - w[c + TILT_Y]
    dv_x, dv_y = v_x - w[c + TILT_X_RATE], v_y - w[c + TILT_Y_RATE]

    # What it would take to carry the ring along with its carrier.
    follow = w[seal + FOLLOWING : seal + FOLLOWING + 3]
    follow[0] = w[c + Z_ACCELERATION]
    follow[1] = w[c + TILT_X_ACCELERATION] - spin * dv_y - spin_rate * d_y
    follow[2] = w[c + TILT_Y_ACCELERATION] + spin * dv_x + spin_rate * d_x
    force = p[ring + MASS] * follow[0] - w[net] if p[ring + AT_Z] >= 0.0 else 0.0
    moment_x = moment_y = 0.0
    if p[ring + AT_TILT] >= 0.0:
        moment_x = p[ring + INERTIA] * follow[1] - w[net + 1]
        moment_y = p[ring + INERTIA] * follow[2] - w[net + 2]
    w[seal + SEAL_EXCESS] = excess(force, moment_x, moment_y, line, radius)

    friction = w[seal : seal + 3]
    if p[ring + STUCK] != 0.0:
        friction[0], friction[1], friction[2] = force, moment_x, moment_y
        w[seal + SEAL_SPEED] = 0.0
    else:
        s, s_x, s_y = v - w[c + Z_RATE], dv_x + spin * d_y, dv_y - spin * d_x
        w[seal + SEAL_SPEED] = math.hypot(s, radius * math.hypot(s_x, s_y))
        # The velocity of the onset beside its own gives friction a direction at standstill (stick_slip.py).
        sliding(
            s + p[ring + ONSET], s_x + p[ring + ONSET + 1], s_y + p[ring + ONSET + 2],
            line, radius, p[ring + SEAL_BAND], p[ring + SEAL_SMOOTH] != 0.0, friction,
        )  # fmt: skip
    for i in range(3):
        w[net + i] += friction[i]
    return friction[0] * v + friction[1] * v_x + friction[2] * v_y
