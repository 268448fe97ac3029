"""Scenes made of a scene: the FMS twin of an FMR seal and back, the scene held at one speed, and both compared.

The twin carries the same ring on the other side: mass, inertias, support and own misalignment move over; the rigid
partner gets the runout (FMS) or the fixed misalignment (FMR) that the other partner had.  The film stays.
"""

from dataclasses import replace

import numpy as np

from .. import closed_form as cf
from ..dynamics import modes
from ..dynamics.equilibrium import initially
from ..dynamics.model import Model
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.excitation import Housing, Shaft
from ..scene.rings import ROTOR, STATOR, Rotor, Stator
from ..scene.scene import Closing, Initial, Scene, SceneError

SEALS = ("fmr", "fms")
FORMULAS = {"fmr": (cf.fmr_static, cf.fmr_dynamic), "fms": (cf.fms_static, cf.fms_dynamic)}
CARRIED = ("mass", "transverse_inertia", "polar_inertia", "unphysical_inertia", "misalignment", "support",
           "secondary_seal")  # fmt: skip


def arrangement(scene: Scene) -> str:
    """ "FMR", "FMS" or "FMSR": which rings float."""
    if scene.stator.support and scene.rotor.support:
        return "FMSR"
    return "FMR" if scene.rotor.support else "FMS"


def counterpart(scene: Scene) -> Scene:
    """The same seal with the other ring flexible.

    **Source** Green (1989), who compares the two arrangements of one seal this way.
    Raises ImpossibleScene when both rings float: there is no rigid partner to change places with.
    """
    rotor, stator = scene.rotor, scene.stator
    if rotor.support and stator.support:
        raise SceneError("stator.support", "a support under both rings", "one flexible ring, to have a twin")
    if rotor.support:
        moved = {name: getattr(rotor, name) for name in CARRIED}
        new_stator = Stator(**moved, misalignment_direction=rotor.misalignment_phase, speed=stator.speed)
        new_rotor = Rotor(
            runout=stator.misalignment, runout_phase=stator.misalignment_direction, axial_runout=rotor.axial_runout
        )
    else:
        moved = {name: getattr(stator, name) for name in CARRIED}
        new_rotor = Rotor(**moved, misalignment_phase=stator.misalignment_direction, axial_runout=rotor.axial_runout)
        new_stator = Stator(misalignment=rotor.runout, misalignment_direction=rotor.runout_phase, speed=stator.speed)
    start = Initial(rotor=scene.initial.stator, stator=scene.initial.rotor)
    return replace(scene, rotor=new_rotor, stator=new_stator, initial=start)


def with_single_flexible_ring(scene: Scene, wanted: str) -> Scene:
    """The scene as FMR or FMS (`wanted`): itself, its twin, or, of two floating rings, the other one held rigid."""
    present = arrangement(scene)
    if present == wanted:
        return scene
    if present != "FMSR":
        return counterpart(scene)
    if wanted == "FMR":
        return replace(scene, stator=replace(scene.stator, support=None))
    runout = replace(scene.rotor, support=None, runout=scene.rotor.misalignment)
    return replace(scene, rotor=runout)


def frozen_at_start(scene: Scene, speed: float | None = None, clearance: float | None = None) -> Scene:
    """The scene with every table at its initial value, and at another shaft speed (rad/s) or clearance (m) if given;
    with a clearance, the closing force is what holds it."""
    film = replace(
        scene.film,
        **{name: initially(getattr(scene.film, name)) for name in ("viscosity", "outer_pressure", "inner_pressure")},
    )
    closing = scene.closing
    if clearance is not None:
        film, closing = replace(film, clearance=clearance), Closing()
    elif isinstance(closing.spring_force, PiecewiseLinear):
        closing = replace(closing, spring_force=initially(closing.spring_force))
    rotor, stator = scene.rotor, scene.stator
    rotor = replace(rotor, misalignment=initially(rotor.misalignment), runout=initially(rotor.runout))
    stator = replace(stator, misalignment=initially(stator.misalignment), speed=initially(stator.speed))
    shaft = Shaft(initially(scene.shaft.speed) if speed is None else float(speed), scene.shaft.whirl)
    return replace(scene, shaft=shaft, film=film, rotor=rotor, stator=stator, closing=closing)


