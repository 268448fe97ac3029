"""Accepted steps as observers see them, and what lies between them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..numerics.hermite import integrals, sample, sample_doubtful

# Steps kept to the left of what is worked on, and left for later on the right: neighbours for dense output.
OVERLAP = 4


@dataclass(frozen=True)
class Block:
    """Accepted steps of a segment: times `t` (m,) (s, of the segment), unknowns `ys` (m, size), derivatives `yps` (m,
    size; zero where the segment has a right-hand side).  New are the intervals between the steps `begin` and `end`, up
    to `until` (s) if the run ends before the last of them does; the other steps are neighbours.  `stiff`: by a method
    whose rates are only as exact as its tolerance where the scene's fastest decay magnifies that."""

    segment: object
    t: np.ndarray
    ys: np.ndarray
    yps: np.ndarray
    begin: int
    end: int
    until: float | None = None
    stiff: bool = False

    @cached_property
    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and rates, each (m, n), at the steps."""
        return self.segment.motion(self.ys, self.yps)

    @cached_property
    def slopes(self) -> np.ndarray | None:
        """The right-hand side (m, size) at the steps; None where a ring has no mass."""
        return None if np.any(self.segment.lacks_inertia) else self.segment.derivatives(self.t, self.ys)

    @cached_property
    def accelerations(self) -> np.ndarray | None:
        """Second derivatives (m, n) of the displacements at the steps; None where a ring has no mass."""
        slopes = self.slopes
        return None if slopes is None else np.ascontiguousarray(slopes[:, self.segment.rate_places])

    @cached_property
    def increments(self) -> np.ndarray:
        """Integrals (end - begin, size) of the right-hand side over each new step; every ring has mass."""
        return integrals(self.t, self.slopes, self.begin, self.end)

    @property
    def whole(self) -> int:
        """The last step up to which whole intervals belong to the run."""
        return self.end if self.until is None else self.end - 1

    def cut(self, until: float) -> "Block":
        """The block of a run that ends at `until` (s, of the segment)."""
        return self._with(end=int(np.searchsorted(self.t, until)), until=until)

    def only(self, step: int) -> "Block":
        """The block with one step new."""
        return self._with(begin=step, end=step + 1)

    def _with(self, **other) -> "Block":
        found = replace(self, **other)
        # What has been worked out stays.
        for name in ("motion", "slopes", "accelerations"):
            if name in self.__dict__:
                found.__dict__[name] = self.__dict__[name]
        return found

    def at(self, times) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and rates, each (k, n), at `times` (k,) (s, of the segment) inside the new steps.

        Rates are interpolated with the accelerations at the steps, as far as these can be trusted: the slope of the
        displacements' interpolant would magnify their error by one over the step.
        """
        first, last = max(0, self.begin - OVERLAP), min(len(self.t), self.end + OVERLAP + 1)
        begin, end, count, t = self.begin - first, self.end - first, last - first, self.t[first:last]
        (values, slopes), more = self.motion, self.accelerations
        out, slope = np.empty((2, len(times), values.shape[1]))
        sample(t, values[first:last], slopes[first:last], count, begin, end, times, out, slope)
        if more is not None and self.stiff:
            sample_doubtful(t, slopes[first:last], more[first:last], count, begin, end, times, slope)
        elif more is not None:
            sample(t, slopes[first:last], more[first:last], count, begin, end, times, slope, np.empty_like(slope))
        return out, slope

    def film_at(self, times) -> tuple:
        """The film's unknowns (k, n) at `times` (k,) (s), in a tuple; an empty one where it has none."""
        film = self.segment.film
        if film.start == film.stop:
            return ()
        first, last = max(0, self.begin - OVERLAP), min(len(self.t), self.end + OVERLAP + 1)
        x, x_rate = (np.ascontiguousarray(part[first:last, film]) for part in (self.ys, self.yps))
        out, slope = np.empty((len(times), x.shape[1])), np.empty((len(times), x.shape[1]))
        sample(self.t[first:last], x, x_rate, last - first, self.begin - first, self.end - first, times, out, slope)
        return (self.segment.film_between(times, *self.at(times), out),)
