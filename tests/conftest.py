"""Which cases run.

`pytest` runs of each file the cheapest cases up to a processor time that is the same for every file, every case marked
`core` (the physics or the contract its file exists for), and every case not yet measured, but for those that need a
shared fixture which is dear and which no other case has paid for: the whole stays within `SECONDS` with warm kernels. A
file or a case named on the command line runs in any case, and so does what `-k`, `-m` or `--lf` picks. `pytest --all`
runs everything, `pytest --rest` what a plain `pytest` leaves out. A case marked `slow` (Dask, killed processes, full
disks, long convergence studies) never runs by itself in a plain `pytest`.

`pytest --measure` runs everything and writes `durations.json`, which is committed: seconds of processor time, child
processes included, by file and case, and the time a file may take. A fixture shared by several cases stands by itself,
as `@name`, paid by the first case that needs it. What takes less than `CHEAP` is not listed. With files
named, only their times are written anew and the time a file may take stays.
"""

import gc
import json
import math
import os
import sys
import time
from collections import Counter, defaultdict
from itertools import chain
from pathlib import Path

import pytest

HERE = Path(__file__).parent
DURATIONS = HERE / "durations.json"
# Processor time (s) of the cases of a plain run; the rest of 300 s is imports and collection in each process.
SECONDS, CHEAP = 215.0, 0.05

if sys.dont_write_bytecode:
    # Most of the start of a process is compiling, half of the collection is rewriting asserts: both are kept.
    sys.dont_write_bytecode, sys.pycache_prefix = False, str(HERE.parent / ".pytest_cache" / "bytecode")
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix

# Stale kernels are dropped by this import: once, before several processes begin to compile new ones.
import sealdyn  # noqa: E402, F401
from sealdyn.numerics.interruption import one_thread  # noqa: E402

# Matrices here are small: threads of BLAS made some cases dearer many times and none quicker.
one_thread()

