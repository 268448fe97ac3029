"""What a run-up says, in sentences."""

import math

from ...status import Status

RPM = 30 / math.pi
WAYS = ("up", "down")


def sentences(answer) -> list[str]:
    """Verdict of ramps of the shaft speed."""
    rows = answer["rows"]
    said = [_range(answer), *answer["warnings"]]
    said += [f"at {row['rate']:.4g} rad/s^2: {row['failed']}" for row in rows if "failed" in row]
    good = [row for row in rows if "failed" not in row]
    said += list(dict.fromkeys(warning for row in good for warning in row["warnings"]))
    said += [
        f"at {row['rate']:.4g} rad/s^2: {_ended(row)}" for row in good if row["status"] != Status.OK or row["touched"]
    ]
    said += _peaks(answer, good) + _lag(good) + _resolution(answer, good)
    if answer["crossing"] is None:
        said.append(_no_threshold(answer))
        return said + _extremes(good)
    return said + _growth(answer, good) + _touch(answer)


def _speed(w) -> str:
    return f"{w:.5g} rad/s ({w * RPM:.5g} rpm)"


def _ended(row) -> str:
    """That it touched or collapsed, and where on its way."""
    where = f"at {_speed(row['h_min_speed'])} going {row['h_min_way']}" if row["h_min_speed"] else ""
    if row["status"] == Status.OK:
        return f"the faces touch, closest {where} (mean planes {1e6 * row['h_min']:.3g} um), and the run goes on"
    return f"{row['message'].partition(' at t =')[0]} {where}: the run ends there" if where else row["message"]


def _range(answer) -> str:
    chosen = f"; {', '.join(answer['chosen'])} chosen here" if answer["chosen"] else ""
    rates = ", ".join(f"{row['rate']:.4g}" for row in answer["rows"])
    turns = [row["turns"] for row in answer["rows"] if row.get("turns")]
    count = f", {min(turns):.3g} to {max(turns):.4g} turns each way" if turns else ""
    return (f"shaft speed from {_speed(answer['begin'])} to {_speed(answer['end'])} and back at {rates} rad/s^2"
            f"{count}{chosen}")  # fmt: skip


def _peaks(answer, rows) -> list[str]:
    """Where linear theory has the peak and where the ramps have it."""
    unit, what = (1e6, "urad") if answer["tilting"] else (1e6, "um")
    linear, order = answer["linear"]["peak"], answer["order"]
    if not max(answer["linear"]["amplitude"], default=0.0):
        return [f"nothing drives order {order:g}: its amplitude is the whirl's or nothing"]
    if linear is None:
        return [f"order {order:g}: linear steady theory has no peak inside the range"]
    said = [f"order {order:g}: linear steady theory peaks at {_speed(linear[0])} with {unit * linear[1]:.4g} {what}"]
    for row in rows:
        found = [f"{row[w]['peak'][0] - linear[0]:+.4g} rad/s going {w} ({unit * row[w]['peak'][1]:.4g} {what})"
                 for w in WAYS if row[w]["peak"]]  # fmt: skip
        if found:
            said.append(f"at {row['rate']:.4g} rad/s^2 the peak is found {', '.join(found)}, read to about "
                        f"{row['speed_in_window'] / 4:.2g} rad/s")  # fmt: skip
    return said


def _lag(rows) -> list[str]:
    told = [(row["rate"], max(d for d in (row[w]["departure"] for w in WAYS) if d is not None)) for row in rows
            if any(row[w]["departure"] is not None for w in WAYS)]  # fmt: skip
    if not told:
        return []
    return ["farthest from linear steady theory (below the threshold, of the largest amplitude): "
            + ", ".join(f"{_share(part)} at {rate:.4g} rad/s^2" for rate, part in told)]  # fmt: skip


def _share(part) -> str:
    return f"{100 * part:.3g} %" if part < 2 else f"{part:.3g} times"


def _resolution(answer, rows) -> list[str]:
    told = [row for row in rows if row["up"]["speed"]]
    lost = [row for row in rows if not row["up"]["speed"]]
    said = []
    if told:
        words = ", ".join(
            f"{row['window']} turns ({row['resolution']:.2g} orders, {row['speed_in_window']:.3g} rad/s) "
            f"at {row['rate']:.4g}"
            for row in told
        )
        said.append(f"Hann windows of whole turns, {answer['samples_per_turn']} samples a turn evenly over the shaft's "
                    f"exact angle; resolution {words} rad/s^2")  # fmt: skip
    if lost:
        said.append("too fast for a window of whole turns: " + ", ".join(f"{row['rate']:.4g} rad/s^2" for row in lost))
    folded = [row for row in told if row["folding"] > 1e-4]
    if folded:
        worst = max(folded, key=lambda row: row["folding"])
        said.append(f"aliasing: {100 * worst['folding']:.2g} % of the power lies in the top tenth of the band at "
                    f"{worst['rate']:.4g} rad/s^2 and may be folded: raise samples_per_turn")  # fmt: skip
    return said


def _no_threshold(answer) -> str:
    if answer["threshold"] is None:
        return "no stability threshold: whirl dies out at every speed, however slowly it is passed"
    return f"the stability threshold {_speed(answer['threshold'])} is not on the way"


def _extremes(rows) -> list[str]:
    told = [
        f"{1e6 * row['relative_misalignment']:.4g} urad, {1e6 * row['h_min']:.4g} um at {row['rate']:.4g} rad/s^2"
        for row in rows
        if row["h_min"] is not None
    ]
    return [f"largest relative misalignment and thinnest film: {', '.join(told)}"] if told else []


