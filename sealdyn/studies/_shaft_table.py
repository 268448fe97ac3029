"""What the shaft feels of a seal, as tables over the speed for rotor models of other programs."""

import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..scenario.errors import ScenarioError
from ..scenario.reader import Scenario, scenario_of
from ..units import QuantityError, Speed
from ._runner import study

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
