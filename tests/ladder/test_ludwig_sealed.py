"""Ludwig & Allen's ring under a sealed pressure: closed form, actual film, the ring let go, seats still and turning."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_ludwig_nodding import ARM, TILT, nodding
from test_ludwig_nodding import RING as NODDING
from test_ludwig_quasi_static import linearised
from test_ludwig_released import RING, ready_scene

from sealdyn.analysis import quasi_static
from sealdyn.closed_form import ludwig_allen as la
from sealdyn.closed_form import sealed_wedge
from sealdyn.dynamics.interface import opening_law
from sealdyn.scene.scene import SceneError
from sealdyn.studies.sealing_number import released as free

NARROW = replace(RING, face_width=0.5e-3)
# Over F_s / (R dR): outside, inside, both above the cavity's, far above it.
EDGES = {"outside": (0.0, 0.1), "inside": (1.0, 0.0), "both": (0.1, 0.3), "strong": (0.0, 10.0)}


def under(ring, inner, outer):
    per = ring.spring_force / (ring.mean_radius * ring.face_width)
    return replace(ring, inner_pressure=inner * per, outer_pressure=outer * per)


def sealed(scene, ring, inner, outer, cavity=0.0):
    """The scene under these pressures and 70 % balance, its springs such that the load on the film stays `ring`'s."""
    ring = under(ring, inner, outer)
    pressures = ring.inner_pressure + cavity, ring.outer_pressure + cavity
    film = replace(
        scene.film, inner_pressure=pressures[0], outer_pressure=pressures[1], cavitation_pressure=cavity or 0.0
    )
    # Linear over the width: the mean at the mean radius, and the slope's moment of inertia, width^2/12.
    width, area = ring.face_width, 2 * math.pi * ring.mean_radius * ring.face_width
    opening = area * (0.5 * sum(pressures) + (pressures[1] - pressures[0]) * width / (12 * ring.mean_radius))
    closing = area * (0.7 * max(pressures) + 0.3 * min(pressures))
    spring = ring.spring_force + opening - closing
    return replace(scene, film=film, closing=replace(scene.closing, balance_ratio=0.7, spring_force=spring))


@pytest.mark.parametrize("name", EDGES)
def test_balance_on_the_actual_film(name):
    """Force to rounding; sine moment to the arm that a face of finite width has longer, dR^2/(20 R^2) = 3.5e-6."""
    ring = under(NARROW, *EDGES[name])
    films = la.equilibrium(2.5, ring.group, ring.edges)
    force, moment = quasi_static.residuals(2.5, quasi_static.Wedge(ring), films)
    assert abs(force) < 1e-9 and moment == pytest.approx((ring.face_width / ring.mean_radius) ** 2 / 20, rel=0.2)
    assert quasi_static.static_root(2.5, films, ring) == pytest.approx(films, rel=3e-5)
    expected = la.eigenvalues(2.5, 0.5 * ring.shaft_speed, ring.edges)
    assert linearised(films, ring) == pytest.approx(expected, rel=1e-5)


def test_balance_in_time():
    """From 2 % below: a start that much above hangs where the pressure is strong."""
    ring = under(NARROW, *EDGES["outside"])
    films = np.array(la.equilibrium(2.5, ring.group, ring.edges))
    run = quasi_static.quasi_static(2.5, 0.98 * films, ring, duration=0.3)
    assert run.status == "settled", run.message
    assert np.array(run.films) == pytest.approx(films, rel=3e-5)
    strong = under(NARROW, *EDGES["strong"])
    films = np.array(la.equilibrium(2.5, strong.group, strong.edges))
    assert quasi_static.quasi_static(2.5, 1.02 * films, strong).status == "hang-up"


@pytest.mark.core
@pytest.mark.parametrize("cavity", [0.0, 1e5])
def test_a_scene_gives_back_its_load(cavity):
    """Balance ratio, spring and pressures: what is left beyond the opening of flat faces; absolute pressures do not
    matter."""
    ring = under(NARROW, 0.1, 0.3)
    found = free.ring_of(sealed(ready_scene(NARROW), NARROW, 0.1, 0.3, cavity))
    assert vars(found) == pytest.approx(vars(ring), rel=1e-9)
    scene = sealed(ready_scene(NARROW), NARROW, 0.1, 0.3)
    with pytest.raises(SceneError) as refused:
        free.ring_of(replace(scene, closing=replace(scene.closing, balance_ratio=0.1, spring_force=1.0)))
    assert refused.value.key == "closing.spring_force"
    for change, key in (({"cavitation_pressure": None}, "cavitation_pressure"), ({"inertia": True}, "inertia")):
        with pytest.raises(SceneError) as refused:
            free.ring_of(replace(scene, film=replace(scene.film, **change)))
        assert refused.value.key == f"film.{key}"


