"""Lebeck, Teale & Pierce (1979), Table 2-7: the wavy seal with Gaussian heights whose peaks are worn flat."""

import math

from ...scene.forces import Contact
from ...scene.patterns import Waviness
from ...scene.scene import Scene, SceneError
from .lebeck_1979 import CELLS, HALF, OUTER, TOLERANCE, UNEXPLAINED, balance, pressure_unit, seal

TITLE = "Lebeck, Teale & Pierce (1979), Table 2-7, wavy seal, Gaussian heights with plateaus; reynolds, 24 x 180 a wave"
FILM = "reynolds"
COVERS = "the same with faces worn to plateaus"
COLUMNS = {"plateau/sigma_1": "truncation", "quantity": "quantity", "published": "published", "computed": "computed",
           "independent": "independent", "deviation": "deviation", "verdict": "verdict"}  # fmt: skip
DIGITS = 5
SOURCE = "Lebeck, Teale & Pierce (1979), Table 2-7"
# Units of length are the outer radius and the composite rms roughness; three waves.
ROUGHNESS = OUTER / 3e5
ORDER, AMPLITUDE, SEALED, STRENGTH, SHEAR = 3, 1.2, 5.55e-4, 5.55e-2, 5.55e-3
# Of the plateaus, of the roughness: the report's are smooth, and their load jumps.
FINISH = 0.02
TOLERANCES = TOLERANCE | {"load_support": 1e-2, "leakage": 1e-2, "clearance": 1e-2}
# Truncation over one face's rms heights: printed number, and that of an independent computation, in its digits; None
# where there is no balance.
ROWS = {
    1.25: {"load_support": (0.998, 1.000), "clearance": (3.0555, 3.0873), "leakage": (0.1022, 0.0996),
           "friction_coefficient": (0.0019, None)},
    1.50: {"load_support": (0.895, 0.903), "clearance": (3.140, 3.166), "leakage": (0.1066, 0.1070),
           "friction_coefficient": (0.0124, 0.0124)},
    1.75: None,
}  # fmt: skip
FRICTION = "viscous shear over all of the film is 0.0027 by itself, more than the print has with contact"


def scene_of(truncation: float, cells=CELLS) -> Scene:
    """The seal of a row, SI, with `cells` over the radius and around a wave."""
    unit = pressure_unit(ROUGHNESS)
    worn = Contact(roughness=ROUGHNESS, law="plateaus", truncation=truncation, plateau_roughness=FINISH * ROUGHNESS,
                   compressive_strength=STRENGTH * unit, shear_strength=SHEAR * unit)  # fmt: skip
    return seal(SEALED * unit, worn, Waviness(order=ORDER, amplitude=AMPLITUDE * ROUGHNESS), cells)


def checks() -> list[dict]:
    """Each number of the table; besides what every source has truncation, computed and independent."""
    rows = []
    for truncation, numbers in ROWS.items():
        try:
            found = balance(scene_of(truncation))
        except SceneError:
            # No clearance holds the closing force.
            found = None
        if numbers is None:
            rows.append(_row(truncation, "balances", 0.0, (None, 0.0), float(found is not None)))
            continue
        # In units of the roughness, of which the other table's is a multiple.
        found = dict.fromkeys(numbers, math.nan) if found is None else found
        found |= {name: found[name] * HALF / ROUGHNESS for name in ("clearance", "leakage")}
        rows += [_row(truncation, name, TOLERANCES[name], print_, found[name]) for name, print_ in numbers.items()]
    return rows


def _row(truncation, quantity, tolerance, numbers, computed) -> dict:
    published, independent = numbers
    expected = published if independent is None else independent
    apart = None if independent is None else abs(computed - independent) / (abs(independent) or 1.0)
    deviation = None if published is None else float(computed / published - 1.0)
    verdict, remark = "agrees", ""
    if apart is not None and not apart <= tolerance:
        verdict, remark = "FAILED", "the film and an independent computation disagree"
    elif deviation is None:
        remark = "no clearance at which film and plateaus carry the closing force, as the report says"
    elif not abs(computed / expected - 1.0) <= tolerance:
        verdict, remark = "unexplained", FRICTION
    elif not abs(deviation) <= tolerance:
        verdict, remark = "unexplained", UNEXPLAINED
    return {"source": SOURCE, "truncation": truncation, "quantity": quantity, "published": published,
            "computed": float(computed), "independent": independent, "deviation": deviation, "roads_apart": apart,
            "verdict": verdict, "remark": remark}  # fmt: skip


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    return f"{row['truncation']:.2f}, {row['quantity'].replace('_', ' ')}"
