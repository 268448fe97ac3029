"""What a run-up is asked to do: checked settings, from where to where, how fast, and what linear theory says of it."""

import math

import numpy as np

from ...analysis.poincare_map import frozen_at_end
from ...analysis.rotating_wave import free_model
from ...dynamics.modes import verdict
from ...numerics.piecewise_linear import PiecewiseLinear
from ...scenario.errors import ScenarioError
from ...scenario.reader import with_values
from ...scenario.settings import si_unit, values_in_si
from ...scene import scene as scenes
from ...scene.scene import part
from ...simulation.stability import critical_speed, resonance_speeds
from .ramp_run import tables_end
from .speed_ramp import Steady, followed_mode, touch_tilt

SPEED = "shaft.speed"
# The threshold is passed by so much; a whirl met there, over clearance/outer radius.
ABOVE, DISTURBANCE = 1.05, 1e-3
# Turns of a slow, a middle and a fast ramp where no threshold sets the pace; with one: growth on the way, as a share of
# the growth to touch.
TURNS, SHARES = (1000, 250, 60), (1.5, 0.75, 0.25)
# A ring that sticks and slips costs a hundred times as much a turn.
STICKING = (120, 60, 40)
# Accuracy of a run that meets a whirl, over the whirl's size; and the finest asked for.
FINE, FINEST = 2e-3, 1e-11
SETTLE, MOST_TURNS, PER_TURN = 5, 40_000, (32, 256)


def wrong(scenario, setting: str, found: str, expected: str) -> ScenarioError:
    return ScenarioError(scenario.name, f"study.runup.{setting}", found, expected)


def checked(scenario, settings):
    """Raises ScenarioError for a key that cannot change in time."""
    key = settings.key
    try:
        now = part(scenario.scene, key)
    except AttributeError:
        now = None
    if now is None and key == "closing.spring_force":
        raise wrong(scenario, "key", f"{key}, which the scenario does not give", "a quantity that it does give")
    if isinstance(now, bool) or not isinstance(now, int | float | PiecewiseLinear):
        raise wrong(scenario, "key", repr(key), 'a quantity of the scene that may change, e.g. "film.outer_pressure"')
    value = now.value[0] if isinstance(now, PiecewiseLinear) else float(now)
    try:
        with_values(scenario, {key: PiecewiseLinear((0.0, 1.0), (value, value)), "run.duration": 1.0})
    except ScenarioError as error:
        raise wrong(scenario, "key", repr(key), f"a quantity that may change in time ({error})") from None


def rate_unit(unit: str) -> str:
    """SI unit of a rate of a quantity with this unit."""
    return f"{unit}^2" if unit.endswith("/s") else f"{unit}/s"


def value_of(scenario, settings, name: str) -> float | None:
    """`begin` or `end` in SI.  Raises ScenarioError."""
    given = getattr(settings, name)
    if given is None:
        return None
    try:
        read = with_values(scenario, {settings.key: given, "run.duration": 1.0})
    except ScenarioError as error:
        raise wrong(scenario, name, error.found, error.expected) from None
    value = part(read.scene, settings.key)
    if isinstance(value, PiecewiseLinear):
        raise wrong(scenario, name, "a table", "one value: the ramp is made of `begin`, `end` and `rates`")
    return float(value)


def jumps(scene, key: str) -> bool:
    """Whether a step of the key would be a jump of a rigid ring, which the film's damping does not allow."""
    return key == "rotor.runout" or (key == "stator.misalignment" and scene.stator.support is None)


def rates_of(scenario, settings) -> list[float | None] | None:
    """Rates in SI per second, rising; None in it is a step; None for none given.  Raises ScenarioError."""
    if settings.rates is None:
        return None
    words = str(settings.rates)
    parts = [w.strip() for w in words.split(",")]
    steps, numbers = [w for w in parts if w == "step"], ",".join(w for w in parts if w != "step")
    expected = 'rates above zero (per second), "a, b, c" or "from:to:count[:log]"'
    if steps and settings.key == SPEED:
        raise wrong(scenario, "rates", '"step" of the shaft speed', expected)
    if steps and jumps(scenario.scene, settings.key):
        raise wrong(scenario, "rates", f'"step" of {settings.key}', "rates: a rigid ring cannot jump in the film")
    own = rate_unit(si_unit(scenario.scene, settings.key))
    found = sorted(values_in_si(scenario, numbers, own, "study.runup.rates")) if numbers else []
    if any(not rate > 0 for rate in found):
        raise wrong(scenario, "rates", repr(words), expected + "; `begin` and `end` give the direction")
    return [*found, *([None] if steps else [])]


