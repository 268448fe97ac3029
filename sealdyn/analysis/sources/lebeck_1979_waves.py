"""Lebeck, Teale & Pierce (1979), ch. 3: driven waves of an elastic ring, against the balances of the film "reynolds".

Eq. 3-12 (the largest waviness of the drive), the largest stable waviness of three waves (Table 3-3, read from a grid of
0.25), and the ring that is best (Table 3-5).  Table 3-2 is lost in the scan.
"""

from dataclasses import asdict, replace

import numpy as np

from ...dynamics.elastic_ring import design, joined, operating_point, stiffest
from ...scene.rings import ElasticRing
from . import lebeck_1979 as base

TITLE = "Lebeck, Teale & Pierce (1979), ONR ME-95(79)ONR-414-1, ch. 3, driven waves of an elastic ring; 12 x 60 a wave"
FILM = "reynolds"
COVERS = "largest driven and largest stable waviness of an elastic ring, and its best stiffness"
COLUMNS = {"waves": "order", "K": "stiffness", "quantity": "quantity", "published": "published",
           "reynolds": "computed", "independent": "independent", "deviation": "deviation",
           "verdict": "verdict"}  # fmt: skip
DIGITS = 4
SOURCE = "Lebeck, Teale & Pierce (1979), ch. 3"
TORSION, CENTROID, LENGTH = 6.0, 0.9508 * base.OUTER, 0.5 * base.OUTER
# Most that may leak, over speed, outer radius squared and half height; net wavinesses of three waves that are computed,
# and of others around that leakage.
LEAKAGE, CELLS, GRID, PRINTED_FOLD = 0.0878, (12, 60), 0.25, 0.75
THREE, OTHERS = np.geomspace(0.2, 3.0, 15), np.linspace(0.4, 0.65, 6)
# Film and independent computation agree so far; a print with as many digits.
TOLERANCE = 1e-2
# K of each row of Table 3-3, and the fold by an independent computation of 20 x 100 cells a wave.
FOLDS = ((1.25e-7, 0.660), (2.5e-7, 0.674), (5e-7, 0.708))
# Table 3-5: order, optimum K and load support there, printed; and independent ones of the stiffest ring that leaks
# the limit.
OPTIMA = ((6, 7.55e-7, 0.867, 1.101e-6, 0.958), (9, 2.19e-7, 0.950, 2.297e-7, 0.990))
# Eq. 3-12 at K = 2.5e-7 as it can be read.
DRIVEN, AT = ((6, 3.6), (9, 0.68)), 2.5e-7
READ_OFF = "read from a grid of 0.25: of its points the one with the largest initial waviness is printed"
LOST = (
    "by a graphical method of considerable error, as the report says, from its Table 3-2, which is lost; computed: the "
    "stiffest ring that its drive still bends to the waves that leak the limit, softer ones do no better"
)


def ring_of(stiffness: float) -> ElasticRing:
    """The ring of a K = E J c^3/(viscosity speed r_c^3 r_o^4), with the drive of the report."""
    bending = stiffness * base.VISCOSITY * base.SPEED * CENTROID**3 * base.OUTER**4 / base.HALF**3
    return ElasticRing(bending_stiffness=bending, radius=CENTROID, torsion_ratio=TORSION,
                       drive_pressure=base.SEALED * base.pressure_unit(base.HALF), drive_length=LENGTH)  # fmt: skip


def curve_of(order: int, nets) -> dict:
    """Balances of waves of one order along `nets` (over the half height), joined."""
    ring = ring_of(AT)
    scene = base.scene_of(base.Row(order, 1.0, (None, 1.0)), CELLS)
    scene = replace(scene, stator=replace(scene.stator, elastic=ring))
    points = [asdict(operating_point(scene, float(net) * base.HALF)) for net in nets]
    return joined(ring.compliance(order), points)


def checks() -> list[dict]:
    """Each number; besides what every source has order, stiffness (K), computed and independent; wavinesses over the
    half height."""
    rows = [_row(order, AT, "driven_waviness", published, ring_of(AT).driven(order) / base.HALF)
            for order, published in DRIVEN]  # fmt: skip
    three = curve_of(3, THREE)
    for stiffness, independent in FOLDS:
        ring = ring_of(stiffness)
        fold = design(ring, 3, three)["fold"] / base.HALF
        # What the grid makes of it is the print.
        explained = READ_OFF if largest_on_grid(ring, three) == PRINTED_FOLD else ""
        rows.append(_row(3, stiffness, "largest_stable_waviness", PRINTED_FOLD, fold, independent, explained))
    limit = LEAKAGE * base.SPEED * base.OUTER**2 * base.HALF
    for order, published, support, independent, carried in OPTIMA:
        best = stiffest(ring_of(AT), order, curve_of(order, OTHERS), limit)
        found = AT * best["stiffest"] / ring_of(AT).bending_stiffness
        rows.append(_row(order, published, "optimum_stiffness", published, found, independent))
        rows.append(_row(order, published, "optimum_load_support", support, best["load_support"], carried))
    return rows


def largest_on_grid(ring, curve) -> float:
    """Net waviness (over the half height) of most initial waviness among those of the report's grid."""
    nets = np.arange(GRID, curve["net"][-1] / base.HALF, GRID)
    load = np.interp(nets, curve["net"] / base.HALF, curve["load"])
    return float(nets[np.argmax(np.abs(nets * base.HALF - ring.compliance(3) * load))])


def _row(order, stiffness, quantity, published, computed, independent=None, explained="") -> dict:
    off = ("rounding", explained) if explained else ("unexplained", LOST)
    if independent is None:
        off = "FAILED", "not what eq. 3-12 gives"
    told = {"source": SOURCE, "order": order, "stiffness": stiffness, "quantity": quantity}
    return told | base.judged(published, independent, computed, TOLERANCE, off=off)


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    return f"{row['order']} waves, K = {row['stiffness']:g}, {row['quantity'].replace('_', ' ')}"
