"""Columns of numbers in HDF5 files that other programs wrote, as netCDF leaves them: packed, with samples that are
missing, units as rows of one.  HDF5 may crash or never end on such a file, which is read in a process of its own:

    python -m sealdyn.archive.columns FILE MOST NAME ...

prints JSON: the columns, or what is wrong with them."""

import json
import math
import os
import sys
from pathlib import Path

import h5py
import numpy as np

from .files import READING_ERRORS, ArchiveError, bound_this_process, held_in_words, must_have_an_end, read_apart

# Bytes of a chunk: a packed one may be far larger than its file.
MOST_CHUNK = 1 << 28
# Attributes of what stands for a missing sample; those of bounds, and how a value (as stored) is outside them.
FILLS = ("_fillvalue", "missing_value")
BOUNDS = {"valid_min": np.less, "valid_max": np.greater}


def read_columns(path: str | os.PathLike, names: tuple[str, ...], most: int) -> dict[str, tuple[list[float], str]]:
    """{name: (values, unit)} of the datasets `names`, whatever their case, at the root of an HDF5 file.

    values = stored * `scale_factor` + `add_offset`; `unit` is the attribute `units` or `unit`, whatever its case, ""
    without.  Raises ArchiveError for another shape than one row of at most `most` numbers, for samples that are missing
    (`_FillValue`, `missing_value`, outside of the valid range), and for attributes that say something else than that.
    **Source** NetCDF Climate and Forecast (CF) Metadata Conventions 1.10, sections 2.5.1, 3.1 and 8.1, and the NetCDF
    Users' Guide, attribute conventions (`_Unsigned`, `valid_range`)."""
    must_have_an_end(path)
    done, file_name = read_apart(__name__, os.path.abspath(path), str(most), *names), Path(path).name
    try:
        found = json.loads(done.stdout) if done and done.returncode == 0 else None
    except ValueError:
        found = None
    if found is None:
        how = "crashes on it" if done else "does not come to an end with it"
        raise ArchiveError(f"{file_name}: no readable HDF5 file (HDF5 {how})")
    if "wrong" in found:
        raise ArchiveError(f"{file_name}{found['wrong']}")
    return {name: (values, unit) for name, (values, unit) in found["columns"].items()}


def main() -> int:
    """The other process."""
    bound_this_process()
    path, most, *names = sys.argv[1:]
    try:
        with h5py.File(path, "r") as file:
            found = {"columns": _columns(file, names, int(most))}
    except ArchiveError as error:
        found = {"wrong": str(error)}
    except (*READING_ERRORS, MemoryError) as error:
        why = held_in_words(error) or f"no readable HDF5 file ({type(error).__name__})"
        found = {"wrong": f": {why}"}
    print(json.dumps(found))
    return 0


def _columns(file, names: list[str], most: int) -> dict[str, tuple[list[float], str]]:
    found = {}
    for key in file:
        name = key.strip().lower()
        if name not in names:
            continue
        if name in found:
            raise ArchiveError(f": {name} twice")
        try:
            if not isinstance(file.get(key, getlink=True), h5py.HardLink):
                raise ArchiveError("a link to elsewhere")
            found[name] = _column(file[key], most)
        except ArchiveError as error:
            raise ArchiveError(f", {name}: {error}") from None
    return found


