"""Vibration: what a shaking housing does to the film, over frequency."""
