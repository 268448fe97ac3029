"""Critical speed: the stability threshold of the aligned seal by three independent methods, and the whirl beyond it.

Linear: published formula with the film's own coefficients, eigenvalues, growth of a small disturbance in time.
Beyond: the family of circular whirls that leaves the threshold (analysis/whirl), and runs in time that must agree.
"""

from dataclasses import asdict, dataclass
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from ..analysis.whirl import (
    TOO_SLOW,
    bounded_or_not,
    branch,
    contact_tilt_aligned,
    free_model,
    growth_rate,
    linear_growth,
    tipping_disturbance,
)
from ..closed_form import fmr_critical_speed, fms_critical_speed
from ..dynamics.linearisation import moves_with_speed
from ..dynamics.run_state import RunState
from ..numerics.piecewise_linear import initially
from ..scene.rings import ROTOR, STATOR
from ..scene.scene import Closing
from ..scene.variants import with_values
from ..simulation.selection import choose_method
from ..simulation.stability import FASTEST, critical_speed, held_speeds, natural_frequency, speeds_held
from ..status import Status
from ._words import no_film_beyond, plain
from ._words import speed as speed_words

REFUSES = ("secondary-seal",)
ALONG = {"growth": ("speed",), "nonlinear/branch": ("speed",), "nonlinear/tipping": ("speed",),
         "nonlinear/directions": ("speed",)}  # fmt: skip
units = dict.fromkeys(("speed", "frequency", "bracket"), "rad/s") | dict.fromkeys(("opening", "h_min"), "m")
units |= dict.fromkeys(("eigenvalue", "growth/time_domain", "growth/uncertainty", "growth_rate", "rate"), "1/s")
units |= dict.fromkeys(
    ("amplitude", "disturbance", "whirl", "tipping/branch", "directions/branch", "from", "apart"), "rad"
)
units |= dict.fromkeys(("difference", "turns"), "1")

# Speeds, relative to the eigenvalues' threshold, at which a disturbance is let grow or decay.
SHARES = (0.95, 0.98, 0.998, 1.002, 1.02, 1.05)
NARROW = 2e-5
# Without a threshold: speeds, in parts of a tenth of the fastest, at which it is seen that there is none.
TRIED = (0.3, 1.0, 3.0, 10.0)
# Of an eigenvalue's growth rate what the runs in time may be away from it besides their own uncertainty.
ALIKE = 1e-3


# A scenario (and flags) with which the default settings take so much processor time (s) on one core.
TIMED = ("fms_reference", 13)


@dataclass(frozen=True)
class Settings:
    """How growth is measured in time, and whether to go beyond linear."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012

    method: Literal["adams", "bdf", "dop853", "radau"] = "adams"
    """Integrator."""
    accuracy: float = 1e-7
    """Accuracy to begin with, tightened until it cannot decide a verdict."""
    turns: int = 200
    """Length of a growth measurement, in turns of the shaft or of a whirl that turns faster."""
    speeds: int = 4
    """Points along the whirl family."""
    beyond: bool = True
    """Go beyond linear."""


def run(scenario, settings, tools) -> dict:
    """The threshold by three independent methods, and the whirl beyond it."""
    scene = scenario.scene
    model = free_model(scene, initially(scene.shaft.speed))
    if moves_with_speed(scene.film):
        # At every speed the same closing force, wherever it then puts the gap.
        force = Closing(balance_ratio=model.closing.balance_ratio, spring_force=initially(model.closing.spring))
        scene = with_values(scene, {"closing": force, "film.clearance": model.clearance})
    pace = natural_frequency(model) or 1.0
    eigenvalue = critical_speed(model)
    formula, why = by_formula(model)
    method = "ida" if model.unknowns.has_residual_form else settings.method
    how = {"method": method, "accuracy": settings.accuracy, "turns": settings.turns}
    answer = {"formula": formula, "formula_reason": why, "eigenvalue": eigenvalue, "unit": "rad/s"}
    answer["speeds_held"], answer["own_speed"] = speeds_held(model), abs(scene.shaft.speed)
    answer |= in_time(scene, model, eigenvalue, how, tools, pace)
    answer["nonlinear"] = beyond(model, scene, eigenvalue, settings, tools)
    return {**answer, "verdict": sentences(answer)}


def by_formula(model) -> tuple[float | None, str]:
    """Closed form fed with the film's own coefficients (rad/s or None), and why there is none."""
    scene = model.scene
    if model.interface.stores:
        return None, "a film that stores: no published formula"
    if moves_with_speed(scene.film):
        return None, "a gap that moves with the speed: no published formula"
    if model.unknowns.floats[STATOR] and model.unknowns.floats[ROTOR]:
        return None, "both rings float: no published formula"
    if scene.stator.speed != 0.0:
        return None, "the stator turns: no published formula"
    fmr = model.unknowns.floats[ROTOR]
    formula, ring = (fmr_critical_speed, scene.rotor) if fmr else (fms_critical_speed, scene.stator)
    if ring.transverse_inertia == 0.0:
        return None, "a ring without inertia has no threshold"
    stiffness, damping = ring.support.tilt()
    film_k, film_d = model.film_matrices()
    try:
        speed = formula(
            transverse_inertia=ring.transverse_inertia,
            polar_inertia=ring.polar_inertia,
            support_stiffness=stiffness,
            support_damping=damping,
            film_stiffness=float(film_k[1, 1]),
            film_damping=float(film_d[1, 1]),
        )
    except ValueError as error:
        return None, str(error)
    return speed, "" if speed is not None else f"{'FMR' if fmr else 'FMS'}: stable at every speed"


