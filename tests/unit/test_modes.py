"""Eigenvalues, whirl direction, verdict, critical speed against the complex equations (Green 1989), solved here."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import GIVEN, INERTIA, SPEED, SUPPORT, film, fms, free_ring, ring, started
from scenes import of_given_film as run_of

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.modes import Mode, film_matrices, verdict
from sealdyn.dynamics.stability_thresholds import one_by_one, resonance_speeds, thresholds
from sealdyn.scene.rings import Rotor, Stator

K_F, D_F, K_FZ, D_FZ = GIVEN
K_S, D_S = SUPPORT.tilt()
SLENDER = INERTIA / 3


FMS, FMR = dict(stator=Stator(**ring(3.0))), dict(rotor=Rotor(**ring(3.0)))
FMSR = dict(
    stator=Stator(**ring(mass=0.8, transverse_inertia=6e-4, polar_inertia=1.1e-3)), rotor=Rotor(**ring(3.0))
)  # fmt: skip


def complex_roots(floating, speed, stator_speed=0.0):
    """Roots of det(s^2 M + s C + K) of the tilts in complex form, by its companion matrix."""
    rings = {
        "stator": (6e-4 if len(floating) == 2 else INERTIA, 1.1e-3 if len(floating) == 2 else SLENDER, stator_speed, 1),
        "rotor": (INERTIA, SLENDER, speed, -1),
    }
    n = len(floating)
    m, c, k = (np.zeros((n, n), dtype=complex) for _ in range(3))
    wedge = 0.5j * (speed + stator_speed)
    for a, name in enumerate(floating):
        inertia, polar, spin, sign = rings[name]
        m[a, a] = inertia
        c[a, a] += D_S - 1j * polar * spin
        k[a, a] += K_S - 1j * spin * D_S
        for b, other in enumerate(floating):
            c[a, b] += sign * rings[other][3] * D_F
            k[a, b] += sign * rings[other][3] * (K_F - wedge * D_F)
    inverse = np.linalg.inv(m)
    return np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ k, -inverse @ c]]))


def axial_roots(masses):
    """Roots of the axial motion of one or two rings."""
    n, signs = len(masses), [1, -1][: len(masses)]
    film_part = np.outer(signs, signs)
    k = np.eye(n) * SUPPORT.axial_stiffness + K_FZ * film_part
    c = np.eye(n) * SUPPORT.axial_damping + D_FZ * film_part
    inverse = np.diag(1 / np.array(masses))
    return np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ k, -inverse @ c]]))


def same(found, expected, rel=1e-9):
    """Two sets of eigenvalues agree: each has its nearest in the other."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert len(found) == len(expected)
    distance = np.abs(found[:, None] - expected[None, :])
    assert np.max(distance.min(axis=0)) < rel * np.max(np.abs(expected))
    assert np.max(distance.min(axis=1)) < rel * np.max(np.abs(expected))


