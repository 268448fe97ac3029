"""Charts of seals that nobody tuned: tiny tilts, aligned faces, no threshold, nothing that touches."""

import re

import numpy as np
import pytest
from drawn import curve, drawn, panel, study, text_trouble
from made_up_run import SUMMARY, drop, whirling, write
from matplotlib.collections import LineCollection

from sealdyn.report.charts import film, orbit, overview, spectrum
from sealdyn.report.charts.page import free_side
from sealdyn.report.charts.record import fitting
from sealdyn.report.text import speed_unit

RPM = '# Does it ride?\n[shaft]\nspeed = "9550 rpm"\n'
LONG = 9


def ticks(ax):
    """Labels of the ticks in view of both axes, and what stands beside an axis as a factor of them."""
    ax.figure.draw_without_rendering()
    shown = []
    for axis, limits in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        low, high = sorted(limits)
        at = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=False)
        words = [label.get_text() for place, label in at if low <= place <= high]
        shown.append([re.sub(r"[${}]|\\mathdefault", "", word) for word in words if word])
    return shown, [axis.get_offset_text().get_text() for axis in (ax.xaxis, ax.yaxis)]


def must_be_legible(figure):
    """No text on another or off the page, no empty panel, and ticks that are short, distinct and without a factor."""
    assert text_trouble(figure) == ([], [])
    for ax in figure.axes:
        if not (ax.axison and ax.xaxis.get_visible()):
            continue
        labels, factors = ticks(ax)
        assert factors == ["", ""], ax.get_title("left")
        for words in labels:
            assert len(set(words)) == len(words) and all(len(word) <= LONG for word in words), words


def empty(figure):
    """Titles of panels that say only why they are empty."""
    return [ax.get_title("left") for ax in figure.axes if ax.axison and not ax.xaxis.get_visible()]


def said(figure):
    return [text.get_text() for text in figure.texts]


# --- runs --------------------------------------------------------------------------------------------------


def test_units_follow_the_size():
    assert fitting("µrad", 3.0) == ("µrad", 1.0) and fitting("ml/h", 1e-6) == ("ml/h", 1.0)
    assert fitting("µrad", 0.0142) == ("nrad", 1e3) and fitting("µm", 3e-5) == ("pm", 1e6)
    assert fitting("µm", 0.0) == ("µm", 1.0)


@pytest.mark.parametrize("chart", [overview, orbit, film, spectrum], ids=lambda chart: chart.__name__.split(".")[-1])
def test_tiny_tilts_are_read_in_tiny_units(tmp_path, chart):
    archive = write(tmp_path / "seal.h5", whirling(tilt=2e-11))
    figure = drawn(chart, archive, tmp_path / "chart.png")
    must_be_legible(figure)
    words = [text.get_text() for ax in figure.axes for text in (ax.xaxis.label, ax.yaxis.label)]
    assert chart is film or any("prad" in word for word in words)


def test_aligned_faces_have_no_panel_of_tilts(tmp_path):
    columns = whirling()
    columns |= {name: 0 * columns[name] for name in columns if "tilt" in name or "misalignment" in name}
    archive = write(tmp_path / "seal.h5", columns)
    for chart in (overview, spectrum):
        figure = drawn(chart, archive, tmp_path / "chart.png")
        must_be_legible(figure)
        assert empty(figure) == [] and not any("ilt" in ax.get_title("left") for ax in figure.axes)
    assert len(drawn(orbit, archive, tmp_path / "chart.png").axes) == 1


def test_a_run_of_two_turns_is_not_drawn_twice(tmp_path):
    figure = drawn(overview, write(tmp_path / "seal.h5", whirling(samples=200, turns=1.5)), tmp_path / "chart.png")
    titles = [ax.get_title("left") for ax in figure.axes]
    assert len(titles) == len(set(titles)) and not any("last" in title for title in titles) and empty(figure) == []
    must_be_legible(figure)


