"""A scene linearised about its equilibrium: matrices, steady state, exact motion of a linear scene.

That equilibrium is the aligned one, but where the faces press with a moment: there the rings rest tilted."""

import numpy as np

from ..faces import geometry
from ..faces.film_thickness import h_min
from ..faces.geometry import COLLAPSE, DZ, FORCE, GX, GY, wide_ring
from ..scene.film import follows_speed
from ..scene.patterns import grooves_of, waves_of
from ..scene.rings import ROTOR, STATOR, stuck_support
from ..scene.scene import SceneError
from .equations import OFFSET
from .equilibrium import axial_shift
from .imposed_motion import AXIAL, FIXED_AXIS, FIXED_MOMENT, ON_RING, OWN, PULL, ROW, TURNING, UNBALANCE, rest_state
from .intervals import constant_and_slope, modulo_turn
from .modes import MOTIONS, QUARTER_TURN, FilmDoubt, Harmonic, LinearScene, RingNumbers
from .stability_thresholds import Whirl, all_at_once, one_by_one
from .swept_motion import sweeps_of

GAP = [DZ, GX, GY]
# Corrections of a tilted rest, and the last of them, in clearances, after which it is known.
MOST_CORRECTIONS, RESTS = 30, 1e-8


def linear_scene(model, interval, speed: float | None = None, shift: float | None = None) -> LinearScene:
    """The linearised scene at an interval's start, or at another shaft speed (rad/s), or with aligned faces at another
    `shift` (m) of the gap.

    **Source** a film meets the mean spin wm only beside the rate of the tilt, g' - i wm g (Green 1989, eq. 2): at
    another speed it needs no other linearisation.
    **Valid** no floor of the pressure that small motion meets, no waves, which have a wedge of their own, and neither
    inertia of the fluid, grooves nor coning that follows the speed, which move the gap with it: such a film is
    linearised at every speed, as is one whose numbers are given at each.  Raises SceneError at a speed at which no
    aligned film holds the closing force.
    """
    w_r = constant_and_slope(model.scene.shaft.speed, interval)[0] if speed is None else speed
    w_s = constant_and_slope(model.scene.stator.speed, interval)[0]
    resting = shift is None and model.unknowns.faces_tilt
    if shift is None:
        if speed is not None and moves_with_speed(model.given):
            shift, balanced = axial_shift(model, interval, speed)
            if not balanced:
                found = f"{speed:g} rad/s, at which no film holds the closing force"
                raise SceneError("shaft.speed", found, "a speed at which inertia, coning and grooves leave such a film")
        else:
            shift = model.axial_shift(interval)
    interface, spin, film, rest = model.interface, 0.5 * (w_r + w_s), None, None
    rings = []
    for k, ring in enumerate((model.scene.stator, model.scene.rotor)):
        support = stuck_support(ring)
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
                uneven=support.tilt_difference() if support else 0.0,
                axis=modulo_turn(interval.angles[1 - k]) + support.tilt_axis if support else 0.0,
            )
        )
    if linear_in_speed(model, interval):
        slopes, goes_with = model.still_film(interval, shift), spin
        stiffness = slopes.stiffness - spin * slopes.damping @ QUARTER_TURN
    else:
        tilted = tilted_rest(model, interval, rings, spin, shift) if resting else None
        if tilted is not None:
            slopes, film, rest = tilted
        else:
            s, steps = rest_state(model.scene, interface.clearance, interval, spin, shift)
            film = interface.linear_film(s, steps) if interface.stores else None
            slopes = interface.slopes_about(s, steps, film=film)
        goes_with, stiffness = 0.0, slopes.stiffness
    if film is not None and any(ring.turns_uneven for ring in rings):
        key = f"{model.unknowns.turning_supports[0]}.tilt_stiffness"
        raise SceneError(key, "two that turn, beside a film that stores", "one, or a film with one stiffness")
    error_k, error_d = slopes.stiffness_error, slopes.damping_error
    tilt = max(error_k[1, 1], error_k[2, 2]), max(error_d[1, 1], error_d[2, 2])
    if not goes_with:
        # The wedge is as wrong as it is, whatever the damping.
        tilt = tilt[0] + max(error_k[1, 2], error_k[2, 1]), tilt[1]
    doubt = FilmDoubt((error_k[0, 0], error_d[0, 0]), tilt, goes_with)
    return LinearScene(rings, stiffness, slopes.damping, film, doubt, rest)


