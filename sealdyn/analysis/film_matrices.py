"""Stiffness and damping of film and asperities about any state of the gap and over a grid of states, and the axial
balance of tilted faces."""

from dataclasses import dataclass

import numpy as np

from ..dynamics.equilibrium import ROUNDING, axial_excess, crossing, resolved_matrices
from ..dynamics.imposed_motion import set_conditions
from ..dynamics.model import Model
from ..faces.film_thickness import h_min
from ..faces.geometry import (
    COLLAPSE,
    DZ,
    FLOOR,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    MEAN_SPIN,
    SPIN_DIFFERENCE,
)
from ..quantities import resolved
from ..scene.scene import SceneError, frozen_at_start, with_values

STEP = 0.02


@dataclass(frozen=True)
class State:
    """Where the film is linearised: axial gap change (m), relative tilt (rad, complex), its rate of turning (rad/s)."""

    dz: float = 0.0
    tilt: complex = 0.0
    whirl: float = 0.0


def matrices(
    model: Model, state: State, speed: float | None = None, omega: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping (3, 3) of film and asperities about a state: what the opening force and the moments on the
    stator lose per displacement and per rate of (dz, g_x, g_y), moving at a frequency `omega` (rad/s), which matters to
    a film that stores only.  Raises ValueError where the faces touch."""
    s = gap_state(model, state, speed)
    thinnest = h_min(model.face, s)[0]
    if thinnest <= model.face[COLLAPSE]:
        raise ValueError(f"the faces touch at a tilt of {abs(state.tilt):.4g} rad")
    # Eight differences reach four steps to either side: stay clear of the other face, which rough ones may pass.
    length = STEP * min(model.clearance, max(thinnest, model.face[FLOOR]))
    tilt = length / model.face[1]
    pace = max(abs(s[MEAN_SPIN]), 1.0)
    found = model.interface.about(s, (length, tilt, length * pace, tilt * pace), omega)
    return resolved_matrices(*found, model.closing_force(), thinnest, model.face[1])


def gap_state(model: Model, state: State, speed: float | None = None) -> np.ndarray:
    """The gap-state array of a state at a shaft speed (rad/s)."""
    scene, s = model.scene, np.zeros(GAP_STATE_SIZE)
    w_r, w_s = scene.shaft.speed if speed is None else speed, scene.stator.speed
    s[DZ], s[GX], s[GY] = state.dz, state.tilt.real, state.tilt.imag
    turning = 1j * state.whirl * state.tilt
    s[GX_RATE], s[GY_RATE] = turning.real, turning.imag
    s[MEAN_SPIN], s[SPIN_DIFFERENCE] = 0.5 * (w_r + w_s), w_r - w_s
    set_conditions(s, scene, float, w_r)
    return s


def opened(model: Model, tilt: complex, whirl: float) -> float:
    """Axial opening (m) at which film, closing force and supports balance with the faces tilted."""
    s = gap_state(model, State(0.0, tilt, whirl))
    closing = model.closing_force()
    thinnest, excess = h_min(model.face, s)[0], axial_excess(model, s, closing)
    if resolved(excess(0.0), ROUNDING * closing) == 0.0:
        return 0.0
    # From faces that all but touch, or rough ones whose asperities are all but flat, upwards.
    closed = model.face[COLLAPSE] + 0.01 * model.face[FLOOR]
    low, reach = closed - thinnest, model.clearance
    high = max(low, 0.0)
    while excess(high) > 0 and high < 100 * reach:
        low, high = high, high + 0.25 * reach
    if excess(low) * excess(high) > 0:
        raise ValueError(f"no axial balance at a tilt of {abs(tilt):.4g} rad")
    return crossing(excess, low, high)


def mapped(scene, accuracy: float, speeds, frequencies, conings=None, clearances=None) -> dict:
    """{speed, frequency (rad/s), coning (rad) or clearances (m), if asked} and, over these in this order, `clearance`
    (m), `stiffness` and `damping` (3, 3) of the aligned film; `failed` the reasons of points that cannot be, whose
    numbers are None.

    `scene` constant in time.  At every speed and coning it is the scene with these: a clearance that is given stays,
    one that the closing force decides follows.  A film that does not store has the same at every frequency.
    """
    axis, key, values = ("coning", "film.coning", conings) if clearances is None else ("clearances", "", clearances)
    shape = (len(speeds), len(frequencies), 1 if values is None else len(values))
    flat, failed = {name: np.full(shape, None) for name in ("clearance", "stiffness", "damping")}, {}
    for a, speed in enumerate(speeds):
        for c, value in enumerate([None] if values is None else values):
            there = with_values(scene, {"shaft.speed": float(speed)} | ({key: float(value)} if key and values else {}))
            there = there if clearances is None else frozen_at_start(there, clearance=float(value))
            try:
                model, found = Model(there, accuracy), None
                for b, omega in enumerate(frequencies):
                    if found is None or model.interface.stores:
                        found = [part.tolist() for part in matrices(model, State(), omega=omega)]
                    for held, part in zip(flat.values(), (model.clearance, *found), strict=True):
                        held[a, b, c] = part
            except (SceneError, ValueError) as error:
                failed.setdefault(str(error), []).append({"speed": float(speed), axis: value})
    answer = {"speed": [float(w) for w in speeds], "frequency": [float(w) for w in frequencies]}
    if values is not None:
        answer[axis] = [float(v) for v in values]
    for name, held in flat.items():
        nothing = None if name == "clearance" else [[None] * 3] * 3
        listed = [[[nothing if v is None else v for v in row] for row in plane] for plane in held]
        answer[name] = listed if values is not None else [[row[0] for row in plane] for plane in listed]
    return answer | {"failed": [{"reason": reason, "points": points} for reason, points in failed.items()]}
