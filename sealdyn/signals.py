"""What is looked at: everything the archive keeps, from the motion at given times."""

import numpy as np

from . import dynamics
from .gap import (
    CAVITATED,
    DZ,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    MOMENT_X,
    MOMENT_Y,
    SPIN_DIFFERENCE,
    TORQUE,
    h_min,
)
from .layout import RING_NAMES
from .legs import constant_and_slope, reduced

PARTS = ("z", "tilt_x", "tilt_y", "z_rate", "tilt_x_rate", "tilt_y_rate")


def signals(problem, taus, q, q_rate) -> dict[str, np.ndarray]:
    """Named series (m,) at leg times of the problem's present leg; `q`, `q_rate` (m, n) displacements and rates.
    SI; leakage counts from high to low pressure."""
    m = len(taus)
    gap, scratch, low = np.empty((m, GAP_STATE_SIZE)), np.empty((m, dynamics.SCRATCH)), np.empty((m, 3))
    flow, f, p, w, s, face = problem.film.flow, problem.f, problem.p, problem.w, problem.s, problem.face
    ys, yps = np.zeros((m, problem.size)), np.zeros(problem.size)
    massive = problem.rate_places >= 0
    ys[:, : problem.n] = q
    ys[:, problem.rate_places[massive]] = q_rate[:, massive]
    for i in range(m):
        yps[: problem.n] = q_rate[i]
        dynamics.kinematics(taus[i], ys[i], yps, p, w, s)
        flow(f, s)
        gap[i], scratch[i] = s, w
        low[i] = h_min(face, s[DZ], s[GX], s[GY])
    return _columns(problem, np.asarray(taus), gap, scratch, low)


def _columns(problem, taus, gap, scratch, low):
    leg, columns = problem.leg, {}
    speed, slope = constant_and_slope(problem.scene.shaft.speed, leg)
    columns["time"] = leg.time + taus
    columns["shaft_angle"] = np.mod(reduced(leg.rotor_angle) + taus * (speed + 0.5 * slope * taus), 2 * np.pi)
    columns["shaft_speed"] = speed + slope * taus
    for k, name in enumerate(RING_NAMES):
        at = dynamics.OWN_STATE + 6 * k
        for i, part in enumerate(PARTS[: 6 if problem.floats[k] else 3]):
            columns[f"{name}_{part}"] = scratch[:, at + i]
    g = gap[:, GX] + 1j * gap[:, GY]
    columns["relative_tilt_x"], columns["relative_tilt_y"] = gap[:, GX], gap[:, GY]
    columns["relative_misalignment"], columns["relative_precession"] = np.abs(g), np.angle(g)
    columns["axial_gap_change"] = gap[:, DZ]
    columns["h_min"], columns["h_min_angle"], columns["h_min_radius"] = low.T
    columns["film_force"] = gap[:, FORCE]
    columns["film_moment_x"], columns["film_moment_y"] = gap[:, MOMENT_X], gap[:, MOMENT_Y]
    closing = problem.closing.over(leg, problem.scene.film)
    columns["closing_force"] = closing[0] + closing[1] * taus
    # Flow in +r runs from high to low pressure when the inside is sealed.
    sign = -1.0 if problem.closing.outer_is_high else 1.0
    columns["leakage_inner"] = sign * gap[:, FLOW_INNER]
    columns["leakage_outer"] = sign * gap[:, FLOW_OUTER]
    columns["friction_torque"] = gap[:, TORQUE]
    columns["friction_power"] = gap[:, TORQUE] * gap[:, SPIN_DIFFERENCE]
    columns["cavitated_fraction"] = gap[:, CAVITATED]
    return {name: np.ascontiguousarray(values) for name, values in columns.items()}
