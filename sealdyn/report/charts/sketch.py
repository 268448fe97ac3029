"""The seal in half section: radii to scale, lengths along the shaft as drawn by hand, cone and clearance enlarged."""

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from .page import look, save, sheet
from .palette import BLACK, CONTACT, GREY, PALE, RING, SKY
from .record import Run

# Along the shaft, in widths of the face: length of a ring, clearance, cone, room for a support.
LONG, CLEARANCE, CONE, ROOM = 1.2, 0.08, 0.14, 1.0
COIL = (0, 0, 1, -1, 1, -1, 1, -1, 1, -1, 1, 0, 0)


@look()
def draw(archive_path, out_path):
    """The figure alone."""
    figure = sheet(6.0, 4.4)
    panel(figure.add_axes((0.1, 0.12, 0.87, 0.78)), Run(archive_path))
    return save(figure, out_path)


def panel(ax, run: Run) -> None:
    """Rings, film, supports, secondary seals and balance radius over the radius (mm)."""
    inner, outer = 1e3 * run.film("inner_radius"), 1e3 * run.film("outer_radius")
    width = outer - inner
    cone = np.sign(run.film("coning") or 0.0) * CONE * width
    near, far = CLEARANCE * width + max(0.0, -cone), CLEARANCE * width + max(0.0, cone)
    back = CLEARANCE * width + CONE * width + LONG * width
    ax.add_patch(Polygon([(0, inner), (near, inner), (far, outer), (0, outer)], fc=SKY, alpha=0.5, lw=0))
    ax.add_patch(Rectangle((-LONG * width, inner), LONG * width, width, fc=RING["rotor"], alpha=0.75, ec=BLACK))
    stator = [(near, inner), (far, outer), (back, outer), (back, inner)]
    ax.add_patch(Polygon(stator, fc=RING["stator"], alpha=0.75, ec=BLACK))
    ends = {"rotor": (-LONG * width, -1), "stator": (back, 1)}
    low, high = inner, outer
    for ring, (end, way) in ends.items():
        ax.text(end - way * 0.5 * LONG * width, inner + 0.5 * width, ring, ha="center", va="center", rotation=90)
        low, high = _held(ax, run, ring, end, way, width, low, high)
    low, high = _balance(ax, run, inner, outer, back, low, high)
    for key, radius, side in (("outer_pressure", outer, "bottom"), ("inner_pressure", inner, "top")):
        pressure = run.film(key)
        if pressure is not None:
            words = f"  {1e-5 * pressure:.4g} bar"
            offset = 0.06 * width * (1 if side == "bottom" else -1)
            ax.text(0.5 * near, radius + offset, words, ha="center", va=side, fontsize=8)
    reach = LONG + 1.3 * ROOM
    ax.set(xlim=(-reach * width, back + 1.3 * ROOM * width), ylim=(low - 0.5 * width, high + 0.5 * width))
    ax.set(ylabel="radius, mm", xticks=[], title="Radii to scale; cone and clearance enlarged")
    ax.grid(axis="x", visible=False)


def _held(ax, run: Run, ring: str, end: float, way: int, width: float, low: float, high: float):
    """What carries a ring: a spring at the radius of its support, or nothing that gives; its secondary seal."""
    table = run.resolved.get(ring) or {}
    support, seal = table.get("support"), table.get("secondary_seal")
    wall = end + way * ROOM * width
    middle = 0.5e3 * (run.film("inner_radius") + run.film("outer_radius"))
    if support:
        radius = 1e3 * support["radius"]
        along = np.linspace(end, wall, 13)
        ax.plot(
            along, radius + 0.09 * width * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, -1, 1, 0, 0]), color=BLACK, lw=1.2
        )
        ax.plot([wall, wall], [radius - 0.4 * width, radius + 0.4 * width], color=BLACK, lw=2.5)
        ax.text(0.5 * (end + wall), radius + 0.16 * width, f"support, r {radius:.4g}", ha="center", fontsize=7.5)
        low, high = min(low, radius - 0.4 * width), max(high, radius + 0.4 * width)
    else:
        ax.add_patch(Rectangle((min(end, wall), middle - 0.5 * width), ROOM * width, width, fc=PALE, ec=GREY))
        fixed = "on the shaft" if ring == "rotor" else "in the housing"
        ax.text(0.5 * (end + wall), middle, fixed, ha="center", va="center", fontsize=7.5, rotation=90)
    if seal:
        radius = 1e3 * seal["radius"]
        ax.plot(end - way * 0.3 * LONG * width, radius, "o", ms=11, color=BLACK)
        ax.text(
            end - way * 0.3 * LONG * width, radius + 0.2 * width, f"O-ring, r {radius:.4g}", ha="center", fontsize=7.5
        )
        low, high = min(low, radius), max(high, radius)
    return low, high


def _balance(ax, run: Run, inner: float, outer: float, back: float, low: float, high: float):
    """The radius at which the closing pressure ends, from the balance ratio and the side of the higher pressure."""
    ratio = (run.summary.get("closing") or {}).get("balance_ratio")
    pressures = [run.film(key) for key in ("outer_pressure", "inner_pressure")]
    if ratio is None or None in pressures or pressures[0] == pressures[1]:
        return low, high
    area = ratio * (outer**2 - inner**2)
    square = outer**2 - area if pressures[0] > pressures[1] else inner**2 + area
    if square <= 0:
        return low, high
    radius = square**0.5
    ax.axhline(radius, color=CONTACT, lw=0.9, ls="--")
    ax.set_xlabel(f"dashed: balance radius {radius:.4g} mm, balance ratio {ratio:.3g}", fontsize=8, color=CONTACT)
    return min(low, radius), max(high, radius)
