"""A driven seal seen once per period of its forcing: the period map, runs of whole periods, tangents of the map; and a
rubbing seal followed over a key: each point from the last one's end, and what its motion is like there.

**Source** Moon, *Chaotic Vibrations* (1987), ch. 2 (stroboscopic section); the tangents are those of the equations of
motion, differenced across the right-hand side and integrated beside the motion.
**Valid** constant conditions and commensurate forcing.  A ring that sticks has no map with a derivative.
"""

import math
import time as clock
from dataclasses import dataclass

import numpy as np

from ..dynamics.interface import Interface
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..dynamics.signals import signals
from ..dynamics.warm_state import at_work
from ..numerics import time_series
from ..numerics.piecewise_linear import PiecewiseLinear
from ..numerics.time_series import two_trajectories
from ..scene.rings import RING_NAMES
from ..scene.scene import Closing, SceneError, part, tables_at_end, with_values
from ..simulation.selection import choose_method
from ..solvers.contract import Cause, Counts, Recorder, SolverFailure, Status, tolerance_for
from ..solvers.integrate import solve
from ..solvers.methods import METHODS

# Periods integrated at a time; samples of a period.
PIECE, SAMPLES = 250, 64
# Step across the right-hand side, in units of the scales; accuracy of tangents relative to their length.
ACROSS, TANGENT = 1e-6, 1e-6


@dataclass(frozen=True)
class PeriodSamples:
    """Whole periods of a run.  `section` (m,) relative tilt (rad, complex, fixed axes) at the start of each; `tilt` (m,
    samples) the same all along; `ring` (m, samples) tilt of a flexible ring about the x axis (rad); `h_min`,
    `contact_force`, `friction_power`, `contact_power` (m, samples) in SI; `lowest` (m,) smallest film of each period
    (m); `touching` (m,) share of each period in contact; `contacts` that ended or go on; `impulse` of contact per
    period (N s); `last` (n,) unknowns at the end; `status`, `message`; `evaluations` and wall time (s) per period."""

    section: np.ndarray
    tilt: np.ndarray
    ring: np.ndarray
    h_min: np.ndarray
    contact_force: np.ndarray
    friction_power: np.ndarray
    contact_power: np.ndarray
    lowest: np.ndarray
    touching: np.ndarray
    contacts: int
    impulse: float
    last: np.ndarray
    status: str
    message: str
    evaluations: float
    wall_time: float


