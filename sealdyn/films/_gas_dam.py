"""Compressible flow of a gas across a sealing dam: one sector of the circle, quasi-one-dimensional.

**Source** Zuk, J., "Analysis of face deformation effects on gas film seal performance", NASA TM X-68022 (1972), in the
closed form below instead of his march.  The flow is followed upstream from the exit, where M2 is 1 or
what the low pressure asks for, if that is less: subsonic, critical and choked are one.  One unknown, the Mach number M1
at the entrance, gives the flow there (loss C_L, static temperature, viscosity, friction factor):

    P1 = P0 / (1 + d M1^2/C_L^2)^(g/(g - 1)),   T1 = T0/(1 + d M1^2),   P A M sqrt(1 + d M^2) = constant

and is the one that the flow followed upstream arrives with.  Friction: 24/Re laminar, 0.079/Re^(1/4) turbulent,
blended; Re = 2 (flow per width)/viscosity.
**Valid** narrow films, flow along the radius, faces without waves across the dam; no squeeze: a dam alone has no
damping.  There is no flow of this kind where the film opens so fast, A'/A >= g f/h with the entrance sonic, that the
gas chokes at the entrance, or where an entrance loss lets less through than the dam would take.

Constant width is one piece and exact.  Radial change of width is a few pieces, of equal int dx/h, each exact at its
edges.  Mass flow does not change along the radius, so Re goes with 1/r: the friction factor of a piece is Simpson's
mean of its edges' and its middle's, and a map that is exact at both edges says where in the piece the gas meets it.
Friction is scaled so that slow flow, d(S/A^2) = -2 g f dx/(h A^2), has no error from r within the piece: 1e-6 with 4
pieces on a dam as narrow as Zuk's, 1e-4 on one of 15 % of its radius, and less where that is laminar.

The flow with wall friction through a channel whose area changes, in closed form:

**Source** the equation that Zuk, NASA TM X-68022 (1972), marches: Fanning friction factor f, film h, area A, x along
the flow, g the ratio of specific heats,

    dm/m = (-2 dA/A + 2 g f m dx/h) (1 + d m)/(1 - m),   m = M^2,   d = (g - 1)/2

Where e = dA/A / (g f dx/h) is constant (the `shape`) it integrates.  Upstream of a place where S = 1/m + d is S_b, in
a variable t that grows against the flow,

    a = 1 + e d,   k = (exp(e t) - 1)/(e S_b),   S = S_b exp(-e t)(1 + a k)
    2 g f int dx/h = t - (1 + d) ln(1 + a k)/a

(derived here: dS = (a - e S) dt, 2 g f dx/h = (S - 1 - d)/S dt).  It is regular at m = 1, at e = 0, e = 1 and a = 0,
and on the line m = e, which no flow crosses: channels that narrow or widen, flows that speed up or slow down are one
formula.
**Valid** subsonic to sonic.
"""

import math

import numpy as np

from ..numerics.kernel import inner_kernel, outer_kernel


@inner_kernel()
def shrinkage(z):
    """(1 - exp(-z))/z."""
    return 1.0 if z == 0.0 else -math.expm1(-z) / z


@inner_kernel()
def blended_friction(laminar, turbulent, reynolds):
    """Fanning friction factor (f_l^8 + f_t^8)^(1/8) of f_l = `laminar`/Re and f_t = `turbulent`/Re^(1/4), of which one
    may be 0."""
    laminar, turbulent = laminar / reynolds, turbulent / math.sqrt(math.sqrt(reynolds))
    large, small = max(laminar, turbulent), min(laminar, turbulent)
    if small == 0.0:
        return large
    square = (small / large) * (small / large)
    return large * math.sqrt(math.sqrt(math.sqrt(1.0 + square * square * square * square)))


@inner_kernel()
def upstream(shape, state, t, d):
    """S and 2 g f int dx/h at `t` upstream of where S is `state`."""
    z, a = shape * t, 1.0 + shape * d
    if z > 40.0:
        # On the line m = e, to rounding.
        return a / shape, t - (1.0 + d) * (z + math.log(a / (shape * state))) / a
    grown = math.expm1(z)
    k = grown / (shape * state) if shape != 0.0 else t / state
    log = math.log1p(a * k) / a if a != 0.0 else k
    return state * (1.0 + a * k) / (1.0 + grown), t - (1.0 + d) * log


