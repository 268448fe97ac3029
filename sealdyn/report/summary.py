"""The summary of a run as an answer: labels and numbers that a seal engineer reads first, the rest as details.

The terminal prints the lines without `detail`, at most fifteen; `--verbose`, the review page and the archive's own
figure have all of them.
"""

import math
from collections.abc import Iterator

from ..answers import Answer, Line
from ..quantities import everyday, in_words
from ..status import Status

# Share by which a mean and its end differ where a run came from elsewhere.
ELSEWHERE = 0.02
# Rise (K) beyond which a leakage cannot carry the heat, whatever the liquid: it would boil, or be no lubricant.
CARRIED = 100.0
ZERO_CELSIUS = 273.15
# How a number below what the accuracy resolves begins.
BELOW = "below "


def is_radial(info: dict) -> bool:
    """Whether an archive is that of a radial seal, by its resolved scene."""
    return any((info.get("resolved") or {}).get(table) for table in ("lip", "circumferential"))


def run_answer(summary: dict) -> Answer:
    """The answer of a run of a face or a radial seal."""
    lines = list(_radial_lines(summary) if "follower" in summary else _face_lines(summary))
    files = ", ".join(filter(None, (summary["archive"], summary.get("figure"))))
    lines.append(Line("files", [(files, None, "")]))
    message = summary["message"] if summary["status"] != Status.OK else ""
    return Answer(summary, message, notes=summary["warnings"], lines=lines)


def tilt_resolved(summary: dict) -> float:
    """Relative misalignment (rad) below which a run's accuracy tells nothing; 0 of a run without a thinnest film."""
    clearance, radius = (
        (summary.get(part) or {}).get(key) for part, key in (("film", "clearance"), ("h_min", "radius"))
    )
    return summary.get("accuracy", 0.0) * clearance / radius if clearance and radius else 0.0


def is_below(value: float | None, near: float) -> bool:
    """Whether a number that is not zero is one that the accuracy does not resolve."""
    return value is not None and 0.0 < abs(value) < near


def _another(end: float | None, mean: float | None) -> bool:
    """Whether the aligned seal at the end has another number than the run's mean."""
    return end is not None and mean is not None and abs(end - mean) > ELSEWHERE * max(abs(end), abs(mean))


# --- face seals ------------------------------------------------------------------------------------------


def _face_lines(summary) -> Iterator[Line]:
    model, film, closing, contact = (summary[k] for k in ("model", "film", "closing", "contact"))
    counts, leak, friction = summary["counts"], summary["leakage"], summary["friction"]
    yield Line(
        "model", [(f"{model['film']} film, unknowns {', '.join(model['unknowns'])}, {model['solver']}", None, "")]
    )
    yield from _computation(model, counts, summary["wall_time"])
    speed = summary.get("speed")
    if speed and speed["start"] != speed["end"]:
        yield Line("speed", [("from", speed["start"], "speed"), ("to", speed["end"], "speed")])
    yield from _film_lines(summary)
    if summary["contact_margin"] is not None:
        yield _margin(summary, contact)
    flow = leak["mean_kg_per_h"]
    where = " at 0 degC and 1.01325 bar" if leak["conditions"] else ""
    yield Line("leakage", [("mean", leak["mean"], "leakage"), (where.strip(), None, ""),
                           ("", flow and flow / everyday("mass_flow")[1], "mass_flow")])  # fmt: skip
    if _another(film.get("leakage"), leak["mean"]):
        yield Line("", [("aligned, at the end", film["leakage"], "leakage")], detail=True)
    if film.get("exit_mach") is not None:
        choked = "choked" if film["exit_mach"] >= 1.0 else "not choked"
        yield Line("", [("Mach number where the gas leaves", film["exit_mach"], "1"), (choked, None, "")])
    heat = summary.get("heat")
    if heat is None:
        yield _friction(friction, closing["face_area"])
    else:
        yield Line("friction", [("", friction["power"], "power"), ("torque", friction["torque"], "torque")])
        yield from _heat_lines(heat)
    if _another(film.get("friction_power"), friction["power"]):
        yield Line("", [("aligned, at the end", film["friction_power"], "power")], detail=True)
    yield Line("film", [("clearance", film["clearance"], "clearance"),
                        ("axial stiffness", film["axial_stiffness"], "axial_stiffness"),
                        ("tilt stiffness", film["tilt_stiffness"], "tilt_stiffness"),
                        ("tilt damping", film["tilt_damping"], "tilt_damping"),
                        ("asperities included" if contact else "", None, "")], detail=True)  # fmt: skip
    yield Line("closing", [("", closing["force"], "force"), ("balance ratio", closing["balance_ratio"], "1"),
                           ("spring", closing["spring_force"], "force"), ("duty", closing["duty"], "pressure")],
               detail=True)  # fmt: skip
    if contact:
        yield from _contact_lines(contact, summary["end"]["time"])
    if summary["secondary_seal"]:
        yield from _seal_lines(summary["secondary_seal"])
    if film["max_cavitated_fraction"]:
        how = "its liquid is kept" if model["film"] == "reynolds" else "floored after solving: mass is not conserved"
        yield Line("cavitation", [("up to", film["max_cavitated_fraction"], "cavitated_fraction"), (how, None, "")])
    yield from _stability_lines(summary["stability"])
    yield from _audit_lines(summary)


