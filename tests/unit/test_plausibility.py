"""Cautions of runs that leave what their film is valid for, beside runs that do not, and the numbers in them."""

import re

import numpy as np
import pytest
from command import SCENARIOS

from sealdyn.dynamics.run_state import Concern
from sealdyn.scenario.reader import read_scenario, with_values
from sealdyn.simulation import plausibility, simulate

SEAL = SCENARIOS / "fms_reference.toml"
# So slow and thin a fluid that nothing is left to say of the reference seal.
TAME = ["shaft.speed=100 rad/s", "film.viscosity=5 mPa*s", "run.turns=1", "run.accuracy=1e-3"]
OWN = "{ tilt_stiffness = 5790, tilt_damping = 4.08, axial_stiffness = 6.1e6, axial_damping = 5200 }"


def cautions(*overrides, path=SEAL, change=None):
    """{concern: sentences} of a short run, whose `warnings` hold the same."""
    scenario = read_scenario(path, [*TAME, *overrides])
    scenario = with_values(scenario, change) if change else scenario
    found, kept = {}, plausibility.cautions

    def listening(*anything):
        told = kept(*anything)
        for caution in told:
            found.setdefault(caution.concern, []).append(caution.sentence)
        return told

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sealdyn.simulation.summary.cautions", listening)
        summary = simulate.simulate_in_memory(scenario)
    assert all(sentence in summary["warnings"] for told in found.values() for sentence in told)
    return found


def numbers(sentence):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?", sentence)]


def test_a_tame_seal_has_none():
    assert cautions() == {}


@pytest.mark.core
def test_reynolds_numbers_and_inertia_of_the_reference_seal():
    """rho W r h / mu: 640 where h = C = 10 um, 2800 at the outer one; 3/20 rho w^2 (r_o^2 - r_i^2) = 0.86 bar, 17 %."""
    found = cautions("shaft.speed=1000 rad/s", "film.viscosity=0.5 mPa*s")
    assert set(found) == {Concern.TURBULENCE, Concern.INERTIA}
    assert numbers(found[Concern.TURBULENCE][0])[:4] == [640, 32, 2800, 40]
    assert numbers(found[Concern.INERTIA][0])[:2] == [0.864, 17.3]
    counted = cautions("shaft.speed=1000 rad/s", "film.viscosity=0.5 mPa*s", "film.inertia=true")
    assert set(counted) == {Concern.TURBULENCE}
    own = cautions("shaft.speed=1000 rad/s", 'film.model="linear"', f"film.coefficients={OWN}")
    assert not {Concern.TURBULENCE, Concern.INERTIA} & set(own)


def test_poiseuille_reynolds_number_of_the_leakage():
    """Q / (2 pi r nu) of the aligned narrow film, pressed through 30 um of water."""
    found = cautions("film.clearance=30 um", "film.viscosity=0.5 mPa*s", "film.coning=0", "film.outer_pressure=30 bar",
                     "stator.misalignment=0", "rotor.runout=0")  # fmt: skip
    flow = (30e-6) ** 3 * 3e6 / (12 * 0.5e-3 * 0.032 * np.log(40 / 32)) / 5e-7
    (sentence,) = found[Concern.TURBULENCE]
    assert numbers(sentence)[0] == pytest.approx(flow, rel=0.01)


def test_friction_that_heats_the_leakage():
    thin = ["film.clearance=1 um", "film.coning=0.3 mrad", "film.viscosity=0.5 mPa*s"]
    (sentence,) = cautions(*thin, "shaft.speed=80 rad/s")[Concern.HEATING]
    assert 10 < numbers(sentence)[0] < 100 and "would heat" in sentence
    # Beyond that a rise has no meaning: watts on the face have one.
    (sentence,) = cautions(*thin, "shaft.speed=250 rad/s")[Concern.HEATING]
    assert "cannot carry" in sentence and " K" not in sentence