@inner_kernel()
def span(shape, state, wanted, start, d):
    """t at which 2 g f int dx/h is `wanted`, and S there, by Newton's method from `start` (0: none); t = -1 where the
    flow would have been sonic before."""
    if shape * (state - d) >= 1.0:
        # The flow slows down: from below Newton's steps stay below, and leave the subsonic range only if the flow does.
        t = wanted
    elif start > 0.0:
        t = start
    else:
        t = wanted + (1.0 + d) * math.log1p((wanted + math.sqrt(2.0 * (1.0 + d) * wanted)) / state)
    for _ in range(60):
        if shape * t < -600.0:
            # A start too near to a sonic exit has thrown a step far out.
            t = -1.0 / shape
        here, length = upstream(shape, state, t, d)
        if not here - d > 1.0:
            return -1.0, state
        step = (wanted - length) * here / (here - d - 1.0)
        # Newton's method squares what is left, and so does S along its slope.
        if abs(step) <= 1e-7 * t:
            return t + step, here + (1.0 - shape * (here - d)) * step
        t = max(t + step, 0.5 * t)
    return -1.0, state


# Parameter block: J/(kg K), total temperature of the reservoir (K), radii of the dam (m), viscosity (Pa s) or, where
# that is 0, factor (kg/(m s K^0.5)) and temperature (K) of Sutherland's law, C_L, f Re laminar and f Re^(1/4) turbulent
# (0: without), number of pieces (0: constant width), whether friction and load follow the radius, Gauss points on
# [0, 1].
(
    GAS_CONSTANT,
    HEAT_RATIO,
    TEMPERATURE,
    INNER_RADIUS,
    OUTER_RADIUS,
    VISCOSITY,
    SUTHERLAND_FACTOR,
    SUTHERLAND_TEMPERATURE,
    ENTRANCE_LOSS,
    LAMINAR,
    TURBULENT,
    PIECES,
    LOCAL,
    POINTS,
    ABSCISSAE,
) = range(15)
MOST_POINTS = 24
WEIGHTS = ABSCISSAE + MOST_POINTS
BLOCK_SIZE = WEIGHTS + MOST_POINTS

# What a solution gives, per unit width at the mean radius: gauge force int (P - P_low) dr (N/m), its moment about the
# mean radius int (P - P_low)(r - r_m) dr (N), both with r dr/r_m for dr where they follow the radius, mass flow
# (kg/(m s), positive in +r), Mach numbers, Reynolds number at the mean radius.
FORCE, MOMENT, MASS_FLOW, ENTRANCE_MACH, EXIT_MACH, REYNOLDS = range(6)
# Work space: int dx/h of a piece, then for each from the exit on: film and radius at its exit, ln of its exit's area
# over its entrance's, int dx/h with what makes good its radii, mean radius over those of its exit, middle and entrance;
# 2 g int f dx/h, how f is skewed, shape, S at its exit and t of the last trial.
LENGTH, FIRST_PIECE = 6, 7
(
    FILM,
    RADIUS,
    GROWTH,
    RESISTANCE,
    AT_EXIT,
    AT_MIDDLE,
    AT_ENTRANCE,
    LOSS,
    SKEW,
    SHAPE,
    STATE,
    SPAN,
    PIECE_SIZE,
) = range(13)
MOST_PIECES = 16
DAM_SIZE = FIRST_PIECE + PIECE_SIZE * MOST_PIECES

SOLVED, ENTRANCE_CHOKED, NOT_FOUND, NO_FILM = range(4)
STATUS = {
    ENTRANCE_CHOKED: "the gas chokes at the entrance of the dam: no flow that is subsonic inside it exists",
    NOT_FOUND: "the flow across the dam was not found",
    NO_FILM: "film thickness and pressures of a gas dam must be positive numbers",
}

# f Re laminar, f Re^(1/4) turbulent.
LAWS = {"blend": (24.0, 0.079), "laminar": (24.0, 0.0), "turbulent": (0.0, 0.079)}
# Pieces, and Gauss points on each.
DIVISIONS = {"constant": (1, 16), "radial": (4, 8), "zuk": (4, 8)}


