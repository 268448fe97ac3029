"""Small motion of a seal whose housing shakes, about its aligned equilibrium, and the acceleration that closes it.

The housing carries the stator, on its support or rigidly; the shaft stands still.  With film K_f, D_f, support K, D and
inertia m of the ring that floats the gap moves, per unit motion of the housing at the angular frequency w, along z
    FMS: (K + i w D) / (K + K_f - m w^2 + i w (D + D_f))
    FMR: (K - m w^2 + i w D) / (K + K_f - m w^2 + i w (D + D_f))
and in tilt likewise with the wedge and the gyroscopic moment, which make an ellipse of it; with both rings afloat and
films that store the same balance of complex forces has the film's answer at that frequency.
**Source** equations of one ring on support and film (Green 1989, eqs. 1 and 2), the housing's motion added.
**Valid** motion that is small beside the film, stable seals.
"""

import math
from dataclasses import replace

import numpy as np

from ...dynamics.model import Model
from ...dynamics.modes import Harmonic, verdict
from ...dynamics.run_state import RunState
from ...dynamics.steady_extremes import steady_extremes
from ...scene.contact import touch_height
from ...scene.excitation import AngularVibration, AxialVibration, Housing
from ...scene.rings import STATOR
from ...scene.scene import Initial, Scene, SceneError
from ...scene.variants import frozen_at_start, unforced
from ...scene.waviness import waves_of
from .._words import speed

# Motion of the housing (z, tilt about x, tilt about y), and which modes it excites.
SHAPES = {"axial": (1.0, 0.0, 0.0), "angular": (0.0, 1.0, 0.0)}
KINDS = {"axial": "axial", "angular": "tilt"}
# Damping ratio from which a mode is not said to swing.
STILL = 0.995


class ShakenSeal:
    """A scene of which nothing moves but its housing.

    `model` of the aligned seal and its `linear` scene; `gaps` [(radius, film thickness)] (m) of the aligned faces where
    they may touch first, crests of waves taken off; `level` (m): the film at which they touch, the height of the
    asperities, or nothing where the faces are smooth or their asperities touch at rest (`riding`); `own` (m, rad): by
    how much the scene's own runout and misalignment close the gap axially, and tilt it.  Raises SceneError for a seal
    that is not stable, or not damped.
    """

    def __init__(self, scene: Scene):
        scene = replace(frozen_at_start(scene), housing=Housing(), initial=Initial())
        self.scene = replace(unforced(scene, scene.shaft.speed), initial=Initial())
        self.model = Model(self.scene)
        self.linear, self._at = self.model.linear_scene(), {}
        self.modes = self.linear.modes()
        if verdict(self.modes) != "stable":
            found = f"{speed(scene.shaft.speed)}, at which small motion does not die out"
            raise SceneError("shaft.speed", found, "a speed at which the seal is stable (sealdyn study critical-speed)")
        crests, shift = sum(wave.amplitude for wave in waves_of(self.model.scene)), self.model.axial_shift()
        self.gaps = [(r, h + shift - crests) for r, h in self.model.aligned_gaps()]
        rough, self.thinnest = touch_height(scene), min(h for _, h in self.gaps)
        self.riding = self.thinnest <= rough and rough > 0.0
        self.level = 0.0 if self.riding else rough
        forced = Model(scene)
        linear, period = forced.linear_scene(), RunState(forced, 1.0).period()
        answers = [(h, linear.response(h)) for h in forced.segment().harmonics()]
        tilt, _, closing = steady_extremes(linear, answers, period)
        self.own = closing, tilt

    def gap_motion(self, direction: str, frequency: float) -> np.ndarray:
        """Complex amplitude (3,) of (dz, g_x, g_y) (m, rad), stator minus rotor, per unit motion (m, or rad about the x
        axis) of the housing in a `direction` ("axial" | "angular") at a `frequency` (Hz)."""
        shape, none = np.array(SHAPES[direction], dtype=complex), np.zeros(3, dtype=complex)
        shaken = Harmonic(2 * math.pi * frequency, STATOR, shape, none)
        # A film that stores is asked once at a frequency.
        if frequency not in self._at:
            self._at[frequency] = self.linear.at_frequency(shaken.frequency)
        linear = self._at[frequency]
        return linear.relative(shaken, linear.response(shaken))

    def gain(self, direction: str, frequency: float) -> float:
        """Largest motion of the gap over a period per unit motion of the housing: m/m axially, rad/rad in tilt."""
        axial, tilt = sizes(self.gap_motion(direction, frequency))
        return axial if direction == "axial" else tilt

    def touch(self, direction: str, frequency: float, aligned: bool = False) -> float:
        """Amplitude of the housing's acceleration (m/s^2, rad/s^2) at which the thinnest film reaches `level`, the
        scene's own runout and misalignment at their worst beside it, or without them (`aligned`); 0 where these touch
        alone."""
        axial, tilt = sizes(self.gap_motion(direction, frequency))
        closing, own_tilt = (0.0, 0.0) if aligned else self.own
        left = [(r, h - self.level - closing - r * own_tilt) for r, h in self.gaps]
        with np.errstate(divide="ignore"):
            displacement = min(np.float64(max(room, 0.0)) / (axial + r * tilt) for r, room in left)
        return float((2 * math.pi * frequency) ** 2 * displacement)

    def decay(self, direction: str) -> float:
        """Decay rate (1/s) of the slowest motion that vibration of this direction excites."""
        rates = [-mode.value.real for mode in self.modes if mode.kind == KINDS[direction]]
        # The tilt opens the gap, too.
        rates += [-mode.value.real for mode in self.modes] if direction == "angular" else []
        return min(rates, default=math.inf)

    def shaken(self, direction: str, frequency: float, acceleration: float) -> Scene:
        """The aligned scene, its housing shaken with an acceleration (m/s^2, rad/s^2) at a frequency (Hz)."""
        kind = {"axial": AxialVibration, "angular": AngularVibration}[direction]
        return replace(self.scene, housing=Housing(**{direction: [kind(frequency, acceleration=acceleration)]}))

    def resonances(self) -> list[dict]:
        """Modes at rest on the film: `kind` ("axial" | "tilt"), `direction` of whirl, natural `frequency` abs(p)/(2 pi)
        and `damped_frequency` (Hz), `damping_ratio` -Re p/abs(p) of the eigenvalue p; of one that hardly
        swings the `growth_rate` (1/s) alone."""
        found = []
        for mode in sorted(self.modes, key=lambda mode: (mode.kind, abs(mode.value))):
            row = {"kind": mode.kind, "direction": mode.direction, "growth_rate": mode.value.real}
            size = abs(mode.value)
            if mode.value.imag and -mode.value.real < STILL * size:
                row |= {"frequency": size / (2 * math.pi), "damped_frequency": mode.value.imag / (2 * math.pi),
                        "damping_ratio": -mode.value.real / size}  # fmt: skip
            found.append(row)
        return found


def sizes(motion) -> tuple[float, float]:
    """Largest axial motion (m) and tilt (rad) over a period of a complex motion (3,) of the gap: of the tilt, an
    ellipse, the longer half axis, the sum of a forward and a backward circle."""
    z, x, y = motion
    return float(abs(z)), float(0.5 * (abs(x + 1j * y) + abs(x - 1j * y)))
