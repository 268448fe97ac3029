"""Contact onset: film and tilt of the periodic orbit as the forcing grows, linear and nonlinear onset, curve."""

import re

import numpy as np

from ...archive import read_study
from ..text import speed_unit
from .page import PAPER, absent, logarithmic, look, number, printed, save, study_page, upright
from .palette import BLUE, CONTACT, FILM, GREY, PALE, PURPLE, THEORY, TILT
from .record import read_in

# Onsets further apart than this are seen on a logarithmic axis only.
APART = 20.0
# A number and its unit.
WRITTEN = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S.*?)?\s*")


@look()
def draw(archive_path, out_path):
    """The film over the forcing, how the seal lifts, and the onset over another key: panels of what is there."""
    study = read_study(archive_path)
    answer, title = study["answer"], "When do the faces first touch?"
    bold = " ".join(answer["verdict"]) if "failed" in answer else answer["verdict"][0]
    # What linear theory says stands where nothing was followed, too.
    known = answer.get("path") or answer.get("linear") or (answer["formula"] and answer.get("clearance"))
    # Faces that touch without any forcing have no onset: what carries them stands in its place.
    rests = answer["nonlinear"] == 0.0 and answer.get("closing_force")
    lifts = np.any((answer.get("path") or {}).get("axial", 0.0))
    panels = {_rest: rests, _film: known, _opening: lifts, _curve: answer["curve"]}
    panels = {draws.__name__: draws for draws, there in panels.items() if there}
    mosaic, size = [list(panels) or ["nothing"]], (12, 5.2) if len(panels) > 1 else (8.5, 5.2)
    if list(panels) in ([], ["_rest"]):
        size = 8.5, 3.0
    figure, ax = study_page(study, *size, mosaic, title, bold=bold)
    # Archives of earlier versions do not hold the key's unit.
    speeds = speed_unit(study)
    unit = _unit(study, speeds)
    for name, draws in panels.items():
        draws(ax[name], answer, *unit, speeds)
    if not panels:
        absent(ax["nothing"], "Smallest film thickness", _why(answer))
    return save(figure, out_path)


def _unit(study, speeds) -> tuple[str, float]:
    """What the key is read in and how many of it make one of its SI unit; a tilt as the verdict has its onset, or as it
    was written where no orbit was followed."""
    answer = study["answer"]
    unit = (answer.get("units") or {}).get("forcing", "rad")
    if unit != "rad":
        return read_in(unit, [], speeds)
    key = re.escape(answer["key"].split(".")[-1])
    # What the command line says stands in place of the scenario's.
    overrides = [words for words in map(str, study.get("overrides") or []) if words.startswith(answer["key"])]
    words = overrides[-1] if overrides else study["scenario"]
    fine = re.search(rf"\b{key}\s*=[^#\n]*\burad\b", words) if not answer.get("path") else None
    return ("µrad", 1e6) if fine or 0 < (answer["nonlinear"] or answer["formula"] or 1.0) < 1e-3 else ("mrad", 1e3)


def _why(answer):
    """Why no orbit is drawn."""
    return "touching when aligned" if answer["nonlinear"] == 0.0 else answer.get("failed") or "no orbit followed"


def _rest(ax, answer, *_):
    """Of faces that touch at rest: the film there, and what the asperities carry of the closing force."""
    film, touch, force, closing = (answer[name] for name in ("clearance", "touch", "contact_force", "closing_force"))
    said = f"film {1e6 * film:.3g} µm\nof {1e6 * touch:.3g} µm, where asperities meet"
    carried = f"asperities carry {force:.4g} N\nof the closing force {closing:.4g} N"
    rows = (said, film / touch, FILM), (carried, force / closing, CONTACT)
    for at, (_, share, colour) in enumerate(rows):
        ax.barh(at, 100 * share, 0.5, color=colour)
        ax.text(100 * share, at, f" {100 * share:.3g} %", va="center", color=colour)
    ax.set_yticks(range(len(rows)), [words for words, *_ in rows])
    ax.set(title="At rest, nothing out of square", xlabel="%", xlim=(0, 115), ylim=(len(rows) - 0.5, -0.5))
    ax.grid(False, axis="y")


def _path(answer, name, per):
    """Forcing (`per` of its unit in one SI unit) and a column of the path, in the order of the forcing, from where
    nothing forces."""
    forcing = np.array(answer["path"]["forcing"])
    order = np.argsort(forcing)
    start = answer["clearance"] if name == "h_min" else 0
    return np.r_[0, per * forcing[order]], np.r_[start, np.array(answer["path"][name])[order]]


