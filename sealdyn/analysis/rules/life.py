"""Running time between overhauls."""

from ._finding import Verdict, missing, within

SOURCE = "1500 h between overhauls"
COMMAND = "sealdyn study wear FILE"

MOST = 1500 * 3600.0


def finding(seal):
    """Pass up to 1500 h, what seals were asked for; more is a note."""
    life = seal.application.life
    if life is None:
        return missing("application.life")
    said = f"asked for {life / 3600:.4g} h between overhauls, seals of the guide for {MOST / 3600:g} h"
    return within(said, life, "s", most=MOST, beyond=Verdict.NOTE)
