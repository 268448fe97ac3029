"""What `sealdyn check` finds before a run, sizes among it, and scenarios to begin with."""

import json
import subprocess
import sys
import tomllib

import pytest
from command import SCENARIOS, sealdyn

from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.scenario.templates import kinds, template
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.plausibility import size_of
from sealdyn.simulation.simulate import simulate

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
    answer = sealdyn("check", SCENARIOS / "rub.toml", *slips, cwd=tmp_path)
    assert answer.code == 0
    told = sealdyn("check", SCENARIOS / "rub.toml", *slips, "--json", cwd=tmp_path).found["warnings"]
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


SEAL = SCENARIOS / "fms_reference.toml"
COMMAND = [sys.executable, "-m", "sealdyn.cli"]


def said(*words):
    """Exit code, standard output and lines of standard error of a command without a terminal."""
    found = subprocess.run([*COMMAND, *words], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    return found.returncode, found.stdout, found.stderr.strip().splitlines()


@pytest.mark.parametrize(
    ("override", "key"),
    [("run.turns=1e9", "run.samples_per_turn"), ("run.samples_per_turn=1000000000", "run.samples_per_turn"),
     ("run.duration=1e6 s", "run.samples_per_turn"), ("run.samples=10000000000", "run.samples")],
)  # fmt: skip
def test_a_large_run_is_told_and_not_begun(override, key, tmp_path):
    out = tmp_path / "a.h5"
    code, _, (line,) = said("run", str(SEAL), "--set", override, "--out", str(out))
    assert code == 2 and key in line and "GB" in line and "rows" in line and "--yes" in line
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(SceneError, match="allow_large=True"):
        simulate(read_scenario(SEAL, [override]), out)


def test_a_run_beyond_any_machine_is_not_begun_whatever_is_said(tmp_path):
    code, _, (line,) = said("run", str(SEAL), "--set", "run.turns=1e14", "--yes", "--out", str(tmp_path / "a.h5"))
    assert code == 2 and "GB, at least 5600000 h" in line and "--yes" not in line
    with pytest.raises(SceneError):
        simulate(read_scenario(SEAL, ["run.turns=1e14"]), tmp_path / "a.h5", allow_large=True)


@pytest.mark.core
def test_check_tells_the_size():
    size = size_of(read_scenario(SEAL, ["run.turns=1e7"]))
    # Measured: 180 GB.
    assert size.rows == pytest.approx(6.4e8) and 1e11 < size.bytes < 4e11
    code, out, _ = said("check", str(SEAL), "--set", "run.turns=1e7", "--json")
    assert code == 0 and json.loads(out)["size"]["rows"] == pytest.approx(6.4e8)
    code, out, _ = said("check", str(SEAL), "--set", "run.turns=1e7")
    assert "1e+07 turns, 6.4e+08 rows" in out


EXTREME = [
    ("run.turns=1e300", "turns"), ("run.samples=1" + 400 * "0", "samples"), ("film.coning=1e308", "coning"),
    ("film.outer_radius=1e200 m", "outer_radius"), ("shaft.speed=1e100", "speed"), ("film.coning=1e-320", "coning"),
    ("stator.mass=1e100 kg", "mass"), ("closing.balance_ratio='nan'", "balance_ratio"), ("run.turns='inf'", "turns"),
]  # fmt: skip


@pytest.mark.parametrize(("override", "key"), EXTREME)
def test_numbers_of_no_world_are_refused_by_their_key(override, key):
    with pytest.raises(ScenarioError) as refused:
        read_scenario(SEAL, [override])
    assert key in str(refused.value) and "\n" not in str(refused.value) and len(str(refused.value)) < 300


def test_tables_too():
    text = SEAL.read_text().replace('speed = "1000 rad/s"', 'speed = { time = ["0 s", "1 s"], value = [1000, 1e200] }')
    assert "1e200" in text
    with pytest.raises(ScenarioError, match="speed"):
        parse_scenario(text, "seal")


@pytest.mark.parametrize("kind", kinds())
def test_it_runs(kind, tmp_path):
    answer = sealdyn("new", kind, cwd=tmp_path)
    assert answer.code == 0 and f"{kind}.toml" in answer.out
    short = ["--set", f"run.turns={0.05 if kind == 'wavy' else 1}", "--no-plot", "--json"]
    answer = sealdyn("run", f"{kind}.toml", *short, "--out", "a.h5", cwd=tmp_path)
    assert answer.code == 0, answer.err
    found = answer.found
    assert found["stability"]["verdict"] == "stable"
    floats = found["model"]["reasons"][0]
    assert kind.upper() in floats or kind in ("gas", "pump", "wavy", "dry-gas")


@pytest.mark.parametrize("kind", kinds())
def test_it_explains_itself(kind):
    text = template(kind)
    assert "?" in text.splitlines()[0] and tomllib.loads(text)
    keys = [line for line in text.splitlines() if " = " in line and line[0] != "#"]
    assert sum("  # " in line for line in keys) > 0.5 * len(keys)


@pytest.mark.core
def test_nothing_is_overwritten(tmp_path):
    (tmp_path / "fms.toml").write_text("mine")
    answer = sealdyn("new", "fms", cwd=tmp_path)
    assert answer.code == 2 and "already" in answer.err and (tmp_path / "fms.toml").read_text() == "mine"
    answer = sealdyn("new", "fsm", cwd=tmp_path)
    assert answer.code == 2 and "nearest 'fms'" in answer.err
    assert sealdyn("new", "gas", "--out", "nowhere/a.toml", cwd=tmp_path).code == 2
