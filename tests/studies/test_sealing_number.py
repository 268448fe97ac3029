"""Sealing number: closed form, actual film, in time and let go, over the force ratio; its chart; what it refuses."""

import json
import math

import pytest
from command import SCENARIOS

from sealdyn.archive import read_study
from sealdyn.report import panels
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.scene import SceneError
from sealdyn.studies._runner import run_study
from sealdyn.studies.sealing_number import released

PATH = SCENARIOS / "ludwig_allen.toml"
RATIOS = (1.2, 1.45, 1.6, 2.5)


def read(*overrides):
    return parse_scenario(PATH.read_text(), "ludwig_allen", list(overrides))


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    out = tmp_path_factory.mktemp("sealing") / "number.h5"
    flags = {"force_ratios": RATIOS, "starts": ("closed form",), "turns": 60}
    return run_study("sealing-number", read(), out, flags=flags, workers=1), out


def number(q):
    """Sealing number as printed: (pi^4/256)^2 q^4 sqrt(1 - (256/pi^4)/q^2)."""
    return (math.pi**4 / 256) ** 2 * q**4 * math.sqrt(1 - 256 / math.pi**4 / q**2)


def test_balance_is_the_closed_form_where_there_is_one(found):
    rows = {row["force_ratio"]: row for row in found[0]["balance"]}
    for name in ("closed_form", "static", "quasi_static"):
        assert rows[2.5][name]["sealing_number"] == pytest.approx(number(2.5), rel=2e-4), name
    for q in RATIOS[:3]:
        assert rows[q]["closed_form"] is None and rows[q]["static"] is None
        assert rows[q]["quasi_static"]["status"] == "hang-up" and rows[q]["static_said"]


def test_released_ring_by_its_fate(found):
    """On its own soft support the ring has films just where the closed form has none; measured h0 0.8205 um at 1.45,
    where a free ring without any spring has (derived by hand) e^2 = 0.4025 and h0 = 0.8206 um."""
    rows = {(row["force_ratio"], row["support"]): row for row in found[0]["released"]}
    assert [rows[q, "own"]["status"] for q in RATIOS] == ["hang-up", "film", "film", "straightened"]
    moment = 4 / math.pi / 1.45
    e = math.sqrt((moment**2 - math.pi**2 / 16) / (1 - math.pi**2 / 16))
    assert rows[1.45, "own"]["sealing_number"][0] == pytest.approx(e / (1 - e * e) ** 2, rel=5e-3)
    held = rows[2.5, "as the closed form needs"]
    assert held["status"] == "film" and held["ratio"]["mean_film"] == pytest.approx(1.0, abs=2e-3)
    assert held["sealing_number"][0] == pytest.approx(number(2.5), rel=4e-3)
    assert rows[2.5, "own"]["ratio"]["mean_film"] < 0.2 and rows[1.2, "own"]["ratio"] is None
    assert max(row["energy_residual"] for row in found[0]["released"]) < 1e-2


def test_line_and_published_rows(found):
    """The printed h0 of q = 2 has two digits: 2 %, in its square 4 %."""
    line = found[0]["line"]
    assert line["force_ratio"][-1] == pytest.approx(2.5)
    assert line["sealing_number"] == pytest.approx([number(q) for q in line["force_ratio"]], rel=1e-6, abs=1e-9)
    assert len(found[0]["published"]) == 2
    for row in found[0]["published"]:
        assert row["sealing_number"] == pytest.approx(number(row["force_ratio"]), rel=0.04)


def test_chart(found, tmp_path):
    answer, out = found
    json.dumps(answer, allow_nan=False)
    numbers, carries = ([one for one in panel["series"]] for panel in read_study(out)["panels"][:2])
    assert [numbers[0]["x"], numbers[0]["y"]] == [answer["line"][name] for name in ("force_ratio", "sealing_number")]
    films = [row for row in answer["released"] if row["status"] in ("film", "straightened")]
    assert films
    for row in films:
        assert any(
            (row["force_ratio"], row["sealing_number"][0]) in zip(one["x"], one["y"], strict=True) for one in numbers
        )
        if row["ratio"]:
            pair = (row["force_ratio"], row["ratio"]["mean_film"])
            assert any(pair in zip(one["x"], one["y"], strict=True) for one in carries)
    assert panels.draw(out, tmp_path / "figure.png").exists()


def test_chart_of_failed_points(tmp_path, monkeypatch):
    """Hopeless runs are rows with their reason, and the figure shows the rest."""

    def fails(*anything):
        raise RuntimeError("no such luck")

    monkeypatch.setattr(released, "released", fails)
    flags = {"force_ratios": 2.5, "starts": "closed form"}
    answer = run_study("sealing-number", read(), tmp_path / "none.h5", flags=flags, workers=1)
    assert [row["failed"] for row in answer["released"]] == ["RuntimeError: no such luck"] * 2
    assert panels.draw(tmp_path / "none.h5", tmp_path / "none.png").exists()


def test_a_sealed_pressure_is_answered(tmp_path):
    """1 bar outside: F_s is what spring and balance press beyond the opening of flat faces (linear over the width), and
    closed form, film and time agree to what a face of dR/R = 0.017 leaves."""
    keys = ("film.outer_pressure=1 bar", "closing.balance_ratio=0.7", "closing.spring_force=90 N")
    flags = {"force_ratios": 2.5, "starts": "closed form", "turns": 1, "last": 1}
    answer = run_study("sealing-number", read(*keys), tmp_path / "p.h5", flags=flags, workers=1)
    area, width = 2 * math.pi * 0.06 * 1.02e-3, 1.02e-3
    load = 90 + 1e5 * area * (0.7 - 0.5 - width / (12 * 0.06))
    assert answer["seal"]["spring_force"] == pytest.approx(load, rel=1e-9)
    row = answer["balance"][0]
    # Thicker than with ambient pressures: it tilts more.
    assert row["closed_form"]["mean_film"] > 1.3 * math.sqrt(number(2.5) * 2e-3 * 300 * 0.06 * width**3 / load)
    for name in ("static", "quasi_static"):
        assert row[name]["mean_film"] == pytest.approx(row["closed_form"]["mean_film"], rel=1e-3), name
    own, needed = answer["released"]
    assert needed["foreseen"]["mean_film"] == pytest.approx(row["closed_form"]["mean_film"], rel=1e-6)
    assert own["foreseen"] is None and answer["published"] == []
    assert answer["least_force_ratio"] < answer["least_attracting_force_ratio"] < 16 / math.pi**2
    assert answer["line"]["sealing_number"][-1] == pytest.approx(row["closed_form"]["sealing_number"], rel=1e-6)


@pytest.mark.core
def test_other_seals_are_refused(tmp_path):
    with pytest.raises(SceneError) as refused:
        run_study("sealing-number", read("film.coning=1 mrad"), tmp_path / "a.h5", workers=1)
    assert refused.value.key == "film.coning"
    for flags in ({"force_ratio": 2.0}, {"force_ratios": [0.0]}):
        with pytest.raises(ScenarioError) as refused:
            run_study("sealing-number", read(), tmp_path / "b.h5", flags=flags, workers=1)
        assert next(iter(flags)) in str(refused.value)
