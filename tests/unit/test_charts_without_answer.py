"""Charts of studies whose points all failed, or that found nothing: a page that says why, never an error."""

import warnings
from importlib import import_module

import numpy as np
import pytest
from drawn import drawn, text_trouble

from sealdyn.archive import write_study

WHY = "the film closes at the start"
LOST = {"failed": WHY}
NOTHING = {"verdict": [WHY], "status": "failed"}
THREE = [1.0, 2.0, 3.0]
UNKNOWN = [None, None, None]
SEAL = {name: THREE for name in ("static", "dynamic", "total", "static_phase", "dynamic_phase")} | {
    "stable": 3 * [False]
}
AXIS = {"key": "shaft.speed", "unit": "rad/s", "values": THREE, "here": None}
LOADS = ("h_min", "relative_misalignment", "leakage")

# What each study hands on when nothing of it succeeds.
ANSWERS = {
    "campbell": {"speed": THREE, "unit": "rpm", "own_speed": 0.0, "lines": [1.0, 0.5], "crossings": [],
                 "thresholds": [], "modes": [{"kind": "tilt", "frequency": THREE, "log_decrement": UNKNOWN,
                                              "directions": 3 * ["none"]}]},
    "coefficients": {
        "stiffness": np.eye(3).tolist(), "damping": np.eye(3).tolist(),
        "at": {"tilt_x": 0.0, "tilt_y": 0.0, "clearance": 1e-5, "axial_opening": 0.0, "speed": 0.0, "h_min": 1e-5},
        "tilted": {"stiffness": None, "damping": None, "at": None, "said": WHY},
        **{f"against_{x}": {x: THREE, "stiffness": UNKNOWN, "damping": UNKNOWN}
           for x in ("speed", "clearance", "tilt")},
    },
    "contact_onset": {"key": "rotor.runout", "formula": None, "nonlinear": None, **LOST, "over": "film.coning",
                      "curve": [{"value": 1.0, **LOST}, {"value": 2.0, **LOST}]},
    "critical_speed": {
        "formula": None, "eigenvalue": 5600.0, "time_domain": {"value": None},
        "growth": {"speed": [5000.0, 5600.0, 6000.0], "eigenvalue": UNKNOWN, "time_domain": UNKNOWN,
                   "uncertainty": UNKNOWN},
        "nonlinear": {"verdict": WHY, "contact_tilt": 1e-4, "tipping": [LOST],
                      "directions": [{"speed": 5000.0, **LOST}, {"speed": 6000.0, **LOST}],
                      "branch": {"speed": [5500.0], "amplitude": [1e-5], "growth_rate": [1.0]}},
    },
    "elastic_ring": {"initial": 1.0, "points": [], "curve": dict.fromkeys(("net", "initial", "load_support"), THREE)},
    "equilibrium": {"closing_force": 100.0, "roots": [],
                    "curve": {"clearance": THREE, "opening_force": THREE, "stiffness": THREE}},
    "failures": {"rows": [{"item": 1, "title": "chaos", **LOST}]},
    "load_support": {"keys": ["shaft.speed"], "axes": [AXIS], "rows": 3 * [LOST]},
    "neutral_stability": {"damping": [], "reason": WHY, "drift": [], "drift_reason": WHY, "resolved": None,
                          "turns": 60},
    "pressure": {"film": "linear", "pressure": None},
    "rub": {"key": "rotor.runout", "touch": 1e-7, "rows": [], "judge": None, "methods": None, "separation": None,
            "whirl": {"rows": [{"speed": 1.0, **LOST}]}},
    "runup": {
        "key": "shaft.speed", "begin": 1.0, "end": 3.0, "order": 1.0, "tilting": True, "threshold": None, "whirl": None,
        "linear": {"speed": THREE, "amplitude": [0.0, 0.0, 0.0], "phase": THREE}, "waterfall": None,
        "touch_rate": None, "rows": [{"rate": 1.0, **LOST}], "curve": {n: [] for n in (*LOADS, "rate", "touched")},
    },
    "runup of a load": {"key": "film.outer_pressure", "begin": 1.0, "end": 3.0, "unit": "Pa", "rate_unit": "Pa/s",
                        "decay": 1.0, "quasi_static": {n: UNKNOWN for n in LOADS}, "rows": [{"rate": 1.0, **LOST}]},
    "sealing_number": {
        "balance": [{"force_ratio": q, **LOST} for q in (1.2, 20.0)], "published": [],
        "released": [{"force_ratio": 2.0, **LOST}],
        "line": {"force_ratio": THREE, "sealing_number": THREE}, "foreseen": {"force_ratio": [], "sealing_number": []},
        "least_force_ratio": 1.6, "least_attracting_force_ratio": 1.7,
        "map": {"guide": THREE, "hang_up_below": THREE, "straightens_above": THREE,
                "closed_form": {"force_ratio": THREE, "guide": [0.1, 0.3, 0.5]}},
    },
    "stability": {"axes": {"x": AXIS, "y": {**AXIS, "key": "film.coning"}}, "tilt_growth_rate": 3 * [UNKNOWN],
                  "growth_rate": 3 * [UNKNOWN], "unconditional": {"limit": None}, "confirmed": []},
    "steady_state": {"period": 1.0, "multipliers": None, "stable": None},
    "sweep": {"keys": ["a", "b"], "axes": 2 * [AXIS], "outputs": ["h_min.value"], "output_units": {"h_min.value": "m"},
              "rows": 9 * [LOST]},
    "tolerance": {
        "keys": ["a", "b"], "outputs": ["h_min.value"], "output_units": {"h_min.value": "m"},
        "nominal": {"h_min.value": None}, "quantiles": {"h_min.value": dict.fromkeys(("1", "5", "25", "50"))},
        "scatter": {name: {"unit": "rad"} for name in "ab"}, "sobol": {"total": None, "reason": WHY},
        "tighten": {"h_min.value": [{"key": name, "total": None, "rank_correlation": None} for name in "ab"]},
        "samples": {"keys": {name: 2 * THREE for name in "ab"}, "outputs": {"h_min.value": 2 * UNKNOWN},
                    "contact": 2 * UNKNOWN},
        "convergence": {"samples": [16], "runs": [32], "output": "h_min.value", "quantiles": {},
                        "probability_of_contact": [[None, 0.0, 1.0]], "total": {"a": [None], "b": [None]}},
    },
    "transmissibility": {
        "speed": THREE, "unit": "rad/s", "formula_holds": False, "phase": WHY, "crossings": [], "table": [],
        "best": {name: [{"seal": None, "from": 1.0, "to": 3.0}] for name in ("static", "dynamic", "total")},
        "film": WHY, "time_domain": [{"seal": "fmr", **LOST}],
        **{name: {**SEAL, "linear_algebra": SEAL} for name in ("fmr", "fms", "fmsr")},
    },
    "vibration": {
        "directions": ["axial"], "outer_radius": 0.04, "accelerations": [], "modes": [], "gear_mesh": [],
        "table": {"frequency": THREE, "axial_gain": THREE, "axial_touch": 3 * [0.0], "axial_touch_aligned": THREE},
        "time_domain": [{"direction": "axial", "frequency": 1.0, **LOST}],
    },
    "wear": {"history": {"time": []}, "end": {"said": WHY}},
    "work_precision": {
        "where": "end", "judge_error": None, "methods": {}, "models": [], "scene": {"turns": 1.0},
        "machine": dict.fromkeys(("processor", "cores", "python", "numpy", "scipy", "scikit-sundae", "numba"), "x"),
    },
}  # fmt: skip


@pytest.mark.parametrize("name", ANSWERS)
def test_a_study_without_an_answer_has_a_page_that_says_why(name, tmp_path):
    settings = {"repeats": 1, "tolerances": 1, "loosest": 1.0, "tightest": 1.0}
    study = name.split()[0]
    meta = {
        "study": study,
        "name": "seal",
        "question": "Does it ride?",
        "overrides": [],
        "version": "1",
        "settings": settings,
    }
    path = write_study(tmp_path / "s.h5", "", {}, meta, {**NOTHING, **ANSWERS[name]}, {})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = drawn(import_module(f"sealdyn.report.charts.study_{study}"), path, tmp_path / "s.png")
    assert text_trouble(figure) == ([], [])
    said = " ".join(text.get_text() for text in [*figure.texts, *(t for ax in figure.axes for t in ax.texts)])
    assert WHY[1:] in " ".join(said.split()) or name in (
        "campbell",
        "coefficients",
        "elastic_ring",
        "equilibrium",
        "transmissibility",
    )
