"""What a film by lines of radius leaves out: the same gap beside the film over radius and angle.

Two things: flow along the circle, little in narrow faces, and where the pressure would be below that of cavities the
liquid that these keep.  A floor of the pressure makes liquid where cavities end, and so is full at once where they take
their time to fill: force and moment are too large where cavities are long, leakage may be anything.  Both films stand
in the frame that turns with the tilt, in which cavities are steady.
**Source** films/reynolds beside the film of a run.
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
from ..films import film_module, film_name, refused
from ..numerics.piecewise_linear import initially
from ..scene.reynolds import Reynolds
from ..scene.waviness import waves_of
from .steady_tilt import steady_tilt

# Cells over radius and angle, and the least share of the face that counts as cavitated.
CELLS, TORN = (40, 96), 1e-3
# Differences below this are those of the cells; a film with less than this share of a force has lost its liquid.
FINE, STARVED = 3e-3, 1e-6


def beside_reynolds(run) -> dict | None:
    """Force, moment and leakage of a run's film over those of the film "reynolds", less 1, at the start or at its
    linear steady tilt, whichever tilts it more: `tilt` (rad), `force`, `moment`, `leakage` (None where nothing leaks or
    turns), `cavitated` shares of the face, by either film, and a sentence, `said`.  None where the film has no lines of
    radius, or the other does not take the faces."""
    model = run.model
    scene, (film, f) = model.scene, model.observed
    floor = scene.film.cavitation_pressure is not None
    if model.unknowns.film_unknowns or waves_of(scene) or film_name(film) == "linear":
        return None
    options = Reynolds(cells_r=CELLS[0], cells_theta=CELLS[1], roughness="none", sectors=1,
                       cavitation="mass-conserving" if floor else "none")  # fmt: skip
    keeps, table = film_module("reynolds"), replace(scene.film, model="reynolds", reynolds=options)
    # Of a narrow seal, the two are one.
    table = replace(table, geometry="cylindrical")
    if refused(keeps, table):
        return None
    s = _state(run)
    g = keeps.parameters(table, model.clearance)
    lay_surfaces(g, scene)
    if h_min(f, s)[0] <= 0.0:
        return None
    other = s.copy()
    film.flow(f, s)
    tilt, torn = math.hypot(s[GX], s[GY]), s[CAVITATED] > TORN
    found = {"tilt": tilt, "force": None, "moment": None, "leakage": None, "cavitated": [float(s[CAVITATED]), None]}
    at = f"at a tilt of {1e6 * tilt:.4g} urad"
    what = f"floor of the pressure, on {100 * s[CAVITATED]:.2g} % of the face {at}" if torn else at
    x = np.empty(len(keeps.unknowns(g).names))
    code = keeps.start(g, other, x)
    if code == 0:
        keeps.flow(g, other, x)
    floor_alone = (scene.film.cavitation_pressure or 0.0) * math.pi * (table.outer_radius**2 - table.inner_radius**2)
    if code or (torn and other[FORCE] - floor_alone < STARVED * (s[FORCE] - floor_alone)):
        why = "a film that keeps its liquid is starved, edges at the cavitation pressure give it none"
        return found | {"said": f"{what}: {why}"} if torn else None
    moment = [math.hypot(at[MOMENT_X], at[MOMENT_Y]) for at in (s, other)]
    parts = {"leakage": (s[FLOW_INNER], other[FLOW_INNER]), "force": (s[FORCE], other[FORCE]), "moment": moment}
    if not tilt:
        del parts["moment"]
    off = {part: float(mine / whole - 1.0) for part, (mine, whole) in parts.items() if whole}
    than = "cavities that keep their liquid" if torn else "flow along the circle, too"
    than += ", between smooth faces" if scene.contact is not None else ""
    told = ", ".join(f"{part} {100 * share:+.2g} %" for part, share in off.items() if abs(share) > FINE)
    said = f"{what}, beside a film with {than} (reynolds): {told or f'the same within {100 * FINE:.2g} %'}"
    return found | off | {"cavitated": [float(s[CAVITATED]), float(other[CAVITATED])], "said": said}


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
