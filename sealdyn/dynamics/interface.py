"""What lies between the rings: the film of a scene, the asperities that may touch, and the borrowed numbers."""

from dataclasses import replace

import numpy as np

from ..faces import contact
from ..faces.geometry import (
    CLEARANCE,
    CONTACT_FORCE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FLOOR,
    FORCE,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    SPIN_DIFFERENCE,
    VISCOSITY,
    face_parameters,
)
from ..faces.surfaces import lay_surfaces
from ..films import film_module, film_name, film_of, has_unknowns
from ..numerics.piecewise_linear import initially
from ..scene.film import Coefficients
from ..scene.scene import SceneError
from .condensation import LinearFilm, linearise
from .equilibrium import settle
from .intervals import constant_and_slope


class Interface:
    """The film of a scene (`film` its module, `name`, block `f`), its asperities (block `contact`, None without), and
    the aligned equilibrium: `clearance`, `closing`, `equilibria`, `message`.  `opening_force(clearance, p_i, p_o)` (N)
    is that of the aligned faces at rest, film and asperities; `observed`: film and block from which leakage, friction,
    film force and fields are reported; `unknowns` of the film (films/_unknowns.py), None of an algebraic one."""

    def __init__(self, scene, error: float, film=None):
        self.scene = scene
        self.film = film_of(scene, film)
        self.name = film_name(self.film)
        self.opening_force = opening_law(scene, self.film)
        self.clearance, self.closing, self.equilibria, self.message = settle(scene, self.opening_force)
        self.f = self.film.parameters(self._table(), self.clearance, error)
        self.contact = lay_surfaces(self.f, scene)
        if self._borrowed() is not self.film:
            # The opening force is linear in both pressures.
            force = self._borrowed().opening_law(scene.film)
            for slot, ends in ((self.film.FORCE_I, (1.0, 0.0)), (self.film.FORCE_O, (0.0, 1.0))):
                self.f[slot] = force(self.clearance, *ends)
        self.unknowns = self.film.unknowns(self.f) if has_unknowns(self.film) else None
        self.observed = self.film, self.f

    def _borrowed(self):
        """The film whose numbers the scene's film has."""
        return _lender(self.scene, self.film)

    def _table(self):
        """The film's table; a linear film that borrows another film's coefficients gets them here."""
        table, source = self.scene.film, self._borrowed()
        if source is self.film:
            return table
        block = source.parameters(table, self.clearance, 1e-13)
        k, d = linearised_film(source.wrench, block, self.scene, self.clearance)
        taken = Coefficients(
            tilt_stiffness=k[1, 1], tilt_damping=d[1, 1], axial_stiffness=k[0, 0], axial_damping=d[0, 0]
        )
        return replace(table, coefficients=taken)

    @property
    def stores(self) -> bool:
        """Whether the film remembers: some of its unknowns have rates, and its coefficients hang on the frequency."""
        return self.unknowns is not None and bool(np.any(self.unknowns.differential))

    @property
    def film_wrench(self):
        """Function `wrench(f, s)`: force and moments of the film alone; of one with unknowns when it is steady."""
        return self.film.wrench if self.unknowns is None else self._steady_wrench

    @property
    def wrench(self):
        """Function `wrench(f, s)`: film and asperities together, as the force and moments of the film."""
        return self.film_wrench if self.contact is None else self._rough_wrench

    def _steady_wrench(self, f, s):
        self.film.wrench(f, s, self.steady(f, s))

    def _rough_wrench(self, f, s):
        self.film_wrench(f, s)
        contact.contact_load(self.contact, f, s)
        for film, rough in ((FORCE, CONTACT_FORCE), (MOMENT_X, CONTACT_X), (MOMENT_Y, CONTACT_Y)):
            s[film] += s[rough]

    def steady(self, f, s) -> np.ndarray:
        """Unknowns (n,) of the steady film at a gap state.  Raises SceneError if there are none."""
        x = np.empty(len(self.unknowns.names))
        code = self.film.start(f, s, x)
        if code:
            raise SceneError("film", self.film.STATUS[code], "a gap at which this film has a solution")
        return x

    def linearised(self, interval=None, mean_spin=None, shift=0.0, omega=0.0, pace=None, film=None):
        """Stiffness and damping matrices (3, 3) of film and asperities about the aligned rest state, as
        `linearised_film`; of a film with unknowns at the frequency `omega` (rad/s), of its `linear_film` if given."""
        if self.unknowns is None:
            return linearised_film(self.wrench, self.f, self.scene, self.clearance, interval, mean_spin, shift, pace)
        s, steps = rest_state(self.scene, self.clearance, interval, mean_spin, shift, pace)
        return self._with_asperities((film or self.linear_film(s, steps)).matrices(omega), s, steps)

    def linear_film(self, s, steps) -> LinearFilm:
        """A film with unknowns about a gap state, these steady; `steps` as in condensation.moved_gaps."""
        # Sparse matrices are loaded for a film with unknowns only.
        from .film_derivatives import FilmDerivatives

        derivatives = FilmDerivatives(self.film, self.unknowns, self.f)
        return LinearFilm(derivatives, s, self.steady(self.f, s), steps)

    def about(self, s, steps, omega=0.0):
        """Stiffness and damping matrices (3, 3) of film and asperities about a gap state, `steps` as in
        condensation.moved_gaps; of a film with unknowns at the frequency `omega` (rad/s)."""
        if self.unknowns is None:
            return linearise(self.wrench, self.f, s, steps)
        return self._with_asperities(self.linear_film(s, steps).matrices(omega), s, steps)

    def _with_asperities(self, matrices, s, steps):
        """The film's stiffness and damping `matrices`, and those of the asperities."""
        if self.contact is None:
            return matrices
        rough = linearise(self._asperities_alone, self.f, s, steps)
        return matrices[0] + rough[0], matrices[1] + rough[1]

    def _asperities_alone(self, f, s):
        contact.contact_load(self.contact, f, s)
        s[FORCE : FORCE + 3] = s[CONTACT_FORCE : CONTACT_FORCE + 3]


