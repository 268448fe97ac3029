"""Do runs that are stopped and continued end as if nobody had stopped them, and are impossible scenes refused?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/unusual_runs.py continued|refused [scenes] [seed]

Random scenes of all the families (tests/families.py, tests/hard_families.py).  Continued: a scene is run into an
archive, stopped up to three times and gone on with; the archive must hold what that of the run holds which nobody
stopped, as exactly as asked, and end as it did, or say that it is not exact.  Refused: a scene with one key that makes
it impossible must be refused in one line that names the key.
"""

import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from hard_families import FAMILIES, impossible, one_of
from patterned_faces import scenario

from sealdyn.archive import column, read_info
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import with_values
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.selection import prepare_run
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers import sundials_direct

SEED, MOST_STOPS = 2026, 3
# How a refusal reads: the key to blame, what was found and what is expected, in one line.
REFUSED = re.compile(r"(\w+: )?(\[[\w.]+\]( \S+)?|\w+(\.\w+)*): found .+; expected .+")
LOOKED_AT = ("h_min", "relative_misalignment", "leakage", "friction_torque", "contact_force")
# Steps between two looks at whether to stop: often enough for short runs.
BLOCK = 20


def seal_of(drawn):
    """A drawn scene with its run, as a scenario."""
    run = dict(duration=drawn.duration, turns=None, accuracy=drawn.accuracy, start=drawn.start, solver="auto")
    return scenario(drawn.scene, **run)


def refused(number: int, seed: int = SEED) -> dict:
    """What an impossible scene shows: `wrong`, empty where it is refused in one line that names a key to blame."""
    random = np.random.default_rng([seed, number])
    drawn = one_of(str(random.choice(FAMILIES)), random)
    kinds = impossible(random, drawn)
    kind = sorted(kinds)[number % len(kinds)]
    row, wrong = {"number": number, "kind": kind, "words": drawn.words}, "taken"
    try:
        prepare_run(with_values(seal_of(drawn), kinds[kind]), allow_large=False)
    except (SceneError, ScenarioError) as error:
        said = str(error)
        wrong = "" if REFUSED.fullmatch(said) and not said.endswith("takes ") else f"says {said!r}"
    except Exception as error:
        wrong = f"{type(error).__name__}: {error}"
    return {**row, "wrong": wrong}


def continued(number: int, seed: int = SEED) -> dict:
    """What a scene shows that is stopped and continued: the largest `error` of a column, over the largest value of
    that of the whole run, in accuracies; `wrong`, empty where all is well."""
    random = np.random.default_rng([seed, number])
    drawn = one_of(str(random.choice(FAMILIES)), random)
    row, sundials_direct.BLOCK = {"number": number, "kind": "continued", "words": drawn.words}, BLOCK
    with tempfile.TemporaryDirectory() as folder:
        whole, part = Path(folder, "whole.h5"), Path(folder, "part.h5")
        seal, looks = seal_of(drawn), []
        try:
            first = simulate(seal, whole, stop=lambda: looks.append(1))
        except SceneError:
            return {**row, "kind": "no scene", "wrong": ""}
        last, stops = None, 0
        for after in random.integers(0, max(1, len(looks) // 2), random.integers(1, MOST_STOPS + 1)):
            left = iter(range(int(after)))
            last = simulate(seal, part, stop=lambda left=left: next(left, None) is None, resume=stops > 0)
            if last.status != "interrupted":
                break
            stops += 1
        if last.status == "interrupted":
            last = simulate(seal, part, resume=True)
        row |= {"stops": stops, "status": str(first.status), "met": last.summary["certificate"]["met"], "error": 0.0}
        if last.status != first.status:
            return {**row, "wrong": f"whole {first.status}, continued {last.status} ({last.message})"}
        for name in set(LOOKED_AT) & set(read_info(whole)["series"]):
            ours, theirs = column(part, name), column(whole, name)
            if ours.shape != theirs.shape:
                return {**row, "wrong": f"{len(ours)} rows, whole {len(theirs)}"}
            error = float(np.nanmax(np.abs(ours - theirs), initial=0.0)) / (float(np.nanmax(np.abs(theirs))) or 1.0)
            row["error"] = max(row["error"], error / drawn.accuracy)
    spoken = first.status != "ok" or row["met"] is not True
    return {**row, "wrong": "" if row["error"] <= 1.0 or spoken else f"{row['error']:.2g} accuracies apart"}


def main(what: str, count: int, seed: int):
    judged, kinds, wrong, worst, exact = {"refused": refused, "continued": continued}[what], Counter(), 0, 0.0, 0
    for number in range(count):
        row = judged(number, seed)
        kinds[row["kind"]] += 1
        wrong += bool(row["wrong"])
        worst = max(worst, row.get("error", 0.0))
        exact += row.get("error") == 0.0
        rest = " ".join(f"{key} {row[key]}" for key in ("stops", "status", "met", "error") if key in row)
        verdict = f"WRONG {row['wrong']} " if row["wrong"] else ""
        print(f"{number} {verdict}{row['kind']} {rest} {','.join(row['words'])}", flush=True)
    print(f"{count - wrong} of {count} as they must be: {dict(kinds)}")
    if what == "continued":
        print(f"largest difference {worst:.2g} accuracies, none to the last bit in {exact}")


if __name__ == "__main__":
    given = sys.argv[1:]
    main(given[0], *(int(word) for word in given[1:]), *(40, SEED)[len(given) - 1 :])
