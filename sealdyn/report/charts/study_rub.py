"""Rub: bifurcation diagram over the key, the exponent below it, sections and spectra at chosen points, and what two
correct runs make of the same start."""

import numpy as np

from ...answers import Axis, Level, Panel, Series
from ...archive import read_study
from ...quantities import in_words
from ...status import Status
from ..panels import study_sheet
from .page import CYCLED, save
from .poincare import around

# Names of keys on the axis.
NAMES = {"rotor.runout": "runout of the rotor", "stator.misalignment": "misalignment of the stator",
         "rotor.misalignment": "misalignment of the rotor", "shaft.speed": "shaft speed"}  # fmt: skip
CLASSES = {"chaotic": "second", "quasi-periodic": "fourth", "no contact": "grey", "settling": "sixth",
           "undecided": "fifth"}  # fmt: skip
DIRECTION = {"up": ("first", "growing"), "down": ("fifth", "falling")}
# Values of the key up to which the diagram has large points.
FEW = 30
# Points of the diagram shown one by one.
MOST = 3


def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    rows = [row for row in answer["rows"] if row["status"] == Status.OK]
    along = _key(answer)
    panels = [_diagram(along, answer, rows), _exponents(along, answer, rows)]
    for k, row in enumerate(_chosen(rows, answer)):
        value = in_words(along.quantity, row["value"])
        panels += [_section(row, f"{value}: {row['class']}", first=k == 0), _spectrum(row)]
    panels += [_separation(answer)] if answer["separation"] else []
    panels += [_averages(answer)] if answer["methods"] else []
    panels += [_whirl(answer)] if (answer["whirl"] or {}).get("rows") else []
    figure = study_sheet(study, panels, below=f"{study['name']}: {answer['verdict'][0]}")
    return save(figure, out_path)


def _key(answer) -> Axis:
    """The key along an axis."""
    key, unit = answer["key"], answer["units"]["rows/value"]
    return Axis("1" if unit == "SI" else unit, NAMES.get(key, key))


def _style(row) -> str:
    return CLASSES.get(row["class"], "good")


def _aside(answer) -> dict:
    """How far the two directions are drawn beside their value, so that neither hides the other."""
    values = np.unique([row["value"] for row in answer["rows"]])
    both = len({row["direction"] for row in answer["rows"]}) > 1 and len(values) > 1
    step = 0.1 * float(np.min(np.diff(values))) if both else 0.0
    return {"up": -step, "down": step}


def _diagram(along, answer, rows) -> Panel:
    """Smallest film of every turn kept, over the key."""
    aside, series = _aside(answer), []
    sides = {"up": " (left of its value)", "down": " (right)"} if aside["down"] else {"up": "", "down": ""}
    for direction, (colour, label) in DIRECTION.items():
        mine = [row for row in rows if row["direction"] == direction]
        if mine:
            x = np.concatenate([np.full(len(r["h_min"]), r["value"] + aside[direction]) for r in mine])
            style = f"{colour} point{' small' if len(mine) > FEW else ''}"
            films = np.concatenate([r["h_min"] for r in mine])
            series.append(Series("marks", x, films, label=label + sides[direction], style=style))
    lost = [row["value"] for row in answer["rows"] if row["status"] != Status.OK]
    if lost:
        series.append(Series("marks", lost, [0.0] * len(lost), label="crushed: no motion", style="black cross front"))
    level = Level(answer["touch"], "asperities meet", style="contact dashed", number=True)
    return Panel("Smallest film of each turn", along, Axis("h_min", "smallest film"), series, [level])


def _exponents(along, answer, rows) -> Panel:
    aside, series = _aside(answer), []
    for row in rows:
        mark = "circle" if row["direction"] == "up" else "square open"
        label = row["class"] if row["class"] in CLASSES else "period n"
        series.append(Series("marks", [row["value"] + aside[row["direction"]]], [row["exponent"]], label=label,
                             style=f"{_style(row)} {mark} small", error=[row["uncertainty"]]))  # fmt: skip
    zero = Level(0.0, style="black")
    return Panel(
        "Largest Lyapunov exponent", along, Axis("1", "exponent a period"), series, [zero], below=True, tall=0.7
    )


