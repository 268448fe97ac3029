"""Every public name shows how it is used, and what it shows is what happens."""

import doctest
import inspect

import numpy as np
import pytest

import sealdyn


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where examples run: with the reference scenario, two turns of it, as fms.toml."""
    folder = tmp_path_factory.mktemp("examples")
    (folder / "fms.toml").write_text(sealdyn.example("fms_reference").with_({"run.turns": 2}).to_toml())
    return folder


@pytest.mark.parametrize("name", sealdyn.__all__)
def test_an_example_does_what_it_shows(name, folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    words = inspect.getdoc(getattr(sealdyn, name))
    example = doctest.DocTestParser().get_doctest(words, {"sealdyn": sealdyn}, name, None, None)
    assert example.examples
    with np.printoptions(precision=4):
        found = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(example)
    assert not found.failed, capsys.readouterr().out
