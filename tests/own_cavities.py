"""The cavitating film between a wavy and a flat face in words of its own: cells of a liquid that is a little soft
(Elrod's way), filled and emptied until nothing changes; nothing here chooses which cells are full."""

import numpy as np
from scipy.integrate import solve_ivp

SOFT = 3e3


def steady(inner, outer, low, high, viscosity, spin, thickness, cells):
    """Pressures (Pa, above cavitation) and fill (cells_r, cells_theta) of the film at rest.

    Radii in m, pressures `low` inside and `high` outside above cavitation; `spin` the mean of both faces (rad/s);
    `thickness(theta)` (m) of an array of angles; even cells in ln r and theta."""
    n_r, n_t = cells
    du, dt = np.log(outer / inner) / n_r, 2.0 * np.pi / n_t
    r = inner * np.exp((np.arange(n_r) + 0.5) * du)
    theta = dt * np.arange(n_t)
    h, h_next = thickness(theta), thickness(theta + 0.5 * dt)
    area = r[:, None] ** 2 * np.sinh(du) * np.ones(n_t)
    stiff = SOFT * max(high, low)

    def pressure(fill):
        return stiff * np.maximum(fill - 1.0, 0.0)

    def rate(_, y):
        fill = y.reshape(n_r, n_t)
        p, full = pressure(fill), np.minimum(fill, 1.0)
        padded = np.vstack([2.0 * low - p[:1], p, 2.0 * high - p[-1:]])
        outwards = -(h**3) / (12.0 * viscosity) * np.diff(padded, axis=0) / du
        along = h_next**3 / (12.0 * viscosity) * (p - np.roll(p, -1, 1)) / dt
        dragged = spin * h_next * full
        gained = (outwards[:-1] - outwards[1:]) / du + (np.roll(along, 1, 1) - along) / dt
        filled = gained / r[:, None] ** 2 * du / np.sinh(du) + (np.roll(dragged, 1, 1) - dragged) / dt
        return (filled / h).ravel()

    start = np.full(n_r * n_t, 1.0 + 0.3 / SOFT)
    found = solve_ivp(rate, (0.0, 60.0 / spin), start, method="Radau", rtol=1e-8, atol=1e-11)
    fill = found.y[:, -1].reshape(n_r, n_t)
    p = pressure(fill)
    return p, np.minimum(fill, 1.0), float((p * area).sum() * dt)
