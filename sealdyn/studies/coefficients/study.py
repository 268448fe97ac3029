"""Stiffness and damping of the film and of asperities that touch, 3 x 3 on (dz, tilt about x, tilt about y): aligned,
tilted, over speed and clearance."""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from ...dynamics.model import Model
from ...faces.film_thickness import h_min
from ...scenario.settings import values_in_si
from ...scene.scene import SceneError
from ...scene.variants import frozen_at_start
from ...scene.waviness import waves_of
from ...simulation.film_error import steady_tilt
from ...units import Angle, Length, Speed
from .._words import HERTZ, RPM, frequencies
from .._words import speed as speed_words
from .matrices import ORDER, State, gap_state, matrices, opened
from .table import columns, lines, mapped

WITH_WAVES = True
ACCURACY = 1e-10
STIFFNESS_UNITS = [["N/m", "N/rad", "N/rad"], ["N", "N*m/rad", "N*m/rad"], ["N", "N*m/rad", "N*m/rad"]]
DAMPING_UNITS = [[u.replace("/m", "*s/m").replace("/rad", "*s/rad") if "/" in u else u + "*s" for u in row]
                 for row in STIFFNESS_UNITS]  # fmt: skip
ALONG = {f"against_{name}": (name,) for name in ("speed", "clearance", "tilt", "frequency")}
ALONG |= {"map": ("speed", "frequency", "coning"), "table": ("row",)}
units = {
    "speed": "rad/s",
    "frequency": "rad/s",
    "coning": "rad",
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
TIMED = ("fmr_reference", 2)


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
    for a rotordynamics code, over speed, frequency and coning."""
    speed: str | float | None = None
    """Shaft speeds of that table, "500:2000 rad/s:7" or a list, each at the clearance that follows there."""
    coning: str | float | None = None
    """Conings of that table, "0:6 mrad:13" or a list."""


def run(scenario, settings, tools) -> dict:
    """Matrices aligned and tilted, and sweeps."""
    scene = frozen_at_start(scenario.scene)
    model, speed = Model(scene, ACCURACY), scene.shaft.speed
    answer = {
        "order": list(ORDER),
        "film": model.interface.name,
        **_listed(matrices(model, State())),
        "stiffness_units": STIFFNESS_UNITS,
        "damping_units": DAMPING_UNITS,
        "at": _at(model, State(), speed),
        "stator_speed": scene.stator.speed,
        "asperities": scene.contact is not None,
        "tilted": _tilted(model, settings, speed),
        "against_speed": _against_speed(model, settings, speed),
        "against_clearance": _against_clearance(scene, model, settings),
        "against_tilt": _against_tilt(model, settings),
    }
    asked = {name: None if given is None else values_in_si(scenario, str(given), unit, f"--{name}")
             for name, given, unit in (("frequency", settings.frequency, "rad/s"), ("speed", settings.speed, "rad/s"),
                                       ("coning", settings.coning, "rad"))}  # fmt: skip
    motion = asked["frequency"]
    if model.interface.stores:
        answer["against_frequency"] = against_frequency(model, settings, speed, motion)
        answer["synchronous"] = _listed(matrices(model, State(), omega=abs(speed))) if speed else None
    if any(values is not None for values in asked.values()):
        # Speeds that nobody asked go with frequencies only.
        speeds = asked["speed"] or ([speed] if motion is None else _speeds(settings, speed))
        answer["map"] = mapped(scene, ACCURACY, speeds, motion or [0.0], asked["coning"])
        answer["table"] = columns(answer["map"])
    return answer | {"verdict": _verdict(answer)}


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


def against_frequency(model, settings, speed, motion=None) -> dict:
    """Of a film that stores: what a motion of another frequency (rad/s) meets; without `motion` those of the
    speeds."""
    motion = _speeds(settings, speed) if motion is None else motion
    return _columns("frequency", motion, [_listed(matrices(model, State(), omega=w)) for w in motion])


def _against_clearance(scene, model, settings) -> dict:
    low = settings.clearance_from or 0.3 * model.clearance
    high = settings.clearance_to or 3 * model.clearance
    clearances, rows = np.geomspace(low, high, max(2, settings.points)), []
    for clearance in clearances:
        try:
            rows.append(_listed(matrices(Model(frozen_at_start(scene, clearance=float(clearance)), ACCURACY), State())))
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


def tables(answer) -> list:
    """The map, point by point."""
    heads = (("coning, mrad", "coning", 1e3), ("speed, rpm", "speed", RPM), ("frequency, Hz", "frequency", HERTZ),
             ("clearance, um", "clearance", 1e6), ("axial k, N/m", "k_axial_axial"), ("d, N s/m", "d_axial_axial"),
             ("tilt k, N m/rad", "k_tilt_x_tilt_x"), ("cross k, N m/rad", "k_tilt_x_tilt_y"),
             ("d, N m s/rad", "d_tilt_x_tilt_x"))  # fmt: skip
    return [(lines(answer["map"]), heads if "coning" in answer["map"] else heads[1:])] if "map" in answer else []


def _coning(answer) -> list[str]:
    """How clearance and tilt stiffness follow the coning, at the first speed and frequency of the map."""
    found = answer.get("map", {})
    if len(found.get("coning", ())) < 2:
        return []
    known = [(v, c, k[1][1]) for v, c, k in zip(found["coning"], found["clearance"][0][0], found["stiffness"][0][0],
                                                strict=True) if c is not None]  # fmt: skip
    if not known:
        return ["No coning asked leaves a film."]
    (low, first, _), (high, last, _) = known[0], known[-1]
    at, _, stiffest = max(known, key=lambda point: point[2])
    lost = len(found["coning"]) - len(known)
    why = found["failed"][0]["reason"] if found["failed"] else ""
    stays = abs(last - first) < 1e-6 * first
    course = f"stays at {1e6 * first:.4g} um" if stays else f"goes from {1e6 * first:.4g} to {1e6 * last:.4g} um"
    return [f"Over a coning of {1e3 * low:.4g} to {1e3 * high:.4g} mrad the clearance {course}; the tilt stiffness is "
            f"largest at {1e3 * at:.4g} mrad, {stiffest:.5g} N m/rad."
            + (f"  At {lost} of the conings there is no film: {why}" if lost else "")]  # fmt: skip


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
    # A wedge film turns with the mean of both faces.
    wedge = 0.5 * (1.0 + answer["stator_speed"] / at["speed"]) if at["speed"] else 0.0
    ratio = (
        f", {k[1, 2] / pace:.4g} of the shaft speed times the damping ({wedge:.4g} for a wedge film)" if pace else ""
    )
    film = f"{answer['film']} film" + (" with asperities" if answer["asperities"] else "")
    said = [
        f"Aligned at {at['clearance'] * 1e6:.4g} um, {speed_words(at['speed'])}, {film}: axial "
        f"{k[0, 0]:.5g} N/m and {d[0, 0]:.5g} N s/m; tilt {k[1, 1]:.5g} N m/rad and {d[1, 1]:.5g} N m s/rad.",
        f"Cross stiffness {k[1, 2]:.5g} N m/rad{ratio}.",
    ]
    said += _coning(answer) + _table_error(answer) + _hammer(answer)
    if tilted["stiffness"] is None:
        return [*said, f"Tilted: {tilted['said']}."]
    t, where = np.array(tilted["stiffness"]), tilted["at"]
    size, opening = math.hypot(where["tilt_x"], where["tilt_y"]) * 1e6, where["axial_opening"] * 1e6
    return [
        *said,
        f"Tilted by {size:.4g} urad ({tilted['said']}) the seal opens by {opening:.3g} um; tilt stiffness "
        f"{t[1, 1]:.5g} and {t[2, 2]:.5g} N m/rad, axial to tilt {np.abs(t[0, 1:]).max():.3g} N/rad.",
    ]
