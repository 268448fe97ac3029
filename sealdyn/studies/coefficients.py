"""Stiffness and damping of the film and of asperities that touch, 3 x 3 on (dz, tilt about x, tilt about y): aligned,
tilted, over speed and clearance."""

import cmath
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from ..analysis.film_matrices import State, gap_state, mapped, matrices, opened
from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.model import Model
from ..faces.film_thickness import h_min
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.settings import Words, values_in_si
from ..scene.patterns import grooves_of, waves_of
from ..scene.scene import SceneError, frozen_at_start, tilting
from ..scene.tabulated import ELEMENTS as NAMES
from ..scene.tabulated import ORDER
from ..simulation.film_error import steady_tilt
from ..units import Angle, Length, Speed, Tilt
from . import Info

ACCURACY = 1e-10
STIFFNESS_UNITS = [["N/m", "N/rad", "N/rad"], ["N", "N*m/rad", "N*m/rad"], ["N", "N*m/rad", "N*m/rad"]]
DAMPING_UNITS = [[u.replace("/m", "*s/m").replace("/rad", "*s/rad") if "/" in u else u + "*s" for u in row]
                 for row in STIFFNESS_UNITS]  # fmt: skip
AXES = ("speed", "frequency", "coning", "clearances")
# Rows and columns of a matrix.
ELEMENTS, FORCES = ("force", "motion"), ("force", "moment_x", "moment_y")
# What the answer says of them.
LABELS = {"order": list(ORDER), "motion": list(ORDER), "force": list(FORCES)}
UNITS = {"stiffness_units": STIFFNESS_UNITS, "damping_units": DAMPING_UNITS}
INFO = Info(
    timed=("fmr_reference", 2),
    asks="How stiff is the film, and how does it damp?",
    wavy=True,
    grooved=True,
    aligned=True,
    units={
        "speed": "rad/s", "frequency": "rad/s", "coning": "rad", "clearance": "m", "clearances": "m",
        "tilt": "rad", "axial_opening": "m",
        "stiffness": STIFFNESS_UNITS, "damping": DAMPING_UNITS,
        # Over grooves.
        "leakage": "m^3/s", "mass_flow": "kg/s", "torque": "N*m", "film_force": "N", "least_pressure": "Pa",
        **dict.fromkeys(("modes/axial", "modes/tilt_forward", "modes/tilt_backward"), "1/s"),
        **dict.fromkeys(("tracking/by_runout", "tracking/by_misalignment", "tracking/by_groove",
                         "tracking/at_twice", "tracking/largest"), "rad"),
        "twice/frequency": "rad/s", "twice/forward": "N*m/rad", "twice/backward": "N*m/rad",
        "tracking/h_min": "m",
        "error": "1",
        **dict(zip(NAMES, [unit for row in STIFFNESS_UNITS + DAMPING_UNITS for unit in row], strict=True)),
    },
    along={
        **dict.fromkeys(("stiffness", "damping", "synchronous", "tilted"), ELEMENTS),
        **{f"against_{name}": (name, *ELEMENTS) for name in ("speed", "clearance", "tilt", "frequency")},
        "map": ("speed", "frequency", "coning?", "clearances?", *ELEMENTS), "table": ("row",),
    },
)  # fmt: skip
# Elements in tilt: name, row, column, style.
TILT = (("Kxx", 1, 1, "blue"), ("Kyy", 2, 2, "good dashed"), ("Kxy", 1, 2, "bad"), ("Kyx", 2, 1, "warn dashed"))
# Of the largest of its panel: a curve that is nowhere more cannot be told from zero, and what is rounding.
UNSEEN, NOTHING = 0.01, 1e-9
# Panels of the map: title, matrix, place in it, and quantity.
MAP = (
    ("Axial stiffness", "stiffness", (0, 0), "axial_stiffness"),
    ("Tilt stiffness", "stiffness", (1, 1), "tilt_stiffness"),
    ("Cross stiffness", "stiffness", (1, 2), "tilt_stiffness"),
    ("Tilt damping", "damping", (1, 1), "tilt_damping"),
)
MOST_LINES = 6

SPEEDS, CONINGS, CLEARANCES = (Words(kind.__metadata__[0]) for kind in (Speed, Tilt, Length))


