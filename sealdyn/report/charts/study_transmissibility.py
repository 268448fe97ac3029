"""Bode plot of the FMR, the FMS and the FMSR seal over speed, three independent methods on one chart:
transmissibilities above, a strip that shows which is best below each, then phases, and the table at the foot."""

from textwrap import wrap

import numpy as np
from matplotlib.ticker import LogLocator, MultipleLocator

from ...archive import read_study
from ..text import speed_unit
from .page import logarithmic, look, number, save, stacked, study_page
from .palette import BLACK, GREEN, GREY, PALE, RING
from .record import done

COLOUR = {"fmr": RING["rotor"], "fms": RING["stator"], "fmsr": GREEN}
MARK = {"fmr": "o", "fms": "s", "fmsr": "D"}
# Height of the strip that shows which arrangement is best, of the axes.
STRIP = 0.035
# Most lines of words in a panel.
MOST = 4
TITLES = {
    "static": "Static: fixed in space",
    "dynamic": "Dynamic: turns with the shaft",
    "total": "Total: both forcings 1",
}
# Largest transmissibility of a figure below which it is read in this unit, and how many of that make one.
UNITS = ((2e-5, "nrad per mrad of forcing", 1e6), (2e-2, "µrad per mrad of forcing", 1e3))
# Steps of ticks of a phase, degrees, and the most ticks.
DEGREES, TICKS = (1, 2, 5, 10, 15, 30, 45, 90, 180), 7
RPM = 60 / (2 * np.pi)
WORDS = {
    "static_transmissibility": "static transmissibility",
    "dynamic_transmissibility": "dynamic transmissibility",
    "maximum_relative_misalignment": "maximum relative misalignment",
    "critical_misalignment": "critical misalignment, C/r_o",
    "critical_speed": "critical speed",
}


