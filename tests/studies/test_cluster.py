"""Points on a Dask scheduler's workers, all in processes of their own: the rows of a local run, whoever is killed."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import pytest

import sealdyn
from sealdyn.numerics import cluster as cluster_module
from sealdyn.numerics.cluster import ClusterError, workers_of
from sealdyn.numerics.parallel import Results, Together, evaluate, processes
from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation.batch import run_many
from sealdyn.simulation.result import COMMON
from sealdyn.studies._runner import run_study

# Workers import this file: it takes nothing from the modules beside the tests.
PATH = Path(__file__).parents[2] / "scenarios" / "fms_reference.toml"
SHORT = ["run.turns=6", 'run.start="steady"']
VARY = "rotor.runout=10:60 urad:6"
IMPORTS = os.pathsep.join([str(Path(sealdyn.__file__).parents[1]), str(Path(__file__).parent)])
LIMIT = 60

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("distributed") is None, reason="an extra: sealdyn[dask]"),
]


# --- what workers evaluate ------------------------------------------------------------------------------


def logged(log, scenario, point):
    """One run of a sweep, its process and what it set written down before."""
    with open(log, "a") as file:
        file.write(f"{os.getpid()} {json.dumps(point['set'])}\n")
    time.sleep(0.1)
    return Together(partial(run_many, scenario))(point)


def odd(point):
    from threadpoolctl import threadpool_info

    if point["x"] == 1:
        raise ValueError("one is not for us")
    return {"x": point["x"], "threads": [library["num_threads"] for library in threadpool_info()]}


def ends(point):
    os._exit(1)


def slow(folder, point):
    (Path(folder) / f"{point['x']}").touch()
    time.sleep(1.0)
    return point


def poisonous(point):
    if point["x"] == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return {"y": 10 * point["x"]}


# --- a scheduler and workers ----------------------------------------------------------------------------


def started(folder, *words, **env):
    """`dask WORDS` as a process of its own, in a folder."""
    env = {**os.environ, "PYTHONPATH": IMPORTS, "DASK_DISTRIBUTED__LOGGING__DISTRIBUTED": "error"} | env
    line = [sys.executable, "-m", "dask", *map(str, words), "--no-dashboard"]
    return subprocess.Popen(line, env=env, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def worker(address, folder, *words, **env):
    return started(folder, "worker", address, "--nthreads", 1, "--local-directory", folder, *words, **env)


@contextlib.contextmanager
def cluster(folder, *words, **env):
    """Address of a scheduler with two workers, and the three processes."""
    told = folder / "scheduler.json"
    running = [started(folder, "scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", told, **env)]
    try:
        until(lambda: address_in(told))
        address = address_in(told)
        running += [worker(address, folder, *words) for _ in range(2)]
        with client_of(address) as client:
            client.wait_for_workers(2, timeout=LIMIT)
        yield address, running
    finally:
        for process in reversed(running):
            ended(process)


def address_in(told):
    """Of a scheduler's file, once it is whole."""
    with contextlib.suppress(OSError, ValueError):
        return json.loads(told.read_text())["address"]


def ended(process):
    process.terminate()
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        # The nanny of a worker that dies while both are asked to end.
        process.kill()
        process.wait(LIMIT)


def client_of(address):
    from distributed import Client

    return Client(address, set_as_default=False)


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    with cluster(tmp_path_factory.mktemp("cluster"), "--no-nanny") as (address, _):
        yield address


def until(happened):
    end = time.monotonic() + LIMIT
    while not happened():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.02)


def tasks_of(client) -> int:
    """Points that the scheduler knows of."""
    return client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks))


def quiet(done, count):
    pass


def scenario():
    return parse_scenario(PATH.read_text(), "fms_reference", SHORT)


def rows_of(crew, function, count, folder):
    return evaluate(function, [{"x": x} for x in range(count)], Results(folder), crew, quiet, "points")


# --- tests ----------------------------------------------------------------------------------------------


