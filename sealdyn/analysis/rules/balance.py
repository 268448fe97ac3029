"""Sealed pressure, by balance."""

from ._finding import missing, within

SOURCE = "100 psi unbalanced; the guide prints the balance, a pure number, once in N/m^2"
COMMAND = "sealdyn study equilibrium FILE"

# Sealed pressure (Pa): closing area not less than the face, or less.
UNBALANCED, BALANCED = 68.9e4, 689e4


def finding(seal):
    """Pass up to 68.9 N/cm^2 with a balance (closing area over face area) of 1 or more, 689 N/cm^2 below."""
    pressure, balance = seal.sealed_pressure, seal.model.closing.balance_ratio
    if pressure == 0.0:
        return missing("film.outer_pressure", "film.inner_pressure", "application.highest_pressure")
    most, kind = (UNBALANCED, "unbalanced") if balance >= 1.0 else (BALANCED, "balanced")
    closing = seal.scene.closing
    told = "" if closing.balance_ratio is not None else ", as the clearance asks for"
    said = (
        f"{pressure / 1e4:.4g} N/cm^2 sealed by a seal of balance {balance:.4g}{told}; {kind} seals take up to "
        f"{most / 1e4:.4g} N/cm^2"
    )
    return within(said, pressure, "Pa", most=most, balance=balance)
