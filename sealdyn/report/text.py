"""Words for people: the summary of a run, a resolved scene, the answer of a study, what an archive holds."""

import math
import re

from ..status import Status
from ..toml_line import toml_line
from .radial import radial_rows
from .tables import table_lines

MICRO, MILLI, DEGREES = 1e6, 1e3, 180 / math.pi


def lines(scenario, summary: dict) -> list[str]:
    """About a dozen lines: what a seal engineer reads first."""
    message = "" if summary["status"] == Status.OK else summary["message"]
    speeds = speed_unit({"scenario": scenario.text, "overrides": scenario.overrides})
    return _table(scenario.name, summary["status"], message, rows_of(summary, speeds))


def rows_of(summary: dict, speeds=("rad/s", 1.0)):
    """(name, words) of every line of a run, of a face or a radial seal, `speeds` in the unit of `speed_unit`; a line
    that goes on has no name."""
    return radial_rows(summary) if "follower" in summary else run_rows(summary, speeds)


def question_of(comment: str) -> str:
    """What a scenario asks: its comment up to the question mark, or without one its first sentence."""
    if "?" in comment:
        return comment[: comment.index("?") + 1]
    return comment.split(". ")[0]


# A key of a speed, and rpm in its value or its table of times and values.
RPM = re.compile(r"^[^#\n]*speed\s*=[^#\n]*\brpm\b", re.MULTILINE)


def speed_unit(info: dict) -> tuple[str, float]:
    """What the speeds of a run or study are read in, "rpm" where its scenario or command line has them so, else
    "rad/s", and how many of it make one rad/s."""
    written = [info.get("scenario") or "", *map(str, info.get("overrides") or [])]
    return ("rpm", 30 / math.pi) if any(map(RPM.search, written)) else ("rad/s", 1.0)


def _table(title, status, message, rows) -> list[str]:
    ended = f"{title}: {status}" + (f" - {message}" if message else "")
    return [ended, *(f"  {name:<14}{words}" for name, words in rows)]


def run_rows(summary, speeds):
    """(name, words) of every line, as `rows_of`."""
    model, film, closing = (summary[k] for k in ("model", "film", "closing"))
    yield "model", (f"{model['film']} film, unknowns {', '.join(model['unknowns'])}; {model['solver']}, "
                    f"{summary['counts']['steps']} steps, {summary['counts']['rhs']} evaluations, "
                    f"{summary['wall_time']:.2g} s")  # fmt: skip
    yield from (("", reason) for reason in model["reasons"])
    if model["unused"]:
        yield "not used", ", ".join(model["unused"])
    leak, friction = summary["leakage"], summary["friction"]
    yield from _settled_rows(summary)
    yield from _whole_run_rows(summary)
    yield from _margin_rows(summary)
    factor, unit = (6e4, "l/min") if leak["conditions"] else (3.6e9, "ml/h")
    volume = f"{_n(leak['mean'], factor)} {unit}" + (" at 0 degC and 1.01325 bar" if leak["conditions"] else "")
    yield "leakage", f"{_n(leak['mean'])} m^3/s = {volume} = {_n(leak['mean_kg_per_h'])} kg/h (mean of the run)"
    if _another(film.get("leakage"), leak["mean"]):
        yield "", f"aligned, at the end of the run: {_n(film['leakage'], factor)} {unit}"
    # Archives of earlier versions do not hold it.
    if film.get("exit_mach") is not None:
        how = "choked" if film["exit_mach"] >= 1.0 else "not choked"
        yield "", f"aligned, the gas leaves the faces at a Mach number of {_n(film['exit_mach'])}: {how}"
    yield "friction", _friction(friction, closing.get("face_area"))
    if _another(film.get("friction_power"), friction["power"]):
        yield "", f"aligned, at the end of the run: {_n(film['friction_power'])} W"
    rough = ", asperities included" if summary["contact"] else ""
    yield "film", (f"clearance {_n(film['clearance'], MICRO)} um, tilt stiffness {_n(film['tilt_stiffness'])} N m/rad, "
                   f"tilt damping {_n(film['tilt_damping'])} N m s/rad, axial stiffness "
                   f"{_n(film['axial_stiffness'])} N/m{rough}")  # fmt: skip
    yield "closing", (f"{_n(closing['force'])} N (balance ratio {_n(closing['balance_ratio'])}, spring "
                      f"{_n(closing['spring_force'])} N, duty {_n(closing['duty'], 1e-5)} bar)")  # fmt: skip
    if summary["contact"]:
        yield from _contact_rows(summary["contact"], summary["end"]["time"])
    if summary["secondary_seal"]:
        yield from _seal_rows(summary["secondary_seal"])
    if film["max_cavitated_fraction"]:
        floored = summary["model"]["film"] != "reynolds"
        how = "floored after solving: does not conserve mass" if floored else "its liquid is kept"
        yield (
            "cavitation",
            f"up to {_n(film['max_cavitated_fraction'], 100)} % of the face at the floor pressure ({how})",
        )
    yield "stability", _stability(summary["stability"], *speeds)
    if summary["energy_residual"] is not None:
        yield "energy audit", f"residual {summary['energy_residual']:.1e} of the work exchanged"
    if summary.get("certificate"):
        yield "accuracy", summary["certificate"]["said"]
    yield from (("WARNING", warning) for warning in summary["warnings"])
    yield "files", ", ".join(filter(None, (summary["archive"], summary.get("figure"))))


