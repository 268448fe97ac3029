"""A wavy ring that bends: which waviness it has under load, of the one it was made with; and of waves that a drive
bends, which of them, left under load, carry most, and on how stiff a ring.

    net = initial + compliance [ int (p + p_c) r dr ]_n
    initial = | net - c(E J) H(net) |,   of driven waves: c and what the drive makes both go with 1/(E J)

Film and asperities press on the standing ring where the film is thin and so level its waves.  Waves and harmonics are
complex: a cos(n theta) + b sin(n theta) is a + i b.  What the ring was made with follows from what is left at once, the
other way round there may be several answers.  The load H on a wave follows from the waves that are left alone: one
curve of it for each order answers for all rings.
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), eqs. 3-1 to 3-12, ch. 3 and Figs. 3-11 to 3-13:
several operating points, and that one holds where more waviness left would need more to begin with.
**Valid** aligned faces, one order of waves on the ring that stands still, at rest; of driven waves one torsion ratio
for all rings."""

import cmath
import math
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from ..faces.geometry import CLEARANCE, CONTACT_FORCE, CONTACT_TORQUE, FLOW_INNER, FORCE, TORQUE
from ..faces.roughness import contact_fraction
from ..films import film_of
from ..numerics.piecewise_linear import initially
from ..scene.film import aligned_gaps, coned
from ..scene.forces import HALF_HEIGHT
from ..scene.scene import SceneError
from .imposed_motion import rest_state
from .interface import Asked, Interface, flow_at_rest, prepared

# Angles of a wave, and radii, for the asperities.
FINE, RADII = 2048, 16
# How exactly operating points are found.
EXACT = 1e-6
# From a waviness down to the next in looking for the largest that holds, and the least, in initial ones.
STRIDE, LEAST = 0.8, 1e-4


@dataclass(frozen=True)
class OperatingPoint:
    """Waviness under load, `net`, and that of the ring without, `initial` (m); `turned` (rad), by how much the angle
    n theta of the net waves' crests lies beyond that of the initial ones; load support (film over film and asperities),
    `clearance` (m), `leakage` (m^3/s, from high to low pressure) and `friction_coefficient` at the mean radius."""

    net: float
    initial: float
    turned: float
    load_support: float
    clearance: float
    leakage: float
    friction_coefficient: float


def order_of(scene) -> int:
    """Order of the waves of a scene's elastic ring."""
    return int(scene.stator.waviness[0].order)


def unloaded(scene) -> float:
    """Waviness (m) of a scene's ring without load: what it was made with, and what its drive adds."""
    return scene.stator.waviness[0].amplitude + scene.stator.elastic.driven(order_of(scene))


def with_net(scene, net: float, phase: float = 0.0):
    """The scene with a ring that keeps a `net` waviness (m)."""
    waves = [replace(scene.stator.waviness[0], amplitude=net, phase=phase)]
    return replace(scene, stator=replace(scene.stator, elastic=None, waviness=waves))


def with_cells_of(scene, net: float):
    """The scene with the cells that a ring of this `net` waviness (m) needs: the same for all wavinesses."""
    kept = with_net(scene, net)
    return replace(scene, film=prepared(kept, film_of(kept)))


def operating_point(scene, net: float) -> OperatingPoint:
    """Where film and asperities of a scene carry its closing force when its elastic ring has a `net` waviness (m), and
    the waviness that it was made with.  Raises SceneError where nothing carries it."""
    return state(scene, net)[0]


def state(scene, net):
    """The operating point of a net waviness (m), its interface, gap state, unknowns of the film, initial waves
    (complex)."""
    interface = Interface(with_net(scene, net), 1e-8)
    s, _ = rest_state(interface.scene, interface.clearance)
    flow_at_rest(interface, s)
    x = interface.steady(interface.f, s)
    initial = net - scene.stator.elastic.compliance(order_of(scene)) * harmonic(interface, x, complex(net))
    film, carried = scene.film, s[FORCE] + s[CONTACT_FORCE]
    high_inside = initially(film.inner_pressure) > initially(film.outer_pressure)
    arm = 0.5 * (film.inner_radius + film.outer_radius)
    point = OperatingPoint(
        net, abs(initial), -cmath.phase(initial), float(s[FORCE] / carried), interface.clearance,
        float(s[FLOW_INNER]) * (1.0 if high_inside else -1.0),
        float(abs(s[TORQUE] + s[CONTACT_TORQUE]) / (carried * arm)),
    )  # fmt: skip
    return point, interface, s, x, initial


