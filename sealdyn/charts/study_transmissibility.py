"""Transmissibilities of the FMR and the FMS seal over speed, three roads on one chart, and the table below."""

import numpy as np

from ..archive import read_study
from .page import look, save, sheet, shortened
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
    """Three panels over speed and a table, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(11.5, 7.4)
        figure.text(0.035, 0.965, "How much misalignment reaches the film?", fontsize=13, weight="bold", va="center")
        figure.text(0.035, 0.933, shortened(f"{study['name']}: {study['question']}", 150), fontsize=9, va="center")
        for i, quantity in enumerate(TITLES):
            panel(figure.add_axes((0.06 + 0.317 * i, 0.385, 0.28, 0.455)), answer, quantity, i == 0)
        _legend(figure, answer)
        _table(figure, answer)
        return save(figure, out_path)


def panel(ax, answer, quantity: str, labelled: bool):
    """One transmissibility of both arrangements."""
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
    both = np.concatenate([answer[s][quantity] for s in COLOUR])
    lowest, highest = max(both.min(), 1e-9), np.percentile(both, 99)
    if highest > 8 * lowest:
        # Far apart: the crossing is seen on a logarithmic axis only.
        ax.set_yscale("log")
        ax.set_ylim(0.7 * lowest, highest * (highest / lowest) ** 0.2)
    else:
        ax.set_ylim(0, 1.22 * highest)
    ax.set(xlim=(speed[0], speed[-1]), xlabel=f"shaft speed, {unit}")
    ax.locator_params(axis="x", nbins=5)
    if labelled:
        ax.set_ylabel("relative misalignment per unit forcing")
    ax.set_title(TITLES[quantity])
    _crossings(ax, answer, quantity, factor, unit)


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


def _legend(figure, answer):
    from matplotlib.lines import Line2D

    road = "formula" if answer["formula_holds"] else "linear algebra"
    apart = max((r["error"][q] for r in answer["time_domain"] if "failed" not in r for q in TITLES), default=None)
    handles = [
        Line2D([], [], color=COLOUR["fmr"], lw=2.2, alpha=0.75, label=f"FMR, {road}"),
        Line2D([], [], color=COLOUR["fms"], lw=2.2, alpha=0.75, label=f"FMS, {road}"),
        Line2D([], [], color=BLACK, lw=0.8, ls=(0, (4, 5)), label="linear algebra"),
    ]
    if apart is not None:
        label = f"time domain (largest error bar {apart:.0e})"
        handles.append(Line2D([], [], color=GREY, ls="", marker="o", mfc="white", label=label))
    if not all(all(answer[s]["stable"]) for s in COLOUR):
        handles.append(Line2D([], [], color=GREY, lw=1, ls=":", label="no steady state: not damped"))
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.03, 0.922), ncols=5)


def _table(figure, answer):
    """FMR against FMS, as Green's Table 1."""
    rows = answer["table"]
    if not rows:
        return
    ax = figure.add_axes((0.06, 0.03, 0.914, 0.28))
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
