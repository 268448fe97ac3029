"""Charts from made-up archives: what they say is checked by formula, how they look by measuring the figure."""

import json
import subprocess
import sys

import numpy as np
import pytest
from drawn import drawn, panel, text_trouble
from made_up_run import FILM, SCENARIO, SUMMARY, drop, first, pressures, whirling, write

from sealdyn.archive import ArchiveWriter, Series
from sealdyn.numerics.time_series import order_spectrum
from sealdyn.report.charts import film, orbit, overview, poincare, record, spectrum
from sealdyn.report.charts.film import thickness
from sealdyn.report.charts.orbit import hull
from sealdyn.report.charts.record import Run

KINDS = {"overview": overview, "orbit": orbit, "film": film, "spectrum": spectrum, "poincare": poincare}


def archives():
    full = whirling()
    still = {**first(full, 50), "shaft_angle": np.zeros(50), "shaft_speed": np.zeros(50)}
    flat = {**full, **{n: 0 * full[n] for n in ("relative_tilt_x", "relative_tilt_y", "relative_misalignment")}}
    long_message = "h_min fell below the floor at t = 0.2 s, theta = 1.2 rad; try a larger clearance, less runout, "
    return {
        "full": (full, {}),
        "near_contact": (whirling(tilt=1.7e-4), {}),
        "pressed": (full, {"rows": (0, 1500, 3839)}),
        "pressed_aligned": (flat, {"rows": (0, 1)}),
        "run_up": (whirling(ramp=8000.0), {"summary": {}}),
        "shaken": (full, {"housing": {"axial": [{"frequency": 1e5}]}}),
        "collapsed": (first(whirling(tilt=2.2e-4), 700), {"status": "collapsed", "message": 4 * long_message}),
        "failed_at_once": (first(full, 3), {"status": "failed", "message": "step size vanished", "summary": {}}),
        "interrupted": (first(full, 90), {"status": "interrupted", "message": "Ctrl-C", "summary": {}}),
        "running": (full, {"status": "running"}),
        "one_row": (first(full, 1), {"summary": {}}),
        "no_rows": (first(full, 0), {"summary": {}}),
        "axial_only": (drop(full, "tilt", "misalignment"), {}),
        "aligned": (flat, {}),
        "bare": (drop(full, "h_min", "leakage", "axial", "shaft"), {"film": {}, "summary": {}}),
        "standing": (still, {"summary": {}}),
    }


ARCHIVES = archives()


# The overview has a panel of every kind; alone the kinds are drawn of the archives that they draw in their own way.
ALONE = {"full", "shaken", "collapsed", "one_row", "axial_only", "aligned", "bare", "pressed"}
CHARTS = [(name, kind) for name in ARCHIVES for kind in KINDS if kind == "overview" or name in ALONE]


@pytest.mark.parametrize("name, kind", CHARTS)
def test_every_chart_draws_every_archive_legibly(tmp_path, kind, name):
    columns, options = ARCHIVES[name]
    archive = write(tmp_path / "seal.h5", columns, **options)
    assert text_trouble(drawn(KINDS[kind], archive, tmp_path / "chart.png", written=name == "full")) == ([], [])


def test_what_is_missing_leaves_its_panel_empty(tmp_path):
    columns, options = ARCHIVES["bare"]
    figure = drawn(overview, write(tmp_path / "seal.h5", columns, **options), tmp_path / "chart.png", written=False)
    empty = [ax for ax in figure.axes if not ax.lines and not ax.xaxis.get_visible()]
    assert len(empty) == 2 and all(len(ax.texts) == 1 for ax in empty)


def test_the_overview_says_question_model_verdict_and_numbers(tmp_path):
    archive = write(tmp_path / "seal.h5", whirling(), message="done")
    figure = drawn(overview, archive, tmp_path / "chart.png", written=False)
    words = [text.get_text() for text in figure.texts]
    assert words[0] == "Does a flexibly mounted rotor follow a misaligned stator?"
    assert "seal" in words[1] and "radial film" in words[1] and "3 unknowns" in words[1] and "stable" in words[1]
    assert words[2] == "ok: done"
    numbers = [text.get_text() for ax in figure.axes for text in ax.texts]
    assert "2.3 µm, 23 % of clearance" in numbers and "0.7203 l/min" in numbers and "8684 rad/s" in numbers