def _separation(answer) -> Panel:
    apart, size = np.maximum(answer["separation"]["apart"], 1e-12), answer["separation"]["spread"]
    levels = [Level(size, "size of the attractor", legend=True)] if size > 1e-3 else []
    lost = answer["separation"]["lost"]
    if lost is not None:
        levels.append(Level(lost, upright=True, to=len(apart), style="contact"))
    title = "Two correct runs" + (" part" if lost is not None else "")
    y = Axis("1", "apart, tilt scales", scale="log", high=100 * max(size, apart.max()))
    line = Series("line", np.arange(len(apart)), apart, style="first thin")
    return Panel(title, Axis("1", "periods", low=0, high=len(apart)), y, [line], levels, first=True)


def _averages(answer) -> Panel:
    """Difference of the two methods over the uncertainty of it."""
    marks, names = {"good": [], "bad": []}, list(answer["methods"]["invariants"])
    for k, entry in enumerate(answer["methods"]["invariants"].values()):
        a, b = entry["values"]
        size = entry["allowed"] if entry["allowed"] > 0 else np.inf
        marks["good" if entry["agree"] else "bad"].append((float(np.clip((b - a) / size, -1.9, 1.9)), k))
    series = [Series("marks", *zip(*held, strict=True), style=f"{c} circle small") for c, held in marks.items() if held]
    levels = [Level(-1, upright=True, to=1, style="good"), Level(0, upright=True, style="black")]
    words = Axis("1", " ", words=[name.replace("_", " ") for name in names])
    along = Axis("1", "DOP853 − Adams, in uncertainties", low=-2, high=2)
    title = "Averages agree" if answer["judge"]["agree"] else "Averages"
    return Panel(title, along, words, series, levels, down=True, first=not answer["separation"])


def _whirl(answer) -> Panel:
    series = []
    for k, row in enumerate(row for row in answer["whirl"]["rows"] if "amplitudes" in row):
        words, colour = f"{in_words('speed', row['speed'], 5)}: {row['fate']}", CYCLED[k % len(CYCLED)]
        turns = np.arange(len(row["amplitudes"]))
        series.append(Series("line", turns, row["amplitudes"], label=words, style=f"{colour} thin"))
    axis = Axis("misalignment", "relative tilt", scale="log")
    return Panel(
        "A small whirl", Axis("1", "turns"), axis, series, first=not (answer["separation"] or answer["methods"])
    )


def _chosen(rows, answer) -> list[dict]:
    """Up to three points: the first that rubs, the last of another class before the judged one, and that one."""
    rubs = [row for row in rows if row["contact_share"] > 0 and row["direction"] == "up"] or rows
    if len(rubs) <= MOST:
        return rubs
    wanted = answer["judge"]["value"] if answer["judge"] else rubs[-1]["value"]
    last = min(range(len(rubs)), key=lambda k: abs(rubs[k]["value"] - wanted))
    other = [k for k in range(last) if rubs[k]["class"] != rubs[last]["class"]]
    middle = other[-1] if other else len(rubs) // 2
    picks = sorted({0, middle, last})
    return [rubs[k] for k in ([*picks, len(rubs) - 1] if len(picks) < 3 and len(rubs) - 1 not in picks else picks)]


def _section(row, title, first: bool) -> Panel:
    """Tilt of one point, once per turn."""
    x, y = np.array(row["section"]).T
    (low, high), (bottom, top) = around(x, y, least=0.5 * max(np.abs(x).max(), np.abs(y).max()))
    across = Axis("misalignment", "γ about x", low=low, high=high)
    up = Axis("misalignment", "γ about y", low=bottom, high=top)
    return Panel(title, across, up, [Series("marks", x, y, style=f"{_style(row)} point")], equal=True,
                 first=first, tall=0.8)  # fmt: skip


def _spectrum(row) -> Panel:
    orders, size = np.array(row["orders"][1:]), np.array(row["amplitude"])
    top = size.max()
    line = Series("line", orders, np.maximum(size[1:], 1e-9 * top), style=f"{_style(row)} thin")
    along = Axis("1", "order of the shaft speed", low=0, high=orders[-1])
    axis = Axis("misalignment", "tilt", scale="log", low=1e-5 * top, high=3 * top)
    return Panel("Spectrum of the ring", along, axis, [line], below=True, tall=0.7)
