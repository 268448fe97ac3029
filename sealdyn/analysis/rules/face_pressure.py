"""Face pressure of the spring alone."""

from ._finding import missing, within

SOURCE = "10 to 30 psi; section 2.2.4.3 prints 5.89 to 26.5 N/cm^2 for it, a misprint"
COMMAND = "sealdyn study equilibrium FILE"

LEAST, MOST = 6.89e4, 20.7e4


def finding(seal):
    """Pass from 6.89 to 20.7 N/cm^2, spring force over the whole face."""
    if seal.spring_force is None:
        return missing("closing.spring_force")
    pressure = seal.spring_force / seal.face_area
    said = f"the spring presses the faces with {pressure / 1e4:.4g} N/cm^2, usual are {LEAST / 1e4:g} to {MOST / 1e4:g}"
    return within(said, pressure, "Pa", LEAST, MOST)
