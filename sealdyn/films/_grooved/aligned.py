"""The aligned film of a scene with grooves: opening force over the clearance, flows and torque, small motion.

Numbers are Richardson's of two meshes (`order` of balance.py), the finer of which has twice the columns.  The opening
force over many clearances is read from values and slopes at clearances evenly spaced in their logarithm, cubic between
them (Hermite), each computed when it is first needed.
**Source** balance.py, motion.py; the slope of the force is the film's own axial stiffness at rest.
**Valid** as they; a liquid whose pressure falls below zero is refused unless it has a cavitation pressure.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

from ...faces.pattern import Box, Boxes, Dimples, Pattern, Spiral, pumps
from ...numerics.piecewise_linear import initially
from ...scene.film import coned
from ...scene.fluid import GasReynolds, gas_of, viscosity_of
from ...scene.forces import contact_thresholds
from ...scene.patterns import Grooves, grooves_of
from ...scene.scene import SceneError
from .balance import COLUMNS, Conditions, NoSteadyFilm, Steady, extrapolated, order, steady
from .mesh import Mesh, mesh_on
from .motion import Motion, axial_film

# Columns of the coarser mesh where a force is wanted at many clearances; e-folds of the clearance from node to node;
# clearances (m) between which films are looked for, and the least where rough faces keep a film that meet.
MANY, STRIDE, THINNEST, WIDEST, MET = 8, 0.1, 2e-8, 2e-3, 5e-10


def pattern_of(one: Grooves) -> Pattern:
    """The pattern of a row of grooves."""
    if one.shape == "spiral":
        return Spiral(one.count, one.inner_radius, one.outer_radius, one.angle, one.share, one.depth, one.phase)
    if one.shape == "dimples":
        return Dimples(one.count, one.radius, one.length, one.width, one.angle or 0.0, one.depth, one.phase)
    arms = Box(one.inner_radius, one.outer_radius, one.share)
    if one.shape == "pad":
        return Boxes(one.count, one.depth, (arms,), one.phase)
    stem = Box(one.outer_radius, one.stem_outer_radius, one.stem_share)
    return Boxes(one.count, one.depth, (arms, stem), one.phase)


def cavity_of(film) -> float | None:
    """Pressure (Pa) at which the liquid of a `Film` table tears over grooves, None where it never does."""
    kept = film.reynolds is not None and film.reynolds.cavitation == "none"
    return None if kept else film.cavitation_pressure


def conditions_of(scene, clearance: float) -> Conditions:
    """The film of a scene at its start, at a clearance (m)."""
    film, gas = coned(scene), gas_of(scene.film)
    slip = gas is not None and (film.gas_reynolds or GasReynolds()).slip
    return Conditions(
        clearance=clearance,
        viscosity=initially(viscosity_of(film)),
        inner_pressure=initially(film.inner_pressure),
        outer_pressure=initially(film.outer_pressure),
        relative_speed=initially(scene.shaft.speed) - initially(scene.stator.speed),
        face=grooves_of(scene)[0],
        coning=initially(film.coning),
        gas=gas is not None,
        slip=math.sqrt(0.5 * math.pi * gas.gas_constant * initially(film.temperature)) if slip else 0.0,
        cavity=cavity_of(film),
        floor=contact_thresholds(scene.contact)[0] if scene.contact else 0.0,
    )


@dataclass(frozen=True, eq=False)
class AlignedFilm:
    """The film of a scene with grooves at a clearance on a coarse and a fine mesh, and the order of their error."""

    coarse: Steady
    fine: Steady
    frame: float
    grooves: Grooves

    @cached_property
    def order(self) -> float:
        """Order of the meshes' error."""
        return order(self.fine.film)

    def better(self, number):
        """Richardson's value of a `number(steady)` and the error of the fine mesh's."""
        return extrapolated(number(self.coarse), number(self.fine), self.order)

    @cached_property
    def motions(self) -> tuple[Motion, Motion]:
        """Small motion on both meshes."""
        return Motion(self.coarse, self.frame), Motion(self.fine, self.frame)

    def of_motion(self, number):
        """As `better`, of a `number(motion)`."""
        return extrapolated(*(number(motion) for motion in self.motions), self.order)

    @property
    def pumping(self) -> str | None:
        """Which way spiral grooves pump; None of a tee, which has no sense."""
        spiral = self.grooves.shape == "spiral"
        return pumps(self.grooves.angle, self.fine.film.conditions.entrainment) if spiral else None

    @property
    def least_pressure(self) -> float:
        """Pa, absolute."""
        return float(self.fine.p.min())


