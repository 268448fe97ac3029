"""What studies say of a scene with grooves: flows at an equilibrium; stiffness and damping over the frequency, with the
roots of the ring that floats, in the inertial frame."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.equilibrium import settle
from ..dynamics.interface import opening_law
from ..faces.contact import contact_load_and_friction, lay_surfaces
from ..faces.geometry import CONTACT_FORCE, CONTACT_TORQUE, DZ, GAP_STATE_SIZE, SPIN_DIFFERENCE, WEAR, face_parameters
from ..films._grooved.aligned import MANY, AlignedFilm, aligned_film, axial_stiffness
from ..films._grooved.motion import (
    Motion,
    Ring,
    axial_law,
    misalignment_answer,
    root_near,
    runout_answer,
    tilt_law,
    unstable_roots,
)
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scenario.settings import values_in_si
from ..scene.contact import touch_height
from ..scene.film import aligned_gaps, coned
from ..scene.gas import NORMAL_PRESSURE, NORMAL_TEMPERATURE, density_of
from ..scene.scene import Closing, Scene, SceneError
from ..scene.variants import frozen_at_start, refuse_uneven

ERRORS = ("film_force", "leakage", "torque", "axial_stiffness", "tilt_stiffness")
# Speeds between two of which one has more roots that grow.
CLOSER = 5
# Relative change of a frequency that is near enough to begin from.
NEXT_TO = 1e-2
MOTIONS = ("axial", "tilt_forward", "tilt_backward")
# Step of a difference of the asperities' load, in roughnesses.
NEAR = 1e-4
# Frequencies without any asked, in shaft speeds.
FREQUENCIES = np.concatenate([[0.01], np.linspace(0.5, 30.0, 60)])


def flows_over_grooves(scene, clearance: float, carried: float) -> dict:
    """What flows and rubs at a clearance (m) at which the faces carry `carried` (N) beyond the lower pressure, by the
    names of a root of the study equilibrium; also the `torque` (N m) of the shaft, and the stiffness, the film's on
    finer meshes than those of the curve."""
    found, film = aligned_film(scene, clearance), scene.film
    leakage, rubbed, held, wear = _leakage(scene, found), *lands(scene, clearance)
    torque, arm = found.better(lambda one: one.torque)[0] + rubbed, 0.5 * (film.inner_radius + film.outer_radius)
    return {"friction_coefficient": abs(torque) / (carried * arm) if carried > 0.0 else None,
            "mass_flow": leakage * density_of(film), "leakage": leakage, "cavitated_fraction": found.fine.cavitated,
            "torque": torque, "stiffness": found.better(axial_stiffness)[0] + held, **wear}  # fmt: skip


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


def _leakage(scene, found: AlignedFilm) -> float:
    """Flow from the high to the low pressure, m^3/s; of a gas at normal conditions."""
    film = scene.film
    outwards = found.better(lambda one: one.flows[0])[0]
    if film.gas is not None:
        outwards *= NORMAL_TEMPERATURE / (initially(film.temperature) * NORMAL_PRESSURE)
    return math.copysign(1.0, film.inner_pressure - film.outer_pressure) * outwards


def coefficients_over_grooves(scenario, scene, settings) -> Answer:
    """Matrices at rest (the lowest frequency) and at the shaft's, over frequency, and the roots of the ring; over
    speeds the map of a clearance that the closing force decides follows it."""
    speed = initially(scene.shaft.speed)
    clearance, *_ = settle(scene, opening_law(scene))
    refuse_touching(scene, clearance)
    found = aligned_film(scene, clearance)
    given = {
        name: None if words is None else values_in_si(scenario, str(words), "rad/s", f"--{name}")
        for name, words in (("frequency", settings.frequency), ("speed", settings.speed))
    }
    if settings.coning is not None:
        raise SceneError("study.coefficients.coning", "a value", "nothing over grooves, as yet")
    frequencies = given["frequency"] or (max(abs(speed), 1.0) * FREQUENCIES).tolist()
    if min(frequencies) <= 0.0:
        expected = "frequencies above 0: a film over grooves has no one damping at rest"
        raise SceneError("study.coefficients.frequency", f"{min(frequencies):g} rad/s", expected)
    rows = [_matrices(found, w) for w in frequencies]
    numbers = {
        "film": "gas_reynolds" if scene.film.gas is not None else "reynolds",
        "stiffness": rows[0][0], "damping": rows[0][1],
        "at": {"clearance": clearance, "speed": speed, "frequency": frequencies[0]},
        "against_frequency": {"frequency": frequencies, "stiffness": [k for k, _ in rows],
                              "damping": [d for _, d in rows], "failed": [None] * len(rows)},
        "leakage": _leakage(scene, found),
        "torque": found.better(lambda one: one.torque)[0],
        "film_force": found.better(lambda one: one.force)[0],
        "error": _errors(found, frequencies[0]),
        "least_pressure": found.least_pressure,
        "pumping": found.pumping,
        "modes": modes(scene, found),
        "tracking": tracking(scene, found, clearance),
    }  # fmt: skip
    numbers["mass_flow"] = numbers["leakage"] * density_of(scene.film)
    if any(values is not None for values in given.values()):
        numbers["map"] = _mapped(scene, given["speed"] or [speed], frequencies)
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers))


def _matrices(found: AlignedFilm, frequency: float) -> tuple[list, list]:
    """Stiffness and damping (3, 3) at a frequency (rad/s)."""
    k, d = found.of_motion(lambda motion: np.array(motion.matrices(frequency)))[0]
    return k.tolist(), d.tolist()


def _errors(found: AlignedFilm, frequency: float) -> dict:
    """By which shares the finer mesh's numbers err, estimated; by the names of ERRORS."""
    pairs = (
        found.better(lambda one: one.force),
        found.better(lambda one: one.flows[0]),
        found.better(lambda one: one.torque),
        found.of_motion(lambda motion: motion.axial_impedance(1j * frequency)),
        found.of_motion(lambda motion: motion.tilt_impedance(1j * frequency)),
    )
    return {
        name: float(error / abs(value)) if value else 0.0 for name, (value, error) in zip(ERRORS, pairs, strict=True)
    }


