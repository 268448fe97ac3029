"""What an archive says is a stranger's word: it names no place where anything is written, and no file that is read."""

import shutil
from pathlib import Path

import h5py
import pytest
from command import SCENARIOS, sealdyn

from sealdyn.archive import file_stem
from sealdyn.archive.files import seal
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate

SHORT = ["run.turns=1", "run.samples_per_turn=16"]
SEAL = SCENARIOS / "fms_reference.toml"


def plain(tmp_path, motion=""):
    """A scenario of a few turns, with a motion of a carrier."""
    (tmp_path / "own").mkdir(exist_ok=True)
    (tmp_path / "own" / "seal.toml").write_text(f"{SEAL.read_text()}\n{motion}\n")
    return read_scenario(tmp_path / "own" / "seal.toml", SHORT)


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return simulate(plain(folder), folder / "a.h5").archive


def altered(archive, path, **words):
    """A copy of the archive with other root attributes, sealed anew."""
    shutil.copyfile(archive, path)
    with h5py.File(path, "r+") as file:
        for name, word in words.items():
            del file.attrs[name]
            file.attrs[name] = word
        seal(file)
    return path


@pytest.mark.parametrize("name", ["../../planted", "/tmp/planted", "..", "a\nb", "C:\\planted", ".hidden", ""])
@pytest.mark.parametrize("verb", ["study", "python"])
def test_a_name_leads_nowhere(name, verb, archive, tmp_path, monkeypatch):
    """A study of the archive writes below outputs."""
    home = tmp_path / "deep" / "home"
    home.mkdir(parents=True)
    altered(archive, tmp_path / "a.h5", name=name)
    before = {path for path in tmp_path.rglob("*")}
    monkeypatch.chdir(home)
    if verb == "study":
        assert sealdyn("study", "equilibrium", tmp_path / "a.h5", "--no-plot", cwd=home).code == 0
    else:
        simulate(read_scenario(tmp_path / "a.h5"))
    made = {path for path in tmp_path.rglob("*") if path.is_file()} - before
    assert len(made) == 1 and next(iter(made)).parent == home / "outputs"


def test_names_as_people_give_them_are_kept():
    for name in ("fms_reference", "Läufer ± 密封 😀", "pump seal (2)", "a.b-c"):
        assert file_stem(name) == name


SECRET = "time,axial (um)\n" + "".join(f"{0.001 * k},{0.1 * k}\n" for k in range(40))


@pytest.mark.parametrize("table", ["shaft", "housing"])
@pytest.mark.parametrize("place", ["../secret.csv", "absolute", "secret.csv"])
def test_an_archive_opens_no_motion_file(table, place, archive, tmp_path, monkeypatch):
    """Neither from its folder nor from where the program is run; one that it holds is not looked for."""
    for folder in (tmp_path, tmp_path / "home"):
        folder.mkdir(exist_ok=True)
        (folder / "secret.csv").write_text(SECRET)
    place = str(tmp_path / "secret.csv") if place == "absolute" else place
    monkeypatch.chdir(tmp_path / "home")
    motion = f'[{table}.motion]\nfile = "{place}"'
    altered(archive, tmp_path / "a.h5", scenario=f"{SEAL.read_text()}\n{motion}\n")
    with pytest.raises(ScenarioError) as error:
        read_scenario(tmp_path / "a.h5")
    assert error.value.key == f"{table}.motion.file"
    # Asked for by the user it is his.
    asked = read_scenario(tmp_path / "a.h5", [f"{table}.motion.file='{tmp_path / 'secret.csv'}'"])
    again = simulate(asked, tmp_path / "b.h5")
    (tmp_path / "secret.csv").unlink()
    assert read_scenario(again.archive).scene == asked.scene


def test_an_archive_starts_from_no_file(archive, tmp_path):
    """Unless the user says so; what only shows it needs no file."""
    first = Path(shutil.copyfile(archive, tmp_path / "first.h5"))
    second = simulate(read_scenario(SEAL, [*SHORT, f"run.start={first}"]), tmp_path / "second.h5").archive
    answer = sealdyn("run", second, "--no-plot", cwd=tmp_path)
    assert answer.code == 2 and "run.start" in answer.err and len(answer.err.splitlines()) == 1
    for verb in (
        ["show"],
        ["run", "--no-plot", "--set", f"run.start={first}"],
        ["run", "--no-plot", "--set", "run.start=rest"],
    ):
        assert sealdyn(verb[0], second, *verb[1:], cwd=tmp_path).code == 0
