"""Periodic steady state: the orbit with its once-per-turn mark, Floquet multipliers, and what waiting would cost."""

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator

from ...archive import read_study
from .page import absent, logarithmic, look, save, study_page
from .palette import CONTACT, FILM, GREY, MARK, THEORY, TILT
from .record import done, fitting


@look()
def draw(archive_path, out_path):
    """Up to four panels from a study's archive: what there is nothing for is left out."""
    study = read_study(archive_path)
    answer = study["answer"]
    linear, orbit = answer.get("linear") or {}, answer.get("orbit")
    shown = {
        _orbit: orbit or answer.get("defects"),
        _multipliers: answer.get("multipliers") or linear.get("multipliers"),
        _film: orbit or "h_min" in linear,
        _cost: done(answer.get("near_threshold", [])),
    }
    panels = [draws for draws, there in shown.items() if there] or [_orbit]
    names = [draws.__name__ for draws in panels]
    rows = [names] if len(names) < 3 else [names[:2], names[2:] * (1 + (len(names) == 3))]
    title = "Periodic steady state by shooting"
    layout = {"height_ratios": (6, 5)} if len(rows) > 1 else {}
    figure, ax = study_page(study, 11, 1.2 + 2.9 * len(rows), rows, title, bold=answer["verdict"][0], **layout)
    for draws in panels:
        draws(ax[draws.__name__], answer)
    return save(figure, out_path)


def _orbit(ax, answer):
    if not answer.get("orbit"):
        return _defects(ax, answer)
    x, y = (1e6 * np.array(answer["orbit"][f"relative_tilt_{axis}"]) for axis in "xy")
    unit, finer = fitting("µrad", float(np.max(np.hypot(x, y))))
    x, y = finer * x, finer * y
    ax.plot(x, y, color=TILT)
    ax.plot(x[0], y[0], "o", color=MARK, ms=4, label="shaft angle 0")
    ax.plot(0, 0, "+", color=GREY)
    ax.set_aspect("equal", "datalim")
    title = "Orbit of the relative tilt" if answer["period"] else "Relative tilt over the last turns"
    ax.set(title=title, xlabel=f"tilt about x, {unit}", ylabel=f"tilt about y, {unit}")
    ax.legend(loc="upper right")


def _defects(ax, answer):
    """Why there is no orbit: what Newton's method left at each step."""
    left = answer.get("defects")
    if not left:
        return absent(ax, "Orbit of the relative tilt", answer.get("reason") or "no periodic orbit")
    ax.semilogy(np.arange(1, len(left) + 1), left, "o-", color=CONTACT)
    ax.set(title="Newton's method on the period map", xlabel="step", ylabel="defect over one period, scales")
    ax.set_xlim(0.5, len(left) + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(8, integer=True, min_n_ticks=1))


def _film(ax, answer):
    linear = answer.get("linear") or {}
    if not answer.get("orbit"):
        if "h_min" not in linear:
            return absent(ax, "Smallest film thickness", "no periodic orbit")
        ax.plot(1e3 * np.array(linear["time"]), 1e6 * np.array(linear["h_min"]), color=THEORY)
        ax.axhline(0, color=CONTACT, lw=1.2)
        return ax.set(title="Smallest film thickness of linear theory", xlabel="time, ms", ylabel="h_min, µm")
    ax.plot(1e3 * np.array(answer["orbit"]["time"]), 1e6 * np.array(answer["orbit"]["h_min"]), color=FILM)
    title = "Smallest film thickness over " + ("one period" if answer["period"] else "the last turns")
    ax.set(title=title, xlabel="time, ms", ylabel="h_min, µm")


def _multipliers(ax, answer):
    found, name = answer.get("multipliers"), "Floquet multipliers"
    if not found:
        found, name = (answer.get("linear") or {}).get("multipliers"), "Multipliers of linear theory"
    if not found:
        return absent(ax, name, "no period, no multipliers")
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    ax.plot(circle.real, circle.imag, color=GREY, lw=0.8)
    real, imaginary = np.array(found).T
    largest = np.max(np.hypot(real, imaginary))
    ax.plot(real, imaginary, "o", color=TILT if largest < 1.0 else CONTACT, ms=5, mfc="none", mew=1.3)
    ax.set_aspect("equal", "datalim")
    ax.set(title=f"{name}: largest {largest:.3g}", xlabel="real part", ylabel="imaginary part")


def _cost(ax, answer):
    rows, title = done(answer.get("near_threshold", [])), "Cost near the threshold"
    if not rows:
        return absent(ax, title, "no critical speed, or not asked for" if answer.get("orbit") else "no periodic orbit")
    away, cost = np.array([1 - row["part"] for row in rows]), np.array([row["shooting"] for row in rows])
    ax.loglog(away, cost, "o-", color=TILT, label="shooting")
    waited = np.array([row["transient"] or np.nan for row in rows], dtype=float)
    if np.isfinite(waited).any():
        ax.loglog(away, waited, "s--", color=THEORY, label="waiting for the transient")
    beyond = max(20 * cost.max(), 2 * np.nan_to_num(waited).max())
    # Archives of earlier versions do not hold why.
    ends = np.array([row.get("transient_ends") or "not in the periods tried" for row in rows])
    for k, why in enumerate(dict.fromkeys(ends[np.isnan(waited)])):
        failed = away[np.isnan(waited) & (ends == why)]
        ax.loglog(failed, [beyond] * len(failed), "x+1"[k], color=CONTACT, label=f"transient: {why}")
    ax.invert_xaxis()
    ax.set(title=title, xlabel="distance below the critical speed, 1 − w / w_cr", ylabel="periods integrated")
    # Above everything.
    low, high = ax.get_ylim()
    ax.set_ylim(low, high * (high / low) ** 0.45)
    logarithmic(ax, "y")
    if high > 100 * low:
        ax.yaxis.set_major_locator(LogLocator())
    ax.legend(loc="upper left")
