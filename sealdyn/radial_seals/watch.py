"""What a run of a radial seal is looked at for: gaps, loads, times on the shaft, and the flow that the gaps let by."""

import math

import numpy as np
from scipy.optimize import minimize_scalar

from .equations import HELD, RIDING

# Places within each step, and their weights: Boole's rule.
PLACES = np.linspace(0.0, 1.0, 5)
WEIGHTS = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
SUMS = ("riding", "held", "impulse", "cubed")


class Watch:
    """An observer: of every follower the time (s) on the shaft and held by its flange, the impulse of its load (N s)
    and the integral of its gap cubed (m^3 s); over all, the largest gap and the least and largest load with when (s)
    and where (follower), None where there was none.  `begun` (s): nothing before counts."""

    def __init__(self, model, begun: float = 0.0):
        n = model.followers.count
        self.model, self.begun = model, begun
        self.riding, self.held, self.impulse, self.cubed = (np.zeros(n) for _ in SUMS)
        self.time = 0.0
        # Value, time, follower.
        self.extremes = dict.fromkeys(("largest_gap", "least_load", "largest_load"), (None, None, None))

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in a block's new steps."""
        segment, end = block.segment, block.t[block.end] if block.until is None else block.until
        edges = np.append(block.t[block.begin : block.end], end)
        edges = edges[edges + segment.time >= self.begun - 1e-12 * abs(end)]
        widths = np.diff(edges)
        # A run that goes on from its end has a step of no length, in which nothing can be interpolated.
        if not widths.sum() > 0.0:
            return
        taus = np.minimum((edges[:-1, None] + widths[:, None] * PLACES).ravel(), end)
        gaps, _, loads = segment.state(taus, *block.at(taus))
        rides, weights = segment.modes == RIDING, (widths[:, None] * WEIGHTS).ravel()
        self.time += float(widths.sum())
        self.riding += rides * widths.sum()
        self.held += (segment.modes == HELD) * widths.sum()
        self.impulse += rides * (weights @ loads)
        self.cubed += weights @ np.maximum(gaps, 0.0) ** 3
        self._see_gap(block, taus, gaps)
        among = np.flatnonzero(rides)
        for name, sign in (("least_load", -1.0), ("largest_load", 1.0)):
            # At the very end the load may have jumped: that is the next segment's.  Nor does one press that pulls: it
            # leaves, at the first instant of a run that was broken off there.
            seen = np.where(loads[:-1, among] < 0.0, -np.inf, sign * loads[:-1, among])
            if seen.size and seen.max() > -np.inf:
                at, j = np.unravel_index(seen.argmax(), seen.shape)
                self._take(name, sign, float(sign * seen[at, j]), segment.time + taus[at], among[j])

    def _see_gap(self, block, taus, gaps):
        """The largest gap, also between the places."""
        at, j = np.unravel_index(gaps.argmax(), gaps.shape)
        known, found, when = self.extremes["largest_gap"][0], float(gaps[at, j]), float(taus[at])
        if found <= 0.0 or (known is not None and found < 0.99 * known):
            return
        low, high = taus[max(at - 1, 0)], taus[min(at + 1, len(taus) - 1)]

        def negative(tau):
            here = np.array([tau])
            return -block.segment.state(here, *block.at(here))[0][0, j]

        if low < high:
            top = minimize_scalar(
                negative, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
            )
            if -top.fun > found:
                found, when = float(-top.fun), float(top.x)
        self._take("largest_gap", 1.0, found, block.segment.time + when, j)

    def _take(self, name, sign, value, time, j):
        known = self.extremes[name][0]
        if known is None or sign * value > sign * known:
            self.extremes[name] = (value, float(time), int(j))

    def state(self) -> dict:
        """What a continued run needs."""
        sums = {name: getattr(self, name).tolist() for name in SUMS}
        return {"time": self.time, "extremes": {name: list(row) for name, row in self.extremes.items()}, **sums}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.time, self.extremes = state["time"], {name: tuple(row) for name, row in state["extremes"].items()}
        for name in SUMS:
            setattr(self, name, np.array(state[name]))

    def share(self, times) -> np.ndarray:
        """Times (n,) (s) as shares of what was watched."""
        return times / self.time if self.time else np.full(len(times), math.nan)
