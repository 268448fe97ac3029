"""How wrong a run is: the solver's error from a second method, the film's from the next rung, both a posteriori.

**Solver**: a short stretch is integrated again by another method at a thirtieth of the accuracy; what they differ by
grows over the periods that the scene remembers.
**Model**: on the states the lower rung visits, the next rung's film pushes differently; that difference, as a force on
the linearised rings, gives the difference of the motions (the defect of the lower rung, answered linearly).
**Valid** estimates, not bounds: small errors (their own squares are left out), constant conditions for the model's.
"""

import math
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from . import dynamics, watch
from .faces import film_module
from .gap import DZ, DZ_RATE, FLOW_INNER, FORCE, GX, GY, GY_RATE
from .methods import attainable
from .problem import Problem
from .recorder import Recorder
from .signals import signals
from .solve import solve
from .touches import fresh_state

# The stretch integrated twice (fastest periods), and by how much sharper the second time.
STRETCH, SHARPER, PER_PERIOD = 3.0, 30.0, 32
# What a stretch shows, times this, is what a run has (measured: up to a third of its largest error, tests/unit).
SHOWN = 3.0
OTHER = {"adams": "bdf", "bdf": "ida", "ida": "ida", "dop853": "radau", "radau": "dop853", "expm": "dop853"}
# Steps along which the model's defect is followed: per fastest period, and in all; points of a steady period.
FOLLOWED, MOST, STEADY = 16, 250, 32


@dataclass(frozen=True)
class Certificate:
    """Estimated errors relative to the scales of `accuracy`: of the solver, of the film against the next rung (None
    where there is no higher one, or it cannot be estimated), both together, and a sentence."""

    asked: float
    solver: float | None
    model: float | None
    said: str

    @property
    def estimated(self) -> float | None:
        """Both errors together; None if neither is known."""
        known = [error for error in (self.solver, self.model) if error is not None]
        return sum(known) if known else None


def solver_error(problem: Problem, method: str) -> float | None:
    """Estimated error of displacements over the run relative to their scales, from a stretch of it done twice.
    None if the stretch does not end well."""
    stretch = min(problem.legs[0].length, STRETCH * problem.fast_time)
    short, parts = _shortened(problem, stretch), []
    for name, accuracy in ((method, problem.accuracy), (OTHER[method], problem.accuracy / SHARPER)):
        if short.sticking:
            short = _shortened(problem, stretch)
        sink = Recorder(short, stretch / max(8, round(STRETCH * PER_PERIOD)))
        if solve(short, name, max(accuracy, 2.0 * attainable(name, problem.memory)), sink).status != "ok":
            return None
        parts.append(sink.arrays()[1])
    count = min(len(part) for part in parts)
    difference = np.abs(parts[0][:count] - parts[1][:count]) / problem.scales[: problem.n]
    remembered = min(problem.memory, problem.duration / problem.fast_time)
    return SHOWN * float(difference.max()) * max(1.0, remembered * problem.fast_time / stretch)


def _shortened(problem: Problem, stretch: float) -> Problem:
    """The problem over its first `stretch` seconds, with the tolerances of the whole run."""
    if problem.sticking:
        short = Problem(problem.scene, stretch, problem.accuracy)
        short.y0, short.memory = problem.y0.copy(), problem.memory
        return short
    short = copy(problem)
    short.legs = [replace(problem.legs[0], span=Fraction(stretch))]
    short.records, short.touching, short.contacts = watch.fresh_records(), fresh_state(), []
    return short


def model_error(problem: Problem, higher: str = "radial") -> float | None:
    """The larger of `model_errors`, or None."""
    found = model_errors(problem, higher)
    return None if found is None else float(found.max())