# Share by which a mean and its end differ where a run came from elsewhere.
ELSEWHERE = 0.02


def _another(end, mean) -> bool:
    """Whether the aligned seal at the end has another number than the run's mean; archives of earlier versions hold
    none."""
    return end is not None and mean is not None and abs(end - mean) > ELSEWHERE * max(abs(end), abs(mean))


# How a number below what the accuracy resolves begins.
BELOW = "below "
# Rise (K) beyond which a leakage cannot carry the heat, whatever the liquid: it would boil, or be no lubricant.
CARRIED = 100.0


def _friction(friction, area) -> str:
    """Power and torque, and what the heat does: on faces of an `area` (m^2; None in archives that do not hold it)."""
    words = f"{_n(friction['power'])} W, torque {_n(friction['torque'])} N m"
    rise = friction["temperature_rise"]
    if rise is not None and rise <= CARRIED:
        return f"{words}; would heat the leakage by {_n(rise)} K"
    flux = f", {_n(friction['power'] / area, 1e-4)} W/cm^2 of face" if area and friction["power"] is not None else ""
    return f"{words}{flux}" + ("" if rise is None else f": more than the leakage can carry (over {CARRIED:.0f} K)")


def _contact_rows(contact, end):
    """What the faces did where they touched, in a run up to `end` (s)."""
    grazing = f"; {contact['grazing']} grazing within {_n(contact['gap_error'], MICRO)} um, undecided"
    grazing = grazing if contact["grazing"] else ""
    if not contact["touches"]:
        yield "touch", f"never (asperities meet at {_n(contact['touch_at'], MICRO)} um){grazing}"
        return
    several = "s" if contact["touches"] > 1 else ""
    when, longest = f"{contact['touches']} contact{several}, first at t = {_n(contact['first'])} s", contact["longest"]
    lasts = f"longest {_n(longest)} s, "
    if contact["first"] == 0.0 and longest >= end:
        when, lasts = "in contact all the time", ""
    yield "touch", (f"{when}, deepest {_n(contact['depth'], MICRO)} um, {lasts}impulse "
                    f"{_n(contact['impulse'])} N s{grazing}")  # fmt: skip
    # Archives of earlier versions do not hold the share of the load, nor whether the faces wear.
    load = contact.get("share_of_load")
    load = "" if load is None else f", which is {_n(load, 100)} % of what it is above the lower pressure"
    wear = f"wear {_n(contact['wear_rate'], 3.6e9)} um/h" if contact.get("wears", True) else "no wear coefficient"
    yield "", f"carries {_n(contact['share_of_closing'], 100)} % of the absolute closing force{load}"
    yield "", (f"up to {_n(contact['force']['max'])} N and {_n(contact['max_pressure'], 1e-6)} MPa of apparent area; "
               f"real area of the asperities up to {_n(contact['max_area_fraction'], 100)} % of the face; "
               f"{wear}")  # fmt: skip


