"""Film of a gas with storage: the unsteady isothermal Reynolds equation on cells over radius and angle."""

from .._contract import Offer

OFFER = Offer(name="gas_reynolds", fidelity=3, fluids=("gas",))
