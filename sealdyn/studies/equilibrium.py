"""Equilibria: every clearance at which the film carries the closing force, with stiffness and stability."""

import math
from dataclasses import dataclass

import numpy as np

from ..dynamics.equilibrium import (
    ClosingForce,
    equilibria,
    extent,
    film_stiffness,
    settle,
    support_stiffness,
)
from ..dynamics.intervals import spins
from ..films import film_of
from ..numerics.piecewise_linear import initially
from ..scene.scene import SceneError
from ..scene.variants import frozen_at_start
from ..units import Length

WITH_WAVES = True
units = {"curve/clearance": "m", "curve/opening_force": "N", "curve/stiffness": "N/m"}


@dataclass(frozen=True)
class Settings:
    """Clearances from `clearance_from` to `clearance_to` (default: a range that shows every equilibrium), `points`
    of the curve of opening force."""

    clearance_from: Length | None = None
    clearance_to: Length | None = None
    points: int = 241


def run(scenario, settings, tools) -> dict:
    """All equilibria in the range, the opening force over clearance and the closing force."""
    scene = frozen_at_start(scenario.scene)
    film, opening = scene.film, film_of(scene).opening_law(scene.film, *spins(scene))
    inner, outer = film.inner_pressure, film.outer_pressure
    law, said = closing_force(scene, opening)
    closing = law.at(inner, outer, initially(law.spring))
    roots = equilibria(film, opening, closing, inner, outer)
    low, high = _range(film, roots, settings)
    roots = [root for root in roots if low <= root.clearance <= high]
    clearance = np.geomspace(low, high, max(3, settings.points))
    force = np.array([opening(c, inner, outer) for c in clearance])
    # Steps smaller than the distance to closed faces.
    steps = 1e-4 * (clearance - extent(film)[1])
    stiffness = np.array(
        [film_stiffness(opening, c, inner, outer, step) for c, step in zip(clearance, steps, strict=True)]
    )
    support = support_stiffness(scene)
    answer = {
        "roots": [{**vars(root), "stable": bool(root.stable)} for root in roots],
        "closing_force": float(closing),
        "balance_ratio": float(law.balance_ratio),
        "spring_force": float(initially(law.spring)),
        "closing_said": said,
        "support_stiffness": support,
        "range": [float(low), float(high)],
        "curve": {
            "clearance": clearance.tolist(),
            "opening_force": force.tolist(),
            "stiffness": stiffness.tolist(),
        },
    }
    return answer | {"verdict": _verdict(answer)}


def closing_force(scene, opening) -> tuple[ClosingForce, str]:
    """The closing force and a sentence; unlike `settle`, also of a scene without a stable equilibrium."""
    if scene.film.clearance is not None:
        _, law, _, said = settle(scene, opening)
        return law, said
    film, closing = scene.film, scene.closing
    if closing.balance_ratio is None or closing.spring_force is None:
        raise SceneError("film.clearance", "nothing", "a length, or both balance_ratio and spring_force")
    area = math.pi * (film.outer_radius**2 - film.inner_radius**2)
    law = ClosingForce(area, closing.balance_ratio, closing.spring_force, film.outer_pressure >= film.inner_pressure)
    return law, "closing force from balance ratio and spring"


def _range(film, roots, settings) -> tuple[float, float]:
    """Clearances to look at, (m): a decade around what was found, open faces only."""
    rise, least = extent(film)
    found = [root.clearance for root in roots] or [film.clearance or max(rise, 1e-6)]
    least *= 1 + 1e-6
    low = settings.clearance_from if settings.clearance_from is not None else min(found) / 10
    high = settings.clearance_to if settings.clearance_to is not None else max(found) * 10
    low = max(low, least + 0.01 * max(found))
    if not low < high:
        wanted = f"clearances above {least:.4g} m, where the faces are open"
        raise SceneError("study.equilibrium.clearance_to", f"{high:.4g} m", wanted)
    return float(low), float(high)


def tables(answer) -> list:
    """Every clearance of balance."""
    columns = (("clearance, um", "clearance", 1e6), ("film stiffness, N/m", "stiffness"), ("stable", "stable"))
    return [(answer["roots"], columns)]


def _verdict(answer) -> list[str]:
    (low, high), roots, support = answer["range"], answer["roots"], answer["support_stiffness"]
    stable = [f"{1e6 * root['clearance']:.6g} um" for root in roots if root["stable"]]
    said = [
        f"Film and closing force balance at {len(roots)} clearance(s) from {1e6 * low:.4g} to {1e6 * high:.4g} um; "
        f"stable: {', '.join(stable) or 'none'}.",
        f"Closing force {answer['closing_force']:.6g} N (balance ratio {answer['balance_ratio']:.5g}, spring "
        f"{answer['spring_force']:.4g} N; {answer['closing_said']}).",
    ]
    if not roots:
        curve = answer["curve"]["opening_force"]
        said.append(f"The film carries {min(curve):.5g} to {max(curve):.5g} N there: never the closing force.")
    elif len(stable) > 1:
        said.append("Several stable clearances: the start of a run decides which one the seal takes.")
    elif any(not root["stable"] and root["stiffness"] + support > 0 for root in roots):
        said.append(f"The support's {support:.3g} N/m would hold an unstable one.")
    return said
