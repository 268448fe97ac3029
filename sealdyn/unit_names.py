"""Unit names: "mPa*s" becomes a dimension and an exact factor to SI.

Angles are counted as a dimension (pint's own definitions call a radian a pure number, and lose 2 pi between
Hz and rad/s), so the definitions are our own few.
"""

import difflib
import re
from collections.abc import Iterable
from decimal import Decimal
from functools import cache, lru_cache
from typing import Any

# Exact decimals, so that "10 um" is the float 1e-5 and not its neighbour.
PREFIXES = """
giga- = 1e9 = G-
mega- = 1e6 = M-
kilo- = 1e3 = k-
hecto- = 1e2 = h-
deca- = 1e1 = da-
deci- = 1e-1 = d-
centi- = 1e-2 = c-
milli- = 1e-3 = m-
micro- = 1e-6 = u-
nano- = 1e-9 = n-
"""
DEFINITIONS = """
meter = [length] = m = metre
kilogram = [mass] = kg
second = [time] = s = sec
kelvin = [temperature] = K = degC
rankine = 5 / 9 kelvin = degR = degF
radian = [angle] = rad
gram = 1e-3 kilogram = g
minute = 60 second = min
hour = 3600 second = h = hr
micron = 1e-6 meter = microns
inch = 0.0254 meter = in = inches
mil = 1e-3 inch = thou
foot = 12 inch = ft = feet
pound = 0.45359237 kilogram = lb = lbm
ounce = 1 / 16 pound = oz
tonne = 1e3 kilogram
liter = 1e-3 meter**3 = L = l = litre
cc = 1e-6 meter**3
revolution = 6.28318530717958647692528676655900577 radian = rev = turn = r
degree = 1 / 360 revolution = deg
arcminute = 1 / 60 degree = arcmin
arcsecond = 1 / 60 arcminute = arcsec
hertz = revolution / second = Hz
rpm = revolution / minute = RPM = Rpm
rps = revolution / second
newton = kilogram * meter / second**2 = N
standard_gravity = 9.80665 meter / second**2
dyne = 1e-5 newton = dyn
kilogram_force = kilogram * standard_gravity = kgf = kp
pound_force = pound * standard_gravity = lbf
ounce_force = ounce * standard_gravity = ozf
slug = pound_force * second**2 / foot
newton_meter = newton * meter = Nm
newton_second = newton * second = Ns
kilogram_kelvin = kilogram * kelvin = kgK
newton_meter_second = newton * meter * second = Nms
pascal = newton / meter**2 = Pa
pascal_second = pascal * second = Pas
bar = 1e5 pascal = bara
atmosphere = 101325 pascal = atm
torr = 101325 / 760 pascal = Torr
mmHg = 133.322387415 pascal
inHg = 25.4 mmHg
meter_of_water = 9806.65 pascal = mHtwoO
inch_of_water = 0.0254 meter_of_water = inHtwoO
psi = pound_force / inch**2 = psia
ksi = 1e3 psi
poise = 0.1 pascal * second = P
reyn = psi * second
stokes = 1e-4 meter**2 / second = St
joule = newton * meter = J
watt = joule / second = W
calorie = 4.184 joule = cal
british_thermal_unit = 1055.05585262 joule = BTU = Btu
"""
# What most scenarios are written in, as pint reads it: exponents of the dimensions, then units and factors.  To load
# pint takes as long as all else that reads a scenario.
DIMENSIONS = ("[length]", "[mass]", "[time]", "[angle]")
COMMON = {
    (0, 0, 0, 0): {"m/m": "1"},
    (1, 0, 0, 0): {"m": "1", "mm": "1e-3", "um": "1e-6"},
    (0, 1, 0, 0): {"kg": "1", "g": "1e-3"},
    (0, 0, 1, 0): {"s": "1", "ms": "1e-3"},
    (0, 0, 0, 1): {"rad": "1", "mrad": "1e-3", "urad": "1e-6", "deg": "0.01745329251994329576923690769"},
    (0, 0, -1, 1): {"rad/s": "1", "rpm": "0.1047197551196597746154214461", "Hz": "6.283185307179586476925286767"},
    (1, 0, -1, 0): {"m/s": "1"},
    (1, 1, -2, 0): {"N": "1"},
    (-1, 1, -2, 0): {"Pa": "1", "bar": "1e5", "MPa": "1e6", "GPa": "1e9"},
    (-1, 1, -1, 0): {"Pa*s": "1", "mPa*s": "1e-3"},
    (2, 1, 0, 0): {"kg*m^2": "1"},
    (0, 1, -2, 0): {"N/m": "1", "N/mm": "1e3"},
    (0, 1, -1, 0): {"N*s/m": "1"},
    (2, 1, -2, -1): {"N*m/rad": "1"},
    (2, 1, -1, -1): {"N*m*s/rad": "1"},
    (2, 1, -2, 0): {"N*m": "1"},
    (2, 1, -1, 0): {"N*m*s": "1"},
    (1, -1, 2, 0): {"1/Pa": "1"},
}
# A unit is names, one-digit powers, squares of brackets, * / ( ) and blanks: nothing that could be made to compute for
# long.
UNIT = re.compile(r"(?:[a-zA-Z_]++(?:(?:\^|\*\*) ?[+-]?\d(?!\d))?|1(?= */)|\)(?:\^|\*\*) ?2(?!\d)|[*/() ])+")
# As engineers also write them: "mPa.s" and "lbf-in" for products, "kg/m3" for powers, "/Pa".
PRODUCT = re.compile(r"(?<=[a-zA-Z\d)]) ?[.-] ?(?=[a-zA-Z(])")
POWER = re.compile(r"(?<=[a-zA-Z])([2-9])(?!\d)")
# Either of J/(kg*K) and J/kg*K.
UNCLEAR = re.compile(r"/ *[^()*/ ]+ *[. -] *[a-zA-Z]")


