"""Sealing number: does secondary-seal friction lubricate the faces?  Ludwig & Allen's closed form, their balance with
the actual film, the same in time, and the ring let go, over F_s/F_d; under sealed pressures too."""

from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ...analysis import quasi_static
from ...answers import Answer, Axis, Level, Panel, Series, Table
from ...closed_form import ludwig_allen as closed
from ...closed_form import sealed_wedge as sealed
from ...dynamics.model import Model
from ...dynamics.warm_state import at_work
from ...scene.rings import INERTIAL, STATOR
from ...status import Status
from .. import Info
from . import released as free

INFO = Info(
    timed=("ludwig_allen", 66),
    asks="Does friction of the secondary seal lubricate the faces?",
    # Of the rest a film is a length; of what the released ring has, three: mean, least and largest of its last turns.
    units={"speed": "rad/s", "amplitude": "m", "mean_film": "m", "least_film": "m", "ratio/mean_film": "1",
           "ratio/least_film": "1", "direction": "rad", "tilt_stiffness": "N*m/rad", "*": "1"},
    along={"map": ("guide",), "over_speed": ("speed",)}
    | dict.fromkeys(("line", "foreseen", "map/closed_form", "balance", "published", "released"), ("force_ratio",)),
)  # fmt: skip
# Turns (radians of the shaft) a quasi-static run may take; where it starts, over the balance, and under pressure, where
# a film a little thicker already hangs.
RADIANS, ABOVE, BELOW = 300.0, 1.02, 0.98
# Speeds at which films are foreseen.
SPEEDS = 40
RATIOS = (1.2, 1.3, 1.45, 1.6, 1.65, 1.72, 1.8, 2.0, 2.5, 3.0, 5.0, 10.0, 20.0)
Positive, Start = Annotated[float, Field(gt=0)], Literal["closed form", "open"]
OWN, NEEDED = "own", "as the closed form needs"
HOLLOW = "hollow: tilt spring as the closed form needs"
# One fate, one colour and mark, in all panels.
FATES = {"film": "good circle", "straightened": "bad down", "hang-up": "fourth cross", "rubs": "warn diamond",
         "moving": "blue square", "failed": "black plus"}  # fmt: skip


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


def run(scenario, settings, tools) -> Answer:
    """Closed form, static root, quasi-static and released films over the force ratio."""
    scene = at_work(scenario.scene)[0]
    ring = free.ring_of(scene)
    how = {"turns": settings.turns, "last": settings.last, "accuracy": settings.accuracy}
    ratios, starts, inertias = (
        np.atleast_1d(x).tolist() for x in (settings.force_ratios, settings.starts, settings.inertia)
    )
    ratios = sorted(set(ratios))
    balances = tools.map(partial(balance, scene), [{"force_ratio": q} for q in ratios], "balance", ("force_ratio",))
    points = [
        {**how, "force_ratio": q, "support": support, "start": start, "inertia": inertia}
        for q in ratios
        for support in (OWN, NEEDED)
        for start in starts
        for inertia in inertias
        if support == OWN or q > closed.least_force_ratio(ring.edges)
    ]
    released = tools.map(partial(release, scene), points, "released", ("force_ratio", "support", "start", "inertia"))
    answer = {
        "seal": {**vars(ring), "sliding_speed": ring.sliding_speed, "spring_force": ring.spring_force,
                 "edges": ring.edges._asdict()},
        "guide": own_guide(scene, ring),
        "least_force_ratio": closed.least_force_ratio(ring.edges),
        "least_attracting_force_ratio": closed.least_attracting_force_ratio(ring.edges),
        "balance": balances,
        "released": released,
        "published": [{"force_ratio": row.force_ratio, "mean_film": row.mean_film,
                       "sealing_number": row.mean_film**2 / closed.LUDWIG_ALLEN_GROUP}
                      for row in closed.LUDWIG_ALLEN if not ring.edges.sealed],
        "line": _line(ring, max(ratios)),
        "foreseen": _foreseen_line(scene, ring, max(ratios)),
        "map": _map(ring, max(ratios)),
        "over_speed": _over_speed(scene, ring),
    }  # fmt: skip
    torn = "no less than the cavity's" if ring.edges.sealed else "ambient where it diverges"
    notes = ["Their film, which the scene's has to be for the answer to be theirs, is flat and planar, constant over "
             f"the face, its pressure {torn}."]  # fmt: skip
    if ring.edges.sealed:
        least, most, _ = sealed.moment_limits(ring.edges)
        notes.append(f"Under the sealed pressure F_s is the {ring.spring_force:.4g} N of the closing force that the "
                     "pressures between flat faces leave; the wedge cavitates over part of the width.")  # fmt: skip
        if not most > least:
            notes.append(f"A film that tilts more is held with less moment, from {least:.4g} R F_s between parallel "
                         "faces on: a released ring keeps one only where h1/R nears the seat's tilt.")  # fmt: skip
    if free.pair_of(scene).floating == STATOR:
        notes.append("The seat turns: closed form and balance have the ring's friction alone, as theirs do; what is "
                     "foreseen and run has the inertia of its nodding too.")  # fmt: skip
    return Answer(answer, _found(answer), _tables(answer), _panels(answer), notes)


