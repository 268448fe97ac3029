"""The `[film.tabulated]` table: a film in numbers of a seal maker, of a test or of another code.

Stiffness and damping are matrices: what the force on the stator and the two moments on it lose per displacement and per
rate of (axial gap, tilt about x, tilt about y), as `sealdyn study coefficients` writes them.  Their elements are
columns `k_ROW_COLUMN` and `d_ROW_COLUMN` over the rows of a table: over the clearance, the shaft speed, both, or
neither.
"""

from dataclasses import dataclass, field
from math import isfinite
from typing import Annotated

import numpy as np

from ..numerics.piecewise_linear import initially, points
from ..units import Force, Height, OneOrListed, Quantity, Speed, Tilt, Usual, VolumeFlow
from . import Strict

ORDER = ("axial", "tilt_x", "tilt_y")
ELEMENTS = tuple(f"{letter}_{row}_{column}" for letter in "kd" for row in ORDER for column in ORDER)


def _kind(name: str, unit: str, other: tuple[str, ...], most: float, meant: str):
    return Annotated[float, Quantity(name, unit, f'"1e5 {unit}"', other, usual=Usual(0.0, most, meant))]


Stiff, Damp = _kind("film stiffness", "N/m", (), 1e13, "N/um"), _kind("film damping", "N*s/m", (), 1e10, "N*s/mm")
TiltStiff = _kind("tilt stiffness", "N*m/rad", ("N*m",), 1e9, "N*mm/rad")
TiltDamp = _kind("tilt damping", "N*m*s/rad", ("N*m*s",), 1e6, "N*mm*s/rad")
CrossStiff = _kind("cross stiffness", "N/rad", ("N",), 1e11, "N/mrad")
CrossDamp = _kind("cross damping", "N*s/rad", ("N*s",), 1e8, "N*s/mrad")
PressureDrop = Annotated[float, Quantity("pressure difference", "Pa", '"10 bar"', (), 0, True,
    usual=Usual(1e3, 1e9, "bar"))]  # fmt: skip


