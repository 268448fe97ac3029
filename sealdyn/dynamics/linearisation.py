"""A scene linearised about its aligned equilibrium: matrices, steady state, exact motion of a linear scene."""

import numpy as np

from ..scene.rings import STATOR
from .equilibrium import axial_shift
from .imposed_motion import AXIAL, FIXED_AXIS, OWN, ROW
from .interface import rest_state
from .intervals import constant_and_slope
from .modes import QUARTER_TURN, Harmonic, LinearScene, RingNumbers
from .whirl_speeds import all_at_once, one_by_one


def linear_scene(model, interval, speed: float | None = None, shift: float | None = None) -> LinearScene:
    """The linearised scene at an interval's start, or at another shaft speed (rad/s) or `shift` (m) of the gap.

    **Source** a film meets the mean spin wm only beside the rate of the tilt, g' - i wm g (Green 1989, eq. 2): at
    another speed it needs no other linearisation.
    **Valid** no floor of the pressure, which the motion tried may meet, and no inertia of the fluid: such a film is
    linearised at every speed, and inertia moves the gap with it.
    """
    w_r = constant_and_slope(model.scene.shaft.speed, interval)[0] if speed is None else speed
    w_s = constant_and_slope(model.scene.stator.speed, interval)[0]
    if shift is None:
        moves = speed is not None and model.scene.film.inertia
        shift = axial_shift(model, interval, speed)[0] if moves else model.axial_shift(interval)
    interface, spin, film = model.interface, 0.5 * (w_r + w_s), None
    if speed is None or not linear_in_speed(model):
        if interface.stores:
            film = interface.linear_film(*rest_state(model.scene, interface.clearance, interval, spin, shift))
        stiffness, damping = interface.linearised(interval, spin, shift, film=film)
    else:
        still, damping = model.still_film(interval, shift)
        stiffness = still - spin * damping @ QUARTER_TURN
    rings = []
    for k, ring in enumerate((model.scene.stator, model.scene.rotor)):
        support = ring.support
        tilt_k, tilt_d = support.tilt() if support else (0.0, 0.0)
        rings.append(
            RingNumbers(
                sign=1.0 if k == STATOR else -1.0,
                floats=model.unknowns.floats[k],
                mass=ring.mass,
                inertia=ring.transverse_inertia,
                polar=ring.polar_inertia,
                axial_stiffness=support.axial_stiffness if support else 0.0,
                axial_damping=support.axial_damping if support else 0.0,
                tilt_stiffness=tilt_k,
                tilt_damping=tilt_d,
                spin=w_s if k == STATOR else w_r,
            )
        )
    return LinearScene(rings, stiffness, damping, film)


def linear_in_speed(model) -> bool:
    """Whether the matrices at any shaft speed follow from one linearisation of the film."""
    film = model.scene.film
    return film.cavitation_pressure is None and not film.inertia and model.interface.unknowns is None


def whirl_over_speed(model, interval, fastest: float):
    """Eigenvalues of the whirl over shaft speed up to the `fastest` (rad/s), the rest as at an interval's start: the
    function `values` of whirl_speeds.py."""

    def at_speed(w):
        return model.linear_scene(interval, speed=w)

    found = all_at_once(at_speed, fastest) if linear_in_speed(model) else None
    return found or one_by_one(at_speed)


def harmonics(segment) -> list[Harmonic]:
    """The imposed oscillators of a segment as harmonics in its time (constant amplitude and speed)."""
    found = []
    for ring, kind, amplitude, _, cos, sin, a0, a1, _ in segment.rows.reshape(-1, ROW):
        phasor = amplitude * np.exp(1j * a0)
        shape = np.zeros(3, dtype=complex)
        if kind == AXIAL:
            shape[0] = phasor
        elif kind != FIXED_AXIS:
            shape[1], shape[2] = phasor, -1j * phasor
        else:
            shape[1], shape[2] = phasor * cos, phasor * sin
        none = np.zeros(3, dtype=complex)
        found.append(Harmonic(a1, int(ring), none if kind == OWN else shape, shape if kind == OWN else none))
    return found


def steady_motion(segment):
    """Linear steady state of a segment: a function of its time (s) giving (displacements, rates) (m, rad) of all
    floating rings' three unknowns each; the list of (harmonic, complex answer); and the LinearScene."""
    linear = segment.model.linear_scene(segment.interval)
    answers = [(h, linear.response(h)) for h in harmonics(segment)]

    def at(tau):
        q, rate = np.zeros(len(linear.mass)), np.zeros(len(linear.mass))
        for h, answer in answers:
            turned = answer * np.exp(1j * h.frequency * tau)
            q += turned.real
            rate += (1j * h.frequency * turned).real
        return q, rate

    return at, answers, linear


class ExactMotion:
    """Exact solution of a linear scene with constant parameters, in the order of the mechanical unknowns: what is
    forced, and what is left of any start.
    **Source** Golub & Van Loan (2013), Matrix Computations, 9.1: exp(A t) by eigenvectors; where these nearly
    coincide, by scaling and squaring."""

    # Condition of the eigenvectors beyond which rounding shows.
    WORST = 1e6

    def __init__(self, segment):
        _, answers, linear = segment.steady_motion()
        kept, places = segment.model.unknowns.among_three(), [*range(segment.n), *segment.rate_places]
        rows = np.array([*kept, *[len(linear.mass) + i for i in kept]])[np.argsort(places)]
        self.matrix = linear.state_matrix()[np.ix_(rows, rows)]
        self.frequencies = np.array([h.frequency for h, _ in answers])
        both = [np.concatenate([answer, 1j * h.frequency * answer])[rows] for h, answer in answers]
        self.answers = np.array(both).reshape(len(answers), len(rows))
        self.values, vectors = np.linalg.eig(self.matrix)
        self.sound = np.linalg.cond(vectors) < self.WORST
        self.vectors, self.inverse = vectors, np.linalg.inv(vectors) if self.sound else None

    def forced(self, taus) -> np.ndarray:
        """Steady motion (m, n) at segment times."""
        return (np.exp(1j * np.outer(taus, self.frequencies)) @ self.answers).real

    def free(self, start, ages) -> np.ndarray:
        """What becomes (m, n) of a free motion `start` (n,) after `ages` (m,)."""
        if not self.sound:
            # Rarely needed, and loaded only then.
            from scipy.linalg import expm

            return np.array([expm(self.matrix * age) @ start for age in ages])
        return (np.exp(np.outer(ages, self.values)) @ ((self.inverse @ start)[:, None] * self.vectors.T)).real

    def parts(self, start, scales) -> tuple[np.ndarray, np.ndarray]:
        """Exponents (1/s) of the free motion `start` and of the forced one, and how large each is beside `scales`."""
        shares = self.vectors * (self.inverse @ start) if self.sound else np.tile(start[:, None], len(start))
        sizes = np.concatenate([shares.T, self.answers]) / scales
        return np.concatenate([self.values, 1j * self.frequencies]), np.max(np.abs(sizes), axis=1, initial=0.0)
