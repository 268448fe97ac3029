"""Display units have one home: sealdyn/quantities.py.

Looked for in the source of the package, by syntax alone (not where units are read, and in the tables of sources, which
have their units):

- a pair or a mapping of a unit that people read (each name in the table of quantities but those of SI) with a number
  or another such pair: a table of units;
- in the braces of an f-string, a product or quotient with the factor of such a unit: a number formatted by hand;
- in report/ and in the signals, where nothing is computed, any product with a factor of a thousand and more.

Not seen: a factor bound to a name of its own, a unit spelled within a sentence, a conversion by np.degrees.
"""

import ast
from pathlib import Path

import pytest

from sealdyn import quantities

PACKAGE = Path(quantities.__file__).parent
ELSEWHERE = ("quantities.py", "units.py", "unit_names.py", "scenario/errors.py", "analysis/sources")
LOOKED_AT = {path.relative_to(PACKAGE).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}
SHOWN = {(name, factor) for rows in quantities.SIZES.values() for _, name, factor in rows}
SHOWN |= {(held.shown, held.factor) for held in quantities.QUANTITIES.values()}
NAMES = {spelled for name, factor in SHOWN if name and factor != 1.0 for spelled in (name, quantities.printed(name))}
FACTORS = {factor for _, factor in SHOWN} - {1.0}
# An identifier that a table of words has too ("h", "s", "g"): no unit where it stands alone beside a number.
SHORT = 1


def constant(node):
    return node.value if isinstance(node, ast.Constant) else None


def is_number(node) -> bool:
    """A literal number, or arithmetic with one."""
    if isinstance(node, ast.BinOp):
        return is_number(node.left) or is_number(node.right)
    return isinstance(constant(node), int | float) and not isinstance(constant(node), bool)


def is_unit(node) -> bool:
    return isinstance(constant(node), str) and constant(node) in NAMES and len(constant(node)) > SHORT


def by_hand(node, least: float) -> bool:
    """A product or quotient with a literal factor of a display unit, of size `least` and more."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult | ast.Div):
        return False
    sides = [constant(side) for side in (node.left, node.right)]
    return any(isinstance(value, int | float) and value in FACTORS and value >= least for value in sides)


def found_in(text: str, draws: bool = False) -> list[int]:
    """Lines at which a source has what only quantities.py may have; `draws`: it computes nothing."""
    lines = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Tuple | ast.List):
            told = [(a, b) for a, b in zip(node.elts, node.elts[1:], strict=False) if is_unit(a) and is_number(b)]
        elif isinstance(node, ast.Dict):
            told = [
                pair for pair in zip(node.keys, node.values, strict=True) if is_unit(pair[0]) and is_number(pair[1])
            ]
        elif isinstance(node, ast.FormattedValue):
            told = [part for part in ast.walk(node.value) if by_hand(part, 0.0)]
        else:
            told = [node] if draws and by_hand(node, 1e3) else []
        lines += [node.lineno] if told else []
    return lines


@pytest.mark.core
def test_no_file_has_units_of_its_own():
    found = {}
    for name, path in LOOKED_AT.items():
        draws = name.startswith(("report/", "dynamics/signals"))
        if not name.startswith(ELSEWHERE) and (lines := found_in(path.read_text(), draws)):
            found[name] = lines
    assert found == {}


@pytest.mark.core
@pytest.mark.parametrize(
    "source, draws, seen",
    [
        ('READ = {"Pa": ("bar", 1e-5)}', False, True),
        ('per = {"rpm": 30 / pi}', False, True),
        ('words = f"{1e6 * h:.4g} um"', False, True),
        ('words = f"{100 * share:.3g} %"', False, True),
        ("y = 1e6 * h", True, True),
        ("hours = 3600 * duration", False, False),
        ("near = 1e-6 * size", True, False),
        ('words = in_words("h_min", h)', True, False),
    ],
)
def test_what_is_seen(source, draws, seen):
    assert bool(found_in(source, draws)) == seen
