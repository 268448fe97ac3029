"""Averaged short runs of the contact scene over worn faces: what the slow scale of wear asks for.

**Valid** constant conditions with a common period (tables stay at their last value, `[initial]` is left out), and
profiles that are the same all around: what a patch wears off is spread over the circle of both faces.  The ring follows
its worn faces: it is moved to where they touch before each run, and its support's spring pushes less by stiffness times
that travel.  A secondary seal that sticks is let go for that: hang-up over hours is not in it.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np

from ...analysis.poincare_map import FilmCollapsed, frozen_at_end, ramp_to
from ...dynamics import equations
from ...dynamics.equilibrium import axial_excess, crossing, support_stiffness
from ...dynamics.model import Model
from ...dynamics.modes import verdict
from ...dynamics.run_state import RunState
from ...dynamics.signals import signals
from ...faces import contact
from ...faces.geometry import FORCE, PROFILE_DEPTHS, SPIN_DIFFERENCE, WEAR, smallest_gap
from ...scene.film import Profile
from ...scene.forces import contact_thresholds
from ...scene.scene import Closing, Initial, SceneError
from ...simulation.selection import choose_method
from ...solvers.contract import Cause, Recorder, Status
from ...solvers.integrate import solve
from .rosenbrock import Average, NoAverage

# Samples of a shaft turn; those of them on which the slope is taken; step of its differences, in roughnesses.
PER_TURN, FEW, DIFFERENCE = 64, 8, 0.01
# Periods over which the first motion is led from the aligned faces; accuracy of the gap, in roughnesses, per unit of
# what the averages may be wrong by.
RAMP, FINER = 40, 0.3
# Means that are kept of a short run.
MEANS = ("contact_force", "film_force", "closing_force", "friction_power", "contact_area_fraction", "wear_rate",
         "axial_gap_change")  # fmt: skip


class ShortRunAverages:
    """Averages of a scene over profiles at `radius` (n,), to a relative accuracy `within`, over `turns` forcing periods
    at a time and at most `patience` times as many.  Called with the depth (n,) m worn off both faces together and a
    motion (None: from the start) it gives an Average.

    Raises SceneError for a scene without a common period, NoAverage for a run that ends.
    """

    def __init__(self, scene, radius, accuracy=1e-6, within=1e-3, turns=1, patience=40):
        profile = profile_of(scene.film)
        begun = replace(scene, film=replace(scene.film, profile=profile, model="auto"), initial=Initial())
        self.scene = frozen_at_end(begun)
        self.radius = np.asarray(radius, dtype=float)
        self.own = np.interp(self.radius, profile.radius, profile.depth)
        self.within, self.turns, self.patience = within, turns, patience
        rough = scene.contact.roughness
        probe = RunState(Model(self.scene, accuracy), 1.0)
        # The closing force stays the law that the tables' first values decide, as it does in a run.
        start = RunState(Model(begun, accuracy), 1.0)
        self.accuracy = min(accuracy, FINER * within * rough / start.model.clearance)
        self.clearance, self.face_area = start.model.clearance, start.model.closing.area
        given = self.scene.closing.spring_force
        self.closing = start.model.closing if given is None else replace(start.model.closing, spring=given)
        self.still = not len(probe.segment(0).rows)
        self.period = probe.period()
        if self.period is None:
            raise SceneError("shaft.speed", "forcing without a common period", "commensurate, constant forcing")
        self.stiffness, self.shares = supports_of(self.scene)
        self.wears = np.array([scene.contact.stator_wear_coefficient, scene.contact.rotor_wear_coefficient])
        self.difference = DIFFERENCE * rough
        self.unstable = verdict(probe.model.linear_scene().modes()) == "unstable"

    def __call__(self, depth, motion=None) -> Average:
        motion = motion or self.first(depth)
        # The ring follows what has been worn off where it touches.
        travel = motion["travel"] - float(np.dot(motion["share"], depth - np.array(motion["depth"])))
        run = self.run(depth, travel)
        average = self._rest if self.still else self._settle
        seen, states, more = average(run, motion)
        (*nodal, volume_rate), scatter = more.pop("rates"), more.pop("scatter")
        nodal = np.array(nodal)
        shift = seen["axial_gap_change"]
        total = float(nodal.sum())
        end = {
            "travel": travel + shift,
            "y": more.pop("y"),
            "depth": [float(v) for v in depth],
            "share": (nodal / total if total > 0.0 else np.full(len(nodal), 1.0 / len(nodal))).tolist(),
        }
        slope = self._slope(run, states) if total > 0.0 else None
        row = seen | more | {"travel": travel + shift}
        return Average(nodal, float(volume_rate), slope, scatter, end, row)

    def first(self, depth) -> dict:
        """The motion to start from: at rest, or led from aligned faces to what is imposed.  Raises NoAverage."""
        y = []
        if not self.still:
            try:
                y = ramp_to(self.scene, None, None, None, {"accuracy": self.accuracy, "ramp": RAMP}).tolist()
            except FilmCollapsed as lost:
                crushed = lost.cause == Cause.ASPERITIES_CRUSHED
                raise NoAverage(Status.COLLAPSED if crushed else Status.FAILED, str(lost)) from None
        n = len(self.radius)
        return {"travel": 0.0, "y": y, "depth": [float(v) for v in depth], "share": [1.0 / n] * n}

    def run(self, depth, travel: float) -> RunState:
        """The scene over worn faces, its ring `travel` (m) from where it began: the profile is counted from there, so
        that the ring is near zero again, and the closing force is what the springs still give."""
        profile = Profile(tuple(self.radius.tolist()), tuple((self.own + depth + travel).tolist()))
        film = replace(self.scene.film, clearance=self.clearance, profile=profile)
        closing = Closing(self.closing.balance_ratio, self.closing.spring + self.stiffness * travel)
        model = Model(replace(self.scene, film=film, closing=closing), self.accuracy)
        return RunState(model, self.turns * self.period)

    # --- a scene in which nothing moves ---------------------------------------------------------------

    def _rest(self, run, motion):
        """The balance of forces of aligned faces."""
        still = np.zeros((1, run.model.unknowns.n))
        (s,) = _states(run, np.zeros(1), still, still)
        shift = self._root(run, axial_excess(run.model, s, run.model.closing_force()))
        q = np.array([[shift * self.shares[name] for name in run.model.unknowns.names]])
        seen = self._seen(run, np.zeros(1), q, still)
        states = _states(run, np.zeros(1), q, still)
        more = {"rates": self._rates(run, states), "scatter": None, "settled": True, "periods": 0, "y": []}
        return seen, states, more

    def _root(self, run, excess) -> float:
        """Where the opening force falls through the closing force, nearest to where the ring was."""
        here, step = excess(0.0), 0.1 * self.scene.contact.roughness
        if here == 0.0:
            return 0.0
        side, near = math.copysign(step, here), 0.0
        lowest = smallest_gap(run.model.face, 0.0, 0.0, run.model.coning_change())[0]
        while True:
            far = near + side
            if excess(far) * here <= 0.0:
                return crossing(excess, *sorted((near, far)))
            if lowest + far < contact_thresholds(self.scene.contact)[2]:
                raise NoAverage(Status.COLLAPSED, "asperities crushed flat: the faces cannot carry the closing force")
            if far > 100 * max(self.clearance, run.model.face[1] * 1e-3):
                raise NoAverage(Status.FAILED, "the ring is blown open: no gap at which film and springs balance")
            near, side = far, 1.3 * side

    # --- a scene that moves ---------------------------------------------------------------------------

    def _settle(self, run, motion):
        """Runs of whole periods, each from the last one's end, until the averages stay."""
        y = np.zeros(run.model.unknowns.size)
        y[: len(motion["y"])] = motion["y"]
        method, past, turns = None, [], self.period * abs(self.scene.shaft.speed) / (2 * math.pi)
        interval = self.period / (PER_TURN * max(1, round(turns)))
        for _ in range(self.patience):
            run = RunState(run.model, run.duration)
            run.y0 = y
            method = method or choose_method(run)[0]
            sink = Recorder(interval)
            outcome = solve(run, method, self.accuracy, sink)
            if outcome.status != Status.OK:
                raise NoAverage(outcome.status, outcome.message)
            t, q, rate = (part[:-1] for part in sink.arrays())
            states = _states(run, t, q, rate)
            past.append(self._rates(run, states))
            y = np.zeros(run.model.unknowns.size)
            y[: run.model.unknowns.n_mechanical] = outcome.y[: run.model.unknowns.n_mechanical]
            if settled := _stays(past, self.within):
                break
        seen = self._seen(run, t, q, rate)
        rates, scatter = past[-1], None
        if not settled:
            # The later half of the windows is what there is.
            late = np.array(past[len(past) // 2 :])
            rates, scatter = late.mean(axis=0), 2.0 * late.std(axis=0)[:-1] / math.sqrt(len(late))
        y = self._moved(run, y, seen["axial_gap_change"])
        more = {"rates": rates, "scatter": scatter, "settled": settled, "periods": len(past) * self.turns, "y": y}
        return seen, states[:: max(1, len(states) // FEW)], more

    def _moved(self, run, y, shift) -> list[float]:
        """Mechanical unknowns with the mean shift of the gap taken out of the rings' axial displacements."""
        y = y[: run.model.unknowns.n_mechanical].copy()
        for i, name in enumerate(run.model.unknowns.names):
            if name in self.shares:
                y[i] -= shift * self.shares[name]
        return y.tolist()

    # --- from the gap to the nodes --------------------------------------------------------------------

    def _nodal(self, run, s, f=None) -> np.ndarray:
        """Volume rate (n,) m^3/s of both faces at each node's hat, in one gap state."""
        out = np.zeros(len(self.radius))
        contact.wear_rates(run.model.contact, run.model.f if f is None else f, s, out)
        return float(self.wears.sum()) * abs(s[SPIN_DIFFERENCE]) * out

    def _rates(self, run, states) -> np.ndarray:
        """Means over gap states of `_nodal`, and last, by an integral of its own, the volume rate of both faces."""
        found = np.zeros(len(self.radius) + 1)
        for state in states:
            s = state.copy()
            contact.contact_load_and_friction(run.model.contact, run.model.f, s)
            found[:-1] += self._nodal(run, s)
            found[-1] += s[WEAR] * self.face_area
        return found / len(states)

    def _slope(self, run, states) -> np.ndarray:
        """d nodal / d depth (n, n) m^2/s by central differences over gap states as they are, and with the ring moved so
        that the forces balance: exact for faces at rest, near enough for those that move."""
        n, step = len(self.radius), self.difference
        nodal, force = np.zeros((n, n)), np.zeros(n)
        for k, side in product(range(n), (1.0, -1.0)):
            f = run.model.f.copy()
            f[PROFILE_DEPTHS + k] += side * step
            for state in states:
                s = state.copy()
                run.model.interface.wrench(f, s)
                nodal[:, k] += side * self._nodal(run, s, f) / (2 * step * len(states))
                force[k] += side * s[FORCE] / (2 * step * len(states))
        # All hats together are the ring's own motion, against the film, the asperities and its springs.
        give = force.sum() - self.stiffness
        return nodal - np.outer(nodal.sum(axis=1), force) / give if give else nodal

    def _seen(self, run, t, q, rate) -> dict:
        """Means and extremes of what is looked at, over evenly spaced times of whole periods."""
        columns = signals(run.segment(0), t, q, rate)
        side = "leakage_inner" if run.model.closing.outer_is_high else "leakage_outer"
        seen = {name: float(columns[name].mean()) for name in MEANS}
        seen["leakage"] = float(columns[side].mean())
        seen["contact_pressure"] = float(columns["contact_pressure"].max())
        seen["h_min"] = float(columns["h_min"].min())
        seen["relative_misalignment"] = float(columns["relative_misalignment"].max())
        return seen


def profile_of(film) -> Profile:
    """The profile of the faces, a level one where they have none."""
    return film.profile or Profile((film.inner_radius, film.outer_radius), (0.0, 0.0))


def supports_of(scene) -> tuple[float, dict[str, float]]:
    """Stiffness (N/m) of the supports in series, and by how much each ring's axial unknown moves per change of the
    gap."""
    rings = {"stator_z": (scene.stator, 1.0), "rotor_z": (scene.rotor, -1.0)}
    give = {name: (ring.support.axial_stiffness, sign) for name, (ring, sign) in rings.items() if ring.support}
    free = [name for name, (stiffness, _) in give.items() if stiffness == 0.0]
    if free:
        return 0.0, {name: give[name][1] / len(free) if name in free else 0.0 for name in give}
    series = support_stiffness(scene)
    return series, {name: sign * series / stiffness for name, (stiffness, sign) in give.items()}


def _states(run, t, q, rate) -> list[np.ndarray]:
    """Gap states at times (m,) with displacements and rates (m, n)."""
    segment, states = run.segment(0), []
    yps = np.zeros(segment.size)
    for tau, here, speed in zip(t, q, rate, strict=True):
        yps[: segment.n] = speed
        equations.kinematics(tau, run.model.vector(here, speed), yps, segment.p, segment.w, segment.s)
        states.append(segment.s.copy())
    return states


def _stays(past, within) -> bool:
    """Whether the averages have settled: what is still to come, as the last changes shrink, is below `within`."""
    if len(past) < 2:
        return False
    size = max(float(np.max(np.abs(past[-1]))), 1e-300)
    last = float(np.max(np.abs(past[-1] - past[-2]))) / size
    if len(past) == 2:
        # Two equal averages without a third to compare by: only if they agree far better.
        return last <= 0.1 * within
    ratio = last / max(float(np.max(np.abs(past[-2] - past[-3]))) / size, 1e-300)
    return (ratio < 1.0 and last * max(1.0, ratio / (1.0 - ratio)) <= within) or last <= 0.01 * within
