"""Where rings rest on a film whose faces differ around the circle, in the tests' own words: nothing of the program but
the scene's data.

Faces that stand still, shaft or not; loads of the film by collocation, Chebyshev's points over the radius and even
angles (gas: collocated_gas.py; liquid without cavities: here), of a liquid with cavities on cells; and the root of
forces and moments on the rings that float.  Frames and signs as in own_words.py.
"""

import math

import numpy as np
from collocated_gas import chebyshev, collocated, fourier
from scipy.optimize import root
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve
from threadpoolctl import threadpool_limits


def pattern(scene, r, theta):
    """What waves and pads add to the film thickness (m)."""
    total = 0.0 * theta
    for sign, ring in ((1.0, scene.stator), (-1.0, scene.rotor)):
        for wave in ring.waviness:
            total = total + sign * wave.amplitude * np.cos(wave.order * theta + wave.phase)
    for pads in scene.film.pads:
        if (pads.inner_radius, pads.outer_radius) != (scene.film.inner_radius, scene.film.outer_radius):
            raise NotImplementedError("pads that end within the face")
        way, pitch = 0.5 * (pads.inner_radius + pads.outer_radius) / pads.edge, 2.0 * math.pi / pads.count
        # The pads, and once more as many on either side: a flank reaches far.
        for k in range(-pads.count, 2 * pads.count):
            x = np.mod(theta - pads.phase + math.pi, 2 * math.pi) - math.pi - k * pitch
            total = total + 0.5 * pads.depth * (
                np.tanh(way * (x + 0.5 * pads.angle)) - np.tanh(way * (x - 0.5 * pads.angle))
            )
    return total


def thickness(scene, gap):
    """Film thickness (m) over radii (m) and angles (rad), at a gap (m, rad, rad) that opens and tilts the stator."""
    film, (z, g_x, g_y) = scene.film, gap

    def height(r, theta):
        plane = film.clearance + z + film.coning * (r - film.inner_radius)
        return plane + r * (g_x * np.sin(theta) - g_y * np.cos(theta)) + pattern(scene, r, theta)

    return height


def liquid(film, height, spin, radii, angles):
    """Force (N) and moments (N m) of div(h^3 grad p)/(12 mu) = wm dh/dtheta, `height(r, theta)` in m."""
    r, d_r, w = chebyshev(film.inner_radius, film.outer_radius, radii)
    theta, d_theta = fourier(angles)
    n, m = len(r), len(theta)
    along, around = np.kron(d_r, np.eye(m)), np.kron(np.eye(n), d_theta)
    rr, tt = (a.ravel() for a in np.meshgrid(r, theta, indexing="ij"))
    h = height(rr, tt)
    way = (h**3 / (12.0 * film.viscosity))[:, None]
    matrix = along @ (rr[:, None] * way * along) / rr[:, None] + around @ (way * around) / (rr**2)[:, None]
    right = 0.5 * spin * around @ h
    for edge, pressure in ((r[0], film.inner_pressure), (r[-1], film.outer_pressure)):
        at = rr == edge
        matrix[at], right[at] = np.eye(n * m)[at], pressure
    p = np.linalg.solve(matrix, right)
    cell = np.repeat(w, m) * 2 * np.pi / m * rr * p
    return np.array([np.sum(cell), np.sum(cell * rr * np.sin(tt)), -np.sum(cell * rr * np.cos(tt))])


# Cells over radius and angle of a film with cavities, and how often full and torn ones may change places.
CELLS, MOST = (10, 96), 60


