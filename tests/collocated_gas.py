"""The steady gas Reynolds equation by collocation: Chebyshev points over the radius, Fourier around the circle; imports
nothing of the package."""

import numpy as np

R_AIR = 287.053


def chebyshev(low, high, n):
    """Points from `low` to `high`, matrix of the derivative there, weights of the integral."""
    j = np.arange(n + 1)
    x = -np.cos(np.pi * j / n)
    basis = np.polynomial.chebyshev.chebvander(x, n)
    slopes = np.array(
        [np.polynomial.chebyshev.chebval(x, np.polynomial.chebyshev.chebder(row)) for row in np.eye(n + 1)]
    )
    integrals = [0.0 if k % 2 else 2.0 / (1 - k * k) for k in range(n + 1)]
    half = 0.5 * (high - low)
    return low + half * (1 + x), np.linalg.solve(basis.T, slopes).T / half, half * np.linalg.solve(basis.T, integrals)


def fourier(n):
    """Even angles and the matrix of the derivative there (n even)."""
    k = np.arange(n)
    gap = (k[:, None] - k[None, :]) * np.pi / n
    with np.errstate(divide="ignore"):
        matrix = np.where(gap == 0.0, 0.0, 0.5 * (-1.0) ** (k[:, None] - k[None, :]) / np.tan(gap))
    return 2 * np.pi * k / n, matrix


def collocated(film, height, height_rate, spin, slip=False, radii=24, angles=48):
    """Steady pressures by Newton's method at Chebyshev points times even angles,

        wm d(p h)/dtheta + p dh/dt = div(h^3 p (1 + 6 Kn) grad p)/(12 mu),

    for functions `height(r, theta)` and `height_rate(r, theta)`: force, both moments, flow at both radii at normal
    conditions, friction torque."""
    r, d_r, w = chebyshev(film.inner_radius, film.outer_radius, radii)
    theta, d_theta = fourier(angles)
    n, m = len(r), len(theta)
    along, around = np.kron(d_r, np.eye(m)), np.kron(np.eye(n), d_theta)
    rr, tt = (a.ravel() for a in np.meshgrid(r, theta, indexing="ij"))
    h, h_rate, wm = height(rr, tt), height_rate(rr, tt), 0.5 * spin
    free_path = film.viscosity * np.sqrt(np.pi * R_AIR * film.temperature / 2) if slip else 0.0
    mu, edge = 12 * film.viscosity, (rr == r[0]) | (rr == r[-1])
    p_i, p_o = film.inner_pressure, film.outer_pressure
    p = np.sqrt(p_i**2 + (p_o**2 - p_i**2) * np.log(rr / r[0]) / np.log(r[-1] / r[0]))
    for _ in range(60):
        way = h**3 * p + 6 * free_path * h**2
        p_r, p_t = along @ p, around @ p
        left = wm * around @ (p * h) + p * h_rate
        left -= (along @ (rr * way * p_r) / rr + around @ (way * p_t) / rr**2) / mu
        by_r = (rr * h**3 * p_r)[:, None] * np.eye(n * m) + (rr * way)[:, None] * along
        by_t = (h**3 * p_t)[:, None] * np.eye(n * m) + way[:, None] * around
        matrix = (
            wm * around * h + np.diag(h_rate) - ((along @ by_r) / rr[:, None] + (around @ by_t) / rr[:, None] ** 2) / mu
        )
        left[edge], matrix[edge] = 0.0, np.eye(n * m)[edge]
        step = np.linalg.solve(matrix, -left)
        p = np.maximum(p + step, 0.3 * p)
        if np.max(np.abs(step)) < 1e-11 * np.max(p):
            break
    else:
        raise AssertionError("no steady pressures")
    cell = np.repeat(w, m) * 2 * np.pi / m
    way = (h**3 * p + 6 * free_path * h**2) * (along @ p) * rr / mu * 2 * np.pi / m
    normal = 273.15 / (film.temperature * 101325.0)
    torque = film.viscosity * spin * rr**3 / h + 0.5 * h * rr * (around @ p)
    return np.array(
        [np.sum(cell * rr * p), np.sum(cell * rr**2 * p * np.sin(tt)), -np.sum(cell * rr**2 * p * np.cos(tt)),
         -normal * np.sum(way[rr == r[0]]), -normal * np.sum(way[rr == r[-1]]), np.sum(cell * torque)]
    )  # fmt: skip
