"""Wavy rough faces that wear, in words of its own: cells over radius and angle of one wave, each with its own depth;
cavities by which cells are full; Archard's law at every cell, in even depths of wear by Heun's method."""

import numpy as np
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve


def touching(x):
    """Share of Christensen's heights in contact at mean film x (over their half height)."""
    x = np.clip(x, -1.0, 1.0)
    return 0.5 - 35 / 32 * (x - x**3 + 0.6 * x**5 - x**7 / 7)


def mean(x):
    """Mean film between them."""
    y = np.clip(x, -1.0, 1.0)
    inside = 35 / 256 + y / 2 + 35 * y**2 / 64 - 35 * y**4 / 128 + 7 * y**6 / 64 - 5 * y**8 / 256
    return np.where(x >= 1.0, x, inside)


def cubed(x):
    """Mean cube of it."""
    y = np.clip(x, -1.0, 1.0)
    inside = 7 / 256 + y / 6 + 105 * y**2 / 256 + y**3 / 2 + 35 * y**4 / 128
    inside = inside - 7 * y**6 / 128 + 3 * y**8 / 256 - y**10 / 768
    return np.where(x >= 1.0, x**3 + x / 3.0, inside)


class WavyFaces:
    """The seal of Lebeck's Table 3-1, in its units (outer radius, half height, viscosity x speed x (r_o/c)^2)."""

    def __init__(self, order, cells, sealed=0.005, strength=0.5, inner=0.9, balance=0.75):
        self.order, self.sealed, self.strength = order, sealed, strength
        n_r, n_t = cells
        self.dr, self.dt = (1.0 - inner) / n_r, 2.0 * np.pi / order / n_t
        self.r = inner + (np.arange(n_r) + 0.5) * self.dr
        self.edge = inner + np.arange(n_r + 1) * self.dr
        self.wave = np.cos(order * self.dt * np.arange(n_t))
        self.load = np.pi * (1.0 - inner**2) * sealed * balance
        self.cell = self.r[:, None] * self.dr * self.dt * np.ones(n_t)

    def film(self, h):
        """Force of the film of thickness h (radii, angles)."""
        index = np.arange(h.size).reshape(h.shape)
        across = 0.5 * (h[1:] + h[:-1])
        radial = cubed(np.vstack([h[:1], across, h[-1:]])) * self.edge[:, None] * self.dt / self.dr / 12.0
        radial[[0, -1]] *= 2.0
        beside = np.roll(index, -1, 1)
        half = 0.5 * (h + np.roll(h, -1, 1))
        along = cubed(half) * self.dr / (self.r[:, None] * self.dt) / 12.0
        drag = mean(half) * self.r[:, None] * self.dr / 2.0
        rows, columns, values = [], [], []

        def couple(i, j, value):
            for a, b, v in ((i, i, value), (i, j, -value), (j, j, value), (j, i, -value)):
                rows.append(a.ravel()), columns.append(b.ravel()), values.append(v.ravel())

        couple(index[:-1], index[1:], radial[1:-1])
        couple(index, beside, along)
        source = np.zeros(h.shape)
        source[-1] = radial[-1] * self.sealed
        for line, value in ((index[0], radial[0]), (index[-1], radial[-1])):
            rows.append(line), columns.append(line), values.append(value)
        flow = sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
        places = np.concatenate([index.ravel(), beside.ravel()]), np.tile(index.ravel(), 2)
        carried = sparse.csr_matrix((np.concatenate([drag.ravel(), -drag.ravel()]), places))
        full = np.ones(h.size, bool)
        for _ in range(100):
            pick = sparse.diags(full.astype(float))
            matrix = flow @ pick + carried @ (sparse.identity(h.size) - pick)
            found = spsolve(matrix.tocsc(), source.ravel() - carried @ full.astype(float))
            after = np.where(full, found >= 0.0, found > 1.0)
            if (after == full).all():
                break
            full = after
        return self.order * float((np.where(full, found, 0.0).reshape(h.shape) * self.cell).sum())

    def pressed(self, shape, start):
        """Mean film at which film and asperities carry the load over a `shape` of the gap, and contact pressure."""

        def excess(rest):
            h = rest + shape
            rough = self.order * self.strength * float((touching(h) * self.cell).sum())
            return self.film(h) + rough - self.load

        step = 0.05
        while excess(start - step) < 0.0 or excess(start + step) > 0.0:
            step *= 2.0
        rest = brentq(excess, start - step, start + step, xtol=1e-6)
        return rest, self.strength * touching(rest + shape)

    def life(self, amplitude, share, depth=0.04):
        """Time, over half height x strength's units/(coefficient x speed x outer radius), until waves of an `amplitude`
        have fallen to a `share`: half the height between crest and trough."""
        shape, time, rest = amplitude * self.wave * np.ones((len(self.r), 1)), 0.0, 1.3
        size = before = amplitude
        while size > share * amplitude:
            rest, first = self.pressed(shape, rest)
            rate = first * self.r[:, None]
            step = depth / rate.max()
            _, second = self.pressed(shape + step * rate, rest)
            before, rate = size, 0.5 * (rate + second * self.r[:, None])
            shape, time = shape + step * rate, time + step
            # The ring follows, and the gap is counted from its mean.
            shape -= shape.mean()
            size = 0.5 * float(np.ptp(shape.mean(axis=0)))
        return time - step * (share * amplitude - size) / (before - size)
