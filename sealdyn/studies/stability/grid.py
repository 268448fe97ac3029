"""Growth rates of the aligned seal over grids of scenario values, vectorised: no scene is rebuilt where a formula
serves.

The film is isotropic, so the tilts of both rings, as complex numbers, obey one linear equation with complex
coefficients; one flexible ring is a complex quadratic, solved in closed form.
    I s^2 + (D_s + D_f - i J W) s + K_s + K_f - i (D_s W + D_f wm) = 0
**Source** Green (1989), eqs. 1-6, homogeneous.  **Valid** small motion about the aligned equilibrium.
"""

from functools import cached_property
from itertools import product

import numpy as np
from scipy.linalg import eigvals

from ... import closed_form as cf
from ...dynamics.model import Model
from ...dynamics.modes import NEUTRAL
from ...scenario.errors import ScenarioError
from ...scenario.settings import with_values
from ...scene.scene import SceneError
from ...scene.variants import frozen_at_start

INERTIA_RATIO = "inertia_ratio"
BLOCK = 100_000


def growth_rates(masses, dampings, stiffnesses, film_damping, film_stiffness) -> np.ndarray:
    """Largest real part (1/s) of the roots of one or two rings on one film; every argument broadcasts.

    `masses`, `dampings`, `stiffnesses`: lists, one entry per floating ring, complex where the ring spins; the film's
    two act on the sum (one ring) or difference (two rings) of displacements.
    """
    if len(masses) == 1:
        return _quadratic(masses[0], dampings[0] + film_damping, stiffnesses[0] + film_stiffness)
    arrays = np.broadcast_arrays(*masses, *dampings, *stiffnesses, film_damping, film_stiffness)
    shape, flat = arrays[0].shape, [np.ravel(a) for a in arrays]
    (m1, m2), (d1, d2), (k1, k2), (d, k) = (flat[i : i + 2] for i in (0, 2, 4, 6))
    count = len(d)
    damping, stiffness = np.empty((2, count, 2, 2), dtype=complex)
    for matrix, a, b, film in ((damping, d1, d2, d), (stiffness, k1, k2, k)):
        matrix[:, 0, 0], matrix[:, 1, 1], matrix[:, 0, 1], matrix[:, 1, 0] = a + film, b + film, -film, -film
    mass = np.stack([m1, m2], axis=1)
    if np.any(mass == 0):
        found = [_pencil(np.diag(mass[i]), damping[i], stiffness[i]) for i in range(count)]
        return np.array(found).reshape(shape)
    state = np.zeros((count, 4, 4), dtype=complex)
    state[:, 0, 2] = state[:, 1, 3] = 1.0
    state[:, 2:, :2], state[:, 2:, 2:] = -stiffness / mass[:, :, None], -damping / mass[:, :, None]
    bad = ~np.isfinite(state).all(axis=(1, 2))
    state[bad] = 0.0
    values = np.linalg.eigvals(state)
    rates = _neutral(values.real.max(axis=1), np.abs(values).max(axis=1))
    rates[bad] = np.nan
    return rates.reshape(shape)


def _quadratic(a, b, c):
    """Largest real part of the roots of a s^2 + b s + c, without cancellation; a = 0 leaves one root."""
    a, b, c = (np.asarray(x, dtype=complex) for x in (a, b, c))
    root = np.sqrt(b * b - 4 * a * c)
    root = np.where((b.conj() * root).real < 0, -root, root)
    q = -0.5 * (b + root)
    with np.errstate(divide="ignore", invalid="ignore"):
        # q = 0 only for b = c = 0: both roots are zero.
        slow = np.where(q == 0, 0.0, c / q)
        fast = np.where(a == 0, 0.0, q / a)
    largest = np.fmax(np.abs(slow), np.abs(fast))
    return _neutral(np.where(a == 0, slow.real, np.fmax(slow.real, fast.real)), largest)


def _neutral(rates, largest):
    """Growth rates with those within rounding of the largest eigenvalue set to zero."""
    return np.where(np.abs(rates) <= NEUTRAL * largest, 0.0, rates)


def _pencil(mass, damping, stiffness) -> float:
    """The same for two rings of which one has no mass."""
    zero, one = np.zeros((2, 2)), np.eye(2)
    values = eigvals(np.block([[zero, one], [-stiffness, -damping]]), np.block([[one, zero], [zero, mass]]))
    values = values[np.isfinite(values) & (np.abs(values) < 1e12)]
    return float(values.real.max()) if len(values) else np.nan


