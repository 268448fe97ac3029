"""Stiff and sudden scenes: which method keeps up, with how many steps, and how right it is.

    python tests/benchmark/stiff_and_sudden.py [figure.png]

Scenes: scenarios/pressure_step.toml, squeeze.toml, impact.toml.  Each method runs at the scenario's accuracy with at
most BUDGET right-hand sides; one that needs more is stopped and drawn as a cross where it stood.  Error: largest
deviation of any displacement at 101 even times, over the scales, from another method (SciPy's Radau, DOP853 or LSODA)
at a hundred thousandth of the accuracy.
"""

import math
import sys
import time
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from scipy import integrate

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from scenes import prepared, run  # noqa: E402

import sealdyn  # noqa: E402
from sealdyn.dynamics.model import Model  # noqa: E402
from sealdyn.dynamics.segments import Segment  # noqa: E402
from sealdyn.scene.forces import contact_thresholds  # noqa: E402
from sealdyn.solvers.contract import SolverFailure  # noqa: E402
from sealdyn.solvers.methods import METHODS  # noqa: E402

SCENES = ("pressure_step", "squeeze", "impact")
PACKAGE = ("adams", "bdf", "ida", "radau", "dop853")
SCIPY = ("LSODA", "RK45")
BUDGET, POINTS = 100_000, 100
# Who judges: the second where the first would judge itself.  No explicit method ends the squeeze.
JUDGES = {"pressure_step": ("Radau", "DOP853"), "squeeze": ("Radau", "LSODA"), "impact": ("DOP853", "Radau")}
# Time axis, its limits (s), limits of the step (s), title.
SHOWN = {
    "pressure_step": ("linear", (0.0, 0.05), (1e-7, 1e-2), "pressure falls from 5 to 1.3 bar"),
    "squeeze": ("log", (1e-7, 8.0), (1e-10, 3.0), "flat ring pushed to 1 % comes loose"),
    "impact": ("log", (1e-6, 6e-3), (1e-9, 1e-3), "whirling ring thrown onto the face"),
}


def scenario(name):
    return sealdyn.read_scenario(ROOT / "scenarios" / f"{name}.toml")


class CountedSegment(Segment):
    """A segment that counts its evaluations, and stops a method beyond its model's budget."""

    native = None

    def __init__(self, *given):
        super().__init__(*given)
        self.plain = Segment(*given)

    def _check(self, t, y):
        model = self.model
        model.calls += 1
        # Trial states with the rotor beyond the other face.
        model.closed += y[0] >= model.clearance
        if model.calls > model.budget:
            raise SolverFailure(f"crawls at {self.time + t:.3g} s")

    def rhs(self, t, y, yp):
        self._check(t, y)
        self.plain.rhs(t, y, yp)

    def residual(self, t, y, yp, res):
        self._check(t, y)
        self.plain.residual(t, y, yp, res)

    def derivatives(self, taus, ys):
        out = np.zeros((len(taus), self.size))
        for tau, y, yp in zip(taus, ys, out, strict=True):
            self.rhs(tau, y, yp)
        return out


class Counted(Model):
    """A model of such segments: evaluations so far, those with the faces beyond each other, most of them."""

    calls, closed, budget = 0, 0, BUDGET

    def segment(self, interval=None, index=0, last=True, stuck=None):
        return CountedSegment(self, interval or self.start, index, last, stuck)


@dataclass
class Measured:
    """How a method did: ends of its accepted steps, `q` (POINTS + 1, n) over the scales or as far as it came."""

    status: str
    calls: int
    wall: float
    times: np.ndarray
    q: np.ndarray
    residual: float = math.nan
    closed: int = 0
    found: object = None

    @property
    def steps(self):
        return len(self.times) - 1


