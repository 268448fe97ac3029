"""Film of a gas with storage: the unsteady isothermal Reynolds equation on cells over radius and angle."""

FLUIDS = ("gas",)