@dataclass(frozen=True)
class Settings:
    """The tilted state, and what the matrices are followed over."""

    tilt: Angle | None = None
    """Relative misalignment of the tilted state; without it the mean of the linear steady state, or, if that is
    nothing, its turning part."""
    tilt_direction: Angle = 0.0
    """Its direction from the x axis."""
    speed_to: Speed | None = None
    """Highest speed, from rest; without it three times the scenario's."""
    clearance_from: Length | None = None
    """Least clearance; without it 0.3 of the scene's."""
    clearance_to: Length | None = None
    """Largest clearance; without it three times the scene's."""
    points: int = 41
    """Number of speeds, of clearances and of tilts."""
    frequency: Annotated[str | float | None, SPEEDS] = None
    """Frequencies of the motion, "0:2kHz:60" or a list; with it the answer has a table of the aligned film's matrices
    for a rotordynamics code, over speed, frequency and coning."""
    speed: Annotated[str | float | None, SPEEDS] = None
    """Shaft speeds of that table, "500:2000 rad/s:7" or a list, each at the clearance that follows there."""
    coning: Annotated[str | float | None, CONINGS] = None
    """Conings of that table, "0:6 mrad:13" or a list."""
    clearance: Annotated[str | float | None, CLEARANCES] = None
    """Clearances of that table, "5:20 um:16" or a list, in place of conings; a film by numbers
    (`film.model = "tabulated"`) reads it over clearance and speed."""


def run(scenario, settings, tools) -> Answer:
    """Matrices aligned and tilted, and sweeps."""
    scene = frozen_at_start(scenario.scene)
    units = {"frequency": "rad/s", "speed": "rad/s", "coning": "rad", "clearance": "m"}
    asked = {name: getattr(settings, name) for name in units}
    asked |= {name: values_in_si(scenario, str(given), units[name], f"--{name}") for name, given in asked.items()
              if given is not None}  # fmt: skip
    if grooves_of(scene)[1]:
        from ._grooved import coefficients_over_grooves

        answer = coefficients_over_grooves(scene, asked)
        table = {"table": columns_of(answer.numbers["map"])} if "map" in answer.numbers else {}
        return replace(answer, numbers=answer.numbers | LABELS | UNITS | table)
    if asked["coning"] is not None and asked["clearance"] is not None:
        raise ScenarioError(scenario.name, "study.coefficients.clearance", "conings and clearances", "one of them")
    model, speed = Model(scene, ACCURACY), scene.shaft.speed
    tilted, speeds = model if model.unknowns.with_tilt else Model(tilting(scene), ACCURACY), _speeds(settings, speed)
    numbers = {
        **LABELS,
        "film": model.interface.name,
        **_listed(matrices(model, State())),
        **UNITS,
        "at": _at(model, State(), speed),
        "stator_speed": scene.stator.speed,
        "asperities": scene.contact is not None,
        "tilted": _tilted(tilted if settings.tilt else model, settings, speed),
        "against_speed": _columns("speed", speeds, [_listed(matrices(model, State(), w)) for w in speeds]),
        "against_clearance": _against_clearance(model, settings),
        "against_tilt": _against_tilt(tilted, settings),
    }
    motion = asked["frequency"]
    if model.interface.stores:
        numbers["against_frequency"] = against_frequency(model, settings, speed, motion)
        numbers["synchronous"] = _listed(matrices(model, State(), omega=abs(speed))) if speed else None
    if any(values is not None for values in asked.values()):
        # Speeds that nobody asked go with frequencies only.
        given = asked["speed"] or ([speed] if motion is None else speeds)
        numbers["map"] = mapped(scene, ACCURACY, given, motion or [0.0], asked["coning"], asked["clearance"])
        numbers["table"] = columns_of(numbers["map"])
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers))


def _tilted(model, settings, speed) -> dict:
    if settings.tilt is not None:
        tilt, whirl, said = cmath.rect(settings.tilt, settings.tilt_direction), 0.0, "mean tilt given"
    else:
        tilt, whirl, said = steady_tilt(model)
    try:
        state = State(opened(model, tilt, whirl), tilt, whirl)
        return {**_listed(matrices(model, state)), "at": _at(model, state, speed), "said": said}
    except ValueError as reason:
        return {"stiffness": None, "damping": None, "at": None, "said": f"{said}: {reason}"}


def _at(model, state: State, speed) -> dict:
    return {
        "clearance": model.clearance,
        "axial_opening": state.dz,
        "tilt_x": state.tilt.real,
        "tilt_y": state.tilt.imag,
        "whirl": state.whirl,
        "h_min": float(h_min(model.face, gap_state(model, state, speed))[0]),
        "speed": float(speed),
    }


