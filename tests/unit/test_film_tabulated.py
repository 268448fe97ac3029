"""Film by numbers: its matrices, forces, leakage and files, and what is refused."""

import math
from dataclasses import replace

import h5py
import numpy as np
import pytest
from gas_faces import gap_state
from scenes import R_I, R_O, SUPPORT, film, fms, run
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import PchipInterpolator

from sealdyn.analysis.film_matrices import State, matrices
from sealdyn.dynamics.condensation import film_slopes
from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films.tabulated import FILM, parameters
from sealdyn.scenario.reader import ScenarioError, parse_scenario, read_scenario
from sealdyn.scene.scene import Closing, Initial, RingStart
from sealdyn.scene.tabulated import ELEMENTS, ORDER, Tabulated
from sealdyn.studies._runner import run_study
from sealdyn.studies.coefficients import columns_of, mapped

# Of each clearance, at rest; the wedge is half the speed times the tilt damping.
ROWS = (6e-6, 8e-6, 10e-6, 14e-6, 20e-6)
FULL_K = np.array([[2e7, 3e4, -2e4], [1e4, 6e3, 1800.0], [-4e4, -1500.0, 5e3]])
FULL_D = np.array([[9e3, 5.0, 3.0], [-4.0, 3.6, 0.2], [6.0, -0.1, 3.2]])


def named(stiffness, damping):
    """The elements of both matrices by their columns' names."""
    return dict(zip(ELEMENTS, [*np.ravel(stiffness).tolist(), *np.ravel(damping).tolist()], strict=True))


def scaled(**changes):
    """A table over clearances: both matrices, falling with different powers of the film thickness."""
    share = np.array(ROWS) / 1e-5
    held = {name: tuple((value * share ** (-3.5 if name[0] == "k" else -3.0)).tolist())
            for name, value in named(FULL_K, FULL_D).items()}  # fmt: skip
    return Tabulated(**held, clearance=ROWS, **changes)


def table_of(tabulated, **changes):
    return replace(film("tabulated", **changes), tabulated=tabulated)


def gap(**slots):
    return gap_state(film("tabulated"), 1000.0, **slots)


@pytest.mark.core
def test_motion_of_full_matrices_is_that_of_the_equations():
    start = RingStart(z=1e-7, tilt_x=2e-6, tilt_y=-1e-6)
    scene = fms(own=0.0, runout=0.0, film=table_of(Tabulated(**named(FULL_K, FULL_D))), initial=Initial(stator=start))
    found = run(scene, duration=0.004, accuracy=1e-9)
    arm = SUPPORT.radius**2 / 2
    mass = np.array([1.0, 8e-4, 8e-4])
    stiffness = FULL_K + SUPPORT.axial_stiffness * np.diag([1.0, arm, arm])
    damping = FULL_D + SUPPORT.axial_damping * np.diag([1.0, arm, arm])

    def rates(_, y):
        return [*y[3:], *(-(stiffness @ y[:3] + damping @ y[3:]) / mass)]

    exact = solve_ivp(rates, (0.0, 0.004), [1e-7, 2e-6, -1e-6, 0, 0, 0], "DOP853", found.times, rtol=1e-11, atol=1e-20)
    off = np.abs(found.q - exact.y[:3].T).max(axis=0)
    assert np.all(off < 1e-7 * np.abs(exact.y[:3]).max(axis=1)), off
    assert found.outcome.energy_residual < 1e-8
    # And so are the eigenvalues.
    values = np.sort_complex(Model(scene).linear_scene().eigen()[0])
    state = np.block([[np.zeros((3, 3)), np.eye(3)], [-stiffness / mass[:, None], -damping / mass[:, None]]])
    assert values == pytest.approx(np.sort_complex(np.linalg.eigvals(state)), rel=1e-8)


def test_force_is_the_integral_of_the_axial_stiffness():
    scene = fms(film=table_of(scaled(opening_force=900.0, opening_clearance=8e-6), clearance=1.1e-5))
    force = FILM.opening_law(scene.film, 500.0, 1000.0)
    k = PchipInterpolator(ROWS, np.array(scene.film.tabulated.k_axial_axial) * np.array(ROWS) ** 3)
    for clearance in (6e-6, 8e-6, 9.3e-6, 1.7e-5, 2e-5):
        lost = quad(lambda h: float(k(h)) / h**3, 8e-6, clearance, epsrel=1e-11, points=[1e-5, 1.4e-5])[0]
        assert force(clearance, 0.0, 5e5) == pytest.approx(900.0 - lost, rel=1e-9)
    # It follows the pressure as that of the narrow seal.
    assert force(8e-6, 0.0, 6e5) > 900.0 > force(8e-6, 0.0, 4e5)
    assert math.isnan(force(5e-6, 0.0, 5e5)) and math.isnan(force(2.1e-5, 0.0, 5e5))


