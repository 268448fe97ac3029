"""Film by numbers: stiffness and damping matrices over clearance and shaft speed, as measured or computed elsewhere.

    (F, M_x, M_y) = (F_0, 0, 0) - int K(h) (1, 0, 0) dh - K(h) (0, g_x, g_y) - D(h) (dz', g_x', g_y')

h the film thickness of the aligned faces at the inner radius; the integral, of the force from where that is known, of
the moments from the design clearance; F_0 the given opening force or that of the narrow seal.  Over the clearance
`K h^3` and `D h^3` are monotone cubics through the rows, the integral in closed form; over the speed they are straight.
Leakage by numbers: q/h^3 a monotone cubic over the clearance, straight over the pressure difference and zero with it;
else that of the narrow seal, as is the friction.
**Source** the user's numbers; monotone cubics: Fritsch & Butland (1984), SIAM J. Sci. Stat. Comput. 5, 300-304.
**Valid** tilts |g| r_o well below the clearance, of which the axial force knows nothing beyond the first order; motion
so slow, or at the one frequency, for which the numbers hold.
"""

import math

import numpy as np

from ..faces.geometry import (
    CAVITATED,
    CLEARANCE,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    REFUSED,
    SPIN_DIFFERENCE,
    TORQUE,
    face_parameters,
)
from ..numerics.kernel import inner_kernel, value_kernel
from ..numerics.piecewise_linear import initially
from ..scene.film import coning_varies
from ..scene.tabulated import leakage_grid, tabulated_grid
from ._contract import Film
from ._line_laws import forces_per_pressure, narrow_seal, normal_conditions

# Block after the faces: numbers of clearances, of speeds, of clearances and of pressure differences of the leakage
# (0: the narrow seal's); opening force per inner and outer pressure (m^2) and beside both (N); of a gas normal
# temperature over pressure; then clearances, speeds, and pieces: of each clearance interval and speed the 18 elements
# in four powers of 1/h, and the constants of the three integrals; then those of the leakage.
COUNT, SPEEDS, LEAKS, DROPS, FORCE_I, FORCE_O, BESIDE, GAS, TABLE = range(FACE_SIZE, FACE_SIZE + 9)
ELEMENTS, POWERS = 18, 4
PIECE = ELEMENTS * POWERS + 3
# Beyond the clearances of the table by this share, for differences at its ends.
BEYOND = 0.01
OUTSIDE = 1
STATUS = {OUTSIDE: "the film left the clearances of film.tabulated"}


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these."""
    if film is not None and film.tabulated is None:
        return "a table [film.tabulated]"
    plain = film is None or not (film.profile is not None or film.inertia or coning_varies(film) or film.heat)
    return "" if plain and not waves else "plain cones that stay as they are, without waves, heat and inertia"


def known_at(film) -> float:
    """Clearance (m) at which the opening force is known."""
    table, rows = film.tabulated, tabulated_grid(film)[0]
    return table.opening_clearance or film.clearance or float(rows[len(rows) // 2])


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block.  `error` is not needed: no quadrature."""
    rows, speeds, elements = tabulated_grid(film)
    pieces = _pieces(rows, elements.reshape(len(rows), -1))
    pieces = pieces.reshape(len(pieces), len(speeds), ELEMENTS, POWERS)
    ends = rows if len(rows) > 1 else np.array([0.0])
    head = np.zeros(TABLE)
    head[:FACE_SIZE] = face_parameters(film, clearance)
    head[COUNT], head[SPEEDS] = len(rows), len(speeds)
    at = known_at(film)
    head[FORCE_I], head[FORCE_O] = forces_per_pressure(film, at)
    inner, outer = initially(film.inner_pressure), initially(film.outer_pressure)
    if film.tabulated.opening_force is not None:
        head[BESIDE] = film.tabulated.opening_force - head[FORCE_I] * inner - head[FORCE_O] * outer
    head[GAS] = normal_conditions(film)
    # The integrals: zero where the force is known, and the moments at the design clearance.
    constants = np.zeros((*pieces.shape[:2], 3))
    for i, zero in enumerate((at, clearance, clearance)):
        for j in range(len(speeds)):
            held = pieces[:, j, 3 * i]
            for k in range(1, len(held)):
                step = _integral(held[k - 1], rows[k]) - _integral(held[k], rows[k])
                constants[k, j, i] = constants[k - 1, j, i] + step
            k = _piece(rows, zero)
            constants[:, j, i] -= constants[k, j, i] + _integral(held[k], zero)
    whole = np.concatenate([pieces.reshape(*pieces.shape[:2], -1), constants], axis=2)
    leaks = []
    if film.tabulated.leakage is not None:
        places, drops, flow = leakage_grid(film.tabulated)
        places = np.where(np.isnan(places), clearance, places)
        drops = np.where(np.isnan(drops), abs(outer - inner), drops)
        head[LEAKS], head[DROPS] = len(places), len(drops)
        # Of q / h^3: that of q itself over h^3 at the rows, a cubic in h between.
        cubes = _pieces(places, flow / places[:, None] ** 3, power=0)
        leaks = [places, drops, cubes.ravel()]
    return np.concatenate([head, ends, np.nan_to_num(speeds), whole.ravel(), *leaks])


