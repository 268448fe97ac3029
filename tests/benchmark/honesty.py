"""How honest are runs and their certificates on any scene, and what do they cost?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/honesty.py [scenes] [figure.png] [processes] [family] [seed] [budget]

A figure's numbers go beside it (figure.json), for the gallery's page (gallery.py); without a figure (numbers.json, or
"-") no costs are found.  Random scenes of all that the program accepts, seeded (tests/families.py: "wide", "gas",
"gas_reynolds", "reynolds", "patterned"; tests/hard_families.py: "runup", "rubbing", "tilted_faces", or "every" in
turn); the truth of each, whose tilts are unknowns whatever tilts it, by two other references (tests/judge.py), of every
tenth of liquids by equations that share nothing with the program (tests/own_words.py), of gas films that store by four
times as many cells besides, up to the time where they agree within accuracy/100; of cavitating films by their method
twice, far sharper, up to the time where they agree within accuracy/10, loads and flows at 99 % of the instants, as the
certificate has them.
`budget` (s) bounds the processor time of each reference; what takes longer is not judged.
Scenes of which less than a turn is known are drawn anew.
A run is done as `sealdyn run` does it: film, method and tolerance chosen, certified, done again where it is not exact
enough.  Honest: every quantity of the certificate (simulation/verification_run.py) and every contact is right
within the asked accuracy, or the run says that it is not.
Runs that are continued and scenes that are refused: unusual_runs.py.
Cost: processor time of all that, over that of the cheapest method and tolerance that would have done, known only in
hindsight; smooth scenes; the least of three times each.
"""

import json
import math
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from hard_families import FAMILIES, one_of
from judge import (
    Instants,
    TooLong,
    all_contacts,
    by_steps,
    contact_errors,
    instants,
    truth,
    truth_by_steps,
    truth_in_own_words,
)
from scenes import prepared, set_start

from sealdyn.films.reynolds.film import FILM
from sealdyn.report.charts import page as palette
from sealdyn.scenario.tables import Run
from sealdyn.scene.patterns import tilt_is_imposed
from sealdyn.simulation.certificate import certificate, first_steps, judgement, next_plan
from sealdyn.simulation.selection import Plan, choose_method, select_film
from sealdyn.simulation.verification_run import QUANTITIES, Comparison, ErrorScales, clip_jumps
from sealdyn.solvers.integrate import solve

SEED, TIMES = 20_26, 3
# Every tenth scene is judged by equations in the tests' own words.
OWN = 10
ALL = (*QUANTITIES, "contact depth", "contact time")
# Accuracies tried in hindsight, in units of the asked one, from the cheapest; the first that does is taken.
KNOBS = (1000.0, 100.0, 30.0, 10.0, 3.0, 1.0, 0.3)
DEARER, LONGEST = 4.0, 20.0
# A tilt (rad) that is none, but imposed.
NO_TILT = 1e-30
# Methods of films with unknowns of their own; by how much the cells of these are more in the truth, each way.
METHODS, FINER = {"gas_reynolds": ("ida",), "reynolds": ("trbdf2",)}, 2


def begin(drawn):
    """What sets a run's unknowns."""

    def begun(run):
        set_start(run, drawn.start)
        run.check_start()

    return begun


def automatic(drawn, times):
    """A run as `simulate` does it: the run, its certificate, outcome, columns at the times, contacts, and what it took
    (s)."""
    begun = time.process_time()
    run, by_model = select_film(drawn.scene, Run(duration=drawn.duration, accuracy=drawn.accuracy), begin(drawn))
    method, why = choose_method(run)
    plan, tries = Plan("", method, None, run.start, why, film_error=by_model), []
    while True:
        sink = Instants(ErrorScales(run), times)
        trial, errors = first_steps(run, plan)
        options = {"tolerance": trial.tolerance, "steps": trial.steps} if trial else {}
        seen = Comparison(run) if errors is None and plan.method != "expm" else None
        outcome = solve(run, plan.method, drawn.accuracy, sink, errors=errors, seen=seen, **options)
        found, outcome = certificate(run, plan, outcome, errors, seen)
        again = next_plan(run, "auto", plan, outcome, found, tries)
        if again is None:
            break
        tries.append((plan, outcome.tolerance, found))
        run, plan = run.anew(), again
    found, outcome = judgement(found, outcome, tries)
    spent = time.process_time() - begun
    return run, plan.method, found, outcome, sink.all(), all_contacts(run, outcome), spent


