"""The format of an archive: what this program reads, and what a later one has made."""

from .soundness import ArchiveError


def must_be_readable(file, path, formats: tuple[str, ...], what: str) -> None:
    """Raises ArchiveError for an open file that is in none of the `formats`, "NAME NUMBER", the newest first; `what`
    this program calls such a file."""
    made_as = str(file.attrs.get("format", ""))
    if made_as in formats:
        return
    if not is_named(made_as, formats[0]):
        raise ArchiveError(f"{path}: an HDF5 file, but not {what}")
    by = " ".join(str(file.attrs.get("version", "")).split())[:40]
    needed = f"sealdyn {by} or later" if by else "a newer sealdyn"
    raise ArchiveError(f'{path}: a "{made_as}", this program reads up to "{formats[0]}"; install {needed} for it')


def is_named(made_as: str, known: str) -> bool:
    """Whether a format is that of `known`, whatever its number."""
    name, _, number = made_as.rpartition(" ")
    return number.isdecimal() and name == known.rpartition(" ")[0]
