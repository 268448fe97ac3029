"""Defect-based global error estimate (Zadunaisky): what each accepted step leaves over of the equations of motion,
answered linearly (simulation/film_error.py does the same for what a film leaves over).

**Source** Zadunaisky (1976), Numer. Math. 27, 21-39: the defect of an interpolant gives the global error.
**Valid** multistep methods, whose steps are short beside the motion (a tenth of a radian leaves 1e-9); errors small
beside the motion; a scene near enough to its linearisation.  An estimate, not a bound.
"""

import cmath
import math

import numpy as np

from ..numerics.kernel import outer_kernel
from .contract import Retry

# By how much a tolerance is sharpened when errors grow too large.
SHARPER = 10.0


class GlobalErrorEstimate:
    """An observer of the error of the displacements so far, carried along a run of constant conditions; every ring has
    mass.  `worst` is the largest of any displacement at any step, relative to its scale; beyond `allowed` a run had
    better use a sharper tolerance than its own `tolerance`, down to `least`.  Not `sound`: the eigenvectors nearly
    coincide, and nothing is estimated."""

    def __init__(self, segment, allowed: float = math.inf, least: float = 0.0):
        self.segment, self.motion, self.allowed, self.least = segment, segment.exact_motion(), allowed, least
        self.tolerance = least
        self.worst, self.modal = 0.0, np.zeros(len(self.motion.values), dtype=complex)
        self.sound = self.motion.sound
        if self.sound:
            self.shapes = self.motion.vectors[: segment.n] / segment.scales[: segment.n, None]

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
        self.worst = max(self.worst, float(np.max(np.abs((errors @ self.shapes.T).real))))
        if self.worst > self.allowed and self.tolerance > self.least:
            self.restore(before)
            self.tolerance = max(self.tolerance / SHARPER, self.least)
            return Retry(self.tolerance)
        return None

    def state(self) -> dict:
        """What a continued run needs: `worst`, and the modal errors (modes,) as real and imaginary parts."""
        return {"worst": self.worst, "real": self.modal.real.tolist(), "imag": self.modal.imag.tolist()}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.worst, self.modal = state["worst"], np.array(state["real"]) + 1j * np.array(state["imag"])


@outer_kernel()
def _answer(values, widths, pushes, state, out):
    """Modal errors `out` (m, n) after each step: the `state` before it, carried on, and what the step has left over,
    spread over it; `state` is left at the end."""
    for k in range(len(widths)):
        for i in range(len(values)):
            z = values[i] * widths[k]
            # Not np.exp: it takes twice as long to compile.
            grown = cmath.exp(z)
            spread = (grown - 1.0) / z if abs(z) > 1e-6 else 1.0 + 0.5 * z
            state[i] = grown * state[i] + spread * pushes[k, i]
            out[k, i] = state[i]
