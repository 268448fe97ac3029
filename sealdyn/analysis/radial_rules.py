"""A radial seal against the design guide's tables for lip and circumferential seals: experience, not mechanics."""

import math

import numpy as np

from ..dynamics.intervals import largest_value
from ..radial_seals.followers import followers_of
from ..scenario.reader import Scenario
from ..scene.application import RadialApplication
from ..scene.radial import RadialScene
from .seal_figures import Finding, Rule, Verdict, limit_finding, other_seals, rows
from .seal_types import (
    LIP_ECCENTRICITY,
    LIP_PRESSURE,
    LIP_PRESSURE_SPEED,
    LIP_SPEED,
    RIBBED_ECCENTRICITY,
    RIBBED_PRESSURE,
    RIBBED_SPEED,
    SEGMENT_PRESSURE,
    SEGMENT_RUNOUT,
    SEGMENT_SHARE,
    SEGMENT_SPEED,
    Duty,
    seal_type_finding,
)


def findings(scenario: Scenario) -> list[dict]:
    """What every rule finds of the scenario of a radial seal: dicts as design_rules.findings."""
    scene, application = scenario.scene, scenario.application or RadialApplication()
    rules = CIRCUMFERENTIAL if scene.circumferential else RIBBED_LIP if application.hydrodynamic_lip else LIP
    return rows(rules, scene, application.acknowledge)


def surface_speed(scene: RadialScene) -> float:
    """Of the shaft (m/s), at its fastest."""
    return largest_value(scene.shaft.speed) * scene.shaft.radius


def _lip_speed(scene, limit) -> Finding:
    eccentricities, speeds = limit
    total, speed = scene.shaft.eccentricity + scene.shaft.offset, surface_speed(scene)
    # Beyond the table its last speed stands: nothing is extrapolated.
    allowed = float(np.interp(total, eccentricities[::-1], speeds[::-1]))
    sentence = f"{60 * speed:.4g} m/min with {1e3 * total:.3g} mm of offset and eccentricity"
    sentence += f"; experience allows {60 * allowed:.4g} m/min"
    if total > eccentricities[0]:
        return limit_finding(f"{sentence}; the table ends at {1e3 * eccentricities[0]:.3g} mm", speed, most=0.0)
    return limit_finding(sentence, speed, most=allowed)


def _lip_eccentricity(scene, limit) -> Finding:
    total = scene.shaft.eccentricity + scene.shaft.offset
    return limit_finding(
        f"{1e3 * total:.3g} mm of offset and eccentricity, below {1e3 * limit:.3g} mm", total, most=limit
    )


def _lip_load(scene, limit) -> Finding:
    load = _preload(scene)
    sentence = f"the lip presses with {load:.4g} N/m, usual are {limit[0]:g} to {limit[1]:g}"
    return limit_finding(sentence, load, *limit, beyond=Verdict.NOTE)


def _preload(scene) -> float:
    """Radial preload (N/m) along the circumference."""
    followers = followers_of(scene)
    return followers.preload / followers.arc


def _lip_pressure(scene, limit) -> Finding:
    pressures, speeds = limit
    pressure, speed = scene.lip.pressure_difference, surface_speed(scene)
    allowed = float(np.interp(pressure, pressures, speeds))
    if pressure > pressures[-1]:
        sentence = f"{1e-5 * pressure:.3g} bar; the table ends at 5 psi, 0.345 bar"
        return limit_finding(sentence, pressure, most=float(pressures[-1]), unit="Pa")
    sentence = f"{60 * speed:.4g} m/min at {1e-5 * pressure:.3g} bar; experience allows {60 * allowed:.4g} m/min"
    return limit_finding(sentence, speed, most=allowed)


def _segment_speed(scene, limit) -> Finding:
    runouts, speeds = limit
    runout, speed = 2.0 * scene.shaft.eccentricity, surface_speed(scene)
    allowed = float(np.interp(runout, runouts, speeds))
    sentence = f"{60 * speed:.4g} m/min with {1e3 * runout:.3g} mm TIR; experience allows {60 * allowed:.4g} m/min"
    if runout > runouts[-1]:
        return limit_finding(sentence + "; the table ends at 0.508 mm", runout, most=float(runouts[-1]), unit="m")
    return limit_finding(sentence, speed, most=allowed)


def _segment_runout(scene, limit) -> Finding:
    runout, most = 2.0 * scene.shaft.eccentricity, limit * 2.0 * scene.shaft.radius
    sentence = f"{1e3 * runout:.3g} mm TIR, {limit:g} of the diameter are {1e3 * most:.3g} mm"
    return limit_finding(sentence, runout, most=most, beyond=Verdict.NOTE)


