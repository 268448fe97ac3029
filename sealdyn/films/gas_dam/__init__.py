"""The gas dam: compressible flow across the face, at every angle by itself."""

FLUIDS = ("gas",)
