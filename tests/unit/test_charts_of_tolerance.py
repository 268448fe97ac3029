"""The figure of a tolerance study: a single key, long names, the units of its text, what is seen on what."""

import numpy as np
import pytest
from drawn import panel, study, text_trouble
from test_charts_untuned import RPM, empty, ticks

QUANTILES = ("1", "5", "25", "50", "75", "95", "99")


def scattered(keys, outputs, indices=True, runs=(16, 32)):
    """An answer of these keys; outputs {name: (SI unit, largest value)}."""
    spread = {name: (size * np.linspace(0.5, 1.0, 32)).tolist() for name, (_, size) in outputs.items()}
    share = {"total": 0.9, "total_low": 0.6, "total_high": 1.2, "first": 0.8}
    share, levels = share if indices else dict.fromkeys(share), np.linspace(0.5, 1.0, 7)
    tighten = [{"key": key, "rank_correlation": 0.7, **share} for key in keys]
    return {
        "keys": list(keys), "outputs": list(outputs), "output_units": {n: unit for n, (unit, _) in outputs.items()},
        "nominal": {name: 0.7 * size for name, (_, size) in outputs.items()},
        "quantiles": {n: dict(zip(QUANTILES, size * levels, strict=True)) for n, (_, size) in outputs.items()},
        "scatter": {key: {"unit": "rad/s" if "speed" in key else "rad"} for key in keys},
        "sobol": {"total": indices or None, "reason": "not asked for"}, "tighten": dict.fromkeys(outputs, tighten),
        "samples": {"keys": {key: np.linspace(1.0, 2.0, 32).tolist() for key in keys}, "outputs": spread,
                    "contact": 32 * [0]},
        "convergence": {"samples": list(runs), "runs": list(runs), "output": next(iter(outputs)),
                        "quantiles": {level: len(runs) * [1e-6] for level in QUANTILES},
                        "probability_of_contact": len(runs) * [[0.0, 0.0, 0.1]],
                        "total": {key: len(runs) * [0.9 if indices else None] for key in keys}},
    }  # fmt: skip


FILM = {"h_min.value": ("m", 1e-6)}


def test_the_name_of_a_band_stands_off_the_bars(tmp_path):
    ax = panel(study(tmp_path, "tolerance", scattered(["film.coning"], FILM)), "h_min.value")
    ax.figure.draw_without_rendering()
    (band,) = [text for text in ax.get_legend().get_texts() if text.get_text() == "5 to 95 %"]
    assert band.get_window_extent().y0 > ax.get_window_extent().y1


def test_scatter_is_read_in_the_units_of_its_text(tmp_path):
    outputs = {"stability.critical_speed": ("rad/s", 1e3), "leakage.mean": ("m^3/s", 3e-5)}
    outputs["contact_margin"] = ("", 5e7)
    figure = study(tmp_path, "tolerance", scattered(["shaft.speed"], outputs), RPM)
    assert text_trouble(figure) == ([], [])
    labels = [panel(figure, name).get_xlabel().removeprefix(name) for name in outputs]
    assert labels == [", rpm", ", l/min", ", 10⁶"]
    bars = panel(figure, "contact_margin").patches
    assert max(bar.get_x() + bar.get_width() for bar in bars if bar.get_height()) == pytest.approx(50.0)
    cloud = panel(figure, "stability.critical_speed over")
    assert cloud.get_xlabel() == "shaft.speed, rpm" and max(cloud.lines[0].get_xdata()) == pytest.approx(60 / np.pi)


def test_long_names_stay_within_their_panels(tmp_path):
    outputs = {"relative_misalignment.steady_max": ("rad", 1e-6)}
    figure = study(tmp_path, "tolerance", scattered(["stator.support.axial_stiffness", "film.coning"], outputs))
    assert text_trouble(figure) == ([], [])
    ends = [ax._left_title.get_window_extent().x1 - ax.get_window_extent().x1 for ax in figure.axes]
    assert max(ends) < 10.0


def test_runs_are_whole_and_what_was_not_asked_takes_no_room(tmp_path):
    figure = study(tmp_path, "tolerance", scattered(["film.coning"], FILM, indices=False))
    assert empty(figure) == [] and "Do the indices settle?" not in [ax.get_title("left") for ax in figure.axes]
    counts = [float(word) for word in ticks(panel(figure, "h_min.value"))[0][1]]
    assert all(count == int(count) for count in counts) and counts[1] in (1.0, 2.0, 5.0)
