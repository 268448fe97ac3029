"""A run-up: one order over the speed, up and down; waterfall; growth of the whirl; how fast it must be passed."""

from itertools import cycle

import numpy as np

from ...answers import CYCLE, Axis, Level, Panel, Series
from ...archive import read_study
from ...quantities import everyday, in_words, quantity, reading_in
from ..panels import study_sheet
from ..text import written_units
from .page import save

# Of an extreme of a trip: the series it is of, its name, quantity, which extreme it is.
LOADS = {"h_min": ("film", "Thinnest film", "h_min", "smallest"),
         "relative_misalignment": ("tilt", "Relative tilt", "misalignment", "largest"),
         "leakage": ("flow", "Leakage", "leakage", "largest (full), smallest (open)")}  # fmt: skip
# A waterfall shows this many decades below its largest amplitude, and every order that has this share of it.
DECADES, STRONG = 3.5, 0.02
# Of the largest: tilts and films over the rate that differ by less are the same at every rate.
SAME = 0.01
# SI unit of what is ramped -> the quantities it and its rate are read as.
READ_AS = {"rad/s": ("speed", "speed_ramp"), "Pa": ("pressure", "pressure_ramp")}


def draw(path, out):
    """Panels of a speed ramp, or of a ramp of something else, from the study's archive."""
    study = read_study(path)
    answer = study["answer"]
    of_speed = answer["key"] == "shaft.speed"
    what = "its shaft speed" if of_speed else answer["key"]
    title = f"What does {study['name'].replace('_', ' ')} do when {what} ramps up and down?"
    speed = written_units(study)["rad/s"]
    written = {"rad/s": speed, "speed_ramp": quantity("speed_ramp").unit if speed == "rad/s" else "rpm/s"}
    with reading_in(written):
        panels, more = (_speed_ramps if of_speed else _load_ramps)(answer)
        # The sentences of the verdict that a reader needs first.
        story = " ".join(filter(None, [*answer["verdict"][:3], more]))
        return save(study_sheet(study, panels, title, story), out)


def _runs(answer):
    """(colour, row) of every run that was possible."""
    return list(zip(cycle(CYCLE), [row for row in answer["rows"] if "failed" not in row], strict=False))


# --- shaft speed ------------------------------------------------------------------------------------------


def _speed_ramps(answer):
    fall, said = answer["waterfall"], _same(answer)
    ways = [way for way in ("up", "down") if fall and len(fall[way]["speed"]) > 1]
    panels = [*_order(answer), *_waterfall(ways, answer)]
    below = [_growth(answer)] if _grown(answer) else []
    below += [] if said else [_curve(answer)]
    if ways and max(np.max(fall[way]["amplitude"]) for way in ways) > 0:
        row = next(row for row in answer["rows"] if row["rate"] == fall["rate"])
        said += f" Waterfall at {in_words('speed_ramp', fall['rate'])}: Hann windows of {fall['window']} turns, "
        said += f"{row['resolution']:.2g} orders and {in_words('speed', row['speed_in_window'], 3)} wide."
    return [*panels, *below], said.strip()


def _grown(answer) -> list:
    """Runs whose whirl was followed past the threshold."""
    return [(colour, row) for colour, row in _runs(answer) if row.get("growth")]


def _same(answer) -> str:
    """That the rate does not matter, where largest tilt and thinnest film are the same at every one; else ""."""
    curve = answer["curve"]
    film, tilt = (np.array(curve[name], dtype=float) for name in ("h_min", "relative_misalignment"))
    flat = all(len(values) and np.ptp(values) <= SAME * np.abs(values).max() for values in (film, tilt))
    if not flat or np.any(curve["touched"]):
        return ""
    most, least = in_words("misalignment", float(tilt.max())), in_words("h_min", float(film.min()))
    same = in_words("share", SAME)
    return f"At every rate the largest relative tilt is {most} and the thinnest film {least}, within {same}."


