"""outputs/gallery/README.md: every committed picture with the command that draws it, and what was measured.

    python tests/benchmark/gallery.py

The tables are computed from the data beside the pictures: work_precision_fmr.h5 and failures.h5 (archives of their
studies), work_precision_all.json (all_scenarios.py), quickness.json (quickness.py), honesty.json, honesty_gas.json,
honesty_reynolds.json, honesty_gas_reynolds.json and honesty_all.json (honesty.py), robustness.jsonl (robustness.py).
The captions stand in
gallery.md.
"""

import json
from collections import Counter
from pathlib import Path

from sealdyn.archive import read_study
from sealdyn.report.charts.study_work_precision import SHORT
from sealdyn.studies.work_precision import NAMES

GALLERY = Path(__file__).parents[2] / "outputs" / "gallery"
PAGE = GALLERY / "README.md"
CAPTIONS = Path(__file__).with_name("gallery.md")


def page() -> str:
    """The captions, each `{{ name }}` replaced by the table of that name."""
    text = CAPTIONS.read_text()
    for rows in (fastest, models, machine, quickness, scenarios, honesty, failures, robustness):
        head, *below = [f"| {' | '.join(row)} |" for row in rows()]
        lines = [head, "|---" * (head.count(" | ") + 1) + "|", *below]
        text = text.replace("{{ " + rows.__name__ + " }}", "\n".join(lines))
    return text


def number(value: float | None, digits: int = 2) -> str:
    return "-" if value is None else f"{float(f'{value:.{digits}g}'):g}"


def fastest():
    """The fastest method on the reference scene at each error."""
    answer = read_study(GALLERY / "work_precision_fmr.h5")["answer"]
    yield "error at any time", "fastest", "processor time, ms", "next", "next / fastest", "DOP853 / fastest"
    for row in answer["fastest"]:
        names = [NAMES.get(row[key], "-") for key in ("method", "next")]
        yield (f"{row['error']:.0e}", names[0], number(row["processor"] * 1e3, 3), names[1], number(row["factor_next"]),
               number(row["factor_dop853"]))  # fmt: skip


def models():
    """Film models on the reference scene: error of the steady state and processor time."""
    yield "model", "error of the steady state", "processor time, ms"
    for row in read_study(GALLERY / "work_precision_fmr.h5")["answer"]["models"]:
        yield row["label"], number(row["error"]["steady"]), number(row["processor"] * 1e3)


def machine():
    """What the reference scene was measured on."""
    study = read_study(GALLERY / "work_precision_fmr.h5")
    answer = study["answer"]
    yield "reference solution", "second, and its difference", "machine", "solvers"
    judges, on = answer["judges"], answer["machine"]
    yield (judges["exact"], f"{judges['second']}, {number(answer['judge_error'][answer['where']])}",
           f"{on['processor']}, {on['cores']} cores", study.get("solvers", "of no name"))  # fmt: skip


def quickness():
    """What it costs to begin, to be many, to be whole: ratios and their goals."""
    found = json.loads((GALLERY / "quickness.json").read_text())
    on = found["machine"]
    libraries = ", ".join(f"{name} {on[name]}" for name in ("python", "numba", "numpy", "scipy"))
    yield "figure", "ratio", "goal", "s", "over, s"
    for name, row in found["rows"].items():
        yield name, number(row["ratio"], 3), number(row["goal"]), number(row["seconds"], 3), number(row["over"], 3)
    busy = f"{on['cores']} cores under a load of {number(on['load'])}"
    yield f"{on['date']}, {on['processor']}, {busy}; {libraries}; solvers {on['solvers']}", *4 * ("",)


def scenarios():
    """The fastest method on each shipped scenario, with its lead over the next and over DOP853."""
    scenes = json.loads((GALLERY / "work_precision_all.json").read_text())["scenes"]
    yield "scenario", *(f"at {row['error']:.0e}" for row in scenes[0]["fastest"])
    for scene in (one for one in scenes if any(row["method"] for row in one["fastest"])):
        yield scene["name"], *map(winner, scene["fastest"])


