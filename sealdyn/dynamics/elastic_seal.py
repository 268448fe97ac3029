"""Secondary seal that gives before it slides: springs and friction in series all around its circle, and when a place of
it turns back, found between steps, to the time.

At each place theta of a circle of radius R an element of stiffness k and friction f, both per length, is between the
ring and its carrier, and acts against the displacement of the ring there, seen in the carrier as it turns:

    s = z - z_c + R (e_x sin(theta) - e_y cos(theta)),     e = (gamma - gamma_c - gamma_own) exp(-i phi)
    force per length -t,   t = clip(k (s - x), -f, f)

where x is what the element has slid: the play operator of s, so x stays while the element sticks, and while s goes one
way it needs not be known before it turns back.  Between such reversals the wrench is a function of the ring's
displacement, and one without jumps: `x` is a parameter of the segment, which changes at a reversal.
**Source** Jenkins' element; several in parallel: Iwan (1966), "A distributed-element model for hysteresis", J. Applied
Mechanics 33; for stiffness without bound the friction of secondary_seal.py.
**Valid** uniform around the circle, which is taken at POINTS places: what they do is exact while nothing slides, in
axial motion, and in what a turning tilt dissipates; else force and moment of a ring that slides and tilts err by up to
0.7 % of the friction, as they ripple.  At rest where the support is; no creep, damping or frequency in the rubber; the
friction of pins follows no torque.
"""

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel, value_kernel
from ..solvers.contract import Change, Transition
from .equations import (
    LEG_AT,
    NET,
    OWN_STATE,
    PER_SEAL,
    RING,
    SEAL_AT,
    SEAL_EXCESS,
    SEAL_SPEED,
    SEALS,
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
    TILT_X_RATE,
    TILT_Y,
    TILT_Y_RATE,
    Z_RATE,
    Z,
)

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
        self.model, self.rings, self.segment = model, model.unknowns.elastic_rings, None
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
