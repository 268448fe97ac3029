"""What the shaft feels of the seal: stiffness and damping of film, floating rings and supports in series, over the
frequency, as a rotor model takes them.

`shaft_table` and `dyrobes_table` give it in Python over the speed, for rotor models of other programs.
"""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.model import Model
from ..dynamics.modes import at_shaft
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.reader import Scenario, scenario_of
from ..scenario.settings import values_in_si
from ..scene.scene import SceneError, arrangement, frozen_at_start
from ..units import QuantityError, Speed
from . import Info
from ._runner import study
from .coefficients import DAMPING_UNITS, ELEMENTS, FORCES, ORDER, STIFFNESS_UNITS

ALONG = ("frequency", *ELEMENTS)
INFO = Info(
    timed=("fmr_reference", 1),
    asks="What does the shaft feel of the seal?",
    refuses=("secondary-seal", "moment"),
    wavy=True,
    grooved=True,
    units={"frequency": "rad/s", "speed": "rad/s", "stiffness": STIFFNESS_UNITS, "damping": DAMPING_UNITS},
    along={"stiffness": ALONG, "damping": ALONG},
)
# Frequencies without any asked, in shaft speeds.
LOWEST, HIGHEST, COUNT = 0.05, 3.0, 60


@dataclass(frozen=True)
class Settings:
    """Frequencies of the shaft's motion."""

    frequency: str | None = None
    """"from:to:count[:log]" or "a, b, c" with a unit; without it up to three times the shaft speed."""


def run(scenario, settings, tools) -> Answer:
    """Matrices at the shaft over the frequency."""
    scene = frozen_at_start(scenario.scene)
    speed = abs(scene.shaft.speed) or 1000.0
    frequencies = np.linspace(LOWEST, HIGHEST, COUNT) * speed
    if settings.frequency is not None:
        frequencies = np.array(values_in_si(scenario, settings.frequency, "rad/s", "--frequency"))
    if not np.all(frequencies > 0.0):
        expected = "frequencies above 0: damping at rest is none"
        raise ScenarioError(scenario.name, "study.shaft_impedance.frequency", f"{settings.frequency}", expected)
    model = Model(scene)
    linear, found = model.linear_scene(), []
    for k, w in enumerate(frequencies):
        try:
            found.append(at_shaft(linear, float(w)))
        except ValueError as error:
            raise SceneError("rotor.support", str(error), "one tilt stiffness") from None
        tools.say((k + 1) / len(frequencies))
    z = np.array(found)
    numbers = {
        "force": list(FORCES), "motion": list(ORDER),
        "frequency": frequencies.tolist(), "speed": scene.shaft.speed, "arrangement": arrangement(scene),
        "stiffness": z.real.tolist(), "damping": (z.imag / frequencies[:, None, None]).tolist(),
    }  # fmt: skip
    notes = ["The inertia of a rotor that is rigid with the shaft is the shaft's own."]
    return Answer(numbers, _found(numbers), [_table(numbers)], _panels(numbers), notes)


def _found(numbers) -> str:
    """Stiffness at the frequency that is next to the shaft speed."""
    k = int(np.argmin(np.abs(np.array(numbers["frequency"]) - abs(numbers["speed"]))))
    matrix = numbers["stiffness"][k]
    return (f"At {in_words('frequency', numbers['frequency'][k])} the shaft feels "
            f"{in_words('axial_stiffness', matrix[0][0])} axially and {in_words('tilt_stiffness', matrix[1][1])} "
            f"in tilt.")  # fmt: skip


def _table(numbers) -> Table:
    """Axial, tilt direct and tilt cross, over the frequency."""
    columns = [("frequency", "frequency"), ("axial_stiffness", "axial k"), ("axial_damping", "d"),
               ("tilt_stiffness", "tilt k"), ("tilt_damping", "d"), ("tilt_stiffness", "cross k"),
               ("tilt_damping", "cross d")]  # fmt: skip
    matrices = (numbers[name] for name in ("frequency", "stiffness", "damping"))
    rows = [[w, k[0][0], d[0][0], k[1][1], d[1][1], k[1][2], d[1][2]] for w, k, d in zip(*matrices, strict=True)]
    return Table("at the shaft", columns, rows)


