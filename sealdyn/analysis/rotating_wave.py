"""Circular whirl of the aligned seal, free of forcing, as a relative equilibrium: no time integration.

A scene without forcing looks the same from every angle, so it has motions that only turn: every tilt is
`q exp(i omega t)`, every axial displacement constant.  In the frame turning with omega that is a point where the
net moments equal `-omega^2 I q`.  The family of such points, shaft speed against whirl amplitude, leaves the
aligned seal at the stability threshold (a Hopf bifurcation): falling speed means subcritical.
**Source** Golubitsky, Stewart & Schaeffer (1988), Singularities and Groups II, ch. XVI (rotating waves).
**Valid** rings, supports and film alike in all directions (all of this package's), constant parameters.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import eig
from scipy.optimize import brentq, root

from ..dynamics import equations
from ..dynamics.imposed_motion import ROTOR_SPEED
from ..dynamics.linearisation import moves_with_speed
from ..dynamics.model import Model
from ..faces.geometry import smallest_gap
from ..scene.scene import Scene, frozen_at_start, refuse_uneven, unforced

SPEED_AT = equations.LEG_AT + ROTOR_SPEED
# A solution's residual, relative to the scales of force; central-difference step of the linearisation.
SOLVED, STEP = 1e-9, 1e-5
# Whirls of a family, about.
STEPS = 48


@dataclass(frozen=True)
class Whirl:
    """One circular whirl: amplitude |g| of the relative tilt (rad), shaft speed and whirl frequency (rad/s), axial
    opening of the gap (m), smallest film thickness (m), displacements `q` (n,) and unknowns `y` (size,), and
    growth rate (1/s) of the least damped disturbance of it at constant speed."""

    amplitude: float
    speed: float
    frequency: float
    opening: float
    h_min: float
    growth: float
    q: np.ndarray
    y: np.ndarray


def free_model(scene: Scene, speed: float, accuracy: float = 1e-8) -> Model:
    """Model of the unforced scene at a speed (rad/s), its film evaluated to `accuracy`, displacements counted from
    where the film holds the closing force: a gap that moves with the speed has moved."""
    scene = unforced(scene, speed)
    model = Model(scene, accuracy)
    shift = model.axial_shift() if moves_with_speed(model.scene) else 0.0
    if shift == 0.0:
        return model
    # What holds the film there, the supports' share in it.
    return Model(frozen_at_start(model.scene, clearance=model.clearance + shift), accuracy)


class RotatingWave:
    """Circular whirls of one free model: its segment, `n` displacements and their `scales` (n,), the places of tilts
    and axial displacements among them and their signs in the gap."""

    def __init__(self, model: Model):
        refuse_uneven(model.scene)
        self.model, self.segment, self.n = model, model.segment(), model.unknowns.n
        self.places = model.unknowns.rate_places
        names = model.unknowns.names
        self.tilts = [i for i, name in enumerate(names) if name.endswith("tilt_x")]
        self.signs = [1.0 if names[i].startswith("stator") else -1.0 for i in self.tilts]
        self.axial = [i for i, name in enumerate(names) if name.endswith("_z")]
        self.axial_signs = [1.0 if names[i].startswith("stator") else -1.0 for i in self.axial]
        self.scales = model.scales[: self.n]
        self.pace = model.reference_rate

    def turned(self, q) -> np.ndarray:
        """Displacements (n,) turned by a quarter in the tilt planes, zero along the axis."""
        out = np.zeros_like(q)
        for i in self.tilts:
            out[i], out[i + 1] = -q[i + 1], q[i]
        return out

    def state(self, q, frequency) -> np.ndarray:
        """Unknowns (size,) of a circular whirl of displacements `q` (n,): rates are the tilts turned by a quarter,
        times the frequency (rad/s)."""
        return self.model.vector(q, frequency * self.turned(q))

    def relative(self, q):
        """Relative tilt g_x + i g_y (rad), stator minus rotor, of displacements (n,) or (n, m)."""
        return sum(s * (q[i] + 1j * q[i + 1]) for s, i in zip(self.signs, self.tilts, strict=True))

    def opening(self, q) -> float:
        """How much wider the axial gap is (m) than the clearance, of displacements (n,)."""
        return float(sum(s * q[i] for s, i in zip(self.axial_signs, self.axial, strict=True)))

    def least_film(self, q) -> float:
        """Smallest film thickness over the face (m) of displacements (n,)."""
        change = self.model.coning_change(speed=self.segment.p[SPEED_AT])
        return float(smallest_gap(self.model.face, self.opening(q), abs(self.relative(q)), change)[0])

    def _accelerations(self, y, speed):
        self.segment.p[SPEED_AT] = speed
        yp = np.empty(self.segment.size)
        self.segment.rhs(0.0, y, yp)
        return yp

    def _unbalance(self, x, amplitude):
        """Accelerations left over (n,) and the two conditions that fix amplitude and phase; all scaled."""
        q, frequency, speed = x[: self.n] * self.scales, x[-2] * self.pace, x[-1] * self.pace
        yp = self._accelerations(self.state(q, frequency), speed)
        wanted = frequency**2 * self.turned(self.turned(q))
        rest = (yp[self.places] - wanted) / (self.scales * self.pace**2)
        condition = (self.relative(q) - amplitude) / self.scales[self.tilts[0]]
        return np.concatenate([rest, [condition.real, condition.imag]])

    def solve(self, amplitude: float, guess) -> Whirl | None:
        """The whirl of a relative amplitude (rad) near `guess` = (q (n,), frequency (rad/s), speed (rad/s)); None if
        there is none."""
        q, frequency, speed = guess
        x = np.concatenate([q / self.scales, [frequency / self.pace, speed / self.pace]])
        found = root(self._unbalance, x, args=(amplitude,), tol=1e-13)
        if not np.max(np.abs(found.fun)) < SOLVED:
            return None
        q, frequency, speed = found.x[: self.n] * self.scales, found.x[-2] * self.pace, found.x[-1] * self.pace
        y = self.state(q, frequency)
        return Whirl(
            amplitude, float(speed), float(frequency), self.opening(q), self.least_film(q),
            self._growth(y, frequency, speed), q, y,
        )  # fmt: skip

    def _growth(self, y, frequency, speed) -> float:
        """Largest growth rate (1/s) of disturbances in the turning frame, the neutral one of phase left out."""
        values = self.disturbances(y, frequency, speed)
        return float(np.max(np.delete(values, np.argmin(np.abs(values))).real))

    def disturbances(self, y, frequency, speed) -> np.ndarray:
        """Eigenvalues (1/s) of disturbances in the frame that turns at `frequency` (rad/s)."""
        m, scales = self.model.unknowns.n_mechanical, self.model.scales
        matrix = np.empty((m, m))
        for j in range(m):
            step, sides = STEP * scales[j], []
            for sign in (1, -1):
                moved = y.copy()
                moved[j] += sign * step
                sides.append(self._accelerations(moved, speed)[:m])
            matrix[:, j] = (sides[0] - sides[1]) / (2 * step)
        for i in self.tilts:
            for a, b in ((i, i + 1), (self.places[i], self.places[i + 1])):
                matrix[a, b] += frequency
                matrix[b, a] -= frequency
        return np.linalg.eigvals(matrix)

    def onset(self, speed: float):
        """Guess (q, frequency, speed) at zero amplitude: shape (n,) (relative tilt 1) and frequency (rad/s) of the
        least damped tilt mode at the threshold `speed` (rad/s)."""
        frequency, shape = least_damped(self.model, speed)
        return np.array(shape), frequency, speed


def least_damped(model: Model, speed: float) -> tuple[float, np.ndarray]:
    """Whirl frequency (rad/s, positive forward) and shape of the least damped tilt mode at a speed (rad/s): the
    displacements (n,) of a circular whirl whose relative tilt is 1 along the x axis."""
    linear = model.linear_scene(speed=speed)
    values, shapes = linear.eigen()
    tilting = [k for k in range(len(values)) if np.linalg.norm(shapes[0::3, k]) < 0.02 * np.linalg.norm(shapes[:, k])]
    k = max(tilting, key=lambda i: values[i].real)
    value, shape = values[k], shapes[:, k]
    # x + i y turns with exp(value t) or, of the conjugate eigenvalue, with its mirror image.
    forward, backward = shape[1::3] + 1j * shape[2::3], np.conj(shape[1::3] - 1j * shape[2::3])
    ahead = np.linalg.norm(forward) > np.linalg.norm(backward)
    whirl, frequency = (forward, value.imag) if ahead else (backward, -value.imag)
    signs = [linear.rings[r].sign for r in linear.floating]
    whirl = whirl / sum(s * w for s, w in zip(signs, whirl, strict=True))
    q = np.zeros(model.unknowns.n)
    for a, i in enumerate(i for i, name in enumerate(model.unknowns.names) if name.endswith("tilt_x")):
        q[i], q[i + 1] = whirl[a].real, whirl[a].imag
    return float(frequency), q


def branch(model: Model, threshold: float) -> list[Whirl]:
    """Circular whirls from the threshold speed (rad/s) up to contact, by continuation in the amplitude.

    The last one has its film at the floor, unless the family ends before (a fold in the amplitude).
    """
    wave = RotatingWave(model)
    shape, frequency, speed = wave.onset(threshold)
    floor = model.face[4]
    touching = contact_tilt_aligned(model)
    found, amplitude, step = [], 0.0, touching / STEPS
    while len(found) < 6 * STEPS and step > 1e-4 * touching:
        guess = _ahead(found, amplitude + step) if found else (shape * step, frequency, speed)
        whirl = wave.solve(amplitude + step, guess)
        if whirl is None:
            step /= 2
            continue
        if whirl.h_min < floor:
            return [*found, _at_contact(wave, found, whirl, floor)]
        found.append(whirl)
        amplitude += step
    return found


def contact_tilt_aligned(model: Model) -> float:
    """Relative tilt (rad) at which the faces touch without axial opening."""
    face, change = model.face, model.coning_change()
    beyond = 2 * (model.clearance / face[0] + abs(face[3] + change))
    return float(brentq(lambda tilt: smallest_gap(face, 0.0, tilt, change)[0], 0.0, beyond))


def _ahead(found, amplitude):
    """Guess by the last two whirls' straight line."""
    last = found[-1]
    if len(found) < 2:
        scale = amplitude / last.amplitude
        return last.q * scale, last.frequency, last.speed
    t = (amplitude - last.amplitude) / (last.amplitude - found[-2].amplitude)
    return tuple(getattr(last, n) + t * (getattr(last, n) - getattr(found[-2], n)) for n in ("q", "frequency", "speed"))


