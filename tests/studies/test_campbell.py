"""Campbell diagram: modes followed through a constructed crossing and a veering, against roots written out here."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from oracles import green_film, tilt_roots

from sealdyn import read_scenario
from sealdyn.dynamics.model import Model
from sealdyn.studies import campbell
from sealdyn.studies.campbell import Settings, follow


def whole(name, overrides=(), **settings):
    return campbell.run(read_scenario(SCENARIOS / f"{name}.toml", overrides), Settings(**settings), InProcess())


def answer(name, overrides=(), **settings):
    return whole(name, overrides, **settings).numbers


def column(found, name):
    """A column of the table of modes, by its heading."""
    (table,) = found.tables
    k = [heading for _, heading in table.columns].index(name)
    return [row[k] for row in table.rows if row[k] is not None]


def two_oscillators(coupling):
    """Frequencies 1 + w and 3 - w, which meet at w = 1; coupled, they veer apart."""

    def pencil(w):
        stiffness = np.array([[(1 + w) ** 2, coupling], [coupling, (3 - w) ** 2]])
        zero, one = np.zeros((2, 2)), np.eye(2)
        left = np.block([[zero, one], [-stiffness, -np.diag([0.02, 0.1])]])
        return left, np.eye(4)

    return pencil


@pytest.mark.parametrize("points", [7, 20, 101])
def test_modes_go_straight_through_a_crossing(points):
    speeds = np.linspace(0, 2, points)
    values, shapes = follow(two_oscillators(0.0), speeds)
    for row, shape in zip(values, shapes, strict=True):
        place = int(np.argmax(np.abs(shape[0, :2])))
        wanted = 1 + speeds if place == 0 else 3 - speeds
        damping = 0.02 if place == 0 else 0.1
        assert np.abs(row.imag) == pytest.approx(np.sqrt(wanted**2 - damping**2 / 4), rel=1e-9)
        assert row.real == pytest.approx(np.full(points, -damping / 2), rel=1e-9)


def test_sorting_by_frequency_would_have_swapped_them():
    """The failing way: the damping of the mode of lowest frequency jumps at the crossing."""
    values, _ = follow(two_oscillators(0.0), np.linspace(0, 2, 21))
    upper = [sorted((v for v in column if v.imag > 0), key=lambda v: v.imag)[0].real for column in values.T]
    assert np.ptp(upper) > 0.03


def test_coupled_modes_veer_and_exchange_their_shapes():
    # Six speeds would leap over the narrow gap, were none looked at between them.
    speeds = np.linspace(0, 2, 6)
    values, shapes = follow(two_oscillators(0.4), speeds)
    for row, shape in zip(values, shapes, strict=True):
        share = np.abs(shape[:, 0]) > np.abs(shape[:, 1])
        assert share[0] != share[-1]
        assert np.all(np.diff(np.sign(row.imag)) == 0)
    upper = [row for row in values if row[0].imag > 0]
    assert len({int(s) for s in np.sign(upper[0].imag - upper[1].imag)}) == 1


@pytest.mark.core
def test_gyroscopic_ring_on_springs():
    """-I s^2 + J W s + K = 0 for the undamped rotor: frequencies (J W +- sqrt((J W)^2 + 4 I K)) / 2 I."""
    found = answer("free_precession", points=31)
    speed, inertia, polar, k = np.array(found["speed"]), 8e-4, 16e-4, 400.0
    root = np.sqrt((polar * speed) ** 2 + 4 * inertia * k)
    tilt = [m for m in found["modes"] if m["kind"] == "tilt"]
    assert [m["direction"] for m in tilt] == ["backward", "forward"]
    assert tilt[0]["frequency"] == pytest.approx((root - polar * speed) / (2 * inertia), rel=1e-8)
    assert tilt[1]["frequency"] == pytest.approx((root + polar * speed) / (2 * inertia), rel=1e-8)
    assert not found["thresholds"] and set(tilt[0]["log_decrement"]) == {0.0}
    axial = next(m for m in found["modes"] if m["kind"] == "axial")
    assert axial["frequency"] == pytest.approx(np.full(31, np.sqrt(5e5)), rel=1e-9)


@pytest.mark.parametrize("name, ring", [("fmr_reference", "rotor"), ("fms_reference", "stator")])
@pytest.mark.parametrize("c", [0.5, 3.0])
def test_tilt_modes_are_the_roots_of_greens_complex_equation(name, ring, c):
    overrides = ["film.model=linear", f"{ring}.polar_inertia={8e-4 / c!r}"]
    found = answer(name, overrides, points=41, speed_to=12000.0)
    k, d = green_film()
    k_s, d_s, inertia = 400.0, 0.24, 8e-4
    tilt = [m for m in found["modes"] if m["kind"] == "tilt"]
    assert len(tilt) == 2
    for i, w in enumerate(found["speed"]):
        roots = tilt_roots(w, ring, inertia=inertia, polar=inertia / c, k_s=k_s, d_s=d_s, k=k, d=d)
        got = sorted(m["signed_frequency"][i] for m in tilt)
        assert got == pytest.approx(sorted(roots.imag), rel=1e-7, abs=1e-3)
        for m in tilt:
            near = roots[np.argmin(np.abs(roots.imag - m["signed_frequency"][i]))]
            if m["frequency"][i] > 50:
                assert m["log_decrement"][i] == pytest.approx(-2 * np.pi * near.real / abs(near.imag), rel=1e-6)
    critical = [p["speed"] for p in found["thresholds"] if p["what"] == "damping"]
    nu = (d_s + d / 2) / (d_s + d) if ring == "rotor" else d / 2 / (d_s + d)
    if ring == "stator":
        assert critical == [pytest.approx(np.sqrt((k_s + k) / inertia) / nu, rel=1e-5)]
    elif c == 3.0:
        assert critical == [pytest.approx(np.sqrt((k_s + k) / inertia / (nu * (nu - 1 / c))), rel=1e-5)]
    else:
        assert critical == []


def test_four_modes_of_two_rings_are_smooth():
    found = answer("fmsr_both_flexible", points=121)
    tilt = [m for m in found["modes"] if m["kind"] == "tilt"]
    assert len(tilt) == 4
    for mode in tilt:
        bends = np.abs(np.diff(mode["signed_frequency"], 2))
        assert bends.max() < 60.0


def test_order_lines_meet_modes_where_they_say():
    every = whole("fms_reference", ["film.model=linear"], points=61, lines=2.0)
    found = every.numbers
    assert found["lines"] == [2.0, 1.0, 0.5]
    for crossing in found["crossings"]:
        mode = found["modes"][crossing["mode"] - 1]
        at = np.interp(crossing["speed"], found["speed"], mode["frequency"])
        assert at == pytest.approx(crossing["line"] * crossing["speed"], rel=2e-3)
    for line in found["lines"]:
        speeds = [crossing["speed"] for crossing in found["crossings"] if crossing["line"] == line]
        assert sorted(column(every, f"meets {line:g}x")) == sorted(speeds)


COUNTER = ["stator.speed=-800 rad/s"]


def test_a_stator_that_turns_shakes_the_seal_with_its_own_speed():
    every = whole("fmsr_both_flexible", COUNTER, points=61, speed_to=3000.0)
    found = every.numbers
    assert found["stator_speed"] == -800 and found["stator_crossings"]
    for crossing in found["stator_crossings"]:
        mode = found["modes"][crossing["mode"] - 1]
        at = np.interp(crossing["speed"], found["speed"], mode["signed_frequency"])
        assert abs(at) == pytest.approx(800, rel=2e-3) and (at < 0) == (mode["kind"] == "tilt")
    speeds = sorted(crossing["speed"] for crossing in found["stator_crossings"])
    assert sorted(column(every, "meets the stator's speed")) == speeds
    still = whole("fmsr_both_flexible", points=11)
    assert still.numbers["stator_crossings"] == [] and len(still.tables[0].columns) < len(every.tables[0].columns)


def test_massless_ring_has_one_tilt_mode_and_no_rate():
    found = answer("massless_ring", points=11)
    assert [m["kind"] for m in found["modes"]] == ["tilt", "axial"]


def test_a_seal_that_turns_nothing_has_both_its_tilt_modes():
    # A gas dam at rest in its own cone has no cross-coupling: both tilts are one frequency, and neither mode turns.
    found = answer("gas_dam_reference", points=5)
    tilts = [mode for mode in found["modes"] if mode["kind"] == "tilt"]
    assert [mode["kind"] for mode in found["modes"]] == ["tilt", "tilt", "axial"]
    assert [mode["direction"] for mode in tilts] == ["forward", "backward"]
    assert tilts[0]["frequency"] == pytest.approx(tilts[1]["frequency"], rel=1e-9)
    # I x'' + D x' + K x = 0 with what support and film have.
    scene = read_scenario(SCENARIOS / "gas_dam_reference.toml").scene
    stiffness, damping = scene.stator.support.tilt()
    film, _ = Model(scene).film_matrices()
    inertia = scene.stator.transverse_inertia
    root = np.roots([inertia, damping, stiffness + film[1, 1]])[0]
    assert tilts[0]["frequency"][-1] == pytest.approx(abs(root.imag), rel=1e-6)
    assert tilts[0]["growth_rate"][-1] == pytest.approx(root.real, rel=1e-6)


def test_modes_of_one_frequency_are_numbered_alike_whatever_the_speeds():
    for points in (9, 10):
        directions = [mode["direction"] for mode in answer("fms_reference", points=points)["modes"]]
        assert directions == ["forward", "backward", "axial"]


def test_modes_that_grow_at_every_speed_are_named():
    # Faces that open inwards: the film pushes the ring away, axially and in tilt.
    film = ("film.coning=-0.5 mrad", "film.clearance=12 um")
    found = answer("fms_reference", film, points=31)
    growing = [k for k, mode in enumerate(found["modes"], 1) if min(mode["growth_rate"]) > 0]
    assert growing == [1, 3]
    assert not any(min(mode["growth_rate"]) > 0 for mode in answer("fms_reference", points=31)["modes"])