def own_guide(scene, ring) -> float:
    """|K_s - I w^2| gamma / (R F_s) of the scene's support and (of a ring that nods) inertia, at the seat's tilt."""
    pair = free.pair_of(scene)
    return abs(pair.stiffness) * pair.tilt / (ring.mean_radius * ring.spring_force)


def _line(ring, highest) -> dict:
    """The closed form as a line, dense where it rises."""
    least = closed.least_force_ratio(ring.edges)
    q = least * (1 + np.geomspace(1e-6, max(highest / least - 1, 0.1), 100))
    return {"force_ratio": q.tolist(), "sealing_number": closed.sealing_number(q, ring.edges).tolist()}


def _foreseen_line(scene, ring, highest) -> dict:
    """The released ring's film on the scene's own support, where it has one."""
    least, most = closed.film_range(0.0, ring.edges)
    q = np.geomspace(least, min(most * 1.5, max(highest, least)), 120)
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


def _map(ring, highest) -> dict:
    """Where a released ring hangs up, rides and straightens, over the guide; and what the closed form needs."""
    guide = np.linspace(0.0, 1.0, 400, endpoint=False)
    ends = np.minimum([closed.film_range(k, ring.edges) for k in guide], 10 * highest)
    q = np.array(_line(ring, highest)["force_ratio"])
    return {"guide": guide.tolist(), "hang_up_below": ends[:, 0].tolist(), "straightens_above": ends[:, 1].tolist(),
            "closed_form": {"force_ratio": q.tolist(),
                            "guide": closed.closed_form_guide(q, ring.edges).tolist()}}  # fmt: skip


