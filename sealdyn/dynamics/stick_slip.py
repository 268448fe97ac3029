"""When a ring on its secondary seal sticks, slips and reverses: found between steps, to the time.

A sliding ring is captured when its sliding speed has fallen below the model's `capture_speed` (a hundredth of the
accuracy times the scale of the axial rates) and what it would have to hold lies inside the limit surface; a stuck ring
slips when that load reaches the surface.  A ring that comes to rest on a load outside the surface reverses.

Friction has no direction at standstill.  It is that of the sliding velocity plus the velocity of the onset: a little in
the direction in which the load makes the ring slide.  So it is whole and smooth from the first instant of a slip to the
last: solvers see a jump nowhere.
"""

import numpy as np

from ..numerics.hermite import NODES, sample
from ..scene.rings import RING_NAMES
from ..solvers.contract import Change, Transition
from .equations import (
    AT_TILT,
    AT_TILT_RATE,
    AT_Z,
    AT_Z_RATE,
    FOLLOWING,
    INERTIA,
    LEG_AT,
    MASS,
    NET,
    OWN_STATE,
    PER_SEAL,
    RING,
    SEAL_EXCESS,
    SEAL_LINE,
    SEAL_RADIUS,
    SEAL_SPEED,
    SEALS,
)
from .imposed_motion import (
    OSCILLATOR_COUNT,
    PER_RING,
    ROTOR_SPEED,
    STATOR_SPEED,
    TILT_X,
    TILT_X_RATE,
    TILT_Y,
    TILT_Y_RATE,
    Z_RATE,
)

# A ring is captured only when what it must hold is this far inside the limit surface.
INSIDE = 1e-9
# ... and this far when it has only just slipped and not yet left the band: else it would chatter.
WITHDRAWN = 1e-3
# Each approach to standstill goes so much of the way that a constant deceleration would leave.
APPROACH_FACTOR, SHORTEST = 0.9, 0.2
# The capture speed over the scale of the axial rates and the accuracy; the speed of the onset over the capture speed,
# and that below which friction fades, for a step that goes too far, over the speed of the onset.
CAPTURE, ONSET_SPEED, FADE = 0.01, 0.8, 0.5
# The last approach ends above this share of the capture speed, where friction is still whole.
ABOVE = 0.9
# An onset goes on while its direction and that of the load agree so well (cosine).
SAME = 0.5
# Looks into each step of a stuck ring.
LOOKS = 2


