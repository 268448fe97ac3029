"""What the floor of the pressure costs beside cavities that keep their liquid, as `check` says it."""

import pytest
from command import SCENARIOS

from sealdyn import read_scenario
from sealdyn.simulation import film_error as module
from sealdyn.simulation.film_error import reynolds_comparison
from sealdyn.simulation.simulate import prepare_run, simulate

# A film of 1 bar that a runout of 0.25 mrad tears.
LOW = ["film.cavitation_pressure=0", "film.outer_pressure=0.2 bar", "film.coning=0", "rotor.runout=0.2 mrad"]


def found(name, *overrides):
    return reynolds_comparison(prepare_run(read_scenario(SCENARIOS / f"{name}.toml", overrides))[0])


def test_ludwig_and_allens_film_carries_half_as_much_again_by_its_floor(monkeypatch):
    edges = ["film.outer_pressure=0.2 bar", "film.inner_pressure=0.2 bar"]
    off = found("ludwig_allen", *edges)
    assert off["force"] == pytest.approx(0.57, abs=0.03) and off["moment"] == pytest.approx(0.40, abs=0.03)
    assert off["leakage"] == pytest.approx(-1.0, abs=1e-3)
    # Cells do not matter: a grid with four times as many says the same.
    monkeypatch.setattr(module, "CELLS", (32, 256))
    assert found("ludwig_allen", *edges)["force"] == pytest.approx(off["force"], abs=0.02)


def test_edges_at_the_cavitation_pressure_starve_what_keeps_its_liquid():
    off = found("ludwig_allen")
    assert off["force"] is None and "starve" in off["said"]


@pytest.mark.core
def test_a_tilt_that_turns_with_the_fluid_tears_nothing():
    """The rotor's runout is steady in its own frame: the wedge is that of the fluid against it."""
    assert found("fms_reference", *LOW)["cavitated"][0] > 0.01
    assert found("fms_reference", *LOW, "stator.speed=1000 rad/s")["cavitated"][0] < 1e-3


def test_flow_along_the_circle_matters_in_wide_faces():
    """Nothing in faces a fifth as wide as their radius; by the square of the width in wider ones."""
    assert "the same within" in found("fms_reference")["said"]
    aligned = ["film.coning=0", "film.cavitation_pressure=0", "film.inner_pressure=5 bar"]
    moment = [found("fms_reference", *aligned, f"film.inner_radius={r} mm")["moment"] for r in (16, 24)]
    assert moment[0] > 0.05 and 2.0 < moment[0] / moment[1] < 5.0


def test_a_film_that_is_none_of_lines_says_nothing():
    assert found("lebeck_n3") is None
    assert found("fms_reference", "film.model=linear", "film.coefficients=radial") is None


def test_a_run_with_a_floor_that_acts_says_what_its_cavities_would_change(tmp_path):
    short = ["run.turns=2", "run.accuracy=1e-3"]
    torn = simulate(read_scenario(SCENARIOS / "fms_reference.toml", [*LOW, *short]), tmp_path / "torn.h5").summary
    said = [w for w in torn["warnings"] if w.startswith("floor of the pressure")]
    assert len(said) == 1 and "leakage" in said[0] and "reynolds" in said[0]
    full = simulate(read_scenario(SCENARIOS / "fms_reference.toml", ["film.cavitation_pressure=0", *short]),
                    tmp_path / "full.h5").summary  # fmt: skip
    assert not [w for w in full["warnings"] if "floor" in w]
