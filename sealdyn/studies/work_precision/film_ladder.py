"""How much model a scene needs: every rung of the ladder of films, and the harmonic balance, against the highest."""

import math
import time as clock
from dataclasses import asdict

import numpy as np

from ...dynamics import modes
from ...films import film_named, film_names, film_of
from ...scenario.reader import with_values
from ...scene.film import Coefficients
from ...scene.patterns import grooves_of, waves_of
from ...simulation.selection import prepare_run
from ...solvers.contract import tolerance_for
from ...solvers.methods import METHODS
from ...solvers.own_methods import collocation
from ...status import Status
from .observation import errors, observe, worst

# Far below every judged run; the embedded estimate of the judge is of lower order than the judge itself.
JUDGE, TIGHT = 1e-11, 1e-11
# Points over a period at which the harmonic balance is looked at.
POINTS = 4096
WORDS = {"end": "at the end", "over_time": "at any time", "steady": "in the steady state"}


def rungs(scenario) -> list[tuple[str, dict]]:
    """(label, overrides) from the lowest to the highest; films are found by file name."""
    given = isinstance(scenario.scene.film.coefficients, Coefficients)
    if given:
        # The film is these numbers: there is nothing above them.
        return [("linear film, coefficients as given", {"film.model": "linear"})]
    found = []
    scene = scenario.scene
    if grooves_of(scene)[1]:
        return _columns(scenario)
    for name in sorted(film_names(scene.film, waves_of(scene)), key=lambda n: film_named(n).fidelity):
        if film_named(name).halved is not None:
            found += _grids(scenario, name)
        elif name == "linear":
            found += [
                (f"linear film, {words} coefficients", {"film.model": name, "film.coefficients": source})
                for source, words in (("green", "Green's"), ("radial", "radial film's"))
            ]
        else:
            found.append((f"{name.replace('_', ' ')} film", {"film.model": name}))
    return found


def _grids(scenario, name: str) -> list[tuple[str, dict]]:
    """(label, overrides) of a film with cells: half of them, its own, and twice as many where it can have them."""
    film = prepare_run(with_values(scenario, {"film.model": name, **AUTO}))[0].model.scene.film
    own = film_named(name)
    tables = {"half the cells": own.halved(film), "its cells": film}
    tables |= {TWICE: own.doubled(film, 1)} if own.doubled is not None else {}
    return _named(name, {words: _cells(name, table) for words, table in tables.items()})


