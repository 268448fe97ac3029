"""Every exhibit fails where it says and survives where it says; the gallery's page and the sampling warning."""

import json

import numpy as np
import pytest
from command import SCENARIOS
from drawn import text_trouble

import sealdyn
from sealdyn.archive import read_study
from sealdyn.numerics.time_series import at_the_edge, order_spectrum
from sealdyn.report.panels import draw
from sealdyn.scenario.errors import ScenarioError
from sealdyn.studies._runner import run_study
from sealdyn.studies.failures import chosen_for, exhibit_names, place_of, shown

SCENARIO = SCENARIOS / "fmr_reference.toml"
KEYS = {"item", "title", "failing", "failing_error", "survivor", "survivor_error", "unit", "default"}

# Title: least that the failing method must be off (None: it must give no answer), most that the survivor may be.
# Measured at the end of each line.
BOUNDS = {
    "neutral_stability": {"Neutral stability: BDF": (1e-5, 1e-13),  # 4.9e-4, 5e-16
                          "Neutral stability: Adams": (1e-6, 1e-13)},  # 1e-4, 5e-16
    "stiff_squeeze": {"Stiff squeeze film": (1e8, 5e3)},  # 1.8e10, 380
    "touch_between_steps": {"Touch between steps": (60, 0)},  # 249, none
    "coulomb_friction": {"Coulomb friction": (1e-4, 1e-6)},  # 4e-3, 1e-8
    "degenerate_geometry": {"Flat faces": (1e-3, 1e-12),  # 1.6, 2e-15
                            "Zero tilt passed": (1e-4, 1e-9),  # 6e-3, 3e-11
                            "Start at zero tilt": (None, 1e-8)},  # 0/0, 6e-12
    "vanishing_inertia": {"Vanishing inertia": (1500, 600),  # 9800, 130
                          "No inertia": (1e-2, 1e-5)},  # 0.1, 2e-8
    "inconsistent_start": {"Start inside the other face": (1.0, 0),  # 2 um, refused
                           "Loads without an equilibrium": (0.1, 0),  # 0.38, refused
                           "Rates at the start of a DAE": (1e-4, 1e-12),
                           "Pressures that contradict": (0.3, 1e-10)},  # 1, 3e-12
    "fronts": {"Cavitation front": (1e-6, 1e-9),  # 4e-5, 1e-13
               "Choking": (3e-6, 1e-7)},  # 1.7e-5, 9e-9
    "chaos": {"Chaos": (1.0, 0.5)},  # 2.9, 0.06
    "long_runs": {"Phase after 1e6 turns": (1e-10, 3e-12),  # 8e-10, 1.7e-12
                  "Angle added step by step": (1e-5, 3e-12),  # 1.8e-4
                  "5.4 kHz on a 16 Hz shaft": (1000.0, 1.0)},  # 5184 Hz, 0
    "several_answers": {"Several clearances": (0.5, 1e-9),  # 8.5, 1e-12
                        "Two stable clearances": (1.0, 1e-9),  # 11
                        "Three waviness states": (0.3, 3e-6)},
    "linear_theory": {"Linear theory at large tilt": (0.05, 1e-6)},  # 0.13, 8e-11
    "choked_gas": {"Choked exit": (3e-3, 1e-10),  # 9e-3, 5e-14
                   "Invariant line": (0.1, 1e-10)},  # 0.45, 4e-15
    "trapped_gas": {"Trapped gas": (29.0, 2e-3),  # 87, 6e-4
                    "Layer at the edge": (1.3e-3, 1.3e-3)},  # 3.9e-3, 6.7e-4
    "moving_cavity": {"Cavity that follows at once": (0.07, 4e-4),  # 0.23, 1.2e-4
                      "Frozen cavity": (0.05, 1.6e-3),  # 0.15, 5e-4
                      "Implicit Euler": (0.01, 1.3e-3),  # 0.03, 4e-4
                      "Reynolds' condition": (0.19, 1e-9)},  # 0.56, 1e-12
}  # fmt: skip
LONG = {"chaos"}


def exhibits():
    return [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in BOUNDS]


@pytest.mark.core
def test_every_place_has_an_exhibit():
    names = exhibit_names()
    assert set(names) == set(BOUNDS) and sorted(set(names.values())) == list(range(1, 15))


