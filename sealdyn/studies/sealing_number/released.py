"""Ludwig & Allen's ring let go: three degrees of freedom, inertia, Coulomb friction around the secondary seal and both
film moments.  Does it keep the film that their closed form gives it?

Their ring turns and its seat stands (FMR).  Where the seat turns and the ring stands (FMS) the ring nods along with it,
a tilt that turns at the shaft's speed w: its friction is the same, and its transverse inertia pulls it out, I w^2 gamma
against the support's K gamma.  So in place of K stands K - I w^2, of either sign; the film is that of the mirror.
Under sealed pressures F_s is the closing force beyond what they open flat faces with: springs and balance alike.
**Source** derived here, from the equations of motion (dynamics/equations.py) at a tilt gamma exp(i w t).

What it must come to is worked out in `closed_form.ludwig_allen`; here the ring of a scene is run in time and what
becomes of it is named.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ...analysis import quasi_static
from ...closed_form import ludwig_allen as closed
from ...closed_form import sealed_wedge as sealed
from ...dynamics.equilibrium import closing_law
from ...dynamics.model import Model
from ...dynamics.run_state import RunState
from ...dynamics.signals import signals
from ...numerics.piecewise_linear import initially
from ...quantities import in_words
from ...scene.film import coned
from ...scene.rings import RING_NAMES, ROTOR, STATOR, Rotor, Stator, Support
from ...scene.scene import Initial, RingStart, Scene, SceneError, refuse_uneven
from ...simulation.selection import Start, choose_method, set_start
from ...solvers.contract import Recorder, Status
from ...solvers.integrate import solve

# h1/h0 below which a ring has straightened; share of the spring force, or of time, that counts; what is steady.
STRAIGHT, COUNTS, STEADY = 0.1, 0.01, 0.02
# h1/h0 of a start where the closed form has no film; how far apart the faces of an open start are, of its tilt.
START_SHARE, APART = 0.5, 1.01
SAMPLES = 32
# h1/h0 between which a film is sought.
SHARES = 1 - np.geomspace(1, 1e-9, 61)[1:]


# --- the film to be expected ------------------------------------------------------------------------------


@lru_cache(maxsize=4096)
def _film_of(e: float, ring: quasi_static.Ring, axial: float, rest: float) -> tuple[float, complex]:
    """h0 (m) of the film h1/h0 = e that carries F_s and a spring of `axial` F_s (per m) that rests at h0 = `rest`
    (m), and its moment over R F_s."""
    number, sine, cosine = sealed.balance(e, ring.edges)
    mean = math.sqrt(ring.group * number)
    if axial and mean > rest:

        def short(h):
            return sealed.carried(e, h * h / ring.group, ring.edges)[0] - 1.0 - axial * max(h - rest, 0.0)

        mean = brentq(short, 1e-3 * mean, mean * (1 + 1e-9), xtol=1e-14 * mean)
        _, sine, cosine = sealed.carried(e, mean * mean / ring.group, ring.edges)
    return mean, complex(cosine, sine)


def film_on(scene, clearance: float | None = None) -> tuple[float, float, complex]:
    """h0, h1 (m) and the tilt (rad, complex, from the seat's direction) of a scene's ring on its film: its support is
    stretched by that tilt and by h0, and the ring tilts less than its seat until friction and support just hold the
    film; of several such films the one with the least h1/h0.  `clearance` (m): where the support's axial spring is at
    rest, if known (else found from the asperities).
    **Raises** ValueError as `closed_form.ludwig_allen.film`."""
    ring, q, pair = ring_of(scene), force_ratio_of(scene), pair_of(scene)
    stiffness, friction, seat = (
        pair.stiffness / (ring.mean_radius * ring.spring_force),
        closed.moment_ratio(q),
        pair.tilt,
    )
    axial = pair.ring.support.axial_stiffness / ring.spring_force
    rest = Model(scene, 1e-3).clearance if clearance is None and axial else clearance or 0.0

    def seat_of(tilt, amplitude, moment):
        """Tilt of the seat, from the direction of a ring of that tilt."""
        turned = (1j * friction - stiffness * tilt) / moment
        return tilt + amplitude / ring.mean_radius * turned / abs(turned)

    def at(e):
        """h0, the moment, and the ring's tilt under its seat: 0 where the film alone tilts by more than the seat."""
        mean, moment = _film_of(e, ring, axial, rest)
        inside = e * mean / ring.mean_radius
        tilt = 0.0
        if inside < seat:
            tilt = brentq(
                lambda x: abs(seat_of(x, e * mean, moment)) - seat, 0.0, 1.01 * (seat + inside), xtol=1e-15 * seat
            )
        return mean, moment, tilt

    def spare(e):
        """What the film's moment has beyond friction and support, squared."""
        _, moment, tilt = at(e)
        return abs(moment) ** 2 - friction**2 - (stiffness * tilt) ** 2

    # The least e at which the film's moment outgrows friction and support: only there a film attracts.
    low, held = sealed.FLAT, spare(sealed.FLAT)
    for high in SHARES:
        last, held = held, spare(high)
        if last < 0.0 < held:
            e = brentq(spare, low, high, xtol=1e-15)
            mean, moment, tilt = at(e)
            if tilt == 0.0:
                break
            there = seat_of(tilt, e * mean, moment)
            tilted = tilt * there.conjugate() / abs(there)
            return mean, e * mean, tilted if pair.floating == ROTOR else tilted.conjugate()
        low = high
    closed.film(q, stiffness * seat, ring.group, ring.edges)
    raise ValueError("hang-up: the film would tilt by more than the seat")


# --- scenes -----------------------------------------------------------------------------------------------


class Pair(NamedTuple):
    """Which ring floats (`floating`, as RING_NAMES has them) and that `ring`; key, `tilt` (rad) and direction (rad, at
    the start) of its seat, and the speed (rad/s) at which that turns; tilt `stiffness` (N m/rad) that the nodding ring
    meets, its inertia's part off the support's."""

    floating: int
    ring: Stator | Rotor
    key: str
    tilt: float
    direction: float
    speed: float
    stiffness: float

    @property
    def name(self) -> str:
        """Name of the ring that floats."""
        return RING_NAMES[self.floating]


def pair_of(scene) -> Pair:
    """Ring and seat of a scene: the rotor over a stator that stands askew, or the stator over a rotor that runs out."""
    stator, rotor = scene.stator, scene.rotor
    if stator.support is None or rotor.support is not None:
        stiffness = rotor.support.tilt()[0] if rotor.support else 0.0
        tilt = initially(stator.misalignment)
        return Pair(ROTOR, rotor, "stator.misalignment", tilt, stator.misalignment_direction, 0.0, stiffness)
    speed = initially(scene.shaft.speed)
    stiffness = stator.support.tilt()[0] - stator.transverse_inertia * speed**2
    return Pair(STATOR, stator, "rotor.runout", initially(rotor.runout), rotor.runout_phase, speed, stiffness)


def ring_of(scene) -> quasi_static.Ring:
    """The numbers of Ludwig & Allen of a scene.  **Raises** SceneError if it is not of their kind."""
    refuse_uneven(scene)
    f, pair, none = scene.film, pair_of(scene), "nothing"
    name, seal = pair.name, pair.ring.secondary_seal
    other = RING_NAMES[1 - pair.floating]
    turning, gives = initially(scene.stator.speed), seal is not None and seal.stiffness is not None
    own = initially(pair.ring.misalignment)
    stands = pair.floating == ROTOR or not turning
    slope = coned(scene).coning
    wanted = (
        (
            "film.cavitation_pressure",
            f.cavitation_pressure is not None,
            none,
            "a pressure: an uncavitated wedge pulls as much as it pushes",
        ),
        ("film.inertia", not f.inertia, "true", "none"),
        ("closing.spring_force", scene.closing.spring_force is not None, none, "a spring force and a balance ratio"),
        (f"{other}.support", scene.rings[other].support is None, "two flexible rings", "one of them"),
        (f"{name}.support", pair.ring.support is not None, none, "a flexible ring"),
        (f"{name}.secondary_seal", seal is not None, none, "a secondary seal on the ring"),
        (f"{name}.secondary_seal.stiffness", not gives, "one", "none: rigid until it slides"),
        ("stator.speed", stands, f"{turning:g} rad/s", "a ring that stands, or a flexible rotor"),
        ("contact", scene.contact is not None, none, "asperities for the ring to land on"),
        ("film.coning", slope == 0.0, f"{slope:g} rad", "flat faces"),
        (f"{name}.misalignment", not own, f"{own:g} rad", "a ring square in its springs"),
        ("rotor.axial_runout", not scene.rotor.axial_runout, "some", "none: faces at one distance"),
        (pair.key, pair.tilt > 0.0, f"{pair.tilt:g} rad", "a misaligned seat"),
    )
    for key, there, found, expected in wanted:
        if not there:
            raise SceneError(key, found, f"{expected} (a ring of Ludwig & Allen's kind)")
    radius, width = 0.5 * (f.inner_radius + f.outer_radius), f.outer_radius - f.inner_radius
    viscosity, speed = initially(f.viscosity), abs(initially(scene.shaft.speed))
    inner, outer = initially(f.inner_pressure), initially(f.outer_pressure)
    load = initially(scene.closing.spring_force)
    # With equal pressures whatever the balance ratio the fluid's closing is its ambient opening.
    if inner != outer:
        opening = _opening(f, inner, outer)
        load = closing_law(scene, lambda *_: opening)[0].at(inner, outer, load) - opening
        if not load > 1e-9 * opening:
            expected = f"more than the {opening:.4g} N with which the pressures open flat faces"
            raise SceneError("closing.spring_force", f"{opening + load:.4g} N of closing force with it", expected)
    group = viscosity * speed * radius * width**3 / load
    cavity = f.cavitation_pressure
    return quasi_static.Ring(radius, width, viscosity, speed, group, inner - cavity, outer - cavity)


def _opening(film, inner: float, outer: float) -> float:
    """Force (N) of the pressures (Pa) between flat faces, 2 pi int p r dr, the circle's growth with r left in."""
    r_i, r_o = film.inner_radius, film.outer_radius
    mean_square = (r_o**2 + r_o * r_i + r_i**2) / 3 if film.geometry == "planar" else (
        (r_o**2 - r_i**2) / (2 * math.log(r_o / r_i)))  # fmt: skip
    return math.pi * (outer * r_o**2 - inner * r_i**2 - (outer - inner) * mean_square)


def force_ratio_of(scene) -> float:
    """q = F_s / F_d with the friction moment of the scene's secondary seal."""
    ring = ring_of(scene)
    return 4 * ring.mean_radius * ring.spring_force / (math.pi * pair_of(scene).ring.secondary_seal.breakaway()[1])


def with_force_ratio(scene, force_ratio: float, guide: float | None = None) -> Scene:
    """The scene with the friction of F_s / F_d; with `guide`, also on a pure tilt spring that gives K_s gamma = guide
    R F_s at the film (or, if there is none, where the run starts)."""
    ring, pair = ring_of(scene), pair_of(scene)
    friction = closed.friction_moment(ring.spring_force / force_ratio, ring.mean_radius)
    seal, support = pair.ring.secondary_seal, pair.ring.support
    seal = replace(seal, line_friction=friction / (4 * seal.radius**2), friction_force=None)
    if guide is not None:
        seat = pair.tilt
        tilt = seat - _film_or_start(force_ratio, guide, ring)[1] / ring.mean_radius
        if tilt <= 0:
            raise SceneError(pair.key, f"{seat:g} rad", "more than the tilt of the film")
        # What its inertia takes, the support gives.
        stiffness = guide * ring.mean_radius * ring.spring_force / tilt + support.tilt()[0] - pair.stiffness
        support = Support(axial_stiffness=0.0, tilt_stiffness=stiffness)
    return replace(scene, **{pair.name: replace(pair.ring, secondary_seal=seal, support=support)})


def _film_or_start(force_ratio, guide, ring):
    try:
        return closed.film(force_ratio, guide, ring.group, ring.edges)
    except ValueError:
        return start_film(force_ratio, ring)


def start_film(force_ratio: float, ring: quasi_static.Ring) -> tuple[float, float]:
    """h0, h1 (m) of the closed form, or where it has none a wedge that carries the spring at h1/h0 = 1/2."""
    if force_ratio > closed.least_attracting_force_ratio(ring.edges):
        return tuple(float(h) for h in closed.equilibrium(force_ratio, ring.group, ring.edges))
    mean = math.sqrt(ring.group * sealed.balance(START_SHARE, ring.edges)[0])
    return mean, START_SHARE * mean


def started(scene, start="closed form", factor: float = 1.0) -> Scene:
    """The scene with its start: "closed form" (ring following the seat at `factor` times that film), "open" (ring
    square to its shaft and at rest there, faces just apart), or (h0, h1) in m."""
    ring, pair, clearance = ring_of(scene), pair_of(scene), Model(scene, 1e-3).clearance
    seat = pair.tilt
    if start == "open":
        # Where the tilts of the faces reach furthest.
        reach = ring.mean_radius if scene.film.tilt_radius == "mean" else scene.film.outer_radius
        mean, tilt = APART * reach * seat, 0.0
    else:
        films = start_film(force_ratio_of(scene), ring) if start == "closed form" else start
        mean, tilt = factor * films[0], seat - factor * films[1] / ring.mean_radius
    x, y = tilt * math.cos(pair.direction), tilt * math.sin(pair.direction)
    z = mean - clearance if pair.floating == STATOR else clearance - mean
    at = RingStart(z=z, tilt_x=x, tilt_y=y, tilt_x_rate=-pair.speed * y, tilt_y_rate=pair.speed * x)
    return replace(scene, initial=Initial(**{pair.name: at}))


# --- in time ----------------------------------------------------------------------------------------------


@dataclass
class Released:
    """What became of the ring.

    `status`: "film" (steady), "straightened" (parallel to the seat and on its asperities), "rubs", "hang-up" (stuck on
    its secondary seal, faces apart), "moving" (not settled), or the solver's "collapsed", "failed"; `message` a
    sentence.  Over the last turns: mean, least and largest of `mean_film` h0, `amplitude` h1 and `least_film` h0 - h1
    (m), `share` h1/h0, direction of the relative tilt from the seat's (rad) and how often it went around per turn,
    shares of the spring force on contact and of time stuck; then `h0` (m) of the whole run, its evaluations and
    `energy_residual`."""

    status: str
    message: str
    mean_film: tuple[float, float, float]
    amplitude: tuple[float, float, float]
    least_film: tuple[float, float, float]
    share: float
    direction: float
    whirl: float
    contact_share: float
    stuck_share: float
    h0: np.ndarray
    evaluations: int
    energy_residual: float


def released(scene, turns: float = 80, last: float = 4, accuracy: float = 1e-3, method: str | None = None) -> Released:
    """Run the scene from its start over `turns` of the shaft and say what became of the ring in the `last` ones.
    `accuracy` is that of a run, relative to the clearance at which asperities carry the spring."""
    ring = ring_of(scene)
    turn = 2 * math.pi / ring.shaft_speed
    run = RunState(Model(scene, accuracy), turns * turn)
    set_start(run, scene, Start("rest"))
    sink = Kept(turn / SAMPLES)
    outcome = solve(run, method or choose_method(run)[0], accuracy, sink)
    series = {name: np.concatenate([part[name] for part in sink.parts]) for name in sink.parts[0]}
    return _told(run, ring, series, outcome, last)


class Kept(Recorder):
    """Signals of a run, taken while it runs: whether the ring sticks is known only then."""

    def take(self, segment, taus, q, q_rate, x=None):
        self.parts.append(signals(segment, taus, q, q_rate, x))


def _told(run, ring, series, outcome, last) -> Released:
    time, h0 = series["time"], run.model.clearance + series["axial_gap_change"]
    pair = pair_of(run.model.scene)
    # The seat's tilt less the ring's, from the direction of the seat, which may turn.
    sign = 1.0 if pair.floating == ROTOR else -1.0
    g = sign * (series["relative_tilt_x"] + 1j * series["relative_tilt_y"])
    g = g * np.exp(-1j * (pair.direction + pair.speed * time))
    h1 = ring.mean_radius * np.abs(g)
    end = time >= time[-1] - last * 2 * math.pi / ring.shaft_speed
    angle = np.unwrap(np.angle(g[end]))
    told = Released(
        str(outcome.status), outcome.message, *(_spread(h[end]) for h in (h0, h1, h0 - h1)),
        share=float(np.mean(h1[end]) / np.mean(h0[end])), direction=float(np.angle(np.mean(g[end]))),
        whirl=float(angle[-1] - angle[0]) / (2 * math.pi * last),
        contact_share=float(np.mean(series["contact_force"][end]) / ring.spring_force),
        stuck_share=float(np.mean(series[f"{pair.name}_seal_stuck"][end])), h0=h0,
        evaluations=outcome.counts.rhs, energy_residual=outcome.energy_residual,
    )  # fmt: skip
    if outcome.status == Status.OK:
        told.status, told.message = _fate(told, force_ratio_of(run.model.scene))
    return told


def _spread(h) -> tuple[float, float, float]:
    return float(np.mean(h)), float(np.min(h)), float(np.max(h))


def _fate(told: Released, force_ratio: float) -> tuple[str, str]:
    mean, low, high = told.mean_film
    where = f"h0 = {in_words('h_min', mean)}, h1/h0 = {told.share:.3g}, q = F_s/F_d = {force_ratio:.4g}"
    if told.stuck_share > COUNTS:
        return "hang-up", f"hang-up: the secondary seal holds the ring open ({where}); less friction or more spring"
    carried = f"asperities carry {in_words('share', told.contact_share, digits=3)} of the spring"
    if told.share < STRAIGHT and told.contact_share > COUNTS:
        return "straightened", f"straightened and squeezed onto its seat: {carried} ({where})"
    if told.contact_share > COUNTS:
        return "rubs", f"rubs: {carried} ({where})"
    if high - low < STEADY * mean and told.amplitude[2] - told.amplitude[1] < STEADY * mean:
        return "film", f"rides on a steady film: {where}"
    films = " to ".join(in_words("h_min", film) for film in (low, high))
    return "moving", f"not settled: h0 from {films}, {told.whirl:+.3g} turns a turn ({where})"
