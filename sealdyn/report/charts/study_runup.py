"""A run-up: one order over the speed, up and down; waterfall; growth of the whirl; how fast it must be passed."""

import numpy as np

from ...archive import read_study
from .page import absent, legend, level, look, right_axis, save, stacked, study_page, upright
from .palette import BLACK, BLUE, CONTACT, CYCLE, GREY, ORANGE, THICKNESS
from .record import done

# Of an extreme of a trip: the series it is of, its name, unit, how many of it make one SI unit, which extreme it is.
LOADS = {"h_min": ("film", "Thinnest film", "µm", 1e6, "smallest"),
         "relative_misalignment": ("tilt", "Relative tilt", "µrad", 1e6, "largest"),
         "leakage": ("flow", "Leakage", "l/h", 3.6e6, "largest (full), smallest (open)")}  # fmt: skip
# A waterfall shows this many decades below its largest amplitude.
DECADES = 3.5


@look()
def draw(path, out):
    """Four panels of a speed ramp, or of a ramp of something else, from the study's archive."""
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
    fall = answer["waterfall"]
    ways = [way for way in ("up", "down") if fall and len(fall[way]["speed"]) > 1]
    mosaic = [[[["amplitude"], ["phase"]], [ways or ["none"]]], ["growth", "curve"]]
    figure, ax = study_page(study, 12.5, 8.6, mosaic, title, story, height_ratios=(3, 2))
    stacked(ax["amplitude"], ax["phase"])
    _order(ax["amplitude"], ax["phase"], answer)
    _waterfall([ax[way] for way in ways or ["none"]], ways, answer)
    _growth(ax["growth"], answer)
    _curve(ax["curve"], answer)
    return figure


def _order(top, below, answer):
    """Amplitude and phase of the order followed, up full, down dashed, linear theory black."""
    linear, unit = answer["linear"], "µrad" if answer["tilting"] else "µm"
    speed = np.array(linear["speed"])
    driven = max(linear["amplitude"], default=0.0) > 0
    steady = {"color": BLACK, "lw": 2.6, "alpha": 0.35, "label": "linear, steady"}
    if driven:
        angle = _degrees(linear["phase"])
        top.plot(speed, 1e6 * np.array(linear["amplitude"]), **steady)
        below.plot(speed, angle, **steady)
    for colour, row in _runs(answer):
        for way, style in (("up", "-"), ("down", (0, (4, 2)))):
            if not row[way]["speed"]:
                continue
            label = f"{row['rate']:.4g} rad/s²" if way == "up" else None
            top.plot(row[way]["speed"], 1e6 * np.array(row[way]["amplitude"]), color=colour, ls=style, label=label)
            if driven:
                # Of a phase's many turns the one beside linear theory.
                own, near = _degrees(row[way]["phase"]), np.interp(row[way]["speed"], speed, angle)
                below.plot(row[way]["speed"], own + 360 * np.rint(np.mean(near - own) / 360), color=colour, ls=style)
    if driven:
        highest = 1e6 * max(linear["amplitude"])
        seen = [1e6 * max(row[w]["amplitude"]) for _, row in _runs(answer) for w in ("up", "down") if row[w]["speed"]]
        # A run that ends in contact would leave the panel to itself.
        top.set_ylim(0, 1.15 * min(max([highest, *seen]), 2.5 * highest))
    what = f"Relative {'tilt' if answer['tilting'] else 'gap'}, order {answer['order']:g}×"
    top.set(ylabel=f"amplitude, {unit}", title=f"{what}: up full, down dashed")
    below.set(ylabel="phase to the shaft, °", xlabel="shaft speed, rad/s", xlim=(answer["begin"], answer["end"]))
    at = answer["threshold"]
    if at is not None and answer["begin"] < at < answer["end"]:
        upright(top, at, "threshold", CONTACT, height=1.02, ha="center", ls=":")
        upright(below, at, "", CONTACT, ls=":")
    legend(top, "lower right", fontsize=7.5, ncols=2)


def _degrees(phase):
    return np.degrees(np.unwrap(np.asarray(phase)))


