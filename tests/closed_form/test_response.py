"""Transmissibilities and contact onset, against the equation of motion in real coordinates."""

import numpy as np
import pytest
from oracles import tilts_in_turning_axes

from sealdyn import closed_form
from sealdyn.closed_form import critical_forcing

# The reference seal, a stiff and heavily damped one, a light one with a softening film.
SEALS = [
    {"speed": 1000.0, "transverse_inertia": 8e-4, "polar_inertia": 16e-4, "support_stiffness": 400.0}
    | {"support_damping": 0.24, "film_stiffness": 5790.6, "film_damping": 4.082},
    {"speed": 2700.0, "transverse_inertia": 8e-4, "polar_inertia": 8e-4 / 3, "support_stiffness": 2500.0}
    | {"support_damping": 1.3, "film_stiffness": 900.0, "film_damping": 2.0},
    {"speed": 350.0, "transverse_inertia": 2e-3, "polar_inertia": 1e-3, "support_stiffness": 700.0}
    | {"support_damping": 0.9, "film_stiffness": -150.0, "film_damping": 0.7},
]


def answers(seal):
    """All four transmissibilities, of a tilt of 1 along x."""
    ring = [seal[name] for name in ("transverse_inertia", "polar_inertia", "support_stiffness", "support_damping")]
    w, film = seal["speed"], (seal["film_stiffness"], seal["film_damping"])

    def relative(flexible, tilted):
        rings = (ring, None) if flexible == "rotor" else (None, ring)
        frame = w if tilted == "rotor" else 0.0
        return tilts_in_turning_axes(frame, w, *film, *rings, **{f"own_{tilted}": 1.0})

    tilts = {
        "fmr_static": relative("rotor", "stator"), "fmr_dynamic": relative("rotor", "rotor"),
        "fms_static": relative("stator", "stator"), "fms_dynamic": relative("stator", "rotor"),
    }  # fmt: skip
    return {name: np.linalg.norm(tilt) for name, tilt in tilts.items()}


@pytest.mark.parametrize("seal", SEALS)
def test_transmissibilities_solve_the_equation_of_motion(seal):
    for name, expected in answers(seal).items():
        assert getattr(closed_form, name)(**seal) == pytest.approx(expected, rel=1e-12), name


@pytest.mark.parametrize("seal", SEALS)
def test_dimensionless_numbers_serve_as_well(seal):
    scale, w = 4.9e5, seal["speed"]
    bars = {"speed": 1.0}
    for name, value in seal.items():
        power = {"inertia": 2, "damping": 1, "stiffness": 0}.get(name.split("_")[-1])
        if power is not None:
            bars[name] = value * w**power / scale
    for name, expected in answers(seal).items():
        assert getattr(closed_form, name)(**bars) == pytest.approx(expected, rel=1e-12), name


def test_speed_may_be_an_array():
    speeds = np.linspace(0, 3000, 7)
    for name in answers(SEALS[0]):
        law = getattr(closed_form, name)
        swept = law(**SEALS[0] | {"speed": speeds})
        assert swept == pytest.approx([law(**SEALS[0] | {"speed": w}) for w in speeds])


@pytest.mark.core
def test_critical_forcing_brings_the_response_to_contact():
    assert 2e-6 + 0.07 * critical_forcing(3e-4, 2e-6, 0.07) == pytest.approx(3e-4)
    assert critical_forcing(3e-4, 4e-4, 0.07) < 0
    assert critical_forcing(3e-4, 0.0, 0.0) == np.inf