def winner(row: dict) -> str:
    """Method, how many times faster than the next, how many times faster than DOP853, as far as these got there; "-"
    where none is known."""
    factors = (row.get("factor_next"), row.get("factor_dop853"))
    return ", ".join([SHORT.get(row["method"], "-"), *(number(factor) for factor in factors if factor)])


def honesty():
    """The automatic choice on random scenes of every family."""
    found = [json.loads((GALLERY / f"{name}.json").read_text()) for name in FAMILIES.values()]
    yield "measured", *FAMILIES
    for measured, told in HONESTY.items():
        yield measured, *map(told, found)


def _drawn_anew(found) -> str:
    return ", ".join(str(found["dropped"].get(why, 0)) for why in ("known for less than a turn", "not judged"))


# Families of random scenes and the names of their data; what is told of each.
FAMILIES = {"all liquids": "honesty", "gas dams": "honesty_gas", "films that tear": "honesty_reynolds",
            "gas that stores": "honesty_gas_reynolds", "every family in turn": "honesty_all"}  # fmt: skip
HONESTY = {
    "seed, random scenes": lambda found: f"{found['seed']}, {found['scenes']}",
    "drawn anew: known for less than a turn, or no two references": _drawn_anew,
    "judged by equations of their own": lambda found: str(found["own_words"]),
    "asked accuracies": lambda found: " to ".join(number(asked) for asked in found["asked"]),
    "runs right in everything within the asked accuracy": lambda found: str(found["honest"]),
    "wrong, and saying so; wrong without a word": lambda found: f"{found['spoken']}; {found['wrong']}",
    "ended without a promise (collapsed, or not as exact as asked)": lambda found: str(found["over_asked"]),
    "of these right nevertheless": lambda found: str(found.get("false_alarms", "not counted")),
    "contacts, missed or too many": lambda found: f"{found['contacts']}, {found['contacts_wrong']}",
    "estimate over true error above a hundredth of the accuracy: least, 10 %, median, 90 %": lambda found: ", ".join(
        map(number, found["estimate_over_error"])
    ),
    "cost over the cheapest in hindsight, median": lambda found: (
        number(found["median_cost"]) if found["median_cost"] else "not found"
    ),
    "of so many smooth scenes": lambda found: str(found["smooth"]),
}


def failures():
    """The method that fails and the one that survives."""
    yield "place", "method that fails", "its error", "method that survives", "its error", "unit"
    for row in read_study(GALLERY / "failures.h5")["answer"]["rows"]:
        yield (f"{row['item']} {row['title']}", row["failing"], number(row["failing_error"]), row["survivor"],
               number(row["survivor_error"]), row["unit"])  # fmt: skip


def robustness():
    """What came from outside, and how it went."""
    yield "attack", "attempts", "how they went", "came through", "hours", "code"
    kinds, hours, codes, slowest, beside = {}, {}, {}, {}, {}
    for line in (GALLERY / "robustness.jsonl").read_text().splitlines():
        batch = json.loads(line)
        for name, count in batch["counts"].items():
            what, _, outcome = name.partition(": ")
            if not outcome:
                beside[what] = beside.get(what, 0) + count
                continue
            if outcome.endswith("(ms)"):
                slowest[what] = max(slowest.get(what, 0), count)
                continue
            kinds.setdefault(what, Counter())[outcome] += count
            codes.setdefault(what, {})[batch.get("code") or "before"] = None
            hours[what] = hours.get(what, 0.0) + batch["seconds"] / 3600 / len(batch["counts"])
    for what, outcomes in kinds.items():
        went = ", ".join(f"{outcome} {count}" for outcome, count in outcomes.items() if outcome != "escaped")
        code = ", ".join(codes[what])
        yield what, str(outcomes.total()), went, str(outcomes["escaped"]), number(hours[what]), code
    for what, count in beside.items():
        yield what, str(count), "-", "-", "-", "-"
    for what, most in slowest.items():
        yield f"{what}, slowest", "-", f"{most / 1e3:.1f} s of processor time", "-", "-", "-"


if __name__ == "__main__":
    PAGE.write_text(page())
