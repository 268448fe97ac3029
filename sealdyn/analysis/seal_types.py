"""Which of the design guide's four types of seal the speed, pressure, runout and travel of a shaft allow.

**Source** Hayden & Keller, NASA CR-120997 (1974), tables 3.1 to 3.4 and 3.8, sections 2 and 3: experience with oil.  Of
lips tables 3.1 and 3.2 are of pressure without eccentricity and of eccentricity without pressure: with both the lower
of their speeds stands here.
"""

from dataclasses import dataclass

import numpy as np

from .seal_figures import Finding, Verdict

FOOT_PER_MINUTE, PSI = 0.3048 / 60.0, 6894.757
# Sliding speed (m/s) up to which each type goes; of ft/min rounded in print.
SPEEDS = {
    "face seal": 6096.0 / 60,
    "conventional lip seal": 1220.0 / 60,
    "hydrodynamic lip seal": 2135.0 / 60,
    "circumferential seal": 4550.0 / 60,
}
# Table 3.8, of face seals: up to a sliding speed (m/min), total indicator reading (m) of the shaft.
RUNOUT = ((1522.0, 0.508e-3), (3044.0, 0.38e-3), (6090.0, 0.254e-3))
# Pressure (Pa) of an unbalanced and a balanced face; axial travel (m) of its springs, beyond which a seal rides on the
# shaft.
BALANCE = (68.9e4, 689e4)
TRAVEL = {"wave_washer": 0.76e-3, "coil": 1.27e-3, "bellows": 1.27e-3}
# Table 3.2: total eccentricity (m) of lip seals without pressure, and the speed (m/s) that it allows.
LIP_ECCENTRICITY = np.array([0.381e-3, 0.254e-3, 0.203e-3, 0.178e-3])
LIP_SPEED = np.array([1000.0, 2000.0, 3000.0, 4000.0]) * FOOT_PER_MINUTE
# Table 3.1: pressure (Pa) of lip seals, and the speed (m/s) that it allows.
LIP_PRESSURE = np.array([1.0, 3.0, 5.0]) * PSI
LIP_PRESSURE_SPEED = np.array([3000.0, 2000.0, 1500.0]) * FOOT_PER_MINUTE
# Table 3.3: the same of hydrodynamic lips; section 3.1.4: the eccentricity (m) below which they work.
RIBBED_PRESSURE, RIBBED_SPEED = np.array([6.89e3, 20.6e3, 34.4e3]), np.array([1830.0, 1220.0, 610.0]) / 60.0
RIBBED_ECCENTRICITY = 0.127e-3
# Table 3.4: runout (m, total indicator reading) of circumferential seals without pressure, and the speed (m/s) that it
# allows, in the only order that falls: the rows of the scan are shuffled; 1830 m/min is 6000 ft/min.
SEGMENT_RUNOUT = np.array([0.0254e-3, 0.127e-3, 0.254e-3, 0.381e-3, 0.508e-3])
SEGMENT_SPEED = np.array([4550.0, 3660.0, 2440.0, 1830.0, 1220.0]) / 60.0
SEGMENT_PRESSURE, SEGMENT_SHARE = 6890.0, 0.0005


@dataclass(frozen=True)
class Duty:
    """What a shaft asks of a seal: sliding `speed` (m/s), `pressure` difference (Pa), total `runout` (m, indicator
    reading) and `eccentricity` (m, static offset and half the runout), axial `travel` (m) and shaft `diameter` (m);
    None where nothing is said."""

    speed: float
    pressure: float
    runout: float | None = None
    eccentricity: float | None = None
    travel: float | None = None
    diameter: float | None = None


