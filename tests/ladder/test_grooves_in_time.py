"""Films over grooves in motion: the film of a run against the steady aligned film, linear theory of one pitch, today's
gas film, forced motion, the fixed point of a runout, and a row computed elsewhere."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gas_faces import gap_state
from grooved_faces import R_I, R_O
from scenes import run, started
from scipy.optimize import brentq, fsolve
from scipy.sparse.linalg import splu

from sealdyn.analysis.shooting import ForcedWave
from sealdyn.dynamics.condensation import FilmDerivatives
from sealdyn.dynamics.imposed_motion import rest_state
from sealdyn.dynamics.interface import Interface
from sealdyn.dynamics.model import Model
from sealdyn.faces.geometry import (
    DZ,
    DZ_RATE,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    MOMENT_X,
    MOMENT_Y,
    TORQUE,
)
from sealdyn.films import film_named, film_of
from sealdyn.films._grooved import mesh
from sealdyn.films._grooved.aligned import aligned_film, conditions_of
from sealdyn.films._grooved.balance import steady
from sealdyn.films._grooved.cells import _mesh, halved, land_rates, node_table, prepared, state, whole
from sealdyn.films._grooved.film import leaving
from sealdyn.films._grooved.motion import (
    Motion,
    Ring,
    axial_law,
    own_tilt,
    relative_tilt,
    root_near,
    support_law,
    tilt_law,
)
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film, Reynolds
from sealdyn.scene.fluid import NORMAL_PRESSURE, NORMAL_TEMPERATURE, GasReynolds
from sealdyn.scene.patterns import Grooves
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene
from sealdyn.simulation.film_error import cell_error
from sealdyn.simulation.verification_run import ErrorScales

W = 1000.0
COARSE = dict(gas_reynolds=GasReynolds(columns=4), reynolds=Reynolds(columns=4, cavitation="none"))
GAS = Film(R_I, R_O, 5e5, 1e5, viscosity=1.8e-5, gas="air", temperature=300.0, clearance=3e-6, **COARSE)
LIQUID = Film(R_I, R_O, 2.1e6, 2e6, viscosity=1e-3, clearance=6e-6, **COARSE)
SPIRAL = Grooves(5, 6e-6, 0.0555, R_O, 0.5, angle=math.radians(15.0))
TWELVE = replace(SPIRAL, count=12)
SUPPORT = Support(axial_stiffness=1.64e4, axial_damping=1e3, tilt_stiffness=3e5, tilt_damping=50.0)
RING = dict(mass=0.2, transverse_inertia=3.5e-4, support=SUPPORT)
FREE = Ring(0.2, 3.5e-4, 1.64e4, 1e3, 3e5, 50.0)


def seal(table=GAS, grooves=SPIRAL, face="rotor", floats="stator", speed=W, stator_speed=0.0, stator=None, rotor=None):
    """A scene with grooves in one face; `stator`, `rotor`: more of each ring."""
    parts = {"stator": stator or {}, "rotor": rotor or {}}
    for name in floats.split():
        parts[name] = RING | parts[name]
    parts[face] = parts[face] | {"grooves": [grooves]}
    rings = {"rotor": Rotor(**parts["rotor"]), "stator": Stator(speed=stator_speed, **parts["stator"])}
    return Scene(shaft=Shaft(speed=speed), film=table, **rings)


def ready(scene):
    """Film, block, unknowns (n,) not yet known, and the gap state of aligned faces."""
    film = film_of(scene)
    f = film.parameters(film.whole(film.prepared(scene)), scene.film.clearance)
    s = gap_state(replace(scene.film, temperature=scene.film.temperature or 300.0), scene.shaft.speed)
    return film, f, np.empty(len(film.unknowns(f).names)), s


def tilted(film, f, x, s, tilt=2e-5 - 1e-5j, **slots):
    """The film steady at a tilt (rad), and `slots` of the gap state by name in lower case."""
    s[GX], s[GY], s[DZ], s[DZ_RATE], s[GX_RATE] = tilt.real, tilt.imag, 2e-7, 1e-4, 3e-3
    s[28] = 300.0
    for name, value in slots.items():
        s[globals()[name.upper()]] = value
    assert film.start(f, s, x) == 0
    return x


@pytest.mark.core
@pytest.mark.parametrize("table, face", [(GAS, "rotor"), (GAS, "stator"), (LIQUID, "rotor")])
def test_the_aligned_film_is_the_steady_one_of_a_pitch(table, face):
    scene = seal(table, face=face, floats="stator" if face == "rotor" else "rotor")
    film, f, x, s = ready(scene)
    assert film.start(f, s, x) == 0
    film.flow(f, s, x)
    found = aligned_film(scene, table.clearance, 4).coarse
    normal = NORMAL_TEMPERATURE / (300.0 * NORMAL_PRESSURE) if table.gas else 1.0
    assert s[FORCE] == pytest.approx(found.force, rel=1e-10)
    assert s[[FLOW_INNER, FLOW_OUTER]] == pytest.approx(normal * np.array(found.flows), rel=1e-7)
    assert s[TORQUE] == pytest.approx(found.torque, rel=1e-4)
    assert np.abs(s[[MOMENT_X, MOMENT_Y]]).max() < 1e-12 * s[FORCE] * R_O


@pytest.mark.parametrize("table", [GAS, replace(GAS, gas_reynolds=GasReynolds(slip=True, columns=4)), LIQUID])
def test_derivatives_are_those_of_residual_and_wrench(table):
    film, f, x, s = ready(seal(table))
    x = tilted(film, f, x, s)
    x *= 1.0 + 0.05 * np.sin(17.0 * np.arange(len(x)))
    pace, ways = 123.0, FilmDerivatives(film, film.unknowns(f), f)
    v = x * np.cos(5.0 * np.arange(len(x)))
    sides = []
    for step in (1e-6, -1e-6):
        res = np.empty(len(x))
        film.residual(f, s, x + step * v, step * pace * v, res)
        film.wrench(f, s, x + step * v)
        sides.append(np.concatenate([res, s[FORCE : FORCE + 3]]))
    found = np.concatenate([ways.matrix(s, x, 0.0 * x, pace) @ v, ways.wrench(s, x) @ v])
    difference = (sides[0] - sides[1]) / 2e-6
    for part in (slice(0, len(x)), slice(len(x), len(x) + 1), slice(len(x) + 1, None)):
        # A force of some kN is known to rounding, of which its difference shows a millionfold.
        least = 1e-9 * s[FORCE] * (1.0 if part.stop == len(x) + 1 else R_O) if part.start else 0.0
        assert found[part] == pytest.approx(difference[part], abs=1e-7 * np.abs(difference[part]).max() + least)


@pytest.mark.parametrize("table", [GAS, LIQUID])
def test_what_the_cells_store_comes_over_the_edges(table):
    """To rounding, at any pressures, tilted and squeezed."""
    film, f, x, s = ready(seal(table))
    x = tilted(film, f, x, s)
    x *= 1.0 + 0.1 * np.sin(17.0 * np.arange(len(x)))
    film.flow(f, s, x)
    land, p = state(f, s, x)
    out, res, nodes = np.empty(p.shape), np.empty(len(x)), node_table(f)
    leaving(f, s, p, out)
    film.residual(f, s, x, 0.0 * x, res)
    free = nodes[4] >= 0.0
    stored = -float(np.sum(nodes[5][free] * res.reshape(len(p), -1)))
    if not table.gas:
        # The room that the faces make is filled.
        rates = np.empty(p.shape)
        land_rates(f, s, land, rates)
        stored += float(np.sum(nodes[5][free] * rates[:, free]))
    edges = out[:, ~free]
    assert stored == pytest.approx(edges.sum(), abs=1e-12 * np.abs(out).sum())


def test_a_turned_gap_turns_the_moment():
    """Where the pattern stands is where its face has turned to; a whole pitch further all is as before."""
    film, f, x, s = ready(seal())
    found = []
    for angle in (0.0, 0.4, 0.4 + 2.0 * math.pi / 5.0):
        turn = np.exp(1j * angle) if angle < 1.0 else np.exp(0.4j)
        s[27], g = angle, 2e-5 * turn
        s[GX], s[GY], s[GX_RATE], s[GY_RATE] = g.real, g.imag, 0.0, 0.0
        assert film.start(f, s, x) == 0
        film.flow(f, s, x)
        found.append([s[FORCE], complex(s[MOMENT_X], s[MOMENT_Y]) / turn, s[TORQUE], s[FLOW_INNER]])
    for other in found[1:]:
        assert np.abs(np.array(other) / np.array(found[0]) - 1.0).max() < 1e-9


def test_mirrored_grooves_on_a_shaft_that_turns_back():
    """The mirror image: tilts about the mirror's axis change their sign, those across it and forces do not."""
    table, parts = replace(GAS, gas_reynolds=GasReynolds(columns=8)), []
    for sign in (1.0, -1.0):
        grooves = replace(SPIRAL, angle=sign * SPIRAL.angle, depth=2e-6)
        film, f, x, s = ready(seal(table, grooves, speed=sign * W))
        x = tilted(film, f, x, s, sign * 1e-5 + 1.5e-5j, gx_rate=sign * 3e-3)
        film.flow(f, s, x)
        parts.append([s[FORCE], sign * s[MOMENT_X], s[MOMENT_Y], s[FLOW_INNER], sign * s[TORQUE]])
    # Bisections at tips are no mirror images.
    assert parts[0] == pytest.approx(parts[1], rel=2e-3)


