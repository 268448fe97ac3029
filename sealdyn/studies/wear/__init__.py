"""Wear: the radial profile of both faces over hours of operation, from averaged short runs of the contact scene.

Each short run starts from the last one's motion and goes on until its averages stay; the profile advances by Archard's
law, each face by its own coefficient (studies/wear/rosenbrock.py says how, and what limits a step).  Accepted steps
go to the journal at once: a study that was interrupted goes on from the last one.  Wavy faces wear around the circle,
too, from balance to balance (studies/wear/waves.py).
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ...answers import Answer, Axis, Panel, Series, Table
from ...dynamics.warm_state import at_work
from ...quantities import in_words
from ...scenario.errors import ScenarioError
from ...scene.film import coned
from ...scene.patterns import waves_of
from ...status import Status
from ...units import Time
from .. import Info
from .averages import ShortRunAverages
from .rosenbrock import Control, HatBasis, NoAverage, WearState, advance, unevenness

# Radii a profile may have; share of the closing force below which there is no contact, and below which it has faded if
# nothing more than the accuracy is left to wear; a contact over fewer radii than FEW is coarse; one on faces tilted by
# more than UNEVEN roughnesses at the outer radius is not even around the circle.
MOST, TOUCH, FADED, FEW, UNEVEN = 65, 1e-6, 1e-3, 4, 0.1
HISTORY = {
    "time": "s", "leakage": "m^3/s", "friction_power": "W", "contact_share": "1", "contact_force": "N",
    "closing_force": "N", "film_force": "N", "contact_area_fraction": "1", "contact_pressure": "Pa", "h_min": "m",
    "mean_clearance": "m", "coning": "rad", "wear_rate": "m/s", "stator_volume": "m^3", "rotor_volume": "m^3",
    "cold_coning": "rad", "unevenness": "1", "travel": "m", "relative_misalignment": "rad", "periods": "1",
}  # fmt: skip
INFO = Info(
    timed=("run_in", 7),
    warm="The temperature is that of the unworn faces, held while they wear.",
    asks="How do the faces wear over the hours?",
    wavy=True,
    units={
        **{f"history/{name}": unit for name, unit in HISTORY.items()}, "radius": "m", "profile/stator": "m",
        "profile/rotor": "m", "profile/gap": "m", "pv": "Pa m/s", "coefficients": "1/Pa",
        # Of wavy faces.
        **dict.fromkeys(("waviness", "clearance", "amplitudes", "shape", "made"), "m"), "angle": "rad", "life": "s",
        **dict.fromkeys(("load_support", "left_out", "waves", "life_share"), "1"),
    },
    along={"history": ("time",), "amplitudes": ("history/time", "harmonic"), "shape": ("history/time", "angle"),
           "profile": ("history/time", "radius"), "pv": ("history/time", "radius")},
)  # fmt: skip
# Profiles drawn of one face; of the depth computed: what is extrapolated further is told, not drawn; of its thickness:
# a film that changes by less is a flat line.
LINES, FAR, STILL = 6, 6.0, 0.01


@dataclass(frozen=True)
class Settings:
    """Wear over hours, and how finely it is followed."""

    duration: Annotated[Time, Field(gt=0)] = 100 * 3600.0
    """Of operation."""
    nodes: Annotated[int, Field(ge=2, le=MOST)] = 17
    """Radii of the profile."""
    accuracy: Annotated[float, Field(gt=0, le=1)] = 1e-2
    """Error of the depth, in roughnesses."""
    step: Annotated[float, Field(gt=0)] = 1.0
    """Largest change of the profile's shape in one step, in roughnesses."""
    turns: Annotated[int, Field(ge=1, le=10_000)] = 1
    """Forcing periods over which a short run averages, again until two such averages agree."""
    patience: Annotated[int, Field(ge=2, le=10_000)] = 40
    """Averages of a short run at most."""
    even: Annotated[float, Field(gt=0)] = 1e-2
    """Rates that differ by less over the face are those of a profile that has run in."""
    run_in: Literal["stop", "extrapolate", "go on"] = "stop"
    """What then: stop, extrapolate to the duration at a constant rate, or go on."""
    harmonics: Annotated[int, Field(ge=1, le=16)] = 10
    """Multiples of the waves' order that the worn shape of wavy faces has."""
    travelling: bool = False
    """Waves that travel slowly around their ring, a whole number past each place: they wear both faces evenly."""
    life: Annotated[float, Field(gt=0, lt=1)] = 0.5
    """Share of the waviness that is left where the life of a wave is over."""


