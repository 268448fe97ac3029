"""Charts as a design review reads them: units of small numbers, names where numbers are none, words that are true."""

from itertools import pairwise
from unittest import mock

import numpy as np
import pytest
from drawn import crossed, drawn, panel, study, text_trouble
from made_up_run import SUMMARY, whirling, write
from test_charts_untuned import RPM, must_be_legible, said, ticks

from sealdyn.report.charts import animation, moving, overview
from sealdyn.report.charts.page import sheet
from sealdyn.report.charts.palette import CONTACT, CYCLE
from sealdyn.report.charts.study_sweep import axis_label
from sealdyn.report.text import study_lines
from sealdyn.studies.rub.study import sentences, tables

SEALS = ("fmr", "fms", "fmsr")
AMPLITUDES, PHASES = ("static", "dynamic", "total"), ("static_phase", "dynamic_phase")


def words_of(figure):
    return [text.get_text() for ax in figure.axes for text in [*ax.texts, ax.xaxis.label, ax.yaxis.label]]


# --- transmissibility ----------------------------------------------------------------------------------------

QUANTITIES = ("static_transmissibility", "dynamic_transmissibility", "maximum_relative_misalignment",
              "critical_misalignment", "critical_speed")  # fmt: skip
CELLS = dict.fromkeys(SEALS, 1.8270e-4)
TABLE = [{"quantity": name, "unit": "1", **CELLS, "formula": CELLS, "linear_algebra": CELLS, "time_domain": CELLS}
         for name in QUANTITIES]  # fmt: skip


def transmitted(size=0.1, stable=True, **more):
    """An answer of three speeds whose curves have this size."""
    curve = {name: [size, 0.9 * size, 0.8 * size] for name in AMPLITUDES}
    curve |= {name: [0.0, -20.0, -38.0] for name in PHASES}
    curve["stable"] = 3 * [stable]
    best = [{"seal": "fmr" if stable else None, "from": 0.0, "to": 900.0}]
    row = {"seal": "fmr", "speed": 450.0, "error": dict.fromkeys((*AMPLITUDES, *PHASES), 1e-2 * size)}
    row |= dict.fromkeys(AMPLITUDES, 0.9 * size) | dict.fromkeys(PHASES, -20.0)
    return {"speed": [0.0, 450.0, 900.0], "unit": "rad/s", "formula_holds": True, "phase": "", "film": "",
            "crossings": [], "table": [], "best": dict.fromkeys(AMPLITUDES, best), "time_domain": [row],
            **{name: {**curve, "linear_algebra": curve} for name in SEALS}, **more}  # fmt: skip


@pytest.mark.parametrize(
    "size, unit, shown", [(2e-6, "nrad per mrad", 2.0), (2e-3, "µrad per mrad", 2.0), (0.2, "", 0.2)]
)
def test_small_transmissibilities_are_read_in_small_units(tmp_path, size, unit, shown):
    figure = study(tmp_path, "transmissibility", transmitted(size), RPM)
    must_be_legible(figure)
    ax = panel(figure, "Static")
    assert unit in ax.get_ylabel() and shown == pytest.approx(ax.lines[0].get_ydata()[0])
    assert all("e" not in label for words in ticks(ax)[0] for label in words)
    # Marks and bars of the time domain with the curves.
    assert any(np.allclose(line.get_ydata(), 0.9 * shown) for line in ax.lines if len(line.get_ydata()) == 1)
    words = [text.get_text() for other in figure.axes if other.get_legend() for text in other.get_legend().get_texts()]
    per = f"{unit} of forcing" if unit else "per unit forcing"
    assert any(word.startswith(f"time domain (error bars up to\n{shown / 100:.1g} {per}, ") for word in words)
    (bar,) = ax.containers
    assert np.ptp(bar[2][0].get_segments()[0][:, 1]) == pytest.approx(0.02 * shown)


def test_seals_without_a_steady_state_are_not_called_best(tmp_path):
    figure = study(tmp_path, "transmissibility", transmitted(stable=False))
    assert "no steady state at any speed" in words_of(figure) and not any("none best" in w for w in words_of(figure))
    ends = [{"seal": None, "from": 0.0, "to": 300.0}, {"seal": "fmr", "from": 300.0, "to": 900.0}]
    figure = study(tmp_path, "transmissibility", transmitted(best=dict.fromkeys(AMPLITUDES, ends)))
    assert "none best to 300 rad/s\nFMR best beyond 300 rad/s" in words_of(figure)


def test_words_of_a_transmissibility_are_below_its_legend(tmp_path):
    film = "Film radial: -94.032 N m/rad, 5.83e+06 N m s/rad in tilt at 2600.5 rad/s (24828 rpm); "
    film += 'Green\'s Fig. 8 has those of the narrow seal (film.model = "linear").'
    phase = "Phase: how far the tilt of the ring that carries the forcing, relative to its partner, stands behind that "
    phase += "forcing in the forcing's own frame, against the shaft's rotation (negative: ahead)."
    figure = study(tmp_path, "transmissibility", transmitted(stable=False, film=film, phase=phase, table=TABLE))
    must_be_legible(figure)
    (key,) = [ax for ax in figure.axes if ax.get_legend()]
    assert key.texts[0].get_window_extent().y1 < key.get_legend().get_window_extent().y0


def test_linear_algebra_alone_is_drawn_once(tmp_path):
    for holds in (True, False):
        figure = study(tmp_path, "transmissibility", transmitted(formula_holds=holds))
        dashed = [line for line in panel(figure, "Static").lines if line.get_color() == "#000000"]
        assert len(dashed) == 3 * holds
        names = [text.get_text() for ax in figure.axes if ax.get_legend() for text in ax.get_legend().get_texts()]
        assert ("linear algebra" in names) == holds and ("FMR, linear algebra" in names) != holds


