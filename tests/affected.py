"""What a change of one file of the package touches: tests and kernels of files that import it, directly or not."""

import ast
import re
import shutil
import subprocess
import sys
from bisect import bisect
from collections import defaultdict
from itertools import accumulate
from pathlib import Path

from conftest import durations

from sealdyn.kernel_cache import kernel_folder
from sealdyn.numerics.kernel import MARK, _sum

ROOT = Path(__file__).parents[1]
# Known durations (s) that the cases of a step and of all before it may add up to.
STEPS = 10.0, 40.0, 130.0


def name_of(path: Path) -> str:
    """How a file is imported."""
    parts = path.with_suffix("").relative_to(ROOT).parts
    return parts[-1] if parts[0] == "tests" else ".".join(parts).removesuffix(".__init__")


def importers() -> dict[str, set[Path]]:
    """Name of a module or of a helper of the tests -> files that import it, and tests with the word for a film."""
    files = [path for room in ("sealdyn", "tests") for path in (ROOT / room).rglob("*.py")]
    films = {name_of(path).split(".")[2] for path in files if name_of(path).startswith("sealdyn.films.")}
    found = defaultdict(set)
    for path in files:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                room = path.parent.relative_to(ROOT).parts[: 1 - node.level or None] if node.level else ()
                module = ".".join([*room, *([node.module] if node.module else [])])
                for name in (module, *(f"{module}.{one.name}" for one in node.names)):
                    found[name].add(path)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and name_of(path).startswith("test_"):
                for film in films & set(re.findall(r"\w+", node.value)):
                    found[f"sealdyn.films.{film}"].add(path)
                    found[f"sealdyn.films.{film}.film"].add(path)
    return found


def distances(path: Path, found: dict[str, set[Path]]) -> dict[Path, int]:
    """File -> how many imports lie between it and `path`, of those that import it; `found` as of `importers`."""
    known, ring = {path: 0}, [path]
    for one in ring:
        beyond = found[name_of(one)] - known.keys()
        known |= dict.fromkeys(beyond, known[one] + 1)
        ring += sorted(beyond)
    return known


def steps(near: dict[Path, int]) -> list[list[str]]:
    """Test files of each step: the nearest first, then the cheapest, as many as its time allows."""
    known = {file: sum(times.values()) for file, times in durations()["files"].items()}
    tests = {path.relative_to(ROOT).as_posix(): far for path, far in near.items() if path.name.startswith("test_")}
    order = sorted((far, known.get(test.removeprefix("tests/"), 0.0), test) for test, far in tests.items())
    chosen = defaultdict(list)
    for (_, _, test), spent in zip(order, accumulate(cost for _, cost, _ in order), strict=True):
        chosen[bisect(STEPS, spent)].append(test)
    return [chosen[step] for step in range(len(STEPS)) if chosen[step]]


def keep_kernels(kernels: Path, env: dict, dropped: set[str]) -> None:
    """Kernels kept for today's sources, for a mutant's: all but those of files that import it."""
    shutil.rmtree(kernels, ignore_errors=True)
    call = "from sealdyn.kernel_cache import *; print(PREFIX + solvers_digest())"
    done = subprocess.run([sys.executable, "-c", call], env=env, capture_output=True, text=True, check=True)
    (folder := kernels / done.stdout.strip()).mkdir(parents=True)
    for file in kernel_folder().glob("*.nb[ic]"):
        stem, place = re.match(r"(\w+)\..*?-([\w.]+)-", file.name).groups()
        if f"sealdyn.{place}.{stem}" not in dropped and not place.startswith("outside"):
            content = file.read_bytes()[: -len(MARK) - 4].replace(kernel_folder().name.encode(), folder.name.encode())
            (folder / file.name).write_bytes(content + MARK + _sum(content))