def parameters(
    inner_radius: float,
    outer_radius: float,
    temperature: float,
    *,
    gas_constant: float,
    heat_ratio: float,
    viscosity: float = 0.0,
    sutherland: tuple[float, float] = (0.0, 0.0),
    entrance_loss: float = 1.0,
    friction: str = "blend",
    width: str = "radial",
    pieces: int | None = None,
    points: int | None = None,
) -> np.ndarray:
    """Parameter block of a dam, shape (BLOCK_SIZE,).

    Radii of the dam (m), total temperature (K) of the reservoir, gas constant (J/(kg K)), ratio of specific heats.
    `viscosity` (Pa s) constant, or 0 and `sutherland` = factor, temperature of factor T^1.5/(T + temperature);
    `entrance_loss` C_L in (0, 1], 1 without loss; `friction` "blend" | "laminar" | "turbulent"; `width` "radial" (the
    gas flows through, and presses on, the circumference of each radius, friction at its Reynolds number) | "constant"
    (all of the mean radius) | "zuk" (flow through the circumference of each radius, the rest of the mean one, as his
    tilted rows have it).  `pieces` (not of constant width, at most MOST_PIECES) and Gauss `points` on each (at most
    MOST_POINTS), if not the usual ones.
    """
    usual = DIVISIONS[width]
    points = points or usual[1]
    x, w = np.polynomial.legendre.leggauss(points)
    f = np.zeros(BLOCK_SIZE)
    f[[GAS_CONSTANT, HEAT_RATIO, TEMPERATURE]] = gas_constant, heat_ratio, temperature
    f[[INNER_RADIUS, OUTER_RADIUS]] = inner_radius, outer_radius
    f[[VISCOSITY, SUTHERLAND_FACTOR, SUTHERLAND_TEMPERATURE]] = viscosity, *sutherland
    f[[ENTRANCE_LOSS, LAMINAR, TURBULENT]] = entrance_loss, *LAWS[friction]
    f[PIECES] = 0 if width == "constant" else pieces or usual[0]
    f[LOCAL], f[POINTS] = width == "radial", points
    f[ABSCISSAE : ABSCISSAE + points], f[WEIGHTS : WEIGHTS + points] = 0.5 * (1 + x), 0.5 * w
    return f


@inner_kernel()
def _divide(f, h_exit, h_entrance, r_exit, r_entrance, out):
    """Writes the pieces, from the exit on, into the work space; returns their number."""
    pieces = max(int(f[PIECES]), 1)
    r_mean, width = 0.5 * (r_exit + r_entrance), abs(r_exit - r_entrance)
    rise = (h_entrance - h_exit) / h_exit
    length = width / h_exit * (math.log1p(rise) / rise if rise != 0.0 else 1.0) / pieces
    growth = -h_exit * rise / width * length
    out[LENGTH] = length
    r_b = r_exit
    for piece in range(pieces):
        i = FIRST_PIECE + PIECE_SIZE * piece
        out[i + FILM], out[i + RADIUS] = h_exit * math.exp(-growth * piece), r_b
        out[i + GROWTH], out[i + RESISTANCE], out[i + SPAN] = growth, length, 0.0
        out[i + AT_EXIT] = out[i + AT_MIDDLE] = out[i + AT_ENTRANCE] = 1.0
        if f[PIECES] > 0.0:
            middle = h_exit / width * length * (piece + 0.5) * shrinkage(growth * (piece + 0.5))
            far = h_exit / width * length * (piece + 1) * shrinkage(growth * (piece + 1))
            r_middle = r_exit + middle * (r_entrance - r_exit)
            r_a = r_exit + far * (r_entrance - r_exit)
            out[i + GROWTH] += math.log(r_b / r_a)
            # Mean of (r/exponential through its ends)^-2, by its parabola.
            out[i + RESISTANCE] *= math.exp(2.0 / 3.0 * math.log(r_a * r_b / (r_middle * r_middle)))
            if f[LOCAL] != 0.0:
                out[i + AT_EXIT] = r_mean / r_b
                out[i + AT_MIDDLE], out[i + AT_ENTRANCE] = r_mean / r_middle, r_mean / r_a
            r_b = r_a
    return pieces


