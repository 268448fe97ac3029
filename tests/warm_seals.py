"""Warm seals that the tests share: the pump of the README in water that warms, and rows of an independent computation
(other films, other quadrature, other root finding; a sheet of the field's formulas has their derivation).

Tolerances are those that the rows were given with.
"""

from sealdyn import Scenario
from sealdyn.dynamics.warm_state import at_work

# The README's pump in water of 30 degC, with a carbon ring that floats and a ring of silicon carbide that turns.
PUMP = {
    "shaft": {"speed": 308.923278},
    "rotor": {"runout": "20 um TIR"},
    "closing": {"balance_ratio": 0.75, "spring_force": 40.0},
    "film": {
        "inner_radius": 0.025, "outer_radius": 0.03, "coning": 5e-5, "liquid": "water", "temperature": 303.15,
        "outer_pressure": 1.1e6, "inner_pressure": 1e5,
        "heat": {
            "stator": {"resistance": 0.4055, "coning_per_watt": 2.557e-6, "time_constant": 2.05},
            "rotor": {"resistance": 0.05496, "coning_per_watt": 3.038e-7, "time_constant": 0.614},
        },
    },
    "stator": {
        "mass": 0.12, "transverse_inertia": 5e-5,
        "support": {"axial_stiffness": 3e4, "axial_damping": 50.0, "radius": 0.027},
    },
}  # fmt: skip
# A seal with asperities that carry a quarter of its load, in water of 40 degC.
ROUGH = {
    "shaft.speed": 308.923278,
    "film.inner_radius": 0.0305,
    "film.outer_radius": 0.034,
    "film.outer_pressure": 1101325.0,
    "film.inner_pressure": 101325.0,
    "film.temperature": 313.15,
    "closing.balance_ratio": 0.8,
    "closing.spring_force": 100.0,
    "contact": {"roughness": 1e-7, "compressive_strength": 1e8, "friction_coefficient": 0.1},
    "film.heat": {
        "stator": {"resistance": 0.3694, "coning_per_watt": 2.5756e-6, "time_constant": 1.169},
        "rotor": {"resistance": 0.04777, "coning_per_watt": 2.494e-7, "time_constant": 0.517},
    },
}
# A seal with the pressure inside, whose faces close as they warm.
INSIDE = {
    "shaft.speed": 314.159265,
    "film.coning": -2e-4,
    "film.outer_pressure": 1e5,
    "film.inner_pressure": 1.1e6,
    "film.heat": {
        "stator": {"resistance": 0.45, "coning_per_watt": 0.0, "time_constant": 1.0},
        "rotor": {"resistance": 0.065, "coning_per_watt": 1.9e-7, "time_constant": 1.0},
    },
}
VG32 = {
    "density": 870.0,
    "specific_heat": 2000.0,
    "viscosity": [["40 degC", "32 mm^2/s"], ["100 degC", "5.4 mm^2/s"]],
}
# A seal in oil, whose faces open sixfold.
OIL = {
    "shaft.speed": 314.159265,
    "film.inner_radius": 0.035,
    "film.outer_radius": 0.04,
    "film.coning": 2e-4,
    "film.outer_pressure": 2.1e6,
    "film.temperature": 333.15,
    "film.liquid": VG32,
    "closing.balance_ratio": 0.78,
    "closing.spring_force": 100.0,
    "film.heat": {
        "stator": {"resistance": 0.2684, "coning_per_watt": 2.0858e-6, "time_constant": 22.2},
        "rotor": {"resistance": 0.32203, "coning_per_watt": 7.7034e-6, "time_constant": 10.9},
    },
}
# What changes the pump, then its warm states, the coolest first: rise (K), coning (rad), clearance (m), viscosity
# (Pa s), heat, of it of the viscous film and of the asperities (W), leakage (m^3/s), loop gain; or None.
NAMES = ("rise", "coning", "clearance", "viscosity", "power", "viscous", "contact_power", "leakage", "loop_gain")
ROWS = {
    "pump, 400 urad": (
        {"film.coning": 4e-4},
        [(1.3373, 4.1583e-4, 8.4211e-7, 7.7802e-4, 27.694, 27.683, 0.0, 1.1287e-8, -0.0662)],
    ),
    "pump, 50 urad": (
        {},
        [(4.8342, 1.0721e-4, 2.1711e-7, 7.2375e-4, 99.885, 99.884, 0.0, 2.0792e-10, -0.631)],
    ),
    "rough": (ROUGH, [(8.0858, 1.4859e-4, 1.8413e-7, 5.6463e-4, 191.16, 99.23, 91.934, 3.1298e-10, -0.507)]),
    "inside, 3000 rpm": (
        INSIDE,
        [
            (4.5291, -1.8676e-4, 1.2104e-6, 7.2824e-4, 79.755, 79.754, 0.0, 6.2914e-10, -0.0211),
            (66.686, -5.0708e-6, 3.2862e-8, None, 1174.1, None, None, None, None),
        ],
    ),
    "inside, 6000 rpm": (
        INSIDE | {"shaft.speed": 628.31853},
        [
            (17.818, -1.4792e-4, 9.586e-7, 5.6725e-4, 313.75, 313.75, 0.0, 4.0126e-10, 0.0421),
            (60.154, -2.4166e-5, 1.5661e-7, 3.1284e-4, 1059.1, 1059.1, 0.0, 3.1729e-12, 6.59),
        ],
    ),
    "oil": (OIL, [(31.224, 1.1896e-3, 1.8306e-6, 5.6729e-3, 216.33, 216.22, 0.0, 5.5971e-8, -1.53)]),
}
# Clearance (m) and friction (W) before anything is warm.
COLD = {
    "pump, 400 urad": (8.1006e-7, 29.609),
    "pump, 50 urad": (1.0126e-7, 236.87),
    "rough": (1.94248e-7, 348.95),
    "oil": (3.0777e-7, 2995.1),
}
# Speed (rpm) from which the seal INSIDE has no warm state, its viscosity that of 30 degC, and in water.
FOLDS = 5754.0, 8010.0
# Of the pump of 50 urad, cold and warm: axial stiffness (N/m), tilt stiffness (N m/rad), tilt damping (N m s/rad).
COEFFICIENTS = (9.804e8, 3.0064e5, 6.363e5), (4.572e8, 1.4022e5, 5.8363e4)
TOLERANCE = 1e-3


def warm_seal(*changes, **values) -> Scenario:
    """The pump with values set in it, tables of dotted keys one after the other."""
    scenario = Scenario.from_dict(PUMP, "warm")
    for table in (*changes, {key.replace("__", "."): value for key, value in values.items()}):
        scenario = scenario.with_(table) if table else scenario
    return scenario


def by_hand(scenario, speed=None) -> Scenario:
    """The same seal without heat, the numbers of the warm state it works in, at a speed (rad/s) if given, in place of
    liquid and coning."""
    plain, state = at_work(scenario.scene, speed)
    table = scenario.to_dict()
    film = {k: v for k, v in table["film"].items() if k not in ("heat", "liquid", "temperature")}
    liquid = {name: getattr(plain.film, name) for name in ("density", "specific_heat", "vapour_pressure")}
    film |= {"viscosity": state.viscosity, "coning": state.coning} | {k: v for k, v in liquid.items() if v is not None}
    turning = {} if speed is None else {"shaft": {"speed": speed}}
    return Scenario.from_dict(table | {"film": film} | turning, "warm")


def scene_of(*changes, **values):
    """The scene of `warm_seal`."""
    return warm_seal(*changes, **values).scene
