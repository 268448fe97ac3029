"""Words for people: the summary of a run, a resolved scene, the answer of a study, what an archive holds."""

import math
import re
from collections.abc import Mapping

from ..answers import toml_line
from ..kernel_cache import solvers_digest
from ..quantities import everyday, in_words, number, reading_in, shown_in, written_alone
from ..status import Status


def lines(name: str, answer, verbose: bool = False) -> list[str]:
    """The summary of a run (report.summary.run_answer): how it ended, labelled lines, warnings, files; `verbose` with
    its details."""
    summary = answer.numbers
    told = ((line.label, line_words(line)) for line in answer.lines if verbose or not line.detail)
    rows = [(label, words) for label, words in told if words]
    rows[-1:-1] = [("WARNING", warning) for warning in answer.notes]
    return _table(name, summary["status"], answer.found, rows)


# With these words a part goes on with the one before it.
JOINED = ("to", "at", "or", "and", "times")


def line_words(line) -> str:
    """The parts of a line of a summary: words and numbers with their units."""
    told = ""
    for words, value, *quantity in line.parts:
        # A number that there is not takes its words away.
        if value is None and quantity[0]:
            continue
        if value is not None:
            value = value if isinstance(value, str) else in_words(quantity[0], value, *quantity[1:])
        if part := " ".join(filter(None, (words, value))):
            goes_on = not told or part.split()[0] in JOINED
            told += f"{' ' if goes_on else ', '}{part}"
    return told.strip()


def solvers_words(info: Mapping) -> str:
    """By which films, equations and solvers an archive was made, and whether today's are others."""
    made, today = info.get("solvers", "of no name"), solvers_digest()
    return made if made == today else f"{made}, older than {today} of today"


def question_of(comment: str) -> str:
    """What a scenario asks: its comment up to the question mark, or without one its first sentence."""
    if "?" in comment:
        return comment[: comment.index("?") + 1]
    return comment.split(". ")[0]


# A key whose unit a reader wants to see again: SI unit, and the quantities that are read in it.
READ_LIKE = {
    "clearance": ("m", ("clearance", "h_min", "film_thickness", "largest_gap")),
    "radius": ("m", ("radius",)),
    "diameter": ("m", ("radius",)),
    "pressure": ("Pa", ("pressure", "Pa")),
    "pressure_difference": ("Pa", ("pressure", "Pa")),
    "runout": ("rad", ("tilt", "misalignment")),
    "misalignment": ("rad", ("tilt", "misalignment")),
    "speed": ("rad/s", ("rad/s",)),
}
# The last word of such a key, and the unit of its value, or of the values in its table over time.
WRITTEN = re.compile(
    rf"""^[^#\n]*?({"|".join(READ_LIKE)})["']?\s*=(?:\s*\{{\s*time\s*=\s*\[[^\]\n]*\])?"""
    r"""[^#\n"']*["'][^"'\n]*?\d\s*([A-Za-z][\w/]*)""",
    re.MULTILINE,
)
# An override's value without quotes, no list and no table.
BARE = re.compile(r"""=\s*([^"'\[{\n]+)$""")


def written_units(info: dict) -> dict[str, str]:
    """{quantity or SI unit: unit} in which a run or study has what may be read in several: speeds in "rpm" where its
    scenario or command line has them so, else in "rad/s"; pressures, clearances, radii and tilts as they are written,
    where that is no unit of those by size."""
    # A shell takes the quotes of an override away.
    overrides = (BARE.sub(r'="\1"', str(override)) for override in info.get("overrides") or [])
    words = "\n".join([info.get("scenario") or "", *overrides])
    rpm, found = False, dict[str, str]()
    for key, unit in WRITTEN.findall(words):
        si, names = READ_LIKE[key]
        rpm = rpm or unit == "rpm"
        if written_alone(si, unit := unit.removesuffix("g") if si == "Pa" else unit):
            found |= dict.fromkeys(names, unit)
    return found | {"rad/s": "rpm" if rpm else "rad/s"}


def speed_unit(info: dict) -> tuple[str, float]:
    """The same of speeds, and how many of it make one rad/s."""
    with reading_in(written_units(info)):
        return shown_in("speed")


def is_over_time(table: Mapping) -> bool:
    """Whether a resolved table is a quantity that changes with time."""
    return set(table) == {"time", "value"}


def _table(title, status, message, rows) -> list[str]:
    ended = f"{title}: {status}" + (f" - {message}" if message else "")
    return [ended, *(f"  {name:<14}{words}" for name, words in rows)]


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
        out += [f"# WARNING {warning}" for warning in found["warnings"]]
        return out + [f"# {line}" for line in _rule_lines(found["design_rules"])]
    out.append(f"# {model['film']} film; unknowns {', '.join(model['unknowns'])}; solver {model['solver']}")
    out += [f"# {reason}" for reason in model["reasons"]]
    out += [_grooved_line(found)] if "grooves" in found else []
    for root in found["equilibria"]:
        kind = "stable" if root["stable"] else "not stable by the film alone"
        what = "stiffness of film and asperities" if found["scene"]["contact"] else "film stiffness"
        where = f"{in_words('clearance', root['clearance'])}, {what} {in_words('axial_stiffness', root['stiffness'])}"
        out.append(f"# equilibrium clearance {where}, {kind}")
    out += [f"# {line}" for line in _heated_lines(found["heat"])] if found.get("heat") else []
    out += [f"# {found['beside_reynolds']['said']}"] if found.get("beside_reynolds") else []
    if model["unused"]:
        out.append(f"# not used: {', '.join(model['unused'])}")
    out += [f"# WARNING {warning}" for warning in found.get("warnings", [])]
    return out + [f"# {line}" for line in _rule_lines(found["design_rules"])]


