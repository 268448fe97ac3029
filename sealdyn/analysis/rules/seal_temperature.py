"""Temperature that the secondary seal stands."""

from ._finding import Verdict, missing, other_seals, within

SOURCE = "nitrile 380 K, fluoroelastomer 450 to 477 K"
COMMAND = ""

# Of the material (K): no doubt below the first, not beyond the second.
MOST = {"nitrile": (380.0, 380.0), "fluoroelastomer": (450.0, 477.0)}


def finding(seal):
    """Pass up to the material's temperature; a note where the guide's own numbers leave it open."""
    material, temperature = seal.application.secondary_seal_material, seal.highest_temperature
    if material is None:
        return missing("application.secondary_seal_material")
    if material not in MOST:
        return other_seals("the rule knows nitrile and fluoroelastomer")
    if temperature is None:
        return missing("application.highest_temperature")
    sure, most = MOST[material]
    said = f"{temperature:.4g} K at a secondary seal of {material}, good to {sure:g} K"
    if most > sure:
        said += f", at most {most:g} K"
    if sure < temperature <= most:
        return within(said, temperature, "K", most=sure, beyond=Verdict.NOTE)
    return within(said, temperature, "K", most=most)
