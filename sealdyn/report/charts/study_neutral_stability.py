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
    named = ax["threshold"] if answer["damping"] else ax["precession"]
    handles = named.get_legend_handles_labels()
    if handles[0]:
        names = ax["threshold"].legend(*handles, loc="lower left", bbox_to_anchor=(0, 1.07), ncols=7, fontsize=7.5,
                                       columnspacing=1.0, handlelength=1.6)  # fmt: skip
        # It may be wider than its panel, which keeps its width.
        names.set_in_layout(False)
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
            at = share * found["rate"] * turn
            level(ax, at, words, **_beside(ax, at))
    ax.set(title=title, xlabel="right-hand sides per turn", ylabel="|growth per turn|")


def _beside(ax, at: float) -> dict:
    """Where the name of a level hides least of the lines: `side` and `below` of `level`."""
    drawn = [np.array(line.get_data(), float).T for line in ax.lines if line.get_transform() == ax.transData]
    ways = [np.log10(points) for points in drawn if len(points)]
    part = np.linspace(0.0, 1.0, 50)[:, None, None]
    x, y = np.concatenate([(way[:-1] + part * np.diff(way, axis=0)).reshape(-1, 2) for way in ways]).T
    width, height = 0.35 * np.ptp(x), 0.06 * np.ptp(y)
    hidden = {}
    for below in (False, True):
        above = (np.log10(at) - y if below else y - np.log10(at)) / height
        for side, far in (("right", x.max() - x), ("left", x - x.min())):
            hidden[side, below] = np.count_nonzero((far < width) & (above > -0.2) & (above < 1.0))
    side, below = min(hidden, key=hidden.get)
    return {"side": side, "below": below}


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


def _lines(ax, rows, key):
    """One line per method over its accuracies; filled where it damps, open where it pumps; a cross where it failed."""
    crosses = 0
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
        elif own:
            ax.plot([], [], "x", color=colour, ms=7, mew=2, label=f"{SHORT[method]}: no answer")
        for _ in range(len(own) - len(good)):
            at = 0.97 - 0.02 * crosses, 0.99
            ax.plot(*at, "x", color=colour, ms=7, mew=2, transform=ax.transAxes, clip_on=False)
            crosses += 1
