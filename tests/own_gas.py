"""A gas between two plane or coned faces in time, in the tests' own words: nothing of the program.

    d(p h)/dt + wm d(p h)/dtheta = div(h^3 p (1 + 6 Kn) grad p)/(12 mu),   Kn = mu sqrt(pi R T/2)/(p h)

on the program's cells, which are its definition of a gas film: nodes over the radius that get closer towards both edges
of the face, even angles, and the products p h at the nodes between the edges as unknowns.  From a node to its neighbour
h^3 is what a wedge between the two lets through, h^2 of slip the product of both; the faces of the cells lie half-way;
the cells at the edges of the face have no more of the radial flow than up to half-way to the edge.
"""

import math

import numpy as np

# Force, moments about x and y, flow outwards at the inner radius (m^3/s at 273.15 K and 101325 Pa), torque.
LOADS = 5


class OwnGas:
    """Film of a `Film` table with constant temperature.  Unknowns x (angles * cells,) are p h (Pa m), angle by angle;
    `floor` (m) of a film between rough faces;
    conditions are dicts of `mu`, `p_i`, `p_o`, `spin_s`, `spin_r`; gaps as `own_face.face_loads` has them."""

    def __init__(self, film, gas, floor=0.0):
        options = film.gas_reynolds
        (self.cells, self.angles), self.film, self.floor = options.cells, film, floor
        self.size = self.cells * self.angles
        even = np.array([0.0, *((j + 0.5) / self.cells for j in range(self.cells)), 1.0])
        r_i, r_o = film.inner_radius, film.outer_radius
        r = r_i + (r_o - r_i) * (0.2 * even + 0.4 * (1.0 - np.cos(math.pi * even)))
        half = 0.5 * (r[1:] + r[:-1])
        a, b = np.array([r_i, *half[1:-1]]), np.array([*half[1:-1], r_o])
        self.r, theta = r, 2.0 * math.pi * np.arange(self.angles) / self.angles
        self.sin, self.cos = np.sin(theta)[:, None], np.cos(theta)[:, None]
        self.step = 2.0 * math.pi / self.angles
        self.log, self.core, self.area = np.log(r[1:] / r[:-1]), (half[1:] ** 2 - half[:-1] ** 2) / 2, (b**2 - a**2) / 2
        # int dr/r of a cell over its area, over the square of the step that is exact for tilt.
        self.around = np.log(b / a) / self.area / (2.0 - 2.0 * math.cos(self.step))
        self.turning = 0.5 / math.sin(self.step)
        self.slip = 0.5 * math.sqrt(math.pi / 2 * gas.gas_constant * film.temperature) if options.slip else 0.0
        self.pressing, self.tilting = (self._weights(a, b, power) for power in (1, 2))
        self.shearing = (b**4 - a**4) / 4
        # Neighbours around the circle.
        self.after, self.before = (np.roll(np.arange(self.angles), -way) for way in (1, -1))

    def _weights(self, a, b, power):
        """What int p r^power dr has of p at the nodes: a parabola through a cell's node and both beside it."""
        total = np.zeros(len(self.r))
        for j in range(self.cells):
            for k in range(3):
                others = [self.r[j + i] for i in range(3) if i != k]
                one = np.polymul([1.0, -others[0]], [1.0, -others[1]]) / np.prod(self.r[j + k] - np.array(others))
                integral = np.polyint(np.polymul(one, [1.0] + [0.0] * power))
                total[j + k] += np.polyval(integral, b[j]) - np.polyval(integral, a[j])
        return total

    def thickness(self, gap):
        """Film thickness (angles, cells + 2) and its rate (m, m/s) at the nodes."""
        aligned, g_x, g_y, rate, g_x_rate, g_y_rate = gap
        h = aligned + self.film.coning * (self.r - self.r[0]) + self.r * (g_x * self.sin - g_y * self.cos)
        rate = rate + self.r * (g_x_rate * self.sin - g_y_rate * self.cos)
        # Between rough faces, below the floor, a hyperbola.
        bent = np.maximum(h, self.floor**2 / np.maximum(2.0 * self.floor - h, self.floor or 1.0))
        return (
            (bent, np.where(h < self.floor, (bent / (self.floor or 1.0)) ** 2, 1.0) * rate) if self.floor else (h, rate)
        )

    def _pressures(self, now, h, x):
        p = np.empty_like(h)
        p[:, 0], p[:, -1], p[:, 1:-1] = now["p_i"], now["p_o"], x.reshape(self.angles, self.cells) / h[:, 1:-1]
        return p

    def _ways(self, now, h):
        """Factors of differences of p^2 and of p in the flow from node to node: outwards (angles, cells + 1), and to
        the next angle (angles, cells)."""
        mu, inside, outside, here, there = now["mu"], h[:, :-1], h[:, 1:], h[:, 1:-1], h[self.after, 1:-1]
        radial = (inside * outside) ** 2 / (inside + outside) / (12.0 * mu * self.log)
        circular = (here * there) ** 2 / (here + there) / (12.0 * mu) * self.around
        return radial, self.slip * inside * outside / self.log, circular, self.slip * here * there * self.around

    def _flows(self, now, h, p):
        radial, radial_slip, circular, circular_slip = self._ways(now, h)
        square, inner = p * np.abs(p), p[:, 1:-1]
        out = radial * (square[:, :-1] - square[:, 1:]) + radial_slip * (p[:, :-1] - p[:, 1:])
        on = circular * (square[:, 1:-1] - square[self.after, 1:-1]) + circular_slip * (inner - inner[self.after])
        return out, on

    def rates(self, now, gap, x):
        """dx/dt (Pa m/s)."""
        return self.rates_and_loads(now, gap, x)[0]

    def rates_and_loads(self, now, gap, x):
        """The same, and loads (LOADS,) on the stator, see above."""
        h = self.thickness(gap)[0]
        x = np.asarray(x).reshape(self.angles, self.cells)
        p = self._pressures(now, h, x)
        out, on = self._flows(now, h, p)
        wm = 0.5 * (now["spin_s"] + now["spin_r"])
        rates = (out[:, :-1] - out[:, 1:]) / self.core + on[self.before] - on
        rates -= wm * self.turning * (x[self.after] - x[self.before])
        return rates.ravel(), self._loads(now, gap, h, p, out)

    def slopes(self, now, gap, x):
        """d rates / d x (size, size)."""
        h = self.thickness(gap)[0]
        p, (radial, radial_slip, circular, circular_slip) = self._pressures(now, h, x), self._ways(now, h)
        wm, matrix = 0.5 * (now["spin_s"] + now["spin_r"]), np.zeros((self.angles, self.cells) * 2)
        q, h = np.abs(p[:, 1:-1]), h[:, 1:-1]
        k, j = np.meshgrid(np.arange(self.angles), np.arange(self.cells), indexing="ij")

        def by(way, slip):
            return (2.0 * way * q + slip) / h

        inward, outward = by(radial[:, :-1], radial_slip[:, :-1]), by(radial[:, 1:], radial_slip[:, 1:])
        onward, backward = by(circular, circular_slip), by(circular[self.before], circular_slip[self.before])
        matrix[k, j, k, j] -= (inward + outward) / self.core + onward + backward
        matrix[k[:, 1:], j[:, :-1], k[:, 1:], j[:, 1:]] += inward[:, 1:] / self.core[:-1]
        matrix[k[:, 1:], j[:, 1:], k[:, 1:], j[:, :-1]] += outward[:, :-1] / self.core[1:]
        matrix[self.after[k], j, k, j] += onward + wm * self.turning
        matrix[self.before[k], j, k, j] += backward - wm * self.turning
        return matrix.reshape(self.size, self.size)

    def loads_by_pressures(self, now, gap):
        """Force and both moments of each unknown, (3, size)."""
        h = self.thickness(gap)[0][:, 1:-1]
        force, moment = self.step * self.pressing[1:-1] / h, self.step * self.tilting[1:-1] / h
        return np.array([force.ravel(), (moment * self.sin).ravel(), -(moment * self.cos).ravel()])

    def _loads(self, now, gap, h, p, out):
        moments = p @ self.tilting
        m_x, m_y = self.step * moments @ self.sin[:, 0], -self.step * moments @ self.cos[:, 0]
        # The cell at the edge fills at one rate throughout.
        beyond = self.area[0] / self.core[0] - 1.0
        flow = self.step * np.sum(out[:, 0] + beyond * (out[:, 0] - out[:, 1]))
        couette = self.step * np.sum(self.shearing / h[:, 1:-1]) * now["mu"] * (now["spin_r"] - now["spin_s"])
        torque = couette + 0.5 * (gap[1] * m_y - gap[2] * m_x)
        normal = 273.15 / (self.film.temperature * 101325.0)
        return np.array([self.step * (p @ self.pressing).sum(), m_x, m_y, normal * flow, torque])

    def steady(self, now, gap):
        """Unknowns whose pressures stand still while the gap moves on: Newton's method."""
        h, h_rate = (part[:, 1:-1].ravel() for part in self.thickness(gap))
        share = np.log(self.r[1:-1] / self.r[0]) / math.log(self.r[-1] / self.r[0])
        p = np.sqrt(now["p_i"] ** 2 + share * (now["p_o"] ** 2 - now["p_i"] ** 2))
        x, squeezed = np.tile(p, self.angles) * h, h_rate / h
        for _ in range(100):
            change = np.linalg.solve(
                self.slopes(now, gap, x) - np.diag(squeezed), squeezed * x - self.rates(now, gap, x)
            )
            x = np.maximum(x + change, 0.1 * x)
            if np.max(np.abs(change)) < 1e-13 * np.max(x):
                return x
        raise NotImplementedError("no steady pressures")
