"""Fields that runs keep: pressures summed over the face are the force and the moments in the archive, for films with
and without unknowns of their own."""

from functools import partial

import h5py
import numpy as np
import pytest
from command import SCENARIOS
from radial_cells import film_of
from scipy.integrate import simpson

from sealdyn import open_archive
from sealdyn.archive import column, field, read_info
from sealdyn.dynamics.model import Model
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation import selection
from sealdyn.simulation.simulate import simulate

PROFILE = ["film.coning=0", "film.profile={radius=['32 mm', '36 mm', '40 mm'], depth=['0 um', '9 um', '25 um']}"]
# Scenario, what is changed, and how far the sums on the grid may be off: further where the floor has kinks, or where a
# thin film lets the pressure fall within a few radii.
RUNS = {
    "radial": ("fms_reference", ["run.turns=3"], 3e-4),
    "both rings": ("fmsr_both_flexible", ["run.turns=3"], 3e-4),
    "massless": ("massless_ring", ["run.turns=3"], 3e-4),
    "pressure step": ("pressure_step", ["run.turns=3"], 1e-2),
    "profile": ("fms_reference", ["run.turns=3", "film.model='profiled'", *PROFILE], 3e-4),
    "floor": ("ludwig_allen", ["run.turns=1"], 3e-2),
    "chosen linear film": ("fms_reference", ["run.turns=3", "film.model='auto'", "run.accuracy=1e-2"], 3e-4),
}


def archived(tmp_path, name, changes):
    return simulate(read_scenario(SCENARIOS / f"{name}.toml", changes), tmp_path / "run.h5")


def at_fields(path, name):
    """A series at the instants of the fields."""
    time, at = column(path, "time"), field(path, "field_time")
    rows = np.searchsorted(time, at)
    np.testing.assert_array_equal(time[rows], at)
    return column(path, name)[rows]


@pytest.mark.parametrize("case", RUNS)
def test_pressures_sum_up_to_the_force_and_the_moments_of_the_archive(tmp_path, case):
    name, changes, bound = RUNS[case]
    result = archived(tmp_path, name, changes)
    assert result.status == "ok"
    assert (result.summary["model"]["film"] == "linear") == (case == "chosen linear film")
    path = result.archive
    p, r, theta = (field(path, n) for n in ("pressure", "r", "theta"))

    def over_face(arm):
        return 2 * np.pi * np.mean(simpson(p * arm * r[:, None], x=r, axis=1), axis=1)

    force = at_fields(path, "film_force")
    assert np.max(np.abs(over_face(1.0) / force - 1)) < bound
    size = np.max(np.abs(force)) * r[-1]
    arms = {"film_moment_x": r[:, None] * np.sin(theta), "film_moment_y": -r[:, None] * np.cos(theta)}
    for moment, arm in arms.items():
        assert np.max(np.abs(over_face(arm) - at_fields(path, moment))) < bound * size, moment


def test_instants_are_few_and_hold_both_ends(tmp_path):
    result = archived(tmp_path, "fms_reference", ["run.turns=10"])
    at, time = field(result.archive, "field_time"), column(result.archive, "time")
    assert len(at) == 32 and at[0] == time[0] and at[-1] == time[-1]
    assert np.ptp(np.diff(at)) < 2.1 * (time[1] - time[0])
    with open_archive(result.archive) as data:
        assert data.pressure.dims == ("field_time", "r", "theta") and data.pressure.attrs["units"] == "Pa"
        assert data.pressure.isel(r=0).values == pytest.approx(0.0, abs=1e-6)
        assert data.pressure.isel(r=-1).values == pytest.approx(5e5, rel=1e-12)


def test_a_run_of_few_samples_keeps_the_fields_of_all(tmp_path):
    few = archived(tmp_path, "fms_reference", ["run.turns=1", "run.samples=9"])
    np.testing.assert_array_equal(field(few.archive, "field_time"), column(few.archive, "time"))


def test_a_film_that_closes_leaves_the_fields_of_its_end(tmp_path):
    result = archived(
        tmp_path, "fms_reference", ["run.turns=1", "run.samples=1000", "initial.stator.z_rate='-0.3 m/s'"]
    )
    at, time = field(result.archive, "field_time"), column(result.archive, "time")
    assert result.status == "collapsed" and len(at) < len(time)
    assert at[-1] == time[-1]


@pytest.mark.core
def test_a_linear_film_keeps_none(tmp_path):
    result = archived(tmp_path, "fms_reference", ["run.turns=1", "film.model='linear'"])
    assert read_info(result.archive)["fields"] == {}
    with h5py.File(result.archive) as file:
        assert not {"field_time", "r", "theta"} & set(file)


# --- films with unknowns ----------------------------------------------------------------------------

CELLS, ANGLES = 4, 8


@pytest.fixture
def cells(monkeypatch):
    """Runs of scenarios whose film is that of cells, with a liquid that gives way."""
    model = partial(Model, film=film_of(CELLS, ANGLES, compressibility=1e-8))
    monkeypatch.setattr(selection, "Model", model)


def test_pressures_of_a_film_with_unknowns_are_kept_as_they_are(tmp_path, cells):
    result = archived(tmp_path, "fms_reference", ["run.turns=3"])
    assert result.status == "ok" and result.summary["model"]["film"] == "radial_cells"
    path = result.archive
    p, r, theta = (field(path, n) for n in ("pressure", "r", "theta"))
    assert p.shape == (32, CELLS, ANGLES)
    half = 0.5 * (r[1] - r[0])
    area = 2 * np.pi / ANGLES * 0.5 * ((r + half) ** 2 - (r - half) ** 2)[:, None]
    arm = 2 * np.pi / ANGLES * ((r + half) ** 3 - (r - half) ** 3)[:, None] / 3
    assert np.sum(p * area, axis=(1, 2)) == pytest.approx(at_fields(path, "film_force"), rel=1e-9)
    size = np.max(at_fields(path, "film_force")) * r[-1]
    for name, turn in (("film_moment_x", np.sin(theta)), ("film_moment_y", -np.cos(theta))):
        assert np.sum(p * arm * turn, axis=(1, 2)) == pytest.approx(at_fields(path, name), abs=1e-9 * size)