@pytest.mark.parametrize("touch, there", [(1.6e-5, True), (2e-4, False)], ids=["near", "far"])
def test_asperities_that_meet_above_the_film_are_named_in_the_panel(tmp_path, touch, there):
    archive = write(tmp_path / "seal.h5", whirling(), summary={**SUMMARY, "contact": {"touch_at": touch, "touches": 1}})
    ax = panel(drawn(overview, archive, tmp_path / "chart.png"), "Smallest film thickness")
    ax.figure.draw_without_rendering()
    names = {text.get_text(): text for text in ax.texts}
    assert ("asperities meet" in names) == there and "clearance" in names
    inside = ax.get_window_extent()
    for name in names.values():
        box = name.get_window_extent()
        assert inside.y0 <= box.y0 and box.y1 <= inside.y1 + 1


def test_a_name_of_a_level_hides_no_curve():
    x = np.linspace(0.0, 1.0, 101)
    assert free_side(x, [0.5 + 0 * x], 0.0, 0.1) == {"side": "right", "below": False}
    assert free_side(x, [0.05 * x], 0.0, 0.1) == {"side": "left", "below": False}
    assert free_side(x, [0.05 + 0 * x], 0.0, 0.1) == {"side": "right", "below": True}


def test_a_curve_that_hardly_changes_is_a_flat_line(tmp_path):
    columns = whirling(samples=400)
    flow = 1.24205e-3 * (1 + 4e-6 * np.sin(np.arange(400)))
    archive = write(tmp_path / "seal.h5", {**columns, "leakage_inner": flow, "leakage_outer": flow})
    ax = panel(drawn(overview, archive, tmp_path / "chart.png"), "Leakage")
    low, high = ax.get_ylim()
    assert high - low > 0.1 * high and all(len(word) <= 5 for word in ticks(ax)[0][1])


def test_a_heading_tells_all_and_warns(tmp_path):
    message = " ".join(f"sentence number {n} of what happened," for n in range(30)) + " the end"
    summary = {**SUMMARY, "warnings": ["not isothermal: friction heats", "perhaps turbulent: a Reynolds number"]}
    for chart in (overview, film, orbit):
        archive = write(tmp_path / "seal.h5", whirling(), "collapsed", message, summary)
        figure = drawn(chart, archive, tmp_path / "chart.png")
        words = " ".join(said(figure))
        assert message in words and "…" not in words and "not isothermal; perhaps turbulent" in words
        assert text_trouble(figure) == ([], [])


def test_a_study_repeats_the_question_not_the_whole_comment(tmp_path):
    asked = "Does it ride?  It is a seal of nobody.  Expected: no."
    figure = study(tmp_path, "contact_onset", ONSET, question=asked)
    assert said(figure)[:2] == ["When do the faces first touch?", "seal: Does it ride?"]


def test_speeds_are_read_as_they_were_written(tmp_path):
    assert speed_unit({"scenario": RPM})[0] == speed_unit({"overrides": ["shaft.speed=9550 rpm"]})[0] == "rpm"
    assert speed_unit({"scenario": "[shaft]\nspeed = 1000  # 9550 rpm\n# speed = 9550 rpm"}) == ("rad/s", 1.0)
    archive = write(tmp_path / "seal.h5", whirling(), text=RPM)
    figure = drawn(overview, archive, tmp_path / "chart.png")
    assert "82 930 rpm" in [text.get_text() for ax in figure.axes for text in ax.texts]


def test_without_waves_of_tilt_nothing_is_left_of_the_orbit(tmp_path):
    figure = drawn(overview, write(tmp_path / "seal.h5", drop(whirling(), "tilt", "misalignment")), tmp_path / "c.png")
    must_be_legible(figure)
    assert "Orbit of the relative tilt" not in [ax.get_title("left") for ax in figure.axes]


# --- studies -----------------------------------------------------------------------------------------------