def _column(held, most: int) -> tuple[list[float], str]:
    if not isinstance(held, h5py.Dataset) or held.shape is None or held.ndim != 1 or held.dtype.kind not in "fiu":
        raise ArchiveError("no row of numbers")
    if len(held) > most:
        raise ArchiveError(f"{len(held)} samples, at most {most}")
    if held.chunks and math.prod(held.chunks) * held.dtype.itemsize > MOST_CHUNK:
        raise ArchiveError(f"in chunks of more than {MOST_CHUNK} bytes")
    plan = held.id.get_create_plist()
    if plan.get_layout() == h5py.h5d.VIRTUAL or plan.get_external_count():
        raise ArchiveError("numbers that stand in other files")
    attributes = _attributes(held)
    stored, turn = held[()], 0
    if _text(attributes.pop("_unsigned", "")).lower() == "true" and stored.dtype.kind == "i":
        stored, turn = stored.view(stored.dtype.str.replace("i", "u")), 2 ** (8 * stored.dtype.itemsize)
    _refuse_missing(held, stored, attributes, turn)
    scale, offset = (_number(attributes, key, without) for key, without in (("scale_factor", 1.0), ("add_offset", 0.0)))
    units = {_text(attributes[key]) for key in ("unit", "units") if key in attributes}
    if len(units) > 1:
        raise ArchiveError(f"the units {' and '.join(sorted(units))}")
    values = stored.astype(float)
    packed = {"scale_factor", "add_offset"} & set(attributes)
    return (values * scale + offset if packed else values).tolist(), "".join(units)


def _attributes(held) -> dict:
    """The attributes of a dataset by their names in small letters."""
    found = {}
    for key, value in held.attrs.items():
        name = key.strip().lower()
        if name in found:
            raise ArchiveError(f"the attribute {name} twice")
        found[name] = value
    return found


def _refuse_missing(held, stored, attributes: dict, turn: int) -> None:
    """Raises ArchiveError for a sample that says by its value, as it is stored, that there is none; `turn`: what is
    added to negative numbers as `_Unsigned` has the values, else 0."""
    kind = stored.dtype
    fills = [(key, _numbers(attributes, key, kind, None, turn)) for key in FILLS if key in attributes]
    own = held.fillvalue
    if own != 0 and np.isfinite(own):
        # What was never written reads so; the program's own, without which it is zero.
        fills.append(("fill value", np.array([own]).astype(stored.dtype)))
    outside = [(key, np.isin(stored, values)) for key, values in fills]
    low, high = _numbers(attributes, "valid_range", kind, 2, turn) if "valid_range" in attributes else (None, None)
    given = {"valid_min": low, "valid_max": high}
    for key, beyond in BOUNDS.items():
        bound = _numbers(attributes, key, kind, 1, turn)[0] if key in attributes else given[key]
        if bound is not None:
            outside.append((key, beyond(stored, bound)))
    for key, where in outside:
        if where.any():
            raise ArchiveError(f"sample {int(np.argmax(where)) + 1} is missing, by its {key}")


def _number(attributes: dict, key: str, without: float) -> float:
    if key not in attributes:
        return without
    value = float(_numbers(attributes, key, None, 1)[0])
    if not math.isfinite(value) or (key == "scale_factor" and value == 0.0):
        raise ArchiveError(f"the attribute {key} is {value:g}")
    return value


def _numbers(attributes: dict, key: str, kind, count: int | None = None, turn: int = 0) -> np.ndarray:
    """Numbers of an attribute, (count,), of the type `kind` of what is stored where they are compared with it; `turn`
    is added to negative ones."""
    values = np.atleast_1d(np.asarray(attributes[key]))
    if values.dtype.kind not in "fiu" or values.ndim != 1 or len(values) != (count or max(1, len(values))):
        raise ArchiveError(f"the attribute {key} is not {count or 'one or more'} number{'s' * (count != 1)}")
    if kind is not None and kind.kind == "f":
        # 1e20 in single precision is another number than in double.
        return values.astype(kind)
    # Whole numbers, however wide: -1000 is below every byte, whatever its sign is taken for.
    return np.array([int(v) + turn * int(v < 0) for v in values]) if turn and values.dtype.kind == "i" else values


def _text(value) -> str:
    """The words of an attribute that is a text, or a row of one."""
    row = np.atleast_1d(np.asarray(value, dtype=object if isinstance(value, str | bytes) else None)).ravel()
    if isinstance(value, h5py.Empty) or len(row) != 1 or not isinstance(row[0], str | bytes):
        raise ArchiveError("the unit is no text")
    words = row[0].decode() if isinstance(row[0], bytes) else row[0]
    return words.strip("\0 \t\n")


if __name__ == "__main__":
    # HDF5's own way to end may crash, too.
    code = main()
    sys.stdout.flush()
    os._exit(code)