# --- sweeps --------------------------------------------------------------------------------------------


def _listed(found) -> dict:
    stiffness, damping = found
    return {"stiffness": stiffness.tolist(), "damping": damping.tolist()}


def _columns(name, values, rows) -> dict:
    """Matrices over a sweep; a point that cannot be is None."""
    return {
        name: [float(v) for v in values],
        **{key: [row.get(key) for row in rows] for key in ("stiffness", "damping", "failed")},
    }


def _speeds(settings, speed) -> np.ndarray:
    top = settings.speed_to if settings.speed_to is not None else 3 * abs(speed) or 3000.0
    return np.linspace(0.0, top, max(2, settings.points))


def against_frequency(model, settings, speed, motion=None) -> dict:
    """Of a film that stores: what a motion of another frequency (rad/s) meets; without `motion` those of the
    speeds."""
    motion = _speeds(settings, speed) if motion is None else motion
    return _columns("frequency", motion, [_listed(matrices(model, State(), omega=w)) for w in motion])


def _against_clearance(model, settings) -> dict:
    low = settings.clearance_from or 0.3 * model.clearance
    high = settings.clearance_to or 3 * model.clearance
    clearances, rows = np.geomspace(low, high, max(2, settings.points)), []
    for clearance in clearances:
        try:
            other = Model(frozen_at_start(model.scene, clearance=float(clearance)), ACCURACY)
            rows.append(_listed(matrices(other, State())))
        except (SceneError, ValueError) as error:
            rows.append({"failed": str(error)})
    return _columns("clearance", clearances, rows)


def _against_tilt(model, settings) -> dict:
    """About a standing tilt up to nearly touching, the faces opening as they tilt."""
    crests = sum(wave.amplitude for wave in waves_of(model.scene))
    touch = min((h - crests) / r for r, h in model.aligned_gaps())
    tilts, rows, opening = np.linspace(0.0, 0.95 * touch, max(2, settings.points)), [], []
    for tilt in tilts:
        try:
            dz = opened(model, complex(tilt), 0.0)
            rows.append(_listed(matrices(model, State(dz, complex(tilt), 0.0))))
            opening.append(dz)
        except ValueError as error:
            rows.append({"failed": str(error)})
            opening.append(None)
    return {**_columns("tilt", tilts, rows), "axial_opening": opening}


# --- the map -------------------------------------------------------------------------------------------


def columns_of(found: dict) -> dict:
    """The same as columns of numbers, SI: every `speed`, `frequency` (rad/s) and, if asked, `coning` (rad) and
    `clearance` (m), and k_ROW_COLUMN and d_ROW_COLUMN for rows and columns of ORDER."""
    axes = [name for name in AXES if name in found]
    grid = np.meshgrid(*(found[name] for name in axes), indexing="ij")
    table = {name: values.ravel().tolist() for name, values in zip(axes, grid, strict=True) if name != "clearances"}
    parts = [np.array(found[name], dtype=object).reshape(-1, 9) for name in ("stiffness", "damping")]
    if len(axes) == 3:
        table["clearance"] = np.array(found["clearance"], dtype=object).ravel().tolist()
    return table | dict(zip(NAMES, np.hstack(parts).T.tolist(), strict=True))


# --- what is shown -------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """The aligned film, axially and in tilt."""
    k, d, at = numbers["stiffness"], numbers["damping"], numbers["at"]
    pace = d[1][1] * at["speed"]
    # A wedge film turns with the mean of both faces.
    wedge = 0.5 * (1.0 + numbers["stator_speed"] / at["speed"]) if at["speed"] else 0.0
    film = f"{numbers['film']} film" + (" with asperities" if numbers["asperities"] else "")
    ratio = f", {k[1][2] / pace:.4g} of shaft speed times damping ({wedge:.4g} for a wedge film)" if pace else ""
    return (
        f"Aligned at {in_words('clearance', at['clearance'])} the {film} has {in_words('axial_stiffness', k[0][0])} "
        f"axially, {in_words('tilt_stiffness', k[1][1])} in tilt and a cross stiffness of "
        f"{in_words('tilt_stiffness', k[1][2])}{ratio}."
    )


