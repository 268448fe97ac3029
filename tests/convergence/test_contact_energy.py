"""Energy through contacts and friction: the audit closes, and the contact work is the change of its potential."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import NOTHING, SUPPORT, film, fmr, fms, fmsr, ring, run

from sealdyn.dynamics import equations
from sealdyn.faces import contact
from sealdyn.faces.geometry import CONTACT_ENERGY
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import SecondarySeal, Stator
from sealdyn.scene.scene import Initial, RingStart

HARD = Contact(roughness=1e-7, compressive_strength=3e8)
GAUSSIAN = Contact(
    roughness=1e-7, law="greenwood-williamson", asperity_density=1e11, asperity_radius=5e-6, modulus=2e10
)
SEAL = SecondarySeal(radius=0.045, line_friction=40.0)
TURN = 2 * math.pi / 1000.0
RAMP = PiecewiseLinear((0.0, 15 * TURN), (1e-5, 5.6e-3))
EMPTY = film("linear", coefficients=NOTHING)
# A ring thrown at the other face, whirling: no film, no damping, so that every joule is seen.
THROWN = Initial(stator=RingStart(z_rate=-0.008, tilt_x=30e-6, tilt_y_rate=0.1))
SCENES = {
    "rubbing all the time": (fms(own=0.0, runout=RAMP, contact=HARD), 25, "steady"),
    "touching once a turn": (fms(own=1e-3, runout=RAMP, contact=HARD), 25, "steady"),
    "flexible rotor": (fmr(own=1e-4, fixed=RAMP, contact=HARD), 25, "steady"),
    "gaussian asperities": (fms(own=0.0, runout=RAMP, contact=GAUSSIAN), 25, "steady"),
    "impacts in a vacuum": (
        fms(film=EMPTY, own=0.0, runout=0.0, contact=HARD, initial=THROWN,
            stator=Stator(**ring(support=replace(SUPPORT, axial_damping=0.0)))), 20, "rest",
    ),
    "impacts with friction": (
        fms(film=EMPTY, own=0.0, runout=0.0, contact=HARD,
            initial=Initial(stator=RingStart(z_rate=-0.017, tilt_x=30e-6, tilt_y_rate=0.1)),
            stator=Stator(**ring(), secondary_seal=SEAL)), 20, "rest",
    ),
    "rubbing with friction": (
        fms(runout=RAMP, contact=HARD, stator=Stator(**ring(misalignment=1e-4), secondary_seal=SEAL)), 25, "rest",
    ),
}  # fmt: skip


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
@pytest.mark.parametrize("name", SCENES)
def test_audit_closes_through_contact(name, accuracy):
    scene, turns, start = SCENES[name]
    found = run(scene, turns=turns, accuracy=accuracy, start=start, per_turn=64)
    assert found.outcome.status == "ok", found.outcome.message
    assert found["contact_force"].max() > 1.0
    assert found.outcome.energy_residual < 10 * accuracy


def test_contact_work_is_the_change_of_its_potential():
    """The work booked for contact over impacts is minus the change of the asperities' energy, which the audit does
    not use."""
    scene, _, _ = SCENES["impacts in a vacuum"]
    accuracy = 1e-6
    for turns in (0.31, 1.7, 6.3):
        found = run(scene, turns=turns, accuracy=accuracy)
        ready, y = found.ready, found.outcome.y
        segment, energies = ready.segment(0), []
        for state in (ready.y0, y):
            segment.rhs(found.outcome.tau, state, np.empty(segment.size))
            contact.contact_load_and_friction(ready.model.contact, ready.model.f, segment.s)
            energies.append(segment.s[CONTACT_ENERGY])
        work = y[ready.model.unknowns.works][equations.WORKS.index("contact")]
        assert work == pytest.approx(energies[0] - energies[1], abs=10 * accuracy * y[-1])


@pytest.mark.core
def test_an_undamped_ring_keeps_its_energy_through_impacts():
    """No film, no damper: kinetic, spring and asperity energy stay what they were, bounce after bounce."""
    scene, _, _ = SCENES["impacts in a vacuum"]
    found = run(scene, turns=20, accuracy=1e-7)
    rows = []
    found.ready.contacts.tell(rows.extend, end=(found.outcome.tau, found.outcome.y))
    assert sum(row["kind"] == "contact" for row in rows) > 5
    segment = found.ready.segment(0)
    start = segment.energies(np.zeros(1), found.ready.y0[None, :])[0]
    end = segment.energies(np.zeros(1), found.outcome.y[None, :])[0]
    segment.rhs(found.outcome.tau, found.outcome.y, np.empty(segment.size))
    contact.contact_load_and_friction(found.model.contact, found.model.f, segment.s)
    assert end + segment.s[CONTACT_ENERGY] == pytest.approx(start, rel=1e-5)


def test_touching_moves_both_rings_of_a_pair():
    """FMSR: what contact does to the stator it does to the rotor, opposite."""
    scene = replace(fmsr(own=2.5e-3, fixed=2.5e-3), contact=HARD)
    scene = replace(
        scene,
        rotor=replace(scene.rotor, misalignment=PiecewiseLinear(RAMP.time, (1e-5, 1.2e-2))),
        stator=replace(scene.stator, misalignment=1e-4),
    )
    found = run(scene, turns=20, accuracy=1e-5, start="steady")
    assert found.outcome.energy_residual < 1e-4
    assert found["contact_force"].max() > 1.0
