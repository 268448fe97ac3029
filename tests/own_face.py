"""Film and asperities between two plane or coned faces, tilted and moving, in the tests' own words: nothing of the
program.

The film flows radially only.  Gauss points over radii along which the film at most doubles; angles evenly around the
circle or, of rough faces, Gauss points between the kinks.
"""

import math

import numpy as np
from numba import njit
from numpy.polynomial.chebyshev import chebval, chebvander
from numpy.polynomial.legendre import leggauss

# Gauss points on (0, 1): of a radial panel, and of a panel of angles.
X_R, W_R = (part / 2 for part in leggauss(12))
X_A, W_A = (part / 2 for part in leggauss(20))
X_R, X_A = X_R + 0.5, X_A + 0.5
# Laws of contact.
NONE, CHRISTENSEN, GAUSSIAN = 0, 1, 2
# What `face_loads` gives: of the film, then of the asperities.
FORCE, MOMENT_X, MOMENT_Y, FLOW, DRAG, PRESS, PRESS_X, PRESS_Y, RUB = range(9)


# --- asperities ---------------------------------------------------------------------------------------


def gaussian_integrals(x, power):
    """Greenwood and Williamson's integrals of (s - x)^power over the standard normal heights s > x, for -3 < x < 5."""
    points, weights = leggauss(80)
    # s = x + t^2 takes the root away; heights above 9 count for nothing.
    longest = np.sqrt(9.0 - x)
    t = longest[:, None] * (points + 1.0) / 2
    heights = np.exp(-0.5 * (x[:, None] + t**2) ** 2) / math.sqrt(2 * math.pi)
    return (heights * t ** (2 * power) * 2 * t) @ weights * longest / 2


def gaussian_series(power):
    """The polynomial that the program has for these integrals: (u^4 Q)(x), u = (5 - x)/8, Q of degree 16 in 2u - 1, by
    least squares, relative where they are above 1e-5.  Chebyshev's coefficients (17,) of Q."""
    v = np.cos(np.pi * (np.arange(800) + 0.5) / 800)
    exact = gaussian_integrals(1.0 - 4.0 * v, power)
    weight = (exact + 1e-5) ** -0.75
    matrix = ((1.0 + v) / 2)[:, None] ** 4 * chebvander(v, 16)
    return np.linalg.lstsq(weight[:, None] * matrix, weight * exact, rcond=None)[0]


def gaussian_law(power):
    """The same in pieces (32, 14): a polynomial over each quarter of x."""
    q = gaussian_series(power)
    places = np.cos(np.pi * (np.arange(14) + 0.5) / 14)
    x = -3.0 + 0.25 * (np.arange(32)[:, None] + 0.5 + 0.5 * places)
    values = ((5.0 - x) / 8.0) ** 4 * chebval((1.0 - x) / 4.0, q)
    return np.linalg.solve(np.vander(places, increasing=True), values.T).T


PRESSURE_LAW, SHARE_LAW = gaussian_law(1.5), gaussian_law(1.0)


@njit(cache=True)
def touch(law, x):
    """Contact pressure and touching share, over their units, at h over the law's length (Christensen's half height, or
    the rms of Gaussian heights)."""
    if law == CHRISTENSEN:
        if x >= 1.0:
            return 0.0, 0.0
        x = max(x, -1.0)
        share = 0.5 - 35.0 / 32.0 * (x - x**3 + 0.6 * x**5 - x**7 / 7.0)
        return share, share
    if x >= 5.0:
        return 0.0, 0.0
    place = (max(x, -3.0) + 3.0) * 4.0
    k = min(int(place), 31)
    s, pressure, share = 2.0 * (place - k) - 1.0, 0.0, 0.0
    for n in range(13, -1, -1):
        pressure, share = pressure * s + PRESSURE_LAW[k, n], share * s + SHARE_LAW[k, n]
    return pressure, share


# --- where the integrands are smooth ------------------------------------------------------------------


@njit(cache=True)
def flow_film(h, floor):
    """Film thickness that the flow feels at an edge of rough faces: below `floor` a hyperbola with the same slope."""
    return h if h >= floor else floor * floor / (2.0 * floor - h)


@njit(cache=True)
def angles_and_weights(edges, g_x, g_y, levels):
    """Angles and weights of the circle.  Without `levels` (m) evenly, as many as the thinnest film needs; else panels
    that end where an edge of the face passes a level, closer where the film is thin; `edges` ((h, r), (h, r)) (m)."""
    g = math.hypot(g_x, g_y)
    if len(levels) == 0:
        distance = 3.0
        if g > 0.0:
            for h, r in edges:
                distance = min(distance, math.acosh(max(h / (r * g), 1.0 + 1e-7)))
        count = 32 + int(50.0 / distance)
        return np.arange(count) * (2 * math.pi / count), np.full(count, 2 * math.pi / count)
    ends = [0.0]
    for k in range(7):
        ends.append(math.pi / 2**k)
    for h, r in edges:
        for level in levels:
            # h - r g cos(angle from the thinnest place) = level
            if abs(h - level) < r * g:
                ends.append(math.acos((h - level) / (r * g)))
    ends = np.sort(np.array(ends))
    thinnest, points, n = math.atan2(-g_x, g_y), len(X_A), 0
    angles, weights = np.empty((2, 2 * points * (len(ends) - 1)))
    for k in range(len(ends) - 1):
        width = ends[k + 1] - ends[k]
        for j in range(points):
            for side in (-1.0, 1.0):
                angles[n], weights[n] = thinnest + side * (ends[k] + width * X_A[j]), width * W_A[j]
                n += 1
    return angles, weights


