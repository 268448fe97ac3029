"""Vibration: what a shaking housing does to the film, over frequency, and at which acceleration the faces touch.

**Source** Hayden & Keller, NASA CR-120997 (1974): vibration from 3 Hz to a gear mesh of 5400 Hz at 45 g.
Angular acceleration in g is that of the outer edge of the face: the angular one times its radius.
"""

import math
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.constants import g
from scipy.optimize import brentq, minimize_scalar

from ...scenario.errors import ScenarioError
from ...scene.variants import arrangement
from ...units import Acceleration, Frequency
from .in_time import measured
from .small_motion import ShakenSeal

WITH_WAVES = True
REFUSES = ("secondary-seal",)
DIRECTIONS = ("axial", "angular")
# The gear mesh of the guide (m/s^2), where the scenario's application has no frequencies (Hz) of its own.
GEAR_MESH, GEAR_MESH_ACCELERATION = (5400.0,), 45.0 * g
# Points about a resonance, in its width.
NEAR = (-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0)
# Of the accelerations that are those of a direction.
OF_DIRECTION = {"axial": "m/s^2", "angular": "rad/s^2"}
ALONG = {"table": ("frequency",), "modes": ("frequency",)}
units = {"axial_gain": "m/m", "angular_gain": "rad/rad", "axial_per_acceleration": "m/(m/s^2)",
         "angular_per_acceleration": "rad/(rad/s^2)", "axial_touch": "m/s^2", "axial_touch_aligned": "m/s^2",
         "angular_touch": "rad/s^2", "angular_touch_aligned": "rad/s^2", "frequency": "Hz", "damped_frequency": "Hz",
         "growth_rate": "1/s", "damping_ratio": "1", "gain": "1", "touch": "m/s^2", "acceleration": "m/s^2",
         "lowest": "Hz", "highest": "Hz", "accelerations": "m/s^2", "inside": "1", "margin": "1",
         "film_left": "m", "deviation": "1", "ratio": "1"}  # fmt: skip


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("housing_vibration", 3)


@dataclass(frozen=True)
class Settings:
    """Frequencies, the accelerations that are asked about, and runs beside them."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    direction: Literal["axial", "angular", "both"] = "both"
    """Of the housing's vibration."""
    lowest: Frequency = 3.0
    """Lowest frequency."""
    highest: Frequency = 5400.0
    """Highest frequency."""
    points: int = 121
    """Number of frequencies, evenly on a logarithmic axis; some more lie about each resonance."""
    accelerations: tuple[Acceleration, ...] = (GEAR_MESH_ACCELERATION,)
    """Of the housing, of angular vibration that of the outer edge of the face: at which frequencies they close the
    film."""
    runs: int = 4
    """Frequencies in the time domain, beside that of the easiest touch."""


