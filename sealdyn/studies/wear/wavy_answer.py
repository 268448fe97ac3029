"""What the study of wear says of wavy faces: the waves that are left over the hours, and how long they live."""

import math

import numpy as np
from scipy.interpolate import PchipInterpolator

from ...answers import Answer, Axis, Level, Panel, Series, Table
from ...quantities import in_words
from ...status import Status

SEEN = ("waviness", "load_support", "leakage", "friction_power", "contact_force", "closing_force", "film_force",
        "contact_area_fraction", "contact_pressure", "h_min", "clearance", "wear_rate", "left_out")  # fmt: skip
# Shapes drawn; share of the rate that the shape of the depth leaves out beyond which it says so; angles of a shape.
LINES, COARSE, ANGLES = 6, 0.1, 129


def answer_of(balances, wears, rows, end, settings) -> Answer:
    """The answer of the rows of a history (studies/wear), of faces whose coefficients (1/Pa) are `wears`."""
    numbers = _numbers(balances, wears, rows, settings) | {"end": end}
    numbers["status"] = end["kind"] if end["kind"] in (Status.COLLAPSED, Status.FAILED) else Status.OK
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _limits(numbers, settings))


def _numbers(balances, wears, rows, settings) -> dict:
    """Histories, profiles of both faces (their means around the circle), waves of the gap and the balance of volume."""
    rows, basis = [row for row in rows if row["seen"]], balances.basis
    depth = np.array([row["depth"] for row in rows]).reshape(-1, len(basis.areas))
    even = depth[:, : basis.n]
    profile = {face: (k / sum(wears.values()) * even).tolist() for face, k in wears.items()}
    angle = 2.0 * math.pi / balances.wave.order * np.linspace(0.0, 1.0, ANGLES)
    amplitudes = np.array([row["seen"]["amplitudes"] for row in rows]).reshape(-1, balances.harmonics)
    phases = np.outer(np.arange(1, balances.harmonics + 1), balances.wave.order * angle + balances.wave.phase)
    history = {name: [row["seen"][name] for row in rows] for name in SEEN}
    history |= {"time": [row["time"] for row in rows]}
    for face in wears:
        history[f"{face}_volume"] = [basis.volume(np.array(one)) for one in np.pad(
            np.array(profile[face]).reshape(-1, basis.n), ((0, 0), (0, basis.cosines)))]  # fmt: skip
    volume, integral = (basis.volume(depth[-1]), rows[-1]["volume"]) if rows else (0.0, 0.0)
    return {
        "radius": basis.radius.tolist(), "waves": int(balances.wave.order), "made": balances.wave.amplitude,
        "travelling": balances.travelling, "coefficients": list(wears.values()), "profile": profile,
        "angle": angle.tolist(), "amplitudes": amplitudes.tolist(), "shape": (amplitudes @ np.cos(phases)).tolist(),
        "history": history, "life_share": settings.life,
        "life": _life(history["time"], history["waviness"], settings.life),
        "volume": {"profiles": volume, "integral": integral,
                   "residual": abs(volume - integral) / volume if volume else 0.0},
        "steps": max(len(rows) - 1, 0),
    }  # fmt: skip


def _life(time, waviness, share) -> float | None:
    """When (s) the waviness falls to a share of its first value, by a monotone cubic between steps; None if it does
    not."""
    if len(time) < 2 or min(waviness) > share * waviness[0]:
        return None
    return float(PchipInterpolator(time, np.array(waviness) / waviness[0]).solve(share, extrapolate=False)[0])


def _found(numbers) -> str:
    """How long the wave lives, what is left of it and what it carries."""
    said, history = numbers["end"]["said"], numbers["history"]
    said = f"{said[0].upper()}{said[1:]}"
    if not history["time"]:
        return f"{said}."
    if numbers["travelling"]:
        worn = max(max(one[-1]) for one in numbers["profile"].values())
        return f"{said}; travelling waves stay, and the faces lose {in_words('depth', worn)} at most."
    share = in_words("share", numbers["life_share"])
    life = f"in {in_words('time', numbers['life'])}" if numbers["life"] is not None else "not yet"
    carried = [in_words("share", history["load_support"][k]) for k in (0, -1)]
    made, left = (in_words("m", history["waviness"][k]) for k in (0, -1))
    return (
        f"{said}; the waves have fallen to {share} {life}, to {left} of {made} at the end; the film carries "
        f"{carried[0]}, then {carried[1]}."
    )


def _limits(numbers, settings) -> list[str]:
    """What the answer does not hold for."""
    most = max(numbers["history"]["left_out"], default=0.0)
    if most <= COARSE:
        return []
    return [
        f"Up to {in_words('share', most)} of the depth rate is not of the shape that the depth has: waves that wear "
        f"alike at every radius, with {settings.harmonics} harmonics."
    ]


def _tables(numbers) -> list[Table]:
    """The course over the hours."""
    columns = {"time": ("time", "time"), "waviness": ("m", "waviness"), "load_support": ("share", "load support"),
               "leakage": ("leakage", "leakage"), "friction_power": ("power", "friction"),
               "clearance": ("clearance", "clearance"), "wear_rate": ("wear_rate", "wear rate"),
               "stator_volume": ("volume", "stator worn"), "rotor_volume": ("volume", "rotor worn")}  # fmt: skip
    rows = zip(*(numbers["history"][name] for name in columns), strict=True)
    return [Table("history", list(columns.values()), [list(row) for row in rows])]


def _panels(numbers) -> list[Panel]:
    """The shape of one wave from early to late; beside, the course."""
    history = numbers["history"]
    if len(history["time"]) < 2:
        return [Panel("One wave", note=numbers["end"]["said"])]
    time = np.array(history["time"])
    shown = np.unique([int(np.argmin(np.abs(time - t))) for t in np.linspace(0.0, time[-1], LINES)])
    wave = [Series("line", numbers["angle"], numbers["shape"][k], style=f"{time[k] / time[-1]:.3g}",
                   label=in_words("time", time[k], digits=3)) for k in shown]  # fmt: skip
    radial = [Series("line", numbers["radius"], one[-1], label=face, style=face)
              for face, one in numbers["profile"].items() if max(one[-1]) > 0.0]  # fmt: skip
    over = Axis("time", "time of operation", low=0.0, high=float(time[-1]))
    level = [Level(numbers["life_share"] * history["waviness"][0], "life", style="contact dashed")]
    course = [
        ("Waviness", "m", "waviness", "film", level), ("Load support", "share", "load_support", "contact", []),
        ("Leakage", "leakage", "leakage", "leakage", []), ("Wear rate", "wear_rate", "wear_rate", "warn", []),
    ]  # fmt: skip
    return [
        Panel("One wave of the gap", Axis("angle"), Axis("m", "height"), wave),
        Panel("Worn off, mean around the circle", Axis("radius"), Axis("depth"), radial, down=True, below=False),
        *(Panel(title, over, Axis(quantity, " ", low=0.0), [Series("line", time.tolist(), history[name], style=style)],
                levels, below=k > 0, tall=0.6)
          for k, (title, quantity, name, style, levels) in enumerate(course)),
    ]  # fmt: skip
