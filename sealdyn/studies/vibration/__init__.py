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

from ...answers import Answer, Axis, Level, Panel, Series, Table, table_of
from ...quantities import in_words
from ...scenario.errors import ScenarioError
from ...scene.scene import arrangement
from ...units import Acceleration, Frequency
from .. import Info
from .shaken_seal import ShakenSeal, measured

INFO = Info(
    timed=("housing_vibration", 3),
    asks="At which vibration do the faces touch?",
    refuses=("secondary-seal", "moment"),
    wavy=True,
    units={
        "axial_gain": "m/m", "angular_gain": "rad/rad", "axial_per_acceleration": "m/(m/s^2)",
        "angular_per_acceleration": "rad/(rad/s^2)", "axial_touch": "m/s^2", "axial_touch_aligned": "m/s^2",
        "angular_touch": "rad/s^2", "angular_touch_aligned": "rad/s^2", "frequency": "Hz", "damped_frequency": "Hz",
        "growth_rate": "1/s", "damping_ratio": "1", "gain": "1", "touch": "m/s^2", "acceleration": "m/s^2",
        "lowest": "Hz", "highest": "Hz", "accelerations": "m/s^2", "inside": "1", "margin": "1", "film_left": "m",
        "deviation": "1", "ratio": "1",
    },
    along={"table": ("frequency",), "modes": ("frequency",)},
)  # fmt: skip
DIRECTIONS = ("axial", "angular")
# The gear mesh of the guide (m/s^2), where the scenario's application has no frequencies (Hz) of its own.
GEAR_MESH, GEAR_MESH_ACCELERATION = (5400.0,), 45.0 * g
# Points about a resonance, in its width.
NEAR = (-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0)
# Of the accelerations that are those of a direction.
OF_DIRECTION = {"axial": "m/s^2", "angular": "rad/s^2"}
WORDS = {"axial": "axial vibration of the housing", "angular": "angular vibration of the face's outer edge"}
EDGE = {"axial": "axial", "angular": "angular, at the outer edge"}
# Colours and marks; curves that lie on each other are seen.
STYLE = {"axial": ("rotor thick", "rotor circle"), "angular": ("stator", "stator square")}
# Amplitudes of the housing (m) drawn as lines; room beside the first and last frequency.
AMPLITUDES = (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
ROOM = 1.05


@dataclass(frozen=True)
class Settings:
    """Frequencies, the accelerations that are asked about, and runs beside them."""

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


def run(scenario, settings, tools) -> Answer:
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
    numbers = {
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
    points = _points(settings, numbers)
    if points:
        # What a gas dam takes a minute for is not what everybody asks.
        tools.tell(f"vibration: {len(points)} tones in the time domain; --runs 0 leaves them out")
    rows = tools.map(partial(measured, scenario.scene), points, "time domain", ("direction", "frequency"))
    numbers["time_domain"] = rows
    apart = [row["deviation"] for row in rows if "failed" not in row]
    numbers["deviation"] = max(apart, default=None)
    numbers["units"] = dict.fromkeys(("weakest/touch", "time_domain/touch", "linear_touch"), unit_of(directions))
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers))


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


# --- what is shown ---------------------------------------------------------------------------------------


def _arm(numbers, direction: str) -> float:
    """From an acceleration of this direction to one of the housing or of the face's outer edge (m/s^2)."""
    return numbers["outer_radius"] if direction == "angular" else 1.0


def _found(numbers) -> str:
    """From which acceleration on the film is closed, where most easily."""
    said = []
    for found in numbers["weakest"]:
        touch = in_words("acceleration", _arm(numbers, found["direction"]) * found["touch"])
        ends = "" if found["inside"] else ", an end of the range"
        said.append(
            f"{WORDS[found['direction']]} from {touch} on, at {in_words('frequency_hz', found['frequency'])}{ends}"
        )
    if not any(found["touch"] for found in numbers["weakest"]):
        return "The scene's own runout and misalignment close the film without any vibration."
    return f"The faces touch in {'; in '.join(said)} (linear theory)."


def _notes(numbers) -> list[str]:
    """What touch means, and tones that had none in time."""
    rows, said = numbers["time_domain"], []
    if numbers["riding"]:
        said.append("The asperities touch at rest: their stiffness is in the response, and touch is where the faces' "
                    "mean planes meet.")  # fmt: skip
    untouched = sorted({row["said"] for row in rows if row.get("said")})
    said += [f"Tones without a touch in time: {'; '.join(untouched)}."] if untouched else []
    lost = [row["failed"] for row in rows if "failed" in row]
    return said + ([f"{len(lost)} tones failed in time, e.g. {lost[0]}"] if lost else [])