def _order(answer) -> list[Panel]:
    """Amplitude and phase of the order followed, up full, down dashed, linear theory grey."""
    linear = answer["linear"]
    seen = [max(row[w]["amplitude"]) for _, row in _runs(answer) for w in ("up", "down") if row[w]["speed"]]
    speed, driven = np.array(linear["speed"]), max(linear["amplitude"], default=0.0) > 0
    tops, phases, angle = [], [], _degrees(linear["phase"]) if driven else None
    if driven:
        steady = {"label": "linear, steady", "style": "black thick faint"}
        tops.append(Series("line", speed, linear["amplitude"], **steady))
        phases.append(Series("line", speed, angle, **steady))
    for colour, row in _runs(answer):
        for way, style in (("up", ""), ("down", " dashed")):
            if not row[way]["speed"]:
                continue
            at, label = np.array(row[way]["speed"]), in_words("speed_ramp", row["rate"]) if way == "up" else ""
            tops.append(Series("line", at, row[way]["amplitude"], label=label, style=f"{colour} thin{style}"))
            if driven:
                # Of a phase's many turns the one beside linear theory.
                own, near = _degrees(row[way]["phase"]), np.interp(at, speed, angle)
                own = own + 360 * np.rint(np.mean(near - own) / 360)
                phases.append(Series("line", at, own, style=f"{colour} thin{style}"))
    # A run that ends in contact would leave the panel to itself.
    highest = max(linear["amplitude"]) if driven else 0.0
    top = 1.15 * min(max([highest, *seen]), 2.5 * highest) if driven else None
    what = f"Relative {'tilt' if answer['tilting'] else 'gap'}, order {answer['order']:g}×: up full, down dashed"
    along = Axis("speed", low=answer["begin"], high=answer["end"])
    amplitude = Axis(_moving(answer), "amplitude", low=0.0 if driven else None, high=top)
    marks = [Level(_threshold(answer), "threshold", upright=True, style="contact dotted")] if _threshold(answer) else []
    top_panel = Panel(what, along, amplitude, tops, marks, wide=1.4)
    return [top_panel, *([Panel("", along, Axis("phase", "phase to the shaft"), phases, below=True)] if phases else [])]


def _moving(answer) -> str:
    return "misalignment" if answer["tilting"] else "m"


def _threshold(answer) -> float | None:
    """The threshold (rad/s) where it is passed."""
    at = answer["threshold"]
    return at if at is not None and answer["begin"] < at < answer["end"] else None


def _degrees(phase):
    return everyday("angle")[1] * np.unwrap(np.asarray(phase))


def _waterfall(ways, answer) -> list[Panel]:
    """Spectra in orders over the speed, on the way up and on the way down."""
    fall, panels = answer["waterfall"], []
    largest = max((np.max(fall[way]["amplitude"]) for way in ways), default=0.0)
    if not largest > 0:
        return [Panel("Waterfall", note="does not move")] if ways else []
    floor, (low, high) = largest * 10**-DECADES, _strong(fall, ways, largest)
    for way in ways:
        speed = fall[way]["speed"]
        seen = np.clip(np.array(fall[way]["amplitude"]), floor, None)
        series = [Series("map", fall[way]["orders"], speed, seen)]
        if answer["whirl"]:
            whirl, w = (np.array(answer["whirl"][name]) for name in ("frequency", "speed"))
            kept = (w > 0.35 * w[-1]) & (w >= min(speed)) & (w <= max(speed))
            series.append(Series("line", whirl[kept] / w[kept], w[kept], label="linear whirl", style="warn dashed"))
        levels = [Level(order, upright=True, style="pale dotted") for order in (0.5, 1.0)]
        levels += [Level(at, style="pale dotted") for at in [_threshold(answer)] if at]
        along, up = Axis("1", "order", low=low, high=high), Axis("speed", low=min(speed), high=max(speed))
        colour = Axis(_moving(answer), "amplitude", scale="log", low=floor, high=largest)
        panels.append(Panel(f"Waterfall, {way}", along, up, series, levels, colour=colour, wide=0.8))
    return panels


def _strong(fall, ways, largest) -> tuple[float, float]:
    """From which order to which a waterfall is shown: -1 to 2, and what is strong beyond."""
    orders = np.array(fall[ways[0]]["orders"])
    seen = np.max([np.max(fall[way]["amplitude"], axis=0) for way in ways], axis=0) > STRONG * largest
    return min(-1.0, *orders[seen]), max(2.0, *orders[seen])


def _growth(answer) -> Panel:
    """Logarithm of the free whirl since the threshold against what is foretold."""
    series, reach = [], 0.0
    for colour, row in _grown(answer):
        curve = row["growth"]["curve"]
        # Time times the rate: the speed gained, the same for every rate.
        gained, label = np.array(curve["time"]) * row["rate"], in_words("speed_ramp", row["rate"])
        series.append(Series("line", gained, curve["measured"], label=label, style=colour))
        series.append(Series("line", gained, curve["foretold"], label="foretold", style="black thin dashed front"))
        reach = max(reach, *curve["foretold"], *curve["measured"])
    touch = answer["touch_tilt"]
    heights = [(0.02 * answer["tilt_scale"], "2 % of clearance / outer radius"), *([(touch, "touch")] if touch else [])]
    heights = [(np.log(tilt / answer["disturbance"]), words) for tilt, words in heights]
    levels = [Level(at, words, style="grey dotted") for at, words in heights if at < 1.1 * reach]
    levels.append(Level(answer["end"] - answer["crossing"], "back down", upright=True, style="grey"))
    along = Axis("speed", "time since the threshold × rate", low=0.0)
    growth = Axis("1", "ln of growth", low=min(0.0, -0.03 * reach), high=1.12 * reach)
    return Panel("Free whirl since the threshold", along, growth, series, levels, first=True)


