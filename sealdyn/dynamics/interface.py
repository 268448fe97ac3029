"""What lies between the rings: the film of a scene, the asperities that may touch, and the borrowed numbers."""

from dataclasses import replace
from functools import cached_property, lru_cache

import numpy as np

from ..faces import contact
from ..faces.contact import lay_surfaces
from ..faces.geometry import (
    CLEARANCE,
    CONING_CHANGE,
    CONTACT_FORCE,
    CONTACT_TORQUE,
    CONTACT_X,
    CONTACT_Y,
    DZ,
    FLOOR,
    FLOW_INNER,
    FORCE,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    TORQUE,
    face_parameters,
)
from ..films import film_named, film_of
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.excitation import Housing
from ..scene.film import Coefficients, cells_of, coned
from ..scene.patterns import grooves_of, waves_of
from ..scene.scene import Closing, Initial, SceneError, with_values
from .condensation import NOISE, FilmDerivatives, LinearFilm, Slopes, film_slopes
from .equilibrium import settle
from .imposed_motion import asperity_steps, rest_state
from .intervals import constant_and_slope, spins

# Relative error of the quadrature of a film that is linearised: what a run is asked for does not matter to a verdict.
FINE = 1e-13
UNMOVED = {"initial": Initial(), "housing": Housing(), "shaft.motion": None, "stator.load": None, "rotor.load": None}
# How well a film with unknowns of its own knows its stiffness and damping, as a share, and a formula for them.
CONDENSED, FORMULA = 1e-9, 1e-13
# Pace (1/s) of the motion tried of films whose forces are linear in the rates: beside them the rounding of the static
# force is nothing.
FAST = 1e9
# Rounding of a gap, as a share of the clearance, and how far beyond their estimate errors of rough faces may be.
GAP_NOISE, SURE = 4e-16, 3.0