def _mapped(scene, speeds, frequencies) -> dict:
    """The map of the study coefficients, in the inertial frame."""
    answer = {"speed": list(speeds), "frequency": list(frequencies), "frame": "inertial", "clearance": [],
              "stiffness": [], "damping": [], "failed": []}  # fmt: skip
    nothing = [[None] * 3] * 3
    for speed in speeds:
        try:
            other = frozen_at_start(scene, speed=float(speed))
            clearance, *_ = settle(other, opening_law(other))
            found = aligned_film(other, clearance)
            rows = [_matrices(found, w) for w in frequencies]
        except SceneError as error:
            clearance, rows = None, [(nothing, nothing)] * len(frequencies)
            answer["failed"].append({"reason": str(error), "points": [{"speed": float(speed), "coning": None}]})
        answer["clearance"].append([clearance] * len(frequencies))
        answer["stiffness"].append([k for k, _ in rows])
        answer["damping"].append([d for _, d in rows])
    return answer


# --- the ring ------------------------------------------------------------------------------------------


def ring_of(scene) -> Ring | None:
    """The ring that floats, None where both do, or where it has no inertia."""
    refuse_uneven(scene)
    floating = [name for name in ("stator", "rotor") if getattr(scene, name).support is not None]
    if len(floating) != 1:
        return None
    ring = getattr(scene, floating[0])
    spin = initially(scene.stator.speed) if floating[0] == "stator" else initially(scene.shaft.speed)
    if not (ring.mass > 0.0 and ring.transverse_inertia > 0.0):
        return None
    support, (stiffness, damping) = ring.support, ring.support.tilt()
    return Ring(ring.mass, ring.transverse_inertia, support.axial_stiffness, support.axial_damping, stiffness, damping,
                ring.polar_inertia, spin)  # fmt: skip


def modes(scene, found: AlignedFilm) -> dict | None:
    """Roots (1/s) of the ring on film and support in the inertial frame, [real, imaginary]: axial, tilt forward and
    backward, those next to the motion without damping, None of a whirl that there is not; and how many roots of each
    motion grow, counted.  None where two rings float, or one without inertia."""
    ring = ring_of(scene)
    if ring is None:
        return None
    answer = {}
    for name, law, inertia, whirl in (
        ("axial", axial_law, ring.mass, 1.0), ("tilt_forward", tilt_law, ring.transverse_inertia, 1.0),
        ("tilt_backward", tilt_law, ring.transverse_inertia, -1.0),
    ):  # fmt: skip
        try:
            root = found.of_motion(
                lambda motion, law=law, inertia=inertia, whirl=whirl: _root(law(motion, ring), inertia, whirl)
            )[0]
            # Without a whirl that way, overdamped, it is another's.
            answer[name] = [root.real, root.imag] if name == "axial" or root.imag * whirl > 0.0 else None
        except ArithmeticError:
            answer[name] = None
    fine: Motion = found.motions[1]
    for name, law, inertia in (("axial", axial_law, ring.mass), ("tilt", tilt_law, ring.transverse_inertia)):
        answer[f"unstable_{name}"] = unstable_roots(law(fine, ring), inertia)
    answer["stable"] = not (answer["unstable_axial"] or answer["unstable_tilt"])
    return answer


