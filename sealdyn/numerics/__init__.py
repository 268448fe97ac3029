"""Right for any function, time series or eigenproblem: interpolation, exponents, checkpoints, orders."""
