"""How far the forcing of a seal may grow in linear theory, and what ends it: touch, or what the theory stands on."""

import math
from collections.abc import Callable

import numpy as np

from ..dynamics import modes
from ..dynamics.imposed_motion import rest_state
from ..dynamics.interface import flow_at_rest, opening_parts
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..faces.geometry import CONTACT_TORQUE, FLOW_INNER, INNER_PRESSURE, OUTER_PRESSURE, SPIN_DIFFERENCE, TORQUE, TOUCH
from ..scene import scene as scenes
from ..scene.patterns import waves_of
from ..scene.rings import SMALL_TILT
from .plausibility import room_to_open
from .stability import found_alone

# What ends the growth of the forcing: touch, small tilts, or one of those of `room_to_open`.
TOUCHED, TILTED = "touch", "small tilts"
# Of the value at which something ends, relative; beyond the largest (SI) linear theory is not asked.
LOCATED, LARGEST = 1e-9, 1e9


class NoOnset(ValueError):
    """Linear theory sees no value of a key at which the gap first closes."""


def largest_tilt(motion) -> float:
    """Largest tilt (rad) of one harmonic motion, complex amplitudes (3,) of (z, tilt_x, tilt_y)."""
    return float(0.5 * (abs(motion[1] + 1j * motion[2]) + abs(motion[1] - 1j * motion[2])))


def tilt_bound(answers) -> float:
    """Bound on the tilt (rad) of any part in a linear steady state, by its amplitudes: of rings, of what carries them
    and of their own misalignments.  `answers` pairs each Harmonic with its response (3 rings,)."""
    parts = [[h.carrier * (h.ring == k) for h, _ in answers] for k in (0, 1)]
    parts += [[h.own * (h.ring == k) for h, _ in answers] for k in (0, 1)]
    floating = len(answers[0][1]) // 3 if answers else 0
    parts += [[answer[3 * k : 3 * k + 3] for _, answer in answers] for k in range(floating)]
    return max((sum(map(largest_tilt, part)) for part in parts), default=0.0)


def steady_extremes(linear: modes.LinearScene, answers, period: float | None) -> tuple[float, float, float]:
    """Largest and smallest relative misalignment (rad) and largest axial closing (m) of a linear steady state.

    `answers` pairs each Harmonic with its response.  With a common `period` (s) the motion is followed over it;
    without one the amplitudes are added: an upper bound, and 0 for the smallest.
    """
    relative = [(h.frequency, linear.relative(h, a)) for h, a in answers]
    if not relative:
        return 0.0, 0.0, 0.0
    if period is None:
        return sum(largest_tilt(r) for _, r in relative), 0.0, float(sum(abs(r[0]) for _, r in relative))

    frequencies, amplitudes = np.array([w for w, _ in relative]), np.array([r for _, r in relative])

    def measures(t):
        """Minus the squared tilt, the squared tilt and the axial motion at times (m,): what is made small."""
        x = (np.exp(1j * np.multiply.outer(t, frequencies)) @ amplitudes).real
        tilt = x[:, 1] ** 2 + x[:, 2] ** 2
        return np.array([-tilt, tilt, x[:, 0]])

    turns = np.max(np.abs(frequencies)) * period / (2 * np.pi)
    t = np.linspace(0.0, period, 256 * max(1, round(turns)) + 1)
    at, step, each, grid = t[np.argmin(measures(t), axis=1)], t[1] - t[0], np.arange(3), np.linspace(-1, 1, 41)
    # Smooth extrema: close in by ever finer grids.
    for _ in range(6):
        near = at[:, None] + step * grid
        found = measures(near.ravel()).reshape(3, 3, 41)[each, each]
        at = near[each, np.argmin(found, axis=1)]
        step /= 15
    most, least, axial = measures(at)[each, each]
    return float(np.sqrt(-most)), float(np.sqrt(least)), max(0.0, -float(axial))


def state_at_rest(model, at):
    """Gap state of the aligned faces where they rest under the conditions `at` an instant."""
    return rest_state(model.scene, model.clearance, at, shift=model.axial_shift(at))[0]


def aligned_flow(model, at) -> tuple[float, float]:
    """Leakage (m^3/s, from high to low pressure; as volume of a gas at normal conditions) and friction (W) of these.
    Raises SceneError where there is no flow."""
    s = state_at_rest(model, at)
    flow_at_rest(model.interface, s, model.observed)
    from_high_to_low = -1.0 if s[OUTER_PRESSURE] >= s[INNER_PRESSURE] else 1.0
    torque = s[TORQUE] + (0.0 if model.contact is None else s[CONTACT_TORQUE])
    return from_high_to_low * s[FLOW_INNER], torque * s[SPIN_DIFFERENCE]


