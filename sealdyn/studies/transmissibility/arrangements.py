"""The arrangements of a seal, its rotor flexible, its stator or both: linear answers, closed forms, amplitudes and
phases of relative tilts over speed, and those of one arrangement from runs in time; over grooves the answers of rings
on the film of one pitch, which follows the speed under one closing force."""

import math
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ... import closed_form as cf
from ...closed_form.green_1989 import axial_groups, film_groups, ring_groups
from ...dynamics import modes
from ...dynamics.equilibrium import axial_shift
from ...dynamics.extrema import MOST
from ...dynamics.linearisation import moves_with_speed
from ...dynamics.model import Model
from ...dynamics.run_state import RunState
from ...dynamics.signals import signals
from ...quantities import in_words
from ...scene.excitation import Housing
from ...scene.film import Coefficients, aligned_gaps, coned, coning_change
from ...scene.fluid import viscosity_of
from ...scene.rings import RING_NAMES, ROTOR, STATOR
from ...scene.scene import (
    Initial,
    Scene,
    frozen_at_start,
    refuse_uneven,
    with_both_flexible_rings,
    with_single_flexible_ring,
)
from ...simulation.selection import choose_method
from ...simulation.stability import critical_speed
from ...solvers.contract import Recorder, Status
from ...solvers.integrate import solve

SEALS = ("fmr", "fms", "fmsr")
FORMULAS = {"fmr": (cf.fmr_static, cf.fmr_dynamic), "fms": (cf.fms_static, cf.fms_dynamic)}


def arranged(scene: Scene, name: str) -> Scene:
    """A scene as one arrangement (of SEALS); grooves stay in the face that has them, whichever ring floats."""
    found = with_both_flexible_rings(scene) if name == "fmsr" else with_single_flexible_ring(scene, name.upper())
    grooves = {ring: replace(found.rings[ring], grooves=scene.rings[ring].grooves) for ring in RING_NAMES}
    return replace(found, **grooves)


