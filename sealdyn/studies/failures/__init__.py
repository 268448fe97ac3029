"""The study `failures` and its cases."""
