"""Films whose faces differ around the circle, and gas between rough faces, in time, in the tests' own words: nothing of
the program but the scene's data.

    gas      d(p h)/dt + wm d(p h)/dtheta = div(h^3 p (1 + 6 Kn) grad p)/(12 mu)
    liquid   dE(H)/dt + wm dE(H)/dtheta = div(E(H^3) grad p)/(12 mu)

by collocation: Chebyshev's points over the radius times even angles (collocated_gas.py).  Waves turn with their ring;
pads stand still.  Asperities by Gauss points over the radius and even angles.  Frames, signs and the equations of the
rings are those of own_words.py.
"""

import math
from dataclasses import replace

import numpy as np
import own_face
from collocated_gas import chebyshev, fourier
from own_face import DRAG, FLOW, FORCE, MOMENT_X, MOMENT_Y, PRESS
from own_rest import pattern
from own_words import OwnSeal

from sealdyn.scene.rings import Rotor, Stator

# Points of asperities over the radius, and angles.
RADII, AROUND = 12, 384


def share_of_heights(x):
    """Share in contact of Christensen's heights at h = x c."""
    x = np.clip(x, -1.0, 1.0)
    return 0.5 - 35.0 / 32.0 * (x - x**3 + 0.6 * x**5 - x**7 / 7.0)


def mean_film(x):
    """E(H)/c, and E(H^3)/c^3."""
    t = np.clip(x, -1.0, 1.0)
    one = 35 / 256 + t / 2 + 35 * t**2 / 64 - 35 * t**4 / 128 + 7 * t**6 / 64 - 5 * t**8 / 256
    cube = 7 / 256 + t / 6 + 105 * t**2 / 256 + t**3 / 2 + 35 * t**4 / 128 - 7 * t**6 / 128 + 3 * t**8 / 256
    return np.where(x >= 1.0, x, one), np.where(x >= 1.0, x**3 + x / 3.0, cube - t**10 / 768)


