"""Two-dimensional film of a liquid with mass-conserving cavitation: Reynolds' equation on cells over radius and angle.

mesh.py: cells and what the film thickness makes of them; roughness.py: rough faces; pressure.py: the flow balance of
every cell and its linear system; cavitation.py: which cells are full, at a gap state; balance.py: the same in motion;
wrench.py: force, moments, leakage, friction; film.py: the film that scenes ask for.
"""

# Costs more than what "auto" chooses for.
BY_NAME = True
