"""What a run is going to take, reckoned before it hurts."""

import math
from dataclasses import dataclass

from ..dynamics.intervals import largest_value
from ..scene.scene import SceneError

# Bytes of a row of an archive; seconds of a turn that nothing undercuts (the reference seal at a loose accuracy).
ROW, TURN = 300, 2e-4
# Above these a run asks first: bytes of the archive, seconds.
LARGE, LONG = 10e9, 86400.0
# Beyond these there is no machine: turns, rows.
MOST = 1e12


@dataclass(frozen=True)
class Size:
    """Turns of the faster ring and rows of a run; bytes of its archive and seconds that it takes at least."""

    turns: float
    rows: float

    @property
    def bytes(self) -> float:
        """Of the archive, about."""
        return ROW * self.rows

    @property
    def seconds(self) -> float:
        """At least."""
        return TURN * self.turns

    @property
    def possible(self) -> bool:
        """On any machine."""
        return max(self.turns, self.rows) <= MOST

    def __str__(self):
        """In words."""
        return (
            f"{self.turns:.3g} turns, {self.rows:.3g} rows: an archive of {_bytes(self.bytes)}, {_time(self.seconds)}"
        )


def size_of(scenario) -> Size:
    """What a run of a scenario takes; instant, whatever its numbers."""
    shaft = largest_value(scenario.scene.shaft.speed)
    # A radial seal has no ring that turns beside the shaft.
    stator = largest_value(scenario.scene.stator.speed) if hasattr(scenario.scene, "stator") else 0.0
    settings = scenario.run
    turns = settings.turns
    if turns is None:
        turns = settings.duration * max(shaft, stator) / (2 * math.pi)
    rows = settings.samples
    if rows is None:
        rows = 1000 if shaft == 0.0 else turns * settings.samples_per_turn
    # Integers of any length.
    return Size(float(turns), float(min(rows, 10**300)))


def refuse_large(scenario, allowed: bool = False):
    """Raises SceneError for a run beyond any machine, and for a large one that is not `allowed`."""
    size, settings = size_of(scenario), scenario.run
    if size.possible and (allowed or (size.bytes <= LARGE and size.seconds <= LONG)):
        return
    if size.rows > size.turns and (not size.possible or size.bytes > LARGE):
        key = "run.samples" if settings.samples is not None else "run.samples_per_turn"
    else:
        key = "run.turns" if settings.turns is not None else "run.duration"
    less = f"fewer: at most {LARGE / ROW:.2g} rows and {LONG / TURN:.2g} turns"
    raise SceneError(key, str(size), f"{less}; or --yes (allow_large=True)" if size.possible else less)


def _bytes(count: float) -> str:
    return f"{count / 1e9:.3g} GB" if count < 1e15 else f"{count:.1e} bytes"


def _time(seconds: float) -> str:
    if seconds < 3600.0:
        return f"at least {seconds:.2g} s"
    if seconds < 86400.0:
        return f"at least {seconds / 3600:.2g} h"
    return f"at least {seconds / 86400:.3g} days" if seconds < 3e9 else f"at least {seconds / 3.156e7:.2g} years"
