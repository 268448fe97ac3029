"""A shaking housing over frequency: the acceleration at which the faces touch, and how much of the motion the gap
takes up; modes, gear mesh and accelerations asked at the side."""

from textwrap import fill

import numpy as np

from ...archive import read_study
from .page import PAPER, decades, logarithmic, look, number, save, stacked, study_page
from .palette import BLACK, GREY, PALE, RING, VERMILLION

GRAVITY = 9.80665
COLOUR, MARK = {"axial": RING["rotor"], "angular": RING["stator"]}, {"axial": "o", "angular": "s"}
# Curves that lie on each other are seen.
WIDTH = {"axial": 3.0, "angular": 1.5}
WORDS = {"axial": "axial, linear theory", "angular": "angular (outer edge of the face),\nlinear theory"}
# Letters of a name beside the figure.
LETTERS = 34
# Amplitudes of the housing (m) drawn as lines, and their names.
AMPLITUDES = {1e-7: "0.1 µm", 1e-6: "1 µm", 1e-5: "10 µm", 1e-4: "0.1 mm", 1e-3: "1 mm", 1e-2: "10 mm"}


@look()
def draw(archive_path, out_path):
    """Touch above, gain below, the legend and what is known beside them, from a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "At which vibration do the faces touch?"
    said = f"{study['name']}: {' '.join(answer['verdict'][:2])}"
    mosaic = [["touch", "key"], ["gain", "numbers"]]
    figure, ax = study_page(study, 11.5, 7.6, mosaic, title, said, height_ratios=(10, 7), width_ratios=(10, 4.4))
    stacked(ax["touch"], ax["gain"])
    frequency = np.array(answer["table"]["frequency"])
    factor, unit = (100.0, "%") if _largest_gain(answer) > 1e-3 else (1e6, "millionths")
    for direction in answer["directions"]:
        _touch(ax["touch"], answer, direction, frequency)
        gain = factor * np.array(answer["table"][f"{direction}_gain"])
        ax["gain"].plot(frequency, gain, lw=WIDTH[direction], color=COLOUR[direction])
    _times(ax, answer, factor)
    _asked(ax["touch"], answer)
    for mode in answer["modes"]:
        if frequency[0] < mode.get("frequency", 0.0) < frequency[-1] and mode["damping_ratio"] < 1.0:
            colour = COLOUR["axial" if mode["kind"] == "axial" else "angular"]
            ax["gain"].axvline(mode["frequency"], color=colour, lw=0.8, ls=":")
    logarithmic(ax["touch"], "y")
    logarithmic(ax["gain"], "x")
    _decades_only(ax["touch"])
    ax["gain"].set(xlim=(frequency[0], frequency[-1]), xlabel="frequency, Hz", ylim=(0.0, None),
                   ylabel=f"gap's motion, {unit} of the housing's")  # fmt: skip
    ax["touch"].set(ylabel="acceleration of the housing at touch, g")
    curves = [line.get_data() for line in ax["touch"].lines if len(line.get_xdata()) > 2]
    curves += [(frequency, np.full(len(frequency), acceleration / GRAVITY)) for acceleration in answer["accelerations"]]
    _lines_of_amplitude(ax["touch"], frequency, curves)
    _key(ax["key"], answer)
    _numbers(ax["numbers"], answer)
    return save(figure, out_path)


def _arm(answer, direction: str) -> float:
    """From the numbers of a direction to g."""
    return (answer["outer_radius"] if direction == "angular" else 1.0) / GRAVITY


def _touch(ax, answer, direction, frequency):
    """The acceleration of touch over frequency, beside the scene's own forcing and without."""
    arm = _arm(answer, direction)
    touch, aligned = (arm * np.array(answer["table"][f"{direction}_touch{part}"]) for part in ("", "_aligned"))
    if np.any(touch > 0.0):
        ax.plot(frequency, np.where(touch > 0.0, touch, np.nan), lw=WIDTH[direction], color=COLOUR[direction])
    if _own_matters(answer):
        ax.plot(frequency, aligned, lw=1.0, ls=(0, (5, 2)), color=COLOUR[direction])


def _largest_gain(answer) -> float:
    """Of all directions."""
    return max((max(answer["table"][f"{d}_gain"]) for d in answer["directions"]), default=1.0)


def _own_matters(answer) -> bool:
    """Whether the scene's own runout and misalignment are seen."""
    table = answer["table"]
    return any(np.any(np.array(table[f"{d}_touch"]) < 0.97 * np.array(table[f"{d}_touch_aligned"]))
               for d in answer["directions"])  # fmt: skip


def _times(ax, answer, factor):
    """Points of the time domain."""
    for row in answer["time_domain"]:
        if "failed" in row:
            continue
        style = {"marker": MARK[row["direction"]], "ms": 5, "mfc": "white", "mec": COLOUR[row["direction"]],
                 "clip_on": False, "zorder": 5, "ls": "none"}  # fmt: skip
        ax["gain"].plot(row["frequency"], factor * row["gain"], **style)
        if row["touch"] is not None:
            ax["touch"].plot(row["frequency"], _arm(answer, row["direction"]) * row["touch"], **style)


def _asked(ax, answer):
    """The accelerations asked, and the gear mesh."""
    for acceleration in answer["accelerations"]:
        ax.axhline(acceleration / GRAVITY, color=VERMILLION, lw=1.0, ls=(0, (2, 2)))
    for at, acceleration in _gear_meshes(answer):
        ax.plot(at, acceleration / GRAVITY, "*", ms=12, color=VERMILLION, mec=BLACK, mew=0.5, clip_on=False, zorder=6)


