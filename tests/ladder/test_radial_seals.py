"""Lip and circumferential seals: closed forms, an event by event integration that shares no code, energy, statics."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command import SCENARIOS
from scipy.integrate import solve_ivp

from sealdyn.analysis import other_rules
from sealdyn.radial_seals.equations import _dips, _first_below
from sealdyn.radial_seals.followers import (
    fastest,
    followers_of,
    hangs_up,
    largest_eccentricity,
    lip_line,
    needed_preload,
)
from sealdyn.radial_seals.model import RadialModel, RadialRun, RadialSegment
from sealdyn.scenario.reader import read_scenario
from sealdyn.scene.radial import Circumferential, Lip, Lobes, RadialScene, RadialShaft
from sealdyn.simulation.simulate import simulate
from sealdyn.solvers.contract import Recorder, Status
from sealdyn.solvers.integrate import solve
from sealdyn.solvers.run_error import EnergyAudit

R, E, W = 0.025, 1e-4, 300.0
ACCURACY = 1e-7
SEGMENTS = SCENARIOS / "radial" / "circumferential_reference.toml"


def lip(preload=10.0, speed=W, e=E, eta=0.0, offset=0.0, sectors=12, stiffness=5e4, mass=0.03, **more):
    shaft = RadialShaft(R, speed, eccentricity=e, offset=offset)
    return RadialScene(shaft, lip=Lip(mass, sectors, preload, stiffness, loss_factor=eta, **more))


def segments(tension, friction=0.0, speed=W, e=E, offset=0.0, mass=0.06):
    """Six segments, each pressed by `tension` (2 sin 30 deg = 1) and held by `friction`."""
    shaft = RadialShaft(R, speed, eccentricity=e, offset=offset)
    return RadialScene(shaft, circumferential=Circumferential(mass, 6, tension, axial_force=6 * friction,
                                                              flange_friction=1.0))  # fmt: skip


def ran(scene, turns=3.0, method="dop853", accuracy=ACCURACY, every=None):
    run = RadialRun(RadialModel(scene, accuracy), turns * 2 * math.pi / abs(scene.shaft.speed))
    sink = Recorder(every)
    outcome = solve(run, method, accuracy, sink, audit=EnergyAudit())
    assert outcome.status == "ok", outcome.message
    return run, outcome, sink


def lifts(scene, turns=2.0) -> int:
    return ran(scene, turns)[0].stick_slip.counts["lift"]


# --- where contact is lost ----------------------------------------------------------------------------


@pytest.mark.core
@pytest.mark.parametrize("speed", [100.0, W, 2000.0])
@pytest.mark.parametrize("eta", [0.0, 0.3])
@pytest.mark.parametrize("offset", [0.0, 3e-5])
def test_contact_is_lost_at_the_preload_of_the_closed_form(speed, eta, offset):
    """Per metre of circumference: e sqrt((k - m w^2)^2 + (eta k)^2) + k s, within 1e-4 of it."""
    k, m = 5e4, 0.03 / (2 * math.pi * R)
    needed = E * math.hypot(k - m * speed**2, eta * k) + k * offset
    assert lifts(lip(needed * (1 + 5e-5), speed, eta=eta, offset=offset)) == 0
    assert lifts(lip(needed * (1 - 5e-5), speed, eta=eta, offset=offset)) > 0
    scene = lip(needed, speed, eta=eta, offset=offset)
    followers = followers_of(scene)
    assert needed_preload(followers, scene.shaft, speed) == pytest.approx(needed * followers.arc, rel=1e-9)
    assert largest_eccentricity(followers, scene.shaft, speed) == pytest.approx(E, rel=1e-9)


def test_a_soft_preload_rides_between_two_speeds():
    """With preload < e k contact is lost at rest and held between m w^2 = k -+ preload / e."""
    k, m, preload = 5e4, 0.03 / (2 * math.pi * R), 2.0
    low, high = (math.sqrt((k + sign * preload / E) / m) for sign in (-1, 1))
    found = [lifts(lip(preload, w)) for w in (low * 0.9999, low * 1.0001, high * 0.9999, high * 1.0001)]
    assert [n > 0 for n in found] == [True, False, False, True]


@pytest.mark.parametrize("friction", [0.0, 0.01])
def test_segments_leave_at_preload_less_friction(friction):
    """Without stiffness: P = m e w^2 + F, felt where the segment moves inward."""
    needed = 0.01 * E * W**2 + friction
    assert lifts(segments(needed * (1 + 5e-5), friction)) == 0
    assert lifts(segments(needed * (1 - 5e-5), friction)) > 0


@pytest.mark.parametrize("hair", [1e-5, 1e-8])
def test_every_short_flight_is_seen(hair):
    """A hair below the limit every follower leaves once a turn, for microseconds: between the places at which is
    looked."""
    scene = lip(1.0, eta=0.2)
    followers = followers_of(scene)
    scene = lip(needed_preload(followers, scene.shaft, W) / followers.arc * (1 - hair), eta=0.2)
    run, _, _ = ran(scene, 4.0)
    assert run.stick_slip.counts["lift"] == 4 * 12
    assert 0.0 < run.extrema.extremes["largest_gap"][0] < 1e-4 * E


def test_ovality_is_a_wave_of_its_own():
    """Order 2 swings with k + 3 H / r^2 - m (2 w)^2, H the tension of the garter spring."""
    tension, a, w = 0.02, 5e-5, 100.0
    m, k = 0.03 / (2 * math.pi * R), 5e4 + 3 * tension / R**2
    needed = a * abs(k - m * (2 * w) ** 2)
    for share, lost in ((1 + 5e-5, False), (1 - 5e-5, True)):
        scene = lip(needed * share - tension / R, w, e=0.0, sectors=16, garter_tension=tension)
        scene = replace(scene, shaft=replace(scene.shaft, lobes=[Lobes(2, a)]))
        assert (lifts(scene) > 0) == lost


@pytest.mark.parametrize("order, rate", [(4, 0.0), (5, 300.0), (6, 300.0), (7, 300.0)])
def test_lobes_finer_than_the_segments_are_what_the_segments_see(order, rate):
    """Six segments feel order 6 as a move of all at once, which stretches the garter spring: 6 rate (2 sin 30 deg)^2;
    the others not at all."""
    a, m = 1e-5, 0.01
    needed = a * abs((6 * rate if order == 6 else 0.0) - m * (order * W) ** 2)
    for share, lost in ((1 + 5e-5, False), (1 - 5e-5, True)):
        scene = segments(needed * share, e=0.0)
        scene = RadialScene(replace(scene.shaft, lobes=[Lobes(order, a)]),
                            circumferential=replace(scene.circumferential, garter_rate=rate))  # fmt: skip
        followers = followers_of(scene)
        assert needed_preload(followers, scene.shaft, W) == pytest.approx(needed, rel=1e-9)
        assert (lifts(scene, 1.2) > 0) == lost


@pytest.mark.parametrize("speed", [500.0, -500.0])
def test_lobes_swing_a_damped_load_otherwise_the_other_way_round(speed):
    """Of several waves the phases count, and damping shifts them with the direction of rotation."""
    shaft = RadialShaft(R, speed, eccentricity=E, lobes=[Lobes(2, 8e-5, 3.3), Lobes(3, 5e-5, -0.7)])
    scene = RadialScene(shaft, lip=Lip(0.03, 24, 1.0, 5e4, loss_factor=0.6))
    assert fastest(shaft) == speed
    needed = needed_preload(followers_of(scene), shaft, fastest(shaft)) * 24 / (2 * math.pi * R)
    for share, lost in ((1 + 1e-3, False), (1 - 1e-3, True)):
        at = replace(scene, lip=replace(scene.lip, preload=needed * share))
        assert (lifts(at, 1.05) > 0) == lost


def test_what_leaves_at_the_very_start_has_left():
    """Where the housing is off by more than the preload reaches, sectors hang free from the first instant on."""
    k, offset, preload = 5e4, 2e-4, 6.0
    found = ran(lip(preload, e=0.0, eta=1.0, offset=offset), 2.0)[0].stick_slip
    free = int((k * offset * np.cos(2 * np.pi * np.arange(12) / 12) + preload < 0).sum())
    assert free == 3 and found.counts["lift"] == free and found.first_lift == 0.0
    assert (found.modes == 0.0).sum() == free


def test_a_least_value_between_the_first_two_places_of_a_step_is_looked_for():
    """Also between the last two; none where it lies outside the step, or well above zero."""
    x = np.linspace(0.0, 1.0, 9)[:, None]
    at = np.array([0.05, 0.5, 0.96, 0.05, -0.2, 1.2])
    values = (x - at) ** 2 - 1e-6 + np.array([0.0, 0.0, 0.0, 0.1, 0.0, 0.0])
    assert _dips(values).any(axis=0).tolist() == [True, True, True, False, False, False]
    first = _first_below(lambda t: (t - 0.05) ** 2 - 1e-6, x[:, 0], values[:, 0], _dips(values)[:, 0], 0.0)
    assert first == pytest.approx(0.049, abs=1e-9)


def test_a_landing_that_grazes_is_as_exact_as_any():
    """A soft undamped sector touches the shaft almost at the shaft's own speed, and flies on: the instant hangs on the
    last digits of the gap."""
    shaft = RadialShaft(0.0646, -1149.1357, 1.276952e-05, offset=3.752544e-4, offset_direction=0.92554289)
    scene = RadialScene(shaft, lip=Lip(3.9142857e-05, 6, 1.377367, 4580.2346))
    turns, every = 1.5, 1.5 * 2 * math.pi / 1149.1357 / 200
    found = [ran(scene, turns, accuracy=accuracy, every=every) for accuracy in (1e-6, 1e-10)]
    assert found[0][0].stick_slip.counts["land"] >= 2
    one, other = (sink.arrays()[1] for _, _, sink in found)
    np.testing.assert_allclose(one, other, atol=2e-8 * found[0][0].model.length)


# --- beside an integration that shares no code --------------------------------------------------------


def one_by_one(times, theta, m, k, d, preload, friction, e=E, w=W):
    """Displacement of one follower at `times`, and how often it lifts: mode by mode, SciPy's own events."""

    def s(t):
        return e * np.cos(theta - w * t)

    def v(t):
        return e * w * np.sin(theta - w * t)

    def load(t):
        return -m * w * w * s(t) + d * v(t) + k * s(t) + preload + friction * np.sign(v(t))

    def first(falls, t):
        """When `falls` is first below zero from t on."""
        fine = np.linspace(t, times[-1], 100_001)
        below = np.flatnonzero(falls(fine) < 0)
        if not len(below):
            return times[-1]
        if below[0] == 0:
            return t
        low, high = fine[below[0] - 1], fine[below[0]]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if falls(middle) < 0 else (middle, high)
        return high

    out, t, mode, lifted = np.empty(len(times)), 0.0, "ride", 0
    while t < times[-1]:
        if mode == "ride":
            end = first(load, t)
            inside = (times >= t) & (times <= end)
            out[inside] = s(times[inside])
            t, y = end, [s(end), v(end)]
            lifted, mode = lifted + (end < times[-1]), "free"
        elif abs(y[1]) <= 1e-9 * e * w and abs(k * y[0] + preload) <= friction:
            end = first(lambda t, y=y: y[0] + 1e-14 - s(t), t)
            out[(times >= t) & (times <= end)] = y[0]
            t, mode = end, "ride"
        else:
            sign = np.sign(y[1]) if abs(y[1]) > 1e-9 * e * w else -np.sign(k * y[0] + preload)

            def falls(t, y, sign=sign):
                return [y[1], -(k * y[0] + d * y[1] + preload + friction * sign) / m]

            def lands(t, y):
                return y[0] - s(t) + 1e-13 * e

            def stops(t, y, sign=sign):
                return y[1] * sign + 1e-12 * e * w

            lands.terminal, lands.direction, stops.terminal, stops.direction = True, -1, True, -1
            how = {"rtol": 1e-12, "atol": 1e-17, "dense_output": True, "max_step": 2 * math.pi / w / 200}
            events = [lands, stops] if friction else [lands]
            flight = solve_ivp(falls, (t, times[-1]), y, "DOP853", events=events, **how)
            inside = (times >= t) & (times <= flight.t[-1])
            out[inside] = flight.sol(times[inside])[0]
            t, y = flight.t[-1], [float(part) for part in flight.y[:, -1]]
            if flight.status == 1 and len(flight.t_events[0]):
                mode = "ride"
            elif flight.status == 1:
                y[1] = 0.0
    return out, lifted


