"""A radial seal held against the design guide's tables for lip and circumferential seals: experience, not mechanics."""

import math
from functools import partial

import numpy as np

from ..dynamics.intervals import largest_value
from ..radial_seals.followers import followers_of
from ..scene.application import RadialApplication
from .design_rules import GUIDE, acknowledged
from .rules._finding import Verdict, other_seals, within

FOOT_PER_MINUTE, PSI = 0.3048 / 60.0, 6894.757
# Table 3.2: total eccentricity (m) of lip seals without pressure, and the speed (m/s) that it allows.
LIP_ECCENTRICITY = np.array([0.381e-3, 0.254e-3, 0.203e-3, 0.178e-3])
LIP_SPEED = np.array([1000.0, 2000.0, 3000.0, 4000.0]) * FOOT_PER_MINUTE
# Table 3.1: pressure (Pa) of lip seals, and the speed (m/s) that it allows.
LIP_PRESSURE = np.array([1.0, 3.0, 5.0]) * PSI
LIP_PRESSURE_SPEED = np.array([3000.0, 2000.0, 1500.0]) * FOOT_PER_MINUTE
# Table 3.3: the same of hydrodynamic lips, and the eccentricity (m) below which they work.
RIBBED_PRESSURE, RIBBED_SPEED = np.array([6.89e3, 20.6e3, 34.4e3]), np.array([1830.0, 1220.0, 610.0]) / 60.0
RIBBED_ECCENTRICITY = 0.127e-3
# Load (N/m) of conventional and of hydrodynamic lips.
LIP_LOAD, RIBBED_LOAD = (87.5, 123.0), (52.5, 70.0)
# Table 3.4: runout (m, total indicator reading) of circumferential seals without pressure, and the speed (m/s) that it
# allows, in the only order that falls: the rows of the scan are shuffled; 1830 m/min is 6000 ft/min.
SEGMENT_RUNOUT = np.array([0.0254e-3, 0.127e-3, 0.254e-3, 0.381e-3, 0.508e-3])
SEGMENT_SPEED = np.array([4550.0, 3660.0, 2440.0, 1830.0, 1220.0]) / 60.0


def findings(scenario) -> list[dict]:
    """What every rule says of the scenario of a radial seal: dicts as design_rules.findings."""
    scene, application = scenario.scene, scenario.application or RadialApplication()
    rules = CIRCUMFERENTIAL if scene.circumferential else RIBBED_LIP if application.hydrodynamic_lip else LIP
    return [_row(name, *about, scene, application.acknowledge.get(name)) for name, about in rules.items()]


def _row(name, source, command, rule, scene, reason) -> dict:
    found = acknowledged(rule(scene), reason)
    return {
        "rule": name, "verdict": str(found.verdict), "value": found.value, "unit": found.unit, "least": found.least,
        "most": found.most, "guide": GUIDE, "source": source, "said": found.said, "command": command, "reason": reason,
        **found.numbers,
    }  # fmt: skip


def surface_speed(scene) -> float:
    """Of the shaft (m/s), at its fastest."""
    return largest_value(scene.shaft.speed) * scene.shaft.radius


def _lip_speed(scene):
    shaft, speed = scene.shaft, surface_speed(scene)
    total = shaft.eccentricity + shaft.offset
    # Beyond the table its last speed stands: nothing is extrapolated.
    allowed = float(np.interp(total, LIP_ECCENTRICITY[::-1], LIP_SPEED[::-1]))
    said = (f"{60 * speed:.4g} m/min with {1e3 * total:.3g} mm of offset and eccentricity; experience allows "
            f"{60 * allowed:.4g} m/min")  # fmt: skip
    if total > LIP_ECCENTRICITY[0]:
        said += f"; the table ends at {1e3 * LIP_ECCENTRICITY[0]:.3g} mm"
        return within(said, speed, "m/s", most=0.0)
    return within(said, speed, "m/s", most=allowed)


def _lip_eccentricity(scene):
    total = scene.shaft.eccentricity + scene.shaft.offset
    said = f"{1e3 * total:.3g} mm of offset and eccentricity, below {1e3 * RIBBED_ECCENTRICITY:.3g} mm"
    return within(said, total, "m", most=RIBBED_ECCENTRICITY)


def _lip_load(limits, scene):
    followers = followers_of(scene)
    load = followers.preload / followers.arc
    said = f"the lip presses with {load:.4g} N/m, usual are {limits[0]:g} to {limits[1]:g}"
    return within(said, load, "N/m", *limits, beyond=Verdict.NOTE)


