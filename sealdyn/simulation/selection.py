"""What a run is to be: film, method, tolerance and start, chosen once for a scenario and handed down as its Plan."""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import numpy as np

from .. import archive
from ..dynamics.intervals import constant_and_slope, largest_value
from ..dynamics.model import Model
from ..dynamics.run_state import Caution, Concern, RunState
from ..dynamics.swept_motion import COARSE, PER_PERIOD, splines
from ..faces.geometry import COLLAPSE, DZ, FLOOR
from ..quantities import in_words
from ..scenario.reader import Scenario
from ..scenario.tables import Run
from ..scene.fluid import viscosity_of
from ..scene.patterns import EVEN, grooves_of
from ..scene.radial import RadialScene
from ..scene.rings import RING_NAMES
from ..scene.scene import Scene, SceneError
from ..solvers.contract import attainable
from ..units import quoted
from .film_error import model_error
from .plausibility import PER_TURN, refuse_large, unit_warnings

# Ratio of the fastest decay to the fastest motion of interest above which an explicit-like method crawls; the same of a
# radial seal's followers.
STIFF, STIFF_FOLLOWER = 60.0, 50.0
# Samples of a period of the fastest forcing, unless told.
PER_PERIOD_OF_FORCING = 8
STABLE = "on the linear steady response, which is stable"


@dataclass(frozen=True)
class Start:
    """Where a run starts: `taken` "rest", "steady" or an archive; `why` a sentence, empty where it was asked for."""

    taken: str
    why: str = ""


@dataclass(frozen=True)
class Plan:
    """What has been chosen for a run: the name of its `film` (empty of a radial seal), its `method` by the name in
    METHODS, the `tolerance` relative to the scales (None: by a trial, or the cautious one), its `start`, a sentence
    `why` on method and tolerance, the sample `interval` (s) and the `count` of intervals; `film_error` (relative) of a
    linear film that was chosen (None: not estimated); `last`: no other method or tolerance is tried after it; `work`:
    compiled evaluations that it may take."""

    film: str
    method: str
    tolerance: float | None
    start: Start
    why: str
    interval: float = 0.0
    count: int = 0
    film_error: float | None = None
    last: bool = False
    work: float = math.inf


def prepare_run(scenario: Scenario, allow_large: bool = True, lowest: bool = True) -> tuple[RunState, Plan]:
    """A scenario made ready: its run (RunState with its start and windows, or RadialRun) and the Plan for it;
    `allow_large` also one of a day or of gigabytes; the `lowest` film that keeps the accuracy, or film and method
    that cost least among many runs.
    Raises SceneError, which names the numbers that may want a unit, or ArchiveError."""
    radial = isinstance(scenario.scene, RadialScene)
    if (start := scenario.foreign_start) and scenario.run.start == start:
        found = f"{quoted(start)}, which only the archive names"
        raise SceneError("run.start", found, "--set run.start=FILE, where it is meant")
    try:
        refuse_large(scenario, allow_large)
        run, plan = _prepared_radial(scenario) if radial else _prepared(scenario, lowest)
        refuse_large(scenario, allow_large, plan.count)
        return run, plan
    except SceneError as error:
        if not (meant := unit_warnings(scenario)):
            raise
        raise SceneError(error.key, error.found, f"{error.expected}; {'; '.join(meant)}") from None