# In SI a picometre is something: `approx` forgives 1e-12 of anything unless it is told not to.
type(pytest.approx(1.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0


def pytest_addoption(parser):
    group = parser.getgroup("cases")
    group.addoption("--all", action="store_true", dest="all_cases", help="every case")
    group.addoption("--rest", action="store_true", dest="rest_of_cases", help="every case a plain run leaves out")
    group.addoption("--measure", action="store_true", help="every case; their processor times to durations.json")


def pytest_configure(config):
    config.pluginmanager.register(Cases(config), "cases")


def processor_time():
    """Seconds of this process and of its children that have ended."""
    return time.process_time() + sum(os.times()[2:4])


def affordable(cases, seconds, allowed):
    """Names of the cases of a file that a plain run takes: core, cheap or unmeasured ones, and the cheapest others as
    long as the file's time (s) is not spent. A case that is not listed is cheap only if its shared fixtures are, or
    are there for others. `cases`: name -> (core, shared fixtures); `seconds`: the file's times."""

    def listed(name):
        return name in seconds or any(seconds.get("@" + fixture, 0.0) >= CHEAP for fixture, _ in cases[name][1])

    chosen = [name for name, (core, _) in cases.items() if core or not listed(name)]
    paid = {fixture for name in chosen for fixture in cases[name][1]}
    spent = sum(seconds.get(name, 0.0) for name in chosen) + sum(seconds.get("@" + name, 0.0) for name, _ in paid)

    def price(name):
        return seconds.get(name, 0.0) + sum(seconds.get("@" + one[0], 0.0) for one in set(cases[name][1]) - paid)

    for name in sorted(cases.keys() - set(chosen), key=lambda name: (price(name), name)):
        if price(name) < CHEAP or spent + price(name) <= allowed:
            spent += price(name)
            paid |= set(cases[name][1])
            chosen.append(name)
    return set(chosen), spent


def whole_time(items, times):
    """Time (s) of these cases of one file and of the shared fixtures that they need."""
    cases = {name_of(item): traits(item) for item in items}
    return affordable(cases, times["files"].get(file_of(items[0]), {}), math.inf)[1]


def allowed_per_file(files, seconds, budget):
    """Time (s) a file may take for all to stay within a budget (s). `files`: cases as above by file; `seconds` too."""
    low, high = 0.0, budget
    for _ in range(30):
        middle = (low + high) / 2
        whole = sum(affordable(cases, seconds.get(file, {}), middle)[1] for file, cases in files.items())
        low, high = (middle, high) if whole <= budget else (low, middle)
    return math.floor(100 * low) / 100


def file_of(item):
    return item.path.relative_to(HERE).as_posix()


def name_of(item):
    return item.nodeid.partition("::")[2]


def traits(item):
    """Whether a case is core, and the shared fixtures it needs, each with the place of its parameter."""
    places = item.callspec.indices if hasattr(item, "callspec") else {}
    scopes = {name: found[-1].scope for name, found in item._fixtureinfo.name2fixturedefs.items() if found}
    shared = [(name, places.get(name, 0)) for name, scope in scopes.items() if scope != "function"]
    return item.get_closest_marker("core") is not None, shared


def durations():
    return json.loads(DURATIONS.read_text()) if DURATIONS.exists() else {"seconds_a_file": 1.0, "files": {}}


class Cases:
    """Chooses the cases of a run and measures them, in each process; the controlling one counts and writes."""

    def __init__(self, config):
        self.config, self.clock, self.shared = config, 0.0, {}
        self.found, self.dropped, self.workers, self.measured = 0, 0, 0.0, ""
        self.files, self.seconds, self.setups = defaultdict(dict), defaultdict(Counter), defaultdict(Counter)

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, config, items):
        option, times = config.option, durations()
        picked = option.keyword or option.markexpr or getattr(option, "lf", False)
        named = {Path(word.partition("::")[0]).resolve() for word in config.args if ".py" in word}
        by_file = defaultdict(list)
        for item in items:
            by_file[item.path].append(item)
        kept = set()
        for path, group in by_file.items():
            if not option.rest_of_cases and (option.all_cases or option.measure or picked or path in named):
                kept.update(group)
                continue
            cases = {name_of(item): item for item in group if item.get_closest_marker("slow") is None}
            wanted = {name: traits(item) for name, item in cases.items()}
            seconds = times["files"].get(file_of(group[0]), {})
            kept.update(cases[name] for name in affordable(wanted, seconds, times["seconds_a_file"])[0])
        if option.rest_of_cases:
            kept = set(items) - kept
        self.found, self.dropped = len(items), len(items) - len(kept)
        config.hook.pytest_deselected(items=[item for item in items if item not in kept])
        # Files stay whole, each process its own, so that a shared fixture is paid once: the longest begin.
        groups = filter(None, ([item for item in group if item in kept] for group in by_file.values()))
        items[:] = chain(*sorted(groups, key=lambda group: -whole_time(group, times)))

    def pytest_collection_finish(self):
        # What has been imported and collected stays to the end: no collector of garbage need look at it again.
        gc.collect()
        gc.freeze()

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        start = processor_time()
        try:
            return (yield)
        finally:
            if fixturedef.scope != "function":
                self.shared[fixturedef.argname] = processor_time() - start

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self):
        self.clock = processor_time()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item):
        """Gives each of the three reports of a case its time since the one before: they travel to the controller."""
        report, now = (yield), processor_time()
        report.case = file_of(item), name_of(item), item.get_closest_marker("slow") is not None, *traits(item)
        report.own, report.shared = now - self.clock - sum(self.shared.values()), self.shared
        self.clock, self.shared = now, {}
        return report

    def pytest_runtest_logreport(self, report):
        if hasattr(report, "case"):
            file, name, slow, core, shared = report.case
            seconds = self.seconds[file]
            seconds[name] += report.own
            for fixture, spent in report.shared.items():
                seconds["@" + fixture] += spent
                self.setups[file]["@" + fixture] += 1
            if not slow:
                self.files[file][name] = core, [tuple(one) for one in shared]

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self):
        if hasattr(self.config, "workeroutput"):
            self.config.workeroutput["cases"] = self.found, self.dropped, processor_time()
        elif self.config.option.measure:
            self.write()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node):
        if "cases" in getattr(node, "workeroutput", {}):
            # Every process finds and drops the same cases.
            self.found, self.dropped, seconds = node.workeroutput["cases"]
            self.workers += seconds

    def write(self):
        """The times of what has run, a line for each file, of a shared fixture the mean of its parameters; what a file
        may take only when everything has run."""
        for file, setups in self.setups.items():
            for fixture, count in setups.items():
                self.seconds[file][fixture] /= count
        files = {
            file: {name: round(spent, 2) for name, spent in sorted(seconds.items()) if spent >= CHEAP}
            for file, seconds in self.seconds.items()
        }
        allowed = durations()["seconds_a_file"]
        if self.config.args_source is pytest.Config.ArgsSource.ARGS:
            files = durations()["files"] | files
        else:
            cheap = sum(spent for seconds in self.seconds.values() for spent in seconds.values() if spent < CHEAP)
            allowed = allowed_per_file(self.files, files, SECONDS - cheap)
            plain = [affordable(cases, files[file], allowed) for file, cases in self.files.items()]
            least = sum(affordable(cases, files[file], 0.0)[1] for file, cases in self.files.items())
            count, spent = sum(len(chosen) for chosen, _ in plain), cheap + sum(spent for _, spent in plain)
            self.measured = f"a plain run: {count} cases in {spent:.0f} s, {cheap + least:.0f} s of them in any case; "
        lines = [f"{json.dumps(file)}: {json.dumps(files[file])}" for file in sorted(files) if files[file]]
        DURATIONS.write_text(f'{{"seconds_a_file": {allowed}, "files": {{\n' + ",\n".join(lines) + "\n}}\n")

    def pytest_terminal_summary(self, terminalreporter):
        own = time.process_time() + self.workers if self.workers else processor_time()
        words = f"{self.dropped} of {self.found} cases left out (pytest --all runs them); " if self.dropped else ""
        terminalreporter.write_line(f"{self.measured}{words}{own:.0f} s of processor time")
