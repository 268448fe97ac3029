"""sealdyn/analysis/sources/results.json: the rows of `sealdyn validate`, for pages that must be quick.

    python tests/benchmark/validation_results.py [SOURCE]...

Without names all sources; of the others the rows are left as they are.
"""

import json
import sys
from pathlib import Path

from sealdyn.analysis import sources
from sealdyn.analysis.sources import brief, checks, source_names

RESULTS = Path(sources.__file__).with_name("results.json")


def main(names: list[str]) -> None:
    """Compute the rows of these sources and keep them."""
    found = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    found |= {name: brief(name, rows) for name, rows in checks(names or source_names()).items()}
    RESULTS.write_text(json.dumps({name: found[name] for name in source_names() if name in found}, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