class Collocated:
    """The film of a scene at `radii` + 1 points over the radius and `angles` angles.  Gaps are as `own_face.face_loads`
    has them, conditions dicts of `mu`, `p_i`, `p_o`, `spin_s`, `spin_r`, `phi_s`, `phi_r`.  Unknowns of a gas are p h
    (Pa m) between the edges, radius by radius; a liquid has none."""

    def __init__(self, scene, gas, radii=8, angles=32):
        self.scene, self.film, self.gas = scene, scene.film, gas
        self.r, self.d_r, w = chebyshev(self.film.inner_radius, self.film.outer_radius, radii)
        self.theta, self.d_t = fourier(angles)
        self.r, self.weight = self.r[:, None], w[:, None] * 2.0 * math.pi / angles
        self.sin, self.cos = np.sin(self.theta), np.cos(self.theta)
        self.shape, self.inside = (radii + 1, angles), (radii - 1, angles)
        self.size = self.inside[0] * angles if gas else 0
        self.along, self.around = np.kron(self.d_r, np.eye(angles)), np.kron(np.eye(radii + 1), self.d_t)
        self.edge = np.zeros(self.shape, dtype=bool)
        self.edge[[0, -1]] = True
        slip = gas and self.film.gas_reynolds and self.film.gas_reynolds.slip
        self.slip = math.sqrt(math.pi / 2 * gas.gas_constant * self.film.temperature) if slip else 0.0
        contact, options = scene.contact, self.film.reynolds
        self.floor, self.rough = 0.6 * 3.0 * contact.roughness if contact else 0.0, 0.0
        if contact and self.film.model == "reynolds" and (options is None or options.roughness == "christensen"):
            self.floor, self.rough = 0.0, 3.0 * contact.roughness

    def pads(self, r, theta):
        """By how much (m) pads make the film thicker."""
        return pattern(replace(self.scene, stator=Stator(), rotor=Rotor()), r, theta) if self.film.pads else 0.0 * theta

    def height(self, now, gap, r, theta):
        """Distance of the mean planes (m) and its rate (m/s) at radii and angles that broadcast."""
        aligned, g_x, g_y, rate, g_x_rate, g_y_rate = gap
        sin, cos = np.sin(theta), np.cos(theta)
        h = aligned + self.film.coning * (r - self.film.inner_radius) + r * (g_x * sin - g_y * cos)
        h_rate = rate + r * (g_x_rate * sin - g_y_rate * cos)
        # Pads, and the waves of each ring where it is now.
        h, h_rate = h + self.pads(r, theta), h_rate + 0.0 * theta
        for sign, ring, side in ((1.0, self.scene.stator, "_s"), (-1.0, self.scene.rotor, "_r")):
            for wave in ring.waviness:
                at = wave.order * (theta - now["phi" + side]) + wave.phase
                h = h + sign * wave.amplitude * np.cos(at)
                h_rate = h_rate + sign * wave.amplitude * wave.order * now["spin" + side] * np.sin(at)
        return h, h_rate

    def _film(self, now, gap):
        """What flows: mean film, mean cube, rate of the film (m, m^3, m/s)."""
        h, rate = self.height(now, gap, self.r, self.theta)
        if self.rough:
            one, cube = mean_film(h / self.rough)
            return one * self.rough, cube * self.rough**3, rate * (1.0 - share_of_heights(h / self.rough))
        low = h < self.floor
        bent = np.where(low, self.floor**2 / np.where(low, 2.0 * self.floor - h, 1.0), h)
        return bent, bent**3, np.where(low, (bent / self.floor) ** 2 if self.floor else 0.0, 1.0) * rate

    def _pressures(self, now, h, x):
        p = np.empty(self.shape)
        p[0], p[-1], p[1:-1] = now["p_i"], now["p_o"], np.reshape(x, self.inside) / h[1:-1]
        return p

    def _gas_ways(self, now, h, p):
        return h**3 + 6.0 * now["mu"] * self.slip * h**2 / p

    def rates_and_loads(self, now, gap, x):
        """Rates of the unknowns of a gas (Pa m/s), and nine loads as `own_face.face_loads`."""
        h, cube, rate = self._film(now, gap)
        out = np.empty(0)
        if self.gas:
            p = self._pressures(now, h, x)
            way = self._gas_ways(now, h, p)
            # The square of the pressure is nearly straight where the pressure itself is not.
            square = 0.5 * p**2
            flux = self.r * way * (self.d_r @ square)
            flows = self.d_r @ flux / self.r + (way * (square @ self.d_t.T)) @ self.d_t.T / self.r**2
            mean = 0.5 * (now["spin_s"] + now["spin_r"])
            out = (flows / (12.0 * now["mu"]) - mean * (p * h) @ self.d_t.T)[1:-1].ravel()
            normal = 273.15 / (self.film.temperature * 101325.0)
        else:
            p, normal = self._liquid(now, h, cube, rate), 1.0
            flux = self.r * cube * (self.d_r @ p)
        flow = -normal * np.sum(flux[0]) * 2.0 * math.pi / len(self.theta) / (12.0 * now["mu"])
        loads, cell = np.zeros(9), self.weight * self.r * p
        loads[FORCE], loads[FLOW] = cell.sum(), flow
        loads[MOMENT_X], loads[MOMENT_Y] = np.sum(cell * self.r * self.sin), -np.sum(cell * self.r * self.cos)
        shear = now["mu"] * (now["spin_r"] - now["spin_s"]) * self.r**3 / h + 0.5 * h * self.r * (p @ self.d_t.T)
        loads[DRAG] = np.sum(self.weight * shear)
        if self.scene.contact:
            loads[PRESS:] = self._asperities(now, gap)
        return out, loads

    def _liquid(self, now, h, cube, rate):
        """Pressures (Pa)."""
        flat, r = (cube / (12.0 * now["mu"])).ravel()[:, None], np.broadcast_to(self.r, self.shape).ravel()
        matrix = self.along @ (r[:, None] * flat * self.along) / r[:, None]
        matrix += self.around @ (flat * self.around) / (r**2)[:, None]
        right = (rate + 0.5 * (now["spin_s"] + now["spin_r"]) * h @ self.d_t.T).ravel()
        edge = np.zeros(self.shape)
        edge[0], edge[-1] = now["p_i"], now["p_o"]
        known, p = self.edge.ravel(), edge.ravel()
        p[~known] = np.linalg.solve(matrix[np.ix_(~known, ~known)], right[~known] - matrix[~known][:, known] @ p[known])
        return p.reshape(self.shape)

    def slopes(self, now, gap, x):
        """d rates / d x (size, size) of a gas."""
        h = self._film(now, gap)[0]
        p = self._pressures(now, h, x)
        way, n = self._gas_ways(now, h, p), h.size
        square, flat = 0.5 * p**2, p.ravel()
        r, s_r, s_t = np.broadcast_to(self.r, self.shape).ravel(), (self.d_r @ square).ravel(), square @ self.d_t.T
        by_r = (r * way.ravel())[:, None] * self.along * flat
        by_t = way.ravel()[:, None] * self.around * flat
        bent = -6.0 * now["mu"] * self.slip * (h**2).ravel() / flat**2
        by_r[np.arange(n), np.arange(n)] += r * bent * s_r
        by_t[np.arange(n), np.arange(n)] += bent * s_t.ravel()
        mean = 0.5 * (now["spin_s"] + now["spin_r"])
        inner = ~self.edge.ravel()
        matrix = self.along[inner] @ by_r[:, inner] / r[inner][:, None]
        matrix += self.around[inner][:, inner] @ by_t[np.ix_(inner, inner)] / (r[inner] ** 2)[:, None]
        matrix /= 12.0 * now["mu"]
        h = h.ravel()
        return matrix / h[inner] - mean * self.around[np.ix_(inner, inner)]

    def loads_by_pressures(self, now, gap):
        """Force and both moments of each unknown of a gas, (3, size)."""
        h = self._film(now, gap)[0]
        cell = (self.weight * self.r / h)[1:-1]
        arm = cell * self.r[1:-1]
        return np.array([cell.ravel(), (arm * self.sin).ravel(), -(arm * self.cos).ravel()])

    def steady(self, now, gap):
        """Unknowns of a gas whose pressures stand still while the gap moves on: Newton's method."""
        h, _, h_rate = (part[1:-1] for part in self._film(now, gap))
        share = np.log(self.r[1:-1] / self.r[0]) / math.log(self.r[-1, 0] / self.r[0, 0])
        p = np.sqrt(now["p_i"] ** 2 + share * (now["p_o"] ** 2 - now["p_i"] ** 2))
        x, squeezed = (p * h).ravel(), (h_rate / h).ravel()
        for _ in range(100):
            left = self.rates_and_loads(now, gap, x)[0] - squeezed * x
            change = np.linalg.solve(self.slopes(now, gap, x) - np.diag(squeezed), -left)
            x = np.maximum(x + change, 0.1 * x)
            if np.max(np.abs(change)) < 1e-12 * np.max(x):
                return x
        raise NotImplementedError("no steady pressures")

    def _asperities(self, now, gap):
        """PRESS, PRESS_X, PRESS_Y, RUB of Christensen's heights."""
        contact, film = self.scene.contact, self.film
        x, w = np.polynomial.legendre.leggauss(RADII)
        width = film.outer_radius - film.inner_radius
        r, w = film.inner_radius + width * (0.5 + 0.5 * x)[:, None], 0.5 * width * w[:, None]
        theta = 2.0 * math.pi * np.arange(AROUND) / AROUND
        share = share_of_heights(self.height(now, gap, r, theta)[0] / (3.0 * contact.roughness))
        if not share.any():
            return np.zeros(4)
        cell = w * r * 2.0 * math.pi / AROUND * share
        press, arm = contact.compressive_strength * cell, r * cell
        if contact.shear_strength is not None:
            rub = contact.shear_strength
        else:
            rub = contact.compressive_strength * (
                0.1 if contact.friction_coefficient is None else contact.friction_coefficient
            )
        way = np.sign(now["spin_r"] - now["spin_s"])
        strength = contact.compressive_strength
        return np.array(
            [press.sum(), strength * np.sum(arm * np.sin(theta)), -strength * np.sum(arm * np.cos(theta)),
             way * rub * arm.sum()]
        )  # fmt: skip


