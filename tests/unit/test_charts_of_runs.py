"""Charts of runs that made panels hard to read: short runs, long ones, touches, faces that stay square."""

import itertools

import numpy as np
import pytest
from drawn import drawn, panel, text_trouble
from made_up_run import FILM, SUMMARY, drop, first, whirling, write
from matplotlib.figure import Figure

from sealdyn.numerics.time_series import located, order_spectrum, peaks
from sealdyn.report.charts import film, orbit, overview, poincare, sketch, spectrum
from sealdyn.report.charts.overview import sweep_lines
from sealdyn.report.charts.page import written
from sealdyn.report.charts.record import Run


def names(ax):
    return [text.get_text() for text in ax.texts]


def square(columns):
    """The same run with faces that stay square with each other."""
    return columns | {name: 0 * columns[name] for name in columns if "tilt" in name or "misalignment" in name}


@pytest.fixture
def chart(tmp_path):
    """The figure of a made-up run; `written`: saved too."""

    def of(kind, columns, *status, written=False, **options):
        archive = write(tmp_path / "seal.h5", columns, *status, **options)
        return drawn(kind, archive, tmp_path / "chart.png", written=written)

    return of


def test_numbers_are_those_of_print():
    assert [written(value, 3) for value in (4797.0, 2710.4, 31.52, 0.012345)] == ["4800", "2710", "31.5", "0.0123"]
    assert written(-64.31, 4) == "−64.31" and written(43219.7, 4) == "43 220" and written(1e-9, 3) == "1e−09"


@pytest.mark.parametrize("stiffness, told", [(5100.0, "10.2 N/µm, 5100 N m/rad"), (7.1e6, "10.2 N/µm, 7100 kN m/rad")])
def test_stiffnesses_are_told_without_powers_of_ten(chart, stiffness, told):
    summary = SUMMARY | {"film": {"axial_stiffness": 1.02e7, "tilt_stiffness": stiffness}}
    figure = chart(overview, whirling(samples=800), summary=summary, written=True)
    assert told in [words for ax in figure.axes for words in names(ax)]


def test_leakage_has_one_unit_on_the_page(chart, tmp_path):
    columns = whirling(samples=800)
    much = {name: 60 * columns[name] for name in ("leakage_inner", "leakage_outer")}
    summary = SUMMARY | {"leakage": {"mean": 60 * 43219.7 / 3.6e9}}
    figure = chart(overview, columns | much, summary=summary, written=True)
    assert panel(figure, "Leakage").get_ylabel() == "l/min" and "43.22 l/min" in names(panel(figure, "Key numbers"))
    gas = SUMMARY | {"leakage": {"mean": 1e-6, "conditions": {"pressure": 101325.0}}}
    figure = chart(overview, columns, summary=gas, written=True)
    normal = panel(figure, "Leakage").get_ylabel()
    conditions = normal.removeprefix("l/min")
    assert conditions and f"3600 ml/h{conditions}" in names(panel(figure, "Key numbers"))
    running = write(tmp_path / "c.h5", columns, "running", film=FILM | {"gas": "air"})
    figure = drawn(overview, running, tmp_path / "c.png")
    assert panel(figure, "Leakage").get_ylabel() == normal
    assert any(text.get_text().startswith("running: the archive has no end") for text in figure.texts)


@pytest.mark.parametrize("brief", [False, True], ids=["all along", "once"])
def test_contact_beside_a_spectrum(chart, brief):
    columns = whirling(samples=800)
    force = np.full(800, 20.0) if not brief else np.where(np.arange(800) < 3, 20.0, 0.0)
    summary = SUMMARY | {"contact": {"touch_at": 1e-6, "touches": 1, "share_of_closing": 0.00663}}
    figure = chart(overview, columns | {"contact_force": force}, summary=summary, written=True)
    assert text_trouble(figure) == ([], [])
    ax = panel(figure, "Contact force")
    (told,) = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "20 N" in told and "0.663 %" in told
    marks = [line.get_data() for line in ax.lines if line.get_marker() == "o"]
    assert len(marks) == brief and all(x == 0 and y == 20 for x, y in marks)