def test_without_depth_it_is_the_gas_film_of_plain_faces():
    """In the frame of a stator that stands still, tilted and squeezed; extrapolated, of second order without tips."""
    found, slots = [], [FORCE, MOMENT_X, MOMENT_Y, FLOW_INNER, FLOW_OUTER, TORQUE]
    table = replace(GAS, gas_reynolds=GasReynolds(cells=(24, 96), columns=16, slip=True), coning=1e-4)
    scene = seal(table, replace(SPIRAL, depth=0.0, count=6), "stator", "rotor")
    for some in (halved, lambda whole: whole):
        film, *_, s = ready(scene)
        f = film.parameters(some(whole(film.prepared(scene))), table.clearance)
        x = np.empty(len(film.unknowns(f).names))
        tilted(film, f, x, s)
        film.flow(f, s, x)
        found.append(s[slots])
    known = film_named("gas_reynolds")
    block = known.parameters(table, table.clearance)
    y = np.empty(len(known.unknowns(block).names))
    assert known.start(block, s, y) == 0
    known.flow(block, s, y)
    better = found[1] + (found[1] - found[0]) / 3.0
    assert better == pytest.approx(s[slots], rel=3e-3)


@pytest.mark.core
@pytest.mark.parametrize("table, face", [(GAS, "rotor"), (GAS, "stator"), (LIQUID, "rotor")])
def test_stiffness_and_damping_are_those_of_one_pitch(table, face):
    """Of the whole circle condensed and seen from rest, against one pitch with its Bloch factor."""
    turns = {"stator_speed": -300.0, "speed": 700.0}
    scene = seal(table, face=face, floats="stator" if face == "rotor" else "rotor", **turns)
    interface = Interface(scene, 1e-8)
    film = interface.linear_film(*rest_state(scene, interface.clearance))
    motion = Motion(aligned_film(scene, table.clearance, 4).coarse, 700.0 if face == "rotor" else -300.0)
    for frequency in (50.0, 1000.0, 4e4):
        for found, known in zip(film.matrices(frequency), motion.matrices(frequency), strict=True):
            assert found == pytest.approx(known, abs=1e-8 * np.abs(known[1:]).max(), rel=1e-8)


