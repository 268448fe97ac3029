"""A run-up: one order over the speed, up and down; waterfall; growth of the whirl; how fast it must be passed."""

import numpy as np

from ...archive import read_study
from ..text import speed_unit
from .page import absent, legend, level, look, number, right_axis, save, stacked, study_page, upright, written
from .palette import BLACK, BLUE, CONTACT, CYCLE, GREY, ORANGE, THICKNESS
from .record import done, fitting

# Of an extreme of a trip: the series it is of, its name, unit, how many of it make one SI unit, which extreme it is.
LOADS = {"h_min": ("film", "Thinnest film", "µm", 1e6, "smallest"),
         "relative_misalignment": ("tilt", "Relative tilt", "µrad", 1e6, "largest"),
         "leakage": ("flow", "Leakage", "l/h", 3.6e6, "largest (full), smallest (open)")}  # fmt: skip
# What leakage is read in, and how many of it make one m^3/s: the first that makes a tenth and more of it.
FLOWS = (("l/h", 3.6e6), ("ml/h", 3.6e9), ("µl/h", 3.6e12))
# A waterfall shows this many decades below its largest amplitude, and every order that has this share of it.
DECADES, STRONG = 3.5, 0.02
# Of the largest: tilts and films over the rate that differ by less are the same at every rate.
SAME = 0.01
# Of its value: a film or another series of a ramp that changes by less is drawn as a flat line.
FLAT = 1e-3
# What pressures are read in.
READ = {"Pa": ("bar", 1e-5)}


@look()
def draw(path, out):
    """Panels of a speed ramp, or of a ramp of something else, from the study's archive."""
    study = read_study(path)
    answer = study["answer"]
    ramps, what = (_speed_ramps, "its shaft speed") if answer["key"] == "shaft.speed" else (_load_ramps, answer["key"])
    title = f"What does {study['name'].replace('_', ' ')} do when {what} ramps up and down?"
    figure = ramps(study, answer, title, " ".join(_story(answer)))
    return save(figure, out)


def _story(answer) -> list[str]:
    """The sentences of the verdict that a reader needs first."""
    return [words.replace("s^2", "s²") for words in answer["verdict"][:3]]


def _runs(answer):
    """(colour, row) of every run that was possible."""
    return [(CYCLE[k % len(CYCLE)], row) for k, row in enumerate(done(answer["rows"]))]


# --- shaft speed ------------------------------------------------------------------------------------------


def _speed_ramps(study, answer, title, story):
    fall, speeds = answer["waterfall"], speed_unit(study)
    ways = [way for way in ("up", "down") if fall and len(fall[way]["speed"]) > 1]
    if same := _same(answer):
        story += f" {same}"
    order = [["amplitude"], ["phase"]]
    below = [name for name, there in (("growth", _grown(answer)), ("curve", not same)) if there]
    mosaic = [[order, [ways]]] if ways else [[order]]
    layout = {}
    if below:
        mosaic, layout = [[mosaic], [[below]]], {"height_ratios": (3, 2)}
    figure, ax = study_page(study, 12.5, 8.6 if below else 5.8, mosaic, title, story, **layout)
    stacked(ax["amplitude"], ax["phase"])
    _order(ax["amplitude"], ax["phase"], answer, *speeds)
    if ways:
        _waterfall([ax[way] for way in ways], ways, answer, *speeds)
    if "growth" in ax:
        _growth(ax["growth"], answer, *speeds)
    if "curve" in ax:
        _curve(ax["curve"], answer, *speeds)
    return figure


def _rate(value: float, speeds: str) -> str:
    """A ramp rate in words."""
    return f"{number(float(f'{value:.4g}'))} {speeds}/s".replace("s/s", "s²")


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
    unit, finer = fitting("µrad", 1e6 * tilt.max())
    return (f"At every rate the largest relative tilt is {1e6 * finer * tilt.max():.4g} {unit} and the thinnest film "
            f"{1e6 * film.min():.4g} µm, within {100 * SAME:g}\u00a0%.")  # fmt: skip


