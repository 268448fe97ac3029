"""What is observed of a run of a radial seal, and what that amounts to: gaps, loads, times on the shaft and the flow
that the gaps let by, over the whole of it (Watch), as series over time and fields around the shaft (`columns`), and as
its summary."""

import math

import numpy as np
from scipy.optimize import minimize_scalar

from ..archive import Fields, Series
from ..dynamics.intervals import constant_and_slope, modulo_turn
from ..quantities import everyday, in_words, quantity
from ..solvers.contract import Status
from ..solvers.run_error import missing_energy
from .equations import HELD, RIDING
from .followers import fastest, hangs_up, largest_eccentricity, needed_preload

# Places within each step, and their weights: Boole's rule.
PLACES = np.linspace(0.0, 1.0, 5)
WEIGHTS = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
SUMS = ("riding", "held", "impulse", "cubed")


class Watch:
    """An observer: of every follower the time (s) on the shaft and held by its flange, the impulse of its load (N s)
    and the integral of its gap cubed (m^3 s); over all, the largest gap and the least and largest load with when (s)
    and where (follower), None where there was none.  `begun` (s): nothing before counts."""

    def __init__(self, model, begun: float = 0.0):
        n = model.followers.count
        self.model, self.begun = model, begun
        self.riding, self.held, self.impulse, self.cubed = (np.zeros(n) for _ in SUMS)
        self.time = 0.0
        # Value, time, follower.
        self.extremes = dict.fromkeys(("largest_gap", "least_load", "largest_load"), (None, None, None))

    def begin(self, segment, tau, y):
        """Nothing to do."""

    def accept(self, block):
        """Take in a block's new steps."""
        segment, end = block.segment, block.t[block.end] if block.until is None else block.until
        edges = np.append(block.t[block.begin : block.end], end)
        edges = edges[edges + segment.time >= self.begun - 1e-12 * abs(end)]
        widths = np.diff(edges)
        # A run that goes on from its end has a step of no length, in which nothing can be interpolated.
        if not widths.sum() > 0.0:
            return
        taus = np.minimum((edges[:-1, None] + widths[:, None] * PLACES).ravel(), end)
        gaps, _, loads = segment.state(taus, *block.at(taus))
        rides, weights = segment.modes == RIDING, (widths[:, None] * WEIGHTS).ravel()
        self.time += float(widths.sum())
        self.riding += rides * widths.sum()
        self.held += (segment.modes == HELD) * widths.sum()
        self.impulse += rides * (weights @ loads)
        self.cubed += weights @ np.maximum(gaps, 0.0) ** 3
        self._see_gap(block, taus, gaps)
        among = np.flatnonzero(rides)
        for name, sign in (("least_load", -1.0), ("largest_load", 1.0)):
            # At the very end the load may have jumped: that is the next segment's.  Nor does one press that pulls: it
            # leaves, at the first instant of a run that was broken off there.
            seen = np.where(loads[:-1, among] < 0.0, -np.inf, sign * loads[:-1, among])
            if seen.size and seen.max() > -np.inf:
                at, j = np.unravel_index(seen.argmax(), seen.shape)
                self._take(name, sign, float(sign * seen[at, j]), segment.time + taus[at], among[j])

    def _see_gap(self, block, taus, gaps):
        """The largest gap, also between the places."""
        at, j = np.unravel_index(gaps.argmax(), gaps.shape)
        known, found, when = self.extremes["largest_gap"][0], float(gaps[at, j]), float(taus[at])
        if found <= 0.0 or (known is not None and found < 0.99 * known):
            return
        low, high = taus[max(at - 1, 0)], taus[min(at + 1, len(taus) - 1)]

        def negative(tau):
            here = np.array([tau])
            return -block.segment.state(here, *block.at(here))[0][0, j]

        if low < high:
            top = minimize_scalar(
                negative, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
            )
            if -top.fun > found:
                found, when = float(-top.fun), float(top.x)
        self._take("largest_gap", 1.0, found, block.segment.time + when, j)

    def _take(self, name, sign, value, time, j):
        known = self.extremes[name][0]
        if known is None or sign * value > sign * known:
            self.extremes[name] = (value, float(time), int(j))

    def state(self) -> dict:
        """What a continued run needs."""
        sums = {name: getattr(self, name).tolist() for name in SUMS}
        return {"time": self.time, "extremes": {name: list(row) for name, row in self.extremes.items()}, **sums}

    def restore(self, state: dict):
        """Go on from `state`."""
        self.time, self.extremes = state["time"], {name: tuple(row) for name, row in state["extremes"].items()}
        for name in SUMS:
            setattr(self, name, np.array(state[name]))

    def share(self, times) -> np.ndarray:
        """Times (n,) (s) as shares of what was watched."""
        return times / self.time if self.time else np.full(len(times), math.nan)


