"""How wrong a run is: its energy audit, one number that exposes a wrong sign in any scene, and its global error by the
defect (Zadunaisky), what each accepted step leaves over of the equations of motion, answered linearly
(simulation/film_error.py does the same for what a film leaves over).

**Source** Zadunaisky (1976), Numer. Math. 27, 21-39: the defect of an interpolant gives the global error.
**Valid** of the global error: multistep methods, whose steps are short beside the motion (a tenth of a radian leaves
1e-9); errors small beside the motion; a scene near enough to its linearisation.  An estimate, not a bound.
"""

import math
from typing import Any

import numpy as np

from ..numerics.kernel import outer_kernel
from .contract import Retry

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
        self.segment: Any = None
        self.exchanged, self.stored, self.work = 0.0, 0.0, 0.0
        # By unknowns and by powers.
        self.worst = [0.0 if solved else np.inf, 0.0]
        self.energy0: Any = None
        self.works0: Any = None
        self.last: Any = None

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
        self.work, self.stored = state["done"], state["stored"]

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


# By how much a tolerance is sharpened when errors grow too large.
SHARPER = 10.0
# Steps of a block at which its errors are added to the motion.
LOOKS = 8
# They are looked at again where the errors of the motion exceed what they were by this.
NOTABLE = 1.2


class GlobalErrorEstimate:
    """An observer of the error so far, carried along a run of constant conditions; every ring has mass.  `worst` is the
    largest of any displacement at any step, relative to its scale, and of what else is `looked_at` (an object as
    ErrorScales of simulation/verification_run.py, or None), rates at any step, loads at a few where these are largest;
    beyond `allowed` a run had better use a sharper tolerance than its own `tolerance`, down to `least`.  Not `sound`:
    the eigenvectors nearly coincide, and nothing is estimated."""

    def __init__(self, segment, allowed: float = math.inf, least: float = 0.0, looked_at=None):
        self.segment, self.motion, self.allowed, self.least = segment, segment.exact_motion(), allowed, least
        self.looked_at = looked_at
        self.tolerance = least
        self.worst, self.moved, self.modal = 0.0, 0.0, np.zeros(len(self.motion.values), dtype=complex)
        self.sound = self.motion.sound
        if self.sound:
            lengths = segment.scales[: segment.n, None]
            self.shapes = self.motion.vectors[: segment.n] / lengths
            if looked_at is not None:
                rates = self.motion.vectors[segment.rate_places] / (lengths * looked_at.rate)
                self.shapes = np.vstack([self.shapes, rates])

    def begin(self, segment, tau, y):
        """Nothing to do: errors go on over a segment's start."""

    def accept(self, block):
        """The errors of a block's steps; a Retry where they pass what is allowed and a sharper tolerance is left."""
        if block.whole <= block.begin or not self.sound:
            return None
        before, t, ys, begin, end = self.state(), block.t, block.ys, block.begin, block.end
        n = self.segment.n_mechanical
        defects = np.diff(ys[begin : end + 1, :n], axis=0) - block.increments[:, :n]
        errors = np.empty((end - begin, len(self.modal)), dtype=complex)
        _answer(self.motion.values, np.diff(t[begin : end + 1]), defects @ self.motion.inverse.T, self.modal, errors)
        sizes = np.max(np.abs((errors @ self.shapes.T).real), axis=1)
        moved = float(sizes.max())
        if self.looked_at is not None and moved > NOTABLE * self.moved:
            self.worst = max(self.worst, self._loads(block, errors, int(sizes.argmax())))
        self.worst, self.moved = max(self.worst, moved), max(self.moved, moved)
        if self.worst > self.allowed and self.tolerance > self.least:
            self.restore(before)
            self.tolerance = max(self.tolerance / SHARPER, self.least)
            return Retry(self.tolerance)
        return None

    def _loads(self, block, errors, largest) -> float:
        """The largest error of what is looked at, at the step with the `largest` of the `errors` (m, modes) and at a
        few others, where these are added to the motion."""
        picked = np.unique([largest, *np.linspace(0, len(errors) - 1, LOOKS).round().astype(int)])
        ys = block.ys[block.begin + 1 + picked]
        moved = ys.copy()
        moved[:, : self.segment.n_mechanical] += (errors[picked] @ self.motion.vectors.T).real
        taus = block.t[block.begin + 1 + picked]
        here, there = (self.looked_at.of(self.segment, taus, *self.segment.motion(y, y)) for y in (ys, moved))
        return float(self.looked_at.errors(there, here).max())

    def state(self) -> dict:
        """What a continued run needs: `worst`, of displacements and rates `moved`, modal errors (modes,) as real and
        imaginary parts."""
        return {
            "worst": self.worst,
            "moved": self.moved,
            "real": self.modal.real.tolist(),
            "imag": self.modal.imag.tolist(),
        }

    def restore(self, state: dict):
        """Go on from `state`."""
        self.worst, self.moved = state["worst"], state["moved"]
        self.modal = np.array(state["real"]) + 1j * np.array(state["imag"])


def _answer(values, widths, pushes, state, out):
    """Modal errors `out` (m, n) after each step: the `state` before it, carried on, and what the step has left over,
    spread over it; `state` is left at the end."""
    z = widths[:, None] * values
    grown, slow = np.exp(z), np.abs(z) < 1e-6
    spread = np.where(slow, 1.0 + 0.5 * z, (grown - 1.0) / np.where(slow, 1.0, z))
    _carry(grown, spread * pushes, state, out)


@outer_kernel()
def _carry(grown, pushes, state, out):
    """`state` (n,) times `grown` and plus `pushes` (m, n) row by row, into `out`."""
    for k in range(len(grown)):
        for i in range(len(state)):
            state[i] = grown[k, i] * state[i] + pushes[k, i]
            out[k, i] = state[i]