def _pieces(rows, values, power: int = 3) -> np.ndarray:
    """Coefficients (pieces, columns, POWERS), lowest power of h first, of the monotone cubics of values * h^power;
    constants where there is one row."""
    if len(rows) == 1:
        # K itself, which stands at h^3 of K h^3.
        out = np.zeros((1, values.shape[1], POWERS))
        out[0, :, power] = values[0]
        return out
    from scipy.interpolate import PchipInterpolator

    found = PchipInterpolator(rows, values * rows[:, None] ** power).c
    out = np.zeros((len(rows) - 1, values.shape[1], POWERS))
    # From powers of (h - row) to powers of h.
    for k, row in enumerate(rows[:-1]):
        for n in range(POWERS):
            for m in range(n + 1):
                out[k, :, m] += found[POWERS - 1 - n, k] * math.comb(n, m) * (-row) ** (n - m)
    return out


def _integral(a, h: float) -> float:
    return -0.5 * a[0] / (h * h) - a[1] / h + (a[2] * math.log(h) if a[2] else 0.0) + a[3] * h


def _piece(rows, h: float) -> int:
    return min(max(int(np.searchsorted(rows, h)) - 1, 0), max(len(rows) - 2, 0))


@inner_kernel()
def _between(f, at, count, value):
    """Which interval of `count` increasing numbers at `at` in `f` a value lies in; beyond the ends the nearest."""
    low = 0
    while low < count - 2 and f[at + low + 1] <= value:
        low += 1
    return low


@inner_kernel()
def _reached(f, h):
    """Whether the table has a film thickness (m)."""
    count = int(f[COUNT])
    if count == 1:
        return h > 0.0
    return f[TABLE] * (1.0 - BEYOND) <= h <= f[TABLE + count - 1] * (1.0 + BEYOND)


@inner_kernel()
def _cell(f, h, speed):
    """Where in `f` the pieces of both speeds about a shaft speed (rad/s) stand, and the share of the second."""
    count, speeds = int(f[COUNT]), int(f[SPEEDS])
    piece = _between(f, TABLE, count, h) if count > 1 else 0
    first = TABLE + count + speeds + PIECE * speeds * piece
    if speeds == 1:
        return first, first, 0.0
    at = _between(f, TABLE + count, speeds, speed)
    low, high = f[TABLE + count + at], f[TABLE + count + at + 1]
    return first + PIECE * at, first + PIECE * (at + 1), (speed - low) / (high - low)


@inner_kernel()
def _value(f, cell, element, h):
    a = cell + POWERS * element
    return ((f[a] / h + f[a + 1]) / h + f[a + 2]) / h + f[a + 3]


@inner_kernel()
def element_at(f, h, speed, element):
    """An element (SI), its derivative by the film thickness h (m), at a shaft speed (rad/s)."""
    one, other, share = _cell(f, h, speed)
    value = slope = 0.0
    for k in range(2):
        cell, weight = (one, 1.0 - share) if k == 0 else (other, share)
        a = cell + POWERS * element
        value += weight * _value(f, cell, element, h)
        slope -= weight * ((3.0 * f[a] / h + 2.0 * f[a + 1]) / h + f[a + 2]) / (h * h)
    return value, slope