def _order(top, below, answer, speeds, per):
    """Amplitude and phase of the order followed, up full, down dashed, linear theory black."""
    linear, unit = answer["linear"], "µrad" if answer["tilting"] else "µm"
    seen = [max(row[w]["amplitude"]) for _, row in _runs(answer) for w in ("up", "down") if row[w]["speed"]]
    unit, finer = fitting(unit, 1e6 * max([*seen, *linear["amplitude"]], default=0.0))
    micro = 1e6 * finer
    speed = per * np.array(linear["speed"])
    driven = max(linear["amplitude"], default=0.0) > 0
    steady = {"color": BLACK, "lw": 2.6, "alpha": 0.35, "label": "linear, steady"}
    if driven:
        angle = _degrees(linear["phase"])
        top.plot(speed, micro * np.array(linear["amplitude"]), **steady)
        below.plot(speed, angle, **steady)
    for colour, row in _runs(answer):
        for way, style in (("up", "-"), ("down", (0, (4, 2)))):
            if not row[way]["speed"]:
                continue
            label = _rate(per * row["rate"], speeds) if way == "up" else None
            at = per * np.array(row[way]["speed"])
            top.plot(at, micro * np.array(row[way]["amplitude"]), color=colour, ls=style, label=label)
            if driven:
                # Of a phase's many turns the one beside linear theory.
                own, near = _degrees(row[way]["phase"]), np.interp(at, speed, angle)
                below.plot(at, own + 360 * np.rint(np.mean(near - own) / 360), color=colour, ls=style)
    if driven:
        highest = max(linear["amplitude"])
        # A run that ends in contact would leave the panel to itself.
        top.set_ylim(0, 1.15 * micro * min(max([highest, *seen]), 2.5 * highest))
    what = f"Relative {'tilt' if answer['tilting'] else 'gap'}, order {answer['order']:g}×"
    top.set(ylabel=f"amplitude, {unit}", title=f"{what}: up full, down dashed")
    ends = per * answer["begin"], per * answer["end"]
    below.set(ylabel="phase to the shaft, °", xlabel=f"shaft speed, {speeds}", xlim=ends)
    at = answer["threshold"]
    if at is not None and answer["begin"] < at < answer["end"]:
        upright(top, per * at, "threshold", CONTACT, height=1.02, ha="center", ls=":")
        upright(below, per * at, "", CONTACT, ls=":")
    legend(top, "best", fontsize=7.5, ncols=2)


def _degrees(phase):
    return np.degrees(np.unwrap(np.asarray(phase)))


def _waterfall(panels, ways, answer, speeds, per):
    """Spectra in orders over the speed, on the way up and on the way down."""
    fall = answer["waterfall"]
    largest = max((np.max(fall[way]["amplitude"]) for way in ways), default=0.0)
    if largest <= 0:
        for ax in panels:
            absent(ax, "Waterfall", "does not move")
        return
    floor = largest * 10**-DECADES
    for ax, way in zip(panels, ways, strict=True):
        orders, speed = np.array(fall[way]["orders"]), per * np.array(fall[way]["speed"])
        power = np.log10(np.maximum(np.array(fall[way]["amplitude"]), floor))
        image = ax.pcolormesh(orders, speed, power, cmap=THICKNESS, shading="nearest", rasterized=True,
                              vmin=np.log10(floor), vmax=np.log10(largest))  # fmt: skip
        ax.grid(False)
        for order in (0.5, 1.0):
            ax.axvline(order, color="white", lw=0.7, ls=(0, (2, 3)))
        if answer["whirl"]:
            whirl, w = (per * np.array(answer["whirl"][name]) for name in ("frequency", "speed"))
            shown = w > 0.35 * w[-1]
            ax.plot(whirl[shown] / w[shown], w[shown], color=ORANGE, lw=1.2, ls="--")
        if answer["threshold"] and speed.min() < per * answer["threshold"] < speed.max():
            ax.axhline(per * answer["threshold"], color="white", lw=0.8, ls=":")
        ax.set_xticks([-1, -0.5, 0, 0.5, 1, 1.5, 2], ["−1", "−½", "0", "½", "1", "1½", "2"])
        ax.set(title=way, xlim=_strong(fall, ways, largest), ylim=(speed.min(), speed.max()), xlabel="order\n")
        ax.tick_params(labelleft=ax is panels[0])
    panels[0].set(title=f"Waterfall, {ways[0]}", ylabel=f"shaft speed, {speeds}")
    bar = panels[0].figure.colorbar(image, ax=panels, fraction=0.03, pad=0.02)
    bar.set_label(f"log₁₀ of amplitude in {'rad' if answer['tilting'] else 'm'}", fontsize=7.5)
    row = next(row for row in answer["rows"] if row["rate"] == fall["rate"])
    rate = _rate(per * fall["rate"], speeds)
    words = (f"{rate}; Hann windows of {fall['window']} turns: {row['resolution']:.2g} orders, "
             f"{written(per * row['speed_in_window'], 3)} {speeds}")  # fmt: skip
    words += "; dashed orange: linear whirl" if answer["whirl"] else ""
    # Wider than its panel, it has the second line of the label below.
    panels[0].annotate(words, (0, 0), (0, -34), "axes fraction", "offset points", fontsize=7.5, color=GREY, va="top",
                       in_layout=False)  # fmt: skip


def _strong(fall, ways, largest) -> tuple[float, float]:
    """From which order to which a waterfall is shown: -1 to 2, and what is strong beyond."""
    orders = np.array(fall[ways[0]]["orders"])
    seen = np.max([np.max(fall[way]["amplitude"], axis=0) for way in ways], axis=0) > STRONG * largest
    return min(-1.0, *orders[seen]), max(2.0, *orders[seen])