@pytest.mark.parametrize(
    "scene",
    [lip(2.5, eta=0.3), lip(1.0, eta=0.0), lip(4.0, 1500.0, eta=0.1), segments(0.05), segments(0.05, 0.01),
     segments(0.012, 0.01), segments(0.12, 0.1, e=2e-4), segments(0.06, 0.1, e=2e-4), segments(0.06, 1.0)],
    ids=["lip", "undamped lip", "fast lip", "segments", "segments with friction", "nearly hung up", "turning",
         "hung up", "hit while held"],
)  # fmt: skip
def test_the_motion_is_that_of_each_follower_by_itself(scene):
    """Without a coupling each sector is on its own: displacements within 1e-5 of the eccentricity, lifts alike."""
    turns, w = 2.5, scene.shaft.speed
    run, outcome, sink = ran(scene, turns, every=turns * 2 * math.pi / w / 500)
    times, us, _ = sink.arrays()
    found = followers_of(scene)
    lifted = 0
    for j in range(0, found.count, 2):
        exact, n = one_by_one(times, found.angles[j], found.mass, found.row[0], found.damping, found.preload,
                              found.friction, scene.shaft.eccentricity, w)  # fmt: skip
        lifted += n
        np.testing.assert_allclose(us[:, j], exact, atol=1e-5 * scene.shaft.eccentricity)
    assert lifted > 0 and run.stick_slip.counts["lift"] > 0
    assert outcome.energy_residual < 1e-8


