"""What the floor of a film's pressure costs: beside it cavities that keep their liquid.

A film with a floor sets its pressure to that of cavities wherever it would be lower.  It makes liquid where cavities
end, and so is full at once where cavities would take their time to fill: force and moment are too large where these are
long, leakage may be anything.  Both films stand in the frame that turns with the tilt, in which cavities are steady.
**Source** the floor: half and full Sommerfeld films; cavities that keep their liquid: films/reynolds.
**Valid** faces that are the same all around, liquids without inertia.
"""

import math
from dataclasses import replace

import numpy as np

from ..faces.film_thickness import h_min
from ..faces.geometry import (
    CAVITATED,
    DZ_RATE,
    FLOW_INNER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
)
from ..faces.surfaces import lay_surfaces
from ..films import film_module, refused
from ..numerics.piecewise_linear import initially
from ..scene.reynolds import Reynolds
from ..scene.waviness import waves_of
from .steady_tilt import steady_tilt

# Cells of the film that keeps its liquid, and the least share of the face that counts as cavitated.
CELLS, TORN = (16, 128), 1e-3


def floor_beside_cavities(run) -> dict | None:
    """Force, moment and leakage of a run's film with a floor over those of cavities that keep their liquid, less 1, at
    the start or at its linear steady tilt, whichever tilts it more: `force`, `moment`, `leakage` (None where nothing
    leaks or turns), `cavitated` shares of the face, by either film, and a sentence, `said`.  None where the film has no
    floor or does not meet it there, or the other film does not take the faces."""
    model = run.model
    scene, (film, f) = model.scene, model.observed
    if scene.film.cavitation_pressure is None or model.unknowns.film_unknowns or waves_of(scene):
        return None
    options = Reynolds(cells_r=CELLS[0], cells_theta=CELLS[1], roughness="none", sectors=1)
    table, keeps = (
        replace(scene.film, model="reynolds", geometry="cylindrical", reynolds=options),
        film_module("reynolds"),
    )
    if refused(keeps, table):
        return None
    s = _state(run)
    g = keeps.parameters(table, model.clearance)
    lay_surfaces(g, scene)
    if h_min(f, s)[0] <= 0.0:
        return None
    other = s.copy()
    film.flow(f, s)
    if not s[CAVITATED] > TORN:
        return None
    tilt = 1e6 * math.hypot(s[GX], s[GY])
    x = np.empty(len(keeps.unknowns(g).names))
    code = keeps.start(g, other, x)
    if code:
        said = f"floor of the pressure, on {100 * s[CAVITATED]:.2g} % of the face at a tilt of {tilt:.4g} urad; of a " \
               f"film that keeps its liquid {keeps.STATUS[code]}"  # fmt: skip
        return {"force": None, "moment": None, "leakage": None, "cavitated": [float(s[CAVITATED]), None], "said": said}
    keeps.flow(g, other, x)
    moment = [math.hypot(at[MOMENT_X], at[MOMENT_Y]) for at in (s, other)]
    parts = {"leakage": (s[FLOW_INNER], other[FLOW_INNER]), "force": (s[FORCE], other[FORCE]), "moment": moment}
    found = {part: float(floored / kept - 1.0) if kept else None for part, (floored, kept) in parts.items()}
    of = ", ".join(f"{part} {100 * off:+.3g} %" for part, off in found.items() if off is not None)
    said = f"floor of the pressure, on {100 * s[CAVITATED]:.2g} % of the face at a tilt of {tilt:.4g} urad, beside " \
           f"cavities that keep their liquid (reynolds): {of}"  # fmt: skip
    return {**found, "cavitated": [float(s[CAVITATED]), float(other[CAVITATED])], "said": said}


def _state(run) -> np.ndarray:
    """Gap state at the start or of the linear steady tilt, in the frame that turns with the tilt."""
    scene, s = run.model.scene, run.segment(0).gap_state(0.0, run.y0).copy()
    tilt, rate = complex(s[GX], s[GY]), complex(s[GX_RATE], s[GY_RATE])
    whirl = (tilt.conjugate() * rate).imag / abs(tilt) ** 2 if tilt else 0.0
    steady, steady_whirl, _ = steady_tilt(run.model)
    if abs(steady) > abs(tilt):
        tilt, whirl = steady, steady_whirl
    s[DZ_RATE : DZ_RATE + 3] = 0.0
    s[GX], s[GY], s[GX_RATE], s[GY_RATE] = tilt.real, tilt.imag, 0.0, 0.0
    s[MEAN_SPIN] = 0.5 * (initially(scene.shaft.speed) + initially(scene.stator.speed)) - whirl
    return s
