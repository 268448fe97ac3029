"""Methods in time: neutral whirls, stiff films, touch between steps, friction, rings without inertia, chaos."""

import math
from dataclasses import replace

import numpy as np
from sksundae.cvode import CVODE

from ....analysis.rotating_wave import RotatingWave, contact_tilt_aligned, free_model, least_damped
from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.modes import verdict
from ....dynamics.run_state import RunState
from ....dynamics.signals import signals
from ....numerics.piecewise_linear import PiecewiseLinear
from ....quantities import in_words
from ....scene.forces import Contact, SecondarySeal, contact_thresholds
from ....scene.rings import RING_NAMES, AxialRunout, Rotor, Stator
from ....simulation.selection import choose_method
from ....simulation.stability import critical_speed
from ....solvers.contract import Counts, SolverFailure, Status
from ....solvers.fixed_step import REFERENCE_METHODS
from ....solvers.methods import METHODS
from . import ZERO_FILM, integrated, row, run_from

# Neutral stability: at the critical speed a whirl neither grows nor decays; what a method makes of it is its own.

# Growth in a turn of the whirl that a method may hide.
SLOW = 0.05
# Whirl followed, over the tilt that closes the gap; turns of it; a solver tolerance as a user might set it.
AMPLITUDE, NEUTRAL_TURNS, BARE = 0.1, 60, 1e-5


def threshold(scene) -> float | None:
    """Speed (rad/s) where the eigenvalues of the unforced scene cross the axis; None if nowhere."""
    return critical_speed(free_model(scene, 1.0))


def neutral_run(scene, speed: float, turns: float, accuracy: float = 1e-8):
    """The unforced run at its threshold, starting on its neutral circle, and what reads the whirl."""
    model = free_model(scene, speed, accuracy)
    run, whirling = RunState(model, turns * 2 * math.pi / speed), RotatingWave(model)
    frequency, shape = least_damped(model, speed)
    run.y0 = whirling.state(AMPLITUDE * contact_tilt_aligned(model) * shape, frequency)
    return run, whirling


def growth(run, whirling, method: str, tolerance: float, most: float = math.inf) -> tuple[float, int]:
    """Growth rate (1/s) that a method at a bare solver tolerance gives the neutral whirl, over the last three
    quarters of the run, less the eigenvalue's; and right-hand sides spent.  Raises SolverFailure, or TimeoutError
    beyond `most` right-hand sides."""
    counts, steps = Counts(), []
    for t, y, _ in REFERENCE_METHODS[method](run.segment(0), 0.0, run.y0, method, tolerance, counts):
        steps.append((t, np.abs(whirling.relative(y[:, : run.model.unknowns.n].T))))
        if counts.rhs > most:
            raise TimeoutError(f"more than {most:.3g} right-hand sides")
    t, size = (np.concatenate([step[k] for step in steps]) for k in range(2))
    late = t > 0.25 * t[-1]
    exact = max(mode.value.real for mode in run.model.linear_scene().modes() if mode.kind == "tilt")
    return float(np.polyfit(t[late] - t[-1], np.log(size[late]), 1)[0]) - exact, counts.rhs


def meets_neutral_stability(scene, run) -> str:
    """A whirl that hardly grows or decays."""
    whirls = [mode.value for mode in run.model.linear_scene().modes() if mode.value.imag]
    slowest = min(whirls, key=lambda value: abs(value.real / value.imag), default=1.0 + 1.0j)
    share = abs(math.expm1(2 * math.pi * slowest.real / abs(slowest.imag)))
    said = f"a whirl that grows or decays by {in_words('share', share, digits=1)} a turn of its own"
    return said if share < SLOW else ""