@cache
def _registry():
    import pint

    registry = pint.UnitRegistry(None, non_int_type=Decimal, cache_folder=None)
    for line in (PREFIXES + DEFINITIONS).split("\n"):
        if line:
            registry.define(line)
    return registry


@cache
def _common() -> dict[str, tuple[frozenset, Decimal]]:
    """Dimension and factor of the common units."""
    found = {}
    for exponents, units in COMMON.items():
        dimension = frozenset((name, n) for name, n in zip(DIMENSIONS, exponents, strict=True) if n)
        found |= {unit: (dimension, Decimal(factor)) for unit, factor in units.items()}
    return found


@lru_cache(maxsize=1024)
def dimension_and_factor(text: str) -> tuple[frozenset, Decimal]:
    """Dimension (with angle counted) and exact factor to SI of a unit such as "mPa*s"; ValueError when it is none."""
    return _common().get(text) or _by_pint(text)


def _by_pint(text: str) -> tuple[frozenset, Decimal]:
    if len(text) > 60 or UNCLEAR.search(text):
        raise ValueError(text)
    text = POWER.sub(r"^\1", PRODUCT.sub("*", text.replace("H2O", "HtwoO")))
    text = f"1{text}" if text.startswith("/") else text
    if not UNIT.fullmatch(text):
        raise ValueError(text)
    registry = _registry()
    try:
        root = registry.Quantity(Decimal(1), registry.parse_units(text)).to_root_units()
    except Exception as error:  # the expression parser underneath raises whatever it likes
        raise ValueError(text) from error
    return frozenset(root.dimensionality.items()), Decimal(root.magnitude)


def spelled_like(word: Any, known: Iterable[str], most: int = 1, cutoff: float = 0.6) -> list[str]:
    """At most so many `known` words that are spelled like anything a user wrote, nearest first; none for what is no
    word, or longer than words are."""
    return difflib.get_close_matches(word, known, most, cutoff) if isinstance(word, str) and len(word) < 100 else []


def unknown_unit(text: str) -> str:
    """Which word of `text` is no unit, with the nearest that is."""
    if UNCLEAR.search(text):
        return f"'{text}' is unclear: which part divides, brackets say, as in J/(kg*K)"
    for word in re.findall(r"[^\W\d]+", text):
        if not is_unit(word):
            same = [name for name in _names() if name.lower() == word.lower()]
            near = same or spelled_like(word, _names(), 1, 0.5)
            return f"unknown unit '{word}'" + (f", nearest '{near[0]}'" if near else "")
    return f"'{text}' is no unit"


def is_unit(text: str) -> bool:
    """Whether a text is a unit."""
    try:
        dimension_and_factor(text)
    except ValueError:
        return False
    return True


@cache
def _names() -> list[str]:
    plain = [name for line in DEFINITIONS.split("\n") for name in re.findall(r"\b[a-zA-Z_]{1,12}\b", line)]
    symbols = re.findall(r"(\w)-$", PREFIXES, re.MULTILINE)
    return plain + [p + n for n in ("m", "Pa", "N", "s", "rad", "g", "Hz", "P", "J") for p in symbols]
