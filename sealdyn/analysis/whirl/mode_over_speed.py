"""A whirl mode along a change of speed: its eigenvalue, its shape, and what a small whirl grows by.

With the state matrix A(w), right vectors `A r = lambda r` and left ones `l A = lambda l`, a whirl `c(t) r(w(t))`
obeys, while w changes little within one period and one decay time of the others,

    c' = ( lambda - (l r') / (l r) w' ) c,      r' = d r/d w

so |c| grows by exp( integral of Re lambda dt - Re integral of (l r')/(l r) dw ).  The second part depends on the
speeds alone, not on how fast they are passed, and is nothing after a way up and back again.  With r so scaled
that its relative tilt is 1, c is the relative tilt.  A single ring `I x'' + D x' + k(w) x = 0` has
`(l r')/(l r) = lambda' / (2 lambda + D/I)`: its tilt carries the factor `(2 lambda + D/I)**(-1/2)`.
**Source** Fedoryuk (1993), Asymptotic Analysis, ch. 2 (WKB of a linear system).
**Valid** isotropic scenes; error of the order of w' times (slowest of the other modes)**-2.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import eig

from ...dynamics.model import Model

POINTS = 121


@dataclass(frozen=True)
class ModeOverSpeed:
    """One mode over speeds (m,) (rad/s): eigenvalue (m,) (1/s, imaginary part positive forward), right vectors
    (m, 2 n) of relative tilt 1, and the logarithm of the factor that depends on speed alone (m,)."""

    speeds: np.ndarray
    values: np.ndarray
    vectors: np.ndarray
    factor: np.ndarray

    @cached_property
    def _growth(self):
        return CubicSpline(self.speeds, self.values.real)

    @cached_property
    def _integral(self):
        return self._growth.antiderivative()

    @cached_property
    def _factor(self):
        return CubicSpline(self.speeds, self.factor)

    def growth(self, speed):
        """Growth rate (1/s) at a speed (rad/s)."""
        return self._growth(speed)

    def frequency(self, speed):
        """Whirl frequency (rad/s) at a speed (rad/s), positive forward."""
        return np.interp(speed, self.speeds, self.values.imag)

    def between(self, low, high):
        """Integral of the growth rate over the speed (rad/s^2) from low to high (rad/s): over the ramp rate (rad/s^2)
        it is the logarithm of the growth."""
        return self._integral(high) - self._integral(low)

    def gained(self, low, high):
        """Logarithm of the factor that depends on the speeds alone, from low to high (rad/s)."""
        return self._factor(high) - self._factor(low)


def tilt_mode(model: Model, low: float, high: float, at: float, interval=None) -> ModeOverSpeed:
    """The tilt mode that is least damped at the speed `at` (rad/s), over speeds from low to high.
    Raises ValueError for a scene with a massless ring or a film that stores."""
    if not np.all(np.diag(model.linear_scene(interval).mass) > 0):
        raise ValueError("a massless ring has no rates to follow its whirl by")
    speeds = np.linspace(low, high, POINTS)
    begin = int(np.argmin(np.abs(speeds - at)))
    values, vectors, lefts = [None] * POINTS, [None] * POINTS, [None] * POINTS

    def take(k, near):
        every = _turning(model.linear_scene(interval, speed=float(speeds[k])))
        n = int(np.argmax(every[0].real)) if near is None else int(np.argmin(np.abs(every[0] - near)))
        values[k], vectors[k], lefts[k] = every[0][n], every[1][n], every[2][n]

    take(begin, None)
    for k in range(begin + 1, POINTS):
        take(k, values[k - 1])
    for k in range(begin - 1, -1, -1):
        take(k, values[k + 1])
    values, vectors, lefts = np.array(values), np.array(vectors), np.array(lefts)
    changes = CubicSpline(speeds, vectors).derivative()(speeds)
    products = np.einsum("mi,mi->m", lefts, changes) / np.einsum("mi,mi->m", lefts, vectors)
    factor = CubicSpline(speeds, -products.real).antiderivative()(speeds)
    return ModeOverSpeed(speeds, values, vectors, factor - factor[begin])


def _turning(linear):
    """Tilt modes that turn as x + i y: eigenvalues, right vectors of relative tilt 1, left vectors."""
    values, from_left, right = eig(linear.state_matrix(), left=True, right=True)
    n, found = len(linear.mass), []
    signs = np.array([linear.rings[k].sign for k in linear.floating])
    for value, left, vector in zip(values, from_left.T, right.T, strict=True):
        shape = vector[:n]
        if np.linalg.norm(shape[0::3]) > 0.02 * np.linalg.norm(shape):
            continue
        tilt = signs @ (shape[1::3] + 1j * shape[2::3])
        if abs(tilt) > 1e-6 * np.linalg.norm(shape):
            # Of the pair the other member turns as x - i y.
            found.append((value, vector / tilt, left.conj()))
    return [np.array(part) for part in zip(*found, strict=True)]


def modal_disturbance(model: Model, mode: ModeOverSpeed, speed: float, amplitude: float) -> np.ndarray:
    """Change of the unknowns (size,) that adds a whirl of this mode with the relative tilt `amplitude` (rad)."""
    k = int(np.argmin(np.abs(mode.speeds - speed)))
    vector, value, kept = mode.vectors[k], mode.values[k], model.unknowns.among_three()
    # Twice: half of a real part turns the other way, and adds nothing to x + i y.
    return 2 * amplitude * model.vector(vector[kept].real, (value * vector[kept]).real)
