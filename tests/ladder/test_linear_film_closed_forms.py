"""A linear film integrated in time against Green (1989) and limits of FMSR; the radial film at small tilt."""

import numpy as np
import pytest
from scenes import CLEARANCE, INERTIA, MISALIGNMENT, R_I, R_O, SPEED, SUPPORT, TILT_SCALE, film, fmr, fms, fmsr, run

from sealdyn import closed_form
from sealdyn.closed_form import film_coefficients, radial_film_coefficients
from sealdyn.dynamics.extrema import LEAST, MOST

ACCURACY = 1e-8
FILM = film_coefficients(0.032, 0.04, 1e-5, 3.125e-3, 0.5e-3, 5e5)
K_S, D_S = SUPPORT.tilt()


def closed(flexible, c, coefficients=FILM):
    """Static and dynamic transmissibility."""
    numbers = dict(
        speed=SPEED, transverse_inertia=INERTIA, polar_inertia=INERTIA / c, support_stiffness=K_S, support_damping=D_S,
        film_stiffness=coefficients.tilt_stiffness, film_damping=coefficients.tilt_damping,
    )  # fmt: skip
    kind = {"rotor": "fmr", "stator": "fms"}[flexible]
    return [getattr(closed_form, f"{kind}_{part}")(**numbers) for part in ("static", "dynamic")]


@pytest.mark.parametrize("c", [0.5, 3.0])
@pytest.mark.parametrize("flexible", ["rotor", "stator"])
def test_extremes_of_the_relative_misalignment(flexible, c):
    """static, dynamic, maximum and minimum, each from its own run, to 1e-6 at accuracy 1e-8."""
    static, dynamic = closed(flexible, c)
    if flexible == "rotor":
        scenes = [fmr("linear", c, own=0.0), fmr("linear", c, fixed=0.0), fmr("linear", c)]
    else:
        scenes = [fms("linear", c, runout=0.0), fms("linear", c, own=0.0), fms("linear", c)]
    runs = [run(scene, turns=12, accuracy=ACCURACY, per_turn=1) for scene in scenes]
    for which, expected in ((0, static), (1, dynamic)):
        for slot in (MOST, LEAST):
            assert runs[which].record(1)[slot] / MISALIGNMENT == pytest.approx(expected, rel=1e-6)
    most, least = closed_form.superposed(static, dynamic)
    assert runs[2].record(1)[MOST] / MISALIGNMENT == pytest.approx(most, rel=1e-6)
    assert runs[2].record(1)[LEAST] / MISALIGNMENT == pytest.approx(least, rel=1e-6)


@pytest.mark.core
@pytest.mark.parametrize("limit", ["rotor", "stator"])
def test_fmsr_tends_to_its_limits_as_one_over_stiffness(limit):
    """Stiffen the stator's support: FMR is left.  Stiffen the rotor's: FMS."""
    alone = run(fmr("linear") if limit == "rotor" else fms("linear"), turns=3, accuracy=ACCURACY, start="steady")
    relative = alone["relative_tilt_x"] + 1j * alone["relative_tilt_y"]
    factors, errors = np.array([1e3, 1e4, 1e5]), []
    for factor in factors:
        stiff = {"stator_stiffer": factor} if limit == "rotor" else {"rotor_stiffer": factor}
        both = run(fmsr("linear", **stiff), turns=3, accuracy=ACCURACY, start="steady")
        assert both.ready.model.unknowns.n == 4
        answer = both["relative_tilt_x"] + 1j * both["relative_tilt_y"]
        errors.append(np.max(np.abs(answer - relative)) / np.max(np.abs(relative)))
    slope = np.polyfit(np.log(factors), np.log(errors), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.05)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("flexible", ["rotor", "stator"])
def test_small_tilt_is_the_closed_form(flexible, geometry):
    """|g| r_o / C = 1e-3: maximum and minimum relative misalignment to 1e-5, with coefficients from another code
    (covariances over the face) and with the run's own."""
    own = radial_film_coefficients(R_I, R_O, CLEARANCE, 3.125e-3, 0.5e-3, 5e5, geometry=geometry)
    most, least = closed_form.superposed(*closed(flexible, 0.5, own))
    forcing = 1e-3 * TILT_SCALE / most
    partner = {"fixed": forcing} if flexible == "rotor" else {"runout": forcing}
    build = fmr if flexible == "rotor" else fms
    found = run(build(film=film(geometry=geometry), own=forcing, **partner), turns=10, accuracy=1e-10)
    stiffness, damping = found.ready.model.film_matrices()
    assert stiffness[1, 1] == pytest.approx(own.tilt_stiffness, rel=1e-9)
    assert damping[1, 1] == pytest.approx(own.tilt_damping, rel=1e-9)
    assert stiffness[0, 0] == pytest.approx(own.axial_stiffness, rel=1e-9)
    assert damping[0, 0] == pytest.approx(own.axial_damping, rel=1e-9)
    assert found.record(1)[MOST] * R_O / CLEARANCE == pytest.approx(1e-3, rel=1e-5)
    assert found.record(1)[LEAST] / forcing == pytest.approx(least, rel=1e-5)


@pytest.mark.core
def test_the_film_leaves_its_linear_form_with_the_square_of_the_tilt():
    """Deviation from the linear steady state (harmonic balance) grows as amplitude squared."""
    amplitudes, deviations = np.array([1e-4, 2e-4, 4e-4, 8e-4]), []
    for amplitude in amplitudes:
        found = run(fmr(own=0.0, fixed=amplitude), turns=10, accuracy=1e-10, start="steady")
        start = found.tilt("rotor")[0]
        deviations.append(abs(found.tilt("rotor")[-1] / start - 1))
    assert np.polyfit(np.log(amplitudes), np.log(deviations), 1)[0] == pytest.approx(2.0, abs=0.1)
