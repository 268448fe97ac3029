"""Rub: bifurcation diagram over the key, the exponent below it, sections and spectra at chosen points, and what two
correct runs make of the same start."""

import numpy as np

from ...archive import read_study
from ...status import Status
from .page import look, save, sheet, shortened
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

NAMES = {
    "rotor.runout": ("runout of the rotor, mrad", 1e3),
    "stator.misalignment": ("misalignment of the stator, mrad", 1e3),
    "rotor.misalignment": ("misalignment of the rotor, mrad", 1e3),
    "shaft.speed": ("shaft speed, rad/s", 1.0),
}
COLOURS = {"chaotic": VERMILLION, "quasi-periodic": PURPLE, "no contact": GREY, "settling": ORANGE, "undecided": ORANGE}
DIRECTION = {"up": (BLUE, ".", "growing"), "down": (ORANGE, ".", "falling")}
LEFT, WIDTH = 0.065, 0.475


def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    name, factor = NAMES.get(answer["key"], (f"{answer['key']}, SI", 1.0))
    with look():
        figure = sheet(13.0, 8.6)
        figure.text(
            0.03, 0.968, shortened(study["question"].split("?")[0] + "?", 110), fontsize=13, weight="bold", va="center"
        )
        words = next((v for v in answer["verdict"] if v.startswith(answer["key"])), study["name"])
        figure.text(0.03, 0.937, shortened(f"{study['name']}: {words}", 165), fontsize=9, va="center")
        diagram = figure.add_axes((LEFT, 0.575, WIDTH, 0.305))
        below = figure.add_axes((LEFT, 0.355, WIDTH, 0.17), sharex=diagram)
        rows = [row for row in answer["rows"] if row["status"] == Status.OK]
        _diagram(diagram, answer, rows, factor)
        _exponents(below, answer, rows, factor)
        below.set_xlabel(name)
        _bottom(figure, answer)
        unit = "mrad" if factor == 1e3 else "rad/s" if answer["key"] == "shaft.speed" else ""
        for k, row in enumerate(_chosen(rows, answer)):
            _point(figure, row, k, f"{factor * row['value']:.4g} {unit}".strip())
        return save(figure, out_path)


def _aside(answer, factor) -> dict:
    """How far the two directions are drawn beside their value, so that neither hides the other."""
    values = np.unique([factor * row["value"] for row in answer["rows"]])
    both = len({row["direction"] for row in answer["rows"]}) > 1 and len(values) > 1
    step = 0.1 * float(np.min(np.diff(values))) if both else 0.0
    return {"up": -step, "down": step}


def _diagram(ax, answer, rows, factor):
    """Smallest film of every turn kept, over the key."""
    aside = _aside(answer, factor)
    for direction, (colour, mark, label) in DIRECTION.items():
        mine = [row for row in rows if row["direction"] == direction]
        if mine:
            x = np.concatenate([np.full(len(r["h_min"]), factor * r["value"] + aside[direction]) for r in mine])
            y = 1e6 * np.concatenate([r["h_min"] for r in mine])
            ax.plot(x, y, mark, ms=3, mew=0, color=colour, label=label)
    ax.axhline(1e6 * answer["touch"], color=CONTACT, lw=0.9, ls="--")
    ax.annotate("asperities meet", (1.0, 1e6 * answer["touch"]), xycoords=("axes fraction", "data"), xytext=(-2, 3),
                textcoords="offset points", fontsize=8, color=CONTACT, ha="right")  # fmt: skip
    lost = [factor * row["value"] for row in answer["rows"] if row["status"] != Status.OK]
    if lost:
        low = ax.get_ylim()[0]
        ax.plot(lost, np.full(len(lost), low), "x", color=BLACK, ms=7, clip_on=False, label="crushed: no motion")
    ax.set(ylabel="smallest film, µm", title="Smallest film of each turn")
    if answer["rows"]:
        ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.1)
    ax.tick_params(labelbottom=False)


def _exponents(ax, answer, rows, factor):
    seen, aside = {}, _aside(answer, factor)
    for row in rows:
        colour = COLOURS.get(row["class"], GREEN)
        label = row["class"] if row["class"] in COLOURS else "period n"
        mark = "o" if row["direction"] == "up" else "s"
        x = factor * row["value"] + aside[row["direction"]]
        face = colour if mark == "o" else "white"
        ax.errorbar(x, row["exponent"], row["uncertainty"], fmt=mark, ms=4, lw=1.0, capsize=2, color=colour, mfc=face)
        seen[label] = colour
    ax.axhline(0.0, color=BLACK, lw=0.8)
    for label, colour in seen.items():
        ax.plot([], [], "o", ms=4, color=colour, label=label)
    ax.set(ylabel="exponent a period", title="Largest Lyapunov exponent")
    if seen:
        ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=5, borderaxespad=0.1, handletextpad=0.1)