def limits(duty: Duty) -> dict[str, list[tuple[str, float | None, float | None]]]:
    """By type, what counts ("speed" | "pressure" | "runout" | "eccentricity" | "travel"), the duty's value of it and
    the most that this type takes beside the rest of the duty, SI; None where the duty does not say."""
    fpm, tir, offset, pressure = 60.0 * duty.speed, duty.runout, duty.eccentricity, duty.pressure
    of_face = next((allowed for fastest, allowed in RUNOUT if fpm <= fastest), RUNOUT[-1][1])
    lip, ribbed, segments = (SPEEDS[name] for name in [*SPEEDS][1:])
    # Beyond a table its last speed stands: nothing is extrapolated.
    if pressure > 0.0:
        lip = min(lip, float(np.interp(pressure, LIP_PRESSURE, LIP_PRESSURE_SPEED)))
        ribbed = min(ribbed, float(np.interp(pressure, RIBBED_PRESSURE, RIBBED_SPEED)))
    if offset is not None:
        lip = min(lip, float(np.interp(offset, LIP_ECCENTRICITY[::-1], LIP_SPEED[::-1])))
    if tir is not None:
        segments = min(segments, float(np.interp(tir, SEGMENT_RUNOUT, SEGMENT_SPEED)))
    of_segments = float(SEGMENT_RUNOUT[-1])
    if duty.diameter is not None:
        of_segments = min(of_segments, SEGMENT_SHARE * duty.diameter)
    return {
        "face seal": [
            ("speed", duty.speed, SPEEDS["face seal"]),
            ("pressure", pressure, BALANCE[1]),
            ("runout", tir, of_face),
            ("travel", duty.travel, max(TRAVEL.values())),
        ],
        "conventional lip seal": [
            ("speed", duty.speed, lip),
            ("pressure", pressure, float(LIP_PRESSURE[-1])),
            ("eccentricity", offset, float(LIP_ECCENTRICITY[0])),
        ],
        "hydrodynamic lip seal": [
            ("speed", duty.speed, ribbed),
            ("pressure", pressure, float(RIBBED_PRESSURE[-1])),
            ("eccentricity", offset, RIBBED_ECCENTRICITY),
        ],
        "circumferential seal": [
            ("speed", duty.speed, segments),
            ("pressure", pressure, SEGMENT_PRESSURE),
            ("runout", tir, of_segments),
        ],
    }


def suited(duty: Duty) -> list[dict]:
    """Each type, `allowed` (None where what the duty does not say decides), what goes `beyond` it and what is
    `unknown`; of what is beyond the value and the most."""
    found = []
    for name, checks in limits(duty).items():
        beyond = [{"what": what, "value": value, "most": most} for what, value, most in checks
                  if value is not None and value > most]  # fmt: skip
        unknown = [what for what, value, _ in checks if value is None]
        allowed = False if beyond else None if unknown else True
        found.append({"type": name, "allowed": allowed, "beyond": beyond, "unknown": unknown})
    return found


def seal_type_finding(duty: Duty, own: str) -> Finding:
    """Pass unless something goes beyond what the `own` type takes, and the types that are allowed; a note otherwise."""
    types = suited(duty)
    (ours,) = (row for row in types if row["type"] == own)
    words = {True: [], None: [], False: []}
    for row in types:
        why = [f"{b['what']} {_read(**b)}" for b in row["beyond"]] or [f"{what} not known" for what in row["unknown"]]
        words[row["allowed"]].append(f"{row['type']} ({', '.join(why)})" if why else row["type"])
    heads = {True: "allowed", None: "perhaps", False: "not"}
    sentence = "; ".join(f"{head}: {', '.join(words[key])}" for key, head in heads.items() if words[key])
    verdict = Verdict.NOTE if ours["allowed"] is False else Verdict.PASS
    return Finding(verdict, sentence, duty.speed, most=limits(duty)[own][0][2], numbers={"types": types})


def _read(what: str, value: float, most: float) -> str:
    """A number and its limit in the guide's own metric units."""
    factor, unit = {"speed": (60.0, "m/min"), "pressure": (1e-4, "N/cm^2")}.get(what, (1e3, "mm"))
    return f"{factor * value:.4g} beyond {factor * most:.4g} {unit}"
