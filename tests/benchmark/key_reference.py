"""scenarios/README.md: every key of a scenario file, every shipped scenario; scenarios/studies.md: settings of studies.

    python tests/benchmark/key_reference.py

Keys come from the JSON schema (`sealdyn schema`), settings from the studies, scenarios from the comment at the head
of each file.
"""

import json
import re
from pathlib import Path

from sealdyn import read_scenario
from sealdyn.scenario.tables import RadialFile
from sealdyn.studies import study_names
from sealdyn.studies._declared import about, json_schema, settings_of, time_of

SCENARIOS = Path(__file__).parents[2] / "scenarios"
PAGE, STUDIES = SCENARIOS / "README.md", SCENARIOS / "studies.md"
# Design rules, vibration and radial seals, in words; runs beside another program.
GUIDE, BESIDE = (Path(__file__).parent / name for name in ("guide.md", "beside.md"))
HEAD = """# Scenario files

One TOML file describes a seal and a run.  This page is written by `python tests/benchmark/key_reference.py` from the
JSON schema (`sealdyn schema`), which editors read too.

- A quantity is a string with a unit (`"10 um"`, `"9550 rpm"`, `"5 bar"`, `"0.5 mPa*s"`) or a bare number in the SI unit
  named below.  Units multiply by `*`, `.`, `-` or a blank and divide by `/`, powers stand with or without `^`:
  `"0.5 mPa.s"`, `"3 lbf-in"`, `"850 kg/m3"`, `"4 kJ/(kg*K)"`.  `in`, `mil`, `lb`, `lbf`, `psi`, `ksi`, `BTU`, `degF`,
  `kgf`, `cP` and their like are known.
- Pressures are absolute, or gauge if their unit says so: `"5 barg"`, `"70 psig"`, `"0.4 MPa gauge"` are read as so much
  above 1.01325 bar.  Where the air around has another pressure, give absolute ones.
- Where a table has a radius, its diameter may stand instead (`outer_diameter` for `outer_radius`); never both.
- A quantity marked ~ may vary with time: `{ time = [...], value = [...] }`, linear between the times, constant before
  the first and after the last; the same time twice is a step.  `{ file = "speed.csv" }` reads the columns `time` and
  `value`, or the key's own name.
- `[shaft.motion]` and `[housing.motion]` move the carrier of rotor or stator by samples: as lists, or from a `file`
  beside the scenario, CSV with a line of names (`time (ms), axial (um), tilt_x (urad), tilt_y (urad)`, others are not
  read) or HDF5 (datasets with these names, units as attribute `units` or `unit`, packed numbers as the CF conventions
  have them; missing samples are refused); SI without a unit.  A moment that stands there twice counts once; more than
  200 000 samples are cut to the run.  Measured accelerations (`axial_acceleration`) are
  integrated twice, their drift removed.  `[stator.load.samples]` reads `force`, `moment_x`, `moment_y` likewise,
  `[film.tabulated]` `clearance`, `speed`, `k_axial_axial` and its like, or the archive of `sealdyn study coefficients`.
- `[film.NAME]` and `[stator.load.NAME]` are the options of a film or a load of one's own ([own](own), and
  [how](../sealdyn/README.md#films-loads-and-studies-of-ones-own)).
- A number without a unit that no seal has, in SI, is told by `check` and by every run, with what it may have meant.
- The arrangement follows from the supports: a table `[stator.support]` makes the stator float (FMS), `[rotor.support]`
  the rotor (FMR), both make both float (FMSR).
- `sealdyn list` names the shipped ones, wherever sealdyn is installed; `sealdyn.example("fms_reference")` reads one in
  Python.
- `schema = 1` at the head of a file says which version of these keys it is written in; without it the present one.  A
  file of a newer version is refused in a line that says so.
- Settings of studies (`[study.NAME]`) and runs beside another program: [studies.md](studies.md).
- An unknown key is refused; a known key that this seal does not use is listed as `not used`.
- `[application]` is what the seal is asked to do, for the design rules of `sealdyn check` (below); it
  changes no number of a run.
- Axes: the shaft axis z points from the rotor to the stator; angles are counted from the x axis.
"""


OF_STUDIES = """# Settings of studies, and runs beside another program

Keys of a scenario's table `[study.NAME]`, or flags `--key value` of `sealdyn study NAME`; written by
`python tests/benchmark/key_reference.py`.
"""
SHIPPED = """## Shipped scenarios

What is asked of each; what to expect and from which source stands at the head of its file.
"""


