"""The radial film: Reynolds' equation solved over the radius at every angle."""
