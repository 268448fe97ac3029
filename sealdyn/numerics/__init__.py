"""Right for any function, time series or eigenproblem: interpolation, exponents, orders; many points and where they
are kept."""
