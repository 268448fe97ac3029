"""Equations of motion of the two rings in the solver's inner loop.

**Source** Green (1989), eqs. 1-6; Green & Etsion (1985) for the flexibly mounted stator; one equation for
both rings (k = stator, rotor; W_k the spin of the carrier; sg = +1 stator, -1 rotor):

    m z'' = sg (F_film - F_closing) - D_z (z' - z_c') - K_z (z - z_c) + F_load
    I gamma'' = sg M_film + i J W gamma' - D_s [(gamma - gamma_c)' - i W (gamma - gamma_c)]
                - K_s e - dK exp(2 i (phi_k + a)) conj(e) + M_mass,   e = gamma - gamma_c - gamma_own

dK of a support with two tilt stiffnesses, whose axes, at `a`, turn with the carrier (phi_k); M_mass the moment of a
centre of mass off the axis, of unbalance and weight, and of a load from outside (scene/forces.py), as F_load is.
Offset faces: faces/geometry.py.
**Valid** small tilts (1e-4 rad: exact to 1e-8); a changing speed drops -i J W' gamma.
Contact of the faces adds to F_film and M_film; friction of a secondary seal (dynamics/secondary_seal.py) acts on
its ring, and a ring that sticks rigidly follows its carrier: gamma' = gamma_c' + i W (gamma - gamma_c).

Unknowns `y`: displacements, then their rates (a massless ring has none), those of the film if it has any, with contact
or a secondary seal the impulse of contact, then the works and the sum of absolute works.  Parameter block `p`: both
rings, the index of the works, whether there are two more of them, then the imposed motion of the segment
(dynamics/imposed_motion.py).
"""

import math

from ..faces.geometry import (
    CONING_CHANGE,
    CONING_RATE,
    CONTACT_FORCE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    DZ_RATE,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OFFSET_SIZE,
    OUTER_PRESSURE,
    ROTOR_ANGLE,
    SPIN_DIFFERENCE,
    STATOR_ANGLE,
    TEMPERATURE,
    VISCOSITY,
    shift,
    wide_ring,
)
from ..numerics.kernel import call_seal, inner_kernel, outer_kernel
from .imposed_motion import (
    CLOSING_AT,
    INNER_AT,
    LOAD_X,
    LOAD_Y,
    LOAD_Z,
    OUTER_AT,
    OWN_X,
    OWN_X_RATE,
    OWN_Y,
    OWN_Y_RATE,
    PER_RING,
    ROTOR_ANGLE_AT,
    ROTOR_SPEED,
    STATOR_ANGLE_AT,
    STATOR_SPEED,
    TEMPERATURE_AT,
    TILT_X,
    TILT_X_RATE,
    TILT_Y,
    TILT_Y_RATE,
    VISCOSITY_AT,
    Z_RATE,
    Z,
    coning_at,
    imposed_state,
)

# Slots of one ring in the parameter block: it floats?, inertia, support, where its unknowns are in `y`
# (-1: not an unknown) and where their rates are (-1: massless, the rate is the derivative itself); its secondary seal:
# friction per length, radius, sliding speed below which it fades, a smooth law?, whether it sticks now, the velocity of
# its onset (m/s, rad/s, rad/s), and the address of its kernel (dynamics/secondary_seal.py), so that only scenes with a
# seal compile it.
FLOATS, MASS, INERTIA, POLAR, AXIAL_K, AXIAL_D, TILT_K, TILT_D, AT_Z, AT_TILT, AT_Z_RATE, AT_TILT_RATE = range(12)
SEAL_LINE, SEAL_RADIUS, SEAL_BAND, SEAL_SMOOTH, STUCK, ONSET, SEAL_KERNEL = 12, 13, 14, 15, 16, 17, 20
# Half the difference of two tilt stiffnesses, and the angle of the first one's axis; where in `p` the elements of a
# secondary seal that gives begin (secondary_seal.py), 0 without one.
UNEVEN_K, AXIS, SEAL_AT = 21, 22, 23
RING = 24
WORKS_AT = 2 * RING
EXTENDED = WORKS_AT + 1
# Offset faces.
OFFSET = WORKS_AT + 2
LEG_AT = OFFSET + OFFSET_SIZE

