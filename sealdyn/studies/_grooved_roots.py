"""Roots of rings on a film over grooves, in the inertial frame: at an equilibrium, over the speed of the shaft under
one closing force, and the speeds at which they begin to grow."""

import math
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from ..dynamics.equilibrium import settle
from ..dynamics.interface import opening_law
from ..faces.contact import contact_load_and_friction, lay_surfaces
from ..faces.geometry import CONTACT_FORCE, CONTACT_TORQUE, DZ, GAP_STATE_SIZE, SPIN_DIFFERENCE, WEAR, face_parameters
from ..films._grooved.aligned import MANY, AlignedFilm, aligned_film, axial_stiffness
from ..films._grooved.motion import Motion, Ring, axial_law, coupled_law, root_near, tilt_law, unstable_roots
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.film import aligned_gaps, coned
from ..scene.forces import touch_height
from ..scene.scene import Closing, Scene, SceneError, frozen_at_start, refuse_uneven
from ..simulation.stability import FASTEST

# Speeds between two of which one has more roots that grow.
CLOSER = 5
# Relative change of a frequency that is near enough to begin from.
NEXT_TO = 1e-2
MOTIONS = ("axial", "tilt_forward", "tilt_backward")
# Of two rings: the motion between them, and that in which they go together.
TOGETHER = "_together"
# Step of a difference of the asperities' load, in roughnesses.
NEAR = 1e-4
# Newton's steps to a clearance from that of another speed, the largest by its logarithm, and the last.
STEPS, WIDE, SETTLED = 20, 0.4, 1e-11
# Shaft speeds, of the scene's own, from which and to which, and at how many, roots are counted.
SPEEDS = 0.1, 10.0, 24
# Relative width of the last bracket of a threshold.
LOCATED = 1e-7


def lands(scene, clearance: float) -> tuple[float, float, dict]:
    """Torque (N m) and axial stiffness (N/m) of the lands that touch at a clearance (m) and, if they wear, depth rate
    of both faces (m/s, mean over the face) as `wear_rate`."""
    if scene.contact is None:
        return 0.0, 0.0, {}
    face, s = face_parameters(coned(scene), clearance), np.zeros(GAP_STATE_SIZE)
    asperities, loads, step = lay_surfaces(face, scene), [], NEAR * scene.contact.roughness
    s[SPIN_DIFFERENCE] = initially(scene.shaft.speed) - initially(scene.stator.speed)
    for s[DZ] in (-step, step, 0.0):
        contact_load_and_friction(asperities, face, s)
        loads.append(s[CONTACT_FORCE])
    wears = scene.contact.stator_wear_coefficient or scene.contact.rotor_wear_coefficient
    stiffness = (loads[0] - loads[1]) / (2.0 * step)
    return float(s[CONTACT_TORQUE]), float(stiffness), {"wear_rate": float(s[WEAR])} if wears else {}


def refuse_touching(scene, clearance: float) -> None:
    """Raises SceneError where lands touch at a clearance (m): small motion here is of the film alone."""
    if min(h for _, h in aligned_gaps(coned(scene), clearance)) < touch_height(scene):
        found = f"asperities that touch at the clearance of {in_words('clearance', clearance)}"
        raise SceneError("contact", found, "a film that lifts the lands off: small motion here is of the film alone")


def rings_of(scene) -> tuple[Ring, ...]:
    """The rings that float, the stator first; () where one of them has no inertia."""
    refuse_uneven(scene)
    found = []
    for name, spin in (("stator", scene.stator.speed), ("rotor", scene.shaft.speed)):
        ring = scene.rings[name]
        if (support := ring.support) is None:
            continue
        if not (ring.mass > 0.0 and ring.transverse_inertia > 0.0):
            return ()
        stiffness, damping = support.tilt()
        found.append(Ring(ring.mass, ring.transverse_inertia, support.axial_stiffness, support.axial_damping, stiffness,
                          damping, ring.polar_inertia, initially(spin)))  # fmt: skip
    return tuple(found)


def modes(scene, found: AlignedFilm) -> dict | None:
    """Roots (1/s) of the rings on film and supports in the inertial frame, [real, imaginary], those next to motions
    without damping: axial, tilt forward and backward, of two rings also of both together; None of a whirl that there is
    not.  How many roots of each motion grow, counted.  None where a ring has no inertia."""
    rings = rings_of(scene)
    if not rings:
        return None
    growing = growing_roots(found.motions[1], rings)
    return {**_roots_of(found, rings), **growing, "stable": not growing["unstable"]}


