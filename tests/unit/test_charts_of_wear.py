"""The figure of a wear study: what is extrapolated far away, curves that lie on each other, changes that are none."""

import pytest
from drawn import panel, study
from test_charts_untuned import LIFTED, must_be_legible, said, ticks, worn

HOURS = [0.0, 3600.0, 7200.0]


def touching(**more):
    """An answer of three profiles, both faces worn alike."""
    answer = worn(HOURS, **{**LIFTED, "contact_share": 0.3, "contact_area_fraction": 3e-4})
    answer["history"] |= {"stator_volume": [0.0, 1e-9, 2e-9], "rotor_volume": [0.0, 1e-9, 2e-9]}
    profile = {face: [[0.0, 0.0], [1e-7, 2e-7], [2e-7, 4e-7]] for face in ("stator", "rotor")}
    answer["profile"] |= profile
    return answer | more


@pytest.mark.parametrize("depth, drawn", [(8e-7, True), (9e-4, False)])
def test_what_is_extrapolated_does_not_hide_what_is_computed(tmp_path, depth, drawn):
    later = {"time": 500 * 3600.0, "stator": [depth, depth], "rotor": [depth, depth]}
    figure = study(tmp_path, "wear", touching(extrapolated=later))
    must_be_legible(figure)
    ax = panel(figure, "Stator: worn off")
    assert any(line.get_linestyle() == ":" for line in ax.lines) == drawn
    assert max(ax.get_ylim()) < (1.5 if drawn else 0.6)
    names = [text.get_text() for text in [*ax.texts, *(ax.get_legend().get_texts() if ax.get_legend() else [])]]
    words = "extrapolated to 500 h, not computed" if drawn else "extrapolated to 500 h: 900 µm, not computed"
    assert words in names


def test_curves_that_lie_on_each_other_are_seen(tmp_path):
    figure = study(tmp_path, "wear", touching())
    for title in ("Worn volume", "Contact pressure"):
        below, above = panel(figure, title).lines[:2]
        assert below.get_linewidth() > 1.5 * above.get_linewidth()


def test_a_film_that_hardly_changes_is_flat(tmp_path):
    answer = touching()
    answer["history"] |= {"mean_clearance": [2e-6, 2.001e-6, 2.002e-6], "h_min": [2e-6, 2e-6, 1.999e-6]}
    low, high = panel(study(tmp_path, "wear", answer), "Film").get_ylim()
    assert high - low > 0.1


def test_shares_over_decades_are_plain_numbers(tmp_path):
    words = ticks(panel(study(tmp_path, "wear", touching()), "Contact"))[0][1]
    assert {"0.1", "1", "10"} <= set(words)


def test_what_a_wear_does_not_hold_for_is_in_its_figure(tmp_path):
    figure = study(tmp_path, "wear", touching(verdict=["Run in.", "Worn off.", "Mind: fewer than 4 radii touch."]))
    must_be_legible(figure)
    assert any("Mind: fewer than 4 radii touch." in words for words in said(figure))
