"""Files of other versions: refused in one line that names them."""

from pathlib import Path

import h5py
import numpy as np
import pytest

import sealdyn
from sealdyn.archive import ArchiveError, ArchiveWriter, is_study, read_info, read_study, write_study
from sealdyn.archive.run import Series
from sealdyn.scenario.reader import Scenario, ScenarioError, parse_scenario
from sealdyn.scenario.tables import SCHEMA
from sealdyn.scenario.templates import kinds, template
from sealdyn.studies._declared import json_schema

FMS = template("fms")
(SAID,) = [line for line in FMS.splitlines(keepends=True) if line.startswith("schema")]


def in_schema(version) -> str:
    """The template as if it was written in another version of the keys, some of them unknown here."""
    return f"schema = {version}\n[film.magic]\nlevitates = true\n" + FMS.replace(SAID, "")


def test_a_scenario_of_a_newer_version_is_told_from_one_with_mistakes():
    with pytest.raises(ScenarioError) as told:
        parse_scenario(in_schema(SCHEMA + 1), "new.toml")
    assert told.value.key == "schema" and not told.value.others and sealdyn.__version__ in str(told.value)
    with pytest.raises(ScenarioError) as told:
        parse_scenario(in_schema(SCHEMA), "new.toml")
    assert told.value.key == "film.magic.levitates"


@pytest.mark.parametrize("version", ["0", "-1", "true", '"new"', "1.5", "[1]", "{ a = 1 }"])
def test_what_is_no_version_is_refused(version):
    text = FMS.replace(SAID, f"schema = {version}\n")
    with pytest.raises(ScenarioError) as told:
        parse_scenario(text, "fms.toml")
    assert told.value.key.startswith("schema")


@pytest.mark.core
def test_the_version_changes_nothing_of_a_run():
    plain, said = (parse_scenario(FMS.replace(SAID, line), "fms") for line in ("", SAID))
    assert plain == said and plain.resolved() == said.resolved() and hash(plain.given) == hash(said.given)
    assert Scenario.from_dict(said.to_dict()) == said and said.to_dict()["schema"] == SCHEMA
    assert said.with_(film__coning="2 mrad").to_toml().startswith("# Does")


def test_the_page_names_what_this_version_reads():
    page = (Path(__file__).parents[2] / "README.md").read_text()
    (latest,) = [line for line in page.splitlines() if line.startswith(sealdyn.__version__)]
    assert f"version = {{{sealdyn.__version__}}}" in page and f"`schema = {SCHEMA}`" in latest


def test_scenarios_to_begin_with_and_the_schema_name_it():
    assert all(parse_scenario(template(kind), kind).to_dict()["schema"] == SCHEMA for kind in kinds())
    assert json_schema()["properties"]["schema"]["maximum"] == SCHEMA


# --- archives ---------------------------------------------------------------------------------------


def run_archive(path):
    writer = ArchiveWriter(
        path, scenario_text="", resolved={}, meta={"version": "0.1.0"}, series={"z": Series("m", "z")}
    )
    writer.append({"time": np.arange(3.0), "z": np.zeros(3)}, {})
    return writer.finish("ok", "", {})


def study_archive(path):
    return write_study(path, "", {}, {"version": "0.1.0", "study": "sweep"}, {"rows": []}, {})


@pytest.mark.parametrize(("written", "read", "name"), [
    (run_archive, read_info, "sealdyn archive"), (study_archive, read_study, "sealdyn study"),
])  # fmt: skip
def test_an_archive_of_another_format_names_the_version_that_wrote_it(tmp_path, written, read, name):
    path = written(tmp_path / "a.h5")
    read(path)
    for by, named in (("9.8.7", "9.8.7"), (None, "another")):
        with h5py.File(path, "r+") as file:
            file.attrs["format"] = f"{name} 12"
            file.attrs.pop("version", None)
            if by:
                file.attrs["version"] = by
        for reads in (read, sealdyn.open_archive):
            with pytest.raises(ArchiveError, match=f"{name} 12") as told:
                reads(path)
            assert named in str(told.value) and len(str(told.value).splitlines()) == 1
    assert is_study(path) is (written is study_archive)


@pytest.mark.parametrize("made_as", ["sealdyn archive", "sealdyn archive two", "another 1", "", "sealdyn study 0.5"])
def test_what_is_no_format_of_ours_is_no_archive(tmp_path, made_as):
    path = run_archive(tmp_path / "a.h5")
    with h5py.File(path, "r+") as file:
        file.attrs["format"] = made_as
    with pytest.raises(ArchiveError, match="not a sealdyn archive"):
        read_info(path)
