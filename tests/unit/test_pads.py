"""Rayleigh-step pads: their shape, the film over them against collocation, what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from collocated_gas import collocated
from command import SCENARIOS
from gas_faces import PARTS, gap_state, gas_film, steady
from scenes import film as liquid
from scenes import fms

from sealdyn import read_scenario
from sealdyn.dynamics.model import Model
from sealdyn.faces import geometry
from sealdyn.films import film_of
from sealdyn.films.gas_reynolds import film as gas
from sealdyn.scene.film import Pads, depth_of, pads_errors
from sealdyn.scene.scene import SceneError
from sealdyn.studies._runner import run_study

R_I, R_O, CLEARANCE = 0.032, 0.040, 5e-6
CLOSED = Pads(count=6, depth=8e-6, angle=0.5, inner_radius=0.034, outer_radius=0.038, edge=2e-4, phase=0.2)
# Open at both radii, with flanks that spectral points see.
OPEN = Pads(count=3, depth=4e-6, angle=0.9, inner_radius=R_I, outer_radius=R_O, edge=7e-3)


def padded(*pads, cells=(12, 48), **changes):
    return replace(gas_film(cells, inner_pressure=1.5e5, outer_pressure=1e5, clearance=CLEARANCE, **changes), pads=pads)


def test_a_pad_is_as_deep_and_as_long_as_it_says():
    film, theta = padded(CLOSED), np.linspace(0.0, 2.0 * math.pi, 7201)[:-1]
    assert depth_of(film, 0.036, 0.2) == pytest.approx(8e-6, rel=1e-6)
    assert depth_of(film, 0.036, 0.2 + math.pi / 6) == pytest.approx(0.0, abs=1e-13)
    assert depth_of(film, 0.0325, 0.2) < 1e-11 > depth_of(film, 0.0395, 0.2)
    # Half of it in the middle of the flanks.
    for r, angle in ((0.034, 0.2), (0.036, 0.45), (0.036, -0.05)):
        assert depth_of(film, r, angle) == pytest.approx(4e-6, rel=1e-3)
    assert depth_of(film, 0.036, theta).mean() == pytest.approx(8e-6 * 6 * 0.5 / (2 * math.pi), rel=1e-6)
    # Open where it reaches to the edge of the face.
    assert depth_of(padded(OPEN), np.array([R_I, 0.036, R_O]), 0.0) == pytest.approx([4e-6] * 3, rel=1e-1)


def height(r, theta):
    """The film over the open pads in words of its own."""
    way, pitch = 0.036 / 7e-3, 2 * math.pi / 3
    h = CLEARANCE + r * (4e-5 * np.sin(theta) + 5e-5 * np.cos(theta))
    for k in range(-2, 6):
        x = theta - k * pitch
        h = h + 2e-6 * (np.tanh(way * (x + 0.45)) - np.tanh(way * (x - 0.45)))
    return h


def test_the_film_over_pads_tends_to_collocation():
    """Force, moments, flows and torque of tilted faces at speed."""
    exact = collocated(padded(OPEN), height, lambda r, theta: 0.0 * r, 2000.0, radii=16, angles=72)
    errors = []
    for cells in ((6, 36), (12, 72), (24, 144)):
        film = padded(OPEN, cells=cells)
        s = gap_state(film, 2000.0, gx=4e-5, gy=-5e-5)
        steady(gas.parameters(film, CLEARANCE), s)
        apart = s[PARTS] - exact
        errors.append([np.linalg.norm(apart[k]) / np.linalg.norm(exact[k]) for k in ([0], [1, 2], [3, 4], [5])])
    # Measured 2e-4, 2e-3, 7e-4, 4e-4 at the finest.
    assert np.all(np.array(errors[-1]) < 6e-3), errors
    assert np.all(np.array(errors[-1]) < 0.45 * np.array(errors[-2])), errors


def lift(pads, cells=(8, 192), spin=3000.0):
    film = padded(pads, cells=cells)
    film = replace(film, inner_pressure=1e5)
    s = gap_state(film, spin)
    steady(gas.parameters(film, CLEARANCE), s)
    return s[geometry.FORCE] - 1e5 * math.pi * (R_O**2 - R_I**2)


def test_steps_converge_as_cells_and_flanks_get_finer():
    lifts = [lift(CLOSED, cells) for cells in ((8, 96), (16, 192), (32, 384))]
    assert abs(lifts[2] - lifts[1]) < 0.5 * abs(lifts[1] - lifts[0]), lifts
    sharper = [lift(replace(CLOSED, edge=edge), (16, 288)) for edge in (8e-4, 4e-4, 2e-4)]
    assert abs(sharper[2] - sharper[1]) < abs(sharper[1] - sharper[0]), sharper


@pytest.mark.core
def test_pads_lift_with_the_speed():
    even = replace(CLOSED, phase=0.0)
    still, slow, fast = (lift(even, spin=spin) for spin in (0.0, 1000.0, 3000.0))
    assert abs(still) < 1e-6 and 0.0 < slow < fast
    # Turning the other way lifts as much: pads are symmetric.
    assert lift(even, spin=-3000.0) == pytest.approx(fast, rel=1e-9)


def scene(film, **stator):
    made = fms(film=film)
    return replace(made, stator=replace(made.stator, **stator))


def test_which_films_and_faces_take_them():
    assert film_of(scene(padded(CLOSED))) is gas.FILM
    for film in (replace(liquid("radial"), pads=(CLOSED,)), replace(padded(CLOSED), model="gas_dam")):
        with pytest.raises(SceneError, match="pads"):
            film_of(scene(film))
    with pytest.raises(SceneError, match="stands still"):
        film_of(scene(padded(CLOSED), speed=5.0))


@pytest.mark.parametrize(
    "key, changes",
    [("count", {"count": 0}), ("depth", {"depth": -1e-6}), ("angle", {"angle": 1.1}), ("angle", {"angle": 0.0}),
     ("inner_radius", {"inner_radius": 0.031}), ("inner_radius", {"inner_radius": 0.039}),
     ("edge", {"edge": 0.0}), ("edge", {"edge": 2e-3})],
)  # fmt: skip
def test_pads_that_cannot_be(key, changes):
    ((found, *_),) = pads_errors(padded(replace(CLOSED, **changes)))
    assert found == f"pads.0.{key}"
    assert pads_errors(padded(CLOSED)) == []


def test_the_clearance_of_a_padded_face_is_held_and_studies_speak():
    held = Model(scene(padded(CLOSED, cells=(8, 48))), 1e-3)
    assert abs(held.axial_shift()) < 1e-9 * CLEARANCE
    scenario = read_scenario(SCENARIOS / "rayleigh_pads.toml")
    with pytest.raises(SceneError, match="the same all around"):
        run_study("transmissibility", scenario, None, workers=1)
