"""Words for a radial seal: the summary of its run."""

import math

MICRO, DEGREES, RPM = 1e6, 180 / math.pi, 30 / math.pi


def is_radial(info: dict) -> bool:
    """Whether an archive is that of a radial seal, by its resolved scene."""
    return any((info.get("resolved") or {}).get(table) for table in ("lip", "circumferential"))


def radial_rows(summary):
    """(name, words) of every line of a run; a line that goes on has no name."""
    model, one, form = summary["model"], summary["follower"], summary["closed_form"]
    whole, settled, contact = summary["whole"], summary["settled"], summary["contact"]
    kind = "sectors of a lip" if summary["seal"] == "lip" else "segments"
    counts, arc = summary["counts"], one["arc"]
    yield "model", (f"{model['followers']} {kind}; {model['solver']}, {counts['steps']} steps, {counts['rhs']} "
                    f"evaluations, {summary['wall_time']:.2g} s")  # fmt: skip
    yield from (("", reason) for reason in model["reasons"])
    yield "follower", (f"preload {one['preload'] / arc:.4g} N/m, stiffness {one['stiffness'] / arc:.4g} N/m^2, mass "
                       f"{one['mass'] / arc:.4g} kg/m, flange friction {one['friction']:.4g} N each")  # fmt: skip
    yield "contact", (f"settled: {100 * settled['contact_share']:.4g} % of the time on the shaft, the worst follower "
                      f"{100 * settled['least_contact_share']:.4g} %; held by the flange "
                      f"{100 * settled['held_share']:.4g} %")  # fmt: skip
    if contact["lift"]:
        yield "", (f"left the shaft {contact['lift']} times, first at t = {contact['first_lift']:.4g} s; landed "
                   f"{contact['land']} times, {contact['energy_lost']:.3g} J lost")  # fmt: skip
    if whole["largest_gap"]:
        yield "largest gap", (f"{MICRO * whole['largest_gap']:.4g} um at t = {whole['largest_gap_time']:.4g} s, theta "
                              f"= {DEGREES * whole['largest_gap_angle']:.4g} deg")  # fmt: skip
    if whole["least_load"] is not None:
        yield "load", (f"{settled['load']:.4g} N in all; of a follower {whole['least_load']:.4g} to "
                       f"{whole['largest_load']:.4g} N; friction torque {settled['friction_torque']:.4g} "
                       "N m")  # fmt: skip
    yield "leakage", (f"estimate {3.6e9 * settled['leakage_estimate']:.4g} ml/h: laminar flow through the gaps, "
                      "nothing else")  # fmt: skip
    margin, needed = form["margin"], form["needed_preload"] / arc
    there = "nothing swings" if margin is None else f"there is {margin:.4g} times that"
    yield "closed form", (f"rides everywhere with a preload of {needed:.4g} N/m at {form['speed'] * RPM:.5g} rpm: "
                          f"{there}")  # fmt: skip
    largest = form["largest_eccentricity"]
    yield "", f"of eccentricities alone up to {'any' if largest is None else f'{1e3 * largest:.4g} mm'}"
    if form["hangs_up"]:
        yield "", "the flange's friction is as large as the preload: hang-up"
    yield "energy audit", f"residual {summary['energy_residual']:.1e} of the work exchanged"
    if summary.get("certificate"):
        yield "accuracy", summary["certificate"]["said"]
    yield from (("WARNING", warning) for warning in summary["warnings"])
    yield "files", ", ".join(filter(None, (summary["archive"], summary.get("figure"))))