@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
def test_pressures_open_flat_faces_by_what_the_film_has_at_rest(geometry):
    scene = sealed(ready_scene(NARROW), NARROW, 0.1, 0.4)
    scene = replace(scene, film=replace(scene.film, geometry=geometry, inner_radius=0.04))
    pressures = scene.film.inner_pressure, scene.film.outer_pressure
    closing = scene.closing.spring_force + math.pi * (0.06025**2 - 0.04**2) * (0.7 * pressures[1] + 0.3 * pressures[0])
    ring = free.ring_of(scene)
    assert closing - ring.spring_force == pytest.approx(opening_law(scene)(1e-6, *pressures), rel=1e-9)


@pytest.mark.parametrize("edges, q", [((0.0, 0.05), 1.34), ((0.05, 0.0), 1.34), ((0.03, 0.03), 1.33)])
def test_a_free_ring_keeps_the_film_foreseen(edges, q):
    """Between 4/pi/1.0 and 4/pi/0.8926 at p R dR/F_s = 0.05.  Measured: mean film 6e-6, amplitude 1e-5 off."""
    scene = free.with_force_ratio(sealed(ready_scene(NARROW), NARROW, *edges), q)
    mean, amplitude, _ = free.film_on(scene)
    told = free.released(free.started(scene, (1.001 * mean, 1.001 * amplitude)), 20, last=1, accuracy=1e-5)
    assert told.status == "film", told.message
    assert told.mean_film[0] == pytest.approx(mean, rel=1e-4)
    assert told.amplitude[0] == pytest.approx(amplitude, rel=2.5e-4)
    assert told.energy_residual < 1e-4


def test_strong_pressure_leaves_a_free_ring_no_film():
    """The moment of the film falls from 2.42 R F_s with its tilt: one that is let go of a balance at 1.5 straightens,
    one that is asked for more than 2.42 hangs."""
    for q, fate, turns in ((0.85, "straightened", 20), (0.5, "hang-up", 6)):
        scene = free.with_force_ratio(sealed(ready_scene(NARROW), NARROW, 0.0, 1.0), q)
        with pytest.raises(ValueError, match=fate[:7]):
            free.film_on(scene)
        ring = free.ring_of(scene)
        mean = math.sqrt(ring.group * sealed_wedge.balance(0.6, ring.edges)[0])
        told = free.released(free.started(scene, (mean, 0.6 * mean)), turns, last=1)
        assert told.status == fate, told.message


@pytest.mark.parametrize("start, status", [(1.0005, "film"), (0.999, "straightened")])
def test_a_support_holds_the_balance_of_strong_pressure_from_above_only(start, status):
    """Tilt spring as the closed form needs, p R dR/F_s = 0.3: the balance at q = 2 repels; above it there is a film
    where the ring's own tilt is less for h1/R, measured h0 = 25.05 um, 1e-5 off what is foreseen."""
    scene = sealed(ready_scene(NARROW), NARROW, 0.0, 0.3)
    ring = free.ring_of(scene)
    scene = free.with_force_ratio(scene, 2.0, float(la.closed_form_guide(2.0, ring.edges)))
    films = la.equilibrium(2.0, ring.group, ring.edges)
    told = free.released(free.started(scene, (start * films[0], start * films[1])), 40, last=1, accuracy=1e-4)
    assert told.status == status, told.message
    if status == "film":
        assert told.mean_film[0] == pytest.approx(free.film_on(scene)[0], rel=1e-4)


@pytest.mark.parametrize(
    "q, share, edges", [(1.34, 1e-3, (0.0, 0.05)), pytest.param(2.5, 0.82, (0.04, 0.0), marks=pytest.mark.slow)]
)
def test_a_ring_that_nods(q, share, edges):
    """The seat turns: friction alone, and friction with inertia."""
    scene = sealed(nodding(q, share), NODDING, *edges)
    assert free.force_ratio_of(scene) == pytest.approx(q, rel=1e-9)
    mean, amplitude, tilt = free.film_on(scene)
    ring = free.ring_of(scene)
    moment = math.hypot(4 / (math.pi * q), share * abs(tilt) / TILT)
    assert math.hypot(*sealed_wedge.balance(amplitude / mean, ring.edges)[1:]) == pytest.approx(moment, rel=1e-9)
    assert ring.mean_radius * ring.spring_force == pytest.approx(ARM, rel=1e-9)
    told = free.released(free.started(scene, (1.001 * mean, 1.001 * amplitude)), 16, last=1, accuracy=1e-5)
    assert told.status == "film", told.message
    assert told.mean_film[0] == pytest.approx(mean, rel=1e-4)
    assert told.amplitude[0] == pytest.approx(amplitude, rel=2.5e-4)
