"""How far the motion of a scene with a linear film is from that with the next higher film model, without running that
one.

On the states the linear film visits, the higher film pushes differently; that difference, as a force on the linearised
rings, gives the difference of the motions (the defect of the lower film, answered linearly).
**Source** Zadunaisky (1976), Numer. Math. 27, 21-39: the error from the defect; here of a model, derived here.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..faces.geometry import DZ, DZ_RATE, FLOW_INNER, FORCE, GAP_STATE_SIZE, GY, GY_RATE
from ..films import film_module
from ..numerics.kernel import outer_kernel
from ..scene.waviness import waves_of

# Steps along which the defect is followed: per fastest period, at once, and in all; points of a steady period.
FOLLOWED, AT_ONCE, MOST, STEADY = 16, 125, 250, 32
# Least eigenvalue of a scene whose rings are all held, as a share of the largest.
HELD = 1e-12


def model_error(run, higher: str = "radial", enough: float = math.inf) -> float | None:
    """The larger of `model_errors` (relative), or None."""
    found = model_errors(run, higher, enough)
    return None if found is None else float(found.max())


def model_errors(run, higher: str = "radial", enough: float = math.inf) -> np.ndarray | None:
    """Estimated difference of a linear film's scene from that with the film model `higher` over the run.

    `run` a RunState with a linear film and its start; looking further ends once an error exceeds `enough`.
    **Valid** small errors (their squares are left out), constant conditions, rings with mass, a stable scene.
    Returns (2,): of the film at the outer radius in clearances, and of the leakage relative to its largest; None where
    it cannot be estimated.
    """
    model, unknowns = run.model, run.model.unknowns
    if unknowns.has_residual_form or not unknowns.constant or not unknowns.linear:
        return None
    if film_module(higher).accepts(replace(model.scene.film, model=higher), waves_of(model.scene)):
        return None
    segment = run.segment(0)
    _, answers, linear = segment.steady_motion()
    if not np.all(np.diag(linear.mass)):
        return None
    matrix = linear.state_matrix()
    values = np.linalg.eigvals(matrix)
    slowest, sizes = float(np.max(values.real)), np.abs(values)
    # A ring that nothing brings back has no steady motion.
    if slowest > 0 or np.min(sizes) < HELD * np.max(sizes):
        return None
    film = film_module(higher, model.scene.film)
    block = film.parameters(replace(model.scene.film, model=higher), model.clearance, model.accuracy / 10)
    comparison = FilmComparison(segment, linear, film, block)
    # The steady state first: it is cheap, and on it what is left of the start no longer acts.
    worst = _steady_error(run.period(), linear, comparison, answers)
    if worst.max() > enough:
        return worst
    step = model.shortest_period / FOLLOWED
    longest = min(run.duration, -6.0 / slowest if slowest < 0 else math.inf)
    return _transient_error(
        run, linear, comparison, answers, matrix, step, min(int(longest / step) + 1, MOST), worst, enough
    )


def _transient_error(run, linear, comparison, answers, matrix, step, count, worst, enough) -> np.ndarray:
    """The worst of `worst` and the errors at `count` steps from the start on."""
    from scipy.linalg import expm

    n = len(linear.mass)
    # Exact for a push that is constant over a step, so that a stiff film does not shorten it.
    whole = expm(matrix * step)
    mass = np.vstack([np.zeros((n, n)), np.linalg.inv(linear.mass)])
    pushed = 0.5 * np.linalg.solve(matrix, whole - np.eye(2 * n)) @ mass
    unknowns = run.model.unknowns
    places, kept = unknowns.rate_places, unknowns.among_three()
    free = np.zeros(2 * n)
    free[kept], free[n + np.array(kept)] = run.y0[: unknowns.n], run.y0[places]
    free -= _steady_states(answers, np.zeros(1), n)[0]
    error, before = np.zeros(2 * n), np.zeros(n)
    for first in range(0, count + 1, AT_ONCE):
        times = step * np.arange(first, min(first + AT_ONCE, count + 1))
        unforced = _propagate(whole, free, np.zeros((len(times), 2 * n)))
        free = unforced[-1]
        defects = comparison.defects(times, _steady_states(answers, times, n) + unforced[:-1])
        # Nothing pushes before the first step.
        earlier = np.vstack([before if first else -defects[0], defects[:-1]])
        errors = _propagate(whole, error, (earlier + defects) @ pushed.T)[1:]
        error, before = errors[-1], defects[-1]
        worst = np.maximum(worst, comparison.errors(errors))
        if worst.max() > enough:
            break
    return worst


@outer_kernel()
def _propagate(matrix, start, pushes):
    """States (m + 1, n) of x' = matrix x + push from `start` on, one push (m, n) a step."""
    count, n = pushes.shape
    states = np.empty((count + 1, n))
    states[0] = start
    for k in range(count):
        for i in range(n):
            total = pushes[k, i]
            for j in range(n):
                total += matrix[i, j] * states[k, j]
            states[k + 1, i] = total
    return states


