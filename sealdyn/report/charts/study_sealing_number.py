"""Sealing number over F_s/F_d: closed form, actual film, in time, and the ring let go; how far the closed form carries;
and where a released ring hangs up, rides or straightens."""

import numpy as np

from ...archive import read_study
from .page import absent, legend, level, look, save, study_page
from .palette import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, VERMILLION
from .record import done

# One fate, one colour and one mark, in all panels.
FATES = {"film": (GREEN, "o", "rides on a film"), "straightened": (VERMILLION, "v", "straightened, on its asperities"),
         "hang-up": (PURPLE, "X", "hung up, open"), "rubs": (ORANGE, "D", "rubs"), "moving": (SKY, "s", "not settled"),
         "failed": (BLACK, "1", "run failed")}  # fmt: skip
OWN = "own"
TICKS = (1.2, 1.6, 2, 3, 5, 10, 20, 50)


@look()
def draw(archive_path, out_path):
    """The figure of a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    rows = [{**row, "fate": row["status"] if row["status"] in FATES else "failed"} for row in done(answer["released"])]
    # What was found, and what could not be run.
    told = [answer["verdict"][0], *(words for words in answer["verdict"][1:] if words.startswith("Failed"))]
    story = f"{study['name']}: {' '.join(told)}"
    mosaic = [["numbers", "ratios"], ["numbers", "map"]]
    figure, ax = study_page(study, 13.0, 8.2, mosaic, below=story, width_ratios=(3, 2), height_ratios=(6, 7))
    # What was asked, and always where the closed form has no balance and where it has one.
    ratios = [row["force_ratio"] for row in answer["balance"]] + [1.2, 2.0 * answer["least_force_ratio"]]
    _numbers(ax["numbers"], answer, rows)
    _ratios(ax["ratios"], rows)
    _map(ax["map"], answer, rows, max(ratios))
    for panel in ax.values():
        panel.set(xscale="log", xlabel="spring force over friction of half the secondary seal, q = F_s/F_d")
        panel.set_xticks(TICKS, [f"{t:g}" for t in TICKS])
        panel.set_xticks([], minor=True)
        panel.set_xlim(min(ratios) / 1.06, max(ratios) * 1.1)
    return save(figure, out_path)


def _numbers(ax, answer, rows):
    """Sealing number: what is claimed and what happens."""
    line = answer["line"]
    held = [{**r, **r["static"]} for r in answer["balance"] if r.get("static")]
    settled = [{**r, **r["quasi_static"]} for r in answer["balance"]
               if r.get("quasi_static", {}).get("status") == "settled"]  # fmt: skip
    for rows_of, mark, label, style in (
        (line, "-", "closed form, Ludwig & Allen", {"color": BLACK, "lw": 1.6, "zorder": 3}),
        (_columns(held), "+", "same balance, actual film", {"color": ORANGE, "ms": 12, "mew": 1.8, "zorder": 5}),
        (answer["foreseen"], "--", "released on its own support, foreseen", {"color": GREEN, "lw": 1.3, "zorder": 2}),
        (_columns(settled), "D", "same balance in time, settled", {"ms": 9, "mec": BLUE, "mew": 1.3, "zorder": 4}),
        (_columns(answer["published"]), "*", "published rows", {"ms": 15, "mec": BLACK, "zorder": 6}),
    ):
        if rows_of["force_ratio"]:
            ax.plot(rows_of["force_ratio"], rows_of["sealing_number"], mark, mfc="none", label=label, **style)
    ax.set_yscale("log")
    flat = [r["sealing_number"][0] for r in rows if r["fate"] != "hang-up"] + line["sealing_number"][-1:]
    top, low = 40 * max(flat), 0.2 * min(flat)
    _released(ax, [r for r in rows if r["fate"] != "hang-up"])
    _hung(ax, [r for r in rows if r["fate"] == "hang-up"], top)
    ax.set_ylim(low, top)
    _zones(ax, answer)
    ax.set(ylabel="sealing number  h0² F_s / (µ U ΔR³)",
           title="Mean film, as the sealing number (bars: least and largest)")  # fmt: skip
    # Below the panel, where there is nothing to hide.
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=2)


def _columns(rows) -> dict:
    return {name: [row[name] for row in rows] for name in ("force_ratio", "sealing_number")}


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
    # Their film, which the scene's has to be for the figure to be theirs.
    words += "\n\nLudwig & Allen's Fig. 8 needs a flat planar film, constant"
    words += "\nover the face, its pressure ambient where it diverges"
    ax.annotate(words, (attracting, 0.8), xycoords=("data", "axes fraction"), fontsize=8, xytext=(6, 0), va="top",
                textcoords="offset points", annotation_clip=True)  # fmt: skip


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


def _first(rows) -> list[dict]:
    """Of rings that were started in several ways those of the first one."""
    return [row for row in rows if row["start"] == rows[0]["start"]]


def _ratios(ax, rows):
    """Film of the released ring over that of the closed form."""
    for name, words, colour in (("mean_film", "mean film h0", BLUE), ("least_film", "least film", ORANGE),
                                ("sealing_number", "sealing number", GREEN)):  # fmt: skip
        for own, mark in ((True, "o-"), (False, "o:")):
            mine = [r for r in _first(rows) if r["ratio"] and (r["support"] == OWN) == own]
            if mine:
                ax.plot([r["force_ratio"] for r in mine], [r["ratio"][name] for r in mine], mark, color=colour, ms=4,
                        mfc=colour if own else "white", label=words if own else None)  # fmt: skip
    if not ax.lines:
        return absent(
            ax, "How far the closed form carries", "no released ring and closed form have a film at one ratio"
        )
    level(ax, 1.0, "hollow: with a tilt spring that carries R F_s h1/h0", BLACK, ls="-", lw=0.8, zorder=1)
    ax.set(yscale="log", ylabel="released / closed form", title="How far the closed form carries")
    seen = [value for line in ax.lines for value in line.get_ydata()]
    # Room for the names above the line at one, and above all marks.
    low, high = 0.6 * min(seen), 1.6 * max(seen)
    ax.set_ylim(low, max(high * (high / low) ** 0.4, 12.0))
    legend(ax, "upper left", title="on its own support", alignment="left", title_fontsize=8, ncols=3)


def _map(ax, answer, rows, last):
    """Fates over force ratio and what the support carries."""
    found, need = answer["map"], answer["map"]["closed_form"]
    guide, hang, straight = (np.array(found[n]) for n in ("guide", "hang_up_below", "straightens_above"))
    ax.fill_betweenx(guide, 0.1, hang, color=PURPLE, alpha=0.16, lw=0)
    ax.fill_betweenx(guide, hang, np.maximum(straight, hang), color=GREEN, alpha=0.16, lw=0)
    ax.fill_betweenx(guide, straight, 1e3, color=VERMILLION, alpha=0.14, lw=0)
    ax.axhspan(1.0, 2.0, color=PURPLE, alpha=0.16, lw=0)
    ax.plot(need["force_ratio"], need["guide"], color=BLACK, lw=1.6)
    for row in _first(rows):
        colour, mark, _ = FATES[row["fate"]]
        ax.plot(row["force_ratio"], row["guide"], mark, color=colour, ms=6, mec="white", mew=0.6, zorder=4,
                clip_on=False)  # fmt: skip
    # Each name in its region, however far it goes to the right.
    inner, outer, film = last**0.75, min(last**0.5, need["force_ratio"][-1]), last**0.9
    middle = 0.5 * sum(np.interp(film, ends, guide) for ends in (hang, straight))
    named = ((1.22, 0.62, 90, "hangs up", PURPLE), (inner, 0.12, 0, "straightens", VERMILLION),
             (film, min(middle, 1.0), 0, "film", GREEN))  # fmt: skip
    at = outer, np.interp(outer, need["force_ratio"], need["guide"])
    ax.annotate("closed form", at, xytext=(5, -3), textcoords="offset points", weight="bold", fontsize=9, va="top",
                annotation_clip=True)  # fmt: skip
    for x, y, turned, words, colour in named:
        ax.text(x, y, words, color=colour, rotation=turned, weight="bold", fontsize=9, ha="center", va="center",
                clip_on=True)  # fmt: skip
    ax.set(ylim=(-0.02, 1.08), ylabel="tilt moment of the support / R F_s",
           title="What a released ring does: foreseen, and run (marks)")  # fmt: skip
    ax.grid(color=PALE)
