"""Do the tests notice when a line of the package is wrong?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/mutants.py [--seed 1] [--count 60] [--only N ...]

Seeded mutants, half of them in compiled kernels, a quarter each in the rooms archive and scenario, one at a time in a
copy of the tree: another sum, product, comparison or connective, a number 1 % or one larger, a truth value or a
condition denied, `abs` dropped, min for max, a statement left out.  Tests run in steps until one fails, and passes
without the mutant: those that import the file first, plain `pytest` last.  A line each: number, file, line, what became
of what, step and test, or ESCAPED.
"""

import argparse
import ast
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from copy import copy
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from affected import ROOT, distances, importers, keep_kernels, name_of, steps

KERNEL_ROOMS = "dynamics", "faces", "films", "numerics", "radial_seals", "solvers"
SWAPS = {
    ast.Lt: (ast.LtE, ast.Gt), ast.LtE: (ast.Lt, ast.GtE), ast.Gt: (ast.GtE, ast.Lt), ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,), ast.IsNot: (ast.Is,), ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,), ast.Add: (ast.Sub,), ast.Sub: (ast.Add,), ast.Mult: (ast.Div,), ast.Div: (ast.Mult,),
    ast.And: (ast.Or,), ast.Or: (ast.And,),
}  # fmt: skip
EXTREMES = {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum"}
LONGEST = 2400


def parts(node):
    """A node and all in it that is executed: no annotations, decorators, sentences or texts for a debugger."""
    if not isinstance(node, ast.JoinedStr) and getattr(node, "name", "") not in ("__repr__", "__str__"):
        yield node
        for field, below in ast.iter_fields(node):
            for part in below if isinstance(below, list) else [below]:
                if isinstance(part, ast.AST) and field not in ("annotation", "returns", "decorator_list"):
                    yield from parts(part)


def changes(node):
    """(kind, what is written anew, its text afterwards): the ways in which a node can be wrong."""
    compares = isinstance(node, ast.Compare)
    op = node.ops[0] if compares else getattr(node, "op", None)
    for other in SWAPS.get(type(op), ()):
        new = copy(node)
        new.ops, new.op = [other(), *getattr(node, "ops", [])[1:]], other()
        yield "comparison" if compares else type(op).__name__, node, ast.unparse(new)
    if isinstance(node, ast.Constant) and isinstance(value := node.value, int | float):
        larger = 1.01 * value if type(value) is float and value else value + 1
        yield type(value).__name__, node, repr(not value if type(value) is bool else larger)
    elif isinstance(node, ast.If | ast.IfExp | ast.While):
        yield "condition", node.test, f"not ({ast.unparse(node.test)})"
    elif isinstance(node, ast.Call):
        *before, name = ast.unparse(node.func).split(".")
        if name in ("abs", "fabs"):
            yield "abs", node, ast.unparse(node.args[0])
        elif name in EXTREMES:
            yield "extreme", node.func, ".".join([*before, EXTREMES[name]])
    target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
    called = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    if called or isinstance(node, ast.AugAssign) or isinstance(target, ast.Subscript | ast.Attribute):
        yield "statement", node, "pass"


def mutants(seed: int, count: int):
    """(file, node, its text afterwards) of so many mutants; in each part of the draw every kind is as likely."""
    draw = random.Random(seed)
    shares = (KERNEL_ROOMS, count // 2), (("archive",), count // 4), (("scenario",), count - count // 2 - count // 4)
    for rooms, share in shares:
        kinds = defaultdict(list)
        for path in sorted(path for room in rooms for path in (ROOT / "sealdyn" / room).rglob("*.py")):
            tree = ast.parse(path.read_text())
            functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
            kernels = [one for one in functions if re.match(r"@\w+_kernel|@c_function", ast.unparse(one))]
            for part in kernels if rooms is KERNEL_ROOMS else [tree]:
                for node in parts(part):
                    for kind, place, words in changes(node):
                        kinds[kind].append((path, place, words))
        for _ in range(share):
            places = kinds[draw.choice(sorted(kinds))]
            yield places.pop(draw.randrange(len(places)))


def with_text(text: str, node, words: str) -> str:
    """The source `text` with a node's own replaced by `words`."""
    lines = text.encode().splitlines(keepends=True)
    start = sum(map(len, lines[: node.lineno - 1])) + node.col_offset
    end = sum(map(len, lines[: node.end_lineno - 1])) + node.end_col_offset
    return (text.encode()[:start] + words.encode() + text.encode()[end:]).decode()


def first_failure(tree: Path, env: dict, tests: list[str]) -> str:
    """The test that fails first in a copy of the tree, "" where none does."""
    call = [sys.executable, "-m", "pytest", "-x", "-n", "0", "-p", "no:cacheprovider", *tests]
    shutil.rmtree(tree / ".hypothesis", ignore_errors=True)
    try:
        done = subprocess.run(call, cwd=tree, env=env, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return "the time, which ran out"
    told = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", done.stdout, re.MULTILINE)
    return (told[1] if told else f"pytest itself, code {done.returncode}") if done.returncode else ""


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--count", type=int, default=60)
    words.add_argument("--only", type=int, nargs="+", help="numbers of mutants (default all)")
    asked = words.parse_args()
    found, escaped = importers(), 0
    with tempfile.TemporaryDirectory() as folder:
        tree, kernels = Path(folder) / "tree", Path(folder) / "kernels"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".git", "__pycache__", ".*_cache"))
        env = {**os.environ, "PYTHONPATH": str(tree)}
        if not asked.only and (failed := first_failure(tree, env, [])):
            raise SystemExit(f"the tests fail as they are: {failed}")
        env["NUMBA_CACHE_DIR"] = str(kernels)
        for number, (path, node, new) in enumerate(mutants(asked.seed, asked.count), 1):
            if asked.only and number not in asked.only:
                continue
            text, copied, near = path.read_text(), tree / path.relative_to(ROOT), distances(path, found)
            before = " ".join(ast.get_source_segment(text, node).split())
            print(f"{number} {path.relative_to(ROOT)}:{node.lineno} {before[:60]} -> {new[:60]}", end=": ", flush=True)
            for step, tests in enumerate([*steps(near), []], 1):
                copied.write_text(with_text(text, node, new if isinstance(node, ast.stmt) else f"({new})"))
                keep_kernels(kernels, env, {name_of(one) for one in near})
                failed = first_failure(tree, env, tests)
                copied.write_text(text)
                keep_kernels(kernels, env, set())
                if "::" in failed and first_failure(tree, env, [failed]):
                    raise SystemExit(f"a test fails as it is: {failed}")
                if failed:
                    failed = f"{step} {failed}"
                    break
            escaped += not failed
            print(failed or "ESCAPED", flush=True)
    print(f"{escaped} escaped")


if __name__ == "__main__":
    main()
