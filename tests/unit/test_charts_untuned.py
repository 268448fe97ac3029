"""Charts of seals that nobody tuned: tiny tilts, aligned faces, no threshold, nothing that touches."""

import re

import numpy as np
import pytest
from drawn import drawn, panel, text_trouble
from made_up_run import SUMMARY, whirling, write

from sealdyn.quantities import by_size
from sealdyn.report.charts import film, orbit, overview, spectrum

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
    assert by_size("rad", "µrad", 1e6, 3e-6) == ("µrad", 1e6) and by_size("rad", "µrad", 1e6, 1.4e-8) == ("nrad", 1e9)
    assert by_size("m", "µm", 1e6, 2e-3) == ("mm", 1e3) and by_size("m", "µm", 1e6, 0.0) == ("µm", 1e6)
    # A unit that somebody chose stays.
    assert by_size("m", "nm", 1e9, 1e-5) == ("nm", 1e9) and by_size("K", "", 1.0, 3.0) == ("", 1.0)


@pytest.mark.parametrize("chart", [overview, orbit, film, spectrum], ids=lambda chart: chart.__name__.split(".")[-1])
def test_tiny_tilts_are_read_in_tiny_units(tmp_path, chart):
    figure = drawn(chart, write(tmp_path / "seal.h5", whirling(tilt=2e-11)), tmp_path / "chart.png")
    must_be_legible(figure)
    words = [text.get_text() for ax in figure.axes for text in (ax.xaxis.label, ax.yaxis.label)]
    assert chart is film or any("nrad" in word for word in words)


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
    names = [text.get_text().rstrip("0123456789. µm") for text in ax.get_legend().get_texts()]
    assert ("asperities meet" in names) == there and "clearance" in names


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
