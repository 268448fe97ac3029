"""Linear stability of a run, as its summary has it: with all degrees of freedom, at an interval's start."""

from dataclasses import replace

import numpy as np

from ..closed_form import fmr_critical_speed, fms_critical_speed
from ..dynamics import modes, stability_thresholds
from ..dynamics.intervals import constant_and_slope
from ..dynamics.linearisation import moves_with_speed, whirl_over_speed
from ..dynamics.model import Model
from ..dynamics.stability_thresholds import neutral_speeds
from ..scene.patterns import grooves_of, waves_of
from ..scene.rings import ROTOR, STATOR
from ..scene.scene import SceneError, uneven_supports

# Speed (m/s) of the outer edge of a face beyond which there is none: rings burst at some hundreds.
FASTEST = 1000.0
# How far below the least and above the largest of the shaft's speed and the natural frequency thresholds are looked
# for; and by how many speeds, where they are known beforehand, to see that none was missed.
AROUND, POINTS_KNOWN = 1e3, 32
# Halvings of the last step of the way to the last speed at which a film holds the closing force.
HALVINGS = 20
# What is found only where speeds are asked for.
SEARCHED = ("speeds_held", "critical_speed", "thresholds", "resonance_speeds")


def found_alone(failed: list[str], name: str, find):
    """What `find()` finds of an extra of a run that has been integrated: None where it cannot be found, and then
    `failed` has a sentence why."""
    try:
        return find()
    except (SceneError, ArithmeticError, np.linalg.LinAlgError) as error:
        failed.append(f"{name}: not found: {error}")
        return None


def stability(model, interval, linear, speeds: bool, failed: list[str] | None = None) -> dict:
    """Verdict, whirl ratio of the least damped tilt mode, growth rate and its uncertainty (1/s), speeds of the shaft
    and of the stator (rad/s), `fastest` that any shaft turns such a face (rad/s), and all modes of the scene `linear`,
    linearised at the interval's start; if `speeds` also `critical_speed`, `thresholds` and `resonance_speeds`, None
    where it takes too long: over grooves, and a film that stores between wavy faces or over pads; or where the search
    has no end, of which `failed` then tells."""
    found = linear.modes()
    speed = linear.rings[ROTOR].spin
    searched, failed = {}, [] if failed is None else failed
    slow = model.interface.stores and (waves_of(model.scene) or model.scene.film.pads)
    if speeds and (slow or grooves_of(model.scene)[1]):
        # Seconds at every speed: each way that the gap may move meets the film in its own way.
        searched = dict.fromkeys(SEARCHED)
    elif speeds:
        every = found_alone(failed, "critical speeds", lambda: thresholds(model, interval))
        searched = {
            "speeds_held": found_alone(failed, "speeds with a film", lambda: speeds_held(model, interval)),
            "critical_speed": min(every or [], default=None),
            "thresholds": every,
            "resonance_speeds": found_alone(failed, "resonance speeds", lambda: resonance_speeds(model, interval)),
        }
    return {
        "verdict": modes.verdict(found),
        "whirl_ratio": whirl_ratio(found, speed),
        **searched,
        "growth_rate": found[0].value.real if found else None,
        "growth_rate_uncertainty": modes.uncertainty(found) if found else None,
        "speed": speed,
        "stator_speed": linear.rings[STATOR].spin,
        "fastest": FASTEST / model.scene.film.outer_radius,
        "modes": [
            {"re": m.value.real, "im": m.value.imag, "kind": m.kind, "direction": m.direction, "uncertainty": m.error}
            for m in found
        ],
    }


def no_stability(model, interval) -> dict:
    """The same where it could not be found."""
    unknown, scene = ("verdict", "whirl_ratio", *SEARCHED, "growth_rate", "growth_rate_uncertainty"), model.scene
    speed, stator_speed = (constant_and_slope(ring.speed, interval)[0] for ring in (scene.shaft, scene.stator))
    return dict.fromkeys(unknown) | {
        "speed": speed, "stator_speed": stator_speed, "fastest": FASTEST / scene.film.outer_radius, "modes": [],
    }  # fmt: skip


