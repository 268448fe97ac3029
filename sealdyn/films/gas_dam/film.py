"""Gas dam: quasi-one-dimensional compressible flow with friction along the radius, at every angle by itself.

**Source** Zuk, NASA TM X-68022 (1972), in the closed form of _gas_dam.py: friction, change of area, entrance loss,
laminar and turbulent, subsonic to choked.  Around the circle the even sectors of the trapezoidal rule.
**Valid** narrow dams of ideal gas, adiabatic; faces that are plain cones.  It has no squeeze film and no wedge: no
damping and no cross stiffness, which have to come from elsewhere (the supports, a secondary seal, "gas_reynolds").
Where a sector has no flow of this kind, because the gas chokes at its entrance, the film has no solution (STATUS).
"""

import math

import numpy as np

from ...faces.geometry import (
    CAVITATED,
    FACE_SIZE,
    FLOOR,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GY,
    INNER_PRESSURE,
    INNER_RADIUS,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    REFUSED,
    SPIN_DIFFERENCE,
    TEMPERATURE,
    TORQUE,
    VISCOSITY,
    edges_of,
    face_parameters,
    regularised_thickness,
)
from ...numerics.kernel import inner_kernel, value_kernel
from ...numerics.piecewise_linear import initially
from ...scene.fluid import GasDam, density_of, gas_of, viscosity_of
from .. import _gas_dam as sector
from .._contract import PRESSURE, Film, force_over_clearance
from .._gas_dam import STATUS
from . import OFFER

# Block after the faces: the sector's (_gas_dam.py), whether viscosity is that of the gap state, density at which
# volumes are stated (kg/m^3), ln of what sectors may err, how many sectors a bend around the circle takes.
DAM = FACE_SIZE
OWN_VISCOSITY, DENSITY, LOG_ERROR, BENT, BLOCK_SIZE = range(DAM + sector.BLOCK_SIZE, DAM + sector.BLOCK_SIZE + 5)
# Least and most sectors.
FEWEST, MOST = 8, 512
# The friction's Gauss points, and those of the field.
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(8)
RADII, ANGLES = 65, 48


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    plain = film is None or (film.profile is None and film.geometry == "cylindrical")
    return "" if plain and not waves else "plain cones only, cylindrical ones"


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,): a Film table, design clearance at the inner radius
    (m), relative error allowed to the sum over the sectors."""
    f, gas, options = np.zeros(BLOCK_SIZE), gas_of(film), film.gas_dam or GasDam()
    f[:FACE_SIZE] = face_parameters(film, clearance)
    f[DAM : DAM + sector.BLOCK_SIZE] = sector.parameters(
        film.inner_radius,
        film.outer_radius,
        1.0,
        gas_constant=gas.gas_constant,
        heat_ratio=gas.heat_ratio,
        sutherland=(0.0, 0.0) if gas.reference_viscosity is None else gas.sutherland(),
        entrance_loss=options.entrance_loss,
        friction=options.friction,
        width=options.width,
    )
    error = min(max(error, 1e-12), 1e-2)
    f[OWN_VISCOSITY], f[DENSITY] = film.viscosity is not None, density_of(film)
    f[LOG_ERROR] = math.log(1e2 / error)
    # Where the flow begins to choke, or a face meets the floor, the second derivative jumps: 2e-3/N^3 of the force.
    f[BENT] = (5e-3 / error) ** (1.0 / 3.0)
    return f


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned film, `force(clearance, inner_pressure, outer_pressure, floor)`; NaN where it
    has no solution.  The spins do not matter."""
    f, s = parameters(film, 1.0), np.zeros(GAP_STATE_SIZE)
    s[TEMPERATURE], s[VISCOSITY] = initially(film.temperature), initially(viscosity_of(film))
    return force_over_clearance(film, f, s, wrench)


