"""How far a film is from a better one, without a run of that.

Of a linear film its motion from that with the next higher film model (`model_errors`), of a film by lines of radius the
film over radius and angle (`reynolds_comparison`), of a film of cells itself with half of them (`cell_error`).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..dynamics.model import Model
from ..dynamics.native import Value, at_each, load_value, propagate, states_along, thinnest_value
from ..dynamics.run_state import RunState
from ..dynamics.swept_motion import records
from ..faces.contact import lay_surfaces
from ..faces.film_thickness import h_min
from ..faces.geometry import (
    CAVITATED,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FLOW_INNER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
)
from ..films import film_named, limits
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.film import Reynolds
from ..scene.patterns import waves_of
from ..scene.scene import SceneError, seals_that_stick
from .verification_run import ErrorScales

# Steps along which the defect is followed: per fastest period, at once, and in all; points of a steady period.
FOLLOWED, AT_ONCE, MOST, STEADY = 16, 125, 250, 32
# What divides a change that is none; what halving the cells says of their error in a run, times this, counts as it.
TINY, MARGIN = 1e-300, 1.5
# Least eigenvalue of a scene whose rings are all held, as a share of the largest.
HELD = 1e-12


def model_error(run: RunState, enough: float = math.inf) -> float | None:
    """The larger of `model_errors` (relative), or None."""
    found = model_errors(run, enough)
    return None if found is None else float(found.max())


def model_errors(run: RunState, enough: float = math.inf) -> np.ndarray | None:
    """Estimated difference of a linear film's scene from that with the radial film over the run.

    On the states the linear film visits, the higher film pushes differently; that difference, as a force on the
    linearised rings, gives the difference of the motions (the defect of the lower film, answered linearly).
    **Source** Zadunaisky (1976), Numer. Math. 27, 21-39: the error from the defect; here of a model, derived here.

    `run` a RunState with a linear film and its start; looking further ends once an error exceeds `enough`.
    **Valid** small errors (their squares are left out), constant conditions, rings with mass, a stable scene.
    Returns (2,): of the film at the outer radius in clearances, and of the leakage relative to its largest; None where
    it cannot be estimated.
    """
    model, unknowns = run.model, run.model.unknowns
    if unknowns.has_residual_form or not unknowns.constant or not unknowns.linear:
        return None
    table = replace(model.scene.film, model="radial")
    if film_named("radial").accepts(table, waves_of(model.scene)):
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
    film = film_named("radial", model.scene.film)
    block = film.parameters(table, model.clearance, model.accuracy / 10)
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
        unforced = propagate(whole, free, np.zeros((len(times), 2 * n)))
        free = unforced[-1]
        defects = comparison.defects(times, _steady_states(answers, times, n) + unforced[:-1])
        # Nothing pushes before the first step.
        earlier = np.vstack([before if first else -defects[0], defects[:-1]])
        errors = propagate(whole, error, (earlier + defects) @ pushed.T)[1:]
        error, before = errors[-1], defects[-1]
        worst = np.maximum(worst, comparison.errors(errors))
        if worst.max() > enough:
            break
    return worst


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


# Cells over radius and angle, and the least share of the face that counts as cavitated.
CELLS, TORN = (40, 96), 1e-3
# Differences below this are those of the cells; a film with less than this share of a force has lost its liquid.
FINE, STARVED = 3e-3, 1e-6


def reynolds_comparison(run: RunState) -> dict | None:
    """Force, moment and leakage of a run's film over those of the film "reynolds", less 1, at the start or at its
    linear steady tilt, whichever tilts it more: `tilt` (rad), `force`, `moment`, `leakage` (None where nothing leaks or
    turns), `cavitated` shares of the face, by either film, and a sentence, `said`.  None where the film has no lines of
    radius, or the other does not take the faces.

    A film by lines of radius leaves out the flow along the circle, little in narrow faces, and where the pressure would
    be below that of cavities the liquid that these keep.  A floor of the pressure makes liquid where cavities end, and
    so is full at once where they take their time to fill: force and moment are too large where cavities are long,
    leakage may be anything.  Both films stand in the frame that turns with the tilt, in which cavities are steady.
    **Source** films/reynolds beside the film of a run.
    **Valid** faces that are the same all around, liquids without inertia.
    """
    model = run.model
    scene, (film, f) = model.scene, model.observed
    floor = scene.film.cavitation_pressure is not None
    if model.unknowns.film_unknowns or waves_of(scene) or film.constant or film.as_given:
        return None
    options = Reynolds(cells_r=CELLS[0], cells_theta=CELLS[1], roughness="none", sectors=1,
                       cavitation="mass-conserving" if floor else "none")  # fmt: skip
    keeps, table = film_named("reynolds"), replace(scene.film, model="reynolds", reynolds=options)
    # Of a narrow seal, the two are one.
    table = replace(table, geometry="cylindrical")
    if limits(keeps, table):
        return None
    s = _turning_state(run)
    g = keeps.parameters(table, model.clearance)
    lay_surfaces(g, scene)
    if h_min(f, s)[0] <= 0.0:
        return None
    other = s.copy()
    film.flow(f, s)
    tilt, torn = math.hypot(s[GX], s[GY]), s[CAVITATED] > TORN
    found = {"tilt": tilt, "force": None, "moment": None, "leakage": None, "cavitated": [float(s[CAVITATED]), None]}
    at = f"at a tilt of {in_words('tilt', tilt)}"
    what = f"floor of the pressure, on {in_words('share', s[CAVITATED], 2)} of the face {at}" if torn else at
    x = np.empty(len(keeps.unknowns(g).names))
    code = keeps.start(g, other, x)
    if code == 0:
        keeps.flow(g, other, x)
    floor_alone = (scene.film.cavitation_pressure or 0.0) * math.pi * (table.outer_radius**2 - table.inner_radius**2)
    if code or (torn and other[FORCE] - floor_alone < STARVED * (s[FORCE] - floor_alone)):
        why = "a film that keeps its liquid is starved, edges at the cavitation pressure give it none"
        return found | {"said": f"{what}: {why}"} if torn else None
    moment = [math.hypot(at[MOMENT_X], at[MOMENT_Y]) for at in (s, other)]
    parts = {"leakage": (s[FLOW_INNER], other[FLOW_INNER]), "force": (s[FORCE], other[FORCE]), "moment": moment}
    if not tilt:
        del parts["moment"]
    off = {part: float(mine / whole - 1.0) for part, (mine, whole) in parts.items() if whole}
    than = "cavities that keep their liquid" if torn else "flow along the circle, too"
    than += ", between smooth faces" if scene.contact is not None else ""
    told = ", ".join(f"{part} {in_words('share', share, 2, '+')}" for part, share in off.items() if abs(share) > FINE)
    said = f"{what}, beside a film with {than} (reynolds): {told or 'the same within ' + in_words('share', FINE, 2)}"
    return found | off | {"cavitated": [float(s[CAVITATED]), float(other[CAVITATED])], "said": said}


def _turning_state(run) -> np.ndarray:
    """Gap state at the start or of the linear steady tilt, in the frame that turns with the tilt."""
    scene, s = run.model.scene, run.segment(0).gap_state(0.0, run.y0).copy()
    tilt, rate = complex(s[GX], s[GY]), complex(s[GX_RATE], s[GY_RATE])
    whirl = (tilt.conjugate() * rate).imag / abs(tilt) ** 2 if tilt else 0.0
    steady, steady_whirl, _ = steady_tilt(run.model)
    if abs(steady) > abs(tilt):
        tilt, whirl = steady, steady_whirl
    s[DZ_RATE : DZ_RATE + 3] = 0.0
    s[GX], s[GY], s[GX_RATE], s[GY_RATE] = tilt.real, tilt.imag, 0.0, 0.0
    s[MEAN_SPIN] = 0.5 * (initially(scene.shaft.speed) + initially(scene.stator.speed)) - whirl
    return s


def cell_error(run: RunState, halving: float | None = None) -> float | None:
    """Relative error of the film's cells, the largest of force, moment and leakage on the scales of the certificate, of
    the film at rest at the gap where the run began and where it ended, and, where `halving` is what half the cells
    change in the run, of the run; None of a film that has none to halve, or where nothing is known.

    **Source** Richardson (1911), *Phil. Trans. R. Soc. A* 210, 307: what halving changes, over 2^p - 1, is the error of
    a method of order p; of cells too wide for that order what four times as many say of the aligned film, as if of
    order one, where that is more.
    """
    model, (film, f) = run.model, run.model.observed
    if film.halved is None:
        return None
    scales, half = ErrorScales(run), _block(model, model.interface.halved())
    at_rest = _apart_at_rest(run, scales, f, half)
    changes = [] if at_rest is None else [float(at_rest.max())]
    changes += [] if halving is None else [MARGIN * halving]
    if not changes:
        return None
    share = 1.0 / (2.0**model.interface.cell_order - 1.0)
    if film.finer is not None:
        try:
            others = half, _block(model, model.interface.finer())
        except SceneError:
            # So many cells there are not: what half of them say is not known to be all.
            return None
        halved, finer = (_apart_at_rest(run, scales, f, other, aligned=True) for other in others)
        if halved is not None and finer is not None:
            share = max(share, 4.0 / 3.0 * float((finer / np.maximum(halved, TINY)).max()))
    return max(changes) * share


def _block(model: Model, table) -> np.ndarray:
    """The film's block of another Film table."""
    block = model.observed[0].parameters(table, model.clearance)
    lay_surfaces(block, model.scene)
    return block