def tilted_rest(model, interval, rings, spin: float, shift: float):
    """Where rings whose faces press with a moment rest, from `shift` (m) of the aligned gap on, at an interval's start
    and a mean `spin` (rad/s): Slopes and LinearFilm (None of a film that does not store) about it, and displacements
    (n,) of the floating rings; None where it is not found.

    Newton's method on forces and moments of film, asperities, supports and closing force.
    **Valid** patterns that stand still (films/__init__.py takes no others), so that the rest does; no forcing.
    """
    interface, face = model.interface, model.face
    s, steps = rest_state(model.scene, interface.clearance, interval, spin, shift)
    closing, thin = np.array([model.closing.over(interval, model.scene.film)[0], 0.0, 0.0]), h_min(face, s)[0]
    supports = LinearScene(rings, np.zeros((3, 3)), np.zeros((3, 3)))
    # Displacements in clearances, of the axial gap and of the outer edge.
    units = np.tile([model.clearance, *2 * [model.clearance / model.scene.film.outer_radius]], len(supports.floating))
    q = np.linalg.pinv(supports.gap) @ [shift, 0.0, 0.0]
    try:
        for _ in range(MOST_CORRECTIONS):
            s[GAP] = supports.gap @ q
            near = min(1.0, h_min(face, s)[0] / thin) if not model.scene.contact else 1.0
            reach = tuple(near * step for step in steps)
            film = interface.linear_film(s, reach) if interface.stores else None
            slopes = interface.slopes_about(s, reach, film=film)
            interface.wrench(interface.whole[0], s)
            left = supports.stiffness @ q - supports.gap.T @ (s[FORCE : FORCE + 3] - closing)
            step = np.linalg.solve(LinearScene(rings, *slopes[:2]).stiffness, left)
            if np.max(np.abs(step / units)) < RESTS:
                return slopes, film, q
            # Not through the other face.
            for _ in range(MOST_CORRECTIONS):
                s[GAP] = supports.gap @ (q - step)
                if h_min(face, s)[0] > face[COLLAPSE]:
                    break
                step = 0.5 * step
            q = q - step
    except (SceneError, np.linalg.LinAlgError):
        # No film there.
        pass
    return None


def linear_in_speed(model, interval=None) -> bool:
    """Whether the matrices at any shaft speed, the rest as at an interval's start, follow from one linearisation of the
    film."""
    interface = model.interface
    plain = interface.floor_is_clear(interval) and interface.unknowns is None and not interface.film.as_given
    return plain and not moves_with_speed(model.given) and not waves_of(model.scene)


def moves_with_speed(scene) -> bool:
    """Whether the aligned gap of a scene is another at another speed."""
    film = scene.film
    return film.inertia or follows_speed(film) or film.heat is not None or bool(grooves_of(scene)[1])


def whirl_over_speed(model, interval):
    """Eigenvalues of the whirl over the shaft's speed in its own direction, the rest as at an interval's start: the
    function `values` of stability_thresholds.py, and the Whirl they are those of (None where the matrices are not
    linear in the speed)."""
    linear = model.linear_scene(interval)
    direction = -1.0 if linear.rings[ROTOR].spin < 0.0 else 1.0
    whirl = _whirl(linear) if linear_in_speed(model, interval) else None
    if whirl is None:
        return _whirl_of_matrices(model, interval, direction, linear), None
    whirl = whirl if direction > 0.0 else whirl.mirrored()
    return all_at_once(whirl), whirl


def _whirl_of_matrices(model, interval, direction, linear):
    """The function `values` of a scene whose matrices are not those of a Whirl."""

    def at_speed(w):
        return model.linear_scene(interval, speed=w)

    found = None
    if linear.film is not None:
        from .film_modes import tilts_over_speed

        found = tilts_over_speed(at_speed, abs(linear.rings[ROTOR].spin) or model.reference_rate, direction)
    return found or one_by_one(at_speed, direction)


# Place of the tilts among LinearScene's motions.
TILT = MOTIONS.index("tilt")


