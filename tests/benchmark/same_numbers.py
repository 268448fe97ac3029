"""Regression of numbers: the `--json` of every scenario's run and of every study on its timed scenario.

    python tests/benchmark/same_numbers.py keep numbers.json [NAME ...]     (NAME: a scenario's or a study's)
    python tests/benchmark/same_numbers.py compare before.json after.json

A refactoring changes no number: every finite number, null, truth value, status, enumeration and exit code stands under
its old key, equal to the bit on one machine.  Sentences are not compared; the keys in EXCEPTED are not either.
Commands run from this checkout, one after the other; `compare` ends with exit code 1 where anything differs.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Times of the clock or of the processor, paths, and the machine: what two runs of one program do not share.
EXCEPTED = {"wall_time", "wall", "processor", "seconds", "time_ratio", "archive", "figure", "machine", "busy", "cost"}
# Too long in full; the numbers of their first turns are compared.
SHORTENED = {"rub": ["--set", "run.turns=60"], "rub_chaotic": ["--set", "run.turns=40"]}
# An enumeration is one word; a sentence has blanks, a path has slashes.
WORD = re.compile(r"[\w.+-]*")
STUDIES = """
from sealdyn.studies import study_names
from sealdyn.studies._runner import study_module
import json
def timed(module):
    return module.INFO.timed if hasattr(module, "INFO") else module.TIMED
print(json.dumps({name: timed(study_module(name.replace("-", "_")))[0] for name in study_names()}))
"""


def commands() -> dict[str, list[str]]:
    """Name -> arguments of `sealdyn`, scenarios first."""
    paths = {path.stem: path for path in sorted((ROOT / "scenarios").rglob("*.toml"))}
    found = {name: ["run", str(path), *SHORTENED.get(name, [])] for name, path in paths.items()}
    asked = subprocess.run([sys.executable, "-c", STUDIES], cwd=ROOT, capture_output=True, text=True, check=True)
    for study, line in json.loads(asked.stdout).items():
        scenario, *flags = line.split()
        found[f"study {study}"] = ["study", study, str(paths[scenario]), *flags, "--workers", "1"]
    return found


def kept(arguments: list[str]) -> dict:
    """Exit code and JSON of one command, from a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "kept.h5")
        line = [sys.executable, "-m", "sealdyn.cli", *arguments, "--json", "--no-plot", "--out", out]
        done = subprocess.run(line, cwd=ROOT, capture_output=True, text=True)
    return {"code": done.returncode, "json": json.loads(done.stdout) if done.stdout.strip() else done.stderr[-500:]}


def leaves(tree, path=()):
    """(path, value) of everything that is compared."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            if key not in EXCEPTED:
                yield from leaves(value, (*path, key))
    elif isinstance(tree, list):
        # A list of sentences may become shorter; one of numbers, rows or words may not.
        if not all(isinstance(value, str) for value in tree):
            yield (*path, "length"), len(tree)
            for k, value in enumerate(tree):
                yield from leaves(value, (*path, k))
    elif not isinstance(tree, str) or WORD.fullmatch(tree):
        yield path, tree


def differences(before: dict, after: dict) -> list[str]:
    """A line for every leaf of `before` that `after` lacks or has otherwise."""
    there = dict(leaves(after))
    nothing = object()
    found = []
    for path, value in leaves(before):
        now = there.get(path, nothing)
        if now is nothing or now != value or type(now) is not type(value):
            found.append(f"{'/'.join(map(str, path))}: {value!r} -> {'absent' if now is nothing else repr(now)}")
    return found


def keep(file: Path, names: list[str]) -> None:
    asked = commands()
    chosen = [name for name in asked if not names or name in names or name.removeprefix("study ") in names]
    found = json.loads(file.read_text()) if file.exists() else {}
    for name in chosen:
        found[name] = kept(asked[name])
        print(f"{name}: exit {found[name]['code']}", flush=True)
        file.write_text(json.dumps(found))


def compare(before: Path, after: Path) -> int:
    one, other = (json.loads(path.read_text()) for path in (before, after))
    bad = 0
    for name in (name for name in one if name in other):
        lines = differences(one[name], other[name])
        bad += bool(lines)
        count = sum(1 for _ in leaves(one[name]))
        print(f"{name}: {count} values, {len(lines)} differ")
        for line in lines[:12]:
            print(f"    {line}")
    absent = [name for name in one if name not in other]
    print(f"{len(one) - len(absent)} commands compared, {bad} differ" + (f"; not kept: {absent}" if absent else ""))
    return int(bad > 0)


def main():
    match sys.argv[1:]:
        case ["keep", file, *names]:
            keep(Path(file), names)
        case ["compare", before, after]:
            sys.exit(compare(Path(before), Path(after)))
        case _:
            print(__doc__)
            sys.exit(2)


if __name__ == "__main__":
    main()
