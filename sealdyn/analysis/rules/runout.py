"""Radial runout of the shaft that a face seal takes, by sliding speed."""

from ._finding import Verdict, missing, within

SOURCE = "table 3.8"
COMMAND = ""

# Up to a sliding speed (m/min), total indicator reading (m).
ALLOWED = ((1522.0, 0.508e-3), (3044.0, 0.38e-3), (6090.0, 0.254e-3))


def finding(seal):
    """Pass up to the runout of its row; beyond the table's last speed no more than in its last row, and a note."""
    runout = seal.application.shaft_runout
    if runout is None:
        return missing("application.shaft_runout")
    speed = 60 * seal.sliding_speed
    most = next((allowed for fastest, allowed in ALLOWED if speed <= fastest), None)
    said = f"shaft runout {1e3 * runout:.4g} mm TIR at {speed:.4g} m/min"
    if most is not None:
        return within(f"{said}, {1e3 * most:.4g} mm allowed", runout, "m", most=most)
    last, most = ALLOWED[-1]
    said += f", beyond the table, which ends with {1e3 * most:.4g} mm at {last:.0f} m/min"
    found = within(said, runout, "m", most=most)
    return found if found.verdict == Verdict.FAIL else within(said, runout, "m", most=0.0, beyond=Verdict.NOTE)
