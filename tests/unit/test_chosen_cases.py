"""Which cases a plain run takes, on a made-up suite: the cheapest of each file, core ones, those not yet measured."""

import json
import re
from pathlib import Path

import mpmath
import numpy as np
import pytest

pytest_plugins = ["pytester"]
CONFTEST = Path(__file__).parents[1] / "conftest.py"
FILE = """
import pytest
from spending import spend

@pytest.fixture(scope="module")
def shared():
    spend(0.2)

def test_cheap(): pass
@pytest.mark.parametrize("seconds", [0.1, 0.3])
def test_dear(seconds): spend(seconds)
@pytest.mark.core
def test_core(): spend(0.2)
def test_one(shared): pass
def test_two(shared): spend(0.06)
@pytest.mark.slow
def test_slow(): pass
"""
SPENDING = """
import time

def spend(seconds):
    end = time.process_time() + (seconds if SPEND else 0.0)
    while time.process_time() < end:
        pass
"""
CASES = ["cheap", "dear[0.1]", "dear[0.3]", "core", "one", "two", "slow"]
TIMES = {"test_dear[0.1]": 0.1, "test_dear[0.3]": 0.3, "test_core": 0.2, "@shared": 0.2, "test_two": 0.06}


@pytest.fixture
def suite(pytester):
    """A suite of two equal files with this mechanism."""
    pytester.makeconftest(CONFTEST.read_text().replace("import sealdyn ", "# "))
    pytester.makeini("[pytest]\nmarkers =\n    core\n    slow\n")
    pytester.makepyfile(test_a=FILE, test_b=FILE, spending="SPEND = False\n" + SPENDING)
    return pytester


def allow(suite, seconds, times):
    files = {f"{name}.py": times for name in ("test_a", "test_b")}
    (suite.path / "durations.json").write_text(json.dumps({"seconds_a_file": seconds, "files": files}))


def ran(suite, *words):
    """Cases of each file that run, and what the last lines say of those left out."""
    # What is measured has a process of its own: its collector of garbage sees nothing of the cases before.
    way = suite.runpytest_subprocess if {"2", "--measure"} & {*words} else suite.runpytest_inprocess
    result = way("-v", *words)
    passed = re.findall(
        r"(test_[ab])\.py::test_(\S+) PASSED|PASSED \S* *test_([ab])\.py::test_(\S+)", result.stdout.str()
    )
    found = {"a": [], "b": []}
    for file, name, other_file, other_name in passed:
        found[(file or other_file)[-1]].append(name or other_name)
    left = re.search(r"(\d+) of (\d+) cases left out", result.stdout.str())
    return {file: sorted(names) for file, names in found.items()}, left and (int(left[1]), int(left[2]))


@pytest.mark.core
def test_everything_not_measured_runs(suite):
    found, left = ran(suite)
    assert found["a"] == found["b"] == sorted(set(CASES) - {"slow"}) and left == (2, 14)


@pytest.mark.parametrize(
    "seconds, kept",
    [
        # The cheap `one` needs a dear fixture.
        (0.0, {"cheap", "core"}),
        (0.47, {"cheap", "core", "dear[0.1]"}),
        # It has paid for the fixture: 0.5 s are spent before `two`.
        (0.53, {"cheap", "core", "dear[0.1]", "one"}),
        (0.57, {"cheap", "core", "one", "two", "dear[0.1]"}),
        (1.0, set(CASES) - {"slow"}),
    ],
)
def test_a_file_runs_core_unmeasured_and_its_cheapest_cases(suite, seconds, kept):
    allow(suite, seconds, TIMES)
    found, left = ran(suite)
    assert found["a"] == found["b"] == sorted(kept) and left == (2 * (7 - len(kept)), 14)


def test_a_shared_fixture_is_paid_once(suite):
    """Both users of the fixture are dropped when it cannot be paid; paid by one, the other costs its own time."""
    times = TIMES | {"test_one": 0.05}
    for seconds, kept in [(0.4, {"dear[0.1]"}), (0.55, {"dear[0.1]", "one"}), (0.61, {"dear[0.1]", "one"})]:
        allow(suite, seconds, times)
        assert set(ran(suite)[0]["a"]) == kept | {"cheap", "core"}