def _computation(model, counts, seconds) -> Iterator[Line]:
    parts = [("steps", counts["steps"], "1"), ("evaluations", counts["rhs"], "1"), ("", seconds, "s")]
    yield Line("", parts, detail=True)
    yield from (Line("", [(reason, None, "")], detail=True) for reason in model["reasons"])
    if model.get("unused"):
        yield Line("not used", [(", ".join(model["unused"]), None, "")])


def _audit_lines(summary) -> Iterator[Line]:
    if summary["energy_residual"] is not None:
        yield Line("energy audit", [("residual of the work exchanged", summary["energy_residual"], "1")], detail=True)
    # What is not as exact as asked stands among the warnings, in the same words.
    if summary.get("certificate") and summary["certificate"]["met"] is not False:
        yield Line("accuracy", [(summary["certificate"]["said"], None, "")])


def _film_lines(summary) -> Iterator[Line]:
    """Thinnest film and relative misalignment: settled, and of the whole run where that is another."""
    low, tilt, form = (summary[k] for k in ("h_min", "relative_misalignment", "closed_form"))
    near, settled = tilt_resolved(summary), tilt["steady_max"] is not None
    if not settled:
        yield Line("steady state", [(tilt["steady_said"], None, "")])
    films, tilts, same = [], [], settled and _settled_throughout(summary)
    if settled and low["steady"] is not None:
        share = low["steady"] / low["value"] * low["of_clearance"]
        films = [("settled", low["steady"], "h_min"), ("of the clearance", share, "share")]
    if low["value"] is not None and not same:
        films += [("whole run", low["value"], "h_min"), ("at", low["time"], "time")]
    if films:
        yield Line("h_min", films)
    if low["value"] is not None:
        yield Line("", [("whole run", low["of_clearance"], "share"), ("of the clearance at", low["time"], "time"),
                        ("theta", low["theta"], "angle"), ("r", low["radius"], "radius")], detail=True)  # fmt: skip
    if settled:
        # Two digits beyond what is accurate, to compare.
        digits = min(max(2 + math.floor(math.log10(max(tilt["steady_max"], near) / near)), 3), 6) if near else 4
        tilts = [("settled", *_resolved(tilt[name], near, digits)) for name in ("steady_min", "steady_max")]
        tilts[1] = ("to", *tilts[1][1:])
        if "relative_max" in form:
            tilts += [
                ("closed form", form["relative_min"], "misalignment"),
                ("to", form["relative_max"], "misalignment"),
            ]
    if tilt["max"] is not None and not same:
        tilts.append(("largest of the run", *_resolved(tilt["max"], near, 4)))
    if tilts:
        yield Line("misalignment", tilts)
    if settled and "relative_max" in form:
        friction = ", without the O-ring's friction" if summary["secondary_seal"] else ""
        yield Line("", [(f"closed form: {form['road']}{friction}", None, "")], detail=True)
    if tilt["mean"] is not None:
        yield Line("", [("mean of the run", *_resolved(tilt["mean"], near, 4))], detail=True)


