"""Work and precision: the error of what the user looks at against what it costs, method by method and model by model.

How much solver does this scene need: every method over a range of tolerances against a judge that is none of them.
How much model: every rung of the ladder of films, and the harmonic balance, against the highest rung.
"""

import math
import os
import platform
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field

from ...answers import Answer, Table, table_of
from ...dynamics.intervals import largest_value
from ...scenario.reader import with_values
from ...scene.scene import SceneError
from ...simulation.film_error import reynolds_comparison
from ...simulation.result import libraries
from ...simulation.selection import check_method, choose_method, prepare_run
from ...solvers.fixed_step import REFERENCE_METHODS
from ...solvers.own_methods import collocation
from ...status import Status
from .. import Info
from . import film_ladder
from .film_ladder import JUDGE, TIGHT
from .observation import WHERE, errors, is_radial, observe, worst

NAMES = {
    "adams": "CVODE Adams", "bdf": "CVODE BDF", "bdf2": "CVODE BDF order 2", "ida": "IDA", "dop853": "SciPy DOP853",
    "rk45": "SciPy RK45", "lsoda": "SciPy LSODA", "radau": "SciPy Radau", "newmark": "Newmark",
    "generalised_alpha": "generalised-alpha", "midpoint": "implicit midpoint", "expm": "matrix exponential",
    "gauss": "Gauss collocation of order 12", "radau_nodes": "Radau collocation of order 9",
    "trbdf2": "TR-BDF2", "scipy_bdf": "SciPy BDF", "ida1": "IDA order 1 (implicit Euler)", "ida2": "IDA order 2",
    "segregated": "segregated film and rings", "quasi_static": "quasi-static film",
}  # fmt: skip
INFO = Info(
    timed=("fmr_reference", 33),
    seals="any",
    wavy=True,
    grooved=True,
    # Errors are shares of a scale.
    units={"processor": "s", "*": "1"},
    along={f"methods/{name}": ("tolerance",) for name in NAMES} | {
        f"methods/{name}/{what}": (f"methods/{name}/tolerance",)
        for name in NAMES for what in ("error", *(f"observables/{where}" for where in WHERE))
    },
)  # fmt: skip
FAST = ("adams", "bdf", "ida", "dop853", "lsoda", "expm", "trbdf2")
SLOW = ("rk45", "radau", "bdf2", "newmark", "generalised_alpha", "midpoint")
# Of films with unknowns beside IDA: it at low orders, and SciPy on the rates where every unknown has one; film and
# rings in turn; a film that stores nothing.
OF_FILMS = ("scipy_bdf", "ida2", "ida1", "segregated", "quasi_static")
ON_RATES = ("scipy_bdf", "radau", "dop853", "rk45")
LATER = (*SLOW, *OF_FILMS)
Method = Literal[*FAST, *LATER]
# The loosest accuracy that a run may be asked for.
LOOSEST = 0.1
ASKED = (1e-2, 1e-4, 1e-6, 1e-9)
# Judges of films with unknowns of their own: tolerances over the accuracy, until two have ended.
SHARP = (1e-3, 8e-3, 6.4e-2)
# The first of them where every unknown has a rate, so that high orders pay.
SHARPEST = 1e-6
# A method is not judged by itself at tolerances nearer than this to the judge's own.
CLOSEST = 3.0
# A time below this is measured again.
BRIEF = 0.3


@dataclass(frozen=True)
class Settings:
    """Methods and tolerances, and how they are judged."""

    tolerances: int = 10
    """Number of tolerances, evenly from `loosest` to `tightest`."""
    loosest: Annotated[float, Field(gt=0, le=1)] = 1e-2
    """Loosest tolerance."""
    tightest: Annotated[float, Field(gt=0, le=1)] = 1e-11
    """Tightest tolerance."""
    repeats: int = 3
    """Repeats of a run, of which the fastest counts."""
    longest: float = 60.0
    """Seconds that a run may take."""
    slowest: float = 100.0
    """Times the fastest run of that error: beyond, a cross."""
    samples: int = 400
    """Intervals at which errors are taken."""
    methods: tuple[Method, ...] = ()
    """Methods to judge; empty: all."""
    judging: float = 120.0
    """Seconds that the reference may take."""
    where: Literal["end", "over_time", "steady"] = "over_time"
    """Where the verdict looks."""
    models: bool = True
    """Also compare the film models."""


