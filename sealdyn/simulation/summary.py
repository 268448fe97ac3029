"""What a run amounts to: the numbers of `run --json`, from the run, the outcome and the running tallies."""

import math
from functools import cache

import numpy as np

from .. import closed_form
from ..dynamics import modes
from ..dynamics.equilibrium import resolved_matrices
from ..dynamics.extrema import H_LEG, H_RADIUS, H_TAU, H_THETA, LEAST, MOST, H
from ..dynamics.intervals import constant_and_slope
from ..dynamics.run_state import Caution, Concern
from ..faces.geometry import TOUCH
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, density_of, gas_of
from ..scene.forces import load_of
from ..scene.radial import RadialScene
from ..scene.rings import RING_NAMES, ROTOR, STATOR
from ..scene.scene import uneven_supports
from ..solvers.contract import Status
from ..solvers.run_error import missing_energy
from .margin import aligned_flow, contact_margin, state_at_rest, steady_extremes
from .plausibility import cautions, unit_warnings
from .stability import formula_numbers, found_alone, no_stability, stability

ML_PER_H, KG_PER_H = 3.6e9, 3.6e3


def model_chosen(scenario, run, plan) -> dict:
    """What the scene chose: `film`, names of the `unknowns`, `solver`, `start` ("rest", "steady" or an archive),
    `reasons` (sentences), and `unused` keys it does not use."""
    begun = [f"start: {run.start.why}"] if run.start.why else []
    return {
        "film": plan.film,
        "unknowns": run.model.unknowns.names,
        "solver": plan.method,
        "start": run.start.taken,
        "reasons": [*run.reasons, *begun, f"solver: {plan.why}", run.model.interface.message],
        "unused": scenario.unused,
    }


def parts(scenario, run, plan, outcome, tally, speeds: bool = True) -> dict:
    """The summary (`run --json`, SI) of a finished run, in which what costs something is a function that finds it:
    `plain` of it is JSON-ready.  `plan` as carried out, `outcome` of `solve`, its `tally`; `speeds`: with
    critical and resonance speeds, which cost more than a short run."""
    if isinstance(scenario.scene, RadialScene):
        from ..radial_seals.observers import summary_of

        found = summary_of(scenario, run, plan, outcome)
        return {**found, "warnings": [*unit_warnings(scenario), *found["warnings"]]}
    model, segment, failed = run.model, run.segment(outcome.segment), []
    # Of the conditions at the end; where these have no film what hangs on it is unknown, and the run is a run.
    at = model.instant(segment.interval, outcome.tau)
    linear, period = found_alone(failed, "linear film", lambda: model.linear_scene(at)), run.period(outcome.segment)
    whole = cache(lambda: run.extrema.extremes()[0])
    steady = cache(lambda: _steady(run, outcome, period, run.start.taken != "rest"))
    answers = cache(lambda: _answers(segment, at, linear))
    tilt = cache(lambda: _linear_steady(segment, answers, linear, period))

    def extra(name, find, otherwise=None):
        found = None if linear is None else found_alone(failed, name, find)
        return otherwise if found is None else found

    margin = cache(
        lambda: extra("contact margin", lambda: contact_margin(model, at, linear, tilt(), answers), (math.nan, None))
    )
    return {
        "status": outcome.status,
        "message": outcome.message,
        "model": lambda: model_chosen(scenario, run, plan),
        "speed": {
            "start": _first(model.scene.shaft.speed, run.intervals[0]),
            "end": _first(model.scene.shaft.speed, at),
        },
        "h_min": lambda: {
            "value": whole()[H],
            "time": run.end_time(int(whole()[H_LEG]), whole()[H_TAU]),
            "theta": whole()[H_THETA],
            "radius": whole()[H_RADIUS],
            "of_clearance": whole()[H] / model.clearance,
            "steady": steady()["thinnest"],
        },
        "relative_misalignment": lambda: {
            "max": whole()[MOST],
            "min": whole()[LEAST],
            "mean": lambda: tally.mean("relative_misalignment"),
            **{part: found for part, found in steady().items() if part != "thinnest"},
        },
        "leakage": lambda: _leakage(model, tally),
        "friction": lambda: {
            "torque": tally.mean("friction_torque"),
            "power": tally.mean("friction_power"),
            "max_power": tally.most("friction_power"),
            "temperature_rise": _temperature_rise(model, tally),
        },
        "heat": lambda: None if model.heat is None else _heat(model, tally, run.end_time(outcome.segment, outcome.tau)),
        "contact": _contact(run, outcome, tally),
        "secondary_seal": _secondary_seal(run),
        "film": _film(model, at, linear, tally, failed),
        "closing": _closing(model, at),
        "contact_margin": lambda: margin()[0],
        "contact_margin_limit": lambda: margin()[1],
        "closed_form": lambda: extra(
            "closed form", lambda: _closed_form(segment, at, linear, tilt()), {"road": "none: not found"}
        ),
        "stability": lambda: extra(
            "stability", lambda: stability(model, at, linear, speeds, failed), no_stability(model, at)
        ),
        "energy_residual": outcome.energy_residual,
        # Last of what may fail: what has failed is told.
        "warnings": lambda: [caution.sentence for caution in _cautions(scenario, run, outcome, tally)] + failed,
        "counts": {name: count for name, count in vars(outcome.counts).items() if name != "slow"},
        "tolerance": outcome.tolerance,
        "accuracy": model.accuracy,
        "end": {
            "time": run.end_time(outcome.segment, outcome.tau),
            "asked": run.duration,
            "state": {name: outcome.y[place] for name, place in _state_places(model.unknowns).items()},
        },
    }