def test_the_table_of_a_transmissibility_tells_its_speed_clear_of_its_columns(tmp_path):
    # A formula that does not hold below zero stiffness finds none where linear algebra finds one.
    rows = [*TABLE[:-1], {**TABLE[-1], "formula": dict.fromkeys(SEALS)}]
    figure = study(tmp_path, "transmissibility", transmitted(2e-4, table=rows, own_speed=900.59), RPM)
    must_be_legible(figure)
    words = words_of(figure)
    assert "At 8600 rpm" in words and "in the form of Green (1989), Table 1" in words and "none" not in words
    texts = {text.get_text(): text for ax in figure.axes for text in ax.texts}
    figure.draw_without_rendering()
    heads = [texts[name].get_window_extent() for name in ("in the form of Green (1989), Table 1", "formula")]
    assert heads[0].x1 + 20 < heads[1].x0


def test_phases_of_some_degrees_have_round_ticks(tmp_path):
    for turn, start in ((1.0, 0.0), (5.0, 0.0), (12.0, 0.0), (-1.0, -180.0), (6.0, 180.0)):
        answer = transmitted()
        for name in SEALS:
            answer[name]["dynamic_phase"] = [start, start - 18.0 * turn, start - 36.0 * turn]
        ax = [ax for ax in study(tmp_path, "transmissibility", answer).axes][4]
        shown = [float(word.replace("−", "-")) for word in ticks(ax)[0][1]]
        step = shown[1] - shown[0]
        assert step in (10.0, 30.0, 45.0, 90.0) and 3 <= len(shown) <= 7, shown


# --- equilibrium ---------------------------------------------------------------------------------------------


def balance(contact=None, roots=(), verdict=("Balance at 0 clearances.", "Closing force 900 N.", "It carries less.")):
    clearance = np.geomspace(1e-7, 1e-5, 21)
    film = 300.0 + 1e-5 / clearance
    rough = np.zeros(21) if contact is None else np.maximum(contact * (1 - clearance / 4e-7), 0.0)
    curve = {"clearance": clearance.tolist(), "opening_force": (film + rough).tolist(),
             "contact_force": rough.tolist(), "stiffness": (1e-5 / clearance**2).tolist()}  # fmt: skip
    return {"curve": curve, "closing_force": 900.0, "roots": list(roots), "verdict": list(verdict)}


def test_an_equilibrium_says_what_was_found(tmp_path):
    figure = study(tmp_path, "equilibrium", balance())
    must_be_legible(figure)
    assert "Balance at 0 clearances. It carries less." in said(figure)


def test_the_force_of_asperities_is_seen_to_its_end(tmp_path):
    root = {"clearance": 3.7e-7, "stable": True, "stiffness": 1e9}
    ax = panel(study(tmp_path, "equilibrium", balance(contact=8e3, roots=[root])), "Opening")
    assert ax.get_ylim()[0] <= 0.0


# --- Campbell ------------------------------------------------------------------------------------------------


def whirls(decrement, verdict):
    mode = {"kind": "tilt", "direction": "forward", "directions": 3 * ["forward"], "frequency": [300.0, 310.0, 320.0],
            "log_decrement": decrement, "growth_rate": [-1.0, -1.0, -1.0]}  # fmt: skip
    return {"speed": [0.0, 500.0, 1000.0], "unit": "rpm", "modes": [mode], "crossings": [], "lines": [1.0],
            "thresholds": [], "stator_speed": 0.0, "stator_crossings": [], "own_speed": 400.0,
            "verdict": verdict}  # fmt: skip


def test_a_campbell_diagram_says_what_is_unstable(tmp_path):
    verdict = ["Mode 1 (tilt, mostly forward): 300 rad/s.", "Unstable at every speed of this range: mode 1 (tilt).",
               "Mode 1 meets once per turn at 310 rad/s."]  # fmt: skip
    figure = study(tmp_path, "campbell", whirls([0.26, 0.26, 0.25], verdict))
    must_be_legible(figure)
    assert " ".join(verdict[1:]) in said(figure)


@pytest.mark.parametrize("size", [0.02, 0.26, 3.0, 300.0])
def test_the_unstable_side_is_named_where_it_has_room(tmp_path, size):
    ax = panel(study(tmp_path, "campbell", whirls([size, size, 0.9 * size], ["It whirls."])), "Damping")
    bottom, zero = ax.transData.transform([(0, ax.get_ylim()[0]), (0, 0)])[:, 1]
    named = [text for text in ax.texts if text.get_text() == "unstable"]
    assert bool(named) == (zero - bottom > 0.05 * ax.bbox.height)


@pytest.mark.parametrize("decrement", [[-300.0, -12.0, -3.0], [2.0, -1.0, -3.0], [-3.0, -12.0, -300.0]])
def test_the_name_of_the_unstable_side_is_on_no_curve(tmp_path, decrement):
    answer = whirls(decrement, ["It whirls."])
    answer |= {"speed": np.linspace(0, 1000, 61).tolist()}
    mode = answer["modes"][0]
    for name in ("frequency", "log_decrement", "growth_rate"):
        mode[name] = np.interp(answer["speed"], [0, 150, 1000], mode[name]).tolist()
    mode["directions"] = 61 * ["forward"]
    ax = panel(study(tmp_path, "campbell", answer), "Damping")
    assert "unstable" in [text.get_text() for text in ax.texts] and crossed(ax) == []


def test_modes_above_a_campbell_diagram_are_named(tmp_path):
    answer = whirls([0.3, 0.3, 0.3], ["It whirls."])
    answer["modes"] *= 3
    answer["modes"][1] = {**answer["modes"][1], "frequency": [9e3, 9e3, 9e3]}
    figure = study(tmp_path, "campbell", answer)
    must_be_legible(figure)
    assert "above: mode 2" in words_of(figure)


def test_modes_that_lie_on_each_other_are_both_seen(tmp_path):
    answer = whirls([0.3, 0.3, 0.3], ["It whirls."])
    (mode,) = answer["modes"]
    still = {**mode, "kind": "axial", "frequency": 3 * [0.0], "log_decrement": 3 * [None], "directions": 3 * ["none"]}
    apart = {**mode, "frequency": [100.0, 150.0, 200.0], "log_decrement": [0.1, 0.2, 0.1]}
    answer["modes"] = [mode, apart, dict(mode), still]
    figure = study(tmp_path, "campbell", answer)
    must_be_legible(figure)
    for title in ("Whirl frequency", "Damping"):
        lines = [line for line in panel(figure, title).lines if len(line.get_xdata()) == 3]
        first, other, second = (
            next(line.get_linewidth() for line in lines if line.get_color() == colour) for colour in CYCLE[:3]
        )
        assert first > second + 1.0 and other == second
    # What does not oscillate is told, not drawn on the axis.
    assert figure.axes[0].get_title("left") == "Whirl frequency (mode 4 does not oscillate)"
    assert all(np.any(line.get_ydata()) for line in figure.axes[0].lines if len(line.get_xdata()))


