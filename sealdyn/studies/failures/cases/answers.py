"""Where a run begins and which answer there is: contradicting starts, several clearances, linear theory."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, newton

from ....analysis.shooting import Shooter
from ....analysis.sources import lebeck_1979
from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.elastic_ring import operating_point, operating_points
from ....dynamics.model import Model
from ....dynamics.run_state import RunState
from ....films import film_named
from ....quantities import everyday, in_words
from ....scene.excitation import Shaft
from ....scene.film import Film
from ....scene.fluid import GasReynolds
from ....scene.forces import Contact
from ....scene.rings import ElasticRing, Stator, Support
from ....scene.scene import Closing, Initial, RingStart, Scene, SceneError
from ....simulation.film_error import steady_tilt
from ....simulation.margin import steady_state
from ....solvers.contract import Recorder, Status
from ....solvers.integrate import solve
from . import cruise_dam, integrated, row, run_from
from .integration import lightened

# Inconsistent start: closed faces, loads no film can carry, rates and pressures that contradict the film's
# equation.

BELOW = -2e-6


def closed_start() -> list[dict]:
    """A start 2 um beyond the other face: a film taken at its mean thickness has no pole there."""
    scene = reference_scene("FMR")
    film, support = replace(scene.film, model="radial"), scene.rotor.support
    wide, width = film.clearance, film.outer_radius - film.inner_radius
    cone, middle = film.coning * width, 0.5 * (film.inner_radius + film.outer_radius)

    def rates(t, y):
        damping = 2 * np.pi * middle * film.viscosity * width**3 / (y[0] + cone / 2) ** 3
        return [y[1], support.axial_stiffness * (wide - y[0]) - damping * y[1]]

    through = solve_ivp(rates, (0.0, 0.01), [BELOW, 0.0], "LSODA", rtol=1e-6, atol=1e-12)
    closed = max(0.0, -float(np.min(through.y[0]))) if through.success else np.nan
    run = run_from(replace(scene, film=film), 0.01, 1e-6, rotor_z=wide - BELOW)
    try:
        run.check_start()
        said, refused = "starts all the same", -BELOW
    except SceneError:
        said, refused = "refused with a sentence, no step taken", 0.0
    return row(
        7, "Start inside the other face", ("film of mean thickness: a success, says LSODA", closed * everyday("m")[1]),
        (said, refused * everyday("m")[1]), "overlap of the faces accepted, um",
        "refuses a start below the film's floor and names the key, what was found and what to try",
    )  # fmt: skip


def no_equilibrium() -> list[dict]:
    """Closing force above what the converging film can ever carry: Newton on the clearance goes below zero."""
    scene = reference_scene("FMR")
    film = replace(scene.film, model="radial", clearance=None)
    overloaded = replace(scene, film=film, closing=Closing(balance_ratio=1.3, spring_force=0.0))
    opening = film_named("radial", film).opening_law(film)
    area = np.pi * (film.outer_radius**2 - film.inner_radius**2)
    closing = 1.3 * area * film.outer_pressure

    def excess(c):
        return opening(c, 0.0, film.outer_pressure) - closing

    c = 1e-5
    for _ in range(50):
        step = 1e-3 * c
        moved = c - excess(c) * 2 * step / (excess(c + step) - excess(c - step))
        if not moved > 0:
            break
        c = moved
    try:
        Model(overloaded)
        said, left = "assembled all the same", abs(excess(c)) / closing
    except SceneError:
        said, left = "refused with a sentence", 0.0
    return row(
        7, "Loads without an equilibrium",
        (f"Newton leaves the film at {in_words('h_min', c, digits=2)}", abs(excess(c)) / closing),
        (said, left), "force left unbalanced, of the closing force",
        "searches every clearance from a thousandth to a thousand times the coning and says what could be carried",
    )  # fmt: skip


def contradicting_rates() -> list[dict]:
    """A massless ring begun with rates of zero, and with the rates that its film's equation asks for."""
    run = run_from(lightened(0.0), 0.01, 1e-6)
    segment, sizes = run.segment(0), []
    left = np.empty(segment.size)
    for yp in (np.zeros(segment.size), segment.start(0.0, run.y0)[1]):
        segment.residual(0.0, run.y0, yp, left)
        sizes.append(float(np.max(np.abs(left[: segment.n]))))
    return row(
        7, "Rates at the start of a DAE", ("started with rates of zero", sizes[0]),
        ("rates from the balance itself", sizes[1]), "unbalanced, N and N m",
        "solves the residual for the rates before IDA takes its first step",
    )  # fmt: skip