def torn(film, height, spin):
    """As `liquid`, of a film that tears at its cavitation pressure and keeps its liquid: each cell is full, with a
    pressure above that, or has it and is filled in part; which, by Newton's method on the two together."""
    (n, m), base = CELLS, film.cavitation_pressure
    step, turn = math.log(film.outer_radius / film.inner_radius) / n, 2.0 * math.pi / m
    r = film.inner_radius * np.exp((np.arange(n) + 0.5) * step)[:, None]
    rim = film.inner_radius * np.exp(np.arange(n + 1) * step)[:, None]
    theta = turn * np.arange(m)
    area = 0.5 * (rim[1:] ** 2 - rim[:-1] ** 2) * np.ones(m)
    over = height(rim, theta) ** 3 / (12.0 * film.viscosity) * turn / step
    over[[0, -1]] *= 2.0
    ahead = height(r, theta + 0.5 * turn)
    along, carried = ahead**3 / (12.0 * film.viscosity) * step / turn, 0.5 * spin * area * ahead
    place, back = np.arange(n * m).reshape(n, m), np.roll(np.arange(n * m).reshape(n, m), 1, axis=1)
    before = np.roll(along, 1, axis=1)

    def matrix(places, values):
        rows, columns = np.broadcast_arrays(place, places)
        return coo_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=(n * m, n * m)).tocsc()

    # What flows into each cell, by pressures and by fill.
    pressed = matrix(place, -over[:-1] - over[1:] - along - before) + matrix(back, before)
    pressed += matrix(np.roll(place, -1, axis=1), along)
    inward, outward = over.copy(), over.copy()
    inward[0] = outward[-1] = 0.0
    pressed += matrix(np.roll(place, 1, axis=0), inward[:-1]) + matrix(np.roll(place, -1, axis=0), outward[1:])
    filled = matrix(back, np.roll(carried, 1, axis=1)) - matrix(place, carried)
    edges = np.zeros((n, m))
    edges[0], edges[-1] = over[0] * (film.inner_pressure - base), over[-1] * (film.outer_pressure - base)
    whole, full = np.ones(n * m), np.ones(n * m, dtype=bool)
    for _ in range(MOST):
        # The unknown of a full cell is its pressure, of a torn one what it lacks.
        both = pressed @ diags(full.astype(float)) + filled @ diags((~full).astype(float))
        found = spsolve(both.tocsc(), -(edges.ravel() + filled @ whole))
        now = found > 0.0
        if np.array_equal(now, full):
            break
        full = now
    else:
        raise AssertionError("full and torn cells change places")
    cell = area * np.where(full, found, 0.0).reshape(n, m)
    return np.array([cell.sum(), np.sum(cell * r * np.sin(theta)), -np.sum(cell * r * np.cos(theta))])


def loads(scene, gap, radii=8, angles=32):
    """Force (N) and moments (N m) on the stator at a gap (m, rad, rad)."""
    height, spin = thickness(scene, gap), scene.shaft.speed + scene.stator.speed
    if scene.film.cavitation_pressure is not None:
        return torn(scene.film, height, spin)
    if scene.film.gas is None:
        return liquid(scene.film, height, spin, radii, angles)
    return collocated(scene.film, height, lambda r, theta: 0.0 * r, spin, radii=radii, angles=angles)[:3]


def rest(scene, radii=8, angles=32):
    """{"stator" or "rotor": (z (m), tilt (rad, complex))} of the rings that float where nothing moves; the closing
    force is what holds aligned faces at the clearance."""
    floating = [(name, getattr(scene, name)) for name in ("stator", "rotor") if getattr(scene, name).support]
    closing = loads(scene, (0.0, 0.0, 0.0), radii, angles)[0]
    length, unit = scene.film.clearance, scene.film.clearance / scene.film.outer_radius

    def moved(y):
        return {name: (y[3 * k] * length, complex(*y[3 * k + 1 : 3 * k + 3]) * unit)
                for k, (name, _) in enumerate(floating)}  # fmt: skip

    def left(y):
        """Forces and moments over the closing force and this times the outer radius."""
        at = moved(y)
        signs = {"stator": 1.0, "rotor": -1.0}
        z = sum(signs[name] * part[0] for name, part in at.items())
        g = sum(signs[name] * part[1] for name, part in at.items())
        force, m_x, m_y = loads(scene, (z, g.real, g.imag), radii, angles)
        out = []
        for name, ring in floating:
            support, (own_z, tilt) = ring.support, at[name]
            spin = scene.shaft.speed if name == "rotor" else scene.stator.speed
            stiffness, damping = (k * support.radius**2 / 2 for k in (support.axial_stiffness, support.axial_damping))
            # A damper that turns with its ring pushes a tilt that stands.
            moment = signs[name] * complex(m_x, m_y) - (stiffness - 1j * spin * damping) * tilt
            push = signs[name] * (force - closing) - support.axial_stiffness * own_z
            out += [push, moment.real / scene.film.outer_radius, moment.imag / scene.film.outer_radius]
        return np.array(out) / closing

    # Small matrices: several threads only wait for each other.
    with threadpool_limits(1):
        found = root(left, np.zeros(3 * len(floating)), tol=1e-9)
    assert found.success, found.message
    return moved(found.x)
