"""Both rings flexible in the study `transmissibility`: Green's conjecture, where which arrangement is best, in time."""

import numpy as np
import pytest
from command import SCENARIOS
from in_process import InProcess
from oracles import tilt_roots, tilts_in_turning_axes

from sealdyn import read_scenario
from sealdyn.closed_form.green_1989 import GREEN_1989_ROUNDED
from sealdyn.scene.scene import arrangement, counterpart, with_both_flexible_rings
from sealdyn.studies import transmissibility
from sealdyn.studies.transmissibility import Settings

K_F, D_F = 5790.583579096709, 4.082073628553869
RING = (8e-4, 16e-4, 400.0, 0.24)


def whole(file="fmr_reference.toml", overrides=("film.model=linear",), **settings):
    return transmissibility.run(read_scenario(SCENARIOS / file, overrides), Settings(**settings), InProcess())


def answer(*args, **settings):
    return whole(*args, **settings).numbers


@pytest.fixture(scope="module", params=["fmr_reference.toml", "fms_reference.toml"])
def both(request):
    """Either scenario makes the same three seals."""
    return whole(request.param, points=41, speed_to=4000.0, time_points=8)


@pytest.fixture
def greens(both):
    return both.numbers


@pytest.mark.core
def test_greens_conjecture_and_where_it_fails(greens):
    (row,) = [r for r in greens["table"] if r["quantity"] == "maximum_relative_misalignment"]
    for road in ("formula", "linear_algebra", "time_domain"):
        assert row[road] == pytest.approx(dict(fmr=0.1256, fms=0.1411, fmsr=0.0729), abs=5e-5)
    pairs = {tuple(pair["seals"]): pair["best"] for pair in greens["pairs"]}
    assert [s["seal"] for s in pairs["fmr", "fmsr"]] == ["fmsr", "fmr", "fmsr"]
    ends = [s["to"] for s in pairs["fmr", "fmsr"]]
    # The roots of tests/closed_form/test_both_rings.py, in 40 digits.
    assert ends == pytest.approx([1346.0508, 2327.1723, 4000.0], abs=1e-3)
    assert pairs["fms", "fmsr"] == [{"seal": "fmsr", "from": 0.0, "to": 4000.0}]
    assert greens["best"]["total"] == pairs["fmr", "fmsr"]
    assert [s["seal"] for s in greens["best"]["dynamic"]] == ["fmsr", "fmr"]
    assert [s["seal"] for s in greens["best"]["static"]] == ["fmsr"]


def test_the_critical_misalignment_of_two_floating_rings_is_the_smaller(both, greens):
    """It was that of the stator's alone, the kinder one; and no key was named."""
    rows = {row["quantity"]: row["formula"] for row in greens["table"]}
    static, dynamic = (rows[f"{kind}_transmissibility"]["fmsr"] for kind in ("static", "dynamic"))
    # Faces of parallel edges' clearance C touch at the tilt C / r_o times this.
    stator = rows["critical_misalignment"]["fmr"] * rows["static_transmissibility"]["fmr"]
    touch = stator + rows["dynamic_transmissibility"]["fmr"]
    sizes = {"stator": (touch - dynamic) / static, "rotor": (touch - static) / dynamic}
    assert rows["critical_misalignment"]["fmsr"] == pytest.approx(min(sizes.values()), rel=1e-9)
    ring = min(sizes, key=sizes.get)
    keys = [row[6] for row in both.tables[0].rows if row[1] == "formula"]
    assert keys == ["stator.misalignment", "rotor.runout", f"{ring}.misalignment"]


def test_lines_and_points_in_time_are_the_rings_in_turning_axes(greens):
    """Measured: amplitudes 2e-8 apart, phases 4e-6 deg."""
    assert greens["roads_apart"] < 1e-12 and greens["phases_apart"] < 1e-9

    def seen(w, frame):
        own = {"own_rotor": 1.0} if frame else {"own_stator": 1.0}
        tilt = tilts_in_turning_axes(frame, w, K_F, D_F, RING, RING, **own)
        # Counted from the ring that carries the forcing.
        x, y = -tilt if frame else tilt
        return np.hypot(x, y), -np.degrees(np.arctan2(y, x))

    fmsr = greens["fmsr"]
    for i, w in enumerate(greens["speed"][1:], 1):
        for name, frame in (("static", 0.0), ("dynamic", w)):
            size, phase = seen(w, frame)
            assert fmsr[name][i] == pytest.approx(size, rel=1e-9)
            assert (fmsr[f"{name}_phase"][i] - phase + 180) % 360 - 180 == pytest.approx(0.0, abs=1e-8)
    rows = [r for r in greens["time_domain"] if r["seal"] == "fmsr"]
    assert len(rows) >= 8 and not any("failed" in r for r in rows)
    for row in rows:
        sizes = []
        for name, frame in (("static", 0.0), ("dynamic", row["speed"])):
            size, phase = seen(row["speed"], frame)
            sizes.append(size)
            assert row[name] == pytest.approx(size, rel=1e-6)
            assert (row[f"{name}_phase"] - phase + 180) % 360 - 180 == pytest.approx(0.0, abs=1e-3)
        assert row["total"] == pytest.approx(sum(sizes), rel=1e-6)


