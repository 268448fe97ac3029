"""The answer of a study in one HDF5 file, the scenario inside."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path

import h5py

from .columns import columns
from .fields import sayable
from .made_as import is_named, must_be_readable
from .run import ODD
from .seal import is_whole, seal
from .soundness import ArchiveError, is_sound, must_be_sound
from .space import DATASET, FILE, hdf5_with_room
from .tables import unit_of, units_of

FORMAT = "sealdyn study 1"


def write_study(
    path, scenario_text: str, resolved: dict, meta: dict, answer: dict, units: dict, along=(), panels=()
) -> Path:
    """Write the answer of a study: whole as JSON (`/answer`), and every list of numbers or truths in it as a float64
    dataset `/data/KEY` (columns.py) with its unit, so that any HDF5 reader can plot it.  `units` and `along` as in
    `tables.variables` are kept as JSON, so that the archive can be shown without its study.
    `meta` becomes root attributes; `panels`, plain data, are kept so that the archive draws itself.  Replaces an
    existing file only when complete; returns its path."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    texts = {"scenario": scenario_text, "resolved": json.dumps(resolved), "answer": json.dumps(answer)}
    texts |= {"panels": json.dumps(list(panels))}
    numbers = [(key, column.values) for key, column in columns(answer).items() if column.values.dtype.kind in "fb"]
    meta = {**meta, "units": units, "along": dict(along)}
    size = sum(map(len, texts.values())) + len(json.dumps(meta)) + sum(8 * values.size for _, values in numbers)
    try:
        with hdf5_with_room(fresh, 4 * size + FILE + DATASET * len(numbers)) as file:
            _write(file, meta, texts, numbers, units_of(answer, units))
        os.replace(fresh, path)
    except BaseException:
        fresh.unlink(missing_ok=True)
        raise
    is_sound(path)
    return path


def _write(file, meta, texts, numbers, units) -> None:
    """All of a study, into an open file."""
    file.attrs["format"] = FORMAT
    file.attrs["program"] = "sealdyn"
    file.attrs["created"] = datetime.now(UTC).isoformat(timespec="seconds")
    for name, value in meta.items():
        value = sayable(value) if isinstance(value, str) else value
        file.attrs[name] = value if isinstance(value, str | int | float) else json.dumps(value)
    for name, text in texts.items():
        file.create_dataset(name, data=sayable(text), dtype=h5py.string_dtype())
    for key, values in numbers:
        column = file.create_dataset(f"data/{key}", data=values, dtype="<f8")
        column.attrs["units"] = unit_of(key, units)
        column.attrs["long_name"] = key
    seal(file)


def is_study(path) -> bool:
    """Whether there is the file of a study at `path`, of this format or another."""
    try:
        must_be_sound(path)
        with h5py.File(path, "r") as file:
            return is_named(str(file.attrs.get("format")), FORMAT)
    except (ArchiveError, OSError, RuntimeError):
        return False


def read_study(path) -> dict:
    """Everything of a study's file: `answer`, `scenario`, `resolved`, and the meta attributes (JSON ones decoded).
    Raises ArchiveError."""
    path = Path(path)
    if not path.is_file():
        raise ArchiveError(f"{path}: no such file")
    try:
        must_be_sound(path)
        with h5py.File(path, "r") as file:
            must_be_readable(file, path, (FORMAT,), "a sealdyn study")
            if not is_whole(file):
                raise ArchiveError(f"{path}: what it says was altered since it was written")
            info = {}
            for name, value in file.attrs.items():
                value = value.item() if hasattr(value, "item") else value
                if isinstance(value, str) and name not in ("name", "question") and value.startswith(("{", "[")):
                    value = json.loads(value)
                info[name] = value
            info["scenario"] = file["scenario"].asstr()[()]
            info["resolved"] = json.loads(file["resolved"].asstr()[()])
            info["answer"] = json.loads(file["answer"].asstr()[()])
            info["panels"] = json.loads(file["panels"].asstr()[()])
            info["written"] = info["answer"].get("written", {}) if isinstance(info["answer"], dict) else {}
            if not isinstance(info["answer"], dict) or not isinstance(info["study"], str):
                raise TypeError("its answer is no table")
            if not all(isinstance(info.get(name, {}), dict) for name in ("units", "along")):
                raise TypeError("its units or dimensions are no table")
            return info
    except ODD as error:
        words = " ".join(str(error).split())[:200]
        raise ArchiveError(f"{path}: damaged ({words or type(error).__name__})") from error
