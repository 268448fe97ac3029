"""Which keys a scenario file is written in: a later program may know others."""

from .. import __version__
from ..units import quoted
from .errors import ScenarioError

# Raised when a key is renamed, goes, or means something else; new keys alone do not raise it.
SCHEMA = 1


def refuse_newer(raw: dict, name: str) -> None:
    """Raises ScenarioError for the tables of a scenario whose `schema` is above SCHEMA: what else is unknown in it is
    not wrong, only newer."""
    found = raw.get("schema")
    if isinstance(found, int) and found > SCHEMA:
        expected = f"at most {SCHEMA}, all that sealdyn {__version__} reads: install a newer sealdyn for this file"
        raise ScenarioError(name, "schema", quoted(found), expected)
