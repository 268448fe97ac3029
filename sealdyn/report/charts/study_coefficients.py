"""Film stiffness and damping over speed, clearance and tilt, the matrices themselves, and the map over speed, frequency
and coning if there is one."""

import numpy as np

from ...archive import read_study
from ..text import question_of, speed_unit
from .page import logarithmic, look, number, right_axis, save, shortened, stacked, study_page
from .palette import BLACK, BLUE, CYCLE, GREEN, GREY, ORANGE, PURPLE, VERMILLION
from .record import fitting

DASHED = (0, (4, 3))
# In plain letters: with mathematical ones matplotlib asks for fonts that some machines do not list.
TILT = (("Kxx", 1, 1, BLUE, "-"), ("Kyy", 2, 2, GREEN, DASHED), ("Kxy", 1, 2, VERMILLION, "-"),
        ("Kyx", 2, 1, ORANGE, DASHED))  # fmt: skip
# Of the largest of its panel: a curve that is nowhere more cannot be told from zero, and what is rounding.
UNSEEN, NOTHING = 0.01, 1e-9
NAMES = ("z", "x", "y")
SWEEPS = {"speed": ("Over speed", 1.0, "shaft speed"), "clearance": ("Over clearance", 1e6, "clearance, µm"),
          "tilt": ("Over tilt (axially balanced)", 1e6, "relative tilt about x, µrad")}  # fmt: skip
# Axes of the map, the one with the most to show first: factor, label, and how a line is named.
AXES = {"coning": (1e3, "coning, mrad", "{:.4g} mrad"), "frequency": (1 / (2 * np.pi), "frequency, Hz", "{:.4g} Hz"),
        "speed": (60 / (2 * np.pi), "shaft speed, rpm", "{:.5g} rpm")}  # fmt: skip
MOST_LINES = 6
# Large stiffnesses (N m/rad) in units with fewer digits.
LARGE = ((1e7, 1e-6, "MN m/rad"), (1e4, 1e-3, "kN m/rad"), (0.0, 1.0, "N m/rad"))
# Large axial stiffnesses (N/m) and tilt dampings (N m s/rad) alike.
AXIAL = ((1e11, 1e-9, "kN/µm"), (0.0, 1e-6, "N/µm"))
DAMPING = ((1e6, 1e-6, "MN m s/rad"), (1e4, 1e-3, "kN m s/rad"), (0.0, 1.0, "N m s/rad"))
# Panels of the map: title, matrix, place in it, and units.
MAP = {"map axial": ("Axial K", "stiffness", (0, 0), AXIAL), "map tilt": ("Tilt K", "stiffness", (1, 1), LARGE),
       "map cross": ("Cross K", "stiffness", (1, 2), LARGE),
       "map damping": ("Tilt D", "damping", (1, 1), DAMPING)}  # fmt: skip
FREQUENCY = {"frequency": ("Over frequency", 1 / (2 * np.pi), "frequency of the motion, Hz")}