def _growth(ax, answer, speeds, per):
    """Logarithm of the free whirl since the threshold against what is foretold."""
    runs, title = _grown(answer), "Free whirl since the threshold: measured, and foretold (black)"
    for colour, row in runs:
        curve = row["growth"]["curve"]
        # Time times the rate: the speed gained, the same for every rate.
        gained = per * np.array(curve["time"]) * row["rate"]
        label = _rate(per * row["rate"], speeds)
        ax.plot(gained, curve["measured"], color=colour, lw=2.0, label=label)
        ax.plot(gained, curve["foretold"], color=BLACK, lw=0.9, ls=(0, (3, 2)))
    top = per * (answer["end"] - answer["crossing"])
    small = np.log(0.02 * answer["tilt_scale"] / answer["disturbance"])
    touch = np.log(answer["touch_tilt"] / answer["disturbance"]) if answer["touch_tilt"] else None
    reach = max(max(max(r["growth"]["curve"]["foretold"]), *r["growth"]["curve"]["measured"]) for _, r in runs)
    for height, words in ((small, "2 % of clearance / outer radius"), (touch, "touch")):
        if height is not None and height < 1.1 * reach:
            level(ax, height, words, side="left", ls=":")
    upright(ax, top, "back down", lw=0.8)
    ax.set(title=title, xlabel=f"time since the threshold × rate, {speeds}", ylabel="ln of growth", xlim=(0, None),
           ylim=(min(0.0, -0.03 * reach), 1.12 * reach))  # fmt: skip
    legend(ax, "best", fontsize=7.5, frameon=True, framealpha=0.8, edgecolor="none")


def _curve(ax, answer, speeds, per):
    """Largest misalignment and thinnest film over the ramp rate."""
    curve, title = answer["curve"], "How fast must one pass?"
    rate = per * np.array(curve["rate"], dtype=float)
    if not len(rate):
        return absent(ax, title, "no run ended")
    film, tilt = (1e6 * np.array(curve[name], dtype=float) for name in ("h_min", "relative_misalignment"))
    unit, finer = fitting("µrad", np.nanmax(tilt))
    tilt, micro, rates = finer * tilt, 1e6 * finer, f"{speeds}/s".replace("s/s", "s²")
    touched = np.array(curve["touched"], dtype=bool)
    ax.set(xscale="log", yscale="log" if tilt.min() > 0 else "linear")
    # Where all touch the line has the name.
    names = ("largest relative tilt", "_") if touched.all() else ("_", "largest relative tilt")
    ax.plot(rate, tilt, color=BLUE, lw=1.2, label=names[0])
    ax.plot(rate[~touched], tilt[~touched], "o", color=BLUE, ms=4.5, label=names[1])
    if touched.any():
        ax.plot(rate[touched], tilt[touched], "X", color=CONTACT, ms=6.5, label="touches")
    ax.yaxis.set_minor_formatter(lambda value, _: "")
    ax.yaxis.set_major_formatter(lambda value, _: number(value))
    if answer["disturbance"] and answer["rate_foretold"]:
        fine = np.geomspace(rate.min(), rate.max(), 200)
        left = np.log(max(answer["touch_tilt"] - answer["forced_tilt"], 1e-30) / answer["disturbance"])
        whirl = answer["disturbance"] * np.exp(left * per * answer["rate_foretold"] / fine)
        said = micro * np.minimum(answer["forced_tilt"] + whirl, answer["touch_tilt"])
        ax.plot(fine, said, color=BLACK, lw=0.9, ls=(0, (3, 2)), label="foretold: forced + whirl, to touch")
    touch = (answer["touch_rate"] or {}).get("value")
    if touch:
        upright(ax, per * touch, _rate(per * touch, speeds), CONTACT)
    low, high = np.nanmin(tilt), np.nanmax(tilt)
    ax.set(title=title, xlabel=f"ramp rate, {rates}", ylabel=f"largest relative tilt, {unit}")
    ax.set_ylim(0.6 * low, 3.0 * high if high > 0 else 1.0)
    other = right_axis(ax, "thinnest film, µm", ORANGE)
    other.plot(rate, film, color=ORANGE, marker="s", ms=3.5, lw=1.0, label="thinnest film (right)")
    thin, thick = min(0.0, np.nanmin(film)), max(np.nanmax(film), 0.0)
    other.set_ylim(thin - 0.1 * (thick - thin) * (thin < 0), thick + 0.5 * max(thick - thin, 1e-3))
    handles = [h for a in (ax, other) for h in a.get_legend_handles_labels()[0]]
    ax.legend(handles=handles, loc="upper right", fontsize=7.5, ncols=2)


