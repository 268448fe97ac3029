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

from ... import closed_form as cf
from ...dynamics.exponents import roots
from ...dynamics.linearisation import moves_with_speed
from ...dynamics.model import Model
from ...scenario.errors import ScenarioError
from ...scenario.reader import with_values
from ...scene.film import coning_varies
from ...scene.forces import HALF_HEIGHT
from ...scene.scene import SceneError, frozen_at_start, part, refuse_uneven

INERTIA_RATIO = "inertia_ratio"
BLOCK = 100_000


def growth_rates(masses, dampings, stiffnesses, film_damping, film_stiffness) -> np.ndarray:
    """Largest real part (1/s) of the roots of one or two rings on one film, 0 where its error bound contains zero; all
    arguments broadcast.

    `masses`, `dampings`, `stiffnesses`: lists, one entry per floating ring, complex where the ring spins; the film's
    two act on the sum (one ring) or difference (two rings) of displacements.
    """
    rings = list(zip(masses, dampings, stiffnesses, strict=True))
    values, errors = roots(rings, (film_damping, film_stiffness))
    rates = np.where(np.isnan(values), -np.inf, values.real)
    largest = np.max(rates, axis=-1, initial=-np.inf)
    grows = np.max(np.where(np.isnan(values), -np.inf, rates - errors), axis=-1, initial=-np.inf) > 0.0
    dies = np.max(np.where(np.isnan(values), -np.inf, rates + errors), axis=-1, initial=-np.inf) < 0.0
    return np.where(np.isinf(largest), np.nan, np.where(grows | dies, largest, 0.0))


class Grid:
    """A scenario over two axes: `axes` maps a dotted key (or "inertia_ratio") to its values; the first is x, the
    second y, and every result has shape (y, x).
    **Valid** a film with one stiffness and damping at any frequency: not one that stores."""

    def __init__(self, scenario, axes: dict[str, np.ndarray]):
        self.scenario, self.scene = scenario, frozen_at_start(scenario.scene)
        refuse_uneven(self.scene)
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
        if (
            film.gas is not None
            or film.liquid is not None
            or film.clearance is None
            or not isinstance(own, str)
            or film.tilt_radius != "local"
            or self.scene.contact
            or coning_varies(film)
        ):
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
        if "stator.speed" in self.axes and self.scene.film.inertia:
            touching.append("stator.speed")
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
        """Whether the film's coefficients change with speed (those of liquid films with a cone of its own do not)."""
        if moves_with_speed(self.scene):
            return True
        ends = [self.model.linear_scene(speed=float(w)) for w in self.axes["shaft.speed"][[0, -1]]]
        return not all(
            np.allclose(first[i, i], last[i, i], rtol=1e-6)
            for first, last in ((ends[0].film_k, ends[1].film_k), (ends[0].film_d, ends[1].film_d))
            for i in range(2)
        )


class _Given:
    """Value of a dotted key: the axis if it is one, else the scene's."""

    def __init__(self, scene, grid):
        self.scene, self.grid = scene, grid

    def __call__(self, key: str):
        return self.grid[key] if key in self.grid else part(self.scene, key)

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
    slope = given("film.coning") + given("film.coning_per_speed_squared") * np.square(given("shaft.speed"))
    if given("film.coning_per_kelvin"):
        warmer = given("film.temperature") - given("film.coning_reference_temperature")
        slope = slope + given("film.coning_per_kelvin") * warmer
    if given("film.coning_per_pressure"):
        sealed = np.abs(np.subtract(given("film.outer_pressure"), given("film.inner_pressure")))
        slope = slope + given("film.coning_per_pressure") * (sealed - given("film.coning_reference_pressure"))
    outer = gap + slope * np.subtract(r_o, r_i)
    # Rough faces are closed where all their asperities are flat.
    rough = given.scene.contact
    flat = 0.0 if rough and rough.law == "plateaus" else -HALF_HEIGHT
    lowest = np.multiply(flat, given("contact.roughness")) if rough else np.multiply(floor, gap)
    return np.asarray((r_i > 0) & (r_i < r_o) & (gap > 0) & (outer > lowest))


def _possible(given, clearance) -> np.ndarray:
    """Where the scene can be, by the rules a scenario is read by."""
    good = _open(given, clearance)
    for ring, body in (("stator", given.scene.stator), ("rotor", given.scene.rotor)):
        if body.support is None:
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
