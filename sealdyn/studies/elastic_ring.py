"""Elastic ring: which waviness a wavy ring has left under load, of the one it was made with; every operating point, and
whether it holds, by the slope of the one over the other and by letting it go."""

import cmath
import contextlib
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table, columns, table_of
from ..dynamics.elastic_ring import (
    OperatingPoint,
    harmonic,
    operating_point,
    operating_points,
    order_of,
    state,
    unloaded,
    with_cells_of,
)
from ..dynamics.warm_state import at_work
from ..faces import contact
from ..faces.film_thickness import lay_waves
from ..faces.geometry import CLEARANCE, CONTACT_FORCE, DZ, FORCE
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.scene import Scene, SceneError, frozen_at_start
from ..units import Length, Time
from . import Info

INFO = Info(
    timed=("lebeck_elastic", 14),
    asks="Which waviness is left under load?",
    wavy=True,
    units={
        **dict.fromkeys(("net", "initial", "clearance", "from", "to"), "m"), "turned": "rad", "leakage": "m^3/s",
        "time": "s", **dict.fromkeys(("load_support", "friction_coefficient", "let_go/points"), "1"),
    },
    along={"curve": ("net",), "points/let_go": ("instant",)},
)  # fmt: skip
# Net wavinesses that are looked at, in initial ones.
LEAST, LARGEST = 1e-3, 1.3
# Steps of letting a ring go, and how near (as a share) it has come back.
STEPS, NEAR = 80, 0.1
COLUMNS = ("net", "initial", "turned", "load_support", "clearance", "leakage", "friction_coefficient")
# Operating points by whether they hold: style and words.
ROOTS = {True: ("good circle large front", "holds"), False: ("bad cross large front", "does not hold")}


@dataclass(frozen=True)
class Settings:
    """The curve of initial over net waviness, and how a ring is let go."""

    net_from: Length | None = None
    """Least net waviness; without it a thousandth of the initial one."""
    net_to: Length | None = None
    """Largest net waviness; without it a little beyond the initial one."""
    points: int = 33
    """Points of the curve."""
    disturbance: float = 0.05
    """Share by which a ring is let go from less and from more than an operating point."""
    duration: Time = 1.0
    """How long it is followed."""


def run(scenario, settings, tools) -> Answer:
    """The curve of initial over net waviness, operating points by two roads."""
    scene = bending(scenario, "torsion_ratio")
    ring, initial, order = scene.stator.elastic, unloaded(scene), order_of(scene)
    low, high = asked_range(settings, "study.elastic_ring.net", "m", LEAST * initial, LARGEST * initial)
    # The same cells for all: those of a wave as high as the film is thick, which is as thick as the faces are rough.
    rough = scene.contact.roughness if scene.contact else (low * high) ** 0.5
    scene = with_cells_of(scene, min(max(rough, low), high))
    nets = [float(net) for net in np.geomspace(low, high, max(3, settings.points))]
    rows = tools.map(partial(point_of, scene), nets, "wavinesses")
    along = [OperatingPoint(**row) for row in rows if "failed" not in row]
    if not along:
        raise SceneError("stator.elastic", rows[0]["failed"], "a seal with a balance")
    found = operating_points(scene, along)
    points = [_let_go(scene, settings, point, holds) for point, holds in found]
    answer = {
        "order": order,
        "initial": initial,
        "compliance": ring.compliance(order),
        "curve": columns(along, COLUMNS),
        "points": points,
    }
    return Answer(answer, _found(answer), [_table(answer)], _panels(answer), _notes(answer))


def bending(scenario, more: str) -> Scene:
    """The scene as it works; raises SceneError where its ring does not bend, and asks for `more` keys of that."""
    scene = at_work(frozen_at_start(scenario.scene))[0]
    if scene.stator.elastic is None:
        raise SceneError("stator.elastic", "nothing", f"the ring that bends: bending_stiffness, radius, {more}")
    return scene


def asked_range(settings, key: str, unit: str, low: float, high: float) -> tuple[float, float]:
    """Ends (SI) of a range that a study is asked for by two settings, key_from and key_to, in place of `low` and
    `high`; `key` "study.NAME.SETTING".  Raises SceneError for one that does not rise from above 0."""
    asked = key.rpartition(".")[2]
    given = [getattr(settings, f"{asked}_{end}") for end in ("from", "to")]
    low, high = (default if end is None else end for end, default in zip(given, (low, high), strict=True))
    if not 0.0 < low < high:
        raise SceneError(f"{key}_to", f"{high:g} {unit}", f"more than {asked}_from = {low:g} {unit} > 0")
    return low, high


