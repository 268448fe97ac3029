"""The periodic orbit followed as its forcing grows, until the film touches."""

import numpy as np

from ..dynamics.model import Model
from .harmonic_balance import HarmonicBalance, NotSmooth
from .shooting import ForcedWave, NoOrbit, NotOneSpeed, Shooter, TooMuchWork

# Right-hand sides that the path of orbits may take: three times what the dearest scenario needs.
MOST_WORK = 1_200_000


class Follower:
    """Follows the periodic orbit as the forcing grows, until its thinnest film is the margin, or `touch` (m)."""

    def __init__(self, scene, margin: float, accuracy: float, monodromy=None, start=None, touch: float = 0.0):
        self.scene, self.margin, self.accuracy, self.touch = scene, margin, accuracy, touch
        self.monodromy, self.start, self.path = monodromy, start, []
        self.known, self.work = [], 0

    def told(self) -> dict:
        """The path of orbits followed, and their clearance (m), if there is any."""
        names = ("forcing", "h_min", "tilt", "axial")
        path = {name: [p[name] for p in self.path] for name in names}
        return {"path": path, "clearance": self.path[-1]["clearance"]} if self.path else {}

    def excess(self, value: float) -> float:
        """h_min / clearance - margin of the orbit at one forcing, guessed from its neighbours."""
        finder, orbit = self._found(self.scene(value), value)
        self.orbit, self.finder, self.start = orbit, finder, orbit.start
        self.known = [*[k for k in self.known if k[0] != value][-3:], (value, orbit, finder.guess())]
        low, model = orbit.extremes["h_min"], finder.model
        tilt, axial = orbit.extremes["relative_misalignment"]["max"], self._mean_axial(model, orbit)
        self.path.append({"forcing": value, "h_min": low["value"], "radius": low["radius"], "tilt": tilt,
                          "clearance": model.clearance, "axial": axial})  # fmt: skip
        return low["value"] / model.clearance - (self.touch / model.clearance or self.margin)

    def _found(self, scene, value):
        """What finds the orbit of a scene, and the orbit: as a point, by harmonic balance, or by shooting."""
        for kind in (ForcedWave, HarmonicBalance):
            try:
                finder = kind(scene, self.accuracy)
                return finder, self._within(finder, value)
            except (NotOneSpeed, NotSmooth):
                continue
        # A floored film has kinks and costs a hundred times more: a looser orbit is all it can give.
        tight, target = (1e-10, 1e-8) if scene.film.cavitation_pressure is None else (1e-6, 1e-5)
        finder = Shooter(scene, self.accuracy, tight=tight)
        orbit = self._within(finder, value, monodromy=self.monodromy, target=target, most=25)
        self.monodromy = orbit.monodromy
        return finder, orbit

    def _within(self, finder, value, **how):
        """What it finds for a forcing, its right-hand sides counted and bounded."""
        finder.most_work = MOST_WORK - self.work
        try:
            return finder.find(self._guess(value, finder), **how)
        except TooMuchWork:
            raise TooMuchWork(f"more than {MOST_WORK} right-hand sides for the path of orbits") from None
        finally:
            self.work += finder.work

    def multiplier(self) -> float | None:
        """Largest modulus of the Floquet multipliers of the last orbit."""
        return self.finder.multiplier(self.orbit)

    def _guess(self, value, finder):
        """The linear steady state, which scales with the forcing, plus what the nonlinear film adds to it: a
        polynomial in the forcing through the orbits known (and through nothing at no forcing)."""
        linear = finder.guess()
        known = [(v, _begun(finder, orbit), before) for v, orbit, before in self.known if before.shape == linear.shape]
        if not known:
            return self.start if self.start is not None and self.start.shape == linear.shape else linear
        if len(known) == 1:
            v, x, before = known[0]
            return linear + (x - before) * (value / v) ** 2
        nodes = [0.0, *(v for v, _, _ in known)]
        added = [np.zeros_like(linear), *(x - before for _, x, before in known)]
        total = np.zeros_like(linear)
        for i, (node, part) in enumerate(zip(nodes, added, strict=True)):
            others = [n for j, n in enumerate(nodes) if j != i]
            total += part * np.prod([(value - n) / (node - n) for n in others])
        return linear + total

    @staticmethod
    def _mean_axial(model, orbit):
        """Axial opening of the gap (m) at the start of the orbit: how far the seal has lifted."""
        signs = {"stator_z": 1.0, "rotor_z": -1.0}
        return float(sum(signs.get(name, 0.0) * x for name, x in zip(model.unknowns.names, orbit.start, strict=False)))

    def follow(self, linear: float, tolerance: float, most: float = np.inf) -> float:
        """The forcing that touches, from below: ever shorter secant steps, since a trial orbit must not cross the
        closed film.  The gap closes ever more slowly (the seal opens axially), so a secant stops short of touch.
        Raises NoOrbit also where the orbit at the forcing `most`, the last that is followed, does not touch."""
        clearance = Model(self.scene(0.0), 1e-6).clearance if self.touch else 1.0
        low, low_left, step, longest = 0.0, 1.0 - (self.touch / clearance or self.margin), 0.4 * linear, np.inf
        for _ in range(80):
            value = min(low + step, most)
            try:
                left = self.excess(value)
            except TooMuchWork:
                raise
            except NoOrbit:
                step = longest = 0.5 * step
                if abs(step) < 1e-6 * linear:
                    raise
                continue
            slope = (left - low_left) / (value - low)
            low, low_left, longest = value, left, 2.0 * longest
            # Where steps were cut a short one says nothing of how far touch is.
            if abs(left) < 1e-6 or abs(left) < tolerance * value * abs(slope):
                return float(value - left / slope)
            if value == most and left > 0.0:
                raise NoOrbit("the last orbit that may be followed does not touch")
            aim = 0.3 * left if left > 0.03 else 0.0
            # Where tilting opens the thinnest film, too, no secant knows how far.
            step = min((aim - left) / slope if slope < 0.0 else np.inf, 0.2 * linear, longest)
            if value > 20 * linear:
                raise NoOrbit("no touch up to twenty times the linear onset")
        raise NoOrbit("the path of orbits did not reach touch in 80 steps")

    def close(self, near: float, tolerance: float) -> float:
        """The forcing that touches, by secants from a forcing already close."""
        a, b = 0.98 * near, near
        f_a, f_b = self.excess(a), self.excess(b)
        for _ in range(12):
            c = b - f_b * (b - a) / (f_b - f_a)
            c = min(max(c, 0.8 * near), 1.2 * near)
            a, f_a, b, f_b = b, f_b, c, self.excess(c)
            if abs(b - a) < tolerance * near:
                return float(b)
        raise NoOrbit("the floored onset did not settle")


def _begun(finder, orbit):
    """What a finder goes on from to find the neighbour of an orbit."""
    return orbit.start if orbit.points is None else finder.at(orbit.points, finder.times(finder.first))