def _at_contact(wave, found, beyond, floor):
    """The whirl between the last one found and one beyond contact whose film is at the floor."""
    last = found[-1]
    kept = {}

    def excess(amplitude):
        kept[amplitude] = wave.solve(amplitude, (last.q * amplitude / last.amplitude, last.frequency, last.speed))
        return kept[amplitude].h_min - floor

    low = last.amplitude
    at = brentq(excess, low, beyond.amplitude, xtol=1e-12 * low, rtol=1e-12)
    return kept[at]


def kind_of(family: list[Whirl], threshold: float) -> str:
    """Of the whirls that leave the threshold (rad/s): subcritical (towards lower speed), supercritical, or
    with a fold."""
    speeds = np.array([threshold, *[w.speed for w in family]])
    falls, rises = np.all(np.diff(speeds) < 0), np.all(np.diff(speeds) > 0)
    if falls or rises:
        return "subcritical" if falls else "supercritical"
    return "subcritical, then turning" if speeds[1] < threshold else "supercritical, then turning"


def family_columns(family: list[Whirl]) -> dict:
    """Columns of a family of whirls, in SI."""
    names = {n: n for n in ("speed", "amplitude", "frequency", "opening", "h_min")} | {"growth_rate": "growth"}
    return {key: [getattr(w, name) for w in family] for key, name in names.items()}