def unsettled_pressures() -> list[dict]:
    """A gas film that stores, begun with the low pressure everywhere, and with the pressures of its steady flow."""
    film = Film(
        inner_radius=0.032, outer_radius=0.040, inner_pressure=1e5, outer_pressure=6e5, clearance=5e-6, coning=2e-4,
        gas="air", temperature=300.0, model="gas_reynolds", gas_reynolds=GasReynolds(cells=(8, 8)),
    )  # fmt: skip
    ring = dict(mass=0.3, transverse_inertia=3e-4, polar_inertia=5e-4)
    support = Support(axial_stiffness=5e4, axial_damping=100.0, radius=0.04)
    scene = Scene(
        shaft=Shaft(speed=1000.0), film=film, stator=Stator(**ring, support=support), initial=Initial(RingStart(z=0.0))
    )
    moved = []
    for settled in (False, True):
        run = run_from(scene, 2e-3, 1e-6)
        if not settled:
            # Products of pressure and film.
            run.y0[run.model.unknowns.film] = film.inner_pressure * film.clearance
        # A run that goes on settles nothing.
        recorder, resume = Recorder(1e-5), None if settled else (0, 0.0, run.y0)
        outcome = solve(run, "ida", 1e-6, recorder, resume=resume)
        at = run.model.unknowns.names.index("stator_z")
        far = float(np.max(np.abs(recorder.arrays()[1][:, at]))) / film.clearance
        moved.append(1.0 if outcome.status == Status.COLLAPSED else far)
    return row(
        7, "Pressures that contradict", ("begun with the low pressure everywhere: the faces close", moved[0]),
        ("pressures of the steady flow, by Newton", moved[1]), "motion of a ring at rest, of the clearance",
        "solves for the steady film at the gap of the start before the first step",
    )  # fmt: skip


def meets_inconsistent_start(scene, run) -> str:
    """A start that film and loads need not agree with."""
    if not run.model.loads_are_balanced(run.model.start):
        return "no clearance at which the film holds its loads"
    if run.model.unknowns.film_unknowns is not None:
        return "its film has pressures of its own to begin with"
    if run.model.unknowns.massless:
        return "a ring without mass has rates that follow from its position"
    return "[initial] gives a start of its own" if scene.initial.given else ""


# Several answers: a diverging film with rough faces has a clearance that touches and one that does not hold, a gas dam
# that hardly narrows two that hold, a wavy ring that bends three wavinesses.

# Spring (N) beside a balance of 0.6.
SPRING = 65.0


def diverging():
    """The reference seal coned the other way, with asperities, closed by its balance and a spring."""
    scene = reference_scene("FMR")
    film = replace(scene.film, model="radial", coning=-0.5e-3, clearance=None)
    rough = Contact(roughness=0.5e-6, compressive_strength=1e9)
    return replace(scene, film=film, contact=rough, closing=Closing(balance_ratio=0.4, spring_force=50.0))


def two_that_hold():
    """The reference seal's ring on Zuk's dam at cruise, 0.2 mrad narrower outwards: thin, the taper holds it, thick,
    choking does, and in between neither."""
    scene = reference_scene("FMS")
    film = cruise_dam(coning=-0.2e-3)
    return replace(scene, film=film, closing=Closing(balance_ratio=0.6, spring_force=SPRING))


def _by_newton(model) -> float:
    """The clearance (m) that Newton's method finds from 10 um."""
    return newton(lambda clearance: _excess(model, clearance), 10e-6)


def _excess(model, clearance) -> float:
    """Opening over closing force, less 1."""
    pressures = model.scene.film.inner_pressure, model.scene.film.outer_pressure
    return model.interface.opening_force(clearance, *pressures) / model.closing_force() - 1


def one_that_holds() -> list[dict]:
    """Newton from the design clearance finds one answer, the search over all clearances every one."""
    model = Model(diverging())
    roots = model.interface.equilibria
    alone = _by_newton(model)
    held = [root.clearance for root in roots if root.stable]
    off, residual = min(abs(alone - c) for c in held), max(abs(_excess(model, c)) for c in held)
    return row(
        11, "Several clearances",
        (f"Newton from 10 um: {in_words('h_min', alone, digits=3)}, which does not hold", off / held[0]),
        (f"every clearance searched: {len(roots)} found, {len(held)} holds", residual),
        "off the clearance that holds, relative",
        "starts at the widest clearance that holds and says how many there are (study equilibrium lists them)",
    )  # fmt: skip


def another_that_holds() -> list[dict]:
    """Newton finds the wide clearance and knows nothing of the narrow one, where a landing ring may come to stay."""
    model = Model(two_that_hold())
    roots = model.interface.equilibria
    held = sorted(root.clearance for root in roots if root.stable)
    alone, residual = _by_newton(model), max(abs(_excess(model, c)) for c in held)
    told = in_words("h_min", alone, digits=3)
    return row(
        11, "Two stable clearances",
        (f"Newton from 10 um: {told}, which holds", max(abs(alone / c - 1) for c in held)),
        (f"every clearance searched: {', '.join(in_words('h_min', c, digits=3) for c in held)} hold", residual),
        "off the other clearance that holds, relative",
        "starts at the widest clearance that holds and says how many there are (study equilibrium lists them)",
    )  # fmt: skip


