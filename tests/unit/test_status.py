"""How a run ended, and what a warning is about, is told by members, never by the words of a person's sentence."""

import ast
from pathlib import Path

import pytest

from sealdyn.status import Status

PACKAGE = Path(__file__).parents[2] / "sealdyn"
FILES = sorted(PACKAGE.rglob("*.py"))
# Variables that hold sentences.
SENTENCES = {"message", "said", "sentence", "warning"}


def words(node):
    """Status words among the constants of an expression."""
    inside = node.elts if isinstance(node, ast.Tuple | ast.List | ast.Set) else [node]
    return {item.value for item in inside if isinstance(item, ast.Constant)} & set(Status)


def offences(source):
    """Lines that compare, look up or match a status by its bare word, or ask how a sentence begins or what it has."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Compare):
            # SciPy's solvers have a status of their own.
            if ast.unparse(node.left) == "solver.status":
                continue
            for operator, left, right in zip(node.ops, [node.left, *node.comparators], node.comparators, strict=False):
                if isinstance(operator, ast.Eq | ast.NotEq) and (words(left) | words(right)):
                    yield node.lineno
                literal = isinstance(right, ast.Tuple | ast.List | ast.Set)
                if isinstance(operator, ast.In | ast.NotIn) and ((literal and words(right)) or sentence(right)):
                    yield node.lineno
        elif isinstance(node, ast.Dict):
            # A table from status words: how it ends with which exit code, colour or sentence.
            keys = [key for key in node.keys if key and words(key)]
            if len(keys) > 1:
                yield node.lineno
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            if node.func.attr in ("startswith", "endswith") and sentence(node.func.value):
                yield node.lineno
        elif isinstance(node, ast.MatchValue) and words(node.value):
            yield node.lineno


def sentence(node):
    """Whether an expression is a sentence: by its name, or an exception's text."""
    name = {ast.Name: "id", ast.Attribute: "attr"}.get(type(node))
    is_text = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "str"
    return (name and getattr(node, name) in SENTENCES) or is_text


@pytest.mark.core
def test_the_check_sees():
    for source in (
        'if row["status"] == "ok": pass',
        'if "failed" != status: pass',
        'if status in ("ok", "slow"): pass',
        'EXIT = {"ok": 0, "invalid": 2}',
        'x = [w for w in warnings if not warning.startswith("aliasing")]',
        'if "crushed" in str(error): pass',
        'if "crushed" in outcome.message: pass',
        'match status:\n    case "failed": pass',
    ):
        assert list(offences(source)), source


def test_the_check_leaves_alone():
    for source in ('if "failed" in row: pass', 'if row["kind"] == "run-in": pass', 'x = {"failed": 1}'):
        assert not list(offences(source)), source


def test_no_module_branches_on_words():
    for path in FILES:
        assert not list(offences(path.read_text())), path
