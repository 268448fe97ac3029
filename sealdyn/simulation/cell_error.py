"""How far the cells of a film are from the film itself: force, moment and leakage once more with half the cells.

**Source** Richardson (1911), *Phil. Trans. R. Soc. A* 210, 307: what halving changes, over 2^2 - 1, is the error of a
method of second order.
"""

import numpy as np

from ..faces.geometry import CONING_RATE, DZ_RATE, FLOW_INNER, FORCE, GX_RATE, GY_RATE, MOMENT_X, MOMENT_Y
from ..faces.surfaces import lay_surfaces
from .looked_at import LookedAt

# The difference to half the cells, over this, is the error of all of them.
RICHARDSON = 3.0


def cell_error(run) -> float | None:
    """Relative error of the film's cells, the largest of force, moment and leakage on the scales of the certificate, of
    the film at rest at the gap where the run began and where it ended; None of a film that has none to halve, or no
    steady pressures there."""
    model = run.model
    film, f = model.observed
    if not hasattr(film, "halved"):
        return None
    coarse = film.parameters(model.interface.halved(), model.clearance)
    lay_surfaces(coarse, model.scene)
    scales, worst = LookedAt(run), 0.0
    for index, tau, y in ((0, 0.0, run.y0), run.last or (0, 0.0, run.y0)):
        loads = []
        for block in (f, coarse):
            s, x = run.segment(index).gap_state(tau, y).copy(), np.empty(len(film.unknowns(block).names))
            s[[DZ_RATE, GX_RATE, GY_RATE, CONING_RATE]] = 0.0
            if film.start(block, s, x):
                return None
            film.flow(block, s, x)
            still = np.zeros(2 * scales.n)
            loads.append([[*still, s[FORCE], s[MOMENT_X], s[MOMENT_Y], s[FLOW_INNER], 0.0]])
        worst = max(worst, scales.errors(*map(np.array, loads[::-1])).max())
    return float(worst) / RICHARDSON
