"""The elements of a radial seal as followers: for each a mass, springs to its neighbours, damping, preload and dry
friction; the equations know nothing else of the seal.  And in closed form when they leave a shaft that runs out."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..dynamics.intervals import largest_value
from ..numerics.piecewise_linear import points
from ..quantities import in_words
from ..scene.radial import Lip, RadialScene


@dataclass(frozen=True)
class Followers:
    """`angles` (n,) (rad) around the shaft; of each follower `mass` (kg), `row` (n,) of the circulant stiffness matrix
    (N/m), `damping` (N s/m), `preload` (N, towards the shaft), dry `friction` (N) of its flange and `arc` (m), its
    length along the circumference."""

    angles: np.ndarray
    mass: float
    row: np.ndarray
    damping: float
    preload: float
    friction: float
    arc: float

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.angles)

    @cached_property
    def modal_stiffness(self) -> np.ndarray:
        """Stiffness (N/m) of a follower where all move as cos(m theta), m = 0 .. n - 1."""
        return np.fft.fft(self.row).real

    def least_load(self, order: int, speed: float) -> float:
        """Amplitude (N) per metre of a wave of this order, by which the load on the shaft swings while all follow:
        abs(k_m - m (order w)^2 + i d order w)."""
        w = order * speed
        return abs(self.modal_stiffness[order % self.count] - self.mass * w * w + 1j * self.damping * w)


def followers_of(scene: RadialScene) -> Followers:
    """The followers of a lip or of segments."""
    return _of_lip(scene) if scene.lip else _of_segments(scene)


def lip_line(lip: Lip, radius: float) -> tuple[float, float]:
    """Preload (N/m) and stiffness of the beam (N/m^2) of a lip, per length of circumference.

    **Source** Hayden & Keller (1974), eqs. 2.9 to 2.11, divided by the circumference.
    **Valid** a slender lip, small deflections.
    """
    tension = _tension(lip)
    if lip.preload is not None:
        return lip.preload + tension / radius, lip.stiffness
    stiffness = 3.0 * lip.modulus * (lip.thickness**3 / 12.0) / lip.length**3
    return tension / radius + stiffness * lip.interference, stiffness


def _tension(lip: Lip) -> float:
    """Tension (N) of hoop and garter spring."""
    hoop = lip.hoop_stress * lip.hoop_area if lip.hoop_stress is not None else 0.0
    return hoop + lip.garter_tension


def _of_lip(scene: RadialScene) -> Followers:
    """A ring in tension on a bed of beams: k_m = k + H (m^2 - 1) / r^2; where all widen the tension presses each sector
    as before, but the spring's own rate counts."""
    lip, radius, n = scene.lip, scene.shaft.radius, scene.lip.sectors
    preload, stiffness = lip_line(lip, radius)
    tension, arc = _tension(lip), 2.0 * math.pi * radius / n
    orders = np.minimum(np.arange(n), n - np.arange(n))
    per_length = stiffness + tension * np.maximum(orders**2 - 1.0, 0.0) / radius**2
    per_length[0] += 2.0 * math.pi * lip.garter_rate / radius
    speed = largest_value(scene.shaft.speed)
    damping = lip.loss_factor * stiffness / speed if speed else 0.0
    return Followers(
        2.0 * math.pi * np.arange(n) / n, lip.mass / n, np.fft.ifft(per_length).real * arc, damping * arc,
        preload * arc, 0.0, arc,
    )  # fmt: skip


def _of_segments(scene: RadialScene) -> Followers:
    """Segments of arc 2 pi / n: the spring around them presses each with 2 T sin(pi / n); where all move out by u it is
    longer by 2 n sin(pi / n) u."""
    seal, n = scene.circumferential, scene.circumferential.segments
    share = 2.0 * math.sin(math.pi / n)
    row = np.full(n, seal.garter_rate * share * share)
    return Followers(
        2.0 * math.pi * np.arange(n) / n, seal.mass / n, row, 0.0, seal.garter_tension * share,
        seal.flange_friction * seal.axial_force / n, 2.0 * math.pi * scene.shaft.radius / n,
    )  # fmt: skip


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


def hangs_up(followers) -> bool:
    """Whether the friction of the flange holds a follower that nothing but its preload moves: P <= F."""
    return 0.0 < followers.friction >= followers.preload


def closed_form_sentences(followers, shaft) -> list[str]:
    """The closed forms at the shaft's largest speed, in sentences."""
    speed = fastest(shaft)
    needed, largest = needed_preload(followers, shaft, speed), largest_eccentricity(followers, shaft, speed)
    per = 1.0 / followers.arc
    sentences = [
        f"preload {followers.preload * per:.4g} N/m; {needed * per:.4g} N/m are needed to ride all the way round"
    ]
    if math.isfinite(largest):
        sentences.append(f"without lobes it rides on eccentricities up to {in_words('m', largest)} at this speed")
    if hangs_up(followers):
        sentences.append("the friction of the flange is as large as the preload: segments hang up")
    return sentences
