"""The `[[stator.waviness]]` and `[[rotor.waviness]]` tables: waves around a face, which turn with its ring."""

import math
from dataclasses import dataclass

from ..numerics.piecewise_linear import points
from ..units import Angle, Length

# Most waves of both faces together: kernels keep room for them.
MOST_WAVES = 16
# Finer than a hundredth of the circle a surface is rough or grooved, not wavy.
HIGHEST_ORDER = 100


@dataclass(frozen=True)
class Waviness:
    """One wave of a ring's face, `amplitude cos(order (theta - ring angle) + phase)` of its height, counted along the
    shaft: on the stator it opens the gap, on the rotor it closes it."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    order: int
    """Waves to the circle, 2 to 100 (order 1 is a tilt)."""
    amplitude: Length
    """Half the height from trough to crest."""
    phase: Angle = 0.0
    """Of the wave at the angle zero of its ring."""


def waves_of(scene) -> list[Waviness]:
    """Waves (Waviness) of both faces of a scene, the stator's first."""
    return [*scene.stator.waviness, *scene.rotor.waviness]


def turning_waves(scene) -> str:
    """Key of the waves of a face that ever turns, "" if all stand still."""
    for name, ring, speed in (("stator", scene.stator, scene.stator.speed), ("rotor", scene.rotor, scene.shaft.speed)):
        if any(wave.amplitude for wave in ring.waviness) and any(points(speed)):
            return f"{name}.waviness"
    return ""


def waviness_errors(scene) -> list[tuple[str, str, str]]:
    """What the wavy faces of a scene cannot have: (key, found, expected)."""
    bad = []
    for name, ring in (("stator", scene.stator), ("rotor", scene.rotor)):
        for n, wave in enumerate(ring.waviness):
            key = f"{name}.waviness.{n}"
            if not 2 <= wave.order <= HIGHEST_ORDER or wave.order != int(wave.order):
                whole = f"a whole number from 2 (1 is a tilt, 0 a clearance: give them as such) to {HIGHEST_ORDER}"
                bad.append((f"{key}.order", f"{wave.order}", whole))
            if not 0.0 <= wave.amplitude < math.inf:
                bad.append((f"{key}.amplitude", f"{wave.amplitude:g} m", "a finite length >= 0"))
            if not math.isfinite(wave.phase):
                bad.append((f"{key}.phase", f"{wave.phase:g} rad", "a finite angle"))
    waves = waves_of(scene)
    if len(waves) > MOST_WAVES:
        blame = "rotor.waviness" if scene.rotor.waviness else "stator.waviness"
        bad.append((blame, f"{len(waves)} waves in all", f"at most {MOST_WAVES}"))
    if waves and scene.contact and scene.film.model != "reynolds":
        expected = 'film.model = "reynolds", or no such table: other films end a run where wavy faces meet'
        bad.append(("contact", "a table beside wavy faces", expected))
    return bad