ONSET = {"key": "rotor.runout", "formula": None, "nonlinear": None, "failed": "linear theory never touches",
         "over": None, "curve": [], "status": "failed"}  # fmt: skip


def test_an_onset_without_an_answer_shows_what_linear_theory_sees(tmp_path):
    linear = {"forcing": [0.0, 1e-3, 2e-3], "h_min": [8e-7, 7.9e-7, 7.8e-7], "own": 2e-4}
    figure = study(tmp_path, "contact_onset", {**ONSET, "clearance": 8e-7, "linear": linear})
    (ax,) = figure.axes
    assert empty(figure) == [] and ax.get_ylim()[0] <= 0 and ax.get_ylim()[1] >= 0.8
    must_be_legible(figure)
    assert len(study(tmp_path, "contact_onset", ONSET).axes) == 1


@pytest.mark.parametrize("scenario, unit", [(RPM, "1000 rpm"), ("", "krad/s")], ids=["rpm", "rad per second"])
def test_growth_without_a_threshold_is_seen_at_every_speed(tmp_path, scenario, unit):
    speed, rates = [1.6e5, 5.2e5, 1.6e6, 5.2e6], [-9.9, -15.0, -68.0, -670.0]
    growth = {"speed": speed, "eigenvalue": rates, "time_domain": rates, "uncertainty": 4 * [1e-3]}
    nothing = {"verdict": "No threshold, so no whirl branches off.", "tipping": []}
    answer = {"formula": None, "eigenvalue": None, "time_domain": {"value": None}, "growth": growth,
              "nonlinear": nothing}  # fmt: skip
    figure = study(tmp_path, "critical_speed", answer, scenario)
    must_be_legible(figure)
    (ax,) = figure.axes
    assert ax.get_xlabel().endswith(unit) and ax.get_xscale() == "log"
    box, title = ax.get_legend().get_window_extent(), ax._left_title.get_window_extent()
    assert not box.overlaps(title) and box.y1 < ax.get_window_extent().y0
    # Each point apart from its neighbours, and zero in view.
    low, high = ax.get_ylim()
    assert low < min(rates) and high > 0
    at = ax.transData.transform(np.column_stack([ax.lines[1].get_xdata(), ax.lines[1].get_ydata()]))
    assert np.abs(np.diff(at[:, 1])).min() > 10


def test_a_map_of_one_sign_shows_its_own_range(tmp_path):
    axes = {"x": {"key": "shaft.speed", "unit": "rad/s", "values": [100.0, 200.0, 300.0], "here": 200.0},
            "y": {"key": "film.coning", "unit": "rad", "values": [0.0, 1e-3, 2e-3], "here": 1e-3}}  # fmt: skip
    rates = [[-31.0, -30.5, -30.2], [-30.9, -30.4, -30.1], [-30.8, -30.3, -30.0]]
    answer = {"axes": axes, "growth_rate": rates, "tilt_growth_rate": rates, "unconditional": {"limit": None},
              "confirmed": []}  # fmt: skip
    figure = study(tmp_path, "stability", answer, RPM)
    must_be_legible(figure)
    mesh = figure.axes[0].collections[0]
    shades = {tuple(colour) for colour in mesh.to_rgba(np.array(rates).ravel()).round(2).tolist()}
    assert (mesh.norm.vmin, mesh.norm.vmax) == (-31.0, -30.0) and len(shades) == 9
    assert figure.axes[0].get_xlabel() == "shaft speed, rpm" and figure.axes[0].get_xlim()[1] > 300 * 30 / np.pi
    mixed = {**answer, "growth_rate": [[-1.0, 0.5, 1.0]] * 3, "tilt_growth_rate": [[-1.0, 0.5, 1.0]] * 3}
    norm = study(tmp_path, "stability", mixed).axes[0].collections[0].norm
    assert norm.vmin == -norm.vmax == -1.0