def show_neutral_stability() -> list[dict]:
    """BDF at a bare tolerance of 1e-5 damps, Adams errs too; the matrix exponential keeps the circle."""
    scene = reference_scene("FMR", 3.0)
    speed = threshold(scene)
    run, whirling = neutral_run(scene, speed, NEUTRAL_TURNS)
    turn = 2 * math.pi / speed
    rates = {m: growth(run, whirling, m, BARE)[0] * turn for m in ("bdf", "adams", "expm")}

    def named(method, words):
        return f"{words} {'pumps' if rates[method] > 0 else 'damps'}", abs(rates[method])

    kept = "matrix exponential keeps the circle", abs(rates["expm"])
    default = "tightens the accuracy until the method's own damping cannot decide, and asks the eigenvalues as well"
    words = "growth per turn"
    damps = row(1, "Neutral stability: BDF", named("bdf", "BDF, tolerance 1e-5,"), kept, words, default)
    return damps + row(1, "Neutral stability: Adams", named("adams", "Adams, tolerance 1e-5,"), kept, words, default)


# Stiff squeeze film: flat faces at 1 % of their clearance, where damping is a million times that of the design.

CLEARANCE, STIFF_ACCURACY, STIFF_BUDGET = 1e-5, 1e-6, 20_000


def squeezed():
    """A flat ring on springs of 5 N/um pushed to 1 % of its clearance; 8 s bring it back."""
    scene = reference_scene("FMR")
    flat = replace(scene.film, model="radial", coning=0.0, outer_radius=0.036)
    support = replace(scene.rotor.support, axial_stiffness=5e6, radius=0.036)
    ring = replace(scene.rotor, support=support)
    return run_from(replace(scene, film=flat, rotor=Rotor(**vars(ring)), stator=Stator()), 8.0, STIFF_ACCURACY,
                   rotor_z=0.99 * CLEARANCE)  # fmt: skip


def meets_stiff_squeeze(scene, run) -> str:
    """Whether the program calls the run stiff."""
    method, why = choose_method(run)
    return why.partition(":")[0] if method == "bdf" else ""


def show_stiff_squeeze() -> list[dict]:
    """Right-hand sides that a second of motion costs: DOP853 given 20 000, BDF to the end."""
    run, counts, reached = squeezed(), Counts(), 0.0
    for t, _, _ in METHODS["dop853"](run.segment(0), 0.0, run.y0, "dop853", STIFF_ACCURACY, counts):
        reached = t[-1]
        if counts.rhs > STIFF_BUDGET:
            break
    run = squeezed()
    outcome, _ = integrated(run, "bdf", STIFF_ACCURACY)
    if outcome.status != Status.OK:
        raise RuntimeError(outcome.message)
    left = math.floor(math.log10(run.duration / reached))
    return row(
        2, "Stiff squeeze film", (f"DOP853 crawls: 1e-{left} of the run done", counts.rhs / reached),
        ("BDF runs to the end", outcome.counts.rhs / run.duration), "right-hand sides per second of motion",
        f'looks at the fastest decay where the run starts and takes "{choose_method(run)[0]}" by itself',
    )  # fmt: skip


# Touch: a gap that closes for four degrees of each turn, between the steps of a solver that has no reason to look.

TOUCH_TURNS, TOLERANCE, HALF = 300, 1e-4, math.radians(2)
SOFT = Contact(roughness=1e-7, compressive_strength=1e-6)