@pytest.mark.parametrize("name", exhibits())
def test_the_failure_is_there_and_the_survivor_holds(name):
    rows = shown({"exhibit": name})["rows"]
    by_title = {row["title"]: row for row in rows}
    assert set(by_title) == set(BOUNDS[name])
    for title, (least, most) in BOUNDS[name].items():
        row = by_title[title]
        assert set(row) == KEYS and row["default"] and row["unit"]
        if least is None:
            assert row["failing_error"] is None
        else:
            assert np.isfinite(row["failing_error"]) and row["failing_error"] > least
        assert row["survivor_error"] <= most
    json.dumps(rows, allow_nan=False)


def test_every_error_is_drawn_in_the_panel_of_its_unit(tmp_path):
    out = tmp_path / "failures.h5"
    answer = run_study("failures", sealdyn.read_scenario(SCENARIO), out, flags={"items": [3, 5, 11, 13]}, workers=1)
    assert answer["status"] == "ok" and answer["items"] == [3, 5, 11, 13]
    assert answer["scenario"]["method"] == "adams"
    held = read_study(out)
    assert held["answer"]["rows"] == answer["rows"]
    drawn = [x for panel in held["panels"] for one in panel["series"] if one["kind"] == "marks" for x in one["x"]]
    errors = [row[name] for row in answer["rows"] for name in ("failing_error", "survivor_error")]
    assert sorted(drawn) == sorted(error for error in errors if error)
    words = [word for panel in held["panels"] for one in panel["series"] for word in one.get("names", ())]
    assert words.count("no answer") == errors.count(None) == 1
    assert [panel["x"]["label"] for panel in held["panels"]] == ["error", "dips missed of 300"]
    assert text_trouble(draw(out))[1] == []


# A scene that comes to each place: one that ships, with overrides; few cells of those that have them.
COARSE = ["film.reynolds.cells_r=6", "film.reynolds.cells_theta=108"]
ROUGH = ["contact.roughness='0.1 um'", "contact.compressive_strength='1 GPa'"]
MEET = {
    "neutral_stability": ("fms_reference", ["shaft.speed=5600 rad/s", "film.model=radial"]),
    "stiff_squeeze": ("pressure_step", []),
    "touch_between_steps": ("impact", []),
    "coulomb_friction": ("hang_up", []),
    "degenerate_geometry": ("fms_reference", ["film.coning='1 nrad'"]),
    "vanishing_inertia": ("massless_ring", []),
    "inconsistent_start": ("impact", []),
    "fronts": ("fms_reference", ["film.cavitation_pressure='0 bar'", "film.model=radial"]),
    "chaos": ("fms_reference", ["shaft.speed=6500 rad/s", *ROUGH]),
    "long_runs": ("fms_reference", ["run.samples_per_turn=1"]),
    "several_answers": ("lebeck_elastic", COARSE),
    "linear_theory": ("rub", []),
    "choked_gas": ("gas_dam_reference", []),
    "trapped_gas": ("gas_reynolds_reference", []),
    "moving_cavity": ("lebeck_n3", COARSE),
}


def met_by(name, overrides) -> set[str]:
    scenario = sealdyn.read_scenario(SCENARIO.with_name(f"{name}.toml"), overrides)
    own, met = chosen_for(scenario, exhibit_names())
    assert "refused" not in own
    return {place for place, why in met.items() if why}


@pytest.mark.parametrize("place", BOUNDS)
def test_a_seal_is_told_which_places_it_comes_to(place):
    assert place in met_by(*MEET[place])


@pytest.mark.parametrize("name", ["lebeck_elastic", "lebeck_n3"])
def test_a_wavy_seal_is_told_too_and_is_not_called_flat(name, tmp_path):
    scenario = sealdyn.read_scenario(SCENARIO.with_name(f"{name}.toml"), COARSE)
    answer = run_study("failures", scenario, tmp_path / "f.h5", flags={"items": [5, 11, 14]}, workers=1)
    assert [row["item"] for row in answer["met"]] == ([11, 14] if name == "lebeck_elastic" else [14])


def test_reasons_are_in_words_and_few_digits():
    flat = sealdyn.read_scenario(SCENARIO, ["film.coning=0"])
    assert chosen_for(flat, ["degenerate_geometry"])[1] == {"degenerate_geometry": "its faces are parallel"}
    stiff = sealdyn.read_scenario(SCENARIO.with_name("ludwig_allen.toml"))
    assert "fastest decay 852000 times the fastest forcing" in chosen_for(stiff, [])[0]["why"]
    assert place_of("coulomb_friction") == "Coulomb friction" and place_of("long_runs") == "long runs"