def whirl_ratio(found, speed: float) -> float | None:
    """Whirl frequency of the least damped tilt mode of some modes, least damped first, over the shaft speed (rad/s):
    negative where it turns against the shaft; None without such a mode, or at rest."""
    tilt = next((mode for mode in found if mode.kind == "tilt"), None)
    if tilt is None or not speed:
        return None
    return (-1.0 if tilt.direction == "backward" else 1.0) * tilt.value.imag / speed


def speeds_held(model, interval=None) -> list[float] | None:
    """The `held_speeds` (rad/s) of what `thresholds` looks through, None where that is all."""
    whole = _range(model, interval)
    held = held_speeds(model, interval, *whole) if whole[1] else whole
    return None if held == whole else list(held)


def thresholds(model, interval=None) -> list[float]:
    """Shaft speeds (rad/s, rising, without sign: in the direction in which the shaft turns) at which the tilts of a
    model lose or regain their damping, the rest as at an interval's start (default: the run's).

    **Valid** every speed, where the film's matrices are linear in it (dynamics/stability_thresholds.py); of a film with
    a floor of the pressure, unknowns of its own, heat or waves those that 30 speeds a decade tell apart, from a
    thousandth of the smaller of the shaft's speed and `natural_frequency` to a thousand times the larger, within
    `held_speeds`."""
    whole = _range(model, interval)
    if not whole[1]:
        return []
    values, whirl = whirl_over_speed(model, interval)
    neutral, points = ((), None) if whirl is None else (neutral_speeds(whirl), POINTS_KNOWN)
    low, high = held_speeds(model, interval, *whole)
    return stability_thresholds.thresholds(values, low, high, points, neutral)


def critical_speed(model, interval=None) -> float | None:
    """Lowest of the `thresholds` (rad/s); None if there is none."""
    return min(thresholds(model, interval), default=None)


def critical_speed_undamped(model) -> tuple[bool, float | None]:
    """Whether a floating rotor's support has tilt damping, which turns with it, and the critical speed (rad/s) without;
    None if there is none, and where the rotor has no such damping, or where each speed is a search of its own.

    **Source** Green (1989), eq. for the whirl ratio (D_s + D_f/2)/(D_s + D_f) of a flexibly mounted rotor: what its
    damper adds there lowers the critical speed; re-derived."""
    support = model.scene.rotor.support
    known = model.interface.unknowns is None and not moves_with_speed(model.given)
    if support is None or not support.tilt()[1] or not known:
        return False, None
    stiffness = support.tilt_stiffness if support.radius is None else support.tilt()[0]
    bare = replace(support, radius=None, tilt_stiffness=stiffness, tilt_damping=0.0)
    scene = replace(model.given, rotor=replace(model.given.rotor, support=bare))
    return True, critical_speed(Model(scene, model.accuracy, None, model.film))


def resonance_speeds(model, interval=None) -> list[float]:
    """Shaft speeds (rad/s) at which a forward tilt mode of a model turns with the shaft, likewise.

    **Valid** from a hundredth to a hundred times the `natural_frequency`, within `held_speeds`."""
    natural = natural_frequency(model, interval)
    if not natural:
        return []
    values, whirl = whirl_over_speed(model, interval)
    # Of the same search as the thresholds'.
    held = held_speeds(model, interval, *_range(model, interval))
    low, high = np.clip([1e-2 * natural, 1e2 * natural], *held)
    return stability_thresholds.resonance_speeds(values, low, high, whirl=whirl)


