"""Runs and studies against equations in the tests' own words: scenes that nobody has tuned.

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/own_judgement.py [--seed 2029] [--scenes 40] [--kind NAME]

Kinds in turn (tests/own_judged.py, where the promise is told, too): a rub (liquid), a rub over a gas that stores with
an O-ring, wavy rough faces that rub, pads and waves over a gas that stores, waves on a liquid, a liquid with cavities,
runs of gas and cavities that are interrupted and go on, and the onset of contact.
"""

import argparse
import signal
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from own_judged import KINDS, LONGEST


def too_long(*anything):
    """Ends a scene."""
    raise TimeoutError


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=2029)
    parser.add_argument("--scenes", type=int, default=40)
    parser.add_argument("--kind", choices=[kind.__name__ for kind in KINDS])
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
    signal.signal(signal.SIGVTALRM, too_long)
    kinds = [kind for kind in KINDS if asked.kind in (None, kind.__name__)]
    table, number = {}, asked.first
    for k in range(asked.scenes):
        kind, found = kinds[k % len(kinds)], None
        while found is None:
            number, begun = number + 1, time.process_time()
            signal.setitimer(signal.ITIMER_VIRTUAL, 2.0 * LONGEST)
            try:
                found = kind(np.random.default_rng([asked.seed, number]))
            except (NotImplementedError, TimeoutError, AssertionError, np.linalg.LinAlgError) as reason:
                print(f"{kind.__name__} {number}: not judged, {reason!r}", flush=True)
            finally:
                signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        errors, promised, said, more = found
        worst = max(errors, key=errors.get)
        ratio = errors[worst] / promised
        table.setdefault(kind.__name__, []).append((len(errors), ratio, said))
        words = " ".join(f"{name} {error:.1e}" for name, error in errors.items())
        print(f"{'BREACH ' if ratio > 1.0 else ''}{kind.__name__} {number}: {worst} {ratio:.2f} of {promised:.1e}"
              f"{' said' if said else ''} ({more if isinstance(more, str) else f'{more:.2f}'}) {words} "
              f"{time.process_time() - begun:.0f} s", flush=True)  # fmt: skip
    print(f"{'kind':16} scenes  numbers  worst error over promised  warned")
    for name, rows in table.items():
        print(f"{name:16} {len(rows):6} {sum(row[0] for row in rows):8} {max(row[1] for row in rows):21.2f} "
              f"{sum(row[2] for row in rows):13}")  # fmt: skip


if __name__ == "__main__":
    main()