# --- anything else ----------------------------------------------------------------------------------------


def _load_ramps(study, answer, title, story):
    # An aligned seal has no tilt to show.
    moves = any(row.get("relative_misalignment") for _, row in _runs(answer)) or not _runs(answer)
    loads = {name: load for name, load in _loads(answer).items() if moves or name != "relative_misalignment"}
    mosaic = [[f"{name} over rate" for name in loads], [f"{name} in time" for name in loads]]
    figure, ax = study_page(study, 12.5, 8.6, mosaic, title, story, height_ratios=(6, 5))
    for name, load in loads.items():
        _over_rate(ax[f"{name} over rate"], answer, name, *load)
        _in_time(ax[f"{name} in time"], answer, *load)
    legend(ax["h_min in time"], "best", fontsize=7.5)
    return figure


def _loads(answer) -> dict:
    """LOADS, tilt and leakage in units of their size."""
    tilts = [row["relative_misalignment"] for _, row in _runs(answer) if row.get("relative_misalignment")]
    series, title, unit, micro, what = LOADS["relative_misalignment"]
    unit, finer = fitting(unit, micro * max(tilts, default=0.0))
    tilt = series, title, unit, micro * finer, what
    flows = [row["leakage"] for _, row in _runs(answer) if row.get("leakage")]
    most = max((abs(flow) for flow in flows), default=0.0)
    unit, factor = next((flow for flow in FLOWS if flow[1] * most >= 0.1), FLOWS[-1] if most else FLOWS[0])
    series, title, _, _, what = LOADS["leakage"]
    return {**LOADS, "relative_misalignment": tilt, "leakage": (series, title, unit, factor, what)}


def _read(answer) -> tuple[str, float]:
    """What the ramped quantity is read in, and how many of it make one SI unit."""
    return READ.get(answer["unit"], (answer["unit"], 1.0))


def _over_rate(ax, answer, name, series, title, unit, factor, what):
    """Extremes of each trip over its rate, the step at the right end, in front of the quasi-static range."""
    runs = [(colour, row) for colour, row in _runs(answer) if row.get(name) is not None]
    slow = factor * np.array([value for value in answer["quasi_static"][name] if value is not None])
    values = np.array([*slow, *(factor * row[name] for _, row in runs)])
    if not len(values):
        return absent(ax, f"{title}, {unit}", "no run ended")
    if len(slow):
        ax.axhspan(slow.min(), slow.max(), color=GREY, alpha=0.2, lw=0, label="range of the slow answer")
    _, per = _read(answer)
    far = 10 * max((per * row["rate"] for _, row in runs if row["rate"]), default=1.0)
    for colour, row in runs:
        at = per * row["rate"] if row["rate"] else far
        ax.plot(at, factor * row[name], "o", color=colour, ms=7)
        if name == "leakage":
            ax.plot(at, factor * row["leakage_least"], "o", mfc="white", color=colour, ms=7)
    ax.set(xscale="log", title=f"{title}, {unit}: {what}",
           xlabel=f"ramp rate, {_read(answer)[0]}/s (at the far right: a step)")  # fmt: skip
    largest = abs(values).max()
    room = (0.25 * np.ptp(values) if np.ptp(values) > FLAT * largest else 0.1 * largest) or 1.0
    # What is never below zero has room for a mark below it.
    ax.set_ylim(max(values.min() - room, -0.04 * values.max() if values.min() >= 0 else -np.inf), values.max() + room)
    legend(ax, "best", fontsize=7.5)


def _in_time(ax, answer, series, title, unit, factor, _):
    """The way there, from where it begins; time logarithmic, since the rates differ by tens."""
    first, (read, per) = 0.03 * answer["decay"], _read(answer)
    last, seen = first, []
    for colour, row in _runs(answer):
        begin, _, back, _ = row["stages"]
        time, values = np.array(row["time"]) - begin, factor * np.array(row[series])
        # Just before the way back, which a step begins with a jump.
        kept = (time >= first) & (time < (back - begin) * (1 - 1e-12))
        name = "a step" if row["rate"] is None else f"{written(per * row['rate'], 3)} {read}/s"
        ax.plot(time[kept], values[kept], color=colour, lw=1.2, label=name)
        last, seen = max(last, back - begin), [*seen, *values[kept]]
    if last == first:
        return absent(ax, f"{title} on the way", "no run ended")
    if seen and np.ptp(seen) <= FLAT * np.abs(seen).max():
        ax.set_ylim(np.mean(seen) + np.array([-0.1, 0.1]) * (np.abs(seen).max() or 1.0))
    ax.set(xscale="log", xlim=(first, last), title=f"{title} on the way to {per * answer['end']:.4g} {read}",
           xlabel="time since the change began, s", ylabel=unit)  # fmt: skip