def state_names(unknowns) -> list[str]:
    """Names of `end.state`."""
    return [*_state_places(unknowns)]


def _state_places(unknowns) -> dict[str, int]:
    """Places of displacements and rates by name."""
    rates = {f"{n}_rate": at for n, at in zip(unknowns.names, unknowns.rate_places, strict=True) if at >= 0}
    return {name: place for place, name in enumerate(unknowns.names)} | rates


def _steady(run, outcome, period, begun_well):
    """Steady extremes over the last forcing period, and the thinnest film (m) there, or None, with a sentence."""

    def none(sentence):
        return {"steady_max": None, "steady_min": None, "thinnest": None, "steady_said": sentence}

    if outcome.status not in (Status.OK, Status.INACCURATE):
        return none(f"no steady state: the run {outcome.status}")
    _, last, before = run.extrema.extremes()
    if not math.isfinite(last[MOST]) or not math.isfinite(before[MOST]):
        if period is None:
            return none("no steady state: forcing frequencies are incommensurate or change with time")
        return none("no steady state: constant conditions last less than two forcing periods")
    model = run.model
    scale = model.clearance / model.scene.film.outer_radius
    change = max(
        abs(last[MOST] - before[MOST]) / scale,
        abs(last[LEAST] - before[LEAST]) / scale,
        abs(last[H] - before[H]) / model.clearance,
    )
    if change > model.accuracy:
        other = begun_well or model.no_steady_response()
        try_it = "run longer" if other else 'run longer or use run.start = "steady"'
        return none(
            f"not steady: the last two forcing periods differ by {change:.1e} of the clearance "
            f"(accuracy {model.accuracy:.0e}); {try_it}"
        )
    said = "steady over the last two forcing periods"
    return {"steady_max": last[MOST], "steady_min": last[LEAST], "thinnest": last[H], "steady_said": said}


def _cautions(scenario, run, outcome, tally) -> list[Caution]:
    """All that a person should know before trusting the run."""
    model = run.model
    leakage = _leakage(model, tally)["mean"]
    heat = _temperature_rise(model, tally), tally.mean("friction_power") / model.closing.area
    wear = 0.0 if model.contact is None else tally.mean("wear_rate")
    low = run.extrema.extremes()[0, H]
    lost = missing_energy(outcome.energy_residual, model.accuracy)
    energy = [Caution(Concern.ENERGY, lost)] if lost else []
    found = cautions(scenario, run, outcome, leakage, heat, low, wear)
    warm = []
    if model.heat is not None:
        from .heat import heat_cautions

        warm = heat_cautions(model.given, model.heat, settled_friction(model, tally))
    return [*run.cautions, *energy, *_blown_open(run, tally), *found, *warm]


def _blown_open(run, tally) -> list[Caution]:
    """A gap many times its clearance, or that which the loads of a later time leave, is no seal any more."""
    model, widest = run.model, tally.most("axial_gap_change")
    if not widest >= 10 * model.clearance:
        return []
    # A seal that starts on its asperities lifts by many times their height.
    held = model.clearance + max(model.axial_shift(one) for one in (*run.intervals.few, run.intervals.end))
    if not widest >= 10 * held:
        return []
    times = f"the gap grew by {widest / held:.3g} times the clearance"
    sentence = f"blown open: {times}; the closing force does not hold this film"
    return [Caution(Concern.BLOWN_OPEN, sentence)]


