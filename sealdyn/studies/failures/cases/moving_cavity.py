"""Cavities that move: a film's stiffness and damping where its cavities follow the faces with their liquid.

Lebeck's seal with three waves, its clearance swinging with the shaft: the cavity behind each crest takes up liquid and
gives it back, neither at once nor not at all.
**Source** the film about its rest, linearised (dynamics/condensation.py), and the same motion step by step.
"""

import math
from functools import cache

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu, spsolve

from ....analysis.sources import lebeck_1979
from ....dynamics.interface import Interface, rest_state
from ....faces.geometry import DZ, FLOW_INNER, FORCE, INNER_PRESSURE, MEAN_SPIN, OUTER_PRESSURE
from ....faces.roughness import mean_film_cubed
from ....films.reynolds.mesh import AREA, SECTORS, films, table
from ....solvers.trbdf2 import D, W
from . import row

CELLS, TURNS, STEPS, SWING = (6, 36), 3, 64, 1e-4
SPEED = lebeck_1979.SPEED


@cache
def seal():
    """The film at rest: Interface, gap state, and linearised over the whole circle."""
    interface = Interface(lebeck_1979.scene_of(lebeck_1979.ROWS[1], CELLS), 1e-8)
    s, steps = rest_state(interface.scene, interface.clearance)
    return interface, s, interface.linear_film(s, steps)


def frozen_damping(linear) -> float:
    """Axial damping (N s/m) of pressures alone, with every cavity as large as it is at rest."""
    n = len(linear.by_gap) // 2
    pressed = splu(linear.by_x.tocsc()[:n, :n]).solve(linear.by_gap_rate[:n, 0])
    return float(linear.force_by_x[0, :n] @ pressed - linear.force_by_gap_rate[0, 0])


def swung(omega: float, euler: bool) -> complex:
    """Axial dynamic stiffness (N/m) from the film's force while the gap swings, STEPS to a turn."""
    interface, rest, _ = seal()
    film, f, s = interface.film, interface.f, rest.copy()
    x, h, swing = interface.steady(f, s), 2.0 * math.pi / omega / STEPS, SWING * interface.clearance
    rate, forces, times = np.zeros_like(x), [], h * np.arange(1, TURNS * STEPS + 1)

    def stage(t, alpha, base):
        s[DZ] = swing * math.sin(omega * t)
        if film.settle(f, s, alpha, base, x):
            raise RuntimeError("the film was not solved")
        return alpha * (x - base)

    for t in times:
        at, begun = x.copy(), t - h
        if euler:
            stage(t, 1.0 / h, at)
        else:
            first = stage(begun + 2.0 * D * h, 1.0 / (D * h), at + D * h * rate)
            rate = stage(t, 1.0 / (D * h), at + h * W * (rate + first))
        film.wrench(f, s, x)
        forces.append(s[FORCE] - rest[FORCE])
    last = slice(-STEPS, None)
    forces = np.array(forces[last]) - np.mean(forces[last])
    # sin(w t) is the imaginary part of exp(i w t).
    return complex(-2.0 * np.mean(forces * 1j * np.exp(-1j * omega * times[last])) / swing)