def in_order(model, reference, columns):
    """Columns of the reference run with unknowns in the order of another model's."""
    names = [reference.unknowns.names.index(name) for name in model.unknowns.names]
    n = reference.unknowns.n
    return columns[:, [*names, *(n + k for k in names), *range(2 * n, columns.shape[1])]]


def hindsight(make, drawn, times, scales, true, rows):
    """Processor time (s) of the cheapest method and tolerance that keep the accuracy; infinite if none does."""
    best = math.inf
    for method in METHODS.get(drawn.scene.film.model, ("adams", "bdf", "dop853")):
        for knob in KNOBS:
            spent, accuracy = math.inf, min(drawn.accuracy * knob, 0.05)
            try:
                for _ in range(TIMES):
                    begun = time.process_time()
                    run, sink = make(accuracy), Instants(scales, times, begun + min(DEARER * best, LONGEST))
                    outcome = solve(run, method, accuracy, sink)
                    spent = min(spent, time.process_time() - begun)
            except TooLong:
                # A sharper one costs more still.
                break
            if outcome.status != "ok":
                continue
            errors = scales.errors(sink.all()[:rows], true[:rows])
            if np.all((clip_jumps(errors) if method == "trbdf2" else errors) <= drawn.accuracy):
                best = min(best, spent)
                break
    return best


def in_finer_cells(drawn, scales, times, method):
    """Columns of a sharp run with more cells, or None where it takes too long."""
    film = drawn.scene.film
    cells = tuple(FINER * count for count in film.gas_reynolds.cells)
    scene = replace(drawn.scene, film=replace(film, gas_reynolds=replace(film.gas_reynolds, cells=cells)))
    run = prepared(scene, drawn.duration, drawn.accuracy / 100, drawn.start)
    try:
        # The flow over the edge of narrow cells is what a loose tolerance knows least.
        return by_steps(run, scales, times, method, drawn.accuracy * 1e-4, time.process_time() + 4 * LONGEST)[0]
    except TooLong:
        return None


