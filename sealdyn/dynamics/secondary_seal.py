"""Secondary seals: friction along a circle, of a seal that slides or sticks as one, and of one that gives before it
slides, with what turns back found between steps, to the time.

Coulomb friction as axial force and moment on a rigid ring, whose sliding speed is a constant plus a first harmonic,
v = z' + R (q_x sin(theta) - q_y cos(theta)); the circle integral of -F' sign(v) is

    u = R |q|,  a = z'/u clipped to [-1, 1]:   force -4 R F' asin(a),   moment -4 R^2 F' sqrt(1 - a^2) q/|q|

Nothing sticks partially: the ring slides everywhere (or along a line), or is stuck with all three speeds zero.
The loads it can hold while stuck fill the limit surface |M| / (4 R^2 F') = cos(pi/2 |F| / (2 pi R F')).
**Source** Ludwig & Allen, NASA TN D-8102 (1976).
**Valid** uniform line friction, rigid ring, no dependence on speed.

Where the seal gives, an element of stiffness k and friction f, both per length, is at each place theta between the ring
and its carrier, and acts against the displacement of the ring there, seen in the carrier as it turns:

    s = z - z_c + R (e_x sin(theta) - e_y cos(theta)),     e = (gamma - gamma_c - gamma_own) exp(-i phi)
    force per length -t,   t = clip(k (s - x), -f, f)

where x is what the element has slid: the play operator of s, so x stays while the element sticks, and while s goes one
way it needs not be known before it turns back.  Between such reversals the wrench is a function of the ring's
displacement, and one without jumps: `x` is a parameter of the segment, which changes at a reversal.
**Source** Jenkins' element; several in parallel: Iwan (1966), "A distributed-element model for hysteresis", J. Applied
Mechanics 33; for stiffness without bound the friction above.
**Valid** uniform around the circle, which is taken at POINTS places: what they do is exact while nothing slides, in
axial motion, and in what a turning tilt dissipates; else force and moment of a ring that slides and tilts err by up to
0.7 % of the friction, as they ripple.  At rest where the support is; no creep, damping or frequency in the rubber; the
friction of pins follows no torque.
"""

