"""Periodic steady state: the orbit with its once-per-turn mark, Floquet multipliers, and what waiting would cost."""

import numpy as np

from ...archive import read_study
from .page import absent, heading, look, save, sheet
from .palette import CONTACT, FILM, GREY, MARK, THEORY, TILT


def draw(archive_path, out_path):
    """Four panels from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    with look():
        figure = sheet(11, 7)
        heading(
            figure, "Periodic steady state by shooting", f"{study['name']}: {study['question']}", answer["verdict"][0]
        )
        _orbit(figure.add_axes((0.07, 0.50, 0.36, 0.34)), answer)
        _film(figure.add_axes((0.07, 0.09, 0.36, 0.29)), answer)
        _multipliers(figure.add_axes((0.54, 0.50, 0.40, 0.34)), answer)
        _cost(figure.add_axes((0.54, 0.09, 0.40, 0.29)), answer)
        return save(figure, out_path)


def _orbit(ax, answer):
    if not answer.get("orbit"):
        return absent(ax, "Orbit of the relative tilt", "no common period")
    waves = answer["orbit"]
    x, y = 1e6 * np.array(waves["relative_tilt_x"]), 1e6 * np.array(waves["relative_tilt_y"])
    ax.plot(x, y, color=TILT)
    ax.plot(x[0], y[0], "o", color=MARK, ms=4, label="shaft angle 0")
    ax.plot(0, 0, "+", color=GREY)
    ax.set_title("Orbit of the relative tilt")
    ax.set_aspect("equal", "datalim")
    ax.set_xlabel("tilt about x, µrad")
    ax.set_ylabel("tilt about y, µrad")
    ax.legend(loc="upper right")


def _film(ax, answer):
    if not answer.get("orbit"):
        return absent(ax, "Smallest film thickness", "no common period")
    waves = answer["orbit"]
    ax.plot(1e3 * np.array(waves["time"]), 1e6 * np.array(waves["h_min"]), color=FILM)
    ax.set_title("Smallest film thickness over one period")
    ax.set_xlabel("time, ms")
    ax.set_ylabel("h_min, µm")


def _multipliers(ax, answer):
    if not answer.get("multipliers"):
        return absent(ax, "Floquet multipliers", "no periodic orbit")
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    ax.plot(circle.real, circle.imag, color=GREY, lw=0.8)
    points = np.array(answer["multipliers"])
    colour = TILT if answer["stable"] else CONTACT
    ax.plot(points[:, 0], points[:, 1], "o", color=colour, ms=5, mfc="none", mew=1.3)
    ax.set_aspect("equal", "datalim")
    ax.set_title(f"Floquet multipliers: largest {np.max(np.hypot(*points.T)):.3g}")
    ax.set_xlabel("real part")
    ax.set_ylabel("imaginary part")


def _cost(ax, answer):
    rows = [row for row in answer["near_threshold"] if "failed" not in row]
    title = "Cost near the threshold"
    if not rows:
        return absent(ax, title, "no critical speed, or not asked for")
    away = np.array([1 - row["part"] for row in rows])
    ax.loglog(away, [row["shooting"] for row in rows], "o-", color=TILT, label="shooting")
    waited = [(a, row["transient"]) for a, row in zip(away, rows, strict=True) if row["transient"]]
    if waited:
        ax.loglog(*zip(*waited, strict=True), "s--", color=THEORY, label="waiting for the transient")
    failed = [a for a, row in zip(away, rows, strict=True) if not row["transient"]]
    if failed:
        top = max(row["shooting"] for row in rows) * 20
        ax.loglog(failed, [top] * len(failed), "x", color=CONTACT, label="transient: not in the periods tried")
    ax.invert_xaxis()
    ax.set_title(title)
    ax.set_xlabel("distance below the critical speed, 1 − w / w_cr")
    ax.set_ylabel("periods integrated")
    ax.legend(loc="upper left")
