"""What verbs say, in Python: the same numbers, the same errors."""

import json
import pkgutil

import pytest
from command import SCENARIOS
from command import sealdyn as verb

import sealdyn

REFERENCE = SCENARIOS / "fms_reference.toml"


def test_no_public_name_is_that_of_a_part_of_the_package():
    """Else the name is one or the other, as something was imported before."""
    parts = {module.name for module in pkgutil.iter_modules(sealdyn.__path__)}
    assert not parts & set(sealdyn.__all__)
    assert all(getattr(sealdyn, name) is not None for name in sealdyn.__all__)


def test_what_check_says(tmp_path):
    found = sealdyn.check(REFERENCE, {"film.clearance": "8 um"})
    assert found["status"] == "ok" and found["scene"]["film"]["clearance"] == 8e-6
    told = verb("check", REFERENCE, "--set", "film.clearance=8 um", "--json", cwd=tmp_path).found
    assert json.loads(json.dumps(found)) == told
    rules = sealdyn.design_rules(REFERENCE, {"film.clearance": "8 um"})
    assert sorted(rules, key=str) == sorted(found["design_rules"], key=str)
    with pytest.raises(sealdyn.ScenarioError):
        sealdyn.check(REFERENCE, {"film.clearance": "-8 um"})


def test_what_validate_says():
    rows = sealdyn.validate("green-1989")
    assert rows and all(row["verdict"] != "FAILED" for row in rows)
    with pytest.raises(ValueError):
        sealdyn.validate("green-1990")


def test_studies_and_keys_are_listed():
    assert "critical-speed" in sealdyn.list_studies() and all(sealdyn.list_studies().values())
    assert "film" in sealdyn.schema()["properties"] and "lip" in sealdyn.schema(radial=True)["properties"]
