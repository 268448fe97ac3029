"""Contact onset: the forcing at which the steady film first touches, by continuation of the periodic orbit."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import brentq

from ..analysis.shooting import NoOrbit, Shooter, TooMuchWork
from ..dynamics.interface import opening_parts
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.steady_extremes import steady_extremes
from ..numerics.piecewise_linear import points
from ..scenario.errors import ScenarioError
from ..scenario.settings import must_be_number, si_unit, with_values
from ..scene import variants
from ..scene.checks import unused
from ..scene.contact import touch_height
from ..status import Status
from ._words import quantity, shown_in

REFUSES = ("secondary-seal",)
# Right-hand sides that the path of orbits may take: three times what the dearest scenario needs.
MOST_WORK = 1_200_000
# A tilt (rad) that nobody calls small: gap and pressure are then wrong by a thousandth, and no seal runs so far off.
SMALL_TILT = 0.05
# Beyond this value of a key, SI, linear theory is not asked any more.
LARGEST = 1e9
ALONG = {"path": ("forcing",), "linear": ("forcing",), "curve": ("value",)}
# Of the key itself the answer knows the unit.
units = dict.fromkeys(("h_min", "axial", "clearance", "radius", "linear_radius", "touch"), "m") | {"tilt": "rad"}
units |= dict.fromkeys(("contact_force", "closing_force"), "N") | {
    "cavitation_pressure": "Pa",
    "start": "SI",
    "beyond_tilt": "rad",
}
units |= dict.fromkeys(("margin", "times_own", "ratio", "axial_opening", "multiplier", "curve/path/curve"), "1")


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fms_reference --set stator.misalignment=0", 14)


@dataclass(frozen=True)
class Settings:
    """What grows until the film touches, and what the onset is followed over."""

    key: str | None = None
    """Key that grows until the film touches; without it the tilt that the seal has: of an FMS rotor.runout before
    stator.misalignment, of an FMR stator.misalignment, of an FMSR rotor.misalignment, each before the other."""
    margin: float = 1e-3
    """Touch is a film of so much of the clearance; of rough faces where their asperities meet."""
    over: str | None = None
    """Another key, over which the onset is a curve."""
    values: tuple[float | str, ...] = ()
    """Values of that key."""
    floor: bool = False
    """Also with the pressure floored at the lower boundary pressure, along the curve too (slower)."""
    tolerance: float = 1e-6
    """Relative error of the onset."""
    most: float = 1000.0
    """An onset that linear theory sees beyond so many times the scenario's own value of the key is not followed;
    nor is one beyond any small tilt."""


def run(scenario, settings, tools) -> dict:
    """Linear and nonlinear onset of the key, the path of orbits to it, and a curve over another key."""
    key = settings.key or acting(scenario.scene)[0]
    must_be_number(scenario, key, "study.contact_onset.key")
    if unused(scenario.scene, {key}):
        found, expected = f"{key}, which this seal does not use", " or ".join(acting(scenario.scene))
        raise ScenarioError(scenario.name, "study.contact_onset.key", found, expected)
    base = {"key": key, "margin": settings.margin, "tolerance": settings.tolerance, "most": settings.most}
    # Plain and floored are separate points: the floored film may fail, or be interrupted, where the plain one holds.
    floors = [False, True] if settings.floor else [False]
    sets = [{}, *({settings.over: value} for value in settings.values if settings.over)]
    points = [{**base, "set": s, "floor": f} for s in sets for f in floors]
    rows = tools.map(partial(onset, scenario), points, "onset")
    plain, floored = rows[:: len(floors)], rows[1::2] if settings.floor else [None] * len(sets)
    curve = [
        {"value": value, **row} | ({"floored": brief(below)} if below else {})
        for value, row, below in zip(settings.values, plain[1:], floored[1:], strict=False)
    ]
    answer = {"key": key, "formula": None, "nonlinear": None, "radius": None, "margin": settings.margin,
              **plain[0], "floored": floored[0], "over": settings.over, "curve": curve}  # fmt: skip
    unit = si_unit(scenario.scene, key)
    answer["units"] = dict.fromkeys(("forcing", "formula", "nonlinear"), unit)
    answer["units"]["value"] = si_unit(scenario.scene, settings.over) if curve else "SI"
    if "failed" in answer:
        answer["status"] = Status.OK if answer.get("beyond_tilt") else Status.FAILED
    return {**answer, "verdict": _verdict(answer, unit)}


def acting(scene) -> list[str]:
    """Keys (dotted) of the tilts that may be imposed on the gap of a scene: those that it has first."""
    keys = ["rotor.misalignment" if scene.rotor.support else "rotor.runout", "stator.misalignment"]
    if not scene.stator.support:
        keys.reverse()
    return sorted(keys, key=lambda key: not any(points(variants.part(scene, key))))


def brief(row: dict) -> dict:
    """What a point of the floored curve says: the rest is its plain neighbour's."""
    return {k: row[k] for k in ("nonlinear", "ratio", "cavitation_pressure", "failed") if k in row}


