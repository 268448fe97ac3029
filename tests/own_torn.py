"""A liquid film that tears and keeps its liquid, between faces that differ around the circle, in time with its rings,
in the tests' own words: nothing of the program but the scene's data.

    d(fill E(H))/dt + wm d(fill E(H))/dtheta = div(E(H^3) grad p)/(12 mu),   p >= p_cav,  fill <= 1, one of both at once

Cells even in ln r and theta, the liquid that faces drag is that of the cell it comes from.  Rings and cells together by
the second backward difference formula in steps of one length, each solved by Newton's method; the first step in EULER
backward steps of Euler.  The program steps otherwise (TR-BDF2, of lengths it chooses).
"""

import math

import numpy as np
from own_face import FLOW, FORCE, MOMENT_X, MOMENT_Y, PRESS
from own_films import OwnPatterned, mean_film
from own_march import Seen, thinnest, told
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

EULER, MOST = 8, 60


class OwnTorn(OwnPatterned):
    """Equations of motion of a scene with such a film; unknowns beside the rings' are one a cell: pressure above
    cavitation (Pa), or below zero what its fill lacks, times SCALE.  `cells` over radius and angle."""

    SCALE = 1e5

    def __init__(self, scene, duration, cells=(10, 96)):
        self.cells = cells
        film, (n, m) = scene.film, cells
        step = math.log(film.outer_radius / film.inner_radius) / n
        self.turn, self.per = 2.0 * math.pi / m, 2.0 * math.pi / m / step
        self.rim = film.inner_radius * np.exp(np.arange(n + 1) * step)[:, None]
        self.r = film.inner_radius * np.exp((np.arange(n) + 0.5) * step)[:, None]
        self.theta = self.turn * np.arange(m)
        self.cell_area = 0.5 * (self.rim[1:] ** 2 - self.rim[:-1] ** 2) * self.turn * np.ones(m)
        place = np.arange(n * m).reshape(n, m)
        back, ahead = np.roll(place, 1, axis=1), np.roll(place, -1, axis=1)
        below, above = np.roll(place, 1, axis=0), np.roll(place, -1, axis=0)
        # Rows and columns of what full cells press, then of what torn ones are filled with.
        self.rows = np.concatenate([place.ravel()] * 7)
        self.columns = np.concatenate([a.ravel() for a in (place, back, ahead, below, above, place, back)])
        super().__init__(scene, duration)

    def _refuse(self):
        if self.scene.film.model != "reynolds" or self.scene.film.cavitation_pressure is None or self.scene.film.gas:
            raise NotImplementedError("a film that these cells do not know")

    def ways(self, now, gap):
        """Flows for a pressure (m^3/(Pa s)) over the radius and to the next angle, liquid that is dragged there
        (m^3/s), and what a cell holds (m^3)."""
        film = self.collocated

        def means(r, theta):
            h = film.height(now, gap, r, theta)[0]
            if film.rough:
                one, cube = mean_film(h / film.rough)
                return one * film.rough, cube * film.rough**3
            low = h < film.floor
            h = np.where(low, film.floor**2 / np.where(low, 2.0 * film.floor - h, 1.0), h)
            return h, h**3

        over = self.per * means(self.rim, self.theta)[1] / (12.0 * now["mu"])
        over[[0, -1]] *= 2.0
        h, cube = means(self.r, self.theta + 0.5 * self.turn)
        mean = 0.5 * (now["spin_s"] + now["spin_r"])
        assert mean >= 0.0
        held = means(self.r, self.theta)[0] * self.cell_area
        return over, cube / (12.0 * now["mu"] * self.per), mean * h * self.cell_area / self.turn, held

    def inflow(self, now, ways, w):
        """What flows into each cell (m^3/s)."""
        over, along, dragged, _ = ways
        p, fill = self.split(w)
        base = self.scene.film.cavitation_pressure
        edges = [np.full((1, self.cells[1]), now[side] - base) for side in ("p_i", "p_o")]
        outwards = over * -np.diff(np.vstack([edges[0], p, edges[1]]), axis=0)
        onwards = along * (p - np.roll(p, -1, axis=1)) + dragged * fill
        return outwards[:-1] - outwards[1:] + np.roll(onwards, 1, axis=1) - onwards, outwards

    def split(self, w):
        """Pressure above cavitation (Pa) and fill."""
        w = np.reshape(w, self.cells)
        return np.maximum(w, 0.0), 1.0 + np.minimum(w, 0.0) / self.SCALE

    def slopes_by_cells(self, ways, w, kept):
        """Sparse matrix d(inflow)/dw less `kept` times what the cells hold."""
        over, along, dragged, held = ways
        full = (np.reshape(w, self.cells) > 0.0).astype(float)
        torn = (1.0 - full) / self.SCALE
        inner, outer = over[:-1].copy(), over[1:].copy()
        inner[0] = outer[-1] = 0.0
        before = np.roll(along, 1, axis=1)
        values = [
            -(over[:-1] + over[1:] + along + before) * full,
            before * np.roll(full, 1, axis=1),
            along * np.roll(full, -1, axis=1),
            inner * np.roll(full, 1, axis=0),
            outer * np.roll(full, -1, axis=0),
            -(dragged + kept * held) * torn,
            np.roll(dragged * torn, 1, axis=1),
        ]
        data = np.concatenate([v.ravel() for v in values])
        return coo_matrix((data, (self.rows, self.columns))).tocsc()

    def at_rest(self, now, gap):
        """Unknowns of the film at a gap that stands still."""
        ways, w = self.ways(now, gap), np.full(self.cells, 1.0)
        for _ in range(MOST):
            change = splu(self.slopes_by_cells(ways, w, 1e-9)).solve(-self.inflow(now, ways, w)[0].ravel())
            found = w + change.reshape(self.cells)
            if np.array_equal(found > 0.0, w > 0.0):
                return found.ravel()
            w = found
        raise AssertionError("full and torn cells change places")

    def _rates_and_loads(self, now, gap, x):
        given = len(x)
        x = x if given else self.at_rest(now, gap)
        ways, out = self.ways(now, gap), np.zeros(9)
        cell = self.cell_area * (self.split(x)[0] + self.scene.film.cavitation_pressure)
        out[FORCE], out[FLOW] = cell.sum(), self.inflow(now, ways, x)[1][0].sum()
        arm = cell * self.r
        out[MOMENT_X], out[MOMENT_Y] = np.sum(arm * np.sin(self.theta)), -np.sum(arm * np.cos(self.theta))
        if self.scene.contact:
            out[PRESS:] = self.collocated._asperities(now, gap)
        return np.zeros(given), out

    def _loads(self, now, gap, x):
        return self._rates_and_loads(now, gap, x)[1]

    def step(self, t, dt, before, w, formula):
        """Displacements, rates, unknowns and what is held at t + dt; `before` (rows of displacements, rates and held),
        the `formula` that makes their rates: (a, b, c) of (a y - b y_1 + c y_2)/dt."""
        n, (a, b, c), now = self.n, formula, self._at(t + dt, self.piece(t + dt))
        base_q, base_v, held_before = ((b * one - c * two) for one, two in zip(*before, strict=True))
        q = before[0][0] + dt * before[0][1]
        steps = 1e-7 * self.lengths

        def left(q, w):
            v = (a * q - base_q) / dt
            y = np.concatenate([q, v, w.ravel()])
            gap = self._gap(self._motion(t + dt, y, now)[1])
            ways = self.ways(now, gap)
            pushed = (a * v - base_v) / dt - self.rates(t + dt, y)[n : 2 * n]
            held = ways[3] * self.split(w)[1]
            return pushed, (self.inflow(now, ways, w)[0] - (a * held - held_before) / dt).ravel(), ways, held, v

        for _ in range(MOST):
            pushed, filled, ways, *_ = left(q, w)
            solver = splu(self.slopes_by_cells(ways, w, a / dt))
            # What the rings' unknowns move, by differences; what the cells push, exactly.
            moved = [left(q + np.eye(n)[i] * steps[i], w) for i in range(n)]
            by_rings = np.column_stack([(one[1] - filled) / d for one, d in zip(moved, steps, strict=True)])
            own = np.column_stack([(one[0] - pushed) / d for one, d in zip(moved, steps, strict=True)])
            full = (w > 0.0).astype(float).reshape(self.cells) * self.cell_area
            arms = [full, full * self.r * np.sin(self.theta), -full * self.r * np.cos(self.theta)]
            rows = []
            for name, ring in self.floating:
                sign = -1.0 if name == "stator" else 1.0
                inert = (ring.mass, ring.transverse_inertia, ring.transverse_inertia)
                rows += [sign * arm.ravel() / mass for arm, mass in zip(arms, inert, strict=True)]
            rows = np.array(rows)
            both = solver.solve(np.column_stack([filled, by_rings]))
            change = np.linalg.solve(own - rows @ both[:, 1:], -pushed + rows @ both[:, 0])
            w_change = -both[:, 0] - both[:, 1:] @ change
            same = np.array_equal(w + w_change > 0.0, w > 0.0)
            q, w = q + change, w + w_change
            if same and np.max(np.abs(change) / self.lengths) < 1e-8:
                v = (a * q - base_q) / dt
                gap = self._gap(self._motion(t + dt, np.concatenate([q, v]), now)[1])
                return q, v, w, self.ways(now, gap)[3] * self.split(w)[1]
        raise AssertionError(f"no step at {t:g} s")