@look()
def draw(archive_path, out_path):
    """Three panels of stiffness above three of damping, and two matrices, from a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "How stiff is the film, and how does it damp?"
    shown = SWEEPS | (FREQUENCY if "against_frequency" in answer else {})
    sweeps = [answer[f"against_{name}"] for name in shown]
    damps = any(np.nan_to_num(_entries(s, "damping", i, i)).any() for s in sweeps for i in (1, 2))
    tilts = [curve for curve in TILT if _seen(sweeps, *curve[1:3])]
    rows, matrices = [[f"{matrix} {name}" for name in shown] for matrix in "KD"], [["aligned", "tilted"]]
    mosaic, heights = [[rows], [matrices]], (9, 4)
    maps = [name for name in MAP if "map" in answer and (name == "map axial" or _any(answer["map"], name))]
    if maps:
        mosaic, heights = [*mosaic, [[[*maps, *_clearance(answer["map"]), "map key"]]]], (9, 4, 5)
    speeds, rpm = speed_unit(study)
    at = f"{number(rpm * answer['at']['speed'], '.5g')} {speeds}"
    per, unit = _unit_of(sweeps, "stiffness", [(i, j) for _, i, j, *_ in TILT], LARGE)
    words = [": ".join(filter(None, (study["name"], question_of(study["question"]))))]
    words += [_held(study, at), _left_out(sweeps, tilts, damps)]
    figure, ax = study_page(study, 11.5, 2.6 + 0.415 * sum(heights), mosaic, title, "\n".join(words),
                            height_ratios=heights)  # fmt: skip
    units = [_unit_of(sweeps, "damping", ((1, 1), (2, 2)), DAMPING), _unit_of(sweeps, "stiffness", ((0, 0),), AXIAL)]
    for name, (words, scale, label) in shown.items():
        sweep, above, below = answer[f"against_{name}"], ax[f"K {name}"], ax[f"D {name}"]
        stacked(above, below)
        scale, label = (rpm, f"{label}, {speeds}") if name == "speed" else (scale, label)
        x = scale * np.array(sweep[name])
        _stiffness(above, sweep, x, words, per, tilts)
        beside = below
        if damps:
            _damping(below, sweep, x, name, units[0][0])
            beside = right_axis(below, "", GREY)
        _axial(beside, sweep, x, units[1][0])
        if name == (list(shown)[-1] if damps else "speed"):
            beside.set_ylabel(f"axial stiffness, {units[1][1]}", color=GREY)
        below.set(xlim=(x[0], x[-1]), xlabel=label)
        if name == "clearance":
            logarithmic(below, "x")
        else:
            below.locator_params(axis="x", nbins=6 if len(shown) < 4 else 4)
    ax["K speed"].set_ylabel(f"tilt stiffness, {unit}")
    # Beside the page's title: no curve and no panel's title is below it.
    corner = 1 - 0.2 / figure.get_size_inches()[0], 1 - 0.26 / figure.get_size_inches()[1]
    ax["K speed"].legend(loc="center right", bbox_to_anchor=corner, bbox_transform=figure.transFigure, ncols=4,
                         borderaxespad=0.0)  # fmt: skip
    ax["K speed"].get_legend().set_in_layout(False)
    if damps:
        ax["D speed"].set_ylabel(f"tilt damping, {units[0][1]}\n(xx solid, yy dashed)", color=PURPLE)
    _matrix(ax["aligned"], answer, answer["at"], "Aligned", at)
    _matrix(ax["tilted"], answer["tilted"], answer["tilted"]["at"], "Tilted: " + answer["tilted"]["said"], at)
    if maps:
        _map(ax, answer["map"])
    return save(figure, out_path)


def _held(study, at: str) -> str:
    """At which clearance the film is followed over everything else; `at` the speed in words."""
    answer, given = study["answer"], (study["resolved"].get("film") or {}).get("clearance")
    held = "the scenario's" if given else f"the balance at {at}"
    over = "speed and frequency" if "against_frequency" in answer else "speed"
    words = f"Clearance over {over}: held at {1e6 * answer['at']['clearance']:.4g} µm, {held}"
    words += "; over tilt: the faces open until they balance"
    follows = "map" in answer and _clearance(answer["map"])
    return words + ("; in the map: follows the closing force." if follows else ".")


def _left_out(sweeps, tilts, damps: bool) -> str:
    """What is not drawn, since it cannot be told from zero."""
    sizes = {name: _largest(sweeps, i, j) for name, i, j, *_ in TILT}
    small = [name for name in sizes if name not in [drawn for drawn, *_ in tilts]]
    zero = [name for name in small if sizes[name] <= NOTHING * max(sizes.values())]
    small = [name for name in small if name not in zero]
    zero += [] if damps else ["tilt damping"]
    said = [f"zero: {', '.join(zero)}"] if zero else []
    if small:
        size = max(sizes[name] for name in small)
        per, unit = _fitting(size, LARGE)
        said += [f"under 1 % of the others: {', '.join(small)} (at most {per * size:.3g} {unit})"]
    return f"Not drawn, {'; '.join(said)}." if said else ""


def _largest(sweeps, i: int, j: int) -> float:
    return max(np.nanmax(np.abs(_entries(sweep, "stiffness", i, j)), initial=0.0) for sweep in sweeps)


def _seen(sweeps, i: int, j: int) -> bool:
    """Whether a tilt stiffness is more than nothing beside the others in any panel, or all are nothing."""
    every = [[_largest([sweep], *curve[1:3]) for curve in TILT] for sweep in sweeps]
    return not np.any(every) or any(_largest([s], i, j) > UNSEEN * max(e) for s, e in zip(sweeps, every, strict=True))


def _any(found, panel: str) -> bool:
    """Whether a panel of the map shows more than zero and rounding."""
    _, name, (i, j), _ = MAP[panel]
    values = np.abs(np.array(found[name], dtype=float))
    return np.nanmax(values[..., i, j], initial=0.0) > NOTHING * np.nanmax(values[..., 1:, 1:], initial=0.0)


def _clearance(found) -> list[str]:
    """The panel of the clearance, where it is not everywhere the same."""
    known = np.array(found["clearance"], dtype=float)
    known = known[np.isfinite(known)]
    return ["map clearance"] if len(known) and np.ptp(known) > 1e-6 * known.max() else []


def _map(ax, found):
    """The map over its longest axis but for the coning, which goes before; a line for each of some of the others."""
    axes = [name for name in ("speed", "frequency", "coning") if name in found]
    along = next((name for name in AXES if len(found.get(name, ())) > 1), "speed")
    others = [name for name in axes if name != along]
    factor, label, _ = AXES[along]
    places = list(np.ndindex(*(len(found[name]) for name in others)))
    shown = sorted({round(k) for k in np.linspace(0, len(places) - 1, MOST_LINES)})
    for nth, (colour, place) in enumerate(zip(CYCLE, [places[k] for k in shown], strict=False)):
        # Lines that lie on each other are seen.
        style = {"color": colour, "lw": 3.6 - 0.5 * nth, "ms": 3}
        at = dict(zip(others, place, strict=True))
        index = tuple(at.get(name, slice(None)) for name in axes)
        words = ", ".join(AXES[n][2].format(AXES[n][0] * found[n][k]) for n, k in at.items() if len(found[n]) > 1)
        mark = "-o" if len(found[along]) < 3 else "-"
        for panel, (title, name, entry, units) in ((panel, MAP[panel]) for panel in MAP if panel in ax):
            values = np.array(found[name], dtype=float)[(..., *entry)]
            per, unit = _fitting(np.nanmax(np.abs(values), initial=0.0), units)
            ax[panel].plot(factor * np.array(found[along]), per * values[index], mark, **style)
            ax[panel].set(title=f"{title}, {unit}", xlabel=label)
        ax["map key"].plot([], [], **style, label=words or "scene's speed,\nslow motion")
        if "map clearance" not in ax:
            continue
        clearance = 1e6 * np.array(found["clearance"], dtype=float)[index]
        ax["map clearance"].plot(factor * np.array(found[along]), clearance, mark, **style)
        ax["map clearance"].set(title="Clearance, µm", xlabel=label)
    ax["map key"].axis("off")
    ax["map key"].legend(loc="upper left", borderaxespad=0.0)


def _entries(sweep, name, i, j):
    return np.array([np.nan if m is None else m[i][j] for m in sweep[name]], dtype=float)


def _fitting(largest: float, units) -> tuple[float, str]:
    """How many of the unit of such a number make one in SI, and its name, of `units` with the least number of each."""
    return next((per, name) for least, per, name in units if largest >= least)


def _unit_of(sweeps, matrix: str, places, units) -> tuple[float, str]:
    """The same of the elements of a matrix at some places (i, j)."""
    every = [np.abs(_entries(sweep, matrix, *place)) for sweep in sweeps for place in places]
    return _fitting(np.nanmax(np.concatenate([*every, [0.0]])), units)


def _stiffness(ax, sweep, x, title, per, tilts):
    for label, i, j, colour, dashes in tilts:
        ax.plot(x, per * _entries(sweep, "stiffness", i, j), color=colour, ls=dashes, lw=1.7, label=label)
    ax.axhline(0.0, color=BLACK, lw=0.8)
    ax.set_title(title)


def _damping(ax, sweep, x, name, per):
    """Tilt damping, `per` of its unit in one SI unit."""
    shown = [per * _entries(sweep, "damping", i, i) for i in (1, 2)]
    for values, dashes in zip(shown, ("-", DASHED), strict=True):
        ax.plot(x, values, color=PURPLE, lw=1.7, ls=dashes)
    ax.tick_params(axis="y", colors=PURPLE)
    shown = np.concatenate(shown)
    shown = shown[np.isfinite(shown)]
    if name == "clearance" and len(shown) and shown.min() > 0:
        ax.set(yscale="log", ylim=(shown.min() / 2, shown.max() * 2))
    else:
        low, high = shown.min(initial=0.0), shown.max(initial=0.0)
        ax.set_ylim(1.3 * low, 1.3 * high if high > 0 or low < 0 else 1.0)


def _axial(ax, sweep, x, per):
    """Axial stiffness, `per` of its unit in one SI unit."""
    axial = per * _entries(sweep, "stiffness", 0, 0)
    ax.plot(x, axial, color=GREY, lw=1.7)
    ax.tick_params(axis="y", colors=GREY)
    low, high = np.nanmin(np.append(axial, 0)), np.nanmax(np.append(axial, 0))
    # Higher up than the damping, so that neither hides the other where both are constant.
    ax.set_ylim(1.05 * low, 1.05 * high if high > 0 else 0.1)
    if not np.nan_to_num(axial).any():
        ax.set_yticks([0.0], ["none"])


def _matrix(ax, found, at, title, speed):
    """Both matrices as numbers."""
    ax.axis("off")
    ax.set(xlim=(0, 1), ylim=(0, 1))
    ax.text(0, 1.0, shortened(title, 72), weight="bold", va="top", fontsize=9.5)
    if found["stiffness"] is None:
        return
    tilt, opening = 1e6 * np.hypot(at["tilt_x"], at["tilt_y"]), 1e6 * at["axial_opening"]
    # What is left of the balance's rounding is no opening.
    opening = opening if abs(opening) > 1e-7 * 1e6 * at["clearance"] else 0.0
    (angle, finest), (unit, finer) = fitting("µrad", tilt), fitting("µm", abs(opening))
    words = f"clearance {1e6 * at['clearance']:.4g} µm, opening {finer * opening:.3g} {unit}, "
    words += f"tilt {finest * tilt:.4g} {angle}, {speed}, thinnest film {1e6 * at['h_min']:.4g} µm"
    ax.text(0, 0.87, words, va="top", fontsize=8, color=GREY)
    for left, name, letter, unit in ((0.01, "stiffness", "K", "N, m, rad"), (0.52, "damping", "D", "N, m, s, rad")):
        ax.text(left, 0.72, f"{letter}  ({unit})", va="top", fontsize=8.5)
        for j, across in enumerate(NAMES):
            ax.text(left + 0.17 + 0.15 * j, 0.56, across, va="top", ha="right", fontsize=8.5, color=GREY)
        for i, down in enumerate(NAMES):
            y = 0.41 - 0.16 * i
            ax.text(left, y, down, va="top", fontsize=8.5, color=GREY)
            for j in range(3):
                value = found[name][i][j]
                # Nor is what is left of cells that cancel a coupling.
                if abs(value) < 1e-9 * np.sqrt(abs(found[name][i][i] * found[name][j][j])):
                    value = 0.0
                words = number(value, ".2e" if abs(value) >= 9999.5 or 0 < abs(value) < 1e-3 else ".4g")
                words = words.replace("e+0", "e").replace("e+", "e").replace("e−0", "e−")
                ax.text(left + 0.17 + 0.15 * j, y, words, va="top", ha="right", fontsize=8)
