"""Commented scenarios to begin with, a file each."""

from importlib.resources import files


def kinds() -> list[str]:
    """Names of the seals that there is one of."""
    return sorted(file.name.removesuffix(".toml") for file in files(__name__).iterdir() if file.name.endswith(".toml"))


def template(kind: str) -> str:
    """The text of one of them."""
    return (files(__name__) / f"{kind}.toml").read_text(encoding="utf-8")
