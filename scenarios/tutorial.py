"""From nothing to an answered question: a pump seal that leaks too much, and what to do about it.

    python tutorial.py          # in an empty folder; some ten seconds, a minute or so more the first time

Editors that know cells run it piece by piece at the marks `# %%`.  The number that a line should give stands behind it.
In a shell the same is done by `sealdyn new fms`, `sealdyn check fms.toml`, `sealdyn run fms.toml` and their like.
"""

import math
from pathlib import Path

from scipy.optimize import minimize_scalar

import sealdyn
from sealdyn.scenario.templates import template


def about(number: float, expected: float, within: float = 1e-3) -> bool:
    """Whether a number is what stands behind it, but for rounding."""
    return math.isclose(number, expected, rel_tol=within)


# %% 1. A scenario to begin with: a stator on springs (FMS) in water of 11 bar, a rotor with runout.
Path("fms.toml").write_text(template("fms"))
seal = sealdyn.read_scenario("fms.toml")
print(seal.question)
assert seal.scene.stator.support and not seal.scene.rotor.support

# %% 2. Check: everything is in SI; what cannot be is said in a line that names the key and what is expected.
checked = sealdyn.check(seal)
print(checked["clearance"])  # 2.39e-06 m: the closing force decides
assert about(checked["clearance"], 2.3897e-6)

try:
    seal.with_({"film.outer_radius": "36 bar"})
except sealdyn.ScenarioError as error:
    print(error)
    assert error.key == "film.outer_radius"

# %% 3. Run: thirty turns of the shaft, with a certificate of how exact they are.
first = sealdyn.run(seal, out="outputs/first.h5")
told = first.summary
print(first.status, told["certificate"]["said"])
print(told["h_min"]["value"])  # 2.386e-06 m: the faces stay apart
print(told["relative_misalignment"]["steady_max"])  # 1.278e-07 rad of 278 urad of runout: the stator follows
print(told["stability"]["verdict"], told["stability"]["critical_speed"])  # stable up to 38850 rad/s
print(told["leakage"]["mean_ml_per_h"])  # 916 ml/h: far too much
print(told["friction"]["power"])  # 20.6 W
assert first.status == "ok" and told["certificate"]["met"] and told["stability"]["verdict"] == "stable"
assert about(told["h_min"]["value"], 2.3858e-6) and about(told["relative_misalignment"]["steady_max"], 1.278e-7, 0.01)
assert about(told["leakage"]["mean_ml_per_h"], 916.0) and about(told["friction"]["power"], 20.64)

# %% 4. Look: a figure, and the series behind it as an xarray Dataset with units.
first.plot.overview().savefig("outputs/first.png")
print(first.data.h_min.attrs["units"], first.data.sizes)  # m, 1921 instants
assert first.data.sizes["time"] == 30 * 64 + 1 and Path("outputs/first.png").exists()

# %% 5. Change: less coning lets the faces closer, which leaks less and rubs the water more.
wanted = ["h_min.value", "leakage.mean_ml_per_h", "friction.power"]
flatter = sealdyn.evaluate(seal, {"film.coning": "0.3 mrad"}, wanted)
print(flatter)  # 0.717 um, 24.7 ml/h (0.3^3 of what it was), 68.8 W
assert about(flatter["leakage.mean_ml_per_h"], 24.73) and about(flatter["friction.power"], 68.8)

# %% 6. Sweep: coning and balance ratio together, a row of the table for each of twelve runs.
table = sealdyn.sweep(
    seal, {"film.coning": [3e-4, 6e-4, 1e-3], "closing.balance_ratio": [0.7, 0.75, 0.8, 0.85]}, wanted
)
print(table)
print(table.loc[(6e-4, 0.85), "leakage.mean_ml_per_h"])  # 24.2 ml/h
assert len(table) == 12 and set(table["status"]) == {"ok"}
assert about(table.loc[(6e-4, 0.85), "leakage.mean_ml_per_h"], 24.19)


# %% 7. Optimise, with scipy: which balance ratio, if 100 ml/h of leakage are as bad as 30 W of friction?
def cost(balance_ratio: float) -> float:
    """What leaks and what rubs, weighed."""
    found = sealdyn.evaluate(seal, {"closing.balance_ratio": balance_ratio}, wanted)
    return found["leakage.mean_ml_per_h"] / 100 + found["friction.power"] / 30


best = minimize_scalar(cost, bounds=(0.75, 0.95), method="bounded", options={"xatol": 1e-4})
print(best.x, best.fun)  # 0.900, 1.662
assert best.success and about(best.x, 0.900, 0.01) and about(best.fun, 1.6617)

better = seal.with_({"closing.balance_ratio": round(best.x, 2)})
Path("better.toml").write_text(better.to_toml())
second = sealdyn.run(better, out="outputs/better.h5")
print(second.summary["leakage"]["mean_ml_per_h"])  # 21.7 ml/h
print(second.summary["friction"]["power"])  # 43.3 W
print(*second.summary["warnings"], sep="\n")  # so little water cannot carry that heat: the rings must
assert about(second.summary["leakage"]["mean_ml_per_h"], 21.74) and about(second.summary["friction"]["power"], 43.33)
assert any("isothermal" in warning for warning in second.summary["warnings"])

# %% 8. A study: is it stable, at other speeds too, and with less damping in its support?
answer = sealdyn.study("stability", better, out="outputs/better-stability.h5")
print(*answer.verdict, sep="\n")  # stable, up to 61969 rad/s, 201 times its own speed
answer.plot().savefig("outputs/better-stability.png")
growth = answer.data["growth_rate"]
print(growth.sizes, float(growth.min()))  # over damping and speed, as far as the threshold and beyond
assert answer.status == "ok" and float(growth.min()) < 0.0 and "stable" in answer.verdict[0]

# %% 9. Design rules of helicopter seals, NASA CR-120997: experience with oil in gearboxes, no law for water.
rules = sealdyn.design_rules("better.toml")
broken = [rule["rule"] for rule in rules if rule["verdict"] == "fail"]
print(broken)  # face_pressure (the spring is weak for an oil seal), leakage (5 ml/h are allowed)
assert broken == ["face_pressure", "leakage"]

# %% 10. What the change has changed, and a page for the review, which opens anywhere.
changed = sealdyn.compare("outputs/first.h5", "outputs/better.h5")["scene"]
print(*(f"{row['key']}: {row['values']}" for row in changed), sep="\n")  # closing.balance_ratio: [..., 0.9]
assert [row["key"] for row in changed] == ["closing.balance_ratio"]
sealdyn.review(["outputs/first.h5", "outputs/better.h5", "outputs/better-stability.h5"], "review.html")
assert "better" in Path("review.html").read_text(encoding="utf-8")
print("the page is review.html")

# %% 11. Step by step, as a controller or another program does: slower, until the film takes 30 W.
steps = sealdyn.Simulation(better)
state = steps.state
while state["friction_power"] > 30.0:
    steps.set(shaft_speed=0.99 * state["shaft_speed"])
    state = steps.step(1e-3)
print(steps.time, state["shaft_speed"])  # 19 ms, 255 rad/s; power goes with the square of the speed
assert about(state["shaft_speed"], 308.923 * 0.99 ** round(steps.time / 1e-3))
