"""Charts of studies of seals as users have them: what stands in each panel, and that it can be read."""

import numpy as np
import pytest
from drawn import crossed, panel, study, text_trouble
from matplotlib.container import BarContainer
from matplotlib.figure import Figure

from sealdyn.report.charts.page import numbered
from sealdyn.report.charts.record import read_in


def numbers(axis):
    """Labels of the major ticks in view."""
    axis.figure.draw_without_rendering()
    low, high = sorted(axis.get_view_interval())
    at = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
    return [label.get_text() for place, label in at if low <= place <= high]


def titles(figure):
    return [ax.get_title("left") for ax in figure.axes]


def inside(ax):
    """Names in a panel that leave it."""
    ax.figure.draw_without_rendering()
    box = ax.get_window_extent()
    boxes = {text.get_text(): text.get_window_extent() for text in ax.texts}
    return [words for words, b in boxes.items() if b.x0 < box.x0 - 1 or b.x1 > box.x1 + 1]


@pytest.mark.parametrize("low, high", [(3e3, 9e3), (7.0, 55.0), (720.0, 725.0), (0.02, 0.04), (1e-6, 1e3)])
def test_a_logarithmic_axis_has_three_numbers(low, high):
    ax = Figure().subplots()
    ax.set(xscale="log", xlim=(low, high))
    numbered(ax.xaxis)
    shown = numbers(ax.xaxis)
    assert len(shown) >= 3 and len(set(shown)) == len(shown)
    # Mathematical letters ask for fonts that are not on every list.
    assert not any("$" in words for words in shown)


def test_values_of_keys_are_read_in_the_units_of_engineers():
    assert read_in("m", [1e-5]) == ("µm", 1e6) and read_in("m", [0.04]) == ("mm", 1e3)
    assert read_in("rad", []) == ("mrad", 1e3) and read_in("N*s/m", [1.0]) == ("N s/m", 1.0)
    assert read_in("1", [1.0]) == ("", 1.0) and read_in("rad/s", [1.0], ("rpm", 9.5)) == ("rpm", 9.5)


# --- contact onset, threshold ------------------------------------------------------------------------------

ONSET = {"key": "rotor.runout", "over": None, "curve": [], "units": {"forcing": "rad", "value": "SI"}}


def test_faces_that_touch_at_rest_have_no_empty_panel(tmp_path):
    answer = {**ONSET, "formula": 0.0, "nonlinear": 0.0, "clearance": 3.2e-7, "touch": 4.5e-7, "contact_force": 133.0,
              "closing_force": 724.0}  # fmt: skip
    figure = study(tmp_path, "contact_onset", answer)
    (ax,) = figure.axes
    bars = [bar.get_width() for bars in ax.containers if isinstance(bars, BarContainer) for bar in bars]
    assert bars == pytest.approx([100 * 3.2 / 4.5, 100 * 133 / 724]) and ax.get_yaxis().get_visible()
    assert text_trouble(figure) == ([], [])


PATH = {"forcing": [1e-3, 2e-3], "h_min": [5e-6, 0.0], "axial": [0.0, 0.0]}
CLOSES = {**ONSET, "formula": 2e-3, "nonlinear": 2e-3, "clearance": 1e-5, "path": PATH}


def test_a_seal_that_does_not_lift_has_no_panel_of_it(tmp_path):
    assert titles(study(tmp_path, "contact_onset", CLOSES)) == ["Smallest film thickness"]
    lifting = {**CLOSES, "path": {**PATH, "axial": [1e-7, 2e-7]}}
    assert len(study(tmp_path, "contact_onset", lifting).axes) == 2


