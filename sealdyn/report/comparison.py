"""Two runs side by side: what was changed in the scene, and what that changed in the results."""

import math
from collections.abc import Iterator

import numpy as np

from ..answers import dotted
from ..archive import ArchiveError, column, is_study, read_info
from ..quantities import in_words, number, reading_in, shown_in
from .summary import BELOW, is_below, is_radial, tilt_resolved
from .text import speed_unit

# Of the larger value: what differs by less differs by rounding.
ROUNDING = 1e-12
# Of a summary: what tells of the computation and not of the seal.
OWN = ("wall_time", "counts", "archive", "figure", "model.reasons", "warnings")
# Numbers of a summary that are printed (JSON has all): dotted key, quantity, heading.
FIRST = (
    ("h_min.value", "h_min", "h_min"),
    ("h_min.steady", "h_min", "h_min settled"),
    ("relative_misalignment.max", "misalignment", "misalignment max"),
    ("relative_misalignment.steady_max", "misalignment", "misalignment settled"),
    ("leakage.mean", "leakage", "leakage"),
    ("friction.power", "power", "friction"),
    ("film.clearance", "clearance", "clearance"),
    ("film.axial_stiffness", "axial_stiffness", "axial stiffness"),
    ("film.tilt_stiffness", "tilt_stiffness", "tilt stiffness"),
    ("closing.force", "force", "closing force"),
    ("stability.whirl_ratio", "1", "whirl ratio"),
    ("stability.critical_speed", "speed", "critical speed"),
    ("contact_margin", "1", "margin"),
    ("contact.touches", "1", "contacts"),
    ("contact.share_of_closing", "share", "contact, of closing"),
    ("contact.force.mean", "force", "contact force"),
    ("contact.force.max", "force", "contact force max"),
    ("contact.wear_rate", "wear_rate", "wear rate"),
    ("settled.contact_share", "share", "on the shaft"),
    ("whole.largest_gap", "largest_gap", "largest gap"),
    ("settled.load", "force", "load on the shaft"),
    ("settled.friction_torque", "torque", "friction torque"),
    ("settled.leakage_estimate", "leakage", "leakage estimate"),
    ("closed_form.needed_preload", "force", "preload needed of one"),
    ("closed_form.largest_eccentricity", "m", "followed eccentricity"),
    ("contact.lift", "1", "lost contacts"),
)
# How many times as much is told as such.
MANY = 4.0
# Series of which the largest difference is told, and their quantity.
SERIES = {"h_min": "h_min", "relative_misalignment": "misalignment", "largest_gap": "largest_gap", "load": "force"}
# What the accuracy of a run is the error of: films, angles between the faces.
FILMS, TILTS = ("h_min", "h_min.value", "h_min.steady"), "relative_misalignment"
UNRESOLVED, ALIKE = "no change that the accuracy resolves", "  (the same to four digits)"


def comparison(one, other) -> dict:
    """`scene` and `summary`, lists of {key, values: [one, other], change (relative, None of what is no number)} of what
    differs, and `series`, {name, unit, most} with the largest difference (SI) at the instants that both runs have;
    `speeds` the unit in which people read them.  Films and tilts have `resolved`, below what size (SI) the accuracy of
    each run tells nothing.
    **Raises** ArchiveError for what is no archive of a run."""
    infos = [_read(path) for path in (one, other)]
    if is_radial(infos[0]) != is_radial(infos[1]):
        kinds = ["a radial seal" if is_radial(info) else "a face seal" for info in infos]
        raise ArchiveError(f"{other}: the archive of {kinds[1]}; expected that of {kinds[0]}, as {one}")
    scenes, summaries = ([dict(dotted(info[key])) for info in infos] for key in ("resolved", "summary"))
    return {
        "names": [str(one), str(other)],
        "status": [str(info["status"]) for info in infos],
        "speeds": speed_unit(infos[1])[0],
        "scene": _different(*scenes),
        "summary": [
            {**row, **_resolution(row["key"], infos)}
            for row in _different(*summaries)
            if not row["key"].startswith(OWN)
        ],
        "series": [{**row, **_resolution(row["name"], infos)} for row in _series(one, other, infos)],
    }


