"""Stiffness and damping of the aligned film over shaft speed, frequency and coning, for a rotordynamics code."""

import numpy as np

from ...dynamics.model import Model
from ...scene.scene import SceneError
from ...scene.variants import with_values
from .matrices import ORDER, State, matrices

NAMES = [f"{letter}_{row}_{column}" for letter in "kd" for row in ORDER for column in ORDER]


def mapped(scene, accuracy: float, speeds, frequencies, conings=None) -> dict:
    """{speed, frequency (rad/s), coning (rad, if asked)} and, over these in this order, `clearance` (m), `stiffness`
    and `damping` (3, 3) of the aligned film; `failed` the reasons of points that cannot be, whose numbers are None.

    `scene` constant in time.  At every speed and coning it is the scene with these: a clearance that is given stays,
    one that the closing force decides follows.  A film that does not store has the same at every frequency.
    """
    shape = (len(speeds), len(frequencies), 1 if conings is None else len(conings))
    clearance, failed = np.full(shape, None), {}
    both = {name: np.full(shape, None) for name in ("stiffness", "damping")}
    for a, speed in enumerate(speeds):
        for c, coning in enumerate([None] if conings is None else conings):
            values = {"shaft.speed": float(speed)} | ({} if coning is None else {"film.coning": float(coning)})
            try:
                model, found = Model(with_values(scene, values), accuracy), None
                for b, omega in enumerate(frequencies):
                    if found is None or model.interface.stores:
                        found = [part.tolist() for part in matrices(model, State(), omega=omega)]
                    clearance[a, b, c], both["stiffness"][a, b, c], both["damping"][a, b, c] = model.clearance, *found
            except (SceneError, ValueError) as error:
                failed.setdefault(str(error), []).append({"speed": float(speed), "coning": coning})
    answer = {"speed": [float(w) for w in speeds], "frequency": [float(w) for w in frequencies]}
    if conings is not None:
        answer["coning"] = [float(v) for v in conings]
    flat = {"clearance": clearance, **both}
    for name, values in flat.items():
        nothing = None if name == "clearance" else [[None] * 3] * 3
        listed = [[[nothing if v is None else v for v in row] for row in plane] for plane in values]
        answer[name] = listed if conings is not None else [[row[0] for row in plane] for plane in listed]
    return answer | {"failed": [{"reason": reason, "points": points} for reason, points in failed.items()]}


def columns(found: dict) -> dict:
    """The same as columns of numbers, SI: every `speed`, `frequency` (rad/s) and, if asked, `coning` (rad) with its
    `clearance` (m), and k_ROW_COLUMN and d_ROW_COLUMN for rows and columns of ORDER."""
    axes = [name for name in ("speed", "frequency", "coning") if name in found]
    grid = np.meshgrid(*(found[name] for name in axes), indexing="ij")
    table = {name: values.ravel().tolist() for name, values in zip(axes, grid, strict=True)}
    parts = [np.array(found[name], dtype=object).reshape(-1, 9) for name in ("stiffness", "damping")]
    if "coning" in found:
        table["clearance"] = np.array(found["clearance"], dtype=object).ravel().tolist()
    return table | dict(zip(NAMES, np.hstack(parts).T.tolist(), strict=True))


def lines(found: dict) -> list[dict]:
    """A line for every point: what is printed."""
    table = columns(found)
    clearance = np.array(found["clearance"], dtype=object).ravel().tolist()
    points = [dict(zip(table, values, strict=True)) for values in zip(*table.values(), strict=True)]
    return [line | {"clearance": c} for line, c in zip(points, clearance, strict=True)]
