"""Design rules that a seal is judged by before it runs: a table, each with where it stands, its limit and the command
that tests it in the time domain or on the film.

**Source** Hayden & Keller, Design Guide for Helicopter Transmission Seals, NASA CR-120997 (1974): experience with oil
in gearboxes, good for a first judgement of other seals.  Limits are as printed, in SI.
"""

import math

import numpy as np

from ..dynamics.intervals import largest_value
from ..dynamics.model import Model
from ..numerics.piecewise_linear import initially, points
from ..quantities import in_words
from ..scenario.reader import Scenario
from ..scene.application import Application
from ..scene.fluid import viscosity_of
from ..scene.patterns import HIGHEST_ORDER
from .other_rules import BALANCE, OF_GAS, RUNOUT, SPEEDS, TRAVEL, Duty, seal_type_finding
from .seal_figures import (
    Finding,
    Rule,
    Seal,
    Verdict,
    followability,
    limit_finding,
    missing_keys,
    note,
    other_seals,
    resonances,
    rows,
)

CC_PER_H = 1e-6 / 3600
SPRINGS = {"wave_washer": "a wave washer takes", "coil": "coil springs take", "bellows": "bellows take"}
# Of the table's face width: how near counts as that width is not the guide's.
NEAR = 0.1
ANGLES = np.linspace(0.0, 2 * np.pi, 40 * HIGHEST_ORDER + 1)  # forty to a wave


def findings(scenario: Scenario, model: Model) -> list[dict]:
    """What every rule finds of a scenario and its `model`, one dict a rule: `rule`, `verdict` ("pass" | "fail" | "note"
    | "acknowledged" | "not applicable"), `value`, `unit`, `least` and `most` (SI, None where there are none), `guide`
    and `source` in it, `said` (a sentence), `command` that tests it ("" if none does), `reason` with which it is
    acknowledged (None without), and the rule's own numbers, `needs` among them: keys of which one is missing.
    Raises SceneError where the film has no solution."""
    application = scenario.application or Application()
    rules = RULES
    if scenario.scene.film.gas is not None:
        rules = {name: rule for name, rule in RULES.items() if name not in OF_OIL} | OF_GAS
    return rows(rules, Seal(scenario.scene, application, model), application.acknowledge)


# --- faces and film --------------------------------------------------------------------------------------


def _sliding_speed(seal: Seal, limit) -> Finding:
    """Pass up to 6096 m/min; more "is possible with proper cooling": a note."""
    speed = seal.sliding_speed
    sentence = (
        f"sliding speed {in_words('m/s', speed)} at the mean diameter, face seals go up to {in_words('m/s', limit)}"
    )
    if speed > limit:
        sentence += ": more is possible with proper cooling"
    return limit_finding(sentence, speed, most=limit, beyond=Verdict.NOTE)


def _seal_type(seal: Seal, limit) -> Finding:
    """Pass unless something goes beyond a face seal; which other types would do."""
    asked, diameter, runout = seal.application, seal.application.shaft_diameter, seal.application.shaft_runout
    offsets = [length for length in (runout and 0.5 * runout, asked.eccentricity) if length is not None]
    total = sum(offsets) if offsets else None
    duty = Duty(seal.sliding_speed, seal.sealed_pressure, runout, total, asked.axial_displacement, diameter)
    return seal_type_finding(duty, "face seal")


def _runout(seal: Seal, limit) -> Finding:
    """Pass up to the runout of its row; beyond the table's last speed no more than in its last row, and a note."""
    runout = seal.application.shaft_runout
    if runout is None:
        return missing_keys("application.shaft_runout")
    speed = 60 * seal.sliding_speed
    most = next((allowed for fastest, allowed in limit if speed <= fastest), None)
    sentence = f"shaft runout {in_words('m', runout)} TIR at {in_words('m/s', seal.sliding_speed)}"
    if most is not None:
        return limit_finding(f"{sentence}, {in_words('m', most)} allowed", runout, most=most)
    last, most = limit[-1]
    sentence += f", beyond the table, which ends with {in_words('m', most)} at {in_words('m/s', last / 60)}"
    if runout > most:
        return limit_finding(sentence, runout, most=most)
    return limit_finding(sentence, runout, most=0.0, beyond=Verdict.NOTE)


