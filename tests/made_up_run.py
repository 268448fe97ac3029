"""Archives of made-up runs, for charts: what is in them is known by formula."""

import numpy as np

from sealdyn.archive import ArchiveWriter, Fields, Series
from sealdyn.quantities import everyday

FILM = {"inner_radius": 0.032, "outer_radius": 0.04, "clearance": 1e-5, "coning": 3e-3}
SCENARIO = "# Does a flexibly mounted rotor follow a misaligned stator?  Expected: mostly.\n[shaft]\nspeed = 1000\n"
SUMMARY = {
    "model": {"film": "radial", "unknowns": ["rotor_z", "rotor_tilt_x", "rotor_tilt_y"], "solver": "adams"},
    "stability": {"verdict": "stable", "whirl_ratio": 0.49, "critical_speed": 8684.0},
    "h_min": {"value": 2.3e-6, "of_clearance": 0.23, "time": 0.1},
    "relative_misalignment": {"max": 2.4e-4, "min": 3e-5, "mean": 1e-4, "steady_max": 2e-4, "steady_min": None},
    "closed_form": {"relative_max": 2.1e-4, "relative_min": 4e-5}, "leakage": {"mean": 43219.7 / 3.6e9},
    "friction": {"power": 55.6, "torque": 0.0556}, "film": {"axial_stiffness": 1.02e7, "tilt_stiffness": 5100.0},
    "closing": {"force": 725.7, "balance_ratio": 0.802}, "contact_margin": 1.6, "energy_residual": 4.7e-8,
}  # fmt: skip


def whirling(samples=3840, turns=60.0, tilt=1e-4, speed=1000.0, ramp=0.0):
    """Series of a seal whose relative tilt is static + once per turn + a decaying half-frequency whirl."""
    time = np.linspace(0, turns * 2 * np.pi / speed, samples)
    angle = speed * time + ramp * time**2 / 2
    whirl = tilt * (0.6 * np.exp(0.3j) + 0.4 * np.exp(1j * angle))
    whirl = whirl + 0.8 * tilt * np.exp(1j * 0.45 * angle - angle / 40)
    rise = 1e-7 * np.sin(2 * angle)
    return {
        "time": time,
        "shaft_angle": angle % (2 * np.pi),
        "shaft_speed": speed + ramp * time,
        "relative_tilt_x": whirl.real,
        "relative_tilt_y": whirl.imag,
        "rotor_tilt_x": -whirl.real,
        "rotor_tilt_y": tilt / 2 - whirl.imag,
        "relative_misalignment": np.abs(whirl),
        "axial_gap_change": rise,
        "h_min": 1e-5 + rise - FILM["inner_radius"] * np.abs(whirl),
        "h_min_angle": np.angle(whirl) - np.pi / 2,
        "h_min_radius": np.full(samples, FILM["inner_radius"]),
        "leakage_inner": 1.2e-5 * (1 + 0.01 * np.sin(angle)),
        "leakage_outer": 1.2e-5 * (1 + 0.01 * np.cos(angle)),
    }


def series(name):
    """A series as runs write it: SI unit, and the everyday unit of thicknesses, tilts and leakage."""
    lengths, angles = {"h_min", "axial_gap_change"}, "tilt" in name or "misalignment" in name
    unit = "m" if name in lengths else "rad" if angles else "m^3/s" if "leakage" in name else "1"
    unit = "N" if "force" in name else unit
    return Series(unit, name, *everyday(unit))


def pressures(rows):
    """Fields of `whirling` at these rows: a made-up pressure, which rises with the row."""
    r, theta = np.linspace(FILM["inner_radius"], FILM["outer_radius"], 5), np.linspace(0, 2 * np.pi, 24, endpoint=False)
    grid = {"r": (Series("m", "radius"), r), "theta": (Series("rad", "angle"), theta)}
    over = np.array(rows)[:, None, None] / 1000 + np.cos(theta) * r[:, None] / r[-1]
    fields = Fields({"pressure": Series("Pa", "film pressure", "MPa", 1e-6)}, grid, len(rows))
    return fields, {"field_time": whirling()["time"][list(rows)], "pressure": 1e5 * over}


def write(path, columns, status="ok", message="", summary=None, film=None, rows=(), text=SCENARIO, **resolved):
    given = {name: series(name) for name in columns if name != "time"}
    resolved = {"film": FILM if film is None else film, **resolved}
    fields, kept = pressures(rows) if rows else (None, None)
    run = ArchiveWriter(path, scenario_text=text, resolved=resolved, meta={}, series=given, fields=fields)
    run.append(columns, fields=kept)
    if status == "running":
        run.close()
        return path
    return run.finish(status, message, SUMMARY if summary is None else summary)


def drop(columns, *words):
    return {name: values for name, values in columns.items() if not any(word in name for word in words)}


def first(columns, rows):
    return {name: values[:rows] for name, values in columns.items()}