def test_matrices_are_the_slopes_of_the_forces():
    f = parameters(table_of(scaled()), 1e-5)
    s = gap(DZ=-7e-7, GX=4e-6, DZ_RATE=1e-4, GY_RATE=2e-3)
    found, exact = film_slopes(FILM.wrench, f, s, (2e-8, 5e-7, 1e-5, 5e-4))[:2], FILM.matrices(f, s)
    for one, other in zip(found, exact, strict=True):
        assert np.abs(one - other) == pytest.approx(0.0, abs=1e-7 * np.abs(other).max())
    # Aligned at the design clearance they are the rows themselves, and no moment is left.
    for one, other in zip(FILM.matrices(f, gap()), (FULL_K, FULL_D), strict=True):
        assert one == pytest.approx(other, rel=1e-12)
    s = gap()
    FILM.wrench(f, s)
    assert s[geometry.MOMENT_X] == pytest.approx(0.0, abs=1e-9)


SPEEDS, CLEARANCES = (0.0, 1000.0, 2000.0), (5e-6, 7e-6, 1e-5, 1.4e-5, 2e-5)


def written(columns, path):
    units = {"clearance": ("um", 1e6), "speed": ("rpm", 30 / math.pi), "frequency": ("rad/s", 1.0)}
    heads = [f"{name} ({units[name][0]})" if name in units else name for name in columns]
    factors = [units.get(name, ("", 1.0))[1] for name in columns]
    rows = zip(*columns.values(), strict=True)
    lines = (",".join(repr(v * f) for v, f in zip(row, factors, strict=True)) for row in rows)
    path.write_text("\n".join([",".join(heads), *lines]))


def test_what_the_radial_film_writes_comes_back(tmp_path):
    scene = fms("radial", own=1e-6, runout=1e-6)
    columns = columns_of(mapped(scene, 1e-10, SPEEDS, [0.0], clearances=CLEARANCES))
    written(columns, tmp_path / "film.csv")
    with h5py.File(tmp_path / "film.h5", "w") as file:
        for name, values in columns.items():
            file[f"table.{name}"] = values
    given = SEAL.replace("[film]", '[film]\nmodel = "tabulated"\ntabulated = { file = "film.csv" }')
    (tmp_path / "seal.toml").write_text(given)
    by_csv = read_scenario(tmp_path / "seal.toml")
    for scenario in (by_csv, read_scenario(tmp_path / "seal.toml", ["film.tabulated.file=film.h5"])):
        again = columns_of(mapped(scenario.scene, 1e-10, SPEEDS, [0.0], clearances=CLEARANCES))
        for name, values in columns.items():
            assert again[name] == pytest.approx(values, rel=1e-9, abs=1e-9 * max(map(abs, values), default=0.0) + 1e-9)
    # Between its rows it is near, and beyond its speeds the film has the wedge that it has.
    one, other = (matrices(Model(s), State(), 3000.0) for s in (scene, by_csv.scene))
    assert np.abs(one[0] - other[0]).max() < 1e-9 * np.abs(one[0]).max()
    # Small motion is that of the radial film, and so is the threshold.
    one, other = (run(s, duration=0.01, accuracy=1e-8) for s in (scene, by_csv.scene))
    assert np.abs(one.q - other.q).max() < 3e-3 * np.abs(one.q).max()
    # Whole without the file.
    assert parse_scenario(by_csv.to_toml(), "seal.toml").scene == by_csv.scene


def test_threshold_is_that_of_the_radial_film():
    scene = fms("radial", own=1e-6, runout=1e-6)
    held = columns_of(mapped(scene, 1e-10, SPEEDS, [0.0]))
    table = Tabulated(**{name: tuple(held[name]) for name in ("speed", *ELEMENTS)})
    one, other = (Model(s) for s in (scene, replace(scene, film=table_of(table))))
    for w in (1000.0, 5000.0, 7000.0):
        values = [np.sort_complex(m.linear_scene(speed=w).eigen()[0]) for m in (one, other)]
        assert values[1] == pytest.approx(values[0], rel=1e-7)


def test_leakage_goes_with_the_cube_of_the_film():
    f = parameters(table_of(Tabulated(**named(FULL_K, FULL_D), leakage=2e-9)), 1e-5)
    for dz, drop in ((0.0, 5e5), (3e-6, 5e5), (-2e-6, 2e5), (0.0, -5e5)):
        s = gap(DZ=dz, OUTER_PRESSURE=max(drop, 0.0), INNER_PRESSURE=max(-drop, 0.0))
        FILM.flow(f, s)
        # Inwards, where the pressure is higher outside.
        assert s[geometry.FLOW_INNER] == pytest.approx(-2e-9 * (1.0 + dz / 1e-5) ** 3 * drop / 5e5, rel=1e-12)


def test_leakage_of_a_table_passes_through_its_rows():
    rows = [(h, p, 3e4 * h**2.5 * p**0.8) for h in (6e-6, 1e-5, 2e-5) for p in (1e5, 4e5, 1e6)]
    places, drops, flows = (tuple(column) for column in zip(*rows, strict=True))
    own = dict(leakage=flows, leakage_clearance=places, leakage_difference=drops)
    f = parameters(table_of(Tabulated(**named(FULL_K, FULL_D), **own)), 1e-5)
    for h, p, flow in [*rows, (1e-5, 5e4, rows[3][2] / 2), (4e-5, 1e5, rows[6][2] * 8)]:
        s = gap(DZ=h - 1e-5, OUTER_PRESSURE=p)
        FILM.flow(f, s)
        assert -s[geometry.FLOW_INNER] == pytest.approx(flow, rel=1e-9)


