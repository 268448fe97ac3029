"""Figures of a seal that design rules judge, SI: of its scene and application, its rings on their springs, its spring
against what the ring needs to follow the rotor; and what a rule finds."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from ..dynamics.imposed_motion import rest_state
from ..dynamics.interface import flow_at_rest
from ..dynamics.intervals import constant_and_slope, largest_value
from ..dynamics.model import Model
from ..faces.contact import contact_load_and_friction
from ..faces.geometry import CONTACT_TORQUE, FLOW_INNER, FLOW_OUTER, SPIN_DIFFERENCE
from ..numerics.piecewise_linear import PiecewiseLinear, initially, points, value_at
from ..scene.application import Application
from ..scene.rings import RING_NAMES
from ..scene.scene import Scene
from ..simulation.result import plain

# A frequency nearer to a natural one than this share of it is at resonance; the guide gives no distance.
MARGIN = 0.1
# Damping ratio from which a ring that is shaken has no resonance.
NO_PEAK = math.sqrt(0.5)
# Points of one turn of the runout, and turns where an order is no integer.
POINTS, TURNS = 2000, 20


GUIDE = "Hayden & Keller, NASA CR-120997 (1974)"


class Verdict(StrEnum):
    """How a seal stands to a rule."""

    PASS = "pass"
    FAIL = "fail"
    NOTE = "note"
    """Worth knowing; the guide gives no limit, or says itself that it may be passed."""
    ACKNOWLEDGED = "acknowledged"
    """Broken on purpose, with a reason."""
    NOT_APPLICABLE = "not applicable"
    """The rule is for other seals, or a key that would tell is missing."""


@dataclass(frozen=True)
class Finding:
    """A verdict and its `sentence` (without the source); the figure `value` (SI; `unit` where it is not that of the
    rule) with its limits `least` and `most`, None where there are none; `numbers` beside it, by name."""

    verdict: Verdict
    sentence: str
    value: float | None = None
    least: float | None = None
    most: float | None = None
    unit: str | None = None
    numbers: dict = field(default_factory=dict)


def limit_finding(
    sentence: str, value: float, least=None, most=None, beyond: Verdict = Verdict.FAIL, unit=None, **numbers
) -> Finding:
    """A figure against its limits, `beyond` which it gets that verdict."""
    inside = (-math.inf if least is None else least) <= value <= (math.inf if most is None else most)
    return Finding(Verdict.PASS if inside else beyond, sentence, value, least, most, unit, numbers)


def note(sentence: str, value: float, **numbers) -> Finding:
    """A figure without a limit."""
    return Finding(Verdict.NOTE, sentence, value, numbers=numbers)


def missing_keys(*keys: str) -> Finding:
    """No verdict without one of these keys."""
    return Finding(Verdict.NOT_APPLICABLE, f"needs {' or '.join(keys)}", numbers={"needs": [*keys]})


def other_seals(sentence: str) -> Finding:
    """A rule for other seals than this."""
    return Finding(Verdict.NOT_APPLICABLE, sentence)


@dataclass(frozen=True)
class Seal:
    """A scene as it was made, what it is for (an empty `Application` if nothing says so), and its model."""

    scene: Scene
    application: Application
    model: Model

    @property
    def mean_diameter(self) -> float:
        """Mean diameter (m) of the face."""
        return self.scene.film.outer_radius + self.scene.film.inner_radius

    @property
    def face_width(self) -> float:
        """Radial width (m) of the face."""
        return self.scene.film.outer_radius - self.scene.film.inner_radius

    @property
    def face_area(self) -> float:
        """Area (m^2) of the face."""
        return math.pi * self.mean_diameter * self.face_width

    @property
    def sliding_speed(self) -> float:
        """Highest sliding speed pi D N (m/s) at the mean diameter, of the scene or in service."""
        spin = _largest_difference(self.scene.shaft.speed, self.scene.stator.speed)
        return 0.5 * self.mean_diameter * max(spin, self.application.highest_speed or 0.0)

    @property
    def shaft_speeds(self) -> tuple[float, float]:
        """Lowest and highest shaft speed (rad/s, either way) of the scene and in service."""
        signed = points(self.scene.shaft.speed)
        low = 0.0 if min(signed) < 0.0 < max(signed) else min(map(abs, signed))
        lowest, highest = self.application.lowest_speed, self.application.highest_speed
        return min(low, low if lowest is None else lowest), max(largest_value(self.scene.shaft.speed), highest or 0.0)

    @property
    def sealed_pressure(self) -> float:
        """Largest pressure difference (Pa) across the face, of the scene or in service."""
        film = self.scene.film
        low = min(*points(film.inner_pressure), *points(film.outer_pressure))
        return max(
            _largest_difference(film.outer_pressure, film.inner_pressure),
            (self.application.highest_pressure or 0.0) - low,
        )

    @property
    def spring_force(self) -> float | None:
        """Spring force (N) at the start, given or following from balance ratio and clearance; None where the scene
        only says that something holds its clearance."""
        closing = self.scene.closing
        if closing.spring_force is None and closing.balance_ratio is None:
            return None
        return initially(self.model.closing.spring)

    @property
    def face_load(self) -> float:
        """Closing force (N) at the start above the lower of the two pressures."""
        film = self.scene.film
        low = min(initially(film.inner_pressure), initially(film.outer_pressure))
        return self.model.closing_force() - low * self.face_area

    @property
    def film_thickness(self) -> float:
        """Film thickness (m) of the aligned faces at the mean radius, at the start."""
        radii, gaps = zip(*self.model.aligned_gaps(), strict=True)
        return float(np.interp(0.5 * self.mean_diameter, radii, gaps))

    @property
    def asperity_heat(self) -> float:
        """Friction (W) of the asperities at the highest sliding speed, of what they carry at the start."""
        interface = self.model.interface
        if interface.contact is None:
            return 0.0
        s = rest_state(self.model.scene, self.model.clearance, self.model.start)[0]
        s[SPIN_DIFFERENCE] = 2 * self.sliding_speed / self.mean_diameter
        contact_load_and_friction(interface.contact, self.model.observed[1], s)
        return float(s[CONTACT_TORQUE] * s[SPIN_DIFFERENCE])

    @property
    def leakage(self) -> float:
        """Leakage (m^3/s) of the aligned faces, at the start.  Raises SceneError where the film has no solution."""
        s = rest_state(self.model.scene, self.model.clearance, self.model.start)[0]
        flow_at_rest(self.model.interface, s, self.model.observed)
        return abs(float(s[FLOW_INNER if self.model.closing.outer_is_high else FLOW_OUTER]))

    @property
    def highest_temperature(self) -> float | None:
        """Highest temperature (K) of the fluid, of the scene or in service; None where neither says."""
        given = self.application.highest_temperature, *points(self.scene.film.temperature)
        return max((t for t in given if t is not None), default=None)

    @property
    def face_temperature(self) -> float | None:
        """Highest temperature (K) of the film: in service, or of the warm faces; None where neither is known."""
        heat = self.model.heat
        warm = None if heat is None else initially(self.scene.film.temperature) + heat.rise
        return max((t for t in (self.highest_temperature, warm) if t is not None), default=None)

    @property
    def o_ring_temperature(self) -> float | None:
        """Highest temperature (K) at the secondary seal: that of the fluid, or of a ring where its O-ring sits, which
        is known of one from its drawing; None where neither is known."""
        fluid, heat = self.highest_temperature, self.model.heat
        if heat is None or fluid is None:
            return fluid
        from ..dynamics.warm_state import warming

        shares = [ring.at_o_ring or 0.0 for ring in warming(self.model.given).rings.values()]
        return max(fluid, initially(self.scene.film.temperature) + max(shares) * heat.rise)


def _largest_difference(one, other) -> float:
    """Largest difference of two numbers or functions of time, in their unit."""
    times = {t for q in (one, other) if isinstance(q, PiecewiseLinear) for t in q.time} | {0.0}
    # Of a step also what was before it.
    times |= {math.nextafter(t, -math.inf) for t in times}
    return max(abs(value_at(one, t) - value_at(other, t)) for t in times)


# --- rings on their springs and dampers, without the film ------------------------------------------------


def ring_modes(scene: Scene) -> list[dict]:
    """Modes of the floating rings at rest: `ring`, `motion` ("axial" | "tilt"), `frequency` (Hz) and `damping_ratio`;
    none of a ring without inertia or springs."""
    modes = []
    for name, ring in zip(RING_NAMES, (scene.stator, scene.rotor), strict=True):
        if ring.support is None:
            continue
        support = ring.support
        axial = ring.mass, support.axial_stiffness, support.axial_damping
        mean, damping = support.tilt()
        spread = abs(support.tilt_difference())
        tilts = [("tilt", (ring.transverse_inertia, k, damping)) for k in sorted({mean - spread, mean + spread})]
        for motion, (inertia, stiffness, damping) in [("axial", axial), *tilts]:
            if inertia > 0.0 and stiffness > 0.0:
                modes.append({"ring": name, "motion": motion,
                              "frequency": math.sqrt(stiffness / inertia) / (2 * math.pi),
                              "damping_ratio": damping / (2 * math.sqrt(stiffness * inertia))})  # fmt: skip
    return modes


def resonances(scene: Scene, bands: list[tuple[float, float]], what: str) -> Finding:
    """Fail if a mode that has a resonance lies in or near one of the `bands` (Hz, Hz) of `what` shakes the seal; an
    undamped mode elsewhere is a note, since flexibly mounted parts shall be damped."""
    modes = ring_modes(scene)
    if not modes:
        keys = ("mass", "transverse_inertia", "support")
        floating = [n for n, ring in zip(RING_NAMES, (scene.stator, scene.rotor), strict=True) if ring.support]
        return missing_keys(*(f"{name}.{key}" for name in floating for key in keys))
    distance, nearest, band = min(
        ((_distance(mode["frequency"], band), mode, band) for mode in modes for band in bands),
        key=lambda one: (one[1]["damping_ratio"] >= NO_PEAK, one[0]),
    )
    shaken = f"{band[0]:.4g} Hz" if band[0] == band[1] else f"{band[0]:.4g} to {band[1]:.4g} Hz"
    sentence = (
        f"{what} shakes with {shaken}; on its springs alone the {nearest['ring']}'s {nearest['motion']} motion has "
        f"{nearest['frequency']:.4g} Hz, damping ratio {nearest['damping_ratio']:.2g}"
    )
    verdict = Verdict.PASS
    if nearest["damping_ratio"] >= NO_PEAK:
        sentence += ": damped so well that there is no resonance"
    elif distance <= MARGIN:
        verdict, sentence = Verdict.FAIL, f"{sentence}: resonance, unless the film prevents it"
    elif any(mode["damping_ratio"] == 0.0 for mode in modes):
        verdict, sentence = Verdict.NOTE, f"{sentence}: apart, but flexibly mounted parts shall be damped"
    numbers = {"modes": modes, "shaken": [*map(list, bands)]}
    return Finding(verdict, sentence, nearest["frequency"], numbers=numbers)


def _distance(frequency: float, band: tuple[float, float]) -> float:
    """How far a frequency lies from a band (both Hz), as a share of it; 0 inside."""
    return max(band[0] - frequency, frequency - band[1], 0.0) / frequency


# --- hang-up ---------------------------------------------------------------------------------------------


def followability(model: Model) -> dict | None:
    """Whether the spring keeps a flexible stator on a rotor that runs out, axially or in its face (hang-up).

    The ring follows z_r = sum of a_n cos(n phi + e_n) and the tilt g_r exp(i phi) of the rotor's face if what closes it
    beats the friction of its secondary seal, its inertia and the change of its support springs at every angle:
    F > -m z_r'' - k z_r + F_f where it moves away, and what presses the faces then is left to tilt it, at most on the
    arm of the outer radius: |-I w^2 g + K (g - g_own) + M_f| / r_o more.  F_f and M_f are those of a ring that slides
    and tilts at once (dynamics/secondary_seal.py), and F no less than the friction alone.
    On the arm of the kern of the face, (r_i^2 + r_o^2)/(4 r_o), in place of r_o all of the face stays pressed: between
    the two loads one side of it opens, and only a run says how far.
    **Source** Hayden & Keller (1974): the spring load must exceed secondary-seal friction plus the inertia of following
    the runout; the tilt derived here, from the resultant of a face that only pushes.
    **Valid** balanced or absent pressures, no film force, constant speed, no gyroscopic moment (a stator that does not
    turn), only the stator floats; of a tilt over time the largest.
    Returns `ring`, `available` (spring, N), `needed` (N), `friction`, `inertia`, `tilting` (N, what the moment asks
    for, at most), `holds`, `sure` (N, from which on all of the face is pressed), `sentence`; None where there is
    nothing to follow, as of a rotor that carries the runout itself.
    """
    scene, rotor = model.scene, model.scene.rotor
    floating = [k for k, floats in model.unknowns.floats.items() if floats]
    tilt = max(points(rotor.runout), key=abs)
    if floating != [0] or not (rotor.axial_runout or tilt) or scene.closing.spring_force is None:
        return None
    ring = scene.stator
    spring = constant_and_slope(scene.closing.spring_force, model.start)[0]
    speed = constant_and_slope(scene.shaft.speed, model.start)[0]
    friction = ring.secondary_seal.breakaway()[0] if ring.secondary_seal else 0.0
    whole = all(float(r.order).is_integer() for r in rotor.axial_runout)
    phi = np.linspace(0, 2 * math.pi * (1 if whole else TURNS), POINTS * (1 if whole else TURNS))
    z, rate, acceleration = (np.zeros_like(phi) for _ in range(3))
    for runout in rotor.axial_runout:
        w = runout.order * speed
        angle = runout.order * phi + runout.phase
        z += runout.amplitude * np.cos(angle)
        rate -= runout.amplitude * w * np.sin(angle)
        acceleration -= runout.amplitude * w * w * np.cos(angle)
    drag, moment = np.where(rate <= 0, friction, -friction), np.zeros_like(phi)
    if tilt:
        turned = tilt * np.exp(1j * (phi + rotor.runout_phase))
        moment = _tilting(ring, speed, turned, constant_and_slope(ring.misalignment, model.start)[0])
        if ring.secondary_seal and speed:
            drag, across = np.zeros_like(phi), 1j * math.copysign(1.0, speed) * turned / tilt
            for one in ring.secondary_seal.circles():
                along = np.clip(-rate / (one.radius * abs(speed) * tilt), -1.0, 1.0)
                drag += 2.0 / math.pi * one.friction * np.arcsin(along)
                moment = moment + 2.0 / math.pi * one.friction * one.radius * np.sqrt(1.0 - along**2) * across
        moment = np.abs(moment)
    inner, outer = scene.film.inner_radius, scene.film.outer_radius
    kern = (inner**2 + outer**2) / (4.0 * outer)
    pull = -ring.mass * acceleration - ring.support.axial_stiffness * z
    # A ring that has parted, and sticks, takes all of the friction to close again.
    needed, sure = (
        max(float(np.max(pull + drag + moment / arm)), friction if tilt else -math.inf) for arm in (outer, kern)
    )
    inertia, tilting = float(np.max(ring.mass * np.abs(acceleration))), float(np.max(moment)) / outer
    holds, together = spring > needed, spring > sure
    sentence = (
        f"spring {spring:.4g} N {'exceeds' if holds else 'does not exceed'} the {needed:.4g} N that the "
        f"{RING_NAMES[0]} needs to follow the runout (secondary-seal friction {friction:.4g} N, inertia "
        f"{inertia:.4g} N, {f'tilting up to {tilting:.4g} N, ' if tilt else ''}support springs): "
        + ("the faces stay together" if together else "" if holds else "the faces part (hang-up)")
        + (f"from {sure:.4g} N on all of the face is pressed, below one side of it opens" if holds > together else "")
    )
    return {"ring": RING_NAMES[0], "available": spring, "needed": needed, "friction": friction, "inertia": inertia,
            "tilting": tilting, "holds": holds, "sure": sure, "sentence": sentence}  # fmt: skip


def _tilting(ring, speed: float, turned, own: float):
    """Moments (N m, complex) that carry a ring along with tilts `turned` (m,) (rad, complex), without friction."""
    stretched = turned - own * np.exp(1j * ring.misalignment_direction)
    uneven = ring.support.tilt_difference() * np.exp(2j * ring.support.tilt_axis)
    springs = ring.support.tilt()[0] * stretched + uneven * stretched.conj()
    return springs - ring.transverse_inertia * speed**2 * turned


@dataclass(frozen=True)
class Rule:
    """A design rule: `judge(seal, limit)` gives its `Finding`, of a figure in `unit` (SI) against the `limit` (SI: one
    number, least and most, or a table; None: there is none); `source` is what of the guide its numbers are, `command`
    tests it ("" if nothing does)."""

    judge: Callable
    limit: object
    unit: str
    source: str
    command: str = ""
    guide: str = GUIDE


def rows(rules: dict[str, Rule], seal, acknowledge: dict[str, str]) -> list[dict]:
    """`findings` by a table of rules, by name, for what they judge; `acknowledge` {rule: reason}."""
    return [plain(_row(name, rule, rule.judge(seal, rule.limit), acknowledge.get(name)))
            for name, rule in sorted(rules.items())]  # fmt: skip


def _row(name: str, rule: Rule, finding: Finding, reason: str | None) -> dict:
    if reason is not None and finding.verdict in (Verdict.FAIL, Verdict.NOTE):
        finding = replace(finding, verdict=Verdict.ACKNOWLEDGED)
    unit = rule.unit if finding.unit is None else finding.unit
    return {
        "rule": name,
        "verdict": str(finding.verdict),
        "value": finding.value,
        "unit": "" if finding.value is None else unit,
        "least": finding.least,
        "most": finding.most,
        "guide": rule.guide,
        "source": rule.source,
        "said": finding.sentence,
        "command": rule.command,
        "reason": reason,
        **finding.numbers,
    }