def test_units_of_a_heading_are_printed(tmp_path):
    figure = study(tmp_path, "equilibrium", balance(verdict=["Balance at 1.5 um, 36 deg, 2 urad, 3 mm^2.", "Closing."]))
    assert "Balance at 1.5 µm, 36°, 2 µrad, 3 mm²." in said(figure)


# --- sweeps and load support ---------------------------------------------------------------------------------


def test_pure_numbers_have_no_unit_and_bare_ones_that_of_their_key():
    axis = {"key": "closing.balance_ratio", "unit": "", "values": [0.7, 0.8]}
    assert axis_label({**axis, "si": "1"}) == "closing.balance_ratio"
    assert axis_label({**axis, "key": "film.coning", "si": "rad"}) == "film.coning, rad"
    assert axis_label({**axis, "key": "rotor.runout", "unit": "um TIR"}) == "rotor.runout, µm TIR"
    assert axis_label({**axis, "unit": None}) == "closing.balance_ratio"
    # Archives of earlier versions do not hold the key's own unit.
    assert axis_label(axis) == "closing.balance_ratio, SI"


# --- critical speed, stability, contact onset ----------------------------------------------------------------


@pytest.mark.parametrize("scenario, unit", [(RPM, "9550 rpm"), ("", "1000.07 rad/s")], ids=["rpm", "rad per second"])
def test_the_scenarios_own_speed_is_marked_beside_its_threshold(tmp_path, scenario, unit):
    speed, rates = [800.0, 1200.0, 1600.0, 2000.0], [-9.0, -5.0, 1.0, 3.0]
    growth = {"speed": speed, "eigenvalue": rates, "time_domain": rates, "uncertainty": 4 * [1e-3]}
    answer = {"formula": None, "eigenvalue": 1500.0, "time_domain": {"value": 1500.0}, "growth": growth,
              "own_speed": 9550 * np.pi / 30, "nonlinear": None}  # fmt: skip
    figure = study(tmp_path, "critical_speed", answer, scenario)
    must_be_legible(figure)
    (ax,) = figure.axes
    own = [line for line in ax.lines if line.get_label() == f"this scenario {unit}"]
    assert len(own) == 1 and ax.get_xlim()[0] <= own[0].get_xdata()[0] <= ax.get_xlim()[1]
    # Far away it would squeeze the curve: then it is told in the legend alone.
    figure = study(tmp_path, "critical_speed", {**answer, "own_speed": 1e6}, scenario)
    assert figure.axes[0].get_xlim()[1] < 1e5
    assert any("this scenario" in text.get_text() for text in figure.axes[0].get_legend().get_texts())


def test_an_onset_over_written_values_is_drawn_where_they_are(tmp_path):
    rows = [{"value": value, "nonlinear": 1e-4, "formula": 1.1e-4} for value in ("0.1 mrad", "0.5 mrad", "2 mrad")]
    answer = {"key": "rotor.runout", "formula": 1.1e-4, "nonlinear": 1e-4, "over": "film.coning", "curve": rows,
              "clearance": 1e-5, "units": {"forcing": "rad", "value": "rad"}}  # fmt: skip
    figure = study(tmp_path, "contact_onset", answer)
    must_be_legible(figure)
    ax = panel(figure, "Onset over")
    assert list(ax.lines[0].get_xdata()) == [0.1, 0.5, 2.0] and ax.get_xlabel() == "film.coning, mrad"
    # Values in several units, and words, stand side by side.
    rows[0]["value"] = "100 urad"
    ax = panel(study(tmp_path, "contact_onset", answer), "Onset over")
    assert [text.get_text() for text in ax.get_xticklabels()] == ["100 urad", "0.5 mrad", "2 mrad"]
    plain = [{**row, "value": value} for row, value in zip(rows, (0.7, 0.8, 0.9), strict=True)]
    answer |= {"over": "closing.balance_ratio", "curve": plain, "units": {"forcing": "rad", "value": "SI"}}
    assert panel(study(tmp_path, "contact_onset", answer), "Onset over").get_xlabel() == "closing.balance_ratio"


def grid(first, second=None, **outputs):
    """A sweep's answer: keys `first` and `second` with their units and values, outputs as rows of values."""
    axes = [{"key": key, "unit": unit, "values": values} for key, unit, values in filter(None, (first, second))]
    rows = [dict(zip(outputs, row, strict=True)) for row in zip(*outputs.values(), strict=True)]
    return {"keys": [a["key"] for a in axes], "axes": axes, "outputs": list(outputs), "rows": rows, "output_units": {}}


def test_numbers_at_the_cells_of_a_map_are_apart(tmp_path):
    speeds = ("shaft.speed", "rpm", [5000.0, 12000.0, 19000.0, 26000.0, 33000.0, 40000.0])
    outputs = {f"output.{k}": list(map(float, range(12))) for k in range(8)}
    figure = study(tmp_path, "sweep", grid(speeds, ("film.coning", "mrad", [0.5, 4.0]), **outputs))
    assert text_trouble(figure) == ([], [])
    (ax,) = [ax for ax in figure.axes if ax.get_title("left") == "output.0"]
    shown = [label for label in ax.get_xticklabels() if label.get_text()]
    boxes = [label.get_window_extent() for label in shown]
    assert len(shown) >= 3 and all(one.x1 + 4 < other.x0 for one, other in pairwise(boxes))


def test_stable_is_green_in_whatever_order_it_comes(tmp_path):
    for words in (["unstable", "stable"], ["stable", "unstable"]):
        answer = grid(("film.coning", "mrad", [0.0, 1.0]), **{"stability.verdict": words})
        (ax,) = study(tmp_path, "sweep", answer).axes
        colours = {words[round(line.get_xdata()[0])]: line.get_color() for line in ax.lines}
        assert colours == {"stable": "#009E73", "unstable": "#D55E00"}


