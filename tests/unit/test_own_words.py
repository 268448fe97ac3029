"""Scenes of all the families against their equations in other words (tests/own_words.py): right-hand side and what the
certificate looks at, at any state, and one run."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from families import wide
from judge import by_steps
from own_words import OwnSeal, own
from scenes import prepared
from scipy.integrate import DOP853, Radau

from sealdyn.simulation.verification_run import ErrorScales

SEED = 77
# Together everything that `wide` draws but sticking: see test_scenes_have_everything.
SCENES = (6, 12, 13, 17, 18, 23, 31, 33, 36, 39, 42, 63, 64, 89, 338, 396)
ROUGH = (6, 12, 17, 31, 33, 36)
# A speed table with whirl and axial tone; tables of pressure and misalignment; an O-ring beside axial runout.
# Of the last, which is dear, the first quarter.
TRAVELLED = ((18, "adams", DOP853, 1.0), (63, "bdf", Radau, 1.0), (39, "bdf", Radau, 0.25))


@cache
def scene_of(number):
    """What is drawn, its scene with the radial film, a run, its scales, and the seal in own words."""
    drawn = wide(np.random.default_rng([SEED, number]))
    scene = replace(drawn.scene, film=replace(drawn.scene.film, model="radial"))
    run = prepared(scene, drawn.duration, 1e-12)
    return drawn, scene, run, ErrorScales(run), OwnSeal(scene, drawn.duration)


def state_at(random, seal, t, thinnest):
    """Displacements and rates of some tenths of their scales, of which the thinnest film is `thinnest` (m)."""
    scale = np.concatenate([seal.lengths, seal.lengths * seal.rate])
    while True:
        y = scale * random.uniform(-0.6, 0.6, 2 * seal.n)
        if seal.thinnest(t, y) > 0.05 * seal.scene.film.clearance:
            break
    y[0] += (seal.thinnest(t, y) - thinnest) * (-1.0 if seal.names[0] == "stator_z" else 1.0)
    return y


def times_of(random, seal):
    """Anywhere, and within a thousandth of the run after each break of a table."""
    after = [kink + 1e-3 * seal.duration * random.random() for kink in (0.0, *seal.breaks)]
    return [*random.uniform(0.0, seal.duration, 2), *after]


def both(run, scales, seal, t, y):
    """Rates and columns of the program and in own words, both with the program's unknowns."""
    n, names = seal.n, run.model.unknowns.names
    order = np.array([seal.names.index(name) for name in names])
    order = np.concatenate([order, n + order])
    segment = run.segment(max(k for k in range(len(run.intervals)) if run.intervals[k].time <= t))
    tau, full, rates = t - segment.time, np.zeros(segment.size), np.empty(segment.size)
    full[: 2 * n] = y[order]
    segment.rhs(tau, full, rates)
    motion = segment.motion(full[None, :], np.zeros((1, segment.size)))
    columns = scales.of(segment, np.array([tau]), *motion)[0]
    own_columns = seal.columns(t, y)
    return (rates[: 2 * n], columns), (seal.rates(t, y)[order], own_columns[[*order, *range(2 * n, 2 * n + 5)]])


def load_of(scales, columns, n):
    """The load (N) by which errors are told: the closing force or, in a squeezed film, the film's."""
    return max(scales.force, abs(columns[2 * n]))


def rate_scales(run, load):
    """What this load does to each rate of the rings."""
    scene, found = run.model.scene, []
    for name in run.model.unknowns.names:
        ring = getattr(scene, name.split("_")[0])
        axial = name.endswith("_z")
        found.append(load / ring.mass if axial else load * scene.film.outer_radius / ring.transverse_inertia)
    return np.array(found)


@pytest.mark.core
def test_scenes_have_everything():
    drawn = [scene_of(number)[0] for number in SCENES]
    words = {word for one in drawn for word in one.words}
    assert words >= {
        "fms", "fmr", "fmsr", "flat", "cone", "negative cone", "contact", "o-ring", "angular tone", "axial tone",
        "whirl", "axial runout", "counter-rotating", "pressure table", "viscosity table", "misalignment table",
        "speed table", "rub", "throw",
    }  # fmt: skip
    laws = {one.scene.contact.law for one in drawn if one.scene.contact}
    assert laws == {"christensen", "greenwood-williamson"}


def apart(number, random, share, t):
    """How far program and own words are apart at a state with this `share` of the clearance left: rates (n,) and film
    loads (5,: force, two moments, leakage, torque) over their scales; and what of the rates is not the film's."""
    _, scene, run, scales, seal = scene_of(number)
    n, outer = seal.n, scene.film.outer_radius
    y = state_at(random, seal, t, share * scene.film.clearance)
    (rates, columns), (own_rates, own_columns) = both(run, scales, seal, t, y)
    np.testing.assert_array_equal(rates[:n], own_rates[:n])
    np.testing.assert_allclose(columns[: 2 * n], own_columns[: 2 * n], rtol=1e-13, atol=1e-13)
    load = load_of(scales, columns, n)
    leakage, torque = max(scales.leakage, abs(columns[-2])), max(scales.torque, abs(columns[-1]))
    of_loads = (columns - own_columns)[2 * n :] / [load, load * outer, load * outer, leakage, torque]
    of_rates = ((rates - own_rates) / np.tile(rate_scales(run, load), 2))[n:]
    # The film pushes the stator away from the rotor.
    film = [(1.0 if name.startswith("stator") else -1.0) * of_loads[k % 3] for k, name in enumerate(seal.names)]
    order = [seal.names.index(name) for name in run.model.unknowns.names]
    return np.abs(of_rates), np.abs(of_loads), np.abs(of_rates - np.array(film)[order])


@pytest.mark.parametrize("number", SCENES)
def test_rates_and_loads(number):
    """Equal to 1e-9 of the load: films of moderate thickness, thin ones and, of rough faces, those which touch as far
    as the film is not continued."""
    _, scene, _, _, seal = scene_of(number)
    random = np.random.default_rng([SEED, number, 1])
    thin = 0.7 * 3.0 * scene.contact.roughness / scene.film.clearance if scene.contact else 0.02
    for share in (0.6, 0.3 if thin < 0.3 else thin, thin):
        for t in times_of(random, seal):
            of_rates, of_loads, _ = apart(number, random, share, t)
            assert max(of_rates.max(), of_loads.max()) <= 1e-9


@pytest.mark.parametrize("number", ROUGH)
def test_rough_faces_pressed_together(number):
    """Asperities of faces that overlap, and the film between them, which is continued below 0.6 of the asperity height
    and has a bend there: equal to 1e-9 of the load."""
    _, scene, _, _, seal = scene_of(number)
    random = np.random.default_rng([SEED, number, 2])
    for of_height in (0.5, 0.1, -0.3):
        share = of_height * 3.0 * scene.contact.roughness / scene.film.clearance
        for t in times_of(random, seal):
            assert max(part.max() for part in apart(number, random, share, t)) <= 1e-9


@pytest.mark.parametrize(("number", "method", "kind", "share"), TRAVELLED)
def test_runs(number, method, kind, share):
    """A whole run by `solve` and one in own words, both far sharper than the accuracy by which they are compared."""
    drawn, scene, run, scales, seal = scene_of(number)
    assert run.model.unknowns.names == seal.names
    times = np.linspace(0.0, share * drawn.duration, 40, endpoint=False)
    columns, _ = by_steps(prepared(scene, drawn.duration, 1e-9), scales, times, method, 1e-11)
    others = own(scene, drawn.duration, run.y0[: 2 * seal.n], times, 1e-10, kind)
    assert scales.errors(columns, others).max() < 1e-7