def test_names_of_levels_leave_a_film_that_swings_through_them(chart):
    columns = whirling(samples=1600)
    columns["h_min"] = 1e-5 * (1 + 0.1 * np.sin(columns["time"] * 2000))
    figure = chart(overview, columns, written=True)
    ax = panel(figure, "Smallest film thickness")
    assert not any(names(ax)) and [t.get_text() for t in ax.get_legend().get_texts()] == ["clearance 10 µm", "contact"]
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    points = ax.transData.transform(np.column_stack(ax.lines[0].get_data()))
    assert not any(box.contains(*point) for point in points)


def test_levels_and_a_sweep_have_a_row_each_above_the_film(tmp_path):
    """The names of levels that stand above the film stand below the line of a sweep."""
    sweep = {"frequency": [40.0, 4000.0], "start": 0.02, "duration": 0.3, "spacing": "logarithmic"}
    columns = whirling(samples=2000)
    columns["h_min"] = 1e-5 * (1.0 + 0.95 * np.sin(37.0 * columns["shaft_angle"]))
    run = write(tmp_path / "seal.h5", columns, housing={"axial_sweep": [sweep]})
    figure = drawn(overview, run, tmp_path / "c.png")
    ax = panel(figure, "Smallest film thickness")
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    told = [text for text in ax.texts if text.get_text().endswith("Hz")]
    assert len(told) > 2 and not any(box.overlaps(text.get_window_extent()) for text in told)


def test_frequencies_of_a_sweep_stand_apart(tmp_path):
    """Also beside the name of the last one, which ends where the line does."""
    for ratio in np.geomspace(2.0, 400.0, 25):
        sweep = {"frequency": [40.0, 40.0 * ratio], "start": 0.0, "duration": 0.35, "spacing": "logarithmic"}
        ax = Figure(figsize=(4.0, 1.8)).subplots()
        sweep_lines(ax, Run(write(tmp_path / "seal.h5", whirling(samples=400), housing={"axial_sweep": [sweep]})))
        ax.set_xlim(0, 60)
        ax.figure.draw_without_rendering()
        boxes = [text.get_window_extent() for text in ax.texts]
        assert len(boxes) > 1 and not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2)), ratio


def test_thousands_of_turns_have_ticks_apart(chart):
    columns = whirling(samples=32 * 3000 + 1, turns=3000)
    figure = chart(overview, columns)
    ax = panel(figure, "Smallest film thickness, last 4 turns")
    figure.draw_without_rendering()
    low, high = ax.get_xlim()
    labels = [label for at, label in zip(ax.get_xticks(), ax.get_xticklabels(), strict=True) if low <= at <= high]
    assert [label.get_text() for label in labels] == ["2996", "2997", "2998", "2999", "3000"]
    boxes = [label.get_window_extent() for label in labels]
    assert all(other.x0 - box.x1 > 0.3 * box.width for box, other in itertools.pairwise(boxes))


def test_a_panel_of_the_last_turns_has_something_to_show(chart):
    figure = chart(overview, whirling(samples=60, turns=400))
    assert not any("last" in ax.get_title("left") for ax in figure.axes)


def test_a_warning_of_one_word_tells_its_reason(chart):
    warnings = ["accuracy: errors add up over 9 periods; adams keeps 1e-9 at best", "not isothermal: friction heats"]
    figure = chart(overview, whirling(samples=200), summary=SUMMARY | {"warnings": warnings})
    words = [text.get_text() for text in figure.texts]
    assert "warning: accuracy: errors add up over 9 periods; not isothermal" in words


# --- spectra ----------------------------------------------------------------------------------------------


def spectrum_of(tilt, turns, per_turn=64):
    """Titles and names of peaks of the spectrum of a relative tilt(turns)."""
    at = np.arange(turns * per_turn + 1) / per_turn
    return at, order_spectrum(at, tilt(at))


def whirl(order, at):
    return np.exp(2j * np.pi * order * at)


