"""Steady state: the periodic response by harmonic balance, or shooting where it is not smooth, with Floquet
multipliers, instead of waiting for transients."""

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..analysis.harmonic_balance import FilmBalance, HarmonicBalance, NotSmooth
from ..analysis.shooting import ForcedWave, NoOrbit, Orbit, Shooter
from ..answers import Answer, Axis, Level, Panel, Series, Table, table_of
from ..dynamics import modes
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.signals import signals
from ..faces.film_thickness import h_min
from ..faces.geometry import GX, GY
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.reader import with_values
from ..simulation.margin import steady_extremes
from ..simulation.selection import choose_method
from ..simulation.stability import critical_speed
from ..solvers.contract import Recorder, Status
from ..solvers.integrate import solve
from . import Info

INFO = Info(
    timed=("fms_reference", 5),
    asks="What is the periodic steady state?",
    wavy=True,
    grooved=True,
    units={
        "period": "s", "time": "s", "h_min": "m", "speed": "rad/s",
        **dict.fromkeys(("relative_tilt_x", "relative_tilt_y", "relative_misalignment", "shaft_angle"), "rad"),
        **dict.fromkeys(("multipliers", "multiplier", "part", "shooting", "transient", "defects"), "1"),
    },
    along={"orbit": ("time",), "linear": ("time",), "linear/multipliers": ("mode",), "multipliers": ("mode",),
           "near_threshold": ("speed",)},
)  # fmt: skip
# Cycles of a period of which each has samples of its own from there on, how many, and the most samples.
FEW, PER_CYCLE, MOST = 4, 48, 20_000
# Turns of a run without a period that are drawn, and samples of each.
SHOWN, PER_TURN = 20, 64
NOT_KNOWN = "Whether the seal keeps it is not known: the film stores."
# Accuracy of the orbit that is shown, at least.
SHARP = 1e-8


@dataclass(frozen=True)
class Settings:
    """The period, and the comparison with waiting."""

    turns: int = 1
    """Common periods of the forcing that are taken as one period (2 finds half-frequency responses)."""
    samples: int = 256
    """Samples of a period in the figure; more where the forcing has many cycles in it."""
    approach: tuple[float, ...] = (0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995)
    """Speeds, as parts of the critical speed, at which the cost is compared with a transient's; empty: none."""
    longest: int = 4000
    """Longest transient tried, in periods."""


def run(scenario, settings, tools) -> Answer:
    """Orbit, multipliers, verdict on the nonlinear orbit; against harmonic balance; cost near the threshold."""
    asked = (("turns", settings.turns, 1), ("samples", settings.samples, 2), ("longest", settings.longest, 1))
    for key, given, least in asked:
        if given < least:
            raise ScenarioError(scenario.name, f"study.steady_state.{key}", str(given), f"{least} or more")
    try:
        finder = _finder(HarmonicBalance, scenario, settings)
    except NoOrbit as reason:
        with suppress(NoOrbit):
            return _turning(ForcedWave(scenario.scene, scenario.run.accuracy), settings)
        try:
            finder = _finder(FilmBalance, scenario, settings)
        except NoOrbit:
            return _time_domain(scenario, str(reason))
    linear, stores = finder.model.linear_scene(), finder.model.interface.stores
    critical, verdict = None if stores else critical_speed(finder.model), modes.verdict(linear.modes())
    try:
        finder, orbit, waves = _orbit(finder, scenario, settings)
    except NoOrbit as reason:
        if stores:
            return _time_domain(scenario, str(reason))
        values = [v for mode in linear.modes() for v in {mode.value, mode.value.conjugate()}]
        foretold = [complex(np.exp(v * finder.period)) for v in values]
        numbers = {"status": Status.FAILED, "period": finder.period, "multipliers": None, "stable": None,
                   "h_min": None, "relative_misalignment": None, "critical_speed": critical, "near_threshold": [],
                   "orbit": None, "reason": str(reason), "defects": finder.defects,
                   "linear": {"verdict": verdict, "multipliers": [[m.real, m.imag] for m in foretold],
                              **_linear_film(finder, settings.samples)}}  # fmt: skip
        there = f"critical speed {in_words('speed', critical)}" if critical else "no critical speed"
        found = f"No periodic steady state was found: {reason}; linear theory: {verdict}, {there}."
        return Answer(numbers, found, panels=_panels(numbers))
    tools.say(0.1)
    answers = linear.answers(finder.model.segment().harmonics())
    most, least, _ = steady_extremes(linear, answers, finder.period)
    rows = []
    if critical and not finder.model.unknowns.has_residual_form:
        rows = _near_threshold(scenario, settings, critical, tools)
    numbers = {
        "period": orbit.period,
        "multipliers": None if stores else [[float(m.real), float(m.imag)] for m in orbit.multipliers],
        "stable": None if stores else orbit.stable,
        "residual": orbit.residual,
        "periods_used": orbit.periods_used,
        "h_min": waves["h_min"],
        "relative_misalignment": waves["relative_misalignment"],
        "linear": {"relative_max": most, "relative_min": least, "verdict": verdict},
        "unknowns": finder.model.unknowns.names,
        "start": {name: float(x) for name, x in zip(finder.model.unknowns.names, orbit.start, strict=False)},
        "orbit": _waves(finder.model, waves),
        "near_threshold": rows,
        "critical_speed": critical,
    }
    kind = "found" if stores else "stable" if orbit.stable else "UNSTABLE"
    found = f"The periodic steady state is {kind}; h_min {in_words('h_min', waves['h_min']['value'], digits=5)}."
    return Answer(numbers, found, _tables(numbers), _panels(numbers), [NOT_KNOWN] if stores else [])


