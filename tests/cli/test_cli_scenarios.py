"""Every shipped scenario, shortened, through the command line: exit code, JSON contract, archive, figure."""

import json
import math
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
import xarray
from command import REFERENCE, SCENARIOS, finished, sealdyn, settings, short, started

from sealdyn import open_archive
from sealdyn.report.text import plain_letters
from sealdyn.unit_names import dimension_and_factor

# A plain run has one of each kind of film.
MARKS = dict.fromkeys(("hang_up", "runup_past_threshold"), pytest.mark.slow)
MARKS |= dict.fromkeys(("fms_reference", "gas_dam_reference", "gas_reynolds_reference", "pump_seal"), pytest.mark.core)
SHIPPED = [pytest.param(path, marks=MARKS.get(path.stem, ())) for path in sorted(SCENARIOS.glob("*.toml"))]
# Fewer cells and turns where a run is dear.
COARSER = {
    "upstream_pumping": {"film.reynolds.columns": 4, "run.turns": 0.5},
    "dry_gas_seal": {"film.gas_reynolds.columns": 4, "run.turns": 0.5, "run.accuracy": 0.05},
    "turning_pads": {"film.gas_reynolds.columns": 8, "run.turns": 1, "run.accuracy": 0.1},
    "dry_gas_start": {"film.gas_reynolds.columns": 4},
    "lebeck_n6": {"film.reynolds.cells_r": 6, "film.reynolds.cells_theta": 270},
    "lebeck_n3": {"film.reynolds.cells_r": 6, "film.reynolds.cells_theta": 135},
    "lebeck_plateaus": {
        "film.reynolds.cells_r": 6,
        "film.reynolds.grid_accuracy": 0.9,
        "run.turns": 0.25,
        "run.accuracy": 0.05,
    },
    "lebeck_elastic": {"film.reynolds.cells_r": 6},
    "lebeck_driven": {"film.reynolds.cells_r": 6, "film.reynolds.cells_theta": 180},
}
# A figure of each kind of film and of motion.
DRAWN = {"dry_gas_seal", "fms_reference", "gas_dam_reference", "gas_reynolds_reference", "housing_vibration",
         "lebeck_n3", "pump_seal", "rub", "runup_past_threshold"}  # fmt: skip
CONTRACT = {
    "model": {"film", "unknowns", "solver", "start", "reasons", "unused"},
    "h_min": {"value", "time", "theta", "radius", "of_clearance"},
    "relative_misalignment": {"max", "min", "mean", "steady_max", "steady_min"},
    "leakage": {"mean", "max", "mean_ml_per_h"}, "friction": {"torque", "power"},
    "film": {"axial_stiffness", "tilt_stiffness"}, "closing": {"force", "balance_ratio"}, "closed_form": set(),
    "stability": {"verdict", "whirl_ratio", "critical_speed", "resonance_speeds"}, "counts": {"rhs", "steps"},
}  # fmt: skip
PLAIN = {"status", "message", "contact_margin", "contact_margin_limit", "energy_residual", "wall_time", "archive",
         "figure"}  # fmt: skip
TILT_SCALE = 1e-5 / 0.04


@pytest.fixture(scope="module", params=SHIPPED, ids=lambda path: path.stem)
def run(request, tmp_path_factory):
    """One shipped scenario, run once: its folder, what the command left, and its archive."""
    name, folder = request.param.stem, tmp_path_factory.mktemp(request.param.stem)
    words = [*short(request.param), *settings(COARSER.get(name, {})), *(["--no-plot"] if name not in DRAWN else [])]
    # Few speeds at which modes are looked at: of some scenes they take most of the time.
    with mock.patch("sealdyn.dynamics.stability_thresholds.PER_DECADE", 8):
        answer = sealdyn("run", request.param, *words, "--json", cwd=folder)
    with open_archive(folder / answer.found["archive"]) as data:
        return folder, answer, data.load()


def scene(data):
    """The resolved scene of an archive."""
    return json.loads(data.attrs["resolved"])


def initial(quantity):
    """A number, or the first value of a table."""
    return quantity["value"][0] if isinstance(quantity, dict) else quantity


def ending(answer):
    """Status and exit code that a scenario is known for: this ring amplifies errors beyond what can be kept."""
    return ("inaccurate", 5) if Path(answer.found["archive"]).stem == "squeeze" else ("ok", 0)


