"""A film with unknowns of its own (radial_cells.py) tends to the radial film, which it is once more: at rest, in time,
and linearised."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from radial_cells import film_of
from scenes import CLEARANCE, R_I, R_O, SPEED, Sink, film, fms, fmsr, ring, run, runup, started
from scipy.special import iv, kv

from sealdyn.dynamics.condensation import FilmDerivatives
from sealdyn.dynamics.interface import Interface
from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films.radial import film as radial
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import SecondarySeal, Stator
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.selection import check_method, choose_method
from sealdyn.solvers.contract import Cause
from sealdyn.solvers.integrate import solve
from sealdyn.studies.coefficients import Settings, against_frequency

PARTS = [geometry.FORCE, geometry.MOMENT_X, geometry.MOMENT_Y, geometry.FLOW_INNER, geometry.FLOW_OUTER,
         geometry.TORQUE]  # fmt: skip


def moving_state():
    """A tilt that leaves a third of the clearance, and rates of the size of the motion."""
    s = np.zeros(geometry.GAP_STATE_SIZE)
    tilt = 0.65 * CLEARANCE / R_I
    s[geometry.GX], s[geometry.GY], s[geometry.DZ] = 0.8 * tilt, -0.6 * tilt, 0.05 * CLEARANCE
    s[geometry.DZ_RATE] = 0.03 * CLEARANCE * SPEED
    s[geometry.GX_RATE], s[geometry.GY_RATE] = 0.2 * CLEARANCE / R_O * SPEED, 0.1 * CLEARANCE / R_O * SPEED
    s[geometry.MEAN_SPIN], s[geometry.SPIN_DIFFERENCE], s[geometry.VISCOSITY] = 0.5 * SPEED, SPEED, 0.5e-3
    s[geometry.INNER_PRESSURE], s[geometry.OUTER_PRESSURE] = 1e5, 6e5
    return s


def steady(cells, angles=64):
    """Film, block, gap state and pressures of the steady film."""
    cellular, s = film_of(cells, angles), moving_state()
    f, x = cellular.parameters(film(), CLEARANCE), np.empty(cells * angles)
    assert cellular.start(f, s, x) == 0
    return cellular, f, s, x


@pytest.mark.core
def test_force_moments_leakage_and_torque_tend_to_the_radial_films_at_second_order():
    exact = moving_state()
    radial.flow(radial.parameters(film(), CLEARANCE, 1e-13), exact)
    errors = []
    for cells in (16, 32, 64):
        cellular, f, s, x = steady(cells)
        cellular.flow(f, s, x)
        errors.append(np.abs(s[PARTS] / exact[PARTS] - 1))
    errors = np.array(errors)
    orders = np.log2(errors[:-1] / errors[1:])
    # Measured 1.86 to 2.0, and 3.5e-3 of a moment with 64 cells.
    assert np.all((orders > 1.8) & (orders < 2.2)), orders
    assert np.max(errors[-1]) < 1e-2


def test_start_solves_the_residual():
    cellular, f, s, x = steady(12)
    res = np.empty_like(x)
    assert cellular.residual(f, s, x, np.zeros_like(x), res) == 0
    assert np.max(np.abs(res)) < 1e-9 * np.max(np.abs(x))


@pytest.mark.parametrize("side", [1.0, -3.0])
@pytest.mark.parametrize("compressibility", [0.0, 1e-7])
def test_derivatives_by_differences_are_the_films_own(compressibility, side):
    """Three colours serve a film whose cells know their neighbours; unknowns of either sign and larger than their
    scales."""
    rough, own = (film_of(6, 16, compressibility, given) for given in (False, True))
    s, f = moving_state(), own.parameters(film(), CLEARANCE)
    x, found = np.empty(96), []
    own.start(f, s, x)
    unknowns, x = own.unknowns(f), side * x
    assert side > 0.0 or np.min(x) < -np.max(unknowns.scales)
    assert len(set(unknowns.colours)) == 3 and unknowns.differential.all() == (compressibility > 0)
    for one in (own, rough):
        derivatives = FilmDerivatives(one, unknowns, f)
        found.append((derivatives.matrix(s, x, 0 * x, 2e3).data, derivatives.wrench(s, x)))
    for given, differenced in zip(*found, strict=True):
        assert np.max(np.abs(differenced - given)) < 1e-9 * np.max(np.abs(given))


# --- in time ----------------------------------------------------------------------------------------


def cellular(cells, angles=16, **more):
    """A Model of that film."""
    return partial(Model, film=film_of(cells, angles, **more))


def largest(found, exact):
    return float(np.max(np.abs(found.scaled() - exact.scaled())) / np.max(np.abs(exact.scaled())))


MASSLESS = fms(stator=Stator(**ring(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0, misalignment=25e-6)))


@pytest.mark.parametrize("scene", [fms(), fmsr(), MASSLESS], ids=["stator", "both rings", "massless stator"])
def test_motion_tends_to_that_of_the_radial_film_at_second_order(scene):
    exact = run(scene, 0.5, method="ida")
    errors = []
    for cells in (16, 32, 64):
        found = run(scene, 0.5, method="ida", model_class=cellular(cells))
        assert found.outcome.status == "ok" and found.outcome.energy_residual < 1e-5
        errors.append(largest(found, exact))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.7) & (orders < 2.3)), (orders, errors)
    for name in ("film_force", "leakage_inner", "friction_torque", "h_min"):
        assert np.max(np.abs(found[name] - exact[name])) < 0.01 * np.max(np.abs(exact[name])), name


def test_asperities_touch_beside_the_film():
    scene = replace(fms(), contact=Contact(roughness=3.8e-6, compressive_strength=3e8))
    exact, found = run(scene, 0.25, method="ida"), run(scene, 0.25, method="ida", model_class=cellular(48))
    assert np.max(exact["contact_force"]) > 1.0
    assert np.max(np.abs(found["contact_force"] - exact["contact_force"])) < 0.01 * np.max(exact["contact_force"])
    assert largest(found, exact) < 0.02 and found.outcome.energy_residual < 1e-5


def test_friction_that_does_not_stick_acts_beside_the_film():
    def with_seal(**given):
        seal = SecondarySeal(radius=0.04, friction_force=3.0, **given)
        return fms(stator=Stator(**ring(misalignment=25e-6, secondary_seal=seal)))

    scene = with_seal(law="regularised", width=1e-4)
    exact, found = run(scene, 0.25, method="ida"), run(scene, 0.25, method="ida", model_class=cellular(48))
    assert found.outcome.status == "ok" and np.max(np.abs(found["stator_seal_moment_x"])) > 0.01
    assert largest(found, exact) < 0.02
    with pytest.raises(SceneError):
        cellular(4)(with_seal())


def test_pressures_follow_a_changing_speed_past_its_kinks():
    duration = 0.03
    exact, found = (run(runup(), duration=duration, per_turn=8, method="ida", **more)
                    for more in ({}, {"model_class": cellular(48)}))  # fmt: skip
    assert found.outcome.status == "ok" and found.outcome.segment == 2
    assert largest(found, exact) < 0.02


def test_a_run_by_differences_is_that_of_the_films_own_derivatives():
    own, rough = (run(fms(), 0.25, method="ida", model_class=cellular(8, own_derivatives=o)) for o in (True, False))
    assert largest(rough, own) < 1e-6


def test_methods_that_need_rates_refuse_with_a_sentence():
    ready = started(fms(), 0.01, model_class=cellular(4))
    assert choose_method(ready)[0] == "ida"
    for method in ("adams", "bdf", "dop853", "radau", "expm"):
        with pytest.raises(SceneError):
            check_method(ready.model, method)
    for method in ("adams", "dop853"):
        outcome = solve(ready, method, 1e-6, Sink(0.01, 1e-3))
        assert outcome.status == "failed" and outcome.cause == Cause.METHOD_GAVE_UP


def test_derivatives_of_the_residual_are_its_differences():
    """Columns of rings, film and works, against differences of the whole residual at a state that moves."""
    segment = cellular(5, 8)(fmsr()).segment()
    draw, alpha = np.random.default_rng(1), 3e4
    y = 0.1 * segment.scales * draw.normal(size=segment.size)
    yp = 100.0 * segment.scales * draw.normal(size=segment.size)
    data, above, below = np.empty(segment.pattern.nnz), np.empty(segment.size), np.empty(segment.size)
    segment.residual_derivatives(0.0, y, yp, alpha, data)
    found = segment.pattern.copy()
    found.data[:] = data
    expected = np.empty(found.shape)
    for j in range(segment.size):
        step = np.zeros(segment.size)
        step[j] = 1e-6 * max(abs(y[j]), segment.scales[j])
        segment.residual(0.0, y + step, yp + alpha * step, above)
        segment.residual(0.0, y - step, yp - alpha * step, below)
        expected[:, j] = (above - below) / (2 * step[j])
    apart, size = np.abs(found.toarray() - expected) * segment.scales, np.abs(expected) * segment.scales
    worst = apart / size.max(axis=1, keepdims=True)
    assert np.max(worst) < 1e-6, np.argwhere(worst > 1e-6)


@pytest.mark.parametrize("scene", [fms(), MASSLESS], ids=["with mass", "massless"])
@pytest.mark.parametrize("compressibility", [0.0, 1e-9])
def test_start_is_consistent(scene, compressibility):
    segment = cellular(6, 16, compressibility=compressibility)(scene).segment()
    y, res = np.zeros(segment.size), np.empty(segment.size)
    y[: segment.n_mechanical] = 0.1 * segment.scales[: segment.n_mechanical]
    segment.settle_film(0.0, y)
    begun, yp = segment.start(0.0, y)
    segment.residual(0.0, begun, yp, res)
    assert np.array_equal(begun[: segment.n_mechanical], y[: segment.n_mechanical])
    assert np.max(np.abs(res[segment.film])) < 1e-9 * 5e5
    size = np.abs(yp[: segment.n_mechanical]) + 1.0
    assert np.max(np.abs(res[: segment.n_mechanical]) / size) < 1e-8


# --- linearised -------------------------------------------------------------------------------------


def test_stiffness_and_damping_tend_to_the_radial_films_and_hang_on_no_frequency():
    exact = Interface(fms(), 1e-13).slopes()[:2]
    errors = []
    for cells in (16, 32, 64):
        interface = Interface(fms(), 1e-13, film_of(cells, 16))
        found = interface.slopes()[:2]
        for fast in interface.slopes(omega=5e3)[:2], interface.slopes(omega=1.0)[:2]:
            assert fast[0] == pytest.approx(found[0], rel=1e-7, abs=1e-7 * found[0][1, 1])
            assert fast[1] == pytest.approx(found[1], rel=1e-6, abs=1e-6 * found[1][1, 1])
        errors.append([abs(a[i] / b[i] - 1) for a, b in zip(found, exact, strict=True) for i in ((0, 0), (1, 1))])
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.7) & (orders < 2.3)), orders
    assert np.max(errors[-1]) < 6e-3


def squeezed_compressible_film(omega, compressibility, mu=0.5e-3):
    """Axial K + i w D of flat faces with a compressible liquid between: p = -(1/(beta h)) (1 - A I0(l r) - B K0(l r)),
    l^2 = 12 mu i w beta / h^2, zero at both radii; per unit of the gap's amplitude."""
    root = np.sqrt(12j * omega * mu * compressibility) / CLEARANCE
    a, b = np.linalg.solve([[iv(0, root * r), kv(0, root * r)] for r in (R_I, R_O)], [1.0, 1.0])

    def primitive(r):
        return 0.5 * r * r - r / root * (a * iv(1, root * r) - b * kv(1, root * r))

    return 2 * np.pi / (compressibility * CLEARANCE) * (primitive(R_O) - primitive(R_I))