def _turning(wave, settings) -> Answer:
    """Of a film that stores: what turns with its forcing, a point of that frame."""
    orbit = wave.find()
    tilt, low = wave.relative(orbit), orbit.extremes["h_min"]
    times = np.linspace(0.0, orbit.period, settings.samples)
    turned = tilt * np.exp(1j * wave.speed * times)
    names = wave.model.unknowns.names
    numbers = {
        "period": orbit.period, "multipliers": None, "stable": None, "residual": orbit.residual, "periods_used": 0,
        "h_min": low, "relative_misalignment": orbit.extremes["relative_misalignment"], "linear": None,
        "unknowns": names, "start": {name: float(x) for name, x in zip(names, orbit.start, strict=False)},
        "orbit": {"time": times.tolist(), "relative_tilt_x": turned.real.tolist(),
                  "relative_tilt_y": turned.imag.tolist(),
                  "relative_misalignment": np.full(len(times), abs(tilt)).tolist(),
                  "h_min": np.full(len(times), low["value"]).tolist()},
        "near_threshold": [], "critical_speed": None,
    }  # fmt: skip
    film = in_words("h_min", low["value"], digits=5)
    found = f"The steady state turns with its forcing, at {in_words('speed', wave.speed)}; h_min {film}."
    return Answer(numbers, found, _tables(numbers), _panels(numbers), [NOT_KNOWN])


def _finder(kind, scenario, settings):
    return kind(scenario.scene, scenario.run.accuracy, settings.turns)


def _orbit(finder, scenario, settings) -> tuple[HarmonicBalance | Shooter, Orbit, dict]:
    """What found the orbit, the orbit, and its samples."""
    count = _samples(finder, settings.samples)
    try:
        orbit = finder.with_multipliers(finder.find())
        return finder, orbit, finder.extremes(orbit.points, count)
    except NotSmooth:
        shooter = _finder(Shooter, scenario, settings)
        orbit = shooter.find()
        # Of a seal that follows closely the accuracy of a run is more than the whole relative tilt.
        return shooter, orbit, shooter.extremes(orbit.start, count, min(scenario.run.accuracy, SHARP))


def _samples(finder, asked: int) -> int:
    """Samples of a period: as asked, and more where the fastest forcing has many cycles in it."""
    fastest = max((abs(h.frequency) for h in finder.model.segment().harmonics()), default=0.0)
    cycles = math.ceil(fastest * finder.period / (2 * math.pi))
    return max(asked, min(PER_CYCLE * cycles, MOST)) if cycles > FEW else asked


def _linear_film(finder, samples) -> dict:
    """Thinnest film of the linear steady state over one period; below zero where it would cut into the faces."""
    segment, run = finder.model.segment(), RunState(finder.model, finder.period)
    at, _, _ = segment.steady_motion()
    places, times = finder.model.unknowns.among_three(), np.linspace(0.0, finder.period, samples)
    moving = [run.model.vector(q[places], rate[places]) for q, rate in map(at, times)]
    films = [h_min(run.model.face, segment.gap_state(t, y))[0] for t, y in zip(times, moving, strict=True)]
    return {"time": times.tolist(), "h_min": [float(h) for h in films]}


def _waves(model, waves) -> dict:
    """Relative tilt and h_min at some times, from the run's own signals; of conditions that do not change."""
    if model.unknowns.film_unknowns:
        return _without_film(model, waves)
    columns = signals(model.segment(), waves["times"], waves["displacements"], waves["rates"])
    names = ("time", "relative_tilt_x", "relative_tilt_y", "relative_misalignment", "h_min", "shaft_angle")
    return {name: [float(x) for x in columns[name]] for name in names}