def test_films_of_nanometres():
    """Half a nanometre short of contact counts as closed; above it stands the roughness, told or not."""
    thin = ["film.coning=0", "film.viscosity=1e-5 Pa*s", "rotor.runout=0", "stator.misalignment=0"]
    for clearance, word in (("5 nm", "continuum"), ("49 nm", "[contact]")):
        (sentence,) = cautions(*thin, f"film.clearance={clearance}")[Concern.THIN_FILM]
        assert word in sentence and numbers(sentence)[0] == float(clearance.split()[0])
    assert Concern.THIN_FILM not in cautions(*thin, "film.clearance=1 um")
    rough = [*thin, "contact.roughness=1 um", "contact.compressive_strength=300 MPa"]
    (sentence,) = cautions(*rough, "film.clearance=0.9 um")[Concern.THIN_FILM]
    assert numbers(sentence) == [0.9, 1]
    # The mean cube of heights of 0.5 um rms about 2 um is 1 + 3/16 of the cube of the mean.
    found = cautions(*thin, "contact.roughness=0.5 um", "contact.compressive_strength=300 MPa", "film.clearance=2 um")
    (sentence,) = found[Concern.ROUGH_FILM]
    assert numbers(sentence)[0] == 19 and Concern.ROUGH_FILM not in cautions(*thin, "film.clearance=2 um")


def test_the_arm_of_contact():
    rough = ["contact.roughness=0.1 um", "contact.compressive_strength=300 MPa"]
    assert Concern.CONTACT_ARM not in cautions(*rough)
    (sentence,) = cautions(*rough, 'film.tilt_radius="mean"')[Concern.CONTACT_ARM]
    assert numbers(sentence) == [pytest.approx(100 * 4 / 36, abs=0.1)]


def test_a_film_below_its_vapour_pressure():
    assert Concern.FLASHING not in cautions("film.inner_pressure=1 bar", "film.vapour_pressure=0.9 bar")
    (sentence,) = cautions("film.vapour_pressure=2.3 kPa")[Concern.FLASHING]
    assert numbers(sentence) == [0, 0.023]
    # Both edges above it, and the wedge below it.
    wedge = ["film.coning=0", "film.outer_pressure=1 bar", "film.inner_pressure=1 bar", "shaft.speed=3000 rad/s",
             "closing.balance_ratio=0.8", "film.vapour_pressure=0.9 bar"]  # fmt: skip
    assert Concern.FLASHING not in cautions(*wedge, "stator.misalignment=0", "rotor.runout=0")
    tilted = cautions(*wedge, "stator.misalignment=0.1 mrad", "stator.support.axial_stiffness=5e8 N/m")
    assert numbers(tilted[Concern.FLASHING][0])[0] < 0.9


# A fluid that fills a metre calmly.
THICK = ["film.coning=0", "film.outer_pressure=0.001 Pa", "film.viscosity=1e6 Pa*s"]


def test_numbers_without_units():
    (sentence,) = cautions("shaft.speed=100")[Concern.UNITS]
    assert numbers(sentence)[:2] == [100, pytest.approx(954.93)]
    half = sentence.replace("100 ", "50 ").replace("954.93", "477.465")
    assert cautions("shaft.speed=100", change={"shaft.speed": 50.0})[Concern.UNITS] == [half]
    # A sweep gives SI numbers: nobody wrote these.
    assert cautions(change={"shaft.speed": 50.0}) == {}
    far = cautions("film.clearance=1", *THICK)
    written = cautions("film.clearance=1000 mm", *THICK)
    # Nobody forgot a unit that was written; either is one sentence.
    told = [[(s.startswith("film.clearance"), numbers(s)[0]) for s in c[Concern.UNITS]] for c in (far, written)]
    assert told == [[(True, 1)], [(False, 1000)]]


