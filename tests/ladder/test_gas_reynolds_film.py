"""The gas Reynolds film among the others: at a high mean pressure it is the radial film; in time with the rings it
stores what flows in, and moves as its own linear form says."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from gas_faces import PARTS, gap_state, gas_film, steady
from scenes import SPEED, TILT_SCALE, Sink, fms, prepared, run, started
from scipy.integrate import simpson

from sealdyn.dynamics.interface import Interface
from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films.gas_reynolds import film as gas
from sealdyn.films.radial import film as radial
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.scene.scene import SceneError
from sealdyn.simulation.certificate import certify
from sealdyn.simulation.film_error import cell_error
from sealdyn.simulation.selection import check_method, choose_method
from sealdyn.solvers.integrate import solve

# Narrow, so that nothing flows around the circle; thick as a liquid, at a mean pressure that hardly lets it give way.
HIGH, NORMAL = 1e9, 273.15 / (300.0 * 101325.0)
NARROW = dict(inner_radius=0.039, clearance=1e-5, coning=2e-3, viscosity=0.5e-3, inner_pressure=HIGH,
              outer_pressure=HIGH + 5e5)  # fmt: skip


def both(cells=(12, 48), **changes):
    """A `Film` of that gas, and of a liquid."""
    film = gas_film(cells, **(NARROW | changes))
    return film, replace(film, gas=None, temperature=None, gas_reynolds=None, model="radial")


# --- small compressibility ----------------------------------------------------------------------------


@pytest.mark.core
def test_a_gas_that_hardly_gives_way_is_the_radial_film():
    """Force above the inner pressure, moments, volume flow and torque, of a gap that moves."""
    film, liquid = both()
    slots = dict(gx=8e-5, gy=-6e-5, dz_rate=3e-4, gx_rate=0.05, gy_rate=0.02)
    s, exact = (gap_state(film, SPEED, **slots) for _ in range(2))
    steady(gas.parameters(film, film.clearance), s)
    radial.flow(radial.parameters(liquid, film.clearance, 1e-12), exact)
    for state in (s, exact):
        state[geometry.FORCE] -= HIGH * np.pi * (film.outer_radius**2 - film.inner_radius**2)
    s[[geometry.FLOW_INNER, geometry.FLOW_OUTER]] /= NORMAL * HIGH
    # Measured up to 2.6e-4.
    assert s[PARTS] == pytest.approx(exact[PARTS], rel=8e-4)


@pytest.mark.parametrize("omega", [0.0, 500.0, 3000.0])
def test_a_gas_that_hardly_gives_way_has_the_radial_films_stiffness_and_damping(omega):
    film, liquid = both()
    found = Interface(fms(film=film), 1e-12).slopes(omega=omega)[:2]
    exact = Interface(fms(film=liquid), 1e-12).slopes()[:2]
    # Measured up to 6e-5.
    for mine, other in zip(found, exact, strict=True):
        for place in ((0, 0), (1, 1), (2, 2)):
            assert mine[place] == pytest.approx(other[place], rel=2e-4)
    # The wedge: half the shaft's speed times the damping.
    assert found[0][1, 2] == pytest.approx(exact[0][1, 2], rel=2e-4)
    assert found[0][1, 2] == pytest.approx(0.5 * SPEED * found[1][1, 1], rel=2e-4)


def test_motion_in_a_gas_that_hardly_gives_way_is_that_in_the_radial_film():
    film, liquid = both((12, 24))
    exact = run(fms(film=liquid), 1.0, 1e-8)
    found = run(fms(film=film), 1.0, 1e-9, "ida")
    assert found.outcome.status == "ok"
    apart = np.max(np.abs(found.scaled() - exact.scaled())) / np.max(np.abs(exact.scaled()))
    # Measured 7e-5.
    assert apart < 3e-4


# --- in time ------------------------------------------------------------------------------------------


SOFT = dict(clearance=5e-6, coning=5e-4, inner_pressure=1e5, outer_pressure=6e5)


class Stored(Sink):
    """Keeps the film's unknowns too."""

    def __init__(self, *given):
        super().__init__(*given)
        self.x = []

    def take(self, segment, taus, q, q_rate, x=None):
        super().take(segment, taus, q, q_rate, x)
        self.x.append(x)


