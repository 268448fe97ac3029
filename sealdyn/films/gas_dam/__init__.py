"""The gas dam: compressible flow across the face, at every angle by itself."""

from .._contract import Offer

OFFER = Offer(name="gas_dam", fidelity=2, fluids=("gas",))
