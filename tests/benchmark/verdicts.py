"""Are stability verdicts, growth rates and critical speeds right on any seal?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/verdicts.py [seals] [points of the scan] [kind] [seed]

Random seals (tests/random_seals.py, seeded), every third moved to within 1e-3 to 1e-9 of one of its thresholds, against
film coefficients by quadrature, eigenvalues in mpmath and a dense scan from a thousandth to ten times the seal's speed
(tests/eigenvalue_scan.py).  Right: the verdict is that of the exact growth rate, or "neutral" where the stated
uncertainty contains both zero and that rate; the growth rate is right within its uncertainty; the thresholds in the
scanned range are those of the scan to 1e-8, or 1e-6 where the stated uncertainty of the growth rate is no better (a
face edge within 1e-7 of where the film between rough faces has a bend), and the critical speed is the lowest of all.
Kind "rough": seals that ride on their asperities; "patterned": waves or pads, on films of cells, which no scan knows:
those are begun with a small tilt and left to themselves in time; the tilt must grow or die out at the stated rate.
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from eigenvalue_scan import growth, thresholds
from random_seals import drawn_seal, patterned_seal, plain, rough_seal
from scenes import Sink, prepared

from sealdyn.dynamics.model import Model
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.scene import Initial, RingStart
from sealdyn.simulation.selection import choose_method
from sealdyn.simulation.stability import stability
from sealdyn.solvers.integrate import solve

SEED, NEAR, LOW, HIGH = 2026, 3, 1e-3, 10.0
# A tilt in time: over the clearance per outer radius; e-folds that it is followed; how near its rate must be, over the
# size of the eigenvalue.
TILT, FOLDS, SAME = 1e-3, 4.0, 0.02


def seals(count: int, points: int, drawn=drawn_seal, seed=SEED):
    """Numbers, scenes and the thresholds (rad/s) of each, by a scan of so many `points`."""
    for n in range(count):
        draw = np.random.default_rng([seed, n])
        scene = drawn(draw)
        found = thresholds(plain(scene), points, LOW, HIGH)
        if n % NEAR == 0 and found:
            speed = draw.choice(found) * (1.0 + draw.choice([-1.0, 1.0]) * 10.0 ** -draw.uniform(3.0, 9.0))
            scene = replace(scene, shaft=Shaft(speed=float(speed)))
            found = thresholds(plain(scene), points, LOW, HIGH)
        yield n, scene, found


def judged(scene, wanted: list[float]) -> tuple[dict, dict, list[str]]:
    """The answer, the exact growth rates, and what is wrong with it."""
    model = Model(scene)
    answer, exact, bad = stability(model, None, model.linear_scene(), True), growth(plain(scene)), []
    rate, error = answer["growth_rate"], answer["growth_rate_uncertainty"]
    if exact["all"] is None:
        return answer, exact, [] if answer["verdict"] == "stable" and rate is None else ["modes of nothing"]
    true = float(exact["all"])
    if abs(true - rate) > error:
        bad.append(f"growth {rate:.17g} +- {error:.1g}, exactly {true:.17g}")
    sign = "unstable" if true > 0 else "stable"
    if answer["verdict"] not in ((sign, "neutral") if abs(rate) <= error else (sign,)):
        bad.append(f"{answer['verdict']} with growth {rate:.3g} +- {error:.1g}, exactly {true:.3g}")
    speed = scene.shaft.speed
    inside = [w for w in answer["thresholds"] if LOW * speed <= w <= HIGH * speed]
    if len(inside) != len(wanted) or not all(same(scene, *pair) for pair in zip(inside, wanted, strict=True)):
        bad.append(f"thresholds {inside}, scan {wanted}")
    if answer["critical_speed"] != min(answer["thresholds"], default=None):
        bad.append(f"critical speed {answer['critical_speed']} of {answer['thresholds']}")
    return answer, exact, bad


def same(scene, found: float, wanted: float) -> bool:
    """Whether two thresholds (rad/s) are the same to 1e-8, or as nearly as the growth rate there is known."""
    if abs(found - wanted) <= 1e-8 * wanted:
        return True
    model = Model(replace(scene, shaft=Shaft(speed=wanted)))
    tilt = [(m.value.real, m.error) for m in model.linear_scene().modes() if m.kind == "tilt"]
    low, high = (max(rate + sign * error for rate, error in tilt) for sign in (-1.0, 1.0))
    return abs(found - wanted) <= 1e-6 * wanted and low <= 0.0 <= high


def judged_in_time(scene) -> tuple[dict, float, list[str]]:
    """The answer, the growth rate (1/s) of a small tilt in time, and what is wrong with the answer."""
    model = Model(scene)
    answer = stability(model, None, model.linear_scene(), True)
    slowest = max((m for m in answer["modes"] if m["kind"] == "tilt"), key=lambda m: m["re"])
    size, film = abs(complex(slowest["re"], slowest["im"])), scene.film
    tilted = replace(scene, initial=Initial(stator=RingStart(tilt_x=TILT * film.clearance / film.outer_radius)))
    duration = min(FOLDS / abs(slowest["re"]), 40.0 * np.pi / size)
    run = prepared(tilted, duration, 1e-7)
    sink = Sink(duration, duration / 400)
    outcome = solve(run, choose_method(run)[0], 1e-7, sink)
    if outcome.status != "ok":
        return answer, np.nan, [f"in time {outcome.status} {outcome.message}"]
    times, names = np.concatenate(sink.times), run.model.unknowns.names
    at = names.index("stator_tilt_x")
    tilt = np.concatenate(sink.q)[:, at] + 1j * np.concatenate(sink.q)[:, at + 1]
    late = times > 0.5 * duration
    rate = float(np.polyfit(times[late], np.log(np.abs(tilt[late])), 1)[0])
    bad = [] if abs(rate - slowest["re"]) <= SAME * size else [f"in time {rate:.5g}, said {slowest['re']:.5g} 1/s"]
    stable = all(m["re"] < 0.0 for m in answer["modes"])
    if answer["verdict"] != "neutral" and (answer["verdict"] == "stable") != stable:
        bad.append(f"{answer['verdict']} with modes {answer['modes']}")
    return answer, rate, bad


def in_time(count: int, seed: int = SEED):
    """Judge seals with patterned faces, and print what is wrong."""
    wrong, verdicts, worst = 0, {}, 0.0
    for n in range(count):
        answer, rate, bad = judged_in_time(patterned_seal(np.random.default_rng([seed, n])))
        verdicts[answer["verdict"]] = verdicts.get(answer["verdict"], 0) + 1
        slowest = max((m for m in answer["modes"] if m["kind"] == "tilt"), key=lambda m: m["re"])
        apart = abs(rate - slowest["re"]) / abs(complex(slowest["re"], slowest["im"]))
        worst, wrong = max(worst, apart), wrong + bool(bad)
        print(
            f"{n} {answer['verdict']} {slowest['re']:.5g} in time {rate:.5g} apart {apart:.1e} {bad or ''}", flush=True
        )
    print(f"{count - wrong} of {count} patterned seals right: verdicts {verdicts}, rates at most {worst:.1e} of the "
          "eigenvalue apart")  # fmt: skip


def main(count: int, points: int, kind: str = "smooth", seed: int = SEED):
    if kind == "patterned":
        return in_time(count, seed)
    drawn = {"smooth": drawn_seal, "rough": rough_seal}[kind]
    wrong, cost, sharp, verdicts, stiffest, crossings = 0, [], [], {}, 0.0, 0
    for n, scene, wanted in seals(count, points, drawn, seed):
        answer, _, bad = judged(scene, wanted)
        model = Model(scene)
        linear, began = model.linear_scene(), time.process_time()
        stability(model, None, linear, True)
        cost.append(time.process_time() - began)
        verdicts[answer["verdict"]] = verdicts.get(answer["verdict"], 0) + 1
        crossings += len(wanted)
        if answer["modes"]:
            stiffest = max(stiffest, max(abs(complex(m["re"], m["im"])) for m in answer["modes"]))
            sharp.append(answer["growth_rate_uncertainty"] / max(abs(answer["growth_rate"]), 1e-300))
        wrong += bool(bad)
        for words in bad:
            print(f"{n}: {words}", flush=True)
    print(
        f"{count - wrong} of {count} seals right: verdicts {verdicts}, {crossings} thresholds in range, fastest mode "
        f"{stiffest:.2g} 1/s\nuncertainty over growth rate: median {np.median(sharp):.1g}, 90 % below "
        f"{np.quantile(sharp, 0.9):.1g}; stability with all speeds {1e3 * np.median(cost):.2f} ms in the median, "
        f"{1e3 * max(cost):.2f} ms at most"
    )


if __name__ == "__main__":
    given = [int(word) if word.isdigit() else word for word in sys.argv[1:]]
    main(*given, *(200, 400)[len(given) :])
