"""HDF5 files that a stranger can read: run.py for trajectories, study.py for the answers of studies."""

from .fields import FIELD_TIME, Fields, Series
from .run import ArchiveError, ArchiveWriter, column, field, last_state, open_archive, partial_path, read_info
from .study import read_study, write_study

__all__ = [
    "FIELD_TIME",
    "ArchiveError",
    "ArchiveWriter",
    "Fields",
    "Series",
    "column",
    "field",
    "last_state",
    "open_archive",
    "partial_path",
    "read_info",
    "read_study",
    "write_study",
]
