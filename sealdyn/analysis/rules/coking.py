"""Temperature at which the lubricant cokes."""

from ._finding import missing, other_seals, within

SOURCE = "lubricants coke near 505 K"
COMMAND = ""

MOST = 505.0


def finding(seal):
    """Pass up to 505 K."""
    if seal.scene.film.gas is not None:
        return other_seals("the film is a gas")
    temperature = seal.highest_temperature
    if temperature is None:
        return missing("application.highest_temperature")
    return within(f"{temperature:.4g} K, lubricants coke near {MOST:g} K", temperature, "K", most=MOST)
