"""A film from outside with options of its own: scenarios/own/films/fed_film.py read, run, swept, kept, and missing."""

import copy
import json
import os
import pickle
import shutil
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from command import SCENARIOS
from scipy.integrate import quad

import sealdyn
from sealdyn import ScenarioError, read_scenario
from sealdyn.extensions import VARIABLE
from sealdyn.faces import geometry as g
from sealdyn.films import film_named
from sealdyn.scenario.own_options import Missing
from sealdyn.studies._declared import schema

FILE = SCENARIOS / "own" / "films" / "fed_film.py"
SUPPLY, REFERENCE = "film.fed_film.supply_pressure", SCENARIOS / "fms_reference.toml"
MORE = "from dataclasses import dataclass\n\nfrom sealdyn.films.fed_film import FILM\n"


@pytest.fixture
def fed(monkeypatch):
    """The reference seal with the film, which no folder had before."""
    monkeypatch.setenv(VARIABLE, "")
    return read_scenario(REFERENCE, ["run.turns=3"]).with_film(FILE, supply_pressure="12 bar")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of films on SEALDYN_PATH, of which the file of the example is one."""
    (tmp_path / "films").mkdir()
    shutil.copy(FILE, tmp_path / "films")
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "films"


@pytest.mark.core
def test_force_and_moments_are_the_integrals_of_the_laws(fed):
    """By adaptive quadrature of the formulas, at gap states that are far from aligned."""
    film, table = film_named("fed_film"), fed.scene.film
    f, rng = film.parameters(table, 1e-5, 1e-9), np.random.default_rng(3)
    b, r, p_s, h_c = 8e-3, 36e-3, 12e5, 12e-6
    for _ in range(5):
        s = np.zeros(g.GAP_STATE_SIZE)
        gx, gy = rng.uniform(-1e-4, 1e-4, 2)
        dz, dz_rate, gx_rate, gy_rate, spin = rng.uniform(-3e-6, 3e-6), *rng.uniform(-0.01, 0.01, 3), 500.0
        for slot, value in ((g.DZ, dz), (g.GX, gx), (g.GY, gy), (g.DZ_RATE, dz_rate), (g.GX_RATE, gx_rate),
                            (g.GY_RATE, gy_rate), (g.MEAN_SPIN, spin), (g.VISCOSITY, 5e-4),
                            (g.SPIN_DIFFERENCE, 1e3)):  # fmt: skip
            s[slot] = value
        film.flow(f, s)

        def line(a, dz=dz, gx=gx, gy=gy, dz_rate=dz_rate, gx_rate=gx_rate, gy_rate=gy_rate):
            h = 1e-5 + 3.125e-3 * 4e-3 + dz + r * (gx * np.sin(a) - gy * np.cos(a))
            squeezed = dz_rate + r * (gx_rate * np.sin(a) - gy_rate * np.cos(a))
            squeezed += 500.0 * r * (gx * np.cos(a) + gy * np.sin(a))
            return r * (p_s / (1.0 + (h / h_c) ** 3) * b - 5e-4 * (b / h) ** 3 * squeezed), h

        whole = [quad(lambda a, arm=arm: line(a)[0] * arm(a), 0, 2 * np.pi, epsabs=1e-9)[0]
                 for arm in (lambda a: 1.0, lambda a: r * np.sin(a), lambda a: -r * np.cos(a))]  # fmt: skip
        torque = quad(lambda a: 5e-4 * 1e3 * b * r**3 / line(a)[1], 0, 2 * np.pi)[0]
        assert s[[g.FORCE, g.MOMENT_X, g.MOMENT_Y]] == pytest.approx(whole, rel=1e-7)
        assert s[g.TORQUE] == pytest.approx(torque, rel=1e-9) and np.isnan(s[g.FLOW_INNER])


@pytest.mark.core
def test_a_run_and_its_archive(fed, tmp_path, monkeypatch):
    """Small motion has the slope of the law; an archive is run again with the same source, and no other."""
    path = tmp_path / "a.h5"
    found = sealdyn.run(fed, out=path).summary
    h, h_c = 1e-5 + 3.125e-3 * 4e-3, 12e-6
    slope = 12e5 * 3 * h**2 / h_c**3 / (1 + (h / h_c) ** 3) ** 2 * 8e-3 * 2 * np.pi * 36e-3
    assert found["status"] == "ok" and found["film"]["axial_stiffness"] == pytest.approx(slope, rel=1e-6)
    assert found["film"]["tilt_stiffness"] == pytest.approx(0.5 * slope * 36e-3**2, rel=1e-6)
    again = read_scenario(path)
    assert again == fed and again.scene.film.fed_film.capillary_film == 12e-6
    assert sealdyn.run(again, out=tmp_path / "b.h5").summary["h_min"] == found["h_min"]
    other = tmp_path / "films"
    other.mkdir()
    (other / "fed_film.py").write_text(FILE.read_text() + "\n# Another.\n")
    for place, told in (("", "SEALDYN_PATH"), (str(tmp_path), "source")):
        monkeypatch.setenv(VARIABLE, place)
        with pytest.raises(ScenarioError) as refused:
            read_scenario(path)
        assert refused.value.key == "film.model" and "fed_film" in refused.value.found
        assert told in refused.value.found + refused.value.expected
    assert read_scenario(path, ["film.model=fed_film"]).scene.film.fed_film.supply_pressure == 12e5


def test_options_are_read_like_any_table(fed):
    copied = pickle.loads(pickle.dumps(fed)), copy.deepcopy(fed), sealdyn.Scenario.from_dict(fed.to_dict())
    assert all(one == fed for one in copied) and fed.resolved()["film"]["fed_film"]["supply_pressure"] == 12e5
    changed = fed.with_({SUPPLY: "10 bar", "film.fed_film.capillary_film": 1e-5})
    assert vars(changed.scene.film.fed_film) == {"supply_pressure": 1e6, "capillary_film": 1e-5} and changed != fed
    assert changed == fed.with_({"film.fed_film": {"supply_pressure": "10 bar", "capillary_film": "10 um"}})
    assert fed.with_({"film.model": "radial"}).unused() == [SUPPLY]
    (options,) = [
        held for name, held in schema()["$defs"].items() if name.endswith("fed_film__Options") or name == "Options"
    ]
    assert options["required"] == ["supply_pressure"] and options["properties"]["capillary_film"]["unit"] == "m"


@pytest.mark.parametrize(
    "key, value, found, expected",
    [
        ("film.fed_film.suply_pressure", "1 bar", "an unknown key", "supply_pressure"),
        (SUPPLY, "3 mm", "3 mm", "pressure"),
        ("film.fed_film.capillary_film", "-1 um", "-1e-06 m", "> 0"),
        ("film.fed_film", {}, "nothing", "pressure"),
        ("film.fed_film", 3.0, "3.0", "supply_pressure"),
        ("film.fed_fillm", {"supply_pressure": 1e6}, "an unknown key", "fed_film"),
    ],
)
def test_what_is_wrong_with_options_is_told_like_of_any_table(fed, key, value, found, expected):
    with pytest.raises(ScenarioError) as refused:
        fed.with_({key: value})
    told = refused.value
    assert told.name == fed.name and told.key.startswith("film.fed_fil")
    assert found in told.found and expected in told.expected


def test_options_that_are_needed_and_a_film_that_is_not_there(fed, monkeypatch):
    with pytest.raises(ScenarioError) as refused:
        read_scenario(REFERENCE, ["film.model=fed_film"])
    assert refused.value.key == "film.fed_film" and "supply_pressure" in refused.value.expected
    monkeypatch.setenv(VARIABLE, "")
    for overrides in (["film.model=fed_film", f"{SUPPLY}=1e6"], ["film.model=fed_film"]):
        with pytest.raises(ScenarioError) as refused:
            read_scenario(REFERENCE, overrides)
        assert refused.value.key == "film.model" and "fed_film" in refused.value.found
    with pytest.raises(ScenarioError) as refused:
        read_scenario(REFERENCE, [f"{SUPPLY}=1e6"])
    assert refused.value.key == "film.fed_film" and VARIABLE in refused.value.expected


@pytest.mark.parametrize(
    "text, told",
    [
        ("FILM = (", "SyntaxError"),
        ("", "FILM"),
        (MORE, "fed_film"),
        (MORE + "\n\nclass Options:\n    pass\n", "Options"),
        (MORE + "\n\n@dataclass(frozen=True)\nclass Options:\n    x: Strange\n", "NameError"),
    ],
)
def test_a_file_that_is_no_film_is_told_in_a_line(folder, text, told):
    (folder / "odd.py").write_text(text)
    with pytest.raises(ScenarioError) as refused:
        read_scenario(REFERENCE, ["film.model=odd"])
    assert refused.value.key == "film.model" and "\n" not in str(refused.value)
    assert "odd" in refused.value.found and told in refused.value.found + refused.value.expected
    # And is in the way of nobody else.
    assert "FED" not in json.dumps(schema()["$defs"]) and read_scenario(REFERENCE).scene.film.model == "radial"


def test_a_file_that_has_changed_is_read_again(folder):
    """In one session; annotations may be text."""
    text, seen = FILE.read_text(), []
    for factor in ("1.0", "0.50"):
        made = text.replace("return pressure *", f"return {factor} * pressure *")
        (folder / "fed_film.py").write_text("from __future__ import annotations\n" + made)
        scenario = read_scenario(REFERENCE, ["film.model=fed_film", f"{SUPPLY}=12 bar"])
        seen.append(film_named("fed_film").opening_law(scenario.scene.film)(1e-5, 0.0, 5e5))
    assert seen[1] == pytest.approx(0.5 * seen[0])
    with pytest.raises(ScenarioError) as refused:
        read_scenario(REFERENCE, ["film.model=fed_film", "film.fed_film={}"])
    assert refused.value.key == SUPPLY and "absolute pressure" in refused.value.expected


def test_where_a_film_of_ones_own_stands(fed, folder):
    nowhere = dict.fromkeys((folder.parent / "fed_film.py", folder / "gone.py"), "films/NAME.py")
    for file, told in (nowhere | {FILE: "another name"}).items():
        with pytest.raises(ScenarioError) as refused:
            fed.with_film(file)
        assert refused.value.key == "film.model" and told in refused.value.expected
    (folder / "radial.py").write_text("")
    with pytest.raises(ScenarioError):
        fed.with_film(folder / "radial.py")
    # Nothing has changed by it.
    assert os.environ[VARIABLE] == str(folder.parent)


@pytest.mark.core
def test_many_runs_in_other_processes(fed):
    sets = [{SUPPLY: "8 bar"}, {SUPPLY: "16 bar"}, {SUPPLY: "1 mm"}]
    rows = sealdyn.simulate_many(fed, sets, ["film.axial_stiffness"], workers=2)
    stiff = rows["film.axial_stiffness"].values
    assert stiff[1] == pytest.approx(2 * stiff[0], rel=1e-6) and list(rows.status.values[1:]) == ["ok", "not possible"]
    table = sealdyn.sweep(fed, {SUPPLY: ["8 bar", "16 bar"]}, "film.axial_stiffness", workers=2)
    assert table["film.axial_stiffness"].values == pytest.approx(stiff[:2])


def test_a_process_without_the_film_is_told_so(fed, tmp_path, monkeypatch):
    """Processes that do not inherit: each point says what is missing, and none ends its process."""
    place = os.environ[VARIABLE]
    for there, done in (("", False), (place, True)):
        monkeypatch.setenv(VARIABLE, there)
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            pool.submit(int, 1).result()
            monkeypatch.setenv(VARIABLE, place)
            flags = {"vary": [f"{SUPPLY}=8:12 bar:2"]}
            rows = sealdyn.run_study("sweep", fed, tmp_path / "a.h5", flags=flags, scheduler=pool)["rows"]
        assert [row.get("status") == "ok" for row in rows] == [done, done]
        assert done or all("films/fed_film" in str(row) and VARIABLE in str(row) for row in rows)
    monkeypatch.setenv(VARIABLE, "")
    lost = pickle.loads(pickle.dumps(fed.scene.film))
    assert isinstance(lost, Missing)
    with pytest.raises(ImportError):
        _ = lost.model


def test_studies_over_options(fed, tmp_path):
    """Scatter of an option, and a map over one."""
    flags = {"scatter": [f"{SUPPLY}=uniform(10 bar, 14 bar)"], "samples": 16, "indices": False}
    answer = sealdyn.run_study("tolerance", fed, tmp_path / "t.h5", flags=flags, workers=1)
    assert answer["keys"] == [SUPPLY]
    flags = {"x": f"{SUPPLY}=5:15 bar:2", "y": "shaft.speed=500:1000 rad/s:2"}
    assert sealdyn.run_study("stability", fed, tmp_path / "s.h5", flags=flags, workers=1)["growth_rate"]