def run(scenario, settings, tools) -> dict:
    """The film over frequency, where it is closed most easily, the gear mesh, and the time domain."""
    if not 0.0 < settings.lowest < settings.highest:
        found = f"{settings.lowest:g} to {settings.highest:g} Hz"
        raise ScenarioError(scenario.name, "study.vibration.highest", found, "a range of frequencies above 0 Hz")
    seal = ShakenSeal(scenario.scene)
    directions = DIRECTIONS if settings.direction == "both" else (settings.direction,)
    frequencies = _frequencies(settings, seal.resonances())
    columns = {"frequency": frequencies.tolist()}
    for direction in directions:
        columns |= curves(seal, direction, frequencies)
        tools.say(0.2)
    film, edge = seal.model.scene.film, seal.model.scene.film.outer_radius
    answer = {
        "arrangement": arrangement(scenario.scene),
        "film": seal.model.interface.name,
        "directions": list(directions),
        "outer_radius": film.outer_radius,
        "clearance": seal.model.clearance,
        "thinnest": seal.thinnest,
        "touch_height": seal.level,
        "riding": seal.riding,
        "own": {"closing": seal.own[0], "tilt": seal.own[1]},
        "accelerations": list(settings.accelerations),
        "modes": seal.resonances(),
        "peaks": [extreme(seal.gain, d, frequencies, columns[f"{d}_gain"], -1.0, "gain") for d in directions],
        "weakest": [extreme(seal.touch, d, frequencies, columns[f"{d}_touch"], 1.0, "touch") for d in directions],
        "bands": [band for d in directions for a in settings.accelerations
                  for band in bands(seal, d, frequencies, columns[f"{d}_touch"], a, edge)],
        "gear_mesh": gear_mesh(seal, scenario.application, directions, edge),
        "table": columns,
    }  # fmt: skip
    points = _points(settings, answer)
    if points:
        # What a gas dam takes a minute for is not what everybody asks.
        tools.tell(f"vibration: {len(points)} tones in the time domain; --runs 0 leaves them out")
    rows = tools.map(partial(measured, scenario.scene), points, "time domain") if points else []
    answer["time_domain"] = [{**point, **row} for point, row in zip(points, rows, strict=True)]
    apart = [row["deviation"] for row in answer["time_domain"] if "failed" not in row]
    answer["deviation"] = max(apart, default=None)
    answer["units"] = dict.fromkeys(("weakest/touch", "time_domain/touch", "linear_touch"), unit_of(directions))
    return answer | {"verdict": _verdict(answer)}


def unit_of(directions) -> str:
    """Unit of an acceleration in one of these directions; of both, each with its name."""
    if len(directions) == 1:
        return OF_DIRECTION[directions[0]]
    return ", ".join(f"{OF_DIRECTION[direction]} {direction}" for direction in directions)


def _frequencies(settings, modes) -> np.ndarray:
    """Frequencies (Hz) of the curves: even on a logarithmic axis, and closer about every resonance."""
    low, high = settings.lowest, settings.highest
    even = np.geomspace(low, high, max(2, settings.points))
    near = [mode["frequency"] * (1 + k * mode["damping_ratio"]) for mode in modes if "frequency" in mode for k in NEAR]
    # geomspace rounds its ends.
    return np.unique([low, high, *even[1:-1], *(f for f in near if low < f < high)])


def curves(seal: ShakenSeal, direction: str, frequencies) -> dict:
    """Columns of the table over frequencies (Hz): `gain` of the gap per motion of the housing and motion of the gap
    `per_acceleration`; the `touch` acceleration beside the scene's own forcing and of `aligned` faces."""
    gains = np.array([seal.gain(direction, f) for f in frequencies])
    touches = [[seal.touch(direction, f, aligned) for f in frequencies] for aligned in (False, True)]
    return {f"{direction}_gain": gains.tolist(),
            f"{direction}_per_acceleration": (gains / (2 * math.pi * frequencies) ** 2).tolist(),
            f"{direction}_touch": touches[0], f"{direction}_touch_aligned": touches[1]}  # fmt: skip


def extreme(function, direction: str, frequencies, values, sign: float, name: str) -> dict:
    """{direction, frequency (Hz), `name`, inside}: where `function(direction, frequency)`, `values` at the frequencies,
    times `sign` is smallest; `inside` the range, and not at its end."""
    values = sign * np.array(values)
    k = int(np.argmin(values))
    at, inside = float(frequencies[k]), 0 < k < len(values) - 1
    if inside:
        low, high = (math.log(frequencies[n]) for n in (k - 1, k + 1))
        found = minimize_scalar(lambda x: sign * function(direction, math.exp(x)), bounds=(low, high), method="bounded",
                                options={"xatol": 1e-9})  # fmt: skip
        at = math.exp(found.x) if found.fun < values[k] else at
    return {"direction": direction, "frequency": at, name: float(function(direction, at)), "inside": inside}


