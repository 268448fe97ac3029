"""Ludwig & Allen's ring in time: two unknowns, mean film and amplitude, on the radial film, by IDA.

**Source** Ludwig & Allen, NASA TN D-8102 (1976), whose balance of spring force and of the moment about the diameter
through thickest and thinnest film becomes two equations for h0, h1 and their rates.
**Valid** no inertia; planar film of constant thickness over a narrow face (face width <= 0.02 mean radius for 1e-4);
half-Sommerfeld cavitation: an estimate.  The seat is tilted by a fixed angle, the ring turns.  Under sealed pressures
the spring force is the closing load that the film at rest leaves, and a film's force what it has beyond that at rest.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from ..closed_form import ludwig_allen as closed
from ..closed_form.sealed_wedge import Edges
from ..faces.geometry import (
    DZ,
    DZ_RATE,
    FORCE,
    GAP_STATE_SIZE,
    GX,
    GX_RATE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    VISCOSITY,
)
from ..films.radial import floored as radial
from ..quantities import in_words
from ..scene.film import Film
from ..solvers.contract import Counts, SolverFailure, tolerance_for
from ..solvers.methods import METHODS
from ..status import Status

# Film error: below what the integrator is asked, so that it meets a smooth function.
FILM_ERROR = 1e-10
# Rates over speed times h0 below which a film has settled; h1/h0 that is no wedge; how far ahead
# (of h0) a run that gave up is asked whether any rates are left.
SETTLED, NO_WEDGE, AHEAD = 1e-8, 1e-6, 1e-3
# Least force and moment, of those asked, that a root finder is told.
FLAT = 1e-12
NO_RATES = "no squeeze of the film, however fast, gives this friction moment with this spring force"


@dataclass(frozen=True)
class Ring:
    """A seal of Ludwig & Allen's kind (SI); sealed pressures above the cavity's.  The defaults have their group
    mu U dR^3 / F_s = 3.79e-13 m^2 and their face width; what else their example had is lost."""

    mean_radius: float = 0.06
    face_width: float = closed.LUDWIG_ALLEN_FACE_WIDTH
    viscosity: float = 5e-3
    shaft_speed: float = 1000.0
    group: float = closed.LUDWIG_ALLEN_GROUP
    inner_pressure: float = 0.0
    outer_pressure: float = 0.0

    @property
    def sliding_speed(self) -> float:
        """U = w R (m/s)."""
        return self.shaft_speed * self.mean_radius

    @property
    def spring_force(self) -> float:
        """F_s (N), from the group: what closes the faces beyond the film at rest."""
        return self.viscosity * self.sliding_speed * self.face_width**3 / self.group

    @property
    def edges(self) -> Edges:
        """The pressures at both edges, over the load."""
        per = self.mean_radius * self.face_width / self.spring_force
        return Edges(per * self.inner_pressure, per * self.outer_pressure, self.face_width / self.mean_radius)

    def film(self) -> Film:
        """Planar film, tilt taken at the mean radius, cavitation pressure zero."""
        half = 0.5 * self.face_width
        return Film(
            model="radial",
            inner_radius=self.mean_radius - half,
            outer_radius=self.mean_radius + half,
            viscosity=self.viscosity,
            outer_pressure=self.outer_pressure,
            inner_pressure=self.inner_pressure,
            clearance=math.sqrt(self.group),
            geometry="planar",
            tilt_radius="mean",
            cavitation_pressure=0.0,
            floor=1e-9,
        )


class Wedge:
    """The radial film of a ring beyond that at rest, as a function of h0, h1 and their rates."""

    def __init__(self, ring: Ring):
        self.ring, film = ring, ring.film()
        self.clearance = film.clearance
        self.f, self.s = radial.parameters(film, film.clearance, FILM_ERROR), np.zeros(GAP_STATE_SIZE)
        self.s[MEAN_SPIN], self.s[VISCOSITY] = 0.5 * ring.shaft_speed, ring.viscosity
        self.s[INNER_PRESSURE], self.s[OUTER_PRESSURE] = ring.inner_pressure, ring.outer_pressure
        self.at_rest = 0.0
        self.at_rest = self((self.clearance, 0.0))[0]

    def __call__(self, films, rates=(0.0, 0.0)) -> tuple[float, float, float]:
        """Force (N), sine and cosine moment (N m) for (h0, h1) in m and their rates in m/s."""
        s, radius = self.s, self.ring.mean_radius
        s[DZ], s[GX], s[DZ_RATE], s[GX_RATE] = films[0] - self.clearance, films[1] / radius, rates[0], rates[1] / radius
        radial.wrench(self.f, s)
        return float(s[FORCE]) - self.at_rest, float(s[MOMENT_Y]), float(s[MOMENT_X])


def residuals(force_ratio: float, wedge: Wedge, films, rates=(0.0, 0.0)) -> np.ndarray:
    """(force / F_s - 1, sine moment / (4 R F_d / pi) - 1) of the radial film at (h0, h1) in m and their rates in m/s,
    shape (2,)."""
    ring, (force, sine, _) = wedge.ring, wedge(films, rates)
    friction = closed.friction_moment(ring.spring_force / force_ratio, ring.mean_radius)
    return np.array([force / ring.spring_force - 1.0, sine / friction - 1.0])


def static_root(force_ratio: float, start, ring: Ring) -> tuple[float, float]:
    """Film h0, h1 (m) that balances the radial film, from `start` = (h0, h1).

    **Raises** ValueError naming hang-up if there is none.
    """
    wedge = Wedge(ring)

    def films(x):
        # ln h0 and the logit of h1 / h0: no trial film is closed.
        mean = math.exp(x[0])
        return mean, mean / (1 + math.exp(-x[1]))

    share = start[1] / start[0]
    # In logarithms force and moment are nearly linear in these; a film without a cavity has no force.
    found = root(
        lambda x: np.log1p(np.maximum(residuals(force_ratio, wedge, films(x)), FLAT - 1)),
        [math.log(start[0]), math.log(share / (1 - share))],
        tol=1e-12,
    )
    if not np.max(np.abs(residuals(force_ratio, wedge, films(found.x)))) < 1e-6:
        raise ValueError(f"hang-up: no film found that balances spring and friction at F_s/F_d = {force_ratio:.4g}")
    return films(found.x)


@dataclass
class Settling:
    """A run: how it ended ("settled", "hang-up", "moving" or "failed"), a sentence, times (s), h0 and h1 (m)."""

    status: str
    message: str
    time: np.ndarray
    mean_film: np.ndarray
    amplitude: np.ndarray

    @property
    def films(self) -> tuple[float, float]:
        """h0, h1 (m) at the end."""
        return float(self.mean_film[-1]), float(self.amplitude[-1])


class _Balance:
    """What the integrator asks of a segment, for unknowns h0, h1 and the balance of force and sine moment."""

    algebraic, film, may_change = (), slice(0, 0), False

    def __init__(self, ring: Ring, force_ratio: float, films, duration: float):
        self.ring, self.wedge, self.force_ratio, self.length = ring, Wedge(ring), force_ratio, duration
        # A last, idle unknown: the integrators leave the last one uncontrolled.
        self.scales = np.array([films[0], films[0], 1.0])
        self.last_rates = np.zeros(2)
        self.shortest_period = 2 * math.pi / ring.shaft_speed

    def longest_step(self):
        return math.inf

    def rates(self, films):
        """Rates (m/s) that balance force and moment at these films, sought from the last ones; None if there are none
        (then either the film is too thick for any, or a solver's trial left the physical range)."""
        pace = films[0] * self.ring.shaft_speed
        if not 0 < films[1] < films[0]:
            return None
        for start in (self.last_rates / pace, np.zeros(2)):
            found = root(lambda x: residuals(self.force_ratio, self.wedge, films, x * pace), start, tol=1e-11)
            if np.max(np.abs(found.fun)) < 1e-8:
                self.last_rates = found.x * pace
                return self.last_rates
        return None

    def none_ahead(self, films) -> bool:
        """Whether the film runs into a place where no rates balance it."""
        rates = self.rates(films)
        if rates is None:
            return True
        return self.rates(films + AHEAD * films[0] * rates / np.max(np.abs(rates))) is None

    def residual(self, tau, y, yp, res):
        # Solved for the rates: where a film is all dry the balances do not change with them, and IDA's differences,
        # taken over a first step's tiny length, would see nothing.
        rates = self.rates(y[:2])
        res[:2] = np.nan if rates is None else yp[:2] - rates
        res[2] = yp[2]

    def start(self, tau, y):
        pace = y[0] * self.ring.shaft_speed
        for guess in ((0, 0), (-0.1, -0.1), (-1, -1), (-0.3, 0.3), (0.1, 0.1), (-1, 0), (0.3, -0.3)):
            self.last_rates = pace * np.array(guess, dtype=float)
            rates = self.rates(y[:2])
            if rates is not None:
                return y, np.append(rates, 0.0)
        raise SolverFailure(NO_RATES)


def quasi_static(force_ratio: float, start, ring: Ring, duration: float = 0.1, accuracy: float = 1e-5) -> Settling:
    """h0, h1 in time under spring force and sine moment, squeeze included, from `start` = (h0, h1) in m.

    Settles on `closed_form.ludwig_allen.equilibrium` for q above 1.7132; below it the balance repels (below 1.6211
    there is none; under pressure both are less) and the run ends as "hang-up".  So does one that starts too thick
    (under pressure 1 % too thick may be enough), where friction holds it open: squeezing acts alike on both halves of
    the circle, so the sine moment is at most that of a film wet all around, twice the half film's.
    Nobody balances the moment about the tilt axis, which would straighten the ring: its guide carries that.
    """
    balance, y = _Balance(ring, force_ratio, start, duration), np.array([*start, 0.0])
    times, films, verdict, said = [0.0], [y[:2]], "", ""
    try:
        tolerance = tolerance_for("ida", accuracy, 1.0)
        for t, ys, yps in METHODS["ida"](balance, 0.0, y, "ida", tolerance, Counts()):
            times += list(t)
            films += list(ys[:, :2])
            # No amplitude, no wedge: nothing holds the ring against its friction any more.
            if films[-1][1] < NO_WEDGE * films[-1][0]:
                verdict = "no wedge"
            elif np.max(np.abs(yps[-1, :2])) < SETTLED * ring.shaft_speed * films[-1][0]:
                verdict = "settled"
            if verdict:
                break
    except SolverFailure as failure:
        said = str(failure)
    status, message = _ending(balance, verdict, said, times[-1], films[-1])
    mean_film, amplitude = np.array(films).T
    return Settling(status, message, np.array(times), mean_film, amplitude)


def _ending(balance, verdict, said, time, film) -> tuple[str, str]:
    """Status and sentence of a run that ended with a verdict, or with what IDA `said`, at a time (s) and films."""
    where = f"at t = {time:.4g} s, h0 = {in_words('h_min', film[0])}, h1/h0 = {film[1] / film[0]:.3g}"
    if verdict == "settled":
        return "settled", f"settled {where}"
    ratio, edges = balance.force_ratio, balance.ring.edges
    if said == NO_RATES or (said and balance.none_ahead(film)):
        why = NO_RATES
    elif verdict == "no wedge":
        why = "the wedge is gone"
    elif ratio <= closed.least_force_ratio(edges):
        why = said or "the film goes on moving"
    else:
        return (Status.FAILED, f"{said} ({where})") if said else ("moving", f"not settled {where}")
    return "hang-up", (
        f"hang-up: spring and secondary-seal friction are not balanced with F_s/F_d = {ratio:.4g} (a balance needs "
        f"{closed.least_force_ratio(edges):.4f}, one that attracts {closed.least_attracting_force_ratio(edges):.4f}): "
        f"{why}; {where}.  Less friction, more spring or a start closer to the seat."
    )