class PeriodMap:
    """The period map of a scene by one method at one accuracy; `method` None: what the scene wants.  `period` (s),
    `size` n of its points: the mechanical unknowns, of a massless ring the displacements, and their `scales` (n,).
    Raises SceneError if there is no period, or the film stores."""

    def __init__(self, scene, accuracy: float = 1e-6, method: str | None = None):
        self.scene, self.accuracy = scene, accuracy
        model = Model(scene, accuracy)
        period = RunState(model, 1.0).period()
        if period is None or not model.unknowns.constant:
            raise SceneError("shaft.speed", "forcing without a common period", "commensurate, constant forcing")
        if model.interface.stores:
            raise SceneError("film", "one that stores", "a film whose state is the motion of the rings")
        self.period = float(period)
        self.model, self.one_period = model, RunState(model, self.period)
        self.method = method or choose_method(self.one_period)[0]
        self.size = model.unknowns.n if model.unknowns.massless else model.unknowns.n_mechanical
        self.scales = model.scales[: self.size]
        self.turns_per_period = self.period * abs(scene.shaft.speed) / (2 * math.pi)

    def step(self, x) -> np.ndarray:
        """The unknowns (n,) one period later.  Raises SceneError for a ring that sticks, SolverFailure."""
        run = self.one_period
        if run.stick_slip:
            key = f"{RING_NAMES[run.stick_slip.rings[0]]}.secondary_seal.law"
            raise SceneError(key, "a ring that sticks", 'law = "regularised" for exponents')
        y = np.zeros(run.model.unknowns.size)
        y[: self.size] = x
        tolerance = tolerance_for(self.method, self.accuracy, run.memory)
        for _, block, _ in METHODS[self.method](run.segment(0), 0.0, y, self.method, tolerance, Counts()):
            last = block[-1]
        return last[: self.size].copy()

    def run(self, x, periods: int) -> PeriodSamples:
        """Whole periods from the unknowns x (n,); ends early if the film collapses."""
        parts, done = [], 0
        while done < periods:
            count = min(PIECE, periods - done)
            parts.append(self._piece(x, count))
            x, done = parts[-1].last, done + count
            if parts[-1].status != Status.OK:
                break
        return joined(parts)

    def _piece(self, x, periods: int) -> PeriodSamples:
        run = RunState(self.model, periods * self.period)
        run.y0[: self.size] = x
        sink, begun = Recorder(self.period / SAMPLES), clock.perf_counter()
        outcome = solve(run, self.method, self.accuracy, sink)
        t, q, rate = sink.arrays()
        whole = min(periods, int(t[-1] / self.period * (1 + 1e-9))) * SAMPLES
        touched = []
        run.contacts.tell(touched.extend, end=(outcome.tau, outcome.y))
        end = run.end_time(outcome.segment, outcome.tau)
        share = touching(touched, self.period * np.arange(whole // SAMPLES + 1), end)
        impulse = float(outcome.y[run.model.unknowns.impulse]) if run.model.unknowns.extended else 0.0
        spent = clock.perf_counter() - begun
        return PeriodSamples(
            **self.looked_at(t[:whole], q[:whole], rate[:whole], run), touching=share,
            contacts=sum(e["kind"] == "contact" for e in touched), impulse=impulse / periods,
            last=outcome.y[: self.size].copy(), status=outcome.status, message=outcome.message,
            evaluations=outcome.counts.rhs / periods, wall_time=spent / periods,
        )  # fmt: skip

    def looked_at(self, t, q, rate, run=None) -> dict:
        """What is kept of a motion sampled SAMPLES times a period: displacements and rates (m, n) at times `t` (m,)
        (s); the arrays of PeriodSamples but `touching` and `last`, by name."""
        run = run or self.one_period
        starts = np.array([interval.time for interval in run.intervals])
        indices = np.searchsorted(starts, t * (1 + 1e-12), side="right") - 1
        parts = []
        for k in np.unique(indices):
            inside = indices == k
            parts.append(signals(run.segment(int(k)), t[inside] - starts[k], q[inside], rate[inside]))
        names = parts[0] if parts else ()
        seen = {name: np.concatenate([p[name] for p in parts]).reshape(-1, SAMPLES) for name in names}
        if not seen:
            return dict.fromkeys(("section", "lowest"), np.empty(0)) | dict.fromkeys(
                ("tilt", "ring", "h_min", "contact_force", "friction_power", "contact_power"), np.empty((0, SAMPLES))
            )
        tilt = seen["relative_tilt_x"] + 1j * seen["relative_tilt_y"]
        ring = "stator" if run.model.unknowns.floats[0] else "rotor"
        torque = seen.get("contact_torque", np.zeros(tilt.shape))
        spin = self.scene.shaft.speed - self.scene.stator.speed
        return {
            "section": tilt[:, 0], "tilt": tilt, "ring": seen[f"{ring}_tilt_x"], "h_min": seen["h_min"],
            "contact_force": seen.get("contact_force", np.zeros(tilt.shape)), "friction_power": seen["friction_power"],
            "contact_power": torque * spin, "lowest": dips(seen["h_min"]),
        }  # fmt: skip

    def tangents(self, x, q, samples: list | None = None):
        """One period by DOP853: the unknowns (n,) and the tangents (n, k) from `x` (n,) and `q` (n, k), in units of the
        scales; keeps the motion, SAMPLES times, in `samples` as (displacements, rates).

        **Source** Hairer, Norsett & Wanner (1993), Solving ODEs I (DOP853); variations by central differences.
        **Valid** rings with mass that do not stick (SceneError); raises SolverFailure.
        """
        from scipy.integrate import DOP853

        run, n, k = self.one_period, self.size, q.shape[1]
        if run.model.unknowns.has_residual_form or run.stick_slip:
            raise SceneError("run.solver", "a massless ring, or one that sticks", "rings with mass, friction smooth")
        segment = run.segment(0)
        y, yp, scales = np.zeros(segment.size), np.zeros(segment.size), self.scales

        def rate(tau, z):
            out = np.empty_like(z)
            y[:n] = z[:n]
            segment.rhs(tau, y, yp)
            out[:n] = yp[:n]
            vectors, moved = z[n:].reshape(k, n), out[n:].reshape(k, n)
            for v, dv in zip(vectors, moved, strict=True):
                # A tangent grows as it goes: the step keeps its length.
                size = ACROSS / max(float(np.linalg.norm(v)), 1e-30)
                y[:n] = z[:n] + size * scales * v
                segment.rhs(tau, y, yp)
                dv[:] = yp[:n]
                y[:n] = z[:n] - size * scales * v
                segment.rhs(tau, y, yp)
                dv[:] = (dv - yp[:n]) / (2 * size * scales)
            return out

        tolerance = tolerance_for("dop853", self.accuracy, run.memory)
        relative = np.concatenate([np.full(n, max(tolerance, 2.3e-14)), np.full(k * n, TANGENT)])
        absolute = np.concatenate([tolerance * scales, np.full(k * n, TANGENT)])
        solver = DOP853(rate, 0.0, np.concatenate([x, q.T.ravel()]), self.period, rtol=relative, atol=absolute)
        due, done = self.period * np.arange(SAMPLES) / SAMPLES, 0
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise SolverFailure(f"dop853 gave up on the tangents: {message}")
            last = int(np.searchsorted(due, solver.t, side="left"))
            if samples is not None and last > done:
                seen = solver.dense_output()(due[done:last])[:n].T
                samples.append((seen[:, : segment.n], seen[:, segment.rate_places]))
                done = last
        return solver.y[:n].copy(), solver.y[n:].reshape(k, n).T.copy()


def touching(touched: list[dict], starts, end: float) -> np.ndarray:
    """Share (m,) of each period, `starts` (m + 1,) (s), in contact; `touched` the contacts as events, `end` (s) of the
    run for one that goes on."""
    spans = [(e["time"], e["lift_off"] if np.isfinite(e["lift_off"]) else end)
             for e in touched if e["kind"] == "contact"]  # fmt: skip
    total = np.zeros(len(starts))
    for a, b in spans:
        total += np.clip(starts - a, 0.0, b - a)
    return np.diff(total) / np.diff(starts)


def dips(h) -> np.ndarray:
    """Smallest (m,) of each row of samples (m, samples) of a smooth series: the vertex of a parabola where it
    is low."""
    flat = h.ravel()
    at = np.clip(np.argmin(h, axis=1) + h.shape[1] * np.arange(len(h)), 1, len(flat) - 2)
    a, b, c = flat[at - 1], flat[at], flat[at + 1]
    bend = a - 2 * b + c
    vertex = b - (a - c) ** 2 / (8 * np.where(bend > 0, bend, np.inf))
    return np.minimum(h.min(axis=1), np.where((b <= a) & (b <= c), vertex, b))


def joined(parts: list[PeriodSamples]) -> PeriodSamples:
    """Runs that follow each other as one: impulse, evaluations and wall time per period are their means, contacts their
    sum."""
    if len(parts) == 1:
        return parts[0]
    rows = {name: np.concatenate([getattr(p, name) for p in parts]) for name in PeriodSamples.__annotations__
            if isinstance(getattr(parts[0], name), np.ndarray) and name != "last"}  # fmt: skip
    weights = np.array([max(len(p.section), 1) for p in parts], dtype=float)
    means = {name: float(np.average([getattr(p, name) for p in parts], weights=weights))
             for name in ("impulse", "evaluations", "wall_time")}  # fmt: skip
    # A contact that goes on over the seam of two pieces counts once more: as little as one in PIECE periods.
    return PeriodSamples(**rows, **means, contacts=sum(p.contacts for p in parts), last=parts[-1].last,
                 status=parts[-1].status, message=parts[-1].message)  # fmt: skip


def share_below(h, level: float) -> np.ndarray:
    """Share (m,) of each row (m, samples) of an evenly sampled film (m) below a level (m), straight between samples."""
    flat = h.ravel()
    a, b = flat - level, np.append(flat[1:], flat[-1]) - level
    below = np.where(a < 0, 1.0, 0.0)
    crossing = a * b < 0
    part = np.abs(a) / np.where(crossing, np.abs(a) + np.abs(b), 1.0)
    below = np.where(crossing, np.where(a < 0, part, 1.0 - part), below)
    return below.reshape(h.shape).mean(axis=1)


# What is ramped to its new value in time; anything else changes between two turns.
RAMPED = ("rotor.runout", "rotor.misalignment", "stator.misalignment", "shaft.speed")
# Highest order kept of a spectrum.
ORDERS = 5.0
# Distance of two neighbours, in units of the scales, and how much finer they are integrated.
FINER, APART = 100.0, 1e-4


def frozen_at_end(scene):
    """The scene with every function of time at its last value: what it drives to, closed by the law that its start
    decides."""
    film = scene.film
    if film.clearance is not None and any(
        isinstance(p, PiecewiseLinear) for p in (film.inner_pressure, film.outer_pressure)
    ):
        law = Interface(at_work(scene)[0], 1e-6).closing
        scene = with_values(scene, {"closing": Closing(law.balance_ratio, law.spring)})
    return tables_at_end(scene)


class FilmCollapsed(RuntimeError):
    """The film did not survive the way to a point: the sentence, and the cause where it is known."""

    def __init__(self, message: str, cause: Cause | None = None):
        super().__init__(message)
        self.cause = cause


def ramp_to(scene, key, last, x, point):
    """Unknowns (n,) after the ramp to the scene from the value `last` of `key` and its end `x` (n,), or from a seal
    without any misalignment (x None).  `point` {"accuracy", "ramp" (periods)}.  Raises FilmCollapsed."""
    starts = {key: last} if x is not None and key in RAMPED else {}
    if x is None:
        starts = {k: 0.0 for k in RAMPED[:3] if part(scene, k)}
    period_map = PeriodMap(scene, point["accuracy"])
    if not starts:
        return np.zeros(period_map.size) if x is None else x
    span, moving = point["ramp"] * period_map.period, scene
    if key == "shaft.speed" and x is not None:
        # Whole turns, so that the phases meet.
        span *= 2 * scene.shaft.speed / (scene.shaft.speed + last)
    for k, start in starts.items():
        moving = with_values(moving, {k: PiecewiseLinear((0.0, span), (start, part(scene, k)))})
    run = RunState(Model(moving, point["accuracy"]), span)
    if x is not None:
        run.y0[: period_map.size] = x
    outcome = solve(run, period_map.method, point["accuracy"], Recorder())
    if outcome.status != Status.OK:
        raise FilmCollapsed(outcome.message, outcome.cause)
    return outcome.y[: period_map.size]


def sweep_branch(scene, point: dict) -> dict:
    """{"rows": the points of one direction, each from the end of the one before}.

    `point` {"key", "values", "direction", and what `characterise` and `ramp_to` take}.  A row has `value`, `direction`,
    `start` ("continued" or "aligned"), `status`, and the keys of `characterise`, or `message` and `class` "collapse".
    """
    scene, x, last, rows = frozen_at_end(scene), None, None, []
    for value in point["values"]:
        here = with_values(scene, {point["key"]: value})
        row = {"value": value, "direction": point["direction"], "start": "continued" if x is not None else "aligned"}
        try:
            x, more = characterise(here, ramp_to(here, point["key"], last, x, point), point)
            rows.append(row | {"status": Status.OK, **more})
        except FilmCollapsed as lost:
            x = None
            rows.append(row | {"status": Status.COLLAPSED, "message": str(lost), "class": "collapse"})
        last = value
    return {"rows": rows}


def neighbours(scene, x, turns, accuracy, method=None):
    """Exponent per period by two trajectories over `turns` periods from `x` (n,), integrated FINER than the rest: their
    distance must be far above the integrator's error even after a period that draws them together."""
    fine = PeriodMap(scene, accuracy / FINER, method)
    return two_trajectories(fine.step, x, fine.scales, turns, distance=APART)


def characterise(scene, x, point) -> tuple[np.ndarray, dict]:
    """Where the motion ends up at one point: its last unknowns (n,), and what it is like.  Raises FilmCollapsed.

    `x` (n,) to start from; `point` {"accuracy", "drop" and "keep" (periods left out and kept), "exponent_turns"}.
    Returns `class`, `period` (returns), `distinct`, `contacts` per period, `contact_share`, `contact_force` over the
    closing force, `impulse` (N s), `contact_power` (W), `exponent`, `uncertainty`, `multiplier`, `section` [m][2]
    (rad), `h_min` [m] (m), `lines`, `orders`, `amplitude` (rad), `end` [n], `evaluations` and `wall_time` (s) per
    period.
    """
    period_map = PeriodMap(scene, point["accuracy"])
    for periods in (point["drop"], point["keep"]):
        turns = period_map.run(x, periods)
        x = turns.last
        if turns.status != Status.OK:
            raise FilmCollapsed(turns.message)
    model = period_map.model
    scale = model.clearance / model.face[1]
    exponent = neighbours(scene, x, point["exponent_turns"], point["accuracy"])
    size = max(scale, float(np.ptp(turns.section.real)), float(np.ptp(turns.section.imag)))
    period = time_series.period_of(turns.section[len(turns.section) // 2 :], size)
    points, still = time_series.distinct_points(turns.section, size), time_series.shrinking(turns.section)
    kind = time_series.classify(period, exponent.value, exponent.uncertainty, still, points)
    orders, amplitude = time_series.spectrum(turns.ring.ravel(), SAMPLES / period_map.turns_per_period)
    kept = orders <= ORDERS
    return x, {
        "class": "no contact" if not turns.touching.any() and period == 1 else kind,
        "period": period,
        "distinct": points,
        "contacts": turns.contacts / point["keep"],
        "contact_share": float(turns.touching.mean()),
        "contact_force": float(turns.contact_force.mean() / model.closing_force()),
        "impulse": turns.impulse,
        "contact_power": float(turns.contact_power.mean()),
        "exponent": exponent.value,
        "uncertainty": exponent.uncertainty,
        "multiplier": math.exp(exponent.value * period) if period else None,
        "section": [[float(s.real), float(s.imag)] for s in turns.section],
        "h_min": turns.lowest.tolist(),
        "lines": time_series.lines(orders, amplitude),
        "orders": orders[kept].tolist(),
        "amplitude": amplitude[kept].tolist(),
        "end": [float(v) for v in x],
        "evaluations": turns.evaluations,
        "wall_time": turns.wall_time,
    }
