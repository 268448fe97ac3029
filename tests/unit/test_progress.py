"""The progress bar: what it says of a run that is done more than once, and of the wait after the last step."""

from time import sleep

import numba.core.event
import pytest
from command import SCENARIOS

from sealdyn.kernel_cache import compiling
from sealdyn.numerics.parallel import Checkpoint, processes
from sealdyn.scenario.reader import read_scenario
from sealdyn.studies import _runner
from sealdyn.studies._runner import StudyContext, run_study
from sealdyn.terminal import Progress


@pytest.fixture
def shown():
    bar = Progress()
    # As it is entered, but for the timer.
    compiling.append(bar._compile)
    bar._show()
    yield bar
    bar.__exit__()


@pytest.mark.core
def test_a_run_done_again_begins_again(shown):
    shown(2.0, 2.0)
    begun = shown.bar.tasks[0].start_time
    shown(0.001, 2.0)
    (line,) = shown.bar.tasks
    assert line.fields["words"].startswith("run 2: t = 0.001 of 2 s")
    # A line of the bar that once was full says "0:00:00 remaining" for ever.
    assert not line.finished and line.time_remaining is None
    assert line.start_time == begun


def test_a_bar_that_does_not_know_says_so(shown):
    """Two points in a second, the third takes minutes: no seconds are promised once these are over."""
    for done in (0.25, 0.5):
        shown(done, 1.0, "vibration")
        sleep(0.02)
    (line,) = shown.bar.tasks
    assert any(c.isdigit() for c in shown.remaining(line))
    shown.moved -= 100.0
    assert not any(c.isdigit() for c in shown.remaining(line))
    # What does not move counts as waiting.
    shown(0.5, 1.0, "vibration")
    assert not any(c.isdigit() for c in shown.remaining(line))


def test_a_wait_for_kernels_is_told(shown):
    """Also where a bar says what is being done: not the first kernel of a machine, the first of a film."""
    seen = []
    with numba.core.event.trigger_event("numba:compile"):
        with numba.core.event.trigger_event("numba:compile"):
            pass
        seen.append(shown.bar.tasks[0].fields["words"])
    seen.append(shown.bar.tasks[0].fields["words"])
    assert seen[0] != seen[1] == shown.now["words"] and seen[0].startswith(seen[1])


def test_a_study_says_its_name_and_no_points_that_there_are_none(tmp_path):
    seen = []
    scenario = read_scenario(SCENARIOS / "fms_reference.toml", ["film.model=linear"])
    run_study("campbell", scenario, tmp_path / "c.h5", flags={"points": 11}, progress=lambda *now: seen.append(now))
    assert {words for _, _, words in seen} == {"campbell"} and seen[-1][0] == 1.0
    tools = StudyContext(None, None, lambda *now: seen.append(now))
    count = len(seen)
    assert tools.map(len, [], "cost") == [] and len(seen) == count


def identity(point):
    return point


@pytest.mark.parametrize("least, lines", [(0.0, 1), (1e9, 0)])
def test_what_takes_long_says_after_its_first_point_how_long(tmp_path, monkeypatch, capsys, least, lines):
    """Once, and not of points that were kept from before."""
    monkeypatch.setattr(_runner, "LONG", least)
    tools = StudyContext(Checkpoint(tmp_path / "kept", ""), processes(1), lambda *now: None)
    tools.map(identity, [{"x": 1}], "cost")
    tools.map(identity, [{"x": k} for k in range(5)], "cost")
    told = capsys.readouterr().err.splitlines()
    assert len(told) == lines and all("3 are left" in line for line in told)