def _grooved_line(found) -> str:
    """The aligned film over grooves."""
    grooves, clearance = found["grooves"], in_words("clearance", found["clearance"])
    pumped = f", which pump {grooves['pumping']}" if grooves["pumping"] else ""
    deep = (
        f"depth {grooves['depth_over_film']:.3g} times that, Couette Reynolds number {grooves['reynolds_number']:.3g}"
    )
    return f"# aligned film over the grooves of the {grooves['face']}{pumped}: {clearance}, {deep}"


def _heated_lines(heat) -> list[str]:
    """What each ring takes of the heat, and how warm that makes the faces."""
    out = []
    for name, ring in heat["rings"].items():
        parts = [f"{ring['resistance']:.4g} K/W", in_words("coning_per_watt", ring["coning_per_watt"])]
        parts += [f"settles in {in_words('time', ring['time_constant'])}"] if ring["time_constant"] else []
        parts += [f"h {ring['convection']:.4g} W/(m^2 K)", f"h w/k {ring['biot']:.3g}"] if ring["convection"] else []
        parts += [f"Re {ring['reynolds']:.3g}"] if ring["reynolds"] else []
        out.append(f"heat into the {name}: {', '.join(parts)}")
    ends = heat["interval"]
    between = f" ({ends['rise'][1]:.4g} to {ends['rise'][0]:.4g})" if ends and None not in ends["rise"] else ""
    coned = f"coning {in_words('tilt', heat['coning'])}, of it by heat {in_words('tilt', heat['coning_by_heat'])}"
    return [*out, f"warm faces {heat['rise']:.4g}{between} K above the sealed liquid, {coned}"]


def _rule_lines(rows) -> list[str]:
    """How many design rules came out how, then one line a rule: those that failed first, those that could not tell
    last."""
    if not rows:
        return []
    order = ("fail", "acknowledged", "note", "pass", "not applicable")
    count = [row["verdict"] for row in rows].count
    counts = ", ".join(f"{count(verdict)} {verdict}" for verdict in order if count(verdict))
    out = [f"design rules of {' and '.join(dict.fromkeys(row['guide'] for row in rows))}: {counts}"]
    for row in sorted(rows, key=lambda row: order.index(row["verdict"])):
        words = f"{row['said']} ({row['source']})" if row["verdict"] != order[-1] else row["said"]
        words += f"; reason: {row['reason']}" if row["reason"] else ""
        words += f"; try {row['command']}" if row["command"] and row["verdict"] != order[-1] else ""
        line = f"  {row['verdict']:<15}{row['rule']}: {words}"
        out.append(line)
    return out


def _table_lines(name, value):
    if not isinstance(value, dict):
        return [] if value is None or value == [] else [f"{name} = {toml_line(value)}"]
    plain = {k: v for k, v in value.items() if not isinstance(v, dict) or is_over_time(v)}
    out = [f"[{name}]"] if any(v is not None and v != [] for v in plain.values()) else []
    out += [f"{k} = {toml_line(v)}" for k, v in plain.items() if v is not None and v != []]
    for k, v in value.items():
        if k not in plain:
            out += _table_lines(f"{name}.{k}", v)
    return out


def study_lines(answer: dict) -> list[str]:
    """What a study found, its tables and its notes."""
    out = [f"  {answer['found']}"]
    with reading_in(answer["written"]):
        for table in answer["tables"]:
            out += [f"    {line}" for line in table_lines(table)]
    return out + [f"  {note}" for note in answer["notes"]]


def archive_lines(path, info: dict) -> list[str]:
    """What an archive holds."""
    rows = [("made", f"{info['created']} by sealdyn {info.get('version', '?')}, solver {info.get('solver', '?')}, "
                     f"accuracy {info.get('accuracy', '?')}"), ("rows", info["rows"])]  # fmt: skip
    restart = info.get("restart") or {}
    if info["status"] == Status.RUNNING and restart:
        rows.append(("state kept", f"leg {restart.get('leg')}, leg time {restart.get('tau')} s"))
    summary = info.get("summary") or {}
    if "follower" in summary:
        share = in_words("share", summary["settled"]["contact_share"])
        rows.append(("contact", f"{share} of the time on the shaft (settled)"))
    elif summary:
        low = summary["h_min"]
        rows.append(("h_min", f"{in_words('h_min', low['value'])} at t = {in_words('time', low['time'])}"))
        rows.append(("stability", summary["stability"]["verdict"]))
    rows += [("event", _event(event)) for event in info.get("events", [])]
    rows.append(("series", ", ".join(f"{n} [{s.units}]" for n, s in info["series"].items())))
    if info["fields"]:
        over = " x ".join(f"{count} {name}" for name, count in info["grid"].items())
        rows.append(("fields", ", ".join(f"{n} [{s.units}]" for n, s in info["fields"].items()) + f": {over}"))
    return _table(path, info["status"], info.get("message"), rows)


