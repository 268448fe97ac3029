"""Archives whose attributes are of another kind than the program writes: one line or an answer, from every verb."""

import json
import random
import shutil

import h5py
import numpy as np
import pytest
from benchmark.attack.archives import altered
from command import SCENARIOS, sealdyn

from sealdyn.archive import read_info
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate

SHORT = ("run.turns=3", "run.samples_per_turn=16")
VERBS = {
    "show": ["show"],
    "show as JSON": ["show", "--json"],
    "compare": ["compare"],
    "compare as JSON": ["compare", "--json"],
    "report": ["report"],
    "check": ["check"],
}
ARRAY = json.dumps({"value": {"array": [1e-6, 2e-6]}})
ODD = {
    "numbers that are arrays": {
        "summary": lambda words: words.replace('"value": ', '"value": {"array": [1, 2]}, "was": ')
    },
    "a summary that is an array": {"summary": '{"array": [1, 2, 3]}'},
    "a summary that is a list": {"summary": "[1, 2]"},
    "a summary that is a number": {"summary": 3},
    "a name that is a number": {"name": 5},
    "a name that is JSON": {"name": '{"array": [1]}'},
    "a question that is a row": {"question": np.arange(3)},
    "a version that is a number": {"version": 7},
    "a creation in numbers": {"created": 2026},
    "overrides that are numbers": {"overrides": "[1, 2]"},
    "overrides that are a table": {"overrides": '{"a": 1}'},
    "libraries that are a word": {"libraries": "numpy"},
    "resolved that is a list": {"resolved": "[]"},
    "a title of two": {"title": np.array(["a", "b"], "S1")},
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("odd")
    simulate(read_scenario(SCENARIOS / "fms_reference.toml", SHORT), folder / "whole.h5")
    return folder / "whole.h5"


def with_attributes(whole, path, given: dict):
    shutil.copyfile(whole, path)
    with h5py.File(path, "r+") as file:
        for name, value in given.items():
            value = value(file.attrs[name]) if callable(value) else value
            del file.attrs[name]
            file.attrs[name] = value
        # A stranger seals nothing.
        del file.attrs["seal"]
    return path


def ends_well(verb, path, whole, folder):
    more = [whole] if verb.startswith("compare") else ["--out", folder / "page.html"] if verb == "report" else []
    word, *flags = VERBS[verb]
    answer = sealdyn(word, path, *more, *flags, cwd=folder)
    assert answer.code in (0, 2) and "Traceback" not in answer.err, (verb, answer.err)
    if answer.code == 2:
        lines = [
            line for line in answer.err.splitlines() if not line.startswith("first run") and " remaining" not in line
        ]
        assert len(lines) == (0 if "--json" in flags else 1), lines


@pytest.mark.parametrize("kind", ODD)
def test_attributes_of_another_kind(kind, whole, tmp_path):
    path = with_attributes(whole, tmp_path / "odd.h5", ODD[kind])
    for verb in VERBS:
        ends_well(verb, path, whole, tmp_path)


def test_numbers_that_are_arrays_stay_tables(whole, tmp_path):
    """Only what a run goes on from has arrays."""
    path = with_attributes(whole, tmp_path / "odd.h5", {"summary": ARRAY})
    assert read_info(path)["summary"] == json.loads(ARRAY)


@pytest.mark.parametrize("seed", range(3))
def test_a_draw_of_altered_words(seed, whole, tmp_path):
    """As tests/benchmark/attack/archives.py, of which this is a few."""
    chance = random.Random(f"odd {seed}")
    given = {chance.choice(("summary", "resolved", "summary", "libraries")): lambda words: altered(chance, words)}
    path = with_attributes(whole, tmp_path / "odd.h5", given)
    for verb in ("show", "compare as JSON", "report"):
        ends_well(verb, path, whole, tmp_path)