def _misalignment(seal: Seal, limit) -> Finding:
    """Pass up to 0.0005 rad, the largest of both rings' tilts and of the runout of the data sheet."""
    rotor, stator, diameter = seal.scene.rotor, seal.scene.stator, 2 * seal.scene.film.outer_radius
    key = "misalignment" if rotor.support else "runout"
    tilts = {f"rotor.{key}": largest_value(getattr(rotor, key)),
             "stator.misalignment": largest_value(stator.misalignment),
             "application.face_runout": (seal.application.face_runout or 0.0) / diameter}  # fmt: skip
    worst = max(tilts, key=tilts.get)
    if tilts[worst] == 0.0:
        return missing_keys(*tilts)
    sentence = f"{worst} tilts a face by {in_words('rad', tilts[worst])}, up to {in_words('rad', limit)} are usual"
    return limit_finding(sentence, tilts[worst], most=limit)


def _face_width(seal: Seal, limit) -> Finding:
    """Pass within a tenth of the table's width, linear between its bores; else a note, for it is a width to begin with
    and no limit.  Beyond the table a note."""
    bore, width = seal.application.bore, seal.face_width
    if bore is None:
        return missing_keys("application.bore")
    bores, widths = limit
    sentence = f"face {in_words('m', width)} wide at a bore of {in_words('m', bore)}"
    if not bores[0] <= bore <= bores[-1]:
        sentence += f", beyond the table ({in_words('m', bores[0])} to {in_words('m', bores[-1])})"
        return note(sentence, width, usual=None)
    usual = float(np.interp(bore, bores, widths))
    sentence += f"; {in_words('m', usual)} is usual"
    if width > (1 + NEAR) * usual:
        sentence += ": a wider face makes more heat"
    return limit_finding(sentence, width, (1 - NEAR) * usual, (1 + NEAR) * usual, beyond=Verdict.NOTE, usual=usual)


def _flatness(seal: Seal, limit) -> Finding:
    """Pass up to 0.88 um on either face, as it was made."""
    heights = {"stator": _height(seal.scene.stator), "rotor": _height(seal.scene.rotor)}
    worst = max(heights, key=heights.get)
    if heights[worst] == 0.0:
        return missing_keys("stator.waviness", "rotor.waviness")
    sentence = (
        f"the {worst}'s face is wavy by {in_words('m', heights[worst])}, faces are flat within {in_words('m', limit)}"
    )
    return limit_finding(sentence, heights[worst], most=limit)


def _height(ring) -> float:
    """From trough to crest (m)."""
    waves = (wave.amplitude * np.cos(wave.order * ANGLES + wave.phase) for wave in ring.waviness)
    return float(np.ptp(sum(waves, np.zeros_like(ANGLES))))


def _finish(seal: Seal, limit) -> Finding:
    """Pass up to 0.14 um, two faces of 0.1 um together; a note up to that of a hard face and a carbon nose.  The
    scene's roughness is an rms one; a guide that averages reads some tenths less."""
    if seal.scene.contact is None:
        return missing_keys("contact.roughness")
    roughness, (hard, nose) = seal.scene.contact.roughness, limit
    most, with_nose = math.sqrt(2) * hard, math.hypot(hard, nose)
    sentence = f"both faces are rough by {in_words('m', roughness)} together; two of {in_words('m', hard)} have "
    sentence += f"{in_words('m', most, 2)}, with a carbon nose up to {in_words('m', with_nose, 2)}"
    beyond = Verdict.NOTE if roughness <= with_nose else Verdict.FAIL
    return limit_finding(sentence, roughness, most=most, beyond=beyond)


def _film_thickness(seal: Seal, limit) -> Finding:
    """Pass from 1.25 to 2.5 um at the mean radius of the aligned faces; else a note: typical is no limit."""
    film = seal.film_thickness
    least, most = (in_words("m", value) for value in limit)
    sentence = f"film {in_words('m', film)} at the mean radius, typical are {least} to {most}"
    return limit_finding(sentence, film, *limit, beyond=Verdict.NOTE)