def _apart_at_rest(run: RunState, scales, f, other, aligned: bool = False) -> np.ndarray | None:
    """Largest error (2,), on ErrorScales, of the film's loads at rest in block `f` beside those in block `other`, at
    the gap where the run began and where it ended, with its tilts or `aligned`; None where there are no steady
    pressures."""
    film, found = run.model.observed[0], []
    for index, tau, y in ((0, 0.0, run.y0), run.last or (0, 0.0, run.y0)):
        loads = []
        for block in (f, other):
            s, x = run.segment(index).gap_state(tau, y).copy(), np.empty(len(film.unknowns(block).names))
            s[[DZ_RATE, GX_RATE, GY_RATE, CONING_RATE]] = 0.0
            if aligned:
                s[[GX, GY]] = 0.0
            if film.start(block, s, x):
                return None
            film.flow(block, s, x)
            still = np.zeros(2 * scales.n)
            loads.append([[*still, s[FORCE], s[MOMENT_X], s[MOMENT_Y], s[FLOW_INNER], 0.0]])
        found.append(scales.errors(*map(np.array, loads[::-1])).max())
    return np.array(found)


def steady_tilt(model: Model) -> tuple[complex, float, str]:
    """Relative tilt (rad, complex), its whirl (rad/s) and what it is, of the linear steady state."""
    if seals_that_stick(model.scene):
        return 0.0, 0.0, "a ring that its secondary seal holds has no linear steady state: aligned"
    if model.unknowns.faces_tilt:
        return 0.0, 0.0, "aligned faces that press with a moment are no linear steady state: aligned"
    if records(model.scene):
        return 0.0, 0.0, "samples have no linear steady state: aligned"
    segment = model.segment()
    if not segment.harmonic:
        return 0.0, 0.0, "a sweep has no linear steady state: aligned"
    linear = model.linear_scene()
    parts: dict[float, complex] = {}
    for harmonic, answer in linear.answers(segment.harmonics()):
        g = linear.relative(harmonic, answer)
        # Re(g e^{iwt}) is a forward and a backward circle.
        w = harmonic.frequency
        parts[w] = parts.get(w, 0.0) + (g[1] + 1j * g[2]) / 2
        parts[-w] = parts.get(-w, 0.0) + ((g[1] - 1j * g[2]) / 2).conjugate()
    mean = parts.pop(0.0, 0.0)
    if abs(mean) > 0:
        return complex(mean), 0.0, "mean tilt of the linear steady state"
    if parts:
        w, largest = max(parts.items(), key=lambda item: abs(item[1]))
        if abs(largest) > 0:
            return complex(largest), float(w), "turning tilt of the linear steady state, at one instant"
    return 0.0, 0.0, "no forcing tilts this scene: aligned"
