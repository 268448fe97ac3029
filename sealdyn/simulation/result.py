"""What a run leaves: how it ended, its numbers, and its archive, on disk or in memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from ..archive import open_archive
from ..report.plot import Plot

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Result:
    """What a run leaves: `status` (a value of Status), a sentence, the summary as a dict (as `run --json` prints it,
    SI), and the path of the archive, or None and its `content` where it was kept in memory only.

    >>> result = sealdyn.run("fms.toml")
    >>> result.status, float(result.data.h_min[0])
    ('ok', 9.2e-06)
    >>> result.plot.orbit().savefig("orbit.pdf")
    """

    status: str
    message: str
    summary: dict[str, Any] = field(repr=False)
    archive: Path | None
    content: bytes | None = field(default=None, repr=False)

    @cached_property
    def data(self) -> xarray.Dataset:
        """All of the archive as an `xarray.Dataset` in memory, as `open_archive` has it: series over `time` with units,
        fields over `field_time` and their grid."""
        with self._at_hand() as path, open_archive(path) as lazy:
            return lazy.load()

    @property
    def plot(self) -> Plot:
        """Its figures: `overview()`, `orbit()`, `film()`, `spectrum()`, `poincare()`."""
        return Plot(self._at_hand)

    def _at_hand(self) -> AbstractContextManager[Path]:
        return at_hand(self.archive, self.content)


@contextmanager
def at_hand(archive: Path | None, content: bytes | None) -> Iterator[Path]:
    """The path of an archive, of one that is in memory only (`content`) for as long as the block lasts."""
    if content is None:
        yield archive
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "archive.h5"
        path.write_bytes(content)
        yield path