def test_a_chart_takes_unit_and_factor_from_the_archive(tmp_path):
    display, largest, label = ("nm", 1e9), 1e4, "h_min, nm"
    columns = first(whirling(tilt=0.0), 400)
    given = {name: Series("m", name, *(display if name == "h_min" else ())) for name in columns if name != "time"}
    run = ArchiveWriter(tmp_path / "seal.h5", scenario_text=SCENARIO, resolved={"film": FILM}, meta={}, series=given)
    run.append(columns)
    path = run.finish("ok", "", SUMMARY)
    figure = drawn(overview, path, tmp_path / "chart.png", written=False)
    panels = [ax for ax in figure.axes if ax.get_ylabel() == label]
    assert len(panels) == 2
    for ax in panels:
        assert max(ax.lines[0].get_ydata()) == pytest.approx(largest, rel=0.02)


def test_turns_count_through_wraps_blocks_and_changing_speed(tmp_path, monkeypatch):
    monkeypatch.setattr(record, "BLOCK", 100)
    for ramp in (0.0, 5e4):
        columns = whirling(samples=1501, turns=60, ramp=ramp)
        run = Run(write(tmp_path / "seal.h5", drop(columns, "tilt"), film={}))
        exact = (1000 * columns["time"] + ramp * columns["time"] ** 2 / 2) / (2 * np.pi)
        np.testing.assert_allclose(run.turns, exact, atol=1e-9)
    # Two rows in three turns: only the speed can tell.
    rare = drop(whirling(samples=41, turns=60), "tilt")
    np.testing.assert_allclose(Run(write(tmp_path / "b.h5", rare)).turns, np.linspace(0, 60, 41), atol=1e-9)


@pytest.mark.core
def test_thinning_loses_no_extreme(tmp_path):
    columns = whirling(samples=300_000, turns=3000)
    spikes = {7: 3e-6, 123_456: 1e-6, 299_990: 2e-6}
    for row, value in spikes.items():
        columns["h_min"][row] = value
    run = Run(write(tmp_path / "seal.h5", columns))
    x, h = run.envelope("h_min")
    assert len(h) <= record.POINTS and (np.diff(x) >= 0).all()
    assert h.min() == 1e-6 and h.max() == columns["h_min"].max()
    for row, value in spikes.items():
        assert run.turns[row] == x[np.flatnonzero(h == value)[0]]
    figure = drawn(overview, run.path, tmp_path / "chart.png", written=False)
    assert max(len(line.get_xdata()) for ax in figure.axes for line in ax.lines) <= record.POINTS


def at_order(orders, amplitude, order):
    return amplitude[np.abs(orders - order).argmin()]


@pytest.mark.core
def test_the_spectrum_gives_orders_amplitudes_and_directions():
    turns = np.arange(64 * 20 + 1) / 64
    angle = 2 * np.pi * turns
    signal = 0.5 + 3 * np.exp(1j * angle) + 1j * np.exp(-2j * angle)
    orders, amplitude, resolution, resampled = order_spectrum(turns, signal)
    assert not resampled and resolution == pytest.approx(1.5 / 20)
    for order, expected in {1: 3, -2: 1, 0: 0.5, -1: 0, 2: 0, 3: 0}.items():
        assert at_order(orders, amplitude, order) == pytest.approx(expected, abs=1e-9)
    orders, amplitude, _, _ = order_spectrum(turns, 7 + 2 * np.cos(3 * angle + 1))
    assert at_order(orders, amplitude, 3) == pytest.approx(2) and amplitude[0] == pytest.approx(0, abs=1e-9)