def judge(number, family="wide", seed=SEED, budget=None, costs=True):
    """What one scene shows: a dict, with `why` where it is no scene or cannot be judged; `budget` (s) of processor time
    of each reference, `costs`: found too."""
    random = np.random.default_rng([seed, number])
    drawn = one_of(FAMILIES[number % len(FAMILIES)] if family == "every" else family, random)
    row = {"number": number, "words": drawn.words, "accuracy": drawn.accuracy, "smooth": drawn.smooth}
    highest = drawn.scene
    if highest.film.gas is None and highest.film.model != "reynolds":
        highest = replace(highest, film=replace(highest.film, model="radial"))
    if not tilt_is_imposed(highest):
        # Whether tilts may be left out is the run's answer, and so is one sector for all; the cells are the same.
        if highest.film.model == "reynolds":
            cells = replace(FILM.prepared(highest).reynolds, sectors=None)
            highest = replace(highest, film=replace(highest.film, reynolds=cells))
        highest = replace(highest, stator=replace(highest.stator, misalignment=NO_TILT))

    def make(accuracy=drawn.accuracy / 100):
        return prepared(highest, drawn.duration, accuracy, drawn.start)

    try:
        reference = make()
        reference.check_start()
    except ValueError:
        return {**row, "why": "no scene"}
    scales, times = ErrorScales(reference), instants(random, reference)
    chosen = choose_method(reference)[0]
    own = number % OWN == 0 and highest.film.model not in ("gas_dam", "reynolds")
    asked = make, scales, times, drawn.accuracy, chosen, *([budget] if budget else [])
    known = truth_in_own_words(*asked) if own else None
    known = truth_by_steps(*asked) if chosen == "trbdf2" else known or truth(*asked)
    if known is None:
        return {**row, "why": "not judged"}
    turn = 2 * math.pi / scales.rate
    if known.rows == 0 or times[known.rows - 1] < min(turn, 0.99 * drawn.duration):
        return {**row, "why": "known for less than a turn"}
    run, method, found, outcome, columns, contacts, spent = automatic(drawn, times)
    rows = min(known.rows, len(columns))
    if found["horizon"]:
        rows = min(rows, int(np.searchsorted(times, found["horizon"])))
    true = in_order(run.model, reference.model, known.columns)
    errors = ErrorScales(run).errors(columns[:rows], true[:rows])
    errors = (clip_jumps(errors) if chosen == "trbdf2" else errors).max(axis=0, initial=0.0)
    if drawn.scene.film.model == "gas_reynolds":
        fine = in_finer_cells(replace(drawn, scene=highest), scales, times, chosen)
        if fine is None:
            return {**row, "why": "finer cells take too long"}
        rows = min(rows, len(fine))
        # What is left of second order has a share of the difference.
        fine = in_order(run.model, reference.model, fine)
        beyond = ErrorScales(run).errors(columns[:rows], fine[:rows]).max(axis=0, initial=0.0)
        errors = np.maximum(errors, beyond * FINER**2 / (FINER**2 - 1.0))
    until = times[rows - 1] if rows < len(times) else drawn.duration
    wrong, depth, instant = contact_errors(contacts, known.contacts or [], until, run, scales.rate)
    best = math.inf
    if costs and drawn.smooth and outcome.status == "ok":
        spent = min([spent, *(automatic(drawn, times)[-1] for _ in range(TIMES - 1))])
        best = hindsight(make, drawn, times, scales, known.columns, rows)
    return {**row, "errors": [*errors.tolist(), depth, instant], "contacts_wrong": wrong, "contacts": len(contacts),
            "estimated": found["estimated"], "met": found["met"], "status": str(outcome.status), "method": method,
            "film": run.model.interface.name, "known": times[known.rows - 1] / drawn.duration, "by": known.found_by,
            "cost": spent, "best": best}  # fmt: skip


def told(row):
    """The largest error over the accuracy, and whether the run said that it is not within it."""
    most = max(row["errors"][: len(QUANTITIES)]) / row["accuracy"]
    spoken = row["status"] != "ok" or row["met"] is not True
    return most, spoken


def said(row) -> str:
    """One line about a scene."""
    most, spoken = told(row)
    estimated = (row["estimated"] or math.nan) / row["accuracy"]
    parts = " ".join(f"{error / row['accuracy']:.2g}" for error in row["errors"])
    verdict = "" if most <= 1.0 and not row["contacts_wrong"] else "SAID " if spoken else "WRONG "
    low = "LOW " if not spoken and most > 0.01 and estimated < 0.3 * most else ""
    return (f"{row['number']} {verdict}{low}asked {row['accuracy']:.1e} estimated {estimated:.2g} errors {parts} "
            f"contacts {row['contacts']}-{row['contacts_wrong']} cost {row['cost']:.2g}/{row['best']:.2g} "
            f"{row['status']} {row['film']} {row['method']} by {row['by']} {','.join(row['words'])}")  # fmt: skip


def main():
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    processes = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    family = sys.argv[4] if len(sys.argv) > 4 else "wide"
    seed = int(sys.argv[5]) if len(sys.argv) > 5 else SEED
    budget = float(sys.argv[6]) if len(sys.argv) > 6 else None
    path = Path(sys.argv[2]) if len(sys.argv) > 2 and sys.argv[2] != "-" else None
    drawn = path is not None and path.suffix == ".png"
    judged = partial(judge, family=family, seed=seed, budget=budget, costs=drawn)
    rows, dropped, number = [], Counter(), 0
    with ProcessPoolExecutor(processes) as pool:
        while len(rows) < wanted:
            count = max(2 * processes, wanted - len(rows))
            for row in pool.map(judged, range(number, number + count)):
                if "why" in row:
                    dropped[row["why"]] += 1
                    print(row["number"], row["why"], ",".join(row["words"]), flush=True)
                elif len(rows) < wanted:
                    rows.append(row)
                    print(said(row), flush=True)
                    if path:
                        # After each scene: a run that is ended leaves what it has found.
                        found = json.dumps(numbers(rows, dropped, seed), indent=1)
                        path.with_suffix(".json").write_text(found + "\n")
            number += count
    print(json.dumps(numbers(rows, dropped, seed), indent=1))
    if drawn:
        draw(rows, path)


