"""Unit names: "mPa*s" becomes a dimension and an exact factor to SI.

Angles are counted as a dimension (where a radian is a pure number, 2 pi is lost between Hz and rad/s).
The definitions are written as pint reads them, and read as pint does (tests/unit/test_units.py holds both against each
other) without its third of a second at every start.
"""

import difflib
import re
from collections import Counter
from decimal import Decimal
from functools import cache, lru_cache

# Exact decimals, so that "10 um" is the float 1e-5 and not its neighbour.
PREFIXES = """
giga- = 1e9 = G-
mega- = 1e6 = M-
kilo- = 1e3 = k-
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
radian = [angle] = rad
gram = 1e-3 kilogram = g
minute = 60 second = min
hour = 3600 second = h = hr
micron = 1e-6 meter = microns
inch = 0.0254 meter = in
mil = 1e-3 inch = thou
foot = 12 inch = ft
pound = 0.45359237 kilogram = lb = lbm
liter = 1e-3 meter**3 = L = l = litre
cc = 1e-6 meter**3
revolution = 6.28318530717958647692528676655900577 radian = rev = turn
degree = 1 / 360 revolution = deg
arcminute = 1 / 60 degree = arcmin
arcsecond = 1 / 60 arcminute = arcsec
hertz = revolution / second = Hz
rpm = revolution / minute
newton = kilogram * meter / second**2 = N
standard_gravity = 9.80665 meter / second**2
pound_force = pound * standard_gravity = lbf
newton_meter = newton * meter = Nm
newton_second = newton * second = Ns
newton_meter_second = newton * meter * second = Nms
pascal = newton / meter**2 = Pa
pascal_second = pascal * second = Pas
bar = 1e5 pascal = bara
atmosphere = 101325 pascal = atm
psi = pound_force / inch**2 = psia
poise = 0.1 pascal * second = P
stokes = 1e-4 meter**2 / second = St
joule = newton * meter = J
watt = joule / second = W
calorie = 4.184 joule = cal
"""
# A unit is names, one-digit powers, * / ( ) and blanks: nothing that could be made to compute for long.
UNIT = re.compile(r"(?:[a-zA-Z_]++(?:(?:\^|\*\*) ?[+-]?\d(?!\d))?|1(?= */)|[*/() ])+")
# Spelled out, and what it stands for.
SPELLED = (
    (re.compile(r" per "), "/"),
    (re.compile(r"\b(?:square|sq) (\w+)"), r"\1**2"),
    (re.compile(r"\bcubic (\w+)"), r"\1**3"),
    (re.compile(r"(\w+) squared\b"), r"\1**2"),
    (re.compile(r"(\w+) cubed\b"), r"\1**3"),
)
TOKEN = re.compile(r" *([a-zA-Z_]\w*|\d+(?:\.\d*)?(?:e-?\d+)?|(?:\^|\*\*) ?[+-]?\d|[*/()])")


@lru_cache(maxsize=1024)
def dimension_and_factor(text: str) -> tuple[frozenset, Decimal]:
    """Dimension (with angle counted) and exact factor to SI of a unit such as "mPa*s"; ValueError when it is none."""
    if len(text) > 60 or not UNIT.fullmatch(text):
        raise ValueError(text)
    return _evaluated(text)


def _evaluated(text: str) -> tuple[frozenset, Decimal]:
    """As `dimension_and_factor`, of any expression: products and quotients from left to right."""
    for spelled, meant in SPELLED:
        text = spelled.sub(meant, text)
    tokens, at = [], 0
    while rest := text[at:].strip():
        found = TOKEN.match(text, at)
        if not found:
            raise ValueError(rest)
        tokens.append(found[1])
        at = found.end()
    powers, factor = _product(tokens)
    if tokens:
        raise ValueError(text)
    return frozenset((name, power) for name, power in powers.items() if power), factor


def _product(tokens: list[str]) -> tuple[Counter, Decimal]:
    """Powers of the dimensions, and factor, of a product, taken off the front of the tokens."""
    powers, factor, sign = Counter(), Decimal(1), 1
    while True:
        if not tokens:
            raise ValueError("nothing to multiply")
        more, size = _atom(tokens)
        if tokens and tokens[0][0] in "*^" and tokens[0] != "*":
            power = int(tokens.pop(0).lstrip("*^ "))
            more, size = {name: power * n for name, n in more.items()}, size**power
        for name, n in more.items():
            powers[name] += sign * n
        factor = factor * size if sign > 0 else factor / size
        if not tokens or tokens[0] == ")":
            return powers, factor
        # Blanks multiply.
        sign = -1 if tokens[0] == "/" else 1
        if tokens[0] in "*/":
            tokens.pop(0)


def _atom(tokens: list[str]) -> tuple[dict, Decimal]:
    """The same of a number, a name or a bracket."""
    token = tokens.pop(0)
    if token == "(":
        found = _product(tokens)
        if not tokens or tokens.pop(0) != ")":
            raise ValueError("a bracket that is not closed")
        return found
    return ({}, Decimal(token)) if token[0].isdigit() else _named(token)


@cache
def _named(word: str) -> tuple[dict, Decimal]:
    """The same of a unit's name: as it stands, else with a prefix, else either in the plural."""
    prefixes, units = _definitions()
    for plural in ("", "s"):
        for prefix, scale in {"": Decimal(1), **prefixes}.items():
            name = word.removeprefix(prefix).removesuffix(plural)
            if prefix + name + plural != word or name not in units or (plural and len(name) == 1):
                continue
            if units[name].startswith("["):
                return {units[name]: 1}, scale
            powers, factor = _evaluated(units[name])
            return dict(powers), scale * factor
    raise ValueError(word)


@cache
def _definitions() -> tuple[dict[str, Decimal], dict[str, str]]:
    """Scale of every prefix, and definition of every name of a unit."""
    prefixes, units = {}, {}
    for line in filter(None, (PREFIXES + DEFINITIONS).split("\n")):
        name, definition, *others = line.split(" = ")
        for word in (name, *others):
            if word.endswith("-"):
                prefixes[word[:-1]] = Decimal(definition)
            else:
                units[word] = definition
    return prefixes, units


def unknown_unit(text: str) -> str:
    """Which word of `text` is no unit, with the nearest that is."""
    for word in re.findall(r"[^\W\d]+", text):
        if not _is_unit(word):
            same = [name for name in _names() if name.lower() == word.lower()]
            near = same or difflib.get_close_matches(word, _names(), 1, 0.5)
            return f"unknown unit '{word}'" + (f", nearest '{near[0]}'" if near else "")
    return f"'{text}' is no unit"


def _is_unit(word: str) -> bool:
    try:
        dimension_and_factor(word)
    except ValueError:
        return False
    return True


@cache
def _names() -> list[str]:
    plain = [name for line in DEFINITIONS.split("\n") for name in re.findall(r"\b[a-zA-Z_]{1,12}\b", line)]
    symbols = re.findall(r"(\w)-$", PREFIXES, re.MULTILINE)
    return plain + [p + n for n in ("m", "Pa", "N", "s", "rad", "g", "Hz", "P", "J") for p in symbols]
