"""Opening force over clearance with the closing force: where they meet the seal rides."""

import numpy as np

from ...archive import read_study
from .page import heading, look, save, sheet
from .palette import BLACK, FILM, GREEN, GREY, THEORY, VERMILLION


def draw(archive_path, out_path):
    """Force above, film stiffness below, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(9.5, 7.2)
        heading(figure, "At which clearance does the seal ride?", f"{study['name']}: {study['question']}")
        top, below = figure.add_axes((0.11, 0.43, 0.86, 0.42)), figure.add_axes((0.11, 0.09, 0.86, 0.25))
        clearance = 1e6 * np.array(answer["curve"]["clearance"])
        _forces(top, answer, clearance)
        _stiffness(below, answer, clearance)
        for ax in (top, below):
            ax.set_xscale("log")
            ax.set_xlim(clearance[0], clearance[-1])
            ax.xaxis.set_major_formatter(lambda v, _: f"{v:g}")
            ax.xaxis.set_minor_formatter(lambda v, _: f"{v:g}" if f"{v:.0e}"[0] in "25" else "")
            ax.set_xlabel("clearance at the inner radius, µm")
        return save(figure, out_path)


def _forces(ax, answer, clearance):
    opening, closing = np.array(answer["curve"]["opening_force"]), answer["closing_force"]
    ax.plot(clearance, opening, color=FILM, lw=2.0, label="opening force of the aligned film")
    ax.axhline(closing, color=THEORY, lw=1.6, ls="--", label=f"closing force {closing:.5g} N")
    span = max(np.ptp(np.append(opening, closing)), 1e-9)
    for stable, colour, mark, label in ((True, GREEN, "o", "stable"), (False, VERMILLION, "X", "unstable")):
        roots = [r for r in answer["roots"] if r["stable"] == stable]
        at = [1e6 * r["clearance"] for r in roots]
        if roots:
            ax.plot(at, [closing] * len(roots), mark, ms=10, mfc=colour, mec=BLACK, ls="", label=label, zorder=4)
        for x in at:
            ax.annotate(
                f"{x:.4g} µm", (x, closing), xytext=(0, -18), textcoords="offset points", fontsize=9, ha="center"
            )
    ax.set(ylim=(min(opening.min(), closing) - 0.08 * span, max(opening.max(), closing) + 0.18 * span),
           ylabel="axial force, N", title="Opening and closing force")  # fmt: skip
    ax.legend(loc="upper right", ncols=2)


def _stiffness(ax, answer, clearance):
    stiffness = 1e-6 * np.array(answer["curve"]["stiffness"])
    ax.plot(clearance, stiffness, color=FILM, lw=1.8)
    ax.axhline(0.0, color=BLACK, lw=0.9)
    ax.fill_between(clearance, np.minimum(stiffness, 0.0), 0.0, color=VERMILLION, alpha=0.15, lw=0)
    for root in answer["roots"]:
        colour = GREEN if root["stable"] else VERMILLION
        ax.axvline(1e6 * root["clearance"], color=GREY, lw=0.8, ls=":")
        ax.plot(1e6 * root["clearance"], 1e-6 * root["stiffness"], "o" if root["stable"] else "X", ms=8, mfc=colour,
                mec=BLACK, zorder=4)  # fmt: skip
    ax.set(ylabel="stiffness, N/µm", title="Axial film stiffness (negative: the film runs away)")