def run(scenario, settings, tools) -> Answer:
    """Methods, their judge, models, and who is fastest at which accuracy."""
    run, radial = ready(scenario), is_radial(scenario.scene)
    if scenario.run.start == "auto" and not radial:
        # All methods and films begin alike.
        scenario = with_values(scenario, {"run.start": run.start.taken})
    chosen = [m for m in (*FAST, *LATER) if not settings.methods or m in settings.methods]
    chosen = [m for m in chosen if _can(run, m)]
    exact, band, judges = reference(scenario, settings.samples, settings.judging)
    tools.say(0.1)
    sharpest = judges.get("least", 0.0)
    looked_at = [t for t in tolerances(settings) if t >= sharpest] or [settings.loosest]
    shared = {"tolerances": looked_at, "repeats": settings.repeats, "samples": settings.samples}
    judged = partial(judge, scenario, exact, judges)
    # Runs beside each other would disturb each other's clocks.
    alone = tools.alone()
    first = [{**shared, "method": m, "limit": settings.longest} for m in chosen if m in FAST]
    rows = alone.map(judged, first, "methods")
    tools.say(0.4)
    shared |= {"front": front(rows, settings.where), "slowest": settings.slowest, "where": settings.where}
    later = [{**shared, "method": m, "limit": settings.longest} for m in chosen if m in LATER]
    rows += alone.map(judged, later, "methods")
    tools.say(0.8)
    methods = dict(zip([m for g in (FAST, LATER) for m in chosen if m in g], rows, strict=True))
    methods = {name: row for name, row in methods.items() if "failed" not in row}
    mark_slow_runs(methods, settings.where, settings.slowest)
    rungs, unjudged = [], None
    if settings.models and not radial:
        rungs, unjudged = film_ladder.compare(scenario, settings.samples, settings.longest, settings.repeats, exact)
    answer = {
        "where": settings.where,
        "scene": {"turns": _turns(run), "duration": run.duration, "method": choose_method(run)[0]},
        "judges": judges,
        "judge_error": band,
        "methods": methods,
        "models": rungs,
        "models_unjudged": unjudged,
        "beside_reynolds": None if radial else reynolds_comparison(run),
        "machine": {**machine(), "back_end": back_end(methods)},
        "names": {name: NAMES[name] for name in methods},
    }
    answer["fastest"] = [rank_methods(answer, error) for error in ASKED]
    return Answer(answer, _found(answer), _tables(answer), notes=_notes(answer, settings))


def _can(run, method: str) -> bool:
    """Whether a method is one for this run; a massless ring shows what becomes of the others."""
    if is_radial(run.model.scene):
        # Its equations have no residual form, and change with every contact.
        return method not in ("ida", "expm", "trbdf2", *OF_FILMS)
    own = run.model.unknowns.film_unknowns is not None
    if method in OF_FILMS and not own:
        return False
    if own and method in ON_RATES:
        return run.segment(0).has_rates
    if method in ("expm", "trbdf2") or (own and method not in OF_FILMS):
        try:
            check_method(run.model, method)
        except SceneError:
            return False
    return True


def ready(scenario, tolerance: float = TIGHT):
    """A fresh run whose film and gap are evaluated far more accurately than any judged run.  The steps of a
    radial seal are no longer than what is interpolated between them allows: its accuracy is the `tolerance`."""
    if is_radial(scenario.scene):
        accuracy = min(max(tolerance, TIGHT), LOOSEST)
    else:
        accuracy = film_ladder.sharpest(scenario)
    run, *_ = prepare_run(with_values(scenario, {"run.accuracy": accuracy, "run.solver": "auto"}))
    return run