def _roots_of(found: AlignedFilm, rings) -> dict:
    answer = {}
    for name, law, inertias, whirl in _motions(rings):
        for kind in ("", TOGETHER)[: len(rings)]:
            root_of = partial(_root, law=law, rings=rings, inertias=inertias, whirl=whirl, together=bool(kind))
            answer[name + kind] = None
            with suppress(ArithmeticError):
                root = found.of_motion(root_of)[0]
                # Without a whirl that way, overdamped, it is another's.
                if name == "axial" or root.imag * whirl > 0.0:
                    answer[name + kind] = [root.real, root.imag]
    return answer


def growing_roots(fine: Motion, rings: tuple[Ring, ...]) -> dict:
    """How many roots of film and rings grow, `unstable`; with 3 grooves and more of each motion."""
    if fine.uneven:
        inertia = math.prod(ring.mass * ring.transverse_inertia**2 for ring in rings)
        return {"unstable": unstable_roots(_determinant(fine, rings), inertia, degree=6 * len(rings))}
    counts = {}
    # Both whirls are roots of one law.
    for name, law, inertias, _ in _motions(rings)[:2]:
        count = unstable_roots(law(fine, *rings), math.prod(inertias), degree=2 * len(rings))
        counts[f"unstable_{name.partition('_')[0]}"] = count
    return {**counts, "unstable": sum(counts.values())}


def _motions(rings):
    """Name, law, inertias and sense of the motions."""
    masses, inertias = ([getattr(ring, name) for ring in rings] for name in ("mass", "transverse_inertia"))
    return (("axial", axial_law, masses, 1.0), ("tilt_forward", tilt_law, inertias, 1.0),
            ("tilt_backward", tilt_law, inertias, -1.0))  # fmt: skip


def _determinant(motion, rings):
    """Of `coupled_law`, a function of s (1/s) in the frame of the pattern."""
    law = coupled_law(motion, *rings)
    return lambda s: complex(np.linalg.det(law(s)))


def _root(motion, law, rings, inertias, whirl: float, together: bool) -> complex:
    """The root (1/s) next to the motion without damping."""
    whole = law(motion, *rings)
    if together:
        # The film is not strained.
        parts = [ring.axial_stiffness if law is axial_law else ring.angular_stiffness for ring in rings]
        w = math.sqrt(sum(parts) / sum(inertias))
    else:
        # Of two rings the film is stiffer than their supports.
        inertia = 1.0 / sum(1.0 / one for one in inertias)
        film = motion.axial_impedance if law is axial_law else motion.tilt_impedance
        w = 1.0
        for _ in range(30):
            s = 1j * whirl * w
            # law + inertia w^2 is the stiffness that the motion meets.
            stiffness = (whole(s) + inertia * w * w if len(rings) == 1 else film(s)).real
            before, w = w, math.sqrt(max(stiffness, 1e-3 * abs(stiffness)) / inertia)
            if abs(w - before) < NEXT_TO * w:
                break
    root = root_near(whole, complex(0.0, whirl * w))
    if not motion.uneven:
        return root
    around = 0.0 if law is axial_law else 1j * motion.frame
    return root_near(_determinant(motion, rings), root - around) + around


# --- over the speed ------------------------------------------------------------------------------------


@dataclass
class FilmOverSpeed:
    """The aligned film of a scene at shaft speeds, under the closing force that it has at its own one."""

    scene: Scene
    known: dict = field(default_factory=dict, compare=False, repr=False)

    @cached_property
    def law(self):
        """The closing force."""
        return settle(self.scene, opening_law(self.scene))[1]

    @cached_property
    def free(self) -> Scene:
        """The scene whose closing force is given and whose clearance follows."""
        closing = Closing(balance_ratio=self.law.balance_ratio, spring_force=self.law.spring)
        return replace(self.scene, closing=closing, film=replace(self.scene.film, clearance=None))

    def __call__(self, speed: float) -> tuple[Scene, float, AlignedFilm]:
        """The scene at a speed (rad/s), its clearance (m) and film.  Raises SceneError where none lifts the lands."""
        if speed not in self.known:
            turned = frozen_at_start(self.free, speed=speed)
            near = min(self.known, key=lambda w: abs(w - speed), default=None)
            found = None if near is None else self._near(turned, *self.known[near][1:])
            if found is None:
                clearance = settle(turned, opening_law(turned))[0]
                film = aligned_film(turned, clearance, MANY)
                found = self._near(turned, clearance, film) or (clearance, film)
            refuse_touching(turned, found[0])
            self.known[speed] = (turned, *found)
        return self.known[speed]

    def _near(self, turned, clearance: float, film: AlignedFilm) -> tuple[float, AlignedFilm] | None:
        """Newton's way to the equilibrium from another one's clearance and film; None where it loses its way."""
        table = coned(turned)
        hold = self.law.at(*map(initially, (table.inner_pressure, table.outer_pressure, self.law.spring)))
        for _ in range(STEPS):
            try:
                film = aligned_film(turned, clearance, MANY, film)
            except SceneError:
                return None
            left, stiffness = film.better(lambda one: one.force)[0] - hold, film.better(axial_stiffness)[0]
            if not stiffness > 0.0:
                return None
            step = left / (stiffness * clearance)
            if abs(step) < SETTLED:
                return clearance, film
            clearance *= math.exp(min(max(step, -WIDE), WIDE))
        return None