@pytest.mark.parametrize("own, unit, per", [("100 urad", "µrad", 1e6), (1e-4, "mrad", 1e3)])
def test_an_onset_far_beyond_the_seal_is_seen_beside_it(tmp_path, own, unit, per):
    answer = {**ONSET, "formula": 2.5, "nonlinear": None, "clearance": 1.5e-6, "times_own": 2.5e4, "beyond_tilt": 0.05,
              "failed": "beyond any small tilt"}  # fmt: skip
    figure = study(tmp_path, "contact_onset", answer, f"[rotor]\nrunout = {own!r}\n")
    (ax,) = figure.axes
    assert ax.get_xlabel() == f"rotor.runout, {unit}" and f" the scenario's own, {per * 1e-4:.4g} {unit} " in [
        text.get_text() for text in ax.texts
    ]
    place = ax.transAxes.inverted().transform(ax.transData.transform([(per * x, 0.0) for x in (1e-4, 0.05, 2.5)]))[:, 0]
    assert 0.05 < place[0] < place[1] - 0.2 < place[2] - 0.4 < 0.6 and text_trouble(figure) == ([], [])


def test_a_small_onset_is_read_in_microradians(tmp_path):
    path = {"forcing": [1e-4, 2e-4], "h_min": [5e-6, 0.0], "axial": [0.0, 0.0]}
    answer = {**CLOSES, "formula": 2e-4, "nonlinear": 2e-4, "path": path}
    assert study(tmp_path, "contact_onset", answer).axes[0].get_xlabel() == "rotor.runout, µrad"


def test_an_onset_over_a_key_is_read_in_its_unit(tmp_path):
    rows = [{"value": v, "formula": 2e-3, "nonlinear": 2e-3} for v in (5e-6, 8e-6)]
    answer = {**CLOSES, "over": "film.clearance", "curve": rows, "units": {"forcing": "rad", "value": "m"}}
    figure = study(tmp_path, "contact_onset", answer)
    ax = panel(figure, "Onset over film.clearance")
    assert ax.get_xlabel() == "film.clearance, µm" and ax.lines[0].get_xdata() == pytest.approx([5.0, 8.0])
    for ax in figure.axes:
        figure.draw_without_rendering()
        box, room = ax.get_legend().get_window_extent(), ax.get_window_extent()
        assert room.x0 <= box.x0 and box.x1 <= room.x1


def test_a_threshold_that_was_not_run_in_time_is_seen_by_its_eigenvalues(tmp_path):
    growth = {"speed": [3.6e4, 3.8e4, 4.0e4], "eigenvalue": [-2.0, -0.1, 2.0], "time_domain": 3 * [None],
              "uncertainty": 3 * [None]}  # fmt: skip
    answer = {"formula": 3.81e4, "eigenvalue": 3.81e4, "time_domain": {"value": None}, "growth": growth,
              "nonlinear": {"verdict": "Beyond linear: not followed at such a speed."}}  # fmt: skip
    figure = study(tmp_path, "critical_speed", answer)
    (ax,) = figure.axes
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert ax.lines[1].get_ydata() == pytest.approx([-2.0, -0.1, 2.0]) and not any("time" in w for w in words)


# --- equilibrium, stability, vibration ---------------------------------------------------------------------


def test_the_clearance_of_a_rough_seal_is_named_beside_its_curve(tmp_path):
    clearance = np.geomspace(3e-8, 3e-6, 241)
    rough, film = 1e3 * (2e-7 / clearance) ** 5, 500.0 * (3e-7 / clearance) ** 0.15
    opening = rough + film
    root = float(np.interp(-700.0, -opening, clearance))
    curve = {"clearance": clearance.tolist(), "opening_force": opening.tolist(), "contact_force": rough.tolist(),
             "stiffness": (-np.gradient(opening, clearance)).tolist()}  # fmt: skip
    roots = [{"clearance": root, "stable": True, "stiffness": 5e9}]
    figure = study(tmp_path, "equilibrium", {"closing_force": 700.0, "roots": roots, "curve": curve})
    ax = panel(figure, "Opening and closing force")
    assert crossed(ax) == [] and text_trouble(figure) == ([], [])
    # No half of the panel where every force is beyond it.
    low, high = np.log(ax.get_xlim())
    seen = np.log(1e6 * clearance[opening < ax.get_ylim()[1]][0])
    assert (seen - low) / (high - low) < 0.25


