"""A gas dam from the command line."""

import numpy as np
import pytest
from command import SCENARIOS, sealdyn

from sealdyn.archive import column

REFERENCE = SCENARIOS / "gas_dam_reference.toml"


@pytest.mark.core
def test_reference_follows_its_seat(tmp_path):
    done = sealdyn("run", REFERENCE, "--out", "x.h5", "--json", "--no-plot", cwd=tmp_path)
    assert done.code == 0 and done.found["status"] == "ok"
    assert any("no squeeze film" in reason for reason in done.found["model"]["reasons"])
    tracking = done.found["relative_misalignment"]["max"]
    assert tracking < 0.05 * 1.5e-5
    flows = [column(tmp_path / "x.h5", f"mass_flow_{side}") for side in ("inner", "outer")]
    assert np.array_equal(*flows) and np.all(flows[0] > 0)
    # Kilograms are what volumes at normal conditions weigh.
    leakage = done.found["leakage"]
    assert leakage["conditions"] == {"temperature": 273.15, "pressure": 101325.0}
    assert leakage["mean_kg_per_h"] == pytest.approx(3600 * flows[0].mean(), rel=1e-3)