def run(scenario, settings, tools) -> Answer:
    """The history of both faces, and why it ends."""
    wears = _coefficients(scenario)
    radius = _radii(scenario.scene.film, settings.nodes)
    rough = scenario.scene.contact.roughness
    # What the averages may be wrong by: a tenth of what a step may, on the depth of about a roughness.
    # Worn at the temperature of the unworn faces.
    scene, warm = at_work(scenario.scene)
    if waves_of(scene):
        from .waves import BalancesOfWaves, answer_of

        balances = BalancesOfWaves(scene, radius, settings.harmonics, settings.travelling)
        control = Control(rough, settings.accuracy, settings.step * rough)
        rows, end = _history(balances, balances.basis, control, settings, tools)
        return answer_of(balances, wears, rows, end, settings)
    hats = HatBasis(radius)
    runs = ShortRunAverages(scene, radius, scenario.run.accuracy, 0.1 * settings.accuracy, settings.turns,
                    settings.patience)  # fmt: skip
    rows, end = _history(runs, hats, Control(rough, settings.accuracy, settings.step * rough), settings, tools)
    numbers = _numbers(runs, hats, wears, rows, warm.coned_by if warm is not None else 0.0) | {"end": end}
    if end["kind"] == "run-in" and settings.run_in == "extrapolate":
        numbers["extrapolated"] = _extrapolated(rows[-1], wears, settings.duration)
    numbers["status"] = end["kind"] if end["kind"] in (Status.COLLAPSED, Status.FAILED) else Status.OK
    return Answer(numbers, _found(numbers), _tables(numbers, settings), _panels(numbers), _limits(numbers, settings))


def _coefficients(scenario) -> dict[str, float]:
    """Wear coefficient (1/Pa) of each face.  Raises ScenarioError where there is nothing to wear."""
    scene = scenario.scene
    if scene.contact is None:
        raise ScenarioError(scenario.name, "contact", "nothing", "a [contact] table: there is no wear without")
    wears = {"stator": scene.contact.stator_wear_coefficient, "rotor": scene.contact.rotor_wear_coefficient}
    if not any(wears.values()):
        raise ScenarioError(
            scenario.name, "contact.stator_wear_coefficient", "no wear coefficient on either face",
            'one of stator_wear_coefficient and rotor_wear_coefficient, e.g. "1e-16 1/Pa"',
        )  # fmt: skip
    if scene.film.model == "linear":
        raise ScenarioError(scenario.name, "film.model", '"linear"', 'a film that sees the worn faces: "auto"')
    if scene.film.pads:
        raise ScenarioError(scenario.name, "film.pads", "pads", "none: pads do not wear here")
    if scene.film.cavitation_pressure is not None and not waves_of(scene):
        raise ScenarioError(scenario.name, "film.cavitation_pressure", "a value", "nothing: worn faces have no floor")
    return wears


def _radii(film, nodes: int) -> np.ndarray:
    """Evenly spaced radii (n,) m, and those of a profile that is there already."""
    even = np.linspace(film.inner_radius, film.outer_radius, nodes)
    if not film.profile:
        return even
    own = np.array(film.profile.radius)
    apart = np.min(np.abs(even[:, None] - own[None, :]), axis=1) > 0.02 * (even[1] - even[0])
    return np.sort(np.concatenate([own, even[apart]]))[:MOST] if len(own) + apart.sum() <= MOST else own


# --- through the hours ------------------------------------------------------------------------------------


def _history(runs, hats, control, settings, tools) -> tuple[list[dict], dict]:
    """A row for each accepted step, those of an interrupted study first, and how it ended."""
    rows, known = [], tools.journal.rows
    while f"step:{len(rows)}" in known:
        rows.append(known[f"step:{len(rows)}"])
    last = rows[-1] if rows else {"time": 0.0, "depth": 0.0 * hats.areas, "volume": 0.0, "span": 0.0, "motion": None}
    worn = WearState(last["time"], np.array(last["depth"]), last["volume"], last["span"], last["motion"])
    going_on = bool(rows)
    try:
        for worn, average in advance(runs, hats, worn, settings.duration, control):  # noqa: B020
            if not going_on:
                rows.append(_row(worn, average, hats))
                tools.journal.add(f"step:{len(rows) - 1}", rows[-1])
            going_on = False
            end = _ended(rows, settings, control)
            # One that ends early is done all the same.
            share = 1.0 if end else worn.time / settings.duration
            tools.say(share, f"{_time(worn.time)} of {_time(settings.duration)}")
            if end:
                return rows, end
    except NoAverage as stop:
        if not rows:
            rows.append({"time": 0.0, "depth": worn.depth.tolist(), "rate": None, "volume": 0.0, "seen": None})
        return rows, {"kind": stop.kind, "time": worn.time, "said": f"a short run ends: {stop}"}
    raise AssertionError("a history ends at its duration")


