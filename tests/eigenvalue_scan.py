"""Stability of an aligned seal the long way, with nothing of the package: film coefficients by quadrature in
mpmath, eigenvalues in mpmath, thresholds by a dense scan over the shaft speed.

A seal is a dict of plain SI numbers: `film` (see `film_numbers`), `rings` {"stator": ..., "rotor": ...} of those that
float, each a dict of mass, transverse, polar, axial_stiffness, axial_damping, tilt_stiffness, tilt_damping;
`stator_speed`.  One complex unknown stands for both tilts of a ring, tilt_x + i tilt_y = exp(s t):

    P(s) = I s^2 + (D - i J W) s + K - i W D    for the ring alone, W its spin;  axially the same without spin, m for I
    F(s) = K_f + (s - i wm) D_f                 for the film, wm the half sum of both spins
"""

from functools import cache
from itertools import pairwise

import mpmath as mp
import numpy as np
from own_face import gaussian_series

DIGITS = 40


@cache
def gauss(points=30) -> list:
    """Gauss-Legendre nodes and weights on [-1, 1]: pairs of mpmath numbers."""
    found = []
    for x in np.polynomial.legendre.leggauss(points)[0]:
        x = mp.findroot(lambda t: mp.legendre(points, t), mp.mpf(float(x)))
        slope = points * (mp.legendre(points - 1, x) - x * mp.legendre(points, x)) / (1 - x * x)
        found.append((x, 2 / ((1 - x * x) * slope**2)))
    return found


def film_numbers(film: dict) -> tuple:
    """Tilt stiffness and damping, axial stiffness and damping of the aligned film, as mpmath numbers: `kind` "given"
    (`numbers`), "green" (the narrow seal's formulas) or "radial" (Reynolds' equation along the radius, to first order
    in a small motion of the gap); with `rough` (3 rms heights in m, unit of pressure in Pa) of asperities too, below
    0.6 of which the radial film has the edges H = f^2 / (2 f - h)."""
    found = _smooth_numbers(film)
    if "rough" not in film:
        return found
    tilt, axial = asperity_stiffness(film)
    return found[0] + tilt, found[1], found[2] + axial, found[3]


def asperity_stiffness(film: dict) -> tuple:
    """Tilt (N m/rad) and axial (N/m) stiffness of the asperities of aligned faces: the slope of their pressure, summed
    over the face where they meet.  Christensen's: strength 35 (c^2 - h^2)^3 / 32 c^7 below c; `gaussian` ones: that of
    the polynomial in own_face.py, below 5 rms."""
    r_i, r_o, clearance, coning, c, strength = (
        mp.mpf(x) for x in (*(film[n] for n in ("inner_radius", "outer_radius", "clearance", "coning")), *film["rough"])
    )
    ends, top = [r_i, r_o], c
    if film["gaussian"]:
        q, top = gaussian_slope(), 5 * c / 3
    if coning and r_i < r_i + (top - clearance) / coning < r_o:
        # Exact for polynomials: the asperities meet on one side of this radius only.
        ends.insert(1, r_i + (top - clearance) / coning)
    total = [mp.mpf(0), mp.mpf(0)]
    for a, b in pairwise(ends):
        for x, w in gauss():
            r = (a + b) / 2 + (b - a) / 2 * x
            h = clearance + coning * (r - r_i)
            if h < top:
                steep = 35 * (c * c - h * h) ** 3 / (32 * c**7)
                if film["gaussian"]:
                    steep = mp.polyval(q, (top - h) / (8 * c / 3), asc=True) / (8 * c / 3)
                slope = (b - a) / 2 * w * strength * steep
                arm = (r_i + r_o) / 2 if film["mean"] else r
                total = [total[0] + slope * mp.pi * r * arm**2, total[1] + slope * 2 * mp.pi * r]
    return tuple(total)


@cache
def gaussian_slope() -> list:
    """Slope by u of the polynomial u^4 Q(2u - 1) for the pressure of Gaussian asperities, lowest power first."""
    # T_0, T_1, ... as polynomials of u, lowest power first.
    before, here, found = [mp.mpf(1)], [mp.mpf(-1), mp.mpf(2)], [mp.mpf(0)] * 21
    for coefficient in gaussian_series(1.5):
        for power, x in enumerate(before):
            found[power + 4] += mp.mpf(float(coefficient)) * x
        twice = product(here, [mp.mpf(-2), mp.mpf(4)])
        before, here = here, [x - (before[k] if k < len(before) else 0) for k, x in enumerate(twice)]
    return [power * x for power, x in enumerate(found)][1:]


