"""When followers leave the shaft, land on it, stop on their flange and slip again: found between the solver's steps."""

import numpy as np
from scipy.optimize import minimize_scalar

from ..solvers.contract import Change, Transition
from .equations import FREE, HELD, RIDING

# Places within each step at which is looked.
LOOKS = 8
# What counts as nothing: of distances and speeds a share of their error, of loads of their size.
OF_ERROR, OF_LOAD = 0.01, 1e-11
# From a place to the next to rounding.
HALVINGS = 48
# Share of a step by which a contact is moved to where it is.
NEWTON = 0.01
# Share of a segment's length in which nothing is integrated.
CRUMB = 1e-12
EVENTS = {"lift": "leaves the shaft", "land": "lands on the shaft", "stick": "is held by its flange",
          "slip": "slips on its flange", "turn": "turns on its flange"}  # fmt: skip


class Contacts:
    """Modes and signs of sliding of all followers (`modes`, `signs` (n,)); finds and makes their changes.  `counts` of
    each kind of EVENTS, `dropped` the kinetic energy (J) lost at landings, `first_lift` (s) or None."""

    def __init__(self, model):
        n = model.followers.count
        self.model, self.segment = model, None
        self.modes, self.signs = np.full(n, RIDING), np.zeros(n)
        self.counts, self.dropped, self.first_lift = dict.fromkeys(EVENTS, 0), 0.0, None
        followers = model.followers
        self.near = OF_ERROR * model.accuracy * model.length
        self.slow = self.near * model.reference_rate
        self.weak = OF_LOAD * (followers.preload + followers.friction + followers.row[0] * model.length)

    # --- what solve asks ----------------------------------------------------------------------------

    def start(self, segment, tau: float, y) -> dict:
        """Modes at the very start: who rides pulls nowhere."""
        self.begin(segment, tau, y)
        here = segment.surface(tau)
        _, _, loads = self._state(np.array([tau]), y)
        for j in range(len(self.modes)):
            if self.modes[j] == RIDING and loads[0, j] < -self.weak:
                self._let_go(j, y, here[j])
                self.counts["lift"], self.first_lift = self.counts["lift"] + 1, segment.time + tau
        return self.held()

    def begin(self, segment, tau, y):
        """A segment begins."""
        self.segment = segment

    def held(self) -> dict:
        """The modes, as a segment takes them."""
        return {"modes": self.modes.copy(), "signs": self.signs.copy()}

    def state(self) -> dict:
        """What a continued run needs."""
        return {"modes": self.modes.tolist(), "signs": self.signs.tolist(), "counts": self.counts,
                "dropped": self.dropped, "first_lift": self.first_lift}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.modes, self.signs = np.array(state["modes"]), np.array(state["signs"])
        self.counts, self.dropped, self.first_lift = dict(state["counts"]), state["dropped"], state["first_lift"]

    def accept(self, block, advance) -> Transition | None:
        """The first change in a block of steps.  `advance(tau, y, until)`: unknowns at `until` (s)."""
        # Worked out once for all steps.
        _ = block.accelerations
        for step in range(block.begin, block.end):
            found = self._in_step(block, step)
            # What happens at the end belongs to what comes next.
            if found and self.segment.length - found[0] > CRUMB * self.segment.length:
                time, j, touches = found
                y = advance(block.t[step], block.ys[step], time)
                if touches:
                    time, y = self._at_contact(block, step, time, y, j, advance)
                return Transition(step, float(time), y, (j, touches))
        return None

    def _at_contact(self, block, step, time, y, j, advance):
        """Time and unknowns where follower j meets the shaft, which between the steps was found at `time` (s), with the
        unknowns `y` there: a step of Newton's.  Where one grazes the other the time hangs on the last digits."""
        here, low = self.segment.surface(time)[j], block.t[step]
        gap, closing = y[j] - here[0], here[1] - y[self.segment.n + j]
        if closing <= 0.0 or abs(gap) > NEWTON * (block.t[step + 1] - low) * closing or time + gap / closing <= low:
            return time, y
        time += gap / closing
        return time, advance(low, block.ys[step], time)

    def make(self, transition: Transition) -> Change:
        """Let the follower of `transition.what` (which, whether at the shaft) do what its guards ask."""
        (j, touches), tau, y = transition.what, transition.time, transition.y.copy()
        here, n = self.segment.surface(tau)[j], len(self.modes)
        mode, v = self.modes[j], y[n + j]
        lost = 0.0
        if mode == RIDING:
            kind = self._let_go(j, y, here)
        elif touches:
            kind, lost = "land", 0.5 * self.model.followers.mass * (v - here[1]) ** 2
            y[j], y[n + j] = here[0], here[1]
            self.modes[j], self.signs[j] = RIDING, 0.0
        elif mode == HELD:
            kind = "slip"
            self.modes[j], self.signs[j] = FREE, np.sign(-self._pull(j, y))
        else:
            kind = self._stop(j, y)
        self.counts[kind] += 1
        self.dropped += lost
        if kind == "lift" and self.first_lift is None:
            self.first_lift = self.segment.time + tau
        text = f"follower {j + 1} {EVENTS[kind]}"
        return Change(y, self.held(), {"kind": kind, "value": float(lost if kind == "land" else v), "text": text})

    # --- what a follower does -----------------------------------------------------------------------

    def _let_go(self, j, y, here) -> str:
        """Follower j leaves the shaft with the shaft's own motion; where that stands, friction may hold it."""
        y[j], y[len(self.modes) + j] = here[0], here[1]
        if abs(here[1]) > self.slow:
            self.modes[j], self.signs[j] = FREE, np.sign(here[1])
        else:
            self._stop(j, y)
        return "lift"

    def _stop(self, j, y) -> str:
        """Follower j, at rest: held, or turned to where it is pulled."""
        pull, n = self._pull(j, y), len(self.modes)
        y[n + j] = 0.0
        if abs(pull) <= self.model.followers.friction:
            self.modes[j], self.signs[j] = HELD, 0.0
            return "stick"
        self.modes[j], self.signs[j] = FREE, -np.sign(pull)
        return "turn"

    def _pull(self, j, y) -> float:
        """Inward force (N) of springs and preload on follower j."""
        found = self.model.followers
        n = found.count
        return float(found.row[(j - np.arange(n)) % n] @ y[:n] + found.preload)

    # --- where it happens ---------------------------------------------------------------------------

    def _state(self, taus, y):
        n = self.segment.n
        us, vs = (np.repeat(part[None, :], len(taus), axis=0) for part in (y[:n], y[n : 2 * n]))
        return self.segment.state(taus, us, vs)

    def guards(self, block, taus):
        """What must not fall below zero at `taus` (m,) (s) inside a block's new steps, two each (m, n): the distance
        from the shaft of those that are not on it (m); the load of those that ride, what friction has left of those
        that are held (N), and the speed of the free ones in the direction of their sliding where there is friction
        (m/s)."""
        us, vs = block.at(taus)
        gaps, _, loads = self.segment.state(taus, us, vs)
        friction, modes = self.model.followers.friction, self.modes
        sliding = vs * self.signs if friction else np.full_like(vs, np.inf)
        second = np.where(modes == RIDING, loads, np.where(modes == HELD, friction - np.abs(loads), sliding))
        return np.where(modes == RIDING, np.inf, gaps), second

    def _in_step(self, block, step):
        """Time and follower of the first change within a step, and whether it meets the shaft; or None."""
        taus = np.linspace(block.t[step], block.t[step + 1], LOOKS + 1)
        block = block.only(step)
        allowed = np.full(len(self.modes), self.near), np.where(self.modes == FREE, self.slow, self.weak)
        first = None
        for which, values in enumerate(self.guards(block, taus)):
            least = -allowed[which]
            dips = _dips(values)
            for j in np.flatnonzero((values[1:] < least).any(axis=0) | dips.any(axis=0)):

                def guard(tau, which=which, j=j):
                    return self.guards(block, np.array([tau]))[which][0, j]

                found = _first_below(guard, taus, values[:, j], dips[:, j], least[j])
                if found is not None:
                    # No interval without a length.
                    found = max(found, taus[0] + CRUMB * self.segment.length)
                if found is not None and (first is None or found < first[0]):
                    first = (found, int(j), which == 0)
        return first


