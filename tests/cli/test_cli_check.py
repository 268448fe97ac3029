"""What `sealdyn check` says beyond the scene."""

import pytest
from command import SCENARIOS, sealdyn

DAM = SCENARIOS / "gas_dam_reference.toml"


def test_check_says_what_the_floor_of_a_pressure_costs(tmp_path):
    answer = sealdyn("check", SCENARIOS / "ludwig_allen.toml", "--json", cwd=tmp_path)
    assert answer.code == 0 and "starve" in answer.found["beside_reynolds"]["said"]


def test_check_prints_gauge_pressures_as_absolute_and_says_so(tmp_path):
    arguments = ["check", SCENARIOS / "axial_only.toml", "--set", "film.outer_pressure=5 barg"]
    answer = sealdyn(*arguments, cwd=tmp_path)
    assert answer.code == 0 and "\nouter_pressure = 601325.0\n" in answer.out
    assert sealdyn(*arguments, "--json", cwd=tmp_path).found["gauge"] == ["film.outer_pressure"]


@pytest.mark.core
def test_check_prints_the_mass_of_a_body(tmp_path):
    body = "{ inner_radius = 0, outer_diameter = '20 cm', length = '10 cm', density = '1 g/cm3' }"
    text = (SCENARIOS / "axial_only.toml").read_text().splitlines()
    kept = [line for line in text if not line.startswith(("mass", "transverse_inertia", "polar_inertia"))]
    (tmp_path / "seal.toml").write_text("\n".join(kept))
    ring = "rotor" if "[rotor.support]" in kept else "stator"
    answer = sealdyn("check", "seal.toml", "--set", f"{ring}.body={body}", cwd=tmp_path)
    assert answer.code == 0, answer.err
    assert f"[{ring}.body]" in answer.out and "\nmass = 3.14159" in answer.out


def test_tables_of_studies_are_read_whatever_is_asked(tmp_path):
    scene = (SCENARIOS / "axial_only.toml").read_text()
    (tmp_path / "a.toml").write_text(scene + "\n[study.contact-onest]\nvalues = ['1 urad']\n")
    for words in (("check", "a.toml"), ("run", "a.toml", "--set", "run.turns=1"), ("study", "sweep", "a.toml")):
        refused = sealdyn(*words, cwd=tmp_path)
        assert refused.code == 2 and refused.err.count("\n") == 1, refused
        assert "[study] contact-onest: found an unknown study" in refused.err
        assert "nearest 'contact-onset'" in refused.err
    (tmp_path / "b.toml").write_text(scene + "\n[study.contact-onset]\nvalue = ['1 urad']\n")
    refused = sealdyn("check", "b.toml", cwd=tmp_path)
    assert refused.code == 2 and "value: found an unknown key" in refused.err and "nearest 'values'" in refused.err
    # A hyphen is as good as an underscore.
    (tmp_path / "c.toml").write_text(scene + "\n[study.work-precision]\nmethods = ['adsms']\n")
    refused = sealdyn("study", "work-precision", "c.toml", cwd=tmp_path)
    assert refused.code == 2 and "methods: found 'adsms'" in refused.err and refused.err.count("\n") == 1
    refused = sealdyn("study", "critical-speed", SCENARIOS / "fms_reference.toml", "--method", "adsms", cwd=tmp_path)
    assert refused.code == 2 and "method: found 'adsms'" in refused.err and refused.err.count("\n") == 1


def test_check_warns_before_a_run_does(tmp_path):
    """Slips of units, inertia left out and edges that boil need no run to be seen."""
    slips = ["--set", "film.outer_pressure=8", "--set", 'film.vapour_pressure="2 bar"']
    answer = sealdyn("check", SCENARIOS / "pump_seal.toml", *slips, cwd=tmp_path)
    assert answer.code == 0
    told = sealdyn("check", SCENARIOS / "pump_seal.toml", *slips, "--json", cwd=tmp_path).found["warnings"]
    assert all(f"# WARNING {sentence}" in answer.out for sentence in told) and len(told) > 1


def test_check_warns_of_units_and_a_refusal_names_them(tmp_path):
    """What `run` says of numbers without a unit, before any run; and why there is no balance."""
    told = sealdyn("check", DAM, "--set", "stator.mass=150", "--json", cwd=tmp_path).found["warnings"]
    assert any("stator.mass" in sentence for sentence in told)
    assert sealdyn("check", DAM, "--json", cwd=tmp_path).found["warnings"] == []
    held = "closing = { balance_ratio = 0.8, spring_force = '20 N' }\n"
    (tmp_path / "bar.toml").write_text(held + DAM.read_text().replace('clearance = "0.25 mil"', ""))
    for verb in ("check", "run"):
        done = sealdyn(verb, "bar.toml", "--set", "film.inner_pressure=16", cwd=tmp_path)
        assert done.code == 2 and "film.inner_pressure without a unit is read as 16 Pa" in done.err
