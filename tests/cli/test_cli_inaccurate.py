"""A run that is not as exact as asked: done again, sharper, and if that does not help status and exit code say so."""

import pytest
from command import SCENARIOS, sealdyn, settings

from sealdyn.archive import read_info


def test_a_run_that_errs_too_much_is_done_again(tmp_path):
    answer = sealdyn("run", SCENARIOS / "impact.toml", "--no-plot", "--json", "--out", "a.h5", cwd=tmp_path)
    found = answer.found
    assert answer.code == 0 and found["certificate"]["met"] and "again, sharper" in " ".join(found["model"]["reasons"])
    assert found["tolerance"] < 5e-9


@pytest.mark.core
def test_a_run_that_no_tolerance_helps_is_inaccurate(tmp_path):
    """A flat ring squeezed to a hundredth of its film amplifies errors beyond what any of its methods can keep."""
    out = tmp_path / "a.h5"
    answer = sealdyn(
        "run",
        SCENARIOS / "squeeze.toml",
        "--no-plot",
        "--json",
        "--out",
        out,
        *settings({"run.accuracy": 1e-9}),
        cwd=tmp_path,
    )
    found = answer.found
    assert answer.code == 5 and found["status"] == "inaccurate" and read_info(out)["status"] == "inaccurate"
    assert not found["certificate"]["met"] and any("NOT met" in warning for warning in found["warnings"])