def numbers(rows, dropped, seed) -> dict:
    """What the rows of all scenes show together."""
    verdicts = [told(row) for row in rows]
    right = [most <= 1.0 and not row["contacts_wrong"] for row, (most, _) in zip(rows, verdicts, strict=True)]
    spoken = [said for _, said in verdicts]
    claimed = [
        row["estimated"] / (most * row["accuracy"])
        for row, (most, said) in zip(rows, verdicts, strict=True)
        if not said and most > 0.01
    ]
    costs = np.array([row["cost"] / row["best"] for row in rows if math.isfinite(row["best"])])
    return {
        "seed": seed,
        "scenes": len(rows),
        "honest": sum(right),
        "spoken": sum(said and not well for well, said in zip(right, spoken, strict=True)),
        "wrong": sum(not said and not well for well, said in zip(right, spoken, strict=True)),
        "over_asked": sum(spoken),
        # Said not to be as exact as asked, and is.
        "false_alarms": sum(
            well and (row["met"] is False or row["status"] == "inaccurate")
            for well, row in zip(right, rows, strict=True)
        ),
        "dropped": dict(dropped),
        "estimate_over_error": [min(claimed), *np.quantile(claimed, [0.1, 0.5, 0.9]).tolist()] if claimed else [],
        "asked": [min(row["accuracy"] for row in rows), max(row["accuracy"] for row in rows)],
        "median_cost": float(np.median(costs)) if len(costs) else None,
        "smooth": len(costs),
        "own_words": sum(row["by"].startswith("own words") for row in rows),
        "contacts": sum(row["contacts"] for row in rows),
        "contacts_wrong": sum(row["contacts_wrong"] for row in rows),
    }


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    for smooth, colour, marker, label in (
        (True, palette.BLUE, "o", "smooth"),
        (False, palette.ORANGE, "s", "contact or dry friction"),
    ):
        these = [row for row in rows if row["smooth"] == smooth]
        asked = [row["accuracy"] for row in these]
        worst = [max(row["errors"][: len(QUANTITIES)]) for row in these]
        left.loglog(asked, worst, marker, color=colour, ms=4, label=label)
        left.loglog(asked, [row["estimated"] or math.nan for row in these], marker, mfc="none", color=colour, ms=3,
                    alpha=0.5)  # fmt: skip
        dear = [(row["accuracy"], row["cost"] / row["best"]) for row in these if math.isfinite(row["best"])]
        if dear:
            right.loglog(*zip(*dear, strict=True), marker, color=colour, ms=4)
    ends = np.array([min(row["accuracy"] for row in rows), max(row["accuracy"] for row in rows)])
    left.loglog(ends, ends, color=palette.BLACK, lw=1)
    left.annotate("error = accuracy asked", (ends[0], ends[0]), xytext=(4, 10), textcoords="offset points", rotation=28,
                  fontsize=8)  # fmt: skip
    left.set(xlabel="accuracy asked", ylabel="largest error of all quantities",
             title="Filled: true error; hollow: certificate")  # fmt: skip
    left.legend(fontsize=8)
    right.axhline(2.5, color=palette.GREY, ls="--", lw=1)
    right.axhline(1.0, color=palette.BLACK, lw=1)
    right.set(xlabel="accuracy asked", ylabel="cost over the cheapest in hindsight",
              title="Choosing, running and certifying, smooth scenes")  # fmt: skip
    for axes in (left, right):
        axes.grid(True, alpha=0.3)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