def _root(law, inertia: float, whirl: float) -> complex:
    """The root (1/s) next to the motion of the ring without damping."""
    w = 1.0
    for _ in range(30):
        # law + inertia w^2 is the stiffness that the motion meets.
        stiffness = (law(1j * whirl * w) + inertia * w * w).real
        before, w = w, math.sqrt(max(stiffness, 1e-3 * abs(stiffness)) / inertia)
        if abs(w - before) < NEXT_TO * w:
            break
    return root_near(law, complex(0.0, whirl * w))


@dataclass(frozen=True)
class RootsOverSpeed:
    """Roots (1/s) of the ring of a scene at shaft speeds, under the closing force that it has at its own one."""

    scene: Scene

    def __post_init__(self):
        if ring_of(self.scene) is None:
            raise SceneError("rotor.support", "two rings that float over grooves, or one without inertia", "one ring")

    @cached_property
    def free(self) -> Scene:
        """The scene whose closing force is given and whose clearance follows."""
        law = settle(self.scene, opening_law(self.scene))[1]
        closing = Closing(balance_ratio=law.balance_ratio, spring_force=law.spring)
        return replace(self.scene, closing=closing, film=replace(self.scene.film, clearance=None))

    def __call__(self, speed: float) -> dict:
        """`clearance` (m), roots [real, imaginary] by the names of MOTIONS, None of one that there is not, and how many
        roots of film and ring are `growing`, counted."""
        turned = frozen_at_start(self.free, speed=speed)
        clearance = settle(turned, opening_law(turned))[0]
        refuse_touching(turned, clearance)
        found = modes(turned, aligned_film(turned, clearance, MANY))
        growing = found["unstable_axial"] + found["unstable_tilt"]
        return {"clearance": clearance, "growing": growing, **{name: found[name] for name in MOTIONS}}


def roots_over_speed(scene, speeds, tools) -> tuple[list[dict], dict, list[str]]:
    """Rows of RootsOverSpeed that have a film, with their `speed` (rad/s); roots (complex, a row each) of the motions
    that are whirls or oscillations of their own at all of these; and what is to be said of the others."""
    roots = RootsOverSpeed(scene)
    # Once, not in each process.
    _ = roots.free
    held = _rows(roots, speeds, tools, "roots")
    # Closer where roots begin to grow or cease to.
    between = [np.linspace(a["speed"], b["speed"], CLOSER + 2)[1:-1] for a, b in pairwise(held)
               if a["growing"] != b["growing"]]  # fmt: skip
    if between:
        held = sorted([*held, *_rows(roots, np.concatenate(between), tools, "closer")], key=lambda row: row["speed"])
    if not held:
        raise SceneError(
            "shaft.speed", f"no film over grooves from {speeds[0]:g} to {speeds[-1]:g} rad/s", "other speeds"
        )
    known = {name: [row[name] for row in held] for name in MOTIONS}
    notes = []
    lost = [name.replace("_", " ") for name, values in known.items() if None in values]
    if lost:
        notes.append(f"Not an oscillation of its own at all speeds, and left out: {', '.join(lost)}.")
    growing = [row["speed"] for row in held if row["growing"]]
    if growing:
        notes.append(f"Roots that grow, counted around the right half plane, at {len(growing)} of {len(held)} speeds, "
                     f"the lowest {in_words('speed', growing[0])}.")  # fmt: skip
    return held, {name: np.array(values) @ [1.0, 1j] for name, values in known.items() if None not in values}, notes


def _rows(roots, speeds, tools, words: str) -> list[dict]:
    """Rows of the speeds (rad/s) that have a film, with them."""
    found = tools.map(roots, [float(w) for w in speeds], words)
    return [{"speed": float(w), **row} for w, row in zip(speeds, found, strict=True) if "failed" not in row]


def tracking(scene, found: AlignedFilm, clearance: float) -> dict | None:
    """How a stator that floats follows its rotor, by linear theory: relative misalignment (rad) `by_runout` of the
    rotor, constant on it, `by_misalignment` of the stator, which the rotor passes, and the `largest`, their sum;
    thinnest film over the lands `h_min` (m), where that is not negative.  None of other arrangements."""
    ring = ring_of(scene)
    if ring is None or scene.stator.support is None:
        return None
    speed = initially(scene.shaft.speed)
    runout, misalignment = initially(scene.rotor.runout), initially(scene.stator.misalignment)

    def parts(motion):
        return np.array([
            runout_answer(motion, ring, runout, speed) - runout, misalignment_answer(motion, ring, misalignment),
        ])  # fmt: skip

    by_runout, by_misalignment = np.abs(found.of_motion(parts)[0]).tolist()
    film, largest = coned(scene), by_runout + by_misalignment
    wide = film.outer_radius - film.inner_radius
    thinnest = clearance + min(
        -largest * film.inner_radius, initially(film.coning) * wide - largest * film.outer_radius
    )
    return {"by_runout": by_runout, "by_misalignment": by_misalignment, "largest": largest,
            "h_min": thinnest if thinnest > 0.0 else None}  # fmt: skip