def _garter_load(scene, limit) -> Finding:
    load = _preload(scene)
    sentence = f"the garter spring presses with {load:.4g} N/m, usual are {limit[0]:g} to {limit[1]:g}"
    return limit_finding(sentence, load, *limit, beyond=Verdict.NOTE)


def _axial_load(scene, limit) -> Finding:
    load = scene.circumferential.axial_force / (2.0 * math.pi * scene.shaft.radius)
    sentence = f"axial springs press with {load:.4g} N/m, usual are about 70 (here {limit[0]:g} to {limit[1]:g})"
    return limit_finding(sentence, load, *limit, beyond=Verdict.NOTE)


def _segment_pressure(scene, limit) -> Finding:
    pressure = scene.circumferential.pressure_difference
    return limit_finding(f"{1e-4 * pressure:.3g} N/cm^2, below {1e-4 * limit:.3g} (1 psi)", pressure, most=limit)


def _hang_up(scene, limit) -> Finding:
    followers = followers_of(scene)
    sentence = f"the garter spring presses a segment with {followers.preload:.3g} N"
    sentence += f", its flange holds it with up to {followers.friction:.3g} N"
    # To be equal is not enough.
    return limit_finding(sentence, followers.friction, most=followers.preload * (1.0 - 1e-12))


def _seal_type(own: str):
    """Rule of a radial seal of its `own` type: its axial travel is free."""

    def judge(scene, limit) -> Finding:
        shaft = scene.shaft
        duty = Duty(
            surface_speed(scene), scene.seal.pressure_difference, 2.0 * shaft.eccentricity,
            shaft.eccentricity + shaft.offset, diameter=2.0 * shaft.radius,
        )  # fmt: skip
        return seal_type_finding(duty, own)

    return judge


def _other_lips(sentence: str):
    return lambda scene, limit: other_seals(sentence)


FOLLOW, TYPES = "sealdyn study followability FILE", "tables 3.1 to 3.4 and 3.8"
LIP = {
    "lip_eccentricity": Rule(_other_lips("section 3.1.4 is of hydrodynamic lips"), None, "m", "section 3.1.4", FOLLOW),
    "lip_load": Rule(_lip_load, (87.5, 123.0), "N/m", "lip load of conventional lips", FOLLOW),
    "lip_pressure": Rule(_lip_pressure, (LIP_PRESSURE, LIP_PRESSURE_SPEED), "m/s", "table 3.1"),
    "lip_speed": Rule(_lip_speed, (LIP_ECCENTRICITY, LIP_SPEED), "m/s", "table 3.2", FOLLOW),
    "seal_type": Rule(_seal_type("conventional lip seal"), None, "m/s", TYPES),
}
RIBBED_LIP = {
    "lip_eccentricity": Rule(_lip_eccentricity, RIBBED_ECCENTRICITY, "m", "section 3.1.4", FOLLOW),
    "lip_load": Rule(_lip_load, (52.5, 70.0), "N/m", "lip load of hydrodynamic lips", FOLLOW),
    "lip_pressure": Rule(_lip_pressure, (RIBBED_PRESSURE, RIBBED_SPEED), "m/s", "table 3.3"),
    "lip_speed": Rule(_other_lips("table 3.2 is of conventional lips"), None, "m/s", "table 3.2", FOLLOW),
    "seal_type": Rule(_seal_type("hydrodynamic lip seal"), None, "m/s", TYPES),
}
CIRCUMFERENTIAL = {
    "axial_load": Rule(_axial_load, (50.0, 90.0), "N/m", "axial load about 70 N/m", FOLLOW),
    "garter_load": Rule(_garter_load, (17.5, 35.0), "N/m", "radial garter load 17.5 to 35 N/m", FOLLOW),
    "hang_up": Rule(_hang_up, None, "N", "friction on the case flange", "sealdyn run FILE"),
    "seal_type": Rule(_seal_type("circumferential seal"), None, "m/s", TYPES),
    "segment_pressure": Rule(_segment_pressure, SEGMENT_PRESSURE, "Pa", "below 0.689 N/cm^2"),
    "segment_runout": Rule(_segment_runout, SEGMENT_SHARE, "m", "shaft runout below 0.0005 of the diameter", FOLLOW),
    "segment_speed": Rule(_segment_speed, (SEGMENT_RUNOUT, SEGMENT_SPEED), "m/s", "table 3.4", FOLLOW),
}