@inner_kernel()
def _viscosity(f, temperature):
    """Viscosity (Pa s) at a static temperature (K)."""
    if f[VISCOSITY] > 0.0:
        return f[VISCOSITY]
    return f[SUTHERLAND_FACTOR] * temperature * math.sqrt(temperature) / (temperature + f[SUTHERLAND_TEMPERATURE])


@inner_kernel()
def _met(part, skew):
    """Share of int dx/h within which `part` of a piece's friction lies, from its exit on: its slope is 1/skew there
    and `skew` at the entrance, of friction factors whose ratio is skew^2."""
    return part / (part + skew * (1.0 - part))


@inner_kernel()
def _trial(f, area_a, area_b, p_high, p_low, pieces, mach, out):
    """M1^2 over that of the flow followed upstream from the exit, less 1, at a trial M1 = `mach`: below 0 where the
    flow is too small; NaN where it would have been sonic inside the dam.  Leaves the flow in `out`."""
    g = f[HEAT_RATIO]
    d = 0.5 * (g - 1.0)
    m = mach * mach
    p_1 = p_high * math.exp(-g / (2.0 * d) * math.log1p(d * m / (f[ENTRANCE_LOSS] * f[ENTRANCE_LOSS])))
    flow = p_1 * area_a * mach * math.sqrt(1.0 + d * m)
    out[MASS_FLOW] = flow * math.sqrt(g / (f[GAS_CONSTANT] * f[TEMPERATURE]))
    out[REYNOLDS] = 2.0 * out[MASS_FLOW] / _viscosity(f, f[TEMPERATURE] / (1.0 + d * m))
    # The exit: at the low pressure, or sonic.
    asked = (flow / (p_low * area_b)) ** 2
    m_2 = min(1.0, 2.0 * asked / (1.0 + math.sqrt(1.0 + 4.0 * d * asked)))
    out[ENTRANCE_MACH], out[EXIT_MACH] = mach, m_2
    state = 1.0 / m_2 + d
    f_b = blended_friction(f[LAMINAR], f[TURBULENT], out[REYNOLDS] * out[FIRST_PIECE + AT_EXIT])
    for piece in range(pieces):
        i = FIRST_PIECE + PIECE_SIZE * piece
        friction, skew = f_b, 1.0
        if f[LOCAL] != 0.0:
            middle = blended_friction(f[LAMINAR], f[TURBULENT], out[REYNOLDS] * out[i + AT_MIDDLE])
            f_a = blended_friction(f[LAMINAR], f[TURBULENT], out[REYNOLDS] * out[i + AT_ENTRANCE])
            skew = math.sqrt(f_b / f_a)
            # The area where half the friction lies is not that of the middle; again by a parabola.
            off = _met(0.5, skew) - 0.5
            friction = (f_b + 4.0 * middle + f_a) / 6.0 * math.exp(4.0 / 3.0 * out[i + GROWTH] * off)
            f_b = f_a
        wanted = 2.0 * g * friction * out[i + RESISTANCE]
        shape = 2.0 * out[i + GROWTH] / wanted
        # The trial before is a good start: most of t is friction.
        start = out[i + SPAN] * wanted / out[i + LOSS] if out[i + SPAN] > 0.0 else 0.0
        t, state_a = span(shape, state, wanted, start, d)
        out[i + LOSS], out[i + SKEW], out[i + SHAPE], out[i + STATE], out[i + SPAN] = wanted, skew, shape, state, t
        if t < 0.0:
            return math.nan
        state = state_a
    return m * (state - d) - 1.0


@inner_kernel()
def _largest_mach(f):
    """Mach number at the entrance with the largest flow through it: 1 without loss."""
    d, c = 0.5 * (f[HEAT_RATIO] - 1.0), f[ENTRANCE_LOSS] * f[ENTRANCE_LOSS]
    b = 1.0 + d - 2.0 * d * c
    return math.sqrt(2.0 * c / (b + math.sqrt(b * b + 4.0 * d * c)))


