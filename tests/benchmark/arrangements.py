"""The arrangements FMS, FMR and FMSR and the film between the faces: half sections, nothing to scale.

python tests/benchmark/arrangements.py [figure.png]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, Polygon, Rectangle

STATOR, ROTOR, FIXED, FILM = "#b9cfe4", "#f3c9a5", "#d9d9d9", "#8fd3c1"
# Radii and axial places: shaft, face, housing; the rotor on the left, the stator on the right.
SHAFT, INNER, OUTER, HOUSING = 0.7, 1.3, 2.5, 3.1
FACE, CLEARANCE, OPEN = 2.2, 0.12, 0.22


def spring(axes, start, stop, height):
    """A spring along the shaft."""
    x = np.linspace(start, stop, 9)
    y = height + 0.1 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    axes.plot(x, y, color="black", lw=1.2)
    axes.text((start + stop) / 2, height + 0.2, "support", ha="center", fontsize=8)


def o_ring(axes, x, height):
    """A secondary seal."""
    axes.add_patch(Circle((x, height), 0.3, fc="#555555", ec="black"))
    axes.text(x + 0.4, height, "O-ring", va="center", fontsize=8)


def arrangement(axes, name, words, floats):
    """Half section of one arrangement; `floats` names the rings on springs."""
    axes.set_title(f"{name}: {words}", fontsize=11, loc="left")
    axes.add_patch(Rectangle((0, 0), 5.4, SHAFT, fc=FIXED, ec="black"))
    axes.plot([-0.2, 5.6], [0, 0], "-.", color="black", lw=0.8)
    axes.text(2.7, SHAFT / 2, "shaft", ha="center", va="center")
    axes.add_patch(
        Polygon([(0, 3.5), (5.4, 3.5), (5.4, 1), (5.1, 1), (5.1, HOUSING), (0, HOUSING)], fc=FIXED, ec="black")
    )
    axes.text(1.2, 3.3, "housing", ha="center", va="center")
    back = FACE - 0.8
    axes.add_patch(Rectangle((back, INNER), 0.8, OUTER - INNER, fc=ROTOR, ec="black"))
    axes.text(back + 0.4, 1.9, "rotor", ha="center", va="center", rotation=90)
    front, top = FACE + CLEARANCE, FACE + CLEARANCE + OPEN
    axes.add_patch(Polygon([(front, INNER), (top, OUTER), (3.3, OUTER), (3.3, INNER)], fc=STATOR, ec="black"))
    axes.text(2.98, 1.9, "stator", ha="center", va="center", rotation=90)
    axes.add_patch(Polygon([(FACE, INNER), (front, INNER), (top, OUTER), (FACE, OUTER)], fc=FILM, ec="none"))
    if "rotor" in floats:
        axes.add_patch(Rectangle((0.2, SHAFT), 0.3, 1.5, fc=FIXED, ec="black"))
        spring(axes, 0.5, back, 1.9)
        o_ring(axes, back + 0.4, 1.0)
    else:
        axes.add_patch(Rectangle((back, SHAFT), 0.8, INNER - SHAFT, fc=ROTOR, ec="black"))
    if "stator" in floats:
        spring(axes, 3.3, 5.1, 1.9)
        o_ring(axes, 2.98, 2.8)
    else:
        axes.add_patch(Rectangle((3.3, INNER), 1.8, OUTER - INNER, fc=STATOR, ec="black"))
    axes.set(xlim=(-0.3, 5.7), ylim=(-0.5, 3.7), aspect="equal")
    axes.axis("off")


def film(axes):
    """The film, widened: clearance, coning, tilt, radii, pressures."""
    axes.set_title("Film, widened", fontsize=11, loc="left")
    low, high, tilt, cone = 0.6, 3.0, 0.25, 0.9
    axes.add_patch(Rectangle((0, low), 1, high - low, fc=ROTOR, ec="black"))
    axes.add_patch(Polygon([(1.8, low), (1.8 + cone, high), (4.0, high), (4.0, low)], fc=STATOR, ec="black"))
    axes.add_patch(Polygon([(1, low), (1.8, low), (1.8 + cone, high), (1, high)], fc=FILM, ec="none"))
    axes.plot([1.8, 1.8], [low, high], "--", color="black", lw=0.9)
    axes.plot([1.8 + tilt, 1.8 + cone + 2 * tilt], [low, high], ":", color="black", lw=1.4)
    axes.annotate("", (1, low - 0.12), (1.8, low - 0.12), arrowprops={"arrowstyle": "<->"})
    axes.text(1.4, low - 0.42, "clearance", ha="center", fontsize=9)
    axes.annotate("", (1.8, 2.7), (1.8 + cone * (2.7 - low) / (high - low), 2.7), arrowprops={"arrowstyle": "<-"})
    axes.text(1.7, 2.7, "coning\npositive", ha="right", va="center", fontsize=8)
    axes.annotate("tilt", (2.75, 2.1), (3.2, 2.4), arrowprops={"arrowstyle": "->"}, fontsize=9)
    axes.text(0.5, 1.8, "rotor", ha="center", rotation=90, va="center")
    axes.text(3.7, 1.3, "stator", ha="center", rotation=90, va="center")
    axes.text(1.75, high + 0.25, "outer pressure", ha="center", fontsize=9)
    axes.text(2.3, low - 0.42, "inner pressure", ha="left", fontsize=9)
    for radius, name in ((low, "inner radius"), (high, "outer radius")):
        axes.plot([4.05, 4.35], [radius, radius], color="black", lw=0.8)
        axes.text(4.4, radius, name, va="center", fontsize=9)
    axes.annotate("z", (0.0, -0.3), (0.9, -0.3), arrowprops={"arrowstyle": "<-"}, va="center")
    axes.set(xlim=(-0.2, 5.9), ylim=(-0.5, 3.7), aspect="equal")
    axes.axis("off")


def main():
    figure, axes = plt.subplots(1, 4, figsize=(16, 3.4), layout="constrained")
    arrangement(axes[0], "FMS", "stator floats", ["stator"])
    arrangement(axes[1], "FMR", "rotor floats", ["rotor"])
    arrangement(axes[2], "FMSR", "both float", ["stator", "rotor"])
    film(axes[3])
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "arrangements.png", dpi=110)


if __name__ == "__main__":
    main()