# Scratch `w`: imposed state of both rings, their own state, the net force and moments on each; then per ring the
# friction of its secondary seal, its sliding speed, how far what it must hold lies outside what it can, and the
# acceleration that follows the carrier; the cosine and sine of twice the angle of an uneven support, and those of the
# carrier's own angle where a secondary seal gives; the centre of the narrower face (m).
OWN_STATE = 2 * PER_RING
NET = OWN_STATE + 2 * 6
SEALS = NET + 2 * 3
SEAL_SPEED, SEAL_EXCESS, FOLLOWING = 3, 4, 5
PER_SEAL = 8
AXES = SEALS + 2 * PER_SEAL
TURN = AXES + 2 * 2
CENTRE = TURN + 2 * 2
SCRATCH = CENTRE + 2

# The works, in the order of `y`; the last two only with contact or a secondary seal.
WORKS = ("support_damper", "film", "closing", "carrier", "gyroscopic", "contact", "secondary_seal")
PLAIN = 5


@outer_kernel()
def kinematics(tau, y, yp, p, w, s):
    """Imposed motion, ring states and the gap state `s` (GAP_STATE_SIZE,) at segment time tau (s) and unknowns `y`
    (size,); `p` the parameters, `w` (SCRATCH,) scratch, which it fills.  `yp` is read only for the rates of a massless
    ring."""
    leg = p[LEG_AT:]
    imposed_state(tau, leg, w[: 2 * PER_RING])
    for k in range(2):
        ring, c, x = k * RING, k * PER_RING, OWN_STATE + 6 * k
        for i in range(6):
            w[x + i] = w[c + i]
        if p[ring + FLOATS] != 0.0:
            for i in range(6):
                w[x + i] = 0.0
            z, tilt = int(p[ring + AT_Z]), int(p[ring + AT_TILT])
            z_rate, tilt_rate = int(p[ring + AT_Z_RATE]), int(p[ring + AT_TILT_RATE])
            if z >= 0:
                w[x + Z] = y[z]
                w[x + Z_RATE] = y[z_rate] if z_rate >= 0 else yp[z]
            if tilt >= 0:
                w[x + TILT_X], w[x + TILT_Y] = y[tilt], y[tilt + 1]
                if tilt_rate >= 0:
                    w[x + TILT_X_RATE], w[x + TILT_Y_RATE] = y[tilt_rate], y[tilt_rate + 1]
                else:
                    w[x + TILT_X_RATE], w[x + TILT_Y_RATE] = yp[tilt], yp[tilt + 1]
    a, b = OWN_STATE, OWN_STATE + 6
    s[DZ], s[DZ_RATE] = w[a + Z] - w[b + Z], w[a + Z_RATE] - w[b + Z_RATE]
    s[GX], s[GX_RATE] = w[a + TILT_X] - w[b + TILT_X], w[a + TILT_X_RATE] - w[b + TILT_X_RATE]
    s[GY], s[GY_RATE] = w[a + TILT_Y] - w[b + TILT_Y], w[a + TILT_Y_RATE] - w[b + TILT_Y_RATE]
    spin_s = leg[STATOR_SPEED] + leg[STATOR_SPEED + 1] * tau
    spin_r = leg[ROTOR_SPEED] + leg[ROTOR_SPEED + 1] * tau
    s[STATOR_ANGLE] = leg[STATOR_ANGLE_AT] + tau * (leg[STATOR_SPEED] + 0.5 * leg[STATOR_SPEED + 1] * tau)
    s[ROTOR_ANGLE] = leg[ROTOR_ANGLE_AT] + tau * (leg[ROTOR_SPEED] + 0.5 * leg[ROTOR_SPEED + 1] * tau)
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = 0.5 * (spin_s + spin_r), spin_r - spin_s
    s[VISCOSITY] = leg[VISCOSITY_AT] + leg[VISCOSITY_AT + 1] * tau
    s[INNER_PRESSURE] = leg[INNER_AT] + leg[INNER_AT + 1] * tau
    s[OUTER_PRESSURE] = leg[OUTER_AT] + leg[OUTER_AT + 1] * tau
    s[TEMPERATURE] = leg[TEMPERATURE_AT] + leg[TEMPERATURE_AT + 1] * tau
    s[CONING_CHANGE], s[CONING_RATE] = coning_at(tau, leg)
    for k in range(2):
        if p[k * RING + UNEVEN_K] != 0.0:
            twice = 2.0 * ((s[STATOR_ANGLE] if k == 0 else s[ROTOR_ANGLE]) + p[k * RING + AXIS])
            w[AXES + 2 * k], w[AXES + 2 * k + 1] = math.cos(twice), math.sin(twice)
        if p[k * RING + SEAL_AT] != 0.0:
            angle = s[STATOR_ANGLE] if k == 0 else s[ROTOR_ANGLE]
            w[TURN + 2 * k], w[TURN + 2 * k + 1] = math.cos(angle), math.sin(angle)
    if p[OFFSET] != 0.0:
        wide = OWN_STATE + 6 * wide_ring(p[OFFSET:])
        shift(p[OFFSET:], w[wide : wide + 6], w[CENTRE:], s)