def _leakage(seal: Seal, limit) -> Finding:
    """Pass up to the goal, a note up to the limit of the data sheet (of a liquid 5 cc/h without one)."""
    film, own = seal.scene.film, seal.application.leakage_limit
    if initially(film.outer_pressure) == initially(film.inner_pressure):
        return missing_keys("film.outer_pressure", "film.inner_pressure")
    if math.isnan(seal.leakage):
        return other_seals("the film knows no leakage")
    if film.gas is not None and own is None:
        return other_seals("the guide's limit is that of a liquid; application.leakage_limit is this seal's own")
    goal, most = limit
    if own is not None:
        goal, most = min(goal, own) if film.gas is None else own, own
    leakage, whose = seal.leakage, "the guide's" if own is None else "this seal's"
    sentence = f"aligned faces leak {in_words('leakage', leakage)} at the start, {whose} limit is "
    sentence += in_words("leakage", most) + (f", the goal {in_words('leakage', goal)}" if goal < most else "")
    if leakage > most:
        return limit_finding(sentence, leakage, most=most)
    return limit_finding(sentence, leakage, most=goal, beyond=Verdict.NOTE)


def _lubricant_side(seal: Seal, limit) -> Finding:
    """Pass at the outer diameter, where it is thrown back into the seal; at the inner one the faces may starve: a
    note."""
    film = seal.scene.film
    rise = initially(film.outer_pressure) - initially(film.inner_pressure)
    if rise == 0.0:
        return missing_keys("film.outer_pressure", "film.inner_pressure")
    if rise > limit:
        sentence = "sealed at the outer diameter: the centrifugal force keeps the lubricant there"
    else:
        sentence = (
            "sealed at the inner diameter: the centrifugal force throws the lubricant through the film, it may starve"
        )
    return limit_finding(sentence, rise, least=limit, beyond=Verdict.NOTE)


def _heat(seal: Seal, limit) -> Finding:
    """Watts at the highest sliding speed, of the film at the start, and of faces that carry the closing force above the
    lower pressure: a note; fail if the film makes more than the faces do dry, and so spares them nothing.  What the
    asperities make besides is in the sentence."""
    speed, film = seal.sliding_speed, seal.film_thickness
    if film <= 0.0:
        # Rough faces may carry a cone that closes their mean planes.
        return other_seals(f"the mean film is {in_words('m', film)}: the asperities carry the faces")
    full = initially(viscosity_of(seal.model.scene.film)) * seal.face_area * speed**2 / film
    dry = [f * seal.face_load * speed for f in limit]
    rough = seal.asperity_heat
    sentence = f"heat {full:.4g} W of a full film of {in_words('m', film)}"
    sentence += f" and {rough:.4g} W of the asperities that touch," if rough > 0.0 else ""
    sentence += f" at {in_words('m/s', speed)}; faces that run dry would make {dry[0]:.4g} to {dry[1]:.4g} W"
    if full > dry[1] > 0.0:
        sentence += f": more than without it, {in_words('heat_flux', full / seal.face_area)} of face"
        return limit_finding(sentence, full, most=dry[1], dry=dry, asperities=rough)
    return note(sentence, full, dry=dry, asperities=rough)


def _pressure_velocity(seal: Seal, limit) -> Finding:
    """A note: closing force above the lower pressure, over the face, times the highest sliding speed."""
    pv = seal.face_load / seal.face_area * seal.sliding_speed
    sentence = (
        f"PV {in_words('Pa*m/s', pv)}, if the faces carried all of the closing force: to be held against the limit of "
        "their materials"
    )
    return note(sentence, pv)


# --- closing force and springs ---------------------------------------------------------------------------


def _face_pressure(seal: Seal, limit) -> Finding:
    """Pass from 6.89 to 20.7 N/cm^2, spring force over the whole face."""
    if seal.spring_force is None:
        return missing_keys("closing.spring_force")
    (least, most), pressure = limit, seal.spring_force / seal.face_area
    sentence = f"the spring presses the faces with {in_words('Pa', pressure)}"
    sentence += f", usual are {in_words('Pa', least)} to {in_words('Pa', most)}"
    return limit_finding(sentence, pressure, least, most)


def _balance(seal: Seal, limit) -> Finding:
    """Pass up to 68.9 N/cm^2 with a balance (closing area over face area) of 1 or more, 689 N/cm^2 below."""
    pressure, balance = seal.sealed_pressure, seal.model.closing.balance_ratio
    if pressure == 0.0:
        return missing_keys("film.outer_pressure", "film.inner_pressure", "application.highest_pressure")
    most, kind = (limit[0], "unbalanced") if balance >= 1.0 else (limit[1], "balanced")
    why = "" if seal.scene.closing.balance_ratio is not None else ", as the clearance asks for"
    sentence = (
        f"{in_words('Pa', pressure)} sealed by a seal of balance {balance:.4g}{why}; {kind} seals take up to "
        f"{in_words('Pa', most)}"
    )
    return limit_finding(sentence, pressure, most=most, balance=balance)