def _lip_pressure(pressures, speeds, scene):
    pressure, speed = scene.lip.pressure_difference, surface_speed(scene)
    allowed = float(np.interp(pressure, pressures, speeds))
    said = f"{60 * speed:.4g} m/min at {1e-5 * pressure:.3g} bar; experience allows {60 * allowed:.4g} m/min"
    if pressure > pressures[-1]:
        return within(f"{1e-5 * pressure:.3g} bar; the table ends at 5 psi, 0.345 bar", pressure, "Pa",
                      most=float(pressures[-1]))  # fmt: skip
    return within(said, speed, "m/s", most=allowed)


def _segment_speed(scene):
    runout, speed = 2.0 * scene.shaft.eccentricity, surface_speed(scene)
    allowed = float(np.interp(runout, SEGMENT_RUNOUT, SEGMENT_SPEED))
    said = f"{60 * speed:.4g} m/min with {1e3 * runout:.3g} mm TIR; experience allows {60 * allowed:.4g} m/min"
    if runout > SEGMENT_RUNOUT[-1]:
        return within(said + "; the table ends at 0.508 mm", runout, "m", most=float(SEGMENT_RUNOUT[-1]))
    return within(said, speed, "m/s", most=allowed)


def _segment_runout(scene):
    runout, most = 2.0 * scene.shaft.eccentricity, 0.0005 * 2.0 * scene.shaft.radius
    said = f"{1e3 * runout:.3g} mm TIR, 0.0005 of the diameter are {1e3 * most:.3g} mm"
    return within(said, runout, "m", most=most, beyond=Verdict.NOTE)


def _garter_load(scene):
    followers = followers_of(scene)
    load = followers.preload / followers.arc
    return within(f"the garter spring presses with {load:.4g} N/m, usual are 17.5 to 35", load, "N/m", least=17.5,
                  most=35.0, beyond=Verdict.NOTE)  # fmt: skip


def _axial_load(scene):
    load = scene.circumferential.axial_force / (2.0 * math.pi * scene.shaft.radius)
    return within(f"axial springs press with {load:.4g} N/m, usual are about 70 (here 50 to 90)", load, "N/m",
                  least=50.0, most=90.0, beyond=Verdict.NOTE)  # fmt: skip


def _segment_pressure(scene):
    pressure = scene.circumferential.pressure_difference
    return within(f"{1e-4 * pressure:.3g} N/cm^2, below 0.689 (1 psi)", pressure, "Pa", most=6890.0)


def _hang_up(scene):
    followers = followers_of(scene)
    said = (f"the garter spring presses a segment with {followers.preload:.3g} N, its flange holds it with up to "
            f"{followers.friction:.3g} N")  # fmt: skip
    return within(said, followers.friction, "N", most=followers.preload * (1.0 - 1e-12))


FOLLOW = "sealdyn study followability FILE"
# Rule: where it stands in the guide, the command that tests it, and the rule.
LIP = {
    "lip_eccentricity": ("table 3.3", FOLLOW, lambda scene: other_seals("table 3.3 is of hydrodynamic lips")),
    "lip_load": ("lip load of conventional lips", FOLLOW, partial(_lip_load, LIP_LOAD)),
    "lip_pressure": ("table 3.1", "", partial(_lip_pressure, LIP_PRESSURE, LIP_PRESSURE_SPEED)),
    "lip_speed": ("table 3.2", FOLLOW, _lip_speed),
}
RIBBED_LIP = {
    "lip_eccentricity": ("table 3.3", FOLLOW, _lip_eccentricity),
    "lip_load": ("lip load of hydrodynamic lips", FOLLOW, partial(_lip_load, RIBBED_LOAD)),
    "lip_pressure": ("table 3.3", "", partial(_lip_pressure, RIBBED_PRESSURE, RIBBED_SPEED)),
    "lip_speed": ("table 3.2", FOLLOW, lambda scene: other_seals("table 3.2 is of conventional lips")),
}
CIRCUMFERENTIAL = {
    "axial_load": ("axial load about 70 N/m", FOLLOW, _axial_load),
    "garter_load": ("radial garter load 17.5 to 35 N/m", FOLLOW, _garter_load),
    "hang_up": ("friction on the case flange", "sealdyn run FILE", _hang_up),
    "segment_pressure": ("below 0.689 N/cm^2", "", _segment_pressure),
    "segment_runout": ("shaft runout below 0.0005 of the diameter", FOLLOW, _segment_runout),
    "segment_speed": ("table 3.4", FOLLOW, _segment_speed),
}
