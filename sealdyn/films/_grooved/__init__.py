"""Films between faces of which one has a pattern, in the frame of that pattern: triangles on one pitch, the steady
aligned film, small motion about it, and the film of a run."""
