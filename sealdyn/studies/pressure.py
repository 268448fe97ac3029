"""Film pressure over the face at a gap state, with its force, moment, centre of pressure and leakage."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import simpson

from ..dynamics.interface import Interface
from ..faces.contact import contact_load
from ..faces.film_thickness import film_thickness, h_min
from ..faces.geometry import (
    COLLAPSE,
    CONTACT_FORCE,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    INNER_RADIUS,
    MOMENT_X,
    MOMENT_Y,
    OUTER_RADIUS,
    REFUSED,
)
from ..numerics.crossing import crossing
from ..scenario.errors import ScenarioError, nearest_of
from ..scenario.overrides import value_of
from ..scene.gas import density_of
from ..scene.scene import SceneError
from ..scene.variants import frozen_at_start
from ..units import Angle, Quantity, QuantityError, quoted
from .coefficients.matrices import State, gap_state

WITH_WAVES = True
# What `at` may set.
PLACES = {"clearance": Quantity("clearance", "m", '"10 um"', (), 0, True), "tilt": Angle.__metadata__[0]}
# Error of the film's integrals, as a share; share of gauge force or moment by which the sums over a coarse grid err.
EXACT, COARSE = 1e-10, 0.01
# Of the larger edge pressure times the area: a gauge force below has no centre; of force and radius: no moment.
NOTHING = 1e-9

# What is kept of further clearances, beside their profile.
BESIDE = ("clearance", "force", "gauge_force", "centre_of_pressure", "leakage", "mass_flow", "exit_mach")

ALONG = {
    "pressure": ("r", "theta"),
    "profiles": ("pressure/r",),
    "profiles/width_mean": ("pressure/theta",),
    "profiles/mid_radius": ("pressure/theta",),
    "beside": ("clearance", "pressure/r"),
}
units = {
    "beside/clearance": "m",
    "beside/force": "N",
    "beside/gauge_force": "N",
    "beside/leakage": "m^3/s",
    "beside/mass_flow": "kg/s",
    "moment": "N*m",
    "integrated/moment": "N*m",
    "pressure/r": "m",
    "pressure/theta": "rad",
    "pressure/p": "Pa",
    "edges/inner": ["m", "Pa"],
    "edges/outer": ["m", "Pa"],
    "centre_of_pressure": "1",
    "exit_mach": "1",
    "beside/circle_mean": "Pa",
    "profiles/thinnest": "Pa",
    "profiles/thickest": "Pa",
    "profiles/circle_mean": "Pa",
    "profiles/width_mean": "Pa",
    "profiles/mid_radius": "Pa",
}


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fms_reference --at tilt=0.15mrad", 1)


@dataclass(frozen=True)
class Settings:
    """The gap state; nothing moves."""

    at: str | float | tuple[str, ...] = ""
    """"clearance=5 um, tilt=0.1 mrad", either may be left out: clearance at the inner radius of the aligned faces
    (without it the equilibrium), then tilted about the x axis (without it 0)."""
    beside: str | float | tuple[str | float, ...] = ""
    """Further clearances, "5 um, 6 um", whose profiles over the radius are drawn beside, at the same tilt."""


def run(scenario, settings, tools) -> dict:
    """Pressure over the film's own grid, what it sums up to, and profiles over the radius and around the circle; and
    what there is of it at further clearances."""
    place = _place(scenario.name, settings.at)
    answer = _at(scenario, place)
    others = [_at(scenario, {**place, "clearance": c}) for c in _clearances(scenario.name, settings.beside)]
    answer["beside"] = [
        {name: other[name] for name in BESIDE} | {"circle_mean": (other["profiles"] or {}).get("circle_mean")}
        for other in others
    ]
    return answer


def _clearances(name: str, beside) -> list[float]:
    """Clearances (m) of the words `beside`.  Raises ScenarioError that names the scenario `name`."""
    words = ",".join(map(str, beside)) if isinstance(beside, tuple) else str(beside)
    try:
        return [PLACES["clearance"].read(value_of(part)) for part in map(str.strip, words.split(",")) if part]
    except QuantityError as error:
        raise ScenarioError(name, "study.pressure.beside", error.found, error.expected) from None


def _at(scenario, place) -> dict:
    """The answer at one place."""
    scene = frozen_at_start(scenario.scene, clearance=place.get("clearance"))
    try:
        interface, tilt = Interface(scene, EXACT), place.get("tilt", 0.0)
    except SceneError as error:
        key = "study.pressure.at" if "clearance" in place else error.key
        raise ScenarioError(scenario.name, key, error.found, error.expected) from None
    f, s = interface.f, gap_state(interface, State(0.0, complex(tilt)))
    thinnest, angle, radius = h_min(f, s)
    if thinnest <= f[COLLAPSE]:
        raise ScenarioError(scenario.name, "study.pressure.at", *_closed(interface, tilt))
    own = () if interface.unknowns is None else (interface.steady(f, s),)
    interface.film.flow(f, s, *own)
    if not np.all(np.isfinite(s[FORCE : FLOW_OUTER + 1])):
        where = f"a clearance of {interface.clearance:.4g} m and a tilt of {tilt:.4g} rad"
        why = interface.film.STATUS[int(s[REFUSED])] if s[REFUSED] else "force and leakage are no numbers"
        expected = "a clearance of the size of a film's, and a flow through it"
        raise ScenarioError(scenario.name, "study.pressure.at", f"{where}: {why}", expected)
    p_low, area = min(scene.film.inner_pressure, scene.film.outer_pressure), interface.closing.area
    # What leaves on the side of the low pressure.
    leakage = -s[FLOW_INNER] if interface.closing.outer_is_high else s[FLOW_OUTER]
    gauge = float(s[FORCE] - p_low * area)
    answer = {
        "film": interface.name,
        "gas": scene.film.gas is not None,
        "clearance": float(interface.clearance),
        "tilt": float(tilt),
        "h_min": {"value": float(thinnest), "theta": float(angle % (2 * math.pi)), "radius": float(radius)},
        "force": float(s[FORCE]),
        "gauge_force": gauge if abs(gauge) > EXACT * abs(s[FORCE]) else 0.0,
        "contact_force": _contact_force(interface, s),
        "moment": [float(s[MOMENT_X]) + 0.0, float(s[MOMENT_Y]) + 0.0],
        "centre_of_pressure": None,
        # Not a zero with a minus.
        "leakage": float(leakage) + 0.0,
        "mass_flow": float(density_of(scene.film) * leakage) + 0.0,
        "exit_mach": interface.film.exit_mach(f, s)[1] if hasattr(interface.film, "exit_mach") else None,
        "high_pressure": "outer" if interface.closing.outer_is_high else "inner",
        "edges": {side: [float(getattr(scene.film, f"{side}_{what}")) for what in ("radius", "pressure")]
                  for side in ("inner", "outer")},
        "pressure": None,
        "profiles": None,
        "integrated": None,
    }  # fmt: skip
    if any(field.name == "pressure" for field in getattr(interface.film, "FIELDS", ())):
        answer |= _over_face(interface, s, own, answer)
    return answer | {"verdict": _verdict(answer, "" if "clearance" in place else interface.message)}


def _place(name: str, at) -> dict[str, float]:
    """Clearance (m) and tilt (rad) of the words `at`, as far as they are there.  Raises ScenarioError that names the
    scenario `name`."""
    place, example = {}, '"clearance=5 um, tilt=0.1 mrad"'
    words = ",".join(at) if isinstance(at, tuple) else str(at)
    for part in filter(None, (part.strip() for part in words.split(","))):
        key, equals, value = (word.strip() for word in part.partition("="))
        if key not in PLACES:
            hint = nearest_of(key, PLACES)
            raise ScenarioError(name, "study.pressure.at", quoted(key or part), f"{' or '.join(PLACES)}{hint}")
        if key in place or not (equals and value):
            found = f"{key} twice" if key in place else quoted(part)
            raise ScenarioError(name, "study.pressure.at", found, f"each once and with a value, {example}")
        try:
            place[key] = PLACES[key].read(value_of(value))
        except QuantityError as error:
            raise ScenarioError(name, "study.pressure.at", f"{key} = {error.found}", error.expected) from None
    return place


def _closed(interface, tilt: float) -> tuple[str, str]:
    """What was found where the faces leave no film, and what is expected."""
    f, clearance = interface.f, interface.clearance

    def gap(tilt):
        return h_min(f, gap_state(interface, State(0.0, complex(tilt))))[0] - f[COLLAPSE]

    if gap(0.0) <= 0.0:
        return f"faces that meet at a clearance of {1e6 * clearance:.4g} um", "a larger clearance"
    found = f"faces that meet at a clearance of {1e6 * clearance:.4g} um and a tilt of {1e3 * tilt:.4g} mrad"
    # However far beyond the tilt is.
    while gap(0.5 * tilt) <= 0.0:
        tilt *= 0.5
    return found, f"a tilt below {1e3 * abs(crossing(gap, 0.5 * tilt, tilt, 1e-9)):.4g} mrad"


def _contact_force(interface, s) -> float:
    """Force (N) of the asperities that touch at a gap state."""
    if interface.contact is None:
        return 0.0
    rough = s.copy()
    contact_load(interface.contact, interface.f, rough)
    return float(rough[CONTACT_FORCE])


# --- the field ------------------------------------------------------------------------------------------


def _over_face(interface, s, own, answer) -> dict:
    """The field, its profiles and its sums, for an `answer` that has the rest."""
    film, f = interface.film, interface.f
    r, theta = film.grid(f)
    fields = np.empty((len(film.FIELDS), len(r), len(theta)))
    film.fields(f, s, *own, fields)
    p = fields[[field.name for field in film.FIELDS].index("pressure")]
    narrow = getattr(film, "MEAN_CIRCUMFERENCE", False)
    force, moment, centre = sums(r, theta, p, answer["edges"], answer["high_pressure"] == "outer", narrow)
    around = np.array([film_thickness(f, s, 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]), angle) for angle in theta])
    middle = int(np.argmin(np.abs(r - 0.5 * (f[INNER_RADIUS] + f[OUTER_RADIUS]))))
    share = weights(theta) / (2 * np.pi)
    # Over the face, not over the width: an even share of its area for each.
    full, full_p = with_edges(r, p, answer["edges"])
    area = 0.5 * (full[-1] ** 2 - full[0] ** 2)
    return {
        "centre_of_pressure": centre,
        "pressure": {"r": r.tolist(), "theta": theta.tolist(), "p": p.tolist()},
        "profiles": {
            "thinnest": p[:, np.argmin(around)].tolist(),
            "thickest": p[:, np.argmax(around)].tolist(),
            "circle_mean": (p @ share).tolist(),
            "width_mean": (simpson(full_p * full[:, None], x=full, axis=0) / area).tolist(),
            "mid_radius": p[middle].tolist(),
            "at": {"thinnest": float(theta[np.argmin(around)]), "thickest": float(theta[np.argmax(around)]),
                   "mid_radius": float(r[middle])},
        },
        "integrated": {"force": force, "moment": moment},
    }  # fmt: skip


def sums(r, theta, p, edges, outer_is_high: bool, narrow: bool = False):
    """Force (N), moments (N m) on the stator and centre of the gauge pressure (share of the width from the edge of the
    high pressure, None without a gauge force), of pressures `p` (radii, angles) over r dr dtheta.

    Simpson's rule over the radius, from edge to edge; the trapezoid around the circle, which is exact up to the order
    of half the angles.  `edges` {"inner": [radius, pressure], "outer": ...}.  `narrow`: on the mean circumference, at
    whatever radius.
    """
    r, p = with_edges(r, p, edges)
    share = weights(theta)

    def over_face(values):
        return float(simpson(values @ share, x=r))

    arm = r[:, None]
    ring = np.full_like(arm, 0.5 * (r[0] + r[-1])) if narrow else arm
    force = over_face(p * ring)
    moment = [over_face(p * ring * arm * np.sin(theta)), over_face(-p * ring * arm * np.cos(theta))]
    high, low = (r[-1], r[0]) if outer_is_high else (r[0], r[-1])
    pressures = [edge[1] for edge in edges.values()]
    gauge = (p - min(pressures)) * ring
    carried = over_face(gauge)
    if abs(carried) <= NOTHING * max(*pressures, 1.0) * np.pi * (r[-1] ** 2 - r[0] ** 2):
        return force, moment, None
    return force, moment, over_face(gauge * (high - arm) / (high - low)) / carried


def with_edges(r, p, edges):
    """Radii (m) and pressures (radii, angles) with both edges, where a grid of cells ends before them."""
    (inner, p_inner), (outer, p_outer) = edges["inner"], edges["outer"]
    near = 1e-9 * (outer - inner)
    if r[0] - inner > near:
        r, p = np.append(inner, r), np.vstack([np.full(p.shape[1], p_inner), p])
    if outer - r[-1] > near:
        r, p = np.append(r, outer), np.vstack([p, np.full(p.shape[1], p_outer)])
    return r, p


def weights(theta) -> np.ndarray:
    """Angle (rad) that each of the angles of a full circle stands for."""
    around = np.concatenate([[theta[-1] - 2 * np.pi], theta, [theta[0] + 2 * np.pi]])
    return 0.5 * (around[2:] - around[:-2])


# --- in words -------------------------------------------------------------------------------------------


def _verdict(answer, message: str) -> list[str]:
    """Sentences on an answer; `message`: how its clearance was found, "" where it was given."""
    where = f"{'the equilibrium of ' if message else ''}{1e6 * answer['clearance']:.5g} um"
    where += f", tilted by {1e6 * answer['tilt']:.5g} urad" if answer["tilt"] else ", aligned"
    x, y = answer["moment"]
    said = [
        f"At {where} ({answer['film']} film; thinnest {1e6 * answer['h_min']['value']:.4g} um): force "
        f"{answer['force']:.6g} N, {answer['gauge_force']:.5g} N of it above the lower edge pressure; "
        f"{f'moments {x:.4g} and {y:.4g} N m' if _turns(answer) else 'no moment'}; leakage "
        f"{_flow(answer)}, {answer['mass_flow'] * 3600:.4g} kg/h.",
    ]
    if answer["exit_mach"] is not None:
        choked = "choked" if answer["exit_mach"] >= 1.0 else "subsonic"
        said.append(f"The gas leaves at a Mach number of {answer['exit_mach']:.4g} at most: {choked}.")
    if message:
        said.append(f"Clearance: {message}.")
    if answer["contact_force"]:
        said.append(f"Asperities carry {answer['contact_force']:.5g} N besides; the pressure shown is the film's.")
    if answer["pressure"] is None:
        said.append(
            f"The {answer['film']} film has no pressure over the face: it implies a force and a moment that change in "
            "proportion to the motion, and no profile; the radial and the profiled film have one."
        )
        return said
    return [*said, *_of_the_field(answer)]


def _flow(answer) -> str:
    """The leakage as a volume, of a gas at normal conditions."""
    if answer["gas"]:
        return f"{answer['leakage'] * 6e4:.4g} l/min at 0 degC and 1.01325 bar"
    return f"{answer['leakage'] * 3.6e9:.4g} ml/h"


def _of_the_field(answer) -> list[str]:
    p, centre, said = np.array(answer["pressure"]["p"]), answer["centre_of_pressure"], []
    spread = f"Pressure {1e-5 * p.min():.5g} to {1e-5 * p.max():.5g} bar"
    if centre is None:
        said.append(f"{spread}; without a gauge force it has no centre.")
    else:
        edge = answer["high_pressure"]
        said.append(f"{spread}; its centre lies {centre:.4g} of the width from the {edge} edge.")
    if p.min() < -NOTHING * p.max():
        said.append("A liquid hardly bears less than 0: film.cavitation_pressure gives the film a floor.")
    if _is_coarse(answer):
        force, (x, y) = answer["integrated"].values()
        said.append(f"The grid is coarse here: the field sums up to {force:.5g} N and to {x:.4g} and {y:.4g} N m.")
    return said


def _turns(answer) -> bool:
    """Whether there is a moment that is no rounding."""
    return math.hypot(*answer["moment"]) > NOTHING * abs(answer["force"]) * answer["edges"]["outer"][0]


def _is_coarse(answer) -> bool:
    """Whether the sums over the grid are not those of the film."""
    off, shown = abs(answer["integrated"]["force"] - answer["force"]), answer["integrated"]["moment"]
    if off > COARSE * max(abs(answer["gauge_force"]), NOTHING * abs(answer["force"])):
        return True
    return _turns(answer) and math.dist(shown, answer["moment"]) > COARSE * math.hypot(*answer["moment"])


def tables(answer) -> list:
    """What there is of it at every clearance, where there are more than one, and profiles over the radius."""
    found = []
    if answer["beside"]:
        columns = (("clearance, um", "clearance", 1e6), ("force, N", "force"), ("gauge force, N", "gauge_force"),
                   ("centre, share of the width", "centre_of_pressure"), ("mass flow, kg/h", "mass_flow", 3600),
                   ("exit Mach", "exit_mach"))  # fmt: skip
        found = [([answer, *answer["beside"]], columns)]
    if answer["pressure"] is None:
        return found
    profiles, r = answer["profiles"], answer["pressure"]["r"]
    names = ("thinnest", "thickest", "circle_mean")
    rows = [{"r": r[k], **{name: profiles[name][k] for name in names}} for k in range(len(r))]
    columns = (("radius, mm", "r", 1e3), ("p where thinnest, bar", "thinnest", 1e-5),
               ("where thickest", "thickest", 1e-5), ("mean of the circle", "circle_mean", 1e-5))  # fmt: skip
    return [*found, (rows, columns)]
