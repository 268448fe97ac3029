"""The names of the package, as the README uses them."""

from pathlib import Path

import sealdyn

SCENARIO = Path(__file__).parents[2] / "scenarios" / "axial_only.toml"


def test_the_readme_program_runs_and_runs_again(tmp_path):
    """A package's attribute is taken by a submodule of its name as soon as that is imported: there must be none."""
    scenario = sealdyn.read_scenario(SCENARIO, ["run.samples=50"])
    for _ in range(2):
        result = sealdyn.simulate(scenario, tmp_path / "mine.h5")
        assert result.status == "ok"
        with sealdyn.open_archive(result.archive) as data:
            assert data["h_min"].shape == (51,)
    for name in sealdyn.__all__:
        assert callable(getattr(sealdyn, name))
