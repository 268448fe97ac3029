"""What a user looks at, and the scales by which its errors are told: what `run.accuracy` is about.

Displacements: the clearance C, of tilts C over the outer radius r_o.  Rates: these times the reference rate, the
largest of shaft speed, relative spin and housing frequencies, or the rate itself at that instant where it is larger (a
squeezed film lets go a million times faster than anything turns).  Film force: F, the largest closing force over the
run less the lower pressure on the face (if there is none, the largest film force less the same).  Film moment: F r_o.
Leakage: the larger of its peak and that of the aligned film at C under the largest pressure difference; between equal
pressures, where nothing flows through, the volume that the clearance holds, times the reference rate.  Torque: the
larger of its peak and that of the aligned film at C.
"""

import math

import numpy as np

from ..dynamics.interface import rest_state
from ..dynamics.intervals import constant_and_slope
from ..dynamics.sampled_motion import motions
from ..dynamics.signals import samples
from ..faces.geometry import FLOW_INNER, FORCE, INNER_PRESSURE, MOMENT_X, MOMENT_Y, OUTER_PRESSURE, TORQUE
from ..numerics.piecewise_linear import initially
from ..scene.gas import density_of, gas_of

# Share of what the clearance holds below which nothing flows through.
NOTHING = 1e-9
QUANTITIES = ("displacement", "rate", "force", "moment", "leakage", "torque")


class LookedAt:
    """Scales of a run (RunState): `lengths` (n,) of displacements, reference `rate` (rad/s), `force` (N) and, of the
    aligned film at the clearance, `leakage` (m^3/s) and `torque` (N m)."""

    def __init__(self, run):
        model = run.model
        self.n, self.rate = model.unknowns.n, reference_rate(run)
        self.lengths, self.outer_radius = model.scales[: self.n], model.scene.film.outer_radius
        ends = [end for interval in run.intervals.few for end in self._ends(model, interval)]
        self.force, self.leakage, self.torque = (max(one[k] for one in ends) for k in range(3))
        swept = self._held(model) * self.rate
        self.leakage = swept if self.leakage < NOTHING * swept else self.leakage

    def _ends(self, model, interval):
        """Closing force less the lower pressure (N), aligned leakage and torque at both ends of an interval."""
        film, (observed, f) = model.scene.film, model.observed
        area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
        closing = model.closing.over(interval, film)
        pressures = np.array([constant_and_slope(p, interval) for p in (film.inner_pressure, film.outer_pressure)])
        s, _ = rest_state(model.scene, model.clearance, interval)
        for tau in (0.0, interval.length):
            at = pressures @ [1.0, tau]
            s[INNER_PRESSURE], s[OUTER_PRESSURE] = at
            own = () if model.interface.unknowns is None else (model.interface.steady(f, s),)
            observed.flow(f, s, *own)
            yield closing[0] + closing[1] * tau - min(at) * area, abs(s[FLOW_INNER]), abs(s[TORQUE])

    def _held(self, model) -> float:
        """Volume (m^3, of a gas at normal conditions) between the faces."""
        film, gas = model.scene.film, gas_of(model.scene.film)
        volume = math.pi * (film.outer_radius**2 - film.inner_radius**2) * model.clearance
        if gas is None:
            return volume
        density = initially(film.inner_pressure) / (gas.gas_constant * initially(film.temperature))
        return volume * density / density_of(film)

    def of(self, segment, taus, q, q_rate, x=None) -> np.ndarray:
        """Columns (m, 2 n + 5) at segment times (m,) (s), SI where they have no scale of their own: displacements and
        rates over theirs, film force, moments about x and y, leakage, torque."""
        at = samples(segment, taus, q, q_rate, x)
        loads = at.gap[:, [FORCE, MOMENT_X, MOMENT_Y, FLOW_INNER]]
        return np.column_stack([q / self.lengths, q_rate / (self.lengths * self.rate), loads, at.torque])

    def errors(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """How far (m, len(QUANTITIES)) the columns of two runs at the same times are apart, over the scales of the
        second."""
        n, gap, peaks = self.n, np.abs(one - other), np.max(np.abs(other), axis=0, initial=0.0)
        force, leakage, torque = self.force, max(self.leakage, peaks[-2]), max(self.torque, peaks[-1])
        force = force if force > 0.0 else peaks[2 * n]
        moment = np.hypot(gap[:, 2 * n + 1], gap[:, 2 * n + 2])
        fast = np.maximum(np.abs(other[:, n : 2 * n]).max(axis=1), 1.0)
        # What is nothing throughout has no scale, and no error.
        force, leakage, torque = (scale or 1.0 for scale in (force, leakage, torque))
        over = [gap[:, 2 * n] / force, moment / (force * self.outer_radius), gap[:, -2] / leakage, gap[:, -1] / torque]
        return np.column_stack([gap[:, :n].max(axis=1), gap[:, n : 2 * n].max(axis=1) / fast, *over])


def reference_rate(run) -> float:
    """The largest (rad/s) of shaft speed, relative spin and housing frequencies over a run; where nothing turns or
    shakes that of the model."""
    scene, found = run.model.scene, [0.0]
    for interval in run.intervals.few:
        (shaft, faster), (stator, turning) = (
            constant_and_slope(speed, interval) for speed in (scene.shaft.speed, scene.stator.speed)
        )
        for tau in (0.0, interval.length):
            w = shaft + faster * tau
            found += [abs(w), abs(w - stator - turning * tau)]
    found += [2 * math.pi * tone.frequency for tone in scene.housing.tones]
    found += [2 * math.pi * max(sweep.frequency) for sweep in scene.housing.sweeps]
    found += [sampled.rate for sampled in motions(scene).values()]
    return max(found) or run.model.reference_rate