def bare_root_search(scene) -> int:
    """Dips, of 300, in which CVODE's own root search (Adams, 1e-4) sees a change of sign, its unknowns the tilt of the
    scene's stator under a rotor that runs out."""
    speed, support, inertia = scene.shaft.speed, scene.stator.support, scene.stator.transverse_inertia
    stiffness, damping = support.tilt()
    scale = scene.film.clearance / scene.film.outer_radius

    def stator(t, y, yp):
        g, v, runout = complex(y[0], y[1]), complex(y[2], y[3]), 0.1 * scale * np.exp(1j * speed * t)
        a = -(damping * v + stiffness * (g - runout)) / inertia
        yp[0], yp[1], yp[2], yp[3] = v.real, v.imag, a.real, a.imag

    def gap(t, y, events):
        events[0] = math.cos(HALF) + math.cos(speed * t)

    gap.terminal, gap.direction = [False], [0]
    absolute = TOLERANCE * np.array([scale, scale, scale * speed, scale * speed])
    solver = CVODE(stator, method="Adams", rtol=TOLERANCE, atol=absolute, max_num_steps=10**7, eventsfn=gap,
                   num_events=1)  # fmt: skip
    turn = 2 * math.pi / speed
    found = solver.solve(np.array([0.0, TOUCH_TURNS * turn]), np.zeros(4))
    return len(set(np.floor(np.atleast_1d(found.t_events) / turn).astype(int))) if found.t_events is not None else 0


def by_the_watch(scene) -> int:
    """Contacts that the package locates in the same 300 turns at the same accuracy."""
    depth = (scene.film.clearance - contact_thresholds(SOFT)[1]) / math.cos(HALF)
    dipping = replace(
        scene,
        film=replace(scene.film, model="linear", coefficients=ZERO_FILM),
        rotor=Rotor(axial_runout=[AxialRunout(order=1, amplitude=depth, phase=math.pi / 3)]),
        contact=SOFT,
    )
    run, events = run_from(dipping, TOUCH_TURNS * 2 * math.pi / scene.shaft.speed, TOLERANCE), []
    outcome, _ = integrated(run, "adams", TOLERANCE)
    run.contacts.tell(events.extend, end=(outcome.tau, outcome.y))
    return len(events)


def meets_touch_between_steps(scene, run) -> str:
    """A scene with asperities."""
    return "[contact]: its faces may touch between two steps" if run.model.contact is not None else ""


def show_touch_between_steps() -> list[dict]:
    """Dips missed by CVODE's root search and by the search on every step's own polynomial."""
    scene = reference_scene("FMS")
    return row(
        3, "Touch between steps", ("CVODE Adams' root search, 1e-4", TOUCH_TURNS - bare_root_search(scene)),
        ("gap searched on each step's polynomial", TOUCH_TURNS - by_the_watch(scene)), f"dips missed of {TOUCH_TURNS}",
        "bounds the gap over every step from its two ends and searches wherever it may close",
    )  # fmt: skip


# Coulomb friction: a ring that rubs itself to rest; a smoothed sign of the sliding speed lets it creep away.

FRICTION, START, CYCLES, COULOMB_ACCURACY = 0.31, 5e-6, 12, 1e-6
# Width of the smoothed sign (m/s); the largest sliding speed is 3.5 mm/s.
WIDTH = 1e-4


def off_rest(seal) -> tuple[float, int]:
    """How far (clearances) from where friction stops it the ring stands in the end, and right-hand sides."""
    scene = reference_scene("FMS")
    support = replace(scene.stator.support, axial_damping=0.0)
    stator = replace(scene.stator, support=support, secondary_seal=seal)
    film = replace(scene.film, model="linear", coefficients=ZERO_FILM)
    scene = replace(scene, film=film, stator=stator, rotor=Rotor())
    natural = math.sqrt(support.axial_stiffness / stator.mass)
    run = run_from(scene, CYCLES * 2 * math.pi / natural, COULOMB_ACCURACY, stator_z=START)
    outcome, _ = integrated(run, "adams", COULOMB_ACCURACY)
    # Amplitude falls by 2 F/k each half cycle, until the spring is weaker than friction.
    rest, dead = START, FRICTION / support.axial_stiffness
    while abs(rest) > dead:
        rest = -math.copysign(abs(rest) - 2 * dead, rest)
    return abs(outcome.y[0] - rest) / run.model.clearance, outcome.counts.rhs


def meets_coulomb_friction(scene, run) -> str:
    """A ring on an O-ring."""
    held = [RING_NAMES[k] for k in run.model.unknowns.seals]
    return f"[{held[0]}.secondary_seal]: the ring sticks and slips" if held else ""


