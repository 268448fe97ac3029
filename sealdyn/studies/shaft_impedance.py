"""What the shaft feels of the seal: stiffness and damping of film, floating rings and supports in series, over the
frequency, as a rotor model takes them."""

from dataclasses import dataclass

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.model import Model
from ..dynamics.modes import at_shaft
from ..quantities import in_words
from ..scenario.errors import ScenarioError
from ..scenario.settings import values_in_si
from ..scene.scene import SceneError, arrangement, frozen_at_start
from . import Info
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