@njit(cache=True)
def radial_panels(r_i, r_o, gap_i, gap_o, film_i, film_o, levels, ends):
    """Ends of radial panels, into `ends`, and how many: the film at most doubles, and the gap passes no level."""
    ends[0], ends[1], n = r_i, r_o, 2
    for level in levels:
        if min(gap_i, gap_o) < level < max(gap_i, gap_o):
            ends[n] = r_i + (level - gap_i) / (gap_o - gap_i) * (r_o - r_i)
            n += 1
    film = 2.0 * min(film_i, film_o)
    while film < max(film_i, film_o):
        ends[n] = r_i + (film - film_i) / (film_o - film_i) * (r_o - r_i)
        film *= 2.0
        n += 1
    ends[:n] = np.sort(ends[:n])
    return n


# --- loads --------------------------------------------------------------------------------------------


@njit(cache=True)
def face_loads(face, conditions, gap, law, contact, levels):
    """Loads of film and asperities on the stator (N, N m), flow outwards at the inner radius (m^3/s), and torques that
    the shaft supplies (N m), (9,); nan where smooth faces meet.

    face (r_i, r_o, coning, floor); conditions (viscosity, p_i, p_o, stator and rotor speed); gap (h at r_i without
    tilt, g_x, g_y and their rates); contact (length of the law, its units of pressure and of share, friction of
    pressure and of share); levels: gaps (m) where contact has kinks.
    """
    r_i, r_o, coning, floor = face
    mu, p_i, p_o, spin_s, spin_r = conditions
    aligned, g_x, g_y, h_rate, g_x_rate, g_y_rate = gap
    width, g = r_o - r_i, math.hypot(g_x, g_y)
    out, ends = np.zeros(9), np.empty(64)
    edges = ((aligned, r_i), (aligned + coning * width, r_o))
    if law == NONE and not (edges[0][0] > r_i * g and edges[1][0] > r_o * g):
        return out * np.nan
    angles, weights = angles_and_weights(edges, g_x, g_y, levels)
    for angle, weight in zip(angles, weights):  # noqa: B905
        sin, cos = math.sin(angle), math.cos(angle)
        tilt = g_x * sin - g_y * cos
        # dh/dt + mean spin dh/dtheta = h_rate + r turned
        turned = g_x_rate * sin - g_y_rate * cos + 0.5 * (spin_s + spin_r) * (g_x * cos + g_y * sin)
        h_i, h_o = edges[0][0] + r_i * tilt, edges[1][0] + r_o * tilt
        # Between rough faces the film is linear between its edges, also where only one of these is below the floor.
        film_i, film_o = flow_film(h_i, floor), flow_film(h_o, floor)
        a, b, c, d, e, f, drag = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(radial_panels(r_i, r_o, h_i, h_o, film_i, film_o, levels, ends) - 1):
            length = ends[k + 1] - ends[k]
            middle = h_i + (h_o - h_i) * (0.5 * (ends[k] + ends[k + 1]) - r_i) / width
            near = law != NONE and middle < levels[0]
            for j in range(len(X_R)):
                r, dr = ends[k] + length * X_R[j], length * W_R[j]
                film = film_i + (film_o - film_i) * (r - r_i) / width
                # r h^3 p'/(12 mu) = q + constant
                q = h_rate * (r * r - r_i * r_i) / 2.0 + turned * (r**3 - r_i**3) / 3.0
                one = dr / film**3
                a, b = a + one / r, b + one * q / r
                c, d = c + one * r, d + one * q * r
                e, f = e + one * r * r, f + one * q * r * r
                drag += dr * r**3 / film
                if near:
                    pressure, share = touch(law, (h_i + (h_o - h_i) * (r - r_i) / width) / contact[0])
                    pressure, share = weight * dr * r * pressure * contact[1], weight * dr * r * share * contact[2]
                    out[PRESS] += pressure
                    out[PRESS_X] += r * sin * pressure
                    out[PRESS_Y] -= r * cos * pressure
                    out[RUB] += r * (contact[3] * pressure + contact[4] * share)
        # Pressures at both edges give the constant; loads by parts.
        constant = ((p_o - p_i) / (12.0 * mu) - b) / a
        moment = (p_o * r_o**3 - p_i * r_i**3) / 3.0 - 4.0 * mu * (f + constant * e)
        out[FORCE] += weight * ((p_o * r_o**2 - p_i * r_i**2) / 2.0 - 6.0 * mu * (d + constant * c))
        out[MOMENT_X] += weight * moment * sin
        out[MOMENT_Y] -= weight * moment * cos
        out[FLOW] -= weight * constant
        out[DRAG] += weight * mu * (spin_r - spin_s) * drag
    # Integral of (h/2) r dp/dtheta, by parts over the circle.
    out[DRAG] += 0.5 * (g_x * out[MOMENT_Y] - g_y * out[MOMENT_X])
    out[RUB] *= np.sign(spin_r - spin_s)
    return out
