"""Where the whirl of an unforced seal settles above its threshold, contact included: limit cycle, rub, collapse."""

import math

import numpy as np

from ...status import Status
from ..poincare_map import PIECE, PeriodMap
from .rotating_wave import RotatingWave, contact_tilt_aligned, free_model, least_damped

# Start as a share of the tilt of contact; amplitudes that change less from piece to piece have settled.
SMALL, STEADY = 0.02, 1e-3


def settles(scene, speed: float, accuracy: float = 1e-6, most: int = 3000) -> dict:
    """Fate of a small whirl at a shaft speed (rad/s): "decays", "limit cycle" (no touch), "rub", "collapse", "failed",
    or "unsettled" after `most` turns.

    Returns `speed`, `fate` (`message` if the run ended early), `from` (rad) it starts, `first_contact` and `turns`
    (turns of the shaft), `amplitudes` (largest relative tilt of each turn, rad), and over the last turns `amplitude`
    (least and largest relative tilt, rad), `whirl_ratio`, `contact_share` of the time, `contact_force` over the closing
    force, `contact_power` and `friction_power` (W), `h_min` (m).
    """
    model = free_model(scene, speed)
    unit, wave = contact_tilt_aligned(model), RotatingWave(model)
    frequency, shape = least_damped(model, speed)
    period_map = PeriodMap(model.scene, accuracy)
    x = wave.state(SMALL * unit * shape, frequency)[: period_map.size]
    row = {"speed": float(speed), "fate": "unsettled", "first_contact": None, "from": SMALL * unit}
    done, before, sizes = 0, None, []
    while done < most:
        turns = period_map.run(x, PIECE)
        x, size = turns.last, np.abs(turns.tilt)
        if len(size):
            sizes += np.max(size, axis=1).tolist()
        touched = np.flatnonzero(turns.touching > 0)
        if row["first_contact"] is None and len(touched):
            row["first_contact"] = int(done + touched[0])
        done += len(turns.section)
        if turns.status != Status.OK:
            row["fate"], row["message"] = (
                "collapse" if turns.status == Status.COLLAPSED else turns.status,
                turns.message,
            )
            break
        # The late half of a piece, so that one piece can settle.
        late = size[len(size) // 2 :]
        now = np.array([late.min(), late.max(), late.mean()])
        if now[1] < 0.2 * SMALL * unit:
            row["fate"] = "decays"
            break
        if before is not None and np.all(np.abs(now - before) < STEADY * now[1]):
            row["fate"] = "rub" if turns.touching[-PIECE // 2 :].any() else "limit cycle"
            break
        before = now
    # A chaotic or modulated rub never repeats: it has settled if it neither left nor died.
    if row["fate"] == "unsettled" and turns.touching.any():
        row["fate"] = "rub"
    return row | {"turns": done, "amplitudes": sizes} | _late(turns, period_map, speed)


def _late(turns, period_map, speed) -> dict:
    """Averages over the late half of the last piece."""
    half = slice(len(turns.section) // 2, None)
    tilt = turns.tilt[half].ravel()
    if len(tilt) < 4:
        return {}
    angle = np.unwrap(np.angle(tilt))
    per_sample = np.polyfit(np.arange(len(angle)), angle, 1)[0] * turns.tilt.shape[1] / (2 * math.pi)
    return {
        "amplitude": [float(np.abs(tilt).min()), float(np.abs(tilt).max())],
        "whirl_ratio": float(per_sample / period_map.turns_per_period * np.sign(speed)),
        "contact_share": float(turns.touching[half].mean()),
        "contact_force": float(turns.contact_force[half].mean() / period_map.model.closing_force()),
        "contact_power": float(turns.contact_power[half].mean()),
        "friction_power": float(turns.friction_power[half].mean()),
        "h_min": float(turns.lowest[half].min()),
    }
