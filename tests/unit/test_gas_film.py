"""The film of a gas dam around the circle, against sums of the marched dam; gases; what a gas refuses."""

import math

import numpy as np
import pytest
from command import SCENARIOS
from marched_dam import Dam, flow
from scenes import run

from sealdyn.dynamics.condensation import film_slopes
from sealdyn.dynamics.imposed_motion import fluid_conditions
from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films import linear
from sealdyn.films.gas_dam import film as gas_dam
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scenario.errors import ScenarioError
from sealdyn.scenario.reader import parse_scenario
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Coefficients, Film
from sealdyn.scene.fluid import GASES, GasDam, density_of, viscosity_of
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene, SceneError
from sealdyn.solvers.contract import Status

R_I, R_O, HIGH, LOW, HOT = 0.083, 0.0845, 1.4e6, 1e5, 700.0
CONING, CLEARANCE = -2e-3, 6.5e-6
REFERENCE = SCENARIOS / "gas_dam_reference.toml"


def film(**changes):
    """A dam that narrows outwards, high pressure inside."""
    given = dict(
        model="gas_dam", gas="air", temperature=HOT, inner_radius=R_I, outer_radius=R_O, inner_pressure=HIGH,
        outer_pressure=LOW, clearance=CLEARANCE, coning=CONING, gas_dam=GasDam(width="constant"),
    )  # fmt: skip
    return Film(**(given | changes))


def loads(table, tilt=0j, kernel=gas_dam.flow, error=1e-10, dz=0.0):
    """The gap state at a tilt (rad, complex)."""
    s = np.zeros(geometry.GAP_STATE_SIZE)
    s[geometry.GX], s[geometry.GY], s[geometry.DZ] = tilt.real, tilt.imag, dz
    for slot, value in fluid_conditions(table).items():
        s[slot] = value
    s[geometry.SPIN_DIFFERENCE] = 1000.0
    kernel(gas_dam.parameters(table, table.clearance, error), s)
    return s


def marched_sum(table, tilt, angles):
    """Force, moments (N m) and mass flow (kg/s) as a sum of marched dams over even angles; high pressure inside."""
    gas, total, width = GASES[table.gas], np.zeros(4), R_O - R_I
    mean = 0.5 * (R_I + R_O)
    for theta in 2 * math.pi * np.arange(angles) / angles:
        swing = tilt.real * math.sin(theta) - tilt.imag * math.cos(theta)
        films = CLEARANCE + R_I * swing, CLEARANCE + CONING * width + R_O * swing
        dam = Dam((R_I, R_O), films, (HIGH, LOW), HOT, gas.gas_constant, gas.heat_ratio, gas.viscosity,
                  lambda re: ((24 / re) ** 8 + (0.079 / re**0.25) ** 8) ** 0.125, False, False, 1.0)  # fmt: skip
        found = flow(dam)
        arm = mean + (found.centre - 0.5) * width
        force = found.force * mean
        moments = arm * force * math.sin(theta), -arm * force * math.cos(theta)
        total += np.array([force, *moments, found.mass_flow * mean])
    return total * 2 * math.pi / angles


@pytest.mark.parametrize("tilt", [0j, 2e-5 - 1e-5j, 3.5e-5 * np.exp(2j)])
def test_force_moments_and_flow_are_the_sum_of_marched_dams(tilt):
    s, table = loads(film(), tilt), film()
    force, m_x, m_y, mass = marched_sum(table, tilt, 40 if tilt else 4)
    area = math.pi * (R_O - R_I) * (R_O + R_I)
    assert s[geometry.FORCE] - LOW * area == pytest.approx(force, rel=1e-6)
    assert s[geometry.MOMENT_X] == pytest.approx(m_x, rel=1e-5, abs=1e-9 * force * R_O)
    assert s[geometry.MOMENT_Y] == pytest.approx(m_y, rel=1e-5, abs=1e-9 * force * R_O)
    for slot in (geometry.FLOW_INNER, geometry.FLOW_OUTER):
        assert density_of(table) * s[slot] == pytest.approx(mass, rel=1e-6)