def _panels(numbers) -> list[Panel]:
    """Stiffness above damping, axial and tilt."""
    x, panels = numbers["frequency"], []
    own = [Level(abs(numbers["speed"]), "shaft speed", upright=True, style="black dotted")] if numbers["speed"] else []
    for title, kind, (k, j) in (("Axial", "axial", (0, 0)), ("Tilt", "tilt", (1, 2))):
        for matrix in ("stiffness", "damping"):
            lines = [Series("line", x, [m[k][k] for m in numbers[matrix]], label="direct" if k else "", style="film")]
            if k:
                lines.append(Series("line", x, [m[k][j] for m in numbers[matrix]], label="cross", style="bad"))
            panels.append(Panel(f"{title} {matrix}", Axis("frequency", "frequency of the shaft's motion"),
                                Axis(f"{kind}_{matrix}"), lines, [Level(0.0, style="black"), *own],
                                below=matrix == "damping"))  # fmt: skip
    return panels


SPEED = Speed.__metadata__[0]


def shaft_table(
    source: Scenario | str | os.PathLike[str],
    speeds: Iterable[float | str],
    whirl_ratio: float = 1.0,
    overrides: Mapping[str, Any] | Iterable[str] = (),
) -> dict[str, Any]:
    """Stiffness and damping that the shaft feels, at each of the `speeds` (rad/s, or with units) at a whirl of
    `whirl_ratio` times the speed: lists "speed" and "frequency" (rad/s), "stiffness" and "damping" (3, 3) of each, on
    (z, tilt_x, tilt_y), N, m, rad; as `study shaft-impedance` finds them.  `json.dump` writes it for others.
    **Valid** small motion.  **Raises** ScenarioError.

    >>> table = sealdyn.shaft_table("fms.toml", ["5000 rpm", "9000 rpm"])
    >>> [round(k[0][0]) for k in table["stiffness"]]
    [221608, -383730]
    """
    scenario = scenario_of(source, overrides)
    found: dict[str, Any] = {"whirl_ratio": whirl_ratio, "speed": [], "frequency": [], "stiffness": [], "damping": []}
    for given in speeds:
        try:
            speed = SPEED.read(given.item() if isinstance(given, np.generic) else given)
        except QuantityError as error:
            raise ScenarioError(scenario.name, "speeds", error.found, error.expected) from None
        frequency = abs(whirl_ratio * speed)
        if not 0.0 < frequency < np.inf:
            expected = "speeds and a ratio other than 0: damping at rest is none"
            raise ScenarioError(scenario.name, "speeds", f"{speed:g} rad/s, whirl_ratio {whirl_ratio:g}", expected)
        at_speed = scenario.with_({"shaft.speed": speed})
        answer = study("shaft-impedance", at_speed, workers=1, frequency=f"{frequency!r} rad/s").answer
        found["speed"].append(speed)
        for name in ("frequency", "stiffness", "damping"):
            found[name] += answer[name]
    return found


def dyrobes_table(table: Mapping[str, Any], unit: int, comment: str = "") -> str:
    """Text of a table (as of `shaft_table`) as DyRoBeS reads bearing coefficients from a file: 24 to a speed, zero but
    for the tilts; axial motion has no place there.  `unit`: the number by which your DyRoBeS knows N, m, kg and s.
    **Source** the help of DyRoBeS Rotor, "Bearing Coefficients from External Data File": first N, unit, number of
    coefficients, sense of rotation and three zeros, then a line of rpm, K, C and M of x and y, K, C and M of the tilts.

    >>> print(sealdyn.dyrobes_table(sealdyn.shaft_table("fms.toml", [500.0]), 3, "seal").splitlines()[0])
    1, 3, 24, 0, 0, 0, 0  seal
    """
    count = len(table["speed"])
    lines = [f"{count}, {unit}, 24, 0, 0, 0, 0  {' '.join(comment.split())}".rstrip()]
    for speed, stiffness, damping in zip(table["speed"], table["stiffness"], table["damping"], strict=True):
        tilts = [matrix[i][j] for matrix in (stiffness, damping) for i in (1, 2) for j in (1, 2)]
        numbers = [abs(speed) * 30.0 / np.pi, *[0.0] * 12, *tilts, *[0.0] * 4]
        lines.append(", ".join(f"{number:.9g}" for number in numbers))
    return "\n".join(lines) + "\n"
