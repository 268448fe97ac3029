"""Radial followers: lip and circumferential seals, elements that a preload holds on a turning shaft."""
