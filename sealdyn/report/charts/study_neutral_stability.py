"""Numerical damping over cost: what each method adds to a neutral whirl and to a free precession."""

import math
import textwrap

import numpy as np

from ...archive import read_study
from .page import absent, look, save, sheet, shortened
from .palette import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

STYLE = {
    "adams": (BLUE, "o", "CVODE Adams"),
    "bdf": (VERMILLION, "s", "CVODE BDF"),
    "ida": (PURPLE, "D", "IDA"),
    "dop853": (GREEN, "^", "DOP853"),
    "rk45": (SKY, "v", "RK45"),
    "radau": (ORANGE, "P", "Radau"),
    "expm": (BLACK, "X", "matrix exponential"),
}
# Below this a change per turn is rounding.
ROUNDING = 1e-17


def draw(path, out):
    """Left: growth per turn at the threshold.  Right: energy drift per turn of free precession."""
    info = read_study(path)
    answer = info["answer"]
    with look():
        figure = sheet(12, 6.4)
        title = f"What do the methods themselves add to {info['name'].replace('_', ' ')} where nothing damps?"
        figure.text(0.035, 0.955, shortened(title, 110), fontsize=13, weight="bold", va="center")
        words = next((line for line in answer["verdict"] if line.startswith("the default")), answer["verdict"][0])
        for k, line in enumerate(textwrap.wrap(words, 165)[:2]):
            figure.text(0.035, 0.908 - 0.033 * k, line, fontsize=9, va="center")
        left = figure.add_axes((0.07, 0.1, 0.4, 0.64))
        right = figure.add_axes((0.56, 0.1, 0.4, 0.64), sharex=left if answer["damping"] and answer["drift"] else None)
        threshold(left, answer)
        precession(right, answer)
        return save(figure, out)


def threshold(ax, answer):
    """Growth per turn of the neutral whirl."""
    title = "Growth of a neutral whirl, at the stability threshold"
    if not answer["damping"]:
        absent(ax, title, textwrap.fill(answer["reason"], 62))
        return
    _lines(ax, answer["damping"], "growth")
    found = answer["resolved"]
    if found and "rate" in found:
        turn = 2 * math.pi / answer["critical_speed"]
        for share, words in ((1.0, "resolved by study critical-speed"), (0.01, "a hundredth of it")):
            level = share * found["rate"] * turn
            ax.axhline(level, color=GREY, lw=1.0, ls="--")
            ax.annotate(words, (0.99, level), xycoords=("axes fraction", "data"), xytext=(0, 2),
                        textcoords="offset points", ha="right", fontsize=7.5, color=GREY)  # fmt: skip
    ax.set(xlabel="right-hand sides per turn", ylabel="|growth per turn|")
    ax.set_title(title)
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1.07), ncol=4, fontsize=7.5, columnspacing=1.0, handlelength=1.6)


def precession(ax, answer):
    """Energy drift per turn of the free ring."""
    title = "Energy drift of free precession"
    if not answer["drift"]:
        absent(ax, title, textwrap.fill(answer["drift_reason"], 62))
        return
    short = [row for row in answer["drift"] if row["turns"] == answer["turns"]]
    _lines(ax, short, "energy")
    for row in answer["drift"]:
        if row["turns"] != answer["turns"] and row.get("energy") is not None:
            colour, _, name = STYLE[row["method"]]
            size = max(abs(row["energy"]), ROUNDING)
            ax.plot(row["cost"], size, "*", ms=15, color=colour, mec=BLACK, mew=0.7, zorder=6)
            ax.annotate(f"{name}, {row['turns']} turns", (row["cost"], size), xytext=(-9, -3),
                        textcoords="offset points", ha="right", fontsize=7.5)  # fmt: skip
    ax.set(xlabel="right-hand sides per turn", ylabel="|energy drift per turn|, relative")
    ax.set_title(title)
    ax.text(0.5, 1.09, "filled: damps      open: pumps      × on top: no answer", transform=ax.transAxes, ha="center",
            fontsize=8.5)  # fmt: skip
    if not answer["damping"]:
        ax.legend(loc="lower left", fontsize=7.5)


def _lines(ax, rows, key):
    """One line per method over its accuracies; filled where it damps, open where it pumps; a cross where it failed."""
    for method, (colour, marker, name) in STYLE.items():
        own = [row for row in rows if row["method"] == method]
        good = [row for row in own if row.get(key) is not None]
        if good:
            cost = np.array([row["cost"] for row in good])
            value = np.array([row[key] for row in good])
            size = np.maximum(np.abs(value), ROUNDING)
            ax.loglog(cost, size, "-", color=colour, lw=1.1, alpha=0.7)
            for grows, face in ((False, colour), (True, "white")):
                part = (value > 0) == grows
                ax.plot(cost[part], size[part], marker, ms=6, mfc=face, mec=colour, mew=1.3)
            ax.plot([], [], marker + "-", color=colour, ms=6, lw=1.1, label=name)
        for k in range(len(own) - len(good)):
            ax.plot(0.97 - 0.02 * k, 0.99, "x", color=colour, ms=7, mew=2, transform=ax.transAxes, clip_on=False)
