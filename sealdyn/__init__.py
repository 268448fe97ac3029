"""sealdyn: time-domain rotor dynamics of flexibly mounted mechanical face seals."""

__version__ = "0.1.0"
