"""One page for a design review: question, scene, sketch, model, accuracy, figures, verdicts, rules, provenance; of any
number of archives, with nothing loaded from elsewhere.  Figures are enlarged and read off, tables sorted."""

import importlib
import re
from pathlib import Path

from ..answers import dotted, toml_line
from ..archive import is_study, read_info, read_study
from ..quantities import printed, reading_in
from .summary import is_radial, run_answer
from .text import is_over_time, line_words, question_of, solvers_words, table_columns, written_units

TEMPLATE = Path(__file__).with_name("review.html")
# Figures of a run and what they show.
FIGURES = {
    "sketch": "The seal",
    "overview": "Overview of the run",
    "film": "Film thickness",
    "orbit": "Orbits",
}
RADIAL_FIGURES = {"overview": "Overview of the run"}
# Rows of a table that the page has: of more, so many evenly spread ones.
MOST_ROWS = 500
# Numbers of four digits below ten millions that stand with a power of ten.
POWER = re.compile(r"\b\d(?:\.\d+)?e\+0[1-6]\b")


def review(archives, out_path, title: str = "", rules=None, validation=None, progress=None) -> Path:
    """Write the page of some archives (paths) of runs and studies.

    `rules(path, info)` gives the rows of the design rules of a run (`findings` of analysis/design_rules.py),
    `validation(film)` the sources that a film was held against (`sources_of_film` of analysis/sources);
    `progress(done, archives, words)` is told of each.  Returns the path.  **Raises** ArchiveError for what is no
    archive."""
    from jinja2 import Environment, StrictUndefined

    from .charts.page import replacing

    # A place that cannot be is found out before anything is drawn.
    out_path = Path(out_path)
    out_path.parent.mkdir(parents=True, exist_ok=True)
    parts, paths = [], [Path(path) for path in archives]
    for path in paths:
        if progress:
            progress(len(parts), len(paths), f"{path.name} ({len(parts) + 1} of {len(paths)})")
        parts.append(_study(path) if is_study(path) else _run(path, rules, validation))
    if progress:
        progress(len(paths), len(paths), "writing the page")
    seals = _seals(parts)
    _said_once(parts)
    page = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    words = page.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        title=title or _title(parts, seals), parts=parts, seals=seals if len(seals) > 1 else []
    )
    with replacing(out_path) as fresh:
        fresh.write_text(words, encoding="utf-8", errors="backslashreplace")
    return out_path


# Tables of a scenario that are no part of its seal.
ASKED = ("run.", "study.", "application.")


def _seals(parts: list[dict]) -> list[list[str]]:
    """Parts by their scenes: of each scene that is another than those before it, what its parts are."""
    found = {}
    for part in parts:
        found.setdefault(_seal_of(part), []).append(f"{part['name']}, {part['kind']} ({dict(part['made'])['archive']})")
    return [*found.values()]


def _seal_of(part: dict) -> tuple[tuple[str, str], ...]:
    """Of the scene of a part what is its seal."""
    return tuple((key, value) for key, value in part["scene"] if not key.startswith(ASKED))


def _said_once(parts: list[dict]) -> None:
    """What parts have in common only the first of them says; `as_in` of the others has its number, by what is common:
    the question, the drawing, rules, validation, the scene."""
    first = {}
    for number, part in enumerate(parts, 1):
        drawn = "sketch" in [chart for _, chart, _ in part["figures"]]
        common = {
            "asked": (part["question"], part["more"]),
            "sketch": drawn and _seal_of(part),
            "rules": part["rules"],
            "film": part["film"],
            "scene": (part["scene"], part["scenario"]),
        }
        said_by = {what: first.setdefault((what, repr(said)), number) for what, said in common.items()}
        part["as_in"] = {what: common[what] and where < number and where for what, where in said_by.items()}
        if part["as_in"]["sketch"]:
            part["figures"] = [figure for figure in part["figures"] if figure[1] != "sketch"]


