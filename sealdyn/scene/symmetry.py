"""How far a scene is the same all around."""

import math

from ..numerics.piecewise_linear import points
from .waviness import waves_of


def tilt_is_imposed(scene) -> bool:
    """Whether anything but its own start ever tilts a ring."""
    rotor, stator = scene.rotor, scene.stator
    tilts = [rotor.misalignment if rotor.support else rotor.runout, stator.misalignment]
    tilts += [whirl.angle for whirl in scene.shaft.whirl]
    vibrations = (*scene.housing.angular_tones, *scene.housing.angular_sweep)
    shaken = any(vibration.displacement or vibration.acceleration for vibration in vibrations)
    sampled = (m for m in (scene.housing.motion, scene.shaft.motion) if m)
    shaken = shaken or any(any(m.tilt_x or ()) or any(m.tilt_y or ()) for m in sampled)
    return shaken or any(any(points(tilt)) for tilt in tilts)


def tilt_is_given(scene) -> bool:
    """Whether a floating ring starts with a tilt, or with a rate of it, by [initial]."""
    starts = ((scene.rotor, scene.initial.rotor), (scene.stator, scene.initial.stator))
    moved = [start for ring, start in starts if ring.support is not None]
    return any(v for s in moved for v in (s.tilt_x, s.tilt_y, s.tilt_x_rate, s.tilt_y_rate))


def alike_sectors(scene) -> int:
    """Into how many sectors that are alike at any time the film of a scene falls: 1 where a ring tilts, as many as all
    waves have in common where none does, 0 (any number) without waves."""
    if tilt_is_imposed(scene) or tilt_is_given(scene):
        return 1
    return math.gcd(*(wave.order for wave in waves_of(scene) if wave.amplitude))
