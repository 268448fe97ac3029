"""Quantities with units, against values worked out by hand."""

import functools
import math
import subprocess
import sys
from decimal import Decimal

import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sealdyn import unit_names, units
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.units import QuantityError


def read(kind, value):
    return kind.__metadata__[0].read(value)


@pytest.mark.parametrize(
    "kind, text, si",
    [
        ("Length", "10 um", 1e-5), ("Length", "10um", 1e-5), ("Length", "10 µm", 1e-5), ("Length", "1 in", 0.0254),
        ("Speed", "9550 rpm", 9550 * 2 * math.pi / 60), ("Speed", "150 Hz", 150 * 2 * math.pi),
        ("Speed", "1000 rad/s", 1000.0), ("Speed", "1 deg/s", math.pi / 180), ("Frequency", "50 Hz", 50.0),
        ("Frequency", "5.4 kHz", 5400.0), ("Frequency", "3000 rpm", 50.0),
        ("Frequency", "100 rad/s", 100 / (2 * math.pi)), ("Acceleration", "45 g", 45 * 9.80665),
        ("Acceleration", "20 m/s^2", 20.0), ("AngularAcceleration", "30 rad/s^2", 30.0),
        ("AngularAcceleration", "1 rev/s^2", 2 * math.pi), ("Mass", "800 g", 0.8), ("Angle", "25 urad", 25e-6),
        ("Angle", "0.5 mrad", 5e-4), ("Angle", "1 deg", math.pi / 180), ("Angle", "3 um/mm", 3e-3),
        ("Pressure", "5 bar", 5e5), ("Pressure", "1 psi", 6894.757293168362), ("Viscosity", "0.5 mPa*s", 5e-4),
        ("Viscosity", "0.5 mPa s", 5e-4), ("Viscosity", "0.5 cP", 5e-4), ("Inertia", "8e-4 kg*m^2", 8e-4),
        ("Inertia", "8 kg·cm²", 8e-4), ("Damping", "300 N*s/m", 300.0), ("TiltStiffness", "400 N*m", 400.0),
        ("TiltStiffness", "400 N*m/rad", 400.0), ("TiltStiffness", "1 N*m/deg", 180 / math.pi),
        ("TiltDamping", "0.24 N m s/rad", 0.24), ("Density", "1 g/cm^3", 1000.0),
        ("SpecificHeat", "4.18 kJ/(kg*K)", 4180.0), ("Time", "2 min", 120.0), ("Viscosity", "0.5 mPa.s", 5e-4),
        ("Viscosity", "8e-7 reyn", 8e-7 * 4.4482216152605 / 0.0254**2), ("Inertia", "8e-4 kg.m2", 8e-4),
        ("Inertia", "1 lb-in^2", 0.45359237 * 0.0254**2), ("Inertia", "1 lbf*s^2*in", 4.4482216152605 * 0.0254),
        ("TiltStiffness", "1 in-lbf/rad", 4.4482216152605 * 0.0254), ("Force", "1 kgf", 9.80665),
        ("Force", "8 ozf", 8 / 16 * 4.4482216152605), ("Pressure", "1 kgf/cm2", 98066.5),
        ("Stress", "1 ksi", 6894757.293168361), ("Stress", "5 daN/mm2", 5e7), ("Pressure", "760 torr", 101325.0),
        ("Pressure", "5 barg", 601325.0), ("Pressure", "5 bar gauge", 601325.0),
        ("Pressure", "5 bar (gage)", 601325.0), ("Pressure", "5 bar(g)", 601325.0),
        ("Pressure", "0.5 MPag", 601325.0), ("Pressure", "500 kPa g", 601325.0),
        ("Pressure", "1 kgf/cm2(g)", 98066.5 + 101325), ("Pressure", "-0.5 barg", 51325.0),
        ("Pressure", "0 psig", 101325.0), ("Pressure", "70 psig", 70 * 6894.757293168362 + 101325),
        ("SpecificHeat", "1 BTU/(lb*degF)", 4186.8), ("SpecificHeat", "4.18 kJ/(kg.K)", 4180.0),
        ("Density", "62.4 lb/ft3", 62.4 * 0.45359237 / 0.3048**3), ("Temperature", "491.67 degR", 273.15),
        ("Temperature", "32 degF", 273.15), ("Temperature", "40 C", 313.15), ("Temperature", "40 ° C", 313.15),
        ("Temperature", "32F", 273.15), ("SpecificHeat", "2 kJ/kgK", 2000.0),
        ("ConingPerKelvin", "1 urad/degF", 1.8e-6), ("Speed", "50 rps", 100 * math.pi),
        ("WearCoefficient", "1e-16 /Pa", 1e-16), ("WearCoefficient", "1e-7 mm3/(N m)", 1e-16),
        ("Speed", "10 rev / min", math.pi / 3), ("Speed", "10 r/min", math.pi / 3), ("Speed", "10 RPM", math.pi / 3),
        ("Pressure", "0.5 MPaG", 601325.0), ("Pressure", "2 inHg", 50.8 * 133.322387415),
        ("Pressure", "2 mH2O", 19613.3), ("Pressure", "50 mmH2O", 490.3325), ("Pressure", "1 inH2O", 249.08891),
        ("Tilt", "\N{MINUS SIGN}10 urad", -1e-5), ("Viscosity", "1e\N{MINUS SIGN}3 N·s·m⁻²", 1e-3),
        ("Speed", "5 rad s⁻¹", 5.0), ("Inertia", "8 kg·cm²", 8e-4),
    ],
)  # fmt: skip
def test_strings_with_units(kind, text, si):
    assert read(getattr(units, kind), text) == pytest.approx(si, rel=1e-15)