def show_coulomb_friction() -> list[dict]:
    """Error of the resting place after twelve periods."""
    smooth, calls = off_rest(SecondarySeal(radius=0.045, friction_force=FRICTION, law="regularised", width=WIDTH))
    real, fewer = off_rest(SecondarySeal(radius=0.045, friction_force=FRICTION))
    return row(
        4, "Coulomb friction", (f"sign smoothed over 0.1 mm/s creeps ({calls} right-hand sides)", smooth),
        (f"real sticking stands ({fewer})", real), "resting place, of clearance",
        'sticks at exactly zero speed and slips when the load exceeds friction (law = "coulomb")',
    )  # fmt: skip


# Vanishing inertia: a lighter ring decays ever faster towards the same motion, and without inertia has no rates.

VANISHING_TURNS, VANISHING_ACCURACY, LIGHT, VANISHING_BUDGET = 2, 1e-6, 1e-7, 60_000


def lightened(share: float):
    """The reference FMS seal under a runout, its stator's mass and inertia a share of what they are."""
    scene = reference_scene("FMS", 0.5, 25e-6, 25e-6)
    ring = vars(scene.stator)
    parts = {name: share * ring[name] for name in ("mass", "transverse_inertia", "polar_inertia")}
    return replace(scene, stator=Stator(**(ring | parts)), rotor=Rotor(runout=25e-6))


def begun(share: float):
    """A run of that scene over some turns."""
    scene = lightened(share)
    return run_from(scene, VANISHING_TURNS * 2 * np.pi / scene.shaft.speed, VANISHING_ACCURACY)


def calls(share: float, method: str, limit: float = np.inf) -> float:
    """Right-hand sides per turn; a run that spends more than `limit` is judged by the turns it made."""
    run, counts, reached = begun(share), Counts(), 0.0
    for t, _, _ in METHODS[method](run.segment(0), 0.0, run.y0, method, VANISHING_ACCURACY, counts):
        reached = t[-1] / run.duration
        if counts.rhs > limit:
            break
    return counts.rhs / (reached * VANISHING_TURNS)


def without_mass() -> tuple[float | None, float]:
    """How far the tilt by CVODE at no inertia, whose rates nobody writes, and by IDA is from that of a ring with next
    to none (BDF); over clearance / outer radius.  None for CVODE if it gives up."""
    end = integrated(begun(LIGHT), "bdf", VANISHING_ACCURACY)[0].y
    massless = begun(0.0)
    x = massless.model.unknowns.names.index("stator_tilt_x")

    def off(y):
        return float(np.hypot(*(y[x : x + 2] - end[x : x + 2]))) * massless.model.face[1] / massless.model.clearance

    by_ida = off(integrated(begun(0.0), "ida", VANISHING_ACCURACY)[0].y)
    try:
        *_, (_, y, _) = METHODS["bdf"](massless.segment(0), 0.0, massless.y0, "bdf", VANISHING_ACCURACY, Counts())
    except SolverFailure:
        return None, by_ida
    return off(y[-1]) if np.isfinite(y[-1]).all() else None, by_ida


def meets_vanishing_inertia(scene, run) -> str:
    """A ring without mass."""
    return "a floating ring without mass or inertia" if run.model.unknowns.massless else ""


def show_vanishing_inertia() -> list[dict]:
    """Adams at a ten-millionth of the inertia, and CVODE at none, beside IDA at none."""
    by_cvode, by_ida = without_mass()
    default = "drops the rates of a ring without inertia and takes IDA on the residual form"
    return [
        *row(6, "Vanishing inertia", (f"CVODE Adams, {LIGHT:.0e} of the mass", calls(LIGHT, "adams", VANISHING_BUDGET)),
             ("IDA, no mass at all", calls(0.0, "ida")), "right-hand sides per turn", default),
        *row(6, "No inertia", ("CVODE at m = 0 writes no rates: stands still, says done", by_cvode),
             (f"IDA at m = 0 against {LIGHT:.0e} of the mass", by_ida), "tilt, of clearance / radius", default),
    ]  # fmt: skip


