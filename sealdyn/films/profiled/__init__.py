"""The profiled film: the radial film between faces that are not plain cones."""

from .._contract import Offer

OFFER = Offer(name="profiled", fidelity=2, generalises="radial")
