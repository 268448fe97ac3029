"""Film thickness."""

from ._finding import Verdict, within

SOURCE = "typical film"
COMMAND = "sealdyn run FILE"

LEAST, MOST = 1.25e-6, 2.5e-6


def finding(seal):
    """Pass from 1.25 to 2.5 um at the mean radius of the aligned faces; else a note: typical is no limit."""
    film = seal.film_thickness
    said = f"film {1e6 * film:.4g} um at the mean radius, typical are {1e6 * LEAST:g} to {1e6 * MOST:g} um"
    return within(said, film, "m", LEAST, MOST, beyond=Verdict.NOTE)
