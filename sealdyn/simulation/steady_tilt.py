"""How the faces of a scene stand to each other when its linear steady response is all that tilts them."""

from ..scene.variants import seals_that_stick


def steady_tilt(model) -> tuple[complex, float, str]:
    """Relative tilt (rad, complex), its whirl (rad/s) and what it is, of the linear steady state."""
    if seals_that_stick(model.scene):
        return 0.0, 0.0, "a ring that its secondary seal holds has no linear steady state: aligned"
    if model.scene.shaft.motion or model.scene.housing.motion:
        return 0.0, 0.0, "a motion by samples has no linear steady state: aligned"
    segment = model.segment()
    if not segment.harmonic:
        return 0.0, 0.0, "a sweep has no linear steady state: aligned"
    linear = model.linear_scene()
    parts: dict[float, complex] = {}
    for harmonic in segment.harmonics():
        g = linear.relative(harmonic, linear.response(harmonic))
        # Re(g e^{iwt}) is a forward and a backward circle.
        w = harmonic.frequency
        parts[w] = parts.get(w, 0.0) + (g[1] + 1j * g[2]) / 2
        parts[-w] = parts.get(-w, 0.0) + ((g[1] - 1j * g[2]) / 2).conjugate()
    mean = parts.pop(0.0, 0.0)
    if abs(mean) > 0:
        return complex(mean), 0.0, "mean tilt of the linear steady state"
    if parts:
        w, largest = max(parts.items(), key=lambda item: abs(item[1]))
        if abs(largest) > 0:
            return complex(largest), float(w), "turning tilt of the linear steady state, at one instant"
    return 0.0, 0.0, "no forcing tilts this scene: aligned"