@pytest.mark.core
def test_an_order_between_the_lines_is_located():
    _, (orders, amplitude, *_) = spectrum_of(lambda at: 3e-6 * whirl(2 / 3, at) + 1e-6 * whirl(-2, at), 8)
    found = [located(orders, amplitude, at) for at in peaks(orders, amplitude)]
    np.testing.assert_allclose(found, [(2 / 3, 3e-6), (-2, 1e-6)], rtol=5e-3)
    # Two orders two lines apart shift each other's neighbours: they stay where they are.
    _, (orders, amplitude, *_) = spectrum_of(lambda at: 3e-6 * whirl(0.5, at) + 2e-6j * whirl(1, at), 4)
    found = [located(orders, amplitude, at) for at in peaks(orders, amplitude)]
    assert [order for order, _ in found] == [0.5, 1.0]


def test_a_rotating_whirl_is_named_though_others_are_near(chart):
    columns = whirling(samples=64 * 20 + 1, turns=20)
    at = columns["time"] * 1000 / (2 * np.pi)
    tilt = 1e-6 * sum(whirl(order, at) / (1 + abs(order)) for order in (-1, -0.5, 0, 0.5, 1))
    columns |= {"relative_tilt_x": tilt.real, "relative_tilt_y": tilt.imag}
    found = {words.split("×")[0] for words in names(panel(chart(spectrum, columns), "Relative tilt"))}
    assert found == {"−1", "−0.5", "0", "0.5", "1"}


def test_few_turns_have_no_spectrum_and_their_noise_no_warning(chart, tmp_path):
    archive = write(tmp_path / "a.h5", whirling(samples=200, turns=3))
    figure = drawn(spectrum, archive, tmp_path / "chart.png", written=False)
    assert len(figure.axes) == 1 and "fewer than four turns" in names(figure.axes[0])[0]
    assert not spectrum.has_orders(Run(archive))
    # Five turns: the last four, in which the turning tilt stands clear of the constant one.
    columns = whirling(samples=64 * 5 + 1, turns=5)
    tilt = 1e-6 * (0.2 + np.exp(1j * 1000 * columns["time"])) + 1e-9 * np.random.default_rng(0).normal(size=321)
    columns |= {"relative_tilt_x": tilt.real, "relative_tilt_y": tilt.imag}
    ax = panel(chart(spectrum, columns), "Relative tilt")
    assert "last 4 turns" in ax.get_xlabel() and not any("folded" in words for words in names(ax))
    assert [words.split("×")[0] for words in names(ax)] == ["1", "0"]


def test_a_drift_is_no_order(chart):
    columns = square(whirling(samples=64 * 20 + 1, turns=20))
    columns["axial_gap_change"] = 1e-6 * np.exp(-columns["time"] * 30)
    assert names(panel(chart(spectrum, columns), "Axial motion")) == []


# --- sections ---------------------------------------------------------------------------------------------


def test_a_section_of_square_faces_is_their_film(chart):
    figure = chart(poincare, square(whirling(samples=800)))
    assert [ax.get_title("left") for ax in figure.axes] == ["Once per turn: smallest film thickness"]


def test_a_section_counts_passages_and_enlarges_no_rounding(chart):
    columns = whirling(samples=64 * 3 + 1, turns=3)
    tilt = 1e-6 + 1e-4 * np.exp(1j * 1000 * columns["time"]) * (1 + 1e-6 * np.arange(193))
    columns |= {"relative_tilt_x": tilt.real, "relative_tilt_y": tilt.imag}
    figure = chart(poincare, columns)
    ax = panel(figure, "Once per turn: relative tilt")
    assert ax.get_legend().get_texts()[0].get_text() == "last of 4 passages"
    low, high = ax.get_xlim()
    # Values differ by 0.02 %; that is drawn, less is not.
    assert high - low < 0.1 * high
    columns |= {"relative_tilt_x": tilt.real / np.abs(tilt) * 1e-4, "relative_tilt_y": tilt.imag / np.abs(tilt) * 1e-4}
    low, high = panel(chart(poincare, columns), "Once per turn: relative tilt").get_xlim()
    assert high - low > 10


