"""Grooved faces with films computed elsewhere: rows of an independent prototype (two families of meshes, extrapolated).

`force` above the lower pressure (N), `outflow` (gas Pa m^3/s, liquid m^3/s), `torque` (N m); `axial_K_at_nW` and
`axial_wD_at_nW` (N/m), `tilt_Z_at_nW` (N m, inertial, real and imaginary) at n times the shaft speed; each with its
tolerance."""

import json
import math
from functools import cache
from pathlib import Path

from sealdyn.faces.pattern import Box, Spiral, tee
from sealdyn.films._grooved.balance import Conditions, steady, steady_pair
from sealdyn.films._grooved.mesh import mesh_of

ROWS = json.loads((Path(__file__).parent / "grooved_rows.json").read_text())
R_I, R_O = 0.0516, 0.0616
AREA = math.pi * (R_O**2 - R_I**2)
SPIRAL = Spiral(12, 0.0555, R_O, math.radians(15.0), 0.5, 6e-6)
TEE = tee(12, 6e-6, Box(0.0555, 0.0585, 0.7), Box(0.0585, R_O, 0.2))
GAS = Conditions(3e-6, 1.8e-5, 1e5, 5e5, 1000.0)
LIQUID = Conditions(3e-6, 1e-3, 1e5, 5e5, 300.0, gas=False)


def pattern_of(row):
    if row["spiral"] is None:
        return TEE
    count, inner, outer, degrees, share, depth = row["spiral"]
    return Spiral(count, inner, outer, math.radians(degrees), share, depth)


@cache
def films_of(name):
    """The steady film of a row on two meshes, and the order of their error."""
    row = ROWS[name]
    keys = "clearance", "viscosity", "inner_pressure", "outer_pressure", "shaft_speed"
    conditions = Conditions(*(row[key] for key in keys), gas=row["gas"])
    return steady_pair(pattern_of(row), row["inner_radius"], row["outer_radius"], conditions)


def film(pattern=SPIRAL, conditions=GAS, columns=8, **mesh):
    """A steady film on a coarse mesh of the face of row gas_5bar."""
    return steady(mesh_of(pattern, R_I, R_O, columns, **mesh), conditions)
