"""Energy audit: one number that exposes a wrong sign in any scene."""

import numpy as np


class EnergyAudit:
    """An observer of the energy balance: largest |dE - sum of works| (J) over the sum of integrals of |power| (J), at
    every step.

    Works are those among the unknowns; or better (`from_powers`), where steps are short, the integrals of the powers at
    the steps: of the errors that a multistep method makes in works, nothing forgets.
    """

    def __init__(self, from_powers: bool = False):
        self.from_powers, self.segment = from_powers, None
        self.worst, self.exchanged, self.work = 0.0, 0.0, 0.0
        self.energy0 = self.works0 = self.last = None

    def begin(self, segment, tau, y):
        """A segment begins at `tau` (s), `y` (size,); the first fixes the zero of energy and works.  At a step of an
        imposed motion the spring energy jumps (its end is moved in no time): that work is booked here."""
        self.segment = segment
        energy = float(segment.energies(np.array([tau]), y[None, :])[0])
        if self.energy0 is None:
            self.energy0, self.works0 = energy, y[segment.works].sum()
        else:
            self.energy0 += energy - self.last
        self.last = energy

    def accept(self, block):
        """Check the steps of a block."""
        begin, end, t, ys = block.begin, block.whole, block.t, block.ys
        if end <= begin:
            return
        works_at = self.segment.works
        energies = self.segment.energies(t[begin + 1 : end + 1], ys[begin + 1 : end + 1])
        if not self.from_powers:
            works = ys[begin + 1 : end + 1, works_at].sum(axis=1) - self.works0
        else:
            works = self.work + np.cumsum(block.increments[: end - begin, works_at].sum(axis=1))
            self.work = float(works[-1])
        defects = np.abs(energies - self.energy0 - works)
        self.worst = max(self.worst, float(defects.max()))
        self.last, self.exchanged = float(energies[-1]), float(ys[end, -1])

    def state(self) -> dict:
        """What a continued run needs: worst defect, energy exchanged, energies and works (J)."""
        return {"worst": self.worst, "moved": self.exchanged, "energy0": self.energy0, "works0": self.works0,
                "last": self.last, "done": self.work}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.worst, self.exchanged, self.last = state["worst"], state["moved"], state["last"]
        self.energy0, self.works0 = state["energy0"], state["works0"]
        self.work = state.get("done", 0.0)

    def residual(self) -> float:
        """The largest defect over the energy exchanged, dimensionless; 0 when nothing is exchanged."""
        return self.worst / self.exchanged if self.exchanged > 0 else 0.0
