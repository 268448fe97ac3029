"""Wear: what has gone from both faces over the hours, contact pressure times speed at start and end, and what leakage,
friction and the contact's share of the load become."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from ...archive import read_study
from .page import absent, look, save, sheet, shortened
from .palette import BLACK, CONTACT, FILM, GREY, LEAK, ORANGE, RING, STATUS, THICKNESS

# Profiles drawn of one face.
LINES = 9
LEFT, MIDDLE, WIDTH = 0.062, 0.635, 0.345


def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    history = answer["history"]
    with look():
        figure = sheet(13.0, 8.6)
        figure.text(
            0.03, 0.968, shortened(study["question"].split("?")[0] + "?", 110), fontsize=13, weight="bold", va="center"
        )
        figure.text(0.03, 0.937, shortened(f"{study['name']}: {answer['end']['said']}", 165), fontsize=9, va="center",
                    color=STATUS.get(answer["status"], BLACK))  # fmt: skip
        if not history["time"]:
            absent(figure.add_axes((LEFT, 0.1, 0.9, 0.75)), "No profile", answer["end"]["said"])
            return save(figure, out_path)
        unit, factor = _time_unit(history["time"][-1])
        _faces(figure, answer, unit, factor)
        _pressed(figure.add_axes((LEFT, 0.075, 0.47, 0.22)), answer)
        _over_time(figure, history, unit, factor)
        return save(figure, out_path)


def _time_unit(end) -> tuple[str, float]:
    for unit, seconds in (("h", 3600.0), ("min", 60.0)):
        if end >= seconds:
            return unit, 1.0 / seconds
    return "s", 1.0


def _length_unit(largest) -> tuple[str, float]:
    return ("µm", 1e6) if largest >= 3e-7 else ("nm", 1e9)


def _faces(figure, answer, unit, factor):
    """Worn depth of each face over the radius, coloured by time; below, the gap they leave."""
    time = factor * np.array(answer["history"]["time"])
    radius = 1e3 * np.array(answer["radius"])
    colour, scale = colormaps[THICKNESS].reversed(), Normalize(0.0, time[-1] or 1.0)
    shown = np.unique([int(np.argmin(np.abs(time - t))) for t in np.linspace(0.0, time[-1], LINES)])
    for k, face in enumerate(("stator", "rotor")):
        ax = figure.add_axes((LEFT + 0.258 * k, 0.655, 0.212, 0.225))
        depth = np.array(answer["profile"][face])
        name, per = _length_unit(depth.max())
        if depth.max() == 0.0:
            absent(ax, f"{face.capitalize()}: worn off", "does not wear")
            continue
        for i in shown:
            ax.plot(radius, per * depth[i], color=colour(scale(time[i])), lw=1.3)
        if answer["extrapolated"]:
            ax.plot(radius, per * np.array(answer["extrapolated"][face]), color=GREY, lw=1.0, ls=":")
        ax.invert_yaxis()
        ax.margins(x=0.01)
        ax.set(xlabel="radius, mm", ylabel=f"depth, {name}", title=f"{face.capitalize()}: worn off")
    ax = figure.add_axes((LEFT, 0.375, 0.47, 0.2))
    gap = np.array(answer["profile"]["gap"])
    gap = gap - gap.min(axis=1, keepdims=True)
    name, per = _length_unit(gap.max())
    for i in shown:
        ax.plot(radius, per * gap[i], color=colour(scale(time[i])), lw=1.3)
    ax.margins(x=0.01)
    ax.set(xlabel="radius, mm", ylabel=f"gap, {name}", title="Shape of the gap, from its narrowest place")
    bar = figure.colorbar(ScalarMappable(scale, colour), cax=figure.add_axes((0.546, 0.375, 0.008, 0.505)))
    bar.set_label(f"time, {unit}")
    bar.outline.set_visible(False)


def _pressed(ax, answer):
    """Contact pressure times sliding speed over the radius, at start and end."""
    radius, pv = 1e3 * np.array(answer["radius"]), np.array(answer["pv"])
    name, per = ("MPa m/s", 1e-6) if pv[-1].max() >= 1e4 else ("kPa m/s", 1e-3)
    last = max(pv[-1].max(), 1e-300)
    ax.plot(radius, per * pv[0], color=ORANGE, label="start", lw=1.4)
    ax.plot(radius, per * pv[-1], color=FILM, label="end", lw=1.8)
    # A new edge carries far more than the rest: the end must stay visible.
    top = max(min(pv[0].max(), 8 * last), 1.15 * last) if last > 1e-6 * pv[0].max() else pv[0].max()
    if pv[0].max() > top:
        ax.annotate(f"start: up to {per * pv[0].max():.3g}", (0.5, 0.93), xycoords="axes fraction", fontsize=8,
                    color=ORANGE, ha="center", va="top")  # fmt: skip
    ax.set_ylim(0.0, 1.08 * per * top or None)
    ax.margins(x=0.01)
    ax.set(xlabel="radius, mm", ylabel=name, title="Contact pressure × sliding speed")
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.1)


def _over_time(figure, history, unit, factor):
    """Four panels over the hours."""
    time = factor * np.array(history["time"])
    panels = (
        ("Leakage", *_leakage(history)),
        ("Friction power", "W", ((1.0, "friction_power", BLACK, ""),)),
        ("Contact", "%", ((100.0, "contact_share", CONTACT, "of the closing force"),
                          (100.0, "contact_area_fraction", ORANGE, "of the face touches"))),
        ("Film", "µm", ((1e6, "mean_clearance", FILM, "mean over the face"), (1e6, "h_min", GREY, "thinnest"))),
        ("Worn volume", "mm³", ((1e9, "stator_volume", RING["stator"], "stator"),
                                (1e9, "rotor_volume", RING["rotor"], "rotor"))),
    )  # fmt: skip
    height, first = 0.118, None
    for k, (title, ylabel, curves) in enumerate(panels):
        ax = figure.add_axes((MIDDLE, 0.762 - 0.1718 * k, WIDTH, height), sharex=first)
        first = first or ax
        for per, name, colour, label in curves:
            mark = "." if len(time) <= 80 else ""
            ax.plot(time, per * np.array(history[name]), color=colour, label=label, marker=mark, ms=3)
        if title in ("Leakage", "Friction power"):
            ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
        if title == "Contact" and min(history["contact_share"]) > 0.0 < min(history["contact_area_fraction"]):
            # A few asperities carry the load: far less of the area than of the force.
            ax.set_yscale("log")
        ax.set(ylabel=ylabel, title=title)
        ax.margins(x=0.01)
        if curves[0][3]:
            ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.1)
        if k < len(panels) - 1:
            ax.tick_params(labelbottom=False)
        else:
            ax.set_xlabel(f"time of operation, {unit}")


def _leakage(history):
    """Unit and curve of the leakage."""
    unit, per = ("l/h", 3.6e6) if max(history["leakage"]) > 1e4 / 3.6e9 else ("ml/h", 3.6e9)
    return unit, ((per, "leakage", LEAK, ""),)