def onset(scenario, point: dict) -> dict:
    """Linear and nonlinear onset of one scenario; `path` the orbits on the way.  Without a nonlinear onset it says why:
    `failed`; where that is an onset of linear theory beyond any small tilt, `beyond_tilt` (rad) is there too."""
    scenario = with_values(scenario, point["set"])
    floor = min(scenario.scene.film.floor, point["margin"] / 4)
    key, rough = point["key"], touch_height(scenario.scene)
    aligned = touching_when_aligned(scenario.scene, rough)
    if aligned:
        return {"key": key, "formula": 0.0, "nonlinear": 0.0, "margin": point["margin"], **aligned}

    def scene(value):
        # Until asperities meet the film is alone.
        given = with_values(scenario, {key: value, "film.floor": floor, "run.start": "steady"}).scene
        return variants.with_values(given, {"contact": None})

    try:
        formula, touching = linear_onset(scene, key, rough)
    except NoOrbit as reason:
        return {"key": key, "margin": point["margin"], "touch": rough, "failed": str(reason),
                **linear_films(scene, key, rough, scenario.scene)}  # fmt: skip
    result = {"key": key, "formula": formula, "linear_radius": touching, "margin": point["margin"], "touch": rough,
              "times_own": times_own(scenario.scene, key, formula),
              "clearance": Model(scene(0.0), 1e-6).clearance}  # fmt: skip
    if si_unit(scenario.scene, key) == "rad" and formula > SMALL_TILT:
        why = f"beyond any small tilt ({SMALL_TILT:g} rad): the film does not limit {key}"
        return {**result, "beyond_tilt": SMALL_TILT, "failed": why}
    if (result["times_own"] or 0.0) > point["most"]:
        return {**result, "failed": f"beyond {point['most']:g} times the scenario's own nothing is followed"}
    follower = Follower(scene, point["margin"], min(scenario.run.accuracy, 1e-7), touch=rough)
    try:
        value = follower.follow(formula, point["tolerance"])
    except NoOrbit as reason:
        return {**result, **follower.told(), "failed": str(reason)}
    clearance = follower.path[-1]["clearance"]
    # The path's chord iterations keep one monodromy; the verdict at the onset needs its own.
    monodromy = Shooter(scene(value), 1e-7, tight=1e-10).monodromy(follower.start)
    result |= {
        "nonlinear": value,
        "ratio": value / formula,
        "radius": follower.path[-1]["radius"],
        "start": [float(x) for x in follower.start],
        "axial_opening": follower.path[-1]["axial"] / clearance,
        "multiplier": float(np.max(np.abs(np.linalg.eigvals(monodromy)))),
        **follower.told(),
    }
    if point["floor"]:
        film = scenario.scene.film
        lowest = min(float(film.inner_pressure), float(film.outer_pressure))

        def floored(value):
            return variants.with_values(scene(value), {"film.cavitation_pressure": lowest})

        with_floor = Follower(floored, point["margin"], 1e-4, follower.monodromy, follower.start, rough)
        result["nonlinear"] = with_floor.close(value, 1e-4)
        result["ratio"] = result["nonlinear"] / formula
        result["cavitation_pressure"] = lowest
    return result


def touching_when_aligned(scene, rough: float) -> dict | None:
    """Where rough faces, whose asperities meet at the film thickness `rough` (m), touch without any forcing: radius (m)
    and what asperities carry (N); None if they do not."""
    if not rough:
        return None
    scene = variants.frozen_at_start(scene)
    model, film = Model(scene), scene.film
    thinnest, radius = min((h, r) for r, h in model.aligned_gaps())
    if thinnest >= rough:
        return None
    carried = opening_parts(scene)(model.clearance, film.inner_pressure, film.outer_pressure)
    return {"radius": float(radius), "touch": rough, "clearance": model.clearance, "contact_force": float(carried[1]),
            "closing_force": model.closing_force()}  # fmt: skip


def times_own(scene, key: str, value: float) -> float | None:
    """The value of a key over the scene's own; None where that is zero, or no number."""
    own = variants.part(variants.frozen_at_start(scene), key)
    return abs(value / own) if isinstance(own, int | float) and own else None


