"""Two-dimensional film of a liquid with mass-conserving cavitation: Reynolds' equation on cells over radius and angle.

mesh.py: cells and what the film thickness makes of them; pressure.py: the flow balance of every cell, its linear
system, which cells are full at a gap state, and what they add up to; balance.py: the same in motion; film.py: the film
that scenes ask for.
"""

from .._contract import Offer

# Costs more than what "auto" chooses for.
OFFER = Offer(name="reynolds", fidelity=4, only_on_request=True)