def test_marks_and_words_of_a_map_are_whole(tmp_path):
    axes = {"x": {"key": "shaft.speed", "unit": "rad/s", "values": np.geomspace(100, 1e4, 9).tolist(), "here": 200.0},
            "y": {"key": "film.coning", "unit": "rad", "values": [0.0, 1e-3, 2e-3], "here": 1e-3}}  # fmt: skip
    rates = [[*(8 * [-30.0]), 5.0]] * 3
    answer = {"axes": axes, "growth_rate": rates, "tilt_growth_rate": rates, "unconditional": {"limit": None},
              "confirmed": [{"x": 100.0, "y": 0.0, "failed": "too slow"}]}  # fmt: skip
    ax = study(tmp_path, "stability", answer).axes[0]
    assert {text.get_text() for text in ax.texts} == {"stable", "unstable"} and inside(ax) == []
    assert not any(line.get_clip_on() for line in ax.lines if line.get_label() == "not confirmed")
    assert numbers(ax.yaxis) == ["0", "1", "2"]
    # The word of a narrow region does not lie at its end.
    (word,) = [text for text in ax.texts if text.get_text() == "unstable"]
    assert word.get_position()[1] == pytest.approx(1.0)


def test_the_star_of_the_scenario_lies_on_no_frame(tmp_path):
    axes = {
        "x": {"key": "shaft.speed", "unit": "rad/s", "values": np.geomspace(100, 1e4, 41).tolist(), "here": 1e4},
        "y": {"key": "inertia_ratio", "unit": "1", "values": np.linspace(0.5, 4, 41).tolist(), "here": 0.51},
    }
    rates = np.linspace(-1, 1, 41**2).reshape(41, 41).tolist()
    answer = {"axes": axes, "growth_rate": rates, "tilt_growth_rate": rates, "unconditional": {"limit": None},
              "confirmed": []}  # fmt: skip
    ax = study(tmp_path, "stability", answer).axes[0]
    (star,) = [line for line in ax.lines if line.get_label() == "this scenario"]
    (at,), room = ax.transData.transform(np.column_stack(star.get_data())), ax.get_window_extent()
    half = 0.5 * star.get_markersize() / 72 * ax.figure.dpi
    assert min(at[0] - room.x0, room.x1 - at[0], at[1] - room.y0, room.y1 - at[1]) > half
    # The rest of the map is where it was.
    assert ax.get_xlim()[0] < 100 and ax.get_xlim()[1] < 1.3e4 and ax.get_ylim()[0] > 0.35 and ax.get_ylim()[1] < 4.1


def test_amplitudes_of_a_housing_are_named_where_no_curve_runs(tmp_path):
    frequency = np.geomspace(3, 5400, 41)
    touch = 0.07 * (frequency / 3) ** 1.6
    table = {"frequency": frequency.tolist(), "axial_gain": np.linspace(0, 1, 41).tolist(),
             "axial_touch": touch.tolist(), "axial_touch_aligned": touch.tolist()}  # fmt: skip
    answer = {"directions": ["axial"], "outer_radius": 0.04, "accelerations": [441.3], "modes": [], "gear_mesh": [],
              "table": table, "time_domain": []}  # fmt: skip
    figure = study(tmp_path, "vibration", answer)
    ax = figure.axes[0]
    assert ax.texts and inside(ax) == []
    (curve,) = [line for line in ax.lines if line.get_linewidth() == 3.0]
    points = ax.transData.transform(np.column_stack(curve.get_data()))
    for text in ax.texts:
        box = text.get_window_extent()
        assert not any(box.contains(*point) for point in points), text.get_text()