def _dips(values):
    """Where three places (m - 2, n) of the columns (m, n) have a least value between them that may lie below zero:
    twice as deep as the parabola through them says.  Between the outer two of a step's places it counts too."""
    with np.errstate(invalid="ignore", divide="ignore"):
        slope, bend = 0.5 * (values[2:] - values[:-2]), values[:-2] - 2.0 * values[1:-1] + values[2:]
        return (np.abs(slope) <= 1.1 * bend) & (values[1:-1] < slope**2 / bend)


def _first_below(guard, taus, values, dips, least) -> float | None:
    """When `guard(tau)`, of which `values` (m,) at `taus` (m,) and the `dips` (m - 2,) are known, first falls below
    `least`; None if never."""
    for k in range(1, len(taus)):
        if values[k] < least:
            return _bisected(guard, taus[k - 1], taus[k], least)
        if k + 1 < len(taus) and dips[k - 1]:
            deepest = minimize_scalar(guard, bounds=(taus[k - 1], taus[k + 1]), method="bounded",
                                      options={"xatol": 1e-9 * (taus[-1] - taus[0])})  # fmt: skip
            if deepest.fun < least:
                return _bisected(guard, taus[k - 1], deepest.x, least)
    return None


def _bisected(guard, low, high, least) -> float:
    """The first instant at which the guard is below `least`, between `low` where it is not and `high` where it is."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if guard(middle) < least else (middle, high)
    return high
