"""HDF5 files that a stranger can read: run.py and run_writer.py for trajectories, study.py for the answers of studies,
as columns in tables.py; files.py for what all files have."""

from importlib import import_module
from typing import TYPE_CHECKING

from .files import READING_ERRORS, ArchiveError, file_stem, is_full, link_target, only_writer, partial_path
from .run import FIELD_TIME, Fields, Series, column, field, last_state, read_info
from .run_writer import ArchiveWriter

if TYPE_CHECKING:
    from .study import (
        answer_as_dataset,
        answer_tables,
        as_dataset,
        is_study,
        open_archive,
        read_study,
        write_study,
    )
    from .tables import columns_of

__all__ = [
    "FIELD_TIME",
    "READING_ERRORS",
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
    "file_stem",
    "is_full",
    "is_study",
    "last_state",
    "link_target",
    "only_writer",
    "open_archive",
    "partial_path",
    "read_info",
    "read_study",
    "write_study",
]


def __getattr__(name: str):
    """What a run alone does not need."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{'tables' if name == 'columns_of' else 'study'}"), name)
