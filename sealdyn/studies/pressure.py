"""Film pressure over the face at a gap state, with its force, moment, centre of pressure and leakage."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import simpson

from ..analysis.film_matrices import State, gap_state
from ..answers import Answer, Axis, Level, Panel, Series, Table
from ..dynamics.interface import Interface
from ..dynamics.warm_state import at_work
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
from ..numerics.piecewise_linear import crossing
from ..quantities import in_words, number, resolved, shown_in
from ..scenario.errors import ScenarioError, nearest_of
from ..scenario.overrides import value_of
from ..scene.fluid import density_of
from ..scene.scene import SceneError, frozen_at_start, tilting
from ..units import Angle, Quantity, QuantityError, quoted
from . import Info

INFO = Info(
    timed=("fms_reference --at tilt=0.15mrad", 1),
    asks="How is the film pressure spread over the face?",
    wavy=True,
    units={
        "moment": "N*m", "integrated/moment": "N*m", "edges/inner": ["m", "Pa"], "edges/outer": ["m", "Pa"],
        "centre_of_pressure": "1", "exit_mach": "1", "pressure/r": "m", "pressure/theta": "rad", "pressure/p": "Pa",
        "beside/clearance": "m", "beside/force": "N", "beside/gauge_force": "N", "beside/leakage": "m^3/s",
        "beside/mass_flow": "kg/s", "beside/circle_mean": "Pa",
        **{f"profiles/{name}": "Pa" for name in ("thinnest", "thickest", "circle_mean", "width_mean", "mid_radius")},
    },
    along={
        "pressure": ("r", "theta"),
        "profiles": ("pressure/r",),
        "profiles/width_mean": ("pressure/theta",),
        "profiles/mid_radius": ("pressure/theta",),
        "beside": ("clearance", "pressure/r"),
    },
)  # fmt: skip
# What `at` may set.
PLACES = {"clearance": Quantity("clearance", "m", '"10 um"', (), 0, True), "tilt": Angle.__metadata__[0]}
# Error of the film's integrals, as a share; share of gauge force or moment by which the sums over a coarse grid err.
EXACT, COARSE = 1e-10, 0.01
# Of the larger edge pressure times the area: a gauge force below has no centre; of force and radius: no moment.
NOTHING = 1e-9
# Of the largest pressure: a field that differs by less around the circle is that of aligned faces.
EVEN = 1e-9
# What is kept of further clearances, beside their profile.
BESIDE = ("clearance", "force", "gauge_force", "centre_of_pressure", "leakage", "mass_flow", "exit_mach")


@dataclass(frozen=True)
class Settings:
    """The gap state; nothing moves."""

    at: str | float | tuple[str, ...] = ""
    """"clearance=5 um, tilt=0.1 mrad", either may be left out: clearance at the inner radius of the aligned faces
    (without it the equilibrium), then tilted about the x axis (without it 0)."""
    beside: str | float | tuple[str | float, ...] = ""
    """Further clearances, "5 um, 6 um", whose profiles over the radius are drawn beside, at the same tilt."""


def run(scenario, settings, tools) -> Answer:
    """Pressure over the film's own grid, what it sums up to, and profiles over the radius and around the circle; and
    what there is of it at further clearances."""
    place = _place(scenario.name, settings.at)
    numbers, message = _at(scenario, place)
    others = [_at(scenario, {**place, "clearance": c})[0] for c in _clearances(scenario.name, settings.beside)]
    numbers["beside"] = [
        {name: other[name] for name in BESIDE} | {"circle_mean": (other["profiles"] or {}).get("circle_mean")}
        for other in others
    ]
    notes = [f"Clearance: {message}."] if message else []
    return Answer(numbers, _found(numbers), _tables(numbers, others), _panels(numbers), notes + _limits(numbers))


def _clearances(name: str, beside) -> list[float]:
    """Clearances (m) of the words `beside`.  Raises ScenarioError that names the scenario `name`."""
    words = ",".join(map(str, beside)) if isinstance(beside, tuple) else str(beside)
    try:
        return [PLACES["clearance"].read(value_of(part)) for part in map(str.strip, words.split(",")) if part]
    except QuantityError as error:
        raise ScenarioError(name, "study.pressure.beside", error.found, error.expected) from None


def _at(scenario, place) -> tuple[dict, str]:
    """The answer at one place, and how its clearance was found, "" where it was given."""
    tilt = place.get("tilt", 0.0)
    try:
        scene = frozen_at_start(at_work(scenario.scene)[0], clearance=place.get("clearance"))
        interface = Interface(tilting(scene) if tilt else scene, EXACT)
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
        why = interface.film.status[int(s[REFUSED])] if s[REFUSED] else "force and leakage are no numbers"
        expected = "a clearance of the size of a film's, and a flow through it"
        raise ScenarioError(scenario.name, "study.pressure.at", f"{where}: {why}", expected)
    p_low, area = min(scene.film.inner_pressure, scene.film.outer_pressure), interface.closing.area
    # What leaves on the side of the low pressure.
    leakage = -s[FLOW_INNER] if interface.closing.outer_is_high else s[FLOW_OUTER]
    gauge = float(s[FORCE] - p_low * area)
    numbers = {
        "film": interface.name,
        "gas": scene.film.gas is not None,
        "clearance": float(interface.clearance),
        "tilt": float(tilt),
        "h_min": {"value": float(thinnest), "theta": float(angle % (2 * math.pi)), "radius": float(radius)},
        "force": float(s[FORCE]),
        "gauge_force": resolved(gauge, EXACT * abs(s[FORCE])),
        "contact_force": _contact_force(interface, s),
        "moment": [float(s[MOMENT_X]) + 0.0, float(s[MOMENT_Y]) + 0.0],
        "centre_of_pressure": None,
        # Not a zero with a minus.
        "leakage": float(leakage) + 0.0,
        "mass_flow": float(density_of(scene.film) * leakage) + 0.0,
        "exit_mach": interface.film.exit_mach(f, s)[1] if interface.film.exit_mach is not None else None,
        "high_pressure": "outer" if interface.closing.outer_is_high else "inner",
        "edges": {"inner": [float(scene.film.inner_radius), float(scene.film.inner_pressure)],
                  "outer": [float(scene.film.outer_radius), float(scene.film.outer_pressure)]},
        "pressure": None,
        "profiles": None,
        "integrated": None,
    }  # fmt: skip
    if any(field.name == "pressure" for field in interface.film.quantities):
        numbers |= _over_face(interface, s, own, numbers)
    return numbers, "" if "clearance" in place else interface.message


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
        return f"faces that meet at a clearance of {in_words('clearance', clearance)}", "a larger clearance"
    found = f"faces that meet at a clearance of {in_words('clearance', clearance)} and a tilt of "
    found += in_words("tilt", tilt)
    # However far beyond the tilt is.
    while gap(0.5 * tilt) <= 0.0:
        tilt *= 0.5
    return found, f"a tilt below {in_words('tilt', abs(crossing(gap, 0.5 * tilt, tilt, 1e-9)))}"


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
    fields = np.empty((len(film.quantities), len(r), len(theta)))
    film.fields(f, s, *own, fields)
    p = fields[[field.name for field in film.quantities].index("pressure")]
    narrow = film.mean_circumference is not None and film.mean_circumference(f)
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


# --- what is shown --------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """What the film carries, and where."""
    where = f"At {in_words('clearance', numbers['clearance'], digits=5)}, "
    where += f"tilted by {in_words('tilt', numbers['tilt'], digits=5)}" if numbers["tilt"] else "aligned"
    found = f"{where}, the {numbers['film']} film carries {in_words('force', numbers['force'], digits=6)}"
    if numbers["pressure"] is None:
        return f"{found}."
    low, high = (end(map(end, numbers["pressure"]["p"])) for end in (min, max))
    ends = number(low, shown_in("pressure")[1]), in_words("pressure", high)
    centre = numbers["centre_of_pressure"]
    at = "" if centre is None else f", its centre {centre:.4g} of the width from the {numbers['high_pressure']} edge"
    return f"{found} at {ends[0]} to {ends[1]}{at}."


def _limits(numbers) -> list[str]:
    """What the numbers do not tell of their own validity."""
    said = []
    if numbers["contact_force"]:
        said.append("Asperities carry their force besides; the pressure shown is the film's.")
    if numbers["pressure"] is None:
        said.append(
            f"The {numbers['film']} film has no pressure over the face: it implies a force and a moment that change in "
            "proportion to the motion, and no profile; the radial and the profiled film have one."
        )
        return said
    p = np.array(numbers["pressure"]["p"])
    if p.min() < -NOTHING * p.max():
        said.append("A liquid hardly bears less than 0: film.cavitation_pressure gives the film a floor.")
    if _is_coarse(numbers):
        force, (x, y) = numbers["integrated"].values()
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


def _tables(numbers, others) -> list[Table]:
    """What there is at every clearance, and profiles over the radius."""
    flow = "leakage (0 degC, 1.01325 bar)" if numbers["gas"] else "leakage"
    columns = [
        ("clearance", "clearance"), ("tilt", "tilt"), ("h_min", "thinnest film"), ("force", "force"),
        ("force", "above the lower edge pressure"), ("force", "asperities"), ("moment", "moment x"), ("moment", "y"),
        ("leakage", flow), ("mass_flow", "mass flow"), ("1", "exit Mach"), ("share", "centre, of the width"),
    ]  # fmt: skip
    rows = [
        [row["clearance"], row["tilt"] or None, row["h_min"]["value"], row["force"], row["gauge_force"],
         row["contact_force"] or None, *(row["moment"] if _turns(row) else (None, None)), row["leakage"],
         row["mass_flow"], row["exit_mach"], row["centre_of_pressure"]]
        for row in [numbers, *others]
    ]  # fmt: skip
    found = [Table("state", columns, rows)]
    if numbers["pressure"] is None:
        return found
    profiles = numbers["profiles"]
    columns = [("radius", "radius"), ("pressure", "p where thinnest"), ("pressure", "where thickest"),
               ("pressure", "mean of the circle")]  # fmt: skip
    names = ("thinnest", "thickest", "circle_mean")
    if not _is_uneven(numbers):
        columns, names = [columns[0], columns[-1]], ("circle_mean",)
    rows = zip(numbers["pressure"]["r"], *(profiles[name] for name in names), strict=True)
    return [*found, Table("over the radius", columns, [list(row) for row in rows])]


def _is_uneven(numbers) -> bool:
    """Whether the pressure differs around the circle."""
    p = np.array(numbers["pressure"]["p"])
    return bool(np.ptp(p, axis=1).max() > EVEN * np.abs(p).max())


def _panels(numbers) -> list[Panel]:
    """The face; profiles over radius and, where they differ, around the circle."""
    if numbers["pressure"] is None:
        return [Panel("Over the face", note=f"The {numbers['film']} film shows no pressure over the face.")]
    field, profiles, low = numbers["pressure"], numbers["profiles"], numbers["h_min"]
    # The circle closes.
    around = [*field["theta"], field["theta"][0] + 2 * math.pi]
    face = [Series("map", around, field["r"], [[*row, row[0]] for row in field["p"]])]
    edges = [numbers["edges"][side][0] for side in ("inner", "outer")]
    uneven = _is_uneven(numbers)
    # Pads in a face that is otherwise even leave it no one thinnest place.
    placed = uneven and profiles["at"]["thinnest"] != profiles["at"]["thickest"]
    if placed:
        face.append(Series("marks", [low["theta"]], [low["radius"]], label="thinnest film",
                           style="contact circle open large front"))  # fmt: skip
    panels = [Panel("Over the face", Axis("angle"), Axis("radius", low=edges[0], high=edges[1]), face, polar=True,
                    colour=Axis("pressure", "film pressure"), wide=0.85)]  # fmt: skip
    panels.append(_over_radius(numbers, edges, placed))
    if uneven:
        middle = in_words("radius", profiles["at"]["mid_radius"])
        curves = [("width_mean", "mean of the face's width", "film thick"),
                  ("mid_radius", f"at r = {middle}", "black dashed")]  # fmt: skip
        series = [Series("line", around, [*profiles[name], profiles[name][0]], label=label, style=style)
                  for name, label, style in curves]  # fmt: skip
        levels = [Level(low["theta"], "thinnest film", upright=True, style="contact dotted", legend=True)]
        panels.append(Panel("Around the circle", Axis("angle", "angle from the x axis", low=around[0], high=around[-1]),
                            Axis("pressure", "film pressure"), series, levels if placed else [],
                            below=True))  # fmt: skip
    return panels


def _over_radius(numbers, edges, placed: bool) -> Panel:
    """Pressure from edge to edge, at this clearance and at the further ones."""
    field, profiles, beside, series = numbers["pressure"], numbers["profiles"], numbers["beside"], []
    if placed and not beside:
        for name, style in (("thinnest", "contact"), ("thickest", "good dashed")):
            label = f"where {name}, {in_words('angle', profiles['at'][name])}"
            series.append(Series("line", field["r"], profiles[name], label=label, style=style))
    label = f"at {in_words('clearance', numbers['clearance'])}, mean of the circle" if beside else "mean of the circle"
    series.append(Series("line", field["r"], profiles["circle_mean"], label=label, style="film thick"))
    for other in beside:
        label = f"at {in_words('clearance', other['clearance'])}"
        series.append(Series("line", field["r"], other["circle_mean"], label=label))
    centre, levels = numbers["centre_of_pressure"], []
    if centre is not None and 0 <= centre <= 1:
        high, low = edges[::-1] if numbers["high_pressure"] == "outer" else edges
        place = high + centre * (low - high)
        levels = [Level(place, "centre of gauge pressure", upright=True, style="grey dotted", legend=True)]
    return Panel("Over the radius", Axis("radius", low=edges[0], high=edges[1]), Axis("pressure", "film pressure"),
                 series, levels)  # fmt: skip
