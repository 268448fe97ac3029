"""The stability threshold by three independent methods, and what becomes of the whirl beyond it."""

import numpy as np

from ...archive import read_study
from .page import absent, legend, look, once, save, study_page
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PALE

FATE = {"decays": (GREEN, "dies out"), "bounded": (BLUE, "stays bounded"), "contact": (CONTACT, "ends in contact")}


@look()
def draw(path, out):
    """Left: growth rate against speed.  Right: whirl amplitude against speed, by continuation and in time."""
    study = read_study(path)
    answer = study["answer"]
    title = f"Where does {study['name'].replace('_', ' ')} start to whirl, and what becomes of it?"
    kind = (answer["nonlinear"] or {}).get("verdict", "").split(" At ")[0].split(" Small whirls")[0]
    figure, ax = study_page(study, 11.5, 6.2, [["linear", "nonlinear"]], title, f"{answer['verdict'][0]} {kind}")
    linear(ax["linear"], answer)
    nonlinear(ax["nonlinear"], answer)
    return save(figure, out)


def linear(ax, answer):
    """Growth rate of a small disturbance against speed."""
    growth, title = answer["growth"], "Growth of a small disturbance"
    speed = np.array(growth["speed"]) / 1e3
    rates, uncertain, eigen = (np.array(growth[k], dtype=float) for k in ("time_domain", "uncertainty", "eigenvalue"))
    if not np.isfinite(eigen).any():
        return absent(ax, title, "no growth rate was found")
    ax.axhline(0, color=BLACK, lw=0.8)
    ax.plot(speed, eigen, color=ORANGE, lw=1.6, label="eigenvalues")
    ax.errorbar(speed, rates, yerr=uncertain, fmt="o", ms=5, mfc="none", color=BLUE, capsize=3,
                label="in time (bar: uncertainty)")  # fmt: skip
    if answer["formula"]:
        ax.axvline(answer["formula"] / 1e3, color=GREY, ls="--", lw=1.2, label=f"formula {answer['formula']:.6g} rad/s")
    value = answer["time_domain"]["value"]
    if value:
        ax.plot(value / 1e3, 0, "x", ms=9, mew=2, color=BLACK, label=f"threshold in time {value:.6g} rad/s")
    _frame(ax, title, "growth rate, 1/s", 2)


def nonlinear(ax, answer):
    """Whirl amplitude against speed: the family (solid stable, dashed unstable) and the runs."""
    found, title = answer["nonlinear"], "Whirl beyond the threshold"
    if not found or "branch" not in found:
        return absent(ax, title, (found or {}).get("verdict", "not asked for"))
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
    low, high = (end(row["speed"] for row in found["directions"]) / 1e3 for end in (min, max))
    room = 0.08 * (high - low) or 0.01 * high
    ax.set(xlim=(low - room, high + room), ylim=(-0.02 * size.max(), 1.15 * size.max()))
    _frame(ax, f"{title} (▲ begun small, ▼ begun large)", "whirl tilt / tilt that closes the unopened gap", 3)


def _runs(ax, found, unit):
    """Where each run in time began (triangle: up from a small whirl, down from a large one), where it stayed."""
    for fate, (colour, said) in FATE.items():
        rows = [row for row in found["directions"] if row.get("fate") == fate]
        for row in rows:
            mark = "^" if row["start"] == "small" else "v"
            ax.plot(row["speed"] / 1e3, row["from"] / unit, mark, ms=6, color=colour, label=once(ax, said))
        for row in (row for row in rows if row["whirl"]):
            ax.plot(row["speed"] / 1e3, row["whirl"] / unit, "o", ms=7, mfc="none", mew=1.5, color=colour,
                    label=once(ax, "settles at"))  # fmt: skip


def _frame(ax, title, ylabel, columns):
    """Title and legend above, and the speed in rpm on top, its name at the end of the ticks."""
    ax.set(xlabel="shaft speed, krad/s", ylabel=ylabel)
    ax.set_title(title, pad=18)
    legend(ax, "lower center", bbox_to_anchor=(0.5, 1.12), ncols=columns, fontsize=7.5)
    top = ax.secondary_xaxis("top", functions=(lambda x: x * 3e4 / np.pi, lambda x: x * np.pi / 3e4))
    top.spines["top"].set_color(PALE)
    top.tick_params(labelsize=7, colors=GREY)
    ax.text(-0.045, 1.015, "rpm", transform=ax.transAxes, color=GREY, fontsize=7, ha="right", va="bottom")
