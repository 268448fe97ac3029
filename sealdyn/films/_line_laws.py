"""Films that know no pressure over the face: their leakage and friction as those of the narrow seal at any gap, and a
film by laws over its thickness, Python functions of the force per length of the mean circle, from any source.

    F = oint [w(h) - d(h) (h_t + wm h_theta)] r dtheta,     h = C + dz + coning (r - r_i) + r (g_x sin - g_y cos)

with w the opening force and d the damping per length (N/m, N s/m^2), r the mean radius, wm the mean spin, whose term is
the wedge of Reynolds' equation; moments as h weighs them.  The functions are asked once, before a run: cubic splines
over the logarithm of h, with knots until they agree to the error that the run allows, stand for them.
**Source** of leakage and friction: conductance `h^3/(12 mu)` and drag `mu r w/h` of parallel faces, integrated over the
width of a cone in closed form, angle by angle around the circle.
**Valid** laws: narrow faces without waves, tilts within the thicknesses at which the laws hold; pressures that stay.
Leakage and friction: laminar flow, without squeeze and without what the pressure does on the slope of a wave; of a gas
isothermal and viscous.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..closed_form import narrow_seal_opening_force
from ..faces.film_thickness import film_thickness
from ..faces.geometry import (
    CAVITATED,
    CLEARANCE,
    CONING,
    CONING_CHANGE,
    CONING_RATE,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOOR,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    ORDER_LIST,
    ORDERS,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    SPIN_DIFFERENCE,
    TEMPERATURE,
    TILT_AT_MEAN,
    TORQUE,
    VISCOSITY,
    WAVES,
    face_parameters,
    regularised_thickness,
)
from ..numerics.kernel import inner_kernel, value_kernel
from ..numerics.piecewise_linear import PiecewiseLinear, initially
from ..scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE
from ._contract import Film

FLOW_ANGLES = 64


def normal_conditions(film) -> float:
    """Normal temperature over normal pressure (K/Pa) of a `Film` table with a gas; 0 with a liquid."""
    return 0.0 if film.gas is None else NORMAL_TEMPERATURE / NORMAL_PRESSURE


def forces_per_pressure(film, clearance: float) -> tuple[float, float]:
    """Opening force (N) of the aligned narrow seal of a `Film` table at a clearance (m), over its inner and over its
    outer pressure (m^2)."""
    faces = film.inner_radius, film.outer_radius, clearance, initially(film.coning)
    return narrow_seal_opening_force(*faces, 1.0, 0.0), narrow_seal_opening_force(*faces, 0.0, 1.0)


@inner_kernel()
def narrow_seal(f, s, normal):
    """Flow in +r (m^3/s; of a gas at normal conditions, `normal` not 0) and friction torque on the rotor (N m), whose
    forces stand in the gap state `s`; `f` a face block."""
    r_i, r_o, floor = f[INNER_RADIUS], f[OUTER_RADIUS], f[FLOOR]
    width, r_m = r_o - r_i, 0.5 * (r_i + r_o)
    tilt = math.hypot(s[GX], s[GY])
    swing_i, swing_o = r_i * tilt, r_o * tilt
    if f[TILT_AT_MEAN] != 0.0:
        swing_i = swing_o = r_m * tilt
    conductance = drag = 0.0
    angles = FLOW_ANGLES
    if f[WAVES] != 0.0:
        angles *= int(f[ORDER_LIST + int(f[ORDERS]) - 1])
    for j in range(angles):
        angle = 2.0 * math.pi * j / angles
        if f[WAVES] == 0.0:
            # Counted from the thinnest place.
            cos_b = math.cos(angle)
            h_i = regularised_thickness(f[CLEARANCE] + s[DZ] - swing_i * cos_b, floor)
            coned = (f[CONING] + s[CONING_CHANGE]) * width
            h_o = regularised_thickness(f[CLEARANCE] + s[DZ] + coned - swing_o * cos_b, floor)
        else:
            h_i = regularised_thickness(film_thickness(f, s, r_i, angle), floor)
            h_o = regularised_thickness(film_thickness(f, s, r_o, angle), floor)
        conductance += 2.0 * (h_i * h_o) ** 2 / (width * (h_i + h_o))
        change = (h_o - h_i) / h_i
        drag += width / h_i * (math.log1p(change) / change if abs(change) > 1e-9 else 1.0)
    d_theta = 2.0 * math.pi / angles
    drop = s[OUTER_PRESSURE] - s[INNER_PRESSURE]
    volume = -r_m * drop * d_theta * conductance / (12.0 * s[VISCOSITY])
    if normal != 0.0:
        # Isothermal, at the mean pressure: p^2 falls as the pressure of a liquid.
        volume *= 0.5 * (s[INNER_PRESSURE] + s[OUTER_PRESSURE]) * normal / s[TEMPERATURE]
    twist = 0.5 * (s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X])
    return volume, s[VISCOSITY] * s[SPIN_DIFFERENCE] * r_m**3 * d_theta * drag + twist


# Block after the faces: logarithm of the thinnest film, distance of knots, how many pieces, and four coefficients of
# each piece, highest power first, of opening force, damping and leakage.
FIRST, STEP, PIECES, LAWS = range(FACE_SIZE, FACE_SIZE + 4)
FEWEST, MOST, ANGLES = 256, 8192, 64
# Thickest film, in clearances; the thinnest is the floor.
THICKEST = 100.0

Law = Callable[[np.ndarray, Any, Any], Any]


def line_film(
    name: str, opening: Law, damping: Law, leakage: Law | None = None, fluids: Sequence[str] = ("liquid",)
) -> Film:
    """The Film called `name` of laws `law(thickness, options, table)`: opening force (N/m), damping (N s/m^2) and
    leakage in +r (m^2/s) per length of the mean circle, at film thicknesses (n,) (m); `options` those of `[film.NAME]`
    (None of a file without Options), `table` the `[film]`.  Without `leakage` that is NaN; friction is that of a plain
    film of its viscosity.  Raises ValueError where a law is not finite or not smooth."""

    def at(law: Law, thickness: np.ndarray, table: Any) -> np.ndarray:
        with np.errstate(all="ignore"):
            held = np.asarray(law(thickness, getattr(table, name, None), table), dtype=float)
        return np.broadcast_to(held, thickness.shape)

    def parameters(table: Any, clearance: float, error: float = 1e-8) -> np.ndarray:
        first, last = math.log(table.floor * clearance), math.log(THICKEST * clearance)
        pieces = FEWEST
        while (splines := _splines(table, first, last, pieces, error)) is None:
            pieces *= 2
        head = [first, (last - first) / pieces, pieces]
        return np.concatenate([face_parameters(table, clearance), head, splines.ravel()])

    def _splines(table: Any, first: float, last: float, pieces: int, error: float) -> np.ndarray | None:
        """Coefficients (3, pieces, 4), None where more pieces are needed."""
        # From scipy where a film is so made.
        from scipy.interpolate import CubicSpline

        knots, out = np.linspace(first, last, pieces + 1), np.full((3, pieces, 4), np.nan)
        middles = knots[:-1] + 0.5 * (knots[1] - knots[0])
        for k, law in enumerate((opening, damping, leakage)):
            if law is None:
                continue
            values, between = at(law, np.exp(knots), table), at(law, np.exp(middles), table)
            if not (np.isfinite(values).all() and np.isfinite(between).all()):
                raise ValueError(
                    f"film {name}: a law that is not finite from {math.exp(first):g} to {math.exp(last):g} m"
                )
            spline = CubicSpline(knots, values)
            size = np.maximum(np.abs(between), 1e-9 * np.abs(values).max())
            if (np.abs(spline(middles) - between) > max(error, 1e-10) * size).any():
                if pieces < MOST:
                    return None
                raise ValueError(f"film {name}: a law that {MOST} pieces of a spline do not follow")
            out[k] = spline.c.T
        return out

    def opening_law(table: Any, mean_spin: float = 0.0, spin_difference: float = 0.0) -> Callable[..., float]:
        radius = 0.5 * (table.inner_radius + table.outer_radius)
        wider = initially(table.coning) * (radius - table.inner_radius)

        def force(clearance: float, inner_pressure: float, outer_pressure: float, floor: float | None = None) -> float:
            return 2.0 * math.pi * radius * float(at(opening, np.array([clearance + wider]), table)[0])

        return force

    return Film(
        name=name,
        fidelity=1,
        fluids=tuple(fluids),
        only_on_request=True,
        accepts=accepts,
        parameters=parameters,
        opening_law=opening_law,
        wrench=wrench,
        flow=flow,
    )


def accepts(table: Any, waves: Sequence[Any] = ()) -> str:
    """What faces it takes, "" if it can take these."""
    if waves or (
        table is not None and (table.profile is not None or table.inertia or table.cavitation_pressure is not None)
    ):
        return "plain cones only"
    moving = table is not None and any(
        isinstance(p, PiecewiseLinear) for p in (table.inner_pressure, table.outer_pressure)
    )
    return "pressures that stay as they are" if moving else ""


@inner_kernel()
def law_at(f, law, thickness):
    """One of the laws (0, 1, 2) at a film thickness (m), beyond its ends as there."""
    place = (math.log(max(thickness, 1e-300)) - f[FIRST]) / f[STEP]
    piece = min(max(place, 0.0), f[PIECES])
    k = min(int(piece), int(f[PIECES]) - 1)
    x, c = (piece - k) * f[STEP], LAWS + 4 * (law * int(f[PIECES]) + k)
    return ((f[c] * x + f[c + 1]) * x + f[c + 2]) * x + f[c + 3]


@inner_kernel()
def _around(f, s, whole):
    """Integrals around the mean circle into the gap state; of leakage and friction if the `whole` of it is asked."""
    r = 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS])
    arm, along = r - f[INNER_RADIUS], 2.0 * math.pi * r / ANGLES
    mean = f[CLEARANCE] + s[DZ] + (f[CONING] + s[CONING_CHANGE]) * arm
    mean_rate = s[DZ_RATE] + s[CONING_RATE] * arm
    force, moment_x, moment_y, leaking, thin = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(ANGLES):
        angle = 2.0 * math.pi * k / ANGLES
        cos, sin = math.cos(angle), math.sin(angle)
        h = mean + r * (s[GX] * sin - s[GY] * cos)
        rate = mean_rate + r * (s[GX_RATE] * sin - s[GY_RATE] * cos)
        wedge = s[MEAN_SPIN] * r * (s[GX] * cos + s[GY] * sin)
        pushed = law_at(f, 0, h) - law_at(f, 1, h) * (rate + wedge)
        force += pushed
        moment_x += pushed * r * sin
        moment_y -= pushed * r * cos
        if whole:
            leaking += law_at(f, 2, h)
            thin += 1.0 / max(h, 1e-300)
    s[FORCE], s[MOMENT_X], s[MOMENT_Y], s[CAVITATED] = force * along, moment_x * along, moment_y * along, 0.0
    if whole:
        s[FLOW_INNER] = s[FLOW_OUTER] = leaking * along
        width = f[OUTER_RADIUS] - f[INNER_RADIUS]
        s[TORQUE] = s[VISCOSITY] * s[SPIN_DIFFERENCE] * width * r * r * thin * along


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) on the stator, into the gap state."""
    _around(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also leakage in +r (m^3/s) and friction torque on the rotor (N m)."""
    _around(f, s, True)