def test_without_any_balance_a_load_support_says_so_once(tmp_path):
    rows = [{"closing.balance_ratio": 0.5}, {"closing.balance_ratio": 1.3}]
    axis = {"key": "closing.balance_ratio", "unit": "", "si": "1", "values": [0.5, 1.3]}
    answer = {"keys": [axis["key"]], "axes": [axis], "outputs": [], "output_units": {"leakage": "m^3/s"}, "rows": rows,
              "verdict": ["Nothing holds the faces apart."]}  # fmt: skip
    figure = study(tmp_path, "load_support", answer)
    assert len(figure.axes) == 1 and figure.get_figheight() < 4
    assert "seal: Does it ride?" in said(figure) and "Nothing holds the faces apart." in said(figure)


def test_a_point_that_is_not_confirmed_is_seen_on_every_colour(tmp_path):
    axes = {"x": {"key": "film.coning", "unit": "rad", "values": [0.0, 1e-3], "here": 1e-3},
            "y": {"key": "film.clearance", "unit": "m", "values": [1e-6, 2e-6], "here": 1e-6}}  # fmt: skip
    rates, confirmed = [[-1.0, 1.0], [-1.0, 1.0]], [{"x": 1e-3, "y": 2e-6, "failed": "too fast"}]
    answer = {"axes": axes, "growth_rate": rates, "tilt_growth_rate": rates, "unconditional": {"limit": None},
              "confirmed": confirmed}  # fmt: skip
    ax = study(tmp_path, "stability", answer).axes[0]
    (mark,) = [line for line in ax.lines if line.get_label() == "not confirmed"]
    assert mark.get_marker() == "X" and mark.get_markerfacecolor() == "white"


def test_onsets_far_apart_are_all_seen(tmp_path):
    rows = [{"value": 1e-4, "formula": 2.3, "nonlinear": None, "failed": "beyond any small tilt"},
            {"value": 5e-4, "formula": 0.1, "nonlinear": 0.09},
            {"value": 2e-3, "formula": 0.043, "nonlinear": 0.05}]  # fmt: skip
    answer = {"key": "rotor.runout", "formula": 0.1, "nonlinear": 0.09, "over": "film.coning", "curve": rows,
              "clearance": 1e-5, "units": {"forcing": "rad", "value": "rad"}}  # fmt: skip
    figure = study(tmp_path, "contact_onset", answer)
    must_be_legible(figure)
    assert panel(figure, "Onset over").get_yscale() == "log"


# --- coefficients, steady state ------------------------------------------------------------------------------


def test_damping_of_millions_has_short_ticks(tmp_path):
    full = [[1.21e10, 0.0, 0.0], [0.0, 1.91e7, 2.75e7], [0.0, -2.75e7, 1.91e7]]
    at = {"tilt_x": 0.0, "tilt_y": 0.0, "clearance": 5e-7, "axial_opening": 0.0, "speed": 9.4, "h_min": 5e-7}
    answer = {"stiffness": full, "damping": full, "at": at,
              "tilted": {"stiffness": full, "damping": full, "at": at, "said": "mean tilt"}}  # fmt: skip
    for name, end in (("speed", 28.0), ("clearance", 1.6e-6), ("tilt", 1e-5)):
        values = np.linspace(0.1 * end, end, 9)
        share = (values[0] / values) ** 2
        answer[f"against_{name}"] = {name: values.tolist(), "stiffness": [(s * np.array(full)).tolist() for s in share],
                                     "damping": [(s * np.array(full)).tolist() for s in share]}  # fmt: skip
    figure = study(tmp_path, "coefficients", answer, RPM)
    must_be_legible(figure)
    words = words_of(figure)
    assert any("tilt damping, MN m s/rad" in word for word in words) and not any("e+" in word for word in words)
    assert not any("e" in label for ax in figure.axes if ax.axison for part in ticks(ax)[0] for label in part)


def test_why_a_transient_was_not_waited_for_is_told_clear_of_its_marks(tmp_path):
    rows = [
        {"part": part, "shooting": 100, "transient": None, "transient_ends": "the film closes"} for part in (0.5, 0.9)
    ]
    orbit = {name: np.sin(np.linspace(0, 6, 9)).tolist() for name in ("relative_tilt_x", "relative_tilt_y", "h_min")}
    answer = {"orbit": {**orbit, "time": np.linspace(0, 1, 9).tolist()}, "period": 1.0, "multipliers": [[0.1, 0.0]],
              "near_threshold": rows}  # fmt: skip
    ax = panel(study(tmp_path, "steady_state", answer), "Cost near the threshold")
    assert text_trouble(ax.figure) == ([], [])
    box = ax.get_legend().get_window_extent()
    for line in ax.lines:
        points = ax.transData.transform(np.column_stack(line.get_data()).astype(float))
        assert not any(box.contains(*point) for point in points)
    assert "transient: the film closes" in [text.get_text() for text in ax.get_legend().get_texts()]


# --- animation -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("part", [2e-3, 1e-6], ids=["little", "hardly"])
def test_the_names_of_an_animation_are_on_its_page(tmp_path, part):
    columns = whirling(samples=400, turns=10)
    columns["h_min"] = 1.39141e-5 * (1 + part * np.sin(np.arange(400)))
    figures = []
    with mock.patch.object(moving, "sheet", lambda *size: figures.append(sheet(*size)) or figures[-1]):
        animation.animate(write(tmp_path / "seal.h5", columns), tmp_path / "last.png")
    (figure,) = figures
    assert text_trouble(figure) == ([], [])
    line = figure.axes[-1] if figure.axes[-1].get_xlabel() else figure.axes[3]
    assert all(len(word) <= 7 for word in ticks(line)[0][1])


# --- what was not reached --------------------------------------------------------------------------------------


