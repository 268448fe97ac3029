"""Waves on an elastic ring that a drive bends: which of them, left under load, carry most, and on how stiff a ring.

    initial = | net - c(E J) H(net) |,   c and what the drive makes both go with 1/(E J)

The load H on a wave follows from the waves that are left alone: one curve of it for each order answers for all rings.
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 3, eqs. 3-6 to 3-12 and Figs. 3-11 to 3-13.
**Valid** as dynamics/elastic_ring.py; one torsion ratio for all rings.
"""

import numpy as np
from scipy.interpolate import CubicSpline

READ = ("load_support", "friction_coefficient", "leakage", "clearance")
# Places of a curve between the balances that are computed.
PLACES = 20_001


def joined(compliance: float, rows: list[dict]) -> dict[str, np.ndarray]:
    """Operating points of a ring of one `compliance` (m/N) as dicts, along which `net` waviness rises, joined by cubic
    splines over its logarithm: `net` (m) evenly, READ, and the harmonic of the `load` (N, complex) there."""
    net, initial, turned = (np.array([row[name] for row in rows]) for name in ("net", "initial", "turned"))
    load = (net - initial * np.exp(-1j * turned)) / compliance
    along = np.linspace(*np.log(net[[0, -1]]), PLACES)
    read = {name: [row[name] for row in rows] for name in READ}
    columns = CubicSpline(np.log(net), np.stack([load.real, load.imag, *read.values()], axis=1))(along).T
    return {"net": np.exp(along), "load": columns[0] + 1j * columns[1], **dict(zip(read, columns[2:], strict=True))}


def design(ring, order: int, curve, limit: float | None = None) -> dict:
    """The waviness of most load support on a `ring` among the stable ones that its drive can make (any, without one)
    and that leak at most the `limit` (m^3/s): net, initial and READ (None where there is none), what limits it;
    `drivable`, `fold`, where the smallest waves that hold end, `holds_again` (None where all hold), and the
    `largest_stable` net waviness that the drive can make."""
    net = curve["net"]
    initial = np.abs(net - ring.compliance(order) * curve["load"])
    drivable = ring.driven(order) or None
    rising = np.append(np.diff(initial) > 0.0, True)
    rising[-1] = rising[-2]
    makes = initial <= (np.inf if drivable is None else drivable)
    leaks = curve["leakage"] > (np.inf if limit is None else limit)
    turns = np.flatnonzero(np.diff(rising.astype(int)))
    fold = next((i for i in turns if rising[i]), None)
    again = next((i for i in turns if not rising[i]), None)
    holds = np.flatnonzero(rising & makes)
    good = np.flatnonzero(rising & makes & ~leaks)
    out = {"stiffness": ring.bending_stiffness, "drivable": drivable,
           "fold": None if fold is None else float(net[fold]),
           "holds_again": None if again is None else float(net[again]),
           "largest_stable": float(net[holds[-1]]) if len(holds) else None}  # fmt: skip
    if not len(good):
        return out | dict.fromkeys(("net", "initial", *READ)) | {"limited_by": "drive" if not len(holds) else "leakage"}
    best = good[np.argmax(curve["load_support"][good])]
    following = min(best + 1, len(net) - 1)
    limits = {"range": following == best, "drive": not makes[following], "fold": not rising[following],
              "leakage": leaks[following]}  # fmt: skip
    limited_by = next((name for name, there in limits.items() if there), "nothing")
    return out | {"net": float(net[best]), "initial": float(initial[best]), "limited_by": limited_by,
                  **{name: float(curve[name][best]) for name in READ}}  # fmt: skip


def stiffest(ring, order: int, curve, limit: float | None) -> dict:
    """The waviness of most load support that leaks at most the `limit` (m^3/s) on any ring, and the bending stiffness
    (N m^2) of the `stiffest` ring that the drive of `ring` can still bend there: |E J net - c load| = d.  None where
    there is none, or no drive."""
    allowed = np.flatnonzero(curve["leakage"] <= (np.inf if limit is None else limit))
    if not len(allowed):
        return {"stiffest": None, "net": None, "load_support": None}
    best = allowed[np.argmax(curve["load_support"][allowed])]
    net, load = curve["net"][best], curve["load"][best]
    pushed = ring.bending_stiffness * ring.compliance(order) * load
    drive = ring.bending_stiffness * ring.driven(order)
    roots = np.roots([net**2, -2.0 * net * pushed.real, abs(pushed) ** 2 - drive**2])
    real = [root.real for root in roots if root.imag == 0.0 and root.real > 0.0]
    return {"stiffest": float(max(real)) if real and drive else None, "net": float(net),
            "load_support": float(curve["load_support"][best])}  # fmt: skip