@pytest.mark.parametrize("error", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize(("tilt", "clearance"), [(1e-5, 5e-6), (3e-5, 5e-6), (4e-5, 5e-6), (2.04e-5, 6.074e-6)])
def test_sectors_keep_the_error_asked_also_where_the_flow_begins_to_choke(error, tilt, clearance):
    """In the last of these few sectors would do for the tilt alone."""
    table = film(clearance=clearance)
    exact, s = loads(table, tilt * 1j, error=1e-12), loads(table, tilt * 1j, error=error)
    machs = gas_dam.exit_mach(gas_dam.parameters(table, table.clearance), exact)
    assert tilt < 2e-5 or machs[0] < 1.0 == machs[1]
    for slot in (geometry.FORCE, geometry.MOMENT_Y, geometry.MOMENT_X, geometry.FLOW_INNER):
        scale = R_O * exact[geometry.FORCE] if slot in (geometry.MOMENT_X, geometry.MOMENT_Y) else exact[slot]
        assert abs(s[slot] - exact[slot]) <= error * scale


def test_turned_tilt_turns_the_moment_and_mirrored_pressures_reverse_the_flow():
    one, other = loads(film(), 3e-5), loads(film(), 3e-5j)
    assert other[geometry.MOMENT_Y] == pytest.approx(one[geometry.MOMENT_X], rel=1e-12)
    assert other[geometry.FORCE] == pytest.approx(one[geometry.FORCE], rel=1e-13)
    # A narrow constant-width dam does not know inside from outside.
    turned = film(inner_pressure=LOW, outer_pressure=HIGH, coning=-CONING, clearance=CLEARANCE + CONING * (R_O - R_I))
    back, forth = loads(turned), loads(film())
    assert back[geometry.FLOW_INNER] == pytest.approx(-forth[geometry.FLOW_INNER], rel=1e-12)
    assert back[geometry.FORCE] == pytest.approx(forth[geometry.FORCE], rel=1e-12)


@pytest.mark.core
def test_pressure_field_sums_up_to_the_force():
    table = film(gas_dam=None)
    f, s = gas_dam.parameters(table, table.clearance), loads(table, 2.5e-5 + 1e-5j)
    r, theta = gas_dam.grid(f)
    assert len(r) > 16 and len(theta) > 16
    # Where it chokes the pressure falls as a root: many radii.
    r = R_I + (R_O - R_I) * 0.5 * (1 - np.cos(np.pi * np.arange(1000) / 999))
    field = np.empty((1, 1000, len(theta)))
    gas_dam.fields(f, s, field)
    gauge = np.trapezoid((field[0] - LOW) * r[:, None], r, axis=0)
    low = LOW * math.pi * (R_O - R_I) * (R_O + R_I)
    assert 2 * math.pi * gauge.mean() == pytest.approx(s[geometry.FORCE] - low, rel=2e-5)
    # From the reservoir, less what speeds the gas up, down to the low pressure or the choked one.
    assert np.all(np.diff(field[0], axis=0) < 0) and np.all(field[0, 0] <= HIGH) and np.all(field[0, -1] >= LOW * 0.999)


def test_where_there_is_no_flow_the_film_says_so():
    """A dam that opens tenfold outwards chokes at its entrance."""
    wide = film(clearance=2e-5, coning=0.2)
    s = loads(wide, kernel=gas_dam.wrench)
    assert math.isnan(s[geometry.FORCE]) and gas_dam.STATUS[int(s[geometry.REFUSED])].startswith("the gas chokes")
    with pytest.raises(SceneError, match="no solution"):
        Model(seal(wide))
    with pytest.raises(SceneError, match="no solution"):
        film_slopes(gas_dam.wrench, gas_dam.parameters(wide, wide.clearance), s, (1e-8, 1e-7, 1e-5, 1e-4))


SUPPORT = Support(axial_stiffness=2e4, axial_damping=100.0, radius=0.085)


def seal(table, **stator):
    ring = dict(mass=0.15, transverse_inertia=5.3e-4, polar_inertia=10.5e-4, misalignment=2e-5, support=SUPPORT)
    return Scene(Shaft(speed=1250.0), table, stator=Stator(**(ring | stator)), rotor=Rotor(runout=1.5e-5))


@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853", "radau"])
def test_a_run_that_leaves_what_the_film_has_solutions_for_ends_in_words(method):
    """Pressure that rises on a dam that opens outwards, held open, until its entrance chokes."""
    rising = PiecewiseLinear((0.0, 0.02), (2e5, 8e6))
    held = Support(axial_stiffness=1e10, axial_damping=1e4, radius=0.085)
    table = film(inner_pressure=rising, coning=2.2e-2, clearance=9e-6)
    found = run(seal(table, support=held), 2.0, method=method)
    assert found.outcome.status == Status.FAILED and found.outcome.tau < 0.008
    assert "chokes at the entrance" in found.outcome.message


# --- gases --------------------------------------------------------------------------------------------


@pytest.mark.core
def test_gas_constants_and_viscosities_are_the_published_ones():
    """Universal gas constant over molar mass; viscosities at 300 K of Lemmon & Jacobsen (2004) for nitrogen, argon and
    air, of Petersen (1970) for helium, within 1.5 %."""
    molar = {"air": 28.9647, "nitrogen": 28.0134, "helium": 4.002602, "argon": 39.948}
    at_300 = {"air": 18.54e-6, "nitrogen": 17.89e-6, "helium": 19.91e-6, "argon": 22.72e-6}
    for name, gas in GASES.items():
        assert gas.gas_constant == pytest.approx(8314.46262 / molar[name], rel=1e-4)
        assert gas.viscosity(300.0) == pytest.approx(at_300[name], rel=0.015)
    for temperature in np.linspace(GASES["helium"].lowest, GASES["helium"].highest, 9):
        assert GASES["helium"].viscosity(temperature) == pytest.approx(3.674e-7 * temperature**0.7, rel=0.025)


def test_viscosity_follows_a_table_of_temperatures():
    """Linear between 16 points: the law is met to 3e-4 in between; a step stays a step."""
    ramp = PiecewiseLinear((0.0, 1.0, 1.0, 2.0), (300.0, 700.0, 400.0, 400.0))
    viscosity = viscosity_of(film(temperature=ramp))
    for t in np.linspace(0.0, 2.0, 41):
        assert viscosity.at(t) == pytest.approx(GASES["air"].viscosity(ramp.at(t)), rel=5e-4)
    assert viscosity.time.count(1.0) == 2
    own = film(temperature=ramp, viscosity=2e-5)
    assert viscosity_of(own) == 2e-5


def test_a_gas_is_counted_at_normal_conditions():
    assert density_of(film()) == pytest.approx(1.2923, rel=1e-4)
    assert density_of(film(gas=None, viscosity=1e-3, density=870.0)) == 870.0


def test_linear_film_of_a_gas_leaks_as_the_isothermal_viscous_dam():
    """h^3 (p1^2 - p2^2)/(24 mu R T L) over the mean circumference."""
    own = Coefficients(tilt_stiffness=1e4, tilt_damping=1.0, axial_stiffness=1e7, axial_damping=1e3)
    table = film(model="linear", coefficients=own, coning=0.0, clearance=1e-6)
    s = loads(table)
    f = linear.parameters(table, table.clearance)
    linear.flow(f, s)
    mu, gas, width = GASES["air"].viscosity(HOT), GASES["air"], R_O - R_I
    mass = math.pi * (R_I + R_O) * 1e-18 * (HIGH**2 - LOW**2) / (24 * mu * gas.gas_constant * HOT * width)
    assert density_of(table) * s[geometry.FLOW_INNER] == pytest.approx(mass, rel=1e-12)


# --- what the user meets ------------------------------------------------------------------------------

BAD = [
    ({"gas": '"heliun"'}, "gas", "'helium'"),
    ({"temperature": '"20 bar"'}, "temperature", "temperature"),
    ({"temperature": "5000"}, "temperature", "Sutherland"),
    ({"temperature": None}, "temperature", "temperature"),
    ({"outer_pressure": "0"}, "outer_pressure", "above 0"),
    ({"cavitation_pressure": "0"}, "cavitation_pressure", "cavitate"),
    ({"inertia": "true"}, "inertia", "liquids"),
    ({"model": '"radial"'}, "model", '"gas_dam"'),
    ({"model": '"linear"'}, "model", '"gas_dam"'),
    ({"gas": None}, "viscosity", "viscosity"),
    ({"gas": None, "viscosity": "1e-3"}, "temperature", "air"),
    ({"gas": "{ gas_constant = 287.0 }"}, "viscosity", "reference_viscosity"),
    ({"gas": "{ gas_constant = 287.0, heat_ratio = 0.9, reference_viscosity = 2e-5 }"}, "heat_ratio", "above 1"),
    ({"gas_dam": "{ entrance_loss = 1.5 }"}, "entrance_loss", "no loss"),
    ({"gas_dam": '{ friction = "lamnar" }'}, "friction", "laminar"),
    ({"geometry": '"planar"'}, "model", "cylindrical"),
]


@pytest.mark.parametrize("changes,key,hint", BAD, ids=[f"{next(iter(c))}-{h}" for c, _, h in BAD])
def test_bad_gas_keys_get_one_clear_line(changes, key, hint):
    values = {
        "model": '"gas_dam"', "gas": '"air"', "temperature": '"800 degF"', "inner_radius": '"83 mm"',
        "outer_radius": '"84.5 mm"', "inner_pressure": '"14 bar"', "outer_pressure": '"1 bar"', "clearance": '"6 um"',
        "coning": "-2e-3",
    } | changes  # fmt: skip
    lines = "\n".join(f"{name} = {value}" for name, value in values.items() if value is not None)
    text = f'[shaft]\nspeed = "12000 rpm"\n[film]\n{lines}\n[stator]\nmass = 1\n[stator.support]\n'
    text += "axial_stiffness = 1e5\nradius = 0.08\n[run]\n"
    with pytest.raises(ScenarioError) as error:
        parse_scenario(text, "x.toml")
    line = str(error.value)
    assert "\n" not in line and key in line and hint in line


@pytest.mark.parametrize(
    "words,kelvin",
    [("800 degF", 699.8167), ("20 degC", 293.15), ("20 °C", 293.15), ("20 celsius", 293.15), ("300 K", 300.0)],
)
def test_temperatures_have_scales(words, kelvin):
    text = REFERENCE.read_text().replace('"800 degF"', f'"{words}"')
    assert parse_scenario(text, "x.toml").scene.film.temperature == pytest.approx(kelvin, rel=1e-6)