@inner_kernel()
def _first_guess(f, area_a, p_high, p_low, pieces, out):
    """Mach number at the entrance of laminar flow without inertia, bent down to what a sonic exit lets through (the
    last numbers by trying: 4.2 trials are left)."""
    resistance = growth = 0.0
    for piece in range(pieces - 1, -1, -1):
        i = FIRST_PIECE + PIECE_SIZE * piece
        own = out[i + RESISTANCE] / out[i + AT_MIDDLE]
        resistance += own * math.exp(-2.0 * growth) * shrinkage(2.0 * out[i + GROWTH])
        growth += out[i + GROWTH]
    speed = math.sqrt(f[HEAT_RATIO] * f[GAS_CONSTANT] * f[TEMPERATURE])
    resistance *= 24.0 * speed * _viscosity(f, f[TEMPERATURE]) / (p_high * area_a)
    drop = (p_high - p_low) * (p_high + p_low) / (p_high * p_high)
    choking = 2.0 + 8.0 * math.exp(-2.0 * growth)
    return 2.0 * drop / (resistance + math.sqrt(resistance * resistance + choking * drop))


@inner_kernel()
def _find_flow(f, area_a, area_b, p_high, p_low, pieces, out):
    """Finds M1, by inverse quadratic interpolation inside a bracket; the trial at M1 = 0 is known.  Returns SOLVED or
    a code of STATUS."""
    low, high = 0.0, _largest_mach(f)
    x_1, r_1 = 0.0, (p_low - p_high) * (p_low + p_high) / (p_high * p_high)
    x_2, r_2 = x_1, r_1
    x = min(_first_guess(f, area_a, p_high, p_low, pieces, out), 0.9 * high)
    for count in range(100):
        r = _trial(f, area_a, area_b, p_high, p_low, pieces, x, out)
        if r < 0.0:
            low = x
        else:
            high = x
        slope = (x - x_1) / (r - r_1) if r != r_1 else 0.0
        step = -r * slope
        if r_2 != r_1 and r_2 != r:
            step += r * r_1 * (slope - (x_1 - x_2) / (r_1 - r_2)) / (r - r_2)
        if abs(step) <= 1e-12 * x or high - low <= 1e-15 * high:
            break
        # Bisection where that leaves the bracket, is no number, or comes to no end.
        if not math.isnan(r):
            x_2, r_2, x_1, r_1 = x_1, r_1, x, r
        x = x + step if low < x + step < high and count % 12 != 11 else 0.5 * (low + high)
    if abs(r) < 1e-8:
        return SOLVED
    # A trial grows with M1 until it is no number, and is below 0 before that: without a root the entrance lets too
    # little through.
    r = _trial(f, area_a, area_b, p_high, p_low, pieces, _largest_mach(f), out)
    return NOT_FOUND if r >= 0.0 else ENTRANCE_CHOKED


@inner_kernel()
def _load(f, p_low, pieces, slope, direction, r_mean, out):
    """Writes FORCE and MOMENT of the flow found; `slope` of the film along the flow, which goes in `direction` (1: +r).
    Gauss points in sqrt(S_b + t): the pressure between parallel faces is a polynomial of that, over its square."""
    g, points = f[HEAT_RATIO], int(f[POINTS])
    d = 0.5 * (g - 1.0)
    flow = abs(out[MASS_FLOW]) * math.sqrt(f[GAS_CONSTANT] * f[TEMPERATURE] / g)
    force = moment = 0.0
    for piece in range(pieces):
        i = FIRST_PIECE + PIECE_SIZE * piece
        h_b, r_b, shape, state = out[i + FILM], out[i + RADIUS], out[i + SHAPE], out[i + STATE]
        loss, skew = out[i + LOSS], out[i + SKEW]
        v_b = math.sqrt(state)
        v_range = math.sqrt(state + out[i + SPAN]) - v_b
        for k in range(points):
            v = v_b + v_range * f[ABSCISSAE + k]
            here, spent = upstream(shape, state, (v - v_b) * (v + v_b), d)
            part = spent / loss
            length = out[LENGTH] * _met(part, skew)
            x = h_b * length * shrinkage(slope * length)
            h, r = h_b - slope * x, r_b - direction * x
            area = h
            if f[PIECES] > 0.0:
                area = h_b * r_b / r_mean * math.exp(-out[i + GROWTH] * part)
            dx = f[WEIGHTS + k] * v_range * 2.0 * v * h * out[LENGTH] / loss * (here - d - 1.0) / here
            gauge = flow * (here - d) / (area * math.sqrt(here)) - p_low
            if f[LOCAL] != 0.0:
                stretch = part + skew * (1.0 - part)
                dx *= skew / (stretch * stretch) * r / r_mean
            force += gauge * dx
            moment += gauge * dx * (r - r_mean)
    out[FORCE], out[MOMENT] = force, moment


