"""Opening force over clearance with the closing force: where they meet the seal rides."""

import numpy as np

from ...archive import read_study
from .page import PAPER, logarithmic, look, save, study_page
from .palette import BLACK, CONTACT, FILM, GREEN, GREY, THEORY, VERMILLION

# Colour and mark of a root by its stability.
ROOT = {True: (GREEN, "o", "stable"), False: (VERMILLION, "X", "unstable")}
# What is drawn of the force of asperities, in closing forces, and of their stiffness, in that of the stiffest root.
SHOWN = 3.0


@look()
def draw(archive_path, out_path):
    """Force above, stiffness below, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    title = "At which clearance does the seal ride?"
    # The closing force, second in the verdict, stands in the legend.
    found = " ".join([*answer["verdict"][:1], *answer["verdict"][2:]])
    figure, ax = study_page(study, 9.5, 7.4, [["force"], ["stiffness"]], title, bold=found, height_ratios=(5, 3))
    clearance = 1e6 * np.array(answer["curve"]["clearance"])
    shown = _forces(ax["force"], answer, clearance)
    _stiffness(ax["stiffness"], answer, clearance)
    for panel in ax.values():
        logarithmic(panel, "x")
        panel.set(xlim=(clearance[shown], clearance[-1]), xlabel="clearance at the inner radius, µm")
    return save(figure, out_path)


def _forces(ax, answer, clearance) -> int:
    """Forces over clearance; returns the first point in view: asperities pressed flat fill no part of the panel."""
    opening, closing = np.array(answer["curve"]["opening_force"]), answer["closing_force"]
    rough = np.array(answer["curve"].get("contact_force", [0.0]))
    label = "opening force, film and asperities" if rough.any() else "opening force of the aligned film"
    ax.plot(clearance, opening, color=FILM, lw=2.0, label=label)
    if rough.any():
        ax.plot(clearance, rough, color=CONTACT, lw=1.4, ls=":", label="of it asperities")
    ax.axhline(closing, color=THEORY, lw=1.6, ls="--", label=f"closing force {closing:.5g} N")
    # Asperities pressed flat carry so much that nothing else would be seen.
    top = min(opening.max(), SHOWN * closing) if rough.any() and closing > 0 else opening.max()
    span = max(max(top, closing) - min(opening.min(), closing), 1e-9)
    for stable, (colour, mark, label) in ROOT.items():
        at = [1e6 * root["clearance"] for root in answer["roots"] if root["stable"] == stable]
        if at:
            ax.plot(at, [closing] * len(at), mark, ms=10, mfc=colour, mec=BLACK, label=label, zorder=4)
        # Above a force that falls, below one that rises: on its right both sides are free there.
        for x in at:
            ax.annotate(f"{x:.4g} µm", (x, closing), xytext=(7, 6 if stable else -6), textcoords="offset points",
                        fontsize=9, va="bottom" if stable else "top", bbox=PAPER)  # fmt: skip
    # Asperities are seen to where they leave each other.
    lowest = min(opening.min(), closing, 0.0 if rough.any() else np.inf)
    ax.set(ylim=(lowest - 0.08 * span, max(top, closing) + 0.18 * span),
           ylabel="axial force, N", title="Opening and closing force")  # fmt: skip
    ax.legend(loc="upper right", ncols=2)
    # A quarter of a decade before the force comes into view.
    seen = clearance >= clearance[np.argmax(opening <= top + 0.18 * span)] / 10**0.25
    return int(np.argmax(seen)) if rough.any() else 0


def _stiffness(ax, answer, clearance):
    stiffness = 1e-6 * np.array(answer["curve"]["stiffness"])
    ax.plot(clearance, stiffness, color=FILM, lw=1.8)
    ax.axhline(0.0, color=BLACK, lw=0.9)
    ax.fill_between(clearance, np.minimum(stiffness, 0.0), 0.0, color=VERMILLION, alpha=0.15, lw=0)
    for root in answer["roots"]:
        colour, mark, _ = ROOT[root["stable"]]
        ax.axvline(1e6 * root["clearance"], color=GREY, lw=0.8, ls=":")
        ax.plot(1e6 * root["clearance"], 1e-6 * root["stiffness"], mark, ms=8, mfc=colour, mec=BLACK, zorder=4)
    held = [1e-6 * root["stiffness"] for root in answer["roots"]]
    rough = np.any(answer["curve"].get("contact_force", [0.0]))
    what = "film and asperities" if rough else "the film"
    if rough and max(held, default=0.0) > 0:
        ax.set_ylim(min(stiffness.min(), 0.0) - 0.1 * max(held), SHOWN * max(held))
    ax.set(ylabel="stiffness, N/µm", title=f"Axial stiffness of {what} (negative: it runs away)")
