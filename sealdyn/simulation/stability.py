"""Linear stability of a run, as its summary has it: with all degrees of freedom, at an interval's start."""

from ..dynamics import modes
from ..scene.rings import ROTOR


def stability(model, interval, linear, speeds: bool) -> dict:
    """Verdict, whirl ratio of the least damped tilt mode, growth rate (1/s), shaft speed (rad/s) and all modes of the
    scene `linear`, linearised at the interval's start; if `speeds` also `critical_and_resonance_speeds`."""
    found = linear.modes()
    speed = linear.rings[ROTOR].spin
    tilt = [mode for mode in found if mode.kind == "tilt"]
    whirl = None
    if tilt and speed:
        sign = -1.0 if tilt[0].direction == "backward" else 1.0
        whirl = sign * tilt[0].value.imag / speed
    return {
        "verdict": modes.verdict(found),
        "whirl_ratio": whirl,
        **(critical_and_resonance_speeds(model, interval, tilt) if speeds else {}),
        "growth_rate": found[0].value.real if found else None,
        "speed": speed,
        "modes": [{"re": m.value.real, "im": m.value.imag, "kind": m.kind, "direction": m.direction} for m in found],
    }


def critical_and_resonance_speeds(model, interval, tilt) -> dict:
    """`critical_speed` (rad/s, None if there is none) and `resonance_speeds` (rad/s), from a thousandth to a thousand
    times (resonance: a hundredth to a hundred times) the fastest of the `tilt` modes."""
    if not tilt:
        return {"critical_speed": None, "resonance_speeds": []}

    def at_speed(w):
        return model.linear_scene(interval, speed=w)

    pace = max(abs(mode.value) for mode in tilt)
    return {
        "critical_speed": modes.critical_speed(at_speed, 1e-3 * pace, 1e3 * pace),
        "resonance_speeds": modes.resonance_speeds(at_speed, 1e-2 * pace, 1e2 * pace),
    }