def test_methods_agree_on_a_lip_whose_sectors_pull_at_each_other():
    """Hoop tension and garter rate couple them: DOP853, Adams and Radau, to the accuracy."""
    scene = lip(1.5, eta=0.2, garter_tension=1.0, garter_rate=200.0)
    found = [ran(scene, 2.0, method, 1e-6, every=1e-4)[2].arrays()[1] for method in ("dop853", "adams", "radau")]
    for other in found[1:]:
        np.testing.assert_allclose(other, found[0], atol=3e-5 * E)


@pytest.mark.parametrize("sizes", ["energies", "motion"])
def test_the_audit_and_the_certificate_bite(sizes, tmp_path, monkeypatch):
    """Energies that are off by a thousandth fail the audit, steps too long for what is between them the certificate."""
    energies = RadialSegment.energies
    if sizes == "energies":
        monkeypatch.setattr(RadialSegment, "energies", lambda *at: 1.001 * energies(*at))
    else:
        monkeypatch.setattr("sealdyn.radial_seals.model.BETWEEN", 100.0)
    scenario = read_scenario(SEGMENTS, ["run.turns=1", "shaft.eccentricity='0.3 mm'"])
    found = simulate(scenario, tmp_path / "x.h5")
    assert found.status == "inaccurate"
    assert ("energy audit" in found.message) == (sizes == "energies")
    assert found.summary["certificate"]["met"] == (sizes == "energies")


