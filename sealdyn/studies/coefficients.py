"""Stiffness and damping of the film and of asperities that touch, 3 x 3 on (dz, tilt about x, tilt about y): aligned,
tilted, over speed and clearance."""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from ..dynamics.equilibrium import axial_excess, crossing
from ..dynamics.fluid import set_conditions
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
from ..scenario.settings import values_in_si
from ..scene.scene import SceneError
from ..scene.variants import frozen_at_start
from ..scene.waviness import waves_of
from ..simulation.steady_tilt import steady_tilt
from ..units import Angle, Length, Speed
from ._words import frequencies
from ._words import speed as speed_words

WITH_WAVES = True
# Rows and columns of the matrices.
ORDER = ("axial", "tilt_x", "tilt_y")
STIFFNESS_UNITS = [["N/m", "N/rad", "N/rad"], ["N", "N*m/rad", "N*m/rad"], ["N", "N*m/rad", "N*m/rad"]]
DAMPING_UNITS = [[u.replace("/m", "*s/m").replace("/rad", "*s/rad") if "/" in u else u + "*s" for u in row]
                 for row in STIFFNESS_UNITS]  # fmt: skip
STEP = 0.02

ALONG = {f"against_{name}": (name,) for name in ("speed", "clearance", "tilt", "frequency")} | {"table": ("row",)}
units = {
    "speed": "rad/s",
    "frequency": "rad/s",
    "clearance": "m",
    "tilt": "rad",
    "axial_opening": "m",
    "stiffness": STIFFNESS_UNITS,
    "damping": DAMPING_UNITS,
} | {
    f"{letter}_{row}_{column}": matrix[i][j]
    for letter, matrix in (("k", STIFFNESS_UNITS), ("d", DAMPING_UNITS))
    for i, row in enumerate(ORDER)
    for j, column in enumerate(ORDER)
}  # fmt: skip


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fmr_reference", 3)


@dataclass(frozen=True)
class Settings:
    """The tilted state, and what the matrices are followed over."""

    tilt: Angle | None = None
    """Relative misalignment of the tilted state; without it the mean of the linear steady state, or, if that is
    nothing, its turning part."""
    tilt_direction: Angle = 0.0
    """Its direction from the x axis."""
    speed_to: Speed | None = None
    """Highest speed, from rest; without it three times the scenario's."""
    clearance_from: Length | None = None
    """Least clearance; without it 0.3 of the scene's."""
    clearance_to: Length | None = None
    """Largest clearance; without it three times the scene's."""
    points: int = 41
    """Number of speeds, of clearances and of tilts."""
    frequency: str | float | None = None
    """Frequencies of the motion, "0:2kHz:60" or a list; with it the answer has a table of the aligned film's matrices
    over speed and frequency for a rotordynamics code."""


@dataclass(frozen=True)
class State:
    """Where the film is linearised: axial gap change (m), relative tilt (rad, complex), its rate of turning (rad/s)."""

    dz: float = 0.0
    tilt: complex = 0.0
    whirl: float = 0.0


def run(scenario, settings, tools) -> dict:
    """Matrices aligned and tilted, and sweeps."""
    scene = frozen_at_start(scenario.scene)
    model, speed = Model(scene, 1e-10), scene.shaft.speed
    answer = {
        "order": list(ORDER),
        "film": model.interface.name,
        **_listed(matrices(model, State())),
        "stiffness_units": STIFFNESS_UNITS,
        "damping_units": DAMPING_UNITS,
        "at": _at(model, State(), speed),
        "tilted": _tilted(model, settings, speed),
        "against_speed": _against_speed(model, settings, speed),
        "against_clearance": _against_clearance(scene, model, settings),
        "against_tilt": _against_tilt(model, settings),
    }
    asked = settings.frequency
    frequencies = None if asked is None else values_in_si(scenario, str(asked), "rad/s", "--frequency")
    if model.interface.stores:
        answer["against_frequency"] = against_frequency(model, settings, speed, frequencies)
        answer["synchronous"] = _listed(matrices(model, State(), omega=abs(speed))) if speed else None
    if frequencies is not None:
        answer["table"] = table(model, _speeds(settings, speed), frequencies)
    return answer | {"verdict": _verdict(answer)}


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
    return model.interface.about(s, (length, tilt, length * pace, tilt * pace), omega)


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
    thinnest, excess = h_min(model.face, s)[0], axial_excess(model, s, model.closing_force())
    # From faces that all but touch, or rough ones whose asperities are all but flat, upwards.
    closed = model.face[COLLAPSE] + 0.01 * model.face[FLOOR]
    low, reach = closed - thinnest, model.clearance
    high = max(low, 0.0)
    while excess(high) > 0 and high < 100 * reach:
        low, high = high, high + 0.25 * reach
    if excess(low) * excess(high) > 0:
        raise ValueError(f"no axial balance at a tilt of {abs(tilt):.4g} rad")
    return crossing(excess, low, high)


