"""Contact onset: film and tilt of the periodic orbit as the forcing grows, linear and nonlinear onset, curve."""

import numpy as np

from ...archive import read_study
from .page import absent, heading, look, save, sheet
from .palette import BLUE, CONTACT, FILM, PURPLE, THEORY, TILT


def draw(archive_path, out_path):
    """Three panels from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(12, 5.2)
        heading(figure, "When do the faces first touch?", f"{study['name']}: {study['question']}", answer["verdict"][0])
        boxes = [(0.06 + 0.325 * i, 0.13, 0.25, 0.61) for i in range(3)]
        axes = [figure.add_axes(box) for box in boxes]
        if answer.get("path"):
            _film(axes[0], answer)
            _opening(axes[1], answer)
        else:
            for ax, title in zip(axes, ("Smallest film thickness", "Tilt and opening"), strict=False):
                absent(ax, title, "no orbit found")
        _curve(axes[2], answer)
        return save(figure, out_path)


def _path(answer, name):
    """A column of the path, in the order of the forcing."""
    forcing = np.array(answer["path"]["forcing"])
    order = np.argsort(forcing)
    return 1e3 * forcing[order], np.array(answer["path"][name])[order]


def _film(ax, answer):
    forcing, h_min = _path(answer, "h_min")
    clearance = 1e6 * answer["clearance"]
    ax.plot(np.r_[0, forcing], np.r_[clearance, 1e6 * h_min], "o-", color=FILM, ms=3.5, label="nonlinear orbit")
    linear = 1e3 * answer["formula"]
    ax.plot([0, linear], [clearance, 0], "--", color=THEORY, label="linear theory")
    ax.axhline(0, color=CONTACT, lw=1.2)
    ax.set_title("Smallest film thickness")
    ax.set_xlabel(f"{answer['key']}, mrad")
    ax.set_ylabel("h_min, µm")
    ax.legend(loc="upper right")


def _opening(ax, answer):
    forcing, axial = _path(answer, "axial")
    ax.plot(np.r_[0, forcing], np.r_[0, 100 * axial / answer["clearance"]], "o-", color=BLUE, ms=3.5)
    ax.set_title("The seal lifts: axial opening")
    ax.set_xlabel(f"{answer['key']}, mrad")
    ax.set_ylabel("opening, % of the clearance")
    ax.axvline(1e3 * answer["formula"], color=THEORY, ls="--")
    ax.axvline(1e3 * answer["nonlinear"], color=CONTACT, lw=1.2)
    ax.text(1e3 * answer["formula"], ax.get_ylim()[1], "linear onset ", color=THEORY, ha="right", va="top", rotation=90)
    ax.text(1e3 * answer["nonlinear"], ax.get_ylim()[0], "onset ", color=CONTACT, ha="right", va="bottom", rotation=90)


def _curve(ax, answer):
    rows = answer["curve"]
    if not rows:
        return absent(ax, "Onset over another key", "no study.contact_onset.over asked for")
    words = any(isinstance(row["value"], str) for row in rows)
    at = list(range(len(rows))) if words else [row["value"] for row in rows]
    floored = [row.get("floored", {}) for row in rows]
    # Where an onset was not found the curve has a gap, and a cross on the axis.
    for found, name, style in (
        (rows, "nonlinear", {"color": TILT, "marker": "o", "ms": 4.5, "label": "nonlinear"}),
        (
            floored,
            "nonlinear",
            {"color": PURPLE, "marker": "s", "ms": 4.5, "mfc": "white", "label": "pressure floored"},
        ),
        (rows, "formula", {"color": THEORY, "ls": "--", "marker": ".", "label": "linear theory"}),
    ):
        if any(found):
            ax.plot(at, [1e3 * row[name] if row.get(name) is not None else np.nan for row in found], **style)
    missing = [x for x, *pair in zip(at, rows, floored, strict=True) if any("failed" in row for row in pair)]
    if missing:
        ax.plot(missing, [0.0] * len(missing), "x", color=CONTACT, clip_on=False, label="an onset was not found")
    if words:
        ax.set_xticks(at, [str(row["value"]) for row in rows])
    ax.set_ylim(0, 1.45 * ax.get_ylim()[1])
    ax.set_title(f"Onset over {answer['over']}")
    ax.set_xlabel(answer["over"] if words else f"{answer['over']}, SI")
    ax.set_ylabel(f"{answer['key']} at touch, mrad")
    ax.legend(loc="upper right")
