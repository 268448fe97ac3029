"""Defect-based global error estimate (Zadunaisky): what each accepted step leaves over of the equations of motion,
answered linearly (simulation/film_error.py does the same for what a film leaves over).

**Source** Zadunaisky (1976), Numer. Math. 27, 21-39: the defect of an interpolant gives the global error.
**Valid** multistep methods, whose steps are short beside the motion (a tenth of a radian leaves 1e-9); errors small
beside the motion; a scene near enough to its linearisation.  An estimate, not a bound.
"""

import math

import numpy as np

from ..numerics.kernel import outer_kernel
from .contract import Retry

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
    beyond
    `allowed` a run had better use a sharper tolerance than its own `tolerance`, down to `least`.  Not `sound`: the
    eigenvectors nearly coincide, and nothing is estimated."""

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
        pass

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
