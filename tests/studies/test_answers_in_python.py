"""Studies asked for in Python: numbers with dimensions and units, figures, and nothing left behind."""

import numpy as np
import pytest
from command import SCENARIOS
from hypothesis import example, given, settings
from hypothesis import strategies as st

import sealdyn
from sealdyn.archive import answer_as_dataset

SCENARIO = sealdyn.read_scenario(SCENARIOS / "fms_reference.toml", ["run.turns=4"])


def test_a_study_leaves_nothing_without_an_archive(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    found = sealdyn.study("equilibrium", SCENARIO, points=41, workers=1)
    assert len(found.plot().axes) > 0 and found.archive is None and found.answer["archive"] is None
    assert not list(tmp_path.iterdir())
    assert found.study == "equilibrium" and found.status == "ok" and found.message == " ".join(found.verdict)
    (root,) = found.answer["roots"]
    assert root["clearance"] == pytest.approx(1e-5, rel=1e-9)
    stiffness, there = found.data["curve.stiffness"], found.data["curve.clearance"]
    assert stiffness.dims == ("curve.clearance",) and stiffness.size == 41 and stiffness.attrs["units"] == "N/m"
    assert stiffness.sel({"curve.clearance": 1e-5}, method="nearest") == pytest.approx(root["stiffness"], rel=0.2)
    assert there.attrs["units"] == "m"
    assert found.data["roots.clearance"].dims == ("roots",) and found.data.sizes["roots"] == 1


def test_fields_and_columns_of_an_answer_lie_along_what_its_study_names():
    field = sealdyn.study("pressure", SCENARIO, workers=1)
    assert field.data["pressure.p"].dims == ("pressure.r", "pressure.theta")
    assert field.data["pressure.p"].attrs["units"] == "Pa"
    assert field.data["pressure.p"].values.tolist() == field.answer["pressure"]["p"]
    both = sealdyn.study("transmissibility", SCENARIO, workers=1).data
    assert both["fms.total"].dims == both["fmr.linear_algebra.total"].dims == ("speed",)
    assert both.speed.attrs["units"] == "rad/s"


@pytest.mark.core
def test_rows_of_an_answer_are_a_dimension():
    found = sealdyn.study("campbell", SCENARIO, workers=1)
    frequency = found.data["modes.frequency"]
    assert frequency.dims == ("modes", "speed") and frequency.attrs["units"] == "rad/s"
    for row, mode in zip(frequency, found.answer["modes"], strict=True):
        assert np.array_equal(row, np.array(mode["frequency"], float), equal_nan=True)
    # The lines of excitation are no speeds.
    assert found.data["lines"].dims == ("lines.0",)


def test_a_row_that_failed_hides_no_other():
    data = answer_as_dataset({"rows": [{"failed": "collapsed"}, {"h_min": 2e-6}]}, {"rows/h_min": "m"}, {})
    assert data["rows.h_min"].dims == ("rows",) and np.isnan(data["rows.h_min"][0]) and data["rows.h_min"][1] == 2e-6


def test_axes_that_are_not_told_are_not_guessed():
    """Columns of one length are not of one dimension for that."""
    answer = {
        "speed": [1.0, 2.0],
        "lines": [3.0, 4.0],
        "one": {"matrix": [[1.0, 2.0]] * 2, "odd": [1.0]},
        "verdict": [],
    }
    data = answer_as_dataset(answer, {"speed": "rad/s"}, {"one": ("speed",)})
    assert data["lines"].dims == ("lines.0",) and data["one.odd"].dims == ("one.odd.0",)
    assert data["one.matrix"].dims == ("speed", "one.matrix.1") and "verdict" not in data
    assert data.speed.values.tolist() == [1.0, 2.0] and data.speed.attrs["units"] == "rad/s"


NAMES = st.sampled_from(["speed", "one", "two", "failed"])
VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.floats(allow_nan=False), st.text(max_size=3)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(NAMES, inner, max_size=3)),
    max_leaves=12,
)


@settings(max_examples=200, deadline=None)
@example({"speed": [[1.0]], "one": [1.0]}, {"one": ("speed",)})
@example({"speed": None, "failed": [{"speed": None}]}, {"one": ("speed", "speed"), "failed": ("one", "failed")})
@given(st.dictionaries(NAMES, VALUES, max_size=4), st.dictionaries(NAMES, st.tuples(NAMES, NAMES), max_size=3))
def test_any_answer_can_be_shown(answer, along):
    data = answer_as_dataset(answer, {"speed": "rad/s"}, along)
    for name, values in answer.items():
        if isinstance(values, list) and values and all(isinstance(value, float) for value in values):
            assert data[name].values.tolist() == values


@pytest.mark.parametrize(
    "name, given_settings, told",
    [
        ("equilibirum", {}, "nearest 'equilibrium'"),
        ("equilibrium", {"ponts": 3}, "nearest 'points'"),
        ("equilibrium", {"points": "many"}, "[study.equilibrium] points"),
        ("sweep", {"vary": "film.clerance=1,2"}, "nearest 'clearance'"),
    ],
)
def test_what_cannot_be_studied_is_told_in_one_line(name, given_settings, told):
    with pytest.raises(sealdyn.ScenarioError) as refused:
        sealdyn.study(name, SCENARIO, **given_settings)
    assert told in str(refused.value) and "\n" not in str(refused.value)


def test_what_a_study_does_not_reckon_with_is_an_error_of_the_scenario():
    with_contact = SCENARIO.with_({"contact": {"roughness": "0.1 um", "compressive_strength": "300 MPa"}})
    with pytest.raises(sealdyn.ScenarioError) as refused:
        sealdyn.study("neutral-stability", with_contact)
    assert str(refused.value).startswith("fms_reference: [contact]")