def growth(scene, point: dict) -> dict:
    """Growth rate of a small disturbance at one speed, by eigenvalues and in the time domain."""
    return growth_rate(scene, point["speed"], point["turns"], point["method"], point["accuracy"])


def in_time(scene, model, eigenvalue, how, tools, pace) -> dict:
    """Bracketing of the threshold by growth and decay; without a threshold, decay at a few speeds."""
    fastest = FASTEST / scene.film.outer_radius
    if eigenvalue is None:
        tried = [factor * min(pace, fastest / 10.0) for factor in TRIED]
        # Slow shafts on stiff films: nothing here is as close to its threshold as Adams' small damping would matter.
        if how["method"] == "adams":
            how = {**how, "method": choose_method(RunState(free_model(scene, tried[0]), 1.0))[0]}
        speeds = _within_held(model, tried)
        rows = tools.map(partial(growth, scene), [{**how, "speed": w} for w in speeds], "growth")
        signs = {row["rate"] > 0 for row in rows if "failed" not in row and row["decided"]}
        said = "a disturbance grows at some of the speeds tried"
        if len(signs) == 1:
            said = f"a disturbance {'grows' if True in signs else 'dies out'} at every speed tried"
        elif not signs:
            said = _unmeasured(rows) or "neither growth nor decay beyond the method's own"
        if speeds == tried and pace > fastest / 10.0:
            said += f", up to {FASTEST:g} m/s at the outer radius"
        found = {"value": None, "uncertainty": None, "reason": said}
        # That there is none is not confirmed: growth here and decay there, or neither.
        undecided = {} if len(signs) == 1 else {"status": Status.FAILED}
        return {"time_domain": found, "growth": columns(rows, speeds), **undecided}
    if eigenvalue > fastest:
        edge = plain(eigenvalue * scene.film.outer_radius, 4)
        reason = f"not run, {edge} m/s at the outer radius are of no seal"
        speeds = [share * eigenvalue for share in SHARES]
        rows = [{"eigenvalue": linear_growth(free_model(scene, w))} for w in speeds]
        return {"time_domain": {"value": None, "uncertainty": None, "reason": reason}, "growth": columns(rows, speeds)}
    speeds = [share * eigenvalue for share in SHARES]
    rows = tools.map(partial(growth, scene), [{**how, "speed": w} for w in speeds], "growth")
    around = between(rows, speeds)
    if around is None:
        reason = _unmeasured(rows) or "growth does not change sign within 5 % of the eigenvalues' threshold"
        return {"time_domain": {"value": None, "uncertainty": None, "reason": reason}, "growth": columns(rows, speeds)}
    # Two more on either side of where the line between them crosses zero: a bracket of a few hundred-thousandths.
    crossing, _ = line_crossing(*around)
    near = [crossing * (1 - NARROW), crossing * (1 + NARROW)]
    closer = tools.map(partial(growth, scene), [{**how, "speed": w} for w in near], "growth")
    last = between(closer, near) or around
    value, uncertainty = line_crossing(*last)
    order = np.argsort([*speeds, *near])
    speeds, rows = [[*speeds, *near][i] for i in order], [[*rows, *closer][i] for i in order]
    bracket = [last[0][0], last[1][0]]
    found = {"value": value, "uncertainty": uncertainty, "bracket": bracket, "method": how["method"]}
    ends = [row for _, row in last]
    found["accuracy"] = min(row["accuracy"] for row in ends)
    found["numerical_damping"] = max(row["numerical_damping"] for row in ends)
    found["against_eigenvalue"] = max(abs(row["rate"] - row["eigenvalue"]) for row in ends)
    return {"time_domain": found, "growth": columns(rows, speeds)}