@inner_kernel()
def _tilt_springs(k, p, w):
    """Moments (N m) of ring k's support springs."""
    ring, c, x, axes = k * RING, k * PER_RING, OWN_STATE + 6 * k, AXES + 2 * k
    e_x = w[x + TILT_X] - w[c + TILT_X] - w[c + OWN_X]
    e_y = w[x + TILT_Y] - w[c + TILT_Y] - w[c + OWN_Y]
    uneven = p[ring + UNEVEN_K]
    if uneven == 0.0:
        return -p[ring + TILT_K] * e_x, -p[ring + TILT_K] * e_y
    return (
        -p[ring + TILT_K] * e_x - uneven * (w[axes] * e_x + w[axes + 1] * e_y),
        -p[ring + TILT_K] * e_y - uneven * (w[axes + 1] * e_x - w[axes] * e_y),
    )


@inner_kernel()
def _net(tau, k, p, w, s, power):
    """Net force and moments on ring k (without inertia) into the scratch; adds the powers of the elements and
    returns the springs' power."""
    leg = p[LEG_AT:]
    ring, c, x, net = k * RING, k * PER_RING, OWN_STATE + 6 * k, NET + 3 * k
    sign = 1.0 if k == 0 else -1.0
    spin_at = STATOR_SPEED if k == 0 else ROTOR_SPEED
    spin = leg[spin_at] + leg[spin_at + 1] * tau
    closing = leg[CLOSING_AT] + leg[CLOSING_AT + 1] * tau
    v, v_x, v_y = w[x + Z_RATE], w[x + TILT_X_RATE], w[x + TILT_Y_RATE]

    # Support: damper on the velocity relative to the turning carrier, spring from the ring's own rest tilt.
    d_x, d_y = w[x + TILT_X] - w[c + TILT_X], w[x + TILT_Y] - w[c + TILT_Y]
    damper = -p[ring + AXIAL_D] * (v - w[c + Z_RATE])
    damper_x = -p[ring + TILT_D] * (v_x - w[c + TILT_X_RATE] + spin * d_y)
    damper_y = -p[ring + TILT_D] * (v_y - w[c + TILT_Y_RATE] - spin * d_x)
    spring = -p[ring + AXIAL_K] * (w[x + Z] - w[c + Z])
    spring_x, spring_y = _tilt_springs(k, p, w)
    gyro_x, gyro_y = -p[ring + POLAR] * spin * v_y, p[ring + POLAR] * spin * v_x

    film_x, film_y, contact_x, contact_y = s[MOMENT_X], s[MOMENT_Y], s[CONTACT_X], s[CONTACT_Y]
    if p[OFFSET] != 0.0 and k == wide_ring(p[OFFSET:]):
        # Forces act at the centre of the narrower face.
        film_x, film_y = film_x + w[CENTRE + 1] * s[FORCE], film_y - w[CENTRE] * s[FORCE]
        contact_x, contact_y = contact_x + w[CENTRE + 1] * s[CONTACT_FORCE], contact_y - w[CENTRE] * s[CONTACT_FORCE]

    w[net] = sign * (s[FORCE] + s[CONTACT_FORCE] - closing) + damper + spring + w[c + LOAD_Z]
    w[net + 1] = sign * (film_x + contact_x) + damper_x + spring_x + gyro_x + w[c + LOAD_X]
    w[net + 2] = sign * (film_y + contact_y) + damper_y + spring_y + gyro_y + w[c + LOAD_Y]

    # An unknown that is not integrated (tilt of an axial scene, z of a tilt scene) has rate zero.
    power[0] += damper * v + damper_x * v_x + damper_y * v_y
    power[1] += sign * (s[FORCE] * v + film_x * v_x + film_y * v_y)
    power[2] -= sign * closing * v
    power[4] += gyro_x * v_x + gyro_y * v_y
    if len(power) > PLAIN:
        power[5] += sign * (s[CONTACT_FORCE] * v + contact_x * v_x + contact_y * v_y)
        if p[ring + SEAL_LINE] > 0.0:
            power[6] += call_seal(int(p[ring + SEAL_KERNEL]), k, spin, leg[spin_at + 1], p, w)
    return spring * v + spring_x * v_x + spring_y * v_y


