"""Are stability verdicts, growth rates and critical speeds right on any seal?

    OPENBLAS_NUM_THREADS=1 python tests/benchmark/verdicts.py [seals] [points of the scan]

Random seals (tests/random_seals.py, seeded), every third moved to within 1e-3 to 1e-9 of one of its thresholds, against
film coefficients by quadrature, eigenvalues in mpmath and a dense scan from a thousandth to ten times the seal's speed
(tests/eigenvalue_scan.py).  Right: the verdict is that of the exact growth rate, or "neutral" where the stated
uncertainty contains both zero and that rate; the growth rate is right within its uncertainty; the thresholds in the
scanned range are those of the scan to 1e-8, or 1e-6 where the stated uncertainty of the growth rate is no better (a
face edge within 1e-7 of where the film between rough faces has a bend), and the critical speed is the lowest of all.
"""

import sys
import time
from dataclasses import replace

import numpy as np
from eigenvalue_scan import growth, thresholds
from random_seals import drawn_seal, plain

from sealdyn.dynamics.model import Model
from sealdyn.scene.excitation import Shaft
from sealdyn.simulation.stability import stability

SEED, NEAR, LOW, HIGH = 2026, 3, 1e-3, 10.0


def seals(count: int, points: int, drawn=drawn_seal):
    """Numbers, scenes and the thresholds (rad/s) of each, by a scan of so many `points`."""
    for n in range(count):
        draw = np.random.default_rng([SEED, n])
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


def main(count: int, points: int):
    wrong, cost, sharp, verdicts, stiffest, crossings = 0, [], [], {}, 0.0, 0
    for n, scene, wanted in seals(count, points):
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
    given = [int(word) for word in sys.argv[1:]]
    main(*given, *(200, 400)[len(given) :])
