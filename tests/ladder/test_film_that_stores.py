"""Rings on a film that stores (radial_cells.py with a liquid that gives way): every mode and response meets its
stiffness and damping at its own frequency, here against the whole linear system, Bessel functions, and runs in time."""

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
from radial_cells import film_of
from scenes import SPEED, SUPPORT, TILT_SCALE, film, fmr, fms, fmsr, ring, run
from scipy.linalg import eig
from scipy.optimize import newton
from test_film_with_unknowns import squeezed_compressible_film

from sealdyn.analysis.whirl_in_time import fit_growth
from sealdyn.dynamics import modes, stability_thresholds
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.modes import Harmonic
from sealdyn.dynamics.stability_thresholds import one_by_one
from sealdyn.scene.excitation import Shaft, Whirl
from sealdyn.scene.forces import Contact
from sealdyn.scene.rings import Stator
from sealdyn.scene.scene import Initial, RingStart

# The slowest pressures of this liquid die out in 0.4 ms: about the pace of the rings.
STORING = 1e-6
QUIET = {fms: dict(own=0.0, runout=0.0), fmr: dict(own=0.0, fixed=0.0), fmsr: dict(own=0.0, fixed=0.0)}
MASSLESS = Stator(**ring(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0))


def aligned(build, **more):
    """A scene without forcing that has its tilts nevertheless."""
    name = "rotor" if build is fmr else "stator"
    return replace(build(**{**QUIET[build], **more}), initial=Initial(**{name: RingStart(tilt_x=1e-18)}))


def stored(scene, compressibility=STORING, cells=12, angles=8):
    return Model(scene, film=film_of(cells, angles, compressibility))


def whole_system(model):
    """All eigenvalues (m,) of rings and film at rest, and the rings' share (m,) of each, from differences of the whole
    residual: the unknowns as the run in time has them, nothing eliminated."""
    segment = model.segment()
    n, rest = segment.film.stop, np.zeros(segment.size)
    segment.settle_film(0.0, rest)
    still, res, sides = np.zeros(segment.size), np.empty(segment.size), []
    for which in (0, 1):
        matrix = np.zeros((n, n))
        for j in range(n):
            step = 1e-3 * segment.scales[j] * (model.reference_rate if which else 1.0)
            for offset, weight in ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12)):
                moved = [rest.copy(), still.copy()]
                moved[which][j] += offset * step
                segment.residual(0.0, *moved, res)
                matrix[:, j] += weight / step * res[:n]
        sides.append(matrix * segment.scales[:n])
    values, shapes = eig(sides[0], -sides[1])
    kept = np.isfinite(values)
    share = np.abs(shapes[: segment.n]).max(axis=0) / np.abs(shapes).max(axis=0)
    return values[kept], share[kept]


@pytest.mark.parametrize("compressibility", [1e-8, 1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize(
    "scene",
    [aligned(fms, speed=5000.0), aligned(fmr, speed=9000.0, c=3.0), aligned(fmsr, speed=3000.0),
     aligned(fms, stator=MASSLESS),
     replace(aligned(fms), contact=Contact(roughness=3.8e-6, compressive_strength=3e8))],
    ids=["stator", "rotor", "both rings", "massless stator", "asperities beside"],
)  # fmt: skip
def test_modes_are_those_of_rings_and_film_together(scene, compressibility):
    model = stored(scene, compressibility)
    linear = model.linear_scene()
    found, (expected, share) = linear.eigen()[0], whole_system(model)
    for value in found:
        assert np.min(np.abs(expected - value)) < 1e-6 * abs(value)
    # Of the film's other modes no ring knows.
    moving = expected[(share > 1e-6) & (np.abs(expected) < 0.99 * linear.reach)]
    for value in moving:
        assert np.min(np.abs(found - value)) < 1e-6 * abs(value)
    assert np.sum(found.real > 0) == np.sum(expected.real > 0)


@pytest.mark.core
def test_a_film_that_hardly_stores_has_the_modes_of_slow_motion():
    soft, hard = (stored(aligned(fms, speed=5000.0), b).linear_scene() for b in (1e-12, 0.0))
    assert hard.film is None and soft.film is not None
    for value in hard.eigen()[0]:
        assert np.min(np.abs(soft.eigen()[0] - value)) < 1e-4 * abs(value)


@pytest.mark.slow
def test_axial_modes_of_flat_faces_are_roots_with_bessel_functions():
    """m p^2 + d p + k + H(p) = 0, at second order in the cells."""
    flat, compressibility = aligned(fms, film=film(coning=0.0)), 2.7e-6

    def left(p):
        dynamic = p * p + SUPPORT.axial_damping * p + SUPPORT.axial_stiffness
        return dynamic + squeezed_compressible_film(-1j * p, compressibility)

    errors = []
    for cells in (16, 32, 64):
        found = [m for m in stored(flat, compressibility, cells, 4).linear_scene().modes() if m.kind == "axial"]
        oscillating = max((m.value for m in found if m.value.imag > 0), key=abs)
        exact = newton(left, oscillating, rtol=1e-12)
        errors.append(abs(oscillating / exact - 1))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.7) & (orders < 2.3)) and errors[-1] < 3e-3, (orders, errors)