def _film(ax, answer, unit, per, _):
    if answer.get("path"):
        forcing, h_min = _path(answer, "h_min", per)
        ax.plot(forcing, 1e6 * h_min, "o-", color=FILM, ms=3.5, label="nonlinear orbit")
    touch, linear = 1e6 * (answer.get("touch") or 0.0), answer.get("linear")
    if linear:
        forcing, h_min = per * np.array(linear["forcing"]), 1e6 * np.array(linear["h_min"])
    else:
        share = np.r_[0.0, np.geomspace(1e-6, 1.0, 241)]
        forcing, h_min = per * answer["formula"] * share, 1e6 * answer["clearance"] * (1.0 - share) + touch * share
    ax.plot(forcing, h_min, "--", color=THEORY, label="linear theory")
    ax.axhline(touch, color=CONTACT, lw=1.2, label="asperities meet" if touch else "touch")
    own = linear["own"] if linear else answer.get("times_own") and answer["formula"] / answer["times_own"]
    far = not linear and not answer.get("path") and _far(ax, answer, own, per)
    if own:
        words = "the scenario's own" + (f", {number(per * own, '.4g')} {unit}" if far else "")
        upright(ax, per * own, words, BLUE, height=0.4, ls=":")
    ax.set(title="Smallest film thickness", xlabel=f"{answer['key']}, {unit}", ylabel="h_min, µm")
    # Beside the curves where they fall, above them where they do not.
    ax.set_ylim(top=1.3 * ax.get_ylim()[1])
    ax.legend(loc="upper right")


def _far(ax, answer, own: float | None, per: float) -> bool:
    """Whether linear theory sees touch so far beyond the scene's `own` that both are seen on a logarithmic axis only,
    which the panel then has, with what is no small tilt on it."""
    onset, beyond = answer["formula"], answer.get("beyond_tilt")
    first = own or (1e-3 * beyond if beyond else onset)
    if onset <= APART * first:
        return False
    ax.set(xscale="log", xlim=(0.3 * per * first, 2.0 * per * onset))
    if beyond:
        ax.axvspan(per * beyond, 2.0 * per * onset, color=PALE, alpha=0.5, lw=0, zorder=0.5)
        words = f" no small tilt: beyond {beyond:g} rad"
        ax.text(per * beyond, 0.1, words, transform=ax.get_xaxis_transform(), color=GREY, fontsize=8, bbox=PAPER)
    return True


def _opening(ax, answer, unit, per, _):
    forcing, axial = _path(answer, "axial", per)
    ax.plot(forcing, 100 * axial / answer["clearance"], "o-", color=BLUE, ms=3.5)
    upright(ax, per * answer["formula"], "linear onset", THEORY, height=0.93, ha="right", ls="--")
    if answer["nonlinear"] is not None:
        upright(ax, per * answer["nonlinear"], "onset", CONTACT, ha="right")
    ax.set(
        title="The seal lifts: axial opening", xlabel=f"{answer['key']}, {unit}", ylabel="opening, % of the clearance"
    )


def _curve(ax, answer, unit, per, speeds):
    rows = answer["curve"]
    at, name = _asked([row["value"] for row in rows], (answer.get("units") or {}).get("value", "SI"), speeds)
    words = at is None
    at = list(range(len(rows))) if words else at
    floored = [row.get("floored", {}) for row in rows]
    # Where an onset was not found the curve has a gap, and a cross on the axis.
    for found, column, style in (
        (rows, "nonlinear", {"color": TILT, "marker": "o", "ms": 4.5, "label": "nonlinear"}),
        (floored, "nonlinear", {"color": PURPLE, "marker": "s", "mfc": "white", "label": "pressure floored"}),
        (rows, "formula", {"color": THEORY, "ls": "--", "marker": ".", "label": "linear theory"}),
    ):
        if any(found):
            ax.plot(at, per * np.array([row.get(column) for row in found], dtype=float), **style)
    missing = [x for x, *pair in zip(at, rows, floored, strict=True) if any("failed" in row for row in pair)]
    if missing:
        ax.plot(missing, [0.0] * len(missing), "x", color=CONTACT, clip_on=False, label="an onset was not found",
                transform=ax.get_xaxis_transform())  # fmt: skip
    if words:
        ax.set_xticks(at, [str(row["value"]) for row in rows])
    seen = [row[name] for row in [*rows, *floored] for name in ("nonlinear", "formula") if row.get(name)]
    low, high = per * min(seen, default=0.0), per * max(seen, default=1.0)
    if low > 0 and high > APART * low:
        logarithmic(ax, "y")
        ax.set_ylim(0.6 * low, high * (high / low) ** 0.45)
    else:
        ax.set_ylim(0, 1.45 * ax.get_ylim()[1])
    ax.set(title=f"Onset over {answer['over']}", xlabel=", ".join(filter(None, (answer["over"], name))),
           ylabel=f"{answer['key']} at touch, {unit}")  # fmt: skip
    ax.legend(loc="upper right")


def _asked(values, si: str, speeds) -> tuple[list[float] | None, str]:
    """Where values lie and in which unit, as they were asked: numbers in SI (`si` their unit, "SI" of pure numbers), or
    written with one unit.  None for words, and for values in several units."""
    written = [WRITTEN.fullmatch(value) if isinstance(value, str) else None for value in values]
    if all(written) and len({found[2] for found in written}) == 1:
        return [float(found[1]) for found in written], printed(written[0][2] or "")
    if any(isinstance(value, str) for value in values):
        return None, ""
    name, factor = ("", 1.0) if si == "SI" else read_in(si, values, speeds)
    return [factor * value for value in values], name
