"""Energy audit: one number that exposes a wrong sign in any scene."""

import numpy as np

# Accuracies that the residual of a sound run stays below.
ALLOWED = 10.0
# Work below this share of the energy that stands in springs and motion is not told from its rounding.
TELLING = 1e-3


class EnergyAudit:
    """An observer of the energy balance: largest |dE - sum of works| (J) over the sum of integrals of |power| (J), at
    every step.  Where nothing moves against anything (a stuck ring that turns with its shaft) that sum is a rounding:
    the defect is then measured by the energy that stands there.

    Works are found twice, and the better ones count: as unknowns of the solver, of whose errors nothing forgets, and as
    integrals of the powers over the steps, which long steps do not resolve.  An equation that does not do what its
    works say shows in both.  `solved`: whether the solver has worked them out.
    """

    def __init__(self, solved: bool = True):
        self.segment, self.exchanged, self.stored, self.work = None, 0.0, 0.0, 0.0
        # By unknowns and by powers.
        self.worst = [0.0 if solved else np.inf, 0.0]
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
        gained = energies - self.energy0
        self.stored = max(self.stored, float(np.abs(energies).max()))
        self._see(0, gained - (ys[begin + 1 : end + 1, works_at].sum(axis=1) - self.works0))
        if block.slopes is None:
            # A ring without mass has no power at a step.
            self.worst[1] = np.inf
        else:
            works = self.work + np.cumsum(block.increments[: end - begin, works_at].sum(axis=1))
            self.work = float(works[-1])
            self._see(1, gained - works)
        self.last, self.exchanged = float(energies[-1]), float(ys[end, -1])

    def _see(self, way, defects):
        self.worst[way] = max(self.worst[way], float(np.abs(defects).max()))

    def state(self) -> dict:
        """What a continued run needs: worst defects, energy exchanged, energies and works (J)."""
        return {"worst": self.worst, "moved": self.exchanged, "stored": self.stored, "energy0": self.energy0,
                "works0": self.works0, "last": self.last, "done": self.work}  # fmt: skip

    def restore(self, state: dict):
        """Go on from `state`."""
        self.worst, self.exchanged, self.last = state["worst"], state["moved"], state["last"]
        self.energy0, self.works0 = state["energy0"], state["works0"]
        self.work, self.stored = state.get("done", 0.0), state.get("stored", 0.0)

    def residual(self) -> float:
        """The largest defect over the energy exchanged, dimensionless; 0 when nothing is exchanged."""
        if not self.exchanged > 0:
            return 0.0
        # Where only the solver's own works tell, no finer than by the energy that they are solved to a share of.
        finest = float(self.segment.scales[self.segment.works.start]) if np.isinf(self.worst[1]) else 0.0
        return min(self.worst) / max(self.exchanged, TELLING * self.stored, finest)


def missing_energy(residual: float, accuracy: float) -> str | None:
    """A sentence where the residual of a run's audit is larger than its accuracy lets it be, else None; NaN: of a run
    that was not audited."""
    if not residual > ALLOWED * accuracy:
        return None
    return (
        f"energy audit: {residual:.1e} of the work exchanged is not accounted for, {ALLOWED * accuracy:.0e} is "
        "allowed: do not trust this run"
    )