def _notes(numbers) -> list[str]:
    """What could not be reckoned, and where a film that stores feeds the motion."""
    said = [f"Tilted: {numbers['tilted']['said']}."] if numbers["tilted"]["stiffness"] is None else []
    for name, k in (("axial", 0), ("tilt", 1)) if (swept := numbers.get("against_frequency")) else ():
        negative = [w for w, d in zip(swept["frequency"], swept["damping"], strict=True) if d[k][k] < 0.0]
        if negative:
            ends = " to ".join(in_words("frequency", w) for w in (negative[0], negative[-1]))
            said.append(f"The film's {name} damping is negative (pneumatic hammer) at {len(negative)} of "
                        f"{len(swept['frequency'])} frequencies, {ends}.")  # fmt: skip
    for failed in numbers.get("map", {}).get("failed", ()):
        said.append(f"No film at {len(failed['points'])} points of the map: {failed['reason']}")
    return said


def _tables(numbers) -> list[Table]:
    """The states, their matrices, and the map point by point."""
    at, tilted = numbers["at"], numbers["tilted"]
    states = [("aligned", numbers, at), ("at the shaft's frequency", numbers.get("synchronous"), at),
              (f"tilted: {tilted['said']}", tilted, tilted["at"])]  # fmt: skip
    states = [state for state in states if state[1] and state[1]["stiffness"]]
    columns = [("1", "state"), ("clearance", "clearance"), ("tilt", "tilt x"), ("tilt", "tilt y"),
               ("clearance", "axial opening"), ("h_min", "thinnest film"), ("speed", "speed")]  # fmt: skip
    names = ("clearance", "tilt_x", "tilt_y", "axial_opening", "h_min", "speed")
    found = [Table("states", columns, [[name, *(where[n] for n in names)] for name, _, where in states])]
    heads = ["state", "on", *(f"{letter} {name}" for letter in "KD" for name in ("dz", "x", "y"))]
    columns = [("1", head) for head in heads]
    rows = [
        [name.split(":")[0] if i == 0 else "", on, *_row(held["stiffness"], i), *_row(held["damping"], i)]
        for name, held, _ in states
        for i, on in enumerate(("force, N", "moment x, N m", "moment y, N m"))
    ]
    found.append(Table("matrices", columns, rows))
    if "map" in numbers:
        grid = numbers["table"] | {"clearance": np.ravel(np.array(numbers["map"]["clearance"], object)).tolist()}
        heads = {
            "coning": ("rad", "coning"), "speed": ("speed", "speed"), "frequency": ("frequency", "frequency"),
            "clearance": ("clearance", "clearance"), "k_axial_axial": ("axial_stiffness", "axial k"),
            "d_axial_axial": ("axial_damping", "d"), "k_tilt_x_tilt_x": ("tilt_stiffness", "tilt k"),
            "k_tilt_x_tilt_y": ("tilt_stiffness", "cross k"), "d_tilt_x_tilt_x": ("tilt_damping", "d"),
        }  # fmt: skip
        names = [name for name in heads if name in grid]
        rows = zip(*(grid[name] for name in names), strict=True)
        found.append(Table("map", [heads[name] for name in names], [list(row) for row in rows]))
    return found


def _row(matrix, i: int) -> list[float]:
    """A row of a matrix, without what is left of cells that cancel a coupling."""
    size = [abs(matrix[i][i] * matrix[j][j]) ** 0.5 for j in range(3)]
    return [value if abs(value) > NOTHING * size[j] else 0.0 for j, value in enumerate(matrix[i])]


def _element(sweep, matrix: str, i: int, j: int) -> list:
    """An element of the matrices of a sweep, None where there is none."""
    return [None if found is None else found[i][j] for found in sweep[matrix]]


def _largest(sweep, matrix: str, i: int, j: int) -> float:
    return max((abs(v) for v in _element(sweep, matrix, i, j) if v is not None), default=0.0)