def test_a_section_looks_at_what_has_settled(chart):
    columns = whirling(samples=64 * 40 + 1, turns=40, tilt=1e-6)
    columns["relative_tilt_x"] = columns["relative_tilt_x"] + 1e-3 * np.exp(-columns["time"] * 1000)
    ax = panel(chart(poincare, columns), "Once per turn: relative tilt")
    assert ax.get_title("left").endswith("last 21 passages") and ax.get_xlim()[1] < 10


def test_rare_samples_have_no_section(chart):
    figure = chart(poincare, whirling(samples=90, turns=30))
    assert len(figure.axes) == 1 and "samples per turn" in names(figure.axes[0])[0]


# --- film -------------------------------------------------------------------------------------------------


def test_a_film_of_square_faces_is_drawn_over_the_turns(chart):
    columns = square(whirling(samples=800))
    columns["h_min"] = 1e-5 + columns["axial_gap_change"]
    figure = chart(film, columns, film={**FILM, "coning": 0.0}, written=True)
    ax = panel(figure, "Film thickness, even around the circle")
    assert len(ax.lines) == 2 and not ax.images
    np.testing.assert_allclose(ax.lines[0].get_ydata(), 1e6 * columns["h_min"])
    # Of the film over the face, which is even, the colours have one number.
    (bar,) = [ax for ax in figure.axes if ax.get_ylabel() and ax.get_position().width < 0.02]
    assert len(bar.get_yticks()) == 1


def test_a_map_of_the_film_shows_all_of_the_last_turns(chart):
    (image,) = panel(chart(film, whirling(samples=9000, turns=1.0)), "Film thickness around").images
    assert image.get_extent()[:2] == pytest.approx((0.0, 1.0)) and image.get_array().shape[1] <= film.MOST_COLUMNS


def test_instants_of_a_shaft_at_rest_are_told_in_milliseconds(chart):
    columns = first(whirling(), 50) | {"shaft_angle": np.zeros(50), "shaft_speed": np.zeros(50)}
    assert panel(chart(film, columns, rows=(0, 20, 40)), "Film pressure at").get_title("center").endswith(" ms")


@pytest.mark.parametrize(
    "speeds, last, said", [((50.0, 50.0), 1.0, "turns"), ((50.0, 90.0), 1.0, "ms"), ((50.0, 90.0), 3.0, "s")]
)
def test_a_run_up_is_drawn_over_time(chart, speeds, last, said):
    columns = whirling(samples=900)
    columns["time"] *= last / columns["time"][-1]
    speed = {"time": [0.0, last], "value": list(speeds)}
    columns["shaft_speed"] = np.interp(columns["time"], speed["time"], speed["value"])
    figure = chart(overview, columns, shaft={"speed": speed})
    shown = panel(figure, "Smallest film thickness").lines[0].get_xdata()[-1]
    assert any(said in ax.get_xlabel().replace("time, ", "") for ax in figure.axes)
    assert shown == pytest.approx({"turns": shown, "ms": 1e3 * last, "s": last}[said])


# --- rings ------------------------------------------------------------------------------------------------


def test_a_ring_under_another_is_seen(chart):
    columns = whirling(samples=800)
    columns |= {f"stator_tilt_{axis}": columns[f"rotor_tilt_{axis}"] for axis in "xy"}
    rings = {line.get_label(): line for line in panel(chart(orbit, columns), "Tilt of each ring").lines}
    assert rings["stator"].get_linewidth() > 3.5 * rings["rotor"].get_linewidth()


def test_two_rings_that_stand_still_in_one_place_are_both_seen(chart):
    columns = whirling(samples=800)
    columns |= {f"{ring}_tilt_{axis}": np.full(800, 1e-4) for ring in ("stator", "rotor") for axis in "xy"}
    ax = panel(chart(orbit, columns), "Tilt of each ring")
    dots, (stator, rotor) = ([one.get_markersize() for one in ax.lines if one.get_marker() == mark] for mark in "os")
    assert stator > rotor + 2 and rotor > max(dots) + 2
    assert not any(text.get_text().startswith("whole run: to") for text in ax.get_legend().get_texts())