def _tilted(model, settings, speed) -> dict:
    if settings.tilt is not None:
        tilt, whirl, said = cmath.rect(settings.tilt, settings.tilt_direction), 0.0, "mean tilt given"
    else:
        tilt, whirl, said = steady_tilt(model)
    try:
        state = State(opened(model, tilt, whirl), tilt, whirl)
        return {**_listed(matrices(model, state)), "at": _at(model, state, speed), "said": said}
    except ValueError as reason:
        return {"stiffness": None, "damping": None, "at": None, "said": f"{said}: {reason}"}


def _at(model, state: State, speed) -> dict:
    return {
        "clearance": model.clearance,
        "axial_opening": state.dz,
        "tilt_x": state.tilt.real,
        "tilt_y": state.tilt.imag,
        "whirl": state.whirl,
        "h_min": float(h_min(model.face, gap_state(model, state, speed))[0]),
        "speed": float(speed),
    }


# --- sweeps --------------------------------------------------------------------------------------------


def _listed(found) -> dict:
    stiffness, damping = found
    return {"stiffness": stiffness.tolist(), "damping": damping.tolist()}


def _columns(name, values, rows) -> dict:
    """Matrices over a sweep; a point that cannot be is None."""
    return {
        name: [float(v) for v in values],
        "stiffness": [row.get("stiffness") for row in rows],
        "damping": [row.get("damping") for row in rows],
        "failed": [row.get("failed") for row in rows],
    }


def _speeds(settings, speed) -> np.ndarray:
    top = settings.speed_to if settings.speed_to is not None else 3 * abs(speed) or 3000.0
    return np.linspace(0.0, top, max(2, settings.points))


def _against_speed(model, settings, speed) -> dict:
    speeds = _speeds(settings, speed)
    return _columns("speed", speeds, [_listed(matrices(model, State(), w)) for w in speeds])


def against_frequency(model, settings, speed, frequencies=None) -> dict:
    """Of a film that stores: what a motion of another frequency (rad/s) meets; without `frequencies` those of the
    speeds."""
    frequencies = _speeds(settings, speed) if frequencies is None else frequencies
    return _columns("frequency", frequencies, [_listed(matrices(model, State(), omega=w)) for w in frequencies])


def table(model, speeds, frequencies) -> dict:
    """Columns of numbers, SI: shaft `speed` and `frequency` of the motion (rad/s), every pair of them, and there the
    aligned film's k_ROW_COLUMN and d_ROW_COLUMN for rows and columns of ORDER.  A film that does not store has the same
    at every frequency."""
    rows = []
    for speed in speeds:
        found = None
        for omega in frequencies:
            if found is None or model.interface.stores:
                found = np.concatenate([part.ravel() for part in matrices(model, State(), speed, omega)])
            rows.append([speed, omega, *found])
    names = [f"{letter}_{row}_{column}" for letter in "kd" for row in ORDER for column in ORDER]
    return dict(zip(("speed", "frequency", *names), np.array(rows).T.tolist(), strict=True))


