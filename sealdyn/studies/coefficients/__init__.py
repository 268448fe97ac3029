"""The study `coefficients`."""
