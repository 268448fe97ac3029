"""Lebeck, Teale & Pierce (1979), wavy rough seal: load support, friction and leakage at balance, against the film
"reynolds" and Christensen's asperities.

Of nine waves the friction is left out: its printed digits are not to hand.  The report's
dimensional numbers contradict its dimensionless ones; these are what is computed, with the half height c of the
asperities, the outer radius and the speed as units.
"""

import math
from dataclasses import dataclass

from ...dynamics.imposed_motion import rest_state
from ...dynamics.interface import Interface, flow_at_rest
from ...faces.geometry import CONTACT_TORQUE, FLOW_INNER, FORCE, TORQUE
from ...scene.excitation import Shaft
from ...scene.film import Film, Reynolds
from ...scene.forces import HALF_HEIGHT, Contact
from ...scene.patterns import Waviness
from ...scene.rings import Stator, Support
from ...scene.scene import Closing, Scene

TITLE = "Lebeck, Teale & Pierce (1979), ONR ME-95(79)ONR-414-1, wavy rough seal at balance; reynolds, 24 x 180 a wave"
FILM = "reynolds"
COVERS = "load support, friction and leakage of a wavy rough seal at rest"
COLUMNS = {"waves": "order", "h_n/c": "amplitude", "quantity": "quantity", "published": "published",
           "reynolds": "computed", "independent": "independent", "deviation": "deviation",
           "verdict": "verdict"}  # fmt: skip
DIGITS = 4
SOURCE = "Lebeck, Teale & Pierce (1979), Table 3-1"
# The scene: units of length are the outer radius and the half height of the asperities.
INNER, OUTER, HALF = 0.045, 0.05, 0.5e-6
VISCOSITY, SPEED = 3.05e-4, 188.0
SEALED, BALANCE = 0.005, 0.75
CELLS = 24, 180
# Share of the number up to which a print agrees, or an independent computation does.
TOLERANCE = {"load_support": 4e-3, "friction_coefficient": 2e-2, "leakage": 2e-2}
UNEXPLAINED = (
    "the report's number does not follow from its equations as printed, and no error of it is known: coarser cells "
    "and cavities that do not keep their liquid carry more, not less"
)
UNPRINTED = "no printed number: the film against an independent computation"


@dataclass(frozen=True)
class Row:
    """Number of waves, their amplitude over the half height, and of load support, friction coefficient and leakage
    (over speed, outer radius squared and half height) the printed number, None where nothing is printed, and that of an
    independent computation of the same equations, in its digits."""

    order: int
    amplitude: float
    load_support: tuple[float | None, float]
    friction_coefficient: tuple[float | None, float] | None = None
    leakage: tuple[float | None, float] | None = None


ROWS = (Row(3, 0.0, (0.690, 0.690)), Row(3, 0.60, (0.845, 0.847), (0.0178, 0.0177), (0.0878, 0.0866)),
        Row(6, 0.55, (0.953, 0.958), (0.0065, 0.0066), (None, 0.0874)),
        Row(9, 0.42, (0.945, 0.964), None, (None, 0.0649)),
        Row(9, 0.525, (0.982, 0.992), None, (None, 0.0925)))  # fmt: skip


def scene_of(row: Row, cells=CELLS) -> Scene:
    """The seal of a row, SI, with `cells` over the radius and around a wave."""
    unit = pressure_unit(HALF)
    rough = Contact(roughness=HALF / HALF_HEIGHT, compressive_strength=100.0 * SEALED * unit,
                    shear_strength=10.0 * SEALED * unit)  # fmt: skip
    return seal(SEALED * unit, rough, Waviness(order=row.order, amplitude=row.amplitude * HALF), cells)


def pressure_unit(height: float) -> float:
    """Unit of pressure (Pa) where the unit of film thickness is a `height` (m)."""
    return VISCOSITY * SPEED * (OUTER / height) ** 2


def seal(sealed: float, contact: Contact, wave: Waviness, cells) -> Scene:
    """The report's seal with a `sealed` pressure (Pa), asperities, and one wave of the stator."""
    film = Film(
        inner_radius=INNER, outer_radius=OUTER, outer_pressure=sealed, inner_pressure=0.0, viscosity=VISCOSITY,
        cavitation_pressure=0.0, model="reynolds",
        reynolds=Reynolds(cells_r=cells[0], cells_theta=cells[1] * wave.order),
    )  # fmt: skip
    support = Support(axial_stiffness=0.0, radius=0.5 * (INNER + OUTER))
    return Scene(shaft=Shaft(speed=SPEED), film=film, contact=contact, stator=Stator(support=support, waviness=[wave]),
                 closing=Closing(balance_ratio=BALANCE, spring_force=0.0))  # fmt: skip


def balance(scene) -> dict[str, float]:
    """Load support, friction coefficient and leakage, dimensionless, and the clearance (over the half height) where
    film and asperities of a scene carry its closing force."""
    interface = Interface(scene, 1e-10)
    s, _ = rest_state(scene, interface.clearance)
    flow_at_rest(interface, s)
    closing = BALANCE * scene.film.outer_pressure * math.pi * (OUTER**2 - INNER**2)
    return {"load_support": s[FORCE] / closing,
            "friction_coefficient": (s[TORQUE] + s[CONTACT_TORQUE]) / (0.5 * closing * (INNER + OUTER)),
            "leakage": -s[FLOW_INNER] / (SPEED * OUTER**2 * HALF), "clearance": interface.clearance / HALF}  # fmt: skip


def checks() -> list[dict]:
    """Each number; besides what every source has order, amplitude (over c), computed and independent."""
    return [
        _row(row, quantity, computed[quantity])
        for row in ROWS
        for computed in [balance(scene_of(row))]
        for quantity in TOLERANCE
        if getattr(row, quantity)
    ]


def _row(row, quantity, computed) -> dict:
    told = {"source": SOURCE, "order": row.order, "amplitude": row.amplitude, "quantity": quantity}
    return told | judged(*getattr(row, quantity), computed, TOLERANCE[quantity], UNPRINTED)


def judged(published, independent, computed, tolerance: float, unprinted="", off=("unexplained", UNEXPLAINED)) -> dict:
    """What a row says of three numbers, of which one of the first two may be None; its remark where nothing is printed,
    and verdict and remark `off` the print."""
    apart = None if independent is None else abs(float(computed / independent - 1.0))
    deviation = None if published is None else float(computed / published - 1.0)
    verdict, remark = "agrees", ""
    if apart is not None and not apart <= tolerance:
        verdict, remark = "FAILED", "the film and an independent computation disagree"
    elif deviation is None:
        remark = unprinted
    elif not abs(deviation) <= tolerance:
        verdict, remark = off
    return {"published": published, "computed": float(computed), "independent": independent, "deviation": deviation,
            "roads_apart": apart, "verdict": verdict, "remark": remark}  # fmt: skip


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    return f"{row['order']} waves, {row['quantity'].replace('_', ' ')}"


def shown(row: dict) -> dict:
    """A row of which flat faces have no waves."""
    return row | {"order": str(row["order"]) if row["amplitude"] else "none"}