def pressure(tmp_path, waves, thickest=2.0):
    r, theta = np.linspace(0.045, 0.05, 9), np.linspace(0, 2 * np.pi, 48, endpoint=False)
    p = 1e5 * (1 + (r[:, None] - 0.045) / 0.005) * (1 + waves * (1 + np.sin(3 * theta)) ** 3)
    profiles = {"at": {"thinnest": 1.0, "thickest": thickest, "mid_radius": 0.0475}, "circle_mean": p.mean(1).tolist(),
                "thinnest": p[:, 0].tolist(), "thickest": p[:, 9].tolist(), "width_mean": p.mean(0).tolist(),
                "mid_radius": p[4].tolist()}  # fmt: skip
    answer = {"film": "reynolds", "pressure": {"r": r.tolist(), "theta": theta.tolist(), "p": p.tolist()},
              "edges": {"inner": [0.045], "outer": [0.05]}, "profiles": profiles, "clearance": 1e-6,
              "h_min": {"theta": 1.0, "radius": 0.045}, "centre_of_pressure": 0.4,
              "high_pressure": "outer"}  # fmt: skip
    return study(tmp_path, "pressure", answer)


def test_no_legend_hides_a_pressure(tmp_path):
    figure = pressure(tmp_path, 0.5)
    figure.draw_without_rendering()
    for title in ("Over the radius", "Around the circle"):
        ax = panel(figure, title)
        box = ax.get_legend().get_window_extent()
        for line in (line for line in ax.lines if len(line.get_xdata()) > 2):
            points = ax.transData.transform(np.column_stack(line.get_data()))
            assert not any(box.contains(*point) for point in points), line.get_label()
    assert text_trouble(figure) == ([], [])


def test_pads_have_no_one_thinnest_place(tmp_path):
    named = panel(pressure(tmp_path, 0.5), "Over the radius"), panel(pressure(tmp_path, 0.5, 1.0), "Over the radius")
    assert [sum("where the film" in line.get_label() for line in ax.lines) for ax in named] == [2, 0]


def test_aligned_faces_have_nothing_to_show_around_the_circle(tmp_path):
    assert "Around the circle" not in titles(pressure(tmp_path, 0.0))


def test_cavities_end_where_none_is_left(tmp_path):
    axis = {"key": "contact.roughness", "unit": "um", "values": [0.1, 0.2, 0.3]}
    rows = [{"load_support": 1.0, "clearance": 1e-6, "cavitated_fraction": torn} for torn in (0.3, 0.1, 0.0)]
    figure = study(tmp_path, "load_support", {"keys": ["contact.roughness"], "axes": [axis], "rows": rows})
    (area,) = figure.axes[0].collections
    assert area.get_paths()[0].vertices[:, 0].max() == pytest.approx(0.3)


# --- coefficients, transmissibility ------------------------------------------------------------------------


def coefficients(tmp_path, damping, **more):
    at = {"tilt_x": 2e-12, "tilt_y": 0.0, "clearance": 1e-5, "axial_opening": 2e-20, "speed": 100.0, "h_min": 1e-5}
    k, d = np.diag([1e7, 5e3, 5e3]).tolist(), np.diag([damping * 100, damping, damping]).tolist()
    answer = {"stiffness": k, "damping": d, "at": at,
              "tilted": {"stiffness": k, "damping": d, "at": at, "said": "mean tilt"}}  # fmt: skip
    answer |= {f"against_{x}": {x: [1e-6, 2e-6, 3e-6], "stiffness": 3 * [k], "damping": 3 * [d]}
               for x in ("speed", "clearance", "tilt")}  # fmt: skip
    return study(tmp_path, "coefficients", answer | more)


def test_constant_stiffness_and_damping_do_not_hide_each_other(tmp_path):
    figure = coefficients(tmp_path, 3.6)
    heights = []
    for ax in figure.axes:
        if ax.get_ylabel().startswith("tilt damping") or ax.get_ylabel().startswith("axial"):
            low, high = ax.get_ylim()
            heights.append((ax.lines[0].get_ydata()[0] - low) / (high - low))
    assert len(heights) == 2 and abs(heights[0] - heights[1]) > 0.1
    words = " ".join(text.get_text() for ax in figure.axes for text in ax.texts)
    assert "opening 0 µm" in words and "tilt 2 prad" in words