def _seal_rows(seals):
    for name, seal in seals["rings"].items():
        yield "o-ring", (f"{name}: {seal['law']} friction, breaks away at {_n(seal['breakaway_force'])} N or "
                         f"{_n(seal['breakaway_moment'])} N m")  # fmt: skip
    if seals["sticks"] is not None:
        held = ", ".join(seals["stuck_at_end"])
        held = f"stuck: {held}" if held else "sliding"
        yield "", f"stuck {seals['sticks']} times, slipped {seals['slips']} times; at the end {held}"


def _settled_rows(summary):
    """Thinnest film and relative misalignment of the settled part of a run, or why there is none."""
    low, tilt, form = (summary[k] for k in ("h_min", "relative_misalignment", "closed_form"))
    if tilt["steady_max"] is None:
        yield "steady state", tilt["steady_said"]
        return
    # Archives of earlier versions did not keep it.
    if low.get("steady") is not None:
        share = low["steady"] / low["value"] * low["of_clearance"]
        yield "h_min", f"settled: {_n(low['steady'], MICRO)} um ({_n(share, 100)} % of the clearance)"
    # Two digits beyond what is accurate, to compare.
    near = tilt_resolved(summary)
    digits = min(max(2 + math.floor(math.log10(max(tilt["steady_max"], near) / near)), 3), 6)
    if 0.0 < tilt["steady_max"] < near:
        words = f"settled: {if_resolved(tilt['steady_max'], MICRO, near)} urad, less than the accuracy asked resolves"
    else:
        words = "settled, urad: max {}, min {}".format(
            *(if_resolved(tilt[name], MICRO, near, digits) for name in ("steady_max", "steady_min"))
        )
    if "relative_max" in form:
        words += f"; closed form {_n(form['relative_max'], MICRO, digits)}, {_n(form['relative_min'], MICRO, digits)} "
        # Linear theory knows no friction: a ring on an O-ring lags by more.
        words += f"({form['road']}{', without the O-ring' if summary['secondary_seal'] else ''})"
    yield "misalignment", words


def _whole_run_rows(summary):
    """The same of the whole run: its transient where it settles to something else."""
    low, tilt = summary["h_min"], summary["relative_misalignment"]
    settled = tilt["steady_max"] is not None
    first, second = ("transient", "") if settled else ("h_min", "misalignment")
    if settled and _all_is_settled(summary):
        first = "whole run"
    if low["value"] is not None:
        words = "h_min " if settled else ""
        yield first, (f"{words}{_n(low['value'], MICRO)} um ({_n(low['of_clearance'], 100)} % of the clearance) at t = "
                      f"{_n(low['time'])} s, theta = {_n(low['theta'], DEGREES)} deg, r = "
                      f"{_n(low['radius'], MILLI)} mm")  # fmt: skip
    if tilt["max"] is not None:
        near = tilt_resolved(summary)
        if 0.0 < tilt["max"] < near:
            yield second, f"{'misalignment ' if settled else ''}{if_resolved(tilt['max'], MICRO, near)} urad"
            return
        words = "misalignment, urad" if settled else "urad"
        most, least, mean = (if_resolved(tilt[name], MICRO, near) for name in ("max", "min", "mean"))
        yield second, f"{words}: max {most}, min {least}, mean {mean}"


def tilt_resolved(summary) -> float:
    """Relative misalignment (rad) below which a run's accuracy tells nothing; 0 of a run without a thinnest film."""
    clearance, radius = summary["film"]["clearance"], summary["h_min"]["radius"]
    return summary["accuracy"] * clearance / radius if clearance and radius else 0.0


def if_resolved(value, factor: float, near: float, digits: int = 4) -> str:
    """A number (SI; None: "-") times `factor`; one below what the accuracy resolves, `near` (SI), as that."""
    below = value is not None and 0.0 < abs(value) < near
    return f"{BELOW}{_n(near, factor, 3)}" if below else _n(value, factor, digits)