class OwnPatterned(OwnSeal):
    """Equations of motion of a scene with such a film; `grid`: points over the radius and angles."""

    def __init__(self, scene, duration, grid=(8, 32)):
        self.grid = grid
        super().__init__(scene, duration)

    def _refuse(self):
        scene, film = self.scene, self.scene.film
        rough = scene.contact and scene.contact.law != "christensen"
        if rough or film.model not in ("reynolds", "gas_reynolds") or film.cavitation_pressure is not None:
            raise NotImplementedError("a film that collocation does not know")

    def _film_of(self, gas):
        self.collocated = Collocated(self.scene, gas, *self.grid)
        return self.collocated if gas else None

    def _contact(self):
        self.face = np.array([self.scene.film.inner_radius, self.scene.film.outer_radius, self.scene.film.coning, 0.0])
        self.law, self.levels, self.touching = own_face.NONE, np.empty(0), np.zeros(5)

    def _rates_and_loads(self, now, gap, x):
        return self.collocated.rates_and_loads(now, gap, x)

    def _loads(self, now, gap, x):
        return self.collocated.rates_and_loads(now, gap, x)[1]

    def h_min(self, t, y):
        """Thinnest film (m), on a grid of points; pads count as land, as the program has it."""
        now = self._at(t, self.piece(t))
        gap = self._gap(self._motion(t, y, now)[1])
        r = np.linspace(self.film_edges[0], self.film_edges[1], 5)[:, None]
        theta = np.linspace(0.0, 2.0 * math.pi, 720)
        return float((self.collocated.height(now, gap, r, theta)[0] - self.collocated.pads(r, theta)).min())

    @property
    def film_edges(self):
        """Radii of the face (m)."""
        return self.scene.film.inner_radius, self.scene.film.outer_radius

    def thinnest(self, t, y):
        """Room of its own: patterned and rough faces end no run here."""
        return math.inf
