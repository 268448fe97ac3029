"""The radial film at small tilt, integrated in time, against closed forms fed with its own linearisation."""

import numpy as np
import pytest
from scenes import CLEARANCE, INERTIA, R_I, R_O, SPEED, SUPPORT, TILT_SCALE, film, fmr, fms, run

from sealdyn import closed_form
from sealdyn.closed_form import radial_film_coefficients
from sealdyn.dynamics.extrema import LEAST, MOST

K_S, D_S = SUPPORT.tilt()


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("flexible", ["rotor", "stator"])
def test_small_tilt_is_the_closed_form(flexible, geometry):
    """|g| r_o / C = 1e-3: maximum and minimum relative misalignment to 1e-5, with coefficients from another code
    (covariances over the face) and with the run's own."""
    own = radial_film_coefficients(R_I, R_O, CLEARANCE, 3.125e-3, 0.5e-3, 5e5, geometry=geometry)
    numbers = dict(
        speed=SPEED, transverse_inertia=INERTIA, polar_inertia=2 * INERTIA, support_stiffness=K_S,
        support_damping=D_S, film_stiffness=own.tilt_stiffness, film_damping=own.tilt_damping,
    )  # fmt: skip
    if flexible == "rotor":
        static, dynamic = closed_form.fmr_static(**numbers), closed_form.fmr_dynamic(**numbers)
    else:
        static, dynamic = closed_form.fms_static(**numbers), closed_form.fms_dynamic(**numbers)
    most, least = closed_form.superposed(static, dynamic)
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