def compared(row: dict, family: list[Whirl], stable: bool) -> dict:
    """A row {speed, whirl} of a run in time with the family's amplitude at its speed (rad; None where it has none of
    that stability) and the difference from it."""
    amplitudes, speeds = np.array([w.amplitude for w in family]), np.array([w.speed for w in family])
    speed_of, row["branch"], row["difference"] = CubicSpline(amplitudes, speeds), None, None
    for k in np.flatnonzero(np.diff(np.sign(speeds - row["speed"]))):
        if (family[k + 1].growth < 0) == stable:
            row["branch"] = float(brentq(lambda a: speed_of(a) - row["speed"], amplitudes[k], amplitudes[k + 1]))
            row["difference"] = row["whirl"] / row["branch"] - 1 if row.get("whirl") else None
    return row


# --- a mode along a change of speed ---
# A whirl mode along a change of speed: its eigenvalue, its shape, and what a small whirl grows by.
#
# With the state matrix A(w), right vectors `A r = lambda r` and left ones `l A = lambda l`, a whirl `c(t) r(w(t))`
# obeys, while w changes little within one period and one decay time of the others,
#
#     c' = ( lambda - (l r') / (l r) w' ) c,      r' = d r/d w
#
# so |c| grows by exp( integral of Re lambda dt - Re integral of (l r')/(l r) dw ).  The second part depends on the
# speeds alone, not on how fast they are passed, and is nothing after a way up and back again.  With r so scaled
# that its relative tilt is 1, c is the relative tilt.  A single ring `I x'' + D x' + k(w) x = 0` has
# `(l r')/(l r) = lambda' / (2 lambda + D/I)`: its tilt carries the factor `(2 lambda + D/I)**(-1/2)`.
# **Source** Fedoryuk (1993), Asymptotic Analysis, ch. 2 (WKB of a linear system).
# **Valid** isotropic scenes; error of the order of w' times (slowest of the other modes)**-2.

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


def tilt_mode(model: Model, low: float, high: float, at: float) -> ModeOverSpeed:
    """The tilt mode that is least damped at the speed `at` (rad/s), over speeds from low to high.
    Raises ValueError for a scene with a massless ring or a film that stores."""
    if not np.all(np.diag(model.linear_scene().mass) > 0):
        raise ValueError("a massless ring has no rates to follow its whirl by")
    speeds = np.linspace(low, high, POINTS)
    begin = int(np.argmin(np.abs(speeds - at)))
    values, vectors, lefts = [None] * POINTS, [None] * POINTS, [None] * POINTS

    def take(k, near):
        every = _turning(model.linear_scene(speed=float(speeds[k])))
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