def _prepared(scenario, lowest):
    settings = scenario.run
    chosen = []

    def begin(run):
        # Once for the scene, by the film it asks for: a simpler film tried for it starts where that one does.
        if not chosen:
            chosen.append(choose_start(run, settings.start))
        set_start(run, scenario.scene, chosen[0])

    run, film_error = select_film(scenario.scene, settings, begin, lowest or settings.solver == "expm")
    fastest = run.fastest_forcing()
    interval, count = sampling(run.duration, largest_value(scenario.scene.shaft.speed), settings, fastest)
    run.check_loads()
    method, why = settings.solver, "asked for"
    if method != "auto":
        check_method(run.model, method)
    else:
        method, why = choose_method(run, exact=lowest)
    best = attainable(method, run.memory)
    if best > settings.accuracy:
        sentence = f"accuracy: errors add up over {run.memory:.3g} periods; {method} keeps {best:.1e} at best"
        run.cautions.append(Caution(Concern.ACCURACY, sentence))
    if run.model.unknowns.faces_tilt and run.model.linear_scene().rest is None:
        sentence = "stability and stiffness are of aligned faces: no rest is found for what their pattern presses"
        run.cautions.append(Caution(Concern.ALIGNED, sentence))
    if any(row.count < EVEN for row in grooves_of(scenario.scene)[1]):
        sentence = "stability and stiffness are means over a turn of so few grooves: study coefficients has more"
        run.cautions.append(Caution(Concern.ALIGNED, sentence))
    run.watch_last_periods()
    if fastest * interval > math.pi:
        frequency = fastest / (2 * math.pi)
        sentence = (
            f"aliasing: forcing at {frequency:.5g} Hz needs more than {2 * frequency * run.duration:.0f} samples "
            f"in all, {count} asked: raise run.samples_per_turn"
        )
        run.cautions.append(Caution(Concern.ALIASING, sentence))
    for key, sampled in splines(scenario.scene).items():
        if sampled.coarse > COARSE:
            power = in_words("share", sampled.coarse, 2)
            sentence = (
                f"aliasing: {power} of the power of the rate of {key} has fewer than {PER_PERIOD} samples a period: "
                "give it finer"
            )
            run.cautions.append(Caution(Concern.ALIASING, sentence))
    return run, Plan(run.model.interface.name, method, None, chosen[0], why, interval, count, film_error)


def _prepared_radial(scenario):
    """The same of a radial seal, which rides on the shaft as it begins."""
    # Its kernels are loaded for a radial seal only.
    from ..radial_seals.model import RadialModel, RadialRun

    settings = scenario.run
    model = RadialModel(scenario.scene, settings.accuracy)
    run = RadialRun(model, model.time_of(settings.turns) if settings.duration is None else settings.duration)
    interval, count = sampling(run.duration, largest_value(scenario.scene.shaft.speed), settings)
    method, why = (settings.solver, "asked for") if settings.solver != "auto" else choose_method(run)
    run.start = Start("riding", "all followers on the shaft, where that pulls nowhere")
    return run, Plan("", method, None, run.start, why, interval, count, last=True)


def sampling(duration: float, fastest: float, settings: Run, forcing: float = 0.0) -> tuple[float, int]:
    """Sample interval (s) and number of intervals of a run of `duration` (s), its shaft turning at `fastest` (rad/s) at
    most, its forcing at `forcing` (rad/s); `settings` as the `[run]` table."""
    if settings.samples is not None:
        return duration / settings.samples, settings.samples
    if fastest == 0.0:
        count = max(1000, math.ceil(PER_PERIOD_OF_FORCING * duration * forcing / (2 * math.pi)))
        return duration / count, count
    per_turn = settings.samples_per_turn
    if per_turn is None:
        per_turn = max(PER_TURN, math.ceil(PER_PERIOD_OF_FORCING * forcing / fastest * (1.0 - 1e-12)))
    exact = duration * fastest / (2 * math.pi) * per_turn
    count = max(1, round(exact))
    if abs(exact - count) < 1e-6 * count:
        return duration / count, count
    interval = 2 * math.pi / fastest / per_turn
    return interval, int(duration / interval)


def select_film(
    scene: Scene, settings: Run, start: Callable[[RunState], None], lowest: bool = True
) -> tuple[RunState, float | None]:
    """A run of the scene with the lowest film model that keeps the accuracy, and the estimated error of a linear film
    that was chosen for it (None: not estimated).  `settings` as the `[run]` table: `accuracy`, and `duration` (s) or
    `turns`; `start(run)` sets the run's unknowns.

    Only "auto" is chosen for: the linear film, with the radial film's coefficients, where its estimated error is below
    half the accuracy, else the radial film; of faces with a profile the profiled film.  Unless the `lowest` is asked
    for, a linear film is not tried: in a compiled loop it is no cheaper.  Raises SceneError.
    """
    film, accuracy = scene.film, settings.accuracy

    def started(scene, observed=None) -> RunState:
        model = Model(scene, accuracy, observed)
        run = RunState(model, model.time_of(settings.turns) if settings.duration is None else settings.duration)
        start(run)
        return run

    highest = started(scene)
    name = highest.model.interface.name
    if film.model != "auto":
        return highest, None
    if film.gas is not None:
        highest.reasons.append(f"film auto: the {name} film, for a gas")
        return highest, None
    if name != "radial":
        highest.reasons.append(f"film auto: the {name} film; the faces have a profile, others know cones only")
        return highest, None
    why = _why_not_linear(scene, highest) if lowest else "many runs share its compiled loop"
    if why is None:
        simpler = replace(scene, film=replace(film, model="linear", coefficients="radial"))
        linear = started(simpler, highest.model.observed)
        error = model_error(linear, enough=0.5 * accuracy)
        if error is not None and error < 0.5 * accuracy:
            linear.reasons.append(
                f"film auto: the linear film, with the radial film's coefficients, is within {error:.1e} of it"
            )
            return linear, error
        why = (
            "the linear film's error cannot be estimated"
            if error is None
            else f"the linear film errs by {error:.1e} or more"
        )
    highest.reasons.append(f"film auto: the radial film; {why}")
    return highest, None