def test_what_is_stored_over_a_run_is_what_has_flown_in():
    scene = fms(film=gas_film((8, 24), **SOFT))
    turn = 2 * np.pi / SPEED
    ready, sink = prepared(scene, turn, 1e-8), Stored(turn, turn / 512)
    outcome = solve(ready, "ida", 1e-8, sink)
    assert outcome.status == "ok" and outcome.energy_residual < 1e-6
    x = np.concatenate(sink.x)
    r, _ = gas.grid(ready.model.f)
    edges = np.concatenate([r[:1], 0.5 * (r[1:-2] + r[2:-1]), r[-1:]])
    stored = (x.reshape(-1, 24, 8) @ (0.5 * np.diff(edges**2))).sum(axis=1) * 2 * np.pi / 24 * NORMAL
    inner, outer = (np.concatenate([part[f"leakage_{side}"] for part in sink.parts]) for side in ("inner", "outer"))
    # Leakage counts from the outer, high side inwards.
    flown = simpson(outer - inner, x=np.concatenate(sink.times))
    through = simpson(np.abs(inner), x=np.concatenate(sink.times))
    assert np.ptp(stored) > 1e-4 * through
    assert abs(stored[-1] - stored[0] - flown) < 1e-6 * through


def test_rings_follow_the_linear_response_of_a_gas_that_stores():
    """A shaft that whirls against its turn, in a film whose stiffness and damping hang on the frequency."""
    small = 1e-3 * TILT_SCALE
    film = gas_film((8, 16), **SOFT)
    scene = replace(fms(film=film, own=0.0, runout=0.0), shaft=Shaft(SPEED, whirl=[Whirl(ratio=-2.0, angle=small)]))
    found = run(scene, 12, 1e-9, "ida")
    linear = found.model.linear_scene()
    (h,) = found.model.segment().harmonics()
    tilt, t = (found["relative_tilt_x"] + 1j * found["relative_tilt_y"])[-65:-1], found.times[-65:-1]
    g = linear.relative(h, linear.response(h))
    expected = (g[1] + 1j * g[2]) / 2
    assert abs(np.mean(tilt * np.exp(-1j * h.frequency * t)) - expected) < 1e-4 * abs(expected)


def test_cells_converge_in_time():
    fine = run(fms(film=gas_film((24, 64), **SOFT)), 1.0, 1e-8, "ida")
    errors = []
    for cells in ((6, 16), (12, 32)):
        found = run(fms(film=gas_film(cells, **SOFT)), 1.0, 1e-8, "ida")
        errors.append(np.max(np.abs(found.scaled() - fine.scaled())) / np.max(np.abs(fine.scaled())))
    # Measured 1.3e-2 and 1.4e-3.
    assert errors[1] < 4e-3 and errors[1] < 0.3 * errors[0], errors


def test_the_residual_form_is_chosen():
    scene = fms(film=gas_film((6, 12), **SOFT))
    ready = started(scene, 0.01)
    assert choose_method(ready)[0] == "ida" and ready.model.interface.film is gas.FILM
    with pytest.raises(SceneError):
        check_method(ready.model, "adams")
    given = started(
        replace(scene, film=replace(scene.film, model="auto")), 0.01, model_class=partial(Model, film=gas.FILM)
    )
    assert given.model.interface.film is gas.FILM


@pytest.mark.parametrize("tilt", [0.2, 0.6])
@pytest.mark.parametrize("cells", [(8, 24), (12, 48)])
def test_the_error_of_the_cells_is_told_by_half_of_them(cells, tilt):
    """Neither hidden, nor more than a few times as large, against 48 x 144 cells."""

    def loads(cells):
        scene = fms(film=gas_film(cells, coning=3e-4), runout=tilt * 5e-6 / 0.04, own=0.0)
        ready = prepared(scene, 1e-3, 1e-6)
        model, s = ready.model, ready.segment(0).gap_state(0.0, ready.y0)
        gas.flow(model.f, s, model.interface.steady(model.f, s))
        return ready, s

    ready, s = loads(cells)
    _, exact = loads((48, 144))
    area = np.pi * (0.040**2 - 0.032**2)
    force = ready.model.closing_force() - 1e5 * area
    off = np.abs(s - exact)
    true = max(
        off[geometry.FORCE] / force,
        np.hypot(off[geometry.MOMENT_X], off[geometry.MOMENT_Y]) / (force * 0.040),
        off[geometry.FLOW_INNER] / abs(exact[geometry.FLOW_INNER]),
    )
    assert 0.5 * true < cell_error(ready) < 10.0 * true + 1e-6


def test_cells_too_coarse_for_the_accuracy_are_said():
    scene = fms(film=gas_film((6, 16), coning=3e-4))
    ready = prepared(scene, 1e-3, 1e-6)
    found = certify(ready, "ida", 1e-8, measured=(np.array([0.0, 1e-3]), np.array([0.0, 1e-9])))
    assert found.model > 1e-5 and "more film.gas_reynolds.cells, some" in found.said and found.solved