def _title(parts: list[dict], seals: list[list[str]]) -> str:
    names = ", ".join(dict.fromkeys(part["name"] for part in parts))
    return f"Design review: {names}" + (f" ({len(seals)} different scenes)" if len(seals) > 1 else "")


def _run(path: Path, rules, validation) -> dict:
    info = read_info(path)
    summary = info["summary"]
    with reading_in(written_units(info)):
        answer = run_answer(summary) if summary else None
        rows = [(line.label, told(line_words(line))) for line in answer.lines] if answer else []
    figures = RADIAL_FIGURES if is_radial(info) else dict(FIGURES)
    if summary and summary.get("relative_misalignment", {}).get("max") == 0:
        # Aligned faces have none.
        figures.pop("orbit", None)
    film = (summary.get("model") or {}).get("film", "") if summary else ""
    found = rules(path, info) if rules else []
    return _part(
        path, info, "run", info["status"],
        message=told(info.get("message", "")),
        rows=[(name, words) for name, words in rows if name != "files"],
        warnings=[told(words) for words in answer.notes] if answer else [],
        figures=[(words, chart, _drawn(path, f"charts.{chart}")) for chart, words in figures.items()],
        rules=[{**rule, **{name: told(rule[name]) for name in ("said", "source")}} for rule in found],
        film=film,
        validation=validation(film) if validation and film else [],
    )  # fmt: skip


def _study(path: Path) -> dict:
    study = read_study(path)
    answer = study["answer"]
    with reading_in(answer["written"]):
        columns = [table_columns(table, MOST_ROWS) for table in answer["tables"]]
    return _part(
        path, study, f"study {study['study']}", answer["status"],
        # The verdict, which stands below.
        message="" if answer["verdict"] else told(answer.get("message", "")),
        figures=[(f"Study {study['study']}", "study", _drawn(path, "panels"))],
        verdict=[told(words) for words in answer["verdict"]],
        tables=[[[told(cell) for cell in row] for row in zip(*table, strict=True)] for table in columns if table],
    )  # fmt: skip


def _part(path: Path, info: dict, kind: str, status, **own) -> dict:
    """What the page has of an archive: what every one holds, and its `own`; the rest is empty."""
    empty = dict.fromkeys(("rows", "warnings", "rules", "validation", "verdict", "tables"), ())
    return {
        **empty, "film": "", "kind": kind, "name": info["name"], **_asked(info), "status": str(status),
        "scene": _scene(info["resolved"]), "scenario": info["scenario"], "made": _made(path, info), **own,
    }  # fmt: skip


def told(words: str) -> str:
    """Words of a terminal as a page has them: units of print, numbers below ten millions in full."""
    plain = POWER.sub(lambda found: f"{float(found[0]):.7g}", words)
    return printed(plain)


def _asked(info: dict) -> dict:
    """The scenario's opening question, and what else its comment says."""
    words = info.get("question") or ""
    question = question_of(words)
    return {"question": question or info["name"], "more": words[len(question) :].strip(". ")}


def _drawn(path: Path, chart: str) -> tuple[str, str]:
    """A chart as it stands in the page, and its axes."""
    # With matplotlib, only where something is drawn.
    from .charts.page import svg_of

    return svg_of(importlib.import_module(f"{__package__}.{chart}").draw(path, None))


def _scene(tables: dict) -> list[tuple[str, str]]:
    """Keys and values in SI, what is not given left out."""
    given = dotted(tables, is_over_time)
    return [(key, toml_line(value)) for key, value in given if value is not None and value != []]


def _made(path: Path, info: dict) -> list[tuple[str, str]]:
    libraries = info.get("libraries") or {}
    overrides = info.get("overrides") or []
    rows = [
        ("archive", path.name),
        ("made", f"{info.get('created', '?')} by sealdyn {info.get('version', '?')}"),
        ("solvers", solvers_words(info)),
        ("changed on the command line", ", ".join(map(str, overrides)) or "nothing"),
    ]
    if isinstance(libraries, dict) and libraries:
        rows.append(("libraries", ", ".join(f"{name} {number}" for name, number in libraries.items())))
    return rows
