"""Ramps of the shaft speed, a pressure, ...: the trip, its orders, what grows on it, what linear theory foretells."""
