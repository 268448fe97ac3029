"""Stability map: growth rate over two values, the threshold, the scenario itself, and points confirmed in time."""

import numpy as np
from matplotlib.colors import SymLogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...archive import read_study
from .page import heading, look, save, sheet
from .palette import BLACK, PALE, VERMILLION, YELLOW

# Axis values as an engineer reads them.
SHOWN = {"m": (1e6, "µm"), "rad": (1e3, "mrad"), "Pa": (1e-5, "bar"), "Pa*s": (1e3, "mPa s")}
WORDS = {"inertia_ratio": "inertia ratio c = I/J (transverse over polar)", "shaft.speed": "shaft speed"}
COLOURS = "PuOr_r"


def draw(archive_path, out_path):
    """The map of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(11.5, 7.0)
        heading(
            figure,
            "Where does the seal whirl by itself?",
            f"{study['name']}: {study['question']}",
            " ".join(answer["verdict"][:3]),
        )
        ax = figure.add_axes((0.075, 0.145, 0.80, 0.685))
        mesh = _map(ax, answer)
        if mesh is not None:
            bar = figure.colorbar(mesh, cax=figure.add_axes((0.895, 0.145, 0.018, 0.685)))
            bar.set_ticks(_ticks(mesh))
            bar.ax.minorticks_off()
            bar.set_label("growth rate of the least damped tilt mode, 1/s   (− decays, + grows)")
        _marks(ax, answer)
        figure.legend(handles=_handles(answer), loc="lower left", bbox_to_anchor=(0.065, 0.015), ncols=5)
        return save(figure, out_path)


def _map(ax, answer):
    x, y = (answer["axes"][name] for name in "xy")
    at_x, at_y = (_scaled(axis) for axis in (x, y))
    rates = np.array(answer["tilt_growth_rate"], dtype=float)
    every = np.array(answer["growth_rate"], dtype=float)
    ax.set(xlabel=_label(x), ylabel=_label(y), facecolor=PALE)
    ax.grid(False)
    for axis, scale in ((x, ax.set_xscale), (y, ax.set_yscale)):
        values = np.array(axis["values"])
        if len(values) > 2 and np.all(values > 0) and not np.allclose(np.diff(values), values[1] - values[0]):
            scale("log")
    if not np.isfinite(rates).any():
        ax.text(0.5, 0.5, "no possible scene on this map", transform=ax.transAxes, ha="center")
        return None
    ax.patch.set(hatch="///", edgecolor="white")
    largest = float(np.nanmax(np.abs(rates))) or 1.0
    norm = SymLogNorm(linthresh=max(largest / 300, 1e-12), vmin=-largest, vmax=largest)
    mesh = ax.pcolormesh(at_x, at_y, np.ma.masked_invalid(rates), norm=norm, cmap=COLOURS, shading="nearest",
                         rasterized=True)  # fmt: skip
    finite = every[np.isfinite(every)]
    if finite.min() < 0 < finite.max():
        ax.contour(at_x, at_y, np.ma.masked_invalid(every), [0.0], colors=BLACK, linewidths=2.0)
    if _axial_only(answer).any():
        ax.contourf(at_x, at_y, _axial_only(answer).astype(float), [0.5, 1.5], colors="none", hatches=["xx"])
    _say(ax, at_x, at_y, every)
    limit = answer["unconditional"]["limit"]
    for axis, line in ((x, ax.axvline), (y, ax.axhline)):
        if axis["key"] == "inertia_ratio" and limit and min(axis["values"]) < limit < max(axis["values"]):
            line(limit, color=VERMILLION, lw=1.6, ls="--")
    return mesh


def _axial_only(answer):
    """Where the axial motion is unstable and the tilt is not."""
    tilt, every = (np.array(answer[k], dtype=float) for k in ("tilt_growth_rate", "growth_rate"))
    return (every > 0) & (tilt <= 0)


def _ticks(mesh):
    """Zero and whole powers of ten clear of it."""
    top = np.log10(mesh.norm.vmax)
    powers = [10.0**k for k in range(int(np.floor(top)) - 1, int(np.floor(top)) + 1)]
    return [*(-p for p in reversed(powers)), 0.0, *powers]


def _say(ax, x, y, rates):
    """Names the two regions, each at its most inner point."""
    for word, region in (("stable", rates < 0), ("unstable", rates > 0)):
        if np.mean(region) < 0.03:
            continue
        depth = _depth(region)
        j, i = np.unravel_index(int(np.argmax(depth)), depth.shape)
        ax.text(x[i], y[j], word, ha="center", va="center", fontsize=13, weight="bold",
                bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 2})  # fmt: skip


def _depth(region):
    """Steps from each cell of a region to its edge (the map's edge counts), by repeated erosion."""
    inside, depth = np.pad(region, 1), np.zeros(region.shape)
    while inside.any():
        depth += inside[1:-1, 1:-1]
        inside[1:-1, 1:-1] &= inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
        if depth.max() > max(region.shape):
            break
    return depth


def _marks(ax, answer):
    x, y = (answer["axes"][name] for name in "xy")
    if x["here"] is not None and y["here"] is not None:
        inside = all(min(a["values"]) <= a["here"] <= max(a["values"]) for a in (x, y))
        if inside:
            ax.plot(x["here"] * _factor(x), y["here"] * _factor(y), marker="*", ms=15, mfc=YELLOW, mec=BLACK, ls="",
                    clip_on=False, zorder=5)  # fmt: skip
    for point in answer["confirmed"]:
        at = point["x"] * _factor(x), point["y"] * _factor(y)
        if "failed" in point:
            ax.plot(*at, marker="x", color=VERMILLION, ms=8, mew=2, ls="", zorder=5)
        else:
            ax.plot(*at, marker="^" if point["time_domain"] > 0 else "v", ms=8, mfc="white", mec=BLACK, ls="", zorder=5)


def _handles(answer):
    def mark(marker, label, **look):
        return Line2D([], [], ls="", marker=marker, mec=BLACK, mfc="white", label=label, **look)

    handles = [Line2D([], [], color=BLACK, lw=2.0, label="threshold (eigenvalues)")]
    if answer["unconditional"]["limit"] and "inertia_ratio" in [a["key"] for a in answer["axes"].values()]:
        label = f"stable at every speed up to c = 1/ν = {answer['unconditional']['limit']:.4g}"
        handles.append(Line2D([], [], color=VERMILLION, lw=1.6, ls="--", label=label))
    if all(a["here"] is not None for a in answer["axes"].values()):
        handles.append(Line2D([], [], ls="", marker="*", ms=11, mfc=YELLOW, mec=BLACK, label="this scenario"))
    if any("failed" not in p for p in answer["confirmed"]):
        handles.append(mark("^", "grows in the time domain"))
        handles.append(mark("v", "decays in the time domain"))
    if any("failed" in p for p in answer["confirmed"]):
        handles.append(Line2D([], [], ls="", marker="x", color=VERMILLION, mew=2, label="not confirmed"))
    if _axial_only(answer).any():
        handles.append(Patch(facecolor="white", hatch="xx", edgecolor=BLACK, label="axially unstable"))
    if any(v is None for row in answer["growth_rate"] for v in row):
        handles.append(Patch(facecolor=PALE, hatch="///", edgecolor="white", label="no such scene"))
    return handles


def _factor(axis) -> float:
    return SHOWN.get(axis["unit"], (1.0, ""))[0] * _milli(axis)


def _milli(axis) -> float:
    """Radii in mm, films in um."""
    return 1e-3 if axis["unit"] == "m" and max(map(abs, axis["values"])) > 2e-3 else 1.0


def _label(axis) -> str:
    unit = SHOWN.get(axis["unit"], (1.0, axis["unit"].replace("*", " ")))[1]
    if axis["unit"] == "m":
        unit = "mm" if _milli(axis) != 1.0 else "µm"
    words = WORDS.get(axis["key"], axis["key"].replace(".", " ").replace("_", " "))
    return words if axis["unit"] == "1" else f"{words}, {unit}"


def _scaled(axis):
    return np.array(axis["values"]) * _factor(axis)
