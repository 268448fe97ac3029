"""What comes from outside: folders of SEALDYN_PATH, entry points, digests, kernels and kept results by their source."""

import sys
from importlib.metadata import EntryPoint

import pytest

from sealdyn import extensions
from sealdyn.kernel_cache import KernelLocator, kernel_folder
from sealdyn.numerics.parallel import content_keys

TEXT = "def law(x):\n    return x\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for room in extensions.ROOMS:
        (tmp_path / room).mkdir()
    (tmp_path / "films" / "soft.py").write_text(TEXT)
    (tmp_path / "films" / "_helper.py").write_text("")
    monkeypatch.setenv("SEALDYN_PATH", str(tmp_path))
    return tmp_path


def law_of(source):
    found = {}
    exec(compile(source.read_text(), str(source), "exec"), found)
    return found["law"]


def test_what_a_folder_has(folder):
    assert extensions.in_folders("films") == ["soft"] and extensions.in_folders("studies") == []
    assert extensions.source_of("films", "soft") == folder / "films" / "soft.py"
    assert extensions.digest("films", "radial") is None and len(extensions.digest("films", "soft")) == 16
    assert set(extensions.all_digests()) == {"films/soft"}


def test_what_an_installed_package_names(tmp_path, monkeypatch):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "__init__.py").write_text("")
    (tmp_path / "mine" / "law.py").write_text(TEXT)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    monkeypatch.setattr(extensions, "entry_points", lambda group: [EntryPoint("soft", "mine.law", group)])
    extensions.installed.cache_clear()
    try:
        assert extensions.source_of("films", "soft") == tmp_path / "mine" / "law.py"
        assert extensions.is_outside(tmp_path / "mine" / "law.py")
        assert not extensions.is_outside(tmp_path / "mine" / "__init__.py")
    finally:
        extensions.installed.cache_clear()


def test_kernels_are_kept_by_the_source_and_the_package(folder):
    source, names = folder / "films" / "soft.py", []
    for text in (TEXT, f"{TEXT}\n# Another.\n"):
        source.write_text(text)
        locator = KernelLocator.from_function(law_of(source), str(source))
        assert locator.get_cache_path() == str(kernel_folder())
        names.append(locator.get_disambiguator())
    assert names[0] != names[1]
    # A file beside a run may use this package's constants, too; one that does not name it is left to numba.
    for text, ours in (("from sealdyn.faces.geometry import DZ\n" + TEXT, True), (TEXT, False)):
        (other := folder / f"{ours}.py").write_text(text)
        assert (KernelLocator.from_function(law_of(source), str(other)) is not None) is ours


def test_results_hang_on_what_comes_from_outside(folder, monkeypatch):
    with_it = content_keys(content_keys, [1])
    (folder / "films" / "soft.py").write_text(f"{TEXT}\n# Another.\n")
    changed = content_keys(content_keys, [1])
    monkeypatch.delenv("SEALDYN_PATH")
    assert len({*with_it, *changed, *content_keys(content_keys, [1])}) == 3