def bands(seal: ShakenSeal, direction: str, frequencies, touches, acceleration: float, edge: float) -> list[dict]:
    """Ranges of frequency (Hz) in which an acceleration (m/s^2, of angular vibration at the radius `edge` (m)) closes
    the film, `touches` that which does at the frequencies."""
    asked = acceleration / (edge if direction == "angular" else 1.0)
    closed = [touch <= asked for touch in touches]
    ends = [] if not closed[0] else [float(frequencies[0])]
    for (low, high), (before, after) in zip(pairwise(frequencies), pairwise(closed), strict=True):
        if before != after:
            ends.append(float(brentq(lambda f: seal.touch(direction, f) - asked, low, high, rtol=1e-9)))
    ends += [float(frequencies[-1])] if closed[-1] else []
    return [{"direction": direction, "acceleration": acceleration, "lowest": low, "highest": high}
            for low, high in zip(ends[::2], ends[1::2], strict=True)]  # fmt: skip


def gear_mesh(seal: ShakenSeal, application, directions, edge: float) -> list[dict]:
    """At each gear mesh frequency (Hz) of the application, or the guide's: the acceleration of `touch` (m/s^2, of
    angular vibration at the outer edge), its `margin` over the guide's 45 g, and how much of the film, in m, is left
    at 45 g (`film_left`, below zero where the faces would cut)."""
    rows = []
    for frequency in (application.gear_mesh_frequency if application else None) or GEAR_MESH:
        for direction in directions:
            arm = edge if direction == "angular" else 1.0
            touch, aligned = (arm * seal.touch(direction, frequency, part) for part in (False, True))
            share = GEAR_MESH_ACCELERATION / aligned if aligned else math.inf
            left = seal.thinnest - (seal.thinnest - seal.level) * share if math.isfinite(share) else None
            rows.append({"direction": direction, "frequency": frequency, "acceleration": GEAR_MESH_ACCELERATION,
                         "touch": touch, "margin": touch / GEAR_MESH_ACCELERATION, "film_left": left})  # fmt: skip
    return rows


def _points(settings, answer) -> list[dict]:
    """Tones in the time domain: `runs` frequencies over the range, and where the film is closed most easily."""
    if settings.runs < 1:
        return []
    spread = (
        [settings.lowest, settings.highest] if settings.runs > 1 else [math.sqrt(settings.lowest * settings.highest)]
    )
    chosen = np.geomspace(spread[0], spread[-1], settings.runs).tolist()
    chosen[0], chosen[-1] = spread[0], spread[-1]
    points = []
    for direction, weakest in zip(answer["directions"], answer["weakest"], strict=True):
        points += [{"direction": direction, "frequency": f} for f in sorted({*chosen, weakest["frequency"]})]
    return points


def tables(answer) -> list:
    """Modes, the gear mesh, and the time domain."""
    modes = (("mode", "kind"), ("turns", "direction"), ("natural, Hz", "frequency"), ("damped, Hz", "damped_frequency"),
             ("damping ratio", "damping_ratio"), ("growth rate, 1/s", "growth_rate"))  # fmt: skip
    mesh = (("gear mesh", "direction"), ("frequency, Hz", "frequency"), ("touch, g", "touch", 1 / g),
            ("times 45 g", "margin"), ("film left at 45 g, um", "film_left", 1e6))  # fmt: skip
    time = (("in time", "direction"), ("frequency, Hz", "frequency"), ("gap per motion", "gain"),
            ("away from linear", "deviation"), ("touch, g", "in_g"), ("linear, g", "linear_in_g"), ("ratio", "ratio"),
            ("", "said"))  # fmt: skip
    rows = []
    for row in answer["time_domain"]:
        arm = (answer["outer_radius"] if row["direction"] == "angular" else 1.0) / g
        rows.append(row | {f"{name}in_g": arm * row[key] for name, key in (("", "touch"), ("linear_", "linear_touch"))
                           if row.get(key) is not None})  # fmt: skip
    return [(answer["modes"], modes), (answer["gear_mesh"], mesh), (rows, time)]


# --- what is said ----------------------------------------------------------------------------------------

WORDS = {"axial": "Axial", "angular": "Angular"}