def test_the_names_of_stiffnesses_lie_on_no_title(tmp_path):
    matrix = np.diag([1e8, 1e6, 1e6])
    matrix[0, 1] = 1e-7
    sweep = {"frequency": [0.0, 2e4, 5e4], "stiffness": 3 * [matrix.tolist()], "damping": 3 * [matrix.tolist()]}
    figure = coefficients(tmp_path, 3.6, stiffness=matrix.tolist(), against_frequency=sweep)
    assert text_trouble(figure) == ([], [])
    figure.draw_without_rendering()
    box = panel(figure, "Over speed").get_legend().get_window_extent()
    heads = [*(ax._left_title for ax in figure.axes), *figure.texts]
    assert not any(box.overlaps(words.get_window_extent()) for words in heads if words.get_text())
    assert any(ax.get_xlabel() == "frequency of the motion, Hz" for ax in figure.axes)
    # A coupling of rounding is none.
    assert not any("e−7" in text.get_text() for ax in figure.axes for text in ax.texts)


def words_below_title(figure):
    return [text.get_text() for text in figure.texts]


def test_what_is_zero_is_named_and_not_drawn(tmp_path):
    figure = coefficients(tmp_path, 0.0)
    assert "Not drawn, zero: Kxy, Kyx, tilt damping." in words_below_title(figure)
    assert not any(ax.get_ylabel().startswith("tilt damping") for ax in figure.axes)
    legend = [text.get_text() for text in panel(figure, "Over speed").get_legend().get_texts()]
    assert legend == ["Kxx", "Kyy"]
    (ax,) = [ax for ax in figure.axes if ax.get_ylabel() == "axial stiffness, N/µm"]
    assert len(ax.lines) == 1 and text_trouble(figure) == ([], [])


def test_a_stiffness_that_cannot_be_told_from_zero_is_named_with_its_size(tmp_path):
    k = [[1e7, 0.0, 0.0], [0.0, 2e4, 1e7], [0.0, -1e7, 2e4]]
    sweeps = {f"against_{x}": {x: [1.0, 2.0], "stiffness": 2 * [k], "damping": 2 * [k]}
              for x in ("speed", "clearance", "tilt")}  # fmt: skip
    found = {"speed": [1.0], "frequency": [0.0, 1.0], "clearance": [[1e-5, 1e-5]], "stiffness": [2 * [k]],
             "damping": [np.zeros((2, 3, 3)).tolist()]}  # fmt: skip
    figure = coefficients(tmp_path, 3.6, map=found, **sweeps)
    assert "Not drawn, under 1 % of the others: Kxx, Kyy (at most 20 kN m/rad)." in words_below_title(figure)
    assert titles(figure).count("Tilt K, kN m/rad") == titles(figure).count("Cross K, MN m/rad") == 1
    assert not any(title.startswith("Tilt D") for title in titles(figure))


def test_the_figure_of_coefficients_says_at_which_clearance(tmp_path):
    words = " ".join(words_below_title(coefficients(tmp_path, 3.6)))
    assert "Clearance over speed: held at 10 µm, the balance at 100 rad/s; over tilt: the faces open" in words