def model_errors(problem: Problem, higher: str = "radial") -> np.ndarray | None:
    """Estimated difference of a linear film's scene from that with the film rung `higher` over the run: of the film at
    the outer radius in clearances, and of the leakage relative to its largest.  None where it cannot be estimated
    (changing conditions, a massless or unstable scene)."""
    if problem.massless or not problem.constant or not problem.linear:
        return None
    at, _, linear = problem.steady_motion()
    matrix = linear.state_matrix()
    values = np.linalg.eigvals(matrix)
    if np.max(values.real) > 0:
        return None
    from scipy.linalg import expm

    n, kept = len(linear.mass), problem.kept()
    slowest = -1.0 / max(float(np.max(values.real)), -1e300) if np.max(values.real) < 0 else math.inf
    step = problem.fast_time / FOLLOWED
    count = min(int(min(problem.duration, 6.0 * slowest) / step) + 1, MOST)
    # Exact for a push that is constant over a step, so that a stiff film does not shorten it.
    whole = expm(matrix * step)
    mass = np.vstack([np.zeros((n, n)), np.linalg.inv(linear.mass)])
    pushed = np.linalg.solve(matrix, whole - np.eye(2 * n)) @ mass
    film = film_module(higher)
    block = film.parameters(replace(problem.scene.film, model=higher), problem.clearance, problem.accuracy / 10)

    seen = _Seen(problem, linear, film, block)
    q, rate = at(0.0)
    start = np.zeros(2 * n)
    start[kept], start[n + np.array(kept)] = problem.y0[: problem.n], problem.y0[problem.rate_places]
    free, error, worst, before = start - np.concatenate([q, rate]), np.zeros(2 * n), np.zeros(2), None
    for k in range(count + 1):
        q, rate = at(k * step)
        state = np.concatenate([q, rate]) + free
        defect = seen.defect(k * step, state[kept], state[n + np.array(kept)])
        if before is not None:
            error = whole @ error + pushed @ (0.5 * (before + defect))
            worst = np.maximum(worst, seen.error(error[:n], error[n:]))
        before, free = defect, whole @ free
    # Then the steady state, on which what is left of the start no longer acts.
    return np.maximum(worst, _steady_error(problem, linear, seen, at, kept))