def _hang_up(seal: Seal, limit) -> Finding:
    """Pass if the spring beats what the ring needs to follow the rotor; a note where one side of the face opens."""
    scene = seal.scene
    if scene.rotor.support or not scene.stator.support:
        return other_seals("the rotor floats, which carries its axial runout itself")
    if not (scene.rotor.axial_runout or any(points(scene.rotor.runout))):
        return missing_keys("rotor.axial_runout", "rotor.runout")
    if scene.closing.spring_force is None:
        return missing_keys("closing.spring_force")
    balance = followability(seal.model)
    sentence = balance.pop("sentence")
    if balance["needed"] < balance["available"] <= balance["sure"]:
        return note(sentence, balance["available"], **balance)
    # To be equal is not enough.
    least = math.nextafter(balance["needed"], math.inf)
    return limit_finding(sentence, balance["available"], least=least, **balance)


def _axial_travel(seal: Seal, limit) -> Finding:
    """Pass up to 0.76 mm with a wave washer, 1.27 mm with coil springs or bellows; without a kind of spring what all of
    them take passes and what none of them does fails."""
    travel, kind = seal.application.axial_displacement, seal.application.spring
    if travel is None:
        return missing_keys("application.axial_displacement")
    sentence = f"axial travel {in_words('m', travel)}"
    least_of_all, most_of_all = min(limit.values()), max(limit.values())
    if kind is None and least_of_all < travel <= most_of_all:
        return missing_keys("application.spring")
    if kind is None:
        most, words = least_of_all if travel <= least_of_all else most_of_all, "springs take"
    else:
        most, words = limit[kind], SPRINGS[kind]
    sentence += f", {words} up to {in_words('m', most)}"
    if travel > most_of_all:
        sentence += ": beyond it a seal that rides on the shaft"
    return limit_finding(sentence, travel, most=most)


def _shaft_resonance(seal: Seal, limit) -> Finding:
    """Fail if a ring on its springs has a resonance at a speed of the shaft, of the scene or in service, or at one of
    the stator's carrier, where that turns."""
    bands = [tuple(speed / (2 * math.pi) for speed in seal.shaft_speeds)]
    if bands[0][1] == 0.0:
        return missing_keys("shaft.speed", "application.highest_speed")
    turning = [abs(speed) / (2 * math.pi) for speed in points(seal.scene.stator.speed)]
    if any(turning):
        bands.append((min(turning), max(turning)))
        return resonances(seal.scene, bands, "rotation of the shaft or of the stator's carrier")
    return resonances(seal.scene, bands, "the shaft")


def _gear_resonance(seal: Seal, limit) -> Finding:
    """Fail if a ring on its springs has a resonance at a gear mesh frequency, at a tone of the housing or in a band of
    its random vibration or of a sweep."""
    housing = seal.scene.housing
    tones = [tone.frequency for tone in (*housing.axial, *housing.angular)]
    tones += seal.application.gear_mesh_frequency or ()
    bands = [(tone, tone) for tone in tones]
    bands += [(r.frequency[0], r.frequency[-1]) for r in (*housing.axial_random, *housing.angular_random)]
    bands += [(min(sweep.frequency), max(sweep.frequency)) for sweep in housing.sweeps]
    if not bands:
        return missing_keys("application.gear_mesh_frequency", "housing.axial")
    return resonances(seal.scene, bands, "what surrounds it")


# --- temperature and life --------------------------------------------------------------------------------


def _seal_temperature(seal: Seal, limit) -> Finding:
    """Pass up to the material's temperature (table 3.7)."""
    material, temperature = seal.application.secondary_seal_material, seal.o_ring_temperature
    if material is None:
        return missing_keys("application.secondary_seal_material")
    if material not in limit:
        return other_seals(f"the rule knows {', '.join(limit)}")
    if temperature is None:
        return missing_keys("application.highest_temperature")
    sentence = f"{temperature:.4g} K at a secondary seal of {material}, good to {limit[material]:g} K"
    return limit_finding(sentence, temperature, most=limit[material])


def _coking(seal: Seal, limit) -> Finding:
    """Pass up to 505 K."""
    temperature = seal.face_temperature
    if temperature is None:
        return missing_keys("application.highest_temperature")
    return limit_finding(f"{temperature:.4g} K, lubricants coke near {limit:g} K", temperature, most=limit)


