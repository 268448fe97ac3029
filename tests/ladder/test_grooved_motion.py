"""Small motion over a patterned face: rows computed elsewhere, differences of the steady film, the whole circle, plain
faces in either frame, roots with a ring."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gap_state
from grooved_faces import GAS, LIQUID, R_I, R_O, ROWS, SPIRAL, TEE, film, films_of

from sealdyn.closed_form.film import radial_film_coefficients
from sealdyn.faces.geometry import GX, MOMENT_X, MOMENT_Y
from sealdyn.films import film_named
from sealdyn.films._grooved.balance import extrapolated, order, steady
from sealdyn.films._grooved.mesh import mesh_of
from sealdyn.films._grooved.motion import (
    TO_TURNS,
    Motion,
    Ring,
    axial_law,
    circle_impedance,
    coupled_law,
    relative_tilt,
    root_near,
    support_law,
    tilt_law,
    unstable_roots,
)
from sealdyn.scene.film import Film
from sealdyn.scene.fluid import GasReynolds

W = 1000.0
PLAIN = replace(SPIRAL, depth=0.0)
RING = Ring(0.2, 3.5e-4, 1.64e4, 1e3, 31.0, 1.4)
# At w = 0.01, 1, 2, 5, 10, 30 W: axial K and D, Kxx, Dxx, Kxy of the inertial frame, by an independent prototype.
OVER_FREQUENCY = {
    "gas_5bar": [
        (3.326e8, 5560, 4.986e5, 20.6, -1.89e4), (3.336e8, 5200, 5.043e5, 18.4, -1.70e4),
        (3.354e8, 4510, 5.152e5, 14.1, -1.11e4), (3.383e8, 3530, 5.303e5, 7.26, 5.44e3),
        (3.459e8, 3420, 5.423e5, 5.97, 6.02e3), (3.904e8, 1700, 6.170e5, 2.95, 234),
    ],
    "gas_1bar": [
        (1.546e8, -28600, 2.222e5, -3.5, -2.55e4), (1.396e8, -12700, 2.201e5, -10.9, -5.97e3),
        (1.316e8, -3980, 2.076e5, -5.2, 2.97e3), (1.277e8, 510, 2.002e5, 0.90, 4.54e3),
        (1.358e8, 1150, 2.123e5, 1.92, 572), (1.466e8, 292, 2.303e5, 0.48, -30),
    ],
}  # fmt: skip


def motions(name):
    coarse, fine, power = films_of(name)
    speed = ROWS[name]["shaft_speed"]
    return Motion(coarse, speed), Motion(fine, speed), power


def better(name, number):
    coarse, fine, power = motions(name)
    return extrapolated(number(coarse), number(fine), power)[0]


@pytest.mark.core
@pytest.mark.parametrize("name", [name for name in ROWS if "tilt_Z_at_+0W" in ROWS[name]["expected"]])
def test_stiffness_and_damping_of_the_rows(name):
    """Within the row's tolerance, or 0.4 %; of complex numbers that of their magnitude."""
    row = ROWS[name]
    speed, expected = row["shaft_speed"], row["expected"]
    for times in (0, 1):
        stiffness, tolerance = expected[f"axial_K_at_{times}W"]
        damping = expected.get(f"axial_wD_at_{times}W", [0.0])[0]
        found = better(name, lambda motion, s=1j * times * speed: motion.axial_impedance(s))
        assert found.real == pytest.approx(stiffness, rel=max(tolerance, 4e-3))
        assert found.imag == pytest.approx(damping, abs=max(tolerance, 4e-3) * abs(stiffness + 1j * damping))
    for times in (0, 1, -1):
        value, tolerance = expected[f"tilt_Z_at_{times:+d}W"]
        found = better(name, lambda motion, s=1j * times * speed: motion.tilt_impedance(s))
        assert abs(found - complex(*value)) < max(tolerance, 4e-3) * abs(complex(*value))