def _why_not_linear(scene, radial: RunState) -> str | None:
    """What rules the linear film out before anything is tried, or None."""
    unknowns = radial.model.unknowns
    if scene.contact or unknowns.seals:
        return "contact or friction is no place for a linear film"
    if scene.film.cavitation_pressure is not None:
        return "the pressure has a floor"
    if scene.film.inertia:
        return "the fluid has inertia"
    if not unknowns.constant or unknowns.has_residual_form:
        return "conditions change, or a ring has no mass"
    # A tilt ratio t leaves errors of t^2: no estimate is needed to see that far.
    ratio = 1.0 - radial.start_film() / radial.model.clearance
    if ratio * ratio > 100.0 * radial.model.accuracy:
        return f"the film starts {abs(ratio):.2g} off the clearance, and a linear film errs by about the square"
    return None


def choose_method(run: RunState, exact: bool = True) -> tuple[str, str]:
    """The method for a run (RunState, RadialRun), by its name in METHODS, and a sentence why; the `exact` motion of a
    linear film, where it has one, or what a compiled loop of many runs integrates."""
    model = run.model
    if isinstance(model.scene, RadialScene):
        stiff = model.followers.damping / model.followers.mass > STIFF_FOLLOWER * model.reference_rate
        why = "every change of contact is a new start: a one-step method" + (", and the lip is stiff" if stiff else "")
        return "radau" if stiff else "dop853", why
    if model.interface.film.settle is not None:
        return "trbdf2", "cells that tear and fill: TR-BDF2, the film settled at each stage"
    if model.unknowns.massless:
        return "ida", "a massless ring has no rates: IDA, on the residual form"
    if model.unknowns.has_residual_form:
        return "ida", "the film has unknowns of its own: IDA, on the residual form"
    if exact and model.unknowns.linear and model.unknowns.constant:
        return "expm", "linear film, constant conditions: the exact motion, by matrix exponential"
    ratio = _fastest_decay(run) * model.shortest_period / (2 * math.pi)
    if ratio > STIFF:
        return "bdf", f"fastest decay {float(f'{ratio:.3g}'):g} times the fastest forcing: stiff, CVODE BDF"
    return "adams", f"fastest decay {max(ratio, 0):.2g} times the fastest motion: not stiff, CVODE Adams"


def check_method(model: Model, method: str) -> None:
    """Raises SceneError where a method cannot integrate a scene."""
    unknowns = model.unknowns
    settles = model.interface.film.settle is not None
    if method == "trbdf2" and not settles:
        raise SceneError("run.solver", '"trbdf2"', "another solver: it is for films whose cells tear and fill")
    if unknowns.has_residual_form and method != "ida" and not (settles and method == "trbdf2"):
        what = "a massless ring" if unknowns.massless else "a film with unknowns of its own"
        raise SceneError("run.solver", f'"{method}" for {what}', '"ida" (or "auto")')
    if method == "expm" and not (unknowns.linear and unknowns.constant):
        what = "a nonlinear film, contact or friction" if not unknowns.linear else "parameters that change with time"
        raise SceneError("run.solver", f'"expm" with {what}', 'film.model = "linear" and constant parameters')


def _fastest_decay(run) -> float:
    """Fastest decay (1/s) of the scene linearised where the run starts (a squeezed film is stiffer by the cube) and at
    the equilibrium of the loads of each interval's start and of the run's end."""
    model, s = run.model, run.segment(0).gap_state(0.0, run.y0)
    varying = (model.scene.shaft.speed, viscosity_of(model.scene.film))
    places = {(max(s[DZ], model.f[FLOOR] - model.clearance),): run.intervals[0]}
    end = run.intervals.end
    for interval in (*run.intervals.few, end):
        places[model.axial_shift(interval), *(constant_and_slope(q, interval)[0] for q in varying)] = interval
    decays = []
    for at, interval in places.items():
        try:
            decays.append(float(np.max(-model.linear_scene(interval, shift=at[0]).eigen()[0].real)))
        except SceneError:
            # A film that there is no more where the run would end: how far it comes is found out by running.
            if interval is not end:
                raise
    return max(decays)


