"""What a run of a radial seal keeps: series over time, and gap and load around the shaft."""

import math

import numpy as np

from ..dynamics.intervals import constant_and_slope, modulo_turn
from .equations import RIDING

# Name: SI unit, meaning, unit for people and how many of it make one.
SERIES = {
    "shaft_angle": ("rad", "shaft angle", "deg", 180 / math.pi),
    "shaft_speed": ("rad/s", "shaft speed", "rpm", 30 / math.pi),
    "largest_gap": ("m", "largest gap between seal and shaft", "µm", 1e6),
    "contact_share": ("", "share of the followers that ride on the shaft", "%", 100.0),
    "least_load": ("N", "least load of a follower that rides, 0 if none does", "N", 1.0),
    "load": ("N", "load of all followers on the shaft", "N", 1.0),
    "friction_torque": ("N m", "friction torque on the shaft", "mN m", 1e3),
    "leakage_estimate": ("m^3/s", "leakage estimate: laminar flow through the gaps", "ml/h", 3.6e9),
}
FIELDS = {
    "gap": ("m", "gap between seal and shaft", "µm", 1e6),
    "follower_load": ("N", "load of a follower on the shaft", "N", 1.0),
}


def columns(segment, taus, us, vs) -> tuple[dict, dict]:
    """Series (m,) and fields (m, n) at segment times `taus` (m,) (s), displacements and rates (m, n)."""
    scene, followers = segment.model.scene, segment.model.followers
    gaps, _, loads = segment.state(taus, us, vs)
    rides = segment.modes == RIDING
    gaps, loads = np.maximum(gaps, 0.0), np.where(rides, np.maximum(loads, 0.0), 0.0)
    speed, slope = constant_and_slope(scene.shaft.speed, segment.interval)
    total = loads.sum(axis=1)
    found = {
        "time": segment.time + taus,
        "shaft_angle": np.mod(modulo_turn(segment.interval.rotor_angle) + taus * (speed + 0.5 * slope * taus),
                              2.0 * math.pi),
        "shaft_speed": speed + slope * taus,
        "largest_gap": gaps.max(axis=1),
        "contact_share": np.full(len(taus), rides.mean()),
        "least_load": loads[:, rides].min(axis=1) if rides.any() else np.zeros(len(taus)),
        "load": total,
        "friction_torque": scene.seal.friction_coefficient * scene.shaft.radius * total,
        "leakage_estimate": conductance(scene) * followers.arc * (gaps**3).sum(axis=1),
    }  # fmt: skip
    return found, {"gap": gaps, "follower_load": loads}


def conductance(scene) -> float:
    """Flow (m^3/s) per length of circumference and gap cubed, dp / (12 mu width): laminar, along the shaft; 0 where the
    scene does not say what it takes."""
    seal = scene.seal
    if not (seal.contact_width and seal.viscosity):
        return 0.0
    return seal.pressure_difference / (12.0 * seal.viscosity * seal.contact_width)