def by_package(name, method, accuracy=None, scene=None):
    """One of the package's methods on a scene."""
    given = scenario(name)
    # `run` of the shared scenes samples by the turn.
    per_turn = POINTS * 2 * math.pi / (given.scene.shaft.speed * given.run.duration)
    begun = time.perf_counter()
    taken = [np.zeros(1)]

    def steps(segment, *how):
        for block in METHODS[method](segment, *how):
            taken.append(segment.time + block[0])
            yield block

    found = run(scene or given.scene, accuracy=accuracy or given.run.accuracy, method=method, per_turn=per_turn,
                duration=given.run.duration, model_class=Counted, steps=steps)  # fmt: skip
    wall = time.perf_counter() - begun
    model, outcome = found.model, found.outcome
    q = found.q / model.scales[: model.unknowns.n]
    times = np.unique(np.concatenate(taken))
    return Measured(outcome.status, model.calls, wall, times, q, outcome.energy_residual, model.closed, found)


def by_scipy(name, method, tolerance=None, exact_jacobian=False):
    """One of SciPy's methods on a scene's right-hand side, leg by leg."""
    given = scenario(name)
    # The same margin between tolerance and accuracy as for the package's Radau.
    tolerance = tolerance or given.run.accuracy / 30
    ready = prepared(given.scene, given.run.duration, given.run.accuracy, model_class=Counted)
    if tolerance < 1e-9:
        ready.model.budget = 100 * BUDGET
    absolute = np.append(tolerance * ready.model.scales[:-1], 1e30)
    even = np.linspace(0.0, given.run.duration, POINTS + 1)

    def rhs(t, y):
        yp = np.empty(segment.size)
        segment.rhs(t, y, yp)
        return yp

    def jacobian(t, y):
        matrix = np.zeros((segment.size, segment.size))
        segment.jacobian(t, np.array(y), None, matrix)
        return matrix

    options = {"jac": jacobian} if exact_jacobian else {}
    y, times, q, status, begun = ready.y0, [0.0], [], "ok", time.perf_counter()
    try:
        for index, leg in enumerate(ready.intervals):
            segment = ready.segment(index)
            last = index + 1 == len(ready.intervals)
            inside = even[(even >= leg.time) & ((even < leg.time + leg.length) | last)] - leg.time
            solver = getattr(integrate, method)(rhs, 0.0, y, leg.length, rtol=max(tolerance, 2.3e-14), atol=absolute,
                                                **options)  # fmt: skip
            for t, at_due in _steps(solver, np.minimum(inside, leg.length)):
                times.append(t + leg.time)
                q += [state[: ready.model.unknowns.n] for state in at_due]
            y = solver.y
    except SolverFailure as failure:
        status = str(failure)
    q = np.array(q) / ready.model.scales[: ready.model.unknowns.n] if q else np.zeros((0, ready.model.unknowns.n))
    return Measured(status, ready.model.calls, time.perf_counter() - begun, np.array(times), q)


def _steps(solver, due):
    """Ends of the steps of a SciPy solver, with the states at the times due in each."""
    done = 0
    while solver.status == "running":
        # A trial stage may fly off and overflow; the error norm then refuses the step.
        with np.errstate(all="ignore"):
            message = solver.step()
        if solver.status == "failed":
            raise SolverFailure(message)
        upto = int(np.searchsorted(due, solver.t, side="right"))
        inner = solver.dense_output() if upto > done else None
        yield solver.t, [inner(t) for t in due[done:upto]]
        done = upto


@lru_cache(maxsize=8)
def reference(name, method):
    """Displacements over the scales, by one of SciPy's methods at a hundred thousandth of the accuracy."""
    return by_scipy(name, method, scenario(name).run.accuracy * 1e-5, exact_jacobian=method in ("Radau", "LSODA")).q


def error(name, method, measured):
    """Largest deviation, over the scales, from a far tighter run by another method; infinite if it did not end."""
    judge = next(other for other in JUDGES[name] if other.lower() != method.lower())
    exact = reference(name, judge)
    return float(np.max(np.abs(measured.q - exact))) if len(measured.q) == len(exact) else math.inf


def smallest_gap(name):
    """Times (s) and thinnest film (m) of the scene, finely sampled."""
    given = scenario(name)
    found = run(given.scene, accuracy=1e-6, method="bdf", duration=given.run.duration,
                per_turn=4000 * 2 * math.pi / (given.scene.shaft.speed * given.run.duration))  # fmt: skip
    return found.times, found["h_min"]


