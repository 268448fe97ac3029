"""Small seals that start from rest and come back to it, each a scenario of its own kind of faces, film and friction.

A cycle is still, up to speed, at speed, down, and still again; the same seal at its final speed turns as often.
Of tests/benchmark/startups.py (all, by processor time) and tests/failure/test_start_and_stop.py (a few, by counts).
"""

import math
from collections.abc import Mapping
from pathlib import Path

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.reader import Scenario, read_scenario, with_values

SCENARIOS = Path(__file__).parents[1] / "scenarios"
COULOMB = {"stator.secondary_seal": {"radius": 0.033, "friction_force": 5.0}}
SMOOTH = {"stator.secondary_seal": {"radius": 0.033, "friction_force": 5.0, "law": "regularised", "width": 1e-4}}
DRY = {"film.outer_pressure": 1e5, "film.inner_pressure": 1e5, "film.viscosity": 18e-6}
GAS = {"film.gas": "air", "film.temperature": 300.0, "film.outer_pressure": 5e5, "run.accuracy": 1e-3}
CONSTANT_RUNOUT = {"rotor.runout": 25e-6, "run.start": "auto", "run.accuracy": 1e-4}
CELLS = {"film.reynolds": {"cells_r": 6, "cells_theta": 36, "grid_accuracy": 0.5}}
CAVITATING = {"film.model": "reynolds", "film.cavitation_pressure": 0.0, **CELLS}

# Name: (scenario it is drawn from, what is changed).
SEALS: dict[str, tuple[str, dict]] = {
    "liquid": ("pump_seal", {}),
    "liquid, flat": ("pump_seal", {"film.coning": 0.0}),
    "liquid, coned": ("pump_seal", {"film.coning": 3e-4}),
    "liquid, hard pressed": ("pump_seal", {"closing.spring_force": 600.0}),
    "gas dam, touching": ("pump_seal", {**GAS, "film.model": "gas_dam"}),
    "dry": ("pump_seal", DRY),
    "dry, rough": ("pump_seal", {**DRY, "contact.roughness": 5e-7}),
    "dry, running out": ("pump_seal", {**DRY, "rotor.runout": 1e-4}),
    "dry, O-ring": ("pump_seal", {**DRY, **COULOMB}),
    "dry, smooth O-ring": ("pump_seal", {**DRY, **SMOOTH}),
    "liquid, O-ring": ("pump_seal", COULOMB),
    "liquid, tight O-ring": (
        "pump_seal",
        {"stator.secondary_seal": {"radius": 0.033, "friction_force": 60.0}},
    ),
    "no contact, flexible rotor": ("fmr_reference", {"run.accuracy": 1e-4}),
    "no contact, O-ring": ("fms_reference", {**COULOMB, "run.accuracy": 1e-4}),
    "asperities near by": ("rub", CONSTANT_RUNOUT),
    "no mass": ("massless_ring", {"run.accuracy": 1e-4}),
    "gas dam": ("gas_dam_reference", {"run.accuracy": 1e-4}),
    "gas dam, O-ring": ("gas_dam_reference", {**COULOMB, "run.accuracy": 1e-3}),
    "gas cells": ("gas_reynolds_reference", {"film.gas_reynolds.cells": [4, 12]}),
    "cavitating": ("rub", {**CONSTANT_RUNOUT, **CAVITATING, "run.accuracy": 1e-2}),
}


def cycle(name: str, turns: float, over: Mapping = {}) -> tuple[Scenario, Scenario]:
    """A seal of SEALS from rest to its speed and back to rest in so many `turns`, and the same at its speed for as
    many; `over` changes both."""
    file, changes = SEALS[name]
    seal = read_scenario(SCENARIOS / f"{file}.toml")
    if seal.scene.film.heat is not None:
        # Isothermal: a gas, or a film of nothing, has none of its heat.
        tables = seal.to_dict()
        tables["film"] = {k: v for k, v in tables["film"].items() if k not in ("liquid", "temperature", "heat")}
        seal = Scenario.from_dict(tables | {"film": tables["film"] | {"viscosity": 0.65e-3}}, file)
    seal = with_values(seal, {**changes, **over})
    speed = seal.scene.shaft.speed
    # Up and down take twice the time that their turns take at speed.
    unit = 0.25 * turns * 2 * math.pi / abs(speed)
    times = tuple(unit * t for t in (0.0, 0.2, 2.2, 4.2, 6.2, 6.4))
    ramp = PiecewiseLinear(times, tuple(speed * v for v in (0.0, 0.0, 1.0, 1.0, 0.0, 0.0)))
    moving = with_values(seal, {"shaft.speed": ramp, "run.duration": times[-1]})
    return moving, with_values(seal, {"run.turns": turns})