def _waterfall(panels, ways, answer):
    """Spectra in orders over the speed, on the way up and on the way down."""
    fall = answer["waterfall"]
    largest = max((np.max(fall[way]["amplitude"]) for way in ways), default=0.0)
    if largest <= 0:
        for ax in panels:
            absent(ax, "Waterfall", "does not move" if ways else "no window of whole turns fits on the ramp")
        return
    floor = largest * 10**-DECADES
    for ax, way in zip(panels, ways, strict=True):
        orders, speed = np.array(fall[way]["orders"]), np.array(fall[way]["speed"])
        power = np.log10(np.maximum(np.array(fall[way]["amplitude"]), floor))
        image = ax.pcolormesh(orders, speed, power, cmap=THICKNESS, shading="nearest", rasterized=True,
                              vmin=np.log10(floor), vmax=np.log10(largest))  # fmt: skip
        ax.grid(False)
        for order in (0.5, 1.0):
            ax.axvline(order, color="white", lw=0.7, ls=(0, (2, 3)))
        if answer["whirl"]:
            whirl, w = np.array(answer["whirl"]["frequency"]), np.array(answer["whirl"]["speed"])
            shown = w > 0.35 * w[-1]
            ax.plot(whirl[shown] / w[shown], w[shown], color=ORANGE, lw=1.2, ls="--")
        if answer["threshold"] and speed.min() < answer["threshold"] < speed.max():
            ax.axhline(answer["threshold"], color="white", lw=0.8, ls=":")
        ax.set(title=way, xlim=(-1.0, 2.0), ylim=(answer["begin"], answer["end"]), xlabel="order\n")
        ax.set_xticks([-0.5, 0, 0.5, 1, 1.5], ["−½", "0", "½", "1", "1½"])
        ax.tick_params(labelleft=ax is panels[0])
    panels[0].set(title=f"Waterfall, {ways[0]}", ylabel="shaft speed, rad/s")
    bar = panels[0].figure.colorbar(image, ax=panels, fraction=0.03, pad=0.02)
    bar.set_label(f"log₁₀ of amplitude in {'rad' if answer['tilting'] else 'm'}", fontsize=7.5)
    row = next(row for row in answer["rows"] if row["rate"] == fall["rate"])
    words = (f"{fall['rate']:.4g} rad/s²; Hann windows of {fall['window']} turns: {row['resolution']:.2g} orders, "
             f"{row['speed_in_window']:.3g} rad/s")  # fmt: skip
    words += "; dashed orange: linear whirl" if answer["whirl"] else ""
    # Wider than its panel, it has the second line of the label below.
    panels[0].annotate(words, (0, 0), (0, -34), "axes fraction", "offset points", fontsize=7.5, color=GREY, va="top",
                       in_layout=False)  # fmt: skip


def _growth(ax, answer):
    """Logarithm of the free whirl since the threshold against what is foretold."""
    runs = [(colour, row) for colour, row in _runs(answer) if row.get("growth")]
    title = "Free whirl since the threshold: measured, and foretold (black)"
    if not runs:
        return absent(ax, title, "no threshold on the way")
    for colour, row in runs:
        curve = row["growth"]["curve"]
        # Time times the rate: the speed gained, the same for every rate.
        gained = np.array(curve["time"]) * row["rate"]
        ax.plot(gained, curve["measured"], color=colour, lw=2.0, label=f"{row['rate']:.4g} rad/s²")
        ax.plot(gained, curve["foretold"], color=BLACK, lw=0.9, ls=(0, (3, 2)))
    top = answer["end"] - answer["crossing"]
    small = np.log(0.02 * answer["tilt_scale"] / answer["disturbance"])
    touch = np.log(answer["touch_tilt"] / answer["disturbance"]) if answer["touch_tilt"] else None
    reach = max(max(max(r["growth"]["curve"]["foretold"]), *r["growth"]["curve"]["measured"]) for _, r in runs)
    for height, words in ((small, "2 % of clearance / outer radius"), (touch, "touch")):
        if height is not None and height < 1.1 * reach:
            level(ax, height, words, side="left", ls=":")
    upright(ax, top, "back down", lw=0.8)
    ax.set(title=title, xlabel="time since the threshold × rate, rad/s", ylabel="ln of growth", xlim=(0, None),
           ylim=(min(0.0, -0.03 * reach), 1.12 * reach))  # fmt: skip
    ax.legend(loc="upper left", fontsize=7.5, bbox_to_anchor=(0.0, 0.82), frameon=True, framealpha=0.8,
              edgecolor="none")  # fmt: skip