def _all_is_settled(summary) -> bool:
    """Whether film and misalignment are nowhere further out than where settled, by what is printed or is accurate."""
    low, tilt, clearance = summary["h_min"], summary["relative_misalignment"], summary["film"]["clearance"]
    if low.get("steady") is None:
        return False
    near = summary["accuracy"] * clearance
    pairs = ((low["value"], low["steady"], near), (tilt["max"], tilt["steady_max"], near / low["radius"]))
    return all(_n(whole) == _n(part) or abs(whole - part) <= apart for whole, part, apart in pairs)


def _margin_rows(summary):
    margin, contact = summary["contact_margin"], summary["contact"]
    if margin is None:
        return
    if margin == 0.0:
        words = "the asperities touch without any forcing: there is no margin"
    elif margin < 1.0:
        words = f"linear theory: the faces touch from {_n(margin)} times this forcing on"
    else:
        words = f"linear theory: forcing may grow {_n(margin)} times before the faces touch"
        words += ", yet they touched in this run" if contact and contact["touches"] else ""
    yield "contact", words


def _stability(stability, unit, per):
    def at(*speeds, joined=", "):
        return f"{joined.join(f'{float(_n(w, per)):.7g}' for w in speeds)} {unit}"

    critical, whirl = stability["critical_speed"], stability["whirl_ratio"]
    verdict = stability["verdict"]
    text = f"{verdict} (all degrees of freedom, at {at(stability['speed'])})"
    if verdict == "neutral" and stability.get("growth_rate_uncertainty") is not None:
        known = _n(stability["growth_rate_uncertainty"], digits=2)
        text += f", growth rate {_n(stability['growth_rate'])} 1/s, known to +- {known} 1/s only"
    if whirl is not None:
        text += f", whirl ratio {_n(whirl)}"
    # Archives of earlier versions do not hold it.
    keeps = ", the stator keeping its own speed" if stability.get("stator_speed") else ""
    fastest = stability.get("fastest") or math.inf
    if critical and critical > fastest:
        text += f", no critical speed up to {at(fastest)}, faster than any such face turns{keeps}"
    elif critical:
        text += f", critical speed {at(critical)}{keeps}"
        every = stability.get("thresholds") or [critical]
        tilts = [mode["re"] for mode in stability["modes"] if mode["kind"] == "tilt"]
        if tilts and verdict != "neutral":
            # The tilts' growth at this speed says it of the others: each threshold turns it round.
            turned = sum(w < abs(stability["speed"]) for w in every) % 2
            below = (max(tilts) < 0.0) != bool(turned)
            text += f" (stable {'below' if below else 'above'})"
        if again := [w for w in every[1:] if w <= fastest]:
            text += f", again at {at(*again)}"
    elif stability["thresholds"] is None:
        text += ", critical speed not looked for (study campbell)"
    else:
        text += f", no critical speed{keeps}"
    if stability.get("speeds_held"):
        text += f" (from {at(*stability['speeds_held'], joined=' to ')}, where a film holds the closing force)"
    if met := [w for w in stability["resonance_speeds"] or () if w <= fastest]:
        text += f", resonance of a tilt at {at(*met)} (all modes: study campbell)"
    return text


def _n(value, factor=1.0, digits=4):
    return "-" if value is None else f"{value * factor:.{digits}g}"


# Keys of [film] that say nothing of a gas.
OF_LIQUIDS = ("density", "inertia", "specific_heat", "coefficients")