def test_coefficients_of_millions_have_short_ticks_and_a_legend_of_their_own(tmp_path):
    speed = np.linspace(0.0, 4000.0, 9)
    at = {"tilt_x": 0.0, "tilt_y": 0.0, "clearance": 1e-5, "axial_opening": 0.0, "speed": 1256.6, "h_min": 1e-5}
    full = [[1.23e8, -6608.0, 7934.0], [-3538.0, 3.76e4, 1.92e5], [3741.0, -1.92e5, 3.76e4]]

    def sweep(name, values):
        cross = [[[3e8, 0, 0], [0, 2e5, 1e4 * v], [0, -1e4 * v, 2e5]] for v in values]
        return {f"against_{name}": {name: list(values), "stiffness": cross, "damping": np.zeros((9, 3, 3)).tolist()}}

    answer = {"stiffness": full, "damping": full, "at": at, "tilted": {"stiffness": full, "damping": full, "at": at,
              "said": "turning tilt of the linear steady state, at one instant"}}  # fmt: skip
    answer |= sweep("speed", speed) | sweep("clearance", 1e-6 + 1e-9 * speed) | sweep("tilt", 1e-9 * speed)
    figure = study(tmp_path, "coefficients", answer, RPM)
    must_be_legible(figure)
    ax = panel(figure, "Over speed")
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    for line in ax.lines[:4]:
        points = ax.transData.transform(np.column_stack(line.get_data()))
        assert not any(box.contains(*point) for point in points)
    assert any("12000 rpm" in text.get_text() for ax in figure.axes for text in ax.texts)


def rub_row(value):
    return {"value": value, "status": "ok", "direction": "up", "class": "no contact", "contact_share": 0.0,
            "h_min": [7e-6, 7.1e-6], "exponent": -1.0, "uncertainty": 0.1, "section": [[1e-4, 2e-4], [1e-4, 2.1e-4]],
            "orders": [0.0, 1.0, 2.0], "amplitude": [0.0, 1e-4, 1e-6]}  # fmt: skip


@pytest.mark.parametrize("points", [1, 2, 3])
def test_a_rub_of_few_points_leaves_no_part_of_the_page_empty(tmp_path, points):
    answer = {"key": "rotor.runout", "touch": 1e-6, "rows": [rub_row(1e-4 * (k + 1)) for k in range(points)],
              "judge": None, "methods": None, "separation": None, "whirl": None}  # fmt: skip
    figure = study(tmp_path, "rub", answer)
    must_be_legible(figure)
    boxes = [ax.get_position() for ax in figure.axes]
    for x in (0.3, 0.9):
        lowest = min(box.y0 for box in boxes if box.x0 < x < box.x1)
        assert lowest < 0.15


def test_a_runup_whose_rate_does_not_matter_says_so(tmp_path):
    way = {"speed": [10.0, 50.0, 100.0], "amplitude": [9e-9, 8e-9, 7e-9], "phase": [0.0, 0.1, 0.2]}
    answer = {"key": "shaft.speed", "begin": 10.0, "end": 100.0, "order": 1.0, "tilting": True, "threshold": None,
              "whirl": None, "linear": way, "waterfall": None, "touch_rate": None, "disturbance": None,
              "rows": [{"rate": rate, "up": way, "down": way} for rate in (10.0, 1e3)],
              "curve": {"rate": [10.0, 1e3], "h_min": [8e-7, 8.001e-7], "relative_misalignment": [9e-9, 9.01e-9],
                        "leakage": [1.0, 1.0], "touched": [False, False]}}  # fmt: skip
    figure = study(tmp_path, "runup", answer, RPM)
    must_be_legible(figure)
    assert len(figure.axes) == 2 and empty(figure) == [] and figure.axes[1].get_xlabel() == "shaft speed, rpm"
    assert "At every rate the largest relative tilt is 9.01 nrad and the thinnest film 0.8 µm" in " ".join(said(figure))
    answer["curve"]["relative_misalignment"] = [9e-9, 5e-8]
    assert "How fast must one pass?" in [ax.get_title("left") for ax in study(tmp_path, "runup", answer).axes]