def choose_start(run: RunState, asked: str) -> Start:
    """The start of a run (RunState, still at rest) whose scenario says `asked` (`run.start`)."""
    if asked != "auto":
        return Start(asked)
    closed = run.start_film() <= run.model.face[COLLAPSE]
    doubt = _response_is_doubtful(run)
    if doubt and not closed:
        return Start("rest", f"at rest: {doubt}")
    ruled_out = run.model.no_steady_response()
    if ruled_out:
        return Start("rest", f"at rest: {ruled_out}")
    if closed:
        # Where both are closed the response is the one to tell of.
        overlap = f"at rest the faces would overlap; on the linear steady response, though {doubt}"
        return Start("steady", overlap if doubt else STABLE)
    if run.start_film(run.steady_start()) <= run.model.face[COLLAPSE]:
        return Start("rest", "at rest: the linear steady response closes the film")
    return Start("steady", STABLE)


def _response_is_doubtful(run) -> str:
    """Why the motion need not stay near a linear steady response; else empty."""
    unknowns = run.model.unknowns
    if run.model.scene.initial.given:
        return "[initial] gives the rest"
    if run.model.contact is not None:
        return "contact is not linear"
    if unknowns.seals:
        return "what a secondary seal holds is not linear"
    if unknowns.film_unknowns is not None:
        return "a film with unknowns of its own starts with them settled"
    return "" if unknowns.constant else "conditions change with time"


def starts_of(scenario: Scenario) -> dict[str, bool]:
    """Whether a run can start "steady" and at "rest", where its film is open.  Raises as `prepare_run`."""
    run, _ = prepare_run(scenario)
    floor, rest = run.model.face[COLLAPSE], np.zeros(run.model.unknowns.size)
    steady = not run.model.no_steady_response() and run.start_film(run.steady_start()) > floor
    return {"steady": bool(steady), "rest": bool(run.start_film(rest) > floor)}


def set_start(run, scene: Scene | RadialScene, start: Start) -> None:
    """Set the initial unknowns of a run: rest, the linear steady state, an archive's last state, and what [initial]
    gives; followers ride, as they are made.  Raises SceneError where the film is closed there, or ArchiveError."""
    run.start = start
    if isinstance(scene, RadialScene):
        return
    unknowns, taken = run.model.unknowns, start.taken
    run.y0 = np.zeros(unknowns.size)
    if taken == "steady":
        run.y0, run.extrema.steady = run.steady_start(), True
    elif taken != "rest":
        rates = unknowns.n + np.arange(unknowns.n_mechanical - unknowns.n)
        y = _last_unknowns(taken, unknowns)
        run.y0[: unknowns.n] = y[: unknowns.n]
        run.y0[rates] = y[rates]
    for k, ring in ((0, scene.initial.stator), (1, scene.initial.rotor)):
        for part, given in asdict(ring).items():
            base = f"{RING_NAMES[k]}_{part.removesuffix('_rate')}"
            if given is None or base not in unknowns.names:
                continue
            place = unknowns.names.index(base)
            place = unknowns.rate_places[place] if part.endswith("_rate") else place
            if place >= 0:
                run.y0[place] = given
    run.check_start()


def _last_unknowns(start, unknowns) -> np.ndarray:
    """The unknowns (size,) that the archive `start` ends with."""
    state = archive.last_state(start)
    if not state:
        raise archive.ArchiveError(f"{start}: holds no last state to start from")
    try:
        names, y = [str(name) for name in state["names"]], np.array(state["y"], float)
    except archive.READING_ERRORS as error:
        raise archive.ArchiveError(f"{start}: its last state is none of this program's ({error})") from None
    if names != unknowns.names or y.shape != (unknowns.size,):
        found, wanted = (", ".join(one)[:200] for one in (names, unknowns.names))
        raise SceneError("run.start", f"{start} with unknowns {found}", f"an archive with the unknowns {wanted}")
    if not np.all(np.isfinite(y)):
        raise archive.ArchiveError(f"{start}: its last state is no number")
    return y