def resolved_lines(found: dict) -> list[str]:
    """The resolved scene in SI, then what the program makes of it."""
    out = []
    for table, keys in found["scene"].items():
        if table == "film" and keys["gas"] is not None:
            keys = {key: value for key, value in keys.items() if key not in OF_LIQUIDS}
        out += _table_lines(table, keys)
    if found.get("gauge"):
        given = " and ".join(found["gauge"])
        out.append(f"# pressures are absolute: {given}, given as gauge, with the 1.01325 bar of the air")
    model = found["model"]
    if "closed_form" in found:
        out.append(f"# {model['followers']} followers; solver {model['solver']}")
        out += [f"# {line}" for line in (*model["reasons"], *found["closed_form"])]
        return out + [f"# {line}" for line in _rule_lines(found["design_rules"])]
    out.append(f"# {model['film']} film; unknowns {', '.join(model['unknowns'])}; solver {model['solver']}")
    out += [f"# {reason}" for reason in model["reasons"]]
    for root in found["equilibria"]:
        kind = "stable" if root["stable"] else "not stable by the film alone"
        what = "stiffness of film and asperities" if found["scene"]["contact"] else "film stiffness"
        where = f"{_n(root['clearance'], MICRO)} um, {what} {_n(root['stiffness'])} N/m"
        out.append(f"# equilibrium clearance {where}, {kind}")
    out += [f"# {found['beside_reynolds']['said']}"] if found.get("beside_reynolds") else []
    if model["unused"]:
        out.append(f"# not used: {', '.join(model['unused'])}")
    out += [f"# WARNING {warning}" for warning in found.get("warnings", [])]
    return out + [f"# {line}" for line in _rule_lines(found["design_rules"])]


def _rule_lines(rows) -> list[str]:
    """How many design rules came out how, then one line a rule: those that failed first, those that could not tell
    last."""
    if not rows:
        return []
    order = ("fail", "acknowledged", "note", "pass", "not applicable")
    count = [row["verdict"] for row in rows].count
    counts = ", ".join(f"{count(verdict)} {verdict}" for verdict in order if count(verdict))
    out = [f"design rules of {rows[0]['guide']}: {counts}"]
    for row in sorted(rows, key=lambda row: order.index(row["verdict"])):
        words = f"{row['said']} ({row['source']})" if row["verdict"] != order[-1] else row["said"]
        words += f"; reason: {row['reason']}" if row["reason"] else ""
        words += f"; try {row['command']}" if row["command"] and row["verdict"] != order[-1] else ""
        line = f"  {row['verdict']:<15}{row['rule']}: {words}"
        out.append("".join(c if c.isprintable() else " " for c in line))
    return out


def _table_lines(name, value):
    if not isinstance(value, dict):
        return [] if value is None or value == [] else [f"{name} = {toml_line(value)}"]
    plain = {k: v for k, v in value.items() if not isinstance(v, dict) or set(v) == {"time", "value"}}
    out = [f"[{name}]"] if any(v is not None and v != [] for v in plain.values()) else []
    out += [f"{k} = {toml_line(v)}" for k, v in plain.items() if v is not None and v != []]
    for k, v in value.items():
        if k not in plain:
            out += _table_lines(f"{name}.{k}", v)
    return out


# Rows of a study's table that are printed: of more, so many evenly spread ones.
MOST_ROWS = 24