CASES = {
    "FMS": (FMS, ["stator"], [1.0], 0.0),
    "FMR": (FMR, ["rotor"], [1.0], 0.0),
    "FMSR": (FMSR, ["stator", "rotor"], [0.8, 1.0], 0.0),
    "counter-rotating": (
        FMSR | dict(stator=replace(FMSR["stator"], speed=-700.0)), ["stator", "rotor"], [0.8, 1.0], -700.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("speed", [300.0, 4000.0, 9000.0])
@pytest.mark.parametrize("name", CASES)
def test_eigenvalues_against_the_complex_equations(name, speed):
    rings, floating, masses, stator_speed = CASES[name]
    linear = run_of(**rings).model.linear_scene(speed=speed)
    tilt = complex_roots(floating, speed, stator_speed)
    expected = np.concatenate([tilt, tilt.conj(), axial_roots(masses)])
    same(linear.eigen()[0], expected)
    same(np.linalg.eigvals(linear.state_matrix()), expected)


@pytest.mark.parametrize("floor", [None, -1e5], ids=["no floor", "floor"])
@pytest.mark.parametrize("speed", [3.0, 300.0, 9000.0])
def test_film_at_another_speed_is_the_film_linearised_there(speed, floor):
    """To rounding where the still film serves all speeds; a film with a floor is linearised at each."""
    model = Model(fms(film=film(cavitation_pressure=floor)))
    linear = model.linear_scene(speed=speed)
    stiffness, damping = model.interface.slopes(model.start, 0.5 * speed, model.axial_shift())[:2]
    for found, expected in ((linear.film_k, stiffness), (linear.film_d, damping)):
        assert found[0, 0] == pytest.approx(expected[0, 0], rel=1e-8)
        assert found[1:, 1:] == pytest.approx(expected[1:, 1:], rel=1e-8)
    assert linear.film_k[2, 1] == pytest.approx(-0.5 * speed * linear.film_d[1, 1], rel=1e-8)


@pytest.mark.parametrize("speed", [300.0, 4000.0])
@pytest.mark.parametrize("name", CASES)
def test_whirl_direction_is_the_sign_of_the_complex_root(name, speed):
    """gamma ~ exp(s t): forward turns with the shaft."""
    rings, floating, masses, stator_speed = CASES[name]
    modes = run_of(**rings).model.linear_scene(speed=speed).modes()
    assert all(a.value.real >= b.value.real for a, b in pairwise(modes))
    for root in complex_roots(floating, speed, stator_speed):
        seen = root if root.imag > 0 else root.conj()
        nearest = min((m for m in modes if m.kind == "tilt"), key=lambda mode: abs(mode.value - seen))
        assert nearest.value == pytest.approx(seen, rel=1e-8)
        assert nearest.direction == ("forward" if root.imag > 0 else "backward")
    axial = [mode.value for mode in modes if mode.kind == "axial"]
    same(axial, [s for s in axial_roots(masses) if s.imag >= 0])


def test_massless_ring_has_its_first_order_eigenvalue_alone():
    light = run_of(rotor=Rotor(**ring(mass=0.0, transverse_inertia=0.0, polar_inertia=0.0)))
    values = light.model.linear_scene().eigen()[0]
    tilt = -(K_S + K_F - 1j * SPEED * (D_S + D_F / 2)) / (D_S + D_F)
    axial = -(SUPPORT.axial_stiffness + K_FZ) / (SUPPORT.axial_damping + D_FZ)
    same(values, [tilt, tilt.conjugate(), axial])


# --- verdict and critical speed ------------------------------------------------------------------------


def fmr_threshold():
    """Speed where a root of the complex polynomial of the slender FMR ring is imaginary, s = i nu w."""
    nu = (D_S + D_F / 2) / (D_S + D_F)
    return math.sqrt((K_S + K_F) / INERTIA / (nu * (nu - 1 / 3)))


def fms_threshold():
    return 2 * (1 + D_S / D_F) * math.sqrt((K_S + K_F) / INERTIA)


@pytest.mark.core
@pytest.mark.parametrize("rings,expected", [(FMS, fms_threshold()), (FMR, fmr_threshold())], ids=["FMS", "FMR"])
def test_critical_speed_is_the_formula(rings, expected):
    whole = run_of(**rings)
    found = thresholds(one_by_one(lambda w: whole.model.linear_scene(speed=w)), 100.0, 1e6)[0]
    assert found == pytest.approx(expected, rel=1e-10)
    at = [verdict(whole.model.linear_scene(speed=share * expected).modes()) for share in (1 - 1e-6, 1.0, 1 + 1e-6)]
    assert at == ["stable", "neutral", "unstable"]


def test_a_short_disk_has_no_critical_speed():
    whole = run_of(rotor=Rotor(**ring(0.5)))
    assert thresholds(one_by_one(lambda w: whole.model.linear_scene(speed=w)), 100.0, 1e6) == []


def test_an_undamped_ring_is_neutral_at_every_speed():
    free = started(free_ring(), 1.0)
    for speed in (10.0, 1000.0, 1e5):
        assert verdict(free.model.linear_scene(speed=speed).modes()) == "neutral"
    assert thresholds(one_by_one(lambda w: free.model.linear_scene(speed=w)), 10.0, 1e5) == []


def test_verdict_reads_the_worst_mode():
    good, bad = Mode(-5 + 100j, "tilt", "forward"), Mode(1 + 30j, "axial", "axial")
    assert verdict([bad, good]) == "unstable" and verdict([good]) == "stable"


def test_an_aligned_scene_above_its_threshold_is_unstable():
    """Its run integrates the axial motion alone; the verdict sees the tilts."""
    whole = run_of(**FMR, speed=1.05 * fmr_threshold())
    assert whole.model.unknowns.names == ["rotor_z"]
    assert verdict(whole.model.linear_scene().modes()) == "unstable"


def test_resonance_is_where_a_forward_mode_turns_with_the_shaft():
    """Undamped slender ring: -I w^2 + J w^2 + K = 0."""
    free = started(free_ring(3.0), 1.0)
    found = resonance_speeds(one_by_one(lambda w: free.model.linear_scene(speed=w)), 10.0, 1e5)
    assert found == pytest.approx([math.sqrt(K_S / (INERTIA - SLENDER))], rel=1e-9)


def test_matrices_of_an_isotropic_film():
    """M = -[K g + D (g' - i wm g)], in complex form."""
    stiffness, damping = film_matrices(K_F, D_F, K_FZ, D_FZ, 300.0)
    g, rate = 3e-6 - 2e-6j, 1e-3 + 4e-3j
    found = -(stiffness @ [1e-6, g.real, g.imag] + damping @ [2e-3, rate.real, rate.imag])
    assert found[0] == pytest.approx(-(K_FZ * 1e-6 + D_FZ * 2e-3), rel=1e-14)
    assert complex(*found[1:]) == pytest.approx(-(K_F * g + D_F * (rate - 300j * g)), rel=1e-13)
