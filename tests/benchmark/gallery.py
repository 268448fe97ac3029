"""outputs/gallery/README.md: every committed picture with the command that draws it, and what was measured.

    python tests/benchmark/gallery.py

The tables are computed from the data beside the pictures: work_precision_fmr.h5 and failures.h5 (archives of their
studies), work_precision_all.json (all_scenarios.py), honesty.json, honesty_reynolds.json, honesty_gas.json and
honesty_gas_reynolds.json (honesty.py), robustness.jsonl (robustness.py).  The captions stand in gallery.md.
"""

import json
from collections import Counter
from pathlib import Path

from sealdyn.archive import read_study
from sealdyn.report.charts.study_work_precision import SHORT
from sealdyn.studies.work_precision.study import NAMES

GALLERY = Path(__file__).parents[2] / "outputs" / "gallery"
PAGE = GALLERY / "README.md"
CAPTIONS = Path(__file__).with_name("gallery.md")


def page() -> str:
    """The captions, each `{{ name }}` replaced by the table of that name."""
    text = CAPTIONS.read_text()
    for rows in (fastest, models, machine, scenarios, *FAMILIES, failures, robustness):
        head, *below = [f"| {' | '.join(row)} |" for row in rows()]
        lines = [head, "|---" * (head.count(" | ") + 1) + "|", *below]
        text = text.replace("{{ " + rows.__name__ + " }}", "\n".join(lines))
    return text


def number(value: float | None, digits: int = 2) -> str:
    return "-" if value is None else f"{value:.{digits}g}"


def fastest():
    """The fastest method on the reference scene at each error."""
    answer = read_study(GALLERY / "work_precision_fmr.h5")["answer"]
    yield "error at any time", "fastest", "wall time, ms", "next", "next / fastest", "DOP853 / fastest"
    for row in answer["fastest"]:
        names = [NAMES.get(row[key], "-") for key in ("method", "next")]
        yield (f"{row['error']:.0e}", names[0], number(row["wall"] * 1e3, 3), names[1], number(row["factor_next"]),
               number(row["factor_dop853"]))  # fmt: skip


def models():
    """Film models on the reference scene: error of the steady state and wall time."""
    yield "model", "error of the steady state", "wall time, ms"
    for row in read_study(GALLERY / "work_precision_fmr.h5")["answer"]["models"]:
        yield row["label"], number(row["error"]["steady"]), number(row["wall"] * 1e3)


def machine():
    """What the reference scene was measured on."""
    answer = read_study(GALLERY / "work_precision_fmr.h5")["answer"]
    yield "reference solution", "second, and its difference", "machine"
    judges, on = answer["judges"], answer["machine"]
    yield (judges["exact"], f"{judges['second']}, {number(answer['judge_error'][answer['where']])}",
           f"{on['processor']}, {on['cores']} cores")  # fmt: skip


def scenarios():
    """The fastest method on each shipped scenario, with its lead over the next and over DOP853."""
    scenes = json.loads((GALLERY / "work_precision_all.json").read_text())["scenes"]
    yield "scenario", *(f"at {row['error']:.0e}" for row in scenes[0]["fastest"])
    for scene in scenes:
        yield f"`{scene['name']}`", *map(winner, scene["fastest"])


def winner(row: dict) -> str:
    """Method, how many times faster than the next, how many times faster than DOP853."""
    if row["method"] is None:
        return f"none: {row['why'].replace('judges', 'reference solutions')}"
    return f"{SHORT[row['method']]}, {number(row['factor_next'])}, {number(row['factor_dop853'])}"


def honesty():
    """The automatic choice on random scenes."""
    yield from _honesty("honesty.json")


def honesty_reynolds():
    """The same with films that tear."""
    yield from _honesty("honesty_reynolds.json")


def honesty_gas():
    """The same with gas dams."""
    yield from _honesty("honesty_gas.json")


def honesty_gas_reynolds():
    """The same with gas that stores."""
    yield from _honesty("honesty_gas_reynolds.json")


def _honesty(name):
    found = json.loads((GALLERY / name).read_text())
    least, low, middle, high = map(number, found["estimate_over_error"])
    yield "measured", "value"
    yield "seed, random scenes", f"{found['seed']}, {found['scenes']}"
    yield (
        "drawn anew: known for less than a turn, or no two references",
        (", ".join(str(found["dropped"].get(why, 0)) for why in ("known for less than a turn", "not judged"))),
    )
    yield "judged by equations of their own", str(found["own_words"])
    yield "asked accuracies", " to ".join(number(asked) for asked in found["asked"])
    yield "runs right in everything within the asked accuracy", str(found["honest"])
    yield "wrong, and saying so; wrong without a word", f"{found['spoken']}; {found['wrong']}"
    yield "runs that ended without a promise (collapsed, or not as exact as asked)", str(found["over_asked"])
    yield "contacts of the faces, missed or too many", f"{found['contacts']}, {found['contacts_wrong']}"
    yield (
        "estimate over true error where that exceeds a hundredth of the accuracy: least, 10 %, median, 90 %",
        f"{least}, {low}, {middle}, {high}",
    )
    yield (
        "cost of choosing, running and certifying over the cheapest in hindsight, median of "
        f"{found['smooth']} smooth scenes",
        number(found["median_cost"]),
    )


def failures():
    """The method that fails and the one that survives."""
    yield "place", "method that fails", "its error", "method that survives", "its error", "unit"
    for row in read_study(GALLERY / "failures.h5")["answer"]["rows"]:
        yield (f"{row['item']} {row['title']}", row["failing"], number(row["failing_error"]), row["survivor"],
               number(row["survivor_error"]), row["unit"])  # fmt: skip


def robustness():
    """What came from outside, and how it went."""
    yield "attack", "attempts", "how they went", "came through", "hours"
    kinds, hours = {}, {}
    for line in (GALLERY / "robustness.jsonl").read_text().splitlines():
        batch = json.loads(line)
        for name, count in batch["counts"].items():
            what, outcome = name.split(": ", 1)
            kinds.setdefault(what, Counter())[outcome] += count
            hours[what] = hours.get(what, 0.0) + batch["seconds"] / 3600 / len(batch["counts"])
    for what, outcomes in kinds.items():
        went = ", ".join(f"{outcome} {count}" for outcome, count in outcomes.items() if outcome != "escaped")
        yield what, str(outcomes.total()), went, str(outcomes["escaped"]), number(hours[what])


FAMILIES = honesty, honesty_reynolds, honesty_gas, honesty_gas_reynolds

if __name__ == "__main__":
    PAGE.write_text(page())
