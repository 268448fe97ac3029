"""Settings of studies that hurt: numbers that are none, counts below one or beyond measure, words in their place."""

import dataclasses
import random
from pathlib import Path

from sealdyn.studies import study_names
from sealdyn.studies._runner import study_module

from .outcome import SLOW, command, judged

SEAL = Path(__file__).parents[3] / "scenarios" / "fms_reference.toml"
VALUES = (
    "nan", "inf", "-inf", "-1", "0", "1e308", "-1e308", "1e-320", "1" + 40 * "0", "1000000000000000000", "1e18", "0.5",
    "true", "null", "[]", "{}", "[[]]", "{\"a\": 1}", "[" * 100_000, "x", "", "é", "\"nan\"", "10 furlongs",
    "1:2:1000000000",
    "film.clearance=1:2 um:1000000000", "film.clearance=1:2 um:0", "film.clearance=", "=", "film.clearance=nan,1",
    "nothing=1,2", "1,nan", "1 rad/s, inf", "x" * 5000, "film.clearance=2:1:3:log", "0:0:5", "-5 um", "1e400",
)  # fmt: skip
# Long enough (s) to refuse: what is begun may go on.
PATIENCE = 6


def settings(ledger, seed, numbers, folder: Path) -> None:
    """Every setting of every study with each of these values, in an order of chance."""
    every = []
    for name in study_names():
        kind = study_module(name.replace("-", "_")).Settings
        every += [(name, field.name, value) for field in dataclasses.fields(kind) for value in VALUES]
    random.Random(seed).shuffle(every)
    for name, key, value in every[numbers[0] : numbers[-1] + 1]:
        out = folder / "study.h5"
        words = ("study", name, SEAL, f"--{key.replace('_', '-')}={value}", "--no-plot", "--workers", 1, "--out", out)
        code, _, error = command(*words, "--set", "run.turns=2", patience=PATIENCE)
        outcome, how = ("begun", "") if code == SLOW else judged(code, error)
        ledger.note("setting of a study", outcome, how and f"{name} {key}={value[:30]}: {how}", error)
        for left in folder.glob("*study*"):
            left.unlink()