def _over_speed(scene, ring) -> dict:
    """Films to be expected with the scene's own friction over the shaft's speed, up to where the inertia of a ring that
    nods takes all the moment that a film has (of one that turns: twice its own speed); None where there is none."""
    pair, q, most = free.pair_of(scene), free.force_ratio_of(scene), 2.0 * ring.shaft_speed
    own, arm = pair.ring.support.tilt()[0], ring.mean_radius * ring.spring_force / pair.tilt
    inertia = (own - pair.stiffness) / ring.shaft_speed**2
    if inertia > 0.0:
        most = ((sealed.moment_limits(ring.edges)[1] * arm + own) / inertia) ** 0.5
    speeds, films = np.linspace(0.0, most, SPEEDS + 1)[1:], []
    guides = (inertia * speeds**2 - own) / arm
    for speed, guide in zip(speeds, guides, strict=True):
        try:
            films.append(closed.film(q, float(guide), ring.group * speed / ring.shaft_speed, ring.edges))
        except ValueError:
            films.append((None, None))
    mean, amplitude = zip(*films, strict=True)
    return {"speed": speeds.tolist(), "moment_ratio": closed.moment_ratio(q, guides).tolist(), "mean_film": list(mean),
            "amplitude": list(amplitude)}  # fmt: skip


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
        films = closed.equilibrium(q, ring.group, ring.edges)
        row["closed_form"] = _films(*films, ring)
        start = (BELOW if ring.edges.sealed else ABOVE) * np.array(films)
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
    pair = free.pair_of(scene)
    heavier = replace(pair.ring, **{name: point["inertia"] * getattr(pair.ring, name) for name in INERTIAL})
    scene = replace(scene, **{pair.name: heavier})
    guide = None if point["support"] == OWN else float(closed.closed_form_guide(q, ring.edges))
    scene = free.started(free.with_force_ratio(scene, q, guide), point["start"])
    # Landing on the asperities may defeat a method at one accuracy and not at the next.
    for accuracy in (point["accuracy"], point["accuracy"] / 3, 3 * point["accuracy"]):
        told = free.released(scene, point["turns"], point["last"], accuracy)
        if told.status != Status.FAILED:
            break
    row = {name: getattr(told, name) for name in ("status", "message", "mean_film", "least_film", "share", "direction",
           "whirl", "contact_share", "stuck_share", "evaluations", "energy_residual")}  # fmt: skip
    row |= {
        "accuracy": accuracy,
        "tilt_stiffness": free.pair_of(scene).ring.support.tilt()[0],
        "guide": _guide(scene, told, ring),
    }
    row["sealing_number"] = [h**2 / ring.group for h in told.mean_film]
    row["foreseen"], row["foreseen_said"], row["ratio"] = None, "", None
    try:
        row["foreseen"] = _films(*free.film_on(scene)[:2], ring)
    except ValueError as error:
        row["foreseen_said"] = str(error)
    if q > closed.least_force_ratio(ring.edges):
        was = _films(*closed.equilibrium(q, ring.group, ring.edges), ring)
        row["ratio"] = {"mean_film": told.mean_film[0] / was["mean_film"],
                        "least_film": told.least_film[0] / was["least_film"],
                        "sealing_number": row["sealing_number"][0] / was["sealing_number"]}  # fmt: skip
    return row


def _guide(scene, told, ring) -> float:
    """What support and inertia carried in the end, |K_s - I w^2| gamma / (R F_s)."""
    relative = told.amplitude[0] / ring.mean_radius * np.exp(1j * told.direction)
    pair = free.pair_of(scene)
    return float(abs(pair.stiffness) * abs(pair.tilt - relative) / (ring.mean_radius * ring.spring_force))


# --- what is told -----------------------------------------------------------------------------------------


def _found(numbers) -> str:
    """What becomes of the released ring on its own support over the force ratio."""
    own, seal = _rows(numbers, OWN), numbers["seal"]
    low, high = closed.film_range(numbers["guide"], sealed.Edges(**seal["edges"]))
    fates = [(fate, [row["force_ratio"] for row in rows]) for fate, rows in groupby(own, key=lambda row: row["status"])]
    words = ["{} at {}".format(fate, " to ".join(dict.fromkeys((f"{q[0]:g}", f"{q[-1]:g}")))) for fate, q in fates]
    said = ", ".join(words) or "no run ended"
    foreseen = f"a film from {low:.4g} to {high:.4g}" if low < high else "no film"
    return f"The released ring over F_s/F_d: {said}; foreseen {foreseen}."


