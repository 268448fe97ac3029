"""A ring on its springs: the resonance that the design rule finds is where a shaken ring moves most in time."""

import math

import numpy as np
import pytest

from sealdyn.analysis.design_rules import findings
from sealdyn.archive import column
from sealdyn.scenario.reader import parse_scenario
from sealdyn.simulation.simulate import prepare_run, simulate

MASS, STIFFNESS, DAMPING = 0.12, 30e3, 6.0
NATURAL = math.sqrt(STIFFNESS / MASS) / (2 * math.pi)
# A film that does nothing: the guide's rule is of the springs alone.
SEAL = f"""
shaft.speed = "2950 rpm"
[film]
model = "linear"
inner_radius = "25 mm"
outer_radius = "30 mm"
clearance = "10 um"
viscosity = "1e-9 Pa*s"
outer_pressure = "1 bar"
inner_pressure = "1 bar"
coefficients = {{ tilt_stiffness = 0, tilt_damping = 0, axial_stiffness = 0, axial_damping = 0 }}
[stator]
mass = {MASS}
transverse_inertia = "5e-5 kg*m^2"
support = {{ axial_stiffness = {STIFFNESS}, axial_damping = {DAMPING}, radius = "10 mm" }}
[run]
duration = "2 s"
samples = 20000
"""


@pytest.mark.core
@pytest.mark.parametrize(("share", "verdict"), [(0.85, "pass"), (1.0, "fail"), (1.15, "pass")])
def test_a_shaken_ring_moves_most_where_the_rule_fails(tmp_path, share, verdict):
    """Amplitude over the housing's, settled: sqrt(1 + (2 D r)^2)/sqrt((1 - r^2)^2 + (2 D r)^2): 3.5, 10 and 2.9."""
    tone = f"housing.axial=[{{frequency={share * NATURAL},displacement=1e-8}}]"
    scenario = parse_scenario(SEAL, "shaken.toml", [tone])
    row = next(r for r in findings(scenario, prepare_run(scenario)[0].model) if r["rule"] == "gear_resonance")
    assert row["verdict"] == verdict and row["value"] == pytest.approx(NATURAL, rel=1e-12)
    result = simulate(scenario, tmp_path / "shaken.h5")
    time, z = (column(result.archive, name) for name in ("time", "stator_z"))
    damped = 2 * DAMPING / (2 * math.sqrt(STIFFNESS * MASS)) * share
    expected = math.sqrt(1 + damped**2) / math.hypot(1 - share**2, damped)
    assert np.max(np.abs(z[time > 1.5])) / 1e-8 == pytest.approx(expected, rel=1e-3)
    assert (expected > 5) == (verdict == "fail")
