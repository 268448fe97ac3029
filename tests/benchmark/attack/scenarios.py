"""Scenarios, mutated: a value replaced by one that hurts, a key lost or misspelt, tables doubled, bytes changed; keys
of the schema drawn at random; texts, `--set` and tables of Python that are too deep, too long or none."""

import random
import re
import time
from functools import cache, partial
from pathlib import Path

from sealdyn.analysis.desk import checked
from sealdyn.scenario.errors import is_list, tables
from sealdyn.scenario.reader import Scenario, parse_scenario
from sealdyn.scenario.tables import RadialFile, ScenarioFile
from sealdyn.simulation.plausibility import refuse_large, size_of, unit_warnings
from sealdyn.units import quantity_of

from .outcome import command, judged, tried

HOUSE = Path(__file__).parents[3]
SCENARIOS = HOUSE / "scenarios"
# Longest time (s) for reading one, and for checking it, which may compile a film first.
READY, CHECKED = 20, 120
# Of the scenarios that are read one in so many is checked whole, and one in so many goes through the command line.
EVERY, TYPED = 30, 100
# Numbers that hurt; strings and other things that do.
NUMBERS = (
    "0", "-0.0", "-1", "1", "2", "nan", "inf", "-inf", "1e308", "-1e308", "1e200", "1e100", "1e30", "1e14", "1e-24",
    "1e-30", "1e-200", "1e-320", "5e-324", "1e18", "9223372036854775807", "10000000000", "1" + 400 * "0", "0.5",
    "1e-3", "1e3", "1e6", "1e9", "1e-9", "0x" + 4000 * "f", 5000 * "9", "1_000", "0b1", "1e99999",
)  # fmt: skip
OTHERS = (
    '""', '"nan"', '"inf"', '"-inf m"', '"nan rad/s"', "true", "[]", "{}", "[1, 2]", '"x"', '"1e400 m"', '"\\u0000"',
    "1979-05-27", '"auto"', '"10 furlongs"', '"1 um"', '"1e300 bar"', '"5 %"', '"' + 2000 * "m" + '"',
    '"\\u001b[2J"', "10 um", "3000 rpm", "{ time = [0, 1], value = [0, 1] }", "[[[[[[1]]]]]]", "{ a = { a = 1 } }",
    '"' + 3000 * "1" + ' m"', '"' + 900 * "1 " + '"', "[" + "1," * 3000 + "]", '["1 m", 2]', '"1 m/s/m*kg^9"',
    '"' + "(" * 50 + 'm"', '"1 m^99999999"', "[" * 2000,
)  # fmt: skip
VALUE = re.compile(r"^(\s*[\w.]+\s*=\s*)(.+)$", re.M)


def healthy() -> list[str]:
    """The scenarios that are mutated: those that come with the program, and those that `sealdyn new` writes."""
    templates = HOUSE / "sealdyn" / "scenario" / "templates"
    return [path.read_text() for folder in (SCENARIOS, templates) for path in sorted(folder.glob("*.toml"))]


def mutated(random, text) -> str:
    """A scenario with one to three things wrong, or only strange."""
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        lines = text.split("\n")
        places = [k for k, line in enumerate(lines) if VALUE.match(line)]
        if not places:
            return text
        k, way = random.choice(places), random.random()
        head, value = VALUE.match(lines[k]).groups()
        unit = re.match(r'"[-+.\deE ]*(.*)"', value)
        if way < 0.45:
            number = random.choice(NUMBERS)
            lines[k] = head + (f'"{number} {unit.group(1)}"' if unit and random.random() < 0.8 else number)
        elif way < 0.65:
            lines[k] = head + random.choice(OTHERS)
        elif way < 0.75:
            del lines[k]
        elif way < 0.82:
            at = random.randrange(len(head))
            lines[k] = head[:at] + random.choice("abz_.-=[ ") + head[at + 1 :] + value
        elif way < 0.9:
            lines.insert(random.choice(places), lines[k])
        elif way < 0.95:
            tables = [j for j, line in enumerate(lines) if line.startswith("[")]
            lines[random.choice(tables)] = random.choice(
                ("[run]", "[contact]", "[[stator.waviness]]", "[film.gas]", "[x]")
            )
        else:
            at = random.randrange(max(1, len(text)))
            return text[:at] + chr(random.choice((0, 10, 34, 39, 91, 127, 233, 0x1F600))) + text[at + 1 :]
        text = "\n".join(lines)
    return text