@inner_kernel()
def _gas(f, s):
    """The sector's block at the temperature and viscosity of a gap state."""
    g = f[DAM : DAM + sector.BLOCK_SIZE].copy()
    g[sector.TEMPERATURE] = s[TEMPERATURE]
    g[sector.VISCOSITY] = s[VISCOSITY] if f[OWN_VISCOSITY] != 0.0 else 0.0
    return g


@inner_kernel()
def _solve(f, g, s, edges, cos, out):
    """Flow through the sector at this cosine of the angle from the thinnest place; films at its edges, and its code."""
    h_i = regularised_thickness(edges[0] - edges[2] * cos, f[FLOOR])
    h_o = regularised_thickness(edges[1] - edges[3] * cos, f[FLOOR])
    return h_i, h_o, sector.dam(g, h_i, h_o, s[INNER_PRESSURE], s[OUTER_PRESSURE], out)


@inner_kernel()
def _sectors(f, edges, bent):
    """Number of sectors: even, what the trapezoidal rule needs for the edge that is nearer to touching, its error
    falling as exp(-N eta), cosh(eta) = film over swing; more where something is `bent`."""
    ratio, wanted = min(edges[0] / edges[2], edges[1] / edges[3]), float(MOST)
    if ratio > 1.0:
        wanted = min(wanted, f[LOG_ERROR] / math.acosh(ratio))
    if bent:
        wanted = max(wanted, f[BENT])
    return 2 * math.ceil(0.5 * min(max(wanted, FEWEST), MOST))


@inner_kernel()
def _circle(f, s, complete):
    """Adds up the sectors: force and moments, with `complete` also flow and torque."""
    r_i, r_o = f[INNER_RADIUS], f[OUTER_RADIUS]
    r_m, low = 0.5 * (r_i + r_o), min(s[INNER_PRESSURE], s[OUTER_PRESSURE])
    g, out, edges = _gas(f, s), np.empty(sector.DAM_SIZE), edges_of(f, s)
    tilt = math.hypot(s[GX], s[GY])

    # The thinnest place and the thickest tell what is between.
    force = moment = mass = drag = 0.0
    bent = edges[0] - edges[2] < f[FLOOR] or edges[1] - edges[3] < f[FLOOR]
    k, count, choked = 0, 2 if tilt > 0.0 else 1, 0
    while k <= count // 2:
        # In the order 0, N/2, then all between.
        cos = 1.0 - 2.0 * k if k < 2 else math.cos(2.0 * math.pi * (k - 1) / count)
        h_i, h_o, code = _solve(f, g, s, edges, cos, out)
        if code != sector.SOLVED:
            s[FORCE] = s[MOMENT_X] = s[MOMENT_Y] = math.nan
            s[FLOW_INNER] = s[FLOW_OUTER] = s[TORQUE] = math.nan
            if s[REFUSED] == 0.0:
                s[REFUSED] = code
            return
        twice = 1.0 if k < 2 else 2.0
        force += twice * out[sector.FORCE]
        moment += twice * (r_m * out[sector.FORCE] + out[sector.MOMENT]) * cos
        mass += twice * out[sector.MASS_FLOW]
        if complete:
            drag += twice * _couette(r_i, r_o, h_i, h_o)
        if k < 2:
            choked += out[sector.EXIT_MACH] >= 1.0
        if k == 1:
            count = _sectors(f, edges, bent or choked == 1)
        k += 1
    share = 2.0 * math.pi / count
    s[FORCE] = low * math.pi * (r_o - r_i) * (r_o + r_i) + share * r_m * force
    moment *= share * r_m
    s[MOMENT_X] = -moment * s[GX] / tilt if tilt > 0.0 else 0.0
    s[MOMENT_Y] = -moment * s[GY] / tilt if tilt > 0.0 else 0.0
    if complete:
        s[FLOW_INNER] = s[FLOW_OUTER] = share * r_m * mass / f[DENSITY]
        # (h/2) dp/dtheta by parts around the circle.
        lift = 0.5 * (s[GX] * s[MOMENT_Y] - s[GY] * s[MOMENT_X])
        s[TORQUE] = share * drag * s[VISCOSITY] * s[SPIN_DIFFERENCE] + lift
        s[CAVITATED] = 0.0