def _tables(numbers) -> list[Table]:
    """Touch, bands, modes, gear mesh, and the time domain; accelerations of the housing or the outer edge."""
    hertz, rows = "frequency_hz", []
    for found, peak in zip(numbers["weakest"], numbers["peaks"], strict=True):
        touch = _arm(numbers, found["direction"]) * found["touch"]
        amplitude = touch / (2 * math.pi * found["frequency"]) ** 2
        rows.append([found["direction"], found["frequency"], touch, amplitude, peak["gain"], peak["frequency"]])
    columns = [("1", "direction"), (hertz, "touches most easily at"), ("acceleration", "from"), ("m", "amplitude"),
               ("share", "at most moves the gap"), (hertz, "at")]  # fmt: skip
    tables = [Table("touch", columns, rows)]
    rows = [[band["acceleration"], band["direction"], band["lowest"], band["highest"]] for band in numbers["bands"]]
    asked = [[a, d, None, None] for a in numbers["accelerations"] for d in numbers["directions"]
             if not any(row[:2] == [a, d] for row in rows)]  # fmt: skip
    columns = [("acceleration", "asked"), ("1", "direction"), (hertz, "closes the film from"), (hertz, "to")]
    tables.append(Table("bands", columns, rows + asked))
    columns = [("1", "mode", "kind"), ("1", "turns", "direction"), (hertz, "natural", "frequency"),
               (hertz, "damped", "damped_frequency"), ("1", "damping ratio", "damping_ratio"),
               ("growth_rate", "growth rate", "growth_rate")]  # fmt: skip
    tables.append(table_of("modes", columns, numbers["modes"]))
    columns = [("1", "gear mesh", "direction"), (hertz, "frequency", "frequency"), ("acceleration", "touch", "touch"),
               ("1", "times 45 g", "margin"), ("h_min", "film left at 45 g", "film_left")]  # fmt: skip
    tables.append(table_of("gear mesh", columns, numbers["gear_mesh"]))
    rows = []
    for row in numbers["time_domain"]:
        arm, touches = _arm(numbers, row["direction"]), ("touch", "linear_touch")
        rows.append(row | {name: arm * row[name] for name in touches if row.get(name) is not None})
    columns = [("1", "in time", "direction"), (hertz, "frequency", "frequency"), ("1", "gap per motion", "gain"),
               ("1", "away from linear", "deviation"), ("acceleration", "touch", "touch"),
               ("acceleration", "linear", "linear_touch"), ("1", "ratio", "ratio")]  # fmt: skip
    return [*tables, table_of("in time", columns, rows)]


def _panels(numbers) -> list[Panel]:
    """The acceleration of touch above how much of the motion the gap takes up."""
    table = numbers["table"]
    frequency = table["frequency"]
    axis = Axis(
        "frequency_hz", "frequency of the housing", scale="log", low=frequency[0] / ROOM, high=ROOM * frequency[-1]
    )
    touches = {d: [_arm(numbers, d) * v or None for v in table[f"{d}_touch"]] for d in numbers["directions"]}
    aligned = {d: [_arm(numbers, d) * v for v in table[f"{d}_touch_aligned"]] for d in numbers["directions"]}
    # Whether the scene's own runout and misalignment are seen.
    own = any((v or 0.0) < 0.97 * w for d in touches for v, w in zip(touches[d], aligned[d], strict=True))
    above, below = [], []
    for direction in numbers["directions"]:
        line, mark = STYLE[direction]
        done = [row for row in numbers["time_domain"] if row["direction"] == direction and "failed" not in row]
        touched = [row for row in done if row.get("touch") is not None]
        above.append(Series("line", frequency, touches[direction], label=EDGE[direction], style=line))
        if own:
            above.append(Series("line", frequency, aligned[direction], label=f"{direction}, aligned faces",
                                style=f"{line.split()[0]} dashed thin"))  # fmt: skip
        if touched:
            above.append(Series("marks", [row["frequency"] for row in touched],
                                [_arm(numbers, direction) * row["touch"] for row in touched],
                                label=f"{direction}, aligned, in time", style=f"{mark} open front"))  # fmt: skip
        below.append(Series("line", frequency, table[f"{direction}_gain"], style=line))
        below.append(Series("marks", [row["frequency"] for row in done], [row.get("gain") for row in done],
                            style=f"{mark} open front"))  # fmt: skip
    # A mesh outside the range is in the table.
    meshes = {(row["frequency"], row["acceleration"]) for row in numbers["gear_mesh"]}
    meshes = [mesh for mesh in meshes if frequency[0] <= mesh[0] <= frequency[-1]]
    if meshes:
        above.append(Series("marks", *zip(*meshes, strict=True), label="gear mesh of the guide, 45 g",
                            style="bad star large front"))  # fmt: skip
    values = [v for one in above for v in one.y if v] + list(numbers["accelerations"])
    low, high = 0.5 * min(values), 2.0 * max(values)
    levels = [Level(a, "asked", style="bad dashed", number=True) for a in numbers["accelerations"]]
    modes = [Level(mode["frequency"], f"{mode['kind']} mode", upright=True, style="grey dotted")
             for mode in numbers["modes"] if frequency[0] < mode.get("frequency", 0.0) < frequency[-1]]  # fmt: skip
    return [
        Panel("Acceleration at which the faces touch", axis, Axis("acceleration", scale="log", low=low, high=high),
              [*_amplitudes(frequency, low, high), *above], levels, tall=1.3),
        Panel("What the gap takes up", axis, Axis("share", "gap's share of the motion", low=0.0), below, modes,
              below=True),
    ]  # fmt: skip


def _amplitudes(frequency, low: float, high: float) -> list[Series]:
    """Lines of equal amplitude of the housing, named where they enter the panel."""
    series = []
    for amplitude in AMPLITUDES:
        ends = [max(frequency[0], math.sqrt(low / amplitude) / (2 * math.pi)),
                min(frequency[-1], math.sqrt(high / amplitude) / (2 * math.pi))]  # fmt: skip
        if ends[1] > 2.0 * ends[0]:
            y = [amplitude * (2 * math.pi * at) ** 2 for at in ends]
            series.append(Series("line", ends, y, style="grey thin faint", names=[in_words("m", amplitude)]))
    return series
