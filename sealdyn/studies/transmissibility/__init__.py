"""The study `transmissibility`."""
