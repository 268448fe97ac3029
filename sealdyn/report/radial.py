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
    yield from _contact_rows(whole, settled, contact)
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


def _contact_rows(whole, settled, contact):
    """Contact, gap, load and leakage: what has settled, or of a run that ended before that the whole of it."""
    part, of = (whole, "whole run") if settled["load"] is None else (settled, "settled")
    if part is whole:
        yield "contact", "nothing has settled: the run ended in its first half"
    if part["load"] is not None:
        yield (
            "contact" if part is settled else "",
            (
                f"{of}: {100 * part['contact_share']:.4g} % of the time on the shaft, the worst follower "
                f"{100 * part['least_contact_share']:.4g} %; held by the flange {100 * part['held_share']:.4g} %"
            ),
        )
    if contact["lift"]:
        yield "", (f"whole run: left the shaft {contact['lift']} times, first at t = {contact['first_lift']:.4g} s; "
                   f"landed {contact['land']} times, {contact['energy_lost']:.3g} J lost")  # fmt: skip
    if whole["largest_gap"]:
        gap, angle = MICRO * whole["largest_gap"], DEGREES * whole["largest_gap_angle"]
        yield (
            "largest gap",
            f"whole run: {gap:.4g} um at t = {whole['largest_gap_time']:.4g} s, theta = {angle:.4g} deg",
        )
    if part["load"] is None:
        return
    if whole["least_load"] is not None:
        yield "load", (f"{of}: {part['load']:.4g} N in all, {_of_a_follower(part)}; friction torque "
                       f"{part['friction_torque']:.4g} N m")  # fmt: skip
        if _of_a_follower(whole) != _of_a_follower(part):
            yield "", f"whole run: {_of_a_follower(whole)}"
    yield "leakage", (f"{of}: estimate {3.6e9 * part['leakage_estimate']:.4g} ml/h: laminar flow through the gaps, "
                      "nothing else")  # fmt: skip


def _of_a_follower(part) -> str:
    """The least and the largest load of one."""
    least, most = part["least_load"], part["largest_load"]
    return "none rides" if least is None else f"of a follower {least:.4g} to {most:.4g} N"
