"""Sources: published numbers beside what the program computes, one file per source, found by file name.

What every source offers:

`TITLE`     a line: the source, what is held against it, the units of its table.
`FILM`      the film that it is held against, by the name of its file.
`COVERS`    what of a seal it stands for, in a few words.
`checks()`  a list of rows (dicts), one per printed number, SI units:
              source        str, publication and place in it
              quantity      str
              published     the printed number; None: none printed, or the source says that there is none
              deviation     what is computed over `published`, less 1; None without one
              roads_apart   largest difference of the methods, relative; None with one method only
              verdict       "agrees" | "rounding" (follows from the digits printed) | "print differs" (the error of the
                            source itself, explained in `remark`) | "unexplained" (not the printed number, though two
                            independent computations agree) | "FAILED"
              remark        str, "" if there is nothing to say
            and what else tells the rows of this source apart.
`COLUMNS`   of its table: heading, and key in a row; and if need be
`DIGITS`    of its numbers, 6 unless told, and
`shown(row)`  a row as its table has it, in units of a size to read.
`place(row)`  which line a remark speaks of, a few words.

results.json keeps the rows for pages that must be quick: tests/benchmark/validation_results.py writes it.
"""

import importlib
import json
import pkgutil
from importlib.resources import files


def source_names() -> list[str]:
    """Names of the sources there are, hyphenated."""
    return sorted(m.name.replace("_", "-") for m in pkgutil.iter_modules(__path__))


def wanted_sources(source: str | None) -> list[str]:
    """The name of one source ("zuk-1972", "zuk_1972"), or of all.  Raises ValueError for no such source."""
    names = source_names()
    wanted = names if source is None else [source.replace("_", "-")]
    if not set(wanted) <= set(names):
        raise ValueError(f'source: found "{source}"; expected one of {", ".join(names)}')
    return wanted


def source_module(name: str):
    """The source `name` (hyphenated)."""
    return importlib.import_module(f"{__name__}.{name.replace('-', '_')}")


def checks(names: list[str]) -> dict[str, list[dict]]:
    """The rows of each of these sources."""
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
    return json.loads(files(__name__).joinpath("results.json").read_text(encoding="utf-8"))


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
        shown, digits = getattr(source, "shown", dict), getattr(source, "DIGITS", 6)
        cells = [
            [*source.COLUMNS],
            *([_cell(key, row[key], digits) for key in source.COLUMNS.values()] for row in map(shown, rows)),
        ]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        print("\n" * (count > 0) + source.TITLE)
        for line in cells:
            print("  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip())
        for remark in dict.fromkeys(row["remark"] for row in rows if row["remark"]):
            print(f"{', '.join(source.place(row) for row in rows if row['remark'] == remark)}: {remark}")


def _cell(key: str, value, digits: int) -> str:
    """A value of a row as its table has it."""
    if value is None or isinstance(value, str):
        return "-" if value is None else value.replace("_", " ")
    return f"{100 * value:+.2f} %" if key == "deviation" else f"{value:.{digits}g}"
