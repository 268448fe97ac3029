"""HDF5 files that a stranger can read: run.py for trajectories, study.py for the answers of studies; dataset.py
shows both to xarray."""

from .dataset import answer_as_dataset, answer_tables, as_dataset, columns_of, open_archive, tables_as_dataset
from .fields import FIELD_TIME, Fields, Series
from .lock import only_writer
from .run import ODD, ArchiveWriter, column, field, followed, last_state, partial_path, read_info
from .soundness import ArchiveError
from .space import is_full
from .study import is_study, read_study, write_study

__all__ = [
    "FIELD_TIME",
    "ODD",
    "ArchiveError",
    "ArchiveWriter",
    "Fields",
    "Series",
    "answer_as_dataset",
    "answer_tables",
    "as_dataset",
    "column",
    "columns_of",
    "field",
    "followed",
    "is_full",
    "is_study",
    "last_state",
    "only_writer",
    "open_archive",
    "partial_path",
    "read_info",
    "read_study",
    "tables_as_dataset",
    "write_study",
]