@dataclass
class RootsOverSpeed:
    """Roots (1/s) of the rings of a scene at shaft speeds, under the closing force that it has at its own one."""

    scene: Scene
    film: FilmOverSpeed | None = field(default=None, compare=False, repr=False)

    def __post_init__(self):
        if not rings_of(self.scene):
            raise SceneError("rotor.support", "a ring without inertia that floats over grooves", "one with inertia")
        self.film = self.film or FilmOverSpeed(self.scene)

    def __call__(self, speed: float) -> dict:
        """`clearance` (m), roots [real, imaginary] by their names in `modes`, None of one that there is not, and how
        many roots of film and rings are `growing`, counted."""
        _, clearance, film = self.film(speed)
        found = modes(frozen_at_start(self.scene, speed=speed), film)
        return {"clearance": clearance, "growing": found["unstable"], **roots_in(found)}

    def prepare(self) -> None:
        """Know the film at the scene's own speed, if there is one."""
        _ = self.film.free
        with suppress(SceneError):
            self.film(abs(initially(self.scene.shaft.speed)))

    def growing(self, speed: float) -> int:
        """How many roots grow at a speed (rad/s)."""
        return growing_roots(self.film(speed)[2].motions[1], self._rings(speed))["unstable"]

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt, as `growth_of`."""
        return growth_of(self(speed))

    def _tilt_rate(self, speed: float) -> float:
        """Of roots that are known, without the count."""
        return growth_of({**_roots_of(self.film(speed)[2], self._rings(speed)), "growing": 0})

    def _rings(self, speed: float) -> tuple[Ring, ...]:
        return rings_of(frozen_at_start(self.scene, speed=speed))

    def threshold(self, low: float, high: float) -> float:
        """The speed (rad/s) between two of which one has more roots that grow."""
        rates = self.growth(low), self.growth(high)
        if all(map(math.isfinite, rates)) and rates[0] * rates[1] < 0.0:
            return float(brentq(self._tilt_rate, low, high, rtol=LOCATED))
        before = self.growing(low)
        while high - low > LOCATED * high:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.growing(middle) == before else (low, middle)
        return 0.5 * (low + high)


def roots_in(row) -> dict:
    """The roots among what `modes` or a row of RootsOverSpeed has, by their names."""
    return {name: root for name, root in row.items() if name.startswith(MOTIONS)}


def growth_of(row, motion: str | tuple[str, ...] = "tilt") -> float:
    """Growth rate (1/s) of the least damped motion of a kind (of any: MOTIONS) of a row of RootsOverSpeed that
    is a whirl or an oscillation of its own; inf where only the count knows of one that grows."""
    rates = [root[0] for name, root in row.items() if name.startswith(motion) and root]
    rate = max(rates, default=-math.inf)
    return math.inf if row["growing"] and rate < 0.0 else rate


def roots_over_speed(scene, speeds, tools) -> tuple[list[dict], dict, list[str]]:
    """Rows of RootsOverSpeed that have a film, with their `speed` (rad/s); roots (complex, a row each) of the motions
    that are whirls or oscillations of their own at all of these; and what is to be said of the others."""
    roots = RootsOverSpeed(scene)
    # Once, not in each process.
    roots.prepare()
    held = _rows(roots, speeds, tools, "roots")
    # Closer where roots begin to grow or cease to.
    between = [np.linspace(a["speed"], b["speed"], CLOSER + 2)[1:-1] for a, b in pairwise(held)
               if a["growing"] != b["growing"]]  # fmt: skip
    if between:
        held = sorted([*held, *_rows(roots, np.concatenate(between), tools, "closer")], key=lambda row: row["speed"])
    if not held:
        found = f"no film over grooves from {speeds[0]:g} to {speeds[-1]:g} rad/s"
        raise SceneError("shaft.speed", found, "other speeds")
    known, notes = {name: [row[name] for row in held] for name in roots_in(held[0])}, []
    lost = [name.replace("_", " ") for name, values in known.items() if None in values]
    if lost:
        notes.append(f"Not an oscillation of its own at all speeds, and left out: {', '.join(lost)}.")
    growing = [row["speed"] for row in held if row["growing"]]
    if growing:
        notes.append(f"Roots that grow, counted around the right half plane, at {len(growing)} of {len(held)} speeds, "
                     f"the lowest {in_words('speed', growing[0])}.")  # fmt: skip
    return held, {name: np.array(values) @ [1.0, 1j] for name, values in known.items() if None not in values}, notes


def thresholds(roots: RootsOverSpeed, tools) -> tuple[list[tuple[float, float | None]], list[float]]:
    """Speeds (rad/s) of SPEEDS, of the scene's own, that have a film, with the growth rate (1/s) of the least damped
    tilt, None of one that only the count knows, and those between them at which roots begin to grow or cease to,
    rising."""
    scene = roots.scene
    own = abs(initially(scene.shaft.speed)) or 1000.0
    roots.prepare()
    top = min(SPEEDS[1] * own, max(FASTEST / scene.film.outer_radius, own))
    held = _rows(roots, np.geomspace(SPEEDS[0] * own, top, SPEEDS[2]), tools, "roots")
    if not held:
        raise SceneError("shaft.speed", "no film over the grooves that lifts the lands, at any speed near", "others")
    found = [roots.threshold(a["speed"], b["speed"]) for a, b in pairwise(held) if a["growing"] != b["growing"]]
    rates = {row["speed"]: growth_of(row) for row in held} | dict.fromkeys(found, 0.0)
    return [(w, rate if math.isfinite(rate) else None) for w, rate in sorted(rates.items())], found


def _rows(roots, speeds, tools, words: str) -> list[dict]:
    """Rows of the speeds (rad/s) that have a film, with them."""
    found = tools.map(roots, [float(w) for w in speeds], words)
    return [{"speed": float(w), **row} for w, row in zip(speeds, found, strict=True) if "failed" not in row]


# --- maps ----------------------------------------------------------------------------------------------


def growth_rates(scenes) -> list[tuple[float, float]]:
    """Growth rates (1/s) of all motions and of the tilts alone of scenes at their own clearances, NaN where there is no
    film; scenes that differ in what their rings are have one film."""
    films, found = {}, []
    for scene in scenes:
        grooves = [ring.grooves for ring in (scene.rotor, scene.stator)]
        key = repr((scene.film, scene.closing, scene.shaft.speed, scene.stator.speed, scene.contact, grooves))
        if key not in films:
            films[key] = _settled_film(scene)
        ring = modes(scene, films[key]) if films[key] is not None else None
        row = ring and {**ring, "growing": ring["unstable"]}
        found.append((growth_of(row, MOTIONS), growth_of(row)) if row else (math.nan, math.nan))
    return found


def _settled_film(scene) -> AlignedFilm | None:
    try:
        clearance = settle(scene, opening_law(scene))[0]
        refuse_touching(scene, clearance)
        return aligned_film(scene, clearance, MANY)
    except SceneError:
        return None


def margins_over_grooves(scene, tools) -> dict:
    """The margins of the study stability at a scene's own values."""
    around, speed = RootsOverSpeed(scene), initially(scene.shaft.speed)
    row, critical = around(speed), min(thresholds(around, tools)[1], default=None)
    roots = {name: root for name, root in roots_in(row).items() if root}
    falling = sorted(roots, key=lambda name: -roots[name][0])
    least = next(iter(falling), None)
    tilt = next((name for name in falling if name.startswith("tilt")), None)
    return {
        "verdict": "unstable" if row["growing"] else "stable",
        "growth_rate": roots[least][0] if least else None,
        "least_damped": least and least.partition("_")[0],
        "growth_rate_uncertainty": None,
        "whirl_ratio": roots[tilt][1] / speed if tilt and speed else None,
        "critical_speed": critical,
        "speeds_held": None,
        "speed_margin": critical / abs(speed) if critical and speed else None,
    }
