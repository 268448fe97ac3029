"""Campbell diagram: whirl frequencies over shaft speed, each mode followed through crossings, with its damping."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.linalg import eig
from scipy.optimize import brentq, linear_sum_assignment

from ..answers import CYCLE, Answer, Axis, Level, Panel, Series, Table
from ..dynamics.model import Model
from ..quantities import in_words, reading_in
from ..scene.patterns import grooves_of
from ..scene.scene import frozen_at_start
from ..simulation.stability import held_speeds
from ..units import Speed
from . import Info

INFO = Info(
    timed=("fms_reference", 2),
    asks="At which frequencies does the seal whirl?",
    refuses=("secondary-seal",),
    wavy=True,
    grooved=True,
    units={
        **dict.fromkeys(("speed", "frequency", "signed_frequency"), "rad/s"), "growth_rate": "1/s",
        **dict.fromkeys(("log_decrement", "lines", "line", "mode", "whirl_ratio", "growing"), "1"),
        "clearance": "m",
    },
    along={"modes": ("speed",)},
)  # fmt: skip
POINTS, POINTS_OVER_GROOVES = 241, 25
# Shapes of neighbouring speeds that resemble each other less than this ask for a speed between them.
ALIKE, HALVINGS = 0.97, 7
NOT_OSCILLATING = 1e-9
# Of their size: eigenvalues that differ by less are equal.
SAME = 1e-9
# Of a decrement: beyond, a mode hardly oscillates and its curve would hide the others.
MOST_DECREMENT = 100.0
DASHES = {"forward": "", "backward": "dashed", "axial": "dotted", "none": "dashdot"}


@dataclass(frozen=True)
class Settings:
    """Speeds, and how the figure is drawn."""

    speed_from: Speed = 0.0
    """Lowest speed."""
    speed_to: Speed | None = None
    """Highest speed; without it six times the scenario's, no more than a film holds."""
    points: int | None = None
    """Number of speeds (241; over grooves 25)."""
    unit: Literal["rpm", "rad/s"] = "rpm"
    """Of the figure's axes."""
    lines: tuple[float, ...] | float = ()
    """Orders of the shaft speed that are drawn besides 1x and 1/2x."""


def run(scenario, settings, tools) -> Answer:
    """Modes over speed, where they meet the order lines, and where they turn or lose their damping."""
    scene = frozen_at_start(scenario.scene)
    if grooves_of(scene)[1]:
        return _over_grooves(scene, settings, tools)
    model, own = Model(scene), abs(scene.shaft.speed)
    top = settings.speed_to
    if top is None:
        _, top = held_speeds(model, model.start, 1e-3 * own, 6 * own or 6000.0)
    speeds = np.linspace(settings.speed_from, top, max(3, settings.points or POINTS))

    def pencil(w):
        return model.linear_scene(speed=float(w)).pencil()

    begin = model.linear_scene(speed=float(speeds[0]))
    values, shapes = follow(pencil, speeds, tools.say, begin.reach)
    values = sharpened(values, [model.linear_scene(speed=float(w)).modes() for w in speeds])
    tools.say(1.0)
    modes = described(values, shapes[:, :, : len(begin.mass)])
    lost = model.unknowns.faces_tilt and begin.rest is None
    notes = ["The modes are of aligned faces: no tilt was found in which the rings rest."] if lost else []
    return _answer(scene, settings, speeds, modes, notes)


def _over_grooves(scene, settings, tools) -> Answer:
    """Roots of the ring on the film of one pitch, at fewer speeds."""
    from ._grooved_roots import roots_over_speed

    top = settings.speed_to if settings.speed_to is not None else 2.0 * abs(scene.shaft.speed) or 2000.0
    points = max(3, settings.points or POINTS_OVER_GROOVES)
    # At rest grooves do not pump.
    speeds = np.linspace(settings.speed_from or top / points, top, points)
    rows, roots, notes = roots_over_speed(scene, speeds, tools)
    modes = [_mode(name.partition("_")[0], row) for name, row in roots.items()]
    more = {name: [row[name] for row in rows] for name in ("clearance", "growing")}
    return _answer(scene, settings, np.array([row["speed"] for row in rows]), modes, notes, **more)