@inner_kernel()
def _works(tau, p, w, s, yp, at):
    """Powers of the elements into yp[at:]: support dampers, film, closing force, carriers (and what turns with them:
    axes of springs, unbalance; weight, and loads from outside), gyroscopic term (zero), contact and secondary seals,
    and the sum of absolute powers, springs included; the contact force, whose integral is the impulse, just before
    them.  The springs' energy is a state function, so what counts as work is that of their moving ends (carrier, own
    misalignment)."""
    count = PLAIN
    if p[EXTENDED] != 0.0:
        count, yp[at - 1] = PLAIN + 2, s[CONTACT_FORCE]
    power = yp[at : at + count]
    for i in range(len(power)):
        power[i] = 0.0
    springs = 0.0
    for k in range(2):
        if p[k * RING + FLOATS] != 0.0:
            springs += _net(tau, k, p, w, s, power)
            ring, c, x = k * RING, k * PER_RING, OWN_STATE + 6 * k
            if p[ring + AT_Z] >= 0.0:
                power[3] -= p[ring + AXIAL_K] * (w[x + Z] - w[c + Z]) * w[c + Z_RATE]
                power[3] += w[c + LOAD_Z] * w[x + Z_RATE]
            if p[ring + AT_TILT] >= 0.0:
                m_x, m_y = _tilt_springs(k, p, w)
                power[3] += m_x * (w[c + TILT_X_RATE] + w[c + OWN_X_RATE])
                power[3] += m_y * (w[c + TILT_Y_RATE] + w[c + OWN_Y_RATE])
                power[3] += w[c + LOAD_X] * w[x + TILT_X_RATE] + w[c + LOAD_Y] * w[x + TILT_Y_RATE]
                if p[ring + UNEVEN_K] != 0.0:
                    # What turning the axes of its springs takes.
                    e_x = w[x + TILT_X] - w[c + TILT_X] - w[c + OWN_X]
                    e_y = w[x + TILT_Y] - w[c + TILT_Y] - w[c + OWN_Y]
                    spin_at = LEG_AT + (STATOR_SPEED if k == 0 else ROTOR_SPEED)
                    across = w[AXES + 2 * k] * 2.0 * e_x * e_y - w[AXES + 2 * k + 1] * (e_x * e_x - e_y * e_y)
                    power[3] += p[ring + UNEVEN_K] * across * (p[spin_at] + p[spin_at + 1] * tau)
    exchanged = abs(springs)
    for i in range(count):
        exchanged += abs(power[i])
    yp[at + count] = exchanged