def test_a_steady_state_that_was_not_found_shows_linear_theory_alone(tmp_path):
    linear = {"time": [0.0, 0.01, 0.02], "h_min": [2e-6, 2.1e-6, 2e-6], "multipliers": [[0.5, 0.0], [-0.5, 0.0]]}
    figure = study(tmp_path, "steady_state", {"linear": linear, "status": "failed", "reason": "a trial orbit"})
    must_be_legible(figure)
    assert empty(figure) == [] and len(figure.axes) == 2


def test_transmissibility_of_a_turning_stator_and_bars_that_end_at_the_frame(tmp_path):
    seal = {name: [0.1, 0.1, 0.1] for name in ("static", "dynamic", "total", "static_phase", "dynamic_phase")}
    seal["stable"] = 3 * [True]
    wild = dict.fromkeys(("static", "dynamic", "total", "static_phase", "dynamic_phase"), 5.0)
    row = {"seal": "fmr", "speed": 2.0, "error": wild, **dict.fromkeys(wild, 0.1)}
    best = {name: [{"seal": "fmr", "from": 1.0, "to": 3.0}] for name in ("static", "dynamic", "total")}
    answer = {"speed": [1.0, 2.0, 3.0], "unit": "rad/s", "formula_holds": True, "phase": "", "crossings": [],
              "film": "", "table": [], "best": best, "time_domain": [row], "stator_speed": -600.0,
              **{name: {**seal, "linear_algebra": seal} for name in ("fmr", "fms", "fmsr")}}  # fmt: skip
    figure = study(tmp_path, "transmissibility", answer)
    titles = [ax.get_title("left") for ax in figure.axes]
    assert "Static: turns with the stator" in titles and "Static: fixed in space" not in titles
    bars = [line for ax in figure.axes for line in ax.collections if isinstance(line, LineCollection)]
    assert bars and all(line.get_clip_on() for line in bars)


FOLLOWED = {"speed": 100.0, "eccentricity": 1e-4, "radius": 0.025, "most": 5e-3, "runs": [],
            "guide": {"surface_speed": [5.0, 10.0], "eccentricity": [4e-4, 3e-4], "words": "table 3.2"}}  # fmt: skip


def test_a_limit_that_was_not_looked_for_runs_on_along_its_bound(tmp_path):
    lines = [{"name": "soft", "speed": [10.0, 100.0, 200.0], "eccentricity": [None, None, 4e-3]},
             {"name": "held", "speed": [10.0, 100.0, 200.0], "eccentricity": [0.0, 0.0, 0.0]}]  # fmt: skip
    found = [{"curve": 0, "speed": 200.0, "eccentricity": 4e-3}, {"curve": 1, "speed": 10.0, "eccentricity": None}]
    figure = study(tmp_path, "followability", {**FOLLOWED, "curves": lines, "runs": found})
    must_be_legible(figure)
    (ax,) = figure.axes
    names = ax.get_legend_handles_labels()[1]
    assert "held: nothing is followed" in names and names.count("limit found by runs") == 1
    assert curve(ax, "soft")[1] == pytest.approx([5.0, 5.0, 4.0])
    assert "a fifth of the shaft's radius: no limit is looked for beyond" in [text.get_text() for text in ax.texts]
    swapped = {**FOLLOWED, "curves": lines[::-1], "runs": [{"curve": 1, "speed": 200.0, "eccentricity": 4e-3}]}
    assert "limit found by runs" in study(tmp_path, "followability", swapped).axes[0].get_legend_handles_labels()[1]


def neutral(method, *growths, cost=100.0):
    """Rows of a method; None: it failed."""
    return [{"method": method, "accuracy": 0.1**k, "turns": 20, "growth": size, "energy": size,
             "cost": size and cost * (k + 1)} for k, size in enumerate(growths)]  # fmt: skip


