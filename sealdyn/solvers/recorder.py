"""A sink for the solver that keeps what it is given in memory."""

import numpy as np


class Recorder:
    """A sink that keeps displacements in memory, every `interval` seconds; none without an interval."""

    def __init__(self, interval: float | None = None):
        self.interval, self.parts = interval, []

    def due(self, segment):
        """Segment times (m,) (s) of output: whole multiples of the interval since the start of the run."""
        if self.interval is None:
            return np.empty(0)
        first, length = max(0, int(np.ceil(segment.time / self.interval - 1e-9))), segment.length
        taus = (first + np.arange(int(length / self.interval) + 2)) * self.interval - segment.time
        inside = (taus >= 0) & ((taus < length * (1 - 1e-12)) | segment.last) & (taus <= length * (1 + 1e-12))
        return np.clip(taus[inside], 0, length)

    def take(self, segment, taus, q, q_rate, x=None):
        """Keep displacements and rates (m, n) at segment times (m,) (s); the film's unknowns `x` are not kept."""
        self.parts.append((segment.time + taus, q, q_rate))

    def state(self, segment, tau, y):
        """The state reached: not kept."""

    def event(self, segment, tau, event):
        """A change of the equations: not kept."""

    def arrays(self):
        """Times (m,) (s, of the run), displacements (m, n), rates (m, n)."""
        return tuple(np.concatenate([part[i] for part in self.parts]) for i in range(3))
