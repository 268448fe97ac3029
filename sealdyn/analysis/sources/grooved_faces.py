"""Films over grooves: rows computed elsewhere, and narrow-groove theory, against the film on triangles.

No published number of a film over so many grooves could be had (Muijderman (1964) and Malanoski & Pan (1965) give the
limit of infinitely many, in closed form).  The rows of grooved_rows.json are of an independent prototype: triangles
with other weights and sheared quadrilaterals, both extrapolated, within the tolerance that stands beside each number.
"""

import json
import math
from importlib.resources import files

import numpy as np

from ...closed_form.film import GroovedFace, narrow_groove_gas, narrow_groove_liquid
from ...faces.pattern import Box, Boxes, Spiral
from ...films._grooved.balance import Conditions, extrapolated, steady_pair
from ...films._grooved.motion import Motion

TITLE = "Own rows of spiral and T-grooves, and narrow-groove theory (Muijderman 1964); film on triangles, SI units"
FILM = "gas_reynolds"
COVERS = "force, flow, torque, stiffness and damping over spiral and T-grooves"
COLUMNS = {"case": "case", "quantity": "quantity", "elsewhere": "published", "computed": "computed",
           "deviation": "deviation", "verdict": "verdict"}  # fmt: skip

OWN, NARROW = "Own rows over grooves, another program", "Muijderman (1964), narrow grooves"
# Relative: where the two discretisations of the rows differ by more than the row says (stiffness, a liquid's flow).
LEAST = {"axial": 4e-3, "tilt": 4e-3, "outflow": 5e-3}
# Counts of grooves whose ratios to the theory are extrapolated in 1/count, by a polynomial, and what is left.
COUNTS, NARROW_TOLERANCE = (48, 96, 192), 6e-3
OF_STIFFNESS = "judged as a share of the stiffness at that frequency"
TEE = Boxes(12, 6e-6, (Box(0.0555, 0.0585, 0.7), Box(0.0585, 0.0616, 0.2)))


def grooved_rows() -> dict[str, dict]:
    """Faces, conditions and expected numbers, each with its relative tolerance (of a complex number: of its size)."""
    return json.loads(files(__package__).joinpath("grooved_rows.json").read_text(encoding="utf-8"))


def pattern_of(row) -> Spiral | Boxes:
    """The grooves of a row."""
    if row["spiral"] is None:
        return TEE
    count, inner, outer, degrees, share, depth = row["spiral"]
    return Spiral(count, inner, outer, math.radians(degrees), share, depth)


def conditions_of(row) -> Conditions:
    """The film of a row."""
    keys = "clearance", "viscosity", "inner_pressure", "outer_pressure", "shaft_speed"
    return Conditions(*(row[key] for key in keys), gas=row["gas"], cavity=row.get("cavity"))


def checks() -> list[dict]:
    """A row per number: besides what every source has `case`, `computed`, and what both are of a complex number, its
    size."""
    return [line for name, row in grooved_rows().items() for line in _own(name, row)] + _narrow()


def _own(name: str, row) -> list[dict]:
    coarse, fine, order = steady_pair(pattern_of(row), row["inner_radius"], row["outer_radius"], conditions_of(row))
    speed, lower = row["shaft_speed"], min(row["inner_pressure"], row["outer_pressure"])
    area = math.pi * (row["outer_radius"] ** 2 - row["inner_radius"] ** 2)
    motions = Motion(coarse, speed), Motion(fine, speed)

    def computed(key):
        times = 1j * speed * int(key[key.rindex("_") + 1 : -1]) if key.endswith("W") else 0.0
        if key.startswith("tilt"):
            return [motion.tilt_impedance(times) for motion in motions]
        if key.startswith("axial"):
            part = np.imag if "wD" in key else np.real
            return [part(motion.axial_impedance(times)) for motion in motions]
        return [{"force": one.force - lower * area, "outflow": one.flows[0], "torque": one.torque}[key]
                for one in (coarse, fine)]  # fmt: skip

    lines = []
    for key, (expected, tolerance) in row["expected"].items():
        value, _ = extrapolated(*computed(key), order)
        known = complex(*expected) if isinstance(expected, list) else expected
        # Damping is a small part of what meets the motion.
        damping = "wD" in key
        whole = abs(row["expected"]["axial_K_at_1W"][0]) if damping else abs(known)
        allowed = max(tolerance, next((least for part, least in LEAST.items() if key.startswith(part)), 0.0))
        agrees = abs(value - known) / whole <= allowed
        lines.append(_line(OWN, name, key, known, value, agrees, OF_STIFFNESS if damping else ""))
    return lines


def _narrow() -> list[dict]:
    """Force above the ambient and flow, of the limit of many grooves over the theory's."""
    lines = []
    face = GroovedFace(0.0516, 0.0616, 0.0555, 0.0616, math.radians(15.0), 0.5, 6e-6, 3e-6)
    ambient = 1e5 * math.pi * (face.outer_radius**2 - face.inner_radius**2)
    for name, law, viscosity, speed in (
        ("liquid", narrow_groove_liquid, 1e-3, 300.0), ("gas", narrow_groove_gas, 1.8e-5, 1000.0),
    ):  # fmt: skip
        conditions = Conditions(3e-6, viscosity, 1e5, 1e5, speed, gas=name == "gas")
        limit = law(face, viscosity, conditions.entrainment, 1e5, 1e5)
        found = many_over_narrow(face, conditions, limit, COUNTS)
        for quantity, known, ratio in zip(
            ("force", "outflow"), (limit.force - ambient, limit.flow), found, strict=True
        ):
            lines.append(_line(NARROW, f"many grooves, {name}", quantity, known, ratio * known,
                               abs(ratio - 1.0) <= NARROW_TOLERANCE))  # fmt: skip
    return lines


def many_over_narrow(face: GroovedFace, conditions: Conditions, limit, counts) -> np.ndarray:
    """Force above the pressure outside and flow, of the film over the theory's `limit`, (2,): a polynomial through so
    many grooves as `counts` has, at 1/count = 0."""
    ratios, ends = [], (face.inner_radius, face.outer_radius)
    ambient = conditions.outer_pressure * math.pi * (ends[1] ** 2 - ends[0] ** 2)
    for count in counts:
        grooved = face.groove_inner_radius, face.groove_outer_radius, face.angle, face.share, face.depth
        coarse, fine, order = steady_pair(Spiral(int(count), *grooved), *ends, conditions)
        force = extrapolated(coarse.force - ambient, fine.force - ambient, order)[0]
        flow = extrapolated(coarse.flows[0], fine.flows[0], order)[0]
        ratios.append((force / (limit.force - ambient), flow / limit.flow))
    return np.polynomial.polynomial.polyfit(1.0 / np.array(counts), ratios, len(counts) - 1)[0]


def _line(source, case, quantity, known, value, agrees, remark="") -> dict:
    return {
        "source": source, "case": case, "quantity": quantity, "published": _size(known), "computed": _size(value),
        "deviation": _size(value) / _size(known) - 1.0, "roads_apart": None,
        "verdict": "agrees" if agrees else "FAILED",
        "remark": remark if agrees else "not the number computed elsewhere",
    }  # fmt: skip


def _size(value) -> float:
    return float(abs(value)) if isinstance(value, complex) else float(value)


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    return f"{row['case'].replace('_', ' ')} {row['quantity'].replace('_', ' ')}"