# --- what is shown -------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """Stiffness at rest, and whether the ring whirls."""
    k, at, ring = numbers["stiffness"], numbers["at"], numbers["modes"]
    said = (
        f"Aligned at {in_words('clearance', at['clearance'])} the film over grooves has "
        f"{in_words('axial_stiffness', k[0][0])} axially and {in_words('tilt_stiffness', k[1][1])} in tilt"
    )
    if ring is None:
        return f"{said}."
    said = f"{said}; the ring on it {'is stable' if ring['stable'] else 'whirls or hammers by itself'}"
    follows = numbers["tracking"]
    if not (ring["stable"] and follows and follows["largest"]):
        return f"{said}."
    low = f"thinnest film {in_words('h_min', follows['h_min'])}" if follows["h_min"] else "which closes the film"
    return f"{said} and follows with a relative misalignment up to {in_words('tilt', follows['largest'])}, {low}."


def _notes(numbers) -> list[str]:
    """The error, the pumping, negative damping."""
    worst = max(numbers["error"].values())
    notes = [f"Extrapolated over two meshes, the finer of which errs by {in_words('share', worst, digits=2)} at most."]
    if numbers["pumping"]:
        notes.append(f"The grooves pump {numbers['pumping']}.")
    swept = numbers["against_frequency"]
    for name, k in (("axial", 0), ("tilt", 1)):
        negative = [w for w, d in zip(swept["frequency"], swept["damping"], strict=True) if d[k][k] < 0.0]
        if negative:
            ends = " to ".join(in_words("frequency", w) for w in (negative[0], negative[-1]))
            notes.append(f"The film's {name} damping is negative at {len(negative)} of {len(swept['frequency'])} "
                         f"frequencies, {ends}: grooves store gas.")  # fmt: skip
    if numbers["modes"] is None:
        notes.append("Two rings float, or one without inertia: no roots.")
    return notes


def _tables(numbers) -> list[Table]:
    """The film, its matrices over frequency, and the roots of the ring."""
    columns = [("clearance", "clearance"), ("force", "film force"), ("leakage", "leakage"), ("torque", "torque"),
               ("pressure", "least pressure")]  # fmt: skip
    row = [numbers["at"]["clearance"], *(numbers[n] for n in ("film_force", "leakage", "torque", "least_pressure"))]
    found = [Table("film", columns, [row])]
    swept = numbers["against_frequency"]
    columns = [("frequency", "frequency"), ("axial_stiffness", "axial k"), ("axial_damping", "d"),
               ("tilt_stiffness", "tilt k"), ("tilt_stiffness", "cross k"), ("tilt_damping", "d")]  # fmt: skip
    rows = [[w, k[0][0], d[0][0], k[1][1], k[1][2], d[1][1]]
            for w, k, d in zip(swept["frequency"], swept["stiffness"], swept["damping"], strict=True)]  # fmt: skip
    found.append(Table("matrices", columns, rows))
    if numbers["modes"] is not None:
        roots = [(name, numbers["modes"][name]) for name in ("axial", "tilt_forward", "tilt_backward")]
        rows = [[name.replace("_", " "), *(root or (None, None))] for name, root in roots]
        found.append(Table("roots", [("1", "motion"), ("1/s", "growth rate"), ("frequency", "whirl")], rows))
    return found


def _panels(numbers) -> list[Panel]:
    """Stiffness and damping over the frequency."""
    swept = numbers["against_frequency"]
    x, panels = swept["frequency"], []
    for matrix, quantities in (("stiffness", ("axial_stiffness", "tilt_stiffness")),
                               ("damping", ("axial_damping", "tilt_damping"))):  # fmt: skip
        for k, quantity in enumerate(quantities):
            lines = [Series("line", x, [m[k][k] for m in swept[matrix]], label="direct" if k else "", style="film")]
            if k:
                lines.append(Series("line", x, [m[1][2] for m in swept[matrix]], label="cross", style="bad"))
            title = f"{'Tilt' if k else 'Axial'} {matrix}"
            panels.append(Panel(title, Axis("frequency", "frequency of the motion"), Axis(quantity), lines,
                                [Level(0.0, style="black")]))  # fmt: skip
    return panels
