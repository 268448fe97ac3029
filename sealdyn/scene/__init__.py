"""What a scenario may contain, as plain frozen data, and scenes made of scenes; no arrays, no files."""


class Strict:
    """A table of a scenario file: keys that it does not have are refused."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012