class Interface:
    """The film of a scene (`film` the Film, `name`, block `f`), its asperities (block `contact`, None without), and
    the aligned equilibrium: `clearance`, `closing`, `equilibria`, `message`.  `opening_force(clearance, p_i, p_o)` (N)
    is that of the aligned faces at rest, film and asperities; `observed`: film and block from which leakage, friction,
    film force and fields are reported; `unknowns` of the film (films/_contract.py), None of an algebraic one."""

    def __init__(self, scene, error: float, film=None):
        self.scene = scene
        self.film = film_of(scene, film)
        self.name = self.film.name
        self.opening_force = opening_law(scene, self.film)
        self.clearance, self.closing, self.equilibria, self.message = _settled(scene, self.film, self.opening_force)
        self._table_used = self._table()
        self.f = self.film.parameters(self._table_used, self.clearance, error)
        self.contact = lay_surfaces(self.f, scene)
        if self._borrowed() is not self.film:
            # The opening force is linear in both pressures.
            force = self._borrowed().opening_law(coned(scene), *spins(scene))
            for slot, ends in zip(self.film.opening_slots, ((1.0, 0.0), (0.0, 1.0)), strict=True):
                self.f[slot] = force(self.clearance, *ends, self.f[FLOOR] if scene.contact else None)
        self.unknowns = self.film.unknowns(self.f) if self.film.unknowns else None
        self.observed = self.film, self.f

    def _borrowed(self):
        """The film whose numbers the scene's film has."""
        return lender(self.scene, self.film)

    def _table(self):
        """The film's table; a linear film that borrows another film's coefficients gets them here."""
        table, source = prepared(self.scene, self.film), self._borrowed()
        if source is self.film:
            return table
        edges = initially(table.inner_pressure), initially(table.outer_pressure)
        if table.cavitation_pressure is not None and _clear(table, *edges):
            # Small motion meets no floor.
            table = replace(table, cavitation_pressure=None)
            source = film_named(source.name, table, self.scene.contact is not None)
        block = source.parameters(table, self.clearance, FINE)
        lay_surfaces(block, self.scene)
        # Where it does, it is the scene's own motion that says how much.
        pace, spin = (FAST, 0.0) if table.cavitation_pressure is None else (None, None)
        self._borrowed_slopes = film_slopes(
            source.wrench, block, *rest_state(self.scene, self.clearance, mean_spin=spin, pace=pace)
        )
        k, d = self._borrowed_slopes[:2]
        taken = Coefficients(
            tilt_stiffness=k[1, 1], tilt_damping=d[1, 1], axial_stiffness=k[0, 0], axial_damping=d[0, 0]
        )
        return replace(self.scene.film, coefficients=taken)

    @property
    def stores(self) -> bool:
        """Whether the film remembers: some of its unknowns have rates, and its coefficients hang on the frequency."""
        return self.unknowns is not None and bool(np.any(self.unknowns.differential))

    @property
    def grid_accuracy(self) -> float | None:
        """Relative error that the cells of the film may have beside the run's accuracy; None where it counts in that,
        or there are none."""
        return self.film.grid_accuracy(self._table_used) if self.film.grid_accuracy else None

    @property
    def cell_order(self) -> float:
        """Order of the cells' error."""
        return self.film.cell_order(self._table_used) if self.film.cell_order else 2.0

    def halved(self):
        """The Film table with half the cells of this one's."""
        return self.film.halved(self._table_used)

    def finer(self):
        """The Film table of aligned faces with four times the cells of this one's."""
        return self.film.finer(self._table_used)

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

    @cached_property
    def whole(self):
        """Block and unknowns of the film over the whole circle, whatever part of it stands for all in a run: what tilts
        that the run does not have do to it."""
        if self.film.whole is None:
            return self.f, self.unknowns
        f = self.film.parameters(self.film.whole(self._table_used), self.clearance)
        lay_surfaces(f, self.scene)
        if self.film.for_modes is not None:
            self.film.for_modes(f)
        return f, self.film.unknowns(f)

    def steady(self, f, s) -> np.ndarray:
        """Unknowns (n,) of the steady film at a gap state.  Raises SceneError if there are none."""
        return _steady(self.film, f, s, self.unknowns if f is self.f else self.film.unknowns(f))

    @cached_property
    def _fine(self) -> np.ndarray:
        """The film's block for linearising it: of the finest quadrature."""
        if self.film.constant:
            return self.f
        f = self.film.parameters(self._table_used, self.clearance, FINE)
        lay_surfaces(f, self.scene)
        return f

    def floor_is_clear(self, interval=None) -> bool:
        """Whether small motion of the aligned film never meets the floor of its pressure, or it has none."""
        film = self.scene.film
        first = (lambda q: constant_and_slope(q, interval)[0]) if interval else initially
        return _clear(film, first(film.inner_pressure), first(film.outer_pressure))

    @cached_property
    def _unfloored(self):
        """Function `wrench(f, s)` and block of the film without the floor of its pressure."""
        table = replace(self._table_used, cavitation_pressure=None)
        plain = film_named(self.name, table, self.scene.contact is not None)
        f = plain.parameters(table, self.clearance, FINE)
        lay_surfaces(f, self.scene)
        return plain.wrench, f

    def slopes(self, interval=None, mean_spin=None, shift=0.0, omega=0.0, pace=None, film=None) -> Slopes:
        """Stiffness and damping of film and asperities about the aligned rest state and how well they are known,
        arguments as `rest_state`; of a film with unknowns at the frequency `omega` (rad/s), of its `linear_film` if
        given."""
        return self.slopes_about(*rest_state(self.scene, self.clearance, interval, mean_spin, shift, pace), omega, film)

    def slopes_about(self, s, steps, omega=0.0, film=None) -> Slopes:
        """The same about any gap state at rest, `steps` as in condensation.moved_gaps."""
        found = self._film_slopes(s, steps, omega, film)
        if self.contact is None:
            return found
        clear = asperity_steps(self.scene, self.clearance + s[DZ], s[CONING_CHANGE])
        rough = film_slopes(self._asperities_alone, self._fine, s, clear)
        both = self._sure(found, steps), self._sure(rough, clear)
        return Slopes(*(a + b for a, b in zip(*both, strict=True)))

    def _film_slopes(self, s, steps, omega, film) -> Slopes:
        """Stiffness and damping of the film alone."""
        if self.film.matrices is not None:
            error = np.finfo(float).eps if isinstance(self.scene.film.coefficients, Coefficients) else FORMULA
            own = _known(*self.film.matrices(self.f, s), error)
            if self._borrowed() is self.film:
                return own
            more = self._borrowed_slopes
            return own._replace(
                stiffness_error=own.stiffness_error + more.stiffness_error,
                damping_error=own.damping_error + more.damping_error,
            )
        if self.unknowns is None:
            floored, wrench, f = self.scene.film.cavitation_pressure is not None, self.film.wrench, self._fine
            if floored and _clear(self.scene.film, s[INNER_PRESSURE], s[OUTER_PRESSURE]):
                # Small motion never meets the floor.
                wrench, f = self._unfloored
            return film_slopes(wrench, f, s, steps)
        matrices = (film or self.linear_film(s, steps)).matrices(omega)
        return _known(*matrices, CONDENSED if self.contact is None else CONDENSED + NOISE * self.clearance / steps[0])

    def _sure(self, found: Slopes, steps) -> Slopes:
        """Slopes between rough faces: asperities are steep, so that the gap's own rounding shows in the force, and
        their differences converge more slowly than a film's."""
        rounding = GAP_NOISE * self.clearance / steps[0] * np.abs(found.stiffness)
        return found._replace(stiffness_error=SURE * found.stiffness_error + rounding)

    def linear_film(self, s, steps) -> LinearFilm:
        """A film with unknowns about a gap state, these steady; `steps` as in condensation.moved_gaps."""
        f, unknowns = self.whole
        found = LinearFilm.about(FilmDerivatives(self.film, unknowns, f), s, self.steady(f, s), steps)
        return found if self.film.frame is None else found.seen_from_rest(self.film.frame(f, s))

    def about(self, s, steps, omega=0.0):
        """Stiffness and damping matrices (3, 3) of film and asperities about a gap state, `steps` as in
        condensation.moved_gaps; of a film with unknowns at the frequency `omega` (rad/s)."""
        if self.film.matrices is not None:
            stiffness, damping = self.film.matrices(self.f, s)
        elif self.unknowns is None:
            return film_slopes(self.wrench, self._fine, s, steps)[:2]
        else:
            stiffness, damping = self.linear_film(s, steps).matrices(omega)
        if self.contact is not None:
            stiffness = stiffness + film_slopes(self._asperities_alone, self._fine, s, steps).stiffness
        return stiffness, damping

    def _asperities_alone(self, f, s):
        contact.contact_load(self.contact, f, s)
        s[FORCE : FORCE + 3] = s[CONTACT_FORCE : CONTACT_FORCE + 3]


