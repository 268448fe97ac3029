"""Bode plot of the FMR and the FMS seal over speed, three independent methods on one chart: transmissibilities above,
phases below
them, and the table at the foot."""

from textwrap import wrap

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from ...archive import read_study
from .page import heading, look, save, sheet
from .palette import BLACK, GREY, PALE, RING

COLOUR = {"fmr": RING["rotor"], "fms": RING["stator"]}
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


def draw(archive_path, out_path):
    """Amplitudes and phases over speed and a table, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(11.5, 9.6)
        heading(figure, "How much misalignment reaches the film?", f"{study['name']}: {study['question']}")
        for i, quantity in enumerate(TITLES):
            left = 0.06 + 0.324 * i
            above = figure.add_axes((left, 0.585, 0.262, 0.32))
            _amplitudes(above, answer, quantity)
            if quantity == "total":
                _legend(figure, answer, left)
                above.set_xlabel(f"shaft speed, {answer['unit']}")
            else:
                _phases(figure.add_axes((left, 0.32, 0.262, 0.2), sharex=above), answer, f"{quantity}_phase")
                above.tick_params(labelbottom=False)
        figure.axes[0].set_ylabel("relative misalignment per unit forcing")
        figure.axes[1].set_ylabel("phase behind the forcing, deg")
        figure.align_ylabels(figure.axes[:2])
        _table(figure, answer)
        return save(figure, out_path)


def _roads(ax, answer, quantity: str):
    """One column of both arrangements by three independent methods over speed."""
    unit = answer["unit"]
    factor = RPM if unit == "rpm" else 1.0
    speed = factor * np.array(answer["speed"])
    for seal, colour in COLOUR.items():
        stable = np.array(answer[seal]["stable"])
        line, dashes = np.array(answer[seal][quantity]), np.array(answer[seal]["linear_algebra"][quantity])
        ax.plot(speed, np.where(stable, line, np.nan), color=colour, lw=2.2, alpha=0.75)
        ax.plot(speed, np.where(stable, np.nan, line), color=colour, lw=1.0, alpha=0.5, ls=":")
        ax.plot(speed, np.where(stable, dashes, np.nan), color=BLACK, lw=0.8, ls=(0, (4, 5)))
        rows = [r for r in answer["time_domain"] if r["seal"] == seal and "failed" not in r]
        at = [factor * r["speed"] for r in rows]
        bars = [r["error"][quantity] for r in rows]
        mark = "o" if seal == "fmr" else "s"
        ax.errorbar(at, [r[quantity] for r in rows], bars, fmt=mark, ms=4.5, mfc="white", mec=colour, ecolor=colour,
                    capsize=3, lw=1.0, clip_on=False)  # fmt: skip
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
        ax.set_yscale("log")
        ax.set_ylim(0.7 * lowest, highest * (highest / lowest) ** room)
        ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if highest < 300 * lowest else (1,)))
        ax.yaxis.set_minor_formatter(NullFormatter())
        ax.yaxis.set_major_formatter(lambda v, _: f"{v:g}")
    else:
        ax.set_ylim(0, (1 + room) * highest)
    ax.set_title(TITLES[quantity])
    _crossings(ax, answer, quantity, RPM if answer["unit"] == "rpm" else 1.0, answer["unit"])


def _phases(ax, answer, name: str):
    """One phase; positive: behind, negative: ahead."""
    both = _roads(ax, answer, name)
    spread = max(np.ptp(both), 1.0)
    ax.axhline(0.0, color=BLACK, lw=0.6)
    ax.set_ylim(min(both.min(), 0) - 0.1 * spread, max(both.max(), 0) + 0.1 * spread)
    ax.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 1.5, 2, 3, 4.5, 6, 9, 10]))
    ax.yaxis.set_major_formatter(lambda v, _: f"{v:g}".replace("-", "−"))
    ax.set_xlabel(f"shaft speed, {answer['unit']}")


def _crossings(ax, answer, quantity, factor, unit):
    found = [c for c in answer["crossings"] if c["quantity"] == quantity]
    if not found:
        better = answer["better"][quantity]
        words = f"{better.upper()} better at every speed" if better else "both the same"
        ax.text(0.03, 0.96, words, transform=ax.transAxes, va="top", fontsize=8,
                color=GREY)  # fmt: skip
    for n, crossing in enumerate(found[:4]):
        at = factor * crossing["speed"]
        ax.axvline(at, color=GREY, lw=0.8, ls=":")
        words = f"{crossing['better_above'].upper()} better above {at:.6g} {unit}"
        ax.text(
            0.03,
            0.96 - 0.065 * n,
            words,
            transform=ax.transAxes,
            va="top",
            fontsize=8,
            color=GREY,
            backgroundcolor="white",
        )


def _legend(figure, answer, left):
    from matplotlib.lines import Line2D

    road = "formula" if answer["formula_holds"] else "linear algebra"
    errors = [r["error"] for r in answer["time_domain"] if "failed" not in r]
    apart = max((e[q] for e in errors for q in TITLES), default=None)
    handles = [
        Line2D([], [], color=COLOUR["fmr"], lw=2.2, alpha=0.75, label=f"FMR, {road}"),
        Line2D([], [], color=COLOUR["fms"], lw=2.2, alpha=0.75, label=f"FMS, {road}"),
        Line2D([], [], color=BLACK, lw=0.8, ls=(0, (4, 5)), label="linear algebra"),
    ]
    if apart is not None:
        turned = max(e[q] for e in errors for q in ("static_phase", "dynamic_phase"))
        label = f"time domain (error bars up to\n{apart:.0e} and {turned:.0e} deg)"
        handles.append(Line2D([], [], color=GREY, ls="", marker="o", mfc="white", label=label))
    if not all(all(answer[s]["stable"]) for s in COLOUR):
        handles.append(Line2D([], [], color=GREY, lw=1, ls=":", label="no steady state: not damped"))
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(left - 0.01, 0.522), fontsize=8.5)
    words = "\n".join(wrap(answer["phase"], 48))
    figure.text(left, 0.345, words, fontsize=8.5, color=GREY, va="center", linespacing=1.4)


def _table(figure, answer):
    """FMR against FMS, as Green's Table 1."""
    rows = answer["table"]
    if not rows:
        return
    ax = figure.add_axes((0.06, 0.02, 0.914, 0.225))
    ax.axis("off")
    roads = ("formula", "linear_algebra", "time_domain")
    heads = ("At the scenario's speed (Green's Table 1)", "FMR", "", "", "FMS", "", "")
    below = ("", *(r.replace("_", " ") for r in roads), *(r.replace("_", " ") for r in roads))
    columns = (0.0, 0.32, 0.435, 0.55, 0.68, 0.795, 0.91)
    lines = [heads, below]
    for row in rows:
        cells = [_cell(row, row[road][seal], road) for seal in ("fmr", "fms") for road in roads]
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
