"""What is looked at: everything the archive keeps, from the motion at given times."""

import numpy as np

from ..faces.geometry import (
    CAVITATED,
    CONTACT_AREA,
    CONTACT_FORCE,
    CONTACT_PRESSURE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    MOMENT_X,
    MOMENT_Y,
    ORDER_LIST,
    ORDERS,
    SPIN_DIFFERENCE,
    TORQUE,
    WEAR,
)
from ..faces.waviness import wave_parts_along
from ..scene.rings import RING_NAMES
from . import equations
from .intervals import constant_and_slope, modulo_turn

# What contact adds.
CONTACT_SIGNALS = {
    "contact_force": CONTACT_FORCE,
    "contact_moment_x": CONTACT_X,
    "contact_moment_y": CONTACT_Y,
    "contact_torque": CONTACT_TORQUE,
    "contact_area_fraction": CONTACT_AREA,
    "contact_pressure": CONTACT_PRESSURE,
    "wear_rate": WEAR,
}
PARTS = ("z", "tilt_x", "tilt_y", "z_rate", "tilt_x_rate", "tilt_y_rate")


def wave_names(face) -> list[tuple[str, str]]:
    """Names of the cosine and of the sine part of the gap's waves, per order."""
    orders = face[ORDER_LIST : ORDER_LIST + int(face[ORDERS])]
    return [(f"gap_cos_{n:.0f}", f"gap_sin_{n:.0f}") for n in orders]


def signals(segment, taus, q, q_rate, x=None) -> dict[str, np.ndarray]:
    """Named series (m,) at times of a segment; `q`, `q_rate` (m, n) displacements and rates, `x` (m, n) the film's.
    SI; leakage counts from high to low pressure."""
    # Kernels of fixed signature are made ready by their import.
    from .kernels import Value, states_along

    m, taus = len(taus), np.ascontiguousarray(taus, dtype=float)
    gap, scratch, low = np.empty((m, GAP_STATE_SIZE)), np.empty((m, equations.SCRATCH)), np.empty((m, 3))
    model = segment.model
    ys, yps = np.zeros((m, segment.size)), np.zeros((m, segment.size))
    massive = segment.rate_places >= 0
    ys[:, : segment.n], yps[:, : segment.n] = q, q_rate
    ys[:, segment.rate_places[massive]] = q_rate[:, massive]
    (flow, f), contact = model.observed, np.empty(0) if model.contact is None else model.contact
    blocks = contact, bool(model.unknowns.seals), segment.p, segment.w, segment.s
    if x is None:
        states_along(Value(flow), f, *blocks, taus, ys, yps, model.face, gap, scratch, low)
    else:
        ys[:, segment.film] = x
        segment.states(taus, ys, yps, gap, scratch, low)
    return _columns(segment, taus, gap, scratch, low)


def _columns(segment, taus, gap, scratch, low):
    model, leg, columns = segment.model, segment.interval, {}
    speed, slope = constant_and_slope(model.scene.shaft.speed, leg)
    columns["time"] = leg.time + taus
    columns["shaft_angle"] = np.mod(modulo_turn(leg.rotor_angle) + taus * (speed + 0.5 * slope * taus), 2 * np.pi)
    columns["shaft_speed"] = speed + slope * taus
    for k, name in enumerate(RING_NAMES):
        at = equations.OWN_STATE + 6 * k
        for i, part in enumerate(PARTS[: 6 if model.unknowns.floats[k] else 3]):
            columns[f"{name}_{part}"] = scratch[:, at + i]
    g = gap[:, GX] + 1j * gap[:, GY]
    columns["relative_tilt_x"], columns["relative_tilt_y"] = gap[:, GX], gap[:, GY]
    columns["relative_misalignment"], columns["relative_precession"] = np.abs(g), np.angle(g)
    columns["axial_gap_change"] = gap[:, DZ]
    columns["h_min"], columns["h_min_angle"], columns["h_min_radius"] = low.T
    columns["film_force"] = gap[:, FORCE]
    columns["film_moment_x"], columns["film_moment_y"] = gap[:, MOMENT_X], gap[:, MOMENT_Y]
    closing = model.closing.over(leg, model.scene.film)
    columns["closing_force"] = closing[0] + closing[1] * taus
    # Flow in +r runs from high to low pressure when the inside is sealed.
    sign = -1.0 if model.closing.outer_is_high else 1.0
    columns["leakage_inner"] = sign * gap[:, FLOW_INNER]
    columns["leakage_outer"] = sign * gap[:, FLOW_OUTER]
    torque = gap[:, TORQUE] + gap[:, CONTACT_TORQUE]
    columns["friction_torque"], columns["friction_power"] = torque, torque * gap[:, SPIN_DIFFERENCE]
    columns["cavitated_fraction"] = gap[:, CAVITATED]
    if model.face[ORDERS]:
        parts = wave_parts_along(model.face, gap)
        for j, names in enumerate(wave_names(model.face)):
            columns |= {name: parts[:, j, i] for i, name in enumerate(names)}
    if model.contact is not None:
        for name, slot in CONTACT_SIGNALS.items():
            columns[name] = gap[:, slot]
    for k in model.unknowns.seals:
        at = equations.SEALS + equations.PER_SEAL * k
        names = ("seal_friction", "seal_moment_x", "seal_moment_y", "seal_sliding_speed")
        for i, name in enumerate(names):
            columns[f"{RING_NAMES[k]}_{name}"] = scratch[:, at + i]
        stuck = segment.p[equations.RING * k + equations.STUCK]
        columns[f"{RING_NAMES[k]}_seal_stuck"] = np.full(len(taus), stuck)
    return {name: np.ascontiguousarray(values) for name, values in columns.items()}
