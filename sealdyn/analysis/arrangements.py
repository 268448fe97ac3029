"""The arrangements of a seal, its rotor flexible, its stator or both: their linear answers and the closed forms."""

from dataclasses import replace

import numpy as np

from .. import closed_form as cf
from ..dynamics import modes
from ..dynamics.equilibrium import axial_shift
from ..dynamics.model import Model
from ..scene.excitation import Housing
from ..scene.rings import ROTOR, STATOR
from ..scene.scene import Initial, Scene
from ..scene.variants import frozen_at_start, with_both_flexible_rings, with_single_flexible_ring

SEALS = ("fmr", "fms", "fmsr")
FORMULAS = {"fmr": (cf.fmr_static, cf.fmr_dynamic), "fms": (cf.fms_static, cf.fms_dynamic)}


class Arrangement:
    """One arrangement (of SEALS) of the scenario's seal: its linear answers at any shaft speed (rad/s)."""

    def __init__(self, scene: Scene, name: str):
        both = name == "fmsr"
        self.name = name
        self.scene = with_both_flexible_rings(scene) if both else with_single_flexible_ring(scene, name.upper())
        self.model = Model(self.scene)
        self.stator_speed = scene.stator.speed

    def linear(self, speed: float) -> modes.LinearScene:
        """The LinearScene at a shaft speed (rad/s)."""
        return self.model.linear_scene(speed=float(speed))

    def clearance(self, speed: float) -> float:
        """Clearance (m) at which the film holds the closing force at a shaft speed (rad/s)."""
        model = self.model.at_speed(float(speed))
        return model.clearance + axial_shift(model, model.start, float(speed))[0]

    def relative_tilts(self, speed: float) -> tuple[complex, complex]:
        """Static and dynamic relative tilt (stator minus rotor) per unit forcing (rad/rad), each in its frame, by
        harmonic balance."""
        linear, found = self.linear(speed), []
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

        **Source**, **Valid** closed_form/response.py, closed_form/response.py.
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

    def growth(self, speed: float) -> float:
        """Growth rate (1/s) of the least damped tilt mode; 0 within its uncertainty."""
        return modes.growth([mode for mode in self.linear(speed).modes() if mode.kind == "tilt"])

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
    """The arrangements {"fmr": ..., "fms": ..., "fmsr": ...} of the scene's seal, nothing imposed, clearance kept, or
    the closing force of heated faces."""
    scene = frozen_at_start(scene)
    if scene.film.heat is None:
        # That of heated faces follows the speed, under the same closing force.
        scene = frozen_at_start(scene, clearance=Model(scene).clearance)
    quiet = replace(scene, housing=Housing(), initial=Initial(), shaft=replace(scene.shaft, whirl=[], motion=None))
    quiet = replace(quiet, rotor=replace(quiet.rotor, axial_runout=[]))
    return {name: Arrangement(quiet, name) for name in SEALS}