class Arrangement:
    """One arrangement (of SEALS) of the scenario's seal: its linear answers at any shaft speed (rad/s)."""

    def __init__(self, scene: Scene, name: str):
        self.name = name
        self.scene = arranged(scene, name)
        self.model = Model(self.scene)
        self.stator_speed = scene.stator.speed

    def linear(self, speed: float) -> modes.LinearScene:
        """The LinearScene at a shaft speed (rad/s)."""
        return self.model.linear_scene(speed=float(speed))

    def clearance(self, speed: float) -> float:
        """Clearance (m) at which the film holds the closing force at a shaft speed (rad/s)."""
        model = self.model.at_speed(float(speed))
        return model.clearance + axial_shift(model, model.start, float(speed))[0]

    def relative_tilts(self, speed: float, linear: modes.LinearScene | None = None) -> tuple[complex, complex]:
        """Static and dynamic relative tilt (stator minus rotor) per unit forcing (rad/rad), each in its frame, by
        harmonic balance; `linear` in place of that of the speed (rad/s)."""
        linear, found = linear or self.linear(speed), []
        for ring, frequency in ((STATOR, self.stator_speed), (ROTOR, speed)):
            none, circle = np.zeros(3, dtype=complex), np.array([0, 1, -1j])
            own = linear.rings[ring].floats
            forcing = modes.Harmonic(float(frequency), ring, none if own else circle, circle if own else none)
            tilt = linear.relative(forcing, linear.response(forcing))
            found.append(complex(tilt[1] + 1j * tilt[2]) / 2)
        return tuple(found)

    def formula_tilts(self, speeds) -> np.ndarray:
        """The same by the quotients of Green (1989) whose amplitudes `closed_form` gives, of two floating rings by
        fmsr_relative_tilts; complex, shape (2, n), at speeds (n,) (rad/s).

        **Source**, **Valid** closed_form/tilting_ring.py.
        """
        if self.name == "fmsr":
            rotor, stator = map(tilting, (self.scene.rotor, self.scene.stator))
            return np.array(cf.fmsr_relative_tilts(speeds, *self.film_numbers(speeds), rotor, stator))
        n = self.tilt_numbers(speeds)
        w, k_s, d_s, k, d = (n[name] for name in ("speed", "support_stiffness", "support_damping",
                                                       "film_stiffness", "film_damping"))  # fmt: skip
        behind = k - 0.5j * d * w
        if self.name == "fmr":
            support = k_s - 1j * d_s * w
            inertial = (n["polar_inertia"] - n["transverse_inertia"]) * w**2
            return np.array([support / (support + behind), -k_s / (inertial + k_s + behind.conj())])
        ring = k_s - n["transverse_inertia"] * w**2 + 1j * d_s * w
        return np.array([k_s / (k_s + behind), -ring / (ring + behind.conj())])

    def algebra(self, speed: float) -> tuple[float, float, float]:
        """Static, dynamic, total transmissibility (rad/rad) by harmonic balance at a speed (rad/s)."""
        static, dynamic = map(abs, self.relative_tilts(speed))
        return static, dynamic, static + dynamic

    def absolute(self, speed: float) -> float | None:
        """Tilt of the ring that floats per unit tilt of its rigid partner (rad/rad), 1 of one that follows it exactly,
        by harmonic balance at a speed (rad/s); None of two floating rings.

        **Source** Green (1989), eq. 7, for the rotor; the relative tilt is the stator's less the rotor's."""
        static, dynamic = self.relative_tilts(speed)
        return {"fmr": abs(1.0 - static), "fms": abs(1.0 + dynamic)}.get(self.name)

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt mode; 0 within its uncertainty."""
        return modes.growth([mode for mode in self.linear(speed).modes() if mode.kind == "tilt"])

    def critical_speed_by_formula(self) -> float | None:
        """Closed form of the critical speed (rad/s) of one flexible ring whose gap does not move with the speed."""
        if self.name == "fmsr" or moves_with_speed(self.scene):
            return None
        numbers = self.tilt_numbers(1.0)
        numbers.pop("speed")
        try:
            return (cf.fmr_critical_speed if self.name == "fmr" else cf.fms_critical_speed)(**numbers)
        except ValueError:
            return None

    def critical_speed(self) -> float | None:
        """The seal's critical speed (rad/s)."""
        return critical_speed(self.model)

    def film_numbers(self, speed) -> tuple[np.ndarray, np.ndarray]:
        """Tilt stiffness (N m/rad) and tilt damping (N m s/rad) of the film at a speed (rad/s, number or array)."""
        films = [(s.film_k[1, 1], s.film_d[1, 1]) for s in map(self.linear, np.atleast_1d(speed))]
        return tuple(np.array(column).reshape(np.shape(speed)) for column in zip(*films, strict=True))

    def tilt_numbers(self, speed) -> dict:
        """The seven keywords of the closed forms of one floating ring (SI), speed (rad/s, number or array) among them;
        film coefficients re-evaluated at each speed."""
        ring = tilting(self.scene.rotor if self.name == "fmr" else self.scene.stator)
        stiffness, damping = self.film_numbers(speed)
        return {"speed": speed, **ring._asdict(), "film_stiffness": stiffness, "film_damping": damping}

    def formula_holds(self, speed: float) -> bool:
        """Whether the film is isotropic with the wedge of the mean spin and stores nothing, and the stator stands."""
        if self.model.interface.stores:
            return False
        k, d = self.linear(speed).film_k, self.linear(speed).film_d
        wanted_k, wanted_d = modes.film_matrices(k[1, 1], d[1, 1], k[0, 0], d[0, 0], 0.5 * speed)
        near = np.allclose(k[1:, 1:], wanted_k[1:, 1:], rtol=0, atol=1e-7 * np.abs(k[1:, 1:]).max())
        return bool(self.stator_speed == 0 and near and np.allclose(d[1:, 1:], wanted_d[1:, 1:], rtol=1e-7, atol=1e-12))

    def formula(self, speed):
        """Static, dynamic, total transmissibility (rad/rad) by the closed forms, at a speed (rad/s, number or
        array)."""
        if self.name == "fmsr":
            tilts = self.formula_tilts(np.atleast_1d(speed))
            static, dynamic = np.abs(tilts).reshape(2, *np.shape(speed))
        else:
            static, dynamic = (f(**self.tilt_numbers(speed)) for f in FORMULAS[self.name])
        return static, dynamic, static + dynamic