def test_a_table_of_tiny_transmissibilities_keeps_its_columns(tmp_path):
    three = [1e-6, 2e-6, 3e-6]
    seal = dict.fromkeys(("static", "dynamic", "total", "static_phase", "dynamic_phase"), three) | {
        "stable": 3 * [True]
    }
    value = dict.fromkeys(("fmr", "fms", "fmsr"), 6.8071234e-7)
    speed = dict.fromkeys(("fmr", "fms", "fmsr"), 6.3715e5)
    table = [{"quantity": name, **dict.fromkeys(("formula", "linear_algebra", "time_domain"), cells)}
             for name, cells in (("static_transmissibility", value), ("critical_speed", speed))]  # fmt: skip
    error = dict.fromkeys(seal, 5e-6) | {"static_phase": 1.0, "dynamic_phase": 1.0}
    row = {"seal": "fmr", "speed": 20.0, **{name: 2e-6 for name in seal}, "error": error}
    answer = {"speed": [10.0, 20.0, 30.0], "unit": "rad/s", "formula_holds": True, "phase": "Phase.", "film": "Film.",
              "best": {name: [{"seal": "fmr", "from": 10.0, "to": 30.0}] for name in ("static", "dynamic", "total")},
              "table": table, "time_domain": [row], "crossings": [],
              **{name: {**seal, "linear_algebra": seal} for name in ("fmr", "fms", "fmsr")}}  # fmt: skip
    figure = study(tmp_path, "transmissibility", answer, '[shaft]\nspeed = "1000 rpm"\n')
    assert text_trouble(figure) == ([], [])
    (ax,) = [ax for ax in figure.axes if any(text.get_text() == "FMSR" for text in ax.texts)]
    words = [text.get_text() for text in ax.texts]
    assert "6.807e−7" in words and "critical speed, rpm" in words and f"{6.3715e5 * 30 / np.pi:.5g}" not in words
    assert inside(ax) == []
    # Bars of an error that leave the panel are cut there.
    bars = [bar for ax in figure.axes for bar in ax.collections if bar.get_label().startswith("_")]
    assert all(bar.get_clip_on() for bar in bars)


# --- sweep, tolerance --------------------------------------------------------------------------------------


def sweep(tmp_path, axes, rows, outputs):
    answer = {"keys": [axis["key"] for axis in axes], "axes": axes, "outputs": outputs, "rows": rows,
              "output_units": dict.fromkeys(outputs, "m")}  # fmt: skip
    return study(tmp_path, "sweep", answer)


def test_nothing_lies_between_words(tmp_path):
    models = {"key": "film.model", "unit": None, "values": ["radial", "linear"]}
    figure = sweep(tmp_path, [models], [{"h_min.value": 1e-6}, {"h_min.value": 2e-6}], ["h_min.value"])
    assert figure.axes[0].lines[0].get_linestyle() == "None"


def test_a_map_tells_points_without_a_value_from_the_page(tmp_path):
    axes = [{"key": "rotor.runout", "unit": "mrad", "values": [0.0, 0.5]}, {"key": "film.coning", "unit": "mrad",
            "values": [1.0, 2.0]}]  # fmt: skip
    outputs = [f"relative_misalignment.steady_max_{k}" for k in range(8)]
    rows = [dict.fromkeys(outputs, value) for value in (1e-6, None, 2e-6, None)]
    figure = sweep(tmp_path, axes, rows, outputs)
    ax = panel(figure, outputs[0])
    assert ax.patch.get_hatch() and numbers(ax.xaxis) == ["0", "0.5"]
    assert any("Hatched: no value" in text.get_text() for text in figure.texts) and text_trouble(figure) == ([], [])


def tolerance(tmp_path, runs):
    tilts, films = np.linspace(4e-10, 1.4e-9, 32), 32 * [2e-6]
    names, keys = ["relative_misalignment.max", "h_min.value"], ["film.coning"]
    levels = ("1", "5", "25", "50", "75", "95", "99")
    quantiles = {
        names[0]: dict(zip(levels, np.linspace(4e-10, 1.4e-9, 7), strict=True)),
        names[1]: dict.fromkeys(levels, 2e-6),
    }
    tighten = [{"key": "film.coning", "total": None, "rank_correlation": 1.0, "first": None}]
    answer = {
        "keys": keys, "outputs": names, "output_units": {names[0]: "rad", names[1]: "m"}, "quantiles": quantiles,
        "nominal": {names[0]: 1e-9, names[1]: 2e-6}, "scatter": {"film.coning": {"unit": "rad"}},
        "sobol": {"total": None, "reason": "not asked for"}, "tighten": dict.fromkeys(names, tighten),
        "samples": {"keys": {"film.coning": np.linspace(-3e-3, -1e-3, 32).tolist()},
                    "outputs": {names[0]: tilts.tolist(), names[1]: films}, "contact": 32 * [1]},
        "convergence": {"samples": runs, "runs": runs, "output": names[0],
                        "quantiles": {level: len(runs) * [1e-9] for level in levels},
                        "probability_of_contact": len(runs) * [[1.0, 0.9, 1.0]], "total": {}},
    }  # fmt: skip
    return study(tmp_path, "tolerance", answer)


