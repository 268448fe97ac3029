"""Ludwig & Allen's ring let go: what its film must be, by integrals over the circle and in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import fsolve

from sealdyn.analysis import quasi_static
from sealdyn.closed_form import ludwig_allen as la
from sealdyn.dynamics.model import Model
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Rotor, SecondarySeal, Stator, Support
from sealdyn.scene.scene import Closing, Scene, SceneError
from sealdyn.studies.sealing_number import released as free
from sealdyn.studies.sealing_number.released import film_on, released, ring_of, started, with_force_ratio

RING = quasi_static.Ring(viscosity=2e-3, shaft_speed=300.0)


def ready_scene(ring: quasi_static.Ring, misalignment=2.5e-3, mass=0.5, inertia_ratio=0.5,
                support: Support | None = None, roughness=5e-8) -> Scene:  # fmt: skip
    """The released ring as a scene of its own (SI): misaligned seat, ring of a given transverse over polar inertia,
    free to tilt if no `support` is given, asperities to land on; friction of F_s/F_d = 2."""
    inertia = 0.5 * mass * ring.mean_radius**2
    rotor = Rotor(
        mass=mass,
        transverse_inertia=inertia,
        polar_inertia=inertia / inertia_ratio,
        support=support or Support(axial_stiffness=0.0, tilt_stiffness=0.0),
        secondary_seal=SecondarySeal(radius=ring.mean_radius, line_friction=0.0),
    )
    bare = Scene(
        shaft=Shaft(speed=ring.shaft_speed),
        film=replace(ring.film(), clearance=None),
        rotor=rotor,
        stator=Stator(misalignment=misalignment),
        closing=Closing(balance_ratio=1.0, spring_force=ring.spring_force),
        contact=Contact(roughness=roughness, compressive_strength=3e8),
    )
    return with_force_ratio(bare, 2.0)


SCENE = ready_scene(RING)


def ran(q, guide=None, start="closed form", factor=1.0, scene=SCENE, turns=60, **how):
    made = started(with_force_ratio(scene, q, guide), start, factor)
    return made, released(made, turns, **how)


def integrals(e):
    """Force over mu U dR^3 / h0^2, sine and cosine moment over that times R, of the wedge: integrals over its half."""

    def over(arm):
        return quad(lambda t: 0.5 * e * math.sin(t) / (1 + e * math.cos(t)) ** 3 * arm(t), 0, math.pi, epsrel=1e-12)[0]

    return over(lambda t: 1.0), over(math.sin), over(math.cos)


@pytest.mark.parametrize("q,guide", [(1.3, 0.0), (1.6, 0.0), (2.0, 0.5), (3.0, 0.8), (20.0, 0.9)])
def test_film_balances_force_and_both_moments(q, guide):
    """Friction 4 R F_d / pi and support stand at right angles; e found here by a root finder on the integrals."""
    wanted = math.hypot(4 / (math.pi * q), guide)

    def short(e):
        load, sine, cosine = integrals(float(e[0]))
        return math.hypot(sine, cosine) / load - wanted

    mean, amplitude = la.film(q, guide, RING.group)
    e = float(fsolve(short, [0.9 * amplitude / mean], xtol=1e-12)[0])
    assert amplitude / mean == pytest.approx(e, rel=1e-7)
    assert mean**2 == pytest.approx(integrals(e)[0] * RING.group, rel=1e-7)


@pytest.mark.core
def test_the_range_of_films():
    """Free: from 4/pi, where the load acts at the arm R, to 16/pi^2, just where Ludwig & Allen's film begins."""
    least, most = la.film_range()
    assert least == pytest.approx(4 / math.pi, rel=1e-12) and most == pytest.approx(la.LEAST_FORCE_RATIO, rel=1e-12)
    with pytest.raises(ValueError, match="hang-up"):
        la.film(0.999 * least, 0.0, RING.group)
    with pytest.raises(ValueError, match="straightens"):
        la.film(1.001 * most, 0.0, RING.group)
    assert la.film_range(0.8)[1] == math.inf and la.film_range(1.0)[0] == math.inf


@pytest.mark.parametrize("q", [1.7, 2.0, 5.0, 20.0])
def test_a_support_that_carries_the_cosine_moment_gives_the_closed_form(q):
    films = la.equilibrium(q, RING.group)
    load, _, cosine = integrals(films[1] / films[0])
    guide = la.closed_form_guide(q)
    assert guide == pytest.approx(-cosine / load, rel=1e-9)
    assert la.film(q, guide, RING.group) == pytest.approx(films, rel=1e-9)
    assert film_on(with_force_ratio(SCENE, q, guide))[:2] == pytest.approx(films, rel=1e-9)


def test_a_scene_gives_back_its_numbers():
    scene = with_force_ratio(SCENE, 3.3)
    assert free.force_ratio_of(scene) == pytest.approx(3.3, rel=1e-12)
    assert vars(ring_of(scene)) == pytest.approx(vars(RING), rel=1e-9)
    with pytest.raises(SceneError, match=r"film\.cavitation_pressure"):
        ring_of(replace(scene, film=replace(scene.film, cavitation_pressure=None)))
    with pytest.raises(SceneError, match="more than the tilt"):
        with_force_ratio(ready_scene(RING, misalignment=1e-3), 20.0, la.closed_form_guide(20.0))


# --- in time ----------------------------------------------------------------------------------------------