def test_each_seal_is_best_only_where_it_has_a_steady_state():
    """A long rotor (c = 3): two equal supports, one of which turns, are damped up to 1815 rad/s only."""
    found = answer(overrides=["film.model=linear", f"rotor.polar_inertia={8e-4 / 3!r}"], points=61, speed_to=9000.0,
                   time_points=0)  # fmt: skip
    inertia, polar, k_s, d_s = 8e-4, 8e-4 / 3, 400.0, 0.24

    def growth(w):
        """Largest real part of the roots of both rings' equations, from their matrices."""
        film = K_F - 0.5j * w * D_F
        stiffness = np.array([[k_s + film, -film], [-film, k_s - 1j * w * d_s + film]])
        damping = np.array([[d_s + D_F, -D_F], [-D_F, d_s + D_F - 1j * polar * w]])
        matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness / inertia, -damping / inertia]])
        return np.linalg.eigvals(matrix).real.max()

    (end,) = found["stability_ends"]["fmsr"]
    assert growth(0.9999 * end) < 0 < growth(1.0001 * end)
    for name, flexible in (("fmr", "rotor"), ("fms", "stator")):
        (other,) = found["stability_ends"][name]
        around = [
            tilt_roots(w, flexible, inertia=inertia, polar=polar, k_s=k_s, d_s=d_s, k=K_F, d=D_F).real.max()
            for w in (0.9999 * other, 1.0001 * other)
        ]
        assert around[0] < 0 < around[1] and other > end
    last = found["best"]["static"]
    assert [s["seal"] for s in last] == ["fmsr", "fms", "fmr", None]
    assert [s["to"] for s in last[:3]] == [found["stability_ends"][name][0] for name in ("fmsr", "fms", "fmr")]


def test_the_ring_stands_under_both_sides():
    scene = read_scenario(SCENARIOS / "fmr_reference.toml").scene
    both = with_both_flexible_rings(scene)
    assert arrangement(both) == "FMSR" and with_both_flexible_rings(both) == both
    assert both.rotor == scene.rotor and both.stator.misalignment == scene.stator.misalignment
    for name in ("mass", "transverse_inertia", "polar_inertia", "support"):
        assert getattr(both.stator, name) == getattr(scene.rotor, name)
    other = with_both_flexible_rings(counterpart(scene))
    assert other.stator == both.stator and other.rotor == both.rotor


def test_greens_groups_of_his_seal(greens):
    """As he prints them, rounded; b, c and R exactly."""
    groups = greens["groups"]
    for ring in ("rotor", "stator"):
        for name in ("transverse_inertia", "support_stiffness", "support_damping"):
            assert groups[ring][name] == pytest.approx(GREEN_1989_ROUNDED[name], rel=1e-2 / 1.63)
        assert groups[ring]["inertia_ratio"] == pytest.approx(0.5)
    assert groups["film_stiffness"] == pytest.approx(GREEN_1989_ROUNDED["film_stiffness"], abs=5e-5)
    assert groups["film_damping"] == pytest.approx(GREEN_1989_ROUNDED["film_damping"], abs=5e-5)
    assert groups["coning"] == pytest.approx(12.5) and groups["radius_ratio"] == pytest.approx(0.8)
    # 6 mu w (r_o / C)^2 (1 - R)^2
    assert groups["seal_parameter"] == pytest.approx(6 * 0.5e-3 * 1000 * 4000**2 * 0.2**2)
    assert groups["pressure_drop"] == pytest.approx(0.5e6 / groups["seal_parameter"])


def test_a_seal_of_equal_groups_answers_alike():
    """Twice the radii and clearance, half the speed, other pressures: the same groups, the same transmissibilities."""
    scenario = read_scenario(SCENARIOS / "fmr_reference.toml", ["film.model=linear"])
    # Stiffness, damping and inertia grow as S r_o^4 / C, that over w, that over w^2: S halves, r_o^4 / C is 8 times.
    other = read_scenario(SCENARIOS / "fmr_reference.toml", [
        "film.model=linear", "shaft.speed=500", "film.inner_radius=0.064", "film.outer_radius=0.08",
        "film.clearance=2e-5", f"film.outer_pressure={0.25e6}", f"rotor.transverse_inertia={8e-4 * 16}",
        f"rotor.polar_inertia={16e-4 * 16}", f"rotor.support.axial_stiffness={5e5}",
        f"rotor.support.axial_damping={600.0}", "rotor.support.radius=0.08",
    ])  # fmt: skip
    one, two = (transmissibility.run(s, Settings(points=2, time_points=0), InProcess()).numbers
                for s in (scenario, other))  # fmt: skip

    def flat(groups):
        return {f"{a}.{b}": v for a in ("rotor", "stator") for b, v in groups[a].items()} | {
            name: groups[name] for name in ("radius_ratio", "coning", "pressure_drop", "film_stiffness", "film_damping")
        }

    assert flat(two["groups"]) == pytest.approx(flat(one["groups"]), rel=1e-9)
    for row, twin in zip(one["table"][:4], two["table"][:4], strict=True):
        assert row["formula"] == pytest.approx(twin["formula"], rel=1e-9)


def test_no_groups_at_rest():
    found = answer(
        overrides=["film.model=linear", "shaft.speed=0", "run.duration=1", "run.samples=9"], points=3, time_points=0
    )
    assert found["groups"] == {} and found["table"] == []