SUPPORT = {"axial_stiffness": 3e4, "radius": None, "tilt_stiffness": 11.0}


def section(chart, **scene):
    """The axes of a sketch."""
    (ax,) = chart(sketch, drop(whirling(samples=40), "tilt"), written=True, **scene).axes
    assert text_trouble(ax.figure) == ([], [])
    return ax


def test_a_support_given_by_its_tilt_stiffness_is_sketched(chart):
    ax = section(chart, stator={"support": SUPPORT}, rotor={})
    assert "support,\n11 N m/rad" in names(ax)


def test_what_is_beyond_the_face_is_held_by_its_ring(chart):
    rings = {"support": SUPPORT | {"radius": 0.036}, "secondary_seal": {"radius": 0.045}}
    ax = section(chart, stator=rings, rotor={"support": SUPPORT | {"radius": 0.03}})
    boxes = [patch.get_extents().transformed(ax.transData.inverted()) for patch in ax.patches]
    reached = [(box.y0, box.y1) for box in boxes]
    assert any(np.allclose(edges, (40.0, 45.0)) for edges in reached)
    assert any(np.allclose(edges, (30.0, 32.0)) for edges in reached)


def test_a_sketch_tells_what_it_does_not_draw(chart):
    changing = {"time": [0.0, 1.0], "value": [1e5, 11e5]}
    waves = [{"order": 3, "amplitude": 3e-7, "phase": 0.0}]
    profile = {"radius": [0.032, 0.034, 0.04], "depth": [3e-6, 0.0, 0.0]}
    scene = {**FILM, "coning": 0.0, "outer_pressure": changing, "inner_pressure": 1e5, "profile": profile}
    ax = section(chart, film=scene, stator={"support": SUPPORT, "waviness": waves, "speed": 0.0}, rotor={})
    assert {"1 to 11 bar abs.", "1 bar abs."} <= set(names(ax)) and "3 waves of 0.3 µm" in ax.get_xlabel()
    # Thickest at the inner radius, and level from 34 mm on.
    gap = ax.patches[0].get_xy()
    assert gap[gap[:, 1] <= 32.0][:, 0].max() > 2 * gap[gap[:, 1] > 35][:, 0].max()


GROOVES = {"count": 6, "depth": 6e-6, "inner_radius": 0.036, "outer_radius": 0.04, "share": 0.5, "shape": "spiral",
           "angle": 0.3, "stem_outer_radius": None, "stem_share": None, "phase": 0.0}  # fmt: skip


@pytest.mark.parametrize("angle, pumped", [(0.3, "inwards"), (-0.3, "outwards")])
def test_grooves_are_drawn_from_the_front(angle, pumped, tmp_path):
    """Where the face is deep, in the sense in which theta rises, and which way they pump on a rotor."""
    archive = write(tmp_path / "seal.h5", drop(whirling(samples=40), "tilt"), shaft={"speed": 500.0}, stator={},
                    rotor={"grooves": [GROOVES | {"angle": angle}]})  # fmt: skip
    _, ax = drawn(sketch, archive, tmp_path / "chart.png").axes
    assert pumped in ax.get_xlabel() and "6 spiral grooves" in ax.get_xlabel()
    x, y = np.moveaxis(ax.collections[0].get_coordinates(), -1, 0)
    r, theta = np.hypot(x, y)[:-1, :-1], np.arctan2(y, x)[:-1, :-1]
    deep = ~np.ma.getmaskarray(ax.collections[0].get_array()).reshape(r.shape)
    assert r[deep].min() == pytest.approx(36.0, abs=0.1) and deep[r > 36.0].mean() == pytest.approx(0.5, abs=0.02)
    # The middle of the groove at the angle 0 of its inner radius goes on to ln(r/36)/tan(angle).
    middle = np.log(39.0 / 36.0) / np.tan(angle)
    near = (np.abs(r - 39.0) < 0.05) & (np.abs(np.angle(np.exp(1j * (theta - middle)))) < 0.1)
    assert near.any() and deep[near].all()
