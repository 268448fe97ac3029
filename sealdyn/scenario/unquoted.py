"""The commonest slip in a scenario file: a quantity whose number and unit stand without quotation marks."""

import re

PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
HEADER = re.compile(r"\s*\[+\s*([\w.\s-]+?)\s*\]+\s*(?:#.*)?")
KEY = re.compile(r"([\w.-]+)\s*=\s*(?![\s=])")
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
QUANTITY = re.compile(rf"(?<![\w.])({NUMBER}\s*[^\W\d][^,\]}}#\"'=]*)")


def unquoted_quantity(text: str, error: str) -> tuple[str, str, str] | None:
    """Key (dotted), found and expected of the quantity without quotation marks on which the TOML parser stumbled over
    `text`, by its message `error`; None if it was something else."""
    if not (place := PLACE.search(error)):
        return None
    row, column = int(place[1]), int(place[2]) - 1
    lines = text.splitlines()[:row]
    line = lines[-1] if len(lines) == row else ""
    for quantity in QUANTITY.finditer(line):
        # The parser stops within it: at the unit, or at the number's first character.
        if quantity.start() <= column <= quantity.end():
            written = quantity[1].strip()
            found = f"{written} without quotation marks (line {row})"
            return _key(lines, quantity.start()), found, f'a quantity with its unit in quotation marks, "{written}"'
    return None


def _key(lines: list[str], column: int) -> str:
    """Dotted key of what stands at a column of the last of the lines."""
    table = next((match[1] for line in reversed(lines[:-1]) if (match := HEADER.fullmatch(line))), "")
    for line in (lines[-1][:column], *reversed(lines[:-1])):
        if keys := [match for match in KEY.finditer(line)]:
            # Of an inline table, its own key first.
            inline = keys[:1] if "{" in line[: keys[-1].start()] else []
            parts = [table, *(match[1] for match in (*inline, keys[-1]))]
            return ".".join(dict.fromkeys(filter(None, parts)))
    return table