@pytest.mark.parametrize("omega", [30.0, 1e3, 2e4])
def test_stiffness_and_damping_of_a_compressible_film_hang_on_the_frequency(omega):
    flat, compressibility = replace(fms(), film=film(coning=0.0)), 2.7e-6
    exact = squeezed_compressible_film(omega, compressibility)
    errors = []
    for cells in (24, 48, 96):
        k, d = Interface(flat, 1e-13, film_of(cells, 4, compressibility)).slopes(omega=omega)[:2]
        errors.append(abs(k[0, 0] + 1j * omega * d[0, 0] - exact) / abs(exact))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.7) & (orders < 2.3)) and errors[-1] < 3e-3, (orders, errors)


def test_coefficients_study_shows_them_over_the_frequency():
    flat, compressibility = replace(fms(), film=film(coning=0.0)), 2.7e-6
    model = Model(flat, 1e-10, film=film_of(96, 4, compressibility))
    found = against_frequency(model, Settings(points=3, speed_to=2e4), SPEED)
    assert model.interface.stores and found["frequency"] == [0.0, 1e4, 2e4]
    for i, omega in ((1, 1e4), (2, 2e4)):
        exact = squeezed_compressible_film(omega, compressibility)
        total = found["stiffness"][i][0][0] + 1j * omega * found["damping"][i][0][0]
        assert abs(total - exact) < 3e-3 * abs(exact)


def test_damping_at_no_frequency_is_the_limit():
    interface = Interface(fms(), 1e-13, film_of(12, 8, 1e-7))
    still, slow = interface.slopes()[:2], interface.slopes(omega=1.0)[:2]
    for one, other in zip(still, slow, strict=True):
        assert one == pytest.approx(other, rel=1e-5, abs=1e-5 * abs(one[1, 1]))
