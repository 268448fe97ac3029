"""Charts from made-up archives: what they say is checked by formula, how they look by measuring the figure."""

import importlib
import itertools
import json
import subprocess
import sys

import numpy as np
import pytest

from sealdyn.archive import ArchiveWriter, Series
from sealdyn.report.charts import record
from sealdyn.report.charts.record import Run
from sealdyn.studies._runner import study_module

KINDS = ["overview", "orbit", "film", "spectrum", "poincare"]
FILM = {"inner_radius": 0.032, "outer_radius": 0.04, "clearance": 1e-5, "coning": 3e-3}
SCENARIO = "# Does a flexibly mounted rotor follow a misaligned stator?  Expected: mostly.\n[shaft]\nspeed = 1000\n"
SUMMARY = {
    "model": {"film": "radial", "unknowns": ["rotor_z", "rotor_tilt_x", "rotor_tilt_y"], "solver": "adams"},
    "stability": {"verdict": "stable", "whirl_ratio": 0.49, "critical_speed": 8684.0},
    "h_min": {"value": 2.3e-6, "of_clearance": 0.23, "time": 0.1},
    "relative_misalignment": {"max": 2.4e-4, "min": 3e-5, "mean": 1e-4, "steady_max": 2e-4, "steady_min": None},
    "closed_form": {"relative_max": 2.1e-4, "relative_min": 4e-5},
    "leakage": {"mean_ml_per_h": 43219.7},
    "friction": {"power": 55.6, "torque": 0.0556},
    "film": {"axial_stiffness": 1.02e7, "tilt_stiffness": 5100.0},
    "closing": {"force": 725.7, "balance_ratio": 0.802},
    "contact_margin": 1.6,
    "energy_residual": 4.7e-8,
}


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


def write(path, columns, status="ok", message="", summary=None, film=None, **resolved):
    series = {name: Series("SI", name) for name in columns if name != "time"}
    resolved = {"film": FILM if film is None else film, **resolved}
    run = ArchiveWriter(path, scenario_text=SCENARIO, resolved=resolved, meta={}, series=series)
    run.append(columns)
    if status == "running":
        run.close()
        return path
    return run.finish(status, message, SUMMARY if summary is None else summary)


def drop(columns, *words):
    return {name: values for name, values in columns.items() if not any(word in name for word in words)}


def first(columns, rows):
    return {name: values[:rows] for name, values in columns.items()}


def archives():
    full = whirling()
    still = {**first(full, 50), "shaft_angle": np.zeros(50), "shaft_speed": np.zeros(50)}
    flat = {**full, **{n: 0 * full[n] for n in ("relative_tilt_x", "relative_tilt_y", "relative_misalignment")}}
    long_message = "h_min fell below the floor at t = 0.2 s, theta = 1.2 rad; try a larger clearance, less runout, "
    return {
        "full": (full, {}),
        "near_contact": (whirling(tilt=1.7e-4), {}),
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


@pytest.fixture
def figures(monkeypatch):
    """Figures as they were saved."""
    seen = []

    def catch(module):
        save = module.save
        monkeypatch.setattr(module, "save", lambda figure, path: seen.append(figure) or save(figure, path))
        return seen

    return catch


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ARCHIVES)
def test_every_chart_draws_every_archive_legibly(tmp_path, figures, kind, name):
    from PIL import Image

    columns, options = ARCHIVES[name]
    chart = importlib.import_module(f"sealdyn.report.charts.{kind}")
    seen = figures(chart)
    out = tmp_path / "chart.png"
    assert chart.draw(write(tmp_path / "seal.h5", columns, **options), out) == out
    assert out.stat().st_size <= 300_000 and list(tmp_path.glob("*.new")) == []
    with Image.open(out) as image:
        assert round(image.info["dpi"][0]) == 150
    overlaps, outside = text_trouble(seen[0])
    assert not overlaps and not outside


