"""Linear stability of a run, as its summary has it: with all degrees of freedom, at an interval's start."""

import math

from ..dynamics import modes, whirl_speeds
from ..dynamics.linearisation import whirl_over_speed
from ..scene.rings import ROTOR


def stability(model, interval, linear, speeds: bool) -> dict:
    """Verdict, whirl ratio of the least damped tilt mode, growth rate (1/s), shaft speed (rad/s) and all modes of the
    scene `linear`, linearised at the interval's start; if `speeds` also `critical_speed` and `resonance_speeds`."""
    found = linear.modes()
    speed = linear.rings[ROTOR].spin
    tilt = [mode for mode in found if mode.kind == "tilt"]
    whirl = None
    if tilt and speed:
        sign = -1.0 if tilt[0].direction == "backward" else 1.0
        whirl = sign * tilt[0].value.imag / speed
    searched = {}
    if speeds:
        searched = {
            "critical_speed": critical_speed(model, interval),
            "resonance_speeds": resonance_speeds(model, interval),
        }
    return {
        "verdict": modes.verdict(found),
        "whirl_ratio": whirl,
        **searched,
        "growth_rate": found[0].value.real if found else None,
        "speed": speed,
        "modes": [{"re": m.value.real, "im": m.value.imag, "kind": m.kind, "direction": m.direction} for m in found],
    }


def critical_speed(model, interval=None) -> float | None:
    """Lowest shaft speed (rad/s) at which a tilt mode of a model loses or regains its damping, the rest as at an
    interval's start (default: the run's); None if there is none.

    **Valid** from a thousandth to a thousand times the `natural_frequency`."""
    natural = natural_frequency(model, interval)
    if not natural:
        return None
    low, high = 1e-3 * natural, 1e3 * natural
    return whirl_speeds.critical_speed(whirl_over_speed(model, interval, high), low, high)


def resonance_speeds(model, interval=None) -> list[float]:
    """Shaft speeds (rad/s) at which a forward tilt mode of a model turns with the shaft, likewise.

    **Valid** from a hundredth to a hundred times the `natural_frequency`."""
    natural = natural_frequency(model, interval)
    if not natural:
        return []
    low, high = 1e-2 * natural, 1e2 * natural
    return whirl_speeds.resonance_speeds(whirl_over_speed(model, interval, high), low, high)


def natural_frequency(model, interval=None) -> float:
    """Geometric mean (rad/s) of the tilt modes' eigenvalues, 0 if there are none: of an overdamped pair, however far
    apart, the root of stiffness over inertia."""
    sizes = [abs(mode.value) for mode in model.linear_scene(interval).modes() if mode.kind == "tilt" and mode.value]
    return math.exp(sum(map(math.log, sizes)) / len(sizes)) if sizes else 0.0