def _without_film(model, waves) -> dict:
    """The same of the rings' motion alone, for a film whose forces have more to them."""
    segment, rows = model.segment(), []
    for tau, q, rate in zip(*(waves[name] for name in ("times", "displacements", "rates")), strict=True):
        s = segment.gap_state(tau, model.vector(q, rate))
        rows.append([tau, s[GX], s[GY], np.hypot(s[GX], s[GY]), h_min(model.face, s)[0]])
    names = ("time", "relative_tilt_x", "relative_tilt_y", "relative_misalignment", "h_min")
    return {name: [float(x) for x in column] for name, column in zip(names, zip(*rows, strict=True), strict=True)}


def _tables(numbers) -> list[Table]:
    """The orbit, and what shooting and waiting cost near the critical speed."""
    low, tilt, linear = numbers["h_min"], numbers["relative_misalignment"], numbers.get("linear") or {}
    largest = max((math.hypot(*m) for m in numbers["multipliers"] or ()), default=None)
    columns = [("time", "period"), ("1", "largest multiplier"), ("h_min", "h_min"), ("share", "of the clearance"),
               ("misalignment", "misalignment from"), ("misalignment", "to"), ("misalignment", "linear from"),
               ("misalignment", "to"), ("1", "periods integrated")]  # fmt: skip
    row = [numbers["period"], largest, low["value"], low["of_clearance"], tilt["min"], tilt["max"],
           linear.get("relative_min"), linear.get("relative_max"), numbers.get("periods_used")]  # fmt: skip
    tables = [Table("steady state", columns, [row])]
    if numbers["near_threshold"]:
        names = (("share", "of critical speed", "part"), ("speed", "speed", "speed"),
                 ("1", "periods by shooting", "shooting"), ("1", "by waiting", "transient"),
                 ("1", "waiting ends", "transient_ends"), ("1", "failed", "failed"))  # fmt: skip
        rows = [{key: value or None for key, value in row.items()} for row in numbers["near_threshold"]]
        tables.append(table_of("cost near the threshold", names, rows))
    return tables


def _panels(numbers) -> list[Panel]:
    """Orbit, multipliers, film and cost: those that there are."""
    orbit, linear, panels = numbers.get("orbit"), numbers.get("linear") or {}, []
    periodic = numbers["period"] and orbit
    over = "one period" if periodic else "the last turns"
    if orbit:
        x, y = orbit["relative_tilt_x"], orbit["relative_tilt_y"]
        marks = [Series("marks", [0.0], [0.0], style="grey plus")]
        marks += [Series("marks", x[:1], y[:1], label="shaft angle 0", style="black circle front")] if periodic else []
        curve = Series("line", x, y, style="tilt")
        panels.append(Panel(f"Relative tilt over {over}", Axis("tilt", "tilt about x"), Axis("tilt", "tilt about y"),
                            [curve, *marks], equal=True))  # fmt: skip
    elif numbers.get("defects"):
        left = numbers["defects"]
        panels.append(Panel("Newton's method", Axis("1", "step"), Axis("1", "what is left, scales", "log"),
                            [Series("line", list(range(1, len(left) + 1)), left, style="contact circle")]))  # fmt: skip
    values, name = numbers.get("multipliers"), "Floquet multipliers"
    if not values:
        values, name = linear.get("multipliers"), "Multipliers of linear theory"
    if values:
        turn = np.linspace(0, 2 * np.pi, 200)
        real, imaginary = np.array(values).T
        largest = float(np.max(np.hypot(real, imaginary)))
        circle = Series("line", np.cos(turn), np.sin(turn), label="unit circle", style="grey thin")
        dots = Series("marks", real, imaginary, style=f"{'tilt' if largest < 1.0 else 'contact'} open circle")
        panels.append(Panel(f"{name}: largest {largest:.3g}", Axis("1", "real part"), Axis("1", "imaginary part"),
                            [circle, dots], equal=True))  # fmt: skip
    film = orbit or (linear if "h_min" in linear else None)
    if film:
        named = f"Thinnest film over {over}" if orbit else "Thinnest film of linear theory"
        panels.append(Panel(named, Axis("time"), Axis("h_min", "h_min"),
                            [Series("line", film["time"], film["h_min"], style="film" if orbit else "theory")],
                            [] if orbit else [Level(0.0, "the faces touch", style="contact")]))  # fmt: skip
    rows = [row for row in numbers["near_threshold"] if "failed" not in row]
    if rows:
        panels.append(_cost_panel(rows))
    return panels or [Panel("Periodic steady state", note=numbers.get("reason") or "no periodic orbit")]