@inner_kernel()
def lost(f, h, speed, row):
    """Integral of the element of a `row` (0 force, 1 and 2 moments) and of axial motion up to h (m)."""
    one, other, share = _cell(f, h, speed)
    total = 0.0
    for k in range(2):
        cell, weight = (one, 1.0 - share) if k == 0 else (other, share)
        a = cell + POWERS * 3 * row
        logarithm = f[a + 2] * math.log(h) if f[a + 2] != 0.0 else 0.0
        whole = -0.5 * f[a] / (h * h) - f[a + 1] / h + logarithm + f[a + 3] * h
        total += weight * (whole + f[cell + POWERS * ELEMENTS + row])
    return total


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned faces, `force(clearance, inner_pressure, outer_pressure, floor)`, clearance in m
    and pressures in Pa; nan beyond the clearances of the table; it has no use for a floor."""
    f, speed = parameters(film, known_at(film)), mean_spin + 0.5 * spin_difference

    def force(clearance: float, inner_pressure: float, outer_pressure: float, floor: float | None = None) -> float:
        if not _reached(f, clearance):
            return math.nan
        still = f[FORCE_I] * inner_pressure + f[FORCE_O] * outer_pressure + f[BESIDE]
        return float(still - lost(f, clearance, speed, 0))

    return force


def matrices(f, s):
    """Stiffness and damping, each (3, 3), on (dz, g_x, g_y) at a gap state: the numbers of the table, and in the first
    column what they change with the clearance under tilt and in motion.  Beyond the table all are nan."""
    h, speed = f[CLEARANCE] + s[DZ], s[MEAN_SPIN] + 0.5 * s[SPIN_DIFFERENCE]
    if not _reached(f, h):
        return np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    found = np.array([element_at(f, h, speed, e) for e in range(ELEMENTS)]).reshape(2, 3, 3, 2)
    (stiffness, damping), (bent, slowed) = found[..., 0], found[..., 1]
    stiffness = stiffness.copy()
    stiffness[:, 0] += bent[:, 1:] @ [s[GX], s[GY]] + slowed @ [s[DZ_RATE], s[GX_RATE], s[GY_RATE]]
    return stiffness, damping


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    h, speed = f[CLEARANCE] + s[DZ], s[MEAN_SPIN] + 0.5 * s[SPIN_DIFFERENCE]
    s[CAVITATED] = 0.0
    if not _reached(f, h):
        s[REFUSED] = OUTSIDE
        s[FORCE] = s[MOMENT_X] = s[MOMENT_Y] = np.nan
        return
    one, other, share = _cell(f, h, speed)
    for row in range(3):
        total = lost(f, h, speed, row)
        for part in range(1, 6):
            moved = s[DZ + part] if part < 3 else s[DZ_RATE + part - 3]
            if moved != 0.0:
                element = 3 * row + part if part < 3 else 9 + 3 * row + part - 3
                value = (1.0 - share) * _value(f, one, element, h)
                if share != 0.0:
                    value += share * _value(f, other, element, h)
                total += value * moved
        s[FORCE + row] = -total
    s[FORCE] += f[FORCE_I] * s[INNER_PRESSURE] + f[FORCE_O] * s[OUTER_PRESSURE] + f[BESIDE]


@inner_kernel()
def own_leakage(f, h, drop):
    """Leakage (m^3/s) of the numbers given, at a film thickness (m) and a pressure difference (Pa), both > 0."""
    leaks, drops = int(f[LEAKS]), int(f[DROPS])
    count, speeds = int(f[COUNT]), int(f[SPEEDS])
    at = TABLE + count + speeds + PIECE * speeds * max(count - 1, 1)
    cubes = at + leaks + drops
    piece = _between(f, at, leaks, h) if leaks > 1 else 0
    # Beyond the rows it goes on with the cube.
    near = min(max(h, f[at]), f[at + leaks - 1]) if leaks > 1 else 1.0
    k = _between(f, at + leaks, drops, drop) if drops > 1 else 0
    low = cubes + POWERS * (drops * piece + k)
    one = ((f[low + 3] * near + f[low + 2]) * near + f[low + 1]) * near + f[low]
    first = f[at + leaks + k]
    if drops == 1 or drop <= first:
        return h**3 * one * drop / first
    low += POWERS
    other = ((f[low + 3] * near + f[low + 2]) * near + f[low + 1]) * near + f[low]
    return h**3 * (one + (other - one) * (drop - first) / (f[at + leaks + k + 1] - first))


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) by the numbers given or of the narrow seal, and its friction torque on the
    rotor (N m)."""
    wrench(f, s)
    volume, s[TORQUE] = narrow_seal(f, s, f[GAS])
    if f[LEAKS] != 0.0:
        drop, h = s[OUTER_PRESSURE] - s[INNER_PRESSURE], f[CLEARANCE] + s[DZ]
        volume = 0.0 if drop == 0.0 else -math.copysign(own_leakage(f, max(h, 0.0), abs(drop)), drop)
    s[FLOW_INNER] = s[FLOW_OUTER] = volume


FILM = Film(
    name="tabulated",
    fidelity=1,
    fluids=("liquid", "gas"),
    only_on_request=True,
    as_given=True,
    remark="film by numbers of a table: for tilts and motion small beside the clearance; its speeds go on straight",
    status=STATUS,
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
    matrices=matrices,
    wrench=wrench,
    flow=flow,
)