def test_methods_without_an_answer_are_named_and_names_lie_beside_the_curves(tmp_path):
    damping = [*neutral("dop853", None, None), *neutral("rk45", None, None), *neutral("expm", 1e-14, 1e-14, cost=10.0),
               *neutral("bdf", 1e-6, 1e-8, cost=5000.0)]  # fmt: skip
    drift = [*neutral("expm", 1e-17, 1e-17, cost=10.0), *neutral("bdf", 1e-4, 1e-9)]
    answer = {"damping": damping, "drift": drift, "reason": "", "drift_reason": "", "turns": 20, "critical_speed": 10.0,
              "resolved": {"rate": 1e-7 * 10 / (2 * np.pi)}}  # fmt: skip
    figure = study(tmp_path, "neutral_stability", answer)
    must_be_legible(figure)
    ax = panel(figure, "Growth")
    crosses = [line for line in ax.lines if line.get_marker() == "x" and len(line.get_xdata())]
    assert len({line.get_xdata()[0] for line in crosses}) == 4
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "DOP853: no answer" in names and "RK45: no answer" in names
    inside = {text.get_text(): text.get_window_extent() for text in ax.texts}
    part = np.linspace(0.0, 1.0, 200)
    way = ax.transData.transform(np.column_stack([5000.0 * 2**part, 10.0 ** (-6 - 2 * part)]))
    assert not any(inside["resolved by study critical-speed"].contains(*point) for point in way)
    alone = study(tmp_path, "neutral_stability", {**answer, "damping": [], "resolved": None, "reason": "no threshold"})
    must_be_legible(alone)
    assert panel(alone, "Energy").get_legend() is None and panel(alone, "Growth").get_legend().get_texts()


def elastic(nets, made=10.0, **point):
    """An answer over these net wavinesses (µm): made with ten times the root, and a point let go."""
    curve = {"net": [1e-6 * net for net in nets], "initial": [1e-6 * made * net**0.5 for net in nets],
             "load_support": [1.0 for _ in nets]}  # fmt: skip
    points = [{"stable": True, "load_support": 1.0, **point}] if point else []
    return {"curve": curve, "initial": 1e-6 * made, "points": points}


def test_an_elastic_ring_has_its_legend_beside_the_curves_and_its_starts_in_view(tmp_path):
    way = {"from": 0.95e-6, "time": [0.0, 1e-3, 2e-3], "net": [0.95e-6, 0.9999e-6, 1e-6]}
    falling = {**elastic([0.1, 1.0, 10.0], net=1e-6, let_go=[way])}
    falling["curve"]["initial"].reverse()
    figure = study(tmp_path, "elastic_ring", falling)
    must_be_legible(figure)
    ax = next(ax for ax in figure.axes if ax.get_ylabel() == "initial waviness, µm")
    assert ax.get_legend().get_window_extent().y0 >= ax.get_window_extent().y1
    assert panel(figure, "Let go").get_ylim()[0] < 0.95


def measured(errors, reasons=(), expected=None):
    """A method's row over its errors (None: it did not end)."""
    status = ["ok" if error is not None else "failed" if expected is None else "stopped" for error in errors]
    walls = [1e-3 * 10**k for k in range(len(errors))]
    reason = list(reasons) or ["" for _ in errors]
    return {"error": dict.fromkeys(("end", "over_time", "steady"), errors), "wall": walls, "status": status,
            "rhs": [1e6 * w for w in walls], "reason": reason, "expected": [expected for _ in errors]}  # fmt: skip