def _gear_meshes(answer) -> set[tuple[float, float]]:
    """Frequency and acceleration of the gear meshes in the range."""
    low, *_, high = answer["table"]["frequency"]
    found = {(row["frequency"], row["acceleration"]) for row in answer["gear_mesh"]}
    return {(at, acceleration) for at, acceleration in found if low <= at <= high}


def _decades_only(ax):
    """Over many decades numbers at their beginnings alone, large ones as powers of ten."""
    low, high = ax.get_ylim()
    if high > 1e3 * low:
        from matplotlib.ticker import LogLocator

        ax.yaxis.set_major_locator(LogLocator(numticks=9))
        if high >= 1e6:
            decades(ax.yaxis)


def _lines_of_amplitude(ax, frequency, curves):
    """Straight lines of equal amplitude of the housing behind the curves, named where they are farthest from those,
    each (x, y)."""
    low, high = ax.get_ylim()
    for amplitude, words in AMPLITUDES.items():
        line = (2 * np.pi * frequency) ** 2 * amplitude / GRAVITY
        inside = np.nonzero((line > low * (high / low) ** 0.02) & (line < high))[0]
        ax.plot(frequency, line, color=PALE, lw=0.8, zorder=0)
        if len(inside) > len(frequency) // 6:
            # Not at the ends, where the name would leave the panel.
            middle = inside[len(inside) // 8 : -(len(inside) // 8) or None]
            middle = middle[frequency[middle] > frequency[0] * (frequency[-1] / frequency[0]) ** 0.1]
            away = [_away(frequency[k], line[k], curves, frequency[-1] / frequency[0], high / low) for k in middle]
            at = middle[int(np.argmax(away))]
            ax.text(frequency[at], line[at], words, fontsize=7, color=GREY, ha="center", va="center", zorder=0,
                    clip_on=True, bbox=PAPER | {"alpha": 1.0})  # fmt: skip
    ax.set_ylim(low, high)


def _away(x: float, y: float, curves, across: float, up: float) -> float:
    """Least distance of a point to the curves in parts of the panel, both axes logarithmic over these ratios, no more
    than is needed."""
    near = [0.15]
    for curve in curves:
        at, values = (np.asarray(v, dtype=float) for v in curve)
        good = np.isfinite(values) & (values > 0)
        apart = np.hypot(np.log(at[good] / x) / np.log(across), np.log(values[good] / y) / np.log(up))
        near.append(apart.min(initial=np.inf))
    return min(near)


def _key(ax, answer):
    """What the lines are."""
    ax.axis("off")
    for direction in answer["directions"]:
        ax.plot([], [], color=COLOUR[direction], lw=WIDTH[direction], label=WORDS[direction])
        if any(row["direction"] == direction and "failed" not in row for row in answer["time_domain"]):
            ax.plot([], [], ls="none", marker=MARK[direction], mfc="white", mec=COLOUR[direction], ms=5,
                    label=f"{direction}, in time, faces aligned")  # fmt: skip
    if _own_matters(answer):
        ax.plot([], [], color=GREY, lw=1.0, ls=(0, (5, 2)), label="without the scene's own\nrunout and misalignment")
    if answer["accelerations"]:
        asked = ", ".join(number(acceleration / GRAVITY, ".4g") for acceleration in answer["accelerations"])
        words = fill(f"asked: {asked} g", LETTERS)
        ax.plot([], [], color=VERMILLION, lw=1.0, ls=(0, (2, 2)), label=words)
    if _gear_meshes(answer):
        ax.plot([], [], "*", ls="none", ms=12, color=VERMILLION, mec=BLACK, mew=0.5, label="gear mesh, 45 g")
    ax.plot([], [], color=PALE, lw=1.2, label="amplitude of the housing")
    if any("frequency" in mode for mode in answer["modes"]):
        ax.plot([], [], color=GREY, lw=0.8, ls=":", label="natural frequency (below)")
    ax.legend(loc="upper left", borderaxespad=0.0, fontsize=8.5, labelspacing=0.7)


def _numbers(ax, answer):
    """Modes and gear mesh as numbers."""
    ax.axis("off")
    lines = [("Modes on the film", "Hz", "damping ratio")] if answer["modes"] else []
    for mode in answer["modes"][:7]:
        words = mode["kind"] if mode["direction"] in ("none", "axial") else f"{mode['kind']}, {mode['direction']}"
        swings = "frequency" in mode
        lines.append((words, number(mode["frequency"], ".4g") if swings else "–",
                      number(mode["damping_ratio"], ".3g") if swings else "does not swing"))  # fmt: skip
    lines += ([("", "", "")] if lines else []) + [("Gear mesh, linear", "touch, g", "times 45 g")]
    for row in answer["gear_mesh"][:4]:
        lines.append((f"{row['direction']}, {number(row['frequency'], '.4g')} Hz",
                      _digits(row["touch"] / GRAVITY), _digits(row["margin"])))  # fmt: skip
    for k, cells in enumerate(lines):
        bold = "bold" if cells[0] in ("Modes on the film", "Gear mesh, linear") else "normal"
        for x, words, side in zip((0.0, 0.63, 1.0), cells, ("left", "right", "right"), strict=True):
            ax.text(x, 1.0 - 0.078 * k, words, va="top", ha=side, fontsize=8.5, weight=bold, transform=ax.transAxes)


def _digits(value: float) -> str:
    """Four digits, without a power of ten below a million."""
    return number(float(f"{value:.4g}"))