def _within_held(model, tried: list[float]) -> list[float]:
    """The speeds `tried` (rad/s, rising) where a film holds the closing force at each; else such a row up to the last
    speed at which one does, none of them twice."""
    low, high = held_speeds(model, model.start, tried[0], tried[-1])
    if (low, high) == (tried[0], tried[-1]):
        return tried
    tried = [factor * high / TRIED[-1] for factor in TRIED]
    low, high = held_speeds(model, model.start, tried[0], high)
    return sorted({min(max(speed, low), high) for speed in tried})


def _unmeasured(rows) -> str:
    """Why no row has a growth rate; "" if one has."""
    return rows[0]["failed"] if all("failed" in row for row in rows) else ""


def between(rows, speeds):
    """The neighbouring ((speed, row), (speed, row)) between which decay turns into growth, both decided; or None."""
    good = [(w, row) for w, row in zip(speeds, rows, strict=True) if "failed" not in row and row["decided"]]
    for a, b in pairwise(good):
        if a[1]["rate"] < 0 < b[1]["rate"]:
            return a, b
    return None


def line_crossing(a, b) -> tuple[float, float]:
    """Speed (rad/s) where the line between two rates crosses zero, and its uncertainty: theirs over the slope."""
    (low, p), (high, q) = a, b
    slope = (q["rate"] - p["rate"]) / (high - low)
    return float(low - p["rate"] / slope), float(max(p["uncertainty"], q["uncertainty"]) / slope)


def roads_apart(growth) -> str:
    """A sentence where growth in time is another than the eigenvalues have it, by more than three times its
    uncertainty: of the speed at which they are farthest apart; "" where they agree."""
    names, far = ("speed", "eigenvalue", "time_domain", "uncertainty"), []
    for speed, linear, rate, doubt in zip(*(growth[name] for name in names), strict=True):
        if None not in (linear, rate, doubt) and abs(rate - linear) > 3.0 * doubt + ALIKE * abs(linear):
            far.append((abs(rate - linear) / (doubt or 1e-300), speed, linear, rate, doubt))
    if not far:
        return ""
    _, speed, linear, rate, doubt = max(far)
    return (
        f"Eigenvalues and runs in time disagree at {len(far)} of {len(growth['speed'])} speeds, most at "
        f"{speed_words(speed)}: growth rate {linear:.3g} 1/s by eigenvalues, {rate:.3g} +- {doubt:.1g} 1/s in time."
    )


def columns(rows, speeds) -> dict:
    names = {"eigenvalue": "eigenvalue", "time_domain": "rate", "uncertainty": "uncertainty"}
    found = {"speed": list(speeds), **{k: [row.get(n) for row in rows] for k, n in names.items()}}
    found["decided"] = [row.get("decided", False) for row in rows]
    return {**found, "failed": [row.get("failed") for row in rows]}


# --- beyond linear ------------------------------------------------------------------------------------


def tipping(scene, point: dict) -> dict:
    """The disturbance that tips the seal at one speed, and the whirl it passes on the way."""
    return tipping_disturbance(scene, point["speed"], point["parting"])


def fate(scene, point: dict) -> dict:
    """What becomes of a small or large whirl at one speed."""
    return bounded_or_not(scene, point["speed"], point["start"], point["shape"], point["frequency"])