def _clear(film, inner_pressure, outer_pressure) -> bool:
    """Whether the pressure of an aligned `Film` lies above its floor inside the face.  At the floor it may be at an
    edge that the pressure rises from."""
    floor, low = film.cavitation_pressure, min(inner_pressure, outer_pressure)
    # What turns the fluid draws the pressure below both edges.
    above = floor is None or floor < low or (floor == low and inner_pressure != outer_pressure)
    return above and (floor is None or not film.inertia)


def lender(scene, film):
    """The film whose numbers a scene's `film` has: its own, or the radial film's in a linear film that says so."""
    borrows = film.opening_slots is not None and scene.film.coefficients == "radial"
    return film_named("radial", scene.film, scene.contact is not None) if borrows else film


def prepared(scene, film):
    """The `Film` table of a scene as its `film` takes it: with enough cells for what it is asked for; cells that are
    given stay.  Raises SceneError where the seal has no balance, and for more cells than are looked for."""
    if film.prepared is None:
        return scene.film
    given = film.cells_are_given is None or film.cells_are_given(scene.film)
    return film.prepared(scene) if given else _searched(Asked(scene, film))


def opening_law(scene, film=None):
    """Function `force(clearance, p_i, p_o)` (N): film and asperities together of a scene's aligned faces at rest."""
    parts = opening_parts(scene, film)
    return lambda clearance, inner, outer: sum(parts(clearance, inner, outer))


