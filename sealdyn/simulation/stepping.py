"""A run made step by step, for co-simulation and control: what is outside it may change between any two steps.

Each step is the method of a run over a stretch of its equations, to the instant asked for; the method starts anew
there, so that nothing of a step knows what comes.  Contacts, reversals of friction and extremes are located inside the
steps, as in a run.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..dynamics.extrema import H, empty_records
from ..dynamics.imposed_motion import CARRIERS, KINDS, Held, imposed_on
from ..dynamics.intervals import LONGEST, Interval, angle_turned
from ..dynamics.run_state import RunState
from ..dynamics.signals import samples, series_of, signal_table
from ..dynamics.swept_motion import check_covers
from ..scenario.errors import ScenarioError, nearest_of, scene_errors_of
from ..scenario.reader import Scenario, scenario_of
from ..scene.excitation import Whirl
from ..scene.patterns import turning_waves
from ..scene.radial import RadialScene
from ..scene.rings import RING_NAMES, ROTOR, STATOR, AxialRunout
from ..solvers.contract import Status, tolerance_for
from ..solvers.integrate import CRUMB, solve
from ..units import QuantityError, cut, quoted
from .run import RunEnded
from .selection import prepare_run
from .verification_run import ProgressSink

# Motion that moves nothing: a scene that has it has all its unknowns.
NOTHING = 1e-300


@dataclass(frozen=True)
class Snapshot:
    """All of a Simulation at an instant, to go back to; it may be pickled."""

    time: float
    content: dict[str, Any]


class Simulation:
    """A run in steps of any size: its `state` at an instant, what may be `set` between steps, snapshots.

    `source`, `overrides` as of `sealdyn.run`.  All six motions of its rings are unknowns, as what is set may move them;
    the accuracy asked for holds over a time as long as the scenario's run, which may be passed.  Without `set` the
    motion is that of `sealdyn.run`.  Beside `state`: `time` (s), `events` (contacts and the like, as in an archive),
    `units` of the state, `method`.
    Raises ScenarioError for what cannot be run, RunEnded in a step in which the film collapses or the solver gives up.

    >>> seal = sealdyn.Simulation("fms.toml")
    >>> for _ in range(10):
    ...     seal.set(shaft_speed=seal.state["shaft_speed"] + 1.0)
    ...     state = seal.step(1e-4)
    >>> round(state["shaft_speed"]), round(1e6 * state["h_min"], 1)
    (1010, 9.8)
    """

    def __init__(self, source: Scenario | str | os.PathLike[str], overrides: Mapping[str, Any] | Iterable[str] = ()):
        scenario = scenario_of(source, overrides)
        self.name = scenario.name
        if isinstance(scenario.scene, RadialScene):
            raise ScenarioError(scenario.name, "radial", "a radial seal", "a face seal")
        if scenario.run.solver == "expm":
            raise ScenarioError(scenario.name, "run.solver", '"expm"', '"auto": what is set may change')
        with scene_errors_of(scenario.name):
            prepared, plan = prepare_run(_with_all_motions(scenario), lowest=False)
        self._scene, self.method = scenario.scene, plan.method
        self._run = run = _Stepped(prepared)
        self._tolerance = tolerance_for(plan.method, run.model.accuracy, run.memory)
        self._now, self._tau, self._y = Fraction(0), 0.0, prepared.y0.copy()
        # What is imposed, and what the present interval has of it.
        self._held: dict[str, Held] = {}
        self._shown: dict[str, Held] = {}
        self._events: list[dict[str, Any]] = []
        run.begin(Fraction(0), (Fraction(0), Fraction(0)), run.model)
        segment = run.segment()
        segment.settle_film(0.0, self._y)
        if run.stick_slip:
            segment = run.segment(0, run.stick_slip.start(segment, 0.0, self._y))
        self._at_end: tuple | None = None
        self._state: dict[str, float] | None = None
        self._fresh, self._ended = False, None

    # --- what is asked ------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Time (s) since the start."""
        return float(self._now)

    @property
    def state(self) -> dict[str, float]:
        """Named numbers, SI (`units`): time; displacements, tilts and rates of the rings; film thickness, the least
        since the last step began (`least_h_min`); forces, moments, leakage and friction as the archive has them; and
        what the seal does to its carriers, `shaft_force`, `shaft_moment_x`, `shaft_moment_y`, `housing_force`, ...
        (of a ring that is rigid with its carrier without its inertia, and without the steady thrust)."""
        if self._state is None:
            self._state = self._look()
        return dict(self._state)

    @property
    def units(self) -> dict[str, str]:
        """SI units of the state's numbers."""
        found = {"time": "s"} | {signal.name: signal.unit for signal in signal_table(self._run.model)}
        return found | {"least_h_min": "m"}

    @property
    def events(self) -> list[dict[str, Any]]:
        """What has happened, in the order of time: kind, time (s), value and more, as the events of an archive."""
        return list(self._events)

    def __repr__(self) -> str:
        state = self.state
        return f"Simulation {self.name}: {self.method}, t = {self.time:g} s, h_min = {state['h_min']:.4g} m"

    def _repr_html_(self) -> str:
        from ..report.in_python import html_table

        units, state = self.units, self.state
        rows = [(name, f"{value:.6g}", units[name]) for name, value in state.items()]
        return html_table(rows, ("state", "value", "unit"), self.name)

    # --- what is done -------------------------------------------------------------------------------

    def step(self, duration: float) -> dict[str, float]:
        """Go on by a duration (s); returns the `state`.  Raises RunEnded, and ValueError for no duration."""
        if not 0.0 < duration < math.inf:
            raise ValueError(f"{self.name}: duration: found {quoted(duration)}; expected a time > 0 in s")
        return self._to(self._now + Fraction(duration))

    def step_to(self, time: float) -> dict[str, float]:
        """Go on to a time (s) since the start; returns the `state`.  Raises as `step`."""
        if not self.time < time < math.inf:
            expected = f"a time in s after {self.time:g} s, where the simulation is"
            raise ValueError(f"{self.name}: time: found {quoted(time)}; expected {expected}")
        return self._to(Fraction(time))

    def set(self, **values: float | str | tuple[float, ...]) -> None:
        """Impose from now on: `shaft_speed`, `inner_pressure`, `outer_pressure`; motion of a carrier, `shaft_z`,
        `shaft_tilt_x`, `shaft_tilt_y`, `housing_z`, ..., beside runout and vibration; loads on a floating ring,
        `stator_force` (along z), `stator_moment_x`, `rotor_moment_y`, ....

        A number is SI, a string has a unit.  A tuple (value, rate), of a motion (value, rate, acceleration), goes on
        from the value as a polynomial in time.  All else stays as it is.  Raises ScenarioError.
        """
        read = {name: self._read(name, value) for name, value in values.items()}
        held = {name: Held(self._now, terms) for name, terms in read.items()}
        same = all(name in self._held and self._held[name].terms == terms for name, terms in read.items())
        if same and not any(one.moves for one in held.values()):
            return
        self._held = {**self._held, **held}
        self._fresh, self._state, self._at_end = True, None, None

    def snapshot(self) -> Snapshot:
        """All that the simulation is now."""
        run = self._run
        content = {
            "names": run.model.unknowns.names, "now": self._now, "tau": self._tau, "y": self._y, "held": self._held,
            "shown": self._shown, "fresh": self._fresh, "ended": self._ended, "events": self._events,
            "interval": run.intervals[0], "modes": run.modes(), "records": run.extrema.state(),
            "motion": self._at_end and self._at_end[1:],
        }  # fmt: skip
        return Snapshot(self.time, deepcopy(content))

    def restore(self, snapshot: Snapshot) -> None:
        """Go back, or on, to a snapshot of this simulation or of one of the same scenario.  Raises ValueError for that
        of another."""
        kept, run = deepcopy(snapshot.content), self._run
        if kept["names"] != run.model.unknowns.names or kept["y"].shape != self._y.shape:
            found, expected = (", ".join(names) for names in (kept["names"], run.model.unknowns.names))
            raise ValueError(f"{self.name}: snapshot: found unknowns {found}; expected {expected}")
        for name in ("now", "tau", "y", "held", "shown", "fresh", "ended", "events"):
            setattr(self, f"_{name}", kept[name])
        run.intervals = [kept["interval"]]
        run.restore_modes(kept["modes"])
        run.extrema.restore(kept["records"])
        run.show(imposed_on(run.model, self._shown, run.intervals[0]))
        self._at_end = None if kept["motion"] is None else (run.segment(), *kept["motion"])
        self._state = None

    # --- inside -------------------------------------------------------------------------------------

    def _read(self, name: str, value) -> tuple[float, ...]:
        """The polynomial that a value stands for."""
        if name not in KINDS:
            expected = f"one of {', '.join(KINDS)}{nearest_of(name, KINDS)}"
            raise ScenarioError(self.name, name, "nothing that can be set", expected)
        quantity, terms = KINDS[name]
        given = value if isinstance(value, tuple | list) else (value,)
        now = given[0] if given else value
        try:
            first = quantity.read(now.item() if isinstance(now, np.generic) else now)
            rates = [float(x) for x in given[1:]]
        except QuantityError as error:
            raise ScenarioError(self.name, name, error.found, error.expected) from None
        except (TypeError, ValueError):
            rates = [math.nan]
        if len(given) > terms or not all(map(math.isfinite, rates)):
            more = "rate and acceleration" if terms > 2 else "a rate"
            expected = f"{quantity.name} in {quantity.unit}, or a tuple of it and {more} in SI"
            raise ScenarioError(self.name, name, cut(repr(value)), expected)
        self._refuse(name, first)
        return (first, *rates, *[0.0] * (terms - 1 - len(rates)))

    def _refuse(self, name: str, value: float) -> None:
        """Raises ScenarioError for what this scene has no place for."""
        scene, unknowns = self._scene, self._run.model.unknowns
        kind, _, part = name.partition("_")
        if kind in CARRIERS and part != "speed" and getattr(scene, kind).motion is not None:
            raise ScenarioError(self.name, name, f"a scenario with {kind}.motion", "one without, or its samples alone")
        if kind in RING_NAMES and not unknowns.floats[RING_NAMES.index(kind)]:
            raise ScenarioError(self.name, name, f"a {kind} that is rigid with its carrier", "a ring with a support")
        if part == "force" and unknowns.floats[STATOR] and unknowns.floats[ROTOR]:
            raise ScenarioError(self.name, name, "two floating rings", "one floating ring")
        conditions = name in ("shaft_speed", "inner_pressure", "outer_pressure")
        if conditions and self._run.model.heat is not None:
            expected = "no film.heat: the faces are as warm as speed and pressures of their own make them"
            raise ScenarioError(self.name, name, "faces that take heat", expected)
        turned = name == "shaft_speed" and value != 0.0
        if turned and scene.rotor.waviness and not turning_waves(scene):
            raise ScenarioError(self.name, name, "a wavy rotor at rest", "a scenario whose shaft turns")

    def _to(self, target: Fraction) -> dict[str, float]:
        """Go on to an instant."""
        if self._ended:
            raise RunEnded(self.name, *self._ended)
        run, begin = self._run, self._now
        run.extrema.windows[1] = [float(begin), float(target)]
        run.extrema.records[1] = empty_records()[1]
        while self._now < target:
            self._begin_interval(target)
            interval = run.intervals[0]
            end = min(target, interval.start + interval.span)
            until = float(end - interval.start)
            if until - self._tau > CRUMB * max(until, run.model.shortest_period):
                self._integrate(until)
            self._now, self._tau = end, until
        self._state = None
        return self.state

    def _begin_interval(self, target: Fraction) -> None:
        """A stretch of time on which all that is imposed is linear, or of a motion a parabola, begins now, unless one
        goes on."""
        run = self._run
        interval = run.intervals[0]
        ended = self._now >= interval.start + interval.span
        if not (self._fresh or ended):
            return
        moving = any(held.moves for held in self._held.values())
        before = replace(interval, span=self._now - interval.start)
        shown = run.shown.scene
        turned = (angle_turned(q, before, interval) for q in (shown.shaft.speed, shown.stator.speed))
        angles = tuple(a + more for a, more in zip(interval.angles, turned, strict=True))
        instant = Interval(self._now, Fraction(1), *angles)
        steady = {name: Held(held.since, (held.at(self._now)[0], *[0.0] * (len(held.terms) - 1)))
                  for name, held in self._held.items()}  # fmt: skip
        run.begin(self._now, angles, imposed_on(run.model, steady, instant), target if moving else None)
        if moving:
            run.show(imposed_on(run.model, self._held, run.intervals[0]))
        self._shown, self._tau, self._fresh = self._held, 0.0, False

    def _integrate(self, until: float) -> None:
        """Go on to a time (s) of the present segment."""
        run, sink = self._run, _Kept(self._run)
        if self._run.model.scene.shaft.motion or self._run.model.scene.housing.motion:
            with scene_errors_of(self.name):
                check_covers(run.model.scene, run.intervals[0].time + until)
        run.until = until
        outcome = solve(
            run, self.method, run.model.accuracy, sink, tolerance=self._tolerance,
            resume=(0, self._tau, self._y),
        )  # fmt: skip
        self._events += sink.events
        run.contacts.tell(self._events.extend)
        self._events.sort(key=lambda event: event["time"])
        self._y, self._tau = outcome.y, outcome.tau
        self._at_end = sink.last
        if outcome.status != Status.OK:
            self._now, self._state = run.intervals[0].start + Fraction(outcome.tau), None
            self._ended = str(outcome.status), outcome.message
            raise RunEnded(self.name, *self._ended)

    def _look(self) -> dict[str, float]:
        """The state's numbers."""
        if self._fresh:
            self._begin_interval(self._now + Fraction(self._run.model.shortest_period))
            self._fresh = any(held.moves for held in self._held.values())
        segment, *motion = self._at_end or (self._run.segment(), *self._motion())
        at = samples(segment, np.array([self._tau]), *motion)
        found = {name: float(values[0]) for name, values in series_of(at).items()}
        least = float(self._run.extrema.records[1, H])
        return {**found, "time": self.time, "least_h_min": min(least, found["h_min"])}

    def _motion(self) -> tuple:
        """Displacements and rates, each (1, n), and the film's unknowns, if it has any, where no step has left them."""
        segment, tau, y = self._run.segment(), self._tau, self._y
        yp = np.zeros_like(y)
        if segment.has_residual_form:
            y, yp = segment.start(tau, y)
        film = (y[None, segment.film],) if segment.film.stop > segment.film.start else ()
        return (*segment.motion(y[None, :], yp[None, :]), *film)