def shown(name):
    """All methods on a scene, and a line about each."""
    found = {}
    for method in (*PACKAGE, *SCIPY):
        # Twice: the first run also loads what is compiled.
        tried = [by_package(name, method) if method in PACKAGE else by_scipy(name, method) for _ in range(2)]
        found[method] = best = min(tried, key=lambda m: m.wall)
        wrong = error(name, method, best)
        print(
            f"{name:14s}{method:7s} {best.status[:26]:27s}{best.steps:7d} steps {best.calls:7d} rhs "
            f"{best.wall * 1e3:8.1f} ms  error {wrong:8.1e}  energy {best.residual:8.1e}"
        )
    return found


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    from sealdyn.report.charts import page as palette

    colours = dict(zip((*PACKAGE, *SCIPY), (palette.BLUE, palette.GREEN, palette.SKY, palette.PURPLE,
                   palette.VERMILLION, palette.GREY, palette.ORANGE), strict=True))  # fmt: skip
    figure, axes = pyplot.subplots(2, 4, figsize=(16, 7), layout="constrained")
    for column, name in enumerate(SCENES):
        steps, gap = axes[:, column]
        for method, one in found[name].items():
            at, size = one.times[1:], np.diff(one.times)
            if one.status == "ok":
                steps.step(at, size, lw=1, color=colours[method])
            else:
                # Up to where it was stopped, and a cross there.
                steps.plot(at, size, lw=2, color=colours[method])
                steps.plot(at[-1], size[-1], "x", ms=10, mew=3, color=colours[method])
        times, h = smallest_gap(name)
        gap.plot(times, h * 1e6, color=palette.FILM)
        contact = scenario(name).scene.contact
        if contact:
            gap.axhline(
                contact_thresholds(contact)[1] * 1e6, color=palette.CONTACT, lw=1, ls="--", label="asperities meet"
            )
            gap.legend(loc="lower right", frameon=False)
        for axis in (steps, gap):
            axis.set(xscale=SHOWN[name][0], yscale="log", xlim=SHOWN[name][1])
            axis.grid(True, alpha=0.3)
        steps.set(ylim=SHOWN[name][2], title=SHOWN[name][3])
        gap.set_xlabel("time, s")
    axes[0, 0].set_ylabel("step, s")
    axes[1, 0].set_ylabel("smallest film thickness, um")
    _draw_costs(axes[:, 3], found, colours)
    figure.savefig(path, dpi=100)
    print(path)


def _draw_costs(axes, found, colours):
    cost, legend = axes
    for name, marker in zip(SCENES, "os^", strict=True):
        for method, one in found[name].items():
            wrong = error(name, method, one)
            stopped = not math.isfinite(wrong)
            cost.loglog(one.calls, 1.0 if stopped else wrong, marker="x" if stopped else marker, ms=9 if stopped else 7,
                        mew=3 if stopped else 1, color=colours[method], ls="none")  # fmt: skip
    cost.axhline(1e-6, color="k", lw=0.8, ls=":")
    cost.annotate("squeeze: dop853, RK45", (8e4, 0.2), fontsize=8, ha="right")
    cost.annotate("accuracy asked", (1.5e4, 1.3e-6), fontsize=8)
    cost.set_title("error against cost")
    cost.set_xlabel("right-hand sides")
    cost.set_ylabel("error, in C or C/r_o")
    cost.grid(True, alpha=0.3)
    legend.axis("off")
    for method, colour in colours.items():
        legend.plot([], [], color=colour, lw=3, label=method)
    for name, marker in zip(SCENES, "os^", strict=True):
        legend.plot([], [], "k", marker=marker, ls="none", label=name.replace("_", " "))
    legend.plot([], [], "kx", ms=9, mew=3, label=f"stopped at {BUDGET} right-hand sides")
    legend.legend(loc="center left", frameon=False, title="methods and scenes")


def main():
    found = {name: shown(name) for name in SCENES}
    draw(found, sys.argv[1] if len(sys.argv) > 1 else ROOT / "outputs" / "gallery" / "stiff_and_sudden.png")


if __name__ == "__main__":
    main()