class Grid:
    """A scenario over two axes: `axes` maps a dotted key (or "inertia_ratio") to its values; the first is x, the
    second y, and every result has shape (y, x).
    **Valid** a film with one stiffness and damping at any frequency: not one that stores."""

    def __init__(self, scenario, axes: dict[str, np.ndarray]):
        self.scenario, self.scene = scenario, frozen_at_start(scenario.scene)
        self.axes = {key: np.asarray(values, dtype=float) for key, values in axes.items()}
        self.model = Model(self.scene)
        self.floating = [n for n, f in zip(("stator", "rotor"), self.model.unknowns.floats.values(), strict=True) if f]

    def rates(self) -> tuple[np.ndarray, np.ndarray]:
        """Growth rates (1/s) of all degrees of freedom and of the tilts alone; NaN where the scene cannot be."""
        (x_key, x), (y_key, y) = self.axes.items()
        total, tilt = np.empty((2, len(y), len(x)))
        rows = max(1, BLOCK // len(x))
        for at in range(0, len(y), rows):
            part = slice(at, at + rows)
            total[part], tilt[part] = self._block({x_key: x[None, :], y_key: y[part][:, None]}, part)
        return total, tilt

    def _block(self, grid, rows):
        given = _Given(self.scene, grid)
        possible = _possible(given, self.model.clearance)
        k, d, k_z, d_z = self.films(given, rows)
        mean_spin = 0.5 * (given("shaft.speed") + given("stator.speed"))
        tilt, axial = ([], [], []), ([], [], [])
        for ring in self.floating:
            spin = given("shaft.speed" if ring == "rotor" else "stator.speed")
            stiffness, damping = given.tilt(ring)
            moment = given(f"{ring}.transverse_inertia"), damping - 1j * given.polar(ring) * spin
            for column, value in zip(tilt, (*moment, stiffness - 1j * damping * spin), strict=True):
                column.append(value)
            for column, name in zip(axial, ("mass", "support.axial_damping", "support.axial_stiffness"), strict=True):
                column.append(given(f"{ring}.{name}"))
        tilts = growth_rates(*tilt, d, k - 1j * mean_spin * d)
        axials = growth_rates(*axial, d_z, k_z)
        shape = np.broadcast_shapes(possible.shape, *(v.shape for v in grid.values()))
        good = np.broadcast_to(possible, shape)
        return np.where(good, np.fmax(tilts, axials), np.nan), np.where(good, tilts, np.nan)

    # --- film coefficients ---------------------------------------------------------------------------

    @cached_property
    def films(self):
        """A function of the given values and rows: tilt and axial stiffness and damping of the film."""
        closed = self._closed_form()
        if closed and self._reproduces(closed):
            return lambda given, rows: closed(given)
        return self._rebuilt()

    def _closed_form(self):
        film, name = self.scene.film, self.model.interface.name
        own = film.coefficients if name == "linear" else "radial"
        if film.clearance is None or not isinstance(own, str) or film.tilt_radius != "local" or self.scene.contact:
            return None
        formula, more = (cf.film_coefficients, {}) if own == "green" else (
            cf.radial_film_coefficients, {"geometry": film.geometry})  # fmt: skip

        def closed(given):
            names = ("inner_radius", "outer_radius", "clearance", "coning", "viscosity")
            numbers = {n: given(f"film.{n}") for n in names}
            drop = given("film.outer_pressure") - given("film.inner_pressure")
            # Impossible faces are answered by the reference seal and blanked afterwards.
            good = _open(given, self.model.clearance)
            numbers = {n: np.where(good, v, getattr(film, n)) for n, v in numbers.items()}
            return formula(**numbers, pressure_drop=drop, **more)

        return closed

    def _reproduces(self, closed) -> bool:
        """Whether the formula is this film's own linearisation."""
        stiffness, damping = self.model.film_matrices()
        own = [stiffness[1, 1], damping[1, 1], stiffness[0, 0], damping[0, 0]]
        return bool(np.allclose(np.array(closed(_Given(self.scene, {}))), own, rtol=1e-6))

    def _rebuilt(self):
        """Linearise the film once for every value of the axes that touch it."""
        touching = [key for key in self.axes if key.startswith(("film.", "closing.", "contact."))]
        if "shaft.speed" in self.axes and self._follows_speed():
            touching.append("shaft.speed")
        shape = [len(v) if key in touching else 1 for key, v in self.axes.items()]
        table = np.full((4, *shape), np.nan)
        for place in product(*map(range, shape)):
            values = {key: float(v[i]) for (key, v), i in zip(self.axes.items(), place, strict=True) if key in touching}
            table[(slice(None), *place)] = self._coefficients(values)
        # Tables are stored (x, y); results are (y, x).
        table = np.swapaxes(table, 1, 2)
        return lambda given, rows: table if table.shape[1] == 1 else table[:, rows]

    def _coefficients(self, values) -> list[float]:
        try:
            model = Model(frozen_at_start(with_values(self.scenario, {**values, "run.start": "steady"}).scene))
        except (ScenarioError, SceneError):
            return [np.nan] * 4
        k, d = model.film_matrices()
        if abs(k[1, 1] - k[2, 2]) > 1e-6 * abs(k[1, 1]) or abs(k[1, 2] + k[2, 1]) > 1e-6 * abs(k[1, 2]) + 1e-9:
            raise SceneError("film.model", "a film that is not the same in all directions", "an isotropic film")
        return [k[1, 1], d[1, 1], k[0, 0], d[0, 0]]

    def _follows_speed(self) -> bool:
        """Whether the film's coefficients change with speed (those of liquid films do not)."""
        ends = [self.model.linear_scene(speed=float(w)) for w in self.axes["shaft.speed"][[0, -1]]]
        return not all(
            np.allclose(getattr(ends[0], m)[i, i], getattr(ends[1], m)[i, i], rtol=1e-6)
            for m in ("film_k", "film_d")
            for i in range(2)
        )


class _Given:
    """Value of a dotted key: the axis if it is one, else the scene's."""

    def __init__(self, scene, grid):
        self.scene, self.grid = scene, grid

    def __call__(self, key: str):
        if key in self.grid:
            return self.grid[key]
        value = self.scene
        for step in key.split("."):
            value = getattr(value, step)
        return value

    def polar(self, ring: str):
        if INERTIA_RATIO in self.grid:
            return self(f"{ring}.transverse_inertia") / self.grid[INERTIA_RATIO]
        return self(f"{ring}.polar_inertia")

    def tilt(self, ring: str):
        """Tilt stiffness and damping of the support.  As in a scenario, giving a tilt coefficient drops the radius
        and giving the radius drops the tilt coefficients."""
        by_tilt = any(f"{ring}.support.tilt_{n}" in self.grid for n in ("stiffness", "damping"))
        by_radius = f"{ring}.support.radius" in self.grid
        radius = None if by_tilt else self(f"{ring}.support.radius")
        if radius is not None or by_radius:
            half = np.square(radius) / 2
            return tuple(self(f"{ring}.support.axial_{n}") * half for n in ("stiffness", "damping"))
        found = [self(f"{ring}.support.tilt_{n}") for n in ("stiffness", "damping")]
        return tuple(0.0 if v is None else v for v in found)


def _open(given, clearance):
    """Where the radii and the film at both edges are possible."""
    r_i, r_o, floor = (given(f"film.{n}") for n in ("inner_radius", "outer_radius", "floor"))
    gap = given("film.clearance")
    gap = clearance if gap is None else gap
    outer = gap + given("film.coning") * np.subtract(r_o, r_i)
    return np.asarray((r_i > 0) & (r_i < r_o) & (gap > 0) & (outer > np.multiply(floor, gap)))


def _possible(given, clearance) -> np.ndarray:
    """Where the scene can be, by the rules a scenario is read by."""
    good = _open(given, clearance)
    for ring in ("stator", "rotor"):
        if getattr(given.scene, ring).support is None:
            continue
        transverse, polar = given(f"{ring}.transverse_inertia"), given.polar(ring)
        # Rounding of J = 2 (I / c) c must not exclude the thin disk itself.
        disk = polar <= 2 * np.asarray(transverse) * (1 + 1e-12)
        good = good & (disk | given(f"{ring}.unphysical_inertia")) & ((polar <= 0) | (np.asarray(transverse) > 0))
        radius = given(f"{ring}.support.radius")
        good = good & (True if radius is None else np.asarray(radius) > 0)
    floor = given("film.cavitation_pressure")
    if floor is not None:
        good = good & (np.minimum(given("film.outer_pressure"), given("film.inner_pressure")) >= floor)
    return np.asarray(good)