def test_a_gauge_pressure_is_known_as_such_however_its_minus_is_typeset():
    """Of what is read as one: archives keep which values were."""
    for text in ("-0.5 barg", "\N{MINUS SIGN}0.5 barg", "0.5 MPaG"):
        assert units.is_gauge(text) and units.is_gauge({"time": [0.0], "value": [text]})
    assert not units.is_gauge("\N{MINUS SIGN}0.5 bar") and not units.is_gauge(3.0)


def test_decimal_text_gives_the_nearest_float():
    # 10 * 1e-6 in floats is 9.999999999999999e-06
    assert read(units.Length, "10 um") == 1e-5
    assert read(units.Inertia, "16e-4 kg*m^2") == 16e-4


def test_bare_numbers_are_si():
    assert read(units.Speed, 1000) == 1000.0
    assert isinstance(read(units.Speed, 1000), float)
    assert read(units.Frequency, 50) == 50.0


@pytest.mark.parametrize(
    "kind, value, says",
    [
        ("Speed", "10 um", "a unit of length"), ("Speed", "1000 1/s", "neither radians nor revolutions"),
        ("Speed", "10", "no unit"), ("Length", "10 rpm", "speed"), ("Length", "10 micrometre s", "expected a length"),
        ("Pressure", "5 Bar", "nearest 'bar'"), ("SpecificHeat", "4.18 kJ/kg.K", "J/(kg*K)"),
        ("WearCoefficient", "1e-7 mm^3/N m", "unclear: which part divides, brackets say"),
        ("WearCoefficient", "1e-16 //Pa", "is no unit"), ("Temperature", "20 (degC)", "another zero"),
        ("Temperature", "20 kdegC", "another zero"), ("Pressure", "-2 barg", ">= 0"),
        ("Pressure", "5 Bar(g)", "nearest 'bar'"), ("Pressure", "5 m(g)", "a unit of length"),
        ("Pressure", "5 (g)", "expected"), ("Stress", "5 barg", "nearest 'bar'"), ("Pressure", -1.0, ">= 0"),
        ("Viscosity", 0, "> 0"), ("Mass", "-1 kg", ">= 0"), ("Inertia", "-1 kg*m^2", ">= 0"),
        ("Stiffness", "-1 N/m", ">= 0"), ("Damping", -3, ">= 0"), ("Frequency", "0 Hz", "> 0"),
        ("Angle", "20 um TIR", "rotor.runout"), ("Acceleration", "45 kg", "a unit of mass"),
        ("Mass", True, "found true"), ("Mass", math.nan, "finite"), ("Mass", math.inf, "finite"),
        ("Mass", "nan kg", "expected a mass"), ("Mass", "1e400 kg", "finite"), ("Mass", 10**400, "beyond"),
        ("Mass", None, "expected a mass"), ("Mass", [1], "a list"), ("Mass", {"a": 1}, "a table"),
        ("Mass", "", "expected a mass"), ("Length", "9**9**9**9 m", "expected a length"),
        ("Length", "1 m**9**9**9", "expected a length"), ("Length", "1 " + "m" * 58 + "$", "expected a length"),
        ("Length", "1 ((((", "expected a length"), ("Length", "1" * 100000, "expected a length"),
    ],
)  # fmt: skip
def test_refused_with_what_was_found_and_expected(kind, value, says):
    with pytest.raises(QuantityError, match=r".*") as refusal:
        read(getattr(units, kind), value)
    assert says in str(refusal.value)
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 300


def test_an_integer_that_python_does_not_print():
    with pytest.raises(QuantityError):
        read(units.Mass, 10**5000)
    assert units.quoted(10**5000) == "a number of thousands of digits"


def test_signed_kinds_take_negative_values():
    assert read(units.SignedTiltStiffness, "-400 N*m/rad") == -400.0
    assert read(units.Length, "-1 um") == -1e-6


def varying(value, kind=units.Speed):
    return units.Varying[kind].__metadata__[0].read(value)