def opens_for_a_stranger(path, data, status):
    """An archive, beside the same one opened by this package: xarray alone."""
    with xarray.open_dataset(path, engine="h5netcdf") as plain:
        xarray.testing.assert_identical(plain.assign_attrs(rows=data.attrs["rows"]), data)
    assert data.h_min.dims == ("time",)
    wanted = {"units", "long_name", "display_unit", "display_factor"}
    assert all(wanted <= series.attrs.keys() for series in data.values())
    assert (data.h_min.attrs["display_unit"], data.h_min.attrs["display_factor"]) == ("µm", 1e6)
    for series in (held for held in data.variables.values() if held.attrs.get("display_unit")):
        unit, shown = (plain_letters(series.attrs[key]) for key in ("units", "display_unit"))
        # Units that are held are of factor 1, a pure number among them.
        size = {unit: 1.0, "%": 0.01}.get(shown) or float(dimension_and_factor(shown)[1])
        assert series.attrs["display_factor"] == pytest.approx(1.0 / size, rel=1e-12)
    assert data.attrs["status"] == status and "[film]" in data.attrs["scenario"]


def test_run_answers_with_the_whole_contract(run):
    folder, answer, data = run
    found = answer.found
    assert (found["status"], answer.code) == ending(answer), answer.err
    assert found.keys() >= CONTRACT.keys() | PLAIN
    for table, keys in CONTRACT.items():
        assert found[table].keys() >= keys, table
    assert found["model"]["unused"] == []
    assert found["stability"]["verdict"] in ("stable", "neutral", "unstable")
    assert found["energy_residual"] < 10 * found["accuracy"]
    assert found["counts"]["rhs"] > 0 and found["counts"]["steps"] > 0 and found["wall_time"] > 0
    # Archive and figure, and nothing else.
    assert sorted(path.name for path in folder.iterdir()) == ["outputs"]
    stem = found["archive"].removeprefix("outputs/").removesuffix(".h5")
    figure = [f"{stem}.png"] if stem in DRAWN else []
    assert sorted(path.name for path in (folder / "outputs").iterdir()) == [f"{stem}.h5", *figure]
    assert not figure or (folder / found["figure"]).read_bytes()[:4] == b"\x89PNG"
    opens_for_a_stranger(folder / found["archive"], data, found["status"])


def is_mean(value, series, slack=0.0) -> bool:
    """Whether a mean over a run is that of its samples, as far as these tell: by how much it differs between all of
    them and every other one."""
    fine, coarse = (np.trapezoid(s, s.time) / (s.time[-1] - s.time[0]) for s in (series, series[::2]))
    return abs(value - float(fine)) <= 3 * abs(float(fine - coarse)) + 1e-3 * abs(float(fine)) + slack


def test_numbers_of_the_summary_are_those_of_the_archive(run):
    _, answer, data = run
    found = answer.found
    # An extremum between samples is at least as extreme as the samples, but for what is not worth locating.
    slack = 0.02 * found["accuracy"]
    low, tilt = found["h_min"], found["relative_misalignment"]
    film, touching = scene(data)["film"], scene(data)["contact"]
    clearance = film["clearance"] or 1e-5
    assert low["value"] <= float(data.h_min.min()) + slack * clearance
    # Rough faces that touch come closer than their mean planes.
    assert low["value"] > (-3 * touching["roughness"] if touching else 0.0)
    assert touching or low["value"] > 0.95 * float(data.h_min.min())
    assert 0 <= low["time"] <= found["end"]["time"] == pytest.approx(float(data.time[-1]), rel=2e-3)
    assert low["radius"] in (film["inner_radius"], film["outer_radius"]) and -math.pi <= low["theta"] <= math.pi
    assert tilt["max"] >= float(data.relative_misalignment.max()) - slack * TILT_SCALE
    assert tilt["min"] <= float(data.relative_misalignment.min()) + slack * TILT_SCALE
    assert is_mean(tilt["mean"], data.relative_misalignment, 5 * found["accuracy"] * TILT_SCALE)
    # Where it leaves the film, which a film that stores tells from where it enters.
    outwards = initial(film["inner_pressure"]) > initial(film["outer_pressure"])
    leaving = data.leakage_outer if outwards else data.leakage_inner
    assert is_mean(found["leakage"]["mean"], leaving) and is_mean(found["friction"]["power"], data.friction_power)
    np.testing.assert_array_less(0, np.diff(data.time))
    assert all(np.isfinite(series).all() for series in data.values())