@inner_kernel()
def pressure_inside(f, out, h_exit, h_entrance, r_exit, r_entrance, r):
    """Pressure (Pa) at radius `r` of the flow that `dam` has left in `out`; films (m) and radii (m) at the edge where
    it leaves and at the other."""
    g, pieces = f[HEAT_RATIO], max(int(f[PIECES]), 1)
    d, r_mean = 0.5 * (g - 1.0), 0.5 * (r_exit + r_entrance)
    flow = abs(out[MASS_FLOW]) * math.sqrt(f[GAS_CONSTANT] * f[TEMPERATURE] / g)
    share = (r - r_exit) / (r_entrance - r_exit)
    h = h_exit + (h_entrance - h_exit) * share
    # int dx/h from the exit, in pieces.
    rise = (h - h_exit) / h_exit
    length = share * abs(r_entrance - r_exit) / h_exit * (math.log1p(rise) / rise if rise != 0.0 else 1.0)
    piece = min(int(length / out[LENGTH]), pieces - 1)
    i = FIRST_PIECE + PIECE_SIZE * piece
    part, state = _met(min(max(length / out[LENGTH] - piece, 0.0), 1.0), 1.0 / out[i + SKEW]), out[i + STATE]
    if part > 0.0:
        state = span(out[i + SHAPE], state, out[i + LOSS] * part, 0.0, d)[1]
    area = h
    if f[PIECES] > 0.0:
        area = out[i + FILM] * out[i + RADIUS] / r_mean * math.exp(-out[i + GROWTH] * part)
    return flow * (state - d) / (area * math.sqrt(state))


@outer_kernel()
def dam(f, inner_film, outer_film, inner_pressure, outer_pressure, out):
    """Flow across a sector of the dam: parameter block `f` (BLOCK_SIZE,), films (m) and pressures (Pa) at the inner and
    the outer radius -> `out` (DAM_SIZE,), slots FORCE to REYNOLDS; total pressure on the higher side, static on the
    lower.  Returns SOLVED, or a code of STATUS with these slots zero."""
    out[:LENGTH] = 0.0
    if not (inner_film > 0.0 and outer_film > 0.0 and inner_pressure > 0.0 and outer_pressure > 0.0):
        return NO_FILM
    if inner_pressure == outer_pressure:
        return SOLVED
    direction = 1.0
    r_a, r_b, h_a, h_b = f[INNER_RADIUS], f[OUTER_RADIUS], inner_film, outer_film
    p_high, p_low = inner_pressure, outer_pressure
    if inner_pressure < outer_pressure:
        direction = -1.0
        r_a, r_b, h_a, h_b, p_high, p_low = r_b, r_a, h_b, h_a, p_low, p_high
    r_mean = 0.5 * (r_a + r_b)
    pieces = _divide(f, h_b, h_a, r_b, r_a, out)
    # Areas over the mean circumference.
    area_a, area_b = h_a, h_b
    if f[PIECES] > 0.0:
        area_a, area_b = h_a * r_a / r_mean, h_b * r_b / r_mean
    code = _find_flow(f, area_a, area_b, p_high, p_low, pieces, out)
    if code != SOLVED:
        out[:LENGTH] = 0.0
        return code
    _load(f, p_low, pieces, (h_b - h_a) / abs(r_b - r_a), direction, r_mean, out)
    out[MASS_FLOW] *= direction
    out[EXIT_MACH] = math.sqrt(out[EXIT_MACH])
    return SOLVED
