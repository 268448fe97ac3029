"""Published numbers beside what the program computes: the sources (sources/), one or all."""

import importlib
import json
import pkgutil
from importlib.resources import files

from . import sources


def source_names() -> list[str]:
    """Names of the sources there are, hyphenated."""
    return sorted(m.name.replace("_", "-") for m in pkgutil.iter_modules(sources.__path__))


def source_module(name: str):
    """The source `name` (hyphenated)."""
    return importlib.import_module(f"{sources.__name__}.{name.replace('-', '_')}")


def checks(names: list[str]) -> dict[str, list[dict]]:
    """The rows of each of these sources (sources/__init__.py says what a row has)."""
    return {name: source_module(name).checks() for name in names}


KEPT = ("quantity", "published", "deviation", "verdict", "remark")


def brief(name: str, rows: list[dict]) -> list[dict]:
    """What results.json keeps of the rows of a source: `where` in it and the columns KEPT, deviations to two digits."""
    source = source_module(name)
    return [
        {"where": source.place(row), **{key: row[key] for key in KEPT},
         "deviation": None if row["deviation"] is None else float(f"{row['deviation']:.2g}")}
        for row in rows
    ]  # fmt: skip


def stored_rows() -> dict[str, list[dict]]:
    """The rows of every source as they were last computed (`brief`)."""
    return json.loads(files(sources).joinpath("results.json").read_text(encoding="utf-8"))


def sources_of_film(film: str) -> list[dict]:
    """Sources that a film was held against: name, title, what of a seal each `covers`, `command` that computes it anew,
    `counts` of its verdicts and its rows (`stored_rows`)."""
    found = []
    for name, rows in stored_rows().items():
        source, verdicts = source_module(name), [row["verdict"] for row in rows]
        if film == source.FILM:
            counts = {verdict: verdicts.count(verdict) for verdict in dict.fromkeys(verdicts)}
            found.append({"name": name, "title": source.TITLE, "covers": source.COVERS,
                          "command": f"sealdyn validate {name}", "counts": counts, "rows": rows})  # fmt: skip
    return found


def report(found: dict[str, list[dict]]) -> None:
    """Print what `checks` returns: a table per source, its remarks below."""
    for count, (name, rows) in enumerate(found.items()):
        source = source_module(name)
        cells = [source.HEAD, *map(source.cells, rows)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        print("\n" * (count > 0) + source.TITLE)
        for line in cells:
            print("  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip())
        for remark in dict.fromkeys(row["remark"] for row in rows if row["remark"]):
            print(f"{', '.join(source.place(row) for row in rows if row['remark'] == remark)}: {remark}")
