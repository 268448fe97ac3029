"""Published numbers beside what the program computes: the sources (sources/), one or all."""

import importlib
import pkgutil

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
            print(f"{', '.join(source.about(row) for row in rows if row['remark'] == remark)}: {remark}")