def _curve(answer) -> Panel:
    """Largest misalignment and thinnest film over the ramp rate."""
    curve, title = answer["curve"], "How fast must one pass?"
    rate, film, tilt = (np.array(curve[name], dtype=float) for name in ("rate", "h_min", "relative_misalignment"))
    if not len(rate):
        return Panel(title, note="no run ended", first=not _grown(answer))
    touched = np.array(curve["touched"], dtype=bool)
    series = [Series("line", rate, tilt, label="largest relative tilt", style="blue thin circle small")]
    if touched.any():
        series.append(Series("marks", rate[touched], tilt[touched], label="touches", style="contact cross front"))
    if answer["disturbance"] and answer["rate_foretold"]:
        fine = np.geomspace(rate.min(), rate.max(), 200)
        left = np.log(max(answer["touch_tilt"] - answer["forced_tilt"], 1e-30) / answer["disturbance"])
        whirl = answer["disturbance"] * np.exp(left * answer["rate_foretold"] / fine)
        foretold = np.minimum(answer["forced_tilt"] + whirl, answer["touch_tilt"])
        words = "foretold: forced + whirl, to touch"
        series.append(Series("line", fine, foretold, label=words, style="black thin dashed"))
    words = {"label": "thinnest film (right)", "style": "warn square small thin"}
    series.append(Series("line", rate, film, right=True, **words))
    touch = (answer["touch_rate"] or {}).get("value")
    levels = [Level(touch, "touches up to", upright=True, style="contact", number=True, legend=True)] if touch else []
    tilts = Axis("misalignment", "largest relative tilt", scale="log" if tilt.min() > 0 else "linear")
    right = Axis("h_min", low=min(0.0, 1.1 * film.min()), high=1.1 * max(film.max(), 0.0) or None)
    return Panel(title, Axis("speed_ramp", scale="log"), tilts, series, levels, right, first=not _grown(answer))


# --- anything else ----------------------------------------------------------------------------------------


def _load_ramps(answer):
    # An aligned seal has no tilt to show.
    moves = any(row.get("relative_misalignment") for _, row in _runs(answer)) or not _runs(answer)
    loads = {name: load for name, load in LOADS.items() if moves or name != "relative_misalignment"}
    panels = [_over_rate(answer, name, *load) for name, load in loads.items()]
    return panels + [_in_time(answer, *load, first=k == 0) for k, load in enumerate(loads.values())], ""


def _read_as(answer) -> tuple[str, str]:
    """The quantities that what is ramped and its rate are read as, or their units."""
    return READ_AS.get(answer["unit"], (answer["unit"], f"{answer['unit']}/s"))


def _over_rate(answer, name, series, title, held, what) -> Panel:
    """Extremes of each trip over its rate, the step at the right end, in front of the quasi-static range."""
    title = f"{title}: {what}"
    runs = [(colour, row) for colour, row in _runs(answer) if row.get(name) is not None]
    slow = [value for value in answer["quasi_static"][name] if value is not None]
    values = np.array([*slow, *(row[name] for _, row in runs)])
    if not runs:
        return Panel(title, note="no run ended")
    far = 10 * max((row["rate"] for _, row in runs if row["rate"]), default=1.0)
    marks = []
    for colour, row in runs:
        at = [row["rate"] or far]
        marks.append(Series("marks", at, [row[name]], style=f"{colour} circle"))
        if name == "leakage":
            marks.append(Series("marks", at, [row["leakage_least"]], style=f"{colour} circle open"))
    levels = [Level(min(slow), "range of the slow answer", to=max(slow), legend=True)] if slow else []
    # What is never below zero has room for a mark below it.
    low, high = values.min(), values.max()
    room = 0.25 * max(high - low, 0.4 * abs(values).max()) or None
    ends = {"low": max(low - room, -0.04 * high if low >= 0 else -np.inf), "high": high + room} if room else {}
    along = Axis(_read_as(answer)[1], "ramp rate (far right: a step)", scale="log")
    return Panel(title, along, Axis(held, " ", **ends), marks, levels)


def _in_time(answer, series, title, held, _, first: bool) -> Panel:
    """The way there, from where it begins; time logarithmic, since the rates differ by tens."""
    begun, lines, last = 0.03 * answer["decay"], [], 0.03 * answer["decay"]
    load, rate = _read_as(answer)
    for colour, row in _runs(answer):
        begin, _, back, _ = row["stages"]
        time, values = np.array(row["time"]) - begin, np.array(row[series])
        # Just before the way back, which a step begins with a jump.
        kept = (time >= begun) & (time < (back - begin) * (1 - 1e-12))
        name = "a step" if row["rate"] is None else in_words(rate, row["rate"], 3)
        lines.append(Series("line", time[kept], values[kept], label=name, style=f"{colour} thin"))
        last = max(last, back - begin)
    if last == begun:
        return Panel(f"{title} on the way", note="no run ended", first=first)
    along = Axis("s", "time since the change began", scale="log", low=begun, high=last)
    title = f"{title} on the way to {in_words(load, answer['end'])}"
    return Panel(title, along, Axis(held, " "), lines, first=first)