@pytest.mark.parametrize("name", OVER_FREQUENCY)
def test_stiffness_and_damping_over_the_frequency(name):
    """Gas in grooves stores: negative damping at ambient pressure up to some times the speed."""
    for times, (axial_k, axial_d, direct_k, direct_d, cross) in zip(
        (0.01, 1, 2, 5, 10, 30), OVER_FREQUENCY[name], strict=True
    ):
        w = times * W
        k, d = better(name, lambda motion, w=w: np.array(motion.matrices(w)))
        # The printed digits stand for 0.5 %; damping errs by a share of the impedance.
        assert k[0, 0] == pytest.approx(axial_k, rel=6e-3) and k[1, 1] == pytest.approx(direct_k, rel=6e-3)
        assert w * d[0, 0] == pytest.approx(w * axial_d, abs=6e-3 * abs(axial_k))
        for found, row in ((w * d[1, 1], w * direct_d), (k[1, 2], cross)):
            assert found == pytest.approx(row, abs=6e-3 * direct_k)
        assert k[2, 1] == -k[1, 2] and k[2, 2] == k[1, 1] and not k[0, 1:].any() and not d[1:, 0].any()
        assert (d[0, 0] < 0.0) == (axial_d < 0.0)


def test_roots_with_a_ring():
    rows = {axial_law: [-5356 + 45260j], tilt_law: [-5035 + 43004j, -5017 - 43056j, -2625 + 456.6j]}
    for law, roots in rows.items():
        for root in roots:
            found = better("gas_5bar", lambda motion, law=law, root=root: root_near(law(motion, RING), root))
            assert abs(found - root) < 5e-3 * abs(root)


def test_answers_to_runout_and_to_misalignment():
    """The linear part of a run of an independent prototype."""
    ring, runout, misalignment = Ring(0.2, 3.5e-4, 1.64e4, 1e3, 3e5, 50.0), 2e-5, 4e-5

    def relative(motion):
        turning = abs(relative_tilt(motion, (ring,), support_law(ring, 1j * W) * runout, W)[0])
        standing = abs(relative_tilt(motion, (ring,), support_law(ring, 0.0) * misalignment, 0.0)[0])
        return np.array([turning + standing, abs(turning - standing)])

    assert better("gas_5bar", relative) == pytest.approx([2.245e-5, 7.5773e-6], rel=4e-3)


@pytest.mark.parametrize("pattern", [SPIRAL, TEE])
@pytest.mark.parametrize("conditions", [GAS, LIQUID, replace(GAS, slip=300.0, coning=1e-4)])
def test_stiffness_at_rest_is_the_slope_of_the_force(pattern, conditions):
    step, mesh = 1e-9, mesh_of(pattern, R_I, R_O, 8)
    near = [steady(mesh, replace(conditions, clearance=3e-6 + way)).force for way in (-step, step)]
    slope = -(near[1] - near[0]) / (2.0 * step)
    assert Motion(steady(mesh, conditions)).axial_impedance(0.0).real == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("pattern", [SPIRAL, replace(SPIRAL, count=3), TEE])