def held_speeds(model, interval, low: float, high: float) -> tuple[float, float]:
    """The part of [low, high] (rad/s, without sign) in which an aligned film holds the closing force as it does at the
    shaft's speed: inertia and coning that follow the speed leave none far from it.  Of a range beyond that the last
    speed towards it that has one, twice."""
    if not moves_with_speed(model.given):
        return low, high
    spin = model.linear_scene(interval).rings[ROTOR].spin
    direction, own = -1.0 if spin < 0.0 else 1.0, abs(spin) or low

    def held(speed):
        try:
            return bool(model.linear_scene(interval, speed=direction * speed))
        except SceneError:
            return False

    def last(end):
        # Also on the way to an end that has a film again there may be none.
        inside, outside = own, end
        way = stability_thresholds.spread(*sorted((own, end)))
        for speed in way[1:] if end > own else way[-2::-1]:
            if not held(speed):
                outside = speed
                break
            inside = speed
        else:
            return end
        for _ in range(HALVINGS):
            middle = float(np.sqrt(inside * outside))
            inside, outside = (middle, outside) if held(middle) else (inside, middle)
        return inside

    found = last(low), last(high)
    return min(found), max(found)


def _range(model, interval) -> tuple[float, float]:
    """Speeds (rad/s) between which thresholds are looked for, 0 and 0 without any: AROUND below the smaller and above
    the larger of natural frequency and the shaft's speed, of those that are not zero."""
    speed = abs(model.linear_scene(interval).rings[ROTOR].spin)
    known = [w for w in (natural_frequency(model, interval), speed) if w]
    return min(known, default=0.0) / AROUND, max(known, default=0.0) * AROUND


def natural_frequency(model, interval=None) -> float:
    """Geometric mean (rad/s) of the tilts' eigenvalues, of rings at rest where the film is linear in the speed; 0 if
    there are none: of an overdamped pair, however far apart, the root of stiffness over inertia."""
    _, whirl = whirl_over_speed(model, interval)
    if whirl is not None:
        found, _ = stability_thresholds.all_at_once(replace(whirl, stator_speed=0.0))([0.0])
        sizes = np.abs(found[np.isfinite(found)])
    else:
        sizes = np.array([abs(mode.value) for mode in model.linear_scene(interval).modes() if mode.kind == "tilt"])
    sizes = sizes[sizes > 0.0]
    return float(np.exp(np.mean(np.log(sizes)))) if len(sizes) else 0.0


def formula_numbers(ring, film_stiffness: float, film_damping: float) -> dict[str, float]:
    """What closed forms of one floating ring are fed with: its own, and the film's in tilt (N m/rad, N m s/rad)."""
    stiffness, damping = ring.support.tilt()
    return {
        "transverse_inertia": ring.transverse_inertia,
        "polar_inertia": ring.polar_inertia,
        "support_stiffness": stiffness,
        "support_damping": damping,
        "film_stiffness": film_stiffness,
        "film_damping": film_damping,
    }


def by_formula(model) -> tuple[float | None, str]:
    """Closed form fed with the film's own coefficients (rad/s or None), and why there is none."""
    scene = model.scene
    if model.interface.stores:
        return None, "a film that stores: no published formula"
    if moves_with_speed(model.given):
        return None, "a gap that moves with the speed: no published formula"
    if model.unknowns.floats[STATOR] and model.unknowns.floats[ROTOR]:
        return None, "both rings float: no published formula"
    if scene.stator.speed != 0.0:
        return None, "the stator turns: no published formula"
    if uneven_supports(scene):
        return None, "a support with two tilt stiffnesses: no published formula"
    fmr = model.unknowns.floats[ROTOR]
    formula, ring = (fmr_critical_speed, scene.rotor) if fmr else (fms_critical_speed, scene.stator)
    if ring.transverse_inertia == 0.0:
        return None, "a ring without inertia has no threshold"
    film_k, film_d = model.film_matrices()
    try:
        speed = formula(**formula_numbers(ring, float(film_k[1, 1]), float(film_d[1, 1])))
    except ValueError as error:
        return None, str(error)
    return speed, "" if speed is not None else f"{'FMR' if fmr else 'FMS'}: stable at every speed"
