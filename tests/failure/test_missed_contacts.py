"""No contact is missed: dips of an imposed gap and of a gap made of states, for every method at every tolerance."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import CLEARANCE, NOTHING, SPEED, SUPPORT, film, fms, ring, run

from sealdyn.scene.forces import Contact, contact_thresholds
from sealdyn.scene.rings import AxialRunout, Rotor, Stator
from sealdyn.scene.scene import Initial, RingStart

EMPTY = film("linear", coefficients=NOTHING)
# Faces so soft that touching changes nothing: what is seen is the search alone.
SOFT = Contact(roughness=1e-7, compressive_strength=1e-6)
TOUCH = contact_thresholds(SOFT)[1]
TURN = 2 * math.pi / SPEED


def contacts(found):
    events = []
    found.ready.contacts.tell(events.extend, end=(found.outcome.tau, found.outcome.y))
    return events


# Adams takes 7 steps for all 300 turns at 1e-4 (the stator does not move): a root search sees nothing at all.
# Cost of the search (measured): 0.5 us for each look at the gap, some 20 looks a turn.
@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853", "radau"])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("degrees", [4.0, 0.4])
def test_an_imposed_dip_is_seen_every_turn(method, accuracy, degrees):
    """Below touch for four or 0.4 degrees of each of 300 turns, 6 nm and 0.06 nm deep."""
    half = math.radians(degrees) / 2
    amplitude = (CLEARANCE - TOUCH) / math.cos(half)
    scene = fms(film=EMPTY, stator=Stator(**ring()), contact=SOFT,
                rotor=Rotor(axial_runout=[AxialRunout(order=1, amplitude=amplitude, phase=math.pi / 3)]))  # fmt: skip
    found = run(scene, turns=300, accuracy=accuracy, method=method, per_turn=1)
    events = contacts(found)
    assert len(events) == 300
    for n, event in enumerate(events):
        middle = (n + 5 / 6) * TURN
        assert event["deepest"] == pytest.approx(middle, abs=1e-3 * TURN)
        assert event["depth"] == pytest.approx(amplitude - (CLEARANCE - TOUCH), abs=0.5 * accuracy * CLEARANCE)
        # What lies within the gap's error is named so.
        decided = event["depth"] > found.ready.model.gap_error()
        assert event["kind"] == ("contact" if decided else "grazing")
        if not decided:
            continue
        # A dip's length goes with the root of its depth, which is known to the accuracy asked: DOP853, at the edge of
        # its stability, lets rounding grow to its tolerance (2e-6 C at 1e-4), on some processors and not on others.
        length = 2 * math.acos(1 - event["depth"] / amplitude) / SPEED
        assert event["lift_off"] - event["time"] == pytest.approx(length, rel=1e-5)
        assert middle - event["time"] == pytest.approx(half / SPEED, rel=0.05)


@pytest.mark.parametrize("method", ["adams", "bdf", "ida", "dop853", "radau"])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-7])
@pytest.mark.parametrize("errors", [3.0, 0.3, -0.3, -3.0])
def test_a_dip_of_states_is_seen_down_to_the_certified_error(method, accuracy, errors):
    """A free undamped stator bounces: each period its gap sinks below touch by so many times the certified error.  A
    deeper one is a contact, one within the error grazes and is called undecided, one clear of touch is neither."""
    depth = errors * 2 * accuracy * CLEARANCE
    amplitude = CLEARANCE - TOUCH + depth
    natural = math.sqrt(SUPPORT.axial_stiffness / 1.0)
    scene = fms(film=EMPTY, own=0.0, runout=0.0, contact=SOFT, initial=Initial(stator=RingStart(z=amplitude)),
                stator=Stator(**ring(support=replace(SUPPORT, axial_damping=0.0))))  # fmt: skip
    found = run(scene, duration=20 * 2 * math.pi / natural, accuracy=accuracy, method=method, per_turn=4)
    events = contacts(found)
    seen = {event["kind"] for event in events}
    if errors == -3.0:
        assert not events
        return
    assert len(events) == 20
    times = (np.arange(20) + 0.5) * 2 * math.pi / natural
    assert [event["deepest"] for event in events] == pytest.approx(times, abs=0.05 / natural)
    assert seen == ({"contact"} if errors == 3.0 else {"grazing"})
    assert all(abs(event["depth"] - depth) < 2 * accuracy * CLEARANCE for event in events)


@pytest.mark.core
def test_impulse_and_angle_of_a_contact():
    """A stiff pair of faces: the impulse of each contact is the integral of the contact force over it."""
    hard = Contact(roughness=1e-7, compressive_strength=3e8)
    scene = fms(film=EMPTY, own=0.0, contact=hard, stator=Stator(**ring()),
                rotor=Rotor(runout=100e-6, axial_runout=[AxialRunout(order=1, amplitude=6.6e-6)]))  # fmt: skip
    found = run(scene, turns=4, accuracy=1e-7, per_turn=20_000)
    events = [event for event in contacts(found) if event["kind"] == "contact"]
    assert len(events) >= 3
    force, times = found["contact_force"], found.times
    for event in events[:3]:
        inside = (times > event["time"] - 1e-5) & (times < event["lift_off"] + 1e-5)
        assert event["impulse"] == pytest.approx(np.trapezoid(force[inside], times[inside]), rel=1e-4)
        deepest = np.argmin(np.where(inside, found["h_min"], np.inf))
        assert event["theta"] == pytest.approx(found["h_min_angle"][deepest], abs=2e-3)
        assert event["radius"] == found["h_min_radius"][deepest]