def planned(scenario, settings) -> dict:
    """From where to where, how fast, what is followed: everything the runs are handed."""
    steady = Steady(scenario.scene)
    own = _own_speed(scenario.scene)
    free = free_model(frozen_at_end(scenario.scene), own)
    resonances = resonance_speeds(free) if steady.tilting else []
    threshold = critical_speed(free) if steady.tilting else None
    begin, end, chosen = _range(scenario, settings, own, resonances, threshold, free)
    crossing = max(threshold, begin) if threshold is not None and threshold < end else None
    crossing = crossing if not free.unknowns.has_residual_form else None
    mode = followed_mode(scenario.scene, begin, end, crossing)
    scale = free.clearance / free.face[1]
    disturbance = settings.disturbance if settings.disturbance is not None else DISTURBANCE * scale
    forced = sum(abs(steady.at(crossing or end, order)) for order in steady.orders) if steady.tilting else 0.0
    hold, limit = settings.hold or 0.0, touch_tilt(free)
    foretold = _rate_foretold(mode, crossing, end, hold, limit - forced, disturbance)
    order = settings.order if settings.order is not None else steady.main()
    per_turn, warnings = _per_turn(scenario.scene, settings, begin)
    warnings += _tones(scenario.scene, steady.tilting, order, begin, end)
    rates = rates_of(scenario, settings)
    if rates is None:
        sticks = any(seal and seal.law == "coulomb" for seal in
                     (scenario.scene.stator.secondary_seal, scenario.scene.rotor.secondary_seal))  # fmt: skip
        rates = _own_rates(begin, end, foretold, STICKING if sticks else TURNS)
        chosen.append("rates")
    slow = _turns(begin, end, rates[0])
    if slow > MOST_TURNS:
        least = _turns(begin, end, 1.0) / MOST_TURNS
        raise wrong(scenario, "rates", f"{rates[0]:.4g} rad/s^2: {slow:.3g} turns each way",
                    f"a rate above {least:.3g} rad/s^2, or a shorter way from begin to end")  # fmt: skip
    still = tables_end(scenes.with_values(scenario.scene, {SPEED: begin}))
    settle = max(still, SETTLE * 2 * math.pi / max(begin, 0.05 * end))
    changed = _tilted(scenario, steady, crossing)
    needed = max(FINE * disturbance / scale, FINEST)
    if crossing is not None and scenario.run.accuracy > needed:
        changed["run.accuracy"] = float(f"{needed:.3g}")
        warnings.append(f"accuracy {needed:.2g} instead of {scenario.run.accuracy:.2g}, for so small a whirl")
    base = {"begin": begin, "end": end, "hold": hold, "crossing": crossing, "disturbance": disturbance}
    base |= {"settle": settle, "per_turn": per_turn, "window": settings.window, "order": order}
    return {"scenario": with_values(scenario, changed), "base": base, "rates": rates, "mode": mode,
            "crossing": crossing, "steady": steady, "chosen": chosen,
            "linear_verdict": verdict(free.linear_scene().modes()), "threshold": threshold,
            "resonances": resonances, "tilt_scale": scale, "touch_tilt": limit,
            "forced": forced, "rate_foretold": foretold, "warnings": warnings}  # fmt: skip


def _own_speed(scene) -> float:
    speed = scene.shaft.speed
    return max(map(abs, speed.value)) if isinstance(speed, PiecewiseLinear) else abs(speed) or 1000.0


def _range(scenario, settings, own, resonances, threshold, free):
    """Speeds to begin and end at, and which of them were chosen here.  Raises ScenarioError."""
    begin, end = value_of(scenario, settings, "begin"), value_of(scenario, settings, "end")
    chosen = [name for name, given in (("begin", begin), ("end", end)) if given is None]
    low, high = _by_itself(scenario.scene.shaft.speed, own, resonances, threshold, free)
    if begin is None:
        begin = low if end is None or low < end else 0.5 * end
    end = high if end is None else end
    for name, value in (("begin", begin), ("end", end)):
        if value < 0:
            raise wrong(scenario, name, f"{value:g} rad/s", "a speed not below zero")
    if not begin < end:
        raise wrong(scenario, "begin", f"{begin:.6g} rad/s, not below end {end:.6g} rad/s",
                    "a lower speed than end: the ramp goes up from begin and comes back down")  # fmt: skip
    return float(f"{begin:.6g}"), float(f"{end:.6g}"), chosen