def at_rest(scene):
    """The scene with a ring that keeps the waves which its load leaves: the largest of those that hold, to which a
    lifted ring comes down.  Raises SceneError where there are none.  A scene without elastic ring is its own."""
    return scene if scene.stator.elastic is None else _at_rest(Asked(scene, film_of(scene)))


@lru_cache(maxsize=16)
def _at_rest(asked):
    scene, made, phase = asked.scene, unloaded(asked.scene), asked.scene.stator.waviness[0].phase
    if made == 0.0:
        return with_net(scene, 0.0, phase)
    fixed = with_cells_of(scene, min(made, scene.contact.roughness if scene.contact else math.inf))
    above = net = made / STRIDE
    while net > LEAST * made:
        try:
            enough = operating_point(fixed, net).initial <= made
        except SceneError:
            # Waves higher than any film.
            above = net
            enough = False
        if enough:
            break
        above, net = net, net * STRIDE
    else:
        raise SceneError("stator.elastic", "waves that the load levels altogether", "a stiffer ring, or no waves")
    rest = brentq(lambda h: operating_point(fixed, h).initial - made, net, above, rtol=EXACT)
    # The net crests lie beyond the initial ones, which the phase is counted from.
    return with_net(scene, rest, phase - operating_point(fixed, rest).turned)


def operating_points(scene, along: list[OperatingPoint]) -> list[tuple[OperatingPoint, bool]]:
    """Every operating point of the scene's ring among those `along` which net waviness rises, and whether it holds:
    where more waviness left would need more to begin with."""
    initial, found = unloaded(scene), []
    for before, here in pairwise(along):
        if (before.initial - initial) * (here.initial - initial) <= 0.0 and before.initial != here.initial:
            at = brentq(lambda h: operating_point(scene, h).initial - initial, before.net, here.net, rtol=EXACT)
            found.append((operating_point(scene, at), here.initial > before.initial))
    return found


def harmonic(interface, x, net: complex, clearance=None) -> complex:
    """Harmonic (N, complex) of the load int (p + p_c) r dr on the ring, of the order of its waves; unknowns `x` of the
    film, `net` waves (m, complex) and `clearance` (m; default the seal's) that the asperities meet."""
    faces, film = interface.scene.contact, interface.scene.film
    order, load = order_of(interface.scene), interface.film.line_load(interface.f, x)
    # Angles of one wave, or of all of them.
    step = interface.film.grid(interface.f)[1][1]
    pressed = complex(2.0 * np.mean(load * np.exp(1j * order * step * np.arange(len(load)))))
    if faces is None:
        return pressed
    clearance = interface.f[CLEARANCE] if clearance is None else clearance
    angle, inner, outer = 2.0 * math.pi / FINE * np.arange(FINE), film.inner_radius**2, film.outer_radius**2
    # Radii of equal areas.
    radii = np.sqrt(inner + (outer - inner) * (np.arange(RADII) + 0.5) / RADII)
    height = np.interp(radii, *zip(*aligned_gaps(coned(interface.scene), clearance), strict=True))[:, None]
    touching = contact_fraction((height + (net * np.exp(-1j * angle)).real) / (HALF_HEIGHT * faces.roughness))
    rough = 0.5 * (outer - inner) * faces.compressive_strength
    return pressed + complex(2.0 * rough * np.mean(touching * np.exp(1j * angle)))


READ = ("load_support", "friction_coefficient", "leakage", "clearance")
# Places of a curve between the balances that are computed.
PLACES = 20_001


