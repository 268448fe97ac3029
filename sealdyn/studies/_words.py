"""Numbers as an engineer reads them, for sentences and tables; the data of an answer stay SI."""

import math

RPM, HERTZ = 30 / math.pi, 0.5 / math.pi
# What a SI unit is shown in: units and factors from the size (SI) on at which they begin, the smallest first.
SHOWN = {
    "m": ((0.0, "um", 1e6), (1e-3, "mm", 1e3)),
    "rad": ((0.0, "urad", 1e6), (1e-3, "mrad", 1e3)),
    "rad/s": ((0.0, "rpm", RPM),),
    "Pa": ((0.0, "Pa", 1.0), (1e3, "bar", 1e-5)),
    "m^3/s": ((0.0, "ml/h", 3.6e9), (1e-5, "l/min", 6e4)),
    "kg/s": ((0.0, "kg/h", 3600.0),),
}


def shown_in(unit: str, values) -> tuple[str, float]:
    """The unit in which `values` (in a SI `unit`) are shown, by the largest of them, and its factor; the same unit for
    one that has no other."""
    size = max((abs(v) for v in values if isinstance(v, int | float) and math.isfinite(v)), default=0.0)
    return next(((name, factor) for begin, name, factor in reversed(SHOWN.get(unit, ())) if size >= begin), (unit, 1.0))


def quantity(value: float, unit: str, digits: int = 5) -> str:
    """A value (SI) in words: "4.8979 mrad", "9549.3 rpm (1000 rad/s)"."""
    if unit == "rad/s":
        return speed(value, digits)
    name, factor = shown_in(unit, [value])
    return f"{value * factor:.{digits}g}{f' {name}' if name not in ('', '1') else ''}"


def plain(value: float, digits: int = 5) -> str:
    """A number of so many digits, without a power of ten below ten millions."""
    return f"{float(f'{value:.{digits}g}'):.{max(digits, 7)}g}"


def speed(w: float, digits: int = 5) -> str:
    """A shaft speed (rad/s) in words."""
    return f"{plain(w, digits)} rad/s ({plain(w * RPM, digits)} rpm)"


def no_film_beyond(held) -> str:
    """Up to which speed a film holds the closing force, of `speeds_held` (rad/s), None where that is every speed."""
    return f" up to {speed(held[1])}, beyond which no film holds the closing force" if held else ""


def frequencies(low: float, high: float, digits: int = 5) -> str:
    """A range of frequencies of vibration (rad/s) in words, one where both ends read alike."""
    ends = [f"{w:.{digits}g}" for w in (low, high)]
    hertz = [f"{w * HERTZ:.{digits}g}" for w in (low, high)]
    one = ends[0] == ends[1]
    return f"{ends[0] if one else ' to '.join(ends)} rad/s ({hertz[0] if one else ' to '.join(hertz)} Hz)"
