"""Rules beside those of a liquid's face seal (design_rules.py): which of the design guide's four types of seal the
speed, pressure, runout and travel of a shaft allow; a radial seal against the guide's tables for lips and
circumferential seals, experience with oil, not mechanics; and of gas films whether they carry statically, and whether
they are choked.

**Source** Hayden & Keller, NASA CR-120997 (1974), tables 3.1 to 3.4 and 3.8, sections 2 and 3.  Of lips tables 3.1 and
3.2 are of pressure without eccentricity and of eccentricity without pressure: with both the lower of their speeds
stands here.  Of gases Zuk, NASA TM X-68022 (1972), whose figures are computed here of the scene's own film.
**Valid** of gases: aligned faces at the start of the scene, slow motion.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..dynamics.imposed_motion import rest_state
from ..dynamics.intervals import largest_value
from ..dynamics.model import Model
from ..quantities import in_words
from ..radial_seals.followers import followers_of
from ..scenario.reader import Scenario
from ..scene.application import RadialApplication
from ..scene.patterns import grooves_of
from ..scene.radial import RadialScene
from ..scene.scene import frozen_at_start
from .film_matrices import State, matrices
from .seal_figures import Finding, Rule, Seal, Verdict, limit_finding, note, other_seals, rows

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
    """A number and its limit."""
    unit = {"speed": "m/s", "pressure": "Pa"}.get(what, "m")
    return f"{in_words(unit, value)} beyond {in_words(unit, most)}"


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
    sentence = f"{in_words('m/s', speed)} with {in_words('m', total)} of offset and eccentricity"
    sentence += f"; experience allows {in_words('m/s', allowed)}"
    if total > eccentricities[0]:
        return limit_finding(f"{sentence}; the table ends at {in_words('m', eccentricities[0])}", speed, most=0.0)
    return limit_finding(sentence, speed, most=allowed)


def _lip_eccentricity(scene, limit) -> Finding:
    total = scene.shaft.eccentricity + scene.shaft.offset
    return limit_finding(
        f"{in_words('m', total)} of offset and eccentricity, below {in_words('m', limit)}", total, most=limit
    )


def _preload(what: str):
    """Rule of the radial preload (N/m) along the circumference, of `what` presses."""

    def judge(scene, limit) -> Finding:
        followers = followers_of(scene)
        load = followers.preload / followers.arc
        pressed, least, most = (in_words("force_per_length", value) for value in (load, *limit))
        sentence = f"{what} presses with {pressed}, usual are {least} to {most}"
        return limit_finding(sentence, load, *limit, beyond=Verdict.NOTE)

    return judge


def _lip_pressure(scene, limit) -> Finding:
    pressures, speeds = limit
    pressure, speed = scene.lip.pressure_difference, surface_speed(scene)
    allowed = float(np.interp(pressure, pressures, speeds))
    if pressure > pressures[-1]:
        sentence = f"{in_words('Pa', pressure)}; the table ends at {in_words('Pa', pressures[-1])}"
        return limit_finding(sentence, pressure, most=float(pressures[-1]), unit="Pa")
    sentence = f"{in_words('m/s', speed)} at {in_words('Pa', pressure)}; experience allows {in_words('m/s', allowed)}"
    return limit_finding(sentence, speed, most=allowed)


def _segment_speed(scene, limit) -> Finding:
    runouts, speeds = limit
    runout, speed = 2.0 * scene.shaft.eccentricity, surface_speed(scene)
    allowed = float(np.interp(runout, runouts, speeds))
    sentence = (
        f"{in_words('m/s', speed)} with {in_words('m', runout)} TIR; experience allows {in_words('m/s', allowed)}"
    )
    if runout > runouts[-1]:
        return limit_finding(
            sentence + f"; the table ends at {in_words('m', runouts[-1])}", runout, most=float(runouts[-1]), unit="m"
        )
    return limit_finding(sentence, speed, most=allowed)


def _segment_runout(scene, limit) -> Finding:
    runout, most = 2.0 * scene.shaft.eccentricity, limit * 2.0 * scene.shaft.radius
    sentence = f"{in_words('m', runout)} TIR, {limit:g} of the diameter are {in_words('m', most)}"
    return limit_finding(sentence, runout, most=most, beyond=Verdict.NOTE)


def _axial_load(scene, limit) -> Finding:
    load = scene.circumferential.axial_force / (2.0 * math.pi * scene.shaft.radius)
    pressed, least, most = (in_words("force_per_length", value) for value in (load, *limit))
    sentence = f"axial springs press with {pressed}, usual are about 70 N/m (here {least} to {most})"
    return limit_finding(sentence, load, *limit, beyond=Verdict.NOTE)


def _segment_pressure(scene, limit) -> Finding:
    pressure = scene.circumferential.pressure_difference
    return limit_finding(f"{in_words('Pa', pressure)}, below {in_words('Pa', limit)} (1 psi)", pressure, most=limit)


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
    "lip_load": Rule(_preload("the lip"), (87.5, 123.0), "N/m", "lip load of conventional lips", FOLLOW),
    "lip_pressure": Rule(_lip_pressure, (LIP_PRESSURE, LIP_PRESSURE_SPEED), "m/s", "table 3.1"),
    "lip_speed": Rule(_lip_speed, (LIP_ECCENTRICITY, LIP_SPEED), "m/s", "table 3.2", FOLLOW),
    "seal_type": Rule(_seal_type("conventional lip seal"), None, "m/s", TYPES),
}
RIBBED_LIP = {
    "lip_eccentricity": Rule(_lip_eccentricity, RIBBED_ECCENTRICITY, "m", "section 3.1.4", FOLLOW),
    "lip_load": Rule(_preload("the lip"), (52.5, 70.0), "N/m", "lip load of hydrodynamic lips", FOLLOW),
    "lip_pressure": Rule(_lip_pressure, (RIBBED_PRESSURE, RIBBED_SPEED), "m/s", "table 3.3"),
    "lip_speed": Rule(_other_lips("table 3.2 is of conventional lips"), None, "m/s", "table 3.2", FOLLOW),
    "seal_type": Rule(_seal_type("hydrodynamic lip seal"), None, "m/s", TYPES),
}
CIRCUMFERENTIAL = {
    "axial_load": Rule(_axial_load, (50.0, 90.0), "N/m", "axial load about 70 N/m", FOLLOW),
    "garter_load": Rule(
        _preload("the garter spring"), (17.5, 35.0), "N/m", "radial garter load 17.5 to 35 N/m", FOLLOW
    ),
    "hang_up": Rule(_hang_up, None, "N", "friction on the case flange", "sealdyn run FILE"),
    "seal_type": Rule(_seal_type("circumferential seal"), None, "m/s", TYPES),
    "segment_pressure": Rule(_segment_pressure, SEGMENT_PRESSURE, "Pa", "below 0.689 N/cm^2"),
    "segment_runout": Rule(_segment_runout, SEGMENT_SHARE, "m", "shaft runout below 0.0005 of the diameter", FOLLOW),
    "segment_speed": Rule(_segment_speed, (SEGMENT_RUNOUT, SEGMENT_SPEED), "m/s", "table 3.4", FOLLOW),
}


ZUK = "Zuk, NASA TM X-68022 (1972)"


def film_stiffness(seal: Seal, limit) -> Finding:
    """Fail unless the film presses the harder the thinner it is (N/m above `limit`): under a constant closing force it
    would shut or blow open."""
    if grooves_of(seal.model.scene)[1]:
        return other_seals("the faces have grooves: sealdyn study coefficients FILE")
    try:
        stiffness = float(matrices(Model(frozen_at_start(seal.model.scene)), State())[0][0, 0])
    except ValueError as error:
        return other_seals(str(error))
    inner, *_, outer = (gap for _, gap in sorted(seal.model.aligned_gaps()))
    leaving, entering = (inner, outer) if seal.model.closing.outer_is_high else (outer, inner)
    along = "narrows" if leaving < entering else "opens" if leaving > entering else "is even"
    sentence = f"axial stiffness {in_words('axial_stiffness', stiffness)} at {in_words('m', seal.model.clearance)}, "
    sentence += f"of a gap that {along} along the flow" + (
        "" if stiffness > limit else ": it holds no clearance by itself"
    )
    own = sum(ring.support.axial_stiffness for ring in (seal.scene.stator, seal.scene.rotor) if ring.support)
    beyond = Verdict.NOTE if stiffness + own > limit else Verdict.FAIL
    if beyond == Verdict.NOTE and stiffness <= limit:
        sentence += f", the supports' {in_words('axial_stiffness', own)} do"
    return limit_finding(sentence, stiffness, least=limit, beyond=beyond, supports=own)


def choking(seal: Seal, limit) -> Finding:
    """A note where the gas leaves the dam with the speed of sound: what the low pressure does no longer reaches the
    film, and the leakage follows the high one alone."""
    film, f = seal.model.observed
    if film.exit_mach is None:
        return other_seals(f"the {film.name} film is viscous, without inertia of the gas; gas_dam knows Mach numbers")
    state = rest_state(seal.model.scene, seal.model.clearance, seal.model.start)[0]
    mach = film.exit_mach(f, state)[1]
    sentence = f"the gas leaves at Mach {mach:.3g}, {'choked' if mach >= limit else 'not choked'}"
    return note(sentence, mach) if mach >= limit else limit_finding(sentence, mach, most=limit)


OF_GAS = {
    "choking": Rule(choking, 1.0, "1", "choked dams of tables 1 and 2", "sealdyn study pressure FILE", ZUK),
    "film_stiffness": Rule(
        film_stiffness, 0.0, "N/m", "a parallel dam is unstable below 0.55 mil, computed",
        "sealdyn study equilibrium FILE", ZUK,
    ),
}  # fmt: skip
