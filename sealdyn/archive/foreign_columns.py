"""Columns of numbers in an HDF5 file of anybody's."""

from pathlib import Path

import h5py
import numpy as np

from .run import ODD
from .soundness import ArchiveError


def read_columns(path, names: tuple[str, ...], most: int) -> dict[str, tuple[list[float], str]]:
    """{name: (values, unit)} of those of the `names` that are datasets at the root of an HDF5 file; `unit` is their
    attribute `units`, empty without.  Raises ArchiveError for another shape than one row of at most `most` numbers."""
    found = {}
    try:
        with h5py.File(path, "r") as file:
            for name in names:
                held = file.get(name)
                if held is None:
                    continue
                if not isinstance(held, h5py.Dataset) or held.ndim != 1 or held.dtype.kind not in "fiu":
                    raise ArchiveError(f"{Path(path).name}: {name} is no row of numbers")
                if len(held) > most:
                    raise ArchiveError(f"{Path(path).name}: {len(held)} samples, at most {most}")
                unit = held.attrs.get("units", "")
                unit = unit.decode() if isinstance(unit, bytes) else str(unit)
                found[name] = np.asarray(held[()], float).tolist(), unit
    except ODD as error:
        raise ArchiveError(f"{Path(path).name}: no readable HDF5 file ({type(error).__name__})") from None
    return found
