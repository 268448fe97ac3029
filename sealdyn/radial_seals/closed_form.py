"""When followers leave a shaft that runs out, in closed form."""

import math

import numpy as np

from ..numerics.piecewise_linear import points


def fastest(shaft) -> float:
    """The shaft's largest speed (rad/s), with its sign: lobes swing a damped load otherwise the other way round."""
    return max(points(shaft.speed), key=abs)


def swing(followers, waves, speed: float) -> float:
    """Amplitude (N) by which the load of a follower swings while all ride, of `waves` (order, amplitude in m, phase)
    at the shaft speed (rad/s, signed); of several waves the largest of their sum over a turn.

    **Source** Newton's law for a mass that moves as e cos(order (theta - w t)): N = P + Re[(k - m (order w)^2 + i d
    order w) e exp(...)].
    **Valid** linear springs and damping; followers so many that each wave is a single mode.
    """
    if len(waves) == 1:
        return followers.least_load(waves[0][0], speed) * waves[0][1]
    angle = np.linspace(0.0, 2.0 * math.pi, 1 if not waves else 3600, endpoint=False)
    total = np.zeros(len(angle))
    for order, amplitude, phase in waves:
        w = order * speed
        stiffness = followers.modal_stiffness[order % followers.count] - followers.mass * w * w
        factor = amplitude * (stiffness - 1j * followers.damping * w)
        total += (factor * np.exp(1j * (order * angle - phase))).real
    return float(-total.min(initial=0.0))


def needed_preload(followers, shaft, speed: float) -> float:
    """Least preload (N) of a follower with which all ride on the shaft at the speed (rad/s, signed): swing, stiffness
    times static offset, and the friction that works against following.

    **Valid** as `swing`; of waves out of step with the friction's sign the bound is on the safe side (friction counts
    in full, while it is felt only as a follower moves inward).
    """
    offset = followers.modal_stiffness[1 % followers.count] * shaft.offset
    return swing(followers, shaft.waves, speed) + abs(offset) + followers.friction


def largest_eccentricity(followers, shaft, speed: float) -> float:
    """Largest eccentricity (m) that all followers ride on at the speed (rad/s), without other waves; infinite where the
    load does not swing, 0 where the preload does not even do for the offset and the friction."""
    left = followers.preload - followers.friction - abs(followers.modal_stiffness[1 % followers.count]) * shaft.offset
    per_metre = followers.least_load(1, abs(speed))
    if left <= 0.0:
        return 0.0
    return left / per_metre if per_metre else math.inf


def held_between(stiffness: float, mass: float, preload: float, eccentricity: float) -> tuple[float, float]:
    """Speeds (rad/s) between which an undamped follower without friction rides: m w^2 = k -+ preload / e; the lower one
    is 0 where it rides at rest."""
    low, high = stiffness - preload / eccentricity, stiffness + preload / eccentricity
    return math.sqrt(max(low, 0.0) / mass), math.sqrt(high / mass)


def hangs_up(followers) -> bool:
    """Whether the friction of the flange holds a follower that nothing but its preload moves: P <= F."""
    return 0.0 < followers.friction >= followers.preload


def said(followers, shaft) -> list[str]:
    """The closed forms at the shaft's largest speed, in sentences."""
    speed = fastest(shaft)
    needed, largest = needed_preload(followers, shaft, speed), largest_eccentricity(followers, shaft, speed)
    per = 1.0 / followers.arc
    sentences = [
        f"preload {followers.preload * per:.4g} N/m; {needed * per:.4g} N/m are needed to ride all the way round"
    ]
    if math.isfinite(largest):
        sentences.append(f"without lobes it rides on eccentricities up to {1e3 * largest:.4g} mm at this speed")
    if hangs_up(followers):
        sentences.append("the friction of the flange is as large as the preload: segments hang up")
    return sentences
