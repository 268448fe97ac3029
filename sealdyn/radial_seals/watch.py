"""What a run of a radial seal is looked at for: gaps, loads, times on the shaft, and the flow that the gaps let by."""

import numpy as np

from .equations import HELD, RIDING

# Places within each step: Simpson's rule.
PLACES = 5


class Watch:
    """An observer: of every follower the time (s) on the shaft and held by its flange, the impulse of its load (N s)
    and the integral of its gap cubed (m^3 s); over all, the largest gap and the least and largest load with when (s)
    and where (follower).  `begun` (s): nothing before counts."""

    def __init__(self, model, begun: float = 0.0):
        n = model.followers.count
        self.model, self.begun = model, begun
        self.riding, self.held, self.impulse, self.cubed = (np.zeros(n) for _ in range(4))
        self.time = 0.0
        # Value, time, follower.
        self.extremes = {"largest_gap": (0.0, None, None), "least_load": (np.inf, None, None),
                         "largest_load": (-np.inf, None, None)}  # fmt: skip

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in a block's new steps."""
        segment, end = block.segment, block.t[block.end] if block.until is None else block.until
        edges = np.append(block.t[block.begin : block.end], end)
        edges = edges[edges + segment.time >= self.begun - 1e-12 * abs(end)]
        if len(edges) < 2:
            return
        widths = np.diff(edges)
        taus = (edges[:-1, None] + widths[:, None] * np.linspace(0.0, 1.0, PLACES)).ravel()
        gaps, _, loads = segment.state(taus, *block.at(np.minimum(taus, end)))
        rides = segment.modes == RIDING
        weights = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
        weights = (widths[:, None] * weights).ravel()
        self.time += float(widths.sum())
        self.riding += rides * widths.sum()
        self.held += (segment.modes == HELD) * widths.sum()
        self.impulse += rides * (weights @ loads)
        self.cubed += weights @ np.maximum(gaps, 0.0) ** 3
        self._see("largest_gap", gaps, taus, segment, np.max)
        if rides.any():
            for name, best in (("least_load", np.min), ("largest_load", np.max)):
                self._see(name, np.where(rides, loads, -np.inf if best is np.max else np.inf), taus, segment, best)

    def _see(self, name, values, taus, segment, best):
        found = float(best(values))
        if best([found, self.extremes[name][0]]) == found and found != self.extremes[name][0]:
            at, j = np.unravel_index(values.argmax() if best is np.max else values.argmin(), values.shape)
            self.extremes[name] = (found, float(segment.time + taus[at]), int(j))

    def state(self) -> dict:
        """What a continued run needs."""
        return {"time": self.time, "extremes": {name: list(row) for name, row in self.extremes.items()},
                **{name: getattr(self, name).tolist() for name in ("riding", "held", "impulse", "cubed")}}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.time = state["time"]
        self.extremes = {name: tuple(np.inf if x is None and name == "least_load" and k == 0 else x
                                     for k, x in enumerate(row)) for name, row in state["extremes"].items()}  # fmt: skip
        for name in ("riding", "held", "impulse", "cubed"):
            setattr(self, name, np.array(state[name]))
