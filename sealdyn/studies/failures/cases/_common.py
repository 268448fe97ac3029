"""What exhibits share: rows, and runs of small scenes in memory."""

from ....closed_form.zuk_1972 import CRUISE
from ....dynamics.model import Model
from ....dynamics.run_state import RunState
from ....scene.film import Coefficients, Film
from ....solvers.contract import Recorder
from ....solvers.integrate import solve

# A film that does nothing, so that a ring's own motion is known exactly.
ZERO_FILM = Coefficients(tilt_stiffness=0.0, tilt_damping=0.0, axial_stiffness=0.0, axial_damping=0.0)


def cruise_dam(**faces) -> Film:
    """Zuk's dam at cruise as a film table; `faces`: its clearance (m) and coning (rad), as far as they are given."""
    return Film(
        model="gas_dam",
        gas="air",
        temperature=CRUISE.temperature,
        inner_radius=CRUISE.inner_radius,
        outer_radius=CRUISE.outer_radius,
        inner_pressure=CRUISE.high_pressure,
        outer_pressure=CRUISE.low_pressure,
        **faces,
    )


def row(item: int, title: str, failing: tuple, survivor: tuple, unit: str, default: str) -> dict:
    """A row from (what it is, number or None) of the failing method and of the survivor."""
    return {
        "item": item,
        "title": title,
        "failing": failing[0],
        "failing_error": None if failing[1] is None else float(failing[1]),
        "survivor": survivor[0],
        "survivor_error": None if survivor[1] is None else float(survivor[1]),
        "unit": unit,
        "default": default,
    }


def run_from(scene, duration: float, accuracy: float, **start) -> RunState:
    """A run whose unknowns named in `start` (as in Unknowns.names, or with `_rate`) begin there."""
    run = RunState(Model(scene, accuracy), duration)
    for name, value in start.items():
        place = run.model.unknowns.names.index(name.removesuffix("_rate"))
        run.y0[run.model.unknowns.rate_places[place] if name.endswith("_rate") else place] = value
    return run


def integrated(run, method: str, accuracy: float, interval: float | None = None):
    """Outcome and recorder of a run by one method."""
    recorder = Recorder(interval)
    return solve(run, method, accuracy, recorder), recorder