def text_trouble(figure):
    """Pairs of texts that lie on one another, and texts that leave the page."""
    figure.canvas.draw()
    page = figure.bbox
    boxes = []
    for text in figure.findobj(lambda artist: hasattr(artist, "get_text") and hasattr(artist, "get_fontsize")):
        if text.get_visible() and text.get_text().strip() and shown(text, figure):
            boxes.append((text.get_text(), text.get_window_extent()))
    overlaps = [
        (a, b)
        for (a, box), (b, other) in itertools.combinations(boxes, 2)
        if box.shrunk(0.9, 0.8).overlaps(other.shrunk(0.9, 0.8)) and not (box.width < 1 or other.width < 1)
    ]
    outside = [a for a, box in boxes if box.x0 < 0 or box.y0 < 0 or box.x1 > page.x1 or box.y1 > page.y1]
    return overlaps, outside


def shown(text, figure):
    """Whether a tick label belongs to a drawn tick of a visible axis; other texts always do."""
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
            if any(text in (tick.label1, tick.label2) for tick in ticks):
                drawn = [t.label1 for t in axis._update_ticks()] if axis.get_visible() else []
                return text in drawn
            if text in (axis.label, axis.offsetText):
                return axis.get_visible()
        if text in ax.get_children() and not ax.axison and text not in ax.texts:
            return text.get_text() == ax.get_title(loc="left")
    return True


def test_what_is_missing_is_said(tmp_path, figures):
    from sealdyn.report.charts import overview

    columns, options = ARCHIVES["bare"]
    seen = figures(overview)
    overview.draw(write(tmp_path / "seal.h5", columns, **options), tmp_path / "chart.png")
    words = [text.get_text() for ax in seen[0].axes for text in ax.texts]
    assert words.count("not in this scene") >= 3


def test_the_overview_says_question_model_verdict_and_numbers(tmp_path, figures):
    from sealdyn.report.charts import overview

    seen = figures(overview)
    overview.draw(write(tmp_path / "seal.h5", whirling(), message="done"), tmp_path / "chart.png")
    figure = seen[0]
    words = [text.get_text() for text in figure.texts]
    assert words[0] == "Does a flexibly mounted rotor follow a misaligned stator?"
    assert "seal" in words[1] and "radial film" in words[1] and "3 unknowns" in words[1] and "stable" in words[1]
    assert words[2] == "ok: done"
    numbers = [text.get_text() for ax in figure.axes for text in ax.texts]
    assert "2.3 µm, 23 % of clearance" in numbers and "43 220 ml/h" in numbers and "8684 rad/s" in numbers


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


def test_thinning_loses_no_extreme(tmp_path, figures, monkeypatch):
    from sealdyn.report.charts import overview

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
    seen = figures(overview)
    overview.draw(run.path, tmp_path / "chart.png")
    assert max(len(line.get_xdata()) for ax in seen[0].axes for line in ax.lines) <= record.POINTS
    assert (tmp_path / "chart.png").stat().st_size <= 300_000


def at_order(orders, amplitude, order):
    return amplitude[np.abs(orders - order).argmin()]


def test_the_spectrum_gives_orders_amplitudes_and_directions():
    from sealdyn.report.charts.spectrum import order_spectrum

    turns = np.arange(64 * 20 + 1) / 64
    angle = 2 * np.pi * turns
    orders, amplitude, resolution, resampled = order_spectrum(
        turns, 0.5 + 3 * np.exp(1j * angle) + 1j * np.exp(-2j * angle)
    )
    assert not resampled and resolution == pytest.approx(1.5 / 20)
    for order, expected in {1: 3, -2: 1, 0: 0.5, -1: 0, 2: 0, 3: 0}.items():
        assert at_order(orders, amplitude, order) == pytest.approx(expected, abs=1e-9)
    orders, amplitude, _, _ = order_spectrum(turns, 7 + 2 * np.cos(3 * angle + 1))
    assert at_order(orders, amplitude, 3) == pytest.approx(2) and amplitude[0] == pytest.approx(0, abs=1e-9)


