"""Scenes the tests share, built in Python: the seal of Green (1989) with the support under either ring or both."""

import math
from dataclasses import replace

import numpy as np

from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import RunState
from sealdyn.dynamics.signals import signals
from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing, Shaft
from sealdyn.scene.film import Coefficients, Film
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Initial, RingStart, Scene
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

CLEARANCE, R_I, R_O, SPEED = 1e-5, 0.032, 0.040, 1000.0
INERTIA, MISALIGNMENT = 8e-4, 25e-6
TILT_SCALE = CLEARANCE / R_O
SUPPORT = Support(axial_stiffness=5e5, axial_damping=300.0, radius=0.04)
NOTHING = Coefficients(tilt_stiffness=0.0, tilt_damping=0.0, axial_stiffness=0.0, axial_damping=0.0)
# A scenario: an oil barrier whose fluid's inertia lets no film hold the closing force from 15 803 rpm on (the FMR seal
# from 15 806).
BARRIER = """
[shaft]
speed = "12000 rpm"
[film]
inner_radius = "45 mm"
outer_radius = "50 mm"
coning = "1 mrad"
inertia = true
viscosity = "20 mPa*s"
density = "870 kg/m^3"
outer_pressure = "4 bar"
inner_pressure = "1 bar"
[closing]
balance_ratio = 0.65
spring_force = "30 N"
[rotor]
misalignment = "50 urad"
body = { inner_radius = "40 mm", outer_radius = "54 mm", length = "25 mm", material = "silicon carbide" }
support = { axial_stiffness = "50 N/mm", axial_damping = "100 N*s/m", radius = "45 mm" }
[stator]
misalignment = "100 urad"
[run]
turns = 2
"""


def film(model="radial", **changes):
    """Green's film: 25 um of coning over an 8 mm face, 5 bar outside."""
    given = dict(
        inner_radius=R_I, outer_radius=R_O, clearance=CLEARANCE, coning=3.125e-3, viscosity=0.5e-3,
        outer_pressure=5e5, inner_pressure=0.0, model=model,
    )  # fmt: skip
    return Film(**(given | changes))


def ring(c=0.5, **changes):
    """Inertia and support of Green's ring; c = transverse over polar inertia."""
    return dict(mass=1.0, transverse_inertia=INERTIA, polar_inertia=INERTIA / c, support=SUPPORT) | changes


def fmr(model="radial", c=0.5, speed=SPEED, own=MISALIGNMENT, fixed=MISALIGNMENT, **parts):
    """Flexible rotor (own misalignment, turning) over a misaligned stator (fixed)."""
    given = dict(
        shaft=Shaft(speed=speed),
        film=film(model),
        rotor=Rotor(**ring(c, misalignment=own)),
        stator=Stator(misalignment=fixed),
    )
    return Scene(**(given | parts))


def fms(model="radial", c=0.5, speed=SPEED, own=MISALIGNMENT, runout=MISALIGNMENT, **parts):
    """Flexible stator (own misalignment, fixed) over a rotor that runs out (turning)."""
    given = dict(
        shaft=Shaft(speed=speed),
        film=film(model),
        stator=Stator(**ring(c, misalignment=own)),
        rotor=Rotor(runout=runout),
    )
    return Scene(**(given | parts))


def fmsr(model="radial", rotor_stiffer=1.0, stator_stiffer=1.0, speed=SPEED, own=MISALIGNMENT, fixed=MISALIGNMENT):
    """Both rings float; a support may be stiffened."""
    stiff = [
        replace(SUPPORT, axial_stiffness=factor * SUPPORT.axial_stiffness) for factor in (rotor_stiffer, stator_stiffer)
    ]
    return Scene(
        shaft=Shaft(speed=speed),
        film=film(model),
        rotor=Rotor(**ring(support=stiff[0], misalignment=own)),
        stator=Stator(**ring(support=stiff[1], misalignment=fixed)),
    )


def large_tilt(model="radial"):
    """A stator so far out of square that the gap closes to some tenths of the clearance."""
    return fmr(model, fixed=2.6e-3, own=MISALIGNMENT)


def housing_vibration(model="radial"):
    """Axial and angular housing tones, one pair commensurate with the shaft."""
    shaking = Housing(
        axial=[AxialVibration(frequency=400.0, acceleration=20.0)],
        angular=[
            AngularVibration(frequency=2 * SPEED / (2 * math.pi), displacement=5e-6),
            AngularVibration(frequency=75.0, displacement=20e-6, direction=math.pi / 2),
        ],
    )
    return fmr(model, fixed=0.0, housing=shaking)


def runup(model="radial"):
    """A stator carried from 1000 to 3000 rad/s in 20 ms, with kinks."""
    return fms(model, speed=PiecewiseLinear((0.0, 0.005, 0.025, 0.03), (1000.0, 1000.0, 3000.0, 3000.0)))


def free_ring(c=0.5, tilt=20e-6, tilt_rate=5e-3, speed=SPEED):
    """A rotor on undamped springs in a film that does nothing."""
    return fmr(
        c=c,
        speed=speed,
        film=film("linear", coefficients=NOTHING),
        rotor=Rotor(**ring(c, support=replace(SUPPORT, axial_damping=0.0))),
        stator=Stator(),
        initial=Initial(rotor=RingStart(tilt_x=tilt, tilt_y_rate=tilt_rate)),
    )