def _bottom(figure, answer):
    """Separation of two correct runs, the two methods' averages, or the fate of whirl."""
    panels = [p for p, there in ((_separation, answer["separation"]), (_averages, answer["methods"]),
                                 (_whirl, answer["whirl"] and answer["whirl"]["rows"])) if there]  # fmt: skip
    for k, panel in enumerate(panels):
        width = WIDTH / len(panels) - (0.065 if len(panels) > 1 else 0.0) * (1 - 1 / len(panels))
        panel(figure.add_axes((LEFT + k * (width + 0.065), 0.075, width, 0.18)), answer)


def _separation(ax, answer):
    apart = np.maximum(answer["separation"]["apart"], 1e-12)
    ax.semilogy(np.arange(len(apart)), apart, color=BLUE)
    size = answer["separation"]["spread"]
    if size > 1e-3:
        ax.axhline(size, color=GREY, lw=0.9, ls="--")
        ax.annotate("size of the attractor", (0.98, size), xycoords=("axes fraction", "data"), xytext=(0, 5),
                    textcoords="offset points", fontsize=7.5, color=GREY, ha="right")  # fmt: skip
    lost = answer["separation"]["lost"]
    if lost is not None:
        ax.axvspan(lost, len(apart), color=VERMILLION, alpha=0.08, lw=0)
    top = 100 * max(size, apart.max())
    ax.set(xlim=(0, len(apart)), ylim=(None, top), xlabel="periods", ylabel="apart, tilt scales")
    ax.set_title("Two correct runs part" if lost is not None else "Two correct runs")


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
    ax.set(xlim=(-2, 2), xlabel="DOP853 − Adams, in uncertainties")
    ax.set_title("Averages agree" if answer["judge"]["agree"] else "Averages")


def _whirl(ax, answer):
    for row, colour in zip(answer["whirl"]["rows"], (BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILLION) * 3, strict=False):
        if "amplitudes" in row:
            size = 1e3 * np.array(row["amplitudes"])
            ax.semilogy(np.arange(len(size)), size, color=colour, label=f"{row['speed']:.5g} rad/s: {row['fate']}")
    # Room for the names below the curves.
    ax.set(xlabel="turns", ylabel="relative tilt, mrad", title="A small whirl", ylim=(ax.get_ylim()[0] / 30, None))
    ax.legend(loc="lower right", fontsize=6.5)


def _chosen(rows, answer) -> list[dict]:
    """Up to three points: the first that rubs, the last of another class before the judged one, and that one."""
    rubs = [row for row in rows if row["contact_share"] > 0 and row["direction"] == "up"] or rows
    if len(rubs) <= 3:
        return rubs
    wanted = answer["judge"]["value"] if answer["judge"] else rubs[-1]["value"]
    last = min(range(len(rubs)), key=lambda k: abs(rubs[k]["value"] - wanted))
    other = [k for k in range(last) if rubs[k]["class"] != rubs[last]["class"]]
    middle = other[-1] if other else len(rubs) // 2
    picks = sorted({0, middle, last})
    return [rubs[k] for k in ([*picks, len(rubs) - 1] if len(picks) < 3 and len(rubs) - 1 not in picks else picks)]


def _point(figure, row, k, words):
    """Section and spectrum of one point."""
    bottom = 0.665 - 0.295 * k
    left = figure.add_axes((0.61, bottom, 0.145, 0.215))
    right = figure.add_axes((0.825, bottom, 0.155, 0.215))
    colour = COLOURS.get(row["class"], GREEN)
    x, y = 1e3 * np.array(row["section"]).T
    left.plot(x, y, ".", ms=4, color=colour)
    for values, limit in ((x, left.set_xlim), (y, left.set_ylim)):
        middle, half = 0.5 * (values.min() + values.max()), 0.62 * max(np.ptp(values), 0.05)
        limit(middle - half, middle + half)
    left.set(xlabel="γ about x, mrad", ylabel="γ about y, mrad", title=f"{words}: {row['class']}")
    left.locator_params(nbins=4)
    orders, size = np.array(row["orders"]), 1e3 * np.array(row["amplitude"])
    right.semilogy(orders[1:], np.maximum(size[1:], 1e-9), color=colour, lw=0.8)
    top = size.max()
    right.set(xlim=(0, orders[-1]), ylim=(1e-5 * top, 3 * top), xlabel="order of the shaft speed", ylabel="tilt, mrad")
    right.set_title("Spectrum of the ring")
    right.set_xticks(np.arange(0, int(orders[-1]) + 1))
