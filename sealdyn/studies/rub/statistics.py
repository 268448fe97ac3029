"""What can be said of a motion beyond its horizon: averages by two methods that share neither integrator nor
differencing, and how two correct runs part.

Methods: Adams (CVODE) with two trajectories; DOP853 with tangents differenced across the right-hand side.
"""

import time as clock

import numpy as np

from ...analysis.continuation import FilmCollapsed, frozen_at_end, neighbours
from ...analysis.poincare_map import SAMPLES, PeriodMap, share_below
from ...numerics import time_series
from ...numerics.time_series import tangent_product
from ...scene.contact import contact_thresholds
from ...scene.variants import with_values
from ...status import Status

# Separation that makes a forecast worthless, in units of the attractor's spread; the tighter of two correct runs.
LOST, TIGHTER = 0.3, 100.0


def evaluate_point(scene, point: dict) -> dict:
    """Exponent and averages at one point by one method; "both": how two correct runs part."""
    scene, x = with_values(frozen_at_end(scene), {point["key"]: point["value"]}), np.array(point["start"])
    if point["method"] == "both":
        return divergence(scene, x, point)
    begun, turns = clock.perf_counter(), point["turns"]
    stroboscope = PeriodMap(scene, point["accuracy"], point["method"])
    if point["method"] == "adams":
        seen = stroboscope.run(x, turns)
        if seen.status != Status.OK:
            raise FilmCollapsed(seen.message)
        exponent = neighbours(scene, x, turns, point["accuracy"], "adams")
        series = {"h_min": seen.lowest, "section": seen.section, "force": seen.contact_force, "share": seen.touching}
    else:
        samples: list = []
        exponent = tangent_product(lambda x, q: stroboscope.tangents(x, q, samples), x, turns, directions=2)
        kept = [np.concatenate(parts) for parts in zip(*samples, strict=True)]
        times = stroboscope.period * np.tile(np.arange(SAMPLES) / SAMPLES, len(kept[0]) // SAMPLES)
        seen = stroboscope.looked_at(times, *kept)
        series = {"h_min": seen["lowest"], "section": seen["section"], "force": seen["contact_force"],
                  "share": share_below(seen["h_min"], touch_level(scene))}  # fmt: skip
    return {
        "averages": averages(series, exponent, stroboscope.period),
        "floors": noise_floors(stroboscope),
        "spectrum": exponent.spectrum.tolist(),
        "wall_time": (clock.perf_counter() - begun) / turns,
    }


def averages(series, exponent, period) -> dict:
    """What must not depend on the method: exponent, film, section, share of contact, impulse per period."""
    x, y = series["section"].real, series["section"].imag
    return {
        "exponent": {"value": exponent.value, "uncertainty": exponent.uncertainty},
        **time_series.statistics(series["h_min"], "h_min"),
        "section_x_mean": time_series.average(x),
        "section_y_mean": time_series.average(y),
        "section_x_std": time_series.average(x, np.std),
        "section_y_std": time_series.average(y, np.std),
        "contact_share": time_series.average(series["share"]),
        "impulse": time_series.average(series["force"].mean(axis=1) * period),
    }


def noise_floors(stroboscope) -> dict:
    """What a run of finite accuracy and sampling cannot tell apart even on a periodic motion."""
    model, error = stroboscope.model, 100 * stroboscope.accuracy
    film, tilt = error * model.clearance, error * model.clearance / model.face[1]
    return (
        {f"h_min_{n}": film for n in ("mean", "std", "median", "q05", "q95")}
        | {f"section_{n}": tilt for n in ("x_mean", "y_mean", "x_std", "y_std")}
        | {"contact_share": 1e-3, "impulse": error * model.closing_force() * stroboscope.period, "exponent": 1e-3}
    )


def divergence(scene, x, point) -> dict:
    """Two correct runs from one start, one a hundred times tighter: how far apart (in units of clearance over outer
    radius) each turn, and after how many they have nothing in common."""
    runs = [PeriodMap(scene, point["accuracy"] / f, "adams") for f in (1.0, TIGHTER)]
    sections = [s.run(x, min(point["turns"], 200)).section for s in runs]
    scale = runs[0].model.clearance / runs[0].model.face[1]
    m = min(map(len, sections))
    apart = np.abs(sections[0][:m] - sections[1][:m]) / scale
    spread = time_series.spread(sections[1]) / scale
    beyond = np.flatnonzero(apart > LOST * spread) if spread > 100 * point["accuracy"] else []
    return {"apart": apart.tolist(), "spread": spread, "lost": int(beyond[0]) if len(beyond) else None,
            "accuracies": [point["accuracy"], point["accuracy"] / TIGHTER]}  # fmt: skip


def touch_level(scene) -> float:
    """Film thickness (m) at which the asperities meet."""
    return contact_thresholds(scene.contact)[1]
