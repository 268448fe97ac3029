"""What a design rule says of a seal."""

import math
from dataclasses import dataclass, field
from enum import StrEnum


class Verdict(StrEnum):
    """How a seal stands to a rule."""

    PASS = "pass"
    FAIL = "fail"
    NOTE = "note"
    """Worth knowing; the guide gives no limit, or says itself that it may be passed."""
    ACKNOWLEDGED = "acknowledged"
    """Broken on purpose, with a reason."""
    NOT_APPLICABLE = "not applicable"
    """The rule is for other seals, or a key that would tell is missing."""


@dataclass(frozen=True)
class Finding:
    """A verdict and the sentence `said` (without the source); the figure `value` in `unit` (SI) with its limits `least`
    and `most`, None where there are none; `numbers` that are told beside it, by name."""

    verdict: Verdict
    said: str
    value: float | None = None
    unit: str = ""
    least: float | None = None
    most: float | None = None
    numbers: dict = field(default_factory=dict)


def within(said, value, unit, least=None, most=None, beyond=Verdict.FAIL, **numbers) -> Finding:
    """A figure held against its limits, `beyond` which it gets that verdict."""
    inside = (-math.inf if least is None else least) <= value <= (math.inf if most is None else most)
    return Finding(Verdict.PASS if inside else beyond, said, value, unit, least, most, numbers)


def noted(said, value, unit, **numbers) -> Finding:
    """A figure without a limit."""
    return Finding(Verdict.NOTE, said, value, unit, numbers=numbers)


def missing(*keys: str) -> Finding:
    """Not told without one of these keys."""
    return Finding(Verdict.NOT_APPLICABLE, f"needs {' or '.join(keys)}", numbers={"needs": [*keys]})


def other_seals(said: str) -> Finding:
    """A rule for other seals than this."""
    return Finding(Verdict.NOT_APPLICABLE, said)
