"""Sealing number over F_s/F_d: closed form, actual film, in time, and the ring let go; how far the closed form carries;
and where a released ring hangs up, rides or straightens."""

import numpy as np

from ...archive import read_study
from .page import look, save, sheet, shortened
from .palette import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, VERMILLION

# One fate, one colour and one mark, in all panels.
FATES = {"film": (GREEN, "o", "rides on a film"), "straightened": (VERMILLION, "v", "straightened, on its asperities"),
         "hang-up": (PURPLE, "X", "hung up, open"), "rubs": (ORANGE, "D", "rubs"), "moving": (SKY, "s", "not settled"),
         "failed": (BLACK, "1", "run failed")}  # fmt: skip
OWN = "own"
TICKS = (1.2, 1.6, 2, 3, 5, 10, 20, 50)


def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    rows = [row for row in answer["released"] if "failed" not in row]
    for row in rows:
        row["fate"] = row["status"] if row["status"] in FATES else "failed"
    with look():
        figure = sheet(13.0, 8.2)
        figure.text(
            0.035,
            0.965,
            shortened(study["question"].partition("?")[0] + "?", 115),
            fontsize=13,
            weight="bold",
            va="center",
        )
        figure.text(0.035, 0.932, shortened(f"{study['name']}: {answer['verdict'][0]}", 175), fontsize=9, va="center")
        main = figure.add_axes((0.06, 0.075, 0.51, 0.79))
        ratio = figure.add_axes((0.645, 0.55, 0.335, 0.315), sharex=main)
        fates = figure.add_axes((0.645, 0.075, 0.335, 0.36), sharex=main)
        _numbers(main, answer, rows)
        _ratios(ratio, rows)
        _map(fates, answer, rows)
        ratios = [row["force_ratio"] for row in answer["balance"]]
        main.set_xscale("log")
        main.set_xlim(min(ratios) / 1.06, max(ratios) * 1.1)
        for ax in (main, ratio, fates):
            ax.set_xticks(TICKS, [f"{t:g}" for t in TICKS])
            ax.set_xticks([], minor=True)
            ax.set_xlim(min(ratios) / 1.06, max(ratios) * 1.1)
            ax.set_xlabel("spring force over friction of half the secondary seal, q = F_s/F_d")
        return save(figure, out_path)


def _numbers(ax, answer, rows):
    """Sealing number: what is claimed and what happens."""
    line = answer["line"]
    ax.plot(
        line["force_ratio"], line["sealing_number"], color=BLACK, lw=1.6, label="closed form, Ludwig & Allen", zorder=3
    )
    held = [(r["force_ratio"], r["static"]["sealing_number"]) for r in answer["balance"] if r.get("static")]
    if held:
        ax.plot(
            *zip(*held, strict=True), color=ORANGE, lw=3.2, ls=(0, (2, 2)), label="same balance, actual film", zorder=2
        )
    part, words = answer["foreseen"], "released on its own support, foreseen"
    if part["force_ratio"]:
        ax.plot(part["force_ratio"], part["sealing_number"], color=GREEN, lw=1.3, ls="--", label=words, zorder=2)
    quasi = [r for r in answer["balance"] if r.get("quasi_static", {}).get("status") == "settled"]
    x, y = [r["force_ratio"] for r in quasi], [r["quasi_static"]["sealing_number"] for r in quasi]
    style = dict(ms=9, mfc="none", mec=BLUE, mew=1.3, ls="", zorder=4)
    ax.plot(x, y, "D", label="same balance in time, settled", **style)
    x, y = ([p[name] for p in answer["published"]] for name in ("force_ratio", "sealing_number"))
    ax.plot(x, y, "*", ms=15, mfc="none", mec=BLACK, ls="", label="published rows", zorder=6)
    ax.set_yscale("log")
    flat = [r["sealing_number"][0] for r in rows if r["fate"] != "hang-up"] + line["sealing_number"][-1:]
    top, low = 40 * max(flat), 0.2 * min(flat)
    _released(ax, [r for r in rows if r["fate"] != "hang-up"])
    _hung(ax, [r for r in rows if r["fate"] == "hang-up"], top)
    ax.set_ylim(low, top)
    _zones(ax, answer)
    ax.set(
        ylabel="sealing number  h0² F_s / (µ U ΔR³)", title="Mean film, as the sealing number (bars: least and largest)"
    )
    ax.legend(loc="upper left", bbox_to_anchor=(0.36, 0.44), fontsize=8)


def _hung(ax, rows, top):
    """No film to put a number to: a strip at the top, those that started open a little lower."""
    colour, mark, words = FATES["hang-up"]
    for start, height, fill in (("closed form", 0.35, colour), ("open", 0.12, "white")):
        q = [r["force_ratio"] for r in rows if r["start"] == start]
        if q:
            said = "from a film" if start != "open" else "started open"
            ax.plot(q, [height * top] * len(q), mark, ms=8, mfc=fill, mec=colour, ls="", label=f"{words} ({said})")