# Up to this share of the tilt that touches, a seal is near its aligned film.
NEAR = 0.5


def _growth(answer, rows) -> list[str]:
    scale = answer["tilt_scale"]
    above = ", ".join(f"{row['time_above']:.3g} s at {row['rate']:.4g}" for row in rows)
    said = [
        f"above the threshold {_speed(answer['threshold'])} for {above} rad/s^2; a whirl of "
        f"{1e6 * answer['disturbance']:.3g} urad ({100 * answer['disturbance'] / scale:.2g} % of clearance/outer "
        "radius) is met at the crossing; the free whirl is the run with it less the same run without"
    ]
    if answer["forced_tilt"] > NEAR * answer["touch_tilt"]:
        tilt = f"{1e6 * answer['forced_tilt']:.4g} urad, {1e6 * answer['touch_tilt']:.4g} would close the unopened gap"
        return [*said, f"linear theory would force a tilt of {tilt}: no small whirl about an aligned film, and its "
                "linear growth rate tells nothing here"]  # fmt: skip
    for row in rows:
        found = row["growth"]
        if not found or found["error"] is None:
            continue
        what = "while small" if found["left_small"] else "at its largest"
        error = found["error_with_factor"]
        said.append(
            f"at {row['rate']:.4g} rad/s^2 it grows {math.exp(found['measured']):.4g}-fold {what} "
            f"(ln {found['measured']:.4g}); integral of the linear growth rate {found['integral']:.4g} "
            f"({100 * found['error']:+.2g} %), with the mode's change of shape {found['with_factor']:.4g} "
            f"({100 * error:+.2g} %)"
        )
    worst = max((abs(r["growth"]["error_with_factor"] or 0.0) for r in rows if r["growth"]), default=0.0)
    if worst > 0.01 and answer["forced_tilt"] > 0.02 * scale:
        said.append(f"linear growth is that of the aligned film; the seal carries a forced tilt of "
                    f"{100 * answer['forced_tilt'] / scale:.3g} % of clearance/outer radius, whose square changes "
                    "the growth rate of a nonlinear film")  # fmt: skip
    return said


def _touch(answer) -> list[str]:
    touch, foretold = answer["touch_rate"], answer["rate_foretold"]
    linear = f"linear theory {foretold:.4g} rad/s^2" if foretold else "linear theory: no such rate"
    if touch is None:
        return [f"rate that just touches not looked for; {linear}"]
    if touch["value"] is None:
        return [f"how fast one must pass to stay below touch: {touch['said']}; {linear}"]
    return [f"to stay below touch the threshold must be passed faster than {touch['value']:.4g} rad/s^2 "
            f"({touch['bracket'][0]:.5g} touches, {touch['bracket'][1]:.5g} does not); {linear}"]  # fmt: skip


# --- anything else ----------------------------------------------------------------------------------------


def load_sentences(answer) -> list[str]:
    """Verdict of ramps and steps of anything but the speed."""
    slow, key, unit = answer["quasi_static"], answer["key"], answer["unit"]
    slowest = answer["slowest"]
    fade = (f"disturbances of the linear seal fall to 1/e within {-1 / slowest:.3g} s" if slowest < 0
            else f"the linear seal is unstable there, its disturbances grow by {slowest:.3g} 1/s")  # fmt: skip
    said = [f"{key} from {answer['begin']:.5g} to {answer['end']:.5g} {unit} and back; {fade}"]
    ends = ["no gap balances the loads" if slow["h_min"][k] is None else
            f"{1e6 * slow['h_min'][k]:.4g} um, {1e6 * slow['relative_misalignment'][k]:.4g} urad, "
            f"{slow['leakage'][k] * 3.6e9:.5g} ml/h" for k in (0, -1)]  # fmt: skip
    said.append(f"infinitely slowly (thinnest film, misalignment, leakage): {ends[0]} at begin, {ends[1]} at end")
    if None in slow["h_min"][1:-1] and None not in (slow["h_min"][0], slow["h_min"][-1]):
        said.append("between them are values whose loads no gap balances")
    for row in answer["rows"]:
        name = "a step" if row["rate"] is None else f"{row['rate']:.4g} {answer['rate_unit']}"
        said.append(f"{name}: {row['failed'] if 'failed' in row else _loaded(row)}")
    return said


# Below this share of the change nothing is said to be beyond.
BEYOND = 0.005


def _loaded(row) -> str:
    over = row["overshoot"]

    def beyond(share):
        return "" if share is None or share < BEYOND else f" ({100 * share:.3g} % of its change beyond the slow answer)"

    film = "no film" if row["h_min"] is None else f"thinnest film {1e6 * row['h_min']:.4g} um{beyond(over['h_min'])}"
    tilt, more = 1e6 * row["relative_misalignment"], over["relative_misalignment"]
    words = f"{film}, largest misalignment {tilt:.4g} urad"
    words += f" ({100 * more:.3g} % above the slow answer)" if more is not None and more > BEYOND else ""
    low, high = row["leakage_least"] * 3.6e9, row["leakage"] * 3.6e9
    words += f", leakage {low:.5g} to {high:.5g} ml/h{beyond(over['leakage'])}"
    return words if row["status"] == Status.OK else f"{words}; {row['message']}"
