"""The study `wear`."""