def test_one_count_of_runs_does_not_settle(tmp_path):
    few, more = (tolerance(tmp_path, runs) for runs in ([32], [32, 64]))
    assert "Quantiles" in titles(more) and "Quantiles" not in titles(few)
    assert few.get_size_inches()[1] < more.get_size_inches()[1]


def test_scattered_outputs_are_read_in_fitting_units(tmp_path):
    figure = tolerance(tmp_path, [32])
    ax = panel(figure, "relative_misalignment.max")
    assert ax.get_xlabel().endswith("nrad") and len(numbers(ax.xaxis)) <= 6
    # An output that is the same in every run is a number, not a bar of no width.
    assert [text.get_text() for text in panel(figure, "h_min.value").texts] == ["2 µm in every run that has a value"]
    cloud = panel(figure, "relative_misalignment.max over film.coning")
    assert cloud.get_xlabel() == "film.coning, mrad" and [line.get_label() for line in cloud.lines] == ["touched"]
    assert text_trouble(figure) == ([], [])


# --- rub, wear, sealing number, run-up, steady state -------------------------------------------------------


def rub(tmp_path, key, unit, values, **more):
    rows = [{"value": v, "status": "ok", "direction": "up", "class": "period 1",
             "contact_share": float(v == values[-1]), "h_min": [1e-7, 1e-7], "exponent": -1.0,
             "uncertainty": 0.1, "section": [[1e-4, 2e-4]],
             "orders": [0.0, 1.0, 2.0], "amplitude": [0.0, 1e-4, 1e-6]} for v in values]  # fmt: skip
    answer = {"key": key, "touch": 1e-6, "rows": rows, "judge": None, "methods": None, "separation": None,
              "whirl": None, "units": {"rows/value": unit}}  # fmt: skip
    return study(tmp_path, "rub", answer | more)


@pytest.mark.parametrize("periods", [40, 200])
def test_the_size_of_an_attractor_is_named_beside_the_runs(tmp_path, periods):
    apart = np.minimum(1e-12 * np.exp(np.arange(periods)), 30.0) * (1 + 0.9 * np.sin(np.arange(periods)))
    separation = {"apart": apart.tolist(), "spread": 8.0, "lost": 30}
    ax = panel(rub(tmp_path, "rotor.runout", "rad", [1e-3], separation=separation), "Two correct runs part")
    ax.figure.draw_without_rendering()
    (name,) = [text.get_window_extent() for text in ax.texts if "attractor" in text.get_text()]
    points = ax.transData.transform(np.column_stack(ax.lines[0].get_data()))
    assert not any(name.contains(*point) for point in points)


def test_one_point_that_rubs_has_its_section_above_its_spectrum(tmp_path):
    figure = rub(tmp_path, "rotor.runout", "rad", [1e-3, 2e-3])
    section, spectrum = panel(figure, "2 mrad: period 1").get_position(), panel(figure, "Spectrum").get_position()
    assert section.y0 > spectrum.y1 and spectrum.width > 0.3


def test_a_rub_over_any_key_has_its_unit(tmp_path):
    figure = rub(tmp_path, "film.outer_pressure", "Pa", [1e5, 2e5])
    assert any(ax.get_xlabel() == "film.outer_pressure, bar" for ax in figure.axes)


def test_a_face_that_does_not_wear_has_no_panel(tmp_path):
    history = {"time": [0.0, 100.0], "leakage": [1e-9, 1e-9], "friction_power": [1.0, 1.0], "contact_share": [0.1, 0.1],
               "contact_area_fraction": [1e-3, 1e-3], "mean_clearance": [1e-7, 1e-7], "h_min": [1e-7, 1e-7],
               "stator_volume": [0.0, 1e-9], "rotor_volume": [0.0, 0.0]}  # fmt: skip
    profile = {"stator": [[0.0, 0.0], [1e-7, 1e-7]], "rotor": 2 * [[0.0, 0.0]], "gap": 2 * [[1e-7, 2e-7]]}
    answer = {"history": history, "end": {"said": "worn"}, "radius": [0.03, 0.04], "profile": profile,
              "pv": 2 * [[1e5, 1e5]], "extrapolated": None}  # fmt: skip
    figure = study(tmp_path, "wear", answer)
    assert "Stator: worn off" in titles(figure) and not any(title.startswith("Rotor") for title in titles(figure))
    assert len(panel(figure, "Worn volume").lines) == 1