def _answer(scene, settings, speeds, modes, notes, **more) -> Answer:
    """What `modes` (described) over `speeds` say, with `more` numbers."""
    lines = sorted({1.0, 0.5, *np.array(settings.lines, float).ravel().tolist()}, reverse=True)
    numbers = {
        "speed": speeds.tolist(),
        "unit": settings.unit,
        "own_speed": abs(scene.shaft.speed),
        "lines": lines,
        "modes": modes,
        "crossings": crossings(modes, speeds, lines),
        "thresholds": thresholds(modes, speeds),
        "stator_speed": scene.stator.speed,
        "stator_crossings": stator_crossings(modes, speeds, scene.stator.speed),
        **more,
    }
    with reading_in({"rad/s": settings.unit}):
        return Answer(numbers, _found(numbers), [_table(numbers)], _panels(numbers), notes)


# --- following modes -----------------------------------------------------------------------------------


def follow(pencil, speeds, say=lambda fraction: None, reach=np.inf) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (modes, speeds) and shapes (modes, speeds, n) of `left x = s right x`, each row one mode.

    `pencil(speed)` gives (left, right), and more where x is another one at every speed (LinearScene.pencil).  Modes
    within `reach` (1/s) at the first speed are followed.  Neighbours are matched by biorthogonality of left and right
    vectors, which two modes that merely meet in frequency do not share; where the match is weak, speeds between are
    looked at.
    """
    here = _solve(*pencil(speeds[0]))
    near = np.abs(here[0]) < reach
    here = here[0][near], here[1][:, near], here[2][near]
    values, shapes = [here[0]], [here[1]]
    for k, (a, b) in enumerate(pairwise(speeds)):
        here = _step(pencil, a, here, b, HALVINGS)
        values.append(here[0])
        shapes.append(here[1])
        say(0.9 * (k + 1) / len(speeds))
    return np.array(values).T, np.array(shapes).transpose(2, 0, 1)


def _solve(left, right, whole=None, lift=None):
    """Finite eigenvalues (m,), right vectors (n, m) and left vectors times `right` (m, n), so scaled that the product
    of both is one; with `whole` and `lift` (LinearScene.pencil) on the unknowns that are the same at any speed."""
    values, from_left, vectors = eig(left, right, left=True, right=True)
    finite = np.isfinite(values) & (np.abs(values) < 1e12)
    values, vectors, from_left = values[finite], vectors[:, finite], from_left[:, finite]
    duals = from_left.conj().T @ (right if whole is None else whole)
    vectors = vectors if lift is None else lift @ vectors
    products = np.einsum("mn,nm->m", duals, vectors)
    # A defective pair has no such scale; its frequency must do.
    products = np.where(np.abs(products) < 1e-14, 1.0, products)
    return values, vectors, duals / products[:, None]


def _step(pencil, a, here, b, halvings, there=None):
    """Modes at speed b in the order of those `here` at speed a."""
    there = there if there is not None else _solve(*pencil(b))
    order, resemblance = _match(here, there)
    if resemblance < ALIKE and halvings > 0:
        middle = 0.5 * (a + b)
        between = _step(pencil, a, here, middle, halvings - 1)
        return _step(pencil, middle, between, b, halvings - 1, there)
    return tuple(part[order] if i != 1 else part[:, order] for i, part in enumerate(there))


def _match(here, there) -> tuple[np.ndarray, float]:
    """Which mode there continues each mode here, and how well the worst one does."""
    # Both products, so that the length of a vector does not matter.
    overlap = np.sqrt(np.abs(here[2] @ there[1]) * np.abs(there[2] @ here[1]).T)
    overlap = np.minimum(overlap, 1.0)
    scale = max(np.max(np.abs(here[0])), 1e-300)
    distance = np.abs(here[0][:, None] - there[0][None, :]) / scale
    # Vectors decide; among equal ones (a symmetric pair at rest) the nearer frequency does.
    rows, order = linear_sum_assignment(distance * 0.1 - overlap)
    return order, float(np.min(overlap[rows, order]))


def described(values, shapes) -> list[dict]:
    """Modes as the answer has them, from all eigenvalues (each twice, with its conjugate).

    Of a tilt pair the member that turns as x + i y is kept: its frequency is signed, positive forward.  Two that are
    equal at every speed turn neither way, as any mix of them is a mode: one is kept.
    """
    found, twins = [], _twins(values)
    for k, (row, shape) in enumerate(zip(values, shapes, strict=True)):
        axial, x, y = shape[:, 0::3], shape[:, 1::3], shape[:, 2::3]
        total = np.linalg.norm(shape, axis=1)
        kind = "axial" if np.median(np.linalg.norm(axial, axis=1) / total) > 0.5 else "tilt"
        turns = np.linalg.norm(x + 1j * y, axis=1) - np.linalg.norm(x - 1j * y, axis=1)
        keep = np.median(turns / total) > 0 if kind == "tilt" else not np.median(row.imag) < -NOT_OSCILLATING
        if kind == "tilt" and k in twins:
            keep = twins[k]
        if keep:
            found.append((kind, row))
    # Slowest first, of equal ones the forward one; modes are numbered in this order.
    found.sort(key=lambda pair: (pair[0] == "axial", *_place(np.median(pair[1].imag))))
    return [_mode(kind, row) for kind, row in found]


def _place(frequency: float) -> tuple[float, float]:
    """Size to nine digits and opposite of a signed frequency: what modes are sorted by."""
    return float(f"{abs(frequency):.9g}"), -frequency


def _twins(values) -> dict[int, bool]:
    """Rows of `values` (modes, speeds) that equal another one at every speed, and whether each is the first of two."""
    first, found = [], {}
    for k, row in enumerate(values):
        other = next((j for j in first if np.allclose(values[j], row, rtol=SAME, atol=0.0)), None)
        if other is None:
            first.append(k)
        else:
            found |= {other: True, k: False}
            first.remove(other)
    return found


def sharpened(values, modes) -> np.ndarray:
    """Eigenvalues (modes, speeds) as exactly as the `modes` of each speed (LinearScene.modes) have them, which do not
    lose a slow one to the rounding of a fast one; a growth rate within its uncertainty is none."""
    found = np.array(values)
    for column, here in zip(found.T, modes, strict=True):
        known = np.array([m.value if abs(m.value.real) > m.error else 1j * m.value.imag for m in here])
        known = np.concatenate([known, known.conj()])
        column[:] = known[np.argmin(np.abs(column[:, None] - known[None, :]), axis=1)]
    return found


def _mode(kind: str, row) -> dict:
    still = np.abs(row.imag) <= NOT_OSCILLATING * np.abs(row)
    signed = np.where(still, 0.0, row.imag)
    with np.errstate(divide="ignore", invalid="ignore"):
        decrement = np.where(still, np.nan, -2 * np.pi * row.real / np.abs(signed))
    whirl = np.sign(signed)
    directions = ["none" if w == 0 else "forward" if w > 0 else "backward" for w in whirl]
    if kind == "axial":
        directions = ["none" if w == 0 else "axial" for w in whirl]
    return {
        "kind": kind,
        "frequency": np.abs(signed).tolist(),
        "signed_frequency": signed.tolist(),
        "direction": max(dict.fromkeys(directions), key=directions.count),
        "directions": directions,
        "growth_rate": row.real.tolist(),
        "log_decrement": [float(d) if np.isfinite(d) else None for d in decrement],
    }


# --- what the diagram says -----------------------------------------------------------------------------


def _zeros(speeds, values) -> list[float]:
    """Speeds where a smooth function of speed, given at points, changes sign: cubic through four neighbours."""
    found = []
    for k in range(len(speeds) - 1):
        if values[k] * values[k + 1] < 0:
            near = slice(max(0, k - 1), min(len(speeds), k + 3))
            x, y = np.asarray(speeds[near]) - speeds[k], np.asarray(values[near])
            width = speeds[k + 1] - speeds[k]
            curve = np.polynomial.Polynomial.fit(x, y, len(x) - 1)
            ends = curve(0.0) * curve(width) < 0
            found.append(float(speeds[k] + (brentq(curve, 0.0, width) if ends else width / 2)))
    return found


def crossings(modes, speeds, lines) -> list[dict]:
    """Shaft speeds (rad/s) where a forward tilt mode (or an axial one) meets an order line."""
    return [
        {"line": order, "mode": number, "speed": speed, "frequency": order * speed}
        for number, mode in enumerate(modes, 1)
        for order in lines
        for speed in _zeros(speeds, np.array(mode["signed_frequency"]) - order * speeds)
    ]


def stator_crossings(modes, speeds, stator_speed) -> list[dict]:
    """Shaft speeds (rad/s) where a tilt mode (or an axial one) meets the stator's own speed, which shakes the seal with
    the errors of a stator that turns; none of one that stands."""
    if not stator_speed:
        return []
    found = []
    for number, mode in enumerate(modes, 1):
        away = np.array(mode["signed_frequency"]) - (stator_speed if mode["kind"] == "tilt" else abs(stator_speed))
        found += [{"mode": number, "speed": speed} for speed in _zeros(speeds, away)]
    return found


def thresholds(modes, speeds) -> list[dict]:
    """Speeds (rad/s) where a mode loses or regains its damping, and where it changes its direction of whirl."""
    found = []
    for number, mode in enumerate(modes, 1):
        for speed in _zeros(speeds, mode["growth_rate"]):
            ratio = float(np.interp(speed, speeds, mode["signed_frequency"])) / speed if speed else None
            found.append({"mode": number, "what": "damping", "speed": speed, "whirl_ratio": ratio})
        for speed in _zeros(speeds, mode["signed_frequency"]):
            found.append({"mode": number, "what": "direction", "speed": speed, "whirl_ratio": 0.0})
    return found


def _found(numbers) -> str:
    """The first loss of damping, or what there is in its place."""
    turns = [point for point in numbers["thresholds"] if point["what"] == "damping"]
    # Beyond rounding.
    growing = [number for number, mode in enumerate(numbers["modes"], 1)
               if np.all(np.array(mode["growth_rate"]) > SAME * (1.0 + np.abs(mode["frequency"])))]  # fmt: skip
    met = [crossing for crossing in numbers["crossings"] if crossing["line"] == 1.0]
    if growing:
        return f"Unstable at every speed of this range: mode {' and '.join(map(str, growing))}."
    if turns:
        first = min(turns, key=lambda point: point["speed"])
        mode, k = numbers["modes"][first["mode"] - 1], np.searchsorted(numbers["speed"], first["speed"])
        change = "loses" if mode["growth_rate"][min(k, len(numbers["speed"]) - 1)] > 0.0 else "regains"
        return f"Mode {first['mode']} {change} its damping at {in_words('speed', first['speed'], 5)}."
    if met:
        first = min(met, key=lambda crossing: crossing["speed"])
        return f"Mode {first['mode']} meets once per turn at {in_words('speed', first['speed'], 5)}."
    return "No mode meets once per turn or changes its damping in this range."


def _table(numbers) -> Table:
    """A row a mode: what it is, and the speeds at which something happens to it."""
    lines = numbers["lines"]
    columns = [("1", "mode"), ("1", "kind"), ("1", "whirl"), ("speed", "frequency from"), ("speed", "to")]
    columns += [("speed", f"meets {line:g}x") for line in lines]
    columns += [("speed", "damping changes"), ("1", "whirl ratio"), ("speed", "whirl turns round")]
    columns += [("speed", "meets the stator's speed")] if numbers["stator_speed"] else []
    rows = []
    for number, mode in enumerate(numbers["modes"], 1):
        events = [
            [c["speed"] for c in numbers["crossings"] if (c["mode"], c["line"]) == (number, line)] for line in lines
        ]
        own = [point for point in numbers["thresholds"] if point["mode"] == number]
        damping = [point for point in own if point["what"] == "damping"]
        events += [[p["speed"] for p in damping], [p["whirl_ratio"] for p in damping]]
        events += [[p["speed"] for p in own if p["what"] == "direction"]]
        if numbers["stator_speed"]:
            events += [[c["speed"] for c in numbers["stator_crossings"] if c["mode"] == number]]
        name = [number, mode["kind"], mode["direction"], mode["frequency"][0], mode["frequency"][-1]]
        # What happens more than once takes a row each time.
        for k in range(max(1, *map(len, events))):
            rows.append([*(name if k == 0 else [None] * len(name)), *(e[k] if k < len(e) else None for e in events)])
    return Table("modes", columns, rows)


def _panels(numbers) -> list[Panel]:
    """Frequencies beside decrements, over speed."""
    speed, modes = numbers["speed"], numbers["modes"]
    frequencies, decrements, crossings = [], [], numbers["crossings"]
    for k, mode in enumerate(modes):
        colour = CYCLE[k % len(CYCLE)]
        # Each direction of whirl has its dashes; a curve goes on to the point where the next begins.
        for way in dict.fromkeys(mode["directions"]):
            near = [way in mode["directions"][max(0, j - 1) : j + 1] for j in range(len(speed))]
            part = [value if there else None for value, there in zip(mode["frequency"], near, strict=True)]
            if any(part):
                label = f"mode {k + 1}, {mode['kind'] if way == 'axial' else way}"
                frequencies.append(Series("line", speed, part, label=label, style=f"{colour} {DASHES[way]} "))
        values = [d if d is not None and abs(d) < MOST_DECREMENT else None for d in mode["log_decrement"]]
        if any(value is not None for value in values):
            decrements.append(Series("line", speed, values, label=f"mode {k + 1}", style=colour))
    highest = max((max(mode["frequency"]) for mode in modes), default=0.0)
    # Where all whirl far faster than the shaft turns they are shown, not where they might meet its lines.
    lowest = min((min(mode["frequency"]) for mode in modes if max(mode["frequency"])), default=0.0)
    top = (1.08 * highest if lowest > 1.25 * speed[-1] else min(1.08 * highest, 1.25 * speed[-1])) or None
    for line in numbers["lines"]:
        frequencies.append(Series("line", [speed[0], speed[-1]], [line * speed[0], line * speed[-1]],
                                  label=f"{line:g}x shaft speed", style="grey thin dotted"))  # fmt: skip
    if crossings:
        at = [[c[name] for c in crossings] for name in ("speed", "frequency")]
        frequencies.append(Series("marks", *at, label="meets an order line", style="black open circle front"))
    turns = [point["speed"] for point in numbers["thresholds"] if point["what"] == "damping"]
    levels = [Level(at, "", upright=True, style="bad dashed", number=True) for at in turns]
    own = []
    if speed[0] < numbers["own_speed"] < speed[-1]:
        own = [Level(numbers["own_speed"], "this scenario", upright=True, style="black dotted")]
    over = Axis("speed", low=speed[0], high=speed[-1])
    sizes = [abs(v) for one in decrements for v in one.y if v]
    width = max(0.02, min(sizes, default=1.0))
    scale = Axis("log_decrement", scale="asinh" if max(sizes, default=0.0) > 30 * width else "linear", width=width)
    zero = [Level(0.0, "stable above", style="black")]
    return [
        Panel("Whirl frequency", over, Axis("rad/s", "whirl frequency", low=0.0, high=top), frequencies, levels + own,
              wide=1.4),
        Panel("Damping", over, scale, decrements, zero + levels, note="no mode oscillates" * (not decrements)),
    ]  # fmt: skip
