"""Energy audit: one number that exposes a wrong sign in any scene."""

import numpy as np

from ..numerics.hermite import integrals


class Audit:
    """Energy balance: largest |dE - sum of works| over the sum of integrals of |power|, at every step.

    Works are those among the unknowns, or better, where the powers at the steps are known and steps are short, their
    integrals: of the errors that a multistep method makes in works, nothing forgets.
    """

    def __init__(self, problem):
        self.problem, self.worst, self.moved, self.done = problem, 0.0, 0.0, 0.0
        self.energy0 = self.works0 = self.last = None

    def begin(self, tau, y):
        """A leg begins; the first fixes the zero of energy and works.  At a step of an imposed motion the
        spring energy jumps (its end is moved in no time): that work is booked here."""
        energy = float(self.problem.energies(np.array([tau]), y[None, :])[0])
        if self.energy0 is None:
            self.energy0, self.works0 = energy, y[self.problem.works].sum()
        else:
            self.energy0 += energy - self.last
        self.last = energy

    def take(self, t, ys, begin, end, powers=None):
        """Check the steps (begin, end] of the running leg; `powers` (m, works) at all of them, or None."""
        if end <= begin:
            return
        energies = self.problem.energies(t[begin + 1 : end + 1], ys[begin + 1 : end + 1])
        if powers is None:
            works = ys[begin + 1 : end + 1, self.problem.works].sum(axis=1) - self.works0
        else:
            total = np.ascontiguousarray(powers.sum(axis=1)[:, None])
            works = self.done + np.cumsum(integrals(t, total, begin, end)[:, 0])
            self.done = float(works[-1])
        defects = np.abs(energies - self.energy0 - works)
        self.worst = max(self.worst, float(defects.max()))
        self.last, self.moved = float(energies[-1]), float(ys[end, -1])

    def kept(self) -> dict:
        """What a continued run needs."""
        return {"worst": self.worst, "moved": self.moved, "energy0": self.energy0, "works0": self.works0,
                "last": self.last, "done": self.done}  # fmt: skip

    def restore(self, kept: dict):
        """Go on from `kept`."""
        self.worst, self.moved, self.last = kept["worst"], kept["moved"], kept["last"]
        self.energy0, self.works0 = kept["energy0"], kept["works0"]
        self.done = kept.get("done", 0.0)

    def residual(self) -> float:
        """The one number; 0 when nothing is exchanged."""
        return self.worst / self.moved if self.moved > 0 else 0.0
