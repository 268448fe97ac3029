"""What the film shows over its faces at given times: pressure and the like."""

import numpy as np

from .signals import samples


def fields_of(model) -> tuple:
    """Fields (films/_fields.py) of the film that is reported, none of one that declares none."""
    return getattr(model.observed[0], "FIELDS", ())


def field_grid(model) -> tuple[np.ndarray, np.ndarray]:
    """Radii (m) and angles (rad, from the x axis) at which they are given."""
    film, f = model.observed
    return film.grid(f)


def fields(segment, taus, q, q_rate, x=None) -> dict[str, np.ndarray]:
    """Fields (m, radii, angles) at times (m,) of a segment, given as to `signals`; SI."""
    table = fields_of(segment.model)
    (film, f), gap = segment.model.observed, samples(segment, taus, q, q_rate, x).gap
    out = np.empty((len(taus), len(table), *map(len, field_grid(segment.model))))
    for i in range(len(taus)):
        own = () if x is None else (x[i],)
        film.fields(f, gap[i], *own, out[i])
    return {field.name: out[:, k] for k, field in enumerate(table)}
