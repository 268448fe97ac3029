"""What a run of a radial seal amounts to."""

import numpy as np

from ..solvers.contract import Status
from ..solvers.energy_audit import missing_energy
from .followers import fastest, hangs_up, largest_eccentricity, needed_preload
from .observers import conductance

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
        "whole": _watched(run.extrema, scene, followers),
        "settled": _watched(run.contacts, scene, followers),
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


def _watched(watch, scene, followers) -> dict:
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
                f"{1e6 * whole['largest_gap']:.4g} um")  # fmt: skip
        if np.isfinite(settled["contact_share"]):
            share = 100.0 * (1.0 - settled["contact_share"])
            lost += (f"; settled, a follower is off the shaft {share:.3g} % of the time, by up to "
                     f"{1e6 * settled['largest_gap']:.4g} um")  # fmt: skip
        said.append(lost)
    if summary["closed_form"]["hangs_up"]:
        said.append("the flange's friction is as large as the preload: segments hang up where the shaft leaves them")
    if scene.shaft.offset + sum(a for _, a, _ in scene.shaft.waves) > 0.1 * scene.shaft.radius:
        said.append("the shaft is off by more than a tenth of its radius: radial motion is not small")
    return said
