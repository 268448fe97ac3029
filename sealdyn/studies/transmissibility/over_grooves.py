"""The arrangements of a seal over grooves: the answers of rings on the film of one pitch, which follows the speed under
one closing force."""

from itertools import pairwise

import numpy as np

from ...films._grooved.motion import relative_tilt, support_law
from ...scene.scene import Scene, frozen_at_start
from .._grooved_roots import FilmOverSpeed, RootsOverSpeed, rings_of
from .arrangements import SEALS, Arrangement, quiet


class OverGrooves(Arrangement):
    """One arrangement; `film` at any speed is that of all of them."""

    def __init__(self, scene: Scene, name: str, film: FilmOverSpeed):
        super().__init__(scene, name)
        self.roots, self.rates = RootsOverSpeed(self.scene, film), {}

    def relative_tilts(self, speed: float) -> tuple[complex, complex]:
        """As of Arrangement, with 3 grooves and more; of fewer the part at the forcing's own frequency."""
        motions = self.roots.film(speed)[2]
        rings = rings_of(frozen_at_start(self.scene, speed=speed))
        floats = [name for name in ("stator", "rotor") if getattr(self.scene, name).support is not None]

        def answers(motion):
            found = []
            for name, frequency, sign in (("stator", self.stator_speed, 1.0), ("rotor", speed, -1.0)):
                if name in floats:
                    k = floats.index(name)
                    moment, ahead = rings[k].angular_stiffness, (rings[k], *rings[:k], *rings[k + 1 :])
                else:
                    moment, ahead = support_law(rings[0], 1j * frequency), rings
                found.append(sign * relative_tilt(motion, ahead, moment, frequency)[0])
            return np.array(found)

        static, dynamic = motions.of_motion(answers)[0]
        return complex(static), complex(dynamic)

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt."""
        if speed not in self.rates:
            self.rates[speed] = self.roots.growth(speed)
        return self.rates[speed]

    def critical_speed(self) -> float | None:
        """Lowest speed (rad/s) of those looked at from which on a tilt grows."""
        known = sorted(self.rates)
        for low, high in pairwise(known):
            if self.rates[low] < 0.0 <= self.rates[high]:
                return self.roots.threshold(low, high)
        return None

    def film_numbers(self, speed) -> tuple[np.ndarray, np.ndarray]:
        """Tilt stiffness (N m/rad) and damping (N m s/rad) of the film at speeds (rad/s), once per turn."""
        films = [self.roots.film(float(w))[2].of_motion(lambda motion, w=w: np.array(motion.matrices(abs(w))))[0]
                 for w in np.atleast_1d(speed)]  # fmt: skip
        return tuple(np.array([film[k][1, 1] for film in films]).reshape(np.shape(speed)) for k in (0, 1))

    def formula_holds(self, speed: float) -> bool:
        """Never: no closed form has grooves."""
        return False


def seals_over_grooves(scene: Scene) -> dict[str, OverGrooves]:
    """The arrangements of a scene, as of `seals_of`, on one film."""
    scene = quiet(scene)
    film = FilmOverSpeed(scene)
    return {name: OverGrooves(scene, name, film) for name in SEALS}