@pytest.mark.parametrize("conditions", [GAS, LIQUID])
def test_one_pitch_answers_as_the_whole_circle(pattern, conditions):
    found = film(pattern, conditions)
    motion, s = Motion(found), -300.0 + 700.0j
    circle = circle_impedance(found)(s)
    ahead, behind = motion.frame_impedance(s), motion.frame_impedance(np.conj(s)).conjugate()
    direct, cross = 0.5 * (ahead + behind), 0.5j * (ahead - behind)
    expected = np.zeros((3, 3), dtype=complex)
    expected[0, 0] = motion.axial_impedance(s)
    expected[1:, 1:] = [[direct, cross], [-cross, direct]]
    scale = np.array([1.0, R_O, R_O])
    error = np.abs(circle - expected) / np.outer(scale, scale)
    assert error.max() < 1e-8 * abs(circle[0, 0])


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_pitches_answer_at_two_frequencies(count):
    """Tilts about both axes of the pattern are not alike; with one pitch axial motion and tilt are not apart either."""
    motion = Motion(film(replace(SPIRAL, count=count), LIQUID), W)
    z = motion.coupled(0.0)
    assert abs(z[1, 2]) > 1e-2 * abs(z[1, 1]) and z[2, 2] == pytest.approx(z[1, 1].conjugate(), rel=1e-12)
    assert (np.abs(z[0, 1:]).max() > 1e-4 * R_O * abs(z[0, 0])) == (count == 1)
    assert motion.tilt_impedance(1j * W) == pytest.approx(z[1, 1], rel=1e-12)
    assert abs(motion.beside_impedance(1j * W)) == pytest.approx(abs(z[1, 2]), rel=1e-10)
    # A standing tilt about x, drawn in the frame of the pattern and turned back to the inertial one.
    s, times = -1j * W, np.array([0.0, 0.4, 1.1]) / W
    in_frame = (TO_TURNS @ motion.circle(s) @ np.array([0.0, 1.0, -1j]))[1:, None] * np.exp(s * times)
    both = in_frame[0] + in_frame[1].conjugate()
    expected = 2.0 * motion.tilt_impedance(0.0) + 2.0 * motion.beside_impedance(0.0) * np.exp(2j * W * times)
    assert both * np.exp(1j * W * times) == pytest.approx(expected, rel=1e-9)


def test_all_roots_of_ring_and_film_are_those_of_one_determinant():
    """Of three pitches and more those of axial motion and of tilt forward and, conjugate, backward."""
    motion = Motion(film(replace(SPIRAL, count=4), GAS, columns=4), W)
    law = coupled_law(motion, RING)

    def determinant(s):
        return complex(np.linalg.det(law(s)))

    axial, tilt = root_near(axial_law(motion, RING), -5e3 + 45e3j), root_near(tilt_law(motion, RING), -5e3 + 43e3j)
    for root in (axial, tilt - 1j * W, (tilt - 1j * W).conjugate()):
        assert root_near(determinant, root * 1.001) == pytest.approx(root, rel=1e-8)
    heavy = replace(RING, mass=100.0, axial_damping=0.0)
    thin = Motion(film(SPIRAL, replace(GAS, outer_pressure=1e5), columns=4), W)
    law = coupled_law(thin, heavy)
    apart = unstable_roots(axial_law(thin, heavy), heavy.mass), unstable_roots(tilt_law(thin, heavy), 3.5e-4)
    # Each tilt that grows is two roots here, with its conjugate.
    assert unstable_roots(determinant, 100.0 * 3.5e-4**2, degree=6) == apart[0] + 2 * apart[1] > 0


def test_the_frame_of_plain_faces_does_not_matter():
    """A pattern without depth in the turning rotor and in the standing stator, and the closed row of plain faces."""
    turning = Motion(film(PLAIN, columns=16), W)
    standing = Motion(film(PLAIN, replace(GAS, face="stator"), columns=16), 0.0)
    for w in (-3e3, 0.0, 1e3, 2e4):
        assert turning.tilt_impedance(1j * w) == pytest.approx(standing.tilt_impedance(1j * w), rel=3e-3)
        axial = turning.axial_impedance(1j * w), standing.axial_impedance(1j * w)
        assert abs(axial[0] - axial[1]) < 1e-9 * 1e8
    pair = [Motion(film(PLAIN, columns=16, times=times), W) for times in (1, 2)]
    for s, row in ((0.0, 34841.0 - 185392.0j), (1j * W, 34841.0 + 185392.0j)):
        found = extrapolated(*(motion.tilt_impedance(s) for motion in pair), 2.0)[0]
        assert abs(found - row) < 1e-3 * abs(row)
    found = extrapolated(*(motion.axial_impedance(1j * W) for motion in pair), 2.0)[0]
    assert abs(found - (115535000.0 + 165857000.0j)) < 2e-3 * abs(found)