@inner_kernel()
def _couette(r_i, r_o, h_i, h_o):
    """int r^3/h dr (m^3)."""
    total, half = 0.0, 0.5 * (r_o - r_i)
    for k in range(len(POINTS)):
        r = r_i + half * (1.0 + POINTS[k])
        total += WEIGHTS[k] * half * r**3 / (h_i + (h_o - h_i) * (r - r_i) / (r_o - r_i))
    return total


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state; NaN and a code of
    STATUS in REFUSED where there is no solution."""
    _circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s at normal conditions), the same at both radii, and the friction torque on the
    rotor (N m)."""
    _circle(f, s, True)


# --- over the face ------------------------------------------------------------------------------------


def grid(f) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m), closer at the edges, where a choked gas expands, and angles (rad) of the field."""
    return np.array([_radius(f, k, RADII) for k in range(RADII)]), np.arange(ANGLES) * (2 * np.pi / ANGLES)


@inner_kernel()
def _radius(f, k, count):
    """Radius (m) number k of so many."""
    share = 0.5 * (1.0 - math.cos(math.pi * k / (count - 1)))
    return f[INNER_RADIUS] + (f[OUTER_RADIUS] - f[INNER_RADIUS]) * share


@value_kernel()
def fields(f, s, out):
    """Pressure (Pa) at the grid's radii and angles into `out` (1, radii, angles); NaN where there is no solution."""
    g, work, edges = _gas(f, s), np.empty(sector.DAM_SIZE), edges_of(f, s)
    r_i, r_o, thinnest = f[INNER_RADIUS], f[OUTER_RADIUS], math.atan2(-s[GX], s[GY])
    outwards = s[INNER_PRESSURE] > s[OUTER_PRESSURE]
    for j in range(out.shape[2]):
        cos = math.cos(2.0 * math.pi * j / out.shape[2] - thinnest)
        h_i, h_o, code = _solve(f, g, s, edges, cos, work)
        for i in range(out.shape[1]):
            r = _radius(f, i, out.shape[1])
            if code != sector.SOLVED:
                out[0, i, j] = math.nan
            elif s[INNER_PRESSURE] == s[OUTER_PRESSURE]:
                out[0, i, j] = s[INNER_PRESSURE]
            elif outwards:
                out[0, i, j] = sector.pressure_inside(g, work, h_o, h_i, r_o, r_i, r)
            else:
                out[0, i, j] = sector.pressure_inside(g, work, h_i, h_o, r_i, r_o, r)


def sectors_for(f, s) -> int:
    """How many sectors the rule takes at a gap state where nothing begins to choke."""
    return _sectors(f, edges_of(f, s), False)


def mean_circumference(f) -> bool:
    """Whether the pressure acts on the mean circumference, at whatever radius."""
    return f[DAM + sector.LOCAL] == 0.0


def exit_mach(f, s) -> tuple[float, float]:
    """Least and largest Mach number at the exit around the circle at a gap state."""
    g, edges, out, found = _gas(f, s), edges_of(f, s), np.empty(sector.DAM_SIZE), []
    for cos in np.cos(np.linspace(0.0, np.pi, ANGLES + 1)):
        _solve(f, g, s, edges, cos, out)
        found.append(float(out[sector.EXIT_MACH]))
    return min(found), max(found)


FILM = Film(
    **OFFER._asdict(),
    remark="a gas dam has no squeeze film: all damping is that of the supports and secondary seals",
    status=STATUS,
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
    wrench=wrench,
    flow=flow,
    quantities=(PRESSURE,),
    grid=grid,
    fields=fields,
    mean_circumference=mean_circumference,
    exit_mach=exit_mach,
)
