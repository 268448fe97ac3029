"""Do the tests notice when a line of the package is wrong?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/mutants.py [mutants] [seed] [room ...]

Seeded mutants of the rooms (default: archive, scenario), one at a time in a copy of the tree: a comparison turned round
(< for <=, == for !=), a sum for a difference, a product for a quotient, a number one larger, "and" for "or", a
condition denied; in functions only.  A line each: file, line, what became of what, and the first test of plain `pytest`
that failed, or ESCAPED; at the end how many were caught.  Mutants of rooms that hold kernels compile them anew, a
minute or two each.
"""

import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from sealdyn.kernel_cache import kernel_folder

ROOT = Path(__file__).parents[2]
SWAPS = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Add: ast.Sub, ast.Sub: ast.Add,
    ast.Mult: ast.Div, ast.Div: ast.Mult, ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
LONGEST = 900


def places(tree) -> list[ast.AST]:
    """Nodes of functions that can be mutated."""
    found = []
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        for statement in function.body:
            for node in ast.walk(statement):
                number = isinstance(node, ast.Constant) and type(node.value) in (int, float)
                if number or isinstance(node, ast.Compare | ast.BinOp | ast.BoolOp | ast.If | ast.IfExp):
                    found.append(node)
    # Places within a sentence are not told.
    inside = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in ast.walk(node)}
    swapped = (node for node in found if not isinstance(node, ast.BinOp) or type(node.op) in SWAPS)
    return [node for node in swapped if id(node) not in inside]


def mutated(node) -> tuple[ast.AST, str]:
    """What is written anew of a node, and its text afterwards."""
    if isinstance(node, ast.If | ast.IfExp):
        return node.test, f"(not ({ast.unparse(node.test)}))"
    if isinstance(node, ast.Compare):
        node.ops[0] = SWAPS[type(node.ops[0])]()
    elif isinstance(node, ast.Constant):
        node.value += 1
    else:
        node.op = SWAPS[type(node.op)]()
    return node, f"({ast.unparse(node)})"


def with_text(text: str, node, words: str) -> str:
    """The source `text` with a node's own replaced by `words`."""
    lines = text.encode().splitlines(keepends=True)
    start = sum(map(len, lines[: node.lineno - 1])) + node.col_offset
    end = sum(map(len, lines[: node.end_lineno - 1])) + node.end_col_offset
    return (text.encode()[:start] + words.encode() + text.encode()[end:]).decode()


def first_failure(tree: Path) -> str:
    """The test that fails first in a copy of the tree, "" where none does."""
    call = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
    env = {**os.environ, "PYTHONPATH": str(tree), "NUMBA_CACHE_DIR": str(tree.with_name("kernels"))}
    try:
        done = subprocess.run(call, cwd=tree, env=env, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return "the time, which ran out"
    if done.returncode == 0:
        return ""
    told = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return told[0].split(" - ")[0] if told else f"pytest itself, code {done.returncode}"


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 2037
    rooms = sys.argv[3:] or ["archive", "scenario"]
    draw, caught = random.Random(seed), 0
    files = sorted(path for room in rooms for path in (ROOT / "sealdyn" / room).rglob("*.py"))
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        leave = shutil.ignore_patterns(".git", "__pycache__", ".*_cache")
        shutil.copytree(ROOT, tree, ignore=leave)
        # Mutants outside the kernels compile none.
        shutil.copytree(kernel_folder(), Path(folder) / "kernels" / kernel_folder().name)
        if failed := first_failure(tree):
            raise SystemExit(f"the tests fail as they are: {failed}")
        for _ in range(count):
            path = draw.choices(files, [path.stat().st_size for path in files])[0]
            text = path.read_text()
            if not (found := places(ast.parse(text))):
                continue
            node, words = mutated(draw.choice(found))
            before = " ".join(ast.get_source_segment(text, node).split())
            copy = tree / path.relative_to(ROOT)
            copy.write_text(with_text(text, node, words))
            failed = first_failure(tree)
            copy.write_text(text)
            caught += bool(failed)
            place = f"{path.relative_to(ROOT)}:{node.lineno}"
            print(f"{place} {before[:60]} -> {words[:60]}: {failed or 'ESCAPED'}", flush=True)
    print(f"{caught} of {count} caught")


if __name__ == "__main__":
    main()