def _contact(run, outcome, tally):
    """What the faces did where they touched, also if they do at the end; None without a [contact] table."""
    model = run.model
    if model.contact is None:
        return None
    found = run.contacts.so_far((run.end_time(outcome.segment, outcome.tau), outcome.y))
    level = model.face[TOUCH]

    def share():
        closing = tally.mean("closing_force")
        return tally.mean("contact_force") / closing if closing else None

    def share_of_load():
        """Of the closing force above the lower pressure, which surrounds the ring: load support is 1 less this."""
        edges = model.scene.film.inner_pressure, model.scene.film.outer_pressure
        if any(isinstance(pressure, PiecewiseLinear) for pressure in edges):
            return None
        load = tally.mean("closing_force") - min(edges) * model.closing.area
        return tally.mean("contact_force") / load if load else None

    return {
        "touches": found.count,
        "grazing": found.grazing,
        "gap_error": model.gap_error(),
        "touch_at": level,
        "first": found.first,
        "lowest": found.lowest,
        "depth": None if found.lowest is None else level - found.lowest,
        "longest": found.longest,
        "impulse": found.impulse,
        "force": lambda: {"mean": tally.mean("contact_force"), "max": tally.most("contact_force")},
        "share_of_closing": share,
        "share_of_load": share_of_load,
        "torque": lambda: tally.mean("contact_torque"),
        "max_area_fraction": lambda: tally.most("contact_area_fraction"),
        "max_pressure": lambda: tally.most("contact_pressure"),
        "wear_rate": lambda: tally.mean("wear_rate"),
        "wears": any((model.scene.contact.stator_wear_coefficient, model.scene.contact.rotor_wear_coefficient)),
    }


def _secondary_seal(run):
    """Friction of secondary seals: what holds them, and how often they stuck and slipped; None without one."""
    unknowns = run.model.unknowns
    if not unknowns.seals:
        return None
    rings = {}
    for k in unknowns.seals:
        force, moment = unknowns.seal(k).breakaway()
        rings[RING_NAMES[k]] = {"breakaway_force": force, "breakaway_moment": moment, "law": unknowns.seal(k).law}
        if k in unknowns.elastic_rings:
            stiffness, reach = unknowns.seal(k).springs()[0], unknowns.seal(k).reach()
            rings[RING_NAMES[k]] |= {"axial_stiffness": stiffness, "gives": reach}
    found = run.stick_slip
    if found is None or unknowns.elastic_rings:
        return {"rings": rings, "sticks": None, "slips": None, "energy_dropped": None, "stuck_at_end": None}
    held = [RING_NAMES[k] for k, held in found.stuck.items() if held]
    return {"rings": rings, "sticks": found.sticks, "slips": found.slips, "energy_dropped": found.dropped,
            "stuck_at_end": held}  # fmt: skip


# At which volumes of a gas are stated.
NORMAL = {"temperature": NORMAL_TEMPERATURE, "pressure": NORMAL_PRESSURE}


def _leakage(model, tally):
    side = "leakage_inner" if model.closing.outer_is_high else "leakage_outer"
    mean = tally.mean(side)
    return {
        "mean": mean,
        "max": tally.most(side),
        "mean_ml_per_h": mean * ML_PER_H,
        "mean_kg_per_h": mean * density_of(model.scene.film) * KG_PER_H,
        "conditions": None if model.scene.film.gas is None else NORMAL,
    }


def _heat(model, tally, end):
    # Loaded only where a ring takes heat.
    from .heat import heat_of

    at_end = None if model.course is None else model.course.at(end)
    return {**heat_of(model.given, model.heat, settled_friction(model, tally)), "end": at_end}


def settled_friction(model, tally):
    """Mean friction (W) of a run whose loads stay, which its heat may be compared with; of others nan."""
    from ..dynamics.warm_course import breaks

    return math.nan if len(breaks(model.given)) > 1 else tally.mean("friction_power")


def _temperature_rise(model, tally):
    """Rise (K) if all friction power heats the leakage."""
    film = model.scene.film
    flow = abs(tally.mean("leakage_inner" if model.closing.outer_is_high else "leakage_outer"))
    gas = gas_of(film)
    heat = film.specific_heat if gas is None else gas.heat_ratio / (gas.heat_ratio - 1.0) * gas.gas_constant
    return tally.mean("friction_power") / (density_of(film) * heat * flow) if flow > 0 else math.nan