def _life(seal: Seal, limit) -> Finding:
    """Pass up to 1500 h, what seals were asked for; more is a note."""
    life = seal.application.life
    if life is None:
        return missing_keys("application.life")
    sentence = f"asked for {in_words('time', life)} between overhauls, seals of the guide for {in_words('time', limit)}"
    return limit_finding(sentence, life, most=limit, beyond=Verdict.NOTE)


RUN, LOAD_SUPPORT, WEAR = "sealdyn run FILE", "sealdyn study load-support FILE", "sealdyn study wear FILE"
EQUILIBRIUM = "sealdyn study equilibrium FILE"
RULES = {
    "axial_travel": Rule(_axial_travel, TRAVEL, "m", "axial displacement"),
    # Sealed pressure with a closing area not less than the face, and with less.
    "balance": Rule(
        _balance, BALANCE, "Pa",
        "100 psi unbalanced; the guide prints the balance, a pure number, once in N/m^2", EQUILIBRIUM,
    ),
    "coking": Rule(_coking, 505.0, "K", "lubricants coke near 505 K"),
    "face_pressure": Rule(
        _face_pressure, (6.89e4, 20.7e4), "Pa",
        "10 to 30 psi; section 2.2.4.3 prints 5.89 to 26.5 N/cm^2 for it, a misprint", EQUILIBRIUM,
    ),
    # Bores and widths.
    "face_width": Rule(
        _face_width, ((25.4e-3, 50.8e-3, 76.2e-3, 101.6e-3), (1.58e-3, 1.58e-3, 1.98e-3, 2.39e-3)), "m", "table 2.7",
        LOAD_SUPPORT,
    ),
    "film_thickness": Rule(_film_thickness, (1.25e-6, 2.5e-6), "m", "typical film", RUN),
    # Of each face.
    "finish": Rule(_finish, (0.1e-6, 0.508e-6), "m", "about 0.1 um, carbon nose to 0.508 (3.2.1.4)", LOAD_SUPPORT),
    "flatness": Rule(_flatness, 0.88e-6, "m", "three helium light bands", LOAD_SUPPORT),
    "gear_resonance": Rule(
        _gear_resonance, None, "Hz", "gear mesh up to 5400 Hz, 45 g", "sealdyn study vibration FILE"
    ),
    "hang_up": Rule(_hang_up, None, "N", "spring load against friction and inertia", RUN),
    # Friction coefficients of dry faces.
    "heat": Rule(
        _heat, (0.1, 0.25), "W", "full film mu A (w D/2)^2/h, dry pi f F D N, carbon-graphite f 0.1 to 0.25", RUN
    ),
    # Goal and limit.
    "leakage": Rule(_leakage, (1 * CC_PER_H, 5 * CC_PER_H), "m^3/s", "limit 5 cc/h, goal 1 cc/h", RUN),
    "life": Rule(_life, 1500 * 3600.0, "s", "1500 h between overhauls", WEAR),
    "lubricant_side": Rule(
        _lubricant_side, 0.0, "Pa", "lubricant on the outer diameter", "sealdyn run FILE --set film.inertia=true"
    ),
    "misalignment": Rule(
        _misalignment, 0.0005, "rad", '0.0005 in/in of diameter; the metric twin ".0127 m/mm" is a misprint',
        "sealdyn study contact-onset FILE",
    ),
    "pressure_velocity": Rule(
        _pressure_velocity, None, "Pa m/s", "no limit of materials is taken from the guide", WEAR
    ),
    "runout": Rule(_runout, RUNOUT, "m", "table 3.8"),
    "seal_temperature": Rule(
        _seal_temperature, {"nitrile": 380.0, "silicone": 450.0, "fluoroelastomer": 477.0}, "K", "table 3.7"
    ),
    "seal_type": Rule(_seal_type, None, "m/s", "tables 3.1 to 3.4 and 3.8"),
    "shaft_resonance": Rule(_shaft_resonance, None, "Hz", "rotation 3 to 350 Hz", "sealdyn study campbell FILE"),
    "sliding_speed": Rule(_sliding_speed, SPEEDS["face seal"], "m/s", "20 000 ft/min"),
}  # fmt: skip
# In a gearbox: what is asked of a gas film in their place stands in other_rules.py.
OF_OIL = ("coking", "film_thickness", "lubricant_side", "seal_type")