# Chaos: two correct runs of a rubbing ring part exponentially; their averages agree.

RAMP, CHAOS_TURNS, SETTLED, PER_TURN, ACCURACIES = 0.05, 130, 40, 16, (1e-5, 1e-7)


def rubbing():
    """Green's ring as a misaligned stator at 2.6 times its resonance, in a thin fluid between rough hard faces, under a
    runout of 0.55 mrad (the scene of scenarios/rub_chaotic.toml)."""
    scene = reference_scene("FMS", 0.5, speed=2442.0)
    support = replace(scene.stator.support, axial_damping=150.0)
    film = replace(scene.film, model="radial", viscosity=0.04e-3, outer_pressure=0.3e5)
    return replace(
        scene,
        film=film,
        stator=replace(scene.stator, support=support, misalignment=PiecewiseLinear((0.0, RAMP), (0.0, 3e-3))),
        rotor=replace(scene.rotor, runout=PiecewiseLinear((0.0, RAMP), (0.0, 0.55e-3))),
        contact=Contact(roughness=1e-6, compressive_strength=1e9, friction_coefficient=0.1),
    )


def followed(accuracy: float):
    """Tilt over its scale once a turn, and film over the clearance, after the ramp."""
    scene = rubbing()
    turn = 2 * math.pi / scene.shaft.speed
    run = run_from(scene, CHAOS_TURNS * turn, accuracy)
    outcome, recorder = integrated(run, "adams", accuracy, turn / PER_TURN)
    if outcome.status != Status.OK:
        raise RuntimeError(outcome.message)
    t, q, rate = recorder.arrays()
    late = t > t[-1] - (CHAOS_TURNS - SETTLED) * turn
    last = run.segment(-1)
    h_min = signals(last, t[late] - last.time, q[late], rate[late])["h_min"] / run.model.clearance
    x = run.model.unknowns.names.index("stator_tilt_x")
    return (q[late, x] + 1j * q[late, x + 1])[::PER_TURN] * run.model.face[1] / run.model.clearance, h_min


def meets_chaos(scene, run) -> str:
    """Asperities on which an unstable ring lands."""
    if run.model.contact is None or verdict(run.model.linear_scene().modes()) != "unstable":
        return ""
    return "an unstable ring with [contact]: it may hit its asperities without end"


def show_chaos() -> list[dict]:
    """How far apart once a turn in the end, and in the mean film thickness."""
    (one, film), (other, film_other) = (followed(accuracy) for accuracy in ACCURACIES)
    spread = np.std(other)
    apart = np.abs(one[: len(other)] - other[: len(one)])[-50:].max() / spread
    averages = abs(film.mean() - film_other.mean()) / film_other.std()
    return row(
        9, "Chaos", ("single runs, accuracies 1e-5 and 1e-7", apart),
        (f"their mean film over {CHAOS_TURNS - SETTLED} turns", averages),
        "apart, in standard deviations of the motion",
        "measures the exponent in study rub, says where forecasts end, and compares averages beyond",
    )  # fmt: skip


EXHIBITS = {
    "neutral_stability": (1, (show_neutral_stability,), meets_neutral_stability),
    "stiff_squeeze": (2, (show_stiff_squeeze,), meets_stiff_squeeze),
    "touch_between_steps": (3, (show_touch_between_steps,), meets_touch_between_steps),
    "coulomb_friction": (4, (show_coulomb_friction,), meets_coulomb_friction),
    "vanishing_inertia": (6, (show_vanishing_inertia,), meets_vanishing_inertia),
    "chaos": (9, (show_chaos,), meets_chaos),
}
