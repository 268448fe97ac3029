"""The study `tolerance`."""
