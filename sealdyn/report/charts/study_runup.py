"""A run-up: one order over the speed, up and down; waterfall; growth of the whirl; how fast it must be passed."""

import textwrap

import numpy as np

from ...archive import read_study
from .page import absent, look, save, sheet, shortened
from .palette import BLACK, BLUE, CONTACT, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
RPM = 30 / np.pi
# A waterfall shows this many decades below its largest amplitude.
DECADES = 3.5


def draw(path, out):
    """Four panels of a speed ramp, or of a ramp of something else, from the study's archive."""
    study = read_study(path)
    answer = study["answer"]
    with look():
        figure = sheet(12.5, 8.6)
        speed = answer["key"] == "shaft.speed"
        what = "its shaft speed" if speed else answer["key"]
        title = f"What does {study['name'].replace('_', ' ')} do when {what} ramps up and down?"
        figure.text(0.035, 0.968, shortened(title, 110), fontsize=13, weight="bold", va="center")
        for line, words in enumerate(textwrap.wrap(" ".join(_story(answer)), 185)[:3]):
            figure.text(0.035, 0.937 - 0.022 * line, words, fontsize=8.5, va="center")
        _speed_panels(figure, answer) if speed else _load_panels(figure, answer)
        return save(figure, out)


def _story(answer) -> list[str]:
    """The sentences of the verdict that a reader needs first."""
    return [words.replace("s^2", "s²") for words in answer["verdict"][:3]]


def _runs(answer):
    """(colour, row) of every run that was possible."""
    rows = [row for row in answer["rows"] if "failed" not in row]
    return [(COLOURS[k % len(COLOURS)], row) for k, row in enumerate(rows)]


# --- shaft speed ------------------------------------------------------------------------------------------


def _speed_panels(figure, answer):
    top = figure.add_axes((0.065, 0.665, 0.39, 0.185))
    below = figure.add_axes((0.065, 0.44, 0.39, 0.185), sharex=top)
    _order(top, below, answer)
    _waterfall(figure, answer)
    _growth(figure.add_axes((0.065, 0.07, 0.39, 0.265)), answer)
    _curve(figure.add_axes((0.56, 0.07, 0.39, 0.265)), answer)


def _order(top, below, answer):
    """Amplitude and phase of the order followed, up full, down dashed, linear theory black."""
    linear, unit = answer["linear"], "µrad" if answer["tilting"] else "µm"
    speed = np.array(linear["speed"])
    driven = max(linear["amplitude"], default=0.0) > 0
    if driven:
        top.plot(speed, 1e6 * np.array(linear["amplitude"]), color=BLACK, lw=2.6, alpha=0.35, label="linear, steady")
        angle = _degrees(linear["phase"])
        below.plot(speed, angle, color=BLACK, lw=2.6, alpha=0.35)
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
    order = f"{answer['order']:g}×"
    top.set(ylabel=f"amplitude, {unit}", title=f"Relative {'tilt' if answer['tilting'] else 'gap'}, order {order}: up "
            "full, down dashed")  # fmt: skip
    below.set(ylabel="phase to the shaft, °", xlabel="shaft speed, rad/s", xlim=(answer["begin"], answer["end"]))
    top.tick_params(labelbottom=False)
    _mark(top, answer)
    _mark(below, answer, named=False)
    top.legend(loc="lower right", fontsize=7.5, ncols=2)


def _degrees(phase):
    return np.degrees(np.unwrap(np.asarray(phase)))


def _mark(ax, answer, named=True):
    """The threshold as a line."""
    at = answer["threshold"]
    if at is None or not answer["begin"] < at < answer["end"]:
        return
    ax.axvline(at, color=CONTACT, lw=1.0, ls=":")
    if named:
        ax.text(at, 1.02, "threshold", transform=ax.get_xaxis_transform(), color=CONTACT, fontsize=7.5, ha="center")