@pytest.mark.parametrize("contact, label", [(120.0, "whirl touches"), (None, "followed to here")])
def test_a_whirl_that_was_not_followed_to_contact_does_not_touch(tmp_path, contact, label):
    growth = {"speed": [600.0, 640.0, 680.0], "eigenvalue": [-1.0, 0.0, 1.0], "time_domain": [-1.0, 0.0, 1.0],
              "uncertainty": 3 * [1e-3]}  # fmt: skip
    branch = {"speed": [600.0, 300.0, 130.0], "amplitude": [1e-4, 2e-4, 3e-4], "growth_rate": [1.0, 1.0, 1.0]}
    rows = [
        {"speed": speed, "start": "small", "from": 1e-5, "fate": "decays", "whirl": None} for speed in (300.0, 600.0)
    ]
    found = {"verdict": "Beyond linear.", "branch": branch, "contact_tilt": 3e-4, "contact_speed": contact,
             "tipping": [], "directions": rows}  # fmt: skip
    answer = {"formula": None, "eigenvalue": 640.0, "time_domain": {"value": 640.0}, "growth": growth,
              "own_speed": 2600.0, "nonlinear": found}  # fmt: skip
    figure = study(tmp_path, "critical_speed", answer)
    names = [text.get_text() for ax in figure.axes for text in ax.get_legend().get_texts()]
    assert label in names and "this scenario 2600 rad/s, not shown" in names


def test_a_search_of_one_step_counts_whole_steps(tmp_path):
    figure = study(tmp_path, "steady_state", {"status": "failed", "reason": "it closes", "defects": [5e-3]})
    ax = panel(figure, "Newton's method")
    assert all("." not in word for word in ticks(ax)[0][0])
    (ax,) = study(tmp_path, "steady_state", {"reason": "a film that stores", "period": None}).axes
    assert ax.get_title("left") == "Orbit of the relative tilt"


def test_a_sweep_of_zeros_has_one_tick(tmp_path):
    answer = grid(("film.coning", "mrad", [0.0, 1.0]), **{"relative_misalignment.max": [0.0, 0.0]})
    (ax,) = study(tmp_path, "sweep", answer).axes
    assert ticks(ax)[0][1] == ["0"]


def test_a_transient_that_is_not_over_is_drawn_above_those_that_are(tmp_path):
    waited = (65, 4776, None)
    rows = [{"part": part, "shooting": 51, "transient": periods, "transient_ends": ""}
            for part, periods in zip((0.5, 0.99, 0.995), waited, strict=True)]  # fmt: skip
    orbit = {name: np.sin(np.linspace(0, 6, 9)).tolist() for name in ("relative_tilt_x", "relative_tilt_y", "h_min")}
    answer = {"orbit": {**orbit, "time": np.linspace(0, 1, 9).tolist()}, "period": 1.0, "multipliers": [[0.1, 0.0]],
              "near_threshold": rows}  # fmt: skip
    ax = panel(study(tmp_path, "steady_state", answer), "Cost near the threshold")
    (cross,) = [line for line in ax.lines if line.get_marker() == "x"]
    assert cross.get_ydata()[0] > 4776 and 3 <= len(ticks(ax)[0][1]) <= 9


# --- sealing number --------------------------------------------------------------------------------------------


def ring(ratio, number, support="own", start="closed form", share=0.1):
    return {"force_ratio": ratio, "status": "film", "start": start, "support": support, "guide": 0.1,
            "sealing_number": [number, 0.9 * number, 1.1 * number],
            "ratio": {"mean_film": share**0.5, "least_film": 0.5, "sealing_number": share}}  # fmt: skip


def sealing(released, **more):
    """An answer in which the closed form has 0.6 (q - 1.62)^2 for a sealing number."""
    line, guide = np.linspace(1.63, 8.0, 60), np.linspace(0, 1, 51)
    rows = [{"force_ratio": q, "static": {"sealing_number": 0.6 * (q - 1.62) ** 2}} for q in (1.8, 3.0, 8.0)]
    return {"balance": rows, "published": [{"force_ratio": 2.0, "sealing_number": 1.4}], "released": released,
            "line": {"force_ratio": line.tolist(), "sealing_number": (0.6 * (line - 1.62) ** 2).tolist()},
            "foreseen": {"force_ratio": [], "sealing_number": []}, "least_force_ratio": 1.621,
            "least_attracting_force_ratio": 1.713,
            "map": {"guide": guide.tolist(), "hang_up_below": (1.27 / (1 - 0.95 * guide)).tolist(),
                    "straightens_above": (1.62 / (1 - guide / 0.8).clip(1e-3)).tolist(),
                    "closed_form": {"force_ratio": line.tolist(), "guide": (1 - 1.6 / line).tolist()}},
            **more}  # fmt: skip


def under_legends(figure):
    """Marks and points of lines in view that lie under the legend of their panel."""
    figure.draw_without_rendering()
    found = []
    for ax in (ax for ax in figure.axes if ax.get_legend()):
        box = ax.get_legend().get_window_extent()
        points = [line.get_transform().transform(np.column_stack(line.get_data()).astype(float)) for line in ax.lines]
        seen = [tuple(point) for rows in points for point in rows if ax.bbox.contains(*point)]
        found += [point for point in seen if box.contains(*point)]
    return found


@pytest.mark.parametrize("q, number, share", [(1.7, 1.2, 0.015), (3.0, 1e-2, 1e-4), (2.0, 20.0, 50.0)])
def test_no_mark_of_sealing_numbers_is_under_a_legend(tmp_path, q, number, share):
    figure = study(tmp_path, "sealing_number", sealing([ring(q, number, share=share)]))
    assert text_trouble(figure) == ([], []) and under_legends(figure) == []
    ax = panel(figure, "How far the closed form carries")
    assert ax.get_ylim()[0] < share < ax.get_ylim()[1]


def test_rings_that_only_start_open_have_their_marks_and_ratios(tmp_path):
    rows = [ring(q, 1.0, support, "open") for q in (1.8, 3.0) for support in ("own", "as the closed form needs")]
    figure = study(tmp_path, "sealing_number", sealing(rows))
    assert len(panel(figure, "How far the closed form carries").lines) > 1
    marks = [line for line in panel(figure, "What a released ring does").lines if line.get_marker() == "o"]
    assert len(marks) == len(rows)