def study_lines(answer: dict, tables) -> list[str]:
    """The verdict of a study and its tables.

    `tables`: pairs of rows (dicts) and columns `(heading, key of a row, factor)`, the factor 1 if left out; a dotted
    key goes into the dicts of a row.  A row with the key `failed` ends with that reason.
    """
    if "found" in answer:
        out = [f"  {answer['found']}"]
        for table in answer["tables"]:
            out += [f"    {line}" for line in table_lines(table, answer["written"])]
        return out + [f"  {note}" for note in answer["notes"]]
    out = [f"  {sentence}" for sentence in answer["verdict"]]
    for rows, columns in tables:
        if rows:
            step = -(-len(rows) // MOST_ROWS)
            out += [f"    {line}" for line in _aligned([*rows[:-1:step], rows[-1]], columns)]
            out += [f"    ({len(rows)} rows in the archive)"] if step > 1 else []
    return out


def _aligned(rows, columns) -> list[str]:
    """Headings and rows, each column as wide as its widest cell; numbers to the right, words to the left; after the
    first no column without a value."""
    first, *others = columns
    columns = [first, *(column for column in others if any(_value(row, column[1]) is not None for row in rows))]
    cells = [[heading, *(_cell(row, *where) for row in rows)] for heading, *where in columns]
    widths = [max(map(len, column)) for column in cells]
    words = [isinstance(_value(rows[0], key), str) for _, key, *_ in columns]
    reasons = ["", *(row.get("failed") or "" for row in rows)]
    return [
        "  ".join([c.ljust(w) if left else c.rjust(w) for c, w, left in zip(line, widths, words, strict=True)] + [why])
        .rstrip()
        for *line, why in zip(*cells, reasons, strict=True)
    ]  # fmt: skip


def _cell(row, key, factor=1.0) -> str:
    value = _value(row, key)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else _plain(_n(value, factor))


def _plain(words: str) -> str:
    """Speeds and flows of five or six figures without an exponent."""
    return f"{float(words):.0f}" if words.endswith(("e+04", "e+05")) else words


def _value(row, key):
    for name in key.split("."):
        row = row.get(name) if isinstance(row, dict) else None
    return row


def archive_lines(path, info: dict) -> list[str]:
    """What an archive holds."""
    rows = [("made", f"{info['created']} by sealdyn {info.get('version', '?')}, solver {info.get('solver', '?')}, "
                     f"accuracy {info.get('accuracy', '?')}"), ("rows", info["rows"])]  # fmt: skip
    restart = info.get("restart") or {}
    if info["status"] == Status.RUNNING and restart:
        rows.append(("state kept", f"leg {restart.get('leg')}, leg time {restart.get('tau')} s"))
    summary = info.get("summary") or {}
    if "follower" in summary:
        rows.append(("contact", f"{_n(summary['settled']['contact_share'], 100)} % of the time on the shaft (settled)"))
    elif summary:
        low = summary["h_min"]
        rows.append(("h_min", f"{_n(low['value'], MICRO)} um at t = {_n(low['time'])} s"))
        rows.append(("stability", _stability(summary["stability"], *speed_unit(info))))
    rows += [("event", _event(event)) for event in info.get("events", [])]
    rows.append(("series", ", ".join(f"{n} [{s.units}]" for n, s in info["series"].items())))
    if info["fields"]:
        over = " x ".join(f"{count} {name}" for name, count in info["grid"].items())
        rows.append(("fields", ", ".join(f"{n} [{s.units}]" for n, s in info["fields"].items()) + f": {over}"))
    return _table(path, info["status"], info.get("message"), rows)


def _event(event) -> str:
    """What happened and when; of a contact also how long."""
    when = f"{event['kind']} at t = {_n(event['time'])} s"
    if event["kind"] != "contact" or event.get("lift_off") is None:
        return when
    lasts = event["lift_off"] - event["time"]
    return f"{when}, to the end" if math.isnan(lasts) else f"{when}, for {_n(lasts)} s"


def csv_rows(info: dict, column, block: int = 4096):
    """Header and rows of all series, read block by block."""
    names = ["time", *[n for n in info["series"] if n != "time"]]
    yield ",".join(f"{n} [{info['series'][n].units}]" for n in names)
    for start in range(0, info["rows"], block):
        part = [column(name, slice(start, min(start + block, info["rows"]))) for name in names]
        for row in zip(*part, strict=True):
            yield ",".join(repr(float(x)) for x in row)


def csv_lines(columns: dict):
    """Header and rows of columns of equal length: numbers with every digit, words and headings quoted where they must
    be, nothing for what there is not."""
    yield ",".join(map(_quoted, columns))
    for row in zip(*(values.tolist() for values in columns.values()), strict=True):
        yield ",".join(_csv_cell(value) for value in row)


def _csv_cell(value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    return "" if math.isnan(value) else repr(value)


def _quoted(words: str) -> str:
    return '"' + words.replace('"', '""') + '"' if any(c in words for c in ',"\n\r') else words


def tables_line(tables: dict) -> list[str]:
    """Which tables an archive has, for those who want one."""
    sizes = [f"{name} ({len(next(iter(columns.values())))} rows)" for name, columns in tables.items()]
    return [f"  tables for --csv, --mat: {', '.join(sizes)}"] if sizes else []