def point_of(scene, net: float) -> dict:
    """The operating point of a net waviness (m), as a row."""
    return asdict(operating_point(scene, net))


def _let_go(scene, settings, point, holds) -> dict:
    """An operating point, whether it `holds` by the slope, and what becomes of it from less and from more waviness."""
    ways = []
    for share in (1.0 - settings.disturbance, 1.0 + settings.disturbance):
        try:
            time, wave, clearance = release(scene, point.net, share * point.net, settings.duration, STEPS)
        except ValueError as reason:
            ways.append({"from": share * point.net, "failed": str(reason)})
            continue
        ways.append({"from": share * point.net, "to": float(abs(wave[-1])), "time": time.tolist(),
                     "net": np.abs(wave).tolist(), "clearance": clearance.tolist()})  # fmt: skip
    ends = [way.get("to") for way in ways]
    back = None if None in ends else all(abs(end / point.net - 1.0) < NEAR * settings.disturbance for end in ends)
    return {**asdict(point), "stable": bool(holds), "comes_back": back, "let_go": ways}


def _found(numbers) -> str:
    """Which wavinesses the load leaves, or what the ring would have to be made with."""
    made, points, curve = in_words("m", numbers["initial"]), numbers["points"], numbers["curve"]
    if points:
        left = [f"{in_words('m', point['net'])} ({ROOTS[point['stable']][1]})" for point in points]
        return f"Of {made} of {numbers['order']} waves the load leaves {', '.join(left)}."
    ends = [in_words("m", end(curve["initial"])) for end in (min, max)]
    least = numbers["initial"] < min(curve["initial"])
    less = f"; if any is left, it is less than the {in_words('m', curve['net'][0])} looked at" if least else ""
    return f"No operating point of a ring made with {made}: those looked at need {ends[0]} to {ends[1]}{less}."


def _notes(numbers) -> list[str]:
    points, notes = numbers["points"], []
    if any(point["comes_back"] not in (None, point["stable"]) for point in points):
        notes.append("Slope and motion disagree where waves turn as they change, or the duration is short.")
    for point in points:
        if point["comes_back"] is None:
            why = next(way["failed"] for way in point["let_go"] if "failed" in way)
            notes.append(f"At {in_words('m', point['net'])} the motion was not followed: {why}.")
    if sum(point["stable"] for point in points) > 1:
        notes.append("Several hold: how the seal was loaded decides which; from lifted faces it is the largest.")
    return notes


def _table(numbers) -> Table:
    """Every operating point."""
    names = (
        ("m", "waviness left", "net"), ("1", "stable by the slope", "stable"), ("1", "comes back", "comes_back"),
        ("angle", "turned", "turned"), ("clearance", "clearance", "clearance"),
        ("share", "load support", "load_support"), ("1", "friction", "friction_coefficient"),
        ("leakage", "leakage", "leakage"),
    )  # fmt: skip
    return table_of("operating points", names, numbers["points"])


def _panels(numbers) -> list[Panel]:
    """The curve with its crossings above load support along it; the waviness of points that were let go over time."""
    curve, made, points = numbers["curve"], numbers["initial"], numbers["points"]
    initial = [Series("line", curve["net"], curve["initial"], label="made with this, left with that", style="film")]
    load = [Series("line", curve["net"], curve["load_support"], style="contact")]
    for stable, (style, words) in ROOTS.items():
        own = [point for point in points if point["stable"] == stable]
        at = [point["net"] for point in own]
        if own:
            initial.append(Series("marks", at, [made] * len(at), label=words, style=style))
            load.append(Series("marks", at, [point["load_support"] for point in own], style=style))
    net = Axis("m", "net waviness", scale="log", low=curve["net"][0], high=curve["net"][-1])
    level = Level(made, "made with", style="theory dashed", number=True, legend=True)
    return [
        Panel("Waviness made and left", net, Axis("m", "initial waviness", scale="log"), initial, [level]),
        Panel("", net, Axis("share", "load support"), load, below=True),
        _let_go_panel(points),
    ]