def _whirl(linear) -> Whirl | None:
    """The tilts of a linear scene, for any shaft speed; None where the film is not the same in all directions."""
    motions = linear.motions()
    if motions is None:
        return None
    _, (film_d, film_k), doubt = motions
    rings = [linear.rings[k] for k in linear.floating]
    numbers = [(r.inertia, r.polar, r.tilt_stiffness, r.tilt_damping, r.sign < 0.0) for r in rings]
    bounds = doubt[0][TILT], doubt[1][TILT]
    return Whirl(numbers, film_k[TILT].real, film_d[TILT].real, bounds, linear.rings[STATOR].spin)


def check_harmonic(segment) -> None:
    """Raises SceneError where samples move a carrier or pull at a ring, or a sweep does."""
    for key in segment.records:
        raise SceneError(key, "samples, which have no harmonics", "tones, or a run in time")
    if not segment.harmonic:
        key, _ = sweeps_of(segment.model.scene)[0]
        raise SceneError(key, "a sweep, which has no harmonics", "tones, or a run in time")


def harmonics(segment) -> list[Harmonic]:
    """The imposed oscillators of a segment as harmonics in its time (constant amplitude and speed), without what
    samples and sweeps impose."""
    found = []
    for ring, kind, amplitude, _, cos, sin, a0, a1, _ in segment.rows.reshape(-1, ROW):
        phasor = amplitude * np.exp(1j * a0)
        shape = np.zeros(3, dtype=complex)
        if kind == PULL and amplitude and not a1 and not segment.model.interface.film.constant:
            # What stands moves the gap about which the film is linearised (equilibrium.py).
            continue
        if kind in (AXIAL, PULL):
            shape[0] = phasor
        elif kind not in (FIXED_AXIS, FIXED_MOMENT):
            shape[1], shape[2] = phasor, -1j * phasor
        else:
            shape[1], shape[2] = phasor * cos, phasor * sin
        none = np.zeros(3, dtype=complex)
        if kind == UNBALANCE:
            shape *= 1j * a1**2
        moves, own = kind in (AXIAL, TURNING, FIXED_AXIS), kind == OWN
        moment = shape if kind in ON_RING else None
        found.append(Harmonic(a1, int(ring), shape if moves else none, shape if own else none, moment))
    return found + (_of_offset_faces(segment) if segment.p[OFFSET] else [])


def _of_offset_faces(segment) -> list[Harmonic]:
    """What the offset of a face does to the floating rings: the closing force on its arm to the wider one, and to both
    the film of coned faces that slide."""
    block, interval, model = segment.p[OFFSET:], segment.interval, segment.model
    speeds = [constant_and_slope(ring.speed, interval)[0] for ring in (model.scene.stator, model.scene.shaft)]
    pace, angle = (speeds[1], interval.rotor_angle) if block[geometry.OF_ROTOR] else (speeds[0], interval.stator_angle)
    # The narrower face's centre (m), x + i y, and the rate of the tilt, per m of it, that a coned film feels.
    centre = block[geometry.OFFSET] * np.exp(1j * (block[geometry.DIRECTION] + modulo_turn(angle)))
    coning = block[geometry.CONED] + model.coning_change(interval)
    coned = (0.5 * sum(speeds) - pace) * coning / block[geometry.MEAN_RADIUS]
    linear, none = model.linear_scene(interval), np.zeros(3, dtype=complex)
    force, found = model.closing.over(interval, model.scene.film)[0], []
    for k in linear.floating:
        push = -linear.film_d[1, 1] * coned * centre - (1j * force * centre if k == wide_ring(block) else 0.0)
        found.append(Harmonic(pace, k, none, none, linear.rings[k].sign * push * np.array([0.0, 1.0, -1j])))
    return found


def steady_motion(segment):
    """Linear steady state of a segment: a function of its time (s) giving (displacements, rates) (m, rad) of all
    floating rings' three unknowns each; the list of (harmonic, complex answer); and the LinearScene."""
    linear = segment.model.linear_scene(segment.interval)
    answers = linear.answers(harmonics(segment))

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
        order = np.argsort(places)
        rows = np.array([*kept, *[len(linear.mass) + i for i in kept]])[order]
        # A motion that is none of the unknowns may lack its mass.
        self.matrix = linear.state_matrix(kept)[np.ix_(order, order)]
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
