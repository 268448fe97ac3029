"""Wear: the radial profile of both faces over hours of operation, from averaged short runs of the contact scene.

Each short run starts from the last one's motion and goes on until its averages stay; the profile advances by Archard's
law, each face by its own coefficient (studies/wear/rosenbrock.py says how, and what limits a step).  Accepted steps
go to the journal at once: a study that was interrupted goes on from the last one.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ...scenario.errors import ScenarioError
from ...scene.coning import coned
from ...status import Status
from ...units import Time
from .._words import wear, wearing
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
    "unevenness": "1", "travel": "m", "relative_misalignment": "rad", "periods": "1",
}  # fmt: skip
ALONG = {"history": ("time",), "profile": ("history/time", "radius"), "pv": ("history/time", "radius")}
units = {f"history/{name}": unit for name, unit in HISTORY.items()} | {
    "radius": "m", "profile/stator": "m", "profile/rotor": "m", "profile/gap": "m", "pv": "Pa m/s",
    "coefficients": "1/Pa",
}  # fmt: skip


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("run_in", 7)
# What a refusal of wavy faces goes on with.
OF_WAVES = "; how fast crests wear the study equilibrium says, with wear coefficients in [contact]"


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


def run(scenario, settings, tools) -> dict:
    """The history of both faces, and why it ends."""
    wears = _coefficients(scenario)
    radius = _radii(scenario.scene.film, settings.nodes)
    hats, rough = HatBasis(radius), scenario.scene.contact.roughness
    # What the averages may be wrong by: a tenth of what a step may, on the depth of about a roughness.
    runs = ShortRunAverages(scenario.scene, radius, scenario.run.accuracy, 0.1 * settings.accuracy, settings.turns,
                    settings.patience)  # fmt: skip
    rows, end = _history(runs, hats, Control(rough, settings.accuracy, settings.step * rough), settings, tools)
    answer = _answer(runs, hats, wears, rows) | {"end": end}
    if end["kind"] == "run-in" and settings.run_in == "extrapolate":
        answer["extrapolated"] = _extrapolated(answer, rows[-1], hats, wears, settings.duration)
    status = end["kind"] if end["kind"] in (Status.COLLAPSED, Status.FAILED) else Status.OK
    return {**answer, "status": status, "verdict": sentences(answer, settings)}


def _coefficients(scenario) -> dict[str, float]:
    """Wear coefficient (1/Pa) of each face.  Raises ScenarioError where there is nothing to wear."""
    scene = scenario.scene
    if scene.contact is None:
        raise ScenarioError(scenario.name, "contact", "nothing", "a [contact] table: there is no wear without")
    wears = {face: getattr(scene.contact, f"{face}_wear_coefficient") for face in ("stator", "rotor")}
    if not any(wears.values()):
        raise ScenarioError(
            scenario.name, "contact.stator_wear_coefficient", "no wear coefficient on either face",
            'one of stator_wear_coefficient and rotor_wear_coefficient, e.g. "1e-16 1/Pa"',
        )  # fmt: skip
    if scene.film.model == "linear":
        raise ScenarioError(scenario.name, "film.model", '"linear"', 'a film that sees the worn faces: "auto"')
    if scene.film.cavitation_pressure is not None:
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
    last = rows[-1] if rows else {"time": 0.0, "depth": 0.0 * hats.radius, "volume": 0.0, "span": 0.0, "motion": None}
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
            tools.say(share, f"{_hours(worn.time)} of {_hours(settings.duration)}")
            if end:
                return rows, end
    except NoAverage as stop:
        if not rows:
            rows.append({"time": 0.0, "depth": worn.depth.tolist(), "rate": None, "volume": 0.0, "seen": None})
        return rows, {"kind": stop.kind, "time": worn.time, "said": f"a short run ends: {stop}"}
    raise AssertionError("a history ends at its duration")


def _row(worn, average, hats) -> dict:
    rate, _ = hats.rates(average.nodal)
    touching = int(np.sum(rate > 0.01 * rate.max()))
    return {
        "time": worn.time, "depth": worn.depth.tolist(), "volume": worn.volume, "span": worn.span,
        "motion": worn.motion, "rate": rate.tolist(), "coarse": 0 < touching < FEW, "seen": average.row,
    }  # fmt: skip


def _ended(rows, settings, control) -> dict | None:
    """Why the history ends here, if it does: kind, time (s) and a sentence."""
    row = rows[-1]
    rate, time, seen = np.array(row["rate"]), row["time"], row["seen"]
    left = settings.duration - time
    lift_off = seen["contact_force"] <= TOUCH * seen["closing_force"]
    faded = seen["contact_force"] <= FADED * seen["closing_force"] and rate.max() * left < control.tolerance
    if lift_off or (left > 0.0 and faded):
        before = rows[-2]["time"] if len(rows) > 1 else 0.0
        when = f"between {_hours(before)} and {_hours(time)}" if time else "from the start"
        what = "the film carries the whole load: no contact" if lift_off else "contact has faded to nothing"
        return {"kind": "lift-off", "time": time, "said": f"{what} {when}, and nothing wears any more"}
    if left <= 0.0:
        return {"kind": "duration", "time": time, "said": f"worn for {_hours(time)}"}
    if settings.run_in != "go on" and unevenness(rate) < settings.even:
        said = (
            f"run in after {_hours(time)}: the depth rates over the face are even within {100 * settings.even:.3g} %, "
            f"{wear(rate.mean())}"
        )
        return {"kind": "run-in", "time": time, "said": said}
    return None


# --- the answer -------------------------------------------------------------------------------------------


def _answer(runs, hats, wears, rows) -> dict:
    """Histories, profiles and the balance of volume, JSON-ready."""
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


def _extrapolated(answer, row, hats, wears, duration) -> dict:
    """Depths at the asked duration if the rates stay."""
    left, both = duration - row["time"], sum(wears.values())
    depth = np.array(row["depth"]) + left * np.array(row["rate"])
    return {"time": duration, "from": row["time"]} | {
        face: (k / both * depth).tolist() for face, k in wears.items()
    }  # fmt: skip


# --- in words ---------------------------------------------------------------------------------------------


def tables(answer) -> list:
    """The history."""
    names = ("time", "leakage", "friction_power", "contact_share", "coning", "h_min")
    values = zip(*(answer["history"].get(name, []) for name in names), strict=True)
    columns = (("time, h", "time", 1 / 3600), ("leakage, ml/h", "leakage", 3.6e9), ("friction, W", "friction_power"),
               ("contact, % of absolute closing force", "contact_share", 100),
               ("coning of the gap, urad", "coning", 1e6), ("smallest film, um", "h_min", 1e6))  # fmt: skip
    return [([dict(zip(names, row, strict=True)) for row in values], columns)]


def sentences(answer, settings) -> list[str]:
    """The verdict: why the history ends, how deep the faces are worn, and what limits the answer."""
    said, time, later = answer["end"]["said"], answer["history"]["time"], answer["extrapolated"]
    lines = [f"{said[0].upper()}{said[1:]}."]
    if not time:
        return lines
    # Rounding is no growth.
    depths = {face: np.maximum(answer["profile"][face][-1], 0.0) for face in ("stator", "rotor")}
    coefficients = dict(zip(depths, answer["coefficients"], strict=True))
    worn = [f"{face} {_length(min(d))} to {_length(max(d))}" for face, d in depths.items() if max(d) > 0.0]
    told = f"Worn off in {_hours(time[-1])}: {', '.join(worn)}" if worn else "Nothing is worn off"
    if later:
        deep = ", ".join(f"{face} {_length(max(later[face]))}" for face, k in coefficients.items() if k)
        told += f"; extrapolated at the last rates, not computed, to {_hours(later['time'])}: {deep}"
    elif answer["end"]["kind"] == "run-in":
        total = max(map(sum, zip(*depths.values(), strict=True)))
        total += answer["history"]["wear_rate"][-1] * (settings.duration - time[-1])
        told += (f"; at the rate that is left, not computed, {_hours(settings.duration)} come to {_length(total)} "
                 f"of {wearing(coefficients)} (see --run-in extrapolate)")  # fmt: skip
    limits = _limits(answer, settings)
    return [*lines, f"{told}.", *([f"Mind: {'; '.join(limits)}."] if limits else [])]


def _limits(answer, settings) -> list[str]:
    """What the answer does not hold for."""
    profiles, limits = answer["steps"] + 1, []
    if answer["not_settled"]:
        limits.append(f"averages of {answer['not_settled']} of {profiles} profiles had not settled in "
                      f"{settings.patience} x {settings.turns} periods")  # fmt: skip
    if answer["coarse"] and len(answer["radius"]) > FEW:
        limits.append(
            f"fewer than {FEW} radii touch at {answer['coarse']} of {profiles} profiles: raise study.wear.nodes"
        )
    if answer["tilt_over_roughness"] > UNEVEN and max(answer["history"]["contact_force"]) > 0.0:
        limits.append(f"the faces tilt by up to {answer['tilt_over_roughness']:.2g} roughnesses: a face on which the "
                      "contact patch stands wears deeper")  # fmt: skip
    if answer["unstable"]:
        limits.append("the aligned seal is unstable at this speed: its wear holds for the motion seen here only")
    return limits


def _hours(seconds) -> str:
    return f"{seconds / 3600:.4g} h" if seconds >= 360.0 or seconds == 0.0 else f"{seconds:.3g} s"


def _length(metres) -> str:
    return f"{1e6 * metres:.4g} um" if metres >= 1e-7 else f"{1e9 * metres:.3g} nm"