def tilting(ring) -> cf.TiltingRing:
    """What a floating ring of a scene is in tilt (SI)."""
    return cf.TiltingRing(ring.transverse_inertia, ring.polar_inertia, *ring.support.tilt())


def seals_of(scene: Scene) -> dict[str, Arrangement]:
    """The arrangements {"fmr": ..., "fms": ..., "fmsr": ...} of the scene's seal, as `quiet`."""
    scene = quiet(scene)
    return {name: Arrangement(scene, name) for name in SEALS}


def quiet(scene: Scene) -> Scene:
    """A scene at its start with nothing imposed, clearance kept, or the closing force of heated faces."""
    scene = frozen_at_start(scene)
    refuse_uneven(scene)
    if scene.film.heat is None:
        # That of heated faces follows the speed, under the same closing force.
        scene = frozen_at_start(scene, clearance=Model(scene).clearance)
    scene = replace(scene, housing=Housing(), initial=Initial(), shaft=replace(scene.shaft, whirl=[], motion=None))
    rings = {"rotor": replace(scene.rotor, axial_runout=[], mass_centre=None, load=None),
             "stator": replace(scene.stator, mass_centre=None, load=None)}  # fmt: skip
    return replace(scene, **rings)


def groups(seals: dict[str, Arrangement], speed: float) -> dict:
    """Green's dimensionless groups at a speed (rad/s), {} at rest: those of faces and film, and of the rings on their
    supports, `rotor` and `stator`, as they float in the FMSR seal, those of axial motion under `axial`; what each is:
    closed_form/green_1989.py."""
    if speed == 0.0:
        return {}
    seal = seals["fmsr"]
    film = coned(seal.model.at_speed(speed).scene, float, speed)
    face = dict(
        speed=speed,
        viscosity=viscosity_of(film),
        inner_radius=film.inner_radius,
        outer_radius=film.outer_radius,
        clearance=film.clearance,
    )
    stiffness, damping = (float(v) for v in seal.film_numbers(speed))
    drop = film.outer_pressure - film.inner_pressure
    coefficients = {"film_stiffness": stiffness, "film_damping": damping}
    found = film_groups(**face, coning=film.coning, pressure_drop=drop, **coefficients)
    linear = seal.linear(speed)
    found["axial"] = {"film": axial_groups(**face, stiffness=linear.film_k[0, 0], damping=linear.film_d[0, 0])}
    for name, ring in (("rotor", seal.scene.rotor), ("stator", seal.scene.stator)):
        axial = dict(mass=ring.mass, stiffness=ring.support.axial_stiffness, damping=ring.support.axial_damping)
        found["axial"][name] = axial_groups(**face, **axial)
        found[name] = ring_groups(**face, **tilting(ring)._asdict())
        if not np.isfinite(found[name]["inertia_ratio"]):
            found[name]["inertia_ratio"] = None
    return found


QUANTITIES = ("static", "dynamic", "total")
PHASES = ("static_phase", "dynamic_phase")
# Forcing of a time-domain point, as part of the thinnest edge film, and what may be left of its transient.
AMPLITUDE, LEFT, PER_TURN = 0.2, 1e-9, 64
COARSER = 100.0


def points_in_time(scenario, settings, speeds, own_speed, tools) -> list[dict]:
    """Rows of a dozen speeds, the scenario's own among them."""
    if settings.time_points < 1:
        return []
    chosen = np.linspace(speeds[0], speeds[-1], settings.time_points + (speeds[0] == 0))
    chosen = sorted({float(w) for w in [*chosen, own_speed] if w != 0})
    points = [
        {"seal": seal, "speed": w, "accuracy": settings.accuracy, "longest": settings.longest}
        for w in chosen
        for seal in SEALS
    ]
    return tools.map(partial(measured, scenario.scene), points, "time domain", ("seal", "speed"))


