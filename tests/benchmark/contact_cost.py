"""What a [contact] table costs a run that never touches, and what a turn of rubbing costs.

    python tests/benchmark/contact_cost.py

The reference FMS seal without and with asperities, the same runs in turn (machines are noisy: read the ratio of the
minima); then the runout of scenarios/rub.toml, whose faces touch all the time at its end.
"""

import time
from pathlib import Path

from sealdyn.scenario.reader import parse_scenario, read_scenario
from sealdyn.simulation.simulate import prepare_run
from sealdyn.solvers.contract import Recorder
from sealdyn.solvers.integrate import solve

SCENARIOS = Path(__file__).parents[2] / "scenarios"
CONTACT = '[contact]\nroughness = "0.1 um"\ncompressive_strength = "300 MPa"\n'


def seconds(scenario):
    ready, plan = prepare_run(scenario)
    method = plan.method
    begun = time.perf_counter()
    outcome = solve(ready, method, scenario.run.accuracy, Recorder())
    return time.perf_counter() - begun, outcome, ready


def open_film():
    text = (SCENARIOS / "fms_reference.toml").read_text()
    plain, touching = (parse_scenario(t, "fms", ["run.turns=400"]) for t in (text, text + CONTACT))
    seconds(plain), seconds(touching)
    pairs = [(seconds(plain), seconds(touching)) for _ in range(15)]
    without, with_table = (min(pair[i][0] for pair in pairs) for i in (0, 1))
    counts = [pairs[0][i][1].counts for i in (0, 1)]
    each = [1e6 * t / c.rhs for t, c in zip((without, with_table), counts, strict=True)]
    print(f"400 turns, never touching: {without * 1e3:.1f} ms without, {with_table * 1e3:.1f} ms with the table, "
          f"ratio {with_table / without:.3f}")  # fmt: skip
    print(f"  right-hand sides {counts[0].rhs} and {counts[1].rhs}; {each[0]:.2f} and {each[1]:.2f} us each, all in")


def rubbing():
    found = {}
    for turns in (80, 160):
        scenario = read_scenario(SCENARIOS / "rub.toml", [f"run.turns={turns}"])
        seconds(scenario)
        found[turns] = min((seconds(scenario) for _ in range(3)), key=lambda run: run[0])
    wall = (found[160][0] - found[80][0]) / 80
    calls = (found[160][1].counts.rhs - found[80][1].counts.rhs) / 80
    print(f"rubbing all the time (accuracy 1e-5): {wall * 1e3:.2f} ms and {calls:.0f} right-hand sides a turn, "
          f"{wall / calls * 1e6:.1f} us each; energy residual {found[160][1].energy_residual:.1e}")  # fmt: skip


if __name__ == "__main__":
    open_film()
    rubbing()