def _by_itself(speed, own, resonances, threshold, free) -> tuple[float, float]:
    """Speeds to begin and end at when nobody says: those of the scenario's own table, or half the first resonance to
    past the threshold (past the resonances if it is far away), the scenario's own speed on the way."""
    if isinstance(speed, PiecewiseLinear):
        return max(min(speed.value), 0.01 * own), own
    whirl = [m.value.imag for m in free.linear_scene().modes() if m.value.imag > 0]
    first = resonances[0] if resonances else min([threshold] if threshold else whirl or [own])
    # A threshold far beyond where the seal runs and resonates is not on the way.
    if threshold is not None and threshold < 8 * max([own, *resonances]):
        return 0.5 * min(first, own), max(ABOVE * threshold, own)
    return 0.5 * min(first, own), max(1.5 * max([*resonances, first]), 1.2 * own)


def _turns(begin, end, rate) -> float:
    """Turns of the shaft on one way."""
    return (end**2 - begin**2) / (2 * rate) / (2 * math.pi)


def _rate_foretold(mode, crossing, end, hold, limit, disturbance) -> float | None:
    """Rate (rad/s^2) at which a whirl met at the crossing would just touch by linear theory; None if any rate does or
    none."""
    if mode is None or not 0 < disturbance < limit:
        return None
    left = math.log(limit / disturbance) - float(mode.growth(end)) * hold
    grown = 2 * float(mode.between(crossing, end))
    return grown / left if left > 0 and grown > 0 else None


def _own_rates(begin, end, foretold, few) -> list[float]:
    way = _turns(begin, end, 1.0)
    rates = [foretold / share for share in SHARES] if foretold else [way / turns for turns in few]
    # At least a few windows of whole turns on the way, and no more turns than anyone waits for.
    return [float(f"{np.clip(rate, way / 4000, way / 30):.4g}") for rate in rates]


def _tones(scene, tilting, order, begin, end) -> list[str]:
    """Where the housing shakes at the order that is followed."""
    tones = scene.housing.angular if tilting else scene.housing.axial
    met = [(v.frequency, 2 * math.pi * v.frequency / abs(order)) for v in tones if order]
    bands = scene.housing.angular_random if tilting else scene.housing.axial_random
    bands = [*bands, *(scene.housing.angular_sweep if tilting else scene.housing.axial_sweep)]
    said = [
        f"the housing's {low:.4g} to {high:.4g} Hz meet order {order:g} and add to it"
        for low, high in ((min(band.frequency), max(band.frequency)) for band in bands)
        if begin * abs(order) < 2 * math.pi * high and 2 * math.pi * low < end * abs(order)
    ]
    return said + [
        f"the housing's {f:.4g} Hz meets order {order:g} at {w:.5g} rad/s: near there the order holds both"
        for f, w in met
        if begin < w < end
    ]


def _per_turn(scene, settings, begin) -> tuple[int, list[str]]:
    """Samples of a turn for the highest order known beforehand, and a warning if that is not enough."""
    orders = [abs(w.ratio) for w in scene.shaft.whirl] + [abs(r.order) for r in scene.rotor.axial_runout]
    tones = [v.frequency for v in scene.housing.tones] + [max(v.frequency) for v in scene.housing.sweeps]
    highest = max([1.0, *orders, *(2 * math.pi * f / max(begin, 1e-9) for f in tones)])
    count = settings.samples_per_turn
    if count is None:
        count = int(np.clip(2 ** math.ceil(math.log2(4 * highest)), *PER_TURN))
    if count > 2 * highest:
        return count, []
    said = (
        f"aliasing: order {highest:.3g} is driven at the lowest speed, above the {count / 2:.0f} that {count} samples "
        "a turn show: it folds back; raise samples_per_turn or begin"
    )
    return count, [said]


def _tilted(scenario, steady, crossing) -> dict:
    """Values that give an undriven scene its tilts as unknowns, by a tilt of nothing, where a whirl is to be met."""
    if crossing is None or steady.orders or steady.model.unknowns.with_tilt:
        return {}
    ring = "stator" if scenario.scene.stator.support else "rotor"
    return {f"initial.{ring}.tilt_x": 1e-18}