@pytest.mark.parametrize("name", ["fms_reference", "fmr_reference", "fmsr_both_flexible", "housing_vibration"])
def test_an_ordinary_seal_comes_to_none_of_them(name):
    assert met_by(name, []) == set()


def test_the_answer_speaks_of_this_seal(tmp_path):
    """Of two exhibits the seal comes to one."""
    scenario = sealdyn.read_scenario(SCENARIO, ROUGH)
    answer = run_study("failures", scenario, tmp_path / "f.h5", flags={"items": [3, 5]}, workers=1)
    assert [row["item"] for row in answer["met"]] == [3] and "[contact]" in answer["met"][0]["met"]
    assert {row["item"] for row in answer["rows"] if row["met"]} == {3}
    assert answer["met"][0]["met"] in answer["found"]
    assert [row[0] for row in answer["tables"][1]["rows"]] == [3]


def test_an_exhibit_that_breaks_is_a_row_with_its_reason(tmp_path, monkeypatch):
    from sealdyn.studies.failures.cases.integration import EXHIBITS

    def broken():
        raise ValueError("broken on purpose")

    monkeypatch.setitem(EXHIBITS, "touch_between_steps", (3, (broken,), lambda scene, run: ""))
    out = tmp_path / "failures.h5"
    answer = run_study("failures", sealdyn.read_scenario(SCENARIO), out, flags={"items": 3}, workers=1)
    assert answer["status"] == "failed" and "broken on purpose" in answer["rows"][0]["failed"]
    assert any("broken on purpose" in note for note in answer["notes"])
    assert draw(out) is not None


def test_items_that_do_not_exist_are_refused(tmp_path):
    with pytest.raises(ScenarioError) as refused:
        run_study("failures", sealdyn.read_scenario(SCENARIO), tmp_path / "x.h5", flags={"items": [15]}, workers=1)
    assert refused.value.key.endswith("items") and "15" in refused.value.found
    assert "14" in refused.value.expected


# --- sampling --------------------------------------------------------------------------------------------


EDGE = [(order, 64, 0.01 / 1.01) for order in (30, 31, 33, 34)]


@pytest.mark.parametrize("order, per_turn, share", [*EDGE, (30, 256, 0.0), (34, 256, 0.0), (3, 64, 0.0)])
def test_a_response_at_the_edge_of_the_band_has_its_share(order, per_turn, share):
    """A hundredth of the power; order 33 of 64 samples a turn shows at 31."""
    at = np.arange(40 * per_turn) / per_turn
    signal = np.cos(2 * np.pi * at) + 0.1 * np.cos(2 * np.pi * order * at)
    orders, amplitude, resolution, _ = order_spectrum(at, signal)
    assert at_the_edge(orders, amplitude, 0.5 * resolution) == pytest.approx(share, rel=0.05, abs=1e-6)


def drawn_texts(order, samples):
    """What the spectrum of a seal says whose tilt has a part at one order."""
    from sealdyn.report.charts import spectrum
    from sealdyn.report.charts.page import look, sheet

    class Made:
        turned, rows, turns = True, samples, np.arange(samples) / 64

        def has(self, *names):
            return True

        def last(self, *_):
            return 0

        def values(self, name, first):
            return np.full(samples, 1000.0)

        def housing(self, kind):
            return []

        def shown(self, name, size):
            return "urad", 1e6

    with look():
        ax = sheet(8, 4).add_axes((0.1, 0.1, 0.8, 0.8))
        turns = Made.turns
        tilt = 1e-4 * (np.exp(2j * np.pi * turns) + 0.1 * np.exp(2j * np.pi * order * turns))
        spectrum.show(ax, Made(), lambda first: tilt, "tilt", "tilt_x", "k", None)
        return [text.get_text() for text in ax.texts]


# The second part is a tenth of the first; order 33.75 of 64 samples a turn shows at 30.25.
@pytest.mark.parametrize("order, warns", [(30, True), (33.75, True), (3, False), (25.0, False)])
def test_the_spectrum_says_so_in_the_figure(order, warns):
    texts = drawn_texts(order, 64 * 20)
    assert any("may be folded" in text for text in texts) == warns