@look()
def draw(archive_path, out_path):
    """Amplitudes and phases over speed and a table, from a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "How much misalignment reaches the film?"
    # As the scenario has it, or as it was asked.
    if speed_unit(study)[0] == "rpm":
        answer = {**answer, "unit": "rpm"}
    mosaic = [list(TITLES), ["static phase", "dynamic phase", "legend"]] + ([3 * ["table"]] if answer["table"] else [])
    heights = (9, 8, 7)[: len(mosaic)]
    figure, ax = study_page(study, 11.5, 10.8 if answer["table"] else 8.0, mosaic, title, height_ratios=heights)
    for quantity in ("static", "dynamic"):
        stacked(ax[quantity], ax[f"{quantity} phase"])
        _phases(ax[f"{quantity} phase"], answer, f"{quantity}_phase")
    unit, per = _unit(answer)
    for quantity in TITLES:
        _amplitudes(ax[quantity], answer, quantity, per)
    for name in ("static phase", "dynamic phase", "total"):
        ax[name].set_xlabel(f"shaft speed, {answer['unit']}")
    ax["static"].set_ylabel(f"relative misalignment{unit}")
    ax["static phase"].set_ylabel("phase behind the forcing, deg")
    _legend(ax["legend"], answer, unit, per)
    if answer["table"]:
        _table(ax["table"], answer)
    return save(figure, out_path)


def _unit(answer) -> tuple[str, float]:
    """What stands behind the name of a transmissibility, and how many of it make one."""
    largest = max(np.max(answer[seal][name]) for seal in COLOUR for name in TITLES)
    found = next(((f", {unit}", per) for least, unit, per in UNITS if largest < least), None)
    return found or (" per unit forcing", 1.0)


def _roads(ax, answer, quantity: str, per: float = 1.0):
    """One column of the arrangements by three independent methods over speed, `per` of its unit in one."""
    factor = RPM if answer["unit"] == "rpm" else 1.0
    speed = factor * np.array(answer["speed"])
    for seal, colour in COLOUR.items():
        stable = np.array(answer[seal]["stable"])
        line, dashes = (per * np.array(road[quantity]) for road in (answer[seal], answer[seal]["linear_algebra"]))
        ax.plot(speed, np.where(stable, line, np.nan), color=colour, lw=2.2, alpha=0.75)
        ax.plot(speed, np.where(stable, np.nan, line), color=colour, lw=1.0, alpha=0.5, ls=":")
        if answer["formula_holds"]:
            ax.plot(speed, np.where(stable, dashes, np.nan), color=BLACK, lw=0.8, ls=(0, (4, 5)))
        inside = sorted((answer["speed"][0], answer["speed"][-1]))
        for row in done(answer["time_domain"]):
            # The scenario's own speed may lie elsewhere.
            if row["seal"] != seal or not inside[0] <= row["speed"] <= inside[1]:
                continue
            at, value = factor * row["speed"], per * row[quantity]
            ax.errorbar(at, value, per * row["error"][quantity], fmt="none", lw=1.0, ecolor=colour, capsize=3)
            ax.plot(at, value, MARK[seal], ms=4.5, mfc="white", mec=colour, clip_on=False)
    ax.set(xlim=(speed[0], speed[-1]))
    ax.locator_params(axis="x", nbins=5)
    return per * np.concatenate([answer[s][quantity] for s in COLOUR])


def _amplitudes(ax, answer, quantity: str, per: float):
    """One transmissibility."""
    both = _roads(ax, answer, quantity, per)
    lowest, highest = max(both.min(), 1e-9), np.percentile(both, 99)
    # Above the curves: a line of words for every stretch.
    room = 0.12 + 0.1 * len(answer["best"][quantity][:MOST])
    if highest > 8 * lowest:
        # Far apart: the crossing is seen on a logarithmic axis only.
        logarithmic(ax, "y")
        ax.set_ylim(0.7 * lowest, highest * (highest / lowest) ** room)
        if highest > 300 * lowest:
            ax.yaxis.set_major_locator(LogLocator())
    else:
        ax.set_ylim(0, (1 + room) * highest)
    turns = quantity == "static" and answer.get("stator_speed")
    ax.set_title("Static: turns with the stator" if turns else TITLES[quantity])
    _best(ax, answer, quantity)


def _phases(ax, answer, name: str):
    """One phase; positive: behind, negative: ahead."""
    both = _roads(ax, answer, name)
    spread = max(np.ptp(both), 1.0)
    ax.axhline(0.0, color=BLACK, lw=0.6)
    low, high = min(both.min(), 0) - 0.1 * spread, max(both.max(), 0) + 0.1 * spread
    ax.set_ylim(low, high)
    if high - low > TICKS:
        ax.yaxis.set_major_locator(MultipleLocator(next((d for d in DEGREES if TICKS * d > high - low), 360)))
    ax.yaxis.set_major_formatter(lambda value, _: number(value))


def _best(ax, answer, quantity):
    """A strip in the colour of the arrangement that transmits least, and the speeds at which that changes, in words."""
    factor, unit = (RPM if answer["unit"] == "rpm" else 1.0), answer["unit"]
    stretches, lines = answer["best"][quantity], []
    for stretch in stretches:
        seal, ends = stretch["seal"], [factor * stretch[end] for end in ("from", "to")]
        ax.axvspan(*ends, ymax=STRIP, color=COLOUR.get(seal, PALE), lw=0)
        name = seal.upper() if seal else "none"
        if len(stretches) == 1:
            lines.append(f"{name} best at every speed" if seal else _none(answer))
            continue
        last = stretch is stretches[-1]
        lines.append(f"{name} best beyond {ends[0]:.6g} {unit}" if last else f"{name} best to {ends[1]:.6g} {unit}")
        if not last:
            ax.axvline(ends[1], color=GREY, lw=0.8, ls=":")
    if len(lines) > MOST:
        lines = [*lines[: MOST - 1], f"and {len(lines) - MOST + 1} stretches more"]
    ax.text(0.03, 0.96, "\n".join(lines), transform=ax.transAxes, va="top", fontsize=8, color=GREY, linespacing=1.5,
            backgroundcolor="white")  # fmt: skip


def _none(answer) -> str:
    """Why no arrangement is best at any speed."""
    damped = any(any(answer[seal]["stable"]) for seal in COLOUR)
    return "alike at every speed" if damped else "no steady state at any speed"


def _legend(ax, answer, unit: str, per: float):
    """What the lines are, how far the time domain is from them, in the unit of the axes, and what a phase is."""
    ax.axis("off")
    road = "formula" if answer["formula_holds"] else "linear algebra"
    for seal, colour in COLOUR.items():
        ax.plot([], [], color=colour, lw=2.2, alpha=0.75, label=f"{seal.upper()}, {road}")
    if answer["formula_holds"]:
        ax.plot([], [], color=BLACK, lw=0.8, ls=(0, (4, 5)), label="linear algebra")
    errors = [row["error"] for row in done(answer["time_domain"])]
    if errors:
        apart = per * max(error[name] for error in errors for name in TITLES)
        turned = max(error[name] for error in errors for name in ("static_phase", "dynamic_phase"))
        size = f"{_short(apart, 1)} {unit.removeprefix(', ').strip()}"
        label = f"time domain (error bars up to\n{size}, {_short(turned, 1)} deg)"
        ax.plot([], [], "o", color=GREY, mfc="white", label=label)
    if not all(all(answer[seal]["stable"]) for seal in COLOUR):
        ax.plot([], [], color=GREY, lw=1, ls=":", label="no steady state: not damped")
    ax.plot([], [], color=GREY, lw=6, label="strip: the one that transmits least")
    ax.legend(loc="upper left", borderaxespad=0.0, fontsize=8, labelspacing=0.35)
    words = "\n".join([*wrap(answer["film"], 52), *wrap(answer["phase"], 52)])
    ax.text(0.0, 0.0, words, fontsize=8, color=GREY, va="bottom", linespacing=1.3, transform=ax.transAxes)


def _table(ax, answer):
    """The arrangements, as Green's Table 1."""
    ax.axis("off")
    by_formula, unit = answer["formula_holds"], answer["unit"]
    # Archives of earlier versions hold neither the speed nor whether the gap moves with it.
    own = answer.get("own_speed")
    own = f"{(RPM if unit == 'rpm' else 1.0) * own:.5g} {unit}" if own else "its own speed"
    roads = {"formula": "formula", "linear_algebra": "lin. algebra", "time_domain": "in time"}
    heads = [f"At {own}"]
    for seal in COLOUR:
        heads += [seal.upper(), "", ""]
    below = ("in the form of Green (1989), Table 1", *(len(COLOUR) * list(roads.values())))
    columns = (0.0, *(0.28 + 0.25 * i + 0.08 * j for i in range(len(COLOUR)) for j in range(len(roads))))
    lines = [heads, below]
    for row in answer["table"]:
        speed = row["quantity"] == "critical_speed"
        factor = RPM if speed and unit == "rpm" else 1.0
        formula = by_formula and not (speed and answer.get("gap_moves"))
        cells = [_cell(row, seal, road, formula, factor) for seal in COLOUR for road in roads]
        lines.append((WORDS[row["quantity"]] + (f", {unit}" if speed else ""), *cells))
    for i, cells in enumerate(lines):
        y = 1 - i / (len(lines) + 1.6)
        for x, words in zip(columns, cells, strict=True):
            weight = "bold" if i == 0 else "normal"
            ax.text(x, y, words, va="top", fontsize=8.5, weight=weight, color=GREY if i == 1 else BLACK)
        if i >= 1:
            ax.axhline(y - 0.088, color=PALE, lw=0.5)
    # What its rows do not say.
    words = "\n".join(wrap(answer.get("critical", ""), 165))
    ax.text(0, 0, words, va="bottom", fontsize=8, color=GREY, linespacing=1.3)
    ax.set(xlim=(0, 1), ylim=(0, 1))


def _short(value: float, digits: int) -> str:
    """So many digits, in no more letters than a column has."""
    plain = 1e-3 <= abs(value) < 1e7
    words = f"{float(f'{value:.{digits}g}'):.7g}" if plain else f"{value:.{digits - 1}e}"
    return number(float(words)) if digits == 1 and plain else words.replace("e-0", "e−").replace("e+0", "e")


def _cell(row, seal, road, by_formula: bool, factor: float) -> str:
    value = row[road][seal]
    if value is not None:
        return _short(factor * value, 5 if factor * abs(value) >= 0.01 else 4)
    # No critical speed is an answer; no formula for it, one beyond its bounds, and no search for it in time, are none.
    known = row["linear_algebra"][seal] is None
    answers = road == "linear_algebra" or (road == "formula" and by_formula and seal != "fmsr" and known)
    return "none" if row["quantity"] == "critical_speed" and answers else "–"