def test_a_scheduler_answers_what_this_machine_does(scheduler, tmp_path):
    """To the bit: by its address, by a client, which stays open, and from a folder they share."""
    flags = {"vary": [VARY, "film.coning=3,-9 mrad"]}
    local = run_study("sweep", scenario(), tmp_path / "a.h5", flags=flags, workers=1)
    by_address = run_study("sweep", scenario(), tmp_path / "b.h5", flags=flags, scheduler=scheduler)
    assert by_address["rows"] == local["rows"] and by_address["verdict"] == local["verdict"]
    assert "[film] coning" in local["rows"][1]["failed"]
    with client_of(scheduler) as client:
        kept = tmp_path / "kept"
        by_client = sealdyn.run_study(
            "sweep", scenario(), tmp_path / "c.h5", flags=flags, scheduler=client, results=kept
        )
        assert client.status == "running"
    assert by_client["rows"] == local["rows"] and len(list(kept.iterdir())) == 12
    again = run_study("sweep", scenario(), tmp_path / "d.h5", flags=flags, workers=1, results=kept)
    assert again["rows"] == local["rows"] and len(list(kept.iterdir())) == 12


def test_any_executor_answers_what_this_machine_does(scheduler, tmp_path):
    flags = {"vary": [VARY]}
    wanted = run_study("sweep", scenario(), tmp_path / "a.h5", flags=flags, workers=1)["rows"]
    with client_of(scheduler) as client, ProcessPoolExecutor(2) as pool:
        for k, executor in enumerate((pool, client.get_executor())):
            found = run_study("sweep", scenario(), tmp_path / f"{k}.h5", flags=flags, scheduler=executor)
            assert found["rows"] == wanted
        with workers_of(pool) as crew:
            one, two, three = rows_of(crew, odd, 3, tmp_path)
            assert two == {"failed": "one is not for us"} and one["x"] == 0 and three["x"] == 2
        with workers_of(pool) as crew, pytest.raises(ClusterError):
            rows_of(crew, ends, 2, tmp_path / "b")


def test_failures_are_rows_and_workers_keep_to_one_thread(scheduler, tmp_path):
    with workers_of(scheduler) as crew:
        one, two, three = rows_of(crew, odd, 3, tmp_path)
    assert two == {"failed": "one is not for us"}
    assert one["x"] == 0 and three["x"] == 2 and set(one["threads"]) == {1}


def test_who_leaves_cancels_what_waits(scheduler, tmp_path):
    def ctrl_c(done, count):
        if done == 2:
            raise KeyboardInterrupt

    begun = tmp_path / "begun"
    begun.mkdir()
    with client_of(scheduler) as client:
        with workers_of(client) as crew, pytest.raises(KeyboardInterrupt):
            points = [{"x": x} for x in range(40)]
            evaluate(partial(slow, str(begun)), points, Results(tmp_path / "kept"), crew, ctrl_c, "points")
        until(lambda: tasks_of(client) == 0)
    assert len(list((tmp_path / "kept").iterdir())) == 2 and len(list(begun.iterdir())) <= 6


def test_workers_of_another_version_are_refused(scheduler, tmp_path):
    package = tmp_path / "sealdyn"
    package.mkdir()
    (package / "__init__.py").write_text('__version__ = "0.0.1"\n')
    other = worker(scheduler, tmp_path, "--no-nanny", "--name", "other", PYTHONPATH=str(tmp_path))
    try:
        with client_of(scheduler) as client:
            client.wait_for_workers(3, timeout=LIMIT)
            with pytest.raises(ClusterError, match=r"found sealdyn 0\.0\.1; expected sealdyn ") as refused:
                run_study("sweep", scenario(), tmp_path / "a.h5", flags={"vary": VARY}, scheduler=client)
        assert "\n" not in str(refused.value)
    finally:
        ended(other)
        with client_of(scheduler) as client:
            until(lambda: len(client.nthreads()) == 2)