def _row(worn, average, hats) -> dict:
    rate, _ = hats.rates(average.nodal)
    face = hats.over_face(rate)
    touching = int(np.sum(rate > 0.01 * rate.max()))
    return {
        "time": worn.time, "depth": worn.depth.tolist(), "volume": worn.volume, "span": worn.span,
        "motion": worn.motion, "rate": rate.tolist(), "fastest": float(face.max()), "mean": float(face.mean()),
        "uneven": float(unevenness(face)), "coarse": 0 < touching < FEW, "seen": average.row,
    }  # fmt: skip


def _ended(rows, settings, control) -> dict | None:
    """Why the history ends here, if it does: kind, time (s) and a sentence."""
    row = rows[-1]
    time, seen = row["time"], row["seen"]
    left = settings.duration - time
    lift_off = seen["contact_force"] <= TOUCH * seen["closing_force"]
    faded = seen["contact_force"] <= FADED * seen["closing_force"] and row["fastest"] * left < control.tolerance
    if lift_off or (left > 0.0 and faded):
        before = rows[-2]["time"] if len(rows) > 1 else 0.0
        when = f"between {_time(before)} and {_time(time)}" if time else "from the start"
        what = "the film carries the whole load: no contact" if lift_off else "contact has faded to nothing"
        return {"kind": "lift-off", "time": time, "said": f"{what} {when}, and nothing wears any more"}
    if left <= 0.0:
        return {"kind": "duration", "time": time, "said": f"worn for {_time(time)}"}
    if settings.run_in != "go on" and row["uneven"] < settings.even:
        said = (
            f"run in after {_time(time)}: the depth rates over the face are even within "
            f"{in_words('share', settings.even, digits=3)}, "
            f"{in_words('wear_rate', row['mean'])}"
        )
        return {"kind": "run-in", "time": time, "said": said}
    return None


# --- the answer -------------------------------------------------------------------------------------------


def _numbers(runs, hats, wears, rows, coned_by) -> dict:
    """Histories, profiles and the balance of volume, JSON-ready; `coned_by`: coning by heat (rad) of the faces."""
    rows = [row for row in rows if row["seen"]]
    both = sum(wears.values())
    depth = np.array([row["depth"] for row in rows]).reshape(-1, len(hats.radius))
    worn = {face: k / both * depth for face, k in wears.items()}
    slope = coned(runs.scene).coning * (hats.radius - hats.radius[0])
    gap = runs.own + slope + depth
    history = {name: [row["seen"][name] for row in rows] for name in HISTORY if rows and name in rows[0]["seen"]}
    history["time"] = [row["time"] for row in rows]
    history["contact_share"] = [row["seen"]["contact_force"] / row["seen"]["closing_force"] for row in rows]
    history["mean_clearance"] = [
        runs.clearance + row["seen"]["travel"] + hats.volume(g) / hats.areas.sum()
        for row, g in zip(rows, gap, strict=True)
    ]
    history["coning"] = [_slope(hats, g) for g in gap]
    history["cold_coning"] = [cone - coned_by for cone in history["coning"]]
    history["unevenness"] = [float(u) if np.isfinite(u) else None for u in (unevenness(row["rate"]) for row in rows)]
    for face in wears:
        history[f"{face}_volume"] = [hats.volume(d) for d in worn[face]]
    last, tilt = rows[-1] if rows else None, max((row["seen"]["relative_misalignment"] for row in rows), default=0.0)
    volume = hats.volume(depth[-1]) if rows else 0.0
    return {
        "radius": hats.radius.tolist(),
        "coefficients": list(wears.values()),
        "profile": {face: d.tolist() for face, d in worn.items()} | {"gap": gap.tolist()},
        "pv": [(np.array(row["rate"]) / both).tolist() for row in rows],
        "history": history,
        "volume": {
            "profiles": volume,
            "integral": last["volume"] if last else 0.0,
            "residual": abs(volume - last["volume"]) / volume if volume else 0.0,
        },
        "steps": max(len(rows) - 1, 0),
        "not_settled": sum(not row["seen"]["settled"] for row in rows),
        "coarse": sum(row["coarse"] for row in rows),
        "tilt_over_roughness": tilt * float(hats.radius[-1]) / runs.scene.contact.roughness,
        "still": runs.still,
        "unstable": runs.unstable,
        "period": runs.period,
        "extrapolated": None,
    }


