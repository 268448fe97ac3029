"""The radial film: Reynolds' equation solved over the radius at every angle."""

from .._contract import Offer

OFFER = Offer(name="radial", fidelity=2)