def test_table_with_units_entry_by_entry():
    table = varying({"time": ["0 s", "500 ms", 2], "value": ["60 rpm", 10, "1 Hz"]})
    assert table == PiecewiseLinear((0.0, 0.5, 2.0), (pytest.approx(2 * math.pi), 10.0, pytest.approx(2 * math.pi)))
    assert varying("1 Hz") == pytest.approx(2 * math.pi)


@pytest.mark.core
def test_table_is_linear_between_and_held_outside():
    table = PiecewiseLinear((1.0, 2.0, 2.0, 4.0), (10.0, 20.0, 50.0, 30.0))
    assert [table.at(t) for t in (-1, 1, 1.5, 2, 3, 4, 9)] == [10, 10, 15, 50, 40, 30, 30]
    assert table.at(2 - 1e-12) == pytest.approx(20.0)
    assert table.breaks() == (1.0, 2.0, 4.0)


@pytest.mark.parametrize(
    "table, says",
    [
        ({"time": [0, 1], "value": [1]}, "as many times as values"), ({"time": [0], "value": [1]}, "at least 2"),
        ({"time": [0, 2, 1], "value": [1, 2, 3]}, "do not decrease"),
        ({"time": [0, 0, 0], "value": [1, 2, 3]}, "at most twice"),
        ({"time": [0, 1], "values": [1, 2]}, "nearest key 'value'"), ({"time": [0, 1]}, "value = nothing"),
        ({"time": 0, "value": [1, 2]}, "time = 0"), ({"time": [0, 1], "value": [1, "2 um"]}, "value[1]"),
        ({"time": [0, "1 m"], "value": [1, 2]}, "time[1]"), ({"time": [0, 1], "value": [1, math.nan]}, "value[1]"),
        ([1, 2], "a table { time"),
    ],
)  # fmt: skip
def test_bad_tables(table, says):
    with pytest.raises(QuantityError) as refusal:
        varying(table)
    assert says in str(refusal.value)


@pytest.mark.parametrize("value, loaded", [(1.0, False), ("1 um", False), ("1 mil", True)])
def test_pint_is_loaded_only_for_a_unit_that_is_not_common(value, loaded):
    code = f"import sys, sealdyn.units as u; u.Length.__metadata__[0].read({value!r}); sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == loaded


def test_common_units_are_as_pint_reads_them():
    """To the last of 28 digits, which pint rounds to or not by what it has been asked before."""
    common = unit_names._common()
    assert {"um", "rpm", "bar", "N*m*s/rad"} <= set(common)
    for unit, (dimension, factor) in common.items():
        expected, exact = unit_names._by_pint(unit)
        assert dimension == expected and abs(factor - exact) <= exact * Decimal("1e-27"), unit
        assert float(factor) == float(exact)


# Spellings of scenario files, and those of pint's own registry for the same.
WORDS = {"kgf": "kgf", "ksi": "ksi", "psi": "psi", "BTU": "Btu_it", "lbf": "lbf", "in": "in", "mil": "thou", "cP": "cP"}
WORDS |= {"mPa": "mPa", "N": "N", "um": "um", "daN": "daN", "hPa": "hPa", "mbar": "mbar", "ft": "ft", "lb": "lb"}
WORDS |= {"oz": "oz", "ozf": "ozf", "slug": "slug", "tonne": "tonne", "dyn": "dyn", "torr": "torr", "mmHg": "mmHg"}
WORDS |= {"cSt": "cSt", "atm": "atm", "kW": "kW", "cal": "cal", "ml": "ml", "thou": "thou", "degF": "degR", "kp": "kgf"}
WORDS |= {"reyn": "psi*s", "bara": "bar", "min": "min", "K": "K"}
SYMBOLS = functools.cache(pint.UnitRegistry)


@settings(deadline=None)
@given(st.lists(st.tuples(st.sampled_from(sorted(WORDS)), st.integers(1, 3)), min_size=1, max_size=4), st.data())
def test_every_spelling_is_what_pint_reads(parts, data):
    """Products, powers and a divisor, in each way of writing them."""
    words = ""
    for n, (word, power) in enumerate(parts):
        sign = data.draw(st.sampled_from("*.- ")) if n else ""
        words += sign + word + (data.draw(st.sampled_from(["^", "**", ""])) + str(power) if power > 1 else "")
    below = data.draw(st.sampled_from(["", *sorted(WORDS)]))
    same = SYMBOLS().Quantity(1.0, "*".join(f"({WORDS[word]})**{power}" for word, power in parts))
    same = same / SYMBOLS().Quantity(1.0, WORDS[below]) if below else same
    _, factor = unit_names.dimension_and_factor(f"{words}/{below}" if below else words)
    assert float(factor) == pytest.approx(same.to_base_units().magnitude, rel=1e-9)