def test_a_sharper_run_that_fails_is_no_certificate(tmp_path, monkeypatch):
    runs = []

    def second_gives_up(*args, **more):
        outcome = solve(*args, **more)
        runs.append(outcome)
        return replace(outcome, status=Status.FAILED, message="gave up")

    monkeypatch.setattr("sealdyn.simulation.verification_run.solve", second_gives_up)
    found = simulate(read_scenario(SEGMENTS, ["run.turns=1"]), tmp_path / "x.h5")
    assert found.status == "inaccurate" and "a sharper run failed (gave up)" in found.message


# --- statics ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("share, hung", [(1 + 1e-6, False), (1 - 1e-6, True)])
def test_segments_hang_up_at_the_friction_that_statics_predicts(share, hung):
    """Garter 2 T sin(pi / n) against mu A / n: on a slow shaft, whose inertia is nothing."""
    friction = 0.05
    run, _, _ = ran(segments(friction * share, friction, speed=0.01), 1.5)
    assert bool((run.stick_slip.modes == 1.0).all()) == hung


def test_lip_load_of_the_section():
    """Eqs. 2.9 to 2.11 of the guide over the circumference: hoop and garter 2 pi (s A + T), beam 3 E I delta / l^3."""
    section = Lip(0.003, hoop_stress=1e6, hoop_area=4e-6, garter_tension=1.5, modulus=1e7, thickness=1e-3,
                  length=6e-3, interference=3e-4)  # fmt: skip
    preload, stiffness = lip_line(section, R)
    whole = 2 * math.pi * (1e6 * 4e-6 + 1.5) + 3 * 1e7 * (2 * math.pi * R * 1e-9 / 12) * 3e-4 / 6e-3**3
    assert preload * 2 * math.pi * R == pytest.approx(whole, rel=1e-12)
    assert stiffness == pytest.approx(1e7 * 1e-9 / (4 * 6e-3**3), rel=1e-12)


