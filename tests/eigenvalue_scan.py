"""Stability of an aligned seal the long way, importing nothing of the package: film coefficients by quadrature in
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
    in a small motion of the gap)."""
    if film["kind"] == "given":
        return tuple(mp.mpf(x) for x in film["numbers"])
    names = ("inner_radius", "outer_radius", "clearance", "coning", "viscosity")
    r_i, r_o, clearance, coning, mu = (mp.mpf(film[name]) for name in names)
    drop, width, r_m = mp.mpf(film["outer_pressure"]) - mp.mpf(film["inner_pressure"]), r_o - r_i, (r_i + r_o) / 2
    if film["kind"] == "green":
        h_o = clearance + coning * width
        both, y = clearance + h_o, (h_o - clearance) / (h_o + clearance)
        squeeze = (mp.atanh(y) - y) / y**3 if y else mp.mpf(1) / 3
        tilt_k = mp.pi * drop * (coning * r_i - clearance) * (r_m * width / both) ** 2
        tilt_d = 24 * mp.pi * mu * r_m**3 * (width / both) ** 3 * squeeze
        return tilt_k, tilt_d, 2 * mp.pi * r_m * width * drop * (h_o - clearance) / both**2, 2 * tilt_d / r_m**2

    def h(r):
        return clearance + coning * (r - r_i)

    def integral(power, of_h):
        panels, x = width / 4, [(r_i + (k + 0.5 + node / 2) * width / 4, w) for k in range(4) for node, w in gauss()]
        return panels / 2 * mp.fsum(w * r**power / h(r) ** of_h for r, w in x)

    # Flow along the radius is a h^3 p' / 12 mu with a = r, or 1 on the planar face.
    a = 0 if film["planar"] else 1
    line = integral(-a, 3)
    flow = drop / line

    def motion(reach, power, arm):
        """Minus what the pressure does to `-int r^power p' / power dr` when the gap widens by 1 or the arm, and when
        it does so at unit rate; the gap widens by `reach` r^`arm`."""
        level = integral(power - a, 3) / line
        stiffness = -3 * flow * reach * (integral(power - a + arm, 4) - level * integral(arm - a, 4))
        # Phi' = a m, with m the widening.
        grown = a + arm + 1
        damping = 12 * mu * reach / grown * (integral(power - a + grown, 3) - level * integral(grown - a, 3))
        return stiffness / power, damping / power

    axial = [2 * mp.pi * x for x in motion(mp.mpf(1), 2, 0)]
    tilt = [mp.pi * x for x in (motion(r_m, 3, 0) if film["mean"] else motion(mp.mpf(1), 3, 1))]
    return tuple(tilt + axial)


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