def test_the_longest_file_begins_and_stays_whole(suite):
    """Two processes each take one file: a shared fixture is set up once a file."""
    files = {"test_a.py": {}, "test_b.py": {"@shared": 0.2}}
    (suite.path / "durations.json").write_text(json.dumps({"seconds_a_file": 1.0, "files": files}))
    lines = suite.runpytest_inprocess("-v", "--all", "-n", "0").stdout.str()
    assert lines.index("test_b.py::test_cheap") < lines.index("test_a.py::test_cheap")
    lines = suite.runpytest_subprocess("-v", "--all", "-n", "2", "--dist", "loadfile", "--no-loadscope-reorder")
    processes = set(re.findall(r"\[(gw\d)\].* PASSED (test_[ab])", lines.stdout.str()))
    assert len(processes) == 2


def test_all_rest_and_what_is_named(suite):
    allow(suite, 0.0, TIMES | {"test_one": 0.05})
    plain, everything, rest = (ran(suite, *words)[0]["a"] for words in ([], ["--all"], ["--rest"]))
    assert everything == sorted(CASES) and sorted(plain + rest) == everything and set(plain) == {"cheap", "core"}
    assert ran(suite, "test_b.py") == ({"a": [], "b": sorted(CASES)}, None)
    assert ran(suite, "test_b.py::test_slow")[0] == {"a": [], "b": ["slow"]}
    assert ran(suite, "-k", "two")[0] == {"a": ["two"], "b": ["two"]}
    assert ran(suite, "-m", "slow")[0] == {"a": ["slow"], "b": ["slow"]}


@pytest.mark.parametrize("processes", ["0", "2"])
def test_measured_times_choose_the_next_plain_run(suite, processes):
    """A budget below all: the dearest case of each file is left out, in one process and in two."""
    conftest = suite.path / "conftest.py"
    suite.makepyfile(spending="SPEND = True\n" + SPENDING)
    conftest.write_text(conftest.read_text().replace("SECONDS, CHEAP = 215.0", "SECONDS, CHEAP = 1.5"))
    alike = ["-n", processes, "--dist", "loadfile"] if processes != "0" else ["-n", "0"]
    everything, left = ran(suite, "--measure", *alike)
    assert everything["a"] == everything["b"] == sorted(CASES) and left is None
    found = json.loads((suite.path / "durations.json").read_text())
    for times in found["files"].values():
        for name, seconds in TIMES.items():
            assert seconds - 0.01 <= times[name] < seconds + 0.2
        assert set(times) == set(TIMES)
    assert 0.55 < found["seconds_a_file"] < 1.0
    kept, left = ran(suite, *alike)
    assert kept["a"] == kept["b"] == sorted(set(CASES) - {"slow", "dear[0.3]"}) and left == (4, 14)
    # Of a named file the times are written anew, and the rest stays.
    ran(suite, "--measure", "test_b.py", *alike)
    again = json.loads((suite.path / "durations.json").read_text())
    files = again["files"], found["files"]
    assert again["seconds_a_file"] == found["seconds_a_file"] and files[0]["test_a.py"] == files[1]["test_a.py"]


def test_every_file_of_physics_has_a_core_case():
    """Rooms whose files each hold one claim; elsewhere a file may be of sentences or of looks alone."""
    rooms = ("closed_form", "convergence", "failure", "ladder")
    files = [path for room in rooms for path in sorted((CONFTEST.parent / room).glob("test_*.py"))]
    assert [path.name for path in files if "pytest.mark.core" not in path.read_text()] == [] != files


def test_no_case_is_named_by_a_path_of_this_machine():
    """Its time would be nobody else's."""
    files = json.loads(CONFTEST.with_name("durations.json").read_text())["files"]
    assert not [name for cases in files.values() for name in cases if "Path(" in name]


def test_no_file_sets_a_library_for_all_others():
    """A process has collected every file by now: what one sets at its import holds for all cases."""
    assert mpmath.mp.dps == 15
    assert np.geterr() == {"divide": "warn", "over": "warn", "under": "ignore", "invalid": "warn"}
