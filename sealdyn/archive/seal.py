"""A digest of what an archive says in words and of the state it goes on from, so that a change to them is seen."""

import hashlib
import json

import h5py

SEAL = "seal"
# Texts beside the root attributes: of a run that is done, of a study.
STATE, TEXTS = "restart", ("scenario", "resolved", "answer")


def seal(file) -> None:
    """Seal an archive: its root attributes as they are, and its texts."""
    names = sorted(set(file.attrs) - {SEAL})
    if SEAL in file.attrs:
        del file.attrs[SEAL]
    file.attrs[SEAL] = f"{_digest(file, names)} {' '.join(names)}"


def is_whole(file) -> bool:
    """Whether an archive says what it said when it was sealed, whatever has been added; True of one without a seal."""
    text = file.attrs.get(SEAL)
    if text is None:
        return True
    digest, *names = str(text).split(" ")
    return set(names) <= set(file.attrs) and digest == _digest(file, names)


def _digest(file, names) -> str:
    said = {name: _plain(file.attrs[name]) for name in names}
    if STATE in file and "state" in file[STATE].attrs:
        said["/state"] = _plain(file[STATE].attrs["state"])
    for name in TEXTS:
        if isinstance(file.get(name), h5py.Dataset):
            said[f"/{name}"] = _plain(file[name][()])
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:16]


def _plain(value):
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return value.item() if hasattr(value, "item") else str(value)
