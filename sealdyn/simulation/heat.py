"""What heat does to a seal, in numbers: the warm state of a scene as `run`, `check` and `equilibrium` have it."""

import math

import numpy as np

from ..answers import columns
from ..dynamics.run_state import Caution, Concern
from ..dynamics.warm_course import breaks, followed
from ..dynamics.warm_state import Warming, WarmState, warming
from ..numerics.piecewise_linear import initially
from ..quantities import in_words
from ..scene.film import aligned_gaps, coned
from ..scene.fluid import liquid_of

# The hottest place of a face is warmer than its mean by up to this factor.
HOTTEST = 1.55
# Share of the heat that the leakage may carry; number (b mu U^2/k) from which the film is warmer than its walls.
CARRIES, THICK_FILM = 1.0 / 3.0, 1.0
RADII = 2001
# Share by which the friction of a run may differ from that of the aligned film.
ANOTHER = 0.05
# Convection is known to a factor of two.
COOLINGS = (0.5, 2.0)
# Speeds that are looked at on the way up, and how exactly those are found at which a seal hunts or has no warm state.
SPEEDS, ONSET, FOLD = 4, 1e-4, 1e-3
# Share of the highest rise that the liquid's table has, beyond which it is the table that ends.
TABLE = 0.99


def heat_of(scene, state: WarmState | None, friction: float | None = None) -> dict | None:
    """The numbers of a warm state of a scene with `[film.heat]`, SI, beside the mean `friction` (W) of a run; None
    without a state."""
    if state is None:
        return None
    found = warming(scene)
    total, cold = state.power, found.cold_state
    return {
        "rise": state.rise,
        "face_temperature": found.sealed + state.rise,
        "coning": state.coning,
        "coning_by_heat": found.coning_per_kelvin * state.rise,
        "viscosity": state.viscosity,
        "power": state.power,
        "contact_power": state.contact_power,
        "friction": {"counted": counted(state), "run": friction},
        "shares": {
            **{name: state.rise / ring.resistance / total for name, ring in found.rings.items()},
            "leakage": state.carried * state.rise / total,
        },
        "loop_gain": state.loop_gain,
        "slow_eigenvalue": None if state.slow is None else [state.slow.real, state.slow.imag],
        "stable": state.stable,
        "hunting_period": state.period,
        "boiling_radius": boiling_radius(found, state),
        "boiling_radius_hottest": boiling_radius(found, state, max(HOTTEST, _hottest(found))),
        "cold": {"clearance": cold and cold.clearance, "power": cold and cold.power, "leakage": cold and cold.leakage},
        "interval": _interval(scene),
        "hottest": found.sealed + _hottest(found) * state.rise,
        "rings": {name: {k: v for k, v in vars(ring).items() if k != "drawn"} for name, ring in found.rings.items()},
    }


def limits_of(found: Warming, high: float) -> dict:
    """From which shaft speeds (rad/s) up to `high` the state that continues the cold one hunts (`hunting`: `speed`,
    `period` (s) there) and is no more (`fold`); None where it does not, or the liquid's table ends before."""
    # Speeds and the states there, from rest on.
    known: list[tuple[float, WarmState | None]] = [(0.0, found.cold_state)]

    def look(speed) -> WarmState | None:
        there, (_, near) = found.at_speed(speed), known[-1]
        return there.continued(near or there.cold_state)

    def located(speed, state, share, holds):
        """The first speed, within a share, at which no state `holds`, and what is there: known from the last speed at
        which one does and a later one."""
        while abs(speed - known[-1][0]) > share * abs(speed):
            middle = 0.5 * (known[-1][0] + speed)
            between = look(middle)
            if between is not None and holds(between):
                known.append((middle, between))
            else:
                speed, state = middle, between
        return speed, state

    fold = None
    for speed in map(float, np.linspace(0.0, high, SPEEDS + 1)[1:]):
        state = look(speed)
        if state is None and known[-1][1] is not None:
            fold = speed
            break
        known.append((speed, state))
    if fold is not None:
        fold, _ = located(fold, None, FOLD, lambda state: True)
        fold = fold if known[-1][1].rise <= TABLE * found.highest else None
    unstable = [k for k, (_, state) in enumerate(known) if state is not None and not state.stable]
    if not unstable:
        return {"hunting": None, "fold": fold}
    begun = known[unstable[0]]
    del known[unstable[0] :]
    speed, state = located(*begun, ONSET, lambda state: state.stable)
    period = state and state.period
    return {"hunting": {"speed": speed, "period": period} if period else None, "fold": fold}


def limits_said(limits: dict) -> str:
    """What `limits_of` found in a sentence, "" of nothing."""
    words, hunting = [], limits["hunting"]
    if hunting is not None:
        speed, period = in_words("speed", hunting["speed"]), in_words("time", hunting["period"])
        words.append(f"at {speed} the seal begins to hunt, with a period of {period}")
    if limits["fold"] is not None:
        words.append(f"at {in_words('speed', limits['fold'])} the state that it warms to from the cold is no more")
    said = "; ".join(words)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _hottest(found: Warming) -> float:
    """The hottest place over the mean rise: of the rings from their drawings, or the largest there is."""
    return max((ring.hottest for ring in found.rings.values() if ring.hottest is not None), default=HOTTEST)