def measured(scene, point: dict) -> dict:
    """Static, dynamic and total of one arrangement at one speed, from a run on the linear film in the film's own
    coefficients; `error`: the difference to a run at a hundred times coarser accuracy."""
    seal = seals_of(scene)[point["seal"]]
    if seal.model.interface.stores:
        raise ValueError("a film that stores: no linear film with one stiffness and damping stands for it in time")
    decay = -seal.growth(point["speed"])
    if point["speed"] == seal.stator_speed:
        raise ValueError("the stator turns with the shaft: static and dynamic are one")
    turn = 2 * math.pi / abs(point["speed"] - seal.stator_speed)
    if decay <= 0:
        kind = "unstable" if decay < 0 else "undamped"
        raise ValueError(f"{kind} at {in_words('speed', point['speed'])}: no steady state")
    turns = math.ceil(-math.log(LEFT) / decay / turn) + 4
    if turns > point["longest"]:
        raise ValueError(f"the transient takes {turns} turns to die out, more than {point['longest']:g}")
    clearance = seal.clearance(point["speed"])
    amplitude = _amplitude(seal, point["speed"], clearance)
    scene = _forced(seal, point["speed"], clearance, amplitude)
    fine = np.array(_steady(scene, turns, point["accuracy"], amplitude))
    coarse = np.array(_steady(scene, turns, COARSER * point["accuracy"], amplitude))
    away = np.abs(fine - coarse)
    # 359 deg apart is 1 deg apart.
    away[3:] = np.minimum(away[3:], 360.0 - away[3:])
    names = (*QUANTITIES, *PHASES)
    return dict(zip(names, fine.tolist(), strict=True)) | {
        "error": dict(zip(names, away.tolist(), strict=True)), "turns": turns
    }  # fmt: skip


def _amplitude(seal: Arrangement, speed: float, clearance: float) -> float:
    """Forcing (rad) that leaves the film of a `clearance` (m) open."""
    scene = seal.model.at_speed(speed).scene
    film, change = scene.film, coning_change(scene, float, speed)
    thinnest = min(h for _, h in aligned_gaps(film, clearance, change))
    return AMPLITUDE * thinnest / film.outer_radius / max(1.0, seal.algebra(speed)[2])


def _forced(seal: Arrangement, speed: float, clearance: float, amplitude: float) -> Scene:
    """The arrangement with both forcings (rad), on the linear film of a `clearance` (m), which has the
    stiffness of asperities that touch too."""
    linear = seal.linear(speed)
    own = Coefficients(
        tilt_stiffness=linear.film_k[1, 1],
        tilt_damping=linear.film_d[1, 1],
        axial_stiffness=linear.film_k[0, 0],
        axial_damping=linear.film_d[0, 0],
    )
    scene = frozen_at_start(seal.model.at_speed(speed).scene, speed)
    return replace(
        scene,
        # Inertia has moved the gap, and is in the coefficients.
        film=replace(scene.film, model="linear", coefficients=own, inertia=False, clearance=clearance),
        contact=None,
        stator=replace(scene.stator, misalignment=amplitude, misalignment_direction=0.0),
        rotor=replace(scene.rotor, misalignment=amplitude, runout=amplitude, misalignment_phase=0.0, runout_phase=0.0),
    )


def _steady(scene: Scene, turns: int, accuracy: float, amplitude: float) -> tuple:
    """Relative tilt per unit forcing over the last turn of a run from rest: what turns with the stator, what with
    the shaft, the largest, and the phases (deg) of the first two."""
    speed = scene.shaft.speed
    # A turn of the shaft seen from the stator: over it the two frequencies are orthogonal and meet once.
    turn = 2 * math.pi / abs(speed - scene.stator.speed)
    run = RunState(Model(scene, accuracy), turns * turn)
    run.extrema.windows[1] = [run.duration - turn, run.duration]
    recorder = Recorder(turn / PER_TURN)
    outcome = solve(run, choose_method(run)[0], accuracy, recorder)
    if outcome.status != Status.OK:
        raise ValueError(outcome.message)
    t, q, rate = (a[-PER_TURN:] for a in recorder.arrays())
    seen = signals(run.segment(0), t, q, rate)
    tilt = seen["relative_tilt_x"] + 1j * seen["relative_tilt_y"]
    static, dynamic = (np.mean(tilt * np.exp(-1j * w * t)) / amplitude for w in (scene.stator.speed, speed))
    largest = run.extrema.records[1, MOST] / amplitude
    return tuple(float(v) for v in (abs(static), abs(dynamic), largest, *phases(speed, static, dynamic)))


