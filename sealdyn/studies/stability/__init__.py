"""The study `stability`."""