def leakage_by_reynolds_condition() -> tuple[float, float]:
    """Leakage (m^3/s) where pressures are held above cavitation without a thought for the liquid, and where it is kept:
    the pressure is least, and its slope nothing, at the edge of a cavity; what flows there comes from nowhere."""
    interface, rest, _ = seal()
    f, s = interface.f, rest.copy()
    _, carried, ways, around = films(f, s)
    angles, cells = carried.shape
    own, area = np.arange(angles * cells).reshape(angles, cells), table(f, AREA)[:cells]
    rows, columns, values = [], [], []

    def between(a, b, way):
        for i, j, sign in ((a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)):
            rows.append(i.ravel()), columns.append(j.ravel()), values.append((sign * way).ravel())

    between(own[:, :-1], own[:, 1:], ways[:, 1:-1])
    between(own, np.roll(own, -1, 0), around)
    for edge, way in ((own[:, 0], ways[:, 0]), (own[:, -1], ways[:, -1])):
        rows.append(edge), columns.append(edge), values.append(way)
    whole = csc_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
    right = s[MEAN_SPIN] * area * (np.roll(carried, 1, 0) - carried)
    right[:, 0] += ways[:, 0] * s[INNER_PRESSURE]
    right[:, -1] += ways[:, -1] * s[OUTER_PRESSURE]
    right, full = right.ravel(), np.full(angles * cells, True)
    while True:
        p = np.zeros(len(right))
        p[full] = spsolve(whole[full][:, full], right[full])
        now = np.where(full, p >= 0.0, right - whole @ p > 0.0)
        if np.array_equal(now, full):
            break
        full = now
    inner = f[SECTORS] * float(ways[:, 0] @ (p.reshape(angles, cells)[:, 0] - s[INNER_PRESSURE]))
    interface.film.flow(f, s, interface.steady(f, s))
    return inner, -float(s[FLOW_INNER])


def leakage_of_the_mean_cube() -> float:
    """Leakage (m^3/s) in closed form: weighted with ln r the balance of all cells leaves a flow through the mean of
    E(H^3), wherever cavities are, for what is dragged around the circle comes back."""
    film, row_ = seal()[0].scene.film, lebeck_1979.ROWS[1]
    waves = row_.amplitude * np.cos(2.0 * math.pi * np.arange(4096) / 4096)
    cube = lebeck_1979.HALF**3 * float(np.mean(mean_film_cubed(seal()[0].clearance / lebeck_1979.HALF + waves)))
    fall = film.outer_pressure - film.inner_pressure
    return 2.0 * math.pi * cube * fall / (12.0 * film.viscosity * math.log(film.outer_radius / film.inner_radius))


def meets_moving_cavity(scene, run) -> str:
    """A film of cells that tear and fill."""
    return "cavities that keep their liquid move in its film" if run.model.interface.film.settle is not None else ""


def show_moving_cavity() -> list[dict]:
    """Stiffness of slow motion, damping of a frozen cavity, implicit Euler, Reynolds' condition."""
    interface, rest, linear = seal()
    interface.film.wrench(interface.f, rest, interface.steady(interface.f, rest))
    k, d = (float(part[0, 0]) for part in linear.matrices(SPEED))
    true = complex(k, SPEED * d)
    kept, euler = swung(SPEED, False), swung(SPEED, True)
    loose, right = leakage_by_reynolds_condition()
    slow = float(linear.slow[0][0, 0])
    return [
        row(
            14, "Cavity that follows at once", ("stiffness of slow motion, at shaft speed", abs(slow / k - 1.0)),
            ("the motion step by step, TR-BDF2, 64 steps a turn", abs(kept.real / k - 1.0)),
            "axial film stiffness, relative", "keeps the liquid of every cell as an unknown",
        ),
        row(
            14, "Frozen cavity", ("damping of the pressures alone", abs(frozen_damping(linear) / d - 1.0)),
            ("the motion step by step, TR-BDF2, 64 steps a turn", abs(kept.imag / SPEED / d - 1.0)),
            "axial film damping, relative", "keeps the liquid of every cell as an unknown",
        ),
        row(
            14, "Implicit Euler", ("implicit Euler, 64 steps a turn", abs(euler - true) / abs(true)),
            ("TR-BDF2, 64 steps a turn", abs(kept - true) / abs(true)), "dynamic stiffness, relative",
            "steps with TR-BDF2 where cells tear and fill",
        ),
        row(
            14, "Reynolds' condition", ("p >= p_cav alone", abs(loose / right - 1.0)),
            ("void and pressure, the liquid kept", abs(right / leakage_of_the_mean_cube() - 1.0)), "leakage, relative",
            "keeps the liquid; a floor of the radial film says that it does not",
        ),
    ]  # fmt: skip


EXHIBITS = {"moving_cavity": (14, show_moving_cavity, meets_moving_cavity)}
