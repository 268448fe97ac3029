"""Initial over net waviness of an elastic ring, its operating points, what becomes of them."""

import numpy as np

from ...archive import read_study
from .page import absent, legend, logarithmic, look, save, study_page
from .palette import BLACK, CONTACT, FILM, GREEN, GREY, THEORY, VERMILLION

ROOT = {True: (GREEN, "o", "holds"), False: (VERMILLION, "X", "does not hold")}


@look()
def draw(archive_path, out_path):
    """The curve with its crossings, load support along it, and the waviness of points that were let go over time."""
    study = read_study(archive_path)
    answer = study["answer"]
    title = "Which waviness is left under load?"
    rows = [["curve", "time"], ["load", "time"]]
    figure, ax = study_page(study, 11.5, 7.4, rows, title, " ".join(answer["verdict"][:2]), width_ratios=(1.1, 1.0))
    curve = {name: np.array(values) for name, values in answer["curve"].items()}
    net = 1e6 * curve["net"]
    ax["curve"].plot(net, 1e6 * curve["initial"], color=FILM, lw=2.0, label="made with this, left with that")
    ax["curve"].axhline(1e6 * answer["initial"], color=THEORY, lw=1.4, ls="--", label="what the ring was made with")
    ax["load"].plot(net, 100.0 * curve["load_support"], color=CONTACT, lw=2.0)
    for stable, (colour, mark, label) in ROOT.items():
        points = [point for point in answer["points"] if point["stable"] == stable]
        if points:
            at = [1e6 * point["net"] for point in points]
            style = {"ls": "none", "marker": mark, "ms": 10, "mfc": colour, "mec": BLACK, "zorder": 4}
            ax["curve"].plot(at, [1e6 * answer["initial"]] * len(at), label=label, **style)
            ax["load"].plot(at, [100.0 * point["load_support"] for point in points], **style)
    for panel, words in (("curve", "initial waviness, µm"), ("load", "load support, %")):
        logarithmic(ax[panel], "x")
        ax[panel].set(xlabel="net waviness, µm", ylabel=words, xlim=(net[0], net[-1]))
    logarithmic(ax["curve"], "y")
    legend(ax["curve"], "above", ncols=2)
    _released(ax["time"], answer["points"])
    return save(figure, out_path)


def _released(ax, points):
    """Waviness over time of every point that was let go."""
    ways = [(point, way) for point in points for way in point["let_go"] if "net" in way]
    if not ways:
        absent(ax, "Let go", "no operating point whose motion was followed")
        return
    for point in points:
        ax.axhline(1e6 * point["net"], color=GREY, lw=0.9, ls=":")
        # A ring that is back at once does not enlarge its last step.
        ax.update_datalim([(1.0, 1e6 * way["from"]) for way in point["let_go"]], updatex=False)
    for point, way in ways:
        colour = ROOT[point["stable"]][0]
        ax.plot(1e3 * np.array(way["time"][1:]), 1e6 * np.array(way["net"][1:]), color=colour, lw=1.5)
    logarithmic(ax, "x")
    logarithmic(ax, "y")
    ax.set(xlabel="time, ms", ylabel="waviness, µm", title="Let go a little beside each point")