def beyond(model, scene, threshold, settings, tools) -> dict | None:
    """Family of whirls from the threshold to contact, tipping disturbances, and runs up and down in speed."""
    if not settings.beyond:
        return None
    if model.unknowns.linear:
        return {
            "verdict": "Beyond linear: of a linear film nothing bounds the whirl and nothing tips it.",
            "tipping": [],
        }
    if threshold is not None and threshold > FASTEST / scene.film.outer_radius:
        return {"verdict": "Beyond linear: not followed at such a speed.", "tipping": []}
    if threshold is None:
        return {"verdict": "Beyond linear: no threshold, so no whirl branches off.", "tipping": []}
    if scene.contact:
        verdict = "Beyond linear: asperities bound the whirl (study rub); without contact the film's own whirls."
        return {"verdict": verdict, "tipping": []}
    if model.unknowns.film_unknowns:
        verdict = "Beyond linear: whirls of a film with unknowns of its own are not followed."
        return {"verdict": verdict, "tipping": []}
    at_threshold = free_model(scene, threshold)
    family = branch(at_threshold, threshold)
    if not family:
        verdict = "Beyond linear: no family of circular whirls was found at the threshold."
        return {"verdict": verdict, "tipping": []}
    unit = contact_tilt_aligned(at_threshold)
    found = {"kind": kind_of(family, threshold), "branch": family_columns(family), "contact_tilt": unit}
    ends_in_contact = family[-1].h_min < 2 * at_threshold.face[4]
    found["contact_speed"] = family[-1].speed if ends_in_contact else None
    low, high = min(w.speed for w in family), max(w.speed for w in family)
    inner = ((np.arange(settings.speeds) + 0.5) / settings.speeds).tolist()
    below = [threshold - (threshold - low) * x for x in inner] if low < 0.9995 * threshold else []
    near = [min(family, key=lambda whirl: abs(whirl.speed - w)) for w in below]
    points = [{"speed": w, "parting": whirl.growth} for w, whirl in zip(below, near, strict=True)]
    rows = tools.map(partial(tipping, scene), points, "tipping")
    found["tipping"] = [compared({"speed": w, **row}, family, False) for w, row in zip(below, rows, strict=True)]
    above = [threshold + (high - threshold) * x for x in inner] if high > 1.0005 * threshold else []
    outside = [min(low - 0.005 * threshold, 0.998 * threshold), max(high + 0.005 * threshold, 1.002 * threshold)]
    points = []
    for w in sorted([*below, *above, *outside]):
        points += [{"speed": w, "start": "small", "shape": None, "frequency": None}]
        points += [{"speed": w, "start": "large", "shape": (0.97 * family[-1].q).tolist(),
                    "frequency": family[-1].frequency}]  # fmt: skip
    rows = tools.map(partial(fate, scene), points, "fate")
    found["directions"] = [
        compared({"speed": p["speed"], "start": p["start"], **row}, family, True)
        for p, row in zip(points, rows, strict=True)
    ]
    return {"verdict": " ".join(nonlinear_sentences(found, threshold)), **found}


def kind_of(family, threshold) -> str:
    """subcritical (the family leaves towards lower speed), supercritical, or with a fold."""
    speeds = np.array([threshold, *[w.speed for w in family]])
    falls, rises = np.all(np.diff(speeds) < 0), np.all(np.diff(speeds) > 0)
    if falls or rises:
        return "subcritical" if falls else "supercritical"
    return "subcritical, then turning" if speeds[1] < threshold else "supercritical, then turning"


def family_columns(family) -> dict:
    names = {n: n for n in ("speed", "amplitude", "frequency", "opening", "h_min")} | {"growth_rate": "growth"}
    return {key: [asdict(w)[name] for w in family] for key, name in names.items()}


def compared(row: dict, family, stable: bool) -> dict:
    """The row with the family's amplitude at its speed (rad; None where the family has none of that stability)."""
    amplitudes, speeds = np.array([w.amplitude for w in family]), np.array([w.speed for w in family])
    speed_of, row["branch"], row["difference"] = CubicSpline(amplitudes, speeds), None, None
    for k in np.flatnonzero(np.diff(np.sign(speeds - row["speed"]))):
        if (family[k + 1].growth < 0) == stable:
            row["branch"] = float(brentq(lambda a: speed_of(a) - row["speed"], amplitudes[k], amplitudes[k + 1]))
            row["difference"] = row["whirl"] / row["branch"] - 1 if row.get("whirl") else None
    return row


def sentences(answer) -> list[str]:
    """The verdict."""
    said, eigen, time = [], answer["eigenvalue"], answer["time_domain"]
    if eigen is None:
        why = "eigenvalues cross at no speed" + (f" ({reason})" if (reason := answer["formula_reason"]) else "")
        said.append(f"No critical speed{no_film_beyond(answer['speeds_held'])}: {why}; in time {time['reason']}.")
    else:
        formula = answer["formula"]
        roads = f"eigenvalues {eigen:.6g}"
        roads += f", formula {formula:.6g}" if formula else f" ({answer['formula_reason']})"
        if time["value"] is None:
            roads += f"; in time: {time['reason']}"
        else:
            roads += f", in time {time['value']:.6g} +- {time['uncertainty']:.1g}"
        said.append(f"Critical speed {speed_words(eigen)}: {roads}.")
    if time.get("numerical_damping") is not None:
        closest = min(abs(v) for v in answer["growth"]["time_domain"] if v is not None)
        said.append(
            f"The method in time, {time['method']}, adds at most {time['numerical_damping']:.1g} 1/s of damping or "
            f"growth of its own there ({time['against_eigenvalue']:.1g} 1/s away from the eigenvalues); the smallest "
            f"growth rate that decides a verdict is {closest:.2g} 1/s."
        )
    said += filter(None, [roads_apart(answer["growth"])])
    if answer["nonlinear"]:
        said.append(answer["nonlinear"]["verdict"])
    return said


