"""Followability: the largest eccentricity that is followed over the speed, runs upon it, and the guide's table."""

import math

import numpy as np

from ...archive import read_study
from .page import legend, level, logarithmic, look, once, save, study_page
from .palette import CYCLE, GREY, MARK

RPM = 30.0 / math.pi


@look()
def draw(archive_path, out_path):
    """One panel, logarithmic upward: below a curve the element rides all the way round.  Where a limit is beyond what
    was looked for the curve runs along that bound."""
    study = read_study(archive_path)
    answer = study["answer"]
    figure, ax = study_page(study, 10.0, 6.0, [["map"]], below=" ".join(answer["verdict"]))
    # Archives of earlier versions do not hold the bound.
    ax, most = ax["map"], answer.get("most", math.nan)
    if "most" in answer and any(e is None for line in answer["curves"] for e in line["eccentricity"]):
        level(ax, 1e3 * most, "a fifth of the shaft's radius: no limit is looked for beyond", side="left")
    for k, line in enumerate(answer["curves"]):
        colour = CYCLE[k % len(CYCLE)]
        limit = np.array([most if e is None else e for e in line["eccentricity"]], float)
        held = "" if limit.any() else ": nothing is followed"
        # A logarithmic axis has no place for nothing.
        shown = np.where(limit > 0.0, 1e3 * limit, np.nan)
        ax.plot(RPM * np.array(line["speed"]), shown, color=colour, label=line["name"] + held)
        points = [row for row in answer["runs"] if row["curve"] == k and row.get("eccentricity")]
        ax.plot([RPM * row["speed"] for row in points], [1e3 * row["eccentricity"] for row in points], "o",
                color=colour, mfc="none", ms=7, label=once(ax, "limit found by runs") if points else "_")  # fmt: skip
    guide = answer["guide"]
    speeds = RPM * np.array(guide["surface_speed"]) / answer["radius"]
    ax.plot(speeds, 1e3 * np.array(guide["eccentricity"]), "s--", color=GREY, ms=5, label=f"guide, {guide['words']}")
    if answer["eccentricity"] > 0:
        ax.plot(RPM * answer["speed"], 1e3 * answer["eccentricity"], "*", color=MARK, ms=11, label="this scenario")
    ax.set(xlabel="shaft speed, rpm", ylabel="largest eccentricity followed, mm",
           title="Contact is lost above the curve")  # fmt: skip
    logarithmic(ax, "y")
    legend(ax, "best")
    return save(figure, out_path)