def test_a_run_that_leaves_the_table_ends():
    scene = fms(own=0.0, runout=0.0, film=table_of(scaled()),
                initial=Initial(stator=RingStart(z=9.5e-6, z_rate=0.2)))  # fmt: skip
    found = run(scene, duration=0.01)
    assert found.outcome.status != "ok" and "film.tabulated" in found.outcome.message


SEAL = f"""
[shaft]
speed = "1000 rad/s"
[film]
inner_radius = {R_I}
outer_radius = {R_O}
clearance = "10 um"
coning = "3.125 mrad"
viscosity = "0.5 mPa*s"
outer_pressure = "5 bar"
inner_pressure = "0 bar"
[rotor]
runout = "1 urad"
[stator]
mass = "1 kg"
transverse_inertia = "8e-4 kg*m^2"
polar_inertia = "16e-4 kg*m^2"
misalignment = "1 urad"
support = {{ axial_stiffness = "5e5 N/m", axial_damping = "300 N*s/m", radius = "40 mm" }}
[run]
turns = 1
"""
TWO = "k_axial_axial = [1e7, 2e7]\nd_axial_axial = 1e3\nk_tilt_x_tilt_x = 5e3\nk_tilt_y_tilt_y = 5e3"


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ("d_axial_axial = 1e3", "tabulated.k_axial_axial"),
        (TWO, "tabulated.clearance"),
        (f"{TWO}\nclearance = [8e-6, 9e-6, 1.2e-5]", "tabulated.clearance"),
        (f"{TWO}\nclearance = [1.1e-5, 2e-5]", "clearance"),
        (f"{TWO}\nclearance = [8e-6, -2e-5]", "tabulated.clearance"),
        (f"{TWO}\nfrequency = [0, 100]\nclearance = 1e-5", "tabulated.frequency"),
        (f"{TWO}\nconing = [0, 1e-3]", "tabulated.coning"),
        (f"{TWO}\nspeed = [0, 500]", "speed"),
        ('k_axial_axial = "3 N*m"', "tabulated.k_axial_axial"),
        ("k_axial_axial = 1e7\nleakage = [1e-9, 2e-9]", "tabulated.leakage"),
        ("k_axial_axial = 1e7\nleakage_clearance = 1e-5", "tabulated.leakage_clearance"),
        ('file = "none.csv"', "tabulated.file"),
    ],
)
def test_what_a_table_cannot_be(table, key):
    text = SEAL.replace("[film]", '[film]\nmodel = "tabulated"')
    text = text.replace("[rotor]", f"[film.tabulated]\n{table}\n[rotor]")
    with pytest.raises(ScenarioError) as error:
        parse_scenario(text, "seal.toml")
    assert error.value.key == (f"film.{key}" if key != "speed" else "shaft.speed")


def test_one_of_several_frequencies_is_taken():
    table = Tabulated(k_axial_axial=(1e7, 3e7), frequency=(0.0, 200.0), at_frequency=200.0)
    assert FILM.matrices(parameters(table_of(table), 1e-5), gap())[0][0, 0] == 3e7


def test_the_closing_force_finds_the_clearance():
    table = table_of(scaled(opening_force=700.0, opening_clearance=1e-5), clearance=None)
    model, area = Model(fms(film=table, closing=Closing(0.8, 10.0))), math.pi * (R_O**2 - R_I**2)
    assert 6e-6 < model.clearance < 1e-5
    assert model.interface.opening_force(model.clearance, 0.0, 5e5) == pytest.approx(0.8 * 5e5 * area + 10.0, rel=1e-9)


def test_the_study_writes_the_table_that_the_film_reads(tmp_path):
    scenario = parse_scenario(SEAL, "seal.toml")
    flags = {"clearance": "6:15um:4", "speed": "0:2000rad/s:3", "points": 2}
    run_study("coefficients", scenario, tmp_path / "film.h5", flags=flags, workers=1)
    given = SEAL.replace("[film]", '[film]\nmodel = "tabulated"\ntabulated = { file = "film.h5" }')
    (tmp_path / "seal.toml").write_text(given)
    table = read_scenario(tmp_path / "seal.toml").scene.film.tabulated
    assert sorted(set(table.clearance)) == pytest.approx([6e-6, 9e-6, 12e-6, 15e-6]) and len(table.speed) == 12
    exact = matrices(Model(replace(scenario.scene, film=replace(scenario.scene.film, clearance=9e-6))), State())
    place = [k for k in range(12) if table.speed[k] == 1000.0 and table.clearance[k] == pytest.approx(9e-6)]
    assert len(place) == 1
    for i, row in enumerate(ORDER):
        assert getattr(table, f"k_{row}_{row}")[place[0]] == pytest.approx(exact[0][i, i], rel=1e-9)