def _smooth_numbers(film: dict) -> tuple:
    if film["kind"] == "given":
        return tuple(mp.mpf(x) for x in film["numbers"])
    names = ("inner_radius", "outer_radius", "clearance", "coning", "viscosity")
    r_i, r_o, clearance, coning, mu = (mp.mpf(film[name]) for name in names)
    drop, width, r_m = mp.mpf(film["outer_pressure"]) - mp.mpf(film["inner_pressure"]), r_o - r_i, (r_i + r_o) / 2
    edges = clearance, clearance + coning * width
    if film["kind"] == "green":
        both, y = edges[0] + edges[1], (edges[1] - edges[0]) / (edges[0] + edges[1])
        squeeze = (mp.atanh(y) - y) / y**3 if y else mp.mpf(1) / 3
        tilt_k = mp.pi * drop * (coning * r_i - clearance) * (r_m * width / both) ** 2
        tilt_d = 24 * mp.pi * mu * r_m**3 * (width / both) ** 3 * squeeze
        return tilt_k, tilt_d, 2 * mp.pi * r_m * width * drop * (edges[1] - edges[0]) / both**2, 2 * tilt_d / r_m**2
    # What the edges of the film do when those of the gap move by 1.
    floor = mp.mpf("0.6") * film["rough"][0] if "rough" in film else 0
    gain = [mp.mpf(1) if h >= floor else (floor / (2 * floor - h)) ** 2 for h in edges]
    edges = [h if h >= floor else floor**2 / (2 * floor - h) for h in edges]

    def h(r):
        return edges[0] + (edges[1] - edges[0]) * (r - r_i) / width

    def integral(power, of_h):
        panels, x = width / 4, [(r_i + (k + 0.5 + node / 2) * width / 4, w) for k in range(4) for node, w in gauss()]
        return panels / 2 * mp.fsum(w * r**power / h(r) ** of_h for r, w in x)

    # Flow along the radius is a h^3 p' / 12 mu with a = r, or 1 on the planar face.
    a = 0 if film["planar"] else 1
    line = integral(-a, 3)
    flow = drop / line

    def stiffness(at_i, at_o, power):
        """Minus what the pressure does to `-int r^power p' / power dr` when the edges widen by `at_i` and `at_o`."""
        level, slope = integral(power - a, 3) / line, (at_o - at_i) / width
        parts = [integral(power - a + n, 4) - level * integral(n - a, 4) for n in (0, 1)]
        return -3 * flow * ((at_i - slope * r_i) * parts[0] + slope * parts[1]) / power

    def damping(reach, power, arm):
        """The same when the gap widens at a unit rate by `reach` r^`arm`: Phi' = a m, with m the widening."""
        level, grown = integral(power - a, 3) / line, a + arm + 1
        part = integral(power - a + grown, 3) - level * integral(grown - a, 3)
        return 12 * mu * reach / grown * part / power

    arms = (r_m, r_m) if film["mean"] else (r_i, r_o)
    tilt_k = mp.pi * stiffness(gain[0] * arms[0], gain[1] * arms[1], 3)
    tilt_d = mp.pi * (damping(r_m, 3, 0) if film["mean"] else damping(mp.mpf(1), 3, 1))
    return tilt_k, tilt_d, 2 * mp.pi * stiffness(*gain, 2), 2 * mp.pi * damping(mp.mpf(1), 2, 0)


def product(p, q):
    """Product of two polynomials, highest power first."""
    out = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            out[i + j] += x * y
    return out


def total(p, q):
    """Sum of two polynomials, highest power first."""
    longest = max(len(p), len(q))
    p, q = [0] * (longest - len(p)) + p, [0] * (longest - len(q)) + q
    return [x + y for x, y in zip(p, q, strict=True)]


def polynomial(alone, film):
    """The determinant of one or two rings, each `alone` [2, 1, 0], on one film [1, 0]; without leading zeros."""
    if len(alone) == 1:
        found = total(alone[0], film)
    else:
        # | P_s + F    -F   |
        # |   -F     P_r + F |
        found = total(product(total(alone[0], film), total(alone[1], film)), [-x for x in product(film, film)])
        # F^2 cancels, so that massless rings leave true zeros in front only if it never stood there.
        found = total(product(film, total(alone[0], alone[1])), product(alone[0], alone[1]))
    while found and found[0] == 0:
        found = found[1:]
    return found


def tilt_polynomial(seal, numbers, speed, real=mp.mpf, i=mp.j):
    """Of the tilts, at a shaft speed (rad/s)."""
    k_f, d_f = (real(x) for x in numbers[:2])
    w = {"rotor": real(speed), "stator": real(seal["stator_speed"])}
    mean = (w["rotor"] + w["stator"]) / 2
    alone = []
    for name, ring in seal["rings"].items():
        inertia, polar = real(ring["transverse"]), real(ring["polar"])
        k, d = real(ring["tilt_stiffness"]), real(ring["tilt_damping"])
        alone.append([inertia, d - i * polar * w[name], k - i * w[name] * d])
    return polynomial(alone, [d_f, k_f - i * mean * d_f])