def _panels(numbers) -> list[Panel]:
    """Stiffness in tilt above damping and axial stiffness, over speed, clearance and tilt; below, the map."""
    at, held = numbers["at"], numbers.get("against_frequency")
    here = in_words("clearance", at["clearance"])
    shown = [
        (f"Over speed, at {here}", Axis("speed"), numbers["against_speed"]),
        ("Over clearance", Axis("clearance", scale="log"), numbers["against_clearance"]),
        ("Over tilt, axially balanced", Axis("tilt", "relative tilt about x"), numbers["against_tilt"]),
    ]
    if held:
        shown.append((f"Over frequency, at {here}", Axis("frequency", "frequency of the motion"), held))
    sweeps = [sweep for *_, sweep in shown]
    sizes = [{name: _largest(sweep, "stiffness", i, j) for name, i, j, _ in TILT} for sweep in sweeps]
    seen = {name for size in sizes for name in size if size[name] > UNSEEN * max(size.values())}
    seen = seen or set(sizes[0])
    damps = any(_largest(sweep, "damping", k, k) for sweep in sweeps for k in (1, 2))
    absent = [name for name, *_ in TILT if name not in seen]
    note = f"{', '.join(absent)} below 1 % of these" if absent else ""
    panels = []
    for k, (title, axis, sweep) in enumerate(shown):
        x = sweep[axis.quantity]
        axis = replace(axis, low=x[0], high=x[-1])
        above = [Series("line", x, _element(sweep, "stiffness", i, j), label=name if k == 0 else "", style=style)
                 for name, i, j, style in TILT if name in seen]  # fmt: skip
        panels.append(Panel(title, axis, Axis("tilt_stiffness"), above, [Level(0.0, style="black")], note=note))
        note = ""
        axial = Series("line", x, _element(sweep, "stiffness", 0, 0), label="axial stiffness" if k == 0 else "",
                       style="grey", right=damps)  # fmt: skip
        right = _from_zero(Axis("axial_stiffness"), axial.y, 1.05)
        drawn = (("Dxx", 1, "fourth"), ("Dyy", 2, "fourth dashed")) if damps else ()
        below = [Series("line", x, _element(sweep, "damping", i, i), label=name if k == 0 else "", style=style)
                 for name, i, style in drawn]  # fmt: skip
        values = [v for one in below for v in one.y if v is not None]
        log = axis.quantity == "clearance" and min(values, default=0.0) > 0.0
        left = Axis("tilt_damping", scale="log") if log else _from_zero(Axis("tilt_damping"), values, 1.3)
        panels.append(Panel("", axis, left if damps else right, [*below, axial], right=right if damps else None,
                            below=True))  # fmt: skip
    return panels + (_map_panels(numbers["map"]) if "map" in numbers else [])


def _from_zero(axis: Axis, values, room: float) -> Axis:
    """The axis from zero on, with `room` above, where all values are on one side."""
    known = [v for v in values if v is not None]
    top = max(known, default=0.0)
    return replace(axis, low=0.0, high=room * top) if top > 0.0 <= min(known) else axis


def _map_panels(found) -> list[Panel]:
    """The map over its longest axis, clearance and coning before the others; a line for each of some of the others."""
    quantities = {"clearances": "clearance", "coning": "rad", "frequency": "frequency", "speed": "speed"}
    axes = [name for name in AXES if name in found]
    along = next((name for name in quantities if len(found.get(name, ())) > 1), "speed")
    others = [name for name in axes if name != along]
    places = list(np.ndindex(*(len(found[name]) for name in others)))
    places = [places[k] for k in sorted({round(k) for k in np.linspace(0, len(places) - 1, MOST_LINES)})]
    axis, panels = Axis(quantities[along], along.removesuffix("s")), []
    matrices = {name: np.array(found[name], dtype=float) for name in ("stiffness", "damping")}
    clearance = np.array(found["clearance"], dtype=float)
    drawn = [(title, matrices[name][(..., *entry)], quantity) for title, name, entry, quantity in MAP]
    drawn = [one for k, one in enumerate(drawn) if k == 0 or _any(one[1], matrices[MAP[k][1]])]
    known = clearance[np.isfinite(clearance)]
    if "clearances" not in found and len(known) and np.ptp(known) > 1e-6 * known.max():
        drawn.append(("Clearance", clearance, "clearance"))
    for k, (title, values, quantity) in enumerate(drawn):
        series = []
        for nth, place in enumerate(places):
            at = dict(zip(others, place, strict=True))
            index = tuple(at.get(name, slice(None)) for name in axes)
            words = [in_words(quantities[n], found[n][j]) for n, j in at.items() if len(found[n]) > 1]
            style = ("thick", "", "thin")[min(nth, 2)] + " circle small" * (len(found[along]) < 3)
            label = ", ".join(words) or "scene's speed, slow motion"
            line = values[index].tolist()
            series.append(Series("line", found[along], line, label=label if k == 0 else "", style=style))
        panels.append(Panel(title, axis, Axis(quantity, " "), series, first=k == 0))
    return panels


def _any(values, matrix) -> bool:
    """Whether an element shows more than zero and rounding beside the others in tilt."""
    most = np.nanmax(np.abs(matrix[..., 1:, 1:]), initial=0.0)
    return bool(np.nanmax(np.abs(values), initial=0.0) > NOTHING * most)
