"""Integrators of any problem, and how wrong a step is; nothing here knows of seals or files."""
