"""Sealing number: does secondary-seal friction lubricate the faces?  Ludwig & Allen's closed form, their balance with
the actual film, the same in time, and the ring let go, over F_s/F_d."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ...analysis import quasi_static
from ...closed_form import ludwig_allen
from ...closed_form import ludwig_allen as closed
from ...dynamics.model import Model
from ...numerics.piecewise_linear import initially
from ...status import Status
from . import released as free

ALONG = {"line": ("force_ratio",), "foreseen": ("force_ratio",), "map": ("guide",),
         "map/closed_form": ("force_ratio",), "balance": ("force_ratio",), "published": ("force_ratio",),
         "released": ("force_ratio",)}  # fmt: skip
# Of what is left a film is a length; of what the released ring has, three: mean, least and largest of its last turns.
units = {"mean_film": "m", "least_film": "m", "ratio/mean_film": "1", "ratio/least_film": "1", "direction": "rad",
         "tilt_stiffness": "N*m/rad", "*": "1"}  # fmt: skip

# Turns (radians of the shaft) a quasi-static run may take; how far above the balance it starts.
RADIANS, ABOVE = 300.0, 1.02
RATIOS = (1.2, 1.3, 1.45, 1.6, 1.65, 1.72, 1.8, 2.0, 2.5, 3.0, 5.0, 10.0, 20.0)
Positive, Start = Annotated[float, Field(gt=0)], Literal["closed form", "open"]
OWN, NEEDED = "own", "as the closed form needs"


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("ludwig_allen", 66)


@dataclass(frozen=True)
class Settings:
    """Force ratios, and the released rings."""

    force_ratios: Annotated[tuple[Positive, ...], Field(min_length=1)] | Positive = RATIOS
    """F_s/F_d."""
    starts: tuple[Start, ...] | Start = ("closed form", "open")
    """Where a released ring starts: on the closed form's film, or open: square to its shaft, at rest."""
    inertia: tuple[Positive, ...] | Positive = (1.0,)
    """Multiples of the ring's mass and inertias."""
    turns: Positive = 80.0
    """Turns that a released ring runs."""
    last: Positive = 4.0
    """Turns of these that count."""
    accuracy: Positive = 1e-3
    """Accuracy of these runs."""


def run(scenario, settings, tools) -> dict:
    """Closed form, static root, quasi-static and released films over the force ratio."""
    scene = scenario.scene
    ring = free.ring_of(scene)
    how = {"turns": settings.turns, "last": settings.last, "accuracy": settings.accuracy}
    ratios, starts, inertias = (
        np.atleast_1d(x).tolist() for x in (settings.force_ratios, settings.starts, settings.inertia)
    )
    ratios = sorted(set(ratios))
    balances = tools.map(partial(balance, scene), [{"force_ratio": q} for q in ratios], "balance")
    points = [
        {"force_ratio": q, "support": support, "start": start, "inertia": inertia}
        for q in ratios
        for support in (OWN, NEEDED)
        for start in starts
        for inertia in inertias
        if support == OWN or q > closed.LEAST_FORCE_RATIO
    ]
    released = tools.map(partial(release, scene), [{**how, **point} for point in points], "released")
    answer = {
        "seal": {**vars(ring), "sliding_speed": ring.sliding_speed, "spring_force": ring.spring_force},
        "guide": own_guide(scene, ring),
        "least_force_ratio": closed.LEAST_FORCE_RATIO,
        "least_attracting_force_ratio": closed.LEAST_ATTRACTING_FORCE_RATIO,
        "balance": [{"force_ratio": q, **row} for q, row in zip(ratios, balances, strict=True)],
        "released": [{**point, **row} for point, row in zip(points, released, strict=True)],
        "published": [{"force_ratio": row.force_ratio, "mean_film": row.mean_film,
                       "sealing_number": row.mean_film**2 / closed.LUDWIG_ALLEN_GROUP}
                      for row in closed.LUDWIG_ALLEN],
        "line": _line(max(ratios)),
        "foreseen": _foreseen_line(scene, ring, max(ratios)),
        "map": _map(max(ratios)),
    }  # fmt: skip
    return {**answer, "verdict": sentences(answer)}


