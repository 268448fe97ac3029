"""What several studies share: orbits, whirls, branches, arrangements."""