def _resolved(value, near: float, digits: int):
    """Value and quantity, or words in place of one that the accuracy does not resolve."""
    if is_below(value, near):
        return BELOW + in_words("misalignment", near, 3), None
    return value, "misalignment", digits


def _settled_throughout(summary) -> bool:
    """Whether film and misalignment are nowhere further out than where settled, by what is accurate."""
    low, tilt, clearance = summary["h_min"], summary["relative_misalignment"], summary["film"]["clearance"]
    if low["steady"] is None:
        return False
    near = summary["accuracy"] * clearance
    pairs = ((low["value"], low["steady"], near), (tilt["max"], tilt["steady_max"], near / low["radius"]))
    return all(f"{a:.4g}" == f"{b:.4g}" or abs(a - b) <= apart for a, b, apart in pairs)


# What ends the margin where it is no touch.
MARGIN_ENDS = {
    "small tilts": "not limited by touch within small tilts, which are over at",
    "laminar film": "not limited by touch while the film is laminar, which is over at",
    "slow gas": "not limited by touch while the gas is slow, which is over at",
}


def _margin(summary, contact) -> Line:
    """By how much the forcing may grow, of linear theory."""
    margin = summary["contact_margin"]
    if margin == 0.0:
        return Line("margin", [("the asperities touch without any forcing", None, "")])
    if ended := MARGIN_ENDS.get(summary.get("contact_margin_limit")):
        over = (ended, margin, "1")
        return Line("margin", [over, ("times this forcing (linear theory)", None, "")])
    words = "times this forcing touches (linear theory)"
    also = "the faces touched in this run" if contact and contact["touches"] and margin >= 1.0 else ""
    return Line("margin", [("", margin, "1"), (words, None, ""), (also, None, "")])


def _friction(friction, area) -> Line:
    """Power and torque, and what the heat does on faces of an `area` (m^2)."""
    parts = [("", friction["power"], "power"), ("torque", friction["torque"], "torque")]
    rise = friction["temperature_rise"]
    if rise is not None and rise <= CARRIED:
        return Line("friction", [*parts, ("would heat the leakage by", rise, "temperature")])
    if area and friction["power"] is not None:
        parts.append(("of face", friction["power"] / area, "heat_flux"))
    more = f"more than the leakage can carry (over {CARRIED:.0f} K)" if rise is not None else ""
    return Line("friction", [*parts, (more, None, "")])


def _heat_lines(heat) -> Iterator[Line]:
    """The warm state: temperature and coning, and as details what the faces were before and where the heat goes."""
    coned, cold = heat["coning_by_heat"], heat["cold"]
    faces = heat["face_temperature"] - ZERO_CELSIUS
    end = heat.get("end")
    then = [("in the end", end["rise"], "temperature"), ("coning", end["coning_by_heat"], "tilt")] if end else []
    yield Line("heat", [("faces", faces, "degC"), ("by heat", heat["rise"], "temperature"),
                        ("coning", heat["coning"], "tilt"), ("of it by heat", coned, "tilt"), *then])  # fmt: skip
    if cold["clearance"] is not None:
        before = ("unheated: clearance", cold["clearance"], "clearance")
        yield Line("", [before, ("leakage", cold["leakage"], "leakage"), ("friction", cold["power"], "power")])
    if (ends := heat["interval"]) is not None and None not in ends["rise"]:
        parts = [
            ("half and twice the convection", ends["rise"][0], "temperature"),
            ("and", ends["rise"][1], "temperature"),
        ]
        parts += [("coning", ends["coning"][0], "tilt"), ("and", ends["coning"][1], "tilt")]
        yield Line("", parts, detail=True)
    taken = [(f"to the {name}", share, "share") for name, share in heat["shares"].items()]
    more = [("viscosity", heat["viscosity"], "viscosity"), ("loop gain", heat["loop_gain"], "1")]
    yield Line("", [*taken, *more], detail=True)