def nonlinear_sentences(found, threshold) -> list[str]:
    said = [f"Beyond linear: {found['kind']} (contact: the film at its floor)."]
    unit, touching = found["contact_tilt"], found["branch"]["amplitude"][-1]
    speed = found["contact_speed"]
    at = f"{speed_words(speed)}, {speed / threshold:.4f} of the threshold" if speed else "no speed followed"
    if found["kind"] == "subcritical" and not speed:
        said.append("Nothing bounds the whirl above the threshold: it grows to contact.  Below it an unstable whirl "
                    f"stands beside rest, followed down to {speed_words(min(found['branch']['speed']))}: "
                    "hysteresis.")  # fmt: skip
    elif found["kind"] == "subcritical":
        said.append("Nothing bounds the whirl above the threshold: it grows to contact.  Below it an unstable whirl "
                    f"stands between rest and contact, down to {at}: hysteresis over that range.")  # fmt: skip
    elif found["kind"] == "supercritical":
        said.append("Above the threshold the film bounds the whirl, which grows with speed and touches at "
                    f"{at}, its tilt {touching / unit:.3g} of what closes an unopened gap; contact beyond; no "
                    "hysteresis.")  # fmt: skip
    else:
        said.append(f"The family of whirls turns back on its way to contact at {at}: hysteresis between the turns.")
    for row in found["tipping"]:
        if row.get("disturbance"):
            said.append(f"At {row['speed'] / threshold:.4f} of the threshold a whirl of "
                        f"{row['disturbance'] * 1e6:.0f} urad ({row['disturbance'] / unit:.3g} of the contact tilt) "
                        "tips it.")  # fmt: skip
    slow = sorted((row["speed"], row["branch"]) for row in found["tipping"] if row.get("turns") and row["branch"])
    if slow:
        shares, sizes = [at / threshold for at, _ in slow], [1e6 * size for _, size in slow]
        said.append(f"At {_span(shares, '.4f')} of the threshold a whirl of {_span(sizes, '.0f')} urad tips it, by the "
                    "family alone: runs that begin beside it part too slowly to be told apart in time.")  # fmt: skip
    if found["directions"]:
        said += [fates(found["directions"], start) for start in ("small", "large")]
    apart = [abs(row["difference"]) for row in (*found["tipping"], *found["directions"]) if row["difference"]]
    if apart:
        said.append(f"Whirls by continuation and in time agree within {max(apart):.1e} ({len(apart)} compared).")
    return said


def _span(values, form) -> str:
    """First to last of some numbers."""
    first, last = (format(value, form) for value in (values[0], values[-1]))
    return first if first == last else f"{first} to {last}"


def fates(rows, start) -> str:
    """What became of the small or large whirls, from low to high speed."""
    rows = [row for row in rows if row["start"] == start]
    failed = [row["failed"] for row in rows if "failed" in row]
    slow = [row for row in rows if row.get("fate") == TOO_SLOW]
    rows = [row for row in rows if row.get("fate") not in (None, TOO_SLOW)]
    parts, last = [], None
    whirls = f"{start.capitalize()} whirls in time"
    left = ""
    if slow:
        # Nothing failed: where they go the sign of their growth rate says.
        ways = [f"{'grows' if row['rate'] > 0 else 'dies out'} at {speed_words(row['speed'])}" for row in slow]
        left = f"too slow to be followed ({slow[0]['said']}), by eigenvalues a small one {', '.join(ways)}"
    if not rows:
        return f"{whirls}: {left or f'none was followed to its end ({failed[0]})'}."
    for row in rows:
        if row["fate"] != last:
            parts.append([row["fate"], row["speed"], row["speed"]])
        parts[-1][2], last = row["speed"], row["fate"]
    words = [f"{what} at {speed_words(a)}" + (f" to {speed_words(b)}" if b > a else "") for what, a, b in parts]
    return f"{whirls}: {', '.join(words)}{f'; {left}' if left else ''}."
