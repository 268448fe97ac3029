"""Colours that colour-blind readers tell apart.

**Source** Okabe and Ito (2008), Color Universal Design; the map for film thickness is cividis
(Nunez, Anderton and Renslow, 2018), that for pressure viridis (van der Walt and Smith, 2015).
"""

from ...status import Status

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILLION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#8A8A8A"
PALE = "#D9D9D9"

THICKNESS, PRESSURE = "cividis", "viridis"

# One meaning, one colour, in every chart.
FILM, TILT, LEAK, CONTACT, THEORY, MARK = BLUE, GREEN, SKY, VERMILLION, ORANGE, BLACK
RING = {"stator": PURPLE, "rotor": BLUE}
STATUS = {Status.OK: GREEN, Status.INACCURATE: ORANGE, Status.COLLAPSED: VERMILLION, Status.FAILED: VERMILLION,
          Status.INTERRUPTED: ORANGE, Status.RUNNING: BLUE}  # fmt: skip

# Colours of lines that have no meaning of their own, in order.
CYCLE = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)
CYCLED = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh")

# Words of a style: colours by their meaning, dashes, marks.
COLOURS = {
    "film": FILM, "tilt": TILT, "leakage": LEAK, "contact": CONTACT, "theory": THEORY, **RING, **STATUS,
    "stable": GREEN, "unstable": VERMILLION, "neutral": ORANGE, "good": GREEN, "bad": VERMILLION, "warn": ORANGE,
    "black": BLACK, "grey": GREY, "pale": PALE, "blue": BLUE, "yellow": YELLOW,
}  # fmt: skip
COLOURS |= dict(zip(CYCLED, CYCLE, strict=True))
DASHES = {"dashed": (0, (5, 2)), "dotted": (0, (1, 1.5)), "dashdot": (0, (5, 2, 1, 2))}
MARKS = {"circle": "o", "square": "s", "diamond": "D", "triangle": "^", "down": "v", "cross": "x", "plus": "+",
         "star": "*", "tick": "_", "point": "."}  # fmt: skip

# Colour, line and marker of every method: the house's own in full lines, SciPy's dashed, fixed steps dotted.
LOOKS = {
    "adams": (BLUE, "-", "o"), "bdf": (GREEN, "-", "s"), "bdf2": (GREEN, "--", "D"), "ida": (PURPLE, "-", "^"),
    "expm": (BLACK, "-", "*"), "dop853": (VERMILLION, "-", "v"), "rk45": (VERMILLION, "--", "<"),
    "lsoda": (SKY, "-", "p"), "radau": (ORANGE, "-", "h"), "newmark": (GREY, "--", "P"),
    "generalised_alpha": (GREY, ":", "X"), "midpoint": (BLACK, ":", "d"), "trbdf2": (BLUE, "--", "v"),
}  # fmt: skip
SHORT = {"adams": "Adams", "bdf": "BDF", "bdf2": "BDF 2", "ida": "IDA", "dop853": "DOP853", "rk45": "RK45",
         "lsoda": "LSODA", "radau": "Radau", "newmark": "Newmark", "generalised_alpha": "gen.-α",
         "midpoint": "midpoint", "expm": "expm", "trbdf2": "TR-BDF2"}  # fmt: skip