def joined(compliance: float, rows: list[dict]) -> dict[str, np.ndarray]:
    """Operating points of a ring of one `compliance` (m/N) as dicts, along which `net` waviness rises, joined by cubic
    splines over its logarithm: `net` (m) evenly, READ, and the harmonic of the `load` (N, complex) there."""
    # A run of an elastic ring needs no spline.
    from scipy.interpolate import CubicSpline

    net, initial, turned = (np.array([row[name] for row in rows]) for name in ("net", "initial", "turned"))
    load = (net - initial * np.exp(-1j * turned)) / compliance
    along = np.linspace(*np.log(net[[0, -1]]), PLACES)
    read = {name: [row[name] for row in rows] for name in READ}
    columns = CubicSpline(np.log(net), np.stack([load.real, load.imag, *read.values()], axis=1))(along).T
    return {"net": np.exp(along), "load": columns[0] + 1j * columns[1], **dict(zip(read, columns[2:], strict=True))}


def design(ring, order: int, curve, limit: float | None = None) -> dict:
    """The waviness of most load support on a `ring` among the stable ones that its drive can make (any, without one)
    and that leak at most the `limit` (m^3/s): net, initial and READ (None where there is none), what limits it;
    `drivable`, `fold`, where the smallest waves that hold end, `holds_again` (None where all hold), and the
    `largest_stable` net waviness that the drive can make."""
    net = curve["net"]
    initial = np.abs(net - ring.compliance(order) * curve["load"])
    drivable = ring.driven(order) or None
    rising = np.append(np.diff(initial) > 0.0, True)
    rising[-1] = rising[-2]
    makes = initial <= (np.inf if drivable is None else drivable)
    leaks = curve["leakage"] > (np.inf if limit is None else limit)
    turns = np.flatnonzero(np.diff(rising.astype(int)))
    fold = next((i for i in turns if rising[i]), None)
    again = next((i for i in turns if not rising[i]), None)
    holds = np.flatnonzero(rising & makes)
    good = np.flatnonzero(rising & makes & ~leaks)
    out = {"stiffness": ring.bending_stiffness, "drivable": drivable,
           "fold": None if fold is None else float(net[fold]),
           "holds_again": None if again is None else float(net[again]),
           "largest_stable": float(net[holds[-1]]) if len(holds) else None}  # fmt: skip
    if not len(good):
        return out | dict.fromkeys(("net", "initial", *READ)) | {"limited_by": "drive" if not len(holds) else "leakage"}
    best = good[np.argmax(curve["load_support"][good])]
    following = min(best + 1, len(net) - 1)
    limits = {"range": following == best, "drive": not makes[following], "fold": not rising[following],
              "leakage": leaks[following]}  # fmt: skip
    limited_by = next((name for name, there in limits.items() if there), "nothing")
    return out | {"net": float(net[best]), "initial": float(initial[best]), "limited_by": limited_by,
                  **{name: float(curve[name][best]) for name in READ}}  # fmt: skip


def stiffest(ring, order: int, curve, limit: float | None) -> dict:
    """The waviness of most load support that leaks at most the `limit` (m^3/s) on any ring, and the bending stiffness
    (N m^2) of the `stiffest` ring that the drive of `ring` can still bend there: |E J net - c load| = d.  None where
    there is none, or no drive."""
    allowed = np.flatnonzero(curve["leakage"] <= (np.inf if limit is None else limit))
    if not len(allowed):
        return {"stiffest": None, "net": None, "load_support": None}
    best = allowed[np.argmax(curve["load_support"][allowed])]
    net, load = curve["net"][best], curve["load"][best]
    pushed = ring.bending_stiffness * ring.compliance(order) * load
    drive = ring.bending_stiffness * ring.driven(order)
    roots = np.roots([net**2, -2.0 * net * pushed.real, abs(pushed) ** 2 - drive**2])
    real = [root.real for root in roots if root.imag == 0.0 and root.real > 0.0]
    return {"stiffest": float(max(real)) if real and drive else None, "net": float(net),
            "load_support": float(curve["load_support"][best])}  # fmt: skip
