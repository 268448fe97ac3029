"""Stability map: growth rate over two values, the threshold, the scenario itself, and points confirmed in time."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import ListedColormap, Normalize, SymLogNorm
from scipy.ndimage import distance_transform_cdt

from ...archive import read_study
from ..text import speed_unit
from .page import absent, look, number, once, save, study_page
from .palette import BLACK, PALE, VERMILLION, YELLOW
from .record import read_in

WORDS = {"inertia_ratio": "inertia ratio c = I/J (transverse over polar)", "shaft.speed": "shaft speed"}
COLOURS = "PuOr_r"
FEW = 6
# Share of the map's width and height that keeps the star clear of the frame.
CLEAR = 0.025


@look()
def draw(archive_path, out_path):
    """The map of a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "Where does the seal whirl by itself?"
    figure, ax = study_page(study, 11.5, 7.0, [["map"]], title, bold=" ".join(answer["verdict"][:3]))
    if np.isfinite(np.array(answer["tilt_growth_rate"], dtype=float)).any():
        shown = [_shown(answer["axes"][name], *speed_unit(study)) for name in "xy"]
        mesh = _map(ax["map"], answer, shown)
        bar = figure.colorbar(mesh, ax=ax["map"], fraction=0.025, pad=0.02, ticks=_ticks(mesh),
                              label="growth rate of the least damped tilt mode, 1/s   (− decays, + grows)")  # fmt: skip
        bar.ax.minorticks_off()
        bar.ax.yaxis.set_major_formatter(lambda rate, _: number(rate))
        _marks(ax["map"], answer, *(factor for factor, _ in shown))
        figure.legend(loc="outside lower left", ncols=5, borderaxespad=1.5)
    else:
        absent(ax["map"], "Growth rate", "no possible scene on this map")
    return save(figure, out_path)


def _map(ax, answer, shown):
    x, y = (answer["axes"][name] for name in "xy")
    (per_x, label_x), (per_y, label_y) = shown
    at_x, at_y = per_x * np.array(x["values"]), per_y * np.array(y["values"])
    rates = np.array(answer["tilt_growth_rate"], dtype=float)
    every = np.array(answer["growth_rate"], dtype=float)
    ax.set(xlabel=label_x, ylabel=label_y, facecolor=PALE)
    ax.grid(False)
    for axis, scale in ((x, ax.set_xscale), (y, ax.set_yscale)):
        values = np.array(axis["values"])
        if len(values) > 2 and np.all(values > 0) and not np.allclose(np.diff(values), values[1] - values[0]):
            scale("log")
            # Plain numbers, as on axes that are not logarithmic.
            (ax.xaxis if axis is x else ax.yaxis).set_major_formatter(lambda value, _: number(value))
    # A few values stand at their cells.
    for values, put in ((at_x, ax.set_xticks), (at_y, ax.set_yticks)):
        if len(values) <= FEW:
            put(values, [number(value, ".4g") for value in values])
    ax.patch.set(hatch="///", edgecolor="white")
    norm, colours = _colours(rates)
    mesh = ax.pcolormesh(at_x, at_y, np.ma.masked_invalid(rates), norm=norm, cmap=colours, shading="nearest",
                         rasterized=True)  # fmt: skip
    if np.nanmin(every) < 0 < np.nanmax(every):
        ax.contour(at_x, at_y, np.ma.masked_invalid(every), [0.0], colors=BLACK, linewidths=2.0)
        ax.plot([], [], color=BLACK, lw=2.0, label="threshold (eigenvalues)")
    # Where the axial motion is unstable and the tilt is not.
    axial = (every > 0) & (rates <= 0)
    if axial.any():
        ax.contourf(at_x, at_y, axial.astype(float), [0.5, 1.5], colors="none", hatches=["xx"])
        ax.fill_between([], [], fc="white", hatch="xx", ec=BLACK, label="axially unstable")
    if np.isnan(every).any():
        ax.fill_between([], [], fc=PALE, hatch="///", ec="white", label="no such scene")
    _say(ax, at_x, at_y, every)
    limit = answer["unconditional"]["limit"]
    for axis, line in ((x, ax.axvline), (y, ax.axhline)):
        if axis["key"] == "inertia_ratio" and limit and min(axis["values"]) < limit < max(axis["values"]):
            label = f"stable at every speed up to c = 1/ν = {limit:.4g}"
            line(limit, color=VERMILLION, lw=1.6, ls="--", label=label)
    return mesh