def tolerances(settings) -> list[float]:
    """From the loosest to the tightest, evenly in the exponent."""
    if settings.tolerances == 1:
        return [settings.loosest]
    ratio = math.log10(settings.tightest / settings.loosest) / (settings.tolerances - 1)
    return [float(f"{settings.loosest * 10 ** (ratio * k):.4g}") for k in range(settings.tolerances)]


def reference(scenario, samples: int, limit: float):
    """The exact run at so many `samples` within `limit` seconds, how far a second judge is from it (`{where: error}`
    or None), and the names of both.

    Judges in order: collocation at Gauss or at Radau nodes, whichever suits the scene, then the matrix exponential or
    DOP853 at 1e-13 where they can, then the other nodes.  Of a film with unknowns of its own its method far sharper
    than asked, then SciPy's Radau where every unknown has a rate, or the same again."""
    run = ready(scenario)
    own = run.segment(0).film.stop > run.segment(0).film.start
    good = []
    for name, tolerance in _sharper(scenario, run) if own else _others(run):
        steps = REFERENCE_METHODS.get(name, collocation)
        found = observe(ready(scenario, tolerance), steps, name, tolerance, limit, samples)
        if found.status in (Status.OK, Status.COLLAPSED) and (own or name not in [one for one, *_ in good]):
            good.append((name, found, tolerance, f"{NAMES[name]} at {tolerance:.0e}" if own else NAMES[name]))
        if len(good) == 2:
            break
    if not good:
        return found, None, {"exact": None, "second": None, "reason": found.reason}
    (name, exact, tolerance, words), *others = good
    band, second = (worst(errors(others[0][1], exact)), others[0][3]) if others else (None, None)
    judges = {"exact": words, "second": second, "reason": exact.reason, "method": None if own else name,
              "status": exact.status}  # fmt: skip
    return exact, band, judges | ({"least": CLOSEST * tolerance} if own else {})


def _others(run) -> list[tuple[str, float]]:
    """Judges that are none of the judged methods, and their tolerances."""
    stiff = choose_method(run)[0] in ("bdf", "radau")
    first, last = ("radau_nodes", "gauss") if stiff else ("gauss", "radau_nodes")
    between = [] if stiff or run.segment(0).has_residual_form else [("dop853", 1e-13)]
    if _can(run, "expm"):
        between = [("expm", 1e-13)]
    return [(first, JUDGE), *between, (last, JUDGE), ("dop853", 1e-12)]


def _sharper(scenario, run) -> list[tuple[str, float]]:
    """Judges at tolerances far below the scenario's accuracy, each once."""
    trials = [(choose_method(run)[0], share) for share in SHARP]
    if _can(run, "radau"):
        method = trials[0][0]
        trials = [(method, SHARPEST), ("radau", SHARPEST), trials[0], ("radau", SHARP[0]), *trials[1:]]
    # Beyond the tightest tolerance two would be one.
    return list(dict.fromkeys((name, max(share * scenario.run.accuracy, TIGHT)) for name, share in trials))


def judge(scenario, exact, judges: dict, point: dict) -> dict:
    """One method over all tolerances against the exact run: columns of time, counts, errors, status and reason."""
    method, rows = point["method"], []
    # What is compiled is loaded before the clock starts.
    observe(ready(scenario), REFERENCE_METHODS[method], method, 1e-2, 0.05, point["samples"])
    for tolerance in point["tolerances"]:
        limit, expected = _allowed(point, rows, tolerance)
        rows.append({**_measured(scenario, method, tolerance, point, exact, limit), "expected": expected})
        if rows[-1]["status"] == "stopped" and len(rows) > 1:
            # Tighter ones take longer still, but for the first: too loose, a method may crawl where a film rings.
            break
    # Again, one round after the other: a busy moment of the machine must not hit all runs of one tolerance.
    for _ in range(point["repeats"] - 1):
        for row in rows:
            if row["status"] == Status.OK and row["processor"] < BRIEF:
                again = _run(scenario, method, row["tolerance"], point, point["limit"])
                row["processor"] = min(row["processor"], again.processor)
    if judges.get("method") == method:
        for row in rows:
            row["errors"] = {where: {} for where in WHERE}
    names = sorted({name for row in rows for found in row["errors"].values() for name in found})
    columns = ("tolerance", "processor", "rhs", "status", "reason", "expected", "back_end")
    return {
        **{name: [row[name] for row in rows] for name in columns},
        "error": {where: [max(row["errors"][where].values(), default=None) for row in rows] for where in WHERE},
        "observables": {
            where: {name: [row["errors"][where].get(name) for row in rows] for name in names} for where in WHERE
        },
    }