def _event(event) -> str:
    """What happened and when; of a contact also how long."""
    when = f"{event['kind']} at t = {in_words('time', event['time'])}"
    if event["kind"] != "contact" or event.get("lift_off") is None:
        return when
    lasts = event["lift_off"] - event["time"]
    return f"{when}, to the end" if math.isnan(lasts) else f"{when}, for {in_words('time', lasts)}"


# How what a spreadsheet takes for a formula begins.
COMPUTED = ("=", "+", "-", "@", "\t", "\r")


def plain_letters(unit: str) -> str:
    """A unit as a scenario may have it."""
    return unit.replace("µ", "u").replace("²", "^2").replace("³", "^3").replace("°", "deg")


def csv_rows(info: dict, column, read: bool = False, block: int = 4096):
    """Header and rows of all series, read block by block, in SI or in the units that people `read` them in."""
    names = ["time", *[n for n in info["series"] if n != "time"]]
    series = [info["series"][name] for name in names]
    shown = [(one.display_unit or one.units, one.display_factor) if read else (one.units, 1.0) for one in series]
    yield ",".join(_quoted(f"{name} [{plain_letters(unit)}]") for name, (unit, _) in zip(names, shown, strict=True))
    for start in range(0, info["rows"], block):
        rows = slice(start, min(start + block, info["rows"]))
        part = [column(name, rows) * factor for name, (_, factor) in zip(names, shown, strict=True)]
        for row in zip(*part, strict=True):
            yield ",".join(repr(float(x)) for x in row)


def as_read(columns: dict) -> dict:
    """Columns of a table, {"h_min [m]": values}, in the units that people read them in."""
    found = {}
    for heading, values in columns.items():
        name, bracket, unit = heading.removesuffix("]").partition(" [")
        shown, factor = everyday(unit) if bracket else ("", 1.0)
        found[f"{name} [{plain_letters(shown)}]" if bracket else heading] = values * factor if factor != 1.0 else values
    return found


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
    """Words as a cell; those that a spreadsheet would compute, and that are no number, are told to be text."""
    if words.startswith(COMPUTED) and not _is_number(words):
        words = f"'{words}"
    return '"' + words.replace('"', '""') + '"' if any(c in words for c in ',"\n\r') else words


def _is_number(words: str) -> bool:
    try:
        return math.isfinite(float(words))
    except ValueError:
        return False


def tables_line(tables: dict) -> list[str]:
    """Which tables an archive has, for those who want one."""
    sizes = [f"{name} ({len(next(iter(columns.values())))} rows)" for name, columns in tables.items()]
    return [f"  tables for --csv, --mat: {', '.join(sizes)}"] if sizes else []


# Rows that are printed: of more, so many evenly spread ones.
MOST_ROWS = 24


def table_lines(table: Mapping) -> list[str]:
    """A table of an answer as JSON has it (answers.as_json): headings, then rows, numbers to the right, words to the
    left; no column without a value but the first."""
    columns, rows = table_columns(table), table["rows"]
    if not columns:
        return []
    lines = ["  ".join(cells).rstrip() for cells in zip(*columns, strict=True)]
    return lines + ([f"({len(rows)} rows in the archive)"] if len(rows) > MOST_ROWS else [])


def table_columns(table: Mapping, most: int = MOST_ROWS) -> list[list[str]]:
    """The columns of such a table that are printed, each a heading and cells of equal width; of more than `most` rows
    every second, third ..."""
    rows = table["rows"]
    if not rows:
        return []
    step = -(-len(rows) // most)
    printed = [*rows[:-1:step], rows[-1]]
    held = [one["quantity"] for one in table.get("of_rows", ())]
    held = [*held[:-1:step], *held[-1:]]
    columns = []
    for k, column in enumerate(table["columns"]):
        values = [row[k] for row in rows]
        if k == 0 or any(value is not None for value in values):
            columns.append(_column(column, values, [row[k] for row in printed], held))
    return columns


def _column(column, values, printed, of_rows) -> list[str]:
    """Heading and cells of equal width; `of_rows` the quantity of each row."""
    words = any(isinstance(value, str) for value in values)
    if column["quantity"] == "row":
        cells = [column["name"], *(_of_row(*pair) for pair in zip(of_rows, printed, strict=True))]
    else:
        unit, factor = shown_in(column["quantity"], values)
        cells = [", ".join(filter(None, (column["name"], "" if words else unit))), *(_cell(v, factor) for v in printed)]
    width = max(map(len, cells))
    return [cell.ljust(width) if words else cell.rjust(width) for cell in cells]


def _of_row(held: str, value) -> str:
    return value if isinstance(value, str) else in_words(held, value) if value is not None else "-"


def _cell(value, factor: float) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else number(value, factor)