def forced(film, f, x, s, move, frequency, steps=160, periods=2):
    """Mean over a period of force and moments times e^{-i w t}, of the film between faces that `move(t)` moves: its
    displacements and rates of z and both tilts; trapezoidal steps, Newton's once a step."""
    dt, ways = 2.0 * math.pi / frequency / steps, FilmDerivatives(film, film.unknowns(f), f)
    rate, res, parts = np.zeros(len(x)), np.empty(len(x)), []
    for k in range(periods * steps + 1):
        t = k * dt
        s[DZ : DZ_RATE + 3], s[27] = move(t), W * t
        if k == 0:
            assert film.start(f, s, x) == 0
            film.residual(f, s, x, rate, res)
            rate = -res
            continue
        if k == 1:
            factors = splu(ways.matrix(s, x, rate, 2.0 / dt))
        last, before = x.copy(), rate
        for _ in range(3):
            rate = 2.0 / dt * (x - last) - before
            film.residual(f, s, x, rate, res)
            x = x - factors.solve(res)
        rate = 2.0 / dt * (x - last) - before
        film.wrench(f, s, x)
        if k > (periods - 1) * steps:
            parts.append(s[FORCE : FORCE + 3] * np.exp(-1j * frequency * t))
    return 2.0 * np.mean(parts, axis=0)


