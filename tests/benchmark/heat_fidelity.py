"""What a rung of heat costs and how near it comes: isothermal, two numbers a ring from the fin's closed form (rung 1),
two numbers from the drawing (rung 2), both rings by finite elements and a film of local temperature (full).

    python tests/benchmark/heat_fidelity.py

Four liquid seals; errors in clearance and leakage of the working state beside the full one, processor time (s) with
kernels loaded.  Writes outputs/gallery/heat_fidelity.png and heat_fidelity.json.
"""

import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

sys.path.insert(0, str(Path(__file__).parents[1] / "ladder"))

import matplotlib.pyplot as plt
import own_warm
from oracles import ring_fin
from test_warm_seals_whole import SEALS
from warm_seals import OIL, ROUGH, warm_seal

from sealdyn.dynamics.warm_state import Warming
from sealdyn.faces.ring_heat import conduction, ring_heat

GALLERY = Path(__file__).parents[2] / "outputs" / "gallery"
CHANGES = {"pump, 400 urad": {"film.coning": 4e-4}, "pump, 50 urad": {}, "pump_seal": ROUGH, "oil": OIL}
RUNGS = "isothermal", "rung 1", "rung 2", "full"
TRIALS = 3


def numbers(body) -> dict:
    """What the fin says of a ring."""
    solid = {key: getattr(body, key) for key in ("conductivity", "expansion", "poisson", "density", "specific_heat")}
    fin = ring_fin(body.inner_radius, body.outer_radius, body.length, **solid, convection=body.convection)
    return dict(zip(("resistance", "coning_per_watt", "time_constant"), map(float, fin), strict=True))


def drawing(body) -> dict:
    return {"convection": body.convection, "wetted_length": body.wetted_length, "wet": "outer"}


def scene(name, heat) -> object:
    """A seal with `heat` of each ring's RingBody, its bodies drawn."""
    changes = {**CHANGES[name], "stator": {"support": {"axial_stiffness": 3e4, "axial_damping": 50.0, "radius": 0.03}}}
    for ring, body in zip(("stator", "rotor"), SEALS[name].rings, strict=True):
        solid = ("inner_radius", "outer_radius", "length", "density", "modulus", "poisson", "expansion",
                 "conductivity", "specific_heat")  # fmt: skip
        changes[ring] = {**changes.get(ring, {}), "body": {key: getattr(body, key) for key in solid}}
    changes["film.heat"] = {r: heat(b) for r, b in zip(("stator", "rotor"), SEALS[name].rings, strict=True)}
    return warm_seal(changes).scene


def timed(find):
    """The answer, and the least processor time of some trials."""
    spent = []
    for _ in range(TRIALS):
        for kept in (ring_heat, conduction):
            kept.cache_clear()
        begun = time.process_time()
        answer = find()
        spent.append(time.process_time() - begun)
    return answer, min(spent)


def rows() -> list[dict]:
    """Name, rung, clearance (m), leakage (m^3/s), their errors and the processor time (s)."""
    found = []
    for name, seal in SEALS.items():
        fin, drawn = scene(name, numbers), scene(name, drawing)
        ways = {
            "isothermal": lambda drawn=drawn: Warming(drawn).cold_state,
            "rung 1": lambda fin=fin: Warming(fin).working(),
            "rung 2": lambda drawn=drawn: Warming(drawn).working(),
            "full": lambda seal=seal: own_warm.warm(seal),
        }
        each = {rung: timed(way) for rung, way in ways.items()}
        full = each["full"][0]
        for rung, (state, seconds) in each.items():
            errors = {key: abs(getattr(state, key) / getattr(full, key) - 1.0) for key in ("clearance", "leakage")}
            found.append({"seal": name, "rung": rung, "seconds": seconds, "clearance": state.clearance,
                          "leakage": state.leakage, "errors": errors})  # fmt: skip
            told = ", ".join(f"{key} {getattr(state, key):.4g} ({error:.1%})" for key, error in errors.items())
            print(f"{name:16s} {rung:10s} {seconds:8.3f} s  {told}", flush=True)
    return found


def draw(found):
    """Error over cost, a panel for clearance and one for leakage."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained", sharex=True)
    marks = dict(zip(SEALS, "osD^", strict=True))
    colours = dict(zip(RUNGS, ("C7", "C0", "C2", "C3"), strict=True))
    for panel, key in zip(panels, ("clearance", "leakage"), strict=True):
        for row in found:
            if row["rung"] != "full":
                panel.loglog(row["seconds"], 100 * row["errors"][key], marks[row["seal"]], color=colours[row["rung"]],
                             markersize=9, markeredgecolor="white")  # fmt: skip
        costs = [row["seconds"] for row in found if row["rung"] == "full"]
        panel.axvspan(min(costs), max(costs), color=colours["full"], alpha=0.25, lw=0)
        panel.set(xlabel="processor time, s", ylabel=f"error of the {key}, %", title=key.capitalize())
        panel.grid(alpha=0.3)
    handles = [plt.Line2D([], [], marker=m, ls="", color="0.3", label=name) for name, m in marks.items()]
    handles += [plt.Line2D([], [], marker="s", ls="", color=c, label=rung) for rung, c in colours.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=8, frameon=False, fontsize=9)
    figure.suptitle("Heat: what each rung costs and misses beside rings by finite elements")
    figure.savefig(GALLERY / "heat_fidelity.png", dpi=110)


if __name__ == "__main__":
    kept = rows()
    (GALLERY / "heat_fidelity.json").write_text(json.dumps(kept, indent=1))
    draw(kept)
