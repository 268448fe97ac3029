"""Axial travel that the spring must take up."""

from ._finding import missing, within

SOURCE = "axial displacement"
COMMAND = ""

MOST = {"wave_washer": 0.76e-3, "coil": 1.27e-3, "bellows": 1.27e-3}
NAMES = {"wave_washer": "a wave washer takes", "coil": "coil springs take", "bellows": "bellows take"}


def finding(seal):
    """Pass up to 0.76 mm with a wave washer, 1.27 mm with coil springs or bellows; without a kind of spring what all of
    them take passes and what none of them does fails."""
    travel, kind = seal.application.axial_displacement, seal.application.spring
    if travel is None:
        return missing("application.axial_displacement")
    said = f"axial travel {1e3 * travel:.4g} mm"
    if kind is None and min(MOST.values()) < travel <= max(MOST.values()):
        return missing("application.spring")
    if kind is None:
        most, words = (min if travel <= min(MOST.values()) else max)(MOST.values()), "springs take"
    else:
        most, words = MOST[kind], NAMES[kind]
    said += f", {words} up to {1e3 * most:.4g} mm"
    if travel > max(MOST.values()):
        said += ": beyond it a seal that rides on the shaft"
    return within(said, travel, "m", most=most)