# Name: quantity or SI unit, and meaning.
SERIES = {
    "shaft_angle": ("angle", "shaft angle"),
    "shaft_speed": ("speed_rpm", "shaft speed"),
    "largest_gap": ("m", "largest gap between seal and shaft"),
    "contact_share": ("share", "share of the followers that ride on the shaft"),
    "least_load": ("N", "least load of a follower that rides, 0 if none does"),
    "load": ("N", "load of all followers on the shaft"),
    "friction_torque": ("friction_torque", "friction torque on the shaft"),
    "leakage_estimate": ("m^3/s", "leakage estimate: laminar flow through the gaps"),
}
FIELDS = {
    "gap": ("m", "gap between seal and shaft"),
    "follower_load": ("N", "load of a follower on the shaft"),
}


class RadialErrorScales:
    """What is compared of two runs, and its scales, as ErrorScales of a face seal: displacements and loads of all
    followers, over the length of the model and the largest load."""

    def __init__(self, model):
        self.n, self.length = model.followers.count, model.length

    def of(self, segment, taus, us, vs) -> np.ndarray:
        """Columns (m, 2 n) at segment times (m,) (s): displacements (m) and loads (N)."""
        _, around = columns(segment, taus, us, vs)
        return np.hstack([us, around["follower_load"]])

    def errors(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """How far (m, 2 n) the columns of two runs are apart, over the scales of the second."""
        loads = np.nanmax(np.abs(other[:, self.n :]), initial=0.0) or 1.0
        scales = np.concatenate([np.full(self.n, self.length), np.full(self.n, loads)])
        return np.abs(one - other) / scales


def archived_series(model, instants: int) -> tuple[dict[str, Series], Fields]:
    """Series by name and fields at so many instants, as an archive of this model keeps them."""

    def told(held, words):
        return Series(quantity(held).unit, words, *everyday(held))

    grid = {"theta": (told("angle", "angle, from the x axis"), model.followers.angles)}
    series, fields = ({name: told(*row) for name, row in table.items()} for table in (SERIES, FIELDS))
    return series, Fields(fields, grid, instants)


def columns(segment, taus, us, vs) -> tuple[dict, dict]:
    """Series (m,) and fields (m, n) at segment times `taus` (m,) (s), displacements and rates (m, n)."""
    scene, followers = segment.model.scene, segment.model.followers
    gaps, _, loads = segment.state(taus, us, vs)
    rides = segment.modes == RIDING
    gaps, loads = np.maximum(gaps, 0.0), np.where(rides, np.maximum(loads, 0.0), 0.0)
    speed, slope = constant_and_slope(scene.shaft.speed, segment.interval)
    total = loads.sum(axis=1)
    found = {
        "time": segment.time + taus,
        "shaft_angle": np.mod(modulo_turn(segment.interval.rotor_angle) + taus * (speed + 0.5 * slope * taus),
                              2.0 * math.pi),
        "shaft_speed": speed + slope * taus,
        "largest_gap": gaps.max(axis=1),
        "contact_share": np.full(len(taus), rides.mean()),
        "least_load": loads[:, rides].min(axis=1) if rides.any() else np.zeros(len(taus)),
        "load": total,
        "friction_torque": scene.seal.friction_coefficient * scene.shaft.radius * total,
        "leakage_estimate": conductance(scene) * followers.arc * (gaps**3).sum(axis=1),
    }  # fmt: skip
    return found, {"gap": gaps, "follower_load": loads}


def conductance(scene) -> float:
    """Flow (m^3/s) per length of circumference and gap cubed, dp / (12 mu width): laminar, along the shaft; 0 where the
    scene does not say what it takes."""
    seal = scene.seal
    if not (seal.contact_width and seal.viscosity):
        return 0.0
    return seal.pressure_difference / (12.0 * seal.viscosity * seal.contact_width)


# Share of a run in which nothing but the first look at it lies.
AT_ONCE = 1e-9


def summary_of(scenario, run, plan, outcome) -> dict:
    """The numbers of `run --json`, SI; `settled` are those of the second half of the run."""
    scene, followers, contacts = run.model.scene, run.model.followers, run.stick_slip
    speed = fastest(scene.shaft)
    needed = needed_preload(followers, scene.shaft, speed)
    kind = "lip" if scene.lip else "circumferential"
    first = contacts.first_lift
    if first is not None and first < AT_ONCE * run.duration:
        first = 0.0
    summary = {
        "status": outcome.status,
        "message": outcome.message,
        "seal": kind,
        "model": {"followers": followers.count, "solver": plan.method, "reasons": [f"solver: {plan.why}"],
                  "unused": []},
        "follower": {
            "mass": followers.mass, "stiffness": float(followers.modal_stiffness[1 % followers.count]),
            "damping": followers.damping, "preload": followers.preload, "friction": followers.friction,
            "arc": followers.arc,
        },
        "whole": _watch_numbers(run.extrema, scene, followers),
        "settled": _watch_numbers(run.contacts, scene, followers),
        "contact": {**contacts.counts, "first_lift": first, "energy_lost": contacts.dropped,
                    "followers_held_at_end": int((contacts.modes == 1.0).sum()),
                    "followers_riding_at_end": int((contacts.modes == 2.0).sum())},
        "closed_form": {
            "speed": abs(speed),
            "needed_preload": needed,
            "margin": followers.preload / needed if needed else None,
            "largest_eccentricity": largest_eccentricity(followers, scene.shaft, speed),
            "hangs_up": hangs_up(followers),
        },
        "energy_residual": outcome.energy_residual,
        "warnings": [],
        "counts": {name: getattr(outcome.counts, name) for name in ("rhs", "steps", "jacobians", "restarts")},
        "tolerance": outcome.tolerance,
        "accuracy": run.model.accuracy,
        "end": {"time": run.end_time(outcome.segment, outcome.tau), "asked": run.duration},
    }  # fmt: skip
    summary["warnings"] += _warnings(summary, scene)
    lost = missing_energy(outcome.energy_residual, run.model.accuracy)
    if outcome.status == Status.OK and lost:
        summary |= {"status": Status.INACCURATE, "message": lost}
    return summary


def _watch_numbers(watch, scene, followers) -> dict:
    """Shares, loads and leakage over the time that was watched."""
    time = watch.time or np.nan
    riding, held = watch.share(watch.riding), watch.share(watch.held)
    (gap, gap_time, gap_at), (least, least_time, _), (most, _, _) = (
        watch.extremes[name] for name in ("largest_gap", "least_load", "largest_load")
    )
    angle = None if gap_at is None else float(followers.angles[gap_at])
    load = float(watch.impulse.sum() / time)
    return {
        "contact_share": float(riding.mean()), "least_contact_share": float(riding.min()),
        "held_share": float(held.mean()),
        "largest_gap": gap or 0.0, "largest_gap_time": gap_time, "largest_gap_angle": angle,
        "least_load": least, "least_load_time": least_time,
        "largest_load": most,
        "load": load, "friction_torque": scene.seal.friction_coefficient * scene.shaft.radius * load,
        "leakage_estimate": conductance(scene) * followers.arc * float(watch.cubed.sum()) / time,
    }  # fmt: skip


def _warnings(summary, scene) -> list[str]:
    said, whole, settled = [], summary["whole"], summary["settled"]
    if summary["contact"]["lift"]:
        lost = (f"contact is lost: first at t = {summary['contact']['first_lift']:.4g} s, in the whole run by up to "
                f"{in_words('largest_gap', whole['largest_gap'])}")  # fmt: skip
        if np.isfinite(settled["contact_share"]):
            share = 1.0 - settled["contact_share"]
            lost += (f"; settled, a follower is off the shaft {in_words('share', share, 3)} of the time, by up to "
                     f"{in_words('largest_gap', settled['largest_gap'])}")  # fmt: skip
        said.append(lost)
    if summary["closed_form"]["hangs_up"]:
        said.append("the flange's friction is as large as the preload: segments hang up where the shaft leaves them")
    if scene.shaft.offset + sum(a for _, a, _ in scene.shaft.waves) > 0.1 * scene.shaft.radius:
        said.append("the shaft is off by more than a tenth of its radius: radial motion is not small")
    return said