def _steady_error(problem, linear, seen, at, kept) -> np.ndarray:
    """The same over the last forcing period, by harmonics; 0 if the forcing has no common period."""
    period = problem.period()
    if not period:
        return np.zeros(2)
    points, n = STEADY, len(linear.mass)
    times = np.arange(points) * period / points
    states = [at(tau) for tau in times]
    forces = [seen.defect(tau, q[kept], rate[kept]) for tau, (q, rate) in zip(times, states, strict=True)]
    spectrum = np.fft.rfft(np.array(forces), axis=0)
    answers = np.zeros((points // 2 + 1, n), dtype=complex)
    w = 2 * math.pi / period * np.arange(points // 2 + 1)
    for k in range(points // 2):
        dynamic = linear.stiffness + 1j * w[k] * linear.damping - w[k] ** 2 * linear.mass
        answers[k] = np.linalg.solve(dynamic, spectrum[k])
    motion = np.fft.irfft(answers, points, axis=0)
    rates = np.fft.irfft(1j * w[:, None] * answers, points, axis=0)
    worst = np.zeros(2)
    for tau, (q, rate), x, v in zip(times, states, motion, rates, strict=True):
        seen.defect(tau, q[kept], rate[kept])
        worst = np.maximum(worst, seen.error(x, v))
    return worst


class _Seen:
    """What the higher film makes of the states of the lower one."""

    def __init__(self, problem, linear, film, block):
        self.problem, self.linear, self.film, self.block = problem, linear, film, block
        self.s, self.moved = problem.s.copy(), problem.s.copy()
        self.leakage = 0.0

    def defect(self, tau, q, rate):
        """Force and moments (3 per floating ring) by which the higher film pushes more than the lower one."""
        problem, linear = self.problem, self.linear
        y, s = problem.unknowns(q, rate), problem.s
        dynamics.kinematics(tau, y, np.zeros(problem.size), problem.p, problem.w, s)
        problem.film.wrench(problem.f, s)
        lower = s[FORCE : FORCE + 3].copy()
        self.film.flow(self.block, s)
        self.s[:] = s
        self.leakage = max(self.leakage, abs(s[FLOW_INNER]))
        more = s[FORCE : FORCE + 3] - lower
        return np.concatenate([linear.rings[k].sign * more for k in linear.floating])

    def error(self, x, v) -> np.ndarray:
        """Change of what is looked at by displacements x and rates v (3 per floating ring) at the last state: film at
        the outer radius in clearances, leakage relative to its largest."""
        linear, problem = self.linear, self.problem
        relative, rate = (
            sum(linear.rings[k].sign * u[3 * a : 3 * a + 3] for a, k in enumerate(linear.floating)) for u in (x, v)
        )
        film = (abs(relative[DZ]) + problem.face[1] * math.hypot(relative[GX], relative[GY])) / problem.clearance
        if not self.leakage:
            return np.array([film, 0.0])
        self.moved[:] = self.s
        self.moved[DZ : GY + 1] += relative
        self.moved[DZ_RATE : GY_RATE + 1] += rate
        self.film.flow(self.block, self.moved)
        return np.array([film, abs(self.moved[FLOW_INNER] - self.s[FLOW_INNER]) / self.leakage])


def lowest_rung(scene, duration: float, accuracy: float, start) -> Problem:
    """The scene as a problem on the lowest film rung that keeps the accuracy; `start(problem)` sets its unknowns.

    Only "auto" is chosen for: the linear film, with the radial film's coefficients, where its estimated error is
    below half the accuracy, else the radial film.  Raises ImpossibleScene.
    """
    film = scene.film
    if film.model != "auto":
        problem = Problem(scene, duration, accuracy)
        start(problem)
        return problem
    radial = Problem(replace(scene, film=replace(film, model="radial")), duration, accuracy)
    start(radial)
    why = _why_not_linear(scene, radial)
    if why is None:
        linear = Problem(replace(scene, film=replace(film, model="linear", coefficients="radial")), duration, accuracy)
        start(linear)
        error = model_error(linear)
        if error is not None and error < 0.5 * accuracy:
            linear.observed = radial.observed
            said = f"film auto: the linear film, with the radial film's coefficients, is within {error:.1e} of it"
            linear.reasons.append(said)
            return linear
        why = "the linear film's error cannot be estimated" if error is None else f"the linear film errs by {error:.1e}"
    radial.reasons.append(f"film auto: the radial film; {why}")
    return radial


def _why_not_linear(scene, radial: Problem) -> str | None:
    """What rules the linear film out before anything is tried, or None."""
    if scene.contact or radial.layout.seals:
        return "contact or friction is no place for a linear film"
    if scene.film.cavitation_pressure is not None:
        return "the pressure has a floor"
    if not radial.constant or radial.massless:
        return "conditions change, or a ring has no mass"
    low = float(signals(radial, np.zeros(1), radial.y0[None, : radial.n], np.zeros((1, radial.n)))["h_min"][0])
    # A tilt ratio t leaves errors of t^2: no estimate is needed to see that far.
    ratio = 1.0 - low / radial.clearance
    if ratio * ratio > 100.0 * radial.accuracy:
        return f"the film starts {abs(ratio):.2g} off the clearance, and a linear film errs by about the square"
    return None


def certify(problem: Problem, method: str) -> Certificate:
    """Certificate of a finished run of this problem by this method."""
    by_solver = solver_error(problem, method)
    by_model = model_error(problem) if problem.film_name == "linear" else None
    parts = [f"solver {by_solver:.1e}" if by_solver is not None else "solver not estimated"]
    if by_model is not None:
        parts.append(f"model {by_model:.1e} against the radial film")
    elif problem.film_name == "linear":
        parts.append("the linear film's own error not estimated here")
    else:
        parts.append(f"the {problem.film_name} film is the highest rung")
    known = [error for error in (by_solver, by_model) if error is not None]
    asked = problem.accuracy
    said = f"asked {asked:.0e}, estimated {sum(known):.1e} ({', '.join(parts)})" if known else ", ".join(parts)
    if known and sum(known) > asked:
        cure = (
            "a higher film rung"
            if by_model and by_model > 0.5 * sum(known)
            else 'run.solver = "dop853" or a shorter run'
        )
        said += f"; NOT met: try {cure}"
    return Certificate(asked, by_solver, by_model, said)
