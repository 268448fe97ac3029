"""The relative misalignment over one turn of a run: the triangle of both rings' tilts, and a vector that stands still
plus one that turns with the shaft (Green 1989)."""

import numpy as np
import pytest
from oracles import tilts_in_turning_axes
from scenes import INERTIA, MISALIGNMENT, SPEED, SUPPORT, fmr, fms, fmsr, run

from sealdyn.closed_form import film_coefficients

FILM = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
RING = (INERTIA, INERTIA / 0.5, *SUPPORT.tilt())
# Arrangement: scene, the rings that float.
SEALS = {"fmr": (fmr, RING, None), "fms": (fms, None, RING), "fmsr": (fmsr, RING, RING)}
ACCURACY = 1e-8


@pytest.fixture(scope="module", params=SEALS)
def turn(request):
    """A settled turn of the seal, tilts of stator and rotor over it, and the relative tilts (complex) that stand still
    and that turn."""
    scene, rotor, stator = SEALS[request.param]
    found = run(scene("linear"), turns=1, accuracy=ACCURACY, start="steady")
    parts = []
    for frame, own in ((0.0, "own_stator"), (SPEED, "own_rotor")):
        x, y = tilts_in_turning_axes(
            frame, SPEED, FILM.tilt_stiffness, FILM.tilt_damping, rotor, stator, **{own: MISALIGNMENT}
        )
        parts.append(complex(x, y))
    tilts = [
        np.full(len(found.times), MISALIGNMENT, dtype=complex) if stator is None else found.tilt("stator"),
        MISALIGNMENT * np.exp(1j * SPEED * found.times) if rotor is None else found.tilt("rotor"),
    ]
    return found, tilts, *parts


def test_the_vector_itself(turn):
    found, _, standing, turning = turn
    tilt = found["relative_tilt_x"] + 1j * found["relative_tilt_y"]
    assert np.max(np.abs(tilt - standing - turning * np.exp(1j * SPEED * found.times))) < 1e-6 * MISALIGNMENT


@pytest.mark.core
def test_triangle_of_nutations(turn):
    """|g|^2 = |s|^2 + |r|^2 - 2 |s| |r| cos(psi_r - psi_s), s and r the tilts of the rings."""
    found, (stator, rotor) = turn[:2]
    square = abs(stator) ** 2 + abs(rotor) ** 2
    square -= 2 * abs(stator) * abs(rotor) * np.cos(np.angle(rotor) - np.angle(stator))
    assert np.max(np.abs(np.sqrt(square) - found["relative_misalignment"])) < 1e-7 * MISALIGNMENT
    # All change over the turn, but for the tilt of a ring that is held.
    assert np.ptp(found["relative_misalignment"]) > 0.01 * MISALIGNMENT
    assert max(np.ptp(abs(stator)), np.ptp(abs(rotor))) > 0.01 * MISALIGNMENT


def test_each_ring_stands_in_part_and_turns_in_part(turn):
    """Absolute tilts: in either ring what answers the stator stands still, what answers the rotor turns."""
    found, tilts, standing, turning = turn
    fast, parts = np.exp(1j * SPEED * found.times), []
    for tilt in tilts:
        still, round_ = np.mean(tilt[:-1]), np.mean((tilt / fast)[:-1])
        assert np.max(np.abs(tilt - still - round_ * fast)) < 1e-6 * MISALIGNMENT
        parts.append([still, round_])
    assert np.subtract(*parts) == pytest.approx([standing, turning], abs=1e-6 * MISALIGNMENT)
