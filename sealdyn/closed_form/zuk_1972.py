"""The published numbers of a main-shaft seal at cruise: gas flow across a sealing dam.

**Source** Zuk, J., "Analysis of face deformation effects on gas film seal performance", NASA TM X-68022 (1972).
"""

from typing import NamedTuple


class Cruise(NamedTuple):
    """The seal of the tables: air, high pressure at the inner radius.  SI units."""

    inner_radius: float = 3.265 * 0.0254
    outer_radius: float = 3.315 * 0.0254
    high_pressure: float = 215 * 6894.757
    low_pressure: float = 15 * 6894.757
    temperature: float = (800 + 459.67) / 1.8
    gas_constant: float = 287.04
    heat_ratio: float = 1.4
    # Sutherland's factor (kg/(m s K^0.5)) and temperature (K).
    sutherland: tuple[float, float] = (1.458e-6, 110.4)


class Published(NamedTuple):
    """One row: tilt (rad, positive: the film grows outwards), mean film (m), printed leakage (kg/s), force (N) and its
    centre (share of the dam's width from the high pressure); force and centre without the error of the tilted rows,
    and exit Mach number, computed: laminar, no entrance loss, width constant (no tilt) or radial, the friction factor
    of the mean radius; the printed exit Mach number.  None of what is not printed, or not held from the print."""

    tilt: float
    mean_film: float
    leakage: float | None
    force: float | None
    centre: float | None
    corrected_force: float
    corrected_centre: float
    exit_mach: float
    printed_exit_mach: float | None


CRUISE = Cruise()
MIL, POUND, POUND_FORCE = 25.4e-6, 0.45359237, 4.4482216152605


def _row(tilt, mils, pounds_per_minute, pounds, centre, corrected_pounds, corrected_centre, exit_mach, printed=None):
    return Published(
        tilt,
        mils * MIL,
        None if pounds_per_minute is None else pounds_per_minute * POUND / 60,
        None if pounds is None else pounds * POUND_FORCE,
        None if centre is None else centre / 100,
        corrected_pounds * POUND_FORCE,
        corrected_centre / 100,
        exit_mach,
        printed,
    )


# The printed forces and centres of the tilted rows are wrong: 220 lb are more than full pressure on the whole dam.
ZUK_1972 = (
    _row(0.0, 0.1, 0.0122, 133, 39.1, 133.4, 39.07, 0.251),
    _row(0.0, 0.2, 0.0939, 135, 39.7, 134.8, 39.51, 0.907),
    _row(0.0, 0.3, 0.2890, 138, 40.5, 137.8, 40.55, 1.0),
    _row(0.002, 0.1, 0.0068, 58, 26.0, 82.4, 31.57, 0.093, 0.09),
    _row(0.002, 0.2, 0.0837, 91, 33.0, 110.3, 36.12, 0.661, 0.66),
    _row(-0.002, 0.2, 0.0827, 220, 49.8, 155.3, 42.16, 1.0),
)
# Rows of which one printed number is held, or none.
ZUK_1972_IN_PART = (
    _row(0.0, 0.5, None, None, 41.7, 141.4, 42.65, 1.0),
    _row(0.002, 0.3, None, None, None, 121.0, 38.44, 1.0, 1.0),
    _row(0.002, 0.5, None, None, None, 130.1, 41.65, 1.0, 1.0),
    _row(-0.002, 0.3, None, None, None, 151.8, 42.19, 1.0),
    _row(-0.002, 0.5, None, None, None, 150.5, 43.41, 1.0),
)
