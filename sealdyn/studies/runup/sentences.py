"""What a run-up says, in sentences."""

from ...status import Status
from .._words import RPM, plain, quantity, speed

WAYS = ("up", "down")
# Up to this share of the tilt that touches, a seal is near its aligned film; of the power that may be folded.
NEAR, FOLDED = 0.5, 1e-4


def sentences(answer) -> list[str]:
    """Verdict of ramps of the shaft speed: how fast to pass, what was passed, what growth says; then warnings."""
    good = [row for row in answer["rows"] if "failed" not in row]
    lines = [_passing(answer, good), _passed(answer)]
    if answer["crossing"] is not None:
        lines += _growth(answer, good)
    folded = max((row["folding"] for row in good), default=0.0)
    warnings = [*answer["warnings"], *(words for row in good for words in row["warnings"])]
    if folded > FOLDED:
        warnings.append(f"aliasing: {100 * folded:.2g} % of the power may be folded: raise samples_per_turn")
    return [*lines, *dict.fromkeys(warnings)]


def rate_words(rate) -> str:
    return f"{plain(rate, 4)} rad/s^2 ({plain(rate * RPM, 4)} rpm/s)"


def _passing(answer, rows) -> str:
    """How fast the threshold must be passed; without one how near the faces come."""
    threshold, touch, foretold = answer["threshold"], answer["touch_rate"], answer["rate_foretold"]
    if answer["crossing"] is None:
        films = [(row["h_min"], row["rate"]) for row in rows if row["h_min"] is not None]
        near = f"; thinnest film {1e6 * min(films)[0]:.4g} um, at {rate_words(min(films)[1])}" if films else ""
        if threshold is not None:
            return f"The stability threshold {speed(threshold)} is not on the way{near}."
        if not answer["tilting"]:
            return f"Nothing tilts the rings here, and no whirl is followed{near}."
        if answer["linear_verdict"] != "stable":
            return f"No stability threshold: the seal is {answer['linear_verdict']} at every speed{near}."
        return f"No stability threshold: whirl dies out at every speed, however slowly it is passed{near}."
    linear = f"linear theory: {rate_words(foretold)}" if foretold else "linear theory: no such rate"
    if touch is None or touch["value"] is None:
        why = "not looked for" if touch is None else touch["said"]
        return f"How fast the threshold {speed(threshold)} must be passed to stay below touch: {why}; {linear}."
    return (f"To stay below touch the threshold {speed(threshold)} must be passed faster than "
            f"{rate_words(touch['value'])}; {linear}.")  # fmt: skip


def _passed(answer) -> str:
    linear, order = answer["linear"]["peak"], f"order {answer['order']:g}"
    chosen = f" ({', '.join(answer['chosen'])} chosen here)" if answer["chosen"] else ""
    peak = f"linear steady theory has no peak of {order} there"
    if not max(answer["linear"]["amplitude"], default=0.0):
        peak = f"nothing drives {order}"
    elif linear is not None:
        height = f"{1e6 * linear[1]:.4g} {'urad' if answer['tilting'] else 'um'}"
        peak = f"linear steady theory has the peak of {order} at {speed(linear[0])}, {height}"
    return f"Shaft speed from {speed(answer['begin'])} to {speed(answer['end'])} and back{chosen}; {peak}."


def _growth(answer, rows) -> list[str]:
    """How the whirl grows beside the integral of the linear growth rate, or why that tells nothing."""
    if answer["forced_tilt"] > NEAR * answer["touch_tilt"]:
        forced, closing = 1e6 * answer["forced_tilt"], 1e6 * answer["touch_tilt"]
        return [f"Linear theory would force a tilt of {forced:.4g} urad, {closing:.4g} would close the unopened gap: "
                "its growth rate tells nothing here."]  # fmt: skip
    off = [row["growth"]["error_with_factor"] for row in rows if row["growth"] and row["growth"]["error"] is not None]
    off = [abs(error) for error in off if error is not None]
    if not off:
        return []
    return [f"A whirl of {1e6 * answer['disturbance']:.3g} urad met at the threshold grows as the integral of the "
            f"linear growth rate says, within {100 * max(off):.2g} % of the logarithm."]  # fmt: skip


def load_sentences(answer) -> list[str]:
    """Verdict of ramps and steps of anything but the speed."""
    slow, key, slowest = answer["quasi_static"], answer["key"], answer["slowest"]
    begin, end = (quantity(answer[name], answer["unit"]) for name in ("begin", "end"))
    films = [(row["h_min"], row["rate"]) for row in answer["rows"] if row.get("h_min") is not None]
    least, rate = min(films, key=lambda film: film[0], default=(None, None))
    how = "in a step" if rate is None else f"at {quantity(rate, answer['unit'], 4)}/s"
    film = "no film" if least is None else f"thinnest film {1e6 * least:.4g} um, {how}"
    lines = [f"{key} from {begin} to {end} and back: {film}."]
    ends = ["no gap balances the loads" if slow["h_min"][k] is None else
            f"{1e6 * slow['h_min'][k]:.4g} um, {1e6 * slow['relative_misalignment'][k]:.4g} urad, "
            f"{quantity(slow['leakage'][k], 'm^3/s')}" for k in (0, -1)]  # fmt: skip
    between = "; between them are values whose loads no gap balances" if None in slow["h_min"][1:-1] else ""
    lines.append(f"Infinitely slowly (film, misalignment, leakage): {ends[0]} at begin, {ends[1]} at end{between}.")
    lines.append(f"Disturbances of the linear seal fall to 1/e within {-1 / slowest:.3g} s." if slowest < 0 else
                 f"The linear seal is unstable there: its disturbances grow by {slowest:.3g} 1/s.")  # fmt: skip
    ended = [row["message"] for row in answer["rows"] if row.get("status", Status.OK) != Status.OK]
    return [*lines, *dict.fromkeys(ended)]
