"""Exhibits: files by subject, of places where a method fails, shown in the order of their items.

What every file offers (the contract): `EXHIBITS` {name: (item, shows, meets)}:

`item`       int; exhibits of one number belong to one place where methods fail.
`shows`      functions without arguments, each of a list of rows, made by running the failing method and the survivor on
             a small scene of the reference seal (Green, 1989); at most some seconds.  A row is a dict: `item`, `title`,
             `failing` and `survivor` (what each is), `failing_error` and `survivor_error` (numbers in `unit`; None: no
             answer at all), `unit`, and `default`, a sentence on what the program does by itself.
`meets(scene, run)`  what of a scene and its run (RunState, made ready) leads to this place, in words, or empty.

An exhibit may use a bare library method: the naive use of it is what fails.
"""

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


def row(item: int, title: str, failing: tuple, survivor: tuple, unit: str, default: str) -> list[dict]:
    """One row, in a list, from (what it is, number or None) of the failing method and of the survivor."""
    found = {"item": item, "title": title}
    for name, (words, error) in (("failing", failing), ("survivor", survivor)):
        found |= {name: words, f"{name}_error": None if error is None else float(error)}
    return [found | {"unit": unit, "default": default}]


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
