"""Grooved faces with films computed elsewhere: rows of an independent prototype (two families of meshes, extrapolated).

`force` above the lower pressure (N), `outflow` (gas Pa m^3/s, liquid m^3/s), `torque` (N m); `axial_K_at_nW` and
`axial_wD_at_nW` (N/m), `tilt_Z_at_nW` (N m, inertial, real and imaginary) at n times the shaft speed; each with its
tolerance."""

import math
from functools import cache

from sealdyn.analysis.sources.grooved_faces import TEE, conditions_of, grooved_rows, pattern_of
from sealdyn.faces.pattern import Spiral
from sealdyn.films._grooved.balance import Conditions, steady, steady_pair
from sealdyn.films._grooved.mesh import mesh_of

__all__ = [
    "AREA",
    "FACES_TOML",
    "GAS",
    "LIQUID",
    "RINGS_TOML",
    "ROWS",
    "R_I",
    "R_O",
    "SEAL_TOML",
    "SPIRAL",
    "TEE",
    "film",
    "films_of",
    "pattern_of",
]  # fmt: skip
ROWS = grooved_rows()
# The face of row gas_5bar in a scenario: what follows `[film]`, and the rings, up to what else the support has.
FACES_TOML = """
gas = "air"
temperature = "300 K"
viscosity = "1.8e-5 Pa*s"
inner_radius = "51.6 mm"
outer_radius = "61.6 mm"
inner_pressure = "1 bar"
"""
RINGS_TOML = """
[[rotor.grooves]]
count = 12
depth = "6 um"
inner_radius = "55.5 mm"
outer_radius = "61.6 mm"
angle = "15 deg"
share = 0.5
[stator]
mass = "0.2 kg"
transverse_inertia = "3.5e-4 kg*m^2"
[stator.support]
axial_stiffness = "1.64e4 N/m"
tilt_stiffness = "31 N*m/rad"
"""
SEAL_TOML = f"""
[shaft]
speed = "1000 rad/s"
[film]
{FACES_TOML}
outer_pressure = "5 bar"
clearance = "3 um"
{RINGS_TOML}
axial_damping = "1e3 N*s/m"
tilt_damping = "1.4 N*m*s/rad"
[run]
turns = 5
"""
R_I, R_O = 0.0516, 0.0616
AREA = math.pi * (R_O**2 - R_I**2)
SPIRAL = Spiral(12, 0.0555, R_O, math.radians(15.0), 0.5, 6e-6)
GAS = Conditions(3e-6, 1.8e-5, 1e5, 5e5, 1000.0)
LIQUID = Conditions(3e-6, 1e-3, 1e5, 5e5, 300.0, gas=False)


@cache
def films_of(name):
    """The steady film of a row on two meshes, and the order of their error."""
    row = ROWS[name]
    return steady_pair(pattern_of(row), row["inner_radius"], row["outer_radius"], conditions_of(row))


def film(pattern=SPIRAL, conditions=GAS, columns=8, **mesh):
    """A steady film on a coarse mesh of the face of row gas_5bar."""
    return steady(mesh_of(pattern, R_I, R_O, columns, **mesh), conditions)
