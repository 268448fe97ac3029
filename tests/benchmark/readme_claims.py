"""The README's numbers, computed: passages between `<!-- claims: NAME -->` and `<!-- end -->`.

    python tests/benchmark/readme_claims.py [--check]

Writes each passage from what its study left beside its figure in outputs/gallery: `work-precision` from
work_precision_fmr.h5, `all-scenarios` from work_precision_all.json (written by all_scenarios.py), `honesty` from
honesty.json (written by honesty.py).  A passage without its data is left alone.  --check only says what differs.
"""

import json
import re
import sys
import textwrap
from collections import Counter
from pathlib import Path

from sealdyn.archive import read_study
from sealdyn.report.charts.study_work_precision import SHORT
from sealdyn.studies.work_precision.study import BUSY, LIKE, NAMES

ROOT = Path(__file__).parents[2]
README, GALLERY = ROOT / "README.md", ROOT / "outputs" / "gallery"
# Factors below this may turn on a machine that does something else besides.
CLOSE = 1.5
WORDS = {"end": "at the end", "over_time": "at any time", "steady": "in the steady state"}


# --- the passages: data in, words out ----------------------------------------------------------------


def work_precision(study: dict) -> str:
    """Who is fastest at which error on one scene, how much model it needs, what leaves the chart: three sentences."""
    answer = study["answer"]
    machine, command = answer["machine"], f"sealdyn study work-precision scenarios/{study['name']}.toml"
    where = WORDS[answer["where"]]
    told = [fastest(row, f" {where}" * (k == 0)) for k, row in enumerate(answer["fastest"])]
    return sentences(
        [
            f"`{command}` charts both, on {machine['processor']} with {machine['cores']} cores{strained([machine])}: "
            f"at an error of {'; at '.join(told)}"
        ],
        models(answer["models"]),
        [crosses(answer["methods"], study["settings"]["slowest"]), judged(answer)],
    )


def sentences(*parts: list[str]) -> str:
    """One sentence of each list of clauses; empty ones are left out."""
    told = ["; ".join(clause for clause in clauses if clause) for clauses in parts]
    return "  ".join(f"{capital(line)}." for line in told if line)


def fastest(row: dict, where: str) -> str:
    """One asked error: the fastest method, its time, and by what factor."""
    if row["method"] is None:
        return f"{power(row['error'])}{where} nobody wins ({row['why']})"
    line = f"{power(row['error'])}{where} {NAMES[row['method']]} is fastest, {number(row['wall'] * 1e3)} ms"
    if row["next"] and row["factor_next"] < LIKE:
        line += f", hardly ahead of {NAMES[row['next']]}"
    elif row["next"]:
        line += f", {number(row['factor_next'], 2)} times faster than {NAMES[row['next']]}"
    if row["factor_dop853"] and "dop853" not in (row["method"], row["next"]):
        line += f", {number(row['factor_dop853'], 2)} times faster than {NAMES['dop853']}"
    return line


def strained(machines) -> str:
    """That the machine was busy, if it was."""
    most = max((machine["busy"] for machine in machines if machine["busy"]), default=1.0)
    return f", a busy machine (wall times up to {number(most, 2)} times the processor's)" if most > BUSY else ""


def crosses(methods: dict, slowest: float) -> str:
    """Who leaves the chart for being too slow."""
    gone = [NAMES[name] for name, row in methods.items()
            if any(status in ("stopped", "slow") and "times" in reason
                   for status, reason in zip(row["status"], row["reason"], strict=True))]  # fmt: skip
    if not gone:
        return ""
    return (f"{listed(gone)} {'leave' if len(gone) > 1 else 'leaves'} the chart as crosses, more than "
            f"{number(slowest)} times slower than the fastest at the error they would reach")  # fmt: skip


def models(rungs: list[dict]) -> list[str]:
    """How much model: the first rung of the ladder below an error of the steady state, and where a linear film ends."""
    found = [(row, row["error"]["steady"]) for row in rungs if row["error"]["steady"]]
    said, before = [], None
    for asked in (1e-2, 1e-4):
        row, error = next(((row, error) for row, error in found if error <= asked), (None, None))
        if row and row is not before:
            name = row["label"].replace("balance, ", "balance with ")
            said.append(f"{power(asked)} {name} (error {number(error, 2)}, {number(row['wall'] * 1e3, 2)} ms)")
            before = row
    said = [f"in the steady state this scene needs for {listed(said, ', for ')}"] if said else []
    linear = [error for row, error in found if row["label"].startswith("linear")]
    if linear and len(linear) < len(found):
        said.append(f"the best linear film is wrong by {number(min(linear), 2)} whatever the solver")
    return said


def judged(answer: dict) -> str:
    """By whom, and how sure that is."""
    band = (answer["judge_error"] or {}).get(answer["where"])
    if band is None:
        return ""
    judges = answer["judges"]
    return f"the judge is {judges['exact']}, from which {judges['second']} differs by {number(band, 2)}"