def _cost_panel(rows) -> Panel:
    """Periods that shooting and waiting integrate, over the distance from the critical speed."""
    away, cost = [1.0 - row["part"] for row in rows], [row["shooting"] for row in rows]
    series = [Series("line", away, cost, label="shooting", style="tilt circle")]
    waited = [row["transient"] or None for row in rows]
    if any(waited):
        series.append(Series("line", away, waited, label="waiting for the transient", style="theory dashed square"))
    lost = [at for at, periods in zip(away, waited, strict=True) if periods is None]
    if lost:
        beyond = max(20.0 * max(cost), 2.0 * max((w for w in waited if w), default=0.0))
        series.append(Series("marks", lost, [beyond] * len(lost), label="transient: no answer", style="contact cross"))
    x = Axis("1", "distance below the critical speed, 1 - w/w_cr", "log", 1.2 * max(away), min(away) / 1.2)
    return Panel("Cost near the threshold", x, Axis("1", "periods integrated", "log"), series)


def _near_threshold(scenario, settings, critical, tools) -> list[dict]:
    points = [
        {"part": part, "speed": part * critical, "turns": settings.turns, "longest": settings.longest}
        for part in settings.approach
        # A second frequency that does not follow the shaft has no period in common with it there.
        if RunState(Model(with_values(scenario, {"shaft.speed": part * critical}).scene), 1.0).period()
    ]
    return tools.map(partial(cost, scenario), points, "cost")


def cost(scenario, point: dict) -> dict:
    """Periods of integration that shooting needs at one speed, and periods until a transient from rest repeats
    itself within the accuracy (None: not within `longest`, or it ends as `transient_ends` says)."""
    scenario = with_values(scenario, {"shaft.speed": point["speed"]})
    shooter = Shooter(scenario.scene, scenario.run.accuracy, point["turns"])
    row = {"part": point["part"], "speed": point["speed"]}
    orbit = shooter.find()
    row |= {"shooting": orbit.periods_used, "multiplier": float(np.max(np.abs(orbit.multipliers)))}
    row["transient"], row["transient_ends"] = waiting(
        scenario.scene, shooter, orbit, scenario.run.accuracy, point["longest"]
    )
    return row


def waiting(scene, shooter, orbit, accuracy: float, longest: int) -> tuple[int | None, str]:
    """Periods until a transient from rest stays within the accuracy of the orbit; None where it does not within the
    `longest`, or ends before: then with words why."""
    chunk, start = 32, 0
    while start < longest:
        run = RunState(Model(scene, accuracy), shooter.period * (start + chunk))
        recorder = Recorder(shooter.period)
        outcome = solve(run, choose_method(run)[0], accuracy, recorder)
        if outcome.status != Status.OK:
            return None, "the film closes" if outcome.status == Status.COLLAPSED else "the solver gives up"
        _, q, _ = recorder.arrays()
        away = np.max(
            np.abs(q - orbit.start[: run.model.unknowns.n]) / run.model.scales[: run.model.unknowns.n], axis=1
        )
        late = np.nonzero(away > accuracy)[0]
        if len(late) == 0 or late[-1] + 1 < len(away):
            return (int(late[-1] + 1) if len(late) else 0), ""
        start, chunk = start + chunk, 2 * (start + chunk)
    return None, ""


def _time_domain(scenario, reason: str) -> Answer:
    """Without a common period: a long run, of which the last turns are drawn, and it says so."""
    scene = scenario.scene
    speed = abs(initially(scene.shaft.speed)) or 1.0
    turns = 200
    run = RunState(Model(scene, scenario.run.accuracy), turns * 2 * math.pi / speed)
    half = 0.5 * run.duration
    run.extrema.windows[1:] = [[half, run.duration], [half, run.duration]]
    recorder = Recorder(run.duration / turns / PER_TURN)
    outcome = solve(run, choose_method(run)[0], scenario.run.accuracy, recorder)
    record, unknowns = run.extrema.records[1], run.model.unknowns
    times, q, q_rate = (part[-SHOWN * PER_TURN :] for part in recorder.arrays())
    shown = {"times": times, "displacements": q, "rates": q_rate}
    numbers = {
        "period": None,
        "multipliers": None,
        "stable": None,
        "status": str(outcome.status),
        "h_min": {"value": float(record[0]), "of_clearance": float(record[0] / run.model.clearance)},
        "relative_misalignment": {"max": float(record[4]), "min": float(record[6])},
        "near_threshold": [],
        # What a film holds is not recorded, and its forces do not follow from the motion alone.
        "orbit": _waves(run.model, shown) if unknowns.constant and not unknowns.film_unknowns else None,
        "reason": reason,
    }
    low = in_words("h_min", float(record[0]), digits=5)
    found = f"No period to shoot for: {reason}; in time over {turns} turns, the second half: h_min {low}."
    return Answer(numbers, found, _tables(numbers), _panels(numbers))
