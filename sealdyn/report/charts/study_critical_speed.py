"""The stability threshold by three independent methods, and what becomes of the whirl beyond it."""

import textwrap

import numpy as np

from ...archive import read_study
from .page import absent, look, save, sheet, shortened
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PALE

FATE = {"decays": (GREEN, "dies out"), "bounded": (BLUE, "stays bounded"), "contact": (CONTACT, "ends in contact")}


def draw(path, out):
    """Left: growth rate against speed.  Right: whirl amplitude against speed, by continuation and in time."""
    info = read_study(path)
    answer = info["answer"]
    with look():
        figure = sheet(11.5, 6.2)
        title = f"Where does {info['name'].replace('_', ' ')} start to whirl, and what becomes of it?"
        figure.text(0.035, 0.955, shortened(title, 105), fontsize=13, weight="bold", va="center")
        figure.text(0.035, 0.905, shortened(answer["verdict"][0], 165), fontsize=9, va="center")
        kind = (answer["nonlinear"] or {}).get("verdict", "").split(" At ")[0].split(" Small whirls")[0]
        for line, words in enumerate(textwrap.wrap(kind, 165)[:2]):
            figure.text(0.035, 0.868 - 0.033 * line, words, fontsize=9, va="center")
        left = figure.add_axes((0.075, 0.09, 0.385, 0.57))
        right = figure.add_axes((0.56, 0.09, 0.41, 0.57))
        linear(left, answer)
        nonlinear(right, answer)
        return save(figure, out)


def linear(ax, answer):
    """Growth rate of a small disturbance against speed."""
    growth = answer["growth"]
    speed = np.array(growth["speed"]) / 1e3
    ax.axhline(0, color=BLACK, lw=0.8)
    ax.plot(speed, _numbers(growth["eigenvalue"]), color=ORANGE, lw=1.6, label="eigenvalues")
    ax.errorbar(speed, _numbers(growth["time_domain"]), yerr=_numbers(growth["uncertainty"]), fmt="o", ms=5, mfc="none",
                color=BLUE, capsize=3, label="in time (bar: uncertainty)")  # fmt: skip
    if answer["formula"]:
        ax.axvline(answer["formula"] / 1e3, color=GREY, ls="--", lw=1.2, label=f"formula {answer['formula']:.6g} rad/s")
    value = answer["time_domain"]["value"]
    if value:
        ax.plot(value / 1e3, 0, "x", ms=9, mew=2, color=BLACK, label=f"threshold in time {value:.6g} rad/s")
    ax.set(xlabel="shaft speed, krad/s", ylabel="growth rate, 1/s")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.12), ncol=2, fontsize=7.5)
    ax.set_title("Growth of a small disturbance", pad=18)
    _rpm(ax)


def nonlinear(ax, answer):
    """Whirl amplitude against speed: the family (solid stable, dashed unstable) and the runs."""
    found, title = answer["nonlinear"], "Whirl beyond the threshold"
    if not found or "branch" not in found:
        absent(ax, title, (found or {}).get("verdict", "not asked for"))
        return
    family, unit = found["branch"], found["contact_tilt"]
    speed = np.array([answer["eigenvalue"], *family["speed"]]) / 1e3
    size = np.array([0.0, *family["amplitude"]]) / unit
    stable = np.array([family["growth_rate"][0], *family["growth_rate"]]) < 0
    for held, style, label in ((True, "-", "whirl, stable"), (False, "--", "whirl, unstable")):
        if (stable == held).any():
            part = np.where(stable == held, size, np.nan)
            ax.plot(speed, part, style, color=BLACK, lw=1.8, label=label)
    ax.plot(speed[-1], size[-1], "s", color=CONTACT, ms=7, label="whirl touches", zorder=5)
    tips = [row for row in found["tipping"] if row.get("disturbance")]
    if tips:
        at = [row["speed"] / 1e3 for row in tips]
        edge, least = ([row[name] / unit for row in tips] for name in ("whirl", "disturbance"))
        ax.plot(at, edge, "x", ms=8, mew=1.8, color=ORANGE, label="whirl at the edge, in time")
        ax.plot(at, least, "_", ms=13, mew=2, color=ORANGE, label="tips the unopened gap")
    _runs(ax, found, unit)
    span = np.ptp([row["speed"] for row in found["directions"] if "from" in row]) / 1e3
    low = min(row["speed"] for row in found["directions"]) / 1e3
    ax.set(xlabel="shaft speed, krad/s", ylabel="whirl tilt / tilt that closes the unopened gap",
           xlim=(low - 0.08 * span, low + 1.08 * span), ylim=(-0.02 * size.max(), 1.15 * size.max()))  # fmt: skip
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.12), ncol=3, fontsize=7.5, columnspacing=1.2, handlelength=1.8)
    ax.set_title(f"{title} (▲ begun small, ▼ begun large)", pad=18)
    _rpm(ax)


def _runs(ax, found, unit):
    """Where each run in time began (triangle: up from a small whirl, down from a large one), where it stayed."""
    named = set()
    for row in found["directions"]:
        if "fate" not in row or row["fate"] not in FATE:
            continue
        colour, said = FATE[row["fate"]]
        mark = "^" if row["start"] == "small" else "v"
        label = None if row["fate"] in named else said
        named.add(row["fate"])
        ax.plot(row["speed"] / 1e3, row["from"] / unit, mark, ms=6, color=colour, label=label)
        if row["whirl"]:
            label = None if "settled" in named else "settles at"
            named.add("settled")
            ax.plot(row["speed"] / 1e3, row["whirl"] / unit, "o", ms=7, mfc="none", mew=1.5, color=colour, label=label)


def _numbers(values):
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def _rpm(ax):
    """The same axis in rpm on top, its name at the end of the ticks."""
    top = ax.secondary_xaxis("top", functions=(lambda x: x * 3e4 / np.pi, lambda x: x * np.pi / 3e4))
    top.spines["top"].set_color(PALE)
    top.tick_params(labelsize=7, colors=GREY)
    ax.text(-0.045, 1.015, "rpm", transform=ax.transAxes, color=GREY, fontsize=7, ha="right", va="bottom")