def _tables(numbers) -> list[Table]:
    """The balance on the actual film, what becomes of the released ring, and how far the closed form carries."""
    ratio, film = ("1", "F_s/F_d"), "film_thickness"
    columns = [ratio, (film, "h0 of the closed form"), (film, "static"), (film, "quasi-static"), ("1", "quasi-static")]
    names = ("closed_form", "static", "quasi_static")
    rows = [[row["force_ratio"], *((row.get(name) or {}).get("mean_film") for name in names),
             (row.get("quasi_static") or {}).get("status")] for row in numbers["balance"]]  # fmt: skip
    balances = Table("balance", columns, rows)
    columns = [ratio, ("1", "tilt spring"), ("1", "start"), ("1", "ring"), (film, "h0"), ("1", "h1/h0"),
               (film, "foreseen h0"), ("share", "of the spring on asperities")]  # fmt: skip
    rows = [[row["force_ratio"], row["support"], row["start"], row.get("status", "failed"),
             row.get("mean_film", [None])[0], _first(row.get("share")), (row.get("foreseen") or {}).get("mean_film"),
             _first(row.get("contact_share"))] for row in numbers["released"]]  # fmt: skip
    released = Table("released", columns, rows)
    columns = [("1", "tilt spring / R F_s"), ("1", "no balance below"), ("1", "repels below"),
               ("share", "h0 off: actual film"), ("share", "released ring, spring as needed")]  # fmt: skip
    static = [row for row in numbers["balance"] if row.get("static")]
    kept = [row for row in _rows(numbers, NEEDED) if row["status"] == "film"]
    off = [max((abs(row["static"]["mean_film"] / row["closed_form"]["mean_film"] - 1) for row in static), default=None),
           max((abs(row["ratio"]["mean_film"] - 1) for row in kept), default=None)]  # fmt: skip
    own = [numbers[name] for name in ("guide", "least_force_ratio", "least_attracting_force_ratio")]
    tables = [balances, released, Table("closed form", columns, [[*own, *off]])]
    columns = [("speed", "shaft.speed"), ("1", "moment / R F_s"), (film, "foreseen h0")]
    rows = zip(*(numbers["over_speed"][key] for key in ("speed", "moment_ratio", "mean_film")), strict=True)
    carried = [list(row) for row in rows if row[2] is not None]
    return tables + ([Table("over speed", columns, carried)] if carried else [])


def _first(value):
    """The mean of a mean, least and largest; a number itself."""
    return value[0] if isinstance(value, list | tuple) else value


def _rows(numbers, support) -> list[dict]:
    """Released rings on a support that were run, of several starts those of the first."""
    rows = [row for row in numbers["released"] if row["support"] == support and "failed" not in row]
    return [row for row in rows if row["start"] == rows[0]["start"]]


def _panels(numbers) -> list[Panel]:
    """Sealing numbers; beside them how far the closed form carries, and where a released ring hangs up, rides or
    straightens."""
    # What was asked, and always where the closed form has no balance and where it has one.
    ratios = [row["force_ratio"] for row in numbers["balance"]] + [1.2, 2.0 * numbers["least_force_ratio"]]
    over = Axis("1", "q = F_s/F_d, spring force over friction of half the secondary seal", scale="log",
                low=min(ratios) / 1.06, high=max(ratios) * 1.1)  # fmt: skip
    rows = [{**row, "status": row["status"] if row["status"] in FATES else "failed"} for row in numbers["released"]
            if "failed" not in row]  # fmt: skip
    numbers = {**numbers, "released": rows}
    return [_numbers_panel(numbers, rows, over), _carried_panel(numbers, over), _fates_panel(numbers, over)]


