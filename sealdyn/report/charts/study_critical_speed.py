"""The stability threshold by three independent methods, and what becomes of the whirl beyond it."""

import numpy as np

from ...archive import read_study
from ..text import speed_unit
from .page import absent, legend, logarithmic, look, number, once, save, study_page
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PALE

RPM = 30 / np.pi
# Factor beyond the speeds that are drawn up to which the scenario's own is marked.
FAR = 2.0
FATE = {"decays": (GREEN, "dies out"), "bounded": (BLUE, "stays bounded"), "contact": (CONTACT, "ends in contact")}


@look()
def draw(path, out):
    """Left: growth rate against speed.  Right: whirl amplitude against speed, by continuation and in time, where it was
    followed."""
    study = read_study(path)
    answer = study["answer"]
    title = f"Where does {study['name'].replace('_', ' ')} start to whirl, and what becomes of it?"
    kind = (answer["nonlinear"] or {}).get("verdict", "").split(" At ")[0].split(" Small whirls")[0]
    said, follows = f"{answer['verdict'][0]} {kind}", "branch" in (answer["nonlinear"] or {})
    panels, width = (["linear", "nonlinear"], 11.5) if follows else (["linear"], 8.5)
    figure, ax = study_page(study, width, 6.2, [panels], title, said)
    shown = _Speeds(study, answer)
    linear(ax["linear"], answer, shown)
    if follows:
        nonlinear(ax["nonlinear"], answer, shown)
    return save(figure, out)


class _Speeds:
    """How speeds are shown: in rpm where the scenario has them so, else in rad/s or krad/s."""

    def __init__(self, study, answer):
        self.unit, self.per = speed_unit(study)
        largest = max(filter(None, [*answer["growth"]["speed"], answer["eigenvalue"]]), default=1.0)
        self.name, self.scale = self.unit, self.per
        if self.per * largest >= 1e4:
            self.name, self.scale = ("1000 rpm" if self.unit == "rpm" else "krad/s"), 1e-3 * self.per

    def said(self, speed: float) -> str:
        return f"{number(self.per * speed, '.6g')} {self.unit}"


def linear(ax, answer, shown):
    """Growth rate of a small disturbance against speed."""
    growth, title = answer["growth"], "Growth of a small disturbance"
    speed = shown.scale * np.array(growth["speed"])
    rates, uncertain, eigen = (np.array(growth[k], dtype=float) for k in ("time_domain", "uncertainty", "eigenvalue"))
    if not np.isfinite(eigen).any():
        why = next(filter(None, growth.get("failed") or []), "no growth rate was found")
        return absent(ax, title, why)
    ax.axhline(0, color=BLACK, lw=0.8)
    # Speeds tried far apart are no curve.
    near = answer["eigenvalue"] is not None
    ax.plot(speed, eigen, "-" if near else "D", ms=4.5, color=ORANGE, lw=1.6, label="eigenvalues")
    if np.isfinite(rates).any():
        ax.errorbar(speed, rates, yerr=uncertain, fmt="o", ms=5, mfc="none", color=BLUE, capsize=3,
                    label="in time (bar: uncertainty)")  # fmt: skip
    if answer["formula"]:
        label = f"formula {shown.said(answer['formula'])}"
        ax.axvline(shown.scale * answer["formula"], color=GREY, ls="--", lw=1.2, label=label)
    _own(ax, answer, shown)
    value = answer["time_domain"]["value"]
    if value:
        ax.plot(shown.scale * value, 0, "x", ms=9, mew=2, color=BLACK, label=f"threshold in time {shown.said(value)}")
    if answer["eigenvalue"] is None and speed.min() > 0 and speed.max() > 10 * speed.min():
        # Speeds tried far apart: each is seen on logarithmic axes only.
        logarithmic(ax, "x")
        most = np.nanmax(np.abs(eigen))
        if most > 30 * np.nanmin(np.abs(eigen)) > 0:
            least = np.nanmin(np.abs(eigen))
            ax.set_yscale("asinh", linear_width=least)
            ends = np.nanmin(eigen), np.nanmax(eigen)
            powers = [t for t in _decades(most) if t > 0.9 * least]
            ax.set_yticks([*(-t for t in reversed(powers) if ends[0] < 0), 0.0, *(t for t in powers if ends[1] > 0)])
            ax.set_ylim(min(1.5 * ends[0], -0.3 * least), max(1.5 * ends[1], 0.3 * least))
            ax.yaxis.set_major_formatter(lambda at, _: number(at))
            ax.minorticks_off()
    _frame(ax, title, "growth rate, 1/s", 2, shown)