def test_with_changing_speed_orders_stay_sharp():
    from sealdyn.report.charts.spectrum import order_spectrum

    # Even in time, speed from 1 to 3 turns per unit: over time the line would smear across a factor of three.
    time = np.linspace(0, 20, 6001)
    turns = time + 0.05 * time**2
    orders, amplitude, _, resampled = order_spectrum(turns, 2 * np.exp(2j * np.pi * turns))
    assert resampled
    assert at_order(orders, amplitude, 1) == pytest.approx(2, rel=1e-3)
    assert amplitude[np.abs(orders - 1) > 0.2].max() < 1e-3


def test_the_map_is_thinnest_where_the_archive_says(tmp_path):
    from sealdyn.report.charts.film import thickness

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


def test_the_reach_of_an_orbit_holds_every_row(tmp_path):
    from sealdyn.report.charts.orbit import hull

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


# --- studies -----------------------------------------------------------------------------------------


class Tools:
    """Evaluates in this process."""

    def map(self, function, points, what="points"):
        return [function(point) for point in points]

    def say(self, fraction):
        pass


STUDIES = {
    "campbell": [
        ("fms_reference", [], {}),
        ("fmr_reference", [], {}),
        ("fmr_reference", ["rotor.polar_inertia=2.6667e-4"], {"lines": (0.5, 1.0, 2.0), "unit": "rad/s"}),
        ("fmsr_both_flexible", [], {}),
    ],
    "transmissibility": [
        ("fmr_reference", [], {"points": 61, "time_points": 0}),
        ("fms_reference", ["film.model=linear"], {"points": 31, "time_points": 1, "speed_to": 1000.0}),
        ("fmsr_both_flexible", ["stator.speed=-300"], {"points": 61, "time_points": 0, "unit": "rpm"}),
        ("fmr_reference", [], {"points": 61, "time_points": 0, "speed_to": 1e5}),
    ],
}


@pytest.mark.parametrize(
    "study, name, overrides, settings", [(study, *case) for study, cases in STUDIES.items() for case in cases], ids=str
)
def test_study_charts_are_legible(tmp_path, figures, study, name, overrides, settings):
    from pathlib import Path

    from sealdyn import read_scenario
    from sealdyn.archive import write_study

    module = study_module(study)
    chart = importlib.import_module(f"sealdyn.report.charts.study_{study}")
    scenario = read_scenario(Path(__file__).parents[2] / "scenarios" / f"{name}.toml", overrides)
    answer = module.run(scenario, module.Settings(**settings), Tools())
    meta = {"name": name, "question": scenario.question}
    path = write_study(tmp_path / "s.h5", scenario.text, {}, meta, answer, module.units)
    seen = figures(chart)
    assert chart.draw(path, tmp_path / "s.png").stat().st_size <= 300_000
    overlaps, outside = text_trouble(seen[0])
    assert not overlaps and not outside
    assert not (crossed(seen[0].axes[0]) if study == "campbell" else [])
    if study == "transmissibility":
        heights = [ax.get_position().y0 for ax in seen[0].axes[:5]]
        # Amplitudes above, the phases of the first two below them.
        assert heights[0] == heights[2] == heights[4] > heights[1] == heights[3]
        assert seen[0].axes[1].get_ylabel() == "phase behind the forcing, deg"


def crossed(ax):
    """Names in a panel that a line not their own, or a mark, runs through."""
    ax.figure.canvas.draw()
    found = []
    for text in ax.texts:
        box = text.get_window_extent()
        for line in ax.lines:
            points = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
            along = np.linspace(0, 1, 4000)
            at = np.linspace(0, 1, len(points))
            dense = np.column_stack([np.interp(along, at, points[:, k]) for k in (0, 1)])
            inside = (box.x0 < dense[:, 0]) & (dense[:, 0] < box.x1) & (box.y0 < dense[:, 1]) & (dense[:, 1] < box.y1)
            # Its own line runs through the middle of the name.
            middle = np.hypot(dense[:, 0] - (box.x0 + box.x1) / 2, dense[:, 1] - (box.y0 + box.y1) / 2).min()
            if inside.any() and middle > 2:
                found.append(text.get_text())
    return found
