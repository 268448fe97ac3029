"""Symmetry of a scene around the shaft: how often it repeats itself, and with that whether aligned rings stay so.

Whatever differs around the circle has an order, how often it repeats itself there: a wave the number of its waves, pads
their count, a tilt one.  Pressure is no linear function of the film thickness, so that parts of orders n and m press
with n - m, too (cos 2a cos 3a holds cos a): all of them together repeat themselves as often as their orders have in
common, the greatest common divisor, and a moment is what repeats itself once.
**Source** Curie (1894), J. Phys. Theor. Appl. 3, 393: effects have at least the symmetry of their causes.
**Valid** the motion that keeps the symmetry; whether a tilt beside it dies out is a question for the modes.
"""

import math

from ..numerics.piecewise_linear import points
from .contact import grooves_of, waves_of


def alike_sectors(scene, faces_press: bool = True) -> int:
    """Into how many sectors that are alike at any time a scene falls: 1 where a ring tilts, 0 (any number) where
    nothing differs around the circle; `faces_press`: whether the pressure feels waves and pads."""
    tilt = (1,) if tilt_is_imposed(scene) or tilt_is_given(scene) else ()
    return math.gcd(*(face_orders(scene) if faces_press else ()), *tilt)


def face_orders(scene) -> list[int]:
    """Orders of what the faces of a scene have around the circle: waves, pads and grooves."""
    waves = {wave.order for wave in waves_of(scene) if wave.amplitude}
    return sorted(waves | {row.count for row in (*scene.film.pads, *grooves_of(scene)[1]) if row.depth})


def faces_tilt(scene) -> bool:
    """Whether the faces of a scene, aligned, press with a moment by their waves and pads."""
    return math.gcd(*face_orders(scene)) == 1


def tilt_is_imposed(scene) -> bool:
    """Whether anything but its own start and its faces ever tilts a ring."""
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
