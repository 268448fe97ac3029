"""The slow scale of wear: a radial profile that advances over hours by rates averaged over short runs.

**Source** Archard's law, *J. Appl. Phys.* 24 (1953) 981; the step is ROS34PW2 of Rang & Angermann, *BIT* 45 (2005) 761,
a linearly implicit pair of orders 3(2) that keeps its order with any approximation of the rates' slope; projection
by consistent masses kept positive as in flux-corrected transport, Zalesak, *J. Comput. Phys.* 31 (1979) 335.
**Valid** rates that depend on the profile alone once the motion has settled: hours against milliseconds.

What limits a step: the pressure of rough faces changes over a fraction of the roughness, so the *shape* of the profile
relaxes while about that depth is worn, and an explicit step could wear no more at a time for all the hours that
follow.  The implicit step may: where the profile has its lasting shape it grows without bound, for the ring follows
the uniform part.  On the way there the error of the pair limits it, and `allowed`, the most by which the shape may
change in one step.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from ...status import Status

# ROS34PW2: stage positions, their implicit parts, weights, weights of order 2.
GAMMA = 0.435866521508459
ALPHA = np.array([
    [0.0, 0.0, 0.0, 0.0],
    [0.87173304301691801, 0.0, 0.0, 0.0],
    [0.84457060015369423, -0.11299064236484185, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
])  # fmt: skip
IMPLICIT = np.array([
    [GAMMA, 0.0, 0.0, 0.0],
    [-0.87173304301691801, GAMMA, 0.0, 0.0],
    [-0.90338057013044082, 0.054180672388095326, GAMMA, 0.0],
    [0.24212380706095346, -1.2232505839045147, 0.54526025533510214, GAMMA],
])  # fmt: skip
WEIGHTS = np.array([0.24212380706095346, -1.2232505839045147, 1.5452602553351020, GAMMA])
LOWER = np.array([0.37810903145819369, -0.096042292212423178, 0.5, 0.2179332607542295])
# Share of the asked accuracy that one step may err by (tests: the whole run then keeps it); first step's depth, in
# roughnesses; how much shorter a step that fails is tried again, and the least depth it may wear, in the error allowed.
A_STEP, FIRST, SHORTER, LEAST = 0.5, 0.1, 0.25, 1e-3
# An error estimate from averages that scatter is mostly their scatter, up to so many times.
SCATTERED = 3.0


class NoAverage(RuntimeError):
    """A short run that gives no averages: how it ended, and a sentence."""

    def __init__(self, kind: Status, said: str):
        super().__init__(kind, said)
        self.kind, self.said = kind, said

    def __str__(self):
        return self.said


@dataclass(frozen=True)
class Average:
    """What a short run over one profile says.

    `nodal` (n,) m^3/s: integral over the face of the depth rate of both faces together times each node's hat;
    `volume_rate` m^3/s: the same over the whole face, found without the hats;
    `slope` (n, n) m^2/s: d nodal / d depth, or an approximation (none: explicit steps);
    `scatter` (n,) m^3/s: how well `nodal` is known;  `motion`: where the next short run starts;  `row`: what else to
    remember of it.
    """

    nodal: np.ndarray
    volume_rate: float
    slope: np.ndarray | None = None
    scatter: np.ndarray | None = None
    motion: object = None
    row: dict = field(default_factory=dict)


@dataclass(frozen=True)
class WearState:
    """A profile on its way: `time` s, `depth` (n,) m of both faces together, `volume` m^3 by integration of the volume
    rate, `span` of the next step s (0: to be found), `motion` from which the short run at this profile starts."""

    time: float
    depth: np.ndarray
    volume: float = 0.0
    span: float = 0.0
    motion: object = None


class HatBasis:
    """Depths linear between `radius` (n,): `mass` (n, n) m^2, integrals of two hats' product; `areas` (n,) of one."""

    def __init__(self, radius):
        self.radius = radius = np.asarray(radius, dtype=float)
        self.mass = np.zeros((len(radius), len(radius)))
        for k, (a, b) in enumerate(pairwise(radius)):
            # int phi_i phi_j r dr over one element is exact in these two moments.
            across = 2 * np.pi * (b - a) / 12.0
            self.mass[k, k] += across * (3 * a + b)
            self.mass[k + 1, k + 1] += across * (a + 3 * b)
            self.mass[k, k + 1] += across * (a + b)
            self.mass[k + 1, k] += across * (a + b)
        self.areas = self.mass.sum(axis=1)

    def volume(self, depth) -> float:
        """Volume (m^3) under a profile of depths (n,)."""
        return float(self.areas @ depth)

    def rates(self, nodal) -> tuple[np.ndarray, bool]:
        """Depth rates (n,) m/s whose volume is that of `nodal` (n,) m^3/s, and whether nothing had to be limited.

        Consistent masses find a rate that is linear over the face exactly, but undershoot beside a sharp edge of the
        contact.  There the exchange between neighbours is cut back so far that no face grows, and that none wears where
        it does not touch.
        """
        rate = np.linalg.solve(self.mass, nodal)
        if rate.min() >= 0.0:
            return rate, True
        # Exchange[i, j]: what node i gets from node j beyond its own lumped share.
        exchange = self.mass * (rate[:, None] - rate[None, :]) * np.outer(nodal > 0.0, nodal > 0.0)
        lost = -np.minimum(exchange, 0.0).sum(axis=1)
        keep = np.minimum(1.0, np.maximum(nodal, 0.0) / np.where(lost > 0.0, lost, np.inf))
        keep[lost == 0.0] = 1.0
        exchange *= np.where(exchange < 0.0, keep[:, None], keep[None, :])
        return (nodal + exchange.sum(axis=1)) / self.areas, False

    def over_face(self, rate) -> np.ndarray:
        """Depth rates (m/s) at places of the face."""
        return np.asarray(rate)

    def largest(self, scatter) -> float:
        """Most that a depth rate (m/s) may be wrong by where each of `nodal` is by `scatter` (n,) m^3/s."""
        return float(np.max(np.abs(np.linalg.inv(self.mass)) @ np.abs(scatter)))

    def slopes(self, slope, exact: bool) -> np.ndarray:
        """d rate / d depth (n, n) 1/s of d nodal / d depth."""
        if slope is None:
            return np.zeros_like(self.mass)
        return np.linalg.solve(self.mass, slope) if exact else slope / self.areas[:, None]