def _curve(ax, answer):
    """Largest misalignment and thinnest film over the ramp rate."""
    curve, title = answer["curve"], "How fast must one pass?"
    rate = np.array(curve["rate"], dtype=float)
    if not len(rate):
        return absent(ax, title, "no run ended")
    film, tilt = (1e6 * np.array(curve[name], dtype=float) for name in ("h_min", "relative_misalignment"))
    touched = np.array(curve["touched"], dtype=bool)
    ax.set(xscale="log", yscale="log" if tilt.min() > 0 else "linear")
    ax.plot(rate, tilt, color=BLUE, lw=1.2)
    ax.plot(rate[~touched], tilt[~touched], "o", color=BLUE, ms=4.5, label="largest relative tilt")
    ax.plot(rate[touched], tilt[touched], "X", color=CONTACT, ms=6.5, label="touches")
    if answer["disturbance"] and answer["rate_foretold"]:
        fine = np.geomspace(rate.min(), rate.max(), 200)
        left = np.log(max(answer["touch_tilt"] - answer["forced_tilt"], 1e-30) / answer["disturbance"])
        whirl = answer["disturbance"] * np.exp(left * answer["rate_foretold"] / fine)
        said = 1e6 * np.minimum(answer["forced_tilt"] + whirl, answer["touch_tilt"])
        ax.plot(fine, said, color=BLACK, lw=0.9, ls=(0, (3, 2)), label="foretold: forced + whirl, to touch")
    touch = (answer["touch_rate"] or {}).get("value")
    if touch:
        upright(ax, touch, f"{touch:.4g} rad/s²", CONTACT)
    low, high = np.nanmin(tilt), np.nanmax(tilt)
    ax.set(title=title, xlabel="ramp rate, rad/s²", ylabel="largest relative tilt, µrad")
    ax.set_ylim(0.6 * low, 3.0 * high if high > 0 else 1.0)
    other = right_axis(ax, "thinnest film, µm", ORANGE)
    other.plot(rate, film, color=ORANGE, marker="s", ms=3.5, lw=1.0, label="thinnest film (right)")
    thin, thick = min(0.0, np.nanmin(film)), max(np.nanmax(film), 0.0)
    other.set_ylim(thin - 0.1 * (thick - thin) * (thin < 0), thick + 0.5 * max(thick - thin, 1e-3))
    handles = [h for a in (ax, other) for h in a.get_legend_handles_labels()[0]]
    ax.legend(handles=handles, loc="upper right", fontsize=7.5, ncols=2)


# --- anything else ----------------------------------------------------------------------------------------


def _load_ramps(study, answer, title, story):
    mosaic = [[f"{name} over rate" for name in LOADS], [f"{name} in time" for name in LOADS]]
    figure, ax = study_page(study, 12.5, 8.6, mosaic, title, story, height_ratios=(6, 5))
    for name, load in LOADS.items():
        _over_rate(ax[f"{name} over rate"], answer, name, *load)
        _in_time(ax[f"{name} in time"], answer, *load)
    legend(ax["h_min in time"], "best", fontsize=7.5)
    return figure


def _over_rate(ax, answer, name, series, title, unit, factor, what):
    """Extremes of each trip over its rate, the step at the right end, in front of the quasi-static range."""
    runs = [(colour, row) for colour, row in _runs(answer) if row.get(name) is not None]
    slow = factor * np.array([value for value in answer["quasi_static"][name] if value is not None])
    values = np.array([*slow, *(factor * row[name] for _, row in runs)])
    if not len(values):
        return absent(ax, f"{title}, {unit}", "no run ended")
    if len(slow):
        ax.axhspan(slow.min(), slow.max(), color=GREY, alpha=0.2, lw=0, label="range of the slow answer")
    far = 10 * max((row["rate"] for _, row in runs if row["rate"]), default=1.0)
    for colour, row in runs:
        at = row["rate"] or far
        ax.plot(at, factor * row[name], "o", color=colour, ms=7)
        if name == "leakage":
            ax.plot(at, factor * row["leakage_least"], "o", mfc="white", color=colour, ms=7)
    ax.set(xscale="log", title=f"{title}, {unit}: {what}",
           xlabel=f"ramp rate, {answer['rate_unit']} (at the far right: a step)")  # fmt: skip
    room = 0.25 * max(np.ptp(values), 1e-3 * abs(values).max()) or 1.0
    ax.set_ylim(values.min() - room, values.max() + room)
    legend(ax, "best", fontsize=7.5)


def _in_time(ax, answer, series, title, unit, factor, _):
    """The way there, from where it begins; time logarithmic, since the rates differ by tens."""
    first = 0.03 * answer["decay"]
    last = first
    for colour, row in _runs(answer):
        begin, _, back, _ = row["stages"]
        time, values = np.array(row["time"]) - begin, factor * np.array(row[series])
        kept = (time >= first) & (time <= back - begin)
        name = "a step" if row["rate"] is None else f"{row['rate']:.3g} {answer['rate_unit']}"
        ax.plot(time[kept], values[kept], color=colour, lw=1.2, label=name)
        last = max(last, back - begin)
    if last == first:
        return absent(ax, f"{title} on the way", "no run ended")
    ax.set(xscale="log", xlim=(first, last), title=f"{title} on the way to {answer['end']:.4g} {answer['unit']}",
           xlabel="time since the change began, s", ylabel=unit)  # fmt: skip