def _slope(hats, gap) -> float:
    """Coning (rad) of the straight line nearest to a gap (n,) over the face."""
    lines = np.stack([np.ones(len(gap)), hats.radius - hats.radius[0]])
    return float(np.linalg.solve(lines @ hats.mass @ lines.T, lines @ hats.mass @ gap)[1])


def _extrapolated(row, wears, duration) -> dict:
    """Depths at the asked duration if the rates stay."""
    left, both = duration - row["time"], sum(wears.values())
    depth = np.array(row["depth"]) + left * np.array(row["rate"])
    return {"time": duration, "from": row["time"], **{face: (k / both * depth).tolist() for face, k in wears.items()}}


# --- what is shown ----------------------------------------------------------------------------------------


def _time(seconds: float) -> str:
    return in_words("s", seconds)


def _worn(numbers) -> dict[str, np.ndarray]:
    """Depth (n,) m worn off each face at the end; rounding is no growth."""
    return {face: np.maximum(numbers["profile"][face][-1], 0.0) for face in ("stator", "rotor")}


def _found(numbers) -> str:
    """Why the history ends, and how deep the faces are worn."""
    said = numbers["end"]["said"]
    said = f"{said[0].upper()}{said[1:]}"
    if not numbers["history"]["time"]:
        return f"{said}."
    worn = [f"{face} by {in_words('depth', max(d))} at most" for face, d in _worn(numbers).items() if max(d) > 0.0]
    return f"{said}; worn off: {', '.join(worn) or 'nothing'}."


def _limits(numbers, settings) -> list[str]:
    """What the answer does not hold for."""
    profiles, limits = numbers["steps"] + 1, []
    if not numbers["history"]["time"]:
        return limits
    if numbers["not_settled"]:
        limits.append(f"Averages of {numbers['not_settled']} of {profiles} profiles had not settled in "
                      f"{settings.patience} x {settings.turns} periods.")  # fmt: skip
    if numbers["coarse"] and len(numbers["radius"]) > FEW:
        limits.append(
            f"Fewer than {FEW} radii touch at {numbers['coarse']} of {profiles} profiles: raise study.wear.nodes."
        )
    if numbers["tilt_over_roughness"] > UNEVEN and max(numbers["history"]["contact_force"]) > 0.0:
        limits.append(f"The faces tilt by up to {numbers['tilt_over_roughness']:.2g} roughnesses: a face on which the "
                      "contact patch stands wears deeper.")  # fmt: skip
    if numbers["unstable"]:
        limits.append("The aligned seal is unstable at this speed: its wear holds for the motion seen here only.")
    return limits


def _tables(numbers, settings) -> list[Table]:
    """Depths of the faces, at the end and beyond, and the history."""
    history, later = numbers["history"], numbers["extrapolated"]
    if not history["time"]:
        return []
    depths = _worn(numbers)
    rows = [[face, min(d), max(d), later and max(later[face])] for face, d in depths.items() if max(d) > 0.0]
    if numbers["end"]["kind"] == "run-in" and not later:
        both = sum(depths.values())
        left = history["wear_rate"][-1] * (settings.duration - history["time"][-1])
        rows.append(["both together", float(min(both)), float(max(both)), float(max(both) + left)])
    columns = [("1", "face"), ("depth", "worn off, least"), ("depth", "most"),
               ("depth", f"in {_time(settings.duration)} at the last rates, not computed")]  # fmt: skip
    found = [Table("worn", columns, rows)]
    names = {
        "time": ("time", "time"),
        "leakage": ("leakage", "leakage"),
        "friction_power": ("power", "friction"),
        "contact_share": ("share", "contact, of the absolute closing force"),
        "coning": ("tilt", "coning of the gap"),
        "h_min": ("h_min", "thinnest film"),
    }
    if history["cold_coning"] != history["coning"]:
        names["cold_coning"] = ("tilt", "coning when cold")
    rows = zip(*(history[name] for name in names), strict=True)
    return [*found, Table("history", list(names.values()), [list(row) for row in rows])]