def _numbers_panel(numbers, rows, over) -> Panel:
    """Sealing number: what is claimed and what happens; where a ring hangs up there is no film to put a number to."""
    columns, series = ("force_ratio", "sealing_number"), []
    static = [{**row, **row["static"]} for row in numbers["balance"] if row.get("static")]
    settled = [{**row, **row["quasi_static"]} for row in numbers["balance"]
               if (row.get("quasi_static") or {}).get("status") == "settled"]  # fmt: skip
    for kind, given, label, style in (
        ("line", numbers["line"], "closed form", "black"),
        ("line", numbers["foreseen"], "foreseen", "good dashed"),
        ("marks", static, "balance", "warn plus large"),
        ("marks", settled, "balance in time", "blue open diamond large"),
        ("marks", numbers["published"], "published", "black open star large"),
    ):
        x, y = ([row[name] for row in given] if isinstance(given, list) else given[name] for name in columns)
        if x:
            series.append(Series(kind, x, y, label=label, style=style))
    flat = [row["sealing_number"][0] for row in rows if row["status"] != "hang-up"]
    flat += numbers["line"]["sealing_number"][-1:]
    low, top = 0.2 * min(flat), 10 * max(flat)
    for fate, style in FATES.items():
        label = fate
        for support, fill in ((OWN, ""), (NEEDED, " open")):
            mine = [row for row in rows if row["support"] == support and row["status"] == fate]
            if not mine:
                continue
            x, spread = [row["force_ratio"] for row in mine], [row["sealing_number"] for row in mine]
            hung = fate == "hang-up"
            y = [0.5 * top if hung else mean for mean, *_ in spread]
            error = None if hung else [max(mean - least, most - mean, 0.0) for mean, least, most in spread]
            series.append(Series("marks", x, y, label=label, style=f"{style}{fill}", error=error))
            label = ""
    least, attracting = numbers["least_force_ratio"], numbers["least_attracting_force_ratio"]
    zones = [Level(over.low, "no balance", True, "grey", to=least, legend=True),
             Level(least, "repels", True, "blue", to=attracting, legend=True)]  # fmt: skip
    axis = Axis("1", "sealing number  h0² F_s / (µ U ΔR³)", scale="log", low=low, high=top)
    return Panel("Mean film, as the sealing number (bars: its range)", over, axis, series, zones, note=HOLLOW, wide=1.4)


def _carried_panel(numbers, over) -> Panel:
    """Film of the released ring over that of the closed form."""
    title, series = "How far the closed form carries", []
    for name, words, style in (("mean_film", "mean film h0", "blue"), ("least_film", "least film", "warn"),
                               ("sealing_number", "sealing number", "good")):  # fmt: skip
        for support, dashes, label in ((OWN, "circle small", words), (NEEDED, "dotted open circle small", "")):
            mine = [row for row in _rows(numbers, support) if row["ratio"]]
            if mine:
                x, y = [row["force_ratio"] for row in mine], [row["ratio"][name] for row in mine]
                series.append(Series("line", x, y, label=label, style=f"{style} {dashes}"))
    if not series:
        return Panel(title, note="no released ring and closed form have a film at one ratio")
    return Panel(title, over, Axis("1", "released / closed form", scale="log"), series, [Level(1.0, style="black")])


def _fates_panel(numbers, over) -> Panel:
    """Fates over force ratio and what the support carries: foreseen, and run."""
    found, need, last = numbers["map"], numbers["map"]["closed_form"], over.high / 1.1
    series = [Series("line", found["hang_up_below"], found["guide"], style="fourth thick"),
              Series("line", found["straightens_above"], found["guide"], style="bad thick"),
              Series("line", need["force_ratio"], need["guide"], label="closed form", style="black")]  # fmt: skip
    for fate, style in FATES.items():
        mine = [row for support in (OWN, NEEDED) for row in _rows(numbers, support) if row["status"] == fate]
        if mine:
            x, y = [row["force_ratio"] for row in mine], [row["guide"] for row in mine]
            series.append(Series("marks", x, y, style=f"{style} front"))
    film = last**0.9
    ends = [np.interp(film, found[name], found["guide"]) for name in ("hang_up_below", "straightens_above")]
    places = {"hangs up": (1.3, 0.62), "straightens": (last**0.75, 0.12), "film": (film, min(0.5 * sum(ends), 1.0))}
    x, y = zip(*places.values(), strict=True)
    series.append(Series("words", x, y, names=list(places), style="grey"))
    moment = Axis("1", "tilt moment of support and inertia / R F_s", low=-0.02, high=1.08)
    return Panel("What a released ring does (marks: run)", over, moment, series, below=True)