def test_garter_around_segments_is_the_gradient_of_its_energy():
    """Six segments moved out: the force is T dL/du and grows with the spring's rate, L = sum of 2 sin(pi/n) u."""
    scene = RadialScene(RadialShaft(R, W), circumferential=Circumferential(0.06, 6, 2.0, garter_rate=500.0))
    found, u = followers_of(scene), np.array([1.0, -2.0, 0.5, 3.0, 0.0, 1.5]) * 1e-4
    matrix = np.array([np.roll(found.row, j) for j in range(6)])
    assert found.preload == pytest.approx(2.0)
    np.testing.assert_allclose(matrix @ u, 500.0 * u.sum(), rtol=1e-12)


def test_a_lip_that_widens_is_pressed_by_its_tension_as_before():
    """All sectors out by u: the ring of tension H gains 2 pi H u of energy, which is linear; only the spring's own rate
    counts, (2 pi)^2 rate on all."""
    scene = lip(garter_tension=3.0, garter_rate=200.0)
    found = followers_of(scene)
    assert 12 * found.modal_stiffness[0] == pytest.approx(5e4 * 2 * math.pi * R + 200.0 * (2 * math.pi) ** 2)
    # Moved as a whole it feels no tension either.
    assert found.modal_stiffness[1] == pytest.approx(5e4 * found.arc)
    assert found.modal_stiffness[3] == pytest.approx((5e4 + 8 * 3.0 / R**2) * found.arc)


def test_a_lip_has_no_flange_that_could_hold_it():
    assert not hangs_up(followers_of(lip(preload=0.0))) and hangs_up(followers_of(segments(0.01, 0.01)))
    assert not hangs_up(followers_of(segments(0.011, 0.01)))


# --- experience ---------------------------------------------------------------------------------------


def test_the_guides_lip_table_is_no_mass_on_a_spring():
    """1/e = 2.86 + 0.2 v^2 per mm (v in 1000 ft/min): P = e (m w^2 - k) would ask for k < 0."""
    thousands = other_rules.LIP_SPEED / (1000 * other_rules.FOOT_PER_MINUTE)
    slope, start = np.polyfit(thousands**2, 1e-3 / other_rules.LIP_ECCENTRICITY, 1)
    assert start == pytest.approx(2.86, abs=0.01) and slope == pytest.approx(0.19, abs=0.01)
    # Of segments all rows together would have a stiffness, the four slower ones none.
    speeds, inverse = other_rules.SEGMENT_SPEED, 1e-3 / (0.5 * other_rules.SEGMENT_RUNOUT)
    assert np.polyfit(speeds**2, inverse, 1)[1] < 0 < np.polyfit(speeds[1:] ** 2, inverse[1:], 1)[1]
    for table in (other_rules.LIP_SPEED[np.argsort(other_rules.LIP_ECCENTRICITY)],
                  speeds[np.argsort(other_rules.SEGMENT_RUNOUT)]):  # fmt: skip
        assert np.all(np.diff(table) < 0)
