"""What the shaft feels in a run whose shaft moves as a harmonic, beside the impedance of the linearised seal."""

import math

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn import Simulation, read_scenario
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.modes import at_shaft
from sealdyn.scene.scene import frozen_at_start

# Of the shaft's motion: frequency over speed, and amplitude in clearances.
RATIO, SHARE = 0.7, 1e-3
STILL = {"rotor.runout": 0.0, "rotor.misalignment": 0.0, "stator.misalignment": 0.0}
ROTOR = {"mass": 0.8, "transverse_inertia": 6e-4, "polar_inertia": 1.1e-3,
         "support": {"axial_stiffness": 6e5, "axial_damping": 400.0, "radius": 0.04}}  # fmt: skip


def scenario_of(kind, fluid):
    """A seal with a floating stator (FMS), rotor (FMR) or both, in a liquid, in a gas without and with a memory."""
    name = {"liquid": "fms_reference", "gas": "gas_dam_reference", "stored gas": "gas_reynolds_reference"}[fluid]
    tables = read_scenario(SCENARIOS / f"{name}.toml").to_dict()
    radius = 0.068 if fluid == "stored gas" else 0.04
    ring = {**ROTOR, "support": {**ROTOR["support"], "radius": radius}}
    tables = {key: value for key, value in tables.items() if key in ("shaft", "film", "rotor", "stator", "closing")}
    tables["rotor"] = ring if "R" in kind else {}
    tables["stator"] = {**ring, "mass": 1.1} if "S" in kind else {}
    if fluid == "stored gas":
        tables["film"]["gas_reynolds"] = {"cells": [6, 16]}
    tables["run"] = {"turns": 20, "start": "steady", "accuracy": 1e-6}
    return type(read_scenario(SCENARIOS / f"{name}.toml")).from_dict(tables)


@pytest.mark.core
@pytest.mark.parametrize("fluid", ["liquid", "gas", "stored gas"])
@pytest.mark.parametrize("kind", ["FMS", "FMR", "FMSR"])
def test_the_reaction_of_a_run_is_that_of_the_impedance(kind, fluid):
    """Axially and in tilt at once, from the steady response on."""
    scenario = scenario_of(kind, fluid)
    linear = Model(frozen_at_start(scenario.scene)).linear_scene()
    speed = scenario.scene.shaft.speed
    gap, radius, w = Model(scenario.scene).clearance, scenario.scene.film.outer_radius, RATIO * speed
    move, tilt = SHARE * gap, SHARE * gap / radius
    seal = Simulation(scenario.with_({
        "shaft.whirl": [{"ratio": RATIO, "angle": tilt}], "rotor.axial_runout": [{"order": RATIO, "amplitude": move}],
    }))  # fmt: skip
    seal.step(20 * 2 * math.pi / w)
    rows = []
    for _ in range(16):
        state = seal.step(2 * math.pi / w / 16)
        moment = complex(state["shaft_moment_x"], state["shaft_moment_y"])
        rows.append((state["time"], state["shaft_force"], moment * np.exp(-1j * w * state["time"])))
    t, force, moment = np.array(rows).T
    z = at_shaft(linear, abs(w))
    parts = np.stack([np.ones(len(t)), np.cos(w * t.real), np.sin(w * t.real)], axis=1)
    _, a, b = np.linalg.lstsq(parts, force.real, rcond=None)[0]
    assert -(a - 1j * b) / move == pytest.approx(z[0, 0], rel=1e-4)
    # Of g = g_x + i g_y that goes with exp(i w t).
    assert -np.mean(moment) / tilt == pytest.approx(z[1, 1] - 1j * z[1, 2], rel=1e-4)