def _steady_states(answers, times, n) -> np.ndarray:
    """Linear steady displacements and rates (m, 2 n) at segment times."""
    states = np.zeros((len(times), 2 * n))
    for harmonic, answer in answers:
        turned = np.exp(1j * harmonic.frequency * times)[:, None] * answer
        states[:, :n] += turned.real
        states[:, n:] -= harmonic.frequency * turned.imag
    return states


def _steady_error(period, linear, comparison, answers) -> np.ndarray:
    """Errors over a forcing `period` (s), by harmonics; 0 if the forcing has no common period."""
    if not period:
        return np.zeros(2)
    n, times = len(linear.mass), np.arange(STEADY) * period / STEADY
    spectrum = np.fft.rfft(comparison.defects(times, _steady_states(answers, times, n)), axis=0)
    w = 2 * math.pi / period * np.arange(len(spectrum))[:, None, None]
    motion = np.linalg.solve(linear.stiffness + 1j * w * linear.damping - w**2 * linear.mass, spectrum[:, :, None])
    # The highest harmonic of so many points has no sine part.
    motion[-1] = 0.0
    both = np.concatenate([motion, 1j * w * motion], axis=1)[:, :, 0]
    return comparison.errors(np.fft.irfft(both, STEADY, axis=0))


@dataclass
class FilmComparison:
    """What the higher film (`film`, block `block`) makes of the states of the lower one; `gaps` (m, GAP_STATE_SIZE) the
    states last seen, `leakage` (m^3/s) the largest so far."""

    segment: object
    linear: object
    film: object
    block: np.ndarray
    gaps: np.ndarray | None = None
    leakage: float = 0.0

    def defects(self, times, states) -> np.ndarray:
        """Forces (N) and moments (N m), shape (m, n), by which the higher film pushes more than the lower one, at
        segment `times` (m,) (s) and `states` (m, 2 n), displacements and rates."""
        # Kernels of fixed signature are made ready by their import.
        from ..dynamics.function_values import Value, load_value, thinnest_value
        from ..dynamics.kernels import at_each, states_along

        segment, linear, n = self.segment, self.linear, len(self.linear.mass)
        model, kept = segment.model, segment.model.unknowns.among_three()
        ys = np.zeros((len(times), segment.size))
        ys[:, : segment.n], ys[:, segment.rate_places] = states[:, kept], states[:, n + np.array(kept)]
        self.gaps = np.empty((len(times), GAP_STATE_SIZE))
        unused = np.empty((len(times), len(segment.w))), np.empty((len(times), 3))
        scratch = segment.p, segment.w, segment.s
        states_along(
            Value(model.interface.film.wrench), model.f, *load_value(None), False, *scratch,
            np.ascontiguousarray(times), ys, np.zeros_like(ys), thinnest_value(model.face), model.face, self.gaps,
            *unused,
        )  # fmt: skip
        more = self.gaps[:, FORCE : FORCE + 3].copy()
        at_each(Value(self.film.flow), self.block, self.gaps)
        more = self.gaps[:, FORCE : FORCE + 3] - more
        self.leakage = max(self.leakage, float(np.max(np.abs(self.gaps[:, FLOW_INNER]))))
        return np.concatenate([linear.rings[k].sign * more for k in linear.floating], axis=1)

    def errors(self, moved) -> np.ndarray:
        """Largest change (2,) by displacements and rates `moved` (m, 2 n) at the states last seen: of the film at the
        outer radius in clearances, of the leakage relative to its largest."""
        # Kernels of fixed signature are made ready by their import.
        from ..dynamics.function_values import Value
        from ..dynamics.kernels import at_each

        linear, model, n = self.linear, self.segment.model, len(self.linear.mass)
        x, v = (
            sum(linear.rings[k].sign * part[:, 3 * a : 3 * a + 3] for a, k in enumerate(linear.floating))
            for part in (moved[:, :n], moved[:, n:])
        )
        film = (np.abs(x[:, 0]) + model.face[1] * np.hypot(x[:, 1], x[:, 2])) / model.clearance
        if not self.leakage:
            return np.array([film.max(), 0.0])
        gaps = self.gaps.copy()
        gaps[:, DZ : GY + 1] += x
        gaps[:, DZ_RATE : GY_RATE + 1] += v
        at_each(Value(self.film.flow), self.block, gaps)
        leakage = np.abs(gaps[:, FLOW_INNER] - self.gaps[:, FLOW_INNER]) / self.leakage
        return np.array([film.max(), leakage.max()])