def _against_clearance(scene, model, settings) -> dict:
    low = settings.clearance_from or 0.3 * model.clearance
    high = settings.clearance_to or 3 * model.clearance
    clearances, rows = np.geomspace(low, high, max(2, settings.points)), []
    for clearance in clearances:
        try:
            rows.append(_listed(matrices(Model(frozen_at_start(scene, clearance=float(clearance)), 1e-10), State())))
        except (SceneError, ValueError) as error:
            rows.append({"failed": str(error)})
    return _columns("clearance", clearances, rows)


def _against_tilt(model, settings) -> dict:
    """About a standing tilt up to nearly touching, the faces opening as they tilt."""
    crests = sum(wave.amplitude for wave in waves_of(model.scene))
    touch = min((h - crests) / r for r, h in model.aligned_gaps())
    tilts, rows, opening = np.linspace(0.0, 0.95 * touch, max(2, settings.points)), [], []
    for tilt in tilts:
        try:
            dz = opened(model, complex(tilt), 0.0)
            rows.append(_listed(matrices(model, State(dz, complex(tilt), 0.0))))
            opening.append(dz)
        except ValueError as error:
            rows.append({"failed": str(error)})
            opening.append(None)
    return {**_columns("tilt", tilts, rows), "axial_opening": opening}


def _hammer(answer) -> list[str]:
    """Where the damping of a film that stores is negative, which compressibility may do."""
    swept, said = answer.get("against_frequency"), []
    for name, k in (("axial", 0), ("tilt", 1)) if swept else ():
        negative = [w for w, d in zip(swept["frequency"], swept["damping"], strict=True) if d[k][k] < 0.0]
        if negative:
            share, ends = f"{len(negative)} of {len(swept['frequency'])}", frequencies(negative[0], negative[-1])
            where = f"{share} frequencies, {ends}"
            said.append(f"The film's {name} damping is negative (pneumatic hammer) at {where}.")
    return said


def _table_error(answer) -> list[str]:
    """What a table of slow motion says wrongly of motion at the shaft's frequency, of a film that stores."""
    fast = answer.get("synchronous")
    if not fast:
        return []
    ratio = {
        (name, k): fast[name][k][k] / slow if (slow := answer[name][k][k]) else math.nan
        for name in ("stiffness", "damping")
        for k in (0, 1)
    }
    axial, tilt = ([ratio[name, k] for name in ("stiffness", "damping")] for k in (0, 1))
    return [f"Motion at the shaft's frequency meets {axial[0]:.4g} times the axial stiffness of slow motion and "
            f"{axial[1]:.4g} times its damping, {tilt[0]:.4g} and {tilt[1]:.4g} times in tilt: so far off is a table "
            "of slow motion."]  # fmt: skip


def _verdict(answer) -> list[str]:
    k, d, at, tilted = np.array(answer["stiffness"]), np.array(answer["damping"]), answer["at"], answer["tilted"]
    pace = d[1, 1] * at["speed"]
    ratio = f", {k[1, 2] / pace:.4g} of the shaft speed times the damping (half, for a wedge film)" if pace else ""
    said = [
        f"Aligned at {at['clearance'] * 1e6:.4g} um, {speed_words(at['speed'])}, {answer['film']} film: axial "
        f"{k[0, 0]:.5g} N/m and {d[0, 0]:.5g} N s/m; tilt {k[1, 1]:.5g} N m/rad and {d[1, 1]:.5g} N m s/rad.",
        f"Cross stiffness {k[1, 2]:.5g} N m/rad{ratio}.",
    ]
    said += _table_error(answer) + _hammer(answer)
    if tilted["stiffness"] is None:
        return [*said, f"Tilted: {tilted['said']}."]
    t, where = np.array(tilted["stiffness"]), tilted["at"]
    size, opening = math.hypot(where["tilt_x"], where["tilt_y"]) * 1e6, where["axial_opening"] * 1e6
    return [
        *said,
        f"Tilted by {size:.4g} urad ({tilted['said']}) the seal opens by {opening:.3g} um; tilt stiffness "
        f"{t[1, 1]:.5g} and {t[2, 2]:.5g} N m/rad, axial to tilt {np.abs(t[0, 1:]).max():.3g} N/rad.",
    ]
