"""Wear: what has gone from both faces over the hours, contact pressure times speed at start and end, and what leakage,
friction and the contact's share of the load become."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.ticker import NullFormatter

from ...archive import read_study
from .page import PAPER, absent, legend, look, number, save, stacked, study_page
from .palette import BLACK, CONTACT, FILM, GREY, LEAK, ORANGE, RING, THICKNESS

# Profiles drawn of one face; width of a curve on which another one may lie.
LINES, BENEATH = 9, 3.0
# Of the depth computed: what is extrapolated further is told, not drawn.
FAR = 6.0
# Of its thickness: a film that changes by less is a flat line.
STILL = 0.01
GAP = "Shape of the gap, from its narrowest place"


@look()
def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    history, said = answer["history"], answer["end"]["said"]
    if not history["time"]:
        figure, ax = study_page(study, 13.0, 8.6, [["none"]], bold=said)
        absent(ax["none"], "No profile", said)
        return save(figure, out_path)
    if len(history["time"]) == 1:
        # Nothing has a course over the hours.
        figure, ax = study_page(study, 9.0, 5.0, [["gap"]], below=_numbers(history), bold=said)
        _gap(ax["gap"], answer)
        return save(figure, out_path)
    unit, factor = _time_unit(history["time"][-1])
    worn = [face for face in ("stator", "rotor") if np.any(answer["profile"][face])] or ["stator"]
    panels, left = _over_time(history, worn), [[[worn]], ["gap"], ["pressed"]]
    right = [[title] for title in panels]
    limits = " ".join(line for line in answer.get("verdict", []) if line.startswith("Mind"))
    below = f"{study['name']}\n{limits}".strip()
    figure, ax = study_page(study, 13.0, 8.6, [[left, right]], below=below, bold=said, width_ratios=(4, 3))
    _faces(figure, ax, answer, worn, unit, factor)
    _pressed(ax["pressed"], answer)
    stacked(*(ax[title] for title in panels))
    for title, panel in panels.items():
        _history(ax[title], factor * np.array(history["time"]), history, title, *panel)
    ax["Worn volume"].set_xlabel(f"time of operation, {unit}")
    return save(figure, out_path)


def _numbers(history) -> str:
    """Leakage, friction and film of the only instant."""
    leakage, per = _leakage_unit(history)
    return (f"leakage {per * history['leakage'][0]:.4g} {leakage}, friction {history['friction_power'][0]:.4g} W, "
            f"film {1e6 * history['h_min'][0]:.4g} µm where it is thinnest")  # fmt: skip


def _gap(ax, answer):
    """The gap as it is, over the radius."""
    gap = np.array(answer["profile"]["gap"][-1])
    name, per = _length_unit(np.ptp(gap))
    ax.plot(1e3 * np.array(answer["radius"]), per * (gap - gap.min()), color=FILM, lw=1.3)
    ax.margins(x=0.01)
    ax.set(xlabel="radius, mm", ylabel=f"gap, {name}", title=GAP)


def _leakage_unit(history) -> tuple[str, float]:
    return ("l/h", 3.6e6) if max(history["leakage"]) > 1e4 / 3.6e9 else ("ml/h", 3.6e9)


def _time_unit(end) -> tuple[str, float]:
    for unit, seconds in (("h", 3600.0), ("min", 60.0)):
        if end >= seconds:
            return unit, 1.0 / seconds
    return "s", 1.0


def _length_unit(largest) -> tuple[str, float]:
    return ("µm", 1e6) if largest >= 3e-7 else ("nm", 1e9)


def _faces(figure, ax, answer, worn, unit, factor):
    """Worn depth of each face over the radius, coloured by time; below, the gap they leave."""
    time = factor * np.array(answer["history"]["time"])
    radius = 1e3 * np.array(answer["radius"])
    colour, scale = colormaps[THICKNESS].reversed(), Normalize(0.0, time[-1] or 1.0)
    shown = np.unique([int(np.argmin(np.abs(time - t))) for t in np.linspace(0.0, time[-1], LINES)])
    gap = np.array(answer["profile"]["gap"])
    depths = {face: np.array(answer["profile"][face]) for face in worn}
    for face, depth in {**depths, "gap": gap - gap.min(axis=1, keepdims=True)}.items():
        title = GAP if face == "gap" else f"{face.capitalize()}: worn off"
        name, per = _length_unit(depth.max())
        if face in depths and depth.max() == 0.0:
            absent(ax[face], title, "does not wear")
            continue
        for i in shown:
            ax[face].plot(radius, per * depth[i], color=colour(scale(time[i])), lw=1.3)
        if face in depths:
            if answer["extrapolated"]:
                _extrapolated(ax[face], radius, answer["extrapolated"], face, depth.max(), per)
            ax[face].invert_yaxis()
        ax[face].margins(x=0.01)
        ax[face].set(xlabel="radius, mm", ylabel=f"{'depth' if face in depths else 'gap'}, {name}", title=title)
    bar = figure.colorbar(ScalarMappable(scale, colour), ax=[ax[worn[-1]]], fraction=0.04, label=f"time, {unit}")
    bar.outline.set_visible(False)


def _extrapolated(ax, radius, later, face, computed, per):
    """The depth at the asked duration; where it is far beyond what was `computed`, in words alone."""
    unit, factor = _time_unit(later["time"])
    depth = np.array(later[face])
    words = f"extrapolated to {factor * later['time']:.4g} {unit}"
    if depth.max() <= FAR * computed:
        ax.plot(radius, per * depth, color=GREY, lw=1.0, ls=":", label=f"{words}, not computed")
        ax.legend(loc="best")
        return
    name, per = _length_unit(depth.max())
    ax.text(0.5, 0.04, f"{words}: {per * depth.max():.3g} {name}, not computed", transform=ax.transAxes, color=GREY,
            fontsize=8, ha="center", va="bottom", bbox=PAPER)  # fmt: skip


def _pressed(ax, answer):
    """Contact pressure times sliding speed over the radius, at start and end."""
    radius, pv = 1e3 * np.array(answer["radius"]), np.array(answer["pv"])
    name, per = ("MPa m/s", 1e-6) if pv[-1].max() >= 1e4 else ("kPa m/s", 1e-3)
    last = max(pv[-1].max(), 1e-300)
    ax.plot(radius, per * pv[0], color=ORANGE, label="start", lw=BENEATH)
    ax.plot(radius, per * pv[-1], color=FILM, label="end", lw=1.5)
    # A new edge carries far more than the rest: the end must stay visible.
    top = max(min(pv[0].max(), 8 * last), 1.15 * last) if last > 1e-6 * pv[0].max() else pv[0].max()
    if pv[0].max() > top:
        ax.annotate(f"start: up to {per * pv[0].max():.3g}", (0.5, 0.93), xycoords="axes fraction", fontsize=8,
                    color=ORANGE, ha="center", va="top")  # fmt: skip
    ax.set_ylim(0.0, 1.08 * per * top or None)
    ax.margins(x=0.01)
    ax.set(xlabel="radius, mm", ylabel=name, title="Contact pressure × sliding speed")
    legend(ax, "above", ncols=2)


def _over_time(history, worn) -> dict:
    """Unit and curves (factor, column of the history, colour, label) of every panel over the hours; volumes of the
    faces that are `worn`."""
    leakage = _leakage_unit(history)
    return {
        "Leakage": (leakage[0], (leakage[1], "leakage", LEAK, "")),
        "Friction power": ("W", (1.0, "friction_power", BLACK, "")),
        "Contact": ("%", (100.0, "contact_share", CONTACT, "of the absolute closing force"),
                    (100.0, "contact_area_fraction", ORANGE, "of the face touches")),
        "Film": ("µm", (1e6, "mean_clearance", FILM, "mean over the face"), (1e6, "h_min", GREY, "thinnest")),
        "Worn volume": ("mm³", *((1e9, f"{face}_volume", RING[face], face) for face in worn)),
    }  # fmt: skip


def _history(ax, time, history, title, unit, *curves):
    """One panel over the hours."""
    mark = "." if len(time) <= 80 else ""
    for k, (per, name, colour, label) in enumerate(curves):
        below = title in ("Film", "Worn volume") and len(curves) > 1 and not k
        ax.plot(time, per * np.array(history[name]), color=colour, label=label, marker=mark, ms=3,
                lw=BENEATH if below else 1.0)  # fmt: skip
    if title in ("Leakage", "Friction power"):
        # With room above what hardly changes.
        ax.set_ylim(min(0.0, ax.get_ylim()[0]), max(1.12 * ax.dataLim.y1, 0.0) or None)
    if title == "Contact" and min(history["contact_share"]) > 0.0 < min(history["contact_area_fraction"]):
        # A few asperities carry the load: far less of the area than of the force.
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(lambda value, _: number(value))
        ax.yaxis.set_minor_formatter(NullFormatter())
    low, high = ax.dataLim.intervaly
    if title == "Film" and high - low < STILL * high:
        ax.set_ylim((1.0 - 5.0 * STILL) * low, (1.0 + 5.0 * STILL) * high)
    ax.set(ylabel=unit, title=title)
    ax.margins(x=0.01)
    legend(ax, "above", ncols=2)
