"""Contact onset: film and tilt of the periodic orbit as the forcing grows, linear and nonlinear onset, curve."""

import numpy as np

from ...archive import read_study
from .page import absent, look, save, study_page, upright
from .palette import BLUE, CONTACT, FILM, PURPLE, THEORY, TILT


@look()
def draw(archive_path, out_path):
    """The film over the forcing, how the seal lifts, and the onset over another key: panels of what is there."""
    study = read_study(archive_path)
    answer, title = study["answer"], "When do the faces first touch?"
    bold = " ".join(answer["verdict"]) if "failed" in answer else answer["verdict"][0]
    # What linear theory says stands where nothing was followed, too.
    known = answer.get("path") or answer.get("linear") or (answer["formula"] and answer.get("clearance"))
    panels = {_film: known, _opening: answer.get("path"), _curve: answer["curve"]}
    panels = {draws.__name__: draws for draws, there in panels.items() if there}
    mosaic, size = [list(panels) or ["nothing"]], (12, 5.2) if len(panels) > 1 else (8.5, 5.2 if panels else 3.0)
    figure, ax = study_page(study, *size, mosaic, title, bold=bold)
    for name, draws in panels.items():
        draws(ax[name], answer)
    if not panels:
        absent(ax["nothing"], "Smallest film thickness", _why(answer))
    return save(figure, out_path)


def _why(answer):
    """Why no orbit is drawn."""
    return "touching when aligned" if answer["nonlinear"] == 0.0 else answer.get("failed") or "no orbit followed"


def _path(answer, name):
    """Forcing (mrad) and a column of the path, in the order of the forcing, from where nothing forces."""
    forcing = np.array(answer["path"]["forcing"])
    order = np.argsort(forcing)
    start = answer["clearance"] if name == "h_min" else 0
    return np.r_[0, 1e3 * forcing[order]], np.r_[start, np.array(answer["path"][name])[order]]


def _film(ax, answer):
    if answer.get("path"):
        forcing, h_min = _path(answer, "h_min")
        ax.plot(forcing, 1e6 * h_min, "o-", color=FILM, ms=3.5, label="nonlinear orbit")
    touch, linear = 1e6 * (answer.get("touch") or 0.0), answer.get("linear")
    if linear:
        forcing, h_min = 1e3 * np.array(linear["forcing"]), 1e6 * np.array(linear["h_min"])
    else:
        forcing, h_min = [0, 1e3 * answer["formula"]], [1e6 * answer["clearance"], touch]
    ax.plot(forcing, h_min, "--", color=THEORY, label="linear theory")
    ax.axhline(touch, color=CONTACT, lw=1.2, label="asperities meet" if touch else "touch")
    own = linear["own"] if linear else answer.get("times_own") and answer["formula"] / answer["times_own"]
    if own:
        upright(ax, 1e3 * own, "the scenario's own", BLUE, height=0.4, ls=":")
    ax.set(title="Smallest film thickness", xlabel=f"{answer['key']}, mrad", ylabel="h_min, µm")
    ax.set_ylim(top=1.25 * ax.get_ylim()[1])
    ax.legend(loc="upper right", ncols=3)


def _opening(ax, answer):
    forcing, axial = _path(answer, "axial")
    ax.plot(forcing, 100 * axial / answer["clearance"], "o-", color=BLUE, ms=3.5)
    upright(ax, 1e3 * answer["formula"], "linear onset", THEORY, height=0.93, ha="right", ls="--")
    if answer["nonlinear"] is not None:
        upright(ax, 1e3 * answer["nonlinear"], "onset", CONTACT, ha="right")
    ax.set(title="The seal lifts: axial opening", xlabel=f"{answer['key']}, mrad", ylabel="opening, % of the clearance")


def _curve(ax, answer):
    rows = answer["curve"]
    words = any(isinstance(row["value"], str) for row in rows)
    at = list(range(len(rows))) if words else [row["value"] for row in rows]
    floored = [row.get("floored", {}) for row in rows]
    # Where an onset was not found the curve has a gap, and a cross on the axis.
    for found, name, style in (
        (rows, "nonlinear", {"color": TILT, "marker": "o", "ms": 4.5, "label": "nonlinear"}),
        (floored, "nonlinear", {"color": PURPLE, "marker": "s", "mfc": "white", "label": "pressure floored"}),
        (rows, "formula", {"color": THEORY, "ls": "--", "marker": ".", "label": "linear theory"}),
    ):
        if any(found):
            ax.plot(at, 1e3 * np.array([row.get(name) for row in found], dtype=float), **style)
    missing = [x for x, *pair in zip(at, rows, floored, strict=True) if any("failed" in row for row in pair)]
    if missing:
        ax.plot(missing, [0.0] * len(missing), "x", color=CONTACT, clip_on=False, label="an onset was not found")
    if words:
        ax.set_xticks(at, [str(row["value"]) for row in rows])
    ax.set_ylim(0, 1.45 * ax.get_ylim()[1])
    ax.set(title=f"Onset over {answer['over']}", xlabel=answer["over"] if words else f"{answer['over']}, SI",
           ylabel=f"{answer['key']} at touch, mrad")  # fmt: skip
    ax.legend(loc="upper right")