def _verdict(answer) -> list[str]:
    said = [_weakest(answer, k) for k in range(len(answer["directions"]))]
    said += _bands(answer)
    said += [f"Gear mesh, {row['frequency']:.5g} Hz, {row['direction']}: linear touch at {in_g(row['touch'])}, "
             f"{digits(row['margin'])} times the guide's 45 g." for row in answer["gear_mesh"]]  # fmt: skip
    said += _in_time(answer)
    if answer["riding"]:
        said.append("The asperities touch at rest: their stiffness is in the response, and touch is where the faces' "
                    "mean planes meet.")  # fmt: skip
    return said


def _weakest(answer, k: int) -> str:
    """Where the film is closed most easily, and how it follows there."""
    found, peak, direction = answer["weakest"][k], answer["peaks"][k], answer["directions"][k]
    arm = answer["outer_radius"] if direction == "angular" else 1.0
    where = "of the face's outer edge" if direction == "angular" else "of the housing"
    ends = "" if found["inside"] else ", an end of the range"
    if found["touch"] == 0.0:
        return f"{WORDS[direction]} vibration: the scene's own runout and misalignment close the film without any."
    amplitude = 1e3 * arm * found["touch"] / (2 * math.pi * found["frequency"]) ** 2
    return (f"{WORDS[direction]} vibration {where} touches most easily at {found['frequency']:.4g} Hz{ends}: from "
            f"{in_g(arm * found['touch'])} on, {digits(amplitude)} mm (linear theory); at most "
            f"{100 * peak['gain']:.3g} % of it moves the gap, at {peak['frequency']:.4g} Hz.")  # fmt: skip


def _bands(answer) -> list[str]:
    """At which frequencies the accelerations asked close the film."""
    said = []
    for direction in answer["directions"]:
        for acceleration in answer["accelerations"]:
            found = [band for band in answer["bands"]
                     if (band["direction"], band["acceleration"]) == (direction, acceleration)]  # fmt: skip
            ranges = " and ".join(f"{band['lowest']:.4g} to {band['highest']:.4g} Hz" for band in found)
            if not found:
                where = "leave the film open at every frequency"
            elif len(found) == 1 and found[0]["lowest"] == answer["table"]["frequency"][0]:
                top = found[0]["highest"]
                open_above = top < answer["table"]["frequency"][-1]
                where = f"leave the film open above {top:.4g} Hz" if open_above else "close the film at every frequency"
            else:
                where = f"close the film at {ranges}"
            said.append(f"{in_g(acceleration)} {direction} {where} (linear theory).")
    return said


def _in_time(answer) -> list[str]:
    """How far the nonlinear film in time is from linear theory."""
    rows = answer["time_domain"]
    done, said = [row for row in rows if "failed" not in row], []
    if done:
        said.append(f"In time, {len(done)} tones: small motion within {answer['deviation']:.1e} of linear theory.")
    ratios = [row["ratio"] for row in done if row["ratio"] is not None]
    if ratios:
        more = (
            "later than linear theory says"
            if min(ratios) > 1.0
            else "sooner in places"
            if max(ratios) > 1.0
            else "sooner"
        )
        ends = dict.fromkeys(f"{ratio:.3g}" for ratio in (min(ratios), max(ratios)))
        said[-1] += f" The nonlinear film touches {' to '.join(ends)} times the linear acceleration: {more}."
    untouched = sorted({row["said"] for row in done if row["said"]})
    said += [f"Tones without a touch in time: {'; '.join(untouched)}."] if untouched else []
    lost = [row["failed"] for row in rows if "failed" in row]
    if lost:
        said.append(f"{len(lost)} tones failed in time, e.g. {lost[0]}")
    return said


def in_g(acceleration: float) -> str:
    """An acceleration (m/s^2) as it is spoken of."""
    return f"{digits(acceleration / g)} g"


def digits(value: float) -> str:
    """Four digits, without a power of ten below a million."""
    return f"{float(f'{value:.4g}'):g}"