def test_a_worker_that_joins_late_is_asked_too(scheduler, tmp_path, monkeypatch):
    with workers_of(scheduler) as crew:
        monkeypatch.setattr(cluster_module, "__version__", "0.0.2")
        with pytest.raises(ClusterError, match=r"found sealdyn .*; expected sealdyn 0\.0\.2"):
            rows_of(crew, odd, 3, tmp_path)


def test_ctrl_c_of_the_command_cancels_what_waits(scheduler, tmp_path):
    kept = tmp_path / "kept"
    command = [
        sys.executable, "-m", "sealdyn.cli", "study", "sweep", str(PATH), "--vary", "rotor.runout=10:60 urad:200",
        "--set", "run.turns=3000", "--out", str(tmp_path / "s.h5"), "--scheduler", scheduler, "--results", str(kept),
    ]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    until(lambda: process.poll() is not None or len(list(kept.glob("*.json"))) > 1)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=LIMIT)
    assert process.returncode == 130 and "Traceback" not in said
    assert 1 < len(list(kept.iterdir())) < 200
    with client_of(scheduler) as client:
        until(lambda: tasks_of(client) == 0)


def test_a_worker_killed_in_the_middle_costs_nothing(tmp_path):
    """SIGKILL: nothing is lost, nothing is there twice, and the rows are those of a local run."""
    points = [{"outputs": list(COMMON), "set": {"rotor.runout": f"{x} urad"}} for x in range(10, 22)]
    log, kept = tmp_path / "log", tmp_path / "kept"
    function = partial(logged, str(log), scenario())
    with cluster(tmp_path, "--no-nanny") as (address, (_, victim, _)):

        def kill():
            until(lambda: kept.exists() and len(list(kept.glob("*.json"))) >= 3)
            victim.send_signal(signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        with workers_of(address) as crew:
            rows = evaluate(function, points, Results(kept), crew, quiet, "runs")
        killer.join()
    lines = log.read_text().splitlines()
    pids, evaluated = zip(*(line.split(" ", 1) for line in lines), strict=True)
    mine = pids.count(str(victim.pid))
    # Killed with points to do, and whatever was in its hands was done by the other.
    assert 0 < mine < len(points) - mine and victim.returncode == -signal.SIGKILL
    assert len(set(evaluated)) == len(points) and len(points) <= len(lines) <= len(points) + 3
    assert len(list(kept.iterdir())) == len(points)
    assert rows == evaluate(function, points, Results(tmp_path / "local"), processes(1), quiet, "runs")
    assert not any("failed" in row for row in rows)
    # All of it is in the folder: nobody evaluates anything again.
    assert rows == evaluate(function, points, Results(kept), processes(1), quiet, "runs")
    assert len(log.read_text().splitlines()) == len(lines) + len(points)


def test_a_scheduler_that_dies_ends_a_study_in_one_line(tmp_path, capfd):
    with cluster(tmp_path, "--no-nanny") as (address, (scheduler, *_)):

        def kill(done, count):
            if done == 2:
                scheduler.kill()

        capfd.readouterr()
        with workers_of(address) as crew, pytest.raises(ClusterError, match="lost with 38 points to do") as lost:
            points = [{"x": x} for x in range(40)]
            evaluate(partial(slow, str(tmp_path)), points, Results(tmp_path / "kept"), crew, kill, "points")
        assert "\n" not in str(lost.value) and capfd.readouterr().err == ""
    assert len(list((tmp_path / "kept").iterdir())) == 2


def test_a_point_that_kills_its_workers_is_a_row(tmp_path):
    """Those that waited behind it are answered; it is not kept, for another day it may be the machine."""
    with (
        cluster(tmp_path, DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0") as (address, _),
        workers_of(address) as crew,
    ):
        rows = rows_of(crew, poisonous, 6, tmp_path / "kept")
    assert list(rows[0]) == ["failed"] and "KilledWorker" in rows[0]["failed"]
    assert rows[1:] == [{"y": 10 * x} for x in range(1, 6)]
    assert len(list((tmp_path / "kept").iterdir())) == 5