def phases(speeds, static, dynamic) -> tuple:
    """Phases (deg) of the relative tilts (stator minus rotor, in the frame of the forcing) behind their forcings."""
    sense = np.where(np.asarray(speeds) < 0, -1.0, 1.0)
    # The rotor carries the dynamic forcing: counted from it, the relative tilt has the other sign.  (+ 0 for no -0.)
    return tuple(0.0 - sense * np.degrees(np.angle(tilt)) + 0.0 for tilt in (static, -np.asarray(dynamic)))


def curves(speeds, tilts) -> dict:
    """Amplitudes and phases over speed, phases without jumps."""
    static, dynamic = np.abs(tilts)
    lags = [_without_jumps(lag).tolist() for lag in phases(speeds, *tilts)]
    amplitudes = [a.tolist() for a in (static, dynamic, static + dynamic)]
    return dict(zip((*QUANTITIES, *PHASES), (*amplitudes, *lags), strict=True))


def _without_jumps(lag) -> np.ndarray:
    """Phases (deg) that run on; of those that begin behind and ahead at once, half a turn away, as near to zero as they
    can be told."""
    lag = np.unwrap(lag, period=360.0)
    return lag - 360.0 * np.round(lag.mean() / 360.0) if abs(lag[0]) > 90.0 else lag


def phases_apart(one, other) -> float:
    """Largest distance (deg) of two rows of phases: 359 deg apart is 1 deg apart."""
    away = np.abs(np.asarray(one) - other) % 360.0
    return float(np.max(np.minimum(away, 360.0 - away)))


class OverGrooves(Arrangement):
    """One arrangement; `film` (FilmOverSpeed) at any speed is that of all of them."""

    def __init__(self, scene: Scene, name: str, film):
        from .._grooved_roots import RootsOverSpeed

        super().__init__(scene, name)
        self.roots, self.rates = RootsOverSpeed(self.scene, film), {}

    def relative_tilts(self, speed: float) -> tuple[complex, complex]:
        """As of Arrangement, with 3 grooves and more; of fewer the part at the forcing's own frequency."""
        from ...films._grooved.motion import relative_tilt, support_law
        from .._grooved_roots import rings_of

        motions = self.roots.film(speed)[2]
        rings = rings_of(frozen_at_start(self.scene, speed=speed))
        floats = [name for name, ring in self.scene.rings.items() if ring.support is not None]

        def answers(motion):
            found = []
            for name, frequency, sign in (("stator", self.stator_speed, 1.0), ("rotor", speed, -1.0)):
                if name in floats:
                    k = floats.index(name)
                    moment, ahead = rings[k].angular_stiffness, (rings[k], *rings[:k], *rings[k + 1 :])
                else:
                    moment, ahead = support_law(rings[0], 1j * frequency), rings
                found.append(sign * relative_tilt(motion, ahead, moment, frequency)[0])
            return np.array(found)

        static, dynamic = motions.of_motion(answers)[0]
        return complex(static), complex(dynamic)

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt."""
        if speed not in self.rates:
            self.rates[speed] = self.roots.growth(speed)
        return self.rates[speed]

    def critical_speed(self) -> float | None:
        """Lowest speed (rad/s) of those looked at from which on a tilt grows."""
        known = sorted(self.rates)
        for low, high in pairwise(known):
            if self.rates[low] < 0.0 <= self.rates[high]:
                return self.roots.threshold(low, high)
        return None

    def film_numbers(self, speed) -> tuple[np.ndarray, np.ndarray]:
        """Tilt stiffness (N m/rad) and damping (N m s/rad) of the film at speeds (rad/s), once per turn."""
        films = [self.roots.film(float(w))[2].of_motion(lambda motion, w=w: np.array(motion.matrices(abs(w))))[0]
                 for w in np.atleast_1d(speed)]  # fmt: skip
        return tuple(np.array([film[k][1, 1] for film in films]).reshape(np.shape(speed)) for k in (0, 1))

    def formula_holds(self, speed: float) -> bool:
        """Never: no closed form has grooves."""
        return False


def seals_over_grooves(scene: Scene) -> dict[str, OverGrooves]:
    """The arrangements of a scene, as of `seals_of`, on one film."""
    from .._grooved_roots import FilmOverSpeed

    scene = quiet(scene)
    film = FilmOverSpeed(scene)
    return {name: OverGrooves(scene, name, film) for name in SEALS}