def opening_parts(scene, film=None):
    """Function `forces(clearance, p_i, p_o)` (N, N): opening force of the film, with the floor of rough faces, and of
    touching asperities, of aligned faces at rest (clearance in m, pressures in Pa); by a `film`, or the scene's own."""
    film_force = _film_force(scene, film)
    if not scene.contact:
        return lambda clearance, inner, outer: (film_force(clearance, inner, outer), 0.0)
    s, face = np.zeros(GAP_STATE_SIZE), face_parameters(coned(scene), 1.0)
    asperities = lay_surfaces(face, scene)

    def forces(clearance: float, inner_pressure: float, outer_pressure: float) -> tuple[float, float]:
        face[CLEARANCE] = clearance
        contact.contact_load(asperities, face, s)
        return film_force(clearance, inner_pressure, outer_pressure, face[FLOOR]), float(s[CONTACT_FORCE])

    return forces


def _film_force(scene, film):
    """Function `force(clearance, p_i, p_o, floor)` (N) of that film alone."""
    if grooves_of(scene)[1] and film is None:
        # Nearer than the mesh of a run; whatever closes the faces, at whatever clearance.
        law = _over_grooves(Asked(replace(scene, closing=Closing(), film=replace(scene.film, clearance=None))))
        return lambda clearance, inner, outer, floor=None: law(clearance, inner, outer)
    film = lender(scene, film_of(scene, film))
    table, surfaces = coned(replace(scene, film=prepared(scene, film))), {}
    if waves_of(scene) and film.standing_waves:
        surfaces["waves"] = scene.stator.waviness, scene.rotor.waviness
    if scene.contact and film.waves_touch:
        surfaces["contact"] = scene.contact
    return film.opening_law(table, *spins(scene), **surfaces)


@lru_cache(maxsize=8)
def _over_grooves(asked):
    from ..films._grooved.aligned import extrapolated_force

    return extrapolated_force(asked.scene)


def _settled(scene, film, opening_force):
    """`settle` of a scene, remembered where the clearance is searched for: several models of a scene are made."""
    if scene.film.clearance is not None:
        return settle(scene, opening_force)
    # What moves the rings matters to the cells only, and may hold records of any length.
    alike = scene if film.prepared is not None else with_values(scene, UNMOVED)
    return _searched_clearance(Asked(alike, film))


@lru_cache(maxsize=8)
def _searched_clearance(asked):
    return settle(asked.scene, opening_law(asked.scene, asked.film))


def flow_at_rest(interface, s, observed=None) -> None:
    """Loads, flows and friction of film and asperities at a gap state at rest, into it; `observed` film and block in
    place of the interface's own.  Raises SceneError."""
    film, f = observed or interface.observed
    _flow(film, f, s, [interface.steady(f, s)] if interface.unknowns is not None else [], interface.contact)


def loads_at_rest(scene, film, clearance: float, error: float) -> np.ndarray:
    """The gap state at rest with loads, flows and friction of a `film`, its integrals to an `error`, and asperities at
    a clearance (m), whatever closes the faces: what a search asks many times.  Raises SceneError."""
    f = film.parameters(prepared(scene, film), clearance, error)
    rough, (s, _) = lay_surfaces(f, scene), rest_state(scene, clearance)
    _flow(film, f, s, [_steady(film, f, s, film.unknowns(f))] if film.unknowns else [], rough)
    return s


