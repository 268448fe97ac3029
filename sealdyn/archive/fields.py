"""Fields of a run in its archive: quantities over a grid at a few of its instants, and how any quantity is laid out."""

from typing import NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5p, h5s, h5t

TEXT_TYPE = h5py.string_dtype()
TEXT = h5t.py_create(TEXT_TYPE, logical=True)
ONE = h5s.create(h5s.SCALAR)
# The dimension of the instants at which fields are kept.
FIELD_TIME = "field_time"
# Rows of a series in one chunk: HDF5 takes 4 GiB.
MOST_IN_PLACE = 1 << 28


class Series(NamedTuple):
    """What a stranger must know of a column; `display_unit`, when given, is what people read it in, `display_factor`
    how many of it make one of `units`."""

    units: str
    long_name: str
    display_unit: str = ""
    display_factor: float = 1.0


class Fields(NamedTuple):
    """Fields of one grid, kept at `most` instants at most: `series` maps a field's name to its `Series`, `grid` that of
    a coordinate to its `Series` and values (m,), in the order of the fields' dimensions."""

    series: dict[str, Series]
    grid: dict[str, tuple[Series, np.ndarray]]
    most: int

    @property
    def shape(self) -> tuple[int, ...]:
        """Of one field at one instant."""
        return tuple(len(values) for _, values in self.grid.values())

    def over_time(self) -> dict[str, Series]:
        """All that grows with the instants: their times (s), and the fields."""
        return {FIELD_TIME: Series("s", "time of the fields", "ms", 1e3), **self.series}

    def checked(self, given: dict, kept: int) -> dict[str, np.ndarray]:
        """Fields as they are written; raises ValueError if they are others, or too many after `kept` instants."""
        arrays = {name: np.array(given[name], "<f8") for name in self.over_time()}
        count = len(arrays[FIELD_TIME])
        for name, values in arrays.items():
            if values.shape != (count, *(() if name == FIELD_TIME else self.shape)):
                raise ValueError(f"{name} has the shape {values.shape}, not that of {count} instants")
        if kept + count > self.most:
            raise ValueError(f"fields at {kept + count} instants, more than {self.most}")
        return arrays if count else {}

    def are_those_of(self, file) -> bool:
        """Whether an archive holds the same fields on the same grid."""
        return set(names_over(file, FIELD_TIME)) == set(self.over_time()) and all(
            name in file and np.array_equal(file[name][()], values) for name, (_, values) in self.grid.items()
        )


def scale_of(file, name: str) -> str | None:
    """Name of the dimension scale along a dataset's first dimension, its own if it is one; None: there is no dataset of
    this name."""
    item = file.get(name)
    # Groups (events, what a run goes on from) have no dimensions.
    if not hasattr(item, "dims"):
        return None
    return (item.name if item.is_scale else item.dims[0][0].name).removeprefix("/")


def names_over(file, scale: str) -> list[str]:
    """Names of the datasets whose first dimension is that of `scale`, the scale among them."""
    return [name for name in file if scale_of(file, name) == scale]


def reserve(file, name: str, series: Series, shape: tuple[int, ...], early: bool):
    """A dataset with room for `shape`, NaN until written, which stays where it is in the file: a single chunk, so that
    it can be shortened there, or in one piece where HDF5 has no chunk so large.  It has its place at once if `early`,
    else with its first values."""
    plan, most = h5p.create(h5p.DATASET_CREATE), None
    if shape[0] <= MOST_IN_PLACE:
        plan.set_chunk(tuple(max(length, 1) for length in shape))
        most = h5s.UNLIMITED, *shape[1:]
    plan.set_alloc_time(h5d.ALLOC_TIME_EARLY if early else h5d.ALLOC_TIME_LATE)
    plan.set_fill_value(np.array(np.nan))
    space = h5s.create_simple(shape, most)
    describe(h5d.create(file.id, name.encode(), h5t.IEEE_F64LE, space, plan), series._asdict())


def describe(item, attributes: dict):
    """Attributes (words, whole and other numbers) of an object of HDF5 (its low-level identifier: three times faster),
    in place of those that it has."""
    for name, value in attributes.items():
        if h5a.exists(item, name.encode()):
            h5a.delete(item, name.encode())
        data = np.array(utf8_text(value), TEXT_TYPE) if isinstance(value, str) else np.array(value)
        kind = TEXT if isinstance(value, str) else h5t.py_create(data.dtype)
        h5a.create(item, name.encode(), kind, ONE).write(data)


def utf8_text(text: str) -> str:
    """A text as HDF5 takes it: of a name that is no UTF-8 the odd bytes are spelt out."""
    return text.encode("utf-8", "backslashreplace").decode()


def attach_scale(file, scale: str, names, dimension: int = 0):
    """Make `scale` this dimension of all these datasets, by default the first."""
    along = h5d.open(file.id, scale.encode())
    h5ds.set_scale(along, scale.encode())
    for name in names:
        if name != scale:
            h5ds.attach_scale(h5d.open(file.id, name.encode()), along, dimension)


def create_fields(file, fields: Fields, instants: int, early: bool) -> None:
    """Room for so many instants of the fields (`early` as in `reserve`), their grid beside them as dimension scales."""
    for name, (series, values) in fields.grid.items():
        item = file.create_dataset(name, data=np.asarray(values, "<f8"))
        describe(item.id, series._asdict())
    for name, series in fields.over_time().items():
        reserve(file, name, series, (instants, *(() if name == FIELD_TIME else fields.shape)), early)
    for dimension, scale in enumerate((FIELD_TIME, *fields.grid)):
        attach_scale(file, scale, fields.series, dimension)
