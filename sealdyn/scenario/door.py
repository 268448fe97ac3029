"""The door of the reader: how deep, long and many what comes in may be, before anything in it is read or searched.

Files, `--set`, the scenarios of archives, settings of studies and tables made in Python all pass here; behind it a text
is one that a terminal can print, a key is a string, an integer one that Python prints, and whatever goes down the
tables comes to an end.
"""

import re
from typing import Any

import numpy as np

from ..units import quoted
from .errors import ScenarioError

# Levels of tables and lists, characters of a key and of a string, entries in all (the samples of two motions and their
# like), and the largest integer.
DEEPEST, LONGEST_KEY, LONGEST_STRING, MOST_ENTRIES, LARGEST = 20, 200, 10_000, 2_000_000, 10**40
# Characters of a text, which may hold the samples of motions.
MOST_CHARACTERS = 1 << 26
# Dotted keys beyond any table, which a TOML parser goes through once for each of their parts, and digits in a row that
# no number has: some parsers take the square of their count.
PART = r"""(?:"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+'|[^\s.=,#\[\]{}"']++)"""
DEEP_KEY = re.compile(rf"(?<![^\s.=,#\[\]{{}}])(?:{PART}[ \t]*+\.[ \t]*+){{{DEEPEST}}}")
LONG_NUMBER = re.compile(r"(?<!\d)\d{2000}")


def refuse_unreadable(text: str, name: str) -> None:
    """Raises ScenarioError for a text of the scenario `name` that would take a parser long."""
    if not isinstance(text, str):
        raise ScenarioError(name, "", quoted(text), "text")
    if len(text) > MOST_CHARACTERS:
        raise ScenarioError(name, "", f"{len(text)} characters", f"at most {MOST_CHARACTERS}")
    if surrogate := _surrogate(text):
        raise ScenarioError(name, "", f"half a character ({surrogate})", "text in UTF-8")
    for pattern, what in ((DEEP_KEY, "tables too deep"), (LONG_NUMBER, "a number of thousands of digits")):
        if place := pattern.search(text):
            line = text.count("\n", 0, place.start()) + 1
            raise ScenarioError(name, "", f"{what} (line {line})", "a scenario file (TOML)")


def refuse_unbounded(tree: Any, name: str, key: str = "") -> None:
    """Raises ScenarioError for tables of the scenario `name` that are deeper, longer or more than a scenario's, or hold
    keys that are no strings; `key` is the path to them."""
    left, entries = [(tree, key, 0)], 0
    while left:
        held, path, depth = left.pop()
        if isinstance(held, np.ndarray):
            held = held.tolist()
        if isinstance(held, dict | list | tuple):
            entries += len(held)
            if depth >= DEEPEST:
                raise ScenarioError(name, path, "tables too deep", "at most 3 levels")
            if entries > MOST_ENTRIES:
                raise ScenarioError(name, path, f"more than {MOST_ENTRIES} entries", "fewer")
        if isinstance(held, dict):
            for step, below in held.items():
                _refuse_key(step, name, path)
                left.append((below, f"{path}.{step}" if path else step, depth + 1))
        elif isinstance(held, list | tuple):
            # Numbers by the thousand are neither long nor deep.
            left += [(below, path, depth + 1) for below in held if not isinstance(below, float)]
        elif isinstance(held, str):
            _refuse_string(held, name, path)
        elif isinstance(held, int) and abs(held) > LARGEST:
            raise ScenarioError(name, path, quoted(held, 40), f"a number of at most {LARGEST:.0e} in size")


def _refuse_key(key: Any, name: str, path: str) -> None:
    if not isinstance(key, str):
        raise ScenarioError(name, path, f"the key {quoted(key)}", "a string as a key")
    if len(key) > LONGEST_KEY or _surrogate(key):
        raise ScenarioError(
            name, path, f"the key {quoted(key)}", f"a key of at most {LONGEST_KEY} characters, in UTF-8"
        )


def _refuse_string(words: str, name: str, path: str) -> None:
    if len(words) > LONGEST_STRING:
        raise ScenarioError(name, path, f"a string of {len(words)} characters", f"at most {LONGEST_STRING}")
    if surrogate := _surrogate(words):
        raise ScenarioError(name, path, f"half a character ({surrogate})", "text in UTF-8")


def _surrogate(text: str) -> str:
    """The half of a character in a text, which no file can hold, as code; "" if there is none."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        return f"U+{ord(text[error.start]):04X}"
    return ""
