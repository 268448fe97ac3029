"""A scene, rings, film, shaft and what drives them, as plain data that decides its own model; and scenes made of
scenes: other values at dotted keys, everything held constant, nothing imposed, the other ring flexible, or both.

The counterpart carries the same ring on the other side: mass, inertias, support, waves and own misalignment move
over; the rigid partner gets the runout (FMS) or the fixed misalignment (FMR) that the other partner had.  The film
stays.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any

from ..numerics.piecewise_linear import PiecewiseLinear, points
from ..status import Status
from ..units import Force, Height, Share, Tilt, TiltRate, Varying, Velocity, cut
from . import Strict
from .excitation import ACCELERATIONS, MOTION_COLUMNS, Housing, Shaft
from .film import Film
from .forces import LOAD_COLUMNS, Contact, standing
from .rings import INERTIAL, OF_MASS, RING_NAMES, Rotor, Stator, stuck_support, with_inertia
from .tabulated import COLUMNS


@dataclass(frozen=True)
class Closing(Strict):
    """The `[closing]` table: hydraulic balance and spring force (N).  Give two of balance ratio, spring force and film
    clearance and the third follows; give the clearance alone and the closing force is what holds it."""

    balance_ratio: Share | None = None
    """Closing area over face area, of the high-pressure side."""
    spring_force: Varying[Force] | None = None
    """Closing force of the springs at the operating length."""


@dataclass(frozen=True)
class RingStart(Strict):
    """Where a floating ring starts, in place of what `run.start` gives: displacement, tilt, and their rates (m, rad,
    m/s, rad/s)."""

    z: Height | None = None
    """Displacement along the shaft axis from equilibrium; positive closes a rotor's gap and opens a stator's."""
    tilt_x: Tilt | None = None
    """Tilt about the x axis."""
    tilt_y: Tilt | None = None
    """Tilt about the y axis."""
    z_rate: Velocity | None = None
    """Rate of `z`."""
    tilt_x_rate: TiltRate | None = None
    """Rate of `tilt_x`."""
    tilt_y_rate: TiltRate | None = None
    """Rate of `tilt_y`."""


@dataclass(frozen=True)
class Initial(Strict):
    """The `[initial]` table; what it gives overrides `run.start`."""

    rotor: RingStart = field(default_factory=RingStart)
    """Start of a floating rotor."""
    stator: RingStart = field(default_factory=RingStart)
    """Start of a floating stator."""

    @property
    def given(self) -> bool:
        """Whether it gives anything."""
        return any(value is not None for ring in (self.rotor, self.stator) for value in vars(ring).values())


@dataclass(frozen=True)
class Scene(Strict):
    """Everything physical a scenario describes, SI."""

    shaft: Shaft
    """Speed and whirl."""
    film: Film
    """Faces, fluid, pressures, film model."""
    rotor: Rotor = field(default_factory=Rotor)
    """The ring that turns with the shaft."""
    stator: Stator = field(default_factory=Stator)
    """The ring that stands in the housing."""
    housing: Housing = field(default_factory=Housing)
    """Vibration of the housing."""
    closing: Closing = field(default_factory=Closing)
    """Hydraulic balance and spring."""
    initial: Initial = field(default_factory=Initial)
    """Start of the floating rings."""
    contact: Contact | None = None
    """Asperities; without this table a film that closes ends the run."""

    @property
    def rings(self) -> dict[str, Stator | Rotor]:
        """Both rings by their names."""
        return {"stator": self.stator, "rotor": self.rotor}


class SceneError(ValueError):
    """A scene that cannot exist: the key to blame, what was found, what is expected, and the `status` of its run;
    `others`: what else is wrong with the same tables."""

    status = Status.INVALID
    others: "tuple[SceneError, ...]" = ()

    def __init__(self, key: str, found: str, expected: str):
        super().__init__(key, found, expected)
        self.key, self.found, self.expected = key, found, expected

    def __str__(self):
        return f"{cut(self.key)}: found {cut(self.found)}; expected {cut(self.expected, 600)}"


# A key that is given takes its alternatives in the same table away.
ALTERNATIVES = {
    "turns": ("duration",),
    "duration": ("turns", "octaves_per_minute"),
    "octaves_per_minute": ("duration",),
    "samples": ("samples_per_turn",),
    "samples_per_turn": ("samples",),
    "displacement": ("acceleration",),
    "acceleration": ("displacement",),
    "file": ("time", *MOTION_COLUMNS, *ACCELERATIONS, *LOAD_COLUMNS, *COLUMNS),
    "time": ("file",),
    **dict.fromkeys((*MOTION_COLUMNS, *ACCELERATIONS, *LOAD_COLUMNS), ("file",)),
    "radius": ("tilt_stiffness", "tilt_damping", "diameter"),
    "diameter": ("tilt_stiffness", "tilt_damping", "radius"),
    "tilt_stiffness": ("radius", "diameter"),
    "tilt_damping": ("radius", "diameter"),
    "inner_radius": ("inner_diameter",),
    "inner_diameter": ("inner_radius",),
    "outer_radius": ("outer_diameter",),
    "outer_diameter": ("outer_radius",),
}
# Tables that may hold functions of time.
VARYING = ("shaft", "film", "rotor", "stator", "closing")
# What a study may be asked to leave out, and the tables that hold it: without contact it is one of the film alone.
LEFT_OUT = {
    "contact": ("contact", "stator.secondary_seal", "rotor.secondary_seal"),
    "secondary-seal": ("stator.secondary_seal", "rotor.secondary_seal"),
}
CARRIED = (*OF_MASS, "misalignment", "support", "secondary_seal", "load")
# What a face keeps, whichever side its ring is on.
FACE = ("waviness", "grooves")


def part(scene, key: str) -> Any:
    """The value at a dotted key, "rotor.runout" or "housing.axial.0.frequency".  Raises AttributeError, IndexError,
    ValueError."""
    for step in key.split("."):
        scene = scene[int(step)] if isinstance(scene, list | tuple) else getattr(scene, step)
    return scene


def with_values(scene, values: dict[str, Any]):
    """The scene (or another frozen table) with other values at dotted keys.

    `values` {"rotor.runout": 2e-4, "housing.axial.0.frequency": 50.0}: SI numbers, `PiecewiseLinear`, whole tables, or
    None for nothing, one after the other; each takes its ALTERNATIVES away.  What it gives is not checked here
    (`checks.check_scene`).  Raises SceneError for keys that the scene does not have.
    """
    for key, value in values.items():
        scene = _with_value(scene, key.split("."), value, key)
        name, _, below = key.partition(".")
        if name in RING_NAMES and scene.rings[name].body:
            # A body's mass follows it; a mass of its own does without the body.
            ring = scene.rings[name]
            ring = replace(ring, body=None) if below in INERTIAL else with_inertia(ring)
            scene = replace(scene, **{name: ring})
    return scene


def _with_value(table, path: list[str], value, key: str):
    step, *rest = path
    if isinstance(table, list | tuple):
        if not step.isdecimal() or int(step) >= len(table):
            raise SceneError(key, f"entry {step} of {len(table)}", f"0 to {len(table) - 1}" if table else "no entry")
        new = _with_value(table[int(step)], rest, value, key) if rest else value
        return type(table)(new if n == int(step) else entry for n, entry in enumerate(table))
    known = [f.name for f in fields(table)] if hasattr(table, "__dataclass_fields__") else []
    if step not in known:
        raise SceneError(key, f"no {step}", f"one of {', '.join(known)}" if known else "a table above it")
    if rest:
        return replace(table, **{step: _with_value(getattr(table, step), rest, value, key)})
    dropped = {name: None for name in ALTERNATIVES.get(step, ()) if name in known}
    return replace(table, **dropped, **{step: value})


# --- without what is not smooth -----------------------------------------------------------------------


def tables_of(scene: Scene, what) -> list[str]:
    """Dotted names of the tables that the scene has of `what`, names of LEFT_OUT."""
    names = dict.fromkeys(name for word in what for name in LEFT_OUT[word])
    return [name for name in names if part(scene, name)]


def seals_that_stick(scene: Scene) -> list[str]:
    """Dotted names of the secondary seals on which floating rings of the scene slide."""
    return [name for name in tables_of(scene, ["secondary-seal"]) if part(scene, name.split(".")[0]).support]


def with_springs_for_seals(scene: Scene) -> tuple[Scene, list[str]]:
    """The scene as small motion meets it, where secondary seals that give are springs beside the supports; dotted names
    of these seals."""
    names = [key for key in seals_that_stick(scene) if part(scene, key).stiffness is not None]
    for key in names:
        support = key.replace("secondary_seal", "support")
        scene = with_values(scene, {support: stuck_support(part(scene, key.split(".")[0])), key: None})
    return scene, names


def uneven_supports(scene: Scene) -> list[str]:
    """Dotted names of the supports with two different tilt stiffnesses."""
    return [f"{name}.support" for name, ring in scene.rings.items() if (s := ring.support) and s.tilt_difference()]


def refuse_uneven(scene: Scene) -> None:
    """Raises SceneError for a support with two different tilt stiffnesses, where a formula knows one."""
    for key in uneven_supports(scene):
        raise SceneError(f"{key}.tilt_stiffness", "two of them", "one: the formulas know no other support")


def turning_supports(scene: Scene) -> list[str]:
    """Those of them that turn."""
    speeds = {"stator": scene.stator.speed, "rotor": scene.shaft.speed}
    return [key for key in uneven_supports(scene) if any(points(speeds[key.partition(".")[0]]))]


def without(scene: Scene, what) -> Scene:
    """The scene without `what`, names of LEFT_OUT: without "contact" that of the film alone."""
    return with_values(scene, dict.fromkeys(tables_of(scene, what)))


# --- constant in time, and free of forcing ------------------------------------------------------------


def tables_at_end(scene: Scene) -> Scene:
    """The scene with every function of time at its last value."""
    return _constant(scene, lambda table: float(table.value[-1]))


def frozen_at_start(scene: Scene, speed: float | None = None, clearance: float | None = None) -> Scene:
    """The scene with every function of time at its initial value, and at another shaft speed (rad/s) or clearance (m)
    if given; with a clearance, the closing force is what holds it."""
    scene = frozen_at(scene, 0.0)
    if speed is not None:
        scene = with_values(scene, {"shaft.speed": float(speed)})
    return scene if clearance is None else with_values(scene, {"film.clearance": clearance, "closing": Closing()})


def frozen_at(scene: Scene, time: float) -> Scene:
    """The scene with every function of time at its value at a `time` (s)."""
    return _constant(scene, lambda table: table.at(time))


def unforced(scene: Scene, speed: float) -> Scene:
    """The scene aligned and free of forcing, at constant conditions (functions of time at zero) and one shaft speed
    (rad/s), `tilting`; a constant axial force from outside stays, since the rest hangs on it."""
    scene = tilting(frozen_at_start(scene))
    rotor, stator, aligned = scene.rotor, scene.stator, {"misalignment": 0.0, "mass_centre": None}
    return replace(
        scene,
        shaft=Shaft(speed=speed),
        rotor=replace(rotor, **aligned, runout=0.0, axial_runout=[], load=standing(rotor.load)),
        stator=replace(stator, **aligned, load=standing(stator.load)),
        housing=Housing(),
    )


def tilting(scene: Scene) -> Scene:
    """The scene with a tilt to start from, whatever its own symmetry: its tilts are unknowns, its film is that of the
    whole circle, and it can be asked for tilted states."""
    nudge = RingStart(tilt_x=1e-6)
    return replace(scene, initial=Initial(rotor=nudge, stator=nudge))


def _constant(scene: Scene, value_of: Callable[[PiecewiseLinear], float]) -> Scene:
    def constant(table):
        held = {key: value_of(h) for key, h in vars(table).items() if isinstance(h, PiecewiseLinear)}
        loads = {"load": constant(table.load)} if getattr(table, "load", None) is not None else {}
        return replace(table, **held, **loads)

    return replace(scene, **{name: constant(getattr(scene, name)) for name in VARYING})


# --- the other ring flexible --------------------------------------------------------------------------


def arrangement(scene: Scene) -> str:
    """ "FMR", "FMS" or "FMSR": which rings float."""
    if scene.stator.support and scene.rotor.support:
        return "FMSR"
    return "FMR" if scene.rotor.support else "FMS"


def counterpart(scene: Scene) -> Scene:
    """The same seal with the other ring flexible.

    **Source** Green (1989), who compares the two arrangements of one seal this way.
    Raises SceneError when both rings float: there is no rigid partner to change places with.
    """
    rotor, stator = scene.rotor, scene.stator
    if rotor.support and stator.support:
        raise SceneError("stator.support", "a support under both rings", "one flexible ring, to have a counterpart")
    if rotor.support:
        moved = {name: getattr(rotor, name) for name in CARRIED + FACE}
        new_stator = Stator(**moved, misalignment_direction=rotor.misalignment_phase, speed=stator.speed)
        new_rotor = Rotor(
            runout=stator.misalignment,
            runout_phase=stator.misalignment_direction,
            axial_runout=rotor.axial_runout,
            waviness=stator.waviness,
            grooves=stator.grooves,
            body=stator.body,
        )
    else:
        moved = {name: getattr(stator, name) for name in CARRIED + FACE}
        new_rotor = Rotor(**moved, misalignment_phase=stator.misalignment_direction, axial_runout=rotor.axial_runout)
        new_stator = Stator(misalignment=rotor.runout, misalignment_direction=rotor.runout_phase, speed=stator.speed,
                            waviness=rotor.waviness, grooves=rotor.grooves, body=rotor.body)  # fmt: skip
    film, heat = scene.film, scene.film.heat
    if heat is not None:
        # What cools a ring goes with it.
        film = replace(film, heat=replace(heat, stator=heat.rotor, rotor=heat.stator))
    start = Initial(rotor=scene.initial.stator, stator=scene.initial.rotor)
    return replace(scene, film=film, rotor=new_rotor, stator=new_stator, initial=start)


def with_both_flexible_rings(scene: Scene) -> Scene:
    """The scene as FMSR: itself, or with the ring that floats a second time in place of its rigid partner, mass,
    inertias, support and O-ring; the partner's misalignment or runout is that of the new ring in its springs."""
    present = arrangement(scene)
    if present == "FMSR":
        return scene
    old, new = (scene.rotor, scene.stator) if present == "FMR" else (scene.stator, scene.rotor)
    carried = {name: getattr(old, name) for name in CARRIED if name not in ("misalignment", "load")}
    if present == "FMR":
        return replace(scene, stator=replace(new, **carried))
    own = {"misalignment": new.runout, "misalignment_phase": new.runout_phase, "runout": 0.0, "runout_phase": 0.0}
    return replace(scene, rotor=replace(new, **carried, **own))


def with_single_flexible_ring(scene: Scene, wanted: str) -> Scene:
    """The scene as FMR or FMS (`wanted`): itself, its counterpart, or, of two floating rings, the other held rigid."""
    present = arrangement(scene)
    if present == wanted:
        return scene
    if present != "FMSR":
        return counterpart(scene)
    if wanted == "FMR":
        return with_values(scene, {"stator.support": None})
    return with_values(scene, {"rotor.support": None, "rotor.runout": scene.rotor.misalignment})