@pytest.mark.parametrize(
    "key,slip,fine,shown",
    [
        ("film.viscosity", "0.8", '"0.8 Pa*s"', 800), ("film.viscosity", "0.8", "0.05", 800),
        ("film.inner_pressure", "1", '"1 Pa"', 1e-5), ("film.temperature", "400", '"400 K"', 126.85),
        ("film.coning", "0.05", '"0.05 rad"', 50), ("stator.mass", "120", "0.12", 120_000),
        ("film.density", "0.998", '"0.998 g/cm^3"', 0.000998),
    ],
)  # fmt: skip
def test_numbers_without_units_that_no_seal_has(key, slip, fine, shown):
    """Each is told in the unit that may have been meant; none with its unit, or of a usual size."""
    light = ["stator.misalignment=0", "rotor.runout=0", "run.start='rest'"]
    if key == "film.temperature":
        # A liquid's matters to its coning only.
        light += ["film.coning_per_kelvin=1e-9 rad/K", "film.coning_reference_temperature=400 K"]
    told = [s for s in cautions(*light, f"{key}={slip}").get(Concern.UNITS, []) if s.startswith(key)]
    assert len(told) == 1 and numbers(told[0])[0] == float(slip) and shown in numbers(told[0])
    assert Concern.UNITS not in cautions(*light, f"{key}={fine}")


def test_wear_of_millimetres_an_hour():
    """1e-6 without a unit is 1e-6 1/Pa, a thousand mm^3/(N m)."""
    rough = ["run.turns=0.5", "run.accuracy=1e-3"]
    slip = cautions(*rough, "contact.stator_wear_coefficient=1e-6", path=SCENARIOS / "run_in.toml")
    assert numbers(slip[Concern.UNITS][0])[::2] == [1e-6, 1000] and numbers(slip[Concern.WEAR][0])[0] > 1
    usual = cautions(*rough, "contact.stator_wear_coefficient=1e-15", path=SCENARIOS / "run_in.toml")
    assert not {Concern.UNITS, Concern.WEAR} & set(usual)


GAS = ["film.viscosity=2e-5 Pa*s", "film.coning=0", "stator.misalignment=0", "rotor.runout=0"]


def test_a_gas_that_leaves_fast():
    """Mach number at the low pressure of the isothermal flow between parallel faces, in words of its own."""
    path = SCENARIOS / "gas_reynolds_reference.toml"
    coarse = [*GAS, "film.gas_reynolds.cells=[24, 8]", "run.turns=0.05"]
    wide = [*coarse, "film.clearance=9 um"]
    found = cautions(*wide, path=path)
    flow = (9e-6) ** 3 * (11e5**2 - 1e5**2) / (24 * 2e-5 * 296.8 * 313.15 * 0.060 * np.log(70 / 60))
    sound = np.sqrt(1.4 * 296.8 * 313.15)
    mach = flow / (1e5 / (296.8 * 313.15) * 9e-6 * sound)
    (sentence,) = found[Concern.CHOKING]
    assert mach > 0.5 and numbers(sentence)[0] == pytest.approx(mach, rel=0.02)
    assert 'film.model = "gas_dam"' in sentence
    assert Concern.CHOKING not in cautions(*coarse, "film.clearance=4 um", path=path)
    # The dam has the inertia.
    assert Concern.CHOKING not in cautions(*GAS, "film.clearance=9 um", 'film.model="gas_dam"', path=path)


def test_a_dam_too_wide_for_the_friction_of_its_mean_radius():
    path = SCENARIOS / "gas_dam_reference.toml"
    zuk = 'film.gas_dam={width="zuk"}'
    (sentence,) = cautions(*GAS, "film.inner_radius=2.315 in", zuk, path=path)[Concern.WIDE_DAM]
    # Slow flow with the friction of every radius, and with that of the mean one, integrated apart from the program.
    assert numbers(sentence) == [pytest.approx(100 * (9331.64 / 9746.03 - 1), abs=0.06)]
    assert Concern.WIDE_DAM not in cautions(*GAS, zuk, path=path)
    for width in ("constant", "radial"):
        other = f'film.gas_dam={{width="{width}"}}'
        assert Concern.WIDE_DAM not in cautions(*GAS, "film.inner_radius=2.315 in", other, path=path)
