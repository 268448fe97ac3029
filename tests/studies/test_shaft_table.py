"""A seal handed to rotor models: its table beside a formula, as DyRoBeS reads it, and in a rotor of ROSS."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from command import SCENARIOS

import sealdyn

# Film, and the stator of Green (1989) on its springs, SI.
K, D = 3000.0, 1.5
FILM = {"tilt_stiffness": K, "tilt_damping": D, "axial_stiffness": 4e6, "axial_damping": 2000.0}
SPEEDS = (300.0, 500.0, 620.0)


@pytest.fixture(scope="module")
def table():
    given = {"film.model": "linear", "film.coefficients": FILM}
    return sealdyn.shaft_table(SCENARIOS / "fms_reference.toml", SPEEDS, overrides=given)


def by_hand(w):
    """What the shaft feels axially and in tilt, g_x + i g_y, of a film before a stator on springs: in series, for a
    motion exp(iwt), complex."""
    axial, tilt = 4e6 + 2000j * w, K + 1j * D * (w - 0.5 * w)
    ring = 5e5 + 300j * w - w**2, 0.5 * (5e5 + 300j * w) * 0.04**2 - 8e-4 * w**2
    return axial - axial**2 / (axial + ring[0]), tilt - tilt**2 / (tilt + ring[1])


def test_the_table_is_film_and_ring_in_series(table):
    assert table["speed"] == table["frequency"] == list(SPEEDS)
    for w, stiffness, damping in zip(SPEEDS, table["stiffness"], table["damping"], strict=True):
        z = np.array(stiffness) + 1j * w * np.array(damping)
        axial, tilt = by_hand(w)
        assert z[0, 0] == pytest.approx(axial, rel=1e-9)
        assert z[1, 1] - 1j * z[1, 2] == pytest.approx(tilt, rel=1e-9)


@pytest.mark.parametrize("speeds", [[0.0], ["3000 m"], [float("inf")]])
def test_speeds_that_there_are_not_are_refused(speeds):
    with pytest.raises(sealdyn.ScenarioError) as error:
        sealdyn.shaft_table(SCENARIOS / "fms_reference.toml", speeds)
    assert error.value.key == "speeds"


def test_dyrobes_finds_the_tilts_at_their_places(table):
    first, *lines = sealdyn.dyrobes_table(table, 3, "two\nlines").splitlines()
    assert first.split("  ") == ["3, 3, 24, 0, 0, 0, 0", "two lines"]
    for w, line, stiffness, damping in zip(SPEEDS, lines, table["stiffness"], table["damping"], strict=True):
        rpm, *numbers = map(float, line.split(","))
        assert rpm == pytest.approx(w * 60 / (2 * np.pi), rel=1e-8) and len(numbers) == 24
        assert not any(numbers[:12]) and not any(numbers[20:])
        expected = [*np.array(stiffness)[1:, 1:].ravel(), *np.array(damping)[1:, 1:].ravel()]
        assert numbers[12:20] == pytest.approx(expected, rel=1e-8)


# A disk in the middle of a light and stiff shaft, in a radial bearing without damping; frequencies of its modes at each
# speed, those of the shaft's own bending left out.
MASS, INERTIA, POLAR = 2.0, 0.01, 0.015
ROTOR = f"""
import json, runpy, sys
import ross as rs
seal = runpy.run_path(sys.argv[1])["FaceSeal"](1, json.load(open(sys.argv[2])))
light = rs.Material("light", rho=0.1, E=2e13, G_s=8e12)
shaft = [rs.ShaftElement(0.05, 0.0, 0.1, material=light) for _ in range(2)]
disk = rs.DiskElement(n=1, m={MASS}, Id={INERTIA}, Ip={POLAR})
rotor = rs.Rotor(shaft, [disk], [rs.BearingElement(n=1, kxx=1e7, cxx=0.0), seal])
modes = {{w: rotor.run_modal(w, num_modes=36, sparse=False).evalues for w in {SPEEDS}}}
print(json.dumps([[[float(s.real), float(s.imag)] for s in modes[w] if 1.0 < abs(s.imag) < 1e5] for w in modes]))
"""


@pytest.mark.slow
def test_a_rotor_of_ross_has_the_modes_that_the_seal_gives_it(table, tmp_path):
    """Axial motion, and backward and forward tilt, at three speeds: roots of m s^2 + d s + k, and of the tilts with the
    disk's gyroscopic moment.  SEALDYN_ROSS names the Python of an environment with ROSS."""
    python = os.environ.get("SEALDYN_ROSS", sys.executable)
    if subprocess.run([python, "-c", "import ross"], capture_output=True).returncode:
        pytest.skip("ROSS is not here: pip install ross-rotordynamics 'plotly<6', and SEALDYN_ROSS=its python")
    (tmp_path / "seal.json").write_text(json.dumps(table))
    words = [python, "-c", ROTOR, SCENARIOS / "ross_face_seal.py", tmp_path / "seal.json"]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    for w, modes in zip(SPEEDS, found, strict=True):
        there = np.array([complex(*one) for one in modes])
        axial, (stiffness, damping) = by_hand(w)[0], of_tilts(table, w)
        expected = [*np.roots([MASS, axial.imag / w, axial.real]),
                    *np.roots([INERTIA, damping - 1j * POLAR * w, stiffness])]  # fmt: skip
        for root in expected:
            # Complex tilts have one root for two of real ones.
            assert np.min(np.abs(there - root)) < 1e-4 * abs(root), (w, root, there)


def of_tilts(table, w):
    """Stiffness and damping of the tilts as a table has them at a speed, complex: k - i k_xy, d - i d_xy."""
    both = (np.array(table[name][table["speed"].index(w)]) for name in ("stiffness", "damping"))
    return tuple(matrix[1, 1] - 1j * matrix[1, 2] for matrix in both)