@dataclass(frozen=True)
class Control:
    """What bounds a step: `length` m times `accuracy` is the error allowed in the depth, `allowed` m the most by which
    one step may change the shape (largest minus smallest depth worn in it)."""

    length: float
    accuracy: float
    allowed: float

    @property
    def tolerance(self) -> float:
        return A_STEP * self.accuracy * self.length


def advance(
    averages: Callable[[np.ndarray, object], Average], hats: HatBasis, worn: WearState, until: float, control: Control
) -> Iterator[tuple[WearState, Average]]:
    """Profiles from `worn` to the time `until` (s), each with its average: first `worn` itself, then every accepted
    step.

    `averages(depth, motion)` is a short run over a profile, started from the motion another one left.  What it
    returns must depend on these two alone: then a run taken up from any WearState goes on as if it had not stopped.
    Raises NoAverage where even the shortest steps find none.
    """
    here = averages(worn.depth, worn.motion)
    yield worn, here
    while worn.time < until:
        worn = _step(averages, hats, worn, here, until, control)
        here = averages(worn.depth, worn.motion)
        yield worn, here


def _step(averages, hats, worn, here, until, control) -> WearState:
    """One accepted step."""
    rate, exact = hats.rates(here.nodal)
    slope = hats.slopes(here.slope, exact)
    fastest, spread = float(np.max(np.abs(rate))), float(np.ptp(rate))
    span = worn.span or FIRST * control.length / max(fastest, 1e-300)
    span = min(span, control.allowed / max(spread, 1e-300))
    noise = 0.0 if here.scatter is None else hats.largest(here.scatter)
    least = LEAST * control.tolerance / max(fastest, 1e-300)
    while True:
        # No crumb of a step at the end.
        last = worn.time + 1.01 * span >= until
        taken = until - worn.time if last else span
        try:
            gain, volume, error = _stages(averages, hats, worn.depth, here, rate, slope, taken)
        except NoAverage:
            span = SHORTER * taken
            if span < least:
                raise
            continue
        # An estimate below what the averages themselves scatter by is none.
        size = float(np.max(np.abs(error))) / (control.tolerance + SCATTERED * taken * noise)
        shape = float(np.ptp(gain)) / control.allowed
        growth = min(0.9 * max(size, 1e-12) ** (-1 / 3), 0.95 / max(shape, 1e-12))
        if size <= 1.0 and shape <= 1.0:
            following = max(span, taken * min(max(growth, 0.2), 4.0)) if last else taken * min(max(growth, 0.2), 4.0)
            return WearState(
                until if last else worn.time + taken, worn.depth + gain, worn.volume + volume, following, here.motion
            )
        span = taken * min(max(growth, 0.1), 0.9)


def _stages(averages, hats, depth, here, rate, slope, span):
    """Depths gained (n,), volume by its own quadrature, and the error of the depths, of one step of length `span`."""
    n = len(depth)
    stages, volumes = np.zeros((4, n)), np.zeros(4)
    left = np.linalg.inv(np.eye(n) - GAMMA * span * slope)
    for i in range(4):
        average, found = here, rate
        if i:
            average = averages(depth + span * ALPHA[i] @ stages, here.motion)
            found, _ = hats.rates(average.nodal)
        stages[i] = left @ (found + span * slope @ (IMPLICIT[i, :i] @ stages[:i]))
        # The volume is one more unknown of the same method, its slope the sum of the others'.
        volumes[i] = average.volume_rate + span * float(hats.areas @ (slope @ (IMPLICIT[i] @ stages)))
    return span * WEIGHTS @ stages, float(span * WEIGHTS @ volumes), span * (WEIGHTS - LOWER) @ stages


def unevenness(rate) -> float:
    """Largest over smallest depth rate, less one; infinite where a part of the face is not worn at all."""
    smallest, largest = float(np.min(rate)), float(np.max(rate))
    return largest / smallest - 1.0 if smallest > 0.0 else np.inf