def march(seal, y0, times, steps):
    """`own_march.Seen` at increasing times from displacements and rates y0 (2 n,), in so many steps; between them
    parabolas of what is seen at the steps."""
    n, dt = seal.n, seal.duration / steps
    now, q, v = seal._at(0.0, 0), np.array(y0[: seal.n]), np.array(y0[seal.n :])
    gap = seal._gap(seal._motion(0.0, np.array(y0), now)[1])
    still = (*gap[:3], 0.0, 0.0, 0.0)
    w = seal.at_rest(now, still)
    held = seal.ways(now, gap)[3] * seal.split(w)[1]
    before = [(q, v, held)]
    for k in range(EULER):
        q, v, w, held = seal.step(k * dt / EULER, dt / EULER, [(q, v, held)] * 2, w, (1.0, 1.0, 0.0))
        if k == 0:
            first = _row(seal, 1e-9 * dt, before[0][0], before[0][1], w)
    rows = [first, _row(seal, dt, q, v, w)]
    before.insert(0, (q, v, held))
    for k in range(1, steps):
        q, v, w, held = seal.step(k * dt, dt, before, w, (1.5, 2.0, 0.5))
        before = [(q, v, held), before[0]]
        rows.append(_row(seal, (k + 1) * dt, q, v, w))
    at, rows = dt * np.arange(steps + 1), np.array(rows)
    seen = np.column_stack([np.interp(times, at, row) for row in rows.T])
    for k, t in enumerate(times):
        # A cubic through four steps beside, of what does not jump.
        first = min(max(int(t / dt) - 1, 0), steps - 3)
        x = t / dt - first
        weights = [np.prod([(x - j) / (i - j) for j in range(4) if j != i]) for i in range(4)]
        seen[k, : 2 * n] = weights @ rows[first : first + 4, : 2 * n]
    sums = np.trapezoid(rows[:, 2 * n + 9 : -1], at, axis=0)
    most = np.abs(rows[:, [2 * n + 9, 2 * n + 10, 2 * n + 12]]).max(axis=0)
    return Seen(np.asarray(times), seen[:, : 2 * n], seen[:, 2 * n : 2 * n + 9], sums, most, float(rows[:, -1].min()))


def _row(seal, t, q, v, w):
    y = np.concatenate([q, v, w])
    loads, summed = told(seal, t, y, seal.piece(t))
    return np.concatenate([q, v, loads, summed, [thinnest(seal, t, y)]])