def test_leakage_and_friction_are_those_of_the_annulus(run):
    """Thin film between narrow faces: flow h^3 dp over viscous resistance, shear viscosity r w / h."""
    _, answer, data = run
    found = answer.found
    if data.axial_gap_change[0] != 0:
        pytest.skip("starts in motion, away from the design clearance")
    film = scene(data)["film"]
    if film["clearance"] is None or film["geometry"] == "planar" or film["pads"]:
        pytest.skip("clearance found, a strip for a ring, or pads in it")
    if film["outer_radius"] * float(data.relative_misalignment[0]) > 0.2 * film["clearance"]:
        pytest.skip("starts tilted")
    r = np.linspace(film["inner_radius"], film["outer_radius"], 20001)
    middle, dr = 0.5 * (r[1:] + r[:-1]), r[1] - r[0]
    coning = float(data.coning[0]) if "coning" in data else film["coning"]
    h = film["clearance"] + coning * (middle - r[0])
    pressure = initial(film["outer_pressure"]) - initial(film["inner_pressure"])
    viscosity = film["viscosity"]
    if film["gas"] is not None:
        # Of air, U.S. Standard Atmosphere (1976).
        temperature = initial(film["temperature"])
        viscosity = 1.458e-6 * temperature**1.5 / (temperature + 110.4)
    flow = math.pi * pressure / (6 * initial(viscosity)) / np.sum(dr / (middle * h**3))
    torque = 2 * math.pi * viscosity * float(data.shaft_speed[0]) * np.sum(middle**3 * dr / h)
    if found["model"]["film"] == "radial" and not data.cavitated_fraction.any():
        assert float(data.leakage_inner[0]) == pytest.approx(flow, rel=0.02)
    assert float(data.friction_torque[0]) == pytest.approx(torque, rel=0.06)
    assert found["leakage"]["mean_ml_per_h"] == pytest.approx(found["leakage"]["mean"] * 1e6 * 3600)


@pytest.mark.core
def test_a_real_process_prints_what_an_engineer_reads_first(tmp_path):
    answer = finished(started("run", REFERENCE, *short(REFERENCE), "--no-plot", cwd=tmp_path))
    assert answer.code == 0, answer.err
    for word in ("model", "h_min", "misalignment", "leakage", "friction", "stability", "accuracy", "files"):
        assert f"\n  {word} " in answer.out
    # Turbulence and inertia of this film; nothing else, and none of them by Python.
    assert answer.out.count("WARNING") == answer.out.count("\n  WARNING ") == 2
    assert "Warning" not in answer.err and "Traceback" not in answer.err
    assert not list(tmp_path.rglob("*.png"))


@pytest.mark.parametrize("name", ["fmr_reference", "fms_reference", "fmsr_both_flexible", "massless_ring"])
def test_small_forcing_reaches_the_closed_form(name, tmp_path):
    small = {"run.turns": 20, "run.accuracy": 1e-8, "stator.misalignment": 2.5e-6, "run.samples_per_turn": 8}
    small["rotor.runout" if name == "fms_reference" else "rotor.misalignment"] = 2.5e-6
    if name == "fmsr_both_flexible":
        small["run.turns"] = 60
    found = sealdyn("run", SCENARIOS / f"{name}.toml", *settings(small), "--json", "--no-plot", cwd=tmp_path).found
    steady, form = found["relative_misalignment"], found["closed_form"]
    assert steady["steady_max"] == pytest.approx(form["relative_max"], rel=1e-5, abs=1e-8 * TILT_SCALE)
    assert steady["steady_min"] == pytest.approx(form["relative_min"], rel=1e-5, abs=1e-8 * TILT_SCALE)


def test_steady_start_has_no_transient(tmp_path):
    steady = settings(
        {"run.turns": 5, "run.start": '"steady"', "stator.misalignment": 1e-6, "rotor.misalignment": 1e-6}
    )
    found = sealdyn("run", REFERENCE, *steady, "--json", "--no-plot", cwd=tmp_path).found
    tilt = found["relative_misalignment"]
    assert tilt["max"] == pytest.approx(tilt["steady_max"], abs=1e-6 * TILT_SCALE)
    assert tilt["min"] == pytest.approx(tilt["steady_min"], abs=1e-6 * TILT_SCALE)
    with open_archive(tmp_path / found["archive"]) as data:
        gap = data.relative_tilt_x.values
        assert gap[:64] == pytest.approx(gap[-65:-1], abs=1e-6 * TILT_SCALE)


@pytest.mark.core
def test_h_min_between_samples_is_that_of_a_dense_run(tmp_path):
    """Sampled twice a turn or 2000 times: the thinnest film is the same, and the dense samples come close to it."""
    asked = {"run.turns": 3, "stator.misalignment": '"100 urad"', "run.start": '"steady"'}
    lows = []
    for samples in (2, 2000):
        changes = settings(asked | {"run.samples_per_turn": samples})
        found = sealdyn("run", REFERENCE, *changes, "--json", "--no-plot", "--out", "x.h5", cwd=tmp_path).found
        lows.append(found["h_min"]["value"])
    with open_archive(tmp_path / "x.h5") as data:
        dense = float(data.h_min.min())
    assert lows[0] == pytest.approx(lows[1], abs=1e-6 * 1e-5)
    assert lows[1] == pytest.approx(dense, abs=2e-6 * 1e-5)