def _film(model, at, linear, tally, failed):
    closing, radius = model.closing.over(at, model.scene.film)[0], model.scene.film.outer_radius
    unknown = np.full((3, 3), np.nan)
    k, d = (unknown, unknown) if linear is None else (linear.film_k, linear.film_d)
    k, d = resolved_matrices(k, d, closing, model.clearance, radius)
    aligned = cache(
        lambda: found_alone(failed, "aligned film", lambda: aligned_flow(model, at)) or (math.nan, math.nan)
    )
    return {
        "clearance": model.clearance + model.axial_shift(at),
        "leakage": lambda: aligned()[0],
        "friction_power": lambda: aligned()[1],
        "axial_stiffness": k[0, 0],
        "axial_damping": d[0, 0],
        "tilt_stiffness": k[1, 1],
        "tilt_damping": d[1, 1],
        "cross_stiffness": k[1, 2],
        "exit_mach": lambda: found_alone(failed, "exit Mach number", lambda: _exit_mach(model, at)),
        "max_cavitated_fraction": lambda: tally.most("cavitated_fraction"),
        "equilibria": [
            {"clearance": e.clearance, "stiffness": e.stiffness, "stable": e.stable} for e in model.interface.equilibria
        ],
    }


def _exit_mach(model, at):
    """Mach number at which a gas leaves these; None of a film that does not know."""
    film, f = model.observed
    return film.exit_mach(f, state_at_rest(model, at))[1] if film.exit_mach is not None else None


def _closing(model, at):
    law, film = model.closing, model.scene.film
    force, _ = law.over(at, film)
    hydraulic = force - _first(law.spring, at)
    return {
        "force": force,
        "balance_ratio": law.balance_ratio,
        "spring_force": force - hydraulic,
        "duty": force / law.area,
        "face_area": law.area,
    }


def _first(quantity, at):
    return constant_and_slope(quantity, at)[0]


def _linear_steady(segment, answers, linear, period):
    """Extremes of the linear steady state: (max, min, largest axial closing, period) or None if it does not exist."""
    rows = segment.rows
    if segment.model.unknowns.faces_tilt or not segment.harmonic:
        return None
    # Frequencies, of which one may begin at rest, and what changes.
    if period is None and len(rows) and np.any(rows[:, 7:9]) and (np.any(rows[:, 3]) or np.any(rows[:, 8])):
        return None
    return (*steady_extremes(linear, answers(), period), period)


def _answers(segment, at, linear):
    """Harmonics of the forcing with the linear response to each."""
    if at is segment.interval:
        return segment.steady_motion()[1]
    return linear.answers(segment.harmonics())


def _closed_form(segment, at, linear, tilt):
    """Steady state of the linearised film: harmonic balance for any scene; for one flexible ring also the published
    formulas fed with the film's own coefficients."""
    if segment.model.unknowns.faces_tilt:
        return {"road": "none: aligned faces press with a moment, so that it is not about them that the rings move"}
    if tilt is None:
        return {"road": "none: conditions change with time"}
    if modes.verdict(linear.modes()) != "stable":
        return {"road": "none: the linear steady state is not approached (not stable)"}
    found = {"relative_max": tilt[0], "relative_min": tilt[1], "axial_closing": tilt[2],
             "road": "harmonic balance of the film's own linearisation"}  # fmt: skip
    if tilt[3] is None and len(segment.rows):
        found["road"] += "; frequencies incommensurate: sum of amplitudes"
    scene, floats = segment.model.scene, segment.model.unknowns.floats
    arrangement = (floats[STATOR], floats[ROTOR])
    # The formulas know one stiffness and damping, whatever the frequency, and no load from outside.
    loaded = any(load_of(ring) for ring in (scene.stator, scene.rotor))
    other = uneven_supports(scene) or segment.model.interface.stores or loaded
    if arrangement == (True, True) or scene.stator.speed != 0.0 or other:
        return found
    ring = scene.stator if arrangement[0] else scene.rotor
    numbers = formula_numbers(ring, linear.film_k[1, 1], linear.film_d[1, 1]) | {"speed": _first(scene.shaft.speed, at)}
    if arrangement[1]:
        name, own = "FMR", scene.rotor.misalignment
        static, dynamic = closed_form.fmr_static(**numbers), closed_form.fmr_dynamic(**numbers)
    else:
        name, own = "FMS", scene.rotor.runout
        static, dynamic = closed_form.fms_static(**numbers), closed_form.fms_dynamic(**numbers)
    found |= {"arrangement": name, "static_transmissibility": static, "dynamic_transmissibility": dynamic}
    imposed, turning = abs(_first(scene.stator.misalignment, at)), abs(_first(own, at))
    most, least = closed_form.superposed(static * imposed, dynamic * turning)
    return found | {"formula_max": float(most), "formula_min": float(least)}