def contact_margin(model, at, linear, tilt, answers) -> tuple[float, str | None]:
    """Factor by which the forcing may grow in linear theory, and what ends it: at "touch" the gap closes at an edge,
    to the height of the asperities where there are any (0 where they touch without forcing), or before "small tilts"
    are over (SMALL_TILT), or a "laminar film" or a "slow gas" at the edge that opens; one that is neither at rest has a
    caution instead.  Unknown of wavy faces, of aligned ones that press with a moment, and of a sweep, which is over
    in the last segment."""
    if waves_of(model.scene) or model.scene.housing.sweeps:
        return math.nan, None
    face = model.face
    inner = model.clearance + model.axial_shift(at)
    outer = inner + (face[3] + model.coning_change(at)) * (face[1] - face[0])
    height = max(face[TOUCH], 0.0)
    if min(inner, outer) <= height:
        return 0.0, TOUCHED
    if tilt is None or modes.verdict(linear.modes()) != "stable":
        return math.nan, None
    most, _, closing, _ = tilt
    ends, tilted = [(math.inf, None)], tilt_bound(answers())
    # Without it the margin is that of touch; that it is missing is told beside it.
    leakage = found_alone([], "leakage", lambda: aligned_flow(model, at)[0]) or math.nan
    for gap, radius in ((inner, face[0]), (outer, face[1])):
        if (reach := radius * most + closing) > 0.0:
            ends.append(((gap - height) / reach, TOUCHED))
            # An edge opens by as much as it closes.
            ends += [(room / reach, name) for room, name in room_to_open(model, leakage, radius, gap)]
    if tilted > 0.0:
        ends.append((SMALL_TILT / tilted, TILTED))
    return min(ends, key=lambda end: end[0])


def steady_state(model: Model):
    """The linearised scene, its answers and, of its steady state, the extremes (`steady_extremes`) and the period
    (s)."""
    linear, period = model.linear_scene(), RunState(model, 1.0).period()
    answers = linear.answers(model.segment().harmonics())
    return linear, answers, (*steady_extremes(linear, answers, period), period)


def limit_of_forcing(model_of: Callable[[float], Model], most: float) -> dict | None:
    """The least `value` of a forcing, up to `most`, at which something ends in linear theory, and what (`by`), of the
    `model_of` a value at its start; None where nothing does, or where that is not known."""

    def found(value):
        model = model_of(value)
        linear, answers, tilt = steady_state(model)
        return contact_margin(model, model.start, linear, tilt, lambda: answers)

    def beyond(value):
        margin = found(value)[0]
        return 1.0 / margin - 1.0 if margin != 0.0 else math.inf

    ends = beyond(0.0), beyond(most)
    if not ends[0] < 0.0 <= ends[1] < math.inf:
        return None
    from scipy.optimize import brentq

    value = float(brentq(beyond, 0.0, most, rtol=LOCATED))
    return {"value": value, "by": found(value)[1]}


def touching_when_aligned(scene, rough: float) -> dict | None:
    """Where rough faces, whose asperities meet at the film thickness `rough` (m), touch without any forcing: radius (m)
    and what asperities carry (N); None if they do not."""
    if not rough:
        return None
    scene = scenes.frozen_at_start(scene)
    model = Model(scene)
    scene, film = model.scene, model.scene.film
    thinnest, radius = min((h, r) for r, h in model.aligned_gaps())
    if thinnest >= rough:
        return None
    carried = opening_parts(scene)(model.clearance, film.inner_pressure, film.outer_pressure)
    return {"radius": float(radius), "touch": rough, "clearance": model.clearance, "contact_force": float(carried[1]),
            "closing_force": model.closing_force()}  # fmt: skip


def times_own(scene, key: str, value: float) -> float | None:
    """The value of a key over the scene's own; None where that is zero, or no number."""
    own = scenes.part(scenes.frozen_at_start(scene), key)
    return abs(value / own) if isinstance(own, int | float) and own else None


def linear_onset(scene, key: str, rough: float = 0.0) -> tuple[float, float]:
    """Value of the key at which the linear steady state closes the gap down to `rough` (m), and the radius (m) where it
    does.  Raises NoOnset if the linear response does not depend on the key, or touches at any of its values."""

    def excess(value):
        model = Model(scene(value), 1e-6)
        film, radius = linear_film(model)
        return (film - rough) / model.clearance, radius

    if excess(0.0)[0] <= 0.0:
        raise NoOnset(f"linear theory touches without any {key}")
    high = 1e-6
    while excess(high)[0] > 0:
        high *= 2
        if high > LARGEST:
            raise NoOnset(f"linear theory does not touch at any {key}: it does not move the gap")
    from scipy.optimize import brentq

    value = brentq(lambda v: excess(v)[0], 0.0, high, xtol=1e-16, rtol=1e-13)
    return float(value), float(excess(value)[1])


def linear_film(model) -> tuple[float, float]:
    """Smallest film thickness (m) of the linear steady state, negative beyond touch, and its radius (m)."""
    (most, _, closing, _), face = steady_state(model)[-1], model.face
    coning = face[3] + model.coning_change()
    gaps = model.clearance, model.clearance + coning * (face[1] - face[0])
    film, radius = min((gap - closing - radius * most, radius) for gap, radius in zip(gaps, face[:2], strict=True))
    return float(film), float(radius)


def linear_films(scene, key: str, rough: float, own) -> dict:
    """Of a seal that linear theory never sees touch: the clearance (m), and `linear`, the films (m) that it sees over
    the key, to ten times the value of the scene `own`, or 10 mrad where it has none."""
    value = scenes.part(scenes.frozen_at_start(own), key)
    value = abs(value) if isinstance(value, int | float) and value else None
    forcing = np.linspace(0.0, 10.0 * value if value else 1e-2, 11).tolist()
    films = [linear_film(Model(scene(v), 1e-6))[0] for v in forcing]
    if films[0] <= rough:
        # Nothing to see: it touches unforced.
        return {}
    return {
        "clearance": Model(scene(0.0), 1e-6).clearance,
        "linear": {"forcing": forcing, "h_min": films, "own": value},
    }
