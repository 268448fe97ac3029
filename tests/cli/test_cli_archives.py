"""What is done with an archive (rerun, start from, show, plot), and the verbs that need none."""

import csv
import io
import json
import subprocess
import sys
import tomllib

import h5py
import numpy as np
import pytest
from command import REFERENCE, SCENARIOS, sealdyn, settings
from PIL import Image

FEW = settings({"run.turns": 4, "rotor.misalignment": '"30 urad"'})


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with one archive, made with an override."""
    folder = tmp_path_factory.mktemp("archives")
    assert sealdyn("run", REFERENCE, *FEW, "--out", "first.h5", "--no-plot", cwd=folder).code == 0
    return folder


def series(path) -> dict:
    with h5py.File(path) as file:
        return {name: item[:] for name, item in file.items() if isinstance(item, h5py.Dataset)}


@pytest.mark.core
def test_rerun_equals_the_original(folder):
    answer = sealdyn("run", "first.h5", "--json", "--no-plot", cwd=folder)
    assert answer.code == 0 and answer.found["archive"] == "first-rerun.h5"
    first, second = series(folder / "first.h5"), series(folder / "first-rerun.h5")
    assert first.keys() == second.keys()
    for name in first:
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)


def test_rerun_takes_overrides(folder):
    answer = sealdyn("run", "first.h5", "--set", "run.turns=1", "--json", "--no-plot", "--out", "one.h5", cwd=folder)
    assert answer.found["end"]["time"] == pytest.approx(2e-3 * np.pi)
    scene = sealdyn("check", folder / "one.h5", "--json", cwd=folder).found["scene"]
    assert scene["rotor"]["misalignment"] == pytest.approx(30e-6)


def test_a_run_starts_where_an_archive_ended(folder):
    on = settings({"run.start": '"first.h5"', "run.turns": 1})
    assert sealdyn("run", REFERENCE, *FEW, *on, "--out", "on.h5", "--no-plot", cwd=folder).code == 0
    first, on = series(folder / "first.h5"), series(folder / "on.h5")
    for name in ("rotor_z", "rotor_tilt_x", "rotor_tilt_y", "rotor_tilt_x_rate"):
        assert on[name][0] == pytest.approx(first[name][-1], rel=1e-12), name


def test_initial_overrides_the_start(folder):
    given = settings({"initial.rotor.tilt_x": '"7 urad"', "run.start": '"steady"', "run.turns": 1})
    assert sealdyn("run", REFERENCE, *given, "--out", "given.h5", "--no-plot", cwd=folder).code == 0
    assert series(folder / "given.h5")["rotor_tilt_x"][0] == pytest.approx(7e-6, rel=1e-12)


def test_show_and_csv(folder):
    assert sealdyn("show", "first.h5", cwd=folder).out.startswith("first.h5: ok")
    table = list(csv.reader(io.StringIO(sealdyn("show", "first.h5", "--csv", cwd=folder).out)))
    kept = series(folder / "first.h5")
    assert len(table) == 1 + len(kept["time"]) == 1 + 4 * 64 + 1
    for place, title in enumerate(table[0]):
        name = title.split(" [")[0]
        # Every digit survives the text.
        assert [float(row[place]) for row in table[1:]] == kept[name].tolist()
    read = list(csv.DictReader(io.StringIO(sealdyn("show", "first.h5", "--csv", "--units", "read", cwd=folder).out)))
    for title, name, factor in (("h_min [um]", "h_min", 1e6), ("leakage_inner [ml/h]", "leakage_inner", 3.6e9)):
        assert [float(row[title]) for row in read] == pytest.approx((factor * kept[name]).tolist(), rel=1e-12)


@pytest.mark.parametrize("kind", ["overview", "orbit", "film", "spectrum"])
def test_plot(kind, folder):
    answer = sealdyn("plot", "first.h5", "--kind", kind, "--out", f"{kind}.png", cwd=folder)
    assert answer.code == 0 and answer.out == f"{kind}.png\n"
    with Image.open(folder / f"{kind}.png") as picture:
        assert picture.format == "PNG"


@pytest.mark.parametrize("suffix, begin", [(".svg", b"<?xml"), (".pdf", b"%PDF")])
def test_a_figure_of_lines_is_written_twice_alike(suffix, begin, folder):
    for name in ("one", "two"):
        answer = sealdyn("plot", "first.h5", "--kind", "orbit", "--out", f"{name}{suffix}", cwd=folder)
        assert answer.code == 0 and answer.out.strip() == f"{name}{suffix}"
    one, two = ((folder / f"{name}{suffix}").read_bytes() for name in ("one", "two"))
    assert one.startswith(begin) and one == two
    assert not list(folder.glob("*.new"))


def test_a_number_of_no_world_in_an_archive_ends_in_a_line(folder):
    """Micrometres of it are beyond all numbers: once a warning of Python stood before the line."""
    path = folder / "huge.h5"
    path.write_bytes((folder / "first.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        # As somebody else might have written it: without the seal.
        del file.attrs["seal"]
        for name in ("h_min", "rotor_tilt_x"):
            file[name][3] = 1e308
    answer = sealdyn("plot", "huge.h5", cwd=folder)
    assert answer.code == 2 and len(answer.err.splitlines()) == 1, answer.err


def test_a_figure_of_another_kind_is_refused(folder):
    answer = sealdyn("plot", "first.h5", "--out", "orbit.jpg", cwd=folder)
    assert answer.code == 2 and answer.err.count("\n") == 1 and all(f".{form}" in answer.err for form in ("svg", "pdf"))


def test_schema_knows_the_keys_of_the_shipped_scenarios(tmp_path):
    schema = sealdyn("schema", cwd=tmp_path).found
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    for path in SCENARIOS.glob("*.toml"):
        _within(tomllib.loads(path.read_text()), schema, schema, path.name)


def _within(tree, schema, root, where):
    """Every table of `tree` has the keys that its schema demands and none that it does not know."""
    while "$ref" in schema:
        schema = root["$defs"][schema["$ref"].rsplit("/", 1)[1]]
    if isinstance(tree, list):
        for item in tree:
            _within(item, schema.get("items", schema), root, where)
    if not isinstance(tree, dict):
        return
    options = schema.get("anyOf") or schema.get("oneOf") or [schema]
    if any(option.get("additionalProperties") for option in options):
        # [study.NAME]: each study knows its own settings.
        return
    tables = [option for option in options if "$ref" in option or "properties" in option]
    assert tables, f"{where}: no table expected"
    if tables != [schema]:
        # One of several: a quantity is a table only when it varies with time.
        table = tables[0]
        return _within(tree, table, root, where)
    assert schema["additionalProperties"] is False, where
    assert set(schema.get("required", [])) <= tree.keys() <= schema["properties"].keys(), where
    for key, value in tree.items():
        _within(value, schema["properties"][key], root, f"{where}: {key}")


def test_check_resolves_to_si(tmp_path):
    answer = sealdyn("check", SCENARIOS / "housing_vibration.toml", cwd=tmp_path)
    assert answer.code == 0
    resolved = answer.out
    assert "viscosity = 0.0005" in resolved and "outer_pressure = 500000.0" in resolved
    found = sealdyn("check", SCENARIOS / "housing_vibration.toml", "--json", cwd=tmp_path).found
    assert found["scene"]["shaft"]["speed"] == pytest.approx(9600 * 2 * np.pi / 60)
    assert found["scene"]["housing"]["axial"][0]["acceleration"] == pytest.approx(2 * 9.80665)
    assert not list(tmp_path.iterdir())


def test_validate_takes_one_source(tmp_path):
    answer = sealdyn("validate", "zuk-1972", cwd=tmp_path)
    assert answer.code == 0 and "tilt counted twice" in answer.out
    for name in ("zuk-1972", "zuk_1972"):
        checks = sealdyn("validate", name, "--json", cwd=tmp_path).found["checks"]
        assert len(checks) == 39 and {check["source"] for check in checks} == {"Zuk (1972), sealing dam at cruise"}
    assert sealdyn("validate", "green", cwd=tmp_path).err.count("green-1989") == 2


def test_validate_fails_where_the_methods_disagree(tmp_path, monkeypatch):
    monkeypatch.setattr("sealdyn.analysis.sources.zuk_1972.TOLERANCE", 1e-3)
    answer = sealdyn("validate", "zuk-1972", "--json", cwd=tmp_path)
    assert answer.code == 5 and answer.found["status"] == "failed"


def test_help_imports_nothing_heavy():
    """Every heavy import belongs to the verb that needs it."""
    asked = "import sys; sys.argv = ['sealdyn', '--help']\nfrom sealdyn.cli import main\n"
    asked += "try: main()\nexcept SystemExit: print(sorted(sys.modules), file=sys.stderr)\n"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert "validate" in done.stdout
    loaded = {name.split(".")[0] for name in json.loads(done.stderr.replace("'", '"'))}
    heavy = {"numpy", "scipy", "numba", "sksundae", "matplotlib", "pint", "pydantic", "h5py", "xarray"}
    assert not loaded & heavy


def test_the_figure_of_a_study_is_drawn_again(tmp_path):
    found = sealdyn("study", "equilibrium", REFERENCE, "--out", "e.h5", "--workers", "1", cwd=tmp_path)
    first = (tmp_path / "e.png").read_bytes()
    (tmp_path / "e.png").unlink()
    assert found.code == 0 and sealdyn("plot", "e.h5", cwd=tmp_path).code == 0
    assert Image.open(tmp_path / "e.png").size == Image.open(io.BytesIO(first)).size
    refused = sealdyn("plot", "e.h5", "--kind", "orbit", cwd=tmp_path)
    assert refused.code == 2 and refused.err.count("\n") == 1