def _colours(rates):
    """Scale and colours: logarithmic on both sides of zero, or of one side alone, evenly, where no other is there."""
    low, high = float(np.nanmin(rates)), float(np.nanmax(rates))
    largest = max(abs(low), abs(high)) or 1.0
    if low < 0 < high:
        return SymLogNorm(linthresh=max(largest / 300, 1e-12), vmin=-largest, vmax=largest), COLOURS
    half = np.linspace(0.08, 0.5, 256) if high <= 0 else np.linspace(0.5, 0.92, 256)
    room = 1e-3 * largest if high - low < 1e-3 * largest else 0.0
    return Normalize(low - room, high + room), ListedColormap(colormaps[COLOURS](half))


def _ticks(mesh):
    """Zero and whole powers of ten clear of it; of an even scale what suits."""
    if not isinstance(mesh.norm, SymLogNorm):
        return None
    top = np.log10(mesh.norm.vmax)
    powers = [10.0**k for k in range(int(np.floor(top)) - 1, int(np.floor(top)) + 1)]
    return [*(-p for p in reversed(powers)), 0.0, *powers]


def _say(ax, x, y, rates):
    """Names the two regions, each at its most inner point."""
    for word, region in (("stable", rates < 0), ("unstable", rates > 0)):
        if np.mean(region) < 0.03:
            continue
        # Steps from each cell to the edge of its region; the map's edge counts.
        depth = distance_transform_cdt(np.pad(region, 1), "taxicab")[1:-1, 1:-1]
        # Of equally inner ones the one in the middle.
        inner = np.argwhere(depth == depth.max())
        j, i = inner[len(inner) // 2]
        # Inside the map, however near to its edge.
        across = (i + 0.5) / len(x)
        side = "left" if across < 0.06 else "right" if across > 0.94 else "center"
        ax.text(x[i], y[j], word, ha=side, va="center", fontsize=13, weight="bold",
                bbox={"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 2})  # fmt: skip


def _marks(ax, answer, per_x, per_y):
    x, y = (answer["axes"][name] for name in "xy")
    if all(a["here"] is not None and min(a["values"]) <= a["here"] <= max(a["values"]) for a in (x, y)):
        ax.plot(x["here"] * per_x, y["here"] * per_y, "*", ms=15, mfc=YELLOW, mec=BLACK, clip_on=False, zorder=5,
                label="this scenario")  # fmt: skip
        _make_room(ax, x["here"] * per_x, y["here"] * per_y)
    for point in answer["confirmed"]:
        mark, words, edge, width = "X", "not confirmed", VERMILLION, 1.5
        if "failed" not in point:
            edge, width, grows = BLACK, 1.0, point["time_domain"] > 0
            mark, words = ("^", "grows in the time domain") if grows else ("v", "decays in the time domain")
        ax.plot(point["x"] * per_x, point["y"] * per_y, mark, ms=9, mfc="white", mec=edge, mew=width, zorder=5,
                clip_on=False, label=once(ax, words))  # fmt: skip


def _make_room(ax, x, y):
    """White room beyond the map where a star at (x, y) would lie on its frame."""
    for axis, at, span, limit in ((ax.xaxis, x, ax.axvspan, ax.set_xlim), (ax.yaxis, y, ax.axhspan, ax.set_ylim)):
        ends, scale = axis.get_view_interval(), axis.get_transform()
        low, high = scale.transform(ends)
        share = (scale.transform([at])[0] - low) / (high - low)
        for end, edge, free, way in ((0, low, share, -1), (1, high, 1.0 - share, 1)):
            if free < CLEAR:
                beyond = scale.inverted().transform([edge + way * (CLEAR - free) * (high - low)])[0]
                span(*sorted((ends[end], beyond)), color="white", lw=0, zorder=0.5)
                limit(*sorted((ends[1 - end], beyond)))


def _shown(axis, speeds: str, per: float) -> tuple[float, str]:
    """How many of the unit for people make one SI unit, and what stands at the axis; speeds as the scenario has them
    (`speeds`, of which `per` make one rad/s)."""
    unit, factor = read_in(axis["unit"], axis["values"], (speeds, per))
    words = WORDS.get(axis["key"], axis["key"].replace(".", " ").replace("_", " "))
    return factor, f"{words}, {unit}" if unit else words