def test_with_changing_speed_orders_stay_sharp():
    # Even in time, speed from 1 to 3 turns per unit: over time the line would smear across a factor of three.
    time = np.linspace(0, 20, 6001)
    turns = time + 0.05 * time**2
    orders, amplitude, _, resampled = order_spectrum(turns, 2 * np.exp(2j * np.pi * turns))
    assert resampled
    assert at_order(orders, amplitude, 1) == pytest.approx(2, rel=1e-3)
    assert amplitude[np.abs(orders - 1) > 0.2].max() < 1e-3
    # A shaft that stood before and stands afterwards adds samples at one angle.
    standing = np.concatenate([np.zeros(50), turns, np.full(50, turns[-1])])
    _, found, _, _ = order_spectrum(standing, 2 * np.exp(2j * np.pi * standing))
    assert found == pytest.approx(amplitude, abs=1e-12)


def test_the_map_is_thinnest_where_the_archive_says(tmp_path):
    columns = whirling(samples=200, turns=3)
    run = Run(write(tmp_path / "seal.h5", columns))
    around = np.linspace(-np.pi, np.pi, 3601)
    over = thickness(run, FILM["inner_radius"], around, 0, 200)
    np.testing.assert_allclose(over.min(1), columns["h_min"], rtol=1e-6)
    off = around[over.argmin(1)] - columns["h_min_angle"]
    assert np.abs(np.angle(np.exp(1j * off))).max() < 2e-3
    # The clearance, where the scene left it to the balance of forces.
    found = Run(write(tmp_path / "b.h5", columns, film={**FILM, "clearance": None}))
    assert found.clearance == pytest.approx(1e-5)


def test_the_pressure_is_that_of_the_thinnest_instant_kept(tmp_path):
    columns, rows = whirling(), (100, 1500, 2000, 2016)
    thinnest = min(rows, key=lambda row: columns["h_min"][row])
    assert thinnest == 2000 and columns["h_min"].min() < columns["h_min"][thinnest]
    figure = drawn(film, write(tmp_path / "seal.h5", columns, rows=rows), tmp_path / "chart.png", written=False)
    ax = panel(figure, "Film pressure at turn")
    _, kept = pressures(rows)
    expected = 0.1 * (kept["pressure"][rows.index(thinnest)] / 1e5)
    values = ax.collections[0].get_array().reshape(5, 25)
    np.testing.assert_allclose(values[:, :-1], expected)
    np.testing.assert_allclose(values[:, -1], expected[:, 0])
    ((angle,), (radius,)) = ax.lines[0].get_data()
    assert angle == columns["h_min_angle"][thinnest] and radius == 1e3 * FILM["inner_radius"]
    assert f"{columns['time'][thinnest] * 1000 / (2 * np.pi):.4g}" in ax.get_title("center")
    assert "film pressure, MPa" in [other.get_ylabel() for other in figure.axes]


def test_the_reach_of_an_orbit_holds_every_row(tmp_path):
    columns = whirling(samples=5000, turns=40)
    corners = hull(Run(write(tmp_path / "seal.h5", columns)), "relative_tilt")
    edge = np.roll(corners, -1, 1) - corners
    x, y = 1e6 * columns["relative_tilt_x"], 1e6 * columns["relative_tilt_y"]
    left_of = edge[0][:, None] * (y - corners[1][:, None]) - edge[1][:, None] * (x - corners[0][:, None])
    # Between two of 72 directions a row may stick out by half the edge times tan(half the angle), no more.
    length = np.hypot(*edge)
    kept = length > 0
    outside = -left_of[kept] / length[kept, None]
    assert (outside.max(1) <= length[kept] / 2 * np.tan(np.pi / 72) + 1e-9).all()
    assert np.hypot(*corners).max() == pytest.approx(np.hypot(x, y).max(), rel=1e-3)


def test_importing_the_charts_room_does_not_import_matplotlib():
    code = "import sys, json, sealdyn.report.charts; print(json.dumps('matplotlib' in sys.modules))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(said.stdout) is False