def _zones(ax, answer):
    """Where the closed form has no balance, and where it repels."""
    least, attracting = answer["least_force_ratio"], answer["least_attracting_force_ratio"]
    ax.axvspan(0.1, least, color=GREY, alpha=0.16, lw=0)
    ax.axvspan(least, attracting, color=SKY, alpha=0.3, lw=0)
    words = f"closed form: hang-up, no balance below {least:.3f} (grey),\none that repels below {attracting:.3f} (blue)"
    ax.annotate(words, (attracting, 0.80), xycoords=("data", "axes fraction"), fontsize=8, xytext=(6, 0),
                textcoords="offset points")  # fmt: skip


def _released(ax, rows):
    """The ring let go, by its fate; filled on its own support, hollow where the support carries what is needed."""
    for fate, (colour, mark, words) in FATES.items():
        for own in (True, False):
            mine = [r for r in rows if r["fate"] == fate and (r["support"] == OWN) == own]
            if not mine:
                continue
            q, y = np.array([r["force_ratio"] for r in mine]), np.array([r["sealing_number"] for r in mine]).T
            bars = np.maximum([y[0] - y[1], y[2] - y[0]], 0.0)
            label = f"released, {'own support' if own else 'tilt spring R F_s h1/h0'}: {words}"
            ax.errorbar(q, y[0], bars, fmt=mark, ms=6, color=colour, mfc=colour if own else "white", capsize=3, lw=1.0,
                        label=label, zorder=5)  # fmt: skip


def _ratios(ax, rows):
    """Film of the released ring over that of the closed form."""
    names = {
        "mean_film": ("mean film h0", BLUE),
        "least_film": ("least film", ORANGE),
        "sealing_number": ("sealing number", GREEN),
    }
    for name, (words, colour) in names.items():
        for own, mark in ((True, "o-"), (False, "o:")):
            mine = [r for r in rows if r["ratio"] and (r["support"] == OWN) == own and r["start"] == "closed form"]
            if mine:
                ax.plot([r["force_ratio"] for r in mine], [r["ratio"][name] for r in mine], mark, color=colour, ms=4,
                        mfc=colour if own else "white", label=words if own else None)  # fmt: skip
    ax.axhline(1.0, color=BLACK, lw=0.8, zorder=1)
    words = "hollow: with a tilt spring that carries R F_s h1/h0"
    ax.annotate(words, (0.98, 1.0), xycoords=("axes fraction", "data"), xytext=(0, 5), textcoords="offset points",
                fontsize=8, ha="right")  # fmt: skip
    ax.set_yscale("log")
    ax.set_ylim(top=12)
    ax.set(ylabel="released / closed form", title="How far the closed form carries")
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="lower left", title="on its own support", alignment="left", title_fontsize=8)


def _map(ax, answer, rows):
    """Fates over force ratio and what the support carries."""
    found, need = answer["map"], answer["map"]["closed_form"]
    guide, hang, straight = (np.array(found[n]) for n in ("guide", "hang_up_below", "straightens_above"))
    ax.fill_betweenx(guide, 0.1, hang, color=PURPLE, alpha=0.16, lw=0)
    ax.fill_betweenx(guide, hang, np.maximum(straight, hang), color=GREEN, alpha=0.16, lw=0)
    ax.fill_betweenx(guide, straight, 1e3, color=VERMILLION, alpha=0.14, lw=0)
    ax.axhspan(1.0, 2.0, color=PURPLE, alpha=0.16, lw=0)
    ax.plot(need["force_ratio"], need["guide"], color=BLACK, lw=1.6)
    for row in rows:
        if row["start"] == "closed form":
            colour, mark, _ = FATES[row["fate"]]
            style = dict(color=colour, ms=6, mec="white", mew=0.6, zorder=4, clip_on=False)
            ax.plot(row["force_ratio"], row["guide"], mark, **style)
    for x, y, turned, words, colour in (
        (1.22, 0.62, 90, "hangs up", PURPLE),
        (5.5, 0.4, 0, "straightens", VERMILLION),
        (13.0, 0.86, 0, "film", GREEN),
    ):
        style = dict(weight="bold", fontsize=9, ha="center", va="center", clip_on=True)
        ax.text(x, y, words, color=colour, rotation=turned, **style)
    ax.annotate("closed form", (7.0, np.interp(7.0, need["force_ratio"], need["guide"])), xytext=(0, -14),
                textcoords="offset points", fontsize=8, ha="center", color=BLACK)  # fmt: skip
    ax.set(
        ylim=(-0.02, 1.08),
        ylabel="tilt moment of the support / R F_s",
        title="What a released ring does: foreseen, and run (marks)",
    )
    ax.grid(color=PALE)
