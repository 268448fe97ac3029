"""Where linear theory fails: at the tilt where the linear film says the faces touch they are far apart."""

from dataclasses import replace

from scipy.optimize import brentq

from ....analysis.shooting import Shooter
from ....analysis.sources.green_1989 import reference_scene
from ....dynamics.model import Model
from ....dynamics.modes import steady_extremes
from ....dynamics.run_state import RunState
from ....simulation.film_error import steady_tilt
from ._common import integrated, row

ITEM = 12
# Share of the tilt at which parallel faces touch, above which linear theory is doubted.
SMALL = 0.1
TURNS, ACCURACY = 20, 1e-7
# Of the linear onset: the way to it, and beyond.
SHARES = (0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 1.2)


def scene(misalignment: float, model: str = "radial"):
    """The reference FMR seal over a misaligned stator."""
    reference = reference_scene("FMR", 0.5, fixed=misalignment)
    return replace(reference, film=replace(reference.film, model=model))


def linear_gap(misalignment: float) -> float:
    """Smallest film over the clearance, as the linear steady state has it."""
    run = RunState(Model(scene(misalignment, "linear"), ACCURACY), 1.0)
    linear = run.model.linear_scene()
    answers = [(h, linear.response(h)) for h in run.segment(0).harmonics()]
    most, _, closing = steady_extremes(linear, answers, run.period())
    inner, outer, coning, c = run.model.face[0], run.model.face[1], run.model.face[3], run.model.clearance
    return min(c - closing - inner * most, c + coning * (outer - inner) - closing - outer * most) / c


def onset() -> float:
    """Misalignment (rad) at which the linear film touches."""
    return brentq(linear_gap, 1e-6, 0.1, xtol=1e-15)


def orbits(shares, touching: float) -> list:
    """Periodic orbits at shares of the linear onset, each guessed from the two before: the linear steady state plus
    what the nonlinear film adds to it."""
    found, known = [], []
    for share in shares:
        shooter = Shooter(scene(share * touching), ACCURACY, tight=1e-9)
        linear = shooter.guess()
        guess = linear
        if known:
            (before, added), (_, less) = known[-1], known[-2] if known[1:] else (0.0, 0.0)
            last = known[-2][0] if known[1:] else 0.0
            guess = linear + added + (added - less) * (share - before) / (before - last)
        orbit = shooter.find(guess, target=1e-7, most=25)
        known.append((share, orbit.start - linear))
        found.append(orbit)
    return found


def meets(scene, run) -> str:
    """A tilt that is no small part of the one at which aligned faces touch."""
    tilt, _, _ = steady_tilt(run.model)
    share = abs(tilt) * scene.film.outer_radius / run.model.clearance
    return f"its steady tilt is {share:.2g} clearances at the outer radius" if share > SMALL else ""


def show() -> list[dict]:
    """Film that is left where linear theory has none, by the periodic orbit, checked in time."""
    touching = onset()
    way = dict(zip(SHARES, orbits(SHARES, touching), strict=True))
    orbit, later = way[1.0], way[SHARES[-1]]
    found, still = (o.extremes["h_min"]["of_clearance"] for o in (orbit, later))
    # The run begins a little off the orbit and must come back to it.
    run = RunState(Model(scene(touching), ACCURACY), TURNS * orbit.period)
    run.y0[: len(orbit.start)] = 0.999 * orbit.start
    run.extrema.windows[1] = [run.duration - orbit.period, run.duration]
    integrated(run, "adams", ACCURACY)
    in_time = run.extrema.records[1, 0] / run.model.clearance
    return [
        row(
            ITEM, "Linear theory at large tilt",
            (f"linear film: touch at {touching * 1e3:.3g} mrad", abs(found - linear_gap(touching))),
            (f"radial film: open, and {still:.2g} C left at 1.2 times that", abs(in_time - found)),
            "smallest film, of clearance",
            'takes the radial film (film.model = "auto") unless the tilt is small enough for the linear one',
        )
    ]  # fmt: skip