def mesh_of_row(face: str, one: Grooves, film, columns: float, times: int, least: int = 2) -> Mesh:
    """One pitch of a row of grooves in a face, between the radii of a `Film` table.  Raises SceneError for grooves so
    many and so flat, or dimples so small, that it has too many nodes."""
    try:
        return mesh_on(pattern_of(one), film.inner_radius, film.outer_radius, columns, times, least)
    except ValueError as error:
        raise SceneError(f"{face}.grooves", str(error), "fewer, steeper or larger ones") from None


def meshes_of(scene, columns: int) -> list[Mesh]:
    """The coarser and the finer mesh of a scene.  Raises SceneError as `mesh_of_row`."""
    face, (one,) = grooves_of(scene)
    return [mesh_of_row(face, one, scene.film, columns, times) for times in (1, 2)]


def aligned_film(scene, clearance: float, columns: int = COLUMNS, near: AlignedFilm | None = None) -> AlignedFilm:
    """The film of a scene with grooves at a clearance (m), so many columns to a pitch of the coarser mesh; one `near`
    by, on the same meshes, is where it is looked for first.  Raises SceneError where there is none, or where a liquid
    would tear."""
    face, film, meshes = grooves_of(scene)[0], scene.film, meshes_of(scene, columns)
    known = (None, None) if near is None else (near.coarse.p, near.fine.p)
    try:
        pair = [steady(mesh, conditions_of(scene, clearance), p) for mesh, p in zip(meshes, known, strict=True)]
    except (NoSteadyFilm, ValueError) as error:
        where = f"a clearance of {clearance:.4g} m over grooves: {error}"
        raise SceneError("film", where, "a clearance of the size of a film's") from None
    frame = initially(scene.shaft.speed) if face == "rotor" else initially(scene.stator.speed)
    found = AlignedFilm(*pair, frame, grooves_of(scene)[1][0])
    if film.gas is None and found.fine.void is None and found.least_pressure < 0.0:
        where = f"a film that would tear (least pressure {found.least_pressure:.3g} Pa)"
        raise SceneError(
            f"{face}.grooves", where, "film.cavitation_pressure, or grooves over which the liquid keeps a pressure"
        )
    return found


class OpeningForce:
    """Opening force (N) of the aligned film over the clearance, `force(clearance, inner_pressure, outer_pressure)`; NaN
    where it has no film, as below `thinnest` (m).  `with_slope` of the same arguments gives the force and its slope by
    the logarithm of the clearance (N), NaN where there is none."""

    def __init__(self, with_slope, thinnest=THINNEST):
        self.with_slope, self.thinnest, self.nodes, self.none_below = with_slope, thinnest, {}, {}

    def __call__(self, clearance: float, inner_pressure: float, outer_pressure: float) -> float:
        if not self.thinnest <= clearance <= WIDEST:
            return math.nan
        at, pressures = math.log(clearance) / STRIDE, (inner_pressure, outer_pressure)
        k = math.floor(at)
        (f0, d0), (f1, d1) = (self._node(n, pressures) for n in (k, k + 1))
        x = at - k
        return float(
            (1.0 + 2.0 * x) * (1.0 - x) ** 2 * f0 + x * x * (3.0 - 2.0 * x) * f1
            + x * (1.0 - x) ** 2 * d0 - x * x * (1.0 - x) * d1
        )  # fmt: skip

    def _node(self, n: int, pressures) -> tuple[float, float]:
        """Force (N) and its change per node (N) at node n."""
        key = (n, *pressures)
        if key not in self.nodes:
            self.nodes[key] = self._found(n, pressures)
        return self.nodes[key]

    def _found(self, n: int, pressures) -> tuple[float, float]:
        # Thinner than one that has no film there is none either.
        if n <= self.none_below.get(pressures, -math.inf):
            return math.nan, math.nan
        force, slope = self.with_slope(math.exp(n * STRIDE), *pressures)
        if math.isnan(force):
            self.none_below[pressures] = max(n, self.none_below.get(pressures, n))
        return force, slope * STRIDE


def extrapolated_force(scene) -> OpeningForce:
    """That of a scene, extrapolated from two meshes.  Raises SceneError for grooves that have no mesh: no clearance
    makes good for it."""
    meshes_of(scene, MANY)
    found = {}

    def with_slope(clearance, inner, outer):
        table = replace(scene.film, inner_pressure=inner, outer_pressure=outer)
        near = min(found, key=lambda other: abs(math.log(other / clearance)), default=None)
        try:
            film = aligned_film(replace(scene, film=table), clearance, MANY, found.get(near))
        except SceneError:
            return math.nan, math.nan
        found[clearance] = film
        return film.better(lambda one: one.force)[0], -film.better(axial_stiffness)[0] * clearance

    return OpeningForce(with_slope, MET if scene.contact else THINNEST)


def axial_stiffness(found: Steady) -> float:
    """Of a steady film that moves slowly, N/m, of any count of grooves."""
    return -found.film.mesh.count * float(axial_film(found)(0.0)[0, 0].real)
