"""Two runs side by side: what was changed in the scene, and what that changed in the results."""

import math
from collections.abc import Iterator

import numpy as np

from ..archive import ArchiveError, column, is_study, read_info
from .radial import is_radial
from .text import BELOW, if_resolved, speed_unit, tilt_resolved

# Of the larger value: what differs by less differs by rounding.
ROUNDING = 1e-12
# Of a summary: what tells of the computation and not of the seal.
OWN = ("wall_time", "counts", "archive", "figure", "model.reasons", "warnings")
# Quantities that are printed (JSON has all): key, heading, factor.
FIRST = (
    ("h_min.value", "h_min, um", 1e6),
    ("h_min.steady", "h_min settled, um", 1e6),
    ("relative_misalignment.max", "misalignment max, urad", 1e6),
    ("relative_misalignment.steady_max", "misalignment settled, urad", 1e6),
    ("leakage.mean", "leakage, ml/h", 3.6e9),
    ("friction.power", "friction, W", 1.0),
    ("film.clearance", "clearance, um", 1e6),
    ("film.axial_stiffness", "axial stiffness, N/m", 1.0),
    ("film.tilt_stiffness", "tilt stiffness, N m/rad", 1.0),
    ("closing.force", "closing force, N", 1.0),
    ("stability.whirl_ratio", "whirl ratio", 1.0),
    ("stability.critical_speed", "critical speed, rad/s", 1.0),
    ("contact_margin", "margin to contact", 1.0),
    ("contact.touches", "contacts", 1.0),
    ("contact.share_of_closing", "contact, % of closing", 100.0),
    ("contact.force.mean", "contact force, N", 1.0),
    ("contact.force.max", "contact force max, N", 1.0),
    ("contact.wear_rate", "wear rate, um/h", 3.6e9),
    ("settled.contact_share", "on the shaft, %", 100.0),
    ("whole.largest_gap", "largest gap, um", 1e6),
    ("settled.load", "load on the shaft, N", 1.0),
    ("settled.friction_torque", "friction torque, N m", 1.0),
    ("settled.leakage_estimate", "leakage estimate, ml/h", 3.6e9),
    ("closed_form.needed_preload", "preload needed of one, N", 1.0),
    ("closed_form.largest_eccentricity", "followed eccentricity, mm", 1e3),
    ("contact.lift", "lost contacts", 1.0),
)
# How many times as much is told as such.
MANY = 4.0
# Leakage (m^3/s) from which it is told in l/min, as that of gases; a speed where people wrote it so.
MUCH, IN_LITRES, IN_RPM = 1e-5, ("leakage, l/min", 6e4), ("critical speed, rpm", 30.0 / math.pi)
# Series of which the largest difference is told: of face seals, of radial seals; the unit people read them in.
SERIES = {"h_min": ("um", 1e6), "relative_misalignment": ("urad", 1e6), "largest_gap": ("um", 1e6), "load": ("N", 1.0)}
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
    scenes, summaries = ([dict(_leaves(info[key])) for info in infos] for key in ("resolved", "summary"))
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
    out += [
        f"  scene         {row['key']}: "
        + " -> ".join(told(row["key"], value) if _is_number(value) else _word(value) for value in row["values"])
        for row in found["scene"]
    ]
    out += [] if found["scene"] else ["  scene         the same"]
    rows = {row["key"]: row for row in found["summary"]}
    shown = [(heading, factor, rows[key]) for key, heading, factor in FIRST if key in rows]
    for heading, factor, row in shown:
        if row["key"] == "stability.critical_speed" and found.get("speeds") == "rpm":
            heading, factor = IN_RPM
        if row["key"] == "leakage.mean" and max(abs(value or 0.0) for value in row["values"]) >= MUCH:
            heading, factor = IN_LITRES
        words = [if_resolved(value, factor, near) for value, near in zip(row["values"], _nears(row), strict=True)]
        alike = words[0] == words[1] and not words[0].startswith(BELOW)
        out.append(f"  {heading:<28}{' -> '.join(words)}{ALIKE if alike else _change_of(row)}")
    if not shown:
        out.append("  results       the same")
    for row in found["series"]:
        unit, factor = SERIES.get(row["name"], (row["unit"], 1.0))
        most = f"differs by up to {factor * row['most']:.3g} {unit}"
        if 0.0 < row["most"] <= sum(_nears(row)):
            most = f"has {UNRESOLVED} ({factor * sum(_nears(row)):.3g} {unit})"
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


def _leaves(tree, name="") -> Iterator[tuple[str, object]]:
    """Dotted keys and values."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from _leaves(value, f"{name}.{key}" if name else key)
    else:
        yield name, tree


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
        return f"  ({100 * change:+.3g} %)"
    return f"  ({times:.3g} times as much)" if times > 1.0 else f"  (a {1.0 / times:.3g}th)"


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _word(value) -> str:
    return f"{value:.6g}" if _is_number(value) else "not given" if value is None else str(value)[:60]


def _series(one, other, infos) -> Iterator[dict]:
    """The largest differences of SERIES at common instants."""
    times = [column(path, "time") for path in (one, other)]
    _, rows, others = np.intersect1d(*times, assume_unique=False, return_indices=True)
    if len(rows) < 2:
        return
    for name in SERIES:
        if all(name in info["series"] for info in infos):
            apart = np.abs(column(one, name)[rows] - column(other, name)[others])
            yield {"name": name, "unit": infos[0]["series"][name].units, "most": float(np.nanmax(apart))}