def _waterfall(figure, answer):
    """Spectra in orders, up below and down above, in one stack."""
    fall = answer["waterfall"]
    box = (0.56, 0.44, 0.36, 0.41)
    ways = [w for w in ("up", "down") if fall and len(fall[w]["speed"]) > 1]
    if not ways:
        absent(figure.add_axes(box), "Waterfall", "no window of whole turns fits on the ramp")
        return
    largest = max(np.max(fall[w]["amplitude"]) for w in ways)
    if largest <= 0:
        absent(figure.add_axes(box), "Waterfall", "does not move")
        return
    width = box[2] / len(ways) - 0.006
    floor = largest * 10**-DECADES
    for k, way in enumerate(ways):
        ax = figure.add_axes((box[0] + k * (width + 0.012), box[1], width, box[3]))
        orders, speed = np.array(fall[way]["orders"]), np.array(fall[way]["speed"])
        level = np.log10(np.maximum(np.array(fall[way]["amplitude"]), floor))
        image = ax.pcolormesh(orders, speed, level, cmap="cividis", shading="nearest", rasterized=True,
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
        ax.set(title=f"{'Waterfall, ' if k == 0 else ''}{way}", xlabel="order", xlim=(-1.0, 2.0),
               ylim=(answer["begin"], answer["end"]), xticks=[-0.5, 0, 0.5, 1, 1.5])  # fmt: skip
        ax.set_xticklabels(["−½", "0", "½", "1", "1½"])
        if k:
            ax.tick_params(labelleft=False)
        else:
            ax.set_ylabel("shaft speed, rad/s")
    bar = figure.colorbar(image, cax=figure.add_axes((0.928, box[1], 0.011, box[3])))
    bar.set_label(f"log₁₀ of amplitude in {'rad' if answer['tilting'] else 'm'}", fontsize=7.5)
    bar.ax.tick_params(labelsize=7)
    row = next(row for row in answer["rows"] if row["rate"] == fall["rate"])
    words = (f"{fall['rate']:.4g} rad/s²; Hann windows of {fall['window']} turns: {row['resolution']:.2g} orders, "
             f"{row['speed_in_window']:.3g} rad/s")  # fmt: skip
    words += "; dashed orange: linear whirl" if answer["whirl"] else ""
    figure.text(0.56, 0.378, words, fontsize=7.5, color=GREY)


def _growth(ax, answer):
    """Logarithm of the free whirl since the threshold against what is foretold."""
    runs = [(colour, row) for colour, row in _runs(answer) if row.get("growth")]
    title = "Free whirl since the threshold: measured, and foretold (black)"
    if not runs:
        absent(ax, title, "no threshold on the way")
        return
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
    for level, words in ((small, "2 % of clearance / outer radius"), (touch, "touch")):
        if level is not None and level < 1.1 * reach:
            ax.axhline(level, color=GREY, lw=0.8, ls=":")
            ax.text(0.01, level, words, transform=ax.get_yaxis_transform(), fontsize=7.5, color=GREY, va="bottom")
    ax.axvline(top, color=GREY, lw=0.8)
    ax.text(top, 0.01, " back down", transform=ax.get_xaxis_transform(), fontsize=7.5, color=GREY)
    ax.set(title=title, xlabel="time since the threshold × rate, rad/s", ylabel="ln of growth", xlim=(0, None),
           ylim=(min(0.0, -0.03 * reach), 1.12 * reach))  # fmt: skip
    ax.legend(loc="upper left", fontsize=7.5, bbox_to_anchor=(0.0, 0.82), frameon=True, framealpha=0.8,
              edgecolor="none")  # fmt: skip


def _curve(ax, answer):
    """Largest misalignment and thinnest film over the ramp rate."""
    curve, title = answer["curve"], "How fast must one pass?"
    rate = np.array(curve["rate"], dtype=float)
    if not len(rate):
        absent(ax, title, "no run ended")
        return
    film = np.array([np.nan if v is None else 1e6 * v for v in curve["h_min"]], dtype=float)
    tilt = 1e6 * np.array(curve["relative_misalignment"], dtype=float)
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
        ax.axvline(touch, color=CONTACT, lw=1.0)
        ax.text(touch, 0.03, f" {touch:.4g} rad/s²", transform=ax.get_xaxis_transform(), color=CONTACT, fontsize=8)
    low, high = np.nanmin(tilt), np.nanmax(tilt)
    ax.set(title=title, xlabel="ramp rate, rad/s²", ylabel="largest relative tilt, µrad")
    ax.set_ylim(0.6 * low, 3.0 * high if high > 0 else 1.0)
    other = ax.twinx()
    other.plot(rate, film, color=ORANGE, marker="s", ms=3.5, lw=1.0, label="thinnest film (right)")
    thin, thick = min(0.0, np.nanmin(film)), max(np.nanmax(film), 0.0)
    other.set_ylim(thin - 0.1 * (thick - thin) * (thin < 0), thick + 0.5 * max(thick - thin, 1e-3))
    other.set_ylabel("thinnest film, µm", color=ORANGE)
    other.spines["right"].set_visible(True)
    other.grid(False)
    handles = [h for a in (ax, other) for h in a.get_legend_handles_labels()[0]]
    ax.legend(handles=handles, loc="upper right", fontsize=7.5, ncols=2)


# --- anything else ----------------------------------------------------------------------------------------


def _load_panels(figure, answer):
    panels = (
        ("film", "h_min", "Thinnest film, µm", 1e6),
        ("tilt", "relative_misalignment", "Relative tilt, µrad", 1e6),
        ("flow", "leakage", "Leakage, l/h", 3.6e6),
    )
    for k, (series, name, title, factor) in enumerate(panels):
        left = 0.065 + 0.322 * k
        _over_rate(figure.add_axes((left, 0.5, 0.265, 0.33)), answer, name, title, factor)
        _in_time(figure.add_axes((left, 0.09, 0.265, 0.28)), answer, series, title, factor)
        if k == 0:
            figure.axes[-1].legend(loc="best", fontsize=7.5)


def _over_rate(ax, answer, name, title, factor):
    """Extremes of each trip over its rate, the step at the right end, in front of the quasi-static range."""
    runs = [(colour, row) for colour, row in _runs(answer) if row.get(name) is not None]
    slow = factor * np.array([value for value in answer["quasi_static"][name] if value is not None])
    if len(slow):
        ax.axhspan(slow.min(), slow.max(), color=GREY, alpha=0.2, lw=0, label="range of the slow answer")
    rates = [row["rate"] for _, row in runs if row["rate"]]
    far = 10 * max(rates, default=1.0)
    for colour, row in runs:
        at = row["rate"] or far
        ax.plot(at, factor * row[name], "o", color=colour, ms=7)
        if name == "leakage":
            ax.plot(at, factor * row["leakage_least"], "o", mfc="white", color=colour, ms=7)
    what = {"h_min": "smallest", "relative_misalignment": "largest", "leakage": "largest (full), smallest (open)"}[name]
    ax.set(
        xscale="log", title=f"{title}: {what}", xlabel=f"ramp rate, {answer['rate_unit']} (at the far right: a step)"
    )
    values = np.array([*slow, *(factor * row[name] for _, row in runs)])
    room = 0.25 * max(np.ptp(values), 1e-3 * abs(values).max(), 1e-12)
    ax.set_ylim(values.min() - room, values.max() + room)
    ax.legend(loc="best", fontsize=7.5)


def _in_time(ax, answer, series, title, factor):
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
    ax.set(xscale="log", xlim=(first, last), title=f"{title.partition(',')[0]} on the way to {answer['end']:.4g} "
           f"{answer['unit']}", xlabel="time since the change began, s", ylabel=title.partition(", ")[2])  # fmt: skip