@pytest.mark.parametrize("kind", ["axial", "tilt"])
def test_forced_motion_shows_stiffness_and_damping(kind):
    """A small motion of the gap in time, within 1 %."""
    scene, w = seal(), 2.0 * W
    film, f, x, s = ready(scene)
    size = np.array([1e-8, 0.0, 0.0] if kind == "axial" else [0.0, 1e-7, 0.0])

    def move(t):
        return np.concatenate([size * math.cos(w * t), -w * size * math.sin(w * t)])

    answer = forced(film, f, x, s, move, w)
    k, d = Motion(aligned_film(scene, GAS.clearance, 4).coarse, W).matrices(w)
    expected = -(k + 1j * w * d) @ size
    own = slice(0, 1) if kind == "axial" else slice(1, 3)
    assert np.abs(answer - expected)[own].max() < 0.01 * np.abs(expected).max()


def relative(done, runout):
    """Relative tilt (rad) in the frame of the rotor at the samples, and the gap's change (m)."""
    tilt = done.q[:, 1] + 1j * done.q[:, 2]
    return tilt * np.exp(-1j * W * done.times) - runout, done.q[:, 0]


def test_small_motion_of_a_stator_is_that_of_linear_theory():
    scene = seal(stator={"misalignment": 4e-7}, rotor={"runout": 2e-7})
    done = run(scene, 3, accuracy=1e-4, method="ida")
    assert done.outcome.status == "ok" and done.outcome.energy_residual < 1e-4
    motion = Motion(aligned_film(scene, GAS.clearance, 4).coarse, W)
    turning, standing = (relative_tilt(motion, (FREE,), support_law(FREE, 1j * w) * tilt, w)[0]
                         for w, tilt in ((W, -2e-7), (0.0, 4e-7)))  # fmt: skip
    expected = turning + standing * np.exp(-1j * W * done.times)
    found, _ = relative(done, 2e-7)
    last = done.times > 2.0 * 2.0 * math.pi / W
    assert np.abs(found - expected)[last].max() < 0.01 * np.abs(expected).max()


@pytest.mark.parametrize("count, depth", [(1, 3e-7), (2, 2e-6)])
def test_one_or_two_grooves_answer_a_standing_tilt_at_twice_the_speed_too(count, depth):
    """One presses askew besides, in a frame that turns with it."""
    scene = seal(grooves=replace(SPIRAL, count=count, depth=depth), stator={"misalignment": 4e-7})
    done = run(scene, 3, accuracy=1e-4, method="ida")
    motion = Motion(aligned_film(scene, GAS.clearance, 4).coarse, W)
    still, twice = relative_tilt(motion, (FREE,), support_law(FREE, 0.0) * 4e-7, 0.0)
    last, own = done.times > 2.0 * 2.0 * math.pi / W, own_tilt(motion, FREE)
    around = np.exp(1j * W * done.times[last])
    found = done.q[last, 1] + 1j * done.q[last, 2]
    left = np.abs(found - still - twice * around**2 - own * around).max()
    assert done.outcome.status == "ok" and abs(twice) > 0.018 * abs(still)
    # What one groove tilts is some per cent beyond linear theory, less with less depth.
    assert left < 0.01 * abs(still) if count == 2 else left < 0.04 * abs(own)


def fixed_point(scene, runout):
    """Tilt (rad) in the rotor's frame and gap (m) of a stator that follows a runout alone, where all stands still."""
    film, f, x, s = ready(scene)
    closing = Interface(scene, 1e-8).closing
    table, support = scene.film, scene.stator.support
    hold = closing.at(table.inner_pressure, table.outer_pressure, 0.0) if not closing.spring else None
    tilt_k, tilt_d = support.tilt()

    def left(at):
        z, tilt = at[0] * 1e-7, complex(*at[1:]) * 1e-6
        g = tilt - runout
        s[DZ], s[GX], s[GY], s[GX_RATE], s[GY_RATE] = z, g.real, g.imag, -W * g.imag, W * g.real
        assert film.start(f, s, x) == 0
        film.wrench(f, s, x)
        moment = complex(s[MOMENT_X], s[MOMENT_Y])
        moment -= (tilt_k + 1j * W * tilt_d - scene.stator.transverse_inertia * W**2) * tilt
        return [(s[FORCE] - hold - support.axial_stiffness * z) / 10.0, moment.real, moment.imag]

    found = fsolve(left, [0.5, 1e6 * abs(runout) * 0.6, 0.0], xtol=1e-13)
    return complex(*found[1:]) * 1e-6 - runout, found[0] * 1e-7