def _let_go_panel(points) -> Panel:
    """Waviness over time of every point that was let go, from its first step on."""
    title, series = "Let go a little beside each point", []
    for point in points:
        style, words = ROOTS[point["stable"]]
        colour = style.split()[0]
        for way in point["let_go"]:
            if "net" in way:
                label = "" if any(one.label == words for one in series) else words
                series.append(Series("line", way["time"][1:], way["net"][1:], label=label, style=colour))
    if not series:
        return Panel(title, note="no operating point whose motion was followed")
    levels = [Level(point["net"], style="grey dotted") for point in points]
    # A ring that is back at once does not enlarge its last step.
    sizes = [size for one in series for size in one.y] + [way["from"] for point in points for way in point["let_go"]]
    waviness = Axis("m", "waviness", scale="log", low=0.95 * min(sizes), high=1.05 * max(sizes))
    return Panel(title, Axis("time", scale="log"), waviness, series, levels)


# --- a ring let go: film and asperities level its waves, in time -----------------------------------------
# **Source** balance and compliance as in dynamics/elastic_ring.py; the film's own flow, with its cavities in motion,
# decides how fast.
# **Valid** ring and film without inertia, aligned faces, one order of waves on the ring that stands still.

# Newton's iterations of a step at most, their differences and what counts as solved, in the wave.
MOST, APART, SOLVED = 25, 1e-5, 1e-8
# How often a step without solution is halved.
HALVINGS = 10


def release(scene: Scene, net: float, start: float, duration: float, steps: int) -> tuple[np.ndarray, ...]:
    """What becomes of an operating point when its wave is another one, `start` (m) in place of `net`: times (s), net
    waves (complex, m) and clearances (m), shapes (steps + 1,); implicit Euler's method with `steps` that grow towards
    the `duration` (s).

    Raises ValueError where a step has no solution."""
    _, interface, s, _, initial = state(scene, net)
    soft, order, film = scene.stator.elastic.compliance(order_of(scene)), order_of(scene), interface.film
    closing = interface.closing.at(initially(scene.film.inner_pressure), initially(scene.film.outer_pressure),
                                   initially(interface.closing.spring))  # fmt: skip
    f, wave = interface.f, scene.stator.waviness[0]

    def lay(at):
        """Clearance and waves of the unknowns into the block and the gap state."""
        a = complex(at[1], at[2])
        lay_waves(f, [replace(wave, amplitude=abs(a), phase=-cmath.phase(a), order=order)], [])
        s[DZ] = at[0] - f[CLEARANCE]

    def excess(at, dt, held, x):
        """What the step's end leaves of axial and wave balance."""
        lay(at)
        code = film.settle(f, s, 1.0 / dt, held, x)
        if code:
            raise ValueError(film.status[code])
        film.wrench(f, s, x)
        rough = 0.0
        if interface.contact is not None:
            contact.contact_load(interface.contact, f, s)
            rough = s[CONTACT_FORCE]
        a = complex(at[1], at[2])
        left = a - initial - soft * harmonic(interface, x, a, at[0])
        return np.array([(s[FORCE] + rough) / closing - 1.0, left.real / start, left.imag / start])

    def step(at, dt, held, x):
        """The unknowns after a step; None where Newton's iterations find none."""
        for _ in range(MOST):
            left = excess(at, dt, held, x)
            jacobian = np.empty((3, 3))
            for k in range(3):
                moved = at.copy()
                moved[k] += APART * start
                jacobian[:, k] = (excess(moved, dt, held, x.copy()) - left) / (APART * start)
            change = np.linalg.solve(jacobian, -left)
            # Not further at once than half the wave.
            change *= min(1.0, 0.5 * start / max(np.max(np.abs(change)), 1e-300))
            at = at + change
            if np.max(np.abs(change)) < SOLVED * start:
                excess(at, dt, held, x)
                return at
        return None

    def advanced(at, dt, x, halvings=0):
        """As `step`, in halves where it finds none."""
        before = x.copy()
        with contextlib.suppress(ValueError, np.linalg.LinAlgError):
            after = step(at, dt, before, x)
            if after is not None:
                return after
        if halvings == HALVINGS:
            wave = in_words("m", abs(complex(at[1], at[2])))
            raise ValueError(f"a step of {dt:.3g} s from a wave of {wave} has no solution")
        x[:] = before
        return advanced(advanced(at, 0.5 * dt, x, halvings + 1), 0.5 * dt, x, halvings + 1)

    at = np.array([interface.clearance, start, 0.0])
    lay(at)
    x = interface.steady(f, s)
    times, found = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, steps) * duration]), [at]
    for dt in np.diff(times):
        at = advanced(at, dt, x)
        found.append(at)
    at = np.array(found)
    return times, at[:, 1] + 1j * at[:, 2], at[:, 0]