def test_wild_errors_of_a_method_stay_in_the_panel_and_reasons_without_their_place(tmp_path):
    why = "newmark gave up 0.002 s into this segment: Newton does not converge."
    methods = {"bdf": measured([1e-2, 1e-4, 1e-6, 1e-8]), "midpoint": measured([5e5, 2e4]),
               "newmark": measured([None, None], [why, why]), "rk45": measured([None], ["stopped"], 1e7)}  # fmt: skip
    small = dict.fromkeys(("end", "over_time", "steady"), 1e-11)
    rung = {"label": "radial film, which has a long name", "error": small, "failed": None}
    answer = {"where": "over_time", "methods": methods, "judge_error": small, "scene": {"turns": 3.0},
              "models": [{**rung, "wall": 10.0**-k} for k in range(6)],
              "machine": {"processor": "AMD", "cores": 2, "python": "3", "numpy": "2", "scipy": "1",
                          "scikit-sundae": "1", "numba": "0"}}  # fmt: skip
    settings = {"repeats": 1, "tolerances": 4, "loosest": 1e-2, "tightest": 1e-8}
    asked = {"question": "Does it ride?  It is a seal of nobody.", "overrides": [f"run.turns={k}" for k in range(30)]}
    figure = study(tmp_path, "work_precision", answer, settings=settings, **asked)
    assert text_trouble(figure) == ([], []) and "Does it ride?" in said(figure)
    solvers = "fastest solver of this scene"
    assert solvers in [text.get_text() for text in panel(figure, "models").get_legend().get_texts()]
    for ax in figure.axes[:4]:
        left = ax.get_window_extent().x0
        assert all(text.get_window_extent().x0 >= left for text in ax.texts)
        crosses = [x for line in ax.lines if line.get_marker() == "x" for x in line.get_xdata()]
        assert crosses and max(crosses) <= ax.get_xlim()[0]
    assert "✕ Newmark: Newton does not converge." in figure.axes[5].texts[0].get_text()


def test_accelerations_over_many_decades_are_powers_of_ten_throughout(tmp_path):
    frequency = np.geomspace(3, 5400, 41)
    touch = (9.81 * 0.1 * (frequency / 3) ** 2.5).tolist()
    table = {"frequency": frequency.tolist(), "axial_gain": np.linspace(0, 1, 41).tolist(), "axial_touch": touch,
             "axial_touch_aligned": touch}  # fmt: skip
    answer = {"directions": ["axial"], "outer_radius": 0.04, "accelerations": [441.3], "modes": [], "gear_mesh": [],
              "table": table, "time_domain": []}  # fmt: skip
    figure = study(tmp_path, "vibration", answer)
    must_be_legible(figure)
    assert all(word.startswith("10") for word in ticks(figure.axes[0])[0][1])


def worn(times, **flat):
    """An answer of wear at these times (s); columns of the history at these values."""
    history = {"time": times, **dict.fromkeys(("stator_volume", "rotor_volume", "contact_share"), [0.0] * len(times))}
    history |= {name: [value] * len(times) for name, value in flat.items()}
    profile = {"stator": len(times) * [[0.0, 0.0]], "rotor": len(times) * [[0.0, 0.0]],
               "gap": len(times) * [[1e-7, 2e-7]]}  # fmt: skip
    return {"history": history, "end": {"said": "it lifts"}, "radius": [0.03, 0.04], "profile": profile,
            "pv": 2 * [[1e5, 1e5]], "extrapolated": None}  # fmt: skip


LIFTED = {"leakage": 1e-9, "friction_power": 1.25, "contact_area_fraction": 0.0, "mean_clearance": 2e-6, "h_min": 1e-6}


def test_a_seal_that_never_wears_has_its_gap_and_its_numbers(tmp_path):
    figure = study(tmp_path, "wear", worn([0.0], **LIFTED))
    must_be_legible(figure)
    assert [ax.get_title("left") for ax in figure.axes] == ["Shape of the gap, from its narrowest place"]
    assert "leakage 3.6 ml/h, friction 1.25 W, film 1 µm where it is thinnest" in " ".join(said(figure))


def test_what_does_not_change_over_the_hours_is_below_the_top_of_its_panel(tmp_path):
    ax = panel(study(tmp_path, "wear", worn([0.0, 3600.0], **LIFTED)), "Friction power")
    assert ax.get_ylim()[0] == 0.0 and ax.get_ylim()[1] > 1.3
