"""Geometry, roughness and contact of the two faces; not what flows between them."""