def test_plain_gas_as_the_film_of_cells_tilted_a_little():
    """A standing tilt meets a film that turns past it at half the speed."""
    table = Film(R_I, R_O, 5e5, 1e5, clearance=3e-6, gas="air", temperature=300.0, viscosity=1.8e-5,
                 model="gas_reynolds", gas_reynolds=GasReynolds(cells=(16, 12)))  # fmt: skip
    old, tilt = film_named("gas_reynolds"), 1e-8
    s, f = gap_state(table, W), old.parameters(table, 3e-6)
    s[GX], x = tilt, np.empty(16 * 12)
    assert old.start(f, s, x) == 0
    old.wrench(f, s, x)
    expected = -(s[MOMENT_X] + 1j * s[MOMENT_Y]) / tilt
    found = Motion(film(PLAIN, columns=16), W).tilt_impedance(0.0)
    assert abs(found - expected) < 5e-3 * abs(expected)


def test_axial_motion_of_a_plain_liquid_film_is_the_closed_form():
    motion = Motion(film(PLAIN, LIQUID, columns=16), LIQUID.relative_speed)
    closed = radial_film_coefficients(R_I, R_O, 3e-6, 0.0, 1e-3, 4e5)
    found = motion.axial_impedance(1j)
    assert found.imag == pytest.approx(closed.axial_damping, rel=2e-3)
    assert abs(found.real) < 1e-6 * abs(found.imag) * LIQUID.relative_speed


def test_a_liquid_damps_by_a_real_number_and_does_not_whirl_at_half_the_speed():
    """Z' = K' + s D' with a real D'; plain faces have Im K' = W D'/2, grooves have not."""
    motion, speed = motions("liquid_upstream_pumping")[1], 300.0
    k = motion.frame_impedance(0.0)
    d = (motion.frame_impedance(5e3j) - k) / 5e3j
    # Real but for the cells: what they hold and what their pressures weigh are two rules.
    assert abs(d.imag) < 1e-3 * d.real
    assert motion.frame_impedance(-70.0 + 900.0j) == pytest.approx(k + (-70.0 + 900.0j) * d, rel=1e-10)
    assert 1.0 - k.imag / (speed * d.real) == pytest.approx(0.526, abs=2e-3)


def test_grooves_the_wrong_way_round_have_negative_stiffness():
    assert Motion(film()).axial_impedance(0.0).real > 1e8
    assert Motion(film(replace(SPIRAL, angle=-SPIRAL.angle))).axial_impedance(0.0).real < -1e8


@pytest.mark.parametrize("pattern, low, high", [(SPIRAL, 1.0, 1.6), (TEE, 1.3, 2.0)])
def test_order_of_convergence_without_bisections(pattern, low, high):
    """Twice the exponent of the tips, of force, flow and stiffness."""
    values = []
    for times in (1, 2, 4):
        found = steady(mesh_of(pattern, R_I, R_O, 16, times, bisections=0), LIQUID)
        values.append([found.force, found.flows[0], Motion(found).axial_impedance(0.0).real])
    steps = np.abs(np.diff(np.array(values), axis=0))
    assert (np.log2(steps[0] / steps[1]) > low).all() and (np.log2(steps[0] / steps[1]) < high).all()
    assert low < order(found.film) < high


def test_a_root_is_found_or_refused():
    assert root_near(lambda s: (s - 3.0) * (s + 5.0 + 2.0j) * np.exp(0.1 * s), -4.0 + 0.0j) == pytest.approx(
        -5.0 - 2.0j
    )
    with pytest.raises(ArithmeticError):
        root_near(np.exp, 1.0)
    assert math.isfinite(abs(root_near(lambda s: s * s + 4.0, 1.0 + 1.0j)))