# Tilt stiffness and damping, axial stiffness and damping of a film given by its four numbers.
GIVEN = 5790.0, 4.08, 6.1e6, 5200.0


def of_given_film(stator=None, rotor=None, speed=SPEED, film_table=None, turns=1.0, **parts):
    """A run of rings (rigid unless given) on either side of that film."""
    table = film_table or film("linear", coefficients=Coefficients(*GIVEN))
    shaft = parts.pop("shaft", Shaft(speed=speed))
    scene = Scene(shaft=shaft, film=table, stator=stator or Stator(), rotor=rotor or Rotor(), **parts)
    return started(scene, 2 * math.pi * turns / abs(speed))


class Sink:
    """Keeps displacements, rates and signals at evenly spaced times."""

    def __init__(self, duration, interval):
        self.interval, self.count = interval, round(duration / interval)
        self.times, self.q, self.rates, self.parts, self.events = [], [], [], [], []

    def due(self, segment):
        taus, length = np.arange(self.count + 1) * self.interval - segment.time, segment.length
        inside = (taus >= -1e-12) & ((taus < length * (1 - 1e-12)) | segment.last) & (taus <= length * (1 + 1e-9))
        return np.clip(taus[inside], 0.0, length)

    def take(self, segment, taus, q, q_rate, x=None):
        self.times.append(taus + segment.time)
        self.q.append(q)
        self.rates.append(q_rate)
        self.parts.append(signals(segment, taus, q, q_rate, x))

    def state(self, *anything):
        pass

    def event(self, segment, tau, event):
        self.events.append({**event, "time": segment.time + tau})


class Run:
    """A finished run: its state, outcome, times (m,), displacements and rates (m, n), signals by name."""

    def __init__(self, ready, outcome, sink):
        self.ready, self.model, self.outcome = ready, ready.model, outcome
        n = ready.model.unknowns.n
        self.times = np.concatenate(sink.times) if sink.times else np.empty(0)
        self.q = np.concatenate(sink.q) if sink.q else np.empty((0, n))
        self.rates = np.concatenate(sink.rates) if sink.rates else np.empty((0, n))
        self.parts, self.events = sink.parts, sink.events

    def __getitem__(self, name):
        return np.concatenate([part[name] for part in self.parts])

    def record(self, window):
        """Extremes of one window, as `sealdyn.dynamics.extrema` names its slots."""
        return self.ready.extrema.records[window]

    def scaled(self):
        """Displacements and rates over their scales, (m, 2n)."""
        scales = self.model.scales[: self.model.unknowns.n]
        return np.hstack([self.q / scales, self.rates / (scales * self.model.reference_rate)])

    def tilt(self, ring):
        """Complex tilt of a ring at the sampled times."""
        at = self.model.unknowns.names.index(f"{ring}_tilt_x")
        return self.q[:, at] + 1j * self.q[:, at + 1]


def started(scene, duration, accuracy=1e-6, model_class=Model):
    """A run of a scene over `duration` (s), at rest."""
    return RunState(model_class(scene, accuracy), duration)


def prepared(scene, duration, accuracy, start="rest", model_class=Model):
    """A run with its start: at rest (plus what [initial] gives) or on the linear steady state."""
    ready = started(scene, duration, accuracy, model_class)
    set_start(ready, start)
    return ready


def set_start(ready, start):
    """Set a run's unknowns as `prepared` does."""
    unknowns, scene = ready.model.unknowns, ready.model.scene
    if start == "steady":
        ready.y0 = ready.steady_start()
    for name, given in (("stator", scene.initial.stator), ("rotor", scene.initial.rotor)):
        for part in ("z", "tilt_x", "tilt_y", "z_rate", "tilt_x_rate", "tilt_y_rate"):
            value, base = getattr(given, part), f"{name}_{part.removesuffix('_rate')}"
            if value is not None and base in unknowns.names:
                place = unknowns.names.index(base)
                ready.y0[unknowns.rate_places[place] if part.endswith("_rate") else place] = value


def run(scene, turns=None, accuracy=1e-6, method="adams", per_turn=64, start="rest", duration=None,
        model_class=Model, **options):  # fmt: skip
    """Integrate a scene; the last two turns are the windows 1 and 2; `options` of `solve`."""
    speed = scene.shaft.speed if not isinstance(scene.shaft.speed, PiecewiseLinear) else max(scene.shaft.speed.value)
    turn = 2 * math.pi / abs(speed)
    duration = duration if duration is not None else turns * turn
    ready = prepared(scene, duration, accuracy, start, model_class)
    ready.extrema.windows[1:] = [[duration - turn, duration], [duration - 2 * turn, duration - turn]]
    sink = Sink(duration, duration / max(1, round(duration / turn * per_turn)))
    outcome = solve(ready, method, accuracy, sink, **options)
    return Run(ready, outcome, sink)


def rates_of(segment):
    """Right-hand side of a segment as SciPy takes it."""

    def rates(t, y):
        out = np.empty(segment.size)
        segment.rhs(t, y, out)
        return out

    return rates


def apart(ready, one, other, interval):
    """Largest difference of displacements, relative to their scales, at samples every `interval` (s) of two runs, each
    a method and options of `solve`; both must end well."""
    found, model = [], ready.model
    for method, options in (one, other):
        sink = Recorder(interval)
        assert solve(ready, method, model.accuracy, sink, **options).status == "ok"
        found.append(sink.arrays()[1] / model.scales[: model.unknowns.n])
    return float(np.max(np.abs(found[0] - found[1])))