import math
from typing import Any

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ..solvers.contract import Change, Transition
from .equations import (
    AT_TILT,
    AT_Z,
    FOLLOWING,
    INERTIA,
    LEG_AT,
    MASS,
    NET,
    ONSET,
    OWN_STATE,
    PER_SEAL,
    RING,
    SEAL_AT,
    SEAL_BAND,
    SEAL_EXCESS,
    SEAL_LINE,
    SEAL_RADIUS,
    SEAL_SMOOTH,
    SEAL_SPEED,
    SEALS,
    STUCK,
    TURN,
    kinematics,
)
from .imposed_motion import (
    OWN_X,
    OWN_X_RATE,
    OWN_Y,
    OWN_Y_RATE,
    PER_RING,
    ROTOR_SPEED,
    STATOR_SPEED,
    TILT_X,
    TILT_X_ACCELERATION,
    TILT_X_RATE,
    TILT_Y,
    TILT_Y_ACCELERATION,
    TILT_Y_RATE,
    Z_ACCELERATION,
    Z_RATE,
    Z,
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


# Places around a circle.
POINTS = 24
# The block: how many elements and places, sine and cosine of these (0 where no ring tilts), then of each element its
# radius, friction and stiffness at one place, and what it has slid at each.
ELEMENTS, PLACES, SINES = 0, 1, 2
RADIUS, FRICTION, STIFFNESS, SLID = 0, 1, 2, 3
# How far (over accuracy and clearance) an element that has turned back must have slid to be worth a reversal.
LEAST_SLIDE = 1e-3


def elements_block(seal, tilts: bool, slid=None) -> np.ndarray:
    """The block of a SecondarySeal's elements; `tilts` whether its ring does, `slid` (elements, places) in m."""
    circles, count = seal.circles(), POINTS if tilts else 1
    theta = 2 * np.pi * np.arange(count) / count
    arms = [np.sin(theta), np.cos(theta)] if tilts else [np.zeros(1), np.zeros(1)]
    slid = np.zeros((len(circles), count)) if slid is None else slid
    parts = [
        [one.radius, one.friction / count, one.stiffness / count, *row] for one, row in zip(circles, slid, strict=True)
    ]
    return np.concatenate([[len(circles), count], *arms, *parts])


@inner_kernel()
def _motion(k, spin, w):
    """Motion (6,) of ring k in its carrier, from where its support is at rest: axial, tilts, and their rates."""
    c, x, turn = k * PER_RING, OWN_STATE + 6 * k, TURN + 2 * k
    cos, sin = w[turn], w[turn + 1]
    e_x, e_y = w[x + TILT_X] - w[c + TILT_X] - w[c + OWN_X], w[x + TILT_Y] - w[c + TILT_Y] - w[c + OWN_Y]
    r_x = w[x + TILT_X_RATE] - w[c + TILT_X_RATE] - w[c + OWN_X_RATE] + spin * e_y
    r_y = w[x + TILT_Y_RATE] - w[c + TILT_Y_RATE] - w[c + OWN_Y_RATE] - spin * e_x
    return (
        w[x + Z] - w[c + Z], cos * e_x + sin * e_y, cos * e_y - sin * e_x,
        w[x + Z_RATE] - w[c + Z_RATE], cos * r_x + sin * r_y, cos * r_y - sin * r_x,
    )  # fmt: skip


@value_kernel()
def elastic_friction(k, spin, spin_rate, p, w):
    """Force and moments of ring k's secondary seal onto its net load; returns their power."""
    x, net, seal, turn = OWN_STATE + 6 * k, NET + 3 * k, SEALS + PER_SEAL * k, TURN + 2 * k
    at = int(p[k * RING + SEAL_AT])
    elements, places = int(p[at + ELEMENTS]), int(p[at + PLACES])
    z, e_x, e_y, v, r_x, r_y = _motion(k, spin, w)
    force = moment_x = moment_y = fastest = sliding = most = 0.0
    for j in range(elements):
        element = at + SINES + 2 * places + j * (SLID + places)
        radius, friction, stiffness = p[element + RADIUS], p[element + FRICTION], p[element + STIFFNESS]
        most += places * friction
        for i in range(places):
            arm_x, arm_y = radius * p[at + SINES + i], -radius * p[at + SINES + places + i]
            t = stiffness * (z + arm_x * e_x + arm_y * e_y - p[element + SLID + i])
            if abs(t) >= friction:
                t = friction if t > 0.0 else -friction
                sliding += friction
                fastest = max(fastest, abs(v + arm_x * r_x + arm_y * r_y))
            force -= t
            moment_x -= t * arm_x
            moment_y -= t * arm_y
    w[seal + SEAL_SPEED], w[seal + SEAL_EXCESS] = fastest, sliding / most
    w[seal] = force
    w[seal + 1] = w[turn] * moment_x - w[turn + 1] * moment_y
    w[seal + 2] = w[turn] * moment_y + w[turn + 1] * moment_x
    for i in range(3):
        w[net + i] += w[seal + i]
    return force * w[x + Z_RATE] + w[seal + 1] * w[x + TILT_X_RATE] + w[seal + 2] * w[x + TILT_Y_RATE]


@outer_kernel()
def displacements(k, taus, ys, yps, p, w, s, out, speeds):
    """Displacement `out` (m) and its rate `speeds` (m/s), both (times, elements, places), of ring k at the places of
    its seal's elements, at segment times `taus` (s) and unknowns `ys`; `p`, `w`, `s`, `yps` as in equations.py."""
    at, spin_at = int(p[k * RING + SEAL_AT]), LEG_AT + (STATOR_SPEED if k == 0 else ROTOR_SPEED)
    places = int(p[at + PLACES])
    for n in range(len(taus)):
        kinematics(taus[n], ys[n], yps[n], p, w, s)
        z, e_x, e_y, v, r_x, r_y = _motion(k, p[spin_at] + p[spin_at + 1] * taus[n], w)
        for j in range(out.shape[1]):
            radius = p[at + SINES + 2 * places + j * (SLID + places) + RADIUS]
            for i in range(places):
                arm_x, arm_y = radius * p[at + SINES + i], -radius * p[at + SINES + places + i]
                out[n, j, i] = z + arm_x * e_x + arm_y * e_y
                speeds[n, j, i] = v + arm_x * r_x + arm_y * r_y


class Reversals:
    """What the elements of secondary seals that give have slid (`slid` {ring: (elements, places)}, m), and the finding
    of the places that turn back after they slid; offers what `stick_slip.StickSlip` does, but counts nothing, since at
    a reversal nothing jumps."""

    sticks = slips = None
    dropped = None

    def __init__(self, model):
        self.model, self.rings = model, model.unknowns.elastic_rings
        self.segment: Any = None
        self.slid, self.reach = {}, {}
        for k in self.rings:
            circles = model.unknowns.seal(k).circles()
            self.slid[k] = np.zeros((len(circles), POINTS if model.unknowns.with_tilt else 1))
            # How far an element gives before it slides.
            self.reach[k] = np.array([[one.friction / one.stiffness] for one in circles])
        self.least = LEAST_SLIDE * model.accuracy * model.clearance

    def begin(self, segment, tau, y):
        """A segment begins: its motion is asked from now on."""
        self.segment = segment

    def start(self, segment, tau: float, y) -> dict:
        """Where the elements rest at the very start: with the support, but no further from the ring than they give."""
        self.begin(segment, tau, y)
        self._follow(tau, y)
        return self.held()

    def held(self) -> dict:
        """What the elements have slid, as a Segment takes it."""
        return {k: slid.copy() for k, slid in self.slid.items()}

    def state(self) -> dict:
        """What a continued run needs."""
        return {"slid": {str(k): slid.tolist() for k, slid in self.slid.items()}}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.slid = {int(k): np.array(slid) for k, slid in state["slid"].items()}

    def accept(self, block, advance) -> Transition | None:
        """The first reversal in a block of steps, or None; `advance` as StickSlip's."""
        first, last = block.begin, block.end + 1
        taus, ys, yps = (part[first:last] for part in (block.t, block.ys, block.yps))
        lengths, found = np.diff(taus)[:, None, None], None
        for k in self.rings:
            s, v = self._motion(k, taus, ys, yps)
            share = _turning(s, v, lengths, self.slid[k], self.reach[k] + self.least)
            earliest = share.reshape(len(share), -1).min(axis=1)
            steps = np.flatnonzero(np.isfinite(earliest))
            if len(steps) and (found is None or (steps[0], earliest[steps[0]]) < found):
                found = steps[0], earliest[steps[0]]
        if found is None:
            return None
        step, share = first + int(found[0]), float(found[1])
        tau, y = block.t[step], block.ys[step]
        time = tau + share * (block.t[step + 1] - tau)
        there = advance(tau, y, time) if time > tau else y.copy()
        if there is None:
            # Not smooth up to there: what is lost is what the place goes back within the step.
            time, there = block.t[step + 1], block.ys[step + 1].copy()
        return Transition(step, float(time), there, None)

    def make(self, transition: Transition) -> Change:
        """The elements that slid are stuck where they are."""
        self._follow(transition.time, transition.y)
        return Change(transition.y, self.held(), None)

    def _follow(self, tau, y):
        """Let every element slide as far as its ring has drawn it."""
        for k in self.rings:
            s = self._motion(k, np.array([tau]), y[None, :].copy(), np.zeros((1, len(y))))[0][0]
            self.slid[k] = np.clip(self.slid[k], s - self.reach[k], s + self.reach[k])

    def _motion(self, k, taus, ys, yps):
        segment, shape = self.segment, (len(taus), *self.slid[k].shape)
        out, speeds = np.empty(shape), np.empty(shape)
        ys, yps = np.ascontiguousarray(ys), np.ascontiguousarray(yps)
        displacements(k, taus, ys, yps, segment.p, segment.w, segment.s, out, speeds)
        return out, speeds


def _turning(s, v, lengths, slid, reach):
    """Where in each step (share of its length, inf: nowhere) an element that slides turns back, (steps, elements,
    places), from displacements `s` and rates `v` at the steps' ends, `lengths` the steps; it slides beyond its `reach`
    from where it has `slid` to."""
    begin, end, v_0, v_1 = s[:-1], s[1:], v[:-1] * lengths, v[1:] * lengths
    # The rate of Hermite's cubic: v_0 + b x + a x^2.
    rise = end - begin
    a, b = 3.0 * (v_0 + v_1) - 6.0 * rise, 6.0 * rise - 4.0 * v_0 - 2.0 * v_1
    turns = v_0 * v_1 < 0.0
    # Of the two roots the one inside, where the rate has one sign before and another behind; without cancellation.
    half = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b * b - 4.0 * a * v_0, 0.0)), b))
    with np.errstate(divide="ignore", invalid="ignore"):
        far, near = half / a, v_0 / half
    x = np.clip(np.where((near >= 0.0) & (near <= 1.0), near, far), 0.0, 1.0)
    x = np.where(turns & np.isfinite(x), x, 0.0)
    at = begin + x * (v_0 + x * (b / 2.0 + x * a / 3.0))
    # Or it is on its way back from the step's start: it turned a trifle before.
    return np.where(-np.sign(v_1) * (at - slid) > reach, x, np.inf)
