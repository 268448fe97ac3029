"""What a film is: the contract between the fluid between the faces and all that asks it.

A film's file ends in `FILM = Film(...)`; a field that it leaves out is None and absent.  A film never asks which ring
floats, and imports no other film.  Its arrays, in every function below:

    f      (n,) float64, the film's block: what `parameters` returned, its leading slots the faces (faces/geometry.py)
    s      (GAP_STATE_SIZE,) float64, a gap state, slots named in faces/geometry.py: gap and rates, spins, pressures,
           viscosity are read; force, moments, flows, torque are written
    x      (n,) float64, the film's own unknowns, of a film that has some
    table  a `Film` table of a scene (scene/film.py: what a scenario says under [film])

Kernels are compiled functions of the module (numerics/kernel.py: `value_kernel` where so marked, since their address is
handed to other kernels), so that they are kept on disk.  A film that has no solution at some gaps writes NaN as its
force, and into REFUSED (faces/geometry.py) a code of its `status`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..faces.geometry import CLEARANCE, FLOOR, FORCE, INNER_PRESSURE, OUTER_PRESSURE
from ..quantities import everyday

if TYPE_CHECKING:
    # Sparse matrices are loaded for a film with unknowns only.
    from scipy.sparse import csc_array


class Offer(NamedTuple):
    """What is asked of a film before it is chosen.  A film that is a folder has its `OFFER` in `__init__.py`, so that
    the kernels of films that are not chosen are neither loaded nor compiled; of one that is a file it is read from its
    FILM.  Fields as of `Film`."""

    name: str
    fidelity: int
    fluids: tuple[str, ...] = ("liquid",)
    only_on_request: bool = False
    generalises: str | None = None


class Field(NamedTuple):
    """A quantity over the face: name, SI unit, what it is, and (unit, factor) that people read it in."""

    name: str
    unit: str
    long_name: str
    shown: tuple[str, float]


PRESSURE = Field("pressure", "Pa", "film pressure, absolute", everyday("Pa"))
FILL = Field("fill", "1", "share of the film that is liquid", everyday("share"))


@dataclass(frozen=True, eq=False)
class FilmUnknowns:
    """Unknowns `x` (n,) of a film.

    `names`; `scales` (n,) in their units; `differential` (n,) bool, true where the residual's row of that unknown has
    its rate in it, false where unknown and row are algebraic; `pattern` (n, n) of the residual's derivative by x and
    by x's rate together, a CSC array whose values do not matter; `around`: how many angles of the whole circle, and how
    many cells of each, the unknowns of one kind are (angle by angle, one kind after the other), None without any.
    """

    names: tuple
    scales: np.ndarray
    differential: np.ndarray
    pattern: csc_array
    around: tuple[int, int] | None = None

    @cached_property
    def colours(self) -> np.ndarray:
        """Colour (n,), from 0 on, of each column: those of one colour share no row, and one difference serves them.
        **Source** Curtis, Powell & Reid (1974), IMA J. Appl. Math. 13, 117-119."""
        indptr, indices = self.pattern.indptr, self.pattern.indices
        colours, taken = np.empty(len(self.names), dtype=np.int64), []
        for column in range(len(self.names)):
            rows = indices[indptr[column] : indptr[column + 1]]
            colour = next((i for i, used in enumerate(taken) if not used[rows].any()), len(taken))
            if colour == len(taken):
                taken.append(np.zeros(len(self.names), dtype=bool))
            taken[colour][rows], colours[column] = True, colour
        return colours


@dataclass(frozen=True, eq=False, kw_only=True)
class Film:
    """A film, fidelity level by fidelity level (see the arrays above).

    What is asked before it is chosen (of a folder by `OFFER` of its `__init__.py`):

    `name`             as `film.model` of a scenario has it: the name of the file or folder.
    `fidelity`         fidelity level (1 linear, 2 radial, 3 gas with storage, 4 cells with cavities); "auto" takes the
                       highest.
    `fluids`           "liquid" and "gas", those of them that it takes.
    `only_on_request`  whether scenes have to ask for it by name.
    `generalises`      name of a film that this one is once more, between faces which that one takes too: where both
                       can serve, only that one is offered.

    What every film has:

    `accepts(table, waves)`
        "" if it can take the faces of a table (None: plain cones) with these waves (Waviness of both rings), else what
        it can take, as words that go after the film's name.
    `parameters(table, clearance, error)`
        its block `f`, for the design clearance (m); `error` is the relative error allowed to its quadrature.
    `opening_law(table, mean_spin, spin_difference)`
        function `force(clearance, inner_pressure, outer_pressure, floor)`: opening force (N) of the aligned film, for
        the equilibrium; clearance and `floor` of the film thickness in m (without it the film's own), pressures
        absolute in Pa; the spins (rad/s, 0 without them) matter to a fluid with inertia.
    `wrench(f, s)`     value kernel: force (N) and moments (N m) on the stator, into `s`.
    `flow(f, s)`       value kernel: as `wrench`, and also leakage (m^3/s, in +r, at both radii; of a gas at normal
                       conditions) and friction torque (N m) on the rotor, into `s`.

    What it may have:

    `remark`           a sentence that every run with it says.
    `status`           {code: sentence} of what it refuses.
    `floored`          import path of the module whose FILM is this film for tables with a floor of the pressure; a
                       path, so that what it compiles is not loaded without one.
    `rough`            the Film that is this film between rough faces, which may meet.
    `patterned`        import path of the module whose FILM is this film between faces of which one has grooves.
    `matrices(f, s)`   stiffness (N/m) and damping (N s/m), each (3, 3), on (dz, g_x, g_y) at a gap state; without it
                       they are differences of the force.
    `constant`         whether its stiffness and damping are given numbers, whatever the gap: no law of a film, so that
                       no other film is asked what it leaves out, and motion on it is linear.
    `as_given`         whether its stiffness and damping at a speed are given numbers: not those at rest and the wedge
                       of the mean spin.
    `opening_slots`    slots of `f` that hold the opening force per inner and per outer pressure (m^2), of a film whose
                       coefficients may be another film's (`film.coefficients = "radial"`).
    `pads`             whether it takes the pads of a table.
    `standing_waves`   whether it takes waves of faces that stand still only; `opening_law` then takes `waves` too,
                       those of the stator and of the rotor.
    `waves_touch`      whether wavy faces may be rough and meet; `opening_law` then takes the `contact` too.

    What it shows over the faces, kept by archives at a few instants:

    `quantities`       the Fields that `fields` writes; () of a film that shows nothing.
    `grid(f)`          radii (m) and angles (rad, from the x axis), which do not change during a run.
    `fields(f, s, out)`
        compiled: their values at a gap state into `out` (fields, radii, angles), in the Fields' units.
    `mean_circumference(f)`
        whether pressure acts on the mean circumference, at whatever radius.
    `exit_mach(f, s)`  least and largest Mach number of the gas at its exit around the circle at a gap state.

    A film may have unknowns `x` of its own, such as pressures; its force is then no function of the gap state alone.
    Its kernels are `wrench(f, s, x)`, `flow(f, s, x)` and `fields(f, s, x, out)`.  It has besides:

    `unknowns(f)`      FilmUnknowns: names, scales, which are differential, the residual's pattern.
    `start(f, s, x)`   compiled: x of the steady film at a gap state, its rates among it; returns 0, or a code of
                       `status`.
    `residual(f, s, x, x_rate, res)`
        value kernel: what is left of the film's equations (n,), in any units; returns 0, or a code of `status`, which
        ends the run, as does what is not a number.  Finite and smooth at any gap state that a solver may try.

    and may have:

    `jacobian(f, s, x, x_rate, alpha, data)`
        value kernel: d res / d x + alpha d res / d x_rate in the order of the pattern's values (nnz,).
    `wrench_jacobian(f, s, x, rows)`
        value kernel: d (force, moments) / d x, (3, n).
    `settle(f, s, alpha, base, x)`
        value kernel: x at the end of a step of an implicit method, where the rates of the differential ones are
        alpha (x - base), alpha in 1/s; at entry x near by.  Returns 0, or a code of `status`.  For films whose residual
        has kinks that no Newton iteration of a library passes.
    `between(f, s, x)` (beside `settle`) compiled: x between two steps, whose differential ones are interpolated, at a
                       gap state.
    `line_load(f, x)`  what the film presses on the faces at each angle of a sector of them, (angles,) in N per rad:
                       what bends a ring.
    `for_modes(f)`     changes a block for linearising: rates that the film has for a solver's sake are infinite in it,
                       and no modes.
    `whole(table)`     the table of the whole circle where a part of it stands for all.
    `frame(f, s)`      speed (rad/s) of the frame in which the unknowns stand, in `around` sectors alike, of a film with
                       a pattern that turns; its aligned state is steady there.
    `prepared(scene)`  the table with what the rest of the scene decides of it; beside it, of a film whose cells are
                       looked for, `cells_are_given(table)`, and `doubled(table, times)`, the table with twice the cells
                       so many times (dynamics/interface.py).
    `grid_accuracy(table)`
        the relative error that its cells may have, beside the accuracy of a run.
    `halved(table)`    the table with half the cells, which err four times as much, or two to the `cell_order(table)`;
                       with `finer(table)`, four times the cells of aligned faces, by which it is measured
                       how much more they err.

    Its stiffness and damping follow by condensation (dynamics/condensation.py); where some unknowns are differential
    they hang on the frequency, and modes and responses have them at their own (dynamics/film_modes.py).
    """

    name: str
    fidelity: int
    fluids: tuple[str, ...] = ("liquid",)
    only_on_request: bool = False
    generalises: str | None = None

    accepts: Callable
    parameters: Callable
    opening_law: Callable
    wrench: Callable
    flow: Callable

    remark: str | None = None
    status: dict[int, str] = field(default_factory=dict)
    floored: str | None = None
    rough: Film | None = None
    patterned: str | None = None
    matrices: Callable | None = None
    constant: bool = False
    as_given: bool = False
    opening_slots: tuple[int, int] | None = None
    pads: bool = False
    standing_waves: bool = False
    waves_touch: bool = False

    quantities: tuple[Field, ...] = ()
    grid: Callable | None = None
    fields: Callable | None = None
    mean_circumference: Callable | None = None
    exit_mach: Callable | None = None

    unknowns: Callable | None = None
    start: Callable | None = None
    residual: Callable | None = None
    jacobian: Callable | None = None
    wrench_jacobian: Callable | None = None
    settle: Callable | None = None
    between: Callable | None = None
    line_load: Callable | None = None
    for_modes: Callable | None = None
    whole: Callable | None = None
    frame: Callable | None = None
    prepared: Callable | None = None
    cells_are_given: Callable | None = None
    doubled: Callable | None = None
    grid_accuracy: Callable | None = None
    halved: Callable | None = None
    cell_order: Callable | None = None
    finer: Callable | None = None


def force_over_clearance(table, f, s, solve) -> Callable:
    """The function `force(clearance, inner_pressure, outer_pressure, floor)` (N) of a film's `opening_law`.

    One block `f` for all clearances, of which only the slots of the clearance and the floor (m) differ; gap state `s`
    of the aligned faces; `solve(f, s)` writes the force.
    """

    def force(clearance: float, inner_pressure: float, outer_pressure: float, floor: float | None = None) -> float:
        f[CLEARANCE], f[FLOOR] = clearance, table.floor * clearance if floor is None else floor
        s[INNER_PRESSURE], s[OUTER_PRESSURE] = inner_pressure, outer_pressure
        solve(f, s)
        return float(s[FORCE])

    return force
