"""How many cells a film needs: doubled until the balance of the aligned seal hardly changes.

**Source** Richardson (1911): what doubling changes, over 2^p - 1, is the error of a method of order p; here half of the
change is, since fronts of cavities are of lower order than the rest.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..faces.geometry import CONTACT_FORCE, CONTACT_TORQUE, FLOW_INNER, FORCE, TORQUE

# Grids that are tried, coarsest first, each with twice the cells of the one before.
MOST_DOUBLINGS = 4
# Share of a change that counts as the error of the finer grid.
CHANGED = 0.5
# Coefficient of friction that is rounding: a standing shaft has none, and its logarithm would never settle.
NOTHING = 1e-9
# What is searched so often need not be searched again; the scenes of a study.
REMEMBERED = 64


class Asked:
    """A scene as what a search may be remembered by."""

    def __init__(self, scene, film):
        self.scene, self.film, self.words = scene, film, f"{film.name} {scene!r}"

    def __eq__(self, other):
        return self.words == other.words

    def __hash__(self):
        return hash(self.words)


def with_cells(scene, film):
    """The `Film` table of a scene with enough cells for what `film` is asked for; cells that are given stay.
    Raises SceneError where the seal has no balance."""
    table = film.prepared(scene)
    return table if film.cells_are_given(scene.film) else _searched(Asked(scene, film))


@lru_cache(maxsize=REMEMBERED)
def _searched(asked):
    scene, film = asked.scene, asked.film
    wanted, before = film.grid_accuracy(film.prepared(scene)), None
    for doubling in range(MOST_DOUBLINGS):
        table = film.doubled(film.prepared(scene), doubling)
        loads = _balance(replace(scene, film=table))
        if before is not None and CHANGED * float(np.max(np.abs(loads - before))) <= wanted:
            break
        before = loads
    return table


def _balance(scene) -> np.ndarray:
    """What film and asperities carry, leak and rub where the aligned seal rests, with what is carried at the clearance
    of that; each over the scale of its own."""
    from .interface import Interface, flow_at_rest, rest_state

    interface = Interface(scene, 1e-8)
    s, _ = rest_state(scene, interface.clearance)
    flow_at_rest(interface, s)
    load = max(abs(s[FORCE] + s[CONTACT_FORCE]), 1e-300)
    return np.array([
        s[FORCE] / load,
        np.log(max(abs(s[FLOW_INNER]), 1e-300)),
        np.log(max(abs(s[TORQUE] + s[CONTACT_TORQUE]), NOTHING * load * scene.film.outer_radius)),
        np.log(interface.clearance),
    ])  # fmt: skip