def three_wavinesses() -> list[dict]:
    """Lebeck's elastic ring of 35 half heights: a search finds the waviness that is left under load where it looks,
    and knows of no other; the middle one of three does not hold."""
    ring = ElasticRing(bending_stiffness=77.0, torsion_ratio=6.0, radius=47.54e-3)
    scene, half = lebeck_1979.scene_of(lebeck_1979.ROWS[1], (6, 36)), lebeck_1979.HALF
    initial = 35.0 * half
    waves = [replace(scene.stator.waviness[0], amplitude=initial)]
    scene = replace(scene, stator=replace(scene.stator, elastic=ring, waviness=waves))
    along = [operating_point(scene, net) for net in np.geomspace(0.1, 20.0, 12) * half]
    found = operating_points(scene, along)
    nets = [point.net for point, _ in found]
    near = (0.2 * half, 0.5 * half)
    alone = brentq(lambda h: operating_point(scene, h).initial - initial, *near, rtol=1e-6)
    return row(
        11, "Three waviness states",
        (f"a search from 0.2 to 0.5 c: {alone / half:.3g} c", max(abs(alone / net - 1.0) for net in nets)),
        (f"every waviness searched: {', '.join(f'{net / half:.3g}' for net in nets)} c",
         max(abs(point.initial / initial - 1.0) for point, _ in found)),
        "off another waviness of the same ring, relative",
        "lists every operating point of an elastic ring and whether it holds (study elastic-ring)",
    )  # fmt: skip


def meets_several_answers(scene, run) -> str:
    """More than one clearance or waviness."""
    if scene.stator.elastic is not None:
        return "[stator.elastic]: a ring that its load bends may have several wavinesses"
    found = len(run.model.interface.equilibria)
    return f"{found} clearances at which film and closing force balance" if found > 1 else ""


# Where linear theory fails: at the tilt where the linear film says the faces touch they are far apart.

# Share of the tilt at which parallel faces touch, above which linear theory is doubted.
SMALL = 0.1
TURNS, ACCURACY = 20, 1e-7
# Of the linear onset: the way to it, and beyond.
SHARES = (0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 1.2)


def scene(misalignment: float, model: str = "radial"):
    """The reference FMR seal over a misaligned stator."""
    reference = reference_scene("FMR", 0.5, fixed=misalignment)
    return replace(reference, film=replace(reference.film, model=model))


def linear_gap(misalignment: float) -> float:
    """Smallest film over the clearance, as the linear steady state has it."""
    model = Model(scene(misalignment, "linear"), ACCURACY)
    most, _, closing, _ = steady_state(model)[-1]
    return min(h - closing - r * most for r, h in model.aligned_gaps()) / model.clearance


def onset() -> float:
    """Misalignment (rad) at which the linear film touches."""
    return brentq(linear_gap, 1e-6, 0.1, xtol=1e-15)


def orbits(touching: float) -> dict:
    """Periodic orbits at SHARES of the linear onset, each guessed from the two before: the linear steady state plus
    what the nonlinear film adds to it."""
    found, known = {}, [(0.0, 0.0)]
    for share in SHARES:
        shooter = Shooter(scene(share * touching), ACCURACY, tight=1e-9)
        guess = linear = shooter.guess()
        if found:
            (last, less), (before, added) = known[-2:]
            guess = linear + added + (added - less) * (share - before) / (before - last)
        found[share] = shooter.find(guess, target=1e-7, most=25)
        known.append((share, found[share].start - linear))
    return found


def meets_linear_theory(scene, run) -> str:
    """A tilt that is no small part of the one at which aligned faces touch."""
    tilt, _, _ = steady_tilt(run.model)
    share = abs(tilt) * scene.film.outer_radius / run.model.clearance
    return f"its steady tilt is {share:.2g} clearances at the outer radius" if share > SMALL else ""


def show_linear_theory() -> list[dict]:
    """Film that is left where linear theory has none, by the periodic orbit, checked in time."""
    touching = onset()
    way = orbits(touching)
    orbit, later = way[1.0], way[SHARES[-1]]
    found, still = (o.extremes["h_min"]["of_clearance"] for o in (orbit, later))
    # The run begins a little off the orbit and must come back to it.
    run = RunState(Model(scene(touching), ACCURACY), TURNS * orbit.period)
    run.y0[: len(orbit.start)] = 0.999 * orbit.start
    run.extrema.windows[1] = [run.duration - orbit.period, run.duration]
    integrated(run, "adams", ACCURACY)
    in_time = run.extrema.records[1, 0] / run.model.clearance
    return row(
        12, "Linear theory at large tilt",
        (f"linear film: touch at {in_words('tilt', touching, digits=3)}", abs(found - linear_gap(touching))),
        (f"radial film: open, and {still:.2g} C left at 1.2 times that", abs(in_time - found)),
        "smallest film, of clearance",
        'takes the radial film (film.model = "auto") unless the tilt is small enough for the linear one',
    )  # fmt: skip


EXHIBITS = {
    "inconsistent_start": (7, (closed_start, no_equilibrium, contradicting_rates, unsettled_pressures),
                           meets_inconsistent_start),
    "several_answers": (11, (one_that_holds, another_that_holds, three_wavinesses), meets_several_answers),
    "linear_theory": (12, (show_linear_theory,), meets_linear_theory),
}  # fmt: skip
