"""What studies say of a scene with grooves: flows at an equilibrium; stiffness and damping over the frequency, with the
roots of the ring that floats, in the inertial frame."""

import math

import numpy as np

from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.equilibrium import settle
from ..dynamics.interface import opening_law
from ..films._grooved.aligned import AlignedFilm, aligned_film, axial_stiffness
from ..films._grooved.motion import own_tilt, relative_tilt, support_law
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.film import coned
from ..scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, density_of
from ..scene.scene import SceneError, frozen_at_start
from ._grooved_roots import lands, modes, refuse_touching, rings_of, roots_in

ERRORS = ("film_force", "leakage", "torque", "axial_stiffness", "tilt_stiffness")
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


def _leakage(scene, found: AlignedFilm) -> float:
    """Flow from the high to the low pressure, m^3/s; of a gas at normal conditions."""
    film = scene.film
    outwards = found.better(lambda one: one.flows[0])[0]
    if film.gas is not None:
        outwards *= NORMAL_TEMPERATURE / (initially(film.temperature) * NORMAL_PRESSURE)
    return math.copysign(1.0, film.inner_pressure - film.outer_pressure) * outwards


def coefficients_over_grooves(scene, asked) -> Answer:
    """Matrices at rest (the lowest frequency) and at the shaft's, over frequency, and the roots of the ring; over
    speeds the map of a clearance that the closing force decides follows it.  `asked`: values (SI) of the settings
    "frequency", "speed", "coning" and "clearance", each or None."""
    speed = initially(scene.shaft.speed)
    clearance, *_ = settle(scene, opening_law(scene))
    refuse_touching(scene, clearance)
    found = aligned_film(scene, clearance)
    for name in ("coning", "clearance"):
        if asked[name] is not None:
            raise SceneError(f"study.coefficients.{name}", "a value", "nothing over grooves, as yet")
    frequencies = asked["frequency"] or (max(abs(speed), 1.0) * FREQUENCIES).tolist()
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
        "twice": _twice(found, frequencies[0]),
        "modes": modes(scene, found),
        "tracking": tracking(scene, found, clearance),
    }  # fmt: skip
    numbers["mass_flow"] = numbers["leakage"] * density_of(scene.film)
    if any(values is not None for values in asked.values()):
        numbers["map"] = _mapped(scene, asked["speed"] or [speed], frequencies)
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _notes(numbers))


def _matrices(found: AlignedFilm, frequency: float) -> tuple[list, list]:
    """Stiffness and damping (3, 3) at a frequency (rad/s)."""
    k, d = found.of_motion(lambda motion: np.array(motion.matrices(frequency)))[0]
    return k.tolist(), d.tolist()


def _twice(found: AlignedFilm, frequency: float) -> dict | None:
    """What of the tilt's dynamic stiffness 1 and 2 grooves answer at twice the speed of the pattern less the frequency
    (rad/s): its size (N m/rad) of a whirl forward and of one backward; None of more grooves."""
    if not found.motions[1].uneven:
        return None
    sizes = found.of_motion(lambda motion: np.array([motion.beside_impedance(w * 1j) for w in (frequency, -frequency)]))
    forward, backward = np.abs(sizes[0]).tolist()
    return {"frequency": 2.0 * found.frame - frequency, "forward": forward, "backward": backward}


def _errors(found: AlignedFilm, frequency: float) -> dict:
    """By which shares the finer mesh's numbers err, estimated; by the names of ERRORS."""
    pairs = (
        found.better(lambda one: one.force),
        found.better(lambda one: one.flows[0]),
        found.better(lambda one: one.torque),
        found.of_motion(lambda motion: motion.axial_impedance(1j * frequency)),
        found.of_motion(lambda motion: motion.tilt_impedance(1j * frequency)),
    )
    shares = (float(error / abs(value)) if value else 0.0 for value, error in pairs)
    return dict(zip(ERRORS, shares, strict=True))


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


def tracking(scene, found: AlignedFilm, clearance: float) -> dict | None:
    """How a stator that floats follows its rotor, by linear theory: relative misalignment (rad) `by_runout` of the
    rotor, constant on it, `by_misalignment` of the stator, which the rotor passes, of one groove `by_groove`, and what
    one and two make of the first two at another frequency, `at_twice`; the `largest`, the sum of all; thinnest film
    over the lands `h_min` (m), where that is not negative.  None of other arrangements."""
    rings = rings_of(scene)
    if len(rings) != 1 or scene.stator.support is None:
        return None
    (ring,) = rings
    speed = initially(scene.shaft.speed)
    runout, misalignment = initially(scene.rotor.runout), initially(scene.stator.misalignment)

    def parts(motion):
        moments = support_law(ring, 1j * speed) * runout, support_law(ring, 0.0) * misalignment
        answers = [relative_tilt(motion, rings, *given) for given in zip(moments, (speed, 0.0), strict=True)]
        return np.array([*answers, (own_tilt(motion, ring), 0.0)])

    ahead, beside = np.abs(found.of_motion(parts)[0]).T
    (by_runout, by_misalignment, by_groove), beside = ahead.tolist(), float(beside.sum())
    film, largest = coned(scene), by_runout + by_misalignment + by_groove + beside
    rise = initially(film.coning) * (film.outer_radius - film.inner_radius)
    thinnest = clearance + min(-largest * film.inner_radius, rise - largest * film.outer_radius)
    return {"by_runout": by_runout, "by_misalignment": by_misalignment, "by_groove": by_groove, "at_twice": beside,
            "largest": largest, "h_min": thinnest if thinnest > 0.0 else None}  # fmt: skip


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
    if twice := numbers["twice"]:
        notes.append(f"Matrices are means over a turn of the grooves, which also answer a tilt with up to "
                     f"{in_words('tilt_stiffness', max(twice['forward'], twice['backward']))} at twice their speed "
                     "less the tilt's own; roots and tracking have both.")  # fmt: skip
    if numbers["modes"] is None:
        notes.append("A ring without inertia floats: no roots.")
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
        roots = roots_in(numbers["modes"])
        rows = [[name.replace("_", " "), *(root or (None, None))] for name, root in roots.items()]
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
