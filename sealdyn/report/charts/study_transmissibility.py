"""Bode plot of the FMR and the FMS seal over speed, three independent methods on one chart: transmissibilities above,
phases below them, and the table at the foot."""

from textwrap import wrap

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator

from ...archive import read_study
from ..text import speed_unit
from .page import logarithmic, look, number, save, stacked, study_page
from .palette import BLACK, GREY, PALE, RING
from .record import done

COLOUR, MARK = {"fmr": RING["rotor"], "fms": RING["stator"]}, {"fmr": "o", "fms": "s"}
TITLES = {
    "static": "Static: fixed in space",
    "dynamic": "Dynamic: turns with the shaft",
    "total": "Total: both forcings 1",
}
RPM = 60 / (2 * np.pi)
WORDS = {
    "static_transmissibility": "static transmissibility",
    "dynamic_transmissibility": "dynamic transmissibility",
    "maximum_relative_misalignment": "maximum relative misalignment",
    "critical_misalignment": "critical misalignment, C/r_o",
    "critical_speed": "critical speed, rad/s",
}


@look()
def draw(archive_path, out_path):
    """Amplitudes and phases over speed and a table, from a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "How much misalignment reaches the film?"
    # As the scenario has it, or as it was asked.
    if speed_unit(study)[0] == "rpm":
        answer = {**answer, "unit": "rpm"}
    mosaic = [list(TITLES), ["static phase", "dynamic phase", "legend"]] + ([3 * ["table"]] if answer["table"] else [])
    heights = (9, 6, 6)[: len(mosaic)]
    figure, ax = study_page(study, 11.5, 9.6 if answer["table"] else 7.2, mosaic, title, height_ratios=heights)
    for quantity in ("static", "dynamic"):
        stacked(ax[quantity], ax[f"{quantity} phase"])
        _phases(ax[f"{quantity} phase"], answer, f"{quantity}_phase")
    for quantity in TITLES:
        _amplitudes(ax[quantity], answer, quantity)
    for name in ("static phase", "dynamic phase", "total"):
        ax[name].set_xlabel(f"shaft speed, {answer['unit']}")
    ax["static"].set_ylabel("relative misalignment per unit forcing")
    ax["static phase"].set_ylabel("phase behind the forcing, deg")
    _legend(ax["legend"], answer)
    if answer["table"]:
        _table(ax["table"], answer["table"])
    return save(figure, out_path)


def _roads(ax, answer, quantity: str):
    """One column of both arrangements by three independent methods over speed."""
    factor = RPM if answer["unit"] == "rpm" else 1.0
    speed = factor * np.array(answer["speed"])
    for seal, colour in COLOUR.items():
        stable = np.array(answer[seal]["stable"])
        line, dashes = np.array(answer[seal][quantity]), np.array(answer[seal]["linear_algebra"][quantity])
        ax.plot(speed, np.where(stable, line, np.nan), color=colour, lw=2.2, alpha=0.75)
        ax.plot(speed, np.where(stable, np.nan, line), color=colour, lw=1.0, alpha=0.5, ls=":")
        ax.plot(speed, np.where(stable, dashes, np.nan), color=BLACK, lw=0.8, ls=(0, (4, 5)))
        for row in (row for row in done(answer["time_domain"]) if row["seal"] == seal):
            ax.errorbar(factor * row["speed"], row[quantity], row["error"][quantity], fmt=MARK[seal], ms=4.5, lw=1.0,
                        mfc="white", mec=colour, ecolor=colour, capsize=3, clip_on=False)  # fmt: skip
    ax.set(xlim=(speed[0], speed[-1]))
    ax.locator_params(axis="x", nbins=5)
    return np.concatenate([answer[s][quantity] for s in COLOUR])


def _amplitudes(ax, answer, quantity: str):
    """One transmissibility."""
    both = _roads(ax, answer, quantity)
    lowest, highest = max(both.min(), 1e-9), np.percentile(both, 99)
    # Above the curves: a line of words for every crossing.
    room = 0.12 + 0.1 * max(1, sum(c["quantity"] == quantity for c in answer["crossings"]))
    if highest > 8 * lowest:
        # Far apart: the crossing is seen on a logarithmic axis only.
        logarithmic(ax, "y")
        ax.set_ylim(0.7 * lowest, highest * (highest / lowest) ** room)
        if highest > 300 * lowest:
            ax.yaxis.set_major_locator(LogLocator())
    else:
        ax.set_ylim(0, (1 + room) * highest)
    ax.set_title(TITLES[quantity])
    _crossings(ax, answer, quantity)


def _phases(ax, answer, name: str):
    """One phase; positive: behind, negative: ahead."""
    both = _roads(ax, answer, name)
    spread = max(np.ptp(both), 1.0)
    ax.axhline(0.0, color=BLACK, lw=0.6)
    ax.set_ylim(min(both.min(), 0) - 0.1 * spread, max(both.max(), 0) + 0.1 * spread)
    ax.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 1.5, 2, 3, 4.5, 6, 9, 10]))
    ax.yaxis.set_major_formatter(lambda value, _: number(value))


def _crossings(ax, answer, quantity):
    found = [c for c in answer["crossings"] if c["quantity"] == quantity][:4]
    better = answer["better"][quantity]
    lines = [] if found else [f"{better.upper()} better at every speed" if better else "both the same"]
    for crossing in found:
        at = crossing["speed"] * (RPM if answer["unit"] == "rpm" else 1.0)
        ax.axvline(at, color=GREY, lw=0.8, ls=":")
        lines.append(f"{crossing['better_above'].upper()} better above {at:.6g} {answer['unit']}")
    ax.text(0.03, 0.96, "\n".join(lines), transform=ax.transAxes, va="top", fontsize=8, color=GREY, linespacing=1.5,
            backgroundcolor="white")  # fmt: skip


def _legend(ax, answer):
    """What the lines are, how far the time domain is from them, and what a phase is."""
    ax.axis("off")
    road = "formula" if answer["formula_holds"] else "linear algebra"
    for seal, colour in COLOUR.items():
        ax.plot([], [], color=colour, lw=2.2, alpha=0.75, label=f"{seal.upper()}, {road}")
    ax.plot([], [], color=BLACK, lw=0.8, ls=(0, (4, 5)), label="linear algebra")
    errors = [row["error"] for row in done(answer["time_domain"])]
    if errors:
        apart = max(error[name] for error in errors for name in TITLES)
        turned = max(error[name] for error in errors for name in ("static_phase", "dynamic_phase"))
        label = f"time domain (error bars up to\n{apart:.0e} and {turned:.0e} deg)"
        ax.plot([], [], "o", color=GREY, mfc="white", label=label)
    if not all(all(answer[seal]["stable"]) for seal in COLOUR):
        ax.plot([], [], color=GREY, lw=1, ls=":", label="no steady state: not damped")
    ax.legend(loc="upper left", borderaxespad=0.0, fontsize=8.5)
    words = "\n".join(wrap(answer["phase"], 48))
    ax.text(0.0, 0.0, words, fontsize=8.5, color=GREY, va="bottom", linespacing=1.4, transform=ax.transAxes)


def _table(ax, rows):
    """FMR against FMS, as Green's Table 1."""
    ax.axis("off")
    roads = ("formula", "linear_algebra", "time_domain")
    heads = ("At the scenario's speed (Green's Table 1)", "FMR", "", "", "FMS", "", "")
    below = ("", *(r.replace("_", " ") for r in roads), *(r.replace("_", " ") for r in roads))
    columns = (0.0, 0.32, 0.435, 0.55, 0.68, 0.795, 0.91)
    lines = [heads, below]
    for row in rows:
        cells = [_cell(row, row[road][seal], road) for seal in COLOUR for road in roads]
        lines.append((WORDS[row["quantity"]], *cells))
    for i, cells in enumerate(lines):
        y = 1 - i / (len(lines) - 0.5)
        for x, words in zip(columns, cells, strict=True):
            weight = "bold" if i == 0 else "normal"
            ax.text(x, y, words, va="top", fontsize=8.5, weight=weight, color=GREY if i == 1 else BLACK)
        if i >= 1:
            ax.axhline(y - 0.118, color=PALE, lw=0.5)
    ax.set(xlim=(0, 1), ylim=(0, 1))


def _cell(row, value, road) -> str:
    if value is None:
        return "none" if row["quantity"] == "critical_speed" and road != "time_domain" else "–"
    return f"{value:.5g}"