class Arrangement:
    """One arrangement of the scenario's seal: its linear answers at any shaft speed (rad/s)."""

    def __init__(self, scene: Scene, name: str):
        self.name, self.scene = name, with_single_flexible_ring(scene, name.upper())
        self.model = Model(self.scene)
        self.stator_speed = scene.stator.speed

    def linear(self, speed: float) -> modes.LinearScene:
        return self.model.linear_scene(speed=float(speed))

    def relative_tilts(self, speed: float) -> tuple[complex, complex]:
        """Static and dynamic relative tilt (stator minus rotor) per unit forcing, in its frame, by harmonic balance."""
        linear, found = self.linear(speed), []
        for ring, frequency in ((STATOR, self.stator_speed), (ROTOR, speed)):
            none, circle = np.zeros(3, dtype=complex), np.array([0, 1, -1j])
            own = linear.rings[ring].floats
            forcing = modes.Harmonic(float(frequency), ring, none if own else circle, circle if own else none)
            tilt = linear.relative(forcing, linear.response(forcing))
            found.append(complex(tilt[1] + 1j * tilt[2]) / 2)
        return tuple(found)

    def formula_tilts(self, speeds) -> np.ndarray:
        """The same by the quotients of Green (1989) whose amplitudes `closed_form` gives; complex, shape (2, n)."""
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
        """Static, dynamic, total by harmonic balance."""
        static, dynamic = map(abs, self.relative_tilts(speed))
        return static, dynamic, static + dynamic

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt mode; 0 within rounding."""
        values = [mode.value for mode in self.linear(speed).modes() if mode.kind == "tilt"]
        rate = max(value.real for value in values)
        return rate if abs(rate) > modes.NEUTRAL * max(map(abs, values)) else 0.0

    def tilt_numbers(self, speed) -> dict:
        """The keywords of the closed forms; film coefficients re-evaluated at each speed."""
        films = [(s.film_k[1, 1], s.film_d[1, 1]) for s in map(self.linear, np.atleast_1d(speed))]
        ring = self.scene.rotor if self.name == "fmr" else self.scene.stator
        stiffness, damping = ring.support.tilt()
        return {
            "speed": speed,
            "transverse_inertia": ring.transverse_inertia,
            "polar_inertia": ring.polar_inertia,
            "support_stiffness": stiffness,
            "support_damping": damping,
            "film_stiffness": np.array([k for k, _ in films]).reshape(np.shape(speed)),
            "film_damping": np.array([d for _, d in films]).reshape(np.shape(speed)),
        }

    def formula_holds(self, speed: float) -> bool:
        """Whether the film is isotropic with the wedge of the mean spin, and the stator stands still."""
        k, d = self.linear(speed).film_k, self.linear(speed).film_d
        wanted_k, wanted_d = modes.film_matrices(k[1, 1], d[1, 1], k[0, 0], d[0, 0], 0.5 * speed)
        near = np.allclose(k[1:, 1:], wanted_k[1:, 1:], rtol=0, atol=1e-7 * np.abs(k[1:, 1:]).max())
        return bool(self.stator_speed == 0 and near and np.allclose(d[1:, 1:], wanted_d[1:, 1:], rtol=1e-7, atol=1e-12))

    def formula(self, speed):
        """Static, dynamic, total by the closed forms."""
        static, dynamic = (f(**self.tilt_numbers(speed)) for f in FORMULAS[self.name])
        return static, dynamic, static + dynamic


def seals_of(scenario) -> dict[str, Arrangement]:
    """Both arrangements of the scenario's seal, nothing imposed, clearance kept."""
    clearance = Model(frozen_at_start(scenario.scene)).clearance
    scene = frozen_at_start(scenario.scene, clearance=clearance)
    quiet = replace(scene, housing=Housing(), initial=Initial(), shaft=replace(scene.shaft, whirl=[]))
    quiet = replace(quiet, rotor=replace(quiet.rotor, axial_runout=[]))
    return {name: Arrangement(quiet, name) for name in SEALS}