@outer_kernel()
def rates(tau, y, p, w, s, yp):
    """Right-hand side: y' from the states and net forces (kinematics and film already evaluated)."""
    at = int(p[WORKS_AT])
    _works(tau, p, w, s, yp, at)
    for k in range(2):
        ring, x, net = k * RING, OWN_STATE + 6 * k, NET + 3 * k
        z_rate, tilt_rate = int(p[ring + AT_Z_RATE]), int(p[ring + AT_TILT_RATE])
        if z_rate >= 0:
            yp[int(p[ring + AT_Z])] = w[x + Z_RATE]
            yp[z_rate] = w[net] / p[ring + MASS] if p[ring + STUCK] == 0.0 else w[SEALS + PER_SEAL * k + FOLLOWING]
        if tilt_rate >= 0:
            tilt = int(p[ring + AT_TILT])
            yp[tilt], yp[tilt + 1] = w[x + TILT_X_RATE], w[x + TILT_Y_RATE]
            if p[ring + STUCK] == 0.0:
                yp[tilt_rate] = w[net + 1] / p[ring + INERTIA]
                yp[tilt_rate + 1] = w[net + 2] / p[ring + INERTIA]
            else:
                # Not the sum of forces, which is the same but for rounding: a stuck ring does not creep.
                yp[tilt_rate] = w[SEALS + PER_SEAL * k + FOLLOWING + 1]
                yp[tilt_rate + 1] = w[SEALS + PER_SEAL * k + FOLLOWING + 2]


@outer_kernel()
def residual(tau, y, yp, p, w, s, work, res):
    """Residual form of the same equations, for IDA: a massless ring's row is its force balance.
    `work` is scratch of the size of y."""
    at = int(p[WORKS_AT])
    _works(tau, p, w, s, work, at)
    first, count = (at - 1, 9) if p[EXTENDED] != 0.0 else (at, 6)
    for i in range(first, first + count):
        res[i] = yp[i] - work[i]
    for k in range(2):
        ring, x, net = k * RING, OWN_STATE + 6 * k, NET + 3 * k
        z, tilt = int(p[ring + AT_Z]), int(p[ring + AT_TILT])
        z_rate, tilt_rate = int(p[ring + AT_Z_RATE]), int(p[ring + AT_TILT_RATE])
        if z_rate >= 0:
            res[z] = yp[z] - w[x + Z_RATE]
            res[z_rate] = yp[z_rate] - w[net] / p[ring + MASS]
        elif z >= 0:
            res[z] = w[net]
        if tilt_rate >= 0:
            res[tilt], res[tilt + 1] = yp[tilt] - w[x + TILT_X_RATE], yp[tilt + 1] - w[x + TILT_Y_RATE]
            res[tilt_rate] = yp[tilt_rate] - w[net + 1] / p[ring + INERTIA]
            res[tilt_rate + 1] = yp[tilt_rate + 1] - w[net + 2] / p[ring + INERTIA]
        elif tilt >= 0:
            res[tilt], res[tilt + 1] = w[net + 1], w[net + 2]


@outer_kernel()
def energies(taus, ys, yp, p, w, s, out):
    """Energy (J) at several steps, `taus` (m,) (s) and `ys` (m, unknowns), into `out` (m,)."""
    for k in range(len(taus)):
        kinematics(taus[k], ys[k], yp, p, w, s)
        out[k] = energy(p, w)


@inner_kernel()
def energy(p, w):
    """Kinetic energy of the rings and energy of their support springs (J), from the scratch state."""
    total = 0.0
    for k in range(2):
        ring, c, x = k * RING, k * PER_RING, OWN_STATE + 6 * k
        if p[ring + AT_Z] >= 0.0:
            stretch = w[x + Z] - w[c + Z]
            total += 0.5 * p[ring + MASS] * w[x + Z_RATE] ** 2 + 0.5 * p[ring + AXIAL_K] * stretch**2
        if p[ring + AT_TILT] >= 0.0:
            e_x = w[x + TILT_X] - w[c + TILT_X] - w[c + OWN_X]
            e_y = w[x + TILT_Y] - w[c + TILT_Y] - w[c + OWN_Y]
            total += 0.5 * p[ring + INERTIA] * (w[x + TILT_X_RATE] ** 2 + w[x + TILT_Y_RATE] ** 2)
            total += 0.5 * p[ring + TILT_K] * (e_x * e_x + e_y * e_y)
            if p[ring + UNEVEN_K] != 0.0:
                along = w[AXES + 2 * k] * (e_x * e_x - e_y * e_y) + w[AXES + 2 * k + 1] * 2.0 * e_x * e_y
                total += 0.5 * p[ring + UNEVEN_K] * along
    return total
