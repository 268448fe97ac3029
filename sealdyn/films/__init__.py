"""Films: one file per rung of the ladder, found by file name.

What every film module offers (the contract):

`RUNG`            int, its place on the ladder (1 linear, 2 radial, ...); "auto" climbs it.
`UNKNOWNS`        number of unknowns the film owns; 0 for an algebraic law.
`parameters(film, clearance)`
                  float64 array: the film's block of the parameter array, for a `Film` table and the
                  design clearance (m).  The kernels below get this block.
`opening_force(film, clearance, inner_pressure, outer_pressure)`
                  force (N) of the aligned film at rest, for the equilibrium.
`wrench(f, s)`    compiled kernel: film block `f`, gap state `s` (slots named in gap.py) -> writes
                  force and moments on the stator into `s`.
`flow(f, s)`      compiled kernel: as `wrench`, and also leakage, friction torque into `s`.

A film never asks which ring floats, and imports no other film.
"""