def test_films_at_three_force_ratios_are_three_marks(tmp_path):
    ax = panel(study(tmp_path, "sealing_number", sealing([ring(3.0, 1.0)])), "Mean film")
    (films,) = [line for line in ax.lines if line.get_label() == "same balance, actual film"]
    assert films.get_linestyle() == "None" and films.get_marker() != "None"


def test_rings_that_could_not_run_are_told(tmp_path):
    said_so = "Failed points: 2; the first: a film closed at the start"
    rows = [ring(3.0, 1.0), {"force_ratio": 8.0, "failed": "closed"}]
    figure = study(tmp_path, "sealing_number", sealing(rows, verdict=["It rides.", "More.", said_so]))
    assert said_so in " ".join(said(figure))


# --- run-up ----------------------------------------------------------------------------------------------------


def load_ramp(leakage=1e-6, **more):
    """An answer of a ramp and a step of a pressure, that of the step with a jump at the way back."""
    way = {"time": [0.0, 1.0, 2.0, 2.5], "film": [1e-5, 9e-6, 8e-6, 8e-6], "tilt": [2e-6, 1e-6, 3e-6, 3e-6]}
    rows = [{"rate": rate, "h_min": 8e-6, "relative_misalignment": 3e-6, "leakage": leakage, "leakage_least": 0.0,
             "stages": [0.0, top, 2.5, 3.0], **way, "flow": [leakage, 0.5 * leakage, 0.1 * leakage, end]}
            for rate, top, end in ((2e8, 2.0, 0.1 * leakage), (None, 0.0, leakage))]  # fmt: skip
    return {"key": "film.inner_pressure", "begin": 10e5, "end": 4e5, "unit": "Pa", "rate_unit": "Pa/s", "decay": 0.1,
            "quasi_static": {"h_min": [8e-6, 1e-5], "relative_misalignment": [1e-6, 3e-6],
                             "leakage": [0.1 * leakage, leakage]}, "rows": rows, **more}  # fmt: skip


def test_a_ramp_of_a_pressure_is_read_in_plain_rates_and_ends_before_the_way_back(tmp_path):
    figure = study(tmp_path, "runup", load_ramp())
    must_be_legible(figure)
    names = [text.get_text() for ax in figure.axes if ax.get_legend() for text in ax.get_legend().get_texts()]
    assert "2000 bar/s" in names and "a step" in names
    ax = panel(figure, "Leakage on the way")
    assert all(line.get_ydata()[-1] == min(line.get_ydata()) for line in ax.lines)
    # Nothing that is never below zero has an axis that goes far below it.
    low, high = panel(figure, "Leakage, l/h").get_ylim()
    assert -0.06 * high < low < 0


@pytest.mark.parametrize("leakage, unit", [(1e-6, "l/h"), (1e-8, "ml/h"), (3e-12, "µl/h")])
def test_a_leakage_that_ramps_is_read_in_a_unit_of_its_size(tmp_path, leakage, unit):
    figure = study(tmp_path, "runup", load_ramp(leakage))
    must_be_legible(figure)
    assert panel(figure, "Leakage, ").get_title("left").startswith(f"Leakage, {unit}: ")
    assert panel(figure, "Leakage on the way").get_ylabel() == unit


def waterfall_of(order, size=1e-6, speeds=(140.0, 150.0)):
    orders = np.linspace(-1.5, 2.5, 41)
    rows = [[1e-6 * np.exp(-200 * (n - 1) ** 2) + size * np.exp(-200 * (n - order) ** 2) for n in orders]] * 2
    way = {"orders": orders.tolist(), "speed": list(speeds), "amplitude": rows}
    return {"rate": 10.0, "window": 32, "up": way, "down": way}


def speed_ramp(touched=False, **more):
    way = {"speed": [10.0, 50.0, 100.0], "amplitude": [9e-9, 8e-9, 7e-9], "phase": [0.0, 0.1, 0.2]}
    rows = [
        {"rate": rate, "up": way, "down": way, "resolution": 0.05, "speed_in_window": 140.7} for rate in (10.0, 1e3)
    ]
    return {"key": "shaft.speed", "begin": 10.0, "end": 200.0, "order": 1.0, "tilting": True, "threshold": None,
            "whirl": None, "linear": way, "waterfall": None, "touch_rate": None, "disturbance": None, "rows": rows,
            "curve": {"rate": [10.0, 1e3], "h_min": [8e-7, 8e-7], "relative_misalignment": [9e-9, 5e-8],
                      "leakage": [1.0, 1.0], "touched": 2 * [touched]}, **more}  # fmt: skip


@pytest.mark.parametrize("order, low, high", [(-1.4, -1.5, 2.0), (2.4, -1.0, 2.5), (0.5, -1.0, 2.0)])
def test_a_waterfall_shows_every_order_that_is_strong(tmp_path, order, low, high):
    figure = study(tmp_path, "runup", speed_ramp(waterfall=waterfall_of(order)), RPM)
    ax = panel(figure, "Waterfall, up")
    assert ax.get_xlim() == pytest.approx((low, high), abs=0.11)
    assert any("1344 rpm" in text.get_text() or "1340 rpm" in text.get_text() for text in ax.texts)


def test_ramps_that_all_touch_have_a_name_for_their_line_alone(tmp_path):
    figure = study(tmp_path, "runup", speed_ramp(touched=True))
    ax = panel(figure, "How fast must one pass?")
    (tilt,) = [line for line in ax.lines if line.get_label() == "largest relative tilt"]
    assert len(tilt.get_xdata()) == 2


def test_a_film_that_hardly_changes_is_a_flat_line_of_a_ramp(tmp_path):
    answer = load_ramp()
    answer["quasi_static"]["h_min"] = [1.19931e-6, 1.19933e-6]
    for row in answer["rows"]:
        row |= {"film": [1.1992e-6, 1.1993e-6, 1.1994e-6, 1.1993e-6], "h_min": 1.1992e-6}
    figure = study(tmp_path, "runup", answer)
    must_be_legible(figure)
    for title in ("Thinnest film, ", "Thinnest film on the way"):
        low, high = panel(figure, title).get_ylim()
        assert high - low > 0.1 * high