def _flow(film, f, s, own, rough) -> None:
    film.flow(f, s, *own)
    if rough is not None:
        contact.contact_load_and_friction(rough, f, s)


def _steady(film, f, s, unknowns) -> np.ndarray:
    x = np.empty(len(unknowns.names))
    if code := film.start(f, s, x):
        raise SceneError("film", film.status[code], "a gap at which this film has a solution")
    return x


def _known(stiffness, damping, error) -> Slopes:
    """Stiffness and damping known to a relative `error`."""
    return Slopes(stiffness, damping, error * np.abs(stiffness), error * np.abs(damping))


# --- Cells ---------------------------------------------------------------------------------------------

# How many cells a film needs: doubled until the balance of the aligned seal hardly changes.
#
# **Source** Richardson (1911): what doubling changes, over 2^p - 1, is the error of a method of order p; here half of
# the change is, since fronts of cavities are of lower order than the rest.

# Grids that are tried, coarsest first, each with twice the cells of the one before.
MOST_DOUBLINGS = 4
# Most cells that are looked for, of a sector thrice, for its mean, cosine and sine around the circle; and what so many
# take to make ready, as measured on one core: seconds, with the square of their count, and bytes.
MOST_SOUGHT, MEASURED, SECONDS, BYTES = 7000, 6480, 12.0, 0.5e9
# Share of a change that counts as the error of the finer grid.
CHANGED = 0.5
# Coefficient of friction that is rounding: a standing shaft has none, and its logarithm would never settle.
NOTHING = 1e-9
# What is searched so often need not be searched again; the scenes of a study.
REMEMBERED = 64


class Asked:
    """A scene as what a search may be remembered by."""

    def __init__(self, scene, film=None):
        self.scene, self.film, self.words = scene, film, f"{film and film.name} {scene!r}"

    def __eq__(self, other):
        return self.words == other.words and self.film == other.film

    def __hash__(self):
        return hash(self.words)


@lru_cache(maxsize=REMEMBERED)
def _searched(asked):
    scene, film = asked.scene, asked.film
    wanted, before = film.grid_accuracy(film.prepared(scene)), None
    for doubling in range(MOST_DOUBLINGS):
        table = film.doubled(film.prepared(scene), doubling)
        _refuse_many(table, wanted)
        loads = _balance(replace(scene, film=table))
        if before is not None and CHANGED * float(np.max(np.abs(loads - before))) <= wanted:
            break
        before = loads
    return table


def _refuse_many(table, wanted):
    """Raises SceneError for cells that are not asked for by their number and would take minutes, before any is laid."""
    cells, angles, sectors = cells_of(table)
    count = cells * angles * min(sectors, 3)
    times = count / MEASURED
    if count > MOST_SOUGHT:
        cost = f"some {in_words('time', SECONDS * times**2, 2)} and {in_words('B', BYTES * times, 2)} to make ready"
        found = f"{wanted:g}, for which the next cells are {cells} x {angles * sectors}: {cost}"
        expected = "a looser accuracy of the cells, or cells_r and cells_theta, which are taken as they are"
        raise SceneError("film.reynolds.grid_accuracy", found, expected)


def _balance(scene) -> np.ndarray:
    """What film and asperities carry, leak and rub where the aligned seal rests, with what is carried at the clearance
    of that; each over the scale of its own."""
    interface = Interface(scene, 1e-8)
    s, _ = rest_state(scene, interface.clearance)
    flow_at_rest(interface, s)
    load = max(abs(s[FORCE] + s[CONTACT_FORCE]), 1e-300)
    return np.array([
        s[FORCE] / load,
        np.log(max(abs(s[FLOW_INNER]), 1e-300)),
        np.log(max(abs(s[TORQUE] + s[CONTACT_TORQUE]), NOTHING * load * scene.film.outer_radius)),
        np.log(interface.clearance),
    ])  # fmt: skip