@dataclass(frozen=True)
class Tabulated(Strict):
    """A film by its stiffness and damping as matrices, over clearance and shaft speed; columns that are not given are
    zero, and one number stands for all rows."""

    file: str | None = field(default=None, compare=False)
    """CSV or HDF5 with these columns, beside the scenario, or the archive of `sealdyn study coefficients` with its
    table (`--clearance`, `--speed`, `--frequency`)."""
    titles: list[str] | None = field(default=None, compare=False)
    """Names of the columns of a CSV file that has no line of them, "time (ms)" and the like, "" for one not read."""
    k_axial_axial: OneOrListed[Stiff] | None = None
    """Force lost per widening of the gap."""
    k_axial_tilt_x: OneOrListed[CrossStiff] | None = None
    """Force lost per tilt about x."""
    k_axial_tilt_y: OneOrListed[CrossStiff] | None = None
    """Force lost per tilt about y."""
    k_tilt_x_axial: OneOrListed[CrossStiff] | None = None
    """Moment about x lost per widening of the gap."""
    k_tilt_x_tilt_x: OneOrListed[TiltStiff] | None = None
    """Moment about x lost per tilt about x."""
    k_tilt_x_tilt_y: OneOrListed[TiltStiff] | None = None
    """Moment about x lost per tilt about y: half the speed times tilt damping in a wedge film."""
    k_tilt_y_axial: OneOrListed[CrossStiff] | None = None
    """Moment about y lost per widening of the gap."""
    k_tilt_y_tilt_x: OneOrListed[TiltStiff] | None = None
    """Moment about y lost per tilt about x: that of `k_tilt_x_tilt_y` with the other sign in a wedge film."""
    k_tilt_y_tilt_y: OneOrListed[TiltStiff] | None = None
    """Moment about y lost per tilt about y."""
    d_axial_axial: OneOrListed[Damp] | None = None
    """As the stiffness of that name, per rate."""
    d_axial_tilt_x: OneOrListed[CrossDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_axial_tilt_y: OneOrListed[CrossDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_x_axial: OneOrListed[CrossDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_x_tilt_x: OneOrListed[TiltDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_x_tilt_y: OneOrListed[TiltDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_y_axial: OneOrListed[CrossDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_y_tilt_x: OneOrListed[TiltDamp] | None = None
    """As the stiffness of that name, per rate."""
    d_tilt_y_tilt_y: OneOrListed[TiltDamp] | None = None
    """As the stiffness of that name, per rate."""
    clearance: OneOrListed[Height] | None = None
    """Of each row; without it, or with one, the numbers hold at any gap.  A run that leaves the range ends."""
    speed: OneOrListed[Speed] | None = None
    """Shaft speed of each row; without it, or with one, the numbers hold at any speed.  Linear between, and beyond for
    studies that look there."""
    frequency: OneOrListed[Speed] | None = None
    """Frequency of the motion of each row; equations in time have one matrix, that at `at_frequency`."""
    coning: OneOrListed[Tilt] | None = None
    """Of each row; those at `film.coning` are taken."""
    at_frequency: Speed | None = None
    """Which of several frequencies is taken."""
    opening_force: Force | None = None
    """On the aligned faces at `opening_clearance` and the first pressures; that of the narrow seal without it."""
    opening_clearance: Height | None = None
    """Where `opening_force` is known; `film.clearance`, or the middle row, without it."""
    leakage: OneOrListed[VolumeFlow] | None = None
    """Own leakage: one number, at the design clearance and the first pressures, goes with h^3 and the pressure
    difference; several are rows of `leakage_clearance` and `leakage_difference`.  Without it the narrow seal's."""
    leakage_clearance: OneOrListed[Height] | None = None
    """Of each row of `leakage`."""
    leakage_difference: OneOrListed[PressureDrop] | None = None
    """Pressure difference of each row of `leakage`; without it the first one, and proportional."""


# What a file may hold, and what stands in each row beside the elements.
PLACE = ("clearance", "speed", "frequency", "coning")
COLUMNS = (*ELEMENTS, *PLACE)
LEAKAGE = ("leakage", "leakage_clearance", "leakage_difference")
# As near are two values that are meant as one, as a share.
SAME = 1e-9


def column(held, rows: int) -> np.ndarray:
    """A column (rows,) of what was given: one number or a list; zeros of nothing."""
    return np.broadcast_to(np.array(0.0 if held is None else held, dtype=float), (rows,))


def _rows(given: list) -> int:
    return max((len(held) for held in given if isinstance(held, tuple)), default=1)


def tabulated_grid(film) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clearances (n,) (m) and speeds (m,) (rad/s) of the table of a `Film`, both increasing, nan where it has none, and
    the elements there (n, m, 2, 3, 3), stiffness and damping.  Raises ValueError ((key, found, expected)) where these
    are no grid."""
    table = film.tabulated
    rows = _rows([getattr(table, name) for name in COLUMNS])
    picked = np.ones(rows, dtype=bool)
    for name, wanted, unit in (("frequency", table.at_frequency, "rad/s"), ("coning", initially(film.coning), "rad")):
        values = column(getattr(table, name), rows)
        if getattr(table, name) is None or np.ptp(values) <= SAME * np.abs(values).max():
            continue
        near = np.isclose(values, np.nan if wanted is None else wanted, rtol=SAME, atol=SAME * np.abs(values).max())
        if not near.any():
            key = "at_frequency" if name == "frequency" else "coning"
            several = sorted(set(values))
            found = f"{len(several)} of them from {several[0]:g} to {several[-1]:g} {unit}"
            expected = f"film.tabulated.{key}: one of them" if name == "frequency" else f"film.coning = {wanted:g} rad"
            raise ValueError(name, found, expected)
        picked &= near
    axes, at = _axes([(getattr(table, name), column(getattr(table, name), rows)[picked]) for name in PLACE[:2]])
    out = np.empty((len(axes[0]), len(axes[1]), 18))
    if not _is_grid(axes, at):
        found = f"{len(at[0])} rows of {len(axes[0])} clearances and {len(axes[1])} speeds"
        raise ValueError("clearance", found, "a row for each clearance at each speed")
    out[at[0], at[1]] = np.array([column(getattr(table, name), rows)[picked] for name in ELEMENTS]).T
    return *axes, out.reshape(*out.shape[:2], 2, 3, 3)


def leakage_grid(table: Tabulated) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clearances (n,) (m), pressure differences (m,) (Pa), nan where it has none, and the leakage there (n, m) (m^3/s).
    Raises as `tabulated_grid`."""
    given = [getattr(table, name) for name in LEAKAGE]
    rows = _rows(given)
    axes, at = _axes([(held, column(held, rows)) for held in given[1:]])
    if not _is_grid(axes, at):
        found = f"{rows} rows of {len(axes[0])} clearances and {len(axes[1])} pressure differences"
        raise ValueError("leakage", found, "a row for each clearance at each pressure difference")
    out = np.empty((len(axes[0]), len(axes[1])))
    out[at[0], at[1]] = column(table.leakage, rows)
    return *axes, out


def _axes(places) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Of each (given, values (rows,)): the different values, nan of nothing; and which of them each row has."""
    found = [np.unique(values, return_inverse=True) for _, values in places]
    axes = [
        axis if given is not None else np.array([np.nan]) for (given, _), (axis, _) in zip(places, found, strict=True)
    ]
    return axes, [index for _, index in found]


def _is_grid(axes, at) -> bool:
    """Whether each combination stands in one row."""
    count = len(axes[0]) * len(axes[1])
    return len(at[0]) == count == len(set(zip(*(index.tolist() for index in at), strict=True)))


def tabulated_errors(scene) -> list[tuple[str, str, str]]:
    """What a scene with such a film cannot have: (dotted key, found, expected), empty with another."""
    film, table, bad = scene.film, scene.film.tabulated, []
    if film.model != "tabulated":
        return bad
    if table is None:
        return [("film.tabulated", "nothing", "a table with k_axial_axial and its like, or a file of them")]
    for names in (COLUMNS, LEAKAGE):
        lengths = {name: len(held) for name in names if isinstance(held := getattr(table, name), tuple)}
        if len(set(lengths.values())) > 1:
            first, *others = lengths
            other = next(name for name in others if lengths[name] != lengths[first])
            found = f"{lengths[other]} rows, {lengths[first]} of {first}"
            return [(f"film.tabulated.{other}", found, "as many as of the other columns, or one number")]
        for name in names:
            held = getattr(table, name)
            odd = [v for v in (held if isinstance(held, tuple) else () if held is None else (held,)) if not isfinite(v)]
            if odd or held == ():
                found = f"{odd[0]}" if odd else "no rows"
                return [(f"film.tabulated.{name}", found, "finite numbers")]
    if table.k_axial_axial is None:
        bad.append(("film.tabulated.k_axial_axial", "nothing", "a stiffness, or a list of them, one for each row"))
    for name in ("clearance", "leakage_clearance", "opening_clearance"):
        held = getattr(table, name)
        low = min(held if isinstance(held, tuple) else (1.0,) if held is None else (held,))
        if low <= 0.0:
            bad.append((f"film.tabulated.{name}", f"{low:g} m", "a length > 0"))
    for name in ("leakage_clearance", "leakage_difference"):
        if getattr(table, name) is not None and table.leakage is None:
            bad.append((f"film.tabulated.{name}", "a column without film.tabulated.leakage", "both of them, or none"))
    try:
        clearances, speeds, _ = tabulated_grid(film) if not bad else ([1.0], [np.nan], None)
        if not bad and table.leakage is not None:
            leakage_grid(table)
    except ValueError as error:
        key, found, expected = error.args
        return [*bad, (f"film.tabulated.{key}", found, expected)]
    if film.clearance is not None and len(clearances) > 1 and not clearances[0] <= film.clearance <= clearances[-1]:
        found = f"{film.clearance:g} m"
        bad.append(("film.clearance", found, f"{clearances[0]:g} to {clearances[-1]:g} m, as film.tabulated has it"))
    if film.clearance is None and len(clearances) < 2 and table.opening_clearance is None:
        expected = "a clearance: film.tabulated has none from which the closing force could decide it"
        bad.append(("film.clearance", "nothing", expected))
    run = [value for value in points(scene.shaft.speed) if len(speeds) > 1 and not speeds[0] <= value <= speeds[-1]]
    if run:
        expected = f"{speeds[0]:g} to {speeds[-1]:g} rad/s, as film.tabulated has it"
        bad.append(("shaft.speed", f"{run[0]:g} rad/s", expected))
    if any(points(scene.stator.speed)):
        bad.append(("stator.speed", "a speed", "nothing: the numbers of film.tabulated are for a stator that stands"))
    if film.cavitation_pressure is not None:
        bad.append(("film.cavitation_pressure", "a value", "nothing: film.tabulated has all that the film does"))
    return bad
