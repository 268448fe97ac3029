"""Scenarios, mutated: a value replaced by one that hurts, a key lost or misspelt, tables doubled, bytes changed."""

import random
import re
from functools import partial
from pathlib import Path

from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation.simulate import prepare_run

from .outcome import tried

HOUSE = Path(__file__).parents[3]
SCENARIOS = HOUSE / "scenarios"
# Longest time (s) for making ready: a film may choose many cells.
READY = 120
# Of the scenarios that are read one in so many is made ready.
EVERY = 30
# Numbers that hurt; strings and other things that do.
NUMBERS = (
    "0", "-0.0", "-1", "1", "2", "nan", "inf", "-inf", "1e308", "-1e308", "1e200", "1e100", "1e30", "1e14", "1e-24",
    "1e-30", "1e-200", "1e-320", "5e-324", "1e18", "9223372036854775807", "10000000000", "1" + 400 * "0", "0.5",
    "1e-3", "1e3", "1e6", "1e9", "1e-9",
)  # fmt: skip
OTHERS = (
    '""', '"nan"', '"inf"', '"-inf m"', '"nan rad/s"', "true", "[]", "{}", "[1, 2]", '"x"', '"1e400 m"', '"\\u0000"',
    "1979-05-27", '"auto"', '"10 furlongs"', '"1 um"', '"1e300 bar"', '"5 %"', '"' + 2000 * "m" + '"',
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


def scenarios(ledger, seed, numbers, folder=None) -> None:
    """Mutated scenarios through the reader, of the valid ones one in some made ready to run."""
    texts = healthy()
    for number in numbers:
        chance = random.Random(f"{seed} {number}")
        text = mutated(chance, chance.choice(texts))
        scenario, outcome, how = tried(partial(parse_scenario, text, "attack"))
        ledger.note("scenario read", outcome, how, text)
        if scenario and number % EVERY == 0:
            _, outcome, how = tried(partial(prepare_run, scenario), READY)
            ledger.note("scenario made ready", outcome, how, text)