def _contact_lines(contact, end: float) -> Iterator[Line]:
    """What the faces did where they touched, in a run up to `end` (s)."""
    grazing = [("grazing, undecided", contact["grazing"], "1")] if contact["grazing"] else []
    if not contact["touches"]:
        yield Line("touch", [("never; asperities meet at", contact["touch_at"], "clearance"), *grazing])
        return
    if contact["first"] == 0.0 and contact["longest"] >= end:
        when = [("in contact all the time", None, "")]
    else:
        when = [("contacts", contact["touches"], "1"), ("first at", contact["first"], "time"),
                ("longest", contact["longest"], "time")]  # fmt: skip
    yield Line("touch", [*when, ("deepest", contact["depth"], "depth"),
                         ("of the closing force", contact["share_of_closing"], "share"), *grazing])  # fmt: skip
    yield Line("", [("of what the closing force is above the lower pressure", contact["share_of_load"], "share"),
                    ("impulse", contact["impulse"], "N s"), ("force up to", contact["force"]["max"], "force"),
                    ("pressure up to", contact["max_pressure"], "contact_pressure"),
                    ("real area up to", contact["max_area_fraction"], "share")], detail=True)  # fmt: skip
    if contact["wears"]:
        yield Line("wear", [("", contact["wear_rate"], "wear_rate")])


def _seal_lines(seals) -> Iterator[Line]:
    for name, seal in seals["rings"].items():
        yield Line("o-ring", [(f"{name}, {seal['law']}", None, ""),
                              ("breaks away at", seal["breakaway_force"], "force"),
                              ("or", seal["breakaway_moment"], "moment")])  # fmt: skip
        if "gives" in seal:
            yield Line("", [("gives before it slides", seal["axial_stiffness"], "axial_stiffness"),
                            ("the first of it", seal["gives"], "travel")])  # fmt: skip
    if seals["sticks"] is not None:
        held = ", ".join(seals["stuck_at_end"])
        times = ("times", None, "")
        yield Line("", [("stuck", seals["sticks"], "1"), times, ("slipped", seals["slips"], "1"), times,
                        (f"stuck at the end: {held}" if held else "sliding at the end", None, "")])  # fmt: skip


def _stability_lines(stability) -> Iterator[Line]:
    """Verdict, whirl ratio and critical speed; resonances and the rest as details."""
    verdict, critical = stability["verdict"], stability["critical_speed"]
    if verdict is None:
        yield Line("stability", [("not found", None, "")])
        return
    fastest = stability["fastest"] or math.inf
    parts = [(f"{verdict} at", stability["speed"], "speed")]
    if stability["whirl_ratio"] is not None:
        parts.append(("whirl ratio", stability["whirl_ratio"], "1"))
    if critical and critical <= fastest:
        parts.append(("critical speed", critical, "speed"))
        tilts = [mode["re"] for mode in stability["modes"] if mode["kind"] == "tilt"]
        if tilts and verdict != "neutral":
            # The tilts' growth at this speed says it of the others: each threshold turns it round.
            turned = sum(w < abs(stability["speed"]) for w in stability["thresholds"] or [critical]) % 2
            below = (max(tilts) < 0.0) != bool(turned)
            parts.append((f"stable {'below' if below else 'above'} it", None, ""))
    elif critical:
        parts.append(("no critical speed up to", fastest, "speed"))
    else:
        looked = stability["thresholds"] is not None
        unlooked = "critical speed not looked for (study campbell)"
        parts.append(("no critical speed" if looked else unlooked, None, ""))
    yield Line("stability", parts)
    if verdict == "neutral" and stability.get("growth_rate_uncertainty") is not None:
        yield Line("", [("growth rate", stability["growth_rate"], "growth_rate"),
                        ("known to +-", stability["growth_rate_uncertainty"], "growth_rate")])  # fmt: skip
    again = [w for w in (stability["thresholds"] or [])[1:] if w <= fastest]
    met = [w for w in stability["resonance_speeds"] or () if w <= fastest]
    for words, speeds in (("damping changes again at", again), ("resonance of a tilt at", met)):
        if speeds:
            yield Line(
                "", [(words if k == 0 else "", w, "speed") for k, w in enumerate(speeds)], detail=words[0] == "d"
            )
    if stability.get("stator_speed"):
        yield Line("", [("the stator keeps its own speed", stability["stator_speed"], "speed")], detail=True)
    if stability.get("speeds_held"):
        low, high = stability["speeds_held"]
        yield Line("", [("a film holds the closing force from", low, "speed"), ("to", high, "speed")], detail=True)