def _run(scenario, method, tolerance, point, limit):
    run = ready(scenario, tolerance)
    return observe(run, REFERENCE_METHODS[method], method, tolerance, limit, point["samples"])


def _measured(scenario, method, tolerance, point, exact, limit) -> dict:
    found = _run(scenario, method, tolerance, point, limit)
    reason = found.reason.split("  Try")[0]
    if found.status == "stopped" and limit < point["limit"]:
        reason = f"more than {point['slowest']:g} times the fastest of the error it would reach"
    row = {"tolerance": tolerance, "processor": found.processor, "rhs": found.counts.rhs, "status": found.status}
    row |= {"back_end": found.counts.back_end}
    return {**row, "reason": reason, "errors": errors(found, exact)}


def front(rows, where: str) -> list[tuple[float, float]]:
    """(error, processor time) of every run of these methods that ended."""
    return [pair for row in rows if "failed" not in row for pair in curve(row, where)]


def _allowed(point, rows, tolerance) -> tuple[float, float | None]:
    """Seconds that a run may take, and the error it can be expected to reach: errors go as a power of the tolerance,
    of the last two runs that ended, or as the tolerance."""
    where = point.get("where", "end")
    known = [row for row in rows if row["status"] == Status.OK and row["errors"][where]]
    if not known or not point.get("front"):
        return point["limit"], None
    found = [(row["tolerance"], max(max(row["errors"][where].values()), 1e-16)) for row in known[-2:]]
    (first, before), (last, error) = found[0], found[-1]
    order = math.log(before / error) / math.log(first / last) if first > last else 1.0
    expected = error * (tolerance / last) ** min(max(order, 0.0), 1.0)
    least = time_at(point["front"], max(expected, 1e-16)) or max(spent for _, spent in point["front"])
    return min(point["limit"], point["slowest"] * least), expected


def _found(answer) -> str:
    """Who is fastest at which error."""
    told = [f"to {row['error']:.0e} {NAMES[row['method']] if row['method'] else 'none'}" for row in answer["fastest"]]
    return f"Fastest to an error {film_ladder.WORDS[answer['where']]}: {', '.join(told)}."


def _tables(answer) -> list[Table]:
    """Who is fastest at which error, which runs did not end well, and the film models."""
    ranks = (("1", "error", "error"), ("1", "fastest", "method"), ("time", "in", "processor"), ("1", "next", "next"),
             ("1", "times as long", "factor_next"), ("1", "DOP853, times as long", "factor_dop853"),
             ("1", "why none", "why"))  # fmt: skip
    ends = [[name, len(row["status"]), row["status"].count(Status.OK), next(filter(None, row["reason"]), None)]
            for name, row in answer["methods"].items()]  # fmt: skip
    where = film_ladder.looked_at(answer)
    models = [[row["label"], (row.get("error") or {}).get(where), (row.get("leakage_error") or {}).get(where),
               row.get("processor"), row.get("failed")] for row in answer["models"]]  # fmt: skip
    return [
        table_of("fastest", ranks, answer["fastest"]),
        Table("methods", [("1", "method"), ("1", "runs"), ("1", "ended"), ("1", "the first that did not")], ends),
        Table("models", [("1", "film model"), ("1", "error of the motion"), ("1", "of the leakage"), ("time", "in"),
                         ("1", "failed")], models),
    ]  # fmt: skip