def endless(random, text) -> str:
    """A scenario with something in it that is deep, long or many."""
    many = random.choice((30, 300, 3000, 30_000))
    line = random.choice((
        lambda: ".".join(["a"] * many) + " = 1", lambda: "'b c'." * many + "a = 1", lambda: "x = " + "[" * many,
        lambda: "x = " + "{a=" * many, lambda: "[" + ".".join(["a"] * many) + "]", lambda: "a" * many + " = 1",
        lambda: "x = " + "1" * many, lambda: "x = " + "1" * many + " mm", lambda: "[" + " " * many + "x",
        lambda: "x = '" + "1 " * many + "'", lambda: "\n".join(f"a{n} = 1" for n in range(many)),
        lambda: "[[housing.axial]]\n" * many, lambda: "[[film.pads]]\n" * many, lambda: "x = [" + "1," * many + "]",
        lambda: "study.sweep.vary = '" + "x" * many + "'", lambda: "[study." + "y" * many + "]", lambda: "\ud800",
        lambda: "study.tolerance.samples = 0x" + "f" * many, lambda: "#" + "'" * many, lambda: '"' * many,
        lambda: "application.acknowledge." + "z" * many + " = 'why'", lambda: "film.gas." + "q." * (many // 30) + "a=1",
    ))()  # fmt: skip
    lines = text.split("\n")
    lines.insert(random.randrange(len(lines)), line)
    return "\n".join(lines)


@cache
def keys() -> list[tuple[str, str]]:
    """Every dotted key of the schema, with the unit of what it holds."""
    found = []
    for kind in (ScenarioFile, RadialFile):
        every = tables(kind)
        for table, held in every.items():
            for key, holds in held.items():
                path, quantity = f"{table}.{key}".strip("."), quantity_of(holds)
                steps = path.split(".")
                for n in range(len(steps) - 1, 0, -1):
                    above, last = ".".join(steps[: n - 1]), steps[n - 1]
                    if is_list(every.get(above, {}).get(last)):
                        steps.insert(n, "0")
                found.append((".".join(steps), quantity.unit if quantity else ""))
    return found


def drawn(random) -> list[str]:
    """One to three settings as `--set` has them, of any keys of the schema, sometimes of none."""
    found = []
    for _ in range(random.choice((1, 1, 2, 3))):
        key, unit = random.choice(keys())
        way = random.random()
        number = random.choice((*NUMBERS, f"{10 ** random.uniform(-12, 12):.3g}", f"{random.uniform(-10, 10):.3g}"))
        value = f"{number} {unit}" if way < 0.4 and unit else number if way < 0.7 else random.choice(OTHERS).strip('"')
        if way > 0.95:
            key = random.choice((key[:-1], f"{key}.0", f"{key}.\udcff", key.upper(), "a." * 3000 + "a", "", key * 50))
        found.append(random.choice((f"{key}={value}",) * 9 + (key, f"={value}", f"{key}=\ud800", "[" * 3000)))
    return found


def made(random, depth=0):
    """A value that only Python can give."""
    if depth < 4 and random.random() < 0.5:
        keys = ("time", "value", "file", "a", None, 3, "\ud800", "k" * 300, b"x", ())
        return {random.choice(keys): made(random, depth + 1) for _ in range(random.randrange(4))}
    held = []
    held.append(held)
    deep = 1
    for _ in range(random.choice((5, 50, 5000))):
        deep = [deep]
    return random.choice((held, deep, None, 10**5000, float("nan"), b"x", object(), {1, 2}, [1, None], "\x1b[2J", 1j,
                          (), [[]], True, "1 mm", 1e-5, range(3)))  # fmt: skip


def scenarios(ledger, seed, numbers, folder=None) -> None:
    """Mutated scenarios through the reader; of the valid ones all are asked how large and usual their numbers are, one
    in EVERY is checked whole, and of all one in TYPED is checked by the command (with a folder)."""
    texts = healthy()
    for number in numbers:
        chance = random.Random(f"{seed} {number}")
        text, overrides, more = chance.choice(texts), [], None
        way = chance.random()
        if way < 0.7:
            text = mutated(chance, text)
        elif way < 0.78:
            text = endless(chance, text)
        elif way < 0.93:
            overrides = drawn(chance)
        else:
            more = {chance.choice((*[key for key, _ in keys()], "film", "run", None, 3, "a")): made(chance)}
        # Tables of Python may be such as no text holds.
        example = f"{number}: {overrides or text!r}"[:5000]
        begun = time.process_time()
        scenario, outcome, how = tried(partial(_read, text, overrides, more), READY)
        ledger.note("scenario read", outcome, how, example)
        if scenario:
            _, outcome, how = tried(partial(_sized, scenario), READY)
            ledger.note("scenario sized", outcome, how, example)
        if scenario and number % EVERY == 0:
            _, outcome, how = tried(partial(checked, scenario), CHECKED)
            ledger.note("scenario checked", outcome, how, example)
        ledger.slowest("scenario", time.process_time() - begun, f"{number}")
        if folder and number % TYPED == 0:
            (folder / "typed.toml").write_text(text, errors="surrogatepass")
            words = [word for override in overrides for word in ("--set", override.replace("\0", ""))]
            safe = [word.encode("utf-8", "surrogateescape" if "\udcff" in word else "replace") for word in words]
            code, _, error = command("check", folder / "typed.toml", *map(_argument, safe), patience=120)
            # A line for each thing that is wrong.
            outcome, how = judged(code, error, most=60)
            ledger.note("scenario typed", outcome, how, example)


def _argument(word: bytes) -> str:
    return word.decode("utf-8", "surrogateescape")


def _read(text, overrides, more) -> Scenario:
    scenario = parse_scenario(text, "attack", overrides)
    return scenario.with_(more) if more else scenario


def _sized(scenario):
    refuse_large(scenario, True)
    return size_of(scenario), unit_warnings(scenario), scenario.resolved(), scenario.unused(), hash(scenario.given)
