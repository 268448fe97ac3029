"""A study on other machines that cannot be: one line and exit code 2, before anything is computed."""

import json
import subprocess
import sys

import pytest
from command import REFERENCE, said, sealdyn

from sealdyn.numerics import cluster

SWEEP = ("study", "sweep", REFERENCE, "--vary", "rotor.runout=10,20 urad", "--set", "run.turns=2", "--no-plot")


def refused(*words, cwd) -> str:
    """The line with which a sweep is refused."""
    answer = sealdyn(*SWEEP, *words, cwd=cwd)
    assert answer.code == 2 and answer.out == "" and answer.err.endswith("\n")
    (line,) = said(answer.err)
    as_json = sealdyn(*SWEEP, *words, "--json", cwd=cwd)
    assert as_json.code == 2 and json.loads(as_json.out) == {"status": "invalid", "message": line}
    assert not list(cwd.rglob("*.h5")) and not list(cwd.rglob("*.jsonl"))
    return line


def test_no_dask(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert 'pip install "sealdyn[dask]"' in refused("--scheduler", "tcp://127.0.0.1:8786", cwd=tmp_path)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "tcp://127.0.0.1", "here", "http://127.0.0.1:9"])
def test_no_scheduler_there(tmp_path, monkeypatch, address):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    assert address in refused("--scheduler", address, cwd=tmp_path)


def test_a_process_that_finds_no_scheduler_says_nothing_more_at_its_end(tmp_path):
    pytest.importorskip("distributed")
    program = "from sealdyn import cli; from sealdyn.numerics import cluster; cluster.PATIENCE = 0.5; cli.main()"
    words = [sys.executable, "-c", program, *map(str, SWEEP), "--scheduler", "tcp://127.0.0.1"]
    ended = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode == 2 and ended.stdout == "" and len(said(ended.stderr)) == 1, ended.stderr


def test_a_scheduler_has_its_own_workers(tmp_path):
    assert "--workers" in refused("--scheduler", "tcp://127.0.0.1:8786", "--workers", "2", cwd=tmp_path)


@pytest.mark.core
def test_no_folder_for_results(tmp_path):
    (tmp_path / "taken").write_text("")
    assert "taken" in refused("--results", tmp_path / "taken", cwd=tmp_path)


def test_local_studies_need_no_dask(tmp_path, monkeypatch):
    for name in ("dask", "distributed"):
        monkeypatch.setitem(sys.modules, name, None)
    answer = sealdyn(*SWEEP, "--workers", "1", "--results", tmp_path / "kept", "--json", cwd=tmp_path)
    assert answer.code == 0 and len(list((tmp_path / "kept").iterdir())) == len(answer.found["rows"]) == 2
