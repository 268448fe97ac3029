"""The profiled film: the radial film between faces that are not plain cones."""
