"""Figures of a run for those who look at them in Python, drawn from its archive only."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .charts.page import Figure


class Plot:
    """The charts of one archive, each a matplotlib Figure; `figure.savefig("orbit.svg")` writes it.

    `at_hand()` a context that gives the archive's path."""

    def __init__(self, at_hand: Callable[[], AbstractContextManager[Path]]):
        self._at_hand = at_hand

    def overview(self, turns: float = 4.0) -> Figure:
        """Everything on one sheet; the enlarged panels show the last `turns` turns of the shaft."""
        return self._drawn("overview", turns=turns)

    def orbit(self, turns: float = 8.0) -> Figure:
        """Path of the relative tilt and of each ring's own, of the last `turns` turns."""
        return self._drawn("orbit", turns=turns)

    def film(self, turns: float = 6.0) -> Figure:
        """Film thickness around the circle over the last `turns` turns, and over the face where it is thinnest."""
        return self._drawn("film", turns=turns)

    def spectrum(self, turns: float | None = None) -> Figure:
        """Relative tilt, axial motion and film thickness in orders of the shaft speed, of the last `turns` turns (None:
        the last half of the run)."""
        return self._drawn("spectrum", turns=turns)

    def poincare(self) -> Figure:
        """Relative tilt and film thickness once a turn."""
        return self._drawn("poincare")

    def _drawn(self, chart: str, **settings) -> Figure:
        draw = importlib.import_module(f"{__package__}.charts.{chart}").draw
        with self._at_hand() as path:
            return draw(path, None, **settings)