def comparison_lines(found: dict, told=lambda key, value: _word(value)) -> list[str]:
    """The same for people; `told(key, value)` the words of a number (SI) at a dotted key of a scene."""
    out = [f"A  {found['names'][0]}: {found['status'][0]}", f"B  {found['names'][1]}: {found['status'][1]}"]
    for row in found["scene"]:
        words = (told(row["key"], value) if _is_number(value) else _word(value) for value in row["values"])
        out.append(f"  scene         {row['key']}: {' -> '.join(words)}")
    out += [] if found["scene"] else ["  scene         the same"]
    rows = {row["key"]: row for row in found["summary"]}
    printed = [(heading, quantity, rows[key]) for key, quantity, heading in FIRST if key in rows]
    for heading, quantity, row in printed:
        # One unit on both sides.
        with reading_in({"rad/s": found.get("speeds", "rad/s")}):
            unit, factor = shown_in(quantity, row["values"])
        words = [
            BELOW + number(near, factor, 3) if is_below(value, near) else number(value, factor)
            for value, near in zip(row["values"], _nears(row), strict=True)
        ]
        alike = words[0] == words[1] and not words[0].startswith(BELOW)
        heading = ", ".join(filter(None, (heading, unit)))
        out.append(f"  {heading:<28}{' -> '.join(words)}{ALIKE if alike else _change_of(row)}")
    if not printed:
        out.append("  results       the same")
    for row in found["series"]:
        quantity = SERIES[row["name"]]
        most = f"differs by up to {in_words(quantity, row['most'], digits=3)}"
        if 0.0 < row["most"] <= sum(_nears(row)):
            most = f"has {UNRESOLVED} ({in_words(quantity, sum(_nears(row)), digits=3)})"
        out.append(f"  at the same instants {row['name']} {most}")
    return out


def _resolution(key, infos) -> dict:
    """`resolved` (SI) of a film or a tilt at this key, in each run."""
    summaries = [info["summary"] for info in infos]
    if key in FILMS:
        return {"resolved": [summary["accuracy"] * summary["film"]["clearance"] for summary in summaries]}
    if key.startswith(TILTS) and not key.endswith("_said"):
        return {"resolved": [tilt_resolved(summary) for summary in summaries]}
    return {}


def _nears(row) -> list[float]:
    """The same of a row, 0 of what the accuracy is no error of."""
    return row.get("resolved", [0.0, 0.0])


def _change_of(row) -> str:
    """What has become of a number, in words."""
    one, other = row["values"]
    if None not in (one, other) and abs(other - one) <= sum(_nears(row)):
        return f"  ({UNRESOLVED})"
    return _change_words(row["change"])


def _read(path) -> dict:
    if is_study(path):
        raise ArchiveError(f"{path}: the archive of a study; expected that of a run")
    info = read_info(path)
    if not info["summary"]:
        raise ArchiveError(f"{path}: the run is not complete ({info['status']})")
    return info


def _different(one: dict, other: dict) -> list[dict]:
    keys = [*one, *(key for key in other if key not in one)]
    pairs = ((key, one.get(key), other.get(key)) for key in keys)
    return [{"key": key, "values": [a, b], "change": _change(a, b)} for key, a, b in pairs if _differ(a, b)]


def _differ(a, b) -> bool:
    if _is_number(a) and _is_number(b):
        return abs(a - b) > ROUNDING * max(abs(a), abs(b))
    return a != b


def _change(a, b) -> float | None:
    return b / a - 1.0 if _is_number(a) and _is_number(b) and a else None


def _change_words(change) -> str:
    """A relative change in words: per cent mean little of what is several times as much, or has turned round."""
    if change is None:
        return ""
    times = 1.0 + change
    if times <= 0.0:
        return "  (changes its sign)" if times else "  (to nothing)"
    if 1.0 / MANY < times < MANY:
        return f"  ({'+' if change >= 0 else ''}{in_words('share', change, digits=3)})"
    return f"  ({times:.3g} times as much)" if times > 1.0 else f"  (a {1.0 / times:.3g}th)"


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _word(value) -> str:
    return f"{value:.6g}" if _is_number(value) else "not given" if value is None else str(value)[:60]


def _series(one, other, infos) -> Iterator[dict]:
    """The largest differences of SERIES at common instants."""
    times = [column(path, "time") for path in (one, other)]
    _, rows, others = np.intersect1d(*times, return_indices=True)
    if len(rows) < 2:
        return
    for name in SERIES:
        if all(name in info["series"] for info in infos):
            apart = np.abs(column(one, name)[rows] - column(other, name)[others])
            yield {"name": name, "unit": infos[0]["series"][name].units, "most": float(np.nanmax(apart))}
