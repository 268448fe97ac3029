"""Ludwig & Allen (1976): films of their example and the sealing number over F_s/F_d, against three methods.

Formula: closed_form's.  Static: the root of force and sine moment on the radial film.  Time domain: the same balance
with squeeze, by IDA, from 2 % above until it settles.
"""

import math

import numpy as np

from ...closed_form import ludwig_allen as closed
from .. import quasi_static

TITLE = "Ludwig & Allen (1976), NASA TN D-8102; radial film, planar, half-Sommerfeld; films in um"
FILM = "radial"
COVERS = "film thickness and motion of a ring held by secondary-seal friction (FMR)"
COLUMNS = {"F_s/F_d": "force_ratio", "quantity": "quantity", "published": "published", "formula": "formula",
           "static": "static", "time domain": "time_domain", "deviation": "deviation",
           "verdict": "verdict"}  # fmt: skip

SOURCE, CURVE = "Ludwig & Allen (1976), example", "Ludwig & Allen (1976), Fig. 8"
# The curve of the sealing number, over the force ratios of practice; films of the example whose print is not held.
RATIOS, UNHELD = (2.0, 3.0, 5.0, 10.0, 15.0, 20.0), (10.0, 15.0)
# The methods must agree to this, relative: the arm of a face of finite width is longer by dR^2/(20 R^2), which moves
# the films by up to 7e-5.
TOLERANCE = 3e-4
# One unit of the last printed digit (m); how far above its balance the film starts.
LAST_DIGIT, ABOVE = 0.01e-6, 1.02
NOT_HELD = "no printed number held: the formula against the film"


def checks() -> list[dict]:
    """The films printed and points of the curve: besides what every source has force_ratio and the three methods,
    formula, static and time_domain; films in m."""
    found = {q: _films(q) for q in RATIOS}
    rows = []
    for entry in closed.LUDWIG_ALLEN:
        films = found[entry.force_ratio]
        rows.append(_row(SOURCE, entry.force_ratio, "mean_film", entry.mean_film, films[:, 0]))
        if entry.least_film is not None:
            rows.append(_row(SOURCE, entry.force_ratio, "least_film", entry.least_film, films[:, 0] - films[:, 1]))
    rows += [_row(SOURCE, q, "mean_film", None, found[q][:, 0]) for q in UNHELD]
    numbers = {q: films[:, 0] ** 2 / closed.LUDWIG_ALLEN_GROUP for q, films in found.items()}
    return rows + [_row(CURVE, q, "sealing_number", None, number) for q, number in numbers.items()]


def _films(q: float) -> np.ndarray:
    """h0, h1 (m) by the three methods, (3, 2); NaN where one finds none."""
    ring = quasi_static.Ring()
    formula = closed.equilibrium(q, ring.group)
    start = ABOVE * np.array(formula)
    try:
        static = quasi_static.static_root(q, start, ring)
    except ValueError:
        static = (math.nan, math.nan)
    run = quasi_static.quasi_static(q, start, ring)
    settled = run.films if run.status == "settled" else (math.nan, math.nan)
    return np.array([formula, static, settled])


def _row(source, q, quantity, published, values) -> dict:
    formula, static, time_domain = (None if math.isnan(value) else float(value) for value in values)
    apart = float(np.max(np.abs(values / values[0] - 1)))
    row = {
        "source": source,
        "force_ratio": q,
        "quantity": quantity,
        "published": published,
        "formula": formula,
        "static": static,
        "time_domain": time_domain,
        "deviation": None if published is None else formula / published - 1,
        "roads_apart": None if math.isnan(apart) else apart,
        "verdict": "agrees",
        "remark": "",
    }
    if not apart <= TOLERANCE:
        return row | {"verdict": "FAILED", "remark": "the three methods disagree, or one finds no film"}
    if published is None:
        return row | {"remark": NOT_HELD}
    # The example's inputs are lost; what stands for them was recovered from these prints.
    if abs(formula - published) > 1.0001 * LAST_DIGIT:
        return row | {"verdict": "FAILED", "remark": "not the printed film"}
    return row


def shown(row: dict) -> dict:
    """A row with its films in um."""
    films = () if row["quantity"] == "sealing_number" else ("published", "formula", "static", "time_domain")
    return row | {name: 1e6 * row[name] for name in films if row[name] is not None}


def place(row: dict) -> str:
    """Which line a remark speaks of."""
    return f"F_s/F_d={row['force_ratio']:g} {row['quantity'].replace('_', ' ')}"
