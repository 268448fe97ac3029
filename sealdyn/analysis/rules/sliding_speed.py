"""Sliding speed at the mean face diameter, and other seals that it would suit."""

from ._finding import Verdict, within

SOURCE = "tables 3.1 to 3.4 for the other seals"
COMMAND = ""

# Metres per minute, as printed: 20 000 ft/min, and rounded of 15 000, 7000 and 4000 ft/min.
FACE = 6096.0 / 60
OTHERS = {
    "a conventional lip seal": 1220.0 / 60,
    "a hydrodynamic lip seal": 2135.0 / 60,
    "a circumferential seal": 4550.0 / 60,
}


def finding(seal):
    """Pass up to 6096 m/min; more "is possible with proper cooling": a note."""
    speed = seal.sliding_speed
    said = f"sliding speed {60 * speed:.4g} m/min at the mean diameter, face seals go up to {60 * FACE:.0f} m/min"
    if speed > FACE:
        said += ": more is possible with proper cooling"
    suited = [f"{name} (up to {60 * limit:.0f} m/min)" for name, limit in OTHERS.items() if speed <= limit]
    if suited:
        said += f"; this speed would also suit {', '.join(suited)}"
    return within(said, speed, "m/s", most=FACE, beyond=Verdict.NOTE, also_suited=suited)