def _lender(scene, film):
    """The film whose numbers a scene's `film` has: its own, or the radial film's in a linear film that says so."""
    borrows = film_name(film) == "linear" and scene.film.coefficients == "radial"
    return film_module("radial", scene.film) if borrows else film


def opening_law(scene, film=None):
    """Function `force(clearance, p_i, p_o)` (N): film and asperities together of a scene's aligned faces at rest."""
    parts = opening_parts(scene, film)
    return lambda clearance, inner, outer: sum(parts(clearance, inner, outer))


def opening_parts(scene, film=None):
    """Function `forces(clearance, p_i, p_o)` (N, N): opening force of the film, with the floor of rough faces, and of
    the asperities that touch, of a scene's aligned faces at rest; clearance in m, pressures in Pa.  The scene names its
    film, unless a `film` is given."""
    film_force = _lender(scene, film_of(scene, film)).opening_law(scene.film)
    if not scene.contact:
        return lambda clearance, inner, outer: (film_force(clearance, inner, outer), 0.0)
    s, face = np.zeros(GAP_STATE_SIZE), face_parameters(scene.film, 1.0)
    asperities = lay_surfaces(face, scene)

    def forces(clearance: float, inner_pressure: float, outer_pressure: float) -> tuple[float, float]:
        face[CLEARANCE] = clearance
        contact.contact_load(asperities, face, s)
        return film_force(clearance, inner_pressure, outer_pressure, face[FLOOR]), float(s[CONTACT_FORCE])

    return forces


def rest_state(scene, clearance, interval=None, mean_spin=None, shift=0.0, pace=None):
    """Gap state of the aligned rings at rest at an interval's start, the gap `shift` (m) wider than the clearance, and
    steps for derivatives about it; `mean_spin` (rad/s) in place of the scene's, `pace` (1/s) of the motion that is
    tried in place of it."""
    s = np.zeros(GAP_STATE_SIZE)
    s[DZ] = shift
    clearance = clearance + shift
    first = (lambda q: constant_and_slope(q, interval)[0]) if interval else initially
    s[VISCOSITY] = first(scene.film.viscosity)
    s[INNER_PRESSURE], s[OUTER_PRESSURE] = first(scene.film.inner_pressure), first(scene.film.outer_pressure)
    w_r, w_s = first(scene.shaft.speed), first(scene.stator.speed)
    s[MEAN_SPIN] = 0.5 * (w_r + w_s) if mean_spin is None else mean_spin
    s[SPIN_DIFFERENCE] = w_r - w_s
    length, tilt = 0.02 * clearance, 0.02 * clearance / scene.film.outer_radius
    pace = max(abs(s[MEAN_SPIN]), 1.0) if pace is None else pace
    return s, (length, tilt, length * pace, tilt * pace)


def linearised_film(wrench, f, scene, clearance, interval=None, mean_spin=None, shift=0.0, pace=None):
    """Stiffness and damping matrices (3, 3) of a film's `wrench(f, s)` about `rest_state`."""
    s, steps = rest_state(scene, clearance, interval, mean_spin, shift, pace)
    return linearise(wrench, f, s, steps)
