"""The equations of motion of the rings: unknowns, forces, linear form, events, signals."""