def own_guide(scene, ring) -> float:
    """K_s gamma / (R F_s) of the scene's support, stretched by the seat's tilt."""
    seat = initially(scene.stator.misalignment)
    return scene.rotor.support.tilt()[0] * seat / (ring.mean_radius * ring.spring_force)


def _line(highest) -> dict:
    """The closed form as a line, dense where it rises."""
    q = closed.LEAST_FORCE_RATIO * (1 + np.geomspace(1e-6, max(highest / closed.LEAST_FORCE_RATIO - 1, 0.1), 200))
    return {"force_ratio": q.tolist(), "sealing_number": closed.sealing_number(q).tolist()}


def _foreseen_line(scene, ring, highest) -> dict:
    """The released ring's film on the scene's own support, where it has one."""
    q = np.geomspace(4 / np.pi, min(closed.LEAST_FORCE_RATIO * 1.5, highest), 120)
    films, rest = [], Model(scene, 1e-3).clearance
    for ratio in q:
        try:
            films.append(
                (float(ratio), free.film_on(free.with_force_ratio(scene, float(ratio)), rest)[0] ** 2 / ring.group)
            )
        except ValueError:
            continue
    ratios, numbers = zip(*films, strict=True) if films else ((), ())
    return {"force_ratio": list(ratios), "sealing_number": list(numbers)}


def _map(highest) -> dict:
    """Where a released ring hangs up, rides and straightens, over the guide; and what the closed form needs."""
    guide = np.linspace(0.0, 1.0, 400, endpoint=False)
    edges = np.minimum([ludwig_allen.film_range(k) for k in guide], 10 * highest)
    q = np.array(_line(highest)["force_ratio"])
    return {"guide": guide.tolist(), "hang_up_below": edges[:, 0].tolist(), "straightens_above": edges[:, 1].tolist(),
            "closed_form": {"force_ratio": q.tolist(), "guide": closed.amplitude_ratio(q).tolist()}}  # fmt: skip


# --- points -----------------------------------------------------------------------------------------------


def _films(mean, amplitude, ring) -> dict:
    return {"mean_film": float(mean), "least_film": float(mean - amplitude), "amplitude_ratio": float(amplitude / mean),
            "sealing_number": float(mean) ** 2 / ring.group}  # fmt: skip


def balance(scene, point: dict) -> dict:
    """Ludwig & Allen's balance at one force ratio: closed form, root on the actual film, and in time."""
    ring = free.ring_of(scene)
    q = point["force_ratio"]
    row = {"closed_form": None, "static": None, "static_said": ""}
    start = np.array(free.start_film(q, ring))
    try:
        films = closed.equilibrium(q, ring.group)
        row["closed_form"] = _films(*films, ring)
        start = ABOVE * np.array(films)
        row["static"] = _films(*quasi_static.static_root(q, films, ring), ring)
    except ValueError as error:
        row["static_said"] = str(error)
    settled = quasi_static.quasi_static(q, start, ring, duration=RADIANS / ring.shaft_speed)
    row["quasi_static"] = {"status": settled.status, "message": settled.message}
    if settled.status == "settled":
        row["quasi_static"] |= _films(*settled.films, ring)
    return row


def release(scene, point: dict) -> dict:
    """What becomes of the released ring at one force ratio."""
    ring, q = free.ring_of(scene), point["force_ratio"]
    scene = replace(scene, rotor=_heavier(scene.rotor, point["inertia"]))
    guide = None if point["support"] == OWN else ludwig_allen.closed_form_guide(q)
    scene = free.started(free.with_force_ratio(scene, q, guide), point["start"])
    # Landing on the asperities may defeat a method at one accuracy and not at the next.
    for accuracy in (point["accuracy"], point["accuracy"] / 3, 3 * point["accuracy"]):
        told = free.released(scene, point["turns"], point["last"], accuracy)
        if told.status != Status.FAILED:
            break
    row = {name: getattr(told, name) for name in ("status", "message", "mean_film", "least_film", "share", "direction",
           "whirl", "contact_share", "stuck_share", "evaluations", "energy_residual")}  # fmt: skip
    row |= {"accuracy": accuracy, "tilt_stiffness": scene.rotor.support.tilt()[0], "guide": _guide(scene, told, ring)}
    row["sealing_number"] = [h**2 / ring.group for h in told.mean_film]
    row["foreseen"], row["foreseen_said"], row["ratio"] = None, "", None
    try:
        row["foreseen"] = _films(*free.film_on(scene)[:2], ring)
    except ValueError as error:
        row["foreseen_said"] = str(error)
    if q > closed.LEAST_FORCE_RATIO:
        was = _films(*closed.equilibrium(q, ring.group), ring)
        row["ratio"] = {"mean_film": told.mean_film[0] / was["mean_film"],
                        "least_film": told.least_film[0] / was["least_film"],
                        "sealing_number": row["sealing_number"][0] / was["sealing_number"]}  # fmt: skip
    return row


