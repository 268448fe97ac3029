"""Rub: bifurcation diagram over the key, the exponent below it, sections and spectra at chosen points, and what two
correct runs make of the same start."""

import numpy as np

from ...archive import read_study
from ...status import Status
from ..text import speed_unit
from .page import legend, level, look, save, stacked, study_page, written
from .palette import BLACK, BLUE, CONTACT, CYCLE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION
from .poincare import frame
from .record import fitting, read_in

# Names of keys on the axis, and their SI units.
NAMES = {"rotor.runout": "runout of the rotor", "stator.misalignment": "misalignment of the stator",
         "rotor.misalignment": "misalignment of the rotor", "shaft.speed": "shaft speed"}  # fmt: skip
UNITS = {**dict.fromkeys(NAMES, "rad"), "shaft.speed": "rad/s"}
COLOURS = {"chaotic": VERMILLION, "quasi-periodic": PURPLE, "no contact": GREY, "settling": SKY, "undecided": ORANGE}
DIRECTION = {"up": (BLUE, "growing"), "down": (ORANGE, "falling")}
# Tilts (rad) from here on are read in mrad.
MILLI = 5e-5
# Values of the key up to which the diagram has large points.
FEW = 30
# Points of the diagram shown one by one.
MOST = 3


@look()
def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    name, unit, factor = _named(study, answer)
    rows = [row for row in answer["rows"] if row["status"] == Status.OK]
    points = _chosen(rows, answer)
    whirl = (answer["whirl"] or {}).get("rows")
    below = {_separation: answer["separation"], _averages: answer["methods"], _whirl: whirl}
    below = {draws.__name__: draws for draws, there in below.items() if there}
    left = 5 * [6 * ["diagram"]] + 3 * [6 * ["exponents"]]
    left += 3 * [[panel for panel in below for _ in range(6 // len(below))]] if below else []
    # One point has its section above its spectrum, several have them side by side.
    right = [[f"section {k}", f"spectrum {k}"] for k in range(len(points))]
    right = [[name] for name in right[0]] if len(right) == 1 else right
    words = answer["verdict"][0]
    words = f"{study['name']}: {words}"
    sides = {"mosaic": [[left, right]], "width_ratios": (5, 4)} if right else {"mosaic": left}
    figure, ax = study_page(study, 13.0 if right else 8.0, 8.6, below=words, **sides)
    stacked(ax["diagram"], ax["exponents"])
    _diagram(ax["diagram"], answer, rows, factor)
    _exponents(ax["exponents"], answer, rows, factor)
    ax["exponents"].set_xlabel(f"{name}, {unit}" if unit else name)
    for panel, draws in below.items():
        draws(ax[panel], answer, *([speed_unit(study)] if draws is _whirl else []))
    for k, row in enumerate(points):
        value = " ".join(filter(None, (written(factor * row["value"], 4), unit)))
        _section(ax[f"section {k}"], row, f"{value}: {row['class']}")
        _spectrum(ax[f"spectrum {k}"], row)
    return save(figure, out_path)


def _named(study, answer) -> tuple[str, str, float]:
    """Name of the key on the axis, the unit its values are read in, and how many of it make one SI unit."""
    key = answer["key"]
    # Archives of earlier versions do not hold its unit.
    unit = (answer.get("units") or {}).get("rows/value", UNITS.get(key, ""))
    # What has no unit of its own is a pure number.
    unit = "" if unit == "SI" else unit
    return NAMES.get(key, key), *read_in(unit, [row["value"] for row in answer["rows"]], speed_unit(study))


def _aside(answer, factor) -> dict:
    """How far the two directions are drawn beside their value, so that neither hides the other."""
    values = np.unique([factor * row["value"] for row in answer["rows"]])
    both = len({row["direction"] for row in answer["rows"]}) > 1 and len(values) > 1
    step = 0.1 * float(np.min(np.diff(values))) if both else 0.0
    return {"up": -step, "down": step}


def _diagram(ax, answer, rows, factor):
    """Smallest film of every turn kept, over the key."""
    aside = _aside(answer, factor)
    sides = {"up": " (left of its value)", "down": " (right)"} if aside["down"] else {"up": "", "down": ""}
    for direction, (colour, label) in DIRECTION.items():
        mine = [row for row in rows if row["direction"] == direction]
        if mine:
            x = np.concatenate([np.full(len(r["h_min"]), factor * r["value"] + aside[direction]) for r in mine])
            y = 1e6 * np.concatenate([r["h_min"] for r in mine])
            ax.plot(x, y, ".", ms=3 if len(mine) > FEW else 6, mew=0, color=colour,
                    label=label + sides[direction])  # fmt: skip
    level(ax, 1e6 * answer["touch"], "asperities meet", CONTACT)
    lost = [factor * row["value"] for row in answer["rows"] if row["status"] != Status.OK]
    if lost:
        low = ax.get_ylim()[0]
        ax.plot(lost, np.full(len(lost), low), "x", color=BLACK, ms=7, clip_on=False, label="crushed: no motion")
    ax.set(ylabel="smallest film, µm", title="Smallest film of each turn")
    legend(ax, "above", ncols=3)


def _exponents(ax, answer, rows, factor):
    aside = _aside(answer, factor)
    for row in rows:
        colour = COLOURS.get(row["class"], GREEN)
        mark, face = ("o", colour) if row["direction"] == "up" else ("s", "white")
        x = factor * row["value"] + aside[row["direction"]]
        ax.errorbar(x, row["exponent"], row["uncertainty"], fmt=mark, ms=4, lw=1.0, capsize=2, color=colour, mfc=face)
    ax.axhline(0.0, color=BLACK, lw=0.8)
    seen = {row["class"] if row["class"] in COLOURS else "period n": row["class"] for row in rows}
    for label in seen:
        ax.plot([], [], "o", ms=4, color=COLOURS.get(label, GREEN), label=label)
    ax.set(ylabel="exponent a period", title="Largest Lyapunov exponent")
    legend(ax, "above", ncols=5, handletextpad=0.1)


def _separation(ax, answer):
    apart = np.maximum(answer["separation"]["apart"], 1e-12)
    ax.semilogy(np.arange(len(apart)), apart, color=BLUE)
    size = answer["separation"]["spread"]
    if size > 1e-3:
        ax.axhline(size, color=GREY, lw=0.9, ls="--")
        # Curves rise to the line and stay there: its name lies above them.
        ax.text(0.98, 0.97, "dashed: size of the attractor", transform=ax.transAxes, color=GREY, fontsize=8, ha="right",
                va="top")  # fmt: skip
    lost = answer["separation"]["lost"]
    if lost is not None:
        ax.axvspan(lost, len(apart), color=VERMILLION, alpha=0.08, lw=0)
    ax.set(xlim=(0, len(apart)), ylim=(None, 100 * max(size, apart.max())), xlabel="periods",
           ylabel="apart, tilt scales", title="Two correct runs" + (" part" if lost is not None else ""))  # fmt: skip


def _averages(ax, answer):
    """Difference of the two methods over the uncertainty of it."""
    entries = list(answer["methods"]["invariants"].items())
    at = np.arange(len(entries))[::-1]
    for y, (_, entry) in zip(at, entries, strict=True):
        a, b = entry["values"]
        size = entry["allowed"] if entry["allowed"] > 0 else np.inf
        colour = GREEN if entry["agree"] else VERMILLION
        ax.plot(np.clip((b - a) / size, -1.9, 1.9), y, "o", ms=3.5, color=colour)
    ax.axvspan(-1, 1, color=GREEN, alpha=0.1, lw=0)
    ax.axvline(0, color=BLACK, lw=0.6)
    ax.set_yticks(at, [name.replace("_", " ") for name, _ in entries], fontsize=6)
    ax.tick_params(axis="y", length=0)
    ax.set(xlim=(-2, 2), xlabel="DOP853 − Adams, in uncertainties",
           title="Averages agree" if answer["judge"]["agree"] else "Averages")  # fmt: skip


def _whirl(ax, answer, speeds):
    unit, per = speeds
    for k, row in enumerate(row for row in answer["whirl"]["rows"] if "amplitudes" in row):
        words = f"{written(per * row['speed'], 5)} {unit}: {row['fate']}"
        ax.semilogy(1e3 * np.array(row["amplitudes"]), color=CYCLE[k % len(CYCLE)], label=words)
    # Room for the names below the curves.
    ax.set(xlabel="turns", ylabel="relative tilt, mrad", title="A small whirl", ylim=(ax.get_ylim()[0] / 30, None))
    legend(ax, "lower right", fontsize=6.5)


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


def _tilts(values) -> tuple[np.ndarray, str]:
    """Tilts (rad) in a unit of their size, and its name."""
    values = np.array(values)
    size = float(np.abs(values).max(initial=0.0))
    unit, finer = ("mrad", 1e-3) if size >= MILLI else fitting("µrad", 1e6 * size)
    return 1e6 * finer * values, unit


def _section(ax, row, title):
    """Tilt of one point, once per turn."""
    tilts, unit = _tilts(row["section"])
    x, y = tilts.T
    ax.plot(x, y, ".", ms=4, color=COLOURS.get(row["class"], GREEN))
    frame(ax, x, y, least=min(0.05, 0.5 * np.abs(tilts).max()) if unit == "mrad" else 0.5 * np.abs(tilts).max())
    ax.set(xlabel=f"γ about x, {unit}", ylabel=f"γ about y, {unit}", title=title)
    ax.locator_params(nbins=4)


def _spectrum(ax, row):
    orders, (size, unit) = np.array(row["orders"]), _tilts(row["amplitude"])
    top = size.max()
    shown = np.maximum(size[1:], 1e-9 * top)
    ax.semilogy(orders[1:], shown, color=COLOURS.get(row["class"], GREEN), lw=0.8)
    ax.set(xlim=(0, orders[-1]), ylim=(1e-5 * top, 3 * top), xticks=np.arange(0, int(orders[-1]) + 1),
           xlabel="order of the shaft speed", ylabel=f"tilt, {unit}", title="Spectrum of the ring")  # fmt: skip
