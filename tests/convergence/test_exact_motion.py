"""Linear scenes by the matrix exponential: exact at its steps, and between them within a tenth of the tolerance."""

import math
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scenes import SPEED, SUPPORT, TILT_SCALE, film, fmr, fms, fmsr, free_ring, housing_vibration, prepared, ring
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from sealdyn.dynamics.linearisation import ExactMotion
from sealdyn.scene.film import Coefficients
from sealdyn.scene.rings import Rotor
from sealdyn.solvers.contract import BETWEEN, Counts, Recorder
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.own_methods import expm as exact_steps

TURN = 2 * math.pi / SPEED
SCENES = {
    "fms": fms("linear"),
    "fmr": fmr("linear", own=0.3 * TILT_SCALE, fixed=0.5 * TILT_SCALE),
    "fmsr": fmsr("linear"),
    "shaken": replace(housing_vibration(), film=film("linear")),
    "free": free_ring(),
    "unstable": fmr("linear", c=3.0, speed=1.05 * 8684.0, own=1e-4 * TILT_SCALE, fixed=0.0),
    "stiff": fmr("linear", rotor=Rotor(**ring(support=SUPPORT) | {"mass": 0.02, "transverse_inertia": 8e-6,
                                                                  "polar_inertia": 8e-6})),
}  # fmt: skip


def ran(scene, method, accuracy, start="rest", turns=6, **options):
    """Displacements and rates (m, n) at samples, relative to their scales, and the outcome."""
    turn = 2 * math.pi / scene.shaft.speed
    ready = prepared(scene, turns * turn, accuracy, start)
    sink = Recorder(turn / 48)
    outcome = solve(ready, method, accuracy, sink, **options)
    _, q, rate = sink.arrays()
    return (
        q / ready.model.scales[: ready.model.unknowns.n],
        rate / ready.model.scales[ready.model.unknowns.rate_places],
        outcome,
    )


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("name", SCENES)
def test_between_its_steps_it_keeps_a_tenth_of_the_tolerance(name, start):
    """Against another method at 1e-13, displacements and rates at samples that are no steps; energy as sharply."""
    # At its limit of stability DOP853 lets a step pass now and then that is wrong by 1e-9, as the last bit decides.
    other = "radau" if name == "stiff" else "dop853"
    exact = ran(SCENES[name], other, 1e-9, start, tolerance=1e-13)
    for accuracy in (1e-2, 1e-4, 1e-6, 1e-9):
        found = ran(SCENES[name], "expm", accuracy, start)
        assert found[2].status == "ok" and found[2].energy_residual < 0.1 * accuracy
        for a, b in zip(found[:2], exact[:2], strict=True):
            assert np.max(np.abs(a - b)) < BETWEEN * accuracy + 3e-12


@pytest.mark.parametrize("scene", ["fms", "fmr"])
def test_a_part_that_died_away_asks_for_no_steps(scene):
    """A film whose squeeze dies out within a nanosecond: what rounding leaves of it is no motion.  Followed, it would
    take a million times the steps."""
    squeezed = film("linear", coefficients=Coefficients(tilt_stiffness=1e8, tilt_damping=2e6,
                                                        axial_stiffness=3e11, axial_damping=5e9))  # fmt: skip
    made = replace(SCENES[scene], film=squeezed)
    ready = prepared(made, 3 * TURN, 1e-8, "rest")
    assert np.min(np.linalg.eigvals(ready.segment(0).exact_motion().matrix).real) < -1e9
    blocks = exact_steps(ready.segment(0), 0.0, ready.y0, "expm", 1e-8, Counts())
    reached = [times[-1] for times, _, _ in islice(blocks, 200)]
    assert reached[-1] == pytest.approx(3 * TURN)


def test_a_tighter_tolerance_takes_shorter_steps():
    steps = [ran(SCENES["fmr"], "expm", accuracy, turns=60)[2].counts.steps for accuracy in (1e-3, 1e-6, 1e-9, 1e-12)]
    assert steps == sorted(steps) and steps[-1] > 3 * steps[0]


def test_what_dies_away_does_not_shorten_the_steps_for_long():
    """The light rotor's fastest decay is thousands of times faster than the shaft."""
    ready = prepared(SCENES["stiff"], 60 * TURN, 1e-6)
    fastest = np.max(np.abs(ready.segment(0).exact_motion().values))
    assert fastest * TURN > 3e3
    assert ran(SCENES["stiff"], "expm", 1e-6, turns=60)[2].counts.steps < 3000


@pytest.mark.parametrize("name", ["fmr", "free"])
def test_nearly_equal_eigenvectors_make_no_difference(name, monkeypatch):
    """Scaling and squaring takes over, with the same motion."""
    by_vectors = ran(SCENES[name], "expm", 1e-6, turns=2)
    monkeypatch.setattr(ExactMotion, "WORST", 0.0)
    by_squaring = ran(SCENES[name], "expm", 1e-6, turns=2)
    assert np.max(np.abs(by_vectors[0] - by_squaring[0])) < 1e-7


def test_a_defective_scene_is_carried_on_exactly():
    """A ring that nothing holds: position grows linearly, and there are no two eigenvectors."""
    motion = ExactMotion(prepared(SCENES["free"], TURN, 1e-6).segment(0))
    motion.matrix = np.array([[0.0, 1.0], [0.0, 0.0]])
    motion.values, motion.vectors = np.linalg.eig(motion.matrix)
    motion.sound = bool(np.linalg.cond(motion.vectors) < motion.WORST)
    assert not motion.sound
    assert motion.free(np.array([1.0, 2.0]), [0.0, 3.0]) == pytest.approx(np.array([[1.0, 2.0], [7.0, 2.0]]))


@pytest.mark.core
def test_against_the_matrix_written_out():
    """Forced motion of the reference rotor from rest: an integral of exp(A (t - s)) f(s) by quadrature."""
    ready = prepared(SCENES["fmr"], TURN, 1e-9)
    motion = ready.segment(0).exact_motion()
    n, at = ready.model.unknowns.n_mechanical, 0.7 * TURN

    def rhs(t, y):
        whole = np.zeros(ready.model.unknowns.size)
        ready.segment(0).rhs(t, np.concatenate([y, np.zeros(ready.model.unknowns.size - n)]), whole)
        return whole[:n]

    push = [rhs(t, np.zeros(n)) for t in (0.0, 0.3 * TURN)]
    found = solve_ivp(rhs, (0.0, at), np.zeros(n), method="DOP853", rtol=1e-12, atol=1e-16).y[:, -1]
    exact = motion.forced([at])[0] + motion.free(-motion.forced([0.0])[0], [at])[0]
    assert np.max(np.abs(exact - found) / ready.model.scales[:n]) < 1e-10
    # The free part alone, by SciPy's exponential.
    start = ready.model.scales[:n] * np.linspace(0.1, 0.3, n)
    assert motion.free(start, [at])[0] == pytest.approx(expm(motion.matrix * at) @ start, rel=1e-9, abs=1e-16)
    assert np.any(push[0] != push[1])