class StickSlip:
    """Which rings stick (`stuck` {ring: bool}) and how the others began to slide (`onset` {ring: (3,)}: axial speed,
    m/s, and tilt rates, rad/s); finds and makes the changes: `sticks`, `slips` counts them, `dropped` is the kinetic
    energy (J) lost at captures."""

    def __init__(self, model):
        self.model, self.rings, self.segment = model, model.unknowns.coulomb_rings, None
        self.stuck = dict.fromkeys(self.rings, False)
        self.leaving = dict.fromkeys(self.rings, False)
        self.onset = {k: np.zeros(3) for k in self.rings}
        self.sticks, self.slips, self.dropped = 0, 0, 0.0
        self._yp = np.empty(model.unknowns.size)

    def begin(self, segment, tau, y):
        """A segment begins: its equations are asked from now on."""
        self.segment = segment

    def sliding_state(self, k: int, tau: float, y) -> tuple[float, float]:
        """Sliding speed (m/s) of ring k and how far what it must hold lies outside the limit surface (dimensionless,
        `secondary_seal.excess`), at segment time `tau` (s) and unknowns `y` (size,)."""
        self._find_rates(tau, y)
        at = SEALS + PER_SEAL * k
        return self.segment.w[at + SEAL_SPEED], self.segment.w[at + SEAL_EXCESS]

    def _find_rates(self, tau, y):
        """The derivatives of the unknowns, into `_yp`; a ring without mass moves as the balance of its forces asks."""
        if np.any(self.segment.lacks_inertia):
            self._yp[:] = self.segment.start(tau, y)[1]
        else:
            self.segment.ring_rates(tau, y, self._yp)

    def start(self, segment, tau: float, y) -> dict:
        """The rings that stick at the very start ({ring: bool}): those at rest on a load that they can hold."""
        self.begin(segment, tau, y)
        for k in self.rings:
            speed, outside = self.sliding_state(k, tau, y)
            slow = speed < self.model.capture_speed
            self.stuck[k] = bool(slow and outside < -INSIDE)
            self.onset[k] = self._onset(k, tau, y, self._velocity(k, tau, y)[0] if not slow else None)
        return self.held()

    def held(self) -> dict:
        """How the rings are held, as a Segment takes it: {ring: True if it sticks, else the velocity of its onset}."""
        return {k: self.stuck[k] or self.onset[k].copy() for k in self.rings}

    def state(self) -> dict:
        """What a continued run needs: `stuck` {ring: bool}, `onset`, the counts and the energy lost (J)."""
        stuck, leaving = ({str(k): bool(v) for k, v in of.items()} for of in (self.stuck, self.leaving))
        onset = {str(k): v.tolist() for k, v in self.onset.items()}
        return {"stuck": stuck, "leaving": leaving, "onset": onset, "sticks": self.sticks, "slips": self.slips,
                "dropped": self.dropped}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.stuck = {int(k): v for k, v in state["stuck"].items()}
        self.leaving = {int(k): v for k, v in state["leaving"].items()}
        self.onset = {int(k): np.array(v) for k, v in state["onset"].items()}
        self.sticks, self.slips, self.dropped = state["sticks"], state["slips"], state["dropped"]

    def accept(self, block, advance) -> Transition | None:
        """The first transition in a block of steps, or None.  `advance(tau, y, until)` integrates from `tau` to `until`
        (s) and returns the unknowns (size,) there, or None where the equations jump between."""
        t, ys, yps, known = block.t, block.ys, block.yps, {}

        def velocity(k, step):
            # The end of a step is the start of the next.
            if (k, step) not in known:
                known[k, step] = self._velocity(k, t[step], ys[step])[0]
            return known[k, step]

        for step in range(block.begin, block.end):
            found = None
            for k in self.rings:
                if self.stuck[k]:
                    change = self._slip(k, t, ys, yps, step, advance)
                else:
                    change = self._capture(k, t, ys, step, velocity(k, step), velocity(k, step + 1), advance)
                if change and (found is None or change[0] < found.time):
                    found = Transition(step, float(change[0]), change[1], k)
            if found:
                return found
        return None

    def make(self, transition: Transition) -> Change:
        """Let the ring of a transition slip, reverse or stick; the event's `value` is the kinetic energy (J) lost, as
        what carries the ring sees it: what the friction turns to heat."""
        k, tau, y = transition.what, transition.time, transition.y
        name = RING_NAMES[k]
        velocity, _ = self._velocity(k, tau, y)
        if self.stuck[k]:
            self.stuck[k], self.leaving[k] = False, True
            self.onset[k] = self._onset(k, tau, y)
            self.slips += 1
            event = {"kind": "slip", "value": 0.0, "text": f"the {name} slips on its secondary seal"}
            return Change(y, self.held(), event)
        after, ring = self._at_rest(k, tau, y), self.segment.p[RING * k : RING * (k + 1)]
        if not self._is_held(k, tau, after):
            self.onset[k] = self._onset(k, tau, after)
            return Change(after, self.held(), None)
        inertia = ring[INERTIA] / ring[SEAL_RADIUS] ** 2
        lost = float(0.5 * ring[MASS] * velocity[0] ** 2 + 0.5 * inertia * (velocity[1:] @ velocity[1:]))
        self.stuck[k] = True
        self.sticks += 1
        self.dropped += lost
        event = {"kind": "stick", "value": lost, "text": f"the {name} sticks on its secondary seal"}
        return Change(after, self.held(), event)

    # --- a stuck ring -------------------------------------------------------------------------------

    def _slip(self, k, t, ys, yps, step, advance):
        """When ring k, stuck at the step's start, can no longer be held."""
        inside, low = self._inside(t, ys, yps, step), t[step]

        def is_held(tau):
            return self.sliding_state(k, tau, self._at_rest(k, tau, inside(tau)))[1] <= 0.0

        for x in np.linspace(0, 1, LOOKS + 1)[1:]:
            high = t[step] + x * (t[step + 1] - t[step])
            if not is_held(high):
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    low, high = (middle, high) if is_held(middle) else (low, middle)
                return (high, advance(t[step], ys[step], high)) if high > t[step] else (high, ys[step].copy())
            low = high
        return None

    def _inside(self, t, ys, yps, step):
        """Unknowns inside a step, works as at its start."""
        segment = self.segment
        first, last = max(0, step - NODES), min(len(t), step + NODES + 2)
        q, q_rate = segment.motion(ys[first:last], yps[first:last])
        t, k, here, rate = t[first:last], step - first, np.empty((1, segment.n)), np.empty((1, segment.n))

        def at(tau):
            sample(t, q, q_rate, len(t), k, k + 1, np.array([tau]), here, rate)
            return self.model.vector(here[0], rate[0])

        return at

    # --- a sliding ring -----------------------------------------------------------------------------

    def _velocity(self, k, tau, y):
        """Sliding speeds (m/s) of ring k against what it slides on, axial and along the circle about both axes; and
        their rates (m/s^2)."""
        segment, ring = self.segment, RING * k
        self._find_rates(tau, y)
        p, w = segment.p, segment.w
        c, x, follow = PER_RING * k, OWN_STATE + 6 * k, SEALS + PER_SEAL * k + FOLLOWING
        z_rate, tilt_rate = int(p[ring + AT_Z_RATE]), int(p[ring + AT_TILT_RATE])
        spin, radius = self._spin(k, tau), p[ring + SEAL_RADIUS]
        v, a = np.zeros(3), np.zeros(3)
        if z_rate >= 0:
            v[0], a[0] = w[x + Z_RATE] - w[c + Z_RATE], self._yp[z_rate] - w[follow]
        if tilt_rate >= 0:
            d_x, d_y = w[x + TILT_X] - w[c + TILT_X], w[x + TILT_Y] - w[c + TILT_Y]
            v[1] = radius * (w[x + TILT_X_RATE] - w[c + TILT_X_RATE] + spin * d_y)
            v[2] = radius * (w[x + TILT_Y_RATE] - w[c + TILT_Y_RATE] - spin * d_x)
            a[1:] = radius * (self._yp[tilt_rate : tilt_rate + 2] - w[follow + 1 : follow + 3])
        return v, a

    def _is_held(self, k, tau, rest) -> bool:
        """Whether the load on ring k, at rest in unknowns `rest`, lies inside the limit surface."""
        return self.sliding_state(k, tau, rest)[1] < -(WITHDRAWN if self.leaving[k] else INSIDE)

    def _onset(self, k, tau, y, velocity=None):
        """The velocity (3,) of the onset of ring k: in the direction in which its load makes it slide, or of its
        sliding `velocity`, if that is given.

        **Source** the law of secondary_seal.py, solved for the velocity: v / u = -sin(pi F / (2 F_most)), the tilt
        rates against the moments."""
        segment, ring, radius = self.segment, RING * k, self.segment.p[RING * k + SEAL_RADIUS]
        if velocity is None:
            self.sliding_state(k, tau, y)
            p, w, net = segment.p, segment.w, NET + 3 * k
            at = SEALS + PER_SEAL * k
            inertias = p[ring + MASS], p[ring + INERTIA], p[ring + INERTIA]
            floats = np.array([p[ring + AT_Z], p[ring + AT_TILT], p[ring + AT_TILT]]) >= 0.0
            load = (inertias * w[at + FOLLOWING : at + FOLLOWING + 3] - w[net : net + 3] + w[at : at + 3]) * floats
            angle = np.clip(load[0] / (4.0 * radius * p[ring + SEAL_LINE]), -0.5 * np.pi, 0.5 * np.pi)
            moment = np.hypot(load[1], load[2])
            # A moment of rounding size has no direction.
            tilting = moment > 1e-9 * radius * abs(load[0])
            velocity = -np.array([np.sin(angle), *(load[1:] / moment if tilting else (0.0, 0.0))])
            velocity[0] = velocity[0] if tilting else -np.sign(load[0])
        size = float(np.linalg.norm(velocity))
        onset = ONSET_SPEED * self.model.capture_speed * velocity / (size or 1.0)
        onset[1:] /= radius
        return onset

    def _reverses(self, k, tau, rest) -> bool:
        """Whether the load on ring k, at rest in unknowns `rest`, makes it slide another way than it has begun to."""
        now, then = self.onset[k].copy(), self._onset(k, tau, rest)
        for onset in (now, then):
            onset[1:] *= self.segment.p[RING * k + SEAL_RADIUS]
        return float(now @ then) < SAME * float(then @ then)

    def _spin(self, k, tau):
        leg, at = self.segment.p[LEG_AT:], STATOR_SPEED if k == 0 else ROTOR_SPEED
        return leg[at] + leg[at + 1] * tau

    def _at_rest(self, k, tau, y):
        """The unknowns with ring k moving as its carrier does.  Only there its load tells whether it is held and which
        way it slides: a film that damps much makes a force of the least speed, and of the error of one."""
        segment, ring, y = self.segment, RING * k, y.copy()
        velocity, _ = self._velocity(k, tau, y)
        z_rate, tilt_rate = (int(segment.p[ring + i]) for i in (AT_Z_RATE, AT_TILT_RATE))
        if z_rate >= 0:
            # Subtracting from itself: at rest the rate is zero, not a rounding.
            y[z_rate] -= velocity[0]
        if tilt_rate >= 0:
            radius = segment.p[ring + SEAL_RADIUS]
            y[tilt_rate : tilt_rate + 2] -= velocity[1:] / radius
            if not self._spin(k, tau) and not (segment.p[LEG_AT + OSCILLATOR_COUNT] or not segment.harmonic):
                y[tilt_rate : tilt_rate + 2] = 0.0
        return y

    def _capture(self, k, t, ys, step, a, b, advance):
        """When ring k, of sliding speeds `a` at a step's start and `b` at its end, comes to rest within, and stays."""
        band = self.model.capture_speed
        change = b - a
        length = float(change @ change)
        nearest = float(np.clip(-(a @ change) / length, 0.0, 1.0)) if length > 0 else 1.0
        self.leaving[k] = self.leaving[k] and float(np.linalg.norm(b)) < band
        if float(np.linalg.norm(a + nearest * change)) > band + 0.5 * length**0.5:
            return None
        if float(a @ b) > 0.0 and float(np.linalg.norm(b)) > band:
            # Still on its way, and not at rest between.
            return None
        # From here each integration ends before standstill, so that the friction's direction stays smooth.
        tau, y, part, latest = t[step], ys[step].copy(), APPROACH_FACTOR, t[step + 1]
        before = (tau, y)
        for _ in range(60):
            v, rate = self._velocity(k, tau, y)
            speed = float(np.linalg.norm(v))
            if speed < band:
                rest = self._at_rest(k, tau, y)
                return (tau, y) if self._is_held(k, tau, rest) or self._reverses(k, tau, rest) else None
            slowing = -float(v @ rate) / speed
            if slowing <= 0.0:
                # Past the slowest place: again, with a shorter stride.
                part *= 0.5
                if tau == t[step] or part < SHORTEST:
                    return None
                tau, y = before
                continue
            until = tau + min(part * speed, speed - ABOVE * band) / slowing
            until = min(until, tau + part * (latest - tau))
            if until <= tau:
                return None
            there = advance(tau, y, until)
            if there is None or float(v @ self._velocity(k, until, there)[0]) < 0.0:
                # Beyond standstill, where friction jumps.
                part *= 0.5
                continue
            before = (tau, y)
            tau, y = until, there
        return None