def _with_all_motions(scenario: Scenario) -> Scenario:
    """The scenario with motions that move nothing, axial and angular."""
    scene = scenario.scene
    shaft = replace(scene.shaft, whirl=[*scene.shaft.whirl, Whirl(0.0, NOTHING)])
    rotor = replace(scene.rotor, axial_runout=[*scene.rotor.axial_runout, AxialRunout(0.0, NOTHING)])
    return replace(scenario, scene=replace(scene, shaft=shaft, rotor=rotor), read=None)


class _Stepped(RunState):
    """A run of no given length: its present interval alone, which under the conditions of the model `shown` is
    integrated `until` a time (s) of its own."""

    def __init__(self, prepared: RunState):
        super().__init__(prepared.model, prepared.duration)
        self.memory = prepared.memory
        self.extrema.windows = [[0.0, math.inf], [0.0, 0.0], [math.inf, math.inf]]
        self.extrema.steady = prepared.extrema.steady
        self.intervals: list[Interval] = []

    def begin(self, now: Fraction, angles, shown, latest: Fraction | None = None) -> None:
        """A new interval from `now` (s), angles (rad) there, to the next break, at the `latest` to a time (s)."""
        ends = [now + Fraction(LONGEST * shown.shortest_period), *([latest] if latest else [])]
        if math.isfinite(after := shown.next_break(now)):
            ends.append(Fraction(after))
        self.intervals = [Interval(now, min(ends) - now, *angles)]
        self.show(shown)

    def show(self, shown) -> None:
        """The conditions of the interval are those of another model."""
        self.shown, self.until, self._segment = shown, math.inf, None

    def segment(self, index: int = 0, stuck=None):
        """The equations over the interval, up to where they are to be integrated; `stuck` as of Segment."""
        if stuck is None and self.stick_slip:
            stuck = self.stick_slip.held()
        if self.stick_slip or self._segment is None:
            self._segment = self.shown.segment(self.intervals[0], 0, True, stuck)
            # Made once for all pieces.
            _ = self._segment.native, self._segment.swing
        return self._segment.until(min(self.until, self._segment.length))


class _Kept(ProgressSink):
    """A sink of a step: what has moved where it ends (`last`: segment, displacements and rates, each (1, n), and the
    film's unknowns), and `events`."""

    def __init__(self, run):
        super().__init__(run)
        self.last, self.events = None, []

    def due(self, segment):
        """The end alone."""
        return np.array([segment.length])

    def take(self, segment, taus, *motion):
        """Keep the motion at the end."""
        self.last = (segment, *(part[-1:] for part in motion))

    def event(self, segment, tau, event):
        """Keep what happens."""
        self.events.append({**event, "time": segment.time + tau})
