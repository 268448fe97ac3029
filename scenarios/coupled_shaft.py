"""A flexible shaft and its seal, each by a program of its own: the seal tilts with the shaft, and its moment bends it.

    python coupled_shaft.py          # in any folder; some seconds, a minute more the first time

A disk on an overhung shaft has two tilts, g = g_x + i g_y, an inertia, a gyroscopic moment and an unbalance couple U:

    I g'' - i J w g' + d g' + k g = U exp(i w t) + M

M is the moment of the seal, as `Simulation.state` has it.  A step takes three moves: the seal goes on with the shaft's
tilt as a parabola, the shaft with the seal's moment as a straight line between both ends of the step, and both meet
there.  What they miss of each other falls with the square of the step.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

import sealdyn


@dataclass
class Shaft:
    """The disk on its shaft, SI: state `y` = (g, g'), complex."""

    inertia: float = 2e-3
    polar_inertia: float = 3e-3
    stiffness: float = 5e3
    damping: float = 1.0
    couple: float = 0.05
    speed: float = 1000.0
    y: tuple[complex, complex] = (0j, 0j)

    def acceleration(self, time: float, y: tuple[complex, complex], moment: complex) -> complex:
        """g'' at a time, under a moment of the seal."""
        g, rate = y
        own = self.couple * np.exp(1j * self.speed * time) + 1j * self.polar_inertia * self.speed * rate
        return (own + moment - self.damping * rate - self.stiffness * g) / self.inertia

    def step(self, time: float, duration: float, moment: Callable[[float], complex]) -> None:
        """Go on by a duration, under the moment as a function of the time since its beginning."""
        found = solve_ivp(
            lambda past, y: [y[1], self.acceleration(time + past, y, moment(past))],
            (0.0, duration), self.y, method="DOP853", rtol=1e-10, atol=1e-16,
        )  # fmt: skip
        self.y = (found.y[0, -1], found.y[1, -1])


def coupled(seal: sealdyn.Simulation, shaft: Shaft, duration: float, step: float) -> np.ndarray:
    """Times (s), tilt of the shaft (rad) and moment of the seal on it (N m), complex, three rows."""
    before = complex(seal.state["shaft_moment_x"], seal.state["shaft_moment_y"])
    rows = [(seal.time, shaft.y[0], before)]
    for _ in range(round(duration / step)):
        time, (g, rate) = seal.time, shaft.y
        acceleration = shaft.acceleration(time, shaft.y, before)
        seal.set(
            shaft_tilt_x=(g.real, rate.real, acceleration.real), shaft_tilt_y=(g.imag, rate.imag, acceleration.imag)
        )
        state = seal.step(step)
        after = complex(state["shaft_moment_x"], state["shaft_moment_y"])
        shaft.step(time, step, lambda past, a=before, b=after: a + (b - a) * past / step)
        before = after
        rows.append((seal.time, shaft.y[0], before))
    return np.array(rows).T


if __name__ == "__main__":
    scenario = sealdyn.example("fms_reference").with_({"rotor.runout": 0.0})
    alone, shaft = Shaft(), Shaft()
    alone.step(0.0, 0.05, lambda past: 0j)
    time, tilt, moment = coupled(sealdyn.Simulation(scenario), shaft, 0.05, 5e-5)
    print(abs(alone.y[0]), abs(tilt[-1]))  # 8.22e-06 rad without the seal, 1.03e-05 rad with it
    assert abs(abs(tilt[-1]) - 1.03e-5) < 1e-7