def test_it_leaves_the_closed_form_and_straightens():
    """From the very film of Ludwig & Allen at q = 2 (0.717 um): parallel to the seat and on its asperities.  Measured:
    h0 0.136 um, 21 % of the spring on asperities; a parallel film carries 16/(pi^2 q) = 81 % with all the friction."""
    _, told = ran(2.0)
    assert told.status == "straightened", told.message
    assert told.h0[0] == pytest.approx(la.equilibrium(2.0, RING.group)[0], rel=1e-9)
    assert told.share < 0.05 and told.mean_film[0] < 0.25 * told.h0[0]
    assert told.contact_share == pytest.approx(1 - la.LEAST_FORCE_RATIO / 2.0, abs=0.04)
    assert told.energy_residual < 1e-4


@pytest.mark.parametrize("factor", [0.8, 1.3])
def test_held_by_its_support_it_returns_to_the_closed_form(factor):
    """A tilt spring with R F_s h1/h0 at the film: it attracts, from both sides."""
    _, told = ran(3.0, la.closed_form_guide(3.0), factor=factor)
    assert told.status == "film", told.message
    wanted = la.equilibrium(3.0, RING.group)
    assert (told.mean_film[0], told.amplitude[0]) == pytest.approx(wanted, rel=2e-3)
    # Thinnest at the high point of the seat, as they assume.
    assert abs(told.direction) < 2e-3


def test_it_hangs_up_where_the_wedge_has_no_arm():
    """F_s/F_d = 1.2 < 4/pi: from a film that carries the spring it opens until its secondary seal holds it."""
    _, told = ran(1.2)
    assert told.status == "hang-up"
    assert told.mean_film[0] > 0.8 * RING.mean_radius * 2.5e-3


@pytest.mark.parametrize("q,status", [(1.9, "hang-up"), (2.5, "straightened")])
def test_an_open_ring_closes_only_if_the_spring_overcomes_the_axial_friction(q, status):
    _, told = ran(q, start="open")
    assert told.status == status, told.message


@pytest.mark.parametrize("tilt_radius", ["mean", "local"])
def test_an_open_ring_is_open_all_over_a_wide_face(tilt_radius):
    wide = replace(RING, face_width=10e-3)
    scene = replace(SCENE, film=replace(wide.film(), clearance=None, tilt_radius=tilt_radius))
    made = started(with_force_ratio(scene, 2.0), "open")
    gap = Model(made, 1e-3).clearance - made.initial.rotor.z
    reach = wide.mean_radius if tilt_radius == "mean" else scene.film.outer_radius
    assert 0.0 < gap - reach * made.stator.misalignment < 0.05 * gap


@pytest.mark.slow
@pytest.mark.parametrize("q", [1.3, 1.45, 1.55])
@pytest.mark.parametrize("factor", [0.7, 1.5])
def test_a_free_ring_finds_its_own_film_where_the_closed_form_has_none(q, factor):
    made, told = ran(q, factor=factor, turns=120)
    assert told.status == "film", told.message
    mean, amplitude, tilt = film_on(made)
    assert (told.mean_film[0], told.amplitude[0]) == pytest.approx((mean, amplitude), rel=3e-3)
    g = made.stator.misalignment - tilt
    assert told.direction == pytest.approx(np.angle(g), abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("inertia_ratio", [0.5, 2.0])
@pytest.mark.parametrize("mass", [0.05, 50.0])
def test_inertia_does_not_change_what_becomes_of_it(mass, inertia_ratio):
    """A thousandfold mass, disk or pipe: the film's damping rules."""
    scene = ready_scene(RING, mass=mass, inertia_ratio=inertia_ratio)
    assert ran(2.0, scene=scene)[1].status == "straightened"
    for q, guide in ((1.45, 0.0), (3.0, la.closed_form_guide(3.0))):
        made, told = ran(q, guide, factor=1.1, scene=scene, turns=100)
        assert told.status == "film", told.message
        assert told.mean_film[0] == pytest.approx(film_on(made)[0], rel=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [100.0, 3000.0])
def test_speed_scales_the_film_and_nothing_else(speed):
    """mu U in the group: film as the root of speed, same spring."""
    ring = replace(RING, shaft_speed=speed, group=RING.group * speed / RING.shaft_speed)
    assert ring.spring_force == pytest.approx(RING.spring_force, rel=1e-12)
    scene = ready_scene(ring, misalignment=5e-3)
    _, told = ran(3.0, la.closed_form_guide(3.0), factor=1.2, scene=scene)
    assert told.status == "film", told.message
    was = la.equilibrium(3.0, RING.group)[0]
    assert told.mean_film[0] == pytest.approx(was * math.sqrt(speed / RING.shaft_speed), rel=3e-3)


@pytest.mark.slow
def test_two_methods_agree_and_the_energy_is_accounted_for():
    """Two methods, ten times the accuracy apart, on the way to the film."""
    made = started(with_force_ratio(SCENE, 2.0, la.closed_form_guide(2.0)), factor=1.3)
    one, other = (released(made, 10, accuracy=a, method=m) for a, m in ((1e-3, "bdf"), (1e-4, "ida")))
    assert np.max(np.abs(one.h0 - other.h0)) < 2e-3 * 1.3 * la.equilibrium(2.0, RING.group)[0]
    assert max(one.energy_residual, other.energy_residual) < 1e-4


@pytest.mark.slow
def test_axial_springs_press_it_closer():
    """The support's axial spring adds to F_s by its travel: 2e4 N/m over 5 um are 0.1 % of the spring, and at
    q = 1.3, close to the end of the films, 5 % of h0."""
    soft = ready_scene(RING, support=Support(axial_stiffness=2e4, radius=0.06))
    unguided = film_on(with_force_ratio(SCENE, 1.3))[0]
    made, told = ran(1.3, scene=soft)
    assert told.mean_film[0] == pytest.approx(film_on(made)[0], rel=2e-3)
    assert told.mean_film[0] < 0.97 * unguided
