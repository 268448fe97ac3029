"""The study `work-precision`."""
