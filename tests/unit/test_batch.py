"""Many instants at once are what one at a time are."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import fmr, fms, fmsr, housing_vibration, prepared, runup

from sealdyn.dynamics.signals import TALLIED, signals
from sealdyn.faces.film_thickness import h_min
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import SecondarySeal


def sealed():
    scene = fms()
    held = replace(scene.stator, secondary_seal=SecondarySeal(radius=0.03, line_friction=50.0))
    return replace(scene, stator=held)


SCENES = {
    "fms": fms(), "fmr": fmr("linear"), "fmsr": fmsr(), "shaken": housing_vibration(),
    "contact": replace(fms(), contact=Contact(roughness=2e-6, compressive_strength=3e8)), "sealed": sealed(),
}  # fmt: skip


@pytest.fixture(params=SCENES)
def drawn(request):
    """A segment, times in it and unknowns of three tenths of a scale."""
    segment = prepared(SCENES[request.param], 0.05, 1e-6).segment(0)
    draw = np.random.default_rng(3)
    times = np.sort(draw.uniform(0, 0.05, 40))
    return segment, times, 0.3 * segment.scales * draw.uniform(-1, 1, (40, segment.size))


@pytest.mark.core
def test_derivatives_are_the_right_hand_side(drawn):
    segment, taus, ys = drawn
    found = segment.derivatives(taus, ys)
    for tau, y, here in zip(taus, ys, found, strict=True):
        one = np.zeros(segment.size)
        segment.rhs(tau, y, one)
        assert np.array_equal(one, here)


def test_signals_are_those_of_each_instant(drawn):
    segment, taus, ys = drawn
    q, rate = segment.motion(ys, np.zeros_like(ys))
    together, face = signals(segment, taus, q, rate), segment.model.face
    for k in (0, 17, 39):
        alone = signals(segment, taus[k : k + 1], q[k : k + 1], rate[k : k + 1])
        assert all(together[name][k] == alone[name][0] for name in alone)
        s = segment.gap_state(taus[k], segment.model.vector(q[k], rate[k]))
        assert together["h_min"][k] == h_min(face, s)[0] and together["axial_gap_change"][k] == s[0]
    assert signals(segment, taus[:0], q[:0], rate[:0])["h_min"].shape == (0,)
    tallied = signals(segment, taus, q, rate, tallied=True)
    assert set(tallied) == {"time", *TALLIED} & set(together) and len(tallied) < len(together)
    assert all(np.array_equal(values, together[name]) for name, values in tallied.items())


def test_the_thinnest_film_at_the_start():
    ready = prepared(SCENES["fmsr"], 0.05, 1e-6, "steady")
    segment = ready.segment(0)
    q, rate = segment.motion(ready.y0[None, :], None)
    assert ready.start_film() == signals(segment, np.zeros(1), q, rate)["h_min"][0] < ready.model.clearance


def test_the_same_segment_is_not_made_twice_but_where_rings_stick():
    free, sticking = prepared(runup(), 0.05, 1e-6), prepared(SCENES["sealed"], 0.05, 1e-6)
    first, last = free.segment(0), free.segment(-1)
    assert (first.index, last.index, last.last) == (0, len(free.intervals) - 1, True) and last.index > 0
    assert free.segment(-1) is last and np.array_equal(free.segment(0).p, first.p)
    for held in (True, False):
        assert sticking.segment(0, {0: held}).stuck == {0: held}
