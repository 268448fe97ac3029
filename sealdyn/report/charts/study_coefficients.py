"""Film stiffness and damping over speed, clearance and tilt, and the matrices themselves."""

import numpy as np

from ...archive import read_study
from .page import heading, look, save, sheet, shortened
from .palette import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION

TILT = (("K xx", 1, 1, BLUE, "-"), ("K yy", 2, 2, GREEN, (0, (5, 2))), ("K xy", 1, 2, VERMILLION, "-"),
        ("K yx", 2, 1, ORANGE, (0, (5, 2))))  # fmt: skip
NAMES = ("z", "x", "y")


def draw(archive_path, out_path):
    """Three panels and two matrices, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(11.5, 8.0)
        heading(figure, "How stiff is the film, and how does it damp?", f"{study['name']}: {study['question']}")
        for i, (key, name, scale, label) in enumerate((
            ("against_speed", "speed", 1.0, "shaft speed, rad/s"),
            ("against_clearance", "clearance", 1e6, "clearance, µm"),
            ("against_tilt", "tilt", 1e6, "relative tilt about x, µrad"),
        )):  # fmt: skip
            ax = figure.add_axes((0.07 + 0.33 * i, 0.615, 0.225, 0.225))
            _tilt_panel(ax, answer[key], scale * np.array(answer[key][name]), i)
            damping = figure.add_axes((0.07 + 0.33 * i, 0.335, 0.225, 0.225))
            _damping_panel(damping, answer[key], scale * np.array(answer[key][name]), label, i)
        figure.axes[0].legend(loc="lower left", bbox_to_anchor=(-0.2, 1.11), ncols=4)
        _matrix(figure.add_axes((0.035, 0.02, 0.46, 0.235)), answer, answer["at"], "Aligned")
        tilted = answer["tilted"]
        _matrix(figure.add_axes((0.52, 0.02, 0.46, 0.235)), tilted, tilted["at"], "Tilted: " + tilted["said"])
        return save(figure, out_path)


def _entries(sweep, name, i, j):
    return np.array([np.nan if m is None else m[i][j] for m in sweep[name]], dtype=float)


def _tilt_panel(ax, sweep, x, number):
    titles = ("Over speed", "Over clearance", "Over tilt (axially balanced)")
    for name, i, j, colour, dashes in TILT:
        label = f"{name.split()[0]}$_{{{name.split()[1]}}}$"
        ax.plot(x, _entries(sweep, "stiffness", i, j), color=colour, ls=dashes, lw=1.7, label=label)
    ax.axhline(0.0, color=BLACK, lw=0.8)
    ax.set(title=titles[number], xlim=(x[0], x[-1]))
    ax.tick_params(labelbottom=False, which="both")
    if number == 0:
        ax.set_ylabel("tilt stiffness, N m/rad")
    if number == 1:
        _log(ax)


def _log(ax):
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter(lambda v, _: f"{v:g}")
    ax.xaxis.set_minor_formatter(lambda v, _: f"{v:g}" if f"{v:.0e}"[0] in "25" else "")


def _damping_panel(ax, sweep, x, label, number):
    """Tilt damping on the left, axial stiffness on the right."""
    ax.plot(x, _entries(sweep, "damping", 1, 1), color=PURPLE, lw=1.7, label="tilt damping D$_{xx}$")
    ax.plot(x, _entries(sweep, "damping", 2, 2), color=PURPLE, lw=1.7, ls=(0, (5, 2)), label="D$_{yy}$")
    ax.set(xlim=(x[0], x[-1]), xlabel=label)
    if number == 0:
        ax.set_ylabel("tilt damping, N m s/rad\n(xx solid, yy dashed)", color=PURPLE)
    ax.tick_params(axis="y", colors=PURPLE)
    shown = np.concatenate([_entries(sweep, "damping", i, i) for i in (1, 2)])
    shown = shown[np.isfinite(shown)]
    if "clearance" in label:
        _log(ax)
    if "clearance" in label and len(shown) and shown.min() > 0:
        ax.set_yscale("log")
        ax.set_ylim(shown.min() / 2, shown.max() * 2)
    else:
        ax.set_ylim(0, 1.15 * max(shown.max(initial=0.0), 1e-12))
    other = ax.twinx()
    other.grid(False)
    other.spines["right"].set_visible(True)
    axial = 1e-6 * _entries(sweep, "stiffness", 0, 0)
    other.plot(x, axial, color=GREY, lw=1.7)
    other.tick_params(axis="y", colors=GREY)
    if number == 2:
        other.set_ylabel("axial stiffness, N/µm", color=GREY)
    low, high = np.nanmin(np.append(axial, 0)), np.nanmax(np.append(axial, 0))
    other.set_ylim(1.15 * low, 1.15 * high if high > 0 else 0.1)


def _matrix(ax, found, at, title):
    """Both matrices as numbers."""
    ax.axis("off")
    ax.set(xlim=(0, 1), ylim=(0, 1))
    ax.text(0, 1.0, shortened(title, 72), weight="bold", va="top", fontsize=9.5)
    if found["stiffness"] is None:
        return
    tilt = 1e6 * np.hypot(at["tilt_x"], at["tilt_y"])
    words = f"clearance {1e6 * at['clearance']:.4g} µm, opening {1e6 * at['axial_opening']:.3g} µm, "
    words += f"tilt {tilt:.4g} µrad, {at['speed']:.5g} rad/s, thinnest film {1e6 * at['h_min']:.4g} µm"
    ax.text(0, 0.87, words, va="top", fontsize=8, color=GREY)
    for left, name, letter, unit in ((0.01, "stiffness", "K", "N, m, rad"), (0.52, "damping", "D", "N, m, s, rad")):
        ax.text(left, 0.72, f"{letter}  ({unit})", va="top", fontsize=8.5)
        for j, across in enumerate(NAMES):
            ax.text(left + 0.16 + 0.14 * j, 0.56, across, va="top", ha="right", fontsize=8.5, color=GREY)
        for i, down in enumerate(NAMES):
            y = 0.41 - 0.16 * i
            ax.text(left, y, down, va="top", fontsize=8.5, color=GREY)
            for j in range(3):
                number = found[name][i][j]
                value = (f"{number:.2e}" if abs(number) >= 9999.5 else f"{number:.4g}").replace("-", "−")
                ax.text(left + 0.16 + 0.14 * j, y, value, va="top", ha="right", fontsize=8.5)