# --- stability --------------------------------------------------------------------------------------


@cache
def thresholds():
    """Critical speeds (rad/s) of a stored FMS scene, and as slow motion has it."""
    model = stored(aligned(fms))
    roads = (lambda w: model.linear_scene(speed=w)), (lambda w: model.linear_scene(speed=w).at_frequency(0.0))
    return tuple(stability_thresholds.thresholds(one_by_one(road), 300.0, 3e4, 40)[0] for road in roads)


def test_threshold_is_that_of_rings_and_film_together_and_not_that_of_slow_motion():
    critical, slow = thresholds()
    assert critical > 1.1 * slow
    for share, grows in ((1 - 1e-5, False), (1 + 1e-5, True)):
        values, _ = whole_system(stored(aligned(fms, speed=share * critical)))
        assert (values.real.max() > 0) == grows


@pytest.mark.parametrize("share", [0.35, 0.65])
def test_whirl_between_the_two_thresholds_goes_as_the_film_at_its_frequency_has_it(share):
    """Slow motion has the other verdict there."""
    critical, slow = thresholds()
    speed = critical + share * (slow - critical)
    scene = replace(aligned(fms, speed=speed), initial=Initial(stator=RingStart(tilt_x=1e-4 * TILT_SCALE)))
    found = run(scene, 16, 1e-8, "ida", model_class=partial(Model, film=film_of(12, 8, STORING)))
    linear = found.model.linear_scene()
    assert modes.verdict(linear.modes()) != modes.verdict(linear.at_frequency(0.0).modes())
    rate, spread = fit_growth(found.times, found.tilt("stator"))
    assert rate == pytest.approx(linear.modes()[0].value.real, rel=1e-4) and spread < 1e-4 * abs(rate)


# --- response ---------------------------------------------------------------------------------------


def circles(found, frequencies):
    """Complex circles a of the relative tilt, a exp(i w t), over the last turn."""
    tilt = found["relative_tilt_x"] + 1j * found["relative_tilt_y"]
    last = slice(-65, -1)
    t, tilt = found.times[last], tilt[last]
    return [np.mean(tilt * np.exp(-1j * w * t)) for w in frequencies]


@pytest.mark.parametrize("build, ratio", [(fms, -2.0), (fms, 3.0), (fmr, -2.0), (fmr, 2.0)])
def test_response_is_the_steady_motion_in_time(build, ratio):
    """Against and with the shaft, through the film (FMS) and through the support (FMR)."""
    small = 1e-3 * TILT_SCALE
    scene = build(speed=SPEED, **{**QUIET[build], "own": small})
    scene = replace(scene, shaft=Shaft(SPEED, whirl=[Whirl(ratio=ratio, angle=2 * small, phase=0.3)]))
    found = run(scene, 12, 1e-9, "ida", model_class=partial(Model, film=film_of(12, 8, STORING)))
    linear = found.model.linear_scene()
    answers = [(h, linear.relative(h, linear.response(h))) for h in found.model.segment().harmonics()]
    slow = linear.at_frequency(0.0)
    others = [(h, slow.relative(h, slow.response(h))) for h, _ in answers]
    for h, g in answers:
        (seen,) = circles(found, [h.frequency])
        assert abs(seen - (g[1] + 1j * g[2]) / 2) < 1e-4 * abs(seen)
    apart = [abs((g[1] - other[1]) / g[1]) for (_, g), (_, other) in zip(answers, others, strict=True)]
    assert max(apart) > 0.1


@pytest.mark.parametrize("build", [fms, fmr, fmsr])
def test_a_real_motion_has_a_real_response(build):
    """At -w with the conjugate amplitude the answer is the conjugate."""
    linear = stored(aligned(build)).linear_scene()
    shape = np.array([1e-6, 2e-6 - 1e-6j, 0.5e-6j])
    for ring_of in (0, 1):
        own = shape if linear.rings[ring_of].floats else np.zeros(3)
        there, back = (
            linear.response(Harmonic(w, ring_of, carrier, mine))
            for w, carrier, mine in ((700.0, shape, own), (-700.0, shape.conj(), own.conj()))
        )
        assert np.abs(there.conj() - back).max() < 1e-12 * np.abs(there).max()
