"""Many instants at once are what one at a time are."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import fmr, fms, fmsr, housing_vibration, prepared

from sealdyn.dynamics import equations
from sealdyn.dynamics.signals import signals
from sealdyn.faces.film_thickness import h_min
from sealdyn.scene.contact import Contact
from sealdyn.scene.secondary_seal import SecondarySeal


def sealed():
    scene = fms()
    support = replace(scene.stator.support) if scene.stator.support else None
    return replace(scene, stator=replace(scene.stator, support=support,
                                         secondary_seal=SecondarySeal(radius=0.03, line_friction=50.0)))  # fmt: skip


SCENES = {
    "fms": fms(),
    "fmr": fmr("linear"),
    "fmsr": fmsr(),
    "shaken": housing_vibration(),
    "contact": replace(fms(), contact=Contact(roughness=2e-6, compressive_strength=3e8)),
    "sealed": sealed(),
}


@pytest.fixture(params=SCENES)
def drawn(request):
    """A problem, leg times and unknowns of three tenths of a scale."""
    problem = prepared(SCENES[request.param], 0.05, 1e-6)
    draw = np.random.default_rng(3)
    return problem, np.sort(draw.uniform(0, 0.05, 40)), 0.3 * problem.scales * draw.uniform(-1, 1, (40, problem.size))


def test_derivatives_are_the_right_hand_side(drawn):
    problem, taus, ys = drawn
    found = problem.derivatives(taus, ys)
    for tau, y, here in zip(taus, ys, found, strict=True):
        one = np.zeros(problem.size)
        problem.rhs(tau, y, one)
        assert np.array_equal(one, here)


def test_signals_are_those_of_each_instant(drawn):
    problem, taus, ys = drawn
    q, rate = problem.motion(ys, np.zeros_like(ys))
    together = signals(problem, taus, q, rate)
    for k in (0, 17, 39):
        alone = signals(problem, taus[k : k + 1], q[k : k + 1], rate[k : k + 1])
        assert all(together[name][k] == alone[name][0] for name in alone)
        equations.kinematics(taus[k], problem.unknowns(q[k], rate[k]), np.zeros(problem.size), problem.p, problem.w,
                            problem.s)  # fmt: skip
        low = h_min(problem.face, problem.s)
        assert together["h_min"][k] == low[0] and together["axial_gap_change"][k] == problem.s[0]
    assert signals(problem, taus[:0], q[:0], rate[:0])["h_min"].shape == (0,)


def test_the_thinnest_film_at_the_start():
    problem = prepared(SCENES["fmsr"], 0.05, 1e-6, "steady")
    q, rate = problem.motion(problem.y0[None, :], None)
    assert problem.start_film() == signals(problem, np.zeros(1), q, rate)["h_min"][0] < problem.clearance
