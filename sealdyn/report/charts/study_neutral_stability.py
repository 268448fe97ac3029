"""Numerical damping over cost: what each method adds to a neutral whirl and to a free precession."""

import math

import numpy as np

from ...archive import read_study
from .page import absent, level, look, save, study_page
from .palette import BLACK, LOOKS, SHORT

# Below this a change per turn is rounding.
ROUNDING = 1e-17


@look()
def draw(path, out):
    """Left: growth per turn at the threshold.  Right: energy drift per turn of free precession."""
    study = read_study(path)
    answer = study["answer"]
    title = f"What do the methods themselves add to {study['name'].replace('_', ' ')} where nothing damps?"
    words = next((line for line in answer["verdict"] if line.startswith("the default")), answer["verdict"][0])
    figure, ax = study_page(study, 12, 6.4, [["threshold", "precession"]], title, words)
    if answer["damping"] and answer["drift"]:
        ax["precession"].sharex(ax["threshold"])
    threshold(ax["threshold"], answer)
    precession(ax["precession"], answer)
    return save(figure, out)


def threshold(ax, answer):
    """Growth per turn of the neutral whirl."""
    title = "Growth of a neutral whirl, at the stability threshold"
    if not answer["damping"]:
        return absent(ax, title, answer["reason"])
    _lines(ax, answer["damping"], "growth")
    found = answer["resolved"]
    if found and "rate" in found:
        turn = 2 * math.pi / answer["critical_speed"]
        for share, words in ((1.0, "resolved by study critical-speed"), (0.01, "a hundredth of it")):
            level(ax, share * found["rate"] * turn, words)
    ax.set(title=title, xlabel="right-hand sides per turn", ylabel="|growth per turn|")
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1.07), ncols=7, fontsize=7.5, columnspacing=1.0, handlelength=1.6)


def precession(ax, answer):
    """Energy drift per turn of the free ring."""
    title = "Energy drift of free precession"
    if not answer["drift"]:
        return absent(ax, title, answer["drift_reason"])
    short = [row for row in answer["drift"] if row["turns"] == answer["turns"]]
    _lines(ax, short, "energy")
    for row in answer["drift"]:
        if row["turns"] != answer["turns"] and row.get("energy") is not None:
            colour, _, mark = LOOKS[row["method"]]
            size = max(abs(row["energy"]), ROUNDING)
            ax.plot(row["cost"], size, mark, ms=11, color=colour, mec=BLACK, mew=0.7, zorder=6)
            ax.annotate(f"{SHORT[row['method']]}, {row['turns']} turns", (row["cost"], size), xytext=(-9, -3),
                        textcoords="offset points", ha="right", fontsize=7.5)  # fmt: skip
    ax.set(title=title, xlabel="right-hand sides per turn", ylabel="|energy drift per turn|, relative")
    ax.text(0.5, 1.09, "filled: damps      open: pumps      × on top: no answer", transform=ax.transAxes, ha="center",
            fontsize=8.5)  # fmt: skip
    if not answer["damping"]:
        ax.legend(loc="lower left", fontsize=7.5)


def _lines(ax, rows, key):
    """One line per method over its accuracies; filled where it damps, open where it pumps; a cross where it failed."""
    for method, (colour, line, marker) in LOOKS.items():
        own = [row for row in rows if row["method"] == method]
        good = [row for row in own if row.get(key) is not None]
        if good:
            cost, value = np.array([[row["cost"], row[key]] for row in good]).T
            size = np.maximum(np.abs(value), ROUNDING)
            ax.loglog(cost, size, line, color=colour, lw=1.1, alpha=0.7)
            for grows, face in ((False, colour), (True, "white")):
                part = (value > 0) == grows
                ax.plot(cost[part], size[part], marker, ms=6, mfc=face, mec=colour, mew=1.3)
            ax.plot([], [], line, marker=marker, color=colour, ms=6, lw=1.1, label=SHORT[method])
        for k in range(len(own) - len(good)):
            ax.plot(0.97 - 0.02 * k, 0.99, "x", color=colour, ms=7, mew=2, transform=ax.transAxes, clip_on=False)