def _panels(numbers) -> list[Panel]:
    """What has gone from the faces, the gap and contact pressure times speed over the radius; beside, the course."""
    history = numbers["history"]
    if not history["time"]:
        return [Panel("No profile", note=numbers["end"]["said"])]
    radius = numbers["radius"]
    along, gap = Axis("radius", low=radius[0], high=radius[-1]), np.array(numbers["profile"]["gap"])
    gap -= gap.min(axis=1, keepdims=True)
    title = "Shape of the gap, from its narrowest place"
    if len(history["time"]) == 1:
        # Nothing has a course over the hours.
        return [Panel(title, along, Axis("m", "gap"), [Series("line", radius, gap[-1], style="film")])]
    time = np.array(history["time"])
    shown = np.unique([int(np.argmin(np.abs(time - t))) for t in np.linspace(0.0, time[-1], LINES)])

    early_to_late = [(k, f"{time[k] / time[-1]:.3g}", in_words("time", time[k], digits=3)) for k in shown]

    def over_radius(rows, named):
        return [Series("line", radius, rows[k], style=style, label=when * named) for k, style, when in early_to_late]

    panels, later = [], numbers["extrapolated"]
    worn = [face for face in ("stator", "rotor") if np.any(numbers["profile"][face])] or ["stator"]
    for face in worn:
        depth = np.array(numbers["profile"][face])
        note = "" if depth.max() > 0.0 else "does not wear"
        series = over_radius(depth, face == worn[0]) if depth.max() > 0.0 else []
        if later and max(later[face]) <= FAR * depth.max():
            series.append(Series("line", radius, later[face], style="grey dotted",
                                 label=f"{_time(later['time'])} extrapolated"))  # fmt: skip
        elif later:
            note = f"extrapolated to {_time(later['time'])}: {in_words('depth', max(later[face]))}, not computed"
        panels.append(Panel(f"{face.capitalize()}: worn off", along, Axis("depth"), series, note=note, down=True,
                            below=bool(panels), tall=0.75))  # fmt: skip
    panels.append(Panel(title, along, Axis("m", "gap"), over_radius(gap, False), below=True, tall=0.75))
    panels.append(_pressed(numbers, along))
    return [*panels, *_course(history, worn)]


def _pressed(numbers, along: Axis) -> Panel:
    """Contact pressure times sliding speed over the radius, at start and end."""
    pv, radius = np.array(numbers["pv"]), numbers["radius"]
    last = max(pv[-1].max(), 1e-300)
    # A new edge carries far more than the rest: the end must stay visible.
    top = max(min(pv[0].max(), 8 * last), 1.15 * last) if last > 1e-6 * pv[0].max() else pv[0].max()
    note = f"start: up to {in_words('Pa*m/s', pv[0].max())}" if pv[0].max() > top else ""
    series = [Series("line", radius, pv[0], label="start", style="warn thick"),
              Series("line", radius, pv[-1], label="end", style="film")]  # fmt: skip
    axis = Axis("Pa*m/s", " ", low=0.0, high=1.08 * top or None)
    return Panel("Contact pressure times sliding speed", along, axis, series, note=note, below=True, tall=0.75)


def _course(history, worn) -> list[Panel]:
    """A panel of each quantity over the hours."""
    time = history["time"]
    mark = " circle small" if len(time) <= 80 else ""

    def curves(*rows):
        return [Series("line", time, history[name], label=label, style=style + mark) for name, label, style in rows]

    shares, film = ("contact_share", "contact_area_fraction"), (history["mean_clearance"], history["h_min"])
    # A few asperities carry the load: far less of the area than of the force.
    scale = "log" if all(min(history[name]) > 0.0 for name in shares) else "linear"
    low, high = min(map(min, film)), max(map(max, film))
    still = {"low": (1.0 - 5.0 * STILL) * low, "high": (1.0 + 5.0 * STILL) * high} if high - low < STILL * high else {}
    # With room above what hardly changes.
    flow, heat = ({"low": min(0.0, *history[name]), "high": 1.12 * max(0.0, *history[name]) or None}
                  for name in ("leakage", "friction_power"))  # fmt: skip
    rows = [
        ("Leakage", Axis("leakage", " ", **flow), curves(("leakage", "", "leakage"))),
        ("Friction power", Axis("power", " ", **heat), curves(("friction_power", "", "black"))),
        ("Contact", Axis("share", " ", scale=scale), curves((shares[0], "of the absolute closing force", "contact"),
                                                            (shares[1], "of the face touches", "warn"))),
        ("Film", Axis("h_min", " ", **still), curves(("mean_clearance", "mean over the face", "film thick"),
                                                     ("h_min", "thinnest", "grey"))),
        ("Worn volume", Axis("volume", " "), curves(*((f"{face}_volume", face, face) for face in worn))),
    ]  # fmt: skip
    over = Axis("time", "time of operation", low=0.0, high=time[-1])
    return [Panel(title, over, y, series, below=k > 0, tall=0.6) for k, (title, y, series) in enumerate(rows)]