def _guide(scene, told, ring) -> float:
    """What the support carried in the end, K_s gamma / (R F_s)."""
    relative = told.amplitude[0] / ring.mean_radius * np.exp(1j * told.direction)
    tilt = abs(initially(scene.stator.misalignment) - relative)
    return float(scene.rotor.support.tilt()[0] * tilt / (ring.mean_radius * ring.spring_force))


def _heavier(rotor, factor):
    return replace(rotor, mass=factor * rotor.mass, transverse_inertia=factor * rotor.transverse_inertia,
                   polar_inertia=factor * rotor.polar_inertia)  # fmt: skip


# --- in words ---------------------------------------------------------------------------------------------


def tables(answer) -> list:
    """The balance on the actual film, and what becomes of the released ring."""
    q = ("F_s/F_d", "force_ratio")
    balance = (q, ("h0 of the closed form, um", "closed_form.mean_film", 1e6),
               ("static, um", "static.mean_film", 1e6), ("quasi-static, um", "quasi_static.mean_film", 1e6),
               ("quasi-static", "quasi_static.status"))  # fmt: skip
    released = (q, ("tilt spring", "support"), ("start", "start"), ("ring", "status"), ("h0, um", "film", 1e6),
                ("h1/h0", "share"), ("foreseen h0, um", "foreseen.mean_film", 1e6),
                ("on asperities, % of spring", "contact_share", 100))  # fmt: skip
    return [(answer["balance"], balance),
            ([{**row, "film": row.get("mean_film", [None])[0]} for row in answer["released"]], released)]  # fmt: skip


def sentences(answer) -> list[str]:
    """The verdict: the released ring on its own support, the balance that the closed form states, and the released
    ring on a support that carries what the closed form leaves out."""
    own, kept = _rows(answer, OWN), [row for row in _rows(answer, NEEDED) if row["status"] == "film"]
    low, high = ludwig_allen.film_range(answer["guide"])
    lines = [f"What friction makes of the ring on its own support (tilt spring {answer['guide']:.2g} R F_s), F_s/F_d: "
             f"{_fates(own)}; foreseen a film from {low:.4g} to {high:.4g}."]  # fmt: skip
    if static := [row for row in answer["balance"] if row.get("static")]:
        off = max(abs(row["static"]["mean_film"] / row["closed_form"]["mean_film"] - 1) for row in static)
        least, attracting = answer["least_force_ratio"], answer["least_attracting_force_ratio"]
        lines.append(f"Ludwig & Allen's balance on the actual film has the closed form's h0 within {100 * off:.2g} %; "
                     f"none below {least:.4f}, one that repels below {attracting:.4f}.")  # fmt: skip
    if kept:
        off = max(abs(row["ratio"]["mean_film"] - 1) for row in kept)
        lines.append(f"With a tilt spring that carries R F_s h1/h0 the released ring keeps that h0 within "
                     f"{100 * off:.2g} % for F_s/F_d {_listed([row['force_ratio'] for row in kept])}.")  # fmt: skip
    return lines


def _rows(answer, support):
    rows = [row for row in answer["released"] if row["support"] == support and "failed" not in row]
    return [row for row in rows if row["start"] == rows[0]["start"]]


def _fates(rows) -> str:
    """ "hang-up at 1.2; film at 1.3 to 1.65; ..." """
    words = []
    for row in rows:
        if not words or words[-1][0] != row["status"]:
            words.append((row["status"], []))
        words[-1][1].append(row["force_ratio"])
    return "; ".join(f"{status} at {_listed(ratios)}" for status, ratios in words) or "no run ended"


def _listed(ratios) -> str:
    return f"{ratios[0]:g}" if ratios[0] == ratios[-1] else f"{ratios[0]:g} to {ratios[-1]:g}"