@pytest.mark.parametrize("tilt, unit", [(3e-6, "µrad"), (2e-8, "nrad")])
def test_a_tilt_that_ramps_is_read_in_a_unit_of_its_size(tmp_path, tilt, unit):
    answer = load_ramp()
    for row in answer["rows"]:
        row |= {"tilt": [tilt, 0.8 * tilt, tilt, tilt], "relative_misalignment": tilt}
    answer["quasi_static"]["relative_misalignment"] = [0.5 * tilt, tilt]
    figure = study(tmp_path, "runup", answer)
    assert panel(figure, "Relative tilt, ").get_title("left").startswith(f"Relative tilt, {unit}")
    assert panel(figure, "Relative tilt on the way").get_ylabel() == unit


@pytest.mark.parametrize("shape", [[48.0, 20.0, 6.0], [6.0, 20.0, 48.0], [20.0, 20.0, 20.0]])
def test_the_names_of_ramps_are_on_no_curve(tmp_path, shape):
    way = {"speed": np.linspace(10, 200, 40).tolist(), "phase": np.linspace(0, 1, 40).tolist()}
    way["amplitude"] = (1e-9 * np.interp(way["speed"], [10, 70, 200], shape)).tolist()
    rows = [{"rate": rate, "up": way, "down": way} for rate in (10.0, 1e3)]
    figure = study(tmp_path, "runup", speed_ramp(linear=way, rows=rows), RPM)
    assert under_legends(figure) == [] and text_trouble(figure) == ([], [])


def test_names_of_levels_of_growth_are_not_under_the_names_of_the_ramps(tmp_path):
    gained = np.linspace(0, 450, 30)
    curves = [3.8 * np.sin(gained / 290), 1.3 * np.sin(gained / 290)]
    answer = speed_ramp(threshold=150.0, crossing=150.0, touch_tilt=1e-3, tilt_scale=2.5e-4, disturbance=2.5e-7)
    for row, grown in zip(answer["rows"], curves, strict=True):
        row["growth"] = {"curve": {"time": (gained / row["rate"]).tolist(), "measured": grown.tolist(),
                                   "foretold": grown.tolist()}}  # fmt: skip
    figure = study(tmp_path, "runup", {**answer, "forced_tilt": 0.0, "rate_foretold": None}, RPM)
    assert text_trouble(figure) == ([], [])


# --- rub -------------------------------------------------------------------------------------------------------


def rub(key, unit, values, section=1e-4, **more):
    rows = [{"value": v, "status": "ok", "direction": way, "class": motion, "contact_share": 0.5, "contact_force": 0.1,
             "h_min": [1e-7, 1e-7], "exponent": -1.0, "uncertainty": 0.1, "evaluations": 100.0,
             "section": [[section, 2 * section], [1.01 * section, 2 * section]], "orders": [0.0, 1.0, 2.0],
             "amplitude": [0.0, section, 0.1 * section]}
            for way, motion in (("up", "settling"), ("down", "undecided")) for v in values]  # fmt: skip
    return {"key": key, "touch": 1e-6, "rows": rows, "judge": None, "methods": None, "separation": None, "whirl": None,
            "units": {"rows/value": unit}} | more  # fmt: skip


def test_pure_numbers_of_a_rub_have_no_unit(tmp_path):
    answer = rub("closing.balance_ratio", "SI", [0.7, 0.8, 0.9])
    figure = study(tmp_path, "rub", answer)
    must_be_legible(figure)
    titles = [ax.get_title("left") for ax in figure.axes]
    assert not any("SI" in word.split() for word in [*titles, *" ".join(words_of(figure)).split()])
    assert any(title.startswith("0.7: ") for title in titles)
    assert sentences(answer)[0].startswith("closing.balance_ratio going up: settling to 0.9;")
    assert "SI" not in study_lines({"verdict": []}, tables(answer))[0]


def test_speeds_of_a_rub_have_no_exponent(tmp_path):
    speeds = [-24000 * np.pi / 30, -20000 * np.pi / 30, -16000 * np.pi / 30]
    rows = [{"speed": 2 * speed, "fate": "rub", "amplitudes": [1e-5, 1e-4]} for speed in speeds]
    answer = rub("shaft.speed", "rad/s", speeds, whirl={"critical_speed": 9.0, "rows": rows})
    figure = study(tmp_path, "rub", answer, RPM)
    must_be_legible(figure)
    titles = [ax.get_title("left") for ax in figure.axes]
    assert "−24 000 rpm: settling" in titles
    names = [text.get_text() for text in panel(figure, "A small whirl").get_legend().get_texts()]
    assert names[0] == "−48 000 rpm: rub"
    assert "settling to -16000;" in sentences(answer)[0]


@pytest.mark.parametrize("size, unit, shown", [(1e-4, "mrad", 0.1), (2e-6, "µrad", 2.0), (3e-9, "nrad", 3.0)])
def test_tilts_of_a_rub_are_read_in_a_unit_of_their_size(tmp_path, size, unit, shown):
    figure = study(tmp_path, "rub", rub("rotor.runout", "rad", [1e-4, 2e-4], section=size))
    must_be_legible(figure)
    ax = panel(figure, "0.1 mrad: settling")
    assert ax.get_xlabel() == f"γ about x, {unit}" and ax.lines[0].get_xdata()[0] == pytest.approx(shown)
    spectra = [ax for ax in figure.axes if ax.get_title("left") == "Spectrum of the ring"]
    assert {ax.get_ylabel() for ax in spectra} == {f"tilt, {unit}"}


def test_motions_of_a_rub_have_colours_of_their_own_and_its_directions_their_side(tmp_path):
    figure = study(tmp_path, "rub", rub("rotor.runout", "rad", [1e-4, 2e-4]))
    must_be_legible(figure)
    marks = [line for line in panel(figure, "Largest Lyapunov").lines if line.get_label() in ("settling", "undecided")]
    assert len({line.get_color() for line in marks}) == 2
    names = {text.get_text() for text in panel(figure, "Smallest film").get_legend().get_texts()}
    assert names == {"growing (left of its value)", "falling (right)"}