def linear_onset(scene, key: str, rough: float = 0.0) -> tuple[float, float]:
    """Value of the key at which the linear steady state closes the gap down to `rough` (m), and the radius (m) where it
    does.  Raises NoOrbit if the linear response does not depend on the key, or touches at any of its values."""

    def excess(value):
        model = Model(scene(value), 1e-6)
        film, radius = linear_film(model)
        return (film - rough) / model.clearance, radius

    if excess(0.0)[0] <= 0.0:
        raise NoOrbit(f"linear theory touches without any {key}")
    high = 1e-6
    while excess(high)[0] > 0:
        high *= 2
        if high > LARGEST:
            raise NoOrbit(f"linear theory does not touch at any {key}: it does not move the gap")
    value = brentq(lambda v: excess(v)[0], 0.0, high, xtol=1e-16, rtol=1e-13)
    return float(value), float(excess(value)[1])


def linear_film(model) -> tuple[float, float]:
    """Smallest film thickness (m) of the linear steady state, negative beyond touch, and its radius (m)."""
    linear = model.linear_scene()
    answers = [(h, linear.response(h)) for h in model.segment().harmonics()]
    most, _, closing = steady_extremes(linear, answers, RunState(model, 1.0).period())
    coning = model.face[3] + model.coning_change()
    inner, outer = model.clearance, model.clearance + coning * (model.face[1] - model.face[0])
    inner_left = inner - closing - model.face[0] * most
    outer_left = outer - closing - model.face[1] * most
    return float(min(inner_left, outer_left)), float(model.face[0 if inner_left <= outer_left else 1])


def linear_films(scene, key: str, rough: float, own) -> dict:
    """Of a seal that linear theory never sees touch: the clearance (m), and `linear`, the films (m) that it sees over
    the key, to ten times the value of the scene `own`, or 10 mrad where it has none."""
    value = variants.part(variants.frozen_at_start(own), key)
    value = abs(value) if isinstance(value, int | float) and value else None
    forcing = np.linspace(0.0, 10.0 * value if value else 1e-2, 11).tolist()
    films = [linear_film(Model(scene(v), 1e-6))[0] for v in forcing]
    if films[0] <= rough:
        # Nothing to see: it touches unforced.
        return {}
    return {
        "clearance": Model(scene(0.0), 1e-6).clearance,
        "linear": {"forcing": forcing, "h_min": films, "own": value},
    }


class Follower:
    """Follows the periodic orbit as the forcing grows, until its thinnest film is the margin, or `touch` (m)."""

    def __init__(self, scene, margin: float, accuracy: float, monodromy=None, start=None, touch: float = 0.0):
        self.scene, self.margin, self.accuracy, self.touch = scene, margin, accuracy, touch
        self.monodromy, self.start, self.path = monodromy, start, []
        self.known, self.work = [], 0

    def told(self) -> dict:
        """The path of orbits followed, and their clearance (m), if there is any."""
        names = ("forcing", "h_min", "tilt", "axial")
        path = {name: [p[name] for p in self.path] for name in names}
        return {"path": path, "clearance": self.path[-1]["clearance"]} if self.path else {}

    def excess(self, value: float) -> float:
        """h_min / clearance - margin of the orbit at one forcing, guessed from its neighbours."""
        scene = self.scene(value)
        # A floored film has kinks and costs a hundred times more: a looser orbit is all it can give.
        tight, target = (1e-10, 1e-8) if scene.film.cavitation_pressure is None else (1e-6, 1e-5)
        shooter = Shooter(scene, self.accuracy, tight=tight)
        shooter.most_work = MOST_WORK - self.work
        try:
            orbit = shooter.find(self._guess(value, shooter), self.monodromy, target=target, most=25)
        except TooMuchWork:
            raise TooMuchWork(f"more than {MOST_WORK} right-hand sides for the path of orbits") from None
        finally:
            self.work += shooter.work
        self.monodromy, self.start = orbit.monodromy, orbit.start
        self.known = [*[k for k in self.known if k[0] != value][-3:], (value, orbit.start, shooter.guess())]
        low, model = orbit.extremes["h_min"], shooter.model
        tilt, axial = orbit.extremes["relative_misalignment"]["max"], self._mean_axial(model, orbit)
        self.path.append({"forcing": value, "h_min": low["value"], "radius": low["radius"], "tilt": tilt,
                          "clearance": model.clearance, "axial": axial})  # fmt: skip
        return low["value"] / model.clearance - (self.touch / model.clearance or self.margin)

    def _guess(self, value, shooter):
        """The linear steady state, which scales with the forcing, plus what the nonlinear film adds to it: a
        polynomial in the forcing through the orbits known (and through nothing at no forcing)."""
        linear = shooter.guess()
        if not self.known:
            return linear if self.start is None else self.start
        if len(self.known) == 1:
            v, x, before = self.known[0]
            return linear + (x - before) * (value / v) ** 2
        nodes = [0.0, *(v for v, _, _ in self.known)]
        added = [np.zeros_like(linear), *(x - before for _, x, before in self.known)]
        total = np.zeros_like(linear)
        for i, (node, part) in enumerate(zip(nodes, added, strict=True)):
            others = [n for j, n in enumerate(nodes) if j != i]
            total += part * np.prod([(value - n) / (node - n) for n in others])
        return linear + total

    @staticmethod
    def _mean_axial(model, orbit):
        """Axial opening of the gap (m) at the start of the orbit: how far the seal has lifted."""
        signs = {"stator_z": 1.0, "rotor_z": -1.0}
        return float(sum(signs.get(name, 0.0) * x for name, x in zip(model.unknowns.names, orbit.start, strict=False)))

    def follow(self, linear: float, tolerance: float) -> float:
        """The forcing that touches, from below: ever shorter secant steps, since a trial orbit must not cross the
        closed film.  The gap closes ever more slowly (the seal opens axially), so a secant stops short of touch."""
        clearance = Model(self.scene(0.0), 1e-6).clearance if self.touch else 1.0
        low, low_left, step = 0.0, 1.0 - (self.touch / clearance or self.margin), 0.4 * linear
        for _ in range(80):
            value = low + step
            try:
                left = self.excess(value)
            except TooMuchWork:
                raise
            except NoOrbit:
                step *= 0.5
                if abs(step) < 1e-6 * linear:
                    raise
                continue
            slope = (left - low_left) / (value - low)
            low, low_left = value, left
            if abs(left) < 1e-6 or abs(step) < tolerance * value:
                return float(value - left / slope)
            aim = 0.3 * left if left > 0.03 else 0.0
            step = min((aim - left) / slope, 0.2 * linear)
            if value > 20 * linear:
                raise NoOrbit("no touch up to twenty times the linear onset")
        raise NoOrbit("the path of orbits did not reach touch in 80 steps")

    def close(self, near: float, tolerance: float) -> float:
        """The forcing that touches, by secants from a forcing already close."""
        a, b = 0.98 * near, near
        f_a, f_b = self.excess(a), self.excess(b)
        for _ in range(12):
            c = b - f_b * (b - a) / (f_b - f_a)
            c = min(max(c, 0.8 * near), 1.2 * near)
            a, f_a, b, f_b = b, f_b, c, self.excess(c)
            if abs(b - a) < tolerance * near:
                return float(b)
        raise NoOrbit("the floored onset did not settle")