def _columns(scenario) -> list[tuple[str, dict]]:
    """The same of the film over grooves, which no other film sees."""
    from ...films._grooved.cells import options_of

    name, columns = film_of(scenario.scene).name, options_of(scenario.scene.film).columns
    counts = {"half the cells": columns // 2, "its cells": columns, TWICE: 2 * columns}
    return _named(name, {words: {f"film.{name}.columns": count} for words, count in counts.items()})


def _named(name: str, cells: dict[str, dict]) -> list[tuple[str, dict]]:
    """(label, overrides) of a film with each of these {words: cells}."""
    return [(f"{name.replace('_', ' ')} film, {words}", {"film.model": name, **own}) for words, own in cells.items()]


def _cells(name: str, film) -> dict:
    """Overrides that ask for the cells of a `Film` table; none for those that it has without a word."""
    # The table [film.NAME] is called as its film is.
    options = getattr(film, name)
    cells = {} if options is None else {key: v for key, v in asdict(options).items() if key.startswith("cells")}
    return {f"film.{name}.{key}": list(v) if isinstance(v, tuple) else v for key, v in cells.items() if v is not None}


def compare(scenario, samples: int, longest: float, repeats: int, exact=None) -> tuple[list[dict], str | None]:
    """Rows `{label, error{where}, processor, rhs, failed}` of every rung, cheapest model first, each run with the
    method and tolerance that the program takes for the scenario's accuracy; `exact` the scenario's own exact run.  And
    the highest rung of all where it could not be run exactly, None where it could."""
    ladder = rungs(scenario)
    highest, top, last = exact, ladder[-1], ladder[-1][0]
    # The scenario's own film may be the highest, and then its exact run is there already.
    own = len(top[1]) == 1 and top[1]["film.model"] == scenario.scene.film.model != "linear"
    if not own or exact is None or exact.status != Status.OK:
        highest, top = _highest(scenario, ladder, samples, longest)
    if highest is None:
        return [], last
    if last.endswith(TWICE):
        # That is a judge.
        ladder, last = ladder[:-1], ladder[-2][0]
    ends = ladder[:1] if top == ladder[0] else [ladder[0], top]
    out = [_balanced(scenario, rung, highest, repeats) for rung in ends]
    out += [_run(scenario, rung, highest, samples, longest, repeats) for rung in ladder]
    judged = top[0].startswith(last.partition(",")[0])
    return [row for row in out if row], None if judged else last


def _highest(scenario, ladder, samples, longest):
    """The exact run of the highest rung that this scene can be run with, and that rung."""
    for rung in reversed(ladder):
        try:
            run, *_ = prepare_run(with_values(scenario, {**rung[1], "run.accuracy": sharpest(scenario), **AUTO}))
            # A film with unknowns of its own is never exact.
            own = run.model.unknowns.film_unknowns is not None
            found = None if own else observe(run, collocation, "gauss", JUDGE, 2 * longest, samples)
            if found is None or found.status not in (Status.OK, Status.COLLAPSED):
                accuracy = scenario.run.accuracy / 30.0 if own else 1e-9
                run, plan = prepare_run(with_values(scenario, {**rung[1], "run.accuracy": accuracy, **AUTO}))
                method = plan.method
                tolerance = tolerance_for(method, accuracy, run.memory)
                found = observe(run, METHODS[method], method, tolerance, longest, samples)
        except ValueError:
            # This film refuses the scene.
            continue
        if found.status in (Status.OK, Status.COLLAPSED):
            return found, rung
    return None, None


AUTO = {"run.solver": "auto"}
TWICE = "twice the cells"


def sharpest(scenario) -> float:
    """Accuracy of an exact run: Coulomb friction fades over a band that follows the accuracy, so there the scenario's
    own is kept."""
    seals = (scenario.scene.stator.secondary_seal, scenario.scene.rotor.secondary_seal)
    return scenario.run.accuracy if any(s and s.law == "coulomb" for s in seals) else TIGHT


def _run(scenario, rung, highest, samples, longest, repeats) -> dict:
    """One rung in time, at the scenario's accuracy."""
    label, overrides = rung
    row = {"label": label, "error": {"end": None, "over_time": None, "steady": None}, "processor": None, "failed": None}
    best = None
    try:
        for _ in range(max(1, repeats) + 1):
            run, plan = prepare_run(with_values(scenario, {**overrides, **AUTO}))
            method = plan.method
            tolerance = tolerance_for(method, scenario.run.accuracy, run.memory)
            found = observe(run, METHODS[method], method, tolerance, longest, samples)
            best = found if best is None or found.processor < best.processor else best
            if found.processor > 1.0 or found.status != Status.OK:
                break
    except ValueError as refused:
        return row | {"failed": str(refused)}
    row |= {"processor": best.processor, "rhs": best.counts.rhs, "method": method}
    if best.status != Status.OK or highest.status != Status.OK:
        return row | {"failed": best.reason or f"the highest rung: {highest.reason}"}
    # The motion for itself: a film's leakage is a formula of its own.
    found = errors(best, highest)
    leakage = {where: by_name.pop("leakage", None) for where, by_name in found.items()}
    return row | {"error": worst(found), "leakage_error": leakage}


def _balanced(scenario, rung, highest, repeats) -> dict | None:
    """The harmonic balance of a rung's linearisation, with its own call time; None where there is no steady state."""
    label, overrides = rung
    run, *_ = prepare_run(with_values(scenario, {**overrides, **AUTO}))
    last = run.intervals[-1]
    steady = (
        highest.steady
        and run.period(-1)
        and not run.model.unknowns.extended
        and not run.model.unknowns.has_residual_form
    )
    if not steady or modes.verdict(run.model.linear_scene(last).modes()) != "stable":
        return None
    spent = math.inf
    for _ in range(repeats + 1):
        begun = clock.process_time()
        found = harmonic_balance(run)
        spent = min(spent, clock.process_time() - begun)
    length = highest.scales["h_min"]
    tilt = highest.scales["relative_misalignment"]
    off = [abs(found["h_min"] - highest.steady["h_min"][0]) / length]
    off += [
        abs(a - b) / tilt
        for a, b in zip(found["relative_misalignment"], highest.steady["relative_misalignment"], strict=True)
    ]
    whose = "Green's" if "green" in overrides.values() else label.partition(" film")[0] + " film's"
    whose = "given" if "as given" in label else whose
    error = {"end": None, "over_time": None, "steady": float(max(off))}
    return {"label": f"harmonic balance, {whose} coefficients", "error": error, "processor": spent, "failed": None}


def harmonic_balance(run) -> dict:
    """Linear steady extremes over one period of the last segment: `h_min` (m) and the least and most relative
    misalignment (rad).

    **Source** the answers of modes.LinearScene to every imposed harmonic, superposed.
    **Valid** small motion; constant conditions; a stable scene."""
    segment = run.segment(-1)
    linear = run.model.linear_scene(segment.interval)
    relative = [(h.frequency, linear.relative(h, linear.response(h))) for h in segment.harmonics()]
    t = np.linspace(0.0, run.period(-1), POINTS + 1)
    motion = np.zeros((3, len(t)))
    for frequency, amplitude in relative:
        motion += (amplitude[:, None] * np.exp(1j * frequency * t)).real
    tilt = np.hypot(motion[1], motion[2])
    shift = run.model.axial_shift(segment.interval) + motion[0]
    thinnest = min(np.min(h + shift - r * tilt) for r, h in run.model.aligned_gaps(segment.interval))
    return {"h_min": float(thinnest), "relative_misalignment": [float(tilt.min()), float(tilt.max())]}


def looked_at(answer: dict) -> str:
    """Where errors of models are told: in the steady state if there is one, else where the study looks."""
    return "steady" if any(row["error"]["steady"] is not None for row in answer["models"]) else answer["where"]


def sentence(answer: dict) -> str:
    """The lowest model that is good enough for 1e-2 and for 1e-4, and how wrong the linear film is."""
    where = looked_at(answer)
    errors_of = {row["label"]: row["error"][where] for row in answer["models"] if row["error"][where] is not None}
    if not errors_of:
        return "No rung of the ladder ended: nothing to say about models."
    needs = [f"for {most:.0e} {next((label for label, error in errors_of.items() if error <= most), 'none of them')}"
             for most in (1e-2, 1e-4)]  # fmt: skip
    linear = [error for label, error in errors_of.items() if label.startswith("linear") and error > 0]
    wrong = f"; the linear film is wrong by {min(linear):.1e} whatever the solver" if linear else ""
    above = answer.get("models_unjudged")
    wrong += f"; what the {above} would change is not known, it takes too long to run exactly" if above else ""
    return f"Film model needed {WORDS[where]}: {', '.join(needs)}{wrong}."