def axial_polynomial(seal, numbers):
    """Of the axial motion."""
    alone = [[mp.mpf(ring[x]) for x in ("mass", "axial_damping", "axial_stiffness")] for ring in seal["rings"].values()]
    return polynomial(alone, [numbers[3], numbers[2]])


def roots(coefficients) -> list:
    """Roots of a polynomial, highest power first, in mpmath."""
    n = len(coefficients) - 1
    if n < 1:
        return []
    if n == 1:
        return [-coefficients[1] / coefficients[0]]
    if n == 2:
        a, b, c = coefficients
        root = mp.sqrt(b * b - 4 * a * c)
        return [(-b + root) / (2 * a), (-b - root) / (2 * a)]
    matrix = mp.matrix(n, n)
    for k in range(n):
        matrix[0, k] = -coefficients[k + 1] / coefficients[0]
    for k in range(n - 1):
        matrix[k + 1, k] = 1
    return list(mp.eig(matrix, left=False, right=False))


def largest(coefficients):
    """Largest real part, None of a constant."""
    found = roots(coefficients)
    return max(mp.re(root) for root in found) if found else None


def growth(seal) -> dict:
    """Largest real parts (1/s) of the tilts, of the axial motion and of both at `speed`; None without an eigenvalue."""
    with mp.workdps(DIGITS):
        numbers = film_numbers(seal["film"])
        tilt, axial = largest(tilt_polynomial(seal, numbers, seal["speed"])), largest(axial_polynomial(seal, numbers))
        every = [x for x in (tilt, axial) if x is not None]
        return {"tilt": tilt, "axial": axial, "all": max(every) if every else None}


def thresholds(seal, points=400, low=1e-3, high=10.0) -> list[float]:
    """Every shaft speed between `low` and `high` times `speed` at which the largest growth rate of the tilts changes
    sign: a dense scan, in double precision where that can tell the sign, else in mpmath; between its points too where
    the rate comes near zero and turns back."""
    with mp.workdps(DIGITS):
        numbers = film_numbers(seal["film"])
        floats = [float(x) for x in numbers]

        def exact(w):
            found = roots(tilt_polynomial(seal, numbers, w))
            if not found:
                return mp.mpf(0)
            rate = max(mp.re(root) for root in found)
            # What is left of a root that does not move off the axis is rounding in 40 digits.
            return rate if abs(rate) > mp.mpf(10) ** (6 - DIGITS) * max(abs(root) for root in found) else mp.mpf(0)

        def rate(w):
            found = np.roots(tilt_polynomial(seal, floats, w, float, 1j))
            if len(found) and abs(max(found.real)) > 1e-11 * max(abs(found)):
                return float(max(found.real))
            return float(exact(w))

        speeds = [float(w) for w in seal["speed"] * np.geomspace(low, high, points)]
        rates = [rate(w) for w in speeds]
        for k in range(1, points - 1):
            before, here, after = rates[k - 1 : k + 2]
            turns = here * before > 0 and here * after > 0 and abs(here) < min(abs(before), abs(after))
            if turns:
                extra = closest(rate, speeds[k - 1], speeds[k + 1])
                speeds.append(extra)
                rates.append(rate(extra))
        signs = [(w, np.sign(r)) for w, r in sorted(zip(speeds, rates, strict=True)) if r]
        found = []
        for (a, s), (b, t) in pairwise(signs):
            if s != t:
                found.append(float(crossing(exact, mp.mpf(a), mp.mpf(b))))
        return found


def closest(function, a, b) -> float:
    """Where a function of one sign at a and b comes nearest to zero or beyond it: golden section."""
    golden, side = (5**0.5 - 1) / 2, np.sign(function(a))
    x, y = b - golden * (b - a), a + golden * (b - a)
    f_x, f_y = side * function(x), side * function(y)
    for _ in range(40):
        if min(f_x, f_y) < 0.0:
            break
        if f_x < f_y:
            b, y, f_y = y, x, f_x
            x = b - golden * (b - a)
            f_x = side * function(x)
        else:
            a, x, f_x = x, y, f_y
            y = a + golden * (b - a)
            f_y = side * function(y)
    return x if f_x < f_y else y


def crossing(function, a, b):
    """Zero of a function in a bracket, to 1e-14 of it: the false position of Illinois."""
    f_a, f_b, kept = function(a), function(b), 0
    for _ in range(200):
        x = (a * f_b - b * f_a) / (f_b - f_a)
        f_x = function(x)
        if f_x == 0 or abs(b - a) < mp.mpf(10) ** -14 * abs(b):
            return x
        if mp.sign(f_x) == mp.sign(f_b):
            b, f_b, f_a, kept = x, f_x, f_a / 2 if kept == 1 else f_a, 1
        else:
            a, f_a, f_b, kept = x, f_x, f_b / 2 if kept == -1 else f_b, -1
    raise ValueError("no zero found")