@pytest.mark.parametrize(
    "turns, accuracy, error", [(2, 1e-5, 3e-10), pytest.param(4, 1e-8, 1e-10, marks=pytest.mark.slow)]
)
def test_runout_alone_ends_on_the_fixed_point_of_the_frame(turns, accuracy, error):
    scene = seal(rotor={"runout": 3e-5})
    tilt, gap = fixed_point(scene, 3e-5)
    wave = ForcedWave(scene, accuracy)
    point = wave.find()
    assert wave.relative(point) == pytest.approx(tilt, abs=1e-13)
    assert point.start[0] == pytest.approx(gap, abs=1e-15)
    done = run(scene, turns, accuracy=accuracy, method="ida", per_turn=8)
    found, gaps = relative(done, 3e-5)
    assert abs(tilt) > 1e-5 and abs(found[-1] - tilt) < error
    assert np.abs(found[-8:] - found[-1]).max() < 2.0 * error
    assert gaps[-1] == pytest.approx(gap, abs=R_O * error)


@pytest.mark.parametrize("face, floats", [("rotor", "rotor"), ("stator", "rotor"), ("rotor", "stator rotor")])
def test_other_arrangements_end_on_their_linear_response(face, floats):
    """A floating rotor with its own misalignment over a tilted stator, grooves in either face; both rings floating."""
    scene = seal(face=face, floats=floats, rotor={"misalignment": 2e-7}, stator={"misalignment": 3e-7})
    done = run(scene, 3, accuracy=1e-4, method="ida")
    motion, _, _ = done.model.segment().steady_motion()
    places, names = done.model.unknowns.among_three(), done.model.unknowns.names
    tilts = [i for i, name in enumerate(names) if "tilt" in name]
    last = done.times > 2.0 * 2.0 * math.pi / W
    expected = np.array([motion(t)[0][places] for t in done.times[last]])
    assert done.outcome.status == "ok"
    assert np.abs(done.q[last] - expected)[:, tilts].max() < 0.01 * np.abs(expected[:, tilts]).max()


def test_a_liquid_over_grooves_runs():
    """Upstream pumping: a full film, whose small motion is linear theory's."""
    face = Film(0.026, 0.031, 8e5, 3e5, viscosity=1e-3, clearance=3e-6, reynolds=Reynolds(columns=4))
    pumping = Grooves(10, 8e-6, 0.026, 0.0285, 0.5, angle=math.radians(-15.0))
    scene = seal(face, pumping, speed=300.0, stator={"misalignment": 2e-7}, rotor={"runout": 2e-7})
    done = run(scene, 1, accuracy=1e-5, method="ida")
    motion = Motion(steady(_mesh(prepared(scene)), conditions_of(scene, face.clearance)), 300.0)
    tilt = done.q[-1, 1] + 1j * done.q[-1, 2]
    expected = 2e-7 + sum(relative_tilt(motion, (FREE,), support_law(FREE, 1j * w) * tilt, w)[0]
                          for w, tilt in ((300.0, -2e-7), (0.0, 2e-7)))  # fmt: skip
    assert abs(tilt - expected) < 0.01 * abs(expected - 2e-7)
    assert done["leakage_inner"][-1] < 0.0


def test_modes_are_the_roots_of_one_pitch_with_the_ring():
    """Of a stator over grooves that turn: its axial motion, and those of the film in which it hardly moves."""
    scene = seal(rotor={"runout": 1e-6})
    modes = Model(scene).linear_scene().modes()
    motion = Motion(aligned_film(scene, GAS.clearance, 4).coarse, W)
    for law, kind, start in (
        (axial_law, "axial", 4.5e4j),
        (axial_law, "axial", -2.7e3),
        (tilt_law, "tilt", -3e3 + 4e2j),
    ):
        root = root_near(law(motion, FREE), start)
        nearest = min((abs(mode.value - root), mode.kind) for mode in modes)
        assert nearest[0] < 1e-7 * abs(root) and nearest[1] == kind
    assert modes[0].value == pytest.approx(root, rel=1e-7) and modes[0].direction == "forward"


def test_a_faster_shaft_lifts_to_the_balance_of_its_speed():
    """From 500 to 1000 rad/s, at the closing force of the slower speed."""
    speed = PiecewiseLinear((0.0, 0.002, 0.012, 0.02), (500.0, 500.0, W, W))
    scene = seal(speed=speed, rotor={"runout": 1e-9})
    done = run(scene, duration=0.02, accuracy=1e-4, method="ida")
    table = film_of(scene).prepared(scene)
    slow, fast = (film_of(scene).opening_law(table, 0.5 * w, w) for w in (500.0, W))
    closing = slow(3e-6, 1e5, 5e5)
    lift = brentq(lambda z: fast(3e-6 + z, 1e5, 5e5) - closing - 1.64e4 * z, 0.0, 2e-6)
    assert done.outcome.status == "ok" and done.q[0, 0] == 0.0
    # The law is read between clearances.
    assert done.q[-1, 0] == pytest.approx(lift, rel=1e-4) and lift > 5e-7


