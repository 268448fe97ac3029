"""A sink for the solver that keeps what it is given in memory."""

import numpy as np


class Recorder:
    """A sink that keeps displacements in memory, every `interval` seconds; none without an interval."""

    def __init__(self, problem, interval: float | None = None):
        self.problem, self.interval, self.parts = problem, interval, []

    def due(self, index):
        leg = self.problem.legs[index]
        if self.interval is None:
            return np.empty(0)
        first = max(0, int(np.ceil(leg.time / self.interval - 1e-9)))
        taus = (first + np.arange(int(leg.length / self.interval) + 2)) * self.interval - leg.time
        end = leg.length * (1 + 1e-12)
        last = index + 1 == len(self.problem.legs)
        return np.clip(taus[(taus >= 0) & ((taus < leg.length * (1 - 1e-12)) | last) & (taus <= end)], 0, leg.length)

    def take(self, index, taus, q, q_rate):
        self.parts.append((self.problem.legs[index].time + taus, q, q_rate))

    def state(self, index, tau, y):
        pass

    def event(self, index, tau, event):
        pass

    def arrays(self):
        """Times (m,), displacements (m, n), rates (m, n)."""
        return tuple(np.concatenate([part[i] for part in self.parts]) for i in range(3))