def tables(answer) -> list:
    """The onset over another key."""
    found = [row.get(name) for row in answer["curve"] for name in ("formula", "nonlinear")]
    unit, factor = shown_in(answer.get("units", {}).get("nonlinear", "SI"), found)
    columns = ((answer["over"], "value"), (f"linear, {unit}", "formula", factor),
               (f"nonlinear, {unit}", "nonlinear", factor), ("with a floor", "floored.nonlinear", factor))  # fmt: skip
    return [(answer["curve"], columns)]


def _verdict(answer, unit) -> list[str]:
    if "failed" in answer:
        return _undecided(answer, unit)
    if answer["nonlinear"] == 0.0:
        return [f"The asperities touch without any {answer['key']}, at r = {answer['radius'] * 1e3:.4g} mm: at rest "
                f"they carry {answer['contact_force']:.4g} N of {answer['closing_force']:.5g} N."]  # fmt: skip
    lines = [
        f"The faces first touch at {answer['key']} = {quantity(answer['nonlinear'], unit, 6)}, at r = "
        f"{answer['radius'] * 1e3:.4g} mm; linear theory has {quantity(answer['formula'], unit, 6)}: "
        f"{100 * (answer['ratio'] - 1):+.1f} %.",
        f"The seal opens axially by {100 * answer['axial_opening']:.3g} % of the clearance at the onset.",
    ]
    if answer["multiplier"] > 1:
        lines[1] += "  The orbit there is unstable: the seal leaves it before it touches."
    floored = answer["floored"]
    if floored and "nonlinear" in floored:
        change = 100 * (floored["nonlinear"] / answer["nonlinear"] - 1)
        lines.append(
            f"With the pressure floored at {floored['cavitation_pressure']:.4g} Pa the onset is at "
            f"{floored['nonlinear']:.6g} {unit}, {change:+.2f} %."
        )
    return lines


def _undecided(answer, unit) -> list[str]:
    """What linear theory says, and why the nonlinear film does not."""
    if answer["formula"] is None:
        return [answer["failed"]]
    margin = f", {answer['times_own']:.4g} times the scenario's own" if answer.get("times_own") else ""
    if answer.get("beyond_tilt"):
        onset = f"{answer['key']} = {answer['formula']:.4g} {unit}{margin}"
        return [f"Linear theory touches at {onset}: {answer['failed']}."]
    reached = f"; orbits followed to {max(answer['path']['forcing']):.4g} {unit}" if answer.get("path") else ""
    return [f"Linear theory touches at {answer['key']} = {answer['formula']:.4g} {unit}{margin}.",
            f"Undecided for the nonlinear film: {answer['failed']}{reached}."]  # fmt: skip