def _interval(scene) -> dict | None:
    """Rise (K), coning (rad) and heat (W) with half and with twice the convection, None where no ring is from its
    drawing; null where there is no warm state."""
    if all(ring.convection is None for ring in scene.film.heat.rings.values()):
        return None
    ends = [warming(scene, cooling).working() for cooling in COOLINGS]
    return columns(ends, ("rise", "coning", "power"))


def boiling_radius(found: Warming, state: WarmState, times: float = 1.0) -> float | None:
    """Radius (m) up to which, from the edge of the lower pressure on, the pressure of the aligned film is below the
    vapour pressure of liquid `times` the rise warmer than the sealed one; None where it is not, or is not known.

    **Valid** a full laminar film: the pressure falls as int dr/(r h^3).
    """
    liquid = liquid_of(found.scene.film)
    hot = found.sealed + times * state.rise
    vapour = liquid.vapour_pressure_at(hot)
    if vapour is None:
        return None
    film = coned(found.at(state.rise, state.clearance))
    inner, outer = found.pressures
    r = np.linspace(film.inner_radius, film.outer_radius, RADII)
    h = np.interp(r, *zip(*aligned_gaps(film, state.clearance), strict=True))
    each = 0.5 * np.diff(r) * (1.0 / (r * h**3)[1:] + 1.0 / (r * h**3)[:-1])
    p = inner + (outer - inner) * np.concatenate([[0.0], np.cumsum(each)]) / np.sum(each)
    boils = r[p < vapour]
    if not len(boils):
        return None
    return float(boils[-1] if outer >= inner else boils[0])


def counted(state: WarmState) -> float:
    """Friction (W) of film and asperities that a warm state counts."""
    return state.power - state.flow_power


def is_another(friction: float, aligned: float) -> bool:
    """Whether the mean `friction` (W; nan: not known) of a run is another than the `aligned` film's."""
    return aligned > 0.0 and abs(friction / aligned - 1.0) > ANOTHER


def heat_cautions(scene, state: WarmState, friction: float = math.nan) -> list[Caution]:
    """Where the warm state leaves what it is valid for, and where the mean `friction` (W) of a run is another."""
    found, words = warming(scene), []
    liquid, film = liquid_of(scene.film), scene.film
    if (radius := boiling_radius(found, state)) is not None:
        words.append(
            f"the film boils at the low pressure, up to r = {in_words('radius', radius, 5)}: no film here knows vapour"
        )
    elif (radius := boiling_radius(found, state, HOTTEST)) is not None:
        words.append(f"the film may boil where the face is hottest, up to r = {in_words('radius', radius, 5)}")
    for said, holds in (
        ("the convection is extrapolated beyond Becker's Reynolds numbers of 800 to 1e5", "extrapolated"),
        ("the band is narrower than a third of its ring: the resistance is known less well", "narrow"),
        ("the ring is longer than four times its width: its coning is known less well", "long"),
    ):
        names = [name for name, ring in found.rings.items() if getattr(ring, holds)]
        words += [f"{said} ({' and '.join(names)})"] if names else []
    if is_another(friction, counted(state)):
        words.append(f"the run makes {friction:.4g} W by friction, {counted(state):.4g} W are counted")
    course = followed(scene) if len(breaks(scene)) > 1 else None
    if course is None and len(breaks(scene)) > 1:
        words.append("temperature and coning stay those of the start, though loads change: study warm-up follows them")
    elif course is not None and course.collapsed is not None:
        words.append(f"the aligned film collapses at {course.collapsed:.4g} s; temperature and coning are then held")
    share = state.carried * state.rise / state.power if state.power else 0.0
    if share > CARRIES:
        words.append(
            f"leakage carries {in_words('share', share, 3)} of the heat: the rise is at most half as high as told"
        )
    at, sliding = found.sealed + state.rise, abs(initially(scene.shaft.speed) - initially(scene.stator.speed))
    velocity = sliding * 0.5 * (film.inner_radius + film.outer_radius)
    step = 0.1
    low = max(liquid.lowest, at - step)
    thinning = math.log(liquid.viscosity_at(low) / liquid.viscosity_at(at)) / (at - low)
    nahme = thinning * state.viscosity * velocity**2 / liquid.conductivity_at(at)
    if nahme > THICK_FILM:
        x = math.sqrt(nahme / 8.0)
        factor = math.asinh(x) / (x * math.sqrt(1.0 + x * x))
        words.append(f"Nahme number {nahme:.3g}: its friction is {factor:.3g} of that of one temperature")
    return [Caution(Concern.HEATING, f"heat: {said}") for said in words]
