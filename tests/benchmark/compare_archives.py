"""Results of two commits beside each other: every shipped scenario run by both, archives compared.

`python tests/benchmark/compare_archives.py run FOLDER` runs all scenarios of this checkout into FOLDER (shortened to
at most 40 turns; a study is not run); `... compare OLD NEW` prints a row per scenario: the largest difference of any
series over its scale (thickest film, largest film force, the outer radius, the largest speed; of other units the
largest value of the series), beside the accuracy asked, or that every bit is equal.
"""

import json
import sys
import time
from pathlib import Path

import h5py
import numpy as np

SCENARIOS = Path(__file__).parents[2] / "scenarios"
TURNS = 40.0
# What is not compared: angles jump by a turn, the place of a minimum jumps where two are level.
LEFT_OUT = ("time", "shaft_angle", "relative_precession", "h_min_angle", "h_min_radius")


def run_all(folder: Path) -> None:
    """Archives of all scenarios into `folder`."""
    import sealdyn

    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(SCENARIOS.glob("*.toml")):
        scenario, begun = sealdyn.read_scenario(path), time.perf_counter()
        if (scenario.run.turns or 0.0) > TURNS:
            scenario = sealdyn.read_scenario(path, [f"run.turns={TURNS}"])
        result = sealdyn.simulate(scenario, folder / f"{path.stem}.h5")
        print(f"{path.stem}: {result.status}, {time.perf_counter() - begun:.2f} s", flush=True)


def series_of(path: Path) -> tuple[dict[str, np.ndarray], dict[str, float], float]:
    """Named series of an archive, the scales of their differences, and the accuracy that was asked."""
    with h5py.File(path) as file:
        found = {name: item for name, item in file.items() if isinstance(item, h5py.Dataset) and item.ndim == 1}
        units = {name: str(item.attrs.get("units", "")) for name, item in found.items()}
        series = {name: item[()] for name, item in found.items() if item.dtype.kind == "f"}
        accuracy, radius = float(file.attrs["accuracy"]), json.loads(file.attrs["resolved"])["film"]["outer_radius"]
    length, force = np.nanmax(series["h_min"]), np.nanmax(np.abs(series["film_force"]))
    pace = np.nanmax(np.abs(series["shaft_speed"])) or 1.0
    of_unit = {"m": length, "rad": length / radius, "m/s": length * pace, "rad/s": length / radius * pace,
               "N": force, "N m": force * radius}  # fmt: skip
    own = {name: np.nanmax(np.abs(values), initial=0.0) or 1.0 for name, values in series.items()}
    return series, {name: of_unit.get(units[name], own[name]) for name in series}, accuracy


def compare(old: Path, new: Path) -> list[dict]:
    """A row per archive that both folders hold: `name`, `accuracy`, `worst` (over its scale), `series`, `equal`."""
    rows = []
    for path in sorted(old.glob("*.h5")):
        (a, scales, accuracy), (b, _, _) = series_of(path), series_of(new / path.name)
        differences = {"(none)": 0.0}
        for name in sorted(set(a) & set(b) - set(LEFT_OUT)):
            same = len(a[name]) == len(b[name])
            differences[name] = float(np.nanmax(np.abs(a[name] - b[name])) / scales[name]) if same else np.inf
        worst = max(differences, key=differences.get)
        equal = set(a) == set(b) and all(np.array_equal(a[k], b[k], equal_nan=True) for k in a)
        rows.append({"name": path.stem, "accuracy": accuracy, "worst": differences[worst], "series": worst,
                     "equal": equal})  # fmt: skip
    return rows


if __name__ == "__main__":
    if sys.argv[1:2] == ["run"] and len(sys.argv) == 3:
        run_all(Path(sys.argv[2]))
    elif sys.argv[1:2] == ["compare"] and len(sys.argv) == 4:
        for row in compare(Path(sys.argv[2]), Path(sys.argv[3])):
            words = "equal to the bit" if row["equal"] else f"{row['worst']:.1e} in {row['series']}"
            print(f"{row['name']:28s} accuracy {row['accuracy']:.0e}: {words}")
    else:
        sys.exit(__doc__)