def page() -> str:
    """The page of keys and scenarios, markdown."""
    parts = [HEAD, SHIPPED, *map(shipped, sorted(SCENARIOS.glob("*.toml")))]
    parts += [*map(shipped, sorted(SCENARIOS.glob("radial/*.toml"))), "\n## Keys\n", *keys(json_schema())]
    parts += [
        "## Keys of radial seals\n",
        "A table `[lip]` or `[circumferential]` makes a scenario one of a radial seal.\n",
    ]
    radial = json_schema(RadialFile)
    # `[run]` is that of face seals.
    parts += keys({**radial, "properties": {k: v for k, v in radial["properties"].items() if k != "run"}})
    return "\n".join([*parts, GUIDE.read_text()])


def studies() -> str:
    """The page of studies, markdown."""
    return "\n".join([OF_STUDIES, *map(settings, study_names()), BESIDE.read_text()])


def keys(schema: dict) -> list[str]:
    """A table of keys for each table of a scenario."""
    found = tables(schema, schema).items()
    return [text for kind, paths in found if (text := key_table(schema["$defs"][kind], paths))]


def shipped(path: Path) -> str:
    """A scenario's question, from its head."""
    text = re.sub(r"\s+", " ", read_scenario(path).question)
    question = re.split(r"\s*\b(?:Expected|Found|Source): ", text)[0]
    # The first question, or the first sentence.
    first = re.match(r".*?\?(?= |$)|.*?\.(?= [A-Z]|$)", question)
    return f"- [{path.stem}]({path.relative_to(SCENARIOS)}): {first.group() if first else question}"


def tables(schema: dict, table: dict, path: str = "") -> dict[str, list[str]]:
    """Headings of every table below, such as "[rotor.support]", by the name of its definition."""
    found = {}
    for key, holds in table["properties"].items():
        for way in (holds, holds.get("items", {}), *holds.get("anyOf", [])):
            if "$ref" in way:
                kind = way["$ref"].rsplit("/", 1)[1]
                dotted = f"{path}.{key}".strip(".")
                found.setdefault(kind, []).append(f"[[{dotted}]]" if holds.get("type") == "array" else f"[{dotted}]")
                for below, paths in tables(schema, schema["$defs"][kind], dotted).items():
                    found.setdefault(below, []).extend(paths)
    return found


def key_table(table: dict, paths: list[str]) -> str:
    """One row a key: quantity and unit, default, meaning."""
    # Of a radius and its diameter one is required: the radius is named so.
    either = [rule["oneOf"][0]["required"] for rule in table.get("allOf", ()) if "oneOf" in rule]
    required = sum(either, [*table.get("required", ())])
    rows = [row(key, holds, key in required) for key, holds in table["properties"].items()]
    rows = [line for line in rows if line]
    if not rows:
        return ""
    heading = ", ".join(f"`{path}`" for path in paths)
    return "\n".join(
        [f"### {heading}\n", "| key | quantity, SI unit | default | meaning |", "|---|---|---|---|", *rows, ""]
    )


def row(key: str, holds: dict, required: bool) -> str:
    """The row of a key; nothing for a key that only holds tables, which have headings of their own."""
    if "$ref" in holds or "$ref" in holds.get("items", {}):
        return ""
    if "quantity" in holds:
        varies = any("properties" in kind for kind in holds.get("anyOf", []))
        what = f"{holds['quantity']}, {holds['unit']}{' ~' if varies else ''}"
    else:
        kinds = (holds, *holds.get("anyOf", []))
        words = [word for kind in kinds for word in kind.get("enum", [kind["const"]] if "const" in kind else [])]
        what = ", ".join(f"`{json.dumps(word)}`" for word in words) or {"boolean": "true or false"}.get(
            holds.get("type"), holds.get("type")
        )
        what = "".join([what or "", *(f", {kind['quantity']}, {kind['unit']}" for kind in kinds if "quantity" in kind)])
        if any("$ref" in kind for kind in holds.get("anyOf", [])):
            what += f", table `{key}`"
    default = "required" if required else f"`{shown(holds['default'])}`" if "default" in holds else "none"
    return f"| `{key}` | {what} | {default} | {holds['description'].splitlines()[0]} |"


def settings(name: str) -> str:
    """What a study is for, how long it takes, and its settings."""
    rows = settings_of(name)
    lines = [f"| `{s.key}` | {s.holds} | {f'`{s.default}`' if s.default else 'none'} | {s.meaning} |" for s in rows]
    head = f"## `[study.{name.replace('-', '_')}]`\n\n{about(name)}  *Time:* {time_of(name)}.\n"
    table = ["| key | value, SI unit | default | meaning |", "|---|---|---|---|", *lines]
    return "\n".join([head, *table, ""])


def shown(value) -> str:
    """A default as one types it."""
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)


if __name__ == "__main__":
    PAGE.write_text(page())
    STUDIES.write_text(studies())