def _notes(answer: dict, settings) -> list[str]:
    """How much film model the scene needs, and how far both can be trusted."""
    lines = [film_ladder.sentence(answer)] if answer["models"] else []
    if beside := answer["beside_reynolds"]:
        lines.append(f"The film itself, {beside['said']}.")
    band, judges = (answer["judge_error"] or {}).get(settings.where), answer["judges"]
    if judges["exact"] is None:
        lines.append(f"No judge ended, so there are no errors: {judges['reason']}.")
    elif band is not None:
        lines.append(f"Judged by {judges['exact']}; {judges['second']} differs from it by {band:.1e}.")
    else:
        lines.append(f"Judged by {judges['exact']}; no second judge: {judges['reason'] or 'none ended in time'}.")
    if judges.get("least", 0.0) > settings.tightest:
        lines.append(f"Tolerances below {judges['least']:.0e} it cannot judge, and they are left out.")
    return lines


def _turns(run) -> float:
    rate = largest_value(run.model.scene.shaft.speed) or run.model.reference_rate
    return float(abs(rate) * run.duration / (2 * math.pi))


def back_end(methods) -> str:
    """Who made the steps of CVODE and IDA."""
    found = {name: None for row in methods.values() for name in row["back_end"] if name}
    return " and ".join(found) or "none"


def machine() -> dict:
    """Processor, cores and versions: what a time means."""
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as lines:
            name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), name)
    except OSError:
        pass
    return {"processor": name, "cores": os.cpu_count(), **libraries()}


def mark_slow_runs(methods: dict, where: str, slowest: float):
    """A run that took more than `slowest` times the fastest of at most its error becomes a cross."""
    everyone = {name: curve(row, where) for name, row in methods.items()}
    for row in methods.values():
        for k, error in enumerate(row["error"][where]):
            if row["status"][k] != Status.OK or error is None:
                continue
            least = min((w for c in everyone.values() for e, w in c if e <= error), default=math.inf)
            if row["processor"][k] > slowest * least:
                row["status"][k] = "slow"
                row["reason"][k] = f"{row['processor'][k] / least:.0f} times the fastest of this error"


def curve(row: dict, where: str) -> list[tuple[float, float]]:
    """(error, processor time) of the runs that ended, errors above zero."""
    return [
        (max(error, 1e-16), spent)
        for error, spent, status in zip(row["error"][where], row["processor"], row["status"], strict=True)
        if status == Status.OK and error is not None
    ]


def time_at(points, error: float) -> float | None:
    """Cost at an error: between runs on a line of logarithms, along the lower edge; None below the smallest error."""
    edge, least = [], math.inf
    for e, spent in sorted(points):
        # From the most exact on: only what is cheaper yet is worth its error.
        if spent < least:
            least = spent
            edge.append((math.log(e), math.log(spent)))
    if not edge or edge[0][0] > math.log(error):
        return None
    for (e0, w0), (e1, w1) in pairwise(edge):
        if e1 >= math.log(error):
            return math.exp(w0 + (w1 - w0) * (math.log(error) - e0) / (e1 - e0))
    return math.exp(edge[-1][1])


def rank_methods(answer: dict, error: float) -> dict:
    """Who reaches an error in the least time, by what factor over the next and over DOP853."""
    where = answer["where"]
    band = (answer["judge_error"] or {}).get(where)
    if band is not None and band > error / 3:
        return {"error": error, "method": None, "why": f"the judges differ by {band:.1e}"}
    found = {name: time_at(curve(row, where), error) for name, row in answer["methods"].items()}
    order = sorted((spent, name) for name, spent in found.items() if spent is not None)
    if not order:
        collapsed = answer["judges"].get("status") == Status.COLLAPSED
        why = "the film collapses in the judge's run too" if collapsed else "no method got there"
        return {"error": error, "method": None, "why": why}
    least, name = order[0]
    # Who ended well at the tightest tolerance and is still above this error was not asked tightly enough.
    above = [m for m, row in answer["methods"].items() if found[m] is None and row["status"][-1] == Status.OK]
    out = {"error": error, "method": name, "processor": least, "next": None, "factor_next": None, "factor_dop853": None,
           "not_asked": above}  # fmt: skip
    if len(order) > 1:
        out |= {"next": order[1][1], "factor_next": order[1][0] / least}
    if found.get("dop853"):
        out["factor_dop853"] = found["dop853"] / least
    return out