@pytest.mark.parametrize("ratios", [[1.2], [1.3, 2.0, 5.0], [1.2, 20.0]], ids=["one", "few", "many"])
def test_regions_of_released_rings_are_named_whatever_was_asked(tmp_path, ratios):
    guide = np.linspace(0, 1, 51)
    line = np.linspace(1.63, max(1.8, *ratios), 40)
    fates = [{"force_ratio": q, "status": "hang-up", "start": "open", "support": "own", "sealing_number": None,
              "guide": 0.01, "ratio": None} for q in ratios]  # fmt: skip
    answer = {
        "balance": [{"force_ratio": q} for q in ratios], "published": [], "released": fates,
        "line": {"force_ratio": line.tolist(), "sealing_number": ((line - 1.6) ** 3).tolist()},
        "foreseen": {"force_ratio": [], "sealing_number": []}, "least_force_ratio": 1.621,
        "least_attracting_force_ratio": 1.713,
        "map": {"guide": guide.tolist(), "hang_up_below": (1.27 / (1 - 0.95 * guide)).tolist(),
                "straightens_above": (1.62 / (1 - guide / 0.8).clip(1e-3)).tolist(),
                "closed_form": {"force_ratio": line.tolist(), "guide": (1 - 1.6 / line).tolist()}},
    }  # fmt: skip
    figure = study(tmp_path, "sealing_number", answer)
    ax = panel(figure, "What a released ring does")
    assert inside(ax) == [] and {"hangs up", "straightens", "film", "closed form"} == {t.get_text() for t in ax.texts}
    assert text_trouble(figure) == ([], [])


def test_an_aligned_seal_has_no_panel_of_tilt_when_its_load_ramps(tmp_path):
    way = {"time": [0.0, 1.0, 2.0, 3.0], "film": [1e-5, 9e-6, 8e-6, 8e-6], "tilt": 4 * [0.0], "flow": 4 * [1e-6],
           "stages": [0.0, 2.0, 2.5, 3.0]}  # fmt: skip
    row = {"rate": 1e5, "h_min": 8e-6, "relative_misalignment": 0.0, "leakage": 1e-6, "leakage_least": 1e-7, **way}
    answer = {"key": "film.outer_pressure", "begin": 5e5, "end": 1e5, "unit": "Pa", "rate_unit": "Pa/s", "decay": 0.1,
              "quasi_static": {"h_min": [8e-6, 1e-5], "relative_misalignment": [0.0, 0.0], "leakage": [1e-7, 1e-6]},
              "rows": [row]}  # fmt: skip
    figure = study(tmp_path, "runup", answer)
    assert not any("tilt" in title for title in titles(figure)) and len(figure.axes) == 4


def test_an_orbit_of_nanoradians_is_read_in_them(tmp_path):
    turn = np.linspace(0, 2 * np.pi, 33)
    orbit = {"time": turn.tolist(), "h_min": (2e-7 + 0 * turn).tolist(),
             "relative_tilt_x": (2e-10 * np.cos(turn)).tolist(),
             "relative_tilt_y": (2e-10 * np.sin(turn)).tolist()}  # fmt: skip
    figure = study(tmp_path, "steady_state", {"orbit": orbit, "period": 1.0, "multipliers": [[0.5, 0.0]]})
    ax = panel(figure, "Orbit of the relative tilt")
    assert ax.get_xlabel() == "tilt about x, nrad" and np.abs(ax.lines[0].get_xdata()).max() == pytest.approx(0.2)