# --- failures ------------------------------------------------------------------------------------------------

EXHIBIT = {"item": 2, "title": "Stiff squeeze film", "unit": "overlap, um", "failing": "stops at 4.2 um",
           "failing_error": 1e4, "survivor": "BDF", "survivor_error": 1e-9, "default": "follows M^2"}  # fmt: skip


def met(why, *verdict):
    return {"rows": [{**EXHIBIT, "item": n + 1, "met": why if n == 1 else ""} for n in range(5)],
            "verdict": ["In each of 5 places a method fails.", *verdict]}  # fmt: skip


def test_the_failures_say_which_seal_comes_to_what_and_why(tmp_path):
    lines = ("This seal comes to 1 of their 5 kinds: stiff squeeze (decay 6516 times the forcing).",
             "For this scenario the program takes bdf on the radial film; warned: " + 12 * "heated, ")  # fmt: skip
    figure = study(tmp_path, "failures", met("decay 6516 times the forcing", *lines))
    must_be_legible(figure)
    words = " ".join(said(figure))
    assert "seal: Does it ride?" in words and "stiff squeeze (decay 6516 times the forcing)" in words
    assert lines[1].strip(", ").split("warned")[0] in words and "names in colour" in words
    # Nothing of the seal's lies on the heads of the columns.
    figure = study(tmp_path, "failures", met("", "This scenario is refused: no clearance."), question="")
    assert "seal" in said(figure)
    must_be_legible(figure)
    words = " ".join(said(figure))
    assert "This scenario is refused: no clearance." in words and "names in colour" not in words


def test_the_failures_are_in_the_letters_of_print(tmp_path):
    figure = study(tmp_path, "failures", met(""))
    words = words_of(figure)
    assert "overlap, µm" in words and any("4.2 µm" in text for text in words) and "follows M²" in words
    assert all("$" not in word for word in [text.get_text() for text in figure.axes[0].get_xticklabels()])


@pytest.mark.parametrize("error, letters", [(1e-3, 40), (1e-3, 72), (1e-12, 10), (1e-12, 50)])
def test_words_of_a_failure_lie_in_their_bar_or_beside_it(tmp_path, error, letters):
    row = {**EXHIBIT, "failing_error": error, "failing": "m" * (letters // 2) + "i" * (letters // 2), "unit": "1"}
    ax = study(tmp_path, "failures", {"rows": [row], "verdict": ["One place."]}).axes[0]
    (words,) = [text for text in ax.texts if "mmm" in text.get_text()]
    box, end = words.get_window_extent(), ax.transData.transform((np.log10(error), 0.0))[0]
    assert box.x1 < end or box.x0 > end


# --- vibration -----------------------------------------------------------------------------------------------


def shaken(**more):
    """An answer of an axial vibration whose touch rises with the square of the frequency."""
    frequency = np.geomspace(3.0, 3000.0, 31)
    touch = (2.0 * frequency**2).tolist()
    table = {"frequency": frequency.tolist(), "axial_gain": (1.0 / frequency).tolist(), "axial_touch": touch,
             "axial_touch_aligned": touch}  # fmt: skip
    mesh = {"direction": "axial", "frequency": 5400.0, "acceleration": 441.3, "touch": 1e6, "margin": 2e3}
    return {"directions": ["axial"], "outer_radius": 0.04, "accelerations": [], "modes": [], "gear_mesh": [mesh],
            "table": table, "time_domain": [], **more}  # fmt: skip


def test_a_vibration_says_of_which_seal(tmp_path):
    figure = study(tmp_path, "vibration", shaken())
    must_be_legible(figure)
    assert any(words.startswith("seal: It rides.") for words in said(figure))


@pytest.mark.parametrize("frequency, there", [(5400.0, False), (900.0, True)])
def test_the_key_names_a_gear_mesh_that_is_drawn(tmp_path, frequency, there):
    mesh = {**shaken()["gear_mesh"][0], "frequency": frequency}
    figure = study(tmp_path, "vibration", shaken(gear_mesh=[mesh]))
    names = [text.get_text() for ax in figure.axes if ax.get_legend() for text in ax.get_legend().get_texts()]
    assert ("gear mesh, 45 g" in names) == there


def test_what_is_asked_runs_through_no_name(tmp_path):
    asked = [9.80665 * value for value in (0.01, 0.1, 1.0, 10.0, 100.0)]
    for seen in ([asked[1], asked[3]], asked):
        figure = study(tmp_path, "vibration", shaken(accelerations=seen))
        ax = figure.axes[0]
        figure.draw_without_rendering()
        for line in (line for line in ax.lines if len(line.get_xdata()) == 2):
            y = ax.transData.transform((1.0, line.get_ydata()[0]))[1]
            boxes = [text.get_window_extent() for text in ax.texts]
            assert not any(box.y0 < y < box.y1 for box in boxes), line.get_ydata()
    names = [text.get_text() for ax in figure.axes if ax.get_legend() for text in ax.get_legend().get_texts()]
    assert "asked: 0.01, 0.1, 1, 10, 100 g" in names and "axial, linear theory" in names


# --- overview ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("brief", [True, False])
def test_a_brief_touch_is_marked_where_the_film_is_thinnest(tmp_path, brief):
    columns = whirling(samples=400)
    force = np.where(np.arange(400) == 7, 900.0, 0.0 if brief else 500.0)
    columns |= {"contact_force": force}
    columns["h_min"] = np.where(np.arange(400) == 7, 1e-7, columns["h_min"])
    summary = {**SUMMARY, "contact": {"touch_at": 9e-7, "touches": 1}}
    figure = drawn(overview, write(tmp_path / "seal.h5", columns, summary=summary), tmp_path / "chart.png")
    ax = panel(figure, "Smallest film thickness")
    marks = [line for line in ax.lines if line.get_marker() == "o"]
    assert len(marks) == brief and text_trouble(figure) == ([], [])
    if brief:
        assert marks[0].get_ydata()[0] == pytest.approx(0.1) and marks[0].get_color() == CONTACT
        assert any(text.get_text().startswith("touches at") for text in ax.texts)