def _own(ax, answer, shown):
    """The scenario's own speed, where it is not far from the speeds that are drawn; its number in the legend anyway.
    Archives of earlier versions do not hold it."""
    own = answer.get("own_speed")
    if not own:
        return
    speeds, label = answer["growth"]["speed"], f"this scenario {shown.said(own)}"
    near = min(speeds) / FAR <= own <= FAR * max(speeds)
    label += "" if near else ", not shown"
    ax.axvline(shown.scale * (own if near else speeds[0]), color=BLACK if near else "none", ls=":", lw=1.0, label=label)


def _decades(most: float) -> list[float]:
    """Three powers of ten up to a number."""
    top = int(np.floor(np.log10(most)))
    return [10.0**k for k in range(top - 2, top + 1)]


def nonlinear(ax, answer, shown):
    """Whirl amplitude against speed: the family (solid stable, dashed unstable) and the runs."""
    found, title = answer["nonlinear"], "Whirl beyond the threshold"
    family, unit = found["branch"], found["contact_tilt"]
    speed = shown.scale * np.array([answer["eigenvalue"], *family["speed"]])
    size = np.array([0.0, *family["amplitude"]]) / unit
    stable = np.array([family["growth_rate"][0], *family["growth_rate"]]) < 0
    for held, style, label in ((True, "-", "whirl, stable"), (False, "--", "whirl, unstable")):
        if (stable == held).any():
            part = np.where(stable == held, size, np.nan)
            ax.plot(speed, part, style, color=BLACK, lw=1.8, label=label)
    touches = found.get("contact_speed") is not None
    ax.plot(speed[-1], size[-1], "s", color=CONTACT if touches else GREY, ms=7, zorder=5,
            label="whirl touches" if touches else "followed to here")  # fmt: skip
    tips = [row for row in found["tipping"] if row.get("disturbance")]
    if tips:
        at = [shown.scale * row["speed"] for row in tips]
        edge, least = ([row[name] / unit for row in tips] for name in ("whirl", "disturbance"))
        ax.plot(at, edge, "x", ms=8, mew=1.8, color=ORANGE, label="whirl at the edge, in time")
        ax.plot(at, least, "_", ms=13, mew=2, color=ORANGE, label="tips the unopened gap")
    _runs(ax, found, unit, shown.scale)
    low, high = (shown.scale * end(row["speed"] for row in found["directions"]) for end in (min, max))
    room = 0.08 * (high - low) or 0.01 * high
    ax.set(xlim=(low - room, high + room), ylim=(-0.02 * size.max(), 1.15 * size.max()))
    _frame(ax, f"{title} (▲ begun small, ▼ begun large)", "whirl tilt / tilt that closes the unopened gap", 3, shown)


def _runs(ax, found, unit, scale):
    """Where each run in time began (triangle: up from a small whirl, down from a large one), where it stayed."""
    for fate, (colour, said) in FATE.items():
        rows = [row for row in found["directions"] if row.get("fate") == fate]
        for row in rows:
            mark = "^" if row["start"] == "small" else "v"
            ax.plot(scale * row["speed"], row["from"] / unit, mark, ms=6, color=colour, label=once(ax, said))
        for row in (row for row in rows if row["whirl"]):
            ax.plot(scale * row["speed"], row["whirl"] / unit, "o", ms=7, mfc="none", mew=1.5, color=colour,
                    label=once(ax, "settles at"))  # fmt: skip


def _frame(ax, title, ylabel, columns, shown):
    """The legend below, and beside rad/s the speed in rpm on top, its name at the end of the ticks."""
    ax.set(xlabel=f"shaft speed, {shown.name}", ylabel=ylabel)
    ax.set_title(title, pad=18 if shown.unit != "rpm" else 6)
    legend(ax, "upper center", bbox_to_anchor=(0.5, -0.13), ncols=columns, fontsize=7.5)
    if shown.unit == "rpm":
        return
    _, high = ax.get_xlim()
    # Of large numbers of turns thousands are counted.
    per = RPM / shown.scale
    per, name = (per, "rpm") if per * high < 1e5 else (1e-3 * per, "1000 rpm")
    top = ax.secondary_xaxis("top", functions=(lambda x: x * per, lambda x: x / per))
    top.spines["top"].set_color(PALE)
    top.tick_params(labelsize=7, colors=GREY)
    if ax.get_xscale() == "log":
        logarithmic(top, "x")
    top.xaxis.set_major_formatter(lambda at, _: number(at))
    ax.text(-0.045, 1.015, name, transform=ax.transAxes, color=GREY, fontsize=7, ha="right", va="bottom")