def test_pressures_are_shown_where_the_grooves_have_turned_to():
    film, f, x, s = ready(seal())
    assert film.start(f, s, x) == 0
    radii, angles = film.grid(f)
    shown = np.empty((2, 1, len(radii), len(angles)))
    for k, out in enumerate(shown):
        s[27] = k * angles[1]
        film.fields(f, s, x, out)
    assert shown[1, 0] == pytest.approx(np.roll(shown[0, 0], 1, axis=1), rel=1e-9)
    assert shown[0, 0, [0, -1]] == pytest.approx(np.array([[1e5], [5e5]]) * np.ones(len(angles)), rel=1e-6)
    # What they press, roughly, is the force.
    pressed = np.trapezoid(shown[0, 0].mean(axis=1) * radii, radii) * 2.0 * math.pi
    film.wrench(f, s, x)
    assert pressed == pytest.approx(s[FORCE], rel=5e-3)


@pytest.mark.parametrize(("table", "columns"), [(GAS, 4), (GAS, 6), (LIQUID, 4), (LIQUID, 6)])
def test_the_error_of_columns_is_measured_by_four_times_as_many(table, columns):
    """Also of columns too few for the order of the tips, where halving them tells a third of it, against 24 columns."""

    def loads(columns):
        name = "gas_reynolds" if table.gas else "reynolds"
        options = replace(getattr(table, name), columns=columns)
        ring = {"stator": {"misalignment": 4e-5}, "rotor": {"runout": 2e-5}}
        begun = started(seal(replace(table, **{name: options}), SPIRAL, **ring), 1e-3)
        s = begun.segment(0).gap_state(0.0, begun.y0)
        begun.model.interface.film.flow(begun.model.f, s, begun.model.interface.steady(begun.model.f, s))
        none = np.zeros(2 * begun.model.unknowns.n)
        return begun, np.array([[*none, s[FORCE], s[MOMENT_X], s[MOMENT_Y], s[FLOW_INNER], 0.0]])

    (run, found), (_, exact) = loads(columns), loads(24)
    true = ErrorScales(run).errors(found, exact).max()
    assert 0.6 * true < cell_error(run) < 4.0 * true


def test_columns_too_many_to_be_four_times_as_many_have_no_known_error(monkeypatch):
    """A run is not lost for it: its certificate says so."""
    begun = started(seal(stator={"misalignment": 4e-5}, rotor={"runout": 2e-5}), 1e-3)
    assert cell_error(begun) > 0.0
    mesh.mesh_of.cache_clear()
    monkeypatch.setattr(mesh, "MOST_NODES", begun.model.unknowns.size // SPIRAL.count)
    assert cell_error(begun) is None


@pytest.mark.slow
def test_the_row_of_an_independent_prototype():
    """fms_gas_5bar: half the clearance, 8 % above linear theory; extrapolated from 8 and 16 columns."""
    found = []
    for columns in (8, 16):
        table = replace(GAS, gas_reynolds=GasReynolds(columns=columns))
        scene = seal(table, TWELVE, stator={"misalignment": 4e-5}, rotor={"runout": 2e-5})
        done = run(scene, 2, accuracy=3e-3, method="ida", per_turn=256)
        last = done.times > 2.0 * math.pi / W
        tilt, gap = (part[last] for part in relative(done, 2e-5))
        found.append([abs(tilt).max(), abs(tilt).min(), (3e-6 + gap - R_O * abs(tilt)).min(), gap.mean()])
    order = aligned_film(scene, GAS.clearance, 4).order
    assert 1.0 < order < 1.6 and film_of(scene).cell_order(prepared(scene)) == pytest.approx(order, rel=0.05)
    assert halved(prepared(scene)).times == 1
    coarse, fine = np.array(found)
    better = fine + (fine - coarse) / (2.0**order - 1.0)
    for value, expected, tolerance in zip(
        better, (2.425e-5, 7.7061e-6, 1.8726e-6, 2.053e-7), (6e-3, 6e-3, 4e-3, 4e-3), strict=True
    ):
        assert value == pytest.approx(expected, rel=tolerance)