# --- radial seals ----------------------------------------------------------------------------------------


def _radial_lines(summary) -> Iterator[Line]:
    model, one, form = summary["model"], summary["follower"], summary["closed_form"]
    kind, arc = "sectors of a lip" if summary["seal"] == "lip" else "segments", one["arc"]
    yield Line("model", [(f"{model['followers']} {kind}, {model['solver']}", None, "")])
    yield from _computation(model, summary["counts"], summary["wall_time"])
    yield Line("follower", [("preload", one["preload"] / arc, "force_per_length"),
                            ("stiffness", one["stiffness"] / arc, "N/m^2"),
                            ("mass", one["mass"] / arc, "kg/m"), ("flange friction", one["friction"], "force")],
               detail=True)  # fmt: skip
    yield from _riding_lines(summary["whole"], summary["settled"], summary["contact"])
    margin = form["margin"]
    there = ("there is", margin, "1") if margin is not None else ("nothing swings", None, "")
    needed = ("rides everywhere with a preload of", form["needed_preload"] / arc, "force_per_length")
    times = ("times that" if margin is not None else "", None, "")
    yield Line("closed form", [needed, ("at", form["speed"], "speed"), there, times])
    largest = form["largest_eccentricity"]
    any_of_them = [("any eccentricity is followed", None, "")]
    yield Line("", any_of_them if largest is None else [("eccentricity followed up to", largest, "m")], detail=True)
    if form["hangs_up"]:
        yield Line("", [("the flange's friction is as large as the preload: hang-up", None, "")])
    yield from _audit_lines(summary)


def _riding_lines(whole, settled, contact) -> Iterator[Line]:
    """Contact, gap, load and leakage: what has settled, or of a run that ended before that the whole of it."""
    part, of = (whole, "whole run") if settled["load"] is None else (settled, "settled")
    if part is whole:
        yield Line("steady state", [("nothing has settled: the run ended in its first half", None, "")])
    if part["load"] is not None:
        yield Line("contact", [(f"{of}, of the time on the shaft", part["contact_share"], "share"),
                               ("the worst follower", part["least_contact_share"], "share"),
                               ("held by the flange", part["held_share"], "share")])  # fmt: skip
    if contact["lift"]:
        yield Line("", [("whole run: left the shaft, times", contact["lift"], "1"),
                        ("first at", contact["first_lift"], "time"),
                        ("landed, times", contact["land"], "1"),
                        ("energy lost", contact["energy_lost"], "J")])  # fmt: skip
    if whole["largest_gap"]:
        yield Line("largest gap", [("whole run", whole["largest_gap"], "largest_gap"),
                                   ("at", whole["largest_gap_time"], "time"),
                                   ("theta", whole["largest_gap_angle"], "angle")])  # fmt: skip
    if part["load"] is None:
        return
    if whole["least_load"] is not None:
        yield Line("load", [(f"{of}, in all", part["load"], "force"), *_of_a_follower(part),
                            ("friction torque", part["friction_torque"], "torque")])  # fmt: skip
        if _of_a_follower(whole) != _of_a_follower(part):
            yield Line("", [("whole run", None, ""), *_of_a_follower(whole)], detail=True)
    yield Line("leakage", [(f"{of}, estimate of laminar flow through the gaps", part["leakage_estimate"], "leakage")])


def _of_a_follower(part) -> list:
    """The least and the largest load of one."""
    if part["least_load"] is None:
        return [("none rides", None, "")]
    return [("of a follower", part["least_load"], "force"), ("to", part["largest_load"], "force")]