def all_scenarios(page: dict) -> str:
    """Who wins how often over the shipped scenarios, the largest factors, who names no winner: three sentences."""
    scenes, machine = page["scenes"], page["machine"]
    rows = [(scene["name"], row) for scene in scenes for row in scene["fastest"]]
    won = [(name, row) for name, row in rows if row["method"]]
    wins = []
    for error in dict.fromkeys(row["error"] for _, row in rows):
        found = Counter(row["method"] for _, row in won if row["error"] == error)
        ranks = sorted(found.items(), key=lambda pair: (-pair[1], pair[0]))
        wins.append(f"at {power(error)} the fastest is {listed([f'{SHORT[m]} on {n}' for m, n in ranks])}"
                    if ranks else f"at {power(error)} nobody wins")  # fmt: skip
    close = [row for _, row in won if row["factor_next"] and row["factor_next"] < CLOSE]
    tie = f"in {len(close)} of these {len(won)} cases the next is within {number(CLOSE)} times, a tie"
    return sentences(
        [
            f"every shipped scenario on one page, {len(scenes)} of them (`{page['command']}`), on "
            f"{machine['processor']} with {machine['cores']} cores{strained(scenes)}: {wins[0]}",
            *wins[1:],
        ],
        [tie, lead(won)],
        alone(won) + unnamed(rows),
    )


def lead(won) -> str:
    """The largest lead over DOP853."""
    ahead = sorted(
        ((row["factor_dop853"], name, row) for name, row in won if row["factor_dop853"]), key=lambda x: -x[0]
    )
    if not ahead:
        return ""
    factor, name, row = ahead[0]
    least = min(found for found, other, _ in ahead if other == name)
    return (
        f"the largest lead over DOP853 is that of {SHORT[row['method']]} on `{name}`, {number(factor, 2)} times at "
        f"{power(row['error'])}, {number(least, 2)} times at least"
    )


def alone(won) -> list[str]:
    """Scenes that only one method ends well, at every error asked."""
    out = []
    for name in dict.fromkeys(name for name, _ in won):
        found = {row["method"] if row["next"] is None and not row["not_asked"] else None for n, row in won if n == name}
        if len(found) == 1 and None not in found:
            out.append(f"`{name}` ends with {SHORT[found.pop()]} alone")
    return out


def unnamed(rows) -> list[str]:
    """Where no winner is named, by reason."""
    reasons = {}
    for name, row in rows:
        if row["method"] is None:
            why = "the judges differ by too much" if "differ" in row["why"] else row["why"]
            reasons.setdefault(why, {}).setdefault(row["error"], []).append(f"`{name}`")
    told = [f"{why} ({', '.join(f'at {power(error)} {listed(names)}' for error, names in found.items())})"
            for why, found in reasons.items()]  # fmt: skip
    return [f"no winner is named where {listed(told, ' or ')}"] if told else []


def honesty(found: dict) -> str:
    """The automatic choice over random scenes: how often it kept what was asked, and its price."""
    low, high = found["asked"]
    cost, bare = number(found["median_cost"], 2), number(found["median_cost_running"], 2)
    return (
        f"`python tests/benchmark/honesty.py` (seed {found['seed']}): of {found['scenes']} random seals with asked "
        f"accuracies from {power(low)} to {power(high)}, {found['honest']} were run within what was asked, "
        f"{found['linear']} of all on the linear film.  Choosing, running and certifying cost {cost} times (median) "
        f"what the cheapest film, method and tolerance would have, known in hindsight; the run alone {bare} times."
    )


# --- numbers and lists in words ----------------------------------------------------------------------


def number(value: float, digits: int = 3) -> str:
    """To so many digits, without an exponent where one can do without."""
    value = float(f"{value:.{digits}g}")
    return f"{value:g}" if 1e-3 <= abs(value) < 1e6 or value == 0 else f"{value:.{digits - 1}e}".replace("e-0", "e-")


def power(error: float) -> str:
    """An asked error: 1e-6, 2.5e-3."""
    return f"{error:.1e}".replace(".0e", "e").replace("e-0", "e-")


def listed(words: list[str], last: str = " and ") -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])}{last}{words[-1]}"


def capital(words: str) -> str:
    return words[0].upper() + words[1:]


# --- into the README ---------------------------------------------------------------------------------

CLAIMS = {
    "work-precision": (GALLERY / "work_precision_fmr.h5", work_precision),
    "all-scenarios": (GALLERY / "work_precision_all.json", all_scenarios),
    "honesty": (GALLERY / "honesty.json", honesty),
}


def data(name: str) -> dict | None:
    """What a passage is computed from; None if its study has left nothing."""
    path = CLAIMS[name][0]
    if not path.exists():
        return None
    return read_study(path) if path.suffix == ".h5" else json.loads(path.read_text())


def passage(name: str, found: dict) -> str:
    """The passage as it stands in the README."""
    return textwrap.fill(CLAIMS[name][1](found), 120, break_long_words=False, break_on_hyphens=False)


def standing(text: str, name: str) -> str | None:
    """The passage that the README has now; None without its markers."""
    found = _between(name).search(text)
    return found[2].strip("\n") if found else None


def written(text: str, name: str, words: str) -> str:
    """The README with another passage."""
    return _between(name).sub(lambda found: f"{found[1]}\n{words}\n{found[3]}", text)


def _between(name: str):
    return re.compile(rf"(<!-- claims: {re.escape(name)} -->)(.*?)(<!-- end -->)", re.DOTALL)


def main():
    text = before = README.read_text()
    for name, (path, _) in CLAIMS.items():
        found = data(name)
        if found is None or standing(text, name) is None:
            print(f"{name}: {path.name if found is None else 'the marker in the README'} is missing, left alone")
            continue
        fresh = written(text, name, passage(name, found))
        print(f"{name}: {'as computed' if fresh == text else 'differs'}")
        text = fresh
    if "--check" in sys.argv:
        sys.exit(text != before)
    README.write_text(text)


if __name__ == "__main__":
    main()
